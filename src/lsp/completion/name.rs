//! Completions of words: names in scope, what the host and the language declare, types and keywords.

use std::collections::BTreeSet;

use lsp_types::CompletionItemKind;
use toyproof_glsl::tree::{BuiltInVariable, SamplerShape, Type, VariableId, VariableKind};
use toyproof_glsl::{Resolution, documentation};

use super::{Completer, Item, Place, Rank};
use crate::{describe, scope};

/// The keywords that an expression may have.
const IN_EXPRESSIONS: [&str; 2] = ["true", "false"];

/// The keywords with which a declaration at global scope may begin.
const AT_GLOBAL_SCOPE: [&str; 11] = [
    "const",
    "struct",
    "uniform",
    "varying",
    "precision",
    "highp",
    "mediump",
    "lowp",
    "in",
    "out",
    "layout",
];

/// The qualifiers of parameters.
const OF_PARAMETERS: [&str; 7] = ["in", "out", "inout", "const", "highp", "mediump", "lowp"];

/// The keywords with which a statement may begin, also those inside of `switch` and behind `if`.
const IN_STATEMENTS: [&str; 16] = [
    "if", "else", "for", "while", "do", "switch", "case", "default", "break", "continue", "return",
    "discard", "const", "highp", "mediump", "lowp",
];

impl Completer<'_> {
    pub(super) fn complete_word(&mut self, place: Place) {
        let has_values = matches!(place, Place::Statement | Place::Expression);
        self.add_visible(has_values);
        self.add_macros();
        if has_values {
            self.add_host_variables();
            self.add_functions();
        }
        self.add_types(place);
        let keywords: &[&str] = match place {
            Place::Global => &AT_GLOBAL_SCOPE,
            Place::Parameters => &OF_PARAMETERS,
            Place::Statement => &IN_STATEMENTS,
            Place::Expression => &[],
        };
        let values = IN_EXPRESSIONS.iter().filter(|_| has_values);
        let known = self.snapshot.keywords();
        let offered = keywords.iter().chain(values);
        for &keyword in offered.filter(|keyword| known.contains(*keyword)) {
            let mut item = Item::new(keyword, CompletionItemKind::Keyword, Rank::Keyword);
            item.documentation = documentation::of_word(keyword).map(str::to_owned);
            self.add(item);
        }
        if self.has_snippets() {
            self.add_snippets(place);
        }
    }

    /// Adds the names in scope: of overloads of a function, the name once.
    fn add_visible(&mut self, has_values: bool) {
        let expected = self.expected_type();
        let snapshot = self.snapshot;
        let tree = snapshot.tree();
        let mut of_functions = BTreeSet::new();
        for resolution in scope::visible(snapshot, self.at) {
            let (name, kind, rank, ty) = match resolution {
                Resolution::Variable(id) if has_values => {
                    let variable = &tree[id];
                    let at = variable.at.and_then(|at| snapshot.in_document(at.span));
                    if at.is_some_and(|at| self.is_in_initializer_of(at.start)) {
                        continue;
                    }
                    let (kind, rank) = kind_of_variable(variable.kind);
                    (&variable.name, kind, rank, Some(variable.ty))
                }
                Resolution::Struct(id) => {
                    let ty = Some(Type::Struct(id));
                    (&tree[id].name, CompletionItemKind::Struct, Rank::Function, ty)
                }
                Resolution::Function(id) if has_values => {
                    let name = &tree[id].name;
                    if !of_functions.insert(name.clone()) {
                        continue;
                    }
                    let ty = Some(tree[id].return_type);
                    (name, CompletionItemKind::Function, Rank::Function, ty)
                }
                _ => continue,
            };
            let mut item = Item::new(name, kind, rank);
            item.fits = expected.is_some() && ty == expected;
            item.detail = Some(match resolution {
                Resolution::Struct(_) => format!("struct {name}"),
                _ => describe::declaration(tree, resolution),
            });
            item.documentation = describe::documentation(snapshot, resolution, &mut self.comments);
            self.add(item);
        }
    }

    pub(super) fn add_macros(&mut self) {
        let snapshot = self.snapshot;
        let definitions = snapshot.analysis().expansions().definitions();
        let mut names = BTreeSet::new();
        let at = self.at;
        let before = definitions.iter().filter(|definition| definition.at.start < at);
        for definition in before.rev() {
            if !names.insert(&definition.name) {
                continue;
            }
            let kind = match definition.parameters {
                Some(_) => CompletionItemKind::Function,
                None => CompletionItemKind::Constant,
            };
            let mut item = Item::new(&definition.name, kind, Rank::Global);
            item.detail = Some(describe::macro_definition(snapshot, definition));
            item.documentation = self.comments.at(definition.at);
            self.add(item);
        }
    }

    /// Adds the parameters of the macro whose name is the token at `name`.
    pub(super) fn add_macro_parameters(&mut self, name: usize) {
        let token = self.tokens.code()[name];
        let definitions = self.snapshot.analysis().expansions().definitions();
        let start = self.snapshot.analyzed_byte(token.start);
        let definition = definitions
            .iter()
            .find(|definition| Some(definition.at.start) == start);
        for parameter in definition
            .and_then(|definition| definition.parameters.as_ref())
            .into_iter()
            .flatten()
        {
            self.add(Item::new(parameter, CompletionItemKind::Variable, Rank::Local));
        }
    }

    /// Adds the inputs and built-in variables that exist without a declaration.
    fn add_host_variables(&mut self) {
        let expected = self.expected_type();
        let (analysis, tree) = (self.snapshot.analysis(), self.snapshot.tree());
        for (id, variable) in tree.variables.iter() {
            let exists = match variable.kind {
                VariableKind::Input(_) | VariableKind::Channel(_) => {
                    analysis.dialect.has_input(analysis.stage, &variable.name)
                }
                VariableKind::BuiltIn(_) | VariableKind::BuiltInConstant => true,
                _ => false,
            };
            if variable.at.is_none() && exists {
                self.add_host_variable(id, expected);
            }
        }
    }

    fn add_host_variable(&mut self, id: VariableId, expected: Option<Type>) {
        let variable = &self.snapshot.tree()[id];
        let rank = match variable.kind {
            VariableKind::Input(_) | VariableKind::Channel(_) => Rank::Input,
            VariableKind::BuiltIn(BuiltInVariable::FragCoord) => Rank::BuiltIn,
            _ => Rank::Keyword,
        };
        let (kind, _) = kind_of_variable(variable.kind);
        let mut item = Item::new(&variable.name, kind, rank);
        // Any channel can be looked up: its shape follows from how it is.
        let any_channel = |ty| matches!((ty, variable.ty), (Type::Sampler(_), Type::Sampler(_)));
        item.fits = expected.is_some_and(|ty| ty == variable.ty || any_channel(ty));
        let resolution = Resolution::Variable(id);
        item.detail = Some(describe::declaration(self.snapshot.tree(), resolution));
        item.documentation = describe::documentation(self.snapshot, resolution, &mut self.comments);
        self.add(item);
    }

    fn add_functions(&mut self) {
        let version = self.snapshot.analysis().version;
        for (name, function) in version.functions(self.snapshot.options().lenient) {
            let mut item = Item::new(name, CompletionItemKind::Function, Rank::BuiltIn);
            item.detail = Some(describe::built_in_declaration(function, name, &[]));
            item.documentation = Some(function.documentation().text.to_owned());
            self.add(item);
        }
    }

    fn add_types(&mut self, place: Place) {
        for (name, ty) in self.snapshot.types() {
            let is_long_name =
                matches!(ty, Type::Matrix { columns, rows } if columns == rows) && name.len() > 4;
            let is_value = !matches!(ty, Type::Void | Type::Sampler(_));
            let is_usual = match ty {
                Type::Void => place == Place::Global,
                Type::Sampler(sampler) => {
                    place != Place::Expression && sampler.shape != SamplerShape::D2Array
                }
                _ => true,
            };
            if is_long_name || !is_usual || (place == Place::Statement && !is_value) {
                continue;
            }
            let mut item = Item::new(name, CompletionItemKind::Class, Rank::Type);
            item.documentation = documentation::of_type(ty);
            self.add(item);
        }
    }
}

fn kind_of_variable(kind: VariableKind) -> (CompletionItemKind, Rank) {
    match kind {
        VariableKind::Local => (CompletionItemKind::Variable, Rank::Local),
        VariableKind::Parameter(_) => (CompletionItemKind::Variable, Rank::Parameter),
        VariableKind::Const | VariableKind::BuiltInConstant => (CompletionItemKind::Constant, Rank::Global),
        _ => (CompletionItemKind::Variable, Rank::Global),
    }
}
