//! Spheres of a scene whose edge the textbook's discriminant loses.
//!
//! b² − c, with c = |f|² − r², is a difference of numbers near L², where L is the distance from the eye to the centre: its error is that of
//! L², whatever is left of it. Where the rest is smaller than the error, on both sides of the edge, rays hit or miss by chance.

use glam::DVec3;
use toyproof_diagnostic::{Diagnostic, Span};
use toyproof_glsl::Code;
use toyproof_image::Shown;
use toyproof_scene::{Projection, Scene, Shape};

/// Half of an f32's unit in the last place, relative.
const U: f64 = 1.0 / 16_777_216.0;
/// The largest error of the discriminant, in u·L², as it was measured: with rays in all directions, and with parallel ones, for
/// all of which b is the same.
const ERROR: f64 = 4.4;
const ERROR_PARALLEL: f64 = 1.1;
/// Narrower bands look like any other edge, in pixels.
const NARROWEST: f64 = 1.0;
/// How many places of an edge are looked for on the screen.
const PLACES: u32 = 256;

/// A sphere whose edge may come out wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Trap {
    center: DVec3,
    radius: f64,
    /// How far away its centre is.
    distance: f64,
    /// How wide the band may be where rays hit or miss by chance, in pixels.
    width: f64,
}

/// The spheres of a scene that stands still whose edge may come out wrong, as reckoned. The widest band comes first.
pub(super) fn suspected(scene: &Scene) -> Vec<Trap> {
    let view = View::new(scene);
    let spheres = scene.objects.iter().filter_map(|object| match object.shape {
        Shape::Sphere { center, radius } => Some((DVec3::from_array(center), radius)),
        _ => None,
    });
    let mut traps: Vec<_> = spheres
        .filter_map(|(center, radius)| view.trap(center, radius))
        .filter(|trap| trap.width >= NARROWEST)
        .collect();
    traps.sort_by(|a, b| b.width.total_cmp(&a.width));
    traps
}

/// Those of them whose edge is on the screen, and wrong there, as the shader paints it in f32 and in f64.
pub(super) fn shown(mut traps: Vec<Trap>, scene: &Scene, single: &Shown, double: &Shown) -> Vec<Trap> {
    let view = View::new(scene);
    traps.retain(|trap| view.shows(trap, single, double));
    traps
}

/// The warning about them, told of the discriminant.
pub(super) fn told(traps: &[Trap], at: Span) -> Option<Diagnostic> {
    let (worst, others) = traps.split_first()?;
    let diagnostic = worst.told(at);
    Some(match others.len() {
        0 => diagnostic,
        1 => diagnostic.note("so it is with another sphere, less so"),
        count => diagnostic.note(format!("so it is with {count} other spheres, less so")),
    })
}

impl Trap {
    fn told(&self, at: Span) -> Diagnostic {
        let [x, y, z] = self.center.to_array();
        let (radius, distance, width) = (self.radius, self.distance, self.width);
        let message = format!(
            "this discriminant loses the edge of the sphere at ({x}, {y}, {z}) with radius {radius}: in a band up to {width:.0} pixels wide, rays hit or miss by chance"
        );
        let note = format!(
            "its centre is {distance:.0} away, and the error of f32 grows with the square of that. Write it around the point of the ray that is nearest to the centre: `vec3 h = f - dot(f, d) * d; float disc = r*r - dot(h, h);` for a unit direction d"
        );
        Diagnostic::warning(Code::NearTangent.as_str(), message)
            .at(at)
            .note(note)
    }
}

/// Where the rays of a picture go.
struct View {
    eye: DVec3,
    projection: Projection,
    size: [f64; 2],
}

impl View {
    fn new(scene: &Scene) -> Self {
        Self {
            eye: DVec3::from_array(scene.camera.eye),
            projection: scene.camera.projection,
            size: scene.film.size.map(f64::from),
        }
    }

    fn trap(&self, center: DVec3, radius: f64) -> Option<Trap> {
        let f = self.eye - center;
        let (distance, width) = match self.projection {
            Projection::Pinhole { screen_distance } => {
                let distance = f.length();
                // To where rays touch it; none from inside.
                let reach = (distance * distance - radius * radius).sqrt();
                let error = ERROR * U * distance * distance;
                // The discriminant of a ray that is turned by a small angle a from the edge: 2·r·reach·a + r²·a².
                let angle = ((reach * reach + error).sqrt() - reach) / radius;
                (distance, 2.0 * angle * screen_distance * self.size[0] / 2.0)
            }
            Projection::Parallel { width } => {
                let distance = f.z.hypot(radius);
                let error = ERROR_PARALLEL * U * distance * distance;
                (distance, error / radius * self.size[0] / width)
            }
        };
        (f.length() > radius).then_some(Trap {
            center,
            radius,
            distance,
            width,
        })
    }

    /// Whether the two pictures differ visibly within the band.
    fn shows(&self, trap: &Trap, single: &Shown, double: &Shown) -> bool {
        let [width, height] = single.size();
        let reach = trap.width.ceil().min(f64::from(width)) as i64;
        let differs = |x: i64, y: i64| {
            let inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
            inside && {
                let [a, b] = [single, double].map(|picture| picture.get(x as u32, y as u32));
                a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 1)
            }
        };
        (0..PLACES).any(|place| {
            let angle = f64::from(place) / f64::from(PLACES) * std::f64::consts::TAU;
            self.edge(trap, angle).is_some_and(|[x, y]| {
                let (x, y) = (x.floor() as i64, y.floor() as i64);
                (-reach..=reach).any(|away| differs(x + away, y) || differs(x, y + away))
            })
        })
    }

    /// Where on the screen the edge of a sphere is seen, in pixels from the bottom left; none for what lies behind the eye.
    fn edge(&self, trap: &Trap, angle: f64) -> Option<[f64; 2]> {
        let (center, radius) = (trap.center, trap.radius);
        let scale = self.size[0] / 2.0;
        let [x, y] = match self.projection {
            Projection::Pinhole { screen_distance } => {
                let axis = (center - self.eye).normalize();
                let sine = radius / trap.distance;
                let (u, v) = axis.any_orthonormal_pair();
                let d = axis * (1.0 - sine * sine).sqrt() + (u * angle.cos() + v * angle.sin()) * sine;
                if d.z >= 0.0 {
                    return None;
                }
                [d.x, d.y].map(|side| side / -d.z * screen_distance * scale)
            }
            Projection::Parallel { width } => {
                let [x, y] = [angle.cos(), angle.sin()].map(|side| side * radius);
                let (x, y) = (center.x + x - self.eye.x, center.y + y - self.eye.y);
                [x, y].map(|side| side / (width / 2.0) * scale)
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
    const RECENTRED: &str = "vec3 h = f - b * d; float disc = 1.0 - dot(h, h);";

    /// A shader of white where rays meet the sphere of radius 1 around (0.1, 0.05, −distance), and its scene.
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

    fn paint<N: Number>(checked: &Checked) -> Image {
        let frame = Frame {
            size: SIZE,
            ..Frame::default()
        };
        let settings = Settings::<N>::default();
        let painted = Program::new(checked).unwrap().paint(&frame, &settings).unwrap();
        painted.painting.image()
    }

    fn traps(scene: &Scene, single: &Image, double: &Image) -> Vec<Trap> {
        shown(suspected(scene), scene, &single.into(), &double.into())
    }

    /// How far from the edge, in pixels, the farthest pixel lies that is another in f32 than in f64; none if all are the same.
    fn farthest(scene: &Scene, trap: &Trap, single: &Image, double: &Image) -> Option<f64> {
        let view = View::new(scene);
        let edge: Vec<_> = (0..4 * PLACES)
            .filter_map(|place| view.edge(trap, f64::from(place) / f64::from(PLACES) * 1.6))
            .collect();
        let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
        let away = |(x, y): (u32, u32)| {
            let near = |[u, v]: &[f64; 2]| (u - f64::from(x) - 0.5).hypot(v - f64::from(y) - 0.5);
            edge.iter().map(near).fold(f64::INFINITY, f64::min)
        };
        pixels
            .filter(|&(x, y)| single.get(x, y) != double.get(x, y))
            .map(away)
            .reduce(f64::max)
    }

    #[test]
    fn the_band_is_as_wide_as_it_was_reckoned() {
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
            let (single, double) = (paint::<f32>(&checked), paint::<f64>(&checked));
            let trap = View::new(&scene).trap(DVec3::new(0.1, 0.05, -distance), 1.0);
            let trap = trap.unwrap();
            let told = traps(&scene, &single, &double);
            let farthest = farthest(&scene, &trap, &single, &double);
            assert_eq!(
                told.len(),
                usize::from(trap.width >= NARROWEST),
                "{distance} {trap:?}"
            );
            // A band lies on both sides of the edge, half a pixel is what pixels are wide. How much of it is seen depends on where the
            // numbers lie between powers of two.
            let (half, seen) = (trap.width / 2.0, farthest.unwrap_or(0.0));
            assert!(
                seen < 1.5 * half + 0.5 && (trap.width < NARROWEST || seen > 0.2 * half),
                "{distance} {trap:?} {seen}"
            );

            let (checked, discriminants, _) = case(RECENTRED, distance, &camera, &ray);
            assert!(discriminants.is_empty());
            assert_eq!(paint::<f32>(&checked), paint::<f64>(&checked), "{distance}");
        }
    }

    #[test]
    fn what_the_picture_does_not_show_is_not_told() {
        let camera = "screen_distance = 400.0";
        let ray = "vec3 o = vec3(0.0), d = normalize(vec3(s, -400.0));";
        let (checked, discriminants, scene) = case(TEXTBOOK, 1_000.0, camera, ray);
        let single = paint::<f32>(&checked);
        assert!(traps(&scene, &single, &single).is_empty());
        let told = told(&traps(&scene, &single, &paint::<f64>(&checked)), discriminants[0]);
        assert_eq!(
            told.unwrap().message,
            "this discriminant loses the edge of the sphere at (0.1, 0.05, -1000) with radius 1: \
             in a band up to 17 pixels wide, rays hit or miss by chance"
        );
    }
}
