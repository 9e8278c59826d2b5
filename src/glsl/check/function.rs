//! Functions (§6.1): declarations, overloads, definitions, and the checks of the whole program.

use std::collections::HashSet;

use toyproof_diagnostic::Code;

use super::scope::Entity;
use super::{Call, Checker, Specifier};
use crate::Stage;
use crate::analysis::Resolution;
use crate::stage::{Entry, added_entry};
use crate::token::Symbol;
use crate::tree::{
    Block, BuiltIn, Direction, Function, FunctionId, Item, Place, Type, Variable, VariableId, VariableKind,
};

/// A parameter of a function's header.
#[derive(Debug)]
pub(crate) struct Parameter {
    pub(crate) name: Option<Symbol>,
    pub(crate) ty: Type,
    pub(crate) direction: Direction,
    pub(crate) at: Place,
}

/// The state of the function whose body is being parsed.
#[derive(Debug)]
pub(super) struct Context {
    pub(super) function: FunctionId,
    pub(super) return_type: Type,
    /// Whether the body contains a `return`.
    pub(super) returns: bool,
    /// Whether the type of a returned value contradicts the header: either may be intended.
    pub(super) contradicted: bool,
    /// The undeclared names that were reported.
    pub(super) undeclared: HashSet<Symbol>,
    /// The number of enclosing loops.
    pub(super) loops: usize,
    /// The number of enclosing loops and switches.
    pub(super) breakable: usize,
}

impl Checker<'_> {
    /// Returns the type of a parameter, or reports an error if parameters cannot have it.
    pub(crate) fn parameter_type(&mut self, specifier: &Specifier, direction: Direction) -> Type {
        let ty = self.complete_type(specifier);
        let at = specifier.at;
        if ty == Type::Void {
            self.error(Code::BadType, at, "a parameter cannot be `void`");
            return Type::Error;
        }
        if matches!(direction, Direction::Out | Direction::InOut) && self.holds_sampler(ty) {
            let message = format!("a parameter of type {} can only be `in`", self.quoted_type(ty));
            self.error(Code::BadType, at, message);
        }
        self.check_size_limit(ty, at)
    }

    /// Declares an overload, or finds the one that the header redeclares.
    pub(crate) fn declare_function(
        &mut self,
        result: &Specifier,
        name: Symbol,
        at: Place,
        parameters: &[Parameter],
    ) -> FunctionId {
        let return_type = self.complete_type(result);
        if self.holds_sampler(return_type) {
            let message = format!("a function cannot return {}", self.quoted_type(return_type));
            self.error(Code::BadType, result.at, message);
        }
        let mut overloads = match self.scopes.find_here(name) {
            Some(Entity::Functions(overloads)) => overloads.clone(),
            _ => Vec::new(),
        };
        // The body of a function that cannot be declared is still checked.
        let mut allowed = true;
        for &old in &overloads {
            if self.takes_exactly(old, parameters) {
                if self.same_header(old, return_type, parameters, at) {
                    self.declared(at, Resolution::Function(old));
                    return old;
                }
                allowed = false;
                break;
            }
        }
        if overloads.is_empty() {
            allowed =
                self.check_declarable(name, at) && self.check_not_built_in_function(name, at, parameters);
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
        self.declared(at, Resolution::Function(function));
        if allowed {
            self.scopes.declare(name, Entity::Functions(overloads));
            self.visible_after(at.span.end, Resolution::Function(function));
        }
        function
    }

    /// Checks that a function does not redefine a built-in one (§6.1); variables and structures may hide it.
    /// GLSL ES 1.00 and desktop GLSL also allow functions.
    fn check_not_built_in_function(&mut self, name: Symbol, at: Place, parameters: &[Parameter]) -> bool {
        let text = self.text(name);
        let types: Vec<Type> = parameters.iter().map(|parameter| parameter.ty).collect();
        let allowed = BuiltIn::named(text).is_none_or(|function| {
            let is_overload = self.language.may_overload() && function.result(&types).is_none();
            is_overload || self.language.may_redefine(function)
        });
        if !allowed {
            let message = format!("`{text}` is a built-in function and cannot be redefined");
            self.error(Code::Redeclared, at, message);
        }
        allowed
    }

    fn parameter(&mut self, parameter: &Parameter) -> VariableId {
        let name = parameter.name.map_or("", |name| self.interner.text(name));
        let kind = VariableKind::Parameter(parameter.direction);
        self.tree
            .variables
            .push(Variable::new(name, parameter.ty, kind, Some(parameter.at)))
    }

    fn takes_exactly(&self, function: FunctionId, parameters: &[Parameter]) -> bool {
        let old = &self.tree[function].parameters;
        old.len() == parameters.len()
            && old
                .iter()
                .zip(parameters)
                .all(|(&old, new)| self.tree[old].ty == new.ty)
    }

    /// Checks that a second header with the same parameter types is otherwise the same.
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
            "return type"
        } else if directions
            .into_iter()
            .any(|(&old, new)| self.tree[old].kind != VariableKind::Parameter(new.direction))
        {
            "parameter qualifiers"
        } else {
            return true;
        };
        let message = format!(
            "two declarations of `{}` differ only in their {problem}",
            function.name
        );
        let first = function.at.span;
        self.report(
            Code::BadOverload
                .at(at, message)
                .related(first, "previously declared here"),
        );
        false
    }

    /// Records a prototype.
    pub(crate) fn prototype(&mut self, function: FunctionId, parameters: &[Parameter]) {
        self.tree.items.push(Item::Prototype(function));
        if self.names.is_some() {
            // The parameters of each header are names of their own, which nothing refers to.
            for parameter in parameters.iter().filter(|parameter| parameter.name.is_some()) {
                let id = self.parameter(parameter);
                self.declared(parameter.at, Resolution::Variable(id));
            }
        }
    }

    /// Opens the body of a function: parameters and body share one scope (§4.2.2).
    pub(crate) fn open_body(&mut self, function: FunctionId, at: Place, parameters: &[Parameter]) {
        if self.tree[function].body.is_some() {
            let old = &self.tree[function];
            let diagnostic = Code::Redeclared
                .at(at, format!("redefinition of `{}`", old.name))
                .related(old.at.span, "previously defined here");
            self.report(diagnostic);
        }
        self.tree[function].at = at;
        self.open_scope();
        let mut ids = Vec::with_capacity(parameters.len());
        for parameter in parameters {
            let id = self.parameter(parameter);
            ids.push(id);
            let Some(name) = parameter.name else { continue };
            self.declared(parameter.at, Resolution::Variable(id));
            if self.check_declarable(name, parameter.at) {
                self.scopes.declare(name, Entity::Variable(id));
                self.visible_after(parameter.at.span.end, Resolution::Variable(id));
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

    /// Closes the body of a function, whose text ends at a byte.
    pub(crate) fn close_body(&mut self, function: FunctionId, body: Block, end: u32) {
        self.close_scope(end);
        let context = self.function.take();
        let Function { return_type, at, .. } = self.tree[function];
        // As in WebGL, some paths may lack a `return`, but not all.
        if context.as_ref().is_some_and(|context| context.contradicted) {
            self.tree[function].return_type = Type::Error;
        }
        if !matches!(return_type, Type::Void | Type::Error) && context.is_some_and(|context| !context.returns)
        {
            let message = format!("`{}` has no `return` statement", self.tree[function].name);
            let help = format!(
                "return a {}, or make the function `void`",
                self.quoted_type(return_type)
            );
            self.report(Code::BadReturn.at(at, message).help(help));
        }
        self.tree[function].body = Some(body);
        self.tree.items.push(Item::Function(function));
    }
}

// Checks of the whole program: calls of functions without a body, recursion, and `mainImage` (§6.1).

impl Checker<'_> {
    /// Checks, once all functions are parsed, that every called function has a body and that no function
    /// is recursive (§6.1.2). Returns the entry point; `None` if it is missing, and for Common.
    pub(crate) fn finish(&mut self) -> Option<FunctionId> {
        self.find_late_declarations();
        // A missing definition may be in unparsable text.
        let complete = self.errors.is_empty() && !self.lacks_names;
        let calls = std::mem::take(&mut self.calls);
        let mut reported = HashSet::new();
        for &Call { callee, at, .. } in &calls {
            // Common is compiled alone, but not linked.
            let is_linked = self.stage != Stage::Common;
            if complete && is_linked && self.tree[callee].body.is_none() && reported.insert(callee) {
                let message = format!("`{}` is called but not defined", self.tree[callee].name);
                self.report(
                    Code::Undefined
                        .at(at, message)
                        .related(self.tree[callee].at.span, "declared here"),
                );
            }
        }
        if let Some(Call { caller, callee, at }) = self.find_recursion(&calls) {
            let name = &self.tree[callee].name;
            let message = if caller == callee {
                format!("recursive call: `{name}` calls itself")
            } else {
                format!(
                    "recursive call: `{name}` calls itself through `{}`",
                    self.tree[caller].name
                )
            };
            let diagnostic = Code::Recursion
                .at(at, message)
                .note("GLSL does not support recursion");
            self.report(diagnostic.help("use a loop"));
        }
        if self.calls_added_main {
            return self.find_entry(&added_entry());
        }
        if !self.dialect.calls_main_image() {
            return self.entry_of_main();
        }
        // `main` in place of `mainImage` has been reported.
        if self
            .tree
            .functions
            .iter()
            .any(|(_, function)| function.name == "main")
        {
            return None;
        }
        let entry = self.stage.entry()?;
        if complete || (!self.lacks_names && self.interner.find(entry.name).is_none()) {
            return self.find_entry(&entry);
        }
        None
    }

    /// The last call of a recursive function's cycle.
    fn find_recursion(&self, calls: &[Call]) -> Option<Call> {
        let functions = self.tree.functions.len();
        let mut callees = vec![Vec::new(); functions];
        let mut callers = vec![0_usize; functions];
        for &Call { caller, callee, .. } in calls {
            callees[caller.index()].push(callee.index());
            callers[callee.index()] += 1;
        }
        // Repeatedly remove functions without callers. Each remaining function has a remaining caller.
        let mut free: Vec<_> = (0..functions)
            .filter(|&function| callers[function] == 0)
            .collect();
        while let Some(function) = free.pop() {
            for &callee in &callees[function] {
                callers[callee] -= 1;
                if callers[callee] == 0 {
                    free.push(callee);
                }
            }
        }
        // So following callers leads into a cycle: the first function visited twice is in it.
        let mut call_of = vec![None; functions];
        for &Call { caller, callee, at } in calls {
            if callers[caller.index()] > 0 {
                call_of[callee.index()] = Some((caller, at));
            }
        }
        let mut visited = vec![false; functions];
        let mut function = self.tree.functions.ids().find(|id| callers[id.index()] > 0)?;
        loop {
            let (caller, at) = call_of[function.index()]?;
            if std::mem::replace(&mut visited[function.index()], true) {
                return Some(Call {
                    caller,
                    callee: function,
                    at,
                });
            }
            function = caller;
        }
    }

    /// Finds the function that ShaderToy calls.
    fn find_entry(&mut self, entry: &Entry) -> Option<FunctionId> {
        let mut near = None;
        let mut found: Option<(usize, FunctionId)> = None;
        for (id, function) in self.tree.functions.iter() {
            if function.name != entry.name || function.body.is_none() {
                continue;
            }
            near = Some(function.at);
            let form = entry.form(function, &self.tree);
            found = found
                .into_iter()
                .chain(form.map(|form| (form, id)))
                .min_by_key(|(form, _)| *form);
        }
        if let Some((_, id)) = found {
            return Some(id);
        }
        let name = entry.name;
        let (at, message) = match near {
            Some(_) => (near, format!("`{name}` has the wrong signature")),
            None => (self.end, format!("missing function `{name}`")),
        };
        let diagnostic = Code::NoMainImage.at(at?, message);
        let mut diagnostic = diagnostic.help(entry.help);
        if near.is_none() && !self.tree.functions.is_empty() {
            diagnostic = diagnostic
                .help("put the text of a tab without it, such as Common, in front of the tab that has it");
        }
        self.report(diagnostic);
        None
    }
}
