//! Rays that go the same way, together.

use smallvec::SmallVec;

use super::super::lanes::{Kernel, Lanes, Wide, Wide3};
use super::super::ray::Ray;
use super::super::real::{Real, Vector};
use super::block::{Block, Reach};
use super::formula::{Roots, discriminant};
use super::one::push;
use super::slab::{Slab, Slabs};
use super::tree::{Child, Node};
use super::{EIGHT, NONE, Spheres};

/// How many rays are in a packet: those of 8×8 pixels.
pub(in super::super) const PACKET: usize = 64;

/// A number of each ray.
type Each<T> = [T; PACKET];

/// Rays that start on no surface.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Packet<T> {
    pub(in super::super) origins: Origins<T>,
    pub(in super::super) directions: [Each<T>; 3],
}

impl<T: Real> Packet<T> {
    /// One of its rays.
    #[inline]
    pub(in super::super) fn ray(&self, at: usize) -> Ray<T> {
        let vector = |[x, y, z]: [T; 3]| T::Vec3::new(x, y, z);
        let of = |components: &[Each<T>; 3]| vector([0, 1, 2].map(|axis| components[axis][at]));
        Ray {
            origin: match &self.origins {
                Origins::One(origin) => vector(*origin),
                Origins::Each(origins) => of(origins),
            },
            direction: of(&self.directions),
            from: None,
        }
    }
}

/// Where rays start.
#[derive(Debug)]
pub(in super::super) enum Origins<T> {
    /// All in one point.
    One([T; 3]),
    Each([Each<T>; 3]),
}

/// What the rays of a packet found.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Found<T> {
    /// Infinite where nothing is met.
    t: Each<T>,
    /// The number of the sphere, as [`Real::tag`] hides it.
    tags: Each<T>,
}

impl<T: Real> Found<T> {
    fn nothing() -> Self {
        Self {
            t: [T::infinity(); PACKET],
            tags: [T::tag(NONE); PACKET],
        }
    }

    /// What one ray found.
    #[inline]
    pub(in super::super) fn of(&self, ray: usize) -> Option<(T, u32)> {
        let t = self.t[ray];
        (t < T::infinity()).then(|| (t, self.tags[ray].untag()))
    }
}

pub(super) struct Nearest<'a, T> {
    pub(super) spheres: &'a Spheres<T>,
    pub(super) packet: &'a Packet<T>,
}

impl<T: Real> Kernel<T> for Nearest<'_, T> {
    type Output = Found<T>;

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Found<T> {
        let Self { spheres, packet } = self;
        let mut rays = Walkers::new(simd, packet);
        if spheres.tree.nodes.is_empty() {
            for (block, reach) in spheres.tree.blocks.iter().zip(&spheres.tree.reaches) {
                rays.meet(block, reach);
            }
            return rays.found;
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
                    None => return rays.found,
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
    found: Found<T>,
    /// The largest t of those found.
    limit: T,
}

/// The lowest and the highest of many; all that there are where one is no number.
#[inline(always)]
fn range<T: Real, S: Lanes<T>>(simd: S, numbers: &Each<T>) -> [T; 2] {
    let mut low = Wide::load(simd, numbers);
    let zero = Wide::splat(simd, T::zero());
    // NaN where any number is NaN or infinite.
    let (mut high, mut none) = (low, low * zero);
    let mut at = S::COUNT;
    while at < PACKET {
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
fn largest<T: Real, S: Lanes<T>>(simd: S, numbers: &Each<T>) -> T {
    let mut high = Wide::load(simd, numbers);
    let mut at = S::COUNT;
    while at < PACKET {
        high = high.max(Wide::load(simd, &numbers[at..]));
        at += S::COUNT;
    }
    high.greatest()
}

impl<'a, T: Real, S: Lanes<T>> Walkers<'a, T, S> {
    #[inline(always)]
    fn new(simd: S, packet: &'a Packet<T>) -> Self {
        let (mut a, mut per_a) = ([T::zero(); PACKET], [T::zero(); PACKET]);
        let mut at = 0;
        while at < PACKET {
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
            found: Found::nothing(),
            limit: T::infinity(),
        }
    }

    #[inline(always)]
    fn slab(simd: S, packet: &Packet<T>, axis: usize) -> Slab<T, S::Eight> {
        let origins = match &packet.origins {
            Origins::One(origin) => [origin[axis]; 2],
            Origins::Each(origins) => range(simd, &origins[axis]),
        };
        Slab::new(simd.eight(), origins, range(simd, &packet.directions[axis]))
    }

    /// Meets those spheres of a block that any ray may meet.
    #[inline(always)]
    fn meet(&mut self, block: &Block<T>, reaches: &Reach<T>) {
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
        let mut hits = !misses & ((1 << reaches.count) - 1);
        let mut is_changed = false;
        while hits != 0 {
            let at = hits.trailing_zeros() as usize % EIGHT;
            hits &= hits - 1;
            is_changed |= self.meet_one(block, at);
        }
        if is_changed {
            self.limit = largest(self.simd, &self.found.t);
        }
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
                while at < PACKET {
                    is_changed |= self.meet_some(at, block, place, f, c, radius2);
                    at += S::COUNT;
                }
            }
            Origins::Each(origins) => {
                let mut at = 0;
                while at < PACKET {
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
        let [along, disc] = discriminant(f, d, Wide::load(simd, &self.per_a[at..]), radius2);
        let zero = Wide::splat(simd, T::zero());
        let may = zero.less_or_equal(disc);
        if simd.bits(may) == 0 {
            return false;
        }
        let roots = Roots {
            along,
            disc,
            a: Wide::load(simd, &self.a[at..]),
            c,
            unit: Wide::splat(simd, block.per_unit[place].recip()),
        };
        let t = roots.beyond(simd, zero);
        let infinity = Wide::splat(simd, T::infinity());
        let t = t.select(may, infinity);
        let t = t.select(zero.less(t), infinity);
        let before = Wide::load(simd, &self.found.t[at..]);
        let nearer = t.less(before);
        let nearer_bits = simd.bits(nearer);
        let mut ties = simd.bits(t.less_or_equal(before)) & !nearer_bits & simd.bits(t.less(infinity));
        let number = block.numbers[place];
        if nearer_bits != 0 {
            let tags = Wide::load(simd, &self.found.tags[at..]);
            t.select(nearer, before).store(&mut self.found.t[at..]);
            let tag = Wide::splat(simd, T::tag(number));
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
