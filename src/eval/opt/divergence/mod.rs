//! What does not vary within a batch of pixels: it is computed once for all of them.
//!
//! A value is uniform if all that it is made of is. A cell is, if all values stored to it are, and if whoever reads it was there when it
//! was stored: control that differs from pixel to pixel makes *regions* of the code, branches and scopes that some
//! pixels enter or leave and others do not, and each load must lie in the region of every store. A region that is entered again
//! while the cell lives, in a loop, would meet other pixels than before: then the cell varies, too.

mod follow;
mod solve;
mod watch;

use self::solve::Solve;
use crate::ir::alias::Groups;
use crate::ir::function::{Block, Cell, Cells, Flow, Node, Origin, Scope, Value};

/// What varies.
#[derive(Debug)]
pub(crate) struct Varying {
    values: Vec<bool>,
    cells: Vec<bool>,
    /// Whether pixels may come to a store of the cell that others do not, and later to a load with them.
    shared: Vec<bool>,
    scopes: Vec<bool>,
    constant: Vec<bool>,
}

impl Varying {
    /// Finds out.
    pub(crate) fn of(flow: &Flow, groups: &Groups) -> Self {
        let mut map = Map::new(flow, groups);
        map.block(&flow.body, 0);
        map.close();
        Solve::new(&map).run()
    }

    pub(crate) fn value(&self, value: Value) -> bool {
        self.values[value.0 as usize]
    }

    pub(crate) fn cell(&self, cell: Cell) -> bool {
        self.cells[cell.0 as usize]
    }

    /// Whether stores to the cell must leave alone the pixels that are elsewhere.
    pub(crate) fn is_shared(&self, cell: Cell) -> bool {
        self.shared[cell.0 as usize]
    }

    /// Whether some pixels may leave a scope while others stay in it.
    pub(crate) fn scope(&self, scope: Scope) -> bool {
        self.scopes[scope.0 as usize]
    }

    /// Whether a value is the same all over the frame, and takes no more than inputs and numbers to compute.
    pub(crate) fn is_constant(&self, value: Value) -> bool {
        self.constant[value.0 as usize]
    }
}

/// A block of the code.
#[derive(Debug, Clone, Copy)]
struct Place {
    what: What,
    /// The last place inside of it.
    last: usize,
}

#[derive(Debug, Clone, Copy)]
enum What {
    All,
    Branch(Value),
    Scope(Scope),
    Loop,
}

/// What is known of a cell, or of a group of cells.
#[derive(Debug, Clone, Copy, Default)]
struct Unit {
    /// The first and the last place that hold loads.
    loads: Option<(usize, usize)>,
    /// Where it is stored first.
    begins: Option<usize>,
}

struct Map<'a> {
    flow: &'a Flow,
    groups: &'a Groups,
    places: Vec<Place>,
    units: Vec<Unit>,
    /// Which values are stored, or lead to where one is stored, to which unit, and where.
    stores: Vec<(Value, usize, usize)>,
    /// Scopes that are left, where, and on which condition.
    leaves: Vec<(Scope, usize, Option<Value>)>,
    scopes: Vec<usize>,
    values: Vec<Value>,
}

impl<'a> Map<'a> {
    fn new(flow: &'a Flow, groups: &'a Groups) -> Self {
        Self {
            flow,
            groups,
            places: vec![Place {
                what: What::All,
                last: 0,
            }],
            units: vec![Unit::default(); flow.cells.len()],
            stores: Vec::new(),
            leaves: Vec::new(),
            scopes: vec![0; flow.scopes as usize],
            values: Vec::new(),
        }
    }

    fn enter(&mut self, block: &Block, what: What) {
        let place = self.places.len();
        self.places.push(Place { what, last: place });
        if let What::Scope(scope) = what {
            self.scopes[scope.0 as usize] = place;
        }
        self.block(block, place);
        self.places[place].last = self.places.len() - 1;
    }

    fn block(&mut self, block: &Block, here: usize) {
        for node in block {
            match node {
                Node::Let(value) => {
                    self.values.push(*value);
                    match self.flow.origin(*value) {
                        Origin::Load(cell) => self.load(cell, here),
                        Origin::LoadAt { cells, .. } => self.load(Cell(cells.first), here),
                        _ => {}
                    }
                }
                Node::Store { cell, value } => self.store(*cell, &[*value], here),
                Node::StoreAt {
                    cells: Cells { first, .. },
                    index,
                    value,
                    ..
                } => self.store(Cell(*first), &[*index, *value], here),
                Node::If { condition, yes, no } => {
                    self.enter(yes, What::Branch(*condition));
                    self.enter(no, What::Branch(*condition));
                }
                Node::Scope { scope, body } => self.enter(body, What::Scope(*scope)),
                Node::Loop { body, .. } => self.enter(body, What::Loop),
                Node::Leave(scope) => self.leaves.push((*scope, here, None)),
                Node::LeaveIf { scope, condition, .. } => self.leaves.push((*scope, here, Some(*condition))),
                Node::Round(_) | Node::Check { .. } | Node::Tell { .. } => {}
            }
        }
    }

    /// Completes what the walk could not know.
    fn close(&mut self) {
        self.places[0].last = self.places.len() - 1;
        for value in self.flow.output {
            if let Origin::Load(cell) = self.flow.origin(value) {
                self.load(cell, 0);
            }
        }
    }

    fn load(&mut self, cell: Cell, here: usize) {
        let loads = &mut self.units[self.groups.unit(cell)].loads;
        let (first, last) = loads.unwrap_or((here, here));
        *loads = Some((first.min(here), last.max(here)));
    }

    fn store(&mut self, cell: Cell, values: &[Value], here: usize) {
        let unit = self.groups.unit(cell);
        self.units[unit].begins.get_or_insert(here);
        self.stores
            .extend(values.iter().map(|&value| (value, unit, here)));
    }

    /// Whether one place is the other or lies in it.
    fn holds(&self, outer: usize, inner: usize) -> bool {
        (outer..=self.places[outer].last).contains(&inner)
    }
}
