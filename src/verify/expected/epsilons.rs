//! The ray epsilons of a reference shader: how far off a surface its rays start, and how near a march comes
//! to one.

use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprId, ExprKind, Literal, Value};

use super::variation::{Edit, Subject, Variation};

/// The lengths that authors use, in units of the scene: those up to the default `max_offset` of a scene.
const USUAL_EPSILONS: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// The numbers that may be ray epsilons: smaller ones keep a division from failing, larger ones are sizes.
const EPSILONS: std::ops::Range<f64> = 1e-7..1e-2;

/// The largest number of different epsilons that are varied.
const MAX_EPSILONS: usize = 6;

/// The reference with the usual ray epsilons, each varied alone and all together.
pub(super) fn variations(checked: &Checked) -> Vec<Variation> {
    let groups = epsilons(checked);
    let all = (groups.len() > 1).then(|| groups.concat());
    let groups = groups.into_iter().chain(all);
    groups
        .flat_map(|group| {
            USUAL_EPSILONS.map(|epsilon| Variation {
                edits: group
                    .iter()
                    .map(|&id| Edit::Number(id, Value::Float(epsilon)))
                    .collect(),
                subject: Subject::Epsilons,
            })
        })
        .collect()
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
