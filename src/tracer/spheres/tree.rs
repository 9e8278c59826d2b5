//! Bounding volume hierarchy with eight children per node, over blocks of spheres.
//!
//! obvhs builds a binary tree in f32 (D. Meister and J. Bittner, “Parallel Locally-Ordered Clustering for
//! Bounding Volume Hierarchy Construction”, 2018), of which only the topology is kept: [`Collapse`] converts
//! it to eight children per node, and the boxes are recomputed from the spheres in the tracer's number type.
//! When spheres move, the tree is refitted, as long as its boxes do not become much larger.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};
use smallvec::SmallVec;

use super::block::{Block, Reach, block};
use super::{BLOCK_SIZE, Eight, NumberedSphere};
use crate::real::Real;

/// Up to eight boxes. Empty slots hold inverted boxes.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Node<T> {
    pub(super) low: [Eight<T>; 3],
    pub(super) high: [Eight<T>; 3],
    pub(super) children: [Child; BLOCK_SIZE],
    pub(super) count: usize,
}

/// Index of a node or of a block.
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

    /// Returns the index of the node, or as an error that of the block.
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
            low: [[T::infinity(); BLOCK_SIZE]; 3],
            high: [[T::neg_infinity(); BLOCK_SIZE]; 3],
            children: [Child::ROOT; BLOCK_SIZE],
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

/// Returns the boxes of the spheres, scaled to [−1, 1] to fit into f32. They only determine the topology.
fn boxes<T: Real>(spheres: &[NumberedSphere<T>]) -> Vec<Box32> {
    let numbers = |sphere: &NumberedSphere<T>| {
        let [x, y, z] = sphere.center;
        [x, y, z, sphere.radius].map(|number| number.to_f64().abs())
    };
    let size = spheres.iter().flat_map(numbers).fold(0.0, f64::max);
    let normalized = |number: T| (0.5 * (number.to_f64() / size)) as f32;
    spheres
        .iter()
        .map(|sphere| {
            let center = Vec3A::from_array(sphere.center.map(normalized));
            let radius = normalized(sphere.radius);
            Box32(Aabb::new(center - radius, center + radius))
        })
        .collect()
}

/// Blocks with their bounds, and the nodes above them, root first. A few blocks have no nodes.
#[derive(Debug)]
pub(super) struct Tree<T> {
    pub(super) blocks: Vec<Block<T>>,
    pub(super) reaches: Vec<Reach<T>>,
    pub(super) nodes: Vec<Node<T>>,
    /// Expected traversal cost when it was built.
    cost: f64,
}

/// Largest growth of the cost by refitting, relative to the cost when built, before the tree is rebuilt.
const MAX_COST_RATIO: f64 = 2.0;

impl<T: Real> Tree<T> {
    /// Builds blocks in the order of the spheres, without nodes.
    pub(super) fn without_nodes(spheres: &[NumberedSphere<T>]) -> Self {
        let (blocks, reaches) = spheres.chunks(BLOCK_SIZE).map(block).unzip();
        Self {
            blocks,
            reaches,
            nodes: Vec::new(),
            cost: 0.0,
        }
    }

    pub(super) fn build(spheres: &[NumberedSphere<T>]) -> Self {
        let parameters = BvhBuildParams {
            max_prims_per_leaf: 1,
            ..BvhBuildParams::medium_build()
        };
        let binary = build_bvh2(&boxes(spheres), parameters, &mut std::time::Duration::default());
        let collapse = Collapse::new(&binary);
        let mut tree = Self {
            nodes: vec![Node::empty()],
            ..Self::without_nodes(&[])
        };
        // Roots, in the binary tree, of the nodes created so far.
        let mut roots = vec![0];
        let (mut below, mut at) = (Vec::new(), 0);
        while at < roots.len() {
            let members = collapse.members(roots[at]);
            tree.nodes[at].count = members.len();
            for (slot, member) in members.into_iter().enumerate() {
                if collapse.is_block(member) {
                    below.clear();
                    below.extend(collapse.spheres(member).into_iter().map(|at| spheres[at]));
                    tree.nodes[at].children[slot] = Child::block(tree.blocks.len());
                    let (block, reach) = block(&below);
                    tree.blocks.push(block);
                    tree.reaches.push(reach);
                } else {
                    tree.nodes[at].children[slot] = Child::node(tree.nodes.len());
                    tree.nodes.push(Node::empty());
                    roots.push(member);
                }
            }
            at += 1;
        }
        tree.refit();
        tree.cost = tree.cost();
        tree
    }

    /// Moves the spheres, which are given in increasing order of their indices. Returns false if the tree
    /// must be rebuilt.
    pub(super) fn refit_to(&mut self, spheres: &[NumberedSphere<T>]) -> bool {
        let mut below = Vec::with_capacity(BLOCK_SIZE);
        for (old, reach) in self.blocks.iter_mut().zip(&mut self.reaches) {
            below.clear();
            for number in &old.numbers[..reach.count] {
                let Ok(at) = spheres.binary_search_by_key(number, |sphere| sphere.number) else {
                    return false;
                };
                below.push(spheres[at]);
            }
            (*old, *reach) = block(&below);
        }
        self.refit();
        // NaN fails the comparison.
        self.cost() <= MAX_COST_RATIO * self.cost
    }

    /// Recomputes all boxes, from the leaves up.
    fn refit(&mut self) {
        // Children have larger indices than their parents.
        for at in (0..self.nodes.len()).rev() {
            for slot in 0..self.nodes[at].count {
                let bounds = match self.nodes[at].children[slot].get() {
                    Ok(child) => self.nodes[child].bounds(),
                    Err(block) => self.reaches[block].bounds(&self.blocks[block]),
                };
                self.nodes[at].set(slot, bounds);
            }
        }
    }

    /// Computes the expected cost of a ray through the tree by the surface area heuristic: the sum of the
    /// areas of all boxes relative to that of the root.
    fn cost(&self) -> f64 {
        let area = |[low, high]: [[T; 3]; 2]| {
            let [x, y, z] = [0, 1, 2].map(|axis| (high[axis] - low[axis]).to_f64());
            x * y + y * z + z * x
        };
        let all = self.nodes.first().map_or(1.0, |root| area(root.bounds()));
        let areas = self.nodes.iter().map(|node| {
            let corner = |of: &[Eight<T>; 3], slot: usize| [0, 1, 2].map(|axis| of[axis][slot]);
            let boxes = (0..node.count).map(|slot| [&node.low, &node.high].map(|of| corner(of, slot)));
            boxes.map(area).sum::<f64>()
        });
        areas.sum::<f64>() / all
    }
}

// Conversion of a binary tree to eight children per node: selects the subtrees that become children by the
// surface area heuristic.
//
// H. Ylitie, T. Karras and S. Laine, “Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs”, 2017, section 3. Unlike there, the cost of a node or a block does not depend on how full it is, and
// each subtree that fits into a block becomes one.

/// Smallest costs of representing a subtree by a number of children.
#[derive(Debug, Clone, Copy)]
struct SubtreeCosts {
    /// Cost for at most 1, 2, … children.
    costs: [f32; BLOCK_SIZE - 1],
    /// Number of children taken from each half; 0 if the subtree is a single child.
    halves: [[u8; 2]; BLOCK_SIZE - 1],
    /// The same for the eight children of the node that represents the subtree.
    of_node: [u8; 2],
}

impl SubtreeCosts {
    /// Combines the costs of two halves.
    fn of(area: f32, [one, other]: [[f32; BLOCK_SIZE - 1]; 2]) -> Self {
        let partition = |children: usize| {
            (1..children)
                .map(|k| {
                    (
                        one[k - 1] + other[children - k - 1],
                        [k as u8, (children - k) as u8],
                    )
                })
                .min_by(|(a, _), (b, _)| a.total_cmp(b))
        };
        let (below, of_node) = partition(BLOCK_SIZE).unwrap_or_default();
        let mut subtrees = Self {
            costs: [0.0; BLOCK_SIZE - 1],
            halves: [[0; 2]; BLOCK_SIZE - 1],
            of_node,
        };
        let mut best = (area + below, [0; 2]);
        for at in 0..BLOCK_SIZE - 1 {
            if let Some(more) = partition(at + 1)
                && more.0 < best.0
            {
                best = more;
            }
            (subtrees.costs[at], subtrees.halves[at]) = best;
        }
        subtrees
    }
}

/// A binary tree over more spheres than fit into a block, with the costs of its subtrees.
struct Collapse<'a> {
    binary: &'a Bvh2,
    /// Number of spheres below each node of the binary tree.
    counts: Vec<u32>,
    /// Costs of each subtree that is not a block, and their indices by node.
    subtrees: Vec<SubtreeCosts>,
    subtree_index: Vec<u32>,
}

impl<'a> Collapse<'a> {
    fn new(binary: &'a Bvh2) -> Self {
        let counts = counts(binary);
        let mut collapse = Self {
            binary,
            subtree_index: vec![0; counts.len()],
            counts,
            subtrees: Vec::new(),
        };
        for node in top_down(binary, |node| !collapse.is_block(node))
            .into_iter()
            .rev()
        {
            let node = node as usize;
            let Some(pair) = children(binary, node).filter(|_| !collapse.is_block(node)) else {
                continue;
            };
            let costs = pair.map(|child| {
                if collapse.is_block(child) {
                    [collapse.area(child); BLOCK_SIZE - 1]
                } else {
                    collapse.subtree(child).costs
                }
            });
            collapse.subtree_index[node] = collapse.subtrees.len() as u32;
            collapse
                .subtrees
                .push(SubtreeCosts::of(collapse.area(node), costs));
        }
        collapse
    }

    /// Returns whether a subtree fits into a block.
    fn is_block(&self, node: usize) -> bool {
        self.counts[node] <= BLOCK_SIZE as u32
    }

    fn area(&self, node: usize) -> f32 {
        self.binary.nodes[node].aabb.half_area()
    }

    fn subtree(&self, node: usize) -> &SubtreeCosts {
        &self.subtrees[self.subtree_index[node] as usize]
    }

    /// Returns the children of the node that represents a subtree.
    fn members(&self, root: usize) -> SmallVec<[usize; BLOCK_SIZE]> {
        let mut members = SmallVec::new();
        let mut open: SmallVec<[_; BLOCK_SIZE]> = SmallVec::from_iter([(root, self.subtree(root).of_node)]);
        while let Some((node, halves)) = open.pop() {
            match (children(self.binary, node), halves) {
                (Some([one, other]), [left, right]) if left > 0 => {
                    for (child, share) in [(other, right), (one, left)] {
                        let halves = if self.is_block(child) {
                            [0; 2]
                        } else {
                            self.subtree(child).halves[usize::from(share) - 1]
                        };
                        open.push((child, halves));
                    }
                }
                _ => members.push(node),
            }
        }
        members
    }

    /// Returns the spheres of a subtree.
    fn spheres(&self, root: usize) -> SmallVec<[usize; BLOCK_SIZE]> {
        let mut spheres = SmallVec::new();
        let mut open: SmallVec<[_; BLOCK_SIZE]> = SmallVec::from_iter([root]);
        while let Some(node) = open.pop() {
            if let Some(pair) = children(self.binary, node) {
                open.extend(pair);
            } else {
                let node = &self.binary.nodes[node];
                let first = node.first_index as usize;
                let indices = &self.binary.primitive_indices[first..first + node.prim_count as usize];
                spheres.extend(indices.iter().map(|&index| index as usize));
            }
        }
        spheres
    }
}

fn children(binary: &Bvh2, node: usize) -> Option<[usize; 2]> {
    let node = &binary.nodes[node];
    let first = node.first_index as usize;
    (node.prim_count == 0).then_some([first, first + 1])
}

/// Lists the nodes below the root, parents before children, descending only into open nodes.
fn top_down(binary: &Bvh2, is_open: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut nodes = vec![0];
    let mut at = 0;
    while at < nodes.len() {
        let node = nodes[at] as usize;
        if is_open(node) {
            nodes.extend(
                children(binary, node)
                    .into_iter()
                    .flatten()
                    .map(|child| child as u32),
            );
        }
        at += 1;
    }
    nodes
}

/// Counts the spheres below each node.
fn counts(binary: &Bvh2) -> Vec<u32> {
    let mut counts = vec![0; binary.nodes.len()];
    for node in top_down(binary, |_| true).into_iter().rev() {
        let node = node as usize;
        counts[node] = match children(binary, node) {
            Some([one, other]) => counts[one] + counts[other],
            None => binary.nodes[node].prim_count,
        };
    }
    counts
}
