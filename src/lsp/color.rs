//! Colors in the text, which editors show as swatches and let the author pick.

use lsp_types::{Color, ColorInformation, ColorPresentation, TextEdit};
use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{BuiltIn, Constructor, ExprId, ExprKind, Scalar, Type, Value};

use crate::snapshot::Snapshot;
use crate::tokens::{TokenKind, Tokens};

/// Maximum number of tokens of a statement in front of a color that are searched for names.
const MAX_TOKENS_BEFORE: usize = 100;

/// Parts of names that suggest a color.
const COLOR_NAMES: [&str; 16] = [
    "col",
    "rgb",
    "albedo",
    "tint",
    "diffuse",
    "ambient",
    "specular",
    "sky",
    "fog",
    "emission",
    "palette",
    "glow",
    "background",
    "shade",
    "kd",
    "ks",
];

/// Parts of names and functions that suggest anything else.
const OTHER_NAMES: [&str; 20] = [
    "pos", "dir", "nor", "origin", "offset", "size", "axis", "center", "target", "camera", "rand", "hash",
    "noise", "dot", "cross", "reflect", "rot", "scale", "translat", "box",
];

/// Short names that suggest anything else.
const OTHER_SHORT_NAMES: [&str; 9] = ["ro", "rd", "up", "uv", "p", "q", "n", "ta", "st"];

/// The largest component of a color that only its components suggest is above this.
const DARKEST: f64 = 0.02;

/// The fewest digits behind the point with which a color is written: two show steps of 1 %.
const MIN_DIGITS: usize = 2;

/// A constructor of a color.
struct Swatch {
    /// The literals as they are written: one for all components, or one for each.
    literals: Vec<String>,
    components: Vec<f64>,
}

/// The colors of a document.
pub(crate) fn document_colors(snapshot: &Snapshot) -> Vec<ColorInformation> {
    let tokens = snapshot.tokens();
    let types = snapshot.types();
    let mut found = Vec::new();
    for (id, expr) in snapshot.tree().exprs.iter() {
        let (Some(swatch), false) = (swatch(snapshot, id), expr.at.is_expanded()) else {
            continue;
        };
        let Some(span) = snapshot.in_document(expr.at.span) else {
            continue;
        };
        if is_color(&tokens, &types, span, &swatch) {
            let component = |index: usize| swatch.components.get(index).map_or(1.0, |&value| value as f32);
            let color = Color {
                red: component(0),
                green: component(1),
                blue: component(2),
                alpha: component(3),
            };
            found.push((span, color));
        }
    }
    found.sort_by_key(|(span, _)| span.start);
    let mut positions = snapshot.positions();
    let colors = found.into_iter().map(|(span, color)| ColorInformation {
        range: positions.range(span.start, span.end),
        color,
    });
    colors.collect()
}

/// The constructor of a `vec3` or `vec4` of literals from 0 to 1.
fn swatch(snapshot: &Snapshot, id: ExprId) -> Option<Swatch> {
    let tree = snapshot.tree();
    let Type::Vector(Scalar::Float, size @ (3 | 4)) = tree[id].ty else {
        return None;
    };
    let ExprKind::Construct {
        constructor: constructor @ (Constructor::Vector | Constructor::Splat),
        arguments,
    } = &tree[id].kind
    else {
        return None;
    };
    let mut literals = Vec::with_capacity(arguments.len());
    let mut components = Vec::with_capacity(usize::from(size));
    for &argument in arguments {
        let ExprKind::Literal(literal) = &tree[argument].kind else {
            return None;
        };
        literals.push(literal.text.to_string());
        components.push(match literal.value {
            Value::Float(value) => value,
            Value::Int(value) => f64::from(value),
            Value::Uint(_) | Value::Bool(_) => return None,
        });
    }
    if *constructor == Constructor::Splat {
        components = vec![*components.first()?; usize::from(size)];
    }
    let is_in_range = components.iter().all(|value| (0.0..=1.0).contains(value));
    (is_in_range && components.len() == usize::from(size)).then_some(Swatch { literals, components })
}

/// Whether the names around a constructor suggest a color, or its components do and the names nothing else.
fn is_color(tokens: &Tokens<'_>, types: &[(String, Type)], span: Span, swatch: &Swatch) -> bool {
    let end = tokens.count_before(span.start);
    let start = end.saturating_sub(MAX_TOKENS_BEFORE);
    // What a function of the author does with its argument is in its name.
    let call = tokens.open_call(span.start).map(|call| call.name);
    let call = call.filter(|&name| !is_arithmetic(types, tokens.code()[name].text));
    let start = call.map_or(start, |name| name.max(start));
    let around = tokens.code()[start..end].iter().rev();
    let of_statement = around.take_while(|token| !matches!(token.text, ";" | "{" | "}"));
    let words = of_statement.filter(|token| token.kind == TokenKind::Word);
    let words: Vec<String> = words.map(|token| token.text.to_ascii_lowercase()).collect();
    let any = |parts: &[&str]| {
        words
            .iter()
            .any(|word| parts.iter().any(|part| word.contains(part)))
    };
    if any(&COLOR_NAMES) {
        return true;
    }
    if any(&OTHER_NAMES) || words.iter().any(|word| OTHER_SHORT_NAMES.contains(&&**word)) {
        return false;
    }
    // Vectors of 0 and 1 are often axes, equal components sizes, and small ones steps.
    let color = &swatch.components[..3];
    color.iter().any(|value| value.fract() != 0.0)
        && color.iter().any(|value| *value != color[0])
        && color.iter().any(|value| *value > DARKEST)
}

/// Whether a function combines its arguments to a value of the same kind: a built-in function or constructor.
fn is_arithmetic(types: &[(String, Type)], name: &str) -> bool {
    BuiltIn::named(name).is_some() || types.iter().any(|(known, _)| known == name)
}

/// The texts that write a color in place of the one in bytes of the document, with as many digits.
pub(crate) fn color_presentations(
    snapshot: &Snapshot,
    color: Color,
    range: (u32, u32),
) -> Vec<ColorPresentation> {
    let tree = snapshot.tree();
    let mut exprs = tree.exprs.iter();
    let found = exprs.find_map(|(id, expr)| {
        let span = snapshot.in_document(expr.at.span)?;
        let is_here = (span.start, span.end) == range && !expr.at.is_expanded();
        is_here.then(|| swatch(snapshot, id)).flatten()
    });
    let Some(swatch) = found else {
        return Vec::new();
    };
    let new = [color.red, color.green, color.blue, color.alpha];
    let new = &new[..swatch.components.len()];
    let style = Style::of(&swatch.literals);
    let mut texts: Vec<String> = new.iter().map(|&value| style.write(value)).collect();
    if swatch.literals.len() == 1 && texts.iter().all(|text| *text == texts[0]) {
        texts.truncate(1);
    }
    let text = format!("vec{}({})", swatch.components.len(), texts.join(", "));
    vec![ColorPresentation {
        label: text.clone(),
        text_edit: Some(TextEdit {
            range: snapshot.document_range(range.0, range.1),
            new_text: text,
        }),
        additional_text_edits: None,
    }]
}

/// How an author writes numbers.
struct Style {
    /// The digits behind the point.
    digits: usize,
    /// Whether `0.5` is written `.5`.
    omits_zero: bool,
    /// Whether `1.0` is written `1.`.
    omits_fraction: bool,
}

impl Style {
    fn of(literals: &[String]) -> Self {
        let fraction = |literal: &String| {
            let (_, fraction) = literal.split_once('.')?;
            Some(fraction.chars().take_while(char::is_ascii_digit).count())
        };
        let digits = literals.iter().filter_map(fraction).max().unwrap_or_default();
        Self {
            digits: digits.max(MIN_DIGITS),
            omits_zero: literals.iter().any(|literal| literal.starts_with('.')),
            omits_fraction: literals.iter().any(|literal| literal.ends_with('.')),
        }
    }

    fn write(&self, value: f32) -> String {
        let mut text = format!("{:.*}", self.digits, value.clamp(0.0, 1.0));
        text.truncate(text.trim_end_matches('0').len());
        if text.ends_with('.') {
            if !self.omits_fraction {
                text.push('0');
            }
        } else if self.omits_zero && text.starts_with("0.") {
            text.remove(0);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::of;

    const MAIN: &str = "void mainImage(out vec4 c, in vec2 p) {";

    fn texts(snapshot: &Snapshot, colors: &[ColorInformation]) -> Vec<String> {
        let bytes = |range: lsp_types::Range| {
            let byte = |position| snapshot.encoding.byte(snapshot.file(), position) as usize;
            byte(range.start)..byte(range.end)
        };
        let text = snapshot.file().text();
        colors
            .iter()
            .map(|color| text[bytes(color.range)].to_owned())
            .collect()
    }

    fn colors(statements: &str) -> Vec<String> {
        let snapshot = of(&format!(
            "float plane(vec3 a) {{ return a.x; }} /* 😀 */ {MAIN}\r\n\t{statements} }}"
        ));
        texts(&snapshot, &document_colors(&snapshot))
    }

    #[test]
    fn constructors_are_colors_by_name_or_value() {
        let statements =
            "vec3 color = vec3(1, 0., 0); vec3 x = vec3(.2, .4, .5); c = vec4(0.1, 0.2, 0.3, 1.0);";
        assert_eq!(
            colors(statements),
            ["vec3(1, 0., 0)", "vec3(.2, .4, .5)", "vec4(0.1, 0.2, 0.3, 1.0)"]
        );
        let others = "vec3 pos = vec3(.1, .2, .3); vec3 a = vec3(0, 1, 0), b = vec3(.5); \
            float d = dot(b, vec3(.299, .587, .114)); vec3 e = vec3(2., .5, 0.), f = vec3(p, .5);";
        assert_eq!(colors(others), [""; 0]);
        assert_eq!(colors("vec3 sky = vec3(.5);"), ["vec3(.5)"]);
        assert_eq!(colors("vec3 e = vec3(.001, 0., 0.);"), [""; 0]);
        assert_eq!(
            colors("vec3 col = mix(vec3(1), vec3(0, 0, .5), p.x);"),
            ["vec3(1)", "vec3(0, 0, .5)"]
        );
        assert_eq!(colors("vec3 col = vec3(plane(vec3(0, 1, 0)));"), [""; 0]);
    }

    #[test]
    fn colors_are_written_in_the_style_of_the_author() {
        let written = |literal: &str, color: [f32; 4]| {
            let snapshot = of(&format!("{MAIN} vec4 col = vec4(0); col.rgb = {literal}; }}"));
            let at = snapshot.file().text().find(literal).unwrap() as u32;
            let [red, green, blue, alpha] = color;
            let color = Color {
                red,
                green,
                blue,
                alpha,
            };
            let found = color_presentations(&snapshot, color, (at, at + literal.len() as u32));
            found.into_iter().map(|one| one.label).collect::<String>()
        };
        assert_eq!(
            written("vec3(.2, 1., .400)", [0.5, 0.0, 0.1239, 1.0]),
            "vec3(.5, 0., .124)"
        );
        assert_eq!(
            written("vec3(0.2, 1.0, 0.4)", [0.5, 1.0, 0.126, 1.0]),
            "vec3(0.5, 1.0, 0.13)"
        );
        assert_eq!(written("vec3(.5)", [0.25, 0.25, 0.25, 1.0]), "vec3(.25)");
        assert_eq!(written("vec3(.5)", [0.25, 0.5, 0.25, 1.0]), "vec3(.25, .5, .25)");
        assert_eq!(written("col.rgb", [0.0; 4]), "");
    }
}
