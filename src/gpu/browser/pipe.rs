//! The browser's process, and Chrome's `DevTools` protocol over its pipe: messages of JSON, each ended by a zero byte.

use std::io::{BufRead, BufReader, Write};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};
use std::{fs, thread};

use rustix::process::{Pid, Signal, geteuid, kill_process_group};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::Failure;

/// A browser with our page open.
#[derive(Debug)]
pub(super) struct Pipe {
    child: Child,
    requests: Option<ChildStdin>,
    answers: Receiver<Value>,
    profile: Option<TempDir>,
    /// How many questions were asked.
    asked: u64,
    session: Option<String>,
    product: String,
}

/// It speaks on descriptors 3 and 4, which a shell can put there.
const SHELL: &str = r#"exec "$0" "$@" 3<&0 4>&1 </dev/null >/dev/null 2>/dev/null"#;
/// How long the profile of a browser that ended may take to go.
const GRACE: Duration = Duration::from_secs(3);
const NAP: Duration = Duration::from_millis(10);

impl Pipe {
    /// Starts the browser and opens the page in it.
    pub(super) fn open(program: &Path, page: &str, deadline: Instant) -> Result<Self, Failure> {
        let gone = |error: std::io::Error| Failure::Gone(error.to_string());
        let profile = tempfile::Builder::new()
            .prefix("toyproof-browser-")
            .tempdir()
            .map_err(gone)?;
        // A page of a file may use WebGPU, which an empty one may not.
        let file = profile.path().join("page.html");
        fs::write(&file, page).map_err(gone)?;
        let url = format!("file://{}", file.to_string_lossy());
        let mut command = Command::new("sh");
        command
            .args(["-c", SHELL])
            .arg(program)
            .args(["--headless=new", "--remote-debugging-pipe"])
            .args([
                "--no-first-run",
                "--disable-extensions",
                "--disable-background-networking",
                "--disable-component-update",
            ])
            .args([
                "--use-gl=angle",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
            ])
            .args([
                "--enable-unsafe-webgpu",
                "--use-webgpu-adapter=swiftshader",
                "--enable-features=Vulkan",
            ])
            .arg(format!("--user-data-dir={}", profile.path().to_string_lossy()));
        if geteuid().is_root() {
            // Its own sandbox does not run as root; the shaders are those that run here in any case.
            command.arg("--no-sandbox");
        }
        let mut child = command
            .arg(&url)
            // Out of reach of the terminal's interrupt, and to be ended with all its children.
            .process_group(0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(gone)?;
        let requests = child.stdin.take();
        let (sender, answers) = mpsc::channel();
        if let Some(output) = child.stdout.take() {
            thread::spawn(move || listen(output, &sender));
        }
        let mut pipe = Self {
            child,
            requests,
            answers,
            profile: Some(profile),
            asked: 0,
            session: None,
            product: String::new(),
        };
        pipe.attach(&url, deadline)?;
        Ok(pipe)
    }

    /// Its name and version.
    pub(super) fn product(&self) -> &str {
        &self.product
    }

    /// What an expression of the page's comes to, waited for where it is a promise.
    pub(super) fn call(&mut self, expression: &str, patience: Duration) -> Result<Value, Failure> {
        let deadline = Instant::now() + patience;
        let parameters = json!({"expression": expression, "awaitPromise": true, "returnByValue": true});
        let answer = self.ask("Runtime.evaluate", &parameters, deadline);
        let mut answer = answer.map_err(|failure| match failure {
            Failure::Silent(_) => Failure::Silent(patience),
            other => other,
        })?;
        Ok(answer["result"]["value"].take())
    }

    /// Waits for the page.
    fn attach(&mut self, url: &str, deadline: Instant) -> Result<(), Failure> {
        let version = self.ask("Browser.getVersion", &json!({}), deadline)?;
        version["product"]
            .as_str()
            .unwrap_or("Chromium")
            .clone_into(&mut self.product);
        let page = loop {
            let targets = self.ask("Target.getTargets", &json!({}), deadline)?;
            let pages = targets["targetInfos"].as_array().map_or(&[][..], Vec::as_slice);
            let ours = pages.iter().find(|page| page["url"] == url);
            if let Some(page) = ours {
                break page["targetId"].clone();
            }
            thread::sleep(NAP);
        };
        let parameters = json!({"targetId": page, "flatten": true});
        let session = self.ask("Target.attachToTarget", &parameters, deadline)?;
        self.session = session["sessionId"].as_str().map(str::to_owned);
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if self.call("typeof toyproof === 'function'", left)? == true {
                return Ok(());
            }
            thread::sleep(NAP);
        }
    }

    /// Asks a question; the result of its answer.
    fn ask(&mut self, method: &str, parameters: &Value, deadline: Instant) -> Result<Value, Failure> {
        self.asked += 1;
        let mut message = json!({"id": self.asked, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let sent = self.requests.as_mut().map(|requests| {
            let bytes = [message.to_string().as_bytes(), &[0]].concat();
            requests.write_all(&bytes).and_then(|()| requests.flush())
        });
        if let Some(Err(error)) = sent {
            return Err(Failure::Gone(error.to_string()));
        }
        let start = Instant::now();
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let mut answer = self.answers.recv_timeout(left).map_err(|error| match error {
                RecvTimeoutError::Timeout => Failure::Silent(start.elapsed()),
                RecvTimeoutError::Disconnected => Failure::Gone("it ended".to_owned()),
            })?;
            // Others tell what happens in the browser.
            if answer["id"] == self.asked {
                return match answer["error"]["message"].as_str() {
                    Some(words) => Err(Failure::Gone(words.to_owned())),
                    None => Ok(answer["result"].take()),
                };
            }
        }
    }
}

impl Drop for Pipe {
    fn drop(&mut self) {
        // It has nothing to keep, and would take most of a second to end by itself. This fails where nobody is left.
        if let Some(group) = Pid::from_raw(self.child.id().cast_signed()) {
            let _ = kill_process_group(group, Signal::KILL);
        }
        let _ = self.child.wait();
        // The last of its processes may still be writing.
        if let Some(profile) = self.profile.take() {
            let path = profile.keep();
            let deadline = Instant::now() + GRACE;
            while fs::remove_dir_all(&path).is_err() && path.exists() && Instant::now() < deadline {
                thread::sleep(NAP);
            }
        }
    }
}

fn listen(output: ChildStdout, answers: &mpsc::Sender<Value>) {
    let mut output = BufReader::new(output);
    loop {
        let mut message = Vec::new();
        match output.read_until(0, &mut message) {
            Ok(1..) => message.truncate(message.len() - 1),
            _ => break,
        }
        let Ok(message) = serde_json::from_slice(&message) else {
            continue;
        };
        if answers.send(message).is_err() {
            break;
        }
    }
}
