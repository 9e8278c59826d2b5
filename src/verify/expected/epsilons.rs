//! The ray epsilons of a reference shader: where its rays start off a surface, and how near a march comes to
//! one. They are a matter of style, so the colors for the usual ones are accepted.

use std::time::Instant;

use toyproof_eval::{Program, Settings, UndefinedPolicy};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprId, ExprKind, Literal, Value};
use toyproof_image::Image;
use toyproof_tracer::ColorRange;

use super::bands::is_cached;
use super::shader::ShaderReference;
use crate::TOTAL_TIME_FACTOR;
use crate::compare::Pixel;

/// The lengths that authors use, in units of the scene: those up to the default `max_offset` of a scene.
const USUAL_EPSILONS: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// The numbers that may be ray epsilons: smaller ones keep a division from failing, larger ones are sizes.
const EPSILONS: std::ops::Range<f64> = 1e-7..1e-2;

/// The largest number of different epsilons that are varied.
const MAX_EPSILONS: usize = 6;

/// The largest share of pixels that may change with a ray epsilon. A number on which more of the image depends
/// is none.
const MAX_CHANGED_SHARE: f64 = 0.05;

/// The range of the colors of each pixel, bottom row first.
#[derive(Debug)]
pub(super) struct AcceptedColors(Vec<ColorRange>);

impl AcceptedColors {
    /// The colors of a reference for the usual ray epsilons, each varied alone and all together; none for a
    /// large image, and without epsilons.
    pub(super) fn of(reference: &ShaderReference) -> Option<Self> {
        if !is_cached(reference.frame.size) {
            return None;
        }
        let groups = epsilons(reference.checked());
        let each = groups.iter().map(Vec::clone);
        let all = (groups.len() > 1).then(|| groups.concat());
        let bands = reference.frame.bands().map(|rows| reference.rows(&rows));
        let bands = bands.map(|band| band.ok().map(|band| band.image.clone()));
        let own = Image::of_bands(bands.collect::<Option<_>>()?);
        let mut ranges: Vec<ColorRange> = own.pixels().iter().map(|&color| point(color)).collect();
        let mut is_varied = false;
        for group in each.chain(all) {
            for epsilon in USUAL_EPSILONS {
                let varied = with_epsilon(reference.checked(), &group, epsilon);
                let Some(image) = evaluated(reference, &varied) else {
                    continue;
                };
                let changed = (0..ranges.len())
                    .filter(|&at| Pixel::at(at, &own, &image).difference() > reference.tolerance());
                let changed = changed.count();
                if changed > 0 && changed as f64 <= MAX_CHANGED_SHARE * ranges.len() as f64 {
                    is_varied = true;
                    for (range, &color) in ranges.iter_mut().zip(image.pixels()) {
                        extend(range, color);
                    }
                }
            }
        }
        is_varied.then_some(Self(ranges))
    }

    pub(super) fn range(&self, at: usize) -> &ColorRange {
        &self.0[at]
    }
}

fn point([r, g, b, _]: [f32; 4]) -> ColorRange {
    let color = [r, g, b].map(f64::from);
    ColorRange {
        low: color,
        high: color,
    }
}

fn extend(range: &mut ColorRange, color: [f32; 4]) {
    // Neither the least nor the greatest of a number and NaN is NaN.
    for ((low, high), part) in range.low.iter_mut().zip(&mut range.high).zip(color) {
        *low = low.min(f64::from(part));
        *high = high.max(f64::from(part));
    }
}

/// The literals that may be ray epsilons, grouped by their values.
fn epsilons(checked: &Checked) -> Vec<Vec<ExprId>> {
    let mut groups: Vec<(f64, Vec<ExprId>)> = Vec::new();
    for (id, expr) in checked.tree.exprs.iter() {
        if let ExprKind::Literal(Literal {
            value: Value::Float(value),
            ..
        }) = expr.kind
            && EPSILONS.contains(&value)
        {
            match groups.iter_mut().find(|(known, _)| *known == value) {
                Some((_, group)) => group.push(id),
                None => groups.push((value, vec![id])),
            }
        }
    }
    groups.truncate(MAX_EPSILONS);
    groups.into_iter().map(|(_, group)| group).collect()
}

/// The shader with another number in place of some literals.
fn with_epsilon(checked: &Checked, literals: &[ExprId], epsilon: f64) -> Checked {
    let mut checked = checked.clone();
    for &id in literals {
        checked.tree[id].kind = ExprKind::Literal(Literal {
            text: format!("{epsilon:?}").into(),
            value: Value::Float(epsilon),
        });
    }
    checked.tree.clear_cached_values();
    checked
}

/// The image of a variant of the reference; none if a limit is exceeded.
fn evaluated(reference: &ShaderReference, varied: &Checked) -> Option<Image> {
    let settings = Settings::<f64> {
        undefined: UndefinedPolicy::Plain,
        deadline: Some(Instant::now() + reference.timeout * TOTAL_TIME_FACTOR),
        ..Settings::default()
    };
    let program = Program::prepared(varied, UndefinedPolicy::Plain).ok()?;
    let frame = &reference.frame;
    let rendered = program.render_rows(frame, frame.rows(), &settings);
    rendered.ok().map(|rendered| rendered.image)
}
