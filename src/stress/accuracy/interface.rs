//! The inputs and outputs of a function, component by component, and calls of it as text.

use std::ops::Range;

use thiserror::Error;
use toyproof_diagnostic::nearest;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{Direction, Function, Scalar, Tree, Type, VariableKind};

use super::Case;

/// The most components that the inputs, or the outputs, may have: sixteen vectors.
const MAX_COMPONENTS: usize = 64;

/// A function, with the components of its inputs and outputs.
#[derive(Debug, Clone)]
pub struct Interface {
    /// The name.
    pub name: String,
    /// The declaration without a body: `float box(vec3 p, vec3 b)`.
    pub prototype: String,
    /// The components of parameters that are `in` or `inout`, in order.
    pub inputs: Vec<Component>,
    /// The components of the result, then those of parameters that are `out` or `inout`.
    pub outputs: Vec<Component>,
    /// The float vectors among the inputs.
    pub(super) vectors: Vec<Range<usize>>,
    pub(super) parameters: Vec<Parameter>,
    /// The declaration of a variable for the result; `None` for void.
    pub(super) result: Option<String>,
    /// The byte of the function's name in the text.
    pub(super) name_at: usize,
}

/// A scalar that is a part of an input or output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// What identifies it: `p.x`, `ray.origin.y`, `m[1].x`; `result` is the function's result.
    pub path: String,
    /// The expression for it in the generated shader.
    pub(super) code: String,
    /// The type.
    pub(super) scalar: Scalar,
}

#[derive(Debug, Clone)]
pub(super) struct Parameter {
    /// The name in the source, or a made-up one.
    pub(super) name: String,
    /// The declaration of a variable of its type, without a name that the source uses.
    pub(super) declaration: String,
    /// The same with the name in the source.
    own_declaration: String,
    direction: Direction,
    /// The components among the inputs.
    inputs: Range<usize>,
    shape: Shape,
}

/// How a value is written.
#[derive(Debug, Clone)]
enum Shape {
    Scalar(Scalar),
    /// A constructor with its arguments.
    Composed(String, Vec<Self>),
}

/// Why a function cannot be examined, in a sentence.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct Unsupported(pub String);

impl Interface {
    /// The function of that name; of several, the first that can be examined.
    ///
    /// # Errors
    /// States that there is none, or why it cannot be examined.
    pub fn new(checked: &Checked, name: &str) -> Result<Self, Unsupported> {
        let tree = &checked.tree;
        let mut why = None;
        for (_, function) in defined(tree).filter(|(_, function)| function.name == name) {
            match Self::of(tree, function) {
                Ok(interface) => return Ok(interface),
                Err(reason) => why = why.or(Some(reason)),
            }
        }
        Err(Unsupported(why.unwrap_or_else(|| {
            let names = || defined(tree).map(|(_, function)| function.name.as_str());
            let known: Vec<_> = names().collect();
            match nearest(name, names()) {
                Some(near) => format!("there is no function `{name}`; did you mean `{near}`?"),
                None => format!(
                    "there is no function `{name}`; the shader has {}",
                    known.join(", ")
                ),
            }
        })))
    }

    /// The names of the functions that can be examined, without the one that the host calls.
    #[must_use]
    pub fn names(checked: &Checked) -> Vec<String> {
        let tree = &checked.tree;
        let others = defined(tree).filter(|(id, _)| *id != checked.main_image);
        let mut names: Vec<_> = others
            .filter(|(_, function)| Self::of(tree, function).is_ok())
            .map(|(_, function)| function.name.clone())
            .collect();
        names.dedup();
        names
    }

    fn of(tree: &Tree, function: &Function) -> Result<Self, String> {
        let name = &function.name;
        let mut one = Self {
            name: name.clone(),
            prototype: prototype(tree, function),
            inputs: Vec::new(),
            outputs: Vec::new(),
            vectors: Vec::new(),
            parameters: Vec::new(),
            result: None,
            name_at: function.at.span.start as usize,
        };
        let mut changed = Vec::new();
        for (index, &id) in function.parameters.iter().enumerate() {
            let variable = &tree[id];
            let VariableKind::Parameter(direction) = variable.kind else {
                continue;
            };
            let own_name = match variable.name.as_str() {
                "" => format!("unnamed{index}"),
                own => own.to_owned(),
            };
            let local = format!("tpArgument{index}");
            let mut components = Vec::new();
            let mut vectors = Vec::new();
            let shape = shape(
                tree,
                variable.ty,
                (&own_name, &local),
                &mut components,
                &mut vectors,
            )
            .ok_or_else(|| {
                let ty = tree.type_name(variable.ty);
                format!(
                    "{name} has the parameter `{own_name}` of type {ty}, for which there are no test values"
                )
            })?;
            let before = one.inputs.len();
            if direction != Direction::Out {
                let vectors = vectors.into_iter();
                one.vectors
                    .extend(vectors.map(|range| range.start + before..range.end + before));
                one.inputs.extend(components.clone());
            }
            if matches!(direction, Direction::Out | Direction::InOut) {
                changed.extend(components);
            }
            one.parameters.push(Parameter {
                own_declaration: tree.declaration(&own_name, variable.ty),
                declaration: tree.declaration(&local, variable.ty),
                name: own_name,
                direction,
                inputs: before..one.inputs.len(),
                shape,
            });
        }
        if function.return_type != Type::Void {
            one.result = Some(tree.declaration("tpResult", function.return_type));
            let paths = ("result", "tpResult");
            shape(
                tree,
                function.return_type,
                paths,
                &mut one.outputs,
                &mut Vec::new(),
            )
            .ok_or_else(|| format!("the result of {name} has a type that cannot be compared"))?;
        }
        one.outputs.extend(changed);
        if one.outputs.is_empty() {
            return Err(format!("{name} returns nothing, and has no `out` parameter"));
        }
        if one.inputs.is_empty() {
            return Err(format!("{name} has no inputs to vary"));
        }
        if one.inputs.len().max(one.outputs.len()) > MAX_COMPONENTS {
            return Err(format!(
                "{name} has {} numbers as inputs and {} as outputs; at most {MAX_COMPONENTS} are supported",
                one.inputs.len(),
                one.outputs.len()
            ));
        }
        Ok(one)
    }

    /// The inputs that a path names: a component, or all of a vector, structure or parameter.
    ///
    /// # Errors
    /// States that there is no such input.
    pub(super) fn inputs_at(&self, path: &str) -> Result<Vec<usize>, Unsupported> {
        let is_named = |component: &Component| {
            let rest = component.path.strip_prefix(path);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        let found: Vec<_> = (0..self.inputs.len())
            .filter(|&at| is_named(&self.inputs[at]))
            .collect();
        if found.is_empty() {
            let names: Vec<_> = self
                .input_parameters()
                .map(|parameter| parameter.name.as_str())
                .collect();
            let name = &self.name;
            return Err(Unsupported(format!(
                "{name} has no input `{path}`; it has {}",
                names.join(", ")
            )));
        }
        Ok(found)
    }

    fn input_parameters(&self) -> impl Iterator<Item = &Parameter> {
        self.parameters
            .iter()
            .filter(|parameter| !parameter.inputs.is_empty())
    }

    /// The names of the input parameters, each with its components.
    pub(super) fn input_ranges(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        let parameters = self.input_parameters();
        parameters.map(|parameter| (parameter.name.as_str(), parameter.inputs.clone()))
    }

    /// A call with these inputs, to paste into a shader. Parameters that the function changes are variables,
    /// declared before it.
    #[must_use]
    pub(super) fn call(&self, case: &Case) -> String {
        let mut text = String::new();
        let mut arguments = Vec::new();
        for parameter in &self.parameters {
            let mut values = case[parameter.inputs.clone()].iter().copied();
            match parameter.direction {
                Direction::In | Direction::ConstIn => arguments.push(parameter.shape.literal(&mut values)),
                Direction::InOut => {
                    let value = parameter.shape.literal(&mut values);
                    text.extend([&parameter.own_declaration, " = ", &value, "; "]);
                    arguments.push(parameter.name.clone());
                }
                Direction::Out => {
                    text.extend([&parameter.own_declaration, "; "]);
                    arguments.push(parameter.name.clone());
                }
            }
        }
        text + &format!("{}({})", self.name, arguments.join(", "))
    }
}

/// The functions with a body.
fn defined(tree: &Tree) -> impl Iterator<Item = (toyproof_glsl::tree::FunctionId, &Function)> {
    tree.functions
        .iter()
        .filter(|(_, function)| function.body.is_some())
}

fn prototype(tree: &Tree, function: &Function) -> String {
    let parameters = function.parameters.iter().map(|&id| {
        let variable = &tree[id];
        let direction = match variable.kind {
            VariableKind::Parameter(Direction::Out) => "out ",
            VariableKind::Parameter(Direction::InOut) => "inout ",
            _ => "",
        };
        format!("{direction}{}", tree.declaration(&variable.name, variable.ty))
    });
    let parameters: Vec<_> = parameters.collect();
    let returns = tree.type_name(function.return_type);
    format!("{returns} {}({})", function.name, parameters.join(", "))
}

/// Adds the components of a value, by their paths in the source and in the generated shader, and the ranges
/// of its float vectors; `None` for types without values.
fn shape(
    tree: &Tree,
    ty: Type,
    (path, code): (&str, &str),
    components: &mut Vec<Component>,
    vectors: &mut Vec<Range<usize>>,
) -> Option<Shape> {
    // A type may have millions of components: what is refused need not be listed.
    if components.len() > MAX_COMPONENTS {
        return Some(Shape::Composed(String::new(), Vec::new()));
    }
    let suffixes: Vec<(String, Type)> = match ty {
        Type::Scalar(scalar) => {
            components.push(Component {
                path: path.to_owned(),
                code: code.to_owned(),
                scalar,
            });
            return Some(Shape::Scalar(scalar));
        }
        Type::Vector(scalar, size) => {
            let start = components.len();
            if scalar == Scalar::Float {
                vectors.push(start..start + usize::from(size));
            }
            let names = "xyzw".chars().take(usize::from(size));
            names
                .map(|name| (format!(".{name}"), Type::Scalar(scalar)))
                .collect()
        }
        Type::Matrix { columns, rows } => {
            let component = |column, row| (format!("[{column}].{row}"), Type::FLOAT);
            let rows = || "xyzw".chars().take(usize::from(rows));
            (0..columns)
                .flat_map(|column| rows().map(move |row| component(column, row)))
                .collect()
        }
        Type::Array(id) => {
            let array = tree.array(id);
            let count = array.size.min(MAX_COMPONENTS as u32 + 1);
            (0..count)
                .map(|index| (format!("[{index}]"), array.element))
                .collect()
        }
        Type::Struct(id) => {
            let members = tree[id].members.iter();
            members
                .map(|member| (format!(".{}", member.name), member.ty))
                .collect()
        }
        Type::Void | Type::Sampler(_) | Type::Error => return None,
    };
    let parts = suffixes.into_iter().map(|(suffix, part)| {
        let paths = (&*format!("{path}{suffix}"), &*format!("{code}{suffix}"));
        shape(tree, part, paths, components, vectors)
    });
    Some(Shape::Composed(tree.type_name(ty), parts.collect::<Option<_>>()?))
}

impl Shape {
    fn literal(&self, values: &mut impl Iterator<Item = f64>) -> String {
        match self {
            Self::Scalar(scalar) => literal(*scalar, values.next().unwrap_or_default()),
            Self::Composed(constructor, parts) => {
                let parts: Vec<_> = parts.iter().map(|part| part.literal(values)).collect();
                format!("{constructor}({})", parts.join(", "))
            }
        }
    }
}

/// A literal with this value: the shortest that reads back to the same f32.
pub(super) fn literal(scalar: Scalar, value: f64) -> String {
    match scalar {
        Scalar::Float => format!("{:?}", value as f32),
        Scalar::Bool => (value != 0.0).to_string(),
        Scalar::Uint => format!("{value}u"),
        // Its digits alone are out of range.
        Scalar::Int if value == f64::from(i32::MIN) => "(-2147483647 - 1)".to_owned(),
        Scalar::Int => format!("{value}"),
    }
}
