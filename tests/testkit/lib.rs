//! What the test suite, `cargo xtask` and the fuzz targets share: edited exercises of the course, checked as by
//! `toyproof check`, but through the library; the judges of fuzzed inputs; and an interpreter of shaders, the
//! evaluator's oracle.

#![expect(
    clippy::must_use_candidate,
    clippy::missing_panics_doc,
    clippy::missing_errors_doc,
    reason = "only for tests, which panic on errors"
)]
#![expect(
    clippy::disallowed_methods,
    reason = "tests show the paths that they made themselves"
)]

pub mod devices;
pub mod devtools;
pub mod exercises;
pub mod faults;
pub mod generate;
pub mod interpreter;
pub mod judge;
pub mod lsp;
pub mod pages;
pub mod rewrites;
pub mod textures;
pub mod toolchain;
pub mod wait;
pub mod watching;

use std::env;
use std::ops::Range;
use std::str::FromStr;
use std::time::Duration;

use toyproof::diagnostic::{self, Deadline, Diagnostic, File, Files};
use toyproof::explain::known::Hypotheses;
use toyproof::explain::repair::{DEFAULT_BUDGET, Donors, SearchOptions};
use toyproof::explain::{self, Findings, Options};
use toyproof::glsl::{self, Checked};
use toyproof::gpu::Worker;
use toyproof::image::{Frame, Image};
use toyproof::lint::{Lints, lint};
use toyproof::scene::{self, FrameTime, Scene, export};
use toyproof::tracer::Tracer;
use toyproof::verify::compare::CheckSummary;
use toyproof::verify::{Case, Driver, Expected, ShaderReference};

/// A shader of the course and its scene.
#[derive(Debug, Clone, Copy)]
pub struct Exercise {
    /// The stem of its files.
    pub name: &'static str,
    /// The shader's text.
    pub shader: &'static str,
    /// The scene's text.
    pub scene: &'static str,
    /// The number of the checked frame.
    pub frame: i32,
    /// The time of the checked frame, in seconds.
    pub time: f32,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

macro_rules! exercises {
    ($($exercise:ident = $name:literal $(at $frame:literal, $time:literal)? $(of $size:ident)?;)*) => {$(
        /// An exercise of this name.
        pub static $exercise: Exercise = Exercise {
            name: $name,
            shader: include_str!(concat!("../../glsl/", $name, ".glsl")),
            scene: include_str!(concat!("../../glsl/", $name, ".toml")),
            $(frame: $frame, time: $time,)?
            $(size: $size,)?
            ..STILL
        };
    )*};
}

/// The settings of most exercises.
pub const STILL: Exercise = Exercise {
    name: "",
    shader: "",
    scene: "",
    frame: 0,
    time: 0.0,
    size: SIZE,
};

exercises! {
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

/// The first exercises with rays, in the course's order; all intersect spheres with the same code.
pub static EXERCISES: [&Exercise; 5] = [&SPHERE, &SHADING, &MANY_OBJECTS, &COMPLEX_SCENE, &REFLECTIONS];

/// All exercises of the course.
pub static EVERY_EXERCISE: [&Exercise; 15] = [
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

/// An edit `(from, to)`. `from` occurs exactly once; a `…` in it matches everything up to the first
/// occurrence of the text after it.
pub type Edit = (&'static str, &'static str);

/// Width and height in pixels: small enough for a hundred images, large enough that the tolerated share of
/// differing pixels, 0.1 %, is more than a dozen pixels.
pub const SIZE: [u32; 2] = [160, 90];
/// The same for exercises that take many samples per pixel.
const SMALL: [u32; 2] = [48, 27];

/// The summary of the algorithm check: every test here has a scene.
pub fn algorithm(findings: &Findings) -> &CheckSummary {
    &findings
        .results
        .algorithm
        .as_ref()
        .expect("there is a scene")
        .summary
}

/// The numbers behind a verdict, for people.
pub fn numbers(findings: &Findings) -> String {
    let checks = [
        ("algorithm", &findings.results.algorithm),
        ("precision", &findings.results.precision),
        ("toolchain", &findings.results.toolchain),
    ];
    let checks = checks.into_iter().filter_map(|(name, check)| {
        let summary = &check.as_ref()?.summary;
        let percent = |count| 100.0 * summary.share(count);
        Some(format!(
            "{name} {:.2} % differ, {:.2} % ill-conditioned, {:.2} % undefined, by at most {:.1e}",
            percent(summary.differing),
            percent(summary.ill_conditioned),
            percent(summary.undefined),
            summary.max_abs
        ))
    });
    let checks: Vec<_> = checks.collect();
    format!("{}: {}", findings.verdict, checks.join("; "))
}

/// An exercise's scene.
pub fn scene(exercise: &Exercise) -> Scene {
    let mut files = Files::default();
    let file = files.add(File::new("<scene>", exercise.scene));
    let mut scene =
        scene::parse(&files, file).unwrap_or_else(|errors| panic!("{}", format_errors(&errors, &files)));
    scene.film.size = exercise.size;
    scene
}

/// The tracer of an exercise's scene.
pub fn tracer(exercise: &Exercise) -> Tracer<f64> {
    let moment = FrameTime {
        frame: exercise.frame,
        time: f64::from(exercise.time),
    };
    Tracer::at(&scene(exercise), moment)
}

/// Checks a shader's text.
///
/// # Panics
/// If it is invalid.
pub fn checked(shader: &str) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("<shader>", shader));
    glsl::check(&files, file, &glsl::Options::default())
        .unwrap_or_else(|errors| panic!("{}\n{shader}", format_errors(&errors, &files)))
}

/// Checks a shader's text, and lints it.
///
/// # Panics
/// If it is invalid.
pub fn linted(shader: &str) -> (Checked, Lints) {
    let mut files = Files::default();
    let file = files.add(File::new("<shader>", shader));
    let checked = checked(shader);
    debug_assert_eq!(file, checked.tree[checked.main_image].at.span.file);
    let lints = lint(&files, &checked, &Deadline::default());
    (checked, lints)
}

/// The frame in which an exercise is checked, in a size.
pub fn frame(exercise: &Exercise, size: [u32; 2]) -> Frame {
    Frame {
        size,
        frame: exercise.frame,
        time: exercise.time,
        ..Frame::default()
    }
}

/// Checks an edited shader of an exercise like `toyproof check`.
///
/// # Panics
/// If anything but the comparison of the images fails.
pub fn check_exercise(worker: &mut Worker, shader: &str, exercise: &Exercise) -> Findings {
    check_exercise_with(Some(worker), shader, exercise)
}

/// Like [`check_exercise`], by the evaluator alone if there is no worker.
///
/// # Panics
/// Like [`check_exercise`].
pub fn check_exercise_with(worker: Option<&mut Worker>, shader: &str, exercise: &Exercise) -> Findings {
    check_against(None, worker, shader, exercise)
}

/// Like [`check_exercise`], also comparing wrong images with known mistakes.
///
/// # Panics
/// Like [`check_exercise`].
pub fn check_and_name(worker: &mut Worker, shader: &str, exercise: &Exercise) -> Findings {
    let hypotheses = Hypotheses::new(&scene(exercise), &frame(exercise, exercise.size)).unwrap();
    check_against(Some(&hypotheses), Some(worker), shader, exercise)
}

/// Like [`check_and_name`], by the evaluator alone.
///
/// # Panics
/// Like [`check_exercise`].
pub fn check_and_name_on_cpu(shader: &str, exercise: &Exercise) -> Findings {
    let hypotheses = Hypotheses::new(&scene(exercise), &frame(exercise, exercise.size)).unwrap();
    check_against(Some(&hypotheses), None, shader, exercise)
}

/// Checks a shader by the evaluator alone, and searches for repairs.
///
/// # Panics
/// Like [`check_exercise`].
pub fn check_and_repair(shader: &str, exercise: &Exercise) -> Findings {
    check_and_repair_with(None, shader, exercise)
}

/// Checks a shader by the evaluator alone, and searches for repairs among the donors, if there are any.
///
/// # Panics
/// Like [`check_exercise`].
pub fn check_and_repair_with(donors: Option<&Donors>, shader: &str, exercise: &Exercise) -> Findings {
    let search = SearchOptions {
        donors,
        ..search_options(shader, DEFAULT_BUDGET)
    };
    check_with(None, Some(search), None, shader, exercise)
}

/// Checks a shader by the evaluator alone with a time limit, names its mistake, and searches for repairs with a
/// budget. None if its image takes longer.
///
/// # Panics
/// If the scene is too expensive for known mistakes.
pub fn check_and_repair_within(
    timeout: Duration,
    budget: f64,
    shader: &str,
    exercise: &Exercise,
) -> Option<Findings> {
    let frame = frame(exercise, exercise.size);
    let expected = Expected::from_scene(scene(exercise), &frame);
    let hypotheses = Hypotheses::new(&scene(exercise), &frame).expect("the scene is cheap");
    let (checked, lints) = linted(shader);
    let options = Options {
        hypotheses: Some(&hypotheses),
        search: Some(search_options(shader, budget)),
        ..Options::default()
    };
    let case = Case::new(&checked, &lints, &frame)
        .with_expected(&expected)
        .with_timeout(timeout);
    explain::check(None, &case, &options).ok()
}

/// Checks a shader against a reference like [`check_reference`], and searches for repairs.
///
/// # Panics
/// Like [`check_exercise`].
pub fn check_reference_and_repair(expected: &Expected, shader: &str, exercise: &Exercise) -> Findings {
    let search = search_options(shader, DEFAULT_BUDGET);
    check_expected(expected, None, Some(search), None, shader, exercise)
}

fn search_options(source: &str, budget: f64) -> SearchOptions<'_> {
    SearchOptions {
        source,
        budget,
        donors: None,
        pass: None,
    }
}

/// A reference shader for an exercise: the one that renders its scene, as `toyproof export` writes it.
///
/// # Panics
/// If it cannot be evaluated.
pub fn exported_reference(exercise: &Exercise, tolerance: f64) -> Expected {
    let text = export::shader(&scene(exercise)).expect("every scene of the course can be exported");
    let (checked, lints) = linted(&text);
    let frame = frame(exercise, exercise.size);
    let timeout = Duration::from_secs(60);
    let (reference, _) = ShaderReference::new(&checked, &lints, &frame, tolerance, timeout)
        .unwrap_or_else(|failure| panic!("{failure}\n{text}"));
    Expected::Shader(Box::new(reference))
}

/// Checks a shader against a reference in the exercise's frame, by the evaluator alone.
///
/// # Panics
/// Like [`check_exercise`].
pub fn check_reference(expected: &Expected, shader: &str, exercise: &Exercise) -> Findings {
    check_expected(expected, None, None, None, shader, exercise)
}

fn check_against(
    hypotheses: Option<&Hypotheses>,
    worker: Option<&mut Worker>,
    shader: &str,
    exercise: &Exercise,
) -> Findings {
    check_with(hypotheses, None, worker, shader, exercise)
}

fn check_with(
    hypotheses: Option<&Hypotheses>,
    search: Option<SearchOptions>,
    worker: Option<&mut Worker>,
    shader: &str,
    exercise: &Exercise,
) -> Findings {
    let frame = frame(exercise, exercise.size);
    let expected = Expected::from_scene(scene(exercise), &frame);
    check_expected(&expected, hypotheses, search, worker, shader, exercise)
}

fn check_expected(
    expected: &Expected,
    hypotheses: Option<&Hypotheses>,
    search: Option<SearchOptions>,
    worker: Option<&mut Worker>,
    shader: &str,
    exercise: &Exercise,
) -> Findings {
    let frame = frame(exercise, exercise.size);
    let (checked, lints) = linted(shader);
    let options = Options {
        hypotheses,
        search,
        ..Options::default()
    };
    let case = Case::new(&checked, &lints, &frame)
        .with_expected(expected)
        .with_timeout(Duration::from_secs(60));
    let worker = worker.map(|worker| worker as &mut Driver);
    explain::check(worker, &case, &options).unwrap_or_else(|failure| panic!("{failure}\n{shader}"))
}

fn format_errors(errors: &[Diagnostic], files: &Files) -> String {
    let lines: Vec<_> = errors
        .iter()
        .map(|error| diagnostic::short(error, files))
        .collect();
    lines.join("\n")
}

/// The number of pixels that differ between two images, and the first with both colors.
pub fn differences(a: &Image, b: &Image, ignore: impl Fn(u32, u32) -> bool) -> (usize, String) {
    let [width, height] = a.size();
    // Compared like in the toolchain check.
    let same = |a: f32, b: f32| a == b || (a.is_nan() && b.is_nan());
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let differing: Vec<_> = pixels
        .filter(|&(x, y)| !ignore(x, y))
        .filter(|&(x, y)| (0..3).any(|at| !same(a.get(x, y)[at], b.get(x, y)[at])))
        .collect();
    let first = differing.first().map_or(String::new(), |&(x, y)| {
        format!("first at ({x}, {y}): {:?} and {:?}", a.get(x, y), b.get(x, y))
    });
    (differing.len(), first)
}

/// Applies edits in order to the exercise's shader.
///
/// # Panics
/// If an edit matches nothing or is ambiguous.
pub fn edited(exercise: &Exercise, edits: &[Edit]) -> String {
    edit(exercise.shader, edits, exercise.name)
}

/// Applies edits in order to a text; `name` is for messages.
///
/// # Panics
/// If an edit matches nothing or is ambiguous.
pub fn edit(text: &str, edits: &[Edit], name: &str) -> String {
    try_edit(text, edits).unwrap_or_else(|why| panic!("{name}: {why}\n{text}"))
}

/// Like [`edit`], but returns the error.
pub fn try_edit(text: &str, edits: &[Edit]) -> Result<String, String> {
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

/// The value of an environment variable, or the default.
pub fn setting<T: FromStr>(name: &str, default: T) -> T {
    env::var(name)
        .ok()
        .and_then(|value| value.parse().ok())
        .unwrap_or(default)
}
