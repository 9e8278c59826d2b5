//! A scene as reference: the image of the tracer, and the other accepted colors.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rayon::prelude::*;
use toyproof_image::Frame;
use toyproof_scene::{FrameTime, Scene};
use toyproof_tracer::{ColorRange, EpsilonFamily, EpsilonSet, RayEpsilons, Tracer};

use super::bands::{Bands, ReferenceBand, is_cached};
use super::number_type::NumberType;
use crate::compare::{EXACT_TOLERANCE, EpsilonColors, SEEN};

/// The largest number of color ranges of a scene that are cached: more than one for each pixel of an image of
/// 640×360 in either epsilon set.
const MAX_CACHED_RANGES: usize = 1 << 19;

/// The number of perturbations of a scene with which a pixel is traced; each is applied with both signs.
const PERTURBATIONS: u32 = 4;

/// The largest share of a band's pixels that are tested for an edge of the scene in the pixel: fewer lie on
/// the rows and columns along which a scene with round numbers has edges. If more differ, or change with the
/// number type, edges are not the cause.
const MAX_TIED_SHARE: f64 = 0.05;

/// The cached color ranges of a row, by column and epsilon set.
type Row = HashMap<(u32, EpsilonSet), ColorRange>;

/// The tracer's results for a scene in one frame.
#[derive(Debug)]
pub struct SceneReference {
    scene: Scene,
    time: FrameTime,
    tracer: Tracer<f64>,
    bands: Bands,
    /// The largest number of color ranges in the cache.
    capacity: usize,
    /// By rows from the bottom, so that threads seldom contend for a lock.
    color_ranges: Box<[Mutex<Row>]>,
    cached: AtomicUsize,
    families: OnceLock<Vec<EpsilonFamily>>,
    /// Tracers of the perturbed scenes, for either number type.
    perturbed: [OnceLock<Vec<Tracer<f64>>>; 2],
}

impl SceneReference {
    pub(super) fn new(mut scene: Scene, frame: &Frame) -> Self {
        scene.film.size = frame.size;
        let time = FrameTime::from(frame);
        Self {
            tracer: Tracer::at(&scene, time),
            bands: Bands::new(frame),
            capacity: if is_cached(frame.size) {
                MAX_CACHED_RANGES
            } else {
                0
            },
            color_ranges: (0..frame.size[1]).map(|_| Mutex::default()).collect(),
            cached: AtomicUsize::new(0),
            families: OnceLock::new(),
            perturbed: Default::default(),
            scene,
            time,
        }
    }

    /// The reference of another scene in the same frame.
    #[must_use]
    pub fn with_scene(&self, scene: Scene) -> Self {
        let frame = Frame {
            size: self.scene.film.size,
            frame: self.time.frame,
            time: self.time.time as f32,
            ..Frame::default()
        };
        Self::new(scene, &frame)
    }

    /// The scene, as it is given.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn bytes(&self) -> usize {
        // A table is between half and seven eighths full.
        let color_ranges = 2 * self.cached.load(Ordering::Relaxed);
        self.bands.bytes() + color_ranges * size_of::<((u32, EpsilonSet), ColorRange)>()
    }

    /// The scene at the frame's time, without motion.
    pub fn at_moment(&self) -> Scene {
        self.scene.at(self.time)
    }

    /// The tracer, in double precision.
    #[must_use]
    pub fn tracer(&self) -> &Tracer<f64> {
        &self.tracer
    }

    pub(super) fn rows(&self, rows: &Range<u32>) -> Arc<ReferenceBand> {
        self.bands.get_or_render(rows, || ReferenceBand {
            image: self.tracer.rows(rows.clone(), || ()),
            undefined: Vec::new(),
        })
    }

    /// The colors of some rows.
    pub(super) fn band(&self, rows: &Range<u32>) -> SceneBand<'_> {
        SceneBand {
            scene: self,
            offset: rows.start,
        }
    }

    /// Returns those of the `wanted` pixels of some rows in which the scene has an edge: no shader can
    /// resolve its side.
    pub(super) fn tied(&self, rows: &Range<u32>, wanted: &[bool], number_type: NumberType) -> Vec<bool> {
        let count = wanted.iter().filter(|&&wanted| wanted).count();
        if count as f64 > MAX_TIED_SHARE * wanted.len() as f64 {
            return vec![false; wanted.len()];
        }
        let width = self.scene.film.size[0];
        let pixels = wanted.par_iter().enumerate().map(|(at, &wanted)| {
            let at = at as u32;
            wanted && self.is_tied(at % width, rows.start + at / width, number_type)
        });
        pixels.collect()
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
        let tolerance = match number_type {
            NumberType::Double => EXACT_TOLERANCE,
            NumberType::Single => SEEN,
        };
        perturbed.iter().any(|tracer| {
            let other = clamped(tracer);
            (0..3).any(|i| (own[i] - other[i]).abs() > tolerance)
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

/// The colors that a scene accepts in the band that begins at a row.
#[derive(Debug)]
pub(super) struct SceneBand<'a> {
    scene: &'a SceneReference,
    offset: u32,
}

impl EpsilonColors for SceneBand<'_> {
    fn color_range(&self, x: u32, y: u32, epsilons: EpsilonSet) -> ColorRange {
        self.scene.color_range(x, self.offset + y, epsilons)
    }
    fn families(&self) -> &[EpsilonFamily] {
        let scene = self.scene;
        scene.families.get_or_init(|| scene.tracer.epsilon_families())
    }
    fn pixel_with_epsilons(&self, x: u32, y: u32, epsilons: &RayEpsilons) -> [f64; 3] {
        self.scene
            .tracer
            .pixel_with_epsilons([x, self.offset + y], epsilons)
    }
    fn samples(&self) -> u32 {
        self.scene.tracer.samples()
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_scene as scene;

    use super::*;

    fn expected(size: [u32; 2]) -> SceneReference {
        let mut files = Files::default();
        let text = "[[light]]\nposition = [5.0, 5.0, 0.0]\ncolor = [1.0, 1.0, 1.0]\n\
                    [[sphere]]\ncenter = [0.0, 0.0, -6.0]\nradius = 1.5\n\
                    material = { model = \"lambert\", color = [1.0, 1.0, 0.0] }\n";
        let file = files.add(File::new("s", text));
        let frame = Frame {
            size,
            ..Frame::default()
        };
        SceneReference::new(scene::parse(&files, file).unwrap(), &frame)
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
        assert_eq!(band.image, expected.tracer.render(|| ()));
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
    fn edges_are_not_the_cause_where_most_pixels_differ() {
        // Their rays touch the sphere.
        let expected = expected([64, 36]);
        let rows = 0..36;
        let tied = |wanted: &[bool]| expected.tied(&rows, wanted, NumberType::Single);
        let edges: Vec<bool> = (0..64 * 36)
            .map(|at| expected.is_tied(at % 64, at / 64, NumberType::Single))
            .collect();
        assert_eq!(tied(&edges), edges);
        assert!(!tied(&[true; 64 * 36]).contains(&true));
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
