//! A value of a shader in all pixels, as an image: its expression is assigned to a global, which becomes the
//! color.

use std::collections::HashSet;
use std::time::Instant;

use toyproof_diagnostic::Span;
use toyproof_eval::{Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    Constructor, Direction, Expr, ExprId, ExprKind, Function, Item, Literal, Place, Scalar, Statement,
    StatementKind, Tree, Type, Value, Variable, VariableId, VariableKind,
};
use toyproof_image::{Frame, Image, Rgb8Image};

use crate::repair::written;

/// The value of a pixel that never computes the expression.
const UNSET: f64 = 1e30;

/// The color of a pixel that never computes the expression: dark blue.
const UNSET_COLOR: [u8; 3] = [24, 24, 72];

/// The color of a value that is not finite: magenta.
const NOT_FINITE_COLOR: [u8; 3] = [255, 0, 255];

/// The share of the values at either end that the range of colors leaves out.
const OUTLIERS: f64 = 0.01;

/// The first value that a shader does not have in common with its reference, in all pixels, and the value of
/// the reference that the shader lacks: in the same colors, from black at the start of a range to white at its
/// end. A vector of two or three components is shown as red, green and blue. Pixels that never compute the
/// value are dark blue, values that are not finite magenta.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ValueImages {
    /// The value of the shader; `None` if there is none, or it could not be rendered.
    pub own: Option<Rgb8Image>,
    /// The value of the reference.
    pub reference: Option<Rgb8Image>,
}

impl ValueImages {
    pub(super) fn new(own: Option<&Values>, reference: Option<&Values>) -> Self {
        let mut all: Vec<f64> = own
            .iter()
            .chain(&reference)
            .flat_map(|values| values.finite())
            .collect();
        all.sort_by(f64::total_cmp);
        let left_out = (OUTLIERS * all.len() as f64) as usize;
        let range = match (all.get(left_out), all.iter().rev().nth(left_out)) {
            // Colors and factors are shown as they are.
            (Some(&low), Some(&high)) if low < 0.0 || high > 1.0 => [low, high],
            _ => [0.0, 1.0],
        };
        let [own, reference] = [own, reference].map(|values| values.map(|values| values.shown(range)));
        Self { own, reference }
    }
}

/// The values of an expression in a frame.
pub(super) struct Values {
    image: Image,
    components: usize,
}

impl Values {
    /// Evaluates the expression at a place, or the largest one of a statement, in all pixels of a frame; of
    /// several executions in a pixel, the last. `None` if it is no float or vector of floats, or the shader
    /// could not be rendered before the deadline.
    pub(super) fn new(program: &Program, frame: &Frame, span: Span, deadline: Instant) -> Option<Self> {
        let mut checked = program.checked().clone();
        let expr = expression(&checked.tree, span)?;
        let components = match checked.tree[expr].ty {
            Type::Scalar(Scalar::Float) => 1,
            Type::Vector(Scalar::Float, size) => usize::from(size),
            _ => return None,
        };
        instrument(&mut checked, expr)?;
        let left = deadline.saturating_duration_since(Instant::now());
        let program = Program::prepared_within(&checked, UndefinedPolicy::Plain, Some(left)).ok()?;
        let settings = Settings::<f64> {
            undefined: UndefinedPolicy::Plain,
            deadline: Some(deadline),
            ..Settings::default()
        };
        let image = program.render_rows(frame, frame.rows(), &settings).ok()?.image;
        Some(Self { image, components })
    }

    fn finite(&self) -> impl Iterator<Item = f64> {
        let pixels = self.image.pixels().iter().copied().filter_map(computed);
        let all = pixels.flat_map(|values| values.into_iter().take(self.components));
        all.filter(|value| value.is_finite())
    }

    fn shown(&self, [low, high]: [f64; 2]) -> Rgb8Image {
        let level = |value: f64| (255.0 * ((value - low) / (high - low)).clamp(0.0, 1.0)).round() as u8;
        let color = |pixel: &[f32; 4]| match computed(*pixel) {
            None => UNSET_COLOR,
            Some(values) if !values.iter().all(|value| value.is_finite()) => NOT_FINITE_COLOR,
            Some(values) if self.components == 1 => [level(values[0]); 3],
            Some([x, y, _]) if self.components == 2 => [level(x), level(y), 0],
            Some(values) => values.map(level),
        };
        let [width, height] = self.image.size();
        Rgb8Image::new(width, height, self.image.pixels().iter().map(color).collect())
    }
}

/// The components of a pixel that are shown; `None` if the pixel never computes the expression.
fn computed(pixel: [f32; 4]) -> Option<[f64; 3]> {
    let values = [pixel[0], pixel[1], pixel[2]].map(f64::from);
    (pixel[0] != UNSET as f32).then_some(values)
}

/// The expression at a place, or the largest one inside.
fn expression(tree: &Tree, span: Span) -> Option<ExprId> {
    let is_inside = |expr: &Expr| {
        let own = expr.at.span;
        own.file == span.file && span.start <= own.start && own.end <= span.end && !expr.constant
    };
    // Lvalues have no value that could be assigned.
    let lvalues = tree.exprs.iter().flat_map(|(id, _)| written(tree, id));
    let lvalues: HashSet<ExprId> = lvalues.flat_map(|lvalue| tree.path(lvalue)).collect();
    let all = tree
        .exprs
        .iter()
        .filter(|(id, expr)| is_inside(expr) && !lvalues.contains(id));
    let is_value = |ty| matches!(ty, Type::Scalar(Scalar::Float) | Type::Vector(Scalar::Float, _));
    let values = all.filter(|(_, expr)| is_value(expr.ty));
    // Of equals, the one that was added last uses the others.
    values
        .max_by_key(|(id, expr)| (expr.at.span.end - expr.at.span.start, id.index()))
        .map(|(id, _)| id)
}

/// Makes the value of an expression the color of a shader, whose entry point becomes a function that calls
/// `mainImage`.
fn instrument(checked: &mut Checked, expr: ExprId) -> Option<()> {
    let main = checked.main_image;
    let &[_, place, ..] = &checked.tree[main].parameters[..] else {
        return None;
    };
    let at = checked.tree[main].at;
    let ty = checked.tree[expr].ty;
    let color_type = Type::Vector(Scalar::Float, 4);
    let mut writer = Writer {
        tree: &mut checked.tree,
        at,
    };
    let value = writer.declare(VariableKind::Global, ty);
    let color = writer.declare(VariableKind::Local, color_type);
    let out = writer.declare(VariableKind::Parameter(Direction::Out), color_type);
    let position_type = writer.tree[place].ty;
    let position = writer.declare(VariableKind::Parameter(Direction::In), position_type);
    let original = writer.tree[expr].clone();
    let original = writer.tree.exprs.push(original);
    let target = writer.variable(value);
    writer.tree[expr].kind = ExprKind::Assign {
        op: None,
        target,
        value: original,
    };
    let number = writer.number(UNSET);
    let unset = match ty {
        Type::Vector(..) => writer.construct(Constructor::Splat, vec![number], ty),
        _ => number,
    };
    let arguments = [color, position]
        .map(|variable| writer.variable(variable))
        .to_vec();
    let call = writer.push(
        ExprKind::Call {
            function: main,
            arguments,
        },
        Type::Void,
    );
    let shown = writer.variable(value);
    let shown = match ty.component_count() {
        Some(4) => shown,
        count => {
            let missing = 4 - usize::from(count.unwrap_or(1));
            let rest = (0..missing).map(|_| writer.number(1.0));
            let parts = std::iter::once(shown).chain(rest.collect::<Vec<_>>()).collect();
            writer.construct(Constructor::Vector, parts, color_type)
        }
    };
    let body = vec![
        writer.statement(StatementKind::Declare(color)),
        writer.assignment(value, unset),
        writer.statement(StatementKind::Expression(call)),
        writer.assignment(out, shown),
    ];
    let function = checked.tree.functions.push(Function {
        name: "shown".to_owned(),
        return_type: Type::Void,
        parameters: vec![out, position],
        body: Some(body),
        at,
    });
    checked.tree.items.insert(0, Item::Variable(value));
    checked.tree.items.push(Item::Function(function));
    checked.main_image = function;
    Some(())
}

/// Adds parts to a tree.
struct Writer<'a> {
    tree: &'a mut Tree,
    at: Place,
}

impl Writer<'_> {
    fn declare(&mut self, kind: VariableKind, ty: Type) -> VariableId {
        self.tree.variables.push(Variable {
            name: "shown".to_owned(),
            ty,
            kind,
            initializer: None,
            value: None,
            at: Some(self.at),
        })
    }

    fn push(&mut self, kind: ExprKind, ty: Type) -> ExprId {
        self.tree.exprs.push(Expr {
            kind,
            ty,
            constant: false,
            at: self.at,
        })
    }

    fn variable(&mut self, variable: VariableId) -> ExprId {
        let ty = self.tree[variable].ty;
        self.push(ExprKind::Variable(variable), ty)
    }

    fn number(&mut self, value: f64) -> ExprId {
        let literal = Literal {
            text: "".into(),
            value: Value::Float(value),
        };
        self.push(ExprKind::Literal(literal), Type::FLOAT)
    }

    fn construct(&mut self, constructor: Constructor, arguments: Vec<ExprId>, ty: Type) -> ExprId {
        self.push(
            ExprKind::Construct {
                constructor,
                arguments,
            },
            ty,
        )
    }

    fn statement(&self, kind: StatementKind) -> Statement {
        Statement { kind, at: self.at }
    }

    fn assignment(&mut self, variable: VariableId, value: ExprId) -> Statement {
        let target = self.variable(variable);
        let ty = self.tree[variable].ty;
        let kind = ExprKind::Assign {
            op: None,
            target,
            value,
        };
        let expr = self.push(kind, ty);
        self.statement(StatementKind::Expression(expr))
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use toyproof_diagnostic::{File, Files};

    use super::*;

    const SHADER: &str = "void split(in vec2 p, out float x, inout vec2 rest) { x = p.x; rest.y += 2.0; }
void mainImage(out vec4 c, in vec2 p) {
    float x;
    vec2 rest = p;
    split(p / 4.0, x, rest);
    rest[1] *= 0.5;
    if (p.x < 2.0) x = -1.0 * p.y;
    c = vec4(x, rest, 1.0);
}";

    /// The value of a text of the shader in its pixels.
    fn values(text: &str) -> Option<Vec<Option<[f64; 3]>>> {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", SHADER));
        let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap();
        let program = Program::new(&checked).unwrap();
        let start = SHADER.find(text).unwrap() as u32;
        let span = Span::new(
            checked.tree[checked.main_image].at.span.file,
            start,
            start + text.len() as u32,
        );
        let frame = Frame {
            size: [4, 1],
            ..Frame::default()
        };
        let deadline = Instant::now() + Duration::from_secs(60);
        let values = Values::new(&program, &frame, span, deadline)?;
        Some(values.image.pixels().iter().copied().map(computed).collect())
    }

    #[test]
    fn a_value_is_shown_where_it_is_computed() {
        let first = |text| -> Vec<Option<f64>> {
            let values = values(text).unwrap().into_iter();
            values.map(|value| Some(value?[0])).collect()
        };
        assert_eq!(first("p / 4.0"), [0.125, 0.375, 0.625, 0.875].map(Some));
        assert_eq!(first("-1.0 * p.y"), [Some(-0.5), Some(-0.5), None, None]);
        // The value after the assignment.
        assert_eq!(first("rest.y += 2.0"), [Some(2.5); 4]);
    }

    #[test]
    fn no_lvalue_is_replaced() {
        assert_eq!(values("x, rest"), None);
        assert_eq!(values("rest[1]"), None);
    }

    #[test]
    fn both_images_have_one_range_of_colors() {
        let with = |values: [f32; 2]| Values {
            image: Image::new(2, 1, values.map(|value| [value, 1.0, 1.0, 1.0]).to_vec()),
            components: 1,
        };
        let (own, other) = (with([-1.0, 3.0]), with([1.0, UNSET as f32]));
        let images = ValueImages::new(Some(&own), Some(&other));
        assert_eq!(images.own.unwrap().pixels(), [[0; 3], [255; 3]]);
        assert_eq!(images.reference.unwrap().pixels(), [[128; 3], UNSET_COLOR]);
    }
}
