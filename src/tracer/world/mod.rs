//! The scene in the tracer's number type, and ray queries.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

mod path;
mod points;
mod queries;
mod whitted;

use toyproof_scene::{Integrator, Object, Scene, Shape};

use self::whitted::Deferred;
use crate::lanes::{Kernel, Lanes, Level, Wide, Wide3};
use crate::light::{Background, Light};
use crate::material::{Material, Model};
use crate::ray::{FirstHit, Ray};
use crate::ray_epsilon::{Exact, RayEpsilonPolicy};
use crate::real::{Real, Vector};
use crate::sampler::SampleStream;
use crate::shape::Primitive;
use crate::spheres::{
    LaneHits, LaneRays, NO_SURFACE, NumberedSphere, PACKET_RAYS, Packet, PacketHits, Query, Spheres,
};

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
    /// Creates a world. `store` stores the spheres.
    pub(super) fn new(
        scene: &Scene,
        level: Level,
        store: impl FnOnce(&[NumberedSphere<T>]) -> Spheres<T>,
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

    /// Returns whether any surface is emissive.
    pub(super) fn has_emitters(&self) -> bool {
        !self.emitters.is_empty()
    }

    /// Computes the radiance along a camera ray with the given first hit.
    pub(super) fn radiance(
        &self,
        ray: Ray<T>,
        first: FirstHit<T>,
        mut stream: SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        let [origins, directions] =
            [ray.origin, ray.direction].map(|vector| vector.to_array().map(|component| [component]));
        let [t, surface] = first.tagged().map(|number| [number]);
        let mut radiance = [[T::zero()]; 3];
        let samples = Samples {
            origins: each_slice(&origins),
            directions: each_slice(&directions),
            t: &t,
            surfaces: &surface,
            active: 1,
            streams: std::slice::from_mut(&mut stream),
            radiance: radiance.each_mut().map(|component| &mut component[..]),
        };
        T::run_scalar(Trace {
            world: self,
            samples,
            policy,
        });
        let [[r], [g], [b]] = radiance;
        T::Vec3::new(r, g, b)
    }

    /// Computes the radiance along many camera rays.
    pub(super) fn trace(&self, samples: Samples<'_, T>) {
        T::run(
            self.level,
            Trace {
                world: self,
                samples,
                policy: &Exact,
            },
        );
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
            t_min: policy.t_min(ray.from.is_some()),
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

/// Samples whose camera rays have been traced, and their radiance. The number of samples is a multiple of the
/// number of lanes.
pub(super) struct Samples<'a, T: Real> {
    pub(super) origins: [&'a [T]; 3],
    pub(super) directions: [&'a [T]; 3],
    /// t of the first hits, infinite for none.
    pub(super) t: &'a [T],
    /// The surfaces of the first hits, encoded by [`Real::tag`].
    pub(super) surfaces: &'a [T],
    /// Bit i is set if sample i is to be traced.
    pub(super) active: u64,
    /// The random numbers of each sample.
    pub(super) streams: &'a mut [SampleStream],
    /// Receives the components of the radiance of each active sample.
    pub(super) radiance: [&'a mut [T]; 3],
}

/// Returns the arrays as slices.
pub(super) fn each_slice<T, const N: usize>(arrays: &[[T; N]; 3]) -> [&[T]; 3] {
    arrays.each_ref().map(|array| &array[..])
}

/// Kernel that traces samples, each in a lane.
struct Trace<'a, T: Real, P, R> {
    world: &'a World<T, P>,
    samples: Samples<'a, T>,
    policy: &'a R,
}

impl<T: Real, P: Primitive<T>, R: RayEpsilonPolicy<T>> Kernel<T> for Trace<'_, T, P, R> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let Self {
            world,
            samples,
            policy,
        } = self;
        let mut radiance = samples.radiance;
        let mut deferred = Deferred::none();
        let mut at = 0;
        while at < samples.t.len() {
            let active = (samples.active >> at) as u32 & (u32::MAX >> (32 - S::COUNT));
            if active != 0 {
                let rays = LaneRays {
                    origin: Wide3::load_slices(simd, samples.origins.map(|of| &of[at..])),
                    direction: Wide3::load_slices(simd, samples.directions.map(|of| &of[at..])),
                    from: Wide::splat(simd, T::tag(NO_SURFACE)),
                };
                let hits = LaneHits {
                    t: Wide::load(simd, &samples.t[at..]),
                    surface: Wide::load(simd, &samples.surfaces[at..]),
                };
                let streams = &mut samples.streams[at..];
                let Wide3(r, g, b) = match world.integrator {
                    Integrator::Whitted => {
                        let state = (streams, &mut deferred);
                        world.whitted(simd, rays, hits, state, active, policy)
                    }
                    Integrator::Path => world.path(simd, rays, hits, streams, active, policy),
                };
                let mask = simd.mask(active);
                for (all, new) in radiance.iter_mut().zip([r, g, b]) {
                    let before = Wide::load(simd, &all[at..]);
                    new.select(mask, before).store(&mut all[at..]);
                }
            }
            at += S::COUNT;
        }
    }
}
