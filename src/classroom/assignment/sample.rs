//! A test of a function of a model solution, which a new assignment shows as an example.

use std::fmt::Write as _;

use toyproof_glsl::tree::{Direction, Function, Item, Scalar, Tree, Type, VariableKind};
use toyproof_toml::Literal;

use crate::function_test::{Call, ListedCall, Subject, literal_text, parts};

/// The components of sample arguments, repeated cyclically.
const COMPONENTS: [f64; 4] = [1.0, 0.5, 0.25, 2.0];

/// The number of decimals of a sample result.
const DECIMALS: i32 = 6;

/// The largest number of components of sample arguments and results.
const MAX_COMPONENTS: usize = 16;

/// The tables of a test, as comments: of the first function of the solution that has arguments and a result,
/// and whose result in a sample call is finite. `None` if there is no such function.
#[must_use]
pub(super) fn sample(subject: &Subject) -> Option<String> {
    let tree = &subject.checked.tree;
    let mut defined = tree.items.iter().filter_map(|item| match *item {
        Item::Function(id) if id != subject.checked.main_image => Some(&tree[id]),
        _ => None,
    });
    defined.find_map(|function| test(tree, function, subject))
}

fn test(tree: &Tree, function: &Function, subject: &Subject) -> Option<String> {
    let is_input = |kind| matches!(kind, VariableKind::Parameter(Direction::In | Direction::ConstIn));
    let parameters = function.parameters.iter().map(|&id| &tree[id]);
    let mut components = COMPONENTS.iter().copied().cycle().take(MAX_COMPONENTS);
    let arguments = parameters
        .map(|parameter| is_input(parameter.kind).then(|| literal(tree, parameter.ty, &mut components))?)
        .collect::<Option<Vec<_>>>()?;
    let zero = literal(
        tree,
        function.return_type,
        &mut std::iter::repeat_n(0.0, MAX_COMPONENTS),
    )?;
    if arguments.is_empty() {
        return None;
    }
    let call = ListedCall {
        at: None,
        arguments,
        result: Some(zero),
        outputs: None,
        tolerance: None,
    };
    let calls = [call];
    let result = Call::new(tree, function, &calls, None)?.first_result(&calls, subject)?;
    let [call] = calls;
    let mut result = result.into_iter().map(rounded);
    let result = literal(tree, function.return_type, &mut result)?;
    let arguments: Vec<_> = call.arguments.iter().map(literal_text).collect();
    let mut table = String::new();
    let _ = write!(
        table,
        "# [[function]]\n\
         # name = \"{}\"\n\
         # points = 2\n\
         #\n\
         # [[function.case]]\n\
         # arguments = [{}]\n\
         # result = {}\n",
        function.name,
        arguments.join(", "),
        literal_text(&result)
    );
    Some(table)
}

fn rounded(value: f64) -> f64 {
    let scale = 10_f64.powi(DECIMALS);
    (value * scale).round() / scale
}

/// A value of a type with these components; `None` if there are too few, or one is not finite, or the type
/// has no values.
fn literal(tree: &Tree, ty: Type, components: &mut impl Iterator<Item = f64>) -> Option<Literal> {
    if let Some(parts) = parts(tree, ty) {
        let parts = parts.iter().map(|(_, ty)| literal(tree, *ty, components));
        return parts.collect::<Option<_>>().map(Literal::List);
    }
    let Type::Scalar(scalar) = ty else {
        return None;
    };
    let value = components.next().filter(|value| value.is_finite())?;
    Some(match scalar {
        Scalar::Bool => Literal::Boolean(value != 0.0),
        Scalar::Float => Literal::Number {
            value,
            is_integer: false,
        },
        Scalar::Int | Scalar::Uint => Literal::Number {
            value: value.trunc(),
            is_integer: true,
        },
    })
}
