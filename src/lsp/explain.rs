//! Explanations of codes as files, which every editor can open.

use std::collections::BTreeMap;
use std::path::PathBuf;

use lsp_types::Uri;
use toyproof_diagnostic::Code;
use toyproof_image::{input, output};

use crate::location::uri_of;

/// The explanations of codes, each written once when it is first needed.
#[derive(Debug, Default)]
pub(crate) struct Explanations {
    /// The folder of the files; `None` for no explanations.
    folder: Option<PathBuf>,
    /// `None` for a file that could not be written.
    written: BTreeMap<Code, Option<Uri>>,
}

impl Explanations {
    pub(crate) fn new(folder: Option<PathBuf>) -> Self {
        Self {
            folder,
            written: BTreeMap::new(),
        }
    }

    /// The URI of the explanation of a code.
    pub(crate) fn href(&mut self, code: Code) -> Option<Uri> {
        if let Some(known) = self.written.get(&code) {
            return known.clone();
        }
        let uri = self.write(code);
        self.written.insert(code, uri.clone());
        uri
    }

    fn write(&self, code: Code) -> Option<Uri> {
        let path = self.folder.as_ref()?.join(format!("{code}.md"));
        let text = text(code);
        // Another version of the program may have written it.
        if input::read(&path).ok().as_deref() != Some(text.as_bytes()) {
            output::write(&path, text.as_bytes()).ok()?;
        }
        uri_of(&path)
    }
}

/// The explanation of a code, in Markdown.
pub(crate) fn text(code: Code) -> String {
    format!(
        "# {code}: {}\n\n{}\n",
        code.title(),
        code.explanation().trim_end()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::location::path_of;

    #[test]
    fn an_explanation_is_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let mut explanations = Explanations::new(Some(folder.path().join("new")));
        let uri = explanations.href(Code::Undeclared).unwrap();
        let path = path_of(&uri).unwrap();
        let written = String::from_utf8(input::read(&path).unwrap()).unwrap();
        assert!(written.starts_with("# E0200: "), "{written}");
        assert!(written.contains("\nWrong:\n"), "{written}");
        output::write(&path, b"of another version").unwrap();
        assert_eq!(explanations.href(Code::Undeclared), Some(uri));
        let mut again = Explanations::new(Some(folder.path().join("new")));
        again.href(Code::Undeclared).unwrap();
        assert_eq!(input::read(&path).unwrap(), written.as_bytes());
        assert_eq!(Explanations::new(None).href(Code::Undeclared), None);
    }
}
