//! The codes of all diagnostics of the program.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{Diagnostic, Place, Severity};

macro_rules! codes {
    ($($variant:ident $code:literal $title:literal,)*) => {
        /// The kind of a diagnostic. The codes are stable: never renumber one.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Code {
            $(#[doc = concat!($code, ": ", $title)] #[serde(rename = $code)] $variant,)*
        }

        impl Code {
            /// All codes, in numerical order.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// `E` (errors) or `W` (warnings and notes) and four digits.
            #[must_use]
            pub fn as_str(self) -> &'static str {
                match self {
                    $(Self::$variant => $code,)*
                }
            }

            /// A one-line description.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$variant => $title,)*
                }
            }
        }
    };
}

codes! {
    // The preprocessor, §3.
    UnknownCharacter "E0001" "An invalid character",
    UnterminatedComment "E0002" "An unterminated comment",
    UnknownDirective "E0003" "An unknown preprocessor directive",
    MalformedDirective "E0004" "A malformed directive",
    BadCondition "E0005" "An invalid condition of `#if` or `#elif`",
    UnbalancedCondition "E0006" "Unbalanced conditional directives",
    BadMacro "E0007" "An invalid definition of a macro",
    BadMacroCall "E0008" "An invalid use of a macro",
    PasteOperator "E0009" "`#` or `##` in a macro, which GLSL ES does not have",
    ErrorDirective "E0010" "An `#error` directive",
    BadVersion "E0011" "An unsupported `#version`",
    BadExtension "E0012" "An unsupported extension that is required",
    TooMuchExpansion "E0013" "A macro expansion that is too large",
    // The grammar, §3 and §9.
    Syntax "E0100" "A syntax error",
    TooDeep "E0101" "Nesting that is too deep",
    BadNumber "E0102" "A malformed number",
    NumberRange "E0103" "An integer out of range",
    ReservedWord "E0104" "A reserved word",
    Unclosed "E0105" "An unbalanced bracket",
    // Names, §4.2.
    Undeclared "E0200" "An undeclared name",
    Redeclared "E0201" "A redeclared name",
    NotAVariable "E0202" "A type or function used as a variable, or the reverse",
    UnknownMember "E0203" "An unknown member or an invalid swizzle",
    // Types, §4 and §5.
    BadOperands "E0300" "Invalid operands of an operator",
    Mismatch "E0301" "Mismatched types",
    NoOverload "E0302" "No matching function for a call",
    BadConstructor "E0303" "Invalid arguments of a constructor",
    BadIndex "E0304" "An invalid index",
    BadArraySize "E0305" "An invalid array size",
    ArrayOfArrays "E0306" "An array of arrays, which GLSL ES 3.00 does not support",
    BadType "E0307" "A type that is not allowed here",
    BadReturn "E0308" "An invalid or missing `return`",
    // Rules, §4.3, §5.8 and §6.
    NotWritable "E0400" "An assignment to a read-only value",
    NotConstant "E0401" "A value that must be a constant expression",
    Uninitialized "E0402" "A `const` without a value",
    BadQualifier "E0403" "An invalid qualifier",
    Recursion "E0404" "A recursive function",
    Undefined "E0405" "A function that is called but not defined",
    BadOverload "E0406" "Overloads that differ only in return type or qualifiers",
    BadSwitch "E0407" "An invalid `switch` or label",
    MisplacedJump "E0408" "A `break` or `continue` outside a loop",
    NoMainImage "E0409" "A missing or invalid `mainImage`",
    TooSlow "E0410" "A shader that takes too long to compile",
    TooDeepToRun "E0411" "Control flow nested too deeply for drivers",
    InputOfOtherTab "E0412" "An input that the tab of a project does not have",
    // Files other than shaders.
    UnreadableFile "E0500" "A file that is not text, or too large",
    SceneSyntax "E0501" "A scene file with a syntax error or an unknown key",
    SceneValue "E0502" "A scene with an invalid value",
    RubricSyntax "E0503" "A rubric file with a syntax error or an unknown key",
    RubricValue "E0504" "A rubric with an invalid value",
    AssignmentSyntax "E0505" "An assignment file with a syntax error or an unknown key",
    AssignmentValue "E0506" "An assignment with an invalid value",
    ProjectSyntax "E0507" "A project file with a syntax error",
    ProjectValue "E0508" "A project with an invalid value",
    ScriptSyntax "E0509" "An invalid script of the mouse and the keyboard",
    ScriptValue "E0510" "A script of the mouse and the keyboard with an invalid value",
    // Translation.
    NagaParse "E0900" "An internal error: naga cannot parse the translated shader",
    NagaValidation "E0901" "An internal error: naga cannot validate the translated shader",
    UnsupportedByTarget "E0902" "A feature that the target of the conversion does not provide",
    // Warnings.
    ReservedName "W0001" "A reserved name",
    UnknownExtension "W0002" "An unsupported extension that is enabled",
    // Findings of lints in a shader without errors.
    Unwritten "W0003" "A variable that is used uninitialized",
    MaybeUnwritten "W0004" "A variable that may be used uninitialized",
    SineHash "W0005" "A hash of `sin`, which differs between GPUs",
    Derivative "W0006" "A derivative in non-uniform control flow",
    ImplicitLod "W0007" "An implicit level of detail in non-uniform control flow",
    LongLoop "W0008" "Loops that may exceed the iteration limit of older drivers",
    EndlessLoop "W0009" "An infinite loop",
    UnusedResult "W0010" "An unused result",
    FloatEquality "W0011" "`==` or `!=` of computed floats",
    UnnormalizedDirection "W0012" "A ray–sphere formula for unit directions with a direction that is not normalized",
    BadAllow "W0014" "A malformed `allow` comment",
    UnusedAllow "W0015" "An unused `allow` comment",
    MissingReturn "W0016" "A function that may reach its end without a `return`",
    LintTimeout "W0017" "Lints that exceeded their time limit",
    // Findings about the inputs of a project.
    MissingPass "W0018" "An input that reads a pass that does not exist",
    SamplerConflict "W0019" "Different samplers of one buffer",
    BufferOrder "W0020" "Buffers that do not run in the order of their names",
    // Further findings of lints.
    ReversedEdges "W0021" "A `smoothstep` whose first edge is not less than the second",
    Uncalled "W0022" "A function that is never called",
    IntegerDivision "W0023" "A division of integers whose fraction is lost",
    UnsetUniform "W0030" "A uniform that nothing sets",
    // Findings while a shader runs.
    UndefinedOperation "W0600" "An operation with an undefined result",
    LongRun "W0601" "Loops that exceed the iteration limit of older drivers",
    LostDigits "W0602" "A loss of precision in float32",
    NotFinite "W0603" "A color that is NaN or infinite",
    NeverWritten "W0604" "A read of an uninitialized variable",
    UnboundChannel "W0605" "A channel without an image",
    SlowCompilation "W0606" "A shader that takes the driver too long to compile",
    // Findings over the frames of a project.
    NanInBuffer "W0607" "NaN in a buffer",
    NeverInitialized "W0608" "A buffer that stays zero",
    VisibleGrowth "W0609" "Rounding errors that become visible over frames",
    // Findings about the toolchain and the checks.
    DriverFailure "W0610" "A shader of which the driver renders no image",
    ToolchainDifference "W0611" "An image of the driver that differs from the evaluator's",
    OnlySingle "W0612" "A shader that cannot be evaluated in double precision",
}

impl Code {
    /// Returns the code with this string form, in any case.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let mut codes = Self::ALL.iter().copied();
        codes.find(|code| code.as_str().eq_ignore_ascii_case(text))
    }

    /// The severity of its diagnostics, unless the user denies the warning.
    #[must_use]
    pub fn severity(self) -> Severity {
        match self {
            Self::LintTimeout | Self::SlowCompilation => Severity::Note,
            _ if self.as_str().starts_with('W') => Severity::Warning,
            _ => Severity::Error,
        }
    }

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
