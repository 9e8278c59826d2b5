//! One text through the whole front end, as `toyproof` takes it: preprocess, parse, check, lower, print; then
//! naga's gate.

use std::time::Duration;

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::{Lowered, lower};

use super::{on_a_thread, within};

/// The name of the thread on which naga runs: its panics are not ours.
pub const NAGA: &str = "naga";

/// What came of a text.
#[derive(Debug)]
pub enum Outcome {
    /// It breaks a rule of the language.
    Refused,
    /// naga takes what we made of it.
    Valid,
    /// naga refuses what we made of it or panics, with these words.
    Naga(String),
}

/// As the worker gives it.
const NAGA_STACK: usize = 256 << 20;

/// Judges a text, and what WebGL 2 refuses once more as desktop GLSL.
///
/// # Panics
/// If the front end does, takes more than `allowed` of a processor, or needs more than a small stack.
pub fn judge(text: &str, allowed: Duration) -> Outcome {
    let judged = judge_as(text, false, allowed);
    match judged {
        Outcome::Refused => judge_as(text, true, allowed),
        _ => judged,
    }
}

fn judge_as(text: &str, lenient: bool, allowed: Duration) -> Outcome {
    let options = Options {
        lenient,
        ..Options::default()
    };
    let Some(lowered) = within(allowed, || lowered(text, &options)) else {
        return Outcome::Refused;
    };
    match on_a_thread(NAGA, NAGA_STACK, || ValidModule::parse(&lowered).map(drop)) {
        Ok(Ok(())) => Outcome::Valid,
        Ok(Err(errors)) => Outcome::Naga(format!("refused: {}", errors[0].message)),
        Err(payload) => {
            let words = payload.downcast_ref::<String>().map(String::as_str);
            let words = words.or_else(|| payload.downcast_ref::<&str>().copied());
            Outcome::Naga(format!("panicked: {}", words.unwrap_or_default()))
        }
    }
}

fn lowered(text: &str, options: &Options) -> Option<Lowered> {
    let mut files = Files::default();
    let file = files.add(File::new("input", text));
    Some(lower(&check(&files, file, options).ok()?))
}
