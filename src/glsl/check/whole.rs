//! What can be told once the whole text is read: calls without a body, recursion, and the function that paints (§6.1).

use std::collections::HashSet;

use super::Checker;
use crate::codes::Code;
use crate::tree::{Direction, FunctionId, Place, Type, VariableKind};

impl Checker<'_> {
    /// What can be told once all functions are known: every call has a body, and none comes back (§6.1.2).
    pub(crate) fn finish(&mut self) -> Option<FunctionId> {
        self.find_late_declarations();
        // Of what could not be read, nothing is said to be missing.
        let complete = self.errors.is_empty() && !self.lacks_names;
        let calls = std::mem::take(&mut self.calls);
        let mut told = HashSet::new();
        for &(_, callee, at) in &calls {
            if complete && self.tree[callee].body.is_none() && told.insert(callee) {
                let message = format!(
                    "`{}` is declared and called, but has no body",
                    self.tree[callee].name
                );
                self.report(
                    Code::Undefined
                        .at(at, message)
                        .related(self.tree[callee].at.span, "declared here"),
                );
            }
        }
        if let Some((function, at)) = self.find_recursion(&calls) {
            let message = format!(
                "by this call, `{}` comes to call itself",
                self.tree[function].name
            );
            let note = "GLSL has no stack, so no function may call itself: use a loop";
            self.report(Code::Recursion.at(at, message).note(note));
        }
        // A `main` was told to be no `mainImage`.
        if self
            .tree
            .functions
            .iter()
            .any(|(_, function)| function.name == "main")
        {
            return None;
        }
        if complete || (!self.lacks_names && self.words.find("mainImage").is_none()) {
            return self.main_image();
        }
        None
    }

    /// A function that is reached from itself, and the last call on that way.
    fn find_recursion(&self, calls: &[(FunctionId, FunctionId, Place)]) -> Option<(FunctionId, Place)> {
        let functions = self.tree.functions.len();
        let mut callees = vec![Vec::new(); functions];
        let mut callers = vec![0_usize; functions];
        for &(caller, callee, _) in calls {
            callees[caller.index()].push(callee.index());
            callers[callee.index()] += 1;
        }
        // Take away whoever nobody calls, again and again. Each that is left has a caller that is left.
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
        // So going from caller to caller leads into a circle: whoever is met twice is in it.
        let mut call_of = vec![None; functions];
        for &(caller, callee, at) in calls {
            if callers[caller.index()] > 0 {
                call_of[callee.index()] = Some((caller, at));
            }
        }
        let mut met = vec![false; functions];
        let mut function = self.tree.functions.ids().find(|id| callers[id.index()] > 0)?;
        loop {
            let (caller, at) = call_of[function.index()]?;
            if std::mem::replace(&mut met[function.index()], true) {
                return Some((function, at));
            }
            function = caller;
        }
    }

    /// `void mainImage(out vec4, in vec2)`, as the call that `ShaderToy` makes asks for it.
    fn main_image(&mut self) -> Option<FunctionId> {
        use crate::tree::Scalar::Float;
        let mut near = None;
        for (id, function) in self.tree.functions.iter() {
            if function.name != "mainImage" || function.body.is_none() {
                continue;
            }
            near = Some(function.at);
            let parameters = function
                .parameters
                .iter()
                .map(|&id| (self.tree[id].ty, self.tree[id].kind));
            let fits = matches!(
                parameters.collect::<Vec<_>>()[..],
                [
                    (
                        Type::Vector(Float, 4),
                        VariableKind::Parameter(Direction::Out | Direction::InOut)
                    ),
                    (
                        Type::Vector(Float, 2),
                        VariableKind::Parameter(Direction::In | Direction::ConstIn)
                    ),
                ]
            );
            if fits && function.return_type == Type::Void {
                return Some(id);
            }
        }
        let (at, message) = match near {
            Some(_) => (
                near,
                "this `mainImage` does not have the parameters that ShaderToy gives it",
            ),
            None => (self.end, "the shader has no function `mainImage`"),
        };
        let diagnostic = Code::NoMainImage.at(at?, message);
        let calls = "ShaderToy calls `void mainImage(out vec4 fragColor, in vec2 fragCoord)` for each pixel";
        self.report(diagnostic.note(calls));
        None
    }
}
