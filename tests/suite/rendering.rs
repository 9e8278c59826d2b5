//! `run`: what renders, when it ends, what it saves, and what it reports.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use toyproof::image::{self, Image};

#[cfg(unix)]
use crate::program::command;
use crate::program::toyproof;
use crate::requirements::require_driver;
#[cfg(unix)]
use crate::support::wait::wait_until;

const GRADIENT: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(sin(p / 7.0), 0.25, 1.0); }";
/// Each frame adds to the buffer, which is read without a filter.
const SUM: &str = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + 0.125; }";
const SHOW: &str = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }";
/// The same with a filter.
const BLUR: &str =
    "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p / iResolution.xy) + 0.125; }";

fn write(folder: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

fn write_png(path: &Path, pixels: &[[f32; 4]]) {
    let image = Image::new(pixels.len() as u32, 1, pixels.to_vec());
    fs::write(path, image::encode(&image, path).unwrap()).unwrap();
}

#[test]
fn strict_runs_are_evaluated_where_the_driver_is_software() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(
        folder,
        &[
            ("s.glsl", GRADIENT),
            ("sum/buffer-a.glsl", SUM),
            ("sum/image.glsl", SHOW),
            ("blur/buffer-a.glsl", BLUR),
            ("blur/image.glsl", SHOW),
        ],
    );
    let run = |input: &str, flags: &[&str]| {
        let fixed = [
            "run", input, "-o", "i.exr", "--size", "33x17", "--frame", "3", "--format", "json",
        ];
        let run = toyproof(folder, &[&fixed[..], flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        let images: Value = serde_json::from_str(&run.stdout).unwrap();
        let device = images[0]["device"].as_str().unwrap().to_owned();
        (device, fs::read(folder.join("i.exr")).unwrap())
    };
    for (input, is_evaluated) in [("s.glsl", true), ("sum", true), ("blur", false)] {
        let (device, image) = run(input, &[]);
        assert_eq!(device == "CPU", is_evaluated, "{input}: {device}");
        let (device, by_driver) = run(input, &["--device", "lavapipe"]);
        assert_ne!(device, "CPU", "{input}");
        assert!(image == by_driver, "{input}: the images differ");
    }
    assert_ne!(run("s.glsl", &["--float", "fast"]).0, "CPU");
    assert_eq!(run("s.glsl", &["--precision", "f64"]).0, "CPU");
}

#[test]
fn f64_is_double_precision_on_any_device() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // In float32, 1 + 1e-9 is 1.
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4((1.0 + p.x * 1e-9 - 1.0) * 1e8); }";
    write(folder, &[("s.glsl", text)]);
    for device in ["auto", "cpu"] {
        for (precision, expected) in [("f32", [0.0; 3]), ("f64", [0.05, 0.15, 0.25])] {
            let arguments = [
                "run",
                "s.glsl",
                "-o",
                "i.exr",
                "--size",
                "3x1",
                "--device",
                device,
                "--precision",
                precision,
            ];
            let run = toyproof(folder, &arguments);
            assert_eq!(run.code, 0, "{}", run.stderr);
            let image = image::read(&folder.join("i.exr")).unwrap();
            let red: Vec<f32> = image.pixels().iter().map(|pixel| pixel[0]).collect();
            let is_close = red
                .iter()
                .zip(expected)
                .all(|(red, expected)| (red - expected).abs() < 1e-6);
            assert!(is_close, "{device} {precision}: {red:?}");
        }
    }
}

/// The errors that a run of the arguments reports in JSON.
fn errors(folder: &Path, arguments: &[&str]) -> Value {
    let common = ["run", "-o", "i.png", "--error-map", "e.png", "--format", "json"];
    let run = toyproof(folder, &[&common, arguments].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let map = image::read(&folder.join("e.png")).unwrap();
    assert!(map.size()[1] > 1, "the legend is below the map");
    serde_json::from_str::<Value>(&run.stdout).unwrap()[0]["errors"].take()
}

#[test]
fn the_error_of_float32_is_shown_in_each_pixel() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // In float32, 1 + 1e-9 is 1: the error in double precision is 0.05 for each pixel to the right.
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4((1.0 + p.x * 1e-9 - 1.0) * 1e8); }";
    write(
        folder,
        &[
            ("s.glsl", text),
            ("p/image.glsl", SHOW),
            ("p/buffer-a.glsl", text),
        ],
    );
    let found = errors(folder, &["s.glsl", "--size", "3x1"]);
    // 0.05, 0.15 and 0.25 of 255 levels.
    assert!(
        (found["largest"].as_f64().unwrap() - 63.75).abs() < 1e-3,
        "{found}"
    );
    assert_eq!(found["at"], json!([2, 0]));
    let count = |errors: &Value, name: &str| {
        let bands = errors["histogram"].as_array().unwrap().iter();
        let band = bands
            .clone()
            .find(|band| band[0] == name)
            .unwrap_or_else(|| panic!("{name}: {errors}"));
        band[1].as_u64().unwrap()
    };
    assert_eq!([count(&found, "<= 16"), count(&found, "> 16 levels")], [1, 2]);
    let found = errors(folder, &["s.glsl", "--size", "3x1", "--error-unit", "ulps"]);
    assert_eq!(count(&found, "> 2^20 ULPs"), 3, "{found}");
    // The image only copies what the buffer rendered in float32.
    let found = errors(folder, &["p", "--size", "3x1"]);
    assert_eq!(count(&found, "0"), 3, "{found}");
    let found = errors(folder, &["p", "--size", "3x1", "--pass", "buffer-a"]);
    assert_eq!(count(&found, "> 16 levels"), 2, "{found}");
    let arguments = [
        "run",
        "s.glsl",
        "-o",
        "i.png",
        "--size",
        "3x1",
        "--error-map",
        "e.png",
    ];
    let run = toyproof(folder, &arguments);
    let last = "largest: 63.750 levels at (2, 0); toyproof debug s.glsl --pixel 2,0\n";
    assert!(run.stdout.ends_with(last), "{}", run.stdout);
    let run = toyproof(
        folder,
        &["run", "s.glsl", "p", "-o", "images", "--error-map", "e.png"],
    );
    assert_eq!(run.code, 2, "{}", run.stdout);
    assert!(
        run.stderr.contains("--error-map takes one shader"),
        "{}",
        run.stderr
    );
    for (more, message) in [
        (&["--float", "fast"][..], "--error-map needs the evaluator"),
        (&["--precision", "f64"], "cannot be used with"),
    ] {
        let run = toyproof(folder, &[&arguments, more].concat());
        assert_eq!(run.code, 2, "{}", run.stdout);
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
}

/// In each pixel, four comparisons, three increments, and three times two operations and a sum; one comparison.
const COUNTED: &str = "float f(float x) { return x * x + 1.0; }
float g(float x) { return -x; }
void mainImage(out vec4 c, in vec2 p) {
    float s = 0.0;
    for (int i = 0; i < 3; i++)
        s += f(p.x);
    if (p.x > 99.0)
        s = g(s);
    c = vec4(s);
}
";

#[test]
fn a_profile_counts_operations_and_lists_what_is_unused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("s.glsl", COUNTED)]);
    let run = toyproof(folder, &["run", "s.glsl", "--size", "19x7", "--profile=p.csv"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines: Vec<_> = run.stdout.lines().map(words).collect();
    for line in [
        "17.0 operations per pixel, at most 17 at (0, 0)",
        "mainImage 100.0 % 64.7 % 1.0",
        "f 35.3 % 35.3 % 3.0",
        "5 41.2 % 7.0 4.0× for (int i = 0; i < 3; i++)",
        "line 7: the condition of `if` is never true",
        "never called in this frame: g",
    ] {
        assert!(lines.iter().any(|other| other == line), "{line}: {}", run.stdout);
    }
    let csv = fs::read_to_string(folder.join("p.csv")).unwrap();
    let row = format!("\r\n,s.glsl,1,{},{},6,3,", 19 * 7 * 6, 6.0 / 17.0);
    assert!(csv.contains(&row), "{row}: {csv}");
    let page = toyproof(
        folder,
        &[
            "run",
            "s.glsl",
            "--size",
            "19x7",
            "--profile=p.html",
            "--format",
            "json",
        ],
    );
    assert_eq!(page.code, 0, "{}", page.stderr);
    let images: Value = serde_json::from_str(&page.stdout).unwrap();
    let pass = &images[0]["profile"]["passes"][0];
    assert_eq!(pass["operations"], 17 * 19 * 7, "{pass}");
    assert_eq!(pass["never_called"], json!(["g"]));
    let html = fs::read_to_string(folder.join("p.html")).unwrap();
    assert!(html.contains("for (int i = 0; i &lt; 3; i++)"), "{html}");
    for (arguments, message) in [
        (&["--profile=p.txt"][..], "a profile cannot be written as p.txt"),
        (&["--profile", "-o", "-"], "standard output takes an image"),
        (&["--profile", "--frames", "0..1"], "cannot be used with"),
        (&["--profile", "--float", "fast"], "--profile needs the evaluator"),
    ] {
        let run = toyproof(folder, &[&["run", "s.glsl"], arguments].concat());
        assert_eq!(run.code, 2, "{}", run.stdout);
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
}

#[test]
fn the_profile_of_a_project_has_each_pass_and_names_those_that_are_not_needed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(
        folder,
        &[
            ("p/image.glsl", SHOW),
            ("p/buffer-a.glsl", COUNTED),
            ("p/buffer-b.glsl", GRADIENT),
        ],
    );
    let run = toyproof(
        folder,
        &["run", "p", "-o", "p.png", "--size", "16x8", "--profile"],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    for text in [
        "Buffer A: 17.0 operations per pixel",
        "Image: ",
        "never read by another pass in this frame: Buffer B\n",
    ] {
        assert!(run.stdout.contains(text), "{text}: {}", run.stdout);
    }
}

#[test]
fn an_explicit_time_limit_ends_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {
        float x = p.x;
        for (int i = 0; i < 60000000; i++) x = sin(x) + 1e-3 * float(i & 3);
        c = vec4(x);
    }";
    write(folder.path(), &[("long.glsl", text)]);
    let run = toyproof(
        folder.path(),
        &["run", "long.glsl", "--device", "cpu", "--timeout", "5s"],
    );
    assert_eq!(run.code, 1);
    assert!(
        run.stderr
            .contains("long.glsl: time limit exceeded inside a loop")
            && run.stderr.contains("help: allow more time with --timeout"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_name_without_an_extension_is_that_of_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("s.glsl", GRADIENT)]);
    for output in ["out", "new/", "deep/er", "dotted.name/"] {
        let run = toyproof(
            folder,
            &["run", "s.glsl", "-o", output, "--size", "8x8", "--device", "cpu"],
        );
        assert_eq!(run.code, 0, "{output}: {}", run.stderr);
        assert!(folder.join(output).join("s.png").is_file(), "{output}");
    }
    let run = toyproof(folder, &["run", "s.glsl", "-o", "s.jpg", "--device", "cpu"]);
    assert_eq!(run.code, 2);
    assert!(
        run.stderr.contains("use .png (8 bits) or .exr (floats)"),
        "{}",
        run.stderr
    );
}

/// A signal ends a run while the frames before the first one that is shown are played; a later run goes on.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_ends_the_frames_before_a_sequence_and_saves_their_state() {
    use rustix::process::{Pid, Signal, kill_process};
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("sum/buffer-a.glsl", SUM), ("sum/image.glsl", SHOW)]);
    let fixed = [
        "run", "sum", "-o", "i.exr", "--size", "4x4", "--device", "cpu", "--state", "s",
    ];
    // Until the first frame is rendered, there is no state to save.
    let mut waited = std::time::Duration::from_millis(100);
    let stderr = loop {
        let child = command(folder)
            .args([&fixed[..], &["--frames", "1000000000..1000000001"]].concat())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(waited);
        let handles_term = handles_term(child.id());
        kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
        let output = child.wait_with_output().unwrap();
        if handles_term && folder.join("s").is_file() {
            assert_eq!(output.status.code(), Some(2));
            break String::from_utf8(output.stderr).unwrap();
        }
        waited *= 2;
        assert!(waited.as_secs() < 60, "no state was saved");
    };
    assert!(stderr.contains("interrupted after 0 of 2 frames"), "{stderr}");
    let after = stderr.split("the buffers after frame ").nth(1).unwrap();
    let last: u32 = after.split_whitespace().next().unwrap().parse().unwrap();
    let next = (last + 1).to_string();
    let run = toyproof(folder, &[&fixed[..], &["--frame", &next]].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let image = image::read(&folder.join("i.exr")).unwrap();
    assert_eq!(image.get(0, 0)[0], 0.125 * (last + 2) as f32);
}

/// Whether a process handles SIGTERM.
#[cfg(unix)]
fn handles_term(process: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let mut lines = status.lines();
    let mask = lines.find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() & 1 << 14 != 0
}

/// Nothing is saved, so that an interrupt need not wait for the frame in progress, which a driver may compile
/// for minutes.
#[cfg(unix)]
#[test]
fn a_run_without_a_state_ends_at_once() {
    use rustix::process::{Pid, Signal, kill_process};

    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let slow = "void mainImage(out vec4 c, in vec2 p) {
        float x = p.x;
        for (int i = 0; i < 60000000; i++) x = sin(x) + 1e-3 * float(i & 3);
        c = vec4(x) + texelFetch(iChannel0, ivec2(p), 0);
    }";
    write(folder, &[("slow/buffer-a.glsl", SUM), ("slow/image.glsl", slow)]);
    let child = command(folder)
        .args(["run", "slow", "-o", "i.png", "--device", "cpu"])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    wait_until(|| handles_term(child.id()));
    kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    assert!(!folder.join("i.png").exists());
}

/// A sequence with a state goes on after its last frame, although the state is beyond its first one.
#[cfg(unix)]
#[test]
fn an_interrupted_sequence_with_a_state_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("sum/buffer-a.glsl", SUM), ("sum/image.glsl", SHOW)]);
    let arguments = [
        "run", "sum", "-o", "i.exr", "--size", "4x4", "--device", "cpu", "--state", "s", "--frames",
        "0..3000",
    ];
    let child = command(folder)
        .args(arguments)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    wait_until(|| folder.join("i-0002.exr").is_file());
    let interrupt = std::process::Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status();
    assert!(interrupt.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(folder.join("s").is_file(), "{stderr}");
    let run = toyproof(folder, &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let image = image::read(&folder.join("i-3000.exr")).unwrap();
    assert_eq!(image.get(0, 0)[0], 0.125 * 3001.0);
}

#[test]
fn a_state_belongs_to_a_project_and_a_rate() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let other = SUM.replace("0.125", "0.25");
    write(
        folder,
        &[
            ("sum/buffer-a.glsl", SUM),
            ("sum/image.glsl", SHOW),
            ("other/buffer-a.glsl", &other),
            ("other/image.glsl", SHOW),
        ],
    );
    let run = |project: &str, flags: &[&str]| {
        let fixed = ["run", project, "-o", "i.png", "--size", "8x8", "--device", "cpu"];
        toyproof(folder, &[&fixed[..], flags].concat())
    };
    assert_eq!(run("sum", &["--frame", "3", "--state", "s"]).code, 0);
    let refused = |project: &str, flags: &[&str], reason: &str| {
        let run = run(project, flags);
        assert_eq!(run.code, 2, "{flags:?}");
        assert!(run.stderr.contains(reason), "{reason}: {}", run.stderr);
    };
    refused(
        "other",
        &["--frame", "5", "--state", "s"],
        "s is the state of a project with other texts, passes or inputs",
    );
    refused(
        "sum",
        &["--frame", "5", "--fps", "30", "--state", "s"],
        "s is the state of 60 frames in a second",
    );
    write_png(&folder.join("p.png"), &[[1.0; 4]]);
    refused(
        "sum",
        &["--frame", "5", "--channel1", "p.png", "--state", "s"],
        "s is the state of a project with other texts, passes or inputs",
    );
    // Times that round to frames do not move frame 0.
    assert_eq!(run("sum", &["--time", "0.1", "--state", "s"]).code, 0);
    assert_eq!(run("sum", &["--time", "0.1834", "--state", "s"]).code, 0);
    fs::create_dir(folder.join("d")).unwrap();
    refused(
        "sum",
        &["--frame", "20", "--state", "d"],
        "cannot read d: it is a folder, not a file",
    );
    if cfg!(unix) {
        refused(
            "sum",
            &["--frame", "20", "--state", "/dev/zero"],
            "cannot read /dev/zero: it is a device, not a file",
        );
        let made = std::process::Command::new("mkfifo")
            .arg(folder.join("pipe"))
            .status();
        assert!(made.unwrap().success());
        refused(
            "sum",
            &["--frame", "20", "--state", "pipe"],
            "cannot read pipe: it is a named pipe, not a file",
        );
    }
}

#[test]
fn a_project_reads_images_of_its_folder() {
    const TEXTURE: &str =
        "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p / iResolution.xy); }";
    let toml = |source: &str| {
        format!("[[pass]]\ntab = \"image\"\ninputs = [{{ channel = 0, source = \"{source}\" }}]\n")
    };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(
        folder,
        &[
            ("p/image.glsl", TEXTURE),
            ("p/project.toml", &toml("textures/p.png")),
            ("one.glsl", TEXTURE),
        ],
    );
    fs::create_dir(folder.join("p/textures")).unwrap();
    write_png(
        &folder.join("p/textures/p.png"),
        &[[1.0, 0.2, 0.0, 1.0], [0.0, 0.4, 0.0, 1.0]],
    );
    write_png(&folder.join("outside.png"), &[[1.0; 4]]);
    let run = |input: &str, flags: &[&str]| {
        let fixed = ["run", input, "-o", "i.exr", "--size", "8x8", "--device", "cpu"];
        let run = toyproof(folder, &[&fixed[..], flags].concat());
        (
            run.code,
            run.stderr,
            fs::read(folder.join("i.exr")).unwrap_or_default(),
        )
    };
    let (code, stderr, image) = run("p", &[]);
    assert_eq!(code, 0, "{stderr}");
    assert!(!stderr.contains("warning"), "{stderr}");
    assert!(image::read(&folder.join("i.exr")).unwrap().get(0, 0)[0] > 0.5);
    // The wrap mode and the filter are those of a texture of the site.
    let (code, stderr, given) = run("p", &["--channel0", "p/textures/p.png"]);
    assert_eq!(code, 0, "{stderr}");
    assert_eq!(image, given);
    let check = toyproof(folder, &["check", "p", "--device", "cpu", "--size", "8x8"]);
    assert_eq!(check.code, 0, "{}{}", check.stdout, check.stderr);
    let refused = |source: &str, reason: &str| {
        write(folder, &[("p/project.toml", &toml(source))]);
        for command in ["run", "check"] {
            let run = toyproof(folder, &[command, "p", "--device", "cpu", "--size", "8x8"]);
            let text = run.stdout + &run.stderr;
            assert_eq!(run.code, 1, "{source}: {text}");
            assert!(
                text.contains(reason) && text.contains("E0508"),
                "{reason}: {text}"
            );
        }
    };
    refused("../outside.png", "this path leads out of the project's folder");
    refused(
        "none.png",
        "there is no file none.png in the folder of the project",
    );
    refused("textures.png", "there is no file textures.png");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../outside.png", folder.join("p/link.png")).unwrap();
        refused("link.png", "outside `p`");
    }
    fs::create_dir(folder.join("p/d.png")).unwrap();
    refused("d.png", "d.png is not a regular file");
    fs::write(folder.join("p/text.png"), "text").unwrap();
    refused("text.png", "as an image");
}

#[test]
fn a_channel_with_an_image_is_not_reported_as_black() {
    let toml = "[[pass]]\ntab = \"image\"\ninputs = [{ channel = 0, source = \"London\" }]\n";
    let text = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p); }";
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("p/image.glsl", text), ("p/project.toml", toml)]);
    write_png(&folder.join("p.png"), &[[1.0; 4]]);
    let run = |flags: &[&str]| {
        let fixed = ["run", "p", "-o", "i.png", "--size", "8x8", "--device", "cpu"];
        let run = toyproof(folder, &[&fixed[..], flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stderr
    };
    assert!(run(&[]).contains("“London” of ShaderToy is replaced"));
    let given = run(&["--channel0", "p.png"]);
    assert!(!given.contains("replaced"), "{given}");
    let other = run(&["--channel1", "p.png"]);
    assert!(other.contains("replaced"), "{other}");
}

#[test]
fn run_counts_lints_and_shows_what_concerns_the_image() {
    let text = "uniform float speed;\nfloat hash(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }\n\
                void mainImage(out vec4 c, in vec2 p) { c = vec4(hash(p), speed, hash(p.yx + 1.0), 1.0); }\n";
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("s.glsl", text)]);
    let run = |flags: &[&str]| {
        let fixed = ["run", "s.glsl", "-o", "s.png", "--size", "8x8", "--device", "cpu"];
        toyproof(folder, &[&fixed[..], flags].concat()).stderr
    };
    let short = run(&[]);
    assert!(
        short.contains("warning[W0030]: nothing sets the uniform `speed`, so it is 0"),
        "{short}"
    );
    assert!(!short.contains("W0005"), "{short}");
    assert!(
        short.contains("s.glsl: 1 warning, which `toyproof check s.glsl` shows"),
        "{short}"
    );
    assert!(run(&["-v"]).contains("W0005"));
    assert_eq!(run(&["-q"]), "");
    let check = toyproof(folder, &["check", "s.glsl", "--device", "cpu", "--size", "8x8"]);
    let shown = check.stdout + &check.stderr;
    assert!(shown.contains("W0005") && shown.contains("W0030"), "{shown}");
}

#[test]
fn a_late_frame_names_the_frames_before_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("sum/buffer-a.glsl", SUM), ("sum/image.glsl", SHOW)]);
    let run = |flags: &[&str]| {
        let fixed = ["run", "sum", "-o", "i.png", "--size", "4x4", "--device", "cpu"];
        let run = toyproof(folder, &[&fixed[..], flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stderr
    };
    let late = run(&["--time", "4"]);
    assert!(
        late.contains("240 frames are rendered first") && late.contains("--warm-up N"),
        "{late}"
    );
    assert!(!run(&["--frame", "5"]).contains("rendered first"));
    assert!(!run(&["--time", "4", "--warm-up", "3"]).contains("rendered first"));
}

#[test]
fn frames_of_a_sequence_have_the_time_after_that_of_frame_0() {
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(iTime, iFrame, 0.0, 1.0); }";
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, &[("s.glsl", text), ("p/image.glsl", text)]);
    for input in ["s.glsl", "p"] {
        let run = toyproof(
            folder,
            &[
                "run", input, "-o", "i.exr", "--size", "2x2", "--device", "cpu", "--frames", "1..2", "--fps",
                "4", "--time", "10",
            ],
        );
        assert_eq!(run.code, 0, "{}", run.stderr);
        let pixel = image::read(&folder.join("i-0002.exr")).unwrap().get(0, 0);
        assert_eq!(pixel[..2], [10.5, 2.0], "{input}");
    }
}

#[test]
fn images_that_differ_by_rounding_agree() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let gray = |level: f32| vec![[level / 255.0, level / 255.0, level / 255.0, 1.0]; 4];
    write_png(&folder.join("a.png"), &gray(100.0));
    write_png(&folder.join("b.png"), &gray(101.0));
    write_png(&folder.join("c.png"), &gray(102.0));
    write_png(&folder.join("a.exr"), &gray(100.4));
    write_png(&folder.join("b.exr"), &gray(100.8));
    write(folder, &[("s.glsl", GRADIENT), ("t.glsl", GRADIENT)]);
    let compare = |a: &str, b: &str| {
        let run = toyproof(folder, &["compare", a, b]);
        (run.code, run.stdout + &run.stderr)
    };
    for (a, b, code, text) in [
        ("a.png", "a.png", 0, "all 4 pixels are equal"),
        (
            "a.png",
            "b.png",
            0,
            "all 4 pixels agree to within one level of 255",
        ),
        (
            "a.png",
            "a.exr",
            0,
            "all 4 pixels agree to within one level of 255",
        ),
        (
            "a.png",
            "c.png",
            1,
            "4 of 4 pixels differ by more than one level of 255",
        ),
        ("a.exr", "b.exr", 1, "4 of 4 pixels differ by more than 0.001"),
        ("s.glsl", "t.glsl", 0, "equal to the bit"),
        ("a.png", "t.glsl", 2, "toyproof check t.glsl --reference a.png"),
    ] {
        let (actual, output) = compare(a, b);
        assert_eq!(actual, code, "{a} {b}: {output}");
        assert!(output.contains(text), "{a} {b}: {output}");
    }
}

#[test]
fn explain_searches_for_words() {
    let explain = |word: &str| toyproof(Path::new("."), &["explain", word]);
    let found = explain("602");
    assert_eq!(found.code, 0, "{}", found.stderr);
    assert!(found.stdout.starts_with("W0602  "), "{}", found.stdout);
    let found = explain("acne");
    assert_eq!(found.code, 0, "{}", found.stderr);
    assert!(found.stdout.lines().count() >= 1 && found.stderr.contains("toyproof explain "));
    assert_eq!(explain("nonsense-word").code, 2);
}

#[test]
fn small_mistakes_on_the_command_line_have_a_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("file"), "").unwrap();
    write(folder, &[("s.glsl", GRADIENT)]);
    for (arguments, text) in [
        (&["rnder", "x"][..], "a similar subcommand exists: 'render'"),
        (&["new", "scene", "a.glsl"], "this is the name of a shader"),
    ] {
        let run = toyproof(folder, arguments);
        assert_eq!(run.code, 2, "{arguments:?}");
        assert!(run.stderr.contains(text), "{}", run.stderr);
    }
    let run = toyproof(
        folder,
        &[
            "run",
            "s.glsl",
            "-o",
            "file/s.png",
            "--size",
            "4x4",
            "--device",
            "cpu",
        ],
    );
    assert_eq!(run.code, 2);
    assert!(
        run.stderr.contains("cannot write") && !run.stderr.contains("os error"),
        "{}",
        run.stderr
    );
    let completions = toyproof(folder, &["completions", "bash"]);
    assert!(completions.stdout.contains("W0602") && completions.stdout.contains("far-root"));
}

/// That a shader renders means little if what it reads is missing.
#[test]
fn missing_media_are_named_and_the_verdict_is_not_ok() {
    const CUBE: &str =
        "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, vec3(p, 1.0)) + 0.5; }";
    const TEXTURE: &str = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p) + 0.5; }";
    let toml = "[[pass]]\ntab = \"image\"\n\
                inputs = [{ channel = 0, type = \"texture\", id = \"none\", filepath = \"/media/a/0.jpg\" }]\n";
    let allowed = format!("// toyproof: allow(W0605)\n{CUBE}");
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(
        folder,
        &[
            ("cube.glsl", CUBE),
            ("texture.glsl", TEXTURE),
            ("allowed.glsl", &allowed),
            ("p/image.glsl", TEXTURE),
            ("p/project.toml", toml),
        ],
    );
    write_png(&folder.join("p.png"), &[[1.0; 4]]);
    for (arguments, code, text) in [
        (
            &["cube.glsl"][..],
            1,
            "the cube map of `iChannel0` is not available",
        ),
        (&["p"], 1, "the texture of `iChannel0` is not available"),
        (&["p", "--channel0", "p.png"], 0, "ok "),
        (&["texture.glsl"], 0, "`iChannel0` is black"),
        (&["allowed.glsl"], 0, "ok "),
    ] {
        let fixed = ["check", "--device", "cpu", "--size", "8x8"];
        let run = toyproof(folder, &[&fixed[..], arguments].concat());
        let output = run.stdout + &run.stderr;
        assert_eq!(run.code, code, "{arguments:?}: {output}");
        assert!(output.contains(text), "{arguments:?}: {output}");
        assert_eq!(output.starts_with("inconclusive"), code == 1, "{output}");
    }
}
