//! Prints expressions with the fewest parentheses that preserve their meaning. An explicit stack keeps chains
//! of any length off the call stack.

use std::borrow::Cow;

use toyproof_glsl::tree::{
    BinaryOp, ExprId, ExprKind, Literal, Place, Type, UnaryOp, Value, VariableId, VariableKind,
};

use super::Printer;

/// Precedence levels, from the weakest binding to the strongest.
mod level {
    pub(super) const SEQUENCE: u8 = 0;
    pub(super) const ASSIGN: u8 = 1;
    pub(super) const CONDITIONAL: u8 = 2;
    /// The offset of the levels of binary operators: each adds the operator's own precedence, 1 to 11.
    pub(super) const BINARY: u8 = 2;

    pub(super) const UNARY: u8 = 14;
    pub(super) const POSTFIX: u8 = 15;
}

enum Part<'a> {
    /// An expression, in parentheses if its precedence is below the level.
    Print(ExprId, u8),
    Token(Cow<'a, str>, Place),
}

impl<'a> Printer<'a> {
    /// Prints an expression that stands alone.
    pub(super) fn expression(&mut self, id: ExprId) {
        self.operand(id, level::SEQUENCE);
    }

    /// Prints an expression between commas.
    pub(super) fn argument(&mut self, id: ExprId) {
        self.operand(id, level::ASSIGN);
    }

    fn operand(&mut self, id: ExprId, at_least: u8) {
        let mut pending = vec![Part::Print(id, at_least)];
        while let Some(next) = pending.pop() {
            match next {
                Part::Token(text, at) => self.token(&text, at),
                Part::Print(id, at_least) => {
                    let at = self.cx.tree[id].at;
                    let mut parts = Vec::new();
                    let level = self.parts(id, &mut parts);
                    if level < at_least {
                        self.token("(", at);
                        parts.push(Part::Token(")".into(), at));
                    }
                    pending.extend(parts.into_iter().rev());
                }
            }
        }
    }

    /// Collects the parts of an expression from left to right. Returns its precedence level.
    fn parts(&self, id: ExprId, parts: &mut Vec<Part<'a>>) -> u8 {
        let tree = &self.cx.tree;
        let at = tree[id].at;
        let token = |text: &'a str| Part::Token(text.into(), at);
        match tree[id].kind {
            ExprKind::Unary {
                op: UnaryOp::Plus,
                operand,
            } => {
                parts.push(Part::Print(operand, level::UNARY));
                level::UNARY
            }
            ExprKind::Unary { op, operand } => {
                // `- -x` without the space is another operator.
                parts.extend([token(op.symbol()), Part::Print(operand, level::POSTFIX)]);
                level::UNARY
            }
            ExprKind::Binary { op, left, right } => {
                let level = op.precedence() + level::BINARY;
                let symbol = Part::Token(format!(" {} ", op.symbol()).into(), at);
                parts.extend([Part::Print(left, level), symbol, Part::Print(right, level + 1)]);
                level
            }
            ExprKind::Assign { op, target, value } => {
                let symbol = Part::Token(format!(" {}= ", op.map_or("", BinaryOp::symbol)).into(), at);
                parts.extend([
                    Part::Print(target, level::UNARY),
                    symbol,
                    Part::Print(value, level::ASSIGN),
                ]);
                level::ASSIGN
            }
            ExprKind::Step {
                op,
                postfix: false,
                target,
            } => {
                parts.extend([token(op.symbol()), Part::Print(target, level::UNARY)]);
                level::UNARY
            }
            ExprKind::Conditional { condition, yes, no } => {
                parts.extend([Part::Print(condition, level::CONDITIONAL + 1), token(" ? ")]);
                parts.extend([Part::Print(yes, level::ASSIGN), token(" : ")]);
                parts.push(Part::Print(no, level::CONDITIONAL));
                level::CONDITIONAL
            }
            ExprKind::Sequence { first, second } => {
                parts.extend([
                    Part::Print(first, level::SEQUENCE),
                    token(", "),
                    Part::Print(second, level::ASSIGN),
                ]);
                level::SEQUENCE
            }
            _ => {
                self.postfix_parts(id, parts);
                match parts.as_slice() {
                    [Part::Token(literal, _)] if literal.starts_with('-') => level::UNARY,
                    _ => level::POSTFIX,
                }
            }
        }
    }

    /// Collects the parts of a postfix or primary expression.
    fn postfix_parts(&self, id: ExprId, parts: &mut Vec<Part<'a>>) {
        let tree = &self.cx.tree;
        let at = tree[id].at;
        let token = |text: &'a str| Part::Token(text.into(), at);
        match &tree[id].kind {
            ExprKind::Literal(literal) => parts.push(Part::Token(literal_text(literal), at)),
            ExprKind::Variable(variable) => parts.push(Part::Token(self.variable_text(*variable), at)),
            ExprKind::Call { function, arguments } => {
                call(self.function(*function).into(), arguments, at, parts);
            }
            ExprKind::BuiltIn { function, arguments } => call(function.name().into(), arguments, at, parts),
            ExprKind::Construct { arguments, .. } => {
                call(self.type_name(tree[id].ty).into(), arguments, at, parts);
            }
            &ExprKind::Step { op, target, .. } => {
                parts.extend([Part::Print(target, level::POSTFIX), token(op.symbol())]);
            }
            &ExprKind::Swizzle { vector, components } => {
                parts.extend([
                    Part::Print(vector, level::POSTFIX),
                    Part::Token(format!(".{}", components.name()).into(), at),
                ]);
            }
            &ExprKind::Member { structure, member } => {
                let name = match tree[structure].ty {
                    Type::Struct(id) => self.names.members.get(&(id, member)).map_or("", String::as_str),
                    _ => "",
                };
                parts.extend([Part::Print(structure, level::POSTFIX), token("."), token(name)]);
            }
            &ExprKind::Index { base, index } => {
                let base = Part::Print(base, level::POSTFIX);
                parts.extend([base, token("["), Part::Print(index, level::SEQUENCE), token("]")]);
            }
            ExprKind::Length { array } => {
                let size = match tree[*array].ty {
                    Type::Array(array) => tree.array(array).size,
                    _ => 0,
                };
                parts.push(Part::Token(size.to_string().into(), at));
            }
            // [`Self::parts`] handles the operators.
            _ => {}
        }
    }

    /// The text of a variable that is read; a channel is combined with its sampler.
    fn variable_text(&self, id: VariableId) -> Cow<'a, str> {
        let name = self.variable(id);
        match (self.cx.tree[id].ty, self.cx.tree[id].kind) {
            (Type::Sampler(sampler), VariableKind::Channel(_)) => {
                format!("{}({name}, {name}_sampler)", sampler.name()).into()
            }
            _ => name.into(),
        }
    }
}

/// The text of a literal as written, or of its value where naga would misread it.
fn literal_text(literal: &Literal) -> Cow<'_, str> {
    match literal.value {
        // naga parses 64-bit integers and truncates them to 32.
        Value::Int(value) if literal.text.len() > 11 => value.to_string().into(),
        Value::Uint(value) if literal.text.len() > 12 => format!("{value}u").into(),
        _ => (&*literal.text).into(),
    }
}

/// `name(a, b)`
fn call<'a>(name: Cow<'a, str>, arguments: &[ExprId], at: Place, parts: &mut Vec<Part<'a>>) {
    parts.extend([Part::Token(name, at), Part::Token("(".into(), at)]);
    for (position, &argument) in arguments.iter().enumerate() {
        if position > 0 {
            parts.push(Part::Token(", ".into(), at));
        }
        parts.push(Part::Print(argument, level::ASSIGN));
    }
    parts.push(Part::Token(")".into(), at));
}
