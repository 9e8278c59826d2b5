//! An author's shader with another formula in the place of its own.

use std::ops::Range;

use super::super::axis::Shot;
use super::super::formula::FORMULAS;
use super::super::tally::Outcome;
use super::super::{Failure, paint};
use super::{Answers, Asked, Role, Signature, subject};
use crate::eval::{self, Program, Variant};
use crate::glsl::{self, Checked};

/// The shader with each of the formulas in the place of the one that it meets spheres with, under the formula's name; none of them where that
/// function cannot be recognised, or gives more than t.
///
/// # Errors
/// If the function cannot be asked how it says no.
pub fn replacements(
    text: &str,
    checked: &Checked,
    options: &glsl::Options,
) -> Result<Vec<(&'static str, String)>, Failure> {
    let all = Signature::all(checked);
    let of_spheres = |one: &&Signature| one.name.to_lowercase().contains("sph");
    let Some(signature) = all.iter().find(of_spheres).or(all.first()) else {
        return Ok(Vec::new());
    };
    let Some(body) = body(text, checked, &signature.name) else {
        return Ok(Vec::new());
    };
    let asked = paint::checked(&subject(text, signature, options.clone()))?;
    let program = Program::prepared(&asked, Variant::Plain).map_err(eval::Failure::from)?;
    let asked = Asked {
        program: &program,
        signature,
    };
    let Some(new) = asked.body()? else {
        return Ok(Vec::new());
    };
    let made = FORMULAS.iter().map(|formula| {
        let (function, helper) = (own_name(formula.function()), own_name("powerOfTwo"));
        let words = formula
            .text
            .replace(formula.function(), &function)
            .replace("powerOfTwo", &helper);
        let (before, after) = (&text[..body.start], &text[body.end..]);
        let new = new.replace("FORMULA", &function);
        (formula.name, format!("{words}\n{before}{new}{after}"))
    });
    Ok(made.collect())
}

/// A name that no author uses.
fn own_name(name: &str) -> String {
    format!("toyproof_{name}")
}

impl Asked<'_> {
    /// The body that calls `FORMULA` and answers as the function does; none where that is not simple.
    fn body(&self) -> Result<Option<String>, Failure> {
        let answers: Answers = self.answers::<f32>()?;
        let path = |role: Role| {
            let mut inputs = self.signature.inputs.iter();
            inputs
                .find(|(_, found)| *found == role)
                .map(|(path, _)| path.clone())
        };
        let returns_t = matches!(&self.signature.outputs[..], [(path, Role::T, ty)] if path == "return" && *ty == glsl::tree::Type::FLOAT);
        let miss = match answers.positive_miss() {
            Some(miss) => format!("{:?}", miss as f32),
            None if answers.behind_is_miss() => "-1.0".to_owned(),
            None => return Ok(None),
        };
        let (Some(o), Some(d), true) = (path(Role::Origin), path(Role::Direction), returns_t) else {
            return Ok(None);
        };
        let (c, r) = match (path(Role::Center), path(Role::Radius), path(Role::Sphere)) {
            (_, _, Some(sphere)) => (format!("{sphere}.xyz"), format!("{sphere}.w")),
            (Some(c), Some(r), _) => (c, r),
            _ => return Ok(None),
        };
        let t_min = match path(Role::TMin) {
            Some(path) => path,
            None => format!("{:?}", self.smallest_t(&answers)? as f32),
        };
        let miss = if miss.contains(['.', 'e']) {
            miss
        } else {
            miss + ".0"
        };
        Ok(Some(format!(
            "{{\n    float toyproof_t = FORMULA({o}, {d}, {c}, {r}, {t_min});\n    \
             return toyproof_t > {t_min} ? toyproof_t : {miss};\n}}"
        )))
    }

    /// What t must be larger than to count, of 0 and 1, 2 and 5 times the powers of ten.
    fn smallest_t(&self, answers: &Answers) -> Result<f64, Failure> {
        let decades = (1..=9).rev().map(|decade| 10f64.powi(-decade));
        let steps: Vec<f64> = decades
            .flat_map(|ten| [1.0, 2.0, 5.0].map(|step| step * ten))
            .collect();
        // A sphere so small that where it begins can be told to nine digits.
        let r = 2f64.powi(-10);
        let shots: Vec<Shot> = steps
            .iter()
            .map(|step| Shot {
                o: [0.0; 3],
                d: [0.0, 0.0, -1.0],
                c: [0.0, 0.0, -(r + 1.01 * step) as f32],
                r: r as f32,
            })
            .collect();
        let told = self.ask::<f64>(&shots, answers)?;
        let counts = |(step, told): (&f64, &Outcome)| matches!(told, Outcome::Hit(t) if (t - 1.01 * step).abs() < 0.01 * step);
        let first = steps.iter().zip(&told).position(counts);
        Ok(match first {
            Some(0) | None => 0.0,
            Some(at) => steps[at],
        })
    }
}

/// Where the body of a function stands, braces included.
fn body(text: &str, checked: &Checked, name: &str) -> Option<Range<usize>> {
    let functions = checked.tree.functions.iter();
    let mut named = functions.filter(|(_, function)| function.name == name && function.body.is_some());
    let (Some((_, function)), None) = (named.next(), named.next()) else {
        return None;
    };
    let start = function.at.span.start as usize;
    let (mut depth, mut begin) = (0usize, None);
    let mut rest = text.get(start..)?.char_indices();
    while let Some((at, letter)) = rest.next() {
        let after = &text[start + at..];
        let comment = ["//", "/*"].into_iter().zip(["\n", "*/"]);
        if let Some((_, end)) = comment.into_iter().find(|(begin, _)| after.starts_with(begin)) {
            let length = after[2..].find(end)? + 2 + end.len();
            let next = start + at + length;
            while rest.clone().next().is_some_and(|(at, _)| start + at < next) {
                rest.next();
            }
            continue;
        }
        match letter {
            '{' => {
                begin.get_or_insert(start + at);
                depth += 1;
            }
            '}' => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(begin?..start + at + 1);
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{File, Files};

    fn checked(text: &str) -> Checked {
        let mut files = Files::default();
        let file = files.add(File::new("t", text));
        glsl::check(&files, file, &glsl::Options::default())
            .unwrap_or_else(|errors| panic!("{errors:?}\n{text}"))
    }

    #[test]
    fn each_formula_takes_the_place_of_the_rungs_own() {
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

    #[test]
    fn a_body_ends_where_its_brace_closes_and_comments_do_not_count() {
        let text = "float f(float x) { // }\n if (x > 0.) { return 1.; } /* } */ return 2.; }\n\
                    void mainImage(out vec4 c, in vec2 p) { c = vec4(f(p.x)); }";
        let body = body(text, &checked(text), "f").unwrap();
        assert!(text[body].ends_with("return 2.; }"));
    }
}
