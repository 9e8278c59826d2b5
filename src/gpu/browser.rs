//! Runs shaders in Chromium, with WebGPU or WebGL 2 on `SwiftShader`, its bundled software driver.
//!
//! The browser runs headless with a temporary profile and is controlled through a pipe: it listens on no
//! port, and exits when its end of the pipe is closed, even if this process crashes. It has its own
//! implementation of the built-in functions, whose last bits differ.

mod played;

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};
use std::{fs, thread};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
pub use played::{
    BrowserPass, BrowserRead, THREE_VARIABLE, ThreeLibrary, ThreeModule, passes_job, uniform_values,
};
use serde_json::{Value, json};
use tempfile::TempDir;
use thiserror::Error;
use toyproof_glsl::tree::{Sampler, SamplerShape};
use toyproof_glsl::{Filter, Sampling, Wrap};
use toyproof_image::{Frame, Image, Input, InputType, Shape, Texels, Texture};

/// Why a browser rendered nothing.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum BrowserFailure {
    /// Chromium rejects the shader with this message.
    #[error("Chromium cannot render the shader: {0}")]
    Refused(String),
    /// The textures are larger than a message to Chromium may be.
    #[error(
        "the textures are too large for Chromium, which reads at most {} MiB, as text",
        MAX_CALL_BYTES >> 20
    )]
    TooLarge,
    /// A module needs three.js.
    #[error("three.js is not installed: run `npm install three`, or name its folder in {THREE_VARIABLE}")]
    NoThree,
    /// Chromium did not respond in time.
    #[error("Chromium did not answer within {:.1} s", .0.as_secs_f64())]
    Timeout(Duration),
    /// Chromium could not be started, or communication failed.
    #[error("cannot run Chromium: {0}")]
    Disconnected(String),
}

/// The text of a shader in a language that browsers support.
#[derive(Debug, Clone, Copy)]
pub enum Text<'a> {
    /// GLSL ES 3.00 for WebGL 2: with `ShaderToy`'s inputs as uniforms, or converted.
    Glsl(&'a str),
    /// WGSL for WebGPU, converted.
    Wgsl(&'a str),
}

/// A browser, started on first use and restarted after each failure.
#[derive(Debug)]
pub struct Chromium {
    program: PathBuf,
    timeout: Duration,
    live: Option<BrowserConnection>,
    three: Option<ThreeLibrary>,
}

/// Time limit for the start of the browser, in addition to that of a shader.
const START_TIMEOUT: Duration = Duration::from_secs(60);

/// Largest call: Chromium reads no messages above 100 MiB, and ends the connection.
const MAX_CALL_BYTES: usize = 96 << 20;

/// The script of a page that renders shaders. `toyproof(job)` renders frames; `openPasses` opens a player of
/// the passes of a [`passes_job`], which renders one frame after the other.
pub const SCRIPT: &str = include_str!("browser.js");

/// The page that renders shaders.
fn page_html() -> String {
    format!(
        "<!doctype html>\n<meta charset=\"utf-8\">\n<title>toyproof</title>\n<script>\n{SCRIPT}</script>\n"
    )
}

/// Finds an installed browser.
pub fn find() -> Option<PathBuf> {
    ["chromium", "chromium-browser", "google-chrome"]
        .iter()
        .flat_map(|name| {
            ["/usr/bin", "/usr/local/bin", "/snap/bin"].map(|folder| Path::new(folder).join(name))
        })
        .find(|path| path.exists())
}

/// Wraps a shader whose channels have these shapes in `ShaderToy`'s prologue and epilogue.
pub fn as_shadertoy(shader: &str, channels: [SamplerShape; 4]) -> String {
    as_shadertoy_pass(shader, channels, false)
}

/// Wraps a pass like [`as_shadertoy`]. Buffers keep their alpha.
pub fn as_shadertoy_pass(shader: &str, channels: [SamplerShape; 4], keeps_alpha: bool) -> String {
    let alpha = if keeps_alpha { "color.a" } else { "1.0" };
    let inputs = Input::ALL.map(|input| {
        let length = input.length().map(|length| format!("[{length}]"));
        let (ty, name) = (input.ty().name(), input.name());
        format!("uniform {ty} {name}{};\n", length.unwrap_or_default())
    });
    let inputs = inputs.concat();
    let channels = (0..).zip(channels).map(|(channel, shape)| {
        let sampler = Sampler::float(shape).name();
        format!(
            "uniform {sampler} iChannel{channel};
uniform struct {{ {sampler} sampler; vec3 size; float time; int loaded; }} iCh{channel};
"
        )
    });
    let channels = channels.collect::<String>();
    format!(
        "#version 300 es
#define HW_PERFORMANCE 1
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
precision highp samplerCube;
{inputs}{channels}out vec4 shadertoy_out_color;
#line 1
{shader}
void main() {{
    vec4 color = vec4(0.0, 0.0, 0.0, 1.0);
    mainImage(color, gl_FragCoord.xy);
    shadertoy_out_color = vec4(color.xyz, {alpha});
}}
"
    )
}

impl Chromium {
    /// Creates a browser with a time limit per shader.
    pub fn new(program: PathBuf, timeout: Duration) -> Self {
        Self {
            program,
            timeout,
            live: None,
            three: None,
        }
    }

    /// Renders the frames of a shader, which have textures of the same shapes. Channels without one are black
    /// images.
    ///
    /// # Errors
    /// Why there are no images.
    pub fn render(
        &mut self,
        text: Text,
        sampling: [Sampling; 4],
        frames: &[Frame],
    ) -> Result<Vec<Image>, BrowserFailure> {
        let (language, text) = match text {
            Text::Glsl(text) => ("glsl", text),
            Text::Wgsl(text) => ("wgsl", text),
        };
        let black = black();
        let mut textures = TextureTable::default();
        let frames_json = frames.iter().map(|frame| {
            let channels = frame.channels.each_ref();
            let number_of = |texture: Option<_>| textures.number_of(texture.unwrap_or(&black));
            frame_json(frame, channels.map(Option::as_ref).map(number_of))
        });
        let frames_json: Vec<Value> = frames_json.collect();
        let sampling = sampling.map(sampling_json);
        let inputs = Input::ALL.map(input_json);
        let job = json!({
            "language": language, "text": text, "inputs": inputs, "sampling": sampling,
            "textures": textures.json(), "frames": frames_json,
        });
        self.call_page(&job, &frames.iter().collect::<Vec<_>>())
    }

    /// Calls the page with a job, whose images are those of the frames.
    fn call_page(&mut self, job: &Value, frames: &[&Frame]) -> Result<Vec<Image>, BrowserFailure> {
        let mut connection = match self.live.take() {
            Some(connection) => connection,
            None => BrowserConnection::launch(&self.program, &page_html(), Instant::now() + START_TIMEOUT)?,
        };
        let call = format!("toyproof({job})");
        if call.len() > MAX_CALL_BYTES {
            self.live = Some(connection);
            return Err(BrowserFailure::TooLarge);
        }
        let answer = connection.call(&call, self.timeout)?;
        if let Some(reason) = answer["refused"].as_str() {
            // A browser that lost its context cannot render any more.
            if answer["contextLost"] == false {
                self.live = Some(connection);
            }
            return Err(BrowserFailure::Refused(
                reason.lines().next().unwrap_or_default().to_owned(),
            ));
        }
        self.live = Some(connection);
        let images_base64 = answer["images"].as_array().map_or(&[][..], Vec::as_slice);
        let images = frames.iter().zip(images_base64);
        let images: Option<Vec<Image>> = images
            .map(|(frame, image)| decode_image((*frame, image)))
            .collect();
        images
            .filter(|images| images.len() == frames.len())
            .ok_or_else(|| BrowserFailure::Disconnected("unexpected reply".to_owned()))
    }

    /// Returns the browser's name and version after it has rendered.
    pub fn name(&self) -> Option<&str> {
        self.live.as_ref().map(BrowserConnection::product)
    }
}

/// What a channel without a texture reads.
fn black() -> Texture {
    Texture::from(Image::new(1, 1, vec![[0.0, 0.0, 0.0, 1.0]]))
}

/// The textures of a job, which share what is the same, since they are large.
#[derive(Default)]
struct TextureTable<'a>(Vec<&'a Texture>);

impl<'a> TextureTable<'a> {
    fn number_of(&mut self, texture: &'a Texture) -> usize {
        let known = self.0.iter().position(|known| share_texels(known, texture));
        known.unwrap_or_else(|| {
            self.0.push(texture);
            self.0.len() - 1
        })
    }

    fn json(&self) -> Vec<Value> {
        self.0.iter().map(|texture| texture_json(texture)).collect()
    }
}

fn input_json(input: Input) -> Value {
    json!({
        "name": input.name(),
        "isInteger": input.ty() == InputType::Int,
        "components": input.ty().components(),
        "length": input.length().unwrap_or(1),
        "word": input.offset() / 4,
    })
}

fn sampling_json(Sampling { filter, wrap }: Sampling) -> Value {
    let filter = match filter {
        Filter::Nearest => "nearest",
        Filter::Linear => "linear",
        Filter::Mipmap => "mipmap",
    };
    json!({"filter": filter, "repeats": wrap == Wrap::Repeat})
}

/// A frame with the numbers of its channels' textures.
fn frame_json(frame: &Frame, channels: [usize; 4]) -> Value {
    json!({
        "width": frame.size[0],
        "height": frame.size[1],
        "block": BASE64_STANDARD.encode(frame.block()),
        "channels": channels,
    })
}

/// Whether two textures are copies that share their texels.
fn share_texels(a: &Texture, b: &Texture) -> bool {
    match (a.texels(), b.texels()) {
        (Texels::Single(a), Texels::Single(b)) => Arc::ptr_eq(&a[0], &b[0]) && a.len() == b.len(),
        (Texels::Double(a), Texels::Double(b)) => Arc::ptr_eq(&a[0], &b[0]) && a.len() == b.len(),
        _ => false,
    }
}

/// The levels of a texture, each with its stacked layers.
fn texture_json(texture: &Texture) -> Value {
    let shape = match texture.shape() {
        Shape::Flat => "flat",
        Shape::Cube => "cube",
        Shape::Volume => "volume",
    };
    let stacks = texture.stacks();
    let levels = (0..).zip(&stacks).map(|(level, stack)| {
        let [width, rows] = stack.size();
        let layers = match texture.shape() {
            Shape::Volume => (texture.layers() >> level).max(1),
            Shape::Flat | Shape::Cube => texture.layers(),
        };
        let pixels = BASE64_STANDARD.encode(bytemuck::cast_slice::<_, u8>(stack.pixels()));
        json!({"width": width, "height": rows / layers, "layers": layers, "pixels": pixels})
    });
    json!({"shape": shape, "levels": levels.collect::<Vec<_>>()})
}

fn decode_image((frame, image_base64): (&Frame, &Value)) -> Option<Image> {
    let [width, height] = frame.size;
    let bytes = BASE64_STANDARD.decode(image_base64.as_str()?).ok()?;
    let pixels: Vec<[f32; 4]> = bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect();
    (pixels.len() == width as usize * height as usize).then(|| Image::new(width, height, pixels))
}

// The browser process, and the Chrome `DevTools` protocol over its pipe: JSON messages, each terminated by a
// zero byte.

/// A browser process with our page open.
#[derive(Debug)]
struct BrowserConnection {
    child: Child,
    requests: mpsc::Sender<Vec<u8>>,
    messages: Receiver<Value>,
    profile: Option<TempDir>,
    /// Id of the last request.
    last_id: u64,
    session: Option<String>,
    product: String,
}

/// Chromium communicates on file descriptors 3 and 4, which this shell script redirects.
const LAUNCH_SCRIPT: &str = r#"exec "$0" "$@" 3<&0 4>&1 </dev/null >/dev/null 2>/dev/null"#;

/// Time limit for removing the profile of a browser that has exited.
const PROFILE_REMOVAL_TIMEOUT: Duration = Duration::from_secs(3);

/// The time between two checks of something that is waited for.
const POLL_INTERVAL: Duration = Duration::from_millis(10);

impl BrowserConnection {
    /// Starts the browser and opens the page.
    fn launch(program: &Path, page: &str, deadline: Instant) -> Result<Self, BrowserFailure> {
        let launch_error = |error: std::io::Error| BrowserFailure::Disconnected(error.to_string());
        let profile = tempfile::Builder::new()
            .prefix("toyproof-browser-")
            .tempdir()
            .map_err(launch_error)?;
        // File URLs may use WebGPU; blank pages may not.
        let file = profile.path().join("page.html");
        fs::write(&file, page).map_err(launch_error)?;
        let url = format!("file://{}", file.to_string_lossy());
        let mut command = Command::new("sh");
        command
            .args(["-c", LAUNCH_SCRIPT])
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
        #[cfg(unix)]
        if rustix::process::geteuid().is_root() {
            // Chromium's sandbox does not work as root; the same shaders run on this machine anyway.
            command.arg("--no-sandbox");
        }
        // Shield it from the terminal's interrupt, and allow killing it with all its children.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command
            .arg(&url)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(launch_error)?;
        let (requests, unsent) = mpsc::channel();
        if let Some(input) = child.stdin.take() {
            thread::spawn(move || write_messages(input, &unsent));
        }
        let (sender, messages) = mpsc::channel();
        if let Some(output) = child.stdout.take() {
            thread::spawn(move || read_messages(output, &sender));
        }
        let mut connection = Self {
            child,
            requests,
            messages,
            profile: Some(profile),
            last_id: 0,
            session: None,
            product: String::new(),
        };
        connection.attach(&url, deadline)?;
        Ok(connection)
    }

    /// Returns the browser's name and version.
    fn product(&self) -> &str {
        &self.product
    }

    /// Evaluates an expression in the page, and awaits it if it is a promise.
    fn call(&mut self, expression: &str, timeout: Duration) -> Result<Value, BrowserFailure> {
        let deadline = Instant::now() + timeout;
        let parameters = json!({"expression": expression, "awaitPromise": true, "returnByValue": true});
        let answer = self.request("Runtime.evaluate", &parameters, deadline);
        let mut answer = answer.map_err(|failure| match failure {
            BrowserFailure::Timeout(_) => BrowserFailure::Timeout(timeout),
            other => other,
        })?;
        Ok(answer["result"]["value"].take())
    }

    /// Waits for the page to load and attaches to it.
    fn attach(&mut self, url: &str, deadline: Instant) -> Result<(), BrowserFailure> {
        let version = self.request("Browser.getVersion", &json!({}), deadline)?;
        version["product"]
            .as_str()
            .unwrap_or("Chromium")
            .clone_into(&mut self.product);
        let page = loop {
            let targets = self.request("Target.getTargets", &json!({}), deadline)?;
            let pages = targets["targetInfos"].as_array().map_or(&[][..], Vec::as_slice);
            let ours = pages.iter().find(|page| page["url"] == url);
            if let Some(page) = ours {
                break page["targetId"].clone();
            }
            thread::sleep(POLL_INTERVAL);
        };
        let parameters = json!({"targetId": page, "flatten": true});
        let session = self.request("Target.attachToTarget", &parameters, deadline)?;
        self.session = session["sessionId"].as_str().map(str::to_owned);
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if self.call("typeof toyproof === 'function'", left)? == true {
                return Ok(());
            }
            thread::sleep(POLL_INTERVAL);
        }
    }

    /// Sends a request and returns the result of its response.
    fn request(
        &mut self,
        method: &str,
        parameters: &Value,
        deadline: Instant,
    ) -> Result<Value, BrowserFailure> {
        self.last_id += 1;
        let mut message = json!({"id": self.last_id, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        // If the browser has exited, so has the sender of its messages.
        let _ = self
            .requests
            .send([message.to_string().as_bytes(), &[0]].concat());
        let start = Instant::now();
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let mut answer = self.messages.recv_timeout(left).map_err(|error| match error {
                RecvTimeoutError::Timeout => BrowserFailure::Timeout(start.elapsed()),
                RecvTimeoutError::Disconnected => {
                    BrowserFailure::Disconnected("the browser exited".to_owned())
                }
            })?;
            // Other messages are events.
            if answer["id"] == self.last_id {
                return match answer["error"]["message"].as_str() {
                    Some(reason) => Err(BrowserFailure::Disconnected(reason.to_owned())),
                    None => Ok(answer["result"].take()),
                };
            }
        }
    }
}

impl Drop for BrowserConnection {
    fn drop(&mut self) {
        // There is no state to save, and a regular exit would take most of a second. Fails if the process has
        // exited.
        #[cfg(unix)]
        if let Some(group) = rustix::process::Pid::from_raw(self.child.id().cast_signed()) {
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        let _ = self.child.wait();
        // The last child processes may still be writing.
        if let Some(profile) = self.profile.take() {
            let path = profile.keep();
            let deadline = Instant::now() + PROFILE_REMOVAL_TIMEOUT;
            while fs::remove_dir_all(&path).is_err() && path.exists() && Instant::now() < deadline {
                thread::sleep(POLL_INTERVAL);
            }
        }
    }
}

/// Writes requests until the browser exits. A browser that reads no more blocks this thread only.
fn write_messages(mut input: ChildStdin, requests: &Receiver<Vec<u8>>) {
    for request in requests {
        if input.write_all(&request).and_then(|()| input.flush()).is_err() {
            break;
        }
    }
}

fn read_messages(output: ChildStdout, messages: &mpsc::Sender<Value>) {
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
        if messages.send(message).is_err() {
            break;
        }
    }
}
