//! Construction of a binary tree of spheres by the surface area heuristic.
//!
//! A set of spheres is split where the expected cost of a ray is smallest, among planes between sixteen bins
//! on each axis: I. Wald, “On fast Construction of SAH-based Bounding Volume Hierarchies”, 2007. Leaves are
//! sets that fit into a block, and the cost of a set is the number of its blocks, so that splits leave few
//! blocks half empty.

use glam::{BVec3A, Vec3A};

use super::formula::{BLOCK_SIZE, NumberedSphere};
use crate::real::Real;

/// The most bins on an axis.
const BINS: usize = 16;

/// A box in f32. No box is empty but [`Box3::NONE`].
#[derive(Debug, Clone, Copy)]
struct Box3 {
    low: Vec3A,
    high: Vec3A,
}

impl Box3 {
    const NONE: Self = Self {
        low: Vec3A::INFINITY,
        high: Vec3A::NEG_INFINITY,
    };

    #[inline]
    fn merge(&mut self, low: Vec3A, high: Vec3A) {
        self.low = self.low.min(low);
        self.high = self.high.max(high);
    }

    /// Half of the surface; 0 for no box.
    #[inline]
    fn half_area(&self) -> f32 {
        let size = (self.high - self.low).max(Vec3A::ZERO);
        size.x * (size.y + size.z) + size.y * size.z
    }
}

/// A sphere, scaled so that all are within a unit of the origin.
#[derive(Debug, Clone, Copy)]
struct Item {
    center: Vec3A,
    radius: f32,
    index: u32,
}

/// A set of spheres.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// The place of the first sphere in the order of the tree.
    first: u32,
    count: u32,
    half_area: f32,
    /// The index of the first of the two halves, which are next to each other; 0 for a leaf.
    halves: u32,
}

/// A binary tree, whose leaves have at most [`BLOCK_SIZE`] spheres. The root is node 0, and halves have
/// larger indices than their union.
#[derive(Debug)]
pub(super) struct BinaryTree {
    nodes: Vec<Node>,
    /// The indices of the spheres, in an order in which each node has a contiguous range.
    order: Vec<u32>,
}

impl BinaryTree {
    pub(super) fn build<T: Real>(spheres: &[NumberedSphere<T>]) -> Self {
        let mut items = items(spheres);
        let mut nodes = Vec::with_capacity(items.len() / 2 + 1);
        let (boxes, centers) = bounds(&items);
        nodes.push(Node {
            first: 0,
            count: items.len() as u32,
            half_area: boxes.half_area(),
            halves: 0,
        });
        // Sets to split, with the box of their centers.
        let mut open = vec![(0, centers)];
        while let Some((at, centers)) = open.pop() {
            let Node { first, count, .. } = nodes[at];
            if count as usize <= BLOCK_SIZE {
                continue;
            }
            let set = &mut items[first as usize..][..count as usize];
            // Centers that are not numbers have no order.
            let split = Split::best(set, centers).map(|split| split.partition(set));
            let left_count = split
                .filter(|&left| 0 < left && left < set.len())
                .unwrap_or(set.len() / 2);
            let halves = nodes.len();
            nodes[at].halves = halves as u32;
            let (left, right) = set.split_at(left_count);
            for (half, first) in [(left, first), (right, first + left_count as u32)] {
                let (boxes, centers) = bounds(half);
                open.push((nodes.len(), centers));
                nodes.push(Node {
                    first,
                    count: half.len() as u32,
                    half_area: boxes.half_area(),
                    halves: 0,
                });
            }
        }
        let order = items.into_iter().map(|item| item.index).collect();
        Self { nodes, order }
    }

    /// Number of leaves.
    pub(super) fn leaves(&self) -> usize {
        self.nodes.len().div_ceil(2)
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Half of the surface of a node's box, in the units of the tree.
    pub(super) fn half_area(&self, node: usize) -> f32 {
        self.nodes[node].half_area
    }

    /// Returns the halves of a node, or nothing for a leaf.
    pub(super) fn halves(&self, node: usize) -> Option<[usize; 2]> {
        let halves = self.nodes[node].halves as usize;
        (halves != 0).then_some([halves, halves + 1])
    }

    /// Returns the indices of the spheres of a node.
    pub(super) fn spheres(&self, node: usize) -> &[u32] {
        let Node { first, count, .. } = self.nodes[node];
        &self.order[first as usize..][..count as usize]
    }
}

/// Scales the spheres to [−1, 1] to fit into f32: they only determine the topology.
fn items<T: Real>(spheres: &[NumberedSphere<T>]) -> Vec<Item> {
    let numbers = |sphere: &NumberedSphere<T>| {
        let [x, y, z] = sphere.center;
        [x, y, z, sphere.radius].map(|number| number.to_f64().abs())
    };
    let size = spheres.iter().flat_map(numbers).fold(0.0, f64::max);
    let normalized = |number: T| (0.5 * (number.to_f64() / size)) as f32;
    let item = |(index, sphere): (usize, &NumberedSphere<T>)| Item {
        center: Vec3A::from_array(sphere.center.map(normalized)),
        radius: normalized(sphere.radius),
        index: index as u32,
    };
    spheres.iter().enumerate().map(item).collect()
}

/// Returns the box of spheres and that of their centers.
fn bounds(items: &[Item]) -> (Box3, Box3) {
    let (mut boxes, mut centers) = (Box3::NONE, Box3::NONE);
    for item in items {
        boxes.merge(item.center - item.radius, item.center + item.radius);
        centers.merge(item.center, item.center);
    }
    (boxes, centers)
}

/// The spheres whose centers are in one of the bins of each axis.
#[derive(Debug, Clone, Copy)]
struct Bin {
    boxes: Box3,
    count: u32,
}

/// A plane between bins.
#[derive(Debug, Clone, Copy)]
struct Split {
    grid: Grid,
    axis: usize,
    /// The first bin beyond the plane.
    bin: i32,
}

/// The bins of a set on each axis.
#[derive(Debug, Clone, Copy)]
struct Grid {
    low: Vec3A,
    /// Bins per unit of length; 0 on an axis on which all centers are equal.
    scale: Vec3A,
    last: Vec3A,
}

impl Grid {
    fn new(centers: Box3, bins: usize) -> Self {
        let size = centers.high - centers.low;
        let is_flat: BVec3A = size.cmple(Vec3A::ZERO);
        Self {
            low: centers.low,
            scale: Vec3A::select(is_flat, Vec3A::ZERO, bins as f32 / size),
            last: Vec3A::splat((bins - 1) as f32),
        }
    }

    /// Returns the bin of a center on each axis.
    #[inline]
    fn bins(&self, center: Vec3A) -> [i32; 3] {
        let at = ((center - self.low) * self.scale).min(self.last);
        [at.x as i32, at.y as i32, at.z as i32]
    }

    /// Returns the bin of a center on one axis, the same as [`Grid::bins`].
    #[inline]
    fn bin(&self, center: Vec3A, axis: usize) -> i32 {
        let number = |of: &Vec3A| AsRef::<[f32; 3]>::as_ref(of)[axis];
        let at = (number(&center) - number(&self.low)) * number(&self.scale);
        at.min(number(&self.last)) as i32
    }
}

impl Split {
    /// Finds the best split of a set, or `None` if all its centers are in one place.
    fn best(set: &[Item], centers: Box3) -> Option<Self> {
        let bins = BINS.min(4 + set.len() / 8);
        let grid = Grid::new(centers, bins);
        let empty = Bin {
            boxes: Box3::NONE,
            count: 0,
        };
        let mut table = [[empty; BINS]; 3];
        for item in set {
            let (low, high) = (item.center - item.radius, item.center + item.radius);
            for (of_axis, bin) in table.iter_mut().zip(grid.bins(item.center)) {
                let bin = &mut of_axis[bin as usize % BINS];
                bin.boxes.merge(low, high);
                bin.count += 1;
            }
        }
        let mut best: Option<(f32, Self)> = None;
        for (axis, of_axis) in table.iter().enumerate() {
            let of_axis = &of_axis[..bins];
            // The cost of the spheres beyond each plane, from the last plane down.
            let mut beyond = [0.0; BINS];
            let mut union = empty;
            for at in (1..bins).rev() {
                union.add(&of_axis[at]);
                beyond[at] = union.cost();
            }
            let mut union = empty;
            for at in 1..bins {
                union.add(&of_axis[at - 1]);
                let is_split = union.count > 0 && union.count < set.len() as u32;
                let cost = union.cost() + beyond[at];
                if is_split && best.is_none_or(|(least, _)| cost < least) {
                    let bin = at as i32;
                    best = Some((cost, Self { grid, axis, bin }));
                }
            }
        }
        best.map(|(_, split)| split)
    }

    /// Moves the spheres before the plane to the front, and returns their number. Without branches, which
    /// would be taken at random.
    fn partition(&self, set: &mut [Item]) -> usize {
        let mut left = 0;
        for at in 0..set.len() {
            let is_left = self.grid.bin(set[at].center, self.axis) < self.bin;
            set.swap(left, at);
            left += usize::from(is_left);
        }
        left
    }
}

impl Bin {
    fn add(&mut self, other: &Self) {
        self.boxes.merge(other.boxes.low, other.boxes.high);
        self.count += other.count;
    }

    /// The expected cost of a ray that enters the box around this set, in blocks and per unit of surface.
    fn cost(&self) -> f32 {
        self.boxes.half_area() * self.count.div_ceil(BLOCK_SIZE as u32) as f32
    }
}
