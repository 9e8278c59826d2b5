//! Spectrum-based fault localization: which values the wrong pixels depend on more often than the right ones.
//!
//! A pixel depends on a value if its color changes when the value is changed, which is a dynamic slice found
//! by execution, not by analysis: a statement that a pixel does not run, or whose result it does not use, has
//! no influence. Suspicion is Ochiai's coefficient (Abreu, Zoeteweij and van Gemund, "On the accuracy of
//! spectrum-based fault localization", 2007): with w and r the wrong and right pixels that depend on the
//! value, of W wrong ones, s = w / √(W·(w + r)).

use toyproof_glsl::tree::{BinaryOp, ExprKind, Scalar, Type, UnaryOp};

use super::edit::{Candidate, Change, EditKind};
use super::shader::Shader;
use super::term::Term;
use crate::engine::differ;
use crate::engine::probes::Probe;
use crate::engine::tournament::Values;

/// A change of a float: a factor and a term.
#[derive(Debug, Clone, Copy)]
pub(super) struct Disturbance {
    factor: f64,
    term: f64,
    /// The weight of an influence that only this change shows.
    pub(super) weight: f64,
}

/// First a change so small that most conditions stay as they are; then, for values without influence, one
/// that moves a ray's start or a hit's distance by more than an epsilon.
pub(super) const DISTURBANCES: [Disturbance; 2] = [
    Disturbance {
        factor: 1.0 + 1.0 / 256.0,
        term: 1.0 / 1024.0,
        weight: 1.0,
    },
    Disturbance {
        factor: -1.5,
        term: 0.25,
        weight: 0.8,
    },
];

/// The difference at which a color has changed.
const CHANGED: f64 = 1e-9;

/// The share of its user's suspicion that an operand has at least, where a small change need not show: in a
/// comparison, and for types that are not changed.
const INHERITED: f64 = 0.9;

/// The suspicion of a function that the reference has, too, relative to others with the same influence.
const COPIED: f64 = 0.5;

/// The candidate that changes the value of a site; `None` if its type has no such change.
pub(super) fn disturbed(shader: &Shader, site: usize, by: Disturbance) -> Option<Candidate> {
    let tree = shader.tree;
    let expr = shader.sites[site].exprs[0];
    let own = Term::keep(tree, expr);
    if matches!(tree[expr].kind, ExprKind::Assign { .. }) {
        return None;
    }
    let term = match tree[expr].ty {
        Type::Scalar(Scalar::Float) | Type::Vector(Scalar::Float, _) => {
            let product = Term::binary(BinaryOp::Multiply, own, Term::float(by.factor))?;
            Term::binary(BinaryOp::Add, product, Term::float(by.term))?
        }
        Type::Matrix { .. } => Term::binary(BinaryOp::Multiply, own, Term::float(by.factor))?,
        Type::Scalar(Scalar::Int) => Term::binary(BinaryOp::Add, own, Term::int(1))?,
        Type::BOOL => Term::unary(UnaryOp::Not, own),
        _ => return None,
    };
    Some(Candidate {
        change: Change::Expression { site, term },
        values: Values::Fixed,
        cost: 0,
        kind: EditKind::Expression,
    })
}

/// How suspicious a value is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Suspicion {
    /// Ochiai's coefficient.
    pub(super) ochiai: f64,
    /// The share of the wrong pixels that depend on the value. An edit repairs no others.
    pub(super) coverage: f64,
}

impl Suspicion {
    fn scaled(self, factor: f64) -> Self {
        Self {
            ochiai: factor * self.ochiai,
            coverage: factor * self.coverage,
        }
    }

    pub(super) fn max(self, other: Self) -> Self {
        Self {
            ochiai: self.ochiai.max(other.ochiai),
            coverage: self.coverage.max(other.coverage),
        }
    }
}

/// The suspicion of a value whose change changes the colors at the probes to these.
pub(super) fn suspicion(probes: &[Probe], after: &[[f64; 3]], weight: f64) -> Suspicion {
    let (mut wrong, mut right) = (0.0, 0.0);
    for (probe, &new) in probes.iter().zip(after) {
        if differ(probe.before, new, CHANGED) {
            *(if probe.is_wrong { &mut wrong } else { &mut right }) += 1.0;
        }
    }
    if wrong == 0.0 {
        return Suspicion::default();
    }
    let all_wrong = probes.iter().filter(|probe| probe.is_wrong).count() as f64;
    Suspicion {
        ochiai: weight * wrong / (all_wrong * (wrong + right)).sqrt(),
        coverage: wrong / all_wrong,
    }
}

/// The suspicion of each site: measured, or that of the expression that uses its value. `measured` is `None`
/// if a site was not changed.
pub(super) fn suspicions(shader: &Shader, measured: &[Option<Suspicion>]) -> Vec<Suspicion> {
    let tree = shader.tree;
    let mut suspicions: Vec<Suspicion> = measured.iter().map(|own| own.unwrap_or_default()).collect();
    let places: std::collections::HashMap<_, usize> = shader
        .sites
        .iter()
        .enumerate()
        .map(|(at, site)| (site.exprs[0], at))
        .collect();
    // Users come after their operands.
    for at in (0..shader.sites.len()).rev() {
        let Some(user) = shader.sites[at].user.and_then(|user| places.get(&user)) else {
            continue;
        };
        let is_compared = tree[shader.sites[*user].exprs[0]].ty == Type::BOOL;
        if is_compared || measured[at].is_none() {
            suspicions[at] = suspicions[at].max(suspicions[*user].scaled(INHERITED));
        }
    }
    // A store is as suspicious as the stored value.
    for at in 0..shader.sites.len() {
        if let ExprKind::Assign { value, .. } = tree[shader.sites[at].exprs[0]].kind
            && let Some(&value) = places.get(&value)
        {
            suspicions[at] = suspicions[value];
        }
    }
    for (site, suspicion) in shader.sites.iter().zip(&mut suspicions) {
        let statement = shader.statements[site.statement].at;
        if statement.is_some_and(|id| shader.copied.contains(&id.function)) {
            *suspicion = suspicion.scaled(COPIED);
        }
    }
    suspicions
}

/// The suspicion of each statement: that of its most suspicious value, else that of the statement in front of
/// it, which may be the head of its `if`.
pub(super) fn suspicions_of_statements(shader: &Shader, sites: &[Suspicion]) -> Vec<Suspicion> {
    let mut suspicions = vec![Suspicion::default(); shader.statements.len()];
    for (site, &suspicion) in shader.sites.iter().zip(sites) {
        let own = &mut suspicions[site.statement];
        *own = own.max(suspicion);
    }
    let function = |at: usize| shader.statements[at].at.map(|id| id.function);
    for at in 1..suspicions.len() {
        // A jump, or a statement whose values could not be disturbed, such as an index.
        if suspicions[at].coverage == 0.0 && function(at) == function(at - 1) {
            suspicions[at] = suspicions[at - 1];
        }
    }
    suspicions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suspicion_is_ochiais_coefficient_over_the_pixels_that_change() {
        let before = [[0.5; 3]; 8];
        let probes: Vec<Probe> = (0..8).map(|at| Probe::exact(before[at], at < 4)).collect();
        let changed = |pixels: &[usize]| {
            let mut after = before;
            for &at in pixels {
                after[at][1] = 0.6;
            }
            suspicion(&probes, &after, 1.0)
        };
        assert_eq!(
            changed(&[0, 1, 2, 3]),
            Suspicion {
                ochiai: 1.0,
                coverage: 1.0
            }
        );
        // w = 2, W = 4, r = 1: 2 / sqrt(4 * 3).
        let some = changed(&[0, 1, 7]);
        assert!((some.ochiai - 2.0 / 12f64.sqrt()).abs() < 1e-12);
        assert_eq!(some.coverage, 0.5);
        assert_eq!(changed(&[4, 5]), Suspicion::default());
    }
}
