//! What the functions of Godot's language get as parameters: global variables, and what only the entry point
//! of the host has.

use toyproof_glsl::tree::{BuiltInVariable, VariableId, VariableKind};

use super::Unprintable;
use super::host::CHost;
use super::writer::PrintResult;
use crate::lower::context::LoweringContext;
use crate::lower::{GlobalConflict, orient_derivatives, pass_globals};

/// Passes global variables as arguments, if functions see none in the language of the host; returns what
/// `mainImage` gets from the host's entry point.
pub(super) fn pass(cx: &mut LoweringContext, host: CHost) -> PrintResult<Vec<VariableId>> {
    if !host.language().passes_globals() {
        return Ok(Vec::new());
    }
    if host.orients_derivatives(cx.stage) {
        orient_derivatives(cx);
    }
    for id in cx.tree.variables.ids() {
        let variable = &mut cx.tree[id];
        // Names that begin with `gl_` are reserved.
        if variable.kind == VariableKind::BuiltIn(BuiltInVariable::FragCoord)
            && variable.name.starts_with("gl_")
        {
            "position".clone_into(&mut variable.name);
        }
    }
    pass_globals(cx).map_err(|conflict| {
        Unprintable::Construct(match conflict {
            GlobalConflict::Aliased => {
                "a global variable that is an `out` argument of a function that uses it"
            }
            GlobalConflict::CalledEntry => "a call of `mainImage`",
        })
    })
}
