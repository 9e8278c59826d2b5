//! Wrong shaders that hide their mistake behind undefined behavior, loops that do not end, or the precision.

use std::fs;

use serde_json::Value;

use crate::program::toyproof;

/// The start of a shader that renders a gradient.
const GRADIENT: &str = "void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 p = fragCoord;
    vec3 color = vec3(p / iResolution.xy, 0.5);
";

const END: &str = "    fragColor = vec4(color, 1.0);\n}\n";

fn shader(statements: &str) -> String {
    format!("{GRADIENT}    {statements}\n{END}")
}

/// Checks shaders against the gradient, and returns their records in order.
fn check(shaders: &[String]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("reference.glsl"), shader("")).unwrap();
    fs::create_dir(folder.path().join("hw")).unwrap();
    for (number, shader) in shaders.iter().enumerate() {
        fs::write(folder.path().join(format!("hw/{number:02}.glsl")), shader).unwrap();
    }
    let arguments = "check hw --reference reference.glsl --device cpu --size 64x36 --search 0 --format json";
    let arguments: Vec<_> = arguments.split(' ').collect();
    let run = toyproof(folder.path(), &arguments);
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    report["shaders"].as_array().unwrap().clone()
}

/// Undefined operations: a float `u` whose value GLSL leaves open.
const UNDEFINED: [&str; 10] = [
    "float u = pow(-1.0 - p.x, 2.5);",
    "float u = pow(0.0 * p.x, 0.0);",
    "float u = smoothstep(1.0, 1.0, p.x + 1.0);",
    "float u = float(7 / int(p.x * 0.0));",
    "float u = float(7 % int(p.x * 0.0));",
    "float u = float(int(p.x * 1e20));",
    "float u = float(1 << int(p.x + 32.0));",
    "float u = min(sqrt(-p.x), 1.0);",
    "float u = clamp(p.x, 2.0, 1.0);",
    "float u = float[2](0.25, 0.75)[int(p.x) + 2];",
];

#[test]
fn a_pixel_is_wrong_that_differs_whatever_undefined_operations_return() {
    let wrong = UNDEFINED.map(|undefined| {
        shader(&format!(
            "if (p.x < 3.0) {{ {undefined} color = vec3(0.9, 0.0, 0.9) + (u > 0.5 ? 0.0 : 0.1); }}"
        ))
    });
    for (record, undefined) in check(&wrong).iter().zip(UNDEFINED) {
        assert_eq!(record["verdict"], "wrong", "{undefined}: {record}");
        assert_eq!(record["algorithm"]["differing"], 3 * 36, "{undefined}");
    }
}

#[test]
fn pixels_that_are_right_for_one_result_are_left_out_and_reported() {
    // A remainder is zero in either case.
    let operations = UNDEFINED.into_iter().filter(|operation| !operation.contains('%'));
    let operations: Vec<_> = operations.collect();
    let open = operations.iter().map(|undefined| {
        shader(&format!(
            "if (p.x < 3.0) {{ {undefined} color += u == 0.5 || u == 0.25 || u == 0.0 ? 0.0 : 0.3; }}"
        ))
    });
    for (record, undefined) in check(&open.collect::<Vec<_>>()).iter().zip(operations) {
        assert_eq!(record["verdict"], "correct", "{undefined}: {record}");
        let reason = record["reason"].as_str().unwrap();
        let words =
            "an area of 108 pixels around (1, 18) was left out, since it depends on undefined behavior";
        assert!(reason.contains(words), "{undefined}: {reason}");
        assert_eq!(record["algorithm"]["undefined_region"]["pixels"], 108);
    }
}

#[test]
fn the_power_of_a_negative_base_may_be_that_of_its_absolute_value() {
    let shader = shader("color.x = pow(p.x / iResolution.x - 1.0, 2.0); color.x = 1.0 - sqrt(color.x);");
    let record = &check(&[shader])[0];
    assert_eq!(record["algorithm"]["differing"], 0, "{record}");
    assert_eq!(record["verdict"], "inconclusive", "{record}");
}

#[test]
fn a_loop_that_does_not_end_is_a_timeout_in_one_pixel_too() {
    let endless = shader("if (p.x < 1.0 && p.y < 1.0) { for (;;) { if (color.x < 0.0) break; } }");
    let record = &check(&[endless])[0];
    assert_eq!(record["verdict"], "timeout", "{record}");
}

/// Loops for ever in double precision alone, in one pixel.
const ENDLESS_IN_DOUBLE: &str = "float one = 1.0 + 1e-10 * p.y / p.y;
    if (one != 1.0 && p.x < 1.0 && p.y < 1.0) { for (;;) { if (color.x < 0.0) break; } }";

#[test]
fn a_shader_that_ends_only_in_float32_is_compared_in_float32() {
    let right = shader(ENDLESS_IN_DOUBLE);
    let wrong = shader(&format!("{ENDLESS_IN_DOUBLE} if (p.x < 9.0) color.z = 0.6;"));
    let records = check(&[right, wrong]);
    for (record, verdict) in records.iter().zip(["correct", "wrong"]) {
        assert_eq!(record["verdict"], verdict, "{record}");
        assert_eq!(record["precision"], Value::Null, "{record}");
        let diagnostics = record["diagnostics"].as_array().unwrap();
        let warning = diagnostics.iter().find(|one| one["code"] == "W0612");
        assert_eq!(warning.unwrap()["line"], 5, "{record}");
    }
}
