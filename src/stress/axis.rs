//! Test axes: each takes one quantity of a ray or surface to its extremes, step by step.

use crate::case::{Case, Label, MARGIN, Step};
use crate::case_sampler::{
    DEGENERATE_PARTS, SPECIAL_QUADRIC_RAYS, SPHERE_ORIGINS, concentric_shells, degenerate_sphere,
    distant_quadric, distant_sphere, grazing_secondary_ray, grazing_sphere, mirrored_ray,
    nearly_linear_quadric, offset_sphere, origin_near_sphere, scaled_sphere, special_quadric_ray,
    stretched_direction,
};
use crate::random::Random;

/// The kind of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// [`Case::Sphere`]
    Spheres,
    /// [`Case::Quadric`]
    Quadrics,
    /// [`Case::Secondary`]
    Secondaries,
}

/// The steps that are easy to compute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EasySteps {
    /// The first; each next one is harder.
    First,
    /// The one of value 1; steps get harder in both directions.
    One,
    /// Both ends; steps get harder towards the middle.
    Ends,
    /// None in particular: the steps are not ordered.
    Unordered,
}

/// A quantity taken to its extremes.
pub struct Axis {
    /// A name of one to three words; it also selects the random cases.
    pub name: &'static str,
    /// The quantity, as the title of a table's row.
    pub label: &'static str,
    /// The quantity with its definition, as the title of a chart's axis.
    pub axis_title: &'static str,
    /// The kind of the axis's cases.
    pub kind: Kind,
    /// The steps in order.
    pub steps: Vec<Step>,
    /// The easy steps.
    pub easy: EasySteps,
    /// The minimum |δ| of a case: its distance from tangency.
    pub margin: f64,
    /// Samples a case; `None` if the sample is unsuitable.
    sample: fn(&mut Random, Step) -> Option<Case>,
}

impl Axis {
    /// The description of a step.
    pub(crate) fn describe(&self, step: Step) -> String {
        match step {
            Step::Number(_) => format!("{} = {step}", self.label),
            Step::Label(label) if self.kind == Kind::Secondaries => format!("{}, {label}", self.label),
            Step::Label(label) => label.to_string(),
        }
    }

    /// Samples a case for a step, without checking its margin.
    pub(crate) fn sample(&self, random: &mut Random, step: Step) -> Option<Case> {
        (self.sample)(random, step)
    }
}

fn decades(from: i32, to: i32, by: i32) -> Vec<Step> {
    let steps = 0..=(to - from) / by;
    steps.map(|i| Step::Number(power_of_ten(from + i * by))).collect()
}

/// The f64 nearest to a power of ten.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

fn labels(labels: &[Label]) -> Vec<Step> {
    labels.iter().copied().map(Step::Label).collect()
}

/// All axes.
#[expect(clippy::too_many_lines, reason = "a table")]
#[must_use]
pub fn axes() -> Vec<Axis> {
    let spheres = |name, [label, axis_title]: [&'static str; 2], steps, easy, sample| Axis {
        name,
        label,
        axis_title,
        kind: Kind::Spheres,
        steps,
        easy,
        margin: MARGIN,
        sample,
    };
    let quadrics = |name, [label, axis_title]: [&'static str; 2], steps, easy, margin, sample| Axis {
        name,
        label,
        axis_title,
        kind: Kind::Quadrics,
        steps,
        easy,
        margin,
        sample,
    };
    let grazing = (1..=20).map(|i| Step::Number(power_of_ten(-i)));
    let missing = (1..=20).rev().map(|i| Step::Number(-power_of_ten(-i)));
    let rays = labels(&[Label::Scale1, Label::Scale1000, Label::Ground]);
    let secondary = |name, label, steps, sample| Axis {
        name,
        label,
        axis_title: "scene",
        kind: Kind::Secondaries,
        steps,
        easy: EasySteps::Unordered,
        margin: 0.0,
        sample,
    };
    vec![
        spheres(
            "scale",
            ["scene scale", "factor on all lengths"],
            decades(-30, 30, 5),
            EasySteps::One,
            scaled_sphere,
        ),
        spheres(
            "distance/radius",
            ["distance / radius", "distance of the ray origin / sphere radius"],
            decades(0, 12, 1),
            EasySteps::First,
            distant_sphere,
        ),
        Axis {
            margin: 0.0,
            ..spheres(
                "grazing",
                [
                    "grazing rays, δ",
                    "δ = 1 − (distance of the line from the center / radius)²; > 0: hit, < 0: miss",
                ],
                grazing.chain(missing).collect(),
                EasySteps::Ends,
                grazing_sphere,
            )
        },
        spheres(
            "origin",
            ["ray origin", "position of the ray origin"],
            labels(&SPHERE_ORIGINS),
            EasySteps::Unordered,
            origin_near_sphere,
        ),
        spheres(
            "gap of shells",
            ["gap between shells", "gap between concentric spheres"],
            decades(-7, -1, 1).into_iter().rev().collect(),
            EasySteps::First,
            concentric_shells,
        ),
        spheres(
            "|d|",
            ["direction length |d|", "length of the ray direction d"],
            decades(-20, 20, 2),
            EasySteps::One,
            stretched_direction,
        ),
        spheres(
            "world offset",
            ["world offset", "distance of the scene from (0, 0, 0)"],
            [Step::Number(0.0)].into_iter().chain(decades(1, 7, 1)).collect(),
            EasySteps::First,
            offset_sphere,
        ),
        Axis {
            margin: 0.0,
            ..spheres(
                "parts",
                ["degenerate input", "kind of degenerate input"],
                labels(&DEGENERATE_PARTS),
                EasySteps::Unordered,
                degenerate_sphere,
            )
        },
        quadrics(
            "A/|q|",
            ["quadratic term A/|q|", "coefficient A of t², relative to |q|"],
            decades(-14, -1, 1).into_iter().rev().collect(),
            EasySteps::First,
            MARGIN,
            nearly_linear_quadric,
        ),
        quadrics(
            "distance/size",
            ["distance / size", "distance of the ray origin / size"],
            decades(0, 7, 1),
            EasySteps::First,
            MARGIN,
            distant_quadric,
        ),
        quadrics(
            "rays of a quadric",
            ["special ray", "kind of ray"],
            labels(&SPECIAL_QUADRIC_RAYS),
            EasySteps::Unordered,
            0.0,
            special_quadric_ray,
        ),
        secondary("mirrored rays", "mirror reflection", rays.clone(), mirrored_ray),
        secondary("grazing rays", "grazing direction", rays, grazing_secondary_ray),
    ]
}
