//! The report as people read it on a terminal, with ANSI colours that the printer may strip.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt;

use anstyle::{AnsiColor, Style};
use toyproof_diagnostic::Json;
use toyproof_verify::compare::{Answer, Comparison, Pixel, Verdict, grouped, magnitude, plural};

use super::Record;

/// One shader: verdict, name, reason, and a line for each question whose answer is worth reading.
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
        ("maths", &record.maths, maths as fn(&Answer) -> String),
        ("rounding", &record.rounding, rounding),
        ("toolchain", &record.toolchain, toolchain),
    ];
    let asked = questions
        .iter()
        .filter_map(|(name, answer, says)| Some((*name, answer.as_ref()?, says)));
    let mut same = Vec::new();
    for (name, answer, says) in asked {
        if answer.is_same() && answer.undefined == 0 {
            same.push(name);
        } else {
            lines.push(format!("{name}: {}", says(answer)));
        }
    }
    if !same.is_empty() {
        lines.push(format!("{}: no difference", list(&same)));
    }
    if let Some(why) = record.toolchain_unasked() {
        lines.push(format!("toolchain: not asked, {why}"));
    }
    if let Some(picture) = &record.picture {
        lines.push(format!("picture: {}", numbers(picture)));
    }
    lines.join(&format!("\n{:13}", ""))
}

/// How many errors there are and where, instead of the first: they are all told in full beside this line.
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

/// All that a person is told of a shader, without colours: what [`line`] says, and each message with its notes.
pub(super) fn details(record: &Record) -> String {
    let mut lines = vec![plain(&line(record))];
    for told in &record.diagnostics {
        lines.push(told.to_string());
        lines.extend(told.notes.iter().map(|note| format!("  = {note}")));
    }
    lines.join("\n")
}

/// A text without its colours.
pub(super) fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

/// How many shaders have each verdict; as words, best first.
#[derive(Debug, Clone, Default)]
pub struct Tally(BTreeMap<Reverse<Verdict>, u64>);

impl Tally {
    /// One more.
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

/// How many shaders there are, and their tally.
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
    let colour = match verdict {
        Verdict::Correct | Verdict::Ok => AnsiColor::Green,
        Verdict::Unstable | Verdict::Inconclusive => AnsiColor::Yellow,
        _ => AnsiColor::Red,
    };
    Style::new().fg_color(Some(colour.into())).bold()
}

pub(super) fn maths(answer: &Answer) -> String {
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

pub(super) fn rounding(answer: &Answer) -> String {
    question(
        answer,
        ["is", "are"],
        "visibly another colour in float32 than in double precision",
        ["cannot be told"; 2],
    )
}

fn toolchain(answer: &Answer) -> String {
    let says = format!(
        "not to the bit what the shader says (by at most {})",
        magnitude(answer.max_abs)
    );
    question(answer, ["is", "are"], &says, ["cannot be told"; 2])
}

/// How many pixels differ or hang by a hair, with the first of them, and how many were left out. Of two forms, one is for one pixel.
fn question(answer: &Answer, verb: [&str; 2], differ: &str, hang: [&str; 2]) -> String {
    let mut parts = Vec::new();
    let of = |count: u64, [one, many]: [&str; 2]| {
        let (of, total) = (grouped(count), grouped(answer.pixels));
        format!("{of} of {total} pixels {}", plural(count, one, many))
    };
    if answer.differing > 0 {
        parts.push(format!("{} {differ}", of(answer.differing, verb)));
    }
    if answer.undecided > 0 {
        parts.push(of(answer.undecided, hang));
    }
    if let (Some(told), Some(pixel)) = (parts.first_mut(), &answer.first) {
        told.push_str(", first ");
        told.push_str(&place(pixel));
        if let Some(worst) = &answer.worst
            && worst.difference() > 10.0 * pixel.difference()
        {
            told.push_str(", most ");
            told.push_str(&place(worst));
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

fn numbers(picture: &Comparison) -> String {
    let levels = match picture.differing_8bit {
        0 => "equal to the reference in 8 bits".to_owned(),
        count => format!(
            "{} {} from the reference in 8 bits, by at most {} {}",
            grouped(count),
            plural(count, "pixel differs", "pixels differ"),
            picture.max_8bit,
            plural(u64::from(picture.max_8bit), "level", "levels"),
        ),
    };
    format!(
        "{levels}; as floats by at most {}, {} on average",
        magnitude(picture.max_abs),
        magnitude(picture.mean_abs)
    )
}

/// A pixel in words: where it is, what was expected and what was found.
#[must_use]
pub fn place(pixel: &Pixel) -> String {
    let colour = |[r, g, b]: [f32; 3]| format!("({r:.4}, {g:.4}, {b:.4})");
    format!(
        "at ({}, {}): expected {}, got {}",
        pixel.x,
        pixel.y,
        colour(pixel.expected),
        colour(pixel.actual)
    )
}
