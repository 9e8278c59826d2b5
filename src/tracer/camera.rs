//! The course's cameras.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use toyproof_scene::{Projection, Scene};

use super::lanes::{Kernel, Lanes, Level, Wide, Wide3};
use super::ray::Ray;
use super::real::{Real, Vector};
use super::spheres::{Origins, PACKET, Packet};

#[derive(Debug)]
pub(super) struct Camera<T: Real> {
    eye: T::Vec3,
    projection: View<T>,
    width: T,
    height: T,
}

#[derive(Debug)]
enum View<T> {
    Pinhole { screen_distance: T },
    Parallel { half_width: T },
}

impl<T: Real> Camera<T> {
    pub(super) fn new(scene: &Scene) -> Self {
        let [width, height] = scene.film.size.map(|side| T::from_f64(f64::from(side)));
        Self {
            eye: T::Vec3::from_f64(scene.camera.eye),
            projection: match scene.camera.projection {
                Projection::Pinhole { screen_distance } => View::Pinhole {
                    screen_distance: T::from_f64(screen_distance),
                },
                Projection::Parallel { width } => View::Parallel {
                    half_width: T::from_f64(0.5 * width),
                },
            },
            width,
            height,
        }
    }

    /// The place on the screen of the fragment coordinates (fx, fy), in pixels from the bottom left:
    /// `x = 2 fx / width − 1`, `y = (2 fy / height − 1) / aspect`.
    pub(super) fn screen(&self, [fx, fy]: [T; 2]) -> [T; 2] {
        [self.screen_x(fx), self.screen_y(fy)]
    }

    #[inline]
    pub(super) fn screen_x(&self, fx: T) -> T {
        fx / self.width * T::from_f64(2.0) - T::one()
    }

    #[inline]
    pub(super) fn screen_y(&self, fy: T) -> T {
        (fy / self.height * T::from_f64(2.0) - T::one()) / (self.width / self.height)
    }

    /// The ray through a place on the screen.
    pub(super) fn ray(&self, [x, y]: [T; 2]) -> Ray<T> {
        let (origin, direction) = match self.projection {
            View::Pinhole { screen_distance } => {
                let mut direction = [[T::zero()]; 3];
                let towards = Towards {
                    x: &[x],
                    y: &[y],
                    screen_distance,
                    directions: direction.each_mut().map(|component| &mut component[..]),
                };
                T::run(Level::Base, towards);
                let [[x], [y], [z]] = direction;
                (self.eye, T::Vec3::new(x, y, z))
            }
            View::Parallel { .. } => (self.start([x, y]), T::Vec3::from_f64(AHEAD)),
        };
        Ray {
            origin,
            direction,
            from: None,
        }
    }

    /// The same rays, together.
    pub(super) fn packet(&self, [x, y]: &[[T; PACKET]; 2], level: Level) -> Packet<T> {
        let mut directions = AHEAD.map(|component| [T::from_f64(component); PACKET]);
        let origins = match self.projection {
            View::Pinhole { screen_distance } => {
                let towards = Towards {
                    x,
                    y,
                    screen_distance,
                    directions: directions.each_mut().map(|component| &mut component[..]),
                };
                T::run(level, towards);
                Origins::One(self.eye.to_array())
            }
            View::Parallel { .. } => {
                let start = |at: usize, axis: usize| self.start([x[at], y[at]]).to_array()[axis];
                Origins::Each([0, 1, 2].map(|axis| std::array::from_fn(|at| start(at, axis))))
            }
        };
        Packet::full(origins, directions)
    }

    /// Where a parallel ray starts.
    fn start(&self, [x, y]: [T; 2]) -> T::Vec3 {
        let half_width = match self.projection {
            View::Parallel { half_width } => half_width,
            View::Pinhole { .. } => T::zero(),
        };
        self.eye + T::Vec3::new(x * half_width, y * half_width, T::zero())
    }
}

/// Where parallel rays go.
const AHEAD: [f64; 3] = [0.0, 0.0, -1.0];

/// Directions from a pinhole to places on the screen, (x, y, −`screen_distance`), of length 1.
struct Towards<'a, T> {
    x: &'a [T],
    y: &'a [T],
    screen_distance: T,
    directions: [&'a mut [T]; 3],
}

impl<T: Real> Kernel<T> for Towards<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let distance = Wide::splat(simd, self.screen_distance);
        let mut at = 0;
        while at < self.x.len() {
            let (x, y) = (Wide::load(simd, &self.x[at..]), Wide::load(simd, &self.y[at..]));
            let Wide3(x, y, z) = Wide3(x, y, -distance).normalize(simd);
            x.store(&mut self.directions[0][at..]);
            y.store(&mut self.directions[1][at..]);
            z.store(&mut self.directions[2][at..]);
            at += S::COUNT;
        }
    }
}
