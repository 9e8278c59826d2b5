//! The same scene with its numbers moved a little: what changes then, no shader can be held to.

use toyproof_image::pcg;

use super::{Camera, Checker, Light, Model, Object, Outline, Point, Projection, QuadricKind, Scene, Shape};

/// Lengths of a scene are moved by a share of themselves, or of this if that is larger, or of the scene's size if that is smaller
/// than this: what is 0 as written is a computed number in a shader.
const UNIT: f64 = 1.0;

/// Numbers in [−1, 1], as many as are asked for.
struct Random {
    state: u32,
    /// By how much a number is moved, relative to its size or the unit.
    share: f64,
    unit: f64,
}

impl Random {
    fn moved(&mut self, value: f64) -> f64 {
        value + self.number() * self.share * value.abs().max(self.unit)
    }

    /// A length above 0.
    fn length(&mut self, value: f64) -> f64 {
        value * (1.0 + self.number() * self.share)
    }

    fn number(&mut self) -> f64 {
        self.state = pcg(self.state);
        f64::from(self.state) / f64::from(u32::MAX) * 2.0 - 1.0
    }

    fn point(&mut self, point: Point) -> Point {
        point.map(|along| self.moved(along))
    }
}

impl Scene {
    /// This scene, in which nothing moves, with all places and lengths moved by up to `share` of their size, each by its own random
    /// number. `-share` with the same seed moves each the other way.
    #[must_use]
    pub fn perturbed(&self, seed: u32, share: f64) -> Self {
        let mut scene = self.clone();
        let mut random = Random {
            state: pcg(seed),
            share,
            unit: self.size().min(UNIT),
        };
        scene.camera = Camera {
            eye: random.point(self.camera.eye),
            projection: match self.camera.projection {
                Projection::Pinhole { screen_distance } => Projection::Pinhole {
                    screen_distance: random.length(screen_distance),
                },
                Projection::Parallel { width } => Projection::Parallel {
                    width: random.length(width),
                },
            },
        };
        for Light { position, radius, .. } in &mut scene.lights {
            *position = random.point(*position);
            *radius = random.length(*radius);
        }
        for figure in &mut scene.figures {
            figure.outline = random.outline(figure.outline);
        }
        for Object { shape, material, .. } in &mut scene.objects {
            *shape = random.shape(*shape);
            if let Some(Checker { size, .. }) = &mut material.checker {
                *size = random.length(*size);
            }
        }
        scene.scatters.clear();
        // What shines where a light is stays there.
        for (before, after) in self.lights.iter().zip(&scene.lights) {
            let surface = |light: &Light| Shape::Sphere {
                center: light.position,
                radius: light.radius,
            };
            for (own, moved) in self.objects.iter().zip(&mut scene.objects) {
                if own.material.model == Model::Emitter && own.shape == surface(before) {
                    moved.shape = surface(after);
                }
            }
        }
        scene
    }

    /// The largest distance of a surface from the eye along an axis.
    fn size(&self) -> f64 {
        let eye = self.camera.eye;
        let places = self.objects.iter().map(|object| match object.shape {
            Shape::Sphere { center, .. } => center,
            Shape::Quadric(quadric) => quadric.origin,
            Shape::Plane { point, .. } => point,
        });
        let distances = places.flat_map(|place| (0..3).map(move |axis| (place[axis] - eye[axis]).abs()));
        distances.fold(0.0, f64::max)
    }
}

impl Random {
    fn shape(&mut self, shape: Shape) -> Shape {
        match shape {
            Shape::Sphere { center, radius } => Shape::Sphere {
                center: self.point(center),
                radius: self.length(radius),
            },
            Shape::Plane { point, normal } => Shape::Plane {
                point: self.point(point),
                normal,
            },
            Shape::Quadric(mut quadric) => {
                quadric.origin = self.point(quadric.origin);
                quadric.kind = self.kind(quadric.kind);
                Shape::Quadric(quadric)
            }
        }
    }

    fn outline(&mut self, outline: Outline) -> Outline {
        match outline {
            Outline::Disk { center, radius } => Outline::Disk {
                center: center.map(|along| self.moved(along)),
                radius: self.length(radius),
            },
            Outline::Wave {
                height,
                amplitude,
                frequency,
            } => Outline::Wave {
                height: self.moved(height),
                amplitude: self.length(amplitude),
                frequency: self.length(frequency),
            },
            Outline::Heart { center, size } => Outline::Heart {
                center: center.map(|along| self.moved(along)),
                size: self.length(size),
            },
        }
    }

    fn kind(&mut self, kind: QuadricKind) -> QuadricKind {
        match kind {
            QuadricKind::Ellipsoid { radii } => QuadricKind::Ellipsoid {
                radii: radii.map(|radius| self.length(radius)),
            },
            QuadricKind::Cylinder { radius, height } => QuadricKind::Cylinder {
                radius: self.length(radius),
                height: self.length(height),
            },
            QuadricKind::Cone { radius, height } => QuadricKind::Cone {
                radius: self.length(radius),
                height: self.length(height),
            },
            QuadricKind::Paraboloid { radius, height } => QuadricKind::Paraboloid {
                radius: self.length(radius),
                height: self.length(height),
            },
            QuadricKind::Hyperboloid {
                waist,
                radius,
                height,
            } => QuadricKind::Hyperboloid {
                waist: self.length(waist),
                radius: self.length(radius),
                height: self.length(height),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::super::parse;

    #[test]
    fn all_lengths_move_by_their_share_and_what_shines_stays_with_its_light() {
        let mut files = Files::default();
        let text = "[film]\nsampler = \"independent\"\n[[light]]\nposition = [1.0, 2.0, -3.0]\nradius = 0.5\ncolor = [1, 1, 1]\n\
                    [[plane]]\npoint = [0.0, -1.0, 0.0]\nmaterial = { model = \"lambert\", color = [1, 1, 1], checker = { color = [0, 0, 0], size = 1.0 } }\n\
                    [[sphere]]\ncenter = [1.0, 2.0, -3.0]\nradius = 0.5\nmaterial = { model = \"emitter\", color = [1, 1, 1] }\n";
        let file = files.add(File::new("s", text));
        let scene = parse(&files, file).unwrap();
        let [there, back] = [1e-9, -1e-9].map(|share| scene.perturbed(7, share));
        assert_ne!(there, scene);
        for axis in 0..3 {
            let moved = [&there, &back].map(|other| other.camera.eye[axis] - scene.camera.eye[axis]);
            assert!(
                moved[0] != 0.0 && moved[0] == -moved[1],
                "what is 0 moves as well: {moved:?}"
            );
            assert!(moved[0].abs() <= 1e-9);
        }
        for other in [&there, &back] {
            let sphere = super::Shape::Sphere {
                center: other.lights[0].position,
                radius: other.lights[0].radius,
            };
            assert!(other.objects.iter().any(|object| object.shape == sphere));
        }
    }
}
