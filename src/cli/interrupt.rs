//! What an interrupt (Ctrl-C) asks for.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Terminal;

/// The first interrupt says `words` and sets what is returned, the second stops at once.
pub(super) fn watch(words: &'static str) -> Arc<AtomicBool> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // Where no handler can be set, an interrupt ends the program as it always did.
    let _ = ctrlc::set_handler(move || {
        Terminal::interrupted(words);
        if flag.swap(true, Ordering::Relaxed) {
            #[expect(clippy::exit, reason = "the user asked twice")]
            std::process::exit(130);
        }
    });
    interrupted
}
