//! The rendered parts of a project: its passes in the site's order, the textures that they read, and how they
//! sample them.

use toyproof_glsl::{Filter, Sampling, Wrap};
use toyproof_image::{MovingTextures, Texture};
use toyproof_player::{self as player, BUFFERS, BufferFormat, Graph, Target};

use crate::pass::{Input, Pass, PassKind, Source, SourceType};
use crate::project::Project;
use crate::textures::{MissingMedium, Textures};

/// The passes that render the image of a project.
#[derive(Debug, Clone)]
pub struct Rendering {
    /// The order of the passes, and their inputs.
    pub graph: Graph,
    /// The indices of the graph's passes in [`Project::passes`], in the order of the graph.
    pub passes: Vec<usize>,
    /// The textures that do not change.
    pub media: Vec<Texture>,
    /// The textures that change from frame to frame.
    pub films: MovingTextures,
    /// The inputs whose media of the site are not available, without repetitions.
    pub missing: Vec<MissingMedium>,
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
        let mut textures = Textures::new(&self.media);
        let nodes = passes
            .iter()
            .map(|&at| &self.passes[at])
            .map(|pass| player::Pass {
                target: pass.kind.target(),
                inputs: [0, 1, 2, 3].map(|channel| {
                    let input = pass.inputs[channel].as_ref()?;
                    match (&input.source, input.source.pass().map(PassKind::target)) {
                        (_, Some(Target::Buffer(buffer))) => Some(player::Source::Buffer(buffer)),
                        (Source::Keyboard, _) => Some(player::Source::Keyboard),
                        _ => textures.source(input, (pass.kind, channel)),
                    }
                }),
            });
        let nodes = nodes.collect();
        let mut formats: [BufferFormat; BUFFERS] = Default::default();
        for pass in &self.passes {
            if let Target::Buffer(buffer) = pass.kind.target() {
                formats[buffer] = pass.format.clone();
            }
        }
        for input in self.rendered_inputs() {
            if let (Some(Target::Buffer(buffer)), Filter::Mipmap) =
                (input.source.pass().map(PassKind::target), input.sampler.filter)
            {
                formats[buffer].mipmaps = true;
            }
        }
        Ok(Rendering {
            graph: Graph::new(nodes, formats),
            passes,
            media: textures.media,
            films: MovingTextures(textures.moving),
            missing: textures.missing,
        })
    }

    /// The sound, as a graph of one pass, with the textures that it reads; `None` if there is none. The site
    /// binds only pictures to it.
    #[must_use]
    pub fn sound(&self) -> Option<Rendering> {
        let at = self.passes.iter().position(|pass| pass.kind == PassKind::Sound)?;
        let pass = &self.passes[at];
        let mut textures = Textures::new(&self.media);
        let inputs = [0, 1, 2, 3].map(|channel| {
            let input = pass.inputs[channel].as_ref()?;
            let is_bound = input.source.source_type() == SourceType::Texture;
            is_bound
                .then(|| textures.source(input, (pass.kind, channel)))
                .flatten()
        });
        let pass = player::Pass {
            target: Target::Image,
            inputs,
        };
        Some(Rendering {
            graph: Graph::new(vec![pass], Default::default()),
            passes: vec![at],
            media: textures.media,
            films: MovingTextures(textures.moving),
            missing: textures.missing,
        })
    }

    /// How the channels of a pass are sampled. On the site, filter and wrap of a buffer belong to its
    /// texture: the filter is that of the highest channel of the pass that reads it, and the wrap that of the
    /// last input in the file. Keyboard and music have one filter and one wrap, whatever their inputs have.
    pub(crate) fn sampling(&self, pass: &Pass) -> [Sampling; 4] {
        pass.inputs.each_ref().map(|input| {
            let Some(input) = input else {
                return Sampling::default();
            };
            if input.source.pass().is_none() {
                let (filter, wrap) = match input.source.source_type() {
                    SourceType::Keyboard => (Filter::Nearest, Wrap::Clamp),
                    SourceType::Music | SourceType::MusicStream | SourceType::Mic => {
                        (Filter::Linear, Wrap::Clamp)
                    }
                    _ => (input.sampler.filter, input.sampler.wrap),
                };
                return Sampling { filter, wrap };
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
