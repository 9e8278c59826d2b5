//! Materials: surface colors and bidirectional reflectance distribution functions (BRDFs).

use std::f64::consts::{FRAC_1_PI, TAU};

use toyproof_scene::{self as scene, Disney};

use crate::glass::Glass;
use crate::lanes::{Columns, Lanes, Wide, Wide3, lanes_of};
use crate::pattern::Pattern;
use crate::real::{Real, Vector};

#[derive(Debug)]
pub(super) struct Material<T: Real> {
    pub(super) model: Model<T>,
    color: T::Vec3,
    /// Boxed, because most surfaces have none.
    pattern: Option<Box<Pattern<T>>>,
}

/// How a surface scatters or emits light.
#[derive(Debug)]
pub(super) enum Model<T: Real> {
    Facing,
    Emitter,
    Reflective(Brdf<T>),
    Mirror,
    Glass(Glass<T>),
}

impl<T: Real> Material<T> {
    pub(super) fn new(object: &scene::Object) -> Self {
        let material = &object.material;
        Self {
            model: match material.model {
                scene::Model::Facing => Model::Facing,
                scene::Model::Emitter => Model::Emitter,
                scene::Model::Lambert => Model::Reflective(Brdf::Lambert),
                scene::Model::Diffuse => Model::Reflective(Brdf::Diffuse),
                scene::Model::Glossy { exponent } => Model::Reflective(Brdf::Glossy {
                    exponent: T::from_f64(exponent),
                }),
                scene::Model::Disney(disney) => Model::Reflective(Brdf::Disney(disney)),
                scene::Model::Mirror => Model::Mirror,
                scene::Model::Glass { ior, fresnel } => Model::Glass(Glass {
                    ior: T::from_f64(ior),
                    fresnel,
                }),
            },
            color: T::Vec3::from_f64(material.color),
            pattern: material
                .pattern
                .map(|pattern| Box::new(Pattern::new(&pattern, &object.shape))),
        }
    }

    /// Returns the color if it is the same everywhere.
    pub(super) fn uniform_color(&self) -> Option<T::Vec3> {
        self.pattern.is_none().then_some(self.color)
    }

    /// Returns the color at a point of the surface, which is given with the normal there, and computed only
    /// if the color depends on it.
    pub(super) fn color(&self, at: impl FnOnce() -> [T::Vec3; 2]) -> T::Vec3 {
        if let Some(pattern) = &self.pattern {
            let [point, normal] = at();
            if pattern.is_second(point, normal) {
                return pattern.color;
            }
        }
        self.color
    }
}

#[derive(Debug)]
pub(super) enum Brdf<T> {
    Lambert,
    Diffuse,
    Glossy { exponent: T },
    Disney(Disney),
}

/// The shading frames at surface points, one per lane; both directions have unit length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<T, S: Lanes<T>> {
    pub(super) normal: Wide3<T, S>,
    /// Direction toward the origin of the ray.
    pub(super) view: Wide3<T, S>,
}

impl<T: Real, S: Lanes<T>> Frame<T, S> {
    #[inline(always)]
    fn reflected(&self, simd: S) -> Wide3<T, S> {
        let two = Wide::splat(simd, T::one() + T::one());
        self.normal * (two * self.normal.dot(self.view)) - self.view
    }
}

/// Returns the tangents along the parallels and along the meridians about the y axis.
fn tangents<T: Real>(normal: T::Vec3) -> [T::Vec3; 2] {
    let [x, _, z] = normal.to_array();
    let along = if x == T::zero() && z == T::zero() {
        T::Vec3::from_f64([1.0, 0.0, 0.0]).cross(normal)
    } else {
        T::Vec3::new(z, T::zero(), -x)
    };
    let along = along.normalize();
    [along, normal.cross(along)]
}

/// A BRDF for light from one direction per lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scattering<T, S: Lanes<T>> {
    /// The value of the BRDF.
    pub(super) value: Wide3<T, S>,
    /// The probability density of [`Brdf::sample`] in solid angle.
    pub(super) density: Wide<T, S>,
}

impl<T: Real> Brdf<T> {
    /// Evaluates the BRDF and the density of its samples for light from the directions `light`, where N·L >
    /// 0, in the lanes in `active`.
    #[inline(always)]
    pub(super) fn scattering<S: Lanes<T>>(
        &self,
        simd: S,
        color: Wide3<T, S>,
        frame: &Frame<T, S>,
        light: Wide3<T, S>,
        active: u32,
    ) -> Scattering<T, S> {
        let [tau, reciprocal_pi] = [TAU, FRAC_1_PI].map(|number| Wide::splat(simd, T::from_f64(number)));
        if let Self::Glossy { exponent } = self {
            let [two, one] = [T::one() + T::one(), T::one()].map(|number| Wide::splat(simd, number));
            let cosine = frame.reflected(simd).dot(light).positive();
            let lobe = cosine.map(active, |cosine| cosine.power(*exponent));
            let exponent = Wide::splat(simd, *exponent);
            return Scattering {
                value: color * ((exponent + two) / tau * lobe),
                density: (exponent + one) / tau * lobe,
            };
        }
        Scattering {
            value: match self {
                Self::Disney(parameters) => {
                    let [normals, views, lights, colors] =
                        [frame.normal, frame.view, light, color].map(Columns::from);
                    let mut values = Columns::splat([T::zero(); 3]);
                    for lane in lanes_of(active) {
                        let [normal, view, light, color] = [&normals, &views, &lights, &colors]
                            .map(|vectors| T::Vec3::from_array(vectors.get(lane)));
                        values.set(
                            lane,
                            disney::<T>(parameters, color, [normal, view], light).to_array(),
                        );
                    }
                    values.load(simd, 0)
                }
                Self::Diffuse => color * reciprocal_pi,
                Self::Lambert | Self::Glossy { .. } => color,
            },
            density: frame.normal.dot(light).positive() * reciprocal_pi,
        }
    }

    /// Samples an angle from the axis of the lobe: proportional to the cosine to the normal, or to the lobe
    /// of a glossy BRDF. Returns that axis, and the cosine and the sine of the angle.
    #[inline(always)]
    pub(super) fn sample<S: Lanes<T>>(
        &self,
        simd: S,
        frame: &Frame<T, S>,
        u: Wide<T, S>,
        active: u32,
    ) -> (Wide3<T, S>, [Wide<T, S>; 2]) {
        let one = Wide::splat(simd, T::one());
        match self {
            Self::Glossy { exponent } => {
                let root = (*exponent + T::one()).recip();
                let cosine = (one - u).map(active, |power| power.power(root));
                let sine = (one - cosine * cosine).positive().sqrt();
                (frame.reflected(simd), [cosine, sine])
            }
            _ => (frame.normal, [(one - u).sqrt(), u.sqrt()]),
        }
    }
}

// Disney BRDF: B. Burley, “Physically Based Shading at Disney”, SIGGRAPH 2012 course notes, section 5. Colors
// are linear.

fn number<T: Real>(value: f64) -> T {
    T::from_f64(value)
}

fn mix<T: Real>(a: T, b: T, weight: T) -> T {
    a + (b - a) * weight
}

fn mix_colors<T: Real>(a: T::Vec3, b: T::Vec3, weight: T) -> T::Vec3 {
    a + (b - a) * weight
}

fn square<T: Real>(x: T) -> T {
    x * x
}

/// Schlick's weight, (1 − cosine)⁵.
fn schlick<T: Real>(cosine: T) -> T {
    let m = (T::one() - cosine).max(T::zero()).min(T::one());
    square(square(m)) * m
}

/// Berry's distribution (γ = 1) for the clear coat.
fn berry<T: Real>(n_h: T, alpha: T) -> T {
    let a2 = square(alpha);
    (a2 - T::one()) * number(FRAC_1_PI) / (a2.logarithm() * (T::one() + (a2 - T::one()) * square(n_h)))
}

/// The anisotropic Trowbridge–Reitz distribution (γ = 2).
fn trowbridge_reitz<T: Real>(n_h: T, [x_h, y_h]: [T; 2], [ax, ay]: [T; 2]) -> T {
    let sum = square(x_h / ax) + square(y_h / ay) + square(n_h);
    number::<T>(FRAC_1_PI) / (ax * ay * square(sum))
}

/// Smith's masking-shadowing factor for GGX in one direction (Walter et al. 2007), divided by twice its
/// cosine.
fn smith<T: Real>(cosine: T, alpha: T) -> T {
    let (a2, c2) = (square(alpha), square(cosine));
    (cosine + (a2 + c2 - a2 * c2).sqrt()).recip()
}

/// Evaluates the BRDF where N·L > 0; it is black where N·V ≤ 0.
fn disney<T: Real>(disney: &Disney, color: T::Vec3, [normal, view]: [T::Vec3; 2], light: T::Vec3) -> T::Vec3 {
    let (n_l, n_v) = (normal.dot(light), normal.dot(view));
    if n_l <= T::zero() || n_v <= T::zero() {
        return T::Vec3::ZERO;
    }
    let half = (light + view).normalize();
    let (n_h, l_h) = (normal.dot(half), light.dot(half));
    let (f_l, f_v, f_h) = (schlick(n_l), schlick(n_v), schlick(l_h));
    let one = T::one();
    let white = T::Vec3::from_f64([1.0; 3]);
    let roughness: T = number(disney.roughness);

    // Base color normalized by its luminance.
    let luminance = color.dot(T::Vec3::from_f64([0.3, 0.6, 0.1]));
    let tint = if luminance > T::zero() {
        color / luminance
    } else {
        white
    };
    let dielectric =
        mix_colors::<T>(white, tint, number(disney.specular_tint)) * number::<T>(0.08 * disney.specular);
    let specular = mix_colors::<T>(dielectric, color, number(disney.metallic));
    let sheen = mix_colors::<T>(white, tint, number(disney.sheen_tint)) * (f_h * number(disney.sheen));

    // Diffuse: 1 at normal incidence, and at grazing incidence ½ or more, depending on roughness.
    let retro = square(l_h) * roughness;
    let grazing = number::<T>(0.5) + retro + retro;
    let diffuse = mix(one, grazing, f_l) * mix(one, grazing, f_v);
    // Subsurface: approximation of Hanrahan and Krueger's model.
    let flat = mix(one, retro, f_l) * mix(one, retro, f_v);
    let subsurface = number::<T>(1.25) * (flat * ((n_l + n_v).recip() - number(0.5)) + number(0.5));
    let base = color * (number::<T>(FRAC_1_PI) * mix(diffuse, subsurface, number(disney.subsurface)));

    // Specular.
    let aspect = (1.0 - 0.9 * disney.anisotropic).sqrt();
    let spread = square(disney.roughness);
    let alpha = [spread / aspect, spread * aspect].map(|alpha| number::<T>(alpha.max(0.001)));
    let along = tangents::<T>(normal).map(|tangent| tangent.dot(half));
    let d = trowbridge_reitz(n_h, along, alpha);
    let alpha_g = number::<T>(square(0.5 + 0.5 * disney.roughness));
    let g = smith(n_l, alpha_g) * smith(n_v, alpha_g);
    let lobe = mix_colors::<T>(specular, white, f_h) * (d * g);

    // Clear coat: polyurethane with an index of refraction of 1.5.
    let gloss = number(0.1 + (0.001 - 0.1) * disney.clearcoat_gloss);
    let quarter = number(0.25);
    let coat = number::<T>(0.25 * disney.clearcoat)
        * berry(n_h, gloss)
        * mix(number(0.04), one, f_h)
        * smith(n_l, quarter)
        * smith(n_v, quarter);

    (base + sheen) * (one - number(disney.metallic)) + lobe + white * coat
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pulp::Scalar;
    use toyproof_image::pcg;
    use toyproof_scene::unit;

    use super::*;
    use crate::ray::spherical_direction;

    fn random_numbers(count: u32) -> impl Iterator<Item = [f64; 4]> {
        (0..count).map(|i| [0, 1, 2, 3].map(|j| unit(pcg(4 * i + j))))
    }

    fn splat(vector: DVec3) -> Wide3<f64, Scalar> {
        Wide3::splat(Scalar, vector.to_array())
    }

    fn single(vector: Wide3<f64, Scalar>) -> DVec3 {
        DVec3::from_array(Columns::from(vector).get(0))
    }

    fn spherical(axis: DVec3, cosine_sine_turn: [f64; 3]) -> DVec3 {
        let simd = Scalar;
        let numbers = cosine_sine_turn.map(|number| Wide::splat(simd, number));
        single(spherical_direction(simd, splat(axis), numbers, 1))
    }

    /// The value of a BRDF and the density of its samples, for a frame of a normal and a view.
    fn scattering(brdf: &Brdf<f64>, color: DVec3, [normal, view]: [DVec3; 2], light: DVec3) -> (DVec3, f64) {
        let frame = Frame {
            normal: splat(normal),
            view: splat(view),
        };
        let scattering = brdf.scattering(Scalar, splat(color), &frame, splat(light), 1);
        (single(scattering.value), scattering.density.to_array()[0])
    }

    fn value(brdf: &Brdf<f64>, color: DVec3, frame: [DVec3; 2], light: DVec3) -> DVec3 {
        scattering(brdf, color, frame, light).0
    }

    fn sample(brdf: &Brdf<f64>, [normal, view]: [DVec3; 2], [u, v]: [f64; 2]) -> DVec3 {
        let simd = Scalar;
        let frame = Frame {
            normal: splat(normal),
            view: splat(view),
        };
        let (axis, [cosine, sine]) = brdf.sample(simd, &frame, Wide::splat(simd, u), 1);
        single(spherical_direction(
            simd,
            axis,
            [cosine, sine, Wide::splat(simd, v)],
            1,
        ))
    }

    /// Samples the hemisphere of +z uniformly.
    fn sample_hemisphere([u, v]: [f64; 2]) -> DVec3 {
        spherical(DVec3::Z, [u, (1.0 - u * u).sqrt(), v])
    }

    fn all_brdfs() -> [Brdf<f64>; 4] {
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
    fn brdfs_are_reciprocal() {
        let color = DVec3::new(0.9, 0.5, 0.2);
        for [a, b, c, d] in random_numbers(1000) {
            let (light, view) = (sample_hemisphere([a, b]), sample_hemisphere([c, d]));
            let frame = |view| [DVec3::Z, view];
            for brdf in all_brdfs() {
                let there = value(&brdf, color, frame(view), light);
                let back = value(&brdf, color, frame(light), view);
                assert!((there - back).length() <= 1e-10 * there.length(), "{brdf:?}");
            }
        }
    }

    #[test]
    fn samples_follow_the_stated_density() {
        // The mean of g over sampled directions equals the integral of g times the density.
        let frame = [DVec3::Z, DVec3::new(0.3, -0.4, 0.75f64.sqrt())];
        let g = |direction: DVec3| (direction - DVec3::new(0.2, 0.5, 0.8)).length_squared();
        let count = 200_000;
        for brdf in [Brdf::Diffuse, Brdf::Glossy { exponent: 5.0 }] {
            let (mut sampled, mut integral, mut total) = (0.0, 0.0, 0.0);
            for [a, b, c, d] in random_numbers(count) {
                sampled += g(sample(&brdf, frame, [a, b]));
                let anywhere = spherical(
                    DVec3::Z,
                    [2.0 * c - 1.0, (1.0 - (2.0 * c - 1.0).powi(2)).sqrt(), d],
                );
                let density = 4.0 * std::f64::consts::PI * scattering(&brdf, DVec3::ONE, frame, anywhere).1;
                total += density;
                integral += g(anywhere) * density;
            }
            let [sampled, integral, total] = [sampled, integral, total].map(|sum| sum / f64::from(count));
            assert!(
                (total - 1.0).abs() < 0.02,
                "{brdf:?}: the density sums to {total}"
            );
            assert!(
                (sampled - integral).abs() < 0.02 * sampled,
                "{brdf:?}: {sampled} {integral}"
            );
        }
    }

    #[test]
    fn brdfs_conserve_energy() {
        let frame = |view| [DVec3::Z, view];
        for brdf in all_brdfs().into_iter().skip(1) {
            for cosine in [0.2, 0.6, 0.95] {
                let view = spherical(DVec3::Z, [cosine, (1.0f64 - cosine * cosine).sqrt(), 0.1]);
                // With cosine sampling, f cos / density = π f.
                let albedo: f64 = random_numbers(20_000)
                    .map(|[a, b, _, _]| {
                        let light = sample(&Brdf::Diffuse, frame(view), [a, b]);
                        std::f64::consts::PI * value(&brdf, DVec3::ONE, frame(view), light).x
                    })
                    .sum::<f64>()
                    / 20_000.0;
                // Burley's sheen and retro-reflection may gain some energy, as his paper states.
                assert!(albedo > 0.2 && albedo < 1.15, "{brdf:?} at {cosine}: {albedo}");
            }
        }
    }
}
