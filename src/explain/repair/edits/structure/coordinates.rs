//! Other screen coordinates.

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Scalar, Type, walk};

use super::super::super::edit::{EditKind, shortened};
use super::super::super::shader::Shape;
use super::{Writer, insertion, replacement};

/// The cost of other coordinates.
const COORDINATES: u32 = 18;

impl Writer<'_> {
    /// Other screen coordinates, and the aspect ratio of coordinates.
    pub(super) fn coordinates(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let main = shader.checked.main_image;
        let Some(&position) = tree[main].parameters.get(1) else {
            return;
        };
        let p = tree[position].name.as_str();
        let vec2 = Type::Vector(Scalar::Float, 2);
        let mentions = |expr: ExprId| walk::mentions(tree, expr, position);
        if self.function(at) == Some(main) {
            let forms = [
                format!("({p} / iResolution.y)"),
                format!("({p} / iResolution.xy)"),
                format!("({p} / iResolution.x)"),
                format!("((2.0 * {p} - iResolution.xy) / iResolution.y)"),
                format!("(2.0 * {p} / iResolution.xy - 1.0)"),
                format!("(({p} - 0.5 * iResolution.xy) / iResolution.y)"),
                format!("({p} / iResolution.xy - 0.5)"),
                format!("((2.0 * {p} - iResolution.xy) / iResolution.x)"),
                format!("(({p} - 0.5 * iResolution.xy) / iResolution.x)"),
            ];
            let sites = shader
                .sites
                .iter()
                .filter(|site| site.statement == at && site.exprs.len() == 1);
            let sites = sites.filter(|site| {
                let expr = site.exprs[0];
                let is_name = matches!(tree[expr].kind, ExprKind::Variable(_) | ExprKind::Swizzle { .. });
                tree[expr].ty == vec2 && !is_name && mentions(expr)
            });
            for span in sites.map(|site| site.span).collect::<Vec<_>>() {
                for form in &forms {
                    let shown = &form[1..form.len() - 1];
                    let message = format!("replace `{}` with `{shown}`", shortened(shader.text(span)));
                    let edits = vec![replacement(span, form)];
                    self.add(at, EditKind::Expression, COORDINATES, message, edits);
                }
            }
        }
        self.components(at);
        let target = match shader.statements[at].kind {
            Shape::Declaration(variable) => Some(variable),
            Shape::Expression(expr) => match tree[expr].kind {
                ExprKind::Assign { target, .. } => match tree[target].kind {
                    ExprKind::Variable(variable) => Some(variable),
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        };
        let (Some(variable), Some(extent)) = (target, self.outline.extents[at]) else {
            return;
        };
        if tree[variable].ty != vec2 || self.function(at) != Some(main) {
            return;
        }
        let name = tree[variable].name.as_str();
        for text in [
            format!("{name}.x *= iResolution.x / iResolution.y;"),
            format!("{name}.y *= iResolution.y / iResolution.x;"),
        ] {
            let message = format!("insert `{text}` after `{}`", shortened(self.text(at)));
            let edits = vec![insertion(extent, extent.end, format!(" {text}"))];
            self.add(at, EditKind::MissingStatement, COORDINATES, message, edits);
        }
    }

    /// Divides a vector by the height or the width instead of by both: by a component of the divisor.
    fn components(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let vec2 = Type::Vector(Scalar::Float, 2);
        let sites = shader.sites.iter();
        let quotients = sites.filter(|site| site.statement == at && site.exprs.len() == 1);
        let divisors = quotients.filter_map(|site| match tree[site.exprs[0]].kind {
            ExprKind::Binary {
                op: BinaryOp::Divide,
                right,
                ..
            } if tree[right].ty == vec2 => Some(tree[right].at.span),
            _ => None,
        });
        for span in divisors.collect::<Vec<_>>() {
            let text = shader.text(span);
            let is_name = |byte: u8| byte.is_ascii_alphanumeric() || b"_.".contains(&byte);
            if text.is_empty() || !text.bytes().all(is_name) {
                continue;
            }
            let whole = text.strip_suffix(".xy").unwrap_or(text);
            for component in ["y", "x"] {
                let new = format!("{whole}.{component}");
                let message = format!("replace `{text}` with `{new}`");
                self.add(
                    at,
                    EditKind::Component,
                    COORDINATES,
                    message,
                    vec![replacement(span, &new)],
                );
            }
        }
    }
}
