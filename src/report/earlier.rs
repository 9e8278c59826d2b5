//! An earlier report, and the verdicts that differ from it: after a correction of the reference, or with a
//! new version of the program.

use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;
use toyproof_verify::Verdict;

use super::{Report, Seconds};

/// The verdicts of an earlier report, and how long its shaders took.
#[derive(Debug, Clone)]
pub struct Earlier {
    name: String,
    verdicts: BTreeMap<String, Verdict>,
    seconds: BTreeMap<String, f64>,
}

/// A shader whose verdict differs between two reports; `None` if a report does not have the shader.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// The shader's name.
    pub shader: String,
    /// The verdict in the earlier report.
    pub before: Option<Verdict>,
    /// The verdict in the later report.
    pub after: Option<Verdict>,
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown =
            |verdict: Option<Verdict>| verdict.map_or("–".to_owned(), |verdict| verdict.to_string());
        let [before, after] = [self.before, self.after].map(shown);
        write!(f, "{before:<12} → {after:<12} {}", self.shader)
    }
}

impl Earlier {
    /// Reads the text of a `verdict.json`; the name is for messages.
    ///
    /// # Errors
    /// Why the text is not one.
    pub fn parse(name: String, text: &str) -> Result<Self, String> {
        #[derive(Deserialize)]
        struct Version {
            version: u32,
        }
        #[derive(Deserialize)]
        struct Shaders {
            shaders: Vec<Entry>,
        }
        #[derive(Deserialize)]
        struct Entry {
            shader: String,
            verdict: Verdict,
            #[serde(default)]
            seconds: Seconds,
        }
        let error = |error: serde_json::Error| format!("it is not a verdict.json: {error}");
        let Version { version } = serde_json::from_str(text).map_err(error)?;
        if version != Report::VERSION {
            return Err(format!(
                "it has version {version}, and this program reads version {}",
                Report::VERSION
            ));
        }
        let Shaders { shaders } = serde_json::from_str(text).map_err(error)?;
        let seconds = shaders
            .iter()
            .filter_map(|one| Some((one.shader.clone(), one.seconds.all?)));
        Ok(Self {
            name,
            seconds: seconds.collect(),
            verdicts: shaders.into_iter().map(|one| (one.shader, one.verdict)).collect(),
        })
    }

    /// How long a shader took; `None` if the report does not state it.
    #[must_use]
    pub fn seconds(&self, shader: &str) -> Option<f64> {
        self.seconds.get(shader).copied()
    }

    /// The name of the report.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The shaders whose verdicts differ in a later report: in its order, and then those that it does not
    /// have.
    #[must_use]
    pub fn changes(&self, later: &Report) -> Vec<Change> {
        let mut gone = self.verdicts.clone();
        let mut changes = Vec::new();
        for record in later.shaders() {
            gone.remove(&record.shader);
            let before = self.verdicts.get(&record.shader).copied();
            if before != Some(record.verdict) {
                changes.push(Change {
                    shader: record.shader.clone(),
                    before,
                    after: Some(record.verdict),
                });
            }
        }
        changes.extend(gone.into_iter().map(|(shader, verdict)| Change {
            shader,
            before: Some(verdict),
            after: None,
        }));
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Record, written};

    fn report(shaders: &[(&str, Verdict)]) -> Report {
        let record = |&(name, verdict): &(&str, Verdict)| Record {
            verdict,
            ..Record::unchecked(name.to_owned())
        };
        Report::new(None, shaders.iter().map(record).collect())
    }

    #[test]
    fn changed_new_and_missing_shaders_are_listed() {
        use Verdict::{Correct, Invalid, Wrong};
        let before = report(&[("a", Wrong), ("b", Correct), ("gone", Invalid)]);
        let before = Earlier::parse("old".to_owned(), &written(|out| before.json(out))).unwrap();
        let after = report(&[("new", Wrong), ("b", Correct), ("a", Correct)]);
        let shown: Vec<_> = before.changes(&after).iter().map(Change::to_string).collect();
        assert_eq!(
            shown,
            [
                "–            → wrong        new",
                "wrong        → correct      a",
                "invalid      → –            gone"
            ]
        );
    }

    #[test]
    fn the_time_of_a_shader_is_that_of_all_its_stages() {
        let record = |name: &str, all| Record {
            seconds: Seconds {
                eval: Some(1.0),
                all,
                ..Seconds::default()
            },
            ..Record::unchecked(name.to_owned())
        };
        let report = Report::new(None, vec![record("a", Some(3.5)), record("b", None)]);
        let earlier = Earlier::parse(String::new(), &written(|out| report.json(out))).unwrap();
        assert_eq!(
            ["a", "b", "c"].map(|name| earlier.seconds(name)),
            [Some(3.5), None, None]
        );
    }

    #[test]
    fn other_files_are_rejected() {
        let parse = |text| Earlier::parse(String::new(), text).unwrap_err();
        assert!(parse("[]").starts_with("it is not a verdict.json"));
        assert_eq!(
            parse(r#"{"version": 1, "shaders": []}"#),
            "it has version 1, and this program reads version 2"
        );
    }
}
