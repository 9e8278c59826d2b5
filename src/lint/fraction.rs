//! `float(1 / 3)`, which is 0: a division of integers drops the fraction before the conversion.

use toyproof_diagnostic::{Code, Fix};
use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Literal, Value};

use super::Findings;
use super::program::{Program, is_float};

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    for expr in program.all_exprs() {
        let ExprKind::Construct { arguments, .. } = &tree[expr].kind else {
            continue;
        };
        if !is_float(tree[expr].ty) {
            continue;
        }
        for &argument in arguments {
            report(program, argument, findings);
        }
    }
}

/// Reports a quotient of two integer literals with a remainder.
fn report(program: &Program, quotient: ExprId, findings: &mut Findings) {
    let tree = program.tree;
    let ExprKind::Binary {
        op: BinaryOp::Divide,
        left,
        right,
    } = tree[quotient].kind
    else {
        return;
    };
    let literal = |expr: ExprId| match &tree[expr].kind {
        ExprKind::Literal(literal) => integer(literal).map(|value| (value, &*literal.text)),
        _ => None,
    };
    let (Some((a, a_text)), Some((b, b_text))) = (literal(left), literal(right)) else {
        return;
    };
    if b == 0 || a % b == 0 {
        return;
    }
    let at = tree[quotient].at;
    let message = format!(
        "this division of integers is {}, not {}: the fraction is lost before the conversion to `float`",
        a / b,
        super::format_number(a as f64 / b as f64)
    );
    findings.add(Code::IntegerDivision, at, message, |diagnostic| {
        let is_decimal = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        let text = format!("{a}.0 / {b}.0");
        if at.is_expanded() || !is_decimal(a_text) || !is_decimal(b_text) {
            return diagnostic.help(format!("write `{text}`"));
        }
        let [left, right] = [left, right].map(|operand| tree[operand].at.span);
        let fix = Fix::new(format!("write `{text}`"), left, format!("{a}.0"));
        diagnostic.fix(fix.and(right, format!("{b}.0")))
    });
}

fn integer(literal: &Literal) -> Option<i64> {
    match literal.value {
        Value::Int(value) => Some(value.into()),
        Value::Uint(value) => Some(value.into()),
        _ => None,
    }
}
