//! The passes of an ISF header: their buffers, the sizes of these, and the textures that each pass reads.

use toyproof_diagnostic::{Diagnostic, Files, Span};
use toyproof_glsl::Options;
use toyproof_player::{BufferFormat, BufferSize, IMAGE_BUFFERS, SizeExpr, Step};

use super::declarations::{Declarations, components, is_name};
use super::pass_index::Tokens;
use super::size;
use crate::node::{Node, Value};

/// The number of textures that a pass can read.
const CHANNELS: usize = 4;

/// A pass that renders a buffer, or the image.
pub(super) struct IsfPass {
    /// The name of the buffer; `None` for the image.
    pub(super) target: Option<String>,
    /// How the textures of the buffer are made.
    pub(super) format: BufferFormat,
    /// Whether the buffer keeps its content from frame to frame.
    persists: bool,
    /// The channels of the pass, by the names of the images and buffers that they read.
    pub(super) channels: Vec<String>,
}

/// The sizes of passes, which may depend on the values of inputs.
pub(super) struct Sizes<'a> {
    pub(super) files: &'a Files,
    pub(super) declared: &'a Declarations,
    pub(super) options: &'a Options,
}

impl Sizes<'_> {
    /// The size of a pass; `old` is the declaration of its buffer in version 1.
    fn of_pass(&self, pass: &Node, old: Option<&Node>) -> Result<BufferSize, Diagnostic> {
        let side = |key, whole| match pass.get(key).or_else(|| old?.get(key)) {
            None => Ok(SizeExpr::new(vec![whole])),
            Some(node) => self.side(node).map(Some),
        };
        let [width, height] = [side("WIDTH", Step::Width)?, side("HEIGHT", Step::Height)?];
        let Some(sides) = width.zip(height).map(<[SizeExpr; 2]>::from) else {
            return Ok(BufferSize::Image);
        };
        let image = [Step::Width, Step::Height].map(|step| SizeExpr::new(vec![step]));
        Ok(
            if sides.each_ref().map(Some) == image.each_ref().map(Option::as_ref) {
                BufferSize::Image
            } else {
                BufferSize::Computed(Box::new(sides))
            },
        )
    }

    /// A number, or an expression.
    fn side(&self, node: &Node) -> Result<SizeExpr, Diagnostic> {
        let (Value::Number(text) | Value::String(text)) = &node.value else {
            return Err(node.error("a size must be a number, or an expression in a string"));
        };
        size::parse(text, |name| self.value(name)).map_err(|error| {
            let whole = node.error(error.message);
            // Columns are those of the text if it has no escapes.
            let span = node
                .span
                .filter(|span| self.files.text(*span) == format!("\"{text}\""));
            match span {
                Some(Span { file, start, .. }) => {
                    let [from, to] = [error.at.start, error.at.end].map(|at| start + 1 + at as u32);
                    whole.at(Span::new(file, from, to))
                }
                None => whole,
            }
        })
    }

    /// The value of an input that is a number.
    fn value(&self, name: &str) -> Option<f64> {
        let is_input = self.declared.uniforms.iter().any(|uniform| uniform.name == name);
        let mut values = self.options.uniforms.iter();
        let given = values.find(|uniform| is_input && uniform.name == name)?;
        match given.components[..] {
            [value] => Some(value),
            _ => None,
        }
    }
}

/// Whether a value is true; older headers have numbers.
fn is_true(node: &Node) -> bool {
    components(node).is_some_and(|components| components.iter().any(|component| *component != 0.0))
}

/// Reads the passes of a header: none if the shader has one that renders the image.
///
/// # Errors
/// A pass that cannot be rendered.
pub(super) fn passes(root: &Node, sizes: &Sizes) -> Result<Vec<IsfPass>, Diagnostic> {
    let nodes = root.get("PASSES").and_then(Node::as_array).unwrap_or_default();
    // Version 1 lists the buffers that persist: their names, or the names with their sizes.
    let old_buffers = root.get("PERSISTENT_BUFFERS");
    let persists = |pass: &Node, target: Option<&str>| {
        let names = old_buffers.and_then(Node::as_array).unwrap_or_default();
        let is_old = target.is_some_and(|target| {
            let is_named = names.iter().any(|name| name.as_str() == Some(target));
            is_named || old_buffers.is_some_and(|buffers| buffers.get(target).is_some())
        });
        is_old || pass.get("PERSISTENT").is_some_and(is_true)
    };
    let mut passes: Vec<IsfPass> = Vec::new();
    for (index, node) in nodes.iter().enumerate() {
        let target = node.get("TARGET").and_then(Node::as_str);
        let old = target.and_then(|target| old_buffers?.get(target));
        let size = sizes.of_pass(node, old)?;
        if target.is_none() && index + 1 < nodes.len() {
            return Err(node.error("only the last pass may be without a `TARGET`"));
        }
        if target.is_none() && size != BufferSize::Image {
            let error = node.error("a pass without a `TARGET` has the size of the image");
            return Err(error.help("leave out WIDTH and HEIGHT, or add a TARGET"));
        }
        if target.is_some_and(|target| !is_name(target)) {
            return Err(node.error("a `TARGET` must be a name in GLSL"));
        }
        let persists = persists(node, target);
        let target = target.map(str::to_owned);
        if target.is_some() && passes.iter().any(|pass| pass.target == target) {
            return Err(node.error("a second pass with the same `TARGET` is not supported"));
        }
        passes.push(IsfPass {
            target,
            format: BufferFormat {
                size,
                ..BufferFormat::default()
            },
            persists,
            channels: Vec::new(),
        });
        if passes.iter().filter(|pass| pass.target.is_some()).count() > IMAGE_BUFFERS {
            let error = format!("more than {IMAGE_BUFFERS} passes with a `TARGET` are not supported");
            return Err(node.error(error));
        }
    }
    let is_single = passes.iter().all(|pass| pass.target.is_none());
    Ok(if is_single { Vec::new() } else { passes })
}

/// Sets the channels of all passes, and which buffers are cleared. `images` and `targets` are those that the
/// text names.
///
/// # Errors
/// A pass reads more than four of them.
pub(super) fn set_channels(
    passes: &mut [IsfPass],
    root: &Node,
    tokens: &Tokens,
    (images, targets): (&[String], &[String]),
) -> Result<(), Diagnostic> {
    let names = (0..).map(|index| tokens.live_names(index));
    let names: Vec<_> = names.take(passes.len()).collect();
    for (index, (pass, live)) in passes.iter_mut().zip(&names).enumerate() {
        // That a buffer was cleared is visible to passes that read it before it is rendered, and where its own
        // pass discards pixels.
        let reads = |target: &String| {
            let mut before = names[..=index].iter();
            live.contains("discard") || before.any(|names| names.contains(target.as_str()))
        };
        pass.format.is_cleared = !pass.persists && pass.target.as_ref().is_some_and(reads);
        let channels = channels(images, targets, |name| live.contains(name));
        pass.channels = channels.ok_or_else(|| {
            let nodes = root.get("PASSES").and_then(Node::as_array).unwrap_or_default();
            let node = nodes.get(index).unwrap_or(root);
            let error = node.error(format!(
                "this pass reads more than {CHANNELS} images and buffers, or an image after the {CHANNELS}th"
            ));
            error.help("what it does not read must be in branches of `if (PASSINDEX == …)`")
        })?;
    }
    Ok(())
}

/// The channels of a pass by the names of what they read: all images, and all targets, if they are at most
/// four. Otherwise those that the pass reads, where an image keeps its channel; `None` if they are too many, or
/// an image has no channel.
fn channels(images: &[String], targets: &[String], is_read: impl Fn(&str) -> bool) -> Option<Vec<String>> {
    let (first, others) = images.split_at(images.len().min(CHANNELS));
    let mut channels = first.to_vec();
    if images.len() + targets.len() <= CHANNELS {
        channels.extend_from_slice(targets);
        return Some(channels);
    }
    if others.iter().any(|name| is_read(name)) {
        return None;
    }
    for name in targets.iter().filter(|name| is_read(name)) {
        if channels.len() < CHANNELS {
            channels.push(name.clone());
        } else {
            let unread = channels.iter().rposition(|name| !is_read(name))?;
            channels[unread].clone_from(name);
        }
    }
    // Other textures stand for one of these.
    if channels.is_empty() {
        channels.extend(targets.first().cloned());
    }
    Some(channels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_have_channels_for_what_they_read() {
        let named = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let channels = |images: &[&str], targets: &[&str], read: &[&str]| {
            channels(&named(images), &named(targets), |name| read.contains(&name))
        };
        // Four textures have the same channels in all passes.
        assert_eq!(
            channels(&["i"], &["a", "b", "c"], &["c"]),
            Some(named(&["i", "a", "b", "c"]))
        );
        // Of more, an image keeps its channel, unless the pass reads four others.
        let many = ["a", "b", "c", "d", "e"];
        assert_eq!(
            channels(&["i", "j"], &many, &["d"]),
            Some(named(&["i", "j", "d"]))
        );
        assert_eq!(
            channels(&["i", "j"], &many, &["d", "b", "e", "j"]),
            Some(named(&["e", "j", "b", "d"]))
        );
        assert_eq!(channels(&["i", "j"], &many, &["a", "b", "c", "d", "e"]), None);
        assert_eq!(channels(&[], &many, &[]), Some(named(&["a"])));
        // The fifth image has no channel.
        let images = ["i", "j", "k", "l", "m"];
        assert_eq!(channels(&images, &["a"], &["m", "a"]), None);
        assert_eq!(
            channels(&images, &["a"], &["i", "a"]),
            Some(named(&["i", "j", "k", "a"]))
        );
    }
}
