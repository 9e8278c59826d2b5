//! The report for people, on a terminal, with ANSI colors that the printer may strip.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt;

use anstyle::{AnsiColor, Style};
use toyproof_diagnostic::{Json, Severity, color_difference, columns, display_width, grouped, plural, wrap};
use toyproof_verify::Verdict;
use toyproof_verify::compare::{CheckSummary, Comparison, Pixel};

use super::repair::{in_tab, suspect_lines};
use super::{Departure, Mistake, Record, Repair};

/// How much is printed of each shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// The verdict, the name and the reason: one line.
    Short,
    /// Also the likely mistake, the fix or the suspect lines, and the command that shows more.
    Normal,
    /// Also the text of the suspect lines and the numbers of the three checks.
    Full,
}

/// The layout of the lines of one run.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// How much is printed.
    pub detail: Detail,
    /// The width of the column of names, in terminal columns.
    pub names: usize,
    /// The width of the terminal in columns; `None` if lines are not wrapped, as in a file.
    pub width: Option<usize>,
    /// Whether errors, or the warnings of a shader without a good verdict, are listed below the shader, as
    /// they are where their source lines are not shown.
    pub lists_diagnostics: bool,
}

/// The widest column of names; longer names move their reasons to the right.
const MAX_NAME_COLUMN: usize = 40;

/// The least width of the column of reasons; where there is less room, they are below the names.
const MIN_SENTENCE: usize = 40;

/// The width of the column of verdicts.
const VERDICT_COLUMN: usize = 13;

impl Layout {
    /// The layout for shaders of these names, without a list of their diagnostics.
    #[must_use]
    pub fn new<'a>(names: impl IntoIterator<Item = &'a str>, width: Option<usize>, detail: Detail) -> Self {
        let names = names.into_iter().map(display_width).max().unwrap_or(0);
        Self {
            detail,
            names: names.min(MAX_NAME_COLUMN),
            width,
            lists_diagnostics: false,
        }
    }

    /// A result: a colored label, the name and a sentence, wrapped below each other.
    #[must_use]
    pub fn row(&self, (label, style): (&str, Style), name: &str, sentence: &str) -> String {
        let spaces = |used: usize, column: usize| " ".repeat(column.saturating_sub(used).max(1));
        let prefix = format!(
            "{style}{label}{style:#}{}{name}{} ",
            spaces(display_width(label), VERDICT_COLUMN),
            spaces(display_width(name), self.names + 1)
        );
        let column = VERDICT_COLUMN + self.names + 2;
        match self.width {
            Some(width) if column + MIN_SENTENCE > width && column + display_width(sentence) > width => {
                let below = wrap(&" ".repeat(VERDICT_COLUMN), VERDICT_COLUMN, sentence, self.width);
                format!("{}\n{below}", prefix.trim_end())
            }
            _ => wrap(&prefix, column, sentence, self.width),
        }
    }

    /// A line below a result.
    #[must_use]
    pub fn below(&self, label: &str, sentence: &str) -> String {
        let indent = " ".repeat(VERDICT_COLUMN);
        let hang = VERDICT_COLUMN + display_width(label);
        wrap(&format!("{indent}{label}"), hang, sentence, self.width)
    }
}

/// Formats one shader: verdict, name and reason, and below them the parts that the layout requests.
#[must_use]
pub fn lines(record: &Record, layout: &Layout) -> String {
    let errors = diagnostics(record, Severity::Error);
    let reason = match errors.len() {
        0 => record.reason.clone(),
        _ if layout.detail == Detail::Short || record.decision.is_some() => record.reason.clone(),
        // The errors themselves are next to this line.
        1 => "1 error".to_owned(),
        count => format!("{} errors", grouped(count as u64)),
    };
    let reason = match record.late() {
        None => reason,
        Some(late) => format!("{reason}; {late}"),
    };
    let label = record.verdict.to_string();
    let mut lines = vec![layout.row((&label, style(record.verdict)), &record.shader, &reason)];
    if layout.detail >= Detail::Normal {
        if layout.lists_diagnostics && !record.verdict.is_good() {
            let warnings = diagnostics(record, Severity::Warning);
            let listed = if errors.is_empty() { &warnings } else { &errors };
            lines.extend(diagnostic_lines(listed, &record.shader, layout));
        }
        // The reason is enough for a shader without a fault.
        if !record.verdict.is_good() || layout.detail == Detail::Full {
            lines.extend(record.details.iter().map(|detail| layout.below("", detail)));
        }
        if let Some(mistake) = &record.mistake {
            lines.extend(mistake_lines(mistake, layout));
        }
        let hints = fix_lines(record).into_iter();
        lines.extend(hints.map(|(label, sentence)| layout.below(&format!("{label}: "), &sentence)));
        let faults = record.faults().into_iter();
        lines.extend(faults.map(|(label, sentence)| layout.below(&format!("{label}: "), &sentence)));
        if layout.detail >= Detail::Full {
            let right = record.right_functions();
            lines.extend(right.map(|sentence| layout.below("function: ", &sentence)));
        }
        if record.fix.is_none() {
            if layout.detail >= Detail::Full {
                lines.extend(suspect_texts(record, layout));
            }
            lines.extend(record.is_search_cut.then(|| layout.below("", CUT_SEARCH)));
        }
        lines.extend(record.is_cut_by_time.then(|| layout.below("", CUT_BY_TIME)));
    }
    if layout.detail >= Detail::Full {
        let dialect = record.dialect.as_ref();
        lines.extend(dialect.map(|dialect| layout.below("dialect: ", &dialect.title())));
        lines.extend(check_lines(record).iter().map(|line| layout.below("", line)));
    }
    if layout.detail >= Detail::Normal
        && let Some(help) = &record.help
    {
        lines.push(layout.below("help: ", help));
    }
    lines.join("\n")
}

fn diagnostics(record: &Record, severity: Severity) -> Vec<&Json> {
    let diagnostics = record.diagnostics.iter();
    diagnostics
        .filter(|diagnostic| diagnostic.severity == severity)
        .collect()
}

/// The largest number of diagnostics of one shader that are listed: the first ones cause most of the others.
const MAX_LISTED: usize = 5;

/// A line for each diagnostic: position, message and code.
fn diagnostic_lines(diagnostics: &[&Json], shader: &str, layout: &Layout) -> Vec<String> {
    let place = |error: &Json| {
        let position = match (error.line, error.column) {
            (Some(line), Some(column)) => format!("{line}:{column}"),
            _ => String::new(),
        };
        match &error.file {
            Some(file) if file != shader => format!("{file}:{position}"),
            _ => position,
        }
    };
    let shown = &diagnostics[..diagnostics.len().min(MAX_LISTED)];
    let places: Vec<_> = shown.iter().map(|error| place(error)).collect();
    let column = places.iter().map(String::len).max().unwrap_or(0);
    let mut lines: Vec<_> = shown
        .iter()
        .zip(&places)
        .map(|(error, place)| {
            layout.below(
                &format!("{place:<column$}  "),
                &format!("{} [{}]", error.message, error.code),
            )
        })
        .collect();
    if let more @ 1.. = diagnostics.len() - shown.len() {
        lines.push(layout.below("", &format!("and {} more", grouped(more as u64))));
    }
    lines
}

/// The likely mistake, or a ranked list if others explain the image as well.
fn mistake_lines(mistake: &Mistake, layout: &Layout) -> Vec<String> {
    let label = mistake.label();
    if mistake.alternatives.is_empty() {
        return vec![layout.below(&format!("{label}: "), &mistake.text)];
    }
    let others = mistake.alternatives.iter().map(|other| &other.text);
    // A symptom is not one of several mistakes, but their effect.
    let first = (!mistake.is_symptom).then_some(&mistake.text);
    let ranked = first
        .into_iter()
        .chain(others)
        .enumerate()
        .map(|(rank, text)| layout.below(&format!("  {}. ", rank + 1), text));
    let heading = layout.below("", "possible mistakes, the most likely first:");
    let symptom = mistake
        .is_symptom
        .then(|| layout.below("symptom: ", &mistake.text));
    symptom.into_iter().chain([heading]).chain(ranked).collect()
}

/// The fix of a wrong shader and its alternatives, else where it departs from the reference, and its suspect
/// lines: each with its label.
pub(super) fn fix_lines(record: &Record) -> Vec<(&'static str, String)> {
    let Some(fix) = &record.fix else {
        let departure = record.departure.iter().flat_map(Departure::sentences);
        let departure = departure.map(|(kind, text)| (kind.label(), text));
        let suspects = suspect_lines(&record.suspects)
            .map(|(label, lines)| (label, format!("{lines} (the wrong pixels depend most on these)")));
        return departure.chain(suspects).collect();
    };
    let placed = |repair: &Repair, text: String| in_tab(repair, &record.shader) + &text;
    let others = fix.alternatives.iter();
    let alternatives = others.map(|other| ("or", placed(other, other.summary())));
    [("fix", placed(fix, fix.sentence()))]
        .into_iter()
        .chain(alternatives)
        .collect()
}

/// The text of each suspect statement.
fn suspect_texts(record: &Record, layout: &Layout) -> Vec<String> {
    let suspects = record.suspects.iter().map(|suspect| {
        let label = format!("  {}:{}  ", suspect.place(), suspect.range.column);
        layout.below(&label, &suspect.text)
    });
    suspects.collect()
}

/// The statement on a search that found no fix and was not complete.
pub(super) const CUT_SEARCH: &str =
    "none of the edits that were tried corrects the image; a larger --search tries more";

/// The statement of a record if its time limit cut the explanation of the verdict.
pub(super) const CUT_BY_TIME: &str =
    "the search for an explanation exceeded its time limit; another run on an idle machine may find more";

/// The table of the checks, and the comparison of the images.
fn check_lines(record: &Record) -> Vec<String> {
    let checks = [
        ("algorithm", &record.algorithm),
        ("precision", &record.precision),
        ("toolchain", &record.toolchain),
    ];
    let header = [
        "check",
        "pixels off",
        "ill-conditioned",
        "undefined",
        "largest",
        "first at",
        "expected → actual",
    ];
    let rows: Vec<_> = checks
        .iter()
        .filter_map(|(name, check)| Some(check_row(name, check.as_ref()?)))
        .collect();
    let mut lines = Vec::new();
    if !rows.is_empty() {
        let header = header.map(str::to_owned);
        lines.extend(columns(
            "",
            &[vec![header.to_vec()], rows].concat(),
            &[1, 2, 3, 4],
        ));
    }
    if let Some(why) = record.skipped_toolchain_reason() {
        lines.push(format!("toolchain  {why}"));
    }
    if let Some(image) = &record.comparison {
        lines.push(format!("image      {}", image_line(image)));
    }
    lines
}

fn check_row(name: &str, check: &CheckSummary) -> Vec<String> {
    let (first, colors) = match &check.first {
        Some(pixel) => (format!("({}, {})", pixel.x, pixel.y), pixel_colors(pixel)),
        None => (String::new(), String::new()),
    };
    vec![
        name.to_owned(),
        grouped(check.differing),
        grouped(check.ill_conditioned),
        grouped(check.undefined),
        color_difference(check.max_abs),
        first,
        colors,
    ]
}

/// The expected and the actual color, with as many decimals as show the difference.
fn pixel_colors(pixel: &Pixel) -> String {
    let color =
        |[r, g, b]: [f32; 3], decimals: usize| format!("({r:.decimals$}, {g:.decimals$}, {b:.decimals$})");
    let colors = |decimals| (color(pixel.expected, decimals), color(pixel.actual, decimals));
    let (mut expected, mut actual) = colors(3);
    if expected == actual {
        (expected, actual) = colors(9);
    }
    format!("{expected} → {actual}")
}

/// Formats a pixel: its position, the expected and the actual color.
#[must_use]
pub fn place(pixel: &Pixel) -> String {
    format!("at ({}, {}): {}", pixel.x, pixel.y, pixel_colors(pixel))
}

fn image_line(image: &Comparison) -> String {
    match image.differing_8bit {
        0 => format!(
            "all {} pixels are equal to the reference in 8 bits",
            grouped(image.pixels)
        ),
        count => format!(
            "{} of {} pixels {} from the reference in 8 bits, by at most {} {}",
            grouped(count),
            grouped(image.pixels),
            plural(count, "differs", "differ"),
            image.max_8bit,
            plural(u64::from(image.max_8bit), "level", "levels"),
        ),
    }
}

/// Describes the result of the algorithm check.
pub(super) fn algorithm(check: &CheckSummary) -> String {
    describe_check(check, "from the reference")
}

/// Describes the result of the precision check.
pub(super) fn precision(check: &CheckSummary) -> String {
    describe_check(check, "visibly between float32 and double precision")
}

/// Describes how many pixels differ, are ill-conditioned and were left out.
fn describe_check(check: &CheckSummary, from: &str) -> String {
    let of = |count: u64| format!("{} of {} pixels", grouped(count), grouped(check.pixels));
    let mut parts = Vec::new();
    if check.differing > 0 {
        let differ = plural(check.differing, "differs", "differ");
        parts.push(format!("{} {differ} {from}", of(check.differing)));
    }
    if check.ill_conditioned > 0 {
        let are = plural(check.ill_conditioned, "is", "are");
        parts.push(format!("{} {are} ill-conditioned", of(check.ill_conditioned)));
    }
    if check.undefined > 0 {
        let depend = plural(check.undefined, "depends", "depend");
        parts.push(format!("{} {depend} on undefined behavior", of(check.undefined)));
    }
    parts.join("; ")
}

/// Formats everything that is reported on a shader, without colors and unwrapped: all lines, and each
/// diagnostic with its notes.
pub(super) fn details(record: &Record) -> String {
    let layout = Layout::new([record.shader.as_str()], None, Detail::Full);
    let mut lines = vec![plain(&lines(record, &layout))];
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
    /// Counts the shaders of records.
    #[must_use]
    pub fn new(records: &[Record]) -> Self {
        let mut tally = Self::default();
        for record in records {
            tally.add(record.verdict);
        }
        tally
    }

    /// Counts one more shader.
    pub fn add(&mut self, verdict: Verdict) {
        *self.0.entry(Reverse(verdict)).or_default() += 1;
    }

    /// The verdicts that occur, the best first, each with the number of its shaders.
    pub fn counts(&self) -> impl Iterator<Item = (Verdict, u64)> + '_ {
        self.0.iter().map(|(Reverse(verdict), count)| (*verdict, *count))
    }

    /// The number of shaders with a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> u64 {
        self.0.get(&Reverse(verdict)).copied().unwrap_or_default()
    }

    /// Formats the number of all shaders and of those of each verdict.
    #[must_use]
    pub fn summary(&self) -> String {
        let count = self.0.values().sum();
        format!(
            "{} {}: {self}",
            grouped(count),
            plural(count, "shader", "shaders")
        )
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = self.counts().map(|(verdict, count)| {
            let style = style(verdict);
            format!("{} {style}{verdict}{style:#}", grouped(count))
        });
        f.write_str(&counts.collect::<Vec<_>>().join(", "))
    }
}

/// The style of a verdict; without a color if nothing was compared.
fn style(verdict: Verdict) -> Style {
    let color = match verdict {
        Verdict::Ok => None,
        Verdict::Correct => Some(AnsiColor::Green),
        Verdict::Unstable | Verdict::Chaotic | Verdict::Inconclusive => Some(AnsiColor::Yellow),
        _ => Some(AnsiColor::Red),
    };
    Style::new().fg_color(color.map(Into::into)).bold()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::samples::{correct, invalid, record};
    use crate::repair::samples::{repaired, suspected};

    fn text(record: &Record, detail: Detail, width: Option<usize>) -> String {
        let layout = Layout {
            lists_diagnostics: true,
            ..Layout::new([record.shader.as_str()], width, detail)
        };
        plain(&lines(record, &layout))
    }

    fn wrong() -> Record {
        let mut wrong = record(Verdict::Wrong);
        wrong.shader = "mai/homework2.glsl".to_owned();
        wrong.reason = "9,423 of 57,600 pixels differ from the reference (16.4 %)".to_owned();
        wrong.mistake = Some(Mistake {
            id: "no-clamp".to_owned(),
            text: "N·L is not clamped to 0".to_owned(),
            is_symptom: false,
            alternatives: Vec::new(),
        });
        wrong.help = Some("toyproof explain no-clamp".to_owned());
        wrong
    }

    #[test]
    fn a_shader_is_one_line_with_what_explains_it_below() {
        assert_eq!(
            text(&wrong(), Detail::Normal, None),
            "wrong        mai/homework2.glsl  9,423 of 57,600 pixels differ from the reference (16.4 %)\n\
             \x20            likely mistake: N·L is not clamped to 0\n\
             \x20            help: toyproof explain no-clamp"
        );
        assert_eq!(text(&wrong(), Detail::Short, None).lines().count(), 1);
    }

    #[test]
    fn lines_wrap_at_the_terminals_width_with_a_hanging_indent() {
        let second_line = |width: usize| {
            let wrapped = text(&wrong(), Detail::Normal, Some(width));
            assert!(
                wrapped.lines().all(|line| display_width(line) <= width),
                "{wrapped}"
            );
            wrapped.lines().nth(1).unwrap().to_owned()
        };
        let name = " ".repeat("wrong        mai/homework2.glsl  ".len());
        assert_eq!(second_line(80), format!("{name}reference (16.4 %)"));
        // There is too little room next to the name.
        assert_eq!(
            second_line(70).trim_start(),
            "9,423 of 57,600 pixels differ from the reference (16.4 %)"
        );
    }

    #[test]
    fn errors_are_listed_with_their_positions() {
        assert_eq!(
            text(&invalid(), Detail::Normal, None),
            "invalid      invalid  1 error\n             a.glsl:2:3  unknown name [E0301]"
        );
    }

    #[test]
    fn other_explanations_are_ranked_and_symptoms_are_labeled() {
        let mut several = wrong();
        let mistake = several.mistake.as_mut().unwrap();
        mistake.alternatives.push(crate::Alternative {
            id: "b".to_owned(),
            text: "second".to_owned(),
        });
        let shown = text(&several, Detail::Normal, None);
        assert!(
            shown.contains("possible mistakes, the most likely first:\n               1. N·L"),
            "{shown}"
        );
        assert!(shown.contains("\n               2. second\n"), "{shown}");
        let mut symptom = wrong();
        symptom.mistake.as_mut().unwrap().is_symptom = true;
        assert!(text(&symptom, Detail::Normal, None).contains("symptom: N·L"));
    }

    #[test]
    fn a_fix_is_below_the_mistake_with_its_alternatives() {
        assert_eq!(
            text(&repaired(), Detail::Normal, None),
            "wrong        wrong  it is wrong\n\
             \x20            likely mistake: an operator is wrong\n\
             \x20            fix: line 2: replace `b + c` with `b - c`; then all 14,400 pixels agree\n\
             \x20            or: line 2: remove `b + c`, and line 4: replace `1.0` with `2.0`\n\
             \x20            help: toyproof explain wrong-operator"
        );
        let full = text(&repaired(), Detail::Full, None);
        assert!(!full.contains("suspect") && !full.contains(CUT_SEARCH), "{full}");
        assert_eq!(text(&repaired(), Detail::Short, None).lines().count(), 1);
    }

    #[test]
    fn without_a_fix_the_suspect_lines_are_listed() {
        let normal = text(&suspected(), Detail::Normal, None);
        assert_eq!(
            normal.lines().nth(1),
            Some("             suspect lines: 4, 2 (the wrong pixels depend most on these)"),
            "{normal}"
        );
        assert!(normal.contains(CUT_SEARCH), "{normal}");
        let full = text(&suspected(), Detail::Full, None);
        let below = format!(
            "suspect lines: 4, 2 (the wrong pixels depend most on these)\n\
             \x20              4:11  `1.0`\n\
             \x20              2:12  `b + c`\n\
             \x20            {CUT_SEARCH}\n"
        );
        assert!(full.contains(&below), "{full}");
        assert_eq!(text(&suspected(), Detail::Short, None).lines().count(), 1);
    }

    #[test]
    fn an_explanation_cut_by_time_is_told_from_a_budget_that_is_used_up() {
        for mut record in [repaired(), suspected()] {
            assert!(!text(&record, Detail::Normal, None).contains(CUT_BY_TIME));
            record.is_search_cut = false;
            record.is_cut_by_time = true;
            let normal = text(&record, Detail::Normal, None);
            assert!(
                normal.contains(CUT_BY_TIME) && !normal.contains(CUT_SEARCH),
                "{normal}"
            );
        }
    }

    #[test]
    fn the_table_of_checks_is_aligned() {
        let mut record = correct();
        record.algorithm.as_mut().unwrap().differing = 1234;
        let shown = text(&record, Detail::Full, None);
        let starts: Vec<_> = shown
            .lines()
            .skip(1)
            .take(3)
            .map(|line| line.find("  "))
            .collect();
        assert!(starts.iter().all(|start| *start == starts[0]), "{shown}");
        assert!(shown.contains("algorithm       1,234"), "{shown}");
    }
}
