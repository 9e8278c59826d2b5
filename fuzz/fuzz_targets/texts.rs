//! What the targets share: a panic of ours ends the run, one of naga's is told once.

use std::collections::HashSet;
use std::panic;
use std::path::PathBuf;
use std::sync::{LazyLock, Mutex};
use std::time::Duration;
use std::{env, fs, thread};

use toyproof_testkit::judge::front_end::{self, NAGA, Outcome};

/// Lets naga panic; in the worker it may. To be called once libFuzzer's own hook, which aborts, is in place.
pub(crate) fn spare_naga() {
    let abort = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if thread::current().name() != Some(NAGA) {
            abort(info);
        }
    }));
}

/// What the front end may take of a processor: a constant and a share of the size. Macros may make up to 2^20
/// tokens of a line, so where there are any the constant is larger.
fn allowance(text: &str) -> Duration {
    let constant = if text.contains("define") { 4000 } else { 100 };
    Duration::from_millis(constant) + Duration::from_micros(20) * text.len() as u32
}

/// Judges a text; the first of each kind that naga refuses or panics on is kept in the folder that `NAGA_FINDINGS` names.
pub(crate) fn run(text: &str) {
    static TOLD: LazyLock<Mutex<HashSet<String>>> = LazyLock::new(Mutex::default);
    let Outcome::Naga(words) = front_end::judge(text, allowance(text)) else {
        return;
    };
    // Names and numbers apart, the same words tell of the same thing.
    let shape: String = words.chars().filter(|c| !c.is_ascii_digit()).take(60).collect();
    let mut told = TOLD.lock().expect("no holder panics");
    if !told.insert(shape.clone()) {
        return;
    }
    eprintln!("naga {words}");
    if let Some(folder) = env::var_os("NAGA_FINDINGS").map(PathBuf::from) {
        let name = shape.replace(|c: char| !c.is_ascii_alphabetic(), "-");
        let kept = fs::create_dir_all(&folder)
            .and_then(|()| fs::write(folder.join(name + ".glsl"), format!("{text}\n// {words}\n")));
        if let Err(error) = kept {
            eprintln!("{}: {error}", folder.display());
        }
    }
}
