//! Packets of rays that are tested together against one sphere after the other, and their hits.

use smallvec::SmallVec;

use super::Spheres;
use super::block::{Block, Reach, Slab, Slabs};
use super::formula::{BLOCK_SIZE, NO_SURFACE, Roots, discriminant};
use super::single_ray::push_sorted;
use super::tree::{Child, Node};
use crate::lanes::{Kernel, Lanes, Wide, Wide3};
use crate::ray::{FirstHit, Ray};
use crate::real::{Real, Vector};

/// Number of rays in a packet: those of 8×8 pixels.
pub(in super::super) const PACKET_RAYS: usize = 64;

/// One number per ray.
pub(super) type Each<T> = [T; PACKET_RAYS];

/// A packet of rays as a structure of arrays.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Packet<T> {
    pub(in super::super) origins: Origins<T>,
    pub(in super::super) directions: [Each<T>; 3],
}

impl<T: Real> Packet<T> {
    /// Creates a full packet of rays that start on no surface.
    pub(in super::super) fn full(origins: Origins<T>, directions: [Each<T>; 3]) -> Self {
        Self { origins, directions }
    }

    #[inline]
    pub(in super::super) fn ray(&self, at: usize) -> Ray<T> {
        let of = |[x, y, z]: &[Each<T>; 3]| T::Vec3::new(x[at], y[at], z[at]);
        Ray {
            origin: match &self.origins {
                Origins::Shared(origin) => T::Vec3::from_array(*origin),
                Origins::Each(origins) => of(origins),
            },
            direction: of(&self.directions),
            from: None,
        }
    }

    /// Returns the origin of each ray.
    pub(in super::super) fn all_origins(&self) -> [Each<T>; 3] {
        match &self.origins {
            Origins::Shared(origin) => origin.map(|component| [component; PACKET_RAYS]),
            Origins::Each(origins) => *origins,
        }
    }

    /// Returns the origins of one ray per lane, from index `at` on.
    #[inline(always)]
    fn lane_origins<S: Lanes<T>>(&self, simd: S, at: usize) -> Wide3<T, S> {
        match &self.origins {
            Origins::Shared(origin) => Wide3::splat(simd, *origin),
            Origins::Each(origins) => Wide3::load(simd, origins, at),
        }
    }
}

/// Origins of rays.
#[derive(Debug)]
pub(in super::super) enum Origins<T> {
    /// All rays start at the same point.
    Shared([T; 3]),
    Each([Each<T>; 3]),
}

/// The nearest hits of the rays of a packet.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct PacketHits<T> {
    /// Infinite if there is no hit.
    pub(super) t: Each<T>,
    /// The index of the sphere, encoded by [`Real::tag`].
    pub(super) tags: Each<T>,
}

impl<T: Real> PacketHits<T> {
    /// No hits.
    pub(in super::super) fn none() -> Self {
        Self {
            t: [T::infinity(); PACKET_RAYS],
            tags: [T::tag(NO_SURFACE); PACKET_RAYS],
        }
    }

    /// Returns t of each ray, infinite if there is no hit.
    pub(in super::super) fn t(&self) -> &Each<T> {
        &self.t
    }

    /// Returns the surface that each ray hits, encoded by [`Real::tag`].
    pub(in super::super) fn surfaces(&self) -> &Each<T> {
        &self.tags
    }

    /// Replaces the hit of a ray if the given one is nearer; see [`FirstHit::update`].
    pub(in super::super) fn update(&mut self, ray: usize, t: Option<T>, surface: usize) {
        let mut first = self.get(ray);
        first.update(t, surface);
        if let Some((t, surface)) = first.get() {
            (self.t[ray], self.tags[ray]) = (t, T::tag(surface as u32));
        }
    }

    /// Replaces the hits of all rays of a packet by those of a surface where these are nearer. `intersect`
    /// maps origins and directions to t, which is not finite if there is no hit.
    #[inline(always)]
    pub(in super::super) fn update_packet<S: Lanes<T>>(
        &mut self,
        simd: S,
        packet: &Packet<T>,
        number: u32,
        intersect: impl Fn(Wide3<T, S>, Wide3<T, S>, Wide<T, S>) -> Wide<T, S>,
    ) {
        let [t_min, infinity] = [T::zero(), T::infinity()].map(|number| Wide::splat(simd, number));
        let mut at = 0;
        while at < PACKET_RAYS {
            let origins = packet.lane_origins(simd, at);
            let t = intersect(origins, Wide3::load(simd, &packet.directions, at), t_min);
            self.update_lanes(simd, at, t.select(t_min.less(t), infinity), number);
            at += S::COUNT;
        }
    }

    /// Replaces the hits of one ray per lane, from index `at` on, where the given ones are nearer; at equal
    /// t, the smaller index wins. Returns whether any t decreased.
    #[inline(always)]
    fn update_lanes<S: Lanes<T>>(&mut self, simd: S, at: usize, t: Wide<T, S>, number: u32) -> bool {
        let before = Wide::load(simd, &self.t[at..]);
        let nearer = t.less(before);
        let nearer_bits = simd.bits(nearer);
        let infinity = Wide::splat(simd, T::infinity());
        let mut ties = simd.bits(t.less_or_equal(before)) & !nearer_bits & simd.bits(t.less(infinity));
        if nearer_bits != 0 {
            let tags = Wide::load(simd, &self.tags[at..]);
            t.select(nearer, before).store(&mut self.t[at..]);
            let tag = Wide::splat(simd, T::tag(number));
            tag.select(nearer, tags).store(&mut self.tags[at..]);
        }
        while ties != 0 {
            let ray = at + ties.trailing_zeros() as usize;
            ties &= ties - 1;
            if number < self.tags[ray].untag() {
                self.tags[ray] = T::tag(number);
            }
        }
        nearer_bits != 0
    }

    #[inline]
    pub(in super::super) fn get(&self, ray: usize) -> FirstHit<T> {
        FirstHit::new(self.t[ray], self.tags[ray].untag())
    }
}

pub(super) struct Nearest<'a, T> {
    pub(super) spheres: &'a Spheres<T>,
    pub(super) packet: &'a Packet<T>,
    pub(super) found: &'a mut PacketHits<T>,
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
        let mut rays = PacketTraversal::new(simd, packet, found);
        if spheres.tree.nodes.is_empty() {
            for (block, reach) in spheres.tree.blocks.iter().zip(&spheres.tree.reaches) {
                rays.intersect_block(block, reach);
            }
            return;
        }
        let mut stack: SmallVec<[(T, Child); 64]> = SmallVec::new();
        let mut next = Child::ROOT;
        loop {
            match next.get() {
                Ok(node) => rays.visit_node(&spheres.tree.nodes[node], &mut stack),
                Err(block) => rays.intersect_block(&spheres.tree.blocks[block], &spheres.tree.reaches[block]),
            }
            next = loop {
                match stack.pop() {
                    None => return,
                    Some((near, _)) if near > rays.limit => {}
                    Some((_, child)) => break child,
                }
            };
        }
    }
}

/// Traversal of the spheres by a packet.
struct PacketTraversal<'a, T, S: Lanes<T>> {
    simd: S,
    packet: &'a Packet<T>,
    a: Each<T>,
    inverse_a: Each<T>,
    slabs: Slabs<T, S::Eight>,
    found: &'a mut PacketHits<T>,
    /// The largest t of the hits so far.
    limit: T,
}

/// Returns the smallest and the largest number, or the full range of the type if any number is not finite.
#[inline(always)]
fn range<T: Real, S: Lanes<T>>(simd: S, numbers: &[T]) -> [T; 2] {
    let mut low = Wide::load(simd, numbers);
    let zero = Wide::splat(simd, T::zero());
    // NaN if any number is NaN or infinite.
    let (mut high, mut not_finite) = (low, low * zero);
    let mut at = S::COUNT;
    while at < numbers.len() {
        let more = Wide::load(simd, &numbers[at..]);
        (low, high, not_finite) = (low.min(more), high.max(more), not_finite + more * zero);
        at += S::COUNT;
    }
    let not_finite = not_finite.reduce_sum();
    if not_finite == T::zero() {
        [low.reduce_min(), high.reduce_max()]
    } else {
        [T::min_value(), T::max_value()]
    }
}

/// Returns the largest number; none may be NaN.
#[inline(always)]
fn largest<T: Real, S: Lanes<T>>(simd: S, numbers: &[T]) -> T {
    let mut high = Wide::load(simd, numbers);
    let mut at = S::COUNT;
    while at < numbers.len() {
        high = high.max(Wide::load(simd, &numbers[at..]));
        at += S::COUNT;
    }
    high.reduce_max()
}

impl<'a, T: Real, S: Lanes<T>> PacketTraversal<'a, T, S> {
    #[inline(always)]
    fn new(simd: S, packet: &'a Packet<T>, found: &'a mut PacketHits<T>) -> Self {
        let (mut a, mut inverse_a) = ([T::zero(); PACKET_RAYS], [T::zero(); PACKET_RAYS]);
        let mut at = 0;
        while at < PACKET_RAYS {
            let d = Wide3::load(simd, &packet.directions, at);
            d.dot(d).store(&mut a[at..]);
            (Wide::splat(simd, T::one()) / d.dot(d)).store(&mut inverse_a[at..]);
            at += S::COUNT;
        }
        Self {
            simd,
            packet,
            a,
            inverse_a,
            slabs: Slabs(
                Self::slab(simd, packet, 0),
                Self::slab(simd, packet, 1),
                Self::slab(simd, packet, 2),
            ),
            limit: largest(simd, &found.t),
            found,
        }
    }

    #[inline(always)]
    fn slab(simd: S, packet: &Packet<T>, axis: usize) -> Slab<T, S::Eight> {
        let origins = match &packet.origins {
            Origins::Shared(origin) => [origin[axis]; 2],
            Origins::Each(origins) => range(simd, &origins[axis]),
        };
        let directions = range(simd, &packet.directions[axis]);
        Slab::new(simd.eight(), origins, directions)
    }

    /// Intersects all rays with those spheres of a block that any ray may hit.
    #[inline(always)]
    fn intersect_block(&mut self, block: &Block<T>, reaches: &Reach<T>) {
        let mut hits = !self.misses(block, reaches) & ((1 << reaches.count) - 1);
        let mut is_changed = false;
        while hits != 0 {
            let at = hits.trailing_zeros() as usize % BLOCK_SIZE;
            hits &= hits - 1;
            is_changed |= self.intersect_sphere(block, at);
        }
        if is_changed {
            self.limit = largest(self.simd, &self.found.t);
        }
    }

    /// Returns a mask of the spheres of a block that no ray can hit.
    #[inline(always)]
    fn misses(&self, block: &Block<T>, reaches: &Reach<T>) -> u32 {
        let simd = self.simd.eight();
        let mut misses = 0;
        let mut at = 0;
        while at < BLOCK_SIZE {
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

    /// Intersects all rays with one sphere. Returns whether any t decreased.
    #[inline(always)]
    fn intersect_sphere(&mut self, block: &Block<T>, slot: usize) -> bool {
        let simd = self.simd;
        let [cx, cy, cz] = &block.center;
        let center = Wide3::splat(simd, [cx[slot], cy[slot], cz[slot]]);
        let inverse_unit = Wide::splat(simd, block.inverse_unit[slot]);
        let radius2 = Wide::splat(simd, block.radius2[slot]);
        let mut is_changed = false;
        match &self.packet.origins {
            Origins::Shared(origin) => {
                let f = (Wide3::splat(simd, *origin) - center) * inverse_unit;
                let c = f.dot(f) - radius2;
                let mut at = 0;
                while at < PACKET_RAYS {
                    is_changed |= self.intersect_lanes(at, block, slot, f, c, radius2);
                    at += S::COUNT;
                }
            }
            Origins::Each(origins) => {
                let mut at = 0;
                while at < PACKET_RAYS {
                    let f = (Wide3::load(simd, origins, at) - center) * inverse_unit;
                    let c = f.dot(f) - radius2;
                    is_changed |= self.intersect_lanes(at, block, slot, f, c, radius2);
                    at += S::COUNT;
                }
            }
        }
        is_changed
    }

    /// Intersects one ray per lane, from index `at` on.
    #[inline(always)]
    fn intersect_lanes(
        &mut self,
        at: usize,
        block: &Block<T>,
        slot: usize,
        f: Wide3<T, S>,
        c: Wide<T, S>,
        radius2: Wide<T, S>,
    ) -> bool {
        let simd = self.simd;
        let d = Wide3::load(simd, &self.packet.directions, at);
        let [along, disc] = discriminant(f, d, Wide::load(simd, &self.inverse_a[at..]), radius2);
        let [zero, t_min, infinity] =
            [T::zero(), T::zero(), T::infinity()].map(|number| Wide::splat(simd, number));
        let number = block.numbers[slot];
        let may_hit = zero.less_or_equal(disc);
        if simd.bits(may_hit) == 0 {
            return false;
        }
        let a = Wide::load(simd, &self.a[at..]);
        let unit = Wide::splat(simd, block.inverse_unit[slot].recip());
        let roots = Roots {
            along,
            disc,
            a,
            c,
            unit,
        };
        let t = roots.beyond(simd, t_min).select(may_hit, infinity);
        let t = t.select(t_min.less(t), infinity);
        self.found.update_lanes(simd, at, t, number)
    }

    /// Pushes the children that any ray may reach.
    #[inline(always)]
    fn visit_node(&self, node: &Node<T>, stack: &mut SmallVec<[(T, Child); 64]>) {
        let simd = self.simd.eight();
        let mut nears = [T::zero(); BLOCK_SIZE];
        let mut misses = 0;
        let mut at = 0;
        while at < BLOCK_SIZE {
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
        let base = stack.len();
        while hits != 0 {
            let at = hits.trailing_zeros() as usize % BLOCK_SIZE;
            hits &= hits - 1;
            push_sorted(stack, base, (nears[at], node.children[at]));
        }
    }
}
