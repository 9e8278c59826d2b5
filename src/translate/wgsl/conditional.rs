//! `?:`, and `&&` and `||` whose right side does something: WGSL's `select` evaluates both of its sides.

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Type, walk};

use super::Unprintable;
use super::text::{Printed, Text};
use super::writer::Writer;

type Done = Result<(), Unprintable>;

impl Writer<'_> {
    /// The condition and the sides of a `?:` that must be an `if`.
    pub(super) fn branching(&mut self, id: ExprId) -> Option<[ExprId; 3]> {
        let ExprKind::Conditional { condition, yes, no } = self.draft.tree[id].kind else {
            return None;
        };
        let is_selection = self.is_selectable(yes) && self.is_selectable(no);
        (!is_selection).then_some([condition, yes, no])
    }

    /// Such a `?:` as an `if` in which `end` prints what becomes of either side.
    pub(super) fn choose(&mut self, id: ExprId, end: &mut dyn FnMut(&mut Self, ExprId) -> Done) -> Done {
        let mut word = "if";
        let mut rest = id;
        while let Some([condition, yes, no]) = self.branching(rest)
            && (rest == id || !self.hoists(condition))
        {
            let condition = self.value(condition)?;
            self.line(&format!("{word} {} {{", condition.words));
            self.inset(|writer| writer.side(yes, end))?;
            word = "} else if";
            rest = no;
        }
        self.line("} else {");
        self.inset(|writer| writer.side(rest, end))?;
        self.line("}");
        Ok(())
    }

    fn side(&mut self, id: ExprId, end: &mut dyn FnMut(&mut Self, ExprId) -> Done) -> Done {
        if self.branching(id).is_some() {
            self.choose(id, end)
        } else {
            end(self, id)
        }
    }

    /// Sets a variable of that name.
    pub(super) fn give(&mut self, name: &str, id: ExprId) -> Done {
        self.side(id, &mut |writer, id| {
            let value = writer.value(id)?;
            writer.line(&format!("{name} = {};", value.words));
            Ok(())
        })
    }

    /// `return`.
    pub(super) fn give_back(&mut self, id: ExprId) -> Done {
        if let Some([condition, yes, no]) = self.branching(id) {
            let condition = self.value(condition)?;
            self.line(&format!("if {} {{", condition.words));
            self.inset(|writer| writer.give_back(yes))?;
            self.line("}");
            return self.give_back(no);
        }
        let value = self.value(id)?;
        self.line(&format!("return {};", value.words));
        Ok(())
    }

    pub(super) fn conditional(&mut self, id: ExprId) -> Printed {
        if self.branching(id).is_some() {
            let name = self.temporary("chosen");
            let ty = self.type_name(self.draft.tree[id].ty);
            self.line(&format!("var {name}: {ty};"));
            self.give(&name, id)?;
            return Ok(Text::primary(name));
        }
        let ExprKind::Conditional { condition, yes, no } = self.draft.tree[id].kind else {
            return Err(Unprintable("a choice"));
        };
        let acts = walk::acts(&self.draft.tree, condition);
        let condition = self.value(condition)?;
        // The sides stand before the condition, and would be evaluated first.
        let condition = if acts && !(self.is_settled(yes) && self.is_settled(no)) {
            self.keep_as("condition", &condition)
        } else {
            condition
        };
        let [no, yes] = [self.value(no)?, self.value(yes)?];
        Ok(Text::primary(format!(
            "select({})",
            Self::list(vec![no, yes, condition])
        )))
    }

    /// Whether an expression may be evaluated whether or not it is wanted: it is cheap, and does nothing.
    fn is_selectable(&mut self, id: ExprId) -> bool {
        let tree = &self.draft.tree;
        let is_plain = matches!(tree[id].ty, Type::Scalar(_) | Type::Vector(..))
            && !walk::any(tree, id, |kind| match kind {
                ExprKind::Call { .. } => true,
                ExprKind::BuiltIn { function, .. } => function.is_texture(),
                _ => false,
            });
        is_plain && !self.hoists(id)
    }

    /// `&&` and `||` whose right side does something.
    pub(super) fn either(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> Printed {
        let left = self.value(left)?;
        let name = self.temporary("holds");
        self.line(&format!("var {name} = {};", left.words));
        let not = if op == BinaryOp::Or { "!" } else { "" };
        self.line(&format!("if {not}{name} {{"));
        self.inset(|writer| {
            let right = writer.value(right)?;
            writer.line(&format!("{name} = {};", right.words));
            Ok(())
        })?;
        self.line("}");
        Ok(Text::primary(name))
    }
}
