//! Intersection of rays with all spheres of a scene.
//!
//! Spheres are stored in blocks of eight. A few blocks are scanned linearly; over many there is a tree of
//! bounding boxes ([`tree`]). It only skips spheres that the ray cannot hit, so results are bit-identical. A
//! single ray is tested against eight spheres or boxes at once ([`single_ray`]); the rays of a packet are
//! tested against one sphere at a time ([`packet`]). All of them use the same formula ([`formula`]).

mod binary;
mod block;
mod collapse;
mod formula;
mod lanes;
mod packet;
mod single_ray;
#[cfg(test)]
mod tests;
mod tree;

pub(super) use formula::{IntersectSphere, NO_SURFACE, NumberedSphere};
pub(super) use lanes::{LaneHits, LaneRays};
pub(super) use packet::{Origins, PACKET_RAYS, Packet, PacketHits};
pub(super) use single_ray::Query;

use self::formula::BLOCK_SIZE;
use self::tree::Tree;
use crate::lanes::Level;
use crate::real::Real;

/// The spheres of a scene.
#[derive(Debug)]
pub struct Spheres<T> {
    tree: Tree<T>,
    level: Level,
}

impl<T: Real> Spheres<T> {
    /// Stores spheres, optionally under a tree, for an instruction set.
    pub(super) fn new(spheres: &[NumberedSphere<T>], tree: bool, level: Level) -> Self {
        let tree = if tree && spheres.len() > BLOCK_SIZE {
            Tree::build(spheres)
        } else {
            Tree::without_nodes(spheres)
        };
        Self { tree, level }
    }

    /// Moves the spheres, which are given in order of their indices. Keeps an existing tree if it is still
    /// good enough.
    pub(super) fn moved(mut self, spheres: &[NumberedSphere<T>]) -> Self {
        if self.has_tree() && self.tree.refit_to(spheres) {
            return self;
        }
        Self::new(spheres, self.has_tree(), self.level)
    }

    /// Finds the smallest t and the index of the sphere; at equal t, the smallest index.
    pub(super) fn nearest(&self, query: &Query<T>) -> Option<(T, u32)> {
        T::run(self.level, single_ray::Nearest { spheres: self, query })
    }

    /// Returns whether there is any hit.
    pub(super) fn any(&self, query: &Query<T>) -> bool {
        T::run(self.level, single_ray::Any { spheres: self, query })
    }

    /// Like [`Spheres::nearest`] for each ray of a packet. Only hits before those already found are recorded.
    pub(super) fn nearest_of_packet(&self, packet: &Packet<T>, found: &mut PacketHits<T>) {
        let nearest = packet::Nearest {
            spheres: self,
            packet,
            found,
        };
        T::run(self.level, nearest);
    }

    /// Returns whether there is a tree; then incoherent rays are traced one by one.
    pub(super) fn has_tree(&self) -> bool {
        !self.tree.nodes.is_empty()
    }
}
