//! The parameters that the user names, with the values to try: `MAX_STEPS=16..256`, `23=8,16,32`.

use std::str::FromStr;

use toyproof_diagnostic::{Span, all_of, nearest};
use toyproof_glsl::tree::{ExprKind, Literal, Place as TreePlace, Value};

use super::find::LINE;
use super::{Parameter, Role, Scope, proposals};

/// The number of values between the ends of a range, both included.
const RANGE_VALUES: usize = 6;

/// The ratio of the ends from which the values of a range grow by factors.
const MIN_GEOMETRIC_RATIO: f64 = 4.0;

/// The most values of a list.
const MAX_VALUES: usize = 64;

/// A parameter that the user names, and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Vary {
    /// The name of a constant, a macro or a uniform, or a line.
    name: String,
    values: Values,
}

#[derive(Debug, Clone, PartialEq)]
enum Values {
    /// Both ends, the smaller one first.
    Range(f64, f64),
    List(Vec<f64>),
}

/// What is wrong with the text of a [`Vary`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected NAME=LOW..HIGH or NAME=A,B,…, such as MAX_STEPS=16..256")]
pub struct VaryParseError;

impl FromStr for Vary {
    type Err = VaryParseError;

    fn from_str(text: &str) -> Result<Self, VaryParseError> {
        let number = |text: &str| {
            let value: f64 = text.trim().parse().map_err(|_| VaryParseError)?;
            if value.is_finite() {
                Ok(value)
            } else {
                Err(VaryParseError)
            }
        };
        let (name, values) = text.split_once('=').ok_or(VaryParseError)?;
        let name = name.trim();
        let values = match values.split_once("..") {
            Some((low, high)) => {
                let (low, high) = (number(low)?, number(high)?);
                Values::Range(low.min(high), low.max(high))
            }
            None => Values::List(values.split(',').map(number).collect::<Result<_, _>>()?),
        };
        let is_short = !matches!(&values, Values::List(values) if values.len() > MAX_VALUES);
        if name.is_empty() || !is_short {
            return Err(VaryParseError);
        }
        Ok(Self {
            name: name.to_owned(),
            values,
        })
    }
}

/// Why a parameter cannot be varied.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum VaryError {
    /// Nothing has this name.
    #[error(
        "the shader has no constant, macro, uniform or line with a number that is named `{name}`{}",
        hint(near.as_deref())
    )]
    Unknown {
        /// The name.
        name: String,
        /// The most similar name.
        near: Option<String>,
    },
    /// Several numbers are in a line.
    #[error(
        "line {line} has several numbers: {}; give the one to vary a name",
        all_of(numbers)
    )]
    Several {
        /// The line, from 1.
        line: usize,
        /// The numbers as they are written.
        numbers: Vec<String>,
    },
}

fn hint(near: Option<&str>) -> String {
    near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

impl Vary {
    /// The parameter with its values, without the shader's own.
    pub(in crate::trade) fn resolve(&self, scopes: &[Scope<'_>]) -> Result<(Parameter, Vec<f64>), VaryError> {
        let parameter = self.parameter(scopes)?;
        let mut values: Vec<f64> = match &self.values {
            Values::List(values) => values.clone(),
            &Values::Range(low, high) => range(low, high),
        };
        if parameter.is_integer() {
            values = values.into_iter().map(f64::round).collect();
        }
        values.dedup();
        values.retain(|&value| value != parameter.value);
        Ok((parameter, values))
    }

    fn parameter(&self, scopes: &[Scope<'_>]) -> Result<Parameter, VaryError> {
        let resolution = Parameter::resolution();
        if self.name == resolution.name {
            return Ok(resolution);
        }
        let mut named: Vec<Parameter> = scopes.iter().flat_map(Scope::named).collect();
        let line = self.name.trim_start_matches(LINE).parse::<usize>().ok();
        let name = line.map_or_else(|| self.name.clone(), |line| format!("{LINE}{line}"));
        // What a loop uses has a role, by which the reference has more accurate values.
        let is_named = |parameter: &Parameter| {
            parameter.name == name || line.is_some() && parameter.name.ends_with(&format!(" in {name}"))
        };
        if let Some(parameter) = proposals(scopes).into_iter().find(is_named) {
            return Ok(parameter);
        }
        if let Some(line) = line {
            let mut on_line: Vec<Parameter> = scopes.iter().flat_map(|scope| scope.on_line(&name)).collect();
            on_line.dedup_by(|a, b| a.place == b.place);
            return match on_line.len() {
                1 => Ok(on_line.remove(0)),
                0 => Err(VaryError::Unknown { name, near: None }),
                _ => Err(VaryError::Several {
                    line,
                    numbers: on_line.iter().map(|number| super::shown(number.value)).collect(),
                }),
            };
        }
        match named.iter().position(|parameter| parameter.name == name) {
            Some(at) => Ok(named.swap_remove(at)),
            None => Err(VaryError::Unknown {
                near: nearest(&name, named.iter().map(|parameter| &*parameter.name)).map(str::to_owned),
                name,
            }),
        }
    }
}

impl Scope<'_> {
    /// The numbers that have a name: variables that never change, and macros.
    fn named(&self) -> Vec<Parameter> {
        let tree = self.tree();
        let variables = tree.variables.ids().filter_map(|variable| {
            let number = self.variable(variable)?;
            let name = tree[variable].name.clone();
            Some(Parameter { name, ..number })
        });
        variables.chain(self.macros()).collect()
    }

    /// The macros that are numbers.
    fn macros(&self) -> impl Iterator<Item = Parameter> {
        let definitions = self.checked.expansions.definitions().iter();
        definitions.filter_map(|definition| {
            let extent = definition.extent;
            let text = self.files.text(extent);
            let replacement = text[(definition.at.end - definition.at.start) as usize..].trim();
            let value = literal(replacement)?;
            let start = extent.end - replacement.len() as u32;
            let span = Span::new(extent.file, start, extent.end);
            let parameter = self.literal(&Literal::new(replacement, value), TreePlace::plain(span))?;
            Some(Parameter {
                name: definition.name.clone(),
                role: Role::Constant,
                ..parameter
            })
        })
    }

    /// The literals of a line.
    fn on_line(&self, name: &str) -> Vec<Parameter> {
        let tree = self.tree();
        let literals = tree
            .exprs
            .iter()
            .filter(|(_, expr)| matches!(expr.kind, ExprKind::Literal(_)));
        let numbers = literals.filter_map(|(id, _)| self.number(id));
        numbers.filter(|number| number.name == name).collect()
    }
}

/// The value of a text that is one literal.
fn literal(text: &str) -> Option<Value> {
    let unsigned = text.strip_suffix(['u', 'U']);
    if let Some(value) = unsigned.and_then(|text| text.parse().ok()) {
        return Some(Value::Uint(value));
    }
    if let Ok(value) = text.parse() {
        return Some(Value::Int(value));
    }
    let is_number = text.starts_with(|first: char| first.is_ascii_digit() || first == '.');
    let float = text.trim_end_matches(['f', 'F']);
    float.parse().ok().filter(|_| is_number).map(Value::Float)
}

/// The values of a range: in equal factors if it is wide, else in equal steps.
fn range(low: f64, high: f64) -> Vec<f64> {
    let is_geometric = low > 0.0 && high / low >= MIN_GEOMETRIC_RATIO;
    let value = |at: usize| {
        let part = at as f64 / (RANGE_VALUES - 1) as f64;
        let value = if is_geometric {
            low * (high / low).powf(part)
        } else {
            low + (high - low) * part
        };
        super::in_steps(value, false)
    };
    (0..RANGE_VALUES).map(value).collect()
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::Options;

    use super::*;

    const TEXT: &str = "\
#define STEPS 100
const float FAR = 20.0;
float epsilon = 0.001;
void mainImage(out vec4 c, in vec2 p) {
    float t = 0.0;
    for (int i = 0; i < STEPS; i++) {
        float d = p.x + t;
        if (d < epsilon || t > FAR) break;
        t += 0.5 * d;
    }
    for (int i = 0; i < 8; i++) t += 1.0;
    for (float x = 0.0; x < 4.0; x += 0.25) t += x;
    for (int n = 5; n > 0; n--) t += 2.0;
    c = vec4(t);
}
";

    fn with_scope<T>(text: &str, use_scope: impl FnOnce(&[Scope<'_>]) -> T) -> T {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let checked = toyproof_glsl::check(&files, file, &Options::default()).unwrap();
        use_scope(&[Scope::new(&checked, &files, true)])
    }

    fn resolve(text: &str) -> Result<(String, Role, Vec<f64>), VaryError> {
        let vary: Vary = text.parse().unwrap();
        let resolved = with_scope(TEXT, |scopes| vary.resolve(scopes));
        resolved.map(|(parameter, values)| (parameter.name, parameter.role, values))
    }

    #[test]
    fn loops_have_limits_steps_and_thresholds() {
        let found = with_scope(TEXT, super::super::proposals);
        let found: Vec<_> = found
            .iter()
            .map(|one| (&*one.name, one.role, one.value))
            .collect();
        assert_eq!(
            found,
            [
                ("STEPS", Role::Count, 100.0),
                ("epsilon", Role::Threshold, 0.001),
                ("FAR", Role::Extent, 20.0),
                ("step in line 9", Role::Step, 0.5),
                ("line 11", Role::Count, 8.0),
                ("limit in line 12", Role::Extent, 4.0),
                ("step in line 12", Role::Step, 0.25),
                ("factor of the step in line 12", Role::Relaxation, 1.0),
                ("line 13", Role::Count, 5.0),
            ]
        );
    }

    #[test]
    fn parameters_are_named_by_their_constant_or_line() {
        let found = resolve("STEPS=16..256").unwrap();
        assert_eq!(
            found,
            (
                "STEPS".to_owned(),
                Role::Count,
                vec![16.0, 28.0, 49.0, 84.0, 147.0, 256.0]
            )
        );
        let found = resolve("11=2,4,8").unwrap();
        assert_eq!(found, ("line 11".to_owned(), Role::Count, vec![2.0, 4.0]));
        assert_eq!(resolve("12=2").unwrap().0, "limit in line 12");
        assert_eq!(resolve("step in line 12=0.5").unwrap().1, Role::Step);
        let found = resolve("FAR=10..15").unwrap();
        assert_eq!(
            (found.1, found.2),
            (Role::Extent, vec![10.0, 11.0, 12.0, 13.0, 14.0, 15.0])
        );
        let error = resolve("STEP=1..2").unwrap_err();
        assert!(error.to_string().ends_with("did you mean `STEPS`?"), "{error}");
        for invalid in ["", "A", "=1", "A=", "A=1..", "A=inf", "A=1,,2"] {
            assert_eq!(invalid.parse::<Vary>(), Err(VaryParseError), "{invalid}");
        }
    }
}
