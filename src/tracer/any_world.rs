//! The world, specialized for the shapes that a scene has.

use toyproof_scene::{Integrator, Scene};

use crate::lanes::Level;
use crate::ray::{FirstHit, Ray};
use crate::ray_epsilon::{Exact, RayEpsilonPolicy};
use crate::real::Real;
use crate::sampler::SampleStream;
use crate::shape::{Shape, Sphere};
use crate::spheres::{NumberedSphere, Packet, PacketHits, Spheres};
use crate::world::World;
use crate::world::trace::Samples;

/// The world, specialized for scenes that consist of spheres only.
#[derive(Debug)]
pub(super) enum AnyWorld<T: Real> {
    Spheres(World<T, Sphere<T>>),
    Shapes(World<T, Shape<T>>),
}

/// Evaluates an expression for the world of either kind.
macro_rules! either {
    ($any:expr, $world:ident => $value:expr) => {
        match $any {
            AnyWorld::Spheres($world) => $value,
            AnyWorld::Shapes($world) => $value,
        }
    };
}

impl<T: Real> AnyWorld<T> {
    /// Creates a world. `store` stores the spheres.
    pub(super) fn new(
        scene: &Scene,
        level: Level,
        store: impl FnOnce(&[NumberedSphere<T>]) -> Spheres<T>,
    ) -> Self {
        let shapes = scene.objects.iter().map(|object| &object.shape);
        match shapes.clone().map(Sphere::from_shape).collect() {
            Some(spheres) => Self::Spheres(World::new(scene, level, store, spheres)),
            None => Self::Shapes(World::new(scene, level, store, shapes.map(Shape::new).collect())),
        }
    }

    pub(super) fn into_spheres(self) -> Spheres<T> {
        either!(self, world => world.spheres)
    }

    pub(super) fn integrator(&self) -> Integrator {
        either!(self, world => world.integrator)
    }

    /// See [`World::nearest`].
    pub(super) fn nearest(&self, ray: &Ray<T>) -> FirstHit<T> {
        either!(self, world => world.nearest(ray, &Exact))
    }

    /// See [`World::nearest_of_packet`].
    pub(super) fn nearest_of_packet(&self, packet: &Packet<T>) -> PacketHits<T> {
        either!(self, world => world.nearest_of_packet(packet))
    }

    /// See [`World::trace`].
    pub(super) fn trace(&self, samples: Samples<'_, T>) {
        either!(self, world => world.trace(samples));
    }

    /// See [`World::radiance`].
    pub(super) fn radiance(
        &self,
        ray: Ray<T>,
        first: FirstHit<T>,
        stream: SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        either!(self, world => world.radiance(ray, first, stream, policy))
    }

    /// See [`World::surfaces`].
    pub(super) fn surfaces(&self) -> usize {
        either!(self, world => world.surfaces())
    }

    /// See [`World::surface_point`].
    pub(super) fn surface_point(&self, ray: &Ray<T>, first: FirstHit<T>) -> [T::Vec3; 2] {
        either!(self, world => world.surface_point(ray, first))
    }

    /// See [`World::acne_dimensions`].
    pub(super) fn acne_dimensions(&self) -> [u32; 2] {
        either!(self, world => world.acne_dimensions())
    }

    /// See [`World::light_policy_dimensions`].
    pub(super) fn light_policy_dimensions(&self) -> [bool; 3] {
        either!(self, world => world.light_policy_dimensions())
    }
}
