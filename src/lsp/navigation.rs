//! Definitions, references and highlights of the name at a place.

use lsp_types::{
    Definition, DefinitionResponse, DocumentHighlight, DocumentHighlightKind, Location, Range, Uri,
};
use toyproof_glsl::Resolution;

use crate::snapshot::Snapshot;
use crate::symbol::{FilePlace, Symbol};
use crate::workspace::Workspace;

/// Where the name at a byte of the analyzed text is declared: a function where it is defined, a macro at its
/// `#define`.
pub(crate) fn definition(snapshot: &Snapshot, at: u32) -> Option<DefinitionResponse> {
    let found = match snapshot.name_at(at) {
        Some(name) => declarations(snapshot, name.resolution),
        None => Vec::new(),
    };
    let found = if found.is_empty() {
        macro_definition(snapshot, at)?
    } else {
        found
    };
    Some(DefinitionResponse::Definition(Definition::LocationList(found)))
}

fn declarations(snapshot: &Snapshot, resolution: Resolution) -> Vec<Location> {
    let tree = snapshot.tree();
    let at = match resolution {
        Resolution::Variable(id) => tree[id].at,
        Resolution::Struct(id) => Some(tree[id].at),
        Resolution::Member(id, member) => Some(tree[id].members[member].at),
        Resolution::Function(id) => Some(tree[id].at),
        Resolution::BuiltIn(_) => None,
    };
    at.and_then(|at| snapshot.location(at.spelling))
        .into_iter()
        .collect()
}

/// The definition of the outermost macro whose use is at a byte of the analyzed text.
fn macro_definition(snapshot: &Snapshot, at: u32) -> Option<Vec<Location>> {
    let expansions = snapshot.analysis().expansions();
    let covering = expansions
        .uses()
        .filter(|used| used.start <= at && at <= used.end);
    let used = covering.min_by_key(|used| used.end - used.start)?;
    let extent = expansions.definition_at(used)?;
    snapshot.location(extent).map(|location| vec![location])
}

/// Where the name at a byte of the analyzed text stands, in all open shaders.
pub(crate) fn references(
    workspace: &mut Workspace,
    snapshot: &Snapshot,
    at: u32,
    with_declaration: bool,
) -> Option<Vec<Location>> {
    let (symbol, _) = Symbol::at(snapshot, at)?;
    let found = symbol.occurrences(workspace).into_iter();
    let found = found.filter(|(_, access)| with_declaration || !access.declares);
    let locations = found.filter_map(|(place, _)| {
        let range = workspace.range_of(&place)?;
        Some(Location::new(Uri(place.uri), range))
    });
    Some(locations.collect())
}

/// Where the name at a byte of the analyzed text stands in its document.
pub(crate) fn highlights(
    workspace: &mut Workspace,
    snapshot: &Snapshot,
    at: u32,
) -> Option<Vec<DocumentHighlight>> {
    let (symbol, _) = Symbol::at(snapshot, at)?;
    let found = symbol.occurrences(workspace).into_iter();
    let here = found.filter(|(place, _)| place.uri == snapshot.uri.0);
    let highlights = here.map(|(FilePlace { start, end, .. }, access)| {
        let kind = if access.writes {
            DocumentHighlightKind::Write
        } else {
            DocumentHighlightKind::Read
        };
        let range: Range = snapshot.document_range(start, end);
        DocumentHighlight::new(range, Some(kind))
    });
    Some(highlights.collect())
}
