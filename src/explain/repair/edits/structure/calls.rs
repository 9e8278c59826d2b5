//! Calls of functions that nothing calls.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, Function, FunctionId, Scalar, Type, Variable, VariableId, VariableKind,
};
use toyproof_verify::random::reachable_expressions;

use super::super::super::edit::{EditKind, shortened};
use super::super::writer::is_float;
use super::{MAX_VALUES, Writer, insertion, replacement};

/// The costs of a call, and of one outside of `mainImage`: an author seldom writes a function for nothing.
const CALL: u32 = 14;
const INNER_CALL: u32 = 17;

/// The additional cost of each choice of arguments after the first.
const EACH_OTHER: u32 = 2;

/// The largest numbers of calls that are tried behind a statement, of those in place of an expression, and of
/// weights with which a result is mixed.
const MAX_CALLS: usize = 9;
const MAX_CALLS_OF_EXPRESSION: usize = 4;
const MAX_WEIGHTS: usize = 12;

impl Writer<'_> {
    /// Calls the functions that nothing calls.
    pub(super) fn helpers(&mut self) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let main = shader.checked.main_image;
        let reachable = reachable_expressions(tree, main);
        let called = reachable.iter().filter_map(|&expr| match tree[expr].kind {
            ExprKind::Call { function, .. } => Some(function),
            _ => None,
        });
        let called: HashSet<FunctionId> = called.collect();
        let reachable: HashSet<ExprId> = reachable.into_iter().collect();
        let has_effects = |function: &Function| function.return_type == Type::Void;
        let is_readable = |function: &Function| {
            let is_in = |&parameter: &VariableId| {
                matches!(tree[parameter].kind, VariableKind::Parameter(Direction::In))
            };
            function.parameters.iter().all(is_in)
        };
        let functions = tree.functions.iter();
        let uncalled = functions.filter(|(id, function)| {
            let is_called = *id == main || called.contains(id);
            let is_useful = has_effects(function) || is_readable(function);
            function.body.is_some() && !is_called && is_useful
        });
        for (id, function) in uncalled.collect::<Vec<_>>() {
            if has_effects(function) {
                for at in 0..shader.statements.len() {
                    let own = self.function(at).filter(|_| self.is_simple(at));
                    if own == Some(main) {
                        self.call_after(id, at, CALL);
                    } else if own.is_some_and(|own| called.contains(&own)) {
                        self.call_after(id, at, INNER_CALL);
                    }
                }
                continue;
            }
            for at in 0..shader.statements.len() {
                if self.is_simple(at) {
                    self.assign_call(id, at);
                }
            }
            for site in &shader.sites {
                let expr = site.exprs[0];
                if site.exprs.len() == 1 && reachable.contains(&expr) && is_float(tree[expr].ty) {
                    self.call_at(id, expr, site.statement);
                }
            }
        }
    }

    /// Calls a function behind a statement.
    fn call_after(&mut self, function: FunctionId, at: usize, cost: u32) {
        let Some(extent) = self.outline.extents[at] else {
            return;
        };
        let name = self.shader.tree[function].name.as_str();
        for (rank, arguments) in self.arguments(function, at, None).iter().enumerate() {
            let cost = cost + EACH_OTHER * rank as u32;
            let text = format!("{name}({});", arguments.join(", "));
            let message = format!("insert `{text}` after `{}`", shortened(self.text(at)));
            let edits = vec![insertion(extent, extent.end, format!(" {text}"))];
            self.add(at, EditKind::MissingCall, cost, message, edits);
        }
    }

    /// Wraps an expression in a call, replaces it by one, multiplies it by one, and adds it.
    fn call_at(&mut self, function: FunctionId, expr: ExprId, statement: usize) {
        let tree = self.shader.tree;
        let own = &tree[function];
        let span = tree[expr].at.span;
        let old = self.shader.text(span);
        let calls = self.arguments(function, statement, Some((old, tree[expr].ty)));
        for arguments in calls.into_iter().take(MAX_CALLS_OF_EXPRESSION) {
            let call = format!("{}({})", own.name, arguments.join(", "));
            let is_same = own.return_type == tree[expr].ty;
            let mut forms = Vec::new();
            if is_same {
                forms.push(call.clone());
            }
            if !arguments.iter().any(|argument| argument == old)
                && (is_same || own.return_type == Type::FLOAT)
            {
                forms.extend([format!("({old} * {call})"), format!("({old} + {call})")]);
            }
            for form in forms {
                let message = format!("replace `{}` with `{}`", shortened(old), shortened(&form));
                let edits = vec![replacement(span, &form)];
                self.add(statement, EditKind::MissingCall, CALL, message, edits);
            }
        }
    }

    /// Assigns the result of a call to a variable behind a statement.
    fn assign_call(&mut self, function: FunctionId, at: usize) {
        let tree = self.shader.tree;
        let (Some(extent), ty) = (self.outline.extents[at], tree[function].return_type) else {
            return;
        };
        let is_target = |own: &&Variable| {
            matches!(own.kind, VariableKind::Local | VariableKind::Parameter(_))
                && (own.ty == ty || ty == Type::FLOAT && is_float(own.ty))
        };
        let targets = self.scope(at).filter(is_target).take(MAX_VALUES);
        let targets: Vec<(String, Type)> = targets.map(|own| (own.name.clone(), own.ty)).collect();
        for (old, own_type) in &targets {
            for arguments in self.arguments(function, at, None) {
                let call = format!("{}({})", tree[function].name, arguments.join(", "));
                let mut texts = vec![format!("{old} *= {call};"), format!("{old} += {call};")];
                if *own_type == ty {
                    texts.push(format!("{old} = {call};"));
                    texts.extend(self.mixed(old, &call).map(|mixed| format!("{old} = {mixed};")));
                }
                for text in texts {
                    let message = format!("insert `{text}` after `{}`", shortened(self.text(at)));
                    let edits = vec![insertion(extent, extent.end, format!(" {text}"))];
                    self.add(at, EditKind::MissingCall, INNER_CALL, message, edits);
                }
            }
        }
    }

    /// Two values, mixed with weights of the reference.
    fn mixed(&self, one: &str, other: &str) -> impl Iterator<Item = String> {
        let weights = self
            .constants
            .floats
            .iter()
            .filter(|&&weight| 0.0 < weight && weight < 1.0);
        weights
            .take(MAX_WEIGHTS)
            .map(move |weight| format!("mix({one}, {other}, {weight:?})"))
    }

    /// The arguments with which a function may be called at a statement: values in scope, converted if
    /// necessary, and the text of an expression with its type.
    fn arguments(&self, function: FunctionId, at: usize, own: Option<(&str, Type)>) -> Vec<Vec<String>> {
        let tree = self.shader.tree;
        let mut calls: Vec<Vec<String>> = vec![Vec::new()];
        for &parameter in &tree[function].parameters {
            let ty = tree[parameter].ty;
            let is_in = matches!(tree[parameter].kind, VariableKind::Parameter(Direction::In));
            let mut values: Vec<String> = Vec::new();
            values.extend(
                own.filter(|&(_, own)| own == ty && is_in)
                    .map(|(text, _)| text.to_owned()),
            );
            // Arguments are often called like their parameters.
            let name = tree[parameter].name.as_str();
            let mut names: Vec<&str> = self.values(at, ty).collect();
            names.sort_by_key(|own| *own != name);
            values.extend(names.into_iter().take(MAX_VALUES).map(str::to_owned));
            if is_in {
                values.extend(self.converted(at, ty));
            }
            let longer = calls.iter().flat_map(|call| {
                let value = |value: &String| [call.as_slice(), std::slice::from_ref(value)].concat();
                values.iter().map(value)
            });
            calls = longer.take(MAX_CALLS).collect();
        }
        calls
    }

    /// The values in scope at a statement that a conversion gives this type.
    fn converted(&self, at: usize, ty: Type) -> Vec<String> {
        let (from, conversion) = match ty {
            Type::Vector(Scalar::Int, size) => (Type::Vector(Scalar::Float, size), format!("ivec{size}")),
            Type::INT => (Type::FLOAT, "int".to_owned()),
            // A number of turns or periods.
            Type::FLOAT => (Type::FLOAT, "fract".to_owned()),
            _ => return Vec::new(),
        };
        let values = self.values(at, from).take(MAX_VALUES);
        values.map(|value| format!("{conversion}({value})")).collect()
    }
}
