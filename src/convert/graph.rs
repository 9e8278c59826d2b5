//! `graph.json`: how a host plays the passes of a converted project. `docs/guide/converting.md` describes it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{Checked, Filter, Sampling, Wrap};
use toyproof_image::{BLOCK_BYTES, Texture};
use toyproof_player::{self as player, BUFFERS, Graph, Target};
use toyproof_project::{Input, PassKind, Project, Rendering, Source, Tab};

use crate::passes::GraphContent;
use crate::proof::noise;

/// The name of the file.
pub const GRAPH_FILE: &str = "graph.json";

/// The version of the format.
const VERSION: u32 = 1;

/// The content of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GraphFile {
    version: u32,
    generator: String,
    /// The name of the project.
    shader: String,
    /// The language of the passes, as `--to` names it.
    language: String,
    uniforms: Uniforms,
    /// The passes in the order in which they are rendered; the image is last.
    passes: Vec<PassEntry>,
}

/// The uniform block.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Uniforms {
    bytes: usize,
    /// The offset of each input in bytes.
    offsets: BTreeMap<String, usize>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PassEntry {
    /// The name that the site shows.
    name: String,
    file: String,
    entry_point: String,
    /// `image`, or `buffer-a` to `buffer-d`.
    target: String,
    format: String,
    /// The content of the target before the first frame, which is never cleared afterward.
    initial: Initial,
    /// Whether mipmaps of the target are made after the pass.
    mipmaps: bool,
    /// The inputs of channels 0 to 3.
    inputs: [Option<InputEntry>; 4],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Initial {
    Zero,
}

/// What a channel of a pass reads, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct InputEntry {
    /// What the channel reads.
    #[serde(flatten)]
    pub(crate) source: SourceEntry,
    #[serde(with = "FilterName")]
    pub(crate) filter: Filter,
    #[serde(with = "WrapName")]
    pub(crate) wrap: Wrap,
}

/// The source of a channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "source", rename_all = "lowercase")]
pub(crate) enum SourceEntry {
    /// What a pass renders, in this frame or in the previous one.
    Buffer {
        /// The name of the target.
        buffer: String,
        /// The frame in which it was rendered.
        frame: FrameName,
    },
    /// The keyboard.
    Keyboard {
        /// Width and height in texels.
        size: [u32; 2],
    },
    /// A texture that does not change, or that comes from a camera or the like.
    Media {
        /// The type of the medium: a texture, a cube map and so on.
        #[serde(rename = "type")]
        kind: String,
        /// The site's id.
        id: String,
        /// The site's name, if it is known.
        name: Option<String>,
        /// Width, height and depth in texels, if they are known.
        size: Option<[u32; 3]>,
        /// The number of stored components: with 1, texels read as (r, 0, 0, 1).
        components: Option<u8>,
        /// Whether the first row of the image is at the top of the texture.
        vflip: bool,
        /// Whether the texture has mipmaps.
        mipmaps: bool,
    },
}

/// The frame in which a buffer was rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum FrameName {
    /// This frame.
    This,
    /// The frame before.
    Previous,
}

/// The names of filters in the file.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Filter", rename_all = "lowercase")]
enum FilterName {
    Nearest,
    Linear,
    Mipmap,
}

/// The names of wraps in the file.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Wrap", rename_all = "lowercase")]
enum WrapName {
    Clamp,
    Repeat,
}

/// The passes of a project, and the textures for their proof.
pub(crate) struct HostGraph<'a> {
    project: &'a Project,
    rendering: &'a Rendering,
    checked: &'a [&'a Checked],
    /// What is rendered in proofs: media that are not available are replaced by noise.
    pub(crate) graph: Graph,
    /// The textures of a proof.
    pub(crate) media: Vec<Texture>,
    /// What [`Self::media`] are.
    known: Vec<(SourceEntry, usize)>,
}

impl<'a> HostGraph<'a> {
    /// Plays the passes of a rendering, whose trees are given in its order.
    pub(crate) fn new(project: &'a Project, rendering: &'a Rendering, checked: &'a [&'a Checked]) -> Self {
        let mut played = Self {
            project,
            rendering,
            checked,
            graph: rendering.graph.clone(),
            media: rendering.media.clone(),
            known: Vec::new(),
        };
        let mut passes = rendering.graph.passes().to_vec();
        for (at, pass) in passes.iter_mut().enumerate() {
            for (channel, source) in pass.inputs.iter_mut().enumerate() {
                if let Some(input) = played.input(at, channel)
                    && input.source.pass().is_none()
                {
                    let shape = checked[at].channels[channel];
                    *source = Some(player::Source::Medium(played.medium(input, *source, shape)));
                }
            }
        }
        played.graph = Graph::new(passes, rendering.graph.formats().clone());
        played
    }

    fn input(&self, pass: usize, channel: usize) -> Option<&'a Input> {
        let number = *self.rendering.passes.get(pass)?;
        self.project.passes[number].inputs[channel].as_ref()
    }

    /// The number of an input's texture, which is that of `source`, if there is one.
    fn medium(&mut self, input: &Input, source: Option<player::Source>, shape: SamplerShape) -> usize {
        let entry = media_entry(input);
        if let Some((_, number)) = self.known.iter().find(|(known, _)| *known == entry) {
            return *number;
        }
        let number = if let Some(player::Source::Medium(number)) = source {
            number
        } else {
            let texture = noise(shape, self.media.len());
            let is_mipmapped = input.sampler.filter == Filter::Mipmap;
            self.media.push(if is_mipmapped {
                texture.with_mipmaps()
            } else {
                texture
            });
            self.media.len() - 1
        };
        self.known.push((entry, number));
        number
    }

    /// The file for passes in this language, with these names.
    pub(crate) fn file(
        &self,
        shader: &str,
        language: &str,
        entry_point: &str,
        names: &[String],
    ) -> GraphFile {
        let passes = self
            .graph
            .passes()
            .iter()
            .enumerate()
            .map(|(at, pass)| PassEntry {
                name: self.project.passes[self.rendering.passes[at]].kind.to_string(),
                file: names[at].clone(),
                entry_point: entry_point.to_owned(),
                target: target_name(pass.target).to_owned(),
                format: "rgba32float".to_owned(),
                initial: Initial::Zero,
                mipmaps: matches!(pass.target, Target::Buffer(buffer) if self.graph.has_mipmaps(buffer)),
                inputs: std::array::from_fn(|channel| self.entry(at, channel)),
            });
        GraphFile {
            version: VERSION,
            generator: format!("toyproof {}", env!("CARGO_PKG_VERSION")),
            shader: shader.to_owned(),
            language: language.to_owned(),
            uniforms: uniforms(),
            passes: passes.collect(),
        }
    }

    /// What a channel of a pass reads, and how.
    pub(crate) fn entry(&self, pass: usize, channel: usize) -> Option<InputEntry> {
        let input = self.input(pass, channel)?;
        let sampling = self.checked[pass].sampling[channel];
        let source = match input.source {
            Source::Buffer(buffer) => SourceEntry::Buffer {
                buffer: target_name(Target::Buffer(buffer.number())).to_owned(),
                frame: frame_name(&self.graph.passes()[..pass], Target::Buffer(buffer.number())),
            },
            _ => media_entry(input),
        };
        Some(InputEntry {
            source,
            filter: sampling.filter,
            wrap: sampling.wrap,
        })
    }

    /// What a pass needs that wgpu-shadertoy 0.2 does not have.
    pub(crate) fn missing_in_wgpu_shadertoy(&self, pass: usize) -> Option<String> {
        let kind = self.project.passes[self.rendering.passes[pass]].kind;
        // The package clears the target of every pass.
        if self.checked[pass].discards() {
            return Some(format!(
                "{kind} has `discard`, after which a pixel keeps an earlier value"
            ));
        }
        let entries = (0..4).filter_map(|channel| self.entry(pass, channel));
        for (channel, entry) in entries.enumerate() {
            if entry.filter == Filter::Mipmap && matches!(entry.source, SourceEntry::Buffer { .. }) {
                return Some(format!("{kind} reads mipmaps of a buffer in iChannel{channel}"));
            }
        }
        None
    }

    /// The graph as its file contains it.
    pub(crate) fn content(&self) -> GraphContent {
        GraphContent {
            graph: self.graph.clone(),
            sampling: self.checked.iter().map(|checked| checked.sampling).collect(),
        }
    }

    /// Reads a file of this project again.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn read(&self, text: &str) -> Result<GraphContent, String> {
        let file: GraphFile = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if (file.version, &file.uniforms) != (VERSION, &uniforms()) {
            return Err("another version of the format".to_owned());
        }
        let mut passes: Vec<player::Pass> = Vec::new();
        let mut sampling = Vec::new();
        let mut formats: [player::BufferFormat; BUFFERS] = Default::default();
        for pass in &file.passes {
            let target = target_named(&pass.target).ok_or("an unknown target")?;
            let mut inputs = [None; 4];
            let mut pass_sampling = [Sampling::default(); 4];
            for (channel, input) in pass.inputs.iter().enumerate() {
                let Some(input) = input else { continue };
                pass_sampling[channel] = Sampling {
                    filter: input.filter,
                    wrap: input.wrap,
                };
                inputs[channel] = match &input.source {
                    SourceEntry::Buffer { buffer, frame } => {
                        let Some(read @ Target::Buffer(number)) = target_named(buffer) else {
                            return Err(format!("{} reads {buffer}, which is not a buffer", pass.name));
                        };
                        if *frame != frame_name(&passes, read) {
                            return Err(format!(
                                "{} reads {buffer} of another frame than its order implies",
                                pass.name
                            ));
                        }
                        Some(player::Source::Buffer(number))
                    }
                    medium => {
                        let known = self.known.iter().find(|(known, _)| known == medium);
                        known.map(|(_, number)| player::Source::Medium(*number))
                    }
                };
            }
            if let Target::Buffer(number) = target {
                formats[number].mipmaps |= pass.mipmaps;
            }
            passes.push(player::Pass { target, inputs });
            sampling.push(pass_sampling);
        }
        if passes.last().map(|pass| pass.target) != Some(Target::Image) || passes.len() != self.checked.len()
        {
            return Err("other passes than the project's".to_owned());
        }
        Ok(GraphContent {
            graph: Graph::new(passes, formats),
            sampling,
        })
    }
}

impl GraphFile {
    /// The text of the file.
    pub(crate) fn to_json(&self) -> String {
        // Strings, lists and options always serialize.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

fn uniforms() -> Uniforms {
    Uniforms {
        bytes: BLOCK_BYTES,
        offsets: toyproof_image::Input::ALL
            .map(|input| (input.name().to_owned(), input.offset()))
            .into(),
    }
}

/// Whether a pass after these reads the texture that a buffer's pass renders in this frame.
fn frame_name(before: &[player::Pass], buffer: Target) -> FrameName {
    if before.iter().any(|pass| pass.target == buffer) {
        FrameName::This
    } else {
        FrameName::Previous
    }
}

fn media_entry(input: &Input) -> SourceEntry {
    let medium = input.source.medium();
    match &input.source {
        Source::Keyboard => SourceEntry::Keyboard { size: [256, 3] },
        source => SourceEntry::Media {
            kind: source.source_type().name().to_owned(),
            id: match source {
                Source::Medium { id, .. } => id.clone(),
                _ => String::new(),
            },
            name: medium.map(|medium| medium.name.to_owned()),
            size: medium.map(|medium| medium.size),
            components: medium.map(|medium| medium.channels),
            vflip: input.sampler.vflip,
            mipmaps: input.sampler.filter == Filter::Mipmap,
        },
    }
}

/// The name of a target, which is that of its file without the extension.
pub(crate) fn target_name(target: Target) -> &'static str {
    let named = Tab::ALL.into_iter().find(|&tab| tab_target(tab) == Some(target));
    named.map_or("", Tab::name)
}

fn target_named(name: &str) -> Option<Target> {
    let tab = Tab::ALL.into_iter().find(|tab| tab.name() == name)?;
    tab_target(tab)
}

fn tab_target(tab: Tab) -> Option<Target> {
    match tab {
        Tab::Pass(PassKind::Image) => Some(Target::Image),
        Tab::Pass(PassKind::Buffer(buffer)) => Some(Target::Buffer(buffer.number())),
        Tab::Common | Tab::Pass(PassKind::CubeA | PassKind::Sound) => None,
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::Options;
    use toyproof_project::check;

    use super::*;

    /// Buffer A reads Buffer B, which reads Buffer A; the image reads both, and noise.
    const PROJECT: &str = r#"{"ver": "0.1", "info": {}, "renderpass": [
        {"type": "image", "name": "Image", "description": "", "outputs": [], "code": "CODE", "inputs": [
            {"channel": 0, "type": "buffer", "id": "4dXGR8", "filepath": "", "sampler": {"filter": "linear", "wrap": "clamp"}},
            {"channel": 1, "type": "texture", "id": "Xsf3zn", "filepath": "", "sampler": {"filter": "mipmap", "wrap": "repeat"}},
            {"channel": 2, "type": "texture", "id": "4dfGRn", "filepath": "", "sampler": {"filter": "linear", "wrap": "repeat"}}]},
        {"type": "buffer", "name": "", "description": "", "outputs": [{"id": "4dXGR8", "channel": 0}], "code": "CODE", "inputs": [
            {"channel": 0, "type": "buffer", "id": "XsXGR8", "filepath": "", "sampler": {"filter": "nearest", "wrap": "clamp"}}]},
        {"type": "buffer", "name": "", "description": "", "outputs": [{"id": "XsXGR8", "channel": 0}], "code": "CODE", "inputs": [
            {"channel": 3, "type": "buffer", "id": "4dXGR8", "filepath": "", "sampler": {"filter": "linear", "wrap": "clamp"}}]}]}"#;

    #[test]
    fn a_written_graph_is_read_again_and_its_faults_are_found() {
        let json = PROJECT.replace("CODE", "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }");
        let mut files = Files::default();
        let file = files.add(File::new("project.json", json));
        let project = Project::from_json(&mut files, file).unwrap();
        let passes = check(&project, &mut files, &Options::default()).unwrap().passes;
        let rendering = project.rendering(&[PassKind::Image]).unwrap();
        let checked: Vec<_> = rendering.passes.iter().map(|&at| &passes[at].checked).collect();
        let played = HostGraph::new(&project, &rendering, &checked);
        let names = ["a", "b", "image"].map(str::to_owned);
        let text = played.file("waves", "wgsl", "main", &names).to_json();
        let read = played.read(&text).unwrap();
        assert_eq!(read.graph, played.graph);
        let sampling: Vec<_> = checked.iter().map(|checked| checked.sampling).collect();
        assert_eq!(read.sampling, sampling);
        // A photograph is not available, and replaced by its own noise.
        let media = read.graph.passes()[2].inputs.map(|input| match input {
            Some(player::Source::Medium(number)) => Some(number),
            _ => None,
        });
        assert_eq!(media, [None, Some(0), Some(1), None]);
        assert_ne!(played.media[0].size(), played.media[1].size());

        for (from, to, why) in [
            ("\"version\": 1", "\"version\": 2", "version"),
            (
                "\"previous\"",
                "\"this\"",
                "Buffer A reads buffer-b of another frame",
            ),
            (
                "\"this\"",
                "\"previous\"",
                "Buffer B reads buffer-a of another frame",
            ),
            (
                "\"target\": \"image\"",
                "\"target\": \"buffer-c\"",
                "other passes",
            ),
            (
                "\"buffer\": \"buffer-b\"",
                "\"buffer\": \"image\"",
                "which is not a buffer",
            ),
            ("\"filter\": \"nearest\"", "\"filter\": \"best\"", "best"),
            ("\"mipmaps\": false,", "", "mipmaps"),
        ] {
            assert!(text.contains(from), "{text}");
            let error = played.read(&text.replacen(from, to, 1)).unwrap_err();
            assert!(error.contains(why), "{error}");
        }
    }
}
