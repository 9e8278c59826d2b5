//! An assignment to begin with.

use std::fmt::Write as _;

use toyproof_glsl::tree::{ExprKind, Input, VariableKind};
use toyproof_image::FrameInputs;

use super::sample::sample;
use crate::function_test::Subject;

/// The size of the frames of an assignment whose reference is a shader, in pixels.
const SIZE: [u32; 2] = [320, 180];

/// The time of the frame that shows motion, in seconds: chosen so that common animations are not back at
/// their start.
const TIME: f32 = 2.3;

/// The example of a test if the model solution has no suitable function: it tests a function of exported
/// scenes.
const SAMPLE: &str = "# [[function]]
# name = \"intersectSphere\"
# points = 2
#
# [[function.case]]
# arguments = [[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, -6.0], 1.5]
# result = 4.5
";

/// The source of a new assignment.
#[derive(Debug, Clone, Copy)]
pub enum Model<'a> {
    /// A model solution.
    Shader(&'a Subject<'a>),
    /// A scene.
    Scene {
        /// Whether something in it moves.
        is_animated: bool,
    },
}

impl Model<'_> {
    /// The frames in which shaders should be compared with the model: the first frame, one at
    /// another time if the image may depend on time, and one with the mouse if it may depend on the mouse.
    #[must_use]
    pub fn frames(&self) -> Vec<FrameInputs> {
        let size = match self {
            Self::Shader(_) => Some(SIZE),
            Self::Scene { .. } => None,
        };
        let still = FrameInputs {
            size,
            ..FrameInputs::default()
        };
        let mut frames = vec![still.clone()];
        if self.is_animated() {
            frames.push(FrameInputs {
                time: TIME,
                frame: (TIME * toyproof_image::FRAME_RATE) as i32,
                ..still.clone()
            });
        }
        if self.reads(Input::Mouse) {
            // A click and a drag that differ in both coordinates.
            let [width, height] = SIZE.map(|side| side as f32);
            let mouse = [0.25 * width, 0.6 * height, 0.5 * width, 0.5 * height];
            frames.push(FrameInputs { mouse, ..still });
        }
        frames
    }

    fn is_animated(&self) -> bool {
        match self {
            Self::Shader(_) => self.reads(Input::Time) || self.reads(Input::Frame),
            Self::Scene { is_animated } => *is_animated,
        }
    }

    fn reads(&self, input: Input) -> bool {
        let Self::Shader(subject) = self else {
            return false;
        };
        let tree = &subject.checked.tree;
        tree.exprs.iter().any(|(_, expr)| match expr.kind {
            ExprKind::Variable(variable) => tree[variable].kind == VariableKind::Input(input),
            _ => false,
        })
    }

    /// The functions that the model solution defines, apart from `mainImage`.
    fn functions(&self) -> Vec<&str> {
        let Self::Shader(subject) = self else {
            return Vec::new();
        };
        let functions = subject
            .checked
            .tree
            .functions
            .iter()
            .map(|(_, function)| function);
        let defined = functions.filter(|function| function.body.is_some() && function.name != "mainImage");
        let mut names: Vec<_> = defined.map(|function| function.name.as_str()).collect();
        // Overloads need not follow each other.
        names.sort_unstable();
        names.dedup();
        names
    }

    /// A test of one of the model solution's functions, as comments.
    fn sample(&self) -> Option<String> {
        match self {
            Self::Shader(subject) => sample(subject),
            Self::Scene { .. } => None,
        }
    }

    /// The text of an assignment for this model, whose file is named, with comments on all keys.
    #[must_use]
    pub fn assignment(&self, file: &str) -> String {
        let (reference, tolerance) = match self {
            Self::Shader(_) => (
                format!("reference = \"{file}\""),
                "# tolerance = 0.5                # the largest difference of a color, in 8-bit levels\n",
            ),
            Self::Scene { .. } => (format!("scene = \"{file}\""), ""),
        };
        let frames: String = self.frames().iter().map(frame).collect();
        let functions = self.functions();
        let quoted: Vec<_> = functions.iter().map(|name| format!("\"{name}\"")).collect();
        let names = if quoted.is_empty() {
            "\"intersectSphere\"".to_owned()
        } else {
            quoted.join(", ")
        };
        // The name of the file, which may be any text, is inserted last. The other texts are lists of numbers
        // and identifiers, so none of them contains a placeholder.
        include_str!("template.toml")
            .replace("{frames}\n", &frames)
            .replace("{functions}", &names)
            .replace(
                "{function}\n",
                &self.sample().unwrap_or_else(|| SAMPLE.to_owned()),
            )
            .replace("{reference}\n", &format!("{reference}\n{tolerance}"))
    }
}

/// The table of a frame.
fn frame(inputs: &FrameInputs) -> String {
    let mut text = String::from("\n[[frame]]\n");
    if let Some([width, height]) = inputs.size {
        let _ = writeln!(text, "size = [{width}, {height}]");
    }
    if inputs.time != 0.0 {
        let _ = writeln!(text, "time = {:?}\nframe = {}", inputs.time, inputs.frame);
    }
    if inputs.mouse != [0.0; 4] {
        let [x, y, z, w] = inputs.mouse;
        let _ = writeln!(text, "mouse = [{x:?}, {y:?}, {z:?}, {w:?}]");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_may_be_named_like_a_placeholder() {
        let text = Model::Scene { is_animated: false }.assignment("{functions}.toml");
        assert!(text.contains("scene = \"{functions}.toml\"\n"), "{text}");
        assert!(text.contains("[\"intersectSphere\"]"), "{text}");
    }
}
