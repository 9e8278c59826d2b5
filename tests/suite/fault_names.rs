//! Known mistakes are named, and correct shaders are not blamed.

use std::time::Duration;

use toyproof::diagnostic::{File, Files};
use toyproof::eval::Program;
use toyproof::glsl;
use toyproof::image::Frame;
use toyproof::verify::Verdict;
use toyproof::verify::mistake::Hypotheses;

use crate::equivalent_rewrites::rewrites;
use crate::fair_verdicts::glass;
use crate::planted_faults::faults;
use crate::support::{
    EVERY_EXERCISE, Exercise, REFLECTIONS, SPHERE, WHITTED, check_and_name_on_cpu, edit, edited, scene,
    try_edit,
};

fn program(shader: &str) -> Program {
    let mut files = Files::default();
    let file = files.add(File::new("<shader>", shader));
    Program::new(&glsl::check(&files, file, &glsl::Options::default()).unwrap()).unwrap()
}

fn frame(exercise: &Exercise) -> Frame {
    Frame {
        size: exercise.size,
        frame: exercise.frame,
        time: exercise.time,
        ..Frame::default()
    }
}

/// The name of the mistake that explains a shader's image for an exercise's scene; at most `pairs` pairs of
/// mistakes are tried.
fn named(exercise: &Exercise, hypotheses: &Hypotheses, shader: &str, pairs: usize) -> String {
    let (program, frame) = (program(shader), frame(exercise));
    let named = hypotheses.recognize(&program, &frame, pairs);
    let names: Vec<_> = named.into_iter().flatten().map(|named| named.name).collect();
    names.join("+")
}

/// The name of each planted fault: `exercise: fault: name`, with `-` where it has no name, and `?` before a
/// name that is not the actual fault. Faults that render the same image have the same name, whatever their
/// cause.
const NAMES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/fault_names.txt");

/// The minimum share of all faults that must be named correctly.
const MIN_NAMED_SHARE: f64 = 0.9;

/// The faults of an exercise, each with its reported name.
fn named_faults(exercise: &Exercise) -> Vec<String> {
    let hypotheses = Hypotheses::of(&scene(exercise), &frame(exercise)).unwrap();
    let own = faults().filter(|fault| std::ptr::eq(fault.1, exercise));
    let faults = own.map(|(title, _, edits)| {
        let name = named(exercise, &hypotheses, &edited(exercise, edits), 0);
        let name = if name.is_empty() { "-" } else { &name };
        format!("{}: {title}: {name}", exercise.name)
    });
    faults.collect()
}

#[test]
fn mistakes_are_named() {
    let names = std::fs::read_to_string(NAMES).unwrap();
    let mut actual = EVERY_EXERCISE.into_iter().flat_map(named_faults);
    let mut wrong = Vec::new();
    for line in names.lines() {
        let expected = line.replace(": ?", ": ");
        let actual_name = actual.next().unwrap_or_default();
        if actual_name != expected {
            wrong.push(format!("{actual_name}\n    not {expected}"));
        }
    }
    wrong.extend(actual);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let is_right = |line: &&str| !line.ends_with(": -") && !line.contains(": ?");
    let (right, all) = (names.lines().filter(is_right).count(), names.lines().count());
    assert!(
        right as f64 >= MIN_NAMED_SHARE * all as f64,
        "{right} of {all} are named rightly"
    );
}

#[test]
fn two_mistakes_at_once_are_named() {
    let hypotheses = Hypotheses::of(&scene(&SPHERE), &frame(&SPHERE)).unwrap();
    let shader = edited(
        &SPHERE,
        &[(" / aspect", ""), ("vec4(color, 1.0)", "vec4(color.bgr, 1.0)")],
    );
    assert_eq!(named(&SPHERE, &hypotheses, &shader, 0), "");
    assert_eq!(
        named(&SPHERE, &hypotheses, &shader, usize::MAX),
        "blue-is-red+no-aspect"
    );
}

/// If secondary rays start elsewhere than in the exported shader, the pixels at the rims of glass differ from
/// those of its mutants.
#[test]
fn mistakes_are_named_wherever_rays_start() {
    let hypotheses = Hypotheses::of(&scene(&WHITTED), &frame(&WHITTED)).unwrap();
    let style = glass("along the normal", 2e-4);
    for (title, name) in [
        ("Schlick instead of Fresnel", "schlick-for-fresnel"),
        ("checker in one direction", "checker-in-one-direction"),
        ("sign in Snell's law", "refraction-sign"),
    ] {
        let fault = faults().find(|fault| fault.0 == title && std::ptr::eq(fault.1, &raw const WHITTED));
        let (_, _, edits) = fault.expect("it is a planted fault");
        let shader = try_edit(&edited(&WHITTED, edits), &style).unwrap();
        assert_eq!(named(&WHITTED, &hypotheses, &shader, 0), name, "{title}");
    }
}

/// A mistake that affects so few pixels that the verdict is `correct` is still reported.
#[test]
fn mistakes_in_few_pixels_are_reported() {
    let in_few = Exercise {
        scene: edit(
            REFLECTIONS.scene,
            &[("max_depth = 100", "max_depth = 5")],
            "scene",
        )
        .leak(),
        size: [160, 90],
        ..REFLECTIONS
    };
    let one_short = edited(&REFLECTIONS, &[("DEPTH = 100", "DEPTH = 4")]);
    let findings = check_and_name_on_cpu(&one_short, &in_few);
    assert_eq!(findings.verdict, Verdict::Correct, "{:?}", findings.reason);
    let mistake = findings.tolerated_mistake.unwrap();
    assert!(mistake.says.starts_with("follows one reflection"), "{mistake:?}");
    let right = edited(&REFLECTIONS, &[("DEPTH = 100", "DEPTH = 5")]);
    let findings = check_and_name_on_cpu(&right, &in_few);
    assert_eq!(findings.tolerated_mistake, None);
}

/// `cargo test --release --test suite -- --ignored every_fault --nocapture` prints the name of each planted
/// fault in the format of `fault_names.txt`.
#[test]
#[ignore = "prints a table"]
fn every_fault_and_its_name() {
    let only = std::env::var("EXERCISE").unwrap_or_default();
    for exercise in EVERY_EXERCISE
        .into_iter()
        .filter(|exercise| exercise.name.contains(&only))
    {
        let start = std::time::Instant::now();
        for line in named_faults(exercise) {
            eprintln!("{line}");
        }
        eprintln!("# {:?}", start.elapsed());
    }
}

/// Every `STEP`th pair of an exercise's faults is tried.
const PAIR_STEP: usize = 23;

/// `cargo test --release --test suite -- --ignored pairs_of_faults --nocapture` prints the names of pairs of
/// planted faults, and the time taken. `EXERCISE` selects exercises.
#[test]
#[ignore = "prints a table"]
fn pairs_of_faults_and_their_names() {
    let only = std::env::var("EXERCISE").unwrap_or_default();
    let (mut all, mut explained, mut right) = (0, 0, 0);
    let (mut longest, mut spent) = (Duration::ZERO, Duration::ZERO);
    for exercise in EVERY_EXERCISE
        .into_iter()
        .filter(|exercise| exercise.name.contains(&only))
    {
        let hypotheses = Hypotheses::of(&scene(exercise), &frame(exercise)).unwrap();
        let own: Vec<_> = faults().filter(|fault| std::ptr::eq(fault.1, exercise)).collect();
        let alone: Vec<String> = own
            .iter()
            .map(|(_, _, edits)| named(exercise, &hypotheses, &edited(exercise, edits), 0))
            .collect();
        let pairs = (0..own.len()).flat_map(|one| (one + 1..own.len()).map(move |other| (one, other)));
        for (one, other) in pairs.step_by(PAIR_STEP) {
            let Ok(both) = try_edit(&edited(exercise, own[one].2), own[other].2) else {
                continue;
            };
            let start = std::time::Instant::now();
            let name = named(exercise, &hypotheses, &both, usize::MAX);
            let took = start.elapsed();
            (longest, spent) = (longest.max(took), spent + took);
            let mut names: Vec<_> = name.split('+').collect();
            names.sort_unstable();
            let mut own_names = [alone[one].as_str(), &alone[other]];
            own_names.sort_unstable();
            all += 1;
            explained += usize::from(!name.is_empty());
            right += usize::from(names == own_names);
            eprintln!("{took:5.2?} {}: {own_names:?}: {name}", exercise.name);
        }
    }
    eprintln!(
        "{explained} of {all} pairs are explained, {right} by their own names; {spent:.1?} in all, {longest:.1?} at most"
    );
}

/// This includes those of which a few pixels differ, because their secondary rays start at other offsets; the
/// verdict is not checked here.
#[test]
fn correct_shaders_have_no_mistake() {
    let mut named_so = Vec::new();
    let mut hypotheses: Option<(&Exercise, Hypotheses)> = None;
    let mut all: Vec<_> = rewrites().collect();
    all.sort_by_key(|(_, exercise, _)| exercise.name);
    for (title, exercise, edits) in all {
        if hypotheses
            .as_ref()
            .is_none_or(|(of, _)| !std::ptr::eq(*of, exercise))
        {
            hypotheses =
                Hypotheses::of(&scene(exercise), &frame(exercise)).map(|hypotheses| (exercise, hypotheses));
        }
        let (_, hypotheses) = hypotheses
            .as_ref()
            .expect("the scene can be painted in little time");
        let name = named(exercise, hypotheses, &edited(exercise, edits), 100);
        if !name.is_empty() {
            named_so.push(format!("{}: {title}: {name}", exercise.name));
        }
    }
    assert!(named_so.is_empty(), "{}", named_so.join("\n"));
}
