//! The trees of generated functions that are plain text.

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::tree::{Direction, FunctionId, VariableKind};
use toyproof_glsl::{self as glsl, Options};

use crate::lower::context::LoweringContext;

/// Parses a generated function whose body is this GLSL: the first item of the result, whose name is not the
/// function's. `None` if it is not
/// valid by itself.
pub(crate) fn helper_tree(
    cx: &LoweringContext,
    id: FunctionId,
    text: &str,
) -> Option<(Files, LoweringContext)> {
    let tree = &cx.tree;
    let function = &tree[id];
    let parameters = function.parameters.iter().map(|&parameter| {
        let variable = &tree[parameter];
        let is_out = matches!(
            variable.kind,
            VariableKind::Parameter(Direction::Out | Direction::InOut)
        );
        let direction = if is_out { "out " } else { "" };
        format!("{direction}{} {}", tree.type_name(variable.ty), variable.name)
    });
    let parameters: Vec<_> = parameters.collect();
    // A comment for helpers whose names do not say enough.
    let about = if function.name.ends_with("remainder") {
        "// `a % b` of GLSL as Mesa and SwiftShader round it, down: other languages round towards zero.\n"
    } else {
        ""
    };
    let source = format!(
        "{about}{} toyproof_helper({}) {{ {text} }}\nvoid mainImage(out vec4 c, in vec2 p) {{}}",
        tree.type_name(function.return_type),
        parameters.join(", ")
    );
    let mut files = Files::default();
    let file = files.add(File::new("<helper>", source));
    let checked = glsl::check(&files, file, &Options::default()).ok()?;
    Some((files, LoweringContext::new(&checked)))
}
