//! The report for programs: `verdict.json`, and `--format json` on standard output.

use std::io::{self, Write};
use std::ops::AddAssign;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{self as diagnostic, Files};
use toyproof_eval as eval;
use toyproof_explain::Findings;
use toyproof_explain::known::{Diagnosis, KnownMistake};
use toyproof_explain::repair::SearchResult;
use toyproof_explain::unused::Unused;
use toyproof_glsl::{Checked, Dialect};
use toyproof_verify::compare::{CheckSummary, Comparison};
use toyproof_verify::{CheckResult, Evidence, Failure, Reason, Ruling, Verdict, decide};

use super::departure::Departure;
use super::reason::{Statement, state, state_reason};
use super::unused::sentences;
use super::{FrameRecord, FunctionRecord, GrowthRecord, Repair, RulesRecord, StudentSubmission, Suspect};

/// The JSON Schema of a [`Report`].
pub const SCHEMA: &str = include_str!("verdict.schema.json");

/// The statement of a record if no fix was searched for.
const UNSEARCHED: &str =
    "no fix was searched for: in a project of several passes, that takes a reference with the same passes";

/// All shaders of one run.
#[derive(Debug, Serialize)]
pub struct Report {
    version: u32,
    tool: String,
    /// The adapter and its driver; null if nothing ran on any.
    device: Option<String>,
    shaders: Vec<Record>,
}

impl Report {
    /// The version of the format.
    pub(super) const VERSION: u32 = 2;

    /// Creates a report of these shaders, in this order.
    #[must_use]
    pub fn new(device: Option<String>, shaders: Vec<Record>) -> Self {
        Self {
            version: Self::VERSION,
            tool: format!("toyproof {}", env!("CARGO_PKG_VERSION")),
            device,
            shaders,
        }
    }

    /// The adapter and its driver; `None` if nothing ran on any.
    #[must_use]
    pub fn device(&self) -> Option<&str> {
        self.device.as_deref()
    }

    /// The name and the version of the program.
    pub(super) fn tool(&self) -> &str {
        &self.tool
    }

    /// The shaders' records.
    #[must_use]
    pub fn shaders(&self) -> &[Record] {
        &self.shaders
    }

    /// Writes the report as `verdict.json`. Floats that are not finite are null.
    ///
    /// # Errors
    /// The report cannot be written.
    pub fn json(&self, out: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *out, self)?;
        out.write_all(b"\n")
    }
}

/// The findings on one shader. Checks that did not run are null.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Record {
    /// Its name, as the user gave it.
    pub shader: String,
    /// The name of the scene, if it was compared with one.
    pub scene: Option<String>,
    /// The file name of the shader or image that it was compared with instead.
    #[serde(default)]
    pub reference: Option<String>,
    /// The host for which it is written, and the version of GLSL; null if it does not compile.
    #[serde(default)]
    pub dialect: Option<DialectRecord>,
    /// The verdict.
    pub verdict: Verdict,
    /// Why, in one short sentence.
    pub reason: String,
    /// Further sentences on the reason, the most important first.
    #[serde(default)]
    pub details: Vec<String>,
    /// Details on what only the reference of a wrong shader uses, unless hints are turned off.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unused: Vec<String>,
    /// The command that shows more; null if there is nothing to show.
    #[serde(default)]
    pub help: Option<String>,
    /// The shader in f64 against the reference; null without one.
    pub algorithm: Option<CheckSummary>,
    /// The shader in f32 against the shader in f64.
    pub precision: Option<CheckSummary>,
    /// The GPU's image against the CPU's, bit by bit; null where no GPU rendered, or where it was free to
    /// rearrange arithmetic.
    pub toolchain: Option<CheckSummary>,
    /// The image against the reference; null if either is missing.
    #[serde(rename = "image")]
    pub comparison: Option<Comparison>,
    /// The known mistake, or the two, that explain a wrong image; null if none does.
    pub mistake: Option<Mistake>,
    /// The most likely edit after which a wrong shader is correct; null if none was found.
    #[serde(default)]
    pub fix: Option<Repair>,
    /// The statements of a wrong shader that most likely contain the mistake, the most suspicious first.
    #[serde(default)]
    pub suspects: Vec<Suspect>,
    /// Where the values of a wrong shader depart from those of its reference shader; null if that is unknown.
    #[serde(default)]
    pub departure: Option<Departure>,
    /// Whether the search for a fix ended before all edits were tried.
    #[serde(default)]
    pub is_search_cut: bool,
    /// Whether the time limit of explanations, which only a hang reaches, cut the explanation of the verdict:
    /// another run may find more.
    #[serde(default)]
    pub is_cut_by_time: bool,
    /// The likely cause of the verdict in the shader's text; null if none is known.
    #[serde(default)]
    pub cause: Option<Position>,
    /// How far float32 is from double precision after several frames; null if the image depends on no other
    /// frame.
    #[serde(default)]
    pub growth: Option<GrowthRecord>,
    /// The results in the frames of an assignment; the first frame with the worst verdict gives everything
    /// above. Null without an assignment.
    #[serde(default)]
    pub frames: Option<Vec<FrameRecord>>,
    /// The rules of an assignment; null if it has none.
    #[serde(default)]
    pub rules: Option<RulesRecord>,
    /// The tests of functions that an assignment has.
    #[serde(default)]
    pub functions: Vec<FunctionRecord>,
    /// The student and the assignment; null if no class is checked.
    #[serde(default)]
    pub submitted: Option<StudentSubmission>,
    /// The diagnostics on the shader and its scene.
    pub diagnostics: Vec<diagnostic::Json>,
    /// The time of each stage.
    pub seconds: Seconds,
}

/// The dialect of a shader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DialectRecord {
    /// The name of the host on the command line, such as `shadertoy`.
    pub host: String,
    /// The version of GLSL, such as `GLSL ES 3.00`.
    pub version: String,
}

impl DialectRecord {
    /// The dialect of a shader.
    #[must_use]
    pub fn new(checked: &Checked) -> Self {
        Self {
            host: checked.dialect.name().to_owned(),
            version: checked.version.name(),
        }
    }

    /// The dialect for people: `The Book of Shaders, GLSL ES 1.00`.
    pub(super) fn title(&self) -> String {
        let host = Dialect::named(&self.host).map(Dialect::title);
        format!("{}, {}", host.unwrap_or(&self.host), self.version)
    }
}

/// The result of the checks of a shader in one frame, from which [`Record::new`] makes a record.
#[derive(Debug)]
pub struct FrameResult<'a> {
    /// The name of the shader, as the user gave it.
    pub shader: &'a str,
    /// The name of the scene, if it was compared with one.
    pub scene: Option<&'a str>,
    /// The file name of the shader or image that it was compared with instead.
    pub reference: Option<&'a str>,
    /// The dialect in which it is written; `None` if it does not compile.
    pub dialect: Option<DialectRecord>,
    /// The findings, or why there is no image.
    pub findings: Result<&'a Findings, &'a Failure>,
    /// The files of the positions in the findings.
    pub files: &'a Files,
    /// The diagnostics on the shader and its scene.
    pub diagnostics: Vec<diagnostic::Json>,
    /// How far float32 is from double precision after several frames.
    pub growth: Option<GrowthRecord>,
    /// A sentence about the media that the shader reads and that are not available.
    pub missing_media: Option<String>,
    /// What only a reference shader uses, and its files.
    pub unused: Option<(Unused, &'a Files)>,
}

impl Record {
    /// Creates the record of a shader in one frame.
    #[must_use]
    pub fn new(result: FrameResult) -> Self {
        let mut record = Self {
            scene: result.scene.map(str::to_owned),
            reference: result.reference.map(str::to_owned),
            dialect: result.dialect,
            diagnostics: result.diagnostics,
            growth: result.growth,
            ..Self::unchecked(result.shader.to_owned())
        };
        match result.findings {
            Ok(findings) => record.set_findings(findings, result.files),
            Err(failure) => record.set_failure(failure, result.files),
        }
        if let Some(missing) = result.missing_media {
            record.set_missing_media(missing);
        }
        if let Some((unused, files)) = &result.unused {
            record.set_unused(unused, files);
            let departure = result
                .findings
                .ok()
                .and_then(|findings| findings.departure.as_ref());
            record.departure = departure.map(|found| Departure::new(found, result.files, files));
        }
        record
    }

    /// Creates the record of a shader that was not checked.
    #[must_use]
    pub fn unchecked(shader: String) -> Self {
        Self {
            shader,
            scene: None,
            reference: None,
            dialect: None,
            verdict: Verdict::Error,
            reason: String::new(),
            details: Vec::new(),
            unused: Vec::new(),
            help: None,
            algorithm: None,
            precision: None,
            toolchain: None,
            comparison: None,
            mistake: None,
            fix: None,
            suspects: Vec::new(),
            departure: None,
            is_search_cut: false,
            is_cut_by_time: false,
            cause: None,
            growth: None,
            frames: None,
            rules: None,
            functions: Vec::new(),
            submitted: None,
            diagnostics: Vec::new(),
            seconds: Seconds::default(),
        }
    }

    /// Adds the findings, apart from their notes.
    fn set_findings(&mut self, findings: &Findings, files: &Files) {
        let answer = |check: &Option<CheckResult>| check.as_ref().map(|check| check.summary.clone());
        self.verdict = findings.verdict;
        self.set_statement(state(findings, files));
        self.mistake = findings
            .mistake
            .as_ref()
            .map(|mistake| Mistake::new(mistake, files));
        if let Some(search) = &findings.search {
            self.set_search(search, files);
        }
        self.is_cut_by_time = findings.is_cut_by_time;
        self.cause = findings.cause.map(|cause| files.position(cause).into());
        self.algorithm = answer(&findings.results.algorithm);
        self.precision = answer(&findings.results.precision);
        self.toolchain = answer(&findings.results.toolchain);
        self.comparison = findings
            .results
            .comparison
            .as_ref()
            .map(|(comparison, _)| comparison.clone());
        let seconds = &mut self.seconds;
        seconds.eval = Some(findings.results.eval.as_secs_f64());
        seconds.trace = findings.results.trace.map(|trace| trace.as_secs_f64());
        if let Some(gpu_run) = &findings.results.gpu_run {
            seconds.translate = Some(gpu_run.translate.as_secs_f64());
            seconds.gpu = Some((gpu_run.compile + gpu_run.draw).as_secs_f64());
        }
    }

    /// States that media are missing, if the shader is compared with nothing: a successful rendering then
    /// means little.
    fn set_missing_media(&mut self, missing: String) {
        let verdict = self.verdict.with_missing_media();
        if verdict != self.verdict {
            (self.verdict, self.reason) = (verdict, missing);
        }
    }

    /// Adds what only the reference uses, if the shader is wrong. `files` are those of the reference.
    pub(super) fn set_unused(&mut self, unused: &Unused, files: &Files) {
        if self.verdict == Verdict::Wrong {
            self.unused = sentences(unused, files);
        }
    }

    /// Returns the record with the results of a search for a fix.
    #[must_use]
    pub fn with_search(mut self, search: &SearchResult, files: &Files) -> Self {
        self.set_search(search, files);
        self
    }

    /// Adds the results of the search for a fix. The fix names the mistake, unless a known one alone explains
    /// the image.
    fn set_search(&mut self, search: &SearchResult, files: &Files) {
        self.fix = Repair::first_of(&search.repairs, files);
        let suspects = search.suspects.iter();
        self.suspects = suspects
            .map(|suspect| Suspect::new(suspect, files, &self.shader))
            .collect();
        self.is_search_cut = search.is_cut;
        if let Some(repair) = search.repairs.first()
            && self.mistake.as_ref().is_none_or(Mistake::is_ambiguous)
        {
            self.mistake = Some(Mistake::from(&repair.mistake));
        }
    }

    /// Returns the record with the statement that no fix was searched for, because the image depends on other
    /// passes, and no reference has passes that correspond to them.
    #[must_use]
    pub fn with_unsearched(mut self) -> Self {
        self.details.push(UNSEARCHED.to_owned());
        self
    }

    /// Records why there is no image, apart from the diagnostics.
    fn set_failure(&mut self, failure: &Failure, files: &Files) {
        if matches!(failure, Failure::Gpu(failure) if failure.is_without_driver()) {
            self.help = Some("toyproof doctor".to_owned());
        }
        let Ruling { verdict, reason } = decide(Evidence::NoImage(failure.clone()));
        self.verdict = verdict;
        if let Reason::NoImage(Failure::Cpu(
            eval::Failure::TooOften { at, .. } | eval::Failure::Timeout { at },
        )) = &reason
        {
            self.cause = Some(files.position(at.span).into());
        }
        self.set_statement(state_reason(&reason, files));
    }

    /// The name of the scene or of the reference that it was compared with.
    pub(super) fn compared_with(&self) -> Option<&str> {
        self.scene.as_deref().or(self.reference.as_deref())
    }

    fn set_statement(&mut self, statement: Statement) {
        (self.reason, self.details) = (statement.reason, statement.details);
    }

    /// The reason why the toolchain check did not run although other checks did.
    pub(super) fn skipped_toolchain_reason(&self) -> Option<&'static str> {
        let others = self.algorithm.is_some() || self.precision.is_some();
        (others && self.toolchain.is_none()).then_some(if self.seconds.gpu.is_some() {
            "not run: --float fast lets the driver rearrange arithmetic"
        } else {
            "not run: no GPU rendered the shader"
        })
    }
}

/// A position in a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl From<diagnostic::Position> for Position {
    fn from(diagnostic::Position { line, column }: diagnostic::Position) -> Self {
        Self { line, column }
    }
}

/// The mistake that explains a wrong image.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Mistake {
    /// Its name, such as `far-root`; for two combined mistakes both names: `no-aspect+no-gamma`.
    pub id: String,
    /// The mistake in the shader, in one sentence.
    pub text: String,
    /// Whether it describes the image, which many mistakes may cause, and not a mistake.
    pub is_symptom: bool,
    /// Other mistakes that render the same image, the most likely first.
    pub alternatives: Vec<Alternative>,
}

/// Another mistake that renders the same image.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Alternative {
    /// Its name.
    pub id: String,
    /// What is wrong in the shader, in one sentence.
    pub text: String,
}

impl Mistake {
    /// Combines the recognized mistakes; `files` are those of the shader.
    #[must_use]
    pub fn new(diagnosis: &Diagnosis, files: &Files) -> Self {
        let texts = diagnosis.mistakes.iter().map(|mistake| match mistake.at {
            Some(at) => format!("{} (line {})", mistake.description, files.position(at).line),
            None => mistake.description.to_string(),
        });
        let alternatives = diagnosis.alternatives.iter().map(|other| Alternative {
            id: other.id.to_owned(),
            text: other.description.to_string(),
        });
        Self {
            id: diagnosis.id(),
            text: texts.collect::<Vec<_>>().join("; and "),
            is_symptom: diagnosis.mistakes.iter().all(|mistake| mistake.is_symptom),
            alternatives: alternatives.collect(),
        }
    }

    /// Whether several mistakes may be meant.
    fn is_ambiguous(&self) -> bool {
        self.is_symptom || !self.alternatives.is_empty()
    }

    /// Its name in a report.
    pub(super) fn label(&self) -> &'static str {
        if self.is_symptom {
            "symptom"
        } else {
            "likely mistake"
        }
    }
}

impl From<&KnownMistake> for Mistake {
    /// A single mistake without alternatives.
    fn from(mistake: &KnownMistake) -> Self {
        Self {
            id: mistake.id.to_owned(),
            text: mistake.description.to_string(),
            is_symptom: mistake.is_symptom,
            alternatives: Vec::new(),
        }
    }
}

/// Times in seconds; null for stages that did not run.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Seconds {
    /// naga: parse, validate, write.
    pub translate: Option<f64>,
    /// The driver: compile, render, read back.
    pub gpu: Option<f64>,
    /// The evaluator: compile, and render every image in f32 and f64.
    pub eval: Option<f64>,
    /// The reference: tracing a scene, or evaluating a shader.
    pub trace: Option<f64>,
    /// All that was done for the shader, also the search for mistakes and fixes and its images; null if it
    /// cannot be read, or nothing is written.
    pub all: Option<f64>,
}

impl Seconds {
    /// The sum of all stages; some of them ran in parallel.
    #[must_use]
    pub fn total(&self) -> f64 {
        let parts = [self.translate, self.gpu, self.eval, self.trace];
        // The sum of an empty iterator is −0.
        parts.into_iter().flatten().fold(0.0, |sum, part| sum + part)
    }
}

impl AddAssign for Seconds {
    fn add_assign(&mut self, other: Self) {
        let sum = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(|a, b| a + b);
        self.translate = sum(self.translate, other.translate);
        self.gpu = sum(self.gpu, other.gpu);
        self.eval = sum(self.eval, other.eval);
        self.trace = sum(self.trace, other.trace);
        self.all = sum(self.all, other.all);
    }
}

/// Sample records for the tests of the formats.
#[cfg(test)]
pub(super) mod samples {
    use toyproof_diagnostic::{self as diagnostic, File, Files, Severity};
    use toyproof_verify::Verdict;
    use toyproof_verify::compare::CheckSummary;

    use crate::{Record, Rubric, Seconds};

    /// A record with this verdict, which is also its name, without checks.
    pub(crate) fn record(verdict: Verdict) -> Record {
        Record {
            scene: Some("scene.toml".to_owned()),
            verdict,
            reason: format!("it is {verdict}"),
            seconds: Seconds {
                gpu: Some(1.0),
                eval: Some(0.5),
                ..Seconds::default()
            },
            ..Record::unchecked(verdict.to_string())
        }
    }

    /// A summary of 1,000 pixels: the numbers that differ, are ill-conditioned and are undefined.
    pub(crate) fn check_summary([differing, ill_conditioned, undefined]: [u64; 3]) -> CheckSummary {
        CheckSummary {
            pixels: 1000,
            differing,
            ill_conditioned,
            undefined,
            max_abs: 0.25,
            ..CheckSummary::default()
        }
    }

    pub(crate) fn correct() -> Record {
        Record {
            algorithm: Some(check_summary([0; 3])),
            precision: Some(check_summary([0; 3])),
            toolchain: Some(check_summary([0; 3])),
            ..record(Verdict::Correct)
        }
    }

    pub(crate) fn invalid() -> Record {
        let mut record = record(Verdict::Invalid);
        record.diagnostics.push(diagnostic::Json {
            severity: Severity::Error,
            code: "E0301".to_owned(),
            message: "unknown name".to_owned(),
            file: Some("a.glsl".to_owned()),
            line: Some(2),
            column: Some(3),
            end_line: Some(2),
            end_column: Some(7),
            fix: Some(diagnostic::JsonFix {
                message: "did you mean `near`?".to_owned(),
                replacement: "near".to_owned(),
                line: 2,
                column: 3,
                end_line: 2,
                end_column: 7,
            }),
            notes: vec!["declare it".to_owned()],
        });
        record
    }

    /// One record of each verdict.
    pub(crate) fn every_verdict() -> Vec<Record> {
        let mut wrong = record(Verdict::Wrong);
        wrong.algorithm = Some(check_summary([500, 0, 0]));
        let mut unstable = correct();
        (unstable.shader, unstable.verdict) = ("unstable".to_owned(), Verdict::Unstable);
        unstable.precision = Some(check_summary([500, 0, 0]));
        vec![
            record(Verdict::Missing),
            invalid(),
            record(Verdict::Timeout),
            record(Verdict::Error),
            wrong,
            unstable,
            record(Verdict::Inconclusive),
            correct(),
            record(Verdict::Ok),
        ]
    }

    impl Rubric {
        /// A rubric without partial points for `compiles`, `algorithm` and `precision`.
        pub(crate) fn with_points(compiles: f64, algorithm: f64, precision: f64) -> Self {
            let text = format!(
                "compiles.points = {compiles:?}\nalgorithm.points = {algorithm:?}\nprecision.points = {precision:?}"
            );
            let mut files = Files::default();
            let file = files.add(File::new("r.toml", text));
            Self::parse(&files, file).unwrap()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::samples::in_frames;
    use crate::record::samples::{every_verdict, record};
    use crate::repair::samples::{repaired, suspected};
    use crate::{Hints, growth, repair, written};

    #[test]
    fn reports_follow_the_schema_and_broken_ones_do_not() {
        let schema = serde_json::from_str(SCHEMA).unwrap();
        let validator = jsonschema::validator_for(&schema).unwrap();
        let black = toyproof_image::Image::new(1, 1, vec![[0.0; 4]]);
        let white = toyproof_image::Image::new(1, 1, vec![[1.0; 4]]);
        let (comparison, _) = toyproof_verify::compare::compare(&black, &white);
        let answer = CheckSummary::new(&black, &white, &[toyproof_verify::compare::PixelStatus::Differs]);
        let with_checks = Record {
            algorithm: Some(answer.clone()),
            precision: Some(answer.clone()),
            toolchain: Some(answer),
            comparison: Some(comparison),
            ..record(Verdict::Ok)
        };
        let mut records = every_verdict();
        records.extend([with_checks, repaired(), suspected()]);
        records.push(repaired().redacted(Hints::Line));
        records.push(in_frames([Verdict::Correct, Verdict::Wrong]));
        records.push(Record {
            growth: Some(growth::samples::chaotic(5)),
            ..record(Verdict::Chaotic)
        });
        let report = Report::new(Some("x".to_owned()), records);
        let mut json: serde_json::Value = serde_json::from_str(&written(|out| report.json(out))).unwrap();
        assert!(
            validator.is_valid(&json),
            "{:?}",
            validator.iter_errors(&json).collect::<Vec<_>>()
        );
        for (path, value) in [
            ("/shaders/10/fix/line", 0.into()),
            ("/shaders/10/fix/edits", serde_json::json!([])),
            ("/shaders/10/fix/alternatives/0/agreeing", "many".into()),
            ("/shaders/11/suspects/0/score", 2.into()),
            ("/shaders/14/growth/cause", "fate".into()),
            ("/shaders/14/growth/frames/0/differing", (-1).into()),
            ("/shaders/13/frames/0/size", serde_json::json!([0, 4])),
            ("/shaders/13/frames/1/verdict", "splendid".into()),
            ("/shaders/0/verdict", "splendid".into()),
        ] {
            let mut json = json.clone();
            *json.pointer_mut(path).unwrap() = value;
            assert!(!validator.is_valid(&json), "{path}");
        }
        json["shaders"][0].as_object_mut().unwrap().remove("verdict");
        assert!(!validator.is_valid(&json));
    }
    #[test]
    fn the_fix_has_the_keys_that_programs_read() {
        let json = serde_json::to_value(repaired()).unwrap();
        let fix = &json["fix"];
        let edit = serde_json::json!({
            "line": 2, "column": 12, "end_line": 2, "end_column": 17,
            "replacement": "b - c", "text": "replace `b + c` with `b - c`",
        });
        assert_eq!(fix["edits"], serde_json::json!([edit]));
        for (key, value) in edit.as_object().unwrap() {
            assert_eq!(fix[key], *value, "{key}");
        }
        let rest = ["id", "file", "agreeing", "pixels"].map(|key| fix[key].clone());
        assert_eq!(
            serde_json::json!(rest),
            serde_json::json!(["wrong-operator", "wrong", 14_400, 14_400])
        );
        assert_eq!(fix["alternatives"][0]["id"], "wrong-number");
        assert_eq!(fix["alternatives"][0]["edits"].as_array().unwrap().len(), 2);
        let suspect = &json["suspects"][0];
        assert_eq!((&suspect["line"], &suspect["score"]), (&4.into(), &0.5.into()));
        assert_eq!(json["is_search_cut"], true);
    }

    #[test]
    fn records_are_read_back_also_from_older_reports() {
        let json = serde_json::to_value(repaired()).unwrap();
        let read: Record = serde_json::from_value(json.clone()).unwrap();
        assert_eq!(serde_json::to_value(&read).unwrap(), json);
        let mut older = json;
        for key in ["fix", "suspects", "is_search_cut", "is_cut_by_time"] {
            older.as_object_mut().unwrap().remove(key).unwrap();
        }
        let read: Record = serde_json::from_value(older).unwrap();
        assert_eq!((read.fix, read.suspects.len()), (None, 0));
    }

    #[test]
    fn a_fix_names_the_mistake_unless_a_known_one_explains_the_image() {
        assert_eq!(repaired().mistake.unwrap().id, "wrong-operator");
        let (files, result) = repair::samples::search();
        let mut known = record(Verdict::Wrong);
        known.mistake = Some(Mistake {
            id: "no-shadows".to_owned(),
            text: "shadows are missing".to_owned(),
            is_symptom: false,
            alternatives: Vec::new(),
        });
        let known = known.with_search(&result, &files);
        assert_eq!(known.mistake.unwrap().id, "no-shadows");
        assert_eq!(known.fix.unwrap().id, "wrong-operator");
    }
}
