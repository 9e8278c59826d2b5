//! Loops: `for` and `while` where WGSL has equivalents, `loop` where a head needs several statements.

use toyproof_glsl::tree::{Block, ExprId, ExprKind, Literal, StatementKind, Type, Value, VariableId, walk};

use super::Unprintable;
use super::statement::has_break;
use super::writer::Writer;

type PrintResult = Result<(), Unprintable>;

impl Writer<'_> {
    pub(super) fn for_loop(
        &mut self,
        init: &Block,
        condition: Option<ExprId>,
        step: Option<ExprId>,
        body: &Block,
    ) -> PrintResult {
        if self.is_head(init) {
            let init = match init.first().map(|statement| &statement.kind) {
                Some(StatementKind::Declare(variable)) => self.loop_variable(*variable)?,
                Some(StatementKind::Expression(expr)) => self.simple_statement(*expr)?,
                _ => String::new(),
            };
            return self.loop_with_init(&init, condition, step, body);
        }
        // A scope of its own keeps the head's declarations from the following statements.
        self.line("{");
        self.indented(|writer| {
            writer.statements(init)?;
            writer.loop_with_init("", condition, step, body)
        })?;
        self.line("}");
        Ok(())
    }

    /// Whether the first statements of a loop fit into its head.
    fn is_head(&mut self, init: &Block) -> bool {
        match init.as_slice() {
            [] => true,
            [only] => match only.kind {
                StatementKind::Declare(variable) => {
                    let value = self.cx.tree[variable].initializer;
                    value.is_none_or(|value| !self.hoists(value))
                }
                StatementKind::Expression(expr) => self.is_simple(expr),
                _ => false,
            },
            _ => false,
        }
    }

    /// Prints a loop whose head begins with `init`.
    fn loop_with_init(
        &mut self,
        init: &str,
        condition: Option<ExprId>,
        step: Option<ExprId>,
        body: &Block,
    ) -> PrintResult {
        let is_plain = condition.is_none_or(|condition| !self.hoists(condition))
            && step.is_none_or(|step| self.is_simple(step));
        if is_plain {
            let condition = match condition {
                Some(condition) => self.value(condition)?.code,
                None => String::new(),
            };
            let step = match step {
                Some(step) => self.simple_statement(step)?,
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
        self.indented(|writer| {
            if let Some(condition) = condition {
                writer.break_unless(condition)?;
            }
            let Some(step) = step else {
                return writer.statements(body);
            };
            writer.loop_body(body, step)?;
            writer.line("continuing {");
            writer.indented(|writer| writer.effect(step))?;
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

    /// Prints a loop's body; in a scope of its own if it shadows a name in `last`, which is evaluated after
    /// it.
    fn loop_body(&mut self, body: &Block, last: ExprId) -> PrintResult {
        if !self.shadows(body, last) {
            return self.statements(body);
        }
        self.line("{");
        self.block(body)?;
        self.line("}");
        Ok(())
    }

    fn shadows(&self, body: &Block, last: ExprId) -> bool {
        let tree = &self.cx.tree;
        let declared = body.iter().filter_map(walk::declared);
        let declared: Vec<&str> = declared.map(|id| self.variable(id)).collect();
        walk::any(tree, last, |kind| match kind {
            ExprKind::Variable(id) => declared.contains(&self.variable(*id)),
            ExprKind::Call { function, .. } => declared.contains(&self.function(*function)),
            _ => false,
        })
    }

    /// Prints the declaration in a loop's head, always as a `var`.
    fn loop_variable(&mut self, id: VariableId) -> Result<String, Unprintable> {
        let text = self.declaration(id)?;
        Ok(match text.strip_prefix("let ") {
            Some(rest) => format!("var {rest}"),
            None => text,
        })
    }

    pub(super) fn while_loop(&mut self, condition: ExprId, body: &Block) -> PrintResult {
        if self.hoists(condition) {
            self.line("loop {");
            self.indented(|writer| {
                writer.break_unless(condition)?;
                writer.statements(body)
            })?;
        } else {
            if self.is_literally(condition, true) && has_break(body) {
                self.line("loop {");
            } else {
                let condition = self.value(condition)?;
                self.line(&format!("while {} {{", condition.code));
            }
            self.block(body)?;
        }
        self.line("}");
        Ok(())
    }

    pub(super) fn do_while(&mut self, body: &Block, condition: ExprId) -> PrintResult {
        self.line("loop {");
        self.indented(|writer| {
            let may_complete = writer.may_complete(body) && !body.last().is_some_and(walk::jumps);
            if may_complete && !walk::continues(body) && !writer.shadows(body, condition) {
                writer.statements(body)?;
                return writer.break_unless(condition);
            }
            writer.loop_body(body, condition)?;
            writer.line("continuing {");
            writer.indented(|writer| {
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
        matches!(&self.cx.tree[id].kind, ExprKind::Literal(Literal { value: Value::Bool(own), .. }) if *own == value)
    }

    fn break_unless(&mut self, condition: ExprId) -> PrintResult {
        if self.is_literally(condition, false) {
            self.line("break;");
            return Ok(());
        }
        let condition = self.negated(condition)?;
        self.line(&format!("if {condition} {{"));
        self.indented(|writer| writer.line("break;"));
        self.line("}");
        Ok(())
    }

    /// Whether an expression is a single assignment, increment or call, which fits into a loop's head.
    fn is_simple(&mut self, id: ExprId) -> bool {
        let tree = &self.cx.tree;
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

    /// Prints such an expression as one line without indentation.
    fn simple_statement(&mut self, id: ExprId) -> Result<String, Unprintable> {
        let outer = std::mem::take(&mut self.out);
        let done = self.effect(id);
        let text = std::mem::replace(&mut self.out, outer);
        done?;
        Ok(text.trim().to_owned())
    }
}
