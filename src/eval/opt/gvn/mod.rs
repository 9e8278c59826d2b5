//! Global value numbering: loads are replaced by stored values, and common subexpressions are computed once.
//!
//! The content of cells is tracked along each control flow path; where paths join, facts that hold on all of
//! them remain. The content of cells that a loop stores is unknown in and after it, unless the stored value
//! is the known one. Known words decide branches, select elements, and give the trip counts of loops.

mod changes;
mod control;
mod reduce;

use self::changes::Changes;
use self::control::{OpenLoop, OpenScope, UnrollBudget};
use crate::ir::{
    AliasGroups, Block, Cell, Cells, Function, NONE, Node, Operation, Predicate, Value, ValueDef,
};
use crate::opt::rollback::RollbackMap;

/// Alias groups of more cells are not tracked cell by cell.
const MAX_TRACKED_CELLS: u32 = 256;

/// Evaluates an operation on words. Returns `None` for an operation on floats.
pub(crate) type Fold = fn(Operation, [u32; 3]) -> Option<u32>;

/// Rewrites a function; `fold` has the semantics of operations. A traced run may replace values, so that
/// common subexpressions are not merged then.
pub(crate) fn number_values(function: &mut Function, fold: Fold, traced: bool) {
    let groups = AliasGroups::new(function);
    let body = std::mem::take(&mut function.body);
    let templates = std::mem::take(&mut function.defs);
    let scopes = std::mem::take(&mut function.scopes);
    let mut pass = ValueNumbering {
        epochs: vec![0; groups.ranges().len()],
        groups,
        replacements: vec![NONE; templates.len()],
        templates,
        changes: Changes::new(&body, scopes, function.loops.len()),
        is_constant: Vec::new(),
        constants: RollbackMap::default(),
        function,
        fold,
        traced,
        cell_values: RollbackMap::default(),
        available: RollbackMap::default(),
        open_scopes: Vec::new(),
        depths: vec![0; scopes as usize],
        open_loops: Vec::new(),
        is_reachable: true,
        budget: UnrollBudget::default(),
        path_budget: control::MAX_PATH_CHANGES,
    };
    pass.import_constants();
    let body = pass.block(&body);
    let output = pass.function.output.map(|value| pass.output(value));
    function.body = body;
    function.output = output;
}

struct ValueNumbering<'a> {
    /// The function that is written.
    function: &'a mut Function,
    groups: AliasGroups,
    /// The number of stores to each group so far.
    epochs: Vec<u32>,
    /// The definitions of the function that is read.
    templates: Vec<ValueDef>,
    /// The new value of each template; in an unrolled loop, that of the latest iteration.
    replacements: Vec<Value>,
    /// The changes made by the loops and scopes of the function that is read.
    changes: Changes,
    /// Which values depend on inputs of the frame and constants only.
    is_constant: Vec<bool>,
    /// The values of constants.
    constants: RollbackMap<ValueDef, Value>,
    fold: Fold,
    traced: bool,
    cell_values: RollbackMap<Cell, Value>,
    available: RollbackMap<(ValueDef, u32), Value>,
    /// The open scopes.
    open_scopes: Vec<OpenScope>,
    /// The index of each scope of the function that is read, among the open ones.
    depths: Vec<usize>,
    /// The open loops.
    open_loops: Vec<OpenLoop>,
    /// Whether control flow reaches this point.
    is_reachable: bool,
    budget: UnrollBudget,
    /// How many changes may still be stored for paths that leave scopes.
    path_budget: usize,
}

impl ValueNumbering<'_> {
    fn block(&mut self, block: &[Node]) -> Block {
        let available = self.available.mark();
        let mut out = Block::with_capacity(block.len());
        self.nodes(block, &mut out);
        self.available.roll_back(available);
        out
    }

    fn nodes(&mut self, block: &[Node], out: &mut Block) {
        for node in block {
            if !self.is_reachable || self.budget.is_full() {
                break;
            }
            self.budget.read();
            self.node(node, out);
        }
    }

    fn node(&mut self, node: &Node, out: &mut Block) {
        match node {
            Node::Let(value) => out.extend(self.compute(*value).map(Node::Let)),
            Node::If { condition, yes, no } => {
                let condition = self.replacements[condition.0 as usize];
                match self.known_word(condition) {
                    Some(word) => self.nodes(if word == 0 { no } else { yes }, out),
                    None => self.branch(condition, [yes, no], out),
                }
            }
            Node::Scope { scope, body } => self.scope(*scope, body, out),
            Node::Loop { id, body } => {
                if let Some(nodes) = self.unroll(body) {
                    out.extend(nodes);
                } else {
                    self.rewrite_loop(*id, body, out);
                }
            }
            // Only nodes without blocks are cloned: unreachable blocks cost nothing, however often they are
            // skipped.
            _ => self.single(node.clone(), out),
        }
    }

    /// Rewrites a node without child blocks.
    fn single(&mut self, mut node: Node, out: &mut Block) {
        node.for_each_value_mut(|value| *value = self.replacements[value.0 as usize]);
        match node {
            Node::Store { cell, value } => self.store(cell, value, out),
            Node::StoreAt {
                cells,
                offset,
                index,
                value,
            } => {
                if let Some(index) = self.known_word(index) {
                    self.store(cells.clamped(offset, index), value, out);
                } else {
                    self.invalidate(cells);
                    out.push(node);
                }
            }
            Node::Break(scope) => self.rewrite_break(scope, out),
            Node::BreakIf {
                scope,
                condition,
                when,
            } => {
                if let Some(word) = self.known_word(condition) {
                    self.budget.decide(self.depths[scope.0 as usize]);
                    if (word != 0) == when {
                        self.rewrite_break(scope, out);
                    }
                } else {
                    let scope = self.record_exit(scope);
                    out.push(Node::BreakIf {
                        scope,
                        condition,
                        when,
                    });
                }
            }
            Node::Check {
                predicate: Predicate::ConstantZeros,
                values,
                ..
            } if !self.may_be_folded(values) => {}
            _ => out.push(node),
        }
    }

    /// Whether constant propagation in a compiler may see the quotient as zero by zero.
    fn may_be_folded(&self, [dividend, divisor]: [Value; 2]) -> bool {
        let known = |value: Value| self.is_constant[value.0 as usize];
        let is_number =
            matches!(self.function.def(divisor), ValueDef::Float(number) if f64::from_bits(number) != 0.0);
        known(dividend) && known(divisor) && !is_number
    }

    fn store(&mut self, cell: Cell, value: Value, out: &mut Block) {
        if self.cell_values.get(cell) != Some(value) {
            self.bump_epoch(cell);
            self.set_cell(cell, value);
            out.push(Node::Store { cell, value });
        }
    }

    fn branch(&mut self, condition: Value, branches: [&[Node]; 2], out: &mut Block) {
        let mark = self.cell_values.mark();
        let mut paths = Vec::new();
        let [yes, no] = branches.map(|branch| {
            self.is_reachable = true;
            let branch = self.block(branch);
            if self.is_reachable {
                paths.push(self.cell_values.changes_since(mark));
            }
            self.cell_values.roll_back(mark);
            branch
        });
        self.merge_paths(paths);
        out.push(Node::If { condition, yes, no });
    }

    fn set_cell(&mut self, cell: Cell, value: Value) {
        let group = self.groups.find(cell);
        if group.is_none_or(|group| self.groups.ranges()[group].count <= MAX_TRACKED_CELLS) {
            self.cell_values.set(cell, Some(value));
        }
    }

    fn bump_epoch(&mut self, cell: Cell) {
        if let Some(group) = self.groups.find(cell) {
            self.epochs[group] += 1;
        }
    }

    fn invalidate(&mut self, cells: Cells) {
        let Some(group) = self.groups.find(Cell(cells.first)) else {
            return;
        };
        self.epochs[group] += 1;
        if self.groups.ranges()[group].count <= MAX_TRACKED_CELLS {
            for cell in cells.first..cells.first + cells.count {
                self.cell_values.set(Cell(cell), None);
            }
        }
    }
}

// Construction of values: common subexpressions are reused, and known words are folded.

impl ValueNumbering<'_> {
    /// Imports constants and inputs.
    fn import_constants(&mut self) {
        for at in 0..self.templates.len() {
            let def = self.templates[at];
            match def {
                ValueDef::Word(_) | ValueDef::Float(_) => self.replacements[at] = self.constant(def),
                ValueDef::Input(..)
                | ValueDef::Extent { .. }
                | ValueDef::Parameter(..)
                | ValueDef::FragCoord(_) => {
                    self.replacements[at] = self.push_value(def);
                }
                ValueDef::Operation(..)
                | ValueDef::Load(_)
                | ValueDef::LoadAt { .. }
                | ValueDef::Texel { .. } => {}
            }
        }
    }

    fn push_value(&mut self, def: ValueDef) -> Value {
        let mut constant = !matches!(
            def,
            ValueDef::Parameter(..)
                | ValueDef::FragCoord(_)
                | ValueDef::Load(_)
                | ValueDef::LoadAt { .. }
                | ValueDef::Texel { .. }
        );
        def.for_each_operand(|operand| constant &= self.is_constant[operand.0 as usize]);
        if !constant {
            self.budget.compute();
        }
        self.is_constant.push(constant);
        self.function.defs.push(def);
        Value(self.function.defs.len() as u32 - 1)
    }

    /// Returns the new value of an output; a load that is never executed if no pixel reaches the end.
    fn output(&mut self, template: Value) -> Value {
        match self.replacements[template.0 as usize] {
            NONE => self.push_value(self.templates[template.0 as usize]),
            value => value,
        }
    }

    /// Returns the value of a word or float constant.
    fn constant(&mut self, def: ValueDef) -> Value {
        if let Some(value) = self.constants.get(def) {
            return value;
        }
        let value = self.push_value(def);
        self.constants.set(def, Some(value));
        value
    }

    /// Returns the constant of a value, if it is a word constant.
    fn known_word(&self, value: Value) -> Option<u32> {
        match self.function.def(value) {
            ValueDef::Word(word) => Some(word),
            _ => None,
        }
    }

    /// Rewrites a value; returns the new one if it must be computed here.
    fn compute(&mut self, template: Value) -> Option<Value> {
        let at = template.0 as usize;
        let replacements = &self.replacements;
        let def = self.templates[at].map_operands(|operand| replacements[operand.0 as usize]);
        let def = match def {
            ValueDef::LoadAt {
                cells, offset, index, ..
            } => {
                let index = self.known_word(index);
                index.map_or(def, |index| ValueDef::Load(cells.clamped(offset, index)))
            }
            _ => self.reduce(def),
        };
        let key = (def, self.epoch(def));
        let found = match def {
            ValueDef::Word(_)
            | ValueDef::Float(_)
            | ValueDef::Input(..)
            | ValueDef::Extent { .. }
            | ValueDef::Parameter(..)
            | ValueDef::FragCoord(_) => Some(self.replacements[at]),
            ValueDef::Load(cell) => self.cell_values.get(cell),
            ValueDef::Operation(operation, operands) => self.fold_operation(operation, operands),
            _ => None,
        };
        let found = found.or_else(|| self.available.get(key).filter(|_| !self.traced));
        if let Some(found) = found {
            self.replacements[at] = found;
            return None;
        }
        let value = self.push_value(def);
        self.replacements[at] = value;
        match def {
            ValueDef::Load(cell) => self.set_cell(cell, value),
            _ => self.available.set(key, Some(value)),
        }
        Some(value)
    }

    /// Folds an operation on known words, or a selection with a known condition.
    fn fold_operation(&mut self, operation: Operation, operands: [Value; 3]) -> Option<Value> {
        let words = operands.map(|value| {
            if value == NONE {
                Some(0)
            } else {
                self.known_word(value)
            }
        });
        match (operation, words) {
            (Operation::Select | Operation::SelectWord, [Some(word), ..]) => {
                Some(operands[if word == 0 { 2 } else { 1 }])
            }
            (_, [Some(a), Some(b), Some(c)]) => {
                (self.fold)(operation, [a, b, c]).map(|word| self.constant(ValueDef::Word(word)))
            }
            _ => None,
        }
    }

    fn epoch(&self, def: ValueDef) -> u32 {
        let ValueDef::LoadAt { cells, .. } = def else {
            return 0;
        };
        let group = self.groups.find(Cell(cells.first));
        group.map_or(0, |group| self.epochs[group])
    }
}
