//! Loops: `for` and `while` where WGSL's say the same, `loop` where the head does what stands in no head.

use toyproof_glsl::tree::{Block, ExprId, ExprKind, Literal, StatementKind, Type, Value, VariableId, walk};

use super::Unprintable;
use super::statement::leaves;
use super::writer::Writer;

type Done = Result<(), Unprintable>;

impl Writer<'_> {
    pub(super) fn for_loop(
        &mut self,
        init: &Block,
        condition: Option<ExprId>,
        step: Option<ExprId>,
        body: &Block,
    ) -> Done {
        if self.is_head(init) {
            let init = match init.first().map(|statement| &statement.kind) {
                Some(StatementKind::Declare(variable)) => self.counter(*variable)?,
                Some(StatementKind::Expression(expr)) => self.single(*expr)?,
                _ => String::new(),
            };
            return self.rounds(&init, condition, step, body);
        }
        // A scope of its own, so that what follows the loop does not see what its head declares.
        self.line("{");
        self.inset(|writer| {
            writer.statements(init)?;
            writer.rounds("", condition, step, body)
        })?;
        self.line("}");
        Ok(())
    }

    /// Whether what a loop begins with may stand in its head.
    fn is_head(&mut self, init: &Block) -> bool {
        match init.as_slice() {
            [] => true,
            [only] => match only.kind {
                StatementKind::Declare(variable) => {
                    let value = self.draft.tree[variable].initialiser;
                    value.is_none_or(|value| !self.hoists(value))
                }
                StatementKind::Expression(expr) => self.is_single(expr),
                _ => false,
            },
            _ => false,
        }
    }

    /// A `for` that begins so.
    fn rounds(&mut self, init: &str, condition: Option<ExprId>, step: Option<ExprId>, body: &Block) -> Done {
        let is_plain = condition.is_none_or(|condition| !self.hoists(condition))
            && step.is_none_or(|step| self.is_single(step));
        if is_plain {
            let condition = match condition {
                Some(condition) => self.value(condition)?.words,
                None => String::new(),
            };
            let step = match step {
                Some(step) => self.single(step)?,
                None => String::new(),
            };
            let init = init.trim_end_matches(';');
            let step = step.trim_end_matches(';');
            self.line(&match (init, condition.as_str(), step) {
                ("", "", "") => "loop {".to_owned(),
                ("", condition, "") => format!("while {condition} {{"),
                _ => format!("for ({init}; {condition}; {step}) {{"),
            });
            self.block(body)?;
            self.line("}");
            return Ok(());
        }
        if !init.is_empty() {
            self.line("{");
            self.indent += 1;
            self.line(init);
        }
        self.line("loop {");
        self.inset(|writer| {
            if let Some(condition) = condition {
                writer.leave_unless(condition)?;
            }
            let Some(step) = step else {
                return writer.statements(body);
            };
            writer.round(body, step)?;
            writer.line("continuing {");
            writer.inset(|writer| writer.effect(step))?;
            writer.line("}");
            Ok(())
        })?;
        self.line("}");
        if !init.is_empty() {
            self.indent -= 1;
            self.line("}");
        }
        Ok(())
    }

    /// What is done in a round, in a scope of its own if that declares a name by which `last`, which is evaluated after it, means something else.
    fn round(&mut self, body: &Block, last: ExprId) -> Done {
        if !self.hides(body, last) {
            return self.statements(body);
        }
        self.line("{");
        self.block(body)?;
        self.line("}");
        Ok(())
    }

    fn hides(&self, body: &Block, last: ExprId) -> bool {
        let tree = &self.draft.tree;
        let declared = body.iter().filter_map(walk::declared);
        let declared: Vec<&str> = declared.map(|id| self.variable(id)).collect();
        walk::any(tree, last, |kind| match kind {
            ExprKind::Variable(id) => declared.contains(&self.variable(*id)),
            ExprKind::Call { function, .. } => declared.contains(&self.function(*function)),
            _ => false,
        })
    }

    /// A declaration in a loop's head, which is a `var`.
    fn counter(&mut self, id: VariableId) -> Result<String, Unprintable> {
        let text = self.declaration(id)?;
        Ok(match text.strip_prefix("let ") {
            Some(rest) => format!("var {rest}"),
            None => text,
        })
    }

    pub(super) fn while_loop(&mut self, condition: ExprId, body: &Block) -> Done {
        if self.hoists(condition) {
            self.line("loop {");
            self.inset(|writer| {
                writer.leave_unless(condition)?;
                writer.statements(body)
            })?;
        } else {
            if self.is_literally(condition, true) && leaves(body) {
                self.line("loop {");
            } else {
                let condition = self.value(condition)?;
                self.line(&format!("while {} {{", condition.words));
            }
            self.block(body)?;
        }
        self.line("}");
        Ok(())
    }

    pub(super) fn do_while(&mut self, body: &Block, condition: ExprId) -> Done {
        self.line("loop {");
        self.inset(|writer| {
            let comes_to_its_end = writer.may_end(body) && !body.last().is_some_and(walk::jumps);
            if comes_to_its_end && !walk::continues(body) && !writer.hides(body, condition) {
                writer.statements(body)?;
                return writer.leave_unless(condition);
            }
            writer.round(body, condition)?;
            writer.line("continuing {");
            writer.inset(|writer| {
                let condition = writer.negated(condition)?;
                writer.line(&format!("break if {condition};"));
                Ok(())
            })?;
            writer.line("}");
            Ok(())
        })?;
        self.line("}");
        Ok(())
    }

    fn is_literally(&self, id: ExprId, value: bool) -> bool {
        matches!(&self.draft.tree[id].kind, ExprKind::Literal(Literal { value: Value::Bool(own), .. }) if *own == value)
    }

    fn leave_unless(&mut self, condition: ExprId) -> Done {
        if self.is_literally(condition, false) {
            self.line("break;");
            return Ok(());
        }
        let condition = self.negated(condition)?;
        self.line(&format!("if {condition} {{"));
        self.inset(|writer| writer.line("break;"));
        self.line("}");
        Ok(())
    }

    /// Whether an expression is one assignment, step or call, and so may stand in a loop's head.
    fn is_single(&mut self, id: ExprId) -> bool {
        let tree = &self.draft.tree;
        match &tree[id].kind {
            &ExprKind::Assign { target, value, .. } => {
                let is_swizzle = matches!(tree[target].kind, ExprKind::Swizzle { components, .. } if components.size() > 1);
                !is_swizzle && !self.hoists(target) && !self.hoists(value)
            }
            &ExprKind::Step { target, .. } => !self.hoists(target),
            ExprKind::Call { .. } => tree[id].ty == Type::Void && !self.hoists(id),
            _ => false,
        }
    }

    /// What such an expression does, as one line without indentation.
    fn single(&mut self, id: ExprId) -> Result<String, Unprintable> {
        let outer = std::mem::take(&mut self.out);
        let done = self.effect(id);
        let text = std::mem::replace(&mut self.out, outer);
        done?;
        Ok(text.trim().to_owned())
    }
}
