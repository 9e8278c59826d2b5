//! What belongs to the structure `Shader`: Metal has no global variables but constants, and only the entry
//! point has textures and inputs.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    BuiltInVariable, Constructor, ExprId, ExprKind, FunctionId, Item, Type, VariableId, VariableKind, walk,
};

use crate::c_family::writer::Writer;
use crate::print::Order;

impl Writer<'_> {
    /// The items that are members of the structure: variables, functions that read or write them, inputs or
    /// textures, and the functions that call these. Overloads are members together, since those of a
    /// structure hide others.
    pub(in super::super) fn members_in_metal(&self, order: &Order) -> HashSet<Item> {
        let mut members: HashSet<Item> = HashSet::from([Item::Function(self.cx.main_image)]);
        let mut constants = HashSet::new();
        for &item in &order.items {
            if let Item::Variable(id) = item {
                if self.is_global_constant(id, &constants) {
                    constants.insert(id);
                } else {
                    members.insert(item);
                }
            }
        }
        loop {
            let count = members.len();
            let functions = order.items.iter().filter_map(|&item| match item {
                Item::Function(id) => Some(id),
                _ => None,
            });
            for id in functions.clone() {
                if !members.contains(&Item::Function(id)) && self.needs_state(id, &members) {
                    members.insert(Item::Function(id));
                }
            }
            let names: HashSet<&str> = functions
                .clone()
                .filter(|&id| members.contains(&Item::Function(id)))
                .map(|id| self.function(id))
                .collect();
            let overloads = functions.filter(|&id| names.contains(self.function(id)));
            members.extend(overloads.map(Item::Function));
            if members.len() == count {
                return members;
            }
        }
    }

    /// Whether a function names a member of the structure, an input or a texture.
    fn needs_state(&self, id: FunctionId, members: &HashSet<Item>) -> bool {
        let tree = &self.cx.tree;
        if self.cx.helper_inputs.contains_key(&id) {
            return true;
        }
        let roots = tree[id].body.as_ref().map(|body| walk::roots(tree, body));
        let mut nodes = roots.into_iter().flatten().flat_map(|root| tree.postorder(root));
        nodes.any(|node| match tree[node].kind {
            ExprKind::Variable(variable) => match tree[variable].kind {
                VariableKind::Input(_)
                | VariableKind::Channel(_)
                | VariableKind::BuiltIn(BuiltInVariable::FragCoord) => true,
                _ => members.contains(&Item::Variable(variable)),
            },
            ExprKind::Call { function, .. } => members.contains(&Item::Function(function)),
            _ => false,
        })
    }

    /// Whether a variable outside functions is never written, and its value is one that every version of the
    /// compiler evaluates: `constants` are such variables before it.
    fn is_global_constant(&self, id: VariableId, constants: &HashSet<VariableId>) -> bool {
        let variable = &self.cx.tree[id];
        match (variable.kind, variable.initializer) {
            (VariableKind::Const | VariableKind::Uniform, Some(value)) => {
                self.is_constant_expression(value, constants)
            }
            (VariableKind::Uniform | VariableKind::Varying, None) => true,
            _ => false,
        }
    }

    fn is_constant_expression(&self, root: ExprId, constants: &HashSet<VariableId>) -> bool {
        let tree = &self.cx.tree;
        let is_scalar = |id: ExprId| matches!(tree[id].ty, Type::Scalar(_));
        tree.postorder(root).into_iter().all(|id| match &tree[id].kind {
            ExprKind::Literal(_) => true,
            ExprKind::Variable(variable) => is_scalar(id) && constants.contains(variable),
            ExprKind::Unary { .. } | ExprKind::Conditional { .. } => is_scalar(id),
            &ExprKind::Binary { left, right, .. } => is_scalar(left) && is_scalar(right),
            ExprKind::Construct {
                constructor,
                arguments,
            } => {
                let count = |ty: Type| u32::from(ty.component_count().unwrap_or(1));
                let given: u32 = arguments.iter().map(|&argument| count(tree[argument].ty)).sum();
                match constructor {
                    Constructor::Scalar => is_scalar(arguments[0]),
                    Constructor::Vector | Constructor::Matrix => given == count(tree[id].ty),
                    Constructor::Resize => false,
                    _ => true,
                }
            }
            _ => false,
        })
    }
}
