//! Quick fixes: the corrections that diagnostics propose, and comments that allow a warning.

use lsp_types::{CodeAction, CodeActionKind, CodeActionResponse, Diagnostic as LspDiagnostic, Range};
use toyproof_diagnostic::{Code, Diagnostic, Diagnostics, Severity, Span};
use toyproof_glsl::{Stage, single_edit};

use crate::diagnostics::converted;
use crate::edits::FileEdits;
use crate::snapshot::Snapshot;
use crate::symbol::FilePlace;
use crate::unit::Unit;
use crate::workspace::Workspace;

/// The kind of the action that applies all corrections.
const FIX_ALL: &str = "source.fixAll.toyproof";

/// The actions for a range of a document. `only` are the kinds that the client wants; empty for all. What a
/// check found is offered everywhere in the document.
pub(crate) fn code_actions(
    workspace: &mut Workspace,
    snapshot: &Snapshot,
    range: Range,
    only: &[CodeActionKind],
    found_by_check: Option<(String, FileEdits)>,
) -> Vec<CodeActionResponse> {
    let mut actions = Vec::new();
    if wants(only, "quickfix") {
        if let Some((title, edits)) = found_by_check {
            let action = action(workspace, title, CodeActionKind::QuickFix, &edits, None);
            actions.push(CodeAction {
                is_preferred: Some(true),
                ..action
            });
        }
        let start = snapshot.encoding.byte(snapshot.file(), range.start);
        let end = snapshot.encoding.byte(snapshot.file(), range.end);
        let wanted = Span::new(snapshot.document, start, end.max(start));
        for diagnostic in &snapshot.unit.diagnostics {
            let is_here = diagnostic
                .span
                .is_some_and(|span| snapshot.files().origin(span).touches(wanted));
            if is_here {
                actions.extend(fixes(workspace, snapshot, diagnostic));
                actions.extend(allow(workspace, snapshot, diagnostic));
            }
        }
    }
    if wants(only, FIX_ALL) {
        actions.extend(fix_all(workspace, snapshot));
    }
    actions.into_iter().map(CodeActionResponse::CodeAction).collect()
}

/// Whether a kind or one that contains it is wanted: `source` contains `source.fixAll`.
fn wants(only: &[CodeActionKind], kind: &str) -> bool {
    let contains = |wanted: &CodeActionKind| {
        let wanted = serde_json::to_value(wanted).unwrap_or_default();
        let wanted = wanted.as_str().unwrap_or_default();
        wanted.is_empty()
            || kind == wanted
            || kind
                .strip_prefix(wanted)
                .is_some_and(|rest| rest.starts_with('.'))
    };
    only.is_empty() || only.iter().any(contains)
}

fn action(
    workspace: &Workspace,
    title: String,
    kind: CodeActionKind,
    edits: &FileEdits,
    of: Option<LspDiagnostic>,
) -> CodeAction {
    CodeAction {
        title,
        kind: Some(kind),
        diagnostics: of.map(|diagnostic| vec![diagnostic]),
        is_preferred: None,
        disabled: None,
        edit: Some(workspace.workspace_edit(edits)),
        command: None,
        data: None,
        tags: None,
    }
}

/// The corrections of a diagnostic: those that it proposes, and of the first error the edit after which the
/// text compiles.
fn fixes(workspace: &Workspace, snapshot: &Snapshot, diagnostic: &Diagnostic) -> Vec<CodeAction> {
    let unit = &snapshot.unit;
    let of = converted(unit, snapshot.encoding, diagnostic);
    let mut found = diagnostic.fixes.clone();
    if let Some(whole) = whole_fix(snapshot, diagnostic)
        && !found.contains(&whole)
    {
        found.insert(0, whole);
    }
    let is_only = found.len() == 1;
    let actions = found.iter().filter_map(|fix| {
        let mut edits = FileEdits::default();
        if !edits.add_fix(unit, fix) {
            return None;
        }
        let title = capitalized(&fix.message);
        let action = action(workspace, title, CodeActionKind::QuickFix, &edits, of.clone());
        Some(CodeAction {
            is_preferred: is_only.then_some(true),
            ..action
        })
    });
    actions.collect()
}

/// The one edit after which the text compiles, if the diagnostic is its first error.
fn whole_fix(snapshot: &Snapshot, diagnostic: &Diagnostic) -> Option<toyproof_diagnostic::Fix> {
    let analysis = snapshot.analysis();
    // Common alone has no entry point, which the search requires.
    if analysis.stage == Stage::Common {
        return None;
    }
    let mut errors = analysis.diagnostics.iter();
    let first = errors.find(|one| one.severity == Severity::Error)?;
    if first.in_origin(snapshot.files()).span != diagnostic.span || first.code != diagnostic.code {
        return None;
    }
    let errors = Diagnostics::new(analysis.diagnostics.clone(), snapshot.files());
    let fix = single_edit(snapshot.files(), snapshot.analyzed(), &errors, snapshot.options())?;
    let mut in_origin = diagnostic.clone();
    in_origin.fixes = vec![fix];
    in_origin.in_origin(snapshot.files()).fixes.pop()
}

/// The action that applies every correction of the document's unit, if fewer errors and no new ones remain.
fn fix_all(workspace: &mut Workspace, snapshot: &Snapshot) -> Option<CodeAction> {
    let unit = &snapshot.unit;
    let mut edits = FileEdits::default();
    let mut count = 0;
    for fix in unit.diagnostics.iter().flat_map(|diagnostic| &diagnostic.fixes) {
        count += usize::from(edits.add_fix(unit, fix));
    }
    if edits.is_empty() {
        return None;
    }
    let after = workspace.edited(&edits).snapshot(&snapshot.uri)?.unit;
    let (old, new) = (&unit.diagnostics, &after.diagnostics);
    let is_old = |one: &Diagnostic| {
        old.iter()
            .any(|other| (other.code, &other.message) == (one.code, &one.message))
    };
    let is_better = errors(&after) < errors(unit) || errors(unit) == 0 && new.len() < old.len();
    let is_safe = new
        .iter()
        .filter(|one| one.severity == Severity::Error)
        .all(is_old);
    if !is_better || !is_safe {
        return None;
    }
    let title = match count {
        1 => "Apply the correction of toyproof".to_owned(),
        _ => format!("Apply all {count} corrections of toyproof"),
    };
    let kind = CodeActionKind::from(FIX_ALL.to_owned());
    Some(action(workspace, title, kind, &edits, None))
}

fn errors(unit: &Unit) -> usize {
    let errors = unit.diagnostics.iter();
    errors.filter(|one| one.severity == Severity::Error).count()
}

/// The action that allows a warning by a comment at the end of its line, if the comment has that effect.
fn allow(workspace: &mut Workspace, snapshot: &Snapshot, diagnostic: &Diagnostic) -> Option<CodeAction> {
    let code = diagnostic.code;
    if diagnostic.severity == Severity::Error || !code.can_be_allowed() {
        return None;
    }
    let span = snapshot.files().origin(diagnostic.span?);
    let file = snapshot.files().get(span.file);
    let bytes = file.line_range(file.line(span.start as usize))?;
    let line = file.text()[bytes.clone()].trim_end();
    let end = (bytes.start + line.len()) as u32;
    // A comment that is there already gets the code as another one.
    let (at, text) = match line.rfind(ALLOW) {
        Some(list) => {
            let close = list + line[list..].find(')')?;
            ((bytes.start + close) as u32, format!(", {code}"))
        }
        None if line.contains("//") || line.ends_with('\\') => return None,
        None => (end, format!(" // {ALLOW}{code})")),
    };
    let place = FilePlace::of(&snapshot.unit, Span::new(span.file, at, at))?;
    let mut edits = FileEdits::default();
    edits.add(place, &text);
    let after = workspace.edited(&edits).snapshot(&snapshot.uri)?.unit;
    let count = |unit: &Unit, code: Code| unit.diagnostics.iter().filter(|one| one.code == code).count();
    if count(&after, code) >= count(&snapshot.unit, code) || errors(&after) > 0 {
        return None;
    }
    let of = converted(&snapshot.unit, snapshot.encoding, diagnostic);
    let title = format!("Allow {code} on this line");
    Some(action(workspace, title, CodeActionKind::QuickFix, &edits, of))
}

/// The begin of the comment that allows warnings.
const ALLOW: &str = "toyproof: allow(";

fn capitalized(text: &str) -> String {
    let mut characters = text.chars();
    let first = characters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(characters).collect()
}
