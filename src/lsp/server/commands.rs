//! What the server does in the background, and the commands that clients run.

use std::path::PathBuf;

use lsp_types::{
    CodeLensRefreshRequest, DidChangeWatchedFilesNotification, InlayHintRefreshRequest, MessageType,
    Notification, Range, Registration, RegistrationParams, RegistrationRequest, Request, ShowDocumentParams,
    ShowDocumentRequest, Uri,
};
use serde_json::{Value, json};
use toyproof_diagnostic::{Code, File};
use toyproof_glsl::Resolution;
use toyproof_project::files::EXTENSIONS;

use super::{Event, Server};
use crate::background::{CHECK_COMMAND, CheckResult, PixelValues, has_reference};
use crate::edits::FileEdits;
use crate::explain;
use crate::snapshot::Snapshot;
use crate::symbol::FilePlace;

/// Shows the values of a pixel as inlay hints: `[uri, x, y]`; `[uri]` or null ends it.
pub(super) const DEBUG_PIXEL: &str = "toyproof.debugPixel";

/// Shows the explanation of a code: `[code]`.
pub(super) const EXPLAIN: &str = "toyproof.explain";

/// The commands of `workspace/executeCommand`.
pub(super) const COMMANDS: [&str; 3] = [CHECK_COMMAND, DEBUG_PIXEL, EXPLAIN];

/// A document that is a file.
struct SavedDocument {
    path: PathBuf,
    /// The folder of the editor that contains it, else its own.
    folder: PathBuf,
    text: File,
}

impl Server<'_> {
    fn saved_document(&self, uri: &Uri) -> Option<SavedDocument> {
        let document = self.workspace.document(uri)?;
        let path = document.path.clone()?;
        let folders = self.workspace.folders.iter();
        let folder = folders
            .filter(|folder| path.starts_with(folder))
            .max_by_key(|folder| folder.as_os_str().len());
        let folder = folder.cloned().or_else(|| path.parent().map(PathBuf::from))?;
        Some(SavedDocument {
            path,
            folder,
            text: document.text.clone(),
        })
    }

    /// Starts what follows a save: the check, if there is something to compare with, and the values of the
    /// chosen pixel.
    pub(super) fn saved(&mut self, uri: &Uri) {
        let settings = self.workspace.settings.clone();
        let Some(document) = self.saved_document(uri) else {
            return;
        };
        if settings.check.on_save && has_reference(&document.path, &settings.check) {
            self.start_check(uri);
        }
        if let Some(pixel) = self.pixels.pixel(uri) {
            self.start_pixel(uri, pixel);
        }
    }

    fn start_check(&mut self, uri: &Uri) {
        let (Some(document), Some(snapshot)) = (self.saved_document(uri), self.workspace.snapshot(uri))
        else {
            return;
        };
        // A shader that does not compile has its diagnostics already.
        if !snapshot.analysis().is_valid() {
            self.checks.forget(uri);
            self.refresh_lenses();
            return;
        }
        let events = self.events.clone();
        let settings = self.workspace.settings.clone();
        self.checks.start(
            &self.executable,
            &document.folder,
            (uri, &document.path, &document.text),
            &settings.check,
            move |result| {
                // The session may have ended.
                let _ = events.send(Event::Checked(result));
            },
        );
        self.refresh_lenses();
    }

    /// Takes over the result of a check.
    pub(super) fn checked(&mut self, result: CheckResult) {
        if self.checks.finish(result) {
            self.is_changed = true;
            self.refresh_lenses();
        }
    }

    fn start_pixel(&mut self, uri: &Uri, pixel: [u32; 2]) {
        let Some(document) = self.saved_document(uri) else {
            return;
        };
        let events = self.events.clone();
        let settings = self.workspace.settings.clone();
        self.pixels.start(
            &self.executable,
            &document.folder,
            (uri, &document.path, &document.text),
            pixel,
            &settings.check,
            move |values| {
                let _ = events.send(Event::Traced(values));
            },
        );
    }

    /// Takes over the values of a pixel.
    pub(super) fn traced(&mut self, values: PixelValues) {
        if let Err(reason) = self.pixels.finish(values) {
            self.show(MessageType::Warning, &reason);
        }
        self.refresh_hints();
    }

    /// Asks the client to report changes of files on disk, if it can: tabs and included files may change
    /// elsewhere.
    pub(super) fn watch_files(&mut self) {
        let can_watch = |client: &lsp_types::ClientCapabilities| {
            let workspace = client.workspace.as_ref()?;
            workspace.did_change_watched_files.as_ref()?.dynamic_registration
        };
        if can_watch(self.workspace.client()) != Some(true) {
            return;
        }
        let mut patterns = EXTENSIONS.to_vec();
        patterns.push("toml");
        let pattern = format!("**/*.{{{}}}", patterns.join(","));
        let options = json!({"watchers": [{"globPattern": pattern}]});
        let method = DidChangeWatchedFilesNotification::METHOD.as_str().to_owned();
        let registration = Registration::new("files".to_owned(), method, Some(options));
        self.ask::<RegistrationRequest>(RegistrationParams::new(vec![registration]));
    }

    fn refresh_lenses(&mut self) {
        let can_refresh = |client: &lsp_types::ClientCapabilities| {
            client.workspace.as_ref()?.code_lens.as_ref()?.refresh_support
        };
        if can_refresh(self.workspace.client()) == Some(true) {
            self.ask::<CodeLensRefreshRequest>(json!(null));
        }
    }

    fn refresh_hints(&mut self) {
        let can_refresh = |client: &lsp_types::ClientCapabilities| {
            client.workspace.as_ref()?.inlay_hint.as_ref()?.refresh_support
        };
        if can_refresh(self.workspace.client()) == Some(true) {
            self.ask::<InlayHintRefreshRequest>(json!(null));
        }
    }

    /// Runs a command of a client.
    ///
    /// # Errors
    /// Its arguments are wrong, or it does not exist.
    pub(super) fn execute(&mut self, command: &str, arguments: &[Value]) -> Result<Value, String> {
        let uri = || {
            let uri = arguments.first().and_then(Value::as_str);
            uri.map(|uri| Uri(uri.to_owned()))
                .ok_or_else(|| format!("`{command}` needs the URI of a document"))
        };
        match command {
            CHECK_COMMAND => {
                let uri = uri()?;
                self.saved_document(&uri)
                    .ok_or("a check needs a shader in a file")?;
                self.start_check(&uri);
                Ok(Value::Null)
            }
            DEBUG_PIXEL => {
                let uri = uri()?;
                match arguments.get(1..).unwrap_or_default() {
                    [] | [Value::Null, ..] => self.pixels.forget(&uri),
                    [x, y] => {
                        let number =
                            |value: &Value| value.as_u64().and_then(|value| u32::try_from(value).ok());
                        let pixel = number(x).zip(number(y)).ok_or("x and y must be pixels, from 0")?;
                        self.saved_document(&uri)
                            .ok_or("the values of a pixel need a shader in a file")?;
                        self.start_pixel(&uri, [pixel.0, pixel.1]);
                    }
                    _ => return Err(format!("`{command}` needs a URI, x and y")),
                }
                self.refresh_hints();
                Ok(Value::Null)
            }
            EXPLAIN => {
                let name = arguments
                    .first()
                    .and_then(Value::as_str)
                    .ok_or("`toyproof.explain` needs a code")?;
                let code = Code::parse(name).ok_or_else(|| format!("`{name}` is not a code"))?;
                let uri = self.explanations.href(code);
                let can_show = |client: &lsp_types::ClientCapabilities| {
                    Some(client.window.as_ref()?.show_document.as_ref()?.support)
                };
                if let Some(uri) = uri.clone()
                    && can_show(self.workspace.client()) == Some(true)
                {
                    self.ask::<ShowDocumentRequest>(ShowDocumentParams {
                        uri,
                        external: None,
                        take_focus: Some(true),
                        selection: None::<Range>,
                    });
                }
                Ok(json!({"uri": uri, "text": explain::text(code)}))
            }
            _ => Err(format!("unknown command `{command}`")),
        }
    }

    /// The verdict of a document above the function that the host calls.
    pub(super) fn lenses(&mut self, uri: &Uri) -> Vec<lsp_types::CodeLens> {
        let Some(snapshot) = self.workspace.snapshot(uri) else {
            return Vec::new();
        };
        let at = snapshot.document_range(entry(&snapshot), entry(&snapshot)).start;
        let at = lsp_types::Position::new(at.line, 0);
        self.checks.lens(uri, snapshot.file(), at).into_iter().collect()
    }

    /// The edits that a check of a document found, and their title.
    pub(super) fn found_fix(&self, snapshot: &Snapshot) -> Option<(String, FileEdits)> {
        let fix = self.checks.fix(&snapshot.uri, snapshot.file())?;
        let mut edits = FileEdits::default();
        for (bytes, text) in fix.edits {
            let place = FilePlace {
                uri: snapshot.uri.0.clone(),
                start: bytes.start,
                end: bytes.end,
            };
            if !edits.add(place, &text) {
                return None;
            }
        }
        Some((fix.title, edits))
    }

    /// Sends a request whose answer needs no action.
    fn ask<R: Request>(&mut self, parameters: impl serde::Serialize) {
        self.requests += 1;
        let id = lsp_server::RequestId::from(self.requests);
        let method = R::METHOD.as_str().to_owned();
        let request = lsp_server::Request::new(id, method, parameters);
        self.send(request.into());
    }
}

/// The byte of the document at which the function stands that the host calls; 0 if it has none.
fn entry(snapshot: &Snapshot) -> u32 {
    let Some(checked) = snapshot.analysis().checked() else {
        return 0;
    };
    let mut names = snapshot.analysis().names.iter();
    let name =
        names.rfind(|name| name.declares && name.resolution == Resolution::Function(checked.main_image));
    let span = name.and_then(|name| snapshot.in_document(name.at.spelling));
    span.map_or(0, |span| span.start)
}
