use toyproof_diagnostic::{File, short};

use super::super::*;
use super::*;

fn read(text: &str) -> Result<Scene, Vec<String>> {
    let mut files = Files::default();
    let file = files.add(File::new("s.toml", text));
    parse(&files, file).map_err(|diagnostics| diagnostics.iter().map(|d| short(d, &files)).collect())
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

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn each_error_has_its_line_column_and_expectation() {
    for (text, place, message) in [
        (
            "[film]\nsise = [1, 1]",
            "s.toml:2:1: error[E0501]",
            "unknown field `sise`, expected one of",
        ),
        ("[sphere]\nradius = 1", "s.toml:1:1: error[E0501]", "[[sphere]]"),
        ("[[film]]\nsamples = 1", "s.toml:1:1: error[E0501]", "[film]"),
        (
            "[film]\nsamples = 1.5",
            "s.toml:2:11: error[E0501]",
            "a whole number",
        ),
        (
            "[camera]\neye = [0, 0]",
            "s.toml:2:7: error[E0501]",
            "array of length 3",
        ),
        ("[camera]\neye = \"here\"", "s.toml:2:7: error[E0501]", "expected"),
        (
            "[camera]\neye = [0, nan, 0]",
            "s.toml:2:7: error[E0502]",
            "finite",
        ),
        (
            "[camera]\nscreen_distance = -1",
            "s.toml:2:19: error[E0502]",
            "above 0, not -1",
        ),
        (
            "[film]\nsize = [0, 0]",
            "s.toml:2:8: error[E0502]",
            "at least 1 pixel",
        ),
        (
            "[film]\nsize = [100000, 100000]",
            "s.toml:2:8: error[E0502]",
            "too large",
        ),
        (
            "[film]\nsamples = 0",
            "s.toml:2:11: error[E0502]",
            "from 1 to 65536, not 0",
        ),
        (
            "[film]\nsampler = \"sobel\"",
            "s.toml:2:11: error[E0501]",
            "unknown variant `sobel`",
        ),
        (
            "[background]\ntop = [1, 1, 1]",
            "s.toml:1:1: error[E0502]",
            "a bottom and a top",
        ),
        (
            "ambient = [-1, 0, 0]",
            "s.toml:1:11: error[E0502]",
            "none below 0",
        ),
        ("title = ", "s.toml:1:9: error[E0501]", ""),
        ("[film]\ngamma = 0", "s.toml:2:9: error[E0502]", "above 0, not 0"),
        (
            "[film]\ntone_map = \"filmic\"",
            "s.toml:2:12: error[E0501]",
            "unknown variant `filmic`",
        ),
        (
            "[camera]\nprojection = \"parallel\"\nscreen_distance = 2",
            "s.toml:3:19: error[E0502]",
            "screen_distance belongs to \"pinhole\", not to \"parallel\"",
        ),
        (
            "[[figure]]\noutline = \"disk\"\ncenter = [0, 0]\ncolor = [1, 1, 1]",
            "s.toml:2:11: error[E0502]",
            "radius is missing",
        ),
        (
            "[[figure]]\noutline = \"wave\"\ncolor = [1, 1, 1]\nheight = 0\namplitude = 1\nfrequency = 1\nsize = 1",
            "s.toml:7:8: error[E0502]",
            "size belongs to \"heart\"",
        ),
        (
            "[[light]]\nposition = [0, 0, 0]\nradius = 1",
            "s.toml:3:10: error[E0502]",
            "needs a film whose sampler draws",
        ),
        (
            "[[motion]]\nname = \"a\"\nframes = 1\nseconds = 1",
            "s.toml:2:8: error[E0502]",
            "either frames or seconds",
        ),
        (
            "[[motion]]\nname = \"a\"\nframes = 0",
            "s.toml:3:10: error[E0502]",
            "other than 0",
        ),
        (
            "[[motion]]\nname = \"a\"\nframes = 1\nwithin = \"a\"",
            "s.toml:4:10: error[E0502]",
            "no motion is called \"a\": there is none before here",
        ),
        (
            "[[motion]]\nname = \"a\"\nframes = 1\n[[light]]\nposition = [0, 0, 0]\nmotion = \"b\"",
            "s.toml:6:10: error[E0502]",
            "expected \"a\"",
        ),
        (
            "[[motion]]\nname = \"a\"\nframes = 1\naxis = [0, 0, 0]",
            "s.toml:4:8: error[E0502]",
            "not all of them 0",
        ),
        (
            "[[ellipsoid]]\ncenter = [0, 0, 0]\nradii = [1, 0, 1]\nmaterial = { model = \"mirror\", color = [1, 1, 1] }",
            "s.toml:3:9: error[E0502]",
            "three finite numbers above 0",
        ),
        (
            "[[hyperboloid]]\ncenter = [0, 0, 0]\nwaist = 2\nradius = 1\nheight = 1\n\
             material = { model = \"mirror\", color = [1, 1, 1] }",
            "s.toml:3:9: error[E0502]",
            "waist must be smaller",
        ),
        (
            "[[scatter]]\ncorner = [0, 0, 0]\ncells = [1000, 1000, 1000]\nspacing = 1\nradius = [0.1, 0.2]\n\
             material = { model = \"mirror\", color = [1, 1, 1] }",
            "s.toml:3:9: error[E0502]",
            "whose product is from 1",
        ),
        (
            "[[plane]]\npoint = [0, -1, 0]\nmaterial = { model = \"glass\", color = [1, 1, 1], ior = 1.5 }",
            "s.toml:3:22: error[E0502]",
            "glass needs an inside",
        ),
        (
            "[[plane]]\npoint = [0, -1, 0]\nmaterial = { model = \"mirror\", color = [1, 1, 1], roughness = 0.5 }",
            "s.toml:3:63: error[E0502]",
            "roughness belongs to \"disney\", not to \"mirror\"",
        ),
        (
            "[[plane]]\npoint = [0, -1, 0]\nmaterial = { model = \"disney\", color = [1, 1, 1], roughness = 2 }",
            "s.toml:3:63: error[E0502]",
            "from 0 to 1, not 2",
        ),
        (
            "[film]\nmax_depth = 17\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
             material = { model = \"glass\", color = [1, 1, 1], ior = 1.5 }",
            "s.toml:2:13: error[E0502]",
            "at most 16",
        ),
        (
            "ambient = [1, 1, 1]\n[film]\nintegrator = \"path\"",
            "s.toml:1:11: error[E0502]",
            "no ambient light",
        ),
        (
            "[film]\nintegrator = \"path\"\nsampler = \"sobol\"\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
             material = { model = \"lambert\", color = [1, 1, 1] }",
            "s.toml:7:22: error[E0502]",
            "knows the models",
        ),
    ] {
        let errors = read(text).unwrap_err();
        assert!(
            errors[0].starts_with(place) && errors[0].contains(message),
            "{text}: {errors:?}"
        );
        assert!(!errors[0].contains('\n'));
    }
    let radius = read(&SPHERE.replace("1.5", "0.0")).unwrap_err();
    assert!(
        radius[0].starts_with("s.toml:3:10: error[E0502]: radius must be"),
        "{radius:?}"
    );
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
