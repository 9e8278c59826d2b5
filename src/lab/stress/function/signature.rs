//! What an author's function takes and gives, recognised by types and names.

use std::collections::BTreeMap;
use std::fmt::Write;

use toyproof_glsl::Checked;
use toyproof_glsl::tree::{Direction, Function, Tree, Type, VariableKind};

use super::leaf::{agrees, inputs, is_sphere, leaves, outputs};
use super::role::Role;

/// What the user says about a function, where names do not: paths (`ray.origin`, `s`, `return`) and their roles.
pub type Map = BTreeMap<String, Role>;

/// A function, and what its values are.
#[derive(Debug, Clone)]
pub struct Signature {
    /// Its name.
    pub name: String,
    /// The names of its parameters with their types.
    parameters: Vec<(String, String)>,
    /// The type of what it returns; none for nothing.
    returns: Option<String>,
    /// What it takes, by its path.
    pub(super) inputs: Vec<(String, Role)>,
    /// What it gives, by its path.
    pub(super) outputs: Vec<(String, Role, Type)>,
}

impl Signature {
    /// Of the function of that name.
    ///
    /// # Errors
    /// What cannot be recognised, in a sentence.
    pub fn recognise(checked: &Checked, name: &str, map: &Map) -> Result<Self, String> {
        let tree = &checked.tree;
        let mut why = None;
        for (_, function) in tree.functions.iter() {
            if function.name == name && function.body.is_some() {
                match Self::of(tree, function, map) {
                    Ok(signature) => return Ok(signature),
                    Err(reason) => why = Some(reason),
                }
            }
        }
        Err(why.unwrap_or_else(|| {
            let names = tree.functions.iter().map(|(_, function)| function.name.as_str());
            let names: Vec<_> = names.filter(|name| *name != "mainImage").collect();
            format!("there is no function {name}; there are {}", names.join(", "))
        }))
    }

    /// All functions that can be recognised with no more help than that.
    #[must_use]
    pub fn all(checked: &Checked, map: &Map) -> Vec<Self> {
        let functions = checked.tree.functions.iter();
        let functions = functions.filter(|(_, function)| function.body.is_some());
        functions
            .filter_map(|(_, function)| Self::of(&checked.tree, function, map).ok())
            .collect()
    }

    /// The one function that can be recognised with no more help than that.
    ///
    /// # Errors
    /// That there is none, or which ones there are.
    pub fn only(checked: &Checked, map: &Map) -> Result<Self, String> {
        let mut all = Self::all(checked, map);
        // Why the one function that was to be had is none with that map.
        if all.is_empty()
            && !map.is_empty()
            && let Ok(one) = Self::only(checked, &Map::new())
        {
            return Self::recognise(checked, &one.name, map);
        }
        match (all.pop(), all.is_empty()) {
            (Some(one), true) => Ok(one),
            (None, _) => Err(
                "no function is seen to take a ray and a sphere and to give t; name it with --function, and what it takes with --map"
                    .to_owned(),
            ),
            (Some(last), false) => {
                let names = all.iter().chain([&last]).map(|one| one.name.as_str());
                let names: Vec<_> = names.collect();
                Err(format!("say with --function which one: {}", names.join(", ")))
            }
        }
    }

    fn of(tree: &Tree, function: &Function, map: &Map) -> Result<Self, String> {
        let mut takes = Vec::new();
        let mut only_takes = Vec::new();
        let mut gives = Vec::new();
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
                gives.extend(leaves.clone());
            } else {
                only_takes.extend(leaves.clone());
            }
            if direction != Direction::Out {
                takes.extend(leaves);
            }
        }
        let returns = (function.return_type != Type::Void).then(|| tree.type_name(function.return_type));
        gives.extend(leaves(tree, "return", function.return_type, ""));
        agrees(function, &takes, &gives, map)?;
        let mut inputs = inputs(&takes, map);
        if !is_sphere(function, &only_takes, &inputs, map) {
            inputs.retain(|(path, role)| !role.is_of_sphere() || map.contains_key(path));
        }
        let has = |role| inputs.iter().any(|(_, found)| *found == role);
        let wanted = [Role::Origin, Role::Direction, Role::Center, Role::Radius];
        let whole = has(Role::Sphere);
        let missing: Vec<_> = wanted
            .into_iter()
            .filter(|role| !has(*role) && (!whole || matches!(role, Role::Origin | Role::Direction)))
            .map(Role::word)
            .collect();
        let name = &function.name;
        if !missing.is_empty() {
            let paths: Vec<_> = takes.iter().map(|leaf| leaf.path.as_str()).collect();
            return Err(format!(
                "of what {name} takes ({}), it is not clear what is {}; say so with --map, as in --map {}=origin",
                paths.join(", "),
                missing.join(" and what is "),
                paths.first().unwrap_or(&"p")
            ));
        }
        let outputs = outputs(&gives, map);
        if !outputs.iter().any(|(_, role, _)| *role == Role::T) {
            return Err(format!(
                "it is not clear how {name} gives t: as a float, as a vec2 of both, in an out parameter or in a member; say so with --map, \
                 as in --map return.depth=t"
            ));
        }
        Ok(Self {
            name: name.clone(),
            parameters,
            returns,
            inputs,
            outputs,
        })
    }

    /// Whether it gives both roots.
    #[must_use]
    pub fn gives_two(&self) -> bool {
        let two = |(_, role, ty): &(String, Role, Type)| {
            *role == Role::Second || (*role == Role::T && *ty != Type::FLOAT)
        };
        self.outputs.iter().any(two)
    }

    /// Whether it tells apart from t whether there is one.
    #[must_use]
    pub fn gives_flag(&self) -> bool {
        self.outputs.iter().any(|(_, role, _)| *role == Role::Flag)
    }

    /// Statements that call it for a case, and the colour of t, flag and second t.
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
        let of = |wanted: Role| {
            let found = self.outputs.iter().find(|(_, role, _)| *role == wanted);
            found.map(|(path, _, ty)| (local(path), *ty))
        };
        let (t, pair) = of(Role::T).map_or(("0.0".to_owned(), false), |(path, ty)| (path, ty != Type::FLOAT));
        let second = of(Role::Second).map_or("0.0".to_owned(), |(path, _)| path);
        let flag = of(Role::Flag).map_or("0.0".to_owned(), |(path, _)| format!("float({path})"));
        let result = if pair {
            format!("vec3({t}.x, {flag}, {t}.y)")
        } else {
            format!("vec3({t}, {flag}, {second})")
        };
        (text, result)
    }

    /// Statements that give a function's parameters these values.
    #[must_use]
    pub fn assignments(&self, o: [f32; 3], d: [f32; 3], c: [f32; 3], r: f32) -> Vec<String> {
        let number = |x: f32| {
            let text = format!("{x:?}");
            if text.contains(['.', 'e', 'N', 'i']) {
                text
            } else {
                text + ".0"
            }
        };
        let vector = |v: [f32; 3]| format!("vec3({})", v.map(number).join(", "));
        let value = |role: Role| match role {
            Role::Origin => Some(vector(o)),
            Role::Direction => Some(vector(d)),
            Role::Center => Some(vector(c)),
            Role::Radius => Some(number(r)),
            Role::Sphere => Some(format!("vec4({}, {})", c.map(number).join(", "), number(r))),
            _ => None,
        };
        let told = self.inputs.iter();
        told.filter_map(|(path, role)| Some(format!("{path} = {};", value(*role)?)))
            .collect()
    }
}
