//! A headless Chromium that paints shaders with WebGL 2 or WebGPU, one after the other: a page of ours fetches them from a server of ours
//! and posts what they paint.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use serde_json::json;
use tempfile::TempDir;

const PAGE: &str = include_str!("page.html");
/// How long a browser may take for one shader, its own start included.
const PATIENCE: Duration = Duration::from_secs(90);

/// What a shader's frames hold: all pixels of the first, from the bottom, then those of the next.
pub(crate) type Pixels = Vec<[f32; 4]>;

/// Why a browser painted nothing.
#[derive(Debug)]
pub(crate) enum Failure {
    /// WebGL refuses the shader, with these words.
    Refused(String),
    /// It did not answer in time, or died.
    Silent,
}

/// A running browser.
#[derive(Debug)]
pub(crate) struct Chromium {
    program: PathBuf,
    port: u16,
    jobs: Sender<String>,
    answers: Receiver<Result<Pixels, Failure>>,
    live: Option<(Child, TempDir)>,
}

/// Where the browser is, if it is installed, and the manifest of its own software Vulkan driver.
pub(crate) fn find() -> Option<(PathBuf, PathBuf)> {
    let program = ["chromium", "chromium-browser", "google-chrome"]
        .iter()
        .flat_map(|name| {
            ["/usr/bin", "/usr/local/bin", "/snap/bin"].map(|folder| Path::new(folder).join(name))
        })
        .find(|path| path.exists())?;
    let manifest = [
        "/usr/lib/chromium",
        "/usr/lib/chromium-browser",
        "/usr/lib64/chromium-browser",
        "/opt/google/chrome",
    ]
    .iter()
    .map(|folder| Path::new(folder).join("vk_swiftshader_icd.json"))
    .find(|path| path.exists())?;
    Some((program, manifest))
}

impl Chromium {
    pub(crate) fn new(program: PathBuf) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port is free");
        let port = listener.local_addr().expect("it is bound").port();
        let (jobs, waiting) = mpsc::channel();
        let (answer, answers) = mpsc::channel();
        let waiting = Arc::new(Mutex::new(waiting));
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let (waiting, answer) = (Arc::clone(&waiting), answer.clone());
                thread::spawn(move || serve(stream, &waiting, &answer));
            }
        });
        Self {
            program,
            port,
            jobs,
            answers,
            live: None,
        }
    }

    /// Paints a fragment shader at each pair of `iTime` and `iFrame`.
    pub(crate) fn paint(
        &mut self,
        source: &str,
        size: [u32; 2],
        shots: &[(f32, i32)],
    ) -> Result<Pixels, Failure> {
        self.work("source", source, size, shots)
    }

    /// Paints a fragment shader in WGSL, with the bindings of converted shaders.
    pub(crate) fn paint_wgsl(
        &mut self,
        text: &str,
        size: [u32; 2],
        shots: &[(f32, i32)],
    ) -> Result<Pixels, Failure> {
        self.work("wgsl", text, size, shots)
    }

    fn work(
        &mut self,
        language: &str,
        text: &str,
        [width, height]: [u32; 2],
        shots: &[(f32, i32)],
    ) -> Result<Pixels, Failure> {
        if self.live.is_none() {
            self.start();
        }
        // What a browser that was given up on said too late.
        while self.answers.try_recv().is_ok() {}
        let job = json!({language: text, "width": width, "height": height, "shots": shots});
        self.jobs.send(job.to_string()).expect("the server lives");
        let answer = self
            .answers
            .recv_timeout(PATIENCE)
            .unwrap_or(Err(Failure::Silent));
        let lost = matches!(&answer, Err(Failure::Refused(words)) if words.contains("context lost"));
        if lost || matches!(answer, Err(Failure::Silent)) {
            self.end();
        }
        answer
    }

    fn start(&mut self) {
        let profile = tempfile::tempdir().expect("a folder can be had");
        let child = Command::new(&self.program)
            // Chromium's own sandbox does not run as root; the shaders are those that `toyproof` would run as well.
            .args([
                "--headless=new",
                "--no-sandbox",
                "--no-first-run",
                "--disable-extensions",
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
            .args(["--disable-background-networking", "--disable-component-update"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg(format!("http://127.0.0.1:{}/", self.port))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the browser starts");
        self.live = Some((child, profile));
    }

    fn end(&mut self) {
        if let Some((mut child, _profile)) = self.live.take() {
            // Its children end with it.
            let _ = child.kill();
            let _ = child.wait();
            // Its question may still be waiting: the answer is for nobody.
            self.jobs.send(String::new()).expect("the server lives");
        }
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        self.end();
    }
}

/// One request of the page's.
fn serve(
    mut stream: TcpStream,
    waiting: &Mutex<Receiver<String>>,
    answer: &Sender<Result<Pixels, Failure>>,
) -> Option<()> {
    let mut reader = BufReader::new(stream.try_clone().ok()?);
    let mut line = String::new();
    reader.read_line(&mut line).ok()?;
    let path = line.split_whitespace().nth(1)?.to_owned();
    let mut length = 0;
    loop {
        line.clear();
        reader.read_line(&mut line).ok()?;
        let header = line.trim().to_ascii_lowercase();
        if header.is_empty() {
            break;
        }
        if let Some(value) = header.strip_prefix("content-length:") {
            length = value.trim().parse().ok()?;
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).ok()?;
    let (kind, reply) = match path.as_str() {
        "/" => ("text/html", PAGE.to_owned()),
        // It waits until there is one.
        "/next" => ("application/json", waiting.lock().ok()?.recv().ok()?),
        "/pixels" => {
            let pixels = body.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect();
            answer.send(Ok(pixels)).ok()?;
            ("text/plain", String::new())
        }
        "/refused" => {
            let words = String::from_utf8_lossy(&body).into_owned();
            answer.send(Err(Failure::Refused(words))).ok()?;
            ("text/plain", String::new())
        }
        _ => ("text/plain", String::new()),
    };
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        reply.len()
    );
    stream.write_all(head.as_bytes()).ok()?;
    stream.write_all(reply.as_bytes()).ok()
}
