//! Scopes: name lookup (§4.2), and diagnostics for unknown names.

use std::collections::HashMap;

use toyproof_diagnostic::{Code, Diagnostic, Fix, Span, nearest};

use super::Checker;
use crate::foreign::Foreign;
use crate::keywords::Word;
use crate::stage::Stage;
use crate::token::Symbol;
use crate::tree::{BuiltIn, ExprId, FunctionId, Place, StructId, Type, VariableId};

/// The entity that a name denotes. Types, variables and functions share one namespace (§4.2.2).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Entity {
    Variable(VariableId),
    Struct(StructId),
    /// All overloads of a function.
    Functions(Vec<FunctionId>),
}

/// The open scopes, innermost last; the outermost is the global scope.
#[derive(Debug)]
pub(super) struct Scopes {
    /// The entities of each name with the depth of the declaring scope, innermost last.
    entities: HashMap<Symbol, Vec<(usize, Entity)>>,
    /// The names that each scope declared.
    declared: Vec<Vec<Symbol>>,
}

impl Default for Scopes {
    fn default() -> Self {
        Self {
            entities: HashMap::new(),
            declared: vec![Vec::new()],
        }
    }
}

impl Scopes {
    pub(super) fn open(&mut self) {
        self.declared.push(Vec::new());
    }

    pub(super) fn close(&mut self) {
        for name in self.declared.pop().unwrap_or_default() {
            if let Some(entities) = self.entities.get_mut(&name) {
                entities.pop();
            }
        }
    }

    pub(super) fn is_global(&self) -> bool {
        self.declared.len() == 1
    }

    /// The entity that the name denotes.
    pub(super) fn find(&self, name: Symbol) -> Option<&Entity> {
        self.entities.get(&name)?.last().map(|(_, entity)| entity)
    }

    /// Every visible name, in no particular order.
    pub(super) fn names(&self) -> impl Iterator<Item = (Symbol, &Entity)> {
        self.entities
            .iter()
            .filter_map(|(&name, entities)| Some((name, &entities.last()?.1)))
    }

    /// The entity that the innermost scope itself declares for the name.
    pub(super) fn find_here(&self, name: Symbol) -> Option<&Entity> {
        let (depth, entity) = self.entities.get(&name)?.last()?;
        (*depth == self.declared.len()).then_some(entity)
    }

    /// Declares the name in the innermost scope, replacing an earlier declaration there.
    pub(super) fn declare(&mut self, name: Symbol, entity: Entity) {
        let depth = self.declared.len();
        let entities = self.entities.entry(name).or_default();
        match entities.last_mut() {
            Some((at, old)) if *at == depth => *old = entity,
            _ => {
                entities.push((depth, entity));
                if let Some(scope) = self.declared.last_mut() {
                    scope.push(name);
                }
            }
        }
    }
}

// Unknown names, and suggestions for them.

/// Makes an error about a name that is probably a misspelling of `near`.
pub(super) fn did_you_mean(code: Code, at: Place, message: &str, near: Option<&str>) -> Diagnostic {
    let Some(near) = near else {
        return code.at(at, message);
    };
    let question = format!("did you mean `{near}`?");
    code.at(at, format!("{message}; {question}"))
        .fix(Fix::new(question, at.spelling, near))
}

/// The help on names that ShaderToy's other tabs may declare: it puts the text of Common in front of each.
const OTHER_TAB: &str =
    "if another tab, such as Common, declares it, put that tab's text in front of this one";

/// Whether a name is written like those of macros and constants.
fn is_constant_name(name: &str) -> bool {
    name.len() > 1 && !name.contains(|c: char| c.is_ascii_lowercase())
}

/// A name that was reported as undeclared.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownName {
    name: Symbol,
    at: Place,
    is_call: bool,
}

impl Checker<'_> {
    /// Reports an undeclared variable, once in each function.
    pub(super) fn undeclared(&mut self, name: Symbol, at: Place) -> ExprId {
        self.report_undeclared(name, at, None)
    }

    /// Reports an undeclared function, once in each function.
    pub(super) fn undeclared_function(&mut self, name: Symbol, at: Place, call: Place) -> ExprId {
        self.report_undeclared(name, at, Some(call))
    }

    fn report_undeclared(&mut self, name: Symbol, at: Place, call: Option<Place>) -> ExprId {
        let text = self.text(name);
        if let Some(value) = self.implicit_input(text).filter(|_| call.is_none()) {
            return self.host_input(value, at);
        }
        let (variables, functions) = self.names_in_scope();
        let (message, first, second) = match call {
            Some(_) => (format!("unknown function `{text}`"), functions, variables),
            None => (format!("`{text}` is not declared"), variables, functions),
        };
        let near = nearest(text, first).or_else(|| nearest(text, second));
        let near = near.map(str::to_owned);
        let known = self
            .function
            .as_mut()
            .is_some_and(|context| !context.undeclared.insert(name));
        if known || self.is_maybe_declared(name) {
            return self.error_expr(at);
        }
        if self.is_input_of_other_tabs(self.text(name)) {
            self.report(self.input_of_other_tabs(name, at));
            return self.error_expr(at);
        }
        let diagnostic = match Foreign::named(self.text(name)) {
            Some(foreign) => {
                let diagnostic = Code::Undeclared.at(at, message);
                let plain_call = call.filter(|call| !at.is_expanded() && !call.is_expanded());
                // The point before the `)`.
                let call_end = plain_call.map(|call| {
                    let end = call.span.end.saturating_sub(1);
                    Span::new(call.span.file, end, end)
                });
                foreign.advise(diagnostic, at, call_end).note(foreign.note())
            }
            None => did_you_mean(Code::Undeclared, at, &message, near.as_deref()),
        };
        self.report(diagnostic);
        self.unknown.push(UnknownName {
            name,
            at,
            is_call: call.is_some(),
        });
        self.error_expr(at)
    }

    /// The error about an input that this tab does not have.
    fn input_of_other_tabs(&self, name: Symbol, at: Place) -> Diagnostic {
        let (input, tab) = (self.text(name), self.stage.tab());
        let diagnostic = Code::InputOfOtherTab.at(at, format!("`{input}` is not an input of {tab}"));
        if self.stage == Stage::Common {
            diagnostic
                .note("ShaderToy also compiles Common alone, with the inputs `iDate` and `iSampleRate` only")
                .help("pass it to the function as an argument, or use it in a macro")
        } else {
            diagnostic.note(format!(
                "{tab} has the inputs `iDate`, `iSampleRate`, `iChannelTime`, `iChannelResolution` and `iChannel0` to `iChannel3`"
            ))
        }
    }

    /// After parsing: changes the errors about names that are declared later in the text accordingly. The
    /// first name that is declared nowhere, and resembles nothing, may be declared in another tab.
    pub(super) fn find_late_declarations(&mut self) {
        let mut names_tab = false;
        for UnknownName { name, at, is_call } in std::mem::take(&mut self.unknown) {
            let late = match self.scopes.find(name) {
                Some(&Entity::Variable(id)) => self.tree[id].at,
                Some(&Entity::Struct(id)) => Some(self.tree[id].at),
                Some(Entity::Functions(ids)) => ids.first().map(|&id| self.tree[id].at),
                None => None,
            };
            let reported = self
                .errors
                .iter_mut()
                .find(|error| error.span == Some(at.span) && error.code == Code::Undeclared);
            let Some(reported) = reported else {
                continue;
            };
            if let Some(late) = late
                && late.span.start > at.span.start
            {
                let text = self.interner.text(name);
                reported.message = format!("`{text}` is used before it is declared");
                reported.related.push((late.span, "declared here".to_owned()));
                reported.fixes.clear();
                reported.notes.clear();
                reported.helps = vec!["move the declaration above the first use".to_owned()];
            } else if !names_tab
                && reported.fixes.is_empty()
                && reported.notes.is_empty()
                && (is_call || is_constant_name(self.interner.text(name)))
            {
                names_tab = true;
                reported.helps.push(OTHER_TAB.to_owned());
            }
        }
    }

    /// The visible variables and functions, sorted by name.
    fn names_in_scope(&self) -> (Vec<&str>, Vec<&str>) {
        let declared = self.scopes.names();
        let (mut variables, mut functions): (Vec<_>, Vec<_>) = (Vec::new(), Vec::new());
        for (name, entity) in declared {
            match entity {
                Entity::Variable(_) => variables.push(self.interner.text(name)),
                Entity::Struct(_) | Entity::Functions(_) => functions.push(self.interner.text(name)),
            }
        }
        // Built-in variables are in a scope only if the text mentions their names.
        let given = self.tree.variables.iter().map(|(_, variable)| variable);
        variables.extend(
            given
                .filter(|variable| variable.at.is_none())
                .map(|variable| &*variable.name),
        );
        functions.extend(BuiltIn::ALL.iter().map(|function| function.name()));
        for names in [&mut variables, &mut functions] {
            names.sort_unstable();
            names.dedup();
        }
        (variables, functions)
    }

    fn type_names(&self) -> Vec<&str> {
        let structs = self.scopes.names().filter_map(|(name, entity)| match entity {
            Entity::Struct(_) => Some(self.interner.text(name)),
            _ => None,
        });
        let mut names: Vec<_> = structs.chain(self.interner.types()).collect();
        names.sort_unstable();
        names
    }

    /// Reports an unknown type, and returns the type that is probably intended.
    pub(crate) fn unknown_type(&mut self, name: Symbol, at: Place) -> Type {
        let text = self.text(name);
        let named = |name: &str| match self.interner.word(self.interner.find(name)?) {
            Word::Type(ty) => Some(ty),
            _ => None,
        };
        let reserved = self.interner.word(name) == Word::Reserved;
        if let Some(foreign) = Foreign::named(text) {
            let code = if reserved {
                Code::ReservedWord
            } else {
                Code::Undeclared
            };
            let ty = foreign.glsl_equivalent().and_then(named).unwrap_or(Type::Error);
            let diagnostic = code.at(at, format!("unknown type `{text}`"));
            self.report(foreign.advise(diagnostic, at, None).note(foreign.note()));
            return ty;
        }
        if reserved {
            self.error(Code::ReservedWord, at, format!("`{text}` is a reserved word"));
            return Type::Error;
        }
        if !self.is_maybe_declared(name) {
            let near = nearest(text, self.type_names());
            let message = format!("unknown type `{text}`");
            self.report(did_you_mean(Code::Undeclared, at, &message, near));
            self.mark_maybe_declared(name);
        }
        Type::Error
    }
}
