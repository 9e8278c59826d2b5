//! The profile of a shader in a frame: the operations of its functions and lines, and what is never executed.

use std::collections::{BTreeMap, HashMap, HashSet};

use toyproof_diagnostic::{FileId, Files, Span};
use toyproof_eval::{CallId, PartKind, Profile};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprKind, FunctionId, Item, VariableKind};
use toyproof_image::Frame;

/// Where the operations of a shader are executed.
#[derive(Debug, Clone)]
pub struct ShaderProfile {
    /// The number of profiled pixels.
    pub pixels: u64,
    /// Of the rows and columns of tiles, every which one was profiled: 1 for the whole image.
    pub step: u32,
    /// The operations of all profiled pixels.
    pub operations: u64,
    /// The largest number of operations of a pixel, and the first such pixel: x from the left, y from the bottom.
    pub largest: (u64, [u32; 2]),
    /// The functions that were called, the most expensive first.
    pub functions: Vec<FunctionProfile>,
    /// The lines with operations or statements that were executed, the most expensive first.
    pub lines: Vec<LineProfile>,
    /// The branches and loop bodies that no pixel executed although what encloses them was, in source order.
    pub unexecuted: Vec<Unexecuted>,
    /// The functions with a body that no pixel called, in source order.
    pub uncalled: Vec<String>,
    /// The uniforms that the shader declares and no expression reads, and the channels with a texture of which
    /// no pixel read a texel.
    pub unread: Vec<String>,
    /// Of which channels a pixel read a texel.
    pub samples_channel: [bool; 4],
}

/// The operations of a function.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FunctionProfile {
    /// The name.
    pub name: String,
    /// The number of calls, by all pixels.
    pub calls: u64,
    /// The operations in its own code.
    pub own: u64,
    /// These, and those of the functions that it calls.
    pub total: u64,
}

/// The operations of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineProfile {
    /// The file.
    pub file: FileId,
    /// The number of the line, from 1.
    pub line: usize,
    /// The operations, of all pixels.
    pub operations: u64,
    /// How often pixels executed the statement of the line that was executed most often; none if no statement
    /// begins in it.
    pub executions: Option<u64>,
}

/// A part of a shader that no pixel executed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unexecuted {
    /// Where it is.
    pub at: Span,
    /// What it is.
    pub kind: PartKind,
}

impl Unexecuted {
    /// Describes the part, such as `the condition of `if` is never true`.
    #[must_use]
    pub fn description(&self) -> &'static str {
        match self.kind {
            PartKind::If => "the condition of `if` is never true",
            PartKind::Else => "`else` is never executed",
            PartKind::Loop => "the body of the loop is never executed",
            PartKind::Case => "the `case` is never executed",
            PartKind::Yes => "the condition of `?:` is never true",
            PartKind::No => "the condition of `?:` is always true",
            PartKind::Right => "the right operand of `&&` or `||` is never evaluated",
            PartKind::Function(_) | PartKind::Statement => "never executed",
        }
    }
}

impl ShaderProfile {
    /// Summarizes the profile of a shader in a frame.
    #[must_use]
    pub fn new(profile: &Profile, checked: &Checked, files: &Files, frame: &Frame) -> Self {
        let calls = calls(profile);
        Self {
            pixels: profile.pixels,
            step: profile.step,
            operations: profile.operations(),
            largest: profile.largest,
            functions: functions(profile, checked, &calls),
            lines: lines(profile, files),
            unexecuted: unexecuted(profile, files),
            uncalled: uncalled(checked, &calls, files),
            unread: unread(profile, checked, frame),
            samples_channel: profile.texels().map(|texels| texels > 0),
        }
    }

    /// Returns a number of operations as a share of all, in percent.
    #[must_use]
    pub fn share(&self, operations: u64) -> f64 {
        100.0 * operations as f64 / self.operations.max(1) as f64
    }

    /// Returns a count of all pixels as that of a pixel, on average.
    #[must_use]
    pub fn per_pixel(&self, count: u64) -> f64 {
        count as f64 / self.pixels.max(1) as f64
    }
}

/// The number of calls of each function.
fn calls(profile: &Profile) -> HashMap<FunctionId, u64> {
    let mut calls = HashMap::new();
    for (part, count) in profile.parts() {
        if let PartKind::Function(function) = part.kind {
            *calls.entry(function).or_default() += count;
        }
    }
    calls
}

fn functions(profile: &Profile, checked: &Checked, calls: &HashMap<FunctionId, u64>) -> Vec<FunctionProfile> {
    let main = checked.main_image;
    let mut by_call = HashMap::<Option<CallId>, u64>::new();
    for (origin, operations) in profile.origins() {
        *by_call.entry(origin.call).or_default() += operations;
    }
    let mut own = HashMap::<FunctionId, u64>::new();
    let mut total = HashMap::<FunctionId, u64>::new();
    // Sums do not depend on the order.
    for (call, operations) in Vec::from_iter(by_call) {
        let mut next = call;
        let callers = std::iter::from_fn(|| {
            let call = profile.call(next?);
            next = call.parent;
            Some(call.function)
        });
        // GLSL has no recursion, so that no function occurs twice.
        let stack: Vec<_> = callers.chain([main]).collect();
        *own.entry(stack[0]).or_default() += operations;
        for function in stack {
            *total.entry(function).or_default() += operations;
        }
    }
    let called = calls.iter().filter(|(_, count)| **count > 0);
    let mut functions: Vec<_> = called
        .map(|(function, &calls)| FunctionProfile {
            name: checked.tree[*function].name.clone(),
            calls,
            own: own.get(function).copied().unwrap_or_default(),
            total: total.get(function).copied().unwrap_or_default(),
        })
        .collect();
    functions.sort_by(|a, b| b.total.cmp(&a.total).then_with(|| a.name.cmp(&b.name)));
    functions
}

fn lines(profile: &Profile, files: &Files) -> Vec<LineProfile> {
    let line = |span: Span| {
        let span = files.origin(span);
        (span.file, files.get(span.file).line(span.start as usize) + 1)
    };
    let mut statements = HashMap::<Span, u64>::new();
    for (part, count) in profile.parts() {
        if part.kind == PartKind::Statement {
            *statements.entry(part.at.span).or_default() += count;
        }
    }
    let mut lines = HashMap::<(FileId, usize), (u64, Option<u64>)>::new();
    for (span, count) in Vec::from_iter(statements) {
        let (_, executions) = lines.entry(line(span)).or_default();
        *executions = (*executions).max(Some(count));
    }
    for (origin, count) in profile.origins() {
        lines.entry(line(origin.at.span)).or_default().0 += count;
    }
    let lines = lines
        .into_iter()
        .map(|((file, line), (operations, executions))| LineProfile {
            file,
            line,
            operations,
            executions,
        });
    let mut lines: Vec<_> = lines
        .filter(|line| line.operations > 0 || line.executions.is_some_and(|count| count > 0))
        .collect();
    let key = |line: &LineProfile| (std::cmp::Reverse(line.operations), line.file, line.line);
    lines.sort_by_key(key);
    lines
}

fn unexecuted(profile: &Profile, files: &Files) -> Vec<Unexecuted> {
    let parts = profile.parts();
    // Of all calls together: whether the part was executed, and whether what encloses it was.
    let mut found = BTreeMap::<_, (Unexecuted, bool, bool)>::new();
    for &(part, count) in &parts {
        if matches!(part.kind, PartKind::Function(_) | PartKind::Statement) {
            continue;
        }
        let is_reached = part.parent.is_none_or(|parent| parts[parent.0 as usize].1 > 0);
        let at = files.origin(part.at.span);
        let (_, was_executed, was_reached) =
            found.entry((at.file, at.start, part.kind)).or_insert_with(|| {
                let kind = part.kind;
                (Unexecuted { at, kind }, false, false)
            });
        *was_executed |= count > 0;
        *was_reached |= is_reached;
    }
    let found = found.into_values();
    found
        .filter_map(|(part, was_executed, was_reached)| (was_reached && !was_executed).then_some(part))
        .collect()
}

fn uncalled(checked: &Checked, calls: &HashMap<FunctionId, u64>, files: &Files) -> Vec<String> {
    let tree = &checked.tree;
    let main = files.origin(tree[checked.main_image].at.span).file;
    let functions = tree.items.iter().filter_map(|item| match *item {
        Item::Function(function) => Some(function),
        _ => None,
    });
    let is_uncalled = |function: &FunctionId| {
        let is_own = files.origin(tree[*function].at.span).file == main;
        is_own && tree[*function].body.is_some() && calls.get(function).is_none_or(|&count| count == 0)
    };
    functions
        .filter(is_uncalled)
        .map(|function| tree[function].name.clone())
        .collect()
}

fn unread(profile: &Profile, checked: &Checked, frame: &Frame) -> Vec<String> {
    let tree = &checked.tree;
    let read = tree.exprs.iter().filter_map(|(_, expr)| match expr.kind {
        ExprKind::Variable(variable) => Some(variable),
        _ => None,
    });
    let read: HashSet<_> = read.collect();
    let is_unread =
        |id, kind| kind == VariableKind::Uniform && !read.contains(&id) && !checked.values_read.contains(&id);
    let uniforms = tree.variables.iter().filter(|&(id, variable)| {
        variable.at.is_some() && is_unread(id, variable.kind) && !checked.is_bound(id)
    });
    let uniforms = uniforms.map(|(_, variable)| variable.name.clone());
    let texels = profile.texels();
    let channels = (0..4).filter(|&at| frame.channels[at].is_some() && texels[at] == 0);
    uniforms
        .chain(channels.map(|channel| format!("iChannel{channel}")))
        .collect()
}
