//! `toyproof reduce`: each kind of fault on a shader of some length; what is left is small, and still shows
//! the fault.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use toyproof::reduce::Size;

use crate::program::{Run, command, run, toyproof};
use crate::requirements::{require_driver, require_program};

/// A shader of 100 tokens per function, whose `mainImage` gets a statement.
fn shader(statement: &str) -> String {
    format!(
        "// Hills with a moving light.\n\
         #define LAYERS 4\n\
         #define SQUARE(x) ((x) * (x))\n\
         const float SCALE = 3.0;\n\
         struct Light {{ vec3 direction; float strength; }};\n\
         float noise(vec2 p) {{\n\
             vec2 cell = floor(p), f = fract(p);\n\
             float a = fract(cell.x * 0.37 + cell.y * 0.71);\n\
             float b = fract((cell.x + 1.0) * 0.37 + cell.y * 0.71);\n\
             return mix(a, b, SQUARE(f.x) * (3.0 - 2.0 * f.x));\n\
         }}\n\
         float height(vec2 p) {{\n\
             float sum = 0.0, weight = 0.5;\n\
             for (int i = 0; i < LAYERS; i++) {{\n\
                 sum += weight * noise(p);\n\
                 if (sum > 2.0) break;\n\
                 weight *= 0.5; p *= 2.0;\n\
             }}\n\
             return sum;\n\
         }}\n\
         vec3 shade(vec2 p, Light light) {{\n\
             vec2 e = vec2(0.01, 0.0);\n\
             vec3 n = normalize(vec3(height(p) - height(p + e), 0.1, height(p) - height(p + e.yx)));\n\
             return vec3(0.4, 0.6, 0.3) * max(dot(n, light.direction), 0.0) * light.strength;\n\
         }}\n\
         void mainImage(out vec4 color, in vec2 position) {{\n\
             vec2 p = SCALE * position / iResolution.y;\n\
             Light light = Light(normalize(vec3(1.0, 1.0, 0.5)), 0.9);\n\
             vec3 c = shade(p, light);\n\
             {statement}\n\
             color = vec4(c, 1.0);\n\
         }}\n"
    )
}

/// Reduces a shader in a folder; returns the run and the result.
fn reduced(folder: &Path, text: &str, arguments: &[&str]) -> (Run, String) {
    fs::write(folder.join("a.glsl"), text).unwrap();
    let mut all = vec!["reduce", "a.glsl", "-o", "small.glsl"];
    all.extend(arguments);
    let run = toyproof(folder, &all);
    let small = fs::read_to_string(folder.join("small.glsl")).unwrap_or_default();
    (run, small)
}

/// Asserts that a shader is reduced to at most that many tokens (names count twice), the same with one and
/// with two threads, and that reducing the result changes nothing.
fn is_reduced_to(text: &str, weight: usize, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["1", "2"].map(|jobs| {
        let arguments = [arguments, &["--jobs", jobs]].concat();
        let (run, small) = reduced(folder.path(), text, &arguments);
        assert_eq!(run.code, 0, "{run:?}");
        assert!(run.stdout.starts_with("reduced a.glsl: "), "{run:?}");
        small
    });
    assert_eq!(one, two, "the result depends on the number of threads");
    assert!(Size::of(&one).weight <= weight, "{:?}\n{one}", Size::of(&one));
    let (run, again) = reduced(folder.path(), &one, arguments);
    assert_eq!((run.code, &again), (0, &one), "{run:?}");
    one
}

#[test]
fn a_warning_is_reduced() {
    let text = shader("if (fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453) > 0.5) c *= 0.9;");
    let small = is_reduced_to(&text, 60, &["--fault", "warning=W0005"]);
    assert!(small.contains("sin("), "{small}");
}

#[test]
fn an_error_is_reduced_without_other_errors() {
    let text = shader("c = mix(c, vec3(1.0), brightness(p));");
    let small = is_reduced_to(&text, 30, &[]);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.glsl"), &small).unwrap();
    let check = toyproof(folder.path(), &["check", "small.glsl", "--device", "cpu"]);
    assert_eq!(check.stderr.matches("error[").count(), 1, "{check:?}");
}

#[test]
fn a_refusal_of_naga_is_reduced_and_reported() {
    let text = shader("mat2 m = mat2(cos(iTime + vec4(0.0, 33.0, 11.0, 0.0))); c.xy = m * c.xy;");
    let arguments = ["--fault", "naga", "--without", "matrices", "--report", "issue.md"];
    let small = is_reduced_to(&text, 40, &arguments);
    assert!(small.contains("mat2("), "{small}");
    let folder = tempfile::tempdir().unwrap();
    reduced(folder.path(), &text, &arguments);
    let report = fs::read_to_string(folder.path().join("issue.md")).unwrap();
    for part in [
        "# A valid fragment shader is not translated to SPIR-V: ",
        &small,
        "--shader-stage frag shader.frag shader.spv",
        "## Shader\n\nThis fragment shader was reduced automatically from a larger one.\n\n```glsl\n#version 450",
    ] {
        assert!(report.contains(part), "{part}\n{report}");
    }
}

#[test]
fn a_report_states_whether_glslang_accepts_the_shader() {
    if !require_program("glslangValidator") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let text = shader("mat2 m = mat2(cos(iTime + vec4(0.0, 33.0, 11.0, 0.0))); c.xy = m * c.xy;");
    let arguments = ["--fault", "naga", "--without", "matrices", "--report", "issue.md"];
    reduced(folder.path(), &text, &arguments);
    let report = fs::read_to_string(folder.path().join("issue.md")).unwrap();
    assert!(
        report.contains("`glslangValidator -V` (Glslang Version: ") && report.contains(") accepts it."),
        "{report}"
    );
}

#[cfg(unix)]
#[test]
fn a_report_on_a_command_has_its_output() {
    let folder = tempfile::tempdir().unwrap();
    let command = "if grep -q dFdx {}; then echo {}: unsupported; exit 3; fi";
    let arguments = ["--command", command, "--report", "issue.md"];
    let (run, _) = reduced(folder.path(), &shader("c += dFdx(c) * 0.1;"), &arguments);
    assert_eq!(run.code, 0, "{run:?}");
    let report = fs::read_to_string(folder.path().join("issue.md")).unwrap();
    for part in [
        "exit status 3. It prints:\n\n```text\na.glsl: unsupported\n```",
        "Save the shader as `a.glsl`, and run `if grep -q dFdx a.glsl;",
    ] {
        assert!(report.contains(part), "{part}\n{report}");
    }
}

#[cfg(unix)]
#[test]
fn a_fault_that_is_lost_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    // The command counts its runs in a file: from the fifth on, it shows no fault.
    let command = "test -f {}; echo >> runs; test $(wc -l < runs) -lt 5";
    let arguments = ["--command", command, "--jobs", "1", "--report", "issue.md"];
    let (run, _) = reduced(folder.path(), &shader(""), &arguments);
    assert!(
        run.code == 2
            && run
                .stderr
                .contains("does not show the fault when it is tested again"),
        "{run:?}"
    );
    assert!(run.stderr.contains("help: commands run in parallel"), "{run:?}");
    assert!(!folder.path().join("issue.md").exists());
}

#[test]
fn a_difference_of_the_toolchain_is_reduced() {
    if !require_driver() {
        return;
    }
    let text = shader("float t = 1.0; if (p.x > 0.5 && (t = 2.0) > 1.0) c *= 0.5; c /= t;");
    let arguments = [
        "--fault",
        "toolchain",
        "--without",
        "short-circuit",
        "--report",
        "issue.md",
    ];
    is_reduced_to(&text, 80, &arguments);
    let folder = tempfile::tempdir().unwrap();
    reduced(folder.path(), &text, &arguments);
    let report = fs::read_to_string(folder.path().join("issue.md")).unwrap();
    for part in [
        "renders wrong values",
        "pixels differ.",
        "## Expected\n\nPixel (",
        "#version 450",
        "- driver: ",
    ] {
        assert!(report.contains(part), "{part}\n{report}");
    }
}

#[test]
fn a_wrong_image_stays_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("reference.glsl"), shader("")).unwrap();
    let text = shader(
        "if (position.x < 8.0) c = vec3(1.0, 0.0, 0.0); if (position.x >= 8.0) c = vec3(0.0, 1.0, 0.0);",
    );
    let arguments = [
        "--fault",
        "verdict=wrong",
        "--reference",
        "reference.glsl",
        "--size",
        "16x9",
    ];
    let (run, small) = reduced(folder.path(), &text, &arguments);
    assert_eq!(run.code, 0, "{run:?}");
    assert!(Size::of(&small).weight < 90, "{small}");
    let compare = [
        "compare",
        "a.glsl",
        "small.glsl",
        "--size",
        "16x9",
        "--tolerance",
        "1",
    ];
    let compared = toyproof(folder.path(), &compare);
    assert_eq!(compared.code, 0, "{compared:?}\n{small}");
}

#[cfg(unix)]
#[test]
fn a_command_decides() {
    let text = shader("c += dFdx(c) * 0.1;");
    let small = is_reduced_to(&text, 40, &["--command", "grep -q dFdx {}"]);
    assert_eq!(
        small,
        "void mainImage(out vec4 color, in vec2 position) {\n    dFdx(vec3(0));\n}\n"
    );
}

#[test]
fn a_shader_without_a_fault_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let (run, small) = reduced(folder.path(), &shader(""), &["--fault", "warning=W0001"]);
    assert_eq!((run.code, small.as_str()), (2, ""));
    assert!(
        run.stderr
            .contains("error: a.glsl: the shader has no warning W0001"),
        "{run:?}"
    );
    let (run, _) = reduced(folder.path(), &shader(""), &["--command", "true"]);
    assert!(run.code == 2 && run.stderr.contains("no `{}`"), "{run:?}");
    let (run, _) = reduced(folder.path(), &shader(""), &["--fault", "crash"]);
    assert!(
        run.code == 2 && run.stderr.contains("expected naga, driver"),
        "{run:?}"
    );
    let (run, _) = reduced(folder.path(), &shader(""), &["--fault", "verdict=wrong"]);
    assert!(
        run.code == 2 && run.stderr.contains("--scene or --reference"),
        "{run:?}"
    );
}

#[test]
fn the_original_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let text = shader("c = vec3(missing);");
    fs::write(folder.path().join("a.glsl"), &text).unwrap();
    let run = toyproof(folder.path(), &["reduce", "a.glsl", "-o", "a.glsl"]);
    assert!(
        run.code == 2 && run.stderr.contains("would be overwritten"),
        "{run:?}"
    );
    let run = toyproof(folder.path(), &["reduce", "a.glsl"]);
    assert_eq!(run.code, 0, "{run:?}");
    assert_eq!(fs::read_to_string(folder.path().join("a.glsl")).unwrap(), text);
    assert!(folder.path().join("a.reduced.glsl").is_file());
    let run = toyproof(folder.path(), &["reduce", "a.reduced.glsl"]);
    assert_eq!(run.code, 0, "{run:?}");
    assert!(!folder.path().join("a.reduced.reduced.glsl").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_the_smallest_shader_so_far() {
    let folder = tempfile::tempdir().unwrap();
    let text = shader("c += dFdx(c) * 0.1;");
    fs::write(folder.path().join("a.glsl"), &text).unwrap();
    let small = folder.path().join("small.glsl");
    let slow = [
        "reduce",
        "a.glsl",
        "-o",
        "small.glsl",
        "--command",
        "sleep 0.2; grep -q dFdx {}",
    ];
    let child = command(folder.path())
        .args(slow)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let child = child.unwrap();
    let start = Instant::now();
    while fs::metadata(&small).map_or(true, |file| file.len() >= text.len() as u64) {
        assert!(start.elapsed() < Duration::from_secs(60), "nothing is written");
        std::thread::sleep(Duration::from_millis(20));
    }
    let pid = rustix::process::Pid::from_raw(child.id() as i32).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::INT).unwrap();
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && stderr.contains("ended before it was complete"),
        "{stderr}"
    );
    let kept = fs::read_to_string(&small).unwrap();
    assert!(kept.contains("dFdx") && kept.len() < text.len(), "{kept}");
    let go_on = [
        "reduce",
        "small.glsl",
        "-o",
        "end.glsl",
        "--command",
        "grep -q dFdx {}",
    ];
    assert_eq!(run(command(folder.path()).args(go_on)).code, 0);
    let end = fs::read_to_string(folder.path().join("end.glsl")).unwrap();
    assert!(end.len() < 80, "{end}");
}

/// A project whose Buffer A fades waves and whose Buffer B is noise; the image shows one of both.
fn waves(folder: &Path, [noise, choice]: [&str; 2]) {
    let folder = folder.join("waves");
    fs::create_dir(&folder).unwrap();
    let common = "// Shared.\n#define TAU 6.28\nfloat unused(float x) { return x * x; }\n\
                  float hash(vec2 p) { return fract(p.x * 0.37 + p.y * 0.71); }\n";
    let fading = "void mainImage(out vec4 color, in vec2 position) {\n\
                  vec4 old = texelFetch(iChannel0, ivec2(position), 0);\n\
                  float wave = sin(position.x * TAU + iTime) * 0.5 + 0.5;\n\
                  if (iFrame == 0) { old = vec4(0.0); }\n\
                  color = mix(old, vec4(wave, hash(position), 0.0, 1.0), 0.5);\n}\n";
    let noise =
        format!("void mainImage(out vec4 color, in vec2 p) {{ float x = {noise}; color = vec4(x); }}\n");
    let image = format!(
        "void mainImage(out vec4 color, in vec2 position) {{\n\
         vec4 a = texelFetch(iChannel0, ivec2(position), 0);\n\
         vec4 b = texelFetch(iChannel1, ivec2(position), 0);\n\
         color = {choice} ? a : b;\n}}\n"
    );
    let toml = "[[pass]]\ntab = \"common\"\n\
                [[pass]]\ntab = \"buffer-a\"\ninputs = [{ channel = 0, source = \"buffer-a\" }]\n\
                [[pass]]\ntab = \"buffer-b\"\ninputs = []\n\
                [[pass]]\ntab = \"image\"\ninputs = [{ channel = 0, source = \"buffer-a\" }, \
                { channel = 1, source = \"buffer-b\" }, { channel = 2, source = \"keyboard\" }]\n";
    let files = [
        ("common.glsl", common),
        ("buffer-a.glsl", fading),
        ("buffer-b.glsl", &noise),
        ("image.glsl", &image),
        ("project.toml", toml),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
}

#[test]
fn a_pass_that_shows_the_fault_alone_is_reduced_to_a_shader() {
    let folder = tempfile::tempdir().unwrap();
    let noise = "fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453)";
    waves(folder.path(), [noise, "a.x > 0.6"]);
    let run = toyproof(folder.path(), &["reduce", "waves", "--fault", "warning=W0005"]);
    assert!(
        run.code == 0 && run.stderr.contains("fault of Buffer B alone: warning W0005"),
        "{run:?}"
    );
    let small = fs::read_to_string(folder.path().join("waves.reduced.glsl")).unwrap();
    assert!(small.contains("sin(") && Size::of(&small).weight < 60, "{small}");
    let run = toyproof(
        folder.path(),
        &["reduce", "waves", "--fault", "warning=W0005", "-o", "waves"],
    );
    assert!(
        run.code == 2 && run.stderr.contains("the result is one shader"),
        "{run:?}"
    );
}

#[test]
fn a_tab_that_does_not_compile_is_reduced() {
    let folder = tempfile::tempdir().unwrap();
    waves(folder.path(), ["hash(p) + p", "a.x > 0.6"]);
    let run = toyproof(folder.path(), &["reduce", "waves"]);
    assert!(
        run.code == 0 && run.stderr.contains("fault of Buffer B alone: error E0"),
        "{run:?}"
    );
    let small = fs::read_to_string(folder.path().join("waves.reduced.glsl")).unwrap();
    assert!(Size::of(&small).weight < 30, "{small}");
}

#[test]
fn a_wrong_image_is_reduced_to_the_passes_that_it_needs() {
    let folder = tempfile::tempdir().unwrap();
    waves(folder.path(), ["hash(p)", "hash(position) > 2.0 && b.x < 2.0"]);
    fs::write(
        folder.path().join("black.glsl"),
        "void mainImage(out vec4 color, in vec2 position) { color = vec4(0.0, 0.0, 0.0, 1.0); }\n",
    )
    .unwrap();
    let reference = ["--reference", "black.glsl", "--size", "8x8", "--frame", "2"];
    let arguments = [
        "reduce",
        "waves",
        "--fault",
        "verdict=wrong",
        "--report",
        "issue.md",
    ];
    let run = toyproof(folder.path(), &[&arguments[..], &reference].concat());
    assert_eq!(run.code, 0, "{run:?}");
    let small = folder.path().join("waves.reduced");
    let names = [
        "common.glsl",
        "buffer-a.glsl",
        "buffer-b.glsl",
        "image.glsl",
        "project.toml",
    ];
    let left = names.map(|name| small.join(name).is_file());
    assert_eq!(left, [false, false, true, true, true]);
    let toml = fs::read_to_string(small.join("project.toml")).unwrap();
    assert!(toml.contains("buffer-b") && !toml.contains("keyboard"), "{toml}");
    let report = fs::read_to_string(folder.path().join("issue.md")).unwrap();
    for part in [
        "`buffer-b.glsl`:\n\n```glsl\nvoid mainImage(",
        "Save the files in a folder `waves.reduced`, and run `toyproof check waves.reduced ",
    ] {
        assert!(report.contains(part), "{part}\n{report}");
    }
    let check = [&["check", "waves.reduced", "--device", "cpu"][..], &reference].concat();
    assert_eq!(toyproof(folder.path(), &check).code, 1);
    // Reducing the result changes nothing.
    let before = names.map(|name| fs::read(small.join(name)).ok());
    let again = [
        &["reduce", "waves.reduced", "--fault", "verdict=wrong"][..],
        &reference,
    ]
    .concat();
    let run = toyproof(folder.path(), &again);
    assert_eq!(run.code, 0, "{run:?}");
    assert_eq!(names.map(|name| fs::read(small.join(name)).ok()), before);
}

#[cfg(unix)]
#[test]
fn a_command_gets_the_folder_of_a_project() {
    let folder = tempfile::tempdir().unwrap();
    waves(folder.path(), ["hash(p)", "a.x > 0.6"]);
    let command = "grep -q 'sin(' {}/buffer-a.glsl";
    let run = toyproof(
        folder.path(),
        &["reduce", "waves", "--command", command, "-o", "small"],
    );
    assert_eq!(run.code, 0, "{run:?}");
    let small = |name: &str| fs::read_to_string(folder.path().join("small").join(name)).ok();
    assert_eq!(
        small("buffer-a.glsl").as_deref(),
        Some("void mainImage(out vec4 color, in vec2 position) {\n    sin(0.);\n}\n")
    );
    assert_eq!(small("buffer-b.glsl"), None);
    let run = toyproof(
        folder.path(),
        &["reduce", "waves", "--command", command, "-o", "small"],
    );
    assert!(
        run.code == 2 && run.stderr.contains("small has a project already"),
        "{run:?}"
    );
}
