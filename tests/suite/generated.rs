//! Generated programs: ours on lavapipe must paint what glslang's paints, to the bit.
//!
//! `TOYPROOF_PROGRAMS` says how many (24), `TOYPROOF_SEED` which (0).

use std::fmt::Write;
use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestError, TestRng, TestRunner};
use toyproof::emit::Target;
use toyproof::frame::Frame;
use toyproof::glsl::{Options, check, lower};
use toyproof::gpu::{FloatMode, Worker};
use toyproof::image::Image;
use toyproof::source::{File, Files};

use crate::support::setting;
use crate::{generate, glslang};

/// Programs that are as long as the decisions that they are made of.
fn programs() -> impl Strategy<Value = String> {
    (8_usize..2000)
        .prop_flat_map(|length| vec(any::<u8>(), length / 2..=length))
        .prop_map(|bytes| generate::program(&bytes))
}

fn frame() -> Frame {
    Frame {
        size: [8, 8],
        time: 2.5,
        frame: 7,
        ..Frame::default()
    }
}

fn ours(worker: &mut Worker, program: &str) -> Result<Image, String> {
    let mut files = Files::default();
    let file = files.add(File::new("program", program));
    let checked = check(&files, file, &Options::default()).map_err(|errors| {
        let lines: Vec<_> = errors
            .iter()
            .map(|error| toyproof::diagnostic::short(error, &files))
            .collect();
        format!("we refuse it: {}", lines.join("\n"))
    })?;
    // Not `draw`, which would look for loops that the driver ends by force: these end by themselves.
    let bytes = worker.translate(lower(&checked), Target::Spirv, FloatMode::Strict);
    let bytes = bytes.map_err(|failure| format!("ours: {failure:?}"))?;
    let painted = worker.run_spirv(glslang::words_of(&bytes), frame(), FloatMode::Fast);
    painted.map_err(|failure| format!("ours: {failure:?}"))
}

fn theirs(worker: &mut Worker, program: &str, folder: &Path) -> Result<Image, String> {
    let words = glslang::words(program, folder).map_err(|words| format!("glslang refuses it: {words}"))?;
    let painted = worker.run_spirv(words, frame(), FloatMode::Strict);
    painted.map_err(|failure| format!("glslang's: {failure}"))
}

fn judge(worker: &mut Worker, program: &str, folder: &Path) -> Result<(), String> {
    let (ours, theirs) = (ours(worker, program)?, theirs(worker, program, folder)?);
    let differ = |&(left, right): &(&[f32; 4], &[f32; 4])| left != right;
    let pairs = || ours.pixels().iter().zip(theirs.pixels());
    match pairs().position(|pair| differ(&pair)) {
        None => Ok(()),
        Some(first) => {
            let (left, right) = (ours.pixels()[first], theirs.pixels()[first]);
            let count = pairs().filter(differ).count();
            Err(format!(
                "{count} pixels differ, first ({}, {}): ours {left:?}, glslang's {right:?}",
                first % 8,
                first / 8
            ))
        }
    }
}

#[test]
fn glslang_paints_the_same() {
    let Some(mut worker) = crate::support::worker() else {
        return;
    };
    if !glslang::is_here() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let count: u32 = setting("TOYPROOF_PROGRAMS", 24);
    let seed: u64 = setting("TOYPROOF_SEED", 0);
    let mut seeds = [0; 32];
    seeds[..8].copy_from_slice(&seed.to_le_bytes());
    let config = Config {
        failure_persistence: None,
        max_shrink_iters: 200,
        ..Config::default()
    };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seeds);
    let mut runner = TestRunner::new_with_rng(config, rng);
    let worker = std::cell::RefCell::new(&mut worker);
    let mut failures = String::new();
    for number in 0..count {
        let tree = programs().new_tree(&mut runner).unwrap();
        let result = runner.run_one(tree, |program| {
            judge(&mut worker.borrow_mut(), &program, folder.path()).map_err(TestCaseError::fail)
        });
        if let Err(TestError::Fail(why, program)) = result {
            let _ = writeln!(failures, "program {number} of seed {seed}: {why}\n{program}");
            eprintln!("program {number} of seed {seed}: {why}\n{program}");
        }
    }
    assert!(failures.is_empty(), "{failures}");
}
