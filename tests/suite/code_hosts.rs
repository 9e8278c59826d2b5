//! What code hosts and editors read: the problem matcher, the hook of pre-commit, and the example of a classroom.

use std::fs;
use std::path::Path;

use regex::Regex;
use serde_json::Value;

use crate::program::toyproof;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_problem_matcher_matches_each_message() {
    let matcher = fs::read_to_string(root().join("packaging/problem-matcher.json")).unwrap();
    let matcher: Value = serde_json::from_str(&matcher).unwrap();
    let pattern = &matcher["problemMatcher"][0]["pattern"][0];
    let page = fs::read_to_string(root().join("docs/guide/editors-and-ci.md")).unwrap();
    let regexp = pattern["regexp"].as_str().unwrap();
    assert!(
        page.contains(regexp),
        "the guide shows another expression than {regexp}"
    );

    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    float unused = 1.0;\n    c = vec3(p, x);\n}\n";
    fs::write(folder.path().join("a:1 b.glsl"), text).unwrap();
    let run = toyproof(
        folder.path(),
        &["check", "a:1 b.glsl", "--format", "short", "--device", "cpu"],
    );
    let lines: Vec<_> = run.stdout.lines().collect();
    assert!(!lines.is_empty(), "{run:?}");
    let regexp = Regex::new(regexp).unwrap();
    for line in lines {
        let groups = regexp
            .captures(line)
            .unwrap_or_else(|| panic!("not matched: {line}"));
        let group = |name: &str| &groups[pattern[name].as_u64().unwrap() as usize];
        assert_eq!(
            (group("file"), group("line"), group("severity")),
            ("a:1 b.glsl", "3", "error")
        );
        assert!(
            group("code").starts_with('E') && !group("message").is_empty(),
            "{line}"
        );
    }
}

#[test]
fn the_classrooms_exercise_can_be_solved() {
    let classroom = root().join("examples/classroom");
    let folder = tempfile::tempdir().unwrap();
    let start = fs::read_to_string(classroom.join("sphere.glsl")).unwrap();
    let gap = "    return COLOR * AMBIENT;";
    assert!(start.contains(gap), "{start}");
    let solved = start.replace(
        gap,
        "vec3 toLight = normalize(vec3(5.0, 5.0, 0.0) - point);\n\
         float cosine = max(dot((point - CENTER) / RADIUS, toLight), 0.0);\n\
         return COLOR * (AMBIENT + vec3(0.9, 0.9, 0.8) * cosine);",
    );
    let assignment = classroom.join("assignment.toml");
    for (text, verdict) in [(start, "wrong"), (solved, "correct")] {
        fs::write(folder.path().join("sphere.glsl"), text).unwrap();
        let assignment = assignment.to_str().unwrap();
        let run = toyproof(
            folder.path(),
            &[
                "check",
                "sphere.glsl",
                "--assignment",
                assignment,
                "--device",
                "cpu",
                "--search",
                "0",
            ],
        );
        assert!(run.stdout.starts_with(verdict), "{run:?}");
    }
}

#[test]
fn hooks_read_every_extension_of_shaders() {
    let hooks = fs::read_to_string(root().join(".pre-commit-hooks.yaml")).unwrap();
    let files = hooks
        .lines()
        .find_map(|line| line.trim().strip_prefix("files: "))
        .unwrap();
    let files = Regex::new(files).unwrap();
    for name in ["a.glsl", "b/c.frag", "d.fs", "e.shadertoy"] {
        assert!(files.is_match(name), "{name}");
    }
    assert!(!files.is_match("glsl/notes.md"));
}
