//! The catalogue of mistakes that occurred in the course, as replacements of parts of the shader that renders
//! a scene, by topic.

mod geometry;
mod image;
mod shading;
mod transport;

use toyproof_scene::export::{MarkedShader, Slot};

use super::Named;

/// A mistake of the catalogue.
#[derive(Debug)]
pub(super) struct Mistake {
    name: &'static str,
    says: &'static str,
    /// The parts of the shader that differ, each with the template of what replaces it.
    edits: &'static [(Slot, &'static str)],
}

impl Mistake {
    /// Returns the shader with this mistake; none if it lacks one of the parts, or has several of that name.
    pub(super) fn apply(&self, shader: &MarkedShader) -> Option<MarkedShader> {
        shader.replaced(self.edits)
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

/// `name: says, [Part = template, OtherPart = template];`. A mistake that can be made in several ways, or that
/// concerns different parts of different shaders, has alternatives: `name: says, [edits], [other edits];`
macro_rules! mistakes {
    ($($name:literal: $says:literal, $([$($slot:ident = $template:expr),* $(,)?]),+;)*) => {
        &[$($($crate::mistake::catalogue::Mistake {
            name: $name,
            says: $says,
            edits: &[$((toyproof_scene::export::Slot::$slot, $template)),*],
        }),+),*]
    };
}

use mistakes;

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl as glsl;
    use toyproof_scene::{Scene, export};

    use super::*;
    use crate::mistake::exercises::{EXERCISES, scene_of};
    use crate::mistake::mutant::variants;

    /// Scenes with what no exercise has.
    const OTHER_SCENES: [&str; 3] = [NESTED_MOTIONS, BOTH_GLASSES, DIFFUSE_PATHS];

    const NESTED_MOTIONS: &str = r#"
        motion = [
            { name = "a", axis = [0, 1, 0], seconds = 2 },
            { name = "b", axis = [0, 1, 0], seconds = 2, within = "a" },
            { name = "c", axis = [0, 1, 0], seconds = 2, within = "b" },
            { name = "d", axis = [0, 1, 0], seconds = 2, within = "c" },
        ]
        sphere = [
            { center = [0, 0, -6], radius = 1, motion = "d", material = { model = "facing", color = [1, 1, 0] } },
        ]
    "#;

    const BOTH_GLASSES: &str = r#"
        sphere = [
            { center = [-2, 0, -6], radius = 1, material = { model = "glass", color = [1, 1, 0], ior = 1.5 } },
            { center = [2, 0, -6], radius = 1, material = { model = "glass", color = [1, 1, 0], ior = 1.5, fresnel = "schlick" } },
        ]
    "#;

    const DIFFUSE_PATHS: &str = r#"
        film = { integrator = "path", max_depth = 3, samples = 2, sampler = "independent" }
        sphere = [
            { center = [0, 4, -6], radius = 1, material = { model = "emitter", color = [9, 9, 9] } },
            { center = [0, 0, -6], radius = 1, material = { model = "diffuse", color = [1, 1, 0] } },
        ]
    "#;

    fn scenes() -> impl Iterator<Item = Scene> {
        let exercises = EXERCISES.into_iter().map(|(_, text)| text);
        exercises.chain(OTHER_SCENES).map(scene_of)
    }

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

    #[test]
    fn every_mistake_is_documented() {
        let pages = include_str!("../../../../docs/guide/mistakes.md");
        for mistake in all() {
            let row = format!("| `{}` | {} |", mistake.name, mistake.says);
            assert!(pages.contains(&row), "docs/guide/mistakes.md lacks {row}");
        }
    }
}
