//! Shaders that are right but not as asked, and shaders that only look so.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use toyproof::verify::Difference;

use crate::program::{Run, toyproof};
use crate::support::{COMPLEX_SCENE, Exercise, SHADING, WHITTED};

const FLAGS: [&str; 7] = [
    "--device",
    "cpu",
    "--size",
    "64x36",
    "--search",
    "0",
    "--format=json",
];

/// Statements after which `fragColor` has a color of the exercise, whose own `mainImage` is `original`.
struct Variant {
    name: &'static str,
    body: &'static str,
    /// What is reported if the exercise's shader is the reference.
    id: Option<&'static str>,
}

const fn variant(name: &'static str, id: &'static str, body: &'static str) -> Variant {
    Variant {
        name,
        body,
        id: Some(id),
    }
}

/// A variant that is none of the differences of whole images.
const fn other(name: &'static str, body: &'static str) -> Variant {
    Variant { name, body, id: None }
}

const VARIANTS: &[Variant] = &[
    variant(
        "mirrored-x",
        "mirrored-x",
        "original(fragColor, vec2(iResolution.x - fragCoord.x, fragCoord.y));",
    ),
    variant(
        "mirrored-y",
        "mirrored-y",
        "original(fragColor, vec2(fragCoord.x, iResolution.y - fragCoord.y));",
    ),
    variant(
        "half-turn",
        "rotated",
        "original(fragColor, iResolution.xy - fragCoord);",
    ),
    variant(
        "quarter-turn",
        "rotated",
        "original(fragColor, vec2(-1, 1) * (fragCoord - 0.5 * iResolution.xy).yx + 0.5 * iResolution.xy);",
    ),
    variant(
        "transposed",
        "rotated",
        "original(fragColor, fragCoord.yx * iResolution.xy / iResolution.yx);",
    ),
    variant(
        "bgr",
        "swapped-channels",
        "original(fragColor, fragCoord); fragColor = fragColor.bgra;",
    ),
    variant(
        "divided-by-y",
        "framing",
        "original(fragColor, (fragCoord - 0.5 * iResolution.xy) * iResolution.x / iResolution.y + 0.5 * iResolution.xy);",
    ),
    variant(
        "no-aspect",
        "framing",
        "vec2 c = 0.5 * iResolution.xy; original(fragColor, (fragCoord - c) * vec2(1, iResolution.x / iResolution.y) + c);",
    ),
    variant(
        "from-0-to-1",
        "framing",
        "original(fragColor, 0.5 * fragCoord + 0.5 * iResolution.xy);",
    ),
    variant("half-a-pixel", "framing", "original(fragColor, fragCoord + 0.5);"),
    variant(
        "2x2",
        "antialiasing",
        "vec4 sum = vec4(0); for (int i = 0; i < 4; i++) { original(fragColor, fragCoord + vec2(i % 2, i / 2) / 2.0 - 0.25); \
         sum += fragColor; } fragColor = sum / 4.0;",
    ),
    variant(
        "3x3",
        "antialiasing",
        "vec4 sum = vec4(0); for (int i = 0; i < 9; i++) { original(fragColor, fragCoord + vec2(i % 3, i / 3) / 3.0 - 1.0 / 3.0); \
         sum += fragColor; } fragColor = sum / 9.0;",
    ),
    variant(
        "2x2-from-the-corner",
        "antialiasing",
        "vec4 sum = vec4(0); for (int i = 0; i < 4; i++) { original(fragColor, fragCoord + vec2(i % 2, i / 2) / 2.0 - 0.5); \
         sum += fragColor; } fragColor = sum / 4.0;",
    ),
    variant(
        "rotated-grid",
        "antialiasing",
        "vec2 offsets[4] = vec2[4](vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(-0.375, 0.125), vec2(0.125, 0.375)); \
         vec4 sum = vec4(0); for (int i = 0; i < 4; i++) { original(fragColor, fragCoord + offsets[i]); sum += fragColor; } \
         fragColor = sum / 4.0;",
    ),
    variant(
        "random-samples",
        "antialiasing",
        "vec4 sum = vec4(0); uint h = uint(fragCoord.x) * 747796405u + uint(fragCoord.y) * 2891336453u; \
         for (int i = 0; i < 16; i++) { h = h * 1664525u + 1013904223u; h = (h ^ (h >> 15)) * 2246822519u; \
         vec2 offset = vec2(h >> 16, h & 65535u) / 65536.0 - 0.5; original(fragColor, fragCoord + offset); sum += fragColor; } \
         fragColor = sum / 16.0;",
    ),
    variant(
        "gamma",
        "color-curve",
        "original(fragColor, fragCoord); fragColor.rgb = pow(fragColor.rgb, vec3(1.0 / 2.2));",
    ),
    variant(
        "reinhard",
        "color-curve",
        "original(fragColor, fragCoord); fragColor.rgb /= 1.0 + fragColor.rgb;",
    ),
    variant(
        "aces-and-gamma",
        "color-curve",
        "original(fragColor, fragCoord); vec3 c = fragColor.rgb; \
         c = clamp(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0); fragColor.rgb = pow(c, vec3(1.0 / 2.2));",
    ),
    variant(
        "contrast",
        "color-curve",
        "original(fragColor, fragCoord); fragColor.rgb = smoothstep(0.0, 1.0, fragColor.rgb);",
    ),
    variant(
        "own-curve",
        "color-curve",
        "original(fragColor, fragCoord); fragColor.rgb *= 1.4 - 0.4 * fragColor.rgb;",
    ),
    variant(
        "mouse",
        "mouse",
        "original(fragColor, fragCoord + 0.2 * (iMouse.xy - 0.5 * iResolution.xy));",
    ),
    variant(
        "resolution",
        "fixed-resolution",
        "original(fragColor, (fragCoord - vec2(320.0, 180.0)) * iResolution.x / 640.0 + 0.5 * iResolution.xy);",
    ),
    variant(
        "default",
        "default-shader",
        "vec2 uv = fragCoord / iResolution.xy; fragColor = vec4(0.5 + 0.5 * cos(iTime + uv.xyx + vec3(0, 2, 4)), 1.0);",
    ),
    other(
        "blur",
        "vec4 sum = vec4(0); for (int i = 0; i < 9; i++) { original(fragColor, fragCoord + vec2(i % 3, i / 3) - 1.0); \
         sum += fragColor; } fragColor = sum / 9.0;",
    ),
    other(
        "tent",
        "vec4 sum = vec4(0); for (int i = 0; i < 81; i++) { original(fragColor, fragCoord + vec2(i % 9, i / 9) / 4.0 - 1.0); \
         sum += fragColor; } fragColor = sum / 81.0;",
    ),
    other("shifted", "original(fragColor, fragCoord + vec2(0.3, 0.2));"),
    other(
        "gradient",
        "original(fragColor, fragCoord); fragColor.rgb += 0.02 * fragCoord.x / iResolution.x;",
    ),
    other(
        "vignette",
        "original(fragColor, fragCoord); fragColor.rgb *= 1.0 - 0.3 * length(fragCoord / iResolution.xy - 0.5);",
    ),
    other(
        "half-gamma",
        "original(fragColor, fragCoord); if (fragCoord.x < 0.5 * iResolution.x) fragColor.rgb = sqrt(fragColor.rgb);",
    ),
    other(
        "one-channel",
        "original(fragColor, fragCoord); fragColor.g = sqrt(fragColor.g);",
    ),
    other(
        "tint",
        "original(fragColor, fragCoord); fragColor.rgb *= vec3(0.9, 0.8, 1.0);",
    ),
    other(
        "half-mirrored",
        "original(fragColor, vec2(fragCoord.x < 0.5 * iResolution.x ? iResolution.x - fragCoord.x : fragCoord.x, fragCoord.y));",
    ),
    other(
        "other-mouse",
        "original(fragColor, fragCoord + 0.2 * (iMouse.xy - 0.3 * iResolution.xy));",
    ),
];

fn variant_of(shader: &str, body: &str) -> String {
    let original = shader.replace("mainImage", "original");
    format!("{original}\nvoid mainImage(out vec4 fragColor, in vec2 fragCoord) {{ {body} }}\n")
}

/// A folder with all variants of an exercise in `shaders`, its own shader, and its scene.
fn folder(exercise: &Exercise) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("shaders")).unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("solution.glsl", exercise.shader);
    write("scene.toml", exercise.scene);
    for variant in VARIANTS {
        let text = variant_of(exercise.shader, variant.body);
        write(&format!("shaders/{}.glsl", variant.name), &text);
    }
    folder
}

fn check(folder: &Path, arguments: &[&str]) -> Run {
    toyproof(folder, &[&["check"], arguments, &FLAGS].concat())
}

/// The record of each shader, by the stem of its file.
fn records(run: &Run) -> BTreeMap<String, Value> {
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    let shaders = report["shaders"].as_array().unwrap().iter();
    let stem = |record: &Value| {
        let path = Path::new(record["shader"].as_str().unwrap());
        path.file_stem().unwrap().to_str().unwrap().to_owned()
    };
    shaders.map(|record| (stem(record), record.clone())).collect()
}

fn is_of_whole_image(id: &str) -> bool {
    Difference::ALL.iter().any(|difference| difference.id() == id)
        || ["wrong-scene", "default-shader"].contains(&id)
}

#[test]
fn differences_from_a_reference_shader_are_named() {
    for exercise in [&SHADING, &WHITTED] {
        let folder = folder(exercise);
        let records = records(&check(
            folder.path(),
            &["shaders", "--reference", "solution.glsl"],
        ));
        for variant in VARIANTS {
            let record = &records[variant.name];
            assert_eq!(record["verdict"], "wrong", "{}", variant.name);
            let id = record["mistake"]["id"].as_str();
            assert_eq!(id, variant.id, "{}: {}", variant.name, record["mistake"]);
        }
    }
}

/// What is reported of a scene is more specific where the catalogue has the mistake.
#[test]
fn differences_from_a_scene_are_named() {
    let known = BTreeMap::from([
        ("mirrored-x", "mirrored"),
        ("mirrored-y", "upside-down"),
        ("bgr", "red-blue-swapped"),
        ("no-aspect", "no-aspect"),
        ("from-0-to-1", "not-centered"),
        ("half-a-pixel", "half-pixel-twice"),
        ("gamma", "extra-gamma"),
        ("reinhard", "extra-tone-map"),
    ]);
    let folder = folder(&COMPLEX_SCENE);
    let records = records(&check(folder.path(), &["shaders", "--scene", "scene.toml"]));
    for variant in VARIANTS {
        let record = &records[variant.name];
        let id = record["mistake"]["id"].as_str();
        match variant.id {
            Some(own) => {
                let expected = known.get(variant.name).copied().unwrap_or(own);
                assert_eq!(id, Some(expected), "{}: {}", variant.name, record["mistake"]);
            }
            None => assert!(
                !id.is_some_and(is_of_whole_image),
                "{}: {}",
                variant.name,
                record["mistake"]
            ),
        }
    }
}

#[test]
fn another_scene_is_named_whether_built_in_or_beside_the_given_one() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("shader.glsl", SHADING.shader);
    write("asked.toml", WHITTED.scene);
    let text = || {
        let records = records(&check(folder.path(), &["shader.glsl", "--scene", "asked.toml"]));
        assert_eq!(records["shader"]["mistake"]["id"], "wrong-scene");
        records["shader"]["mistake"]["text"].as_str().unwrap().to_owned()
    };
    assert_eq!(text(), "the image agrees with another scene, 03-shading");
    write("third-task.toml", SHADING.scene);
    assert_eq!(text(), "the image agrees with another scene, third-task");
}

#[test]
fn only_permitted_differences_are_accepted() {
    let folder = folder(&COMPLEX_SCENE);
    let permit = ["--permit", "antialiasing,color-curve", "--permit", "mirrored-x"];
    let names = [
        "2x2",
        "random-samples",
        "own-curve",
        "mirrored-x",
        "mirrored-y",
        "blur",
        "tint",
    ];
    let shaders = names.map(|name| format!("shaders/{name}.glsl"));
    for reference in [["--scene", "scene.toml"], ["--reference", "solution.glsl"]] {
        let mut arguments: Vec<&str> = shaders.iter().map(String::as_str).collect();
        arguments.extend(reference.iter().chain(&permit));
        for (name, record) in records(&check(folder.path(), &arguments)) {
            let variant = VARIANTS.iter().find(|variant| variant.name == name).unwrap();
            let permitted = ["antialiasing", "color-curve", "mirrored-x"].into_iter();
            let Some(id) = permitted.into_iter().find(|&id| variant.id == Some(id)) else {
                assert_eq!(record["verdict"], "wrong", "{name}");
                continue;
            };
            assert_eq!(record["verdict"], "correct", "{name}: {record}");
            assert!(record["mistake"].is_null());
            let reason = record["reason"].as_str().unwrap();
            assert!(
                reason.contains(&format!("but for `{id}`, which is permitted")),
                "{reason}"
            );
        }
    }
}

#[test]
fn a_permitted_difference_excuses_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let wrong = SHADING
        .shader
        .replace("vec3(0.9, 0.6, 0.2)", "vec3(0.9, 0.6, 0.3)");
    assert_ne!(wrong, SHADING.shader);
    let both = VARIANTS.iter().find(|variant| variant.name == "2x2").unwrap();
    write("shader.glsl", &variant_of(&wrong, both.body));
    write("scene.toml", SHADING.scene);
    let permit = ["shader.glsl", "--scene", "scene.toml", "--permit", "antialiasing"];
    assert_eq!(
        records(&check(folder.path(), &permit))["shader"]["verdict"],
        "wrong"
    );
    let run = check(folder.path(), &["shader.glsl", "--permit", "blur"]);
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("expected one of mirrored-x, "), "{run:?}");
}

#[test]
fn a_frame_number_in_place_of_the_time_is_named() {
    let disk = |position: &str| {
        format!(
            "void mainImage(out vec4 fragColor, in vec2 fragCoord) {{
    vec2 p = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    float x = {position};
    fragColor = vec4(length(p - vec2(sin(x), 0.2 * cos(3.0 * x))) < 0.6 ? vec3(1.0, 0.75, 0.0) : vec3(0.1 + 0.1 * p, 0.25), 1.0);
}}
"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("time.glsl", &disk("iTime"));
    write("sixtieth.glsl", &disk("float(iFrame) / 60.0"));
    write("number.glsl", &disk("float(iFrame)"));
    write("date.glsl", &disk("iDate.w"));
    write("half.glsl", &disk("0.5 * iTime"));
    let shaders = ["sixtieth.glsl", "number.glsl", "date.glsl", "half.glsl"];
    let moment = ["--reference", "time.glsl", "--time", "2", "--frame", "7"];
    let records = records(&check(folder.path(), &[&shaders[..], &moment].concat()));
    let text = |name: &str| {
        records[name]["mistake"]["text"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    };
    assert!(
        text("sixtieth").starts_with("the time is computed from `iFrame`"),
        "{}",
        text("sixtieth")
    );
    assert!(
        text("number").contains("is used as the time in seconds"),
        "{}",
        text("number")
    );
    assert!(
        text("date").starts_with("the time is read from `iDate`"),
        "{}",
        text("date")
    );
    assert_eq!(text("half"), "");
}

#[test]
fn the_line_of_a_written_resolution_is_reported() {
    let folder = folder(&SHADING);
    let run = check(
        folder.path(),
        &["shaders/resolution.glsl", "--reference", "solution.glsl"],
    );
    let records = records(&run);
    let text = records["resolution"]["mistake"]["text"].as_str().unwrap();
    let line = SHADING.shader.lines().count() + 2;
    assert!(text.ends_with(&format!("(line {line})")), "{text}");
}

#[test]
fn where_nothing_was_compared_nothing_is_green() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.glsl", "b.glsl"] {
        fs::write(folder.path().join(name), SHADING.shader).unwrap();
    }
    let run = toyproof(
        folder.path(),
        &[
            "check", "a.glsl", "b.glsl", "--device", "cpu", "--size", "16x9", "--out", "out", "--color",
            "always",
        ],
    );
    assert_eq!(run.code, 0, "{run:?}");
    assert!(
        !run.stdout.contains("\u{1b}[32m") && !run.stdout.contains("\u{1b}[1m\u{1b}[32m"),
        "{run:?}"
    );
    assert!(
        run.stderr.contains("nothing was compared for 2 shaders"),
        "{run:?}"
    );
    let report = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    assert!(report("report.html").contains("Nothing was compared for 2 shaders"));
    assert!(report("junit.xml").contains("skipped=\"2\""));
}
