//! The values of constant expressions in 32-bit floats, as the evaluator and naga compute them.
//!
//! The front end computes constants in double precision, which hides that `length(vec3(1e20))` overflows, and
//! has other last bits. Here every operation is rounded: `+ − × ÷` and `sqrt` of 32-bit floats, computed in
//! double precision, round to the same bits as in one step. Denormals are flushed in functions only, since
//! naga does not flush the others.

use std::collections::HashMap;

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constant, ExprId, ExprKind, Scalar, Tree, Type, Value, VariableKind,
};
use toyproof_math::{ExprGraph, FloatTerm};

use super::polyfill;
use crate::inexact::InexactFunction;

/// The values of constant expressions, as far as computed.
#[derive(Debug, Default)]
pub(super) struct Float32Values {
    known: HashMap<ExprId, Option<Constant>>,
}

impl Float32Values {
    /// The value of an expression; `None` if it is not constant or has no known value.
    pub(super) fn value(&mut self, tree: &Tree, root: ExprId) -> Option<Constant> {
        // A loop handles chains of any length.
        let mut pending = vec![(root, false)];
        while let Some((id, operands_done)) = pending.pop() {
            if self.known.contains_key(&id) {
                continue;
            }
            if !tree[id].constant {
                self.known.insert(id, None);
            } else if operands_done {
                let value = self.of_operands(tree, id);
                self.known.insert(id, value);
            } else {
                pending.push((id, true));
                each_operand(tree, id, |operand| pending.push((operand, false)));
            }
        }
        // A pass may have hidden the value since it was computed.
        self.known
            .get(&root)
            .filter(|_| tree[root].constant)
            .cloned()
            .flatten()
    }

    fn of_operands(&self, tree: &Tree, id: ExprId) -> Option<Constant> {
        let mut operands = Vec::new();
        each_operand(tree, id, |operand| {
            operands.push(
                self.known
                    .get(&operand)
                    .filter(|_| tree[operand].constant)
                    .cloned()
                    .flatten(),
            );
        });
        if let ExprKind::Variable(_) = tree[id].kind {
            return operands.pop().flatten();
        }
        let value = match inexact_value(tree, id, &operands) {
            Some(components) => Constant::of_components(tree[id].ty, components),
            None => tree.value_of(id, operands)?,
        };
        Some(if value.components().is_empty() {
            value
        } else {
            let rounded = value.components().iter().copied().map(rounded);
            Constant::of_components(value.ty, rounded.collect())
        })
    }
}

/// Visits the operands of an expression; that of a constant variable is its initializer.
fn each_operand(tree: &Tree, id: ExprId, mut visit: impl FnMut(ExprId)) {
    match tree[id].kind {
        ExprKind::Variable(variable) if tree[variable].kind == VariableKind::Const => {
            tree[variable].initializer.into_iter().for_each(visit);
        }
        _ => tree[id].kind.for_each_operand(&mut visit),
    }
}

fn rounded(value: Value) -> Value {
    match value {
        Value::Float(value) => Value::Float(f64::from(value as f32)),
        other => other,
    }
}

/// The components of an operation with several roundings.
fn inexact_value(tree: &Tree, id: ExprId, operands: &[Option<Constant>]) -> Option<Vec<Value>> {
    let arguments: Vec<&Constant> = operands.iter().map(Option::as_ref).collect::<Option<_>>()?;
    let floats: Vec<Vec<f32>> = arguments
        .iter()
        .map(|argument| floats(argument))
        .collect::<Option<_>>()?;
    let results = match &tree[id].kind {
        ExprKind::BuiltIn { function, .. } => function_of_floats(*function, tree[id].ty, &floats)?,
        ExprKind::Binary {
            op: BinaryOp::Multiply,
            ..
        } => {
            let types: Vec<Type> = arguments.iter().map(|argument| argument.ty).collect();
            let results = computed(&floats, |terms| polyfill::product(terms, &types));
            // Only products of matrices are sums.
            (!results.is_empty()).then_some(results)?
        }
        _ => return None,
    };
    let values = results.into_iter().map(|value| Value::Float(f64::from(value)));
    Some(values.collect())
}

/// The components of a function whose last bits are implementation-defined, by the evaluator's definition;
/// `None` for other functions.
pub(crate) fn function_of_floats(function: BuiltIn, ty: Type, arguments: &[Vec<f32>]) -> Option<Vec<f32>> {
    let definition = InexactFunction::from_built_in(function, arguments.len())?.definition;
    if definition.argument_count().is_none() {
        let results = computed(arguments, |terms| of_terms(function, terms));
        return (!results.is_empty()).then_some(results);
    }
    let mut results = Vec::new();
    for at in 0..usize::from(ty.component_count()?) {
        // A scalar is combined with every component.
        let component = arguments.iter().map(|argument| {
            let at = if argument.len() == 1 { 0 } else { at };
            Some(vec![*argument.get(at)?])
        });
        let component: Vec<Vec<f32>> = component.collect::<Option<_>>()?;
        results.extend(computed(&component, |terms| of_terms(function, terms)));
    }
    Some(results)
}

fn of_terms<'a>(function: BuiltIn, arguments: &[Vec<FloatTerm<'a>>]) -> Vec<FloatTerm<'a>> {
    let inexact = InexactFunction::from_built_in(function, arguments.len());
    inexact.map_or_else(Vec::new, |inexact| polyfill::apply(inexact.definition, arguments))
}

fn computed(
    arguments: &[Vec<f32>],
    function: impl for<'a> Fn(&[Vec<FloatTerm<'a>>]) -> Vec<FloatTerm<'a>>,
) -> Vec<f32> {
    let graph = ExprGraph::default();
    let mut count = 0;
    let terms: Vec<Vec<FloatTerm>> = arguments
        .iter()
        .map(|argument| {
            let first = count;
            count += argument.len();
            (first..count).map(|index| graph.argument(index)).collect()
        })
        .collect();
    let results: Vec<_> = function(&terms).into_iter().map(FloatTerm::id).collect();
    graph.evaluate(&results, &arguments.concat())
}

/// The components of a value of floats.
pub(super) fn floats(value: &Constant) -> Option<Vec<f32>> {
    if value.ty.scalar() != Some(Scalar::Float) {
        return None;
    }
    let components = value.components().iter().map(|component| match component {
        Value::Float(value) => Some(*value as f32),
        _ => None,
    });
    components.collect()
}
