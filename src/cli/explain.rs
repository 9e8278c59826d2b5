//! `toyproof explain`

use toyproof_diagnostic::{nearest, wrap};
use toyproof_report::{self as report, Explanation};

use super::{CliError, Exit, Terminal};

/// Explain a diagnostic code or a mistake, and how to fix it
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof explain E0301
  toyproof explain far-root
  toyproof explain --list

To trace one pixel of a shader, use `toyproof debug`.")]
pub(super) struct Args {
    /// Codes such as E0301 and W0602, or mistakes such as far-root
    #[arg(required_unless_present = "list", value_name = "CODE")]
    codes: Vec<String>,
    /// List all codes and mistakes
    #[arg(long, exclusive = true)]
    list: bool,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    if args.list {
        for explanation in report::explanations() {
            terminal.result(&format!("{}  {}", explanation.code, explanation.title));
        }
        return Exit::Success;
    }
    let mut exit = Exit::Success;
    for (index, code) in args.codes.iter().enumerate() {
        if index > 0 {
            terminal.result("");
        }
        if let Some(explanation) = report::explain(code) {
            print(&explanation, terminal);
        } else if !print_found(code, terminal) {
            exit = terminal.fail(&unknown(code));
        }
    }
    exit
}

/// Lists the explanations in which a word occurs; returns whether there are any.
fn print_found(word: &str, terminal: &Terminal) -> bool {
    let found = search(word);
    for Explanation { code, title, .. } in &found {
        terminal.result(&format!("{code}  {title}"));
    }
    if let Some(first) = found.first() {
        terminal.note(&format!(
            "`{word}` is not a code: it occurs in these; to read one: toyproof explain {}",
            first.code
        ));
    }
    !found.is_empty()
}

fn print(explanation: &Explanation, terminal: &Terminal) {
    let Explanation { code, title, text } = explanation;
    terminal.paragraph(&format!("{code}: {title}"));
    if !text.is_empty() {
        terminal.result(&format!("\n{}", plain(text, terminal.width())));
    }
}

fn unknown(code: &str) -> CliError {
    let codes: Vec<_> = report::explanations()
        .map(|explanation| explanation.code)
        .collect();
    let error = CliError::new(format_args!("unknown code `{code}`"));
    match nearest(code, codes.iter().map(AsRef::as_ref)) {
        Some(near) => error.with_help(format_args!("did you mean `{near}`?")),
        None if code.contains(['.', '/']) => error.with_help(
            "`explain` takes codes; to trace one pixel of a shader: toyproof debug SHADER --pixel X,Y",
        ),
        None => error.with_help("`toyproof explain --list` lists all codes and mistakes"),
    }
}

/// The maximum number of explanations that a search finds: a word that is in more is too common to help.
const MAX_FOUND: usize = 10;

/// The explanations in whose code, title or text a word occurs: those of codes and titles first.
fn search(word: &str) -> Vec<Explanation> {
    let word = word.to_lowercase();
    if word.trim().len() < 3 || word.contains(['/', '\\']) {
        return Vec::new();
    }
    let mut found: Vec<_> = report::explanations()
        .filter_map(|explanation| {
            let contains = |text: &str| text.to_lowercase().contains(&word);
            let is_named = contains(explanation.code) || contains(explanation.title);
            (is_named || contains(&explanation.text)).then_some((!is_named, explanation))
        })
        .collect();
    found.sort_by_key(|(is_only_in_text, _)| *is_only_in_text);
    found
        .into_iter()
        .take(MAX_FOUND)
        .map(|(_, explanation)| explanation)
        .collect()
}

/// Converts Markdown for a terminal: paragraphs are wrapped, and fenced code is indented.
fn plain(text: &str, width: Option<usize>) -> String {
    let mut lines = Vec::new();
    let mut paragraph: Vec<&str> = Vec::new();
    let mut is_fenced = false;
    let end = |paragraph: &mut Vec<&str>, lines: &mut Vec<String>| {
        if !paragraph.is_empty() {
            lines.push(wrap("", 0, &paragraph.join(" "), width));
            paragraph.clear();
        }
    };
    for line in text.lines() {
        let is_fence = line.starts_with("```");
        if is_fenced && !is_fence {
            lines.push(format!("    {line}").trim_end().to_owned());
            continue;
        }
        if is_fence || line.is_empty() {
            end(&mut paragraph, &mut lines);
        }
        match line {
            _ if is_fence => is_fenced = !is_fenced,
            "" => lines.push(String::new()),
            line => paragraph.push(line),
        }
    }
    end(&mut paragraph, &mut lines);
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_parts_of_codes_are_found() {
        let codes = |word: &str| {
            search(word)
                .into_iter()
                .map(|found| found.code.to_owned())
                .collect::<Vec<_>>()
        };
        assert_eq!(codes("602")[0], "W0602");
        assert!(!codes("acne").is_empty());
        assert!(codes("PRECISION").contains(&"W0602".to_owned()) || codes("precision").len() == MAX_FOUND);
        assert!(codes("zzz").is_empty() && codes("a/b.glsl").is_empty() && codes("a").is_empty());
    }

    #[test]
    fn paragraphs_wrap_and_code_is_indented() {
        let text = "one two\nthree four\n\nWrong:\n```glsl\nint  a = 1.0;\n\nx\n```\nend";
        assert_eq!(
            plain(text, Some(20)),
            "one two three four\n\nWrong:\n    int  a = 1.0;\n\n    x\nend"
        );
    }
}
