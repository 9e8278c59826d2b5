//! Programs that break a rule have an error on the line where it is broken, and nowhere else.

use toyproof::diagnostic::{File, Files, Severity, short};
use toyproof::glsl::{Dialect, Options, check};

use super::{Expectation, Program, programs};

/// Describes how the errors differ from the expected ones.
fn wrong(program: &Program, code: Option<&str>, lines: &[usize]) -> Option<String> {
    let mut files = Files::default();
    let file = files.add(File::new("s", program.text.as_str()));
    let options = Options {
        dialect: Some(Dialect::ShaderToy),
        ..Options::default()
    };
    let Err(reported) = check(&files, file, &options) else {
        return Some("is accepted".to_owned());
    };
    let errors = reported
        .iter()
        .filter(|diagnostic| diagnostic.severity == Severity::Error);
    let reported: Vec<_> = errors.collect();
    let mut found: Vec<_> = reported
        .iter()
        .filter_map(|error| error.span)
        .map(|span| files.position(span).line)
        .collect();
    found.dedup();
    let placed = found == lines && (!lines.is_empty() || reported.len() == 1);
    let coded = code.is_none_or(|code| reported.iter().all(|error| error.code.as_str() == code));
    let output: Vec<_> = reported.iter().map(|error| short(error, &files)).collect();
    (!placed || !coded).then(|| output.join("\n    "))
}

#[test]
fn each_error_is_on_its_line() {
    let mut failures = Vec::new();
    for program in programs() {
        if let Expectation::Refused { code, lines } = &program.expectation
            && let Some(why) = wrong(&program, code.as_deref(), lines)
        {
            failures.push(format!(
                "{}\n    expected {} on {lines:?}\n    {why}",
                program.name,
                code.as_deref().unwrap_or("an error")
            ));
        }
    }
    assert!(
        failures.is_empty(),
        "{} are not refused as they should be:\n{}",
        failures.len(),
        failures.join("\n")
    );
}
