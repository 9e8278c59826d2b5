//! Which functions of constants a WGSL compiler evaluates as the evaluator does.
//!
//! `normalize(vec3f(1.0, 2.0, 3.0))` stays readable, since its steps have one result each. `cos(PI / 4.0)` has
//! other last bits in naga, which proofs read WGSL with, and becomes a literal where these differ.

use toyproof_glsl::tree::BuiltIn;

/// Whether naga evaluates a function of constants to `value`, or leaves it to the driver.
pub(super) fn agrees(function: BuiltIn, arguments: &[Vec<f32>], value: &[f32]) -> bool {
    let at = |argument: usize, component: usize| {
        let argument = &arguments[argument];
        argument[if argument.len() == 1 { 0 } else { component }]
    };
    value.iter().enumerate().all(|(component, value)| {
        let x = at(0, component);
        let evaluated = match function {
            BuiltIn::Radians => x.to_radians(),
            BuiltIn::Degrees => x.to_degrees(),
            BuiltIn::Sin => x.sin(),
            BuiltIn::Cos => x.cos(),
            BuiltIn::Tan => x.tan(),
            BuiltIn::Asin => x.asin(),
            BuiltIn::Acos => x.acos(),
            BuiltIn::Atan if arguments.len() == 2 => x.atan2(at(1, component)),
            BuiltIn::Atan => x.atan(),
            BuiltIn::Sinh => x.sinh(),
            BuiltIn::Cosh => x.cosh(),
            BuiltIn::Tanh => x.tanh(),
            BuiltIn::Asinh => f64::from(x).asinh() as f32,
            BuiltIn::Acosh => f64::from(x).acosh() as f32,
            BuiltIn::Atanh => x.atanh(),
            BuiltIn::Exp => x.exp(),
            BuiltIn::Exp2 => x.exp2(),
            BuiltIn::Log => x.ln(),
            BuiltIn::Log2 => x.log2(),
            // Both are refused, although GLSL defines the second.
            BuiltIn::Pow if x < 0.0 || x == 0.0 && at(1, component) == 0.0 => return false,
            BuiltIn::Pow => x.powf(at(1, component)),
            // The steps of all others are the evaluator's, or are not evaluated.
            _ => return true,
        };
        evaluated.to_bits() == value.to_bits()
    })
}
