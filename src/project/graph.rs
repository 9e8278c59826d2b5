//! The rendered parts of a project: its passes in the site's order, the textures that they read, and how they
//! sample them.

use std::collections::HashMap;

use toyproof_glsl::{Filter, Sampling, Wrap};
use toyproof_image::{Image, Noise, Texture};
use toyproof_player::{self as player, BUFFERS, Graph, Target};

use crate::pass::{Input, Pass, PassKind, Source, SourceType};
use crate::project::Project;

/// The passes that render the image of a project.
#[derive(Debug, Clone)]
pub struct Rendering {
    /// The order of the passes, and their inputs.
    pub graph: Graph,
    /// The indices of the graph's passes in [`Project::passes`], in the order of the graph.
    pub passes: Vec<usize>,
    /// The textures that do not change.
    pub media: Vec<Texture>,
    /// The inputs whose media are replaced, or are black, without repetitions.
    pub replaced: Vec<MissingMedium>,
}

/// An input whose medium is not available.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingMedium {
    /// The source that would be read.
    pub source: Source,
    /// Whether a texture with the same properties takes its place; otherwise the channel is black.
    pub has_stand_in: bool,
    /// The passes that read the texture, each with the number of the channel.
    pub readers: Vec<(PassKind, usize)>,
}

/// Why the image of a project cannot be rendered: a part of a sentence, after the name of the image.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("reads {0}, which is not rendered yet")]
pub struct UnsupportedPass(pub PassKind);

impl Project {
    /// The image and these passes, with all passes that they depend on, for the renderers.
    ///
    /// # Errors
    /// If a pass is needed that cannot be rendered.
    pub fn rendering(&self, shown: &[PassKind]) -> Result<Rendering, UnsupportedPass> {
        let needed = self.needed_by(&[&[PassKind::Image], shown].concat());
        if let Some(&kind) = needed.iter().find(|kind| **kind == PassKind::Sound) {
            return Err(UnsupportedPass(kind));
        }
        let is_rendered = |kind: PassKind| needed.contains(&kind);
        let passes = (0..self.passes.len()).filter(|&at| is_rendered(self.passes[at].kind));
        let mut passes: Vec<usize> = passes.collect();
        // Buffers keep the order of the file; Cube A and the image follow them.
        passes.sort_by_key(|&at| match self.passes[at].kind {
            PassKind::Buffer(_) => 0,
            PassKind::CubeA => 1,
            PassKind::Image | PassKind::Sound => 2,
        });
        let mut media = Media {
            images: &self.images,
            textures: Vec::new(),
            known: Vec::new(),
            replaced: Vec::new(),
        };
        let nodes = passes
            .iter()
            .map(|&at| &self.passes[at])
            .map(|pass| player::Pass {
                target: pass.kind.target(),
                inputs: [0, 1, 2, 3]
                    .map(|channel| media.source(pass.inputs[channel].as_ref()?, (pass.kind, channel))),
            });
        let nodes = nodes.collect();
        let mut mipmaps = [false; BUFFERS];
        for input in self.rendered_inputs() {
            if let (Some(Target::Buffer(buffer)), Filter::Mipmap) =
                (input.source.pass().map(PassKind::target), input.sampler.filter)
            {
                mipmaps[buffer] = true;
            }
        }
        Ok(Rendering {
            graph: Graph::new(nodes, mipmaps),
            passes,
            media: media.textures,
            replaced: media.replaced,
        })
    }

    /// How the channels of a pass are sampled. On the site, filter and wrap of a buffer belong to its
    /// texture: the filter is that of the highest channel of the pass that reads it, and the wrap that of the
    /// last input in the file.
    pub(crate) fn sampling(&self, pass: &Pass) -> [Sampling; 4] {
        pass.inputs.each_ref().map(|input| {
            let Some(input) = input else {
                return Sampling::default();
            };
            if input.source.pass().is_none() {
                return Sampling {
                    filter: input.sampler.filter,
                    wrap: input.sampler.wrap,
                };
            }
            let reads = |other: &&Input| other.source == input.source;
            let highest = pass.inputs.iter().flatten().rfind(reads);
            Sampling {
                filter: highest.map_or(input.sampler.filter, |input| input.sampler.filter),
                wrap: self.wrap(&input.source),
            }
        })
    }

    /// The wrap of a buffer.
    fn wrap(&self, buffer: &Source) -> Wrap {
        let readers = self.rendered_inputs().filter(|input| input.source == *buffer);
        // Inputs without spans are assumed, and all the same.
        let last = readers.max_by_key(|input| input.span.map(|span| span.start));
        last.map_or(Wrap::Clamp, |input| input.sampler.wrap)
    }

    /// The inputs of all passes but Sound, which reads no buffers.
    fn rendered_inputs(&self) -> impl Iterator<Item = &Input> {
        let passes = self.passes.iter().filter(|pass| pass.kind != PassKind::Sound);
        passes.flat_map(|pass| pass.inputs.iter().flatten())
    }
}

/// The textures that do not change, as they are found.
struct Media<'a> {
    /// The images of the project's folder.
    images: &'a HashMap<String, Image>,
    textures: Vec<Texture>,
    /// The properties of the textures, in their order.
    known: Vec<TextureKey>,
    replaced: Vec<MissingMedium>,
}

/// The properties by which textures that do not change differ.
#[derive(PartialEq)]
struct TextureKey {
    source: Source,
    has_mipmaps: bool,
    is_flipped: bool,
}

impl Media<'_> {
    /// The source of an input in the graph; `None` for black.
    fn source(&mut self, input: &Input, reader: (PassKind, usize)) -> Option<player::Source> {
        if let Some(Target::Buffer(buffer)) = input.source.pass().map(PassKind::target) {
            return Some(player::Source::Buffer(buffer));
        }
        if input.source == Source::Keyboard {
            return Some(player::Source::Keyboard);
        }
        let images = self.images;
        let found = input.source.file().and_then(|path| images.get(path));
        let noise = noise(&input.source);
        if found.is_none() {
            let mut replaced = self.replaced.iter_mut();
            match replaced.find(|replaced| replaced.source == input.source) {
                Some(replaced) => replaced.readers.push(reader),
                None => self.replaced.push(MissingMedium {
                    source: input.source.clone(),
                    has_stand_in: noise.is_some(),
                    readers: vec![reader],
                }),
            }
        }
        let has_mipmaps = input.sampler.filter == Filter::Mipmap;
        let key = TextureKey {
            source: input.source.clone(),
            has_mipmaps,
            is_flipped: input.sampler.vflip,
        };
        if let Some(known) = self.known.iter().position(|known| *known == key) {
            return Some(player::Source::Medium(known));
        }
        // An image stands upright if it is flipped on its way to the texture.
        let upright = found.cloned().or_else(|| noise.map(Noise::image));
        let image = upright.map(|image| {
            if input.sampler.vflip {
                image
            } else {
                image.upside_down()
            }
        });
        let texture = Texture::from(image?);
        self.textures.push(if has_mipmaps {
            texture.with_mipmaps()
        } else {
            texture
        });
        self.known.push(key);
        Some(player::Source::Medium(self.known.len() - 1))
    }
}

/// The substitute for a texture of the site.
fn noise(source: &Source) -> Option<Noise> {
    let medium = source
        .medium()
        .filter(|medium| medium.source_type == SourceType::Texture)?;
    Some(match medium.name {
        "RGBA Noise Medium" => Noise::RgbaMedium,
        "RGBA Noise Small" => Noise::RgbaSmall,
        "Gray Noise Medium" => Noise::GrayMedium,
        "Gray Noise Small" => Noise::GraySmall,
        "Bayer" => Noise::Bayer,
        "Blue Noise" => Noise::Blue,
        _ => return None,
    })
}
