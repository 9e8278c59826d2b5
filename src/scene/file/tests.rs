use toyproof_diagnostic::{Diagnostic, File, short};

use super::super::*;
use super::*;

fn read(text: &str) -> Result<Scene, Vec<String>> {
    let mut files = Files::default();
    let file = files.add(File::new("s.toml", text));
    // `s.toml:1:2: error[E0501]: message; help: …`
    let one_line = |one: &Diagnostic| [vec![short(one, &files)], one.notes.clone()].concat().join("; ");
    parse(&files, file).map_err(|errors| errors.iter().map(one_line).collect())
}

const SPHERE: &str =
    "[[sphere]]\ncenter = [0, 0, -6.0]\nradius = 1.5\nmaterial = { model = \"facing\", color = [1, 1, 0] }\n";

#[test]
fn missing_keys_have_defaults() {
    let scene = read("[background]").unwrap();
    assert_eq!(
        scene.film,
        Film {
            size: [640, 360],
            samples: 1,
            sampler: Sampler::Center,
            max_depth: 1,
            integrator: Integrator::Whitted,
            tone_map: ToneMap::None,
            gamma: 1.0,
        }
    );
    assert_eq!(
        scene.camera,
        Camera {
            eye: [0.0; 3],
            projection: Projection::Pinhole { screen_distance: 2.0 },
        }
    );
    assert_eq!(scene.background, Background::Uniform([0.0; 3]));
    assert_eq!(scene.max_offset, 1e-3);
}

#[test]
fn an_empty_scene_is_reported_once() {
    for text in ["", "title = \"soon\"\n[film]\nsize = [4, 4]\n"] {
        let errors = read(text).unwrap_err();
        assert!(
            errors[0].starts_with("s.toml:1:1: error[E0502]") && errors[0].contains("[[sphere]]"),
            "{errors:?}"
        );
    }
    assert_eq!(read("[film]\nsamples = 0").unwrap_err().len(), 1);
    assert!(read("[background]\ncolor = [1, 1, 1]").is_ok());
}

#[test]
fn max_offset_must_be_positive() {
    assert_eq!(
        read("max_offset = 0.01\n[background]\n").unwrap().max_offset,
        0.01
    );
    assert!(read("max_offset = 0.0\n").is_err());
}

#[test]
fn a_complete_scene_is_read_as_written() {
    let scene = read(&format!(
        "title = \"t\"\nambient = [0.1, 0.2, 0.3]\n[film]\nsize = [4, 2]\nsamples = 3\nsampler = \"sine-hash\"\nmax_depth = 9\n\
         tone_map = \"reinhard\"\ngamma = 2.2\n\
         [camera]\neye = [1.0, 2.0, 3.0]\nscreen_distance = 1.5\n[background]\nbottom = [0, 0, 0]\ntop = [1, 1, 1]\n\
         [[light]]\nposition = [5, 5, 0]\nshadow = false\n{SPHERE}"
    ))
    .unwrap();
    assert_eq!(
        scene.film,
        Film {
            size: [4, 2],
            samples: 3,
            sampler: Sampler::SineHash,
            max_depth: 9,
            integrator: Integrator::Whitted,
            tone_map: ToneMap::Reinhard,
            gamma: 2.2,
        }
    );
    assert_eq!(
        scene.background,
        Background::Gradient {
            bottom: [0.0; 3],
            top: [1.0; 3]
        }
    );
    assert_eq!(
        scene.lights[0],
        Light {
            position: [5.0, 5.0, 0.0],
            color: [1.0; 3],
            shadow: false,
            radius: 0.0,
            motion: None,
        }
    );
    let center = [0.0, 0.0, -6.0];
    assert_eq!(scene.objects[0].shape, Shape::Sphere { center, radius: 1.5 });
    assert_eq!(scene.objects[0].material.model, Model::Facing);
}

const PROBES: &[&str] = &[
    "[film]\nsise = [1, 1]",
    "[[sphere]]\ncentre = [0, 0, -6]\ncenter = [0, 0, 1]\nradius = 1\n$M",
    "[[sphere]]\ncentr = [0, 0, -6]\nradius = 1\n$M",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nhue = 2\n$M",
    "[[sphere]]\ncenter = [0, 0, -6]\n$M",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\n",
    "[[sphere]]\ncenter = [0, 0]\nradius = 1\n$M",
    "[[sphere]]\ncenter = [0, 0, \"-6\"]\nradius = \"1.5\"\n$M",
    "[[sphere]]\ncenter = \"here\"\nradius = true\n$M",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = -1\n$M",
    "[[sphere]]\ncenter = [0, nan, -6]\nradius = inf\n$M",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { model = \"phong\", color = [1, 1, 1] }",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { model = \"lambrt\", color = [1, 1, 1] }",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { color = [1, 1, 1] }",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = \"mirror\"",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { model = \"mirror\", color = [1, 1, 1], roughness = 0.5 }",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { model = \"disney\", color = [1, 1, 1], roughness = 2 }",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { model = \"glossy\", color = [1, 1, 1] }",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { model = \"mirror\", color = [1, -1, 1] }",
    "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\nmaterial = { model = \"glass\", color = [1, 1, 1], ior = 1.5, fresnel = \"schlik\" }",
    "[sphere]\nradius = 1",
    "[[film]]\nsamples = 1",
    "film = 3",
    "sphere = 3",
    "[[box]]\nsize = 1",
    "[shpere]\nradius = 1",
    "titel = \"x\"",
    "[film]\nmax_offset = 0.01",
    "[film]\nsamples = 1.5",
    "[film]\nsamples = 0",
    "[film]\nsize = [0, 0]",
    "[film]\nsize = [100000, 100000]",
    "[film]\nsampler = \"sobel\"",
    "[film]\ngamma = 0",
    "[camera]\nprojection = \"parallel\"\nscreen_distance = 2",
    "[background]\ntop = [1, 1, 1]",
    "[[figure]]\noutline = \"disk\"\ncenter = [0, 0]\ncolor = [1, 1, 1]",
    "[[figure]]\noutline = \"wave\"\ncolor = [1, 1, 1]\nheight = 0\namplitude = 1\nfrequency = 1\nsize = 1",
    "[[figure]]\ncolor = [1, 1, 1]",
    "[[light]]\nposition = [0, 0, 0]\nradius = 1\n$S",
    "[[light]]\nposition = [0, 0, 0]\nshadow = 1\n$S",
    "[[motion]]\nname = \"a\"\nframes = 1\nseconds = 1",
    "[[motion]]\nname = \"a\"",
    "[[motion]]\nname = \"a\"\nframes = 0",
    "[[motion]]\nname = \"a\"\nframes = 1\nwithin = \"b\"",
    "[[motion]]\nname = \"orbit\"\nframes = 1\n[[light]]\nposition = [0, 0, 0]\nmotion = \"orbti\"",
    "[[motion]]\nname = \"a\"\nframes = 1\n[[light]]\nposition = [0, 0, 0]\nmotion = \"b\"",
    "[[motion]]\nname = \"a\"\nframes = 1\naxis = [0, 0, 0]",
    "[[motion]]\nname = \"a\"\nframes = 1\n[[motion]]\nname = \"a\"\nframes = 2",
    "[[ellipsoid]]\ncenter = [0, 0, 0]\nradii = [1, 0, 1]\n$M",
    "[[hyperboloid]]\ncenter = [0, 0, 0]\nwaist = 2\nradius = 1\nheight = 1\n$M",
    "[[scatter]]\ncorner = [0, 0, 0]\ncells = [1000, 1000, 1000]\nspacing = 1\nradius = [0.1, 0.2]\n$M",
    "[[scatter]]\ncorner = [0, 0, 0]\ncells = [1, 0, 1]\nspacing = 1\nradius = [0.1, 0.2]\n$M",
    "[[scatter]]\ncorner = [0, 0, 0]\ncells = [1, 1, 1]\nspacing = 1\nradius = [0.1, 0.7]\n$M",
    "[[scatter]]\ncorner = [0, 0, 0]\ncells = [1, 1, 1]\nspacing = 1\nradius = [0.2, 0.1]\n$M",
    "[[plane]]\npoint = [0, -1, 0]\nmaterial = { model = \"glass\", color = [1, 1, 1], ior = 1.5 }",
    "[film]\nmax_depth = 17\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = { model = \"glass\", color = [1, 1, 1], ior = 1.5 }",
    "ambient = [1, 1, 1]\n[film]\nintegrator = \"path\"\nsampler = \"sobol\"\n[background]",
    "[film]\nintegrator = \"path\"\n$S",
    "[film]\nintegrator = \"path\"\nsampler = \"sobol\"\n[[light]]\nposition = [0, 0, 0]\n$S",
    "[film]\nintegrator = \"path\"\nsampler = \"sobol\"\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = { model = \"lambert\", color = [1, 1, 1] }",
    "[film]\nintegrator = \"path\"\nsampler = \"sobol\"\n[[plane]]\npoint = [0, 0, 0]\nmaterial = { model = \"emitter\", color = [1, 1, 1] }",
    "ambient = [inf, 0, 0]\nmax_offset = 0\n[film]\nsamples = 0\nmax_depth = 0",
    "title = \"a\"\n",
    "title = ",
    "title = \"abc\n[film]",
    "title = abc",
    "title = “abc”",
    "[film\nsamples = 1",
    "[[sphere]\nradius = 1",
    "[film]\nsamples: 4",
    "[film]\nsamples 4",
    "// a comment",
    "max_offset = 0,01",
    "[camera]\neye = (0, 0, 1)",
    "[camera]\neye = 0, 0, 1",
    "[camera]\neye = [0 0 1]",
    "[camera]\neye = [0, 0, 1\nwidth = 2",
    "[camera]\neye = [0,, 1]",
    "max_offset = .01",
    "max_offset = 1.",
    "max_offset = 0.01f",
    "max_offset = 1;",
    "max_offset = 01",
    "[film]\nsamples = 1\nsamples = 2",
    "[film]\n[camera]\n[film]",
    "[sphere]\nradius = 1\n[[sphere]]\nradius = 2",
    "[film] samples = 1",
    "[[light]]\nshadow = True",
    "[[light]]\nshadow = null",
    "x = { a = 1 b = 2 }",
    "x = { a = 1\ny = 2",
    "= 3",
    "{ \"title\": \"x\" }",
    "[]",
    "title = \"C:\\\\q\"",
    "x == 1",
    "]",
    "a = 99999999999999999999\nb = 0xfffffffffffffffff",
    "[film]\nsamples = 99999999999999999999",
    "max_offset = 1e999",
    "a = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
];

#[test]
fn probe() {
    let m = "material = { model = \"mirror\", color = [1, 1, 1] }\n";
    let s = format!("[[sphere]]\ncenter = [0, 0, -6]\nradius = 1\n{m}");
    for text in PROBES {
        let text = text.replace("$M", m.trim()).replace("$S", &s);
        println!("{text:?}\n    {:?}", read(&text).err());
    }
}
#[test]
fn all_values_out_of_range_are_reported_together() {
    assert_eq!(
        read("ambient = [inf, 0, 0]\n[film]\nsamples = 0\nmax_depth = 0")
            .unwrap_err()
            .len(),
        3
    );
}
