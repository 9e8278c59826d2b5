//! Flattens nested statements into a sequence guarded by flags.
//!
//! Each region (a branch, an iteration of a loop, a case, the whole function) has a flag that is true while
//! it runs. A jump clears the flags of all regions that it leaves. Loops remain, each around its own regions.

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, Case, Condition, ExprId, FunctionId, Label, Place, Scalar, Statement,
    StatementKind, Type, UnaryOp, VariableId, VariableKind, walk,
};

use crate::lower::context::LoweringContext;

/// A region that a jump may leave.
#[derive(Clone, Copy)]
enum Region {
    Branch,
    Case,
    /// One iteration of a loop, with the flag of whether another follows.
    Iteration(VariableId),
    Function,
}

pub(super) fn flatten_function(cx: &mut LoweringContext, function: FunctionId, body: Block) -> Block {
    let at = cx.tree[function].at;
    let ty = cx.tree[function].return_type;
    let result = (ty != Type::Void).then(|| {
        let result = cx.local("result", ty, at);
        cx.moved.insert(result);
        result
    });
    let mut flattener = Flattener {
        cx,
        regions: Vec::new(),
        result,
        out: Block::new(),
        queued: Block::new(),
    };
    if let Some(result) = result {
        flattener.push(StatementKind::Declare(result), at);
    }
    let runs = flattener.flag(true, at);
    flattener.region(Region::Function, runs, body);
    if let Some(result) = result {
        let value = flattener.cx.build(at).variable(result);
        flattener.push(StatementKind::Return(Some(value)), at);
    }
    flattener.out
}

struct Flattener<'a> {
    cx: &'a mut LoweringContext,
    /// The open regions with their flags, innermost last.
    regions: Vec<(Region, VariableId)>,
    /// The function's return value.
    result: Option<VariableId>,
    out: Block,
    /// Statements to be guarded by the innermost region's flag.
    queued: Block,
}

impl Flattener<'_> {
    fn push(&mut self, kind: StatementKind, at: Place) {
        self.out.push(Statement::new(kind, at));
    }

    /// `bool runs = value;`
    fn flag(&mut self, value: bool, at: Place) -> VariableId {
        let value = self.cx.build(at).zero_or_one(Scalar::Bool, value);
        self.declare_initialized(Type::BOOL, value, at)
    }

    fn declare_initialized(&mut self, ty: Type, value: ExprId, at: Place) -> VariableId {
        let variable = self.cx.local("runs", ty, at);
        self.cx.moved.insert(variable);
        self.cx.tree[variable].initializer = Some(value);
        self.push(StatementKind::Declare(variable), at);
        variable
    }

    fn read(&mut self, variable: VariableId, at: Place) -> ExprId {
        self.cx.build(at).variable(variable)
    }

    fn current(&self) -> Option<VariableId> {
        self.regions.last().map(|&(_, flag)| flag)
    }

    /// Queues a statement to be guarded by the innermost flag.
    fn queue(&mut self, kind: StatementKind, at: Place) {
        self.queued.push(Statement::new(kind, at));
    }

    fn set(&mut self, variable: VariableId, value: ExprId, at: Place) {
        let set = self.cx.build(at).set(variable, value);
        self.queue(StatementKind::Expression(set), at);
    }

    /// Emits the queued statements under one `if`.
    fn flush(&mut self) {
        let body = std::mem::take(&mut self.queued);
        let (Some(first), Some(flag)) = (body.first(), self.current()) else {
            return;
        };
        let at = first.at;
        let condition = self.read(flag, at);
        self.push(StatementKind::when(condition, body), at);
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
                self.flatten_loop(condition_expression(condition), body, step, None, at);
            }
            StatementKind::While { condition, body } => {
                self.flatten_loop(condition_expression(Some(condition)), body, None, None, at);
            }
            StatementKind::DoWhile { body, condition } => {
                self.flatten_loop(None, body, None, Some(condition), at);
            }
            StatementKind::Break => self.exit_regions(
                |region| matches!(region, Region::Iteration(_) | Region::Case),
                true,
                at,
            ),
            StatementKind::Continue => {
                self.exit_regions(|region| matches!(region, Region::Iteration(_)), false, at);
            }
            StatementKind::Return(value) => {
                if let (Some(value), Some(result)) = (value, self.result) {
                    self.set(result, value, at);
                }
                self.exit_regions(|_| false, true, at);
            }
            kind @ (StatementKind::Expression(_) | StatementKind::Discard) => self.queue(kind, at),
            kind @ StatementKind::Struct(_) => self.push(kind, at),
        }
    }

    /// Declares a variable unconditionally and initializes it under the flag.
    fn declare(&mut self, variable: VariableId, at: Place) {
        self.cx.moved.insert(variable);
        self.push(StatementKind::Declare(variable), at);
        if let Some(value) = self.cx.tree[variable].initializer.take() {
            self.cx.tree[variable].kind = VariableKind::Local;
            self.set(variable, value, at);
        }
    }

    fn branches(&mut self, arms: Vec<Arm>, otherwise: Option<Block>, at: Place) {
        self.flush();
        let Some(open) = self.open_flag(at) else {
            return;
        };
        for Arm { condition, body } in arms {
            let here = self.flag(false, at);
            self.regions.push((Region::Branch, open));
            self.set(here, condition, at);
            self.flush();
            self.regions.pop();
            self.exclude(open, here, at);
            self.region(Region::Branch, here, body);
        }
        if let Some(body) = otherwise {
            self.region(Region::Branch, open, body);
        }
    }

    /// Declares the flag of the pixels that no branch has taken yet: all that run the statement.
    fn open_flag(&mut self, at: Place) -> Option<VariableId> {
        let outer = self.current()?;
        let outer = self.read(outer, at);
        Some(self.declare_initialized(Type::BOOL, outer, at))
    }

    /// Clears the flag `open` in the pixels that take the branch `here`.
    fn exclude(&mut self, open: VariableId, here: VariableId, at: Place) {
        let [here, rest] = [here, open].map(|flag| self.read(flag, at));
        let mut build = self.cx.build(at);
        let not_here = build.unary(UnaryOp::Not, here);
        let rest = build.binary(BinaryOp::And, rest, not_here, Type::BOOL);
        let set = build.set(open, rest);
        self.push(StatementKind::Expression(set), at);
    }

    /// Flattens cases, each of which ends in a `break` already.
    fn cases(&mut self, selector: ExprId, cases: Vec<Case>, at: Place) {
        let ty = self.cx.tree[selector].ty;
        let chosen = self.cx.local("selector", ty, at);
        self.cx.moved.insert(chosen);
        self.push(StatementKind::Declare(chosen), at);
        self.set(chosen, selector, at);
        self.flush();
        let Some(open) = self.open_flag(at) else {
            return;
        };
        let (named, default): (Vec<Case>, Vec<Case>) = cases
            .into_iter()
            .partition(|case| !case.labels.contains(&Label::Default));
        for Case { labels, body, at } in named {
            let open_read = self.read(open, at);
            let tests: Vec<ExprId> = walk::values(&labels)
                .map(|value| {
                    let mut build = self.cx.build(at);
                    let selector = build.variable(chosen);
                    let value = build.copy(value);
                    build.binary(BinaryOp::Equal, selector, value, Type::BOOL)
                })
                .collect();
            let mut build = self.cx.build(at);
            let any = tests
                .into_iter()
                .reduce(|a, b| build.binary(BinaryOp::Or, a, b, Type::BOOL));
            let Some(any) = any else {
                continue;
            };
            let here = build.binary(BinaryOp::And, open_read, any, Type::BOOL);
            let here = self.declare_initialized(Type::BOOL, here, at);
            self.exclude(open, here, at);
            self.region(Region::Case, here, body);
        }
        for case in default {
            self.region(Region::Case, open, case.body);
        }
    }

    /// `for (bool again = runs; again; ) { again = condition; … if (again) step; }`
    fn flatten_loop(
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
        let again = self.declare_initialized(Type::BOOL, outer, at);
        let before = std::mem::take(&mut self.out);
        if let Some(condition) = condition {
            let set = self.cx.build(at).set(again, condition);
            self.push(StatementKind::Expression(set), at);
        }
        let runs = self.read(again, at);
        let iteration = self.declare_initialized(Type::BOOL, runs, at);
        self.region(Region::Iteration(again), iteration, body);
        self.regions.push((Region::Branch, again));
        if let Some(step) = step {
            self.queue(StatementKind::Expression(step), at);
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

    /// Clears the flags of the regions that a jump leaves, and of each loop that it ends.
    fn exit_regions(&mut self, is_last: impl Fn(Region) -> bool, ends_loop: bool, at: Place) {
        for (region, flag) in self.regions.clone().into_iter().rev() {
            let last = is_last(region);
            let no = self.cx.build(at).zero_or_one(Scalar::Bool, false);
            self.set(flag, no, at);
            if let (Region::Iteration(again), true) = (region, ends_loop) {
                let no = self.cx.build(at).zero_or_one(Scalar::Bool, false);
                self.set(again, no, at);
            }
            if last {
                break;
            }
        }
    }
}

fn condition_expression(condition: Option<Condition>) -> Option<ExprId> {
    match condition? {
        Condition::Expression(condition) => Some(condition),
        // `hoist_loop_heads` replaced it by an expression.
        Condition::Declare(_) => None,
    }
}
