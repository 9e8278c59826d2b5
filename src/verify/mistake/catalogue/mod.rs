//! The catalogue of mistakes that occurred in the course, as edits of the shader that renders a scene, by
//! topic.

mod geometry;
mod image;
mod shading;
mod transport;

use super::Named;
use crate::mistake::mutant::{Edit, edited};

/// A mistake of the catalogue.
#[derive(Debug)]
pub(super) struct Mistake {
    name: &'static str,
    says: &'static str,
    edits: &'static [Edit],
}

impl Mistake {
    /// Returns the shader with this mistake; none where its edits do not apply.
    pub(super) fn apply(&self, text: &str) -> Option<String> {
        edited(text, self.edits)
    }

    pub(super) fn named(&self) -> Named {
        Named {
            name: self.name,
            says: self.says.into(),
        }
    }
}

/// Returns all mistakes; of two that render the same image, the first is named.
pub(super) fn all() -> impl Iterator<Item = &'static Mistake> {
    let topics: [&[Mistake]; 16] = [
        shading::SHADOWS,
        geometry::INTERSECTIONS,
        geometry::QUADRICS,
        geometry::GRIDS,
        image::FILM,
        image::CAMERA,
        geometry::NORMALS,
        shading::LIGHTS,
        shading::SOFT_LIGHTS,
        transport::MIRRORS,
        transport::GLASS,
        transport::PATHS,
        shading::DISNEY,
        geometry::MOTIONS,
        image::BACKGROUND,
        image::FIGURES,
    ];
    topics.into_iter().flatten()
}

/// `name: says, [edits];`. A mistake that needs different edits in differently written shaders has several
/// alternatives: `name: says, [edits], [other edits];`
macro_rules! mistakes {
    ($($name:literal: $says:literal, $([$($edit:expr),* $(,)?]),+;)*) => {
        &[$($($crate::mistake::catalogue::Mistake {
            name: $name,
            says: $says,
            edits: &[$($edit),*],
        }),+),*]
    };
}

use mistakes;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mistake_is_documented() {
        let pages = include_str!("../../../../docs/mistakes.md");
        for mistake in all() {
            let row = format!("| `{}` | {} |", mistake.name, mistake.says);
            assert!(pages.contains(&row), "docs/mistakes.md lacks {row}");
        }
    }
}
