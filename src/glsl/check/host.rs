//! What a host adds to a shader: the values of the inputs that it sets, and the call of `main`.

use toyproof_diagnostic::{Code, plural};

use super::{Checker, Entity};
use crate::UniformMode;
use crate::dialect::{Bound, InputValue};
use crate::tree::{
    BinaryOp, BuiltInVariable, Constructor, Direction, ExprId, ExprKind, Function, FunctionId, Input, Item,
    Literal, Place, Sampler, SamplerShape, Scalar, Statement, StatementKind, Swizzle, Type, UnaryOp, Value,
    Variable, VariableId, VariableKind,
};

/// The names of the color in GLSL ES 1.00.
const FRAG_COLOR: &str = "gl_FragColor";
const FRAG_DATA: &str = "gl_FragData";

/// The minimum of `gl_MaxDrawBuffers` with `GL_EXT_draw_buffers`: the size of `gl_FragData`.
const MAX_DRAW_BUFFERS: u32 = 4;

const VEC2: Type = Type::Vector(Scalar::Float, 2);
const VEC3: Type = Type::Vector(Scalar::Float, 3);
const VEC4: Type = Type::Vector(Scalar::Float, 4);

/// Why these components are no value of a type; `None` if they are one.
fn misfit(ty: Type, components: &[f64]) -> Option<String> {
    let count = components.len();
    if ty.component_count().map(usize::from) != Some(count) {
        let noun = plural(count as u64, "component", "components");
        return Some(format!("has {count} {noun}"));
    }
    let integers = match ty.scalar() {
        Some(Scalar::Bool) => 0.0..=1.0,
        Some(Scalar::Int) => f64::from(i32::MIN)..=f64::from(i32::MAX),
        Some(Scalar::Uint) => 0.0..=f64::from(u32::MAX),
        Some(Scalar::Float) | None => return None,
    };
    let is_other = |component: &&f64| component.fract() != 0.0 || !integers.contains(component);
    let other = components.iter().find(is_other)?;
    Some(format!("has the component {other}"))
}

impl Checker<'_> {
    /// Declares `gl_FragColor` and `gl_FragData`, where the text uses them.
    pub(super) fn declare_old_outputs(&mut self) {
        if self.dialect.calls_main_image() || !self.language.version.has_old_names() {
            return;
        }
        for name in [FRAG_COLOR, FRAG_DATA] {
            let Some(symbol) = self.interner.find(name) else {
                continue;
            };
            let ty = match name {
                FRAG_DATA => self.tree.array_of(VEC4, MAX_DRAW_BUFFERS),
                _ => VEC4,
            };
            let variable = self
                .tree
                .variables
                .push(Variable::new(name, ty, VariableKind::Global, None));
            self.scopes.declare(symbol, Entity::Variable(variable));
            self.tree.items.push(Item::Variable(variable));
            self.output.get_or_insert(variable);
        }
    }

    /// Binds a global variable: a uniform to its value, an input to what the host sets, a sampler to a texture,
    /// and an output to the color.
    pub(super) fn bind(&mut self, variable: VariableId) {
        if self.tree[variable].kind == VariableKind::Uniform && self.bind_to_value(variable) {
            return;
        }
        if self.dialect.calls_main_image() {
            return;
        }
        let Variable { ty, kind, name, .. } = &self.tree[variable];
        let (ty, kind) = (*ty, *kind);
        if kind == VariableKind::Output {
            // Other outputs go to textures that nothing shows. Of an array, the first element is shown.
            let shown = match ty {
                Type::Array(id) => self.tree.array(id).element,
                _ => ty,
            };
            if self.output.is_none() && matches!(shown, VEC3 | VEC4) {
                self.tree[variable].kind = VariableKind::Global;
                self.output = Some(variable);
            }
            return;
        }
        if !matches!(kind, VariableKind::Uniform | VariableKind::Varying) {
            return;
        }
        let is_own = self.uniform_mode == UniformMode::Own
            && kind == VariableKind::Uniform
            && !matches!(ty, Type::Sampler(_));
        let known = self.dialect.input(name).filter(|_| !is_own);
        let known = known
            .into_iter()
            .flatten()
            .copied()
            .find(|&value| self.type_of_input(value) == ty);
        let value = known.or_else(|| match (kind, ty) {
            // The only coordinates of a quad that covers the image.
            (VariableKind::Varying, VEC2) => Some(InputValue::Quad),
            (VariableKind::Uniform, Type::Sampler(_)) => self.free_texture(ty),
            _ => None,
        });
        if let Some(value) = value {
            self.name_input(value, variable);
            self.bound.insert(variable, Bound::Input(value));
        }
    }

    /// The type of an input that the host sets; some of ShaderToy's are arrays.
    fn type_of_input(&self, value: InputValue) -> Type {
        let InputValue::Whole(input) = value else {
            return value.ty();
        };
        let mut variables = self.tree.variables.iter();
        let found = variables.find(|(_, variable)| variable.kind == VariableKind::Input(input));
        found.map_or_else(|| value.ty(), |(_, variable)| variable.ty)
    }

    /// Gives an input of ShaderToy the name that the text has for it, so that what is printed of the tree is
    /// text of its dialect.
    fn name_input(&mut self, value: InputValue, declared: VariableId) {
        let kind = match value {
            InputValue::Whole(input) | InputValue::First(input, 2..) => VariableKind::Input(input),
            InputValue::Texture(channel) => VariableKind::Channel(channel),
            _ => return,
        };
        let found = self
            .tree
            .variables
            .iter()
            .find(|(_, variable)| variable.kind == kind);
        if let Some((input, _)) = found {
            let name = self.tree[declared].name.clone();
            self.tree[input].name = name;
        }
    }

    /// Reports a texture that is read although no channel is left for it.
    pub(super) fn report_unbound_texture(&mut self, variable: VariableId, at: Place) {
        let Variable { kind, ty, name, .. } = &self.tree[variable];
        // On ShaderToy, nothing sets a declared sampler, whose 0 is the number of the first channel.
        if self.dialect.calls_main_image() {
            return;
        }
        if *kind == VariableKind::Uniform && *ty == Type::Sampler(Sampler::float(SamplerShape::D2)) {
            let message = format!("no channel is left for the texture `{name}`");
            let error = Code::NoChannelLeft.at(at, message);
            self.report(
                error.help("textures are read from four channels, in the order of their declarations"),
            );
        }
    }

    /// Binds a uniform to the value that the caller gives; returns whether there is one.
    fn bind_to_value(&mut self, variable: VariableId) -> bool {
        let Variable { name, ty, at, .. } = &self.tree[variable];
        let Some(given) = self.uniforms.iter().find(|given| given.name == *name) else {
            return false;
        };
        let (ty, at) = (*ty, *at);
        if let (Some(problem), Some(at)) = (misfit(ty, &given.components), at) {
            let ty = self.quoted_type(ty);
            let message = format!("the value of the uniform `{name}` {problem}, but it is {ty}");
            self.error(Code::BadType, at, message);
        } else {
            self.set_value(variable, given.components.clone());
        }
        true
    }

    /// Gives a uniform a value.
    fn set_value(&mut self, variable: VariableId, components: Vec<f64>) {
        let Variable { ty, at, .. } = self.tree[variable];
        let value = Bound::Value(ty, components);
        match at.filter(|_| self.uniform_mode != UniformMode::Replaced) {
            Some(at) => self.tree[variable].initializer = Some(self.bound_value(value, at)),
            None => {
                self.bound.insert(variable, value);
            }
        }
    }

    /// Binds a uniform to the constant with which desktop GLSL initializes it.
    pub(super) fn bind_to_default(&mut self, variable: VariableId, default: Option<ExprId>) {
        let Some(value) = default.and_then(|expr| self.tree.value(expr)) else {
            return;
        };
        let component = |value: &Value| match *value {
            Value::Bool(value) => f64::from(value),
            Value::Int(value) => f64::from(value),
            Value::Uint(value) => f64::from(value),
            Value::Float(value) => value,
        };
        let components = value.components().iter().map(component).collect();
        self.set_value(variable, components);
    }

    /// The first channel to which no sampler is bound, and none with a known name in the text.
    fn free_texture(&self, ty: Type) -> Option<InputValue> {
        let textures = (0..4).map(InputValue::Texture);
        let is_bound =
            |texture: &InputValue| self.bound.values().any(|bound| *bound == Bound::Input(*texture));
        let is_named = |texture: &InputValue| {
            let mut names = self.dialect.names_of(*texture);
            names.any(|name| self.interner.find(name).is_some())
        };
        let mut free = textures.filter(|texture| !is_bound(texture) && !is_named(texture));
        free.find(|texture| texture.ty() == ty)
    }

    /// The value of an input that the host sets although the text does not declare it.
    pub(super) fn implicit_input(&self, name: &str) -> Option<InputValue> {
        let values = self.dialect.input(name).filter(|_| self.dialect.is_implicit());
        values?.first().copied()
    }

    /// The expression of a variable that has a value.
    pub(super) fn bound_value(&mut self, bound: Bound, at: Place) -> ExprId {
        match bound {
            Bound::Input(value) => self.host_input(value, at),
            Bound::Value(ty, components) => {
                let scalar = ty.scalar().unwrap_or(Scalar::Float);
                let literals = components.iter().map(|&component| {
                    let value = match scalar {
                        Scalar::Bool => Value::Bool(component != 0.0),
                        Scalar::Int => Value::Int(component as i32),
                        Scalar::Uint => Value::Uint(component as u32),
                        Scalar::Float => Value::Float(component),
                    };
                    self.value(value, at)
                });
                let literals: Vec<ExprId> = literals.collect();
                match (ty, &literals[..]) {
                    (Type::Scalar(_), &[only]) => only,
                    (Type::Matrix { .. }, _) => self.push_constructor(Constructor::Matrix, ty, literals, at),
                    _ => self.vector(literals, ty, at),
                }
            }
        }
    }

    /// The expression of an input that the host sets.
    pub(super) fn host_input(&mut self, value: InputValue, at: Place) -> ExprId {
        match value {
            InputValue::Whole(input) => self.input(VariableKind::Input(input), at),
            InputValue::First(input, size) => {
                let whole = self.input(VariableKind::Input(input), at);
                self.first(whole, size, at)
            }
            InputValue::Float(input) => {
                let integer = self.input(VariableKind::Input(input), at);
                self.push_constructor(Constructor::Scalar, Type::FLOAT, vec![integer], at)
            }
            InputValue::Mouse => {
                let mouse = self.host_input(InputValue::First(Input::Mouse, 2), at);
                self.over_resolution(mouse, at)
            }
            InputValue::MouseDown => {
                let mouse = self.input(VariableKind::Input(Input::Mouse), at);
                let click = self.components(mouse, &[2], at);
                let zero = self.number(0.0, at);
                self.operation(BinaryOp::Greater, click, zero, Type::BOOL, at)
            }
            InputValue::Quad => {
                let position = self.input(VariableKind::BuiltIn(BuiltInVariable::FragCoord), at);
                let position = self.first(position, 2, at);
                self.over_resolution(position, at)
            }
            InputValue::QuadInSpace => {
                let quad = self.host_input(InputValue::Quad, at);
                let zero = self.number(0.0, at);
                self.vector(vec![quad, zero], VEC3, at)
            }
            InputValue::Surface => {
                let quad = self.host_input(InputValue::Quad, at);
                let half = self.number(0.5, at);
                let centered = self.operation(BinaryOp::Subtract, quad, half, VEC2, at);
                let size = self.host_input(InputValue::SurfaceSize, at);
                self.operation(BinaryOp::Multiply, centered, size, VEC2, at)
            }
            InputValue::SurfaceSize => {
                let [width, height] = [0, 1].map(|component| {
                    let resolution = self.input(VariableKind::Input(Input::Resolution), at);
                    self.components(resolution, &[component], at)
                });
                let aspect = self.operation(BinaryOp::Divide, width, height, Type::FLOAT, at);
                let one = self.number(1.0, at);
                self.vector(vec![aspect, one], VEC2, at)
            }
            InputValue::TextureSize(channel) => {
                let size = self.of_channel(Input::ChannelResolution, channel, at);
                self.first(size, 2, at)
            }
            InputValue::Texture(channel) => self.input(VariableKind::Channel(channel), at),
            InputValue::Constant(values) => {
                let numbers = values
                    .iter()
                    .map(|&value| self.number(value, at))
                    .collect::<Vec<_>>();
                match numbers[..] {
                    [number] => number,
                    _ => self.vector(numbers, value.ty(), at),
                }
            }
        }
    }

    /// The first components of a vector.
    fn first(&mut self, vector: ExprId, size: u8, at: Place) -> ExprId {
        self.components(vector, &[0, 1, 2, 3][..usize::from(size)], at)
    }

    fn components(&mut self, vector: ExprId, components: &[u8], at: Place) -> ExprId {
        let components = Swizzle::new(components).expect("the table names one to four components");
        let ty = Type::vector(Scalar::Float, components.size());
        self.push(ExprKind::Swizzle { vector, components }, ty, false, at)
    }

    fn over_resolution(&mut self, left: ExprId, at: Place) -> ExprId {
        let resolution = self.host_input(InputValue::First(Input::Resolution, 2), at);
        self.operation(BinaryOp::Divide, left, resolution, VEC2, at)
    }

    fn operation(&mut self, op: BinaryOp, left: ExprId, right: ExprId, ty: Type, at: Place) -> ExprId {
        self.push(ExprKind::Binary { op, left, right }, ty, false, at)
    }

    fn number(&mut self, value: f64, at: Place) -> ExprId {
        self.value(Value::Float(value), at)
    }

    /// The expression of a scalar; literals have no sign.
    fn value(&mut self, value: Value, at: Place) -> ExprId {
        let (magnitude, is_negative) = match value {
            Value::Float(value) => (Value::Float(value.abs()), value.is_sign_negative()),
            Value::Int(value) if value > i32::MIN => (Value::Int(value.abs()), value < 0),
            _ => (value, false),
        };
        let text = match magnitude {
            Value::Bool(value) => value.to_string(),
            Value::Int(value) => value.to_string(),
            Value::Uint(value) => format!("{value}u"),
            Value::Float(value) => format!("{value:?}"),
        };
        let operand = self.literal(Literal::new(text, magnitude), at);
        if !is_negative {
            return operand;
        }
        let op = UnaryOp::Minus;
        self.push(ExprKind::Unary { op, operand }, magnitude.ty(), true, at)
    }

    fn vector(&mut self, arguments: Vec<ExprId>, ty: Type, at: Place) -> ExprId {
        self.push_constructor(Constructor::Vector, ty, arguments, at)
    }

    /// The entry point of a host that runs `main`: a function that calls it, and returns its color.
    pub(super) fn entry_of_main(&mut self) -> Option<FunctionId> {
        let main = self
            .tree
            .functions
            .iter()
            .find(|(_, function)| function.name == "main")?;
        let (
            main,
            Function {
                at,
                return_type,
                parameters,
                ..
            },
        ) = main;
        let at = *at;
        if *return_type != Type::Void || !parameters.is_empty() {
            let diagnostic = Code::NoMainImage.at(at, "`main` must have the form `void main()`");
            self.report(diagnostic);
            return None;
        }
        let mut parameter = |ty, name: &str, direction| {
            let kind = VariableKind::Parameter(direction);
            self.tree.variables.push(Variable::new(name, ty, kind, None))
        };
        let color = parameter(VEC4, "color", Direction::Out);
        let position = parameter(VEC2, "position", Direction::In);
        let arguments = Vec::new();
        let call = self.push(
            ExprKind::Call {
                function: main,
                arguments,
            },
            Type::Void,
            false,
            at,
        );
        let mut body = vec![Statement::new(StatementKind::Expression(call), at)];
        if let Some(output) = self.output {
            let target = self.push(ExprKind::Variable(color), VEC4, false, at);
            let value = self.shown_color(output, at);
            let op = None;
            let assignment = self.push(ExprKind::Assign { op, target, value }, VEC4, false, at);
            body.push(Statement::new(StatementKind::Expression(assignment), at));
        }
        let entry = self.tree.functions.push(Function {
            name: "mainImage".to_owned(),
            return_type: Type::Void,
            parameters: vec![color, position],
            body: Some(body),
            at,
        });
        self.tree.items.push(Item::Function(entry));
        Some(entry)
    }

    /// The value of an output as a color.
    fn shown_color(&mut self, output: VariableId, at: Place) -> ExprId {
        let mut ty = self.tree[output].ty;
        let mut value = self.push(ExprKind::Variable(output), ty, false, at);
        if let Type::Array(id) = ty {
            ty = self.tree.array(id).element;
            let index = self.int_literal(0, at);
            value = self.index(value, index, at);
        }
        if ty == VEC3 {
            let one = self.number(1.0, at);
            value = self.vector(vec![value, one], VEC4, at);
        }
        value
    }
}
