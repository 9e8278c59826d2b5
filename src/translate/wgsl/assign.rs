//! What expressions do: assignments, steps, calls. WGSL assigns to no swizzle of several components.

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Scalar, StepOp, Swizzle, Type, VariableKind, walk};

use super::Unprintable;
use super::facts::is_out;
use super::text::{Class, Printed, Text};
use super::writer::Writer;

impl Writer<'_> {
    /// Prints what an expression does; its value is not wanted.
    pub(super) fn effect(&mut self, id: ExprId) -> Result<(), Unprintable> {
        let tree = &self.draft.tree;
        match &tree[id].kind {
            &ExprKind::Assign { op, target, value } => self.assign(op, target, value),
            &ExprKind::Step { op, target, .. } => self.step(op, target),
            &ExprKind::Sequence { first, second } => {
                self.effect(first)?;
                self.effect(second)
            }
            &ExprKind::Conditional { condition, yes, no } => {
                let condition = self.value(condition)?;
                self.line(&format!("if {} {{", condition.words));
                self.inset(|writer| writer.effect(yes))?;
                self.line("} else {");
                self.inset(|writer| writer.effect(no))?;
                self.line("}");
                Ok(())
            }
            ExprKind::Call { .. } => {
                let call = self.value(id)?;
                // A call that copied its arguments back was printed already.
                if call.words.ends_with(')') {
                    self.line(&format!("{};", call.words));
                }
                Ok(())
            }
            ExprKind::Binary {
                op: BinaryOp::And | BinaryOp::Or,
                ..
            } if self.hoists(id) => {
                self.value(id)?;
                Ok(())
            }
            kind => {
                let mut operands = Vec::new();
                kind.for_each_operand(|operand| operands.push(operand));
                operands.into_iter().try_for_each(|operand| self.effect(operand))
            }
        }
    }

    fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId) -> Result<(), Unprintable> {
        let tree = &self.draft.tree;
        let types = (tree[target].ty, tree[value].ty);
        if self.branching(value).is_some() && !walk::acts(tree, target) {
            return self.choose(value, &mut |writer, value| writer.assign(op, target, value));
        }
        let is_swizzle =
            matches!(tree[target].kind, ExprKind::Swizzle { components, .. } if components.size() > 1);
        let Some(op) = op else {
            let value = self.value(value)?;
            return self.set(target, &value);
        };
        let is_matrix = matches!(types.0, Type::Matrix { .. }) || matches!(types.1, Type::Matrix { .. });
        let shifts = matches!(op, BinaryOp::ShiftLeft | BinaryOp::ShiftRight);
        let of_bits = matches!(op, BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor);
        // WGSL shifts by unsigned numbers, and takes no bits of a vector and a number.
        let needs_types = shifts || (of_bits && types.0 != types.1);
        if is_swizzle || is_matrix || needs_types {
            // GLSL leaves open when the target is read; WebGL's translators read it last.
            let value = self.added(target, value)?;
            let before = self.value(target)?;
            let after = self.operation(op, (before, types.0), (value, types.1))?;
            return self.set(target, &after);
        }
        let value = self.added(target, value)?;
        let target = self.value(target)?.words;
        self.line(&format!("{target} {}= {};", op.symbol(), value.words));
        Ok(())
    }

    /// The right side of a compound assignment, set aside if a call in it may change the target: WGSL reads that first.
    fn added(&mut self, target: ExprId, value: ExprId) -> Printed {
        let text = self.value(value)?;
        if text.words.contains('(') && self.may_change(target, value) {
            return Ok(self.keep_as("value", &text));
        }
        Ok(text)
    }

    fn may_change(&self, target: ExprId, value: ExprId) -> bool {
        let tree = &self.draft.tree;
        let Some(root) = tree.root_variable(target) else {
            return true;
        };
        let is_global = tree[root].kind == VariableKind::Global;
        walk::any(tree, value, |kind| match kind {
            ExprKind::Call { function, arguments } => {
                let mut given = arguments.iter().zip(&tree[*function].parameters);
                is_global
                    || given.any(|(&argument, &parameter)| {
                        is_out(self.draft, parameter) && tree.root_variable(argument) == Some(root)
                    })
            }
            _ => false,
        })
    }

    /// Prints an assignment of words.
    pub(super) fn set(&mut self, target: ExprId, value: &Text) -> Result<(), Unprintable> {
        match self.draft.tree[target].kind {
            ExprKind::Swizzle { vector, components } if components.size() > 1 => {
                let letters = self.comments.letters(components, self.draft.tree[target].at);
                self.set_components(vector, components, &letters, value)
            }
            _ => {
                let target = self.value(target)?.words;
                self.line(&format!("{target} = {};", value.words));
                Ok(())
            }
        }
    }

    /// `v.xz = value` as `v = vec3f(value.x, v.y, value.y)`.
    fn set_components(
        &mut self,
        vector: ExprId,
        components: Swizzle,
        letters: &str,
        value: &Text,
    ) -> Result<(), Unprintable> {
        let Type::Vector(_, size) = self.draft.tree[vector].ty else {
            return Err(Unprintable("a swizzle of what is no vector"));
        };
        let chosen = components.components();
        let ascending = chosen.windows(2).all(|pair| pair[1] == pair[0] + 1);
        let base = self.value(vector)?;
        let target = base.words.clone();
        let base = base.operand();
        if ascending && chosen.len() == usize::from(size) {
            self.line(&format!("{target} = {};", value.words));
            return Ok(());
        }
        let all = if letters.contains(['r', 'g', 'b', 'a']) {
            "rgba"
        } else {
            "xyzw"
        };
        let letter = |index: usize| all.get(index..=index).unwrap_or("x");
        let mut parts = Vec::new();
        // A call may change the vector that the rest is read from.
        let root = self.draft.tree.root_variable(vector);
        let may_change = value.words.contains('(')
            && root.is_some_and(|id| self.draft.tree[id].kind == VariableKind::Global);
        let whole = if ascending && !may_change {
            value.clone()
        } else {
            self.keep_as(letters, value)
        };
        let mut at = 0;
        while at < usize::from(size) {
            match chosen.iter().position(|&component| usize::from(component) == at) {
                Some(_) if ascending => {
                    parts.push(whole.words.clone());
                    at += chosen.len();
                    continue;
                }
                Some(place) => parts.push(format!("{}.{}", whole.words, letter(place))),
                None => parts.push(format!("{base}.{}", letter(at))),
            }
            at += 1;
        }
        let ty = self.type_name(self.draft.tree[vector].ty);
        self.line(&format!("{target} = {ty}({});", parts.join(", ")));
        Ok(())
    }

    /// `x++` or `x -= 1.0`.
    pub(super) fn step(&mut self, op: StepOp, target: ExprId) -> Result<(), Unprintable> {
        let target_text = self.value(target)?;
        let sign = if op == StepOp::Increment { '+' } else { '-' };
        let ty = self.draft.tree[target].ty;
        let target_text = target_text.words;
        match ty {
            Type::Scalar(Scalar::Int | Scalar::Uint) => self.line(&format!("{target_text}{sign}{sign};")),
            Type::Scalar(_) => self.line(&format!("{target_text} {sign}= 1.0;")),
            _ => {
                let one = match ty.scalar() {
                    Some(Scalar::Float) => "1.0",
                    Some(Scalar::Uint) => "1u",
                    _ => "1",
                };
                if matches!(ty, Type::Matrix { .. }) {
                    return Err(Unprintable("a matrix that is counted up"));
                }
                if matches!(self.draft.tree[target].kind, ExprKind::Swizzle { .. }) {
                    let after = Text {
                        words: format!("{target_text} {sign} {one}"),
                        class: Class::Sum,
                    };
                    return self.set(target, &after);
                }
                self.line(&format!("{target_text} {sign}= {one};"));
            }
        }
        Ok(())
    }
}
