//! Shaders of ISF with several passes: buffers of sizes of their own, more than four of them, and what a pass
//! may read.

use std::fs;
use std::path::Path;

use serde_json::Value;
use toyproof::image::{self, Image};

use crate::program::{Run, toyproof};
use crate::requirements::require_driver;

/// A buffer of a quarter of the width and half of the height, which adds up the centers of its pixels.
const SUMS: &str = "/*{ \"ISFVSN\": \"2\",
    \"INPUTS\": [{ \"NAME\": \"part\", \"TYPE\": \"float\", \"DEFAULT\": 0.3 }],
    \"PASSES\": [
        { \"TARGET\": \"sums\", \"WIDTH\": \"floor($WIDTH * $part)\", \"HEIGHT\": \"$HEIGHT / 2.0\", \"PERSISTENT\": true, \"FLOAT\": true },
        {} ] }*/
void main() {
    if (PASSINDEX == 0) gl_FragColor = vec4(gl_FragCoord.xy, RENDERSIZE.x, 1) + IMG_THIS_PIXEL(sums);
    else gl_FragColor = vec4(IMG_PIXEL(sums, vec2(1.5, 0.5)).xy, IMG_SIZE(sums).x + IMG_NORM_PIXEL(sums, vec2(0.5)).x, IMG_SIZE(sums).y);
}
";

fn write(folder: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
}

/// Runs a command in a size of 8×6, and asserts that it succeeds.
fn succeeds(folder: &Path, arguments: &[&str]) -> Run {
    let run = toyproof(folder, &[arguments, &["--size", "8x6"]].concat());
    assert_eq!(run.code, 0, "{run:?}");
    run
}

/// Renders an image of 8×6 pixels as EXR.
fn render(folder: &Path, arguments: &[&str]) -> Image {
    succeeds(folder, &[&["run"], arguments, &["-o", "out.exr"]].concat());
    image::read(&folder.join("out.exr")).unwrap()
}

/// Checks without a GPU, and returns the JSON of the only shader.
fn check(folder: &Path, arguments: &[&str]) -> Value {
    let common = ["--size", "8x6", "--device", "cpu", "--format", "json"];
    let run = toyproof(folder, &[&["check"], arguments, &common].concat());
    let json: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    json["shaders"][0].clone()
}

/// The devices of this machine.
fn devices() -> Vec<&'static str> {
    let driver = require_driver().then_some("lavapipe");
    driver.into_iter().chain(["cpu"]).collect()
}

#[test]
fn a_buffer_has_its_own_size_in_its_pass_and_for_those_that_read_it() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &[("a.fs", SUMS)]);
    for device in devices() {
        let device = ["--device", device, "--frame", "2"];
        // floor(8 · 0.3) × 6 / 2, after three frames.
        let buffer = render(
            folder.path(),
            &[&["a.fs", "--pass", "buffer-a"], &device[..]].concat(),
        );
        assert_eq!(buffer.size(), [2, 3]);
        for (x, y) in (0..3).flat_map(|y| [(0, y), (1, y)]) {
            let expected = [x as f32 + 0.5, y as f32 + 0.5, 2.0].map(|sum| 3.0 * sum);
            assert_eq!(buffer.get(x, y)[..3], expected, "{device:?}");
        }
        // The texel (1, 0); two columns; and the middle between two texels, 3 · (0.5 + 1.5) / 2.
        let image = render(folder.path(), &[&["a.fs"], &device[..]].concat());
        assert_eq!(image.size(), [8, 6]);
        assert!(
            image.pixels().iter().all(|pixel| pixel[..3] == [4.5, 1.5, 5.0]),
            "{:?}",
            image.get(0, 0)
        );
        // The size follows from the value of an input.
        let wider = [
            &["a.fs", "--pass", "buffer-a", "--uniform", "part=0.9"],
            &device[..],
        ]
        .concat();
        assert_eq!(render(folder.path(), &wider).size(), [7, 3]);
    }
}

#[test]
fn a_buffer_of_its_own_size_is_resumed_traced_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &[("a.fs", SUMS)]);
    let whole = render(folder.path(), &["a.fs", "--device", "cpu", "--frame", "3"]);
    let state = folder.path().join("sums.state");
    let resumed = |frame| {
        let flags = [
            "a.fs",
            "--device",
            "cpu",
            "--frame",
            frame,
            "--state",
            "sums.state",
        ];
        render(folder.path(), &flags)
    };
    resumed("1");
    let saved = fs::read(&state).unwrap();
    assert_eq!(resumed("3"), whole);
    // The second texel, which the image shows in red: what was saved is what is added to.
    let texel = |red: f32| [red, 1.0, 4.0, 2.0].map(f32::to_le_bytes).concat();
    let at = saved.windows(16).position(|bytes| bytes == texel(3.0)).unwrap();
    let changed = [&saved[..at], &texel(103.0), &saved[at + 16..]].concat();
    fs::write(&state, changed).unwrap();
    assert_eq!(resumed("3").get(0, 0)[0], whole.get(0, 0)[0] + 100.0);
    // The pixel is one of the buffer, not of the image.
    let debug = |pixel| {
        toyproof(
            folder.path(),
            &[
                "debug", "a.fs", "--pass", "buffer-a", "--pixel", pixel, "--frame", "1", "--size", "8x6",
            ],
        )
    };
    let trace = debug("1,2");
    assert!(trace.stdout.contains("gl_FragColor = (3, 5, 4, 2)"), "{trace:?}");
    let outside = debug("2,2");
    assert!(
        outside
            .stderr
            .contains("pixel (2, 2) is outside Buffer A of 2x3 pixels"),
        "{outside:?}"
    );
    // Colors are compared from 0 to 1.
    let divided = SUMS.replace("else gl_FragColor =", "else gl_FragColor = 0.01 *");
    assert_ne!(divided, SUMS);
    let same = "void mainImage(out vec4 c, in vec2 p) {
    float frames = float(iFrame + 1);
    c = 0.01 * vec4(1.5 * frames, 0.5 * frames, 2.0 + frames, 3.0);
}
";
    write(folder.path(), &[("a.fs", &divided), ("same.glsl", same)]);
    let report = check(
        folder.path(),
        &["a.fs", "--reference", "same.glsl", "--frame", "2"],
    );
    assert_eq!(report["verdict"], "correct", "{report}");
    // A buffer of another size is not compared with this one.
    let other = divided.replace("0.3", "0.9");
    write(folder.path(), &[("b.fs", &other)]);
    let report = check(folder.path(), &["a.fs", "--reference", "b.fs", "--frame", "2"]);
    assert_eq!(report["verdict"], "wrong", "{report}");
    assert!(!report.to_string().contains("Buffer A"), "{report}");
}

/// Seven passes: six buffers, of one texel each, of which the last four are read at once.
const CHAIN: &str = "/*{ \"ISFVSN\": \"2\", \"INPUTS\": [{ \"NAME\": \"inputImage\", \"TYPE\": \"image\" }],
    \"PASSES\": [
        { \"TARGET\": \"a\", \"WIDTH\": 1, \"HEIGHT\": 1 }, { \"TARGET\": \"b\", \"WIDTH\": \"1\", \"HEIGHT\": \"1\" },
        { \"TARGET\": \"c\" }, { \"TARGET\": \"d\" }, { \"TARGET\": \"e\" }, { \"TARGET\": \"f\" }, {} ] }*/
void main() {
    vec4 part = vec4(PASSINDEX + 1) / 64.0;
    if (PASSINDEX == 0) gl_FragColor = IMG_PIXEL(inputImage, vec2(0.5)) + part;
    else if (PASSINDEX == 1) gl_FragColor = IMG_NORM_PIXEL(a, vec2(0.5)) + part;
    else if (PASSINDEX == 2) gl_FragColor = IMG_NORM_PIXEL(b, vec2(0.5)) + part;
    else if (PASSINDEX == 3) gl_FragColor = IMG_THIS_PIXEL(c) + IMG_NORM_PIXEL(a, vec2(0.5));
    else if (PASSINDEX == 4) gl_FragColor = IMG_THIS_PIXEL(d) + part;
    else if (PASSINDEX == 5) gl_FragColor = IMG_THIS_PIXEL(e) + IMG_PIXEL(inputImage, vec2(0.5));
    else gl_FragColor = vec4(IMG_THIS_PIXEL(f).r, IMG_THIS_PIXEL(e).r, IMG_THIS_PIXEL(d).r - IMG_THIS_PIXEL(c).r, 1);
}
";

#[test]
fn more_than_four_buffers_share_the_channels_that_a_pass_reads() {
    let folder = tempfile::tempdir().unwrap();
    write(
        folder.path(),
        &[
            ("a.fs", CHAIN),
            (
                "white.glsl",
                "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }\n",
            ),
        ],
    );
    succeeds(folder.path(), &["run", "white.glsl", "-o", "white.png"]);
    // In 64ths: a = 1, b = 1 + 2, c = 3 + 3, d = 6 + 1, e = 7 + 5, f = 12. White adds 64 wherever the image is
    // read: once to a, b and c, twice to d and e, and three times to f.
    let colors = [
        (None, [12.0, 12.0, 1.0]),
        (Some("white.png"), [204.0, 140.0, 65.0]),
    ];
    for device in devices() {
        for (input, expected) in colors {
            let mut arguments = vec!["a.fs", "--device", device];
            arguments.extend(input.into_iter().flat_map(|file| ["--channel0", file]));
            let image = render(folder.path(), &arguments);
            let expected = expected.map(|part: f32| part / 64.0);
            assert!(
                image.pixels().iter().all(|pixel| pixel[..3] == expected),
                "{:?}",
                image.get(0, 0)
            );
        }
    }
    let sixth = render(folder.path(), &["a.fs", "--pass", "buffer-f", "--device", "cpu"]);
    assert_eq!(sixth.get(7, 5)[0], 12.0 / 64.0);
    // Without branches, the seventh pass reads all.
    let all = CHAIN.replace(
        "else gl_FragColor = vec4(",
        "gl_FragColor += IMG_THIS_PIXEL(b) * vec4(",
    );
    write(folder.path(), &[("a.fs", &all)]);
    let refused = toyproof(folder.path(), &["run", "a.fs", "-o", "a.png"]);
    assert!(
        refused.stderr.contains("a.fs:3:9")
            && refused.stderr.contains("reads more than 4 images and buffers"),
        "{refused:?}"
    );
}

/// A chain of buffers of odd sizes, which are interpolated, and one that feeds back.
const BLUR: &str = "/*{ \"ISFVSN\": \"2\", \"PASSES\": [
    { \"TARGET\": \"wave\" }, { \"TARGET\": \"third\", \"WIDTH\": \"$WIDTH / 3\", \"HEIGHT\": \"max($HEIGHT / 3, 2)\" },
    { \"TARGET\": \"fifth\", \"WIDTH\": \"$WIDTH / 5\", \"HEIGHT\": 3 },
    { \"TARGET\": \"trail\", \"WIDTH\": \"$WIDTH * 1.7\", \"PERSISTENT\": true }, {} ] }*/
void main() {
    vec2 at = isf_FragNormCoord;
    if (PASSINDEX == 0) gl_FragColor = vec4(sin(gl_FragCoord.xy * 0.7 + TIME), sqrt(at.x), 1);
    else if (PASSINDEX == 1) gl_FragColor = IMG_NORM_PIXEL(wave, at * 0.9);
    else if (PASSINDEX == 2) gl_FragColor = IMG_NORM_PIXEL(third, at + 0.01);
    else if (PASSINDEX == 3) gl_FragColor = mix(IMG_NORM_PIXEL(fifth, at), IMG_NORM_PIXEL(trail, at * 1.01), 0.8);
    else gl_FragColor = IMG_THIS_PIXEL(trail) + 0.1 * IMG_PIXEL(third, gl_FragCoord.xy / 3.0);
}
";

#[test]
fn the_driver_has_the_bits_of_the_evaluator_in_buffers_of_any_size() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &[("a.fs", BLUR)]);
    if !require_driver() {
        return;
    }
    for pass in ["image", "buffer-b", "buffer-c", "buffer-d"] {
        let [driver, evaluator] = ["lavapipe", "cpu"].map(|device| {
            render(
                folder.path(),
                &["a.fs", "--frame", "5", "--pass", pass, "--device", device],
            )
        });
        let varied = evaluator
            .pixels()
            .iter()
            .any(|pixel| pixel != &evaluator.pixels()[0]);
        assert!(varied && driver == evaluator, "{pass}");
    }
}

#[test]
fn a_buffer_that_does_not_persist_is_cleared_before_each_frame() {
    // The second shader discards all pixels but in frame 0, so that what persists is two frames old.
    for (body, cleared, kept) in [
        (
            "gl_FragColor = IMG_THIS_PIXEL(b) + (PASSINDEX == 0 ? 0.25 : 0.0);",
            0.25,
            0.75,
        ),
        (
            "if (PASSINDEX == 0) { if (FRAMEINDEX > 0) discard; gl_FragColor = vec4(0.5); } else gl_FragColor = IMG_THIS_PIXEL(b);",
            0.0,
            0.5,
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        for (name, key, expected) in [("a.fs", "", cleared), ("b.fs", ", \"PERSISTENT\": true", kept)] {
            let header =
                format!("/*{{ \"ISFVSN\": \"2\", \"PASSES\": [{{ \"TARGET\": \"b\"{key} }}, {{}}] }}*/");
            let text = format!("{header}\nvoid main() {{ {body} }}\n");
            write(folder.path(), &[(name, &text)]);
            for device in devices() {
                let image = render(folder.path(), &[name, "--frame", "2", "--device", device]);
                assert_eq!(image.get(3, 3)[0], expected, "{text} {device}");
            }
        }
    }
}

#[test]
fn buffers_of_other_sizes_are_not_compared_and_all_have_a_limit() {
    let folder = tempfile::tempdir().unwrap();
    let shader = |width: &str, offset: &str| {
        format!(
            "/*{{ \"ISFVSN\": \"2\", \"PASSES\": [{{ \"TARGET\": \"line\", \"WIDTH\": \"{width}\" }}, {{}}] }}*/
void main() {{ gl_FragColor = PASSINDEX == 0 ? vec4(gl_FragCoord.x) : vec4({offset}) + 0.0 * IMG_THIS_PIXEL(line); }}
"
        )
    };
    write(
        folder.path(),
        &[
            ("a.fs", &shader("2", "0.5")),
            ("b.fs", &shader("$WIDTH * 2", "0.5")),
            ("c.fs", &shader("$WIDTH * 2", "0.25")),
        ],
    );
    for (other, code) in [("b.fs", 0), ("c.fs", 1)] {
        let run = toyproof(folder.path(), &["compare", "a.fs", other, "--size", "8x6"]);
        assert_eq!(run.code, code, "{other}: {}{}", run.stdout, run.stderr);
        assert!(!run.stdout.contains("in Buffer A"), "{}", run.stdout);
    }
    let large = "/*{ \"ISFVSN\": \"2\", \"PASSES\": [
    { \"TARGET\": \"a\", \"WIDTH\": 8192, \"HEIGHT\": 4000 }, { \"TARGET\": \"b\", \"WIDTH\": 4000, \"HEIGHT\": 8192 }, {}] }*/
void main() { gl_FragColor = IMG_THIS_PIXEL(a) + IMG_THIS_PIXEL(b); }
";
    write(folder.path(), &[("large.fs", large)]);
    let run = toyproof(
        folder.path(),
        &["run", "large.fs", "--size", "8x6", "-o", "large.png"],
    );
    assert!(
        run.code != 0 && run.stderr.contains("the buffers have 65,536,000 pixels together"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_buffer_that_is_rendered_last_is_shown_in_the_size_of_the_image() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "/*{ \"ISFVSN\": \"2\", \"PASSES\": [{ \"TARGET\": \"small\", \"WIDTH\": \"$WIDTH / 4\", \"HEIGHT\": 1 }] }*/
void main() { gl_FragColor = vec4(gl_FragCoord.xy, RENDERSIZE); }
";
    write(folder.path(), &[("a.fs", shader)]);
    for device in devices() {
        let image = render(folder.path(), &["a.fs", "--device", device]);
        // Two texels, 0.5 and 1.5, which are interpolated between their centers, at 2 and 6 of 8 pixels.
        let row: Vec<f32> = (0..8).map(|x| image.get(x, 3)[0]).collect();
        assert_eq!(row, [0.5, 0.5, 0.625, 0.875, 1.125, 1.375, 1.5, 1.5], "{device}");
        assert_eq!(image.get(0, 0)[1..3], [0.5, 2.0]);
    }
}

#[test]
fn errors_of_sizes_have_a_place_and_conversion_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let with = |from: &str, to: &str| {
        assert!(SUMS.contains(from));
        write(folder.path(), &[("a.fs", &SUMS.replace(from, to))]);
    };
    let run = |arguments: &[&str]| toyproof(folder.path(), &[arguments, &["a.fs", "-o", "out"]].concat());
    for (from, to, place, message) in [
        (
            "* $part",
            "* $parts",
            "a.fs:4:54",
            "there is no input `parts` that is a number",
        ),
        ("floor(", "flor(", "a.fs:4:39", "unknown function `flor`"),
        (
            "\"$HEIGHT / 2.0\"",
            "true",
            "a.fs:4:73",
            "a size must be a number",
        ),
    ] {
        with(from, to);
        let refused = run(&["run"]);
        assert!(
            refused.code != 0 && refused.stderr.contains(place) && refused.stderr.contains(message),
            "{refused:?}"
        );
    }
    with("* $part", "* 1e9");
    let refused = run(&["run"]);
    assert!(
        refused.stderr.contains("Buffer A: image size ") && refused.stderr.contains("too large"),
        "{refused:?}"
    );
    let report = check(folder.path(), &["a.fs"]);
    assert!(report["reason"].to_string().contains("too large"), "{report}");
    write(folder.path(), &[("a.fs", SUMS)]);
    let refused = run(&["convert"]);
    assert!(
        refused.stderr.contains("Buffer A has a size of its own"),
        "{refused:?}"
    );
    let four = CHAIN
        .replace(", \"WIDTH\": 1, \"HEIGHT\": 1", "")
        .replace(", \"WIDTH\": \"1\", \"HEIGHT\": \"1\"", "");
    write(folder.path(), &[("a.fs", &four)]);
    let refused = run(&["convert"]);
    assert!(refused.stderr.contains("more than four buffers"), "{refused:?}");
}
