//! How a binary tree becomes one of eights: which of its subtrees become the children of a node, by the surface area heuristic.
//!
//! H. Ylitie, T. Karras and S. Laine, “Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs”, 2017,
//! section 3. Here a node and a block cost the same, however full they are, and what fits into a block is one.

use obvhs::bvh2::Bvh2;
use smallvec::SmallVec;

use super::EIGHT;

/// The cheapest ways to make a subtree into children of a node.
#[derive(Debug, Clone, Copy)]
struct Ways {
    /// What it costs as at most 1, 2, … children.
    costs: [f32; EIGHT - 1],
    /// How many of them come from each half; none where it is one child.
    halves: [[u8; 2]; EIGHT - 1],
    /// The same for the children of the node that it is.
    of_node: [u8; 2],
}

impl Ways {
    /// Of two halves that cost that.
    fn of(area: f32, [one, other]: [[f32; EIGHT - 1]; 2]) -> Self {
        let parted = |children: usize| {
            (1..children)
                .map(|k| {
                    (
                        one[k - 1] + other[children - k - 1],
                        [k as u8, (children - k) as u8],
                    )
                })
                .min_by(|(a, _), (b, _)| a.total_cmp(b))
        };
        let (below, of_node) = parted(EIGHT).unwrap_or_default();
        let mut ways = Self {
            costs: [0.0; EIGHT - 1],
            halves: [[0; 2]; EIGHT - 1],
            of_node,
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

/// A binary tree of more spheres than fit into a block, and its cheapest ways.
pub(super) struct Collapse<'a> {
    binary: &'a Bvh2,
    /// How many spheres are below each node of the binary tree.
    counts: Vec<u32>,
    /// Of each that is no block, at its place.
    ways: Vec<Ways>,
    places: Vec<u32>,
}

impl<'a> Collapse<'a> {
    pub(super) fn new(binary: &'a Bvh2) -> Self {
        let counts = counts(binary);
        let mut collapse = Self {
            binary,
            places: vec![0; counts.len()],
            counts,
            ways: Vec::new(),
        };
        for node in from_above(binary, |node| !collapse.is_block(node))
            .into_iter()
            .rev()
        {
            let node = node as usize;
            let Some(two) = children(binary, node).filter(|_| !collapse.is_block(node)) else {
                continue;
            };
            let costs = two.map(|child| {
                if collapse.is_block(child) {
                    [collapse.area(child); EIGHT - 1]
                } else {
                    collapse.ways(child).costs
                }
            });
            collapse.places[node] = collapse.ways.len() as u32;
            collapse.ways.push(Ways::of(collapse.area(node), costs));
        }
        collapse
    }

    /// Whether a subtree fits into a block.
    pub(super) fn is_block(&self, node: usize) -> bool {
        self.counts[node] <= EIGHT as u32
    }

    fn area(&self, node: usize) -> f32 {
        self.binary.nodes[node].aabb.half_area()
    }

    fn ways(&self, node: usize) -> &Ways {
        &self.ways[self.places[node] as usize]
    }

    /// The children of the node that a subtree becomes.
    pub(super) fn members(&self, root: usize) -> SmallVec<[usize; EIGHT]> {
        let mut members = SmallVec::new();
        let mut open: SmallVec<[_; EIGHT]> = SmallVec::from_iter([(root, self.ways(root).of_node)]);
        while let Some((node, halves)) = open.pop() {
            match (children(self.binary, node), halves) {
                (Some([one, other]), [left, right]) if left > 0 => {
                    for (child, share) in [(other, right), (one, left)] {
                        let halves = if self.is_block(child) {
                            [0; 2]
                        } else {
                            self.ways(child).halves[usize::from(share) - 1]
                        };
                        open.push((child, halves));
                    }
                }
                _ => members.push(node),
            }
        }
        members
    }

    /// The spheres of a block.
    pub(super) fn spheres(&self, root: usize) -> SmallVec<[usize; EIGHT]> {
        let mut spheres = SmallVec::new();
        let mut open: SmallVec<[_; EIGHT]> = SmallVec::from_iter([root]);
        while let Some(node) = open.pop() {
            if let Some(two) = children(self.binary, node) {
                open.extend(two);
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

/// Nodes from the root on, those above first, whose parents are open.
fn from_above(binary: &Bvh2, is_open: impl Fn(usize) -> bool) -> Vec<u32> {
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

/// How many spheres are below each node.
fn counts(binary: &Bvh2) -> Vec<u32> {
    let mut counts = vec![0; binary.nodes.len()];
    for node in from_above(binary, |_| true).into_iter().rev() {
        let node = node as usize;
        counts[node] = match children(binary, node) {
            Some([one, other]) => counts[one] + counts[other],
            None => binary.nodes[node].prim_count,
        };
    }
    counts
}
