//! Prints structures, globals and functions, in the author's order.

use toyproof_glsl::tree::{Direction, FunctionId, Item, StructId, Type, VariableId, VariableKind};

use super::Unprintable;
use super::language::{Language, Words};
use super::writer::{PrintResult, Writer};
use crate::lower::helper_tree;
use crate::print::{Names, Order};

/// Maximum number of elements in a global list of zeros.
const MAX_ZEROS: u64 = 64;

impl Writer<'_> {
    pub(super) fn item(&mut self, item: Item) -> PrintResult {
        self.check_deadline()?;
        match item {
            Item::Struct(id) => self.structure(id),
            Item::Variable(id) => self.global(id),
            Item::Function(id) => match self.cx.helpers.get(&id) {
                Some(text) => self.helper(id, text),
                None => self.definition(id),
            },
            Item::Prototype(_) => Ok(()),
        }
    }

    fn structure(&mut self, id: StructId) -> PrintResult {
        let tree = &self.cx.tree;
        self.line("");
        let comments = self.comments.before_item(tree[id].at);
        self.comment_lines(&comments);
        self.line(&format!("struct {} {{", self.structure_name(id)));
        for (at, member) in tree[id].members.iter().enumerate() {
            let declared = self.declarator(member.ty, self.member_name(id, at))?;
            self.indented(|writer| {
                let comments = writer.comments.before(member.at, Some(member.at));
                writer.comment_lines(&comments);
                writer.line(&format!("{declared};"));
                let comment = writer.comments.behind(member.at, Some(member.at));
                writer.trailing_comment(comment);
                Ok(())
            })?;
        }
        self.end_of_item("};")?;
        Ok(())
    }

    /// The function that makes a structure of its members.
    pub(super) fn maker(&mut self, id: StructId) -> PrintResult {
        let tree = &self.cx.tree;
        let name = self.structure_name(id);
        let members = tree[id].members.iter().enumerate();
        let parameters = members.map(|(at, member)| self.declarator(member.ty, self.member_name(id, at)));
        let parameters = parameters.collect::<PrintResult<Vec<_>>>()?.join(", ");
        let result = self.free("result");
        self.line("");
        self.line(&format!("{name} {}({parameters}) {{", self.maker_name(id)));
        self.indented(|writer| {
            writer.line(&format!("{name} {result};"));
            for at in 0..tree[id].members.len() {
                let member = writer.member_name(id, at);
                writer.line(&format!("{result}.{member} = {member};"));
            }
            writer.line(&format!("return {result};"));
            Ok(())
        })?;
        self.line("}");
        Ok(())
    }

    pub(super) fn maker_name(&self, id: StructId) -> String {
        self.free(&format!("make_{}", self.structure_name(id)))
    }

    pub(super) fn member_name(&self, id: StructId, at: usize) -> &str {
        self.names.members.get(&(id, at)).map_or("", String::as_str)
    }

    fn global(&mut self, id: VariableId) -> PrintResult {
        let variable = &self.cx.tree[id];
        if let Some(at) = variable.at {
            let comments = self.comments.before_item(at);
            self.comment_lines(&comments);
        }
        // A uniform that nothing sets is zero.
        let is_constant = matches!(variable.kind, VariableKind::Const | VariableKind::Uniform);
        let declared = self.declarator(variable.ty, self.variable(id))?;
        let word = match self.language() {
            Language::Hlsl if is_constant => "static const ",
            Language::Hlsl => "static ",
            Language::Godot => "const ",
            Language::Glsl if is_constant => "const ",
            Language::Msl if !self.members.contains(&Item::Variable(id)) => "constant ",
            Language::Msl | Language::Glsl => "",
        };
        let value = match variable.initializer {
            Some(value) => format!(" = {}", self.initializer(value)?),
            // Static variables are zero without a value, too (Microsoft's “Variable Syntax”).
            None if self.language() == Language::Hlsl && self.element_count(variable.ty) > MAX_ZEROS => {
                String::new()
            }
            None => format!(" = {}", self.zero(variable.ty)?),
        };
        self.line(&format!("{word}{declared}{value};"));
        if let Some(at) = variable.at {
            let comment = self.comments.behind(at, Some(at));
            self.trailing_comment(comment);
        }
        Ok(())
    }

    /// The number of elements of an array of arrays; 1 for other types.
    pub(super) fn element_count(&self, ty: Type) -> u64 {
        match ty {
            Type::Array(id) => {
                let array = self.cx.tree.array(id);
                u64::from(array.size).saturating_mul(self.element_count(array.element))
            }
            _ => 1,
        }
    }

    fn definition(&mut self, id: FunctionId) -> PrintResult {
        let function = &self.cx.tree[id];
        let Some(body) = &function.body else {
            return Err(Unprintable::Construct("a function without a body"));
        };
        if matches!(function.return_type, Type::Array(_)) && !self.language().has_array_values() {
            return Err(Unprintable::Construct("a function that returns an array"));
        }
        self.line("");
        let comments = self.comments.before_item(function.at);
        self.comment_lines(&comments);
        let parameters = function.parameters.iter().map(|&parameter| {
            let variable = &self.cx.tree[parameter];
            let direction = match variable.kind {
                VariableKind::Parameter(direction) => direction,
                _ => Direction::In,
            };
            let declared = self.declarator(variable.ty, self.variable(parameter))?;
            Ok(self.language().parameter(direction, &declared))
        });
        let parameters = parameters.collect::<PrintResult<Vec<_>>>()?.join(", ");
        let returned = self.type_name(function.return_type)?;
        self.line(&format!("{returned} {}({parameters}) {{", self.function(id)));
        self.returned = function.return_type;
        self.indented(|writer| writer.statements(body))?;
        self.end_of_item("}")
    }

    /// Prints the comments at the end of an item, its end, and the comment behind it.
    fn end_of_item(&mut self, end: &str) -> PrintResult {
        let comments = self.comments.at_end_of_item();
        self.indented(|writer| {
            writer.comment_lines(&comments);
            Ok(())
        })?;
        self.line(end);
        let comment = self.comments.behind_item();
        self.trailing_comment(comment);
        Ok(())
    }

    /// Prints a helper function of lowering, by parsing its text as GLSL.
    fn helper(&mut self, id: FunctionId, text: &str) -> PrintResult {
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
        let mut names = Names::new(&cx, &order, &Words::new(self.host));
        names.functions.insert(first, self.function(id).to_owned());
        let mut writer = Writer::new(&cx, &names, &order, self.host, &files, self.deadline);
        writer.definition(first)?;
        self.helpers.append(&mut writer.helpers);
        self.takes_derivatives |= writer.takes_derivatives;
        self.out.push_str(&writer.out);
        Ok(())
    }
}
