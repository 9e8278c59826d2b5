//! The scenes that are timed.

use toyproof::scene::{
    Background, Camera, Film, Integrator, Light, Material, Model, Object, Projection, Sampler, Scene, Shape,
    ToneMap,
};

/// Numbers in [0, 1), the same in every run.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Knuth's MMIX generator, its upper bits.
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / f64::from(1 << 24)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.number()
    }
}

pub(crate) fn material(model: Model) -> Material {
    Material {
        model,
        color: [0.8, 0.6, 0.4],
        pattern: None,
    }
}

/// Spheres at distances of 5 to 25 within the image, whose size is chosen so that they cover about a quarter of it. All
/// numbers are float32's.
pub(crate) fn spheres(count: usize, model: Model) -> Scene {
    let mut random = Random(7);
    let size = (6.0 / count as f64).sqrt().min(2.0);
    let single = |number: f64| f64::from(number as f32);
    let objects = (0..count).map(|_| {
        let away = random.between(5.0, 25.0);
        let [x, y] = [0.5, 0.28].map(|side| away * random.between(-side, side));
        Object {
            shape: Shape::Sphere {
                center: [single(x), single(y), single(-away)],
                radius: single(size * random.between(0.25, 0.75)),
            },
            material: material(model),
            motion: None,
        }
    });
    Scene {
        title: String::new(),
        ambient: [0.1; 3],
        max_offset: 0.001,
        film: Film {
            size: [640, 360],
            samples: 1,
            sampler: Sampler::Center,
            max_depth: 1,
            integrator: Integrator::Whitted,
            tone_map: ToneMap::None,
            gamma: 1.0,
        },
        camera: Camera {
            eye: [0.0; 3],
            look_at: None,
            up: Camera::UP,
            roll: 0.0,
            projection: Projection::Pinhole { screen_distance: 2.0 },
        },
        background: Background::Uniform([0.1, 0.2, 0.3]),
        figures: Vec::new(),
        lights: Vec::new(),
        objects: objects.collect(),
        scatters: Vec::new(),
        motions: Vec::new(),
    }
}

pub(crate) fn light() -> Light {
    Light {
        position: [5.0, 10.0, 5.0],
        color: [0.8; 3],
        shadow: false,
        radius: 0.0,
        motion: None,
    }
}
