//! A front end for GLSL ES 3.00 as ShaderToy runs it: from an author's text to a typed tree, or to diagnostics that a
//! student can act on. Nothing here knows what becomes of the tree.
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
mod options;
mod parse;
mod preprocess;
mod token;
pub mod tree;
mod words;

pub use codes::{Code, IN_MACRO, MAX_TOLD, overdue};
pub use options::Options;
pub use preprocess::Remark;
use toyproof_diagnostic::{Diagnostic, FileId, Files, Severity};
use tree::{FunctionId, SamplerShape, Tree};

use self::check::{Channels, Checker};
use self::parse::Parser;

/// How deep statements, parentheses, calls, unary operators and `?:` may nest, all together. More is refused with a diagnostic; this much
/// fits a stack of 2 MB. Chains of operators, of postfix `.x` and `[i]`, of commas and of `else if` do not count.
pub const MAX_NESTING: usize = 256;

/// A shader that keeps every rule.
#[derive(Debug, Clone)]
pub struct Checked {
    /// The shader.
    pub tree: Tree,
    /// `void mainImage(out vec4, in vec2)`.
    pub main_image: FunctionId,
    /// The shapes of `iChannel0` to `iChannel3`, as asked for or told from use.
    pub channels: [SamplerShape; 4],
    /// Legal things that the front end warns of, in the order of the text. What the author allows is among them: lints know.
    pub warnings: Vec<Diagnostic>,
    /// The comments that are meant for lints.
    pub remarks: Vec<Remark>,
}

impl Checked {
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
                all.sort_by_key(|warning| warning.span.map(|span| span.start));
                Ok(Checked {
                    tree: checker.tree,
                    main_image,
                    channels: channels.shapes,
                    warnings: all,
                    remarks: text.remarks,
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
