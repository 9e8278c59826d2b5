//! Perturbed scenes: differences that tiny changes of a scene's numbers cause are not errors of a shader.

use toyproof_image::pcg;

use super::{
    Camera, Cuboid, Light, Model, Object, Outline, Pattern, Point, Projection, QuadricKind, Scene, Shape,
};

/// The lower bound, in scene units, of the scale of coordinate perturbations, unless the scene is smaller.
/// Coordinates are perturbed relative to their size or this scale, whichever is larger: a coordinate that is
/// 0 in the file is a computed number in a shader.
const MIN_LENGTH_SCALE: f64 = 1.0;

/// A generator of random numbers in [−1, 1].
struct Random {
    state: u32,
    /// The relative size of perturbations.
    magnitude: f64,
    unit: f64,
}

impl Random {
    fn perturb(&mut self, value: f64) -> f64 {
        value + self.number() * self.magnitude * value.abs().max(self.unit)
    }

    /// Perturbs a positive length.
    fn length(&mut self, value: f64) -> f64 {
        value * (1.0 + self.number() * self.magnitude)
    }

    fn number(&mut self) -> f64 {
        self.state = pcg(self.state);
        f64::from(self.state) / f64::from(u32::MAX) * 2.0 - 1.0
    }

    fn point(&mut self, point: Point) -> Point {
        point.map(|along| self.perturb(along))
    }
}

impl Scene {
    /// Returns this scene, which must have no motions, with all positions and lengths perturbed by up to
    /// `magnitude` of their size, each by its own random number. `-magnitude` with the same seed moves each
    /// in the opposite direction.
    #[must_use]
    pub fn perturbed(&self, seed: u32, magnitude: f64) -> Self {
        let mut scene = self.clone();
        let mut random = Random {
            state: pcg(seed),
            magnitude,
            unit: self.size().min(MIN_LENGTH_SCALE),
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
            look_at: self.camera.look_at.map(|point| random.point(point)),
            ..self.camera
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
            if let Some(Pattern { size, .. }) = &mut material.pattern {
                *size = random.length(*size);
            }
        }
        scene.scatters.clear();
        // Emitters that coincide with a light stay there.
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

    /// Returns the largest distance of a surface from the eye along a coordinate axis, in scene units.
    pub fn size(&self) -> f64 {
        let eye = self.camera.eye;
        let places = self.objects.iter().map(|object| object.shape.origin());
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
            Shape::Box(Cuboid { center, size, axes }) => Shape::Box(Cuboid {
                center: self.point(center),
                size: size.map(|side| self.length(side)),
                axes,
            }),
        }
    }

    fn outline(&mut self, outline: Outline) -> Outline {
        match outline {
            Outline::Disk { center, radius } => Outline::Disk {
                center: center.map(|along| self.perturb(along)),
                radius: self.length(radius),
            },
            Outline::Wave {
                height,
                amplitude,
                frequency,
            } => Outline::Wave {
                height: self.perturb(height),
                amplitude: self.length(amplitude),
                frequency: self.length(frequency),
            },
            Outline::Heart { center, size } => Outline::Heart {
                center: center.map(|along| self.perturb(along)),
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
    fn lengths_move_by_their_magnitude_and_emitters_stay_with_their_lights() {
        let mut files = Files::default();
        let text = "[film]\nsampler = \"independent\"\n[[light]]\nposition = [1.0, 2.0, -3.0]\nradius = 0.5\ncolor = [1, 1, 1]\n\
                    [[plane]]\npoint = [0.0, -1.0, 0.0]\nmaterial = { model = \"lambert\", color = [1, 1, 1], checker = { color = [0, 0, 0], size = 1.0 } }\n\
                    [[sphere]]\ncenter = [1.0, 2.0, -3.0]\nradius = 0.5\nmaterial = { model = \"emitter\", color = [1, 1, 1] }\n";
        let file = files.add(File::new("s", text));
        let scene = parse(&files, file).unwrap();
        let [there, back] = [1e-9, -1e-9].map(|magnitude| scene.perturbed(7, magnitude));
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
