//! Renaming, checked by the front end before it is offered: afterwards each shader must have the same errors,
//! and every name must denote what it denoted.

use std::rc::Rc;

use lsp_types::{PrepareRenamePlaceholder, PrepareRenameResult, WorkspaceEdit};
use toyproof_diagnostic::{Severity, Span};
use toyproof_glsl::lexemes;

use crate::edits::FileEdits;
use crate::snapshot::Snapshot;
use crate::symbol::{FilePlace, Symbol};
use crate::unit::{Unit, UnitText};
use crate::workspace::Workspace;

/// What a name denotes for a renaming.
enum Target {
    /// An entity, whose occurrences are those that the front end resolved.
    Entity(Symbol),
    /// A macro. All tokens of its spelling are renamed: a new spelling that occurs nowhere keeps what the
    /// preprocessor does.
    Macro(String),
}

/// The range and the name that would be renamed.
///
/// # Errors
/// Why it cannot be renamed.
pub(crate) fn prepare(snapshot: &Snapshot, at: u32) -> Result<PrepareRenameResult, String> {
    let (_, span) = target(snapshot, at)?;
    let name = snapshot.files().text(span).to_owned();
    let range = snapshot.range(span).ok_or("this name is in another file")?;
    let placeholder = PrepareRenamePlaceholder::new(range, name);
    Ok(PrepareRenameResult::PrepareRenamePlaceholder(placeholder))
}

fn target(snapshot: &Snapshot, at: u32) -> Result<(Target, Span), String> {
    match Symbol::at(snapshot, at) {
        Some((Symbol::Given(name), _)) => Err(format!("`{name}` is not declared in this shader")),
        Some((symbol, span)) if !is_macro(snapshot, snapshot.files().text(span)) => {
            Ok((Target::Entity(symbol), span))
        }
        _ => {
            let span = word_at(snapshot, at).ok_or("there is no name here")?;
            let name = snapshot.files().text(span);
            if is_macro(snapshot, name) {
                Ok((Target::Macro(name.to_owned()), span))
            } else {
                Err(format!(
                    "`{name}` cannot be renamed: nothing in this shader declares it"
                ))
            }
        }
    }
}

fn is_macro(snapshot: &Snapshot, name: &str) -> bool {
    let mut definitions = snapshot.analysis().expansions().definitions().iter();
    definitions.any(|definition| definition.name == name)
}

/// The token with letters at a byte of the analyzed text, or the one that ends there.
fn word_at(snapshot: &Snapshot, at: u32) -> Option<Span> {
    let lexemes = lexemes(snapshot.files(), snapshot.analyzed());
    let here = lexemes.iter().map(|lexeme| lexeme.span);
    let mut here = here.filter(|span| span.start <= at && at <= span.end);
    here.rfind(|&span| is_name(snapshot.files().text(span)))
}

fn is_name(text: &str) -> bool {
    let is_in_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.chars().all(is_in_name) && text.starts_with(|c: char| !c.is_ascii_digit())
}

/// The edits that rename what is at a byte of the analyzed text.
///
/// # Errors
/// Why it cannot be renamed so.
pub(crate) fn rename(
    workspace: &mut Workspace,
    snapshot: &Snapshot,
    at: u32,
    new_name: &str,
) -> Result<WorkspaceEdit, String> {
    let (target, span) = target(snapshot, at)?;
    if !is_name(new_name) {
        return Err(format!("`{new_name}` is not a name"));
    }
    let old_name = snapshot.files().text(span).to_owned();
    let edits = match target {
        Target::Entity(symbol) => edits_of_entity(workspace, &symbol, &old_name, new_name)?,
        Target::Macro(name) => edits_of_macro(workspace, &name, new_name)?,
    };
    let before = workspace.units();
    let after = workspace.edited(&edits).units();
    for (before, after) in before.iter().zip(&after) {
        same(before, after, new_name)?;
    }
    Ok(workspace.workspace_edit(&edits))
}

fn edits_of_entity(
    workspace: &mut Workspace,
    symbol: &Symbol,
    old_name: &str,
    new_name: &str,
) -> Result<FileEdits, String> {
    let mut edits = FileEdits::default();
    let occurrences = symbol.occurrences(workspace);
    for unit in workspace.units() {
        refuse_uncompiled(&unit, symbol, old_name)?;
    }
    for (place, _) in occurrences {
        edits.add(place, new_name);
    }
    Ok(edits)
}

/// Refuses to rename an entity at global scope whose name is also in text that the preprocessor did not
/// compile, such as a branch of `#if` or the replacement of a macro that is not used: what it means there is
/// not known.
fn refuse_uncompiled(unit: &Unit, symbol: &Symbol, name: &str) -> Result<(), String> {
    for text in &unit.texts {
        if !is_global(unit, text, symbol) {
            continue;
        }
        let resolved = |span: Span| {
            let names = text.analysis.names.iter();
            names.map(|name| name.at.spelling).any(|at| at == span)
        };
        let all = lexemes(&unit.files, text.whole);
        for pair in all.windows(2) {
            let [before, lexeme] = pair else { continue };
            let is_selected = unit.files.text(before.span) == ".";
            if unit.files.text(lexeme.span) == name && !is_selected && !resolved(lexeme.span) {
                let line = unit.files.position(lexeme.span).line;
                let file = unit.files.name(lexeme.span);
                return Err(format!(
                    "`{name}` is also used at {file}:{line}, which is not compiled: what it means there is not known"
                ));
            }
        }
    }
    Ok(())
}

/// Whether a text declares the entity at global scope.
fn is_global(unit: &Unit, text: &UnitText, symbol: &Symbol) -> bool {
    let tree = text.analysis.tree();
    let mut globals = text
        .analysis
        .visibilities
        .iter()
        .filter(|visible| visible.depth == 0);
    globals.any(|visible| Symbol::of(unit, tree, visible.resolution).as_ref() == Some(symbol))
}

fn edits_of_macro(workspace: &mut Workspace, name: &str, new_name: &str) -> Result<FileEdits, String> {
    let mut edits = FileEdits::default();
    for unit in workspace.units() {
        let defines = |text: &UnitText| {
            let mut definitions = text.analysis.expansions().definitions().iter();
            definitions.any(|definition| definition.name == name)
        };
        if !unit.texts.iter().any(defines) {
            continue;
        }
        for text in &unit.texts {
            for lexeme in lexemes(&unit.files, text.whole) {
                let found = unit.files.text(lexeme.span);
                if found == new_name {
                    return Err(format!(
                        "`{new_name}` is already used in {}",
                        unit.files.name(lexeme.span)
                    ));
                }
                if found == name {
                    let place = FilePlace::of(&unit, lexeme.span);
                    let place = place.ok_or_else(|| format!("`{name}` is declared by the host"))?;
                    edits.add(place, new_name);
                }
            }
        }
    }
    Ok(edits)
}

/// Refuses a renaming after which a shader has another error, or a name denotes something else.
fn same(before: &Rc<Unit>, after: &Rc<Unit>, new_name: &str) -> Result<(), String> {
    let errors = |unit: &Unit| {
        let errors = unit
            .diagnostics
            .iter()
            .filter(|one| one.severity == Severity::Error);
        errors.map(|one| one.code).collect::<Vec<_>>()
    };
    let (old, new) = (errors(before), errors(after));
    if old != new {
        let mut added = after
            .diagnostics
            .iter()
            .filter(|one| one.severity == Severity::Error);
        let added = added.find(|one| !old.contains(&one.code));
        let reason = added.map_or("other errors", |one| &one.message);
        return Err(format!("renaming it to `{new_name}` is an error: {reason}"));
    }
    for (old, new) in before.texts.iter().zip(&after.texts) {
        let (old, new) = (&old.analysis, &new.analysis);
        let is_same_host =
            (old.dialect, old.version, old.channels) == (new.dialect, new.version, new.channels);
        let entry = |analysis: &toyproof_glsl::Analysis| analysis.checked().map(|checked| checked.main_image);
        let mut names = old.names.iter().zip(&new.names);
        let keeps = |(old, new): (&toyproof_glsl::ResolvedName, &toyproof_glsl::ResolvedName)| {
            (old.resolution, old.declares) == (new.resolution, new.declares)
        };
        let is_same = old.names.len() == new.names.len()
            && names.all(keeps)
            && is_same_host
            && entry(old) == entry(new);
        if !is_same {
            return Err(format!(
                "renaming it to `{new_name}` changes what another name denotes"
            ));
        }
    }
    Ok(())
}
