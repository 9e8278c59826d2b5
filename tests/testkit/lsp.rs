//! A client of the language server: it sends messages, and waits for answers.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;

use serde_json::{Value, json};

use crate::wait::HANG_GUARD;

/// A running server.
#[derive(Debug)]
pub struct Client {
    child: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Value>,
    requests: i64,
}

impl Drop for Client {
    fn drop(&mut self) {
        // A test that failed leaves the server running.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Client {
    /// Starts the program as a language server.
    pub fn start(program: &Path) -> Self {
        let mut command = Command::new(program);
        command.arg("lsp").stdin(Stdio::piped()).stdout(Stdio::piped());
        Self::run(&mut command)
    }

    /// Starts a server whose input and output are pipes.
    pub fn run(command: &mut Command) -> Self {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the server starts");
        let output = child.stdout.take().expect("it is piped");
        let input = child.stdin.take();
        let (send, messages) = mpsc::channel();
        thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(message) = read_message(&mut output) {
                if send.send(message).is_err() {
                    return;
                }
            }
        });
        Self {
            child,
            input,
            messages,
            requests: 0,
        }
    }

    /// Sends a message; the version of the protocol is added.
    pub fn send(&mut self, mut message: Value) {
        message["jsonrpc"] = json!("2.0");
        self.send_text(&message.to_string());
    }

    /// Sends a text as a message.
    pub fn send_text(&mut self, text: &str) {
        let input = self.input.as_mut().expect("the input is open");
        write!(input, "Content-Length: {}\r\n\r\n{text}", text.len()).expect("the server reads");
        input.flush().expect("the server reads");
    }

    /// Closes the server's input.
    pub fn close(&mut self) {
        self.input = None;
    }

    /// The next message.
    pub fn receive(&mut self) -> Value {
        let received = self.messages.recv_timeout(HANG_GUARD);
        received.expect("the server answers")
    }

    /// The next message that has what a pattern has: members of objects, and elements of lists in order.
    /// Messages before it are dropped.
    pub fn receive_like(&mut self, pattern: &Value) -> Value {
        let mut others = Vec::new();
        loop {
            let Ok(message) = self.messages.recv_timeout(HANG_GUARD) else {
                let others: Vec<_> = others.iter().map(Value::to_string).collect();
                panic!("no message is like {pattern}, but:\n{}", others.join("\n"));
            };
            if is_like(&message, pattern) {
                return message;
            }
            others.push(message);
            assert!(others.len() < 1000, "no message is like {pattern}");
        }
    }

    /// Sends a request and waits for its answer.
    pub fn request(&mut self, method: &str, parameters: &Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        self.send(json!({"id": id, "method": method, "params": parameters}));
        loop {
            let message = self.receive();
            if message.get("method").is_none() && message["id"] == json!(id) {
                return message;
            }
        }
    }

    /// Sends a notification.
    pub fn notify(&mut self, method: &str, parameters: &Value) {
        self.send(json!({"method": method, "params": parameters}));
    }

    /// Begins a session with these capabilities of the client and these settings.
    pub fn initialize(&mut self, folder: Option<&str>, capabilities: &Value, settings: &Value) -> Value {
        let folders = folder.map(|uri| json!([{"uri": uri, "name": "folder"}]));
        let parameters = json!({"processId": null, "rootUri": null, "workspaceFolders": folders,
            "capabilities": capabilities, "initializationOptions": settings});
        let answer = self.request("initialize", &parameters);
        self.notify("initialized", &json!({}));
        answer
    }

    /// Opens a document.
    pub fn open(&mut self, uri: &str, text: &str) {
        let document = json!({"uri": uri, "languageId": "glsl", "version": 1, "text": text});
        self.notify("textDocument/didOpen", &json!({"textDocument": document}));
    }

    /// The diagnostics of the next publication for a version of a document.
    pub fn diagnostics(&mut self, uri: &str, version: i64) -> Value {
        let parameters = json!({"uri": uri, "version": version});
        let pattern = json!({"method": "textDocument/publishDiagnostics", "params": parameters});
        self.receive_like(&pattern)["params"]["diagnostics"].take()
    }

    /// Ends the session, and returns the exit code of the server.
    pub fn shut_down(&mut self) -> Option<i32> {
        self.request("shutdown", &Value::Null);
        self.notify("exit", &Value::Null);
        self.wait()
    }

    /// Waits for the server to end, and returns its exit code.
    pub fn wait(&mut self) -> Option<i32> {
        self.child.wait().expect("the server ends").code()
    }
}

/// Whether a value has all that a pattern has.
pub fn is_like(value: &Value, pattern: &Value) -> bool {
    match (value, pattern) {
        (Value::Object(value), Value::Object(pattern)) => pattern
            .iter()
            .all(|(key, pattern)| value.get(key).is_some_and(|value| is_like(value, pattern))),
        (Value::Array(value), Value::Array(pattern)) => {
            value.len() == pattern.len()
                && value
                    .iter()
                    .zip(pattern)
                    .all(|(value, pattern)| is_like(value, pattern))
        }
        _ => value == pattern,
    }
}

fn read_message(output: &mut impl BufRead) -> Option<Value> {
    let mut length = None;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        if let Some(number) = line.strip_prefix("Content-Length: ") {
            length = number.parse().ok();
        }
    }
    let mut bytes = vec![0; length?];
    output.read_exact(&mut bytes).ok()?;
    serde_json::from_slice(&bytes).ok()
}
