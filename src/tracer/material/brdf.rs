//! Bidirectional reflectance distribution functions, and directions drawn for them.

use std::f64::consts::{FRAC_1_PI, TAU};

use toyproof_scene::Disney;

use super::super::ray::{around, basis};
use super::super::real::{Real, Vector};
use super::disney;

#[derive(Debug)]
pub(in super::super) enum Brdf<T> {
    Lambert,
    Diffuse,
    Glossy { exponent: T },
    Disney(Disney),
}

/// The directions at a point of a surface, all of length 1.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Frame<T: Real> {
    pub(in super::super) normal: T::Vec3,
    /// To where the ray came from.
    pub(in super::super) view: T::Vec3,
}

impl<T: Real> Frame<T> {
    fn reflected(&self) -> T::Vec3 {
        let two = T::one() + T::one();
        self.normal * (two * self.normal.dot(self.view)) - self.view
    }

    /// Along the parallels and along the meridians about the y axis.
    pub(super) fn tangents(&self) -> [T::Vec3; 2] {
        let [x, _, z] = self.normal.to_array();
        if x == T::zero() && z == T::zero() {
            return basis::<T>(self.normal);
        }
        let along = T::Vec3::new(z, T::zero(), -x).normalize();
        [along, self.normal.cross(along)]
    }
}

impl<T: Real> Brdf<T> {
    /// What of the light from `light` goes to the viewer, where N·L > 0.
    pub(in super::super) fn value(&self, color: T::Vec3, frame: &Frame<T>, light: T::Vec3) -> T::Vec3 {
        match self {
            Self::Lambert => color,
            Self::Diffuse => color * T::from_f64(FRAC_1_PI),
            Self::Glossy { exponent } => {
                let two = T::one() + T::one();
                let lobe = frame.reflected().dot(light).max(T::zero()).power(*exponent);
                color * ((*exponent + two) / T::from_f64(TAU) * lobe)
            }
            Self::Disney(parameters) => disney::value(parameters, color, frame, light),
        }
    }

    /// A direction drawn for this BRDF: by the cosine to the normal, or for a lobe by the lobe itself.
    pub(in super::super) fn draw(&self, frame: &Frame<T>, [u, v]: [T; 2]) -> T::Vec3 {
        match self {
            Self::Glossy { exponent } => {
                let cosine = (T::one() - u).power((*exponent + T::one()).recip());
                let sine = (T::one() - cosine * cosine).max(T::zero()).sqrt();
                around::<T>(frame.reflected(), cosine, sine, v)
            }
            _ => around::<T>(frame.normal, (T::one() - u).sqrt(), u.sqrt(), v),
        }
    }

    /// The density with which [`Brdf::draw`] draws that direction, over the solid angle.
    pub(in super::super) fn density(&self, frame: &Frame<T>, light: T::Vec3) -> T {
        match self {
            Self::Glossy { exponent } => {
                let lobe = frame.reflected().dot(light).max(T::zero()).power(*exponent);
                (*exponent + T::one()) / T::from_f64(TAU) * lobe
            }
            _ => frame.normal.dot(light).max(T::zero()) * T::from_f64(FRAC_1_PI),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use toyproof_image::pcg;
    use toyproof_scene::unit;

    use super::*;

    fn numbers(count: u32) -> impl Iterator<Item = [f64; 4]> {
        (0..count).map(|i| [0, 1, 2, 3].map(|j| unit(pcg(4 * i + j))))
    }

    /// Uniform over the half space of +z.
    fn above([u, v]: [f64; 2]) -> DVec3 {
        around::<f64>(DVec3::Z, u, (1.0 - u * u).sqrt(), v)
    }

    fn all() -> [Brdf<f64>; 4] {
        let disney = Disney {
            metallic: 0.3,
            subsurface: 0.4,
            anisotropic: 0.6,
            sheen: 0.5,
            clearcoat: 0.7,
            ..Disney::default()
        };
        [
            Brdf::Lambert,
            Brdf::Diffuse,
            Brdf::Glossy { exponent: 20.0 },
            Brdf::Disney(disney),
        ]
    }

    #[test]
    fn light_and_view_can_be_swapped() {
        let color = DVec3::new(0.9, 0.5, 0.2);
        for [a, b, c, d] in numbers(1000) {
            let (light, view) = (above([a, b]), above([c, d]));
            let frame = |view| Frame {
                normal: DVec3::Z,
                view,
            };
            for brdf in all() {
                let there = brdf.value(color, &frame(view), light);
                let back = brdf.value(color, &frame(light), view);
                assert!((there - back).length() <= 1e-10 * there.length(), "{brdf:?}");
            }
        }
    }

    #[test]
    fn what_is_drawn_has_the_density_that_is_said() {
        // The mean of g over drawn directions is the integral of g times the density.
        let frame = Frame {
            normal: DVec3::Z,
            view: DVec3::new(0.3, -0.4, 0.75f64.sqrt()),
        };
        let g = |direction: DVec3| (direction - DVec3::new(0.2, 0.5, 0.8)).length_squared();
        let count = 200_000;
        for brdf in [Brdf::Diffuse, Brdf::Glossy { exponent: 5.0 }] {
            let (mut drawn, mut integral, mut total) = (0.0, 0.0, 0.0);
            for [a, b, c, d] in numbers(count) {
                drawn += g(brdf.draw(&frame, [a, b]));
                let anywhere =
                    around::<f64>(DVec3::Z, 2.0 * c - 1.0, (1.0 - (2.0 * c - 1.0).powi(2)).sqrt(), d);
                let density = 4.0 * std::f64::consts::PI * brdf.density(&frame, anywhere);
                total += density;
                integral += g(anywhere) * density;
            }
            let [drawn, integral, total] = [drawn, integral, total].map(|sum| sum / f64::from(count));
            assert!(
                (total - 1.0).abs() < 0.02,
                "{brdf:?}: the density sums to {total}"
            );
            assert!(
                (drawn - integral).abs() < 0.02 * drawn,
                "{brdf:?}: {drawn} {integral}"
            );
        }
    }

    #[test]
    fn no_more_light_comes_back_than_fell_in() {
        let frame = |view| Frame {
            normal: DVec3::Z,
            view,
        };
        for brdf in all().into_iter().skip(1) {
            for cosine in [0.2, 0.6, 0.95] {
                let view = around::<f64>(DVec3::Z, cosine, (1.0f64 - cosine * cosine).sqrt(), 0.1);
                // By cosine: f cos / density = π f.
                let albedo: f64 = numbers(20_000)
                    .map(|[a, b, _, _]| {
                        let light = Brdf::Diffuse.draw(&frame(view), [a, b]);
                        std::f64::consts::PI * brdf.value(DVec3::ONE, &frame(view), light).x
                    })
                    .sum::<f64>()
                    / 20_000.0;
                // Burley's sheen and retro-reflection may gain a little, as his paper says.
                assert!(albedo > 0.2 && albedo < 1.15, "{brdf:?} at {cosine}: {albedo}");
            }
        }
    }
}
