//! The conditioning of a reference: the number of pixels in which rounding decides its own color, and the
//! edit of a scene that prevents it.

use std::collections::BTreeSet;

use rayon::prelude::*;
use toyproof_eval::Places;
use toyproof_image::pcg;
use toyproof_scene::{Point, Scene};

use super::scene::SceneReference;
use super::{Expected, NumberType};
use crate::compare::Share;
use crate::limits::MAX_DIFFERING;

/// The number of tested pixels, roughly; divided by the number of samples of each.
const TESTED_PIXELS: u32 = 6000;

/// The largest number of lights, and of patterns, that are edited.
const MAX_EDITS: usize = 16;

/// The pixels of a reference in which rounding decides its own color, as where the edge of a tile passes
/// exactly through the sample point. They are left out of comparisons.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditioning {
    /// The ill-conditioned ones of the tested pixels, which are spread over the image.
    pub ill_conditioned: Share,
    /// The edit of a scene that prevents them, such as “move the eye from [0.0, 0.0, 0.0] to [0.0013, 0.0009,
    /// 0.0005]”.
    pub edit: Option<String>,
}

impl Expected {
    /// Tests some rows and columns of the image: edges that pass through many sample points follow one or the
    /// other. `None` if fewer pixels are ill-conditioned than may differ anyway, or if the reference is an
    /// image, of which nothing else is known.
    #[must_use]
    pub fn conditioning(&self) -> Option<Conditioning> {
        match self {
            Self::Scene(scene) => of_scene(scene),
            Self::Shader(shader) => {
                let places = tested_places(shader.frame.size, 1);
                let counts = places.iter().map(|places| shader.ill_conditioned_at(places));
                let ill_conditioned = share(&places, counts.sum());
                is_reported(ill_conditioned).then_some(Conditioning {
                    ill_conditioned,
                    edit: None,
                })
            }
            Self::Image(_) => None,
        }
    }
}

fn is_reported(ill_conditioned: Share) -> bool {
    ill_conditioned.ratio() > MAX_DIFFERING
}

/// Some rows, and some columns. They are selected at random: edges prefer the lines in the middle and at
/// round shares.
fn tested_places(size: [u32; 2], samples: u32) -> [Places; 2] {
    let pairs = (TESTED_PIXELS / samples.max(1) / (size[0] + size[1]) / 2).max(1);
    let centers = |pixels: BTreeSet<u32>| pixels.into_iter().map(|at| f64::from(at) + 0.5).collect();
    // Whole quads, for derivatives.
    let some = |axis: usize| {
        let quads = (0..pairs).map(|pair| 2 * (pcg(pair) % size[axis].div_ceil(2)));
        let lines = quads.flat_map(|at| [at, at + 1]);
        centers(lines.filter(|&at| at < size[axis]).collect())
    };
    let all = |axis: usize| centers((0..size[axis]).collect());
    let [rows, columns] = [[all(0), some(1)], [some(0), all(1)]];
    [rows, columns].map(|[columns, rows]| Places { columns, rows })
}

fn share(places: &[Places; 2], count: u64) -> Share {
    let pixels = |places: &Places| places.size().map(u64::from).iter().product::<u64>();
    let of = places.iter().map(pixels).sum();
    Share { count, of }
}

fn of_scene(reference: &SceneReference) -> Option<Conditioning> {
    let scene = reference.scene();
    let places = tested_places(scene.film.size, scene.film.samples);
    let pixels: Vec<[u32; 2]> = places
        .iter()
        .flat_map(|places| {
            let [columns, rows] = places.pixels();
            rows.into_iter()
                .flat_map(move |y| columns.clone().into_iter().map(move |x| [x, y]))
        })
        .collect();
    let is_tied = |reference: &SceneReference, [x, y]: [u32; 2]| reference.is_tied(x, y, NumberType::Double);
    let tied: Vec<[u32; 2]> = pixels
        .par_iter()
        .copied()
        .filter(|&pixel| is_tied(reference, pixel))
        .collect();
    let ill_conditioned = share(&places, tied.len() as u64);
    if !is_reported(ill_conditioned) {
        return None;
    }
    let is_cured = |edited: Scene| {
        let edited = reference.with_scene(edited);
        // Most edits leave the pixels as they are.
        tied.par_iter().all(|&pixel| !is_tied(&edited, pixel))
            && pixels.par_iter().all(|&pixel| !is_tied(&edited, pixel))
    };
    let edit = edits(scene)
        .into_iter()
        .find(|(_, edited)| is_cured(edited.clone()));
    Some(Conditioning {
        ill_conditioned,
        edit: edit.map(|(text, _)| text),
    })
}

/// Small edits of a scene, each with its description: a moved eye or light, or a pattern of another size.
fn edits(scene: &Scene) -> Vec<(String, Scene)> {
    let step = Step::new(scene);
    let mut edits = Vec::new();
    let mut edit = |text: String, change: &dyn Fn(&mut Scene)| {
        let mut edited = scene.clone();
        change(&mut edited);
        edits.push((text, edited));
    };
    let (eye, moved) = step.moved(scene.camera.eye);
    edit(format!("move the eye from {eye}"), &|scene| {
        scene.camera.eye = moved;
    });
    for (at, light) in scene.lights.iter().enumerate().take(MAX_EDITS) {
        let (position, moved) = step.moved(light.position);
        edit(format!("move the light from {position}"), &|scene| {
            scene.lights[at].position = moved;
        });
    }
    let patterns = scene.objects.iter().enumerate();
    let patterns = patterns.filter_map(|(at, object)| Some((at, object.material.pattern.as_ref()?.size)));
    for (at, size) in patterns.take(MAX_EDITS) {
        let other = step.number(size, 1.0);
        edit(
            format!("change the pattern's size from {size:?} to {other:?}"),
            &|scene| {
                if let Some(pattern) = &mut scene.objects[at].material.pattern {
                    pattern.size = other;
                }
            },
        );
    }
    edits
}

/// About a thousandth of a scene's size, and no round number.
struct Step {
    length: f64,
    /// The number of decimals with which numbers are written.
    decimals: usize,
}

impl Step {
    fn new(scene: &Scene) -> Self {
        let magnitude = scene.size().max(f64::MIN_POSITIVE).log10().floor();
        Self {
            length: 1.3 * 10f64.powf(magnitude - 3.0),
            decimals: (4.0 - magnitude).clamp(0.0, 17.0) as usize,
        }
    }

    fn number(&self, number: f64, steps: f64) -> f64 {
        let text = format!("{:.*}", self.decimals, number + steps * self.length);
        text.parse().unwrap_or(number)
    }

    /// A moved point, and the text “A to B”.
    fn moved(&self, point: Point) -> (String, Point) {
        let [x, y, z] = point;
        let moved = [self.number(x, 1.0), self.number(y, 0.7), self.number(z, 0.4)];
        (format!("{point:?} to {moved:?}"), moved)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use toyproof_diagnostic::{Deadline, File, Files};
    use toyproof_glsl as glsl;
    use toyproof_image::Frame;
    use toyproof_lint::Lints;
    use toyproof_scene as scene;

    use super::*;
    use crate::{DEFAULT_TOLERANCE, ShaderReference};

    fn frame(size: [u32; 2]) -> Frame {
        Frame {
            size,
            ..Frame::default()
        }
    }

    fn scene(text: &str) -> Scene {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        scene::parse(&files, file).unwrap()
    }

    fn shader(text: &str, size: [u32; 2]) -> Option<Conditioning> {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let timeout = Duration::from_secs(60);
        let options = glsl::Options {
            deadline: Deadline::after(timeout),
            ..glsl::Options::default()
        };
        let checked = glsl::check(&files, file, &options).unwrap();
        let frame = frame(size);
        let reference = ShaderReference::new(&checked, &Lints::default(), &frame, DEFAULT_TOLERANCE, timeout);
        Expected::Shader(Box::new(reference.unwrap().0)).conditioning()
    }

    const FLOOR: &str = "[[plane]]\npoint = [0.0, -1.037, 0.0]\nmaterial = { model = \"lambert\", color = [1.0, 1.0, \
                         1.0], checker = { color = [0.0, 0.0, 0.0], size = 1.0 } }\n\
                         [[light]]\nposition = [3.0, 4.0, 1.0]\ncolor = [1.0, 1.0, 1.0]\n";

    #[test]
    fn tile_edges_on_pixel_centers_are_found_and_the_edit_moves_them() {
        // The eye is above an edge of the tiles, and in images of odd width a column of pixels is.
        let scene = scene(FLOOR);
        let even = Expected::from_scene(scene.clone(), &frame([160, 90]));
        assert_eq!(even.conditioning(), None);
        let odd = Expected::from_scene(scene.clone(), &frame([161, 90]));
        let found = odd.conditioning().unwrap();
        // Half of the column sees the floor.
        let ratio = found.ill_conditioned.ratio() * 161.0;
        assert!((0.4..=0.6).contains(&ratio), "{found:?}");
        let edit = "move the eye from [0.0, 0.0, 0.0] to [0.0013, 0.0009, 0.0005]";
        assert_eq!(found.edit.as_deref(), Some(edit));
        let mut edited = scene;
        edited.camera.eye = [0.0013, 0.0009, 0.0005];
        let edited = Expected::from_scene(edited, &frame([161, 90]));
        assert_eq!(edited.conditioning(), None);
    }

    #[test]
    fn a_light_on_a_surface_is_moved() {
        // Shadow rays from the floor end on the sphere: whether it blocks them depends on rounding.
        let sphere = "[[sphere]]\ncenter = [0.0, 3.0, -6.0]\nradius = 1.0\n\
                      material = { model = \"lambert\", color = [1.0, 1.0, 1.0] }\n";
        let scene = scene(&(FLOOR.replace("[3.0, 4.0, 1.0]", "[0.6, 2.2, -6.0]") + sphere));
        let found = Expected::from_scene(scene, &frame([160, 90])).conditioning();
        let edit = found.and_then(|found| found.edit);
        assert!(
            edit.as_ref()
                .is_some_and(|edit| edit.starts_with("move the light")),
            "{edit:?}"
        );
    }

    #[test]
    fn the_template_is_well_conditioned() {
        let scene = scene(&scene::template("week 1"));
        for size in [scene.film.size, [320, 180], [161, 91], [500, 500]] {
            let expected = Expected::from_scene(scene.clone(), &frame(size));
            assert_eq!(expected.conditioning(), None, "{size:?}");
        }
    }

    #[test]
    fn edges_of_a_reference_shader_on_pixel_centers_are_found() {
        let text = "void mainImage(out vec4 color, in vec2 pixel) {
            float x = pixel.x / iResolution.x * 2.0 - 1.0;
            color = vec4(x < 0.0 ? 0.2 : 0.8);
        }";
        assert_eq!(shader(text, [160, 90]), None);
        let found = shader(text, [161, 90]).unwrap();
        assert_eq!(found.edit, None);
        let ratio = found.ill_conditioned.ratio() * 161.0;
        // None of the tested columns is the one in the middle.
        assert!((0.5..=1.0).contains(&ratio), "{found:?}");
    }
}
