//! Compares soft shadows and paths with independent estimates of the same integrals: lights are sampled over
//! their surface, not over the subtended cone; there is no weighting; diffuse directions come from a disk.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use toyproof::diagnostic::{File, Files};
use toyproof::image::Image;
use toyproof::scene::{Background, Integrator, Model, Projection, Sampler, Scene, Shape, ToneMap, parse};
use toyproof::tracer::Tracer;

const SIZE: [u32; 2] = [16, 9];
/// Samples of our estimate per pixel.
const ESTIMATES: u32 = 32_000;

/// An independent generator: xorshift64* (S. Vigna, “An experimental exploration of Marsaglia's xorshift
/// generators, scrambled”, 2016).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform over the unit sphere (Archimedes).
    fn on_sphere(&mut self) -> DVec3 {
        let z = 2.0 * self.number() - 1.0;
        let (sine, cosine) = (TAU * self.number()).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * cosine, across * sine, z)
    }

    /// Cosine-weighted around a normal: a point of the unit sphere around its tip.
    fn by_cosine(&mut self, normal: DVec3) -> DVec3 {
        (normal + self.on_sphere()).normalize()
    }

    /// Weighted by a power of the cosine around an axis: the perpendicular component is that of a uniform
    /// direction on the sphere.
    fn around(&mut self, axis: DVec3, exponent: f64) -> DVec3 {
        let cosine = (1.0 - self.number()).powf(1.0 / (exponent + 1.0));
        let across = self.on_sphere().cross(axis).normalize();
        axis * cosine + across * (1.0 - cosine * cosine).sqrt()
    }
}

/// The intersection of a ray with a surface.
struct Hit {
    point: DVec3,
    normal: DVec3,
    surface: usize,
}

/// A scene of spheres and planes.
struct World<'a> {
    scene: &'a Scene,
}

impl World<'_> {
    fn distance(&self, surface: usize, origin: DVec3, direction: DVec3) -> f64 {
        let candidates = match self.scene.objects[surface].shape {
            Shape::Sphere { center, radius } => {
                let f = origin - DVec3::from_array(center);
                let b = f.dot(direction);
                let disc = b * b - f.dot(f) + radius * radius;
                [-b - disc.sqrt(), -b + disc.sqrt()]
            }
            Shape::Plane { point, normal } => {
                let normal = DVec3::from_array(normal);
                [normal.dot(DVec3::from_array(point) - origin) / normal.dot(direction); 2]
            }
            Shape::Quadric(_) | Shape::Box(_) => unreachable!("not in these scenes"),
        };
        let ahead = candidates.into_iter().filter(|&t| t > 1e-7);
        ahead.fold(f64::INFINITY, f64::min)
    }

    fn intersect(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let distances = (0..self.scene.objects.len()).map(|i| (self.distance(i, origin, direction), i));
        let (t, surface) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
        if t.is_infinite() {
            return None;
        }
        let point = origin + t * direction;
        let normal = match self.scene.objects[surface].shape {
            Shape::Sphere { center, .. } => (point - DVec3::from_array(center)).normalize(),
            Shape::Plane { normal, .. } => DVec3::from_array(normal),
            Shape::Quadric(_) | Shape::Box(_) => unreachable!("not in these scenes"),
        };
        Some(Hit {
            point,
            normal,
            surface,
        })
    }

    /// Samples a point on an emissive sphere, seen from `hit`: returns the direction, and cosine · cosine /
    /// distance² · area, which is 0 if anything but `itself` lies between.
    fn to_light(
        &self,
        hit: &Hit,
        (center, radius, itself): (DVec3, f64, Option<usize>),
        random: &mut Random,
    ) -> (DVec3, f64) {
        let outward = random.on_sphere();
        let to = center + radius * outward - hit.point;
        let distance = to.length();
        let direction = to / distance;
        let (here, there) = (direction.dot(hit.normal), -direction.dot(outward));
        if here <= 0.0 || there <= 0.0 {
            return (direction, 0.0);
        }
        let hidden = (0..self.scene.objects.len())
            .any(|i| Some(i) != itself && self.distance(i, hit.point, direction) < distance * (1.0 - 1e-9));
        let area = 4.0 * PI * radius * radius;
        let share = if hidden {
            0.0
        } else {
            here * there / (distance * distance) * area
        };
        (direction, share)
    }

    fn background(&self) -> DVec3 {
        match self.scene.background {
            Background::Uniform(color) => DVec3::from_array(color),
            Background::Gradient { .. } => unreachable!("not in these scenes"),
        }
    }

    /// One estimate of the radiance along a camera ray, in scenes whose lights illuminate matte surfaces.
    fn lit(&self, direction: DVec3, random: &mut Random) -> DVec3 {
        let Some(hit) = self.intersect(DVec3::ZERO, direction) else {
            return self.background();
        };
        let material = &self.scene.objects[hit.surface].material;
        assert!(material.model == Model::Lambert);
        let mut sum = DVec3::from_array(self.scene.ambient);
        for light in &self.scene.lights {
            let center = DVec3::from_array(light.position);
            let (_, share) = self.to_light(&hit, (center, light.radius, None), random);
            let sine = light.radius / center.distance(hit.point);
            let solid_angle = TAU * (1.0 - (1.0 - sine * sine).sqrt());
            sum += DVec3::from_array(light.color) * share / solid_angle;
        }
        DVec3::from_array(material.color) * sum
    }

    /// One estimate of the radiance along a ray over paths of at most `segments` segments. Emitters are
    /// counted where the path samples them, and where the camera sees them directly, but not where the path
    /// hits them.
    fn path(&self, origin: DVec3, direction: DVec3, segments: u32, random: &mut Random) -> DVec3 {
        let (mut origin, mut direction) = (origin, direction);
        let (mut sum, mut throughput) = (DVec3::ZERO, DVec3::ONE);
        for segment in 1..=segments {
            let Some(hit) = self.intersect(origin, direction) else {
                return sum + throughput * self.background();
            };
            let material = &self.scene.objects[hit.surface].material;
            let color = DVec3::from_array(material.color);
            if material.model == Model::Emitter {
                return if segment == 1 { color } else { sum };
            }
            if segment == segments {
                return sum;
            }
            let mirrored = direction - 2.0 * direction.dot(hit.normal) * hit.normal;
            let brdf = |to: DVec3| match material.model {
                Model::Diffuse => 1.0 / PI,
                Model::Glossy { exponent } => {
                    (exponent + 2.0) / TAU * mirrored.dot(to).max(0.0).powf(exponent)
                }
                model => unreachable!("{model:?} is not in these scenes"),
            };
            for (i, emitter) in self.scene.objects.iter().enumerate() {
                let (Shape::Sphere { center, radius }, Model::Emitter) =
                    (emitter.shape, emitter.material.model)
                else {
                    continue;
                };
                let place = (DVec3::from_array(center), radius, Some(i));
                let (to, share) = self.to_light(&hit, place, random);
                sum += throughput * color * DVec3::from_array(emitter.material.color) * brdf(to) * share;
            }
            let next = if let Model::Glossy { exponent } = material.model {
                let next = random.around(mirrored, exponent);
                throughput *= color * (exponent + 2.0) / (exponent + 1.0) * next.dot(hit.normal).max(0.0);
                next
            } else {
                throughput *= color;
                random.by_cosine(hit.normal)
            };
            (origin, direction) = (hit.point, next);
        }
        sum
    }
}

fn course(text: &str) -> Scene {
    let mut files = Files::default();
    let file = files.add(File::new("scene", text));
    let mut scene = parse(&files, file).unwrap();
    scene.film.size = SIZE;
    scene.film.samples = 16_384;
    scene.film.sampler = Sampler::Sobol;
    scene.film.tone_map = ToneMap::None;
    scene.film.gamma = 1.0;
    scene
}

/// Compares the tracer's image with the mean of the estimates in each pixel: returns the root mean square of
/// the differences in standard errors, and the largest.
fn deviation(actual_image: &Image, scene: &Scene) -> [f64; 2] {
    let world = World { scene };
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let [width, height] = scene.film.size.map(f64::from);
    let Projection::Pinhole { screen_distance } = scene.camera.projection else {
        unreachable!("not in these scenes")
    };
    assert!(scene.camera.eye == [0.0; 3]);
    let (mut squares, mut largest, mut number) = (0.0, 0.0f64, 0.0);
    for y in 0..scene.film.size[1] {
        for x in 0..scene.film.size[0] {
            let (mut sum, mut sum2) = (0.0, 0.0);
            for _ in 0..ESTIMATES {
                let fx = (f64::from(x) + random.number()) / width * 2.0 - 1.0;
                let fy = (f64::from(y) + random.number()) / height * 2.0 - 1.0;
                let direction = DVec3::new(fx, fy * height / width, -screen_distance).normalize();
                let light = match scene.film.integrator {
                    Integrator::Whitted => world.lit(direction, &mut random),
                    Integrator::Path => world.path(DVec3::ZERO, direction, scene.film.max_depth, &mut random),
                };
                let value = light.element_sum();
                sum += value;
                sum2 += value * value;
            }
            let mean = sum / f64::from(ESTIMATES);
            let variance = (sum2 / f64::from(ESTIMATES) - mean * mean).max(0.0);
            // The last term is about the error of the tracer's own image.
            let error = (variance / f64::from(ESTIMATES)).sqrt() + 3e-4 * mean;
            let [r, g, b, _] = actual_image.get(x, y).map(f64::from);
            let z = (r + g + b - mean) / error;
            squares += z * z;
            largest = largest.max(z.abs());
            number += 1.0;
        }
    }
    [(squares / number).sqrt(), largest]
}

/// Compares the tracer's image of `scene` with estimates of `other`.
fn compare(scene: &Scene, other: &Scene) -> [f64; 2] {
    let actual_image = Tracer::<f64>::new(scene).render(|| ());
    deviation(&actual_image, other)
}

const SOFT_SHADOWS: &str = include_str!("../../glsl/09-soft-shadows.toml");
const IMPORTANCE_SAMPLING: &str = include_str!("../../glsl/13-importance-sampling.toml");

/// A scene with a large light, whose penumbras are wide.
fn large_light() -> Scene {
    let mut scene = course(SOFT_SHADOWS);
    scene.lights[0].radius = 2.0;
    scene
}

#[test]
fn estimates_over_the_lights_surface_agree() {
    for scene in [large_light(), course(SOFT_SHADOWS), course(IMPORTANCE_SAMPLING)] {
        let [rms, largest] = compare(&scene, &scene);
        eprintln!("{}: {rms:.2} standard errors, at most {largest:.1}", scene.title);
        assert!(rms < 1.2 && largest < 6.0, "{}: {rms} {largest}", scene.title);
    }
}

#[test]
fn different_lights_and_depths_are_distinguished() {
    let scene = large_light();
    let mut other = scene.clone();
    other.lights[0].radius *= 1.25;
    let [rms, largest] = compare(&scene, &other);
    eprintln!("a light larger by a quarter: {rms:.2}, at most {largest:.1}");
    assert!(rms > 1.5, "{rms}");

    let scene = course(IMPORTANCE_SAMPLING);
    let mut other = scene.clone();
    other.film.max_depth -= 1;
    let [rms, _] = compare(&scene, &other);
    eprintln!("a segment less: {rms:.2}");
    assert!(rms > 3.0, "{rms}");
}
