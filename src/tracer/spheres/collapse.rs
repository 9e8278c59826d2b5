//! Conversion of a binary tree to eight children per node: selects the subtrees that become children by the
//! surface area heuristic.
//!
//! H. Ylitie, T. Karras and S. Laine, “Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs”, 2017, section 3. Unlike in the paper, the cost of a node or a block does not depend on how full it
//! is, and the leaves are given.

use smallvec::SmallVec;

use super::binary::BinaryTree;
use super::formula::BLOCK_SIZE;

/// Smallest costs of representing a subtree by a number of children.
#[derive(Debug, Clone, Copy, Default)]
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
    fn new(area: f32, [one, other]: [&[f32; BLOCK_SIZE - 1]; 2]) -> Self {
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

/// A binary tree with the costs of its subtrees.
pub(super) struct Collapse<'a> {
    binary: &'a BinaryTree,
    /// By node; the elements of leaves are not used.
    subtrees: Vec<SubtreeCosts>,
}

impl<'a> Collapse<'a> {
    pub(super) fn new(binary: &'a BinaryTree) -> Self {
        let mut collapse = Self {
            binary,
            subtrees: vec![SubtreeCosts::default(); binary.len()],
        };
        // Halves have larger indices.
        for node in (0..binary.len()).rev() {
            let area = binary.half_area(node);
            collapse.subtrees[node] = match binary.halves(node) {
                Some(halves) => SubtreeCosts::new(area, halves.map(|half| &collapse.subtrees[half].costs)),
                None => SubtreeCosts {
                    costs: [area; BLOCK_SIZE - 1],
                    ..SubtreeCosts::default()
                },
            };
        }
        collapse
    }

    /// Returns the children of the node that represents a subtree, which must not be a leaf.
    pub(super) fn members(&self, root: usize) -> SmallVec<[usize; BLOCK_SIZE]> {
        let mut members = SmallVec::new();
        let mut open: SmallVec<[_; BLOCK_SIZE]> = SmallVec::from_iter([(root, self.subtrees[root].of_node)]);
        while let Some((node, shares)) = open.pop() {
            match (self.binary.halves(node), shares) {
                (Some([one, other]), [left, right]) if left > 0 => {
                    for (half, share) in [(other, right), (one, left)] {
                        open.push((half, self.subtrees[half].halves[usize::from(share) - 1]));
                    }
                }
                _ => members.push(node),
            }
        }
        members
    }
}
