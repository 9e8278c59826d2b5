//! Projects of several tabs on the command line.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use toyproof::image;

use crate::program::{Run, toyproof};
use crate::requirements::require_driver;
use crate::support::SPHERE;

/// An image that uses a function and a macro of Common, with line ends and characters that must survive.
const IMAGE: &str = "// \u{e9}\tx\r\nvoid mainImage(out vec4 c, in vec2 p)\n{\n    c = vec4(half_of(p.x / iResolution.x), PHASE, 0.0, 1.0);\n}\n";
const COMMON: &str = "#define PHASE fract(iTime)\nfloat half_of(float x) { return 0.5 * x; }";
const SOUND: &str = "vec2 mainSound(int samp, float time) { return vec2(sin(6.2831 * 440.0 * time)); }";
const BUFFER: &str =
    "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + PHASE; }";

fn write(folder: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// The JSON of a project in the variant of the site's pages.
fn page(passes: &Value) -> Value {
    json!({"ver": "0.1", "info": {"id": "x", "name": "Test", "likes": 3, "parentid": null}, "renderpass": passes})
}

fn pass(kind: &str, id: &str, code: &str) -> Value {
    json!({"inputs": [], "outputs": [{"id": id, "channel": 0}], "code": code, "name": "", "description": "", "type": kind})
}

/// A pass that reads Buffer A.
fn reader(kind: &str, id: &str, code: &str) -> Value {
    let mut pass = pass(kind, id, code);
    pass["inputs"] = json!([{
        "id": "4dXGR8", "filepath": "/media/previz/buffer00.png", "previewfilepath": "/media/previz/buffer00.png",
        "type": "buffer", "channel": 0, "published": 1,
        "sampler": {"filter": "linear", "wrap": "clamp", "vflip": "true", "srgb": "false", "internal": "byte"},
    }]);
    pass
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// The only shader of `check --format json` on the CPU.
fn verdict(folder: &Path, arguments: &[&str]) -> (Run, Value) {
    let flags = ["--device", "cpu", "--size", "32x18", "--format", "json"];
    let run = toyproof(folder, &[&["check"], arguments, &flags].concat());
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {run:?}"));
    let shader = report["shaders"][0].clone();
    (run, shader)
}

#[test]
fn export_is_the_inverse_of_import() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let passes = json!([
        reader("image", "4dfGRr", IMAGE),
        pass("common", "", COMMON),
        reader("buffer", "4dXGR8", BUFFER),
        pass("sound", "XsfGRr", SOUND),
    ]);
    let project = page(&passes);
    for (name, json) in [
        ("page", project.clone()),
        ("array", json!([project])),
        ("api", json!({"Shader": project})),
    ] {
        let before = format!("{name}.json");
        write(folder, &[(&before, &json.to_string())]);
        assert_eq!(toyproof(folder, &["import", &before, "-o", name]).code, 0);
        for (file, code) in [
            ("image", IMAGE),
            ("common", COMMON),
            ("buffer-a", BUFFER),
            ("sound", SOUND),
        ] {
            assert_eq!(text(folder, &format!("{name}/{file}.glsl")), code);
        }
        let after = format!("{name}-again.json");
        assert_eq!(toyproof(folder, &["export", name, "-o", &after]).code, 0);
        let again: Value = serde_json::from_str(&text(folder, &after)).unwrap();
        assert_eq!(again, json);
    }
    let again = toyproof(folder, &["import", "page.json", "-o", "page"]);
    assert_eq!(again.code, 2);
    assert!(
        again
            .stderr
            .contains("page/project.toml already exists; nothing was written"),
        "{}",
        again.stderr
    );
    // A file of another tab is not mixed with the imported ones.
    write(folder, &[("other/cube-a.glsl", "")]);
    assert_eq!(toyproof(folder, &["import", "page.json", "-o", "other"]).code, 2);
    assert!(!folder.join("other/image.glsl").exists());
}

#[test]
fn a_shader_is_exported_as_an_image() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("s.glsl", SPHERE.shader)]);
    assert_eq!(toyproof(folder, &["export", "s.glsl", "-o", "s.json"]).code, 0);
    let json: Value = serde_json::from_str(&text(folder, "s.json")).unwrap();
    assert_eq!(json["renderpass"][0]["code"], SPHERE.shader);
    assert_eq!(json["renderpass"][0]["type"], "image");
    assert_eq!(json["ver"], "0.1");
}

#[test]
fn the_template_is_checked_rendered_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    assert_eq!(toyproof(folder, &["new", "project", "waves"]).code, 0);
    let (run, shader) = verdict(folder, &["waves"]);
    assert_eq!((run.code, &shader["verdict"]), (0, &json!("ok")), "{run:?}");
    assert_eq!(shader["diagnostics"], json!([]), "no warnings");
    assert_eq!(toyproof(folder, &["export", "waves", "-o", "waves.json"]).code, 0);
    assert_eq!(verdict(folder, &["waves.json"]).1["verdict"], "ok");
    assert_eq!(
        toyproof(folder, &["new", "project", "waves"]).code,
        2,
        "nothing is overwritten"
    );
    let left_out = toyproof(folder, &["similar", "waves", "waves.json"]);
    let reason = "waves is not compared: the image reads Buffer A, which this command does not render";
    assert!(left_out.stderr.contains(reason), "{}", left_out.stderr);
}

#[test]
fn frames_of_a_project_follow_from_those_before() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    assert_eq!(toyproof(folder, &["new", "project", "waves"]).code, 0);
    let run = |output: &str, flags: &[&str]| {
        let fixed = ["run", "waves", "--size", "16x9", "-o", output];
        let run = toyproof(folder, &[&fixed, flags].concat());
        assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
        run
    };
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    run("5.exr", &["--frame", "5", "--device", "cpu"]);
    if require_driver() {
        run("driver.exr", &["--frame", "5", "--device", "lavapipe"]);
        assert_eq!(bytes("driver.exr"), bytes("5.exr"));
    }
    // The number of samples is in the alpha of the buffer; it does not depend on the precision.
    for precision in ["f32", "f64"] {
        run(
            "sum.exr",
            &[
                "--time",
                "0.0834",
                "--pass",
                "buffer-a",
                "--precision",
                precision,
                "--device",
                "cpu",
            ],
        );
        let sum = image::read(&folder.join("sum.exr")).unwrap();
        assert!(
            sum.pixels().iter().all(|pixel| pixel[3] == 6.0),
            "{:?}",
            sum.get(0, 0)
        );
    }
    run("all.exr", &["--frames", "4..6", "--device", "cpu"]);
    assert_eq!(bytes("all-0005.exr"), bytes("5.exr"));
    // The frame of a project is not that of the next shader.
    write(
        folder,
        &[(
            "time.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(iTime, iFrame, 0, 1); }",
        )],
    );
    let both = [
        "run",
        "waves",
        "time.glsl",
        "-o",
        "both",
        "--size",
        "2x2",
        "--time",
        "0.5",
        "--device",
        "cpu",
    ];
    assert_eq!(toyproof(folder, &both).code, 0);
    let time = image::read(&folder.join("both/time.png")).unwrap();
    assert_eq!(time.get(0, 0)[..2], [128.0 / 255.0, 0.0]);
    // A state goes on where it was written, also by another device.
    let state = ["--state", "waves.state"];
    let confirmed = run(
        "2.exr",
        &[&["--frame", "2", "--device", "cpu"][..], &state].concat(),
    );
    assert!(confirmed.stderr.contains("waves.state"), "{}", confirmed.stderr);
    let other = if require_driver() { "lavapipe" } else { "cpu" };
    run(
        "5-again.exr",
        &[&["--frame", "5", "--device", other][..], &state].concat(),
    );
    assert_eq!(bytes("5-again.exr"), bytes("5.exr"));
}

#[test]
fn a_project_is_a_reference_for_others() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let homework = folder.join("homework");
    fs::create_dir(&homework).unwrap();
    for (folder, name) in [(folder, "solution"), (&homework, "right"), (&homework, "wrong")] {
        assert_eq!(toyproof(folder, &["new", "project", name]).code, 0);
    }
    let buffer = folder.join("homework/wrong/buffer-a.glsl");
    let text = fs::read_to_string(&buffer).unwrap();
    // The sum forgets the previous samples from the fourth frame on.
    fs::write(&buffer, text.replace("iFrame == 0", "iFrame == 0 || iFrame == 3")).unwrap();
    let check = |frame: &str| {
        let flags = ["check", "homework", "--reference", "solution", "--frame", frame];
        let fixed = ["--device", "cpu", "--size", "32x18", "--format", "json"];
        let run = toyproof(folder, &[&flags[..], &fixed].concat());
        let report: Value =
            serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {run:?}"));
        [0, 1].map(|at| report["shaders"][at]["verdict"].as_str().unwrap().to_owned())
    };
    assert_eq!(check("2"), ["correct", "correct"]);
    assert_eq!(check("5"), ["correct", "wrong"]);
}

#[test]
fn states_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    assert_eq!(toyproof(folder, &["new", "project", "waves"]).code, 0);
    let run = |size: &str, frame: &str| {
        let flags = [
            "run", "waves", "-o", "i.png", "--device", "cpu", "--state", "s", "--size", size, "--frame",
            frame,
        ];
        toyproof(folder, &flags)
    };
    assert_eq!(run("8x8", "3").code, 0);
    let refused = |size: &str, frame: &str, reason: &str| {
        let refused = run(size, frame);
        assert_eq!(refused.code, 2);
        assert!(refused.stderr.contains(reason), "{reason}: {}", refused.stderr);
    };
    refused("8x9", "5", "s is the state of frames of 8×8 pixels");
    refused("8x8", "3", "the state is that of frame 3, and frame 3 is earlier");
    let whole = fs::read(folder.join("s")).unwrap();
    fs::write(folder.join("s"), &whole[..whole.len() / 2]).unwrap();
    refused("8x8", "5", "s is damaged");
    fs::write(folder.join("s"), "text").unwrap();
    refused("8x8", "5", "s is not a state of");
    // A texture with too few texels: the count stands before them, as the size does.
    let mut damaged = whole.clone();
    let texels = damaged.windows(3).rposition(|bytes| bytes == [8, 8, 64]).unwrap();
    damaged[texels] = 9;
    fs::write(folder.join("s"), damaged).unwrap();
    refused("8x8", "5", "s is damaged");
    let other = toyproof(folder, &["run", "waves", "-o", "i.png", "--pass", "buffer-b"]);
    assert_eq!(other.code, 2);
    assert!(
        other.stderr.contains("waves: there is no Buffer B"),
        "{}",
        other.stderr
    );
}

#[test]
fn an_image_with_common_is_treated_like_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Sound, and a buffer that the image does not read, change nothing.
    let passes = json!([
        pass("image", "4dfGRr", IMAGE),
        pass("common", "", COMMON),
        reader("buffer", "4dXGR8", BUFFER),
        pass("sound", "XsfGRr", SOUND),
    ]);
    write(
        folder,
        &[
            ("p/image.glsl", IMAGE),
            ("p/common.glsl", COMMON),
            ("p/sound.glsl", SOUND),
            ("j.json", &page(&passes).to_string()),
            ("one.glsl", &format!("{COMMON}\n{IMAGE}")),
        ],
    );
    let images = ["p", "j.json", "one.glsl"].map(|input| {
        let (run, shader) = verdict(folder, &[input]);
        assert_eq!((run.code, &shader["verdict"]), (0, &json!("ok")), "{run:?}");
        let run = toyproof(
            folder,
            &[
                "run", input, "-o", "i.exr", "--size", "32x18", "--time", "0.3", "--device", "cpu",
            ],
        );
        assert_eq!(run.code, 0, "{}", run.stderr);
        fs::read(folder.join("i.exr")).unwrap()
    });
    assert_eq!(images[0], images[2]);
    assert_eq!(images[1], images[2]);
    if require_driver() {
        let converted = ["p", "j.json", "one.glsl"].map(|input| {
            let run = toyproof(folder, &["convert", input, "-o", "c.wgsl", "--verify"]);
            assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
            text(folder, "c.wgsl")
                .lines()
                .skip(1)
                .collect::<Vec<_>>()
                .join("\n")
        });
        assert!(converted[0].contains("fn half_of"), "{}", converted[0]);
    }
}

#[test]
fn a_mistake_in_common_is_found_and_named_there() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let at = SPHERE.shader.find("Ray cameraRay").unwrap();
    let (common, image) = SPHERE.shader.split_at(at);
    let wrong = common.replacen(
        "float c = dot(f, f) - sphere.radius",
        "float c = dot(f, f) + sphere.radius",
        1,
    );
    assert_ne!(wrong, common, "the mistake is planted");
    write(
        folder,
        &[("right/common.glsl", common), ("right/image.glsl", image)],
    );
    write(
        folder,
        &[("wrong/common.glsl", &wrong), ("wrong/image.glsl", image)],
    );
    let (run, shader) = verdict(folder, &["right", "--reference", "right"]);
    assert_eq!((run.code, &shader["verdict"]), (0, &json!("correct")), "{run:?}");
    let (_, shader) = verdict(folder, &["wrong", "--reference", "right"]);
    assert_eq!(shader["verdict"], "wrong");
    assert_eq!(shader["fix"]["file"], "wrong/common.glsl", "{shader}");
}

#[test]
fn diagnostics_are_in_the_lines_of_the_tab() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let common = "float f(float x)\n{\n    return x * iTime;\n}\n";
    let image = "\n\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(f(p.x)) + y; }\n";
    write(
        folder,
        &[
            ("p/common.glsl", common),
            ("p/image.glsl", image),
            ("p/sound.glsl", SOUND),
        ],
    );
    let run = toyproof(folder, &["check", "p", "--format", "short", "--device", "cpu"]);
    assert_eq!(run.code, 1);
    let lines: Vec<_> = run.stdout.lines().collect();
    assert_eq!(
        lines,
        [
            "p/common.glsl:3:16: error[E0412]: `iTime` is not an input of Common",
            "p/image.glsl:3:60: error[E0200]: `y` is not declared",
        ]
    );
    let project = page(&json!([
        pass("image", "4dfGRr", image),
        pass("common", "", common)
    ]));
    write(folder, &[("j.json", &project.to_string())]);
    let run = toyproof(
        folder,
        &["check", "j.json", "--format", "short", "--device", "cpu"],
    );
    assert!(
        run.stdout.starts_with("j.json/common.glsl:3:16: error[E0412]"),
        "{}",
        run.stdout
    );
}

#[test]
fn folders_are_searched_for_projects() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let plain = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }";
    let project = page(&json!([pass("image", "4dfGRr", plain)])).to_string();
    write(
        folder,
        &[
            ("hw/anna/image.glsl", IMAGE),
            ("hw/anna/common.glsl", COMMON),
            ("hw/anna/sketch.glsl", plain),
            ("hw/bo.json", &project),
            ("hw/settings.json", "{\"a\": 1}"),
            ("hw/kim.glsl", plain),
        ],
    );
    let run = toyproof(
        folder,
        &["check", "hw", "--size", "16x9", "--device", "cpu", "-q"],
    );
    let mut names: Vec<_> = run
        .stdout
        .lines()
        .filter_map(|line| line.split_whitespace().nth(1))
        .collect();
    names.sort_unstable();
    assert_eq!(
        names,
        ["hw/anna", "hw/anna/sketch.glsl", "hw/bo.json", "hw/kim.glsl"],
        "{run:?}"
    );
    let run = toyproof(
        folder,
        &["run", "hw", "-o", "out", "--size", "16x9", "--device", "cpu"],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    for image in ["anna.png", "anna/sketch.png", "bo.png", "kim.png"] {
        assert!(folder.join("out").join(image).is_file(), "{image}");
    }
    // A folder that is a project itself.
    let run = toyproof(
        &folder.join("hw/anna"),
        &["check", ".", "--size", "16x9", "--device", "cpu", "-q"],
    );
    assert_eq!(run.code, 0, "{run:?}");
}

#[test]
fn hostile_json_is_refused_with_a_place() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deep = "[".repeat(100_000);
    let wide = format!("{{\"renderpass\": [{}1]}}", "1,".repeat(500_000));
    let keys: Vec<_> = (0..2000).map(|key| format!("\"k{key}\": 1,")).collect();
    let keys = format!("{{{}\"renderpass\": []}}", keys.concat());
    let huge = " ".repeat((8 << 20) + 1);
    for (text, expected) in [
        (deep.as_str(), "x.json:1:65: error[E0507]"),
        (&wide, "error[E0507]: more than 100,000 values"),
        (&keys, "error[E0507]: an object with more than 256 keys"),
        (
            "{\"renderpass\":\n [{\"type\": \"image\"}]}",
            "x.json:2:3: error[E0508]: missing key `code` in a pass",
        ),
        ("{\"a\": 1}", "x.json:1:1: error[E0508]: missing key `renderpass`"),
        (
            "void mainImage(",
            "x.json:1:1: error[E0507]: expected a JSON value",
        ),
        (
            &huge,
            "larger than 1 MiB, the most that a shader or a scene may have (8 MiB for ShaderToy's JSON)",
        ),
    ] {
        write(folder, &[("x.json", text)]);
        let run = toyproof(folder, &["-q", "import", "x.json", "-o", "x"]);
        assert_eq!(run.code, 2);
        assert!(
            run.stderr.contains(expected),
            "{expected}: {}",
            &run.stderr[..run.stderr.len().min(2000)]
        );
        assert!(!folder.join("x").exists());
    }
}

#[test]
fn a_script_moves_the_mouse_and_presses_keys() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let code = "
    void mainImage(out vec4 c, in vec2 p) {
        vec4 keys = vec4(texelFetch(iChannel0, ivec2(32, 0), 0).x, texelFetch(iChannel0, ivec2(32, 1), 0).x,
            texelFetch(iChannel0, ivec2(32, 2), 0).x, float(textureSize(iChannel0, 0).x) / 256.0);
        c = p.x < 1.0 ? keys : iMouse;
    }";
    let mut image = pass("image", "4dfGRr", code);
    image["inputs"] = json!([{
        "id": "4dXGRr", "filepath": "/presets/tex00.jpg", "type": "keyboard", "channel": 0, "published": 1,
        "sampler": {"filter": "nearest", "wrap": "clamp", "vflip": "true", "srgb": "false", "internal": "byte"},
    }]);
    let project = page(&json!([image])).to_string();
    let script = "[[mouse]]\nframe = 2\npress = [5, 3]\n[[mouse]]\nframe = 4\nrelease = true\n\
                  [[key]]\nframe = 1\npress = \"space\"\n[[key]]\nframe = 3\nrelease = \"space\"\n";
    write(folder, &[("keys.json", &project), ("script.toml", script)]);
    let shown = |frame: &str, flags: &[&str]| {
        let fixed = [
            "run",
            "keys.json",
            "-o",
            "i.exr",
            "--size",
            "2x1",
            "--mouse-script",
            "script.toml",
        ];
        let run = toyproof(folder, &[&fixed[..], &["--frame", frame], flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        let image = image::read(&folder.join("i.exr")).unwrap();
        [image.get(0, 0), image.get(1, 0)]
    };
    let [cpu, f64] = [&["--device", "cpu"][..], &["--precision", "f64"]];
    let mut devices = vec![cpu, f64];
    if require_driver() {
        devices.push(&[]);
    }
    for device in devices {
        // The image's alpha is always 1.
        assert_eq!(shown("0", device), [[0.0, 0.0, 0.0, 1.0]; 2], "{device:?}");
        assert_eq!(shown("1", device)[0], [1.0, 1.0, 1.0, 1.0], "{device:?}");
        assert_eq!(
            shown("2", device),
            [[1.0, 0.0, 1.0, 1.0], [5.0, 3.0, 5.0, 1.0]],
            "{device:?}"
        );
        assert_eq!(
            shown("4", device),
            [[0.0, 0.0, 1.0, 1.0], [5.0, 3.0, -5.0, 1.0]],
            "{device:?}"
        );
    }
    let refused = toyproof(
        folder,
        &["run", "keys.json", "-o", "i.png", "--keys", "keys.json"],
    );
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("error[E0509]"), "{}", refused.stderr);
}

#[test]
fn a_warm_up_starts_so_many_frames_before_the_first_that_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let count = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + vec4(1.0, float(iFrame), 0.0, 0.0); }";
    let shown = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }";
    write(folder, &[("sum/buffer-a.glsl", count), ("sum/image.glsl", shown)]);
    let first = |flags: &[&str]| {
        let fixed = ["run", "sum", "-o", "i.exr", "--size", "1x1", "--device", "cpu"];
        let run = toyproof(folder, &[&fixed[..], flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        let [frames, sum, ..] = image::read(&folder.join("i.exr")).unwrap().get(0, 0);
        [frames, sum]
    };
    assert_eq!(first(&["--frame", "20"]), [21.0, 210.0]);
    assert_eq!(first(&["--frame", "20", "--warm-up", "2"]), [3.0, 57.0]);
    assert_eq!(first(&["--frame", "20", "--warm-up", "0"]), [1.0, 20.0]);
    assert_eq!(first(&["--frame", "2", "--warm-up", "50"]), [3.0, 3.0]);
}
