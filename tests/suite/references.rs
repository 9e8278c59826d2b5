//! Shaders that are compared with a shader or an image instead of a scene.

use std::fs;
use std::path::Path;

use serde_json::Value;
use toyproof::verify::{DEFAULT_TOLERANCE, Means, Reason, Verdict};

use crate::program::{Run, toyproof};
use crate::random_draws::OTHER_HASH;
use crate::support::{
    Edit, MANY_OBJECTS, SIZE, SOFT_SHADOWS, WHITTED, check_reference, edited, exported_reference, numbers,
};

/// A disk on a gradient, with a hard edge.
const DISK: &str = "void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 p = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    vec3 color = vec3(0.5 + 0.25 * p, 0.25);
    if (length(p) < 0.61) {
        color = vec3(1.0, 0.75, 0.0);
    }
    fragColor = vec4(color, 1.0);
}
";

/// The same, written by somebody else.
const OTHER_STYLE: &str =
    "float disk(vec2 at, float radius) { return 1.0 - step(radius * radius, dot(at, at)); }
void mainImage(out vec4 o, vec2 at) {
    vec2 uv = at / iResolution.y * 2.0 - vec2(iResolution.x / iResolution.y, 1.0);
    o = vec4(mix(vec3(uv * 0.25 + 0.5, 0.25), vec3(1.0, 0.75, 0.0), disk(uv, 0.61)), 1.0);
}
";

const SMALL: [&str; 4] = ["--device", "cpu", "--size", "64x36"];

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn check(folder: &Path, arguments: &[&str]) -> Run {
    toyproof(folder, &[&["check"], arguments, &SMALL].concat())
}

/// The record of the only shader.
fn record(run: &Run) -> Value {
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    report["shaders"][0].clone()
}

#[test]
fn another_style_is_correct_and_another_image_is_wrong() {
    let wrong = DISK.replace("0.61", "0.66");
    let folder = folder(&[
        ("solution.glsl", DISK),
        ("hw/anna.glsl", OTHER_STYLE),
        ("hw/mai.glsl", &wrong),
        ("hw/anna.toml", "this is not a scene"),
    ]);
    let arguments = ["hw/anna.glsl", "--reference", "solution.glsl", "--format", "json"];
    let run = check(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{run:?}");
    let right = record(&run);
    assert_eq!(right["verdict"], "correct");
    assert_eq!(
        (&right["scene"], &right["reference"]),
        (&Value::Null, &"solution.glsl".into())
    );

    let arguments = ["hw/mai.glsl", "--reference", "solution.glsl", "--format", "json"];
    let run = check(folder.path(), &arguments);
    assert_eq!(run.code, 1, "{run:?}");
    let wrong = record(&run);
    assert_eq!(wrong["verdict"], "wrong");
    let first = &wrong["algorithm"]["first"];
    assert_eq!(first["actual"][0], 1.0, "{first}");
    assert!(first["expected"][0].as_f64().unwrap() < 0.9, "{first}");
    // The search for a fix needs no scene.
    let fix = &wrong["fix"]["edits"][0]["replacement"];
    assert_eq!(fix, "0.61", "{wrong}");
    let help = wrong["help"].as_str().unwrap();
    assert!(help.starts_with("toyproof explain"), "{help}");
}

#[test]
fn a_batch_has_its_reports_and_marks() {
    let wrong = DISK.replace("0.5 + 0.25 * p", "0.5 - 0.25 * p");
    let rubric = "[algorithm]\npoints = 4\n";
    let folder = folder(&[
        ("solution.glsl", DISK),
        ("hw/anna.glsl", OTHER_STYLE),
        ("hw/mai.glsl", &wrong),
        ("rubric.toml", rubric),
    ]);
    let arguments = [
        "hw",
        "--reference",
        "solution.glsl",
        "--out",
        "out",
        "--rubric",
        "rubric.toml",
    ];
    let run = check(folder.path(), &[&arguments[..], &["--search", "0"]].concat());
    assert_eq!(run.code, 1, "{run:?}");
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let csv = read("report.csv");
    let row = |name: &str| csv.lines().find(|line| line.contains(name)).unwrap().to_owned();
    assert!(row("anna").contains(",solution.glsl,correct,"), "{csv}");
    assert!(
        row("anna").contains(",4,4,") && row("mai").contains(",0,4,"),
        "{csv}"
    );
    assert!(read("junit.xml").contains("classname=\"solution.glsl\""));
    assert!(read("report.html").contains("Reference: solution.glsl"));
    let exists = |image: &str| folder.path().join("out").join(image).is_file();
    let values = ["mai-value.png", "mai-reference-value.png"];
    let images = ["anna-reference.png", "anna-actual.png", "mai-algorithm.png"];
    assert!(images.into_iter().chain(values).all(exists));
    let page = read("report.html");
    assert!(page.contains(" data-value=\"") && page.contains(" data-reference-value=\""));
    // A fix says more than the values.
    let run = check(folder.path(), &arguments);
    assert!(run.stdout.contains("fix: "), "{run:?}");
    assert!(exists("mai-fixed.png") && !values.into_iter().any(exists));
    assert!(!read("report.html").contains(" data-value=\""));
}

#[test]
fn a_changed_reference_invalidates_results() {
    let folder = folder(&[("solution.glsl", DISK), ("anna.glsl", OTHER_STYLE)]);
    let arguments = ["anna.glsl", "--reference", "solution.glsl", "--out", "out"];
    let resumed = [&arguments[..], &["--resume"]].concat();
    assert_eq!(check(folder.path(), &arguments).code, 0);
    let again = check(folder.path(), &resumed);
    assert!(again.stderr.contains("1 of 1 result is reused"), "{again:?}");
    let tolerant = check(folder.path(), &[&resumed[..], &["--tolerance", "2"]].concat());
    assert!(!tolerant.stderr.contains("reused"), "{tolerant:?}");
    fs::write(folder.path().join("solution.glsl"), DISK.replace("0.61", "0.66")).unwrap();
    let changed = check(folder.path(), &[&resumed[..], &["--search", "0"]].concat());
    assert_eq!(changed.code, 1, "{changed:?}");
    assert!(!changed.stderr.contains("reused"), "{changed:?}");
}

#[test]
fn pixels_that_rounding_decides_do_not_count() {
    // At 64 pixels a row, the edge lies on the centers of a column, which either side may include.
    let reference = "void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(p.x / iResolution.x * 0.7 < 0.1171875 * 0.7), 1.0); }";
    let other =
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(p.x / iResolution.x <= 0.1171875), 1.0); }";
    let folder = folder(&[("solution.glsl", reference), ("other.glsl", other)]);
    let run = check(
        folder.path(),
        &["other.glsl", "--reference", "solution.glsl", "--format", "json"],
    );
    let record = record(&run);
    assert_eq!(record["verdict"], "correct", "{record}");
    assert_eq!(record["algorithm"]["ill_conditioned"], 36, "{record}");
    let details = record["details"].to_string();
    assert!(
        details.contains("rounding decides the color of the reference itself"),
        "{details}"
    );
}

#[test]
fn a_reference_does_not_hide_the_precision_that_it_loses_too() {
    // A small sphere far away: b² and c agree in almost all digits.
    let far = |b: &str, h: &str, root: &str| {
        format!(
            "void mainImage(out vec4 color, in vec2 p) {{
    vec3 d = normalize(vec3((p - 0.5 * iResolution.xy) / iResolution.y, -300.0)), center = vec3(0, 0, -5000);
    float b = {b} * dot(-center, d), c = dot(center, center) - 25.0, h = {h};
    color = vec4(0.1, 0.1, 0.2, 1.0);
    if (h > 0.0) {{
        vec3 n = ({root} * d - center) / 5.0;
        color.rgb = vec3(0.9, 0.5, 0.2) * max(dot(n, normalize(vec3(1))), 0.0);
    }}
}}"
        )
    };
    let folder = folder(&[
        (
            "solution.glsl",
            &far("2.0", "b * b - 4.0 * c", "0.5 * (-b - sqrt(h))"),
        ),
        ("far.glsl", &far("1.0", "b * b - c", "(-b - sqrt(h))")),
    ]);
    let compared = check(
        folder.path(),
        &["far.glsl", "--reference", "solution.glsl", "--format", "json"],
    );
    let found = record(&compared);
    assert_eq!(found["verdict"], "correct", "{found}");
    let reason = found["reason"].as_str().unwrap();
    assert!(reason.ends_with(", and so does the reference"), "{reason}");
    let text = found.to_string();
    for text_part in ["W0602", "the reference loses precision at the same place"] {
        assert!(text.contains(text_part), "{text}");
    }
    assert!(
        !text.contains("rounding decides the color of the reference"),
        "{text}"
    );
    let alone = check(folder.path(), &["far.glsl", "--format", "json"]);
    let reason = record(&alone)["reason"].to_string();
    assert!(
        reason.contains("visibly between float32 and double precision"),
        "{reason}"
    );
}

#[test]
fn a_reference_that_cannot_be_used_is_reported_before_any_shader_is_checked() {
    let broken = DISK.replace("1.0);\n}", "1.0)\n}");
    let endless = "void mainImage(out vec4 c, in vec2 p) { float x = p.x; while (x > -1.0) x = abs(sin(x)); c = vec4(x); }";
    let undefined = "void mainImage(out vec4 c, in vec2 p) { float a[2]; a[0] = 0.25; a[1] = 0.5; c = vec4(a[int(p.x)]); }";
    let folder = folder(&[
        ("anna.glsl", OTHER_STYLE),
        ("broken.glsl", &broken),
        ("endless.glsl", endless),
        ("undefined.glsl", undefined),
        ("scene.toml", "[background]\n"),
        ("folder/image-2.glsl", DISK),
        ("shader.json", "{}"),
        ("photo.jpg", "?"),
    ]);
    for (reference, messages) in [
        (
            "broken.glsl",
            &[
                "broken.glsl:7:",
                "expected `;`",
                "the reference broken.glsl is invalid",
            ][..],
        ),
        (
            "endless.glsl",
            &["the reference endless.glsl cannot be evaluated: time limit exceeded"],
        ),
        (
            "undefined.glsl",
            &[
                "undefined.glsl:1:",
                "an index out of bounds",
                "the reference undefined.glsl has no defined color in 2,232 of 2,304 pixels (96.9 %)",
            ],
        ),
        ("missing.glsl", &["missing.glsl: no such file"]),
        ("scene.toml", &["scene.toml is a scene", "--scene"]),
        ("folder", &["folder is a folder", "a single shader or an image"]),
        (
            "shader.json",
            &[
                "error[E0508]: missing key `renderpass`",
                "the reference shader.json is invalid",
            ],
        ),
        ("photo.jpg", &[".png and .exr"]),
    ] {
        let run = check(
            folder.path(),
            &["anna.glsl", "--reference", reference, "--timeout", "100ms"],
        );
        assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{reference}: {run:?}");
        for message in messages {
            assert!(run.stderr.contains(message), "{message}: {}", run.stderr);
        }
    }
}

#[test]
fn undefined_pixels_of_the_reference_are_left_out() {
    let reference = DISK.replace(
        "    fragColor",
        "    if (fragCoord.x < 1.0) color.r = 1.0 / pow(-1.0 - fragCoord.y, 0.5);\n    if (fragCoord.y < 1.0) color.g = color.b / 0.0 - color.b / 0.0;\n    fragColor",
    );
    let folder = folder(&[("solution.glsl", &reference), ("anna.glsl", OTHER_STYLE)]);
    let run = check(
        folder.path(),
        &["anna.glsl", "--reference", "solution.glsl", "--format", "json"],
    );
    assert_eq!(run.code, 0, "{run:?}");
    let message =
        "the reference solution.glsl has no defined color in 99 of 2,304 pixels (4.3 %); they are left out";
    assert!(run.stderr.contains(message), "{run:?}");
    let record = record(&run);
    // A column and a row of 64 × 36 pixels.
    assert_eq!(record["algorithm"]["undefined"], 99, "{record}");
    assert_eq!(record["algorithm"]["differing"], 0, "{record}");
}

#[test]
fn an_image_is_compared_as_displayed() {
    let brighter = DISK.replace("fragColor = vec4(color,", "fragColor = vec4(color + 2.4 / 255.0,");
    let folder = folder(&[
        ("solution.glsl", DISK),
        ("anna.glsl", OTHER_STYLE),
        ("brighter.glsl", &brighter),
    ]);
    for image in ["a.png", "a.exr"] {
        let run = toyproof(
            folder.path(),
            &[&["run", "solution.glsl", "-o", image][..], &SMALL].concat(),
        );
        assert_eq!(run.code, 0, "{run:?}");
    }
    let verdict = |shader: &str, image: &str, tolerance: &[&str]| {
        let arguments = [
            "check",
            shader,
            "--reference",
            image,
            "--device",
            "cpu",
            "--format",
            "json",
        ];
        let run = toyproof(folder.path(), &[&arguments[..], tolerance].concat());
        let record = record(&run);
        assert_eq!(
            record["algorithm"]["pixels"],
            64 * 36,
            "the image's size: {run:?}"
        );
        assert!(
            record["details"]
                .to_string()
                .contains("only the image was compared"),
            "{record}"
        );
        record["verdict"].as_str().unwrap().to_owned()
    };
    assert_eq!(verdict("anna.glsl", "a.png", &[]), "correct");
    assert_eq!(verdict("anna.glsl", "a.exr", &["--tolerance", "0.01"]), "correct");
    for (image, low, high) in [("a.png", "1", "3"), ("a.exr", "2", "2.5")] {
        assert_eq!(verdict("brighter.glsl", image, &["--tolerance", low]), "wrong");
        assert_eq!(verdict("brighter.glsl", image, &["--tolerance", high]), "correct");
    }
    let other_size = ["check", "anna.glsl", "--reference", "a.png", "--size", "32x18"];
    let run = toyproof(folder.path(), &other_size);
    assert_eq!(run.code, 2, "{run:?}");
    assert!(
        run.stderr
            .contains("a.png has 64×36 pixels, and the given size is 32x18"),
        "{run:?}"
    );
}

#[test]
fn options_that_contradict_each_other_are_rejected() {
    let folder = folder(&[("anna.glsl", OTHER_STYLE), ("solution.glsl", DISK)]);
    for (arguments, message) in [
        (
            &["--scene", "02-sphere", "--reference", "solution.glsl"][..],
            "'--scene <SCENE>' cannot be used with '--reference <SHADER|IMAGE>'",
        ),
        (&["--tolerance", "1"], "--reference <SHADER|IMAGE>"),
        (
            &["--reference", "solution.glsl", "--tolerance", "-1"],
            "expected a number of 8-bit levels from 0 to 255",
        ),
    ] {
        let run = check(folder.path(), &[&["anna.glsl"], arguments].concat());
        assert_eq!(run.code, 2, "{run:?}");
        assert!(run.stderr.contains(message), "{message}: {}", run.stderr);
    }
}

#[test]
fn a_pixel_is_traced_beside_the_reference() {
    let wrong = DISK.replace("0.61", "0.66");
    let folder = folder(&[("solution.glsl", DISK), ("mai.glsl", &wrong)]);
    let debug = |arguments: &[&str]| {
        let command = ["debug", "mai.glsl", "--pixel", "43,18", "--size", "64x36"];
        let run = toyproof(folder.path(), &[&command[..], arguments].concat());
        assert_eq!(run.code, 0, "{run:?}");
        run.stdout
    };
    let human = debug(&["--reference", "solution.glsl"]);
    assert!(human.contains("expected color     (0.6"), "{human}");
    assert!(
        human.contains("reference: solution.glsl, pixel (43, 18)"),
        "{human}"
    );
    let json: Value =
        serde_json::from_str(&debug(&["--reference", "solution.glsl", "--format", "json"])).unwrap();
    assert_eq!(json["expected"], json["reference"]["f64"]);
    assert_ne!(json["expected"], json["f64"]);
    // Of an image, only the color is known.
    let image = [
        "run",
        "solution.glsl",
        "-o",
        "a.png",
        "--size",
        "64x36",
        "--device",
        "cpu",
    ];
    assert_eq!(toyproof(folder.path(), &image).code, 0);
    let command = [
        "debug",
        "mai.glsl",
        "--pixel",
        "43,18",
        "--reference",
        "a.png",
        "--format",
        "json",
    ];
    let run = toyproof(folder.path(), &command);
    let json: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(json["reference"], Value::Null);
    assert!(json["expected"].is_array(), "{run:?}");
}

/// Other random numbers than those of the exported shader.
const OTHER_SEED: Edit = ("pcg(uint(i))", "pcg(uint(i) + 1000u)");

#[test]
fn stochastic_references_are_compared_by_their_means() {
    let exercise = crate::support::Exercise {
        size: SIZE,
        ..SOFT_SHADOWS
    };
    let reference = exported_reference(&exercise, DEFAULT_TOLERANCE);
    let findings = |edits: &[Edit]| check_reference(&reference, &edited(&exercise, edits), &exercise);
    let same = findings(&[]);
    assert!(matches!(same.reason, Reason::Agrees { .. }), "{}", numbers(&same));
    let other = findings(&[OTHER_SEED]);
    assert_eq!(other.verdict, Verdict::Correct, "{:?}", other.reason);
    assert!(
        matches!(
            other.reason,
            Reason::OtherRandomNumbers {
                means: Means::Same { .. },
                ..
            }
        ),
        "{:?}",
        other.reason
    );
    let wrong = findings(&[OTHER_SEED, ("0.6, vec3(0.7)", "0.7, vec3(0.7)")]);
    assert_eq!(wrong.verdict, Verdict::Wrong, "{:?}", wrong.reason);
    assert!(wrong.reason.compares_means(), "{:?}", wrong.reason);
}

#[test]
fn a_reference_whose_pixels_share_random_numbers_has_no_known_noise() {
    // All pixels have the same seed.
    let reference = exported_reference(&MANY_OBJECTS, DEFAULT_TOLERANCE);
    let other_numbers = edited(&MANY_OBJECTS, OTHER_HASH);
    let findings = check_reference(&reference, &other_numbers, &MANY_OBJECTS);
    assert_eq!(findings.verdict, Verdict::Inconclusive, "{:?}", findings.reason);
    let wrong = edited(
        &MANY_OBJECTS,
        &[("if (!inShadow(hit.point, hit.normal))", "if (true)")],
    );
    let findings = check_reference(&reference, &wrong, &MANY_OBJECTS);
    assert_eq!(findings.verdict, Verdict::Wrong, "{:?}", findings.reason);
}

#[test]
fn ray_epsilons_are_a_matter_of_style() {
    // Refracted rays of the exported shader start off the surface, those of the exercise on it.
    let reference = exported_reference(&WHITTED, DEFAULT_TOLERANCE);
    let findings = check_reference(&reference, WHITTED.shader, &WHITTED);
    assert_eq!(findings.verdict, Verdict::Correct, "{}", numbers(&findings));
}
