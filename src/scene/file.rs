//! The scene file: TOML, with every mistake told by line and column.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::{Background, Camera, Color, Film, Light, Material, Model, Sampler, Scene, Sphere};
use crate::diagnostic::Diagnostic;
use crate::image::check_size;
use crate::source::{FileId, Files, Span};

/// The most samples a pixel.
const MAX_SAMPLES: i64 = 65_536;
/// The most path segments.
const MAX_DEPTH: i64 = 1_000;

/// Reads a scene.
///
/// # Errors
/// What the file should have said, for the first thing that TOML or its schema refuses, or for every value
/// that is out of range.
pub fn parse(files: &Files, file: FileId) -> Result<Scene, Vec<Diagnostic>> {
    let text = files.get(file).text();
    let document: Document = toml::from_str(text).map_err(|error| {
        let diagnostic = Diagnostic::error("E0501", one_sentence(error.message()));
        vec![match error.span() {
            Some(bytes) => diagnostic.at(span(file, bytes)),
            None => diagnostic.at(Span::new(file, 0, 0)),
        }]
    })?;
    let mut checks = Checks {
        file,
        diagnostics: Vec::new(),
    };
    let scene = document.check(&mut checks);
    if checks.diagnostics.is_empty() {
        Ok(scene)
    } else {
        Err(checks.diagnostics)
    }
}

fn one_sentence(message: &str) -> String {
    message.lines().map(str::trim).collect::<Vec<_>>().join("; ")
}

fn span(file: FileId, bytes: Range<usize>) -> Span {
    Span::new(file, bytes.start as u32, bytes.end.max(bytes.start) as u32)
}

type Triple = Spanned<[f64; 3]>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    title: String,
    ambient: Option<Triple>,
    #[serde(default)]
    film: FilmTable,
    #[serde(default)]
    camera: CameraTable,
    background: Option<Spanned<BackgroundTable>>,
    #[serde(default)]
    light: Vec<LightTable>,
    #[serde(default)]
    sphere: Vec<SphereTable>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct FilmTable {
    size: Option<Spanned<[i64; 2]>>,
    samples: Option<Spanned<i64>>,
    sampler: Option<SamplerName>,
    max_depth: Option<Spanned<i64>>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum SamplerName {
    Center,
    SineHash,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct CameraTable {
    eye: Option<Triple>,
    screen_distance: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BackgroundTable {
    color: Option<Triple>,
    bottom: Option<Triple>,
    top: Option<Triple>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LightTable {
    position: Triple,
    color: Option<Triple>,
    shadow: Option<bool>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereTable {
    center: Triple,
    radius: Spanned<f64>,
    material: MaterialTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialTable {
    model: ModelName,
    color: Triple,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum ModelName {
    Facing,
    Lambert,
    Mirror,
}

/// Takes values that are in range and notes those that are not.
struct Checks {
    file: FileId,
    diagnostics: Vec<Diagnostic>,
}

impl Checks {
    fn refuse(&mut self, bytes: Range<usize>, message: String) {
        self.diagnostics
            .push(Diagnostic::error("E0502", message).at(span(self.file, bytes)));
    }

    fn point(&mut self, what: &str, value: Option<Triple>, default: [f64; 3]) -> [f64; 3] {
        let Some(value) = value else {
            return default;
        };
        if !value.get_ref().iter().all(|x| x.is_finite()) {
            self.refuse(value.span(), format!("{what} must be three finite numbers"));
        }
        value.into_inner()
    }

    fn color(&mut self, what: &str, value: Option<Triple>, default: Color) -> Color {
        let Some(value) = value else {
            return default;
        };
        if !value.get_ref().iter().all(|x| x.is_finite() && *x >= 0.0) {
            self.refuse(
                value.span(),
                format!("{what} must be three finite numbers, none below 0"),
            );
        }
        value.into_inner()
    }

    fn positive(&mut self, what: &str, value: &Spanned<f64>) -> f64 {
        let number = *value.get_ref();
        if !(number.is_finite() && number > 0.0) {
            self.refuse(
                value.span(),
                format!("{what} must be a finite number above 0, not {number}"),
            );
        }
        number
    }

    fn count(&mut self, what: &str, value: Option<Spanned<i64>>, max: i64) -> u32 {
        let Some(value) = value else {
            return 1;
        };
        let number = *value.get_ref();
        if !(1..=max).contains(&number) {
            self.refuse(
                value.span(),
                format!("{what} must be a whole number from 1 to {max}, not {number}"),
            );
        }
        number as u32
    }

    fn size(&mut self, value: Option<Spanned<[i64; 2]>>) -> [u32; 2] {
        let Some(value) = value else {
            return [640, 360];
        };
        let [width, height] = value.get_ref().map(|side| side.max(0) as u64);
        check_size(width, height).unwrap_or_else(|message| {
            self.refuse(value.span(), message);
            [1, 1]
        })
    }
}

impl Document {
    fn check(self, checks: &mut Checks) -> Scene {
        let black = [0.0; 3];
        Scene {
            title: self.title,
            ambient: checks.color("ambient", self.ambient, black),
            film: Film {
                size: checks.size(self.film.size),
                samples: checks.count("samples", self.film.samples, MAX_SAMPLES),
                sampler: match self.film.sampler {
                    None | Some(SamplerName::Center) => Sampler::Center,
                    Some(SamplerName::SineHash) => Sampler::SineHash,
                },
                max_depth: checks.count("max_depth", self.film.max_depth, MAX_DEPTH),
            },
            camera: Camera {
                eye: checks.point("eye", self.camera.eye, [0.0; 3]),
                screen_distance: self
                    .camera
                    .screen_distance
                    .map_or(2.0, |distance| checks.positive("screen_distance", &distance)),
            },
            background: background(self.background, checks),
            lights: self
                .light
                .into_iter()
                .map(|light| Light {
                    position: checks.point("position", Some(light.position), black),
                    color: checks.color("color", light.color, [1.0; 3]),
                    shadow: light.shadow.unwrap_or(true),
                })
                .collect(),
            spheres: self
                .sphere
                .into_iter()
                .map(|sphere| Sphere {
                    center: checks.point("center", Some(sphere.center), black),
                    radius: checks.positive("radius", &sphere.radius),
                    material: Material {
                        model: match sphere.material.model {
                            ModelName::Facing => Model::Facing,
                            ModelName::Lambert => Model::Lambert,
                            ModelName::Mirror => Model::Mirror,
                        },
                        color: checks.color("color", Some(sphere.material.color), black),
                    },
                })
                .collect(),
        }
    }
}

fn background(table: Option<Spanned<BackgroundTable>>, checks: &mut Checks) -> Background {
    let black = [0.0; 3];
    let Some(table) = table else {
        return Background::Uniform(black);
    };
    let bytes = table.span();
    match table.into_inner() {
        BackgroundTable {
            color,
            bottom: None,
            top: None,
        } => Background::Uniform(checks.color("color", color, black)),
        BackgroundTable {
            color: None,
            bottom: Some(bottom),
            top: Some(top),
        } => Background::Gradient {
            bottom: checks.color("bottom", Some(bottom), black),
            top: checks.color("top", Some(top), black),
        },
        _ => {
            checks.refuse(
                bytes,
                "a background has either a color, or a bottom and a top".to_owned(),
            );
            Background::Uniform(black)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::short;
    use crate::source::File;

    fn read(text: &str) -> Result<Scene, Vec<String>> {
        let mut files = Files::default();
        let file = files.add(File::new("s.toml", text));
        parse(&files, file).map_err(|diagnostics| diagnostics.iter().map(|d| short(d, &files)).collect())
    }

    const SPHERE: &str = "[[sphere]]\ncenter = [0, 0, -6.0]\nradius = 1.5\nmaterial = { model = \"facing\", color = [1, 1, 0] }\n";

    #[test]
    fn an_empty_file_is_the_empty_scene_with_all_defaults() {
        let scene = read("").unwrap();
        assert_eq!(
            scene.film,
            Film {
                size: [640, 360],
                samples: 1,
                sampler: Sampler::Center,
                max_depth: 1
            }
        );
        assert_eq!(
            scene.camera,
            Camera {
                eye: [0.0; 3],
                screen_distance: 2.0
            }
        );
        assert_eq!(scene.background, Background::Uniform([0.0; 3]));
    }

    #[test]
    fn a_whole_scene_is_read_as_written() {
        let scene = read(&format!(
            "title = \"t\"\nambient = [0.1, 0.2, 0.3]\n[film]\nsize = [4, 2]\nsamples = 3\nsampler = \"sine-hash\"\nmax_depth = 9\n\
             [camera]\neye = [1.0, 2.0, 3.0]\nscreen_distance = 1.5\n[background]\nbottom = [0, 0, 0]\ntop = [1, 1, 1]\n\
             [[light]]\nposition = [5, 5, 0]\nshadow = false\n{SPHERE}"
        ))
        .unwrap();
        assert_eq!(
            scene.film,
            Film {
                size: [4, 2],
                samples: 3,
                sampler: Sampler::SineHash,
                max_depth: 9
            }
        );
        assert_eq!(
            scene.background,
            Background::Gradient {
                bottom: [0.0; 3],
                top: [1.0; 3]
            }
        );
        assert_eq!(
            scene.lights[0],
            Light {
                position: [5.0, 5.0, 0.0],
                color: [1.0; 3],
                shadow: false
            }
        );
        assert_eq!(scene.spheres[0].radius, 1.5);
        assert_eq!(scene.spheres[0].material.model, Model::Facing);
    }

    #[test]
    fn each_mistake_is_told_by_line_column_and_what_was_expected() {
        for (text, place, words) in [
            (
                "[film]\nsise = [1, 1]",
                "s.toml:2:1: error[E0501]",
                "unknown field `sise`, expected one of",
            ),
            (
                "[camera]\neye = [0, 0]",
                "s.toml:2:7: error[E0501]",
                "array of length 3",
            ),
            ("[camera]\neye = \"here\"", "s.toml:2:7: error[E0501]", "expected"),
            (
                "[camera]\neye = [0, nan, 0]",
                "s.toml:2:7: error[E0502]",
                "finite",
            ),
            (
                "[camera]\nscreen_distance = -1",
                "s.toml:2:19: error[E0502]",
                "above 0, not -1",
            ),
            (
                "[film]\nsize = [0, 0]",
                "s.toml:2:8: error[E0502]",
                "nothing to show",
            ),
            (
                "[film]\nsize = [100000, 100000]",
                "s.toml:2:8: error[E0502]",
                "too large",
            ),
            (
                "[film]\nsamples = 0",
                "s.toml:2:11: error[E0502]",
                "from 1 to 65536, not 0",
            ),
            (
                "[film]\nsampler = \"sobel\"",
                "s.toml:2:11: error[E0501]",
                "unknown variant `sobel`",
            ),
            (
                "[background]\ntop = [1, 1, 1]",
                "s.toml:1:1: error[E0502]",
                "a bottom and a top",
            ),
            (
                "ambient = [-1, 0, 0]",
                "s.toml:1:11: error[E0502]",
                "none below 0",
            ),
            ("title = ", "s.toml:1:9: error[E0501]", ""),
        ] {
            let errors = read(text).unwrap_err();
            assert!(
                errors[0].starts_with(place) && errors[0].contains(words),
                "{text}: {errors:?}"
            );
            assert!(!errors[0].contains('\n'));
        }
        let radius = read(&SPHERE.replace("1.5", "0.0")).unwrap_err();
        assert!(
            radius[0].starts_with("s.toml:3:10: error[E0502]: radius must be"),
            "{radius:?}"
        );
    }

    #[test]
    fn every_value_out_of_range_is_told_at_once() {
        assert_eq!(
            read("ambient = [inf, 0, 0]\n[film]\nsamples = 0\nmax_depth = 0")
                .unwrap_err()
                .len(),
            3
        );
    }
}
