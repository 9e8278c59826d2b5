//! The repairs of a wrong shader and its suspect lines, as parts of a record.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Edit, Files, Span, all_of, grouped};
use toyproof_explain::repair;

use super::reason::excerpt;

/// A part of a source text. Lines and columns count from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceRange {
    /// The line of the first character.
    pub line: usize,
    /// The column of the first character.
    pub column: usize,
    /// The line of the end.
    pub end_line: usize,
    /// The column of the end, exclusive; of an insertion, the end is the start.
    pub end_column: usize,
}

impl SourceRange {
    pub(super) fn new(span: Span, files: &Files) -> Self {
        let (start, end) = (files.position(span), files.end_position(span));
        Self {
            line: start.line,
            column: start.column,
            end_line: end.line,
            end_column: end.column,
        }
    }
}

/// An edit of a shader, or several at once, after which its image is the expected one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Repair {
    /// The id of the mistake that the edits correct, such as `wrong-operator`.
    pub id: String,
    /// The name of the file.
    pub file: String,
    /// The range of the first edit.
    #[serde(flatten)]
    pub range: SourceRange,
    /// The replacement of the first edit; `None` if [`Hints`](super::Hints) hide the edits.
    pub replacement: Option<String>,
    /// The advice, such as ``replace `b + c` with `b - c` ``; `None` if the edits are hidden.
    pub text: Option<String>,
    /// The number of pixels that agree with the reference after the edits.
    pub agreeing: u64,
    /// The number of pixels that were compared.
    pub pixels: u64,
    /// Whether the means of the pixels agree, because the shader has random numbers of its own.
    #[serde(default)]
    pub by_means: bool,
    /// All edits, in the order of the text.
    pub edits: Vec<RepairEdit>,
    /// Other repairs, the most likely first; empty for a repair that is itself an alternative.
    #[serde(default)]
    pub alternatives: Vec<Self>,
}

/// An edit of a [`Repair`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RepairEdit {
    /// The text to replace.
    #[serde(flatten)]
    pub range: SourceRange,
    /// The replacement; `None` if the edits are hidden.
    pub replacement: Option<String>,
    /// The advice; `None` if the edits are hidden.
    pub text: Option<String>,
}

impl RepairEdit {
    fn new(edit: &Edit, files: &Files) -> Self {
        let (old, new) = (files.text(edit.span).trim(), edit.replacement.trim());
        let text = match (old, new) {
            ("", new) => format!("insert {}", excerpt(new)),
            (old, "") => format!("remove {}", excerpt(old)),
            (old, new) => format!("replace {} with {}", excerpt(old), excerpt(new)),
        };
        Self {
            range: SourceRange::new(edit.span, files),
            replacement: Some(edit.replacement.clone()),
            text: Some(text),
        }
    }

    fn hide(&mut self) {
        (self.replacement, self.text) = (None, None);
    }
}

impl Repair {
    /// The first repair, with the others as its alternatives; `None` if there are none.
    pub(super) fn first_of(repairs: &[repair::Repair], files: &Files) -> Option<Self> {
        let mut repairs = repairs.iter().filter_map(|repair| Self::new(repair, files));
        let first = repairs.next()?;
        let mut alternatives: Vec<Self> = Vec::new();
        for other in repairs {
            // Edits of whole statements and of their parts may read alike.
            let is_new = |known: &Self| known.summary() != other.summary();
            if is_new(&first) && alternatives.iter().all(is_new) {
                alternatives.push(other);
            }
        }
        Some(Self {
            alternatives,
            ..first
        })
    }

    /// None if the repair has no edits.
    fn new(repair: &repair::Repair, files: &Files) -> Option<Self> {
        let mut edits: Vec<&Edit> = repair.fix.edits.iter().collect();
        edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
        // Of a statement that moves, the place where it is.
        let main = edits.iter().find(|edit| edit.span.start < edit.span.end);
        let main = *main.or(edits.first())?;
        Some(Self {
            id: repair.mistake.id.to_owned(),
            file: files.name(main.span).to_owned(),
            range: SourceRange::new(main.span, files),
            replacement: Some(main.replacement.clone()),
            text: Some(repair.fix.message.clone()),
            agreeing: repair.agreeing,
            pixels: repair.pixels,
            by_means: repair.by_means,
            edits: edits
                .into_iter()
                .map(|edit| RepairEdit::new(edit, files))
                .collect(),
            alternatives: Vec::new(),
        })
    }

    /// Removes the texts of the edits; their lines stay.
    pub(super) fn hide_edits(&mut self) {
        (self.replacement, self.text) = (None, None);
        self.edits.iter_mut().for_each(RepairEdit::hide);
        self.alternatives.iter_mut().for_each(Self::hide_edits);
    }

    /// The lines of the edits, in their order, without duplicates.
    fn lines(&self) -> Vec<String> {
        let mut lines: Vec<_> = self.edits.iter().map(|edit| edit.range.line).collect();
        lines.dedup();
        lines.iter().map(usize::to_string).collect()
    }

    /// States the edits with their lines: ``line 23: replace `b + c` with `b - c` ``. If they are hidden,
    /// states only the lines: “an edit of line 23”.
    #[must_use]
    pub fn summary(&self) -> String {
        let lines = self.lines();
        let Some(text) = &self.text else {
            return match (&lines[..], self.edits.len()) {
                ([line], 1) => format!("an edit of line {line}"),
                ([line], _) => format!("edits of line {line}"),
                (lines, _) => format!("edits of lines {}", all_of(lines)),
            };
        };
        match &lines[..] {
            [line] => return format!("line {line}: {text}"),
            // One change, such as a statement that moves.
            lines if repair::corrects_one_mistake(&self.id) => {
                return format!("lines {}: {text}", all_of(lines));
            }
            _ => {}
        }
        let edits = self.edits.iter().map(|edit| {
            let text = edit.text.as_deref().unwrap_or_default();
            format!("line {}: {text}", edit.range.line)
        });
        edits.collect::<Vec<_>>().join(", and ")
    }

    /// States how many pixels agree after the edits: “then all 14,400 pixels agree”.
    #[must_use]
    pub fn effect(&self) -> String {
        let (agreeing, pixels) = (grouped(self.agreeing), grouped(self.pixels));
        if self.by_means {
            "then the means of all pixels agree".to_owned()
        } else if self.agreeing == self.pixels {
            format!("then all {pixels} pixels agree")
        } else {
            format!("then {agreeing} of {pixels} pixels agree")
        }
    }

    /// States the edits and their effect.
    #[must_use]
    pub fn sentence(&self) -> String {
        format!("{}; {}", self.summary(), self.effect())
    }
}

/// The tab of a project that a file is, such as `buffer-a.glsl`; `None` for the file of a single shader.
pub(super) fn tab<'a>(file: &'a str, shader: &str) -> Option<&'a str> {
    file.strip_prefix(shader)?
        .strip_prefix('/')
        .filter(|tab| !tab.is_empty())
}

/// The file of a repair before its lines, if the shader has several: “in buffer-a.glsl, ”.
pub(super) fn in_tab(repair: &Repair, shader: &str) -> String {
    tab(&repair.file, shader).map_or_else(String::new, |tab| format!("in {tab}, "))
}

/// A statement on which the wrong pixels depend more than the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Suspect {
    /// The statement.
    #[serde(flatten)]
    pub range: SourceRange,
    /// The name of the file, if the shader has several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The suspicion, from 0 to 1.
    pub score: f64,
    /// The statement's text on one line, shortened, in backticks.
    pub text: String,
}

impl Suspect {
    pub(super) fn new(suspect: &repair::Suspect, files: &Files, shader: &str) -> Self {
        let file = files.name(suspect.span);
        Self {
            range: SourceRange::new(suspect.span, files),
            file: tab(file, shader).map(|_| file.to_owned()),
            score: suspect.score,
            text: excerpt(files.text(suspect.span)),
        }
    }

    /// The line, after the tab of a project that it is in: `buffer-a.glsl:35`.
    pub(super) fn place(&self) -> String {
        let line = self.range.line;
        let tab = self.file.as_deref().and_then(|file| file.rsplit('/').next());
        tab.map_or_else(|| line.to_string(), |tab| format!("{tab}:{line}"))
    }
}

/// The label of the suspects, and their lines: `suspect lines`, `35, 33, 52`. `None` without suspects.
pub(super) fn suspect_lines(suspects: &[Suspect]) -> Option<(&'static str, String)> {
    let lines = suspects.iter().map(Suspect::place);
    let label = match suspects {
        [] => return None,
        [_] => "suspect line",
        _ => "suspect lines",
    };
    Some((label, lines.collect::<Vec<_>>().join(", ")))
}

/// Records of wrong shaders for the tests of the formats.
#[cfg(test)]
pub(super) mod samples {
    use toyproof_diagnostic::{File, Files, Fix, Span};
    use toyproof_explain::known::KnownMistake;
    use toyproof_explain::repair::{Repair, SearchResult, Suspect};
    use toyproof_image::Rgb8Image;
    use toyproof_verify::Verdict;

    use crate::Record;
    use crate::record::samples::{check_summary, record};

    /// The shader of the samples. `é` is one character of two bytes.
    pub(crate) const SOURCE: &str = "float é(float b, float c) {\n    return b + c;\n}\nfloat k = 1.0;\n";

    /// The span of a text that occurs once in the shader.
    fn span(files: &mut Files, text: &str) -> Span {
        let file = files.add(File::new("wrong", SOURCE));
        let start = SOURCE.find(text).unwrap();
        Span::new(file, start as u32, (start + text.len()) as u32)
    }

    /// A repair of the operator in line 2, one of both lines 2 and 4, and suspects in these lines.
    pub(crate) fn search() -> (Files, SearchResult) {
        let mut files = Files::default();
        let [sum, number] = ["b + c", "1.0"].map(|text| span(&mut files, text));
        let repair = |id, fix, agreeing| Repair {
            fix,
            mistake: KnownMistake {
                at: None,
                id,
                description: "an operator is wrong".into(),
                is_symptom: false,
            },
            agreeing,
            pixels: 14_400,
            by_means: false,
            image: Rgb8Image::new(1, 1, vec![[0; 3]]),
        };
        let operator = Fix::new("replace `b + c` with `b - c`", sum, "b - c");
        let both = Fix::new("change <both>", number, "2.0").and(sum, "");
        let result = SearchResult {
            repairs: vec![
                repair("wrong-operator", operator, 14_400),
                repair("two-mistakes", both, 14_398),
            ],
            suspects: vec![
                Suspect {
                    span: number,
                    score: 0.5,
                },
                Suspect {
                    span: sum,
                    score: 0.25,
                },
            ],
            is_cut: true,
        };
        (files, result)
    }

    /// A wrong shader with a repair, an alternative and suspects.
    pub(crate) fn repaired() -> Record {
        let (files, result) = search();
        Record {
            help: Some("toyproof explain wrong-operator".to_owned()),
            ..searched(&files, &result)
        }
    }

    /// A wrong shader with suspects, but without a repair.
    pub(crate) fn suspected() -> Record {
        let (files, mut result) = search();
        result.repairs.clear();
        searched(&files, &result)
    }

    fn searched(files: &Files, result: &SearchResult) -> Record {
        let mut record = record(Verdict::Wrong);
        record.algorithm = Some(check_summary([500, 0, 0]));
        record.with_search(result, files)
    }
}

#[cfg(test)]
mod tests {
    use super::samples::{repaired, search, suspected};
    use super::*;

    #[test]
    fn repairs_are_stated_with_their_lines_and_effect() {
        let fix = repaired().fix.unwrap();
        assert_eq!(
            fix.sentence(),
            "line 2: replace `b + c` with `b - c`; then all 14,400 pixels agree"
        );
        assert_eq!(
            fix.alternatives[0].sentence(),
            "line 2: remove `b + c`, and line 4: replace `1.0` with `2.0`; then 14,398 of 14,400 pixels agree"
        );
    }

    #[test]
    fn a_change_of_several_lines_is_stated_once_and_alternatives_that_read_alike_too() {
        let (files, mut result) = search();
        result.repairs[1].mistake.id = "misplaced-statement";
        result.repairs.push(result.repairs[1].clone());
        let fix = Repair::first_of(&result.repairs, &files).unwrap();
        let [only] = &fix.alternatives[..] else {
            panic!("{:?}", fix.alternatives);
        };
        assert_eq!(only.summary(), "lines 2 and 4: change <both>");
    }

    #[test]
    fn edits_of_one_line_are_stated_by_the_message_of_their_fix() {
        let (files, mut result) = search();
        let edits = &mut result.repairs[0].fix.edits;
        let mut second = edits[0].clone();
        second.span.start += 4;
        edits[0].span.end -= 4;
        edits.push(second);
        let mut fix = Repair::first_of(&result.repairs, &files).unwrap();
        assert_eq!(fix.edits.len(), 2);
        assert_eq!(fix.summary(), "line 2: replace `b + c` with `b - c`");
        fix.hide_edits();
        assert_eq!(fix.summary(), "edits of line 2");
    }

    #[test]
    fn ranges_count_characters_and_start_at_the_first_edit() {
        let fix = repaired().fix.unwrap();
        let range = SourceRange {
            line: 2,
            column: 12,
            end_line: 2,
            end_column: 17,
        };
        assert_eq!((fix.range, fix.replacement.as_deref()), (range, Some("b - c")));
        let other = &fix.alternatives[0];
        assert_eq!((other.range, other.replacement.as_deref()), (range, Some("")));
        assert_eq!(fix.file, "wrong");
    }

    #[test]
    fn hidden_edits_keep_their_lines() {
        let mut fix = repaired().fix.unwrap();
        fix.hide_edits();
        let json = serde_json::to_string(&fix).unwrap();
        assert!(!json.contains("b - c") && !json.contains("2.0"), "{json}");
        assert_eq!(fix.sentence(), "an edit of line 2; then all 14,400 pixels agree");
        assert_eq!(fix.alternatives[0].summary(), "edits of lines 2 and 4");
    }

    #[test]
    fn insertions_and_long_texts_are_readable() {
        let (files, result) = search();
        let mut edit = result.repairs[0].fix.edits[0].clone();
        edit.span.end = edit.span.start;
        edit.replacement = format!("\n  a\n{}", "b".repeat(99));
        let text = RepairEdit::new(&edit, &files).text.unwrap();
        assert!(
            text.starts_with("insert `a bbb") && text.ends_with("b` …"),
            "{text}"
        );
        assert!(text.len() < 90, "{text}");
    }

    #[test]
    fn suspects_keep_their_order() {
        let suspects = suspected().suspects;
        assert_eq!(
            suspect_lines(&suspects),
            Some(("suspect lines", "4, 2".to_owned()))
        );
        assert_eq!(suspect_lines(&suspects[..1]).unwrap().0, "suspect line");
        assert_eq!(suspect_lines(&[]), None);
        assert_eq!(suspects[1].text, "`b + c`");
    }
}
