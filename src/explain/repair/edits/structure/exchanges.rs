//! Exchanged variables and values.

use std::collections::BTreeMap;

use toyproof_diagnostic::{Edit, Span};
use toyproof_glsl::tree::{ExprKind, Type, VariableId, VariableKind};

use super::super::super::edit::{EditKind, shortened};
use super::super::super::shader::Shape;
use super::{Writer, replacement};

/// The cost of an exchange.
const EXCHANGE: u32 = 22;

/// The largest number of statements between two whose values are exchanged.
const MAX_DISTANCE: usize = 4;

impl Writer<'_> {
    /// Exchanges two variables in a statement, replaces one everywhere in it, and exchanges the values of two
    /// statements.
    pub(super) fn exchanges(&mut self, at: usize) {
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
}
