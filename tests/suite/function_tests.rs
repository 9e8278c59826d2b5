//! Tests of single functions: in comments, in files beside shaders, and in assignments.

use std::fs;
use std::path::Path;

use expect_test::{Expect, expect};
use serde_json::Value;

use crate::program::{Run, toyproof};

const MAIN: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }\n";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn test(folder: &Path, arguments: &[&str]) -> Run {
    toyproof(folder, &[&["test"], arguments].concat())
}

/// Runs the tests in the comments of a shader.
fn run(shader: &str) -> Run {
    let folder = folder(&[("a.glsl", &format!("{shader}{MAIN}"))]);
    test(folder.path(), &["a.glsl"])
}

/// Asserts what the tests in the comments of a shader print on standard output.
fn prints(shader: &str, code: i32, expected: &Expect) {
    let run = run(shader);
    assert_eq!(run.code, code, "{run:?}");
    expected.assert_eq(&run.stdout);
}

/// Asserts that all tests of a shader pass, and that there are as many.
fn pass(shader: &str, count: usize) {
    let run = run(shader);
    assert_eq!(run.code, 0, "{run:?}");
    assert_eq!(run.stdout.matches("passed  ").count(), count, "{run:?}");
}

#[test]
fn values_are_compared_with_a_tolerance() {
    let disk = "float disk(vec2 p, float r) { return length(p) - r; }\n";
    pass(
        &format!(
            "// @test disk(vec2(3.0, 0.0), 1.0) == 2.0\n//@test disk(vec2(0), 1.0) == -1   // inside\n\
             // @test disk(vec2(3.0, 0.0), 1.0) == 2.01 +- 0.01\n// @test disk(vec2(3, 4), 0.0) != 5.1\n\
             // @test disk(vec2(3, 4), 0.0) <= 5\n// @test disk(vec2(3, 4), 0.0) > 4.9\n\
             /* // @test nothing */\n// @tests are above\n{disk}"
        ),
        6,
    );
    prints(
        &format!("// @test disk(vec2(3.0, 0.0), 1.0) == 2.01\n// @test disk(vec2(3, 4), 1.0) < 4\n{disk}"),
        1,
        &expect![[r"
            failed  a.glsl:1  disk(vec2(3.0, 0.0), 1.0) == 2.01
                    disk(vec2(3.0, 0.0), 1.0) is 2.0, expected 2.01
            failed  a.glsl:2  disk(vec2(3, 4), 1.0) < 4
                    disk(vec2(3, 4), 1.0) is 4.0, expected < 4
        "]],
    );
}

#[test]
fn values_of_any_type_are_compared() {
    pass(
        "struct Hit { float t; vec3 normal; int id; bool is_inside; };\n\
         Hit hit(float t) { return Hit(t, vec3(0, 0, 1), 100000, true); }\n\
         float values[3] = float[](1.0, 2.0, 3.0);\nmat2 twice(mat2 m) { return 2.0 * m; }\n\
         uint large() { return 4294967295u; }\nint small_() { return -2147483647 - 1; }\n\
         // @test hit(2.0) == Hit(2.0, vec3(0, 0, 1), 100000, true)\n\
         // @test hit(2.0) != Hit(2.0, vec3(0, 0, 1), 100001, true)\n// @test hit(1.0).normal.xy == vec2(0)\n\
         // @test hit(1.0).is_inside\n// @test !hit(1.0).is_inside == false\n\
         // @test values == float[](1.0, 2.0, 3.0)\n// @test twice(mat2(1.0)) == mat2(2, 0, 0, 2)\n\
         // @test large() == 4294967295u\n// @test large() - 1u != large()\n// @test small_() == -2147483647 - 1\n\
         // @test hit(1.0).normal in [0, 1]\n// @test hit(1.0).normal >= 0.0\n// @test 1.0 / 0.0 > 1e38\n",
        13,
    );
}

#[test]
fn properties_hold_for_all_values() {
    pass(
        "vec3 normalAt(vec3 p) { return normalize(p + 10.0); }\nfloat wave(float x) { return sin(x); }\n\
         float step3(int n) { return float(n / 3); }\nstruct Ray { vec3 o; vec3 d; };\n\
         float far(Ray r) { return dot(r.o, r.d); }\nfloat scale; void setup(float s) { scale = s; }\n\
         float scaled(float x) { return scale * x; }\n\
         // @test |normalAt(p)| == 1 for p in [-2, 2]\n// @test wave(x) == -wave(-x) for x in [-3, 3]\n\
         // @test wave(x) in [-1, 1] for x in [-100, 100]\n// @test wave(x) is increasing for x in [-1.5, 1.5]\n\
         // @test wave(-x) is decreasing for x in [-1.5, 1.5]\n// @test step3(n) is increasing for n in [-30, 30]\n\
         // @test step3(n) == 0 for n in {0, 1, 2}\n\
         // @test far(Ray(p, q)) == far(Ray(q, p)) for vec3 p, q in [vec3(-1, -2, 0), vec3(1.0)]\n\
         // @test far(r) == 1.0 for r in {Ray(vec3(1), vec3(1, 0, 0)), Ray(vec3(2), vec3(0.5, 0, 0))}\n\
         // @test scaled(x) == 3.0 * x for x in [0, 1] after setup(3.0)\n\
         // @test scaled(x) == s * x for x, s in [0, 1] after setup(s)\n",
        11,
    );
    prints(
        "vec3 normalAt(vec3 p) { return p.x > 1.0 ? 2.0 * normalize(p) : normalize(p); }\n\
         float wave(float x) { return sin(x); }\n\
         // @test |normalAt(p)| == 1 for p in [0.5, 1]\n// @test |normalAt(p)| == 1 for p in [0.5, 2]\n\
         // @test wave(x) is increasing for x in [0, 3]\n// @test wave(float(n)) == 0 for int n in {0, 1}\n",
        1,
        &expect![[r"
            passed  a.glsl:3  |normalAt(p)| == 1 for p in [0.5, 1]
            failed  a.glsl:4  |normalAt(p)| == 1 for p in [0.5, 2]
                    |normalAt(p)| is 2.0, expected 1 at p = (2.0, 0.5, 0.5) (wrong for 172 of 256 values)
            failed  a.glsl:5  wave(x) is increasing for x in [0, 3]
                    wave(x) goes from 0.9999974 to 0.9999016 at x = 1.573059 (wrong for 122 of 257 values)
            failed  a.glsl:6  wave(float(n)) == 0 for int n in {0, 1}
                    wave(float(n)) is 0.841471, expected 0 at n = 1
        "]],
    );
}

#[test]
fn a_result_may_be_wrong_in_float32_only() {
    let shader = "// @test lost(x) == x for x in [0, 1]\nfloat lost(float x) { return (x + 1e7) - 1e7; }\n";
    let wrong = run(shader);
    assert_eq!(wrong.code, 1, "{wrong:?}");
    assert!(
        wrong.stdout.contains("        in float32 only: lost(x) is "),
        "{wrong:?}"
    );
    let folder = folder(&[("a.glsl", &format!("{shader}{MAIN}"))]);
    for (precision, code) in [("f32", 1), ("f64", 0), ("both", 1)] {
        let run = test(folder.path(), &["a.glsl", "--precision", precision]);
        assert_eq!(run.code, code, "{precision}: {run:?}");
    }
}

#[test]
fn functions_are_called_in_the_default_frame() {
    pass(
        "float aspect() { return iResolution.x / iResolution.y; }\nvec4 texel() { return texelFetch(iChannel0, ivec2(0), 0); }\n\
         // @test aspect() == 16.0 / 9.0\n// @test iTime + float(iFrame) == 0.0\n// @test texel().rgb == 0.0\n",
        3,
    );
}

/// What is printed for tests that are invalid.
fn errors(shader: &str, expected: &Expect) {
    let folder = folder(&[("a.glsl", &format!("{shader}{MAIN}"))]);
    let run = test(folder.path(), &["a.glsl", "-q"]);
    assert_eq!(run.code, 2, "{run:?}");
    expected.assert_eq(&run.stderr);
}

#[test]
fn errors_in_comments_have_their_place() {
    errors(
        "float f(float x) { return x; }\n  // @test f(1.0) = 1.0\n// @test f(1.0) ==\n// @test\n\
         // @test 0.0 <= f(1.0) <= 1.0\n// @test f(x) == x for x\n// @test f(1.0) == 1.0 +- tiny\n",
        &expect![[r"
            a.glsl:2:19: error[E0511]: a test compares, and assigns nothing
            a.glsl:3:19: error[E0511]: `==` lacks an expression
            a.glsl:4:9: error[E0511]: the test is empty
            a.glsl:5:24: error[E0511]: a test has one comparison
            a.glsl:6:24: error[E0511]: the variable `x` has no values
            a.glsl:7:24: error[E0511]: `+-` must be followed by a tolerance
        "]],
    );
    errors(
        "float f(float x) { return x; }\nvoid g() {}\n// @test f(1) == 1.0\n// @test f(y) == 1.0\n\
         // @test h(1.0) == 1.0\n// @test f(1.0) == vec2(1.0)\n// @test f(1.0)\n// @test g() == 1\n\
         // @test f(1.0) == true\n// @test f(x) == x for vec9 x in [0, 1]\n// @test |bvec2(true)| == 1\n\
         // @test f(x) == x for x in [vec2(0), 1]\n// @test f(1.0) == 1.0 after nothing()\n",
        &expect![[r"
            a.glsl:3:10: error[E0302]: no matching function for the call `f(int)`; expected `f(float)`
            a.glsl:4:12: error[E0200]: `y` is not declared
            a.glsl:5:10: error[E0200]: unknown function `h`
            a.glsl:7:10: error[E0512]: the test compares nothing: its expression is of type `float`
            a.glsl:8:10: error[E0512]: a value of type `void` cannot be compared
            a.glsl:9:20: error[E0512]: a value of type `float` is compared with one of type `bool`
            a.glsl:10:24: error[E0200]: unknown type `vec9`; did you mean `vec2`?
            a.glsl:11:11: error[E0512]: bars are the length of a vector, found `bvec2`
            a.glsl:12:30: error[E0512]: `x` is of type `float`, and this value of type `vec2`
            a.glsl:13:30: error[E0200]: unknown function `nothing`
        "]],
    );
}

#[test]
fn errors_in_test_files_have_their_place() {
    let shader = format!("float f(float x) {{ return x; }}\n{MAIN}");
    let errors = |tests: &str, expected: &Expect| {
        let folder = folder(&[("a.glsl", &shader), ("a.test.toml", tests)]);
        let run = test(folder.path(), &["a.test.toml", "-q"]);
        assert_eq!(run.code, 2, "{run:?}");
        expected.assert_eq(&run.stderr);
    };
    errors(
        "",
        &expect![[r"
            a.test.toml:1:1: error[E0512]: the file has no tests
        "]],
    );
    errors(
        "shader = \"b.glsl\"\ntests = 1\n[[function]]\nname = \"f\"\ntest = [\"f(1.0) == 1.0\"]\n",
        &expect![[r#"
            a.test.toml:1:10: error[E0512]: there is no shader "b.glsl"
            a.test.toml:2:1: error[E0511]: unknown key `tests`
            a.test.toml:3:1: error[E0512]: the function has no cases
            a.test.toml:5:1: error[E0511]: unknown key `test` in [[function]]
        "#]],
    );
    errors(
        "[[function]]\nname = \"f\"\ntests = [\n  \"f(1.0) == 1.0\",\n  \"f(1.0) = 1.0\", 'f(1.0'\n]\n",
        &expect![[r"
            a.test.toml:5:11: error[E0511]: a test compares, and assigns nothing
            a.test.toml:5:21: error[E0511]: `(` is not closed
        "]],
    );
    errors(
        "[[function]]\nname = \"f\"\nafter = \"g()\"\nprecision = \"f16\"\ntests = [\"f(1.0) == 1.0\"]\n",
        &expect![[r"
            a.test.toml:4:13: error[E0511]: unknown precision `f16`
        "]],
    );
    // An error of the front end.
    errors(
        "[[function]]\nname = \"f\"\ntests = [\n  \"f(1.0) == 1.0\",\n  \"f(1.0 + 1) == 2.0\",\n]\n",
        &expect![[r"
            a.test.toml:5:12: error[E0300]: invalid operands of `+`: `float` and `int`
        "]],
    );
}

#[test]
fn a_shader_without_tests_and_one_that_does_not_compile_are_reported() {
    let folder = folder(&[
        ("none.glsl", MAIN),
        ("invalid.glsl", "// @test 1 == 1\nfloat f( { }\n"),
        (
            "alone.test.toml",
            "[[function]]\nname = \"f\"\ntests = [\"f(1.0) == 1.0\"]\n",
        ),
    ]);
    let none = test(folder.path(), &["none.glsl"]);
    assert_eq!(none.code, 2, "{none:?}");
    assert!(
        none.stderr
            .starts_with("error: none.glsl has no tests\nhelp: write a comment"),
        "{none:?}"
    );
    let invalid = test(folder.path(), &["invalid.glsl"]);
    assert_eq!(invalid.code, 1, "{invalid:?}");
    assert!(invalid.stderr.contains("invalid.glsl:2:"), "{invalid:?}");
    let alone = test(folder.path(), &["alone.test.toml"]);
    assert_eq!(alone.code, 2, "{alone:?}");
    let expected = "error: alone.test.toml names no shader, and no shader is beside it\nhelp: add `shader";
    assert!(alone.stderr.starts_with(expected), "{alone:?}");
    let missing = test(folder.path(), &["missing.glsl"]);
    assert_eq!(missing.code, 2, "{missing:?}");
}

const TESTS: &str = "[[function]]\nname = \"disk\"\ntests = [\"disk(p) == disk(-p) for p in [-1, 1]\"]\n\
                     [[function.case]]\narguments = [[3.0, 0.0]]\nresult = 2.0\n\
                     [[function.case]]\narguments = [[0, 0]]\nresult = -1\n";

#[test]
fn a_file_tests_several_shaders() {
    let right = format!("float disk(vec2 p) {{ return length(p) - 1.0; }}\n{MAIN}");
    let wrong = right.replace("length(p)", "length(p + 0.25)");
    let other = right.replace("vec2 p) { return length(p)", "vec3 p) { return length(p)");
    let folder = folder(&[
        ("task.test.toml", TESTS),
        ("hw/anna.glsl", &right),
        ("hw/kim.glsl", MAIN),
        ("hw/mai.glsl", &wrong),
        ("hw/zoe.glsl", &other),
    ]);
    let run = test(
        folder.path(),
        &["task.test.toml", "hw", "--format", "json", "--out", "results"],
    );
    assert_eq!(run.code, 1, "{run:?}");
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let shaders = report["shaders"].as_array().unwrap();
    let statuses: Vec<(&str, Vec<&str>)> = shaders
        .iter()
        .map(|shader| {
            let tests = shader["tests"].as_array().unwrap().iter();
            let statuses = tests.map(|test| test["status"].as_str().unwrap());
            (shader["shader"].as_str().unwrap(), statuses.collect())
        })
        .collect();
    let expected = [
        ("hw/anna.glsl", vec!["passed"; 3]),
        ("hw/kim.glsl", vec!["failed"; 2]),
        ("hw/mai.glsl", vec!["failed"; 3]),
        // The calls have another signature; the test in a line has the type of the parameter.
        ("hw/zoe.glsl", vec!["failed", "passed"]),
    ];
    assert_eq!(statuses, expected);
    let message = &shaders[1]["tests"][0]["message"];
    assert_eq!(
        message,
        "there is no function `disk`; expected `float disk(vec2)`"
    );
    assert_eq!(shaders[2]["tests"][2]["line"], 3);
    let xml = fs::read_to_string(folder.path().join("results/junit.xml")).unwrap();
    let document = roxmltree::Document::parse(&xml).unwrap();
    let suite = document
        .descendants()
        .find(|node| node.has_tag_name("testsuite"))
        .unwrap();
    let counts = ["name", "tests", "failures", "errors"].map(|name| suite.attribute(name).unwrap());
    assert_eq!(counts, ["toyproof test", "10", "6", "0"]);
    let json = fs::read_to_string(folder.path().join("results/tests.json")).unwrap();
    assert_eq!(json, run.stdout);
}

#[test]
fn an_assignment_has_the_same_tests() {
    let solution = "float disk(vec2 p) { return length(p) - 1.0; }\n\
                    void mainImage(out vec4 c, in vec2 p) { c = vec4(disk(p / iResolution.xy)); }\n";
    let wrong = solution.replace(
        "disk(vec2 p) { return length(p)",
        "disk(vec2 p) { return length(p + 0.25)",
    );
    let assignment = "reference = \"solution.glsl\"\n[[frame]]\nsize = [16, 9]\n[[function]]\nname = \"disk\"\npoints = 2\n\
                      tests = [\"disk(p) == disk(-p) for p in [-1, 1]\", \"disk(vec2(3, 4)) == 4\"]\n";
    let folder = folder(&[
        ("assignment.toml", assignment),
        ("solution.glsl", solution),
        ("hw/a.glsl", solution),
        ("hw/b.glsl", &wrong),
    ]);
    let arguments = [
        "check",
        "hw",
        "--assignment",
        "assignment.toml",
        "--device",
        "cpu",
        "--search",
        "0",
    ];
    let run = toyproof(folder.path(), &[&arguments[..], &["--format", "json"]].concat());
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let function = |index: usize| &report["shaders"][index]["functions"][0];
    assert_eq!(
        (&function(0)["passed"], &function(0)["cases"]),
        (&true.into(), &2.into())
    );
    assert_eq!(
        (&function(1)["passed"], &function(1)["right"]),
        (&false.into(), &0.into())
    );
    let message = function(1)["message"].as_str().unwrap();
    assert!(
        message.starts_with("disk(p) is ") && message.contains(" at p = "),
        "{message}"
    );
}

/// A mistake planted in each exercise: what is replaced, and by what.
const MISTAKES: [(&str, &str, &str); 33] = [
    ("01-sampling", "vec2 d = p - center", "vec2 d = p + center"),
    (
        "01-sampling",
        "ring * ring * ring - q.x * q.x * q.y * q.y * q.y",
        "ring * ring * ring - q.x * q.y * q.y * q.y",
    ),
    (
        "01-sampling",
        "heart(p, vec2(0.35, 0.08), 0.25) < 0.0",
        "heart(p, vec2(0.35, 0.08), 0.25) > 0.0",
    ),
    ("02-sphere", "float t = -b - root", "float t = -b + root"),
    (
        "02-sphere",
        "normalize(vec3(x, y, SCREEN_DEPTH))",
        "vec3(x, y, SCREEN_DEPTH)",
    ),
    (
        "03-shading",
        "max(dot(normal, toLight), 0.0)",
        "dot(normal, toLight)",
    ),
    ("03-shading", "vec3 sum = AMBIENT", "vec3 sum = vec3(0.0)"),
    ("04-many-objects", "if (t < hit.t)", "if (t > hit.t)"),
    ("04-many-objects", "< distance) {", "< NO_HIT) {"),
    ("04-many-objects", "light.color * cosine", "light.color"),
    ("05-complex-scene", "c * v.z - s * v.x", "c * v.z + s * v.x"),
    ("05-complex-scene", "(parent.radius + radius)", "parent.radius"),
    ("06-reflections", "if (t > tMin)", "if (t > 0.0)"),
    ("06-reflections", "0.5 * (1.0 + direction.y)", "direction.y"),
    ("07-diffuse", "material.albedo / PI", "material.albedo"),
    ("07-diffuse", "vec3(1.0 / 2.2)", "vec3(2.2)"),
    ("08-disney", "square(square(m)) * m", "square(square(m))"),
    ("08-disney", "(1.0 - m.metallic)", "1.0"),
    ("08-disney", "mix(1.0, grazing, fV)", "mix(1.0, grazing, fL)"),
    (
        "09-soft-shadows",
        "1.0 - cosine * cosine, 0.0));\n    float phi",
        "1.0 - cosine, 0.0));\n    float phi",
    ),
    ("09-soft-shadows", "< distance) {", "< NO_HIT) {"),
    (
        "10-quadrics",
        "-0.5 * radius * radius / height",
        "-radius * radius / height",
    ),
    ("10-quadrics", "z1 <= quadric.high", "z1 <= 1000.0"),
    ("10-quadrics", "vec3(0.0, 0.0, quadric.g)", "vec3(0.0)"),
    (
        "11-animation",
        "(1.0 - c) * dot(axis, v) * axis",
        "dot(axis, v) * axis",
    ),
    ("11-animation", "pivot + rotate(p - pivot", "rotate(p - pivot"),
    ("12-whitted", "(cosine + eta * beyond)", "(cosine + beyond)"),
    (
        "12-whitted",
        "floor(point.x) + floor(point.z)",
        "floor(point.x + point.z)",
    ),
    (
        "13-importance-sampling",
        "1.0 / (1.0 + ratio * ratio)",
        "1.0 / (1.0 + ratio)",
    ),
    (
        "13-importance-sampling",
        "coneDepth(point, emitter) * float(EMITTERS)",
        "coneDepth(point, emitter)",
    ),
    ("14-accelerator", "SPACING - 2.0 * radius", "SPACING"),
    (
        "14-accelerator",
        "next.x < next.y && next.x < next.z",
        "next.x < next.y",
    ),
    (
        "15-parallel-rays",
        "0.5 * WIDTH * vec3(x, y, 0.0)",
        "WIDTH * vec3(x, y, 0.0)",
    ),
];

#[test]
fn each_exercise_passes_its_tests() {
    let folder = tempfile::tempdir().unwrap();
    let write = ["scenes", "--write", "course"];
    assert_eq!(toyproof(folder.path(), &write).code, 0);
    let run = test(folder.path(), &["course"]);
    assert_eq!(run.code, 0, "{run:?}");
    for entry in fs::read_dir(folder.path().join("course")).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        if path.join("image.glsl").is_file() || path.extension().is_some_and(|extension| extension == "glsl")
        {
            assert!(
                run.stdout.contains(&format!("course/{stem}.test.toml:")),
                "{stem}: {run:?}"
            );
        }
    }
}

#[test]
fn a_planted_mistake_in_each_exercise_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let write = ["scenes", "--write", "course"];
    assert_eq!(toyproof(folder.path(), &write).code, 0);
    let mut missed = Vec::new();
    for (name, from, to) in MISTAKES {
        let path = folder.path().join(format!("course/{name}.glsl"));
        let right = fs::read_to_string(&path).unwrap();
        assert!(right.contains(from), "{name} has no {from}");
        fs::write(&path, right.replace(from, to)).unwrap();
        let run = test(folder.path(), &[&format!("course/{name}.glsl"), "-q"]);
        fs::write(&path, right).unwrap();
        if run.code != 1 {
            missed.push(format!("{name}: {to}: {run:?}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}
