//! Grading platforms: the files that each runs for a submission, and the results that it reads.
//!
//! A platform is one file, with its row of [`PLATFORMS`]. They share the rest: `grade.sh` collects a
//! submission and checks it with `--autograder`, and a `Graded` has the marks of its shaders.

mod autolab;
mod classroom50;
mod coderunner;
mod graded;
mod gradescope;
mod prairielearn;

use std::io::{self, Write};

use self::graded::Graded;
use super::{Hints, Record, Rubric, Thumbnails};

/// A grading platform.
#[derive(Debug)]
pub struct Platform {
    /// Its name on the command line.
    pub name: &'static str,
    /// What a teacher does with the autograder, after “to use it: ”.
    pub advice: &'static str,
    /// Where the kit is.
    pub kit: Kit,
    /// The path of toyproof, if it is not part of the kit.
    pub program: Option<&'static str>,
    /// The files of its own.
    files: fn(&Task) -> Vec<PlatformFile>,
    /// The results of a submission that could not be checked; empty if the platform has its own.
    failure: &'static str,
    /// Writes the results of a submission.
    results: fn(&Graded, &mut dyn Write) -> io::Result<()>,
}

/// All platforms.
pub static PLATFORMS: [&Platform; 5] = [
    &gradescope::PLATFORM,
    &classroom50::PLATFORM,
    &prairielearn::PLATFORM,
    &autolab::PLATFORM,
    &coderunner::PLATFORM,
];

/// Where the kit of an autograder is: toyproof, the assignment, and `grade.sh`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kit {
    /// In a folder, whose name is empty or ends with `/`.
    Folder(&'static str),
    /// In a folder `toyproof` of this tar archive.
    Tar(&'static str),
    /// In this zip archive.
    Zip(&'static str),
}

/// What the files of a platform depend on.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// The name of the assignment: that of its folder.
    pub name: &'a str,
    /// The bytes of toyproof.
    pub program: &'a [u8],
}

/// A file that a platform needs.
#[derive(Debug)]
pub struct PlatformFile {
    /// Its path in the autograder.
    pub path: &'static str,
    /// Its content.
    pub text: String,
    /// Whether it is a program.
    pub is_executable: bool,
}

impl PlatformFile {
    /// A file that is read.
    fn plain(path: &'static str, text: impl Into<String>) -> Self {
        Self {
            path,
            text: text.into(),
            is_executable: false,
        }
    }

    /// A program.
    fn executable(path: &'static str, text: impl Into<String>) -> Self {
        Self {
            is_executable: true,
            ..Self::plain(path, text)
        }
    }
}

/// What students read if the check itself fails.
const FAILED: &str = "The autograder failed, so your submission was not graded. Please inform your teacher.";

impl Platform {
    /// The platform of this name.
    #[must_use]
    pub fn find(name: &str) -> Option<&'static Self> {
        PLATFORMS.into_iter().find(|platform| platform.name == name)
    }

    /// The files outside of the kit.
    #[must_use]
    pub fn files(&self, task: &Task) -> Vec<PlatformFile> {
        (self.files)(task)
    }

    /// The files of the kit beside toyproof and the assignment.
    #[must_use]
    pub fn kit_files(&self) -> Vec<PlatformFile> {
        let failure = (!self.failure.is_empty()).then(|| PlatformFile::plain("failure", self.failure));
        let script = PlatformFile::executable("grade.sh", include_str!("grade.sh"));
        [script].into_iter().chain(failure).collect()
    }

    /// Writes the results of a student's shaders, as far as the hints permit. Of several shaders, the one
    /// with the fewest points counts.
    ///
    /// # Errors
    /// The results cannot be written.
    pub fn write_results(
        &self,
        records: &[Record],
        rubric: &Rubric,
        hints: Hints,
        thumbnails: &Thumbnails,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        (self.results)(&Graded::new(records, rubric, hints, thumbnails), out)
    }
}

/// Bytes as hexadecimal digits.
fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    bytes.iter().fold(String::new(), |mut digits, byte| {
        let _ = write!(digits, "{byte:02x}");
        digits
    })
}

/// Writes JSON on several lines.
fn write_json(value: &impl serde::Serialize, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    out.write_all(b"\n")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;
    use toyproof_verify::Verdict;

    use super::*;
    use crate::record::samples::{correct, every_verdict, invalid, record};
    use crate::repair::samples::{repaired, suspected};
    use crate::written;

    type Schema = fn() -> Value;

    /// The documented formats of the results.
    const SCHEMAS: [(&str, Schema); 5] = [
        ("gradescope", gradescope::tests::schema),
        ("classroom50", classroom50::tests::schema),
        ("prairielearn", prairielearn::tests::schema),
        ("autolab", autolab::tests::schema),
        ("coderunner", coderunner::tests::schema),
    ];

    /// The results of records.
    pub(super) fn results(name: &str, records: &[Record], hints: Hints, images: &Thumbnails) -> String {
        let (platform, rubric) = (Platform::find(name).unwrap(), Rubric::with_points(2.0, 6.0, 2.0));
        written(|out| platform.write_results(records, &rubric, hints, images, out))
    }

    /// The JSON of the results of records, with all hints.
    pub(super) fn json(name: &str, records: &[Record]) -> Value {
        json_of(name, &results(name, records, Hints::Fix, &images()))
    }

    /// The JSON of results; that of Autolab is an array of its last lines.
    fn json_of(name: &str, text: &str) -> Value {
        if name != "autolab" {
            return serde_json::from_str(text).unwrap();
        }
        let lines: Vec<&str> = text.lines().collect();
        let last = lines[lines.len() - 2..].iter();
        last.map(|line| serde_json::from_str::<Value>(line).unwrap())
            .collect()
    }

    fn images() -> Thumbnails {
        let mut images = Thumbnails::default();
        images.add("a<b>.glsl".to_owned(), vec![("your image", b"png".to_vec())]);
        images
    }

    /// Removes each key that a schema requires from a value; returns the keys whose absence is accepted.
    fn not_required(schema: &Value, value: &Value) -> BTreeSet<String> {
        let validator = jsonschema::validator_for(schema).unwrap();
        let mut accepted = BTreeSet::new();
        let mut pending = vec![(schema.clone(), String::new())];
        while let Some((part, pointer)) = pending.pop() {
            for key in part["required"].as_array().into_iter().flatten() {
                let key = key.as_str().unwrap();
                let mut without = value.clone();
                let object = without.pointer_mut(&pointer).and_then(Value::as_object_mut);
                if let Some(object) = object {
                    assert!(
                        object.remove(key).is_some(),
                        "{pointer}/{key} is required and missing"
                    );
                    if validator.is_valid(&without) {
                        accepted.insert(format!("{pointer}/{key}"));
                    }
                }
            }
            for (key, part) in part["properties"].as_object().into_iter().flatten() {
                pending.push((part.clone(), format!("{pointer}/{key}")));
            }
            pending.push((part["items"].clone(), format!("{pointer}/0")));
            for (at, part) in part["prefixItems"].as_array().into_iter().flatten().enumerate() {
                pending.push((part.clone(), format!("{pointer}/{at}")));
            }
            pending.retain(|(part, _)| part.is_object());
        }
        accepted
    }

    #[test]
    fn results_follow_the_documented_schemas() {
        let mut hostile = invalid();
        hostile.diagnostics[0].message = "<script>\u{1b}[31m\u{202e}\n{\"scores\": {}}".to_owned();
        hostile.shader = "\"<img>|\n.glsl".to_owned();
        let all = vec![
            vec![correct()],
            vec![invalid()],
            vec![record(Verdict::Missing)],
            vec![hostile],
            vec![correct(), invalid()],
            every_verdict(),
        ];
        for (name, schema) in SCHEMAS {
            let schema = schema();
            let validator = jsonschema::validator_for(&schema).unwrap();
            for records in &all {
                let json = json(name, records);
                let errors: Vec<_> = validator
                    .iter_errors(&json)
                    .map(|error| error.to_string())
                    .collect();
                assert!(errors.is_empty(), "{name}: {errors:?}\n{json:#}");
            }
            let json = json(name, &[correct()]);
            assert_eq!(not_required(&schema, &json), BTreeSet::new(), "{name}");
        }
        assert_eq!(
            SCHEMAS.map(|(name, _)| name),
            PLATFORMS.map(|platform| platform.name)
        );
    }

    #[test]
    fn no_platform_shows_more_than_the_hints_permit() {
        for (name, _) in SCHEMAS {
            let shown = |record, hints| results(name, &[record], hints, &Thumbnails::default());
            assert!(
                shown(repaired(), Hints::Fix).contains("replace `b + c` with `b - c`"),
                "{name}"
            );
            let lines = shown(repaired(), Hints::Line);
            assert!(lines.contains("fix: an edit of line 2; then all"), "{lines}");
            assert!(!lines.contains("b - c") && !lines.contains("`2.0`"), "{lines}");
            for record in [repaired, suspected] {
                let text = shown(record(), Hints::None);
                for part in ["operator", "line 2", "4, 2", "b + c", "explain"] {
                    assert!(!text.contains(part), "{name}: {part}: {text}");
                }
            }
        }
    }

    #[test]
    fn a_failure_is_stated_in_the_same_format() {
        for platform in PLATFORMS {
            let failure = platform
                .kit_files()
                .into_iter()
                .find(|file| file.path == "failure");
            let failure = failure.map(|file| file.text).unwrap_or_default();
            assert_eq!(
                failure.contains(FAILED),
                platform.name != "classroom50",
                "{failure}"
            );
            let Some((_, schema)) = SCHEMAS.iter().find(|(name, _)| *name == platform.name) else {
                panic!("{} has no schema", platform.name);
            };
            // What is not JSON, the platforms report as an error of the autograder.
            if let Ok(json) = serde_json::from_str(&failure) {
                assert!(
                    jsonschema::validator_for(&schema()).unwrap().is_valid(&json),
                    "{failure}"
                );
            }
        }
    }
}
