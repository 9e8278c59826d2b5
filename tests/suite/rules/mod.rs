//! The rules of GLSL ES 3.00, chapter by chapter, each from both sides: programs that break it, and programs
//! that follow it and compute something that holds only if it was understood.
//!
//! `tests/rules/CHAPTER.glsl` holds many small programs. Each begins with a line `//# § VERDICT rule`:
//!
//! - `holds`: a program with a `bool holds()`, which is true in [`frame`]; or with its own `mainImage`, whose
//!   red is then 1.
//! - `E0200`, or `error` where the specification leaves open which rule is broken first: a program that is
//!   rejected with errors of that code on each line that ends in `//!`, and on no other. Without such a line,
//!   the error concerns the whole text.
//!
//! Where compilers differ, the line `//` below the header states how, and the reason for our choice.

mod accepted;
mod refused;

use std::fs;

use toyproof::image::{Frame, Image};

/// The expected result of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Expectation {
    /// Its red is 1.
    Holds,
    /// It is rejected on these lines (from 1), with this code if one is specified.
    Refused { code: Option<String>, lines: Vec<usize> },
}

/// A program of the collection.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    /// Its position in the collection: file, line, section of the specification, and rule.
    pub(crate) name: String,
    /// The complete text, with its `mainImage`.
    pub(crate) text: String,
    pub(crate) expectation: Expectation,
}

/// The `mainImage` of programs with `holds`.
const PAINTS_WHETHER_IT_HOLDS: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(holds()); }\n";

/// The `mainImage` of programs that break a rule.
const PAINTS_NOTHING: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }\n";

/// Reads the whole collection.
pub(crate) fn programs() -> Vec<Program> {
    let mut paths: Vec<_> = fs::read_dir("tests/rules")
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    paths
        .iter()
        .flat_map(|path| {
            let chapter = path.file_stem().unwrap().to_str().unwrap();
            read(chapter, &fs::read_to_string(path).unwrap())
        })
        .collect()
}

/// The frame of every program of the collection: one pixel, two seconds, the fourth frame, and in channel 0
/// texels (x/4, y/4, 1/2, 1).
pub(crate) fn frame() -> Frame {
    let texels = (0..16).map(|at| [(at % 4) as f32 / 4.0, (at / 4) as f32 / 4.0, 0.5, 1.0]);
    Frame {
        size: [1, 1],
        time: 2.0,
        frame: 3,
        mouse: [1.0, 2.0, 3.0, 4.0],
        date: [2025.0, 0.0, 1.0, 3600.0],
        channels: [Some(Image::new(4, 4, texels.collect()).into()), None, None, None],
        ..Frame::default()
    }
}

fn read(chapter: &str, text: &str) -> Vec<Program> {
    // The text before the first header describes the chapter.
    let mut rest = text.split_inclusive('\n').zip(1..).peekable();
    while rest.next_if(|(line, _)| !line.starts_with("//# ")).is_some() {}
    let mut programs = Vec::new();
    while let Some((header, at)) = rest.next() {
        let mut body = String::new();
        while let Some((line, _)) = rest.next_if(|(line, _)| !line.starts_with("//# ")) {
            body.push_str(line);
        }
        let header = header["//# ".len()..].trim_end();
        let (section, reported) = header.split_once(' ').unwrap();
        let (verdict, rule) = reported.split_once(' ').unwrap();
        let name = format!("tests/rules/{chapter}.glsl:{at}: §{section} {rule}");
        programs.push(program(name, verdict, body.trim_end()));
    }
    programs
}

fn program(name: String, verdict: &str, body: &str) -> Program {
    let marked = (1..).zip(body.lines()).filter(|(_, line)| line.contains("//!"));
    let lines: Vec<usize> = marked.map(|(line, _)| line).collect();
    let (expectation, main) = match verdict {
        "holds" => {
            assert!(lines.is_empty(), "{name}: what holds has no wrong line");
            (Expectation::Holds, PAINTS_WHETHER_IT_HOLDS)
        }
        "error" => (Expectation::Refused { code: None, lines }, PAINTS_NOTHING),
        code => {
            assert!(code.starts_with('E'), "{name}: what is `{code}`?");
            let code = Some(code.to_owned());
            (Expectation::Refused { code, lines }, PAINTS_NOTHING)
        }
    };
    let main = if body.contains("mainImage") { "" } else { main };
    Program {
        name,
        text: format!("{body}\n{main}"),
        expectation,
    }
}

#[test]
fn programs_are_read_with_their_marks() {
    let text = "// About.\n//# 4.2 E0200 a name\nvoid f() {\n  a; //!\n}\n\n//# 4.3 holds b\nbool holds() { return true; }\n";
    let [first, second] = &read("x", text)[..] else {
        panic!("not two");
    };
    assert_eq!(first.name, "tests/rules/x.glsl:2: §4.2 a name");
    assert_eq!(
        first.expectation,
        Expectation::Refused {
            code: Some("E0200".into()),
            lines: vec![2]
        }
    );
    assert_eq!(second.expectation, Expectation::Holds);
    assert_eq!(
        second.text,
        format!("bool holds() {{ return true; }}\n{PAINTS_WHETHER_IT_HOLDS}")
    );
}

/// An empty collection would pass every test.
#[test]
fn the_collection_is_complete() {
    let programs = programs();
    let holds = programs
        .iter()
        .filter(|program| program.expectation == Expectation::Holds)
        .count();
    assert!(holds >= 300, "{holds} programs hold");
    assert!(
        programs.len() - holds >= 300,
        "{} are refused",
        programs.len() - holds
    );
}
