//! `fract(sin(x) * 43758.5453)`: what is left of a sine after its first digits are cut off is each driver's own.

use toyproof_glsl::Code;
use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, UnaryOp, Value};

use super::program::{Definition, Program};
use super::{Found, number};

/// The least factor that makes randomness of a sine: Vulkan lets `sin` be off by 2⁻¹¹, which this makes a
/// twentieth of the whole range. What is multiplied by less is a pattern.
const LEAST_FACTOR: f64 = 100.0;

/// How far Vulkan lets `sin` and `cos` be off, for arguments in [−π, π].
const SINE_ERROR: f64 = 1.0 / 2048.0;

pub(super) fn run(program: &Program, found: &mut Found) {
    for expr in program.all_exprs() {
        let Some(inside) = fraction(program, expr) else {
            continue;
        };
        let Some((sine, factor)) = hash(program, inside) else {
            continue;
        };
        let tree = program.tree;
        let name = if let ExprKind::BuiltIn { function, .. } = tree[sine].kind {
            function.name()
        } else {
            "sin"
        };
        let shown = number(factor);
        let message = format!("randomness from the digits of `{name}(…) * {shown}` differs from GPU to GPU");
        found.tell(Code::SineHash, tree[expr].at, message, |diagnostic| {
            diagnostic
                .note(format!(
                    "each driver computes `{name}` in its own way; Vulkan lets it be off by 2^-11, which times {shown} is {}",
                    number((factor * SINE_ERROR * 10.0).round() / 10.0)
                ))
                .note(
                    "an integer hash is the same everywhere: `uint h = floatBitsToUint(x); h = (h ^ (h >> 16)) * 0x7feb352du; \
                     h = (h ^ (h >> 15)) * 0x846ca68bu; return float((h ^ (h >> 16)) >> 8) / 16777216.0;`",
                )
        });
    }
}

/// What an expression takes the fractional part of: `fract(x)` or `mod(x, 1.0)`.
fn fraction(program: &Program, expr: ExprId) -> Option<ExprId> {
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
fn hash(program: &Program, inside: ExprId) -> Option<(ExprId, f64)> {
    let tree = program.tree;
    let mut terms = vec![inside];
    // Names are followed a few times in all: from `fract(h)` to `h = sin(x) * 43758.5453`, and from there to `s = sin(x)`.
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
                if let Some(hash) = product(program, term) {
                    return Some(hash);
                }
            }
            _ => {}
        }
    }
    None
}

/// The sine among the factors of a product, if the constants among them make it large enough.
fn product(program: &Program, product: ExprId) -> Option<(ExprId, f64)> {
    let tree = program.tree;
    let mut factors = vec![product];
    let (mut size, mut sine) = (1.0, None);
    while let Some(factor) = factors.pop() {
        if let Some(constant) = program.constant(factor) {
            size *= constant
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
                let value = program.only_value(*variable);
                sine = sine.or(value.filter(|&value| is_sine(program, value)));
            }
            _ => {}
        }
    }
    sine.filter(|_| size >= LEAST_FACTOR).map(|sine| (sine, size))
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
