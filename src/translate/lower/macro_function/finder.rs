//! The expressions that uses of macros expand to.

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{ExprId, ExprKind, Scalar, Tree, VariableKind, walk};

use super::uses::{MacroUse, Source, contains};

/// Finds the largest expressions that are within uses, with the indices of these, and the users of all
/// expressions. A use in an argument that occurs twice has two, and one that expands to more or less than an
/// expression may have any number.
pub(super) fn find(
    tree: &Tree,
    source: &Source,
    uses: &[MacroUse],
) -> (Vec<(ExprId, usize)>, HashMap<ExprId, ExprId>) {
    let mut finder = Finder {
        tree,
        source,
        uses,
        found: Vec::new(),
        parents: HashMap::new(),
        fixed: HashSet::new(),
    };
    for (_, function) in tree.functions.iter() {
        walk::each(function.body.as_deref().unwrap_or_default(), &mut |statement| {
            let is_constant = walk::declared(statement).is_some_and(|variable| {
                let value = tree[variable].initializer;
                tree[variable].kind == VariableKind::Const && value.is_some_and(|value| tree[value].constant)
            });
            if !is_constant {
                for root in walk::own_expressions(tree, statement) {
                    finder.visit(root);
                }
            }
        });
    }
    finder.found.retain(|(root, _)| !finder.fixed.contains(root));
    (finder.found, finder.parents)
}

struct Finder<'a> {
    tree: &'a Tree,
    source: &'a Source<'a>,
    uses: &'a [MacroUse<'a>],
    found: Vec<(ExprId, usize)>,
    parents: HashMap<ExprId, ExprId>,
    /// The expressions that a call may not replace: lvalues, and those that must be constant.
    fixed: HashSet<ExprId>,
}

impl Finder<'_> {
    fn visit(&mut self, root: ExprId) {
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            self.fix(id);
            self.find_uses(id);
            self.tree[id].kind.for_each_operand(|operand| {
                self.parents.insert(operand, id);
                pending.push(operand);
            });
        }
    }

    /// Notes the operands of an expression that a call may not replace.
    fn fix(&mut self, id: ExprId) {
        let tree = self.tree;
        tree.each_write(id, |target, _| self.fixed.extend(tree.path(target)));
        let is_offset = |argument: &ExprId| tree[*argument].ty.scalar() == Some(Scalar::Int);
        let integers: Vec<ExprId> = match &tree[id].kind {
            ExprKind::Index { index, .. } => vec![*index],
            ExprKind::BuiltIn { function, arguments } if function.is_texture() => {
                arguments.iter().copied().filter(is_offset).collect()
            }
            _ => return,
        };
        for integer in integers {
            if tree[integer].constant {
                self.fixed.extend(tree.postorder(integer));
            }
        }
    }

    /// Adds the uses that an expression is within and its user is not.
    fn find_uses(&mut self, id: ExprId) {
        let span = self.span(id);
        let outer = self.parents.get(&id).map(|&parent| self.span(parent));
        let mut innermost = self.innermost(span);
        while let Some(at) = innermost
            && !outer.is_some_and(|outer| contains(self.uses[at].span, outer))
        {
            self.found.push((self.without_conversion(id), at));
            innermost = self.uses[at].outer;
        }
    }

    fn span(&self, id: ExprId) -> Span {
        self.source.without_parentheses(self.tree[id].at.span)
    }

    /// The smallest use that contains a span.
    fn innermost(&self, span: Span) -> Option<usize> {
        let after = self.uses.partition_point(|used| used.span.start <= span.start);
        let mut at = after.checked_sub(1)?;
        while !contains(self.uses[at].span, span) {
            at = self.uses[at].outer?;
        }
        Some(at)
    }

    /// The operand of an implicit conversion, which belongs to the place of the use.
    fn without_conversion(&self, mut id: ExprId) -> ExprId {
        while let ExprKind::Construct { arguments, .. } = &self.tree[id].kind
            && let [only] = arguments[..]
            && self.tree[only].at == self.tree[id].at
        {
            id = only;
        }
        id
    }
}
