//! Operators of matrices that Metal lacks, and values that a C++ compiler would compute in another order.

use std::collections::HashSet;

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Scalar, Type, VariableId, VariableKind};

use crate::c_family::Unprintable;
use crate::c_family::expression::{Part, Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(in super::super) fn binary_in_metal(
        &mut self,
        op: BinaryOp,
        left: ExprId,
        right: ExprId,
    ) -> PrintResult<Parts> {
        let [left_type, right_type] = [left, right].map(|side| self.cx.tree[side].ty);
        if let Some(function) = self.matrix_function(op, left_type, right_type)? {
            let mut parts = Self::call(function, &[left, right]);
            if op == BinaryOp::NotEqual {
                parts.insert(0, Part::token("!"));
                return Ok((parts, level::UNARY));
            }
            return Ok((parts, level::POSTFIX));
        }
        if let Some(wrapped) = self.wrapped(op, left, right)? {
            return Ok(wrapped);
        }
        Ok(match op {
            BinaryOp::Equal | BinaryOp::NotEqual if matches!(left_type, Type::Vector(..)) => {
                let (compared, _) = Self::infix(left, op, right);
                let quantifier = if op == BinaryOp::Equal { "all(" } else { "any(" };
                let mut parts = vec![Part::token(quantifier)];
                parts.extend(compared);
                parts.push(Part::token(")"));
                (parts, level::POSTFIX)
            }
            BinaryOp::Xor => Self::infix(left, BinaryOp::NotEqual, right),
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight => {
                let (mut parts, level) = Self::infix(left, op, right);
                parts.pop();
                parts.extend(self.shift_amount(left_type, right)?);
                (parts, level)
            }
            _ => Self::infix(left, op, right),
        })
    }

    /// The right side of a shift. Vectors shift by vectors of their own type.
    fn shift_amount(&self, shifted: Type, amount: ExprId) -> PrintResult<Vec<Part>> {
        let (Type::Vector(..), true) = (shifted, self.cx.tree[amount].ty.scalar() != shifted.scalar()) else {
            let above = BinaryOp::ShiftLeft.precedence() + level::BINARY + 1;
            return Ok(vec![Part::Print(amount, above)]);
        };
        Ok(Self::call(self.type_name(shifted)?, &[amount]))
    }

    /// The function for an operator of matrices that Metal does not have: all but products, and sums and
    /// differences of two matrices.
    fn matrix_function(&mut self, op: BinaryOp, left: Type, right: Type) -> PrintResult<Option<String>> {
        use BinaryOp as B;
        let is_matrix = |ty| matches!(ty, Type::Matrix { .. });
        let matrix = if is_matrix(left) { left } else { right };
        let Type::Matrix { columns, .. } = matrix else {
            return Ok(None);
        };
        let name = match op {
            B::Divide => "matrixDivide",
            B::Add if left != right => "matrixAdd",
            B::Subtract if left != right => "matrixSubtract",
            B::Equal | B::NotEqual => "matrixEqual",
            _ => return Ok(None),
        };
        let operand = |ty, name: &str, column| {
            if is_matrix(ty) {
                format!("{name}[{column}]")
            } else {
                name.to_owned()
            }
        };
        let columns = (0..columns).map(|column| (operand(left, "x", column), operand(right, "y", column)));
        if matches!(op, B::Equal | B::NotEqual) {
            let equal: Vec<_> = columns.map(|(x, y)| format!("all({x} == {y})")).collect();
            let body = format!("return {};", equal.join(" && "));
            return self
                .helper_function(name, &[left, right], Type::BOOL, "", &body)
                .map(Some);
        }
        let symbol = op.symbol();
        let columns: Vec<_> = columns.map(|(x, y)| format!("{x} {symbol} {y}")).collect();
        let body = format!("return {}({});", self.type_name(matrix)?, columns.join(", "));
        self.helper_function(name, &[left, right], matrix, "", &body)
            .map(Some)
    }

    pub(in super::super) fn assignment_in_metal(
        &mut self,
        op: Option<BinaryOp>,
        target: ExprId,
        value: ExprId,
    ) -> PrintResult<Parts> {
        let tree = &self.cx.tree;
        if tree.path(target).any(|node| match tree[node].kind {
            ExprKind::Index { base, .. } => matches!(tree[base].kind, ExprKind::Swizzle { .. }),
            _ => false,
        }) {
            return Err(Unprintable::Construct("an assignment to an element of a swizzle"));
        }
        // C++ leaves open which side it evaluates first.
        let changes_both = !self.is_pure(target) && !self.is_pure(value);
        if changes_both || self.may_change(target, value) || self.changes_index(value, target) {
            return Err(Unprintable::Construct(
                "an assignment whose sides affect each other",
            ));
        }
        let mut parts = vec![Part::Print(target, level::UNARY)];
        let [target_type, value_type] = [target, value].map(|side| tree[side].ty);
        let has_matrix = [target_type, value_type]
            .iter()
            .any(|ty| matches!(ty, Type::Matrix { .. }));
        let wraps = match op {
            Some(op) => self.wrapped(op, target, value)?.is_some(),
            None => false,
        };
        match op {
            Some(op) if has_matrix || wraps => {
                if !self.is_pure(target) {
                    return Err(Unprintable::Construct(
                        "an assignment to a place with a side effect",
                    ));
                }
                parts.push(Part::token(" = "));
                parts.extend(self.binary_in_metal(op, target, value)?.0);
            }
            Some(op @ (BinaryOp::ShiftLeft | BinaryOp::ShiftRight)) => {
                parts.push(Part::Token(format!(" {}= ", op.symbol())));
                parts.extend(self.shift_amount(target_type, value)?);
            }
            _ => {
                let symbol = op.map_or("", BinaryOp::symbol);
                parts.extend([
                    Part::Token(format!(" {symbol}= ")),
                    Part::Print(value, level::ASSIGN),
                ]);
            }
        }
        Ok((parts, level::ASSIGN))
    }

    /// Whether evaluating `value` may change what an index of a place reads.
    fn changes_index(&self, value: ExprId, place: ExprId) -> bool {
        let tree = &self.cx.tree;
        tree.path(place).any(|node| match tree[node].kind {
            ExprKind::Index { index, .. } => self.may_change(value, index),
            _ => false,
        })
    }

    /// Whether evaluating `first` may change the value of `second`.
    fn may_change(&self, first: ExprId, second: ExprId) -> bool {
        let tree = &self.cx.tree;
        if self.is_pure(first) {
            return false;
        }
        let read = tree
            .postorder(second)
            .into_iter()
            .filter_map(|id| match tree[id].kind {
                ExprKind::Variable(variable) => Some(variable),
                _ => None,
            });
        let read: HashSet<VariableId> = read.collect();
        let reads_global = read.iter().any(|&id| tree[id].kind == VariableKind::Global);
        tree.postorder(first).into_iter().any(|id| {
            let mut writes = matches!(tree[id].kind, ExprKind::Call { .. }) && reads_global;
            tree.each_write(id, |place, _| {
                writes |= tree.root_variable(place).is_some_and(|root| read.contains(&root));
            });
            writes
        })
    }

    /// `v.zyx.xy` as `v.zy`.
    pub(in super::super) fn swizzle_in_metal(&self, mut id: ExprId) -> Parts {
        let tree = &self.cx.tree;
        let mut places: Option<Vec<u8>> = None;
        while let ExprKind::Swizzle { vector, components } = tree[id].kind {
            let own = components.components();
            // The outer swizzle selects among the components of the inner one.
            places = Some(match places {
                None => own.to_vec(),
                Some(outer) => outer.into_iter().map(|place| own[usize::from(place)]).collect(),
            });
            id = vector;
        }
        let places = places.unwrap_or_default();
        let letters: String = places
            .iter()
            .map(|&place| char::from(b"xyzw"[usize::from(place)]))
            .collect();
        (
            vec![
                Part::Print(id, level::POSTFIX),
                Part::Token(format!(".{letters}")),
            ],
            level::POSTFIX,
        )
    }

    /// `x++`; vectors of floats have no such operator.
    pub(in super::super) fn step_in_metal(
        &self,
        id: ExprId,
        symbol: &str,
        postfix: bool,
        target: ExprId,
    ) -> PrintResult<Parts> {
        let ty = self.cx.tree[target].ty;
        match (ty, postfix) {
            (Type::Scalar(_) | Type::Vector(Scalar::Int | Scalar::Uint, _), true) => {
                let parts = vec![Part::Print(target, level::POSTFIX), Part::token(symbol)];
                Ok((parts, level::POSTFIX))
            }
            (Type::Scalar(_) | Type::Vector(Scalar::Int | Scalar::Uint, _), false) => {
                let parts = vec![Part::token(symbol), Part::Print(target, level::UNARY)];
                Ok((parts, level::UNARY))
            }
            (Type::Vector(..), _) if !postfix || self.discarded.contains(&id) => {
                let changed = format!(" {}= 1.0", &symbol[..1]);
                Ok((
                    vec![Part::Print(target, level::UNARY), Part::Token(changed)],
                    level::ASSIGN,
                ))
            }
            _ => Err(Unprintable::Construct("`++` or `--` of a vector or matrix")),
        }
    }

    /// Prints the end of a function whose pixel is discarded; the value that it returns is not used.
    pub(in super::super) fn discard_in_metal(&mut self) -> PrintResult {
        self.line("discard_fragment();");
        let value = match self.returned {
            Type::Void => String::new(),
            ty @ (Type::Struct(_) | Type::Array(_)) => format!(" {}{{}}", self.type_name(ty)?),
            ty => format!(" {}", self.zero(ty)?),
        };
        self.line(&format!("return{value};"));
        Ok(())
    }

    /// `-m`: a product, which Metal has for matrices.
    pub(in super::super) fn negated_in_metal(operand: ExprId) -> Parts {
        let level = BinaryOp::Multiply.precedence() + level::BINARY;
        (vec![Part::Print(operand, level), Part::token(" * -1.0")], level)
    }
}
