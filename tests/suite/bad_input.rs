//! Bad input yields a clear message and the right exit code; it never hangs, and leaves no partial output.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::program::{Run, command, run, toyproof};
use crate::requirements::require_driver;

const MAIN: &str = "void mainImage(out vec4 c, in vec2 p)";
/// Compiles slowly on lavapipe: a large array in registers.
const SLOW_TO_COMPILE: &str =
    "float a[8192]; for (int i = 0; i < 8192; i++) a[i] = p.x; c = vec4(a[int(p.x)]);";
const SPHERE: &str = "[[sphere]]\ncenter = [0.0, 0.0, -6.0]\nradius = 1.5\nmaterial = { model = \"facing\", color = [1.0, 1.0, 0.0] }\n";

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn check(text: &str, arguments: &[&str]) -> Run {
    let folder = folder(&[("s.glsl", text)]);
    toyproof(folder.path(), &[&["check", "s.glsl"], arguments].concat())
}

#[track_caller]
fn expect(run: &Run, code: i32, words: &[&str]) {
    let all = format!("{}{}", run.stdout, run.stderr);
    assert_eq!(run.code, code, "{all}");
    for words in words {
        assert!(all.contains(words), "“{words}” is not in:\n{all}");
    }
}

#[test]
fn shaders_that_overflow_driver_counters() {
    let loops = (0..90).map(|d| format!("for (int i{d} = 0; i{d} < 1; i{d}++) "));
    let text = format!(
        "void mainImage(out vec4 c, in vec2 p) {{ {} c += p.xyxy; }}",
        loops.collect::<String>()
    );
    let messages = ["invalid", "E0411", "nested too deeply", "s.glsl:1:"];
    expect(
        &check(&text, &["--device", "lavapipe", "--size", "16x9"]),
        1,
        &messages,
    );
    expect(&check(&text, &["--device", "cpu", "--size", "16x9"]), 0, &["ok"]);
}

#[test]
fn a_missing_file() {
    let run = toyproof(folder(&[]).path(), &["check", "nowhere.glsl"]);
    expect(&run, 2, &["error        nowhere.glsl", "no such file or folder"]);
}

#[test]
fn scenes_and_shaders_are_not_confused() {
    let folder = folder(&[("s.glsl", ""), ("s.toml", SPHERE)]);
    for arguments in [
        &["check", "s.toml"][..],
        &["convert", "s.toml", "-o", "s.wgsl"],
        &["run", "s.toml", "-o", "s.png"],
    ] {
        let run = toyproof(folder.path(), arguments);
        expect(
            &run,
            2,
            &[
                "s.toml",
                "this is a scene, not a shader",
                "toyproof render s.toml",
            ],
        );
    }
    expect(
        &toyproof(folder.path(), &["render", "s.glsl", "-o", "s.png"]),
        2,
        &["s.glsl is a shader", "toyproof run s.glsl"],
    );
}

#[test]
fn each_mistake_is_reported_once() {
    let run = check(
        &format!("{MAIN} {{ c = vec4(1.0) }}\nfloat f() {{ return x; }}"),
        &[],
    );
    expect(
        &run,
        1,
        &["invalid      s.glsl  2 errors\n             help: toyproof explain E0100"],
    );
    assert_eq!(run.stdout.lines().count(), 2, "{}", run.stdout);
    assert_eq!(run.stderr.matches("expected `;`").count(), 1, "{}", run.stderr);
}

#[test]
fn a_folder_without_shaders() {
    let run = toyproof(folder(&[("notes.txt", "")]).path(), &["check", "."]);
    expect(
        &run,
        2,
        &["no shader in this folder", ".glsl .frag .fs .shadertoy"],
    );
}

#[test]
#[cfg(unix)]
fn a_file_that_cannot_be_read() {
    // Nobody can open a socket as a file, not even root.
    let folder = folder(&[]);
    let _socket = std::os::unix::net::UnixListener::bind(folder.path().join("s.glsl")).unwrap();
    expect(
        &toyproof(folder.path(), &["check", "s.glsl"]),
        2,
        &["error        s.glsl  cannot be read"],
    );
}

#[test]
fn a_missing_file_does_not_affect_others() {
    let folder = folder(&[("empty.glsl", "")]);
    let run = toyproof(folder.path(), &["check", "nowhere.glsl", "empty.glsl"]);
    expect(&run, 2, &["error        nowhere.glsl", "invalid      empty.glsl"]);
}

#[test]
fn an_empty_file() {
    expect(
        &check("", &[]),
        1,
        &[
            "missing function `mainImage`",
            "mainImage(out vec4 fragColor, in vec2 fragCoord)",
        ],
    );
}

#[test]
fn a_shader_without_main_image() {
    expect(
        &check("float f() { return 1.0; }", &[]),
        1,
        &["missing function `mainImage`"],
    );
}

#[test]
fn a_brace_that_is_never_closed() {
    let run = check(
        &format!("{MAIN} {{\n  if (p.x > 1.0) {{\n  c = vec4(1.0);\n}}\n"),
        &[],
    );
    expect(&run, 1, &["unclosed `{`", "s.glsl:2:18"]);
}

#[test]
fn twenty_megabytes() {
    expect(
        &check(&" ".repeat(20_000_000), &[]),
        1,
        &["the file is larger than 1 MiB"],
    );
}

#[test]
fn bytes_that_are_not_text() {
    let folder = folder(&[]);
    fs::write(folder.path().join("s.glsl"), b"void f();\nfloat \xff;").unwrap();
    expect(
        &toyproof(folder.path(), &["check", "s.glsl"]),
        1,
        &["not UTF-8 text", "s.glsl:2:7"],
    );
}

#[test]
fn invalid_scenes() {
    let whole = format!("{MAIN} {{ c = vec4(0.0); }}");
    for (scene, words) in [
        ("hue = 1\n".to_owned(), ["unknown key `hue`", "s.toml:1:1"]),
        (
            SPHERE.replace("-6.0", "nan"),
            ["`center` must be finite, found [0.0, 0.0, nan]", "s.toml:2:10"],
        ),
        (
            SPHERE.replace("1.5", "0.0"),
            ["`radius` must be greater than 0, found 0.0", "s.toml:3:10"],
        ),
        (
            "title = \"soon\"\n".to_owned(),
            ["the scene is empty", "s.toml:1:1"],
        ),
        (
            "[film]\nsize = [0, 0]\n".to_owned(),
            ["`size` must be at least 1 pixel", "s.toml:2:8"],
        ),
        (
            "[film]\nsize = [100000, 100000]\n".to_owned(),
            ["`size` must be at most 16,384 pixels", "s.toml:2:8"],
        ),
    ] {
        let folder = folder(&[("s.glsl", &whole), ("s.toml", &scene)]);
        expect(&toyproof(folder.path(), &["check", "s.glsl"]), 2, &words);
        expect(
            &toyproof(folder.path(), &["render", "s.toml", "-o", "s.png"]),
            2,
            &words,
        );
        assert!(!folder.path().join("s.png").exists());
    }
}

#[test]
fn invalid_sizes() {
    for (size, words) in [
        ("0x0", "at least 1 pixel"),
        ("100000x100000", "too large"),
        ("wide", "640x360"),
    ] {
        expect(&check("", &["--size", size]), 2, &[words]);
    }
}

#[test]
fn invalid_time_limits() {
    for (deadline, words) in [
        ("500000000000years", "24 hours"),
        ("25h", "24 hours"),
        ("soon", "--timeout"),
    ] {
        expect(&check("", &["--timeout", deadline]), 2, &[words]);
    }
}

#[test]
fn out_of_range_numbers_have_our_own_messages() {
    let folder = folder(&[
        ("s.glsl", &format!("{MAIN} {{ c = vec4(0.5); }}")),
        ("s.toml", SPHERE),
    ]);
    for (arguments, words) in [
        (&["check", "s.glsl", "--frame", "-1"][..], "not in 0..="),
        (&["check", "s.glsl", "--time", "nan"], "finite"),
        (&["run", "s.glsl", "-o", "s.png", "--time", "inf"], "finite"),
        (
            &["check", "s.glsl", "--date", "2020,12,1,0"],
            "the month 12 is out of range",
        ),
        (&["check", "s.glsl", "--timeout", "0s"], "above 0"),
        (&["debug", "s.glsl", "--pixel", "-1,0"], "expected two integers"),
        (
            &["render", "s.toml", "-o", "s.png", "--max-error", "-1"],
            "above 0",
        ),
        (&["render", "s.toml", "-o", "s.png", "--time", "inf"], "finite"),
        (&["trade", "s.toml", "--max-error", "-1"], "from 0 to 1"),
        (&["trade", "s.toml", "-o", "out", "--budget", "0s"], "above 0"),
        (&["stress", "-o", "out", "--seed", "-1"], "from 0 to"),
    ] {
        let run = toyproof(folder.path(), arguments);
        expect(&run, 2, &[words]);
        assert!(!run.stderr.contains("tip:"), "{}", run.stderr);
    }
    assert_eq!(names(folder.path()), ["s.glsl", "s.toml"]);
}

#[test]
fn a_mismatched_file_extension() {
    let folder = folder(&[("s.glsl", &format!("{MAIN} {{ c = vec4(0.5); }}"))]);
    let convert = |arguments: &[&str]| toyproof(folder.path(), &[&["convert", "s.glsl"], arguments].concat());
    expect(
        &convert(&["-o", "s.wgsl", "--to", "spv"]),
        2,
        &["s.wgsl", "--to is spv"],
    );
    assert_eq!(names(folder.path()), ["s.glsl"]);
    expect(&convert(&["-o", "S.WGSL"]), 0, &[]);
    expect(&convert(&["-o", "l.glsl", "--to", "lowered"]), 0, &[]);
}

#[test]
fn an_unwritable_output_folder() {
    if !require_driver() {
        return;
    }
    let folder = folder(&[("s.glsl", &format!("{MAIN} {{ c = vec4(0.5); }}")), ("file", "")]);
    for arguments in [
        &["check", "s.glsl", "--out", "file/out"][..],
        &["run", "s.glsl", "-o", "file/s.png"],
    ] {
        expect(&toyproof(folder.path(), arguments), 2, &["cannot write file/"]);
    }
    assert_eq!(names(folder.path()), ["file", "s.glsl"]);
}

#[test]
fn an_output_that_is_not_an_image() {
    if !require_driver() {
        return;
    }
    let folder = folder(&[("s.glsl", &format!("{MAIN} {{ c = vec4(0.5); }}"))]);
    expect(
        &toyproof(folder.path(), &["run", "s.glsl", "-o", "s.gif"]),
        2,
        &["GIF is a film", "--duration"],
    );
    expect(
        &toyproof(folder.path(), &["convert", "s.glsl", "-o", "s.txt"]),
        2,
        &["--to", ".wgsl"],
    );
    assert_eq!(names(folder.path()), ["s.glsl"]);
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn no_vulkan_driver() {
    let folder = folder(&[("s.glsl", &format!("{MAIN} {{ c = vec4(0.5); }}"))]);
    let hint = [
        "no Vulkan driver found",
        "apt-get install mesa-vulkan-drivers libvulkan1",
        // Installing a hidden driver would not help.
        "VK_DRIVER_FILES or VK_ICD_FILENAMES is set",
    ];
    let short = [hint[0], hint[2]];
    for (arguments, code, shown) in [
        // The evaluator replaces it, unless a driver is requested: in strict runs with the same bits.
        (&["check", "s.glsl"][..], 0, &short[..]),
        (&["run", "s.glsl", "-o", "s.png"], 0, &[]),
        (
            &["run", "s.glsl", "-o", "s.png", "--float", "fast"],
            0,
            &["no Vulkan driver: shaders are evaluated"],
        ),
        (&["check", "s.glsl", "--device", "lavapipe"], 2, &hint),
        (
            &["run", "s.glsl", "-o", "s.png", "--device", "lavapipe"],
            2,
            &hint,
        ),
        (&["doctor"], 2, &hint),
    ] {
        let mut command = command(folder.path());
        command
            .args(arguments)
            .env("VK_DRIVER_FILES", "/nowhere.json")
            .env("VK_ICD_FILENAMES", "/nowhere.json");
        let run = run(&mut command);
        expect(&run, code, shown);
        if code == 0 {
            let output = format!("{}{}", run.stdout, run.stderr);
            assert!(
                !(output.contains("apt-get") || output.contains("warning") && shown.is_empty()),
                "{output}"
            );
        }
        if let ["check", _] | ["doctor"] = arguments {
            let skipped = format!("{}{}", run.stdout, run.stderr);
            assert!(skipped.contains("toolchain check"), "{arguments:?}: {skipped}");
        }
    }
}

#[test]
fn an_unknown_adapter() {
    if !require_driver() {
        return;
    }
    let run = check(&format!("{MAIN} {{ c = vec4(0.5); }}"), &["--device", "Voodoo"]);
    expect(
        &run,
        2,
        &["no Vulkan adapter with “Voodoo” in its name", "available:"],
    );
}

#[test]
fn endless_and_overlong_loops() {
    if !require_driver() {
        return;
    }
    for body in [
        "for (;;) { } c = vec4(1.0);",
        "float x = 0.0; while (true) { x += 1.0; } c = vec4(x);",
        "float x = 0.0; for (int i = 0; i < 10;) { x += 0.1; } c = vec4(x);",
        "int i = 0; float x = 0.0; while (i < 10) { x += 0.1; if (p.x < 0.0) i++; } c = vec4(x);",
        "float x = 0.0; while (x < 1.0) { x *= 0.5; } c = vec4(x);",
        // Long enough that a driver without a loop cap exceeds the deadline.
        "float x = p.x; for (int i = 0; i < 2000000000; i++) { x = sin(x) + 0.1; } c = vec4(x);",
    ] {
        let run = check(
            &format!("{MAIN} {{ {body} }}"),
            &["--timeout", "8s", "--size", "64x36"],
        );
        expect(&run, 1, &["timeout      s.glsl"]);
    }
}

#[test]
fn a_long_finite_loop_is_not_a_timeout() {
    if !require_driver() {
        return;
    }
    let body = "float x = p.x; for (int i = 0; i < 20000; i++) { x += fract(x * 0.3) * 0.001; } c = vec4(x);";
    let run = check(
        &format!("{MAIN} {{ {body} }}"),
        &["--timeout", "60s", "--size", "16x9"],
    );
    expect(&run, 0, &["ok           s.glsl"]);
}

#[test]
fn twenty_thousand_parentheses() {
    let nested = format!(
        "{MAIN} {{ float x = {}1.0{}; c = vec4(x); }}",
        "(".repeat(20_000),
        ")".repeat(20_000)
    );
    expect(&check(&nested, &[]), 1, &["nesting deeper than 256 levels"]);
}

#[test]
fn nesting_without_brackets_yields_a_verdict() {
    if !require_driver() {
        return;
    }
    for body in [
        format!("float x = {}1.0; c = vec4(x);", "- ".repeat(20_000)),
        format!("{} c = vec4(1.0);", "if (p.x > 1.0) ".repeat(20_000)),
        format!(
            "float x = {}1.0; c = vec4(x);",
            "p.x > 1.0 ? 1.0 : ".repeat(20_000)
        ),
    ] {
        let run = check(&format!("{MAIN} {{ {body} }}"), &["--timeout", "2s"]);
        assert!((0..=1).contains(&run.code), "{}", run.stdout);
    }
}

#[test]
fn a_shader_that_compiles_for_a_minute() {
    if !require_driver() {
        return;
    }
    let run = check(&format!("{MAIN} {{ {SLOW_TO_COMPILE} }}"), &["--timeout", "4s"]);
    // That is the driver's fault, so the evaluator checks the shader.
    let words = ["ok           s.glsl", "W0606", "takes longer than 4 s to compile"];
    expect(&run, 0, &words);
}

#[test]
fn macros_that_grow_without_bound() {
    let mut bomb = "#define A0 1.0 + 1.0\n".to_owned();
    for i in 0..40 {
        writeln!(bomb, "#define A{} A{i} + A{i}", i + 1).unwrap();
    }
    let run = check(
        &format!("{bomb}{MAIN} {{ c = vec4(A40); }}"),
        &["--timeout", "2s"],
    );
    assert!(
        run.stdout.starts_with("timeout") || run.stdout.starts_with("invalid"),
        "{}",
        run.stdout
    );
}

#[test]
fn the_next_shader_is_checked_after_a_worker_dies() {
    if !require_driver() {
        return;
    }
    let folder = folder(&[
        ("a.glsl", &format!("{MAIN} {{ {SLOW_TO_COMPILE} }}")),
        ("b.glsl", &format!("{MAIN} {{ c = vec4(0.5); }}")),
    ]);
    let run = toyproof(
        folder.path(),
        &["check", ".", "--timeout", "2s", "--size", "64x36"],
    );
    expect(
        &run,
        0,
        &["ok           ./a.glsl", "W0606", "ok           ./b.glsl"],
    );
}

#[test]
fn no_output_overwrites_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0, 1); }";
    fs::write(folder.path().join("a.frag"), text).unwrap();
    fs::write(folder.path().join("s.toml"), SPHERE).unwrap();
    assert_eq!(
        toyproof(folder.path(), &["run", "a.frag", "-o", "a.png", "--size", "8x8"]).code,
        0
    );
    let image = fs::read(folder.path().join("a.png")).unwrap();
    for arguments in [
        &["convert", "a.frag", "-o", "./a.frag"][..],
        &["convert", ".", "-o", ".", "--to", "glsl"],
        &["export", "s.toml", "-o", "s.toml"],
        &["compare", "a.png", "a.png", "--diff", "a.png"],
        &["run", "a.frag", "-o", "a.png", "--channel0", "a.png"],
    ] {
        expect(
            &toyproof(folder.path(), arguments),
            2,
            &["is an input and would be overwritten"],
        );
    }
    assert_eq!(fs::read_to_string(folder.path().join("a.frag")).unwrap(), text);
    assert_eq!(fs::read_to_string(folder.path().join("s.toml")).unwrap(), SPHERE);
    assert_eq!(fs::read(folder.path().join("a.png")).unwrap(), image);
}

#[cfg(target_os = "linux")]
#[test]
fn write_errors_are_reported_unless_the_pipe_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_toyproof");
    let run = |end: &str| {
        let line = format!("{program} scenes {end}; echo $?");
        let run = std::process::Command::new("sh")
            .args(["-c", &line])
            .current_dir(folder.path())
            .output()
            .unwrap();
        String::from_utf8_lossy(&[run.stdout, run.stderr].concat()).into_owned()
    };
    let full = run("> /dev/full");
    assert!(
        full.starts_with("2\n") && full.contains("cannot write to standard output"),
        "{full}"
    );
    assert!(!run("| true").contains("error"), "{}", run("| true"));
}

#[cfg(unix)]
#[test]
fn pipes_are_read_once() {
    let root = env!("CARGO_MANIFEST_DIR");
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_toyproof");
    let out = folder.path().display();
    for line in [
        format!("cat glsl/02-sphere.glsl | {program} check - --scene glsl/02-sphere.toml --out {out}"),
        format!("cat glsl/02-sphere.glsl | {program} check - - --scene glsl/02-sphere.toml"),
        format!(
            "cat glsl/02-sphere.glsl | {program} check /dev/stdin --scene glsl/02-sphere.toml --out {out}"
        ),
        format!(
            "cat glsl/02-sphere.toml | {program} check glsl/02-sphere.glsl --scene /dev/stdin --out {out}"
        ),
    ] {
        let line = format!("{line} --size 64x36 --device cpu");
        let run = std::process::Command::new("sh")
            .args(["-c", &line])
            .current_dir(root)
            .output()
            .unwrap();
        let reported = String::from_utf8_lossy(&run.stdout);
        assert!(
            run.status.success() && reported.starts_with("correct "),
            "{line}: {reported}"
        );
    }
}
