//! A function whose statements stand side by side. A flag tells of each region (a branch, a round of a loop,
//! a case, the whole) whether it still runs; a jump lowers the flags of all regions that it leaves. Loops
//! stay, each around its own regions.

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, Case, Condition, ExprId, FunctionId, Label, Place, Scalar, Statement,
    StatementKind, Type, UnaryOp, VariableId, VariableKind, walk,
};

use super::super::draft::Draft;

/// What a jump may leave.
#[derive(Clone, Copy)]
enum Region {
    Branch,
    Case,
    /// One round of a loop, with the flag that tells whether there is another.
    Round(VariableId),
    Function,
}

/// A function's body, flat.
pub(super) fn flatten(draft: &mut Draft, function: FunctionId, body: Block) -> Block {
    let at = draft.tree[function].at;
    let ty = draft.tree[function].return_type;
    let result = (ty != Type::Void).then(|| {
        let result = draft.local("result", ty, at);
        draft.moved.insert(result);
        result
    });
    let mut flat = Flat {
        draft,
        regions: Vec::new(),
        result,
        out: Block::new(),
        waiting: Block::new(),
    };
    if let Some(result) = result {
        flat.push(StatementKind::Declare(result), at);
    }
    let runs = flat.flag(true, at);
    flat.region(Region::Function, runs, body);
    if let Some(result) = result {
        let value = flat.draft.build(at).variable(result);
        flat.push(StatementKind::Return(Some(value)), at);
    }
    flat.out
}

struct Flat<'a> {
    draft: &'a mut Draft,
    /// Those that are open, with their flags.
    regions: Vec<(Region, VariableId)>,
    /// What the function gives.
    result: Option<VariableId>,
    out: Block,
    /// What is to run under the innermost region's flag.
    waiting: Block,
}

impl Flat<'_> {
    fn push(&mut self, kind: StatementKind, at: Place) {
        self.out.push(Statement { kind, at });
    }

    /// `bool runs = value;`
    fn flag(&mut self, value: bool, at: Place) -> VariableId {
        let value = self.draft.build(at).small(Scalar::Bool, value);
        self.declared(Type::BOOL, value, at)
    }

    fn declared(&mut self, ty: Type, value: ExprId, at: Place) -> VariableId {
        let variable = self.draft.local("runs", ty, at);
        self.draft.moved.insert(variable);
        self.draft.tree[variable].initialiser = Some(value);
        self.push(StatementKind::Declare(variable), at);
        variable
    }

    fn read(&mut self, variable: VariableId, at: Place) -> ExprId {
        self.draft.build(at).variable(variable)
    }

    fn current(&self) -> Option<VariableId> {
        self.regions.last().map(|&(_, flag)| flag)
    }

    /// A statement that runs under the innermost flag.
    fn wait(&mut self, kind: StatementKind, at: Place) {
        self.waiting.push(Statement { kind, at });
    }

    fn set(&mut self, variable: VariableId, value: ExprId, at: Place) {
        let set = self.draft.build(at).set(variable, value);
        self.wait(StatementKind::Expression(set), at);
    }

    /// Writes what waits.
    fn flush(&mut self) {
        let body = std::mem::take(&mut self.waiting);
        let (Some(first), Some(flag)) = (body.first(), self.current()) else {
            return;
        };
        let at = first.at;
        let condition = self.read(flag, at);
        let arms = vec![Arm { condition, body }];
        self.push(
            StatementKind::If {
                arms,
                otherwise: None,
            },
            at,
        );
    }

    fn region(&mut self, region: Region, flag: VariableId, body: Block) {
        self.regions.push((region, flag));
        for statement in body {
            self.statement(statement);
        }
        self.flush();
        self.regions.pop();
    }

    fn statement(&mut self, statement: Statement) {
        let at = statement.at;
        match statement.kind {
            StatementKind::Declare(variable) => self.declare(variable, at),
            StatementKind::Block(body) => {
                for statement in body {
                    self.statement(statement);
                }
            }
            StatementKind::If { arms, otherwise } => self.branches(arms, otherwise, at),
            StatementKind::Switch { selector, cases } => self.cases(selector, cases, at),
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                for statement in init {
                    self.statement(statement);
                }
                self.repeat(tested(condition), body, step, None, at);
            }
            StatementKind::While { condition, body } => {
                self.repeat(tested(Some(condition)), body, None, None, at);
            }
            StatementKind::DoWhile { body, condition } => self.repeat(None, body, None, Some(condition), at),
            StatementKind::Break => self.leave(
                |region| matches!(region, Region::Round(_) | Region::Case),
                true,
                at,
            ),
            StatementKind::Continue => self.leave(|region| matches!(region, Region::Round(_)), false, at),
            StatementKind::Return(value) => {
                if let (Some(value), Some(result)) = (value, self.result) {
                    self.set(result, value, at);
                }
                self.leave(|_| false, true, at);
            }
            kind @ (StatementKind::Expression(_) | StatementKind::Discard) => self.wait(kind, at),
            kind @ StatementKind::Struct(_) => self.push(kind, at),
        }
    }

    /// A variable is declared for all that follows and begins under the flag.
    fn declare(&mut self, variable: VariableId, at: Place) {
        self.draft.moved.insert(variable);
        self.push(StatementKind::Declare(variable), at);
        if let Some(value) = self.draft.tree[variable].initialiser.take() {
            self.draft.tree[variable].kind = VariableKind::Local;
            self.set(variable, value, at);
        }
    }

    fn branches(&mut self, arms: Vec<Arm>, otherwise: Option<Block>, at: Place) {
        self.flush();
        let Some(outer) = self.current() else {
            return;
        };
        let outer = self.read(outer, at);
        let open = self.declared(Type::BOOL, outer, at);
        for Arm { condition, body } in arms {
            let here = self.flag(false, at);
            self.regions.push((Region::Branch, open));
            self.set(here, condition, at);
            self.flush();
            self.regions.pop();
            let [here_read, open_read] = [here, open].map(|flag| self.read(flag, at));
            let mut build = self.draft.build(at);
            let not_here = build.unary(UnaryOp::Not, here_read);
            let rest = build.binary(BinaryOp::And, open_read, not_here, Type::BOOL);
            let set = build.set(open, rest);
            self.push(StatementKind::Expression(set), at);
            self.region(Region::Branch, here, body);
        }
        if let Some(body) = otherwise {
            self.region(Region::Branch, open, body);
        }
    }

    /// Cases, each of which ends in a `break` by now.
    fn cases(&mut self, selector: ExprId, cases: Vec<Case>, at: Place) {
        let ty = self.draft.tree[selector].ty;
        let chosen = self.draft.local("selector", ty, at);
        self.draft.moved.insert(chosen);
        self.push(StatementKind::Declare(chosen), at);
        self.set(chosen, selector, at);
        self.flush();
        let Some(outer) = self.current() else {
            return;
        };
        let outer = self.read(outer, at);
        let open = self.declared(Type::BOOL, outer, at);
        let (named, default): (Vec<Case>, Vec<Case>) = cases
            .into_iter()
            .partition(|case| !case.labels.contains(&Label::Default));
        for Case { labels, body, at } in named {
            let open_read = self.read(open, at);
            let tests: Vec<ExprId> = walk::values(&labels)
                .map(|value| {
                    let mut build = self.draft.build(at);
                    let selector = build.variable(chosen);
                    let value = build.copy(value);
                    build.binary(BinaryOp::Equal, selector, value, Type::BOOL)
                })
                .collect();
            let mut build = self.draft.build(at);
            let any = tests
                .into_iter()
                .reduce(|a, b| build.binary(BinaryOp::Or, a, b, Type::BOOL));
            let Some(any) = any else {
                continue;
            };
            let here = build.binary(BinaryOp::And, open_read, any, Type::BOOL);
            let here = self.declared(Type::BOOL, here, at);
            let [here_read, open_read] = [here, open].map(|flag| self.read(flag, at));
            let mut build = self.draft.build(at);
            let not_here = build.unary(UnaryOp::Not, here_read);
            let rest = build.binary(BinaryOp::And, open_read, not_here, Type::BOOL);
            let set = build.set(open, rest);
            self.push(StatementKind::Expression(set), at);
            self.region(Region::Case, here, body);
        }
        for case in default {
            self.region(Region::Case, open, case.body);
        }
    }

    /// `for (bool again = runs; again; ) { again = condition; … if (again) step; }`
    fn repeat(
        &mut self,
        condition: Option<ExprId>,
        body: Block,
        step: Option<ExprId>,
        until: Option<ExprId>,
        at: Place,
    ) {
        self.flush();
        let Some(outer) = self.current() else {
            return;
        };
        let outer = self.read(outer, at);
        let again = self.declared(Type::BOOL, outer, at);
        let before = std::mem::take(&mut self.out);
        if let Some(condition) = condition {
            let set = self.draft.build(at).set(again, condition);
            self.push(StatementKind::Expression(set), at);
        }
        let goes_on = self.read(again, at);
        let round = self.declared(Type::BOOL, goes_on, at);
        self.region(Region::Round(again), round, body);
        self.regions.push((Region::Branch, again));
        if let Some(step) = step {
            self.wait(StatementKind::Expression(step), at);
        }
        if let Some(until) = until {
            self.set(again, until, at);
        }
        self.flush();
        self.regions.pop();
        let body = std::mem::replace(&mut self.out, before);
        let condition = Some(Condition::Expression(self.read(again, at)));
        let init = Block::new();
        let step = None;
        self.push(
            StatementKind::For {
                init,
                condition,
                step,
                body,
            },
            at,
        );
    }

    /// Lowers the flags of the regions that a jump leaves, and of all loops whose rounds it ends for good.
    fn leave(&mut self, is_last: impl Fn(Region) -> bool, ends_loop: bool, at: Place) {
        for (region, flag) in self.regions.clone().into_iter().rev() {
            let last = is_last(region);
            let no = self.draft.build(at).small(Scalar::Bool, false);
            self.set(flag, no, at);
            if let (Region::Round(again), true) = (region, ends_loop) {
                let no = self.draft.build(at).small(Scalar::Bool, false);
                self.set(again, no, at);
            }
            if last {
                break;
            }
        }
    }
}

fn tested(condition: Option<Condition>) -> Option<ExprId> {
    match condition? {
        Condition::Expression(condition) => Some(condition),
        // `loop_head` made an expression of it.
        Condition::Declare(_) => None,
    }
}
