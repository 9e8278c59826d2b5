//! What is printed, and in which order: the author's, but nothing before what it uses, and nothing that is not used.
//!
//! naga reads from top to bottom, forgets what a prototype promised once another definition stands between, and takes
//! time for functions that nobody calls.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    ExprId, ExprKind, Function, Item, StatementKind, Type, VariableId, VariableKind, walk,
};

use crate::lower::Draft;

/// Everything that a picture needs, definitions before uses.
pub(crate) struct Order {
    pub(crate) items: Vec<Item>,
    /// The inputs that are read.
    pub(crate) inputs: Vec<VariableId>,
}

impl Order {
    /// Where labels of `case`s are printed as their values.
    pub(crate) fn of(draft: &Draft) -> Self {
        Self::found(draft, false)
    }

    /// Where they are printed as written, with the constants that they name.
    pub(crate) fn with_labels(draft: &Draft) -> Self {
        Self::found(draft, true)
    }

    fn found(draft: &Draft, labels: bool) -> Self {
        let mut finder = Finder {
            draft,
            labels,
            locals: locals(draft),
            inputs: Vec::new(),
        };
        let roots: Vec<Item> = draft
            .begin
            .iter()
            .chain([&draft.main_image])
            .map(|&id| Item::Function(id))
            .collect();
        let mut used = HashSet::new();
        let mut reached = Vec::new();
        for &root in &roots {
            finder.definitions_first(root, &mut used, &mut reached);
        }
        // The author's order first, so that only what must moves.
        let mut done = HashSet::new();
        let mut items = Vec::new();
        let author = draft.tree.items.iter().filter(|item| used.contains(item));
        for &item in author.chain(&roots) {
            finder.definitions_first(item, &mut done, &mut items);
        }
        let mut inputs = finder.inputs;
        inputs.sort_unstable();
        inputs.dedup();
        Self { items, inputs }
    }
}

/// The variables that functions declare, and their parameters.
fn locals(draft: &Draft) -> HashSet<VariableId> {
    let mut locals = HashSet::new();
    for (_, function) in draft.tree.functions.iter() {
        locals.extend(function.parameters.iter().copied());
        if let Some(body) = &function.body {
            walk::each(body, &mut |statement| locals.extend(walk::declared(statement)));
        }
    }
    locals
}

struct Finder<'a> {
    draft: &'a Draft,
    /// Whether labels name things, too.
    labels: bool,
    locals: HashSet<VariableId>,
    inputs: Vec<VariableId>,
}

impl Finder<'_> {
    /// Appends an item to `out`, what it needs before it.
    fn definitions_first(&mut self, root: Item, done: &mut HashSet<Item>, out: &mut Vec<Item>) {
        let mut pending = vec![(root, false)];
        while let Some((item, needs_done)) = pending.pop() {
            if needs_done {
                out.push(item);
            } else if done.insert(item) {
                pending.push((item, true));
                let needs = self.needs(item);
                pending.extend(
                    needs
                        .into_iter()
                        .rev()
                        .filter(|need| !done.contains(need))
                        .map(|need| (need, false)),
                );
            }
        }
    }

    /// What an item names.
    fn needs(&mut self, item: Item) -> Vec<Item> {
        let mut needs = Vec::new();
        match item {
            Item::Struct(id) => {
                for member in &self.draft.tree[id].members {
                    self.of_type(member.ty, &mut needs);
                }
            }
            Item::Variable(id) => {
                let variable = &self.draft.tree[id];
                self.of_type(variable.ty, &mut needs);
                self.of_expressions(variable.initialiser, &mut needs);
            }
            Item::Prototype(_) => {}
            Item::Function(id) => {
                let draft = self.draft;
                self.of_function(&draft.tree[id], &mut needs);
            }
        }
        needs
    }

    fn of_type(&self, ty: Type, needs: &mut Vec<Item>) {
        let mut ty = ty;
        while let Type::Array(id) = ty {
            ty = self.draft.tree.array(id).element;
        }
        if let Type::Struct(id) = ty {
            needs.push(Item::Struct(id));
        }
    }

    fn of_function(&mut self, function: &Function, needs: &mut Vec<Item>) {
        let draft = self.draft;
        self.of_type(function.return_type, needs);
        for &parameter in &function.parameters {
            self.of_type(draft.tree[parameter].ty, needs);
        }
        if let Some(body) = &function.body {
            walk::each(body, &mut |statement| {
                if let Some(variable) = walk::declared(statement) {
                    self.of_type(draft.tree[variable].ty, needs);
                }
                self.of_expressions(walk::own_expressions(&draft.tree, statement), needs);
                if let (true, StatementKind::Switch { cases, .. }) = (self.labels, &statement.kind) {
                    let labels = cases.iter().flat_map(|case| walk::values(&case.labels));
                    self.of_expressions(labels, needs);
                }
            });
        }
    }

    fn of_expressions(&mut self, roots: impl IntoIterator<Item = ExprId>, needs: &mut Vec<Item>) {
        let tree = &self.draft.tree;
        for id in roots.into_iter().flat_map(|root| tree.postorder(root)) {
            match tree[id].kind {
                ExprKind::Call { function, .. } => needs.push(Item::Function(function)),
                ExprKind::Construct { .. } => self.of_type(tree[id].ty, needs),
                ExprKind::Variable(variable) => match tree[variable].kind {
                    VariableKind::Input(_) => self.inputs.push(variable),
                    VariableKind::BuiltIn(built_in) if super::names::is_known(built_in) => {}
                    _ if self.locals.contains(&variable) => {}
                    _ => needs.push(Item::Variable(variable)),
                },
                _ => {}
            }
        }
    }
}
