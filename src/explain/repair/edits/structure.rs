//! Edits of the structure, as texts: statements that move into or out of a block, jumps, `else`, exchanged
//! variables and values, helper functions that nothing calls, screen coordinates. An edit may turn out to be
//! invalid: each text is parsed and checked.

use std::collections::{BTreeMap, HashSet};

use toyproof_diagnostic::{Edit, Fix, Span};
use toyproof_glsl::tree::{Direction, ExprId, ExprKind, FunctionId, Scalar, Type, VariableId, VariableKind};
use toyproof_verify::random::reachable_expressions;

use super::super::edit::{EditKind, shortened};
use super::super::scan;
use super::super::shader::{Shader, Shape};
use super::is_float;

/// The costs: a move into or out of a block, within a block, an exchange, a jump or `else`, a call of a
/// helper function, screen coordinates, and a copy of an old value.
const MOVE: u32 = 22;
const FAR_MOVE: u32 = 24;
const EXCHANGE: u32 = 23;
const JUMP: u32 = 24;
const HELPER: u32 = 20;
const COORDINATES: u32 = 22;
const OLD_VALUE: u32 = 25;

/// The largest numbers of statements between two whose values are exchanged, of places in a block to which a
/// statement moves, of values in scope that a helper function is called with, and of edits in all.
const MAX_DISTANCE: usize = 4;
const MAX_PLACES: usize = 12;
const MAX_VALUES: usize = 3;
const MAX_EDITS: usize = 4000;

/// An edit of the text.
#[derive(Debug, Clone)]
pub(in crate::repair) struct TextEdit {
    pub(in crate::repair) fix: Fix,
    pub(in crate::repair) kind: EditKind,
    /// How unlikely it is, before its place is considered.
    pub(in crate::repair) cost: u32,
    /// The index of the statement that it changes.
    pub(in crate::repair) statement: usize,
}

/// The edits of a shader.
pub(in crate::repair) fn edits(shader: &Shader) -> Vec<TextEdit> {
    let mut writer = Writer {
        shader,
        outline: Outline::new(shader),
        all: Vec::new(),
    };
    for at in 0..shader.statements.len() {
        writer.moves(at);
        writer.exchanges(at);
        writer.jumps(at);
        writer.coordinates(at);
        writer.old_value(at);
    }
    writer.helpers();
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

    fn function(&self, at: usize) -> Option<FunctionId> {
        self.shader.statements[at].at.map(|id| id.function)
    }

    /// Moves a statement out of the blocks that contain it, into a neighbouring one, or within its own.
    fn moves(&mut self, at: usize) {
        let is_simple = |at: usize| {
            matches!(
                self.shader.statements[at].kind,
                Shape::Declaration(_) | Shape::Expression(_)
            )
        };
        if !is_simple(at) || self.outline.extents[at].is_none() {
            return;
        }
        let outer: Vec<usize> = self.outline.enclosing(at).take(2).collect();
        let siblings = self.siblings(at);
        let own = siblings.iter().position(|&other| other == at);
        let mut places: Vec<(usize, bool, u32)> = Vec::new();
        for &outer in &outer {
            places.extend([(outer, true, MOVE), (outer, false, MOVE)]);
        }
        if let Some(own) = own {
            let is_block =
                |at: usize| matches!(self.shader.statements[at].kind, Shape::If { .. } | Shape::Loop);
            let neighbours = [own.checked_sub(1), own.checked_add(1)].into_iter().flatten();
            let blocks = neighbours
                .filter_map(|at| siblings.get(at))
                .filter(|&&at| is_block(at));
            for &block in blocks {
                let children = self.outline.children(block);
                places.extend(children.first().map(|&first| (first, true, MOVE)));
                places.extend(children.iter().map(|&child| (child, false, MOVE)));
            }
            // Exchanging two neighbours is an edit of the tree.
            let others = siblings.iter().enumerate();
            let far =
                others.filter(|&(other, _)| other.abs_diff(own) > 1 && other.abs_diff(own) <= MAX_PLACES);
            places.extend(far.map(|(other, &place)| (place, other < own, FAR_MOVE)));
        }
        for (place, is_before, cost) in places {
            self.move_to(at, place, is_before, cost);
        }
    }

    fn move_to(&mut self, at: usize, place: usize, is_before: bool, cost: u32) {
        let (Some(own), Some(other)) = (self.outline.extents[at], self.outline.extents[place]) else {
            return;
        };
        let text = self.shader.text(own);
        let (position, inserted) = if is_before {
            (other.start, format!("{text} "))
        } else {
            (other.end, format!(" {text}"))
        };
        let side = if is_before { "before" } else { "after" };
        let message = format!(
            "move `{}` {side} `{}`",
            shortened(text),
            shortened(self.text(place))
        );
        let edits = vec![deletion(own), insertion(own, position, inserted)];
        self.add(at, EditKind::MisplacedStatement, cost, message, edits);
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

    /// Exchanges two variables in a statement, replaces one everywhere in it, and exchanges the values of two
    /// statements.
    fn exchanges(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let mut uses: BTreeMap<VariableId, Vec<Span>> = BTreeMap::new();
        for site in shader
            .sites
            .iter()
            .filter(|site| site.statement == at && site.exprs.len() == 1)
        {
            if let ExprKind::Variable(variable) = tree[site.exprs[0]].kind
                && matches!(
                    tree[variable].kind,
                    VariableKind::Local | VariableKind::Parameter(_)
                )
            {
                uses.entry(variable).or_default().push(site.span);
            }
        }
        let replaced = |spans: &[Span], by: VariableId| -> Vec<Edit> {
            let name = tree[by].name.as_str();
            spans.iter().map(|&span| replacement(span, name)).collect()
        };
        let variables: Vec<VariableId> = uses.keys().copied().collect();
        for (index, &one) in variables.iter().enumerate() {
            for &other in &variables[index + 1..] {
                if tree[one].ty == tree[other].ty {
                    let mut edits = replaced(&uses[&one], other);
                    edits.extend(replaced(&uses[&other], one));
                    let names = [one, other].map(|id| tree[id].name.as_str());
                    let message = format!("exchange `{}` and `{}`", names[0], names[1]);
                    self.add(at, EditKind::Arguments, EXCHANGE, message, edits);
                }
            }
            if uses[&one].len() > 1 {
                for &other in shader.statements[at].scope.iter() {
                    let is_local =
                        matches!(tree[other].kind, VariableKind::Local | VariableKind::Parameter(_));
                    if other != one && is_local && tree[other].ty == tree[one].ty {
                        let [old, new] = [one, other].map(|id| tree[id].name.as_str());
                        let message = format!("replace each `{old}` with `{new}`");
                        let edits = replaced(&uses[&one], other);
                        self.add(at, EditKind::Variable, EXCHANGE, message, edits);
                    }
                }
            }
        }
        let Some((value, ty)) = self.value(at) else { return };
        let siblings = self.siblings(at);
        let after = siblings.iter().filter(|&&other| other > at).take(MAX_DISTANCE);
        for &other in after {
            if let Some((other, other_type)) = self.value(other)
                && other_type == ty
                && shader.text(value) != shader.text(other)
            {
                let [one, two] = [value, other].map(|span| shader.text(span).to_owned());
                let message = format!("exchange `{}` and `{}`", shortened(&one), shortened(&two));
                let edits = vec![replacement(value, &two), replacement(other, &one)];
                self.add(at, EditKind::Operands, EXCHANGE, message, edits);
            }
        }
    }

    /// The text of the value that a statement assigns, and its type.
    fn value(&self, at: usize) -> Option<(Span, Type)> {
        let tree = self.shader.tree;
        self.outline.extents[at]?;
        let value = match self.shader.statements[at].kind {
            Shape::Declaration(variable) => tree[variable].initializer?,
            Shape::Expression(expr) => match tree[expr].kind {
                ExprKind::Assign { value, .. } => value,
                _ => return None,
            },
            _ => return None,
        };
        let place = tree[value].at;
        (!place.is_expanded()).then_some((place.span, tree[value].ty))
    }

    /// Leaves the function or the loop at the end of an `if`, and makes what follows it its `else`.
    fn jumps(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let Shape::If { is_single: true } = shader.statements[at].kind else {
            return;
        };
        let (Some(extent), Some(function)) = (self.outline.extents[at], self.function(at)) else {
            return;
        };
        let mut words = Vec::new();
        if tree[function].return_type == Type::Void {
            words.push("return;");
        }
        if self
            .outline
            .enclosing(at)
            .any(|outer| shader.statements[outer].kind == Shape::Loop)
        {
            words.extend(["break;", "continue;"]);
        }
        let text = shader.text(extent);
        let head = shortened(shader.text(shader.statements[at].span));
        for word in words {
            let edits = if text.ends_with('}') {
                vec![insertion(extent, extent.end - 1, format!("{word} "))]
            } else {
                let Some(body) = scan::body(shader.source, extent.start as usize) else {
                    continue;
                };
                vec![
                    insertion(extent, body as u32, "{ ".to_owned()),
                    insertion(extent, extent.end, format!(" {word} }}")),
                ]
            };
            let message = format!("insert `{word}` at the end of `{head}`");
            self.add(at, EditKind::MissingStatement, JUMP, message, edits);
        }
        let after: Vec<usize> = self
            .siblings(at)
            .into_iter()
            .filter(|&other| other > at)
            .collect();
        let (Some(&next), Some(&last)) = (after.first(), after.last()) else {
            return;
        };
        let (Some(start), Some(end)) = (self.outline.extents[next], self.outline.extents[last]) else {
            return;
        };
        let shown = shortened(self.text(next));
        let message = format!("insert `else` before `{shown}`");
        let single = vec![insertion(start, start.start, "else ".to_owned())];
        self.add(at, EditKind::Condition, JUMP, message.clone(), single);
        let all = vec![
            insertion(start, start.start, "else { ".to_owned()),
            insertion(end, end.end, " }".to_owned()),
        ];
        self.add(
            at,
            EditKind::Condition,
            JUMP,
            format!("{message} and what follows"),
            all,
        );
    }

    /// Other screen coordinates, and the aspect ratio of coordinates.
    fn coordinates(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let main = shader.checked.main_image;
        let Some(&position) = tree[main].parameters.get(1) else {
            return;
        };
        let p = tree[position].name.as_str();
        let vec2 = Type::Vector(Scalar::Float, 2);
        let mentions = |expr: ExprId| toyproof_glsl::tree::walk::mentions(tree, expr, position);
        if self.function(at) == Some(main) {
            let forms = [
                format!("({p} / iResolution.y)"),
                format!("({p} / iResolution.xy)"),
                format!("({p} / iResolution.x)"),
                format!("((2.0 * {p} - iResolution.xy) / iResolution.y)"),
                format!("(2.0 * {p} / iResolution.xy - 1.0)"),
                format!("(({p} - 0.5 * iResolution.xy) / iResolution.y)"),
                format!("({p} / iResolution.xy - 0.5)"),
                format!("((2.0 * {p} - iResolution.xy) / iResolution.x)"),
                format!("(({p} - 0.5 * iResolution.xy) / iResolution.x)"),
            ];
            let sites = shader
                .sites
                .iter()
                .filter(|site| site.statement == at && site.exprs.len() == 1);
            let sites = sites.filter(|site| {
                let expr = site.exprs[0];
                let is_name = matches!(tree[expr].kind, ExprKind::Variable(_) | ExprKind::Swizzle { .. });
                tree[expr].ty == vec2 && !is_name && mentions(expr)
            });
            for span in sites.map(|site| site.span).collect::<Vec<_>>() {
                for form in &forms {
                    let shown = &form[1..form.len() - 1];
                    let message = format!("replace `{}` with `{shown}`", shortened(shader.text(span)));
                    let edits = vec![replacement(span, form)];
                    self.add(at, EditKind::Expression, COORDINATES, message, edits);
                }
            }
        }
        let target = match shader.statements[at].kind {
            Shape::Declaration(variable) => Some(variable),
            Shape::Expression(expr) => match tree[expr].kind {
                ExprKind::Assign { target, .. } => match tree[target].kind {
                    ExprKind::Variable(variable) => Some(variable),
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        };
        let (Some(variable), Some(extent)) = (target, self.outline.extents[at]) else {
            return;
        };
        if tree[variable].ty != vec2 || self.function(at) != Some(main) {
            return;
        }
        let name = tree[variable].name.as_str();
        for text in [
            format!("{name}.x *= iResolution.x / iResolution.y;"),
            format!("{name}.y *= iResolution.y / iResolution.x;"),
        ] {
            let message = format!("insert `{text}` after `{}`", shortened(self.text(at)));
            let edits = vec![insertion(extent, extent.end, format!(" {text}"))];
            self.add(at, EditKind::MissingStatement, COORDINATES, message, edits);
        }
    }

    /// Keeps the value that a variable has before a statement for the one after it.
    fn old_value(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let (Shape::Expression(expr), Some(extent)) = (&shader.statements[at].kind, self.outline.extents[at])
        else {
            return;
        };
        let ExprKind::Assign { target, .. } = tree[*expr].kind else {
            return;
        };
        let (place, ty) = (tree[target].at, tree[target].ty);
        let Some(next) = shader.statements[at]
            .next
            .filter(|_| !place.is_expanded() && is_float(ty))
        else {
            return;
        };
        let target = shader.text(place.span);
        let uses = shader.sites.iter().filter(|site| {
            site.statement == next && site.exprs.len() == 1 && shader.text(site.span) == target
        });
        let uses: Vec<Span> = uses.map(|site| site.span).collect();
        if uses.is_empty() {
            return;
        }
        let Some(name) = ["old", "before", "previous"]
            .into_iter()
            .find(|name| !shader.source.contains(name))
        else {
            return;
        };
        let declaration = format!("{} {name} = {target};", tree.type_name(ty));
        let message = format!(
            "insert `{declaration}` before `{}`, and use `{name}` in `{}`",
            shortened(self.text(at)),
            shortened(shader.text(shader.statements[next].span))
        );
        let mut edits = vec![insertion(extent, extent.start, format!("{declaration} "))];
        edits.extend(uses.into_iter().map(|span| replacement(span, name)));
        self.add(at, EditKind::MissingStatement, OLD_VALUE, message, edits);
    }

    /// Calls of the functions that nothing calls.
    fn helpers(&mut self) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let reachable = reachable_expressions(tree, shader.checked.main_image);
        let called: HashSet<FunctionId> = reachable
            .iter()
            .filter_map(|&expr| match tree[expr].kind {
                ExprKind::Call { function, .. } => Some(function),
                _ => None,
            })
            .collect();
        let reachable: HashSet<ExprId> = reachable.into_iter().collect();
        let is_in =
            |&parameter: &VariableId| matches!(tree[parameter].kind, VariableKind::Parameter(Direction::In));
        let uncalled = tree.functions.iter().filter(|(id, function)| {
            function.body.is_some()
                && *id != shader.checked.main_image
                && !called.contains(id)
                && is_float(function.return_type)
                && function.parameters.iter().all(is_in)
        });
        let uncalled: Vec<FunctionId> = uncalled.map(|(id, _)| id).collect();
        for function in uncalled {
            for site in &shader.sites {
                let expr = site.exprs[0];
                if site.exprs.len() == 1 && reachable.contains(&expr) && is_float(tree[expr].ty) {
                    self.helper(function, expr, site.span, site.statement);
                }
            }
        }
    }

    /// Wraps an expression in a call, replaces it by one, and multiplies it by one or adds it.
    fn helper(&mut self, function: FunctionId, expr: ExprId, span: Span, statement: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let own = &tree[function];
        let old = shader.text(span);
        let values = |ty: Type| -> Vec<String> {
            let scope = shader.statements[statement].scope.iter().rev();
            let of_type = scope.filter(|&&variable| {
                tree[variable].ty == ty && !tree[variable].name.is_empty() && !tree[variable].kind.is_input()
            });
            let names = of_type.map(|&variable| tree[variable].name.clone());
            names.take(MAX_VALUES).collect()
        };
        let mut calls: Vec<Vec<String>> = vec![Vec::new()];
        for &parameter in &own.parameters {
            let mut arguments = values(tree[parameter].ty);
            if tree[parameter].ty == tree[expr].ty {
                arguments.insert(0, old.to_owned());
            }
            let longer = calls.iter().flat_map(|call| {
                arguments
                    .iter()
                    .map(move |argument| [call.as_slice(), std::slice::from_ref(argument)].concat())
            });
            calls = longer.take(2 * MAX_VALUES).collect();
        }
        for arguments in calls {
            let call = format!("{}({})", own.name, arguments.join(", "));
            let mut forms = Vec::new();
            if own.return_type == tree[expr].ty {
                forms.push(call.clone());
            }
            if !arguments.iter().any(|argument| argument == old)
                && (own.return_type == tree[expr].ty || own.return_type == Type::FLOAT)
            {
                forms.extend([format!("({old} * {call})"), format!("({old} + {call})")]);
            }
            for form in forms {
                let message = format!("replace `{}` with `{}`", shortened(old), shortened(&form));
                self.add(
                    statement,
                    EditKind::MissingCall,
                    HELPER,
                    message,
                    vec![replacement(span, &form)],
                );
            }
        }
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
        let all = edits(&Shader::new(&own, text));
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
    fn an_overwritten_value_is_kept() {
        assert!(leads_to(
            "float x = p.x; float y = p.y; x = x - y; y = x + y; c = vec4(x, y, 0.0, 1.0);",
            "float x = p.x; float y = p.y; float old = x; x = x - y; y = old + y; c = vec4(x, y, 0.0, 1.0);",
        ));
    }
}
