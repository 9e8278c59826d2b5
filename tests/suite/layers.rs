//! `render --layers`: EXR files with depth, normals and the like.

use std::path::Path;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, Text, read};
use toyproof::tracer::{BACKGROUND_DEPTH, Layers};

use crate::program::toyproof;

/// The names of the channels of a file, and the samples of one of them, top row first.
fn channels(path: &Path, wanted: &str) -> (Vec<String>, FlatSamples) {
    let reader = read().no_deep_data().largest_resolution_level().all_channels();
    let file = reader
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .unwrap();
    let list = file.layer_data.channel_data.list;
    let names = list.iter().map(|channel| channel.name.to_string()).collect();
    let channel = list.into_iter().find(|channel| channel.name.eq(wanted)).unwrap();
    (names, channel.sample_data)
}

#[test]
fn layers_are_beside_the_colors_which_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let render = |output: &str, more: &[&str]| {
        let arguments = [&["render", "02-sphere", "-o", output, "--size", "33x17"], more].concat();
        let run = toyproof(folder, &arguments);
        assert_eq!(run.code, 0, "{}", run.stderr);
    };
    render("plain.exr", &[]);
    render("layers.exr", &["--layers"]);
    let image = |name: &str| toyproof::image::read(&folder.join(name)).unwrap();
    assert_eq!(image("plain.exr"), image("layers.exr"));

    let path = folder.join("layers.exr");
    let (names, depth) = channels(&path, "Z");
    assert_eq!(
        names,
        [
            "A", "Albedo.B", "Albedo.G", "Albedo.R", "B", "G", "Normal.X", "Normal.Y", "Normal.Z", "R", "Z",
            "id"
        ]
    );
    let (_, id) = channels(&path, "id");
    let (FlatSamples::F32(depth), FlatSamples::U32(id)) = (depth, id) else {
        panic!("the depth is a float, and the number an integer");
    };
    // The sphere of this scene, of radius 1.5, is straight ahead at a distance of 6.
    assert_eq!((depth[8 * 33 + 16], id[8 * 33 + 16]), (4.5, 1));
    assert_eq!((depth[0], id[0]), (BACKGROUND_DEPTH, 0));

    let reader = read().no_deep_data().largest_resolution_level().all_channels();
    let file = reader
        .first_valid_layer()
        .all_attributes()
        .from_file(&path)
        .unwrap();
    let own = &file.layer_data.attributes;
    let text = |text: &str| Some(Text::from(text));
    assert_eq!(
        own.software_name,
        text(&format!("toyproof {}", env!("CARGO_PKG_VERSION")))
    );
    assert_eq!(own.comments, text(Layers::DESCRIPTION));
    let command = format!("{:?}", own.other[&Text::from("command")]);
    assert!(
        command.contains("toyproof render 02-sphere -o layers.exr --size 33x17 --layers"),
        "{command}"
    );
    let scene = format!("{:?}", own.other[&Text::from("scene")]);
    assert!(scene.contains("02-sphere"), "{scene}");
}

#[test]
fn several_samples_have_a_variance() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let flags = [
        "--size",
        "16x9",
        "--samples",
        "4",
        "--sampler",
        "sobol",
        "--layers",
        "--precision",
        "f32",
    ];
    let run = toyproof(
        folder,
        &[&["render", "09-soft-shadows", "-o", "soft.exr"], &flags[..]].concat(),
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    let (names, variance) = channels(&folder.join("soft.exr"), "variance.G");
    assert!(names.contains(&"variance.R".to_owned()), "{names:?}");
    let FlatSamples::F32(variance) = variance else {
        panic!("a variance is a float");
    };
    assert!(variance.iter().all(|&variance| variance >= 0.0));
    assert!(
        variance.iter().any(|&variance| variance > 1e-3),
        "penumbras and edges"
    );
}

#[test]
fn only_exr_files_of_a_fixed_number_of_samples_have_layers() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, expected) in [
        (&["-o", "a.png", "--layers"][..], "write one with -o a.exr"),
        (
            &["-o", "a.exr", "--layers", "--max-error", "0.1"],
            "cannot be used with",
        ),
    ] {
        let run = toyproof(folder.path(), &[&["render", "02-sphere"], arguments].concat());
        assert_eq!(run.code, 2);
        assert!(run.stderr.contains(expected), "{}", run.stderr);
        assert!(!folder.path().join(arguments[1]).exists());
    }
}
