//! The shader with which students begin: the functions that an assignment requires, without their bodies, and
//! a black image, in the dialect of the reference.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use toyproof_glsl::tree::{Direction, Function, Input, Item, Scalar, Tree, Type, VariableKind};
use toyproof_glsl::{Checked, Version};

use crate::assignment::Assignment;
use crate::function_test::Subject;

/// The inputs that a host may declare, with the types that all hosts accept.
const INPUTS: [(Input, &str); 5] = [
    (Input::Resolution, "vec2"),
    (Input::Time, "float"),
    (Input::Frame, "int"),
    (Input::Mouse, "vec2"),
    (Input::Date, "vec4"),
];

/// The text of the shader. `reference` has the dialect and the signatures of the functions; without one, the
/// shader is ShaderToy's, and names the functions in a comment. `uniforms` have values in some frame.
pub(super) fn starter(
    assignment: &Assignment,
    reference: Option<&Subject>,
    uniforms: &BTreeSet<&str>,
) -> String {
    let mut names: BTreeSet<&str> = assignment
        .functions
        .iter()
        .flat_map(|test| test.names())
        .collect();
    // Names in tests that are not the reference's are built-in functions or variables.
    names.retain(|name| reference.is_some_and(|reference| reference.functions(name).next().is_some()));
    let rules = assignment.rules.iter().flat_map(|rules| &rules.must_define);
    let tested = assignment.functions.iter().map(|test| &test.name);
    names.extend(rules.chain(tested).map(String::as_str));
    let (head, main) = match reference.map(|reference| reference.checked) {
        Some(checked) if !checked.dialect.calls_main_image() => main(checked, uniforms),
        _ => (
            String::new(),
            "void mainImage(out vec4 fragColor, in vec2 fragCoord) {\n    \
             fragColor = vec4(0.0, 0.0, 0.0, 1.0);\n}\n"
                .to_owned(),
        ),
    };
    let functions: Vec<&Function> = reference.map_or_else(Vec::new, |reference| {
        let tree = &reference.checked.tree;
        let main_image = reference.checked.main_image;
        let defined = tree.items.iter().filter_map(|item| match *item {
            Item::Function(id) if id != main_image => Some(&tree[id]),
            _ => None,
        });
        defined
            .filter(|function| names.contains(function.name.as_str()))
            .collect()
    });
    let mut text = head;
    let known: BTreeSet<&str> = functions.iter().map(|function| function.name.as_str()).collect();
    for name in names.difference(&known) {
        let _ = writeln!(text, "// Define the function `{name}` here.\n");
    }
    if let Some(reference) = reference {
        let tree = &reference.checked.tree;
        text += &structs(tree, &functions);
        for function in functions {
            let _ = writeln!(text, "{}", stub(tree, function));
        }
    }
    text + &main
}

/// The declarations of a shader whose host runs `main`, and its `main`.
fn main(checked: &Checked, uniforms: &BTreeSet<&str>) -> (String, String) {
    let output = match checked.version {
        Version::Es100 => false,
        Version::Es300 | Version::Es310 | Version::Es320 => true,
        Version::Desktop(number) => number >= 330,
    };
    let mut head = checked.version.directive();
    if !matches!(checked.version, Version::Desktop(_)) {
        head += "precision highp float;\n";
    }
    for (input, ty) in INPUTS {
        if input == Input::Resolution || checked.reads(input) {
            let name = checked.dialect.name_of(input).unwrap_or(input.name());
            let _ = writeln!(head, "uniform {ty} {name};");
        }
    }
    for (_, variable) in checked.tree.variables.iter() {
        if variable.kind == VariableKind::Uniform && uniforms.contains(variable.name.as_str()) {
            let declared = checked.tree.declaration(&variable.name, variable.ty);
            let _ = writeln!(head, "uniform {declared};");
        }
    }
    let color = if output {
        head += "out vec4 fragColor;\n";
        "fragColor"
    } else {
        "gl_FragColor"
    };
    let main = format!("void main() {{\n    {color} = vec4(0.0, 0.0, 0.0, 1.0);\n}}\n");
    (head + "\n", main)
}

/// The structures in the signatures of functions, and those in these.
fn structs(tree: &Tree, functions: &[&Function]) -> String {
    let mut pending: Vec<Type> = functions
        .iter()
        .flat_map(|function| {
            let parameters = function.parameters.iter().map(|&id| tree[id].ty);
            parameters.chain([function.return_type])
        })
        .collect();
    let mut used = Vec::new();
    while let Some(ty) = pending.pop() {
        match ty {
            Type::Array(id) => pending.push(tree.array(id).element),
            Type::Struct(id) if !used.contains(&id) => {
                used.push(id);
                pending.extend(tree[id].members.iter().map(|member| member.ty));
            }
            _ => {}
        }
    }
    let declared = tree.items.iter().filter_map(|item| match *item {
        Item::Struct(id) if used.contains(&id) => Some(&tree[id]),
        _ => None,
    });
    let text = declared.map(|one| {
        let members = one.members.iter();
        let members = members.map(|member| format!("    {};\n", tree.declaration(&member.name, member.ty)));
        format!("struct {} {{\n{}}};\n\n", one.name, members.collect::<String>())
    });
    text.collect()
}

/// A function that sets its results to zero.
fn stub(tree: &Tree, function: &Function) -> String {
    let mut outputs = String::new();
    let parameters = function.parameters.iter().map(|&id| {
        let parameter = &tree[id];
        let direction = match parameter.kind {
            VariableKind::Parameter(Direction::Out) => "out ",
            VariableKind::Parameter(Direction::InOut) => "inout ",
            _ => "",
        };
        if direction == "out "
            && !parameter.name.is_empty()
            && let Some(value) = zero(tree, parameter.ty)
        {
            let _ = writeln!(outputs, "    {} = {value};", parameter.name);
        }
        let declared = format!("{direction}{}", tree.declaration(&parameter.name, parameter.ty));
        declared.trim_end().to_owned()
    });
    let parameters: Vec<String> = parameters.collect();
    let result = zero(tree, function.return_type);
    let result = result.map_or_else(String::new, |value| format!("    return {value};\n"));
    format!(
        "{} {}({}) {{\n{outputs}{result}}}\n",
        tree.type_name(function.return_type),
        function.name,
        parameters.join(", "),
    )
}

/// The zero of a type; `None` for `void` and samplers.
fn zero(tree: &Tree, ty: Type) -> Option<String> {
    let scalar = |scalar| match scalar {
        Scalar::Float => "0.0",
        Scalar::Int => "0",
        Scalar::Uint => "0u",
        Scalar::Bool => "false",
    };
    let parts: Vec<String> = match ty {
        Type::Scalar(of) => return Some(scalar(of).to_owned()),
        Type::Vector(of, _) => vec![scalar(of).to_owned()],
        Type::Matrix { .. } => vec!["0.0".to_owned()],
        Type::Struct(id) => {
            let members = tree[id].members.iter().map(|member| zero(tree, member.ty));
            members.collect::<Option<_>>()?
        }
        Type::Array(id) => {
            let array = tree.array(id);
            vec![zero(tree, array.element)?; array.size as usize]
        }
        Type::Void | Type::Sampler(_) | Type::Error => return None,
    };
    Some(format!("{}({})", tree.type_name(ty), parts.join(", ")))
}
