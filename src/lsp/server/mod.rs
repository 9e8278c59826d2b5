//! The loop over the messages of a client.
//!
//! Requests are answered in turn: the front end takes less time for a shader than a thread would save. All
//! messages that wait are read first, so that a request is not answered that was canceled meanwhile, and
//! diagnostics are only computed for the last of many changes. No request is stale: each is answered with
//! the text that its sender knew.

mod capabilities;
mod commands;
mod reading;
mod requests;
mod respond;

use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;

use lsp_server::{
    Connection, ErrorCode, Message, Notification as LspNotification, ProtocolError, Request, RequestId,
    Response,
};
use lsp_types::{
    CancelNotification, DidChangeConfigurationNotification, DidChangeTextDocumentNotification,
    DidChangeWatchedFilesNotification, DidChangeWorkspaceFoldersNotification,
    DidCloseTextDocumentNotification, DidOpenTextDocumentNotification, DidSaveTextDocumentNotification,
    InitializedNotification, MessageType, Notification, PositionEncodingKind, PublishDiagnosticsNotification,
    PublishDiagnosticsParams, ShowMessageNotification, ShowMessageParams, Uri,
};
use serde_json::{Value, json};

use crate::Host;
use crate::background::{CheckResult, Checks, PixelValues, Pixels};
use crate::diagnostics::{self, Published};
use crate::encoding::Encoding;
use crate::explain::Explanations;
use crate::location::path_of;
use crate::settings::Settings;
use crate::workspace::Workspace;

/// Why the server ended without the client's request.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The client does not follow the protocol.
    #[error("the client does not follow the protocol: {0}")]
    Protocol(#[from] ProtocolError),
    /// The connection cannot be read or written.
    #[error("standard input or output of the language server: {0}")]
    Connection(#[from] std::io::Error),
    /// The client ended the connection, or sent `exit` before `shutdown`.
    #[error("the client ended the connection without `shutdown`")]
    Disconnected,
}

/// The stack of the thread that analyzes texts: nested expressions need as much as in a check.
const STACK_BYTES: usize = 16 << 20;

/// Serves a client on standard input and output until it ends the session.
///
/// # Errors
/// The client does not follow the protocol, or the connection ends early.
pub fn serve(host: Host) -> Result<(), ServeError> {
    let (connection, threads) = Connection::stdio();
    let builder = thread::Builder::new()
        .name("server".to_owned())
        .stack_size(STACK_BYTES);
    let server = builder.spawn(move || serve_connection(&connection, host))?;
    let result = server.join().unwrap_or(Err(ServeError::Disconnected));
    // After an error, the reading thread may wait for a message that never comes.
    if result.is_ok() {
        threads.join()?;
    }
    result
}

/// Serves a client on a connection.
fn serve_connection(connection: &Connection, host: Host) -> Result<(), ServeError> {
    let (id, parameters) = connection.initialize_start()?;
    let encoding = Encoding::negotiated(&offered_encodings(&parameters));
    let result = json!({
        "capabilities": capabilities::of_server(encoding),
        "serverInfo": {"name": "toyproof", "version": env!("CARGO_PKG_VERSION")},
    });
    connection.initialize_finish(id, result)?;
    let (events, waiting) = mpsc::channel();
    let mut server = Server::new(connection, host, encoding, &parameters, events.clone());
    let receiver = connection.receiver.clone();
    // Reads ahead, so that the server sees all messages that wait.
    thread::spawn(move || {
        for message in receiver {
            if events.send(Event::Message(message)).is_err() {
                return;
            }
        }
        let _ = events.send(Event::Disconnected);
    });
    server.run(&waiting)
}

fn offered_encodings(parameters: &Value) -> Vec<PositionEncodingKind> {
    let offered = parameters.pointer("/capabilities/general/positionEncodings");
    let offered = offered.and_then(|offered| serde_json::from_value(offered.clone()).ok());
    offered.unwrap_or_default()
}

/// What the server waits for.
#[derive(Debug)]
enum Event {
    Message(Message),
    Disconnected,
    Checked(CheckResult),
    Traced(PixelValues),
}

/// Whether the session goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Session {
    Open,
    Closed,
}

/// The state of a session.
struct Server<'c> {
    connection: &'c Connection,
    workspace: Workspace,
    explanations: Explanations,
    published: Published,
    /// The program, which runs checks.
    executable: PathBuf,
    checks: Checks,
    pixels: Pixels,
    /// Where results from the background arrive.
    events: Sender<Event>,
    /// The number of requests that were sent.
    requests: i32,
    /// Messages that were read, and not yet handled.
    waiting: VecDeque<Message>,
    /// Whether texts changed since diagnostics were published.
    is_changed: bool,
    has_shut_down: bool,
}

impl<'c> Server<'c> {
    fn new(
        connection: &'c Connection,
        host: Host,
        encoding: Encoding,
        parameters: &Value,
        events: Sender<Event>,
    ) -> Self {
        let client = parameters.get("capabilities").cloned().unwrap_or_default();
        let mut server = Self {
            connection,
            // A client whose capabilities are malformed has none.
            workspace: Workspace::new(encoding, serde_json::from_value(client).unwrap_or_default()),
            explanations: Explanations::new(host.cache),
            published: Published::default(),
            executable: host.executable,
            checks: Checks::default(),
            pixels: Pixels::default(),
            events,
            requests: 0,
            waiting: VecDeque::new(),
            is_changed: false,
            has_shut_down: false,
        };
        for folder in folders_of(parameters) {
            server.workspace.folders.extend(path_of(&folder));
        }
        if let Some(options) = parameters.get("initializationOptions") {
            server.read_settings(options);
        }
        server
    }

    fn run(&mut self, events: &Receiver<Event>) -> Result<(), ServeError> {
        loop {
            let Ok(first) = events.recv() else {
                return Err(ServeError::Disconnected);
            };
            let mut next = Some(first);
            while let Some(event) = next {
                match event {
                    Event::Message(message) => self.waiting.push_back(message),
                    Event::Checked(result) => self.checked(result),
                    Event::Traced(values) => self.traced(values),
                    Event::Disconnected if self.has_shut_down => return Ok(()),
                    Event::Disconnected => return Err(ServeError::Disconnected),
                }
                next = events.try_recv().ok();
            }
            while let Some(message) = self.waiting.pop_front() {
                if self.handle(message)? == Session::Closed {
                    return Ok(());
                }
            }
            self.publish_diagnostics();
        }
    }

    fn handle(&mut self, message: Message) -> Result<Session, ServeError> {
        match message {
            Message::Request(request) => self.request(request),
            Message::Notification(notification) if notification.method == "exit" => {
                return if self.has_shut_down {
                    Ok(Session::Closed)
                } else {
                    Err(ServeError::Disconnected)
                };
            }
            Message::Notification(notification) => {
                let method = notification.method.clone();
                let handled = catch_unwind(AssertUnwindSafe(|| self.notification(notification)));
                match handled {
                    Ok(Ok(())) => {}
                    Ok(Err(error)) => {
                        self.show(MessageType::Warning, &format!("`{method}` is malformed: {error}"));
                    }
                    Err(_) => self.show(MessageType::Error, &format!("internal error in `{method}`")),
                }
            }
            // The client's answers to requests of the server, none of which needs one.
            Message::Response(_) => {}
        }
        Ok(Session::Open)
    }

    fn request(&mut self, request: Request) {
        let id = request.id.clone();
        let response = if self.is_canceled(&id) {
            Response::new_err(
                id,
                ErrorCode::RequestCanceled as i32,
                "canceled by the client".to_owned(),
            )
        } else if request.method == "shutdown" {
            self.has_shut_down = true;
            Response::new_ok(id, ())
        } else if self.has_shut_down {
            let message = "the session is shut down".to_owned();
            Response::new_err(id, ErrorCode::InvalidRequest as i32, message)
        } else {
            let method = request.method.clone();
            let answer = catch_unwind(AssertUnwindSafe(|| requests::answer(self, request)));
            answer.unwrap_or_else(|_| {
                let message = format!("internal error in `{method}`");
                Response::new_err(id, ErrorCode::InternalError as i32, message)
            })
        };
        self.send(Message::Response(response));
    }

    /// Whether a message that waits cancels the request.
    fn is_canceled(&self, id: &RequestId) -> bool {
        self.waiting.iter().any(|message| match message {
            Message::Notification(notification) => {
                notification.method == CancelNotification::METHOD.as_str()
                    && notification.params.get("id") == serde_json::to_value(id).ok().as_ref()
            }
            _ => false,
        })
    }

    fn notification(&mut self, notification: LspNotification) -> Result<(), serde_json::Error> {
        let LspNotification { method, params } = notification;
        match method.as_str().into() {
            DidOpenTextDocumentNotification::METHOD => {
                let document = read::<DidOpenTextDocumentNotification>(params)?.text_document;
                let language = serde_json::to_value(&document.language_id)?;
                let language = language.as_str().unwrap_or_default();
                self.workspace
                    .open(&document.uri, language, document.version, document.text);
                self.is_changed = true;
            }
            DidChangeTextDocumentNotification::METHOD => {
                let change = read::<DidChangeTextDocumentNotification>(params)?;
                let document = change.text_document;
                let uri = document.text_document_identifier.uri;
                self.is_changed |= self
                    .workspace
                    .change(&uri, document.version, change.content_changes);
            }
            DidCloseTextDocumentNotification::METHOD => {
                let closed = read::<DidCloseTextDocumentNotification>(params)?;
                let uri = closed.text_document.uri;
                self.workspace.close(&uri);
                self.checks.forget(&uri);
                self.pixels.forget(&uri);
                self.is_changed = true;
            }
            DidSaveTextDocumentNotification::METHOD => {
                self.saved(&read::<DidSaveTextDocumentNotification>(params)?.text_document.uri);
            }
            DidChangeWatchedFilesNotification::METHOD => {
                self.workspace.forget_all();
                self.is_changed = true;
            }
            DidChangeWorkspaceFoldersNotification::METHOD => {
                let event = read::<DidChangeWorkspaceFoldersNotification>(params)?.event;
                for folder in event.removed {
                    if let Some(path) = path_of(&folder.uri) {
                        self.workspace.folders.remove(&path);
                    }
                }
                let added = event.added.iter().filter_map(|folder| path_of(&folder.uri));
                self.workspace.folders.extend(added);
            }
            DidChangeConfigurationNotification::METHOD => {
                self.read_settings(params.get("settings").unwrap_or(&Value::Null));
            }
            InitializedNotification::METHOD => self.watch_files(),
            // Others, such as `$/setTrace`, need no action, nor do those of later versions
            // of the protocol.
            _ => {}
        }
        Ok(())
    }

    /// Takes over settings, and reports what is wrong with them.
    fn read_settings(&mut self, value: &Value) {
        let (settings, problems) = Settings::read(value);
        for problem in problems {
            self.show(MessageType::Warning, &problem);
        }
        if *self.workspace.settings != settings {
            self.workspace.settings = Rc::new(settings);
            self.workspace.forget_all();
            self.is_changed = true;
        }
    }

    /// Publishes the diagnostics that changed.
    fn publish_diagnostics(&mut self) {
        if !std::mem::take(&mut self.is_changed) {
            return;
        }
        let computed = catch_unwind(AssertUnwindSafe(|| {
            let mut all = BTreeMap::new();
            for unit in self.workspace.units() {
                for (uri, found) in
                    diagnostics::of_unit(&unit, self.workspace.encoding, &mut self.explanations)
                {
                    let of_file: &mut Vec<_> = all.entry(uri).or_default();
                    for diagnostic in found {
                        // A file that several shaders include has the same errors in each.
                        if !of_file.contains(&diagnostic) {
                            of_file.push(diagnostic);
                        }
                    }
                }
            }
            all
        }));
        let Ok(mut all) = computed else {
            self.show(MessageType::Error, "internal error in an analysis");
            return;
        };
        for uri in self.workspace.shaders() {
            let of_file = all.entry(uri.0.clone()).or_default();
            if let Some(document) = self.workspace.document(&uri) {
                of_file.extend(
                    self.checks
                        .diagnostic(&uri, &document.text, self.workspace.encoding),
                );
            }
        }
        for (uri, version, diagnostics) in self.published.replace(all, |uri| self.workspace.version(uri)) {
            self.notify::<PublishDiagnosticsNotification>(PublishDiagnosticsParams {
                uri,
                version,
                diagnostics,
            });
        }
    }

    fn show(&self, kind: MessageType, message: &str) {
        let message = format!("toyproof: {message}");
        self.notify::<ShowMessageNotification>(ShowMessageParams::new(kind, message));
    }

    fn notify<N: Notification>(&self, parameters: N::Params)
    where
        N::Params: serde::Serialize,
    {
        let method = N::METHOD.as_str().to_owned();
        self.send(Message::Notification(LspNotification::new(method, parameters)));
    }

    /// Sends a message. If the connection is closed, the loop ends when it next reads.
    fn send(&self, message: Message) {
        let _ = self.connection.sender.send(message);
    }
}

fn read<N: Notification>(parameters: Value) -> Result<N::Params, serde_json::Error>
where
    N::Params: serde::de::DeserializeOwned,
{
    serde_json::from_value(parameters)
}

/// The folders with which a session begins.
fn folders_of(parameters: &Value) -> Vec<Uri> {
    let uri = |value: &Value| value.as_str().map(|uri| Uri(uri.to_owned()));
    let folders = parameters.get("workspaceFolders").and_then(Value::as_array);
    match folders {
        Some(folders) => folders
            .iter()
            .filter_map(|folder| uri(folder.get("uri")?))
            .collect(),
        None => parameters.get("rootUri").and_then(uri).into_iter().collect(),
    }
}
