//! GLSL ES 3.00 as `ShaderToy` runs it: from an author's text to a typed tree.
//!
//! ```text
//! text ─► preprocess ─► tokens ─► parse ─(asks)─► check ─► tree
//! ```
//!
//! The parser knows the grammar and nothing else; at each construct it asks the checker, which knows scopes, types and rules, for
//! a typed node. So there is one tree, and no tree of mere syntax. Section numbers (§) are those of the GLSL ES 3.00.6
//! specification; where WebGL 2 (ANGLE) is stricter, so are we, and the place says so.

mod check;
mod codes;
mod constant;
mod foreign;
pub mod lower;
mod options;
mod parse;
mod preprocess;
mod print;
mod token;
pub mod tree;
mod warn;
pub mod wgsl;
mod words;

pub use codes::{Code, overdue};
pub use lower::{lower, lower_strict, lower_within};
pub use options::Options;
pub use print::Lowered;

use self::check::{Channels, Checker};
use self::parse::Parser;
use crate::diagnostic::{Diagnostic, Severity};
use crate::source::{FileId, Files, Span};
use tree::{FunctionId, SamplerShape, Tree};

/// How deep statements, parentheses, calls, unary operators and `?:` may nest, all together. More is refused with a diagnostic; this much
/// fits a stack of 2 MB. Chains of operators, of postfix `.x` and `[i]`, of commas and of `else if` do not count.
pub const MAX_NESTING: usize = 256;

/// Lints have that part of the time for a check.
const LINTS: u32 = 4;

/// A shader that keeps every rule.
#[derive(Debug, Clone)]
pub struct Checked {
    /// The shader.
    pub tree: Tree,
    /// `void mainImage(out vec4, in vec2)`.
    pub main_image: FunctionId,
    /// The shapes of `iChannel0` to `iChannel3`, as asked for or told from use.
    pub channels: [SamplerShape; 4],
    /// What is legal and worth a word, and not allowed by the author; or a note that the lints were out of time.
    pub warnings: Vec<Diagnostic>,
    /// Discriminants of spheres that lose digits, as textbooks write them, and not allowed by the author.
    pub discriminants: Vec<Span>,
    /// What the author allows of what is seen while the shader runs, and where.
    pub allowed: Vec<(Code, Span)>,
}

impl Checked {
    /// Whether the author allows this, which was seen while the shader ran. What is told of no line is allowed anywhere.
    #[must_use]
    pub fn allows(&self, seen: &Diagnostic) -> bool {
        let holds = |over: &Span| {
            seen.span
                .is_none_or(|at| at.file == over.file && (over.start..over.end).contains(&at.start))
        };
        let mut allowed = self.allowed.iter();
        allowed.any(|(code, over)| code.as_str() == seen.code && holds(over))
    }

    /// Whether `dFdx`, `dFdy` or `fwidth` occur in it.
    #[must_use]
    pub fn takes_derivatives(&self) -> bool {
        let is_derivative = |kind: &tree::ExprKind| matches!(kind, tree::ExprKind::BuiltIn { function, .. } if function.is_derivative());
        self.tree.exprs.iter().any(|(_, expr)| is_derivative(&expr.kind))
    }

    /// Whether it looks anything up in a texture.
    #[must_use]
    pub fn reads_textures(&self) -> bool {
        let looks_up = |kind: &tree::ExprKind| matches!(kind, tree::ExprKind::BuiltIn { function, .. } if function.is_texture());
        self.tree.exprs.iter().any(|(_, expr)| looks_up(&expr.kind))
    }
}

/// Checks a shader: its tree, or what is wrong with it, in the order of the text.
///
/// ```
/// use toyproof::glsl::{Options, check};
/// use toyproof::source::{File, Files};
///
/// let mut files = Files::default();
/// let text = "void mainImage(out vec4 c, in vec2 f) { c = vec4(f / iResolution.xy, 0, 1); }";
/// let file = files.add(File::new("gradient.glsl", text));
/// let checked = check(&files, file, &Options::default()).unwrap();
/// assert_eq!(checked.tree[checked.main_image].name, "mainImage");
/// ```
///
/// # Errors
/// With at least one error if the shader breaks a rule; warnings may stand among them.
pub fn check(files: &Files, file: FileId, options: &Options) -> Result<Checked, Vec<Diagnostic>> {
    let deadline = &options.deadline;
    let too_slow = |overdue| vec![codes::overdue(overdue)];
    let mut text = preprocess::preprocess(files, file, deadline);
    deadline.check().map_err(too_slow)?;
    if text.incomplete {
        return Err(text.diagnostics);
    }
    let source = files.get(file);
    parse::balance(&mut text, source);
    let told = std::mem::take(&mut text.diagnostics);
    let mut channels = Channels::new(options);
    // A use may tell the shape of a channel; the shader is then read anew with it, at most twice for each of the four.
    loop {
        channels.changed = false;
        let mut checker = Parser::new(&text, source, Checker::new(&text, options, channels.clone())).parse();
        deadline.check().map_err(too_slow)?;
        if checker.channels().changed {
            channels = checker.channels().clone();
            continue;
        }
        let main_image = checker.finish();
        let mut all = told;
        all.append(&mut checker.warnings);
        all.append(&mut checker.errors);
        let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
        return match main_image {
            Some(main_image) if !all.iter().any(is_error) => {
                let tree = checker.tree;
                let warned = warn::warn(
                    files,
                    &tree,
                    main_image,
                    &text.remarks,
                    all,
                    &deadline.share(LINTS),
                );
                Ok(Checked {
                    tree,
                    main_image,
                    channels: channels.shapes,
                    warnings: warned.warnings,
                    discriminants: warned.discriminants,
                    allowed: warned.allowed,
                })
            }
            _ => {
                all.sort_by_key(|diagnostic| diagnostic.span.map_or(u32::MAX, |span| span.start));
                let mut told = Vec::new();
                for diagnostic in all {
                    codes::tell(&mut told, diagnostic);
                }
                Err(told)
            }
        };
    }
}

#[cfg(test)]
mod tests;
