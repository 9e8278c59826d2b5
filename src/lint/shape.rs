//! Structural equality of expressions: the same operators applied to the same variables.

use std::fmt::Write;

use toyproof_glsl::tree::{ExprId, ExprKind, Tree, VariableId};

/// The maximum number of nodes in a shape.
const MAX_SHAPE_NODES: usize = 100;

/// The structure of an expression; `None` for expressions with side effects or more than [`MAX_SHAPE_NODES`]
/// nodes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Shape {
    text: String,
    /// The variables that its value depends on.
    pub(super) variables: Vec<VariableId>,
}

impl Shape {
    pub(super) fn new(tree: &Tree, root: ExprId) -> Option<Self> {
        let mut shape = Self {
            text: String::new(),
            variables: Vec::new(),
        };
        let mut pending = vec![root];
        // One more iteration, in which no node is pending.
        for _ in 0..=MAX_SHAPE_NODES {
            let Some(expr) = pending.pop() else {
                return Some(shape);
            };
            // Each operator's name implies its number of operands, so prefix order identifies the tree.
            let text = &mut shape.text;
            let written = match &tree[expr].kind {
                ExprKind::Literal(literal) => write!(text, "{:?};", literal.value),
                ExprKind::Variable(variable) => {
                    shape.variables.push(*variable);
                    write!(text, "{variable:?};")
                }
                ExprKind::Unary { op, .. } => write!(text, "{op:?};"),
                ExprKind::Binary { op, .. } => write!(text, "{op:?};"),
                ExprKind::Conditional { .. } => write!(text, "?:;"),
                ExprKind::BuiltIn { function, arguments } if function.out_parameter().is_none() => {
                    write!(text, "{function:?}{};", arguments.len())
                }
                ExprKind::Construct { arguments, .. } => {
                    write!(text, "{:?}{};", tree[expr].ty, arguments.len())
                }
                ExprKind::Swizzle { components, .. } => write!(text, ".{};", components.name()),
                ExprKind::Member { member, .. } => write!(text, ".{member};"),
                ExprKind::Index { .. } => write!(text, "[];"),
                ExprKind::Length { .. } => write!(text, "length;"),
                _ => return None,
            };
            written.ok()?;
            let first = pending.len();
            tree[expr].kind.for_each_operand(|operand| pending.push(operand));
            pending[first..].reverse();
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::{Options, check};

    use super::*;

    /// Whether a sum of this many terms, with a sign, has a shape; a sum has a node less than twice its terms.
    fn has_shape(terms: usize, sign: &str) -> bool {
        let sum = vec!["g"; terms].join(" + ");
        let text = format!(
            "float g; void mainImage(out vec4 c, in vec2 p) {{ float x = {sign}({sum}); c = vec4(x); }}"
        );
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let checked = check(&files, file, &Options::default()).unwrap();
        let tree = &checked.tree;
        let mut variables = tree.variables.iter();
        let (_, variable) = variables.find(|(_, variable)| variable.name == "x").unwrap();
        Shape::new(tree, variable.initializer.unwrap()).is_some()
    }

    #[test]
    fn a_shape_has_at_most_the_maximum_number_of_nodes() {
        assert_eq!(MAX_SHAPE_NODES, 100);
        // 99, 100 and 101 nodes.
        assert!(has_shape(50, "") && has_shape(50, "-") && !has_shape(51, ""));
    }
}
