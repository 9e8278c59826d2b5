//! Edits of the structure, as texts: statements that move into or out of a block, jumps, `else`, exchanged
//! variables and values, helper functions that nothing calls, screen coordinates. An edit may turn out to be
//! invalid: each text is parsed and checked.
//!
//! Their costs are low beside those of edits of expressions: a shader has few of them, so that one that
//! repairs an image is seldom lucky.

mod branches;
mod calls;
mod coordinates;
mod exchanges;
mod moves;

use toyproof_diagnostic::{Edit, Fix, Span};
use toyproof_glsl::tree::{FunctionId, Type, Variable};

use super::super::edit::EditKind;
use super::super::scan;
use super::super::shader::{Shader, Shape};
use super::number::Constants;

/// The largest number of places in a block to which a statement moves, of values in scope that are tried for
/// another, and of edits.
const MAX_PLACES: usize = 12;
const MAX_VALUES: usize = 3;
const MAX_EDITS: usize = 6000;

/// An edit of the text.
#[derive(Debug, Clone)]
pub(crate) struct TextEdit {
    pub(crate) fix: Fix,
    pub(crate) kind: EditKind,
    /// How unlikely it is, before its place is considered.
    pub(crate) cost: u32,
    /// The index of the statement that it changes.
    pub(crate) statement: usize,
}

/// The edits of a shader.
pub(crate) fn edits(shader: &Shader, constants: &Constants) -> Vec<TextEdit> {
    let mut writer = Writer {
        shader,
        constants,
        outline: Outline::new(shader),
        all: Vec::new(),
    };
    for at in 0..shader.statements.len() {
        writer.moves(at);
        writer.exchanges(at);
        writer.jumps(at);
        writer.exits(at);
        writer.alternatives(at);
        writer.hidden(at);
        writer.cases(at);
        writer.dropped(at);
        writer.coordinates(at);
        writer.old_value(at);
    }
    writer.parameters();
    writer.helpers();
    writer.all.sort_by_key(|edit| edit.cost);
    writer.all.truncate(MAX_EDITS);
    writer.all
}

/// How the texts of the statements are nested.
struct Outline {
    /// The text of each statement; `None` if it shares it with others or is in a macro.
    extents: Vec<Option<Span>>,
    /// The innermost statement that contains it.
    parents: Vec<Option<usize>>,
}

impl Outline {
    fn new(shader: &Shader) -> Self {
        let extent = |at: usize| {
            let statement = &shader.statements[at];
            let start = statement.span.start as usize;
            let is_whole = statement.at.is_some()
                && !statement.is_expanded
                && scan::follows_statement(shader.source, start);
            let end = scan::statement_end(shader.source, start).filter(|_| is_whole)?;
            Some(Span::new(statement.span.file, statement.span.start, end as u32))
        };
        let extents: Vec<Option<Span>> = (0..shader.statements.len()).map(extent).collect();
        let mut parents = vec![None; extents.len()];
        let mut open: Vec<usize> = Vec::new();
        for (at, statement) in shader.statements.iter().enumerate() {
            let start = statement.span.start;
            while open
                .last()
                .is_some_and(|&last| extents[last].is_none_or(|last| last.end <= start))
            {
                open.pop();
            }
            parents[at] = open.last().copied();
            if matches!(statement.kind, Shape::If { .. } | Shape::Loop | Shape::Other) {
                open.push(at);
            }
        }
        Self { extents, parents }
    }

    /// The statements that contain one, from the inside outwards.
    fn enclosing(&self, at: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(self.parents[at], |&at| self.parents[at])
    }

    /// The statements directly inside one.
    fn children(&self, of: usize) -> Vec<usize> {
        let is_child = |&at: &usize| self.parents[at] == Some(of) && self.extents[at].is_some();
        (of + 1..self.parents.len())
            .filter(is_child)
            .take(MAX_PLACES)
            .collect()
    }
}

struct Writer<'a> {
    shader: &'a Shader<'a>,
    constants: &'a Constants,
    outline: Outline,
    all: Vec<TextEdit>,
}

impl Writer<'_> {
    fn add(&mut self, statement: usize, kind: EditKind, cost: u32, message: String, mut edits: Vec<Edit>) {
        edits.sort_by_key(|edit| edit.span.start);
        if edits
            .windows(2)
            .all(|pair| pair[0].span.end <= pair[1].span.start)
        {
            let fix = Fix { message, edits };
            self.all.push(TextEdit {
                fix,
                kind,
                cost,
                statement,
            });
        }
    }

    fn text(&self, at: usize) -> &str {
        self.outline.extents[at].map_or("", |extent| self.shader.text(extent))
    }

    /// The variables in scope behind a statement, the innermost first.
    fn scope(&self, at: usize) -> impl Iterator<Item = &Variable> {
        let statement = &self.shader.statements[at];
        let declared = match &statement.kind {
            Shape::Declaration(variable) => Some(variable),
            _ => None,
        };
        let scope = declared.into_iter().chain(statement.scope.iter().rev());
        scope.map(|&variable| &self.shader.tree[variable])
    }

    /// The names of the values of a type in scope behind a statement, the innermost first.
    fn values(&self, at: usize, ty: Type) -> impl Iterator<Item = &str> {
        let own = self.scope(at);
        own.filter(move |own| own.ty == ty && !own.name.is_empty() && !own.kind.is_input())
            .map(|own| own.name.as_str())
    }

    /// Whether a statement declares a variable or is an expression.
    fn is_simple(&self, at: usize) -> bool {
        let kind = &self.shader.statements[at].kind;
        self.outline.extents[at].is_some() && matches!(kind, Shape::Declaration(_) | Shape::Expression(_))
    }

    fn function(&self, at: usize) -> Option<FunctionId> {
        self.shader.statements[at].at.map(|id| id.function)
    }

    /// The statements of the same block, in order.
    fn siblings(&self, at: usize) -> Vec<usize> {
        let (parent, function) = (self.outline.parents[at], self.function(at));
        let all = 0..self.shader.statements.len();
        let is_sibling = |&other: &usize| {
            self.outline.parents[other] == parent
                && self.function(other) == function
                && self.outline.extents[other].is_some()
        };
        all.filter(is_sibling).collect()
    }
}

fn deletion(span: Span) -> Edit {
    replacement(span, "")
}

fn replacement(span: Span, text: &str) -> Edit {
    Edit {
        span,
        replacement: text.to_owned(),
    }
}

/// An insertion at a byte of the file of a span.
fn insertion(of: Span, at: u32, text: String) -> Edit {
    Edit {
        span: Span::new(of.file, at, at),
        replacement: text,
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;
    use crate::engine::confirm::apply;

    /// The texts after each edit that is valid.
    fn edited(text: &str) -> Vec<String> {
        let checked = |text: &str| {
            let mut files = Files::default();
            let file = files.add(File::new("a.glsl", text));
            toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default())
        };
        let own = checked(text).unwrap();
        let all = edits(&Shader::new(&own, text), &Constants::default());
        let texts = all.iter().map(|edit| apply(text, &edit.fix).unwrap());
        texts.filter(|text| checked(text).is_ok()).collect()
    }

    /// Whether an edit of the body of `mainImage` results in another body, apart from blanks.
    fn leads_to(before: &str, after: &str) -> bool {
        let helpers = "float grid(vec2 p) { return p.x; }";
        let whole = |body: &str| format!("{helpers} void mainImage(out vec4 c, in vec2 p) {{ {body} }}");
        let words = |text: &str| text.split_whitespace().collect::<String>();
        let wanted = words(&whole(after));
        edited(&whole(before)).iter().any(|text| words(text) == wanted)
    }

    #[test]
    fn statements_move_into_and_out_of_blocks() {
        assert!(leads_to(
            "float s; for (int i = 0; i < 3; i++) { s = 1.0; s *= 0.5; } c = vec4(s);",
            "float s; s = 1.0; for (int i = 0; i < 3; i++) { s *= 0.5; } c = vec4(s);",
        ));
        assert!(leads_to(
            "float s = 1.0; if (p.x > 2.0) { s = 0.5; } s *= 2.0; c = vec4(s);",
            "float s = 1.0; if (p.x > 2.0) { s = 0.5; s *= 2.0; } c = vec4(s);",
        ));
    }

    #[test]
    fn jumps_and_else_are_inserted() {
        assert!(leads_to(
            "if (p.x > 2.0) { c = vec4(1.0); } c = vec4(0.0);",
            "if (p.x > 2.0) { c = vec4(1.0); return; } c = vec4(0.0);",
        ));
        assert!(leads_to(
            "if (p.x > 2.0) c = vec4(1.0); c = vec4(0.0);",
            "if (p.x > 2.0) c = vec4(1.0); else c = vec4(0.0);",
        ));
    }

    #[test]
    fn statements_move_together() {
        assert!(leads_to(
            "float s, t; for (int i = 0; i < 3; i++) { s = 1.0; t = 2.0; s *= t; } c = vec4(s);",
            "float s, t; s = 1.0; t = 2.0; for (int i = 0; i < 3; i++) { s *= t; } c = vec4(s);",
        ));
        assert!(leads_to(
            "float s = 1.0; float t = 2.0; for (int i = 0; i < 3; i++) { s *= t; c = vec4(s); }",
            "for (int i = 0; i < 3; i++) { float s = 1.0; float t = 2.0; s *= t; c = vec4(s); }",
        ));
    }

    #[test]
    fn a_declaration_that_hides_a_variable_becomes_an_assignment() {
        assert!(leads_to(
            "float s = 1.0; if (p.x > 2.0) { float s = 0.5; } c = vec4(s);",
            "float s = 1.0; if (p.x > 2.0) { s = 0.5; } c = vec4(s);",
        ));
    }

    #[test]
    fn dropped_values_are_used() {
        assert!(leads_to(
            "float s = 1.0; min(s, p.x); c = vec4(s);",
            "float s = 1.0; s = min(s, p.x); c = vec4(s);",
        ));
        let text = |call: &str| {
            format!(
                "float f(float x) {{ if (x > 1.0) {{ {call}max(x, 2.0); }} return x; }}
                 void mainImage(out vec4 c, in vec2 p) {{ c = vec4(f(p.x)); }}"
            )
        };
        assert!(edited(&text("")).contains(&text("return ")));
    }

    #[test]
    fn an_assigned_parameter_is_returned_to_the_caller() {
        let text = |qualifier: &str| {
            format!(
                "void paint(float d, {qualifier}vec3 color) {{ color *= d; }}
                 void mainImage(out vec4 c, in vec2 p) {{ vec3 s = vec3(1.0); paint(p.x, s); c = vec4(s, 1.0); }}"
            )
        };
        assert!(edited(&text("")).contains(&text("inout ")));
        assert!(edited(&text("in ")).contains(&text("inout ")));
    }

    #[test]
    fn a_case_ends_before_the_next() {
        assert!(leads_to(
            "float s = 1.0; switch (int(p.x)) { case 0: s = 2.0; case 1: s = 3.0; } c = vec4(s);",
            "float s = 1.0; switch (int(p.x)) { case 0: s = 2.0; break; case 1: s = 3.0; } c = vec4(s);",
        ));
    }

    #[test]
    fn an_else_may_end_before_the_last_statement() {
        assert!(leads_to(
            "float s = 1.0; if (p.x > 1.0) { s = 2.0; } float t = p.y; s = t; s *= 2.0; c = vec4(s);",
            "float s = 1.0; if (p.x > 1.0) { s = 2.0; } else { float t = p.y; s = t; } s *= 2.0; c = vec4(s);",
        ));
    }

    #[test]
    fn a_declaration_moves_with_its_use() {
        assert!(leads_to(
            "vec3 s = vec3(1.0); s *= 2.0; float t = p.y; s = mix(s, vec3(0.0), t); c = vec4(s, 1.0);",
            "vec3 s = vec3(1.0); float t = p.y; s = mix(s, vec3(0.0), t); s *= 2.0; c = vec4(s, 1.0);",
        ));
    }

    #[test]
    fn a_branch_gets_an_assignment_to_its_variable() {
        assert!(leads_to(
            "float s = 1.0; float t = 2.0; if (p.x > 2.0) { s = 0.5; } c = vec4(s);",
            "float s = 1.0; float t = 2.0; if (p.x > 2.0) { s = 0.5; } else { s = t; } c = vec4(s);",
        ));
    }

    #[test]
    fn variables_and_values_are_exchanged() {
        assert!(leads_to(
            "float a = p.x; float b = p.y; c = vec4(a - b * a);",
            "float a = p.x; float b = p.y; c = vec4(b - a * b);",
        ));
        assert!(leads_to(
            "float a = p.x; float b = p.y; c = vec4(a - b);",
            "float a = p.y; float b = p.x; c = vec4(a - b);",
        ));
    }

    #[test]
    fn an_uncalled_function_is_called() {
        assert!(leads_to("c = vec4(p.x);", "c = vec4((p.x * grid(p)));"));
        let helpers = "float last; void mark(float x) { last += x; } ";
        let main = |body: &str| {
            format!("{helpers} void mainImage(out vec4 c, in vec2 p) {{ {body} c = vec4(last); }}")
        };
        let all = edited(&main("float at = p.x; last = 0.5;"));
        assert!(
            all.contains(&main("float at = p.x; last = 0.5; mark(at);")),
            "{all:?}"
        );
        assert!(all.contains(&main("float at = p.x; last = 0.5; mark(fract(at));")));
        // A result is assigned, and mixed with a number of the reference.
        let helpers = "vec3 sky(float x) { return vec3(x, 0.4, 0.5); } ";
        let main = |body: &str| {
            format!("{helpers} void mainImage(out vec4 c, in vec2 p) {{ {body} c = vec4(color, 1.0); }}")
        };
        let text = main("float at = p.x; vec3 color = vec3(0.3);");
        let all = edited(&text);
        assert!(
            all.contains(&main("float at = p.x; vec3 color = vec3(0.3); color *= sky(at);")),
            "{all:?}"
        );
        // It is called already.
        assert!(!leads_to(
            "c = vec4(p.x) * grid(p);",
            "c = vec4((p.x * grid(p))) * grid(p);",
        ));
    }

    #[test]
    fn coordinates_get_the_aspect_ratio() {
        assert!(leads_to(
            "vec2 q = p / iResolution.xy; c = vec4(q, 0.0, 1.0);",
            "vec2 q = p / iResolution.xy; q.x *= iResolution.x / iResolution.y; c = vec4(q, 0.0, 1.0);",
        ));
        assert!(leads_to(
            "vec2 q = p / iResolution.xy; c = vec4(q, 0.0, 1.0);",
            "vec2 q = (p / iResolution.y); c = vec4(q, 0.0, 1.0);",
        ));
    }

    #[test]
    fn a_vector_is_divided_by_one_side_of_the_image() {
        assert!(leads_to(
            "vec2 R = iResolution.xy, q = 5.0 * (p - 0.5 * R) / R; c = vec4(q, 0.0, 1.0);",
            "vec2 R = iResolution.xy, q = 5.0 * (p - 0.5 * R) / R.y; c = vec4(q, 0.0, 1.0);",
        ));
    }

    #[test]
    fn a_loop_ends_on_a_condition_of_the_reference() {
        let text = |exit: &str| {
            format!(
                "void mainImage(out vec4 c, in vec2 p) {{ float t = 0.0;
                 for (int i = 0; i < 9; i++) {{ t += 0.3 * p.x;{exit} }} c = vec4(t); }}"
            )
        };
        let checked = |text: &str| {
            let mut files = Files::default();
            let file = files.add(File::new("a.glsl", text));
            toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap()
        };
        let (own, reference) = (text(""), text(" if (t > 7.5) break;"));
        let constants = Constants::in_trees(&[&checked(&reference).tree]);
        let tree = checked(&own);
        let all = edits(&Shader::new(&tree, &own), &constants);
        let texts = all.iter().filter_map(|edit| apply(&own, &edit.fix));
        assert!(texts.collect::<Vec<_>>().contains(&reference));
    }

    #[test]
    fn an_overwritten_value_is_kept() {
        assert!(leads_to(
            "float x = p.x; float y = p.y; x = x - y; y = x + y; c = vec4(x, y, 0.0, 1.0);",
            "float x = p.x; float y = p.y; float old = x; x = x - y; y = old + y; c = vec4(x, y, 0.0, 1.0);",
        ));
    }
}
