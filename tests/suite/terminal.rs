//! What a terminal shows: colors, wrapped text, interrupts, confirmations, completions and manual pages.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;
use toyproof::diagnostic::display_width;

use crate::program::{command, output, run, toyproof};
use crate::requirements::require_program;
use crate::support::wait::wait_until;
use crate::support::{MANY_OBJECTS, SPHERE};

/// A folder with a correct, a wrong and an invalid shader, a scene, and a long name.
fn homework() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("scene.toml", SPHERE.scene);
    fs::create_dir(folder.path().join("hw")).unwrap();
    write("hw/correct.glsl", SPHERE.shader);
    let wrong = SPHERE
        .shader
        .replace("sphere.radius * sphere.radius", "sphere.radius");
    assert_ne!(wrong, SPHERE.shader);
    write("hw/wrong-with-quite-a-long-name.glsl", &wrong);
    write(
        "hw/invalid.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n  c = vec4(1)\n  d = 1;\n}\n",
    );
    write("hw/none.glsl", "");
    folder
}

const CHECK: &str = "check hw --scene scene.toml --size 32x18 --device cpu";

fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

#[test]
fn colors_follow_the_flag_and_the_environment() {
    let folder = homework();
    let has_colors = |flags: &str, variable: Option<&str>| {
        let mut command = command(folder.path());
        command.args(words(&format!("{CHECK} {flags}")));
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
        command.envs(variable.map(|name| (name, "1")));
        let run = run(&mut command);
        let text = run.stdout + &run.stderr;
        assert!(text.contains("wrong"), "{text}");
        text.contains('\u{1b}')
    };
    assert!(!has_colors("--color auto", None), "in a pipe");
    assert!(has_colors("--color always", None));
    assert!(has_colors("--color always", Some("NO_COLOR")));
    assert!(has_colors("--color auto", Some("CLICOLOR_FORCE")));
    assert!(!has_colors("--color never", Some("CLICOLOR_FORCE")));
    let usage = |color: &str| toyproof(folder.path(), &["check", "--nonsense", "--color", color]).stderr;
    assert!(usage("always").contains('\u{1b}') && !usage("never").contains('\u{1b}'));
}

/// Runs the program on a terminal of this width, and returns what it showed.
fn on_terminal(folder: &Path, arguments: &str, columns: u32, variables: &str) -> String {
    let program = env!("CARGO_BIN_EXE_toyproof");
    let line = format!("stty cols {columns} rows 50; {variables} {program} {arguments}");
    let output = Command::new("script")
        .args(["-qec", &line, "/dev/null"])
        .current_dir(folder)
        .env_remove("NO_COLOR")
        .env("TERM", "xterm")
        .stdin(Stdio::null())
        .output()
        .unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// The lines that are left on a terminal: what follows the last carriage return or erasure of each.
fn remaining_lines(shown: &str) -> Vec<String> {
    let lines = shown.lines().map(|line| {
        let line = line.trim_end_matches('\r');
        let line = line.rsplit(['\r']).next().unwrap();
        line.rsplit("\u{1b}[2K").next().unwrap().to_owned()
    });
    lines.collect()
}

#[test]
fn lines_wrap_at_the_width_of_the_terminal() {
    if !require_program("script") {
        return;
    }
    let folder = homework();
    for columns in [60, 80, 100] {
        let shown = on_terminal(folder.path(), CHECK, columns, "");
        let lines = remaining_lines(&shown);
        assert!(
            lines.iter().any(|line| line.contains("likely mistake: ")),
            "{shown}"
        );
        for line in lines {
            assert!(display_width(&line) <= columns as usize, "{columns}: {line}");
        }
    }
}

#[test]
fn progress_bars_have_no_colors_where_none_are_wanted() {
    if !require_program("script") {
        return;
    }
    let folder = homework();
    // Colors and bold text; moving the cursor is no color.
    let has_colors = |shown: &str| shown.contains("\u{1b}[1m") || shown.contains("\u{1b}[3");
    assert!(has_colors(&on_terminal(folder.path(), CHECK, 100, "")));
    let plain = on_terminal(folder.path(), CHECK, 100, "NO_COLOR=1");
    assert!(!has_colors(&plain), "{plain:?}");
    let flag = on_terminal(folder.path(), &format!("{CHECK} --color never"), 100, "");
    assert!(!has_colors(&flag), "{flag:?}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_sequence_names_the_way_to_resume() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.glsl"), MANY_OBJECTS.shader).unwrap();
    let arguments = "run s.glsl -o s.png --frames 0..99999 --size 64x36 --device cpu";
    let running = command(folder.path())
        .args(words(arguments))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until(|| folder.path().join("s-00002.png").is_file());
    let interrupt = Command::new("kill")
        .args(["-INT", &running.id().to_string()])
        .status();
    assert!(interrupt.unwrap().success());
    let output = running.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(
        stderr.contains("interrupted after ") && stderr.contains(" of 100,000 frames"),
        "{stderr}"
    );
    assert!(
        stderr.contains("help: run the same command again to render the others"),
        "{stderr}"
    );
}

#[test]
fn a_quiet_check_prints_one_line_for_each_shader() {
    let folder = homework();
    let quiet = toyproof(folder.path(), &words(&format!("{CHECK} -q")));
    assert_eq!((quiet.stdout.lines().count(), quiet.stderr.as_str()), (4, ""));
    let short = toyproof(folder.path(), &words(&format!("{CHECK} --format short")));
    assert!(
        short.stdout.lines().all(|line| line.starts_with("hw/")),
        "{}",
        short.stdout
    );
    assert_eq!(short.stdout.matches("error[E").count(), 3, "{}", short.stdout);
}

#[test]
fn every_written_file_is_confirmed() {
    let folder = homework();
    for (arguments, file, facts) in [
        (
            "render scene.toml --size 32x18",
            "scene.png",
            "32×18, 1 sample per pixel, f64, ",
        ),
        (
            "run hw/correct.glsl --size 32x18 --device cpu",
            "correct.png",
            "32×18, f32 on CPU, ",
        ),
        ("export scene.toml -o exported.glsl", "exported.glsl", " kB"),
        (
            "convert hw/correct.glsl -o correct.wgsl",
            "correct.wgsl",
            "hw/correct.glsl → ",
        ),
        (
            "run hw/correct.glsl --size 8x8 --device cpu -o f.png --frames 0..2",
            "f-0002.png",
            "3 frames",
        ),
    ] {
        let run = toyproof(folder.path(), &words(arguments));
        assert_eq!(run.code, 0, "{arguments}: {}", run.stderr);
        assert!(folder.path().join(file).is_file(), "{arguments}");
        assert!(run.stderr.contains(facts), "{arguments}: {}", run.stderr);
        let quiet = toyproof(folder.path(), &words(&format!("{arguments} -q")));
        assert_eq!(quiet.stderr, "", "{arguments}");
    }
}

#[test]
fn texts_go_to_standard_output_by_default() {
    let folder = homework();
    let wgsl = toyproof(folder.path(), &["convert", "hw/correct.glsl"]);
    assert!(wgsl.stdout.contains("fn mainImage("), "{}", wgsl.stdout);
    let shader = toyproof(folder.path(), &["export", "scene.toml"]);
    assert!(shader.stdout.contains("void mainImage("), "{}", shader.stdout);
    let several = toyproof(folder.path(), &["convert", "hw"]);
    assert_eq!(several.code, 2);
    assert!(
        several.stderr.contains("help: name a folder with -o"),
        "{}",
        several.stderr
    );
}

#[test]
fn results_are_available_as_json() {
    let folder = homework();
    let json = |arguments: &str| -> Value {
        let run = toyproof(folder.path(), &words(arguments));
        serde_json::from_str(&run.stdout)
            .unwrap_or_else(|error| panic!("{arguments}: {error}: {}", run.stdout))
    };
    let run = json("run hw/correct.glsl -o x.png --size 8x4 --device cpu --precision f64 --format json");
    assert_eq!(
        (&run[0]["output"], &run[0]["size"]),
        (&"x.png".into(), &serde_json::json!([8, 4]))
    );
    assert_eq!(run[0]["precision"], "f64");
    let converted = json("convert hw -o wgsl --format json");
    let statuses: Vec<_> = converted
        .as_array()
        .unwrap()
        .iter()
        .map(|one| &one["status"])
        .collect();
    assert_eq!(statuses, ["converted", "refused", "refused", "converted"]);
    let error = &converted[1]["diagnostics"][0];
    assert_eq!((&error["line"], &error["code"]), (&2.into(), &"E0100".into()));
    assert!(
        error["end_line"].is_u64() && error["fix"]["replacement"] == ";",
        "{error}"
    );
    assert_eq!(json("doctor --device cpu --format json")["selected"], "cpu");
    let report = json(&format!("{CHECK} --format json"));
    let wrong = &report["shaders"][3];
    assert_eq!(
        (&report["version"], &wrong["mistake"]["id"]),
        (&2.into(), &"radius-not-squared".into())
    );
    assert_eq!(wrong["help"], "toyproof explain radius-not-squared");
}

#[test]
fn codes_and_mistakes_are_explained() {
    let explain = |arguments: &[&str]| toyproof(Path::new("."), &[&["explain"], arguments].concat());
    let two = explain(&["w0602", "far-root"]);
    assert_eq!(two.code, 0, "{}", two.stderr);
    assert!(
        two.stdout.starts_with("W0602: ") && two.stdout.contains("\nfar-root: "),
        "{}",
        two.stdout
    );
    assert!(two.stdout.contains("How to fix it: "), "{}", two.stdout);
    let near = explain(&["far-rot"]);
    assert_eq!(
        (near.code, near.stderr.as_str()),
        (
            2,
            "error: unknown code `far-rot`\nhelp: did you mean `far-root`?\n"
        )
    );
    let shader = explain(&["mine.glsl"]);
    assert!(
        shader.stderr.contains("toyproof debug SHADER --pixel X,Y"),
        "{}",
        shader.stderr
    );
    // The titles of codes contain “internal error”, which `run` does not accept.
    let listed = output(command(Path::new(".")).args(["explain", "--list"])).stdout;
    assert!(
        listed.contains("\nE0301  ") && listed.contains("\nfar-root  "),
        "{listed}"
    );
}

#[test]
fn terms_are_explained() {
    let run = toyproof(Path::new("."), &["explain", "ill-conditioned"]);
    assert!(
        run.stdout
            .starts_with("ill-conditioned: A pixel whose color changes"),
        "{}",
        run.stdout
    );
    assert_eq!(run.stdout.lines().count(), 1);
}

/// Of many shaders, the warnings of those without a good verdict may explain it.
#[test]
fn a_late_shader_in_a_folder_lists_its_warnings() {
    let folder = homework();
    let endless = "void mainImage(out vec4 c, in vec2 p) {\n  c = p.xyxy;\n  while (true) c.x += 1.0;\n}\n";
    fs::write(folder.path().join("hw/endless.glsl"), endless).unwrap();
    let run = toyproof(folder.path(), &words(&format!("{CHECK} --timeout 1")));
    assert!(run.stdout.contains("\n             3:"), "{}", run.stdout);
    assert!(
        run.stdout.contains("[W0009]\n             the loop does not end")
            && run
                .stdout
                .contains("\n             help: toyproof explain W0009\n"),
        "{}",
        run.stdout
    );
    assert!(!run.stderr.contains("-v shows them"), "{}", run.stderr);
}

#[test]
fn the_name_of_a_built_in_scene_is_recognized_where_a_shader_is_expected() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in ["check 02-sphere", "run 02-sphere", "convert 02-sphere"] {
        let run = toyproof(folder.path(), &words(arguments));
        let all = run.stdout + &run.stderr;
        assert!(
            all.contains("`02-sphere` is a built-in scene"),
            "{arguments}: {all}"
        );
    }
}

#[test]
fn shells_and_man_know_every_command() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = toyproof(folder.path(), &["completions", shell]).stdout;
        for name in crate::commands::COMMANDS {
            assert!(script.contains(name), "{shell}: {name}");
        }
        assert!(!script.contains("__worker"), "{shell}");
    }
    let page = toyproof(folder.path(), &["man"]).stdout;
    assert!(page.contains(".TH toyproof 1"), "{page}");
    assert_eq!(toyproof(folder.path(), &["man", "-o", "man1", "-q"]).code, 0);
    for name in crate::commands::COMMANDS {
        let page = folder.path().join(format!("man1/toyproof-{name}.1"));
        assert!(fs::read_to_string(&page).unwrap().contains("SYNOPSIS"), "{name}");
    }
}

#[test]
fn hidden_commands_are_not_suggested() {
    let run = toyproof(Path::new("."), &["wrker"]);
    assert!(run.code == 2 && !run.stderr.contains("worker"), "{}", run.stderr);
    let near = toyproof(Path::new("."), &["rendr"]);
    assert!(near.stderr.contains("'render'"), "{}", near.stderr);
}
