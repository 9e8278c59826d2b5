//! Divergence analysis: values that are uniform within a batch of pixels are computed once for all of them.
//!
//! A value is uniform if its operands are. A cell is uniform if all values stored to it are, and if every
//! reader was active at the store: divergent control flow makes *regions* of the code, branches and scopes
//! that some pixels enter or leave and others do not, and each load must lie in the region of every store. If
//! a region is entered again while the cell is live, in a loop, other pixels may be active than before, so
//! that the cell is divergent, too.

use crate::ir::{AliasGroups, Block, Cell, Cells, Function, Node, Scope, Value, ValueDef};

/// The result of the analysis.
#[derive(Debug)]
pub(crate) struct Divergence {
    values: Vec<bool>,
    cells: Vec<bool>,
    /// Whether only some pixels may execute a store to the cell, and later load it together with the others.
    shared: Vec<bool>,
    scopes: Vec<bool>,
    constant: Vec<bool>,
}

impl Divergence {
    /// Analyzes a function.
    pub(crate) fn new(function: &Function, groups: &AliasGroups) -> Self {
        let mut map = CodeMap::new(function, groups);
        map.block(&function.body, 0);
        map.close();
        Solver::new(&map).run()
    }

    pub(crate) fn value(&self, value: Value) -> bool {
        self.values[value.0 as usize]
    }

    pub(crate) fn cell(&self, cell: Cell) -> bool {
        self.cells[cell.0 as usize]
    }

    /// Whether stores to the cell must preserve the values of inactive pixels.
    pub(crate) fn is_shared(&self, cell: Cell) -> bool {
        self.shared[cell.0 as usize]
    }

    /// Whether some pixels may leave a scope while others stay in it.
    pub(crate) fn scope(&self, scope: Scope) -> bool {
        self.scopes[scope.0 as usize]
    }

    /// Whether a value is the same in the whole frame and depends on inputs and constants only.
    pub(crate) fn is_constant(&self, value: Value) -> bool {
        self.constant[value.0 as usize]
    }
}

/// A block of the code.
#[derive(Debug, Clone, Copy)]
struct Place {
    kind: PlaceKind,
    /// The last place inside of it, in preorder.
    last: usize,
}

#[derive(Debug, Clone, Copy)]
enum PlaceKind {
    All,
    Branch(Value),
    Scope(Scope),
    Loop,
}

/// The accesses of a cell, or of a group of cells.
#[derive(Debug, Clone, Copy, Default)]
struct Unit {
    /// The first and the last place with a load.
    loads: Option<(usize, usize)>,
    /// The place of the first store.
    begins: Option<usize>,
}

struct CodeMap<'a> {
    function: &'a Function,
    groups: &'a AliasGroups,
    places: Vec<Place>,
    units: Vec<Unit>,
    /// Stored values and indices of stores, with the unit and the place.
    stores: Vec<(Value, usize, usize)>,
    /// Breaks: the scope, the place, and the condition.
    leaves: Vec<(Scope, usize, Option<Value>)>,
    scopes: Vec<usize>,
    values: Vec<Value>,
}

impl<'a> CodeMap<'a> {
    fn new(function: &'a Function, groups: &'a AliasGroups) -> Self {
        Self {
            function,
            groups,
            places: vec![Place {
                kind: PlaceKind::All,
                last: 0,
            }],
            units: vec![Unit::default(); function.cells.len()],
            stores: Vec::new(),
            leaves: Vec::new(),
            scopes: vec![0; function.scopes as usize],
            values: Vec::new(),
        }
    }

    fn enter(&mut self, block: &Block, kind: PlaceKind) {
        let place = self.places.len();
        self.places.push(Place { kind, last: place });
        if let PlaceKind::Scope(scope) = kind {
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
                    match self.function.def(*value) {
                        ValueDef::Load(cell) => self.load(cell, here),
                        ValueDef::LoadAt { cells, .. } => self.load(Cell(cells.first), here),
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
                    self.enter(yes, PlaceKind::Branch(*condition));
                    self.enter(no, PlaceKind::Branch(*condition));
                }
                Node::Scope { scope, body } => self.enter(body, PlaceKind::Scope(*scope)),
                Node::Loop { body, .. } => self.enter(body, PlaceKind::Loop),
                Node::Break(scope) => self.leaves.push((*scope, here, None)),
                Node::BreakIf { scope, condition, .. } => self.leaves.push((*scope, here, Some(*condition))),
                Node::LoopHeader(_) | Node::Check { .. } | Node::Trace { .. } | Node::Count(_) => {}
            }
        }
    }

    /// Adds the end of the root place and the loads of the output.
    fn close(&mut self) {
        self.places[0].last = self.places.len() - 1;
        for value in self.function.output {
            if let ValueDef::Load(cell) = self.function.def(value) {
                self.load(cell, 0);
            }
        }
    }

    fn load(&mut self, cell: Cell, here: usize) {
        let loads = &mut self.units[self.groups.representative(cell).index()].loads;
        let (first, last) = loads.unwrap_or((here, here));
        *loads = Some((first.min(here), last.max(here)));
    }

    fn store(&mut self, cell: Cell, values: &[Value], here: usize) {
        let unit = self.groups.representative(cell).index();
        self.units[unit].begins.get_or_insert(here);
        self.stores
            .extend(values.iter().map(|&value| (value, unit, here)));
    }

    /// Whether one place is the other or lies in it.
    fn holds(&self, outer: usize, inner: usize) -> bool {
        (outer..=self.places[outer].last).contains(&inner)
    }
}

// The solver: a worklist that derives each fact once.

struct Solver<'a> {
    map: &'a CodeMap<'a>,
    divergence: Divergence,
    /// Which units are divergent.
    units: Vec<bool>,
    /// Which units are shared.
    shared: Vec<bool>,
    /// Which places are regions.
    regions: Vec<bool>,
    /// The facts implied by each divergent value, followed by those of each divergent unit.
    implications: Implications,
    triggers: Triggers,
    /// Facts whose implications have not been propagated.
    pending: Vec<Fact>,
}

impl<'a> Solver<'a> {
    fn new(map: &'a CodeMap<'a>) -> Self {
        let (function, units) = (map.function, map.units.len());
        let divergence = Divergence {
            values: vec![false; function.defs.len()],
            cells: Vec::new(),
            shared: Vec::new(),
            scopes: vec![false; function.scopes as usize],
            constant: Vec::new(),
        };
        Self {
            map,
            divergence,
            units: vec![false; units],
            shared: vec![false; units],
            regions: vec![false; map.places.len()],
            implications: Self::implications(map),
            triggers: Triggers::new(Self::triggers(map)),
            pending: Vec::new(),
        }
    }

    fn run(mut self) -> Divergence {
        let function = self.map.function;
        for (value, def) in (0..).zip(&function.defs) {
            if matches!(def, ValueDef::FragCoord(_) | ValueDef::Parameter(..)) {
                self.add(Fact::Value(Value(value)));
            }
        }
        for &value in &self.map.values {
            if matches!(function.def(value), ValueDef::Texel { .. }) {
                self.add(Fact::Value(value));
            }
        }
        while let Some(fact) = self.pending.pop() {
            self.propagate(fact);
        }
        for cell in 0..function.cells.len() as u32 {
            let unit = self.map.groups.representative(Cell(cell)).index();
            self.divergence.cells.push(self.units[unit]);
            self.divergence.shared.push(self.shared[unit]);
        }
        self.constant();
        self.divergence
    }

    fn implications(map: &CodeMap<'_>) -> Implications {
        let values = map.function.defs.len();
        let mut implications = Implications::new(values + map.units.len());
        for &value in &map.values {
            let def = map.function.def(value);
            let fact = Fact::Value(value);
            def.for_each_operand(|operand| implications.add(operand.0 as usize, fact));
            match def {
                ValueDef::Load(cell) => {
                    implications.add(values + map.groups.representative(cell).index(), fact);
                }
                ValueDef::LoadAt { cells, .. } => {
                    implications.add(
                        values + map.groups.representative(Cell(cells.first)).index(),
                        fact,
                    );
                }
                _ => {}
            }
        }
        for &(value, unit, _) in &map.stores {
            implications.add(value.0 as usize, Fact::Unit(unit as u32));
        }
        for (at, place) in (0..).zip(&map.places) {
            if let PlaceKind::Branch(condition) = place.kind {
                implications.add(condition.0 as usize, Fact::Region(at));
            }
        }
        for &(scope, _, condition) in &map.leaves {
            if let Some(condition) = condition {
                implications.add(condition.0 as usize, Fact::Scope(scope));
            }
        }
        implications
    }

    fn triggers(map: &CodeMap<'_>) -> Vec<Trigger> {
        let mut triggers = Vec::new();
        for &(scope, here, _) in &map.leaves {
            // A break in a region within the scope: only some pixels of the scope reach it.
            triggers.push(Trigger {
                here,
                outer: map.scopes[scope.0 as usize],
                fact: Fact::Scope(scope),
            });
        }
        let mut stores: Vec<_> = map.stores.iter().map(|&(_, unit, here)| (here, unit)).collect();
        stores.sort_unstable();
        stores.dedup();
        let mut stores = stores.into_iter().peekable();
        // The places around each place, and the loops among them.
        let (mut around, mut loops): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
        for (here, place) in map.places.iter().enumerate() {
            around.truncate(around.partition_point(|&outer| map.holds(outer, here)));
            loops.truncate(loops.partition_point(|&outer| map.holds(outer, here)));
            around.push(here);
            if matches!(place.kind, PlaceKind::Loop) {
                loops.push(here);
            }
            while let Some((_, unit)) = stores.next_if(|&(at, _)| at == here) {
                if let Some(outer) = Self::innermost_safe_place(map, &map.units[unit], &around, &loops) {
                    triggers.push(Trigger {
                        here,
                        outer,
                        fact: Fact::Shared(unit as u32),
                    });
                }
            }
        }
        triggers
    }

    /// Returns the innermost place around a store that may be a region without affecting loads: no load then
    /// combines pixels that were and were not active at the store.
    fn innermost_safe_place(
        map: &CodeMap<'_>,
        unit: &Unit,
        around: &[usize],
        loops: &[usize],
    ) -> Option<usize> {
        let ((first, last), begins) = (unit.loads?, unit.begins?);
        // It contains all loads.
        let holding = around.partition_point(|&place| map.holds(place, first) && map.holds(place, last));
        // It is not entered again once the cell is live.
        let common = around.partition_point(|&place| map.holds(place, begins));
        let once = if around[common - 1] == begins {
            let again = loops.partition_point(|&place| place <= begins);
            loops.get(again).or_else(|| around.last()).copied()?
        } else {
            around[common - 1]
        };
        Some(around[holding - 1].min(once))
    }

    /// Adds a fact.
    fn add(&mut self, fact: Fact) {
        let known = match fact {
            Fact::Value(value) => &mut self.divergence.values[value.0 as usize],
            Fact::Unit(unit) => &mut self.units[unit as usize],
            Fact::Shared(unit) => &mut self.shared[unit as usize],
            Fact::Scope(scope) => &mut self.divergence.scopes[scope.0 as usize],
            Fact::Region(place) => &mut self.regions[place as usize],
        };
        if !std::mem::replace(known, true) {
            self.pending.push(fact);
        }
    }

    fn propagate(&mut self, fact: Fact) {
        let cause = match fact {
            Fact::Value(value) => value.0 as usize,
            Fact::Unit(unit) => self.map.function.defs.len() + unit as usize,
            Fact::Shared(unit) => return self.add(Fact::Unit(unit)),
            Fact::Scope(scope) => return self.add(Fact::Region(self.map.scopes[scope.0 as usize] as u32)),
            Fact::Region(place) => {
                let (first, last) = (place as usize, self.map.places[place as usize].last);
                while let Some(fact) = self.triggers.take(first, last) {
                    self.add(fact);
                }
                return;
            }
        };
        while let Some(fact) = self.implications.take(cause) {
            self.add(fact);
        }
    }

    /// Finds the values that are the same in the whole frame.
    fn constant(&mut self) {
        let function = self.map.function;
        let constant = &mut self.divergence.constant;
        *constant = function
            .defs
            .iter()
            .map(|def| {
                matches!(
                    def,
                    ValueDef::Float(_) | ValueDef::Word(_) | ValueDef::Input(..) | ValueDef::Extent { .. }
                )
            })
            .collect();
        for &value in &self.map.values {
            if let def @ ValueDef::Operation(..) = function.def(value) {
                let mut all = true;
                def.for_each_operand(|operand| all &= constant[operand.0 as usize]);
                constant[value.0 as usize] = all;
            }
        }
    }
}

// Implications between facts.

/// A fact that may be derived.
#[derive(Debug, Clone, Copy)]
enum Fact {
    /// A value is divergent.
    Value(Value),
    /// A cell, or a group of cells, is divergent.
    Unit(u32),
    /// Only some pixels may execute a store to the unit, and later load it together with the others.
    Shared(u32),
    /// Some pixels may leave a scope while others stay in it.
    Scope(Scope),
    /// A place is entered or left by some pixels and not by others.
    Region(u32),
}

/// A list of implied facts for each cause: linked lists in one vector.
#[derive(Debug)]
struct Implications {
    first: Vec<u32>,
    all: Vec<(Fact, u32)>,
}

const END: u32 = u32::MAX;

impl Implications {
    fn new(causes: usize) -> Self {
        Self {
            first: vec![END; causes],
            all: Vec::new(),
        }
    }

    fn add(&mut self, cause: usize, fact: Fact) {
        let next = std::mem::replace(&mut self.first[cause], self.all.len() as u32);
        self.all.push((fact, next));
    }

    /// Takes one fact from the list of a cause.
    fn take(&mut self, cause: usize) -> Option<Fact> {
        let (fact, next) = *self.all.get(self.first[cause] as usize)?;
        self.first[cause] = next;
        Some(fact)
    }
}

// Facts that depend on an enclosing place becoming a region.

/// A fact that holds once any place that contains `here`, and lies within `outer`, is a region.
#[derive(Debug, Clone, Copy)]
struct Trigger {
    here: usize,
    outer: usize,
    fact: Fact,
}

/// All triggers, in a segment tree: each is found once, in logarithmic time.
#[derive(Debug)]
struct Triggers {
    /// Sorted by `here`.
    list: Vec<Trigger>,
    /// The minimum of `outer` over each node of the tree; the children of node `n` are `2 * n` and `2 * n +
    /// 1`.
    min_outer: Vec<usize>,
}

/// The key of triggers that have fired.
const CONSUMED: usize = usize::MAX;

impl Triggers {
    fn new(mut list: Vec<Trigger>) -> Self {
        list.sort_by_key(|trigger| trigger.here);
        let width = list.len().next_power_of_two();
        let mut min_outer = vec![CONSUMED; 2 * width];
        for (at, trigger) in list.iter().enumerate() {
            min_outer[width + at] = trigger.outer;
        }
        for node in (1..width).rev() {
            min_outer[node] = min_outer[2 * node].min(min_outer[2 * node + 1]);
        }
        Self { list, min_outer }
    }

    /// Takes a trigger that fires if the place from `first` to `last` is a region.
    fn take(&mut self, first: usize, last: usize) -> Option<Fact> {
        let from = self.list.partition_point(|trigger| trigger.here < first);
        let to = self.list.partition_point(|trigger| trigger.here <= last);
        let width = self.min_outer.len() / 2;
        let at = self.find(1, [0, width], [from, to], first)?;
        let mut node = width + at;
        self.min_outer[node] = CONSUMED;
        while node > 1 {
            node /= 2;
            self.min_outer[node] = self.min_outer[2 * node].min(self.min_outer[2 * node + 1]);
        }
        Some(self.list[at].fact)
    }

    /// Returns the first trigger in a section of the list whose `outer` is below a bound, within the range of
    /// a tree node.
    fn find(
        &self,
        node: usize,
        [start, end]: [usize; 2],
        section: [usize; 2],
        bound: usize,
    ) -> Option<usize> {
        if end <= section[0] || section[1] <= start || self.min_outer[node] >= bound {
            return None;
        }
        if end - start == 1 {
            return Some(start);
        }
        let middle = start.midpoint(end);
        self.find(2 * node, [start, middle], section, bound)
            .or_else(|| self.find(2 * node + 1, [middle, end], section, bound))
    }
}
