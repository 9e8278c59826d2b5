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
mod operator;
mod prelude;
mod scope;
mod signature;
mod statement;
mod types;

pub(crate) use declare::{Declarator, Qualifiers, Storage};
pub(crate) use function::Parameter;
pub(crate) use types::{Size, Specifier};

pub(crate) use self::channel::Channels;
use self::extent::Extent;
use self::function::Context;
use self::scope::Scopes;
use super::codes::{Code, MAX_TOLD, tell};
use super::options::Options;
use super::token::Symbol;
use super::tree::{Expr, ExprId, ExprKind, FunctionId, Literal, Place, Scalar, Tree, Type, Value};
use super::words::Words;
use crate::diagnostic::Diagnostic;

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
    pub(crate) errors: Vec<Diagnostic>,
    pub(crate) warnings: Vec<Diagnostic>,
}

impl<'a> Checker<'a> {
    pub(crate) fn new(words: &'a Words, options: &Options, channels: Channels) -> Self {
        let mut checker = Self {
            words,
            lenient: options.lenient,
            tree: Tree::default(),
            scopes: Scopes::default(),
            channels,
            struct_extents: Vec::new(),
            function: None,
            calls: Vec::new(),
            errors: Vec::new(),
            warnings: Vec::new(),
        };
        checker.declare_prelude();
        checker
    }

    /// Whether so many errors were told that more would help nobody.
    pub(crate) fn is_full(&self) -> bool {
        self.errors.len() >= MAX_TOLD
    }

    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        tell(&mut self.errors, diagnostic);
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
        self.tree.exprs.push(expr)
    }

    /// What stands for an expression whose mistake has been told.
    fn broken(&mut self, at: Place) -> ExprId {
        let nothing = Literal {
            text: "".into(),
            value: Value::Bool(false),
        };
        self.push(ExprKind::Literal(nothing), Type::Error, true, at)
    }

    /// Tells a mistake in an expression and stands in for it.
    fn refuse(&mut self, code: Code, at: Place, message: impl Into<String>) -> ExprId {
        self.error(code, at, message);
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
        let rank = |ty: Type| match ty.scalar() {
            Some(Scalar::Int) => 1,
            Some(Scalar::Uint) => 2,
            Some(Scalar::Float) => 3,
            Some(Scalar::Bool) | None => 0,
        };
        self.lenient
            && rank(from) > 0
            && rank(from) < rank(to)
            && to.scalar().and_then(|scalar| from.with_scalar(scalar)) == Some(to)
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
        self.refuse(Code::Mismatch, at, message)
    }

    /// A condition: a `bool` (§6.2).
    pub(crate) fn condition(&mut self, expr: ExprId) -> ExprId {
        self.expect(expr, Type::BOOL, "a condition")
    }
}
