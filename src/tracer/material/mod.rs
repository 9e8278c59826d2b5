//! What surfaces do with light.

mod brdf;
mod disney;
mod glass;

pub(super) use brdf::{Brdf, Frame};
pub(super) use glass::{Glass, Meeting};
use toyproof_scene as scene;

use super::real::{Real, Vector};

#[derive(Debug)]
pub(super) struct Material<T: Real> {
    pub(super) model: Model<T>,
    color: T::Vec3,
    /// The colour of every other square and the squares' side.
    checker: Option<(T::Vec3, T)>,
}

/// How a surface answers light.
#[derive(Debug)]
pub(super) enum Model<T: Real> {
    Facing,
    Emitter,
    Reflective(Brdf<T>),
    Mirror,
    Glass(Glass<T>),
}

impl<T: Real> Material<T> {
    pub(super) fn new(material: &scene::Material) -> Self {
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
            checker: material
                .checker
                .map(|checker| (T::Vec3::from_f64(checker.color), T::from_f64(checker.size))),
        }
    }

    /// The colour at a point.
    pub(super) fn color(&self, point: T::Vec3) -> T::Vec3 {
        let Some((other, side)) = self.checker else {
            return self.color;
        };
        let [x, _, z] = point.to_array().map(|along| (along / side).floor());
        let sum = x + z;
        let two = T::one() + T::one();
        if sum - two * (sum / two).floor() == T::zero() {
            self.color
        } else {
            other
        }
    }
}
