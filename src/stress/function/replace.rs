//! Replaces the ray–sphere intersection of a user's shader by other formulas.

use std::ops::Range;

use toyproof_glsl::tree::{Scalar, Type};
use toyproof_glsl::{self as glsl, Checked};

use super::role::Output;
use super::typical::DirectionLength;
use super::{FunctionRunner, MissConvention, Role, RoleMap, Signature};
use crate::body::body;
use crate::case::RaySphere;
use crate::formula::{FORMULAS, Formula, RECENTERED};
use crate::run::RunError;
use crate::tally::Outcome;

/// The shader with its ray–sphere function replaced by each of the formulas, with the formula's name; empty
/// if that function is not recognized, or its results for typical rays differ from the formulas'.
///
/// # Errors
///
/// [`RunError`] if the function cannot be run.
pub fn replacements(
    text: &str,
    checked: &Checked,
    options: &glsl::Options,
) -> Result<Vec<(&'static str, String)>, RunError> {
    let all = Signature::all(checked, &RoleMap::new());
    let of_spheres = |one: &&Signature| one.name.to_lowercase().contains("sph");
    let Some(signature) = all.iter().find(of_spheres).or(all.first()) else {
        return Ok(Vec::new());
    };
    let Some(body) = only_body(text, checked, &signature.name) else {
        return Ok(Vec::new());
    };
    let runner = FunctionRunner::new(text, signature, options, options.deadline.left())?;
    let Some(new_body) = runner.body()? else {
        return Ok(Vec::new());
    };
    let with = |formula: &Formula| {
        let (function, helper) = (reserved_name(formula.function()), reserved_name("powerOfTwo"));
        let formula_text = formula
            .text
            .replace(formula.function(), &function)
            .replace("powerOfTwo", &helper);
        let (before, after) = (&text[..body.start], &text[body.end..]);
        let new_body = new_body.replace("FORMULA", &function);
        format!("{formula_text}\n{before}{new_body}{after}")
    };
    if !runner.agrees(&with(&RECENTERED), signature, options)? {
        return Ok(Vec::new());
    }
    let made = FORMULAS.iter().map(|formula| (formula.name, with(formula)));
    Ok(made.collect())
}

/// A name that user code does not use.
fn reserved_name(name: &str) -> String {
    format!("toyproof_{name}")
}

impl FunctionRunner<'_> {
    /// Whether a shader's function of the same signature returns the same results for typical rays.
    fn agrees(&self, text: &str, signature: &Signature, options: &glsl::Options) -> Result<bool, RunError> {
        let other = match FunctionRunner::new(text, signature, options, options.deadline.left()) {
            Err(RunError::Invalid(_)) => return Ok(false),
            other => other?,
        };
        let outcomes = |runner: &FunctionRunner| {
            runner.typical_outcomes(DirectionLength::Unit, &runner.miss_convention::<f64>()?)
        };
        let (ours, theirs) = (outcomes(self)?, outcomes(&other)?);
        let same = |one: Outcome, other: Outcome| match (one, other) {
            (Outcome::Hit(one), Outcome::Hit(other)) => (one - other).abs() < 1e-6 * one.abs(),
            (one, other) => one == other,
        };
        let pairs = ours.iter().zip(&theirs);
        let agreeing = pairs.filter(|(one, other)| same(one.1, other.1)).count();
        // The user's function may be wrong for some rays, such as those from inside, or with the sphere
        // behind.
        Ok(agreeing * 2 > ours.len())
    }

    /// A body that calls `FORMULA` and returns its result in the function's own convention; `None` if that is
    /// not simple.
    fn body(&self) -> Result<Option<String>, RunError> {
        let convention: MissConvention = self.miss_convention::<f32>()?;
        let path = |role: Role| {
            let mut inputs = self.signature.inputs.iter();
            inputs
                .find(|(_, found)| *found == role)
                .map(|(path, _)| path.clone())
        };
        let (Some(o), Some(d)) = (path(Role::Origin), path(Role::Direction)) else {
            return Ok(None);
        };
        let (c, r) = match (path(Role::Center), path(Role::Radius), path(Role::Sphere)) {
            (_, _, Some(sphere)) => (format!("{sphere}.xyz"), format!("{sphere}.w")),
            (Some(c), Some(r), _) => (c, r),
            _ => return Ok(None),
        };
        let t_min = match path(Role::TMin) {
            Some(path) => path,
            None => number(self.smallest_t(&convention)?),
        };
        let call = |t_min: &str| format!("FORMULA({o}, {d}, {c}, {r}, {t_min})");
        let pair = Type::vector(Scalar::Float, 2);
        let is_result = |output: &Output| output.path == "return";
        let statements = match &self.signature.outputs[..] {
            [one] if is_result(one) && one.role == Role::T && one.ty == Type::FLOAT => {
                let miss = match convention.positive_miss() {
                    Some(miss) => number(miss),
                    None if convention.behind_is_miss() => "-1.0".to_owned(),
                    None => return Ok(None),
                };
                vec![
                    format!("float toyproof_t = {};", call(&t_min)),
                    format!("return toyproof_t > {t_min} ? toyproof_t : {miss};"),
                ]
            }
            [one] if is_result(one) && one.role == Role::T && one.ty == pair => {
                let Some([near, _, far]) = convention.miss() else {
                    return Ok(None);
                };
                vec![
                    format!("float toyproof_near = {};", call("-1.0e30")),
                    format!("float toyproof_far = {};", call("toyproof_near")),
                    // The formulas' results for a miss; a ray tangent to a sphere behind it, which has the
                    // same results, is also a miss.
                    "bool toyproof_miss = toyproof_near == -1.0 && toyproof_far == -1.0;".to_owned(),
                    format!(
                        "return toyproof_miss ? vec2({}, {}) : vec2(toyproof_near, toyproof_far);",
                        number(near),
                        number(far)
                    ),
                ]
            }
            [t, flag] | [flag, t]
                if (t.role, t.ty) == (Role::T, Type::FLOAT)
                    && (flag.role, flag.ty) == (Role::Flag, Type::BOOL)
                    && is_result(flag) =>
            {
                let t = &t.path;
                // A value of 0 most likely means that the parameter is not written.
                let miss = convention.miss().map_or(0.0, |[t, ..]| t);
                let else_branch = if miss == 0.0 {
                    String::new()
                } else {
                    format!(" else {t} = {};", number(miss))
                };
                vec![
                    format!("float toyproof_t = {};", call(&t_min)),
                    format!("if (toyproof_t > {t_min}) {t} = toyproof_t;{else_branch}"),
                    format!("return toyproof_t > {t_min};"),
                ]
            }
            _ => return Ok(None),
        };
        Ok(Some(format!("{{\n    {}\n}}", statements.join("\n    "))))
    }

    /// The minimum accepted t of the function: 0, or 1, 2 or 5 times a power of ten.
    fn smallest_t(&self, convention: &MissConvention) -> Result<f64, RunError> {
        let decades = (1..=8).rev().map(|decade| 10f64.powi(-decade));
        let steps: Vec<f64> = decades
            .flat_map(|ten| [1.0, 2.0, 5.0].map(|step| step * ten))
            .collect();
        // The sphere is so small that f32 resolves its surface to a hundredth of the smallest step.
        let r = 2f64.powi(-10);
        let ray_spheres: Vec<RaySphere> = steps
            .iter()
            .map(|step| RaySphere {
                o: [0.0; 3],
                d: [0.0, 0.0, -1.0],
                c: [0.0, 0.0, -(r + 1.01 * step) as f32],
                r: r as f32,
            })
            .collect();
        let outcomes = self.outcomes::<f64>(&ray_spheres, convention)?;
        let counts = |(step, outcome): (&f64, &Outcome)| matches!(outcome, Outcome::Hit(t) if (t - 1.01 * step).abs() < 0.01 * step);
        let first = steps.iter().zip(&outcomes).position(counts);
        Ok(match first {
            Some(0) | None => 0.0,
            Some(at) => steps[at],
        })
    }
}

/// A literal of a float, which always has a point or an exponent.
fn number(value: f64) -> String {
    format!("{:?}", value as f32)
}

/// The byte range of the body of the only function with that name, including its braces.
fn only_body(text: &str, checked: &Checked, name: &str) -> Option<Range<usize>> {
    let functions = checked.tree.functions.iter();
    let mut named = functions.filter(|(_, function)| function.name == name && function.body.is_some());
    match (named.next(), named.next()) {
        (Some((_, function)), None) => body(text, function.at.span.start as usize),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    fn checked(text: &str) -> Checked {
        let mut files = Files::default();
        let file = files.add(File::new("t", text));
        glsl::check(&files, file, &glsl::Options::default())
            .unwrap_or_else(|errors| panic!("{errors:?}\n{text}"))
    }

    #[test]
    fn each_formula_replaces_that_of_an_exercise() {
        let text = include_str!("../../../glsl/03-shading.glsl");
        let made = replacements(text, &checked(text), &glsl::Options::default()).unwrap();
        assert_eq!(made.len(), FORMULAS.len());
        for (name, text) in made {
            assert!(
                text.contains("return toyproof_t > 1e-5 ? toyproof_t : 1000000.0;"),
                "{name}: {text}"
            );
            checked(&text);
        }
    }

    /// A shader that intersects a sphere by that function.
    fn shader(function: &str, call: &str) -> String {
        format!(
            "{function}\nvoid mainImage(out vec4 c, in vec2 p) {{\n    vec3 ro = vec3(0.0, 0.0, 2.0);\n    \
             vec3 rd = normalize(vec3(p / iResolution.xy - 0.5, -1.0));\n    float t;\n    {call}\n}}\n"
        )
    }

    #[test]
    fn root_pairs_and_flags_are_replaced() {
        let pair = shader(
            "vec2 sphere(vec3 ro, vec3 rd, vec3 center, float radius) {
                vec3 oc = ro - center;
                float b = dot(oc, rd);
                float h = b * b - (dot(oc, oc) - radius * radius);
                if (h < 0.0) return vec2(-1.0, -2.0);
                h = sqrt(h);
                return vec2(-b - h, -b + h);
            }",
            "c = vec4(sphere(ro, rd, vec3(0.0), 1.0), 0.0, 1.0);",
        );
        let flag = shader(
            "bool sphere(vec3 ro, vec3 rd, vec3 center, float radius, out float t) {
                vec3 oc = ro - center;
                float b = dot(oc, rd);
                float h = b * b - (dot(oc, oc) - radius * radius);
                t = 1e6;
                if (h < 0.0) return false;
                t = -b - sqrt(h);
                if (t < 0.0) t = -b + sqrt(h);
                return t > 0.0;
            }",
            "c = vec4(sphere(ro, rd, vec3(0.0), 1.0, t) ? t : 0.0);",
        );
        for (text, line) in [
            (pair, "toyproof_miss ? vec2(-1.0, -2.0)"),
            (flag, "if (toyproof_t > 0.0) t = toyproof_t; else t = 1000000.0;"),
        ] {
            let made = replacements(&text, &checked(&text), &glsl::Options::default()).unwrap();
            assert_eq!(made.len(), FORMULAS.len(), "{text}");
            for (name, text) in made {
                assert!(text.contains(line), "{name}: {text}");
                checked(&text);
            }
        }
    }

    #[test]
    fn functions_with_different_results_are_kept() {
        // It does not return the distance.
        let text = shader(
            "bool sphere(vec3 ro, vec3 rd, vec3 center, float radius, inout float t) {
                vec3 oc = ro - center;
                float b = dot(oc, rd);
                float h = b * b - (dot(oc, oc) - radius * radius);
                if (h < 0.0) return false;
                float near = -b - sqrt(h);
                if (near < 0.0 || near > t) return false;
                t = near * near + 1.0;
                return true;
            }",
            "t = 100.0; c = vec4(sphere(ro, rd, vec3(0.0), 1.0, t) ? t : 0.0);",
        );
        let made = replacements(&text, &checked(&text), &glsl::Options::default()).unwrap();
        assert_eq!(made, []);
    }
}
