//! The analysis of a text for an editor: what [`check`](crate::check) finds, also for a text with errors, and
//! what each name of the text means.

use toyproof_diagnostic::{Diagnostic, FileId, Files, Severity};

use crate::dialect::{Dialect, Version};
use crate::preprocess::{ControlComment, Expansions};
use crate::tree::{BuiltIn, FunctionId, Place, SamplerShape, StructId, Tree, VariableId};
use crate::{Checked, Options, Stage};

/// The entity that a name denotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Resolution {
    /// A variable, constant or parameter, or what the host declares.
    Variable(VariableId),
    /// A structure.
    Struct(StructId),
    /// The member with that index.
    Member(StructId, usize),
    /// A function of the author: one overload of its name.
    Function(FunctionId),
    /// A built-in function.
    BuiltIn(BuiltIn),
}

/// A name in the text that was resolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResolvedName {
    /// The place of the name.
    pub at: Place,
    /// What it denotes.
    pub resolution: Resolution,
    /// Whether the name is declared here, also by a prototype.
    pub declares: bool,
}

/// A declaration, and where its name is visible unless another declaration hides it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Visibility {
    /// What is declared. Of overloaded functions, each has its own.
    pub resolution: Resolution,
    /// The first byte at which the name is visible: after the declarator.
    pub start: u32,
    /// One past the last byte: the end of the scope.
    pub end: u32,
    /// The number of scopes around the one that declares it: 0 at global scope. Of two visible declarations
    /// of a name, the deeper one hides the other.
    pub depth: usize,
}

/// A text with or without errors, as far as its tree could be built.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// The errors and warnings in source order, as [`check`](crate::check) reports them. The warnings of a
    /// valid shader include those that the author allows: lints filter them.
    pub diagnostics: Vec<Diagnostic>,
    /// The host of the shader.
    pub dialect: Dialect,
    /// The version of GLSL in which it is written.
    pub version: Version,
    /// The tab that the text is.
    pub stage: Stage,
    /// The shapes of `iChannel0` to `iChannel3`, as given in the options or inferred from use.
    pub channels: [SamplerShape; 4],
    /// The resolved names in source order. A name in the body of a macro occurs once for each use.
    pub names: Vec<ResolvedName>,
    /// The declarations, in the order of their scopes' ends.
    pub visibilities: Vec<Visibility>,
    pub(crate) content: Content,
}

/// What remains of a text.
#[derive(Debug, Clone)]
pub(crate) enum Content {
    /// A shader without errors.
    Checked(Box<Checked>),
    /// A text with errors or without an entry point.
    Partial(Box<Partial>),
}

/// A text with errors or without an entry point.
#[derive(Debug, Clone)]
pub(crate) struct Partial {
    pub(crate) tree: Tree,
    pub(crate) control_comments: Vec<ControlComment>,
    pub(crate) expansions: Expansions,
}

impl Analysis {
    /// The shader, if it has no errors; `None` also for Common.
    pub fn checked(&self) -> Option<&Checked> {
        match &self.content {
            Content::Checked(checked) => Some(checked),
            Content::Partial(_) => None,
        }
    }

    /// Whether there is no error.
    pub fn is_valid(&self) -> bool {
        let mut diagnostics = self.diagnostics.iter();
        !diagnostics.any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// The tree. Of a text with errors, it has the functions and expressions that could be parsed. Its arenas
    /// also have nodes that no other node refers to, such as the `p` of an unfinished `p.`.
    pub fn tree(&self) -> &Tree {
        match &self.content {
            Content::Checked(checked) => &checked.tree,
            Content::Partial(partial) => &partial.tree,
        }
    }

    /// The macros and their uses.
    pub fn expansions(&self) -> &Expansions {
        match &self.content {
            Content::Checked(checked) => &checked.expansions,
            Content::Partial(partial) => &partial.expansions,
        }
    }

    /// The `// toyproof:` comments.
    pub fn control_comments(&self) -> &[ControlComment] {
        match &self.content {
            Content::Checked(checked) => &checked.control_comments,
            Content::Partial(partial) => &partial.control_comments,
        }
    }
}

/// Analyzes a text, which may have errors.
///
/// ```
/// use toyproof_diagnostic::{File, Files};
/// use toyproof_glsl::{Options, Resolution, analyze};
///
/// let mut files = Files::default();
/// let file = files.add(File::new("a.glsl", "void mainImage(out vec4 c, in vec2 p) { c = p. }"));
/// let analysis = analyze(&files, file, &Options::default());
/// assert!(!analysis.is_valid());
/// let at_dot = analysis.names.iter().rfind(|name| name.at.span.end == 45).unwrap();
/// let Resolution::Variable(p) = at_dot.resolution else { panic!() };
/// assert_eq!(analysis.tree().type_name(analysis.tree()[p].ty), "vec2");
/// ```
pub fn analyze(files: &Files, file: FileId, options: &Options) -> Analysis {
    crate::read(files, file, options, true).into_analysis(options)
}

/// Records what names denote, and where they are visible.
#[derive(Debug, Default)]
pub(crate) struct NameIndex {
    names: Vec<ResolvedName>,
    visibilities: Vec<Visibility>,
    /// The declarations of the open scopes, innermost last, and where they begin to be visible; those of the
    /// global scope are first.
    open: Vec<Vec<(Resolution, u32)>>,
}

impl NameIndex {
    pub(crate) fn resolve(&mut self, at: Place, resolution: Resolution, declares: bool) {
        self.names.push(ResolvedName {
            at,
            resolution,
            declares,
        });
    }

    pub(crate) fn open_scope(&mut self) {
        self.open.push(Vec::new());
    }

    pub(crate) fn declare(&mut self, resolution: Resolution, start: u32) {
        if let Some(scope) = self.open.last_mut() {
            scope.push((resolution, start));
        }
    }

    pub(crate) fn close_scope(&mut self, end: u32) {
        let depth = self.open.len().saturating_sub(1);
        let closed = self.open.pop().unwrap_or_default();
        let closed = closed.into_iter().map(|(resolution, start)| Visibility {
            resolution,
            start,
            end: end.max(start),
            depth,
        });
        self.visibilities.extend(closed);
    }

    /// Closes all scopes at the end of the text, and returns the names in source order.
    pub(crate) fn finish(mut self, end: u32) -> (Vec<ResolvedName>, Vec<Visibility>) {
        while !self.open.is_empty() {
            self.close_scope(end);
        }
        let key = |name: &ResolvedName| (name.at.span.start, name.at.spelling.start, name.resolution);
        self.names.sort_by_key(key);
        // The parser may read a type twice.
        self.names.dedup();
        (self.names, self.visibilities)
    }
}
