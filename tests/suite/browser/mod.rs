//! Chromium's WebGL 2 paints what we paint: the author's text through ANGLE and ours through naga, both on `SwiftShader`, the
//! software driver that Chromium brings, with its own transcendental functions and without `NoContraction`.
//!
//! By itself the course is compared. `TOYPROOF_SHADERS` names a folder of other shaders, of which `TOYPROOF_COUNT` (500) are drawn by
//! `TOYPROOF_SEED` (0) among those that read no channel; a line for each goes to standard error.

pub(crate) mod chromium;

use std::ffi::OsStr;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{env, fs};

use chromium::{Chromium, Failure, Pixels};
use toyproof::frame::Frame;
use toyproof::glsl::wgsl::{Style, wgsl};
use toyproof::glsl::{Options, check, lower};
use toyproof::gpu::{FloatMode, On, Worker};
use toyproof::source::{File, Files};

use crate::support::{RUNGS, setting};

const SIZE: [u32; 2] = [64, 36];
/// `iTime` and `iFrame`.
const SHOTS: [(f32, i32); 2] = [(1.0, 60), (7.3, 438)];

/// A shader between what ShaderToy puts before and behind it.
fn wrapped(shader: &str) -> String {
    format!(
        "#version 300 es
#define HW_PERFORMANCE 1
precision highp float;
precision highp int;
uniform vec3 iResolution;
uniform float iTime, iTimeDelta, iFrameRate, iSampleRate;
uniform int iFrame;
uniform float iChannelTime[4];
uniform vec3 iChannelResolution[4];
uniform vec4 iMouse, iDate;
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

/// A shader's WGSL, in our own words.
fn converted(shader: &str) -> Result<String, String> {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default())
        .map_err(|errors| toyproof::diagnostic::short(&errors[0], &files))?;
    wgsl(&checked, &files, Style::Plain).map_err(|why| why.to_string())
}

/// The author's shader with WebGL 2 beside its conversion with WebGPU.
fn judge_conversion(browser: &mut Chromium, shader: &str) -> (Outcome, String) {
    let told = |failure: Failure| match failure {
        Failure::Refused(words) => words,
        Failure::Silent => "the browser is silent".to_owned(),
    };
    let text = match converted(shader) {
        Ok(text) => text,
        Err(why) => return (Outcome::Unpainted, format!("not converted: {why}")),
    };
    let original = browser.paint(&wrapped(shader), SIZE, &SHOTS);
    let conversion = browser.paint_wgsl(&text, SIZE, &SHOTS);
    match (original, conversion) {
        (Ok(original), Ok(conversion)) => compare(&conversion, &original),
        (Err(failure), _) => (Outcome::Unpainted, format!("WebGL 2: {}", told(failure))),
        (_, Err(failure)) => (Outcome::Unpainted, format!("WebGPU: {}", told(failure))),
    }
}

/// What came of one shader.
#[derive(Debug, PartialEq, Eq)]
enum Outcome {
    /// Every float has the same bits.
    Equal,
    /// As shown, no colour differs by more than 1/255.
    Close,
    /// Some colours differ by more.
    Differ,
    /// One of both did not paint.
    Unpainted,
}

fn ours(worker: &mut Worker, shader: &str) -> Result<Pixels, String> {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default())
        .map_err(|errors| toyproof::diagnostic::short(&errors[0], &files))?;
    let lowered = lower(&checked);
    let mut pixels = Vec::new();
    for (time, number) in SHOTS {
        let frame = Frame {
            size: SIZE,
            time,
            frame: number,
            ..Frame::default()
        };
        let drawn = worker
            .draw(lowered.clone(), frame, FloatMode::Fast)
            .map_err(|failure| failure.to_string())?;
        pixels.extend_from_slice(drawn.image().pixels());
    }
    Ok(pixels)
}

fn compare(ours: &Pixels, theirs: &Pixels) -> (Outcome, String) {
    let same = |a: f32, b: f32| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    let shown = |value: f32| value.clamp(0.0, 1.0);
    let close = |a: f32, b: f32| same(a, b) || (shown(a) - shown(b)).abs() <= 1.0 / 255.0;
    assert_eq!(ours.len(), theirs.len(), "pictures of one size");
    let unlike = |like: &dyn Fn(f32, f32) -> bool| -> Vec<usize> {
        let alike = |index: &usize| {
            let pair = ours[*index].iter().zip(&theirs[*index]);
            pair.into_iter().all(|(&a, &b)| like(a, b))
        };
        (0..ours.len()).filter(|index| !alike(index)).collect()
    };
    let (bits, far) = (unlike(&same), unlike(&close));
    match (bits.len(), far.first()) {
        (0, _) => (Outcome::Equal, String::new()),
        (count, None) => (Outcome::Close, format!("{count} pixels have other bits")),
        (_, Some(&first)) => {
            let words = format!(
                "{} pixels differ, the first is {first}: ours {:?}, the browser's {:?}",
                far.len(),
                ours[first],
                theirs[first]
            );
            (Outcome::Differ, words)
        }
    }
}

fn judge(browser: &mut Chromium, worker: &mut Worker, shader: &str) -> (Outcome, String) {
    let ours = match ours(worker, shader) {
        Ok(pixels) => pixels,
        Err(why) => return (Outcome::Unpainted, format!("ours: {why}")),
    };
    match browser.paint(&wrapped(shader), SIZE, &SHOTS) {
        Ok(theirs) => compare(&ours, &theirs),
        Err(Failure::Refused(words)) => (Outcome::Unpainted, format!("the browser refuses: {words}")),
        Err(Failure::Silent) => (Outcome::Unpainted, "the browser is silent".to_owned()),
    }
}

/// A browser and a worker on the driver that it brings; none where there is no Chromium.
fn both() -> Option<(Chromium, Worker)> {
    let Some((program, manifest)) = chromium::find() else {
        eprintln!("skipped: no Chromium with SwiftShader here");
        return None;
    };
    let toyproof = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    let on = On::Named("SwiftShader".into());
    let worker = Worker::new(toyproof, vec!["worker".into()], on, Duration::from_secs(60));
    Some((Chromium::new(program), worker.with_manifest(manifest)))
}

#[test]
fn the_course_is_the_same_in_a_browser() {
    let Some((mut browser, mut worker)) = both() else {
        return;
    };
    for rung in RUNGS {
        let (outcome, words) = judge(&mut browser, &mut worker, rung.shader);
        let agrees = matches!(outcome, Outcome::Equal | Outcome::Close);
        assert!(agrees, "{}: {outcome:?} {words}", rung.name);
    }
}

#[test]
fn conversions_of_the_course_are_the_same_in_a_browser() {
    let Some((mut browser, _)) = both() else {
        return;
    };
    for rung in RUNGS {
        let (outcome, words) = judge_conversion(&mut browser, rung.shader);
        let agrees = matches!(outcome, Outcome::Equal | Outcome::Close);
        assert!(agrees, "{}: {outcome:?} {words}", rung.name);
    }
}

/// Shaders of that folder that read no channel, drawn by the seed.
fn drawn(folder: &Path) -> Vec<(PathBuf, String)> {
    let (count, seed): (usize, u64) = (setting("TOYPROOF_COUNT", 500), setting("TOYPROOF_SEED", 0));
    let mut shaders: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter_map(|path| Some((path.clone(), fs::read_to_string(path).ok()?)))
        .filter(|(_, text)| !text.contains("iChannel"))
        .collect();
    shaders.sort_by_key(|(path, _)| {
        let mut hasher = DefaultHasher::new();
        (seed, path.file_name()).hash(&mut hasher);
        hasher.finish()
    });
    shaders.truncate(count);
    shaders
}

#[test]
fn other_shaders_are_the_same_in_a_browser() {
    let Some(folder) = env::var_os("TOYPROOF_SHADERS") else {
        eprintln!("skipped: TOYPROOF_SHADERS names no folder of shaders");
        return;
    };
    let Some((mut browser, mut worker)) = both() else {
        return;
    };
    tally(&folder, |text| judge(&mut browser, &mut worker, text));
}

#[test]
fn conversions_of_other_shaders_are_the_same_in_a_browser() {
    let Some(folder) = env::var_os("TOYPROOF_SHADERS") else {
        eprintln!("skipped: TOYPROOF_SHADERS names no folder of shaders");
        return;
    };
    let Some((mut browser, _)) = both() else {
        return;
    };
    tally(&folder, |text| judge_conversion(&mut browser, text));
}

/// Judges shaders of a folder; few may differ.
fn tally(folder: &OsStr, mut judge: impl FnMut(&str) -> (Outcome, String)) {
    let (mut equal, mut close, mut differ, mut others) = (0, 0, 0, 0);
    for (path, text) in drawn(Path::new(folder)) {
        let (outcome, words) = judge(&text);
        eprintln!("{} {outcome:?} {words}", path.display());
        *match outcome {
            Outcome::Equal => &mut equal,
            Outcome::Close => &mut close,
            Outcome::Differ => &mut differ,
            Outcome::Unpainted => &mut others,
        } += 1;
    }
    let told = format!("{equal} equal, {close} within 1/255, {differ} differ, {others} not painted by both");
    eprintln!("{told}");
    assert!(equal + close > 0 && 49 * differ <= equal + close, "{told}");
}
