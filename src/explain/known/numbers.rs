//! Mistakes in one number: a parameter of the scene or of the shader is fitted to the wrong image, and the
//! scene or the shader with the best value is a mutant like others.

use std::sync::Arc;

use toyproof_scene::export::{MarkedShader, Slot};
use toyproof_scene::{FrameTime, Model, Point, Projection, Scene, Shape};

use super::KnownMistake;
use super::change::place;
use crate::engine::fit::Fit;
use crate::engine::probes::Probes;
use crate::engine::tournament::{Entrant, Values, play};
use crate::engine::{Colors, Hypothesis, Numbers};
use crate::known::documented::{Documented, documented};
use crate::known::mutant::{Mutant, MutantSource};
use crate::known::view::View;

/// What the guide says about these mistakes.
pub(super) const DOCUMENTED: &[Documented] = documented! {
    /// Allow as many steps as a ray can need: the sum of the grid's cells along x, y and z.
    Grids "too-few-grid-steps": "the grid traversal stops after … cells";
    /// Use the scene's `screen_distance`.
    Numbers "wrong-screen-distance": "the screen distance is …; the scene has …";
    /// Use the scene's `width`.
    Numbers "wrong-projection-width": "the width of the parallel projection is …; the scene has …";
    /// Use the scene's `gamma`.
    Numbers "wrong-gamma": "gamma is …; the scene has …";
    /// Use the scene's `color` of the light, and check the factors of the shading.
    Numbers "wrong-brightness": "the light at … is … times as bright as the scene's";
    /// Use the scene's `ambient`.
    Numbers "wrong-ambient-light": "the ambient light is … times as bright as the scene's";
    /// Use the scene's `radius` of the light.
    Numbers "wrong-light-radius": "the radius of the light at … is …; the scene has …";
    /// Use the scene's `ior`.
    Numbers "wrong-ior": "the refractive index is …; the scene has …";
    /// Use the scene's `radius` of the sphere.
    Numbers "wrong-radius": "the radius of the sphere at … is …; the scene has …";
    /// Use `throughput *= color` with the color of the mirror that was hit.
    Numbers "constant-mirror-color": "every mirror multiplies the throughput by … instead of its color";
};

/// The hypothesis that a number of the scene, or of the shader that renders it, is wrong.
struct Parameter<'a> {
    id: &'static str,
    /// Describes the mistake of having a value.
    describe: Box<dyn Fn(&str) -> String + Sync + 'a>,
    /// The value whose multiples are tried, or the values that are.
    values: Values,
    /// The correct value, if the scene has this number.
    correct: Option<f64>,
    source: Box<dyn Fn(f64) -> Option<MutantSource> + Sync + 'a>,
    view: &'a Arc<View>,
}

impl Hypothesis for Parameter<'_> {
    type Confirmed = Mutant;

    fn colors(&self, probes: &Probes, &[value, ..]: &Numbers) -> Option<Colors> {
        (self.source)(value)?.colors(&self.view.frame, probes)
    }

    /// A number that is not the correct one is a mutant, which is confirmed like others.
    fn confirm(&self, &[value, ..]: &Numbers) -> Option<Mutant> {
        let is_near = |correct: f64| (value - correct).abs() <= MIN_RELATIVE_ERROR * correct;
        let is_wrong = !self.correct.is_some_and(is_near);
        let source = is_wrong.then(|| (self.source)(value)).flatten()?;
        Some(Mutant::new(vec![self.mistake(value)], source, self.view))
    }
}

impl Parameter<'_> {
    fn mistake(&self, value: f64) -> KnownMistake {
        KnownMistake::new(self.id, (self.describe)(&three_digits(value)))
    }
}

/// The smallest relative difference from the correct value of a number that is reported as wrong.
const MIN_RELATIVE_ERROR: f64 = 0.01;

/// The largest number of surfaces whose radii are fitted.
const MAX_OBJECTS: usize = 16;

/// The numbers of steps through a grid that are tried.
const STEPS: std::ops::RangeInclusive<u32> = 2..=16;

/// The numbers of a scene and of its shader.
pub(super) struct Parameters<'a> {
    pub(super) scene: &'a Scene,
    pub(super) frame_time: FrameTime,
    pub(super) shader: Option<&'a MarkedShader>,
    pub(super) view: &'a Arc<View>,
}

impl<'a> Parameters<'a> {
    /// Returns the mutants that explain some of the wrong pixels with one number, each with its value.
    pub(super) fn fitted(&self, probes: &Probes) -> Vec<Mutant> {
        let Some(probes) = probes.selection() else {
            return Vec::new();
        };
        let all = self.all();
        let entrants = all.iter().map(|parameter| Entrant {
            values: &parameter.values,
            cost: 0,
        });
        let entrants: Vec<Entrant> = entrants.collect();
        let finalists = play(&mut &all[..], &entrants, &probes).into_iter();
        finalists
            .filter_map(|finalist| all[finalist.hypothesis].confirm(&finalist.numbers))
            .collect()
    }

    /// The mistakes in them, each with some value.
    #[cfg(test)]
    pub(super) fn examples(&self) -> Vec<KnownMistake> {
        self.all()
            .iter()
            .map(|parameter| parameter.mistake(1.25))
            .collect()
    }

    fn all(&self) -> Vec<Parameter<'a>> {
        let scene = self.scene;
        let mut all = Vec::new();
        match scene.camera.projection {
            Projection::Pinhole { screen_distance } => {
                all.push(self.of_scene(
                    "wrong-screen-distance",
                    None,
                    screen_distance,
                    |scene, screen_distance| {
                        scene.camera.projection = Projection::Pinhole { screen_distance };
                    },
                ));
            }
            Projection::Parallel { width } => {
                all.push(
                    self.of_scene("wrong-projection-width", None, width, |scene, width| {
                        scene.camera.projection = Projection::Parallel { width };
                    }),
                );
            }
        }
        all.push(
            self.of_scene("wrong-gamma", None, scene.film.gamma, |scene, gamma| {
                scene.film.gamma = gamma;
            }),
        );
        for (index, light) in scene.lights.iter().enumerate() {
            let at = Some(light.position);
            all.push(self.of_scene("wrong-brightness", at, 1.0, move |scene, factor| {
                scene.lights[index].color = light.color.map(|part| factor * part);
            }));
            if light.radius > 0.0 {
                all.push(
                    self.of_scene("wrong-light-radius", at, light.radius, move |scene, radius| {
                        scene.lights[index].radius = radius;
                    }),
                );
            }
        }
        all.push(
            self.of_scene("wrong-ambient-light", None, 1.0, move |new, factor| {
                new.ambient = scene.ambient.map(|part| factor * part);
            }),
        );
        for (index, object) in scene.objects.iter().enumerate() {
            if let Model::Glass { ior, .. } = object.material.model {
                all.push(self.of_scene("wrong-ior", None, ior, move |scene, new| {
                    if let Model::Glass { ior, .. } = &mut scene.objects[index].material.model {
                        *ior = new;
                    }
                }));
            }
            if let Shape::Sphere { center, radius } = object.shape
                && scene.objects.len() <= MAX_OBJECTS
            {
                all.push(
                    self.of_scene("wrong-radius", Some(center), radius, move |scene, new| {
                        if let Shape::Sphere { radius, .. } = &mut scene.objects[index].shape {
                            *radius = new;
                        }
                    }),
                );
            }
        }
        all.extend(self.shader.into_iter().flat_map(|shader| self.of_shader(shader)));
        all
    }

    /// A number of the scene, of the object at a point. The documented description has the point, the value,
    /// and for most numbers the scene's value.
    fn of_scene(
        &self,
        id: &'static str,
        at: Option<Point>,
        correct: f64,
        set: impl Fn(&mut Scene, f64) + Sync + 'a,
    ) -> Parameter<'a> {
        let (scene, frame_time) = (self.scene, self.frame_time);
        let documented = DOCUMENTED.iter().find(|documented| documented.id == id);
        let describe = move |value: &str| {
            let values = [value.to_owned(), three_digits(correct)];
            let parts: Vec<String> = at.map(place).into_iter().chain(values).collect();
            documented.map_or_else(String::new, |documented| {
                documented.description(&parts).into_owned()
            })
        };
        let source = move |value| {
            let mut scene = scene.clone();
            set(&mut scene, value);
            scene.release_changed_scatters();
            Some(MutantSource::Scene(Box::new(scene), frame_time))
        };
        Parameter {
            id,
            describe: Box::new(describe),
            values: Values::fitted(Fit::Multiple(correct)),
            correct: Some(correct),
            source: Box::new(source),
            view: self.view,
        }
    }

    /// Numbers that a shader may have but the scene does not.
    fn of_shader(&self, shader: &'a MarkedShader) -> Vec<Parameter<'a>> {
        type Describe = fn(&str) -> String;
        let steps = STEPS.map(|steps| (f64::from(steps), 0)).collect();
        let all: [(_, Describe, _, _, _); 3] = [
            (
                "light-falloff",
                |value| {
                    format!("light decreases as {value} / distance²; lights in the scene have no falloff")
                },
                Slot::LightTerm,
                "… * NUMBER / dot(lights[i].position - hit.point, lights[i].position - hit.point)",
                Values::fitted(Fit::Multiple(10.0)),
            ),
            (
                "constant-mirror-color",
                |value| format!("every mirror multiplies the throughput by {value} instead of its color"),
                Slot::MirrorStatement,
                "throughput *= NUMBER;",
                Values::fitted(Fit::Multiple(0.5)),
            ),
            (
                "too-few-grid-steps",
                |value| format!("the grid traversal stops after {value} cells"),
                Slot::GridSteps,
                "int(NUMBER)",
                Values::Tried {
                    values: steps,
                    fit: None,
                },
            ),
        ];
        let used = all.into_iter().filter(|(_, _, slot, ..)| shader.has(*slot));
        let parameter =
            |(id, describe, slot, template, values): (_, Describe, _, &'static str, _)| Parameter {
                id,
                describe: Box::new(describe),
                values,
                correct: None,
                source: Box::new(move |value| {
                    let template = template.replace("NUMBER", &format!("{value:?}"));
                    shader.replaced(&[(slot, &template)]).map(MutantSource::Shader)
                }),
                view: self.view,
            };
        used.map(parameter).collect()
    }
}

/// Formats a value with three digits.
fn three_digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 9);
    let text = format!("{value:.0$}", digits as usize);
    match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        None => text,
    }
}
