//! Prints statements, one per line.

use std::collections::HashMap;

use toyproof_glsl::tree::{
    Arm, Block, Case, Condition, ExprId, ExprKind, Label, Scalar, Statement, StatementKind, Type, VariableId,
    VariableKind, walk,
};

use super::Unprintable;
use super::expression::level;
use super::language::Language;
use super::writer::{PrintResult, Writer};
use crate::lower::{has_inner_jump, is_written_first};

impl Writer<'_> {
    /// Prints the statements of a block and the comments in it; the line printed last is its head.
    pub(super) fn statements(&mut self, block: &[Statement]) -> PrintResult {
        let Some(first) = block.first() else {
            return Ok(());
        };
        let (outer, comment) = self.comments.enter(first.at);
        self.trailing_comment(comment);
        self.each_statement(block)?;
        let comments = self.comments.leave(outer);
        self.comment_lines(&comments);
        Ok(())
    }

    fn each_statement(&mut self, block: &[Statement]) -> PrintResult {
        for (number, statement) in block.iter().enumerate() {
            // Structures are printed at global scope.
            if matches!(statement.kind, StatementKind::Struct(_)) {
                continue;
            }
            self.check_deadline()?;
            let next = block.get(number + 1).map(|next| next.at);
            let name = walk::declared(statement).and_then(|variable| self.cx.tree[variable].at);
            let comments = self.comments.before(statement.at, name);
            // The blank line above the first statement belongs to nothing.
            let skipped = usize::from(number == 0 && comments.first().is_some_and(String::is_empty));
            self.comment_lines(&comments[skipped..]);
            self.statement(statement, &block[number + 1..])?;
            let comment = if statement.kind.is_compound() {
                self.comments.behind_block(statement.at, next)
            } else {
                self.comments.behind(statement.at, name)
            };
            self.trailing_comment(comment);
        }
        Ok(())
    }

    /// Prints a block behind the head of its statement.
    fn block(&mut self, head: &str, block: &Block) -> PrintResult {
        self.line(&format!("{head}{{"));
        self.indented(|writer| writer.statements(block))
    }

    /// Prints a statement; `rest` follows it in its block.
    fn statement(&mut self, statement: &Statement, rest: &[Statement]) -> PrintResult {
        match &statement.kind {
            StatementKind::Struct(_) => return Ok(()),
            StatementKind::Expression(expr) => {
                let code = self.expression(*expr)?;
                self.line(&format!("{code};"));
                return Ok(());
            }
            StatementKind::Declare(variable) => {
                let needs_value = self.cx.tree[*variable].initializer.is_none()
                    && !is_written_first(self.cx, *variable, rest);
                return self.declare(*variable, needs_value);
            }
            StatementKind::Break => self.line("break;"),
            StatementKind::Continue => self.line("continue;"),
            StatementKind::Discard if self.language() == Language::Msl => self.discard_in_metal()?,
            StatementKind::Discard => self.line("discard;"),
            StatementKind::Return(None) => self.line("return;"),
            StatementKind::Return(Some(value)) => {
                let code = self.expression(*value)?;
                self.line(&format!("return {code};"));
            }
            // Lowering adds a scope to a `switch`.
            StatementKind::Block(body) if matches!(&body[..], [only] if matches!(only.kind, StatementKind::Switch { .. })) =>
            {
                self.statements(body)?;
            }
            StatementKind::Block(body) => {
                self.block("", body)?;
                self.line("}");
            }
            StatementKind::If { arms, otherwise } => self.branches(arms, otherwise.as_ref())?,
            StatementKind::Switch { selector, cases } => self.switch(*selector, cases)?,
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                let init = match &init[..] {
                    // Godot's loops declare a variable or begin with nothing.
                    [first, ..]
                        if self.language() == Language::Godot
                            && matches!(first.kind, StatementKind::Expression(_)) =>
                    {
                        self.statements(init)?;
                        String::new()
                    }
                    _ => self.init(init)?,
                };
                let condition = match condition {
                    Some(condition) => format!(" {}", self.loop_condition(*condition)?),
                    None => String::new(),
                };
                let step = match step {
                    Some(step) => format!(" {}", self.steps(*step)?),
                    None => String::new(),
                };
                self.block(&format!("for ({init};{condition};{step}) "), body)?;
                self.line("}");
            }
            StatementKind::While { condition, body } => {
                let condition = self.condition(*condition)?;
                self.block(&format!("while ({condition}) "), body)?;
                self.line("}");
            }
            StatementKind::DoWhile { body, condition } => {
                self.block("do ", body)?;
                let condition = self.expression(*condition)?;
                self.line(&format!("}} while ({condition});"));
            }
        }
        Ok(())
    }

    /// The step of a `for`, which may be several.
    fn steps(&mut self, step: ExprId) -> PrintResult<String> {
        let mut steps = Vec::new();
        let mut pending = vec![step];
        while let Some(step) = pending.pop() {
            match self.cx.tree[step].kind {
                ExprKind::Sequence { first, second } => pending.extend([second, first]),
                _ => steps.push(self.operand(step, level::ASSIGN)?),
            }
        }
        Ok(steps.join(", "))
    }

    /// The condition of a `for`. Godot takes a type at its beginning for a declaration.
    fn loop_condition(&mut self, condition: Condition) -> PrintResult<String> {
        let code = self.condition(condition)?;
        let first = code.split('(').next().unwrap_or_default();
        let is_type = self.language() == Language::Godot && !first.is_empty() && self.is_reserved(first);
        Ok(if is_type { format!("({code})") } else { code })
    }

    fn condition(&mut self, condition: Condition) -> PrintResult<String> {
        match condition {
            // Slang refuses an assignment that is a condition without parentheses.
            Condition::Expression(condition) if self.language() == Language::Hlsl => {
                self.operand(condition, level::CONDITIONAL)
            }
            Condition::Expression(condition) => self.expression(condition),
            Condition::Declare(_) => Err(Unprintable::Construct("a declaration in a condition")),
        }
    }

    /// Declares a local variable. The elements of a large array are set to zero by a loop.
    fn declare(&mut self, id: VariableId, needs_value: bool) -> PrintResult {
        /// Maximum number of elements in a list of zeros.
        const MAX_ZEROS: u64 = 16;
        let large = match self.cx.tree[id].ty {
            Type::Array(array) if needs_value && !self.language().has_array_values() => {
                Some(self.cx.tree.array(array))
            }
            _ => None,
        };
        let ty = self.cx.tree[id].ty;
        // Only HLSL has a short form of a zero structure.
        let is_long = |element| self.language() != Language::Hlsl && matches!(element, Type::Struct(_));
        let large = large.filter(|array| self.element_count(ty) > MAX_ZEROS || is_long(array.element));
        let code = self.declaration(id, needs_value && large.is_none())?;
        self.line(&format!("{code};"));
        if let Some(array) = large {
            let index = self.free("index");
            let zero = match array.element {
                Type::Array(_) => {
                    return Err(Unprintable::Construct("a large array of arrays without values"));
                }
                element => self.zero(element)?,
            };
            let size = array.size;
            self.line(&format!("for (int {index} = 0; {index} < {size}; {index}++) {{"));
            let name = self.variable(id);
            self.indented(|writer| {
                writer.line(&format!("{name}[{index}] = {zero};"));
                Ok(())
            })?;
            self.line("}");
        }
        Ok(())
    }

    /// `float a = 1.0`; without an initial value, zero if it needs one.
    fn declaration(&mut self, id: VariableId, needs_value: bool) -> PrintResult<String> {
        let variable = &self.cx.tree[id];
        let declared = self.declarator(variable.ty, self.variable(id))?;
        let is_constant = variable.kind == VariableKind::Const;
        let word = match variable.ty {
            // Arrays of constants are not copied to the stack in each call.
            Type::Array(_)
                if is_constant && variable.value.is_some() && self.language() == Language::Hlsl =>
            {
                "static const "
            }
            _ if is_constant => "const ",
            _ => "",
        };
        let value = match variable.initializer {
            Some(value) => self.initializer(value)?,
            None if needs_value => self.zero(variable.ty)?,
            None => return Ok(declared),
        };
        Ok(format!("{word}{declared} = {value}"))
    }

    /// `int i = 0, j = 1`: all variables share a type.
    fn init(&mut self, init: &Block) -> PrintResult<String> {
        let mut parts = Vec::new();
        for statement in init {
            let part = match statement.kind {
                StatementKind::Declare(variable) if matches!(self.cx.tree[variable].ty, Type::Array(_)) => {
                    return Err(Unprintable::Construct("an array in a loop's head"));
                }
                StatementKind::Declare(variable) if parts.is_empty() => self.declaration(variable, true)?,
                StatementKind::Declare(variable) => {
                    let declared = self.declaration(variable, true)?;
                    let declared = declared.strip_prefix("const ").unwrap_or(&declared);
                    let ty = self.type_name(self.cx.tree[variable].ty)?;
                    declared.strip_prefix(&ty).unwrap_or(declared).trim().to_owned()
                }
                StatementKind::Expression(expr) => self.expression(expr)?,
                _ => return Err(Unprintable::Construct("this statement in a loop's head")),
            };
            parts.push(part);
        }
        Ok(parts.join(", "))
    }

    fn branches(&mut self, arms: &[Arm], otherwise: Option<&Block>) -> PrintResult {
        let mut head = "if";
        for arm in arms {
            let condition = self.expression(arm.condition)?;
            self.block(&format!("{head} ({condition}) "), &arm.body)?;
            head = "} else if";
        }
        if let Some(body) = otherwise {
            self.block("} else ", body)?;
        }
        self.line("}");
        Ok(())
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case]) -> PrintResult {
        let is_unsigned = self.cx.tree[selector].ty.scalar() == Some(Scalar::Uint);
        let selector = self.expression(selector)?;
        self.check_scopes(cases)?;
        if self.language() == Language::Godot && cases.iter().any(has_inner_jump) {
            return Err(Unprintable::Construct(
                "a `switch` with both `continue` and `break` inside blocks",
            ));
        }
        self.line(&format!("switch ({selector}) {{"));
        let Some(first) = cases.first() else {
            self.line("}");
            return Ok(());
        };
        let (outer, comment) = self.comments.enter(first.at);
        self.trailing_comment(comment);
        self.indent += 1;
        for case in cases {
            let comments = self.comments.before(case.at, None);
            self.comment_lines(&comments);
            for label in &case.labels {
                let label = match *label {
                    Label::Default => "default:".to_owned(),
                    Label::Case { value, .. } if is_unsigned => format!("case {value}u:"),
                    Label::Case { value, .. } => format!("case {}:", value.cast_signed()),
                };
                self.line(&label);
            }
            // C++ and DXC do not jump over declarations to a label.
            let declares = case
                .body
                .iter()
                .any(|statement| walk::declared(statement).is_some());
            if declares {
                self.out.pop();
                self.out += " {\n";
                self.indented(|writer| writer.statements(&case.body))?;
                self.line("}");
            } else {
                self.indented(|writer| writer.statements(&case.body))?;
            }
        }
        let comments = self.comments.leave(outer);
        self.comment_lines(&comments);
        self.indent -= 1;
        self.line("}");
        Ok(())
    }

    /// Checks that no case uses a variable that another case declares.
    fn check_scopes(&self, cases: &[Case]) -> PrintResult {
        let tree = &self.cx.tree;
        let declared = cases.iter().enumerate().flat_map(|(number, case)| {
            let variables = case.body.iter().filter_map(walk::declared);
            variables.map(move |variable| (variable, number))
        });
        let declared: HashMap<VariableId, usize> = declared.collect();
        if declared.is_empty() {
            return Ok(());
        }
        for (number, case) in cases.iter().enumerate() {
            let roots = walk::roots(tree, &case.body).into_iter();
            for id in roots.flat_map(|root| tree.postorder(root)) {
                if let ExprKind::Variable(variable) = tree[id].kind
                    && declared.get(&variable).is_some_and(|&other| other != number)
                {
                    return Err(Unprintable::Construct("a variable that several cases share"));
                }
            }
        }
        Ok(())
    }
}
