//! The inputs and functions that the reference of a wrong shader uses, and the shader does not.

use toyproof_diagnostic::{Files, all_of};
use toyproof_explain::unused::Unused;

/// Sentences on the inputs and functions that only the reference uses, for the details of a wrong shader.
/// `files` are the reference's.
pub(super) fn sentences(unused: &Unused, files: &Files) -> Vec<String> {
    let names: Vec<_> = unused.inputs.iter().map(|name| format!("`{name}`")).collect();
    let inputs =
        (!names.is_empty()).then(|| format!("the reference reads {}, the shader does not", all_of(&names)));
    let functions = unused.functions.iter().map(|(name, call)| {
        let line = files.position(*call).line;
        format!("`{name}` is never called; the reference calls it at line {line}")
    });
    inputs.into_iter().chain(functions).collect()
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Span};
    use toyproof_verify::Verdict;

    use super::*;
    use crate::record::samples::{correct, record};
    use crate::{Hints, Record};

    #[test]
    fn only_a_wrong_shader_gets_the_sentences() {
        let mut files = Files::default();
        let file = files.add(File::new("solution.glsl", "a\nb\nshadow()\n"));
        let unused = Unused {
            inputs: vec!["iMouse".to_owned(), "iTime".to_owned()],
            functions: vec![("shadow".to_owned(), Span::new(file, 4, 12))],
        };
        let details = |mut record: Record, hints| {
            record.details.clear();
            record.set_unused(&unused, &files);
            record.redacted(hints).details
        };
        let expected = [
            "the reference reads `iMouse` and `iTime`, the shader does not",
            "`shadow` is never called; the reference calls it at line 3",
        ];
        assert_eq!(details(record(Verdict::Wrong), Hints::Line), expected);
        assert!(details(record(Verdict::Wrong), Hints::None).is_empty());
        assert!(details(correct(), Hints::Fix).is_empty());
    }
}
