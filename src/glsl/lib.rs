//! A front end for GLSL ES 3.00 as ShaderToy runs it: turns source text into a typed tree, or into
//! diagnostics that a student can act on. It does not depend on any consumer of the tree.
//!
//! ```text
//! text ─► preprocess ─► tokens ─► parse ─(calls)─► check ─► tree
//! ```
//!
//! The parser knows only the grammar; for each construct it calls the checker, which knows scopes, types and
//! rules, and gets a typed node. So there is one tree and no separate syntax tree. Section numbers (§) refer
//! to the GLSL ES 3.00.6 specification; where WebGL 2 (ANGLE) is stricter, so is this front end, and a
//! comment says so.
//!
//! # The tree
//!
//! [`Checked`] holds a [`tree::Tree`]: functions, variables and expressions lie in arenas and are named by
//! ids, such as [`tree::ExprId`]. Every expression has a type, one parent, and its place in the source, also
//! if a macro expanded to it. Literals stay as they are written, so that a consumer can read `0.1` as float32
//! or as double precision. Implicit initializations, such as ShaderToy's black color, are not part of the
//! tree.
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_glsl::{Options, check};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let text = "float sq(float x) { return x * x; }\n\
//!                 void mainImage(out vec4 c, in vec2 p) { c = vec4(sq(p.x)); }";
//!     let file = files.add(File::new("square.glsl", text));
//!     let checked = check(&files, file, &Options::default())?;
//!     let names: Vec<_> = checked.tree.functions.iter().map(|(_, function)| &function.name).collect();
//!     assert_eq!(names, ["sq", "mainImage"]);
//!     Ok(())
//! }
//! ```
//!
//! # Diagnostics
//!
//! The parser continues after errors. Each error has a stable [code](toyproof_diagnostic::Code), a span, and
//! often a suggestion; [`toyproof_diagnostic`] renders it for people, editors and programs. The error of
//! [`check`] displays them:
//!
//! ```
//! # use toyproof_diagnostic::{File, Files};
//! # use toyproof_glsl::{Options, check};
//! # let mut files = Files::default();
//! let file = files.add(File::new("a.glsl", "void mainImage(out vec4 c, in vec2 p) { c = vec4(q); }"));
//! let errors = check(&files, file, &Options::default()).unwrap_err();
//! assert!(errors.to_string().starts_with("a.glsl:1:50: error[E0"), "{errors}");
//! ```
//!
//! # Untrusted input
//!
//! No input overflows the stack, and time is linear in the size of the text after macros are expanded, whose
//! size is limited. Nesting is limited by [`MAX_NESTING`], time by [`Options::deadline`].
//!
//! # Parts
//!
//! - `preprocess`: the preprocessor, whose tokens keep the positions of their use and of their source text.
//! - `parse`: matches brackets, then parses the grammar; continues after errors.
//! - `check`: scopes, types, rules and built-in functions; called by the parser for each construct.
//! - `constant`: the values of constant expressions.
//! - `analysis`: a text for an editor, also with errors: what names denote, and where they are visible.
//! - [`tree`]: the typed tree in arenas, and its visitors ([`tree::walk`]).
//! - `single_edit`: one edit after which an invalid shader compiles; `source`: the tokens of a text as it is
//!   written.
//! - `port`: the text of a shader for another host.
//! - [`documentation`]: what the words of the language mean; `vocabulary`: which words a text may use;
//!   `expanded`: the text to which a macro expands. For editors.
//! - `dialect`: the hosts of shaders with their inputs, and the versions of the language.
//! - `codes`: the stable codes of diagnostics; `foreign`: names from other languages and versions.
//! - `stage`, `sampling`: the tabs of a project, and how channels are sampled.

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;

mod analysis;
mod built_in;
mod check;
mod constant;
mod dialect;
pub mod documentation;
mod expanded;
mod foreign;
mod keywords;
mod parse;
mod port;
mod preprocess;
mod reporting;
mod single_edit;
mod source;
mod stage;
mod token;
pub mod tree;
mod vocabulary;

use std::collections::{HashMap, HashSet};

pub use analysis::{Analysis, Resolution, ResolvedName, Visibility, analyze};
pub use dialect::{Dialect, Version};
pub use expanded::expanded;
pub use port::{PortError, Refusal, port, port_in_versions};
pub use preprocess::{ControlComment, Expansions, MacroDefinition, ReadInclude};
pub use reporting::{MAX_REPORTED, overdue};
pub use single_edit::{single_edit, with_single_edit};
pub use source::{Lexeme, lexemes};
pub use stage::{ADDED_MAIN, Stage};
use toyproof_diagnostic::{Deadline, Diagnostic, Diagnostics, FileId, Files, Severity};
pub use toyproof_image::{Filter, Sampling, UniformValue, Wrap};
use tree::{FunctionId, SamplerShape, Tree, VariableId};

use self::analysis::{Content, NameIndex, Partial};
use self::check::{Channels, Checker};
use self::dialect::{Bound, Wrapping};
use self::parse::Parser;
use self::preprocess::PreprocessorOutput;

/// Maximum nesting depth of statements, parentheses, calls, unary operators and `?:`, counted together.
/// Deeper nesting is reported; this depth fits a stack of 2 MB. Chains of operators, of postfix `.x` and
/// `[i]`, of commas and of `else if` do not count.
pub const MAX_NESTING: usize = 256;

/// What becomes of the uniforms that a shader declares, apart from textures, which read channels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum UniformMode {
    /// The host's inputs and the given values take their places.
    #[default]
    Replaced,
    /// The host's inputs take their places. Those with values stay variables, of which the values are the
    /// initializers, for what is written in another language.
    Kept,
    /// All stay variables, also those that have the name of an input of the host: for a host that sets them
    /// itself.
    Own,
}

/// Options of a check.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// Accepts what desktop GLSL accepts: global initializers that are not constant (they run before
    /// `mainImage`, in order), implicit conversions from integers to floats, arrays of arrays, `?:` of arrays
    /// and structures, and user functions named like built-in ones.
    pub lenient: bool,
    /// The host of the shader; `None` to recognize it by the text. The tabs of a project are ShaderToy's.
    pub dialect: Option<Dialect>,
    /// The values of uniforms that the shader declares.
    pub uniforms: Vec<UniformValue>,
    /// What becomes of the uniforms that the shader declares.
    pub uniform_mode: UniformMode,
    /// The tab of a project that the text is.
    pub stage: Stage,
    /// Calls [`ADDED_MAIN`], which has the form of `mainImage`, instead of the function that the host calls:
    /// for a shader to which code was added that calls its functions.
    pub calls_added_main: bool,
    /// The shapes of the textures bound to `iChannel0` to `iChannel3`. An unknown shape is inferred from use:
    /// `sampler2D`, or the shape that the first lookup that does not fit a `sampler2D` requires.
    pub channels: [Option<SamplerShape>; 4],
    /// How the textures of `iChannel0` to `iChannel3` are sampled.
    pub sampling: [Sampling; 4],
    /// When the check must end. Lints get a quarter of the time for themselves; lints that take longer are
    /// skipped.
    pub deadline: Deadline,
}

impl Options {
    /// Adds the values of uniforms that have none.
    pub fn add_uniforms(&mut self, values: &[UniformValue]) {
        UniformValue::add_missing(&mut self.uniforms, values);
    }
}

/// A shader without errors.
#[derive(Debug, Clone)]
pub struct Checked {
    /// The shader.
    pub tree: Tree,
    /// `void mainImage(out vec4, in vec2)`, or the function that ShaderToy calls in another [`Stage`]. Of a
    /// host that runs `main`, a function that calls it and returns its output.
    pub main_image: FunctionId,
    /// The host of the shader.
    pub dialect: Dialect,
    /// The version of GLSL in which it is written.
    pub version: Version,
    /// Whether it was checked leniently, see [`Options::lenient`].
    pub lenient: bool,
    /// The values of its uniforms, see [`Options::uniforms`].
    pub uniforms: Vec<UniformValue>,
    /// What became of the uniforms that it declares.
    pub uniform_mode: UniformMode,
    /// The shapes of `iChannel0` to `iChannel3`, as given in the options or inferred from use.
    pub channels: [SamplerShape; 4],
    /// How the textures of `iChannel0` to `iChannel3` are sampled.
    pub sampling: [Sampling; 4],
    /// The tab that the text is.
    pub stage: Stage,
    /// The front end's warnings in source order, including those that the author allows: lints filter them.
    pub warnings: Vec<Diagnostic>,
    /// The `// toyproof:` comments, which control lints.
    pub control_comments: Vec<ControlComment>,
    /// The macros, which diagnostics name.
    pub expansions: Expansions,
    /// Names in branches of `#if` that are not compiled, and in the replacements of macros: with other
    /// macros, or a use of them, the shader may use what these names declare.
    pub unexpanded_names: HashSet<String>,
    /// The uniforms with values that an expression reads.
    pub values_read: HashSet<VariableId>,
    /// Whether the extension of derivatives is enabled, which WebGL 1 requires for them.
    pub enables_derivatives: bool,
    /// The uniforms and varyings that have a value.
    pub(crate) bound: HashMap<VariableId, Bound>,
    /// The variable that holds the color, if the host runs `main`.
    pub(crate) output: Option<VariableId>,
}

impl Checked {
    /// The options of the check, with which an edited text is checked alike; without a deadline.
    pub fn options(&self) -> Options {
        Options {
            lenient: self.lenient,
            dialect: Some(self.dialect),
            uniforms: self.uniforms.clone(),
            uniform_mode: self.uniform_mode,
            stage: self.stage,
            calls_added_main: false,
            channels: self.channels.map(Some),
            sampling: self.sampling,
            deadline: Deadline::default(),
        }
    }

    /// Whether a uniform or varying that the shader declares has the value of an input, of a texture or of
    /// the options: no expression reads the variable itself.
    pub fn is_bound(&self, variable: tree::VariableId) -> bool {
        self.bound.contains_key(&variable)
    }

    /// The uniforms that the text declares, with the components of their values; `None` for inputs, which the
    /// host sets.
    pub fn declared_uniforms(&self) -> impl Iterator<Item = (&str, tree::Type, Option<&[f64]>)> {
        let variables = self.tree.variables.iter();
        let declared = variables
            .filter(|(_, variable)| variable.kind == tree::VariableKind::Uniform && variable.at.is_some());
        declared.map(|(id, variable)| {
            let value = match self.bound.get(&id) {
                Some(Bound::Input(_)) => None,
                Some(Bound::Value(_, components)) => Some(&components[..]),
                None => Some(&[][..]),
            };
            (&*variable.name, variable.ty, value)
        })
    }

    /// The names of functions, structures and global variables that the text declares, with the bytes where
    /// they are declared.
    pub fn global_names(&self) -> impl Iterator<Item = (&str, u32)> {
        let tree = &self.tree;
        tree.items.iter().filter_map(|item| match *item {
            tree::Item::Variable(id) => Some((&*tree[id].name, tree[id].at?.span.start)),
            tree::Item::Function(id) | tree::Item::Prototype(id) => {
                Some((&*tree[id].name, tree[id].at.span.start))
            }
            tree::Item::Struct(id) => Some((&*tree[id].name, tree[id].at.span.start)),
        })
    }

    /// Whether the shader has `discard`.
    pub fn discards(&self) -> bool {
        let mut found = false;
        for (_, function) in self.tree.functions.iter() {
            tree::walk::each(function.body.as_deref().unwrap_or_default(), &mut |statement| {
                found |= matches!(statement.kind, tree::StatementKind::Discard);
            });
        }
        found
    }

    /// Whether the shader calls `dFdx`, `dFdy` or `fwidth`.
    pub fn takes_derivatives(&self) -> bool {
        self.calls(tree::BuiltIn::is_derivative)
    }

    /// Whether the shader reads textures otherwise than by `texelFetch`.
    pub fn samples_textures(&self) -> bool {
        use tree::BuiltIn::{TexelFetch, TexelFetchOffset, TextureSize};
        self.calls(|function| {
            function.is_texture() && !matches!(function, TexelFetch | TexelFetchOffset | TextureSize)
        })
    }

    /// Whether an expression names an input.
    pub fn reads_input(&self, input: tree::Input) -> bool {
        self.names(|variable| variable.kind == tree::VariableKind::Input(input))
    }

    fn names(&self, is_one: impl Fn(&tree::Variable) -> bool) -> bool {
        let mut exprs = self.tree.exprs.iter();
        exprs.any(|(_, expr)| matches!(expr.kind, tree::ExprKind::Variable(id) if is_one(&self.tree[id])))
    }

    /// Whether an expression names a channel.
    pub fn names_channel(&self, channel: usize) -> bool {
        self.names(|variable| variable.kind == tree::VariableKind::Channel(channel as u8))
    }

    /// Whether the shader reads an input.
    pub fn reads(&self, input: tree::Input) -> bool {
        let is_input =
            |variable: tree::VariableId| self.tree[variable].kind == tree::VariableKind::Input(input);
        let reads =
            |kind: &tree::ExprKind| matches!(kind, tree::ExprKind::Variable(variable) if is_input(*variable));
        self.tree.exprs.iter().any(|(_, expr)| reads(&expr.kind))
    }

    /// Whether the shader reads a texture.
    pub fn reads_textures(&self) -> bool {
        self.calls(tree::BuiltIn::is_texture)
    }

    fn calls(&self, is_one: impl Fn(tree::BuiltIn) -> bool) -> bool {
        let mut exprs = self.tree.exprs.iter();
        exprs.any(
            |(_, expr)| matches!(expr.kind, tree::ExprKind::BuiltIn { function, .. } if is_one(function)),
        )
    }
}

/// Adds the text in which included files replace their directives, and returns its id; that of the file
/// itself if it includes none. Spans in the text are reported as those of the files.
///
/// # Errors
/// A file cannot be read, or a limit is exceeded. Other errors of the text are left to its check.
pub fn with_includes(
    files: &mut Files,
    file: FileId,
    options: &Options,
    read: &mut ReadInclude,
) -> Result<FileId, Diagnostics> {
    let declared = preprocess::declared_version(files, file);
    let wrapping = Wrapping::new(options.dialect.unwrap_or_default(), declared, options.lenient);
    preprocess::with_includes(files, file, options.stage, wrapping, &options.deadline, read)
}

/// Checks a shader. Returns its tree, or its diagnostics in source order.
///
/// ```
/// use toyproof_glsl::{Options, check};
/// use toyproof_diagnostic::{File, Files};
///
/// let mut files = Files::default();
/// let text = "void mainImage(out vec4 c, in vec2 f) { c = vec4(f / iResolution.xy, 0, 1); }";
/// let file = files.add(File::new("gradient.glsl", text));
/// let checked = check(&files, file, &Options::default()).unwrap();
/// assert_eq!(checked.tree[checked.main_image].name, "mainImage");
/// ```
///
/// # Errors
/// If the shader breaks a rule: at least one error, possibly among warnings.
///
/// # Panics
/// For [`Stage::Common`], which has no entry point: see [`check_declarations`].
pub fn check(files: &Files, file: FileId, options: &Options) -> Result<Checked, Diagnostics> {
    let text = read(files, file, options, false).valid(files)?;
    Ok(text
        .into_checked(options)
        .unwrap_or_else(|_| panic!("every stage but Common has an entry point")))
}

/// Checks a text without an entry point, such as Common of a project, which ShaderToy compiles alone
/// ([`Stage::Common`]). Returns its warnings, or its diagnostics, in source order.
///
/// # Errors
/// If the text breaks a rule.
pub fn check_declarations(
    files: &Files,
    file: FileId,
    options: &Options,
) -> Result<Vec<Diagnostic>, Diagnostics> {
    let text = read(files, file, options, false).valid(files)?;
    let warnings = text.diagnostics.into_iter();
    Ok(warnings
        .map(|warning| text.expansions.named(warning, files))
        .collect())
}

/// A text, with or without errors.
struct Text {
    tree: Tree,
    /// The entry point, unless the stage has none or there are errors.
    entry: Option<FunctionId>,
    wrapping: Wrapping,
    channels: [SamplerShape; 4],
    /// What is reported. Without errors, the warnings do not name macros: lints filter them first.
    diagnostics: Vec<Diagnostic>,
    is_valid: bool,
    /// What names denote, if that was to be recorded.
    names: Option<Box<NameIndex>>,
    /// The length of the text in bytes.
    length: u32,
    control_comments: Vec<ControlComment>,
    expansions: Expansions,
    unexpanded_names: HashSet<String>,
    values_read: HashSet<VariableId>,
    enables_derivatives: bool,
    bound: HashMap<VariableId, Bound>,
    output: Option<VariableId>,
}

/// Preprocesses a text in its dialect, which is recognized if the options do not give it: only a shader of
/// another host than ShaderToy has a function `main`.
fn preprocess(files: &Files, file: FileId, options: &Options) -> (Wrapping, PreprocessorOutput) {
    let declared = preprocess::declared_version(files, file);
    let read = |dialect| {
        let wrapping = Wrapping::new(dialect, declared, options.lenient);
        let text = preprocess::preprocess(files, file, options.stage, wrapping, &options.deadline);
        (wrapping, text)
    };
    if options.stage != Stage::Image {
        // The buffers of a project are ShaderToy's, but for those that a header of ISF declares, and those
        // that were written for another host.
        let other = options.dialect.filter(|&dialect| {
            matches!(dialect, Dialect::Isf | Dialect::WebGl) && options.stage == Stage::Buffer
        });
        return read(other.unwrap_or_default());
    }
    if let Some(dialect) = options.dialect {
        return read(dialect);
    }
    let as_shadertoy = read(Dialect::ShaderToy);
    let text = &as_shadertoy.1;
    let occurs = |name: &str| text.interner.find(name).is_some();
    let dialect = if text.defines_main() {
        Dialect::of_main(occurs)
    } else {
        Dialect::of_main_image(occurs)
    };
    if dialect == Dialect::ShaderToy {
        as_shadertoy
    } else {
        read(dialect)
    }
}

/// Reads a text. With `records_names`, also what names denote, and what can be parsed of a text whose extent
/// is unknown.
fn read(files: &Files, file: FileId, options: &Options, records_names: bool) -> Text {
    let deadline = &options.deadline;
    let (wrapping, mut text) = preprocess(files, file, options);
    let source = files.get(file);
    let mut channels = Channels::new(options);
    if let Err(late) = deadline.check() {
        return Text::of_preprocessed(text, wrapping, &channels, vec![overdue(late)]);
    }
    if text.incomplete && !records_names {
        let reported = text.named_diagnostics(files);
        return Text::of_preprocessed(text, wrapping, &channels, reported);
    }
    // What follows from text whose extent is unknown is not reported.
    let only_reported = text.incomplete.then(|| text.named_diagnostics(files));
    parse::balance(&mut text, source);
    let reported = std::mem::take(&mut text.diagnostics);
    // A use may determine the shape of a channel; the shader is then parsed again with it, at most twice for
    // each of the four channels.
    loop {
        channels.changed = false;
        let mut checker = Checker::new(&text, options, wrapping, channels.clone());
        if records_names {
            checker.record_names();
        }
        let mut checker = Parser::new(&text, source, checker).parse();
        if let Err(late) = deadline.check() {
            return Text::of_preprocessed(text, wrapping, &channels, vec![overdue(late)]);
        }
        if checker.channels().changed {
            channels = checker.channels().clone();
            continue;
        }
        let entry = checker.finish();
        let mut all = reported;
        all.append(&mut checker.warnings);
        all.append(&mut checker.errors);
        let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
        all.sort_by_key(|diagnostic| diagnostic.span.map_or(u32::MAX, |span| span.start));
        let has_entry = entry.is_some() || options.stage.entry().is_none();
        let is_valid = has_entry && only_reported.is_none() && !all.iter().any(is_error);
        let diagnostics = match only_reported {
            Some(only) => only,
            None if is_valid => all,
            None => named_once(all, &text.expansions, files),
        };
        let names = checker.take_names();
        let Checker {
            tree,
            values_read,
            bound,
            output,
            ..
        } = checker;
        let unexpanded_names = text.unexpanded_names.iter();
        return Text {
            tree,
            entry: entry.filter(|_| is_valid),
            wrapping,
            channels: channels.shapes,
            diagnostics,
            is_valid,
            names,
            length: source.text().len() as u32,
            control_comments: text.control_comments,
            unexpanded_names: unexpanded_names
                .map(|&name| text.interner.text(name).to_owned())
                .collect(),
            expansions: text.expansions,
            values_read,
            enables_derivatives: text.enables_derivatives,
            bound,
            output,
        };
    }
}

/// The diagnostics of a text with errors, with the names of macros: an error in a macro is reported at its
/// first use only.
fn named_once(all: Vec<Diagnostic>, expansions: &Expansions, files: &Files) -> Vec<Diagnostic> {
    let mut reported = Vec::new();
    for diagnostic in all {
        let notes = diagnostic.notes.len();
        let diagnostic = expansions.named(diagnostic, files);
        let is_in_macro = diagnostic.notes.len() > notes;
        let again = |other: &Diagnostic| {
            (&other.message, &other.notes, &other.related)
                == (&diagnostic.message, &diagnostic.notes, &diagnostic.related)
        };
        if !(is_in_macro && reported.iter().any(again)) {
            reporting::push_limited(&mut reported, diagnostic);
        }
    }
    reported
}

impl Text {
    /// A text that was not parsed, with the errors that are the reason.
    fn of_preprocessed(
        text: PreprocessorOutput,
        wrapping: Wrapping,
        channels: &Channels,
        errors: Vec<Diagnostic>,
    ) -> Self {
        Self {
            tree: Tree::default(),
            entry: None,
            wrapping,
            channels: channels.shapes,
            diagnostics: errors,
            is_valid: false,
            names: None,
            length: 0,
            control_comments: text.control_comments,
            expansions: text.expansions,
            unexpanded_names: HashSet::new(),
            values_read: HashSet::new(),
            enables_derivatives: text.enables_derivatives,
            bound: HashMap::new(),
            output: None,
        }
    }

    /// The text, if it is valid.
    fn valid(self, files: &Files) -> Result<Self, Diagnostics> {
        if self.is_valid {
            Ok(self)
        } else {
            Err(Diagnostics::new(self.diagnostics, files))
        }
    }

    /// The shader, if the text has an entry point.
    fn into_checked(self, options: &Options) -> Result<Checked, Box<Self>> {
        let Some(main_image) = self.entry else {
            return Err(Box::new(self));
        };
        Ok(Checked {
            tree: self.tree,
            main_image,
            dialect: self.wrapping.dialect,
            version: self.wrapping.language.version,
            lenient: options.lenient,
            uniforms: options.uniforms.clone(),
            uniform_mode: options.uniform_mode,
            channels: self.channels,
            sampling: options.sampling,
            stage: options.stage,
            warnings: self.diagnostics,
            control_comments: self.control_comments,
            expansions: self.expansions,
            unexpanded_names: self.unexpanded_names,
            values_read: self.values_read,
            enables_derivatives: self.enables_derivatives,
            bound: self.bound,
            output: self.output,
        })
    }

    fn into_analysis(mut self, options: &Options) -> Analysis {
        let names = self.names.take().unwrap_or_default();
        let (names, visibilities) = names.finish(self.length);
        let Wrapping { dialect, language } = self.wrapping;
        let (diagnostics, channels) = (self.diagnostics.clone(), self.channels);
        let content = match self.into_checked(options) {
            Ok(checked) => Content::Checked(Box::new(checked)),
            Err(text) => Content::Partial(Box::new(Partial {
                tree: text.tree,
                control_comments: text.control_comments,
                expansions: text.expansions,
            })),
        };
        Analysis {
            diagnostics,
            dialect,
            version: language.version,
            stage: options.stage,
            channels,
            names,
            visibilities,
            content,
        }
    }
}

#[cfg(test)]
mod tests;
