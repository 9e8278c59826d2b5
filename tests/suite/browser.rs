//! Chromium's WebGL 2 renders the same images as we do: the author's text through ANGLE and ours through
//! naga, both on `SwiftShader`, the software driver that Chromium ships, with its own transcendental
//! functions and without `NoContraction`.
//!
//! By default the course is compared. `TOYPROOF_SHADERS` names a folder of other shaders, of which
//! `TOYPROOF_COUNT` (500) are chosen with `TOYPROOF_SEED` (0) among those that read no channel; a line for
//! each goes to standard error.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{env, fs};

use serde_json::json;
use toyproof::diagnostic::{Deadline, File, Files};
use toyproof::glsl::tree::SamplerShape;
use toyproof::glsl::{Options, Sampling, check};
use toyproof::gpu::Worker;
use toyproof::gpu::browser::{BrowserFailure, Chromium, Text, as_shadertoy};
use toyproof::image::{Frame, Image};
use toyproof::translate::backend::{Target, emit};
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::wgsl::{Style, wgsl};
use toyproof::translate::{FloatMode, lower};

use crate::requirements::{require_chromium, require_folder, require_swiftshader};
use crate::support::devtools::Page;
use crate::support::wait::wait_until;
use crate::support::{EXERCISES, setting};

const SIZE: [u32; 2] = [64, 36];
/// `iTime` and `iFrame`.
const SHOTS: [(f32, i32); 2] = [(1.0, 60), (7.3, 438)];

/// A shader's pixels in all frames, concatenated, bottom rows first.
type Pixels = Vec<[f32; 4]>;

/// The time limit of a browser for one shader.
const TIME_LIMIT: Duration = Duration::from_secs(90);

fn frames() -> Vec<Frame> {
    let frame = |(time, number)| Frame {
        size: SIZE,
        time,
        frame: number,
        ..Frame::default()
    };
    SHOTS.map(frame).to_vec()
}

fn in_browser(browser: &mut Chromium, text: Text) -> Result<Pixels, BrowserFailure> {
    let images = browser.render(text, [Sampling::default(); 4], &frames())?;
    Ok(images.iter().flat_map(|image| image.pixels().to_vec()).collect())
}

/// A texture that all frames share is sent once; one above the largest message that Chromium reads is
/// refused.
#[test]
fn textures_are_sent_once_and_have_a_limit() {
    let Some(program) = require_chromium() else { return };
    let mut browser = Chromium::new(program, TIME_LIMIT);
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, vec2(0.5)); }";
    let text = as_shadertoy(shader, [SamplerShape::D2; 4]);
    let mut render = |side: u32, count: usize| {
        let image = Image::new(side, side, vec![[0.25; 4]; (side * side) as usize]);
        let frame = Frame {
            size: [2, 1],
            channels: [Some(image.into()), None, None, None],
            ..Frame::default()
        };
        browser.render(Text::Glsl(&text), [Sampling::default(); 4], &vec![frame; count])
    };
    // 43 MB as text: three would be too many.
    let images = render(1400, 3).unwrap();
    assert!(
        images
            .iter()
            .all(|image| image.get(1, 0) == [0.25, 0.25, 0.25, 1.0])
    );
    assert!(matches!(render(2200, 1), Err(BrowserFailure::TooLarge)));
}

/// A shader's WGSL from our own writer.
fn converted(shader: &str) -> Result<String, String> {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default())
        .map_err(|errors| toyproof::diagnostic::short(&errors[0], &files))?;
    wgsl(&checked, &files, Style::Plain, &Deadline::default()).map_err(|why| why.to_string())
}

/// Compares the author's shader in WebGL 2 with its conversion in WebGPU.
fn compare_conversion(browser: &mut Chromium, shader: &str) -> (Outcome, String) {
    let text = match converted(shader) {
        Ok(text) => text,
        Err(why) => return (Outcome::Unpainted, format!("not converted: {why}")),
    };
    let original = in_browser(browser, Text::Glsl(&as_shadertoy(shader, [SamplerShape::D2; 4])));
    let conversion = in_browser(browser, Text::Wgsl(&text));
    match (original, conversion) {
        (Ok(original), Ok(conversion)) => compare(&conversion, &original),
        (Err(failure), _) => (Outcome::Unpainted, format!("WebGL 2: {failure}")),
        (_, Err(failure)) => (Outcome::Unpainted, format!("WebGPU: {failure}")),
    }
}

/// The result of one comparison.
#[derive(Debug, PartialEq, Eq)]
enum Outcome {
    /// Every float is equal to the bit.
    Equal,
    /// No 8-bit color differs by more than 1/255.
    Close,
    /// Some colors differ by more.
    Differ,
    /// One of the two did not render.
    Unpainted,
}

fn ours(worker: &mut Worker, shader: &str) -> Result<Pixels, String> {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default())
        .map_err(|errors| toyproof::diagnostic::short(&errors[0], &files))?;
    let lowered = lower(&checked);
    let mut pixels = Vec::new();
    for frame in frames() {
        let choose_shaders = worker
            .draw(lowered.clone(), frame, FloatMode::Fast)
            .map_err(|failure| failure.to_string())?;
        pixels.extend_from_slice(choose_shaders.image().pixels());
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

fn compare_shader(browser: &mut Chromium, worker: &mut Worker, shader: &str) -> (Outcome, String) {
    let ours = match ours(worker, shader) {
        Ok(pixels) => pixels,
        Err(why) => return (Outcome::Unpainted, format!("ours: {why}")),
    };
    match in_browser(browser, Text::Glsl(&as_shadertoy(shader, [SamplerShape::D2; 4]))) {
        Ok(theirs) => compare(&ours, &theirs),
        Err(failure) => (Outcome::Unpainted, failure.to_string()),
    }
}

/// A browser and a worker on its software driver; none without Chromium.
fn browser_and_worker() -> Option<(Chromium, Worker)> {
    let worker = require_swiftshader()?;
    let program = require_chromium()?;
    Some((Chromium::new(program, TIME_LIMIT), worker))
}

#[test]
fn the_course_is_the_same_in_a_browser() {
    let Some((mut browser, mut worker)) = browser_and_worker() else {
        return;
    };
    for exercise in EXERCISES {
        let (outcome, words) = compare_shader(&mut browser, &mut worker, exercise.shader);
        let agrees = matches!(outcome, Outcome::Equal | Outcome::Close);
        assert!(agrees, "{}: {outcome:?} {words}", exercise.name);
    }
}

#[test]
fn conversions_of_the_course_are_the_same_in_a_browser() {
    let Some((mut browser, _)) = browser_and_worker() else {
        return;
    };
    for exercise in EXERCISES {
        let (outcome, words) = compare_conversion(&mut browser, exercise.shader);
        let agrees = matches!(outcome, Outcome::Equal | Outcome::Close);
        assert!(agrees, "{}: {outcome:?} {words}", exercise.name);
    }
}

/// Chooses shaders of a folder that read no channel, at random from the seed.
fn choose_shaders(folder: &Path) -> Vec<(PathBuf, String)> {
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
#[ignore = "needs a folder of shaders"]
fn other_shaders_are_the_same_in_a_browser() {
    let Some(folder) = require_folder("TOYPROOF_SHADERS") else {
        return;
    };
    let Some((mut browser, mut worker)) = browser_and_worker() else {
        return;
    };
    tally(&folder, |text| compare_shader(&mut browser, &mut worker, text));
}

#[test]
#[ignore = "needs a folder of shaders"]
fn conversions_of_other_shaders_are_the_same_in_a_browser() {
    let Some(folder) = require_folder("TOYPROOF_SHADERS") else {
        return;
    };
    let Some((mut browser, _)) = browser_and_worker() else {
        return;
    };
    tally(&folder, |text| compare_conversion(&mut browser, text));
}

/// Compares shaders of a folder; few may differ.
fn tally(folder: &Path, mut compare_shader: impl FnMut(&str) -> (Outcome, String)) {
    let (mut equal, mut close, mut differ, mut others) = (0, 0, 0, 0);
    for (path, text) in choose_shaders(folder) {
        let (outcome, words) = compare_shader(&text);
        eprintln!("{} {outcome:?} {words}", path.display());
        *match outcome {
            Outcome::Equal => &mut equal,
            Outcome::Close => &mut close,
            Outcome::Differ => &mut differ,
            Outcome::Unpainted => &mut others,
        } += 1;
    }
    let reported =
        format!("{equal} equal, {close} within 1/255, {differ} differ, {others} not painted by both");
    eprintln!("{reported}");
    assert!(equal + close > 0 && 49 * differ <= equal + close, "{reported}");
}

/// Replaces the shader in a page of `examples/hosts`.
fn with_shader(page: &str, text: &str) -> String {
    let page = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("examples/hosts")
            .join(page),
    )
    .unwrap();
    let (head, rest) = page.split_once("<script type=\"x-shader/").unwrap();
    let (language, rest) = rest.split_once("\">").unwrap();
    let (_, rest) = rest.split_once("</script>").unwrap();
    format!("{head}<script type=\"x-shader/{language}\">{text}</script>{rest}")
}

#[test]
fn example_hosts_render_conversions() {
    const SHADER: &str = "void mainImage(out vec4 c, in vec2 p) {
        c = vec4(p / iResolution.xy, 0.25 + 0.0 * sin(iTime) + 0.5 * float(iFrame < 0), 1.0);
    }";
    let Some(program) = require_chromium() else {
        return;
    };
    let mut files = Files::default();
    let file = files.add(File::new("shader", SHADER));
    let checked = check(&files, file, &Options::default()).unwrap();
    let glsl = emit(&ValidModule::parse(&lower(&checked)).unwrap(), Target::Glsl).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut window = Page::with(&program, &SOFTWARE_RENDERING);
    window.window([700, 420], false);
    for (page, text) in [
        ("host.html", converted(SHADER).unwrap()),
        ("host-webgl2.html", String::from_utf8(glsl).unwrap()),
    ] {
        let file = folder.path().join(page);
        fs::write(&file, with_shader(page, &text)).unwrap();
        window.open(&file);
        // The page loads before its canvas is rendered, and no event reports when the canvas reaches the
        // window.
        wait_until(|| shows_the_ramps(&window.screenshot()));
    }
}

/// The flags with which Chromium shows WebGL and WebGPU canvases on a machine without a GPU. The guide lists
/// those of WebGPU.
pub(crate) const SOFTWARE_RENDERING: [&str; 8] = [
    "--hide-scrollbars",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--use-vulkan=swiftshader",
    "--enable-features=Vulkan",
];

#[test]
fn example_hosts_report_errors() {
    let Some(program) = require_chromium() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let open = |window: &mut Page, page: &str, text: &str| {
        let file = folder.path().join(page);
        fs::write(&file, with_shader(page, text)).unwrap();
        window.open(&file);
    };
    let reports = |text: &str| {
        format!(
            "document.querySelector('#errors').textContent.includes({})",
            json!(text)
        )
    };
    let wgsl = "\n@fragment\nfn main() -> @location(0) vec4f {\n  return vec4f(unknown);\n}\n";
    let glsl = "#version 300 es\nprecision highp float;\nout vec4 c;\nvoid main() { c = vec4(unknown); }\n";
    let mut window = Page::with(&program, &SOFTWARE_RENDERING);
    open(&mut window, "host.html", wgsl);
    window.until(&reports("error at line 3, column 16"));
    open(&mut window, "host-webgl2.html", glsl);
    window.until(&reports("ERROR: 0:4: 'unknown'"));
    let mut window = Page::new(&program);
    open(&mut window, "host.html", wgsl);
    window.until(&reports("WebGPU"));
}

/// Whether a window shows red increasing to the right and green increasing upward, on a canvas of 640 by
/// 360 pixels that starts 8 pixels from its top left.
pub(crate) fn shows_the_ramps(shot: &[u8]) -> bool {
    let shown = image::load_from_memory(shot).unwrap().into_rgb8();
    [[0, 0], [639, 0], [0, 359], [400, 100]]
        .into_iter()
        .all(|[x, y]| {
            let found = shown.get_pixel(8 + x, 8 + 359 - y).0;
            let expected = [(x as f32 + 0.5) / 640.0, (y as f32 + 0.5) / 360.0, 0.25];
            let near = |(found, expected): (u8, f32)| (f32::from(found) - 255.0 * expected).abs() <= 1.0;
            found.into_iter().zip(expected).all(near)
        })
}
