//! Cases for each step of the axes, with the reference result of each.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::axis::{Axis, Kind};
use crate::case::{Case, Step};
use crate::exact::{self, DoubleDouble};
use crate::random::Random;

/// The maximum number of samples per requested case: grazing cases are rare.
const MAX_ATTEMPTS_PER_CASE: usize = 64;

/// The cases of all axes of a kind, step by step.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    pub(crate) cases: Vec<Case>,
    /// The reference result of each case.
    pub(crate) references: Vec<Reference>,
    pub(crate) steps: Vec<Cell>,
}

/// The cases of one step.
#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) axis: &'static str,
    pub(crate) step: Step,
    pub(crate) range: Range<usize>,
}

/// The reference result of a case.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Reference {
    /// The smallest t > 0.
    pub(crate) t: Option<DoubleDouble>,
    /// The alternative result that is also accepted, if `t` is so small that the hit may count as the ray's
    /// origin.
    pub(crate) alternative: Alternative,
    /// A part of the case is infinite or NaN: both a miss and NaN are accepted.
    pub(crate) undefined: bool,
    /// The distance from tangency, as in [`Intersection`](exact::Intersection).
    pub(crate) discriminant: f64,
}

/// Where the ray of a case starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RayStart {
    Anywhere,
    /// At the surface or within a unit in the last place of it.
    Surface,
}

impl RayStart {
    /// Where the rays of an axis start.
    pub(crate) fn on_axis(name: &str) -> Self {
        match name {
            "origin" => Self::Surface,
            _ => Self::Anywhere,
        }
    }
}

/// An alternative result that is also accepted.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) enum Alternative {
    #[default]
    Nothing,
    Miss,
    Hit(DoubleDouble),
}

/// The distance below which a hit may be ignored by a ray that starts at a surface, in radii.
const NEAR_HIT_RADII: f64 = 1e-3;

impl Reference {
    /// The reference result of secondary rays, which are not tested for their hits, and of cases of which a
    /// part is infinite or NaN.
    const UNDEFINED: Self = Self {
        t: None,
        alternative: Alternative::Nothing,
        undefined: true,
        discriminant: f64::INFINITY,
    };

    /// The reference result of a case.
    pub(crate) fn new(case: &Case, start: RayStart) -> Self {
        let (intersection, size) = match *case {
            Case::Sphere(ray_sphere) => (ray_sphere.intersection(), f64::from(ray_sphere.r)),
            Case::Quadric { o, d, q, g, k } => (exact::quadric(o, d, q, g, k), 1.0),
            Case::Secondary { .. } => (None, 1.0),
        };
        let Some(intersection) = intersection else {
            return Self::UNDEFINED;
        };
        let is_near = |t: &DoubleDouble| t.high <= NEAR_HIT_RADII * size;
        let next = intersection.roots.iter().find(|root| !is_near(root)).copied();
        let may_be_ignored = start == RayStart::Surface && intersection.t.as_ref().is_some_and(is_near);
        Self {
            t: intersection.t,
            alternative: match (may_be_ignored, next) {
                (false, _) => Alternative::Nothing,
                (true, None) => Alternative::Miss,
                (true, Some(next)) => Alternative::Hit(next),
            },
            undefined: false,
            discriminant: intersection.discriminant,
        }
    }
}

impl Cells {
    /// Samples `count` cases for each step of the axes of a kind; `None` if interrupted.
    pub(crate) fn sample(
        axes: &[Axis],
        kind: Kind,
        seed: u64,
        count: usize,
        interrupt: &AtomicBool,
    ) -> Option<Self> {
        let steps: Vec<_> = axes
            .iter()
            .filter(|axis| axis.kind == kind)
            .flat_map(|axis| axis.steps.iter().map(move |&step| (axis, step)))
            .collect();
        let sampled: Vec<Vec<_>> = steps
            .par_iter()
            .map(|(axis, step)| {
                let random = &mut Random::new(seed, &[axis.name, &step.to_string()]);
                let attempts = (0..count * MAX_ATTEMPTS_PER_CASE).map_while(|_| {
                    let stop = interrupt.load(Ordering::Relaxed);
                    (!stop).then(|| sample_case(axis, *step, random))
                });
                attempts.flatten().take(count).collect()
            })
            .collect();
        if interrupt.load(Ordering::Relaxed) {
            return None;
        }
        let mut all = Self::default();
        for ((axis, step), sampled) in steps.into_iter().zip(sampled) {
            let start = all.cases.len();
            for (case, reference) in sampled {
                all.cases.push(case);
                all.references.push(reference);
            }
            all.steps.push(Cell {
                axis: axis.name,
                step,
                range: start..all.cases.len(),
            });
        }
        Some(all)
    }
}

fn sample_case(axis: &Axis, step: Step, random: &mut Random) -> Option<(Case, Reference)> {
    let case = axis.sample(random, step)?;
    let reference = Reference::new(&case, RayStart::on_axis(axis.name));
    let is_too_near_tangency = reference.discriminant.abs() < axis.margin;
    (!is_too_near_tangency).then_some((case, reference))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::axes;
    use crate::case::Label;

    #[test]
    fn steps_are_filled_and_reproducible() {
        let axes = axes();
        let never = AtomicBool::new(false);
        for kind in [Kind::Spheres, Kind::Quadrics, Kind::Secondaries] {
            let sampled = Cells::sample(&axes, kind, 7, 20, &never).unwrap();
            for cell in &sampled.steps {
                assert_eq!(cell.range.len(), 20, "{} {}", cell.axis, cell.step);
            }
            let repeated = Cells::sample(&axes, kind, 7, 20, &never).unwrap();
            // NaN does not equal itself, but its text does.
            assert_eq!(format!("{:?}", sampled.cases), format!("{:?}", repeated.cases));
            let other = Cells::sample(&axes, kind, 8, 20, &never).unwrap();
            assert_ne!(format!("{:?}", sampled.cases), format!("{:?}", other.cases));
        }
        let stopped = AtomicBool::new(true);
        assert!(Cells::sample(&axes, Kind::Spheres, 7, 20, &stopped).is_none());
    }

    #[test]
    fn sphere_axes_contain_hits_and_misses() {
        let sampled = Cells::sample(&axes(), Kind::Spheres, 1, 200, &AtomicBool::new(false)).unwrap();
        for cell in sampled.steps {
            let hits = sampled.references[cell.range.clone()]
                .iter()
                .filter_map(|reference| reference.t)
                .count();
            let context = format!("{} {}: {hits} of 200", cell.axis, cell.step);
            match (cell.axis, cell.step) {
                ("grazing", Step::Number(delta)) => {
                    assert_eq!(hits, if delta > 0.0 { 200 } else { 0 }, "{context}");
                }
                ("parts", Step::Label(Label::ZeroDirection)) => assert_eq!(hits, 0, "{context}"),
                ("parts", Step::Label(label))
                    if ["infinite", "NaN"]
                        .iter()
                        .any(|part| label.to_string().starts_with(part)) =>
                {
                    assert_eq!(hits, 0, "{context}");
                }
                ("parts", Step::Label(Label::ZeroRadius))
                | ("origin", Step::Label(Label::OriginInside))
                | ("gap of shells", _) => {}
                ("origin", Step::Label(Label::OriginUlpInside)) => assert_eq!(hits, 200, "{context}"),
                _ => assert!((20..=195).contains(&hits), "{context}"),
            }
        }
    }
}
