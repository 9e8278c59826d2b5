//! Fixes: for each shader of `tests/ui`, applying the fix of an error removes the error.

use std::path::Path;

use toyproof_diagnostic::{Json, JsonFix, json};

use super::*;

/// The errors of a text, as JSON.
fn errors(text: &str) -> Vec<Json> {
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    match check(&files, file, &Options::default()) {
        Ok(_) => Vec::new(),
        Err(errors) => errors.iter().map(|error| json(error, &files)).collect(),
    }
}

/// The text with one range replaced, by lines and columns as an editor does.
fn applied(text: &str, fix: &JsonFix) -> String {
    let offset = |line: usize, column: usize| {
        let start: usize = text.split_inclusive('\n').take(line - 1).map(str::len).sum();
        let characters = text[start..].chars().take(column - 1);
        start + characters.map(char::len_utf8).sum::<usize>()
    };
    let start = offset(fix.line, fix.column);
    let end = offset(fix.end_line, fix.end_column);
    assert!(start <= end, "{fix:?}");
    format!("{}{}{}", &text[..start], fix.replacement, &text[end..])
}

#[test]
fn a_fix_removes_its_error() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/ui"));
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "glsl") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let before = errors(&text);
        for error in &before {
            let Some(fix) = &error.fix else { continue };
            let fixed = applied(&text, fix);
            let after = errors(&fixed);
            // Another use of the same unknown name may be reported in its place, but elsewhere.
            let again = |other: &Json| {
                (&other.code, &other.message, other.line, other.column)
                    == (&error.code, &error.message, error.line, error.column)
            };
            assert!(
                !after.iter().any(again),
                "{path:?}: {error} with {fix:?}\n{fixed}"
            );
            count += 1;
        }
    }
    assert!(count >= 40, "only {count} fixes");
}

#[test]
fn no_fix_is_offered_where_the_edit_is_not_known() {
    let cases = [
        // In parentheses, with a comment, and in a macro's argument and body.
        ("float f() { return(2); }", None),
        ("float f(int i) { return i /* steps */ + 1.0; }", Some("float(i)")),
        (
            "#define TWICE(x) (x + x)\nfloat f(int i) { return TWICE(i); }",
            None,
        ),
        (
            "#define ONE 1\nfloat f() { float x = ONE; return x; }",
            Some("1.0"),
        ),
        ("float f() { return 2 * 1.5; }", Some("2.0")),
        ("float f(vec3 v) { return v; }", None),
        (
            "float f(float x) { return saturate(x); }",
            Some("clamp(x, 0.0, 1.0"),
        ),
        ("float f(float x) { return saturat(x); }", None),
        // A division of integers is converted at its operands: its result has lost the fraction.
        ("float f(float x) { return pow(x, 1 / 3); }", Some("1.0 / 3.0")),
        ("float f(float x) { return 1 / 3 * x; }", Some("1.0 / 3.0")),
        ("float f(float x) { return x - (1/2); }", Some("1.0/2.0")),
        (
            "float f() { float x = -1 / (2 * 3); return x; }",
            Some("1.0 / (2.0 * 3.0"),
        ),
        (
            "const int N = 3;\nfloat f() { float x = 1 / N; return x; }",
            Some("1.0 / float(N)"),
        ),
        ("#define N 3\nfloat f() { float x = 1 / N; return x; }", None),
        ("float f(int i) { float x = i / 3; return x; }", None),
        ("float f() { float x = 010 / 3; return x; }", None),
        ("float f() { float x = 7 % 3 / 2; return x; }", None),
    ];
    for (text, wanted) in cases {
        let first = errors(&format!("{text}\n{MAIN}")).swap_remove(0);
        let replacement = first.fix.map(|fix| fix.replacement);
        assert_eq!(replacement.as_deref(), wanted, "{text}");
    }
}
