//! What the camera sees besides colors, for compositors and denoisers: depth, normals, albedo, objects, and
//! the variance of the samples.

use rayon::prelude::*;
use toyproof_image::{ChannelValues, ExrChannel, Image};

use crate::ray::PrimaryHit;
use crate::ray_epsilon::Exact;
use crate::real::{Real, Vector};
use crate::render::Backend;
use crate::sampler::Sample;
use crate::tracer::Tracer;
use crate::transfer::tone_map;

/// The depth of pixels in which no sample hits a surface, in scene units: far behind everything, and finite,
/// since compositors compute with it. Blender writes the same.
pub const BACKGROUND_DEPTH: f32 = 1e10;

/// An image, and what is visible in its pixels, bottom row first. All layers are of the same samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers {
    /// The image, with the bits of [`Tracer::render`].
    pub color: Image,
    /// The mean distance from the camera's eye along its viewing direction (not along the ray), in scene
    /// units, of the samples that hit a surface; [`BACKGROUND_DEPTH`] if none does.
    pub depth: Vec<f32>,
    /// The mean unit normal in scene coordinates, of closed surfaces outward; zero for samples without a
    /// surface.
    pub normal: Vec<[f32; 3]>,
    /// The mean color of the surfaces themselves, in [0, 1], or of the figures; black for samples with
    /// neither.
    pub albedo: Vec<[f32; 3]>,
    /// The object that most samples see, as its number in the scene from 1, followed by those of the figures;
    /// 0 for the background, and the smallest number of equals.
    pub object: Vec<u32>,
    /// The unbiased variance of the samples' colors in linear light, before tone mapping; `None` for one
    /// sample per pixel.
    pub variance: Option<Vec<[f32; 3]>>,
}

impl Layers {
    /// What the channels hold, as a text for the file.
    pub const DESCRIPTION: &str = "\
Z: distance from the camera along its viewing direction, in scene units, mean of the samples that hit; 1e10 without a hit
Normal: mean unit normal in scene coordinates
Albedo: mean color of the surfaces in [0, 1]
variance: unbiased variance of the samples in linear light; divide by their number for that of the pixel
id: number of the object in the scene from 1, then of the figures; 0 is the background";

    /// The layers as channels of an EXR file, beside its colors: `Z`, `Normal.X` to `Normal.Z`, `Albedo.R` to
    /// `Albedo.B`, `id`, and `variance.R` to `variance.B` if there is more than one sample.
    #[must_use]
    pub fn channels(&self) -> Vec<ExrChannel> {
        let float = |name, values| ExrChannel {
            name,
            values: ChannelValues::Float(values),
        };
        let vectors = |names: [&'static str; 3], values: &[[f32; 3]]| {
            let component = |at: usize| values.iter().map(|value| value[at]).collect();
            (0..3)
                .map(|at| float(names[at], component(at)))
                .collect::<Vec<_>>()
        };
        let mut channels = vec![
            float("Z", self.depth.clone()),
            ExrChannel {
                name: "id",
                values: ChannelValues::Number(self.object.clone()),
            },
        ];
        channels.extend(vectors(["Normal.X", "Normal.Y", "Normal.Z"], &self.normal));
        channels.extend(vectors(["Albedo.R", "Albedo.G", "Albedo.B"], &self.albedo));
        if let Some(variance) = &self.variance {
            channels.extend(vectors(["variance.R", "variance.G", "variance.B"], variance));
        }
        channels
    }
}

/// The layers of a pixel.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct PixelLayers {
    color: [f32; 4],
    depth: f32,
    normal: [f32; 3],
    albedo: [f32; 3],
    object: u32,
    variance: [f32; 3],
}

impl<T: Backend> Tracer<T> {
    /// Renders the whole image with its layers, sample by sample, which takes a few times as long as
    /// [`Tracer::render`]. `row_done` is called once per row, from any thread.
    pub fn render_layers(&self, row_done: impl Fn() + Sync) -> Layers {
        let [width, height] = self.film.size;
        let rows: Vec<Vec<PixelLayers>> = (0..height)
            .into_par_iter()
            .map(|y| {
                let row = (0..width).map(|x| T::layers(self, [x, y])).collect();
                row_done();
                row
            })
            .collect();
        let pixels = || rows.iter().flatten();
        Layers {
            color: Image::new(width, height, pixels().map(|pixel| pixel.color).collect()),
            depth: pixels().map(|pixel| pixel.depth).collect(),
            normal: pixels().map(|pixel| pixel.normal).collect(),
            albedo: pixels().map(|pixel| pixel.albedo).collect(),
            object: pixels().map(|pixel| pixel.object).collect(),
            variance: (self.film.samples > 1).then(|| pixels().map(|pixel| pixel.variance).collect()),
        }
    }
}

/// What a sample sees.
struct Seen {
    /// The number of the object or figure; 0 for the background.
    object: u32,
    /// The depth and the normal, of a surface.
    surface: Option<(f64, [f64; 3])>,
    albedo: [f64; 3],
}

impl<T: Real> Tracer<T> {
    /// Computes the layers of a pixel.
    pub(super) fn pixel_layers(&self, pixel: [u32; 2]) -> PixelLayers {
        let count = self.film.samples;
        let (mut normal, mut albedo) = ([0.0; 3], [0.0; 3]);
        let (mut depth, mut hits) = (0.0, 0);
        let mut objects: Vec<(u32, u32)> = Vec::new();
        let mut spread = Spread::default();
        let mean = Self::mean(pixel, count, 0, |sample: Sample| {
            let (primary, stream) = self.primary(self.film.sampler, sample);
            let seen = self.seen(&primary);
            if let Some((distance, direction)) = seen.surface {
                (depth, hits) = (depth + distance, hits + 1);
                add(&mut normal, direction);
            }
            add(&mut albedo, seen.albedo);
            match objects.iter_mut().find(|(object, _)| *object == seen.object) {
                Some((_, number)) => *number += 1,
                None => objects.push((seen.object, 1)),
            }
            let radiance = self.radiance(primary, stream, &Exact);
            spread.add(radiance.to_array().map(Real::to_f64));
            radiance
        });
        let [r, g, b] = mean
            .to_array()
            .map(|component| tone_map(&self.film, component).to_f64() as f32);
        let share = |sum: [f64; 3]| sum.map(|component| (component / f64::from(count)) as f32);
        let most = objects
            .into_iter()
            .max_by(|a, b| a.1.cmp(&b.1).then(b.0.cmp(&a.0)));
        PixelLayers {
            color: [r, g, b, 1.0],
            depth: if hits > 0 {
                (depth / f64::from(hits)) as f32
            } else {
                BACKGROUND_DEPTH
            },
            normal: share(normal),
            albedo: share(albedo),
            object: most.map_or(0, |(object, _)| object),
            variance: spread.variance().map(|component| component as f32),
        }
    }

    fn seen(&self, primary: &PrimaryHit<T>) -> Seen {
        let numbers = |vector: T::Vec3| vector.to_array().map(Real::to_f64);
        match primary {
            PrimaryHit::Figure(figure) => Seen {
                object: (self.world.surfaces() + figure + 1) as u32,
                surface: None,
                albedo: clamped(numbers(self.figures[*figure].color)),
            },
            PrimaryHit::Scene(ray, first) => match first.get() {
                None => Seen {
                    object: 0,
                    surface: None,
                    albedo: [0.0; 3],
                },
                Some((t, surface)) => {
                    let [normal, color] = self.world.surface_point(ray, *first);
                    Seen {
                        object: surface as u32 + 1,
                        surface: Some((self.camera.depth(ray, t).to_f64(), numbers(normal))),
                        albedo: clamped(numbers(color)),
                    }
                }
            },
        }
    }
}

fn add(sum: &mut [f64; 3], term: [f64; 3]) {
    for (sum, term) in sum.iter_mut().zip(term) {
        *sum += term;
    }
}

fn clamped(color: [f64; 3]) -> [f64; 3] {
    color.map(|component| component.clamp(0.0, 1.0))
}

/// The mean and the squared deviations of samples, updated by Welford's method (Technometrics 4(3), 1962).
#[derive(Debug, Default)]
struct Spread {
    count: f64,
    mean: [f64; 3],
    squares: [f64; 3],
}

impl Spread {
    fn add(&mut self, sample: [f64; 3]) {
        self.count += 1.0;
        for at in 0..3 {
            let deviation = sample[at] - self.mean[at];
            self.mean[at] += deviation / self.count;
            self.squares[at] += deviation * (sample[at] - self.mean[at]);
        }
    }

    /// The unbiased variance; 0 for one sample.
    fn variance(&self) -> [f64; 3] {
        self.squares.map(|sum| sum / (self.count - 1.0).max(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::scene;

    /// A film, a camera and one sphere with a radius of 1.5 around (0, 0, −6).
    fn sphere(film: &str, camera: &str) -> String {
        format!(
            "[film]\nsize = [24, 16]\n{film}[camera]\n{camera}[background]\ncolor = [0.25, 0.5, 1.0]\n[[sphere]]\n\
             center = [0, 0, -6]\nradius = 1.5\nmaterial = {{ model = \"facing\", color = [1, 0.5, 0] }}\n"
        )
    }

    fn layers(text: &str) -> (Tracer<f64>, Layers) {
        let tracer = Tracer::<f64>::new(&scene(text));
        let layers = tracer.render_layers(|| ());
        (tracer, layers)
    }

    /// Values in f64 that were rounded to f32.
    fn assert_rounded(value: f32, expected: f64) {
        let difference = (f64::from(value) - expected).abs();
        assert!(
            difference <= 1e-7 * expected.abs().max(1e-3),
            "{value} is not {expected}"
        );
    }

    /// One ray per pixel: o + t·d with |o + t·d − c| = r is solved in closed form.
    #[test]
    fn layers_of_a_sphere_follow_from_its_equation() {
        let (tracer, layers) = layers(&sphere("", ""));
        assert_eq!(layers.color, tracer.render(|| ()));
        assert_eq!(layers.variance, None);
        let mut hits = 0;
        for at in 0..24 * 16 {
            // The screen is at z = −2, from −1 to 1 horizontally.
            let (fx, fy) = (f64::from(at % 24) + 0.5, f64::from(at / 24) + 0.5);
            let screen = [2.0 * fx / 24.0 - 1.0, (2.0 * fy / 16.0 - 1.0) / 1.5, -2.0];
            let length = screen.iter().map(|part| part * part).sum::<f64>().sqrt();
            let direction = screen.map(|part| part / length);
            let along = -6.0 * direction[2];
            let discriminant = along * along - (36.0 - 2.25);
            let at = at as usize;
            if discriminant <= 0.0 {
                assert_eq!((layers.depth[at], layers.object[at]), (BACKGROUND_DEPTH, 0));
                assert_eq!((layers.normal[at], layers.albedo[at]), ([0.0; 3], [0.0; 3]));
                continue;
            }
            hits += 1;
            let t = along - discriminant.sqrt();
            let normal = [t * direction[0], t * direction[1], t * direction[2] + 6.0].map(|part| part / 1.5);
            assert_rounded(layers.depth[at], -t * direction[2]);
            for (value, expected) in layers.normal[at].into_iter().zip(normal) {
                assert_rounded(value, expected);
            }
            assert_eq!((layers.albedo[at], layers.object[at]), ([1.0, 0.5, 0.0], 1));
        }
        assert!((20..200).contains(&hits), "{hits}");
    }

    #[test]
    fn depth_is_along_the_viewing_direction_of_any_camera() {
        // From (8, 0, −6), the sphere is 6.5 away in the direction −x; parallel rays meet it there in all pixels
        // around the middle.
        for camera in [
            "eye = [8, 0, -6]\nlook_at = [0, 0, -6]\n",
            "eye = [8, 0, -6]\nlook_at = [0, 0, -6]\nprojection = \"parallel\"\nwidth = 0.001\n",
        ] {
            let text = sphere("", camera).replace("[24, 16]", "[1, 1]");
            let (_, layers) = layers(&text);
            assert_rounded(layers.depth[0], 6.5);
            assert_rounded(layers.normal[0][0], 1.0);
        }
    }

    #[test]
    fn layers_are_means_of_the_samples_of_the_image() {
        let (tracer, layers) = layers(&sphere("sampler = \"independent\"\nsamples = 16\n", ""));
        assert_eq!(layers.color, tracer.render(|| ()), "to the bit");
        let variance = layers.variance.unwrap();
        let mut mixed = 0;
        for at in 0..24 * 16 {
            let pixel = [at % 24, at / 24];
            let sample = |index| Sample {
                pixel,
                index,
                count: 16,
                set: 0,
            };
            let colors: Vec<_> = (0..16)
                .map(|index| tracer.sample(sample(index), &Exact).to_array())
                .collect();
            let ids: Vec<_> = (0..16)
                .map(|index| tracer.primary(tracer.film.sampler, sample(index)).0.id()[1])
                .collect();
            let hits = ids.iter().flatten().count();
            let at = at as usize;
            mixed += usize::from(hits > 0 && hits < 16);
            assert_eq!(
                layers.object[at],
                u32::from(hits > 8),
                "of equals, the background"
            );
            assert_rounded(layers.albedo[at][0], hits as f64 / 16.0);
            assert_eq!(layers.depth[at] == BACKGROUND_DEPTH, hits == 0);
            for component in 0..3 {
                let mean = colors.iter().map(|color| color[component]).sum::<f64>() / 16.0;
                let squares = colors.iter().map(|color| (color[component] - mean).powi(2));
                assert_rounded(variance[at][component], squares.sum::<f64>() / 15.0);
            }
        }
        assert!(mixed > 10, "{mixed}");
    }

    #[test]
    fn figures_have_colors_and_numbers_after_the_objects() {
        let figure = "[[figure]]\noutline = \"disk\"\ncenter = [0, 0]\nradius = 0.01\ncolor = [0, 2, 0.5]\n";
        let text = sphere("", "").replace("[24, 16]", "[1, 1]") + figure;
        let (_, layers) = layers(&text);
        assert_eq!((layers.object[0], layers.albedo[0]), (2, [0.0, 1.0, 0.5]));
        assert_eq!((layers.depth[0], layers.normal[0]), (BACKGROUND_DEPTH, [0.0; 3]));
        let names: Vec<_> = layers.channels().iter().map(|channel| channel.name).collect();
        assert_eq!(
            names,
            [
                "Z", "id", "Normal.X", "Normal.Y", "Normal.Z", "Albedo.R", "Albedo.G", "Albedo.B"
            ]
        );
    }
}
