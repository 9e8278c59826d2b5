//! The parameters of the call that is being written.

use lsp_types::{
    ActiveParameter, Documentation, ParameterInformation, ParameterInformationLabel, SignatureHelp,
    SignatureInformation,
};
use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{FunctionId, Type};
use toyproof_glsl::{MacroDefinition, Resolution, documentation};

use crate::doc_comment::DocComments;
use crate::snapshot::Snapshot;
use crate::tokens::OpenCall;
use crate::{describe, scope};

/// Maximum number of members that the constructor of an array or structure shows.
const MAX_SHOWN_PARAMETERS: usize = 32;

/// A signature before it has the form of the protocol.
struct Signature {
    /// What stands in front of the parameters, up to the `(`.
    head: String,
    parameters: Vec<String>,
    documentation: Option<String>,
    /// Whether the complete arguments are a beginning of its arguments.
    fits: bool,
}

/// The signatures of the call whose parentheses surround a byte of the analyzed text.
pub(crate) fn signature_help(snapshot: &Snapshot, at: u32) -> Option<SignatureHelp> {
    let in_document = snapshot
        .in_document(Span::new(snapshot.analyzed(), at, at))?
        .start;
    let tokens = snapshot.tokens();
    if tokens.is_in_comment(in_document) {
        return None;
    }
    let call = tokens.open_call(in_document)?;
    if tokens.is_declared(call.name) {
        return None;
    }
    let name = tokens.code()[call.name];
    let given = scope::argument_types(snapshot, &tokens, &call);
    let signatures = signatures(snapshot, name.text, &given, &call, at);
    let active = call.arguments.len() - 1;
    let takes = |signature: &Signature| signature.fits && signature.parameters.len() > active;
    let best = signatures.iter().position(takes);
    let best = best.or_else(|| signatures.iter().position(|one| one.parameters.len() > active));
    if signatures.is_empty() {
        return None;
    }
    Some(SignatureHelp {
        signatures: signatures.into_iter().map(information).collect(),
        active_signature: Some(best.unwrap_or_default() as u32),
        active_parameter: Some(ActiveParameter::Int(active as u32)),
    })
}

fn signatures(snapshot: &Snapshot, name: &str, given: &[Type], call: &OpenCall, at: u32) -> Vec<Signature> {
    let tree = snapshot.tree();
    let mut comments = DocComments::new(snapshot);
    if let Some(definition) = snapshot.analysis().expansions().definition_before(name, at) {
        let found = of_macro(definition, comments.at(definition.at));
        return found.into_iter().collect();
    }
    let functions = scope::functions(snapshot, name, at);
    if !functions.is_empty() {
        let of_function = |function: FunctionId| {
            let parameters = tree[function].parameters.iter();
            let types: Vec<Type> = parameters.map(|&parameter| tree[parameter].ty).collect();
            let mut pairs = types.iter().zip(given);
            let resolution = Resolution::Function(function);
            Signature {
                head: tree.declaration(name, tree[function].return_type),
                parameters: describe::parameters(tree, function),
                documentation: describe::documentation(snapshot, resolution, &mut comments),
                fits: given.len() <= types.len()
                    && pairs.all(|(wanted, given)| *given == Type::Error || wanted == given),
            }
        };
        return functions.into_iter().map(of_function).collect();
    }
    if let Some(structure) = scope::structure(snapshot, name, at) {
        let members = tree[structure].members.iter().take(MAX_SHOWN_PARAMETERS);
        let resolution = Resolution::Struct(structure);
        return vec![Signature {
            head: name.to_owned(),
            parameters: members
                .map(|member| tree.declaration(&member.name, member.ty))
                .collect(),
            documentation: describe::documentation(snapshot, resolution, &mut comments),
            fits: true,
        }];
    }
    let version = snapshot.analysis().version;
    let mut known = version.functions(snapshot.options().lenient);
    if let Some((_, function)) = known.find(|(known, _)| *known == name) {
        let overloads = function.overloads(given).into_iter();
        let shown = overloads.map(|overload| Signature {
            head: format!("{} {name}", overload.result),
            parameters: overload.parameters,
            documentation: Some(function.documentation().text.to_owned()),
            fits: overload.fits,
        });
        return shown.collect();
    }
    let types = snapshot.types().into_iter();
    let mut types = types.filter(|(known, _)| known == name);
    types
        .next()
        .map_or_else(Vec::new, |(_, ty)| of_constructor(name, ty, call.arguments.len()))
}

fn of_macro(definition: &MacroDefinition, documentation: Option<String>) -> Option<Signature> {
    Some(Signature {
        head: definition.name.clone(),
        parameters: definition.parameters.clone()?,
        documentation,
        fits: true,
    })
}

/// The usual forms of the constructor of a built-in type.
fn of_constructor(name: &str, ty: Type, count: usize) -> Vec<Signature> {
    let scalar = ty.scalar().map_or("float", |scalar| scalar.name());
    let of = |parameters: Vec<String>| Signature {
        head: name.to_owned(),
        fits: parameters.len() >= count,
        parameters,
        documentation: documentation::of_type(ty),
    };
    let each = |names: &str| {
        names
            .chars()
            .map(|name| format!("{scalar} {name}"))
            .collect::<Vec<_>>()
    };
    match ty {
        Type::Scalar(_) => vec![of(vec!["x".to_owned()])],
        Type::Vector(_, size) => vec![
            of(vec![format!("{scalar} all")]),
            of(each(&"xyzw"[..usize::from(size)])),
        ],
        Type::Matrix { columns, rows } => {
            let column = |index: u8| format!("vec{rows} column{index}");
            let elements = (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row)));
            vec![
                of(vec!["float diagonal".to_owned()]),
                of((0..columns).map(column).collect()),
                of(elements
                    .map(|(column, row)| format!("float m{column}{row}"))
                    .collect()),
            ]
        }
        _ => Vec::new(),
    }
}

fn information(signature: Signature) -> SignatureInformation {
    let mut label = format!("{}(", signature.head);
    let mut parameters = Vec::with_capacity(signature.parameters.len());
    for (index, parameter) in signature.parameters.iter().enumerate() {
        label.push_str(if index > 0 { ", " } else { "" });
        // Names have ASCII characters only, so bytes are units of every encoding.
        let start = label.len() as u32;
        label.push_str(parameter);
        parameters.push(ParameterInformation {
            label: ParameterInformationLabel::Tuple((start, label.len() as u32)),
            documentation: None,
        });
    }
    label.push(')');
    SignatureInformation {
        label,
        documentation: signature
            .documentation
            .map(|text| Documentation::MarkupContent(describe::markdown(text))),
        parameters: Some(parameters),
        active_parameter: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::marked;

    /// The active signature with the active parameter in brackets, and the number of signatures.
    fn help(text: &str) -> String {
        let (snapshot, at) = marked(text);
        let Some(help) = signature_help(&snapshot, at) else {
            return "none".to_owned();
        };
        let active = &help.signatures[help.active_signature.unwrap() as usize];
        let Some(ActiveParameter::Int(parameter)) = help.active_parameter else {
            panic!("a parameter")
        };
        let parameter = active.parameters.as_ref().unwrap().get(parameter as usize);
        let shown = parameter.map_or(active.label.clone(), |parameter| {
            let ParameterInformationLabel::Tuple((start, end)) = parameter.label else {
                panic!("offsets")
            };
            let (start, end) = (start as usize, end as usize);
            let label = &active.label;
            format!("{}<{}>{}", &label[..start], &label[start..end], &label[end..])
        });
        format!("{shown} of {}", help.signatures.len())
    }

    const MAIN: &str = "void mainImage(out vec4 c, in vec2 p) { vec3 n = vec3(p, 1.); c = vec4(0);";

    #[test]
    fn built_in_functions_have_the_types_of_their_arguments() {
        assert_eq!(
            help(&format!("{MAIN} n = mix(n, |); }}")),
            "vec3 mix(vec3 x, <vec3 y>, vec3 a) of 3"
        );
        assert_eq!(
            help(&format!("{MAIN} n = mix(n, n, |")),
            "vec3 mix(vec3 x, vec3 y, <vec3 a>) of 3"
        );
        assert_eq!(
            help(&format!("{MAIN} c = texture(iChannel0, p, |); }}")),
            "vec4 texture(sampler2D channel, vec2 p, <[float bias]>) of 7"
        );
        assert_eq!(
            help(&format!("{MAIN} n = sin(|")),
            "genType sin(<genType angle>) of 1"
        );
    }

    #[test]
    fn functions_of_the_author_have_overloads_and_comments() {
        let functions = "float f(float a) { return a; } float f(vec3 a, inout float b) { return b; }";
        assert_eq!(
            help(&format!("{functions} {MAIN} f(n, |")),
            "float f(vec3 a, <inout float b>) of 2"
        );
        assert_eq!(
            help(&format!("{functions} {MAIN} f(|n.x); }}")),
            "float f(<float a>) of 2"
        );
        let (snapshot, at) = marked(&format!("// Twice.\nfloat g(float a) {{ return a; }} {MAIN} g(|"));
        let help = signature_help(&snapshot, at).unwrap();
        let Some(Documentation::MarkupContent(text)) = &help.signatures[0].documentation else {
            panic!("a comment")
        };
        assert_eq!(text.value, "Twice.");
    }

    #[test]
    fn constructors_and_macros_have_parameters() {
        assert_eq!(
            help(&format!("struct R {{ vec3 o; vec3 d[2]; }}; {MAIN} R r = R(n, |")),
            "R(vec3 o, <vec3 d[2]>) of 1"
        );
        assert_eq!(
            help(&format!("{MAIN} c = vec4(1., |")),
            "vec4(float x, <float y>, float z, float w) of 2"
        );
        assert_eq!(
            help(&format!("{MAIN} mat2 m = mat2(p, |")),
            "mat2(vec2 column0, <vec2 column1>) of 3"
        );
        assert_eq!(
            help(&format!("#define F(a, bc) a\r\n{MAIN} F(1., |")),
            "F(a, <bc>) of 1"
        );
        assert_eq!(help(&format!("#define N 1\n{MAIN} N(|")), "none");
    }

    #[test]
    fn outside_of_calls_there_is_none() {
        assert_eq!(help(&format!("{MAIN} if (|n.x > 0.) {{}} }}")), "none");
        assert_eq!(help(&format!("{MAIN} /* 😀 f(| */ }}")), "none");
        assert_eq!(help("float f(|"), "none");
    }
}
