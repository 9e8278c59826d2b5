//! All the spheres of a scene, for rays to find the nearest of.
//!
//! Eight of them lie side by side in a block. A few blocks are looked through from the first to the last; over many there is
//! a tree of boxes ([`tree`]), which only leaves out spheres that the ray cannot meet, so that the answer is the same to
//! the bit. One ray meets eight spheres or boxes at once ([`one`]); the rays of a packet meet one sphere together
//! ([`together`]). There is one formula for all of them ([`formula`]).

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

mod block;
mod collapse;
mod formula;
mod one;
mod packet;
mod slab;
#[cfg(test)]
mod tests;
mod together;
mod tree;

pub(super) use formula::Meet;
pub(super) use one::Query;
pub(super) use packet::{Found, Origins, PACKET, Packet};

use self::tree::Tree;
use super::lanes::Level;
use super::real::Real;

/// Spheres and boxes are looked at in eights.
const EIGHT: usize = 8;
type Eight<T> = [T; EIGHT];

/// The number of a surface that is none.
pub(super) const NONE: u32 = u32::MAX;

/// A sphere: its place, its radius, and its number among the scene's surfaces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbered<T> {
    pub(super) center: [T; 3],
    pub(super) radius: T,
    pub(super) number: u32,
}

/// The spheres of a scene.
#[derive(Debug)]
pub(super) struct Spheres<T> {
    tree: Tree<T>,
    level: Level,
}

impl<T: Real> Spheres<T> {
    /// Under a tree or not, for that instruction set.
    pub(super) fn new(spheres: &[Numbered<T>], tree: bool, level: Level) -> Self {
        let tree = if tree && spheres.len() > EIGHT {
            Tree::build(spheres)
        } else {
            Tree::without_nodes(spheres)
        };
        Self { tree, level }
    }

    /// The same spheres elsewhere, in the order of their numbers: a tree that is there is kept, if it still serves.
    pub(super) fn moved(mut self, spheres: &[Numbered<T>]) -> Self {
        if self.has_tree() && self.tree.move_to(spheres) {
            return self;
        }
        Self::new(spheres, self.has_tree(), self.level)
    }

    /// The smallest t of a sphere, and its number; where several have it, the smallest number.
    pub(super) fn nearest(&self, query: &Query<T>) -> Option<(T, u32)> {
        T::run(self.level, one::Nearest { spheres: self, query })
    }

    /// Whether there is any.
    pub(super) fn any(&self, query: &Query<T>) -> bool {
        T::run(self.level, one::Any { spheres: self, query })
    }

    /// The same as [`Spheres::nearest`] for each ray of a packet; only what comes before what has been found is.
    pub(super) fn nearest_of_packet(&self, packet: &Packet<T>, found: &mut Found<T>) {
        let nearest = together::Nearest {
            spheres: self,
            packet,
            found,
        };
        T::run(self.level, nearest);
    }

    /// Whether rays that have nothing to do with each other are to be sent one by one.
    pub(super) fn has_tree(&self) -> bool {
        !self.tree.nodes.is_empty()
    }
}
