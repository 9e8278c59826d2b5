//! Inlining of calls of user-defined functions (§6.1).

use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, FunctionId, Place, Type, VariableId, VariableKind, walk,
};

use super::lvalue::{LValue, Location};
use super::{Builder, InlinedCall, Result};
use crate::ir::{CallId, Cells, Node, PartKind, Value};

/// An evaluated argument.
struct Argument {
    values: Vec<Value>,
    /// The channel of a sampler, or `None` if it is not bound.
    channel: Option<u8>,
    /// The part of a variable that is copied in when the call begins, if the values are not read before.
    copy_in: Option<LValue>,
    /// The part of a variable that gets the parameter's value when the call ends.
    copy_out: Option<LValue>,
}

impl Builder<'_> {
    pub(super) fn call(
        &mut self,
        function: FunctionId,
        arguments: &[ExprId],
        at_call: Place,
    ) -> Result<Vec<Value>> {
        let tree = self.tree;
        let call = self.name_call(function, at_call);
        let parameters = &tree[function].parameters;
        let mut passed = Vec::with_capacity(arguments.len());
        let last_acting = arguments
            .iter()
            .rposition(|&argument| walk::has_side_effects(tree, argument));
        for (at, (&argument, &parameter)) in arguments.iter().zip(parameters).enumerate() {
            let may_change = last_acting.is_some_and(|last| at < last);
            passed.push(self.pass(argument, parameter, may_change)?);
        }
        for passed in &mut passed {
            if let Some(place) = &passed.copy_in {
                // Copied in when the call begins, after all arguments are evaluated, as in glslang.
                passed.values = self.read(place);
            }
        }
        let outer_out_parameters = self.out_parameters.len();
        let mut copy_outs = Vec::new();
        for (at, (passed, &parameter)) in passed.into_iter().zip(parameters).enumerate() {
            if matches!(tree[parameter].ty, Type::Sampler(_)) {
                // A later argument may call the same function with another sampler.
                self.locations
                    .insert(parameter, Location::Channel(passed.channel));
                continue;
            }
            if let Some(copy_out) = &passed.copy_out
                && let Some(cells) = self.shared_cells(copy_out, arguments, at)
            {
                if direction(tree[parameter].kind) == Direction::Out {
                    self.store_all(cells, &passed.values);
                    self.trace_variable(cells, at_call, None);
                    self.begin_out_parameter(parameter, cells);
                }
                self.bind(call, parameter, cells);
                self.locations.insert(parameter, Location::Cells(cells));
                continue;
            }
            let cells = self.allocate_type(tree[parameter].ty)?;
            self.store_all(cells, &passed.values);
            let with_value = direction(tree[parameter].kind) != Direction::Out;
            self.bind(call, parameter, cells);
            self.trace_variable(cells, at_call, with_value.then_some(&passed.values));
            self.begin_variable(parameter, cells, with_value);
            self.locations.insert(parameter, Location::Cells(cells));
            copy_outs.extend(passed.copy_out.map(|copy_out| (cells, copy_out)));
        }
        let result = self.inline(function, call)?;
        self.end_out_parameters(outer_out_parameters);
        let value = self.load_all(result);
        for (cells, copy_out) in copy_outs {
            let values = self.load_all(cells);
            self.write(&copy_out, &values);
            self.trace_write(&copy_out, at_call, &values);
        }
        Ok(value)
    }

    /// Returns the cells of an argument that the function can access in place: they are contiguous, and no
    /// other name refers to them during the call.
    fn shared_cells(&self, target: &LValue, arguments: &[ExprId], at: usize) -> Option<Cells> {
        let root = self.tree.root_variable(arguments[at])?;
        let own = matches!(
            self.tree[root].kind,
            VariableKind::Local | VariableKind::Parameter(_)
        );
        let mut others = arguments.iter().enumerate().filter(|&(other, _)| other != at);
        let alone = others.all(|(_, &other)| self.tree.root_variable(other) != Some(root));
        (own && alone).then(|| self.contiguous_cells(target)).flatten()
    }

    /// Evaluates an argument, or the indices of one that is written.
    fn pass(&mut self, argument: ExprId, parameter: VariableId, may_change: bool) -> Result<Argument> {
        let ty = self.tree[parameter].ty;
        if matches!(ty, Type::Sampler(_)) {
            return Ok(Argument {
                values: Vec::new(),
                channel: self.channel(argument),
                copy_in: None,
                copy_out: None,
            });
        }
        let direction = direction(self.tree[parameter].kind);
        let copy_in = if direction == Direction::In && may_change {
            self.lvalue(argument)?
        } else {
            None
        };
        if matches!(direction, Direction::In | Direction::ConstIn) {
            let values = match &copy_in {
                Some(_) => self.zeros(ty),
                None => self.expression(argument)?,
            };
            return Ok(Argument {
                values,
                channel: None,
                copy_in,
                copy_out: None,
            });
        }
        let copy_out = self.lvalue(argument)?;
        Ok(Argument {
            values: self.zeros(ty),
            channel: None,
            copy_in: copy_out.clone().filter(|_| direction == Direction::InOut),
            copy_out,
        })
    }

    /// Returns the channel of a sampler, or `None` if it is not bound.
    pub(super) fn channel(&mut self, sampler: ExprId) -> Option<u8> {
        let ExprKind::Variable(variable) = self.tree[sampler].kind else {
            return None;
        };
        match self.location(variable) {
            Location::Channel(channel) => channel,
            _ => None,
        }
    }

    /// Inlines the body of a function whose parameters have locations; returns the cells of its result.
    fn inline(&mut self, function: FunctionId, call: Option<CallId>) -> Result<Cells> {
        let tree = self.tree;
        let ty = tree[function].return_type;
        let result = self.allocate_type(ty)?;
        // The result of a function that ends without `return`.
        let zeros = self.zeros(ty);
        self.store_all(result, &zeros);
        let scope = self.scope();
        let body = self.inner(|builder| {
            builder.call_stack.push(InlinedCall { scope, result, call });
            builder.trace_entry(function);
            builder.trace_parameters(function);
            let (breaks, continues) = (
                std::mem::take(&mut builder.breaks),
                std::mem::take(&mut builder.continues),
            );
            if let Some(body) = &tree[function].body {
                let kind = PartKind::Function(function);
                builder.part(kind, tree[function].at, |builder| builder.block(body))?;
            }
            builder.breaks = breaks;
            builder.continues = continues;
            builder.call_stack.pop();
            Ok(())
        })?;
        self.push_scope(scope, body);
        Ok(result)
    }

    /// Inlines `mainImage`, with `color` as the cells of its output.
    pub(super) fn main_image(&mut self, function: FunctionId, color: Cells) -> Result<()> {
        let tree = self.tree;
        let coordinates = self.frag_coord();
        if let &[out, position] = tree[function].parameters.as_slice() {
            self.locations.insert(out, Location::Cells(color));
            self.bind_here(out, color);
            self.begin_variable(out, color, true);
            let cells = self.allocate_type(tree[position].ty)?;
            self.store_all(cells, &coordinates);
            self.locations.insert(position, Location::Cells(cells));
            self.bind_here(position, cells);
            self.trace_variable(cells, tree[function].at, coordinates.get(..cells.count as usize));
            self.begin_variable(position, cells, true);
        }
        self.inline(function, None).map(drop)
    }

    /// Emits a scope, or its body alone if nothing leaves it.
    pub(super) fn push_scope(&self, scope: crate::ir::Scope, mut body: Vec<Node>) {
        super::statement::simplify_exits(&mut body, scope);
        if super::statement::has_break(&body, scope) {
            self.push(Node::Scope { scope, body });
        } else {
            self.writer.borrow_mut().block.extend(body);
        }
    }
}

/// Returns the direction of a parameter.
pub(super) fn direction(kind: VariableKind) -> Direction {
    match kind {
        VariableKind::Parameter(direction) => direction,
        _ => Direction::In,
    }
}
