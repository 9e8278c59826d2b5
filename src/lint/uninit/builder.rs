//! Builds the control-flow graph ([`Cfg`]) of a function from its statements.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    BinaryOp, Block, Case, Condition, Constructor, Direction, ExprId, ExprKind, FunctionId, Label, Statement,
    StatementKind, Tree, Type, VariableId,
};

use super::cfg::{BasicBlock, BlockId, Cfg, Event, Summary, Terminator};
use super::part::{Layout, Part};
use crate::program::direction;

/// Builds the control-flow graph of one function.
pub(super) struct Builder<'a> {
    pub(super) tree: &'a Tree,
    pub(super) layout: &'a Layout<'a>,
    pub(super) summaries: &'a [Summary],
    /// The output color of `mainImage`.
    pub(super) color: Option<VariableId>,
    blocks: Vec<BasicBlock>,
    returned_beside: HashSet<ExprId>,
    pub(super) at: BlockId,
    /// Targets of `break` and `continue`, innermost last; a `switch` has no `continue` target.
    exits: Vec<(BlockId, Option<BlockId>)>,
}

impl<'a> Builder<'a> {
    pub(super) fn build(
        tree: &'a Tree,
        layout: &'a Layout<'a>,
        summaries: &'a [Summary],
        color: Option<VariableId>,
        function: FunctionId,
    ) -> Cfg {
        let mut builder = Self {
            tree,
            layout,
            summaries,
            color,
            blocks: Vec::new(),
            returned_beside: HashSet::new(),
            at: 0,
            exits: Vec::new(),
        };
        builder.at = builder.open();
        for &parameter in &tree[function].parameters {
            if direction(tree, parameter) == Direction::Out {
                builder.emit(Event::Begin(parameter));
            }
        }
        if let Some(body) = &tree[function].body {
            builder.block(body);
        }
        builder.end(Terminator::FallOff);
        Cfg {
            blocks: builder.blocks,
            returned_beside: builder.returned_beside,
        }
    }

    pub(super) fn open(&mut self) -> BlockId {
        self.blocks.push(BasicBlock {
            events: Vec::new(),
            end: Terminator::Open,
        });
        self.blocks.len() - 1
    }

    pub(super) fn emit(&mut self, event: Event) {
        self.blocks[self.at].events.push(event);
    }

    /// Sets the terminator of the current block.
    pub(super) fn end(&mut self, end: Terminator) {
        self.blocks[self.at].end = end;
    }

    fn jump(&mut self, end: Terminator) {
        self.end(end);
        self.at = self.open();
    }

    fn go(&mut self, to: BlockId) {
        self.end(Terminator::Goto(to));
        self.at = to;
    }

    fn block(&mut self, block: &Block) {
        for statement in block {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::Expression(expr) => self.evaluate(*expr),
            StatementKind::Declare(variable) => self.declare(*variable),
            StatementKind::Struct(_) => {}
            StatementKind::Block(body) => self.block(body),
            StatementKind::If { arms, otherwise } => {
                let join = self.open();
                for arm in arms {
                    self.evaluate(arm.condition);
                    let (yes, no) = (self.open(), self.open());
                    self.end(Terminator::Branch {
                        condition: arm.condition,
                        yes,
                        no,
                        exited_loop: None,
                    });
                    self.at = yes;
                    self.block(&arm.body);
                    self.end(Terminator::Goto(join));
                    self.at = no;
                }
                if let Some(body) = otherwise {
                    self.block(body);
                }
                self.go(join);
            }
            StatementKind::Switch { selector, cases } => self.switch(*selector, cases),
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.block(init);
                self.build_loop(*condition, body, *step);
            }
            StatementKind::While { condition, body } => self.build_loop(Some(*condition), body, None),
            StatementKind::DoWhile { body, condition } => {
                let (head, test, after) = (self.open(), self.open(), self.open());
                self.go(head);
                self.exits.push((after, Some(test)));
                self.block(body);
                self.exits.pop();
                self.go(test);
                self.evaluate(*condition);
                let again = self.open();
                self.end(Terminator::Branch {
                    condition: *condition,
                    yes: again,
                    no: after,
                    exited_loop: None,
                });
                self.blocks[again].end = Terminator::BackEdge(head);
                self.at = after;
            }
            StatementKind::Break => {
                if let Some(&(after, _)) = self.exits.last() {
                    self.jump(Terminator::Goto(after));
                }
            }
            StatementKind::Continue => {
                if let Some(next) = self.exits.iter().rev().find_map(|&(_, next)| next) {
                    self.jump(Terminator::Goto(next));
                }
            }
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    self.returned_beside.extend(self.parts_beside(*value));
                    self.evaluate(*value);
                }
                self.jump(Terminator::Return);
            }
            StatementKind::Discard => self.jump(Terminator::Open),
        }
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case]) {
        self.evaluate(selector);
        let bodies: Vec<_> = cases.iter().map(|_| self.open()).collect();
        let join = self.open();
        let values = |labels: &[Label]| {
            labels
                .iter()
                .filter_map(|label| match label {
                    Label::Case { value, .. } => Some(*value),
                    Label::Default => None,
                })
                .collect()
        };
        let default = cases
            .iter()
            .position(|case| case.labels.contains(&Label::Default));
        self.end(Terminator::Switch {
            selector,
            cases: cases
                .iter()
                .zip(&bodies)
                .map(|(case, &body)| (values(&case.labels), body))
                .collect(),
            default: default.map_or(join, |case| bodies[case]),
        });
        self.exits.push((join, None));
        for (index, case) in cases.iter().enumerate() {
            self.at = bodies[index];
            self.block(&case.body);
            let next = bodies.get(index + 1).copied().unwrap_or(join);
            self.end(Terminator::Goto(next));
        }
        self.exits.pop();
        self.at = join;
    }

    fn build_loop(&mut self, condition: Option<Condition>, body: &Block, step: Option<ExprId>) {
        let (head, inside, next, after) = (self.open(), self.open(), self.open(), self.open());
        self.go(head);
        let condition = match condition {
            None => None,
            Some(Condition::Expression(expr)) => {
                self.evaluate_condition(expr, head);
                Some(expr)
            }
            Some(Condition::Declare(variable)) => {
                self.declare(variable);
                self.tree[variable].initializer
            }
        };
        match condition {
            Some(condition) => self.end(Terminator::Branch {
                condition,
                yes: inside,
                no: after,
                exited_loop: Some(head),
            }),
            None => self.end(Terminator::Goto(inside)),
        }
        self.at = inside;
        self.exits.push((after, Some(next)));
        self.block(body);
        self.exits.pop();
        self.go(next);
        if let Some(step) = step {
            self.evaluate(step);
        }
        self.end(Terminator::BackEdge(head));
        self.at = after;
    }

    fn declare(&mut self, variable: VariableId) {
        match self.tree[variable].initializer {
            Some(value) => {
                self.evaluate(value);
                self.emit(Event::Set {
                    variable,
                    target: None,
                    value,
                });
            }
            None => self.emit(Event::Begin(variable)),
        }
    }
    /// The arguments of a constructor with several arguments that are variables or parts of variables.
    fn parts_beside(&self, expr: ExprId) -> Vec<ExprId> {
        match &self.tree[expr].kind {
            ExprKind::Construct {
                constructor: Constructor::Vector | Constructor::Struct,
                arguments,
            } if arguments.len() > 1 => {
                let is_part = |&argument: &ExprId| self.layout.part(argument).is_some();
                arguments.iter().copied().filter(is_part).collect()
            }
            _ => Vec::new(),
        }
    }
}

// Expressions: their reads and writes in evaluation order, as events of a [`Cfg`].

/// Pending work for an expression.
enum Work {
    Evaluate(ExprId),
    /// Evaluate as the condition of the loop with that head, or as a part of that condition.
    EvaluateCondition(ExprId, BlockId),
    Emit(Event),
    /// The previous operand decides whether the next one is evaluated.
    Branch {
        condition: ExprId,
        yes: BlockId,
        no: BlockId,
        exited_loop: Option<BlockId>,
    },
    Goto(BlockId),
    Enter(BlockId),
}

impl Builder<'_> {
    /// Appends an expression's events to the current block, and opens further blocks for operators that
    /// evaluate their operands conditionally.
    pub(super) fn evaluate(&mut self, root: ExprId) {
        self.run(Work::Evaluate(root));
    }

    /// The same for the condition of the loop with that head.
    pub(super) fn evaluate_condition(&mut self, condition: ExprId, head: BlockId) {
        self.run(Work::EvaluateCondition(condition, head));
    }

    fn run(&mut self, first: Work) {
        let tree = self.tree;
        let mut pending = vec![first];
        while let Some(next) = pending.pop() {
            let begin = pending.len();
            match next {
                Work::Emit(event) => self.emit(event),
                Work::Branch {
                    condition,
                    yes,
                    no,
                    exited_loop,
                } => {
                    self.end(Terminator::Branch {
                        condition,
                        yes,
                        no,
                        exited_loop,
                    });
                    self.at = yes;
                }
                Work::Goto(to) => self.end(Terminator::Goto(to)),
                Work::Enter(block) => self.at = block,
                Work::EvaluateCondition(expr, head) => match tree[expr].kind {
                    ExprKind::Binary {
                        op: op @ (BinaryOp::And | BinaryOp::Or),
                        left,
                        right,
                    } => self.short_circuit(op, left, right, Some(head), &mut pending),
                    _ => pending.push(Work::Evaluate(expr)),
                },
                // Literals and constants read no variable that could be uninitialized.
                Work::Evaluate(expr) if tree[expr].constant => {}
                Work::Evaluate(expr) => self.steps(expr, &mut pending),
            }
            // The work was pushed in execution order, and is popped from the end.
            pending[begin..].reverse();
        }
    }

    /// Pushes the steps of an expression in evaluation order.
    fn steps(&mut self, expr: ExprId, pending: &mut Vec<Work>) {
        let tree = self.tree;
        match &tree[expr].kind {
            ExprKind::Variable(_)
            | ExprKind::Swizzle { .. }
            | ExprKind::Member { .. }
            | ExprKind::Index { .. } => match self.layout.part(expr) {
                Some(part) => {
                    self.indices(expr, pending);
                    let part = self.as_read(part, expr);
                    pending.push(Work::Emit(Event::Read { part, expr }));
                }
                None => tree[expr]
                    .kind
                    .for_each_operand(|operand| pending.push(Work::Evaluate(operand))),
            },
            ExprKind::Binary {
                op: op @ (BinaryOp::And | BinaryOp::Or),
                left,
                right,
            } => self.short_circuit(*op, *left, *right, None, pending),
            ExprKind::Conditional { condition, yes, no } => {
                let (if_yes, if_no, join) = (self.open(), self.open(), self.open());
                pending.extend([
                    Work::Evaluate(*condition),
                    Work::Branch {
                        condition: *condition,
                        yes: if_yes,
                        no: if_no,
                        exited_loop: None,
                    },
                    Work::Evaluate(*yes),
                    Work::Goto(join),
                    Work::Enter(if_no),
                    Work::Evaluate(*no),
                    Work::Goto(join),
                    Work::Enter(join),
                ]);
            }
            ExprKind::Assign { op, target, value } => self.assign(*op, *target, *value, pending),
            ExprKind::Step { target, .. } => {
                self.indices(*target, pending);
                if let Some(part) = self.layout.part(*target) {
                    let variable = part.variable;
                    pending.push(Work::Emit(Event::Read {
                        part: part.clone(),
                        expr: *target,
                    }));
                    pending.push(Work::Emit(Event::Write(part)));
                    pending.push(Work::Emit(Event::Forget(variable)));
                }
            }
            ExprKind::Call { function, arguments } => self.call(*function, arguments, pending),
            ExprKind::BuiltIn { function, arguments } => {
                for (index, &argument) in arguments.iter().enumerate() {
                    match self.layout.part(argument) {
                        Some(part) if function.out_parameter() == Some(index) => {
                            let forget = Event::Forget(part.variable);
                            pending.extend([Work::Emit(Event::Write(part)), Work::Emit(forget)]);
                        }
                        _ => pending.push(Work::Evaluate(argument)),
                    }
                }
            }
            ExprKind::Length { .. } => {}
            kind => kind.for_each_operand(|operand| pending.push(Work::Evaluate(operand))),
        }
    }

    /// `&&` and `||`: the left operand decides whether the right one is evaluated.
    fn short_circuit(
        &mut self,
        op: BinaryOp,
        left: ExprId,
        right: ExprId,
        exited_loop: Option<BlockId>,
        pending: &mut Vec<Work>,
    ) {
        let (more, join) = (self.open(), self.open());
        let (yes, no) = if op == BinaryOp::And {
            (more, join)
        } else {
            (join, more)
        };
        let operand = |expr: ExprId| match exited_loop {
            Some(head) => Work::EvaluateCondition(expr, head),
            None => Work::Evaluate(expr),
        };
        pending.extend([
            operand(left),
            Work::Branch {
                condition: left,
                yes,
                no,
                exited_loop,
            },
            Work::Enter(more),
            operand(right),
            Work::Goto(join),
            Work::Enter(join),
        ]);
    }

    fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId, pending: &mut Vec<Work>) {
        let tree = self.tree;
        self.indices(target, pending);
        match &tree[value].kind {
            // The image's alpha is always 1, whatever is written.
            ExprKind::Construct {
                constructor: Constructor::Vector,
                arguments,
            } if matches!(tree[target].kind, ExprKind::Variable(v) if Some(v) == self.color)
                && arguments.len() > 1
                && arguments.last().is_some_and(|&alpha| self.is_scalar_part(alpha)) =>
            {
                let colors = &arguments[..arguments.len() - 1];
                pending.extend(colors.iter().copied().map(Work::Evaluate));
            }
            _ => pending.push(Work::Evaluate(value)),
        }
        if let Some(part) = self.layout.part(target) {
            if op.is_some() {
                pending.push(Work::Emit(Event::Read {
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
            pending.extend([Work::Emit(Event::Write(part)), Work::Emit(known)]);
        }
    }

    fn call(&mut self, function: FunctionId, arguments: &[ExprId], pending: &mut Vec<Work>) {
        let tree = self.tree;
        let summary = &self.summaries[function.index()];
        let mut after = Vec::new();
        for (index, (&parameter, &argument)) in tree[function].parameters.iter().zip(arguments).enumerate() {
            let whole = self.layout.whole(tree[parameter].ty);
            let reads = summary.reads.get(index).copied().unwrap_or(whole);
            let Some(part) = self.layout.part(argument) else {
                pending.push(Work::Evaluate(argument));
                continue;
            };
            self.indices(argument, pending);
            let passed = direction(tree, parameter);
            if passed != Direction::Out && reads != 0 && !matches!(tree[parameter].ty, Type::Sampler(_)) {
                // If the argument is a whole variable, its parts correspond to the parameter's, and only
                // those that the function reads are read; otherwise all of the argument's parts are.
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
                pending.push(Work::Emit(Event::Read { part, expr: argument }));
            }
            if matches!(passed, Direction::Out | Direction::InOut) {
                let forget = Event::Forget(part.variable);
                if summary.writes.get(index).is_none_or(|&writes| writes != 0) {
                    after.push(Work::Emit(Event::Write(part)));
                }
                after.push(Work::Emit(forget));
            }
        }
        pending.push(Work::Emit(Event::Call(summary.globals.clone())));
        pending.append(&mut after);
    }

    /// Reading a whole structure or array counts as reading one unknown part of it: it may be passed on with
    /// members that are never used.
    fn as_read(&self, mut part: Part, expr: ExprId) -> Part {
        part.one_of |= matches!(self.tree[expr].ty, Type::Struct(_) | Type::Array(_));
        part
    }

    fn is_scalar_part(&self, expr: ExprId) -> bool {
        matches!(self.tree[expr].ty, Type::Scalar(_)) && self.layout.part(expr).is_some()
    }

    /// Evaluates the indices of an lvalue.
    fn indices(&self, mut expr: ExprId, pending: &mut Vec<Work>) {
        loop {
            expr = match self.tree[expr].kind {
                ExprKind::Index { base, index } => {
                    pending.push(Work::Evaluate(index));
                    base
                }
                ExprKind::Swizzle { vector: base, .. } | ExprKind::Member { structure: base, .. } => base,
                _ => return,
            };
        }
    }
}
