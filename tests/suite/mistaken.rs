//! Classic mistakes are named, and what is right is not.

use std::time::Duration;

use toyproof::eval::{Program, Settings};
use toyproof::frame::Frame;
use toyproof::glsl;
use toyproof::image::Image;
use toyproof::mistake::Suspects;
use toyproof::source::{File, Files};

use crate::planted_faults::faults;
use crate::support::{EVERY_RUNG, MANY_OBJECTS, REFLECTIONS, Rung, SHADING, SPHERE, edited, scene};

fn program(shader: &str) -> Program {
    let mut files = Files::default();
    let file = files.add(File::new("<shader>", shader));
    Program::new(&glsl::check(&files, file, &glsl::Options::default()).unwrap()).unwrap()
}

fn frame(rung: &Rung) -> Frame {
    Frame {
        size: rung.size,
        frame: rung.frame,
        time: rung.time,
        ..Frame::default()
    }
}

fn painted(program: &Program, frame: &Frame) -> Image {
    let painted = program.paint::<f64>(frame, &Settings::default()).unwrap();
    painted.painting.image()
}

/// What a shader is told that is judged by a rung's scene; two mistakes at once are looked for for so many seconds.
fn named(rung: &Rung, suspects: &Suspects, shader: &str, patience: u64) -> String {
    let (program, frame) = (program(shader), frame(rung));
    let wrong = painted(&program, &frame);
    let named = suspects.recognise(&program, &wrong, &frame, Duration::from_secs(patience));
    let names: Vec<_> = named.into_iter().flatten().map(|named| named.name).collect();
    names.join("+")
}

/// Planted faults by their titles, and their names. “No aspect” is what integers make of 16:9 as well.
static NAMES: &[(&Rung, &str, &str)] = &[
    (
        &SPHERE,
        "roots without the division by 2a, as the slide prints them",
        "roots-not-halved",
    ),
    (&SPHERE, "discriminant without its 4", "discriminant-without-4"),
    (&SPHERE, "sign of b", "sign-of-b"),
    (&SPHERE, "radius not squared", "radius-not-squared"),
    (&SPHERE, "square root forgotten", "root-not-taken"),
    (&SPHERE, "direction not normalised", "direction-not-normalised"),
    (&SPHERE, "aspect missing", "no-aspect"),
    (&SPHERE, "aspect upside down", "aspect-upside-down"),
    (&SPHERE, "aspect of integers", "no-aspect"),
    (&SPHERE, "screen at 1", "screen-at-1"),
    (
        &SPHERE,
        "half a pixel added to a coordinate that has it",
        "half-pixel-twice",
    ),
    (&SPHERE, "normal not normalised", "normal-not-normalised"),
    (
        &SPHERE,
        "centre forgotten in the normal",
        "normal-from-the-origin",
    ),
    (&SPHERE, "gamma that nobody asked for", "gamma"),
    (&SPHERE, "red and blue swapped", "blue-is-red"),
    (&SHADING, "far root", "far-root"),
    (&SHADING, "picture upside down", "upside-down"),
    (&SHADING, "from the light to the point", "normal-inwards"),
    (
        &SHADING,
        "light's position taken for a direction",
        "light-from-afar",
    ),
    (
        &SHADING,
        "direction to the light not normalised",
        "light-not-normalised",
    ),
    (&SHADING, "max missing", "cosine-not-clamped"),
    (&SHADING, "absolute value instead of max", "cosine-without-sign"),
    (&SHADING, "normal inward", "normal-inwards"),
    (
        &SHADING,
        "normal not divided by the radius",
        "normal-not-normalised",
    ),
    (&SHADING, "ambient twice", "ambient-per-light"),
    (&SHADING, "ambient missing", "no-ambient"),
    (&SHADING, "ambient with every light", "ambient-per-light"),
    (&SHADING, "ambient not times the colour", "ambient-not-tinted"),
    (&SHADING, "light's colour ignored", "light-without-colour"),
    (&SHADING, "only one light", "first-light-only"),
    (&SHADING, "black background", "black-background"),
    (&MANY_OBJECTS, "shadows skipped", "no-shadows"),
    (
        &MANY_OBJECTS,
        "no ambient in the shadow",
        "shadow-without-ambient",
    ),
    (&MANY_OBJECTS, "first hit instead of the nearest", "first-hit"),
    (
        &MANY_OBJECTS,
        "farthest hit instead of the nearest",
        "farthest-hit",
    ),
    (&MANY_OBJECTS, "the last hit instead of the nearest", "last-hit"),
    (
        &MANY_OBJECTS,
        "shadow rays that see beyond the light",
        "shadow-beyond-the-light",
    ),
    (&MANY_OBJECTS, "samples not averaged", "samples-not-averaged"),
    (&REFLECTIONS, "the last hit instead of the nearest", "last-hit"),
    (
        &REFLECTIONS,
        "reflection without its factor 2",
        "reflection-without-2",
    ),
    (
        &REFLECTIONS,
        "reflection of the opposite direction",
        "reflection-sign",
    ),
    (&REFLECTIONS, "the ray goes through", "no-reflection"),
    (&REFLECTIONS, "throughput added", "mirrors-added"),
    (&REFLECTIONS, "throughput replaced", "last-mirror-only"),
    (&REFLECTIONS, "throughput forgotten", "mirrors-without-colour"),
    (&REFLECTIONS, "only two bounces", "two-bounces-only"),
    (
        &REFLECTIONS,
        "reflected rays from the eye",
        "reflection-from-the-eye",
    ),
    (&REFLECTIONS, "sky upside down", "background-upside-down"),
    (&REFLECTIONS, "sky by y alone", "background-by-y-alone"),
    (
        &REFLECTIONS,
        "sky of the camera's ray",
        "background-of-the-first-ray",
    ),
    (&REFLECTIONS, "first hit instead of the nearest", "first-hit"),
];

#[test]
fn mistakes_are_named() {
    let mut wrong = Vec::new();
    let mut suspects: Option<(&Rung, Suspects)> = None;
    for &(rung, title, name) in NAMES {
        if suspects.as_ref().is_none_or(|(of, _)| !std::ptr::eq(*of, rung)) {
            suspects = Suspects::of(&scene(rung), &frame(rung)).map(|suspects| (rung, suspects));
        }
        let (_, _, edits) = faults()
            .find(|fault| std::ptr::eq(fault.1, rung) && fault.0 == title)
            .unwrap_or_else(|| panic!("{}: no fault `{title}`", rung.name));
        let told = match &suspects {
            Some((_, suspects)) => named(rung, suspects, &edited(rung, edits), 0),
            None => String::new(),
        };
        if told != name {
            wrong.push(format!("{}: {title}: {told}, not {name}", rung.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn two_mistakes_at_once_are_named() {
    let suspects = Suspects::of(&scene(&SPHERE), &frame(&SPHERE)).unwrap();
    let shader = edited(
        &SPHERE,
        &[(" / aspect", ""), ("vec4(color, 1.0)", "vec4(color.bgr, 1.0)")],
    );
    assert_eq!(named(&SPHERE, &suspects, &shader, 0), "");
    assert_eq!(named(&SPHERE, &suspects, &shader, 300), "no-aspect+blue-is-red");
}

/// `cargo test --release --test suite -- --ignored every_fault --nocapture`: what each planted fault is called whose scene can be exported.
#[test]
#[ignore = "takes a minute, and prints a table"]
fn every_fault_and_its_name() {
    let mut told = Vec::new();
    for rung in EVERY_RUNG {
        let Some(suspects) = Suspects::of(&scene(rung), &frame(rung)) else {
            continue;
        };
        for (title, _, edits) in faults().filter(|fault| std::ptr::eq(fault.1, rung)) {
            let name = named(rung, &suspects, &edited(rung, edits), 0);
            eprintln!("{}: {title}: {name}", rung.name);
            told.push(name);
        }
    }
    let count = told.iter().filter(|name| !name.is_empty()).count();
    eprintln!("{count} of {} have a name", told.len());
}

#[test]
fn what_is_right_has_no_name() {
    for rung in EVERY_RUNG {
        if let Some(suspects) = Suspects::of(&scene(rung), &frame(rung)) {
            assert_eq!(named(rung, &suspects, rung.shader, 300), "", "{}", rung.name);
        }
    }
}
