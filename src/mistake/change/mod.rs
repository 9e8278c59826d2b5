//! Mistakes that are made in the scene: something stands elsewhere, is missing, or moves otherwise.

mod camera;
mod figure;
mod film;
mod hierarchy;
mod light;
mod motion;
mod object;

use std::borrow::Cow;

use super::Named;
use crate::scene::{Moment, Point, Scene};

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
