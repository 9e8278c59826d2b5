//! Shaders that render another scene than the requested one, or ShaderToy's default shader.

use toyproof_image::{Frame, Image};
use toyproof_verify::Expected;

use super::submission::{Submission, View};
use super::{Alternative, OtherScenes};
use crate::known::KnownMistake;
use crate::known::documented::{Documented, documented};

/// What the guide says about these mistakes.
pub(crate) const DOCUMENTED: &[Documented] = documented! {
    /// Submit the shader of this assignment, or check it with the other scene.
    WholeImage "wrong-scene": "the image agrees with another scene, …";
    /// Paste your own shader, and save it before it is exported.
    WholeImage "default-shader": "this is the shader that ShaderToy's editor starts with";
};

/// Finds the scene that a shader renders instead of its own.
pub(super) fn find(submission: &Submission, scenes: &OtherScenes) -> Option<Alternative> {
    default_shader(submission).or_else(|| other_scene(submission, scenes))
}

const OTHER_SCENE: &str = "wrong-scene";
const DEFAULT_SHADER: &str = "default-shader";

/// Compares the image with those of other scenes, first at a few pixels.
fn other_scene(submission: &Submission, scenes: &OtherScenes) -> Option<Alternative> {
    let frame = submission.frame();
    let same = View::with_inputs(frame.clone());
    let actual = same.image(submission, &submission.probes)?;
    scenes.iter().find_map(|(name, scene)| {
        if submission
            .expected()
            .scene()
            .is_some_and(|own| own.objects == scene.objects && own.lights == scene.lights)
        {
            return None;
        }
        let expected = Expected::from_scene(scene.clone(), frame);
        let probed = expected.colors_in(frame, &submission.probes)?;
        if !submission.agree(&submission.probes, &probed, &actual) {
            return None;
        }
        let text = format!("the image agrees with another scene, {name}");
        submission.confirmed(&same, (&expected, frame), KnownMistake::new(OTHER_SCENE, text))
    })
}

/// How much later the second frame is in which the default shader is recognized, in seconds.
const LATER: f32 = 1.7;

/// Recognizes the shader that ShaderToy's editor starts with, in two frames.
fn default_shader(submission: &Submission) -> Option<Alternative> {
    let frame = submission.frame();
    let later = Frame {
        time: frame.time + LATER,
        ..frame.clone()
    };
    let is_default = [frame, &later].into_iter().all(|frame| {
        let image = View::with_inputs(frame.clone()).image(submission, &submission.probes);
        image.is_some_and(|image| {
            submission.agree(&submission.probes, &default_image(submission, frame.time), &image)
        })
    });
    is_default.then(|| Alternative {
        mistake: KnownMistake::new(DEFAULT_SHADER, DEFAULT_SHADER_TEXT),
        algorithm: submission.confirmer.before.summary.clone(),
    })
}

const DEFAULT_SHADER_TEXT: &str = "this is the shader that ShaderToy's editor starts with";

/// The colors of the default shader at the probes: `0.5 + 0.5 * cos(iTime + uv.xyx + vec3(0, 2, 4))`.
fn default_image(submission: &Submission, time: f32) -> Image {
    let [width, height] = submission.size();
    let [columns, rows] = submission.probes.size();
    let pixels = submission.probes.rows.iter().flat_map(|&y| {
        submission.probes.columns.iter().map(move |&x| {
            let uv = [x / width, y / height, x / width];
            let [r, g, b] = [0, 1, 2].map(|i| {
                let angle = f64::from(time) + uv[i] + 2.0 * i as f64;
                (0.5 + 0.5 * angle.cos()) as f32
            });
            [r, g, b, 1.0]
        })
    });
    Image::new(columns, rows, pixels.collect())
}

/// The descriptions of the recognized differences, as examples.
#[cfg(test)]
pub(super) fn examples() -> Vec<KnownMistake> {
    vec![
        KnownMistake::new(OTHER_SCENE, "the image agrees with another scene, 03-shading"),
        KnownMistake::new(DEFAULT_SHADER, DEFAULT_SHADER_TEXT),
    ]
}
