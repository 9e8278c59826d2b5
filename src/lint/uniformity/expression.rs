//! What of expressions differs between the pixels of a quad, and what they make differ.

use toyproof_glsl::tree::{BinaryOp, Direction, ExprId, ExprKind};

use super::super::program::direction;
use super::control::Control;
use super::differing::{Differing, Traits, Visit};

impl Differing<'_> {
    /// Finds what of an expression differs, and what that makes differ.
    pub(super) fn expression(&mut self, root: ExprId, control: Control, visit: &mut Visit) {
        let tree = self.program.tree;
        for expr in tree.postorder(root) {
            let mut traits = match tree[expr].kind {
                ExprKind::Variable(variable) => self.variables[variable.index()],
                ExprKind::Call { function, .. } => self.results[function.index()],
                _ => Traits::default(),
            };
            if !matches!(tree[expr].kind, ExprKind::Call { .. }) {
                tree[expr]
                    .kind
                    .for_each_operand(|operand| traits = traits.or(self.values[operand.index()]));
            }
            self.values[expr.index()] = traits;
        }
        let mut pending = vec![(root, control)];
        while let Some((expr, control)) = pending.pop() {
            self.effects(expr, control);
            if let Some(cause) = control.own.or(control.callers) {
                visit(expr, cause, &self.values);
            }
            let within = |condition: ExprId, differs: bool| Control {
                own: control.own.or(differs.then_some(condition)),
                ..control
            };
            match tree[expr].kind {
                ExprKind::Binary {
                    op: BinaryOp::And | BinaryOp::Or,
                    left,
                    right,
                } => {
                    pending.push((right, within(left, self.values[left.index()].differs)));
                    pending.push((left, control));
                }
                ExprKind::Conditional { condition, yes, no } => {
                    let inside = within(condition, self.values[condition.index()].differs);
                    pending.extend([(no, inside), (yes, inside), (condition, control)]);
                }
                _ => tree[expr]
                    .kind
                    .for_each_operand(|operand| pending.push((operand, control))),
            }
        }
    }

    fn effects(&mut self, expr: ExprId, control: Control) {
        let tree = self.program.tree;
        let mut written = Vec::new();
        if let ExprKind::Call { function, arguments } = &tree[expr].kind {
            if self.calls[function.index()].is_none()
                && let Some(cause) = control.own.or(control.callers)
            {
                self.calls[function.index()] = Some(cause);
                self.grew = true;
            }
            for (&parameter, &argument) in tree[*function].parameters.iter().zip(arguments) {
                let passed = direction(tree, parameter);
                if passed != Direction::Out {
                    self.mark(parameter, self.values[argument.index()]);
                }
                if passed != Direction::In
                    && passed != Direction::ConstIn
                    && let Some(variable) = tree.root_variable(argument)
                {
                    self.mark(variable, self.variables[parameter.index()]);
                }
            }
        }
        tree.each_write(expr, |target, _| {
            let Some(variable) = tree.root_variable(target) else {
                return;
            };
            let mut value = match tree[expr].kind {
                ExprKind::Assign { value, .. } => self.values[value.index()],
                // What a function writes is followed by its parameters.
                ExprKind::Call { .. } => Traits::default(),
                _ => self.values[expr.index()],
            };
            value.differs |= self.is_indexed_apart(target);
            written.push((variable, value));
        });
        for (variable, value) in written {
            self.write(variable, value, control);
        }
    }

    /// Whether pixels may write different elements.
    fn is_indexed_apart(&self, mut target: ExprId) -> bool {
        loop {
            target = match self.program.tree[target].kind {
                ExprKind::Index { index, .. } if self.values[index.index()].differs => return true,
                ExprKind::Index { base, .. }
                | ExprKind::Swizzle { vector: base, .. }
                | ExprKind::Member { structure: base, .. } => base,
                _ => return false,
            };
        }
    }
}
