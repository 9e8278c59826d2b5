//! A headless Chromium with one open page, controlled over a pipe by the `DevTools` protocol.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::wait::{HANG_GUARD, wait_until};

/// One page of a browser.
#[derive(Debug)]
pub struct Page {
    browser: Child,
    orders: ChildStdin,
    told: Receiver<Value>,
    session: Option<String>,
    last: u64,
    /// The events so far.
    events: Vec<Value>,
    _profile: TempDir,
}

impl Page {
    /// Opens an empty page in a browser without a GPU.
    pub fn new(program: &Path) -> Self {
        Self::with(program, &["--disable-gpu"])
    }

    /// Opens an empty page in a browser with these switches.
    pub fn with(program: &Path, switches: &[&str]) -> Self {
        let profile = tempfile::tempdir().unwrap();
        let mut browser = Command::new("sh")
            // The protocol uses file descriptors 3 and 4.
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 0</dev/null 1>/dev/null"])
            .arg(program)
            // Chromium's sandbox does not run as root; the page is trusted.
            .args([
                "--headless=new",
                "--no-sandbox",
                "--no-first-run",
                "--disable-extensions",
            ])
            .args(["--disable-background-networking", "--disable-component-update"])
            .args(switches)
            .arg("--remote-debugging-pipe")
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let orders = browser.stdin.take().unwrap();
        let answers = BufReader::new(browser.stdout.take().unwrap());
        let (tell, told) = mpsc::channel();
        thread::spawn(move || {
            for message in answers.split(0).map_while(Result::ok) {
                let message = serde_json::from_slice(&message).expect("the protocol is JSON");
                if tell.send(message).is_err() {
                    break;
                }
            }
        });
        let mut page = Self {
            browser,
            orders,
            told,
            session: None,
            last: 0,
            events: Vec::new(),
            _profile: profile,
        };
        let target = page.call("Target.createTarget", &json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = page.call("Target.attachToTarget", &attach);
        page.session = session["sessionId"].as_str().map(str::to_owned);
        for domain in ["Runtime", "Log", "Network", "Page"] {
            page.call(&format!("{domain}.enable"), &json!({}));
        }
        page
    }

    /// Calls a method and waits for the reply.
    pub fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.try_call(method, parameters, HANG_GUARD)
            .unwrap_or_else(|error| panic!("{method}: {error}"))
    }

    /// Calls a method and waits for the reply until the time limit.
    fn try_call(&mut self, method: &str, parameters: &Value, timeout: Duration) -> Result<Value, String> {
        self.last += 1;
        let mut order = json!({ "id": self.last, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            order["sessionId"] = session.as_str().into();
        }
        let sent = write!(self.orders, "{order}\0").and_then(|()| self.orders.flush());
        sent.map_err(|error| error.to_string())?;
        let deadline = Instant::now() + timeout;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let message = self.told.recv_timeout(left).map_err(|error| match error {
                RecvTimeoutError::Timeout => format!("no reply within {:.1} s", timeout.as_secs_f64()),
                RecvTimeoutError::Disconnected => "the browser has exited".to_owned(),
            })?;
            if message["id"] == self.last {
                return match &message["error"] {
                    Value::Null => Ok(message["result"].clone()),
                    error => Err(error.to_string()),
                };
            }
            self.events.push(message);
        }
    }

    /// Opens a file and waits until it is loaded.
    pub fn open(&mut self, file: &Path) {
        self.open_url(&format!("file://{}", file.display()));
    }

    /// Opens an address and waits until its page is loaded.
    pub fn open_url(&mut self, url: &str) {
        self.events.clear();
        self.call("Page.navigate", &json!({ "url": url }));
        while !self
            .events
            .iter()
            .any(|event| event["method"] == "Page.loadEventFired")
        {
            let event = self.told.recv_timeout(HANG_GUARD).expect("the page loads");
            self.events.push(event);
        }
    }

    /// Evaluates a JavaScript expression, awaiting promises.
    pub fn value(&mut self, script: &str) -> Value {
        self.try_value(script, HANG_GUARD)
            .unwrap_or_else(|error| panic!("{script}: {error}"))
    }

    /// Evaluates a JavaScript expression, awaiting promises, until the time limit.
    ///
    /// # Errors
    /// The exception, or why the browser does not answer. It may still be busy then: start another one.
    pub fn try_value(&mut self, script: &str, timeout: Duration) -> Result<Value, String> {
        let asked = json!({ "expression": script, "awaitPromise": true, "returnByValue": true });
        let result = self.try_call("Runtime.evaluate", &asked, timeout)?;
        match &result["exceptionDetails"] {
            Value::Null => Ok(result["result"]["value"].clone()),
            exception => Err(exception["exception"]["description"]
                .as_str()
                .map_or_else(|| exception.to_string(), str::to_owned)),
        }
    }

    /// Waits until an expression is true, on the page that is shown then.
    pub fn until(&mut self, script: &str) {
        wait_until(|| match self.try_value(script, HANG_GUARD) {
            Ok(value) => value == true,
            // The page that was asked has been left.
            Err(error) if error.contains("Inspected target navigated") => false,
            Err(error) => panic!("{script}: {error}"),
        });
    }

    /// Presses and releases a key.
    pub fn press(&mut self, key: &str) {
        // Some keys need their code, or the text that they produce.
        let (number, text) = match key {
            "Tab" => (9, ""),
            "Enter" => (13, "\r"),
            _ => (0, ""),
        };
        for kind in ["keyDown", "keyUp"] {
            let press = json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": number, "text": text });
            self.call("Input.dispatchKeyEvent", &press);
        }
    }

    /// Sets the window's size in pixels, and the dark or light color scheme.
    pub fn window(&mut self, [width, height]: [u32; 2], dark: bool) {
        let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", &metrics);
        let scheme = if dark { "dark" } else { "light" };
        let feature = json!({ "name": "prefers-color-scheme", "value": scheme });
        self.call("Emulation.setEmulatedMedia", &json!({ "features": [feature] }));
    }

    /// The window as a PNG.
    pub fn screenshot(&mut self) -> Vec<u8> {
        let shot = self.call("Page.captureScreenshot", &json!({ "format": "png" }));
        STANDARD.decode(shot["data"].as_str().unwrap()).unwrap()
    }

    /// Takes the events with this name since the page was opened.
    pub fn events(&mut self, method: &str) -> Vec<Value> {
        // Pending events have arrived once this call returns.
        self.value("0");
        let events = self.events.iter().filter(|event| event["method"] == method);
        events.map(|event| event["params"].clone()).collect()
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // Its child processes end with it.
        let _ = self.browser.kill();
        let _ = self.browser.wait();
    }
}
