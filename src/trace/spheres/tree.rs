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
use super::block::Block;
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

/// The blocks, and the nodes over them, the root first.
pub(super) fn build<T: Real>(spheres: &[Numbered<T>]) -> (Vec<Block<T>>, Vec<Node<T>>) {
    let parameters = BvhBuildParams {
        max_prims_per_leaf: 1,
        ..BvhBuildParams::medium_build()
    };
    let binary = build_bvh2(&boxes(spheres), parameters, &mut std::time::Duration::default());
    let counts = counts(&binary);
    let (mut blocks, mut nodes) = (Vec::new(), vec![Node::empty()]);
    // Each node once its number is known; their roots in the binary tree.
    let mut roots = vec![0];
    let mut at = 0;
    while at < roots.len() {
        let members = members(&binary, &counts, roots[at]);
        nodes[at].count = members.len();
        for (place, member) in members.into_iter().enumerate() {
            if counts[member] > EIGHT as u32 {
                nodes[at].children[place] = Child::node(nodes.len());
                nodes.push(Node::empty());
                roots.push(member);
            } else {
                let below: Vec<_> = below(&binary, member).into_iter().map(|at| spheres[at]).collect();
                let block = Block::new(&below);
                nodes[at].set(place, block.bounds());
                nodes[at].children[place] = Child::block(blocks.len());
                blocks.push(block);
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
    (blocks, nodes)
}

fn children(binary: &Bvh2, node: usize) -> Option<[usize; 2]> {
    let node = &binary.nodes[node];
    let first = node.first_index as usize;
    (node.prim_count == 0).then_some([first, first + 1])
}

/// How many spheres are below each node of the binary tree.
fn counts(binary: &Bvh2) -> Vec<u32> {
    let mut order = vec![0];
    let mut at = 0;
    while at < order.len() {
        order.extend(children(binary, order[at]).into_iter().flatten());
        at += 1;
    }
    let mut counts = vec![0; binary.nodes.len()];
    for node in order.into_iter().rev() {
        counts[node] = match children(binary, node) {
            Some([one, other]) => counts[one] + counts[other],
            None => binary.nodes[node].prim_count,
        };
    }
    counts
}

/// The children of a node with eight: the largest of those that do not fit into a block is opened until they are eight.
fn members(binary: &Bvh2, counts: &[u32], root: usize) -> Vec<usize> {
    let area = |member: usize| binary.nodes[member].aabb.half_area();
    let mut members = vec![root];
    while members.len() < EIGHT {
        let largest = (0..members.len())
            .filter(|&place| counts[members[place]] > EIGHT as u32)
            .max_by(|&a, &b| area(members[a]).total_cmp(&area(members[b])));
        let Some((place, [one, other])) =
            largest.and_then(|place| Some((place, children(binary, members[place])?)))
        else {
            break;
        };
        members[place] = one;
        members.push(other);
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
