//! Rounding errors over the frames of a project: their causes, and the verdicts that follow.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::toyproof;

/// An image that shows Buffer A.
const SHOWN: &str = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }";

/// The logistic map, in which errors about double from frame to frame.
const LOGISTIC: &str = "
void mainImage(out vec4 c, in vec2 p) {
    float x = texelFetch(iChannel0, ivec2(p), 0).x;
    if (iFrame == 0) x = p.x / iResolution.x;
    c = vec4(3.9 * x * (1.0 - x), 0.0, 0.0, 1.0);
}";

/// A hash that float32 cannot compute, in the first frame alone.
const HASHED: &str = "
float hash(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }
void mainImage(out vec4 c, in vec2 p) {
    vec4 last = texelFetch(iChannel0, ivec2(p), 0);
    if (iFrame == 0) last = vec4(hash(p));
    c = mix(last, vec4(0.5), 0.01);
}";

/// A sum of tenths, which is an integer every ten frames.
const SUMMED: &str = "
void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + 0.1; }";

/// Checks a project of Buffer A and the image on the CPU.
fn check(buffer: &str, image: &str, reference: Option<&str>, frame: &str) -> (Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, buffer: &str| {
        let folder = folder.path().join(name);
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join("buffer-a.glsl"), buffer).unwrap();
        fs::write(folder.join("image.glsl"), image).unwrap();
    };
    write("own", buffer);
    let mut arguments = vec![
        "check", "own", "--frame", frame, "--size", "32x18", "--device", "cpu",
    ];
    arguments.extend(["--format", "json", "-v"]);
    if let Some(reference) = reference {
        write("other", reference);
        arguments.extend(["--reference", "other"]);
    }
    let run = toyproof(folder.path(), &arguments);
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {run:?}"));
    (report["shaders"][0].clone(), run.stderr)
}

fn codes(shader: &Value) -> Vec<&str> {
    let diagnostics = shader["diagnostics"].as_array().unwrap();
    diagnostics
        .iter()
        .map(|one| one["code"].as_str().unwrap())
        .collect()
}

#[test]
fn a_chaotic_project_is_chaotic_only_where_the_difference_is_visible() {
    let (shader, _) = check(LOGISTIC, SHOWN, Some(LOGISTIC), "10");
    assert_eq!(
        (&shader["verdict"], &shader["growth"]["cause"]),
        (&"correct".into(), &Value::Null)
    );
    let (shader, _) = check(LOGISTIC, SHOWN, Some(LOGISTIC), "30");
    assert_eq!(shader["verdict"], "chaotic", "{shader}");
    let growth = &shader["growth"];
    assert_eq!(growth["cause"], "chaos");
    // Between two digits, errors are multiplied by e^0.5 at this rate, the map's Lyapunov exponent.
    let doubling = growth["doubling"].as_f64().unwrap();
    assert!((0.9..2.5).contains(&doubling), "{doubling}");
    let first = growth["first_visible"].as_i64().unwrap();
    assert!((11..30).contains(&first), "{first}");
    let frames = growth["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 31);
    let error = |frame: usize| frames[frame]["max_abs"].as_f64().unwrap();
    assert!(error(0) < 1e-6 && error(30) > 0.1, "{} {}", error(0), error(30));
    assert_eq!(codes(&shader), ["W0609"]);
}

#[test]
fn a_wrong_project_is_wrong_until_chaos_reaches_double_precision() {
    let wrong = LOGISTIC.replace("3.9", "3.8");
    let (shader, _) = check(&wrong, SHOWN, Some(LOGISTIC), "3");
    assert_eq!(shader["verdict"], "wrong");
    let departs = "Buffer A departs from the reference in frame 0";
    assert_eq!(shader["details"][0], departs, "{shader}");
    let fix = &shader["fix"];
    assert_eq!(
        (&fix["file"], &fix["line"]),
        (&"own/buffer-a.glsl".into(), &5.into()),
        "{shader}"
    );
    let verdict = |frame| check(&wrong, SHOWN, Some(LOGISTIC), frame).0["verdict"].clone();
    assert_eq!(verdict("30"), "wrong");
    // A right formula is as far from the reference.
    assert_eq!(verdict("150"), "chaotic");
    let rewritten = LOGISTIC.replace("3.9 * x * (1.0 - x)", "3.9 * (x - x * x)");
    let verdict = |frame| check(&rewritten, SHOWN, Some(LOGISTIC), frame).0["verdict"].clone();
    assert_eq!(verdict("10"), "correct");
    assert_eq!(verdict("30"), "chaotic");
    assert_eq!(verdict("150"), "chaotic");
}

#[test]
fn an_imprecise_frame_is_blamed_with_its_pass_and_line() {
    let (shader, _) = check(HASHED, SHOWN, Some(HASHED), "10");
    assert_eq!(
        (&shader["verdict"], &shader["growth"]["cause"]),
        (&"unstable".into(), &"step".into())
    );
    let reason = shader["reason"].as_str().unwrap();
    assert!(reason.contains("Buffer A does so in frame 0 already"), "{reason}");
    let diagnostics = shader["diagnostics"].as_array().unwrap();
    let lost = diagnostics.iter().find(|one| one["code"] == "W0602").unwrap();
    assert_eq!(lost["line"], 2, "{lost}");
    assert!(
        lost["file"].as_str().unwrap().ends_with("buffer-a.glsl"),
        "{lost}"
    );
    // Without a reference, the shader is not at fault, but warned.
    let (shader, _) = check(HASHED, SHOWN, None, "10");
    assert_eq!(shader["verdict"], "ok");
    assert_eq!(codes(&shader), ["W0005", "W0602", "W0609"]);
}

#[test]
fn errors_that_add_up_are_no_chaos() {
    let fraction = SHOWN.replace(
        "c = texelFetch(iChannel0, ivec2(p), 0)",
        "c = fract(texelFetch(iChannel0, ivec2(p), 0))",
    );
    assert_ne!(fraction, SHOWN);
    // The sum of ten tenths is below 1 in double precision, and above it in float32.
    let (shader, _) = check(SUMMED, &fraction, Some(SUMMED), "9");
    assert_eq!(
        (&shader["verdict"], &shader["growth"]["cause"]),
        (&"unstable".into(), &"accumulation".into()),
        "{shader}"
    );
    let (shader, _) = check(SUMMED, &fraction, Some(SUMMED), "8");
    assert_eq!(shader["verdict"], "correct");
}

#[test]
fn exact_projects_agree_in_all_frames() {
    let life = "
    float cell(ivec2 p) { return texelFetch(iChannel0, p, 0).x; }
    void mainImage(out vec4 c, in vec2 p) {
        ivec2 q = ivec2(p);
        float n = -cell(q);
        for (int i = 0; i < 9; i++) n += cell(q + ivec2(i % 3 - 1, i / 3 - 1));
        c = vec4(n == 3.0 || n == 2.0 && cell(q) == 1.0 ? 1.0 : 0.0);
        if (iFrame == 0) c = vec4((q.x * q.x + 3 * q.y * q.x + q.y) % 5 < 2 ? 1.0 : 0.0);
    }";
    let (shader, stderr) = check(life, SHOWN, Some(life), "60");
    assert_eq!(shader["verdict"], "correct");
    assert!(
        shader["growth"]["frames"]
            .as_array()
            .unwrap()
            .iter()
            .all(|one| one["max_abs"] == 0.0)
    );
    let words = "over frames 0 to 60, float32 and double precision differ by at most 0.00e0";
    assert!(stderr.contains(words), "{stderr}");
}

#[test]
fn the_first_nan_of_a_buffer_is_reported_with_its_line_frame_and_pixel() {
    let buffer = "
    void mainImage(out vec4 c, in vec2 p) {
        vec4 last = texelFetch(iChannel0, ivec2(p), 0);
        c = 0.5 * last + vec4(sqrt(p.x - float(iFrame)));
    }";
    let (shader, _) = check(buffer, SHOWN, None, "7");
    let diagnostics = shader["diagnostics"].as_array().unwrap();
    let nan = diagnostics.iter().find(|one| one["code"] == "W0607").unwrap();
    // The root of −0.5 in the first column of frame 1.
    assert_eq!(
        nan["message"],
        "18 pixels of Buffer A become NaN in frame 1, first (0, 0)"
    );
    assert_eq!((&nan["line"], &nan["column"]), (&4.into(), &31.into()), "{nan}");
    let note = nan["notes"][0].as_str().unwrap();
    assert!(
        note.ends_with("in frame 7, 126 pixels of Buffer A are NaN"),
        "{note}"
    );
    // NaN that vanishes again is no fault.
    let vanishing = buffer
        .replace("sqrt(p.x - float(iFrame))", "iFrame == 2 ? sqrt(p.x - 9.0) : 1.0")
        .replace("0.5 * last", "vec4(0.0)");
    let (shader, _) = check(&vanishing, SHOWN, None, "7");
    assert_eq!(codes(&shader), [""; 0], "{shader}");
}

#[test]
fn a_buffer_that_nothing_initializes_is_reported_unless_the_mouse_may() {
    let fading = "void mainImage(out vec4 c, in vec2 p) { c = 0.99 * texelFetch(iChannel0, ivec2(p), 0); }";
    let (shader, _) = check(fading, SHOWN, None, "7");
    assert_eq!(codes(&shader), ["W0608"]);
    let drawn = fading.replace("c = 0.99", "c = step(distance(p, iMouse.xy), 0.1) + 0.99");
    assert_ne!(drawn, fading);
    let driven = fading.replace("; }", "; if (iMouse.z > 0.0) c = vec4(1.0); }");
    assert_eq!(codes(&check(&driven, SHOWN, None, "7").0), [""; 0]);
    assert_eq!(codes(&check(&drawn, SHOWN, None, "7").0), [""; 0]);
}

#[test]
fn growth_is_reported_in_the_frames_of_an_assignment() {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    for project in ["solution", "homework/a"] {
        write(&format!("{project}/buffer-a.glsl"), LOGISTIC);
        write(&format!("{project}/image.glsl"), SHOWN);
    }
    write(
        "assignment.toml",
        "reference = \"solution\"\n[[frame]]\nframe = 5\nsize = [16, 9]\n[[frame]]\nframe = 30\nsize = [16, 9]\n",
    );
    let arguments = [
        "check",
        "homework",
        "--assignment",
        "assignment.toml",
        "--format",
        "json",
    ];
    let run = toyproof(folder.path(), &[&arguments[..], &["--device", "cpu"]].concat());
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {run:?}"));
    let shader = &report["shaders"][0];
    assert_eq!(shader["verdict"], "chaotic", "{run:?}");
    let growth = |frame: usize| shader["frames"][frame]["growth"].as_f64().unwrap();
    assert!(
        growth(0) < 1e-4 && growth(1) > 0.01,
        "{} {}",
        growth(0),
        growth(1)
    );
}

/// Checks the progressive path tracer of the course with an edit of Buffer A, in a frame.
fn check_progressive(edit: (&str, &str), flags: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let course = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl/16-progressive");
    let own = folder.path().join("own");
    fs::create_dir(&own).unwrap();
    for entry in fs::read_dir(&course).unwrap() {
        let path = entry.unwrap().path();
        let mut text = fs::read_to_string(&path).unwrap();
        if path.ends_with("buffer-a.glsl") {
            assert!(text.contains(edit.0), "{}", edit.0);
            text = text.replace(edit.0, edit.1);
        }
        fs::write(own.join(path.file_name().unwrap()), text).unwrap();
    }
    let fixed = [
        "check",
        "own",
        "--scene",
        "16-progressive",
        "--device",
        "cpu",
        "--format",
        "json",
    ];
    let run = toyproof(folder.path(), &[&fixed[..], flags].concat());
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {run:?}"));
    report["shaders"][0].clone()
}

#[test]
fn a_progressive_path_tracer_agrees_with_its_scene_in_every_frame() {
    // Without a frame, as many as the scene has samples.
    for flags in [
        &["--size", "48x27"][..],
        &["--size", "48x27", "--frame", "0"],
        &["--size", "48x27", "--frame", "21"],
    ] {
        let shader = check_progressive(("", ""), flags);
        assert_eq!(shader["verdict"], "correct", "{flags:?} {shader}");
        assert_eq!(shader["algorithm"]["differing"], 0, "{flags:?}");
    }
    let frames = check_progressive(("", ""), &["--size", "48x27"])["growth"]["frames"].clone();
    assert_eq!(frames.as_array().unwrap().len(), 16);
}

/// Other random numbers, the same in expectation.
const OTHER_NUMBERS: (&str, &str) = (
    "startSample(fragCoord, iFrame)",
    "startSample(fragCoord, 7 * iFrame + 1000)",
);

#[test]
fn a_progressive_path_tracer_with_other_random_numbers_is_compared_by_its_mean() {
    let shader = check_progressive(OTHER_NUMBERS, &["--size", "160x90", "--frame", "15"]);
    assert_eq!(shader["verdict"], "correct", "{shader}");
    let reason = shader["reason"].as_str().unwrap();
    assert!(reason.starts_with("the mean of"), "{reason}");
    let brighter = format!("{}; spheres[1].color *= 1.2", OTHER_NUMBERS.1);
    // With fewer samples, the difference of a sphere could be noise that neighbors share.
    let shader = check_progressive(
        (OTHER_NUMBERS.0, &brighter),
        &["--size", "160x90", "--frame", "63"],
    );
    assert_eq!(shader["verdict"], "wrong", "{shader}");
    assert!(
        shader["details"]
            .to_string()
            .contains("means were compared instead"),
        "{shader}"
    );
}

#[test]
fn mistakes_of_a_progressive_path_tracer_are_wrong() {
    for edit in [
        // The first sample is lost.
        ("iFrame == 0 ? vec4(0.0)", "iFrame <= 1 ? vec4(0.0)"),
        ("throughput *= albedo", "throughput *= albedo * facing"),
        ("vec4(color, 1.0)", "vec4(color, 1.1)"),
        // A moving average instead of the mean.
        (
            "sum = previous + vec4(color, 1.0)",
            "sum = mix(previous, vec4(color, 1.0), 0.1)",
        ),
    ] {
        let shader = check_progressive(edit, &["--size", "48x27"]);
        assert_eq!(shader["verdict"], "wrong", "{edit:?} {}", shader["reason"]);
    }
}

/// Writes a project that spreads the digits of Buffer B, which loses them in its only frame, through Buffer A.
fn write_spreading(folder: &Path) {
    let files = [
        ("image.glsl", "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p).yx, 0); }"),
        // From left to right, one texel per frame.
        (
            "buffer-a.glsl",
            "void mainImage(out vec4 c, in vec2 p) {
                ivec2 q = ivec2(p);
                c = q.x == 0 ? texelFetch(iChannel1, ivec2(3, 2), 0) : texelFetch(iChannel0, q - ivec2(1, 0), 0);
            }",
        ),
        (
            "buffer-b.glsl",
            "void mainImage(out vec4 c, in vec2 p) {
                float x = 1.0e6 + 0.1 * p.x;
                c = vec4(x - 1.0e6);
            }",
        ),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
}

#[test]
fn debug_follows_a_difference_back_through_passes_and_frames() {
    let folder = tempfile::tempdir().unwrap();
    write_spreading(folder.path());
    let debug = |flags: &[&str]| {
        let fixed = ["debug", ".", "--size", "8x8", "--frame", "9"];
        let run = toyproof(folder.path(), &[&fixed[..], flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stdout
    };
    let json: Value = serde_json::from_str(&debug(&["--pixel", "5,2", "--format", "json"])).unwrap();
    let hops: Vec<_> = json["trail"]
        .as_array()
        .unwrap()
        .iter()
        .map(|hop| {
            let pass = hop["pass"].as_str().unwrap();
            (
                hop["frame"].as_i64().unwrap(),
                pass.to_owned(),
                hop["pixel"].clone(),
            )
        })
        .collect();
    let hop = |frame, pass: &str, x: u32, y: u32| (frame, pass.to_owned(), serde_json::json!([x, y]));
    // Image (5, 2) reads A (2, 5), two frames after A (0, 5), which reads Buffer B of the frame before.
    let expected = [
        hop(9, "Image", 5, 2),
        hop(9, "Buffer A", 2, 5),
        hop(8, "Buffer A", 1, 5),
        hop(7, "Buffer A", 0, 5),
        hop(6, "Buffer B", 3, 2),
    ];
    assert_eq!(hops, expected);
    assert_eq!(json["trail_cut"], false);
    // The pass in which it arises shows the line.
    let text = debug(&["--pixel", "3,2", "--pass", "buffer-b"]);
    assert!(text.contains("float x = 1.0e6 + 0.1 * p.x"), "{text}");
    assert!(text.contains("      9  Buffer B         (3, 2)"), "{text}");
    let refused = toyproof(
        folder.path(),
        &["debug", ".", "--pixel", "0,0", "--pass", "buffer-d"],
    );
    assert!(
        refused.stderr.contains("there is no Buffer D"),
        "{}",
        refused.stderr
    );
}
