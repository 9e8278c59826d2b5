//! `toyproof check --explain CODE`

use toyproof_diagnostic::nearest;

use super::{Exit, Terminal};
use crate::report;
use crate::report::Explanation;

/// Prints what a code means.
pub(super) fn run(code: &str, terminal: &Terminal) -> Exit {
    let Some(Explanation { code, title, text }) = report::explain(code) else {
        let codes = report::explanations().map(|explanation| explanation.code);
        let hint = match nearest(code, codes) {
            Some(near) => format!("did you mean {near}?"),
            None => "codes are E or W and four digits, as in error[E0301]".to_owned(),
        };
        terminal.error(format_args!("there is no code {code}; {hint}"));
        return Exit::Trouble;
    };
    terminal.result(&format!("{code}: {title}\n\n{}", plain(text)));
    Exit::Good
}

/// Markdown as a terminal shows it: what is fenced is indented instead.
fn plain(text: &str) -> String {
    let mut fenced = false;
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            fenced = !fenced;
        } else if fenced {
            lines.push(format!("    {line}"));
        } else {
            lines.push(line.to_owned());
        }
    }
    lines.join("\n")
}
