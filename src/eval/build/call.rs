//! Calls of the author's functions, inlined (§6.1).

use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, FunctionId, Place, Type, VariableId, VariableKind, walk,
};

use super::place::{Home, Target};
use super::{Builder, Frame, Result};
use crate::ir::function::{Cells, Node, Value};
use crate::trace::story::CallId;

/// What an argument gives to its parameter, and takes back.
struct Passed {
    values: Vec<Value>,
    /// Where the values are read when the call begins, if not before.
    late: Option<Target>,
    back: Option<Target>,
}

impl Builder<'_> {
    pub(super) fn call(
        &mut self,
        function: FunctionId,
        arguments: &[ExprId],
        at: Place,
    ) -> Result<Vec<Value>> {
        let tree = self.tree;
        let call = self.name_call(function, at);
        let parameters = &tree[function].parameters;
        let mut passed = Vec::with_capacity(arguments.len());
        let last_acting = arguments.iter().rposition(|&argument| walk::acts(tree, argument));
        for (at, (&argument, &parameter)) in arguments.iter().zip(parameters).enumerate() {
            let may_change = last_acting.is_some_and(|last| at < last);
            passed.push(self.pass(argument, parameter, may_change)?);
        }
        for passed in &mut passed {
            if let Some(place) = &passed.late {
                // Copied in when the call begins, after all arguments, as glslang does.
                passed.values = self.read(place);
            }
        }
        let parts = self.parts.len();
        let mut taken = Vec::new();
        for (at, (passed, &parameter)) in passed.into_iter().zip(parameters).enumerate() {
            if matches!(tree[parameter].ty, Type::Sampler(_)) {
                continue;
            }
            if let Some(back) = &passed.back
                && let Some(cells) = self.shared_cells(back, arguments, at)
            {
                if direction(tree[parameter].kind) == Direction::Out {
                    self.store_all(cells, &passed.values);
                    self.begin_part(parameter, cells);
                }
                self.homes.insert(parameter, Home::Cells(cells));
                continue;
            }
            let cells = self.allocate_type(tree[parameter].ty)?;
            self.store_all(cells, &passed.values);
            let with_value = direction(tree[parameter].kind) != Direction::Out;
            self.begin(parameter, cells, with_value);
            self.homes.insert(parameter, Home::Cells(cells));
            taken.extend(passed.back.map(|back| (cells, back)));
        }
        let result = self.inline(function, call)?;
        self.end_parts(parts);
        let value = self.load_all(result);
        for (cells, back) in taken {
            let values = self.load_all(cells);
            self.write(&back, &values);
        }
        Ok(value)
    }

    /// The cells of an argument that a function may work on as they are: nobody else can name them while it runs, and they lie in a row.
    fn shared_cells(&self, target: &Target, arguments: &[ExprId], at: usize) -> Option<Cells> {
        let root = self.tree.root_variable(arguments[at])?;
        let own = matches!(
            self.tree[root].kind,
            VariableKind::Local | VariableKind::Parameter(_)
        );
        let mut others = arguments.iter().enumerate().filter(|&(other, _)| other != at);
        let alone = others.all(|(_, &other)| self.tree.root_variable(other) != Some(root));
        (own && alone).then(|| self.row_of(target)).flatten()
    }

    /// Evaluates an argument, or the indices of one that is written.
    fn pass(&mut self, argument: ExprId, parameter: VariableId, may_change: bool) -> Result<Passed> {
        let ty = self.tree[parameter].ty;
        if matches!(ty, Type::Sampler(_)) {
            let channel = self.channel(argument);
            self.homes.insert(parameter, Home::Channel(channel));
            return Ok(Passed {
                values: Vec::new(),
                late: None,
                back: None,
            });
        }
        let direction = direction(self.tree[parameter].kind);
        let late = if direction == Direction::In && may_change {
            self.target(argument)?
        } else {
            None
        };
        if matches!(direction, Direction::In | Direction::ConstIn) {
            let values = match &late {
                Some(_) => self.zeros(ty),
                None => self.expression(argument)?,
            };
            return Ok(Passed {
                values,
                late,
                back: None,
            });
        }
        let back = self.target(argument)?;
        Ok(Passed {
            values: self.zeros(ty),
            late: back.clone().filter(|_| direction == Direction::InOut),
            back,
        })
    }

    /// The channel that a sampler is; none for one that nobody feeds.
    pub(super) fn channel(&mut self, sampler: ExprId) -> Option<u8> {
        let ExprKind::Variable(variable) = self.tree[sampler].kind else {
            return None;
        };
        match self.home(variable) {
            Home::Channel(channel) => channel,
            _ => None,
        }
    }

    /// The body of a function whose parameters have homes; its result, in cells.
    fn inline(&mut self, function: FunctionId, call: Option<CallId>) -> Result<Cells> {
        let tree = self.tree;
        let ty = tree[function].return_type;
        let result = self.allocate_type(ty)?;
        // As where a function ends without `return`.
        let zeros = self.zeros(ty);
        self.store_all(result, &zeros);
        let scope = self.scope();
        let body = self.inner(|builder| {
            builder.frames.push(Frame { scope, result, call });
            builder.tell_parameters(function);
            let (breaks, continues) = (
                std::mem::take(&mut builder.breaks),
                std::mem::take(&mut builder.continues),
            );
            if let Some(body) = &tree[function].body {
                builder.block(body)?;
            }
            builder.breaks = breaks;
            builder.continues = continues;
            builder.frames.pop();
            Ok(())
        })?;
        self.push_scope(scope, body);
        Ok(result)
    }

    /// `mainImage`, which paints into `colour`.
    pub(super) fn main_image(&mut self, function: FunctionId, colour: Cells) -> Result<()> {
        let tree = self.tree;
        let coordinates = self.frag_coord();
        if let &[out, position] = tree[function].parameters.as_slice() {
            self.homes.insert(out, Home::Cells(colour));
            self.begin(out, colour, true);
            let cells = self.allocate_type(tree[position].ty)?;
            self.store_all(cells, &coordinates);
            self.homes.insert(position, Home::Cells(cells));
            self.begin(position, cells, true);
        }
        self.inline(function, None).map(drop)
    }

    /// A scope, or its body alone where nothing leaves it.
    pub(super) fn push_scope(&self, scope: crate::ir::function::Scope, mut body: Vec<Node>) {
        super::tail::shorten(&mut body, scope);
        if super::tail::leaves(&body, scope) {
            self.push(Node::Scope { scope, body });
        } else {
            self.draft.borrow_mut().block.extend(body);
        }
    }
}

/// How a parameter is passed.
pub(super) fn direction(kind: VariableKind) -> Direction {
    match kind {
        VariableKind::Parameter(direction) => direction,
        _ => Direction::In,
    }
}
