//! Terms: the expressions that an edit writes, as nodes of the typed tree and as text. A term consists of new
//! operations and of parts of the shader that it keeps.

use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, Expr, ExprId, ExprKind, FunctionId, Literal, Place, Scalar, Swizzle,
    Tree, Type, UnaryOp, Value, VariableId, VariableKind,
};

use crate::engine::Numbers;

/// An expression with its type.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Term {
    pub(super) kind: TermKind,
    pub(super) ty: Type,
}

/// The kind of a term.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TermKind {
    /// An expression of the shader.
    Keep(ExprId),
    Float(f64),
    Int(i32),
    Bool(bool),
    /// One of the numbers that are fitted, by its index; a literal once it is known.
    Fitted(u8),
    /// A place for a value, in a donor only.
    Hole(usize),
    Variable(VariableId),
    /// An operation on terms.
    Apply(Op, Vec<Term>),
}

/// An operation of the language, apart from its operands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Op {
    Unary(UnaryOp),
    Binary(BinaryOp),
    Conditional,
    Assign(Option<BinaryOp>),
    BuiltIn(BuiltIn),
    Call(FunctionId),
    Construct(Constructor),
    Swizzle(Swizzle),
    Member(usize),
    Index,
}

impl Op {
    /// The operation that an expression is, and its operands; `None` for names, literals and operations that
    /// no term has.
    pub(super) fn parts(kind: &ExprKind) -> Option<(Self, Vec<ExprId>)> {
        Some(match kind {
            &ExprKind::Unary { op, operand } => (Self::Unary(op), vec![operand]),
            &ExprKind::Binary { op, left, right } => (Self::Binary(op), vec![left, right]),
            &ExprKind::Conditional { condition, yes, no } => (Self::Conditional, vec![condition, yes, no]),
            &ExprKind::Assign { op, target, value } => (Self::Assign(op), vec![target, value]),
            ExprKind::BuiltIn { function, arguments } => (Self::BuiltIn(*function), arguments.clone()),
            ExprKind::Call { function, arguments } => (Self::Call(*function), arguments.clone()),
            ExprKind::Construct {
                constructor,
                arguments,
            } => (Self::Construct(*constructor), arguments.clone()),
            &ExprKind::Swizzle { vector, components } => (Self::Swizzle(components), vec![vector]),
            &ExprKind::Member { structure, member } => (Self::Member(member), vec![structure]),
            &ExprKind::Index { base, index } => (Self::Index, vec![base, index]),
            _ => return None,
        })
    }

    /// The expression with these operands.
    fn kind(self, operands: Vec<ExprId>) -> ExprKind {
        let at = |index: usize| operands[index];
        match self {
            Self::Unary(op) => ExprKind::Unary { op, operand: at(0) },
            Self::Binary(op) => ExprKind::Binary {
                op,
                left: at(0),
                right: at(1),
            },
            Self::Conditional => ExprKind::Conditional {
                condition: at(0),
                yes: at(1),
                no: at(2),
            },
            Self::Assign(op) => ExprKind::Assign {
                op,
                target: at(0),
                value: at(1),
            },
            Self::BuiltIn(function) => ExprKind::BuiltIn {
                function,
                arguments: operands,
            },
            Self::Call(function) => ExprKind::Call {
                function,
                arguments: operands,
            },
            Self::Construct(constructor) => ExprKind::Construct {
                constructor,
                arguments: operands,
            },
            Self::Swizzle(components) => ExprKind::Swizzle {
                vector: at(0),
                components,
            },
            Self::Member(member) => ExprKind::Member {
                structure: at(0),
                member,
            },
            Self::Index => ExprKind::Index {
                base: at(0),
                index: at(1),
            },
        }
    }
}

/// The precedence of operands that need no parentheses in any context, of prefix operators, and of `?:` and
/// assignments; binary operators lie between (GLSL ES 3.00.6 §5.1).
pub(super) const PRIMARY: u8 = 14;
const PREFIX: u8 = 12;
const CONDITIONAL: u8 = 0;
const ASSIGNMENT: u8 = 0;

impl Term {
    pub(super) fn new(kind: TermKind, ty: Type) -> Self {
        Self { kind, ty }
    }

    pub(super) fn apply(op: Op, operands: Vec<Self>, ty: Type) -> Self {
        Self::new(TermKind::Apply(op, operands), ty)
    }

    pub(super) fn construct(constructor: Constructor, arguments: Vec<Self>, ty: Type) -> Self {
        Self::apply(Op::Construct(constructor), arguments, ty)
    }

    pub(super) fn assign(op: Option<BinaryOp>, target: Self, value: Self) -> Self {
        let ty = target.ty;
        Self::apply(Op::Assign(op), vec![target, value], ty)
    }

    /// Whether it is a local variable or a parameter.
    pub(super) fn is_local(&self, tree: &Tree) -> bool {
        match self.kind {
            TermKind::Variable(id) => {
                matches!(tree[id].kind, VariableKind::Local | VariableKind::Parameter(_))
            }
            _ => false,
        }
    }

    /// A member of a structure.
    pub(super) fn member(structure: Self, at: usize, ty: Type) -> Self {
        Self::apply(Op::Member(at), vec![structure], ty)
    }

    pub(super) fn keep(tree: &Tree, expr: ExprId) -> Self {
        Self::new(TermKind::Keep(expr), tree[expr].ty)
    }

    pub(super) fn float(value: f64) -> Self {
        Self::new(TermKind::Float(value), Type::FLOAT)
    }

    pub(super) fn int(value: i32) -> Self {
        Self::new(TermKind::Int(value), Type::INT)
    }

    /// The first of the numbers that are fitted.
    pub(super) fn fitted() -> Self {
        Self::new(TermKind::Fitted(0), Type::FLOAT)
    }

    pub(super) fn variable(tree: &Tree, variable: VariableId) -> Self {
        Self::new(TermKind::Variable(variable), tree[variable].ty)
    }

    pub(super) fn unary(op: UnaryOp, operand: Self) -> Self {
        let ty = operand.ty;
        Self::apply(Op::Unary(op), vec![operand], ty)
    }

    /// A binary operation; `None` if the types do not fit.
    pub(super) fn binary(op: BinaryOp, left: Self, right: Self) -> Option<Self> {
        let ty = binary_type(op, left.ty, right.ty)?;
        Some(Self::apply(Op::Binary(op), vec![left, right], ty))
    }

    /// A call of a built-in function; `None` if it does not accept the arguments.
    pub(super) fn call(function: BuiltIn, arguments: Vec<Self>) -> Option<Self> {
        let types: Vec<Type> = arguments.iter().map(|argument| argument.ty).collect();
        let ty = function.result(&types)?;
        Some(Self::apply(Op::BuiltIn(function), arguments, ty))
    }

    /// The term with the fitted numbers as literals.
    pub(super) fn with_fitted(&self, numbers: &Numbers) -> Self {
        let mut term = self.clone();
        term.each_mut(&mut |part| {
            if let TermKind::Fitted(at) = part.kind {
                part.kind = TermKind::Float(numbers[usize::from(at)]);
            }
        });
        term
    }

    /// Whether an expression of the shader is a part of the term.
    pub(super) fn keeps(&self, expr: ExprId) -> bool {
        let mut keeps = false;
        self.each(&mut |part| keeps |= part.kind == TermKind::Keep(expr));
        keeps
    }

    /// The term with values in its holes.
    pub(super) fn filled(&self, values: &[Self]) -> Self {
        let mut term = self.clone();
        term.each_mut(&mut |part| {
            if let TermKind::Hole(at) = part.kind {
                *part = values[at].clone();
            }
        });
        term
    }

    fn each_mut(&mut self, visit: &mut dyn FnMut(&mut Self)) {
        visit(self);
        if let TermKind::Apply(_, operands) = &mut self.kind {
            for operand in operands {
                operand.each_mut(visit);
            }
        }
    }

    /// Calls `visit` with the term and all of its parts.
    pub(super) fn each(&self, visit: &mut dyn FnMut(&Self)) {
        visit(self);
        if let TermKind::Apply(_, operands) = &self.kind {
            for operand in operands {
                operand.each(visit);
            }
        }
    }

    // As nodes of the tree.

    /// Adds the term to the tree. `moved` is an expression that this term replaces, and the id under which it
    /// can still be found; `fitted` are the parameters for the fitted numbers.
    pub(super) fn build(&self, tree: &mut Tree, moved: [ExprId; 2], fitted: &[VariableId]) -> ExprId {
        let at = tree[moved[1]].at;
        let kind = match &self.kind {
            TermKind::Keep(expr) => return if *expr == moved[0] { moved[1] } else { *expr },
            TermKind::Float(value) => literal(Value::Float(*value)),
            TermKind::Int(value) => literal(Value::Int(*value)),
            TermKind::Bool(value) => literal(Value::Bool(*value)),
            TermKind::Fitted(at) => ExprKind::Variable(fitted[usize::from(*at)]),
            TermKind::Variable(variable) => ExprKind::Variable(*variable),
            TermKind::Hole(_) => unreachable!("donors are filled"),
            TermKind::Apply(op, operands) => {
                let operands = operands.iter().map(|operand| operand.build(tree, moved, fitted));
                op.kind(operands.collect())
            }
        };
        push(tree, kind, self.ty, at)
    }

    // As text.

    /// The term as text for a context that requires at least this precedence.
    pub(super) fn text(&self, tree: &Tree, source: &str, context: u8) -> String {
        let (text, precedence) = self.unparenthesized(tree, source);
        if precedence < context {
            format!("({text})")
        } else {
            text
        }
    }

    fn unparenthesized(&self, tree: &Tree, source: &str) -> (String, u8) {
        match &self.kind {
            TermKind::Keep(expr) => {
                let text = slice(source, tree[*expr].at.span).to_owned();
                let precedence = precedence(tree, *expr, &text);
                (text, precedence)
            }
            TermKind::Float(value) => number(*value),
            TermKind::Int(value) => (value.to_string(), if *value < 0 { PREFIX } else { PRIMARY }),
            TermKind::Bool(value) => (value.to_string(), PRIMARY),
            TermKind::Fitted(_) | TermKind::Hole(_) => ("?".to_owned(), PRIMARY),
            TermKind::Variable(variable) => (tree[*variable].name.clone(), PRIMARY),
            TermKind::Apply(op, operands) => {
                let operand = |at: usize, context: u8| operands[at].text(tree, source, context);
                let call = |name: &str| {
                    let arguments: Vec<String> = (0..operands.len()).map(|at| operand(at, 1)).collect();
                    format!("{name}({})", arguments.join(", "))
                };
                match op {
                    // `--x` would be a decrement.
                    Op::Unary(op) => (format!("{}{}", op.symbol(), operand(0, PREFIX + 1)), PREFIX),
                    Op::Binary(op) => {
                        let own = op.precedence();
                        (
                            format!("{} {} {}", operand(0, own), op.symbol(), operand(1, own + 1)),
                            own,
                        )
                    }
                    Op::Conditional => {
                        let [condition, yes, no] = [0, 1, 2].map(|at| operand(at, 1));
                        (format!("{condition} ? {yes} : {no}"), CONDITIONAL)
                    }
                    Op::Assign(op) => {
                        let (target, value) = (operand(0, PRIMARY), operand(1, CONDITIONAL));
                        (
                            format!("{target} {}= {value}", op.map_or("", BinaryOp::symbol)),
                            ASSIGNMENT,
                        )
                    }
                    Op::BuiltIn(function) => (call(function.name()), PRIMARY),
                    Op::Call(function) => (call(&tree[*function].name), PRIMARY),
                    Op::Construct(_) => (call(&tree.type_name(self.ty)), PRIMARY),
                    Op::Swizzle(components) => {
                        (format!("{}.{}", operand(0, PRIMARY), components.name()), PRIMARY)
                    }
                    Op::Member(member) => {
                        let name = match operands[0].ty {
                            Type::Struct(id) => tree[id].members[*member].name.as_str(),
                            _ => "",
                        };
                        (format!("{}.{name}", operand(0, PRIMARY)), PRIMARY)
                    }
                    Op::Index => (
                        format!("{}[{}]", operand(0, PRIMARY), operand(1, CONDITIONAL)),
                        PRIMARY,
                    ),
                }
            }
        }
    }
}

/// Adds an expression that is not constant: a parameter may select the values that it depends on.
pub(super) fn push(tree: &mut Tree, kind: ExprKind, ty: Type, at: Place) -> ExprId {
    tree.exprs.push(Expr {
        kind,
        ty,
        constant: false,
        at,
    })
}

fn literal(value: Value) -> ExprKind {
    ExprKind::Literal(Literal {
        text: "".into(),
        value,
    })
}

/// The text of a span; empty if it is out of range.
pub(super) fn slice(source: &str, span: Span) -> &str {
    source.get(span.start as usize..span.end as usize).unwrap_or("")
}

/// A float as a literal of GLSL.
fn number(value: f64) -> (String, u8) {
    let text = format!("{value:?}");
    (text, if value.is_sign_negative() { PREFIX } else { PRIMARY })
}

/// The precedence of an expression as it is written.
fn precedence(tree: &Tree, expr: ExprId, text: &str) -> u8 {
    if is_parenthesized(text) {
        return PRIMARY;
    }
    match &tree[expr].kind {
        ExprKind::Binary { op, .. } => op.precedence(),
        ExprKind::Unary { .. } => PREFIX,
        ExprKind::Step { postfix, .. } => {
            if *postfix {
                PRIMARY
            } else {
                PREFIX
            }
        }
        ExprKind::Conditional { .. } | ExprKind::Assign { .. } | ExprKind::Sequence { .. } => CONDITIONAL,
        _ => PRIMARY,
    }
}

/// Whether one pair of parentheses encloses the text.
pub(super) fn is_parenthesized(text: &str) -> bool {
    let mut depth = 0_i32;
    let last = text.len().saturating_sub(1);
    text.starts_with('(')
        && text.bytes().enumerate().all(|(at, byte)| {
            depth += i32::from(byte == b'(') - i32::from(byte == b')');
            depth > 0 || at == last
        })
}

/// The precedence that an operand of an expression must have to need no parentheses.
pub(super) fn context(tree: &Tree, user: ExprId, operand: ExprId) -> u8 {
    match &tree[user].kind {
        ExprKind::Binary { op, left, .. } => op.precedence() + u8::from(*left != operand),
        ExprKind::Unary { .. } => PREFIX + 1,
        ExprKind::Swizzle { .. } | ExprKind::Member { .. } => PRIMARY,
        ExprKind::Index { base, .. } if *base == operand => PRIMARY,
        ExprKind::Assign { .. } | ExprKind::Index { .. } => CONDITIONAL,
        _ => 1,
    }
}

/// The type of a binary operation; `None` if it is invalid (GLSL ES 3.00.6 §5.9).
pub(super) fn binary_type(op: BinaryOp, left: Type, right: Type) -> Option<Type> {
    match op {
        BinaryOp::Multiply => product(left, right),
        BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Divide => componentwise(left, right),
        BinaryOp::Less | BinaryOp::Greater | BinaryOp::LessEqual | BinaryOp::GreaterEqual => {
            let is_number = matches!(left, Type::Scalar(scalar) if scalar != Scalar::Bool);
            (left == right && is_number).then_some(Type::BOOL)
        }
        BinaryOp::Equal | BinaryOp::NotEqual => (left == right).then_some(Type::BOOL),
        BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => {
            (left == Type::BOOL && right == Type::BOOL).then_some(Type::BOOL)
        }
        _ => (left == right && matches!(left.scalar(), Some(Scalar::Int | Scalar::Uint))).then_some(left),
    }
}

fn product(left: Type, right: Type) -> Option<Type> {
    let float = |size| Type::vector(Scalar::Float, size);
    match (left, right) {
        (Type::Matrix { columns, rows }, Type::Vector(Scalar::Float, size)) => {
            (columns == size).then(|| float(rows))
        }
        (Type::Vector(Scalar::Float, size), Type::Matrix { columns, rows }) => {
            (rows == size).then(|| float(columns))
        }
        (Type::Matrix { columns: inner, rows }, Type::Matrix { columns, rows: other }) => {
            (inner == other).then_some(Type::Matrix { columns, rows })
        }
        _ => componentwise(left, right),
    }
}

fn componentwise(left: Type, right: Type) -> Option<Type> {
    let scalar = left.scalar()?;
    if right.scalar() != Some(scalar) || scalar == Scalar::Bool {
        return None;
    }
    match (left, right) {
        _ if left == right => Some(left),
        (Type::Scalar(_), other) | (other, Type::Scalar(_)) => Some(other),
        _ => None,
    }
}
