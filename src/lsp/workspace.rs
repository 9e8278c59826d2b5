//! The open documents and folders of an editor, and what was found in them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use lsp_types::{
    ClientCapabilities, DocumentChange, Edit, OptionalVersionedTextDocumentIdentifier, Range,
    TextDocumentContentChangeEvent, TextDocumentEdit, TextDocumentIdentifier, TextEdit, Uri, WorkspaceEdit,
};
use toyproof_diagnostic::{File, FileId};
use toyproof_glsl::Options;
use toyproof_project::Tab;
use toyproof_project::files::{is_project, is_shader};

use crate::edits::{self, FileEdits};
use crate::encoding::Encoding;
use crate::location::{path_of, uri_of};
use crate::settings::Settings;
use crate::snapshot::Snapshot;
use crate::symbol::FilePlace;
use crate::unit::{Surroundings, Unit};

/// A document that is open in the editor.
#[derive(Debug, Clone)]
pub(crate) struct Document {
    pub(crate) version: i32,
    /// The path, if it is a file.
    pub(crate) path: Option<PathBuf>,
    pub(crate) text: File,
    /// Whether it is a shader, which is analyzed. Other documents, such as `project.toml`, are only read.
    is_shader: bool,
}

/// What is analyzed together.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum UnitKey {
    /// The project in a folder.
    Project(PathBuf),
    /// A shader with what it includes.
    Shader(String),
}

/// The open documents, and what was found in them. Nothing is analyzed before it is needed, and nothing
/// twice until a text changes that it depends on.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) encoding: Encoding,
    /// What the client can do.
    client: Rc<ClientCapabilities>,
    pub(crate) settings: Rc<Settings>,
    /// The folders that are open, as several may be.
    pub(crate) folders: BTreeSet<PathBuf>,
    documents: BTreeMap<String, Document>,
    units: BTreeMap<UnitKey, Rc<Unit>>,
}

impl Workspace {
    pub(crate) fn new(encoding: Encoding, client: ClientCapabilities) -> Self {
        Self {
            encoding,
            client: Rc::new(client),
            ..Self::default()
        }
    }

    /// What the client can do.
    pub(crate) fn client(&self) -> &ClientCapabilities {
        &self.client
    }

    pub(crate) fn open(&mut self, uri: &Uri, language: &str, version: i32, text: String) {
        let path = path_of(uri);
        let name = match &path {
            Some(path) => path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            None => uri.0.rsplit([':', '/']).next().unwrap_or_default().to_owned(),
        };
        // The site's JSON is an export, which nobody edits; vertex shaders are another language.
        let is_shader = match &path {
            Some(path) if is_shader(path) => true,
            Some(path) => language == "glsl" && path.extension().is_none(),
            None => language == "glsl",
        };
        let document = Document {
            version,
            text: File::new(name, text),
            is_shader,
            path,
        };
        self.forget(uri, document.path.as_deref());
        self.documents.insert(uri.0.clone(), document);
    }

    /// Applies changes of a text. Returns whether the document is open.
    pub(crate) fn change(
        &mut self,
        uri: &Uri,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
    ) -> bool {
        let Some(document) = self.documents.get_mut(&uri.0) else {
            return false;
        };
        document.version = version;
        document.text = self.encoding.changed(&document.text, changes);
        let path = document.path.clone();
        self.forget(uri, path.as_deref());
        true
    }

    pub(crate) fn close(&mut self, uri: &Uri) {
        if let Some(document) = self.documents.remove(&uri.0) {
            self.forget(uri, document.path.as_deref());
        }
    }

    pub(crate) fn document(&self, uri: &Uri) -> Option<&Document> {
        self.documents.get(&uri.0)
    }

    /// The version of an open document.
    pub(crate) fn version(&self, uri: &Uri) -> Option<i32> {
        self.document(uri).map(|document| document.version)
    }

    /// The URIs of the open shaders.
    pub(crate) fn shaders(&self) -> Vec<Uri> {
        let shaders = self.documents.iter().filter(|(_, document)| document.is_shader);
        shaders.map(|(uri, _)| Uri(uri.clone())).collect()
    }

    /// Forgets what was found in all documents: files on disk or settings changed.
    pub(crate) fn forget_all(&mut self) {
        self.units.clear();
    }

    /// Forgets what depends on the text of a document.
    fn forget(&mut self, uri: &Uri, path: Option<&Path>) {
        let canonical = path.and_then(|path| path.canonicalize().ok());
        let is_read = |file: &Path| Some(file) == path || Some(file) == canonical.as_deref();
        self.units.retain(|key, unit| {
            let is_own = *key == UnitKey::Shader(uri.0.clone());
            !is_own && !unit.paths.values().any(|file| is_read(file))
        });
        // A new tab changes its project, which did not read it.
        if let Some(folder) = path.and_then(Path::parent) {
            self.units.remove(&UnitKey::Project(folder.to_owned()));
        }
    }

    fn surroundings(&self) -> Surroundings {
        let mut open = BTreeMap::new();
        for document in self.documents.values() {
            let Some(path) = &document.path else { continue };
            open.insert(path.clone(), document.text.text().to_owned());
            if let Ok(canonical) = path.canonicalize() {
                open.insert(canonical, document.text.text().to_owned());
            }
        }
        Surroundings {
            open: Arc::new(open),
            options: Options {
                lenient: self.settings.lenient,
                dialect: self.settings.dialect,
                ..Options::default()
            },
            include_folders: self.include_folders(),
        }
    }

    /// Further folders in which included files may lie; relative ones are in each folder of the editor.
    fn include_folders(&self) -> Vec<PathBuf> {
        let given = self.settings.include_folders.iter();
        let absolute = given.flat_map(|folder| {
            let bases = self.folders.iter().map(move |base| base.join(folder));
            bases.chain(folder.is_absolute().then(|| folder.clone()))
        });
        absolute.collect()
    }

    /// What a document is analyzed with, analyzed if need be; `None` for a document that is not an open
    /// shader.
    fn unit(&mut self, uri: &Uri) -> Option<(UnitKey, Rc<Unit>)> {
        let document = self.documents.get(&uri.0).filter(|document| document.is_shader)?;
        let path = document.path.clone();
        let project = path.as_deref().and_then(project_of);
        if let Some(folder) = project {
            let key = UnitKey::Project(folder.clone());
            let analyze = |surroundings: &Surroundings| Unit::of_project(&folder, surroundings);
            if let Some(unit) = self.cached(&key, analyze) {
                return Some((key, unit));
            }
        }
        let text = self.documents[&uri.0].text.clone();
        let key = UnitKey::Shader(uri.0.clone());
        let analyze = |surroundings: &Surroundings| {
            let mut unit = Unit::of_shader(&text, path.as_deref(), surroundings);
            unit.uris.insert(unit.own, uri.clone());
            Some(unit)
        };
        let unit = self.cached(&key, analyze)?;
        Some((key, unit))
    }

    fn cached(
        &mut self,
        key: &UnitKey,
        analyze: impl FnOnce(&Surroundings) -> Option<Unit>,
    ) -> Option<Rc<Unit>> {
        if let Some(unit) = self.units.get(key) {
            return Some(unit.clone());
        }
        let mut unit = analyze(&self.surroundings())?;
        for (&file, path) in &unit.paths {
            if let Some(uri) = self.uri_at(path) {
                unit.uris.insert(file, uri);
            }
        }
        let unit = Rc::new(unit);
        self.units.insert(key.clone(), unit.clone());
        Some(unit)
    }

    /// The URI of a file: that of the editor, if the file is open.
    fn uri_at(&self, path: &Path) -> Option<Uri> {
        let is_here = |document: &Document| {
            let own = document.path.as_deref();
            own == Some(path) || own.and_then(|own| own.canonicalize().ok()).as_deref() == Some(path)
        };
        let open = self.documents.iter().find(|(_, document)| is_here(document));
        open.map(|(uri, _)| Uri(uri.clone())).or_else(|| uri_of(path))
    }

    /// The range of a place in a file of the open shaders.
    pub(crate) fn range_of(&self, place: &FilePlace) -> Option<Range> {
        let file = self.text_of(&place.uri)?;
        Some(self.encoding.range(&file, place.start, place.end))
    }

    /// The text of a file of the open shaders.
    fn text_of(&self, uri: &str) -> Option<File> {
        if let Some(document) = self.documents.get(uri) {
            return Some(document.text.clone());
        }
        self.units.values().find_map(|unit| {
            let (&file, _) = unit.uris.iter().find(|(_, of_file)| of_file.0 == uri)?;
            Some(unit.files.get(file).clone())
        })
    }

    /// The same documents after edits; the files that are not open are read with theirs.
    pub(crate) fn edited(&self, edits: &FileEdits) -> Self {
        let mut edited = Self {
            encoding: self.encoding,
            client: self.client.clone(),
            settings: self.settings.clone(),
            folders: self.folders.clone(),
            documents: self.documents.clone(),
            units: BTreeMap::new(),
        };
        for (uri, edits) in edits.files() {
            let Some(file) = self.text_of(uri) else { continue };
            let text = File::new(file.name(), edits::apply(file.text(), edits));
            let document = edited.documents.entry(uri.clone()).or_insert_with(|| Document {
                version: 0,
                path: path_of(&Uri(uri.clone())),
                text: file,
                is_shader: false,
            });
            document.text = text;
        }
        edited
    }

    /// Edits as the protocol has them.
    pub(crate) fn workspace_edit(&self, edits: &FileEdits) -> WorkspaceEdit {
        let in_protocol = edits.files().iter().filter_map(|(uri, edits)| {
            let file = self.text_of(uri)?;
            let edit = |(bytes, text): &(std::ops::Range<u32>, String)| {
                TextEdit::new(self.encoding.range(&file, bytes.start, bytes.end), text.clone())
            };
            Some((Uri(uri.clone()), edits.iter().map(edit).collect::<Vec<_>>()))
        });
        let client = self.client.workspace.as_ref();
        let client = client.and_then(|workspace| workspace.workspace_edit.as_ref());
        if client.and_then(|edits| edits.document_changes) != Some(true) {
            return WorkspaceEdit {
                changes: Some(in_protocol.collect()),
                ..WorkspaceEdit::default()
            };
        }
        let changes = in_protocol.map(|(uri, edits)| {
            let version = self.version(&uri);
            let document =
                OptionalVersionedTextDocumentIdentifier::new(version, TextDocumentIdentifier { uri });
            let edits = edits.into_iter().map(Edit::TextEdit).collect();
            DocumentChange::TextDocumentEdit(TextDocumentEdit::new(document, edits))
        });
        WorkspaceEdit {
            document_changes: Some(changes.collect()),
            ..WorkspaceEdit::default()
        }
    }

    /// An open shader as it is now; `None` for other documents. A file without an entry point that another
    /// open shader includes is seen in that shader.
    pub(crate) fn snapshot(&mut self, uri: &Uri) -> Option<Snapshot> {
        let (_, own) = self.unit(uri)?;
        let unit = if own.lacks_only_entry() {
            self.including(uri).unwrap_or(own)
        } else {
            own
        };
        let document = self.documents.get(&uri.0)?;
        let file = match &document.path {
            Some(path) => {
                let canonical = || path.canonicalize().ok();
                unit.file_at(path).or_else(|| unit.file_at(&canonical()?))?
            }
            None => unit.own,
        };
        Some(self.snapshot_in(uri.clone(), unit, file))
    }

    /// The unit of another open shader that includes a file.
    fn including(&mut self, uri: &Uri) -> Option<Rc<Unit>> {
        let path = self.document(uri)?.path.as_ref()?.canonicalize().ok()?;
        let others = self.shaders().into_iter().filter(|other| other != uri);
        others.collect::<Vec<_>>().iter().find_map(|other| {
            let (_, unit) = self.unit(other)?;
            unit.file_at(&path).is_some().then_some(unit)
        })
    }

    /// The files of all open shaders as they are now, also tabs and included files that are not open, each
    /// once.
    pub(crate) fn snapshots(&mut self) -> Vec<Snapshot> {
        let mut found: BTreeMap<String, Snapshot> = BTreeMap::new();
        for unit in self.units() {
            for (&file, uri) in &unit.uris {
                let is_compiled = |whole| unit.files.in_joined(whole, file, 0).is_some();
                if unit.texts.iter().any(|text| is_compiled(text.whole)) {
                    let snapshot = || self.snapshot_in(uri.clone(), unit.clone(), file);
                    found.entry(uri.0.clone()).or_insert_with(snapshot);
                }
            }
        }
        found.into_values().collect()
    }

    fn snapshot_in(&self, uri: Uri, unit: Rc<Unit>, document: FileId) -> Snapshot {
        let own = unit.texts.iter().position(|text| text.own == document);
        let holds = || {
            let mut texts = unit.texts.iter();
            texts.position(|text| unit.files.in_joined(text.whole, document, 0).is_some())
        };
        Snapshot {
            text: own.or_else(holds).unwrap_or(0),
            uri,
            unit,
            document,
            encoding: self.encoding,
            settings: self.settings.clone(),
            client: self.client.clone(),
        }
    }

    /// What the open shaders are analyzed with, each once.
    pub(crate) fn units(&mut self) -> Vec<Rc<Unit>> {
        let mut found: BTreeMap<UnitKey, Rc<Unit>> = BTreeMap::new();
        for uri in self.shaders() {
            if let Some((key, unit)) = self.unit(&uri) {
                found.insert(key, unit);
            }
        }
        // A file without an entry point is a part of the shaders that include it.
        let all: Vec<_> = found.into_values().collect();
        let is_part = |unit: &Rc<Unit>| {
            let path = unit
                .paths
                .get(&unit.own)
                .and_then(|path| path.canonicalize().ok());
            let includes = |other: &Rc<Unit>| {
                let path = path.as_deref().and_then(|path| other.file_at(path));
                path.is_some_and(|file| file != other.own)
            };
            unit.lacks_only_entry() && all.iter().any(includes)
        };
        all.iter().filter(|unit| !is_part(unit)).cloned().collect()
    }
}

/// The folder of the project of which a file is a tab.
fn project_of(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?;
    let folder = path.parent()?;
    let is_tab = Tab::ALL.iter().any(|tab| *name == *tab.file_name());
    (is_tab && is_project(folder)).then(|| folder.to_owned())
}
