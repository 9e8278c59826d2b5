//! Traversal by a single ray, which is tested against eight spheres or boxes at once.

use std::hint::select_unpredictable;

use smallvec::SmallVec;

use super::Spheres;
use super::block::{Block, margin};
use super::formula::{BLOCK_SIZE, Eight, Roots, discriminant};
use super::tree::{Child, Node};
use crate::lanes::{Kernel, Lanes, MAX_LANES, Wide, Wide3};
use crate::real::Real;

/// A query for hits strictly between two values of t, with at most two spheres excluded. A sphere that is hit
/// at the upper bound counts if its index is smaller than `number`.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Query<T> {
    pub(in super::super) origin: [T; 3],
    pub(in super::super) direction: [T; 3],
    pub(in super::super) t_min: T,
    pub(in super::super) t_max: T,
    pub(in super::super) number: u32,
    /// Indices of spheres, or [`super::NO_SURFACE`].
    pub(in super::super) excluded: [u32; 2],
}

pub(super) struct Nearest<'a, T> {
    pub(super) spheres: &'a Spheres<T>,
    pub(super) query: &'a Query<T>,
}

impl<T: Real> Kernel<T> for Nearest<'_, T> {
    type Output = Option<(T, u32)>;

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Option<(T, u32)> {
        traverse::<T, S::Eight, false>(simd.eight(), self.spheres, self.query)
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
        traverse::<T, S::Eight, true>(simd.eight(), self.spheres, self.query).is_some()
    }
}

/// Finds the nearest hit, or any hit if `ANY`.
#[inline(always)]
fn traverse<T: Real, S: Lanes<T>, const ANY: bool>(
    simd: S,
    spheres: &Spheres<T>,
    query: &Query<T>,
) -> Option<(T, u32)> {
    let mut ray = RayTraversal::new(simd, query);
    if spheres.tree.nodes.is_empty() {
        for block in &spheres.tree.blocks {
            ray.intersect_block(block);
            if ANY && ray.has_hit() {
                break;
            }
        }
        return ray.hit();
    }
    let sides = RayBoxes::new(simd, query.direction);
    // Stack of nodes and blocks to visit, with t where the ray enters them, farther ones below.
    let mut open: SmallVec<[(T, Child); 64]> = SmallVec::new();
    let mut next = Child::ROOT;
    loop {
        let nearest = match next.get() {
            Ok(node) => ray.open(&sides, &spheres.tree.nodes[node], &mut open),
            Err(block) => {
                ray.intersect_block(&spheres.tree.blocks[block]);
                if ANY && ray.has_hit() {
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

/// Pushes an entry and keeps those above `base` sorted, nearest on top.
#[inline(always)]
pub(super) fn push_sorted<T: Real>(open: &mut SmallVec<[(T, Child); 64]>, base: usize, entry: (T, Child)) {
    open.push(entry);
    let mut at = open.len() - 1;
    while at > base && open[at - 1].0 < open[at].0 {
        open.swap(at - 1, at);
        at -= 1;
    }
}

/// Traversal of the spheres by one ray.
struct RayTraversal<'a, T, S: Lanes<T>> {
    simd: S,
    query: &'a Query<T>,
    origin: Wide3<T, S>,
    direction: Wide3<T, S>,
    a: Wide<T, S>,
    inverse_a: Wide<T, S>,
    t_min: Wide<T, S>,
    /// t of the nearest hit so far, or the upper bound of the query.
    t: T,
    /// Number of the nearest sphere so far.
    number: u32,
}

impl<'a, T: Real, S: Lanes<T>> RayTraversal<'a, T, S> {
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
            inverse_a: Wide::splat(simd, T::one()) / a,
            t_min: Wide::splat(simd, query.t_min),
            t: query.t_max,
            number: query.number,
        }
    }

    #[inline(always)]
    fn has_hit(&self) -> bool {
        self.t < self.query.t_max || self.number < self.query.number
    }

    #[inline(always)]
    fn hit(&self) -> Option<(T, u32)> {
        self.has_hit().then_some((self.t, self.number))
    }

    /// Intersects the spheres of a block.
    #[inline(always)]
    fn intersect_block(&mut self, block: &Block<T>) {
        let simd = self.simd;
        let mut at = 0;
        while at < BLOCK_SIZE {
            let inverse_unit = Wide::load(simd, &block.inverse_unit[at..]);
            let f = (self.origin - Wide3::load(simd, &block.center, at)) * inverse_unit;
            let radius2 = Wide::load(simd, &block.radius2[at..]);
            let [along, disc] = discriminant(f, self.direction, self.inverse_a, radius2);
            let may_hit = simd.bits(Wide::splat(simd, T::zero()).less_or_equal(disc));
            if may_hit != 0 {
                let roots = Roots {
                    along,
                    disc,
                    a: self.a,
                    c: f.dot(f) - radius2,
                    unit: Wide::splat(simd, T::one()) / inverse_unit,
                };
                let t = roots.beyond(simd, self.t_min);
                let between = [self.t_min.less(t), t.less_or_equal(Wide::splat(simd, self.t))];
                let hits = may_hit & simd.bits(between[0]) & simd.bits(between[1]);
                if hits != 0 {
                    self.take(hits, t, &block.numbers[at..]);
                }
            }
            at += S::COUNT;
        }
    }

    /// Keeps the nearest hit.
    #[inline(always)]
    fn take(&mut self, mut hits: u32, t: Wide<T, S>, numbers: &[u32]) {
        let mut ts = [T::zero(); MAX_LANES];
        t.store(&mut ts);
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize;
            hits &= hits - 1;
            let (t, number) = (ts[lane], numbers[lane]);
            let is_nearer = t < self.t || (t == self.t && number < self.number);
            if is_nearer && !self.query.excluded.contains(&number) {
                (self.t, self.number) = (t, number);
            }
        }
    }

    /// Returns the child whose box the ray enters first, and pushes the other boxes that it crosses.
    #[inline(always)]
    fn open(
        &self,
        sides: &RayBoxes<T, S>,
        node: &Node<T>,
        open: &mut SmallVec<[(T, Child); 64]>,
    ) -> Option<Child> {
        let (mut hits, nears) = self.cross(sides, node);
        if hits == 0 {
            return None;
        }
        let mut next = || {
            let at = hits.trailing_zeros() as usize % BLOCK_SIZE;
            hits &= hits - 1;
            (at, hits == 0)
        };
        let (mut nearest, mut is_last) = next();
        while !is_last {
            let other;
            (other, is_last) = next();
            let is_nearer = nears[other] < nears[nearest];
            let farther = select_unpredictable(is_nearer, nearest, other);
            nearest = select_unpredictable(is_nearer, other, nearest);
            open.push((nears[farther], node.children[farther]));
        }
        Some(node.children[nearest])
    }

    /// Returns a mask of the boxes of a node that the ray crosses, and t where it enters them.
    #[inline(always)]
    fn cross(&self, sides: &RayBoxes<T, S>, node: &Node<T>) -> (u32, Eight<T>) {
        let simd = self.simd;
        let (origin, near, far) = (self.origin, sides.inverse_near, sides.inverse_far);
        let mut nears = [T::zero(); BLOCK_SIZE];
        let mut misses = 0;
        let mut at = 0;
        while at < BLOCK_SIZE {
            let [near_x, far_x] = sides.axis(node, 0, at, [origin.0, near.0, far.0]);
            let [near_y, far_y] = sides.axis(node, 1, at, [origin.1, near.1, far.1]);
            let [near_z, far_z] = sides.axis(node, 2, at, [origin.2, near.2, far.2]);
            let near = near_x.max(near_y).max(near_z.max(Wide::splat(simd, T::zero())));
            let far = far_x.min(far_y).min(far_z.min(Wide::splat(simd, self.t)));
            near.store(&mut nears[at..]);
            // NaN does not exclude a box.
            misses |= simd.bits(far.less(near)) << at;
            at += S::COUNT;
        }
        (!misses & ((1 << node.count) - 1), nears)
    }
}

/// Slab test of one ray against boxes.
struct RayBoxes<T, S: Lanes<T>> {
    simd: S,
    is_negative: [bool; 3],
    /// The reciprocal direction for entry sides, with the conservative margin.
    inverse_near: Wide3<T, S>,
    /// The reciprocal direction for exit sides, with the conservative margin.
    inverse_far: Wide3<T, S>,
}

impl<T: Real, S: Lanes<T>> RayBoxes<T, S> {
    #[inline(always)]
    fn new(simd: S, direction: [T; 3]) -> Self {
        let [x, y, z] = direction.map(away_from_zero);
        let inverse = Wide3::splat(simd, [x.recip(), y.recip(), z.recip()]);
        Self {
            simd,
            is_negative: [x < T::zero(), y < T::zero(), z < T::zero()],
            inverse_near: inverse * Wide::splat(simd, T::one() - margin()),
            inverse_far: inverse * Wide::splat(simd, T::one() + margin()),
        }
    }

    #[inline(always)]
    fn axis(
        &self,
        node: &Node<T>,
        axis: usize,
        at: usize,
        [origin, inverse_near, inverse_far]: [Wide<T, S>; 3],
    ) -> [Wide<T, S>; 2] {
        let (mut first, mut last) = (&node.low[axis], &node.high[axis]);
        if self.is_negative[axis] {
            (first, last) = (last, first);
        }
        [
            (Wide::load(self.simd, &first[at..]) - origin) * inverse_near,
            (Wide::load(self.simd, &last[at..]) - origin) * inverse_far,
        ]
    }
}

/// Returns the number, or the smallest normal number of the same sign if it is too close to 0 for division.
#[inline(always)]
fn away_from_zero<T: Real>(number: T) -> T {
    let tiny = T::min_positive_value();
    if number.abs() < tiny {
        tiny.copysign(number)
    } else {
        number
    }
}
