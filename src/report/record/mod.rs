//! The report for programs: `verdict.json`, and `--format json` on standard output.

mod mistake;
mod position;
#[cfg(test)]
pub(super) mod samples;
mod seconds;
#[cfg(test)]
mod tests;

use std::io::{self, Write};

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{self as diagnostic, Files};
use toyproof_eval as eval;
use toyproof_explain::Findings;
use toyproof_explain::repair::SearchResult;
use toyproof_explain::unused::Unused;
use toyproof_glsl::{Checked, Dialect};
use toyproof_verify::compare::{CheckSummary, Comparison};
use toyproof_verify::{CheckResult, Evidence, Failure, Reason, Ruling, Verdict, decide};

pub use self::mistake::{Alternative, Mistake};
pub use self::position::Position;
pub use self::seconds::Seconds;
use super::departure::Departure;
use super::reason::{Statement, state, state_reason};
use super::unused::sentences;
use super::{
    DecisionRecord, FeatureRecord, FrameRecord, FunctionRecord, GrowthRecord, Repair, RulesRecord,
    StudentSubmission, Suspect,
};

/// The JSON Schema of a [`Report`].
pub const SCHEMA: &str = include_str!("../verdict.schema.json");

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
    /// The name, as the user gave it.
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
    /// The features of the image for which an assignment gives points.
    #[serde(default)]
    pub features: Vec<FeatureRecord>,
    /// The student and the assignment; null if no class is checked.
    #[serde(default)]
    pub submitted: Option<StudentSubmission>,
    /// What a teacher decided instead of the check; null if nothing.
    #[serde(default)]
    pub decision: Option<DecisionRecord>,
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
    #[must_use]
    pub fn title(&self) -> String {
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
            features: Vec::new(),
            submitted: None,
            decision: None,
            diagnostics: Vec::new(),
            seconds: Seconds::default(),
        }
    }

    /// Adds the findings, apart from their notes.
    fn set_findings(&mut self, findings: &Findings, files: &Files) {
        let summary = |check: &Option<CheckResult>| check.as_ref().map(|check| check.summary.clone());
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
        self.algorithm = summary(&findings.results.algorithm);
        self.precision = summary(&findings.results.precision);
        self.toolchain = summary(&findings.results.toolchain);
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
