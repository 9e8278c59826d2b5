//! Compares our GLSL front end for naga with naga's own: which shaders each accepts, whether the module of
//! naga's computes the same image, panics, and time.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use toyproof::diagnostic::{Deadline, File, Files};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::tree::SamplerShape;
use toyproof::glsl::{Checked, Options, check};
use toyproof::image::{Frame, Image, Texture, noise};
use toyproof::translate::backend::roundtrip;
use toyproof::translate::naga::front::glsl::{Frontend, Options as Stage};
use toyproof::translate::naga::{Module, ShaderStage};
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::{ModuleOptions, glsl_to_module};

use crate::projects;

/// The time limit of an image.
const TIMEOUT: Duration = Duration::from_secs(20);

/// A component differs if it does by more, as displayed: two grey levels of 255.
const TOLERANCE: f64 = 2.0 / 255.0;

/// An image is wrong if more than this share of its pixels differs: the last bits of naga's folded constants
/// move single pixels at edges.
const WRONG_SHARE: f64 = 0.01;

/// A block and texture bindings like ours, so that [`roundtrip::shadertoy`] knows the inputs.
fn wrapped(text: &str, checked: &Checked) -> String {
    let mut wrapped = "#version 450\nlayout(location = 0) out vec4 wrapped_color;\n\
        layout(std140, set = 0, binding = 0) uniform WrappedInputs {\n\
        vec3 iResolution; float iTime; float iTimeDelta; int iFrame; float iFrameRate; vec4 wrapped_times[4];\n\
        vec3 iChannelResolution[4]; vec4 iMouse; vec4 iDate; float iSampleRate;\n};\n\
        #define iChannelTime float[4](wrapped_times[0].x, wrapped_times[1].x, wrapped_times[2].x, wrapped_times[3].x)\n"
        .to_owned();
    for (channel, shape) in checked.channels.iter().enumerate() {
        let shape = match shape {
            SamplerShape::D2 => "2D",
            SamplerShape::D3 => "3D",
            SamplerShape::Cube => "Cube",
            SamplerShape::D2Array => "2DArray",
        };
        let _ = writeln!(
            wrapped,
            "layout(set = 0, binding = {}) uniform texture{shape} wrapped_t{channel};\n\
             layout(set = 0, binding = {}) uniform sampler wrapped_s{channel};\n\
             #define iChannel{channel} sampler{shape}(wrapped_t{channel}, wrapped_s{channel})",
            1 + 2 * channel,
            2 + 2 * channel,
        );
    }
    wrapped
        + text
        + "\nvoid main() {\n    vec4 wrapped_image = vec4(0.0, 0.0, 0.0, 1.0);\n    \
        mainImage(wrapped_image, gl_FragCoord.xy);\n    wrapped_color = vec4(wrapped_image.xyz, 1.0);\n}\n"
}

/// The shader as naga's front end can be given it: wrapped, or, with its own `main`, as desktop GLSL: a block
/// in place of its uniforms, and current names in place of old ones.
fn for_naga(text: &str, checked: &Checked) -> String {
    if checked.dialect.calls_main_image() {
        return wrapped(text, checked);
    }
    let mut modern = "#version 450\nlayout(location = 0) out vec4 wrapped_color;\n\
        #define gl_FragColor wrapped_color\n#define varying in\n#define texture2D texture\n\
        layout(std140, set = 0, binding = 0) uniform WrappedInputs {\n"
        .to_owned();
    let is_uniform = |line: &&str| line.trim_start().starts_with("uniform ") && !line.contains("sampler");
    for line in text.lines().filter(is_uniform) {
        let _ = writeln!(modern, "{}", line.trim_start().trim_start_matches("uniform "));
    }
    modern += "};\n";
    for (at, line) in text
        .lines()
        .filter(|line| line.contains("uniform sampler2D"))
        .enumerate()
    {
        let name = line
            .trim_end()
            .trim_end_matches(';')
            .rsplit(' ')
            .next()
            .unwrap_or_default();
        let _ = writeln!(
            modern,
            "layout(set = 0, binding = {}) uniform texture2D wrapped_t{at};\n\
             layout(set = 0, binding = {}) uniform sampler wrapped_s{at};\n\
             #define {name} sampler2D(wrapped_t{at}, wrapped_s{at})",
            1 + 2 * at,
            2 + 2 * at,
        );
    }
    let kept = text.lines().filter(|line| {
        let line = line.trim_start();
        !["#version", "precision ", "uniform ", "out vec4"]
            .iter()
            .any(|start| line.starts_with(start))
    });
    kept.fold(modern, |modern, line| modern + line + "\n")
}

/// Whether glslang accepts a shader as ShaderToy wraps it; other shaders are ours, and valid.
fn is_valid(text: &str, checked: Option<&Checked>) -> bool {
    if checked.is_some_and(|checked| !checked.dialect.calls_main_image()) {
        return true;
    }
    let shapes = checked.map_or([SamplerShape::D2; 4], |checked| checked.channels);
    let mut whole = "#version 300 es\nprecision highp float;\nprecision highp int;\nout vec4 wrapped_color;\n\
        precision highp sampler3D;\nuniform vec3 iResolution, iChannelResolution[4];\nuniform vec4 iMouse, iDate;\n\
        uniform float iTime, iTimeDelta, iFrameRate, iSampleRate, iChannelTime[4];\nuniform int iFrame;\n"
        .to_owned();
    for (channel, shape) in shapes.iter().enumerate() {
        let shape = match shape {
            SamplerShape::D3 => "3D",
            SamplerShape::Cube => "Cube",
            _ => "2D",
        };
        let _ = writeln!(whole, "uniform sampler{shape} iChannel{channel};");
    }
    whole += text;
    whole += "\nvoid main() { mainImage(wrapped_color, gl_FragCoord.xy); }\n";
    let glslang = Command::new("glslangValidator")
        .args(["--stdin", "-S", "frag"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn();
    let mut glslang = glslang.expect("glslangValidator is installed");
    let mut input = glslang.stdin.take().expect("it is piped");
    input.write_all(whole.as_bytes()).expect("glslang reads");
    drop(input);
    glslang.wait().expect("glslang ends").success()
}

fn naga_parse(text: &str) -> Result<Module, String> {
    let options = Stage::from(ShaderStage::Fragment);
    Frontend::default()
        .parse(&options, text)
        .map_err(|error| error.to_string())
}

/// Calls a function that may panic.
fn caught<T>(call: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|_| Err("panic".to_owned()))
}

/// Whether a module computes another image than the shader, in float32: it is written as GLSL by
/// naga, and evaluated. `None` if it cannot be.
fn is_wrong(module: Module, images: &[Option<Image>; 2]) -> Option<bool> {
    let text = caught(|| {
        let valid = ValidModule::new(module).map_err(|error| error.to_string())?;
        roundtrip::shadertoy(&valid).map_err(|error| error.to_string())
    });
    let (_, checked) = checked("round trip", &text.ok()?)?;
    let again = images_of(&checked);
    let mut wrong = false;
    for (image, again) in images.iter().zip(&again) {
        let (image, again) = (image.as_ref()?, again.as_ref()?);
        let shown = |component: f32| f64::from(component.clamp(0.0, 1.0));
        let agrees = |a: f32, b: f32| (shown(a) - shown(b)).abs() <= TOLERANCE || (a.is_nan() && b.is_nan());
        let differs = |(a, b): &(&[f32; 4], &[f32; 4])| !(0..3).all(|at| agrees(a[at], b[at]));
        let differing = image.pixels().iter().zip(again.pixels()).filter(differs).count();
        wrong |= differing as f64 > WRONG_SHARE * image.pixels().len() as f64;
    }
    Some(wrong)
}

/// The images at two times, of 64×36 pixels; `None` where the shader cannot be evaluated in time.
fn images_of(checked: &Checked) -> [Option<Image>; 2] {
    [0.7, 10.3].map(|time: f32| {
        let frame = Frame {
            size: [64, 36],
            channels: std::array::from_fn(|_| Some(Texture::from(noise()))),
            ..Frame::default()
        };
        let settings = Settings::<f32> {
            deadline: Some(Instant::now() + TIMEOUT),
            ..Settings::default()
        };
        let frame = frame.at((time * 60.0) as i32, time);
        let rendered = Program::new(checked).ok()?.render(&frame, &settings).ok()?;
        Some(rendered.framebuffer.image())
    })
}

fn checked(name: &str, text: &str) -> Option<(Files, Checked)> {
    let mut files = Files::default();
    let file = files.add(File::new(name, text));
    let options = Options {
        deadline: Deadline::after(TIMEOUT),
        ..Options::default()
    };
    check(&files, file, &options).ok().map(|checked| (files, checked))
}

/// The least of three times of a call, in milliseconds.
fn milliseconds(mut call: impl FnMut()) -> f64 {
    let times = (0..3).map(|_| {
        let start = Instant::now();
        call();
        1e3 * start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

/// What a front end did with a set of shaders.
#[derive(Default)]
struct Side {
    accepted: usize,
    panics: usize,
    compared: usize,
    wrong: Vec<String>,
    /// Of the shaders that both accept, in milliseconds.
    times: Vec<f64>,
}

impl Side {
    fn add(
        &mut self,
        name: &str,
        module: Result<Module, String>,
        images: Option<&[Option<Image>; 2]>,
    ) -> bool {
        let valid =
            module.and_then(|module| caught(|| ValidModule::new(module).map_err(|error| error.to_string())));
        let module = match valid {
            Ok(valid) => valid.into_module(),
            Err(error) => {
                println!("{name}: {error}");
                self.panics += usize::from(error == "panic");
                return false;
            }
        };
        self.accepted += 1;
        if let Some(is_wrong) = images.and_then(|images| is_wrong(module, images)) {
            self.compared += 1;
            self.wrong.extend(is_wrong.then(|| name.to_owned()));
        }
        true
    }

    fn print(&mut self, name: &str) {
        self.times.sort_by(f64::total_cmp);
        let median = self.times.get(self.times.len() / 2).unwrap_or(&f64::NAN);
        let (accepted, panics, compared, wrong) =
            (self.accepted, self.panics, self.compared, self.wrong.len());
        println!("| {name} | {accepted} | {panics} | {wrong} of {compared} | {median:.2} ms |");
        println!("wrong: {}", self.wrong.join(" "));
    }
}

/// Compares the front ends on the shaders of a folder, or on single-pass shaders of a git repository with the
/// site's JSON: a random choice.
pub(super) fn compare(input: &Path, limit: usize, seed: u64) {
    std::panic::set_hook(Box::new(|_| {}));
    let shaders = if input.join("HEAD").is_file() {
        of_repository(input, limit, seed)
    } else {
        of_folder(input)
    };
    let (mut naga, mut ours) = (Side::default(), Side::default());
    let (mut valid, mut ratios) = (0, Vec::new());
    for (name, text) in &shaders {
        let checked = checked(name, text);
        let checked = checked.as_ref().map(|(_, checked)| checked);
        if !is_valid(text, checked) {
            continue;
        }
        valid += 1;
        let Some(checked) = checked else {
            println!("{name}: refused by our front end");
            continue;
        };
        let given = for_naga(text, checked);
        let options = ModuleOptions {
            validate: false,
            ..ModuleOptions::default()
        };
        let images = images_of(checked);
        let comparable = checked.dialect.calls_main_image().then_some(&images);
        let by_naga = naga.add(name, caught(|| naga_parse(&given)), comparable);
        let by_us = caught(|| glsl_to_module(text, &options).map_err(|error| error.to_string()));
        if ours.add(name, by_us, Some(&images)) && by_naga {
            let [a, b] = [
                milliseconds(|| drop(naga_parse(&given))),
                milliseconds(|| drop(glsl_to_module(text, &options))),
            ];
            naga.times.push(a);
            ours.times.push(b);
            ratios.push(b / a);
        }
    }
    ratios.sort_by(f64::total_cmp);
    println!(
        "{} shaders, {valid} valid; median ratio of times {:.2}",
        shaders.len(),
        ratios.get(ratios.len() / 2).unwrap_or(&f64::NAN)
    );
    println!("| front end | accepted | panics | wrong | median |\n|---|---|---|---|---|");
    naga.print("naga");
    ours.print("ours");
}

/// The shaders of a folder, with their names.
pub(super) fn of_folder(folder: &Path) -> Vec<(String, String)> {
    let entries = fs::read_dir(folder).expect("the folder is readable");
    let paths = entries.map(|entry| entry.expect("it is readable").path());
    let mut paths: Vec<_> = paths
        .filter(|path| {
            path.extension()
                .is_some_and(|ending| ending == "glsl" || ending == "frag")
        })
        .collect();
    paths.sort();
    let read = |path: &std::path::PathBuf| {
        (
            path.to_string_lossy().into_owned(),
            fs::read_to_string(path).expect("it is text"),
        )
    };
    paths.iter().map(read).collect()
}

/// Single-pass shaders of a repository.
fn of_repository(repository: &Path, limit: usize, seed: u64) -> Vec<(String, String)> {
    let code = |text: &str| {
        let json: Value = serde_json::from_str(text).ok()?;
        let shader = json.get("Shader").unwrap_or(&json);
        match shader["renderpass"].as_array()?.as_slice() {
            [pass] if pass["type"] == "image" => Some(pass["code"].as_str()?.to_owned()),
            _ => None,
        }
    };
    let texts = projects::texts(repository, seed);
    texts
        .filter_map(|(name, text)| Some((name, code(&text)?)))
        .take(limit)
        .collect()
}
