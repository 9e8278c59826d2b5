//! The language server as editors run it.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::program::command;
use crate::support::lsp::{Client, is_like};

/// A session, message by message: `$FOLDER` and `$CACHE` are URIs.
const SESSION: &str = include_str!("session.json");

/// A server whose explanations are in the folder.
fn server(folder: &Path) -> Client {
    let mut command = command(folder);
    command.arg("lsp").env("XDG_CACHE_HOME", folder.join("cache"));
    Client::run(&mut command)
}

fn uri(path: &Path) -> String {
    format!("file://{}", path.to_str().unwrap())
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("cache")).unwrap();
    folder
}

#[test]
fn a_recorded_session_is_answered_as_before() {
    let folder = folder();
    let cache = folder
        .path()
        .join("cache/toyproof")
        .join(env!("CARGO_PKG_VERSION"));
    let session = SESSION
        .replace("$FOLDER", &uri(folder.path()))
        .replace("$CACHE", &uri(&cache.join("explanations")));
    let session: Vec<Value> = serde_json::from_str(&session).unwrap();
    let mut server = server(folder.path());
    for message in session {
        if let Some(sent) = message.get("send") {
            server.send(sent.clone());
        } else {
            server.receive_like(&message["await"]);
        }
    }
    assert_eq!(server.wait(), Some(0));
    let explanation = fs::read_to_string(cache.join("explanations/E0200.md")).unwrap();
    assert!(explanation.starts_with("# E0200: "), "{explanation}");
}

#[test]
fn a_session_that_ends_early_is_an_error() {
    let folder = folder();
    let mut without_shutdown = server(folder.path());
    without_shutdown.initialize(None, &json!({}), &Value::Null);
    without_shutdown.notify("exit", &Value::Null);
    assert_eq!(without_shutdown.wait(), Some(2));
    let mut disconnected = server(folder.path());
    disconnected.initialize(None, &json!({}), &Value::Null);
    disconnected.close();
    assert_eq!(disconnected.wait(), Some(2));
    let mut never_begun = server(folder.path());
    never_begun.close();
    assert_eq!(never_begun.wait(), Some(2));
}

#[test]
fn columns_are_bytes_if_the_client_counts_bytes() {
    let folder = folder();
    let mut server = server(folder.path());
    let capabilities = json!({"general": {"positionEncodings": ["utf-8", "utf-16"]}});
    let answer = server.initialize(None, &capabilities, &Value::Null);
    assert_eq!(answer["result"]["capabilities"]["positionEncoding"], "utf-8");
    let document = "untitled:Untitled-1";
    server.open(
        document,
        "void mainImage(out vec4 c, in vec2 p) { /* 😀 */ c = vec4(q); }",
    );
    let diagnostics = server.diagnostics(document, 1);
    assert_eq!(
        diagnostics[0]["range"]["start"],
        json!({"line": 0, "character": 60})
    );
    assert_eq!(server.shut_down(), Some(0));
}

#[test]
fn folders_and_settings_may_change() {
    let folder = folder();
    for name in ["first", "second"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    let first = uri(&folder.path().join("first/a.glsl"));
    let mut server = server(folder.path());
    server.initialize(Some(&uri(&folder.path().join("first"))), &json!({}), &Value::Null);
    let added =
        json!({"added": [{"uri": uri(&folder.path().join("second")), "name": "second"}], "removed": []});
    server.notify("workspace/didChangeWorkspaceFolders", &json!({"event": added}));
    server.open(
        &first,
        "void mainImage(out vec4 c, in vec2 p) { float a = 1; c = vec4(a); }",
    );
    let strict = server.diagnostics(&first, 1);
    assert_eq!(strict.as_array().unwrap().len(), 1);
    let settings = json!({"settings": {"toyproof": {"lenient": true}}});
    server.notify("workspace/didChangeConfiguration", &settings);
    assert_eq!(server.diagnostics(&first, 1), json!([]));
    // A tab of a project that is not open has its errors, too.
    let second = folder.path().join("second");
    fs::write(
        second.join("image.glsl"),
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(q); }",
    )
    .unwrap();
    let common = uri(&second.join("common.glsl"));
    server.open(&common, "float f() { return 1.; }");
    let image = json!({"uri": uri(&second.join("image.glsl"))});
    let published = json!({"method": "textDocument/publishDiagnostics", "params": image});
    let of_image = server.receive_like(&published);
    assert_eq!(of_image["params"]["diagnostics"].as_array().unwrap().len(), 1);
    let closed = json!({"textDocument": {"uri": common}});
    server.notify("textDocument/didClose", &closed);
    let cleared = server.receive_like(&published);
    assert_eq!(cleared["params"]["diagnostics"], json!([]));
    assert_eq!(server.shut_down(), Some(0));
}

/// A folder with an exercise of the course whose light comes from below.
fn wrong_exercise() -> (TempDir, String, String) {
    let folder = folder();
    for name in ["03-shading.glsl", "03-shading.toml"] {
        let text = fs::read_to_string(Path::new("glsl").join(name)).unwrap();
        fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join("03-shading.glsl");
    let right = fs::read_to_string(&path).unwrap();
    let wrong = right.replacen("dot(normal, toLight)", "dot(normal, -toLight)", 1);
    assert_ne!(right, wrong);
    fs::write(&path, &wrong).unwrap();
    let document = uri(&path);
    (folder, document, wrong)
}

#[test]
fn a_save_is_checked_and_its_mistake_shown() {
    let (folder, document, wrong) = wrong_exercise();
    let mut server = server(folder.path());
    let capabilities = json!({"workspace": {"codeLens": {"refreshSupport": true}}});
    server.initialize(Some(&uri(folder.path())), &capabilities, &Value::Null);
    server.open(&document, &wrong);
    assert_eq!(server.diagnostics(&document, 1), json!([]));
    let saved = json!({"textDocument": {"uri": document}});
    server.notify("textDocument/didSave", &saved);
    // One refresh when the check starts, and one when it ends.
    let refresh = json!({"method": "workspace/codeLens/refresh"});
    server.receive_like(&refresh);
    let found = server.diagnostics(&document, 1);
    assert_eq!(found.as_array().unwrap().len(), 1, "{found}");
    assert_eq!(found[0]["source"], "toyproof check");
    let lenses = server.request("textDocument/codeLens", &saved);
    let title = lenses["result"][0]["command"]["title"].as_str().unwrap();
    assert!(title.starts_with("toyproof: wrong: "), "{title}");
    let range = found[0]["range"].clone();
    let only = json!({"diagnostics": [], "only": ["quickfix"]});
    let parameters = json!({"textDocument": {"uri": document}, "range": range, "context": only});
    let actions = server.request("textDocument/codeAction", &parameters);
    let action = &actions["result"][0];
    assert!(
        action["title"]
            .as_str()
            .unwrap()
            .starts_with("Correct the image: "),
        "{actions}"
    );
    assert!(
        is_like(action, &json!({"isPreferred": true, "kind": "quickfix"})),
        "{actions}"
    );
    // What was found is about the saved text.
    let start = json!({"line": 0, "character": 0});
    let change = json!({"range": {"start": start, "end": start}, "text": "\n"});
    let change = json!({"textDocument": {"uri": document, "version": 2}, "contentChanges": [change]});
    server.notify("textDocument/didChange", &change);
    assert_eq!(server.diagnostics(&document, 2), json!([]));
    assert_eq!(server.shut_down(), Some(0));
}

#[test]
fn the_values_of_a_pixel_are_shown_on_their_lines() {
    let (folder, document, wrong) = wrong_exercise();
    let mut server = server(folder.path());
    let capabilities = json!({"workspace": {"inlayHint": {"refreshSupport": true}}});
    let settings = json!({"inlayHints": {"parameterNames": false, "conversions": false}});
    server.initialize(None, &capabilities, &settings);
    server.open(&document, &wrong);
    let command = json!({"command": "toyproof.debugPixel", "arguments": [document, 320, 180]});
    server.request("workspace/executeCommand", &command);
    server.receive_like(&json!({"method": "workspace/inlayHint/refresh"}));
    let end = wrong.lines().count();
    let range = json!({"start": {"line": 0, "character": 0}, "end": {"line": end, "character": 0}});
    let parameters = json!({"textDocument": {"uri": document}, "range": range});
    let hints = server.request("textDocument/inlayHint", &parameters);
    let hints = hints["result"].as_array().unwrap();
    assert!(hints.len() > 3, "{hints:?}");
    let labels: Vec<_> = hints.iter().map(|hint| hint["label"].as_str().unwrap()).collect();
    assert!(
        labels.iter().any(|label| label.starts_with("fragColor = (")),
        "{labels:?}"
    );
    let command = json!({"command": "toyproof.debugPixel", "arguments": [document, null]});
    server.request("workspace/executeCommand", &command);
    let hints = server.request("textDocument/inlayHint", &parameters);
    assert_eq!(hints["result"], json!([]));
    assert_eq!(server.shut_down(), Some(0));
}
