//! Steps that may wait for the end of their statement: `stack[top++] = x` is `stack[top] = x; top++;` where nothing else in it names `top`.

use toyproof_glsl::tree::{
    BinaryOp, Direction, ExprId, ExprKind, StepOp, Type, VariableId, VariableKind, walk,
};

use super::Unprintable;
use super::writer::Writer;

impl Writer<'_> {
    /// Prints a statement by `print`, and after it the steps of its expression that may wait.
    pub(super) fn stepping_later(
        &mut self,
        root: ExprId,
        print: impl FnOnce(&mut Self) -> Result<(), Unprintable>,
    ) -> Result<(), Unprintable> {
        let steps = self.steps_that_wait(root);
        self.waiting.extend(steps.iter().map(|&(id, ..)| id));
        print(self)?;
        for (_, op, target) in steps {
            self.step(op, target)?;
        }
        Ok(())
    }

    /// Steps below an expression that are done in any case.
    fn steps_that_wait(&self, root: ExprId) -> Vec<(ExprId, StepOp, ExprId)> {
        let tree = &self.draft.tree;
        let calls = walk::any(tree, root, |kind| matches!(kind, ExprKind::Call { .. }));
        let mut steps = Vec::new();
        let mut pending = Vec::new();
        let mut id = root;
        loop {
            match tree[id].kind {
                ExprKind::Step {
                    op,
                    postfix: true,
                    target,
                } if id != root => {
                    if let ExprKind::Variable(variable) = tree[target].kind
                        && self.is_alone(variable, calls)
                        && mentions(self, root, variable) == 1
                    {
                        steps.push((id, op, target));
                    }
                }
                ExprKind::Conditional { condition: first, .. }
                | ExprKind::Binary {
                    op: BinaryOp::And | BinaryOp::Or,
                    left: first,
                    ..
                } => pending.push(first),
                ExprKind::Sequence { .. } => {}
                ref kind => kind.for_each_operand(|operand| pending.push(operand)),
            }
            match pending.pop() {
                Some(next) => id = next,
                None => return steps,
            }
        }
    }

    /// Whether nothing but the statement itself may see when a variable is stepped.
    fn is_alone(&self, variable: VariableId, calls: bool) -> bool {
        let variable = &self.draft.tree[variable];
        let is_number = matches!(variable.ty, Type::Scalar(_));
        is_number
            && match variable.kind {
                VariableKind::Local | VariableKind::Parameter(Direction::In) => true,
                VariableKind::Global => !calls,
                _ => false,
            }
    }
}

/// How often a name stands in an expression.
fn mentions(writer: &Writer<'_>, root: ExprId, variable: VariableId) -> usize {
    let tree = &writer.draft.tree;
    let name = writer.variable(variable);
    let named = tree
        .postorder(root)
        .into_iter()
        .filter(|&id| match tree[id].kind {
            ExprKind::Variable(other) => writer.variable(other) == name,
            _ => false,
        });
    named.count()
}
