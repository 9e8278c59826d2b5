//! The stable codes of the front end's diagnostics.

use toyproof_diagnostic::{Diagnostic, Overdue, plural};

use super::tree::Place;

macro_rules! codes {
    ($($variant:ident $code:literal $doc:literal,)*) => {
        /// The kind of error or warning. The codes are stable: never renumber one.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code {
            $(#[doc = concat!($code, ": ", $doc)] $variant,)*
        }

        impl Code {
            /// All codes, in numerical order.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// `E` or `W` and four digits.
            #[must_use]
            pub fn as_str(self) -> &'static str {
                match self {
                    $(Self::$variant => $code,)*
                }
            }

            /// A one-line description.
            #[must_use]
            pub fn about(self) -> &'static str {
                match self {
                    $(Self::$variant => $doc,)*
                }
            }
        }
    };
}

codes! {
    // The preprocessor, §3.
    UnknownCharacter "E0001" "A character that GLSL does not know",
    UnterminatedComment "E0002" "A `/*` without `*/`",
    UnknownDirective "E0003" "A `#` line that is no directive",
    MalformedDirective "E0004" "A directive with too little or too much on its line",
    BadCondition "E0005" "An `#if` or `#elif` that is no integer constant expression",
    UnbalancedCondition "E0006" "An `#if` without `#endif`, or an `#else`, `#elif` or `#endif` too many",
    BadMacro "E0007" "A macro that may not be defined, redefined or undefined so",
    BadMacroCall "E0008" "A macro used with the wrong number of arguments, or without its `)`",
    PasteOperator "E0009" "`#` or `##` in a macro: GLSL ES has neither",
    ErrorDirective "E0010" "An `#error` that was reached",
    BadVersion "E0011" "A `#version` that is not `300 es`, or does not come first",
    BadExtension "E0012" "An `#extension` that is required and does not exist",
    TooMuchExpansion "E0013" "Macros that expand to more than can be meant",
    // The grammar, §3 and §9.
    Syntax "E0100" "Text that does not fit the grammar",
    TooDeep "E0101" "Statements or expressions nested too deep",
    BadNumber "E0102" "A number that is none",
    NumberRange "E0103" "A number that its type cannot hold",
    ReservedWord "E0104" "A word that GLSL ES reserves",
    Unclosed "E0105" "A bracket that is never closed",
    // Names, §4.2.
    Undeclared "E0200" "A name that is not declared",
    Redeclared "E0201" "A name that its scope has already",
    NotAVariable "E0202" "A type or function where a variable is needed, or the other way round",
    UnknownMember "E0203" "A member that its structure does not have, or a selection that is no swizzle",
    // Types, §4 and §5.
    BadOperands "E0300" "An operator on types that it does not take",
    Mismatch "E0301" "A value of one type where another is needed",
    NoOverload "E0302" "A call with arguments that no overload takes",
    BadConstructor "E0303" "A constructor with arguments that it does not take",
    BadIndex "E0304" "An index that is no integer, or out of range, or of something that has no elements",
    BadArraySize "E0305" "An array without a size of at least 1",
    ArrayOfArrays "E0306" "An array of arrays, which GLSL ES 3.00 does not have",
    BadType "E0307" "A type that cannot be used here",
    BadReturn "E0308" "A `return` that does not fit its function",
    // Rules, §4.3, §5.8 and §6.
    NotWritable "E0400" "An assignment to what cannot be written",
    NotConstant "E0401" "A value that must be a constant expression and is none",
    Uninitialized "E0402" "A `const` without a value",
    BadQualifier "E0403" "A qualifier that is not allowed here",
    Recursion "E0404" "A function that calls itself",
    Undefined "E0405" "A function that is called and never defined",
    BadOverload "E0406" "A function that differs from another by its result or qualifiers only",
    BadSwitch "E0407" "A label of a `switch` that is not allowed",
    MisplacedJump "E0408" "A `break` or `continue` outside of a loop",
    NoMainImage "E0409" "No `void mainImage(out vec4, in vec2)`",
    TooSlow "E0410" "A shader that takes too long to compile",
    TooDeepToRun "E0411" "A shader that nests deeper than drivers count",
    // Warnings.
    ReservedName "W0001" "A name that begins with what GLSL keeps for itself",
    UnknownExtension "W0002" "An `#extension` that does not exist",
    // Findings of lints in a shader without errors.
    Unwritten "W0003" "A variable that is read before it is written",
    MaybeUnwritten "W0004" "A variable that is read in pixels that did not write it",
    SineHash "W0005" "Randomness from `fract(sin(x) * 43758.5453)`, which differs from GPU to GPU",
    Derivative "W0006" "A derivative where neighbouring pixels may have gone another way",
    ImplicitLod "W0007" "A texture lookup without a level where neighbouring pixels may have gone another way",
    LongLoop "W0008" "Loops that may run longer than older drivers let them",
    EndlessLoop "W0009" "A loop that never ends",
    UnusedResult "W0010" "A value that is computed and dropped",
    FloatEquality "W0011" "`==` or `!=` of floats that were computed",
    UnnormalizedDirection "W0012" "A ray-sphere formula for unit directions, given one that is never normalised",
    // A lint that also depends on the scene.
    NearTangent "W0013" "A ray-sphere formula that loses the edge of a sphere of the scene",
    BadAllow "W0014" "An `allow` that is not understood",
    UnusedAllow "W0015" "An `allow` that nothing needs",
    MissingReturn "W0016" "A function that on some way ends without a `return`",
    LintTimeout "W0017" "Lints that take too long",
    // Findings while a shader runs.
    UndefinedOperation "W0600" "An operation whose value GLSL leaves open",
    LongRun "W0601" "Loops that older drivers cut short",
    LostDigits "W0602" "Digits that float32 loses",
    NotFinite "W0603" "A colour that is NaN or infinite",
    NeverWritten "W0604" "A read of what was never written",
    UnboundChannel "W0605" "A channel that no picture is bound to",
    SlowCompilation "W0606" "A shader that the driver takes too long to compile",
}

/// The error about a shader that takes too long to compile, in any stage.
#[must_use]
pub fn overdue(overdue: Overdue) -> Diagnostic {
    Diagnostic::error(Code::TooSlow.as_str(), overdue.to_string())
        .help("shorten the longest expressions, arrays and functions, or raise `--timeout` (for `trade`, `--budget`)")
}

/// Maximum number of reported errors of one file, and of warnings.
pub const MAX_REPORTED: usize = 50;

/// Adds a diagnostic unless the limit for its severity is reached.
pub(crate) fn push_limited(reported: &mut Vec<Diagnostic>, diagnostic: Diagnostic) {
    let alike = reported
        .iter()
        .filter(|other| other.severity == diagnostic.severity);
    if alike.count() < MAX_REPORTED {
        reported.push(diagnostic);
    }
}

/// Formats a number of arguments or elements: `1 was given`, `3 were given`.
pub(crate) fn given(count: usize) -> String {
    format!("{count} {} given", plural(count as u64, "was", "were"))
}

/// The text at the spelling location of characters from a macro.
pub const IN_MACRO: &str = "in the definition of this macro";

impl Code {
    /// Whether `// toyproof: allow(…)` may suppress it.
    #[must_use]
    pub fn can_be_allowed(self) -> bool {
        self.as_str().starts_with('W') && !matches!(self, Self::BadAllow | Self::UnusedAllow)
    }

    /// Whether it reports the execution of a shader rather than its text.
    #[must_use]
    pub fn is_of_runs(self) -> bool {
        self.as_str().starts_with("W06") || self == Self::MaybeUnwritten
    }

    /// Makes a diagnostic of this kind at the place of use and, for text from a macro, at the spelling
    /// location.
    pub fn at(self, place: Place, message: impl Into<String>) -> Diagnostic {
        let diagnostic = if self.as_str().starts_with('W') {
            Diagnostic::warning(self.as_str(), message)
        } else {
            Diagnostic::error(self.as_str(), message)
        };
        let diagnostic = diagnostic.at(place.span);
        if place.is_expanded() {
            diagnostic.related(place.spelling, IN_MACRO)
        } else {
            diagnostic
        }
    }

    /// Returns such a diagnostic as an `Err`.
    pub(crate) fn refuse<T>(self, place: Place, message: impl Into<String>) -> Result<T, Box<Diagnostic>> {
        Err(Box::new(self.at(place, message)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_sorted_and_unique() {
        let codes: Vec<_> = Code::ALL.iter().map(|code| code.as_str()).collect();
        assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    }
}
