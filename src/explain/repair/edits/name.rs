//! Edits of names: another variable of the type, other components of a vector, another member or element.

use toyproof_glsl::tree::{ExprId, ExprKind, Swizzle, Type};

use super::super::edit::EditKind;
use super::super::term::{Term, TermKind};
use super::{Writer, is_input};

/// The costs: another name, an input of the frame instead of a name, and other components.
const OTHER: u32 = 12;
const INPUT: u32 = 20;
const COMPONENT: u32 = 11;

impl Writer<'_> {
    pub(super) fn name(&mut self, site: usize) {
        let tree = self.tree;
        let shader = self.shader;
        let expr = shader.sites[site].exprs[0];
        let statement = shader.sites[site].statement;
        // The whole path `hit.normal` is one name.
        let is_path_of =
            |user: ExprId| matches!(tree[user].kind, ExprKind::Member { structure, .. } if structure == expr);
        match &tree[expr].kind {
            ExprKind::Variable(_) | ExprKind::Member { .. } => {
                let ty = tree[expr].ty;
                if shader.sites[site].user.is_none_or(|user| !is_path_of(user))
                    || matches!(ty, Type::Struct(_))
                {
                    let old = shader.text(tree[expr].at.span);
                    for value in self.values(statement, ty) {
                        if value.text(tree, shader.source, 0) != old {
                            let cost = if is_input(tree, &value) { INPUT } else { OTHER };
                            self.replace(site, EditKind::Variable, cost, value);
                        }
                    }
                }
            }
            &ExprKind::Swizzle { vector, components } => self.components(site, vector, components),
            _ => {}
        }
    }

    /// Selects other components of a vector: one is changed, or two are exchanged.
    fn components(&mut self, site: usize, vector: ExprId, old: Swizzle) {
        let tree = self.tree;
        let ty = tree[self.shader.sites[site].exprs[0]].ty;
        let Type::Vector(_, size) = tree[vector].ty else {
            return;
        };
        let old = old.components();
        let mut all: Vec<Vec<u8>> = Vec::new();
        for at in 0..old.len() {
            for component in 0..size {
                let mut new = old.to_vec();
                new[at] = component;
                all.push(new);
            }
            for other in at + 1..old.len() {
                let mut new = old.to_vec();
                new.swap(at, other);
                all.push(new);
            }
        }
        // Rotations, such as yzx for xyz.
        for by in 1..old.len() {
            let mut new = old.to_vec();
            new.rotate_left(by);
            all.push(new);
        }
        let mut tried = vec![old.to_vec()];
        for new in all {
            if let Some(swizzle) = Swizzle::new(&new)
                && !tried.contains(&new)
            {
                let vector = Box::new(Term::keep(tree, vector));
                self.replace(
                    site,
                    EditKind::Component,
                    COMPONENT,
                    Term::new(TermKind::Swizzle(vector, swizzle), ty),
                );
                tried.push(new);
            }
        }
    }
}
