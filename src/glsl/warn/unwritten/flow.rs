//! The ways through a function: blocks of what it reads and writes, and how they follow each other.

use std::collections::HashMap;

use super::super::super::tree::{
    BinaryOp, Block, Case, Condition, Direction, ExprId, ExprKind, FunctionId, Label, Statement,
    StatementKind, Tree, Type, VariableId, VariableKind,
};
use super::super::program::direction;
use super::part::{Layout, Part, Parts};

/// What happens at one place, as far as the search asks.
#[derive(Debug, Clone)]
pub(super) enum Event {
    /// A variable begins, without a value.
    Begin(VariableId),
    Read {
        part: Part,
        /// The place that is told.
        expr: ExprId,
    },
    Write(Part),
    /// A scalar is given a value that may be known.
    Set(VariableId, ExprId),
    /// A variable changes in a way that is not followed.
    Forget(VariableId),
    /// An author's function ran: globals may have changed.
    Called,
}

/// Names a block of a [`Flow`].
pub(super) type BlockId = usize;

#[derive(Debug, Clone)]
pub(super) enum End {
    /// Not told yet, or never reached.
    Open,
    Goto(BlockId),
    /// Back to the head of a loop, the blocks of which begin there and end before the one that goes back.
    Repeat(BlockId),
    Branch {
        condition: ExprId,
        yes: BlockId,
        no: BlockId,
        /// The head of the loop that it may end.
        of_loop: Option<BlockId>,
    },
    Switch {
        selector: ExprId,
        /// The values of the labels of each case, and where it begins.
        cases: Vec<(Vec<u32>, BlockId)>,
        /// Where it goes for any other value.
        default: BlockId,
    },
    Return,
}

#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) events: Vec<Event>,
    pub(super) end: End,
}

/// The ways through a function, from block 0.
pub(super) struct Flow {
    pub(super) nodes: Vec<Node>,
}

/// What callers ask of a function that was looked at before.
#[derive(Debug, Clone, Default)]
pub(super) struct Summary {
    /// By parameter: what of the argument is read, of an `inout` before it is written.
    pub(super) reads: Vec<Parts>,
    /// By parameter: what of it is written on any way.
    pub(super) writes: Vec<Parts>,
}

/// Builds the flow of one function.
pub(super) struct Builder<'a> {
    tree: &'a Tree,
    layout: &'a Layout<'a>,
    summaries: &'a [Summary],
    nodes: Vec<Node>,
    at: BlockId,
    /// Where `break` and `continue` go, the innermost last; a `switch` has no `continue`.
    exits: Vec<(BlockId, Option<BlockId>)>,
}

/// What is left to do of an expression.
enum Work {
    Evaluate(ExprId),
    Happen(Event),
    /// The operand before decided whether what follows is evaluated.
    Branch {
        condition: ExprId,
        yes: BlockId,
        no: BlockId,
    },
    Goto(BlockId),
    Enter(BlockId),
}

impl<'a> Builder<'a> {
    pub(super) fn build(
        tree: &'a Tree,
        layout: &'a Layout<'a>,
        summaries: &'a [Summary],
        function: FunctionId,
    ) -> Flow {
        let mut builder = Self {
            tree,
            layout,
            summaries,
            nodes: Vec::new(),
            at: 0,
            exits: Vec::new(),
        };
        builder.at = builder.open();
        for &parameter in &tree[function].parameters {
            if direction(tree, parameter) == Direction::Out {
                builder.happen(Event::Begin(parameter));
            }
        }
        if let Some(body) = &tree[function].body {
            builder.block(body);
        }
        builder.end(End::Return);
        Flow { nodes: builder.nodes }
    }

    fn open(&mut self) -> BlockId {
        self.nodes.push(Node {
            events: Vec::new(),
            end: End::Open,
        });
        self.nodes.len() - 1
    }

    fn happen(&mut self, event: Event) {
        self.nodes[self.at].events.push(event);
    }

    /// Ends the block, and begins another that nothing reaches yet.
    fn end(&mut self, end: End) {
        self.nodes[self.at].end = end;
    }

    fn jump(&mut self, end: End) {
        self.end(end);
        self.at = self.open();
    }

    fn go(&mut self, to: BlockId) {
        self.end(End::Goto(to));
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
                    self.end(End::Branch {
                        condition: arm.condition,
                        yes,
                        no,
                        of_loop: None,
                    });
                    self.at = yes;
                    self.block(&arm.body);
                    self.end(End::Goto(join));
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
                self.repeat(*condition, body, *step);
            }
            StatementKind::While { condition, body } => self.repeat(Some(*condition), body, None),
            StatementKind::DoWhile { body, condition } => {
                let (head, test, after) = (self.open(), self.open(), self.open());
                self.go(head);
                self.exits.push((after, Some(test)));
                self.block(body);
                self.exits.pop();
                self.go(test);
                self.evaluate(*condition);
                let again = self.open();
                self.end(End::Branch {
                    condition: *condition,
                    yes: again,
                    no: after,
                    of_loop: None,
                });
                self.nodes[again].end = End::Repeat(head);
                self.at = after;
            }
            StatementKind::Break => {
                if let Some(&(after, _)) = self.exits.last() {
                    self.jump(End::Goto(after));
                }
            }
            StatementKind::Continue => {
                if let Some(next) = self.exits.iter().rev().find_map(|&(_, next)| next) {
                    self.jump(End::Goto(next));
                }
            }
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    self.evaluate(*value);
                }
                self.jump(End::Return);
            }
            StatementKind::Discard => self.jump(End::Open),
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
        self.end(End::Switch {
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
            self.end(End::Goto(next));
        }
        self.exits.pop();
        self.at = join;
    }

    fn repeat(&mut self, condition: Option<Condition>, body: &Block, step: Option<ExprId>) {
        let (head, inside, next, after) = (self.open(), self.open(), self.open(), self.open());
        self.go(head);
        let condition = match condition {
            None => None,
            Some(Condition::Expression(expr)) => {
                self.evaluate(expr);
                Some(expr)
            }
            Some(Condition::Declare(variable)) => {
                self.declare(variable);
                self.tree[variable].initialiser
            }
        };
        match condition {
            Some(condition) => self.end(End::Branch {
                condition,
                yes: inside,
                no: after,
                of_loop: Some(head),
            }),
            None => self.end(End::Goto(inside)),
        }
        self.at = inside;
        self.exits.push((after, Some(next)));
        self.block(body);
        self.exits.pop();
        self.go(next);
        if let Some(step) = step {
            self.evaluate(step);
        }
        self.end(End::Repeat(head));
        self.at = after;
    }

    fn declare(&mut self, variable: VariableId) {
        match self.tree[variable].initialiser {
            Some(value) => {
                self.evaluate(value);
                self.happen(Event::Set(variable, value));
            }
            None => self.happen(Event::Begin(variable)),
        }
    }

    fn evaluate(&mut self, root: ExprId) {
        let tree = self.tree;
        let mut work = vec![Work::Evaluate(root)];
        while let Some(next) = work.pop() {
            match next {
                Work::Happen(event) => self.happen(event),
                Work::Branch { condition, yes, no } => {
                    self.end(End::Branch {
                        condition,
                        yes,
                        no,
                        of_loop: None,
                    });
                    self.at = yes;
                }
                Work::Goto(to) => self.end(End::Goto(to)),
                Work::Enter(block) => self.at = block,
                Work::Evaluate(expr) => {
                    // Literals and constants read nothing that could be unwritten.
                    if !tree[expr].constant {
                        let begin = work.len();
                        self.steps(expr, &mut work);
                        work[begin..].reverse();
                    }
                }
            }
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
            } => {
                let (more, join) = (self.open(), self.open());
                let (yes, no) = if *op == BinaryOp::And {
                    (more, join)
                } else {
                    (join, more)
                };
                work.extend([
                    Work::Evaluate(*left),
                    Work::Branch {
                        condition: *left,
                        yes,
                        no,
                    },
                    Work::Enter(more),
                    Work::Evaluate(*right),
                    Work::Goto(join),
                    Work::Enter(join),
                ]);
            }
            ExprKind::Conditional { condition, yes, no } => {
                let (if_yes, if_no, join) = (self.open(), self.open(), self.open());
                work.extend([
                    Work::Evaluate(*condition),
                    Work::Branch {
                        condition: *condition,
                        yes: if_yes,
                        no: if_no,
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

    fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId, work: &mut Vec<Work>) {
        let tree = self.tree;
        self.indices(target, work);
        work.push(Work::Evaluate(value));
        if let Some(part) = self.layout.part(target) {
            if op.is_some() {
                work.push(Work::Happen(Event::Read {
                    part: part.clone(),
                    expr: target,
                }));
            }
            let whole = matches!(tree[target].kind, ExprKind::Variable(_)) && op.is_none();
            let known = if whole {
                Event::Set(part.variable, value)
            } else {
                Event::Forget(part.variable)
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
        work.push(Work::Happen(Event::Called));
        work.append(&mut after);
    }

    /// A structure may well be handed on with members that nobody needs: one of its members is meant, not all.
    fn as_read(&self, mut part: Part, expr: ExprId) -> Part {
        part.one_of |= matches!(self.tree[expr].ty, Type::Struct(_) | Type::Array(_));
        part
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

/// Whether a variable that begins without a value is looked for.
pub(super) fn is_followed(tree: &Tree, variable: VariableId) -> bool {
    let local = matches!(
        tree[variable].kind,
        VariableKind::Local | VariableKind::Parameter(Direction::Out)
    );
    local && !matches!(tree[variable].ty, Type::Sampler(_))
}

/// The variables that a function's blocks begin without a value.
pub(super) fn begun(flow: &Flow) -> Vec<(VariableId, BlockId, usize)> {
    let mut all = Vec::new();
    for (block, node) in flow.nodes.iter().enumerate() {
        for (index, event) in node.events.iter().enumerate() {
            if let Event::Begin(variable) = event {
                all.push((*variable, block, index));
            }
        }
    }
    all
}

/// What a function's own text reads of its parameters, and what it writes of them.
pub(super) fn summary(tree: &Tree, flow: &Flow, function: FunctionId) -> Summary {
    let parameters = &tree[function].parameters;
    let index: HashMap<VariableId, usize> = parameters.iter().copied().zip(0..).collect();
    let mut summary = Summary {
        reads: vec![0; parameters.len()],
        writes: vec![0; parameters.len()],
    };
    for event in flow.nodes.iter().flat_map(|node| &node.events) {
        let (part, sum) = match event {
            Event::Read { part, .. } => (part, &mut summary.reads),
            Event::Write(part) => (part, &mut summary.writes),
            _ => continue,
        };
        if let Some(&index) = index.get(&part.variable) {
            sum[index] |= part.parts;
        }
    }
    summary
}
