//! The semantic rules (GLSL ES 3.00.6 §4–§8): the parser calls the checker for each construct and gets typed
//! nodes.
//!
//! Each error is reported once: its expression gets [`Type::Error`], which fits everywhere.

mod access;
mod call;
mod channel_input;
mod declare;
mod fixit;
mod function;
mod host;
mod initializer;
mod operator;
mod prelude;
mod quotient;
mod scope;
mod signature;
mod statement;
mod types;
mod version;

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::{Code, Deadline, Diagnostic, Fix, IN_MACRO};

pub(crate) use self::declare::{Declarator, Initializer, Qualifiers, Storage};
use self::function::Context;
pub(crate) use self::function::Parameter;
pub(crate) use self::prelude::Channels;
use self::scope::{Entity, Scopes, UnknownName};
pub(crate) use self::statement::Labels;
use self::types::Extent;
pub(crate) use self::types::{Members, Size, Specifier};
use crate::analysis::{NameIndex, Resolution};
use crate::dialect::{Bound, Dialect, Language, Wrapping};
use crate::keywords::Interner;
use crate::parse::LiteralError;
use crate::preprocess::PreprocessorOutput;
use crate::reporting::{MAX_REPORTED, push_limited};
use crate::stage::Stage;
use crate::token::Symbol;
use crate::tree::{
    Expr, ExprId, ExprKind, FunctionId, Literal, Place, Scalar, StructId, Tree, Type, Value, VariableId,
};
use crate::{Options, UniformMode, UniformValue};

/// Builds the tree and enforces the rules.
pub(crate) struct Checker<'a> {
    interner: &'a Interner,
    language: Language,
    dialect: Dialect,
    stage: Stage,
    calls_added_main: bool,
    /// The uniforms and varyings that have a value.
    pub(crate) bound: HashMap<VariableId, Bound>,
    /// The uniforms with values that an expression reads.
    pub(crate) values_read: HashSet<VariableId>,
    /// The values of uniforms that the caller gives.
    uniforms: &'a [UniformValue],
    /// What becomes of the uniforms that the shader declares.
    uniform_mode: UniformMode,
    /// The variable that holds the color, if the host runs `main`.
    pub(crate) output: Option<VariableId>,
    pub(crate) tree: Tree,
    scopes: Scopes,
    channels: Channels,
    /// What names denote, if an editor needs it.
    names: Option<Box<NameIndex>>,
    /// The extent of each structure of the tree, by index.
    struct_extents: Vec<Extent>,
    /// The function whose body is being parsed.
    function: Option<Context>,
    /// All calls.
    calls: Vec<Call>,
    /// The names that were reported as undeclared.
    unknown: Vec<UnknownName>,
    /// Structures some of whose members could not be parsed.
    incomplete: Vec<StructId>,
    /// Names that unparsable text may declare.
    maybe_declared: HashSet<Symbol>,
    /// Whether unparsable text may declare any name.
    lacks_names: bool,
    /// The last token of the text.
    end: Option<Place>,
    pub(crate) errors: Vec<Diagnostic>,
    pub(crate) warnings: Vec<Diagnostic>,
    pub(crate) deadline: Deadline,
}

/// A call of one of the author's functions.
#[derive(Debug, Clone, Copy)]
struct Call {
    caller: FunctionId,
    callee: FunctionId,
    at: Place,
}

impl<'a> Checker<'a> {
    pub(crate) fn new(
        text: &'a PreprocessorOutput,
        options: &'a Options,
        wrapping: Wrapping,
        channels: Channels,
    ) -> Self {
        let mut checker = Self {
            interner: &text.interner,
            unknown: Vec::new(),
            incomplete: Vec::new(),
            maybe_declared: HashSet::new(),
            lacks_names: text.lacks_names,
            // The last token is `End`, which may be lines below the last visible token.
            end: text.tokens.iter().rev().take(2).next_back().map(|token| token.at),
            language: wrapping.language,
            dialect: wrapping.dialect,
            stage: options.stage,
            calls_added_main: options.calls_added_main,
            bound: HashMap::new(),
            values_read: HashSet::new(),
            uniforms: &options.uniforms,
            uniform_mode: options.uniform_mode,
            output: None,
            tree: Tree::default(),
            scopes: Scopes::default(),
            channels,
            names: None,
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

    /// Records from here on what names denote.
    pub(crate) fn record_names(&mut self) {
        let mut names = Box::<NameIndex>::default();
        names.open_scope();
        self.names = Some(names);
    }

    /// The recorded names.
    pub(crate) fn take_names(&mut self) -> Option<Box<NameIndex>> {
        self.names.take()
    }

    /// Records that a name at a place denotes an entity.
    fn resolved(&mut self, at: Place, resolution: Resolution) {
        if let Some(names) = &mut self.names {
            names.resolve(at, resolution, false);
        }
    }

    /// Records that a name is declared at a place.
    fn declared(&mut self, at: Place, resolution: Resolution) {
        if let Some(names) = &mut self.names {
            names.resolve(at, resolution, true);
        }
    }

    /// Records that an entity is visible after its declarator, which ends at a byte, to the end of the current
    /// scope. At the end itself, an author may still be writing the declarator.
    fn visible_after(&mut self, end: u32, resolution: Resolution) {
        if let Some(names) = &mut self.names {
            names.declare(resolution, end + 1);
        }
    }

    /// Whether the limit on reported errors is reached.
    pub(crate) fn is_full(&self) -> bool {
        self.errors.len() >= MAX_REPORTED
    }

    /// Reports an error; an error in the body of a macro is reported at its first use only.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        let in_macro = diagnostic.related.iter().any(|(_, text)| text == IN_MACRO);
        let again =
            |other: &Diagnostic| other.message == diagnostic.message && other.related == diagnostic.related;
        if !in_macro || !self.errors.iter().any(again) {
            push_limited(&mut self.errors, diagnostic);
        }
    }

    /// Stops reporting this name as undeclared.
    pub(crate) fn mark_maybe_declared(&mut self, name: Symbol) {
        self.maybe_declared.insert(name);
    }

    /// Whether unparsable text may declare the name.
    fn is_maybe_declared(&self, name: Symbol) -> bool {
        self.lacks_names || self.maybe_declared.contains(&name)
    }

    fn error(&mut self, code: Code, at: Place, message: impl Into<String>) {
        self.report(code.at(at, message));
    }

    fn text(&self, symbol: Symbol) -> &'a str {
        self.interner.text(symbol)
    }

    fn ty(&self, expr: ExprId) -> Type {
        self.tree[expr].ty
    }

    /// The type of an expression, quoted for a message.
    fn quoted_type(&self, ty: Type) -> String {
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
        self.tree.cache_value(id);
        id
    }

    /// The expression that replaces one whose error has been reported.
    pub(crate) fn error_expr(&mut self, at: Place) -> ExprId {
        let nothing = Literal::new("", Value::Bool(false));
        self.push(ExprKind::Literal(nothing), Type::Error, true, at)
    }

    /// Reports an error in an expression and returns an error expression.
    pub(crate) fn refuse(&mut self, code: Code, at: Place, message: impl Into<String>) -> ExprId {
        self.error(code, at, message);
        self.error_expr(at)
    }

    /// Reports a complete diagnostic and returns an error expression.
    fn refuse_with(&mut self, diagnostic: Diagnostic, at: Place) -> ExprId {
        self.report(diagnostic);
        self.error_expr(at)
    }

    /// Reports a malformed numeric literal and returns an error expression.
    pub(crate) fn malformed_literal(&mut self, error: LiteralError, at: Place) -> ExprId {
        let diagnostic = error.code.at(at, error.message);
        let diagnostic = match error.replacement {
            Some(number) => diagnostic.fix(Fix::new(format!("write `{number}`"), at.spelling, number)),
            None => diagnostic,
        };
        self.refuse_with(diagnostic, at)
    }

    pub(crate) fn literal(&mut self, literal: Literal, at: Place) -> ExprId {
        let ty = literal.value.ty();
        self.push(ExprKind::Literal(literal), ty, true, at)
    }

    /// Converts an expression to a type: returns it unchanged, or implicitly converted as in desktop
    /// GLSL. Returns `None` if it does not fit.
    fn convert(&mut self, expr: ExprId, to: Type) -> Option<ExprId> {
        let from = self.ty(expr);
        if from == to || from == Type::Error || to == Type::Error {
            return Some(expr);
        }
        if !self.converts_implicitly(from, to) {
            return None;
        }
        let Expr { constant, at, .. } = self.tree[expr];
        let kind = ExprKind::Construct {
            constructor: call::conversion(to),
            arguments: vec![expr],
        };
        Some(self.push(kind, to, constant, at))
    }

    /// Whether the language converts implicitly from one type to the other.
    fn converts_implicitly(&self, from: Type, to: Type) -> bool {
        let is_unsigned = to.scalar() == Some(Scalar::Uint);
        self.language.converts_implicitly()
            && (!is_unsigned || self.language.converts_to_unsigned())
            && is_desktop_conversion(from, to)
    }

    /// Converts an expression to a type, or reports an error in which `role` names the expression.
    fn expect(&mut self, expr: ExprId, to: Type, role: &str) -> ExprId {
        if let Some(fits) = self.convert(expr, to) {
            return fits;
        }
        let (from, at) = (self.ty(expr), self.tree[expr].at);
        let message = format!(
            "{role} must be {}, not {}",
            self.quoted_type(to),
            self.quoted_type(from)
        );
        let diagnostic = self.with_fixit(Code::Mismatch.at(at, message), expr, to);
        self.refuse_with(diagnostic, at)
    }

    /// Checks a condition, which must be a `bool` (§6.2).
    pub(crate) fn condition(&mut self, expr: ExprId) -> ExprId {
        self.expect(expr, Type::BOOL, "the condition")
    }
}

/// Whether desktop GLSL converts implicitly from one type to the other (GLSL 4.60 §4.1.10).
fn is_desktop_conversion(from: Type, to: Type) -> bool {
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
