//! Tests of single functions: a function is called with arguments, in f64, and its results are compared.

use std::fmt::Write as _;
use std::time::Duration;

use toyproof_diagnostic::{Files, plural};
use toyproof_glsl::tree::{Direction, Function, Scalar, Tree, Type, VariableKind};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_image::Frame;
use toyproof_report::FunctionRecord;
use toyproof_stress::function::{RoleMap, Signature, test_typical, with_main};
use toyproof_stress::{RunError, ShaderRunner};
use toyproof_toml::Literal;

/// The default of [`FunctionCase::tolerance`]: results in an assignment are written with a few digits.
pub const DEFAULT_CASE_TOLERANCE: f64 = 1e-4;

/// The largest array that is an argument or a result.
const MAX_ARRAY: u32 = 256;

/// The test of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionTest {
    /// The function's name.
    pub name: String,
    /// The points for a function that is right in all cases, ≥ 0.
    pub points: f64,
    /// The cases.
    pub cases: FunctionCases,
}

/// The cases of a test.
#[derive(Debug, Clone, PartialEq)]
pub enum FunctionCases {
    /// These, at least one.
    Listed(Vec<FunctionCase>),
    /// The rays and spheres of [`toyproof_stress`] of typical size, for a function that
    /// intersects a ray with a sphere, whatever its signature.
    Stress,
}

/// A call of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionCase {
    /// The values of the parameters that are not `out`. Lists represent vectors, matrices, arrays and
    /// structures.
    pub arguments: Vec<Literal>,
    /// The expected result, if it is compared.
    pub result: Option<Literal>,
    /// The expected values of the `out` and `inout` parameters, if they are compared.
    pub outputs: Option<Vec<Literal>>,
    /// The largest difference of a component from the expected value, relative to values above 1.
    pub tolerance: f64,
}

/// A shader whose functions are tested.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The files.
    pub files: &'a Files,
    /// The text.
    pub text: &'a str,
    /// Whether the language is lenient.
    pub lenient: bool,
    /// The time limit of a test.
    pub timeout: Duration,
}

impl Subject<'_> {
    fn options(&self) -> glsl::Options {
        glsl::Options {
            lenient: self.lenient,
            deadline: toyproof_diagnostic::Deadline::after(self.timeout),
            ..glsl::Options::default()
        }
    }

    /// The definitions of all functions of that name.
    fn functions<'s>(&'s self, name: &'s str) -> impl Iterator<Item = &'s Function> {
        let functions = self.checked.tree.functions.iter().map(|(_, function)| function);
        functions.filter(move |function| function.name == name && function.body.is_some())
    }
}

impl FunctionTest {
    /// The record of a shader that does not compile.
    #[must_use]
    pub fn untested(&self) -> FunctionRecord {
        FunctionRecord::untested(&self.name, self.points, "the shader does not compile")
    }

    /// Tests the function of a shader.
    #[must_use]
    pub fn run(&self, subject: &Subject) -> FunctionRecord {
        let outcome = match &self.cases {
            FunctionCases::Listed(cases) => self.run_listed(cases, subject),
            FunctionCases::Stress => self.run_typical(subject),
        };
        let at = subject.functions(&self.name).next();
        FunctionRecord {
            at: at.map(|function| subject.files.position(function.at.span).into()),
            ..outcome.unwrap_or_else(|why| FunctionRecord::untested(&self.name, self.points, why))
        }
    }

    fn run_listed(&self, cases: &[FunctionCase], subject: &Subject) -> Result<FunctionRecord, String> {
        let tree = &subject.checked.tree;
        let call = subject
            .functions(&self.name)
            .find_map(|function| Call::new(tree, function, cases))
            .ok_or_else(|| self.mismatch(cases, subject))?;
        let results = call.evaluate(cases, subject)?;
        let mut right = 0;
        let mut message = String::new();
        for (index, (case, actual)) in cases.iter().zip(&results).enumerate() {
            let expected = case.components();
            let is_same = |(actual, expected): (&f64, &f64)| agrees(*actual, *expected, case.tolerance);
            if actual.iter().zip(&expected).all(is_same) {
                right += 1;
            } else if message.is_empty() {
                let arguments: Vec<_> = case.arguments.iter().map(text).collect();
                message = format!(
                    "in case {}, {}({}) is {}, expected {}",
                    index + 1,
                    self.name,
                    arguments.join(", "),
                    numbers(actual),
                    numbers(&expected)
                );
            }
        }
        Ok(self.record(cases.len() as u64, right, message))
    }

    /// Tests a function that intersects a ray with a sphere.
    fn run_typical(&self, subject: &Subject) -> Result<FunctionRecord, String> {
        let signature = Signature::recognize(subject.checked, &self.name, &RoleMap::new());
        let signature = signature.map_err(|why| why.to_string())?;
        let tested = test_typical(subject.text, &signature, &subject.options(), subject.timeout);
        let tested = tested.map_err(|error| not_run(&error))?;
        let message = match tested.mistake {
            Some(mistake) => format!("it {}", mistake.description),
            None => "none of the known mistakes explains it".to_owned(),
        };
        let right = tested.right == tested.cases;
        Ok(self.record(
            tested.cases,
            tested.right,
            if right { String::new() } else { message },
        ))
    }

    fn record(&self, cases: u64, right: u64, message: String) -> FunctionRecord {
        FunctionRecord {
            name: self.name.clone(),
            points: self.points,
            passed: right == cases,
            cases,
            right,
            message,
            at: None,
        }
    }

    /// States why no function can be called with the cases.
    fn mismatch(&self, cases: &[FunctionCase], subject: &Subject) -> String {
        let expected = cases
            .first()
            .map_or_else(String::new, |case| case.signature(&self.name));
        let found: Vec<_> = subject
            .functions(&self.name)
            .map(|function| format!("`{}`", prototype(&subject.checked.tree, function)))
            .collect();
        if found.is_empty() {
            format!("there is no function `{}`; expected `{expected}`", self.name)
        } else {
            let noun = plural(found.len() as u64, "signature", "signatures");
            format!(
                "`{}` has another {noun}: expected `{expected}`, found {}",
                self.name,
                found.join(", ")
            )
        }
    }
}

/// Whether a component agrees with the expected one; NaN agrees with NaN.
fn agrees(actual: f64, expected: f64, tolerance: f64) -> bool {
    if expected.is_finite() {
        (actual - expected).abs() <= tolerance * expected.abs().max(1.0)
    } else {
        actual == expected || (actual.is_nan() && expected.is_nan())
    }
}

/// Components for a message.
fn numbers(components: &[f64]) -> String {
    // Enough digits to show a difference, and no more than f32 has.
    let number = |component: &f64| {
        let digits = format!("{component:.6e}").parse::<f64>().unwrap_or(*component);
        format!("{digits:?}")
    };
    match components {
        [one] => number(one),
        several => format!("({})", several.iter().map(number).collect::<Vec<_>>().join(", ")),
    }
}

impl FunctionCase {
    /// The components of all expected values, in the order of [`Call::components`].
    fn components(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for literal in self.result.iter().chain(self.outputs.iter().flatten()) {
            flatten(literal, &mut all);
        }
        all
    }

    /// The signature that the values indicate.
    fn signature(&self, name: &str) -> String {
        let result = self
            .result
            .as_ref()
            .map_or_else(|| "void".to_owned(), likely_type);
        let outputs = self
            .outputs
            .iter()
            .flatten()
            .map(|output| format!("out {}", likely_type(output)));
        let parameters: Vec<_> = self.arguments.iter().map(likely_type).chain(outputs).collect();
        format!("{result} {name}({})", parameters.join(", "))
    }
}

fn flatten(literal: &Literal, into: &mut Vec<f64>) {
    match literal {
        Literal::Number { value, .. } => into.push(*value),
        Literal::Boolean(value) => into.push(f64::from(u8::from(*value))),
        Literal::List(list) => list.iter().for_each(|literal| flatten(literal, into)),
    }
}

/// The type that a value most likely has.
fn likely_type(literal: &Literal) -> String {
    match literal {
        Literal::Number { .. } => "float".to_owned(),
        Literal::Boolean(_) => "bool".to_owned(),
        Literal::List(list) => {
            let is_vector = (2..=4).contains(&list.len());
            match list.first() {
                Some(Literal::Number { .. }) if is_vector && list.iter().all(is_number) => {
                    format!("vec{}", list.len())
                }
                _ => format!(
                    "{{{}}}",
                    list.iter().map(likely_type).collect::<Vec<_>>().join(", ")
                ),
            }
        }
    }
}

fn is_number(literal: &Literal) -> bool {
    matches!(literal, Literal::Number { .. })
}

/// A value as the assignment has it.
pub(super) fn text(literal: &Literal) -> String {
    match literal {
        Literal::Number {
            value,
            is_integer: true,
        } => format!("{value}"),
        Literal::Number { value, .. } => format!("{value:?}"),
        Literal::Boolean(value) => value.to_string(),
        Literal::List(list) => format!("[{}]", list.iter().map(text).collect::<Vec<_>>().join(", ")),
    }
}

/// A function's return type, name and parameters.
fn prototype(tree: &Tree, function: &Function) -> String {
    let parameters = function.parameters.iter().map(|&id| {
        let direction = match tree[id].kind {
            VariableKind::Parameter(Direction::Out) => "out ",
            VariableKind::Parameter(Direction::InOut) => "inout ",
            _ => "",
        };
        format!("{direction}{}", tree.type_name(tree[id].ty))
    });
    let parameters: Vec<_> = parameters.collect();
    let returns = tree.type_name(function.return_type);
    format!("{returns} {}({})", function.name, parameters.join(", "))
}

/// A function that can be called in all cases, and how.
pub(super) struct Call {
    /// Statements that set the arguments of each case, call the function, and write the compared components
    /// into the color: those of case x in column x, three for each row.
    text: String,
    /// The number of compared components.
    components: usize,
}

impl Call {
    /// `None` if the function's parameters and results do not fit the values of every case.
    pub(super) fn new(tree: &Tree, function: &Function, cases: &[FunctionCase]) -> Option<Self> {
        let mut text = String::from("    ivec2 tpAt = ivec2(tpPlace);\n");
        let names: Vec<_> = (0..function.parameters.len())
            .map(|index| format!("tp{index}"))
            .collect();
        for (name, &id) in names.iter().zip(&function.parameters) {
            let _ = writeln!(text, "    {} {name};", tree.type_name(tree[id].ty));
        }
        for (index, case) in cases.iter().enumerate() {
            let mut arguments = case.arguments.iter();
            let _ = writeln!(text, "    if (tpAt.x == {index}) {{");
            for (name, &id) in names.iter().zip(&function.parameters) {
                if tree[id].kind != VariableKind::Parameter(Direction::Out) {
                    let value = expression(tree, tree[id].ty, arguments.next()?)?;
                    let _ = writeln!(text, "        {name} = {value};");
                }
            }
            text.push_str("    }\n");
            if arguments.next().is_some() {
                return None;
            }
        }
        let call = format!("{}({})", function.name, names.join(", "));
        let _ = match function.return_type {
            Type::Void => writeln!(text, "    {call};"),
            ty => writeln!(text, "    {} tpResult = {call};", tree.type_name(ty)),
        };
        let components = components(tree, function, &names, cases)?;
        for (row, components) in components.chunks(3).enumerate() {
            let mut color = components.to_vec();
            color.resize(4, "0.0".to_owned());
            let _ = writeln!(
                text,
                "    if (tpAt.y == {row}) tpColor = vec4({});",
                color.join(", ")
            );
        }
        Some(Self {
            text,
            components: components.len(),
        })
    }

    /// The components of all results.
    pub(super) fn evaluate(
        &self,
        cases: &[FunctionCase],
        subject: &Subject,
    ) -> Result<Vec<Vec<f64>>, String> {
        let main = format!(
            "void mainImage(out vec4 tpColor, in vec2 tpPlace) {{\n{}}}\n",
            self.text
        );
        let frame = Frame {
            size: [cases.len() as u32, self.components.div_ceil(3).max(1) as u32],
            ..Frame::default()
        };
        let text = with_main(subject.text, &main);
        let colors = ShaderRunner::new(&text, &subject.options(), Some(subject.timeout))
            .and_then(|runner| runner.colors::<f64>(&frame))
            .map_err(|error| not_run(&error))?;
        let result = |x: usize| -> Vec<f64> {
            let component = |index: usize| colors[index / 3 * cases.len() + x][index % 3];
            (0..self.components).map(component).collect()
        };
        Ok((0..cases.len()).map(result).collect())
    }
}

fn not_run(error: &RunError) -> String {
    format!("the test cannot be run: {error}")
}

/// Expressions for the compared components: of the result, then of the outputs. `None` if some case expects
/// other types, or the cases do not compare the same values.
fn components(
    tree: &Tree,
    function: &Function,
    names: &[String],
    cases: &[FunctionCase],
) -> Option<Vec<String>> {
    let first = cases.first()?;
    let outputs = names.iter().zip(&function.parameters).filter(|(_, id)| {
        let direction = tree[**id].kind;
        direction == VariableKind::Parameter(Direction::Out)
            || direction == VariableKind::Parameter(Direction::InOut)
    });
    let outputs: Vec<_> = outputs.map(|(name, id)| (name.as_str(), tree[*id].ty)).collect();
    let result = ("tpResult", function.return_type);
    let compared = first.result.iter().map(|_| result);
    let compared = compared.chain(first.outputs.iter().flat_map(|_| outputs.iter().copied()));
    let compared: Vec<_> = compared.collect();
    for case in cases {
        if (case.result.is_some(), case.outputs.is_some())
            != (first.result.is_some(), first.outputs.is_some())
        {
            return None;
        }
        let values: Vec<_> = case.result.iter().chain(case.outputs.iter().flatten()).collect();
        let mut pairs = compared.iter().zip(&values);
        if values.len() != compared.len() || !pairs.all(|((_, ty), value)| fits(tree, *ty, value)) {
            return None;
        }
    }
    Some(
        compared
            .iter()
            .flat_map(|(name, ty)| paths(tree, *ty, name))
            .collect(),
    )
}

/// Whether a value can be an expected one of a type, where numbers that are not finite may also be expected.
fn fits(tree: &Tree, ty: Type, literal: &Literal) -> bool {
    match (parts(tree, ty), literal) {
        (Some(parts), Literal::List(list)) => {
            parts.len() == list.len()
                && parts
                    .iter()
                    .zip(list)
                    .all(|((_, ty), literal)| fits(tree, *ty, literal))
        }
        (None, literal) => matches!(
            (ty, literal),
            (Type::Scalar(Scalar::Bool), Literal::Boolean(_))
                | (
                    Type::Scalar(Scalar::Float | Scalar::Int | Scalar::Uint),
                    Literal::Number { .. }
                )
        ),
        _ => false,
    }
}

/// A value as an expression of a type; `None` if it cannot have the type.
fn expression(tree: &Tree, ty: Type, literal: &Literal) -> Option<String> {
    if let Some(parts) = parts(tree, ty) {
        let Literal::List(list) = literal else {
            return None;
        };
        let values = parts
            .iter()
            .zip(list)
            .map(|((_, ty), literal)| expression(tree, *ty, literal));
        let values: Vec<_> = values.collect::<Option<_>>()?;
        return (list.len() == parts.len()).then(|| format!("{}({})", tree.type_name(ty), values.join(", ")));
    }
    match (ty, literal) {
        (Type::Scalar(Scalar::Bool), Literal::Boolean(value)) => Some(value.to_string()),
        (Type::Scalar(Scalar::Float), Literal::Number { value, .. }) => Some(format!("({value:?})")),
        (
            Type::Scalar(Scalar::Int),
            Literal::Number {
                value,
                is_integer: true,
            },
        ) => (value.abs() <= f64::from(i32::MAX)).then(|| format!("({value})")),
        (
            Type::Scalar(Scalar::Uint),
            Literal::Number {
                value,
                is_integer: true,
            },
        ) => (0.0..=f64::from(u32::MAX))
            .contains(value)
            .then(|| format!("{value}u")),
        _ => None,
    }
}

/// The parts of a type that is composed of others, each with the end of its path; `None` for scalars, and for
/// types without values.
pub(super) fn parts(tree: &Tree, ty: Type) -> Option<Vec<(String, Type)>> {
    let indexed = |count: u32, part: Type| (0..count).map(|index| (format!("[{index}]"), part)).collect();
    match ty {
        Type::Vector(scalar, size) => Some(indexed(u32::from(size), Type::Scalar(scalar))),
        Type::Matrix { columns, rows } => {
            Some(indexed(u32::from(columns), Type::Vector(Scalar::Float, rows)))
        }
        Type::Array(id) => {
            let array = tree.array(id);
            (array.size <= MAX_ARRAY).then(|| indexed(array.size, array.element))
        }
        Type::Struct(id) => {
            let members = tree[id].members.iter();
            Some(
                members
                    .map(|member| (format!(".{}", member.name), member.ty))
                    .collect(),
            )
        }
        _ => None,
    }
}

/// Expressions for the components of a variable, as floats.
fn paths(tree: &Tree, ty: Type, path: &str) -> Vec<String> {
    match parts(tree, ty) {
        None => vec![format!("float({path})")],
        Some(parts) => {
            let parts = parts.iter();
            parts
                .flat_map(|(end, ty)| paths(tree, *ty, &format!("{path}{end}")))
                .collect()
        }
    }
}
