//! What each word of a document is, for editors to color: functions, variables by their scope, macros,
//! members, and code that is not compiled.

use std::collections::{BTreeMap, HashMap, HashSet};

use lsp_types::{SemanticToken, SemanticTokens, SemanticTokensLegend};
use toyproof_diagnostic::Span;
use toyproof_glsl::Resolution;
use toyproof_glsl::tree::{Type, VariableId, VariableKind};

use crate::snapshot::Snapshot;
use crate::tokens::{Token, TokenKind};

macro_rules! legend {
    ($($name:ident $text:literal,)*) => {
        /// The kinds of tokens.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        enum Kind {
            $($name,)*
        }

        /// Their names in the protocol, in the same order.
        const KINDS: &[&str] = &[$($text,)*];
    };
}

legend! {
    Keyword "keyword",
    Type "type",
    Struct "struct",
    Function "function",
    Method "method",
    Macro "macro",
    Parameter "parameter",
    Variable "variable",
    Property "property",
    Number "number",
    Comment "comment",
}

/// The names of the modifiers, each a bit of its index.
const MODIFIERS: &[&str] = &[
    "declaration",
    "readonly",
    "defaultLibrary",
    "global",
    "uniform",
    "swizzle",
];
const DECLARATION: u32 = 1 << 0;
const READONLY: u32 = 1 << 1;
const DEFAULT_LIBRARY: u32 = 1 << 2;
const GLOBAL: u32 = 1 << 3;
const UNIFORM: u32 = 1 << 4;
const SWIZZLE: u32 = 1 << 5;

/// The names of kinds and modifiers.
pub(crate) fn legend() -> SemanticTokensLegend {
    let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    SemanticTokensLegend {
        token_types: owned(KINDS),
        token_modifiers: owned(MODIFIERS),
    }
}

/// The tokens of a document, or those that overlap a part of its bytes.
pub(crate) fn semantic_tokens(snapshot: &Snapshot, part: Option<(u32, u32)>) -> SemanticTokens {
    let (from, to) = part.unwrap_or((0, u32::MAX));
    let mut classified = classify(snapshot);
    classified.retain(|token| token.start < to && from < token.end);
    classified.sort_by_key(|token| token.start);
    let file = snapshot.file();
    let mut positions = snapshot.positions();
    let mut data = Vec::with_capacity(classified.len());
    let (mut line, mut column) = (0, 0);
    for token in classified {
        // A token of the protocol lies on one line.
        let mut start = token.start as usize;
        let text = file.text().get(start..token.end as usize).unwrap_or_default();
        for part in text.split_inclusive('\n') {
            let shown = part.trim_end_matches(['\r', '\n']);
            let at = positions.at(start as u32);
            start += part.len();
            if shown.is_empty() {
                continue;
            }
            let delta_line = at.line - line;
            data.push(SemanticToken {
                delta_line,
                delta_start: at.character - if delta_line == 0 { column } else { 0 },
                length: snapshot.encoding.length(shown),
                token_type: token.kind as u32,
                token_modifiers_bitset: token.modifiers,
            });
            (line, column) = (at.line, at.character);
        }
    }
    SemanticTokens {
        result_id: None,
        data,
    }
}

/// A token with its bytes in the document.
#[derive(Debug, Clone, Copy)]
struct Classified {
    start: u32,
    end: u32,
    kind: Kind,
    modifiers: u32,
}

fn classify(snapshot: &Snapshot) -> Vec<Classified> {
    let names = Names::new(snapshot);
    let tokens = snapshot.tokens();
    let mut found = Vec::new();
    let mut add = |token: &Token<'_>, kind, modifiers| {
        found.push(Classified {
            start: token.start,
            end: token.end(),
            kind,
            modifiers,
        });
    };
    for comment in tokens.comments() {
        add(comment, Kind::Comment, 0);
    }
    let mut before: Option<&Token<'_>> = None;
    for token in tokens.code() {
        if names.is_skipped(token.start) && !token.is_in_directive {
            add(token, Kind::Comment, 0);
        } else if let Some((kind, modifiers)) = names.class(token, before) {
            add(token, kind, modifiers);
        }
        before = Some(token);
    }
    found
}

/// What the names of a document are.
struct Names<'s> {
    snapshot: &'s Snapshot,
    /// The resolved names by their first byte in the document, and whether they are declared there.
    resolved: HashMap<u32, (Resolution, bool)>,
    /// The names of macros with the first byte of the document at which they are defined.
    macros: BTreeMap<&'s str, u32>,
    words: HashSet<&'static str>,
    types: HashMap<String, Type>,
    /// The parts that conditions skip, in order.
    skipped: Vec<(u32, u32)>,
}

impl<'s> Names<'s> {
    fn new(snapshot: &'s Snapshot) -> Self {
        let analysis = snapshot.analysis();
        let mut resolved = HashMap::new();
        for name in &analysis.names {
            // In the body of a macro, what a name is at the first use.
            if let Some(at) = snapshot.in_document(name.at.spelling) {
                resolved
                    .entry(at.start)
                    .or_insert((name.resolution, name.declares));
            }
        }
        let expansions = analysis.expansions();
        let mut macros = BTreeMap::new();
        for definition in expansions.definitions() {
            // Those of Common and of included files are defined everywhere.
            let start = snapshot.in_document(definition.at).map_or(0, |at| at.start);
            macros.entry(&*definition.name).or_insert(start);
        }
        let skipped = expansions.skipped().iter();
        let skipped = skipped.filter_map(|&span: &Span| snapshot.in_document(span));
        Self {
            snapshot,
            resolved,
            macros,
            words: snapshot.keywords().into_iter().collect(),
            types: snapshot.types().into_iter().collect(),
            skipped: skipped.map(|span| (span.start, span.end)).collect(),
        }
    }

    fn is_skipped(&self, byte: u32) -> bool {
        let after = self.skipped.partition_point(|(start, _)| *start <= byte);
        let before = after.checked_sub(1).map(|index| self.skipped[index]);
        before.is_some_and(|(_, end)| byte < end)
    }

    fn class(&self, token: &Token<'_>, before: Option<&Token<'_>>) -> Option<(Kind, u32)> {
        match token.kind {
            TokenKind::Number => return Some((Kind::Number, 0)),
            TokenKind::Symbol if token.is("#") && token.is_in_directive => return Some((Kind::Keyword, 0)),
            TokenKind::Symbol | TokenKind::Comment => return None,
            TokenKind::Word => {}
        }
        let follows = |text: &str| before.is_some_and(|before| before.is(text));
        if token.is_in_directive && follows("#") {
            return Some((Kind::Keyword, 0));
        }
        if let Some(&start) = self.macros.get(token.text)
            && token.start >= start
        {
            let is_declared = token.is_in_directive && follows("define");
            return Some((Kind::Macro, if is_declared { DECLARATION } else { 0 }));
        }
        if let Some(&(resolution, declares)) = self.resolved.get(&token.start) {
            let (kind, modifiers) = self.resolution(resolution);
            return Some((kind, modifiers | if declares { DECLARATION } else { 0 }));
        }
        if follows(".") {
            return of_member(token.text);
        }
        if let Some(ty) = self.types.get(token.text) {
            let modifiers = if matches!(ty, Type::Void) {
                0
            } else {
                DEFAULT_LIBRARY
            };
            return Some((Kind::Type, modifiers));
        }
        self.words.contains(token.text).then_some((Kind::Keyword, 0))
    }

    fn resolution(&self, resolution: Resolution) -> (Kind, u32) {
        match resolution {
            Resolution::Variable(id) => self.variable(id),
            Resolution::Struct(_) => (Kind::Struct, 0),
            Resolution::Member(..) => (Kind::Property, 0),
            Resolution::Function(_) => (Kind::Function, 0),
            Resolution::BuiltIn(_) => (Kind::Function, DEFAULT_LIBRARY),
        }
    }

    fn variable(&self, id: VariableId) -> (Kind, u32) {
        let tree = self.snapshot.tree();
        match tree[id].kind {
            VariableKind::Local => (Kind::Variable, 0),
            VariableKind::Parameter(_) => (Kind::Parameter, 0),
            VariableKind::Const => (Kind::Variable, READONLY),
            VariableKind::Global | VariableKind::Output => (Kind::Variable, GLOBAL),
            VariableKind::Uniform | VariableKind::Varying => (Kind::Variable, READONLY | GLOBAL | UNIFORM),
            VariableKind::Input(_) | VariableKind::Channel(_) => {
                (Kind::Variable, READONLY | GLOBAL | UNIFORM | DEFAULT_LIBRARY)
            }
            VariableKind::BuiltIn(_) | VariableKind::BuiltInConstant => {
                (Kind::Variable, READONLY | GLOBAL | DEFAULT_LIBRARY)
            }
        }
    }
}

/// What a name behind a `.` is that is not a member of a structure.
fn of_member(text: &str) -> Option<(Kind, u32)> {
    if text == "length" {
        return Some((Kind::Method, DEFAULT_LIBRARY));
    }
    let is_swizzle = |set: &str| text.len() <= 4 && text.chars().all(|c| set.contains(c));
    let sets = ["xyzw", "rgba", "stpq"];
    sets.into_iter()
        .any(is_swizzle)
        .then_some((Kind::Property, SWIZZLE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::of;

    /// Each token as it is in the text, with its kind and modifiers.
    fn tokens(text: &str, part: Option<(u32, u32)>) -> Vec<String> {
        let snapshot = of(text);
        let (mut line, mut column) = (0, 0);
        let mut found = Vec::new();
        for token in semantic_tokens(&snapshot, part).data {
            line += token.delta_line;
            column = token.delta_start + if token.delta_line == 0 { column } else { 0 };
            let at = |column| {
                let position = lsp_types::Position::new(line, column);
                snapshot.encoding.byte(snapshot.file(), position) as usize
            };
            let text = &snapshot.file().text()[at(column)..at(column + token.length)];
            let modifiers = MODIFIERS.iter().enumerate();
            let modifiers = modifiers
                .filter(|(index, _)| token.token_modifiers_bitset & (1 << index) != 0)
                .map(|(_, name)| format!(".{name}"));
            let modifiers = modifiers.collect::<Vec<_>>().concat();
            found.push(format!("{text}:{}{modifiers}", KINDS[token.token_type as usize]));
        }
        found
    }

    #[test]
    fn names_have_their_kinds() {
        let text = "#define SQ(x) (x*x)\r\nstruct R { vec3 o; };\r\nconst float K = 1.;\r\nfloat g;\r\n\
            float f(R r) { return SQ(r.o.xy).x; }\r\n\
            void mainImage(out vec4 c, in vec2 p) { R r; r.o = vec3(K); c = vec4(sin(iTime) + g * f(r)); }";
        let found = tokens(text, None);
        let has = |wanted: &str| assert!(found.iter().any(|token| token == wanted), "{wanted}: {found:?}");
        for wanted in [
            "#:keyword",
            "define:keyword",
            "SQ:macro.declaration",
            "SQ:macro",
            "R:struct.declaration",
            "R:struct",
            "o:property.declaration",
            "o:property",
            "xy:property.swizzle",
            "K:variable.declaration.readonly",
            "K:variable.readonly",
            "g:variable.global",
            "f:function.declaration",
            "f:function",
            "r:parameter.declaration",
            "r:variable.declaration",
            "return:keyword",
            "vec3:type.defaultLibrary",
            "void:type",
            "sin:function.defaultLibrary",
            "iTime:variable.readonly.defaultLibrary.global.uniform",
            "1.:number",
        ] {
            has(wanted);
        }
    }

    #[test]
    fn skipped_code_and_comments_are_comments() {
        let text = "/* 😀\r\n b */ int a;\n#if 0\nint b;\n#else\nint c;\n#endif\n// d";
        let expected = [
            "/* 😀:comment",
            " b */:comment",
            "int:type.defaultLibrary",
            "a:variable.declaration.global",
            "#:keyword",
            "if:keyword",
            "0:number",
            "int:comment",
            "b:comment",
            ";:comment",
            "#:keyword",
            "else:keyword",
            "int:type.defaultLibrary",
            "c:variable.declaration.global",
            "#:keyword",
            "endif:keyword",
            "// d:comment",
        ];
        assert_eq!(tokens(text, None), expected);
    }

    #[test]
    fn a_part_has_the_tokens_that_overlap_it() {
        assert_eq!(
            tokens("int a;\nint bc;\nint d;", Some((11, 12))),
            ["bc:variable.declaration.global"]
        );
    }
}
