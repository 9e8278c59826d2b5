//! The catalogue of identities: forms of an expression that are equal to it, but lose fewer digits for some
//! values. Which form is better is not decided here, but measured.
//!
//! Sources: Higham, Accuracy and Stability of Numerical Algorithms, 2nd edition (2002), chapter 1; Goldberg,
//! “What Every Computer Scientist Should Know About Floating-Point Arithmetic” (1991), sections 1.4 and 4;
//! Haines, Günther and Akenine-Möller, “Precision Improvements for Ray/Sphere Intersection”, Ray Tracing Gems
//! (2019), chapter 7; Kahan, “How Futile are Mindless Assessments of Roundoff in Floating-Point Computation?”
//! (2006), section 12.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId};

use super::site::{Definitions, Term};

/// An identity: other forms of an expression, in parentheses where needed.
pub(super) struct Rule {
    /// The identity, as users know it.
    pub(super) name: &'static str,
    /// Whether the new form has the same value in exact arithmetic. Otherwise it is one whose error of
    /// approximation may be smaller than that of rounding.
    pub(super) is_exact: bool,
    pub(super) forms: fn(&Definitions<'_>, ExprId) -> Vec<Option<String>>,
}

const fn rule(name: &'static str, forms: fn(&Definitions<'_>, ExprId) -> Vec<Option<String>>) -> Rule {
    Rule {
        name,
        is_exact: true,
        forms,
    }
}

/// All identities; the first ones keep the form of a shader best.
pub(super) const RULES: &[Rule] = &[
    rule("terms that cancel exactly", cancelling_terms),
    rule("a difference of squares as a product", difference_of_squares),
    rule(
        "the distance of the center from the ray as a vector",
        discriminant,
    ),
    rule("the root that cancels from the one that does not", quadratic_root),
    rule("the conjugate of a difference of roots", conjugate),
    rule("half angles", one_minus_cosine),
    rule(
        "a difference of sines and cosines as a product",
        trigonometric_difference,
    ),
    rule("differences before sums", reassociated),
    rule("the difference of the arguments of dot products", dot_difference),
    rule("the distance from a far center by its squares", far_distance),
    rule("the haversine of an angle on a sphere", haversine),
    rule("an angle from both of its sides", angle),
    rule("a difference of reciprocals over their product", reciprocals),
    rule("exp(x) - 1 by its series near 0", exponential_minus_one),
    rule("log(1 + x) as Kahan computes it", logarithm_of_one_plus),
    rule("one exponential instead of several", exponentials),
    rule("a weighted mean of both ends", weighted_mean),
    rule("scaled by the largest component", scaled_length),
    rule("powers of the ratio of two numbers", scaled_powers),
    Rule {
        name: "a larger step of a difference quotient",
        is_exact: false,
        forms: larger_step,
    },
];

/// `a + b - a` is b.
fn cancelling_terms(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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
fn difference_of_squares(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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
fn discriminant(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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

/// `u - s` and `u + s` with s² = u² − k are `k / (u + s)` and `k / (u - s)`: of both forms, the one in which
/// nothing cancels.
fn quadratic_root(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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

/// `sqrt(a) - b` is `(a - b * b) / (sqrt(a) + b)`, where a and b² have a term in common; and the difference of
/// two roots or lengths.
fn conjugate(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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
    // A root, and the terms of a square that it contains.
    let with_square = |root: ExprId, b: ExprId, sign: &str| {
        let terms = at.terms(at.resolve(radicand(root)?));
        let own = terms.iter().position(|term| {
            let is_one = at.is_literal(b, 1.0) && at.is_literal(term.expr, 1.0);
            let root = at.square(at.resolve(term.expr));
            !term.is_negative && (is_one || root.is_some_and(|root| at.same(root, b)))
        })?;
        let rest: Vec<Term> = terms
            .iter()
            .enumerate()
            .filter(|&(at, _)| at != own)
            .map(|(_, term)| *term)
            .collect();
        over(format!("{sign}{}", at.sum(&rest)?))
    };
    let two_roots = || over(at.difference(radicand(one)?, radicand(other)?)?);
    let two_lengths = || {
        let (a, b) = (at.text(length(one)?)?, at.text(length(other)?)?);
        over(format!("dot({a} - {b}, {a} + {b})"))
    };
    vec![
        with_square(one, other, ""),
        with_square(other, one, "-"),
        two_roots(),
        two_lengths(),
    ]
}

/// `1.0 - cos(x)` is `2.0 * sin(x / 2) * sin(x / 2)`.
fn one_minus_cosine(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let form = |unit: ExprId, cosine: ExprId, factor: &str| {
        let angle = at.text(at.argument(at.resolve(cosine), BuiltIn::Cos)?)?;
        at.is_literal(unit, 1.0)
            .then(|| format!("({factor} * sin(0.5 * {angle}) * sin(0.5 * {angle}))"))
    };
    vec![form(one, other, "2.0"), form(other, one, "-2.0")]
}

/// `sin(a) - sin(b)`, `cos(a) - cos(b)` and `tan(a) - tan(b)` as products with the sine of `a - b`.
fn trigonometric_difference(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let form = |function: BuiltIn| {
        let a = at.argument(at.resolve(one), function)?;
        let b = at.argument(at.resolve(other), function)?;
        let (a_text, b_text) = (at.text(a)?, at.text(b)?);
        let difference = at
            .difference(a, b)
            .unwrap_or_else(|| format!("({a_text} - {b_text})"));
        Some(match function {
            BuiltIn::Sin => format!("(2.0 * cos(0.5 * ({a_text} + {b_text})) * sin(0.5 * {difference}))"),
            BuiltIn::Cos => format!("(-2.0 * sin(0.5 * ({a_text} + {b_text})) * sin(0.5 * {difference}))"),
            BuiltIn::Tan => format!("(sin({difference}) / (cos({a_text}) * cos({b_text})))"),
            _ => format!("atan({difference} / (1.0 + {a_text} * {b_text}))"),
        })
    };
    [BuiltIn::Sin, BuiltIn::Cos, BuiltIn::Tan, BuiltIn::Atan]
        .into_iter()
        .map(form)
        .collect()
}

/// `(a + b) - c` is `(a - c) + b`, and `a + (b - c)`.
fn reassociated(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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

/// `dot(n, p) - dot(n, q)` is `dot(n, p - q)`, and `dot(p, p) - dot(q, q)` is `dot(p - q, p + q)`.
fn dot_difference(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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
    let difference = |one: ExprId, other: ExprId| {
        let plain = || Some(format!("({} - {})", at.text(one)?, at.text(other)?));
        at.difference(one, other).or_else(plain)
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
                let form = format!("dot({}, {})", at.text(shared)?, difference(p, q)?);
                with_rest(form).filter(|_| at.same(shared, other))
            };
            let squares = || {
                let form = format!("dot({}, {} + {})", difference(a, c)?, at.text(a)?, at.text(c)?);
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
fn far_distance(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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

/// `acos(sin(a) * sin(b) + cos(a) * cos(b) * cos(c))` by the squares of the sines of half the differences.
fn haversine(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = || {
        let cosine = at.resolve(at.argument(expr, BuiltIn::Acos)?);
        let (one, other) = at.binary(cosine, BinaryOp::Add)?;
        let angles = |product: ExprId, function: BuiltIn| -> Option<Vec<ExprId>> {
            let factors = at.factors(product).into_iter();
            factors
                .map(|factor| at.argument(at.resolve(factor), function))
                .collect()
        };
        let with =
            |sines: ExprId, cosines: ExprId| angles(sines, BuiltIn::Sin).zip(angles(cosines, BuiltIn::Cos));
        let (sines, cosines) = with(one, other).or_else(|| with(other, one))?;
        let &[a, b] = &sines[..] else {
            return None;
        };
        let longitude = cosines
            .iter()
            .copied()
            .find(|&angle| !at.same(angle, a) && !at.same(angle, b));
        let is_complete = cosines.len() == 3
            && [a, b]
                .iter()
                .all(|&angle| cosines.iter().any(|&one| at.same(one, angle)));
        let (a, b, c) = (at.text(a)?, at.text(b)?, at.text(longitude?)?);
        let (half, across) = (format!("sin(0.5 * ({a} - {b}))"), format!("sin(0.5 * {c})"));
        is_complete.then(|| {
            format!("(2.0 * asin(sqrt({half} * {half} + cos({a}) * cos({b}) * {across} * {across})))")
        })
    };
    vec![form()]
}

/// `acos(dot(a, b))` of unit vectors is `2.0 * atan(length(a - b), length(a + b))` (Kahan, section 12).
fn angle(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = || {
        let cosine = at.resolve(at.argument(expr, BuiltIn::Acos)?);
        // `clamp(dot(a, b), -1.0, 1.0)`
        let clamped = [BuiltIn::Clamp, BuiltIn::Min, BuiltIn::Max];
        let inner = clamped.into_iter().find_map(|clamp| at.call(cosine, clamp));
        let inner =
            inner.and_then(|arguments| arguments.iter().copied().find(|&one| at.literal(one).is_none()));
        let &[a, b] = at.call(at.resolve(inner.unwrap_or(cosine)), BuiltIn::Dot)? else {
            return None;
        };
        let (a, b) = (at.text(a)?, at.text(b)?);
        Some(format!("(2.0 * atan(length({a} - {b}), length({a} + {b})))"))
    };
    vec![form()]
}

/// `1.0 / x - 1.0 / y` is `(y - x) / (x * y)`.
fn reciprocals(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let form = || {
        let (a, x) = at.binary(at.resolve(one), BinaryOp::Divide)?;
        let (b, y) = at.binary(at.resolve(other), BinaryOp::Divide)?;
        let (x_text, y_text) = (at.text(x)?, at.text(y)?);
        let difference = at
            .difference(y, x)
            .unwrap_or_else(|| format!("({y_text} - {x_text})"));
        let a_text = at.text(a)?;
        at.same(a, b)
            .then(|| format!("({a_text} * {difference} / ({x_text} * {y_text}))"))
    };
    vec![form()]
}

/// `exp(x) - 1.0`: near 0 the first terms of the series, whose rest is less than half a ULP.
fn exponential_minus_one(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    if !at.is_float(expr) {
        return Vec::new();
    }
    let form = |exponential: ExprId, unit: ExprId, sign: &str| {
        let x = at.text(at.argument(at.resolve(exponential), BuiltIn::Exp)?)?;
        let series = format!(
            "{x} * (1.0 + {x} * (0.5 + {x} * (1.0 / 6.0 + {x} * (1.0 / 24.0 + {x} * (1.0 / 120.0 + {x} / 720.0)))))"
        );
        at.is_literal(unit, 1.0)
            .then(|| format!("{sign}(abs({x}) < 0.3 ? {series} : exp({x}) - 1.0)"))
    };
    vec![form(one, other, ""), form(other, one, "-")]
}

/// `log(1.0 + x)` (Goldberg, theorem 4): the error of `1.0 + x` cancels in the quotient.
fn logarithm_of_one_plus(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = || {
        let sum = at.argument(expr, BuiltIn::Log)?;
        let terms = at.terms(at.resolve(sum));
        let unit = terms
            .iter()
            .position(|term| !term.is_negative && at.is_literal(term.expr, 1.0))?;
        let rest = terms
            .iter()
            .enumerate()
            .filter(|&(at, _)| at != unit)
            .map(|(_, term)| *term);
        let x = at.sum(&rest.collect::<Vec<_>>())?;
        at.is_float(expr)
            .then(|| format!("(1.0 + {x} == 1.0 ? {x} : log(1.0 + {x}) * {x} / ((1.0 + {x}) - 1.0))"))
    };
    vec![form()]
}

/// Logarithms and exponentials of sums and quotients, whose intermediate values are not too large for a float.
fn exponentials(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let exponent = |expr: ExprId| at.argument(at.resolve(expr), BuiltIn::Exp);
    let text_of = |function: BuiltIn, expr: ExprId| at.text(at.argument(at.resolve(expr), function)?);
    let pair = |op| at.binary(expr, op);
    let quotient = || {
        let (one, other) = pair(BinaryOp::Divide)?;
        let a = at.text(exponent(one)?)?;
        // `exp(a) / (1.0 + exp(a))`
        let terms = at.terms(at.resolve(other));
        if let [first, second] = terms[..]
            && let Some(b) = exponent(first.expr).or(exponent(second.expr))
            && (at.is_literal(first.expr, 1.0) || at.is_literal(second.expr, 1.0))
        {
            return (at.text(b)? == a).then(|| format!("(1.0 / (1.0 + exp(-{a})))"));
        }
        let b = at.text(exponent(other)?)?;
        Some(format!("exp({a} - {b})"))
    };
    let product = || {
        let (one, other) = pair(BinaryOp::Multiply)?;
        let (a, b) = (at.text(exponent(one)?)?, at.text(exponent(other)?)?);
        Some(format!("exp({a} + {b})"))
    };
    let of_logarithm = || {
        let (one, other) = pair(BinaryOp::Subtract)?;
        let (a, b) = (text_of(BuiltIn::Log, one)?, text_of(BuiltIn::Log, other)?);
        Some(format!("log({a} / {b})"))
    };
    let logarithm_of_sum = || {
        let sum = at.resolve(at.argument(expr, BuiltIn::Log)?);
        let (one, other) = at.binary(sum, BinaryOp::Add)?;
        let (a, b) = (at.text(exponent(one)?)?, at.text(exponent(other)?)?);
        Some(format!("(max({a}, {b}) + log(1.0 + exp(-abs({a} - {b}))))"))
    };
    let inverse = || {
        let inner = at.argument(expr, BuiltIn::Log)?;
        text_of(BuiltIn::Exp, inner)
    };
    vec![
        quotient(),
        product(),
        of_logarithm(),
        logarithm_of_sum(),
        inverse(),
    ]
}

/// `a + (b - a) * t` is `a * (1.0 - t) + b * t`.
fn weighted_mean(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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

/// `length(v)` and `normalize(v)` of the vector divided by its largest component, whose square is neither too
/// large nor too small for a float.
fn scaled_length(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = |function: BuiltIn, name: &str| {
        let vector = at.argument(expr, function)?;
        let size = at.components(vector).filter(|&size| size > 1)?;
        let v = at.text(vector)?;
        let components = ["x", "y", "z", "w"].iter().take(usize::from(size));
        let sizes = components.map(|component| format!("abs({v}.{component})"));
        let largest = sizes.reduce(|one, other| format!("max({one}, {other})"))?;
        let scale = format!("max({largest}, 1.0e-37)");
        Some(match function {
            BuiltIn::Length => format!("({scale} * length({v} / {scale}))"),
            _ => format!("{name}({v} / {scale})"),
        })
    };
    vec![
        form(BuiltIn::Normalize, "normalize"),
        form(BuiltIn::Length, "length"),
    ]
}

/// `pow(pow(x, p) + pow(y, p), q)` with the larger one in front, whose power may be too small or too large for a
/// float.
fn scaled_powers(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = || {
        let &[sum, root] = at.call(expr, BuiltIn::Pow)? else {
            return None;
        };
        let (one, other) = at.binary(at.resolve(sum), BinaryOp::Add)?;
        let power = |expr: ExprId| match at.call(at.resolve(expr), BuiltIn::Pow)? {
            &[base, exponent] => Some((base, exponent)),
            _ => None,
        };
        let ((x, p), (y, q)) = power(one).zip(power(other))?;
        let (x, y, p_text, root) = (at.text(x)?, at.text(y)?, at.text(p)?, at.text(root)?);
        let ratio = format!("min({x}, {y}) / max(max({x}, {y}), 1.0e-37)");
        at.same(p, q)
            .then(|| format!("(max({x}, {y}) * pow(1.0 + pow({ratio}, {p_text}), {root}))"))
    };
    vec![form()]
}

/// The largest number that is taken for the step of a difference quotient.
const MAX_STEP: f64 = 0.01;

/// A small number, several times as large.
fn larger_step(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some(value) = at.literal(expr).filter(|&value| value > 0.0 && value < MAX_STEP) else {
        return Vec::new();
    };
    let is_float = at.is_float(expr);
    let factors = [3.0, 10.0, 30.0, 100.0, 300.0];
    factors
        .map(|factor| is_float.then(|| format!("{:?}", (value * factor) as f32)))
        .into()
}
