//! What is shown for the text under the mouse.

use lsp_types::{Contents, Hover};
use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{ExprKind, Type};
use toyproof_glsl::{Resolution, documentation, expanded};

use crate::describe::{
    self, built_in_declaration, call_at, code_block, declaration, macro_definition, markdown, shortened,
    value,
};
use crate::doc_comment::DocComments;
use crate::snapshot::Snapshot;
use crate::tokens::{Token, TokenKind, Tokens};

/// The type, declaration, value and documentation of what is at a byte of the analyzed text.
pub(crate) fn hover(snapshot: &Snapshot, at: u32) -> Option<Hover> {
    let in_document = snapshot
        .in_document(Span::new(snapshot.analyzed(), at, at))?
        .start;
    let tokens = snapshot.tokens();
    if tokens.is_in_comment(in_document) {
        return None;
    }
    let index = tokens.word_at(in_document).or_else(|| tokens.at(in_document))?;
    let token = tokens.code()[index];
    let start = snapshot.analyzed_byte(token.start)?;
    let span = Span::new(snapshot.analyzed(), start, start + token.text.len() as u32);
    let text = match token.kind {
        TokenKind::Word => of_word(snapshot, &tokens, index, span),
        TokenKind::Symbol => of_operator(snapshot, span),
        TokenKind::Number | TokenKind::Comment => None,
    };
    Some(Hover {
        contents: Contents::MarkupContent(markdown(text?)),
        range: Some(snapshot.document_range(token.start, token.end())),
    })
}

fn of_word(snapshot: &Snapshot, tokens: &Tokens<'_>, index: usize, span: Span) -> Option<String> {
    let token = tokens.code()[index];
    let before = index.checked_sub(1).map(|before| tokens.code()[before]);
    if token.is_in_directive && before.is_some_and(|before| before.is("#")) {
        return documentation::of_word(&format!("#{}", token.text)).map(str::to_owned);
    }
    if let Some(text) = of_macro(snapshot, token, span) {
        return Some(text);
    }
    if let Some(text) = of_name(snapshot, token, span) {
        return Some(text);
    }
    if before.is_some_and(|before| before.is(".")) {
        return of_swizzle(snapshot, token, span);
    }
    let types = snapshot.types();
    if let Some((name, ty)) = types.into_iter().find(|(name, _)| name == token.text) {
        let constant = call_at(snapshot.tree(), span).and_then(|(_, constant)| constant);
        let shown = constant.map(|constant| value_line(snapshot, &constant));
        return Some(joined([
            Some(code_block(&name)),
            shown,
            documentation::of_type(ty),
        ]));
    }
    let keyword = documentation::of_word(token.text)?;
    Some(joined([Some(code_block(token.text)), Some(keyword.to_owned())]))
}

/// The definition of a macro, what it expands to, and the type or value of that.
fn of_macro(snapshot: &Snapshot, token: Token<'_>, span: Span) -> Option<String> {
    let expansions = snapshot.analysis().expansions();
    let definition = expansions.definition_before(token.text, span.start)?;
    let mut uses = expansions.uses();
    let used = uses.find(|used| used.start == span.start && used.file == span.file);
    let is_defined_here = definition.at.start == span.start;
    if used.is_none() && !is_defined_here && !token.is_in_directive {
        return None;
    }
    let expansion = used.and_then(|used| {
        let text = expanded(snapshot.files(), snapshot.analyzed(), snapshot.options(), used)?;
        let is_plain = snapshot.files().text(definition.extent).ends_with(text.as_str());
        (!is_plain).then(|| format!("Expands to\n\n{}", code_block(&text)))
    });
    let result = used.and_then(|used| of_expansion(snapshot, used));
    Some(joined([
        Some(code_block(&macro_definition(snapshot, definition))),
        expansion,
        result,
        DocComments::new(snapshot).at(definition.at),
    ]))
}

/// The value or type of the expression to which the macro at a span expands.
fn of_expansion(snapshot: &Snapshot, used: Span) -> Option<String> {
    let tree = snapshot.tree();
    let exprs = tree.exprs.iter().filter(|(_, expr)| expr.at.span == used);
    // Expressions come after their operands.
    let (id, expr) = exprs.last()?;
    match tree.value(id) {
        Some(constant) => Some(value_line(snapshot, &constant)),
        None if expr.ty == Type::Error => None,
        None => Some(format!("Type: `{}`", tree.type_name(expr.ty))),
    }
}

fn of_name(snapshot: &Snapshot, token: Token<'_>, span: Span) -> Option<String> {
    let tree = snapshot.tree();
    let name = snapshot
        .name_at(span.start)
        .filter(|name| name.at.spelling == span)?;
    let (mut declared, mut shown) = (declaration(tree, name.resolution), None);
    match name.resolution {
        Resolution::Variable(variable) => {
            if let Some(constant) = &tree[variable].value {
                declared = format!("{declared} = {}", value(tree, constant));
            }
        }
        Resolution::BuiltIn(function) => {
            let (types, constant) = call_at(tree, span).unwrap_or_default();
            declared = built_in_declaration(function, token.text, &types);
            shown = constant;
        }
        Resolution::Struct(_) => shown = call_at(tree, span).and_then(|(_, constant)| constant),
        Resolution::Function(_) | Resolution::Member(..) => {}
    }
    Some(joined([
        Some(code_block(&declared)),
        shown.map(|constant| value_line(snapshot, &constant)),
        describe::documentation(snapshot, name.resolution, &mut DocComments::new(snapshot)),
    ]))
}

/// The type of a swizzle, and of which vector it has components.
fn of_swizzle(snapshot: &Snapshot, token: Token<'_>, span: Span) -> Option<String> {
    let tree = snapshot.tree();
    let swizzle = tree
        .exprs
        .iter()
        .find(|(_, expr)| matches!(expr.kind, ExprKind::Swizzle { .. }) && expr.at.spelling.end == span.end);
    let (id, expr) = swizzle?;
    let ExprKind::Swizzle { vector, .. } = expr.kind else {
        return None;
    };
    let ty = tree.type_name(expr.ty);
    let count = token.text.len();
    let of = tree.type_name(tree[vector].ty);
    let text = match count {
        1 => format!("A component of a `{of}`."),
        _ => format!("{count} components of a `{of}`."),
    };
    let constant = tree.value(id).map(|constant| value_line(snapshot, &constant));
    Some(joined([
        Some(code_block(&format!("{ty} .{}", token.text))),
        constant,
        Some(text),
    ]))
}

/// The type of the expression of an operator or bracket, and its value if it is constant.
fn of_operator(snapshot: &Snapshot, span: Span) -> Option<String> {
    let tree = snapshot.tree();
    let contains = |at: Span| at.file == span.file && at.start <= span.start && span.end <= at.end;
    let exprs = tree.exprs.iter();
    let around = exprs.filter(|(_, expr)| {
        let is_leaf = matches!(expr.kind, ExprKind::Literal(_) | ExprKind::Variable(_));
        !expr.at.is_expanded() && contains(expr.at.span) && !is_leaf
    });
    let (id, expr) = around.min_by_key(|(_, expr)| expr.at.span.end - expr.at.span.start)?;
    if matches!(expr.ty, Type::Error | Type::Void) {
        return None;
    }
    let text = shortened(snapshot.files().text(expr.at.span));
    let constant = tree.value(id).map(|constant| value_line(snapshot, &constant));
    let ty = format!("Type: `{}`", tree.type_name(expr.ty));
    Some(joined([Some(code_block(&text)), constant.or(Some(ty))]))
}

fn value_line(snapshot: &Snapshot, constant: &toyproof_glsl::tree::Constant) -> String {
    format!("Value: `{}`", value(snapshot.tree(), constant))
}

/// Paragraphs of Markdown.
fn joined<const N: usize>(parts: [Option<String>; N]) -> String {
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    parts.join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::marked;

    fn shown(text: &str) -> String {
        let (snapshot, at) = marked(text);
        let Some(Hover {
            contents: Contents::MarkupContent(markup),
            ..
        }) = hover(&snapshot, at)
        else {
            return "none".to_owned();
        };
        markup
            .value
            .replace("```glsl\n", "[")
            .replace("\n```", "]")
            .replace("\n\n", " ")
    }

    const MAIN: &str = "void mainImage(out vec4 c, in vec2 p) {";

    #[test]
    fn names_have_their_declaration_value_and_comment() {
        let text = format!("{MAIN} vec3 col[2]; c = vec4(c|ol[0], 1); }}");
        assert_eq!(shown(&text), "[vec3 col[2]]");
        assert_eq!(shown(&format!("{MAIN} c.x = p|.x; }}")), "[vec2 p]");
        assert_eq!(
            shown(&format!(
                "// A turn 😀.\r\nconst float TA|U = 2. * 3.14;\r\n{MAIN} }}"
            )),
            "[const float TAU = 6.28] A turn 😀."
        );
        let ray = "// A ray.\nstruct Ray { vec3 o; float far; // the end\n};";
        assert_eq!(
            shown(&format!("{ray} {MAIN} R|ay r; }}")),
            "[struct Ray {\n    vec3 o;\n    float far;\n}] A ray."
        );
        assert_eq!(
            shown(&format!("{ray} {MAIN} Ray r; r.f|ar = 1.; }}")),
            "[float Ray.far] the end"
        );
        let text = format!(
            "/* Twice. */ float g(in float x, inout vec2 y) {{ return x; }} {MAIN} c.x = g(|1., p); }}"
        );
        assert_eq!(
            shown(&text.replace("g(|", "|g(")),
            "[float g(float x, inout vec2 y)] Twice."
        );
    }

    #[test]
    fn built_in_names_have_documentation() {
        let text = shown(&format!("{MAIN} c = mi|x(c, c, p.x); }}"));
        assert!(
            text.starts_with("[vec4 mix(vec4 x, vec4 y, float a)  // + 2 more] Linear interpolation"),
            "{text}"
        );
        let text = shown(&format!("{MAIN} c.x = iTim|e; }}"));
        assert!(text.starts_with("[uniform float iTime] The time"), "{text}");
        let text = shown(&format!("{MAIN} c = v|ec4(1., 2. * 2., 3., 4.); }}"));
        assert!(
            text.starts_with("[vec4] Value: `vec4(1.0, 4.0, 3.0, 4.0)` A vector of 4"),
            "{text}"
        );
        let text = shown("uniform float u_tim|e; void main() { gl_FragColor = vec4(u_time); }");
        assert!(text.contains("seconds"), "{text}");
        let text = shown("void main() { gl_FragColor = texture2|D(a, b); }");
        assert!(text == "none" || text.contains("texture2D"), "{text}");
        assert!(shown(&format!("{MAIN} disc|ard; }}")).contains("Ends the shader"));
        assert!(shown("#ifd|ef A\n#endif").contains("macro is defined"));
    }

    #[test]
    fn macros_have_their_expansion_and_value() {
        let text =
            format!("#define PI 3.0 // half a turn\r\n#define SQ(x) ((x)*(x))\r\n{MAIN} c.x = S|Q(PI); }}");
        assert_eq!(
            shown(&text),
            "[#define SQ(x) ((x)*(x))] Expands to [((3.0) * (3.0))] Value: `9.0`"
        );
        let plain = text.replace("S|Q(PI)", "P|I");
        assert_eq!(shown(&plain), "[#define PI 3.0] Value: `3.0` half a turn");
        assert_eq!(shown("#define A\n#ifdef |A\n#endif"), "[#define A]");
    }

    #[test]
    fn swizzles_and_operators_have_types_and_values() {
        assert_eq!(
            shown(&format!("{MAIN} c.x = p.x|y.y; }}")),
            "[vec2 .xy] 2 components of a `vec2`."
        );
        assert_eq!(shown(&format!("{MAIN} c.x = 2. *| 3. + p.x; }}")), "none");
        assert_eq!(
            shown(&format!("{MAIN} c.x = 2. |* 3. + p.x; }}")),
            "[2. * 3.] Value: `6.0`"
        );
        assert_eq!(
            shown(&format!("{MAIN} c.x = 2. * 3. |+ p.x; }}")),
            "[2. * 3. + p.x] Type: `float`"
        );
    }

    #[test]
    fn comments_and_half_typed_text_have_what_is_known() {
        assert_eq!(shown(&format!("{MAIN} // p| \n }}")), "none");
        assert_eq!(shown(&format!("{MAIN} vec3 col; c = vec4(co|l.")), "[vec3 col]");
        assert_eq!(shown("|"), "none");
        assert_eq!(shown("unknow|n"), "none");
    }
}
