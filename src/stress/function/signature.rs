//! The inputs and outputs of a user's function, recognized by type and name.

use std::fmt::Write;

use thiserror::Error;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{BinaryOp, Direction, ExprId, ExprKind, Function, Tree, Type, VariableKind};

use super::role::{
    Output, Role, RoleMap, assign_input_roles, assign_output_roles, check_map, is_sphere, leaves,
};
use crate::case::RaySphere;

/// A function, with the roles of its inputs and outputs.
#[derive(Debug, Clone)]
pub struct Signature {
    /// The name.
    pub name: String,
    /// The names and types of the parameters.
    parameters: Vec<(String, String)>,
    /// The return type; `None` for void.
    returns: Option<String>,
    /// The inputs: paths and roles.
    pub(super) inputs: Vec<(String, Role)>,
    /// The outputs.
    pub(super) outputs: Vec<Output>,
    /// Whether the shader adds the square of a radius to anything.
    pub(super) adds_squared_radius: bool,
}

/// Why no function is recognized, in a sentence.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct Unrecognized(pub String);

impl Signature {
    /// Recognizes the function of that name.
    ///
    /// # Errors
    ///
    /// States what is not recognized.
    pub fn recognize(checked: &Checked, name: &str, map: &RoleMap) -> Result<Self, Unrecognized> {
        let tree = &checked.tree;
        let mut why = None;
        for (_, function) in tree.functions.iter() {
            if function.name == name && function.body.is_some() {
                match Self::from_function(tree, function, map) {
                    Ok(signature) => return Ok(signature),
                    Err(reason) => why = Some(reason),
                }
            }
        }
        Err(Unrecognized(why.unwrap_or_else(|| {
            let names = tree.functions.iter().map(|(_, function)| function.name.as_str());
            let names: Vec<_> = names.filter(|name| *name != "mainImage").collect();
            format!(
                "there is no function `{name}`; the shader has {}",
                names.join(", ")
            )
        })))
    }

    /// All functions that are recognized with this map.
    #[must_use]
    pub fn all(checked: &Checked, map: &RoleMap) -> Vec<Self> {
        let functions = checked.tree.functions.iter();
        let functions = functions.filter(|(_, function)| function.body.is_some());
        functions
            .filter_map(|(_, function)| Self::from_function(&checked.tree, function, map).ok())
            .collect()
    }

    /// The only function that is recognized with this map.
    ///
    /// # Errors
    ///
    /// States that there is none, or lists several.
    pub fn only(checked: &Checked, map: &RoleMap) -> Result<Self, Unrecognized> {
        let mut all = Self::all(checked, map);
        // If only the map prevents the recognition of the single candidate, report why.
        if all.is_empty()
            && !map.is_empty()
            && let Ok(one) = Self::only(checked, &RoleMap::new())
        {
            return Self::recognize(checked, &one.name, map);
        }
        match (all.pop(), all.is_empty()) {
            (Some(one), true) => Ok(one),
            (None, _) => Err(Unrecognized(
                "no function intersects a ray with a sphere; name one with --function and its parameters with --map"
                    .to_owned(),
            )),
            (Some(last), false) => {
                let names = all.iter().chain([&last]).map(|one| one.name.as_str());
                let names: Vec<_> = names.collect();
                let which = names.join(", ");
                Err(Unrecognized(format!("several functions intersect a sphere: {which}; choose one with --function")))
            }
        }
    }

    fn from_function(tree: &Tree, function: &Function, map: &RoleMap) -> Result<Self, String> {
        let mut input_leaves = Vec::new();
        let mut in_only_leaves = Vec::new();
        let mut output_leaves = Vec::new();
        let mut parameters = Vec::new();
        for (index, &id) in function.parameters.iter().enumerate() {
            let variable = &tree[id];
            let name = if variable.name.is_empty() {
                format!("unnamed{index}")
            } else {
                variable.name.clone()
            };
            parameters.push((name.clone(), tree.type_name(variable.ty)));
            let VariableKind::Parameter(direction) = variable.kind else {
                continue;
            };
            let leaves = leaves(tree, &name, variable.ty, "");
            if matches!(direction, Direction::Out | Direction::InOut) {
                output_leaves.extend(leaves.clone());
            } else {
                in_only_leaves.extend(leaves.clone());
            }
            if direction != Direction::Out {
                input_leaves.extend(leaves);
            }
        }
        let returns = (function.return_type != Type::Void).then(|| tree.type_name(function.return_type));
        output_leaves.extend(leaves(tree, "return", function.return_type, ""));
        check_map(function, &input_leaves, &output_leaves, map)?;
        let mut inputs = assign_input_roles(&input_leaves, map);
        if !is_sphere(function, &in_only_leaves, &inputs, map) {
            inputs.retain(|(path, role)| !role.is_of_sphere() || map.contains_key(path));
        }
        let has = |role| inputs.iter().any(|(_, found)| *found == role);
        let wanted = [Role::Origin, Role::Direction, Role::Center, Role::Radius];
        let whole = has(Role::Sphere);
        let missing: Vec<_> = wanted
            .into_iter()
            .filter(|role| !has(*role) && (!whole || matches!(role, Role::Origin | Role::Direction)))
            .map(Role::description)
            .collect();
        let name = &function.name;
        if !missing.is_empty() {
            let paths: Vec<_> = input_leaves.iter().map(|leaf| leaf.path.as_str()).collect();
            return Err(format!(
                "no parameter of {name} is recognized as {} (it has {}); name it with --map, such as --map {}=origin",
                missing.join(" or "),
                paths.join(", "),
                paths.first().unwrap_or(&"p")
            ));
        }
        let outputs = assign_output_roles(&output_leaves, map);
        // An `inout` t is compared with the t of nearer hits: it starts as the largest that is accepted.
        let limits = outputs.iter().filter(|output| {
            let is_input = input_leaves.iter().any(|leaf| leaf.path == output.path);
            let has_role = inputs.iter().any(|(input, _)| *input == output.path);
            output.role == Role::T && output.ty == Type::FLOAT && is_input && !has_role
        });
        let limits: Vec<_> = limits.map(|output| (output.path.clone(), Role::TMax)).collect();
        inputs.extend(limits);
        if !outputs.iter().any(|output| output.role == Role::T) {
            return Err(format!(
                "no output of {name} is recognized as t; name it with --map, such as --map return.depth=t"
            ));
        }
        Ok(Self {
            name: name.clone(),
            parameters,
            returns,
            adds_squared_radius: adds_squared_radius(tree, &inputs),
            inputs,
            outputs,
        })
    }

    /// Whether the function returns both roots.
    #[must_use]
    pub fn has_second_root(&self) -> bool {
        let two = |output: &Output| {
            output.role == Role::Second || (output.role == Role::T && output.ty != Type::FLOAT)
        };
        self.outputs.iter().any(two)
    }

    /// Whether the function has a separate flag for a hit.
    #[must_use]
    pub fn has_flag(&self) -> bool {
        self.outputs.iter().any(|output| output.role == Role::Flag)
    }

    /// Statements that call the function for a case, and the color expression with t, flag and second t.
    pub(super) fn call(&self) -> (String, String) {
        let mut text = String::new();
        let local = |path: &str| {
            let (head, rest) = path.split_at(path.find('.').unwrap_or(path.len()));
            let place = self.parameters.iter().position(|(name, _)| name == head);
            place.map_or_else(|| format!("tpResult{rest}"), |at| format!("tp{at}{rest}"))
        };
        for (index, (_, ty)) in self.parameters.iter().enumerate() {
            let _ = writeln!(text, "    {ty} tp{index};");
        }
        for (path, role) in &self.inputs {
            if let Some(input) = role.input() {
                let _ = writeln!(text, "    {} = {input};", local(path));
            }
        }
        let arguments: Vec<_> = (0..self.parameters.len()).map(|i| format!("tp{i}")).collect();
        let call = format!("{}({})", self.name, arguments.join(", "));
        let _ = match &self.returns {
            Some(ty) => writeln!(text, "    {ty} tpResult = {call};"),
            None => writeln!(text, "    {call};"),
        };
        let output = |role: Role| self.outputs.iter().find(|output| output.role == role);
        let path = |role: Role| output(role).map(|output| local(&output.path));
        let or_zero = |path: Option<String>| path.unwrap_or_else(|| "0.0".to_owned());
        let pair = output(Role::T).is_some_and(|output| output.ty != Type::FLOAT);
        let (t, second) = (or_zero(path(Role::T)), or_zero(path(Role::Second)));
        let flag = or_zero(path(Role::Flag).map(|path| format!("float({path})")));
        let result = if pair {
            format!("vec3({t}.x, {flag}, {t}.y)")
        } else {
            format!("vec3({t}, {flag}, {second})")
        };
        (text, result)
    }

    /// Statements that assign these values to the function's parameters.
    #[must_use]
    pub fn assignments(&self, &RaySphere { o, d, c, r }: &RaySphere) -> Vec<String> {
        let number = |x: f32| format!("{x:?}");
        let vector = |v: [f32; 3]| format!("vec3({})", v.map(number).join(", "));
        let value = |role: Role| match role {
            Role::Origin => Some(vector(o)),
            Role::Direction => Some(vector(d)),
            Role::Center => Some(vector(c)),
            Role::Radius => Some(number(r)),
            Role::Sphere => Some(format!("vec4({}, {})", c.map(number).join(", "), number(r))),
            Role::TMin | Role::TMax => role.input().map(str::to_owned),
            _ => None,
        };
        let inputs = self.inputs.iter();
        inputs
            .filter_map(|(path, role)| Some(format!("{path} = {};", value(*role)?)))
            .collect()
    }
}

/// Whether an expression of the shader adds the square of a radius.
fn adds_squared_radius(tree: &Tree, inputs: &[(String, Role)]) -> bool {
    let is_radius = |name: &str| {
        let normalized_name = name.to_lowercase().replace('_', "");
        let mut radii = inputs.iter().filter(|(_, role)| *role == Role::Radius);
        Role::Radius.has_name(&normalized_name)
            || radii.any(|(path, _)| path.rsplit('.').next() == Some(name))
    };
    let is_square = |id: ExprId| match tree[id].kind {
        ExprKind::Binary {
            op: BinaryOp::Multiply,
            left,
            right,
        } => place_name(tree, left).is_some_and(|(name, path)| {
            is_radius(&name) && place_name(tree, right).is_some_and(|(_, other)| other == path)
        }),
        _ => false,
    };
    tree.exprs.iter().any(|(_, expr)| match expr.kind {
        ExprKind::Binary {
            op: BinaryOp::Add,
            left,
            right,
        } => is_square(left) || is_square(right),
        ExprKind::Assign {
            op: Some(BinaryOp::Add),
            value,
            ..
        } => is_square(value),
        _ => false,
    })
}

/// The last name of a variable, a member or a component, and what identifies it; `None` for other
/// expressions. The fourth component of a vector that holds a sphere is named `r`.
fn place_name(tree: &Tree, id: ExprId) -> Option<(String, Vec<String>)> {
    match &tree[id].kind {
        ExprKind::Variable(variable) => {
            let name = tree[*variable].name.clone();
            Some((name, vec![format!("{variable:?}")]))
        }
        ExprKind::Member { structure, member } => {
            let (_, mut path) = place_name(tree, *structure)?;
            let Type::Struct(of) = tree[*structure].ty else {
                return None;
            };
            let name = tree[of].members.get(*member)?.name.clone();
            path.push(name.clone());
            Some((name, path))
        }
        ExprKind::Swizzle { vector, components } => {
            let (_, mut path) = place_name(tree, *vector)?;
            path.push(format!("{:?}", components.components()));
            (components.components() == [3]).then(|| ("r".to_owned(), path))
        }
        _ => None,
    }
}
