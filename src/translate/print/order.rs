//! The items to print and their order: the author's, except that definitions precede uses and unused items
//! are omitted.
//!
//! naga reads from top to bottom, forgets a prototype after another definition, and spends time on functions
//! that are never called.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    BuiltInVariable, ExprId, ExprKind, Function, Item, StatementKind, Type, VariableId, VariableKind, walk,
};

use crate::lower::context::LoweringContext;

/// How `case` labels are printed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum CaseLabels {
    /// As values.
    Values,
    /// As written, with the constants that they name.
    AsWritten,
}

/// Everything that an image depends on, definitions before uses.
pub(crate) struct Order {
    pub(crate) items: Vec<Item>,
    /// The inputs that are read.
    pub(crate) inputs: Vec<VariableId>,
    /// Whether a uniform of the author's block is read; all of them are then among the items.
    pub(crate) reads_uniform_block: bool,
}

impl Order {
    pub(crate) fn new(cx: &LoweringContext, labels: CaseLabels) -> Self {
        let mut collector = Collector {
            cx,
            labels,
            locals: locals(cx),
            inputs: Vec::new(),
        };
        let roots: Vec<Item> = cx
            .startup_function
            .iter()
            .chain([&cx.main_image])
            .map(|&id| Item::Function(id))
            .collect();
        let mut used = HashSet::new();
        let mut reached = Vec::new();
        for &root in &roots {
            collector.push_postorder(root, &mut used, &mut reached);
        }
        let mut block = cx.uniform_block.iter().map(|&id| Item::Variable(id));
        let reads_uniform_block = block.any(|member| used.contains(&member));
        if reads_uniform_block {
            used.extend(cx.uniform_block.iter().map(|&id| Item::Variable(id)));
        }
        // Follow the author's order, so that only misplaced items move.
        let mut done = HashSet::new();
        let mut items = Vec::new();
        let author = cx.tree.items.iter().filter(|item| used.contains(item));
        for &item in author.chain(&roots) {
            collector.push_postorder(item, &mut done, &mut items);
        }
        let mut inputs = collector.inputs;
        inputs.sort_unstable();
        inputs.dedup();
        Self {
            items,
            inputs,
            reads_uniform_block,
        }
    }
}

/// The parameters of functions and the variables that they declare.
fn locals(cx: &LoweringContext) -> HashSet<VariableId> {
    let mut locals = HashSet::new();
    for (_, function) in cx.tree.functions.iter() {
        locals.extend(function.parameters.iter().copied());
        if let Some(body) = &function.body {
            walk::each(body, &mut |statement| locals.extend(walk::declared(statement)));
        }
    }
    locals
}

struct Collector<'a> {
    cx: &'a LoweringContext,
    labels: CaseLabels,
    locals: HashSet<VariableId>,
    inputs: Vec<VariableId>,
}

impl Collector<'_> {
    /// Appends an item to `out`, after its dependencies.
    fn push_postorder(&mut self, root: Item, done: &mut HashSet<Item>, out: &mut Vec<Item>) {
        let mut pending = vec![(root, false)];
        while let Some((item, dependencies_done)) = pending.pop() {
            if dependencies_done {
                out.push(item);
            } else if done.insert(item) {
                pending.push((item, true));
                let dependencies = self.dependencies(item);
                pending.extend(
                    dependencies
                        .into_iter()
                        .rev()
                        .filter(|dependency| !done.contains(dependency))
                        .map(|dependency| (dependency, false)),
                );
            }
        }
    }

    /// The items that an item names.
    fn dependencies(&mut self, item: Item) -> Vec<Item> {
        let mut dependencies = Vec::new();
        match item {
            Item::Struct(id) => {
                for member in &self.cx.tree[id].members {
                    self.add_type(member.ty, &mut dependencies);
                }
            }
            Item::Variable(id) => {
                let variable = &self.cx.tree[id];
                self.add_type(variable.ty, &mut dependencies);
                self.add_expressions(variable.initializer, &mut dependencies);
            }
            Item::Prototype(_) => {}
            Item::Function(id) => {
                let cx = self.cx;
                self.inputs.extend(cx.helper_inputs.get(&id));
                self.add_function(&cx.tree[id], &mut dependencies);
            }
        }
        dependencies
    }

    fn add_type(&self, ty: Type, dependencies: &mut Vec<Item>) {
        let mut ty = ty;
        while let Type::Array(id) = ty {
            ty = self.cx.tree.array(id).element;
        }
        if let Type::Struct(id) = ty {
            dependencies.push(Item::Struct(id));
        }
    }

    fn add_function(&mut self, function: &Function, dependencies: &mut Vec<Item>) {
        let cx = self.cx;
        self.add_type(function.return_type, dependencies);
        for &parameter in &function.parameters {
            self.add_type(cx.tree[parameter].ty, dependencies);
        }
        if let Some(body) = &function.body {
            walk::each(body, &mut |statement| {
                if let Some(variable) = walk::declared(statement) {
                    self.add_type(cx.tree[variable].ty, dependencies);
                }
                self.add_expressions(walk::own_expressions(&cx.tree, statement), dependencies);
                if self.labels == CaseLabels::AsWritten
                    && let StatementKind::Switch { cases, .. } = &statement.kind
                {
                    let labels = cases.iter().flat_map(|case| walk::values(&case.labels));
                    self.add_expressions(labels, dependencies);
                }
            });
        }
    }

    fn add_expressions(&mut self, roots: impl IntoIterator<Item = ExprId>, dependencies: &mut Vec<Item>) {
        let tree = &self.cx.tree;
        for id in roots.into_iter().flat_map(|root| tree.postorder(root)) {
            match tree[id].kind {
                ExprKind::Call { function, .. } => dependencies.push(Item::Function(function)),
                ExprKind::Construct { .. } => self.add_type(tree[id].ty, dependencies),
                ExprKind::Variable(variable) => match tree[variable].kind {
                    VariableKind::Input(_) | VariableKind::Channel(_) => self.inputs.push(variable),
                    // naga has it under the same name.
                    VariableKind::BuiltIn(BuiltInVariable::FragCoord) => {}
                    _ if self.locals.contains(&variable) => {}
                    _ => dependencies.push(Item::Variable(variable)),
                },
                _ => {}
            }
        }
    }
}
