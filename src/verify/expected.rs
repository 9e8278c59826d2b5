//! What shaders of one scene should paint, remembered from one shader to the next.

use std::collections::HashMap;
use std::mem::size_of;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::frame::Frame;
use crate::image::Image;
use crate::scene::{Moment, Scene};
use crate::trace::{Hull, Styles, Tracer};

/// So many hulls of a scene are kept: one for each pixel of a picture of 640×360 in either style, and room to spare.
const MOST_HULLS: usize = 1 << 19;

/// What a pixel is asked for, and the answer.
type Row = HashMap<(u32, Styles), Hull>;

/// The answers of the tracer to a scene in one frame. They are worked out when they are first asked for, and any thread may ask: what many
/// shaders are compared with is traced once.
#[derive(Debug)]
pub struct Expected {
    scene: Scene,
    moment: Moment,
    tracer: Tracer<f64>,
    picture: OnceLock<Arc<Image>>,
    /// By rows from the bottom, so that threads seldom wait for each other.
    hulls: Box<[Mutex<Row>]>,
    kept: AtomicUsize,
}

impl Expected {
    /// Of a scene at the moment of that frame, in the size of its film.
    #[must_use]
    pub fn new(scene: Scene, frame: &Frame) -> Self {
        let moment = Moment {
            frame: frame.frame,
            time: f64::from(frame.time),
        };
        Self {
            tracer: Tracer::at(&scene, moment),
            picture: OnceLock::new(),
            hulls: (0..scene.film.size[1]).map(|_| Mutex::default()).collect(),
            kept: AtomicUsize::new(0),
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
        let picture = self.picture.get().map_or(0, |image| image.pixels().len());
        // A table is between half and seven eighths full.
        let hulls = 2 * self.kept.load(Ordering::Relaxed);
        picture * size_of::<[f32; 4]>() + hulls * size_of::<((u32, Styles), Hull)>()
    }

    /// The scene with everything where it is at the moment.
    pub(super) fn stilled(&self) -> Scene {
        self.scene.at(self.moment)
    }

    pub(super) fn tracer(&self) -> &Tracer<f64> {
        &self.tracer
    }

    /// The reference picture. Who comes while it is traced waits for it, which no thread of rayon's may do.
    pub(super) fn picture(&self) -> Arc<Image> {
        let traced = self.picture.get_or_init(|| Arc::new(self.tracer.picture(|| ())));
        Arc::clone(traced)
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
        if self.kept.load(Ordering::Relaxed) < MOST_HULLS && row().insert((x, styles), hull).is_none() {
            self.kept.fetch_add(1, Ordering::Relaxed);
        }
        hull
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;
    use crate::source::{File, Files};

    fn expected(size: [u32; 2]) -> Expected {
        let mut files = Files::default();
        let text = "[[light]]\nposition = [5.0, 5.0, 0.0]\ncolor = [1.0, 1.0, 1.0]\n\
                    [[sphere]]\ncenter = [0.0, 0.0, -6.0]\nradius = 1.5\n\
                    material = { model = \"lambert\", color = [1.0, 1.0, 0.0] }\n";
        let file = files.add(File::new("s", text));
        let mut scene = scene::parse(&files, file).unwrap();
        scene.film.size = size;
        Expected::new(scene, &Frame::default())
    }

    #[test]
    fn a_picture_is_traced_once_for_all_who_ask() {
        let expected = expected([64, 36]);
        assert_eq!(expected.bytes(), 0);
        let pictures: Vec<_> = std::thread::scope(|scope| {
            let asking: Vec<_> = (0..4).map(|_| scope.spawn(|| expected.picture())).collect();
            asking.into_iter().map(|asked| asked.join().unwrap()).collect()
        });
        assert!(
            pictures
                .iter()
                .all(|picture| Arc::ptr_eq(picture, &expected.picture()))
        );
        assert_eq!(*expected.picture(), expected.tracer.picture(|| ()));
        assert_eq!(expected.bytes(), 64 * 36 * 16);
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
