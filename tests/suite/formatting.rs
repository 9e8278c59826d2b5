//! `fmt`: the tree of a shader does not change, and what is formatted stays as it is.

use std::fs;
use std::io::Write;
use std::process::Stdio;

use toyproof::diagnostic::{File, Files};
use toyproof::format::format;
use toyproof::glsl::{Options, check, lexemes};

use crate::program::{command, toyproof};
use crate::requirements::require_folder;
use crate::support::generate::{Arithmetic, Effects, program};
use crate::support::{EXERCISES, setting};

/// The expressions and statements of a shader, without places; `None` if it does not compile.
fn tree(text: &str) -> Option<String> {
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let tree = check(&files, file, &Options::default()).ok()?.tree;
    let exprs = tree
        .exprs
        .iter()
        .map(|(_, expr)| format!("{:?} {:?}", expr.kind, expr.ty));
    let variables = tree.variables.iter();
    let variables =
        variables.map(|(_, variable)| format!("{} {:?} {:?}", variable.name, variable.ty, variable.kind));
    Some(exprs.chain(variables).collect::<Vec<_>>().join("\n"))
}

/// The lines whose code is longer than 100 columns. What is one token, with what stays on its line, counts
/// only if it could be broken.
fn long_lines(text: &str) -> Vec<String> {
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let tokens = lexemes(&files, file);
    let lines = text.lines().enumerate().filter(|(number, line)| {
        let ends = tokens
            .iter()
            .filter(|token| files.position(token.span).line == number + 1);
        let last = ends.map(|token| files.end_position(token.span).column - 1).max();
        last.is_some_and(|end| end > 100) && line.contains(", ")
    });
    lines.map(|(_, line)| line.to_owned()).collect()
}

/// Formats a text and checks the result.
fn assert_formatted(name: &str, text: &str) -> String {
    let formatted = format(text).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(
        format(&formatted).expect("it was formatted before"),
        formatted,
        "{name} changes when it is formatted again"
    );
    assert!(tree(text) == tree(&formatted), "{name}: the tree changes");
    formatted
}

#[test]
fn the_trees_of_the_course_and_of_random_programs_stay() {
    for exercise in EXERCISES {
        let formatted = assert_formatted(exercise.name, exercise.shader);
        assert!(tree(&formatted).is_some());
        assert_eq!(long_lines(&formatted), [""; 0], "{}", exercise.name);
    }
    for seed in 0..setting("TOYPROOF_PROGRAMS", 40_u32) {
        let bytes: Vec<_> = (0..2000_u32)
            .map(|index| {
                (index
                    .wrapping_add(seed.wrapping_mul(2001))
                    .wrapping_mul(2_654_435_761)
                    >> 24) as u8
            })
            .collect();
        let text = program(&bytes, Effects::Anywhere, Arithmetic::Any);
        assert!(tree(&text).is_some(), "{text}");
        // As if an author had written it on one line, where no directive and no comment needs its own.
        let line = text.replace('\n', " ");
        for text in [&text, &line] {
            assert_formatted(&format!("program {seed}"), text);
        }
    }
}

#[test]
#[ignore = "takes minutes, and a folder of shaders that TOYPROOF_SHADERS names"]
fn the_trees_of_other_shaders_stay() {
    let Some(folder) = require_folder("TOYPROOF_SHADERS") else {
        return;
    };
    let (mut count, mut compile, mut long) = (0, 0, 0);
    for entry in walkdir::WalkDir::new(folder).sort_by_file_name() {
        let entry = entry.unwrap();
        if entry
            .path()
            .extension()
            .is_none_or(|extension| extension != "glsl")
        {
            continue;
        }
        let name = entry.path().display().to_string();
        let text = String::from_utf8_lossy(&fs::read(entry.path()).unwrap()).into_owned();
        if text.contains("__LINE__") {
            eprintln!("{name}: its meaning depends on its lines");
            continue;
        }
        let formatted = assert_formatted(&name, &text);
        count += 1;
        compile += usize::from(tree(&text).is_some());
        for line in long_lines(&formatted) {
            long += 1;
            eprintln!("{name}: {line}");
        }
    }
    eprintln!("{count} shaders, {compile} of which compile, {long} long lines");
    assert!(count > 0);
}

#[test]
fn files_are_formatted_in_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let (untidy, tidy) = (
        "void mainImage(out vec4 c,in vec2 p){\nc=vec4(p,0,1);}\n",
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(p, 0, 1);\n}\n",
    );
    fs::create_dir(path("project")).unwrap();
    for (name, text) in [
        ("a.glsl", untidy),
        ("b.glsl", tidy),
        ("project/image.glsl", untidy),
        ("project/common.glsl", "float  a;"),
        ("deep.glsl", &"(".repeat(1000)),
    ] {
        fs::write(path(name), text).unwrap();
    }
    let run = toyproof(folder.path(), &["fmt", "--check", "a.glsl", "b.glsl", "project"]);
    assert_eq!(
        (run.code, &*run.stdout, &*run.stderr),
        (
            1,
            "a.glsl\nproject/common.glsl\nproject/image.glsl\n",
            "3 files not formatted, 1 unchanged\n"
        )
    );
    assert_eq!(fs::read_to_string(path("a.glsl")).unwrap(), untidy);
    let run = toyproof(
        folder.path(),
        &["fmt", "a.glsl", "b.glsl", "project", "deep.glsl"],
    );
    let error = "error: deep.glsl:1:1: blocks, brackets or conditions are nested too deeply";
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains(error), "{}", run.stderr);
    assert_eq!(
        run.stdout,
        "formatted a.glsl\nformatted project/common.glsl\nformatted project/image.glsl\n"
    );
    for (name, text) in [
        ("a.glsl", tidy),
        ("project/image.glsl", tidy),
        ("project/common.glsl", "float a;\n"),
    ] {
        assert_eq!(fs::read_to_string(path(name)).unwrap(), text, "{name}");
    }
    let run = toyproof(folder.path(), &["fmt", "--check", "a.glsl", "project"]);
    assert_eq!((run.code, &*run.stdout), (0, ""));
}

#[test]
fn standard_input_is_formatted_to_standard_output() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = command(folder.path())
        .args(["fmt", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(b"float  x=1.;").unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "float x = 1.;\n");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn what_is_no_text_of_a_shader_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.json"), r#"{"renderpass": [], "info": {}}"#).unwrap();
    for (name, message) in [
        (
            "a.json",
            "JSON is not formatted\nhelp: write it as files with `toyproof import`",
        ),
        ("none.glsl", "none.glsl"),
    ] {
        let run = toyproof(folder.path(), &["fmt", name]);
        assert_eq!((run.code, &*run.stdout), (2, ""));
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
}
