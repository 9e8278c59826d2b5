//! The pages of the guide that are written from the texts beside the code. The introduction of a page, up to its
//! first generated section, is kept.

use std::fs;
use std::path::{Path, PathBuf};

use toyproof::diagnostic::Code;

/// The generated pages: each with its file and the page as it should be.
pub fn generated() -> Vec<(PathBuf, String)> {
    vec![page("docs/guide/diagnostics.md", &diagnostics())]
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
