//! Statements, choices and calls nested so deep that lavapipe loses count: those of a function side by side,
//! each under a flag that tells whether it runs (`flags`), and long `a ? x : b ? y : …` likewise (`chain`).
//!
//! Mesa's software driver inlines all calls and keeps the conditions that pixels are under on a stack of 80,
//! loops on another; what is nested deeper runs whatever its condition says. Its compiler nests what follows
//! a conditional `return` or `continue`, too.

mod chain;
mod flags;

use std::collections::{HashMap, HashSet};

use super::super::tree::{Block, ExprId, ExprKind, FunctionId, Statement, StatementKind};
use super::draft::Draft;
use super::walk;

/// How deep the driver may nest what it is given: 79 with an `else`, less what helper functions and its own
/// passes add.
const DEEPEST: u32 = 64;
/// Functions that nest no deeper by themselves are left as they are, first and then.
const KEPT: [u32; 2] = [8, 2];

pub(super) fn run(draft: &mut Draft) {
    chain::run(draft);
    for kept in KEPT {
        let depths = Depths::of(draft);
        if depths.whole(draft.main_image) <= DEEPEST {
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
}

/// How deep functions nest.
struct Depths {
    /// Without what the functions that they call nest.
    own: HashMap<FunctionId, u32>,
    /// With it.
    whole: HashMap<FunctionId, u32>,
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
                        whole: 0,
                    };
                    walk.block(body, 0);
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

    fn whole(&self, function: FunctionId) -> u32 {
        self.whole.get(&function).copied().unwrap_or(0)
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

/// One walk through a function, which finds its deepest place.
struct Walk<'a> {
    draft: &'a Draft,
    depths: &'a Depths,
    own: u32,
    whole: u32,
}

impl Walk<'_> {
    /// Statements at that depth; whether control may leave them in their midst.
    fn block(&mut self, block: &[Statement], mut depth: u32) -> bool {
        let mut leaves = false;
        for statement in block {
            if self.statement(statement, depth) {
                // The rest of the block nests in an `else` of it.
                leaves = true;
                depth += 1;
            }
        }
        leaves
    }

    fn statement(&mut self, statement: &Statement, depth: u32) -> bool {
        if let StatementKind::If { arms, otherwise } = &statement.kind {
            let mut leaves = false;
            let mut inner = depth;
            for arm in arms {
                // Each `else if` nests in the `else` before.
                self.expression(arm.condition, inner);
                inner += 1;
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
        let inner = depth + u32::from(!matches!(statement.kind, StatementKind::Block(_)));
        for body in walk::inner(statement) {
            leaves |= self.block(body, inner);
        }
        leaves
    }

    fn expression(&mut self, root: ExprId, depth: u32) {
        self.note(depth, 0);
        let mut pending = vec![(root, depth)];
        while let Some((id, depth)) = pending.pop() {
            let kind = &self.draft.tree[id].kind;
            if let &ExprKind::Conditional { condition, yes, no } = kind {
                self.note(depth + 1, 0);
                pending.extend([(condition, depth), (yes, depth + 1), (no, depth + 1)]);
                continue;
            }
            if let ExprKind::Call { function, .. } = kind {
                self.note(depth, self.depths.whole(*function));
            }
            kind.for_each_operand(|operand| pending.push((operand, depth)));
        }
    }

    fn note(&mut self, depth: u32, called: u32) {
        self.own = self.own.max(depth);
        self.whole = self.whole.max(depth + called);
    }
}
