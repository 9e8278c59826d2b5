//! A tree of boxes over blocks of spheres, eight to a node.
//!
//! obvhs builds a binary tree in f32 (D. Meister and J. Bittner, “Parallel Locally-Ordered Clustering for Bounding Volume
//! Hierarchy Construction”, 2018), of which only the shape is kept: nodes take in their largest descendants until they
//! have eight children, and the boxes are made anew, in the tracer's number type, from the spheres.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};

use super::super::real::Real;
use super::block::{Block, Reach, block};
use super::{EIGHT, Eight, Numbered};

/// Up to eight boxes. Places that are empty hold boxes that are inside out.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Node<T> {
    pub(super) low: [Eight<T>; 3],
    pub(super) high: [Eight<T>; 3],
    pub(super) children: [Child; EIGHT],
    pub(super) count: usize,
}

/// A node or a block, by its number among them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Child(u32);

impl Child {
    pub(super) const ROOT: Self = Self(0);
    const BLOCK: u32 = 1 << 31;

    fn node(number: usize) -> Self {
        Self(number as u32)
    }

    fn block(number: usize) -> Self {
        Self(number as u32 | Self::BLOCK)
    }

    /// The number of the node, or else that of the block.
    #[inline(always)]
    pub(super) fn get(self) -> Result<usize, usize> {
        if self.0 & Self::BLOCK == 0 {
            Ok(self.0 as usize)
        } else {
            Err((self.0 & !Self::BLOCK) as usize)
        }
    }
}

impl<T: Real> Node<T> {
    fn empty() -> Self {
        Self {
            low: [[T::infinity(); EIGHT]; 3],
            high: [[T::neg_infinity(); EIGHT]; 3],
            children: [Child::ROOT; EIGHT],
            count: 0,
        }
    }

    fn set(&mut self, at: usize, [low, high]: [[T; 3]; 2]) {
        for axis in 0..3 {
            self.low[axis][at] = low[axis];
            self.high[axis][at] = high[axis];
        }
    }

    fn bounds(&self) -> [[T; 3]; 2] {
        [
            [0, 1, 2].map(|axis| self.low[axis].into_iter().fold(T::infinity(), T::min)),
            [0, 1, 2].map(|axis| self.high[axis].into_iter().fold(T::neg_infinity(), T::max)),
        ]
    }
}

struct Box32(Aabb);

impl Boundable for Box32 {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// The spheres' boxes, all brought between −1 and 1, so that f32 holds them: they only shape the tree.
fn boxes<T: Real>(spheres: &[Numbered<T>]) -> Vec<Box32> {
    let numbers = |sphere: &Numbered<T>| {
        let [x, y, z] = sphere.center;
        [x, y, z, sphere.radius].map(|number| number.to_f64().abs())
    };
    let size = spheres.iter().flat_map(numbers).fold(0.0, f64::max);
    let brought = |number: T| (0.5 * (number.to_f64() / size)) as f32;
    spheres
        .iter()
        .map(|sphere| {
            let center = Vec3A::from_array(sphere.center.map(brought));
            let radius = brought(sphere.radius);
            Box32(Aabb::new(center - radius, center + radius))
        })
        .collect()
}

/// Blocks, and how far each reaches.
pub(super) type Blocks<T> = (Vec<Block<T>>, Vec<Reach<T>>);

/// The blocks, how far they reach, and the nodes over them, the root first.
pub(super) fn build<T: Real>(spheres: &[Numbered<T>]) -> (Blocks<T>, Vec<Node<T>>) {
    let parameters = BvhBuildParams {
        max_prims_per_leaf: 1,
        ..BvhBuildParams::medium_build()
    };
    let binary = build_bvh2(&boxes(spheres), parameters, &mut std::time::Duration::default());
    let ways = ways(&binary);
    let (mut blocks, mut reaches): Blocks<T> = (Vec::new(), Vec::new());
    let mut nodes = vec![Node::empty()];
    // Each node once its number is known; their roots in the binary tree.
    let mut roots = vec![0];
    let mut at = 0;
    while at < roots.len() {
        let members = members(&binary, &ways, roots[at]);
        nodes[at].count = members.len();
        for (place, member) in members.into_iter().enumerate() {
            if ways[member].count <= EIGHT as u32 {
                let below: Vec<_> = below(&binary, member).into_iter().map(|at| spheres[at]).collect();
                let (block, reach) = block(&below);
                nodes[at].set(place, reach.bounds(&block));
                nodes[at].children[place] = Child::block(blocks.len());
                blocks.push(block);
                reaches.push(reach);
            } else {
                nodes[at].children[place] = Child::node(nodes.len());
                nodes.push(Node::empty());
                roots.push(member);
            }
        }
        at += 1;
    }
    // Children have larger numbers than their parents.
    for at in (0..nodes.len()).rev() {
        for place in 0..nodes[at].count {
            if let Ok(child) = nodes[at].children[place].get() {
                let bounds = nodes[child].bounds();
                nodes[at].set(place, bounds);
            }
        }
    }
    ((blocks, reaches), nodes)
}

fn children(binary: &Bvh2, node: usize) -> Option<[usize; 2]> {
    let node = &binary.nodes[node];
    let first = node.first_index as usize;
    (node.prim_count == 0).then_some([first, first + 1])
}

/// The cheapest ways to make a subtree of the binary tree into children of a node, by the surface area heuristic: H. Ylitie,
/// T. Karras and S. Laine, “Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs”, 2017, section 3. A node
/// and a block cost the same, however full they are, and what fits into a block is one.
#[derive(Debug, Clone, Copy, Default)]
struct Ways {
    /// How many spheres there are.
    count: u32,
    /// What it costs as at most 1, 2, … children.
    costs: [f32; EIGHT - 1],
    /// How many of them come from each half; none where it is one child.
    halves: [[u8; 2]; EIGHT - 1],
    /// The same for the children of the node that it is.
    of_node: [u8; 2],
}

impl Ways {
    fn block(count: u32, area: f32) -> Self {
        Self {
            count,
            costs: [area; EIGHT - 1],
            ..Self::default()
        }
    }

    fn of(area: f32, [one, other]: [&Self; 2]) -> Self {
        let parted = |children: usize| {
            (1..children)
                .map(|k| {
                    (
                        one.costs[k - 1] + other.costs[children - k - 1],
                        [k as u8, (children - k) as u8],
                    )
                })
                .min_by(|(a, _), (b, _)| a.total_cmp(b))
        };
        let count = one.count + other.count;
        if count <= EIGHT as u32 {
            return Self::block(count, area);
        }
        let (below, of_node) = parted(EIGHT).unwrap_or_default();
        let mut ways = Self {
            count,
            of_node,
            ..Self::default()
        };
        let mut best = (area + below, [0; 2]);
        for at in 0..EIGHT - 1 {
            if let Some(more) = parted(at + 1)
                && more.0 < best.0
            {
                best = more;
            }
            (ways.costs[at], ways.halves[at]) = best;
        }
        ways
    }
}

/// Those of each node of the binary tree.
fn ways(binary: &Bvh2) -> Vec<Ways> {
    let mut order = vec![0];
    let mut at = 0;
    while at < order.len() {
        order.extend(children(binary, order[at]).into_iter().flatten());
        at += 1;
    }
    let mut ways = vec![Ways::default(); binary.nodes.len()];
    for node in order.into_iter().rev() {
        let area = binary.nodes[node].aabb.half_area();
        ways[node] = match children(binary, node) {
            Some(two) => Ways::of(area, two.map(|child| &ways[child])),
            None => Ways::block(binary.nodes[node].prim_count, area),
        };
    }
    ways
}

/// The children of a node.
fn members(binary: &Bvh2, ways: &[Ways], root: usize) -> Vec<usize> {
    let mut members = Vec::new();
    let mut open = vec![(root, ways[root].of_node)];
    while let Some((node, halves)) = open.pop() {
        match (children(binary, node), halves) {
            (Some([one, other]), [left, right]) if left > 0 => {
                for (child, share) in [(other, right), (one, left)] {
                    open.push((child, ways[child].halves[usize::from(share) - 1]));
                }
            }
            _ => members.push(node),
        }
    }
    members
}

/// The spheres below a node of the binary tree.
fn below(binary: &Bvh2, root: usize) -> Vec<usize> {
    let mut spheres = Vec::new();
    let mut open = vec![root];
    while let Some(node) = open.pop() {
        if let Some(two) = children(binary, node) {
            open.extend(two);
        } else {
            let node = &binary.nodes[node];
            let first = node.first_index as usize;
            let indices = &binary.primitive_indices[first..first + node.prim_count as usize];
            spheres.extend(indices.iter().map(|&index| index as usize));
        }
    }
    spheres
}
