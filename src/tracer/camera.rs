//! Camera rays of a pinhole or of a parallel projection, and the 2D figures that are drawn over the scene.

use toyproof_scene::{self as scene, Outline, Projection, Scene};

use crate::lanes::{Kernel, Lanes, Level, Wide, Wide3};
use crate::ray::Ray;
use crate::real::{Real, Vector};
use crate::spheres::{Origins, PACKET_RAYS, Packet};

/// A camera, with its constants in the tracer's number type.
#[derive(Debug)]
pub(super) struct Camera<T: Real> {
    eye: T::Vec3,
    forward: T::Vec3,
    /// The directions to the right, up and forward; `None` for x, y and −z.
    axes: Option<[T::Vec3; 3]>,
    projection: ScreenProjection<T>,
    width: T,
    height: T,
    /// The positions on the screen of the centers of the columns of pixels.
    columns: Vec<T>,
    /// The positions on the screen of the centers of the rows of pixels.
    rows: Vec<T>,
}

#[derive(Debug)]
enum ScreenProjection<T> {
    Pinhole { screen_distance: T },
    Parallel { half_width: T },
}

impl<T: Real> Camera<T> {
    pub(super) fn new(scene: &Scene) -> Self {
        let [width, height] = scene.film.size.map(|side| T::from_f64(f64::from(side)));
        let centers = |side: u32| (0..side).map(|at| T::from_f64(f64::from(at)) + T::from_f64(0.5));
        let mut camera = Self {
            eye: T::Vec3::from_f64(scene.camera.eye),
            forward: T::Vec3::from_f64(scene.camera.forward()),
            axes: scene.camera.axes().map(|axes| axes.map(T::Vec3::from_f64)),
            projection: match scene.camera.projection {
                Projection::Pinhole { screen_distance } => ScreenProjection::Pinhole {
                    screen_distance: T::from_f64(screen_distance),
                },
                Projection::Parallel { width } => ScreenProjection::Parallel {
                    half_width: T::from_f64(0.5 * width),
                },
            },
            width,
            height,
            columns: Vec::new(),
            rows: Vec::new(),
        };
        let [columns, rows] = scene.film.size;
        camera.columns = centers(columns).map(|fx| camera.screen_x(fx)).collect();
        camera.rows = centers(rows).map(|fy| camera.screen_y(fy)).collect();
        camera
    }

    /// Returns where the center of a pixel is on the screen.
    #[inline]
    pub(super) fn pixel_center(&self, [column, row]: [u32; 2]) -> [T; 2] {
        [self.columns[column as usize], self.rows[row as usize]]
    }

    /// Maps the fragment coordinates (fx, fy), in pixels from the bottom left, to the screen: `x = 2 fx /
    /// width − 1`, `y = (2 fy / height − 1) / aspect`.
    pub(super) fn screen(&self, [fx, fy]: [T; 2]) -> [T; 2] {
        [self.screen_x(fx), self.screen_y(fy)]
    }

    #[inline]
    fn screen_x(&self, fx: T) -> T {
        fx / self.width * T::from_f64(2.0) - T::one()
    }

    #[inline]
    fn screen_y(&self, fy: T) -> T {
        (fy / self.height * T::from_f64(2.0) - T::one()) / (self.width / self.height)
    }

    /// Maps many fragment coordinates like [`Camera::screen`].
    pub(super) fn screen_positions(
        &self,
        level: Level,
        fragments: &[[T; PACKET_RAYS]; 2],
    ) -> [[T; PACKET_RAYS]; 2] {
        let mut screen = [[T::zero(); PACKET_RAYS]; 2];
        let kernel = ScreenPositions {
            fragments,
            size: [self.width, self.height],
            screen: &mut screen,
        };
        T::run(level, kernel);
        screen
    }

    /// Creates the ray through a point of the screen.
    pub(super) fn ray(&self, [x, y]: [T; 2]) -> Ray<T> {
        let (origin, direction) = match self.projection {
            ScreenProjection::Pinhole { screen_distance } => {
                let mut direction = [[T::zero()]; 3];
                let kernel = PinholeDirections {
                    x: &[x],
                    y: &[y],
                    screen_distance,
                    axes: self.axes.map(|axes| axes.map(T::Vec3::to_array)),
                    directions: direction.each_mut().map(|component| &mut component[..]),
                };
                T::run(Level::Base, kernel);
                let [[x], [y], [z]] = direction;
                (self.eye, T::Vec3::new(x, y, z))
            }
            ScreenProjection::Parallel { .. } => (self.parallel_origin([x, y]), self.forward),
        };
        Ray {
            origin,
            direction,
            from: None,
        }
    }

    /// Returns how far a point of a ray is from the eye along the viewing direction.
    pub(super) fn depth(&self, ray: &Ray<T>, t: T) -> T {
        (ray.origin + ray.direction * t - self.eye).dot(self.forward)
    }

    /// Creates a packet of such rays.
    pub(super) fn packet(&self, [x, y]: &[[T; PACKET_RAYS]; 2], level: Level) -> Packet<T> {
        match self.projection {
            ScreenProjection::Pinhole { screen_distance } => {
                let mut packet = Packet::full(
                    Origins::Shared(self.eye.to_array()),
                    [[T::zero(); PACKET_RAYS]; 3],
                );
                let kernel = PinholeDirections {
                    x,
                    y,
                    screen_distance,
                    axes: self.axes.map(|axes| axes.map(T::Vec3::to_array)),
                    directions: packet.directions.each_mut().map(|component| &mut component[..]),
                };
                T::run(level, kernel);
                packet
            }
            ScreenProjection::Parallel { .. } => {
                let start = |at: usize, axis: usize| self.parallel_origin([x[at], y[at]]).to_array()[axis];
                Packet::full(
                    Origins::Each([0, 1, 2].map(|axis| std::array::from_fn(|at| start(at, axis)))),
                    self.forward.to_array().map(|component| [component; PACKET_RAYS]),
                )
            }
        }
    }

    /// Returns the origin of a parallel ray.
    fn parallel_origin(&self, [x, y]: [T; 2]) -> T::Vec3 {
        let half_width = match self.projection {
            ScreenProjection::Parallel { half_width } => half_width,
            ScreenProjection::Pinhole { .. } => T::zero(),
        };
        let (x, y) = (x * half_width, y * half_width);
        match self.axes {
            None => self.eye + T::Vec3::new(x, y, T::zero()),
            Some([right, up, _]) => self.eye + (right * x + up * y),
        }
    }
}

/// Kernel for [`Camera::screen_positions`].
struct ScreenPositions<'a, T> {
    fragments: &'a [[T; PACKET_RAYS]; 2],
    size: [T; 2],
    screen: &'a mut [[T; PACKET_RAYS]; 2],
}

impl<T: Real> Kernel<T> for ScreenPositions<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let [width, height, aspect, one, two] = [
            self.size[0],
            self.size[1],
            self.size[0] / self.size[1],
            T::one(),
            T::from_f64(2.0),
        ]
        .map(|number| Wide::splat(simd, number));
        for at in (0..PACKET_RAYS).step_by(S::COUNT) {
            let [x, y] = [0, 1].map(|axis| Wide::load(simd, &self.fragments[axis][at..]));
            (x / width * two - one).store(&mut self.screen[0][at..]);
            ((y / height * two - one) / aspect).store(&mut self.screen[1][at..]);
        }
    }
}

/// Computes the unit directions from a pinhole to points (x, y, `screen_distance`) on the screen, to the
/// right, up and forward.
struct PinholeDirections<'a, T> {
    x: &'a [T],
    y: &'a [T],
    screen_distance: T,
    /// The directions to the right, up and forward; `None` for x, y and −z.
    axes: Option<[[T; 3]; 3]>,
    directions: [&'a mut [T]; 3],
}

impl<T: Real> Kernel<T> for PinholeDirections<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let distance = Wide::splat(simd, self.screen_distance);
        let axes = self.axes.map(|axes| axes.map(|axis| Wide3::splat(simd, axis)));
        let mut at = 0;
        while at < self.x.len() {
            let (x, y) = (Wide::load(simd, &self.x[at..]), Wide::load(simd, &self.y[at..]));
            let direction = match axes {
                None => Wide3(x, y, -distance),
                Some([right, up, forward]) => right * x + up * y + forward * distance,
            };
            let Wide3(x, y, z) = direction.normalize(simd);
            x.store(&mut self.directions[0][at..]);
            y.store(&mut self.directions[1][at..]);
            z.store(&mut self.directions[2][at..]);
            at += S::COUNT;
        }
    }
}

#[derive(Debug)]
pub(super) struct Figure<T: Real> {
    outline: Outline,
    pub(super) color: T::Vec3,
}

impl<T: Real> Figure<T> {
    pub(super) fn new(figure: &scene::Figure) -> Self {
        Self {
            outline: figure.outline,
            color: T::Vec3::from_f64(figure.color),
        }
    }

    /// Evaluates the implicit function at a point of the screen: it is negative inside.
    fn value(&self, x: T, y: T) -> T {
        match self.outline {
            Outline::Disk { center, radius } => {
                let [cx, cy, radius] = [center[0], center[1], radius].map(T::from_f64);
                (x - cx) * (x - cx) + (y - cy) * (y - cy) - radius * radius
            }
            Outline::Wave {
                height,
                amplitude,
                frequency,
            } => {
                let [height, amplitude, frequency] = [height, amplitude, frequency].map(T::from_f64);
                let (sine, _) = (frequency * x).sine_and_cosine();
                y - height - amplitude * sine
            }
            Outline::Heart { center, size } => {
                let [cx, cy, size] = [center[0], center[1], size].map(T::from_f64);
                let (u, v) = ((x - cx) / size, (y - cy) / size);
                let ring = u * u + v * v - T::one();
                ring * ring * ring - u * u * (v * v * v)
            }
        }
    }
}

/// Returns the index of the topmost figure at a point of the screen.
pub(super) fn topmost_figure<T: Real>(figures: &[Figure<T>], [x, y]: [T; 2]) -> Option<usize> {
    figures.iter().rposition(|figure| figure.value(x, y) < T::zero())
}
