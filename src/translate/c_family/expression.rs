//! Prints expressions with the fewest parentheses that preserve their meaning. An explicit stack keeps chains
//! of any length off the call stack.

use std::f32::consts;

use toyproof_glsl::tree::{
    BinaryOp, BuiltInVariable, Constructor, ExprId, ExprKind, Literal, Place, Scalar, Type, UnaryOp, Value,
    VariableId, VariableKind, walk,
};

use super::Unprintable;
use super::language::Language;
use super::writer::{PrintResult, Writer};
use crate::author::{float, is_hexadecimal};
use crate::lower::is_pure;

/// Precedence levels, from the weakest binding to the strongest.
pub(super) mod level {
    pub(in super::super) const SEQUENCE: u8 = 0;
    pub(in super::super) const ASSIGN: u8 = 1;
    pub(in super::super) const CONDITIONAL: u8 = 2;
    /// The offset of the levels of binary operators: each adds the operator's own precedence, 1 to 11.
    pub(in super::super) const BINARY: u8 = 2;
    pub(in super::super) const UNARY: u8 = 14;
    pub(in super::super) const POSTFIX: u8 = 15;
}

/// A piece of the code of an expression.
pub(super) enum Part {
    /// An expression, in parentheses if its precedence is below the level.
    Print(ExprId, u8),
    Token(String),
}

impl Part {
    pub(super) fn token(text: impl Into<String>) -> Self {
        Self::Token(text.into())
    }
}

/// The pieces of an expression from left to right, and its precedence level.
pub(super) type Parts = (Vec<Part>, u8);

impl Writer<'_> {
    /// The code of an expression that stands alone.
    pub(super) fn expression(&mut self, id: ExprId) -> PrintResult<String> {
        self.operand(id, level::SEQUENCE)
    }

    /// The code of an expression, in parentheses if its precedence is below the level.
    pub(super) fn operand(&mut self, id: ExprId, at_least: u8) -> PrintResult<String> {
        let mut code = String::new();
        let mut pending = vec![Part::Print(id, at_least)];
        while let Some(next) = pending.pop() {
            match next {
                Part::Token(text) => code += &text,
                Part::Print(id, at_least) => {
                    let (mut parts, level) = self.parts(id).inspect_err(|_| {
                        self.failed_at.get_or_insert(self.cx.tree[id].at);
                    })?;
                    if level < at_least {
                        code += &self.parenthesis(id)?;
                        parts.push(Part::token(")"));
                    }
                    pending.extend(parts.into_iter().rev());
                }
            }
        }
        Ok(code)
    }

    /// What opens the parentheses around an expression. Godot prints the code again, and keeps only those around
    /// operators with two operands: a constructor of the same type stands for others.
    fn parenthesis(&self, id: ExprId) -> PrintResult<String> {
        let expr = &self.cx.tree[id];
        // A negated matrix is a product.
        let is_kept = match expr.kind {
            ExprKind::Binary { .. } | ExprKind::Conditional { .. } => true,
            ExprKind::Unary { .. } => is_matrix(expr.ty),
            _ => false,
        };
        if self.language() != Language::Godot || is_kept {
            return Ok("(".to_owned());
        }
        match expr.ty {
            Type::Scalar(_) | Type::Vector(..) => Ok(format!("{}(", self.type_name(expr.ty)?)),
            _ => Err(Unprintable::Construct("an assignment in an expression")),
        }
    }

    /// Whether the code of an expression begins with a minus.
    fn begins_with_minus(&self, id: ExprId) -> bool {
        let mut id = id;
        loop {
            match &self.cx.tree[id].kind {
                ExprKind::Binary { left, .. } => id = *left,
                ExprKind::Unary { op, .. } => return *op == UnaryOp::Minus,
                ExprKind::Step { op, postfix, .. } => return !postfix && op.symbol() == "--",
                ExprKind::Literal(literal) => return number(literal).starts_with('-'),
                _ => return false,
            }
        }
    }

    #[expect(clippy::too_many_lines, reason = "an arm for each kind of expression")]
    fn parts(&mut self, id: ExprId) -> PrintResult<Parts> {
        use Part::{Print, Token};
        let tree = &self.cx.tree;
        let parts = match &tree[id].kind {
            ExprKind::Literal(literal) => {
                let code = self.literal(literal, tree[id].at);
                let level = if code.starts_with('-') {
                    level::UNARY
                } else {
                    level::POSTFIX
                };
                (vec![Token(code)], level)
            }
            &ExprKind::Variable(variable) => (vec![Token(self.variable_code(variable)?)], level::POSTFIX),
            &ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } if self.language() == Language::Msl && matches!(tree[id].ty, Type::Matrix { .. }) => {
                Self::negated_in_metal(operand)
            }
            &ExprKind::Unary { op, operand } => match op {
                UnaryOp::Plus => (vec![Print(operand, level::UNARY)], level::UNARY),
                UnaryOp::Minus if self.language() == Language::Godot && is_matrix(tree[operand].ty) => {
                    let level = BinaryOp::Multiply.precedence() + level::BINARY;
                    (vec![Part::token("-1.0 * "), Print(operand, level + 1)], level)
                }
                // Godot prints `-(-x)` as `--x`.
                UnaryOp::Minus if self.language() == Language::Godot && self.begins_with_minus(operand) => {
                    let negated = self.type_name(tree[operand].ty)?;
                    let mut parts = vec![Part::token("-")];
                    parts.extend(Self::call(negated, &[operand]));
                    (parts, level::UNARY)
                }
                // `- -x` without the space is another operator.
                _ => (
                    vec![Part::token(op.symbol()), Print(operand, level::POSTFIX)],
                    level::UNARY,
                ),
            },
            &ExprKind::Binary { op, left, right } => self.binary(op, left, right)?,
            &ExprKind::Assign { op, target, value } => self.assignment(op, target, value)?,
            &ExprKind::Step { op, postfix, target } => {
                let symbol = Part::token(op.symbol());
                if self.language() == Language::Msl {
                    self.step_in_metal(id, op.symbol(), postfix, target)?
                } else if postfix {
                    (vec![Print(target, level::POSTFIX), symbol], level::POSTFIX)
                } else {
                    (vec![symbol, Print(target, level::UNARY)], level::UNARY)
                }
            }
            &ExprKind::Conditional { condition, yes, no } => {
                let has_effect = |side| walk::has_side_effects(tree, side);
                if self.language().branches_for_effects() && (has_effect(yes) || has_effect(no)) {
                    return Err(Unprintable::Construct("`?:` or `&&` with a side effect here"));
                }
                let parts = vec![
                    Print(condition, level::CONDITIONAL + 1),
                    Part::token(" ? "),
                    Print(yes, level::ASSIGN),
                    Part::token(" : "),
                    Print(no, level::CONDITIONAL),
                ];
                (parts, level::CONDITIONAL)
            }
            ExprKind::Sequence { .. } if self.language() == Language::Godot => {
                return Err(Unprintable::Construct("`a, b` here"));
            }
            &ExprKind::Sequence { first, second } => {
                let parts = vec![
                    Print(first, level::SEQUENCE),
                    Part::token(", "),
                    Print(second, level::ASSIGN),
                ];
                (parts, level::SEQUENCE)
            }
            ExprKind::Call { function, arguments } => {
                let name = self.function(*function).to_owned();
                (Self::call(name, arguments), level::POSTFIX)
            }
            ExprKind::BuiltIn { function, arguments } => {
                let (function, arguments) = (*function, arguments.clone());
                self.built_in(function, &arguments, tree[id].ty)?
            }
            ExprKind::Construct {
                constructor,
                arguments,
            } => {
                let (constructor, arguments) = (*constructor, arguments.clone());
                self.construct(constructor, &arguments, tree[id].ty)?
            }
            &ExprKind::Swizzle { vector, .. }
                if self.language() == Language::Msl
                    && matches!(tree[vector].kind, ExprKind::Swizzle { .. }) =>
            {
                self.swizzle_in_metal(id)
            }
            &ExprKind::Swizzle { vector, components } => {
                let letters = self.source.letters(components, tree[id].at);
                let parts = vec![Print(vector, level::POSTFIX), Token(format!(".{letters}"))];
                (parts, level::POSTFIX)
            }
            &ExprKind::Member { structure, member } => {
                let Type::Struct(id) = tree[structure].ty else {
                    return Err(Unprintable::Construct("this member"));
                };
                let name = self.member_name(id, member);
                let parts = vec![Print(structure, level::POSTFIX), Token(format!(".{name}"))];
                (parts, level::POSTFIX)
            }
            &ExprKind::Index { base, index } => {
                let parts = vec![
                    Print(base, level::POSTFIX),
                    Part::token("["),
                    Print(index, level::SEQUENCE),
                    Part::token("]"),
                ];
                (parts, level::POSTFIX)
            }
            ExprKind::Length { array } => {
                let Type::Array(array) = tree[*array].ty else {
                    return Err(Unprintable::Construct("this length"));
                };
                let size = tree.array(array).size.to_string();
                (vec![Token(size)], level::POSTFIX)
            }
        };
        Ok(parts)
    }

    /// `name(a, b)`
    pub(super) fn call(name: impl Into<String>, arguments: &[ExprId]) -> Vec<Part> {
        let mut parts = vec![Part::Token(name.into() + "(")];
        parts.extend(Self::list(arguments));
        parts.push(Part::token(")"));
        parts
    }

    /// `a, b`
    pub(super) fn list(arguments: &[ExprId]) -> Vec<Part> {
        let mut parts = Vec::new();
        for (position, &argument) in arguments.iter().enumerate() {
            if position > 0 {
                parts.push(Part::token(", "));
            }
            parts.push(Part::Print(argument, level::ASSIGN));
        }
        parts
    }

    /// `a + b`
    pub(super) fn infix(left: ExprId, op: BinaryOp, right: ExprId) -> Parts {
        let level = op.precedence() + level::BINARY;
        let symbol = Part::Token(format!(" {} ", op.symbol()));
        let parts = vec![Part::Print(left, level), symbol, Part::Print(right, level + 1)];
        (parts, level)
    }

    fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> PrintResult<Parts> {
        if self.language() == Language::Msl {
            return self.binary_in_metal(op, left, right);
        }
        let [left_type, right_type] = [left, right].map(|side| self.cx.tree[side].ty);
        let is_number = |ty| matches!(ty, Type::Scalar(_));
        Ok(match op {
            BinaryOp::Xor if self.language() != Language::Glsl => {
                Self::infix(left, BinaryOp::NotEqual, right)
            }
            BinaryOp::ShiftLeft
            | BinaryOp::ShiftRight
            | BinaryOp::BitAnd
            | BinaryOp::BitXor
            | BinaryOp::BitOr
                if self.language() == Language::Godot =>
            {
                self.bitwise_in_godot(op, left, right)?
            }
            _ if matches!(self.language(), Language::Godot | Language::Glsl) => Self::infix(left, op, right),
            BinaryOp::Multiply if is_product(left_type, right_type) => {
                if !self.is_pure(left) || !self.is_pure(right) {
                    // The arguments would be evaluated in the other order.
                    return Err(Unprintable::Construct("a product of matrices with a side effect"));
                }
                // Matrices are stored with columns as rows.
                (Self::call("mul", &[right, left]), level::POSTFIX)
            }
            BinaryOp::Divide if is_matrix_by_scalar(left_type, right_type) => {
                let function = self.division(left_type)?;
                (Self::call(function, &[left, right]), level::POSTFIX)
            }
            BinaryOp::Equal | BinaryOp::NotEqual if !is_number(left_type) => {
                let (all, _) = Self::infix(left, op, right);
                let quantifier = if op == BinaryOp::Equal { "all(" } else { "any(" };
                let mut parts = vec![Part::token(quantifier)];
                parts.extend(all);
                parts.push(Part::token(")"));
                (parts, level::POSTFIX)
            }
            _ => Self::infix(left, op, right),
        })
    }

    /// `a & ivec3(b)`: the operands of Godot's bitwise operators are of one type, except of shifts of vectors by
    /// a number.
    fn bitwise_in_godot(&self, op: BinaryOp, left: ExprId, right: ExprId) -> PrintResult<Parts> {
        let [left_type, right_type] = [left, right].map(|side| self.cx.tree[side].ty);
        let is_shift = matches!(op, BinaryOp::ShiftLeft | BinaryOp::ShiftRight);
        let is_vector = |ty| matches!(ty, Type::Vector(..));
        let scalar = left_type.scalar().unwrap_or(Scalar::Int);
        let wanted = match (left_type, right_type) {
            (_, Type::Scalar(_)) if is_shift => Type::Scalar(scalar),
            (_, Type::Vector(_, size)) | (Type::Vector(_, size), _) => Type::Vector(scalar, size),
            _ => Type::Scalar(scalar),
        };
        let level = op.precedence() + level::BINARY;
        let side = |side, ty, at_least| {
            let converts = ty != wanted && !(is_shift && is_vector(ty) && side == left);
            Ok(if converts {
                Self::call(self.type_name(wanted)?, &[side])
            } else {
                vec![Part::Print(side, at_least)]
            })
        };
        let mut parts = side(left, left_type, level)?;
        parts.push(Part::Token(format!(" {} ", op.symbol())));
        parts.extend(side(right, right_type, level + 1)?);
        Ok((parts, level))
    }

    pub(super) fn is_pure(&self, id: ExprId) -> bool {
        is_pure(&self.cx.tree, &self.impure, id)
    }

    fn assignment(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId) -> PrintResult<Parts> {
        if self.language() == Language::Msl {
            return self.assignment_in_metal(op, target, value);
        }
        let tree = &self.cx.tree;
        let mut parts = vec![Part::Print(target, level::UNARY)];
        let is_hlsl = self.language() == Language::Hlsl;
        if is_hlsl && op == Some(BinaryOp::Multiply) && is_product(tree[target].ty, tree[value].ty) {
            if !self.is_pure(target) || !self.is_pure(value) {
                return Err(Unprintable::Construct("a product of matrices with a side effect"));
            }
            parts.push(Part::token(" = "));
            parts.extend(Self::call("mul", &[value, target]));
        } else if is_hlsl
            && op == Some(BinaryOp::Divide)
            && is_matrix_by_scalar(tree[target].ty, tree[value].ty)
        {
            if !self.is_pure(target) {
                return Err(Unprintable::Construct(
                    "a matrix with a side effect that is divided",
                ));
            }
            let function = self.division(tree[target].ty)?;
            parts.push(Part::token(" = "));
            parts.extend(Self::call(function, &[target, value]));
        } else {
            let symbol = op.map_or("", BinaryOp::symbol);
            parts.push(Part::Token(format!(" {symbol}= ")));
            let is_shift = matches!(op, Some(BinaryOp::ShiftLeft | BinaryOp::ShiftRight));
            let [own, by] = [target, value].map(|side| self.cx.tree[side].ty);
            match by.with_scalar(own.scalar().unwrap_or(Scalar::Int)) {
                // The operands of a shift have the same sign in Godot.
                Some(ty) if self.language() == Language::Godot && is_shift && ty != by => {
                    parts.extend(Self::call(self.type_name(ty)?, &[value]));
                }
                _ => parts.push(Part::Print(value, level::ASSIGN)),
            }
        }
        Ok((parts, level::ASSIGN))
    }

    fn variable_code(&mut self, id: VariableId) -> PrintResult<String> {
        let variable = &self.cx.tree[id];
        match variable.kind {
            VariableKind::BuiltIn(BuiltInVariable::FragCoord) => self.reads_position = true,
            VariableKind::Channel(_) if self.language() != Language::Glsl => {
                return Err(Unprintable::Construct("a sampler here"));
            }
            _ => {}
        }
        Ok(self.variable(id).to_owned())
    }

    /// The value of a declaration: lists in braces for arrays, and for structures in HLSL.
    pub(super) fn initializer(&mut self, id: ExprId) -> PrintResult<String> {
        match &self.cx.tree[id].kind {
            ExprKind::Construct {
                constructor: Constructor::Struct | Constructor::Array,
                arguments,
            } if self.lists_values(self.cx.tree[id].ty) => {
                let arguments = arguments.clone();
                let values = arguments.into_iter().map(|argument| {
                    // Inner lists state their types.
                    if self.language().has_array_values() {
                        self.operand(argument, level::ASSIGN)
                    } else {
                        self.initializer(argument)
                    }
                });
                let values = values.collect::<PrintResult<Vec<_>>>()?;
                Ok(format!("{{ {} }}", values.join(", ")))
            }
            _ => self.operand(id, level::ASSIGN),
        }
    }

    /// Whether the value of a declaration is a list in braces.
    fn lists_values(&self, ty: Type) -> bool {
        match self.language() {
            Language::Hlsl | Language::Msl => true,
            Language::Godot => matches!(ty, Type::Array(_)),
            Language::Glsl => false,
        }
    }

    /// The value of a declaration whose every component is zero.
    pub(super) fn zero(&self, ty: Type) -> PrintResult<String> {
        if matches!(self.language(), Language::Godot | Language::Glsl) {
            return self.zero_of_glsl(ty);
        }
        Ok(match ty {
            Type::Array(_) | Type::Struct(_) if self.language() == Language::Msl => "{}".to_owned(),
            Type::Vector(..) | Type::Matrix { .. } if self.language() == Language::Msl => {
                format!(
                    "{}({})",
                    self.type_name(ty)?,
                    number(&Literal::from(zero_of(ty.scalar())))
                )
            }
            Type::Array(id) => {
                let array = self.cx.tree.array(id);
                let zeros = vec![self.zero(array.element)?; array.size as usize];
                format!("{{ {} }}", zeros.join(", "))
            }
            Type::Struct(id) => format!("({})0", self.structure_name(id)),
            Type::Scalar(scalar) => number(&Literal::from(zero_of(Some(scalar)))),
            // glslang may make infinities of the integer.
            Type::Matrix { .. } => format!("({})0.0", self.type_name(ty)?),
            _ => format!("({})0", self.type_name(ty)?),
        })
    }

    fn zero_of_glsl(&self, ty: Type) -> PrintResult<String> {
        let list = |zeros: Vec<String>| zeros.join(", ");
        Ok(match ty {
            Type::Array(id) => {
                let array = self.cx.tree.array(id);
                let zeros = vec![self.zero(array.element)?; array.size as usize];
                match self.language() {
                    Language::Glsl => format!("{}({})", self.type_name(ty)?, list(zeros)),
                    _ => format!("{{ {} }}", list(zeros)),
                }
            }
            Type::Struct(id) => {
                let is_array = |ty| matches!(ty, Type::Array(_));
                let has_array = self.cx.tree[id].members.iter().any(|member| is_array(member.ty));
                if has_array && self.language() == Language::Godot {
                    return Err(Unprintable::Construct("an array in a structure without a value"));
                }
                let members = self.cx.tree[id].members.iter().map(|member| self.zero(member.ty));
                let zeros = members.collect::<PrintResult<Vec<_>>>()?;
                format!("{}({})", self.structure_name(id), list(zeros))
            }
            Type::Scalar(scalar) => number(&Literal::from(zero_of(Some(scalar)))),
            _ => {
                let zero = number(&Literal::from(zero_of(ty.scalar())));
                format!("{}({zero})", self.type_name(ty)?)
            }
        })
    }

    /// Prints a literal, or the constant of the macro that it comes from.
    fn literal(&mut self, literal: &Literal, at: Place) -> String {
        let is_infinite = matches!(literal.value, Value::Float(value) if (value as f32).is_infinite());
        let code = match self.language() {
            Language::Msl if is_infinite => "INFINITY".to_owned(),
            Language::Godot => number_in_godot(literal),
            _ => number(literal),
        };
        let Some(name) = self.source.macro_name(at) else {
            return code;
        };
        if self.language() == Language::Godot && is_constant_of_godot(name, literal) {
            return name.to_owned();
        }
        if !self.is_free(name) {
            return code;
        }
        let ty = match literal.value {
            Value::Float(_) => "float",
            Value::Int(_) => "int",
            Value::Uint(_) => "uint",
            Value::Bool(_) => "bool",
        };
        let word = self.language().constant();
        let declaration = format!("{word} {ty} {name} = {code};");
        if self.macros.declare(name, declaration, at) {
            name.to_owned()
        } else {
            code
        }
    }
}

fn zero_of(scalar: Option<Scalar>) -> Value {
    match scalar {
        Some(Scalar::Bool) => Value::Bool(false),
        Some(Scalar::Int) => Value::Int(0),
        Some(Scalar::Uint) => Value::Uint(0),
        _ => Value::Float(0.0),
    }
}

/// Whether `/` divides a matrix by a number.
fn is_matrix_by_scalar(left: Type, right: Type) -> bool {
    matches!((left, right), (Type::Matrix { .. }, Type::Scalar(_)))
}

fn is_matrix(ty: Type) -> bool {
    matches!(ty, Type::Matrix { .. })
}

/// Whether `*` is a product of linear algebra (§5.9).
fn is_product(left: Type, right: Type) -> bool {
    let is_operand = |ty| matches!(ty, Type::Matrix { .. } | Type::Vector(..));
    (is_matrix(left) || is_matrix(right)) && is_operand(left) && is_operand(right)
}

/// Whether a name is that of Godot's own constant with a value.
fn is_constant_of_godot(name: &str, literal: &Literal) -> bool {
    let constant = match name {
        "PI" => consts::PI,
        "TAU" => consts::TAU,
        "E" => consts::E,
        _ => return false,
    };
    matches!(literal.value, Value::Float(value) if value as f32 == constant)
}

/// Godot prints the literals of its code with 14 decimals: smaller numbers are made of their bits.
fn number_in_godot(literal: &Literal) -> String {
    match literal.value {
        Value::Float(value) => {
            let single = value as f32;
            let printed: f32 = format!("{single:.14}").parse().unwrap_or(single);
            if single.is_finite() && printed.to_bits() != single.to_bits() {
                format!("uintBitsToFloat({:#010x}u)", single.to_bits())
            } else {
                number(literal)
            }
        }
        _ => number(literal),
    }
}

fn number(literal: &Literal) -> String {
    match literal.value {
        Value::Bool(value) => value.to_string(),
        Value::Float(value) => float(&literal.text, value),
        // Without the cast, a minus would apply to a number that is out of range.
        Value::Int(i32::MIN) => "int(0x80000000)".to_owned(),
        Value::Int(value) if value >= 0 && is_hexadecimal(&literal.text) => literal.text.to_string(),
        Value::Int(value) => value.to_string(),
        Value::Uint(_) if is_hexadecimal(&literal.text) => {
            format!("{}u", literal.text.trim_end_matches(['u', 'U']))
        }
        Value::Uint(value) => format!("{value}u"),
    }
}
