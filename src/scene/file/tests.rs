use toyproof_diagnostic::{Diagnostic, File};

use super::super::*;
use super::*;

fn read(text: &str) -> Result<Scene, Vec<String>> {
    let mut files = Files::default();
    let file = files.add(File::new("s.toml", text));
    parse(&files, file).map_err(|errors| errors.iter().map(|one| described(one, &files)).collect())
}

/// `line:column code message`, and the notes on lines of their own.
fn described(error: &Diagnostic, files: &Files) -> String {
    let at = files.position(error.span.unwrap());
    let notes = error.notes.iter().map(|note| format!("\n    {note}"));
    let helps = error.helps.iter().map(|help| format!("\n    help: {help}"));
    let notes: Vec<_> = notes.chain(helps).collect();
    format!(
        "{}:{} {} {}{}",
        at.line,
        at.column,
        error.code,
        error.message,
        notes.concat()
    )
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
            look_at: None,
            up: [0.0, 1.0, 0.0],
            roll: 0.0,
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
            errors[0].starts_with("1:1 E0502 the scene is empty\n") && errors[0].contains("[[sphere]]"),
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

/// Scenes with errors, separated by empty lines; below each, its errors.
const BROKEN_SCENES: &str = include_str!("broken_scenes.txt");

#[test]
fn each_error_has_its_place_message_and_advice() {
    let mut count = 0;
    for block in BROKEN_SCENES.split("\n\n") {
        let (text, expected) = block.split_once("\n--> ").unwrap();
        let errors = read(text).map(|_| ()).unwrap_err();
        assert_eq!(errors.join("\n--> "), expected.trim_end(), "{text}");
        count += 1;
    }
    assert!(count > 80, "{count}");
}

#[test]
fn scenes_cut_or_changed_anywhere_are_read_or_reported() {
    for block in BROKEN_SCENES.split("\n\n") {
        let (text, _) = block.split_once("\n--> ").unwrap();
        for (at, _) in text.char_indices() {
            let (before, after) = text.split_at(at);
            let _ = read(before);
            for inserted in ["“", "\"", "[", "{", "=", ",", "\r", "\u{1}", "\n"] {
                let _ = read(&format!("{before}{inserted}{after}"));
            }
        }
    }
}

#[test]
fn only_the_first_of_many_errors_are_reported() {
    let lines: Vec<_> = (0..1000).map(|key| format!("unknown{key} = 1\n")).collect();
    let errors = read(&lines.concat()).unwrap_err();
    assert_eq!(errors.len(), 20);
    assert!(
        errors[19].contains("980 more errors are not shown"),
        "{}",
        errors[19]
    );
}

#[test]
fn british_spellings_of_keys_are_accepted() {
    let british = SPHERE.replace("center", "centre").replace("color", "colour");
    assert_ne!(british, SPHERE);
    assert_eq!(read(&british), read(SPHERE));
}

#[test]
fn numbers_may_be_written_as_integers_of_any_radix() {
    let scene = read("max_offset = 0x10\n[film]\nsamples = 0b11\nsize = [1_0, 2]\n[background]\n").unwrap();
    assert_eq!(
        (scene.max_offset, scene.film.samples, scene.film.size),
        (16.0, 3, [10, 2])
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
