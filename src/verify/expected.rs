//! What shaders of one scene should paint, remembered from one shader to the next.

use std::collections::HashMap;
use std::mem::size_of;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use toyproof_image::{Frame, Image};
use toyproof_scene::{Moment, Scene};
use toyproof_tracer::{Hull, RayStyles, StyleFamily, Styles, Tracer};

use crate::compare::{EXACT_TOLERANCE, SEEN};

/// Of pictures of more pixels nothing is kept, for they are many times this: one of 1920×1080 takes 32 MB.
const MOST_PIXELS: u32 = 1 << 21;

/// So many hulls of a scene are kept: one for each pixel of a picture of 640×360 in either style, and room to spare.
const MOST_HULLS: usize = 1 << 19;

/// In so many scenes whose numbers are moved a little, and in as many where they are moved the other way, a pixel is looked at.
const PERTURBATIONS: u32 = 4;

/// By how much of their size numbers are moved: a few units in the last place of what shaders compute with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Digits {
    /// In f64.
    Double,
    /// In f32.
    Single,
}

impl Digits {
    fn share(self) -> f64 {
        match self {
            Self::Double => 4.0 * f64::EPSILON,
            Self::Single => 2.0 * f64::from(f32::EPSILON),
        }
    }

    /// A pixel that moves by more has another color.
    fn tolerance(self) -> f64 {
        match self {
            Self::Double => EXACT_TOLERANCE,
            Self::Single => SEEN,
        }
    }
}

/// What a pixel is asked for, and the answer.
type Row = HashMap<(u32, Styles), Hull>;

/// The answers of the tracer to a scene in one frame. They are worked out when they are first asked for, and any thread may ask: what many
/// shaders are compared with is traced once, unless it is too large to be kept.
#[derive(Debug)]
pub struct Expected {
    scene: Scene,
    moment: Moment,
    tracer: Tracer<f64>,
    /// Bands of the picture, by their first rows; none if it is too large.
    bands: HashMap<u32, OnceLock<Arc<Image>>>,
    /// How many hulls may be kept.
    room: usize,
    /// By rows from the bottom, so that threads seldom wait for each other.
    hulls: Box<[Mutex<Row>]>,
    kept: AtomicUsize,
    families: OnceLock<Vec<StyleFamily>>,
    /// Of the scene with its numbers moved, for either digits.
    perturbed: [OnceLock<Vec<Tracer<f64>>>; 2],
}

impl Expected {
    /// Of a scene at the moment and in the size of that frame.
    #[must_use]
    pub fn new(mut scene: Scene, frame: &Frame) -> Self {
        scene.film.size = frame.size;
        let moment = Moment {
            frame: frame.frame,
            time: f64::from(frame.time),
        };
        let [width, height] = frame.size;
        let is_kept = width.saturating_mul(height) <= MOST_PIXELS;
        let bands = frame
            .bands()
            .filter(|_| is_kept)
            .map(|rows| (rows.start, OnceLock::new()))
            .collect();
        Self {
            tracer: Tracer::at(&scene, moment),
            bands,
            room: if is_kept { MOST_HULLS } else { 0 },
            hulls: (0..height).map(|_| Mutex::default()).collect(),
            kept: AtomicUsize::new(0),
            families: OnceLock::new(),
            perturbed: Default::default(),
            scene,
            moment,
        }
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How much memory its answers take so far, in bytes, roughly.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let bands = self.bands.values().filter_map(OnceLock::get);
        let pixels: usize = bands.map(|band| band.pixels().len()).sum();
        // A table is between half and seven eighths full.
        let hulls = 2 * self.kept.load(Ordering::Relaxed);
        pixels * size_of::<[f32; 4]>() + hulls * size_of::<((u32, Styles), Hull)>()
    }

    /// The scene with everything where it is at the moment.
    pub(super) fn stilled(&self) -> Scene {
        self.scene.at(self.moment)
    }

    pub(super) fn tracer(&self) -> &Tracer<f64> {
        &self.tracer
    }

    /// A band of the reference picture. Who comes while it is traced waits for it, which no thread of rayon's may do.
    pub(super) fn rows(&self, rows: &Range<u32>) -> Arc<Image> {
        let trace = || Arc::new(self.tracer.rows(rows.clone(), || ()));
        match self.bands.get(&rows.start) {
            Some(band) => Arc::clone(band.get_or_init(trace)),
            None => trace(),
        }
    }

    /// [`Tracer::style_families`]
    pub(super) fn families(&self) -> &[StyleFamily] {
        self.families.get_or_init(|| self.tracer.style_families())
    }

    /// [`Tracer::styled`]
    pub(super) fn styled(&self, x: u32, y: u32, styles: &RayStyles) -> [f64; 3] {
        self.tracer.styled([x, y], styles)
    }

    /// Whether the reference itself is another color in a pixel when the scene's numbers are moved by a few units in the last place: what
    /// a shader paints there, rounding decides, whatever its formulas.
    pub(super) fn is_tied(&self, x: u32, y: u32, digits: Digits) -> bool {
        let perturbed = self.perturbed[digits as usize].get_or_init(|| {
            let stilled = self.stilled();
            let moved = (0..PERTURBATIONS).flat_map(|seed| {
                let share = digits.share();
                [share, -share].map(|share| Tracer::new(&stilled.perturbed(seed, share)))
            });
            moved.collect()
        });
        let clamped = |tracer: &Tracer<f64>| tracer.pixel(x, y).map(|part| part.clamp(0.0, 1.0));
        let own = clamped(&self.tracer);
        perturbed.iter().any(|tracer| {
            let other = clamped(tracer);
            (0..3).any(|i| (own[i] - other[i]).abs() > digits.tolerance())
        })
    }

    /// [`Tracer::hull`]
    pub(super) fn hull(&self, x: u32, y: u32, styles: Styles) -> Hull {
        let row = || {
            let row = &self.hulls[y as usize];
            row.lock().unwrap_or_else(PoisonError::into_inner)
        };
        if let Some(&hull) = row().get(&(x, styles)) {
            return hull;
        }
        let hull = self.tracer.hull(x, y, styles);
        if self.kept.load(Ordering::Relaxed) < self.room && row().insert((x, styles), hull).is_none() {
            self.kept.fetch_add(1, Ordering::Relaxed);
        }
        hull
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
    fn a_band_is_traced_once_for_all_who_ask() {
        let expected = expected([64, 36]);
        assert_eq!(expected.bytes(), 0);
        let rows = 0..36;
        let bands: Vec<_> = std::thread::scope(|scope| {
            let asking: Vec<_> = (0..4).map(|_| scope.spawn(|| expected.rows(&rows))).collect();
            asking.into_iter().map(|asked| asked.join().unwrap()).collect()
        });
        let band = expected.rows(&rows);
        assert!(bands.iter().all(|other| Arc::ptr_eq(other, &band)));
        assert_eq!(*band, expected.tracer.picture(|| ()));
        assert_eq!(expected.bytes(), 64 * 36 * 16);
    }

    #[test]
    fn nothing_is_kept_of_a_large_picture() {
        let expected = expected([1 << 15, 65]);
        let rows = 64..65;
        assert_eq!(expected.rows(&rows), expected.rows(&rows));
        assert_eq!(
            expected.hull(0, 64, Styles::Alike),
            expected.tracer.hull(0, 64, Styles::Alike)
        );
        assert_eq!(expected.bytes(), 0);
    }

    #[test]
    fn a_hull_is_the_tracers_own_also_when_it_is_remembered() {
        let expected = expected([64, 36]);
        for _ in 0..2 {
            for (x, y) in [(32, 18), (25, 18), (0, 35)] {
                for styles in [Styles::Alike, Styles::Mixed] {
                    assert_eq!(expected.hull(x, y, styles), expected.tracer.hull(x, y, styles));
                }
            }
            assert_eq!(expected.kept.load(Ordering::Relaxed), 6);
        }
    }

    #[test]
    fn no_more_hulls_are_kept_than_there_is_room_for() {
        let expected = expected([64, 36]);
        expected.kept.store(MOST_HULLS - 1, Ordering::Relaxed);
        for x in 0..4 {
            assert_eq!(
                expected.hull(x, 0, Styles::Alike),
                expected.tracer.hull(x, 0, Styles::Alike)
            );
        }
        assert_eq!(expected.kept.load(Ordering::Relaxed), MOST_HULLS);
        assert_eq!(expected.hulls[0].lock().unwrap().len(), 1);
    }
}
