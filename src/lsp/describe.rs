//! What names denote, as text for readers: declarations in GLSL, values of constants, and documentation in
//! Markdown.

use lsp_types::{MarkupContent, MarkupKind};
use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{
    BuiltIn, BuiltInVariable, Constant, Direction, FunctionId, StructId, Tree, Type, Value, VariableId,
    VariableKind,
};
use toyproof_glsl::{MacroDefinition, Resolution, documentation};

use crate::doc_comment::DocComments;
use crate::snapshot::Snapshot;

/// Maximum length in bytes of the value of a constant or of the replacement of a macro; the rest is `…`.
const MAX_SHOWN_BYTES: usize = 300;

/// A text in Markdown.
pub(crate) fn markdown(value: String) -> MarkupContent {
    MarkupContent {
        kind: MarkupKind::Markdown,
        value,
    }
}

/// Code as a block of Markdown.
pub(crate) fn code_block(code: &str) -> String {
    // Nothing in GLSL needs three backticks, but a text may have them.
    format!("```glsl\n{}\n```", code.replace("```", "'''"))
}

/// The declaration of what a name denotes, in GLSL without its value.
pub(crate) fn declaration(tree: &Tree, resolution: Resolution) -> String {
    match resolution {
        Resolution::Variable(variable) => variable_declaration(tree, variable),
        Resolution::Struct(structure) => structure_declaration(tree, structure),
        Resolution::Member(structure, member) => match tree[structure].members.get(member) {
            Some(member) => {
                let name = format!("{}.{}", tree[structure].name, member.name);
                tree.declaration(&name, member.ty)
            }
            None => String::new(),
        },
        Resolution::Function(function) => function_declaration(tree, function),
        Resolution::BuiltIn(function) => built_in_declaration(function, function.name(), &[]),
    }
}

fn variable_declaration(tree: &Tree, variable: VariableId) -> String {
    let variable = &tree[variable];
    let qualifier = match variable.kind {
        VariableKind::Global | VariableKind::Local => "",
        VariableKind::Const | VariableKind::BuiltInConstant => "const ",
        VariableKind::Parameter(direction) => direction_keyword(direction),
        VariableKind::Input(_) | VariableKind::Channel(_) | VariableKind::Uniform => "uniform ",
        VariableKind::Output | VariableKind::BuiltIn(BuiltInVariable::FragDepth) => "out ",
        VariableKind::Varying | VariableKind::BuiltIn(_) => "in ",
    };
    format!("{qualifier}{}", tree.declaration(&variable.name, variable.ty))
}

fn direction_keyword(direction: Direction) -> &'static str {
    match direction {
        Direction::In => "",
        Direction::ConstIn => "const ",
        Direction::Out => "out ",
        Direction::InOut => "inout ",
    }
}

/// The members of a structure as it is declared.
fn structure_declaration(tree: &Tree, structure: StructId) -> String {
    let structure = &tree[structure];
    let members = structure.members.iter();
    let lines = members.map(|member| format!("    {};\n", tree.declaration(&member.name, member.ty)));
    let lines: Vec<String> = lines.collect();
    format!("struct {} {{\n{}}}", structure.name, lines.concat())
}

/// Each parameter of a function of the author, such as `inout vec3 p`.
pub(crate) fn parameters(tree: &Tree, function: FunctionId) -> Vec<String> {
    let parameters = tree[function].parameters.iter();
    parameters
        .map(|&parameter| variable_declaration(tree, parameter).trim_end().to_owned())
        .collect()
}

fn function_declaration(tree: &Tree, function: FunctionId) -> String {
    let name = &tree[function].name;
    let declared = tree.declaration(name, tree[function].return_type);
    format!("{declared}({})", parameters(tree, function).join(", "))
}

/// The signature of a built-in function that takes arguments of these types, and how many others there are.
/// `name` is the name by which it is called, which an old version may have.
pub(crate) fn built_in_declaration(function: BuiltIn, name: &str, arguments: &[Type]) -> String {
    let overloads = function.overloads(arguments);
    let complete = |count: usize| {
        let parameters = |parameters: &[String]| {
            parameters
                .iter()
                .filter(|parameter| !parameter.starts_with('['))
                .count()
        };
        move |overload: &&toyproof_glsl::tree::Overload| {
            overload.fits && parameters(&overload.parameters) <= count
        }
    };
    let best = overloads.iter().find(complete(arguments.len()));
    let best = best.or_else(|| overloads.iter().find(|overload| overload.fits));
    let Some(best) = best.or(overloads.first()) else {
        return name.to_owned();
    };
    let others = match overloads.len() {
        1 => String::new(),
        count => format!("  // + {} more", count - 1),
    };
    format!("{} {name}({}){others}", best.result, best.parameters.join(", "))
}

/// The definition of a macro, as it is written.
pub(crate) fn macro_definition(snapshot: &Snapshot, definition: &MacroDefinition) -> String {
    let text = snapshot.files().text(definition.extent);
    format!("#define {}", shortened(text))
}

/// A text up to the length that is shown.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().find(|(at, _)| *at >= MAX_SHOWN_BYTES) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}

/// The value of a constant as a literal or constructor, with floats as the shader has them: of 32 bits.
pub(crate) fn value(tree: &Tree, constant: &Constant) -> String {
    let mut text = String::new();
    write_value(tree, constant, &mut text);
    shortened(&text)
}

fn write_value(tree: &Tree, constant: &Constant, text: &mut String) {
    if let ([only], Type::Scalar(_)) = (constant.components(), constant.ty) {
        text.push_str(&scalar(*only));
        return;
    }
    text.push_str(&tree.type_name(constant.ty));
    text.push('(');
    for (index, component) in constant.components().iter().enumerate() {
        text.push_str(if index > 0 { ", " } else { "" });
        text.push_str(&scalar(*component));
    }
    for (index, part) in constant.parts().iter().enumerate() {
        if text.len() > MAX_SHOWN_BYTES {
            break;
        }
        text.push_str(if index > 0 { ", " } else { "" });
        write_value(tree, part, text);
    }
    text.push(')');
}

fn scalar(value: Value) -> String {
    match value {
        Value::Bool(value) => value.to_string(),
        Value::Int(value) => value.to_string(),
        Value::Uint(value) => format!("{value}u"),
        Value::Float(value) => format!("{:?}", value as f32),
    }
}

/// What a name means, in Markdown: the documentation of what the language or the host declares, or the
/// comment at a declaration of the author.
pub(crate) fn documentation(
    snapshot: &Snapshot,
    resolution: Resolution,
    comments: &mut DocComments<'_>,
) -> Option<String> {
    let tree = snapshot.tree();
    match resolution {
        Resolution::BuiltIn(function) => Some(function.documentation().text.to_owned()),
        Resolution::Variable(id) => {
            let variable = &tree[id];
            if let Some(text) = documentation::of_variable(variable) {
                return Some(text.to_owned());
            }
            if matches!(variable.kind, VariableKind::Parameter(_)) {
                return None;
            }
            let of_author = comments.at(variable.at?.spelling);
            let is_set = matches!(variable.kind, VariableKind::Uniform | VariableKind::Varying);
            of_author.or_else(|| {
                let dialect = snapshot.analysis().dialect;
                is_set
                    .then(|| dialect.input_documentation(&variable.name))
                    .flatten()
            })
        }
        Resolution::Struct(id) => comments.at(tree[id].at.spelling),
        Resolution::Member(id, member) => comments.at(tree[id].members.get(member)?.at.spelling),
        Resolution::Function(id) => comments.at(tree[id].at.spelling),
    }
}

/// The types of the arguments of the call that begins with a name at a byte of the analyzed text, as far as
/// they are known, and the value of the call if it is constant.
pub(crate) fn call_at(tree: &Tree, name: Span) -> Option<(Vec<Type>, Option<Constant>)> {
    use toyproof_glsl::tree::ExprKind::{BuiltIn, Call, Construct};
    let mut exprs = tree.exprs.iter();
    exprs.find_map(|(id, expr)| {
        let (BuiltIn { arguments, .. } | Call { arguments, .. } | Construct { arguments, .. }) = &expr.kind
        else {
            return None;
        };
        let begins = expr.at.spelling.start == name.start && expr.at.spelling.end > name.end;
        let types = || arguments.iter().map(|&argument| tree[argument].ty).collect();
        (begins && expr.at.spelling.file == name.file).then(|| (types(), tree.value(id)))
    })
}
