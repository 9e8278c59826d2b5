//! The mistakes that the course has seen, as edits of the shader that paints a scene: a file for each topic.

mod background;
mod camera;
mod disney;
mod figure;
mod film;
mod glass;
mod grid;
mod intersection;
mod light;
mod mirror;
mod motion;
mod normal;
mod path;
mod quadric;
mod shadow;
mod soft_light;

use super::Named;
use super::edit::{Edit, edited};

/// A mistake.
#[derive(Debug)]
pub(super) struct Mistake {
    name: &'static str,
    says: &'static str,
    edits: &'static [Edit],
}

impl Mistake {
    /// The shader with this mistake; none where it cannot be made.
    pub(super) fn made_in(&self, text: &str) -> Option<String> {
        edited(text, self.edits)
    }

    pub(super) fn named(&self) -> Named {
        Named {
            name: self.name,
            says: self.says.into(),
        }
    }
}

/// All of them; of two that paint the same picture, the first is named.
pub(super) fn all() -> impl Iterator<Item = &'static Mistake> {
    let topics: [&[Mistake]; 16] = [
        shadow::MISTAKES,
        intersection::MISTAKES,
        quadric::MISTAKES,
        grid::MISTAKES,
        film::MISTAKES,
        camera::MISTAKES,
        normal::MISTAKES,
        light::MISTAKES,
        soft_light::MISTAKES,
        mirror::MISTAKES,
        glass::MISTAKES,
        path::MISTAKES,
        disney::MISTAKES,
        motion::MISTAKES,
        background::MISTAKES,
        figure::MISTAKES,
    ];
    topics.into_iter().flatten()
}

/// `name: says, [edits];`, where several edits that have nothing to do with each other make one mistake in shaders of different
/// words: `name: says, [edits], [other edits];`
macro_rules! mistakes {
    ($($name:literal: $says:literal, $([$($edit:expr),* $(,)?]),+;)*) => {
        pub(super) static MISTAKES: &[super::Mistake] = &[$($(super::Mistake {
            name: $name,
            says: $says,
            edits: &[$($edit),*],
        }),+),*];
    };
}

use mistakes;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mistake_is_explained() {
        let pages = include_str!("../../../../docs/mistakes.md");
        for mistake in all() {
            let row = format!("| `{}` | {} |", mistake.name, mistake.says);
            assert!(pages.contains(&row), "docs/mistakes.md lacks {row}");
        }
    }
}
