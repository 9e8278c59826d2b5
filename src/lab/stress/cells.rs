//! Cases for every step of the axes, with the truth about each.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::axis::{Axis, Case, Kind, Shot, Step};
use super::exact::{self, Precise};
use super::random::Random;

/// How often a case is drawn anew, at most, for each that is wanted: grazing ones are rare.
const DRAWS: usize = 64;

/// The cases of all axes of a kind, one after the other.
#[derive(Debug, Default)]
pub(super) struct Cells {
    pub(super) cases: Vec<Case>,
    /// What is right about each.
    pub(super) exact: Vec<Truth>,
    pub(super) steps: Vec<Cell>,
}

/// The cases of one step.
#[derive(Debug)]
pub(super) struct Cell {
    pub(super) axis: &'static str,
    pub(super) step: Step,
    pub(super) range: Range<usize>,
}

/// What is right about a case.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Truth {
    /// The smallest t > 0.
    pub(super) t: Option<Precise>,
    /// Where that is so near that it may as well be taken for where the ray starts: what else is right.
    pub(super) otherwise: Otherwise,
    /// A part of the case is infinite or NaN: no hit is right, and so is NaN.
    pub(super) undefined: bool,
}

/// What else is right of a ray.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) enum Otherwise {
    #[default]
    Nothing,
    Miss,
    Hit(Precise),
}

impl Truth {
    pub(super) const UNDEFINED: Self = Self {
        t: None,
        otherwise: Otherwise::Nothing,
        undefined: true,
    };
}

/// Of a ray that starts at a surface, a hit nearer than this share of the radius may be left out.
const NEAR: f64 = 1e-3;

/// What is right about a case, and its discriminant; none where a part of it is no number. `near`: whether it starts at the surface.
pub(super) fn truth_of(case: &Case, near: bool) -> Option<(Truth, f64)> {
    let (met, size) = match *case {
        Case::Sphere(Shot { o, d, c, r }) => (exact::sphere(o, d, c, r)?, f64::from(r)),
        Case::Quadric { o, d, q, g, k } => (exact::quadric(o, d, q, g, k)?, 1.0),
        // What is asked of them is not where they meet anything.
        Case::Secondary { .. } => return None,
    };
    let next = met.roots.iter().find(|root| root.high > NEAR * size).copied();
    let is_near = |t: Precise| near && t.high <= NEAR * size;
    let truth = Truth {
        t: met.t,
        otherwise: match (met.t.is_some_and(is_near), next) {
            (false, _) => Otherwise::Nothing,
            (true, None) => Otherwise::Miss,
            (true, Some(next)) => Otherwise::Hit(next),
        },
        undefined: false,
    };
    Some((truth, met.discriminant))
}

impl Cells {
    /// So many cases for each step of the axes of that kind; none if it was interrupted.
    pub(super) fn draw(
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
        let drawn: Vec<Vec<_>> = steps
            .par_iter()
            .map(|(axis, step)| {
                let random = &mut Random::new(seed, &[axis.name, &step.to_string()]);
                let draws = (0..count * DRAWS).map_while(|_| {
                    let stop = interrupt.load(Ordering::Relaxed);
                    (!stop).then(|| drawn(axis, *step, random))
                });
                draws.flatten().take(count).collect()
            })
            .collect();
        if interrupt.load(Ordering::Relaxed) {
            return None;
        }
        let mut all = Self::default();
        for ((axis, step), drawn) in steps.into_iter().zip(drawn) {
            let start = all.cases.len();
            for (case, exact) in drawn {
                all.cases.push(case);
                all.exact.push(exact);
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

fn drawn(axis: &Axis, step: Step, random: &mut Random) -> Option<(Case, Truth)> {
    let case = axis.draw(random, step)?;
    match truth_of(&case, axis.name == "origin") {
        Some((_, discriminant)) if discriminant.abs() < axis.margin => None,
        Some((truth, _)) => Some((case, truth)),
        None => Some((case, Truth::UNDEFINED)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::axis::axes;
    use super::*;

    #[test]
    fn every_step_has_its_cases_and_a_seed_draws_them_again() {
        let axes = axes();
        let never = AtomicBool::new(false);
        for kind in [Kind::Spheres, Kind::Quadrics, Kind::Secondaries] {
            let drawn = Cells::draw(&axes, kind, 7, 20, &never).unwrap();
            for cell in &drawn.steps {
                assert_eq!(cell.range.len(), 20, "{} {}", cell.axis, cell.step);
            }
            let again = Cells::draw(&axes, kind, 7, 20, &never).unwrap();
            // NaN is not equal to itself, its words are.
            assert_eq!(format!("{:?}", drawn.cases), format!("{:?}", again.cases));
            let other = Cells::draw(&axes, kind, 8, 20, &never).unwrap();
            assert_ne!(format!("{:?}", drawn.cases), format!("{:?}", other.cases));
        }
        let stopped = AtomicBool::new(true);
        assert!(Cells::draw(&axes, Kind::Spheres, 7, 20, &stopped).is_none());
    }

    #[test]
    fn both_answers_occur_on_every_axis_of_spheres() {
        let drawn = Cells::draw(&axes(), Kind::Spheres, 1, 200, &AtomicBool::new(false)).unwrap();
        for cell in drawn.steps {
            let hits = drawn.exact[cell.range.clone()]
                .iter()
                .filter_map(|truth| truth.t)
                .count();
            let told = format!("{} {}: {hits} of 200", cell.axis, cell.step);
            match (cell.axis, cell.step) {
                ("grazing", Step::Number(delta)) => {
                    assert_eq!(hits, if delta > 0.0 { 200 } else { 0 }, "{told}");
                }
                ("parts", Step::Word("zero direction")) => assert_eq!(hits, 0, "{told}"),
                ("parts", Step::Word(word)) if word.starts_with("infinite") || word.starts_with("NaN") => {
                    assert_eq!(hits, 0, "{told}");
                }
                ("parts", Step::Word("zero radius"))
                | ("origin", Step::Word("the origin inside"))
                | ("gap of shells", _) => {}
                ("origin", Step::Word("the origin one ULP inside")) => assert_eq!(hits, 200, "{told}"),
                _ => assert!((20..=195).contains(&hits), "{told}"),
            }
        }
    }
}
