//! The catalogue of mistakes that occurred in the course, as replacements of parts of the shader that renders
//! a scene, by topic.

mod geometry;
mod image;
mod shading;
mod transport;

use toyproof_scene::export::{MarkedShader, Slot};

use super::KnownMistake;
use super::documented::{Documented, Topic};

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

/// The mistakes of one topic.
#[derive(Debug)]
pub(super) struct Group {
    mistakes: &'static [Mistake],
    /// The id, the description and the fix of each.
    documented: &'static [[&'static str; 3]],
}

/// The groups in the order of their tests; of two mistakes that render the same image, the first is reported.
static GROUPS: [(Topic, &Group); 17] = [
    (Topic::Shadows, &shading::SHADOWS),
    (Topic::Intersection, &geometry::INTERSECTIONS),
    (Topic::Quadrics, &geometry::QUADRICS),
    (Topic::Boxes, &geometry::BOXES),
    (Topic::Grids, &geometry::GRIDS),
    (Topic::Film, &image::FILM),
    (Topic::Camera, &image::CAMERA),
    (Topic::Normals, &geometry::NORMALS),
    (Topic::Shading, &shading::LIGHTS),
    (Topic::SoftShadows, &shading::SOFT_LIGHTS),
    (Topic::Mirrors, &transport::MIRRORS),
    (Topic::Glass, &transport::GLASS),
    (Topic::Paths, &transport::PATHS),
    (Topic::Disney, &shading::DISNEY),
    (Topic::Motion, &geometry::MOTIONS),
    (Topic::Background, &image::BACKGROUND),
    (Topic::Figures, &image::FIGURES),
];

/// Returns all mistakes.
pub(super) fn all() -> impl Iterator<Item = &'static Mistake> {
    GROUPS.iter().flat_map(|(_, group)| group.mistakes)
}

/// What the guide says about them.
pub(super) fn documented() -> impl Iterator<Item = Documented> {
    GROUPS.iter().flat_map(|(topic, group)| {
        let documented = group.documented.iter().filter(|[.., fix]| !fix.is_empty());
        documented.map(|&[id, form, fix]| Documented {
            topic: *topic,
            id,
            form,
            fix,
        })
    })
}

/// `id: description, [Part = template, OtherPart = template];` after a comment with the fix, unless the
/// mistake is documented elsewhere. A mistake that can be made in several ways, or that concerns different
/// parts of different shaders, has alternatives: `id: description, [edits], [other edits];`
macro_rules! mistakes {
    ($(
        $(#[doc = $fix:literal])*
        $id:literal: $description:literal, $([$($slot:ident = $template:expr),* $(,)?]),+;
    )*) => {
        $crate::known::catalogue::Group {
            mistakes: &[$($($crate::known::catalogue::Mistake {
                id: $id,
                description: $description,
                edits: &[$((toyproof_scene::export::Slot::$slot, $template)),*],
            }),+),*],
            documented: &[$([$id, $description, concat!($($fix),*)]),*],
        }
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
