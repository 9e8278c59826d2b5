//! Checks an assertion: its expressions are evaluated for sampled values of its variables, and compared.

use toyproof_diagnostic::{Code, Diagnostic, File, Files, Span, grouped};
use toyproof_glsl::tree::{Scalar, StatementKind, Tree, Type};
use toyproof_glsl::{self as glsl, Checked};

use super::assertion::{Assertion, Comparison, Relation, Set, Side, Variable};
use super::evaluation::{Evaluation, Values};
use super::source::GeneratedText;
use super::value::{Component, agrees, components, margin, numbers};
use super::{DEFAULT_TOLERANCE, Precision, Run, Snippet, Subject, TestError};

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

/// An assertion about a shader.
struct SampledTest<'a> {
    assertion: &'a Assertion,
    after: Option<&'a Snippet>,
    subject: &'a Subject<'a>,
}

/// The types of the expressions.
struct Typed {
    checked: Checked,
    left: Vec<Component>,
    /// The compared values: one for [`Relation::Compare`], two for [`Relation::Within`].
    right: Vec<Vec<Component>>,
    types: Vec<Type>,
    variables: Vec<Vec<Component>>,
    /// The types of the variables, as they are written.
    variable_types: Vec<String>,
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
    fn error(&self, at: Span, message: impl Into<String>, help: &str) -> TestError {
        TestError::Test(vec![Diagnostic::new(Code::TestValue, message).at(at).help(help)])
    }

    /// Adds what is evaluated before the test.
    fn push_after(&self, text: &mut GeneratedText) {
        for after in self.after.into_iter().chain(&self.assertion.after) {
            text.push("    ");
            text.push_snippet(after);
            text.push(";\n");
        }
    }

    /// The compared expressions beside the first: the right side, or the ends of the range.
    fn others(&self) -> Vec<&Snippet> {
        match &self.assertion.relation {
            Relation::Compare(_, right) => vec![&right.expression],
            Relation::Within(low, high) => vec![low, high],
            Relation::Holds | Relation::Increases | Relation::Decreases => Vec::new(),
        }
    }

    /// Checks the expressions, and returns their types.
    fn typed(&self) -> Result<Typed, TestError> {
        let assertion = self.assertion;
        let written = |variable: &Variable| match &variable.ty {
            Some(ty) => ty.text().to_owned(),
            None => self.type_of(variable.name.text()),
        };
        let variable_types: Vec<_> = assertion.variables.iter().map(written).collect();
        let mut text = GeneratedText::default();
        text.push("void tpTyped() {\n");
        let mut ends = Vec::new();
        for variable in &assertion.variables {
            match &variable.set {
                Set::Interval(low, high) => ends.extend([low, high]),
                Set::List(values) => ends.extend(values),
            }
        }
        for (variable, ty) in assertion.variables.iter().zip(&variable_types) {
            text.push("    ");
            match &variable.ty {
                Some(ty) => text.push_snippet(ty),
                None => text.push(ty),
            }
            text.push(" ");
            text.push_snippet(&variable.name);
            text.push(";\n");
        }
        let compared = [&assertion.left.expression].into_iter().chain(self.others());
        let typed: Vec<_> = ends.iter().copied().chain(compared).collect();
        for snippet in &typed {
            text.push("    (");
            text.push_snippet(snippet);
            text.push(");\n");
        }
        self.push_after(&mut text);
        text.push(
            "}\nvoid mainImage(out vec4 tpColor, in vec2 tpPlace) { tpTyped(); tpColor = vec4(0.0); }\n",
        );
        let text = text.after_shader(self.subject);
        let mut files = Files::default();
        let file = files.add(File::new("<test>", text.text()));
        let checked = glsl::check(&files, file, &self.subject.options())
            .map_err(|found| TestError::Test(text.diagnostics(found.into(), assertion.at())))?;
        let types = statement_types(&checked.tree, typed.len());
        let (of_ends, of_sides) = types.split_at(ends.len().min(types.len()));
        let mut of_ends = of_ends.iter().copied();
        let mut variables = Vec::new();
        for (index, variable) in assertion.variables.iter().enumerate() {
            variables.push(self.variable(&checked, index, variable, &mut of_ends)?);
        }
        let tree = &checked.tree;
        let others = self.others();
        let snippets = [&assertion.left.expression]
            .into_iter()
            .chain(others.iter().copied());
        let mut sides = Vec::new();
        for ((index, snippet), &ty) in snippets.enumerate().zip(of_sides) {
            let path = side_name(index);
            let is_length = self.side(index).is_some_and(|side| side.is_length);
            let found = if is_length {
                let has_length = ty == Type::FLOAT || matches!(ty, Type::Vector(Scalar::Float, _));
                has_length.then(|| components(tree, Type::FLOAT, &path)).flatten()
            } else {
                components(tree, ty, &path)
            };
            let Some(found) = found.filter(|found| !found.is_empty()) else {
                let name = tree.type_name(ty);
                let message = if is_length {
                    format!("bars are the length of a vector, found `{name}`")
                } else {
                    format!("a value of type `{name}` cannot be compared")
                };
                let help = "compare numbers, vectors, matrices, structures or arrays of up to 256 elements";
                return Err(self.error(snippet.at(), message, help));
            };
            sides.push((found, if is_length { Type::FLOAT } else { ty }));
        }
        if sides.len() != 1 + others.len() {
            return Err(self.error(assertion.at(), "the test cannot be checked", ""));
        }
        self.check_sides(tree, &sides)?;
        let (mut sides, types): (Vec<_>, Vec<_>) = sides.into_iter().unzip();
        let right = sides.split_off(1);
        Ok(Typed {
            left: sides.remove(0),
            right,
            types,
            variables,
            variable_types,
            checked,
        })
    }

    /// The side with this number.
    fn side(&self, index: usize) -> Option<&Side> {
        match (index, &self.assertion.relation) {
            (0, _) => Some(&self.assertion.left),
            (1, Relation::Compare(_, right)) => Some(right),
            _ => None,
        }
    }

    /// The type of a variable that is passed to a function; `float` if it is not.
    fn type_of(&self, name: &str) -> String {
        let sides = [&self.assertion.left.expression].into_iter().chain(self.others());
        let tree = &self.subject.checked.tree;
        for side in sides {
            for (function, position, count) in argument_places(side.text(), name) {
                let mut types = self
                    .subject
                    .functions(function)
                    .filter(|function| function.parameters.len() == count)
                    .map(|function| tree[function.parameters[position]].ty);
                if let Some(first) = types.next()
                    && types.all(|ty| ty == first)
                {
                    return tree.type_name(first);
                }
            }
        }
        "float".to_owned()
    }

    /// The components of a variable, whose values must be of its type.
    fn variable(
        &self,
        checked: &Checked,
        index: usize,
        variable: &Variable,
        of_values: &mut impl Iterator<Item = Type>,
    ) -> Result<Vec<Component>, TestError> {
        let tree = &checked.tree;
        let name = variable.name.text();
        let declared = tree
            .functions
            .iter()
            .find(|(_, function)| function.name == "tpTyped");
        let body = declared.and_then(|(_, function)| function.body.as_ref());
        let mut declared = body
            .into_iter()
            .flatten()
            .filter_map(|statement| match statement.kind {
                StatementKind::Declare(id) => Some(tree[id].ty),
                _ => None,
            });
        let ty = declared.nth(index).unwrap_or(Type::Error);
        let type_name = tree.type_name(ty);
        let (values, is_interval): (Vec<_>, _) = match &variable.set {
            Set::Interval(low, high) => (vec![low, high], true),
            Set::List(values) => (values.iter().collect(), false),
        };
        let is_numeric = match ty {
            Type::Scalar(scalar) | Type::Vector(scalar, _) => scalar != Scalar::Bool,
            _ => false,
        };
        if is_interval && !is_numeric {
            return Err(self.error(
                variable.name.at(),
                format!("`{name}` of type `{type_name}` has no interval"),
                "list its values: `for ray in {Ray(vec3(0.0), vec3(0.0, 0.0, -1.0))}`; the type is that of \
                 the parameter for which it is passed, or the one before its name",
            ));
        }
        for value in values {
            let found = of_values.next().unwrap_or(Type::Error);
            let is_scalar = matches!(found, Type::Scalar(scalar) if scalar != Scalar::Bool);
            let converts = is_scalar && is_numeric && (is_interval || matches!(ty, Type::Scalar(_)));
            if found != ty && !converts {
                return Err(self.error(
                    value.at(),
                    format!(
                        "`{name}` is of type `{type_name}`, and this value of type `{}`",
                        tree.type_name(found)
                    ),
                    "write the type of the variable before its name: `for vec3 p in …`; without one, it is that \
                     of the parameter for which the variable is passed",
                ));
            }
        }
        components(tree, ty, name)
            .ok_or_else(|| self.error(variable.name.at(), format!("`{name}` has no values"), ""))
    }

    /// Checks that the sides can be compared.
    fn check_sides(&self, tree: &Tree, sides: &[(Vec<Component>, Type)]) -> Result<(), TestError> {
        let assertion = self.assertion;
        let (left, left_type) = &sides[0];
        let left_name = tree.type_name(*left_type);
        let left_at = assertion.left.expression.at();
        let is_vector = |ty: Type| matches!(ty, Type::Scalar(_) | Type::Vector(..) | Type::Matrix { .. });
        let is_ordered = |ty: Type| is_vector(ty) && ty.scalar() != Some(Scalar::Bool);
        match &assertion.relation {
            Relation::Holds if *left_type != Type::BOOL => {
                return Err(self.error(
                    left_at,
                    format!("the test compares nothing: its expression is of type `{left_name}`"),
                    "add a comparison, such as `== 2.0`",
                ));
            }
            Relation::Increases | Relation::Decreases if left.len() != 1 || !is_ordered(*left_type) => {
                let message = format!("only a number is increasing or decreasing, found `{left_name}`");
                return Err(self.error(
                    left_at,
                    message,
                    "test each component: `f(x).x is increasing for …`",
                ));
            }
            Relation::Compare(Comparison::Equal | Comparison::Unequal, _) | Relation::Holds => {}
            _ if !is_ordered(*left_type) => {
                let message = format!("values of type `{left_name}` have no order");
                return Err(self.error(left_at, message, "compare numbers or vectors"));
            }
            _ => {}
        }
        for (other, (_, ty)) in self.others().into_iter().zip(&sides[1..]) {
            // A number stands for all components.
            let fits = |from: Type, from_text: &Snippet, to: Type| {
                let is_integer = from_text
                    .text()
                    .trim_start_matches(['-', '+'])
                    .bytes()
                    .all(|b| b.is_ascii_digit());
                let same_scalar =
                    from.scalar() == to.scalar() || (is_integer && to.scalar() != Some(Scalar::Bool));
                matches!(from, Type::Scalar(_)) && is_vector(to) && same_scalar
            };
            let left_text = &assertion.left.expression;
            if ty != left_type && !fits(*ty, other, *left_type) && !fits(*left_type, left_text, *ty) {
                return Err(self.error(
                    other.at(),
                    format!(
                        "a value of type `{left_name}` is compared with one of type `{}`",
                        tree.type_name(*ty)
                    ),
                    "compare values of the same type, or a vector with a number for all of its components",
                ));
            }
        }
        Ok(())
    }

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
            return Err(self.error(self.assertion.at(), message, "write several tests"));
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
                !(fall <= margin(before, tolerance))
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
                message += &format!(" (wrong for {wrong} of {all} values)");
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

/// The variable with the value of a side.
fn side_name(index: usize) -> String {
    format!("tpSide{index}")
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

/// The types of the first expressions that are statements of `tpTyped`.
fn statement_types(tree: &Tree, count: usize) -> Vec<Type> {
    let function = tree
        .functions
        .iter()
        .find(|(_, function)| function.name == "tpTyped");
    let body = function.and_then(|(_, function)| function.body.as_ref());
    let types = body
        .into_iter()
        .flatten()
        .filter_map(|statement| match statement.kind {
            StatementKind::Expression(id) => Some(tree[id].ty),
            _ => None,
        });
    types.take(count).collect()
}

/// The calls in an expression that have a name as an argument: the function, the position of the argument,
/// and the number of arguments.
fn argument_places<'t>(text: &'t str, name: &str) -> Vec<(&'t str, usize, usize)> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut places = Vec::new();
    for (open, _) in text.match_indices('(') {
        let before = text[..open].trim_end();
        let start = before.rfind(|c| !is_word(c)).map_or(0, |at| at + 1);
        let function = &before[start..];
        if function.is_empty() {
            continue;
        }
        let mut arguments = Vec::new();
        let (mut depth, mut from) = (0, open + 1);
        for (at, c) in text[open..].char_indices() {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth -= 1,
                _ => {}
            }
            if (c == ',' && depth == 1) || depth == 0 {
                arguments.push(text[from..open + at].trim());
                from = open + at + 1;
            }
            if depth == 0 {
                break;
            }
        }
        let found = arguments
            .iter()
            .enumerate()
            .filter(|(_, argument)| **argument == name);
        places.extend(found.map(|(position, _)| (function, position, arguments.len())));
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_calls_with_a_variable_are_found() {
        let found = argument_places("f(p, g(vec2(p), q)) + h ( -p ) + k(p)", "p");
        assert_eq!(found, [("f", 0, 2), ("vec2", 0, 1), ("k", 0, 1)]);
        assert_eq!(argument_places("f(g(a, b), q)", "q"), [("f", 1, 2)]);
    }
}
