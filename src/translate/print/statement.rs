//! Prints statements and declarations, one per line.

use toyproof_glsl::tree::{
    Arm, Block, Case, Condition, Direction, ExprId, ExprKind, FunctionId, Item, Label, Place, Statement,
    StatementKind, StructId, Tree, Type, UnaryOp, VariableId, VariableKind,
};

use super::Printer;

impl Printer<'_> {
    /// Prints a declaration at global scope.
    pub(super) fn item(&mut self, item: Item) {
        match item {
            Item::Struct(id) => self.structure(id),
            Item::Variable(id) if self.cx.uniform_block.contains(&id) => {}
            Item::Variable(id) => {
                self.declaration(id);
                self.plain(";\n");
            }
            Item::Function(id) => self.definition(id),
            Item::Prototype(_) => {}
        }
    }

    fn structure(&mut self, id: StructId) {
        let tree = &self.cx.tree;
        let name = self.names.structs.get(&id).cloned().unwrap_or_default();
        self.token(&format!("struct {name} "), tree[id].at);
        self.braces(|printer| {
            for (at, member) in tree[id].members.iter().enumerate() {
                let name = printer.names.members.get(&(id, at)).cloned().unwrap_or_default();
                printer.line();
                printer.token(&format!("{} {name};\n", printer.type_name(member.ty)), member.at);
            }
        });
        self.plain(";\n");
    }

    fn definition(&mut self, id: FunctionId) {
        let function = &self.cx.tree[id];
        let at = function.at;
        self.plain("\n");
        self.token(
            &format!("{} {}(", self.type_name(function.return_type), self.function(id)),
            at,
        );
        for (position, &parameter) in function.parameters.iter().enumerate() {
            if position > 0 {
                self.plain(", ");
            }
            let variable = &self.cx.tree[parameter];
            let direction = match variable.kind {
                VariableKind::Parameter(Direction::Out) => "out ",
                VariableKind::Parameter(Direction::InOut) => "inout ",
                _ => "",
            };
            let text = format!(
                "{direction}{} {}",
                self.type_name(variable.ty),
                self.variable(parameter)
            );
            self.token(&text, variable.at.unwrap_or(at));
        }
        self.token(") ", at);
        self.braces(|printer| {
            if let Some(body) = &function.body {
                printer.statements(body);
            } else if let Some(text) = printer.cx.helpers.get(&id) {
                printer.line();
                printer.token(text, at);
                printer.plain("\n");
            }
        });
        self.plain("\n");
    }

    /// `const float a = 1.0`
    fn declaration(&mut self, id: VariableId) {
        let variable = &self.cx.tree[id];
        let constant = if variable.kind == VariableKind::Const {
            "const "
        } else {
            ""
        };
        let text = format!("{constant}{} {}", self.type_name(variable.ty), self.variable(id));
        self.spanned(&text, variable.at.map(|at| at.span));
        if let Some(value) = variable.initializer {
            self.plain(" = ");
            self.argument(value);
        }
    }

    fn statements(&mut self, block: &Block) {
        // Structures are printed at global scope.
        for statement in block
            .iter()
            .filter(|statement| !matches!(statement.kind, StatementKind::Struct(_)))
        {
            self.line();
            self.statement(statement);
            self.plain("\n");
        }
    }

    fn block(&mut self, block: &Block) {
        self.braces(|printer| printer.statements(block));
    }

    fn statement(&mut self, statement: &Statement) {
        let at = statement.at;
        match &statement.kind {
            StatementKind::Expression(expr) => {
                self.effect(*expr);
                self.plain(";");
            }
            StatementKind::Declare(variable) => {
                self.declaration(*variable);
                self.plain(";");
            }
            StatementKind::Struct(_) => {}
            StatementKind::Block(body) => self.block(body),
            StatementKind::If { arms, otherwise } => self.branches(arms, otherwise.as_ref(), at),
            StatementKind::Switch { selector, cases } => self.switch(*selector, cases, at),
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.token("for (", at);
                self.init(init);
                self.plain(";");
                if let Some(Condition::Expression(condition)) = condition {
                    self.plain(" ");
                    self.condition(*condition);
                }
                self.plain(";");
                if let Some(step) = step {
                    self.plain(" ");
                    self.expression(*step);
                }
                self.plain(") ");
                self.block(body);
            }
            StatementKind::While { condition, body } => {
                self.token("while (", at);
                if let Condition::Expression(condition) = condition {
                    self.expression(*condition);
                }
                self.plain(") ");
                self.block(body);
            }
            StatementKind::DoWhile { body, condition } => {
                self.token("do ", at);
                self.block(body);
                self.token(" while (", at);
                self.expression(*condition);
                self.plain(");");
            }
            StatementKind::Break => self.token("break;", at),
            StatementKind::Continue => self.token("continue;", at),
            StatementKind::Discard => self.token("discard;", at),
            StatementKind::Return(None) => self.token("return;", at),
            StatementKind::Return(Some(value)) => {
                self.token("return ", at);
                self.expression(*value);
                self.plain(";");
            }
        }
    }

    /// Prints the condition of a `for`; naga treats one that begins with a type as a declaration.
    fn condition(&mut self, condition: ExprId) {
        let mut first = condition;
        while let Some(operand) = self.leftmost(first) {
            first = operand;
        }
        if matches!(self.cx.tree[first].kind, ExprKind::Construct { .. }) {
            self.plain("(");
            self.expression(condition);
            self.plain(")");
        } else {
            self.expression(condition);
        }
    }

    /// The operand that an expression begins with.
    fn leftmost(&self, id: ExprId) -> Option<ExprId> {
        match self.cx.tree[id].kind {
            ExprKind::Binary { left: first, .. }
            | ExprKind::Conditional { condition: first, .. }
            | ExprKind::Sequence { first, .. }
            | ExprKind::Assign { target: first, .. }
            | ExprKind::Index { base: first, .. }
            | ExprKind::Swizzle { vector: first, .. }
            | ExprKind::Member { structure: first, .. }
            | ExprKind::Unary {
                op: UnaryOp::Plus,
                operand: first,
            } => Some(first),
            _ => None,
        }
    }

    /// `int i = 0, j = 1`: all variables share a type.
    fn init(&mut self, init: &Block) {
        for (position, statement) in init.iter().enumerate() {
            match statement.kind {
                StatementKind::Declare(variable) if position == 0 => self.declaration(variable),
                StatementKind::Declare(variable) => {
                    let name = self.variable(variable);
                    self.plain(", ");
                    self.spanned(name, self.cx.tree[variable].at.map(|at| at.span));
                    if let Some(value) = self.cx.tree[variable].initializer {
                        self.plain(" = ");
                        self.argument(value);
                    }
                }
                StatementKind::Expression(expr) => self.effect(expr),
                _ => {}
            }
        }
    }

    /// Prints an expression as a statement, in parentheses if it begins with `float[2](…)`, which naga would
    /// treat as a declaration.
    fn effect(&mut self, expr: ExprId) {
        if begins_with_array(&self.cx.tree, expr) {
            self.plain("(");
            self.expression(expr);
            self.plain(")");
        } else {
            self.expression(expr);
        }
    }

    fn branches(&mut self, arms: &[Arm], otherwise: Option<&Block>, at: Place) {
        for (position, arm) in arms.iter().enumerate() {
            self.token(if position == 0 { "if (" } else { " else if (" }, at);
            self.expression(arm.condition);
            self.plain(") ");
            self.block(&arm.body);
        }
        if let Some(body) = otherwise {
            self.token(" else ", at);
            self.block(body);
        }
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case], at: Place) {
        self.token("switch (", at);
        self.expression(selector);
        self.plain(") ");
        self.braces(|printer| {
            for case in cases {
                for label in &case.labels {
                    printer.line();
                    match *label {
                        Label::Default => printer.token("default", case.at),
                        Label::Case { expr, value } => {
                            let uint =
                                printer.cx.tree[expr].ty.scalar() == Some(toyproof_glsl::tree::Scalar::Uint);
                            let text = if uint {
                                format!("{value}u")
                            } else {
                                value.cast_signed().to_string()
                            };
                            printer.token(&format!("case {text}"), case.at);
                        }
                    }
                    printer.plain(":\n");
                }
                printer.indented(|printer| printer.statements(&case.body));
            }
        });
    }
}

/// Whether an expression's text begins with an array constructor.
fn begins_with_array(tree: &Tree, expr: ExprId) -> bool {
    let mut first = expr;
    loop {
        first = match tree[first].kind {
            ExprKind::Construct { .. } => return matches!(tree[first].ty, Type::Array(_)),
            ExprKind::Binary { left: inner, .. }
            | ExprKind::Assign { target: inner, .. }
            | ExprKind::Conditional { condition: inner, .. }
            | ExprKind::Sequence { first: inner, .. }
            | ExprKind::Swizzle { vector: inner, .. }
            | ExprKind::Member { structure: inner, .. }
            | ExprKind::Index { base: inner, .. }
            | ExprKind::Step {
                postfix: true,
                target: inner,
                ..
            } => inner,
            _ => return false,
        };
    }
}
