//! Uniforms and varyings that the shader declares. ShaderToy sets only its own, so these are zero. Samplers
//! read a channel.

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{ExprKind, VariableKind};

use super::Findings;
use super::program::Program;

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    for expr in program.all_exprs() {
        let ExprKind::Variable(variable) = tree[expr].kind else {
            continue;
        };
        let variable = &tree[variable];
        let kind = match variable.kind {
            VariableKind::Uniform => "uniform",
            VariableKind::Varying => "input",
            _ => continue,
        };
        let Some(at) = variable.at else {
            continue;
        };
        let message = format!("nothing sets the {kind} `{}`, so it is 0", variable.name);
        findings.add(Code::UnsetUniform, at, message, |diagnostic| {
            diagnostic
                .note("ShaderToy sets only its own inputs, such as `iTime`")
                .help("use one of ShaderToy's inputs, or a constant")
        });
    }
}
