//! The rules of an assignment: what a shader must define, must not call and must not read, and its length.

use std::collections::BTreeMap;

use toyproof_diagnostic::{Files, Span, grouped};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprKind, Function};
use toyproof_report::{RulesRecord, Violation};

/// Rules for the text of a shader.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    /// The points for a shader that keeps all rules, ≥ 0.
    pub points: f64,
    /// The functions that a shader must define.
    pub must_define: Vec<String>,
    /// The functions, built-in or the shader's own, that a shader must not call.
    pub must_not_call: Vec<String>,
    /// Whether a shader may read textures.
    pub textures: bool,
    /// The largest number of lines, without blank lines and comments.
    pub max_lines: Option<u32>,
}

impl Rules {
    /// The record of a shader that does not compile.
    #[must_use]
    pub fn unchecked(&self) -> RulesRecord {
        RulesRecord {
            points: self.points,
            violations: None,
        }
    }

    /// Checks a shader with this text.
    #[must_use]
    pub fn check(&self, files: &Files, checked: &Checked, text: &str) -> RulesRecord {
        let violation = |rule: &str, message: String, at: Option<Span>| Violation {
            rule: rule.to_owned(),
            message,
            at: at.map(|at| files.position(at).into()),
        };
        let mut violations = Vec::new();
        let functions = &checked.tree.functions;
        for name in &self.must_define {
            let is_defined = |function: &Function| function.body.is_some() && function.name == *name;
            if !functions.iter().any(|(_, function)| is_defined(function)) {
                let message = format!("the function `{name}` must be defined");
                violations.push(violation("must_define", message, None));
            }
        }
        let calls = Calls::new(checked);
        for name in &self.must_not_call {
            if let Some(spans) = calls.by_name.get(name.as_str()) {
                let message = format!("`{name}` must not be called{}", times(spans.len()));
                violations.push(violation("must_not_call", message, spans.first().copied()));
            }
        }
        if let (false, Some(first)) = (self.textures, calls.textures.first()) {
            let message = format!("textures must not be read{}", times(calls.textures.len()));
            violations.push(violation("textures", message, Some(*first)));
        }
        let lines = code_lines(text);
        if let Some(max) = self.max_lines
            && lines > u64::from(max)
        {
            let message = format!(
                "the shader has {} lines without blank lines and comments; it may have {}",
                grouped(lines),
                grouped(u64::from(max))
            );
            violations.push(violation("max_lines", message, None));
        }
        RulesRecord {
            points: self.points,
            violations: Some(violations),
        }
    }
}

/// States how often something is called, if more than once.
fn times(calls: usize) -> String {
    match calls {
        0 | 1 => String::new(),
        several => format!(" ({} calls)", grouped(several as u64)),
    }
}

/// The places of all calls, in source order.
#[derive(Default)]
struct Calls<'a> {
    by_name: BTreeMap<&'a str, Vec<Span>>,
    textures: Vec<Span>,
}

impl<'a> Calls<'a> {
    fn new(checked: &'a Checked) -> Self {
        let tree = &checked.tree;
        let mut calls = Self::default();
        for (_, expr) in tree.exprs.iter() {
            let name = match &expr.kind {
                ExprKind::Call { function, .. } => tree[*function].name.as_str(),
                ExprKind::BuiltIn { function, .. } => {
                    if function.is_texture() {
                        calls.textures.push(expr.at.span);
                    }
                    function.name()
                }
                _ => continue,
            };
            calls.by_name.entry(name).or_default().push(expr.at.span);
        }
        for spans in calls.by_name.values_mut().chain([&mut calls.textures]) {
            spans.sort_by_key(|span| span.start);
        }
        calls
    }
}

/// The number of lines with code, without blank lines and lines that only have comments.
fn code_lines(text: &str) -> u64 {
    let mut lines = 0;
    let mut has_code = false;
    let mut rest = text;
    while let Some(character) = rest.chars().next() {
        let length = if let Some(comment) = rest.strip_prefix("//") {
            // The line break is not part of the comment.
            2 + line_comment_length(comment)
        } else if let Some(comment) = rest.strip_prefix("/*") {
            let end = comment.find("*/").map_or(rest.len(), |end| end + 4);
            if rest[..end].contains('\n') {
                lines += u64::from(has_code);
                has_code = false;
            }
            end
        } else {
            if character == '\n' {
                lines += u64::from(has_code);
                has_code = false;
            } else {
                has_code |= !character.is_whitespace();
            }
            character.len_utf8()
        };
        rest = &rest[length..];
    }
    lines + u64::from(has_code)
}

/// The length of a comment up to the end of its line, which a backslash continues.
fn line_comment_length(comment: &str) -> usize {
    let mut length = 0;
    for line in comment.split_inclusive('\n') {
        let content = line.trim_end_matches(['\n', '\r']);
        if !content.ends_with('\\') || content.len() == line.len() {
            return length + content.len();
        }
        length += line.len();
    }
    length
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::File;
    use toyproof_glsl::{Options, check};

    use super::*;

    const KEPT: Rules = Rules {
        points: 1.0,
        must_define: Vec::new(),
        must_not_call: Vec::new(),
        textures: true,
        max_lines: None,
    };

    /// `line: message` of each violation.
    fn violations(rules: &Rules, text: &str) -> Vec<String> {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let checked = check(&files, file, &Options::default()).unwrap();
        let record = rules.check(&files, &checked, text);
        let violations = record.violations.unwrap().into_iter();
        violations
            .map(|violation| format!("{}: {}", violation.at.map_or(0, |at| at.line), violation.message))
            .collect()
    }

    const SHADER: &str = "float hit(vec3 p);\n#define SQUARE(x) pow(x, 2.0)\n\
        float area(float r) {\n    return 3.0 * SQUARE(r) + pow(r, 3.0);\n}\n\
        void mainImage(out vec4 c, in vec2 p) {\n    c = texture(iChannel0, p) + area(p.x);\n}\n";

    #[test]
    fn each_rule_has_its_line() {
        assert_eq!(violations(&KEPT, SHADER), [""; 0]);
        let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        let rules = Rules {
            must_define: names(&["area", "hit", "shade"]),
            must_not_call: names(&["pow", "area", "sin"]),
            textures: false,
            max_lines: Some(7),
            ..KEPT
        };
        let expected = [
            "0: the function `hit` must be defined",
            "0: the function `shade` must be defined",
            "4: `pow` must not be called (2 calls)",
            "7: `area` must not be called",
            "7: textures must not be read",
            "0: the shader has 8 lines without blank lines and comments; it may have 7",
        ];
        assert_eq!(violations(&rules, SHADER), expected);
    }

    #[test]
    fn comments_and_blank_lines_are_not_counted() {
        for (text, lines) in [
            ("", 0),
            ("a", 1),
            ("a\n\n  \nb // c\n// d\n", 2),
            ("/* a\nb */\nc /* d */\n/* e */ f /*\n*/ g", 3),
            ("// a \\\nb\nc", 1),
            ("// a \\\r\nb\r\nc\r\n", 1),
            ("/* never closed\na", 0),
            ("a / b\n/", 2),
            ("// ü\nä", 1),
        ] {
            assert_eq!(code_lines(text), lines, "{text:?}");
        }
    }
}
