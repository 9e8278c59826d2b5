//! Edits of names: another variable of the type, other components of a vector, another member or element.

use toyproof_glsl::tree::{ExprId, ExprKind, Swizzle, Type};

use super::super::edit::EditKind;
use super::super::term::{Op, Term};
use super::writer::{At, Writer, is_input};

/// The costs: another name, an input of the frame instead of a name, and other components.
const OTHER: u32 = 12;
const INPUT: u32 = 20;
const COMPONENT: u32 = 11;

impl Writer<'_> {
    pub(super) fn name(&mut self, at: At) {
        let (tree, source) = (self.tree, self.shader.source);
        match &tree[at.expr].kind {
            ExprKind::Variable(_) | ExprKind::Member { .. } => {
                // The whole path `hit.normal` is one name.
                let is_path_of = |user: ExprId| matches!(tree[user].kind, ExprKind::Member { structure, .. } if structure == at.expr);
                if at.user.is_some_and(is_path_of) && !matches!(at.ty, Type::Struct(_)) {
                    return;
                }
                let old = self.shader.text(tree[at.expr].at.span);
                let others = self.values(at.statement, at.ty).into_iter();
                for value in others.filter(|value| value.text(tree, source, 0) != old) {
                    let cost = if is_input(tree, &value) { INPUT } else { OTHER };
                    self.replace(at, EditKind::Variable, cost, value);
                }
            }
            &ExprKind::Swizzle { vector, components } => self.components(at, vector, components),
            _ => {}
        }
    }

    /// Selects other components of a vector: one is changed, or two are exchanged.
    fn components(&mut self, at: At, vector: ExprId, old: Swizzle) {
        let Type::Vector(_, size) = self.tree[vector].ty else {
            return;
        };
        let old = old.components();
        let with = |change: &dyn Fn(&mut Vec<u8>)| {
            let mut new = old.to_vec();
            change(&mut new);
            new
        };
        let mut all: Vec<Vec<u8>> = Vec::new();
        for index in 0..old.len() {
            all.extend((0..size).map(|component| with(&|new| new[index] = component)));
            all.extend((index + 1..old.len()).map(|other| with(&|new| new.swap(index, other))));
        }
        // Rotations, such as yzx for xyz.
        all.extend((1..old.len()).map(|by| with(&|new| new.rotate_left(by))));
        let mut tried = vec![old.to_vec()];
        for new in all {
            if let Some(swizzle) = Swizzle::new(&new)
                && !tried.contains(&new)
            {
                let term = Term::apply(Op::Swizzle(swizzle), vec![self.keep(vector)], at.ty);
                self.replace(at, EditKind::Component, COMPONENT, term);
                tried.push(new);
            }
        }
    }
}
