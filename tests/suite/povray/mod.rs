//! The reference tracer beside POV-Ray 3.7, which shares no code with it.

mod words;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use toyproof::diagnostic::{File, Files};
use toyproof::image::{self, Image};
use toyproof::scene::{self, Moment, Sampler, Scene, ToneMap};
use toyproof::tracer::Tracer;

const SIZE: [u32; 2] = [320, 180];

/// POV-Ray's pictures have 16 bits, and so are off by half of 1/65535 at most, 7.6e-6. Mirrored in a mirror that is
/// mirrored in others, its "tolerances" of 1e-3 and less show: 5.8e-5 at most in a pixel of `quadrics`.
const TOLERANCE: f32 = 1e-4;
/// A grey level.
const VISIBLE: f32 = 1.0 / 255.0;
/// Pixels of a picture in which the two may see different surfaces.
const MOST_EDGES: usize = 2;

/// A scene that both paint.
struct Case {
    name: &'static str,
    scene: &'static str,
    /// What POV-Ray has no words for, and what stands in its place.
    edits: &'static [(&'static str, &'static str)],
    moment: Moment,
}

macro_rules! case {
    ($folder:literal, $name:literal) => {
        Case {
            name: $name,
            scene: include_str!(concat!($folder, $name, ".toml")),
            edits: &[],
            moment: Moment { frame: 0, time: 0.0 },
        }
    };
}

/// The course's scenes that POV-Ray has words for, and some of our own.
static CASES: [Case; 15] = [
    case!("../../../glsl/", "02-sphere"),
    case!("../../../glsl/", "03-shading"),
    case!("../../../glsl/", "04-many-objects"),
    Case {
        moment: Moment { frame: 10, time: 0.0 },
        ..case!("../../../glsl/", "05-complex-scene")
    },
    case!("../../../glsl/", "06-reflections"),
    case!("../../../glsl/", "07-diffuse"),
    case!("../../../glsl/", "10-quadrics"),
    Case {
        moment: Moment { frame: 37, time: 1.3 },
        ..case!("../../../glsl/", "11-animation")
    },
    Case {
        // What tinted glass lets through is another product there.
        edits: &[("color = [0.95, 1.0, 0.95], ior", "color = [1, 1, 1], ior")],
        ..case!("../../../glsl/", "12-whitted")
    },
    case!("../../../glsl/", "14-accelerator"),
    case!("../../../glsl/", "15-parallel-rays"),
    case!("", "facing"),
    case!("", "glass"),
    case!("", "mirrors"),
    case!("", "quadrics"),
];

/// Whether it is installed.
fn is_here() -> bool {
    let found = Command::new("povray")
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok();
    if !found {
        eprintln!("skipped: no povray here; Debian has a package of that name");
    }
    found
}

/// The scene where it is at that moment, one sample in the middle of each pixel, as linear light.
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

/// What POV-Ray paints, in linear light of 16 bits.
fn painted(scene: &Scene, name: &str, folder: &Path) -> Image {
    let (source, picture) = (
        folder.join(format!("{name}.pov")),
        folder.join(format!("{name}.png")),
    );
    fs::write(&source, words::words(scene)).unwrap();
    let [width, height] = scene.film.size;
    let output = Command::new("povray")
        .args([format!("+W{width}"), format!("+H{height}")])
        .arg(format!("+I{}", source.display()))
        .arg(format!("+O{}", picture.display()))
        .args(["-A", "-D", "+FN16", "File_Gamma=1", "Dither=off", "+WT1"])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {told}");
    image::read(&picture).unwrap()
}

/// What a comparison found.
#[derive(Debug, Default)]
struct Apart {
    /// Pixels that differ by more than 1/255.
    visible: usize,
    /// Pixels that differ by more than the tolerance and lie at an edge.
    edges: usize,
    /// The largest difference elsewhere.
    most: f32,
}

impl Apart {
    fn new(scene: &Scene, theirs: &Image) -> Self {
        let tracer = Tracer::<f64>::new(scene);
        let moved = [[1e-3, 0.0], [-1e-3, 0.0], [0.0, 1e-3], [0.0, -1e-3]].map(|[x, y]| {
            let mut scene = scene.clone();
            scene.camera.eye[0] += x;
            scene.camera.eye[1] += y;
            Tracer::<f64>::new(&scene)
        });
        let ours = tracer.picture(|| ());
        let mut apart = Self::default();
        for y in 0..scene.film.size[1] {
            for x in 0..scene.film.size[0] {
                let [at, beside] = [&ours, theirs].map(|picture| picture.get(x, y));
                let difference = difference(at, beside);
                // The eye a thousandth to the side, as far as POV-Ray's own tolerances reach, sees another surface there.
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

/// Of colours clamped to [0, 1], by the component that differs most.
fn difference(a: [f32; 4], b: [f32; 4]) -> f32 {
    (0..3).fold(0.0, |most, i| {
        most.max((a[i].clamp(0.0, 1.0) - b[i].clamp(0.0, 1.0)).abs())
    })
}

#[test]
fn povray_paints_the_same() {
    if !is_here() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut largest = 0.0f32;
    let mut failed = Vec::new();
    for case in &CASES {
        let scene = scene(case);
        let theirs = painted(&scene, case.name, folder.path());
        let apart = Apart::new(&scene, &theirs);
        eprintln!("{}: {apart:?}", case.name);
        largest = largest.max(apart.most);
        if apart.most > TOLERANCE || apart.edges > MOST_EDGES {
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
fn another_scene_is_told_apart() {
    if !is_here() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(&CASES[1]);
    let mut moved = scene.clone();
    moved.lights[0].position[0] += 0.1;
    let theirs = painted(&moved, "moved", folder.path());
    let apart = Apart::new(&scene, &theirs);
    assert!(apart.most > 10.0 * TOLERANCE, "{apart:?}");
}
