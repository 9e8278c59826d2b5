//! The reference of a scene in one frame, cached from one shader to the next.

use std::collections::HashMap;
use std::mem::size_of;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use toyproof_image::{Frame, Image};
use toyproof_scene::{FrameTime, Scene};
use toyproof_tracer::{ColorRange, EpsilonFamily, EpsilonSet, RayEpsilons, Tracer};

use crate::compare::{EXACT_TOLERANCE, SEEN};

/// The largest number of pixels of an image that is cached; one of 1920×1080 takes 32 MB.
const MAX_CACHED_PIXELS: u32 = 1 << 21;

/// The largest number of color ranges of a scene that are cached: more than one for each pixel of an image of
/// 640×360 in either epsilon set.
const MAX_CACHED_RANGES: usize = 1 << 19;

/// The number of perturbations of a scene with which a pixel is traced; each is applied with both signs.
const PERTURBATIONS: u32 = 4;

/// The number type whose rounding is simulated; numbers are perturbed by a few of its units in the last
/// place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NumberType {
    /// In f64.
    Double,
    /// In f32.
    Single,
}

impl NumberType {
    fn perturbation(self) -> f64 {
        match self {
            Self::Double => 4.0 * f64::EPSILON,
            Self::Single => 2.0 * f64::from(f32::EPSILON),
        }
    }

    /// The tolerance above which a pixel has changed.
    fn tolerance(self) -> f64 {
        match self {
            Self::Double => EXACT_TOLERANCE,
            Self::Single => SEEN,
        }
    }
}

/// The cached color ranges of a row, by column and epsilon set.
type Row = HashMap<(u32, EpsilonSet), ColorRange>;

/// The tracer's results for a scene in one frame. They are computed on first use, from any thread: the
/// reference of many shaders is traced once, unless it is too large for the cache.
#[derive(Debug)]
pub struct Expected {
    scene: Scene,
    time: FrameTime,
    tracer: Tracer<f64>,
    /// Bands of the image by their first rows; empty if it is too large.
    bands: HashMap<u32, OnceLock<Arc<Image>>>,
    /// The largest number of color ranges in the cache.
    capacity: usize,
    /// By rows from the bottom, so that threads seldom contend for a lock.
    color_ranges: Box<[Mutex<Row>]>,
    cached: AtomicUsize,
    families: OnceLock<Vec<EpsilonFamily>>,
    /// Tracers of the perturbed scenes, for either number type.
    perturbed: [OnceLock<Vec<Tracer<f64>>>; 2],
}

impl Expected {
    /// Creates the reference of a scene at the time and in the size of the frame.
    #[must_use]
    pub fn new(mut scene: Scene, frame: &Frame) -> Self {
        scene.film.size = frame.size;
        let time = FrameTime {
            frame: frame.frame,
            time: f64::from(frame.time),
        };
        let [width, height] = frame.size;
        let is_cached = width.saturating_mul(height) <= MAX_CACHED_PIXELS;
        let bands = frame
            .bands()
            .filter(|_| is_cached)
            .map(|rows| (rows.start, OnceLock::new()))
            .collect();
        Self {
            tracer: Tracer::at(&scene, time),
            bands,
            capacity: if is_cached { MAX_CACHED_RANGES } else { 0 },
            color_ranges: (0..height).map(|_| Mutex::default()).collect(),
            cached: AtomicUsize::new(0),
            families: OnceLock::new(),
            perturbed: Default::default(),
            scene,
            time,
        }
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The approximate memory of the cached results, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let bands = self.bands.values().filter_map(OnceLock::get);
        let pixels: usize = bands.map(|band| band.pixels().len()).sum();
        // A table is between half and seven eighths full.
        let color_ranges = 2 * self.cached.load(Ordering::Relaxed);
        pixels * size_of::<[f32; 4]>() + color_ranges * size_of::<((u32, EpsilonSet), ColorRange)>()
    }

    /// The scene at the frame's time, without motion.
    pub(super) fn at_moment(&self) -> Scene {
        self.scene.at(self.time)
    }

    pub(super) fn tracer(&self) -> &Tracer<f64> {
        &self.tracer
    }

    /// Returns a band of the reference. Callers block while another thread traces it, so no rayon thread may
    /// call this.
    pub(super) fn rows(&self, rows: &Range<u32>) -> Arc<Image> {
        let trace = || Arc::new(self.tracer.rows(rows.clone(), || ()));
        match self.bands.get(&rows.start) {
            Some(band) => Arc::clone(band.get_or_init(trace)),
            None => trace(),
        }
    }

    /// [`Tracer::epsilon_families`]
    pub(super) fn families(&self) -> &[EpsilonFamily] {
        self.families.get_or_init(|| self.tracer.epsilon_families())
    }

    /// [`Tracer::pixel_with_epsilons`]
    pub(super) fn pixel_with_epsilons(&self, x: u32, y: u32, epsilons: &RayEpsilons) -> [f64; 3] {
        self.tracer.pixel_with_epsilons([x, y], epsilons)
    }

    /// Whether the reference itself changes color in a pixel when the scene's numbers are perturbed by a few
    /// units in the last place: rounding decides the color there, whatever the shader's formulas.
    pub(super) fn is_tied(&self, x: u32, y: u32, number_type: NumberType) -> bool {
        let perturbed = self.perturbed[number_type as usize].get_or_init(|| {
            let at_moment = self.at_moment();
            let tracers = (0..PERTURBATIONS).flat_map(|seed| {
                let perturbation = number_type.perturbation();
                [perturbation, -perturbation]
                    .map(|perturbation| Tracer::new(&at_moment.perturbed(seed, perturbation)))
            });
            tracers.collect()
        });
        let clamped = |tracer: &Tracer<f64>| tracer.pixel(x, y).map(|part| part.clamp(0.0, 1.0));
        let own = clamped(&self.tracer);
        perturbed.iter().any(|tracer| {
            let other = clamped(tracer);
            (0..3).any(|i| (own[i] - other[i]).abs() > number_type.tolerance())
        })
    }

    /// [`Tracer::color_range`]
    pub(super) fn color_range(&self, x: u32, y: u32, epsilons: EpsilonSet) -> ColorRange {
        let row = || {
            let row = &self.color_ranges[y as usize];
            row.lock().unwrap_or_else(PoisonError::into_inner)
        };
        if let Some(&range) = row().get(&(x, epsilons)) {
            return range;
        }
        let range = self.tracer.color_range(x, y, epsilons);
        if self.cached.load(Ordering::Relaxed) < self.capacity && row().insert((x, epsilons), range).is_none()
        {
            self.cached.fetch_add(1, Ordering::Relaxed);
        }
        range
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_scene as scene;

    use super::*;

    fn expected(size: [u32; 2]) -> Expected {
        let mut files = Files::default();
        let text = "[[light]]\nposition = [5.0, 5.0, 0.0]\ncolor = [1.0, 1.0, 1.0]\n\
                    [[sphere]]\ncenter = [0.0, 0.0, -6.0]\nradius = 1.5\n\
                    material = { model = \"lambert\", color = [1.0, 1.0, 0.0] }\n";
        let file = files.add(File::new("s", text));
        let frame = Frame {
            size,
            ..Frame::default()
        };
        Expected::new(scene::parse(&files, file).unwrap(), &frame)
    }

    #[test]
    fn a_band_is_traced_once_for_all_callers() {
        let expected = expected([64, 36]);
        assert_eq!(expected.bytes(), 0);
        let rows = 0..36;
        let bands: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| expected.rows(&rows))).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        let band = expected.rows(&rows);
        assert!(bands.iter().all(|other| Arc::ptr_eq(other, &band)));
        assert_eq!(*band, expected.tracer.render(|| ()));
        assert_eq!(expected.bytes(), 64 * 36 * 16);
    }

    #[test]
    fn a_large_image_is_not_cached() {
        let expected = expected([1 << 15, 65]);
        let rows = 64..65;
        assert_eq!(expected.rows(&rows), expected.rows(&rows));
        assert_eq!(
            expected.color_range(0, 64, EpsilonSet::Alike),
            expected.tracer.color_range(0, 64, EpsilonSet::Alike)
        );
        assert_eq!(expected.bytes(), 0);
    }

    #[test]
    fn a_cached_color_range_equals_the_tracers() {
        let expected = expected([64, 36]);
        for _ in 0..2 {
            for (x, y) in [(32, 18), (25, 18), (0, 35)] {
                for epsilons in [EpsilonSet::Alike, EpsilonSet::Mixed] {
                    assert_eq!(
                        expected.color_range(x, y, epsilons),
                        expected.tracer.color_range(x, y, epsilons)
                    );
                }
            }
            assert_eq!(expected.cached.load(Ordering::Relaxed), 6);
        }
    }

    #[test]
    fn the_cache_of_color_ranges_is_bounded() {
        let expected = expected([64, 36]);
        expected.cached.store(MAX_CACHED_RANGES - 1, Ordering::Relaxed);
        for x in 0..4 {
            assert_eq!(
                expected.color_range(x, 0, EpsilonSet::Alike),
                expected.tracer.color_range(x, 0, EpsilonSet::Alike)
            );
        }
        assert_eq!(expected.cached.load(Ordering::Relaxed), MAX_CACHED_RANGES);
        assert_eq!(expected.color_ranges[0].lock().unwrap().len(), 1);
    }
}
