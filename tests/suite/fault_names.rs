//! Known mistakes are named, and correct shaders are not blamed.

use toyproof::explain::known::Hypotheses;
use toyproof::verify::Verdict;

use crate::fair_verdicts::glass;
use crate::support::faults::{self, faults, hypotheses, name, named_faults};
use crate::support::rewrites::rewrites;
use crate::support::{
    EVERY_EXERCISE, Exercise, REFLECTIONS, SPHERE, WHITTED, check_and_name_on_cpu, edit, edited, try_edit,
};

/// The name of each planted fault: `exercise: fault: name`, with `-` where it has no name, and `?` before a
/// name that is not the actual fault. Faults that render the same image have the same name, whatever their
/// cause. `cargo xtask fault-names` prints the table without the question marks.
const NAMES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/fault_names.txt");

/// The minimum share of all faults that must be named correctly.
const MIN_NAMED_SHARE: f64 = 0.9;

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
    let hypotheses = hypotheses(&SPHERE);
    let shader = edited(
        &SPHERE,
        &[(" / aspect", ""), ("vec4(color, 1.0)", "vec4(color.bgr, 1.0)")],
    );
    assert_eq!(name(&SPHERE, &hypotheses, &shader, 0), "");
    assert_eq!(
        name(&SPHERE, &hypotheses, &shader, usize::MAX),
        "red-blue-swapped+no-aspect"
    );
}

/// If secondary rays start elsewhere than in the exported shader, the pixels at the rims of glass differ from
/// those of its mutants.
#[test]
fn mistakes_are_named_wherever_rays_start() {
    let hypotheses = hypotheses(&WHITTED);
    let style = glass("along the normal", 2e-4);
    for (title, expected) in [
        ("Schlick instead of Fresnel", "schlick-instead-of-fresnel"),
        ("checker in one direction", "checker-stripes"),
        ("sign in Snell's law", "refraction-sign"),
    ] {
        let fault = faults().find(|fault| fault.0 == title && std::ptr::eq(fault.1, &raw const WHITTED));
        let (_, _, edits) = fault.expect("it is a planted fault");
        let shader = try_edit(&edited(&WHITTED, edits), &style).unwrap();
        assert_eq!(name(&WHITTED, &hypotheses, &shader, 0), expected, "{title}");
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
    let diagnosis = findings.tolerated_mistake.unwrap();
    assert_eq!(diagnosis.id(), "one-bounce-fewer", "{diagnosis:?}");
    let right = edited(&REFLECTIONS, &[("DEPTH = 100", "DEPTH = 5")]);
    let findings = check_and_name_on_cpu(&right, &in_few);
    assert_eq!(findings.tolerated_mistake, None);
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
            hypotheses = Some((exercise, faults::hypotheses(exercise)));
        }
        let (_, hypotheses) = hypotheses.as_ref().expect("it is there now");
        let name = name(exercise, hypotheses, &edited(exercise, edits), 100);
        if !name.is_empty() {
            named_so.push(format!("{}: {title}: {name}", exercise.name));
        }
    }
    assert!(named_so.is_empty(), "{}", named_so.join("\n"));
}
