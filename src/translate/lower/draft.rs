//! A shader on its way down: the tree that the passes work on, and what they add to it.

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::Diagnostic;
use toyproof_glsl::tree::{
    Block, Direction, ExprId, Function, FunctionId, Place, Statement, StatementKind, Tree, Type, Variable,
    VariableId, VariableKind, walk,
};

use super::build::Builder;
use super::elementary::Spelled;
use super::helper::Helper;

/// What every pass is given.
pub(crate) struct Draft {
    pub(crate) tree: Tree,
    pub(crate) main_image: FunctionId,
    /// Assignments that run before `mainImage`, in order.
    pub(super) start: Vec<ExprId>,
    /// The function of those assignments.
    pub(crate) begin: Option<FunctionId>,
    /// Variables of our own, each of use within one statement of the author; [`super::sequence`] declares them.
    pub(super) temporaries: HashSet<VariableId>,
    /// Variables whose declarations were moved outwards: their names must not meet others.
    pub(crate) moved: HashSet<VariableId>,
    /// The bodies of functions of our own that are written as text.
    pub(crate) helpers: HashMap<FunctionId, String>,
    /// That it nests deeper than drivers count, with the place.
    pub(crate) too_deep: Option<Diagnostic>,
    helper_ids: HashMap<(Helper, Type, Type), FunctionId>,
    /// The functions of our own that stand for built-in ones, by the types of their arguments.
    pub(super) spelled: HashMap<(Spelled, Vec<Type>), FunctionId>,
}

impl Draft {
    pub(crate) fn new(tree: Tree, main_image: FunctionId) -> Self {
        Self {
            tree,
            main_image,
            start: Vec::new(),
            begin: None,
            temporaries: HashSet::new(),
            moved: HashSet::new(),
            helpers: HashMap::new(),
            too_deep: None,
            helper_ids: HashMap::new(),
            spelled: HashMap::new(),
        }
    }

    pub(super) fn build(&mut self, at: Place) -> Builder<'_> {
        Builder::new(&mut self.tree, at)
    }

    /// Makes nodes where that expression stands.
    pub(super) fn build_at(&mut self, id: ExprId) -> Builder<'_> {
        let at = self.tree[id].at;
        self.build(at)
    }

    /// A variable of our own, to be used within one statement and assigned before it is read.
    pub(super) fn temporary(&mut self, name: &str, ty: Type, at: Place) -> VariableId {
        let variable = self.local(name, ty, at);
        self.temporaries.insert(variable);
        self.moved.insert(variable);
        variable
    }

    /// A local variable of our own.
    pub(super) fn local(&mut self, name: &str, ty: Type, at: Place) -> VariableId {
        let kind = VariableKind::Local;
        self.tree.variables.push(Variable {
            name: format!("toyproof_{name}"),
            ty,
            kind,
            initialiser: None,
            value: None,
            at: Some(at),
        })
    }

    /// A function of our own for those types, made once.
    pub(super) fn helper(&mut self, helper: Helper, types: (Type, Type), at: Place) -> FunctionId {
        if let Some(&id) = self.helper_ids.get(&(helper, types.0, types.1)) {
            return id;
        }
        let id = helper.make(self, types, at);
        self.helper_ids.insert((helper, types.0, types.1), id);
        id
    }

    /// Adds a function of our own. What it is given is read where it stands, as operands are: `in` is `const
    /// in`.
    pub(super) fn function(
        &mut self,
        name: String,
        parameters: &[(Direction, Type, &str)],
        return_type: Type,
        at: Place,
    ) -> FunctionId {
        let variables = &mut self.tree.variables;
        let parameters = parameters.iter().map(|&(direction, ty, name)| {
            let kind = VariableKind::Parameter(match direction {
                Direction::In => Direction::ConstIn,
                other => other,
            });
            let name = name.to_owned();
            variables.push(Variable {
                name,
                ty,
                kind,
                initialiser: None,
                value: None,
                at: Some(at),
            })
        });
        let parameters = parameters.collect();
        self.tree.functions.push(Function {
            name,
            return_type,
            parameters,
            body: None,
            at,
        })
    }

    /// Lets `change` rewrite the body of each function.
    pub(super) fn each_body(&mut self, mut change: impl FnMut(&mut Self, FunctionId, Block) -> Block) {
        let functions: Vec<_> = self.tree.functions.ids().collect();
        for id in functions {
            if let Some(body) = self.tree[id].body.take() {
                let body = change(self, id, body);
                self.tree[id].body = Some(body);
            }
        }
    }

    /// Lets `change` rewrite each statement of each function, inner ones first.
    pub(super) fn each_statement(&mut self, mut change: impl FnMut(&mut Self, Statement, &mut Block)) {
        self.each_body(|draft, _, body| {
            walk::rebuild(body, &mut |statement, out| change(draft, statement, out))
        });
    }

    /// Lets `change` rewrite every expression that stands in the tree now, in any order.
    pub(super) fn each_expression(&mut self, mut change: impl FnMut(&mut Self, ExprId)) {
        for id in self.tree.exprs.ids() {
            change(self, id);
        }
    }

    /// The same, operands before what uses them: for changes that move operands elsewhere.
    pub(super) fn operands_first(&mut self, mut change: impl FnMut(&mut Self, ExprId)) {
        let mut order = Vec::with_capacity(self.tree.exprs.len());
        let mut seen = vec![false; self.tree.exprs.len()];
        let mut pending = Vec::new();
        for root in self.tree.exprs.ids() {
            pending.push((root, false));
            while let Some((id, operands_done)) = pending.pop() {
                if operands_done {
                    order.push(id);
                } else if !std::mem::replace(&mut seen[id.index()], true) {
                    pending.push((id, true));
                    self.tree[id]
                        .kind
                        .for_each_operand(|operand| pending.push((operand, false)));
                }
            }
        }
        for id in order {
            change(self, id);
        }
    }

    /// The expressions whose values nobody asks for.
    pub(super) fn discarded(&self) -> HashSet<ExprId> {
        use toyproof_glsl::tree::ExprKind;
        let mut pending = Vec::new();
        for body in self
            .tree
            .functions
            .iter()
            .filter_map(|(_, function)| function.body.as_ref())
        {
            walk::each(body, &mut |statement| match statement.kind {
                StatementKind::Expression(expr) => pending.push(expr),
                StatementKind::For { step: Some(step), .. } => pending.push(step),
                _ => {}
            });
        }
        let mut discarded = HashSet::new();
        while let Some(id) = pending.pop() {
            discarded.insert(id);
            match self.tree[id].kind {
                ExprKind::Sequence { first, second } => pending.extend([first, second]),
                ExprKind::Conditional { yes, no, .. } => pending.extend([yes, no]),
                _ => {}
            }
        }
        // The first of a sequence is discarded wherever the sequence stands.
        for (_, expr) in self.tree.exprs.iter() {
            if let ExprKind::Sequence { first, .. } = expr.kind {
                discarded.insert(first);
            }
        }
        discarded
    }
}
