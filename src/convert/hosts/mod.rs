//! Hosts whose file has the whole shader, with all its passes: an ES module for three.js, and ISF.
//!
//! A host writes its file from [`Passes`], and reads the passes from the file again for the proof.

mod isf;
mod literal;
mod template;
mod three;
mod three_browser;
mod words;

use toyproof_diagnostic::Deadline;
use toyproof_glsl::{self as glsl, Checked, Dialect, PortError, Version};
use toyproof_image::{Frame, Input, Texture};
use toyproof_player::{Graph, Pass, Target};
use toyproof_project::PassKind;

use crate::graph::{HostGraph, InputEntry};
use crate::header::ProofStatus;
use crate::passes::{GraphContent, PassSources};
use crate::project::{ProjectError, ProjectSource};
use crate::{ConvertError, Converter, ProofError, Prover, Source, TargetCode};

/// A host whose file has all passes of a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Host {
    /// three.js: an ES module with materials, and what renders them.
    Three,
    /// ISF: GLSL with a header in JSON.
    Isf,
}

impl Host {
    /// The host's name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Three => "three",
            Self::Isf => "isf",
        }
    }

    /// What changes the mouse of a frame into one that the host's inputs can describe.
    fn mouse(self) -> fn(Frame) -> Frame {
        match self {
            Self::Three => std::convert::identity,
            Self::Isf => isf::with_its_mouse,
        }
    }

    /// The extension of its files, without the dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Three => "js",
            Self::Isf => "fs",
        }
    }
}

/// ShaderToy's structures of channels, as they are read.
const STRUCTURES: [&str; 4] = ["iCh0.", "iCh1.", "iCh2.", "iCh3."];

/// What is converted for a [`Host`].
#[derive(Debug, Clone, Copy)]
pub enum HostedSource<'a> {
    /// A shader that is not a tab of a project.
    Shader(Source<'a>),
    /// A project: its image, and the passes that the image reads.
    Project(ProjectSource<'a>),
}

impl HostedSource<'_> {
    /// The name of the shader; empty if it is not known.
    fn name(&self) -> &str {
        match self {
            Self::Shader(source) => source.files.get(source.file()).name(),
            Self::Project(source) => source.name,
        }
    }
}

/// The file of a shader for a host.
#[derive(Debug)]
pub struct HostedConversion {
    /// The text of the file.
    pub text: String,
    /// The proof; `None` if no proof was requested.
    pub proof: Option<Result<ProofStatus, ProofError>>,
}

/// The passes of a shader as a host's file has them.
struct Passes<'a> {
    sources: Vec<Source<'a>>,
    kinds: Vec<PassKind>,
    /// The order of the passes, and what they read. Of a shader that is no project, channels read noise in
    /// proofs only.
    graph: Graph,
    media: Vec<Texture>,
    /// What the channels of each pass read, if that is known.
    entries: Vec<[Option<InputEntry>; 4]>,
    /// Whether the shader is a project, which says what its channels read.
    is_project: bool,
    /// The text of Common, which the passes contain.
    common: Option<&'a str>,
}

/// What a host's file says, as it was read again.
struct ReadPasses {
    /// The passes, which complete shaders for this dialect.
    codes: Vec<String>,
    dialect: Dialect,
    /// The order of the passes, and what they read.
    content: GraphContent,
}

impl<'a> Passes<'a> {
    fn of_shader(source: Source<'a>) -> Self {
        let image = Pass {
            target: Target::Image,
            inputs: [None; 4],
        };
        Self {
            sources: vec![source],
            kinds: vec![PassKind::Image],
            graph: Graph::new(vec![image], Default::default()),
            media: Vec::new(),
            entries: vec![[const { None }; 4]],
            is_project: false,
            common: None,
        }
    }

    fn of_project(source: ProjectSource<'a>) -> Result<Self, ProjectError> {
        let ProjectSource { project, files, .. } = source;
        let rendering = source.rendering()?;
        let checked = rendering.passes.iter().map(|&at| &project.checked[at]);
        let checked: Vec<&'a Checked> = checked.collect();
        let host_graph = HostGraph::new(&project.project, &rendering, &checked);
        let count = checked.len();
        let entries = (0..count).map(|pass| std::array::from_fn(|channel| host_graph.entry(pass, channel)));
        let entries = entries.collect();
        let HostGraph { graph, media, .. } = host_graph;
        let kinds = rendering
            .passes
            .iter()
            .map(|&at| project.project.passes[at].kind)
            .collect();
        let common = project.project.common.map(|file| files.get(file).text());
        Ok(Self {
            kinds,
            sources: checked.iter().map(|checked| Source { checked, files }).collect(),
            graph,
            media,
            entries,
            is_project: true,
            common: common.filter(|common| !common.trim().is_empty()),
        })
    }

    /// The channels that a pass reads, or of which it reads the sizes.
    fn channels(&self, pass: usize) -> impl Iterator<Item = usize> {
        let source = &self.sources[pass];
        let reads_sizes = source.checked.reads_input(Input::ChannelResolution);
        // A macro that is not used may name a channel, too.
        let words = words::words(source.text());
        (0..4).filter(move |&channel| {
            source.checked.names_channel(channel)
                || words.contains(&*format!("iChannel{channel}"))
                || reads_sizes && self.entries[pass][channel].is_some()
        })
    }

    /// The passes, with their targets.
    fn targets(&self) -> impl Iterator<Item = Target> {
        self.graph.passes().iter().map(|pass| pass.target)
    }

    /// Proves that what was read from a file renders the same images.
    fn prove(
        &self,
        host: Host,
        text: &str,
        read: &ReadPasses,
        prover: &mut Prover,
    ) -> Result<ProofStatus, ProofError> {
        let codes = read.codes.iter();
        let codes: Vec<_> = codes
            .map(|code| TargetCode::Glsl(code.clone(), read.dialect))
            .collect();
        if let ([source], [code]) = (&self.sources[..], &codes[..]) {
            let proof = prover.prove_with(
                *source,
                code,
                host.mouse(),
                |browser, frames, undefined| match host {
                    Host::Three => {
                        three_browser::shader(self, *source, text, browser, (frames, undefined)).map(Some)
                    }
                    Host::Isf => Ok(None),
                },
            );
            return proof.map(ProofStatus::Proved);
        }
        let passes = PassSources {
            sources: &self.sources,
            graph: &self.graph,
            media: &self.media,
        };
        let proof = prover.prove_passes_with(
            &passes,
            &codes,
            &read.content,
            host.mouse(),
            |browser, original| match host {
                Host::Three => three_browser::passes(self, text, browser, original).map(Some),
                Host::Isf => Ok(None),
            },
        );
        proof.map(ProofStatus::ProvedPasses)
    }
}

impl Converter {
    /// Converts a shader or a project for a host whose file has all passes. With a prover, the file is read
    /// again, and the conversion is proved.
    ///
    /// # Errors
    /// Returns why there is no conversion. One that is not proved is not an error.
    pub fn convert_hosted(
        &self,
        host: Host,
        source: HostedSource,
        prover: Option<&mut Prover>,
    ) -> Result<HostedConversion, ProjectError> {
        let passes = match source {
            HostedSource::Shader(source) => Passes::of_shader(source),
            HostedSource::Project(source) => Passes::of_project(source)?,
        };
        let text = match host {
            Host::Three => three::write(self, &passes)?,
            Host::Isf => isf::write(self, &passes, source.name())?,
        };
        let read = match host {
            Host::Three => three::read(&text, &passes),
            Host::Isf => isf::read(&text, &passes, self.timeout),
        };
        let proof = prover.map(|prover| {
            let read = read.map_err(ProofError::Unreadable)?;
            passes.prove(host, &text, &read, prover)
        });
        Ok(HostedConversion { text, proof })
    }

    /// The GLSL of each pass for a host, in one of these versions.
    fn port_passes(
        &self,
        passes: &Passes,
        dialect: Dialect,
        versions: &[Version],
    ) -> Result<Vec<String>, ProjectError> {
        let deadline = Deadline::after(self.timeout);
        let texts = passes.sources.iter().zip(&passes.kinds).map(|(source, &pass)| {
            let Source { checked, files } = *source;
            let text = glsl::port_in_versions(checked, files, (dialect, versions), &|_, _| None, &deadline);
            let text = text.map_err(|error| ProjectError::Pass {
                pass,
                error: match error {
                    PortError::Overdue(overdue) => overdue.into(),
                    error => ConvertError::Port(error),
                },
            })?;
            match STRUCTURES.into_iter().find(|name| text.contains(name)) {
                Some(name) => {
                    let why = format!("{pass} reads `{name}…`, which only ShaderToy has");
                    Err(ProjectError::Unwritable(why))
                }
                None => Ok(text),
            }
        });
        texts.collect()
    }
}
