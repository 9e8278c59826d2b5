//! Mistakes in the scene: an object is misplaced, missing, or moves differently.

mod hierarchy;
mod image;
mod motion;
mod objects;

use std::borrow::Cow;

use toyproof_scene::{FrameTime, Point, Scene};

use super::KnownMistake;
use super::documented::Documented;

/// A scene at a time, with one change.
pub(super) struct Change {
    pub(super) mistake: KnownMistake,
    pub(super) scene: Scene,
    pub(super) frame_time: FrameTime,
}

/// Collects the changes of one scene.
pub(super) struct Changes<'a> {
    scene: &'a Scene,
    frame_time: FrameTime,
    all: Vec<Change>,
}

/// Returns the changes that lose most of the image, so that many mistakes may be the cause; one of these is
/// reported even if others explain the image as well.
pub(super) fn general(scene: &Scene, frame_time: FrameTime) -> Vec<Change> {
    let mut changes = Changes::new(scene, frame_time);
    objects::no_objects(&mut changes);
    objects::no_lights(&mut changes);
    changes.all
}

/// Returns all other changes; of two that render the same image, the first is reported.
pub(super) fn all(scene: &Scene, frame_time: FrameTime) -> Vec<Change> {
    let mut changes = Changes::new(scene, frame_time);
    image::film(&mut changes);
    image::camera(&mut changes);
    objects::lights(&mut changes);
    motion::motions(&mut changes);
    objects::objects(&mut changes);
    objects::boxes(&mut changes);
    hierarchy::hierarchy(&mut changes);
    image::figures(&mut changes);
    changes.all
}

/// What the guide says about the changes.
pub(super) fn documented() -> impl Iterator<Item = Documented> {
    let all = [
        image::DOCUMENTED,
        motion::DOCUMENTED,
        hierarchy::DOCUMENTED,
        objects::DOCUMENTED,
    ];
    all.into_iter().flatten().copied()
}

impl<'a> Changes<'a> {
    fn new(scene: &'a Scene, frame_time: FrameTime) -> Self {
        Self {
            scene,
            frame_time,
            all: Vec::new(),
        }
    }

    /// Adds the scene after `edit`, if that changes anything. The description is the documented one, with
    /// these texts in place of its ellipses.
    fn add(&mut self, id: &'static str, parts: &[String], edit: impl FnOnce(&mut Scene)) {
        self.add_mistake(described(id, parts), edit);
    }

    /// Adds a mistake of the catalogue that a change of the scene causes, with a description of its own.
    fn add_as(&mut self, id: &'static str, description: String, edit: impl FnOnce(&mut Scene)) {
        self.add_mistake(KnownMistake::new(id, description), edit);
    }

    /// Adds the scene after `edit`, with a symptom of many mistakes.
    fn add_symptom(&mut self, id: &'static str, edit: impl FnOnce(&mut Scene)) {
        self.add_mistake(
            KnownMistake {
                is_symptom: true,
                ..described(id, &[])
            },
            edit,
        );
    }

    fn add_mistake(&mut self, mistake: KnownMistake, edit: impl FnOnce(&mut Scene)) {
        let mut scene = self.scene.clone();
        edit(&mut scene);
        scene.release_changed_scatters();
        if scene != *self.scene {
            self.all.push(Change {
                mistake,
                scene,
                frame_time: self.frame_time,
            });
        }
    }

    /// Adds the scene at another time.
    fn add_at_time(&mut self, id: &'static str, frame_time: FrameTime) {
        self.all.push(Change {
            mistake: described(id, &[]),
            scene: self.scene.clone(),
            frame_time,
        });
    }
}

/// A documented mistake, with texts in place of its ellipses.
fn described(id: &'static str, parts: &[String]) -> KnownMistake {
    let form = documented().find(|documented| documented.id == id);
    KnownMistake::new(id, form.map_or_else(Cow::default, |form| form.description(parts)))
}

/// Formats a point.
pub(super) fn place([x, y, z]: Point) -> String {
    format!("({x}, {y}, {z})")
}

/// Formats an index as an ordinal number: “first”, “second”, …
fn ordinal(index: usize) -> String {
    match index {
        0 => "first".to_owned(),
        1 => "second".to_owned(),
        2 => "third".to_owned(),
        _ => format!("{}th", index + 1),
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_eval::Settings;
    use toyproof_eval_native::Program;
    use toyproof_glsl as glsl;
    use toyproof_image::Frame;
    use toyproof_scene::export;
    use toyproof_tracer::Tracer;

    use super::*;
    use crate::known::exercises::{EXERCISES, TURNED, scene_of};

    /// The number of pixels of a small image in which the exported shader differs from the tracer.
    fn differing(scene: &Scene, frame_time: FrameTime) -> usize {
        let size = [24, 14];
        let text = export::shader(scene).unwrap_or_else(|why| panic!("{why}"));
        let mut files = Files::default();
        let file = files.add(File::new("exported", text.as_str()));
        let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
        let frame = Frame {
            size,
            frame: frame_time.frame,
            time: frame_time.time as f32,
            ..Frame::default()
        };
        let program = Program::new(&checked).unwrap();
        let rendered = program
            .render(&frame, &Settings::<f64>::default())
            .unwrap()
            .framebuffer
            .image();
        let mut scene = scene.clone();
        scene.film.size = size;
        let traced = Tracer::<f64>::at(&scene, frame_time).render(|| ());
        let pairs = rendered.pixels().iter().zip(traced.pixels());
        let differs = |(a, b): &(&[f32; 4], &[f32; 4])| (0..3).any(|i| (a[i] - b[i]).abs() > 0.01);
        pairs.filter(differs).count()
    }

    #[test]
    fn every_changed_scene_is_consistent_with_its_exported_shader() {
        let grids = "[[light]]\nposition = [5.0, 5.0, 0.0]\ncolor = [1, 1, 1]\n\
                     [[sphere]]\ncenter = [0.0, 0.0, -9.0]\nradius = 0.5\nmaterial = { model = \"mirror\", color = [1, 1, 1] }\n\
                     [[scatter]]\ncorner = [-2.0, -1.0, -8.0]\ncells = [2, 2, 2]\nspacing = 1.0\nradius = [0.2, 0.4]\nseed = 7\n\
                     material = { model = \"lambert\", color = [1, 1, 1] }\n\
                     [[scatter]]\ncorner = [0.5, -1.0, -7.0]\ncells = [1, 2, 1]\nspacing = 1.0\nradius = [0.2, 0.4]\nseed = 9\n\
                     material = { model = \"lambert\", color = [1, 1, 1] }\n";
        let frame_time = FrameTime { frame: 10, time: 1.3 };
        for (name, text) in EXERCISES
            .into_iter()
            .chain([("two scatters", grids), ("turned", TURNED)])
        {
            let scene = scene_of(text);
            let own = differing(&scene, frame_time);
            for change in general(&scene, frame_time)
                .into_iter()
                .chain(all(&scene, frame_time))
            {
                let Change {
                    mistake,
                    scene,
                    frame_time,
                } = change;
                for scattered in &scene.scatters {
                    let objects = &scene.objects[scattered.objects.clone()];
                    assert!(
                        scattered.scatter.spheres().eq(objects.iter().cloned()),
                        "{name}: {}",
                        mistake.id
                    );
                }
                let differing = differing(&scene, frame_time);
                // An edge may pass through a pixel's center.
                assert!(differing <= own + 3, "{name}: {}: {differing} pixels", mistake.id);
            }
        }
    }
}
