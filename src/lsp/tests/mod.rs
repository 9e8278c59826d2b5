//! Tests of the engine: texts in a workspace, with and without files.

mod actions;
mod random_edits;
mod reading;
mod renaming;
mod symbols;

use std::fs;
use std::path::Path;

use lsp_types::{TextDocumentContentChangeEvent, TextDocumentContentChangeWholeDocument, Uri, WorkspaceEdit};
use tempfile::TempDir;

use crate::encoding::Encoding;
use crate::location::uri_of;
use crate::snapshot::Snapshot;
use crate::workspace::Workspace;

/// A workspace with files in a folder. A `|` in a text is where the cursor is, and is removed.
struct Fixture {
    workspace: Workspace,
    folder: TempDir,
    /// The file with the cursor, and its byte.
    cursor: Option<(Uri, u32)>,
}

impl Fixture {
    /// Writes files and opens the first `open` of them.
    fn new(open: usize, files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut workspace = Workspace::default();
        let mut cursor = None;
        for (index, (name, text)) in files.iter().enumerate() {
            let path = folder.path().join(name);
            let plain = text.replacen('|', "", 1);
            fs::write(&path, &plain).unwrap();
            let uri = uri_of(&path).unwrap();
            if let Some(at) = text.find('|') {
                cursor = Some((uri.clone(), at as u32));
            }
            if index < open {
                workspace.open(&uri, "glsl", 1, plain);
            }
        }
        Self {
            workspace,
            folder,
            cursor,
        }
    }

    /// A single shader, which is open.
    fn shader(text: &str) -> Self {
        Self::new(1, &[("a.glsl", text)])
    }

    fn uri(&self, name: &str) -> Uri {
        uri_of(&self.folder.path().join(name)).unwrap()
    }

    /// The document with the cursor, and the byte of its analyzed text.
    fn at_cursor(&mut self) -> (Snapshot, u32) {
        let (uri, byte) = self.cursor.clone().expect("a `|` in one text");
        let snapshot = self.workspace.snapshot(&uri).expect("an open shader");
        let at = snapshot
            .files()
            .in_joined(snapshot.analyzed(), snapshot.document, byte);
        (snapshot, at.expect("a text that is compiled"))
    }

    fn change(&mut self, name: &str, text: &str) {
        let whole = TextDocumentContentChangeWholeDocument::new(text.to_owned());
        let change = TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(whole);
        assert!(self.workspace.change(&self.uri(name), 2, vec![change]));
    }

    /// The codes of the diagnostics of a document's unit.
    fn codes(&mut self, name: &str) -> Vec<&'static str> {
        let snapshot = self.workspace.snapshot(&self.uri(name)).expect("an open shader");
        let diagnostics = snapshot.unit.diagnostics.iter();
        diagnostics.map(|one| one.code.as_str()).collect()
    }

    /// The texts of the files that an edit changes, by name.
    fn applied(&self, edit: &WorkspaceEdit) -> Vec<(String, String)> {
        let changes = edit.changes.clone().expect("plain changes");
        let mut edited: Vec<_> = changes
            .into_iter()
            .map(|(uri, edits)| {
                let name = uri.0.rsplit('/').next().unwrap().to_owned();
                let text = fs::read_to_string(self.folder.path().join(&name)).unwrap();
                let file = toyproof_diagnostic::File::new(&name, text);
                let mut text = file.text().to_owned();
                for edit in edits.iter().rev() {
                    let byte = |position| Encoding::Utf16.byte(&file, position) as usize;
                    text.replace_range(byte(edit.range.start)..byte(edit.range.end), &edit.new_text);
                }
                (name, text)
            })
            .collect();
        edited.sort();
        edited
    }
}

#[test]
fn a_document_is_analyzed_again_when_what_it_depends_on_changes() {
    let mut fixture = Fixture::new(
        2,
        &[
            (
                "a.glsl",
                "#include \"b.glsl\"\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(b()); }\n",
            ),
            ("b.glsl", "float b() { return 1.; }\n"),
        ],
    );
    assert_eq!(fixture.codes("a.glsl"), [""; 0]);
    fixture.change("b.glsl", "float other() { return 1.; }\n");
    assert!(fixture.codes("a.glsl").contains(&"E0200"));
    // The included file is seen in the shader that includes it.
    let snapshot = fixture.workspace.snapshot(&fixture.uri("b.glsl")).unwrap();
    assert!(snapshot.file().name().ends_with("b.glsl"));
    assert!(snapshot.analyzed_text().contains("mainImage"));
    fixture.workspace.close(&fixture.uri("b.glsl"));
    assert_eq!(fixture.codes("a.glsl"), [""; 0], "the file on disk counts again");
}

#[test]
fn tabs_are_analyzed_with_common_in_front() {
    let mut fixture = Fixture::new(
        2,
        &[
            (
                "image.glsl",
                "void mainImage(out vec4 c, in vec2 p) { c = vec4(part(p.x)); }\n",
            ),
            ("common.glsl", "float part(float x) { return x / 2.; }\n"),
            (
                "buffer-a.glsl",
                "void mainImage(out vec4 c, in vec2 p) { c = vec4(part(1)); }\n",
            ),
        ],
    );
    // The unopened tab has an error.
    assert_eq!(fixture.codes("image.glsl").len(), 1);
    let snapshot = fixture.workspace.snapshot(&fixture.uri("image.glsl")).unwrap();
    let span = snapshot.unit.diagnostics[0].span.unwrap();
    assert_eq!(snapshot.files().name(span), "buffer-a.glsl");
    fixture.change(
        "common.glsl",
        "float part(int x) { return 1.; }\nfloat part(float x) { return x; }\n",
    );
    assert_eq!(fixture.codes("image.glsl"), [""; 0]);
}

#[test]
fn other_documents_are_not_analyzed() {
    let folder = tempfile::tempdir().unwrap();
    let mut workspace = Workspace::default();
    for (name, language) in [("a.json", "json"), ("a.vert", "glsl"), ("project.toml", "toml")] {
        let uri = uri_of(&Path::new(folder.path()).join(name)).unwrap();
        workspace.open(&uri, language, 1, "}".to_owned());
        assert!(workspace.snapshot(&uri).is_none(), "{name}");
    }
    let untitled = Uri("untitled:Untitled-1".to_owned());
    workspace.open(
        &untitled,
        "glsl",
        1,
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(q); }".to_owned(),
    );
    assert_eq!(workspace.snapshot(&untitled).unwrap().unit.diagnostics.len(), 1);
}
