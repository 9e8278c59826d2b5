//! Control flow: joins at the ends of scopes, loops, and loop unrolling.

use std::ops::Range;

use super::ValueNumbering;
use super::changes::Change;
use crate::ir::{Block, Cell, LoopId, NONE, Node, Scope, Value};
use crate::opt::rollback::Map;

/// The maximum number of changes stored for all paths that leave scopes. Each path stores all changes since
/// the scope began; thousands of paths in one scope would exceed the memory.
pub(super) const MAX_PATH_CHANGES: usize = 1 << 22;

/// The changes on a path up to the point where paths join.
pub(super) type PathChanges = Map<Cell, Option<Value>>;

/// An open scope.
#[derive(Debug)]
pub(super) struct OpenScope {
    scope: Scope,
    /// Where the changes in the scope begin.
    mark: usize,
    /// The paths that leave the scope; none, and no further paths, where the budget is exhausted.
    pub(super) paths: Vec<Option<PathChanges>>,
}

impl ValueNumbering<'_> {
    pub(super) fn scope(&mut self, template: Scope, body: &[Node], out: &mut Block) {
        let scope = Scope(self.function.scopes);
        self.function.scopes += 1;
        let mark = self.cell_values.mark();
        self.depths[template.0 as usize] = self.open_scopes.len();
        self.open_scopes.push(OpenScope {
            scope,
            mark,
            paths: Vec::new(),
        });
        let mut body = self.block(body);
        let mut paths = self.open_scopes.pop().map_or_else(Vec::new, |exit| exit.paths);
        let mut leaves = paths.len();
        if matches!(body.last(), Some(&Node::Break(left)) if left == scope) {
            body.pop();
            leaves -= 1;
        }
        if !paths.is_empty() {
            if self.is_reachable {
                paths.push(self.path_since(mark));
            }
            self.cell_values.roll_back(mark);
            if let Some(paths) = paths.into_iter().collect() {
                self.merge_paths(paths);
            } else {
                self.is_reachable = true;
                self.invalidate_stores(self.changes.of_scope(template));
            }
        }
        if leaves == 0 {
            out.extend(body);
        } else {
            out.push(Node::Scope { scope, body });
        }
    }

    /// Rewrites a break of all active pixels.
    pub(super) fn rewrite_break(&mut self, template: Scope, out: &mut Block) {
        let scope = self.record_exit(template);
        self.is_reachable = false;
        out.push(Node::Break(scope));
    }

    /// Records a path out of a scope, and returns the new scope.
    pub(super) fn record_exit(&mut self, template: Scope) -> Scope {
        let depth = self.depths[template.0 as usize];
        let OpenScope {
            scope,
            mark,
            ref paths,
        } = self.open_scopes[depth];
        let lost = matches!(paths.last(), Some(None));
        let mut path = if lost { None } else { self.path_since(mark) };
        // Pixels that exit wait; the loop may overwrite its cells meanwhile.
        let inside = self.open_loops.partition_point(|open| open.depth <= depth);
        if let (Some(path), Some(open)) = (&mut path, self.open_loops.get(inside)) {
            path.extend(self.cell_values.keys_since(open.mark).map(|cell| (cell, None)));
        }
        self.open_scopes[depth].paths.push(path);
        scope
    }

    /// Returns the changes since a mark, if the budget allows.
    fn path_since(&mut self, mark: usize) -> Option<PathChanges> {
        self.path_budget = self.path_budget.checked_sub(self.cell_values.mark() - mark)?;
        Some(self.cell_values.changes_since(mark))
    }

    /// Joins paths: keeps what holds on all of them.
    pub(super) fn merge_paths(&mut self, paths: Vec<PathChanges>) {
        let count = paths.len();
        self.is_reachable = count > 0;
        // The common value of each cell on the paths that change it, and the number of these paths.
        let mut merged: Map<Cell, (Option<Value>, usize)> = Map::default();
        for (cell, value) in paths.into_iter().flatten() {
            let (common, changing_paths) = merged.entry(cell).or_insert((value, 0));
            *common = common.filter(|_| *common == value);
            *changing_paths += 1;
        }
        let mut merged: Vec<_> = merged.into_iter().collect();
        merged.sort_unstable_by_key(|(cell, _)| *cell);
        for (cell, (value, changing_paths)) in merged {
            let everywhere = changing_paths == count || self.cell_values.get(cell) == value;
            self.cell_values.set(cell, value.filter(|_| everywhere));
        }
    }
}

// Loops that are not unrolled: the content of cells that they store is unknown.

/// An open loop.
#[derive(Debug)]
pub(super) struct OpenLoop {
    /// The number of enclosing scopes.
    pub(super) depth: usize,
    /// Where the changes in the loop begin.
    pub(super) mark: usize,
}

impl ValueNumbering<'_> {
    /// Rewrites a loop that is not unrolled.
    pub(super) fn rewrite_loop(&mut self, id: LoopId, body: &[Node], out: &mut Block) {
        let part = self.changes.of_loop(id);
        for at in part.clone() {
            if let Change::Computed(value) = self.changes.get(at) {
                self.replacements[value.0 as usize] = NONE;
            }
        }
        for at in part {
            match self.changes.get(at) {
                Change::Computed(_) => {}
                Change::Stored(cell, value) => {
                    self.bump_epoch(cell);
                    if self.cell_values.get(cell) != Some(self.replacements[value.0 as usize]) {
                        self.cell_values.set(cell, None);
                    }
                }
                Change::StoredAt(cells) => self.invalidate(cells),
            }
        }
        self.open_loops.push(OpenLoop {
            depth: self.open_scopes.len(),
            mark: self.cell_values.mark(),
        });
        let body = self.block(body);
        self.open_loops.pop();
        self.is_reachable = false;
        out.push(Node::Loop { id, body });
    }

    /// Forgets all cells that some changes store to.
    pub(super) fn invalidate_stores(&mut self, changes: Range<usize>) {
        for at in changes {
            match self.changes.get(at) {
                Change::Computed(_) => {}
                Change::Stored(cell, _) => self.cell_values.set(cell, None),
                Change::StoredAt(cells) => self.invalidate(cells),
            }
        }
    }
}

// Loop unrolling, for loops with known trip counts: values that depend on the induction variable alone are
// then computed once for a frame, and elements that it selects are cells like any others.

/// The maximum number of values that a loop nest may compute per batch once it is unrolled.
const MAX_UNROLLED_VALUES: usize = 1 << 11;

/// The maximum number of nodes read in all attempts of a shader together, failed ones included; it bounds the
/// cost of unrolling.
const MAX_TRIED_NODES: usize = 1 << 16;

/// The remaining budget of attempts to unroll.
#[derive(Debug)]
pub(super) struct UnrollBudget {
    /// The nodes that may still be read in attempts, for the whole shader.
    nodes_left: usize,
    /// The values that the current attempt may still compute; nested attempts share it.
    values_left: Option<usize>,
    /// The depth of the outermost scope with a decided break.
    outermost_decided: usize,
}

impl Default for UnrollBudget {
    fn default() -> Self {
        Self {
            nodes_left: MAX_TRIED_NODES,
            values_left: None,
            outermost_decided: usize::MAX,
        }
    }
}

impl UnrollBudget {
    /// Charges a node that is read.
    pub(super) fn read(&mut self) {
        if self.values_left.is_some() {
            self.nodes_left = self.nodes_left.saturating_sub(1);
        }
    }

    /// Charges a value.
    pub(super) fn compute(&mut self) {
        if let Some(values_left) = &mut self.values_left {
            *values_left = values_left.saturating_sub(1);
        }
    }

    /// Whether the budget is exhausted.
    pub(super) fn is_full(&self) -> bool {
        self.values_left
            .is_some_and(|values_left| values_left.min(self.nodes_left) == 0)
    }

    /// Records that a break out of the scope at this depth was decided.
    pub(super) fn decide(&mut self, depth: usize) {
        self.outermost_decided = self.outermost_decided.min(depth);
    }
}

/// The state at the start of an attempt.
struct Checkpoint {
    values: usize,
    scopes: u32,
    cell_values: usize,
    available: usize,
    constants: usize,
    /// The number of paths out of each open scope.
    paths: Vec<usize>,
}

impl ValueNumbering<'_> {
    /// Unrolls a loop, if each iteration knows whether a next one follows.
    pub(super) fn unroll(&mut self, body: &[Node]) -> Option<Block> {
        // An attempt has a cost of its own.
        self.budget.nodes_left = self.budget.nodes_left.checked_sub(1)?;
        let outermost = self.budget.values_left.is_none();
        if outermost {
            self.budget.values_left = Some(MAX_UNROLLED_VALUES);
        }
        let around = self.budget.outermost_decided;
        let checkpoint = self.checkpoint();
        let mut out = Block::new();
        loop {
            self.budget.outermost_decided = usize::MAX;
            self.nodes(body, &mut out);
            if !self.is_reachable
                || self.budget.is_full()
                || self.budget.outermost_decided >= checkpoint.paths.len()
            {
                break;
            }
        }
        let done = !self.is_reachable && !self.budget.is_full();
        if outermost {
            self.budget.values_left = None;
        }
        self.budget.decide(around);
        if !done {
            self.roll_back(&checkpoint);
        }
        done.then_some(out)
    }

    fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            values: self.function.defs.len(),
            scopes: self.function.scopes,
            cell_values: self.cell_values.mark(),
            available: self.available.mark(),
            constants: self.constants.mark(),
            paths: self.open_scopes.iter().map(|exit| exit.paths.len()).collect(),
        }
    }

    /// Restores the state at the start of an attempt.
    ///
    /// Epochs are not restored: they only grow, and values computed in a past epoch are not looked up.
    /// Replacements of values of the body are not restored: each value is computed again before its use, and
    /// [`Self::repeat`] clears them first. The path budget is not restored: it bounds time, too.
    fn roll_back(&mut self, checkpoint: &Checkpoint) {
        self.is_reachable = true;
        self.cell_values.roll_back(checkpoint.cell_values);
        self.available.roll_back(checkpoint.available);
        for (exit, &paths) in self.open_scopes.iter_mut().zip(&checkpoint.paths) {
            exit.paths.truncate(paths);
        }
        self.constants.roll_back(checkpoint.constants);
        self.function.defs.truncate(checkpoint.values);
        self.is_constant.truncate(checkpoint.values);
        self.function.scopes = checkpoint.scopes;
    }
}
