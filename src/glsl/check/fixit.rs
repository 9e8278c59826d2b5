//! Fix-its: the replacement text that messages propose.

use toyproof_diagnostic::{Diagnostic, Fix, Span};

use crate::check::{Checker, is_desktop_conversion};
use crate::tree::{BinaryOp, ExprId, ExprKind, Scalar, Type, UnaryOp};

impl Checker<'_> {
    /// Adds to the diagnostic how to convert the expression to the type, if one fix is likely.
    pub(super) fn with_fixit(&self, diagnostic: Diagnostic, expr: ExprId, to: Type) -> Diagnostic {
        let diagnostic = match self.fix(expr, to) {
            Some(Ok(fix)) => diagnostic.fix(fix),
            Some(Err(advice)) => diagnostic.label(advice),
            None => diagnostic,
        };
        match self.conversion_note(self.ty(expr), to) {
            Some(note) => diagnostic.note(note),
            None => diagnostic,
        }
    }

    /// The fix that converts the expression to the type, or only advice where the edit is not known.
    fn fix(&self, expr: ExprId, to: Type) -> Option<Result<Fix, String>> {
        if to == Type::FLOAT
            && let Some(quotient) = self.float_quotient(expr)
        {
            return Some(quotient);
        }
        let (advice, replacement) = self.fixit(expr, to)?;
        Some(match self.replaced(expr, to, replacement) {
            Some((span, replacement)) => Ok(Fix::new(advice, span, replacement)),
            None => Err(advice),
        })
    }

    /// A note that explains why an implicit conversion known from desktop GLSL does not happen.
    fn conversion_note(&self, from: Type, to: Type) -> Option<String> {
        (!self.language.converts_implicitly() && is_desktop_conversion(from, to)).then(|| {
            format!(
                "{} has no implicit conversion from {} to {}, unlike desktop GLSL; `--lenient` accepts it",
                self.language.version.webgl(),
                self.quoted_type(from),
                self.quoted_type(to)
            )
        })
    }

    /// Advice on how to convert the expression to the type, and the text that replaces the expression if it
    /// is short.
    pub(super) fn fixit(&self, expr: ExprId, to: Type) -> Option<(String, Option<String>)> {
        let from = self.ty(expr);
        let name = self.tree.type_name(to);
        let written = self.source_text(expr);
        let it = written.as_deref().unwrap_or("…");
        let replacement = match (from, to) {
            (_, Type::BOOL) if self.is_assignment(expr) => {
                return Some(("`=` assigns; use `==` to compare".to_owned(), None));
            }
            (Type::Scalar(scalar), Type::BOOL) => format!("{it} != {}", zero(scalar)),
            (Type::INT, Type::FLOAT) if self.is_number(expr) => format!("{it}.0"),
            (Type::INT, Type::UINT) if self.is_number(expr) => format!("{it}u"),
            (Type::FLOAT, Type::INT | Type::UINT) => match self.whole_number(expr) {
                Some(number) if to == Type::UINT => format!("{number}u"),
                Some(number) => number,
                None => {
                    let replacement = format!("{name}({it})");
                    let advice = format!("write `{replacement}`, which drops the fraction");
                    return Some((advice, written.map(|_| replacement)));
                }
            },
            (Type::Scalar(_), Type::Scalar(_) | Type::Vector(..)) => format!("{name}({it})"),
            (Type::Vector(a, have), Type::Vector(b, want)) if a == b && have > want => {
                let first = &"xyzw"[..usize::from(want)];
                if written.is_none() {
                    return Some((
                        format!("add `.{first}` to take the first {want} components"),
                        None,
                    ));
                }
                format!("{it}.{first}")
            }
            (Type::Vector(Scalar::Float, have), Type::Vector(Scalar::Float, want)) if have < want => {
                let missing = (have..want).map(|index| if index == 3 { ", 1.0" } else { ", 0.0" });
                format!("{name}({it}{})", missing.collect::<String>())
            }
            (Type::Vector(_, have), Type::Vector(_, want)) if have == want => format!("{name}({it})"),
            (Type::Vector(a, _), Type::Scalar(b)) if a == b => {
                let it = written.as_deref().unwrap_or("(…)");
                return Some((format!("select one component, such as `{it}.x`"), None));
            }
            _ => return None,
        };
        Some((format!("write `{replacement}`"), written.map(|_| replacement)))
    }

    /// The edit for a fix-it: the replacement of the whole expression if its characters are known, or of the
    /// `=` in an assignment that is probably a comparison.
    fn replaced(&self, expr: ExprId, to: Type, replacement: Option<String>) -> Option<(Span, String)> {
        if let ExprKind::Assign {
            target,
            value,
            op: None,
        } = self.tree[expr].kind
            && to == Type::BOOL
        {
            let [target, value] = [target, value].map(|part| self.tree[part].at);
            let gap = Span::new(
                target.span.file,
                target.span.end,
                value.span.start.max(target.span.end),
            );
            let is_plain = !self.tree[expr].at.is_expanded() && gap.end - gap.start <= " = ".len() as u32;
            return is_plain.then(|| (gap, " == ".to_owned()));
        }
        Some((self.written_span(expr)?, replacement?))
    }

    /// The span of an expression whose characters are those of [`Self::source_text`]: without parentheses,
    /// blanks or comments.
    fn written_span(&self, expr: ExprId) -> Option<Span> {
        let span = self.tree[expr].at.spelling;
        let written = self.source_text(expr)?;
        (written.len() == (span.end - span.start) as usize).then_some(span)
    }

    /// Adds a fix-it to a diagnostic about operands that an operator does not accept.
    pub(super) fn with_operand_fixit(
        &self,
        diagnostic: Diagnostic,
        op: BinaryOp,
        left: ExprId,
        right: ExprId,
    ) -> Diagnostic {
        let (a, b) = (self.ty(left), self.ty(right));
        // One operand only needs a conversion.
        for (operand, given, other, swapped) in [(left, a, b, false), (right, b, a, true)] {
            let Some(to) = other.scalar().and_then(|scalar| given.with_scalar(scalar)) else {
                continue;
            };
            let types = if swapped { (a, to) } else { (to, b) };
            if is_desktop_conversion(given, to) && self.binary_type(op, types.0, types.1).is_some() {
                return self.with_fixit_at(diagnostic, operand, to);
            }
        }
        if let Some(replacement) = self.replaced_operation(op, left, right) {
            let whole = self.tree[left].at.to(self.tree[right].at).span;
            let advice = format!("write `{replacement}`");
            let diagnostic = diagnostic.fix(Fix::new(advice, whole, replacement));
            return match self.operator_note(op, left, a, b) {
                Some((note, _)) => diagnostic.note(note),
                None => diagnostic,
            };
        }
        match self.operator_note(op, left, a, b) {
            Some((note, help)) => {
                let diagnostic = diagnostic.note(note);
                if help.is_empty() {
                    diagnostic
                } else {
                    diagnostic.help(help)
                }
            }
            // Vectors of different sizes: the longer one is truncated.
            None => match (a, b) {
                (Type::Vector(x, m), Type::Vector(y, n)) if x == y && m > n => {
                    self.with_fixit_at(diagnostic, left, b)
                }
                (Type::Vector(x, m), Type::Vector(y, n)) if x == y && m < n => {
                    self.with_fixit_at(diagnostic, right, a)
                }
                _ => diagnostic,
            },
        }
    }

    /// Moves the diagnostic to the operand to change and adds the fix-it.
    fn with_fixit_at(&self, diagnostic: Diagnostic, operand: ExprId, to: Type) -> Diagnostic {
        let at = self.tree[operand].at;
        if at.is_expanded() {
            // The text to change is in the macro's body, not at its use.
            return self.with_related_fixit(diagnostic, operand, to);
        }
        self.with_fixit(diagnostic.at(at.span), operand, to)
    }

    /// Adds the fix-it for an operand at the operand's spelling location.
    pub(super) fn with_related_fixit(&self, diagnostic: Diagnostic, operand: ExprId, to: Type) -> Diagnostic {
        let from = self.ty(operand);
        let place = self.tree[operand].at.spelling;
        let diagnostic = match self.fix(operand, to) {
            Some(Ok(fix)) => diagnostic.fix(fix),
            Some(Err(advice)) => diagnostic.related(place, advice),
            None => {
                let (to, from) = (self.quoted_type(to), self.quoted_type(from));
                diagnostic.related(place, format!("expected {to}, found {from}"))
            }
        };
        match self.conversion_note(from, to) {
            Some(note) if !diagnostic.notes.contains(&note) => diagnostic.note(note),
            _ => diagnostic,
        }
    }

    /// A note on what the operator is for, and advice, if a different operation was probably intended.
    fn operator_note(&self, op: BinaryOp, left: ExprId, a: Type, b: Type) -> Option<(String, String)> {
        let any = |scalar: Scalar| a.scalar() == Some(scalar) || b.scalar() == Some(scalar);
        let symbol = op.symbol();
        let (note, help) = match op {
            BinaryOp::Remainder if any(Scalar::Float) => (
                "`%` is only defined for integers",
                "for floats, write `mod(a, b)`",
            ),
            BinaryOp::BitXor if any(Scalar::Float) => (
                "`^` is the bitwise exclusive or",
                "for a power, write `pow(a, b)`; for a square, `a * a`",
            ),
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor if a == Type::BOOL && b == Type::BOOL => {
                let note = format!("`{symbol}` is a bitwise operator of integers");
                return Some((note, format!("for `bool` values, write `{}`", logical(op))));
            }
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::ShiftLeft | BinaryOp::ShiftRight
                if any(Scalar::Float) =>
            {
                return Some((format!("`{symbol}` is only defined for integers"), String::new()));
            }
            BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => {
                let note = format!("both operands of `{symbol}` must be `bool`, such as `a > b`");
                return Some((note, String::new()));
            }
            BinaryOp::Less | BinaryOp::LessEqual | BinaryOp::Greater | BinaryOp::GreaterEqual => {
                match (a, b) {
                    (Type::BOOL, _) if self.is_comparison(left) => {
                        let help = format!("write `a {symbol} b && b {symbol} c`");
                        return Some(("comparisons cannot be chained".to_owned(), help));
                    }
                    (Type::Vector(..), Type::Vector(..)) => (
                        "relational operators are only defined for scalars",
                        "use `lessThan(a, b)` or a similar function, and `all(…)` or `any(…)` to combine the components",
                    ),
                    _ => return None,
                }
            }
            _ if any(Scalar::Bool) => (
                "a `bool` is not a number",
                "write `float(b)`, which is 1.0 or 0.0",
            ),
            BinaryOp::Multiply => match (a, b) {
                (Type::Matrix { columns, .. }, Type::Vector(..)) => {
                    let matrix = self.quoted_type(a);
                    let note = format!("{matrix} has {columns} columns: the vector must be a `vec{columns}`");
                    return Some((note, String::new()));
                }
                _ => return None,
            },
            _ => return None,
        };
        Some((note.to_owned(), help.to_owned()))
    }

    /// The text that replaces a whole operation if a different one was probably intended and the operands are
    /// short.
    fn replaced_operation(&self, op: BinaryOp, left: ExprId, right: ExprId) -> Option<String> {
        if self.tree[left].at.to(self.tree[right].at).is_expanded() {
            return None;
        }
        let text = |expr: ExprId| self.written_span(expr).and_then(|_| self.source_text(expr));
        let [a, b] = [left, right].map(|operand| self.ty(operand));
        match op {
            BinaryOp::Remainder if a.scalar() == Some(Scalar::Float) && a == b => {
                Some(format!("mod({}, {})", text(left)?, text(right)?))
            }
            BinaryOp::BitXor if a.scalar() == Some(Scalar::Float) && a == b => {
                Some(format!("pow({}, {})", text(left)?, text(right)?))
            }
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor if a == Type::BOOL && b == Type::BOOL => {
                Some(format!("{} {} {}", text(left)?, logical(op), text(right)?))
            }
            _ if op.precedence() == BinaryOp::Less.precedence() => match self.tree[left].kind {
                ExprKind::Binary {
                    op: first,
                    left,
                    right: middle,
                } if first.precedence() == op.precedence() && self.ty(middle) == b => {
                    let [start, middle, end] = [text(left)?, text(middle)?, text(right)?];
                    let (first, second) = (first.symbol(), op.symbol());
                    Some(format!("{start} {first} {middle} && {middle} {second} {end}"))
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// Whether the expression is `a < b` or similar.
    fn is_comparison(&self, expr: ExprId) -> bool {
        let precedence = BinaryOp::Less.precedence();
        matches!(self.tree[expr].kind, ExprKind::Binary { op, .. } if op.precedence() == precedence)
    }

    fn is_assignment(&self, expr: ExprId) -> bool {
        matches!(self.tree[expr].kind, ExprKind::Assign { op: None, .. })
    }

    /// Whether the expression is a decimal integer literal, possibly negated.
    fn is_number(&self, expr: ExprId) -> bool {
        match &self.tree[expr].kind {
            ExprKind::Literal(literal) => literal.text.bytes().all(|byte| byte.is_ascii_digit()),
            &ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => self.is_number(operand),
            _ => false,
        }
    }

    /// The integer digits of a float literal whose fraction is zero.
    fn whole_number(&self, expr: ExprId) -> Option<String> {
        let written = self.source_text(expr)?;
        let digits = written.trim_end_matches(['f', 'F']);
        let (whole, fraction) = digits.split_once('.')?;
        let is_number = matches!(
            self.tree[expr].kind,
            ExprKind::Literal(_) | ExprKind::Unary { .. }
        );
        (is_number && !whole.is_empty() && fraction.bytes().all(|byte| byte == b'0'))
            .then(|| whole.to_owned())
    }

    /// The source text of a short expression; `None` for longer ones.
    fn source_text(&self, mut expr: ExprId) -> Option<String> {
        let mut after = String::new();
        loop {
            match &self.tree[expr].kind {
                ExprKind::Variable(variable) => return Some(format!("{}{after}", self.tree[*variable].name)),
                ExprKind::Literal(literal) if after.is_empty() => return Some(literal.text.to_string()),
                &ExprKind::Unary {
                    op: UnaryOp::Minus,
                    operand,
                } if after.is_empty() => match &self.tree[operand].kind {
                    ExprKind::Literal(literal) => return Some(format!("-{}", literal.text)),
                    _ => return None,
                },
                &ExprKind::Swizzle { vector, components } if after.is_empty() => {
                    after = format!(".{}", components.name());
                    expr = vector;
                }
                &ExprKind::Member { structure, member } if after.len() < 40 => {
                    let Type::Struct(id) = self.ty(structure) else {
                        return None;
                    };
                    after = format!(".{}{after}", self.tree[id].members[member].name);
                    expr = structure;
                }
                _ => return None,
            }
        }
    }
}

/// The logical operator that corresponds to a bitwise one.
fn logical(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::BitAnd => "&&",
        BinaryOp::BitOr => "||",
        _ => "^^",
    }
}

/// The literal for zero.
fn zero(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Float => "0.0",
        Scalar::Uint => "0u",
        Scalar::Int | Scalar::Bool => "0",
    }
}
