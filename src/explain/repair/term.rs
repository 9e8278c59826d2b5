//! Terms: the expressions that an edit writes, as nodes of the typed tree and as text. A term consists of new
//! operations and of parts of the shader that it keeps.

use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, Expr, ExprId, ExprKind, FunctionId, Literal, Place, Scalar, Swizzle,
    Tree, Type, UnaryOp, Value, VariableId,
};

/// The fitted numbers of an edit; most edits have at most one.
pub(super) type Numbers = [f64; 3];

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
    Unary(UnaryOp, Box<Term>),
    Binary(BinaryOp, Box<Term>, Box<Term>),
    Conditional(Box<[Term; 3]>),
    Assign(Option<BinaryOp>, Box<Term>, Box<Term>),
    BuiltIn(BuiltIn, Vec<Term>),
    Call(FunctionId, Vec<Term>),
    Construct(Constructor, Vec<Term>),
    Swizzle(Box<Term>, Swizzle),
    Member(Box<Term>, usize),
    Index(Box<Term>, Box<Term>),
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
        Self::new(TermKind::Unary(op, Box::new(operand)), ty)
    }

    /// A binary operation; `None` if the types do not fit.
    pub(super) fn binary(op: BinaryOp, left: Self, right: Self) -> Option<Self> {
        let ty = binary_type(op, left.ty, right.ty)?;
        Some(Self::new(
            TermKind::Binary(op, Box::new(left), Box::new(right)),
            ty,
        ))
    }

    /// A call of a built-in function; `None` if it does not accept the arguments.
    pub(super) fn call(function: BuiltIn, arguments: Vec<Self>) -> Option<Self> {
        let types: Vec<Type> = arguments.iter().map(|argument| argument.ty).collect();
        let ty = function.result(&types)?;
        Some(Self::new(TermKind::BuiltIn(function, arguments), ty))
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
        match &mut self.kind {
            TermKind::Unary(_, only) | TermKind::Swizzle(only, _) | TermKind::Member(only, _) => {
                only.each_mut(visit);
            }
            TermKind::Binary(_, one, other)
            | TermKind::Assign(_, one, other)
            | TermKind::Index(one, other) => {
                one.each_mut(visit);
                other.each_mut(visit);
            }
            TermKind::Conditional(parts) => {
                for part in parts.iter_mut() {
                    part.each_mut(visit);
                }
            }
            TermKind::BuiltIn(_, arguments)
            | TermKind::Call(_, arguments)
            | TermKind::Construct(_, arguments) => {
                for part in arguments {
                    part.each_mut(visit);
                }
            }
            _ => {}
        }
    }

    /// Calls `visit` with the term and all of its parts.
    pub(super) fn each(&self, visit: &mut dyn FnMut(&Self)) {
        self.clone().each_mut(&mut |part| visit(part));
    }

    // As nodes of the tree.

    /// Adds the term to the tree. `moved` is an expression that this term replaces, and the id under which it
    /// can still be found; `fitted` are the parameters for the fitted numbers.
    pub(super) fn build(&self, tree: &mut Tree, moved: [ExprId; 2], fitted: &[VariableId]) -> ExprId {
        let at = tree[moved[1]].at;
        let all = |tree: &mut Tree, terms: &[Self]| -> Vec<ExprId> {
            terms.iter().map(|term| term.build(tree, moved, fitted)).collect()
        };
        let kind = match &self.kind {
            TermKind::Keep(expr) => return if *expr == moved[0] { moved[1] } else { *expr },
            TermKind::Float(value) => literal(Value::Float(*value)),
            TermKind::Int(value) => literal(Value::Int(*value)),
            TermKind::Bool(value) => literal(Value::Bool(*value)),
            TermKind::Fitted(at) => ExprKind::Variable(fitted[usize::from(*at)]),
            TermKind::Variable(variable) => ExprKind::Variable(*variable),
            TermKind::Hole(_) => unreachable!("donors are filled"),
            TermKind::Unary(op, operand) => ExprKind::Unary {
                op: *op,
                operand: operand.build(tree, moved, fitted),
            },
            TermKind::Binary(op, left, right) => ExprKind::Binary {
                op: *op,
                left: left.build(tree, moved, fitted),
                right: right.build(tree, moved, fitted),
            },
            TermKind::Conditional(parts) => {
                let [condition, yes, no] = parts.each_ref().map(|part| part.build(tree, moved, fitted));
                ExprKind::Conditional { condition, yes, no }
            }
            TermKind::Assign(op, target, value) => ExprKind::Assign {
                op: *op,
                target: target.build(tree, moved, fitted),
                value: value.build(tree, moved, fitted),
            },
            TermKind::BuiltIn(function, arguments) => ExprKind::BuiltIn {
                function: *function,
                arguments: all(tree, arguments),
            },
            TermKind::Call(function, arguments) => ExprKind::Call {
                function: *function,
                arguments: all(tree, arguments),
            },
            TermKind::Construct(constructor, arguments) => ExprKind::Construct {
                constructor: *constructor,
                arguments: all(tree, arguments),
            },
            TermKind::Swizzle(vector, components) => ExprKind::Swizzle {
                vector: vector.build(tree, moved, fitted),
                components: *components,
            },
            TermKind::Member(structure, member) => ExprKind::Member {
                structure: structure.build(tree, moved, fitted),
                member: *member,
            },
            TermKind::Index(base, index) => ExprKind::Index {
                base: base.build(tree, moved, fitted),
                index: index.build(tree, moved, fitted),
            },
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
        let list = |terms: &[Self]| {
            let texts: Vec<String> = terms.iter().map(|term| term.text(tree, source, 1)).collect();
            texts.join(", ")
        };
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
            TermKind::Unary(op, operand) => {
                // `--x` would be a decrement.
                let operand = operand.text(tree, source, PREFIX + 1);
                (format!("{}{operand}", op.symbol()), PREFIX)
            }
            TermKind::Binary(op, left, right) => {
                let own = op.precedence();
                let left = left.text(tree, source, own);
                let right = right.text(tree, source, own + 1);
                (format!("{left} {} {right}", op.symbol()), own)
            }
            TermKind::Conditional(parts) => {
                let [condition, yes, no] = parts.each_ref().map(|part| part.text(tree, source, 1));
                (format!("{condition} ? {yes} : {no}"), CONDITIONAL)
            }
            TermKind::Assign(op, target, value) => {
                let target = target.text(tree, source, PRIMARY);
                let op = op.map_or("", BinaryOp::symbol);
                let value = value.text(tree, source, CONDITIONAL);
                (format!("{target} {op}= {value}"), ASSIGNMENT)
            }
            TermKind::BuiltIn(function, arguments) => {
                (format!("{}({})", function.name(), list(arguments)), PRIMARY)
            }
            TermKind::Call(function, arguments) => {
                (format!("{}({})", tree[*function].name, list(arguments)), PRIMARY)
            }
            TermKind::Construct(_, arguments) => (
                format!("{}({})", tree.type_name(self.ty), list(arguments)),
                PRIMARY,
            ),
            TermKind::Swizzle(vector, components) => {
                let vector = vector.text(tree, source, PRIMARY);
                (format!("{vector}.{}", components.name()), PRIMARY)
            }
            TermKind::Member(structure, member) => {
                let name = match structure.ty {
                    Type::Struct(id) => tree[id].members[*member].name.clone(),
                    _ => String::new(),
                };
                (
                    format!("{}.{name}", structure.text(tree, source, PRIMARY)),
                    PRIMARY,
                )
            }
            TermKind::Index(base, index) => {
                let base = base.text(tree, source, PRIMARY);
                (
                    format!("{base}[{}]", index.text(tree, source, CONDITIONAL)),
                    PRIMARY,
                )
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
