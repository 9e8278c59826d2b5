//! Side effects: assignments, increments and calls.

use toyproof_glsl::tree::{
    BinaryOp, Direction, ExprId, ExprKind, FunctionId, Scalar, StepOp, Swizzle, Type, VariableId,
    VariableKind, walk,
};

use super::Unprintable;
use super::writer::{Class, Text, TextResult, Writer, is_out};

impl Writer<'_> {
    /// Prints the side effects of an expression; its value is not used.
    pub(super) fn effect(&mut self, id: ExprId) -> Result<(), Unprintable> {
        let tree = &self.cx.tree;
        match &tree[id].kind {
            &ExprKind::Assign { op, target, value } => self.assign(op, target, value),
            &ExprKind::Step { op, target, .. } => self.step(op, target),
            &ExprKind::Sequence { first, second } => {
                self.effect(first)?;
                self.effect(second)
            }
            &ExprKind::Conditional { condition, yes, no } => {
                let condition = self.value(condition)?;
                self.line(&format!("if {} {{", condition.code));
                self.indented(|writer| writer.effect(yes))?;
                self.line("} else {");
                self.indented(|writer| writer.effect(no))?;
                self.line("}");
                Ok(())
            }
            ExprKind::Call { .. } => {
                let call = self.value(id)?;
                // A call with copied arguments is printed already.
                if call.code.ends_with(')') {
                    self.line(&format!("{};", call.code));
                }
                Ok(())
            }
            ExprKind::Binary {
                op: BinaryOp::And | BinaryOp::Or,
                ..
            } if self.hoists(id) => {
                self.value(id)?;
                Ok(())
            }
            kind => {
                let mut operands = Vec::new();
                kind.for_each_operand(|operand| operands.push(operand));
                operands.into_iter().try_for_each(|operand| self.effect(operand))
            }
        }
    }

    fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId) -> Result<(), Unprintable> {
        let tree = &self.cx.tree;
        let types = (tree[target].ty, tree[value].ty);
        if self.branch_operands(value).is_some() && !walk::has_side_effects(tree, target) {
            return self.print_if(value, &mut |writer, value| writer.assign(op, target, value));
        }
        let is_swizzle =
            matches!(tree[target].kind, ExprKind::Swizzle { components, .. } if components.size() > 1);
        let Some(op) = op else {
            let value = self.value(value)?;
            return self.set(target, &value);
        };
        let is_matrix = matches!(types.0, Type::Matrix { .. }) || matches!(types.1, Type::Matrix { .. });
        let shifts = matches!(op, BinaryOp::ShiftLeft | BinaryOp::ShiftRight);
        let of_bits = matches!(op, BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor);
        // WGSL shifts by unsigned integers, and has no bit operations of a vector and a scalar.
        let needs_types = shifts || (of_bits && types.0 != types.1);
        if is_swizzle || is_matrix || needs_types {
            // GLSL does not specify when the target is read; WebGL's translators read it last.
            let value = self.compound_operand(target, value)?;
            let before = self.value(target)?;
            let after = self.operation(op, (before, types.0), (value, types.1))?;
            return self.set(target, &after);
        }
        let value = self.compound_operand(target, value)?;
        let target = self.value(target)?.code;
        self.line(&format!("{target} {}= {};", op.symbol(), value.code));
        Ok(())
    }

    /// Prints the right side of a compound assignment, bound to a name if a call in it may change the target,
    /// which WGSL reads first.
    fn compound_operand(&mut self, target: ExprId, value: ExprId) -> TextResult {
        let text = self.value(value)?;
        if text.code.contains('(') && self.may_change(target, value) {
            return Ok(self.bind_as("value", &text));
        }
        Ok(text)
    }

    fn may_change(&self, target: ExprId, value: ExprId) -> bool {
        let tree = &self.cx.tree;
        let Some(root) = tree.root_variable(target) else {
            return true;
        };
        let is_global = tree[root].kind == VariableKind::Global;
        walk::any(tree, value, |kind| match kind {
            ExprKind::Call { function, arguments } => {
                let mut given = arguments.iter().zip(&tree[*function].parameters);
                is_global
                    || given.any(|(&argument, &parameter)| {
                        is_out(self.cx, parameter) && tree.root_variable(argument) == Some(root)
                    })
            }
            _ => false,
        })
    }

    /// Prints an assignment of a value.
    pub(super) fn set(&mut self, target: ExprId, value: &Text) -> Result<(), Unprintable> {
        match self.cx.tree[target].kind {
            ExprKind::Swizzle { vector, components } if components.size() > 1 => {
                let letters = self.source.letters(components, self.cx.tree[target].at);
                self.set_components(vector, components, &letters, value)
            }
            _ => {
                let target = self.value(target)?.code;
                self.line(&format!("{target} = {};", value.code));
                Ok(())
            }
        }
    }

    /// Prints `v.xz = value` as `v = vec3f(value.x, v.y, value.y)`.
    fn set_components(
        &mut self,
        vector: ExprId,
        components: Swizzle,
        letters: &str,
        value: &Text,
    ) -> Result<(), Unprintable> {
        let Type::Vector(_, size) = self.cx.tree[vector].ty else {
            return Err(Unprintable::Construct("a swizzle of a non-vector"));
        };
        let chosen = components.components();
        let ascending = chosen.windows(2).all(|pair| pair[1] == pair[0] + 1);
        let base = self.value(vector)?;
        let target = base.code.clone();
        let base = base.operand();
        if ascending && chosen.len() == usize::from(size) {
            self.line(&format!("{target} = {};", value.code));
            return Ok(());
        }
        let all = if letters.contains(['r', 'g', 'b', 'a']) {
            "rgba"
        } else {
            "xyzw"
        };
        let letter = |index: usize| all.get(index..=index).unwrap_or("x");
        let mut parts = Vec::new();
        // A call may change the vector that provides the other components.
        let root = self.cx.tree.root_variable(vector);
        let may_change =
            value.code.contains('(') && root.is_some_and(|id| self.cx.tree[id].kind == VariableKind::Global);
        let whole = if ascending && !may_change {
            value.clone()
        } else {
            self.bind_as(letters, value)
        };
        let mut at = 0;
        while at < usize::from(size) {
            match chosen.iter().position(|&component| usize::from(component) == at) {
                Some(_) if ascending => {
                    parts.push(whole.code.clone());
                    at += chosen.len();
                    continue;
                }
                Some(place) => parts.push(format!("{}.{}", whole.code, letter(place))),
                None => parts.push(format!("{base}.{}", letter(at))),
            }
            at += 1;
        }
        let ty = self.type_name(self.cx.tree[vector].ty);
        self.line(&format!("{target} = {ty}({});", parts.join(", ")));
        Ok(())
    }

    /// Prints `x++` or `x -= 1.0`.
    pub(super) fn step(&mut self, op: StepOp, target: ExprId) -> Result<(), Unprintable> {
        let target_text = self.value(target)?;
        let sign = if op == StepOp::Increment { '+' } else { '-' };
        let ty = self.cx.tree[target].ty;
        let target_text = target_text.code;
        match ty {
            Type::Scalar(Scalar::Int | Scalar::Uint) => self.line(&format!("{target_text}{sign}{sign};")),
            Type::Scalar(_) => self.line(&format!("{target_text} {sign}= 1.0;")),
            _ => {
                let one = match ty.scalar() {
                    Some(Scalar::Float) => "1.0",
                    Some(Scalar::Uint) => "1u",
                    _ => "1",
                };
                if matches!(ty, Type::Matrix { .. }) {
                    return Err(Unprintable::Construct("`++` or `--` of a matrix"));
                }
                if matches!(self.cx.tree[target].kind, ExprKind::Swizzle { .. }) {
                    let after = Text::new(format!("{target_text} {sign} {one}"), Class::Sum);
                    return self.set(target, &after);
                }
                self.line(&format!("{target_text} {sign}= {one};"));
            }
        }
        Ok(())
    }
}

impl Writer<'_> {
    /// The pointer for an `out` argument, if it is a variable that WGSL can pass by pointer: a local one.
    /// Others are copied in and out.
    pub(super) fn pointer(&self, argument: ExprId) -> Option<String> {
        let ExprKind::Variable(id) = self.cx.tree[argument].kind else {
            return None;
        };
        match self.cx.tree[id].kind {
            _ if is_out(self.cx, id) => Some(self.variable(id).to_owned()),
            VariableKind::Local | VariableKind::Parameter(_) => Some(format!("&{}", self.variable(id))),
            _ => None,
        }
    }

    /// Prints a call of one of the author's functions.
    pub(super) fn call(&mut self, function: FunctionId, arguments: &[ExprId], ty: Type) -> TextResult {
        let parameters = &self.cx.tree[function].parameters;
        let mut plain = Vec::new();
        let mut back = Vec::new();
        for (&argument, &parameter) in arguments.iter().zip(parameters) {
            if !is_out(self.cx, parameter) {
                plain.push(argument);
            } else if self.pointer(argument).is_none() {
                back.push(argument);
            }
        }
        let mut values = self.values(&plain)?.into_iter();
        let mut copies = Vec::new();
        for &argument in &back {
            let value = self.value(argument)?;
            let name = self.temporary(&format!(
                "{}_copy",
                value.code.rsplit('.').next().unwrap_or_default()
            ));
            self.line(&format!("var {name} = {};", value.code));
            copies.push((argument, name));
        }
        let mut names = copies.iter();
        let mut texts = Vec::new();
        for (&argument, &parameter) in arguments.iter().zip(parameters) {
            texts.push(if !is_out(self.cx, parameter) {
                values.next().ok_or(Unprintable::Construct("this call"))?
            } else if let Some(pointer) = self.pointer(argument) {
                Text::primary(pointer)
            } else {
                let (_, name) = names.next().ok_or(Unprintable::Construct("this call"))?;
                Text::primary(format!("&{name}"))
            });
        }
        let call = format!("{}({})", self.function(function), Self::list(texts));
        if copies.is_empty() {
            return Ok(Text::primary(call));
        }
        let result = if ty == Type::Void {
            self.line(&format!("{call};"));
            Text::primary("")
        } else {
            self.bind_as("result", &Text::primary(call))
        };
        for (argument, name) in copies {
            self.set(argument, &Text::primary(name))?;
        }
        Ok(result)
    }
}

impl Writer<'_> {
    /// Prints a statement by `print`, and then the increments that can be deferred: `stack[top++] = x`
    /// becomes `stack[top] = x; top++;` if nothing else in the statement names `top`.
    pub(super) fn with_deferred_steps(
        &mut self,
        root: ExprId,
        print: impl FnOnce(&mut Self) -> Result<(), Unprintable>,
    ) -> Result<(), Unprintable> {
        let steps = self.deferrable_steps(root);
        self.deferred_steps.extend(steps.iter().map(|&(id, ..)| id));
        print(self)?;
        for (_, op, target) in steps {
            self.step(op, target)?;
        }
        Ok(())
    }

    /// Collects the unconditional postfix increments within an expression that can be deferred.
    fn deferrable_steps(&self, root: ExprId) -> Vec<(ExprId, StepOp, ExprId)> {
        let tree = &self.cx.tree;
        let calls = walk::any(tree, root, |kind| matches!(kind, ExprKind::Call { .. }));
        let mut steps = Vec::new();
        let mut pending = Vec::new();
        let mut id = root;
        loop {
            match tree[id].kind {
                ExprKind::Step {
                    op,
                    postfix: true,
                    target,
                } if id != root => {
                    if let ExprKind::Variable(variable) = tree[target].kind
                        && self.is_unobserved(variable, calls)
                        && mentions(self, root, variable) == 1
                    {
                        steps.push((id, op, target));
                    }
                }
                ExprKind::Conditional { condition: first, .. }
                | ExprKind::Binary {
                    op: BinaryOp::And | BinaryOp::Or,
                    left: first,
                    ..
                } => pending.push(first),
                ExprKind::Sequence { .. } => {}
                ref kind => kind.for_each_operand(|operand| pending.push(operand)),
            }
            match pending.pop() {
                Some(next) => id = next,
                None => return steps,
            }
        }
    }

    /// Whether only the statement itself can observe when a variable is incremented.
    fn is_unobserved(&self, variable: VariableId, calls: bool) -> bool {
        let variable = &self.cx.tree[variable];
        let is_number = matches!(variable.ty, Type::Scalar(_));
        is_number
            && match variable.kind {
                VariableKind::Local | VariableKind::Parameter(Direction::In) => true,
                VariableKind::Global => !calls,
                _ => false,
            }
    }
}

/// The number of times that a name occurs in an expression.
fn mentions(writer: &Writer<'_>, root: ExprId, variable: VariableId) -> usize {
    let tree = &writer.cx.tree;
    let name = writer.variable(variable);
    let named = tree
        .postorder(root)
        .into_iter()
        .filter(|&id| match tree[id].kind {
            ExprKind::Variable(other) => writer.variable(other) == name,
            _ => false,
        });
    named.count()
}
