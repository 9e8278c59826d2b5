//! Statements, conditionals and calls nested deeper than lavapipe supports.
//!
//! Mesa's software driver inlines all calls and keeps the active conditions of its pixels on a stack of 80
//! entries, loops on another; statements nested deeper run regardless of their conditions. Its compiler also
//! nests the statements after a conditional `return` or `continue`. So the statements of deep functions are
//! flattened under flags ([`flatten`]), and long `a ? x : b ? y : …` likewise. Shaders that still nest too
//! deeply (loops in loops, or calls under conditions, again and again) must not run on a driver.

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{
    BinaryOp, ExprId, ExprKind, FunctionId, Place, Scalar, Statement, StatementKind, Tree, Type, UnaryOp,
    VariableId, walk,
};

use super::call_order::callees_first;
use crate::lower::context::LoweringContext;
use crate::lower::{flatten, initializer, lvalue};

/// Depth above which functions are flattened: the driver's limit is 79 with an `else`, less the levels that
/// helper functions and its own passes add.
const FLATTEN_ABOVE_DEPTH: u32 = 64;

/// Maximum depth of conditions or loops that may run on a driver: below the measured 79 and 80, to leave a
/// few for helper functions.
const MAX_DRIVER_DEPTH: u32 = 72;

/// Maximum depths of functions that are not flattened, in the first and the second attempt.
const MAX_KEPT_DEPTHS: [u32; 2] = [8, 2];

/// Flattens conditionals and functions that are nested too deeply for the driver, and records the diagnostic
/// of a shader that still is.
pub(super) fn run(cx: &mut LoweringContext) {
    flatten_conditionals(cx);
    for kept in MAX_KEPT_DEPTHS {
        let depths = Depths::new(cx);
        if depths
            .of_image(cx)
            .is_none_or(|whole| whole.both.depth <= FLATTEN_ABOVE_DEPTH)
        {
            return;
        }
        cx.each_body(|cx, function, body| {
            if depths.own.get(&function).is_some_and(|&own| own > kept) {
                flatten::flatten_function(cx, function, body)
            } else {
                body
            }
        });
    }
    let Some(whole) = Depths::new(cx).of_image(cx) else {
        return;
    };
    let (what, Deepest { depth, at }) = if whole.loops.depth > MAX_DRIVER_DEPTH {
        ("loops", whole.loops)
    } else if whole.conditions.depth > MAX_DRIVER_DEPTH {
        ("conditions", whole.conditions)
    } else {
        return;
    };
    let message = format!("nested too deeply: inside {depth} {what}, including those of its callers");
    cx.too_deep = Some(Code::TooDeepToRun.at(at, message).help(
        "divide it into consecutive steps, or evaluate it with `--device cpu`; drivers allow at most 80 levels",
    ));
}

/// The numbers of conditions and loops around a statement or an expression.
#[derive(Clone, Copy, Default)]
struct Depth {
    conditions: u32,
    loops: u32,
}

impl Depth {
    fn in_condition(self) -> Self {
        Self {
            conditions: self.conditions + 1,
            ..self
        }
    }

    fn in_loop(self) -> Self {
        Self {
            loops: self.loops + 1,
            ..self
        }
    }
}

/// A place of the largest depth, and that depth.
#[derive(Clone, Copy)]
struct Deepest {
    depth: u32,
    at: Place,
}

/// The deepest places of a function, including the functions that it calls.
#[derive(Clone, Copy)]
struct MaxDepths {
    conditions: Deepest,
    loops: Deepest,
    /// Conditions and loops together.
    both: Deepest,
}

impl MaxDepths {
    /// A place without nesting.
    fn shallow(at: Place) -> Self {
        let here = Deepest { depth: 0, at };
        Self {
            conditions: here,
            loops: here,
            both: here,
        }
    }

    /// Records a place at a depth, with the depths inside it: those of a called function.
    fn record(&mut self, depth: Depth, inner: Self) {
        for (deepest, outer, inner) in [
            (&mut self.conditions, depth.conditions, inner.conditions),
            (&mut self.loops, depth.loops, inner.loops),
            (&mut self.both, depth.conditions + depth.loops, inner.both),
        ] {
            let depth = outer + inner.depth;
            if depth > deepest.depth {
                *deepest = Deepest { depth, at: inner.at };
            }
        }
    }
}

/// The nesting depths of all functions.
struct Depths {
    /// The depths without those of called functions.
    own: HashMap<FunctionId, u32>,
    /// Depths including those of called functions.
    whole: HashMap<FunctionId, MaxDepths>,
}

impl Depths {
    /// Computes the depths of all functions, callees before callers.
    fn new(cx: &LoweringContext) -> Self {
        let mut depths = Self {
            own: HashMap::new(),
            whole: HashMap::new(),
        };
        for (function, _) in callees_first(&cx.tree) {
            let Some(body) = &cx.tree[function].body else {
                continue;
            };
            let mut visitor = DepthVisitor {
                cx,
                depths: &depths,
                own: 0,
                whole: MaxDepths::shallow(cx.tree[function].at),
            };
            visitor.block(body, Depth::default());
            let (own, whole) = (visitor.own, visitor.whole);
            depths.own.insert(function, own);
            depths.whole.insert(function, whole);
        }
        depths
    }

    /// The depths of everything that runs for an image.
    fn of_image(&self, cx: &LoweringContext) -> Option<MaxDepths> {
        let mut all = *self.whole.get(&cx.main_image)?;
        if let Some(startup) = cx.startup_function.and_then(|id| self.whole.get(&id)) {
            all.record(Depth::default(), *startup);
        }
        Some(all)
    }
}

/// Finds the deepest places of one function.
struct DepthVisitor<'a> {
    cx: &'a LoweringContext,
    depths: &'a Depths,
    own: u32,
    whole: MaxDepths,
}

impl DepthVisitor<'_> {
    /// Visits the statements of a block at a depth. Returns whether control may jump out of the block.
    fn block(&mut self, block: &[Statement], mut depth: Depth) -> bool {
        let mut leaves = false;
        for statement in block {
            if self.statement(statement, depth) {
                // The rest of the block is nested in an `else` of this statement.
                leaves = true;
                depth = depth.in_condition();
            }
        }
        leaves
    }

    /// Visits a statement at a depth. Returns whether control may jump out of its block, to code after it.
    fn statement(&mut self, statement: &Statement, depth: Depth) -> bool {
        if let StatementKind::If { arms, otherwise } = &statement.kind {
            let mut leaves = false;
            let mut inner = depth;
            for arm in arms {
                // Each `else if` is nested in the previous `else`.
                self.expression(arm.condition, inner);
                inner = inner.in_condition();
                leaves |= self.block(&arm.body, inner);
            }
            if let Some(body) = otherwise {
                leaves |= self.block(body, inner);
            }
            return leaves;
        }
        for expr in walk::own_expressions(&self.cx.tree, statement) {
            self.expression(expr, depth);
        }
        let mut leaves = walk::jumps(statement) && !matches!(statement.kind, StatementKind::Discard);
        let inner = match statement.kind {
            StatementKind::Block(_) => depth,
            StatementKind::Switch { .. } => depth.in_condition(),
            // Loops; other statements have no blocks.
            _ => depth.in_loop(),
        };
        for body in walk::child_blocks(statement) {
            leaves |= self.block(body, inner);
        }
        leaves
    }

    fn expression(&mut self, root: ExprId, depth: Depth) {
        self.record(root, depth, None);
        let mut pending = vec![(root, depth)];
        while let Some((id, depth)) = pending.pop() {
            let kind = &self.cx.tree[id].kind;
            if let &ExprKind::Conditional { condition, yes, no } = kind {
                let inner = depth.in_condition();
                self.record(id, inner, None);
                pending.extend([(condition, depth), (yes, inner), (no, inner)]);
                continue;
            }
            if let ExprKind::Call { function, .. } = kind {
                self.record(id, depth, self.depths.whole.get(function).copied());
            }
            kind.for_each_operand(|operand| pending.push((operand, depth)));
        }
    }

    fn record(&mut self, id: ExprId, depth: Depth, called: Option<MaxDepths>) {
        self.own = self.own.max(depth.conditions + depth.loops);
        let here = MaxDepths::shallow(self.cx.tree[id].at);
        self.whole.record(depth, called.unwrap_or(here));
    }
}

/// Maximum depth of nested conditionals that stay unchanged.
const MAX_KEPT_CONDITIONALS: usize = 16;

/// Flattens nested conditionals: `a ? x : b ? y : z` becomes `chosen = 0, here = a, other = !here,
/// chosen = here ? x : chosen, here2 = other ? b : false, other2 = other && !here2, …, chosen`.
fn flatten_conditionals(cx: &mut LoweringContext) {
    let mut nested = HashSet::new();
    for (_, expr) in cx.tree.exprs.iter() {
        if let ExprKind::Conditional { yes, no, .. } = expr.kind {
            nested.extend([yes, no]);
        }
    }
    cx.each_expression(|cx, id| {
        if !nested.contains(&id)
            && cx.tree[id].ty != Type::Void
            && !cx.tree[id].constant
            && nests_too_deep(&cx.tree, id)
        {
            flatten_conditional(cx, id);
        }
    });
}

/// Whether the branches of a conditional nest conditionals deeper than allowed.
fn nests_too_deep(tree: &Tree, root: ExprId) -> bool {
    let mut pending = vec![(root, 0)];
    while let Some((id, depth)) = pending.pop() {
        if let ExprKind::Conditional { yes, no, .. } = tree[id].kind {
            if depth == MAX_KEPT_CONDITIONALS {
                return true;
            }
            pending.extend([(yes, depth + 1), (no, depth + 1)]);
        }
    }
    false
}

/// Replaces a conditional by a sequence that evaluates the same expressions in the same order.
fn flatten_conditional(cx: &mut LoweringContext, root: ExprId) {
    let (ty, at) = (cx.tree[root].ty, cx.tree[root].at);
    let chosen = cx.temporary("chosen", ty, at);
    let first = initializer::zero_value(cx, ty, at);
    let mut steps = vec![cx.build(at).set(chosen, first)];
    // Each entry has the flag of whether it is evaluated; the outermost always is.
    let whole = cx.build(at).detach(root);
    let mut pending = vec![(whole, None)];
    while let Some((id, flag)) = pending.pop() {
        let ExprKind::Conditional { condition, yes, no } = cx.tree[id].kind else {
            let old = cx.build(at).variable(chosen);
            let value = select_if(cx, flag, id, old, at);
            steps.push(cx.build(at).set(chosen, value));
            continue;
        };
        let (here, other) = (
            cx.temporary("here", Type::BOOL, at),
            cx.temporary("other", Type::BOOL, at),
        );
        let not_taken = cx.build(at).zero_or_one(Scalar::Bool, false);
        let tested = select_if(cx, flag, condition, not_taken, at);
        let mut build = cx.build(at);
        steps.push(build.set(here, tested));
        let here_read = build.variable(here);
        let not_here = build.unary(UnaryOp::Not, here_read);
        let otherwise = match flag {
            Some(flag) => {
                let flag = build.variable(flag);
                build.binary(BinaryOp::And, flag, not_here, Type::BOOL)
            }
            None => not_here,
        };
        steps.push(build.set(other, otherwise));
        // Only one of the two is evaluated, so they keep the order of the text.
        pending.extend([(no, Some(other)), (yes, Some(here))]);
    }
    let last = cx.build(at).variable(chosen);
    lvalue::replace_with_sequence(cx, root, steps, Some(last));
}

/// `flag ? value : other`, or just the value if there is no flag.
fn select_if(
    cx: &mut LoweringContext,
    flag: Option<VariableId>,
    value: ExprId,
    other: ExprId,
    at: Place,
) -> ExprId {
    let Some(flag) = flag else {
        return value;
    };
    let ty = cx.tree[value].ty;
    let mut build = cx.build(at);
    let condition = build.variable(flag);
    build.push(
        ExprKind::Conditional {
            condition,
            yes: value,
            no: other,
        },
        ty,
    )
}
