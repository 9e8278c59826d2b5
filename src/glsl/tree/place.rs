//! Where a node stands in the author's text, through macros.

use toyproof_diagnostic::Span;

/// Where the author used something, and where its characters stand.
///
/// The two differ for text that comes out of a macro's body: then `span` is the use of the outermost macro
/// (`F(x)` in the running text) and `spelled` lies in the body of a `#define`. The arguments of a macro
/// are the author's running text: for them the two are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// In the running text: what lines and messages are counted by.
    pub span: Span,
    /// Where the characters stand.
    pub spelled: Span,
}

impl Place {
    /// Text outside of any macro.
    #[must_use]
    pub fn plain(span: Span) -> Self {
        Self { span, spelled: span }
    }

    /// From here to there. A stretch that leaves one expansion of a macro is told by its running text.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        let span = self.span.to(other.span);
        let spelled = if self.span == other.span && self.is_expanded() && other.is_expanded() {
            self.spelled.to(other.spelled)
        } else {
            span
        };
        Self { span, spelled }
    }

    /// Whether the characters stand in the body of a macro.
    #[must_use]
    pub fn is_expanded(self) -> bool {
        self.span != self.spelled
    }
}
