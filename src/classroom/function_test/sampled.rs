//! Checks an assertion: its expressions are evaluated for sampled values of its variables, and compared.

use toyproof_diagnostic::grouped;
use toyproof_glsl::tree::Scalar;

use super::assertion::{Assertion, Comparison, Relation, Set};
use super::evaluation::{Evaluation, Values};
use super::result::{Run, TestError};
use super::source::{GeneratedText, Snippet};
use super::subject::Subject;
use super::test::{DEFAULT_TOLERANCE, Precision};
use super::typed::{SampledTest, Typed, side_name};
use super::value::{Component, agrees, margin, numbers};

/// The number of values of variables in intervals; of a single component there is one more, so that the
/// intervals between them are exact in f32.
const SAMPLES: usize = 256;

/// The largest number of combinations of listed values; together with sampled ones, a 64th.
const MAX_COMBINATIONS: usize = 4096;

/// Functions that the generated statements call. The numbers have 16 bits, so that they are the same in f32
/// and f64. The hash is PCG (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
const DECLARATIONS: &str = "\
float tpLength(float v) { return abs(v); }
float tpLength(vec2 v) { return length(v); }
float tpLength(vec3 v) { return length(v); }
float tpLength(vec4 v) { return length(v); }
uint tpHash(int v) {
    uint s = uint(v) * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}
// The first samples are the corners; of many components, two of them.
float tpSampled(int number, int component, int count) {
    if (count > 4 && number < 2) return float(number);
    if (count <= 4 && number < (1 << count)) return float((number >> component) & 1);
    return float(tpHash(number * count + component) >> 16u) / 65536.0;
}
// In order, one in each of 256 intervals.
float tpOrdered(int number) {
    if (number == 0 || number == 256) return float(number) / 256.0;
    return float(number * 256 + int(tpHash(number) >> 24u)) / 65536.0;
}
";

/// Evaluates an assertion. `after`: what is evaluated before each of the tests of the function.
pub(super) fn check(
    assertion: &Assertion,
    after: Option<&Snippet>,
    subject: &Subject,
    precision: Precision,
) -> Result<Vec<Run>, TestError> {
    let test = SampledTest {
        assertion,
        after,
        subject,
    };
    let typed = test.typed()?;
    let sampling = test.sampling(&typed)?;
    let evaluation = test.evaluation(&typed, &sampling);
    let all = evaluation.evaluate(subject, precision, Some(assertion.at()))?;
    Ok(all.iter().map(|values| test.run(&typed, values)).collect())
}

/// How the variables are sampled.
struct Sampling {
    /// The combinations of listed values.
    combinations: usize,
    /// The components of variables in intervals.
    sampled: usize,
    cases: usize,
}

impl SampledTest<'_> {
    fn sampling(&self, typed: &Typed) -> Result<Sampling, TestError> {
        let mut combinations = 1_usize;
        let mut sampled = 0;
        for (variable, components) in self.assertion.variables.iter().zip(&typed.variables) {
            match &variable.set {
                Set::Interval(..) => sampled += components.len(),
                Set::List(values) => combinations = combinations.saturating_mul(values.len()),
            }
        }
        let samples = match sampled {
            0 => 1,
            1 => SAMPLES + 1,
            _ => SAMPLES,
        };
        let limit = if sampled == 0 {
            MAX_COMBINATIONS
        } else {
            MAX_COMBINATIONS / 64
        };
        if combinations > limit {
            let message = format!(
                "the lists of values have {} combinations; a test has at most {limit}",
                grouped(combinations as u64)
            );
            return Err(Self::error(self.assertion.at(), message, "write several tests"));
        }
        Ok(Sampling {
            combinations,
            sampled,
            cases: combinations * samples,
        })
    }

    /// The statements that give the variables their values, and evaluate the expressions.
    fn evaluation(&self, typed: &Typed, sampling: &Sampling) -> Evaluation {
        let tree = &typed.checked.tree;
        let mut text = GeneratedText::default();
        text.push(&format!(
            "    int tpSample = tpCase / {0};\n    int tpCombination = tpCase - {0} * tpSample;\n",
            sampling.combinations
        ));
        let mut first_component = 0;
        let mut stride = 1;
        let variables = self.assertion.variables.iter().zip(&typed.variables);
        for (index, (variable, components)) in variables.enumerate() {
            let ty = &typed.variable_types[index];
            match &variable.set {
                Set::Interval(low, high) => {
                    interval(&mut text, index, ty, [low, high]);
                    let sampled = (0..components.len()).map(|component| match sampling.sampled {
                        1 => "tpOrdered(tpSample)".to_owned(),
                        count => format!("tpSampled(tpSample, {}, {count})", first_component + component),
                    });
                    let sampled: Vec<_> = sampled.collect();
                    text.push(&sample(
                        variable.name.text(),
                        index,
                        ty,
                        components,
                        &sampled.join(", "),
                    ));
                    first_component += components.len();
                }
                Set::List(values) => {
                    text.push(&format!("    {ty} {};\n", variable.name.text()));
                    for (at, value) in values.iter().enumerate() {
                        text.push(&format!(
                            "    if (tpCombination / {stride} % {} == {at}) {} = ",
                            values.len(),
                            variable.name.text()
                        ));
                        // Only numbers are converted, such as `1` to a float.
                        let is_scalar = components.len() == 1 && components[0].path == variable.name.text();
                        text.push(&if is_scalar {
                            format!("{ty}(")
                        } else {
                            "(".to_owned()
                        });
                        text.push_snippet(value);
                        text.push(");\n");
                    }
                    stride *= values.len();
                }
            }
        }
        self.push_after(&mut text);
        let snippets = [&self.assertion.left.expression].into_iter().chain(self.others());
        for ((index, snippet), ty) in snippets.enumerate().zip(&typed.types) {
            let is_length = self.side(index).is_some_and(|side| side.is_length);
            let call = if is_length { "tpLength(" } else { "(" };
            text.push(&format!(
                "    {} {} = {call}",
                tree.type_name(*ty),
                side_name(index)
            ));
            text.push_snippet(snippet);
            text.push(");\n");
        }
        let sides = [&typed.left].into_iter().chain(&typed.right);
        let mut declarations = GeneratedText::default();
        declarations.push(DECLARATIONS);
        Evaluation {
            declarations,
            statements: text,
            components: sides.chain(&typed.variables).flatten().cloned().collect(),
            cases: sampling.cases,
        }
    }

    // Results.

    /// Compares the values of all cases.
    fn run(&self, typed: &Typed, values: &Values) -> Run {
        let cases: Vec<Sample> = values
            .cases
            .iter()
            .map(|values| Sample::new(typed, values))
            .collect();
        let is_monotone = matches!(self.assertion.relation, Relation::Increases | Relation::Decreases);
        let wrong: Vec<usize> = if is_monotone {
            let rises = self.assertion.relation == Relation::Increases;
            let tolerance = self.assertion.tolerance.unwrap_or(0.0);
            let is_wrong = |pair: &[Sample]| {
                let (before, after) = (pair[0].left[0], pair[1].left[0]);
                let fall = if rises { before - after } else { after - before };
                // NaN neither rises nor falls.
                fall.is_nan() || fall > margin(before, tolerance)
            };
            let pairs = cases.windows(2).enumerate();
            pairs
                .filter(|(_, pair)| is_wrong(pair))
                .map(|(index, _)| index)
                .collect()
        } else {
            let indexed = cases.iter().enumerate();
            indexed
                .filter(|(_, case)| !self.holds(typed, case))
                .map(|(index, _)| index)
                .collect()
        };
        let message = wrong.first().map_or_else(String::new, |&first| {
            let mut message = match &cases[first..] {
                [case, next, ..] if is_monotone => self.describe_step(typed, case, next),
                [case, ..] => self.describe(typed, case),
                [] => String::new(),
            };
            if wrong.len() > 1 {
                let (wrong, all) = (grouped(wrong.len() as u64), grouped(cases.len() as u64));
                message = format!("{message} (wrong for {wrong} of {all} values)");
            }
            message
        });
        Run {
            is_single: values.is_single,
            samples: cases.len() as u64,
            wrong: wrong.len() as u64,
            message,
        }
    }

    /// Whether the relation holds in a case.
    fn holds(&self, typed: &Typed, case: &Sample) -> bool {
        let right = |side: usize, index: usize| {
            let values = case.right[side];
            if values.len() == 1 {
                values[0]
            } else {
                values[index]
            }
        };
        let tolerance = self.assertion.tolerance;
        let count = case
            .right
            .iter()
            .map(|values| values.len())
            .fold(case.left.len(), usize::max);
        let component = |index: usize| {
            let (left, scalar) = match case.left {
                [only] => (*only, typed.left[0].scalar),
                all => (all[index], typed.left[index].scalar),
            };
            // Integers are exact, unless a tolerance is given.
            let of_right = typed
                .right
                .first()
                .map(|side| side[index.min(side.len() - 1)].scalar);
            let is_float = [Some(scalar), of_right].contains(&Some(Scalar::Float));
            let of_equality = tolerance.unwrap_or(if is_float { DEFAULT_TOLERANCE } else { 0.0 });
            let of_order = tolerance.unwrap_or(0.0);
            match &self.assertion.relation {
                Relation::Holds => left != 0.0,
                Relation::Compare(comparison, _) => {
                    let right = right(0, index);
                    let slack = margin(right, of_order);
                    match comparison {
                        Comparison::Equal | Comparison::Unequal => agrees(left, right, of_equality),
                        Comparison::Less => left < right + slack,
                        Comparison::AtMost => left <= right + slack,
                        Comparison::Greater => left > right - slack,
                        Comparison::AtLeast => left >= right - slack,
                    }
                }
                Relation::Within(..) => {
                    let (low, high) = (right(0, index), right(1, index));
                    left >= low - margin(low, of_order) && left <= high + margin(high, of_order)
                }
                Relation::Increases | Relation::Decreases => true,
            }
        };
        let all = (0..count).all(component);
        match self.assertion.relation {
            Relation::Compare(Comparison::Unequal, _) => !all,
            _ => all,
        }
    }

    /// A wrong case in one sentence.
    fn describe(&self, typed: &Typed, case: &Sample) -> String {
        let left = &self.assertion.left.text;
        let found = values(case.left, &typed.left);
        let right = |side: usize| values(case.right[side], &typed.right[side]);
        let sentence = match &self.assertion.relation {
            Relation::Compare(Comparison::Equal, _) => format!("{left} is {found}, expected {}", right(0)),
            Relation::Compare(Comparison::Unequal, _) => {
                format!("{left} is {found}, expected another value than {}", right(0))
            }
            Relation::Compare(comparison, _) => {
                format!("{left} is {found}, expected {} {}", comparison.symbol(), right(0))
            }
            Relation::Within(..) => format!("{left} is {found}, expected from {} to {}", right(0), right(1)),
            Relation::Holds | Relation::Increases | Relation::Decreases => format!("{left} is {found}"),
        };
        sentence + &self.place(typed, case)
    }

    /// Two successive values in the wrong order, in one sentence.
    fn describe_step(&self, typed: &Typed, case: &Sample, next: &Sample) -> String {
        format!(
            "{} goes from {} to {}{}",
            self.assertion.left.text,
            values(case.left, &typed.left),
            values(next.left, &typed.left),
            self.place(typed, case)
        )
    }

    /// The values of the variables, for a message.
    fn place(&self, typed: &Typed, case: &Sample) -> String {
        let named = self
            .assertion
            .variables
            .iter()
            .zip(&typed.variables)
            .zip(&case.variables);
        let named = named.map(|((variable, components), found)| {
            format!("{} = {}", variable.name.text(), values(found, components))
        });
        let named: Vec<_> = named.collect();
        if named.is_empty() {
            String::new()
        } else {
            format!(" at {}", named.join(", "))
        }
    }
}

/// The values of one case.
struct Sample<'v> {
    left: &'v [f64],
    right: Vec<&'v [f64]>,
    variables: Vec<&'v [f64]>,
}

impl<'v> Sample<'v> {
    fn new(typed: &Typed, values: &'v [f64]) -> Self {
        let mut rest = values;
        let mut take = |components: &Vec<Component>| {
            let (taken, left) = rest.split_at(components.len());
            rest = left;
            taken
        };
        Self {
            left: take(&typed.left),
            right: typed.right.iter().map(&mut take).collect(),
            variables: typed.variables.iter().map(&mut take).collect(),
        }
    }
}

/// Components for a message.
fn values(found: &[f64], components: &[Component]) -> String {
    match (found, components) {
        ([value], [component]) => match component.scalar {
            Scalar::Bool => (*value != 0.0).to_string(),
            Scalar::Int | Scalar::Uint => value.to_string(),
            Scalar::Float => numbers(found),
        },
        _ => numbers(found),
    }
}

/// Declares the ends of an interval.
fn interval(text: &mut GeneratedText, index: usize, ty: &str, ends: [&Snippet; 2]) {
    for (name, end) in ["tpLow", "tpHigh"].into_iter().zip(ends) {
        text.push(&format!("    {ty} {name}{index} = {ty}("));
        text.push_snippet(end);
        text.push(");\n");
    }
}

/// Declares a variable with a value in its interval, at numbers from 0 to 1.
fn sample(name: &str, index: usize, ty: &str, components: &[Component], sampled: &str) -> String {
    let count = components.len();
    let float = if count == 1 {
        "float".to_owned()
    } else {
        format!("vec{count}")
    };
    let (low, high) = (format!("tpLow{index}"), format!("tpHigh{index}"));
    match components.first().map(|component| component.scalar) {
        Some(Scalar::Int | Scalar::Uint) => format!(
            "    {ty} {name} = min({low} + {ty}(floor({float}({high} - {low} + {ty}(1)) * {float}({sampled}))), {high});\n"
        ),
        _ => format!("    {ty} {name} = {low} + ({high} - {low}) * {float}({sampled});\n"),
    }
}
