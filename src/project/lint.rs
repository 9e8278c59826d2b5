//! Warnings about the inputs of a project that the site probably treats differently than the author expects.

use toyproof_diagnostic::{Code, Diagnostic};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprKind, VariableKind};

use crate::pass::{Buffer, Input, PassKind, Source};
use crate::project::Project;

/// An input that the code of its pass names.
struct Read<'p> {
    /// The pass that reads.
    by: PassKind,
    /// The index of that pass in the file.
    index: usize,
    channel: usize,
    input: &'p Input,
}

/// Warns about the inputs of a project; `passes` are the trees of its passes, in the same order.
pub(crate) fn lint(project: &Project, passes: &[&Checked]) -> Vec<Diagnostic> {
    let mut reads = Vec::new();
    for (index, (pass, checked)) in project.passes.iter().zip(passes).enumerate() {
        let used = used_channels(checked);
        for (channel, input) in pass.inputs.iter().enumerate() {
            if let Some(input) = input.as_ref().filter(|_| used[channel]) {
                let by = pass.kind;
                reads.push(Read {
                    by,
                    index,
                    channel,
                    input,
                });
            }
        }
    }
    let mut warnings = Vec::new();
    missing_passes(project, &reads, &mut warnings);
    for buffer in Buffer::OF_SITE {
        let source = Source::Buffer(buffer);
        let of_buffer: Vec<_> = reads.iter().filter(|read| read.input.source == source).collect();
        conflicting_samplers(buffer, &of_buffer, &mut warnings);
    }
    order(project, &reads, &mut warnings);
    warnings
}

/// Which channels a pass names.
fn used_channels(checked: &Checked) -> [bool; 4] {
    let mut used = [false; 4];
    for (_, expr) in checked.tree.exprs.iter() {
        if let ExprKind::Variable(variable) = expr.kind
            && let VariableKind::Channel(channel) = checked.tree[variable].kind
        {
            used[usize::from(channel)] = true;
        }
    }
    used
}

impl Read<'_> {
    fn warning(&self, code: Code, message: String) -> Diagnostic {
        let warning = Diagnostic::new(code, message);
        match self.input.span {
            Some(span) => warning.at(span),
            None => warning,
        }
    }
}

/// Inputs that read a pass that does not exist: the site shows black.
fn missing_passes(project: &Project, reads: &[Read], warnings: &mut Vec<Diagnostic>) {
    for read in reads {
        let Some(source) = read
            .input
            .source
            .pass()
            .filter(|source| project.pass(*source).is_none())
        else {
            continue;
        };
        let message = format!(
            "iChannel{} of {} reads {source}, which does not exist",
            read.channel, read.by
        );
        let warning = read.warning(Code::MissingPass, message);
        warnings.push(
            warning
                .note("ShaderToy reads black there")
                .help("add the tab, or remove the input"),
        );
    }
}

/// Samplers belong to textures on the site, not to inputs: the filter is that of the highest channel of a
/// pass, and the wrap mode that of the last input of all passes.
fn conflicting_samplers(buffer: Buffer, reads: &[&Read], warnings: &mut Vec<Diagnostic>) {
    for (at, first) in reads.iter().enumerate() {
        let later = reads[at + 1..].iter().filter(|later| later.index == first.index);
        let mut other = later.filter(|later| later.input.sampler.filter != first.input.sampler.filter);
        if let Some(other) = other.next_back() {
            let message = format!(
                "iChannel{} and iChannel{} of {} read {buffer} with different filters",
                first.channel, other.channel, first.by
            );
            let warning = first.warning(Code::SamplerConflict, message);
            let note = format!(
                "ShaderToy has one filter for each buffer: that of iChannel{}",
                other.channel
            );
            warnings.push(with_related(warning, other).note(note));
        }
    }
    let Some(last) = reads.last() else {
        return;
    };
    let differing = |read: &&&Read| read.input.sampler.wrap != last.input.sampler.wrap;
    if let Some(first) = reads.iter().find(differing) {
        let message = format!(
            "{} and {} read {buffer} with different wrap modes",
            first.by, last.by
        );
        let warning = first.warning(Code::SamplerConflict, message);
        let note = format!(
            "ShaderToy has one wrap mode for each buffer: that of the last input, of {}",
            last.by
        );
        warnings.push(with_related(warning, last).note(note));
    }
}

fn with_related(warning: Diagnostic, other: &Read) -> Diagnostic {
    match other.input.span {
        Some(span) => warning.related(span, "the other input"),
        None => warning,
    }
}

/// Buffers that read each other and do not run in the order of their names: which frame is read depends on
/// the order.
fn order(project: &Project, reads: &[Read], warnings: &mut Vec<Diagnostic>) {
    for read in reads {
        let (PassKind::Buffer(by), Source::Buffer(source)) = (read.by, &read.input.source) else {
            continue;
        };
        let position = |kind| {
            project
                .passes
                .iter()
                .position(|pass| pass.kind == PassKind::Buffer(kind))
        };
        let Some(source_index) = position(*source) else {
            continue;
        };
        let runs_later = source_index > read.index;
        if runs_later == (*source > by) || by == *source {
            continue;
        }
        let (frame, when) = if runs_later {
            ("the previous frame", "after")
        } else {
            ("the same frame", "before")
        };
        let message = format!("{by} reads {frame} of {source}, which runs {when} it in this project");
        let warning = read.warning(Code::BufferOrder, message);
        let note = "buffers run in the order of the file, which is not that of their names here";
        warnings.push(
            warning
                .note(note)
                .help("order the passes by name if another frame is meant"),
        );
    }
}
