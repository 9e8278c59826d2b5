//! Each warning, and what comes near to it and is not told.

mod found;
mod told;
mod unwritten;

use toyproof_diagnostic::{Deadline, Diagnostic, File, Files};
use toyproof_glsl::{Options, check};

use super::lint;

/// The warnings about a text, as `W0005:3` with the line.
fn warned(text: &str) -> Vec<String> {
    let (found, files) = diagnostics(text);
    found
        .iter()
        .map(|told| {
            format!(
                "{}:{}",
                told.code,
                told.span.map_or(0, |span| files.position(span).line)
            )
        })
        .collect()
}

fn diagnostics(text: &str) -> (Vec<Diagnostic>, Files) {
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    let checked = check(&files, file, &Options::default());
    let checked = checked.unwrap_or_else(|errors| panic!("{text}\n{errors:#?}"));
    (lint(&files, &checked, &Deadline::default()).warnings, files)
}

/// A shader of these functions and these statements of `mainImage`; they begin on line 2.
fn shader(functions: &str, statements: &str) -> String {
    format!(
        "{}\nvoid mainImage(out vec4 c, in vec2 f) {{ c = vec4(0.0);\n{statements}\n}}\n",
        functions.replace('\n', " ")
    )
}

/// Cases line by line: the codes that are told, `-` for none, then functions, `|`, and the statements of `mainImage`.
fn cases(table: &str) {
    let mut wrong = Vec::new();
    for line in table.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (wanted, text) = line.split_once(' ').unwrap();
        let (functions, statements) = text.split_once('|').unwrap_or(("", text));
        let mut told: Vec<_> = diagnostics(&shader(functions, statements))
            .0
            .iter()
            .map(|told| told.code.to_string())
            .collect();
        told.dedup();
        let told = if told.is_empty() {
            "-".to_owned()
        } else {
            told.join(",")
        };
        if told != wanted {
            wrong.push(format!("{told} {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The message of the only warning.
fn message(functions: &str, statements: &str) -> String {
    let (found, _) = diagnostics(&shader(functions, statements));
    assert_eq!(found.len(), 1, "{found:#?}");
    found[0].message.clone()
}
