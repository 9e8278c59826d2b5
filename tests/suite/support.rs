//! Edited rungs of the course, judged as `toyproof check` judges them, but through the library.

use std::env;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Duration;

use toyproof::diagnostic::{self, Deadline, Diagnostic, File, Files};
use toyproof::glsl::{self, Checked};
use toyproof::gpu::{Failure, On, Worker};
use toyproof::image::Frame;
use toyproof::lint::{Lints, lint};
use toyproof::scene::{self, Moment, Scene};
use toyproof::tracer::Tracer;
use toyproof::translate::FloatMode;
use toyproof::verify::compare::Answer;
use toyproof::verify::mistake::Suspects;
use toyproof::verify::{Case, Expected, Findings, verify};

/// A shader of the course and the scene that it paints.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rung {
    pub(crate) name: &'static str,
    pub(crate) shader: &'static str,
    pub(crate) scene: &'static str,
    /// The number of the frame that is judged, and its time in seconds.
    pub(crate) frame: i32,
    pub(crate) time: f32,
    /// Width and height in pixels.
    pub(crate) size: [u32; 2],
}

macro_rules! rungs {
    ($($rung:ident = $name:literal $(at $frame:literal, $time:literal)? $(of $size:ident)?;)*) => {$(
        pub(crate) static $rung: Rung = Rung {
            name: $name,
            shader: include_str!(concat!("../../glsl/", $name, ".glsl")),
            scene: include_str!(concat!("../../glsl/", $name, ".toml")),
            $(frame: $frame, time: $time,)?
            $(size: $size,)?
            ..STILL
        };
    )*};
}

/// What most rungs are judged at.
pub(crate) const STILL: Rung = Rung {
    name: "",
    shader: "",
    scene: "",
    frame: 0,
    time: 0.0,
    size: SIZE,
};

rungs! {
    SAMPLING = "01-sampling";
    SPHERE = "02-sphere";
    SHADING = "03-shading";
    MANY_OBJECTS = "04-many-objects";
    COMPLEX_SCENE = "05-complex-scene" at 10, 0.0;
    REFLECTIONS = "06-reflections";
    DIFFUSE = "07-diffuse";
    DISNEY = "08-disney";
    SOFT_SHADOWS = "09-soft-shadows" of SMALL;
    QUADRICS = "10-quadrics";
    ANIMATION = "11-animation" at 37, 1.3;
    WHITTED = "12-whitted";
    IMPORTANCE_SAMPLING = "13-importance-sampling" of SMALL;
    ACCELERATOR = "14-accelerator";
    PARALLEL_RAYS = "15-parallel-rays";
}

/// The first rungs with rays, in the course's order: spheres, met by the same words in each.
pub(crate) static RUNGS: [&Rung; 5] = [&SPHERE, &SHADING, &MANY_OBJECTS, &COMPLEX_SCENE, &REFLECTIONS];

/// All of the course.
pub(crate) static EVERY_RUNG: [&Rung; 15] = [
    &SAMPLING,
    &SPHERE,
    &SHADING,
    &MANY_OBJECTS,
    &COMPLEX_SCENE,
    &REFLECTIONS,
    &DIFFUSE,
    &DISNEY,
    &SOFT_SHADOWS,
    &QUADRICS,
    &ANIMATION,
    &WHITTED,
    &IMPORTANCE_SAMPLING,
    &ACCELERATOR,
    &PARALLEL_RAYS,
];

/// `(from, to)`. `from` occurs exactly once; a `…` in it stands for everything up to the first occurrence of what
/// follows the `…`.
pub(crate) type Edit = (&'static str, &'static str);

/// Width and height in pixels: small enough for a hundred pictures, large enough that the share of pixels that may
/// differ, 0.1 %, is more than a dozen of them.
pub(crate) const SIZE: [u32; 2] = [160, 90];
/// The same where each pixel takes many samples.
const SMALL: [u32; 2] = [48, 27];

/// The maths question's answer: every test here has a scene.
pub(crate) fn maths(findings: &Findings) -> &Answer {
    &findings.maths.as_ref().expect("there is a scene").answer
}

/// The numbers behind a verdict, for people.
pub(crate) fn numbers(findings: &Findings) -> String {
    let questions = [
        ("maths", &findings.maths),
        ("rounding", &findings.rounding),
        ("toolchain", &findings.toolchain),
    ];
    let told = questions.into_iter().filter_map(|(name, asked)| {
        let answer = &asked.as_ref()?.answer;
        let percent = |count| 100.0 * answer.share(count);
        Some(format!(
            "{name} {:.2} % differ, {:.2} % undecided, {:.2} % undefined, by at most {:.1e}",
            percent(answer.differing),
            percent(answer.undecided),
            percent(answer.undefined),
            answer.max_abs
        ))
    });
    let told: Vec<_> = told.collect();
    format!("{}: {}", findings.verdict, told.join("; "))
}

/// The one worker of a test, or none where there is no Vulkan driver and the test is to be skipped.
///
/// # Panics
/// If there is no driver although `CI` is set, or the worker fails.
pub(crate) fn worker() -> Option<Worker> {
    let program = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    let mut worker = Worker::new(program, vec!["worker".into()], On::Auto, Duration::from_secs(60));
    match worker.probe() {
        Ok(_) => Some(worker),
        Err(Failure::NoDriver(why)) if env::var_os("CI").is_none() => {
            eprintln!("skipped, for there is no Vulkan driver: {why}");
            None
        }
        Err(failure) => panic!("{failure}"),
    }
}

/// A worker on `SwiftShader`, the software driver that Chromium brings, or none where there is no Chromium.
pub(crate) fn swiftshader() -> Option<Worker> {
    let manifest = [
        "/usr/lib/chromium",
        "/usr/lib/chromium-browser",
        "/usr/lib64/chromium-browser",
        "/opt/google/chrome",
    ]
    .map(|folder| Path::new(folder).join("vk_swiftshader_icd.json"))
    .into_iter()
    .find(|path| path.exists());
    let Some(manifest) = manifest else {
        eprintln!("skipped: no Chromium with SwiftShader here");
        return None;
    };
    let program = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    let on = On::Named("SwiftShader".into());
    let worker = Worker::new(program, vec!["worker".into()], on, Duration::from_secs(60));
    Some(worker.with_manifest(manifest))
}

/// A rung's scene.
pub(crate) fn scene(rung: &Rung) -> Scene {
    let mut files = Files::default();
    let file = files.add(File::new("<scene>", rung.scene));
    let mut scene = scene::parse(&files, file).unwrap_or_else(|errors| panic!("{}", told(&errors, &files)));
    scene.film.size = rung.size;
    scene
}

/// The tracer of a rung's scene.
pub(crate) fn tracer(rung: &Rung) -> Tracer<f64> {
    let moment = Moment {
        frame: rung.frame,
        time: f64::from(rung.time),
    };
    Tracer::at(&scene(rung), moment)
}

/// A shader, checked.
///
/// # Panics
/// If it is not valid.
pub(crate) fn checked(shader: &str) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("<shader>", shader));
    glsl::check(&files, file, &glsl::Options::default())
        .unwrap_or_else(|errors| panic!("{}\n{shader}", told(&errors, &files)))
}

/// The same with the lints' findings.
///
/// # Panics
/// Likewise.
pub(crate) fn linted(shader: &str) -> (Checked, Lints) {
    let mut files = Files::default();
    let file = files.add(File::new("<shader>", shader));
    let checked = checked(shader);
    debug_assert_eq!(file, checked.tree[checked.main_image].at.span.file);
    let lints = lint(&files, &checked, &Deadline::default());
    (checked, lints)
}

/// The frame that a rung is judged at, in a size.
pub(crate) fn frame(rung: &Rung, size: [u32; 2]) -> Frame {
    Frame {
        size,
        frame: rung.frame,
        time: rung.time,
        ..Frame::default()
    }
}

/// What `toyproof check` finds of a rung's shader, as edited.
///
/// # Panics
/// If anything goes wrong that is not the picture.
pub(crate) fn judged(worker: &mut Worker, shader: &str, rung: &Rung) -> Findings {
    judged_by(Some(worker), shader, rung)
}

/// The same, without a worker by the evaluator alone.
///
/// # Panics
/// Likewise.
pub(crate) fn judged_by(worker: Option<&mut Worker>, shader: &str, rung: &Rung) -> Findings {
    judged_beside(None, worker, shader, rung)
}

/// The same, as `toyproof check` does it, which compares what is wrong with classic mistakes.
///
/// # Panics
/// Likewise.
pub(crate) fn judged_and_named(worker: &mut Worker, shader: &str, rung: &Rung) -> Findings {
    let suspects = Suspects::of(&scene(rung), &frame(rung, rung.size)).unwrap();
    judged_beside(Some(&suspects), Some(worker), shader, rung)
}

/// What `toyproof check` finds without a worker, classic mistakes included.
///
/// # Panics
/// Likewise.
pub(crate) fn judged_with_names(shader: &str, rung: &Rung) -> Findings {
    let suspects = Suspects::of(&scene(rung), &frame(rung, rung.size)).unwrap();
    judged_beside(Some(&suspects), None, shader, rung)
}

fn judged_beside(
    suspects: Option<&Suspects>,
    worker: Option<&mut Worker>,
    shader: &str,
    rung: &Rung,
) -> Findings {
    let frame = frame(rung, rung.size);
    let (checked, lints) = linted(shader);
    let case = Case {
        checked: &checked,
        lints: &lints,
        expected: Some(&Expected::new(scene(rung), &frame)),
        suspects,
        frame: &frame,
        float: FloatMode::Strict,
        timeout: Duration::from_secs(60),
        pool: None,
    };
    verify(worker, &case).unwrap_or_else(|failure| panic!("{failure}\n{shader}"))
}

fn told(errors: &[Diagnostic], files: &Files) -> String {
    let lines: Vec<_> = errors
        .iter()
        .map(|error| diagnostic::short(error, files))
        .collect();
    lines.join("\n")
}

/// The rung's shader after all edits, one after the other.
///
/// # Panics
/// If there is nothing to edit, or it is not clear where.
pub(crate) fn edited(rung: &Rung, edits: &[Edit]) -> String {
    edit(rung.shader, edits, rung.name)
}

/// A text after all edits, one after the other; `name` is for messages.
///
/// # Panics
/// If there is nothing to edit, or it is not clear where.
pub(crate) fn edit(text: &str, edits: &[Edit], name: &str) -> String {
    try_edit(text, edits).unwrap_or_else(|why| panic!("{name}: {why}\n{text}"))
}

/// The same, or why it cannot be.
pub(crate) fn try_edit(text: &str, edits: &[Edit]) -> Result<String, String> {
    let mut text = text.to_owned();
    for (from, to) in edits {
        let range = place(&text, from).map_err(|why| format!("`{from}` {why}"))?;
        text.replace_range(range, to);
    }
    Ok(text)
}

fn place(text: &str, from: &str) -> Result<Range<usize>, String> {
    let (head, tail) = from.split_once('…').unwrap_or((from, ""));
    match text.matches(head).count() {
        1 => {}
        count => return Err(format!("begins {count} times, not once")),
    }
    let start = text.find(head).ok_or("begins nowhere")?;
    let after = start + head.len();
    let end = text[after..].find(tail).ok_or("ends nowhere")?;
    Ok(start..after + end + tail.len())
}

/// What an environment variable says.
pub(crate) fn setting<T: FromStr>(name: &str, default: T) -> T {
    env::var(name)
        .ok()
        .and_then(|value| value.parse().ok())
        .unwrap_or(default)
}
