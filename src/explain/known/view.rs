//! Views: a few pixels of a frame at which a submission is compared with mutants.

use toyproof_eval::Places;
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image};
use toyproof_scene::{Integrator, Scene};
use toyproof_verify::bounds::MAX_ITERATIONS;
use toyproof_verify::evaluator::evaluate_at;

use crate::engine::probes::{Limits, Probes};
use crate::known::mutant::Mutant;

/// Some pixels of a frame, in whole quads spread over it. Each has the color that it has in the frame, in the
/// frame's own size and aspect ratio.
#[derive(Debug, Clone)]
pub(super) struct View {
    pub(super) frame: Frame,
    pub(super) places: Places,
}

impl View {
    /// Selects at most `side` columns and rows, and at most `all` pixels.
    pub(super) fn new(frame: &Frame, side: u32, all: u64) -> Self {
        let [width, height] = frame.size;
        let divided = |divisor: u32| {
            [width, height].map(|own| match own / divisor {
                side if divisor == 1 || side < 2 => side.max(1),
                side => side & !1,
            })
        };
        let is_small = |divisor: &u32| {
            let [width, height] = divided(*divisor);
            width.max(height) <= side && u64::from(width) * u64::from(height) <= all
        };
        let divisor = (1..=width.max(height)).find(is_small).unwrap_or(u32::MAX);
        Self {
            places: Places::spread(frame.size, divided(divisor)),
            frame: frame.clone(),
        }
    }

    pub(super) fn pixels(&self) -> u64 {
        self.places.size().into_iter().map(u64::from).product()
    }

    /// Renders a shader in f64; `None` if a pixel runs too many loop iterations.
    pub(super) fn render(&self, program: &Program) -> Option<Image> {
        evaluate_at(program, &self.frame, &self.places, MAX_ITERATIONS)
    }
}

/// The number of ray-surface intersections of one unit of work.
const SURFACES_PER_WORK: usize = 8;

/// The work of a pixel.
pub(super) fn cost_per_pixel(scene: &Scene) -> u64 {
    let rays = match scene.film.integrator {
        Integrator::Path => 2 * u64::from(scene.film.max_depth),
        Integrator::Whitted => 1,
    };
    // In a grid, a ray tests only the spheres along its path.
    let scatters = scene.scatters.iter();
    let in_grids: usize = scatters.clone().map(|scattered| scattered.objects.len()).sum();
    let cells: u32 = scatters.flat_map(|scattered| scattered.scatter.cells).sum();
    let surfaces = scene.objects.len() - in_grids + cells as usize;
    let surfaces = surfaces.div_ceil(SURFACES_PER_WORK).max(1) as u64;
    u64::from(scene.film.samples) * rays * surfaces
}

/// The largest difference of equal colors. It is invisible: both images are rendered in double precision.
const COLOR_TOLERANCE: f64 = 1e-3;

/// What a mistake may leave unexplained: other ray epsilons shift the edges of shadows and of reflections.
pub(super) const MOSTLY: Limits = Limits {
    tolerance: COLOR_TOLERANCE,
    of_all: 0.005,
    of_wrong: 0.05,
    extra: 0,
    of_image: None,
};

/// What it may leave in the few pixels by which most pairs of mistakes are ruled out.
pub(super) const ROUGHLY: Limits = Limits {
    of_all: f64::INFINITY,
    of_wrong: 0.2,
    extra: 2,
    ..MOSTLY
};

/// Nothing is left.
pub(super) const COMPLETELY: Limits = Limits {
    of_all: 0.0,
    of_wrong: 0.0,
    ..MOSTLY
};

/// A submission in a view: its colors are what a mistake must render.
pub(super) struct Observation {
    pub(super) image: Image,
    pub(super) probes: Probes,
}

impl Observation {
    /// Renders the submission. Its wrong pixels are those in which it differs from the most similar of the
    /// correct images. `None` if it cannot be rendered.
    pub(super) fn new<'a>(
        submission: &Program,
        view: &View,
        correct: impl Iterator<Item = &'a Image>,
        limits: Limits,
    ) -> Option<Self> {
        let image = view.render(submission)?;
        let probes = correct.map(|correct| Probes::on_grid(&view.places, &image, correct, limits));
        let probes = probes.min_by_key(Probes::wrong)?;
        Some(Self { image, probes })
    }

    /// The number of pixels that a mutant leaves unexplained, and whether these are few.
    pub(super) fn unexplained(&self, mutant: &Mutant) -> Option<(usize, bool)> {
        let outcome = self.probes.outcome(&mutant.colors(&self.probes)?)?;
        Some((outcome.left, outcome.passes))
    }

    /// Whether a mutant explains the image.
    pub(super) fn is_explained_by(&self, mutant: &Mutant) -> bool {
        self.unexplained(mutant).is_some_and(|(_, are_few)| are_few)
    }

    /// The largest number of pixels that a mistake may leave unexplained.
    pub(super) fn most(&self) -> usize {
        MOSTLY.most(self.probes.all.len(), self.probes.wrong())
    }
}
