//! Expressions, as lists of components. Chains of thousands of operators are walked without recursion.

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Scalar, StepOp, Type};

use super::lvalue::Location;
use super::lvalue::{component_count, indexed_element, member_offset, scalar_kind};
use super::{Builder, Result};
use crate::ir::{EventKind, NONE, Node, Operation, PartKind, Value};

/// The maximum number of nodes of an operand of `?:`, `&&` or `||` that is computed for all pixels instead of
/// being branched over.
const MAX_SPECULATED_NODES: usize = 12;

impl Builder<'_> {
    /// Returns the components of an expression's value; none for `void`.
    pub(super) fn expression(&mut self, root: ExprId) -> Result<Vec<Value>> {
        self.deeper(|builder| builder.chain(root))
    }

    fn chain(&mut self, root: ExprId) -> Result<Vec<Value>> {
        self.bounded()?;
        let outer = self.origin();
        // The first operands, down to a leaf.
        let mut chain = vec![root];
        while let Some(first) = chain.last().and_then(|&last| self.first_operand(last)) {
            chain.push(first);
        }
        let mut values = match chain.pop() {
            Some(leaf) => {
                let values = self.leaf(leaf)?;
                self.trace_part(leaf, &values);
                values
            }
            None => Vec::new(),
        };
        while let Some(expr) = chain.pop() {
            values = self.continue_with(expr, values)?;
            self.trace_part(expr, &values);
        }
        self.set_origin(outer);
        Ok(values)
    }

    /// Returns the component of a scalar.
    pub(super) fn scalar(&mut self, expr: ExprId) -> Result<Value> {
        let values = self.expression(expr)?;
        Ok(values.first().copied().unwrap_or_else(|| self.word(0)))
    }

    /// Returns the value of a branch condition.
    pub(super) fn condition(&mut self, expr: ExprId) -> Result<Value> {
        let value = self.scalar(expr)?;
        self.trace_event(EventKind::Branch, self.at(expr), Type::BOOL, &[value]);
        Ok(value)
    }

    /// Returns the operand that is evaluated first, if only its value is used.
    fn first_operand(&self, expr: ExprId) -> Option<ExprId> {
        match self.tree[expr].kind {
            ExprKind::Binary { left: first, .. } | ExprKind::Sequence { first, .. } => Some(first),
            ExprKind::Swizzle { vector: base, .. }
            | ExprKind::Member { structure: base, .. }
            | ExprKind::Index { base, .. }
                if !self.is_in_cells(expr) =>
            {
                Some(base)
            }
            _ => None,
        }
    }

    /// Whether it is a variable in cells, or a part of one.
    fn is_in_cells(&self, expr: ExprId) -> bool {
        let root = self.tree.root_variable(expr);
        root.is_some_and(|variable| matches!(self.locations.get(&variable), Some(Location::Cells(_))))
    }

    fn leaf(&mut self, expr: ExprId) -> Result<Vec<Value>> {
        let tree = self.tree;
        self.begin_origin(tree[expr].at, Some(expr));
        Ok(match &tree[expr].kind {
            ExprKind::Literal(literal) => vec![self.literal(literal.value)],
            ExprKind::Variable(variable) => match self.location(*variable) {
                Location::Cells(cells) => {
                    let own: Vec<u32> = (cells.first..cells.first + cells.count).collect();
                    self.check_written(tree[expr].ty, &own, None);
                    self.load_all(cells)
                }
                Location::Values(values) => values,
                Location::Channel(_) => Vec::new(),
            },
            ExprKind::Swizzle { .. } | ExprKind::Member { .. } | ExprKind::Index { .. } => {
                match self.lvalue(expr)? {
                    Some(target) => self.read(&target),
                    None => Vec::new(),
                }
            }
            &ExprKind::Unary { op, operand } => {
                let values = self.expression(operand)?;
                self.unary_operator(op, tree[operand].ty, &values)
            }
            &ExprKind::Assign { op, target, value } => self.assign(op, target, value, expr)?,
            &ExprKind::Step { op, postfix, target } => self.step(op, postfix, target)?,
            &ExprKind::Conditional { condition, yes, no } => {
                let condition = self.condition(condition)?;
                let ty = tree[expr].ty;
                self.choose(
                    condition,
                    ty,
                    |builder| builder.part(PartKind::Yes, builder.at(yes), |builder| builder.expression(yes)),
                    |builder| builder.part(PartKind::No, builder.at(no), |builder| builder.expression(no)),
                )?
            }
            ExprKind::Call { function, arguments } => self.call(*function, arguments, tree[expr].at)?,
            ExprKind::BuiltIn { function, arguments } => self.built_in(*function, arguments, expr)?,
            ExprKind::Construct {
                constructor,
                arguments,
            } => self.construct(*constructor, tree[expr].ty, arguments)?,
            &ExprKind::Length { array } => {
                let (_, count) = indexed_element(tree, tree[array].ty);
                vec![self.word(count)]
            }
            ExprKind::Binary { .. } | ExprKind::Sequence { .. } => Vec::new(),
        })
    }

    /// Returns the value of an expression from that of its first operand.
    fn continue_with(&mut self, expr: ExprId, first: Vec<Value>) -> Result<Vec<Value>> {
        let tree = self.tree;
        match tree[expr].kind {
            ExprKind::Sequence { second, .. } => self.expression(second),
            ExprKind::Binary { op, right, .. } if matches!(op, BinaryOp::And | BinaryOp::Or) => {
                let left = first.first().copied().unwrap_or(NONE);
                let (yes, no) = (self.bool_value(true), self.bool_value(false));
                let evaluate = |builder: &mut Self| {
                    builder.part(PartKind::Right, builder.at(right), |builder| {
                        builder.expression(right)
                    })
                };
                if op == BinaryOp::And {
                    self.choose(left, Type::BOOL, evaluate, |_| Ok(vec![no]))
                } else {
                    self.choose(left, Type::BOOL, |_| Ok(vec![yes]), evaluate)
                }
            }
            ExprKind::Binary { op, left, right } => {
                let second = self.expression(right)?;
                // The operator of a long expression is on the line of its right operand, or above.
                self.begin_origin(tree[right].at, Some(expr));
                let types = (tree[left].ty, tree[right].ty);
                Ok(self.binary_operator(op, types, &first, &second, tree[expr].at))
            }
            ExprKind::Swizzle { components, .. } => {
                let chosen = components.components().iter();
                Ok(chosen.map(|&at| first[usize::from(at)]).collect())
            }
            ExprKind::Member { structure, member } => {
                let Type::Struct(id) = tree[structure].ty else {
                    return Ok(first);
                };
                let start = member_offset(tree, id, member);
                Ok(first[start..start + component_count(tree, tree[expr].ty)].to_vec())
            }
            ExprKind::Index { base, index } => self.pick(&first, tree[base].ty, index),
            _ => Ok(first),
        }
    }

    /// Evaluates one of two expressions; both, if they are small and without side effects.
    fn choose(
        &mut self,
        condition: Value,
        ty: Type,
        yes: impl FnOnce(&mut Self) -> Result<Vec<Value>>,
        no: impl FnOnce(&mut Self) -> Result<Vec<Value>>,
    ) -> Result<Vec<Value>> {
        let (mut yes_values, mut no_values) = (Vec::new(), Vec::new());
        let mut yes_block = self.inner(|builder| {
            yes_values = yes(builder)?;
            Ok(())
        })?;
        let mut no_block = self.inner(|builder| {
            no_values = no(builder)?;
            Ok(())
        })?;
        let scalars = self.tree.scalars(ty);

        let is_speculatable = |block: &[Node]| {
            block.len() <= MAX_SPECULATED_NODES && block.iter().all(|node| matches!(node, Node::Let(_)))
        };
        if is_speculatable(&yes_block) && is_speculatable(&no_block) {
            for node in yes_block.into_iter().chain(no_block) {
                self.push(node);
            }
            let pairs = yes_values.into_iter().zip(no_values).zip(scalars);
            return Ok(pairs
                .map(|((yes, no), scalar)| match scalar {
                    _ if yes == no => yes,
                    Scalar::Bool if self.bool_value(false) == no => {
                        self.binary(Operation::And, condition, yes)
                    }
                    Scalar::Bool if self.bool_value(true) == yes => self.binary(Operation::Or, condition, no),
                    _ => self.select(condition, yes, no, scalar_kind(scalar)),
                })
                .collect());
        }
        let cells = self.allocate_type(ty)?;
        // Stored on every path to here, so that the live ranges of the cells begin where they are used.
        let zeros = self.zeros(ty);
        self.store_all(cells, &zeros);
        for (block, values) in [(&mut yes_block, &yes_values), (&mut no_block, &no_values)] {
            let outer = std::mem::replace(&mut self.writer.borrow_mut().block, std::mem::take(block));
            self.store_all(cells, values);
            *block = std::mem::replace(&mut self.writer.borrow_mut().block, outer);
        }
        self.push(Node::If {
            condition,
            yes: yes_block,
            no: no_block,
        });
        Ok(self.load_all(cells))
    }

    /// Evaluates the indices of the target, then the value, then reads the target, as in WebGL 2.
    fn assign(
        &mut self,
        op: Option<BinaryOp>,
        target: ExprId,
        value: ExprId,
        whole: ExprId,
    ) -> Result<Vec<Value>> {
        let types = (self.ty(target), self.ty(value));
        let Some(place) = self.lvalue(target)? else {
            return self.expression(value);
        };
        let mut values = self.expression(value)?;
        if let Some(op) = op {
            let old = self.read(&place);
            values = self.binary_operator(op, types, &old, &values, self.at(whole));
        }
        let kind = EventKind::Assignment(self.at(target));
        self.trace_event(kind, self.at(whole), types.0, &values);
        self.write(&place, &values);
        self.trace_write(&place, self.at(whole), &values);
        Ok(values)
    }

    fn step(&mut self, op: StepOp, postfix: bool, target: ExprId) -> Result<Vec<Value>> {
        let ty = self.ty(target);
        let Some(place) = self.lvalue(target)? else {
            return self.expression(target);
        };
        let old = self.read(&place);
        let float = ty.scalar() == Some(Scalar::Float);
        let one = if float { self.float(1.0) } else { self.word(1) };
        let operation = match (op, float) {
            (StepOp::Increment, true) => Operation::Add,
            (StepOp::Decrement, true) => Operation::Sub,
            (StepOp::Increment, false) => Operation::AddWord,
            (StepOp::Decrement, false) => Operation::SubWord,
        };
        let new: Vec<Value> = old.iter().map(|&old| self.binary(operation, old, one)).collect();
        let at = self.at(target);
        self.trace_event(EventKind::Assignment(at), at, ty, &new);
        self.write(&place, &new);
        self.trace_write(&place, at, &new);
        Ok(if postfix { old } else { new })
    }

    fn literal(&self, value: toyproof_glsl::tree::Value) -> Value {
        use toyproof_glsl::tree::Value as Literal;
        match value {
            Literal::Bool(value) => self.bool_value(value),
            Literal::Int(value) => self.word(value.cast_unsigned()),
            Literal::Uint(value) => self.word(value),
            Literal::Float(value) => self.float(value),
        }
    }
}
