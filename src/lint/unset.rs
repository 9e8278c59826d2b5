//! Uniforms and varyings that the shader declares. ShaderToy sets only its own, so these are zero. Samplers
//! read a channel.

use toyproof_diagnostic::Code;
use toyproof_glsl::Dialect;
use toyproof_glsl::tree::{ExprKind, VariableKind};

use super::Findings;
use super::program::Program;

pub(super) fn run(program: &Program, dialect: Dialect, findings: &mut Findings) {
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
            let title = dialect.title();
            let value = format!("give it a value: `--uniform {}=…`", variable.name);
            let help = match (dialect, variable.kind) {
                (_, VariableKind::Varying) => {
                    "a full-screen shader has only the coordinates of the screen, a `vec2`"
                }
                (Dialect::ShaderToy, _) => {
                    "use one of ShaderToy's inputs, or a constant; or `--uniform NAME=VALUE`"
                }
                _ => &value,
            };
            diagnostic
                .note(format!("{title} sets only its own inputs"))
                .help(help)
        });
    }
}
