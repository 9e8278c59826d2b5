//! The examples of the explanations of codes yield the stated diagnostics, and the guide has these explanations.

use std::fs;
use std::path::Path;
use std::time::Duration;

use toyproof::classroom::assignment::Assignment;
use toyproof::classroom::function_test::TestFile;
use toyproof::diagnostic::{Code, Deadline, Diagnostic, File, FileId, Files, human};
use toyproof::explain;
use toyproof::glsl::{self, Checked};
use toyproof::image::{Frame, noise};
use toyproof::lint::lint;
use toyproof::player::Clock;
use toyproof::project::{self, Buffer, PassKind, Project, Tab};
use toyproof::report::{Explanation, Rubric, explanations};
use toyproof::scene;
use toyproof::verify::Case;
use toyproof::verify::project::frames::Frames;
use toyproof::verify::project::growth::follow;
use toyproof::verify::project::playback::PassShader;

use crate::program::toyproof;

/// Codes that no example can produce: those that depend on time, on faults of drivers, on invalid UTF-8 or on the
/// target of a conversion, and internal errors of toyproof.
const CODES_WITHOUT_EXAMPLE: [&str; 13] = [
    "E0410", "E0411", "E0500", "E0900", "E0901", "E0902", "W0017", "W0032", "W0606", "W0610", "W0611",
    "W0612", "W0613",
];

/// The `mainImage` that examples omit.
const MAIN_IMAGE: &str =
    "\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0.0, 1.0); }\n";

/// The explanations of codes, without those of mistakes.
fn diagnostics() -> impl Iterator<Item = Explanation> {
    let is_code = |code: &str| code.starts_with(['E', 'W']) && code.len() == 5;
    explanations().filter(move |explanation| is_code(explanation.code))
}

/// An example of the page.
struct Example<'a> {
    wrong: bool,
    language: &'a str,
    text: &'a str,
}

fn examples(explanation: &Explanation) -> Vec<Example<'_>> {
    let mut examples = Vec::new();
    for (mark, wrong) in [("Wrong:\n\n```", true), ("Right:\n\n```", false)] {
        examples.extend(explanation.text.split(mark).skip(1).map(|rest| {
            let (language, rest) = rest.split_once('\n').unwrap();
            let (text, _) = rest.split_once("```").unwrap();
            Example {
                wrong,
                language,
                text,
            }
        }));
    }
    examples
}

/// All diagnostics of an example.
fn diagnostics_of(example: &Example) -> (Vec<Diagnostic>, Files) {
    let mut files = Files::default();
    match example.language {
        "glsl" => {
            let rest = if ["mainImage", "void main("]
                .iter()
                .any(|name| example.text.contains(name))
            {
                ""
            } else {
                MAIN_IMAGE
            };
            let file = files.add(File::new("example.glsl", format!("{}{rest}", example.text)));
            let checked = glsl::check(&files, file, &glsl::Options::default());
            let mut found = checked.map_or_else(Vec::from, |checked| warnings_of(&files, &checked));
            // The `mainImage` that an example omits would call its functions.
            found.retain(|found| rest.is_empty() || found.code != Code::Uncalled);
            (found, files)
        }
        "toml" => {
            let file = files.add(File::new("example.toml", example.text));
            (scene::parse(&files, file).err().unwrap_or_default().into(), files)
        }
        "glsl common" => {
            let file = files.add(File::new("common.glsl", example.text));
            let options = glsl::Options {
                stage: glsl::Stage::Common,
                ..glsl::Options::default()
            };
            let checked = glsl::check_declarations(&files, file, &options);
            (checked.unwrap_or_else(Vec::from), files)
        }
        "toml project" => {
            let toml = files.add(File::new("project.toml", example.text));
            // Every tab reads the two channels that the examples have.
            let code = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + texelFetch(iChannel1, ivec2(p), 0); }";
            let named = |tab: &Tab| example.text.contains(&format!("tab = \"{}\"", tab.name()));
            let tabs: Vec<_> = Tab::ALL
                .into_iter()
                .filter(named)
                .map(|tab| (tab, files.add(File::new(tab.file_name(), code))))
                .collect();
            let checked = Project::from_folder(&files, Some(toml), &tabs)
                .and_then(|project| project::check(&project, &mut files, &glsl::Options::default()));
            (checked.map_or_else(Vec::from, |checked| checked.warnings), files)
        }
        "glsl buffer" => {
            let buffer = files.add(File::new("buffer-a.glsl", example.text));
            let code = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }";
            let image = files.add(File::new("image.glsl", code));
            let warnings = warnings_over_frames(&mut files, buffer, image);
            (warnings, files)
        }
        "toml rubric" => {
            let file = files.add(File::new("example.toml", example.text));
            (
                Rubric::parse(&files, file).err().unwrap_or_default().into(),
                files,
            )
        }
        "toml script" => {
            let file = files.add(File::new("script.toml", example.text));
            let script = project::parse_script(&files, file);
            (script.err().unwrap_or_default().into(), files)
        }
        "toml test" => {
            let file = files.add(File::new("disk.test.toml", example.text));
            let tests = TestFile::parse(&files, file, Path::new("glsl"));
            (tests.err().unwrap_or_default().into(), files)
        }
        "toml assignment" => {
            let file = files.add(File::new("assignment.toml", example.text));
            let assignment = Assignment::parse(&files, file, Path::new("glsl"));
            (assignment.err().unwrap_or_default().into(), files)
        }
        other => panic!("unknown language {other}"),
    }
}

/// The warnings on a shader, and those on its run.
fn warnings_of(files: &Files, checked: &Checked) -> Vec<Diagnostic> {
    let frame = Frame {
        size: [16, 9],
        // The fourth channel has no image.
        channels: [true, true, true, false].map(|bound| bound.then(|| noise().into())),
        ..Frame::default()
    };
    let lints = lint(files, checked, &Deadline::default());
    let case = Case::new(checked, &lints, &frame).with_timeout(Duration::from_secs(60));
    let mut all = lints.warnings.clone();
    // A shader that never ends has no run to report on.
    all.extend(
        explain::check(None, &case, &explain::Options::default())
            .map(|findings| findings.notes)
            .unwrap_or_default(),
    );
    all
}

/// The number of the last frame in which the examples with buffers are rendered.
const LAST_FRAME: i32 = 60;

/// The warnings on Buffer A, which reads itself, over its frames; the image shows it.
fn warnings_over_frames(files: &mut Files, buffer: FileId, image: FileId) -> Vec<Diagnostic> {
    let kinds = [PassKind::Buffer(Buffer::A), PassKind::Image];
    let tabs: Vec<_> = kinds.map(Tab::Pass).into_iter().zip([buffer, image]).collect();
    let project = Project::from_folder(files, None, &tabs).unwrap();
    let passes = project::check(&project, files, &glsl::Options::default()).unwrap();
    let rendering = project.rendering(&[PassKind::Image]).unwrap();
    let timeout = Duration::from_secs(60);
    let shader = PassShader {
        checked: passes.passes.iter().map(|pass| &pass.checked).collect(),
        graph: &rendering.graph,
        media: &rendering.media,
        films: rendering.films.clone(),
    };
    let programs = shader.programs(timeout).unwrap();
    let inputs = Frame {
        size: [16, 9],
        ..Frame::default()
    };
    let frames = Frames {
        shader: &shader,
        programs: &programs,
        clock: &Clock {
            inputs,
            rate: 60.0,
            start: 0.0,
        },
        last: LAST_FRAME,
        timeout,
        pool: None,
    };
    let history = follow(&frames, |_, _| Ok(())).unwrap();
    passes.warnings.into_iter().chain(history.notes).collect()
}

#[test]
fn generated_pages_are_up_to_date() {
    for (path, page) in toyproof_testkit::pages::generated() {
        let written = fs::read_to_string(&path).unwrap();
        assert!(written == page, "{}: run `cargo xtask docs`", path.display());
    }
}

#[test]
fn wrong_examples_give_only_their_code_and_right_ones_none() {
    let mut mistakes = Vec::new();
    for explanation in diagnostics() {
        let examples = examples(&explanation);
        let fences = explanation.text.matches("```").count() / 2;
        assert_eq!(
            examples.len(),
            fences,
            "{}: an example is not marked",
            explanation.code
        );
        let has = |wrong| examples.iter().any(|example| example.wrong == wrong);
        assert_eq!(
            has(true) && has(false),
            !CODES_WITHOUT_EXAMPLE.contains(&explanation.code),
            "{}",
            explanation.code
        );
        for example in &examples {
            let (reported, files) = diagnostics_of(example);
            let codes: Vec<_> = reported
                .iter()
                .map(|diagnostic| diagnostic.code.as_str())
                .collect();
            let wanted = if example.wrong {
                vec![explanation.code]
            } else {
                Vec::new()
            };
            if codes != wanted {
                let lines: Vec<_> = reported
                    .iter()
                    .map(|reported| human(reported, &files, None, false))
                    .collect();
                mistakes.push(format!(
                    "{} {}\n{}",
                    explanation.code,
                    example.text,
                    lines.join("\n")
                ));
            }
        }
    }
    assert!(mistakes.is_empty(), "{}", mistakes.join("\n\n"));
}

/// The codes reported of a variable `a` of `mainImage` and its uses.
fn codes_of(functions: &str, uses: &str) -> Vec<String> {
    let text = format!(
        "{functions} void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0.0, 0.0, 0.0, 1.0);\n{uses}\n}}"
    );
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
    let line = |reported: &Diagnostic| reported.span.map_or(0, |span| files.position(span).line);
    let reported = warnings_of(&files, &checked);
    let codes = reported
        .iter()
        .map(|reported| format!("{}:{}", reported.code, line(reported)));
    codes.collect()
}

#[test]
fn a_read_of_an_uninitialized_variable_is_reported_once() {
    let trace = "bool trace(vec2 p, out float t) { if (p.x < 3.0) return false; t = p.x; return true; }";
    let none: [&str; 0] = [];
    // Written and read under one condition.
    assert_eq!(codes_of(trace, "float t;\nif (trace(p, t))\nc.x = t;"), none);
    assert_eq!(
        codes_of("", "float a; if (p.x < 3.0) a = 1.0;\nif (p.x < 2.0) c.x = a;"),
        none
    );
    // Read without it.
    assert_eq!(codes_of(trace, "float t;\ntrace(p, t);\nc.x = t;"), ["W0004:4"]);
    assert_eq!(
        codes_of("", "float a;\nif (p.x < 3.0) a = 1.0;\nc.x = a;"),
        ["W0004:4"]
    );
    assert_eq!(
        codes_of(
            "",
            "float a;\nif (p.x < 3.0) a = 1.0;\n// toyproof: allow(W0004)\nc.x = a;"
        ),
        none
    );
    // Written on no path, and in elements that are not distinguished.
    assert_eq!(codes_of("", "float a;\nc.x = a;"), ["W0003:3"]);
    assert_eq!(codes_of("", "float a[2];\na[0] = 1.0; c.x = a[1];"), ["W0604:2"]);
}

#[test]
fn a_code_is_explained_on_the_command_line() {
    let run = toyproof(Path::new("."), &["explain", "e0402"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout.starts_with("E0402: A `const` without a value\n\n"),
        "{}",
        run.stdout
    );
    assert!(
        run.stdout.contains("\nWrong:\n\n    const float PI;\n"),
        "{}",
        run.stdout
    );
    for (code, words) in [
        ("E0420", "error: unknown code `E0420`\nhelp: did you mean `E0"),
        ("nonsense", "`toyproof explain --list` lists all"),
    ] {
        let run = toyproof(Path::new("."), &["explain", code]);
        assert_eq!(run.code, 2);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
}
