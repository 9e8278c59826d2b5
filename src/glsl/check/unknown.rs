//! Names that mean nothing here, and what may have been meant.

use toyproof_diagnostic::nearest;

use super::Checker;
use super::scope::Entity;
use crate::codes::Code;
use crate::foreign::Foreign;
use crate::token::Symbol;
use crate::tree::{BuiltIn, ExprId, Place, Type};
use crate::words::Word;

impl Checker<'_> {
    /// Tells that a variable is not declared, once in each function.
    pub(super) fn undeclared(&mut self, name: Symbol, at: Place) -> ExprId {
        let text = self.text(name);
        let (variables, functions) = self.names_in_scope();
        let near = nearest(text, variables)
            .or_else(|| nearest(text, functions))
            .map(str::to_owned);
        self.tell_unknown(name, at, format!("`{text}` is not declared"), near)
    }

    /// Tells that a function is not declared, once in each function.
    pub(super) fn undeclared_function(&mut self, name: Symbol, at: Place) -> ExprId {
        let text = self.text(name);
        let (variables, functions) = self.names_in_scope();
        let near = nearest(text, functions)
            .or_else(|| nearest(text, variables))
            .map(str::to_owned);
        self.tell_unknown(name, at, format!("there is no function `{text}`"), near)
    }

    fn tell_unknown(&mut self, name: Symbol, at: Place, message: String, near: Option<String>) -> ExprId {
        let known = self
            .function
            .as_mut()
            .is_some_and(|context| !context.undeclared.insert(name));
        if known || self.is_doubtful(name) {
            return self.broken(at);
        }
        let diagnostic = match (Foreign::named(self.text(name)), near) {
            (Some(foreign), _) => Code::Undeclared
                .at(at, message)
                .label(format!("write {}", foreign.instead()))
                .note(foreign.note()),
            (None, Some(near)) => Code::Undeclared.at(at, format!("{message}; did you mean `{near}`?")),
            (None, None) => Code::Undeclared.at(at, message),
        };
        self.report(diagnostic);
        self.unknown.push((name, at));
        self.broken(at)
    }

    /// Once all is read: says of names whose declaration came too late that it did.
    pub(super) fn find_late_declarations(&mut self) {
        for (name, at) in std::mem::take(&mut self.unknown) {
            let late = match self.scopes.find(name) {
                Some(&Entity::Variable(id)) => self.tree[id].at,
                Some(&Entity::Struct(id)) => Some(self.tree[id].at),
                Some(Entity::Functions(ids)) => ids.first().map(|&id| self.tree[id].at),
                None => None,
            };
            let told = self
                .errors
                .iter_mut()
                .find(|error| error.span == Some(at.span) && error.code == Code::Undeclared.as_str());
            if let (Some(late), Some(told)) = (late, told)
                && late.span.start > at.span.start
            {
                let text = self.words.text(name);
                told.message = format!("`{text}` is used before it is declared");
                told.related
                    .push((late.span, "declared here, too late".to_owned()));
                told.notes = vec!["a name can be used only after its declaration: move that up".to_owned()];
            }
        }
    }

    /// The variables and the functions that can be named here, in the order of their names.
    fn names_in_scope(&self) -> (Vec<&str>, Vec<&str>) {
        let declared = self.scopes.names();
        let (mut variables, mut functions): (Vec<_>, Vec<_>) = (Vec::new(), Vec::new());
        for (name, entity) in declared {
            match entity {
                Entity::Variable(_) => variables.push(self.words.text(name)),
                Entity::Struct(_) | Entity::Functions(_) => functions.push(self.words.text(name)),
            }
        }
        // What ShaderToy and GLSL declare is not in scope where the text does not hold its name.
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
            Entity::Struct(_) => Some(self.words.text(name)),
            _ => None,
        });
        let mut names: Vec<_> = structs.chain(self.words.types()).collect();
        names.sort_unstable();
        names
    }

    /// Tells that no type has that name, and gives the one that may be meant.
    pub(crate) fn unknown_type(&mut self, name: Symbol, at: Place) -> Type {
        let text = self.text(name);
        let named = |name: &str| match self.words.word(self.words.find(name)?) {
            Word::Type(ty) => Some(ty),
            _ => None,
        };
        let reserved = self.words.word(name) == Word::Reserved;
        if let Some(foreign) = Foreign::named(text) {
            let code = if reserved {
                Code::ReservedWord
            } else {
                Code::Undeclared
            };
            let ty = foreign.twin().and_then(named).unwrap_or(Type::Error);
            self.report(
                code.at(at, format!("there is no type `{text}`"))
                    .label(format!("write {}", foreign.instead()))
                    .note(foreign.note()),
            );
            return ty;
        }
        if reserved {
            self.error(
                Code::ReservedWord,
                at,
                format!("`{text}` is a word that GLSL reserves"),
            );
            return Type::Error;
        }
        if !self.is_doubtful(name) {
            let message = match nearest(text, self.type_names()) {
                Some(near) => format!("there is no type `{text}`; did you mean `{near}`?"),
                None => format!("there is no type `{text}`"),
            };
            self.error(Code::Undeclared, at, message);
            self.doubt(name);
        }
        Type::Error
    }
}
