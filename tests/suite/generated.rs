//! Generated programs: ours on lavapipe must paint what glslang's and the evaluator paint, to the bit.
//!
//! `TOYPROOF_PROGRAMS` says how many (24), `TOYPROOF_SEED` which (0), `TOYPROOF_FIRST` with which number to begin (0). A program that the
//! driver dies of, as it does of some, is told and counted; it is judged by those that paint it.

use std::cell::RefCell;
use std::fmt::Write;
use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestError, TestRng, TestRunner};
use toyproof::emit::Target;
use toyproof::eval::{Program, Settings};
use toyproof::frame::Frame;
use toyproof::glsl::{Checked, Options, check, lower};
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

/// What is wrong with a program, or with those that paint it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Wrong {
    /// What stays the same while the program is made smaller.
    kind: &'static str,
    words: String,
}

fn wrong(kind: &'static str) -> impl Fn(String) -> Wrong {
    move |words| Wrong { kind, words }
}

/// Those that paint.
struct Judges<'a> {
    worker: Worker,
    folder: &'a Path,
}

impl Judges<'_> {
    /// Whether all who paint a program paint the same; and, in words, on whose SPIR-V the driver died.
    fn judge(&mut self, program: &str) -> Result<Option<String>, Wrong> {
        let checked = checked(program).map_err(wrong("we refuse it"))?;
        let evaluated = evaluated(&checked).map_err(wrong("the evaluator"))?;
        // Not `draw`, which would look for loops that the driver ends by force: these end by themselves.
        let bytes = self
            .worker
            .translate(lower(&checked), Target::Spirv, FloatMode::Strict)
            .map_err(|failure| wrong("ours")(format!("{failure:?}")))?;
        let ours = self.painted(&glslang::words_of(&bytes), FloatMode::Fast);
        let words = glslang::words(program, self.folder).map_err(wrong("glslang refuses it"))?;
        let theirs = self.painted(&words, FloatMode::Strict);
        let mut pictures = vec![("the evaluator's", evaluated)];
        let mut died = String::new();
        for (whose, painted) in [("ours", ours), ("glslang's", theirs)] {
            match painted {
                Ok(picture) => pictures.push((whose, picture)),
                Err(why) => died = format!("{died}{whose}: {why}; "),
            }
        }
        match difference(&pictures) {
            Some(words) => Err(wrong("pixels differ")(words)),
            None => Ok((!died.is_empty()).then_some(died)),
        }
    }

    /// What the driver paints. If it fails, it is asked once more in a new process, where nothing came before.
    fn painted(&mut self, words: &[u32], float: FloatMode) -> Result<Image, String> {
        let first = self.worker.run_spirv(words.to_vec(), frame(), float);
        let Err(failure) = first else {
            return first.map_err(|failure| failure.to_string());
        };
        eprintln!("once more: {failure}");
        self.worker = crate::support::worker().expect("there was one before");
        let second = self.worker.run_spirv(words.to_vec(), frame(), float);
        second.map_err(|failure| failure.to_string())
    }
}

fn checked(program: &str) -> Result<Checked, String> {
    let mut files = Files::default();
    let file = files.add(File::new("program", program));
    check(&files, file, &Options::default()).map_err(|errors| {
        let lines: Vec<_> = errors
            .iter()
            .map(|error| toyproof::diagnostic::short(error, &files))
            .collect();
        lines.join("\n")
    })
}

/// What the evaluator paints, which finds nothing undefined.
fn evaluated(checked: &Checked) -> Result<Image, String> {
    let program = Program::new(checked).map_err(|refusal| refusal.to_string())?;
    let painted = program
        .paint::<f32>(&frame(), &Settings::default())
        .map_err(|failure| failure.to_string())?;
    match painted.painting.undefined() {
        0 => Ok(painted.painting.image()),
        count => Err(format!(
            "{count} pixels are undefined: {:?}",
            painted.observations
        )),
    }
}

/// Where pictures differ first, and how many pixels do.
fn difference(pictures: &[(&str, Image)]) -> Option<String> {
    let differs = |&index: &usize| {
        let mut colours = pictures.iter().map(|(_, picture)| picture.pixels()[index]);
        let first = colours.next();
        colours.any(|colour| Some(colour) != first)
    };
    let differing: Vec<usize> = (0..64).filter(differs).collect();
    let &first = differing.first()?;
    let mut words = format!(
        "{} of 64, the first at ({}, {}):",
        differing.len(),
        first % 8,
        first / 8
    );
    for (whose, picture) in pictures {
        let _ = write!(words, " {whose} {:?}", picture.pixels()[first]);
    }
    Some(words)
}

#[test]
fn glslang_and_the_evaluator_paint_the_same() {
    let Some(worker) = crate::support::worker() else {
        return;
    };
    if !glslang::is_here() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let count: u32 = setting("TOYPROOF_PROGRAMS", 24);
    let seed: u64 = setting("TOYPROOF_SEED", 0);
    let first: u32 = setting("TOYPROOF_FIRST", 0);
    let mut seeds = [0; 32];
    seeds[..8].copy_from_slice(&seed.to_le_bytes());
    let config = Config {
        failure_persistence: None,
        max_shrink_iters: 200,
        ..Config::default()
    };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seeds);
    let mut runner = TestRunner::new_with_rng(config, rng);
    let judges = RefCell::new(Judges {
        worker,
        folder: folder.path(),
    });
    let (mut failures, mut deaths) = (Vec::new(), 0);
    for number in 0..count {
        let tree = programs().new_tree(&mut runner).unwrap();
        if number < first {
            continue;
        }
        let (found, died) = (RefCell::new(None), RefCell::new(None));
        let result = runner.run_one(tree, |program| {
            let wrong = match judges.borrow_mut().judge(&program) {
                Ok(words) => {
                    died.replace(words.map(|words| format!("{words}\n{program}")));
                    return Ok(());
                }
                Err(wrong) => wrong,
            };
            // What is made smaller must not turn into another finding.
            if *found.borrow_mut().get_or_insert(wrong.kind) != wrong.kind {
                return Ok(());
            }
            Err(TestCaseError::fail(format!("{}: {}", wrong.kind, wrong.words)))
        });
        if let Err(TestError::Fail(why, program)) = result {
            eprintln!("program {number} of seed {seed}: {why}\n{program}");
            failures.push(format!("program {number}: {why}"));
        } else if let Some(words) = died.take() {
            eprintln!("program {number} of seed {seed}: the driver died on {words}");
            deaths += 1;
        }
    }
    let told = format!(
        "seed {seed}: {count} programs, {} wrong, the driver died of {deaths}",
        failures.len()
    );
    eprintln!("{told}");
    assert!(failures.is_empty(), "{told}\n{}", failures.join("\n"));
    assert!(50 * deaths <= count, "{told}");
}
