//! `smoothstep` whose first edge is not less than the second: GLSL leaves the result undefined (§8.3).
//!
//! Reports only where the order of the edges is certain: both are constants, or their difference is a sum of
//! constants and of values that are never negative, such as `fwidth(d)` and `2.0 / iResolution.y`.

use toyproof_diagnostic::{Code, Files, Fix, Span};
use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, Input, Type, UnaryOp, Value, VariableKind};

use super::program::Program;
use super::shape::Shape;
use super::{Findings, format_number};

/// The maximum number of expressions examined for one call; nothing is reported beyond it.
const MAX_EXPRS: usize = 100;

/// The maximum length of a proposed text in bytes.
const MAX_FIX_BYTES: usize = 120;

pub(super) fn run(program: &Program, files: &Files, findings: &mut Findings) {
    let tree = program.tree;
    for expr in program.all_exprs() {
        let ExprKind::BuiltIn {
            function: BuiltIn::Smoothstep,
            arguments,
        } = &tree[expr].kind
        else {
            continue;
        };
        let &[low, high, x] = &arguments[..] else {
            continue;
        };
        let Some(order) = order(program, low, high) else {
            continue;
        };
        let at = tree[expr].at;
        let place = |argument: ExprId| (!at.is_expanded()).then_some(tree[argument].at.span);
        let places = place(low).zip(place(high)).zip(place(x));
        let message = match order {
            Order::Equal => "the edges of this `smoothstep` are equal, so that its result is undefined".to_owned(),
            Order::Reversed(None) => {
                "the first edge of this `smoothstep` is greater than the second, so that its result is undefined"
                    .to_owned()
            }
            Order::Reversed(Some([low, high])) => format!(
                "the first edge of this `smoothstep`, {}, is greater than the second, {}, so that its result is undefined",
                format_number(low),
                format_number(high)
            ),
        };
        findings.add(Code::ReversedEdges, at, message, |diagnostic| {
            let diagnostic =
                diagnostic.note("GLSL ES 3.00, 8.3: “Results are undefined if edge0 >= edge1”, although most drivers compute the formula");
            if matches!(order, Order::Equal) {
                return diagnostic.help("for a sharp edge, write `step(edge, x)`");
            }
            match places.and_then(|((low, high), x)| swapped(files, at.span, [low, high, x])) {
                Some(fix) => diagnostic.fix(fix),
                None => diagnostic.help(
                    "write `1.0 - smoothstep(b, a, x)` instead of `smoothstep(a, b, x)`: it is what the formula gives",
                ),
            }
        });
    }
}

/// The order of two edges that are not in the order that GLSL requires.
#[derive(Debug, Clone, Copy)]
enum Order {
    Equal,
    /// The first is greater; with their values where both are constants.
    Reversed(Option<[f64; 2]>),
}

/// The fix that swaps the edges, and subtracts the result from 1.
fn swapped(files: &Files, call: Span, [low, high, x]: [Span; 3]) -> Option<Fix> {
    let text = |span: Span| files.text(span).trim();
    let is_plain = |text: &str| !text.contains(['\n', '#']) && !text.contains("//");
    let whole = format!("1.0 - smoothstep({}, {}, {})", text(high), text(low), text(x));
    let point = |at: u32| Span::new(call.file, at, at);
    (is_plain(&whole) && whole.len() <= MAX_FIX_BYTES).then(|| {
        Fix::new(format!("write `({whole})`"), point(call.start), "(1.0 - ")
            .and(low, text(high))
            .and(high, text(low))
            .and(point(call.end), ")")
    })
}

/// The order of the edges; `None` if it is right, or not known.
fn order(program: &Program, low: ExprId, high: ExprId) -> Option<Order> {
    if let (Some(low), Some(high)) = (program.constant(low), program.constant(high)) {
        let pairs = low.components().iter().zip(high.components());
        let pairs: Vec<[f64; 2]> = pairs
            .filter_map(|pair| match pair {
                (&Value::Float(low), &Value::Float(high)) => Some([low, high]),
                _ => None,
            })
            .collect();
        if let Some(&reversed) = pairs.iter().find(|[low, high]| low > high) {
            return Some(Order::Reversed(Some(reversed)));
        }
        return pairs
            .iter()
            .any(|[low, high]| low == high)
            .then_some(Order::Equal);
    }
    if program.tree[low].ty != Type::FLOAT {
        return None;
    }
    let mut sum = Sum::default();
    sum.add(program, low, 1.0)?;
    sum.add(program, high, -1.0)?;
    if !sum.is_never_negative(program) {
        return None;
    }
    Some(
        if sum.constant == 0.0 && sum.terms.iter().all(|term| term.factor == 0.0) {
            Order::Equal
        } else {
            Order::Reversed(None)
        },
    )
}

/// A sum of constants and of expressions with factors.
#[derive(Debug, Default)]
struct Sum {
    constant: f64,
    terms: Vec<Term>,
    /// The number of expressions that it was made of.
    exprs: usize,
}

#[derive(Debug)]
struct Term {
    expr: ExprId,
    /// Equal expressions have equal shapes.
    shape: Shape,
    factor: f64,
}

impl Sum {
    /// Adds a multiple of an expression; `None` if it is too long, or has side effects.
    fn add(&mut self, program: &Program, expr: ExprId, factor: f64) -> Option<()> {
        let tree = program.tree;
        let mut pending = vec![(expr, factor)];
        while let Some((expr, factor)) = pending.pop() {
            self.exprs += 1;
            if self.exprs > MAX_EXPRS {
                return None;
            }
            if let Some(value) = program.number(expr) {
                self.constant += factor * value;
                continue;
            }
            match tree[expr].kind {
                ExprKind::Binary {
                    op: op @ (BinaryOp::Add | BinaryOp::Subtract),
                    left,
                    right,
                } => {
                    let sign = if op == BinaryOp::Add { 1.0 } else { -1.0 };
                    pending.extend([(left, factor), (right, sign * factor)]);
                }
                ExprKind::Unary {
                    op: UnaryOp::Minus,
                    operand,
                } => pending.push((operand, -factor)),
                ExprKind::Binary {
                    op: BinaryOp::Multiply,
                    left,
                    right,
                } if program.number(left).is_some() || program.number(right).is_some() => {
                    let (number, other) = match program.number(left) {
                        Some(number) => (number, right),
                        None => (program.number(right)?, left),
                    };
                    pending.push((other, factor * number));
                }
                _ => self.add_term(program, expr, factor)?,
            }
        }
        Some(())
    }

    fn add_term(&mut self, program: &Program, expr: ExprId, factor: f64) -> Option<()> {
        let shape = Shape::new(program.tree, expr)?;
        match self.terms.iter_mut().find(|term| term.shape == shape) {
            Some(term) => term.factor += factor,
            None => self.terms.push(Term { expr, shape, factor }),
        }
        Some(())
    }

    /// Whether no part of the expression is ever negative.
    fn is_never_negative(&self, program: &Program) -> bool {
        let mut terms = self.terms.iter().filter(|term| term.factor != 0.0);
        self.constant >= 0.0 && terms.all(|term| term.factor > 0.0 && is_never_negative(program, term.expr))
    }
}

/// Whether the value of an expression is never less than 0.
fn is_never_negative(program: &Program, expr: ExprId) -> bool {
    let tree = program.tree;
    let mut pending = vec![expr];
    for _ in 0..MAX_EXPRS {
        let Some(expr) = pending.pop() else {
            return true;
        };
        let expr = program.resolve(expr);
        if let Some(value) = program.number(expr) {
            if value < 0.0 {
                return false;
            }
            continue;
        }
        match &tree[expr].kind {
            ExprKind::Binary {
                op: BinaryOp::Add | BinaryOp::Multiply | BinaryOp::Divide,
                left,
                right,
            } => pending.extend([*left, *right]),
            ExprKind::BuiltIn { function, arguments } => match function {
                BuiltIn::Abs
                | BuiltIn::Length
                | BuiltIn::Distance
                | BuiltIn::Sqrt
                | BuiltIn::Exp
                | BuiltIn::Exp2
                | BuiltIn::Fwidth => {}
                BuiltIn::Min => pending.extend(arguments),
                _ => return false,
            },
            ExprKind::Swizzle { vector, .. } => match tree[*vector].kind {
                ExprKind::Variable(variable)
                    if tree[variable].kind == VariableKind::Input(Input::Resolution) => {}
                _ => return false,
            },
            _ => return false,
        }
    }
    false
}
