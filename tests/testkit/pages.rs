//! The pages of the guide that are written from the texts beside the code. The introduction of a page, up to its
//! first generated section, is kept.

use std::fs;
use std::path::{Path, PathBuf};

use toyproof::diagnostic::Code;
use toyproof::explain::known::documentation::{self, Topic};

/// The generated pages: each with its file and the page as it should be.
pub fn generated() -> Vec<(PathBuf, String)> {
    vec![
        page("docs/guide/diagnostics.md", &diagnostics()),
        page("docs/guide/mistakes.md", &mistakes()),
    ]
}

fn page(path: &str, sections: &str) -> (PathBuf, String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    let text = fs::read_to_string(&path).unwrap();
    let first = sections.lines().next().unwrap();
    let start = text.find(first).unwrap_or(text.len());
    let page = format!("{}{sections}", &text[..start]);
    (path, page)
}

/// A section for each code.
fn diagnostics() -> String {
    let sections = Code::ALL.iter().map(|code| {
        let (title, text) = (code.title(), code.explanation());
        format!("## {code}: {title}\n\n{text}\n")
    });
    sections.collect::<Vec<_>>().join("\n")
}

/// A section for each topic, with a table of its mistakes.
fn mistakes() -> String {
    let sections = Topic::ALL.iter().map(|&topic| {
        let rows = documentation::all().filter(|mistake| mistake.topic == topic);
        let rows = rows.map(|mistake| format!("| `{}` | {} | {} |\n", mistake.id, mistake.form, mistake.fix));
        format!(
            "## {}\n\n{}\n\n| id | mistake | how to fix it |\n|---|---|---|\n{}",
            topic.title(),
            topic.introduction(),
            rows.collect::<String>()
        )
    });
    sections.collect::<Vec<_>>().join("\n")
}
