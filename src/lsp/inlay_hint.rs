//! Hints between the characters of the text: names of parameters, implicit conversions, values of constants.

use lsp_types::{InlayHint, InlayHintKind, Label};
use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{
    BuiltIn, Constructor, ExprId, ExprKind, StructId, Tree, Type, UnaryOp, VariableKind,
};

use crate::describe;
use crate::snapshot::Snapshot;

/// The hints in a part of the document's bytes.
pub(crate) fn inlay_hints(snapshot: &Snapshot, (from, to): (u32, u32)) -> Vec<InlayHint> {
    let settings = &snapshot.settings.inlay_hints;
    let hints = Hints { snapshot, from, to };
    let mut found = Vec::new();
    for (id, expr) in snapshot.tree().exprs.iter() {
        if expr.at.is_expanded() || !hints.is_shown(expr.at.span) {
            continue;
        }
        if settings.parameter_names {
            hints.add_parameter_names(id, &mut found);
        }
        if settings.conversions {
            hints.add_conversion(id, &mut found);
        }
    }
    if settings.constants {
        hints.add_constants(&mut found);
    }
    found.sort_by_key(|hint| hint.byte);
    found.dedup();
    let mut positions = snapshot.positions();
    let shown = found.into_iter().map(|hint| InlayHint {
        position: positions.at(hint.byte),
        label: Label::String(hint.label),
        padding_right: (hint.kind == Some(InlayHintKind::Parameter)).then_some(true),
        kind: hint.kind,
        text_edits: None,
        tooltip: None,
        padding_left: None,
        data: None,
    });
    shown.collect()
}

/// A hint before it has a position.
#[derive(Debug, PartialEq)]
struct Hint {
    /// The byte of the document at which it stands.
    byte: u32,
    label: String,
    kind: Option<InlayHintKind>,
}

struct Hints<'s> {
    snapshot: &'s Snapshot,
    from: u32,
    to: u32,
}

impl Hints<'_> {
    /// Whether a span of the analyzed text overlaps the part of the document.
    fn is_shown(&self, span: Span) -> bool {
        let in_document = self.snapshot.in_document(span);
        in_document.is_some_and(|span| span.start <= self.to && self.from <= span.end)
    }

    /// Adds the names of the parameters of a call, in front of arguments that do not have that name.
    fn add_parameter_names(&self, id: ExprId, found: &mut Vec<Hint>) {
        let tree = self.snapshot.tree();
        let (arguments, names) = match &tree[id].kind {
            ExprKind::Call { function, arguments } => {
                let parameters = tree[*function].parameters.iter();
                let names = parameters.map(|&parameter| &*tree[parameter].name);
                (arguments, names.collect::<Vec<&str>>())
            }
            ExprKind::BuiltIn { function, arguments } => (arguments, hinted_names(*function)),
            ExprKind::Construct {
                constructor: Constructor::Struct,
                arguments,
            } => match tree[id].ty {
                Type::Struct(structure) => (arguments, member_names(tree, structure)),
                _ => return,
            },
            _ => return,
        };
        if arguments.len() < 2 {
            return;
        }
        for (&argument, name) in arguments.iter().zip(names) {
            let at = tree[argument].at;
            // A name of one letter seldom says more.
            if name.len() < 2 || at.is_expanded() || says(tree, argument, name) {
                continue;
            }
            if let Some(span) = self.snapshot.in_document(self.with_parentheses(at.span)) {
                found.push(Hint {
                    byte: span.start,
                    label: format!("{name}:"),
                    kind: Some(InlayHintKind::Parameter),
                });
            }
        }
    }

    /// The span of an expression with the parentheses around it, which are not part of its place; not those
    /// of a call.
    fn with_parentheses(&self, span: Span) -> Span {
        let text = self.snapshot.analyzed_text();
        let Some((front, back)) = text.get(..span.start as usize).zip(text.get(span.end as usize..)) else {
            return span;
        };
        let (mut front, mut back) = (front.trim_end(), back.trim_start());
        let mut whole = span;
        while let (Some(before), Some(after)) = (front.strip_suffix('('), back.strip_prefix(')')) {
            if before
                .trim_end()
                .ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
            {
                break;
            }
            whole.start = before.len() as u32;
            (front, back) = (before.trim_end(), after.trim_start());
        }
        whole
    }

    /// Adds the constructor that converts an operand without being written.
    fn add_conversion(&self, id: ExprId, found: &mut Vec<Hint>) {
        let tree = self.snapshot.tree();
        let ExprKind::Construct { arguments, .. } = &tree[id].kind else {
            return;
        };
        let [argument] = arguments[..] else { return };
        if tree[argument].at != tree[id].at {
            return;
        }
        if let Some(span) = self.snapshot.in_document(tree[id].at.span) {
            let ty = tree.type_name(tree[id].ty);
            for (byte, label) in [(span.start, format!("{ty}(")), (span.end, ")".to_owned())] {
                let kind = Some(InlayHintKind::Type);
                found.push(Hint { byte, label, kind });
            }
        }
    }

    /// Adds the values of constants whose initializers are computed.
    fn add_constants(&self, found: &mut Vec<Hint>) {
        let tree = self.snapshot.tree();
        for (_, variable) in tree.variables.iter() {
            let (Some(initializer), Some(value)) = (variable.initializer, &variable.value) else {
                continue;
            };
            let is_constant = variable.kind == VariableKind::Const;
            if !is_constant || is_written_out(tree, initializer) || tree[initializer].at.is_expanded() {
                continue;
            }
            let span = self.with_parentheses(tree[initializer].at.span);
            if let Some(span) = self.snapshot.in_document(span).filter(|_| self.is_shown(span)) {
                found.push(Hint {
                    byte: span.end,
                    label: format!(" = {}", describe::value(tree, value)),
                    kind: None,
                });
            }
        }
    }
}

/// The names of the parameters of a built-in function that are worth a hint, and empty ones: most functions
/// are well known, or their parameters have no names that say more.
fn hinted_names(function: BuiltIn) -> Vec<&'static str> {
    let names = function.documentation().parameters.iter();
    let is_hinted = |name: &str| match function {
        BuiltIn::Refract => name == "eta",
        BuiltIn::Faceforward => name.len() > 1,
        _ => function.is_texture() && !matches!(name, "channel" | "p"),
    };
    names
        .map(|&name| if is_hinted(name) { name } else { "" })
        .collect()
}

fn member_names(tree: &Tree, structure: StructId) -> Vec<&str> {
    let members = tree[structure].members.iter();
    members.map(|member| &*member.name).collect()
}

/// Whether an argument has the name of its parameter, perhaps as a part of its own.
fn says(tree: &Tree, argument: ExprId, name: &str) -> bool {
    let own = match &tree[argument].kind {
        ExprKind::Variable(variable) => &*tree[*variable].name,
        ExprKind::Call { function, .. } => &*tree[*function].name,
        ExprKind::Member { structure, member } => match tree[*structure].ty {
            Type::Struct(id) => tree[id].members.get(*member).map_or("", |member| &*member.name),
            _ => "",
        },
        ExprKind::Swizzle { vector, .. } | ExprKind::Index { base: vector, .. } => {
            return says(tree, *vector, name);
        }
        ExprKind::Unary { operand, op } if *op != UnaryOp::Not => return says(tree, *operand, name),
        _ => "",
    };
    let plain = |name: &str| name.replace('_', "").to_ascii_lowercase();
    let (own, name) = (plain(own), plain(name));
    own == name || (own.len() > 1 && (own.contains(&name) || name.contains(&own)))
}

/// Whether an expression consists of literals only, as far as it shows its value.
fn is_written_out(tree: &Tree, expr: ExprId) -> bool {
    match &tree[expr].kind {
        ExprKind::Literal(_) => true,
        ExprKind::Unary { operand, .. } => is_written_out(tree, *operand),
        ExprKind::Construct { arguments, .. } => {
            let mut arguments = arguments.iter();
            arguments.all(|&argument| match &tree[argument].kind {
                ExprKind::Unary { operand, .. } => matches!(tree[*operand].kind, ExprKind::Literal(_)),
                kind => matches!(kind, ExprKind::Literal(_)),
            })
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use std::rc::Rc;

    use super::*;
    use crate::settings::Settings;
    use crate::snapshot::testing::{lenient, of};

    /// The text with its hints between `«` and `»`.
    fn hinted(snapshot: &Snapshot) -> String {
        let mut text = snapshot.file().text().to_owned();
        for hint in inlay_hints(snapshot, (0, text.len() as u32)).into_iter().rev() {
            let byte = snapshot.encoding.byte(snapshot.file(), hint.position) as usize;
            let Label::String(label) = hint.label else {
                panic!("a text")
            };
            text.insert_str(byte, &format!("«{label}»"));
        }
        text
    }

    const MAIN: &str = "void mainImage(out vec4 c, in vec2 p) {";

    #[test]
    fn arguments_have_the_names_of_parameters_unless_they_say_them() {
        let function = "float box(vec3 point, vec3 size, float radius) { return radius; }";
        let text = format!(
            "{function} {MAIN} vec3 boxSize = vec3(1); /* 😀 */\r\n\
             c = vec4(box((vec3(p, 0.)), boxSize, 1.) + box(boxSize, boxSize.xyz, -p.x)); }}"
        );
        let expected = format!(
            "{function} {MAIN} vec3 boxSize = vec3(1); /* 😀 */\r\n\
             c = vec4(box(«point:»(vec3(p, 0.)), boxSize, «radius:»1.) + box(«point:»boxSize, boxSize.xyz, \
             «radius:»-p.x)); }}"
        );
        assert_eq!(hinted(&of(&text)), expected);
    }

    #[test]
    fn few_built_in_functions_and_structures_have_names() {
        let text = format!(
            "struct R {{ vec3 start; float o; }}; {MAIN} R r = R(vec3(1), 2.); \
             c = textureLod(iChannel0, p, 0.) * clamp(p.x, 0., 1.); }}"
        );
        let shown = hinted(&of(&text));
        assert!(shown.contains("R(«start:»vec3(1), 2.)"), "{shown}");
        assert!(
            shown.contains("textureLod(iChannel0, p, «lod:»0.) * clamp(p.x, 0., 1.)"),
            "{shown}"
        );
    }

    #[test]
    fn arguments_of_macros_and_single_arguments_have_none() {
        let text = format!(
            "#define F(a) f(a, 1.)\nfloat f(float first, float other) {{ return first; }}\n\
             {MAIN} c = vec4(F(2.)); }}"
        );
        let shown = hinted(&of(&text));
        assert!(!shown.contains("first:") && !shown.contains("other:"), "{shown}");
    }

    #[test]
    fn conversions_and_constants_are_shown() {
        let mut snapshot = lenient(&format!(
            "const float A = 2. * 3., B = 4.; {MAIN} float x = 1; c = vec4(x); }}"
        ));
        let shown = hinted(&snapshot);
        assert!(shown.contains("float x = «float(»1«)»;"), "{shown}");
        let mut settings = Settings::default();
        settings.inlay_hints.constants = true;
        snapshot.settings = Rc::new(settings);
        let shown = hinted(&snapshot);
        assert!(shown.contains("A = 2. * 3.« = 6.0», B = 4.;"), "{shown}");
    }
}
