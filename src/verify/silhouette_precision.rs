//! Spheres of a scene whose silhouette the textbook discriminant cannot resolve in float32.
//!
//! b² − c, with c = |f|² − r², is a difference of numbers near L², where L is the distance from the eye to
//! the center, so its error is that of L², however small the difference. In the band on both sides of the
//! silhouette where the difference is smaller than the error, rays hit or miss at random.

use glam::DVec3;
use toyproof_diagnostic::{Diagnostic, Span};
use toyproof_glsl::Code;
use toyproof_image::Rgb8Image;
use toyproof_scene::{Projection, Scene, Shape};

/// Half of an f32's unit in the last place, relative.
const U: f64 = 1.0 / 16_777_216.0;
/// The largest error of the discriminant, in u·L², as measured: with rays in all directions, and with
/// parallel rays, for all of which b is the same.
const DISCRIMINANT_ERROR: f64 = 4.4;
const DISCRIMINANT_ERROR_PARALLEL: f64 = 1.1;
/// The smallest width of a band that is reported, in pixels; narrower bands look like any other edge.
const MIN_BAND_WIDTH: f64 = 1.0;

/// The width in pixels from which a band covers most of any image.
const MAX_WIDTH: f64 = 1_000.0;
/// The number of points of a silhouette that are tested on the screen.
const SILHOUETTE_POINTS: u32 = 256;

/// A sphere whose silhouette may be wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SilhouetteBand {
    center: DVec3,
    radius: f64,
    /// The distance of its center from the eye.
    distance: f64,
    /// The estimated width of the band in which rays hit or miss at random, in pixels.
    width: f64,
}

/// Returns the spheres of a scene without motion whose silhouette may be wrong by the error estimate; the
/// widest band first.
pub(super) fn candidates(scene: &Scene) -> Vec<SilhouetteBand> {
    let view = View::new(scene);
    let spheres = scene.objects.iter().filter_map(|object| match object.shape {
        Shape::Sphere { center, radius } => Some((DVec3::from_array(center), radius)),
        _ => None,
    });
    let mut bands: Vec<_> = spheres
        .filter_map(|(center, radius)| view.band(center, radius))
        .filter(|band| band.width >= MIN_BAND_WIDTH)
        .collect();
    bands.sort_by(|a, b| b.width.total_cmp(&a.width));
    bands
}

/// Keeps the spheres whose silhouette is on the screen and differs there between f32 and f64.
pub(super) fn visible(
    mut bands: Vec<SilhouetteBand>,
    scene: &Scene,
    single: &Rgb8Image,
    double: &Rgb8Image,
) -> Vec<SilhouetteBand> {
    let view = View::new(scene);
    bands.retain(|band| view.is_visible(band, single, double));
    bands
}

/// Returns the warning about them, at the discriminant.
pub(super) fn warning(bands: &[SilhouetteBand], at: Span) -> Option<Diagnostic> {
    let (worst, others) = bands.split_first()?;
    let diagnostic = worst.warning(at);
    Some(match others.len() {
        0 => diagnostic,
        1 => diagnostic.note("this affects another sphere as well, in a narrower band"),
        count => diagnostic.note(format!(
            "this affects {count} other spheres as well, in narrower bands"
        )),
    })
}

impl SilhouetteBand {
    fn warning(&self, at: Span) -> Diagnostic {
        let [x, y, z] = self.center.to_array();
        let (radius, distance) = (self.radius, self.distance);
        let width = if self.width < MAX_WIDTH {
            format!("in a band up to {:.0} pixels wide", self.width)
        } else {
            "everywhere".to_owned()
        };
        let message = format!(
            "float32 is too imprecise here for the silhouette of the sphere at ({x}, {y}, {z}) with radius {radius}: \
             rays hit or miss arbitrarily {width}"
        );
        let note = format!(
            "the error grows with the square of the distance to the sphere, {distance:.0}; for a unit direction d, use \
             `vec3 h = f - dot(f, d) * d; float disc = r*r - dot(h, h);`"
        );
        Diagnostic::warning(Code::NearTangent.as_str(), message)
            .at(at)
            .note(note)
    }
}

/// The rays of an image.
struct View {
    eye: DVec3,
    /// The directions to the right, up and forward.
    axes: [DVec3; 3],
    projection: Projection,
    size: [f64; 2],
}

impl View {
    fn new(scene: &Scene) -> Self {
        Self {
            eye: DVec3::from_array(scene.camera.eye),
            axes: match scene.camera.axes() {
                Some(axes) => axes.map(DVec3::from_array),
                None => [DVec3::X, DVec3::Y, DVec3::NEG_Z],
            },
            projection: scene.camera.projection,
            size: scene.film.size.map(f64::from),
        }
    }

    fn band(&self, center: DVec3, radius: f64) -> Option<SilhouetteBand> {
        let f = self.eye - center;
        let (distance, width) = match self.projection {
            Projection::Pinhole { screen_distance } => {
                let distance = f.length();
                // The distance to the points of tangency; NaN from inside.
                let reach = (distance * distance - radius * radius).sqrt();
                let error = DISCRIMINANT_ERROR * U * distance * distance;
                // The discriminant of a ray at a small angle a from the silhouette: 2·r·reach·a + r²·a².
                let angle = ((reach * reach + error).sqrt() - reach) / radius;
                (distance, 2.0 * angle * screen_distance * self.size[0] / 2.0)
            }
            Projection::Parallel { width } => {
                let [_, _, forward] = self.axes;
                let distance = f.dot(forward).hypot(radius);
                let error = DISCRIMINANT_ERROR_PARALLEL * U * distance * distance;
                (distance, error / radius * self.size[0] / width)
            }
        };
        (f.length() > radius).then_some(SilhouetteBand {
            center,
            radius,
            distance,
            width,
        })
    }

    /// Whether the two images differ visibly within the band.
    fn is_visible(&self, band: &SilhouetteBand, single: &Rgb8Image, double: &Rgb8Image) -> bool {
        let [width, height] = single.size();
        let reach = band.width.ceil().min(f64::from(width)) as i64;
        let differs = |x: i64, y: i64| {
            let inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
            inside && {
                let [a, b] = [single, double].map(|image| image.get(x as u32, y as u32));
                a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 1)
            }
        };
        (0..SILHOUETTE_POINTS).any(|point| {
            let angle = f64::from(point) / f64::from(SILHOUETTE_POINTS) * std::f64::consts::TAU;
            self.edge(band, angle).is_some_and(|[x, y]| {
                let (x, y) = (x.floor() as i64, y.floor() as i64);
                (-reach..=reach).any(|offset| differs(x + offset, y) || differs(x, y + offset))
            })
        })
    }

    /// Returns a point of a sphere's silhouette on the screen, in pixels from the bottom left; none for a
    /// point behind the eye.
    fn edge(&self, band: &SilhouetteBand, angle: f64) -> Option<[f64; 2]> {
        let (center, radius) = (band.center, band.radius);
        let scale = self.size[0] / 2.0;
        let [x, y] = match self.projection {
            Projection::Pinhole { screen_distance } => {
                let axis = (center - self.eye).normalize();
                let sine = radius / band.distance;
                let (u, v) = axis.any_orthonormal_pair();
                let d = axis * (1.0 - sine * sine).sqrt() + (u * angle.cos() + v * angle.sin()) * sine;
                let [x, y, depth] = self.axes.map(|axis| axis.dot(d));
                if depth <= 0.0 {
                    return None;
                }
                [x, y].map(|side| side / depth * screen_distance * scale)
            }
            Projection::Parallel { width } => {
                let [x, y] = [angle.cos(), angle.sin()].map(|side| side * radius);
                let [right, up, _] = self.axes;
                let to_center = center - self.eye;
                [right.dot(to_center) + x, up.dot(to_center) + y].map(|side| side / (width / 2.0) * scale)
            }
        };
        Some([x + self.size[0] / 2.0, y + self.size[1] / 2.0])
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{Deadline, File, Files};
    use toyproof_eval::{Number, Program, Settings};
    use toyproof_glsl::{Checked, Options, check};
    use toyproof_image::{Frame, Image};
    use toyproof_lint::lint;
    use toyproof_scene as scene;

    use super::*;

    const SIZE: [u32; 2] = [320, 180];
    const TEXTBOOK: &str = "float k = dot(f, f) - 1.0; float disc = b * b - k;";
    const RECENTERED: &str = "vec3 h = f - b * d; float disc = 1.0 - dot(h, h);";

    /// A shader that is white where rays hit the sphere of radius 1 around (0.1, 0.05, −distance), and its
    /// scene.
    fn case(discriminant: &str, distance: f64, camera: &str, ray: &str) -> (Checked, Vec<Span>, Scene) {
        let mut files = Files::default();
        let shader = format!(
            "void mainImage(out vec4 c, in vec2 p) {{
                vec2 s = (2.0 * p - iResolution.xy) / iResolution.x;
                {ray}
                vec3 f = o - vec3(0.1, 0.05, -{distance:?});
                float b = dot(f, d);
                {discriminant}
                c = vec4(disc > 0.0);
            }}"
        );
        let shader = files.add(File::new("a.glsl", shader));
        let scene = format!(
            "[camera]\n{camera}\n[[sphere]]\ncenter = [0.1, 0.05, -{distance:?}]\nradius = 1.0\n\
             material = {{ model = \"facing\", color = [1.0, 1.0, 1.0] }}\n"
        );
        let scene = files.add(File::new("a.toml", scene));
        let mut scene = scene::parse(&files, scene).unwrap();
        scene.film.size = SIZE;
        let checked = check(&files, shader, &Options::default()).unwrap();
        let lints = lint(&files, &checked, &Deadline::default());
        (checked, lints.discriminants, scene)
    }

    fn render<N: Number>(checked: &Checked) -> Image {
        let frame = Frame {
            size: SIZE,
            ..Frame::default()
        };
        let settings = Settings::<N>::default();
        let rendered = Program::new(checked).unwrap().render(&frame, &settings).unwrap();
        rendered.framebuffer.image()
    }

    fn bands(scene: &Scene, single: &Image, double: &Image) -> Vec<SilhouetteBand> {
        visible(candidates(scene), scene, &single.into(), &double.into())
    }

    /// The distance from the silhouette, in pixels, of the farthest pixel that differs between f32 and f64;
    /// none if no pixel differs.
    fn farthest(scene: &Scene, band: &SilhouetteBand, single: &Image, double: &Image) -> Option<f64> {
        let view = View::new(scene);
        let edge: Vec<_> = (0..4 * SILHOUETTE_POINTS)
            .filter_map(|point| view.edge(band, f64::from(point) / f64::from(SILHOUETTE_POINTS) * 1.6))
            .collect();
        let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
        let offset = |(x, y): (u32, u32)| {
            let near = |[u, v]: &[f64; 2]| (u - f64::from(x) - 0.5).hypot(v - f64::from(y) - 0.5);
            edge.iter().map(near).fold(f64::INFINITY, f64::min)
        };
        pixels
            .filter(|&(x, y)| single.get(x, y) != double.get(x, y))
            .map(offset)
            .reduce(f64::max)
    }

    #[test]
    fn the_band_is_as_wide_as_estimated() {
        for (distance, is_pinhole) in [
            (10.0, true),
            (100.0, true),
            (300.0, true),
            (1_000.0, true),
            (2_000.0, true),
            (10.0, false),
            (300.0, false),
            (1_000.0, false),
            (2_000.0, false),
        ] {
            // A radius of 64 pixels.
            let (camera, ray) = if is_pinhole {
                let screen = 0.4 * distance;
                (
                    format!("screen_distance = {screen:?}"),
                    format!("vec3 o = vec3(0.0), d = normalize(vec3(s, -{screen:?}));"),
                )
            } else {
                (
                    "projection = \"parallel\"\nwidth = 5.0".to_owned(),
                    "vec3 o = vec3(s * 2.5, 0.0), d = vec3(0.0, 0.0, -1.0);".to_owned(),
                )
            };
            let (checked, discriminants, scene) = case(TEXTBOOK, distance, &camera, &ray);
            assert_eq!(discriminants.len(), 1);
            let (single, double) = (render::<f32>(&checked), render::<f64>(&checked));
            let band = View::new(&scene).band(DVec3::new(0.1, 0.05, -distance), 1.0);
            let band = band.unwrap();
            let warning = bands(&scene, &single, &double);
            let farthest = farthest(&scene, &band, &single, &double);
            assert_eq!(
                warning.len(),
                usize::from(band.width >= MIN_BAND_WIDTH),
                "{distance} {band:?}"
            );
            // The band extends to both sides of the silhouette, and a pixel extends half a pixel. How much of
            // the band is visible depends on where the numbers lie between powers of two.
            let (half, offset) = (band.width / 2.0, farthest.unwrap_or(0.0));
            assert!(
                offset < 1.5 * half + 0.5 && (band.width < MIN_BAND_WIDTH || offset > 0.2 * half),
                "{distance} {band:?} {offset}"
            );

            let (checked, discriminants, _) = case(RECENTERED, distance, &camera, &ray);
            assert!(discriminants.is_empty());
            assert_eq!(render::<f32>(&checked), render::<f64>(&checked), "{distance}");
        }
    }

    #[test]
    fn an_invisible_band_is_not_reported() {
        let camera = "screen_distance = 400.0";
        let ray = "vec3 o = vec3(0.0), d = normalize(vec3(s, -400.0));";
        let (checked, discriminants, scene) = case(TEXTBOOK, 1_000.0, camera, ray);
        let single = render::<f32>(&checked);
        assert!(bands(&scene, &single, &single).is_empty());
        let warning = warning(
            &bands(&scene, &single, &render::<f64>(&checked)),
            discriminants[0],
        );
        assert_eq!(
            warning.unwrap().message,
            "float32 is too imprecise here for the silhouette of the sphere at (0.1, 0.05, -1000) with radius 1: \
             rays hit or miss arbitrarily in a band up to 17 pixels wide"
        );
    }
}
