//! Lengths, angles, and products of vectors.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind};

use crate::rewrite::site::{Definitions, Term};

/// A dot product, perhaps twice or with another sign.
struct DotProduct {
    factor: f64,
    one: ExprId,
    other: ExprId,
}

fn dot_product(at: &Definitions<'_>, expr: ExprId) -> Option<DotProduct> {
    let mut factor = 1.0;
    let mut dot = None;
    let mut pending = vec![at.resolve(expr)];
    while let Some(expr) = pending.pop() {
        if let Some(operand) = at.negated(expr) {
            factor = -factor;
            pending.push(at.resolve(operand));
        } else if let Some((left, right)) = at.binary(expr, BinaryOp::Multiply) {
            pending.extend([at.resolve(left), at.resolve(right)]);
        } else if let Some(value) = at.literal(expr) {
            factor *= value;
        } else if let Some(&[one, other]) = at.call(expr, BuiltIn::Dot) {
            if dot.replace((one, other)).is_some() {
                return None;
            }
        } else {
            return None;
        }
    }
    let (one, other) = dot?;
    Some(DotProduct { factor, one, other })
}

/// `b * b - a * c` with b = k f·d and c = f·f − r² is `a * (r * r - dot(l, l))`, where the vector l from the
/// line to the center is `f - k b / a d`.
pub(super) fn discriminant(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((squared, product)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let form = || {
        let b = at.square(at.resolve(squared)).or_else(|| at.square(squared))?;
        let dot = dot_product(at, b)?;
        let factors = at.factors(product);
        // The factor f·f − r², and f.
        let (c, from) = factors.iter().find_map(|&factor| {
            let terms = at.terms(at.resolve(factor));
            let from = terms.iter().find_map(|term| {
                let &[one, other] = at.call(at.resolve(term.expr), BuiltIn::Dot)? else {
                    return None;
                };
                let is_square = !term.is_negative && at.same(one, other);
                (is_square && (at.same(one, dot.one) || at.same(one, dot.other))).then_some(one)
            })?;
            (terms.len() > 1).then_some((factor, from))
        })?;
        let terms = at.terms(at.resolve(c));
        let radius: Vec<Term> = terms
            .into_iter()
            .filter(|term| at.call(at.resolve(term.expr), BuiltIn::Dot).is_none())
            .map(|term| Term {
                is_negative: !term.is_negative,
                ..term
            })
            .collect();
        let direction = if at.same(from, dot.one) {
            dot.other
        } else {
            dot.one
        };
        let (f, d) = (at.text(from)?, at.text(direction)?);
        let radius = at.sum(&radius)?;
        let b = at.text(b)?;
        let others = factors.iter().filter(|&&factor| factor != c);
        let others: Vec<String> = others.map(|&factor| at.text(factor)).collect::<Option<_>>()?;
        let a = others.join(" * ");
        let k = if dot.factor == 1.0 {
            String::new()
        } else {
            format!("{:?} * ", dot.factor)
        };
        let part = match (k.is_empty(), a.is_empty()) {
            (true, true) => b,
            (false, true) => format!("({k}{b})"),
            (_, false) => format!("({k}{b} / ({a}))"),
        };
        let line = format!("{f} - {part} * {d}");
        let rest = format!("({radius} - dot({line}, {line}))");
        Some(if a.is_empty() {
            rest
        } else {
            format!("({a} * {rest})")
        })
    };
    vec![form()]
}

/// `dot(n, p) - dot(n, q)` is `dot(n, p - q)`, and `dot(p, p) - dot(q, q)` is `dot(p - q, p + q)`.
pub(super) fn dot_difference(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    if at
        .binary(expr, BinaryOp::Add)
        .or(at.binary(expr, BinaryOp::Subtract))
        .is_none()
    {
        return Vec::new();
    }
    // A variable may be a negated dot product.
    let terms = at
        .terms(expr)
        .into_iter()
        .map(|term| match at.terms(at.resolve(term.expr))[..] {
            [inner] => Term {
                is_negative: term.is_negative != inner.is_negative,
                expr: inner.expr,
            },
            _ => term,
        });
    let terms: Vec<Term> = terms.collect();
    let dot = |term: &Term| match at.call(at.resolve(term.expr), BuiltIn::Dot)? {
        &[one, other] => Some((one, other)),
        _ => None,
    };
    let mut forms = Vec::new();
    for (first, one) in terms.iter().enumerate().filter(|(_, term)| !term.is_negative) {
        for (second, other) in terms.iter().enumerate().filter(|(_, term)| term.is_negative) {
            let Some(((a, b), (c, d))) = dot(one).zip(dot(other)) else {
                continue;
            };
            let rest = terms
                .iter()
                .enumerate()
                .filter(|&(at, _)| at != first && at != second);
            let rest: Vec<Term> = rest.map(|(_, term)| *term).collect();
            let with_rest = |form: String| {
                if rest.is_empty() {
                    return Some(form);
                }
                Some(format!("({form} + {})", at.sum(&rest)?))
            };
            let common = |shared: ExprId, other: ExprId, p: ExprId, q: ExprId| {
                let form = format!("dot({}, {})", at.text(shared)?, at.minus(p, q)?);
                with_rest(form).filter(|_| at.same(shared, other))
            };
            let squares = || {
                let form = format!("dot({}, {} + {})", at.minus(a, c)?, at.text(a)?, at.text(c)?);
                with_rest(form).filter(|_| at.same(a, b) && at.same(c, d))
            };
            forms.extend([
                squares(),
                common(a, c, b, d),
                common(a, d, b, c),
                common(b, c, a, d),
                common(b, d, a, c),
            ]);
        }
    }
    forms
}

/// `length(p + c) - r` is `(dot(p, p + 2 c) + (dot(c, c) - r * r)) / (length(p + c) + r)`, where p is small.
pub(super) fn far_distance(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((distance, radius)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let Some(vector) = at.argument(at.resolve(distance), BuiltIn::Length) else {
        return Vec::new();
    };
    let terms = at.terms(at.resolve(vector));
    let form = |center: usize| {
        let c = at.sum(&terms[center..=center])?;
        let p = terms
            .iter()
            .enumerate()
            .filter(|&(at, _)| at != center)
            .map(|(_, term)| *term);
        let p = at.sum(&p.collect::<Vec<_>>())?;
        let (distance, r) = (at.text(distance)?, at.text(radius)?);
        Some(format!(
            "((dot({p}, {p} + 2.0 * {c}) + (dot({c}, {c}) - {r} * {r})) / ({distance} + {r}))"
        ))
    };
    if terms.len() < 2 {
        return Vec::new();
    }
    (0..terms.len()).map(form).collect()
}

/// `acos(dot(a, b))` of unit vectors is `2.0 * atan(length(a - b), length(a + b))` (Kahan, section 12).
pub(super) fn angle(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = || {
        let cosine = at.unclamped(at.argument(expr, BuiltIn::Acos)?);
        let &[a, b] = at.call(at.resolve(cosine), BuiltIn::Dot)? else {
            return None;
        };
        let (a, b) = (at.text(a)?, at.text(b)?);
        Some(format!("(2.0 * atan(length({a} - {b}), length({a} + {b})))"))
    };
    vec![form()]
}

/// Of unit vectors, `1.0 - dot(a, b)` is half the square of their distance, and `1.0 - dot(a, b) * dot(a, b)`
/// the square of their cross product (Lagrange's identity), also in `d * d * (k - 1.0) + 1.0`.
pub(super) fn nearly_parallel(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let dot = |expr: ExprId| match at.call(at.resolve(expr), BuiltIn::Dot)? {
        &[a, b] => Some((at.text(a)?, at.text(b)?, at.components(a)?)),
        _ => None,
    };
    // 1 − the square of a dot product.
    let squared_sine = |squared: ExprId| {
        let (a, b, size) = dot(at.square(at.resolve(squared)).or_else(|| at.square(squared))?)?;
        match size {
            2 => {
                let cross = format!("({a}.x * {b}.y - {a}.y * {b}.x)");
                Some(format!("({cross} * {cross})"))
            }
            3 => Some(format!("dot(cross({a}, {b}), cross({a}, {b}))")),
            _ => None,
        }
    };
    let is_one = |expr: ExprId| at.is_literal(expr, 1.0);
    if let Some((unit, other)) = at.binary(expr, BinaryOp::Subtract) {
        let chord = || {
            let (a, b, _) = dot(other)?;
            Some(format!("(0.5 * dot({a} - {b}, {a} - {b}))"))
        };
        // `dot(v, v) - dot(v, d) * dot(v, d)`, the square of the distance from a line.
        let across = || {
            let (v, same, _) = dot(unit)?;
            let along = at.square(at.resolve(other)).or_else(|| at.square(other))?;
            let (a, b, _) = dot(along)?;
            let direction = if a == v { b } else { a.clone() };
            let along = at.text(along)?;
            let rest = format!("({v} - {along} * {direction})");
            (v == same && direction != v && (a == v || direction == a))
                .then(|| format!("dot({rest}, {rest})"))
        };
        return if is_one(unit) {
            vec![chord(), squared_sine(other)]
        } else {
            vec![across()]
        };
    }
    let Some((one, other)) = at.binary(expr, BinaryOp::Add) else {
        return Vec::new();
    };
    let product = if is_one(other) { one } else { other };
    let Some((left, right)) = at.binary(at.resolve(product), BinaryOp::Multiply) else {
        return Vec::new();
    };
    let form = |squared: ExprId, factor: ExprId| {
        let (k, unit) = at.binary(at.resolve(factor), BinaryOp::Subtract)?;
        let (squared_text, k) = (at.text(squared)?, at.text(k)?);
        let is_known = is_one(unit) && (is_one(one) || is_one(other));
        Some(format!("({squared_text} * {k} + {})", squared_sine(squared)?)).filter(|_| is_known)
    };
    vec![form(left, right), form(right, left)]
}

/// `cross(a, b)` is `cross(a, b - a)`, whose arguments are not nearly parallel.
pub(super) fn cross_product(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some(&[a, b]) = at.call(expr, BuiltIn::Cross) else {
        return Vec::new();
    };
    let form = || Some(format!("cross({}, {})", at.text(a)?, at.minus(b, a)?));
    vec![form()]
}

/// `s * (s - a) * (s - b) * (s - c)` with s = (a + b + c) / 2, the square of the area of a triangle, from its
/// sides by length (Kahan, “Miscalculating Area and Angles of a Needle-like Triangle”, 1986).
pub(super) fn triangle_area(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let factors = at.factors(expr);
    if factors.len() != 4 {
        return Vec::new();
    }
    // Half the sum of three sides.
    let sides = |expr: ExprId| {
        let expr = at.resolve(expr);
        let sum = if let Some((sum, two)) = at.binary(expr, BinaryOp::Divide) {
            at.is_literal(two, 2.0).then_some(sum)?
        } else {
            let (one, other) = at.binary(expr, BinaryOp::Multiply)?;
            match (at.literal(one), at.literal(other)) {
                (Some(0.5), None) => other,
                (None, Some(0.5)) => one,
                _ => return None,
            }
        };
        let terms = at.terms(at.resolve(sum));
        let is_sum = terms.len() == 3 && terms.iter().all(|term| !term.is_negative);
        is_sum.then(|| [0, 1, 2].map(|side| terms[side].expr))
    };
    let form = || {
        let (half, sides) = factors.iter().find_map(|&half| Some((half, sides(half)?)))?;
        let subtracted = factors.iter().filter(|&&factor| factor != half).map(|&factor| {
            let (one, side) = at.binary(at.resolve(factor), BinaryOp::Subtract)?;
            at.same(one, half).then_some(side)
        });
        let subtracted = subtracted.collect::<Option<Vec<_>>>()?;
        let is_side = |side: &ExprId| subtracted.iter().any(|&one| at.same(one, *side));
        let [a, b, c] = sides.iter().all(is_side).then_some(sides)?;
        let (a, b, c) = (at.text(a)?, at.text(b)?, at.text(c)?);
        let high = format!("max(max({a}, {b}), {c})");
        let middle = format!("max(min({a}, {b}), min(max({a}, {b}), {c}))");
        let low = format!("min(min({a}, {b}), {c})");
        Some(format!(
            "(0.0625 * ({high} + ({middle} + {low})) * ({low} - ({high} - {middle})) \
             * ({low} + ({high} - {middle})) * ({high} + ({middle} - {low})))"
        ))
    };
    vec![form()]
}

/// `a.x * b.y - a.y * b.x + b.x * c.y - b.y * c.x + c.x * a.y - c.y * a.x`, twice the area of a triangle, is
/// the cross product of two of its sides.
pub(super) fn triangle_of_points(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let terms = at.all_terms(expr);
    if terms.len() != 6 {
        return Vec::new();
    }
    let component = |expr: ExprId, wanted: u8| match &at.tree[expr].kind {
        ExprKind::Swizzle { vector, components } if components.components() == [wanted] => at.text(*vector),
        _ => None,
    };
    // The points of each product of an x and a y.
    let products = || {
        let points = terms.iter().map(|term| {
            let (left, right) = at.binary(term.expr, BinaryOp::Multiply)?;
            let x_and_y = |x, y| component(x, 0).zip(component(y, 1));
            let points = x_and_y(left, right).or_else(|| x_and_y(right, left))?;
            Some((term.is_negative, points))
        });
        points.collect::<Option<Vec<_>>>()
    };
    let form = || {
        let products = products()?;
        let is_there = |is_negative: bool, x: &String, y: &String| {
            products
                .iter()
                .any(|(sign, (a, b))| *sign == is_negative && a == x && b == y)
        };
        let (_, (a, b)) = products.iter().find(|(is_negative, _)| !is_negative)?;
        let (_, (_, c)) = products
            .iter()
            .find(|(is_negative, (from, _))| !is_negative && from == b)?;
        let edges = [(a, b), (b, c), (c, a)];
        let is_triangle = edges
            .iter()
            .all(|(from, to)| is_there(false, from, to) && is_there(true, to, from));
        let cross = format!("(({b}.x - {a}.x) * ({c}.y - {a}.y) - ({b}.y - {a}.y) * ({c}.x - {a}.x))");
        is_triangle.then_some(cross)
    };
    vec![form()]
}

/// `dot(n, p + q) - w` is `dot(n, p) + (dot(n, q) - w)`, where q is far away, and w its distance.
pub(super) fn dot_of_sum(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((product, subtracted)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let Some(&[one, other]) = at.call(at.resolve(product), BuiltIn::Dot) else {
        return Vec::new();
    };
    let form = |shared: ExprId, terms: &[Term], far: usize| {
        let rest = terms.iter().enumerate().filter(|&(at, _)| at != far);
        let rest = at.sum(&rest.map(|(_, term)| *term).collect::<Vec<_>>())?;
        let (n, far, w) = (at.text(shared)?, at.sum(&terms[far..=far])?, at.text(subtracted)?);
        Some(format!("(dot({n}, {rest}) + (dot({n}, {far}) - {w}))"))
    };
    let mut forms = Vec::new();
    for (shared, sum) in [(one, other), (other, one)] {
        let terms = at.terms(at.resolve(sum));
        if terms.len() > 1 {
            forms.extend((0..terms.len()).map(|far| form(shared, &terms, far)));
        }
    }
    forms
}

/// The largest of some sizes, which is not 0.
fn scale(sizes: impl Iterator<Item = String>) -> Option<String> {
    let largest = sizes.reduce(|one, other| format!("max({one}, {other})"))?;
    Some(format!("max({largest}, 1.0e-37)"))
}

/// Lengths and directions of the vector divided by its largest component, whose square is neither too large
/// nor too small for a float: `length(v)`, `sqrt(dot(v, v))`, `sqrt(x * x + y * y)`, `normalize(v)` and `v /
/// length(v)`.
pub(super) fn scaled_length(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let square = |expr: ExprId| match at.call(at.resolve(expr), BuiltIn::Dot)? {
        &[one, other] => at.same(one, other).then_some(one),
        _ => None,
    };
    let norm = |expr: ExprId| {
        let root = || square(at.argument(expr, BuiltIn::Sqrt)?);
        at.argument(expr, BuiltIn::Length).or_else(root)
    };
    let scaled = |vector: ExprId| {
        let size = at.components(vector).filter(|&size| size > 1)?;
        let v = at.text(vector)?;
        let components = ["x", "y", "z", "w"].iter().take(usize::from(size));
        let scale = scale(components.map(|component| format!("abs({v}.{component})")))?;
        Some((format!("{v} / {scale}"), scale))
    };
    let length = || {
        let (scaled, scale) = scaled(norm(expr)?)?;
        Some(format!("({scale} * length({scaled}))"))
    };
    let direction = || {
        let divided = || {
            let (vector, length) = at.binary(expr, BinaryOp::Divide)?;
            let own = norm(at.resolve(length))?;
            at.same(own, vector).then_some(vector)
        };
        let multiplied = |vector: ExprId, inverse: ExprId| {
            let own = square(at.argument(at.resolve(inverse), BuiltIn::InverseSqrt)?)?;
            at.same(own, vector).then_some(vector)
        };
        let by_inverse = || {
            let (one, other) = at.binary(expr, BinaryOp::Multiply)?;
            multiplied(one, other).or_else(|| multiplied(other, one))
        };
        let normalized = at.argument(expr, BuiltIn::Normalize);
        let (scaled, _) = scaled(normalized.or_else(divided).or_else(by_inverse)?)?;
        Some(format!("normalize({scaled})"))
    };
    let root_of_squares = || {
        let terms = at.terms(at.resolve(at.argument(expr, BuiltIn::Sqrt)?));
        let roots = terms.iter().map(|term| {
            let square = at
                .square(term.expr)
                .or_else(|| at.square(at.resolve(term.expr)))?;
            at.text(square).filter(|_| !term.is_negative)
        });
        let roots: Vec<String> = roots.collect::<Option<_>>()?;
        let scale = scale(roots.iter().map(|root| format!("abs({root})")))?;
        let squares: Vec<_> = roots
            .iter()
            .map(|root| format!("({root} / {scale}) * ({root} / {scale})"))
            .collect();
        (at.is_float(expr) && roots.len() > 1).then(|| format!("({scale} * sqrt({}))", squares.join(" + ")))
    };
    vec![direction(), length(), root_of_squares()]
}
