//! The scene in the number type of the tracer, and what its rays meet.

mod path;
mod several;
mod walk;
mod whitted;

use toyproof_scene::{Integrator, Object, Requirements, Scene, Shape};
pub(super) use walk::Walk;

use super::lanes::Level;
use super::light::{Background, Light};
use super::material::{Material, Model};
use super::ray::{First, Hit, Ray};
use super::real::{Real, Vector};
use super::sampler::Draws;
use super::shape::Primitive;
use super::spheres::{Found, NONE, Numbered, Packet, Query, Spheres};
use super::style::{Exact, Style};

/// Surfaces and lights. `P` is the one shape that a scene requires, so that what is asked of each knows it.
#[derive(Debug)]
pub(super) struct World<T: Real, P> {
    pub(super) integrator: Integrator,
    max_depth: u32,
    ambient: T::Vec3,
    pub(super) background: Background<T>,
    lights: Vec<Light<T>>,
    shapes: Vec<P>,
    /// Those of them that are spheres, once more.
    pub(super) spheres: Spheres<T>,
    /// The numbers of the others.
    others: Vec<usize>,
    /// One for each shape.
    materials: Vec<Material<T>>,
    /// The spheres that shine.
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
    /// `before`: the same scene's spheres at another moment, which their tree may serve again.
    pub(super) fn new(
        scene: &Scene,
        level: Level,
        before: Option<Spheres<T>>,
        shape: impl Fn(&Object) -> P,
    ) -> Self {
        let materials: Vec<_> = scene
            .objects
            .iter()
            .map(|object| Material::new(&object.material))
            .collect();
        let emitters = scene.objects.iter().zip(&materials).enumerate();
        let spheres: Vec<_> = (0..)
            .zip(&scene.objects)
            .filter_map(|(number, object)| match object.shape {
                Shape::Sphere { center, radius } => Some(Numbered {
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
            spheres: match before {
                Some(before) => before.moved(&spheres),
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

    /// Whether there are lights, and whether any of them has a surface.
    pub(super) fn lights_and_surfaces(&self) -> [bool; 2] {
        let lit = self.integrator == Integrator::Whitted && !self.lights.is_empty();
        [
            lit,
            lit && self.lights.iter().any(|light| light.surface.is_some()),
        ]
    }

    /// How many lights are looked for, and from how many surfaces one after the other a ray may go on.
    pub(super) fn lights_and_bounces(&self) -> [u32; 2] {
        let lights = match self.integrator {
            Integrator::Whitted => self.lights.iter().filter(|light| light.shadow).count(),
            Integrator::Path => usize::from(self.has_emitters()),
        };
        let goes_on = |material: &Material<T>| matches!(material.model, Model::Mirror | Model::Glass(_));
        let goes_on = self.integrator == Integrator::Whitted && self.materials.iter().any(goes_on);
        [lights as u32, if goes_on { self.max_depth - 1 } else { 0 }]
    }

    /// Whether any surface shines.
    pub(super) fn has_emitters(&self) -> bool {
        !self.emitters.is_empty()
    }

    /// The radiance along a camera ray, which meets that first.
    pub(super) fn radiance(
        &self,
        ray: Ray<T>,
        first: First<T>,
        draws: Draws,
        style: &impl Style<T>,
    ) -> T::Vec3 {
        let mut walk = [Walk::new(ray, first, draws)];
        self.walk(&mut walk, style);
        walk[0].sum
    }

    /// Sums the radiance along several, no more than a packet has.
    pub(super) fn walk(&self, walks: &mut [Walk<T>], style: &impl Style<T>) {
        match self.integrator {
            Integrator::Whitted => self.whitted(walks, style),
            Integrator::Path => {
                for walk in walks {
                    walk.sum = self.path(walk.branch.ray, walk.first, &mut walk.draws, style);
                }
            }
        }
    }

    /// The surface that a ray starts on, if it is not to meet it where it starts: off its surface, it starts on none.
    fn own(ray: &Ray<T>, style: &impl Style<T>) -> Option<usize> {
        ray.from.filter(|_| style.is_on_surface())
    }

    /// What the ray looks for among the spheres; its own surface is looked at apart.
    fn query(
        ray: &Ray<T>,
        style: &impl Style<T>,
        own: Option<usize>,
        light: Option<usize>,
        t_max: T,
    ) -> Query<T> {
        Query {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            t_min: style.t_min(ray.from.is_some()),
            t_max,
            but: [own, light].map(|surface| surface.map_or(NONE, |surface| surface as u32)),
        }
    }

    /// The surface that a ray meets first; where several have the same t, the one with the smallest number.
    pub(super) fn nearest(&self, ray: &Ray<T>, style: &impl Style<T>) -> First<T> {
        let own = Self::own(ray, style);
        let query = Self::query(ray, style, own, None, T::infinity());
        let first = self.spheres.nearest(&query);
        let mut first = first.map_or_else(First::nothing, |(t, number)| First::new(t, number));
        if let Some(own) = own {
            first.take(self.shapes[own].intersect_own(ray, style), own);
        }
        self.nearest_other(ray, &mut first, style);
        first
    }

    /// Looks among those that are no spheres, but not at the ray's own.
    fn nearest_other(&self, ray: &Ray<T>, first: &mut First<T>, style: &impl Style<T>) {
        let own = Self::own(ray, style);
        for &other in &self.others {
            if own != Some(other) {
                first.take(self.shapes[other].intersect(ray, style), other);
            }
        }
    }

    /// The surface that one of the rays of a packet meets first, which found those spheres.
    #[inline]
    pub(super) fn first(&self, packet: &Packet<T>, found: &Found<T>, at: usize) -> First<T> {
        let first = found.of(at);
        if self.others.is_empty() {
            return first;
        }
        self.nearest_with_others(&packet.ray(at), first)
    }

    /// Apart, so that who has no others keeps what is first in registers.
    #[inline(never)]
    fn nearest_with_others(&self, ray: &Ray<T>, mut first: First<T>) -> First<T> {
        self.nearest_other(ray, &mut first, &Exact);
        first
    }

    /// The point where a ray meets a surface first.
    fn hit(&self, ray: &Ray<T>, first: First<T>) -> Option<Hit<T>> {
        let (t, surface) = first.get()?;
        let [point, normal] = self.shapes[surface].surface(ray, t);
        Some(Hit {
            point,
            normal,
            surface,
        })
    }

    /// Whether anything but the surface `light` lies strictly between the ray's origin and `distance`, or the ray misses that surface,
    /// where the style says that it must not.
    fn occluded(&self, ray: &Ray<T>, distance: T, light: Option<usize>, style: &impl Style<T>) -> bool {
        if let Some(light) = light
            && style.lamp().must_be_met
            && self.shapes[light].intersect(ray, style).is_none()
        {
            return true;
        }
        let own = Self::own(ray, style);
        let own_hides = |own: usize| {
            let t = self.shapes[own].intersect_own(ray, style);
            light != Some(own) && t.is_some_and(|t| t < distance)
        };
        let own_sphere = own.filter(|&own| self.shapes[own].sphere().is_some());
        own_sphere.is_some_and(own_hides)
            || self.spheres.any(&Self::query(ray, style, own, light, distance))
            || self.occluded_by_other(ray, distance, light, style)
    }

    /// The same of those that are no spheres.
    fn occluded_by_other(
        &self,
        ray: &Ray<T>,
        distance: T,
        light: Option<usize>,
        style: &impl Style<T>,
    ) -> bool {
        let own = Self::own(ray, style);
        self.others.iter().any(|&other| {
            let t = if own == Some(other) {
                self.shapes[other].intersect_own(ray, style)
            } else {
                self.shapes[other].intersect(ray, style)
            };
            light != Some(other) && t.is_some_and(|t| t < distance)
        })
    }
}
