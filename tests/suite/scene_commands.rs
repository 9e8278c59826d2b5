//! Scenes by name, and `toyproof new scene`.

use std::fs;
use std::path::Path;

use toyproof::diagnostic::{File, Files};
use toyproof::scene;

use crate::program::toyproof;
use crate::support::SPHERE;

/// The reference of the scene format.
const REFERENCE: &str = "docs/guide/scenes.md";

#[test]
fn built_in_scenes_are_accepted_by_name_and_files_come_first() {
    let folder = tempfile::tempdir().unwrap();
    let render = |scene: &str, image: &str| {
        let run = toyproof(folder.path(), &["render", scene, "-o", image, "--size", "16x9"]);
        assert_eq!(run.code, 0, "{scene}: {}", run.stderr);
        fs::read(folder.path().join(image)).unwrap()
    };
    let by_name = render("02-sphere", "name.png");
    assert_eq!(by_name, render("02-sphere.toml", "extension.png"));
    // A file of that name is preferred.
    fs::write(
        folder.path().join("02-sphere.toml"),
        "[background]\ncolor = [1, 1, 1]\n",
    )
    .unwrap();
    assert_ne!(by_name, render("02-sphere.toml", "file.png"));
    assert_eq!(by_name, render("02-sphere", "name.png"));

    fs::write(folder.path().join("s.glsl"), SPHERE.shader).unwrap();
    let run = toyproof(
        folder.path(),
        &[
            "check",
            "s.glsl",
            "--scene",
            "02-sphere",
            "--device",
            "cpu",
            "--size",
            "64x36",
        ],
    );
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
    let run = toyproof(folder.path(), &["export", "06-reflections", "-o", "mirrors.glsl"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(!run.stderr.contains("left out"), "{}", run.stderr);
}

#[test]
fn export_lists_what_a_scene_requires_and_what_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let run = toyproof(
        folder.path(),
        &["export", "06-reflections", "-o", "mirrors.glsl", "-v"],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    // Lines may be wrapped.
    let words = run.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    for text in [
        "the scene requires spheres only, ",
        "secondary rays",
        "left out: ",
        "ray splitting at glass (no surface is glass)",
        "motion (nothing moves)",
    ] {
        assert!(words.contains(text), "{text}: {words}");
    }
    let (required, left_out) = words.split_once("left out: ").unwrap();
    assert!(
        !required.contains("glass") && !left_out.contains("secondary rays"),
        "{words}"
    );
}

#[test]
fn a_missing_scene_is_one_error_for_all_commands() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.glsl"), SPHERE.shader).unwrap();
    fs::write(folder.path().join("b.glsl"), "void mainImage(").unwrap();
    for (scene, help) in [
        ("02-spere", "did you mean the built-in scene `02-sphere`?"),
        ("sphere.toml", "did you mean the built-in scene `02-sphere`?"),
        ("2", "`toyproof scenes` lists the built-in scenes"),
        ("nosuch.toml", "`toyproof scenes` lists the built-in scenes"),
    ] {
        for arguments in [
            &["check", ".", "--out", "out", "--scene", scene][..],
            &["render", scene, "-o", "x.png"],
            &["export", scene, "-o", "x.glsl"],
            &["trade", scene, "-o", "out"],
        ] {
            let run = toyproof(folder.path(), arguments);
            assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{arguments:?}");
            let expected = format!("error: no such file or built-in scene: {scene}\nhelp: {help}\n");
            assert_eq!(run.stderr, expected, "{arguments:?}");
        }
    }
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        2,
        "nothing is written"
    );
}

#[test]
fn an_invalid_scene_stops_the_check_of_all_shaders() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.glsl"), SPHERE.shader).unwrap();
    fs::write(folder.path().join("s.toml"), "[[spher]]\nradius = 1\n").unwrap();
    let run = toyproof(folder.path(), &["check", "a.glsl", "--scene", "s.toml"]);
    assert_eq!((run.code, run.stdout.as_str()), (2, ""));
    assert!(
        run.stderr.contains("unknown table [[spher]]") && run.stderr.contains("did you mean [[sphere]]?"),
        "{}",
        run.stderr
    );
    let run = toyproof(folder.path(), &["check", "a.glsl", "--scene", "a.glsl"]);
    assert_eq!((run.code, run.stdout.as_str()), (2, ""));
    assert!(run.stderr.contains("a.glsl is a shader"), "{}", run.stderr);
}

#[test]
fn a_new_scene_renders_and_its_shader_is_correct() {
    let folder = tempfile::tempdir().unwrap();
    let run = toyproof(folder.path(), &["new", "scene", "week 1"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stderr.contains("created week 1.toml")
            && run
                .stderr
                .contains("toyproof render \"week 1.toml\" -o \"week 1.png\""),
        "{}",
        run.stderr
    );
    let text = fs::read_to_string(folder.path().join("week 1.toml")).unwrap();
    assert!(text.contains("title = \"week 1\""));

    let size = ["--size", "160x90"];
    let run = toyproof(
        folder.path(),
        &[&["render", "week 1.toml", "-o", "w.png"], &size[..]].concat(),
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    let run = toyproof(folder.path(), &["export", "week 1.toml", "-o", "week 1.glsl"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let run = toyproof(
        folder.path(),
        &[&["check", "week 1.glsl", "--device", "cpu"], &size[..]].concat(),
    );
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
}

#[test]
fn ill_conditioned_scenes_are_reported_with_the_edit_that_cures_them() {
    let folder = tempfile::tempdir().unwrap();
    let floor = "[camera]\neye = [0.0, 0.0, 0.0]\n\
                 [[plane]]\npoint = [0.0, -1.037, 0.0]\nmaterial = { model = \"emitter\", color = [1.0, 1.0, 1.0], \
                 checker = { color = [0.0, 0.0, 0.0], size = 1.0 } }\n";
    let path = |name: &str| folder.path().join(name);
    fs::write(path("floor.toml"), floor).unwrap();
    let export = ["export", "floor.toml", "-o", "floor.glsl"];
    assert_eq!(toyproof(folder.path(), &export).code, 0);
    fs::copy(path("floor.glsl"), path("other.glsl")).unwrap();
    let render = |size: &str| {
        let run = toyproof(
            folder.path(),
            &["render", "floor.toml", "-o", "floor.png", "--size", size],
        );
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stderr
    };
    // The eye is above an edge of the tiles, and in images of odd width a column of pixels is.
    assert!(!render("160x90").contains("ill-conditioned"));
    let warning = "warning: floor.toml is ill-conditioned at 161×90: rounding decides";
    let help =
        "help: move the eye from [0.0, 0.0, 0.0] to [0.0013, 0.0009, 0.0005], or choose another --size";
    let message = render("161x90");
    assert!(message.contains(warning), "{message}");

    // Its own shader is right in both sizes, and the warning is printed once.
    let check = [
        "check",
        "floor.glsl",
        "other.glsl",
        "--scene",
        "floor.toml",
        "--device",
        "cpu",
        "--size",
    ];
    for size in ["160x90", "161x90"] {
        let run = toyproof(folder.path(), &[&check[..], &[size]].concat());
        assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
        let count = run.stderr.matches("ill-conditioned").count();
        assert_eq!(count, usize::from(size == "161x90"), "{}", run.stderr);
    }
    let run = toyproof(
        folder.path(),
        &[
            "check",
            "floor.glsl",
            "--reference",
            "other.glsl",
            "--device",
            "cpu",
            "--size",
            "161x90",
        ],
    );
    let warning = "warning: other.glsl is ill-conditioned at 161×90";
    assert!(run.code == 0 && run.stderr.contains(warning), "{}", run.stderr);
    assert!(message.contains(help), "{message}");
    let cured = floor.replace("eye = [0.0, 0.0, 0.0]", "eye = [0.0013, 0.0009, 0.0005]");
    fs::write(path("floor.toml"), cured).unwrap();
    assert!(!render("161x90").contains("ill-conditioned"));
}

#[test]
fn a_new_scene_never_overwrites() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.toml"), "mine").unwrap();
    for arguments in [
        &["new", "scene", "mine"][..],
        &["new", "scene", "mine.toml"],
        &["new", "scene", "x", "-o", "mine.toml"],
    ] {
        let run = toyproof(folder.path(), arguments);
        assert_eq!(run.code, 2, "{arguments:?}");
        assert!(run.stderr.contains("mine.toml already exists"), "{}", run.stderr);
    }
    assert_eq!(
        fs::read_to_string(folder.path().join("mine.toml")).unwrap(),
        "mine"
    );
    for name in ["", "../x", "a/b", "-x", "a\"b"] {
        assert_eq!(toyproof(folder.path(), &["new", "scene", name]).code, 2, "{name}");
    }
    let run = toyproof(folder.path(), &["new", "scene", "other", "-o", "-"]);
    assert!(
        run.code == 0 && run.stdout.contains("title = \"other\""),
        "{}",
        run.stderr
    );
}

#[test]
fn examples_of_the_reference_are_scenes_and_its_images_exist() {
    let page = fs::read_to_string(REFERENCE).unwrap();
    let examples: Vec<_> = page
        .split("```toml\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap())
        .collect();
    assert!(examples.len() >= 3, "{}", examples.len());
    for text in examples {
        let mut files = Files::default();
        let file = files.add(File::new("example.toml", text));
        scene::parse(&files, file).unwrap();
    }
    let folder = Path::new(REFERENCE).parent().unwrap();
    let images: Vec<_> = page
        .split("](../images/")
        .skip(1)
        .map(|rest| rest.split(')').next().unwrap())
        .collect();
    assert!(images.len() > 15, "{}", images.len());
    for image in images {
        assert!(folder.join("../images").join(image).is_file(), "{image}");
    }
}
