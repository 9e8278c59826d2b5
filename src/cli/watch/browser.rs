//! The job with which the page renders the shader itself, in WebGL 2.

use serde_json::Value;
use toyproof_convert::{Source, browser_text};
use toyproof_glsl::Checked;
use toyproof_gpu::browser::{BrowserPass, BrowserRead, passes_job, uniform_values};
use toyproof_image::Frame;
use toyproof_player::{Source as Read, Target};
use toyproof_project::Rendering;

use crate::cli::shader::Shader;

/// The job of a shader, or of what renders a project.
///
/// # Errors
/// Why WebGL 2 cannot render it, in a sentence.
pub(super) fn browser_job(
    shader: &Shader,
    rendering: Option<&Rendering>,
    frame: &Frame,
) -> Result<Value, String> {
    let text = |checked: &Checked| {
        let source = Source {
            checked,
            files: &shader.files,
        };
        browser_text(source).map_err(|error| error.to_string())
    };
    let (Some(project), Some(rendering)) = (shader.project(), rendering) else {
        let checked = shader
            .image()
            .map_err(|_| "the shader does not compile".to_owned())?;
        return Ok(passes_job(&[BrowserPass {
            text: text(checked)?,
            target: Target::Image,
            mipmaps: false,
            reads: frame.channels.each_ref().map(|channel| {
                channel
                    .as_ref()
                    .map_or(BrowserRead::Nothing, BrowserRead::Texture)
            }),
            sampling: checked.sampling,
            uniforms: uniform_values(checked),
        }]));
    };
    let graph = &rendering.graph;
    let read = |read: Option<Read>| -> Result<BrowserRead<'_>, String> {
        let medium = |number: usize| rendering.media.get(number).map(BrowserRead::Texture);
        Ok(match read {
            None => BrowserRead::Nothing,
            Some(Read::Buffer(number)) => BrowserRead::Buffer(number),
            Some(Read::Medium(number)) => medium(number).unwrap_or(BrowserRead::Nothing),
            Some(Read::Keyboard) => BrowserRead::Keyboard,
            Some(Read::Moving(_)) => {
                return Err("it reads a texture that changes from frame to frame".to_owned());
            }
        })
    };
    let mut passes = Vec::new();
    for (pass, checked) in graph.passes().iter().zip(project.checked_of(rendering)) {
        let size = frame.size;
        if graph.size(pass.target, size) != size {
            return Err(format!("{} has another size than the image", pass.target));
        }
        let [a, b, c, d] = pass.inputs.map(read);
        passes.push(BrowserPass {
            text: text(checked)?,
            target: pass.target,
            mipmaps: matches!(pass.target, Target::Buffer(buffer) if graph.has_mipmaps(buffer)),
            reads: [a?, b?, c?, d?],
            sampling: checked.sampling,
            uniforms: uniform_values(checked),
        });
    }
    Ok(passes_job(&passes))
}
