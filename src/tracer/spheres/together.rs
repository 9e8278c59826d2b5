//! The rays of a packet, past one sphere after the other.

use smallvec::SmallVec;

use super::super::lanes::{Kernel, Lanes, Wide, Wide3};
use super::super::real::Real;
use super::block::{Block, Reach};
use super::formula::{Roots, discriminant, other_root};
use super::one::push;
use super::packet::{Each, Found, Origins, PACKET, Packet};
use super::slab::{Slab, Slabs};
use super::tree::{Child, Node};
use super::{EIGHT, Spheres};

pub(super) struct Nearest<'a, T> {
    pub(super) spheres: &'a Spheres<T>,
    pub(super) packet: &'a Packet<T>,
    pub(super) found: &'a mut Found<T>,
}

impl<T: Real> Kernel<T> for Nearest<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let Self {
            spheres,
            packet,
            found,
        } = self;
        let mut rays = Walkers::new(simd, packet, found);
        if spheres.tree.nodes.is_empty() {
            for (block, reach) in spheres.tree.blocks.iter().zip(&spheres.tree.reaches) {
                rays.meet(block, reach);
            }
            return;
        }
        let mut open: SmallVec<[(T, Child); 64]> = SmallVec::new();
        let mut next = Child::ROOT;
        loop {
            match next.get() {
                Ok(node) => rays.cross(&spheres.tree.nodes[node], &mut open),
                Err(block) => rays.meet(&spheres.tree.blocks[block], &spheres.tree.reaches[block]),
            }
            next = loop {
                match open.pop() {
                    None => return,
                    Some((near, _)) if near > rays.limit => {}
                    Some((_, child)) => break child,
                }
            };
        }
    }
}

/// The rays of a packet on their way.
struct Walkers<'a, T, S: Lanes<T>> {
    simd: S,
    packet: &'a Packet<T>,
    a: Each<T>,
    per_a: Each<T>,
    slabs: Slabs<T, S::Eight>,
    found: &'a mut Found<T>,
    /// The largest t of those found.
    limit: T,
}

/// The lowest and the highest of many; all that there are where one is no number.
#[inline(always)]
fn range<T: Real, S: Lanes<T>>(simd: S, numbers: &[T]) -> [T; 2] {
    let mut low = Wide::load(simd, numbers);
    let zero = Wide::splat(simd, T::zero());
    // NaN where any number is NaN or infinite.
    let (mut high, mut none) = (low, low * zero);
    let mut at = S::COUNT;
    while at < numbers.len() {
        let more = Wide::load(simd, &numbers[at..]);
        (low, high, none) = (low.min(more), high.max(more), none + more * zero);
        at += S::COUNT;
    }
    let none = none.sum();
    if none == T::zero() {
        [low.least(), high.greatest()]
    } else {
        [T::min_value(), T::max_value()]
    }
}

/// The largest of many, none of them NaN.
#[inline(always)]
fn largest<T: Real, S: Lanes<T>>(simd: S, numbers: &[T]) -> T {
    let mut high = Wide::load(simd, numbers);
    let mut at = S::COUNT;
    while at < numbers.len() {
        high = high.max(Wide::load(simd, &numbers[at..]));
        at += S::COUNT;
    }
    high.greatest()
}

impl<'a, T: Real, S: Lanes<T>> Walkers<'a, T, S> {
    #[inline(always)]
    fn new(simd: S, packet: &'a Packet<T>, found: &'a mut Found<T>) -> Self {
        let (mut a, mut per_a) = ([T::zero(); PACKET], [T::zero(); PACKET]);
        let mut at = 0;
        while at < packet.count {
            let d = Wide3::load(simd, &packet.directions, at);
            d.dot(d).store(&mut a[at..]);
            (Wide::splat(simd, T::one()) / d.dot(d)).store(&mut per_a[at..]);
            at += S::COUNT;
        }
        Self {
            simd,
            packet,
            a,
            per_a,
            slabs: Slabs(
                Self::slab(simd, packet, 0),
                Self::slab(simd, packet, 1),
                Self::slab(simd, packet, 2),
            ),
            limit: largest(simd, &found.t[..packet.count]),
            found,
        }
    }

    #[inline(always)]
    fn slab(simd: S, packet: &Packet<T>, axis: usize) -> Slab<T, S::Eight> {
        let origins = match &packet.origins {
            Origins::One(origin) => [origin[axis]; 2],
            Origins::Each(origins) => range(simd, &origins[axis][..packet.count]),
        };
        let directions = range(simd, &packet.directions[axis][..packet.count]);
        Slab::new(simd.eight(), origins, directions)
    }

    /// Meets those spheres of a block that any ray may meet.
    #[inline(always)]
    fn meet(&mut self, block: &Block<T>, reaches: &Reach<T>) {
        let mut hits = (1 << reaches.count) - 1;
        // Rays that start on surfaces go anywhere, and where rounding has put one beside its own sphere it must not miss it.
        if self.packet.from.is_none() {
            hits &= !self.misses(block, reaches);
        }
        let mut is_changed = false;
        while hits != 0 {
            let at = hits.trailing_zeros() as usize % EIGHT;
            hits &= hits - 1;
            is_changed |= self.meet_one(block, at);
        }
        if is_changed {
            self.limit = largest(self.simd, &self.found.t[..self.packet.count]);
        }
    }

    /// The spheres of a block that no ray can meet.
    #[inline(always)]
    fn misses(&self, block: &Block<T>, reaches: &Reach<T>) -> u32 {
        let simd = self.simd.eight();
        let mut misses = 0;
        let mut at = 0;
        while at < EIGHT {
            let reach = Wide::load(simd, &reaches.reach[at..]);
            let Wide3(x, y, z) = Wide3::load(simd, &block.center, at);
            let limit = Wide::splat(simd, self.limit);
            let lows = [x - reach, y - reach, z - reach];
            let (missed, _) = self
                .slabs
                .misses(simd, lows, [x + reach, y + reach, z + reach], limit);
            misses |= missed << at;
            at += S::Eight::COUNT;
        }
        misses
    }

    /// All rays meet one sphere; whether any t has become smaller.
    #[inline(always)]
    fn meet_one(&mut self, block: &Block<T>, place: usize) -> bool {
        let simd = self.simd;
        let [cx, cy, cz] = &block.center;
        let center = Wide3::splat(simd, [cx[place], cy[place], cz[place]]);
        let per_unit = Wide::splat(simd, block.per_unit[place]);
        let radius2 = Wide::splat(simd, block.radius2[place]);
        let mut is_changed = false;
        match &self.packet.origins {
            Origins::One(origin) => {
                let f = (Wide3::splat(simd, *origin) - center) * per_unit;
                let c = f.dot(f) - radius2;
                let mut at = 0;
                while at < self.packet.count {
                    is_changed |= self.meet_some(at, block, place, f, c, radius2);
                    at += S::COUNT;
                }
            }
            Origins::Each(origins) => {
                let mut at = 0;
                while at < self.packet.count {
                    let f = (Wide3::load(simd, origins, at) - center) * per_unit;
                    let c = f.dot(f) - radius2;
                    is_changed |= self.meet_some(at, block, place, f, c, radius2);
                    at += S::COUNT;
                }
            }
        }
        is_changed
    }

    /// As many rays as there are lanes, from `at` on.
    #[inline(always)]
    fn meet_some(
        &mut self,
        at: usize,
        block: &Block<T>,
        place: usize,
        f: Wide3<T, S>,
        c: Wide<T, S>,
        radius2: Wide<T, S>,
    ) -> bool {
        let simd = self.simd;
        let d = Wide3::load(simd, &self.packet.directions, at);
        let [along, mut disc] = discriminant(f, d, Wide::load(simd, &self.per_a[at..]), radius2);
        let [zero, t_min, infinity] =
            [T::zero(), self.packet.t_min, T::infinity()].map(|number| Wide::splat(simd, number));
        let number = block.numbers[place];
        let tag = Wide::splat(simd, T::tag(number));
        let own = self
            .packet
            .from
            .as_ref()
            .map(|from| Wide::load(simd, &from[at..]).equal(tag));
        if let Some(own) = own {
            // Of a ray along the surface it may be negative.
            disc = zero.select(own, disc);
        }
        let may = zero.less_or_equal(disc);
        if simd.bits(may) == 0 {
            return false;
        }
        let a = Wide::load(simd, &self.a[at..]);
        let unit = Wide::splat(simd, block.per_unit[place].recip());
        let roots = Roots {
            along,
            disc,
            a,
            c,
            unit,
        };
        let mut t = roots.beyond(simd, t_min).select(may, infinity);
        if let Some(own) = own {
            t = other_root(simd, along, a, unit).select(own, t);
        }
        let t = t.select(t_min.less(t), infinity);
        let before = Wide::load(simd, &self.found.t[at..]);
        let nearer = t.less(before);
        let nearer_bits = simd.bits(nearer);
        let mut ties = simd.bits(t.less_or_equal(before)) & !nearer_bits & simd.bits(t.less(infinity));
        if nearer_bits != 0 {
            let tags = Wide::load(simd, &self.found.tags[at..]);
            t.select(nearer, before).store(&mut self.found.t[at..]);
            tag.select(nearer, tags).store(&mut self.found.tags[at..]);
        }
        while ties != 0 {
            let ray = at + ties.trailing_zeros() as usize;
            ties &= ties - 1;
            if number < self.found.tags[ray].untag() {
                self.found.tags[ray] = T::tag(number);
            }
        }
        nearer_bits != 0
    }

    /// Opens the children that any ray may come to.
    #[inline(always)]
    fn cross(&self, node: &Node<T>, open: &mut SmallVec<[(T, Child); 64]>) {
        let simd = self.simd.eight();
        let mut nears = [T::zero(); EIGHT];
        let mut misses = 0;
        let mut at = 0;
        while at < EIGHT {
            let Wide3(low_x, low_y, low_z) = Wide3::load(simd, &node.low, at);
            let Wide3(high_x, high_y, high_z) = Wide3::load(simd, &node.high, at);
            let (lows, highs) = ([low_x, low_y, low_z], [high_x, high_y, high_z]);
            let limit = Wide::splat(simd, self.limit);
            let (missed, near) = self.slabs.misses(simd, lows, highs, limit);
            near.store(&mut nears[at..]);
            misses |= missed << at;
            at += S::Eight::COUNT;
        }
        let mut hits = !misses & ((1 << node.count) - 1);
        let base = open.len();
        while hits != 0 {
            let at = hits.trailing_zeros() as usize % EIGHT;
            hits &= hits - 1;
            push(open, base, (nears[at], node.children[at]));
        }
    }
}
