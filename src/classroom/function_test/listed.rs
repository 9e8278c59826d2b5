//! Calls of a function with listed arguments and results.

use toyproof_diagnostic::{Span, plural};
use toyproof_glsl::tree::{Direction, Function, Scalar, Tree, Type, VariableKind};
use toyproof_toml::Literal;

use super::evaluation::{Evaluation, Values};
use super::result::{Run, TestError, TestResult};
use super::source::{GeneratedText, Snippet};
use super::subject::Subject;
use super::test::{DEFAULT_TOLERANCE, FunctionTest, ListedCall, Precision};
use super::value::{
    Component, agrees, components, expression, fits, flatten, likely_type, literal_text, numbers, prototype,
};

impl ListedCall {
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

    /// The call as a message shows it.
    fn text(&self, name: &str) -> String {
        let arguments: Vec<_> = self.arguments.iter().map(literal_text).collect();
        format!("{name}({})", arguments.join(", "))
    }
}

/// The results of the listed calls: one for each, or one if the function cannot be called.
pub(super) fn results(
    test: &FunctionTest,
    calls: &[ListedCall],
    subject: &Subject,
    precision: Precision,
) -> Vec<TestResult> {
    if calls.is_empty() {
        return Vec::new();
    }
    let values = evaluate(test, calls, subject, precision);
    let (call, values) = match values {
        Ok(evaluated) => evaluated,
        Err(error) => {
            return vec![TestResult {
                name: calls[0].text(&test.name),
                at: calls[0].at,
                runs: Err(error),
            }];
        }
    };
    let result = |(index, one): (usize, &ListedCall)| TestResult {
        name: one.text(&test.name),
        at: one.at,
        runs: Ok(values
            .iter()
            .map(|values| run(test, one, index, &call.components, values))
            .collect()),
    };
    calls.iter().enumerate().map(result).collect()
}

/// Compares the result of a call.
fn run(
    test: &FunctionTest,
    call: &ListedCall,
    index: usize,
    components: &[Component],
    values: &Values,
) -> Run {
    let actual = &values.cases[index];
    let expected = call.components();
    let is_same = |(component, (actual, expected)): (&Component, (&f64, &f64))| {
        let default = match component.scalar {
            Scalar::Float => DEFAULT_TOLERANCE,
            _ => 0.0,
        };
        agrees(*actual, *expected, call.tolerance.unwrap_or(default))
    };
    let is_right = components.iter().zip(actual.iter().zip(&expected)).all(is_same);
    let message = || {
        format!(
            "in case {}, {} is {}, expected {}",
            index + 1,
            call.text(&test.name),
            numbers(actual),
            numbers(&expected)
        )
    };
    Run {
        is_single: values.is_single,
        samples: 1,
        wrong: u64::from(!is_right),
        message: if is_right { String::new() } else { message() },
    }
}

fn evaluate(
    test: &FunctionTest,
    calls: &[ListedCall],
    subject: &Subject,
    precision: Precision,
) -> Result<(Call, Vec<Values>), TestError> {
    let tree = &subject.checked.tree;
    let call = subject
        .functions(&test.name)
        .find_map(|function| Call::new(tree, function, calls, test.after.as_ref()))
        .ok_or_else(|| TestError::Shader(mismatch(&test.name, calls, subject)))?;
    let at = calls.first().and_then(|call| call.at);
    let values = call.evaluate(calls, subject, precision, at)?;
    Ok((call, values))
}

/// States why no function can be called with the cases.
fn mismatch(name: &str, calls: &[ListedCall], subject: &Subject) -> String {
    let expected = calls
        .first()
        .map_or_else(String::new, |call| call.signature(name));
    let found: Vec<_> = subject
        .functions(name)
        .map(|function| format!("`{}`", prototype(&subject.checked.tree, function)))
        .collect();
    if found.is_empty() {
        format!("there is no function `{name}`; expected `{expected}`")
    } else {
        let noun = plural(found.len() as u64, "signature", "signatures");
        format!(
            "`{name}` has another {noun}: expected `{expected}`, found {}",
            found.join(", ")
        )
    }
}

/// A function that can be called in all cases, and how.
pub(crate) struct Call {
    /// Statements that set the arguments of each case, and call the function.
    statements: GeneratedText,
    /// The compared components: of the result, then of the outputs.
    components: Vec<Component>,
}

impl Call {
    /// `None` if the function's parameters and results do not fit the values of every call.
    pub(crate) fn new(
        tree: &Tree,
        function: &Function,
        calls: &[ListedCall],
        after: Option<&Snippet>,
    ) -> Option<Self> {
        let mut text = GeneratedText::default();
        let names: Vec<_> = (0..function.parameters.len())
            .map(|index| format!("tp{index}"))
            .collect();
        for (name, &id) in names.iter().zip(&function.parameters) {
            text.push(&format!("    {} {name};\n", tree.type_name(tree[id].ty)));
        }
        for (index, call) in calls.iter().enumerate() {
            let mut arguments = call.arguments.iter();
            text.push(&format!("    if (tpCase == {index}) {{\n"));
            for (name, &id) in names.iter().zip(&function.parameters) {
                if tree[id].kind != VariableKind::Parameter(Direction::Out) {
                    let value = expression(tree, tree[id].ty, arguments.next()?)?;
                    text.push(&format!("        {name} = {value};\n"));
                }
            }
            text.push("    }\n");
            if arguments.next().is_some() {
                return None;
            }
        }
        if let Some(after) = after {
            text.push("    ");
            text.push_snippet(after);
            text.push(";\n");
        }
        let call = format!("{}({})", function.name, names.join(", "));
        text.push(&match function.return_type {
            Type::Void => format!("    {call};\n"),
            ty => format!("    {} tpResult = {call};\n", tree.type_name(ty)),
        });
        Some(Self {
            statements: text,
            components: compared(tree, function, &names, calls)?,
        })
    }

    /// The components of all results. `at`: the place of errors in the call.
    pub(super) fn evaluate(
        &self,
        calls: &[ListedCall],
        subject: &Subject,
        precision: Precision,
        at: Option<Span>,
    ) -> Result<Vec<Values>, TestError> {
        let evaluation = Evaluation {
            declarations: GeneratedText::default(),
            statements: self.statements.clone(),
            components: self.components.clone(),
            cases: calls.len(),
        };
        evaluation.evaluate(subject, precision, at)
    }

    /// The components of the first call's results in f64; `None` if it cannot be evaluated.
    pub(crate) fn first_result(&self, calls: &[ListedCall], subject: &Subject) -> Option<Vec<f64>> {
        let values = self.evaluate(calls, subject, Precision::Double, None).ok()?;
        values.into_iter().next()?.cases.into_iter().next()
    }
}

/// The compared components: of the result, then of the outputs. `None` if some case expects other types, or
/// the cases do not compare the same values.
fn compared(
    tree: &Tree,
    function: &Function,
    names: &[String],
    calls: &[ListedCall],
) -> Option<Vec<Component>> {
    let first = calls.first()?;
    let outputs = names.iter().zip(&function.parameters).filter(|(_, id)| {
        let direction = tree[**id].kind;
        direction == VariableKind::Parameter(Direction::Out)
            || direction == VariableKind::Parameter(Direction::InOut)
    });
    let outputs: Vec<_> = outputs.map(|(name, id)| (name.as_str(), tree[*id].ty)).collect();
    let result = ("tpResult", function.return_type);
    let all = first.result.iter().map(|_: &Literal| result);
    let all = all.chain(first.outputs.iter().flat_map(|_| outputs.iter().copied()));
    let all: Vec<_> = all.collect();
    for call in calls {
        if (call.result.is_some(), call.outputs.is_some())
            != (first.result.is_some(), first.outputs.is_some())
        {
            return None;
        }
        let values: Vec<_> = call.result.iter().chain(call.outputs.iter().flatten()).collect();
        let mut pairs = all.iter().zip(&values);
        if values.len() != all.len() || !pairs.all(|((_, ty), value)| fits(tree, *ty, value)) {
            return None;
        }
    }
    let components = all.iter().map(|(name, ty)| components(tree, *ty, name));
    Some(components.collect::<Option<Vec<_>>>()?.concat())
}
