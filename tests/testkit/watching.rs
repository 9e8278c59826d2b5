//! `toyproof watch`, and a client of its page in place of a browser.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;

use serde_json::{Value, json};

use crate::wait::HANG_GUARD;

/// A running `toyproof watch`, which is killed with this value.
#[derive(Debug)]
pub struct Watch {
    program: Child,
    output: BufReader<ChildStdout>,
    /// The host and the port.
    host: String,
    /// The path of the page: the token between slashes.
    path: String,
}

/// An answer to a request.
#[derive(Debug)]
pub struct Answer {
    /// The status code of HTTP.
    pub status: u16,
    /// The head, with its headers.
    pub head: String,
    /// The body.
    pub body: Vec<u8>,
}

/// An image, the top row first, in RGBA.
#[derive(Debug, Clone, PartialEq)]
pub struct Pixels {
    /// What the server says of the image.
    pub head: Value,
    /// The pixels.
    pub bytes: Vec<u8>,
}

impl Watch {
    /// Starts `toyproof watch` in a folder, and waits until it listens.
    pub fn start(program: &Path, folder: &Path, arguments: &[&str]) -> Self {
        Self::start_with(program, folder, arguments, &[])
    }

    /// Starts it with environment variables that are paths.
    pub fn start_with(
        program: &Path,
        folder: &Path,
        arguments: &[&str],
        variables: &[(&str, &Path)],
    ) -> Self {
        let mut program = Command::new(program)
            .arg("watch")
            .args(arguments)
            .envs(variables.iter().copied())
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut output = BufReader::new(program.stdout.take().unwrap());
        let mut url = String::new();
        output.read_line(&mut url).unwrap();
        let (host, token) = url
            .trim_end()
            .strip_prefix("http://")
            .and_then(|rest| rest.split_once('/'))
            .unwrap_or_else(|| panic!("no address: {url:?}"));
        Self {
            host: host.to_owned(),
            path: format!("/{token}"),
            program,
            output,
        }
    }

    /// The address of the page.
    pub fn url(&self) -> String {
        format!("http://{}{}", self.host, self.path)
    }

    /// The host and the port.
    pub fn host(&self) -> &str {
        &self.host
    }

    /// The path of the page.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Interrupts the program, as Ctrl-C does.
    #[cfg(unix)]
    pub fn interrupt(&self) {
        let id = rustix::process::Pid::from_child(&self.program);
        // It may have ended.
        let _ = rustix::process::kill_process(id, rustix::process::Signal::INT);
    }

    /// Waits until the program ends; returns its status, and what it printed after the address.
    pub fn wait(mut self) -> (ExitStatus, String) {
        let mut rest = String::new();
        self.output.read_to_string(&mut rest).unwrap();
        (self.program.wait().unwrap(), rest)
    }

    /// Sends bytes to the server as they are, and returns its answer.
    pub fn send(&self, bytes: &[u8]) -> Answer {
        let mut connection = TcpStream::connect(&self.host).unwrap();
        connection.set_read_timeout(Some(HANG_GUARD)).unwrap();
        // The server may answer and close before it has read everything.
        let _ = connection.write_all(bytes);
        let mut answer = Vec::new();
        let _ = connection.read_to_end(&mut answer);
        let end = answer.windows(4).position(|part| part == b"\r\n\r\n");
        let end = end.unwrap_or_else(|| panic!("{:?}", String::from_utf8_lossy(&answer)));
        let head = String::from_utf8_lossy(&answer[..end]).into_owned();
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok());
        Answer {
            status: status.unwrap(),
            body: answer[end + 4..].to_vec(),
            head,
        }
    }

    /// Gets a path below that of the page.
    pub fn get(&self, path: &str) -> Answer {
        self.send(format!("GET {}{path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.path, self.host).as_bytes())
    }

    /// Posts JSON to a path below that of the page.
    pub fn post(&self, path: &str, body: &Value) -> Answer {
        let body = body.to_string();
        let (own, host, length) = (&self.path, &self.host, body.len());
        let head = format!("POST {own}{path} HTTP/1.1\r\nHost: {host}\r\nContent-Length: {length}\r\n\r\n");
        self.send(format!("{head}{body}").as_bytes())
    }

    /// The image of a view.
    ///
    /// # Errors
    /// The answer without one.
    pub fn image(&self, path: &str, view: &Value) -> Result<Pixels, Answer> {
        let answer = self.post(path, view);
        if answer.status != 200 {
            return Err(answer);
        }
        let end = answer.body.iter().position(|&byte| byte == b'\n').unwrap();
        Ok(Pixels {
            head: serde_json::from_slice(&answer.body[..end]).unwrap(),
            bytes: answer.body[end + 1..].to_vec(),
        })
    }

    /// Opens a tab.
    pub fn open_tab(&self) -> Tab {
        let mut connection = TcpStream::connect(&self.host).unwrap();
        let (path, host) = (&self.path, &self.host);
        write!(connection, "GET {path}events HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let (sender, events) = mpsc::channel();
        thread::spawn(move || {
            let mut name = String::new();
            for line in BufReader::new(connection).lines().map_while(Result::ok) {
                if let Some(event) = line.strip_prefix("event: ") {
                    event.clone_into(&mut name);
                } else if let Some(data) = line.strip_prefix("data: ") {
                    let data: Value = serde_json::from_str(data).expect("events are JSON");
                    if sender.send((name.clone(), data)).is_err() {
                        break;
                    }
                }
            }
        });
        let (name, number) = events.recv_timeout(HANG_GUARD).expect("a tab has a number");
        assert_eq!(name, "tab");
        Tab {
            number: number.as_u64().unwrap(),
            events,
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        // A check in progress ends with the program, unless that is killed.
        #[cfg(unix)]
        self.interrupt();
        #[cfg(not(unix))]
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// A tab: its number, and the events for it.
#[derive(Debug)]
pub struct Tab {
    number: u64,
    events: Receiver<(String, Value)>,
}

impl Tab {
    /// Waits for the next event with this name, and drops those before it.
    pub fn next(&self, name: &str) -> Value {
        loop {
            let (event, data) = self.events.recv_timeout(HANG_GUARD).expect("the event comes");
            if event == name {
                return data;
            }
        }
    }

    /// The number of events with this name that have come and were not read.
    pub fn waiting(&self, name: &str) -> usize {
        self.events.try_iter().filter(|(event, _)| event == name).count()
    }

    /// A view of this tab, of the image at the time 0.
    pub fn view(&self, size: [u32; 2]) -> Value {
        json!({
            "tab": self.number, "size": size, "time": 0, "frame": 0, "mouse": [0, 0, 0, 0], "pass": "image",
        })
    }
}
