//! Reference shaders with other random numbers, and reference images, which have no random numbers.

use std::sync::Arc;

use rayon::prelude::*;
use toyproof_eval::{MAX_VALUES, ParametricProgram, Places, Point, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::{Frame, Image};

use crate::bounds::{EXPLANATION_TIMEOUT, MAX_ITERATIONS};
use crate::evaluator::evaluate_at;
use crate::expected::{DEFAULT_TOLERANCE, ImageReference, ShaderReference};
use crate::random::estimates::{
    ESTIMATE_SETS, Estimate, Estimates, RESAMPLES, StochasticReference, differ_by, mean, of_pixel, pixels,
    variance,
};
use crate::random::replicate_test::{ReplicatedPixel, is_correlated, neighbor_correlations};
use crate::random::replicates::{self, MAX_DISTANCE_RATIO, MIN_RANDOM_CHANGE, RANDOMNESS_GRID};
use crate::random::reseed::{Reseeding, is_deterministic};

/// The number of sets of random numbers that show whether a reseeding changes the random numbers alone.
const TRIED_SETS: u32 = 4;

/// Upper limit of d²(image)/d²(set), each measured from the mean of n sets. For an independent image the
/// expected ratio is (n + 1)/(n − 1).
const MAX_RATIO: f64 = MAX_DISTANCE_RATIO * (TRIED_SETS + 1) as f64 / (TRIED_SETS - 1) as f64;

/// The largest variance of correlated noise as a share of the variance of the image's pixels.
const MAX_NOISE_SHARE: f64 = 0.5;

/// The least correlation of neighbors, in x and in y, of noise that is smooth: value noise of several octaves
/// has more, though the cells of the last ones are as small as pixels.
const MIN_SMOOTHNESS: f64 = 0.6;

type Colors = Vec<[f64; 3]>;

impl ShaderReference {
    /// How the random numbers can be changed; `None` if there are no random numbers, or nothing changes them
    /// alone. Computed once.
    fn reseeding(&self) -> Option<Reseeding> {
        *self.reseeding.get_or_init(|| {
            if is_deterministic(self.checked()) {
                return None;
            }
            let places = Places::spread(self.frame.size, [RANDOMNESS_GRID; 2]);
            let own = self.set(None, 0, &places)?;
            let mut all = Reseeding::all().into_iter();
            all.find(|&reseeding| {
                self.changes_noise_alone(reseeding, &own, &places)
                    .unwrap_or(false)
            })
        })
    }

    /// Whether a reseeding changes pixels, and the unchanged image is like the changed ones. `None` if a
    /// pixel runs too many loop iterations.
    fn changes_noise_alone(&self, reseeding: Reseeding, own: &Colors, places: &Places) -> Option<bool> {
        let first = self.set(Some(reseeding), 1, places)?;
        let changes = |(&a, &b): (&[f64; 3], &[f64; 3])| differ_by(a, b, MIN_RANDOM_CHANGE);
        if !own.iter().zip(&first).any(changes) {
            return Some(false);
        }
        let others = (2..=TRIED_SETS).map(|set| self.set(Some(reseeding), set, places));
        let sets: Vec<Colors> = [Some(first)].into_iter().chain(others).collect::<Option<_>>()?;
        let (mut own_distance, mut distance) = (0.0, 0.0);
        for (at, own) in own.iter().enumerate() {
            let colors = of_pixel(&sets, at);
            let mean = mean(&colors);
            own_distance += squared_distance(own, &mean);
            let distances = colors.iter().map(|color| squared_distance(color, &mean));
            distance += distances.sum::<f64>() / f64::from(TRIED_SETS);
        }
        Some(own_distance <= MAX_RATIO * distance)
    }

    /// The colors at these places with a set of random numbers; with the shader's own without a reseeding.
    fn set(&self, reseeding: Option<Reseeding>, set: u32, places: &Places) -> Option<Colors> {
        let image = match reseeding {
            None => evaluate_at(&self.program, &self.frame, places, MAX_ITERATIONS),
            Some(reseeding) => reseeding.evaluate(self.checked(), set, &self.frame, places, None),
        };
        image.map(|image| colors(&image))
    }

    /// The colors of some pixels with a set of random numbers.
    fn pixels(&self, reseeding: Reseeding, set: u32, pixels: &[[u32; 2]]) -> Option<Colors> {
        let checked = reseeding.apply(self.checked(), set);
        let program =
            ParametricProgram::new(&checked, &[], &self.frame, MAX_VALUES, EXPLANATION_TIMEOUT).ok()?;
        let [dx, dy] = Reseeding::shift(set);
        // Derivatives need whole quads.
        let corners = [[0, 0], [1, 0], [0, 1], [1, 1]];
        let quads = pixels.iter().flat_map(|&[x, y]| {
            let corner = move |[i, j]: [u32; 2]| [f64::from(x / 2 * 2 + i), f64::from(y / 2 * 2 + j)];
            corners.map(corner).map(|[x, y]| Point {
                at: [x + 0.5 + dx, y + 0.5 + dy],
                values: &[],
            })
        });
        let quads: Vec<Point> = quads.collect();
        let settings = Settings::<f64> {
            max_iterations: MAX_ITERATIONS,
            ..Settings::default()
        };
        let colors = program.evaluate(&self.frame, &settings, |evaluator| evaluator.colors(&quads));
        let colors = colors.ok()?;
        let own = pixels.iter().zip(colors.chunks(4));
        own.map(|([x, y], quad)| quad[(x % 2 + 2 * (y % 2)) as usize])
            .collect()
    }

    /// Estimates pixels from several sets of random numbers; `None` if there are no random numbers.
    fn estimated(&self, places: &Places) -> Option<Estimates> {
        let reseeding = self.reseeding()?;
        let own = self.set(None, 0, places)?;
        let sets = (1..ESTIMATE_SETS.end).map(|set| self.set(Some(reseeding), set, places));
        let sets: Vec<Colors> = sets.collect::<Option<_>>()?;
        let estimates = own.iter().enumerate().map(|(at, own)| {
            let displayed = own.map(|part| part.clamp(0.0, 1.0));
            Estimate::new(displayed, |set| sets[set as usize - 1][at])
        });
        let estimates: Vec<Estimate> = estimates.collect();
        let random = pixels(places)
            .into_iter()
            .zip(&estimates)
            .filter(|(_, estimate)| estimate.is_random(self));
        let noise: Vec<ReplicatedPixel> = random.map(|(at, estimate)| estimate.replicated(at)).collect();
        let [x, y, ..] = neighbor_correlations(&noise);
        Some(Estimates {
            are_correlated: is_correlated(&noise),
            axis_correlation: x.min(y),
            pixels: estimates,
        })
    }

    /// Whether the random numbers determine the content of the image, such as the places of objects or the
    /// shape of clouds, rather than its noise: neighboring pixels change together, and by as much as pixels
    /// differ from each other; or they change smoothly, though the numbers depend on the pixel, as those of a
    /// lattice do. A sampler's numbers differ from pixel to pixel, or do not depend on it.
    fn is_content(&self, estimates: &Estimates) -> bool {
        let is_lattice = || {
            let reseeding = self.reseeding();
            reseeding.is_some_and(|reseeding| reseeding.depends_on_pixel(self.checked()))
        };
        if estimates.axis_correlation > MIN_SMOOTHNESS && is_lattice() {
            return true;
        }
        let own: Colors = estimates.pixels.iter().map(|estimate| estimate.own).collect();
        let noise = estimates.pixels.iter().map(|estimate| estimate.variance);
        let noise: f64 = noise.map(|variance| variance.iter().sum::<f64>()).sum();
        let of_image = variance(&own).iter().sum::<f64>() * own.len() as f64;
        estimates.are_correlated && noise > MAX_NOISE_SHARE * of_image
    }
}

/// Whether a shader has random numbers that determine its content rather than its noise.
pub(crate) fn draws_by_random_numbers(checked: &Checked, frame: &Frame) -> bool {
    let Ok(program) = Program::prepared(checked, UndefinedPolicy::Plain) else {
        return false;
    };
    let shader =
        ShaderReference::unevaluated(Arc::new(program), frame, DEFAULT_TOLERANCE, EXPLANATION_TIMEOUT);
    shader.reseeding().is_some() && !shader.is_stochastic()
}

fn colors(image: &Image) -> Colors {
    let color = |&[r, g, b, _]: &[f32; 4]| [r, g, b].map(f64::from);
    image.pixels().iter().map(color).collect()
}

fn squared_distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3)
        .map(|i| (a[i].clamp(0.0, 1.0) - b[i].clamp(0.0, 1.0)).powi(2))
        .sum()
}

/// Nothing is known about how the shader combines its samples.
impl StochasticReference for ShaderReference {
    fn is_stochastic(&self) -> bool {
        let estimates = || self.estimates(&replicates::places(self.frame.size, self));
        self.reseeding().is_some() && estimates().is_none_or(|estimates| !self.is_content(&estimates))
    }

    fn estimates(&self, places: &Places) -> Option<Arc<Estimates>> {
        let estimated = || self.estimated(places).map(Arc::new);
        let (known, estimates) = self.estimates.get_or_init(|| (places.clone(), estimated()));
        if known == places {
            estimates.clone()
        } else {
            estimated()
        }
    }

    fn are_random(&self, pixels: &[[u32; 2]]) -> Vec<bool> {
        let Some(reseeding) = self.reseeding() else {
            return vec![false; pixels.len()];
        };
        let sets: Option<Vec<Colors>> = (1..=RESAMPLES)
            .into_par_iter()
            .map(|set| self.pixels(reseeding, set, pixels))
            .collect();
        let Some(sets) = sets else {
            return vec![false; pixels.len()];
        };
        let is_random = |at: usize| {
            let displayed = |set: &Colors| set[at].map(|part| part.clamp(0.0, 1.0));
            let first = displayed(&sets[0]);
            sets.iter()
                .any(|set| differ_by(first, displayed(set), MIN_RANDOM_CHANGE))
        };
        (0..pixels.len()).map(is_random).collect()
    }

    fn sets(&self, places: &Places, count: u32) -> Option<Vec<Colors>> {
        let reseeding = self.reseeding()?;
        let displayed = |set: Colors| {
            set.into_iter()
                .map(|color| color.map(|part| part.clamp(0.0, 1.0)))
                .collect()
        };
        (1..=count)
            .map(|set| self.set(Some(reseeding), set, places).map(displayed))
            .collect()
    }

    fn least_change(&self) -> f64 {
        // Moving the pixel by a thousandth of its size changes it less.
        MIN_RANDOM_CHANGE
    }
}

/// A single image says nothing about its noise.
impl StochasticReference for ImageReference {
    fn is_stochastic(&self) -> bool {
        true
    }

    fn estimates(&self, _: &Places) -> Option<Arc<Estimates>> {
        None
    }

    fn are_random(&self, pixels: &[[u32; 2]]) -> Vec<bool> {
        vec![false; pixels.len()]
    }

    fn sets(&self, _: &Places, _: u32) -> Option<Vec<Colors>> {
        None
    }
}
