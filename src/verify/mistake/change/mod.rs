//! Mistakes that are made in the scene: something stands elsewhere, is missing, or moves otherwise.

mod camera;
mod figure;
mod film;
mod hierarchy;
mod light;
mod motion;
mod object;

use std::borrow::Cow;

use toyproof_scene::{Moment, Point, Scene};

use super::Named;

/// A scene at a moment, with something changed.
pub(super) struct Change {
    pub(super) named: Named,
    pub(super) scene: Scene,
    pub(super) moment: Moment,
}

/// Gathers changes of one scene.
pub(super) struct Changes<'a> {
    scene: &'a Scene,
    moment: Moment,
    all: Vec<Change>,
}

/// What a picture shows that has lost so much that many mistakes may have led to it; one of these is named, whatever else
/// explains the picture as well.
pub(super) fn general(scene: &Scene, moment: Moment) -> Vec<Change> {
    let mut changes = Changes::new(scene, moment);
    object::none(&mut changes);
    light::none(&mut changes);
    changes.all
}

/// All others; of two that paint the same picture, the first is named.
pub(super) fn all(scene: &Scene, moment: Moment) -> Vec<Change> {
    let mut changes = Changes::new(scene, moment);
    film::changes(&mut changes);
    camera::changes(&mut changes);
    light::changes(&mut changes);
    motion::changes(&mut changes);
    object::changes(&mut changes);
    hierarchy::changes(&mut changes);
    figure::changes(&mut changes);
    changes.all
}

impl<'a> Changes<'a> {
    fn new(scene: &'a Scene, moment: Moment) -> Self {
        Self {
            scene,
            moment,
            all: Vec::new(),
        }
    }

    /// The scene after `edit`, if that changes anything.
    fn add(&mut self, name: &'static str, says: impl Into<Cow<'static, str>>, edit: impl FnOnce(&mut Scene)) {
        let mut scene = self.scene.clone();
        edit(&mut scene);
        scene.release_changed_scatters();
        if scene != *self.scene {
            self.all.push(Change {
                named: Named {
                    name,
                    says: says.into(),
                },
                scene,
                moment: self.moment,
            });
        }
    }

    /// The scene at another moment.
    fn add_moment(&mut self, name: &'static str, says: &'static str, moment: Moment) {
        self.all.push(Change {
            named: Named {
                name,
                says: says.into(),
            },
            scene: self.scene.clone(),
            moment,
        });
    }
}

/// A place, as people write it.
fn place([x, y, z]: Point) -> String {
    format!("({x}, {y}, {z})")
}

/// “first”, “second”, …
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
    use toyproof_eval::{Program, Settings};
    use toyproof_glsl as glsl;
    use toyproof_image::Frame;
    use toyproof_scene as scene;
    use toyproof_scene::export;
    use toyproof_tracer::Tracer;

    use super::*;

    macro_rules! exercises {
        ($($name:literal),* $(,)?) => {
            [$(($name, include_str!(concat!("../../../../glsl/", $name, ".toml")))),*]
        };
    }

    fn scene_of(text: &str) -> Scene {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        scene::parse(&files, file).unwrap()
    }

    /// In how many pixels of a small picture the exported shader is not what the tracer makes of a scene.
    fn differing(scene: &Scene, moment: Moment) -> usize {
        let size = [24, 14];
        let text = export::shader(scene).unwrap_or_else(|why| panic!("{why}"));
        let mut files = Files::default();
        let file = files.add(File::new("exported", text.as_str()));
        let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
        let frame = Frame {
            size,
            frame: moment.frame,
            time: moment.time as f32,
            ..Frame::default()
        };
        let program = Program::new(&checked).unwrap();
        let painted = program
            .paint(&frame, &Settings::<f64>::default())
            .unwrap()
            .painting
            .image();
        let mut scene = scene.clone();
        scene.film.size = size;
        let traced = Tracer::<f64>::at(&scene, moment).picture(|| ());
        let pairs = painted.pixels().iter().zip(traced.pixels());
        let differs = |(a, b): &(&[f32; 4], &[f32; 4])| (0..3).any(|i| (a[i] - b[i]).abs() > 0.01);
        pairs.filter(differs).count()
    }

    #[test]
    fn every_changed_scene_is_whole_and_its_shader_shows_it() {
        let grids = "[[light]]\nposition = [5.0, 5.0, 0.0]\ncolor = [1, 1, 1]\n\
                     [[sphere]]\ncenter = [0.0, 0.0, -9.0]\nradius = 0.5\nmaterial = { model = \"mirror\", color = [1, 1, 1] }\n\
                     [[scatter]]\ncorner = [-2.0, -1.0, -8.0]\ncells = [2, 2, 2]\nspacing = 1.0\nradius = [0.2, 0.4]\nseed = 7\n\
                     material = { model = \"lambert\", color = [1, 1, 1] }\n\
                     [[scatter]]\ncorner = [0.5, -1.0, -7.0]\ncells = [1, 2, 1]\nspacing = 1.0\nradius = [0.2, 0.4]\nseed = 9\n\
                     material = { model = \"lambert\", color = [1, 1, 1] }\n";
        let exercises = exercises![
            "01-sampling",
            "02-sphere",
            "03-shading",
            "04-many-objects",
            "05-complex-scene",
            "06-reflections",
            "07-diffuse",
            "08-disney",
            "09-soft-shadows",
            "10-quadrics",
            "11-animation",
            "12-whitted",
            "13-importance-sampling",
            "14-accelerator",
            "15-parallel-rays",
        ];
        let moment = Moment { frame: 10, time: 1.3 };
        for (name, text) in exercises.into_iter().chain([("two scatters", grids)]) {
            let scene = scene_of(text);
            let own = differing(&scene, moment);
            for change in general(&scene, moment).into_iter().chain(all(&scene, moment)) {
                let Change { named, scene, moment } = change;
                for scattered in &scene.scatters {
                    let objects = &scene.objects[scattered.objects.clone()];
                    assert!(
                        scattered.scatter.spheres().eq(objects.iter().cloned()),
                        "{name}: {}",
                        named.name
                    );
                }
                let differing = differing(&scene, moment);
                // An edge may fall on a pixel's middle.
                assert!(differing <= own + 3, "{name}: {}: {differing} pixels", named.name);
            }
        }
    }
}
