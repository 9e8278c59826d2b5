//! The edits of a shader as a list of texts, for a search that renders more than the shader.

use std::collections::HashSet;

use toyproof_diagnostic::{Fix, Span};
use toyproof_glsl::Checked;

use super::edit::Candidate;
use super::edits::{Constants, assignment_candidates, candidates, structural_edits};
use super::shader::Shader;
use crate::engine::tournament::Values;
use crate::known::KnownMistake;

/// The additional cost of an edit in a function that the references have, too.
const COPIED: u32 = 10;

/// An edit of a shader.
#[derive(Debug, Clone)]
pub(crate) struct ListedEdit {
    pub(crate) fix: Fix,
    pub(crate) mistake: KnownMistake,
    /// The statement that it changes.
    pub(crate) statement: Span,
    /// How unlikely it is.
    pub(crate) cost: u32,
}

/// The edits of a shader up to a cost, the most likely first. `references` are correct shaders for the same
/// assignment.
pub(crate) fn edits(
    checked: &Checked,
    source: &str,
    references: &[&Checked],
    max_cost: u32,
) -> Vec<ListedEdit> {
    let trees: Vec<_> = references.iter().map(|reference| &reference.tree).collect();
    let constants = Constants::in_trees(&trees);
    let shader = Shader {
        copied: constants.definitions.shared_with(&checked.tree),
        ..Shader::new(checked, source)
    };
    let sites: Vec<usize> = (0..shader.sites.len()).collect();
    let statements: Vec<usize> = (0..shader.statements.len()).collect();
    let mut of_tree = candidates(&shader, &constants, &sites, &statements);
    of_tree.extend(assignment_candidates(&shader, &constants, &statements));
    let of_tree = of_tree
        .iter()
        .flat_map(with_each_number)
        .filter(|candidate| candidate.cost <= max_cost);
    let of_tree = of_tree.filter_map(|candidate| {
        Some(ListedEdit {
            fix: candidate.fix(&shader)?,
            mistake: candidate.kind(&shader).mistake(),
            statement: shader.statements[candidate.statement(&shader)].span,
            cost: candidate.cost,
        })
    });
    let of_text = structural_edits(&shader, &constants).into_iter();
    let of_text = of_text
        .filter(|edit| edit.cost <= max_cost)
        .map(|edit| ListedEdit {
            fix: edit.fix,
            mistake: edit.kind.mistake(),
            statement: shader.statements[edit.statement].span,
            cost: edit.cost,
        });
    let mut all: Vec<ListedEdit> = of_tree.chain(of_text).collect();
    let copied = shader.statements.iter().filter(|statement| {
        let function = statement.at.map(|id| id.function);
        function.is_some_and(|function| shader.copied.contains(&function))
    });
    let copied: HashSet<Span> = copied.map(|statement| statement.span).collect();
    for edit in &mut all {
        if copied.contains(&edit.statement) {
            edit.cost += COPIED;
        }
    }
    all.sort_by_key(|edit| edit.cost);
    all
}

/// A candidate with each of the numbers that it tries.
fn with_each_number(candidate: &Candidate) -> Vec<Candidate> {
    match &candidate.values {
        Values::Fixed => vec![candidate.clone()],
        Values::Tried { values, .. } => values
            .iter()
            .map(|&(value, cost)| candidate.with_numbers(&[value, 0.0, 0.0], cost))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    /// The edits of a shader whose body of `mainImage` follows some functions, with their costs.
    fn listed(functions: &str, body: &str) -> Vec<(u32, String)> {
        let text = format!("{functions} void mainImage(out vec4 c, in vec2 p) {{ {body} }}");
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text.as_str()));
        let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap();
        let all = edits(&checked, &text, &[], u32::MAX);
        all.into_iter()
            .map(|edit| (edit.cost, edit.fix.message))
            .collect()
    }

    #[track_caller]
    fn cost(all: &[(u32, String)], message: &str) -> u32 {
        let found = all.iter().find(|(_, own)| own == message);
        found.unwrap_or_else(|| panic!("{message} is not in {all:#?}")).0
    }

    #[test]
    fn variables_are_transformed_behind_statements_and_blocks() {
        let all = listed(
            "vec3 shown(mat3 m, vec3 v) { if (v.x > 0.0) { v.y = 1.0; } return v; }",
            "c = vec4(shown(mat3(p.x), p.xyy), 1.0);",
        );
        cost(&all, "insert `v = m * v;` before `return v;`");
        cost(&all, "insert `v.xy /= v.z;` before `return v;`");
        cost(&all, "insert `v.y += 0.5;` after `v.y = 1.0;`");
        cost(&all, "insert `v *= 2.0;` before `v.y = 1.0;`");
    }

    #[test]
    fn a_variable_that_is_never_assigned_or_read_is_likely_to_be_missing() {
        let all = listed(
            "",
            "float best = 9.0; float other = 1.0; int at = 0; float unread = 2.0;
             for (int i = 0; i < 3; i++) { float d = p.x * float(i); other = d; if (d < best) { at = i; } }
             c = vec4(float(at), best, other, 1.0);",
        );
        let never = cost(&all, "insert `best = d;` after `at = i;`");
        assert!(never < cost(&all, "insert `other = d;` after `at = i;`"));
        let unread = cost(&all, "replace `p.x * float(i)` with `p.x * float(i) + unread`");
        assert!(unread < cost(&all, "replace `p.x * float(i)` with `p.x * float(i) + best`"));
    }

    #[test]
    fn a_value_is_not_combined_with_an_unset_variable() {
        let all = listed(
            "",
            "float a; a = p.x; float b = 1.0; b = p.y; c = vec4(a, b, 0.0, 1.0);",
        );
        let set = cost(&all, "replace `b = p.y` with `b -= p.y`");
        assert!(set < cost(&all, "replace `a = p.x` with `a -= p.x`"));
    }

    #[test]
    fn a_body_without_braces_gets_them() {
        let text =
            "void mainImage(out vec4 c, in vec2 p) { float a = 1.0; if (p.x > 2.0) a = p.x; c = vec4(a); }";
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap();
        let all = edits(&checked, text, &[], u32::MAX);
        let texts = all
            .iter()
            .filter_map(|edit| crate::engine::confirm::apply(text, &edit.fix));
        let wanted = text.replace("a = p.x;", "{ a = p.x; a *= 0.5; }");
        assert!(texts.collect::<Vec<_>>().contains(&wanted));
    }

    #[test]
    fn operations_are_done_in_another_order() {
        let all = listed(
            "vec2 turn(vec2 p, float a) { return p * a; } vec2 lift(vec2 p, float a) { return p + a; }
             int bits[2] = int[](3, 5);",
            "mat2 a = mat2(p.x), b = mat2(p.y), d = mat2(2.0);
             vec2 q = turn(lift(p, 1.0), 2.0);
             ivec2 cell = ivec2(p); int i = 1, j = 2;
             mat2 m = a * b * d;
             c = vec4(m * q, float(bits[0] / 16), float(i + j));
             c *= texelFetch(iChannel0, cell, 0);",
        );
        cost(
            &all,
            "replace `turn(lift(p, 1.0), 2.0)` with `lift(turn(p, 2.0), 1.0)`",
        );
        cost(&all, "replace `a * b * d` with `a * d * b`");
        cost(
            &all,
            "replace `float(bits[0] / 16)` with `float(bits[0]) / float(16)`",
        );
        cost(&all, "replace `cell` with `cell + ivec2(j, i)`");
    }
}
