//! Expressions (§5): operands are evaluated from left to right.

use toyproof::eval::Fault;
use toyproof::glsl::tree::{
    self, BinaryOp, BuiltInVariable, Direction, ExprId, ExprKind, FunctionId, StepOp, Type, VariableId,
    VariableKind,
};

use super::real::Real;
use super::value::{Component, Place, Value, elements, member_start, size, zero};
use super::{Result, Run};

impl<N: Real> Run<'_, N> {
    /// The value of an expression; no components for `void`.
    pub(super) fn value(&mut self, expr: ExprId) -> Result<Value<N>, N> {
        self.step()?;
        let tree = self.tree;
        if let Some(place) = self.place(expr)? {
            return Ok(self.read(&place));
        }
        Ok(match &tree[expr].kind {
            ExprKind::Literal(literal) => vec![match literal.value {
                tree::Value::Bool(value) => Component::Bool(value),
                tree::Value::Int(value) => Component::Int(value),
                tree::Value::Uint(value) => Component::Uint(value),
                tree::Value::Float(value) => Component::float(value),
            }],
            ExprKind::Variable(variable) => self.constant(*variable),
            &ExprKind::Unary { op, operand } => {
                let value = self.value(operand)?;
                value
                    .into_iter()
                    .map(|component| super::operator::unary(op, component))
                    .collect()
            }
            &ExprKind::Binary { op, left, right } => match op {
                BinaryOp::And => vec![Component::Bool(self.condition(left)? && self.condition(right)?)],
                BinaryOp::Or => vec![Component::Bool(self.condition(left)? || self.condition(right)?)],
                _ => {
                    let (a, b) = (self.value(left)?, self.value(right)?);
                    self.binary(op, (tree[left].ty, &a), (tree[right].ty, &b), expr)
                }
            },
            &ExprKind::Assign { op, target, value } => {
                // The indices of the target are evaluated first, its value is read last, as in WebGL 2.
                let place = self.place(target)?.expect("a target is a place");
                let mut value_after = self.value(value)?;
                if let Some(op) = op {
                    let before = self.read(&place);
                    let types = (tree[target].ty, tree[value].ty);
                    value_after = self.binary(op, (types.0, &before), (types.1, &value_after), expr);
                }
                self.write(&place, &value_after);
                value_after
            }
            &ExprKind::Step { op, postfix, target } => {
                let place = self.place(target)?.expect("a target is a place");
                let before = self.read(&place);
                let after: Value<N> = before.iter().map(|&component| step(op, component)).collect();
                self.write(&place, &after);
                if postfix { before } else { after }
            }
            &ExprKind::Conditional { condition, yes, no } => {
                let chosen = if self.condition(condition)? { yes } else { no };
                self.value(chosen)?
            }
            &ExprKind::Sequence { first, second } => {
                self.value(first)?;
                self.value(second)?
            }
            ExprKind::Call { function, arguments } => self.call(*function, arguments, expr)?,
            ExprKind::BuiltIn { function, arguments } => self.built_in(*function, arguments, expr)?,
            ExprKind::Construct {
                constructor,
                arguments,
            } => self.construct(*constructor, tree[expr].ty, arguments)?,
            ExprKind::Swizzle { vector, components } => {
                let value = self.value(*vector)?;
                let chosen = components.components().iter();
                chosen.map(|&at| value[usize::from(at)]).collect()
            }
            &ExprKind::Member { structure, member } => {
                let value = self.value(structure)?;
                let start = member_start(tree, tree[structure].ty, member);
                value[start..start + size(tree, tree[expr].ty)].to_vec()
            }
            &ExprKind::Index { base, index } => {
                let value = self.value(base)?;
                let (element, count) = elements(tree, tree[base].ty);
                let at = self.index(index, count)? * size(tree, element);
                value[at..at + size(tree, element)].to_vec()
            }
            &ExprKind::Length { array } => {
                let (_, count) = elements(tree, tree[array].ty);
                vec![Component::Int(count as i32)]
            }
        })
    }

    /// The value of a variable that cannot be written.
    fn constant(&self, variable: VariableId) -> Value<N> {
        let variable = &self.tree[variable];
        match variable.kind {
            VariableKind::Input(input) => self.input(input, variable.ty),
            VariableKind::BuiltIn(BuiltInVariable::FragCoord) => self.frag_coord(),
            VariableKind::BuiltIn(BuiltInVariable::FrontFacing) => vec![Component::Bool(true)],
            VariableKind::BuiltInConstant => {
                let value = variable.value.as_ref().and_then(tree::Constant::integer);
                vec![Component::Int(
                    value.expect("a built-in constant is an integer") as i32
                )]
            }
            _ => zero(self.tree, variable.ty),
        }
    }

    /// Whether a variable is stored, so that its parts are places.
    fn is_stored(&self, variable: VariableId) -> bool {
        !matches!(self.tree[variable].ty, Type::Sampler(_))
            && !matches!(
                self.tree[variable].kind,
                VariableKind::Input(_)
                    | VariableKind::Channel(_)
                    | VariableKind::Uniform
                    | VariableKind::Varying
                    | VariableKind::BuiltInConstant
                    | VariableKind::BuiltIn(
                        BuiltInVariable::FragCoord
                            | BuiltInVariable::FrontFacing
                            | BuiltInVariable::PointCoord
                    )
            )
    }

    /// The part of a variable that an expression denotes, with its indices evaluated; none if it denotes a value.
    fn place(&mut self, expr: ExprId) -> Result<Option<Place>, N> {
        let tree = self.tree;
        if !tree.root_variable(expr).is_some_and(|root| self.is_stored(root)) {
            return Ok(None);
        }
        let base = match tree[expr].kind {
            ExprKind::Variable(variable) => {
                return Ok(Some(Place {
                    variable,
                    components: (0..size(tree, tree[variable].ty)).collect(),
                }));
            }
            ExprKind::Swizzle { vector: base, .. }
            | ExprKind::Member { structure: base, .. }
            | ExprKind::Index { base, .. } => base,
            _ => return Ok(None),
        };
        let Some(Place { variable, components }) = self.place(base)? else {
            return Ok(None);
        };
        let components = match tree[expr].kind {
            ExprKind::Swizzle {
                components: swizzle, ..
            } => {
                let chosen = swizzle.components().iter();
                chosen.map(|&at| components[usize::from(at)]).collect()
            }
            ExprKind::Member { member, .. } => {
                let start = member_start(tree, tree[base].ty, member);
                components[start..start + size(tree, tree[expr].ty)].to_vec()
            }
            ExprKind::Index { index, .. } => {
                let (element, count) = elements(tree, tree[base].ty);
                let at = self.index(index, count)? * size(tree, element);
                components[at..at + size(tree, element)].to_vec()
            }
            _ => components,
        };
        Ok(Some(Place { variable, components }))
    }

    /// An index within bounds: one that is not becomes the last, a negative one, too.
    fn index(&mut self, index: ExprId, count: usize) -> Result<usize, N> {
        // Constant expressions that must be integers have one value, which the front end has checked.
        if let Some(constant) = self.tree.value(index).and_then(|value| value.integer())
            && let Ok(at) = usize::try_from(constant)
            && at < count
        {
            return Ok(at);
        }
        let value = self.value(index)?[0];
        let bits = value.bits() as usize;
        self.fault(Fault::IndexOutOfBounds, index, bits >= count);
        let bounded = value.with_bits(bits.min(count - 1) as u32);
        Ok(self.settle(bounded).bits() as usize)
    }

    /// Assigns a value to an lvalue.
    pub(super) fn assign(&mut self, target: ExprId, value: &[Component<N>]) -> Result<(), N> {
        let place = self.place(target)?.expect("a target is a place");
        self.write(&place, value);
        Ok(())
    }

    fn read(&mut self, place: &Place) -> Value<N> {
        let variable = self.variable(place.variable);
        place.components.iter().map(|&at| variable[at]).collect()
    }

    fn write(&mut self, place: &Place, value: &[Component<N>]) {
        let variable = self.variable(place.variable);
        for (&at, &component) in place.components.iter().zip(value) {
            variable[at] = component;
        }
    }

    /// The value of a variable that is stored. `gl_FragDepth` is not declared; it is zero until it is written.
    fn variable(&mut self, variable: VariableId) -> &mut Value<N> {
        let tree = self.tree;
        self.variables
            .entry(variable)
            .or_insert_with(|| zero(tree, tree[variable].ty))
    }

    /// Calls a function: parameters are copied in when all arguments are evaluated, and out after the call.
    fn call(&mut self, function: FunctionId, arguments: &[ExprId], expr: ExprId) -> Result<Value<N>, N> {
        enum Argument<N> {
            Sampler(Option<u8>),
            Value(Value<N>),
            Place(Place),
        }
        let tree = self.tree;
        let parameters = &tree[function].parameters;
        let mut passed = Vec::new();
        for (&argument, &parameter) in arguments.iter().zip(parameters) {
            let VariableKind::Parameter(direction) = tree[parameter].kind else {
                panic!("a parameter has a direction");
            };
            // As in glslang, a variable is read after all arguments, unless the parameter is `const in`.
            let is_read_later = direction != Direction::ConstIn;
            let passed_as = if matches!(tree[argument].ty, Type::Sampler(_)) {
                Argument::Sampler(self.channel(argument))
            } else if is_read_later && let Some(place) = self.place(argument)? {
                Argument::Place(place)
            } else {
                Argument::Value(self.value(argument)?)
            };
            passed.push((parameter, direction, passed_as));
        }
        let mut copied_out = Vec::new();
        let mut copied_in = Vec::new();
        for (parameter, direction, argument) in passed {
            match argument {
                Argument::Sampler(channel) => {
                    self.samplers.insert(parameter, channel);
                }
                Argument::Value(value) => copied_in.push((parameter, value)),
                Argument::Place(place) => {
                    copied_in.push(match direction {
                        Direction::Out => (parameter, zero(tree, tree[parameter].ty)),
                        _ => (parameter, self.read(&place)),
                    });
                    if matches!(direction, Direction::Out | Direction::InOut) {
                        copied_out.push((parameter, place));
                    }
                }
            }
        }
        self.variables.extend(copied_in);
        self.path.push(expr.index() as u32);
        let result = self.body(function)?;
        self.path.pop();
        for (parameter, place) in copied_out {
            let value = self.variables[&parameter].clone();
            self.write(&place, &value);
        }
        Ok(result)
    }

    /// The channel that a sampler reads; none if nothing is bound to it.
    pub(super) fn channel(&self, sampler: ExprId) -> Option<u8> {
        let ExprKind::Variable(variable) = self.tree[sampler].kind else {
            return None;
        };
        match self.tree[variable].kind {
            VariableKind::Channel(channel) => Some(channel),
            _ => self.samplers.get(&variable).copied().flatten(),
        }
    }
}

fn step<N: Real>(op: StepOp, component: Component<N>) -> Component<N> {
    let up = op == StepOp::Increment;
    match component {
        Component::Float(value) => {
            let one = N::from_f64(1.0);
            Component::Float(if up { value + one } else { value - one })
        }
        _ => component.with_bits(component.bits().wrapping_add(if up { 1 } else { u32::MAX })),
    }
}
