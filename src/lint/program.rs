//! What every analysis asks of a shader: which functions run, in which order they call, and what variables are given.

use toyproof_diagnostic::Deadline;
pub(super) use toyproof_glsl::tree::walk::direction;
use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, FunctionId, Item, StatementKind, Tree, Type, VariableId, walk,
};

/// A shader as the analyses see it: only what `mainImage` reaches counts.
pub(super) struct Program<'a> {
    pub(super) tree: &'a Tree,
    /// When all analyses must be over.
    pub(super) deadline: &'a Deadline,
    pub(super) main: FunctionId,
    /// Those that run, callees before callers.
    pub(super) functions: Vec<FunctionId>,
    /// By the index of the function: all that it evaluates, in the order of the text, operands first.
    exprs: Vec<Vec<ExprId>>,
    /// By the index of the variable.
    definitions: Vec<Vec<Definition>>,
    /// By the index of the function: what its `return`s give.
    returned: Vec<Vec<ExprId>>,
}

/// One way in which a variable comes by a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Definition {
    /// All of it is given this: by its initialiser, by `=`, or as an argument.
    Value(ExprId),
    /// It is changed, in whole or in part, by this assignment, step or call.
    Change(ExprId),
    /// It comes from outside: a parameter of `mainImage`.
    Outside,
}

impl<'a> Program<'a> {
    pub(super) fn new(tree: &'a Tree, main: FunctionId, deadline: &'a Deadline) -> Self {
        let mut program = Self {
            tree,
            deadline,
            main,
            functions: Vec::new(),
            exprs: vec![Vec::new(); tree.functions.len()],
            definitions: vec![Vec::new(); tree.variables.len()],
            returned: vec![Vec::new(); tree.functions.len()],
        };
        program.find_functions();
        program.find_definitions();
        program
    }

    /// All that a function evaluates, operands before what uses them.
    pub(super) fn exprs(&self, function: FunctionId) -> &[ExprId] {
        &self.exprs[function.index()]
    }

    /// All that runs, function by function, as long as there is time.
    pub(super) fn all_exprs(&self) -> impl Iterator<Item = ExprId> {
        self.functions
            .iter()
            .flat_map(|function| self.exprs(*function).iter().copied())
            .take_while(|_| !self.deadline.is_over())
    }

    /// All ways in which a variable comes by a value; none for one that keeps its first zero.
    pub(super) fn definitions(&self, variable: VariableId) -> &[Definition] {
        &self.definitions[variable.index()]
    }

    /// What a function's `return`s give.
    pub(super) fn returned(&self, function: FunctionId) -> &[ExprId] {
        &self.returned[function.index()]
    }

    /// What a variable always holds, where it is given a value once and never changed.
    pub(super) fn only_value(&self, variable: VariableId) -> Option<ExprId> {
        match self.definitions(variable) {
            [Definition::Value(value)] => Some(*value),
            _ => None,
        }
    }

    /// The expression that an expression is another name of: follows variables that are given a value once. The
    /// operands of what it gives are from where the variable was given its value.
    pub(super) fn resolve(&self, mut expr: ExprId) -> ExprId {
        // Each step goes from a use to an earlier place of the text, or from a callee to a caller; the bound is for lenient globals.
        for _ in 0..MAX_STEPS {
            match self.tree[expr].kind {
                ExprKind::Variable(variable) => match self.only_value(variable) {
                    Some(value) => expr = value,
                    None => return expr,
                },
                _ => return expr,
            }
        }
        expr
    }

    /// The value of an expression that is always the same: constants, and variables that are given one constant.
    pub(super) fn constant(&self, expr: ExprId) -> Option<toyproof_glsl::tree::Constant> {
        let expr = self.resolve(expr);
        if let ExprKind::Variable(variable) = self.tree[expr].kind {
            return self.tree[variable].value.clone();
        }
        self.tree.value(expr)
    }

    fn find_functions(&mut self) {
        let tree = self.tree;
        let mut roots: Vec<FunctionId> = Vec::new();
        for item in &tree.items {
            if let Item::Variable(variable) = item
                && let Some(initialiser) = tree[*variable].initialiser
            {
                roots.extend(
                    tree.postorder(initialiser)
                        .into_iter()
                        .filter_map(|expr| callee(tree, expr)),
                );
            }
        }
        roots.push(self.main);
        let mut seen = vec![false; tree.functions.len()];
        // Each entry is a function and how many of its calls have been followed.
        let mut open: Vec<(FunctionId, Vec<FunctionId>)> = Vec::new();
        for root in roots {
            if !std::mem::replace(&mut seen[root.index()], true) {
                open.push((root, self.read(root)));
            }
            while let Some((function, callees)) = open.last_mut() {
                if let Some(callee) = callees.pop() {
                    if !std::mem::replace(&mut seen[callee.index()], true) {
                        let callees = self.read(callee);
                        open.push((callee, callees));
                    }
                } else {
                    self.functions.push(*function);
                    open.pop();
                }
            }
        }
    }

    /// Notes what a function evaluates; gives what it calls.
    fn read(&mut self, function: FunctionId) -> Vec<FunctionId> {
        let tree = self.tree;
        let Some(body) = &tree[function].body else {
            return Vec::new();
        };
        let exprs: Vec<_> = walk::roots(tree, body)
            .into_iter()
            .flat_map(|root| tree.postorder(root))
            .collect();
        let callees = exprs.iter().filter_map(|&expr| callee(tree, expr)).collect();
        self.exprs[function.index()] = exprs;
        callees
    }

    fn find_definitions(&mut self) {
        let tree = self.tree;
        for item in &tree.items {
            if let Item::Variable(variable) = item
                && let Some(initialiser) = tree[*variable].initialiser
            {
                self.definitions[variable.index()].push(Definition::Value(initialiser));
            }
        }
        for &parameter in &tree[self.main].parameters {
            self.definitions[parameter.index()].push(Definition::Outside);
        }
        for function in self.functions.clone() {
            let mut found: Vec<(VariableId, Definition)> = Vec::new();
            for &expr in self.exprs(function) {
                tree.each_write(expr, |target, value| {
                    if let Some(variable) = tree.root_variable(target) {
                        let whole = matches!(tree[target].kind, ExprKind::Variable(_));
                        let definition = match value {
                            Some(value) if whole => Definition::Value(value),
                            _ => Definition::Change(expr),
                        };
                        found.push((variable, definition));
                    }
                });
                if let ExprKind::Call { function, arguments } = &tree[expr].kind {
                    for (&parameter, &argument) in tree[*function].parameters.iter().zip(arguments) {
                        if direction(tree, parameter) != Direction::Out {
                            found.push((parameter, Definition::Value(argument)));
                        }
                    }
                }
            }
            if let Some(body) = &tree[function].body {
                walk::each(body, &mut |statement| {
                    if let Some(variable) = walk::declared(statement)
                        && let Some(initialiser) = tree[variable].initialiser
                    {
                        found.push((variable, Definition::Value(initialiser)));
                    }
                    if let StatementKind::Return(Some(value)) = statement.kind {
                        self.returned[function.index()].push(value);
                    }
                });
            }
            for (variable, definition) in found {
                self.definitions[variable.index()].push(definition);
            }
        }
    }
}

/// How many names an analysis follows from a use to where its value comes from.
pub(super) const MAX_STEPS: usize = 64;

/// The last of many: all that a search sees of them which takes the newest of what waits, and only so many.
pub(super) fn last<T>(all: &[T], most: usize) -> &[T] {
    &all[all.len().saturating_sub(most)..]
}

/// The author's function that an expression calls.
pub(super) fn callee(tree: &Tree, expr: ExprId) -> Option<FunctionId> {
    match tree[expr].kind {
        ExprKind::Call { function, .. } => Some(function),
        _ => None,
    }
}

/// Whether a type is `float` or made of floats alone, as vectors and matrices are.
pub(super) fn is_float(ty: Type) -> bool {
    ty.scalar() == Some(toyproof_glsl::tree::Scalar::Float)
}
