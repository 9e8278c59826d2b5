//! Functions with a body that the shader never calls.
//!
//! Not reported are: functions of Common, which other tabs may call; overloads of a function that is called;
//! functions that only a function calls that is itself never called; functions that the site calls; and those
//! whose names occur in a branch of `#if` that is not compiled, or in the replacement of a macro.

use std::collections::{BTreeSet, HashSet};

use toyproof_diagnostic::{Code, Files};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{FunctionId, Item};

use super::Findings;
use super::program::{Program, callee};

/// The functions that `ShaderToy` calls, some of them in other tabs or on other devices.
const ENTRIES: [&str; 5] = ["main", "mainImage", "mainVR", "mainSound", "mainCubemap"];

/// The largest number of functions that are reported one by one: more functions are a library.
const MAX_SINGLE: usize = 3;

pub(super) fn run(program: &Program, files: &Files, checked: &Checked, findings: &mut Findings) {
    let tree = program.tree;
    let called: HashSet<_> = tree.exprs.iter().filter_map(|(id, _)| callee(tree, id)).collect();
    let mut names: HashSet<_> = called
        .iter()
        .map(|&function| tree[function].name.as_str())
        .collect();
    names.extend(ENTRIES);
    let tab = files.origin(tree[program.main].at.span).file;
    let is_uncalled = |&function: &FunctionId| {
        let function = &tree[function];
        !names.contains(function.name.as_str())
            && !checked.unexpanded_names.contains(&function.name)
            && !function.at.is_expanded()
            && files.origin(function.at.span).file == tab
    };
    let defined = tree.items.iter().filter_map(|item| match *item {
        Item::Function(function) => Some(function),
        _ => None,
    });
    let mut uncalled: Vec<_> = defined.filter(is_uncalled).collect();
    let at = |function: FunctionId| tree[function].at;
    // A macro may define a function whose name is its argument.
    let starts: BTreeSet<_> = uncalled.iter().map(|&function| at(function).span.start).collect();
    let uses = checked.expansions.uses();
    let in_macros: HashSet<_> = uses.flat_map(|used| starts.range(used.start..used.end)).collect();
    // Overloads are reported once.
    let mut seen = HashSet::new();
    uncalled.retain(|&function| {
        !in_macros.contains(&at(function).span.start) && seen.insert(tree[function].name.as_str())
    });
    if let [first, others @ ..] = &uncalled[..]
        && uncalled.len() > MAX_SINGLE
    {
        let message = format!(
            "`{}` and {} other functions are never called",
            tree[*first].name,
            others.len()
        );
        findings.add(Code::Uncalled, at(*first), message, |diagnostic| {
            let names: Vec<_> = others
                .iter()
                .map(|&other| format!("`{}`", tree[other].name))
                .collect();
            diagnostic.note(format!("the others are {}", names.join(", ")))
        });
        return;
    }
    for function in uncalled {
        let message = format!("the function `{}` is never called", tree[function].name);
        findings.add(Code::Uncalled, at(function), message, |diagnostic| {
            diagnostic.help("call it where its result is needed, or remove it")
        });
    }
}
