//! Bidirectional reflectance distribution functions, and directions drawn for them.

use std::f64::consts::{FRAC_1_PI, TAU};

use super::super::ray::{around, basis};
use super::super::real::{Real, Vector};
use super::disney;
use crate::scene::Disney;

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
                let cosine = u.power((*exponent + T::one()).recip());
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
