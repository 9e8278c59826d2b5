//! The known mistakes that explain a wrong image.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::Files;
use toyproof_explain::known::{Diagnosis, KnownMistake};

/// The mistake that explains a wrong image.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Mistake {
    /// The name, such as `far-root`; for two combined mistakes both names: `no-aspect+no-gamma`.
    pub id: String,
    /// The mistake in the shader, in one sentence.
    pub text: String,
    /// Whether this is a symptom: a description of the image, which many mistakes may cause.
    pub is_symptom: bool,
    /// Other mistakes that render the same image, the most likely first.
    pub alternatives: Vec<Alternative>,
}

/// Another mistake that renders the same image.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Alternative {
    /// The name.
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
    pub(super) fn is_ambiguous(&self) -> bool {
        self.is_symptom || !self.alternatives.is_empty()
    }

    /// The word for the mistake in a report.
    pub(crate) fn label(&self) -> &'static str {
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
