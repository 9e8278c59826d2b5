//! Reduces several texts of which a fault needs some, such as the passes of a project.

use std::ops::ControlFlow;

use toyproof_glsl as glsl;

use crate::{Limits, NoFault, Progress, Tester, search};

/// A text that may be reduced.
#[derive(Debug, Clone)]
pub struct Part {
    /// The text; empty if only whether it is there matters.
    pub text: String,
    /// How the text is checked.
    pub language: glsl::Options,
    /// Whether the fault cannot be tested without it.
    pub is_required: bool,
}

/// The texts of all parts, in their order; `None` for one that is left out.
pub type Texts = Vec<Option<String>>;

/// Decides whether texts show the fault. Each thread has its own.
pub trait PartsTester {
    /// Whether the texts show the fault; the same for the same texts.
    fn show_fault(&mut self, texts: &[Option<String>]) -> bool;
}

impl<F: FnMut(&[Option<String>]) -> bool> PartsTester for F {
    fn show_fault(&mut self, texts: &[Option<String>]) -> bool {
        self(texts)
    }
}

/// Gets all texts, and the progress of the one that is being reduced; may end the reduction.
pub type OnPartsProgress<'p> = dyn FnMut(&[Option<String>], &Progress) -> ControlFlow<()> + 'p;

/// The result of a reduction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartsReduction {
    /// The smallest texts.
    pub texts: Texts,
    /// The number of candidates that were tested.
    pub tries: u64,
    /// Whether nothing succeeds any more; otherwise a limit or the caller has ended the reduction.
    pub is_complete: bool,
}

/// Reduces texts that show a fault together: leaves out parts, and [reduces](crate::reduce) the text of one
/// part after the other, until neither succeeds. `on_progress` gets all texts; `Progress` is about the text
/// that is being reduced, but for the number of tries.
///
/// # Errors
/// If the texts do not show the fault.
pub fn reduce_parts<T: PartsTester>(
    parts: &[Part],
    limits: &Limits,
    make_tester: &(impl Fn() -> T + Sync),
    on_progress: &mut OnPartsProgress,
) -> Result<PartsReduction, NoFault> {
    let texts: Texts = parts.iter().map(|part| Some(part.text.clone())).collect();
    let mut tester = make_tester();
    if !tester.show_fault(&texts) {
        return Err(NoFault);
    }
    let mut search = Search {
        parts,
        limits,
        reduction: PartsReduction {
            texts,
            tries: 0,
            is_complete: true,
        },
        on_progress,
    };
    // The texts among which each part was reduced last: among the same ones, nothing more succeeds.
    let mut reduced_among: Vec<Option<Texts>> = vec![None; parts.len()];
    loop {
        let before = search.reduction.texts.clone();
        search.leave_out(&mut tester);
        for (number, among) in reduced_among.iter_mut().enumerate() {
            if search.reduction.is_complete && among.as_ref() != Some(&search.reduction.texts) {
                search.reduce(number, make_tester);
                *among = Some(search.reduction.texts.clone());
            }
        }
        if search.reduction.texts == before || !search.reduction.is_complete {
            return Ok(search.reduction);
        }
    }
}

struct Search<'a, 'p> {
    parts: &'a [Part],
    limits: &'a Limits<'a>,
    reduction: PartsReduction,
    on_progress: &'p mut OnPartsProgress<'p>,
}

impl Search<'_, '_> {
    /// Leaves out all parts that are not required, or else each that the fault does not need.
    fn leave_out(&mut self, tester: &mut impl PartsTester) {
        let optional = |texts: &Texts| -> Vec<usize> {
            let is_optional = |&at: &usize| !self.parts[at].is_required && texts[at].is_some();
            (0..self.parts.len()).filter(is_optional).collect()
        };
        let all = optional(&self.reduction.texts);
        let candidates = std::iter::once(all.clone()).chain(all.iter().map(|&at| vec![at]));
        for left_out in candidates {
            let mut texts = self.reduction.texts.clone();
            for at in left_out {
                texts[at] = None;
            }
            if !self.reduction.is_complete || texts == self.reduction.texts {
                continue;
            }
            self.reduction.tries += 1;
            let is_smaller = tester.show_fault(&texts);
            if is_smaller {
                self.reduction.texts = texts;
            }
            let progress = Progress {
                text: "",
                size: crate::Size::of(""),
                tries: self.reduction.tries,
                is_smaller,
            };
            let goes_on = (self.on_progress)(&self.reduction.texts, &progress).is_continue();
            self.reduction.is_complete &= goes_on && !self.limits.are_over();
        }
    }

    /// Reduces the text of a part.
    fn reduce<T: PartsTester>(&mut self, number: usize, make_tester: &(impl Fn() -> T + Sync)) {
        let texts = self.reduction.texts.clone();
        let Some(text) = texts[number].as_deref().filter(|text| !text.is_empty()) else {
            return;
        };
        let make_part_tester = || PartTester {
            tester: make_tester(),
            texts: texts.clone(),
            number,
        };
        let mut current = texts.clone();
        let tries = self.reduction.tries;
        let mut on_progress = |progress: &Progress| {
            if progress.is_smaller {
                current[number] = Some(progress.text.to_owned());
            }
            let progress = Progress {
                tries: tries + progress.tries,
                ..*progress
            };
            (self.on_progress)(&current, &progress)
        };
        let language = &self.parts[number].language;
        let reduced = search::run(text, language, self.limits, &make_part_tester, &mut on_progress);
        self.reduction.texts[number] = Some(reduced.text);
        self.reduction.tries += reduced.tries;
        self.reduction.is_complete &= reduced.is_complete;
    }
}

/// Tests texts of a part, among the texts of the others.
struct PartTester<T> {
    tester: T,
    texts: Texts,
    number: usize,
}

impl<T: PartsTester> Tester for PartTester<T> {
    fn shows_fault(&mut self, text: &str) -> bool {
        self.texts[self.number] = Some(text.to_owned());
        self.tester.show_fault(&self.texts)
    }
}
