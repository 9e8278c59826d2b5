//! Expressions: as few parentheses as keep their meaning. A stack of what is left to print keeps chains of any length
//! off the machine's stack.

use std::borrow::Cow;

use toyproof_glsl::tree::{
    BinaryOp, ExprId, ExprKind, Literal, Place, Type, UnaryOp, Value, VariableId, VariableKind,
};

use super::printer::Printer;

/// How tightly an expression holds together; those of binary operators lie between.
mod level {
    pub(super) const SEQUENCE: u8 = 0;
    pub(super) const ASSIGN: u8 = 1;
    pub(super) const CONDITIONAL: u8 = 2;
    /// To be added to the operator's own, 1 to 11.
    pub(super) const BINARY: u8 = 2;
    pub(super) const UNARY: u8 = 14;
    pub(super) const POSTFIX: u8 = 15;
}

enum Todo<'a> {
    /// An expression that must hold together as tightly as that.
    Print(ExprId, u8),
    Word(Cow<'a, str>, Place),
}

impl<'a> Printer<'a> {
    /// An expression that stands alone.
    pub(super) fn expression(&mut self, id: ExprId) {
        self.operand(id, level::SEQUENCE);
    }

    /// An expression between commas.
    pub(super) fn argument(&mut self, id: ExprId) {
        self.operand(id, level::ASSIGN);
    }

    fn operand(&mut self, id: ExprId, at_least: u8) {
        let mut todo = vec![Todo::Print(id, at_least)];
        while let Some(next) = todo.pop() {
            match next {
                Todo::Word(text, at) => self.word(&text, at),
                Todo::Print(id, at_least) => {
                    let at = self.draft.tree[id].at;
                    let mut parts = Vec::new();
                    let level = self.parts(id, &mut parts);
                    if level < at_least {
                        self.word("(", at);
                        parts.push(Todo::Word(")".into(), at));
                    }
                    todo.extend(parts.into_iter().rev());
                }
            }
        }
    }

    /// What an expression is made of, from left to right, and how tightly it holds together.
    fn parts(&self, id: ExprId, parts: &mut Vec<Todo<'a>>) -> u8 {
        let tree = &self.draft.tree;
        let at = tree[id].at;
        let word = |text: &'a str| Todo::Word(text.into(), at);
        match tree[id].kind {
            ExprKind::Unary {
                op: UnaryOp::Plus,
                operand,
            } => {
                parts.push(Todo::Print(operand, level::UNARY));
                level::UNARY
            }
            ExprKind::Unary { op, operand } => {
                // `- -x` without the space is another operator.
                parts.extend([word(op.symbol()), Todo::Print(operand, level::POSTFIX)]);
                level::UNARY
            }
            ExprKind::Binary { op, left, right } => {
                let level = op.precedence() + level::BINARY;
                let symbol = Todo::Word(format!(" {} ", op.symbol()).into(), at);
                parts.extend([Todo::Print(left, level), symbol, Todo::Print(right, level + 1)]);
                level
            }
            ExprKind::Assign { op, target, value } => {
                let symbol = Todo::Word(format!(" {}= ", op.map_or("", BinaryOp::symbol)).into(), at);
                parts.extend([
                    Todo::Print(target, level::UNARY),
                    symbol,
                    Todo::Print(value, level::ASSIGN),
                ]);
                level::ASSIGN
            }
            ExprKind::Step {
                op,
                postfix: false,
                target,
            } => {
                parts.extend([word(op.symbol()), Todo::Print(target, level::UNARY)]);
                level::UNARY
            }
            ExprKind::Conditional { condition, yes, no } => {
                parts.extend([Todo::Print(condition, level::CONDITIONAL + 1), word(" ? ")]);
                parts.extend([Todo::Print(yes, level::ASSIGN), word(" : ")]);
                parts.push(Todo::Print(no, level::CONDITIONAL));
                level::CONDITIONAL
            }
            ExprKind::Sequence { first, second } => {
                parts.extend([
                    Todo::Print(first, level::SEQUENCE),
                    word(", "),
                    Todo::Print(second, level::ASSIGN),
                ]);
                level::SEQUENCE
            }
            _ => {
                self.postfix_parts(id, parts);
                match parts.as_slice() {
                    [Todo::Word(literal, _)] if literal.starts_with('-') => level::UNARY,
                    _ => level::POSTFIX,
                }
            }
        }
    }

    /// The same of an expression that no operator on its left takes apart.
    fn postfix_parts(&self, id: ExprId, parts: &mut Vec<Todo<'a>>) {
        let tree = &self.draft.tree;
        let at = tree[id].at;
        let word = |text: &'a str| Todo::Word(text.into(), at);
        match &tree[id].kind {
            ExprKind::Literal(literal) => parts.push(Todo::Word(spell(literal), at)),
            ExprKind::Variable(variable) => parts.push(Todo::Word(self.lookup(*variable), at)),
            ExprKind::Call { function, arguments } => {
                call(self.function(*function).into(), arguments, at, parts);
            }
            ExprKind::BuiltIn { function, arguments } => call(function.name().into(), arguments, at, parts),
            ExprKind::Construct { arguments, .. } => {
                call(self.type_name(tree[id].ty).into(), arguments, at, parts);
            }
            &ExprKind::Step { op, target, .. } => {
                parts.extend([Todo::Print(target, level::POSTFIX), word(op.symbol())]);
            }
            &ExprKind::Swizzle { vector, components } => {
                parts.extend([
                    Todo::Print(vector, level::POSTFIX),
                    Todo::Word(format!(".{}", components.name()).into(), at),
                ]);
            }
            &ExprKind::Member { structure, member } => {
                let name = match tree[structure].ty {
                    Type::Struct(id) => self.names.members.get(&(id, member)).map_or("", String::as_str),
                    _ => "",
                };
                parts.extend([Todo::Print(structure, level::POSTFIX), word("."), word(name)]);
            }
            &ExprKind::Index { base, index } => {
                let base = Todo::Print(base, level::POSTFIX);
                parts.extend([base, word("["), Todo::Print(index, level::SEQUENCE), word("]")]);
            }
            ExprKind::Length { array } => {
                let size = match tree[*array].ty {
                    Type::Array(array) => tree.array(array).size,
                    _ => 0,
                };
                parts.push(Todo::Word(size.to_string().into(), at));
            }
            // The operators are told apart before.
            _ => {}
        }
    }

    /// A variable where it is read; a channel is a texture with its sampler.
    fn lookup(&self, id: VariableId) -> Cow<'a, str> {
        let name = self.variable(id);
        match (self.draft.tree[id].ty, self.draft.tree[id].kind) {
            (Type::Sampler(sampler), VariableKind::Input(_)) => {
                format!("{}({name}, {name}_sampler)", sampler.name()).into()
            }
            _ => name.into(),
        }
    }
}

/// A literal as written, if naga reads it so; else its value.
fn spell(literal: &Literal) -> Cow<'_, str> {
    match literal.value {
        // naga reads integers of 64 bits and keeps 32.
        Value::Int(value) if literal.text.len() > 11 => value.to_string().into(),
        Value::Uint(value) if literal.text.len() > 12 => format!("{value}u").into(),
        _ => (&*literal.text).into(),
    }
}

/// `name(a, b)`
fn call<'a>(name: Cow<'a, str>, arguments: &[ExprId], at: Place, parts: &mut Vec<Todo<'a>>) {
    parts.extend([Todo::Word(name, at), Todo::Word("(".into(), at)]);
    for (position, &argument) in arguments.iter().enumerate() {
        if position > 0 {
            parts.push(Todo::Word(", ".into(), at));
        }
        parts.push(Todo::Print(argument, level::ASSIGN));
    }
    parts.push(Todo::Word(")".into(), at));
}
