//! The report as people read it on a terminal, with ANSI colours that the printer may strip.

use anstyle::{AnsiColor, Style};

use super::Record;
use crate::compare::{Comparison, Pixel, Verdict};
use crate::diagnostic::Json;

/// One shader: verdict, name, reason, and the pixels to look at.
#[must_use]
pub fn line(record: &Record) -> String {
    let style = style(record.verdict);
    let mut lines = vec![format!(
        "{style}{:<12}{style:#} {}: {}",
        record.verdict,
        record.shader,
        errors(record).unwrap_or_else(|| record.reason.clone())
    )];
    if let Some(picture) = &record.picture {
        lines.push(numbers(picture));
        if record.verdict == Verdict::Wrong {
            let pixels = [("first", picture.first), ("worst", picture.worst)];
            let places = pixels
                .into_iter()
                .filter_map(|(name, pixel)| Some(format!("{name} {}", place(&pixel?))));
            lines.extend(places);
        }
    }
    lines.join(&format!("\n{:13}", ""))
}

/// How many errors there are and where, instead of the first: they are all told in full beside this line.
fn errors(record: &Record) -> Option<String> {
    let places: Vec<_> = record.diagnostics.iter().filter_map(Json::error_place).collect();
    let first = places.iter().flatten().next();
    let count = match places.len() {
        0 => return None,
        1 => "1 error".to_owned(),
        count => format!("{count} errors"),
    };
    Some(match first {
        Some((line, column)) => format!("{count}, the first in line {line}, column {column}"),
        None => count,
    })
}

/// How many shaders have each verdict, best first.
#[must_use]
pub fn summary(records: &[Record]) -> String {
    let mut verdicts: Vec<_> = records.iter().map(|record| record.verdict).collect();
    verdicts.sort_by(|a, b| b.cmp(a));
    let counts: Vec<_> = verdicts
        .chunk_by(|a, b| a == b)
        .map(|same| {
            let style = style(same[0]);
            format!("{} {style}{}{style:#}", same.len(), same[0])
        })
        .collect();
    let noun = if records.len() == 1 { "shader" } else { "shaders" };
    format!("{} {noun}: {}", records.len(), counts.join(", "))
}

fn style(verdict: Verdict) -> Style {
    let colour = match verdict {
        Verdict::Correct | Verdict::Ok => AnsiColor::Green,
        Verdict::Inconclusive => AnsiColor::Yellow,
        _ => AnsiColor::Red,
    };
    Style::new().fg_color(Some(colour.into())).bold()
}

fn numbers(picture: &Comparison) -> String {
    let levels = match picture.differing_8bit {
        0 => "equal in 8 bits".to_owned(),
        count => format!(
            "{count} {} in 8 bits, by at most {} {}",
            plural(count, "pixel differs", "pixels differ"),
            picture.max_8bit,
            plural(u64::from(picture.max_8bit), "level", "levels"),
        ),
    };
    format!(
        "{levels}; as floats by at most {:.1e}, {:.1e} on average",
        picture.max_abs, picture.mean_abs
    )
}

/// A pixel in words: where it is, what was expected and what was found.
#[must_use]
pub fn place(pixel: &Pixel) -> String {
    let colour = |[r, g, b]: [f32; 3]| format!("({r:.4}, {g:.4}, {b:.4})");
    format!(
        "at x {}, y {}: expected {}, found {}",
        pixel.x,
        pixel.y,
        colour(pixel.expected),
        colour(pixel.actual)
    )
}

fn plural<'a>(count: u64, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}
