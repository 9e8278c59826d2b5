//! Tries candidates on several threads, and keeps what succeeds. The result does not depend on the number of
//! threads: candidates are ordered, and the first one that shows the fault counts.

use std::collections::hash_map::DefaultHasher;
use std::collections::{HashMap, HashSet, VecDeque};
use std::hash::{Hash, Hasher};
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::Duration;
use std::{iter, thread};

use toyproof_glsl as glsl;

use crate::rewrite::{Rewrite, apply};
use crate::rewrites::{KINDS, Kind, Source, layout};
use crate::size::Size;
use crate::{Limits, Progress, Reduction, Tester};

/// Reduces a text that shows the fault; `make_tester` is called on each thread.
pub(crate) fn run<T: Tester>(
    text: &str,
    language: &glsl::Options,
    limits: &Limits,
    make_tester: &(impl Fn() -> T + Sync),
    on_progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Reduction {
    let (jobs, inbox) = mpsc::channel::<(u64, String)>();
    let (outbox, results) = mpsc::channel();
    let inbox = Arc::new(Mutex::new(inbox));
    thread::scope(|scope| {
        for _ in 0..limits.threads.max(1) {
            let (inbox, outbox) = (Arc::clone(&inbox), outbox.clone());
            scope.spawn(move || {
                // A worker process ends with the thread that started it, so each thread keeps its own.
                let mut tester = make_tester();
                loop {
                    let job = inbox.lock().unwrap_or_else(PoisonError::into_inner).recv();
                    let Ok((job, text)) = job else { break };
                    // A panic must not leave the search waiting for a result.
                    let shows = catch_unwind(AssertUnwindSafe(|| tester.shows_fault(&text)));
                    if outbox.send((job, shows.unwrap_or(false))).is_err() {
                        break;
                    }
                }
            });
        }
        let mut search = Search {
            best: text.to_owned(),
            size: Size::of(text),
            language,
            limits,
            jobs,
            results,
            sent: HashMap::new(),
            next: 0,
            rejected: HashSet::new(),
            known: HashSet::new(),
            tries: 0,
            is_complete: true,
            on_progress,
        };
        search.rounds();
        Reduction {
            text: search.best,
            tries: search.tries,
            is_complete: search.is_complete,
        }
    })
}

/// How often progress is reported at least.
const REPORT_INTERVAL: Duration = Duration::from_millis(100);

struct Search<'a, 'p> {
    best: String,
    size: Size,
    language: &'a glsl::Options,
    limits: &'a Limits<'a>,
    jobs: mpsc::Sender<(u64, String)>,
    results: mpsc::Receiver<(u64, bool)>,
    /// The candidates that threads have, by number, with their hashes.
    sent: HashMap<u64, u64>,
    /// The number of the next candidate.
    next: u64,
    /// The hashes of candidates that were rejected in their turn.
    rejected: HashSet<u64>,
    /// The hashes of candidates that do not show the fault, also of those that were tested in advance.
    known: HashSet<u64>,
    tries: u64,
    /// Whether neither a limit nor the caller has ended the search.
    is_complete: bool,
    on_progress: &'p mut dyn FnMut(&Progress) -> ControlFlow<()>,
}

impl Search<'_, '_> {
    /// Applies all kinds of rewrites until none succeeds.
    fn rounds(&mut self) {
        self.tidy();
        loop {
            let before = self.size;
            for kind in KINDS {
                let mut level = 0;
                while self.is_complete && self.level(kind, level) {
                    level += 1;
                }
            }
            if self.size == before || !self.is_complete {
                break;
            }
        }
        self.tidy();
    }

    /// Lays the text out anew, if it then still shows the fault.
    fn tidy(&mut self) {
        let tidied = layout::tidy(&self.best);
        if tidied != self.best
            && let Some((_, text)) = self.first_success(iter::once((0, tidied)))
        {
            self.accept(text);
        }
    }

    /// Tries the rewrites of a level, first all, then halves of them; whether there is such a level.
    fn level(&mut self, kind: &Kind, level: usize) -> bool {
        let base = self.best.clone();
        let Some(mut left) = kind.rewrites(&Source::new(&base, self.language), level) else {
            return false;
        };
        left.retain(|rewrite| !rewrite.is_empty());
        let mut done: Vec<Rewrite> = Vec::new();
        let mut chunk = if kind.is_joint { left.len() } else { 1 };
        while chunk > 0 && self.is_complete {
            let mut at = 0;
            loop {
                let size = self.size;
                let candidates = (at..left.len()).step_by(chunk).filter_map(|start| {
                    let chosen = &left[start..left.len().min(start + chunk)];
                    let candidate = apply(&base, done.iter().chain(chosen))?;
                    (Size::of(&candidate) < size).then_some((start, candidate))
                });
                let Some((start, text)) = self.first_success(candidates) else {
                    break;
                };
                done.extend(left.drain(start..left.len().min(start + chunk)));
                self.accept(text);
                at = start;
            }
            chunk = if chunk == 1 { 0 } else { chunk.div_ceil(2) };
        }
        true
    }

    /// Keeps a candidate, and reports it.
    fn accept(&mut self, text: String) {
        self.size = Size::of(&text);
        self.best = text;
        self.report(true);
    }

    fn report(&mut self, is_smaller: bool) {
        let progress = Progress {
            text: &self.best,
            size: self.size,
            tries: self.tries,
            is_smaller,
        };
        if (self.on_progress)(&progress).is_break() {
            self.is_complete = false;
        }
    }

    /// The first candidate that shows the fault, with its number. Threads try later ones meanwhile, whose
    /// results are remembered.
    fn first_success(
        &mut self,
        candidates: impl Iterator<Item = (usize, String)>,
    ) -> Option<(usize, String)> {
        let mut candidates = candidates.fuse();
        let mut waiting: VecDeque<Waiting> = VecDeque::new();
        let mut results: HashMap<u64, bool> = HashMap::new();
        loop {
            let mut is_exhausted = false;
            while self.sent.len() < self.limits.threads.max(1) && !is_exhausted {
                match candidates.next() {
                    None => is_exhausted = true,
                    Some((number, text)) => {
                        let sent = self.send(number, text);
                        waiting.extend(sent);
                    }
                }
            }
            while let Some(first) = waiting.front()
                && let Some(shows_fault) = first.job.map_or(Some(false), |job| results.remove(&job))
                && let Some(first) = waiting.pop_front()
            {
                // Only what one thread alone would test counts.
                self.tries += u64::from(shows_fault || self.rejected.insert(first.hash));
                if shows_fault {
                    return Some((first.number, first.text));
                }
            }
            if waiting.is_empty() && is_exhausted {
                return None;
            }
            if let Ok((job, shows_fault)) = self.results.recv_timeout(REPORT_INTERVAL) {
                if let Some(hash) = self.sent.remove(&job)
                    && !shows_fault
                {
                    self.known.insert(hash);
                }
                results.insert(job, shows_fault);
            }
            self.report(false);
            self.is_complete &= !self.limits.are_over();
            if !self.is_complete {
                return None;
            }
        }
    }

    /// Gives a candidate to a thread, unless its result is known; `None` if it has been rejected before.
    fn send(&mut self, number: usize, text: String) -> Option<Waiting> {
        let mut hasher = DefaultHasher::new();
        text.hash(&mut hasher);
        let hash = hasher.finish();
        if self.rejected.contains(&hash) {
            return None;
        }
        let job = (!self.known.contains(&hash)).then(|| {
            let job = self.next;
            self.next += 1;
            self.sent.insert(job, hash);
            // The threads receive until this end is dropped.
            let _ = self.jobs.send((job, text.clone()));
            job
        });
        Some(Waiting {
            number,
            text,
            hash,
            job,
        })
    }
}

/// A candidate whose result is not known, or that waits for those of earlier ones.
struct Waiting {
    number: usize,
    text: String,
    hash: u64,
    /// `None` if it is known not to show the fault.
    job: Option<u64>,
}
