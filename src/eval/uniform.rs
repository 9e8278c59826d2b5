//! What does not vary within a batch of pixels: it is computed once for all of them.
//!
//! A value is uniform if all that it is made of is. A cell is, if all values stored to it are, and if whoever reads it was there when it
//! was stored: control that differs from pixel to pixel makes *regions* of the code, branches and scopes that some
//! pixels enter or leave and others do not, and each load must lie in the region of every store. A region that is entered again
//! while the cell lives, in a loop, would meet other pixels than before: then the cell varies, too.

use super::flow::{Block, Cell, Cells, Flow, Node, Origin, Scope, Value};
use super::group::Groups;

/// What varies.
#[derive(Debug)]
pub(super) struct Varying {
    values: Vec<bool>,
    cells: Vec<bool>,
    /// Whether pixels may come to a store of the cell that others do not, and later to a load with them.
    shared: Vec<bool>,
    scopes: Vec<bool>,
    constant: Vec<bool>,
}

impl Varying {
    /// Finds out.
    pub(super) fn of(flow: &Flow, groups: &Groups) -> Self {
        let mut map = Map::new(flow, groups);
        map.block(&flow.body, 0);
        map.close();
        map.solve()
    }

    pub(super) fn value(&self, value: Value) -> bool {
        self.values[value.0 as usize]
    }

    pub(super) fn cell(&self, cell: Cell) -> bool {
        self.cells[cell.0 as usize]
    }

    /// Whether stores to the cell must leave alone the pixels that are elsewhere.
    pub(super) fn is_shared(&self, cell: Cell) -> bool {
        self.shared[cell.0 as usize]
    }

    /// Whether some pixels may leave a scope while others stay in it.
    pub(super) fn scope(&self, scope: Scope) -> bool {
        self.scopes[scope.0 as usize]
    }

    /// Whether a value is the same all over the frame, and takes no more than inputs and numbers to compute.
    pub(super) fn is_constant(&self, value: Value) -> bool {
        self.constant[value.0 as usize]
    }
}

/// A block of the code.
#[derive(Debug, Clone, Copy)]
struct Place {
    parent: usize,
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
#[derive(Debug, Clone, Default)]
struct Unit {
    /// Values stored, indices stored to, and where.
    stores: Vec<(Value, usize)>,
    /// The innermost place that holds all loads.
    loads: Option<usize>,
    /// Where it is stored first.
    begins: Option<usize>,
    varies: bool,
    shared: bool,
}

struct Map<'a> {
    flow: &'a Flow,
    groups: &'a Groups,
    places: Vec<Place>,
    units: Vec<Unit>,
    /// Which units are loaded where.
    loads: Vec<(usize, usize)>,
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
                parent: 0,
                what: What::All,
                last: 0,
            }],
            units: vec![Unit::default(); flow.cells.len()],
            loads: Vec::new(),
            leaves: Vec::new(),
            scopes: vec![0; flow.scopes as usize],
            values: Vec::new(),
        }
    }

    /// The unit of a cell is its own, or that of the first of its group.
    fn unit(&self, cell: Cell) -> usize {
        let group = self.groups.find(cell);
        group.map_or(cell.0, |group| self.groups.ranges()[group].first) as usize
    }

    fn enter(&mut self, block: &Block, parent: usize, what: What) {
        let place = self.places.len();
        self.places.push(Place {
            parent,
            what,
            last: place,
        });
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
                    self.enter(yes, here, What::Branch(*condition));
                    self.enter(no, here, What::Branch(*condition));
                }
                Node::Scope { scope, body } => self.enter(body, here, What::Scope(*scope)),
                Node::Loop { body } => self.enter(body, here, What::Loop),
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
        for (unit, here) in std::mem::take(&mut self.loads) {
            let whole = self.units[unit]
                .loads
                .map_or(here, |before| self.common(before, here));
            self.units[unit].loads = Some(whole);
        }
    }

    fn load(&mut self, cell: Cell, here: usize) {
        let unit = self.unit(cell);
        self.loads.push((unit, here));
    }

    fn store(&mut self, cell: Cell, values: &[Value], here: usize) {
        let unit = self.unit(cell);
        let unit = &mut self.units[unit];
        unit.begins.get_or_insert(here);
        unit.stores.extend(values.iter().map(|&value| (value, here)));
    }

    /// Whether one place is the other or lies in it.
    fn holds(&self, outer: usize, inner: usize) -> bool {
        (outer..=self.places[outer].last).contains(&inner)
    }

    fn common(&self, a: usize, b: usize) -> usize {
        let mut outer = a;
        while !self.holds(outer, b) {
            outer = self.places[outer].parent;
        }
        outer
    }

    fn solve(mut self) -> Varying {
        let mut varying = Varying {
            values: self
                .flow
                .origins
                .iter()
                .map(|origin| matches!(origin, Origin::FragCoord(_)))
                .collect(),
            cells: Vec::new(),
            shared: Vec::new(),
            scopes: vec![false; self.flow.scopes as usize],
            constant: Vec::new(),
        };
        while self.step(&mut varying) {}
        for cell in 0..self.flow.cells.len() as u32 {
            let unit = &self.units[self.unit(Cell(cell))];
            varying.cells.push(unit.varies);
            varying.shared.push(unit.shared);
        }
        varying.constant = vec![false; self.flow.origins.len()];
        for (at, origin) in self.flow.origins.iter().enumerate() {
            varying.constant[at] = matches!(origin, Origin::Float(_) | Origin::Word(_) | Origin::Input(..));
        }
        for &value in &self.values {
            if let origin @ Origin::Operation(..) = self.flow.origin(value) {
                let mut all = true;
                origin.for_each_operand(|operand| all &= varying.is_constant(operand));
                varying.constant[value.0 as usize] = all;
            }
        }
        varying
    }

    /// One round; whether more was found to vary.
    fn step(&mut self, varying: &mut Varying) -> bool {
        let mut changed = false;
        for &value in &self.values {
            if varying.value(value) {
                continue;
            }
            let origin = self.flow.origin(value);
            let mut varies = match origin {
                Origin::FragCoord(_) | Origin::Texel { .. } => true,
                Origin::Load(cell) => self.units[self.unit(cell)].varies,
                Origin::LoadAt { cells, .. } => self.units[self.unit(Cell(cells.first))].varies,
                _ => false,
            };
            origin.for_each_operand(|operand| varies |= varying.value(operand));
            varying.values[value.0 as usize] = varies;
            changed |= varies;
        }
        for &(scope, here, condition) in &self.leaves {
            if !varying.scope(scope) && self.some_leave(scope, here, condition, varying) {
                varying.scopes[scope.0 as usize] = true;
                changed = true;
            }
        }
        for unit in 0..self.units.len() {
            let Unit { varies, shared, .. } = self.units[unit];
            if varies && shared {
                continue;
            }
            let shared = shared || self.meets_others(&self.units[unit], varying);
            let varies = shared
                || self.units[unit]
                    .stores
                    .iter()
                    .any(|&(value, _)| varying.value(value));
            let unit = &mut self.units[unit];
            changed |= varies != unit.varies || shared != unit.shared;
            unit.varies = varies;
            unit.shared = shared;
        }
        changed
    }

    /// Whether only some of the pixels in a scope may come to where it is left.
    fn some_leave(&self, scope: Scope, here: usize, condition: Option<Value>, varying: &Varying) -> bool {
        if condition.is_some_and(|condition| varying.value(condition)) {
            return true;
        }
        let end = self.scopes[scope.0 as usize];
        let mut at = here;
        while at != end && at != 0 {
            if self.is_region(at, varying) {
                return true;
            }
            at = self.places[at].parent;
        }
        false
    }

    fn is_region(&self, place: usize, varying: &Varying) -> bool {
        match self.places[place].what {
            What::Branch(condition) => varying.value(condition),
            What::Scope(scope) => varying.scope(scope),
            What::All | What::Loop => false,
        }
    }

    fn region(&self, mut place: usize, varying: &Varying) -> usize {
        while place != 0 && !self.is_region(place, varying) {
            place = self.places[place].parent;
        }
        place
    }

    /// Whether a load may meet pixels that were elsewhere when a cell was stored.
    fn meets_others(&self, unit: &Unit, varying: &Varying) -> bool {
        let (Some(loads), Some(begins)) = (unit.loads, unit.begins) else {
            return false;
        };
        let mut checked = usize::MAX;
        unit.stores.iter().any(|&(_, here)| {
            if here == checked {
                return false;
            }
            checked = here;
            let region = self.region(here, varying);
            !self.holds(region, loads) || self.is_entered_again(region, begins)
        })
    }

    /// Whether a region may be entered more than once after a cell began.
    fn is_entered_again(&self, region: usize, begins: usize) -> bool {
        if self.holds(region, begins) {
            return false;
        }
        let mut at = self.places[region].parent;
        while at != begins {
            if at == 0 || matches!(self.places[at].what, What::Loop) {
                return true;
            }
            at = self.places[at].parent;
        }
        false
    }
}
