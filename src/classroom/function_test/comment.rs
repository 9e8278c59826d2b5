//! The tests in a shader's comments: `// @test f(1.0) == 2.0`.

use toyproof_diagnostic::{Code, Diagnostic, Span};

use super::assertion::Assertion;
use super::source::Snippet;
use super::subject::Subject;
use super::test::{FunctionCases, FunctionTest, MAX_TESTS};

const MARK: &str = "@test";

/// The tests in the comments of a shader, in their order, each as a test of the function that it calls first.
///
/// # Errors
/// Those in the syntax of the tests.
pub fn comment_tests(subject: &Subject) -> Result<Vec<FunctionTest>, Vec<Diagnostic>> {
    let file = subject.checked.tree[subject.checked.main_image].at.span.file;
    let mut tests = Vec::new();
    let mut errors = Vec::new();
    for (start, text) in line_comments(subject.text) {
        let Some(rest) = text.trim_start().strip_prefix(MARK) else {
            continue;
        };
        if rest.starts_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let start = start + text.len() - rest.len();
        // A comment after the test.
        let rest = rest.split("//").next().unwrap_or(rest);
        let span = Span::new(file, start as u32, (start + rest.len()) as u32);
        let whole = Snippet::new(rest, span, true).part(0, rest.len());
        if tests.len() == MAX_TESTS {
            let message = format!("a shader has at most {MAX_TESTS} tests in comments");
            let error = Diagnostic::new(Code::TestValue, message).at(whole.at());
            errors.push(error.help("move tests into a file beside the shader"));
            break;
        }
        match Assertion::parse(&whole) {
            Ok(assertion) => tests.push(test(assertion, subject)),
            Err(error) => {
                let found = Diagnostic::new(Code::TestSyntax, error.message).at(error.at);
                errors.push(if error.help.is_empty() {
                    found
                } else {
                    found.help(error.help)
                });
            }
        }
    }
    if errors.is_empty() { Ok(tests) } else { Err(errors) }
}

fn test(assertion: Assertion, subject: &Subject) -> FunctionTest {
    let is_function = |name: &&str| subject.functions(name).next().is_some();
    let name = assertion.names().into_iter().find(is_function);
    FunctionTest {
        name: name.unwrap_or_default().to_owned(),
        points: 0.0,
        precision: None,
        after: None,
        cases: FunctionCases::Written {
            listed: Vec::new(),
            assertions: vec![assertion],
        },
    }
}

/// The texts of comments that end with their line, each with the byte after its `//`.
fn line_comments(text: &str) -> Vec<(usize, &str)> {
    let mut comments = Vec::new();
    let mut at = 0;
    while let Some(next) = text[at..].find('/').map(|next| at + next) {
        let rest = &text[next..];
        if rest.starts_with("//") {
            let start = next + 2;
            let end = text[start..]
                .find(['\n', '\r'])
                .map_or(text.len(), |end| start + end);
            comments.push((start, &text[start..end]));
            at = end;
        } else if rest.starts_with("/*") {
            at = text[next + 2..]
                .find("*/")
                .map_or(text.len(), |end| next + 2 + end + 2);
        } else {
            at = next + 1;
        }
    }
    comments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_comments_are_found_outside_of_other_comments() {
        let text = "a / b; // one\n/* // two\n*/ c(); //three\r\n/* /* */ // four";
        let found: Vec<_> = line_comments(text).into_iter().map(|(_, text)| text).collect();
        assert_eq!(found, [" one", "three", " four"]);
        assert!(
            line_comments(text)
                .iter()
                .all(|(at, found)| text[*at..].starts_with(found))
        );
    }
}
