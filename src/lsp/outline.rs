//! The symbols of a document, and those of all documents.

use std::collections::BTreeSet;

use lsp_types::{BaseSymbolInformation, DocumentSymbol, Location, Range, SymbolInformation, SymbolKind};
use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{Member, StructId, Type, VariableId, VariableKind};
use toyproof_glsl::{MacroDefinition, Resolution, ResolvedName};

use crate::describe;
use crate::encoding::Positions;
use crate::snapshot::Snapshot;

/// Maximum number of symbols of all documents that a query returns.
const MAX_WORKSPACE_SYMBOLS: usize = 500;

/// The functions, structures, global variables and macros of a document, in its order; members are below
/// their structure.
pub(crate) fn document_symbols(snapshot: &Snapshot) -> Vec<DocumentSymbol> {
    let declarations = snapshot.tokens().declarations();
    let globals: BTreeSet<VariableId> = snapshot.tree().global_variables().collect();
    let names = snapshot.analysis().names.iter();
    let mut at_names = snapshot.positions();
    let declared = names.filter_map(|name| of_name(snapshot, &declarations, &globals, name, &mut at_names));
    let definitions = snapshot.analysis().expansions().definitions().iter();
    let mut at_macros = snapshot.positions();
    let macros = definitions.filter_map(|definition| of_macro(snapshot, definition, &mut at_macros));
    let mut symbols: Vec<DocumentSymbol> = declared.chain(macros).collect();
    symbols.sort_by_key(|symbol| (symbol.range.start.line, symbol.range.start.character));
    // A name in a macro has a symbol for each of its uses.
    symbols.dedup();
    symbols
}

fn symbol(
    positions: &mut Positions<'_>,
    name: &str,
    kind: SymbolKind,
    detail: String,
    (whole, selected): (Span, Span),
) -> DocumentSymbol {
    let (start, selection_start) = (positions.at(whole.start), positions.at(selected.start));
    let selection_range = Range::new(selection_start, positions.at(selected.end));
    DocumentSymbol {
        name: name.to_owned(),
        detail: Some(detail),
        kind,
        tags: None,
        #[expect(deprecated, reason = "the structure of the protocol has the field")]
        deprecated: None,
        range: Range::new(start, positions.at(whole.end)),
        selection_range,
        children: None,
    }
}

/// The symbol of a name that is declared at global scope of the document.
fn of_name(
    snapshot: &Snapshot,
    declarations: &[(u32, u32)],
    globals: &BTreeSet<VariableId>,
    name: &ResolvedName,
    positions: &mut Positions<'_>,
) -> Option<DocumentSymbol> {
    if !name.declares || name.at.is_expanded() {
        return None;
    }
    let at = snapshot.in_document(name.at.span)?;
    let tree = snapshot.tree();
    let (text, kind, detail) = match name.resolution {
        Resolution::Function(id) => {
            let parameters = describe::parameters(tree, id).join(", ");
            let detail = format!("{} ({parameters})", tree.type_name(tree[id].return_type));
            (&tree[id].name, SymbolKind::Function, detail)
        }
        Resolution::Struct(id) => (&tree[id].name, SymbolKind::Struct, String::new()),
        Resolution::Variable(id) if globals.contains(&id) => {
            let kind = match tree[id].kind {
                VariableKind::Const => SymbolKind::Constant,
                _ => SymbolKind::Variable,
            };
            let value = tree[id].value.as_ref().map(|value| describe::value(tree, value));
            let value = value.map_or_else(String::new, |value| format!(" = {value}"));
            (&tree[id].name, kind, tree.type_name(tree[id].ty) + &value)
        }
        Resolution::Variable(_) | Resolution::Member(..) | Resolution::BuiltIn(_) => return None,
    };
    let index = declarations.partition_point(|(_, end)| *end < at.end);
    let declaration = declarations.get(index).filter(|(start, _)| *start <= at.start);
    let (start, end) = declaration.copied().unwrap_or((at.start, at.end));
    let whole = Span::new(at.file, start, end);
    let mut symbol = symbol(positions, text, kind, detail, (whole, at));
    if let Resolution::Struct(id) = name.resolution {
        symbol.children = Some(members(snapshot, id));
    }
    Some(symbol)
}

fn members(snapshot: &Snapshot, structure: StructId) -> Vec<DocumentSymbol> {
    let tree = snapshot.tree();
    let members = tree[structure].members.iter();
    let mut positions = snapshot.positions();
    let of_member = |member: &Member| {
        let at = snapshot.in_document(member.at.span)?;
        let detail = tree.type_name(member.ty);
        Some(symbol(
            &mut positions,
            &member.name,
            SymbolKind::Field,
            detail,
            (at, at),
        ))
    };
    members
        .filter(|member| member.ty != Type::Error)
        .filter_map(of_member)
        .collect()
}

fn of_macro(
    snapshot: &Snapshot,
    definition: &MacroDefinition,
    positions: &mut Positions<'_>,
) -> Option<DocumentSymbol> {
    let whole = snapshot.in_document(definition.extent)?;
    let at = snapshot.in_document(definition.at)?;
    let (kind, detail) = match &definition.parameters {
        Some(parameters) => (
            SymbolKind::Function,
            format!("#define ({})", parameters.join(", ")),
        ),
        None => (SymbolKind::Constant, "#define".to_owned()),
    };
    Some(symbol(positions, &definition.name, kind, detail, (whole, at)))
}

/// The symbols of documents whose names contain the characters of a query in their order, in any case.
pub(crate) fn workspace_symbols<'s>(
    snapshots: impl IntoIterator<Item = &'s Snapshot>,
    query: &str,
) -> Vec<SymbolInformation> {
    let mut found = Vec::new();
    for snapshot in snapshots {
        let container = snapshot.file().name().to_owned();
        let mut pending: Vec<(DocumentSymbol, Option<String>)> = document_symbols(snapshot)
            .into_iter()
            .rev()
            .map(|symbol| (symbol, None))
            .collect();
        while let Some((symbol, parent)) = pending.pop() {
            for child in symbol.children.into_iter().flatten().rev() {
                pending.push((child, Some(symbol.name.clone())));
            }
            if found.len() == MAX_WORKSPACE_SYMBOLS {
                return found;
            }
            if matches(query, &symbol.name) {
                found.push(SymbolInformation {
                    #[expect(deprecated, reason = "the structure of the protocol has the field")]
                    deprecated: None,
                    location: Location::new(snapshot.uri.clone(), symbol.selection_range),
                    base_symbol_information: BaseSymbolInformation {
                        name: symbol.name,
                        kind: symbol.kind,
                        tags: None,
                        container_name: parent.or_else(|| Some(container.clone())),
                    },
                });
            }
        }
    }
    found
}

/// Whether a name has the characters of a query in their order.
fn matches(query: &str, name: &str) -> bool {
    let mut rest = name.chars().map(|c| c.to_ascii_lowercase());
    query
        .chars()
        .all(|wanted| rest.any(|c| c == wanted.to_ascii_lowercase()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::of;

    fn shown(symbols: &[DocumentSymbol]) -> Vec<String> {
        let lines = symbols.iter().flat_map(|symbol| {
            let (start, end) = (symbol.range.start, symbol.range.end);
            let (sl, sc, el, ec) = (start.line, start.character, end.line, end.character);
            let detail = symbol.detail.as_deref().unwrap_or_default();
            let line = format!("{} {:?} {sl}:{sc}-{el}:{ec} {detail}", symbol.name, symbol.kind);
            let children = shown(symbol.children.as_deref().unwrap_or_default()).into_iter();
            std::iter::once(line).chain(children.map(|child| format!("  {child}")))
        });
        lines.collect()
    }

    const TEXT: &str = "#define PI 3.14 // 😀\r\nconst float TAU = 2.*PI, B = 1.;\r\n\
        struct Ray {\r\n\tvec3 o, d;\r\n} ray;\r\n\
        /* 😀 */ float f(vec3 p) {\r\n  float local = p.x;\r\n  return local;\r\n}\r\n\
        void mainImage(out vec4 c, in vec2 p) { c = ";

    #[test]
    fn symbols_are_hierarchical_also_in_half_typed_text() {
        let expected = [
            "PI Constant 0:8-0:15 #define",
            "TAU Constant 1:0-1:32 float = 6.28",
            "B Constant 1:0-1:32 float = 1.0",
            "Ray Struct 2:0-4:6 ",
            "  o Field 3:6-3:7 vec3",
            "  d Field 3:9-3:10 vec3",
            "ray Variable 2:0-4:6 Ray",
            "f Function 5:9-8:1 float (vec3 p)",
            "mainImage Function 9:0-9:43 void (out vec4 c, vec2 p)",
        ];
        assert_eq!(shown(&document_symbols(&of(TEXT))), expected);
    }

    #[test]
    fn symbols_of_a_workspace_match_in_order_of_characters() {
        let snapshots = [
            of(TEXT),
            of("float radiance;\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(0); }"),
        ];
        let names = |query| {
            let found = workspace_symbols(&snapshots, query).into_iter();
            let names = found.map(|symbol| symbol.base_symbol_information.name);
            names.collect::<Vec<_>>().join(" ")
        };
        assert_eq!(names("ra"), "Ray ray radiance");
        assert_eq!(names("mimg"), "mainImage mainImage");
        assert_eq!(names("d"), "d radiance");
        assert_eq!(names("zz"), "");
    }
}
