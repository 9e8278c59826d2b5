//! Finds out what varies: each fact once, and with it what follows.

use super::follow::{Fact, Followers};
use super::watch::{Watch, Watches};
use super::{Map, Unit, Varying, What};
use crate::ir::function::{Cell, Origin, Value};

pub(super) struct Solve<'a> {
    map: &'a Map<'a>,
    varying: Varying,
    /// Which units vary.
    units: Vec<bool>,
    /// Which of them are shared.
    shared: Vec<bool>,
    /// Which places are regions.
    regions: Vec<bool>,
    /// What follows once a value varies, or, after those, a unit.
    followers: Followers,
    watches: Watches,
    /// What was found out and not followed.
    pending: Vec<Fact>,
}

impl<'a> Solve<'a> {
    pub(super) fn new(map: &'a Map<'a>) -> Self {
        let (flow, units) = (map.flow, map.units.len());
        let varying = Varying {
            values: vec![false; flow.origins.len()],
            cells: Vec::new(),
            shared: Vec::new(),
            scopes: vec![false; flow.scopes as usize],
            constant: Vec::new(),
        };
        Self {
            map,
            varying,
            units: vec![false; units],
            shared: vec![false; units],
            regions: vec![false; map.places.len()],
            followers: Self::followers(map),
            watches: Watches::new(Self::watches(map)),
            pending: Vec::new(),
        }
    }

    pub(super) fn run(mut self) -> Varying {
        let flow = self.map.flow;
        for (value, origin) in (0..).zip(&flow.origins) {
            if matches!(origin, Origin::FragCoord(_)) {
                self.note(Fact::Value(Value(value)));
            }
        }
        for &value in &self.map.values {
            if matches!(flow.origin(value), Origin::Texel { .. }) {
                self.note(Fact::Value(value));
            }
        }
        while let Some(fact) = self.pending.pop() {
            self.follow(fact);
        }
        for cell in 0..flow.cells.len() as u32 {
            let unit = self.map.groups.unit(Cell(cell));
            self.varying.cells.push(self.units[unit]);
            self.varying.shared.push(self.shared[unit]);
        }
        self.constant();
        self.varying
    }

    fn followers(map: &Map<'_>) -> Followers {
        let values = map.flow.origins.len();
        let mut followers = Followers::new(values + map.units.len());
        for &value in &map.values {
            let origin = map.flow.origin(value);
            let fact = Fact::Value(value);
            origin.for_each_operand(|operand| followers.add(operand.0 as usize, fact));
            match origin {
                Origin::Load(cell) => followers.add(values + map.groups.unit(cell), fact),
                Origin::LoadAt { cells, .. } => {
                    followers.add(values + map.groups.unit(Cell(cells.first)), fact);
                }
                _ => {}
            }
        }
        for &(value, unit, _) in &map.stores {
            followers.add(value.0 as usize, Fact::Unit(unit as u32));
        }
        for (at, place) in (0..).zip(&map.places) {
            if let What::Branch(condition) = place.what {
                followers.add(condition.0 as usize, Fact::Region(at));
            }
        }
        for &(scope, _, condition) in &map.leaves {
            if let Some(condition) = condition {
                followers.add(condition.0 as usize, Fact::Scope(scope));
            }
        }
        followers
    }

    fn watches(map: &Map<'_>) -> Vec<Watch> {
        let mut watches = Vec::new();
        for &(scope, here, _) in &map.leaves {
            // Only some of the pixels in a scope come to where it is left.
            watches.push(Watch {
                here,
                outer: map.scopes[scope.0 as usize],
                fact: Fact::Scope(scope),
            });
        }
        let mut stores: Vec<_> = map.stores.iter().map(|&(_, unit, here)| (here, unit)).collect();
        stores.sort_unstable();
        stores.dedup();
        let mut stores = stores.into_iter().peekable();
        // The places around each place, and which of them are loops.
        let (mut around, mut loops): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
        for (here, place) in map.places.iter().enumerate() {
            around.truncate(around.partition_point(|&outer| map.holds(outer, here)));
            loops.truncate(loops.partition_point(|&outer| map.holds(outer, here)));
            around.push(here);
            if matches!(place.what, What::Loop) {
                loops.push(here);
            }
            while let Some((_, unit)) = stores.next_if(|&(at, _)| at == here) {
                if let Some(outer) = Self::harmless(map, &map.units[unit], &around, &loops) {
                    watches.push(Watch {
                        here,
                        outer,
                        fact: Fact::Shared(unit as u32),
                    });
                }
            }
        }
        watches
    }

    /// The innermost place around a store that may be a region without a load meeting pixels that were elsewhere when it was stored.
    fn harmless(map: &Map<'_>, unit: &Unit, around: &[usize], loops: &[usize]) -> Option<usize> {
        let ((first, last), begins) = (unit.loads?, unit.begins?);
        // It holds all loads.
        let held = around.partition_point(|&place| map.holds(place, first) && map.holds(place, last));
        // It is not entered again once the cell began.
        let common = around.partition_point(|&place| map.holds(place, begins));
        let once = if around[common - 1] == begins {
            let again = loops.partition_point(|&place| place <= begins);
            loops.get(again).or_else(|| around.last()).copied()?
        } else {
            around[common - 1]
        };
        Some(around[held - 1].min(once))
    }

    /// Notes that something varies.
    fn note(&mut self, fact: Fact) {
        let known = match fact {
            Fact::Value(value) => &mut self.varying.values[value.0 as usize],
            Fact::Unit(unit) => &mut self.units[unit as usize],
            Fact::Shared(unit) => &mut self.shared[unit as usize],
            Fact::Scope(scope) => &mut self.varying.scopes[scope.0 as usize],
            Fact::Region(place) => &mut self.regions[place as usize],
        };
        if !std::mem::replace(known, true) {
            self.pending.push(fact);
        }
    }

    fn follow(&mut self, fact: Fact) {
        let cause = match fact {
            Fact::Value(value) => value.0 as usize,
            Fact::Unit(unit) => self.map.flow.origins.len() + unit as usize,
            Fact::Shared(unit) => return self.note(Fact::Unit(unit)),
            Fact::Scope(scope) => return self.note(Fact::Region(self.map.scopes[scope.0 as usize] as u32)),
            Fact::Region(place) => {
                let (first, last) = (place as usize, self.map.places[place as usize].last);
                while let Some(fact) = self.watches.take(first, last) {
                    self.note(fact);
                }
                return;
            }
        };
        while let Some(fact) = self.followers.take(cause) {
            self.note(fact);
        }
    }

    /// What is the same all over the frame.
    fn constant(&mut self) {
        let flow = self.map.flow;
        let constant = &mut self.varying.constant;
        *constant = flow
            .origins
            .iter()
            .map(|origin| matches!(origin, Origin::Float(_) | Origin::Word(_) | Origin::Input(..)))
            .collect();
        for &value in &self.map.values {
            if let origin @ Origin::Operation(..) = flow.origin(value) {
                let mut all = true;
                origin.for_each_operand(|operand| all &= constant[operand.0 as usize]);
                constant[value.0 as usize] = all;
            }
        }
    }
}
