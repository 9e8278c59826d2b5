//! The rules (GLSL ES 3.00.6 §4–§8): what the parser asks at each construct, answered with typed nodes.
//!
//! A mistake is told once: its expression gets [`Type::Error`], which fits everywhere.

mod access;
mod assign;
mod call;
mod channel;
mod construct;
mod declare;
mod extent;
mod function;
mod mend;
mod operator;
mod overload;
mod prelude;
mod qualifier;
mod scope;
mod signature;
mod statement;
mod types;
mod unknown;
mod whole;

use std::collections::HashSet;

pub(crate) use declare::Declarator;
pub(crate) use function::Parameter;
pub(crate) use qualifier::{Qualifiers, Storage};
pub(crate) use statement::Labels;
use toyproof_diagnostic::{Deadline, Diagnostic};
pub(crate) use types::{Members, Size, Specifier};

pub(crate) use self::channel::Channels;
use self::extent::Extent;
use self::function::Context;
use self::scope::Scopes;
use super::codes::{Code, IN_MACRO, MAX_TOLD, tell};
use super::options::Options;
use super::preprocess::Preprocessed;
use super::token::Symbol;
use super::tree::{Expr, ExprId, ExprKind, FunctionId, Literal, Place, Scalar, StructId, Tree, Type, Value};
use super::words::Words;

/// Builds the tree and keeps the rules.
pub(crate) struct Checker<'a> {
    words: &'a Words,
    lenient: bool,
    pub(crate) tree: Tree,
    scopes: Scopes,
    channels: Channels,
    /// What is known of each structure of the tree, in order.
    struct_extents: Vec<Extent>,
    /// The function whose body is being read.
    function: Option<Context>,
    /// Who calls whom, and where.
    calls: Vec<(FunctionId, FunctionId, Place)>,
    /// The names that were told not to be declared, and where.
    unknown: Vec<(Symbol, Place)>,
    /// Structures whose members could not all be read.
    incomplete: Vec<StructId>,
    /// Names that may be declared in what could not be read.
    doubtful: HashSet<Symbol>,
    /// Whether any name may be.
    lacks_names: bool,
    /// What is written last.
    end: Option<Place>,
    pub(crate) errors: Vec<Diagnostic>,
    pub(crate) warnings: Vec<Diagnostic>,
    pub(crate) deadline: Deadline,
}

impl<'a> Checker<'a> {
    pub(crate) fn new(text: &'a Preprocessed, options: &Options, channels: Channels) -> Self {
        let mut checker = Self {
            words: &text.words,
            unknown: Vec::new(),
            incomplete: Vec::new(),
            doubtful: HashSet::new(),
            lacks_names: text.lacks_names,
            // The last of the tokens is the end itself, which may stand lines below what is written.
            end: text.tokens.iter().rev().take(2).next_back().map(|token| token.at),
            lenient: options.lenient,
            tree: Tree::default(),
            scopes: Scopes::default(),
            channels,
            struct_extents: Vec::new(),
            function: None,
            calls: Vec::new(),
            errors: Vec::new(),
            warnings: Vec::new(),
            deadline: options.deadline.clone(),
        };
        checker.declare_prelude();
        checker
    }

    /// Whether so many errors were told that more would help nobody.
    pub(crate) fn is_full(&self) -> bool {
        self.errors.len() >= MAX_TOLD
    }

    /// Tells an error; one in the body of a macro is told at its first use only.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        let in_macro = diagnostic.related.iter().any(|(_, words)| words == IN_MACRO);
        let again =
            |other: &Diagnostic| other.message == diagnostic.message && other.related == diagnostic.related;
        if !in_macro || !self.errors.iter().any(again) {
            tell(&mut self.errors, diagnostic);
        }
    }

    /// From now on, that this name is not declared is not told.
    pub(crate) fn doubt(&mut self, name: Symbol) {
        self.doubtful.insert(name);
    }

    /// Whether an undeclared name may be declared in what could not be read.
    fn is_doubtful(&self, name: Symbol) -> bool {
        self.lacks_names || self.doubtful.contains(&name)
    }

    fn error(&mut self, code: Code, at: Place, message: impl Into<String>) {
        self.report(code.at(at, message));
    }

    fn text(&self, symbol: Symbol) -> &'a str {
        self.words.text(symbol)
    }

    fn ty(&self, expr: ExprId) -> Type {
        self.tree[expr].ty
    }

    /// The type of an expression, quoted for a message.
    fn said(&self, ty: Type) -> String {
        format!("`{}`", self.tree.type_name(ty))
    }

    fn push(&mut self, kind: ExprKind, ty: Type, constant: bool, at: Place) -> ExprId {
        let expr = Expr {
            kind,
            ty,
            constant,
            at,
        };
        let id = self.tree.exprs.push(expr);
        self.tree.keep_value(id);
        id
    }

    /// What stands for an expression whose mistake has been told.
    pub(crate) fn broken(&mut self, at: Place) -> ExprId {
        let nothing = Literal {
            text: "".into(),
            value: Value::Bool(false),
        };
        self.push(ExprKind::Literal(nothing), Type::Error, true, at)
    }

    /// Tells a mistake in an expression and stands in for it.
    pub(crate) fn refuse(&mut self, code: Code, at: Place, message: impl Into<String>) -> ExprId {
        self.error(code, at, message);
        self.broken(at)
    }

    /// The same with all that there is to say.
    fn refuse_with(&mut self, diagnostic: Diagnostic, at: Place) -> ExprId {
        self.report(diagnostic);
        self.broken(at)
    }

    pub(crate) fn literal(&mut self, literal: Literal, at: Place) -> ExprId {
        let ty = literal.value.ty();
        self.push(ExprKind::Literal(literal), ty, true, at)
    }

    /// The expression as a value of that type: itself, or under `lenient` converted as desktop GLSL does. None if it does not fit.
    fn convert(&mut self, expr: ExprId, to: Type) -> Option<ExprId> {
        let from = self.ty(expr);
        if from == to || from == Type::Error || to == Type::Error {
            return Some(expr);
        }
        if !self.converts(from, to) {
            return None;
        }
        let Expr { constant, at, .. } = self.tree[expr];
        let kind = ExprKind::Construct {
            constructor: construct::conversion(to),
            arguments: vec![expr],
        };
        Some(self.push(kind, to, constant, at))
    }

    /// Whether desktop GLSL converts so without being asked (GLSL 4.60 §4.1.10), and we may.
    fn converts(&self, from: Type, to: Type) -> bool {
        self.lenient && liberal_conversion(from, to)
    }

    /// The expression as a value of that type, or an error that names what for.
    fn expect(&mut self, expr: ExprId, to: Type, role: &str) -> ExprId {
        if let Some(fits) = self.convert(expr, to) {
            return fits;
        }
        let (from, at) = (self.ty(expr), self.tree[expr].at);
        let message = format!(
            "{role} must be {}, and this is {}",
            self.said(to),
            self.said(from)
        );
        let diagnostic = self.mended(Code::Mismatch.at(at, message), expr, to);
        self.refuse_with(diagnostic, at)
    }

    /// A condition: a `bool` (§6.2).
    pub(crate) fn condition(&mut self, expr: ExprId) -> ExprId {
        self.expect(expr, Type::BOOL, "a condition")
    }
}

/// Whether desktop GLSL converts so without being asked (GLSL 4.60 §4.1.10).
fn liberal_conversion(from: Type, to: Type) -> bool {
    let rank = |ty: Type| match ty.scalar() {
        Some(Scalar::Int) => 1,
        Some(Scalar::Uint) => 2,
        Some(Scalar::Float) => 3,
        Some(Scalar::Bool) | None => 0,
    };
    rank(from) > 0
        && rank(from) < rank(to)
        && to.scalar().and_then(|scalar| from.with_scalar(scalar)) == Some(to)
}
