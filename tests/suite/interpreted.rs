//! The evaluator against a plain interpreter of the tree, bit by bit: in f32 and f64, with each treatment of undefined
//! operations.
//!
//! `TOYPROOF_PROGRAMS` sets the number of random programs (200), `TOYPROOF_SEED` their seed (0).

use std::fs;

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{self, Checked, Options};
use toyproof::image::{Frame, pcg};

use crate::support::interpreter::{Comparison, POLICIES, Tally};
use crate::support::judge::programs;
use crate::support::setting;
use crate::support::wait::HANG_GUARD;

const MAX_STEPS: u64 = 2_000_000;

fn checked(name: &str, text: &str) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new(name, text));
    glsl::check(&files, file, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn compare(checked: &Checked, frame: &Frame, pixels: &[[u32; 2]]) -> Result<Tally, String> {
    let mut tally = Tally::default();
    for policy in POLICIES {
        let comparison = Comparison {
            checked,
            frame,
            policy,
            pixels,
            max_steps: MAX_STEPS,
        };
        tally.add(comparison.run()?);
    }
    Ok(tally)
}

#[test]
fn the_course_is_interpreted_to_the_bit() {
    let frame = Frame {
        size: [64, 36],
        time: 1.25,
        frame: 75,
        ..Frame::default()
    };
    let pixels = [[0, 0], [63, 35], [31, 18], [20, 14], [44, 9]];
    let mut tally = Tally::default();
    for entry in fs::read_dir("glsl").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "glsl") {
            let text = fs::read_to_string(&path).unwrap();
            let compared = compare(&checked(&path.display().to_string(), &text), &frame, &pixels);
            tally.add(compared.unwrap_or_else(|error| panic!("{}: {error}", path.display())));
        }
    }
    eprintln!("the course: {tally}");
    assert!(tally.skipped.is_empty(), "{tally}");
}

#[test]
fn random_programs_are_interpreted_to_the_bit() {
    let count: u32 = setting("TOYPROOF_PROGRAMS", 200);
    let seed: u32 = setting("TOYPROOF_SEED", 0);
    let mut tally = Tally::default();
    let mut state = pcg(seed);
    let mut random = || {
        state = pcg(state);
        state
    };
    for _ in 0..count {
        let length = 8 + random() as usize % 900;
        let bytes: Vec<u8> = (0..length).map(|_| (random() >> 13) as u8).collect();
        tally.add(programs::judge(&bytes, HANG_GUARD).1);
    }
    eprintln!("{count} programs: {tally}");
    assert!(tally.compared > 64 * u64::from(count), "{tally}");
}
