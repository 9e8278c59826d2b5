//! Ray epsilons: how shaders keep secondary rays from hitting their own surface.
//!
//! The tracer has no epsilons: it knows the surface on which a ray starts and ignores the hit at that point.
//! Shaders do not, so they offset the origin from the surface or ignore hits near it. Both are legal, and
//! change the color where surfaces touch, at shadow edges and in mirrors.
//! [`Tracer::color_range`](crate::Tracer::color_range) evaluates a pixel under all such policies. The scene
//! states the largest legal offset: [`toyproof_scene::Scene::max_offset`].

use crate::ray::RayKind;
use crate::real::Real;

/// How secondary rays start and how shadow rays treat lights. [`Exact`] compiles to no code.
pub(super) trait RayEpsilonPolicy<T: Real> {
    /// Offset of the origin along the normal, in scene units.
    fn offset(&self) -> T;
    /// Offset of the origin along the ray, in scene units.
    fn along(&self) -> T;
    /// Exclusive lower bound for t of a hit; 0 for camera rays.
    fn t_min(&self, rays: RayKind) -> T;
    /// The policy of shadow rays; this one is for rays that continue.
    fn for_shadow_rays(&self) -> impl RayEpsilonPolicy<T>;
    /// How shadow rays treat lights.
    fn light_policy(&self) -> LightPolicy;

    /// Which rays hit their own surface.
    fn acne(&self) -> Acne {
        Acne::default()
    }

    /// Returns whether secondary rays start exactly on their surface.
    fn starts_on_surface(&self) -> bool {
        self.offset() == T::zero() && self.along() == T::zero()
    }
}

/// How shadow rays treat lights.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LightPolicy {
    /// The direction to a light, or the cone that it subtends, is computed from the origin of the ray instead
    /// of the surface point.
    pub from_ray_origin: bool,
    /// A light with a surface contributes only if the shadow ray hits it. At the edge of the cone, a ray with
    /// an offset origin may miss it.
    pub requires_hit: bool,
    /// For an emitter that a path hits by chance, the density of light sampling is computed at the surface
    /// point instead of the origin of the ray.
    pub weight_at_surface: bool,
}

/// Which rays of a shader wrongly hit the surface on which they start (“surface acne”).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Acne {
    /// Bit n is set if the ray that continues from the n-th surface of a path hits it.
    pub self_hit_bounces: u32,
    /// Bit n is set if the n-th light is wrongly shadowed.
    pub shadowed_lights: u32,
}

/// Rays start exactly on the surface.
pub(super) struct Exact;

impl<T: Real> RayEpsilonPolicy<T> for Exact {
    fn offset(&self) -> T {
        T::zero()
    }
    fn along(&self) -> T {
        T::zero()
    }
    fn t_min(&self, _: RayKind) -> T {
        T::zero()
    }
    fn for_shadow_rays(&self) -> impl RayEpsilonPolicy<T> {
        Self
    }
    fn light_policy(&self) -> LightPolicy {
        LightPolicy::default()
    }
}

/// Ray epsilons of a shader, in scene units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RayEpsilon {
    /// Offset of the origin along the normal.
    pub offset: f64,
    /// Offset of the origin along the ray.
    pub along: f64,
    /// Exclusive lower bound for t of a hit.
    pub t_min: f64,
    /// How shadow rays treat lights.
    pub light_policy: LightPolicy,
    /// Rays that wrongly hit their own surface.
    pub acne: Acne,
}

impl RayEpsilonPolicy<f64> for RayEpsilon {
    fn offset(&self) -> f64 {
        self.offset
    }
    fn along(&self) -> f64 {
        self.along
    }
    fn t_min(&self, rays: RayKind) -> f64 {
        match rays {
            RayKind::Camera => 0.0,
            RayKind::Secondary => self.t_min,
        }
    }
    fn for_shadow_rays(&self) -> impl RayEpsilonPolicy<f64> {
        *self
    }
    fn light_policy(&self) -> LightPolicy {
        self.light_policy
    }
    fn acne(&self) -> Acne {
        self.acne
    }
}

/// Separate epsilons for shadow rays and for rays that continue.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RayEpsilons {
    /// Epsilons of shadow rays.
    pub light: RayEpsilon,
    /// Epsilons of rays that continue.
    pub other: RayEpsilon,
}

impl RayEpsilons {
    /// Uses the same epsilons for both kinds of rays.
    pub fn alike(epsilon: RayEpsilon) -> Self {
        Self {
            light: epsilon,
            other: epsilon,
        }
    }
}

impl RayEpsilonPolicy<f64> for RayEpsilons {
    fn offset(&self) -> f64 {
        self.other.offset
    }
    fn along(&self) -> f64 {
        self.other.along
    }
    fn t_min(&self, rays: RayKind) -> f64 {
        self.other.t_min(rays)
    }
    fn for_shadow_rays(&self) -> impl RayEpsilonPolicy<f64> {
        self.light
    }
    fn light_policy(&self) -> LightPolicy {
        self.light.light_policy
    }
    fn acne(&self) -> Acne {
        self.other.acne
    }
}
