//! The scene in the tracer's number type, and ray queries.

mod path;
mod points;
mod queries;
mod surface_point;
pub(super) mod trace;
mod whitted;

use toyproof_scene::{Integrator, Object, Scene, Shape};

use crate::lanes::Level;
use crate::light::{Background, Light};
use crate::material::{Material, Model};
use crate::ray::{FirstHit, Ray};
use crate::ray_epsilon::{Exact, RayEpsilonPolicy};
use crate::real::{Real, Vector};
use crate::shape::Primitive;
use crate::spheres::{NO_SURFACE, NumberedSphere, PACKET_RAYS, Packet, PacketHits, Query, Spheres};

/// Surfaces and lights. `P` is the shape type of all surfaces: a single kind, where the scene has only that,
/// for static dispatch.
#[derive(Debug)]
pub(super) struct World<T: Real, P> {
    pub(super) integrator: Integrator,
    max_depth: u32,
    ambient: T::Vec3,
    pub(super) background: Background<T>,
    lights: Vec<Light<T>>,
    shapes: Vec<P>,
    /// Copies of those shapes that are spheres.
    pub(super) spheres: Spheres<T>,
    /// Indices of the other shapes.
    others: Vec<usize>,
    /// One material per shape.
    materials: Vec<Material<T>>,
    /// The emissive spheres.
    emitters: Vec<Emitter<T>>,
    level: Level,
}

#[derive(Debug)]
struct Emitter<T: Real> {
    surface: usize,
    center: T::Vec3,
    radius: T,
}

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Creates a world. `store` stores the spheres; `shapes` are those of the scene's objects.
    pub(super) fn new(
        scene: &Scene,
        level: Level,
        store: impl FnOnce(&[NumberedSphere<T>]) -> Spheres<T>,
        shapes: Vec<P>,
    ) -> Self {
        let materials: Vec<_> = scene.objects.iter().map(Material::new).collect();
        let emitters = scene.objects.iter().zip(&materials).enumerate();
        let spheres: Vec<_> = (0..)
            .zip(&scene.objects)
            .filter_map(|(number, object)| match object.shape {
                Shape::Sphere { center, radius } => Some(NumberedSphere {
                    center: center.map(T::from_f64),
                    radius: T::from_f64(radius),
                    number,
                }),
                _ => None,
            })
            .collect();
        let is_other = |object: &Object| !matches!(object.shape, Shape::Sphere { .. });
        Self {
            integrator: scene.film.integrator,
            max_depth: scene.film.max_depth,
            ambient: T::Vec3::from_f64(scene.ambient),
            background: Background::new(&scene.background),
            lights: scene
                .lights
                .iter()
                .map(|light| Light::new(light, &scene.objects))
                .collect(),
            shapes,
            spheres: store(&spheres),
            others: (0..scene.objects.len())
                .filter(|&at| is_other(&scene.objects[at]))
                .collect(),
            emitters: emitters
                .filter_map(
                    |(surface, (object, material))| match (object.shape, &material.model) {
                        (Shape::Sphere { center, radius }, Model::Emitter) => Some(Emitter {
                            surface,
                            center: T::Vec3::from_f64(center),
                            radius: T::from_f64(radius),
                        }),
                        _ => None,
                    },
                )
                .collect(),
            materials,
            level,
        }
    }

    /// Returns whether shadow rays are traced to lights, and whether any of these has a surface.
    pub(super) fn has_lights_and_surfaces(&self) -> [bool; 2] {
        let lit = self.integrator == Integrator::Whitted && !self.lights.is_empty();
        [
            lit,
            lit && self.lights.iter().any(|light| light.surface.is_some()),
        ]
    }

    /// Returns the number of lights with shadow rays and the largest number of consecutive surfaces from
    /// which a ray continues.
    pub(super) fn acne_dimensions(&self) -> [u32; 2] {
        let lights = match self.integrator {
            Integrator::Whitted => self.lights.iter().filter(|light| light.shadow).count(),
            Integrator::Path => usize::from(self.has_emitters()),
        };
        let is_specular = |material: &Material<T>| matches!(material.model, Model::Mirror | Model::Glass(_));
        let is_specular = self.integrator == Integrator::Whitted && self.materials.iter().any(is_specular);
        [lights as u32, if is_specular { self.max_depth - 1 } else { 0 }]
    }

    /// Returns whether there are shadow rays, whether they aim at surfaces that rays can hit, and whether
    /// emitters hit by chance are weighted.
    pub(super) fn light_policy_dimensions(&self) -> [bool; 3] {
        let paths = self.integrator == Integrator::Path;
        let [lights, own_surface] = self.has_lights_and_surfaces();
        let emitters = paths && self.has_emitters();
        [lights || emitters, own_surface || emitters, emitters]
    }

    /// Returns the number of surfaces.
    pub(super) fn surfaces(&self) -> usize {
        self.shapes.len()
    }

    /// Returns whether any surface is emissive.
    pub(super) fn has_emitters(&self) -> bool {
        !self.emitters.is_empty()
    }

    /// Returns the surface on which a ray starts and which it must not hit there. A ray with an offset origin
    /// has none.
    fn own_surface(ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<usize> {
        ray.from.filter(|_| policy.starts_on_surface())
    }

    /// Creates the query for the spheres. The ray's own surface is excluded and tested separately.
    fn query(
        ray: &Ray<T>,
        policy: &impl RayEpsilonPolicy<T>,
        own: Option<usize>,
        light: Option<usize>,
        t_max: T,
    ) -> Query<T> {
        Query {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            t_min: policy.t_min(ray.kind()),
            t_max,
            // No index is smaller, so that no hit at the bound counts.
            number: 0,
            excluded: [own, light].map(|surface| surface.map_or(NO_SURFACE, |surface| surface as u32)),
        }
    }

    /// Finds the nearest surface along a ray; at equal t, the one with the smallest index.
    pub(super) fn nearest(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> FirstHit<T> {
        let own = Self::own_surface(ray, policy);
        let update_by_own = |first: &mut FirstHit<T>| {
            if let Some(own) = own {
                first.update(self.shapes[own].intersect_own(ray, policy), own);
            }
        };
        let mut first = FirstHit::none();
        let mut query = Self::query(ray, policy, own, None, T::infinity());
        // In a tree, the far side of the ray's own surface excludes most nodes.
        let is_own_first = self.spheres.has_tree();
        if is_own_first {
            update_by_own(&mut first);
            if let Some((t, own)) = first.get() {
                (query.t_max, query.number) = (t, own as u32);
            }
        }
        if let Some((t, number)) = self.spheres.nearest(&query) {
            first = FirstHit::new(t, number);
        }
        if !is_own_first {
            update_by_own(&mut first);
        }
        self.nearest_other(ray, &mut first, policy);
        first
    }

    /// Updates `first` by the shapes that are not spheres, except the ray's own surface.
    fn nearest_other(&self, ray: &Ray<T>, first: &mut FirstHit<T>, policy: &impl RayEpsilonPolicy<T>) {
        let own = Self::own_surface(ray, policy);
        for &other in &self.others {
            if own != Some(other) {
                first.update(self.shapes[other].intersect(ray, policy), other);
            }
        }
    }

    /// Finds the first hits of a packet of camera rays.
    pub(super) fn nearest_of_packet(&self, packet: &Packet<T>) -> PacketHits<T> {
        let mut found = PacketHits::none();
        self.spheres.nearest_of_packet(packet, &mut found);
        for &other in &self.others {
            let shape = &self.shapes[other];
            if !shape.update_packet(self.level, packet, &mut found, other as u32) {
                for at in 0..PACKET_RAYS {
                    found.update(at, shape.intersect(&packet.ray(at), &Exact), other);
                }
            }
        }
        found
    }

    /// Returns whether anything except the surface `light` lies strictly between the origin of the ray and
    /// `distance`. Also true if the ray misses that surface and the policy requires a hit.
    fn occluded(
        &self,
        ray: &Ray<T>,
        distance: T,
        light: Option<usize>,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> bool {
        if let Some(light) = light
            && policy.light_policy().requires_hit
            && self.shapes[light].intersect(ray, policy).is_none()
        {
            return true;
        }
        let own = Self::own_surface(ray, policy);
        let is_self_occluded = |own: usize| {
            let t = self.shapes[own].intersect_own(ray, policy);
            light != Some(own) && t.is_some_and(|t| t < distance)
        };
        let own_sphere = own.filter(|&own| self.shapes[own].sphere().is_some());
        own_sphere.is_some_and(is_self_occluded)
            || self.spheres.any(&Self::query(ray, policy, own, light, distance))
            || self.occluded_by_other(ray, distance, light, policy)
    }

    /// Like [`World::occluded`], for shapes that are not spheres only.
    fn occluded_by_other(
        &self,
        ray: &Ray<T>,
        distance: T,
        light: Option<usize>,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> bool {
        let own = Self::own_surface(ray, policy);
        self.others.iter().any(|&other| {
            let t = if own == Some(other) {
                self.shapes[other].intersect_own(ray, policy)
            } else {
                self.shapes[other].intersect(ray, policy)
            };
            light != Some(other) && t.is_some_and(|t| t < distance)
        })
    }
}
