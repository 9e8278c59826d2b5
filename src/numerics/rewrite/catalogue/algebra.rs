//! Sums, products, roots and quotients of numbers.

use toyproof_diagnostic::{Edit, Span};
use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, Swizzle};

use crate::rewrite::site::{Definitions, Term};

/// `a + b - a` is b.
pub(super) fn cancelling_terms(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let is_sum = at
        .binary(expr, BinaryOp::Add)
        .or(at.binary(expr, BinaryOp::Subtract));
    let Some((one, other)) = is_sum else {
        return Vec::new();
    };
    if at.binary(expr, BinaryOp::Subtract).is_some() {
        return vec![at.difference(one, other)];
    }
    vec![at.cancelled(at.terms(expr)).and_then(|rest| at.sum(&rest))]
}

/// The x of x², where 1 is a square as well.
fn square_root(at: &Definitions<'_>, expr: ExprId) -> Option<String> {
    if at.is_literal(expr, 1.0) {
        return Some("1.0".to_owned());
    }
    at.text(at.square(expr)?)
}

/// `x * x - y * y` is `(x - y) * (x + y)`.
pub(super) fn difference_of_squares(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let form = || {
        let (x, y) = (square_root(at, one)?, square_root(at, other)?);
        let difference = at
            .square(one)
            .zip(at.square(other))
            .and_then(|(one, other)| at.difference(one, other));
        let difference = difference.unwrap_or_else(|| format!("({x} - {y})"));
        Some(format!("({difference} * ({x} + {y}))"))
    };
    // `1 - c²` of a cosine is the square of the sine.
    let sine = || {
        let cosine = at.argument(at.resolve(at.square(other)?), BuiltIn::Cos)?;
        let angle = at.text(cosine)?;
        at.is_literal(one, 1.0)
            .then(|| format!("(sin({angle}) * sin({angle}))"))
    };
    vec![form(), sine()]
}

/// `u - s` and `u + s` with s² = u² − k are `k / (u + s)` and `k / (u - s)`: of both forms, the one in which
/// nothing cancels.
pub(super) fn quadratic_root(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let add = at.binary(expr, BinaryOp::Add);
    let Some((one, other)) = add.or(at.binary(expr, BinaryOp::Subtract)) else {
        return Vec::new();
    };
    if !at.is_float(expr) {
        return Vec::new();
    }
    let form = |u: ExprId, s: ExprId, is_sum: bool| {
        let radicand = at.argument(at.resolve(s), BuiltIn::Sqrt)?;
        let terms = at.terms(at.resolve(radicand));
        let inner = at.negated(u).unwrap_or(u);
        let own = terms.iter().position(|term| {
            let square = at.square(at.resolve(term.expr)).or_else(|| at.square(term.expr));
            !term.is_negative
                && square
                    .is_some_and(|root| at.same(root, inner) || at.same(at.resolve(root), at.resolve(inner)))
        })?;
        let rest = terms.iter().enumerate().filter(|&(at, _)| at != own);
        let rest = rest.map(|(_, term)| Term {
            is_negative: !term.is_negative,
            ..*term
        });
        let k = at.sum(&rest.collect::<Vec<_>>())?;
        let (u, s) = (at.text(u)?, at.text(s)?);
        Some(if is_sum {
            format!("({u} < 0.0 ? {k} / ({u} - {s}) : {u} + {s})")
        } else {
            format!("({u} > 0.0 ? {k} / ({u} + {s}) : {u} - {s})")
        })
    };
    if add.is_some() {
        vec![form(one, other, true), form(other, one, true)]
    } else {
        vec![form(one, other, false)]
    }
}

/// `sqrt(a) - b` is `(a - b * b) / (sqrt(a) + b)`, where a and b² have a term in common; and the difference
/// of two roots or lengths.
pub(super) fn conjugate(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    if !at.is_float(expr) {
        return Vec::new();
    }
    let radicand = |expr: ExprId| at.argument(at.resolve(expr), BuiltIn::Sqrt);
    let length = |expr: ExprId| at.argument(at.resolve(expr), BuiltIn::Length);
    let over = |numerator: String| {
        let (one, other) = (at.text(one)?, at.text(other)?);
        Some(format!("({numerator} / ({one} + {other}))"))
    };
    // Where b is negative, nothing cancels.
    let by_sign = |b: ExprId, form: Option<String>| {
        let (one, other, b) = (at.text(one)?, at.text(other)?, at.text(b)?);
        Some(format!("({b} > 0.0 ? {} : {one} - {other})", form?))
    };
    // A root, and the terms of a square that it contains, or that is near to one which it contains.
    let with_square = |root: ExprId, b: ExprId, sign: &str| {
        let terms = at.terms(at.resolve(radicand(root)?));
        let (own, factors) = terms.iter().enumerate().find_map(|(own, term)| {
            if term.is_negative {
                return None;
            }
            if at.is_literal(b, 1.0) && at.is_literal(term.expr, 1.0) {
                return Some((own, None));
            }
            let x = at.square(at.resolve(term.expr))?;
            if at.same(x, b) {
                return Some((own, None));
            }
            let (difference, x, b) = (at.difference(x, b)?, at.text(x)?, at.text(b)?);
            Some((own, Some(format!("{difference} * ({x} + {b})"))))
        })?;
        let rest = terms.iter().enumerate().filter(|&(at, _)| at != own);
        let rest: Vec<Term> = rest.map(|(_, term)| *term).collect();
        over(match (at.sum(&rest), factors) {
            (Some(rest), None) => format!("{sign}{rest}"),
            (Some(rest), Some(factors)) => format!("{sign}({rest} + {factors})"),
            (None, factors) => format!("{sign}{}", factors?),
        })
    };
    let two_roots = || over(at.difference(radicand(one)?, radicand(other)?)?);
    let two_lengths = || {
        let (a, b) = (at.text(length(one)?)?, at.text(length(other)?)?);
        over(format!("dot({a} - {b}, {a} + {b})"))
    };
    // The length of a vector, and one of its components.
    let with_component = |norm: ExprId, component: ExprId, sign: &str| {
        let vector = length(norm)?;
        let ExprKind::Swizzle {
            vector: own,
            components,
        } = at.tree[at.resolve(component)].kind
        else {
            return None;
        };
        let others = (0..at.components(vector)?).filter(|one| !components.components().contains(one));
        let others = Swizzle::new(&others.collect::<Vec<_>>())?.name();
        let v = at.text(vector)?;
        let is_own = at.same(own, vector) && components.size() == 1;
        over(format!("{sign}dot({v}.{others}, {v}.{others})")).filter(|_| is_own)
    };
    let of_root = [with_square(one, other, ""), with_component(one, other, "")];
    let from_root = [with_square(other, one, "-"), with_component(other, one, "-")];
    let mut forms = vec![two_roots(), two_lengths()];
    for (b, of_sign) in [(other, of_root), (one, from_root)] {
        forms.extend(of_sign.iter().cloned());
        forms.extend(of_sign.map(|form| by_sign(b, form)));
    }
    forms
}

/// The square of the difference of the eigenvalues of a symmetric matrix, `(a + b) * (a + b) - 4.0 * (a * b -
/// k)`, is `(a - b) * (a - b) + 4.0 * k`.
pub(super) fn eigenvalues(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = || {
        let (squared, product) = at.binary(expr, BinaryOp::Subtract)?;
        let trace = at.square(at.resolve(squared)).or_else(|| at.square(squared))?;
        let [a, b] = at.terms(at.resolve(trace))[..] else {
            return None;
        };
        let determinant = match at.factors(product)[..] {
            [four, one] if at.is_literal(four, 4.0) => one,
            [one, four] if at.is_literal(four, 4.0) => one,
            _ => return None,
        };
        let terms = at.terms(at.resolve(determinant));
        let own = terms.iter().position(|term| {
            let factors = at.factors(at.resolve(term.expr));
            let is_product = |one, other| at.same(factors[0], one) && at.same(factors[1], other);
            !term.is_negative
                && factors.len() == 2
                && (is_product(a.expr, b.expr) || is_product(b.expr, a.expr))
        })?;
        let rest = terms.iter().enumerate().filter(|&(at, _)| at != own);
        let rest = rest.map(|(_, term)| Term {
            is_negative: !term.is_negative,
            ..*term
        });
        let difference = at.minus(a.expr, b.expr)?;
        let k = at.sum(&rest.collect::<Vec<_>>())?;
        let is_sum = !a.is_negative && !b.is_negative;
        is_sum.then(|| format!("({difference} * {difference} + 4.0 * {k})"))
    };
    vec![form()]
}

/// `x * y - z * w` is `x * (y - z) - z * (w - x)`: of vectors that are nearly parallel, and differ by a small
/// one.
pub(super) fn difference_of_products(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let product = |expr| at.binary(at.resolve(expr), BinaryOp::Multiply);
    let products = at
        .binary(expr, BinaryOp::Subtract)
        .filter(|_| at.is_float(expr))
        .and_then(|(one, other)| product(one).zip(product(other)));
    let Some(((a, b), (c, d))) = products else {
        return Vec::new();
    };
    let form = |x, y, z, w| {
        let (x_text, z_text) = (at.text(x)?, at.text(z)?);
        let (first, second) = (at.minus(y, z)?, at.minus(w, x)?);
        Some(format!("({x_text} * {first} - {z_text} * {second})"))
    };
    vec![
        form(a, b, c, d),
        form(a, b, d, c),
        form(b, a, c, d),
        form(b, a, d, c),
    ]
}

/// `(a + b) - c` is `(a - c) + b`, and `a + (b - c)`.
pub(super) fn reassociated(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let terms = at.terms(at.resolve(one));
    if terms.len() < 2 {
        return Vec::new();
    }
    let form = |first: usize| {
        let subtracted = at.text(other)?;
        let own = at.sum(&terms[first..=first])?;
        let rest = terms
            .iter()
            .enumerate()
            .filter(|&(at, _)| at != first)
            .map(|(_, term)| *term);
        let rest = at.sum(&rest.collect::<Vec<_>>())?;
        Some(format!("(({own} - {subtracted}) + {rest})"))
    };
    (0..terms.len().min(3)).map(form).collect()
}

/// `1.0 / x - 1.0 / y` is `(y - x) / (x * y)`.
pub(super) fn reciprocals(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let form = || {
        let (a, x) = at.binary(at.resolve(one), BinaryOp::Divide)?;
        let (b, y) = at.binary(at.resolve(other), BinaryOp::Divide)?;
        let (x_text, y_text) = (at.text(x)?, at.text(y)?);
        let (difference, a_text) = (at.minus(y, x)?, at.text(a)?);
        at.same(a, b)
            .then(|| format!("({a_text} * {difference} / ({x_text} * {y_text}))"))
    };
    vec![form()]
}

/// `a + (b - a) * t` is `a * (1.0 - t) + b * t`.
pub(super) fn weighted_mean(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((start, product)) = at.binary(expr, BinaryOp::Add) else {
        return Vec::new();
    };
    let form = |difference: ExprId, weight: ExprId| {
        let (end, subtracted) = at.binary(at.resolve(difference), BinaryOp::Subtract)?;
        let (a, b, t) = (at.text(start)?, at.text(end)?, at.text(weight)?);
        at.same(start, subtracted)
            .then(|| format!("({a} * (1.0 - {t}) + {b} * {t})"))
    };
    match at.binary(product, BinaryOp::Multiply) {
        Some((left, right)) => vec![form(left, right), form(right, left)],
        None => Vec::new(),
    }
}

/// The mean of squares minus the square of the mean, `q / n - m * m` with `q += v * v`: both of the
/// differences from the first sample (Chan, Golub and `LeVeque`, “Algorithms for Computing the Sample
/// Variance”, 1983, eq. 1.3).
pub(in crate::rewrite) fn shifted_variance(at: &Definitions<'_>, expr: ExprId) -> Option<Vec<Edit>> {
    let (mean_of_squares, squared_mean) = at.binary(expr, BinaryOp::Subtract)?;
    let mean = at
        .square(squared_mean)
        .or_else(|| at.square(at.resolve(squared_mean)))?;
    let read = at.tree.postorder(at.resolve(mean_of_squares));
    let (name, added, initial) = read.into_iter().find_map(|read| match at.tree[read].kind {
        ExprKind::Variable(variable) => {
            let initial = at.tree[variable].initializer?;
            Some((&at.tree[variable].name, at.added(variable)?, initial))
        }
        _ => None,
    })?;
    let ExprKind::Assign { target, value, .. } = at.tree[added].kind else {
        return None;
    };
    let (sum, v, m) = (at.text(target)?, at.text(at.square(value)?)?, at.text(mean)?);
    let first = format!("first_{name}");
    let zero = match at.components(target)? {
        1 => "0.0".to_owned(),
        size => format!("vec{size}(0.0)"),
    };
    let mean_of_squares = at.text(mean_of_squares)?;
    let place = |expr: ExprId| at.tree[expr].at.spelling;
    let declared = place(initial);
    let edits = [
        (
            place(expr),
            format!("({mean_of_squares} - ({m} - {first}) * ({m} - {first}))"),
        ),
        (
            place(added),
            format!(
                "{first} = {first} == {zero} ? {v} : {first}, {sum} += ({v} - {first}) * ({v} - {first})"
            ),
        ),
        (
            Span::new(declared.file, declared.end, declared.end),
            format!(", {first} = {zero}"),
        ),
    ];
    let edits = edits
        .into_iter()
        .map(|(span, replacement)| Edit { span, replacement });
    Some(edits.collect())
}

/// The largest number that is taken for the step of a difference quotient.
const MAX_STEP: f64 = 0.01;

/// A small number, several times as large.
pub(super) fn larger_step(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some(value) = at.literal(expr).filter(|&value| value > 0.0 && value < MAX_STEP) else {
        return Vec::new();
    };
    if !at.is_step(expr) {
        return Vec::new();
    }
    let is_float = at.is_float(expr);
    let factors = [3.0, 10.0, 30.0, 100.0, 300.0];
    factors
        .map(|factor| is_float.then(|| format!("{:?}", (value * factor) as f32)))
        .into()
}
