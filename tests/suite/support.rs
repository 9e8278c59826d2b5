//! Edited rungs of the course, judged as `toyproof check` judges them, but through the library.

use std::ops::Range;
use std::path::PathBuf;
use std::time::Duration;

use toyproof::compare::{Comparison, Verdict, compare, judge};
use toyproof::diagnostic::{self, Diagnostic};
use toyproof::frame::Frame;
use toyproof::glsl;
use toyproof::gpu::{Failure, FloatMode, On, Worker};
use toyproof::image::Image;
use toyproof::scene;
use toyproof::source::{File, Files};
use toyproof::trace::Tracer;

/// A shader of the course and the scene that it paints.
#[derive(Debug)]
pub(crate) struct Rung {
    pub(crate) name: &'static str,
    pub(crate) shader: &'static str,
    pub(crate) scene: &'static str,
}

macro_rules! rungs {
    ($($rung:ident = $name:literal;)*) => {$(
        pub(crate) static $rung: Rung = Rung {
            name: $name,
            shader: include_str!(concat!("../../glsl/", $name, ".glsl")),
            scene: include_str!(concat!("../../glsl/", $name, ".toml")),
        };
    )*};
}

rungs! {
    SPHERE = "02-sphere";
    SHADING = "03-shading";
    MANY_OBJECTS = "04-many-objects";
    COMPLEX_SCENE = "05-complex-scene";
    REFLECTIONS = "06-reflections";
}

/// All rungs, in the course's order.
pub(crate) static RUNGS: [&Rung; 5] = [&SPHERE, &SHADING, &MANY_OBJECTS, &COMPLEX_SCENE, &REFLECTIONS];

/// `(from, to)`. `from` occurs exactly once; a `…` in it stands for everything up to the first occurrence of what
/// follows the `…`.
pub(crate) type Edit = (&'static str, &'static str);

/// Width and height in pixels: small enough for a hundred pictures, large enough that the share of pixels that may
/// differ, 0.1 %, is more than a dozen of them.
pub(crate) const SIZE: [u32; 2] = [160, 90];

/// What came of one shader.
#[derive(Debug)]
pub(crate) struct Judged {
    pub(crate) verdict: Verdict,
    pub(crate) comparison: Comparison,
    pub(crate) expected: Image,
    pub(crate) actual: Image,
}

impl Judged {
    /// The share of the pixels that `count` is.
    pub(crate) fn share(&self, count: u64) -> f64 {
        count as f64 / self.comparison.pixels as f64
    }

    /// The numbers behind the verdict, for people.
    pub(crate) fn numbers(&self) -> String {
        let Comparison {
            differing,
            undecided,
            max_abs,
            ..
        } = self.comparison;
        format!(
            "{}: {:.2} % differ, {:.2} % undecided, by at most {max_abs:.1e}",
            self.verdict,
            100.0 * self.share(differing),
            100.0 * self.share(undecided),
        )
    }
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
        Err(Failure::NoDriver(why)) if std::env::var_os("CI").is_none() => {
            eprintln!("skipped, for there is no Vulkan driver: {why}");
            None
        }
        Err(failure) => panic!("{failure}"),
    }
}

/// The tracer of a scene at `size`.
pub(crate) fn tracer(scene: &str, size: [u32; 2]) -> Tracer<f64> {
    let mut files = Files::default();
    let file = files.add(File::new("<scene>", scene));
    let mut scene = scene::parse(&files, file).unwrap_or_else(|errors| panic!("{}", told(&errors, &files)));
    scene.film.size = size;
    Tracer::new(&scene)
}

/// Paints and traces at `size`, compares and judges.
///
/// # Panics
/// If anything goes wrong that is not the picture.
pub(crate) fn verdict(worker: &mut Worker, shader: &str, scene: &str, size: [u32; 2]) -> Judged {
    let mut files = Files::default();
    let file = files.add(File::new("<shader>", shader));
    let checked = glsl::check(&files, file, &glsl::Options::default())
        .unwrap_or_else(|errors| panic!("{}\n{shader}", told(&errors, &files)));
    let lowered = glsl::lower_strict(&checked);
    let frame = Frame {
        size,
        ..Frame::default()
    };
    let drawn = match worker.draw(lowered, frame, FloatMode::Strict) {
        Ok(drawn) => drawn,
        Err(Failure::Invalid(errors)) => panic!("{}\n{shader}", told(&errors, &files)),
        Err(failure) => panic!("{failure}\n{shader}"),
    };
    assert_eq!(drawn.cut_short, Some(0), "loops were cut short\n{shader}");
    let tracer = tracer(scene, size);
    let expected = tracer.picture(|| ());
    let hull = |x, y| tracer.hull(x, y);
    let (comparison, _) = compare(&expected, &drawn.image, Some(&hull));
    Judged {
        verdict: judge(&comparison).0,
        comparison,
        expected,
        actual: drawn.image,
    }
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
    let mut text = rung.shader.to_owned();
    for (from, to) in edits {
        let range = place(&text, from).unwrap_or_else(|why| panic!("{}: `{from}` {why}", rung.name));
        text.replace_range(range, to);
    }
    text
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
