//! What expressions do, in the order in which they do it, as events of a [`Flow`](super::flow::Flow).

use toyproof_glsl::tree::{BinaryOp, Constructor, Direction, ExprId, ExprKind, FunctionId, Type};

use super::super::program::direction;
use super::builder::Builder;
use super::flow::{BlockId, End, Event};
use super::part::Part;

/// What is left to do of an expression.
enum Work {
    Evaluate(ExprId),
    /// As the condition of the loop with that head, or a part of it.
    Ask(ExprId, BlockId),
    Happen(Event),
    /// The operand before decided whether what follows is evaluated.
    Branch {
        condition: ExprId,
        yes: BlockId,
        no: BlockId,
        of_loop: Option<BlockId>,
    },
    Goto(BlockId),
    Enter(BlockId),
}

impl Builder<'_> {
    /// Appends what an expression does to the block at hand, and opens others where operators decide what is evaluated.
    pub(super) fn evaluate(&mut self, root: ExprId) {
        self.work(Work::Evaluate(root));
    }

    /// The same for the condition of the loop with that head.
    pub(super) fn ask(&mut self, condition: ExprId, head: BlockId) {
        self.work(Work::Ask(condition, head));
    }

    fn work(&mut self, first: Work) {
        let tree = self.tree;
        let mut work = vec![first];
        while let Some(next) = work.pop() {
            let begin = work.len();
            match next {
                Work::Happen(event) => self.happen(event),
                Work::Branch {
                    condition,
                    yes,
                    no,
                    of_loop,
                } => {
                    self.end(End::Branch {
                        condition,
                        yes,
                        no,
                        of_loop,
                    });
                    self.at = yes;
                }
                Work::Goto(to) => self.end(End::Goto(to)),
                Work::Enter(block) => self.at = block,
                Work::Ask(expr, head) => match tree[expr].kind {
                    ExprKind::Binary {
                        op: op @ (BinaryOp::And | BinaryOp::Or),
                        left,
                        right,
                    } => self.short_circuit(op, left, right, Some(head), &mut work),
                    _ => work.push(Work::Evaluate(expr)),
                },
                // Literals and constants read nothing that could be unwritten.
                Work::Evaluate(expr) if tree[expr].constant => {}
                Work::Evaluate(expr) => self.steps(expr, &mut work),
            }
            // What is done first was pushed first.
            work[begin..].reverse();
        }
    }

    /// What an expression does, in order.
    fn steps(&mut self, expr: ExprId, work: &mut Vec<Work>) {
        let tree = self.tree;
        match &tree[expr].kind {
            ExprKind::Variable(_)
            | ExprKind::Swizzle { .. }
            | ExprKind::Member { .. }
            | ExprKind::Index { .. } => match self.layout.part(expr) {
                Some(part) => {
                    self.indices(expr, work);
                    let part = self.as_read(part, expr);
                    work.push(Work::Happen(Event::Read { part, expr }));
                }
                None => tree[expr]
                    .kind
                    .for_each_operand(|operand| work.push(Work::Evaluate(operand))),
            },
            ExprKind::Binary {
                op: op @ (BinaryOp::And | BinaryOp::Or),
                left,
                right,
            } => self.short_circuit(*op, *left, *right, None, work),
            ExprKind::Conditional { condition, yes, no } => {
                let (if_yes, if_no, join) = (self.open(), self.open(), self.open());
                work.extend([
                    Work::Evaluate(*condition),
                    Work::Branch {
                        condition: *condition,
                        yes: if_yes,
                        no: if_no,
                        of_loop: None,
                    },
                    Work::Evaluate(*yes),
                    Work::Goto(join),
                    Work::Enter(if_no),
                    Work::Evaluate(*no),
                    Work::Goto(join),
                    Work::Enter(join),
                ]);
            }
            ExprKind::Assign { op, target, value } => self.assign(*op, *target, *value, work),
            ExprKind::Step { target, .. } => {
                self.indices(*target, work);
                if let Some(part) = self.layout.part(*target) {
                    let variable = part.variable;
                    work.push(Work::Happen(Event::Read {
                        part: part.clone(),
                        expr: *target,
                    }));
                    work.push(Work::Happen(Event::Write(part)));
                    work.push(Work::Happen(Event::Forget(variable)));
                }
            }
            ExprKind::Call { function, arguments } => self.call(*function, arguments, work),
            ExprKind::BuiltIn { function, arguments } => {
                for (index, &argument) in arguments.iter().enumerate() {
                    match self.layout.part(argument) {
                        Some(part) if function.out_parameter() == Some(index) => {
                            let forget = Event::Forget(part.variable);
                            work.extend([Work::Happen(Event::Write(part)), Work::Happen(forget)]);
                        }
                        _ => work.push(Work::Evaluate(argument)),
                    }
                }
            }
            ExprKind::Length { .. } => {}
            kind => kind.for_each_operand(|operand| work.push(Work::Evaluate(operand))),
        }
    }

    /// `&&` and `||`: the left decides whether the right is evaluated.
    fn short_circuit(
        &mut self,
        op: BinaryOp,
        left: ExprId,
        right: ExprId,
        of_loop: Option<BlockId>,
        work: &mut Vec<Work>,
    ) {
        let (more, join) = (self.open(), self.open());
        let (yes, no) = if op == BinaryOp::And {
            (more, join)
        } else {
            (join, more)
        };
        let operand = |expr: ExprId| match of_loop {
            Some(head) => Work::Ask(expr, head),
            None => Work::Evaluate(expr),
        };
        work.extend([
            operand(left),
            Work::Branch {
                condition: left,
                yes,
                no,
                of_loop,
            },
            Work::Enter(more),
            operand(right),
            Work::Goto(join),
            Work::Enter(join),
        ]);
    }

    fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId, work: &mut Vec<Work>) {
        let tree = self.tree;
        self.indices(target, work);
        match &tree[value].kind {
            // The image's alpha is 1, whatever it is given.
            ExprKind::Construct {
                constructor: Constructor::Vector,
                arguments,
            } if matches!(tree[target].kind, ExprKind::Variable(v) if Some(v) == self.colour)
                && arguments.len() > 1
                && arguments.last().is_some_and(|&alpha| self.is_scalar_part(alpha)) =>
            {
                let colours = &arguments[..arguments.len() - 1];
                work.extend(colours.iter().copied().map(Work::Evaluate));
            }
            _ => work.push(Work::Evaluate(value)),
        }
        if let Some(part) = self.layout.part(target) {
            if op.is_some() {
                work.push(Work::Happen(Event::Read {
                    part: part.clone(),
                    expr: target,
                }));
            }
            let variable = part.variable;
            let known = if op.is_none() {
                Event::Set {
                    variable,
                    target: Some(target),
                    value,
                }
            } else {
                Event::Forget(variable)
            };
            work.extend([Work::Happen(Event::Write(part)), Work::Happen(known)]);
        }
    }

    fn call(&mut self, function: FunctionId, arguments: &[ExprId], work: &mut Vec<Work>) {
        let tree = self.tree;
        let summary = &self.summaries[function.index()];
        let mut after = Vec::new();
        for (index, (&parameter, &argument)) in tree[function].parameters.iter().zip(arguments).enumerate() {
            let whole = self.layout.whole(tree[parameter].ty);
            let reads = summary.reads.get(index).copied().unwrap_or(whole);
            let Some(part) = self.layout.part(argument) else {
                work.push(Work::Evaluate(argument));
                continue;
            };
            self.indices(argument, work);
            let passed = direction(tree, parameter);
            if passed != Direction::Out && reads != 0 && !matches!(tree[parameter].ty, Type::Sampler(_)) {
                // Of a vector, what the function looks at; of a variable as a whole, the same bits as the parameter's.
                let looked = match tree[argument].kind {
                    ExprKind::Variable(_) => part.parts & reads,
                    _ => part.parts,
                };
                let part = self.as_read(
                    Part {
                        parts: looked,
                        ..part.clone()
                    },
                    argument,
                );
                work.push(Work::Happen(Event::Read { part, expr: argument }));
            }
            if matches!(passed, Direction::Out | Direction::InOut) {
                let forget = Event::Forget(part.variable);
                if summary.writes.get(index).is_none_or(|&writes| writes != 0) {
                    after.push(Work::Happen(Event::Write(part)));
                }
                after.push(Work::Happen(forget));
            }
        }
        work.push(Work::Happen(Event::Called(summary.globals.clone())));
        work.append(&mut after);
    }

    /// A structure may well be handed on with members that nobody needs: one of its members is meant, not all.
    fn as_read(&self, mut part: Part, expr: ExprId) -> Part {
        part.one_of |= matches!(self.tree[expr].ty, Type::Struct(_) | Type::Array(_));
        part
    }

    fn is_scalar_part(&self, expr: ExprId) -> bool {
        matches!(self.tree[expr].ty, Type::Scalar(_)) && self.layout.part(expr).is_some()
    }

    /// The indices of an lvalue.
    fn indices(&self, mut expr: ExprId, work: &mut Vec<Work>) {
        loop {
            expr = match self.tree[expr].kind {
                ExprKind::Index { base, index } => {
                    work.push(Work::Evaluate(index));
                    base
                }
                ExprKind::Swizzle { vector: base, .. } | ExprKind::Member { structure: base, .. } => base,
                _ => return,
            };
        }
    }
}
