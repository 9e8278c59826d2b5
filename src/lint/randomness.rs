//! `fract(sin(x) * 43758.5453)`: the low-order digits of a sine differ between drivers.

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, UnaryOp, Value};

use super::program::{Definition, Program};
use super::{Findings, format_number};

/// The minimum factor that turns a sine into a hash: it scales the error of 2⁻¹¹ that Vulkan permits for
/// `sin` to a twentieth of the range of `fract`. Smaller factors make patterns.
const MIN_HASH_FACTOR: f64 = 100.0;

/// The absolute error that Vulkan permits for `sin` and `cos`, for arguments in [−π, π].
const MAX_SINE_ERROR: f64 = 1.0 / 2048.0;

pub(super) fn run(program: &Program, findings: &mut Findings) {
    for expr in program.all_exprs() {
        let Some(inside) = fract_argument(program, expr) else {
            continue;
        };
        let Some((sine, factor)) = find_scaled_sine(program, inside) else {
            continue;
        };
        let tree = program.tree;
        let name = if let ExprKind::BuiltIn { function, .. } = tree[sine].kind {
            function.name()
        } else {
            "sin"
        };
        let factor_text = format_number(factor);
        let message = format!("this hash depends on the precision of `{name}` and differs between GPUs");
        findings.add(Code::SineHash, tree[expr].at, message, |diagnostic| {
            diagnostic
                .note(format!(
                    "Vulkan allows an error of 2^-11 in `{name}`; multiplied by {factor_text}, that is {}",
                    format_number((factor * MAX_SINE_ERROR * 10.0).round() / 10.0)
                ))
                .help(
                    "use an integer hash, which is the same everywhere: `uint h = floatBitsToUint(x); h = (h ^ (h >> 16)) * 0x7feb352du; \
                     h = (h ^ (h >> 15)) * 0x846ca68bu; return float((h ^ (h >> 16)) >> 8) / 16777216.0;`",
                )
        });
    }
}

/// The argument of `fract(x)` or `mod(x, 1.0)`.
fn fract_argument(program: &Program, expr: ExprId) -> Option<ExprId> {
    let ExprKind::BuiltIn { function, arguments } = &program.tree[expr].kind else {
        return None;
    };
    match (function, &arguments[..]) {
        (BuiltIn::Fract, [x]) => Some(*x),
        (BuiltIn::Mod, [x, one]) => {
            let one = program.tree.value(*one)?;
            one.components()
                .iter()
                .all(|&scalar| scalar == Value::Float(1.0))
                .then_some(*x)
        }
        _ => None,
    }
}

/// The sine that a large factor multiplies in one of an expression's terms, and the factor.
fn find_scaled_sine(program: &Program, inside: ExprId) -> Option<(ExprId, f64)> {
    let tree = program.tree;
    let mut terms = vec![inside];
    // At most four names are followed in total: from `fract(h)` to `h = sin(x) * 43758.5453`, and from there
    // to `s = sin(x)`.
    let mut names = 4;
    while let Some(term) = terms.pop() {
        match &tree[term].kind {
            ExprKind::Binary {
                op: BinaryOp::Add | BinaryOp::Subtract,
                left,
                right,
            } => terms.extend([*right, *left]),
            ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => terms.push(*operand),
            ExprKind::Swizzle { vector, .. } => terms.push(*vector),
            ExprKind::Construct { arguments, .. } => terms.extend(arguments.iter().rev()),
            ExprKind::BuiltIn {
                function: BuiltIn::Abs,
                arguments,
            } => terms.push(arguments[0]),
            ExprKind::Variable(variable) if names > 0 => {
                names -= 1;
                let values =
                    program
                        .definitions(*variable)
                        .iter()
                        .filter_map(|definition| match definition {
                            Definition::Value(value) => Some(*value),
                            _ => None,
                        });
                terms.extend(values.take(4));
            }
            ExprKind::Binary {
                op: BinaryOp::Multiply,
                ..
            } => {
                if let Some(found) = scaled_sine(program, term) {
                    return Some(found);
                }
            }
            _ => {}
        }
    }
    None
}

/// The sine among the factors of a product, if its constant factors reach [`MIN_HASH_FACTOR`].
fn scaled_sine(program: &Program, product: ExprId) -> Option<(ExprId, f64)> {
    let tree = program.tree;
    let mut factors = vec![product];
    let (mut scale, mut sine) = (1.0, None);
    while let Some(factor) = factors.pop() {
        if let Some(constant) = program.constant(factor) {
            scale *= constant
                .components()
                .iter()
                .fold(0.0_f64, |most, scalar| match scalar {
                    Value::Float(value) => most.max(value.abs()),
                    _ => most,
                });
            continue;
        }
        match &tree[factor].kind {
            ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            } => factors.extend([*right, *left]),
            ExprKind::Unary { operand, .. } => factors.push(*operand),
            ExprKind::Swizzle { vector, .. } => factors.push(*vector),
            ExprKind::BuiltIn {
                function: BuiltIn::Abs,
                arguments,
            } => factors.push(arguments[0]),
            ExprKind::BuiltIn {
                function: BuiltIn::Sin | BuiltIn::Cos | BuiltIn::Tan,
                ..
            } => sine = Some(factor),
            // `vec2(sin(x), cos(x)) * 43758.0`
            ExprKind::Construct { arguments, .. } => factors.extend(arguments.iter().rev()),
            ExprKind::Variable(variable) => {
                let value = program.single_value(*variable);
                sine = sine.or(value.filter(|&value| is_sine(program, value)));
            }
            _ => {}
        }
    }
    sine.filter(|_| scale >= MIN_HASH_FACTOR)
        .map(|sine| (sine, scale))
}

fn is_sine(program: &Program, expr: ExprId) -> bool {
    matches!(
        program.tree[expr].kind,
        ExprKind::BuiltIn {
            function: BuiltIn::Sin | BuiltIn::Cos | BuiltIn::Tan,
            ..
        }
    )
}
