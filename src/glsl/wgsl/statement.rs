//! Statements, one to a line.

use super::super::lower::walk;
use super::super::tree::{
    Arm, Block, Case, Condition, ExprId, ExprKind, Label, Scalar, Statement, StatementKind, Type, VariableId,
    VariableKind,
};
use super::Unprintable;
use super::writer::Writer;

type Done = Result<(), Unprintable>;

impl Writer<'_> {
    pub(super) fn statements(&mut self, block: &Block) -> Done {
        for statement in block {
            if !matches!(statement.kind, StatementKind::Struct(_)) {
                self.comment(statement.at);
            }
            self.statement(statement)?;
        }
        Ok(())
    }

    fn block(&mut self, block: &Block) -> Done {
        self.inset(|writer| writer.statements(block))
    }

    fn statement(&mut self, statement: &Statement) -> Done {
        match &statement.kind {
            StatementKind::Expression(expr) => self.effect(*expr),
            StatementKind::Declare(variable) => {
                let text = self.declaration(*variable)?;
                self.line(&text);
                Ok(())
            }
            StatementKind::Struct(_) => Ok(()),
            StatementKind::Block(body) => {
                self.line("{");
                self.block(body)?;
                self.line("}");
                Ok(())
            }
            StatementKind::If { arms, otherwise } => self.branches(arms, otherwise.as_ref()),
            StatementKind::Switch { selector, cases } => self.switch(*selector, cases),
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                let condition = match condition {
                    Some(Condition::Expression(condition)) => Some(*condition),
                    Some(Condition::Declare(_)) => return Err(Unprintable("a declaration as a condition")),
                    None => None,
                };
                self.for_loop(init, condition, *step, body)
            }
            StatementKind::While { condition, body } => match *condition {
                Condition::Expression(condition) => self.while_loop(condition, body),
                Condition::Declare(_) => Err(Unprintable("a declaration as a condition")),
            },
            StatementKind::DoWhile { body, condition } => self.do_while(body, *condition),
            StatementKind::Break => {
                self.line("break;");
                Ok(())
            }
            StatementKind::Continue => {
                self.line("continue;");
                Ok(())
            }
            StatementKind::Discard => {
                self.line("discard;");
                Ok(())
            }
            StatementKind::Return(None) => {
                self.line("return;");
                Ok(())
            }
            StatementKind::Return(Some(value)) => {
                if self.draft.tree[*value].ty == Type::Void {
                    self.effect(*value)?;
                    self.line("return;");
                    return Ok(());
                }
                let value = self.value(*value)?;
                self.line(&format!("return {};", value.words));
                Ok(())
            }
        }
    }

    /// `let a = 1.0;`, or `var` for what is written later.
    pub(super) fn declaration(&mut self, id: VariableId) -> Result<String, Unprintable> {
        let variable = &self.draft.tree[id];
        let name = self.variable(id);
        let ty = self.type_name(variable.ty);
        let Some(initialiser) = variable.initialiser else {
            return Ok(format!("var {name}: {ty};"));
        };
        let value = self.value(initialiser)?.words;
        let word = if self.facts.is_memory(id) { "var" } else { "let" };
        if variable.kind == VariableKind::Const && variable.value.is_some() && is_constant(self, initialiser)
        {
            return Ok(format!("const {name}: {ty} = {value};"));
        }
        Ok(format!("{word} {name} = {value};"))
    }

    fn branches(&mut self, arms: &[Arm], otherwise: Option<&Block>) -> Done {
        let mut depth = 0;
        for (at, arm) in arms.iter().enumerate() {
            if at > 0 && self.hoists(arm.condition) {
                // What the condition does is done only where the others did not hold.
                self.line("} else {");
                self.indent += 1;
                depth += 1;
                let condition = self.value(arm.condition)?;
                self.line(&format!("if {} {{", condition.words));
            } else {
                let condition = self.value(arm.condition)?;
                let word = if at == 0 { "if" } else { "} else if" };
                self.line(&format!("{word} {} {{", condition.words));
            }
            self.block(&arm.body)?;
        }
        if let Some(body) = otherwise {
            self.line("} else {");
            self.block(body)?;
        }
        self.line("}");
        for _ in 0..depth {
            self.indent -= 1;
            self.line("}");
        }
        Ok(())
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case]) -> Done {
        let unsigned = self.draft.tree[selector].ty.scalar() == Some(Scalar::Uint);
        let selector = self.value(selector)?;
        self.line(&format!("switch {} {{", selector.words));
        self.indent += 1;
        let mut has_default = false;
        for case in cases {
            let labels: Vec<String> = case
                .labels
                .iter()
                .map(|label| match *label {
                    Label::Default => {
                        has_default = true;
                        "default".to_owned()
                    }
                    Label::Case { value, .. } if unsigned => format!("{value}u"),
                    Label::Case { value, .. } => value.cast_signed().to_string(),
                })
                .collect();
            let head = match labels.as_slice() {
                [one] if one == "default" => "default".to_owned(),
                _ => format!("case {}", labels.join(", ")),
            };
            self.line(&format!("{head}: {{"));
            // Each case ends by itself.
            let body = match case.body.split_last() {
                Some((last, rest)) if matches!(last.kind, StatementKind::Break) => rest,
                _ => &case.body,
            };
            self.block(&body.to_vec())?;
            self.line("}");
        }
        if !has_default {
            self.line("default: {}");
        }
        self.indent -= 1;
        self.line("}");
        Ok(())
    }

    fn for_loop(
        &mut self,
        init: &Block,
        condition: Option<ExprId>,
        step: Option<ExprId>,
        body: &Block,
    ) -> Done {
        let is_plain_init = match init.as_slice() {
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
        };
        let is_plain = is_plain_init
            && condition.is_none_or(|condition| !self.hoists(condition))
            && step.is_none_or(|step| self.is_single(step));
        if is_plain {
            let init = match init.first().map(|statement| &statement.kind) {
                Some(StatementKind::Declare(variable)) => self.counter(*variable)?,
                Some(StatementKind::Expression(expr)) => self.single(*expr)?,
                _ => String::new(),
            };
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
            let head = if init.is_empty() && step.is_empty() {
                if condition.is_empty() {
                    "loop {".to_owned()
                } else {
                    format!("while {condition} {{")
                }
            } else {
                format!("for ({init}; {condition}; {step}) {{")
            };
            self.line(&head);
            self.block(body)?;
            self.line("}");
            return Ok(());
        }
        let scoped = init
            .iter()
            .any(|statement| matches!(statement.kind, StatementKind::Declare(_)));
        if scoped {
            self.line("{");
            self.indent += 1;
        }
        for statement in init {
            match statement.kind {
                StatementKind::Declare(variable) => {
                    let text = self.counter(variable)?;
                    self.line(&text);
                }
                _ => self.statement(statement)?,
            }
        }
        self.line("loop {");
        self.inset(|writer| {
            if let Some(condition) = condition {
                writer.leave_unless(condition)?;
            }
            match step {
                None => writer.statements(body),
                Some(step) => {
                    // A scope of its own, so that the step does not see what the body declares.
                    writer.line("{");
                    writer.block(body)?;
                    writer.line("}");
                    writer.line("continuing {");
                    writer.inset(|writer| writer.effect(step))?;
                    writer.line("}");
                    Ok(())
                }
            }
        })?;
        self.line("}");
        if scoped {
            self.indent -= 1;
            self.line("}");
        }
        Ok(())
    }

    /// A declaration in a loop's head, which is a `var`.
    fn counter(&mut self, id: VariableId) -> Result<String, Unprintable> {
        let text = self.declaration(id)?;
        Ok(match text.strip_prefix("let ") {
            Some(rest) => format!("var {rest}"),
            None => text,
        })
    }

    fn while_loop(&mut self, condition: ExprId, body: &Block) -> Done {
        if self.hoists(condition) {
            self.line("loop {");
            self.inset(|writer| {
                writer.leave_unless(condition)?;
                writer.statements(body)
            })?;
        } else {
            let condition = self.value(condition)?;
            self.line(&format!("while {} {{", condition.words));
            self.block(body)?;
        }
        self.line("}");
        Ok(())
    }

    fn do_while(&mut self, body: &Block, condition: ExprId) -> Done {
        self.line("loop {");
        self.inset(|writer| {
            writer.line("{");
            writer.block(body)?;
            writer.line("}");
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

    fn leave_unless(&mut self, condition: ExprId) -> Done {
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

    /// Whether a block may come to its end, as WGSL's analysis of behaviours sees it (§9.7).
    pub(super) fn may_end(block: &Block) -> bool {
        !block.iter().any(Self::never_ends)
    }

    fn never_ends(statement: &Statement) -> bool {
        match &statement.kind {
            StatementKind::Return(_) => true,
            StatementKind::Block(body) => !Self::may_end(body),
            StatementKind::If {
                arms,
                otherwise: Some(otherwise),
            } => !Self::may_end(otherwise) && arms.iter().all(|arm| !Self::may_end(&arm.body)),
            StatementKind::Switch { cases, .. } => {
                let has_default = cases.iter().any(|case| case.labels.contains(&Label::Default));
                has_default
                    && cases
                        .iter()
                        .all(|case| !Self::may_end(&case.body) && !leaves(&case.body))
            }
            _ => false,
        }
    }
}

/// Whether a `break` of the block's own stands in it.
fn leaves(block: &Block) -> bool {
    block.iter().any(|statement| match &statement.kind {
        StatementKind::Break => true,
        StatementKind::For { .. }
        | StatementKind::While { .. }
        | StatementKind::DoWhile { .. }
        | StatementKind::Switch { .. } => false,
        _ => walk::inner(statement).into_iter().any(leaves),
    })
}

/// Whether WGSL, too, takes an initialiser for constant: numbers, operators and constants, no calls, no arrays.
fn is_constant(writer: &Writer<'_>, id: ExprId) -> bool {
    let tree = &writer.draft.tree;
    !walk::any(tree, id, |kind| match kind {
        ExprKind::Literal(_)
        | ExprKind::Unary { .. }
        | ExprKind::Binary { .. }
        | ExprKind::Swizzle { .. }
        | ExprKind::Construct { .. } => false,
        // One of another that is computed by a call is printed with `let`.
        ExprKind::Variable(variable) => {
            let variable = &tree[*variable];
            variable.kind != VariableKind::Const
                || variable.value.is_none()
                || variable
                    .initialiser
                    .is_none_or(|value| !is_constant(writer, value))
        }
        _ => true,
    }) && matches!(tree[id].ty, Type::Scalar(_) | Type::Vector(..))
}
