//! The second search of a batch: if no edit repairs a wrong shader, expressions of correct shaders are tried
//! in its places.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};

use toyproof_diagnostic::{grouped, plural};
use toyproof_explain::repair::Donors;
use toyproof_report::Record;
use toyproof_verify::Verdict;

use super::batch::Batch;
use super::checker::{Checker, WorkerContext};
use super::options::CheckFormat;
use super::outcome::Outcome;
use super::submission::Submission;
use crate::cli::pool;

/// The largest number of correct shaders for one reference whose expressions are tried: further solutions of
/// the same exercise rarely have new expressions.
const MAX_SHADERS: usize = 64;

/// What a shader was compared with.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct ReferenceKey {
    task: usize,
    /// The name of the scene, or of the other reference.
    name: Option<String>,
}

impl ReferenceKey {
    fn new(submission: &Submission, record: &Record) -> Self {
        Self {
            task: submission.task,
            name: record.scene.clone().or_else(|| record.reference.clone()),
        }
    }
}

impl Batch<'_> {
    /// Searches the unrepaired shaders again, and prints the fixes below the results of all shaders. The
    /// expressions are those of the first correct shaders in the order of the batch, so that the fixes do not
    /// depend on the number of threads.
    pub(super) fn search_again(
        &mut self,
        submissions: &[Submission],
        checkers: &[Checker],
        stop: &AtomicBool,
    ) {
        if self.unrepaired.is_empty() {
            return;
        }
        let (todo, donors) = self.donors(submissions, checkers);
        if todo.is_empty() || stop.load(Ordering::Relaxed) {
            return;
        }
        let bar = self
            .terminal
            .bar(todo.len() as u64, "wrong shaders searched again");
        let mut found: Vec<(usize, Outcome)> = Vec::new();
        let threads = self.threads(todo.len());
        let (records, reported) = (&self.records, &self.reported);
        pool::for_each(
            &todo,
            threads,
            stop,
            || WorkerContext::without_gpu(threads),
            |context, place| {
                let (record, submission) = (&records[place], &submissions[reported[place]]);
                let donors = &donors[&ReferenceKey::new(submission, record)];
                checkers[submission.task].search_again(context, submission, record, donors)
            },
            |place, outcome| {
                bar.inc(1);
                found.extend(outcome.map(|outcome| (place, outcome)));
            },
        );
        bar.finish_and_clear();
        found.sort_by_key(|&(place, _)| place);
        self.take_fixes(found);
    }

    /// Finds the places of the records to search again, and the expressions to search with.
    fn donors(
        &self,
        submissions: &[Submission],
        checkers: &[Checker],
    ) -> (Vec<usize>, HashMap<ReferenceKey, Donors>) {
        let mut correct: HashMap<ReferenceKey, Vec<&Submission>> = HashMap::new();
        let mut wrong = Vec::new();
        for (place, (record, &index)) in self.records.iter().zip(&self.reported).enumerate() {
            let is_donor = record.verdict == Verdict::Correct;
            if is_donor || self.unrepaired.contains(&index) {
                let submission = &submissions[index];
                let reference = ReferenceKey::new(submission, record);
                if !is_donor {
                    wrong.push((place, reference));
                } else if let donors = correct.entry(reference).or_default()
                    && donors.len() < MAX_SHADERS
                {
                    donors.push(submission);
                }
            }
        }
        wrong.retain(|(_, reference)| correct.contains_key(reference));
        let mut donors = HashMap::new();
        for (_, reference) in &wrong {
            if !donors.contains_key(reference) {
                let of_reference = checkers[reference.task].donors(correct[reference].iter().copied());
                donors.insert(reference.clone(), of_reference);
            }
        }
        (wrong.into_iter().map(|(place, _)| place).collect(), donors)
    }

    /// Prints records with fixes, and puts each in the place of the record without.
    fn take_fixes(&mut self, found: Vec<(usize, Outcome)>) {
        if found.is_empty() {
            return;
        }
        let count = found.len() as u64;
        self.terminal.note(&format!(
            "\n{} more {} expressions of correct shaders:",
            grouped(count),
            plural(count, "shader is repaired by", "shaders are repaired by")
        ));
        for (place, Outcome { record, log }) in found {
            let record = record.redacted(self.options.teachers_hints);
            for message in &log.messages {
                message.print(self.terminal);
            }
            if self.options.format == CheckFormat::Human {
                self.terminal.result(&self.lines(&record));
            }
            self.failed |= log.failed;
            self.records[place] = record;
        }
    }
}
