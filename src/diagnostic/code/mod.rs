//! The codes of all diagnostics of the program. The explanation of each stands above it: a file for each
//! topic has a macro that adds its codes to the table.

#[macro_use]
mod files;
#[macro_use]
mod floats;
#[macro_use]
mod grammar;
#[macro_use]
mod lints;
#[macro_use]
mod preprocessor;
#[macro_use]
mod projects;
#[macro_use]
mod rules;
#[macro_use]
mod runs;
#[macro_use]
mod types;

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{Diagnostic, Place, Severity};

macro_rules! codes {
    ([$topic:ident $($others:ident)*] $($codes:tt)*) => {
        $topic! { [$($others)*] $($codes)* }
    };
    ([] $($(#[doc = $line:literal])* $variant:ident $code:literal $title:literal,)*) => {
        /// The kind of a diagnostic. The codes are stable: never renumber one.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Code {
            $(#[doc = concat!($code, ": ", $title)] #[serde(rename = $code)] $variant,)*
        }

        impl Code {
            /// All codes, in numerical order.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// `E` (errors) or `W` (warnings and notes) and four digits.
            pub fn as_str(self) -> &'static str {
                match self {
                    $(Self::$variant => $code,)*
                }
            }

            /// A one-line description.
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$variant => $title,)*
                }
            }

            /// What it means and how to fix it, in Markdown. Examples are in fences, each after a line
            /// `Wrong:` or `Right:`.
            pub fn explanation(self) -> String {
                let text = match self {
                    $(Self::$variant => concat!($($line, "\n"),*),)*
                };
                let lines = text.lines().map(|line| line.strip_prefix(' ').unwrap_or(line));
                lines.collect::<Vec<_>>().join("\n")
            }
        }
    };
}

codes! { [preprocessor grammar types rules files lints floats projects runs] }

impl Code {
    /// Returns the code with this string form, in any case.
    pub fn parse(text: &str) -> Option<Self> {
        let mut codes = Self::ALL.iter().copied();
        codes.find(|code| code.as_str().eq_ignore_ascii_case(text))
    }

    /// The severity of its diagnostics, unless the user denies the warning.
    pub fn severity(self) -> Severity {
        match self {
            Self::LintTimeout | Self::SlowCompilation | Self::StandIn => Severity::Note,
            _ if self.as_str().starts_with('W') => Severity::Warning,
            _ => Severity::Error,
        }
    }

    /// Whether `// toyproof: allow(…)` may suppress it.
    pub fn can_be_allowed(self) -> bool {
        self.as_str().starts_with('W') && !matches!(self, Self::BadAllow | Self::UnusedAllow)
    }

    /// Whether it reports the execution of a shader rather than its text.
    pub fn is_of_runs(self) -> bool {
        self.as_str().starts_with("W06") || self == Self::MaybeUnwritten
    }

    /// Makes a diagnostic of this kind at the place of use and, for text from a macro, at the spelling
    /// location.
    pub fn at(self, place: Place, message: impl Into<String>) -> Diagnostic {
        let diagnostic = Diagnostic::new(self, message).at(place.span);
        if place.is_expanded() {
            diagnostic.related(place.spelling, IN_MACRO)
        } else {
            diagnostic
        }
    }

    /// Returns such a diagnostic as an `Err`.
    ///
    /// # Errors
    /// Always.
    pub fn refuse<T>(self, place: Place, message: impl Into<String>) -> Result<T, Box<Diagnostic>> {
        Err(Box::new(self.at(place, message)))
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// The text at the spelling location of characters from a macro.
pub const IN_MACRO: &str = "in the definition of this macro";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_sorted_and_unique() {
        let codes: Vec<_> = Code::ALL.iter().map(|code| code.as_str()).collect();
        assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    }

    #[test]
    fn codes_are_read_as_they_are_written() {
        for &code in Code::ALL {
            assert_eq!(Code::parse(&code.as_str().to_lowercase()), Some(code));
        }
        assert_eq!(Code::parse("W06"), None);
    }
}
