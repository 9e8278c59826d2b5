//! The second search of a batch: a wrong shader that no edit of its own repairs is searched for places where an
//! expression of a correct shader repairs it.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};

use toyproof_diagnostic::{grouped, plural};
use toyproof_verify::Verdict;
use toyproof_verify::repair::Donors;

use super::args::CheckFormat;
use super::batch::Batch;
use super::checker::{Checker, WorkerContext};
use super::outcome::Outcome;
use super::submission::Submission;
use crate::cli::pool;
use crate::report::{self, Record};

/// The largest number of correct shaders for one reference whose expressions are tried.
const MAX_SHADERS: usize = 64;

/// The task, and the names of the scene or of the other reference that a shader was compared with.
type ReferenceNames = (usize, Option<String>, Option<String>);

fn reference(submission: &Submission, record: &Record) -> ReferenceNames {
    (submission.task, record.scene.clone(), record.reference.clone())
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
        let reference_of = |(index, record): &(usize, Record)| reference(&submissions[*index], record);
        let mut correct: HashMap<ReferenceNames, Vec<&Submission>> = HashMap::new();
        for reported in &self.records {
            let (index, record) = reported;
            if record.verdict == Verdict::Correct {
                let of_reference = correct.entry(reference_of(reported)).or_default();
                of_reference.push(&submissions[*index]);
            }
        }
        let places = self.records.iter().enumerate();
        let todo: Vec<usize> = places
            .filter(|(_, reported)| {
                self.unrepaired.contains(&reported.0) && correct.contains_key(&reference_of(reported))
            })
            .map(|(place, _)| place)
            .collect();
        if todo.is_empty() || stop.load(Ordering::Relaxed) {
            return;
        }
        let mut donors: HashMap<ReferenceNames, Donors> = HashMap::new();
        for &place in &todo {
            let reference = reference_of(&self.records[place]);
            donors.entry(reference).or_insert_with_key(|reference| {
                checkers[reference.0].donors(correct[reference].iter().copied().take(MAX_SHADERS))
            });
        }
        let bar = self
            .terminal
            .bar(todo.len() as u64, "wrong shaders searched again");
        let mut found: Vec<(usize, Outcome)> = Vec::new();
        let threads = self.threads(todo.len());
        let records = &self.records;
        pool::for_each(
            &todo,
            threads,
            stop,
            || WorkerContext::without_gpu(threads),
            |context, place| {
                let (index, record) = &records[place];
                let submission = &submissions[*index];
                let donors = &donors[&reference(submission, record)];
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
        for (place, mut outcome) in found {
            outcome.record.redact(self.args.teachers_hints());
            for message in &outcome.messages {
                message.print(self.terminal);
            }
            if self.args.format == CheckFormat::Human {
                self.terminal
                    .result(&report::lines(&outcome.record, &self.layout));
            }
            self.failed |= outcome.failed;
            self.records[place].1 = outcome.record;
        }
    }
}
