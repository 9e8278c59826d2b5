//! Prints structures, globals and functions, in the author's order.

use toyproof_glsl::tree::{
    Block, Direction, ExprKind, FunctionId, Item, Statement, StatementKind, StructId, Type, VariableId,
    VariableKind, walk,
};

use super::Unprintable;
use super::names::Names;
use super::writer::{Facts, Writer, is_out};
use crate::lower::helper_tree;
use crate::print::Order;

impl Writer<'_> {
    pub(super) fn item(&mut self, item: Item) -> Result<(), Unprintable> {
        self.check_deadline()?;
        self.temporaries.clear();
        match item {
            Item::Struct(id) => self.structure(id),
            Item::Variable(id) => self.global(id),
            Item::Function(id) => {
                if let Some(text) = self.cx.helpers.get(&id) {
                    return self.helper(id, text);
                }
                self.definition(id)
            }
            Item::Prototype(_) => Ok(()),
        }
    }

    fn structure(&mut self, id: StructId) -> Result<(), Unprintable> {
        let tree = &self.cx.tree;
        self.line("");
        let comments = self.comments.before_item(tree[id].at);
        self.comment_lines(&comments);
        let name = self.names.structs.get(&id).cloned().unwrap_or_default();
        self.line(&format!("struct {name} {{"));
        for (at, member) in tree[id].members.iter().enumerate() {
            if matches!(member.ty, Type::Sampler(_)) {
                return Err(Unprintable::Construct("a sampler in a structure"));
            }
            let name = self.names.members.get(&(id, at)).cloned().unwrap_or_default();
            let ty = self.type_name(member.ty);
            self.indented(|writer| {
                let comments = writer.comments.before(member.at, Some(member.at));
                writer.comment_lines(&comments);
                let from = writer.out.len();
                writer.line(&format!("{name}: {ty},"));
                let comment = writer.comments.behind(member.at, Some(member.at));
                writer.trailing_comment(comment, from);
            });
        }
        self.end_of_item();
        Ok(())
    }

    fn global(&mut self, id: VariableId) -> Result<(), Unprintable> {
        let variable = &self.cx.tree[id];
        if matches!(variable.ty, Type::Sampler(_)) {
            return Err(Unprintable::Construct("a sampler that is not a channel"));
        }
        if self.is_in_block(id) {
            if let Some(at) = variable.at {
                let comments = self.comments.before_item(at).into_iter();
                let comments = comments.chain(self.comments.behind(at, Some(at)));
                self.uniforms.extend(comments.filter(|line| !line.is_empty()));
            }
            return self.add_uniform(id);
        }
        if self.out.ends_with("}\n") {
            self.line("");
        }
        if let Some(at) = variable.at {
            let comments = self.comments.before_item(at);
            self.comment_lines(&comments);
        }
        let from = self.out.len();
        let name = self.variable(id);
        let word = match variable.kind {
            VariableKind::Const => "const",
            // The host has no block for it.
            VariableKind::Uniform if variable.initializer.is_some() => "const",
            _ => "var<private>",
        };
        let line = match variable.initializer {
            Some(initializer) => {
                let value = self.value(initializer)?;
                self.typed_declaration(word, name, variable.ty, &value.code)
            }
            None => format!("{word} {name}: {};", self.type_name(variable.ty)),
        };
        self.line(&line);
        if let Some(at) = variable.at {
            let comment = self.comments.behind(at, Some(at));
            self.trailing_comment(comment, from);
        }
        Ok(())
    }

    fn definition(&mut self, id: FunctionId) -> Result<(), Unprintable> {
        let function = &self.cx.tree[id];
        let Some(body) = &function.body else {
            return Err(Unprintable::Construct("a function without a body"));
        };
        self.line("");
        let comments = self.comments.before_item(function.at);
        self.comment_lines(&comments);
        self.head(id)?;
        self.indent += 1;
        for &parameter in &function.parameters {
            let variable = &self.cx.tree[parameter];
            if is_out(self.cx, parameter) {
                // The variable in its only caller is zero-initialized.
                let is_new = id == self.cx.main_image && !self.facts.called.contains(&id);
                let is_read_first = !is_new
                    && variable.kind == VariableKind::Parameter(Direction::Out)
                    && !self.is_written_first(body, parameter);
                if is_read_first {
                    let zero = self.zero(variable.ty);
                    self.line(&format!("*{} = {zero};", self.variable(parameter)));
                }
            } else if self.facts.is_memory(parameter) {
                let argument = self.names.arguments.get(&parameter).cloned().unwrap_or_default();
                self.line(&format!("var {} = {argument};", self.variable(parameter)));
            }
        }
        self.statements(body)?;
        if function.return_type != Type::Void && self.may_complete(body) {
            let zero = self.zero(function.return_type);
            self.line(&format!("return {zero};"));
        }
        self.indent -= 1;
        self.end_of_item();
        Ok(())
    }

    /// Prints the comments at the end of an item, its end, and the comment behind it.
    fn end_of_item(&mut self) {
        let comments = self.comments.at_end_of_item();
        self.indented(|writer| writer.comment_lines(&comments));
        let from = self.out.len();
        self.line("}");
        let comment = self.comments.behind_item();
        self.trailing_comment(comment, from);
    }

    fn head(&mut self, id: FunctionId) -> Result<(), Unprintable> {
        let function = &self.cx.tree[id];
        let mut parameters = Vec::new();
        for &parameter in &function.parameters {
            let variable = &self.cx.tree[parameter];
            if matches!(variable.ty, Type::Sampler(_)) {
                return Err(Unprintable::Construct("a sampler parameter"));
            }
            let ty = self.type_name(variable.ty);
            let own = self.variable(parameter);
            parameters.push(if is_out(self.cx, parameter) {
                format!("{own}: ptr<function, {ty}>")
            } else if self.facts.is_memory(parameter) {
                format!(
                    "{}: {ty}",
                    self.names.arguments.get(&parameter).cloned().unwrap_or_default()
                )
            } else {
                format!("{own}: {ty}")
            });
        }
        let returns = match function.return_type {
            Type::Void => String::new(),
            ty => format!(" -> {}", self.type_name(ty)),
        };
        self.line(&format!(
            "fn {}({}){returns} {{",
            self.function(id),
            parameters.join(", ")
        ));
        Ok(())
    }

    /// Whether an `out` parameter is written as a whole before any other use, on every path.
    fn is_written_first(&self, body: &Block, parameter: VariableId) -> bool {
        let tree = &self.cx.tree;
        for statement in body {
            if let StatementKind::Expression(expr) = statement.kind
                && let ExprKind::Assign {
                    op: None,
                    target,
                    value,
                } = tree[expr].kind
                && matches!(tree[target].kind, ExprKind::Variable(id) if id == parameter)
            {
                return !walk::mentions(tree, value, parameter);
            }
            let block = std::slice::from_ref(statement);
            let mut leaves = false;
            walk::each(block, &mut |inner: &Statement| {
                leaves |= matches!(inner.kind, StatementKind::Return(_) | StatementKind::Discard);
            });
            let block: Block = vec![statement.clone()];
            let mentions = walk::roots(tree, &block)
                .into_iter()
                .any(|root| walk::mentions(tree, root, parameter));
            if leaves || mentions {
                return false;
            }
        }
        false
    }

    /// Prints a helper function of lowering, by parsing its text as GLSL.
    fn helper(&mut self, id: FunctionId, text: &str) -> Result<(), Unprintable> {
        const BROKEN: Unprintable = Unprintable::Construct("a generated function");
        let (files, cx) = helper_tree(self.cx, id, text).ok_or(BROKEN)?;
        let first = cx.tree.items.iter().find_map(|item| match item {
            Item::Function(id) => Some(*id),
            _ => None,
        });
        let first = first.ok_or(BROKEN)?;
        let order = Order {
            items: vec![Item::Function(first)],
            inputs: Vec::new(),
            reads_uniform_block: false,
        };
        let mut names = Names::new(&cx, &order, self.style);
        names.functions.insert(first, self.function(id).to_owned());
        let facts = Facts::new(&cx);
        let mut writer = Writer::new(&cx, &names, &facts, &order, self.style, &files, self.deadline);
        writer.definition(first)?;
        self.uses_derivatives |= writer.uses_derivatives;
        self.helpers.append(&mut writer.helpers);
        self.out.push_str(&writer.out);
        Ok(())
    }
}
