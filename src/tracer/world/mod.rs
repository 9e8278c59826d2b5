//! The scene in the tracer's number type, and ray queries.

mod path;
mod whitted;

use toyproof_scene::{Integrator, Object, Requirements, Scene, Shape};
pub(super) use whitted::PathState;

use crate::lanes::Level;
use crate::light::{Background, Light};
use crate::material::{Material, Model};
use crate::ray::{FirstHit, Hit, Ray};
use crate::ray_epsilon::{Exact, RayEpsilonPolicy};
use crate::real::{Real, Vector};
use crate::sampler::SampleStream;
use crate::shape::Primitive;
use crate::spheres::{NO_SURFACE, NumberedSphere, Packet, PacketHits, Query, Spheres};

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
    /// Creates a world. `previous` are the spheres of the same scene at a different moment, whose tree is
    /// reused if possible.
    pub(super) fn new(
        scene: &Scene,
        level: Level,
        previous: Option<Spheres<T>>,
        shape: impl Fn(&Object) -> P,
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
            shapes: scene.objects.iter().map(shape).collect(),
            spheres: match previous {
                Some(previous) => previous.moved(&spheres),
                None => Spheres::new(&spheres, Requirements::of(scene).many_spheres, level),
            },
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

    /// Returns whether any surface is emissive.
    pub(super) fn has_emitters(&self) -> bool {
        !self.emitters.is_empty()
    }

    /// Computes the radiance along a camera ray with the given first hit.
    pub(super) fn radiance(
        &self,
        ray: Ray<T>,
        first: FirstHit<T>,
        stream: SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        let mut path = [PathState::new(ray, first, stream)];
        self.trace(&mut path, policy);
        path[0].sum
    }

    /// Adds up the radiance along several camera rays, at most [`PACKET_RAYS`](crate::spheres::PACKET_RAYS).
    pub(super) fn trace(&self, paths: &mut [PathState<T>], policy: &impl RayEpsilonPolicy<T>) {
        match self.integrator {
            Integrator::Whitted => self.whitted(paths, policy),
            Integrator::Path => {
                for path in paths {
                    path.sum = self.path(path.branch.ray, path.first, &mut path.stream, policy);
                }
            }
        }
    }

    /// Returns the surface on which a ray starts and which it must not hit there. A ray with an offset origin
    /// has none.
    fn own_surface(ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<usize> {
        ray.from.filter(|_| policy.starts_on_surface())
    }

    /// Returns that surface if it is not a sphere.
    fn own_other(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<usize> {
        if self.others.is_empty() {
            return None;
        }
        Self::own_surface(ray, policy).filter(|&own| self.shapes[own].sphere().is_none())
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
            t_min: policy.t_min(ray.from.is_some()),
            t_max,
            excluded: [own, light].map(|surface| surface.map_or(NO_SURFACE, |surface| surface as u32)),
        }
    }

    /// Finds the nearest surface along a ray; at equal t, the one with the smallest index.
    pub(super) fn nearest(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> FirstHit<T> {
        let own = Self::own_surface(ray, policy);
        let query = Self::query(ray, policy, own, None, T::infinity());
        let first = self.spheres.nearest(&query);
        let mut first = first.map_or_else(FirstHit::none, |(t, number)| FirstHit::new(t, number));
        if let Some(own) = own {
            first.update(self.shapes[own].intersect_own(ray, policy), own);
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
        self.nearest_others_of_packet(packet, &mut found, &Exact);
        found
    }

    /// Updates the hits of the rays of a packet by the shapes that are not spheres, except the surface on which a
    /// ray starts.
    pub(super) fn nearest_others_of_packet(
        &self,
        packet: &Packet<T>,
        found: &mut PacketHits<T>,
        policy: &impl RayEpsilonPolicy<T>,
    ) {
        for &other in &self.others {
            let shape = &self.shapes[other];
            if shape.update_packet(self.level, packet, found, other as u32) {
                continue;
            }
            for at in 0..packet.len() {
                let ray = packet.ray(at);
                if ray.from != Some(other) {
                    found.update(at, shape.intersect(&ray, policy), other);
                }
            }
        }
    }

    /// Computes the surface point of a first hit.
    fn hit(&self, ray: &Ray<T>, first: FirstHit<T>) -> Option<Hit<T>> {
        let (t, surface) = first.get()?;
        let [point, normal] = self.shapes[surface].surface(ray, t);
        Some(Hit {
            point,
            normal,
            surface,
        })
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
