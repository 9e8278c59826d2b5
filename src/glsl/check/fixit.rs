//! Fix-its: the replacement text that messages propose.

use toyproof_diagnostic::Diagnostic;

use crate::check::{Checker, is_desktop_conversion};
use crate::tree::{BinaryOp, ExprId, ExprKind, Scalar, Type, UnaryOp};

impl Checker<'_> {
    /// Adds to the diagnostic how to convert the expression to the type, if one fix is likely.
    pub(super) fn with_fixit(&self, diagnostic: Diagnostic, expr: ExprId, to: Type) -> Diagnostic {
        let diagnostic = match self.fixit(expr, to) {
            Some(fixit) => diagnostic.label(fixit),
            None => diagnostic,
        };
        match self.conversion_note(self.ty(expr), to) {
            Some(note) => diagnostic.note(note),
            None => diagnostic,
        }
    }

    /// A note that explains why an implicit conversion known from desktop GLSL does not happen.
    fn conversion_note(&self, from: Type, to: Type) -> Option<String> {
        (!self.lenient && is_desktop_conversion(from, to)).then(|| {
            format!(
                "WebGL2 does not turn {} into {} by itself; some desktop drivers do, and so does --lenient",
                self.quoted_type(from),
                self.quoted_type(to)
            )
        })
    }

    /// The text that proposes how to convert the expression to the type.
    pub(super) fn fixit(&self, expr: ExprId, to: Type) -> Option<String> {
        let from = self.ty(expr);
        let name = self.tree.type_name(to);
        let written = self.source_text(expr);
        let it = written.as_deref().unwrap_or("…");
        Some(match (from, to) {
            (_, Type::BOOL) if self.is_assignment(expr) => "`=` assigns; to compare write `==`".to_owned(),
            (Type::Scalar(scalar), Type::BOOL) => {
                format!("compare it, as in `{it} != {}`", zero(scalar))
            }
            (Type::INT, Type::FLOAT) if self.is_number(expr) => format!("write `{it}.0`"),
            (Type::INT, Type::UINT) if self.is_number(expr) => format!("write `{it}u`"),
            (Type::FLOAT, Type::INT | Type::UINT) => match self.whole_number(expr) {
                Some(number) if to == Type::UINT => format!("write `{number}u`"),
                Some(number) => format!("write `{number}`"),
                None => format!("write `{name}({it})`, which drops the fraction"),
            },
            (Type::Scalar(_), Type::Scalar(_) | Type::Vector(..)) => format!("write `{name}({it})`"),
            (Type::Vector(a, have), Type::Vector(b, want)) if a == b && have > want => {
                let first = &"xyzw"[..usize::from(want)];
                match &written {
                    Some(it) => format!("write `{it}.{first}`"),
                    None => format!("`.{first}` behind it takes {want} of its components"),
                }
            }
            (Type::Vector(Scalar::Float, have), Type::Vector(Scalar::Float, want)) if have < want => {
                let missing = (have..want).map(|index| if index == 3 { ", 1.0" } else { ", 0.0" });
                format!("write `{name}({it}{})`", missing.collect::<String>())
            }
            (Type::Vector(_, have), Type::Vector(_, want)) if have == want => {
                format!("write `{name}({it})`")
            }
            (Type::Vector(a, _), Type::Scalar(b)) if a == b => {
                format!(
                    "take one component, such as `{}.x`",
                    written.as_deref().unwrap_or("(…)")
                )
            }
            _ => return None,
        })
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
        match self.operator_note(op, left, a, b) {
            Some(note) => diagnostic.note(note),
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

    /// Adds the fix-it for an operand as a related place, at the operand's spelling location.
    pub(super) fn with_related_fixit(&self, diagnostic: Diagnostic, operand: ExprId, to: Type) -> Diagnostic {
        let from = self.ty(operand);
        let label = match self.fixit(operand, to) {
            Some(fixit) => fixit,
            None => format!("this is {}, not {}", self.quoted_type(from), self.quoted_type(to)),
        };
        let diagnostic = diagnostic.related(self.tree[operand].at.spelling, label);
        match self.conversion_note(from, to) {
            Some(note) if !diagnostic.notes.contains(&note) => diagnostic.note(note),
            _ => diagnostic,
        }
    }

    /// A note on what the operator is for, if a different operation was probably intended.
    fn operator_note(&self, op: BinaryOp, left: ExprId, a: Type, b: Type) -> Option<String> {
        let any = |scalar: Scalar| a.scalar() == Some(scalar) || b.scalar() == Some(scalar);
        let chained = matches!(self.tree[left].kind, ExprKind::Binary { op, .. } if op.precedence() == BinaryOp::Less.precedence());
        let logical = match op {
            BinaryOp::BitAnd => "&&",
            BinaryOp::BitOr => "||",
            _ => "^^",
        };
        Some(match op {
            BinaryOp::Remainder if any(Scalar::Float) => {
                "`%` is for integers; for floats write `mod(a, b)`".to_owned()
            }
            BinaryOp::BitXor if any(Scalar::Float) => {
                "`^` combines bits; for a power write `pow(a, b)`, for a square `a * a`".to_owned()
            }
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor if a == Type::BOOL && b == Type::BOOL => {
                format!("`{}` combines bits; for `bool` write `{logical}`", op.symbol())
            }
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::ShiftLeft | BinaryOp::ShiftRight
                if any(Scalar::Float) =>
            {
                format!("`{}` is for integers", op.symbol())
            }
            BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => {
                format!("`{}` joins two `bool`, such as `a > b`", op.symbol())
            }
            BinaryOp::Less | BinaryOp::LessEqual | BinaryOp::Greater | BinaryOp::GreaterEqual => {
                let symbol = op.symbol();
                match (a, b) {
                    (Type::BOOL, _) if chained => format!(
                        "`a {symbol} b {symbol} c` is written `a {symbol} b && b {symbol} c`"
                    ),
                    (Type::Vector(..), Type::Vector(..)) => {
                        "vectors are compared by `lessThan(a, b)` and its kin; `all(…)` or `any(…)` makes one `bool` of the \
                         answers"
                            .to_owned()
                    }
                    _ => return None,
                }
            }
            _ if any(Scalar::Bool) => "a `bool` is no number; `float(b)` makes 1.0 or 0.0 of it".to_owned(),
            BinaryOp::Multiply => match (a, b) {
                (Type::Matrix { columns, .. }, Type::Vector(..)) => {
                    format!(
                        "{} has {columns} columns and takes a `vec{columns}`",
                        self.quoted_type(a)
                    )
                }
                _ => return None,
            },
            _ => return None,
        })
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

    /// The source text of a short expression; none for longer ones.
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

/// The literal for zero.
fn zero(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Float => "0.0",
        Scalar::Uint => "0u",
        Scalar::Int | Scalar::Bool => "0",
    }
}
