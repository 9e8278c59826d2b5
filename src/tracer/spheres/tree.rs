//! Bounding volume hierarchy with eight children per node, over blocks of spheres.
//!
//! A binary tree in f32 ([`BinaryTree`]) determines the topology, [`Collapse`] which of its nodes become
//! children. The boxes are computed from the spheres in the tracer's number type. When spheres move, the tree
//! is refitted, as long as its boxes do not become much larger.

use smallvec::SmallVec;

use super::binary::BinaryTree;
use super::block::{Block, Reach, block};
use super::collapse::Collapse;
use super::formula::{BLOCK_SIZE, Eight, NumberedSphere};
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
        let binary = BinaryTree::build(spheres);
        let collapse = Collapse::new(&binary);
        let mut tree = Self {
            blocks: Vec::with_capacity(binary.leaves()),
            reaches: Vec::with_capacity(binary.leaves()),
            nodes: vec![Node::empty()],
            cost: 0.0,
        };
        // Nodes to fill, with their roots in the binary tree. The next one is a child of the last one, so
        // that the nodes that a ray visits one after the other are close in memory.
        let mut open = vec![(0, 0)];
        while let Some((at, root)) = open.pop() {
            let members = collapse.members(root);
            tree.nodes[at].count = members.len();
            for (slot, member) in members.into_iter().enumerate() {
                tree.nodes[at].children[slot] = if binary.halves(member).is_none() {
                    let below = binary.spheres(member).iter().map(|&at| spheres[at as usize]);
                    let (block, reach) = block(&below.collect::<SmallVec<[_; BLOCK_SIZE]>>());
                    tree.blocks.push(block);
                    tree.reaches.push(reach);
                    Child::block(tree.blocks.len() - 1)
                } else {
                    tree.nodes.push(Node::empty());
                    open.push((tree.nodes.len() - 1, member));
                    Child::node(tree.nodes.len() - 1)
                };
            }
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
