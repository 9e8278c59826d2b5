//! Classic mistakes are named, and what is right is not.

use std::time::Duration;

use toyproof::diagnostic::{File, Files};
use toyproof::eval::Program;
use toyproof::glsl;
use toyproof::image::Frame;
use toyproof::verify::compare::Verdict;
use toyproof::verify::mistake::Suspects;

use crate::equivalent_rewrites::rewrites;
use crate::fair_verdicts::glass;
use crate::planted_faults::faults;
use crate::support::{
    EVERY_RUNG, REFLECTIONS, Rung, SPHERE, WHITTED, edit, edited, judged_with_names, scene, try_edit,
};

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

/// What a shader is told that is judged by a rung's scene; of two mistakes at once, so many are looked at.
fn named(rung: &Rung, suspects: &Suspects, shader: &str, pairs: usize) -> String {
    let (program, frame) = (program(shader), frame(rung));
    let named = suspects.recognise(&program, &frame, pairs);
    let names: Vec<_> = named.into_iter().flatten().map(|named| named.name).collect();
    names.join("+")
}

/// What each planted fault is called: `rung: fault: name`, a `-` where it has no name, and a `?` before one that is not what went wrong.
/// What paints the same picture has the same name, whichever of its causes the fault is.
const NAMES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/mistaken.txt");

/// At least this share of all faults is to be named rightly.
const NAMED: f64 = 0.9;

/// The faults of a rung, each with what it is told.
fn told(rung: &Rung) -> Vec<String> {
    let suspects = Suspects::of(&scene(rung), &frame(rung)).unwrap();
    let own = faults().filter(|fault| std::ptr::eq(fault.1, rung));
    let told = own.map(|(title, _, edits)| {
        let name = named(rung, &suspects, &edited(rung, edits), 0);
        let name = if name.is_empty() { "-" } else { &name };
        format!("{}: {title}: {name}", rung.name)
    });
    told.collect()
}

#[test]
fn mistakes_are_named() {
    let names = std::fs::read_to_string(NAMES).unwrap();
    let mut told = EVERY_RUNG.into_iter().flat_map(told);
    let mut wrong = Vec::new();
    for line in names.lines() {
        let expected = line.replace(": ?", ": ");
        let told = told.next().unwrap_or_default();
        if told != expected {
            wrong.push(format!("{told}\n    not {expected}"));
        }
    }
    wrong.extend(told);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let is_right = |line: &&str| !line.ends_with(": -") && !line.contains(": ?");
    let (right, all) = (names.lines().filter(is_right).count(), names.lines().count());
    assert!(
        right as f64 >= NAMED * all as f64,
        "{right} of {all} are named rightly"
    );
}

#[test]
fn two_mistakes_at_once_are_named() {
    let suspects = Suspects::of(&scene(&SPHERE), &frame(&SPHERE)).unwrap();
    let shader = edited(
        &SPHERE,
        &[(" / aspect", ""), ("vec4(color, 1.0)", "vec4(color.bgr, 1.0)")],
    );
    assert_eq!(named(&SPHERE, &suspects, &shader, 0), "");
    assert_eq!(
        named(&SPHERE, &suspects, &shader, usize::MAX),
        "blue-is-red+no-aspect"
    );
}

/// Where secondary rays start otherwise than in the exported shader, the rims of glass are other pixels than those of its mistakes.
#[test]
fn mistakes_are_named_wherever_rays_start() {
    let suspects = Suspects::of(&scene(&WHITTED), &frame(&WHITTED)).unwrap();
    let style = glass("along the normal", 2e-4);
    for (title, name) in [
        ("Schlick instead of Fresnel", "schlick-for-fresnel"),
        ("checker in one direction", "checker-in-one-direction"),
        ("sign in Snell's law", "refraction-sign"),
    ] {
        let fault = faults().find(|fault| fault.0 == title && std::ptr::eq(fault.1, &raw const WHITTED));
        let (_, _, edits) = fault.expect("it is a planted fault");
        let shader = try_edit(&edited(&WHITTED, edits), &style).unwrap();
        assert_eq!(named(&WHITTED, &suspects, &shader, 0), name, "{title}");
    }
}

/// A mistake that shows in so few pixels that the verdict is `correct` is told of there.
#[test]
fn a_mistake_that_explains_the_few_pixels_that_differ_is_told_of() {
    let in_few = Rung {
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
    let findings = judged_with_names(&one_short, &in_few);
    assert_eq!(findings.verdict, Verdict::Correct, "{}", findings.reason);
    let says = "they are what a tracer paints that follows one reflection";
    assert!(findings.reason.contains(says), "{}", findings.reason);
    let right = edited(&REFLECTIONS, &[("DEPTH = 100", "DEPTH = 5")]);
    let findings = judged_with_names(&right, &in_few);
    assert!(!findings.reason.contains("they are what"), "{}", findings.reason);
}

/// `cargo test --release --test suite -- --ignored every_fault --nocapture`: what each planted fault is called, as `mistaken.txt` has it.
#[test]
#[ignore = "prints a table"]
fn every_fault_and_its_name() {
    let only = std::env::var("RUNG").unwrap_or_default();
    for rung in EVERY_RUNG.into_iter().filter(|rung| rung.name.contains(&only)) {
        let start = std::time::Instant::now();
        for line in told(rung) {
            eprintln!("{line}");
        }
        eprintln!("# {:?}", start.elapsed());
    }
}

/// Of all pairs of a rung's faults every so many are tried.
const STEP: usize = 23;

/// `cargo test --release --test suite -- --ignored pairs_of_faults --nocapture`: two planted faults at once, how they are named, and in
/// how much time. `RUNG` chooses rungs.
#[test]
#[ignore = "prints a table"]
fn pairs_of_faults_and_their_names() {
    let only = std::env::var("RUNG").unwrap_or_default();
    let (mut all, mut explained, mut right) = (0, 0, 0);
    let (mut longest, mut spent) = (Duration::ZERO, Duration::ZERO);
    for rung in EVERY_RUNG.into_iter().filter(|rung| rung.name.contains(&only)) {
        let suspects = Suspects::of(&scene(rung), &frame(rung)).unwrap();
        let own: Vec<_> = faults().filter(|fault| std::ptr::eq(fault.1, rung)).collect();
        let alone: Vec<String> = own
            .iter()
            .map(|(_, _, edits)| named(rung, &suspects, &edited(rung, edits), 0))
            .collect();
        let pairs = (0..own.len()).flat_map(|one| (one + 1..own.len()).map(move |other| (one, other)));
        for (one, other) in pairs.step_by(STEP) {
            let Ok(both) = try_edit(&edited(rung, own[one].2), own[other].2) else {
                continue;
            };
            let start = std::time::Instant::now();
            let name = named(rung, &suspects, &both, usize::MAX);
            let took = start.elapsed();
            (longest, spent) = (longest.max(took), spent + took);
            let mut names: Vec<_> = name.split('+').collect();
            names.sort_unstable();
            let mut own_names = [alone[one].as_str(), &alone[other]];
            own_names.sort_unstable();
            all += 1;
            explained += usize::from(!name.is_empty());
            right += usize::from(names == own_names);
            eprintln!("{took:5.2?} {}: {own_names:?}: {name}", rung.name);
        }
    }
    eprintln!(
        "{explained} of {all} pairs are explained, {right} by their own names; {spent:.1?} in all, {longest:.1?} at most"
    );
}

/// Not even those of which a few pixels are others, since their secondary rays start in another style; the verdict is not asked here.
#[test]
fn what_is_right_has_no_name() {
    let mut named_so = Vec::new();
    let mut suspects: Option<(&Rung, Suspects)> = None;
    let mut all: Vec<_> = rewrites().collect();
    all.sort_by_key(|(_, rung, _)| rung.name);
    for (title, rung, edits) in all {
        if suspects.as_ref().is_none_or(|(of, _)| !std::ptr::eq(*of, rung)) {
            suspects = Suspects::of(&scene(rung), &frame(rung)).map(|suspects| (rung, suspects));
        }
        let (_, suspects) = suspects
            .as_ref()
            .expect("the scene can be painted in little time");
        let name = named(rung, suspects, &edited(rung, edits), 100);
        if !name.is_empty() {
            named_so.push(format!("{}: {title}: {name}", rung.name));
        }
    }
    assert!(named_so.is_empty(), "{}", named_so.join("\n"));
}
