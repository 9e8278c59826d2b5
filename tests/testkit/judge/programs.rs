//! A random program, evaluated and interpreted.

use std::time::Duration;

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::image::Frame;

use super::within;
use crate::generate::{self, Arithmetic, Effects};
use crate::interpreter::{Comparison, POLICIES, Tally};

/// The most steps of the interpreter for a pixel.
const MAX_STEPS: u64 = 200_000;

/// Width and height of the image, all of whose pixels are compared.
const SIZE: [u32; 2] = [4, 4];

/// The program that these bytes decide: the first what it may contain.
#[must_use]
pub fn program(bytes: &[u8]) -> String {
    let (first, rest) = bytes.split_first().unwrap_or((&0, &[]));
    let effects = if first & 1 == 0 {
        Effects::Ordered
    } else {
        Effects::Anywhere
    };
    let arithmetic = if first & 2 == 0 {
        Arithmetic::Exact
    } else {
        Arithmetic::Any
    };
    generate::program(rest, effects, arithmetic)
}

/// Compares the program that these bytes decide with one treatment of undefined operations, which the first byte
/// selects. Returns the program and what was compared.
///
/// # Panics
/// If the program is invalid, if the evaluator and the interpreter differ in a bit, or if checking it takes more than
/// `allowed` of a processor.
pub fn judge(bytes: &[u8], allowed: Duration) -> (String, Tally) {
    let policy = POLICIES[usize::from(bytes.first().unwrap_or(&0) >> 2) % POLICIES.len()];
    let text = program(bytes);
    let mut files = Files::default();
    let file = files.add(File::new("program", &*text));
    let checked = within(allowed, || check(&files, file, &Options::default()));
    let checked = checked.unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    let frame = Frame {
        size: SIZE,
        time: 2.5,
        frame: 7,
        ..Frame::default()
    };
    let [width, height] = SIZE;
    let pixels: Vec<[u32; 2]> = (0..width * height).map(|at| [at % width, at / width]).collect();
    let comparison = Comparison {
        checked: &checked,
        frame: &frame,
        policy,
        pixels: &pixels,
        max_steps: MAX_STEPS,
    };
    let tally = comparison.run().unwrap_or_else(|error| panic!("{error}\n{text}"));
    (text, tally)
}
