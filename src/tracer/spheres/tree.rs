//! A tree of boxes over blocks of spheres, eight to a node.
//!
//! obvhs builds a binary tree in f32 (D. Meister and J. Bittner, “Parallel Locally-Ordered Clustering for Bounding Volume
//! Hierarchy Construction”, 2018), of which only the shape is kept: [`super::collapse`] makes it one of eights, and the boxes are
//! made anew, in the tracer's number type, from the spheres. Where these move, the tree keeps its shape and takes new boxes, as
//! long as they do not become much larger.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};

use super::super::real::Real;
use super::block::{Block, Reach, block};
use super::collapse::Collapse;
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

/// Blocks, how far each reaches, and the nodes over them, the root first; none over a few.
#[derive(Debug)]
pub(super) struct Tree<T> {
    pub(super) blocks: Vec<Block<T>>,
    pub(super) reaches: Vec<Reach<T>>,
    pub(super) nodes: Vec<Node<T>>,
    /// What it cost to walk when it was built.
    cost: f64,
}

/// How many times as much as when it was built a tree may cost before it is built anew.
const WORN: f64 = 2.0;

impl<T: Real> Tree<T> {
    /// Blocks in the order of the spheres, and no nodes.
    pub(super) fn without_nodes(spheres: &[Numbered<T>]) -> Self {
        let (blocks, reaches) = spheres.chunks(EIGHT).map(block).unzip();
        Self {
            blocks,
            reaches,
            nodes: Vec::new(),
            cost: 0.0,
        }
    }

    pub(super) fn build(spheres: &[Numbered<T>]) -> Self {
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
        // Each node once its number is known; their roots in the binary tree.
        let mut roots = vec![0];
        let (mut below, mut at) = (Vec::new(), 0);
        while at < roots.len() {
            let members = collapse.members(roots[at]);
            tree.nodes[at].count = members.len();
            for (place, member) in members.into_iter().enumerate() {
                if collapse.is_block(member) {
                    below.clear();
                    below.extend(collapse.spheres(member).into_iter().map(|at| spheres[at]));
                    tree.nodes[at].children[place] = Child::block(tree.blocks.len());
                    let (block, reach) = block(&below);
                    tree.blocks.push(block);
                    tree.reaches.push(reach);
                } else {
                    tree.nodes[at].children[place] = Child::node(tree.nodes.len());
                    tree.nodes.push(Node::empty());
                    roots.push(member);
                }
            }
            at += 1;
        }
        tree.fit();
        tree.cost = tree.cost();
        tree
    }

    /// The same spheres, elsewhere, by their numbers in rising order: false where the tree has become too loose to keep.
    pub(super) fn move_to(&mut self, spheres: &[Numbered<T>]) -> bool {
        let mut below = Vec::with_capacity(EIGHT);
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
        self.fit();
        // What is NaN is not kept.
        self.cost() <= WORN * self.cost
    }

    /// Brings the boxes to where the spheres are.
    fn fit(&mut self) {
        // Children have larger numbers than their parents.
        for at in (0..self.nodes.len()).rev() {
            for place in 0..self.nodes[at].count {
                let bounds = match self.nodes[at].children[place].get() {
                    Ok(child) => self.nodes[child].bounds(),
                    Err(block) => self.reaches[block].bounds(&self.blocks[block]),
                };
                self.nodes[at].set(place, bounds);
            }
        }
    }

    /// What a ray through the whole is expected to meet, by the surface area heuristic: the boxes' areas over the largest's.
    fn cost(&self) -> f64 {
        let area = |[low, high]: [[T; 3]; 2]| {
            let [x, y, z] = [0, 1, 2].map(|axis| (high[axis] - low[axis]).to_f64());
            x * y + y * z + z * x
        };
        let all = self.nodes.first().map_or(1.0, |root| area(root.bounds()));
        let areas = self.nodes.iter().map(|node| {
            let corner = |of: &[Eight<T>; 3], place: usize| [0, 1, 2].map(|axis| of[axis][place]);
            let boxes = (0..node.count).map(|place| [&node.low, &node.high].map(|of| corner(of, place)));
            boxes.map(area).sum::<f64>()
        });
        areas.sum::<f64>() / all
    }
}
