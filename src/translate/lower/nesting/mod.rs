//! Statements, choices and calls nested so deep that lavapipe loses count: those of a function side by side,
//! each under a flag that tells whether it runs (`flags`), and long `a ? x : b ? y : …` likewise (`chain`).
//! What still nests too deep (loops in loops, functions called under conditions that call others so) is not to be run on a driver.
//!
//! Mesa's software driver inlines all calls and keeps the conditions that pixels are under on a stack of 80,
//! loops on another; what is nested deeper runs whatever its condition says. Its compiler nests what follows
//! a conditional `return` or `continue`, too.

mod chain;
mod flags;

use std::collections::{HashMap, HashSet};

use toyproof_glsl::Code;
use toyproof_glsl::tree::{Block, ExprId, ExprKind, FunctionId, Place, Statement, StatementKind, walk};

use super::draft::Draft;

/// How deep the driver may nest what it is given: 79 with an `else`, less what helper functions and its own
/// passes add.
const DEEPEST: u32 = 64;
/// Conditions or loops that nest deeper though they were flattened are not run: of 79 and 80 that are measured, a few are for helper
/// functions.
const DEEPEST_RUN: u32 = 72;
/// Functions that nest no deeper by themselves are left as they are, first and then.
const KEPT: [u32; 2] = [8, 2];

pub(super) fn run(draft: &mut Draft) {
    chain::run(draft);
    for kept in KEPT {
        let depths = Depths::of(draft);
        if depths
            .of_picture(draft)
            .is_none_or(|whole| whole.both.0 <= DEEPEST)
        {
            return;
        }
        draft.each_body(|draft, function, body| {
            if depths.own.get(&function).is_some_and(|&own| own > kept) {
                flags::flatten(draft, function, body)
            } else {
                body
            }
        });
    }
    let Some(whole) = Depths::of(draft).of_picture(draft) else {
        return;
    };
    let (what, (depth, at)) = if whole.loops.0 > DEEPEST_RUN {
        ("loops", whole.loops)
    } else if whole.conditions.0 > DEEPEST_RUN {
        ("conditions", whole.conditions)
    } else {
        return;
    };
    let message =
        format!("nested too deeply: this runs under {depth} {what}, those of its callers among them");
    draft.too_deep =
        Some(Code::TooDeepToRun.at(at, message).note(
            "drivers lose count at 80; divide it into steps that stand side by side, or try `--on cpu`",
        ));
}

/// What stands around a statement or an expression.
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

/// The deepest places of a function, with what the functions that it calls nest.
#[derive(Clone, Copy)]
struct Whole {
    conditions: (u32, Place),
    loops: (u32, Place),
    /// Conditions and loops.
    both: (u32, Place),
}

impl Whole {
    /// What nests nothing.
    fn shallow(at: Place) -> Self {
        Self {
            conditions: (0, at),
            loops: (0, at),
            both: (0, at),
        }
    }

    /// Notes what stands at a depth.
    fn note(&mut self, depth: Depth, inner: Self) {
        for (most, depth, inner) in [
            (&mut self.conditions, depth.conditions, inner.conditions),
            (&mut self.loops, depth.loops, inner.loops),
            (&mut self.both, depth.conditions + depth.loops, inner.both),
        ] {
            if depth + inner.0 > most.0 {
                *most = (depth + inner.0, inner.1);
            }
        }
    }
}

/// How deep functions nest.
struct Depths {
    /// Without what the functions that they call nest.
    own: HashMap<FunctionId, u32>,
    /// With it.
    whole: HashMap<FunctionId, Whole>,
}

impl Depths {
    /// Of all functions, those that are called before their callers.
    fn of(draft: &Draft) -> Self {
        let mut depths = Self {
            own: HashMap::new(),
            whole: HashMap::new(),
        };
        let mut seen = HashSet::new();
        for root in draft.tree.functions.ids() {
            let mut pending = vec![(root, false)];
            while let Some((function, callees_done)) = pending.pop() {
                let Some(body) = &draft.tree[function].body else {
                    continue;
                };
                if callees_done {
                    let mut walk = Walk {
                        draft,
                        depths: &depths,
                        own: 0,
                        whole: Whole::shallow(draft.tree[function].at),
                    };
                    walk.block(body, Depth::default());
                    let (own, whole) = (walk.own, walk.whole);
                    depths.own.insert(function, own);
                    depths.whole.insert(function, whole);
                } else if seen.insert(function) {
                    pending.push((function, true));
                    pending.extend(callees(draft, body).into_iter().map(|callee| (callee, false)));
                }
            }
        }
        depths
    }

    /// Of all that runs for a picture.
    fn of_picture(&self, draft: &Draft) -> Option<Whole> {
        let mut all = *self.whole.get(&draft.main_image)?;
        if let Some(begin) = draft.begin.and_then(|begin| self.whole.get(&begin)) {
            all.note(Depth::default(), *begin);
        }
        Some(all)
    }
}

fn callees(draft: &Draft, body: &Block) -> HashSet<FunctionId> {
    let roots = walk::roots(&draft.tree, body);
    let nodes = roots.into_iter().flat_map(|root| draft.tree.postorder(root));
    nodes
        .filter_map(|id| match draft.tree[id].kind {
            ExprKind::Call { function, .. } => Some(function),
            _ => None,
        })
        .collect()
}

/// One walk through a function, which finds its deepest places.
struct Walk<'a> {
    draft: &'a Draft,
    depths: &'a Depths,
    own: u32,
    whole: Whole,
}

impl Walk<'_> {
    /// Statements at that depth; whether control may leave them in their midst.
    fn block(&mut self, block: &[Statement], mut depth: Depth) -> bool {
        let mut leaves = false;
        for statement in block {
            if self.statement(statement, depth) {
                // The rest of the block nests in an `else` of it.
                leaves = true;
                depth = depth.in_condition();
            }
        }
        leaves
    }

    fn statement(&mut self, statement: &Statement, depth: Depth) -> bool {
        if let StatementKind::If { arms, otherwise } = &statement.kind {
            let mut leaves = false;
            let mut inner = depth;
            for arm in arms {
                // Each `else if` nests in the `else` before.
                self.expression(arm.condition, inner);
                inner = inner.in_condition();
                leaves |= self.block(&arm.body, inner);
            }
            return leaves
                | otherwise
                    .iter()
                    .fold(false, |leaves, body| leaves | self.block(body, inner));
        }
        for expr in walk::own_expressions(&self.draft.tree, statement) {
            self.expression(expr, depth);
        }
        let mut leaves = walk::jumps(statement) && !matches!(statement.kind, StatementKind::Discard);
        let inner = match statement.kind {
            StatementKind::Block(_) => depth,
            StatementKind::Switch { .. } => depth.in_condition(),
            _ => depth.in_loop(),
        };
        for body in walk::inner(statement) {
            leaves |= self.block(body, inner);
        }
        leaves
    }

    fn expression(&mut self, root: ExprId, depth: Depth) {
        self.note(root, depth, None);
        let mut pending = vec![(root, depth)];
        while let Some((id, depth)) = pending.pop() {
            let kind = &self.draft.tree[id].kind;
            if let &ExprKind::Conditional { condition, yes, no } = kind {
                let inner = depth.in_condition();
                self.note(id, inner, None);
                pending.extend([(condition, depth), (yes, inner), (no, inner)]);
                continue;
            }
            if let ExprKind::Call { function, .. } = kind {
                self.note(id, depth, self.depths.whole.get(function).copied());
            }
            kind.for_each_operand(|operand| pending.push((operand, depth)));
        }
    }

    fn note(&mut self, id: ExprId, depth: Depth, called: Option<Whole>) {
        self.own = self.own.max(depth.conditions + depth.loops);
        let here = Whole::shallow(self.draft.tree[id].at);
        self.whole.note(depth, called.unwrap_or(here));
    }
}
