//! Compares the reference tracer with POV-Ray 3.7, which shares no code with it.

mod words;

use std::fs;
use std::path::Path;
use std::process::Command;

use toyproof::diagnostic::{File, Files};
use toyproof::image::{self, Image};
use toyproof::scene::{self, FrameTime, Sampler, Scene, ToneMap};
use toyproof::tracer::Tracer;

use crate::requirements::require_program;

const SIZE: [u32; 2] = [320, 180];

/// POV-Ray's images have 16 bits, and so an error of at most half of 1/65535, 7.6e-6. In repeated mirror
/// reflections, its "tolerances" of up to 1e-3 show: at most 5.8e-5 in a pixel of `quadrics`.
const TOLERANCE: f32 = 1e-4;
/// One 8-bit level.
const VISIBLE: f32 = 1.0 / 255.0;
/// The number of pixels per image in which the two may see different surfaces.
const MAX_EDGE_PIXELS: usize = 2;

/// A scene that both render.
struct Case {
    name: &'static str,
    scene: &'static str,
    /// Edits that replace features that POV-Ray lacks.
    edits: &'static [(&'static str, &'static str)],
    moment: FrameTime,
}

macro_rules! case {
    ($folder:literal, $name:literal) => {
        Case {
            name: $name,
            scene: include_str!(concat!($folder, $name, ".toml")),
            edits: &[],
            moment: FrameTime { frame: 0, time: 0.0 },
        }
    };
}

/// The course's scenes that POV-Ray can express, and some of our own.
static CASES: [Case; 18] = [
    case!("../../../glsl/", "02-sphere"),
    case!("../../../glsl/", "03-shading"),
    case!("../../../glsl/", "04-many-objects"),
    Case {
        moment: FrameTime { frame: 10, time: 0.0 },
        ..case!("../../../glsl/", "05-complex-scene")
    },
    case!("../../../glsl/", "06-reflections"),
    case!("../../../glsl/", "07-diffuse"),
    case!("../../../glsl/", "10-quadrics"),
    Case {
        moment: FrameTime { frame: 37, time: 1.3 },
        ..case!("../../../glsl/", "11-animation")
    },
    Case {
        // POV-Ray computes the transmission of tinted glass differently.
        edits: &[("color = [0.95, 1.0, 0.95], ior", "color = [1, 1, 1], ior")],
        ..case!("../../../glsl/", "12-whitted")
    },
    case!("../../../glsl/", "14-accelerator"),
    case!("../../../glsl/", "15-parallel-rays"),
    case!("", "facing"),
    case!("", "glass"),
    case!("", "mirrors"),
    case!("", "quadrics"),
    case!("", "boxes"),
    case!("", "patterns"),
    case!("", "turned"),
];

/// The scene at its frame time, with one sample in the center of each pixel, in linear light.
fn scene(case: &Case) -> Scene {
    let mut text = case.scene.to_owned();
    for (from, to) in case.edits {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text = text.replace(from, to);
    }
    let mut files = Files::default();
    let file = files.add(File::new(case.name, text));
    let mut scene = scene::parse(&files, file).unwrap().at(case.moment);
    scene.film.size = SIZE;
    scene.film.samples = 1;
    scene.film.sampler = Sampler::Center;
    scene.film.tone_map = ToneMap::None;
    scene.film.gamma = 1.0;
    scene
}

/// Renders with POV-Ray, in linear light with 16 bits.
fn painted(scene: &Scene, name: &str, folder: &Path) -> Image {
    let (source, image_file) = (
        folder.join(format!("{name}.pov")),
        folder.join(format!("{name}.png")),
    );
    fs::write(&source, words::words(scene)).unwrap();
    let [width, height] = scene.film.size;
    let output = Command::new("povray")
        .args([format!("+W{width}"), format!("+H{height}")])
        .arg(format!("+I{}", source.display()))
        .arg(format!("+O{}", image_file.display()))
        .args(["-A", "-D", "+FN16", "File_Gamma=1", "Dither=off", "+WT1"])
        .output()
        .unwrap();
    let reported = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {reported}");
    image::read(&image_file).unwrap()
}

/// The differences of two images.
#[derive(Debug, Default)]
struct Differences {
    /// Pixels that differ by more than 1/255.
    visible: usize,
    /// Pixels that differ by more than the tolerance and lie at an edge.
    edges: usize,
    /// The largest difference elsewhere.
    most: f32,
}

impl Differences {
    fn new(scene: &Scene, theirs: &Image) -> Self {
        let tracer = Tracer::<f64>::new(scene);
        let moved = [[1e-3, 0.0], [-1e-3, 0.0], [0.0, 1e-3], [0.0, -1e-3]].map(|[x, y]| {
            let mut scene = scene.clone();
            // Moved, not turned, so that everything visible moves in the image.
            let points = [Some(&mut scene.camera.eye), scene.camera.look_at.as_mut()];
            for point in points.into_iter().flatten() {
                point[0] += x;
                point[1] += y;
            }
            Tracer::<f64>::new(&scene)
        });
        let ours = tracer.render(|| ());
        let mut apart = Self::default();
        for y in 0..scene.film.size[1] {
            for x in 0..scene.film.size[0] {
                let [at, beside] = [&ours, theirs].map(|image| image.get(x, y));
                let difference = difference(at, beside);
                // Moving the eye by a thousandth, the magnitude of POV-Ray's own tolerances, shows a
                // different surface there.
                let is_edge = || {
                    moved.iter().any(|tracer| {
                        let [r, g, b] = tracer.pixel(x, y).map(|c| c as f32);
                        self::difference(at, [r, g, b, 1.0]) > VISIBLE
                    })
                };
                apart.visible += usize::from(difference > VISIBLE);
                if difference > TOLERANCE && is_edge() {
                    apart.edges += 1;
                } else {
                    apart.most = apart.most.max(difference);
                }
            }
        }
        apart
    }
}

/// The largest difference of a component, of colors clamped to [0, 1].
fn difference(a: [f32; 4], b: [f32; 4]) -> f32 {
    (0..3).fold(0.0, |most, i| {
        most.max((a[i].clamp(0.0, 1.0) - b[i].clamp(0.0, 1.0)).abs())
    })
}

#[test]
fn povray_renders_the_same() {
    if !require_program("povray") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut largest = 0.0f32;
    let mut failed = Vec::new();
    for case in &CASES {
        let scene = scene(case);
        let theirs = painted(&scene, case.name, folder.path());
        let apart = Differences::new(&scene, &theirs);
        eprintln!("{}: {apart:?}", case.name);
        largest = largest.max(apart.most);
        if apart.most > TOLERANCE || apart.edges > MAX_EDGE_PIXELS {
            failed.push(format!("{}: {apart:?}", case.name));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert!(
        TOLERANCE < 4.0 * largest,
        "{TOLERANCE} is more than is needed: {largest}"
    );
}

#[test]
fn different_scenes_are_distinguished() {
    if !require_program("povray") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(&CASES[1]);
    let mut moved = scene.clone();
    moved.lights[0].position[0] += 0.1;
    let theirs = painted(&moved, "moved", folder.path());
    let apart = Differences::new(&scene, &theirs);
    assert!(apart.most > 10.0 * TOLERANCE, "{apart:?}");
}
