//! The catalogue of mistakes that occurred in the course, as replacements of parts of the shader that renders
//! a scene, by topic.

mod geometry;
mod image;
mod shading;
mod transport;

use toyproof_scene::export::{MarkedShader, Slot};

use super::KnownMistake;

/// A mistake of the catalogue.
#[derive(Debug)]
pub(super) struct Mistake {
    id: &'static str,
    description: &'static str,
    /// The parts of the shader that differ, each with the template of what replaces it.
    edits: &'static [(Slot, &'static str)],
}

impl Mistake {
    /// Returns the shader with this mistake; `None` if it lacks one of the parts, or has several of that
    /// name.
    pub(super) fn apply(&self, shader: &MarkedShader) -> Option<MarkedShader> {
        shader.replaced(self.edits)
    }

    pub(super) fn known(&self) -> KnownMistake {
        KnownMistake::new(self.id, self.description)
    }
}

/// Returns all mistakes; of two that render the same image, the first is reported.
pub(super) fn all() -> impl Iterator<Item = &'static Mistake> {
    let topics: [&[Mistake]; 17] = [
        shading::SHADOWS,
        geometry::INTERSECTIONS,
        geometry::QUADRICS,
        geometry::BOXES,
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

/// `id: description, [Part = template, OtherPart = template];`. A mistake that can be made in several ways, or
/// that concerns different parts of different shaders, has alternatives: `id: description, [edits], [other
/// edits];`
macro_rules! mistakes {
    ($($id:literal: $description:literal, $([$($slot:ident = $template:expr),* $(,)?]),+;)*) => {
        &[$($($crate::known::catalogue::Mistake {
            id: $id,
            description: $description,
            edits: &[$((toyproof_scene::export::Slot::$slot, $template)),*],
        }),+),*]
    };
}

use mistakes;

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl as glsl;
    use toyproof_scene::export;

    use super::*;
    use crate::known::exercises::scenes;
    use crate::known::mutant::variants;

    fn is_valid(shader: &MarkedShader) -> bool {
        let mut files = Files::default();
        let file = files.add(File::new("shader", shader.text.as_str()));
        glsl::check(&files, file, &glsl::Options::default()).is_ok()
    }

    #[test]
    fn every_mistake_can_be_made_in_a_shader() {
        let shaders: Vec<MarkedShader> = scenes().flat_map(|scene| variants(&scene)).collect();
        for mistake in all() {
            let mut mutants = shaders.iter().filter_map(|shader| mistake.apply(shader));
            assert!(mutants.any(|mutant| is_valid(&mutant)), "{mistake:?}");
        }
    }

    #[test]
    fn every_name_of_a_part_stands_for_one() {
        let shaders: Vec<MarkedShader> = scenes()
            .map(|scene| export::marked_shader(&scene).unwrap())
            .collect();
        for &slot in Slot::ALL {
            assert!(shaders.iter().any(|shader| shader.has(slot)), "{slot:?}");
        }
    }
}
