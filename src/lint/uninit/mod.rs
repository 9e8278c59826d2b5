//! Variables that are read before they are written, and functions that end without a `return`.
//!
//! A definite-assignment analysis ([`flow`]) distinguishes components and members, and follows calls by
//! summaries of their parameters. A read that no assignment precedes on any path is an error of the author's,
//! and a warning. One that assignments precede on some paths only is often right, as with a hit record that
//! is read only if a flag is set: it is reported if a run of the shader observes it.

mod flow;
mod missing_return;
mod part;
mod state;

use std::collections::{BTreeMap, BTreeSet};

use flow::{Flow, analyze};
use part::{Access, Layout, Parts};
use toyproof_diagnostic::{Code, Diagnostic};
use toyproof_glsl::tree::{ExprId, Tree, Type, VariableId, VariableKind};

use super::Findings;
use super::program::Program;

/// The end of all messages about reads of an uninitialized variable.
fn with_advice(diagnostic: Diagnostic) -> Diagnostic {
    diagnostic
        .note("its value is undefined; WebGL initializes it to 0")
        .help("initialize it at its declaration")
}

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    let layout = Layout::new(tree);
    let mut summaries = vec![Vec::new(); tree.functions.len()];
    let mut globals = GlobalAccesses::default();
    for &function in &program.functions {
        if program.deadline.is_over() {
            return;
        }
        let color = (function == program.main)
            .then(|| tree[function].parameters.first().copied())
            .flatten();
        let flow = analyze(program, &layout, &summaries, color, function);
        if flow.falls_off && tree[function].return_type != Type::Void {
            missing_return::report(program, function, findings);
        }
        if let Some(color) = color.filter(|_| flow.never_colors) {
            report_color(tree, color, findings);
        }
        report_reads(tree, &layout, &flow, findings);
        globals.add(&flow);
        summaries[function.index()] = flow.parameters;
    }
    globals.report(program, &layout, findings);
}

fn report_reads(tree: &Tree, layout: &Layout, flow: &Flow, findings: &mut Findings) {
    for (&variable, &(expr, parts)) in &flow.definite {
        let message = format!("`{}` is used uninitialized", layout.name(variable, parts));
        let is_parameter = matches!(tree[variable].kind, VariableKind::Parameter(_));
        findings.add(Code::Unwritten, tree[expr].at, message, |diagnostic| {
            let diagnostic = declared(tree, variable, diagnostic);
            if is_parameter {
                diagnostic
                    .note("an `out` parameter has no value until the function assigns it")
                    .help("assign it first, or declare it `inout`")
            } else {
                with_advice(diagnostic)
            }
        });
    }
    for (&variable, reads) in &flow.maybe {
        let Some(&first) = reads.first().filter(|_| !flow.definite.contains_key(&variable)) else {
            continue;
        };
        let name = &tree[variable].name;
        let warning = Code::MaybeUnwritten.at(tree[first].at, format!("`{name}` may be used uninitialized"));
        let mut warning = declared(tree, variable, warning);
        for &other in reads.iter().skip(1).take(MAX_OTHER_READS) {
            warning = warning.related(tree[other].at.span, "also here");
        }
        findings.maybe_uninitialized.push(with_advice(warning));
    }
}

/// The maximum number of further reads that a warning names.
const MAX_OTHER_READS: usize = 3;

/// Adds the declaration, which identifies this variable in an observed read.
fn declared(tree: &Tree, variable: VariableId, diagnostic: Diagnostic) -> Diagnostic {
    match tree[variable].at {
        Some(at) => diagnostic.related(at.span, "declared here without an initializer"),
        None => diagnostic,
    }
}

fn report_color(tree: &Tree, color: VariableId, findings: &mut Findings) {
    if let Some(at) = tree[color].at {
        let message = format!("the output color `{}` is never assigned", tree[color].name);
        findings.add(Code::Unwritten, at, message, |diagnostic| {
            diagnostic.note("the color is undefined; WebGL shows black")
        });
    }
}

/// Reads and writes, by all functions, of the globals without an initial value.
#[derive(Default)]
struct GlobalAccesses {
    writes: BTreeMap<VariableId, Parts>,
    reads: Vec<(Access, ExprId)>,
}

impl GlobalAccesses {
    fn add(&mut self, flow: &Flow) {
        for (&variable, parts) in &flow.global_writes {
            *self.writes.entry(variable).or_default() |= parts;
        }
        self.reads.extend_from_slice(&flow.global_reads);
    }

    /// Reports globals with a part that is read but never written.
    fn report(self, program: &Program, layout: &Layout, findings: &mut Findings) {
        let tree = program.tree;
        let mut reported = BTreeSet::new();
        for (access, expr) in self.reads {
            let missing = access.parts & !self.writes.get(&access.variable).copied().unwrap_or(0);
            if missing == 0
                || (access.is_one_of_parts && missing != access.parts)
                || !reported.insert(access.variable)
            {
                continue;
            }
            let name = layout.name(access.variable, missing);
            let message = format!("`{name}` is used, but never assigned");
            findings.add(Code::Unwritten, tree[expr].at, message, |diagnostic| {
                declared(tree, access.variable, diagnostic)
                    .note("its value is undefined; WebGL initializes it to 0")
                    .help("initialize it, or call the function that assigns it")
            });
        }
    }
}
