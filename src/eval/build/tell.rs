//! What is told of a pixel: an event for each value that a statement stores, decides on, or makes on the way.

use toyproof_glsl::tree::{Direction, ExprId, ExprKind, FunctionId, Place, Type};

use super::call::direction;
use super::place::Home;
use super::{Builder, Frame, layout};
use crate::ir::function::{NONE, Node, Value};
use crate::trace::story::{Call, CallId, Event, EventId, What};

/// Of larger values only the place is told: whole arrays of structures.
const MAX_COMPONENTS: usize = 16;

impl Builder<'_> {
    /// Tells of a value.
    pub(super) fn tell(&mut self, what: What, at: Place, ty: Type, values: &[Value]) {
        if !self.extras.story {
            return;
        }
        let id = self.plot.events.len() as u32;
        self.plot.events.push(Event {
            what,
            at,
            ty,
            call: self.frames.last().and_then(|frame| frame.call),
            round: self.rounds.last().copied(),
        });
        let told = if values.len() > MAX_COMPONENTS {
            &[]
        } else {
            values
        };
        if told.is_empty() {
            self.push(Node::Tell {
                event: id,
                component: 0,
                value: NONE,
            });
        }
        for (component, &value) in (0..).zip(told) {
            self.push(Node::Tell {
                event: id,
                component,
                value,
            });
        }
    }

    /// Tells what an expression makes; of names, numbers, and what is put together or told elsewhere, nothing.
    pub(super) fn tell_part(&mut self, expr: ExprId, values: &[Value]) {
        let tree = self.tree;
        let is_made = match &tree[expr].kind {
            ExprKind::Binary { .. }
            | ExprKind::Unary { .. }
            | ExprKind::Conditional { .. }
            | ExprKind::BuiltIn { .. } => tree.value(expr).is_none(),
            _ => false,
        };
        if is_made && layout::size(tree, tree[expr].ty) > 0 {
            self.tell(What::Part, tree[expr].at, tree[expr].ty, values);
        }
    }

    /// A round of a loop begins; what follows, up to [`Builder::end_rounds`], happens in it.
    pub(super) fn begin_round(&mut self, at: Place) {
        if self.extras.story {
            let id = EventId(self.plot.events.len() as u32);
            self.tell(What::Round, at, Type::Void, &[]);
            self.rounds.push(id);
        }
    }

    pub(super) fn end_rounds(&mut self) {
        self.rounds.pop();
    }

    /// Tells what a function is given.
    pub(super) fn tell_parameters(&mut self, function: FunctionId) {
        if !self.extras.story {
            return;
        }
        for &parameter in &self.tree[function].parameters {
            let variable = &self.tree[parameter];
            if direction(variable.kind) != Direction::Out
                && let Some(at) = variable.at
                && let Home::Cells(cells) = self.home(parameter)
            {
                let values = self.load_all(cells);
                self.tell(What::Stored(at), at, variable.ty, &values);
            }
        }
    }

    /// Names a call inside of the function that is being written.
    pub(super) fn name_call(&mut self, function: FunctionId, at: Place) -> Option<CallId> {
        let parent = self.frames.last().and_then(|frame: &Frame| frame.call);
        self.extras.story.then(|| {
            self.plot.calls.push(Call { function, at, parent });
            CallId(self.plot.calls.len() as u32 - 1)
        })
    }
}
