//! Functions: declared, overloaded, defined (§6.1).

use std::collections::HashSet;

use super::scope::Entity;
use super::{Checker, Specifier};
use crate::codes::Code;
use crate::token::Symbol;
use crate::tree::{
    Block, BuiltIn, Direction, Function, FunctionId, Item, Place, Type, Variable, VariableId, VariableKind,
};

/// A parameter as it stands in the text.
#[derive(Debug)]
pub(crate) struct Parameter {
    pub(crate) name: Option<Symbol>,
    pub(crate) ty: Type,
    pub(crate) direction: Direction,
    pub(crate) at: Place,
}

/// What is known of the function whose body is being read.
#[derive(Debug)]
pub(super) struct Context {
    pub(super) function: FunctionId,
    pub(super) return_type: Type,
    /// Whether a `return` came.
    pub(super) returns: bool,
    /// Whether a `return` gave something else than the header says: either may be meant.
    pub(super) contradicted: bool,
    /// The undeclared names that were told of.
    pub(super) undeclared: HashSet<Symbol>,
    /// How many loops are open.
    pub(super) loops: usize,
    /// How many loops and switches are open.
    pub(super) breakable: usize,
}

impl Checker<'_> {
    /// The type of a parameter, if one can have it.
    pub(crate) fn parameter_type(&mut self, specifier: &Specifier, direction: Direction) -> Type {
        let ty = self.complete_type(specifier);
        let at = specifier.at;
        if ty == Type::Void {
            self.error(Code::BadType, at, "a parameter cannot be `void`");
            return Type::Error;
        }
        if matches!(direction, Direction::Out | Direction::InOut) && self.holds_sampler(ty) {
            let message = format!("a parameter of type {} can only be `in`", self.said(ty));
            self.error(Code::BadType, at, message);
        }
        self.bounded(ty, at)
    }

    /// Declares an overload, or finds the one that the header repeats.
    pub(crate) fn declare_function(
        &mut self,
        result: &Specifier,
        name: Symbol,
        at: Place,
        parameters: &[Parameter],
    ) -> FunctionId {
        let return_type = self.complete_type(result);
        if self.holds_sampler(return_type) {
            let message = format!("a function cannot return {}", self.said(return_type));
            self.error(Code::BadType, result.at, message);
        }
        let mut overloads = match self.scopes.find_here(name) {
            Some(Entity::Functions(overloads)) => overloads.clone(),
            _ => Vec::new(),
        };
        // What cannot be called has a body all the same, which is checked as it stands.
        let mut allowed = true;
        for &old in &overloads {
            if self.takes_exactly(old, parameters) {
                if self.same_header(old, return_type, parameters, at) {
                    return old;
                }
                allowed = false;
                break;
            }
        }
        if overloads.is_empty() {
            allowed = self.may_declare(name, at) && self.may_be_own_function(name, at);
        }
        let parameters = parameters
            .iter()
            .map(|parameter| self.parameter(parameter))
            .collect();
        let function = self.tree.functions.push(Function {
            name: self.text(name).to_owned(),
            return_type,
            parameters,
            body: None,
            at,
        });
        overloads.push(function);
        if allowed {
            self.scopes.declare(name, Entity::Functions(overloads));
        }
        function
    }

    /// §6.1: no function is named as a built-in one; variables and structures may be, and hide it. Desktop GLSL lets functions, too.
    fn may_be_own_function(&mut self, name: Symbol, at: Place) -> bool {
        let text = self.text(name);
        let allowed = self.lenient || BuiltIn::named(text).is_none();
        if !allowed {
            let message = format!("`{text}` is declared already: it is a built-in function");
            self.error(Code::Redeclared, at, message);
        }
        allowed
    }

    fn parameter(&mut self, parameter: &Parameter) -> VariableId {
        self.tree.variables.push(Variable {
            name: parameter.name.map_or("", |name| self.words.text(name)).to_owned(),
            ty: parameter.ty,
            kind: VariableKind::Parameter(parameter.direction),
            initialiser: None,
            value: None,
            at: Some(parameter.at),
        })
    }

    fn takes_exactly(&self, function: FunctionId, parameters: &[Parameter]) -> bool {
        let old = &self.tree[function].parameters;
        old.len() == parameters.len()
            && old
                .iter()
                .zip(parameters)
                .all(|(&old, new)| self.tree[old].ty == new.ty)
    }

    /// A second header with the same parameter types must be the same in the rest, too.
    fn same_header(
        &mut self,
        old: FunctionId,
        return_type: Type,
        parameters: &[Parameter],
        at: Place,
    ) -> bool {
        let function = &self.tree[old];
        let directions = function.parameters.iter().zip(parameters);
        let problem = if function.return_type != return_type {
            "its result"
        } else if directions
            .into_iter()
            .any(|(&old, new)| self.tree[old].kind != VariableKind::Parameter(new.direction))
        {
            "the qualifiers of its parameters"
        } else {
            return true;
        };
        let message = format!("`{}` differs from an overload by {problem} only", function.name);
        let first = function.at.span;
        self.report(Code::BadOverload.at(at, message).related(first, "the other"));
        false
    }

    /// A header without body.
    pub(crate) fn prototype(&mut self, function: FunctionId) {
        self.tree.items.push(Item::Prototype(function));
    }

    /// Opens the body of a function: parameters and body share one scope (§4.2.2).
    pub(crate) fn open_body(&mut self, function: FunctionId, at: Place, parameters: &[Parameter]) {
        if self.tree[function].body.is_some() {
            let old = &self.tree[function];
            let diagnostic = Code::Redeclared
                .at(at, format!("`{}` has a body already", old.name))
                .related(old.at.span, "the first");
            self.report(diagnostic);
        }
        self.tree[function].at = at;
        self.scopes.open();
        let mut ids = Vec::with_capacity(parameters.len());
        for parameter in parameters {
            let id = self.parameter(parameter);
            ids.push(id);
            if let Some(name) = parameter.name
                && self.may_declare(name, parameter.at)
            {
                self.scopes.declare(name, Entity::Variable(id));
            }
        }
        self.tree[function].parameters = ids;
        self.function = Some(Context {
            function,
            return_type: self.tree[function].return_type,
            returns: false,
            contradicted: false,
            undeclared: HashSet::new(),
            loops: 0,
            breakable: 0,
        });
    }

    pub(crate) fn close_body(&mut self, function: FunctionId, body: Block) {
        self.scopes.close();
        let context = self.function.take();
        let Function { return_type, at, .. } = self.tree[function];
        // Some paths may miss it, as in WebGL; not all.
        if context.as_ref().is_some_and(|context| context.contradicted) {
            self.tree[function].return_type = Type::Error;
        }
        if !matches!(return_type, Type::Void | Type::Error) && context.is_some_and(|context| !context.returns)
        {
            let message = format!("`{}` never returns a value", self.tree[function].name);
            let note = format!(
                "end it with `return …;` and a {}, or make it `void`",
                self.said(return_type)
            );
            self.report(Code::BadReturn.at(at, message).note(note));
        }
        self.tree[function].body = Some(body);
        self.tree.items.push(Item::Function(function));
    }
}
