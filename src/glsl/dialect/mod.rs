//! Dialects: how a host wraps the language. A host calls another function than ShaderToy, and sets inputs of
//! other names, which are expressions of ShaderToy's. So the tree of a shader does not depend on its dialect,
//! and neither does anything behind the front end.

mod host;
mod language;

pub use self::host::Dialect;
pub(crate) use self::host::{Bound, InputValue};
pub use self::language::Version;
pub(crate) use self::language::{Language, OLD_TEXTURE_FUNCTIONS};

/// The host of a text, and its language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wrapping {
    pub(crate) dialect: Dialect,
    pub(crate) language: Language,
}

impl Wrapping {
    /// `declared` is the version in the text.
    pub(crate) fn new(dialect: Dialect, declared: Option<Version>, is_lenient: bool) -> Self {
        let declared = declared.filter(|_| !dialect.calls_main_image());
        let version = declared.unwrap_or(dialect.version());
        Self {
            dialect,
            language: Language { version, is_lenient },
        }
    }
}
