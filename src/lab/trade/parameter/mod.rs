//! The parameters of a shader that trade speed for accuracy: the limits of its loops, step sizes, thresholds,
//! the resolution, and any constant that the user names.

mod find;
mod named;

use std::fmt;

use serde::Serialize;
use toyproof_diagnostic::Span;

pub(super) use self::find::{LINE, Scope, proposals};
pub use self::named::{Vary, VaryError, VaryParseError};

/// What a parameter does, which tells the direction in which the shader becomes faster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// The number of iterations of a loop: steps, samples, octaves, bounces.
    Count,
    /// The limit of a length or a time at which a loop ends.
    Extent,
    /// A small number below which a loop ends.
    Threshold,
    /// The length of a step, or the factor of one.
    Step,
    /// A factor of 1 of a step that has none: more is over-relaxation (Keinert et al., “Enhanced Sphere
    /// Tracing”, STAG 2014, section 3.1).
    Relaxation,
    /// The size of the image that is rendered and enlarged, relative to the shown one.
    Resolution,
    /// Unknown: a constant that only the user names.
    Constant,
}

impl Role {
    /// Cheaper values, from the nearest one.
    pub(super) fn cheaper(self, value: f64, is_integer: bool) -> Vec<f64> {
        let factors: &[f64] = match self {
            Self::Count => &[7.0 / 8.0, 0.75, 0.625, 0.5, 0.375, 0.25, 0.125],
            Self::Extent => &[0.75, 0.5, 0.35, 0.25],
            Self::Threshold => &[2.0, 5.0, 10.0, 30.0, 100.0],
            Self::Step => &[1.25, 1.5, 2.0, 3.0],
            Self::Relaxation => &[1.2, 1.4, 1.6],
            Self::Resolution => &[0.75, 0.5],
            Self::Constant => &[],
        };
        let mut values = Vec::new();
        for factor in factors {
            let next = in_steps(value * factor, is_integer);
            if next > 0.0 && next != value && !values.contains(&next) {
                values.push(next);
            }
        }
        values
    }

    /// A more accurate value: after `level` halvings of what the value leaves out.
    pub(super) fn generous(self, value: f64, level: i32) -> Option<f64> {
        let factor = 2f64.powi(level);
        match self {
            Self::Count | Self::Extent => Some(value * factor),
            Self::Threshold => Some(value / (factor * factor)),
            Self::Step => Some(value / factor),
            Self::Relaxation | Self::Resolution | Self::Constant => None,
        }
    }
}

/// Rounds to an integer, or to three significant digits, as people write numbers.
fn in_steps(value: f64, is_integer: bool) -> f64 {
    if is_integer || value == 0.0 {
        return value.round();
    }
    let unit = 10f64.powi(value.abs().log10().floor() as i32 - 2);
    let rounded = (value / unit).round() * unit;
    // The product has digits of rounding, which the shortest form of a float does not.
    f64::from(rounded as f32)
}

/// Where the value of a parameter is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Place {
    /// A literal in a file of the user.
    Literal { span: Span, form: Form },
    /// A float expression, which gets a factor.
    Factor(Span),
    /// A uniform with its name.
    Uniform,
    /// The size of the rendered image.
    Size,
}

/// How a literal is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Int,
    Uint,
    Float,
}

impl Form {
    /// A literal with this value.
    pub(super) fn write(self, value: f64) -> String {
        match self {
            Self::Int => format!("{value:.0}"),
            Self::Uint => format!("{value:.0}u"),
            Self::Float => format!("{:?}", value as f32),
        }
    }
}

/// A number of a shader that may be varied.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    /// The name of the constant, macro or uniform; or the line of a literal.
    pub(super) name: String,
    pub(super) role: Role,
    pub(super) value: f64,
    pub(super) place: Place,
}

impl Parameter {
    /// The number of pixels of the rendered image, relative to the shown one.
    pub(super) fn resolution() -> Self {
        Self {
            name: "resolution".to_owned(),
            role: Role::Resolution,
            value: 1.0,
            place: Place::Size,
        }
    }

    /// Whether its values are integers: those of literals without a point, and numbers of iterations.
    pub(super) fn is_integer(&self) -> bool {
        let form = match self.place {
            Place::Literal { form, .. } => Some(form),
            _ => None,
        };
        self.role == Role::Count || matches!(form, Some(Form::Int | Form::Uint))
    }

    pub(super) fn cheaper(&self) -> Vec<f64> {
        self.role.cheaper(self.value, self.is_integer())
    }

    /// This parameter with another value.
    pub(super) fn set(&self, value: f64) -> Setting {
        Setting {
            parameter: self.name.clone(),
            value,
            own: self.value,
            place: self.place.clone(),
        }
    }
}

/// A parameter with a value that is not the shader's own.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Setting {
    /// The name of the constant, macro or uniform, or the line of a literal; `resolution` for the size.
    pub parameter: String,
    /// The value.
    pub value: f64,
    /// The value in the shader.
    pub own: f64,
    #[serde(skip)]
    place: Place,
}

impl Setting {
    pub(super) fn place(&self) -> &Place {
        &self.place
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.parameter, shown(self.value))
    }
}

/// A value as a person writes it, with the digits that a float has.
pub(super) fn shown(value: f64) -> String {
    (value as f32).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cheaper_values_are_those_that_people_write() {
        assert_eq!(
            Role::Count.cheaper(100.0, true),
            [88.0, 75.0, 63.0, 50.0, 38.0, 25.0, 13.0]
        );
        assert_eq!(Role::Count.cheaper(2.0, true), [1.0]);
        assert_eq!(Role::Count.cheaper(1.0, true), [] as [f64; 0]);
        let shown: Vec<_> = Role::Threshold
            .cheaper(0.001, false)
            .into_iter()
            .map(shown)
            .collect();
        assert_eq!(shown, ["0.002", "0.005", "0.01", "0.03", "0.1"]);
        assert_eq!(Role::Step.generous(0.5, 1), Some(0.25));
        assert_eq!(Role::Threshold.generous(0.01, 1), Some(0.0025));
    }

    #[test]
    fn literals_keep_their_form() {
        assert_eq!(Form::Int.write(96.0), "96");
        assert_eq!(Form::Uint.write(96.0), "96u");
        assert_eq!(Form::Float.write(96.0), "96.0");
        assert_eq!(Form::Float.write(0.001), "0.001");
    }
}
