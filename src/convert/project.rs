//! Converts a project: the passes that its image needs, and the file that says how a host plays them.

use thiserror::Error;
use toyproof_diagnostic::Files;
use toyproof_glsl::Dialect;
use toyproof_gpu::Worker;
use toyproof_player::BufferFormat;
use toyproof_project::{Buffer, CompiledProject, PassKind, Rendering, UnsupportedPass};
use toyproof_translate::backend::Target;
use toyproof_translate::c_family::{CHost, Title};
use toyproof_translate::wgsl::Style;

use crate::engine;
use crate::graph::{GRAPH_FILE, HostGraph, target_name};
use crate::passes::{GraphContent, PassSources, PassesProof};
use crate::script::{SCRIPT_FILE, script};
use crate::{ConvertError, Converter, FallbackReason, ProofError, Prover, Source, TargetCode};

/// A project to convert.
#[derive(Debug, Clone, Copy)]
pub struct ProjectSource<'a> {
    /// The name, for the host.
    pub name: &'a str,
    /// The project.
    pub project: &'a CompiledProject,
    /// The files that it was read from.
    pub files: &'a Files,
}

impl ProjectSource<'_> {
    /// The passes that the image needs.
    ///
    /// # Errors
    /// A pass is needed that is not converted.
    pub(crate) fn rendering(&self) -> Result<Rendering, ProjectError> {
        let project = self.project;
        let rendering = project.rendering(PassKind::Image)?;
        let is_cube = |&at: &usize| project.project.passes[at].kind == PassKind::CubeA;
        if rendering.passes.iter().any(is_cube) {
            return Err(ProjectError::CubeA);
        }
        for pass in rendering.passes.iter().map(|&at| &project.project.passes[at]) {
            match pass.kind {
                PassKind::Buffer(buffer) if !Buffer::OF_SITE.contains(&buffer) => {
                    return Err(ProjectError::ManyBuffers);
                }
                kind if pass.format != BufferFormat::default() => {
                    return Err(ProjectError::BufferFormat(kind));
                }
                _ => {}
            }
        }
        Ok(rendering)
    }
}

/// A converted project.
#[derive(Debug)]
pub struct ProjectConversion {
    /// The passes, in the order in which they are rendered.
    pub passes: Vec<PassFile>,
    /// The files that say how a host plays the passes; the last one makes the conversion complete.
    pub host: Vec<HostFile>,
    /// The proof; `None` if no proof was requested.
    pub proof: Option<Result<PassesProof, ProofError>>,
    /// Why naga wrote a pass, if our own writer could have.
    pub fallback: Option<FallbackReason>,
}

/// The file of a pass.
#[derive(Debug)]
pub struct PassFile {
    /// The pass.
    pub kind: PassKind,
    /// The name of the file.
    pub name: String,
    /// The content.
    pub code: TargetCode,
}

/// A file that says how a host plays the passes: [`GRAPH_FILE`], or a script.
#[derive(Debug)]
pub struct HostFile {
    /// The name.
    pub name: &'static str,
    /// The content.
    pub text: String,
}

/// Why a project could not be converted.
#[derive(Debug, Error)]
pub enum ProjectError {
    /// Hosts of this style render one pass.
    #[error(
        "its image reads other passes, which the style `{}` does not support; use `--style plain` or `--style {}`",
        .0.name(),
        Style::WgpuShadertoy.name()
    )]
    Style(Style),
    /// Hosts of this kind render one pass.
    #[error("its image reads other passes, which the style `{}` does not support", .0.name())]
    Host(CHost),
    /// GLSL is written for hosts that render one pass.
    #[error("its image reads other passes, which the style `{}` does not support", .0.name())]
    Dialect(Dialect),
    /// A pass is needed that cannot be rendered.
    #[error("the project {0}")]
    NotRendered(#[from] UnsupportedPass),
    /// A pass renders a buffer whose textures are not made as those of `ShaderToy`.
    #[error("{0} has a size of its own, or is cleared in each frame, which is not converted yet")]
    BufferFormat(PassKind),
    /// There are more buffers than on `ShaderToy`.
    #[error("the project has more than four buffers, which is not converted yet")]
    ManyBuffers,
    /// A pass renders a cube map.
    #[error("the project reads Cube A, which is not converted yet")]
    CubeA,
    /// The script's package does not have something that the passes need.
    #[error("{0}")]
    Script(String),
    /// The file of the graph is not read as it was written.
    #[error("{GRAPH_FILE}: {0}")]
    Graph(String),
    /// The host's file cannot hold something of the shader.
    #[error("{0}")]
    Unwritable(String),
    /// A pass cannot be converted.
    #[error("{pass}: {error}")]
    Pass {
        /// The pass.
        pass: PassKind,
        /// Why.
        error: ConvertError,
    },
}

impl Converter {
    /// Converts a project whose image reads other passes; `translator` runs naga. With a prover, the
    /// conversion is proved too.
    ///
    /// # Errors
    /// Returns why there is no conversion. One that is not proved is not an error.
    pub fn convert_project(
        &self,
        source: ProjectSource,
        translator: &mut Worker,
        mut prover: Option<&mut Prover>,
    ) -> Result<ProjectConversion, ProjectError> {
        if matches!(self.style, Style::ComputeToys | Style::Bevy) {
            return Err(ProjectError::Style(self.style));
        }
        if let Some(host) = self.c_host.filter(|host| !host.has_passes()) {
            return Err(ProjectError::Host(host));
        }
        if let Some(dialect) = self.dialect {
            return Err(ProjectError::Dialect(dialect));
        }
        let ProjectSource { project, files, name } = source;
        let rendering = source.rendering()?;
        let checked: Vec<_> = project.checked_of(&rendering).collect();
        let host_graph = HostGraph::new(&project.project, &rendering, &checked);
        let extension = self.extension();
        let passes = host_graph.graph.passes().iter();
        let names: Vec<String> = passes
            .map(|pass| format!("{}.{extension}", target_name(pass.target)))
            .collect();
        let (host, content) = self.host(&host_graph, source.name, &names)?;
        let sources: Vec<_> = checked.iter().map(|checked| Source { checked, files }).collect();
        let passes = PassSources {
            sources: &sources,
            graph: &host_graph.graph,
            media: &host_graph.media,
        };
        let kind = |pass: usize| project.project.passes[rendering.passes[pass]].kind;
        let mut codes = Vec::new();
        let mut fallback = None;
        for (pass, &source) in sources.iter().enumerate() {
            let pass_name = target_name(host_graph.graph.passes()[pass].target);
            let title = Title {
                name,
                pass: Some(pass_name),
            };
            let converted = self.convert(source, title, translator, None);
            let converted = converted.map_err(|error| ProjectError::Pass {
                pass: kind(pass),
                error,
            })?;
            codes.push(converted.code);
            fallback = fallback.or(converted.fallback);
        }
        let mut prove = |codes: &[TargetCode]| {
            let prover = prover.as_deref_mut()?;
            Some(prover.prove_passes(&passes, codes, &content))
        };
        let mut proof = prove(&codes);
        // If plain WGSL is not proved, naga may write all passes.
        if let Some(Err(unproved)) = &proof
            && self.may_fall_back()
            && !unproved.is_of_shader()
        {
            let sources = sources.iter();
            let other = sources.map(|&source| self.write_with_naga(source, self.target?, translator).ok());
            if let Some(other) = other.collect::<Option<Vec<_>>>()
                && let Some(Ok(other_proof)) = prove(&other)
                && let Some(Err(unproved)) = proof.replace(Ok(other_proof))
            {
                codes = other;
                fallback = Some(FallbackReason::Unproved(unproved));
            }
        }
        let passes = names.into_iter().zip(codes).enumerate();
        let passes = passes.map(|(pass, (name, code))| PassFile {
            kind: kind(pass),
            name,
            code,
        });
        Ok(ProjectConversion {
            passes: passes.collect(),
            host,
            proof,
            fallback,
        })
    }

    /// The files for the host of passes in these files, and the graph that they contain.
    fn host(
        &self,
        host_graph: &HostGraph,
        name: &str,
        names: &[String],
    ) -> Result<(Vec<HostFile>, GraphContent), ProjectError> {
        if self.style == Style::WgpuShadertoy {
            let text = script(host_graph, names).map_err(ProjectError::Script)?;
            let host = HostFile {
                name: SCRIPT_FILE,
                text,
            };
            return Ok((vec![host], host_graph.content()));
        }
        let language = self.target.map_or("lowered", Target::name);
        let entry_point = match (self.c_host, self.target) {
            (Some(CHost::Godot | CHost::Unity), _) => "fragment",
            // Metal reserves `main`.
            (_, Some(Target::Msl)) => "main_",
            _ => "main",
        };
        let file = host_graph.file(name, language, entry_point, names);
        if let Some(host) = self.c_host
            && let Some(files) = engine::files(host, &file, name)
        {
            if let Some(why) = engine::missing(host, host_graph) {
                return Err(ProjectError::Unwritable(why.to_owned()));
            }
            let script = files.last().map_or("", |file| &file.text);
            let content = engine::read(host, host_graph, script).map_err(ProjectError::Graph)?;
            return Ok((files, content));
        }
        let text = file.to_json();
        let content = host_graph.read(&text).map_err(ProjectError::Graph)?;
        let host = HostFile {
            name: GRAPH_FILE,
            text,
        };
        Ok((vec![host], content))
    }
}
