//! Built-in functions of constants, folded to the evaluator's values.
//!
//! naga evaluates functions of constants with the host's own `sin`, whose last bits are not the evaluator's,
//! and refuses some legal arguments: `pow(0.0, 0.0)`. Literals leave it nothing to evaluate. Values that are
//! not finite are left to [`super::constant`].

use toyproof_glsl::tree::{BuiltIn, Constructor, ExprId, ExprKind, Scalar, Type, Value};

use super::float32::{Float32Values, floats, function_of_floats};
use crate::inexact::InexactFunction;
use crate::lower::context::LoweringContext;

pub(super) fn run(cx: &mut LoweringContext) {
    fold_except(cx, |_| false);
}

/// Folds functions of constants whose last bits are implementation-defined, except those that are kept.
pub(crate) fn fold_except(cx: &mut LoweringContext, is_kept: impl Fn(BuiltIn) -> bool) {
    let mut values = Float32Values::default();
    cx.each_expression_postorder(|cx, id| {
        let ExprKind::BuiltIn { function, arguments } = &cx.tree[id].kind else {
            return;
        };
        let is_exact = InexactFunction::from_built_in(*function, arguments.len()).is_none();
        if !cx.tree[id].constant || is_exact || is_kept(*function) {
            return;
        }
        let (function, ty) = (*function, cx.tree[id].ty);
        let arguments: Option<Vec<Vec<f32>>> = arguments
            .clone()
            .into_iter()
            .map(|argument| floats(&values.value(&cx.tree, argument)?))
            .collect();
        let Some(arguments) = arguments else {
            return;
        };
        let Some(value) = function_of_floats(function, ty, &arguments) else {
            return;
        };
        // The evaluator flushes denormals, before functions and after.
        let is_plain = |value: &f32| value.is_finite() && !value.is_subnormal();
        let are_plain = arguments.iter().flatten().chain(&value).all(is_plain);
        if are_plain {
            replace(cx, id, &value);
        }
    });
}

/// Folds operations on constants whose value depends on the precision in which a compiler computes them: most
/// compute in double precision, and the evaluator rounds each operation. All others stay as they are written.
pub(crate) fn fold_by_precision(cx: &mut LoweringContext) {
    let mut values = Float32Values::default();
    cx.each_expression_postorder(|cx, id| {
        let is_operation = matches!(
            cx.tree[id].kind,
            ExprKind::Binary { .. } | ExprKind::BuiltIn { .. }
        );
        if !is_operation || !cx.tree[id].constant || cx.tree[id].ty.scalar() != Some(Scalar::Float) {
            return;
        }
        let rounded = values.value(&cx.tree, id);
        let (Some(rounded), Some(exact)) = (rounded.as_ref().and_then(floats), cx.tree.value(id)) else {
            return;
        };
        let is_plain = |value: &f32| value.is_finite() && !value.is_subnormal();
        if floats(&exact).is_some_and(|exact| exact != rounded) && rounded.iter().all(is_plain) {
            replace(cx, id, &rounded);
            // Compilers read the digits, which round to this value, in double precision too.
            for literal in cx.tree.postorder(id) {
                if let ExprKind::Literal(literal) = &mut cx.tree[literal].kind
                    && let Ok(value) = literal.text.parse()
                {
                    literal.value = Value::Float(value);
                }
            }
        }
    });
}

/// Replaces an expression by literals.
fn replace(cx: &mut LoweringContext, id: ExprId, value: &[f32]) {
    let ty = cx.tree[id].ty;
    let mut build = cx.build_at(id);
    let components: Vec<ExprId> = value.iter().map(|&component| build.float(component)).collect();
    let node = match (ty, components.as_slice()) {
        (_, &[only]) => only,
        (Type::Matrix { .. }, _) => build.construct(Constructor::Matrix, components, ty),
        _ => build.construct(Constructor::Vector, components, ty),
    };
    cx.tree[id] = cx.tree[node].clone();
    cx.tree[id].constant = true;
    cx.tree.clear_cached_value(id);
}
