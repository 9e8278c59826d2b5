//! The declarations of a shader that may get `mediump`.

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::Span;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, FunctionId, Scalar, StatementKind, Tree, Type, VariableId, VariableKind,
    walk,
};

/// What a `mediump` makes less precise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Subject {
    /// The variables of one declaration.
    Variables(Vec<VariableId>),
    /// The result of a function.
    Result(FunctionId),
}

/// A declaration that may get `mediump`.
#[derive(Debug, Clone)]
pub(super) struct Unit {
    pub(super) subject: Subject,
    /// The names that it declares.
    pub(super) names: Vec<String>,
    /// Where the qualifier stands: in front of the type; a `highp` that it replaces.
    pub(super) at: Span,
}

/// The declarations whose values the emulation can round: of floats and vectors of floats, outside of macros.
pub(super) fn units(checked: &Checked, text: &str) -> Vec<Unit> {
    let tree = &checked.tree;
    let refused = refused(tree);
    let file = tree[checked.main_image].at.span.file;
    let is_eligible = |variable: VariableId| {
        let known = &tree[variable];
        is_float(known.ty)
            && !refused.contains(&variable)
            && known
                .at
                .is_some_and(|at| !at.is_expanded() && at.span.file == file)
    };
    let mut units = Vec::new();
    for variable in tree.global_variables() {
        let known = &tree[variable];
        let is_own = matches!(known.kind, VariableKind::Global | VariableKind::Const);
        if let Some(at) = known.at.filter(|_| is_own && is_eligible(variable)) {
            units.extend(type_before(text, at.span).map(|at| Unit {
                subject: Subject::Variables(vec![variable]),
                names: vec![known.name.clone()],
                at,
            }));
        }
    }
    for (id, function) in tree.functions.iter() {
        if function.body.is_none() || id == checked.main_image {
            continue;
        }
        if is_float(function.return_type) && !function.at.is_expanded() && function.at.span.file == file {
            units.extend(type_before(text, function.at.span).map(|at| Unit {
                subject: Subject::Result(id),
                names: vec![format!("{}()", function.name)],
                at,
            }));
        }
        for &parameter in &function.parameters {
            let known = &tree[parameter];
            let is_in = walk::direction(tree, parameter) == Direction::In;
            if let Some(at) = known.at.filter(|_| is_in && is_eligible(parameter)) {
                units.extend(type_before(text, at.span).map(|at| Unit {
                    subject: Subject::Variables(vec![parameter]),
                    names: vec![known.name.clone()],
                    at,
                }));
            }
        }
    }
    let mut declared: HashMap<Span, Vec<VariableId>> = HashMap::new();
    for (_, function) in tree.functions.iter() {
        if let Some(body) = &function.body {
            walk::each(body, &mut |statement| {
                if let StatementKind::Declare(variable) = statement.kind {
                    declared.entry(statement.at.span).or_default().push(variable);
                }
            });
        }
    }
    let mut declared: Vec<_> = declared.into_iter().collect();
    declared.sort_by_key(|(span, _)| span.start);
    for (_, variables) in declared {
        let first = tree[variables[0]].at;
        if let Some(at) = first.filter(|_| variables.iter().all(|&variable| is_eligible(variable))) {
            units.extend(type_before(text, at.span).map(|at| {
                Unit {
                    names: variables
                        .iter()
                        .map(|&variable| tree[variable].name.clone())
                        .collect(),
                    subject: Subject::Variables(variables),
                    at,
                }
            }));
        }
    }
    units
}

/// Floats and vectors of floats.
pub(super) fn is_float(ty: Type) -> bool {
    matches!(ty, Type::Scalar(Scalar::Float) | Type::Vector(Scalar::Float, _))
}

/// Variables that are written in ways that the emulation does not follow: by a function, or by `+=` or `++`
/// in the middle of an expression.
fn refused(tree: &Tree) -> HashSet<VariableId> {
    let statements = updates(tree);
    let mut refused = HashSet::new();
    for id in tree.exprs.ids() {
        tree.each_write(id, |target, value| {
            if value.is_none() && !statements.contains(&id) {
                refused.extend(tree.root_variable(target));
            }
        });
    }
    refused
}

/// The compound assignments and the steps that are statements, or in the third part of `for`.
fn updates(tree: &Tree) -> HashSet<ExprId> {
    let mut pending = Vec::new();
    for (_, function) in tree.functions.iter() {
        walk::each(
            function.body.as_deref().unwrap_or_default(),
            &mut |statement| match &statement.kind {
                StatementKind::Expression(root) => pending.push(*root),
                StatementKind::For { step, .. } => pending.extend(*step),
                _ => {}
            },
        );
    }
    let mut found = HashSet::new();
    while let Some(root) = pending.pop() {
        match tree[root].kind {
            ExprKind::Sequence { first, second } => pending.extend([first, second]),
            ExprKind::Assign { .. } | ExprKind::Step { .. } => {
                found.insert(root);
            }
            _ => {}
        }
    }
    found
}

/// The place of a precision qualifier in front of the type of a name: `vec3 name`, `highp vec3 name`. `None`
/// for `float a, name`.
fn type_before(text: &str, name: Span) -> Option<Span> {
    let word_before = |end: usize| {
        let end = text[..end].trim_end().len();
        let word = text[..end].trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
        (word.len(), end)
    };
    let (start, end) = word_before(name.start as usize);
    let is_type = ["float", "vec2", "vec3", "vec4"].contains(&&text[start..end]);
    let (qualifier, qualifier_end) = word_before(start);
    let at = match &text[qualifier..qualifier_end] {
        "highp" => (qualifier, start),
        "mediump" | "lowp" => return None,
        _ => (start, start),
    };
    is_type.then(|| Span::new(name.file, at.0 as u32, at.1 as u32))
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    #[test]
    fn qualifiers_stand_in_front_of_types() {
        let text = "// é
float f(in vec3 p) { highp vec2 q = p.xy; float a = 1.0, b = 2.0; q.x += a; a++; return q.x + b++; }
void mainImage(out vec4 c, in vec2 p) { c = vec4(f(p.xyy)); }";
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap();
        let found: Vec<_> = units(&checked, text)
            .into_iter()
            .map(|unit| (unit.names.join(" "), unit.at.start, unit.at.end - unit.at.start))
            .collect();
        // `b++` in an expression is not emulated, and one declaration has one precision.
        assert_eq!(
            found,
            [
                ("f()".to_owned(), 6, 0),
                ("p".to_owned(), 17, 0),
                ("q".to_owned(), 27, 6)
            ]
        );
    }
}
