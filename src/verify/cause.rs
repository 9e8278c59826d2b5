//! The line that a shader loses its digits in.

use std::collections::BTreeMap;
use std::time::Instant;

use toyproof_diagnostic::{Diagnostic, Span};
use toyproof_eval::{Program, Told, What};
use toyproof_glsl::Code;
use toyproof_image::Image;

use super::{Asked, Case};
use crate::compare::{Standing, grouped};
use crate::explain::{Explanation, digits, explain};

/// So many of the pixels that differ are asked for their cause.
const ASKED: usize = 5;

/// What most of some pixels that differ name as the place where f32 and f64 part; none if there is no time to ask them.
pub(super) fn cause(program: &Program, case: &Case, until: Instant, asked: &Asked) -> Option<Diagnostic> {
    let deadline = until.min(Instant::now() + case.timeout);
    let mut named = BTreeMap::<u32, (u64, Diagnostic)>::new();
    for pixel in some(asked, case.frame.size, ASKED) {
        let explained = explain(program, case.frame, pixel, Some(deadline));
        let told = explained
            .ok()
            .and_then(|explanation| diagnostic(&explanation, pixel));
        if let Some((span, told)) = told {
            named.entry(span.start).or_insert((0, told)).0 += 1;
        }
    }
    let most = named.into_values().max_by_key(|&(votes, _)| votes);
    most.map(|(_, diagnostic)| diagnostic)
}

/// Colours that are no numbers, or infinite.
#[derive(Debug, Default)]
pub(super) struct NotFinite {
    /// In how many pixels.
    count: u64,
    /// The first of them.
    first: Option<[u32; 2]>,
}

impl NotFinite {
    /// Looks at a band that begins at that row.
    pub(super) fn look(&mut self, band: &Image, row: u32) {
        let is_bad = |pixel: &[f32; 4]| pixel[..3].iter().any(|part| !part.is_finite());
        let bad = band.pixels().iter().enumerate();
        let mut bad = bad.filter(|(_, pixel)| is_bad(pixel)).map(|(at, _)| at as u32);
        if let Some(at) = bad.next() {
            let width = band.size()[0];
            self.first.get_or_insert([at % width, row + at / width]);
            self.count += 1 + bad.count() as u64;
        }
    }

    /// Where the first comes from; none if all are finite, or that could not be found.
    pub(super) fn told(&self, program: &Program, case: &Case, until: Instant) -> Option<Diagnostic> {
        let [x, y] = self.first?;
        let count = self.count;
        let deadline = until.min(Instant::now() + case.timeout);
        let explained = explain(program, case.frame, [x, y], Some(deadline)).ok()?;
        let step = explained.not_finite.map(|at| &explained.steps[at])?;
        let value = step.single.iter().flatten().find_map(|told| match told {
            Told::Float(value) if !value.is_finite() => Some(digits(*value, true)),
            _ => None,
        });
        let message = format!(
            "{} in {} {}, first at ({x}, {y}), where {} comes of this",
            if count == 1 {
                "a colour that is not finite"
            } else {
                "colours that are not finite"
            },
            grouped(count),
            if count == 1 { "pixel" } else { "pixels" },
            value.unwrap_or_default(),
        );
        let span = explained.plot.event(step.event).at.span;
        Some(
            Diagnostic::warning(Code::NotFinite.as_str(), message)
                .at(span)
                .note(hint([x, y])),
        )
    }
}

/// At most so many of the pixels that differ, or that hang by a hair where none does, from all over the picture.
pub(super) fn some(asked: &Asked, size: [u32; 2], most: usize) -> Vec<[u32; 2]> {
    let width = size[0] as usize;
    let of = |standing| {
        let standings = asked.standings.iter().enumerate();
        standings
            .filter(move |&(_, &own)| own == standing)
            .map(|(at, _)| at)
    };
    let told = [Standing::Differs, Standing::Undecided];
    let told = told.into_iter().find(|&standing| of(standing).next().is_some());
    let Some(told) = told else {
        return Vec::new();
    };
    let all = of(told).count();
    let count = all.min(most);
    let mut left = of(told).enumerate();
    let chosen = (0..count).filter_map(|at| {
        let chosen = (2 * at + 1) * all / (2 * count);
        left.find(|&(number, _)| number == chosen)
    });
    chosen
        .map(|(_, at)| [(at % width) as u32, (at / width) as u32])
        .collect()
}

fn diagnostic(explanation: &Explanation<'_>, [x, y]: [u32; 2]) -> Option<(Span, Diagnostic)> {
    let step = &explanation.steps[explanation.cause?];
    let event = explanation.plot.event(step.event);
    let at = format!("at ({x}, {y})");
    let message = match step.worst() {
        Some((_, single, double)) if event.what == What::Branch => {
            let truth = |told| matches!(told, Told::Word(word) if word != 0);
            format!(
                "float32 decides otherwise here: {at} this is {}, and {} in double precision",
                truth(single),
                truth(double)
            )
        }
        Some((_, Told::Float(single), Told::Float(double))) => format!(
            "float32 loses its digits here: {at} this is {}, and {} in double precision",
            digits(single, true),
            digits(double, false)
        ),
        _ => format!("float32 and double precision part here, {at}"),
    };
    let span = event.at.span;
    Some((
        span,
        Diagnostic::warning(Code::LostDigits.as_str(), message)
            .at(span)
            .note(hint([x, y])),
    ))
}

fn hint([x, y]: [u32; 2]) -> String {
    format!("`toyproof explain` with `--pixel {x},{y}` tells how it comes to this")
}
