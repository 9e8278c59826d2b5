//! Converts the passes of a project, and writes how they are `host_graph`.

use toyproof_convert::graph::{GRAPH_FILE, HostGraph, target_name};
use toyproof_convert::header::{self, ProofStatus};
use toyproof_convert::{PassSources, PassesConversion, Prover, ReadGraph, Source, script};
use toyproof_gpu::Worker;
use toyproof_project::{CompiledProject, PassKind};
use toyproof_translate::wgsl::Style;

use super::super::Exit;
use super::super::shader::Shader;
use super::conversion::{Conversion, OutputFile, Refusal, Settings, refusal};

impl Settings<'_> {
    /// Converts a project whose image reads other passes.
    pub(super) fn convert_project(
        &self,
        translator: &mut Worker,
        prover: Option<&mut Prover>,
        shader: &Shader,
        passes: &CompiledProject,
    ) -> Result<Conversion, Refusal> {
        self.check_passes()?;
        let rendering = passes.rendering(PassKind::Image);
        let rendering =
            rendering.map_err(|error| Refusal::Message(format!("the project {error}"), Exit::Error))?;
        let checked: Vec<_> = passes.checked_of(&rendering).collect();
        let host_graph = HostGraph::new(&passes.project, &rendering, &checked);
        let extension = self.to.extension();
        let targets = host_graph
            .graph
            .passes()
            .iter()
            .map(|pass| target_name(pass.target));
        let names: Vec<String> = targets.map(|name| format!("{name}.{extension}")).collect();
        let (last, read) = if self.converter.style == Style::WgpuShadertoy {
            let text =
                script::script(&host_graph, &names).map_err(|why| Refusal::Message(why, Exit::Error))?;
            let sampling = checked.iter().map(|checked| checked.sampling).collect();
            let graph = host_graph.graph.clone();
            ((script::SCRIPT_FILE, text), ReadGraph { graph, sampling })
        } else {
            let text = host_graph
                .file(&shader.name, &self.to.name(), self.to.entry_point(), &names)
                .to_json();
            let read = host_graph.read(&text);
            let read = read.map_err(|why| Refusal::Message(format!("{GRAPH_FILE}: {why}"), Exit::Error))?;
            ((GRAPH_FILE, text), read)
        };
        let sources: Vec<_> = checked
            .iter()
            .map(|checked| Source {
                checked,
                files: &shader.files,
            })
            .collect();
        let converted = PassSources {
            sources: &sources,
            graph: &host_graph.graph,
            media: &host_graph.media,
        };
        let converted = self
            .converter
            .convert_passes(&converted, &read, translator, prover);
        let kind = |pass: usize| passes.project.passes[rendering.passes[pass]].kind;
        let PassesConversion { files, proof } =
            converted.map_err(|(pass, error)| refusal(error).of_pass(kind(pass)))?;
        let status = self.status(proof.map(|proof| proof.map(ProofStatus::ProvedPasses)));
        let mut fallback = None;
        let mut output = Vec::new();
        for (at, (written, reason)) in files.into_iter().enumerate() {
            let mut bytes = written.into_bytes();
            if let Some(target) = self.converter.target {
                let name = format!("{}, {}", shader.name, kind(at));
                header::insert(&mut bytes, target, &name, &status);
            }
            fallback = fallback.or(reason);
            let name = Some(names[at].clone());
            output.push(OutputFile { name, bytes });
        }
        // It is complete when it is there: its passes precede it.
        output.push(OutputFile {
            name: Some(last.0.to_owned()),
            bytes: last.1.into_bytes(),
        });
        Ok(Conversion {
            files: output,
            status,
            fallback,
        })
    }

    /// Checks that the options apply to projects.
    fn check_passes(&self) -> Result<(), Refusal> {
        let style = self.converter.style;
        let refused = match style {
            Style::ComputeToys | Style::Bevy => format!(
                "its image reads other passes, which the style `{}` does not support; use `--style plain` or \
                 `--style {}`",
                style.name(),
                Style::WgpuShadertoy.name()
            ),
            Style::Plain | Style::WgpuShadertoy => return Ok(()),
        };
        Err(Refusal::Message(refused, Exit::Error))
    }
}
