//! One submission cannot harm another, the reports, or the terminal of the user.

use std::fs;
use std::path::Path;

use crate::program::toyproof;

const SHADER: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0.5, 1.0); }\n";
const FLAGS: [&str; 6] = ["--size", "16x9", "--device", "cpu", "--jobs", "1"];

fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

#[test]
fn folders_named_like_reports_or_images_do_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let reports = [
        "report.html",
        "report.csv",
        "junit.xml",
        "report.sarif",
        "results.json",
        "results.jsonl",
        "verdict.json",
    ];
    for name in reports {
        write(folder.path(), &format!("hw/{name}/x.glsl"), SHADER);
    }
    write(folder.path(), "hw/good-actual.png/x.glsl", SHADER);
    write(folder.path(), "hw/good.glsl", SHADER);
    write(folder.path(), "rubric.toml", "[precision]\npoints = 1\n");
    let arguments = ["check", "hw", "--out", "out", "--rubric", "rubric.toml"];
    let run = toyproof(folder.path(), &[&arguments[..], &FLAGS].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let out = folder.path().join("out");
    for name in reports {
        assert!(out.join(name).is_file(), "{name}");
        assert!(out.join(format!("{name}-2/x-actual.png")).is_file(), "{name}");
    }
    let images = ["good-actual.png/x-actual.png", "good.glsl-actual.png"];
    assert!(images.iter().all(|image| out.join(image).is_file()));
    let results = fs::read_to_string(out.join("results.jsonl")).unwrap();
    assert_eq!(results.lines().count(), reports.len() + 2);
}

#[cfg(unix)]
#[test]
fn links_among_submissions_do_not_redirect_outputs() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let hw = folder.path().join("hw");
    write(folder.path(), "hw/x.glsl", SHADER);
    write(folder.path(), "victim", "mine");
    let links = [
        "report.csv",
        "results.jsonl",
        "x-actual.png",
        "x-algorithm.png",
        "x.png",
        "x.wgsl",
    ];
    for link in links {
        symlink(folder.path().join("victim"), hw.join(link)).unwrap();
    }
    let check = ["check", "hw", "--out", "hw"];
    let run = ["run", "hw", "-o", "hw", "--size", "16x9", "--device", "cpu"];
    let convert = ["convert", "hw", "-o", "hw", "--to", "wgsl"];
    for arguments in [[&check[..], &FLAGS].concat(), run.to_vec(), convert.to_vec()] {
        let run = toyproof(folder.path(), &arguments);
        assert_eq!(run.code, 0, "{arguments:?}: {}", run.stderr);
        assert_eq!(
            fs::read_to_string(folder.path().join("victim")).unwrap(),
            "mine",
            "{arguments:?}"
        );
    }
    assert!(hw.join("x-actual.png").is_file() && !hw.join("x-algorithm.png").exists());
}

/// Names and texts that try to move the cursor, to color the terminal, or to imitate other output.
#[cfg(unix)]
#[test]
fn names_and_texts_cannot_affect_terminals_and_reports() {
    let folder = tempfile::tempdir().unwrap();
    let hostile = "\u{1b}[31m\r\u{c}\u{7f}\u{85}\u{9b}2J\u{2028}\u{202e}\u{2066}";
    let forged = format!("hw/a\ncorrect      z.glsl: all pixels agree{hostile}");
    write(folder.path(), &format!("{forged}.glsl"), SHADER);
    write(folder.path(), &format!("{forged}.toml"), "nonsense = 1\n");
    let text =
        format!("#error {hostile}\n// {hostile}\nvoid mainImage(out vec4 c, in vec2 p) {{ c = {hostile}; }}");
    write(folder.path(), "hw/b.glsl", &text);
    let unknown = format!("{SHADER}{}", "float \u{202e}x\u{9b};");
    write(folder.path(), "hw/c.glsl", &unknown);

    for format in ["human", "json"] {
        let arguments = ["check", "hw", "--out", "out", "--format", format];
        let run = toyproof(folder.path(), &[&arguments[..], &FLAGS].concat());
        assert_eq!(run.code, 2, "{}", run.stderr);
        let line = run.stdout.lines().find(|line| line.starts_with("correct"));
        assert_eq!(line, None, "a forged line");
        for (channel, text) in [("stdout", &run.stdout), ("stderr", &run.stderr)] {
            harmless(channel, text);
        }
        assert!(format!("{}{}", run.stdout, run.stderr).contains("\\u{202e}"));
    }
    for report in [
        "report.html",
        "report.csv",
        "junit.xml",
        "report.sarif",
        "verdict.json",
        "results.jsonl",
    ] {
        harmless(
            report,
            &fs::read_to_string(folder.path().join("out").join(report)).unwrap(),
        );
    }
}

/// Asserts that a text has no control characters except line ends and tabs, which belong to the formats.
#[cfg(unix)]
fn harmless(channel: &str, text: &str) {
    for (at, line) in text.lines().enumerate() {
        let acts = |c: char| {
            (c.is_control() && c != '\t')
                || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        };
        assert!(!line.contains(acts), "{channel}, line {}: {line:?}", at + 1);
    }
}
