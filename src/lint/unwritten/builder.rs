//! Makes the [`Flow`] of a function: its statements as blocks.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    Block, Case, Condition, Constructor, Direction, ExprId, ExprKind, FunctionId, Label, Statement,
    StatementKind, Tree, VariableId,
};

use super::super::program::direction;
use super::flow::{BlockId, End, Event, Flow, Node};
use super::part::Layout;
use super::summary::Summary;

/// Builds the flow of one function.
pub(super) struct Builder<'a> {
    pub(super) tree: &'a Tree,
    pub(super) layout: &'a Layout<'a>,
    pub(super) summaries: &'a [Summary],
    /// The pixel's colour.
    pub(super) colour: Option<VariableId>,
    nodes: Vec<Node>,
    returned_beside: HashSet<ExprId>,
    pub(super) at: BlockId,
    /// Where `break` and `continue` go, the innermost last; a `switch` has no `continue`.
    exits: Vec<(BlockId, Option<BlockId>)>,
}

impl<'a> Builder<'a> {
    pub(super) fn build(
        tree: &'a Tree,
        layout: &'a Layout<'a>,
        summaries: &'a [Summary],
        colour: Option<VariableId>,
        function: FunctionId,
    ) -> Flow {
        let mut builder = Self {
            tree,
            layout,
            summaries,
            colour,
            nodes: Vec::new(),
            returned_beside: HashSet::new(),
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
        builder.end(End::Fall);
        Flow {
            nodes: builder.nodes,
            returned_beside: builder.returned_beside,
        }
    }

    pub(super) fn open(&mut self) -> BlockId {
        self.nodes.push(Node {
            events: Vec::new(),
            end: End::Open,
        });
        self.nodes.len() - 1
    }

    pub(super) fn happen(&mut self, event: Event) {
        self.nodes[self.at].events.push(event);
    }

    /// Ends the block, and begins another that nothing reaches yet.
    pub(super) fn end(&mut self, end: End) {
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
                    self.returned_beside.extend(self.parts_beside(*value));
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
                self.ask(expr, head);
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
                self.happen(Event::Set {
                    variable,
                    target: None,
                    value,
                });
            }
            None => self.happen(Event::Begin(variable)),
        }
    }
    /// The arguments of a constructor of several that are variables or parts of them.
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
