//! Variables that are read before they are written, and functions that end without a `return`, with the path
//! that leads there.
//!
//! The analysis distinguishes components and members, follows calls with `out` and `inout` parameters, and
//! reports feasible paths only: facts about flags and sentinels on a path decide its conditions, and a loop
//! is assumed to run at least once.

mod builder;
mod cfg;
mod conditions;
mod facts;
mod part;
mod path;
mod search;

use std::collections::{BTreeMap, BTreeSet};

use builder::Builder;
use cfg::{Cfg, Event, Summary, begin_events, is_checked, summary};
use part::{Layout, Part, Parts};
use path::{Decision, DecisionKind, Path};
use search::{Budget, Query, Search};
use toyproof_diagnostic::Files;
use toyproof_glsl::Code;
use toyproof_glsl::tree::{Direction, ExprId, FunctionId, Tree, Type, VariableId, VariableKind};

use super::Findings;
use super::program::{Program, direction};

/// The maximum length of a condition quoted in a message, in bytes.
const MAX_CONDITION_BYTES: usize = 48;

pub(super) fn run(program: &Program, files: &Files, findings: &mut Findings) {
    let tree = program.tree;
    let layout = Layout::new(tree);
    let mut summaries = vec![Summary::default(); tree.functions.len()];
    let mut written = GlobalWrites::default();
    let mut budget = Budget::default();
    let color = tree[program.main].parameters.first().copied();
    for &function in &program.functions {
        if program.deadline.is_over() {
            return;
        }
        let cfg = Builder::build(tree, &layout, &summaries, color, function);
        let mut summary = summary(tree, &cfg, function);
        let mut search = Search::new(program, &cfg);
        for (index, &parameter) in tree[function].parameters.iter().enumerate() {
            if direction(tree, parameter) == Direction::InOut {
                let query = Query {
                    variable: Some(parameter),
                    parts: layout.whole(tree[parameter].ty),
                    from: (0, 0),
                    read_at_end: false,
                };
                let paths = search.paths(query, &mut budget);
                summary.reads[index] = paths.iter().fold(0, |parts, path| parts | path.parts);
            }
        }
        summaries[function.index()] = summary;
        let mut reads: Vec<(VariableId, Path, Vec<VariableId>)> = Vec::new();
        for (variable, block, event) in begin_events(&cfg)
            .into_iter()
            .filter(|&(variable, ..)| is_checked(tree, variable))
        {
            let is_color = Some(variable) == color;
            let whole = layout.whole(tree[variable].ty);
            let query = Query {
                variable: Some(variable),
                parts: whole,
                from: (block, event + 1),
                read_at_end: is_color,
            };
            let paths = search.paths(query, &mut budget);
            let best = paths
                .into_iter()
                .min_by_key(|path| (path.decisions.len(), path.expr));
            let Some(path) = best else {
                continue;
            };
            // Variables left uninitialized by the same decisions share one report.
            let alike = |(_, reported, _): &&mut (VariableId, Path, Vec<VariableId>)| {
                !path.decisions.is_empty() && reported.decisions == path.decisions
            };
            match reads.iter_mut().find(alike) {
                Some((.., others)) => others.push(variable),
                None => reads.push((variable, path, Vec::new())),
            }
        }
        if tree[function].return_type != Type::Void {
            let query = Query {
                variable: None,
                parts: 1,
                from: (0, 0),
                read_at_end: true,
            };
            let paths = search.paths(query, &mut budget);
            let best = paths.into_iter().min_by_key(|path| path.decisions.len());
            if let Some(path) = best {
                report_missing_return(tree, files, function, &path, findings);
            }
        }
        for (variable, path, others) in &reads {
            report(tree, files, &layout, *variable, path, others, findings);
        }
        written.add(&cfg);
    }
    written.report(program, &layout, findings);
}

fn report(
    tree: &Tree,
    files: &Files,
    layout: &Layout,
    variable: VariableId,
    path: &Path,
    others: &[VariableId],
    findings: &mut Findings,
) {
    let is_out = matches!(tree[variable].kind, VariableKind::Parameter(_));
    let name = layout.name(variable, path.parts);
    let when = describe_decisions(tree, files, &path.decisions);
    let code = if when.is_empty() {
        Code::Unwritten
    } else {
        Code::MaybeUnwritten
    };
    let message = match (path.expr, when.is_empty()) {
        (Some(_), true) if is_out => {
            format!("`{name}` is read here before it is written: an `out` parameter brings nothing in")
        }
        (Some(_), true) => format!("`{name}` is read here before it is written"),
        (Some(_), false) => format!("`{name}` is read here but never written when {when}"),
        (None, true) => format!("`{name}`, the pixel's colour, is never written"),
        (None, false) => format!("`{name}`, the pixel's colour, is never written when {when}"),
    };
    let declared = tree[variable].at;
    let Some(at) = path.expr.map(|expr| tree[expr].at).or(declared) else {
        return;
    };
    findings.add(code, at, message, |mut diagnostic| {
        if let Some(declared) = declared.filter(|_| path.expr.is_some()) {
            diagnostic = diagnostic.related(declared.span, "declared here, without a value");
        }
        for decision in &path.decisions {
            let at = tree[decision.expr].at.span;
            diagnostic = diagnostic.related(at, describe_outcome(decision.kind));
        }
        for other in others.iter().filter_map(|&other| tree[other].at) {
            diagnostic = diagnostic.related(other.span, "so is this");
        }
        if !others.is_empty() {
            diagnostic = diagnostic.note(format!("so it is with {}", list_names(tree, others)));
        }
        diagnostic.note("WebGL makes it zero; other hosts leave in it what was there before. Give it a value where it is declared")
    });
}

fn report_missing_return(
    tree: &Tree,
    files: &Files,
    function: FunctionId,
    path: &Path,
    findings: &mut Findings,
) {
    let name = &tree[function].name;
    let when = describe_decisions(tree, files, &path.decisions);
    let message = if when.is_empty() {
        format!("`{name}` may end without a `return`")
    } else {
        format!("`{name}` ends without a `return` when {when}")
    };
    findings.add(
        Code::MissingReturn,
        tree[function].at,
        message,
        |mut diagnostic| {
            for decision in &path.decisions {
                let at = tree[decision.expr].at.span;
                diagnostic = diagnostic.related(at, describe_outcome(decision.kind));
            }
            diagnostic
                .note("WebGL then gives zero; other hosts give what was there before. End it with a `return`")
        },
    );
}

/// Lists names in a sentence; of more than four variables, the first three and a count.
fn list_names(tree: &Tree, variables: &[VariableId]) -> String {
    const SHOWN: usize = 4;
    let names = |variables: &[VariableId]| {
        let names: Vec<_> = variables
            .iter()
            .map(|&variable| format!("`{}`", tree[variable].name))
            .collect();
        names.join(", ")
    };
    match variables {
        [only] => names(&[*only]),
        [most @ .., last] if variables.len() <= SHOWN => format!("{} and {}", names(most), names(&[*last])),
        _ => format!(
            "{} and {} more",
            names(&variables[..SHOWN - 1]),
            variables.len() + 1 - SHOWN
        ),
    }
}

/// Describes decisions with their lines.
fn describe_decisions(tree: &Tree, files: &Files, decisions: &[Decision]) -> String {
    let descriptions: Vec<_> = decisions
        .iter()
        .map(|decision| {
            let span = tree[decision.expr].at.span;
            let line = files.position(span).line;
            let text = files.text(span).split_whitespace().collect::<Vec<_>>().join(" ");
            let shown = if text.len() > MAX_CONDITION_BYTES {
                "the condition".to_owned()
            } else {
                format!("`{text}`")
            };
            format!("{shown} {} (line {line})", describe_outcome(decision.kind))
        })
        .collect();
    match descriptions.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

fn describe_outcome(kind: DecisionKind) -> String {
    match kind {
        DecisionKind::Holds(true) => "is true".to_owned(),
        DecisionKind::Holds(false) => "is false".to_owned(),
        DecisionKind::ExitsLoop => "ends the loop".to_owned(),
        DecisionKind::Selects(Some(value)) => format!("is {}", value.cast_signed()),
        DecisionKind::Selects(None) => "is none of the labels".to_owned(),
    }
}

// Globals without an initializer of which a part is read but never written.

/// The parts of globals that all functions together write, and the reads of globals.
#[derive(Default)]
struct GlobalWrites {
    writes: BTreeMap<VariableId, Parts>,
    reads: Vec<(Part, ExprId)>,
}

impl GlobalWrites {
    fn add(&mut self, cfg: &Cfg) {
        for event in cfg.blocks.iter().flat_map(|basic_block| &basic_block.events) {
            match event {
                Event::Write(part) => *self.writes.entry(part.variable).or_default() |= part.parts,
                Event::Read { part, expr } => self.reads.push((part.clone(), *expr)),
                _ => {}
            }
        }
    }

    fn report(self, program: &Program, layout: &Layout, findings: &mut Findings) {
        let tree = program.tree;
        let mut reported = BTreeSet::new();
        for (part, expr) in self.reads {
            let variable = &tree[part.variable];
            if variable.kind != VariableKind::Global || variable.initializer.is_some() {
                continue;
            }
            let missing = part.parts & !self.writes.get(&part.variable).copied().unwrap_or(0);
            if missing == 0 || (part.one_of && missing != part.parts) || !reported.insert(part.variable) {
                continue;
            }
            let name = layout.name(part.variable, missing);
            let message = format!("`{name}` is read here, and nothing that runs ever writes it");
            findings.add(Code::Unwritten, tree[expr].at, message, |diagnostic| {
                let diagnostic = match variable.at {
                    Some(at) => diagnostic.related(at.span, "declared here, without a value"),
                    None => diagnostic,
                };
                diagnostic.note("WebGL makes it zero; is the function called that should fill it?")
            });
        }
    }
}
