//! Trigonometric and exponential functions.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId};

use crate::rewrite::site::Definitions;

/// `1.0 - cos(x)` is `2.0 * sin(x / 2) * sin(x / 2)`.
pub(super) fn one_minus_cosine(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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
pub(super) fn trigonometric_difference(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let form = |function: BuiltIn| {
        let a = at.argument(at.resolve(one), function)?;
        let b = at.argument(at.resolve(other), function)?;
        let (a_text, b_text) = (at.text(a)?, at.text(b)?);
        let difference = at.minus(a, b)?;
        Some(match function {
            BuiltIn::Sin => format!("(2.0 * cos(0.5 * ({a_text} + {b_text})) * sin(0.5 * {difference}))"),
            BuiltIn::Cos => format!("(-2.0 * sin(0.5 * ({a_text} + {b_text})) * sin(0.5 * {difference}))"),
            BuiltIn::Exp => format!("(2.0 * exp(0.5 * ({a_text} + {b_text})) * sinh(0.5 * {difference}))"),
            BuiltIn::Tan => format!("(sin({difference}) / (cos({a_text}) * cos({b_text})))"),
            _ => format!("atan({difference} / (1.0 + {a_text} * {b_text}))"),
        })
    };
    // `sin(a) * cos(b) - cos(a) * sin(b)`
    let of_products = || {
        let angles = |product: ExprId| {
            let (left, right) = at.binary(at.resolve(product), BinaryOp::Multiply)?;
            let argument = |function| {
                [left, right]
                    .into_iter()
                    .find_map(|one| at.argument(at.resolve(one), function))
            };
            Some((argument(BuiltIn::Sin)?, argument(BuiltIn::Cos)?))
        };
        let ((a, b), (c, d)) = angles(one).zip(angles(other))?;
        let is_pair = at.same(a, d) && at.same(b, c);
        Some(format!("sin({})", at.minus(a, b)?)).filter(|_| is_pair)
    };
    let functions = [
        BuiltIn::Sin,
        BuiltIn::Cos,
        BuiltIn::Tan,
        BuiltIn::Atan,
        BuiltIn::Exp,
    ];
    functions.into_iter().map(form).chain([of_products()]).collect()
}

/// `acos(sin(a) * sin(b) + cos(a) * cos(b) * cos(c))` by the squares of the sines of half the differences.
pub(super) fn haversine(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let form = || {
        let cosine = at.resolve(at.unclamped(at.argument(expr, BuiltIn::Acos)?));
        let (one, other) = at.binary(cosine, BinaryOp::Add)?;
        let angles = |product: ExprId, function: BuiltIn| -> Option<Vec<ExprId>> {
            let factors = at.all_factors(product).into_iter();
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

/// `exp(x) - 1.0`, and `a * exp(x) - a`: near 0 the first terms of the series, whose rest is less than half a
/// ULP.
pub(super) fn exponential_minus_one(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    let series = |exponential: ExprId| {
        let exponent = at.argument(at.resolve(exponential), BuiltIn::Exp)?;
        let x = at.text(exponent)?;
        let series = format!(
            "{x} * (1.0 + {x} * (0.5 + {x} * (1.0 / 6.0 + {x} * (1.0 / 24.0 + {x} * (1.0 / 120.0 + {x} / 720.0)))))"
        );
        at.is_float(exponent)
            .then(|| format!("(abs({x}) < 0.3 ? {series} : exp({x}) - 1.0)"))
    };
    let form = |product: ExprId, factor: ExprId, sign: &str| {
        if at.is_literal(factor, 1.0) {
            return Some(format!("{sign}{}", series(product)?));
        }
        let (left, right) = at.binary(at.resolve(product), BinaryOp::Multiply)?;
        let exponential = if at.same(left, factor) {
            right
        } else {
            at.same(right, factor).then_some(left)?
        };
        Some(format!("({sign}{} * {})", at.text(factor)?, series(exponential)?))
    };
    vec![form(one, other, ""), form(other, one, "-")]
}

/// `log(1.0 + x)` (Goldberg, theorem 4), and `pow(1.0 + x, n)`: the error of `1.0 + x` cancels in the
/// quotient.
pub(super) fn logarithm_of_one_plus(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let logarithm = |sum: ExprId| {
        let terms = at.terms(at.resolve(sum));
        let unit = terms
            .iter()
            .position(|term| !term.is_negative && at.is_literal(term.expr, 1.0))?;
        let rest = terms.iter().enumerate().filter(|&(at, _)| at != unit);
        let x = at.sum(&rest.map(|(_, term)| *term).collect::<Vec<_>>())?;
        at.is_float(expr)
            .then(|| format!("(1.0 + {x} == 1.0 ? {x} : log(1.0 + {x}) * {x} / ((1.0 + {x}) - 1.0))"))
    };
    let power = || match at.call(expr, BuiltIn::Pow)? {
        &[base, exponent] => Some(format!("exp({} * {})", at.text(exponent)?, logarithm(base)?)),
        _ => None,
    };
    vec![at.argument(expr, BuiltIn::Log).and_then(logarithm), power()]
}

/// `x - sin(x)`: near 0 the first terms of the series, whose rest is less than half a ULP.
pub(super) fn angle_minus_sine(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let Some((one, other)) = at.binary(expr, BinaryOp::Subtract) else {
        return Vec::new();
    };
    if !at.is_float(expr) {
        return Vec::new();
    }
    let form = |angle: ExprId, sine: ExprId, sign: &str| {
        let own = at.argument(at.resolve(sine), BuiltIn::Sin)?;
        let x = at.text(angle)?;
        let series = format!(
            "{x} * {x} * {x} * (1.0 / 6.0 - {x} * {x} * (1.0 / 120.0 - {x} * {x} * (1.0 / 5040.0 - {x} * {x} / 362880.0)))"
        );
        at.same(own, angle)
            .then(|| format!("{sign}(abs({x}) < 0.3 ? {series} : {x} - sin({x}))"))
    };
    vec![form(one, other, ""), form(other, one, "-")]
}

/// The sum of exponentials, each divided by that of `divisor`.
fn sum_of_exponentials(exponents: &[String], divisor: &str) -> String {
    let terms: Vec<_> = exponents
        .iter()
        .map(|exponent| {
            if exponent == divisor {
                "1.0".to_owned()
            } else {
                format!("exp({exponent} - {divisor})")
            }
        })
        .collect();
    terms.join(" + ")
}

/// Logarithms and exponentials of sums and quotients, whose intermediate values are not too large for a
/// float.
pub(super) fn exponentials(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let exponent = |expr: ExprId| at.argument(at.resolve(expr), BuiltIn::Exp);
    let text_of = |function: BuiltIn, expr: ExprId| at.text(at.argument(at.resolve(expr), function)?);
    let pair = |op| at.binary(expr, op);
    // The exponents of a sum of exponentials, of which 1 is one.
    let exponents = |sum: ExprId| -> Option<Vec<String>> {
        let terms = at.terms(at.resolve(sum));
        let exponents = terms.iter().map(|term| {
            let text = if at.is_literal(term.expr, 1.0) {
                "0.0".to_owned()
            } else {
                at.text(exponent(term.expr)?)?
            };
            (!term.is_negative).then_some(text)
        });
        exponents.collect()
    };
    let quotient = || {
        let (one, other) = pair(BinaryOp::Divide)?;
        let a = at.text(exponent(one)?)?;
        Some(match &exponents(other)?[..] {
            [b] => format!("exp({a} - {b})"),
            all => format!("(1.0 / ({}))", sum_of_exponentials(all, &a)),
        })
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
        let all = exponents(at.argument(expr, BuiltIn::Log)?).filter(|all| all.len() > 1)?;
        let largest = all
            .iter()
            .cloned()
            .reduce(|one, other| format!("max({one}, {other})"))?;
        Some(format!(
            "({largest} + log({}))",
            sum_of_exponentials(&all, &largest)
        ))
    };
    // All components of a vector, such as the scores of a softmax, of which only ratios matter.
    let scaled = || {
        let vector = at.argument(expr, BuiltIn::Exp)?;
        let size = at.components(vector).filter(|&size| size > 1)?;
        let v = at.text(vector)?;
        let components = ["x", "y", "z", "w"].iter().take(usize::from(size));
        let largest = components
            .map(|component| format!("{v}.{component}"))
            .reduce(|one, other| format!("max({one}, {other})"))?;
        Some(format!("exp({v} - {largest})"))
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
        scaled(),
        inverse(),
    ]
}

/// `pow(pow(x, p) + pow(y, p), q)` with the larger one in front, whose power may be too small or too large
/// for a float.
pub(super) fn scaled_powers(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
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
