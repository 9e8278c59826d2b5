//! One ray at a time, with eight spheres or boxes at once.

use smallvec::SmallVec;

use super::super::lanes::{Kernel, Lanes, MOST_LANES, Wide, Wide3};
use super::super::real::Real;
use super::block::{Block, margin};
use super::formula::{Roots, discriminant};
use super::slab::away_from_zero;
use super::tree::{Child, Node};
use super::{EIGHT, Eight, Spheres};

/// What a ray looks for: hits strictly between two t's, with any spheres but two.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Query<T> {
    pub(in super::super) origin: [T; 3],
    pub(in super::super) direction: [T; 3],
    pub(in super::super) t_min: T,
    pub(in super::super) t_max: T,
    /// Numbers of spheres, or [`super::NONE`].
    pub(in super::super) but: [u32; 2],
}

pub(super) struct Nearest<'a, T> {
    pub(super) spheres: &'a Spheres<T>,
    pub(super) query: &'a Query<T>,
}

impl<T: Real> Kernel<T> for Nearest<'_, T> {
    type Output = Option<(T, u32)>;

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Option<(T, u32)> {
        walk::<T, S::Eight, false>(simd.eight(), self.spheres, self.query)
    }
}

pub(super) struct Any<'a, T> {
    pub(super) spheres: &'a Spheres<T>,
    pub(super) query: &'a Query<T>,
}

impl<T: Real> Kernel<T> for Any<'_, T> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> bool {
        walk::<T, S::Eight, true>(simd.eight(), self.spheres, self.query).is_some()
    }
}

/// The nearest hit, or the first that is come upon.
#[inline(always)]
fn walk<T: Real, S: Lanes<T>, const ANY: bool>(
    simd: S,
    spheres: &Spheres<T>,
    query: &Query<T>,
) -> Option<(T, u32)> {
    let mut ray = Walker::new(simd, query);
    if spheres.tree.nodes.is_empty() {
        for block in &spheres.tree.blocks {
            ray.meet(block);
            if ANY && ray.is_stopped() {
                break;
            }
        }
        return ray.hit();
    }
    let sides = Sides::new(simd, query.direction);
    // Nodes and blocks that are still to be seen, with the t's at which the ray comes to them, farther ones first.
    let mut open: SmallVec<[(T, Child); 64]> = SmallVec::new();
    let mut next = Child::ROOT;
    loop {
        let nearest = match next.get() {
            Ok(node) => ray.open(&sides, &spheres.tree.nodes[node], &mut open),
            Err(block) => {
                ray.meet(&spheres.tree.blocks[block]);
                if ANY && ray.is_stopped() {
                    return ray.hit();
                }
                None
            }
        };
        next = match nearest {
            Some(child) => child,
            None => loop {
                match open.pop() {
                    None => return ray.hit(),
                    Some((near, _)) if near > ray.t => {}
                    Some((_, child)) => break child,
                }
            },
        };
    }
}

/// Puts what is nearer on top.
#[inline(always)]
pub(super) fn push<T: Real>(open: &mut SmallVec<[(T, Child); 64]>, base: usize, entry: (T, Child)) {
    open.push(entry);
    let mut at = open.len() - 1;
    while at > base && open[at - 1].0 < open[at].0 {
        open.swap(at - 1, at);
        at -= 1;
    }
}

/// A ray on its way.
struct Walker<'a, T, S: Lanes<T>> {
    simd: S,
    query: &'a Query<T>,
    origin: Wide3<T, S>,
    direction: Wide3<T, S>,
    a: Wide<T, S>,
    per_a: Wide<T, S>,
    t_min: Wide<T, S>,
    /// Of the nearest hit so far, or the query's largest.
    t: T,
    number: u32,
}

impl<'a, T: Real, S: Lanes<T>> Walker<'a, T, S> {
    #[inline(always)]
    fn new(simd: S, query: &'a Query<T>) -> Self {
        let direction = Wide3::splat(simd, query.direction);
        let a = direction.dot(direction);
        Self {
            simd,
            query,
            origin: Wide3::splat(simd, query.origin),
            direction,
            a,
            per_a: Wide::splat(simd, T::one()) / a,
            t_min: Wide::splat(simd, query.t_min),
            t: query.t_max,
            // No number is smaller, so that nothing takes this one's place at the same t.
            number: 0,
        }
    }

    #[inline(always)]
    fn is_stopped(&self) -> bool {
        self.t < self.query.t_max
    }

    #[inline(always)]
    fn hit(&self) -> Option<(T, u32)> {
        self.is_stopped().then_some((self.t, self.number))
    }

    /// Meets the spheres of a block.
    #[inline(always)]
    fn meet(&mut self, block: &Block<T>) {
        let simd = self.simd;
        let mut at = 0;
        while at < EIGHT {
            let per_unit = Wide::load(simd, &block.per_unit[at..]);
            let f = (self.origin - Wide3::load(simd, &block.center, at)) * per_unit;
            let radius2 = Wide::load(simd, &block.radius2[at..]);
            let [along, disc] = discriminant(f, self.direction, self.per_a, radius2);
            let may = simd.bits(Wide::splat(simd, T::zero()).less_or_equal(disc));
            if may != 0 {
                let roots = Roots {
                    along,
                    disc,
                    a: self.a,
                    c: f.dot(f) - radius2,
                    unit: Wide::splat(simd, T::one()) / per_unit,
                };
                let t = roots.beyond(simd, self.t_min);
                let between = [self.t_min.less(t), t.less_or_equal(Wide::splat(simd, self.t))];
                let hits = may & simd.bits(between[0]) & simd.bits(between[1]);
                if hits != 0 {
                    self.take(hits, t, &block.numbers[at..]);
                }
            }
            at += S::COUNT;
        }
    }

    /// Keeps the nearest of some hits.
    #[inline(always)]
    fn take(&mut self, mut hits: u32, t: Wide<T, S>, numbers: &[u32]) {
        let mut ts = [T::zero(); MOST_LANES];
        t.store(&mut ts);
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize;
            hits &= hits - 1;
            let (t, number) = (ts[lane], numbers[lane]);
            let is_nearer = t < self.t || (t == self.t && number < self.number);
            if is_nearer && !self.query.but.contains(&number) {
                (self.t, self.number) = (t, number);
            }
        }
    }

    /// The child of a node whose box the ray comes to first; the others that it crosses are left for later.
    #[inline(always)]
    fn open(
        &self,
        sides: &Sides<T, S>,
        node: &Node<T>,
        open: &mut SmallVec<[(T, Child); 64]>,
    ) -> Option<Child> {
        let (mut hits, nears) = self.cross(sides, node);
        if hits == 0 {
            return None;
        }
        let mut next = || {
            let at = hits.trailing_zeros() as usize % EIGHT;
            hits &= hits - 1;
            ((nears[at], node.children[at]), hits == 0)
        };
        let (mut nearest, mut is_last) = next();
        while !is_last {
            let other;
            (other, is_last) = next();
            let is_nearer = other.0 < nearest.0;
            open.push(if is_nearer { nearest } else { other });
            nearest = if is_nearer { other } else { nearest };
        }
        Some(nearest.1)
    }

    /// Which boxes of a node the ray crosses, and where it comes to each.
    #[inline(always)]
    fn cross(&self, sides: &Sides<T, S>, node: &Node<T>) -> (u32, Eight<T>) {
        let simd = self.simd;
        let mut nears = [T::zero(); EIGHT];
        let mut misses = 0;
        let mut at = 0;
        while at < EIGHT {
            let [near_x, far_x] = sides.axis(node, 0, at, self.origin.0, sides.per_near.0, sides.per_far.0);
            let [near_y, far_y] = sides.axis(node, 1, at, self.origin.1, sides.per_near.1, sides.per_far.1);
            let [near_z, far_z] = sides.axis(node, 2, at, self.origin.2, sides.per_near.2, sides.per_far.2);
            let near = near_x.max(near_y).max(near_z.max(Wide::splat(simd, T::zero())));
            let far = far_x.min(far_y).min(far_z.min(Wide::splat(simd, self.t)));
            near.store(&mut nears[at..]);
            // What is NaN is not left out.
            misses |= simd.bits(far.less(near)) << at;
            at += S::COUNT;
        }
        (!misses & ((1 << node.count) - 1), nears)
    }
}

/// The sides of boxes, as one ray comes to them.
struct Sides<T, S: Lanes<T>> {
    simd: S,
    is_negative: [bool; 3],
    /// One over the direction, for the sides that are met first and last, farther apart than they are.
    per_near: Wide3<T, S>,
    per_far: Wide3<T, S>,
}

impl<T: Real, S: Lanes<T>> Sides<T, S> {
    #[inline(always)]
    fn new(simd: S, direction: [T; 3]) -> Self {
        let [x, y, z] = direction.map(away_from_zero);
        let per = Wide3::splat(simd, [x.recip(), y.recip(), z.recip()]);
        Self {
            simd,
            is_negative: [x < T::zero(), y < T::zero(), z < T::zero()],
            per_near: per * Wide::splat(simd, T::one() - margin()),
            per_far: per * Wide::splat(simd, T::one() + margin()),
        }
    }

    #[inline(always)]
    fn axis(
        &self,
        node: &Node<T>,
        axis: usize,
        at: usize,
        origin: Wide<T, S>,
        per_near: Wide<T, S>,
        per_far: Wide<T, S>,
    ) -> [Wide<T, S>; 2] {
        let (mut first, mut last) = (&node.low[axis], &node.high[axis]);
        if self.is_negative[axis] {
            (first, last) = (last, first);
        }
        [
            (Wide::load(self.simd, &first[at..]) - origin) * per_near,
            (Wide::load(self.simd, &last[at..]) - origin) * per_far,
        ]
    }
}
