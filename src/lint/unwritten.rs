//! Variables that are read before they are written, and functions that end before they return, with the way that gets there.
//!
//! Told of components and members, through calls with `out` and `inout`, and along ways that can be: what is known of flags and
//! sentinels on a way decides its conditions, and who writes a loop means it to run at least once.

mod builder;
mod conditions;
mod evaluate;
mod flow;
mod global;
mod known;
mod part;
mod range;
mod search;
mod summary;
mod terms;
mod way;

use builder::Builder;
use flow::{begun, is_followed};
use part::Layout;
use search::{Budget, Quarry, Search};
use summary::{Summary, summary};
use toyproof_diagnostic::Files;
use toyproof_glsl::Code;
use toyproof_glsl::tree::{Direction, FunctionId, Tree, Type, VariableId, VariableKind};
use way::{Decision, DecisionKind, Way};

use super::Found;
use super::program::{Program, direction};

/// The longest condition that is shown.
const MAX_SHOWN: usize = 48;

pub(super) fn run(program: &Program, files: &Files, found: &mut Found) {
    let tree = program.tree;
    let layout = Layout::new(tree);
    let mut summaries = vec![Summary::default(); tree.functions.len()];
    let mut written = global::Written::default();
    let mut left = Budget::default();
    let colour = tree[program.main].parameters.first().copied();
    for &function in &program.functions {
        if program.deadline.is_over() {
            return;
        }
        let flow = Builder::build(tree, &layout, &summaries, colour, function);
        let mut sum = summary(tree, &flow, function);
        let mut search = Search::new(program, &flow);
        for (index, &parameter) in tree[function].parameters.iter().enumerate() {
            if direction(tree, parameter) == Direction::InOut {
                let quarry = Quarry {
                    variable: Some(parameter),
                    parts: layout.whole(tree[parameter].ty),
                    from: (0, 0),
                    to_the_end: false,
                };
                let ways = search.ways(quarry, &mut left);
                sum.reads[index] = ways.iter().fold(0, |parts, way| parts | way.parts);
            }
        }
        summaries[function.index()] = sum;
        let mut reads: Vec<(VariableId, Way, Vec<VariableId>)> = Vec::new();
        for (variable, block, event) in begun(&flow)
            .into_iter()
            .filter(|&(variable, ..)| is_followed(tree, variable))
        {
            let is_colour = Some(variable) == colour;
            let whole = layout.whole(tree[variable].ty);
            let quarry = Quarry {
                variable: Some(variable),
                parts: whole,
                from: (block, event + 1),
                to_the_end: is_colour,
            };
            let ways = search.ways(quarry, &mut left);
            let best = ways.into_iter().min_by_key(|way| (way.decisions.len(), way.expr));
            let Some(way) = best else {
                continue;
            };
            // What is unwritten for the same reason is told once.
            let alike = |(_, told, _): &&mut (VariableId, Way, Vec<VariableId>)| {
                !way.decisions.is_empty() && told.decisions == way.decisions
            };
            match reads.iter_mut().find(alike) {
                Some((.., others)) => others.push(variable),
                None => reads.push((variable, way, Vec::new())),
            }
        }
        if tree[function].return_type != Type::Void {
            let quarry = Quarry {
                variable: None,
                parts: 1,
                from: (0, 0),
                to_the_end: true,
            };
            let ways = search.ways(quarry, &mut left);
            let best = ways.into_iter().min_by_key(|way| way.decisions.len());
            if let Some(way) = best {
                tell_missing_return(tree, files, function, &way, found);
            }
        }
        for (variable, way, others) in &reads {
            tell(tree, files, &layout, *variable, way, others, found);
        }
        written.add(&flow);
    }
    written.tell(program, &layout, found);
}

fn tell(
    tree: &Tree,
    files: &Files,
    layout: &Layout,
    variable: VariableId,
    way: &Way,
    others: &[VariableId],
    found: &mut Found,
) {
    let is_out = matches!(tree[variable].kind, VariableKind::Parameter(_));
    let name = layout.name(variable, way.parts);
    let when = when(tree, files, &way.decisions);
    let code = if when.is_empty() {
        Code::Unwritten
    } else {
        Code::MaybeUnwritten
    };
    let message = match (way.expr, when.is_empty()) {
        (Some(_), true) if is_out => {
            format!("`{name}` is read here before it is written: an `out` parameter brings nothing in")
        }
        (Some(_), true) => format!("`{name}` is read here before it is written"),
        (Some(_), false) => format!("`{name}` is read here but never written when {when}"),
        (None, true) => format!("`{name}`, the pixel's colour, is never written"),
        (None, false) => format!("`{name}`, the pixel's colour, is never written when {when}"),
    };
    let declared = tree[variable].at;
    let Some(at) = way.expr.map(|expr| tree[expr].at).or(declared) else {
        return;
    };
    found.tell(code, at, message, |mut diagnostic| {
        if let Some(declared) = declared.filter(|_| way.expr.is_some()) {
            diagnostic = diagnostic.related(declared.span, "declared here, without a value");
        }
        for decision in &way.decisions {
            let at = tree[decision.expr].at.span;
            diagnostic = diagnostic.related(at, outcome(decision.kind));
        }
        for other in others.iter().filter_map(|&other| tree[other].at) {
            diagnostic = diagnostic.related(other.span, "so is this");
        }
        if !others.is_empty() {
            diagnostic = diagnostic.note(format!("so it is with {}", listed(tree, others)));
        }
        diagnostic.note("WebGL makes it zero; other hosts leave in it what was there before. Give it a value where it is declared")
    });
}

fn tell_missing_return(tree: &Tree, files: &Files, function: FunctionId, way: &Way, found: &mut Found) {
    let name = &tree[function].name;
    let when = when(tree, files, &way.decisions);
    let message = if when.is_empty() {
        format!("`{name}` may end without a `return`")
    } else {
        format!("`{name}` ends without a `return` when {when}")
    };
    found.tell(
        Code::MissingReturn,
        tree[function].at,
        message,
        |mut diagnostic| {
            for decision in &way.decisions {
                let at = tree[decision.expr].at.span;
                diagnostic = diagnostic.related(at, outcome(decision.kind));
            }
            diagnostic
                .note("WebGL then gives zero; other hosts give what was there before. End it with a `return`")
        },
    );
}

/// Names for a sentence; of many, the first.
fn listed(tree: &Tree, variables: &[VariableId]) -> String {
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

/// The decisions in words, with their lines.
fn when(tree: &Tree, files: &Files, decisions: &[Decision]) -> String {
    let words: Vec<_> = decisions
        .iter()
        .map(|decision| {
            let span = tree[decision.expr].at.span;
            let line = files.position(span).line;
            let text = files.text(span).split_whitespace().collect::<Vec<_>>().join(" ");
            let shown = if text.len() > MAX_SHOWN {
                "the condition".to_owned()
            } else {
                format!("`{text}`")
            };
            format!("{shown} {} (line {line})", outcome(decision.kind))
        })
        .collect();
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

fn outcome(kind: DecisionKind) -> String {
    match kind {
        DecisionKind::Is(true) => "is true".to_owned(),
        DecisionKind::Is(false) => "is false".to_owned(),
        DecisionKind::Ends => "ends the loop".to_owned(),
        DecisionKind::Chooses(Some(value)) => format!("is {}", value.cast_signed()),
        DecisionKind::Chooses(None) => "is none of the labels".to_owned(),
    }
}
