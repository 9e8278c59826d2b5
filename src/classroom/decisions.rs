//! `decisions.toml`: what a teacher decides on single shaders instead of the check.

use std::collections::BTreeSet;
use std::fmt;

use toyproof_diagnostic::{Code, Diagnostics, FileId, Files, nearest};
use toyproof_report::{Decision, StudentSubmission, optional_points};
use toyproof_toml::{Format, Table};
use toyproof_verify::Verdict;

/// The name of the file, which is used beside the file of an assignment or of a class.
pub const FILE_NAME: &str = "decisions.toml";

static FORMAT: Format = Format {
    form_code: Code::AssignmentSyntax,
    value_code: Code::AssignmentValue,
    aliases: &[],
};

/// The verdicts that can be decided. An `error` is not a shader's, and `ok` compares nothing.
const VERDICTS: [(&str, Verdict); 8] = [
    ("correct", Verdict::Correct),
    ("wrong", Verdict::Wrong),
    ("unstable", Verdict::Unstable),
    ("chaotic", Verdict::Chaotic),
    ("inconclusive", Verdict::Inconclusive),
    ("timeout", Verdict::Timeout),
    ("invalid", Verdict::Invalid),
    ("missing", Verdict::Missing),
];

/// The decisions of a teacher.
#[derive(Debug, Clone, Default)]
pub struct Decisions(Vec<DecidedShader>);

/// A decision, and the shaders that it is about.
#[derive(Debug, Clone)]
struct DecidedShader {
    subject: Subject,
    decision: Decision,
    /// The file and the line of the decision, for messages.
    place: String,
}

/// The shaders of a decision.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Subject {
    /// A shader, by its path in the report.
    Shader(String),
    /// A student, by name or number, in an assignment of a class or in all.
    Student {
        student: String,
        assignment: Option<String>,
    },
}

impl Subject {
    /// Whether a shader with this path in the report, and this author, is one of them.
    fn has(&self, shader: &str, submitted: Option<&StudentSubmission>) -> bool {
        match (self, submitted) {
            (Self::Shader(path), _) => plain(path) == plain(shader),
            (Self::Student { student, assignment }, Some(submitted)) => {
                (*student == submitted.student || Some(student) == submitted.id.as_ref())
                    && (assignment.is_none() || *assignment == submitted.assignment)
            }
            (Self::Student { .. }, None) => false,
        }
    }

    /// The value that names them.
    fn name(&self) -> &str {
        match self {
            Self::Shader(name) | Self::Student { student: name, .. } => name,
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.name())?;
        match self {
            Self::Student {
                assignment: Some(assignment),
                ..
            } => write!(f, " in the assignment `{assignment}`"),
            _ => Ok(()),
        }
    }
}

/// A path without a leading `./`.
fn plain(path: &str) -> &str {
    path.strip_prefix("./").unwrap_or(path)
}

impl Decisions {
    /// Parses the decisions of a file. Those on students that name no assignment are on the given one.
    ///
    /// # Errors
    /// The first syntax error of the TOML, or all other errors.
    pub fn parse(files: &Files, file: FileId, assignment: Option<&str>) -> Result<Self, Diagnostics> {
        toyproof_toml::read(&FORMAT, files, file, |document| {
            let mut decisions: Vec<DecidedShader> = Vec::new();
            document.tables("decision", |table| {
                let Some((subject, decision)) = decision(table, assignment) else {
                    return;
                };
                if decisions.iter().any(|other| other.subject == subject) {
                    let message = format!("there are two decisions on {subject}");
                    table.reject(table.span(), message, "remove one of them");
                }
                let line = files.position(table.span()).line;
                decisions.push(DecidedShader {
                    subject,
                    decision,
                    place: format!("{}:{line}", files.get(file).name()),
                });
            });
            document.report_unknown_keys();
            Self(decisions)
        })
    }

    /// Adds the decisions of another file, or of the same one for another assignment.
    pub fn extend(&mut self, others: Self) {
        for other in others.0 {
            if self.0.iter().all(|known| known.subject != other.subject) {
                self.0.push(other);
            }
        }
    }

    /// The decision on a shader with this path in the report, and this author. One that names the shader
    /// precedes one on the student.
    #[must_use]
    pub fn find(&self, shader: &str, submitted: Option<&StudentSubmission>) -> Option<&Decision> {
        let on = |one: &&DecidedShader| one.subject.has(shader, submitted);
        let names_shader = |one: &&DecidedShader| matches!(one.subject, Subject::Shader(_));
        let named = self.0.iter().filter(on).find(names_shader);
        named.or_else(|| self.0.iter().find(on)).map(|one| &one.decision)
    }

    /// A warning for each decision that is on none of these shaders, with advice if a name looks like a
    /// typing error, and for each that is on several students of one name.
    #[must_use]
    pub fn warnings(
        &self,
        shaders: &[(String, Option<&StudentSubmission>)],
    ) -> Vec<(String, Option<String>)> {
        let students = shaders.iter().filter_map(|(_, submitted)| *submitted);
        let students: BTreeSet<&str> = students.map(|one| one.student.as_str()).collect();
        let warning = |one: &DecidedShader| {
            let (name, subject) = (one.subject.name(), &one.subject);
            let mut decided = shaders
                .iter()
                .filter(|(shader, submitted)| subject.has(shader, *submitted))
                .peekable();
            if decided.peek().is_none() {
                let near = match subject {
                    Subject::Shader(_) => nearest(name, shaders.iter().map(|(shader, _)| shader.as_str())),
                    Subject::Student { .. } => nearest(name, students.iter().copied()),
                };
                let message = format!("{}: no shader matches the decision on {subject}", one.place);
                let near = near.filter(|near| *near != name);
                return Some((message, near.map(|near| format!("did you mean `{near}`?"))));
            }
            let is_of_student = matches!(subject, Subject::Student { .. });
            let ids: BTreeSet<_> = decided
                .filter_map(|(_, submitted)| submitted.as_ref()?.id.as_ref())
                .collect();
            (is_of_student && ids.len() > 1).then(|| {
                let message = format!(
                    "{}: the decision is on {} students named {subject}",
                    one.place,
                    ids.len()
                );
                (
                    message,
                    Some("give the number of one: `student = \"1234\"`".to_owned()),
                )
            })
        };
        self.0.iter().filter_map(warning).collect()
    }
}

/// Reads a decision; `None` if a key is missing.
fn decision(table: &mut Table, default: Option<&str>) -> Option<(Subject, Decision)> {
    let shader = table.optional::<String>("shader");
    let student = table.optional::<String>("student");
    let assignment = table.optional::<String>("assignment");
    let verdict = table.choice("verdict", "verdict", &VERDICTS);
    let points = optional_points(table);
    let reason = table.required::<String>("reason");
    if let Some(reason) = reason.as_ref().filter(|reason| reason.value.trim().is_empty()) {
        let help = "the author of the shader reads it";
        table.reject(reason.span, "`reason` is empty", help);
    }
    if let (Some(_), Some(other)) = (&shader, student.as_ref().or(assignment.as_ref())) {
        let message = "`shader` cannot be used with `student` or `assignment`";
        table.reject(other.span, message, "remove one of them");
    }
    let subject = match (shader, student) {
        (Some(shader), _) => Some(Subject::Shader(shader.value)),
        (None, Some(student)) => Some(Subject::Student {
            student: student.value,
            assignment: assignment.map(|name| name.value).or(default.map(str::to_owned)),
        }),
        (None, None) => {
            if table.is_valid() {
                let help =
                    "add `shader = \"homework/mai.glsl\"` as in the report, or `student = \"Mai Lin\"`";
                table.reject(table.span(), "the decision has no shader", help);
            }
            None
        }
    };
    if verdict.is_none() && points.is_none() && table.is_valid() {
        let help = "add `verdict = \"correct\"`, `points = 9` or both";
        table.reject(table.span(), "the decision changes nothing", help);
    }
    let decision = Decision {
        verdict: verdict.map(|verdict| verdict.value),
        points,
        // One line, as reports show it.
        reason: reason?.value.split_whitespace().collect::<Vec<_>>().join(" "),
    };
    Some((subject?, decision))
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::File;

    use super::*;

    fn parse(text: &str) -> Result<Decisions, String> {
        let mut files = Files::default();
        let file = files.add(File::new("decisions.toml", text));
        Decisions::parse(&files, file, None).map_err(|errors| errors.to_string())
    }

    fn submitted(student: &str, assignment: &str) -> StudentSubmission {
        StudentSubmission {
            assignment: Some(assignment.to_owned()),
            student: student.to_owned(),
            id: Some("7".to_owned()),
            late: None,
        }
    }

    #[test]
    fn decisions_are_found_by_path_name_and_number() {
        let decisions = parse(
            "[[decision]]\nstudent = \"Anna\"\nassignment = \"torus\"\npoints = 1\nreason = \"a\"\n\
             [[decision]]\nstudent = \"7\"\nassignment = \"ball\"\npoints = 2\nreason = \"b\"\n\
             [[decision]]\nshader = \"./hw/a.glsl\"\nverdict = \"correct\"\npoints = 3\nreason = \" c \"\n",
        )
        .unwrap();
        let points = |shader: &str, submitted: Option<&StudentSubmission>| {
            decisions.find(shader, submitted).and_then(|one| one.points)
        };
        assert_eq!(points("x.glsl", Some(&submitted("Anna", "torus"))), Some(1.0));
        assert_eq!(points("x.glsl", Some(&submitted("Anna", "ball"))), Some(2.0));
        assert_eq!(points("x.glsl", Some(&submitted("Anna", "cube"))), None);
        assert_eq!(points("hw/a.glsl", Some(&submitted("Anna", "torus"))), Some(3.0));
        assert_eq!(points("x.glsl", None), None);
        let found = decisions.find("hw/a.glsl", None).unwrap();
        assert_eq!(
            (found.verdict, found.reason.as_str()),
            (Some(Verdict::Correct), "c")
        );
    }

    #[test]
    fn a_decision_without_a_shader_is_reported_with_its_line() {
        let decisions = parse(
            "[[decision]]\nshader = \"hw/mia.glsl\"\npoints = 1\nreason = \"a\"\n\
             [[decision]]\nstudent = \"Zoe\"\npoints = 1\nreason = \"a\"\n",
        )
        .unwrap();
        let anna = submitted("Anna", "torus");
        let warnings = decisions.warnings(&[("hw/mai.glsl".to_owned(), Some(&anna))]);
        assert_eq!(
            warnings,
            [
                (
                    "decisions.toml:1: no shader matches the decision on `hw/mia.glsl`".to_owned(),
                    Some("did you mean `hw/mai.glsl`?".to_owned())
                ),
                (
                    "decisions.toml:5: no shader matches the decision on `Zoe`".to_owned(),
                    None
                ),
            ]
        );
    }

    #[test]
    fn a_name_of_several_students_is_a_warning() {
        let text = "[[decision]]\nstudent = \"Anna\"\npoints = 1\nreason = \"a\n b\"\n";
        let decisions = parse(&text.replace("\"a\n b\"", "\"\"\"a\n b\"\"\"")).unwrap();
        let (one, mut other) = (submitted("Anna", "torus"), submitted("Anna", "torus"));
        other.id = Some("8".to_owned());
        let both = [
            ("a.glsl".to_owned(), Some(&one)),
            ("b.glsl".to_owned(), Some(&other)),
        ];
        let [(warning, _)] = &decisions.warnings(&both)[..] else {
            panic!("one warning");
        };
        assert_eq!(
            warning,
            "decisions.toml:1: the decision is on 2 students named `Anna`"
        );
        assert!(decisions.warnings(&both[..1]).is_empty());
        assert_eq!(decisions.find("a.glsl", Some(&one)).unwrap().reason, "a b");
    }

    #[test]
    fn each_error_has_its_place_and_advice() {
        for (text, expected) in [
            (
                "[[decision]]\nshader = \"a\"\npoints = 1",
                "decisions.toml:1:1: error[E0505]: missing key `reason`",
            ),
            (
                "[[decision]]\nreason = \"a\"\npoints = 1",
                "decisions.toml:1:1: error[E0506]: the decision has no shader",
            ),
            (
                "[[decision]]\nshader = \"a\"\nreason = \"a\"",
                "decisions.toml:1:1: error[E0506]: the decision changes nothing",
            ),
            (
                "[[decision]]\nshader = \"a\"\nreason = \"\"\npoints = 1",
                "decisions.toml:3:10: error[E0506]: `reason` is empty",
            ),
            (
                "[[decision]]\nshader = \"a\"\nreason = \"a\"\npoints = -1",
                "decisions.toml:4:10: error[E0506]: `points` must be from 0 to 1,000,000, found -1",
            ),
            (
                "[[decision]]\nshader = \"a\"\nstudent = \"b\"\nreason = \"a\"\npoints = 1",
                "decisions.toml:3:11: error[E0506]: `shader` cannot be used",
            ),
            (
                "[[decision]]\nshader = \"a\"\nreason = \"a\"\nverdict = \"corect\"",
                "decisions.toml:4:11: error[E0505]: unknown verdict `corect`",
            ),
            (
                "[[decision]]\nshader = \"a\"\nreason = \"a\"\npoints = 1\n\
                 [[decision]]\nshader = \"a\"\nreason = \"b\"\npoints = 2",
                "decisions.toml:5:1: error[E0506]: there are two decisions on `a`",
            ),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
