//! Prints a shader in a language with the syntax of C, as its author wrote it: with the original names,
//! comments, loops and expressions.
//!
//! The tree is printed after the few lowering passes that these languages require too. Shaders that the
//! writer does not support ([`Unprintable`]) are left to naga's writers. A host is a row of the table in
//! [`host`](CHost) and a template in `hosts/`.

mod builtin;
mod construct;
mod expression;
#[cfg(test)]
mod godot_tests;
mod host;
mod item;
mod language;
mod lookup;
mod metal;
mod statement;
mod substitute;
#[cfg(test)]
mod tests;
mod writer;

pub use host::CHost;
pub use substitute::HostedText;
use toyproof_diagnostic::{Deadline, Files};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{BuiltInVariable, VariableId, VariableKind};

use self::language::{Language, Words};
use self::writer::Writer;
use crate::lower::context::LoweringContext;
use crate::lower::{
    GlobalConflict, branch_for_effects, call_macros, chain_switches, fold_by_precision, fold_except,
    name_array_values, orient_derivatives, pass_globals, unwrap_case_jumps,
};
use crate::print::{CaseLabels, Names, Order};
pub use crate::unprintable::{Unprintable, WriteFailure};

/// The title of a shader, for hosts whose files state it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Title<'a> {
    /// The name of the shader or project.
    pub name: &'a str,
    /// The name of the pass, in a project with several.
    pub pass: Option<&'a str>,
}

impl<'a> Title<'a> {
    /// The title of a shader that is not a pass of a project.
    #[must_use]
    pub fn of_shader(name: &'a str) -> Self {
        Self { name, pass: None }
    }
}

/// Prints a checked shader for a host; the author's comments are read from `files`.
///
/// # Errors
/// If a construct is not supported, the host lacks an input, or the deadline passes.
pub fn write(
    checked: &Checked,
    files: &Files,
    host: CHost,
    title: Title,
    deadline: &Deadline,
) -> Result<String, WriteFailure> {
    let mut cx = LoweringContext::new(checked);
    call_macros(&mut cx, checked, files, deadline)?;
    fold_except(&mut cx, |_| false);
    fold_by_precision(&mut cx);
    let language = host.language();
    let (early, late) = language.passes();
    cx.has_references = language.has_references();
    early.run(&mut cx, deadline)?;
    if language.branches_for_effects() {
        branch_for_effects(&mut cx);
    }
    if !language.has_array_values() {
        name_array_values(&mut cx);
    }
    late.run(&mut cx, deadline)?;
    unwrap_case_jumps(&mut cx);
    if language == Language::Godot {
        chain_switches(&mut cx);
    }
    let passed = passed_globals(&mut cx, host)?;
    writer::shorten_generated_names(&mut cx, language);
    let order = Order::new(&cx, CaseLabels::Values);
    deadline.check()?;
    let names = Names::new(&cx, &order, &Words::new(host));
    deadline.check()?;
    let mut writer = Writer::new(&cx, &names, &order, host, files, deadline);
    writer.passed = &passed;
    let written = writer.write(&order, title);
    // An expired deadline also makes the writer fail.
    deadline.check()?;
    let written = written?;
    Ok(if language == Language::Godot {
        with_tabs(&written)
    } else {
        written
    })
}

/// A text whose lines are indented by tabs, as Godot's style guide asks.
fn with_tabs(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let code = line.trim_start_matches(' ');
        let indent = line.len() - code.len();
        out.extend(std::iter::repeat_n('\t', indent / INDENT));
        out.push_str(&line[indent - indent % INDENT..]);
        out.push('\n');
    }
    out
}

/// The spaces of a level of indentation.
const INDENT: usize = 4;

/// Passes global variables as arguments, if functions see none in the language of the host; returns what
/// `mainImage` gets from the host's entry point.
fn passed_globals(cx: &mut LoweringContext, host: CHost) -> Result<Vec<VariableId>, Unprintable> {
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
