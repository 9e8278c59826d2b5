//! Prints statements, one per line.

use toyproof_glsl::tree::{
    Arm, Block, Case, Condition, ExprId, ExprKind, Label, Place, Scalar, Statement, StatementKind, Tree,
    Type, VariableId, VariableKind, walk,
};

use super::Unprintable;
use super::writer::Writer;
use crate::author::OuterBlock;
use crate::lower::unwrap_jump;

type PrintResult = Result<(), Unprintable>;

impl Writer<'_> {
    /// Prints the statements of a block and the comments in it; the line printed last is its head.
    pub(super) fn statements(&mut self, block: &Block) -> PrintResult {
        let Some(first) = block.first() else {
            return Ok(());
        };
        let outer = self.enter(first.at);
        self.each_statement(block)?;
        self.leave(outer);
        Ok(())
    }

    /// Enters a block behind its head; prints the comment there.
    fn enter(&mut self, inside: Place) -> OuterBlock {
        let (outer, comment) = self.comments.enter(inside);
        let last_line = self.out.trim_end().rfind('\n').map_or(0, |end| end + 1);
        self.trailing_comment(comment, last_line);
        outer
    }

    /// Leaves a block; prints the comments at its end.
    fn leave(&mut self, outer: OuterBlock) {
        let comments = self.comments.leave(outer);
        self.comment_lines(&comments);
    }

    fn each_statement(&mut self, block: &Block) -> PrintResult {
        for (number, statement) in block.iter().enumerate() {
            if matches!(statement.kind, StatementKind::Struct(_)) {
                continue;
            }
            self.check_deadline()?;
            let next = block.get(number + 1).map(|next| next.at);
            let name = walk::declared(statement).and_then(|variable| self.cx.tree[variable].at);
            let comments = self.comments.before(statement.at, name);
            // The blank line above the first statement belongs to nothing.
            let skipped = usize::from(number == 0 && comments.first().is_some_and(String::is_empty));
            let begin = self.out.len();
            self.comment_lines(&comments[skipped..]);
            let from = self.out.len();
            self.statement(statement)?;
            if self.out.len() == from {
                // Without a statement, a blank line is not needed.
                if comments.iter().all(String::is_empty) {
                    self.out.truncate(begin);
                }
            } else if statement.kind.is_compound() {
                let comment = self.comments.behind_block(statement.at, next);
                let last_line = self.out.trim_end().rfind('\n').map_or(0, |end| end + 1);
                self.trailing_comment(comment, last_line);
            } else {
                let comment = self.comments.behind(statement.at, name);
                self.trailing_comment(comment, from);
            }
        }
        Ok(())
    }

    pub(super) fn block(&mut self, block: &Block) -> PrintResult {
        self.indented(|writer| writer.statements(block))
    }

    fn statement(&mut self, statement: &Statement) -> PrintResult {
        match &statement.kind {
            StatementKind::Expression(expr) => self.with_deferred_steps(*expr, |writer| writer.effect(*expr)),
            StatementKind::Declare(variable) => self.declare(*variable),
            StatementKind::Struct(_) => Ok(()),
            StatementKind::Block(body) if is_switch(body) => self.statements(body),
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
                    Some(Condition::Declare(_)) => {
                        return Err(Unprintable::Construct("a declaration in a condition"));
                    }
                    None => None,
                };
                self.for_loop(init, condition, *step, body)
            }
            StatementKind::While { condition, body } => match *condition {
                Condition::Expression(condition) => self.while_loop(condition, body),
                Condition::Declare(_) => Err(Unprintable::Construct("a declaration in a condition")),
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
                if self.cx.tree[*value].ty == Type::Void {
                    self.effect(*value)?;
                    self.line("return;");
                    return Ok(());
                }
                self.return_value(*value)
            }
        }
    }

    /// Prints `let a = 1.0;`, or `var` for variables that are written later.
    pub(super) fn declaration(&mut self, id: VariableId) -> Result<String, Unprintable> {
        let variable = &self.cx.tree[id];
        let name = self.variable(id);
        let Some(initializer) = variable.initializer else {
            return Ok(format!("var {name}: {};", self.type_name(variable.ty)));
        };
        let value = self.value(initializer)?.code;
        let word = if self.facts.is_memory(id) { "var" } else { "let" };
        if variable.kind == VariableKind::Const && variable.value.is_some() && is_constant(self, initializer)
        {
            return Ok(self.typed_declaration("const", name, variable.ty, &value));
        }
        Ok(format!("{word} {name} = {value};"))
    }

    /// Prints a declaration with its type, unless a constructor implies it: a literal alone would not.
    pub(super) fn typed_declaration(&self, word: &str, name: &str, ty: Type, value: &str) -> String {
        let ty = self.type_name(ty);
        let implies_type = value.strip_prefix(&ty).is_some_and(|rest| rest.starts_with('('));
        if implies_type {
            format!("{word} {name} = {value};")
        } else {
            format!("{word} {name}: {ty} = {value};")
        }
    }

    fn declare(&mut self, id: VariableId) -> PrintResult {
        let name = self.variable(id);
        let Some(initializer) = self.cx.tree[id].initializer else {
            let text = self.declaration(id)?;
            self.line(&text);
            return Ok(());
        };
        // The initializer may use another variable of that name, which the declaration would shadow.
        let is_shadowed = walk::any(&self.cx.tree, initializer, |kind| match kind {
            ExprKind::Variable(other) => self.variable(*other) == name,
            _ => false,
        });
        if !is_shadowed && self.branch_operands(initializer).is_some() {
            let ty = self.type_name(self.cx.tree[id].ty);
            self.line(&format!("var {name}: {ty};"));
            return self.with_deferred_steps(initializer, |writer| writer.assign_value(name, initializer));
        }
        let print = |writer: &mut Self| {
            let text = writer.declaration(id)?;
            writer.line(&text);
            Ok(())
        };
        if is_shadowed {
            print(self)
        } else {
            self.with_deferred_steps(initializer, print)
        }
    }

    fn branches(&mut self, arms: &[Arm], otherwise: Option<&Block>) -> PrintResult {
        let mut depth = 0;
        for (at, arm) in arms.iter().enumerate() {
            if at > 0 && self.hoists(arm.condition) {
                // The side effects of the condition only happen if the previous conditions failed.
                self.line("} else {");
                self.indent += 1;
                depth += 1;
                let condition = self.value(arm.condition)?;
                self.line(&format!("if {} {{", condition.code));
            } else {
                let condition = self.value(arm.condition)?;
                let word = if at == 0 { "if" } else { "} else if" };
                self.line(&format!("{word} {} {{", condition.code));
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

    fn case(&mut self, head: &str, body: &Block) -> PrintResult {
        let from = self.out.len();
        self.line(&format!("{head}: {{"));
        let inner = self.out.len();
        self.block(body)?;
        if self.out.len() == inner {
            self.out.truncate(from);
            self.line(&format!("{head}: {{}}"));
        } else {
            self.line("}");
        }
        Ok(())
    }

    /// Whether a label is a named constant or an expression of such.
    fn is_named(&self, label: ExprId) -> bool {
        let names_something = walk::any(&self.cx.tree, label, |kind| matches!(kind, ExprKind::Variable(_)));
        names_something && is_constant(self, label)
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case]) -> PrintResult {
        let unsigned = self.cx.tree[selector].ty.scalar() == Some(Scalar::Uint);
        let selector = self.value(selector)?;
        self.line(&format!("switch {} {{", selector.code));
        let outer = cases.first().map(|first| self.enter(first.at));
        self.indent += 1;
        let mut has_default = false;
        for case in cases {
            let comments = self.comments.before(case.at, None);
            self.comment_lines(&comments);
            let labels: Vec<String> = case
                .labels
                .iter()
                .map(|label| match *label {
                    Label::Default => {
                        has_default = true;
                        "default".to_owned()
                    }
                    Label::Case { expr, .. } if self.is_named(expr) => match self.value(expr) {
                        Ok(text) => text.code,
                        Err(_) => String::new(),
                    },
                    Label::Case { value, .. } if unsigned => format!("{value}u"),
                    Label::Case { value, .. } => value.cast_signed().to_string(),
                })
                .collect();
            let head = match labels.as_slice() {
                [one] if one == "default" => "default".to_owned(),
                _ => format!("case {}", labels.join(", ")),
            };
            self.case(&head, &body_of(&self.cx.tree, case))?;
        }
        if !has_default {
            self.line("default: {}");
        }
        if let Some(outer) = outer {
            self.leave(outer);
        }
        self.indent -= 1;
        self.line("}");
        Ok(())
    }

    /// Whether control may reach the end of a block, according to WGSL's behavior analysis (§9.7).
    pub(super) fn may_complete(&self, block: &Block) -> bool {
        !block.iter().any(|statement| self.never_completes(statement))
    }

    fn never_completes(&self, statement: &Statement) -> bool {
        match &statement.kind {
            StatementKind::Return(_) => true,
            StatementKind::Block(body) => !self.may_complete(body),
            StatementKind::If {
                arms,
                otherwise: Some(otherwise),
            } => !self.may_complete(otherwise) && arms.iter().all(|arm| !self.may_complete(&arm.body)),
            StatementKind::Switch { cases, .. } => {
                let has_default = cases.iter().any(|case| case.labels.contains(&Label::Default));
                has_default
                    && cases.iter().all(|case| {
                        let body = body_of(&self.cx.tree, case);
                        !self.may_complete(&body) && !has_break(&body)
                    })
            }
            _ => false,
        }
    }
}

/// Whether a block only adds a scope to a lowered `switch`.
fn is_switch(block: &Block) -> bool {
    matches!(block.as_slice(), [only] if matches!(only.kind, StatementKind::Switch { .. }))
}

/// The body of a case, which ends by itself in WGSL.
fn body_of(tree: &Tree, case: &Case) -> Block {
    let mut body = case.body.clone();
    unwrap_jump(tree, &mut body);
    body.pop_if(|last| matches!(last.kind, StatementKind::Break));
    body
}

/// Whether a block contains a `break` that leaves it.
pub(super) fn has_break(block: &Block) -> bool {
    block.iter().any(|statement| match &statement.kind {
        StatementKind::Break => true,
        StatementKind::For { .. }
        | StatementKind::While { .. }
        | StatementKind::DoWhile { .. }
        | StatementKind::Switch { .. } => false,
        _ => walk::child_blocks(statement).into_iter().any(has_break),
    })
}

/// Whether WGSL also treats an initializer as constant: literals, operators and constants, but no calls and
/// no arrays.
fn is_constant(writer: &Writer<'_>, id: ExprId) -> bool {
    let tree = &writer.cx.tree;
    !walk::any(tree, id, |kind| match kind {
        ExprKind::Literal(_)
        | ExprKind::Unary { .. }
        | ExprKind::Binary { .. }
        | ExprKind::Swizzle { .. }
        | ExprKind::Construct { .. } => false,
        // A constant that depends on a computed one is printed with `let`.
        ExprKind::Variable(variable) => {
            let variable = &tree[*variable];
            variable.kind != VariableKind::Const
                || variable.value.is_none()
                || variable
                    .initializer
                    .is_none_or(|value| !is_constant(writer, value))
        }
        _ => true,
    }) && matches!(tree[id].ty, Type::Scalar(_) | Type::Vector(..))
}
