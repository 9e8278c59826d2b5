//! The report for people, on a terminal, with ANSI colors that the printer may strip.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt;

use anstyle::{AnsiColor, Style};
use toyproof_diagnostic::{Json, grouped, magnitude, plural};
use toyproof_verify::Verdict;
use toyproof_verify::compare::{CheckSummary, Comparison, Pixel};

use super::Record;

/// Formats one shader: verdict, name, reason, and a line for each check that found a difference.
#[must_use]
pub fn line(record: &Record) -> String {
    let style = style(record.verdict);
    let mut lines = vec![format!(
        "{style}{:<12}{style:#} {}: {}",
        record.verdict,
        record.shader,
        errors(record).unwrap_or_else(|| record.reason.clone())
    )];
    let questions = [
        (
            "maths",
            &record.algorithm,
            algorithm as fn(&CheckSummary) -> String,
        ),
        ("rounding", &record.precision, precision),
        ("toolchain", &record.toolchain, toolchain),
    ];
    let answered = questions
        .iter()
        .filter_map(|(name, answer, describe)| Some((*name, answer.as_ref()?, describe)));
    let mut same = Vec::new();
    for (name, answer, describe) in answered {
        if answer.is_same() && answer.undefined == 0 {
            same.push(name);
        } else {
            lines.push(format!("{name}: {}", describe(answer)));
        }
    }
    if !same.is_empty() {
        lines.push(format!("{}: no difference", list(&same)));
    }
    if let Some(why) = record.skipped_toolchain_reason() {
        lines.push(format!("toolchain: not asked, {why}"));
    }
    if let Some(image) = &record.comparison {
        lines.push(format!("picture: {}", numbers(image)));
    }
    lines.join(&format!("\n{:13}", ""))
}

/// The number of errors and the first position, instead of the first message: all are printed in full beside
/// this line.
fn errors(record: &Record) -> Option<String> {
    let places: Vec<_> = record.diagnostics.iter().filter_map(Json::error_place).collect();
    let first = places.iter().flatten().next();
    let (count, which) = match places.len() {
        0 => return None,
        1 => ("1 error".to_owned(), "in"),
        count => (format!("{count} errors"), "the first in"),
    };
    Some(match first {
        Some((line, column)) => format!("{count}, {which} line {line}, column {column}"),
        None => count,
    })
}

/// Formats everything that is reported on a shader, without colors: [`line`], and each diagnostic with its
/// notes.
pub(super) fn details(record: &Record) -> String {
    let mut lines = vec![plain(&line(record))];
    for diagnostic in &record.diagnostics {
        lines.push(diagnostic.to_string());
        lines.extend(diagnostic.notes.iter().map(|note| format!("  = {note}")));
    }
    lines.join("\n")
}

/// Strips ANSI colors.
pub(super) fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

/// The number of shaders per verdict; displayed best first.
#[derive(Debug, Clone, Default)]
pub struct Tally(BTreeMap<Reverse<Verdict>, u64>);

impl Tally {
    /// Counts one more shader.
    pub fn add(&mut self, verdict: Verdict) {
        *self.0.entry(Reverse(verdict)).or_default() += 1;
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = self.0.iter().map(|(Reverse(verdict), count)| {
            let style = style(*verdict);
            format!("{count} {style}{verdict}{style:#}")
        });
        f.write_str(&counts.collect::<Vec<_>>().join(", "))
    }
}

/// Formats the number of shaders and their tally.
#[must_use]
pub fn summary(records: &[Record]) -> String {
    let mut tally = Tally::default();
    for record in records {
        tally.add(record.verdict);
    }
    let noun = if records.len() == 1 { "shader" } else { "shaders" };
    format!("{} {noun}: {tally}", records.len())
}

fn style(verdict: Verdict) -> Style {
    let color = match verdict {
        Verdict::Correct | Verdict::Ok => AnsiColor::Green,
        Verdict::Unstable | Verdict::Inconclusive => AnsiColor::Yellow,
        _ => AnsiColor::Red,
    };
    Style::new().fg_color(Some(color.into())).bold()
}

pub(super) fn algorithm(answer: &CheckSummary) -> String {
    question(
        answer,
        ["differs", "differ"],
        "from the scene",
        [
            "hangs by a hair, so that a rounding error decides",
            "hang by a hair, so that a rounding error decides them",
        ],
    )
}

pub(super) fn precision(answer: &CheckSummary) -> String {
    question(
        answer,
        ["is", "are"],
        "visibly another colour in float32 than in double precision",
        ["cannot be told"; 2],
    )
}

fn toolchain(answer: &CheckSummary) -> String {
    let difference = format!(
        "not to the bit what the shader says (by at most {})",
        magnitude(answer.max_abs)
    );
    question(answer, ["is", "are"], &difference, ["cannot be told"; 2])
}

/// Describes how many pixels differ or are ill-conditioned, with the first of them, and how many were left
/// out. Of two verb forms, the first is singular.
fn question(answer: &CheckSummary, verb: [&str; 2], differ: &str, add_image: [&str; 2]) -> String {
    let mut parts = Vec::new();
    let of = |count: u64, [one, many]: [&str; 2]| {
        let (of, total) = (grouped(count), grouped(answer.pixels));
        format!("{of} of {total} pixels {}", plural(count, one, many))
    };
    if answer.differing > 0 {
        parts.push(format!("{} {differ}", of(answer.differing, verb)));
    }
    if answer.ill_conditioned > 0 {
        parts.push(of(answer.ill_conditioned, add_image));
    }
    if let (Some(part), Some(pixel)) = (parts.first_mut(), &answer.first) {
        part.push_str(", first ");
        part.push_str(&place(pixel));
        if let Some(worst) = &answer.worst
            && worst.difference() > 10.0 * pixel.difference()
        {
            part.push_str(", most ");
            part.push_str(&place(worst));
        }
    }
    if answer.undefined > 0 {
        parts.push(format!(
            "{} left out, where the shader does what GLSL leaves undefined",
            grouped(answer.undefined)
        ));
    }
    parts.join("; ")
}

fn list(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

fn numbers(image: &Comparison) -> String {
    let levels = match image.differing_8bit {
        0 => "equal to the reference in 8 bits".to_owned(),
        count => format!(
            "{} {} from the reference in 8 bits, by at most {} {}",
            grouped(count),
            plural(count, "pixel differs", "pixels differ"),
            image.max_8bit,
            plural(u64::from(image.max_8bit), "level", "levels"),
        ),
    };
    format!(
        "{levels}; as floats by at most {}, {} on average",
        magnitude(image.max_abs),
        magnitude(image.mean_abs)
    )
}

/// Describes a pixel: its position, the expected and the actual color.
#[must_use]
pub fn place(pixel: &Pixel) -> String {
    let color = |[r, g, b]: [f32; 3]| format!("({r:.4}, {g:.4}, {b:.4})");
    format!(
        "at ({}, {}): expected {}, got {}",
        pixel.x,
        pixel.y,
        color(pixel.expected),
        color(pixel.actual)
    )
}
