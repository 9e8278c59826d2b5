//! Burley's BRDF: B. Burley, “Physically Based Shading at Disney”, SIGGRAPH 2012 course notes, section 5. Colours are
//! taken as linear.

use std::f64::consts::FRAC_1_PI;

use toyproof_scene::Disney;

use super::super::real::{Real, Vector};
use super::brdf::Frame;

fn number<T: Real>(value: f64) -> T {
    T::from_f64(value)
}

fn mix<T: Real>(a: T, b: T, share: T) -> T {
    a + (b - a) * share
}

fn mix_colors<T: Real>(a: T::Vec3, b: T::Vec3, share: T) -> T::Vec3 {
    a + (b - a) * share
}

fn square<T: Real>(x: T) -> T {
    x * x
}

/// Schlick's weight, (1 − cosine)⁵.
fn schlick<T: Real>(cosine: T) -> T {
    let m = (T::one() - cosine).max(T::zero()).min(T::one());
    square(square(m)) * m
}

/// Berry's distribution, γ = 1, for the clear coat.
fn berry<T: Real>(n_h: T, alpha: T) -> T {
    let a2 = square(alpha);
    (a2 - T::one()) * number(FRAC_1_PI) / (a2.logarithm() * (T::one() + (a2 - T::one()) * square(n_h)))
}

/// Trowbridge and Reitz's, γ = 2, stretched along the tangents.
fn trowbridge_reitz<T: Real>(n_h: T, [x_h, y_h]: [T; 2], [ax, ay]: [T; 2]) -> T {
    let sum = square(x_h / ax) + square(y_h / ay) + square(n_h);
    number::<T>(FRAC_1_PI) / (ax * ay * square(sum))
}

/// One direction's share of Smith's shadowing for GGX (Walter et al. 2007), over twice its cosine.
fn smith<T: Real>(cosine: T, alpha: T) -> T {
    let (a2, c2) = (square(alpha), square(cosine));
    (cosine + (a2 + c2 - a2 * c2).sqrt()).recip()
}

/// The BRDF where N·L > 0; black where N·V ≤ 0.
pub(super) fn value<T: Real>(disney: &Disney, color: T::Vec3, frame: &Frame<T>, light: T::Vec3) -> T::Vec3 {
    let Frame { normal, view } = *frame;
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

    // The base colour with its luminance taken out.
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

    // Diffuse: from 1 at the normal to ½ or more at grazing, by roughness.
    let retro = square(l_h) * roughness;
    let grazing = number::<T>(0.5) + retro + retro;
    let diffuse = mix(one, grazing, f_l) * mix(one, grazing, f_v);
    // Subsurface: Hanrahan and Krueger's, approximated.
    let flat = mix(one, retro, f_l) * mix(one, retro, f_v);
    let subsurface = number::<T>(1.25) * (flat * ((n_l + n_v).recip() - number(0.5)) + number(0.5));
    let base = color * (number::<T>(FRAC_1_PI) * mix(diffuse, subsurface, number(disney.subsurface)));

    // Specular.
    let aspect = (1.0 - 0.9 * disney.anisotropic).sqrt();
    let spread = square(disney.roughness);
    let alpha = [spread / aspect, spread * aspect].map(|alpha| number::<T>(alpha.max(0.001)));
    let along = frame.tangents().map(|tangent| tangent.dot(half));
    let d = trowbridge_reitz(n_h, along, alpha);
    let alpha_g = number::<T>(square(0.5 + 0.5 * disney.roughness));
    let g = smith(n_l, alpha_g) * smith(n_v, alpha_g);
    let lobe = mix_colors::<T>(specular, white, f_h) * (d * g);

    // The clear coat: a polyurethane of index 1.5.
    let gloss = number(0.1 + (0.001 - 0.1) * disney.clearcoat_gloss);
    let quarter = number(0.25);
    let coat = number::<T>(0.25 * disney.clearcoat)
        * berry(n_h, gloss)
        * mix(number(0.04), one, f_h)
        * smith(n_l, quarter)
        * smith(n_v, quarter);

    (base + sheen) * (one - number(disney.metallic)) + lobe + white * coat
}
