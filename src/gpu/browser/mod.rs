//! Running a shader where people will see it: in Chromium, with WebGPU or WebGL 2, on `SwiftShader`, the software driver that it brings.
//!
//! The browser runs without a window and with a profile of its own, and is spoken to through a pipe: it listens on no port, and ends when its end of
//! the pipe is closed, however we end. Its functions are its own, and so are their last bits.

mod pipe;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use pipe::Pipe;
use serde_json::{Value, json};
use thiserror::Error;
use toyproof_image::{Frame, Image};

/// Why a browser painted nothing.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Failure {
    /// It refuses the shader, with these words.
    #[error("Chromium refuses it: {0}")]
    Refused(String),
    /// It did not answer in time.
    #[error("Chromium did not answer within {:.1} s", .0.as_secs_f64())]
    Silent(Duration),
    /// It could not be started or spoken to.
    #[error("cannot run Chromium: {0}")]
    Gone(String),
}

/// A shader's text, in a language that browsers run.
#[derive(Debug, Clone, Copy)]
pub enum Text<'a> {
    /// GLSL ES 3.00 for WebGL 2: with `ShaderToy`'s inputs as uniforms, or converted.
    Glsl(&'a str),
    /// WGSL for WebGPU, converted.
    Wgsl(&'a str),
}

/// A browser that is started when it is first needed, and anew after each that was given up.
#[derive(Debug)]
pub struct Chromium {
    program: PathBuf,
    timeout: Duration,
    live: Option<Pipe>,
}

/// How long a browser may take to start, beside what a shader may take.
const START: Duration = Duration::from_secs(60);
const PAGE: &str = include_str!("page.html");

/// Where the browser is, if it is installed.
#[must_use]
pub fn find() -> Option<PathBuf> {
    ["chromium", "chromium-browser", "google-chrome"]
        .iter()
        .flat_map(|name| {
            ["/usr/bin", "/usr/local/bin", "/snap/bin"].map(|folder| Path::new(folder).join(name))
        })
        .find(|path| path.exists())
}

/// A shader between what `ShaderToy` puts before and behind it.
#[must_use]
pub fn as_shadertoy(shader: &str) -> String {
    format!(
        "#version 300 es
#define HW_PERFORMANCE 1
precision highp float;
precision highp int;
precision highp sampler2D;
uniform vec3 iResolution;
uniform float iTime, iTimeDelta, iFrameRate, iSampleRate;
uniform int iFrame;
uniform float iChannelTime[4];
uniform vec3 iChannelResolution[4];
uniform vec4 iMouse, iDate;
uniform sampler2D iChannel0, iChannel1, iChannel2, iChannel3;
out vec4 shadertoy_out_color;
#line 1
{shader}
void main() {{
    vec4 color = vec4(0.0, 0.0, 0.0, 1.0);
    mainImage(color, gl_FragCoord.xy);
    shadertoy_out_color = vec4(color.xyz, 1.0);
}}
"
    )
}

impl Chromium {
    /// A browser that gives a shader so much time.
    #[must_use]
    pub fn new(program: PathBuf, timeout: Duration) -> Self {
        Self {
            program,
            timeout,
            live: None,
        }
    }

    /// What the shader paints in each frame; channels that hold a picture are flat.
    ///
    /// # Errors
    /// Why there are no pictures.
    pub fn paint(&mut self, text: Text, frames: &[Frame]) -> Result<Vec<Image>, Failure> {
        let (language, text) = match text {
            Text::Glsl(text) => ("glsl", text),
            Text::Wgsl(text) => ("wgsl", text),
        };
        let mut pipe = match self.live.take() {
            Some(pipe) => pipe,
            None => Pipe::open(&self.program, PAGE, Instant::now() + START)?,
        };
        let frames_told: Vec<Value> = frames.iter().map(told).collect();
        let job = json!({"language": language, "text": text, "frames": frames_told});
        let answer = pipe.call(&format!("toyproof({job})"), self.timeout)?;
        if let Some(words) = answer["refused"].as_str() {
            // One whose context is lost has nothing to paint with any more.
            if !words.contains("context lost") {
                self.live = Some(pipe);
            }
            return Err(Failure::Refused(
                words.lines().next().unwrap_or_default().to_owned(),
            ));
        }
        self.live = Some(pipe);
        let pictures = answer["pictures"].as_array().map_or(&[][..], Vec::as_slice);
        let images: Option<Vec<Image>> = frames.iter().zip(pictures).map(image).collect();
        images
            .filter(|images| images.len() == frames.len())
            .ok_or_else(|| Failure::Gone("it answers another question than was asked".to_owned()))
    }

    /// Its name and version, once it has painted.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.live.as_ref().map(Pipe::product)
    }
}

fn told(frame: &Frame) -> Value {
    let channels = frame.channels.iter().enumerate().filter_map(|(number, image)| {
        let image = image.as_ref()?;
        let [width, height] = image.size();
        let pixels = BASE64_STANDARD.encode(bytemuck::cast_slice::<_, u8>(image.pixels()));
        Some(json!({"number": number, "width": width, "height": height, "pixels": pixels}))
    });
    json!({
        "width": frame.size[0],
        "height": frame.size[1],
        "block": BASE64_STANDARD.encode(frame.block()),
        "channels": channels.collect::<Vec<_>>(),
    })
}

fn image((frame, picture): (&Frame, &Value)) -> Option<Image> {
    let [width, height] = frame.size;
    let bytes = BASE64_STANDARD.decode(picture.as_str()?).ok()?;
    let pixels: Vec<[f32; 4]> = bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect();
    (pixels.len() == width as usize * height as usize).then(|| Image::new(width, height, pixels))
}
