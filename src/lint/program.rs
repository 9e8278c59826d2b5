//! Facts shared by all analyses of a shader: reachable functions in call order, and the definitions of
//! variables.

use toyproof_diagnostic::Deadline;
pub(super) use toyproof_glsl::tree::walk::direction;
use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, FunctionId, StatementKind, Tree, Type, Value, VariableId, walk,
};

/// The part of a shader reachable from `mainImage` and from the initializers of global variables.
pub(super) struct Program<'a> {
    pub(super) tree: &'a Tree,
    /// The time limit of all analyses.
    pub(super) deadline: &'a Deadline,
    pub(super) main: FunctionId,
    /// Reachable functions, callees before callers.
    pub(super) functions: Vec<FunctionId>,
    /// By function index: its expressions in textual order, operands first.
    exprs: Vec<Vec<ExprId>>,
    /// By variable index.
    definitions: Vec<Vec<Definition>>,
    /// The operands of the `return` statements of each function, by the function's index.
    returned: Vec<Vec<ExprId>>,
}

/// One definition of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Definition {
    /// The whole variable is set to this expression: by its initializer, by `=`, or as an argument.
    Value(ExprId),
    /// This assignment, step or call changes it, in whole or in part.
    Change(ExprId),
    /// The value comes from outside the shader: a parameter of `mainImage`.
    External,
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

    /// All expressions of a function, operands before their users.
    pub(super) fn exprs(&self, function: FunctionId) -> &[ExprId] {
        &self.exprs[function.index()]
    }

    /// All reachable expressions, function by function, until the deadline.
    pub(super) fn all_exprs(&self) -> impl Iterator<Item = ExprId> {
        self.functions
            .iter()
            .flat_map(|function| self.exprs(*function).iter().copied())
            .take_while(|_| !self.deadline.is_over())
    }

    /// All definitions of a variable; empty for one that keeps its initial zero.
    pub(super) fn definitions(&self, variable: VariableId) -> &[Definition] {
        &self.definitions[variable.index()]
    }

    /// The operands of a function's `return` statements.
    pub(super) fn returned(&self, function: FunctionId) -> &[ExprId] {
        &self.returned[function.index()]
    }

    /// The only value that a variable ever holds, if it is set once and never changed.
    pub(super) fn single_value(&self, variable: VariableId) -> Option<ExprId> {
        match self.definitions(variable) {
            [Definition::Value(value)] => Some(*value),
            _ => None,
        }
    }

    /// Resolves an expression to its definition, through variables that are set once. The operands of the
    /// result are those at the place of the definition.
    pub(super) fn resolve(&self, mut expr: ExprId) -> ExprId {
        // Each step goes from a use to an earlier place in the text, or from a callee to a caller; the bound
        // is needed for globals, which may be defined later.
        for _ in 0..MAX_RESOLVE_STEPS {
            match self.tree[expr].kind {
                ExprKind::Variable(variable) => match self.single_value(variable) {
                    Some(value) => expr = value,
                    None => return expr,
                },
                _ => return expr,
            }
        }
        expr
    }

    /// The value of a constant expression, or of a variable that is set once, to a constant.
    pub(super) fn constant(&self, expr: ExprId) -> Option<toyproof_glsl::tree::Constant> {
        let expr = self.resolve(expr);
        if let ExprKind::Variable(variable) = self.tree[expr].kind {
            return self.tree[variable].value.clone();
        }
        self.tree.value(expr)
    }

    /// The value of a constant `float`, if it is finite.
    pub(super) fn number(&self, expr: ExprId) -> Option<f64> {
        match *self.constant(expr)?.components() {
            [Value::Float(value)] if value.is_finite() => Some(value),
            _ => None,
        }
    }

    fn find_functions(&mut self) {
        let tree = self.tree;
        let mut roots: Vec<FunctionId> = Vec::new();
        for initializer in tree
            .global_variables()
            .filter_map(|variable| tree[variable].initializer)
        {
            let exprs = tree.postorder(initializer).into_iter();
            roots.extend(exprs.filter_map(|expr| callee(tree, expr)));
        }
        roots.push(self.main);
        let mut seen = vec![false; tree.functions.len()];
        // Each entry is a function, and its calls that have not been followed.
        let mut open: Vec<(FunctionId, Vec<FunctionId>)> = Vec::new();
        for root in roots {
            if !std::mem::replace(&mut seen[root.index()], true) {
                open.push((root, self.collect_exprs(root)));
            }
            while let Some((function, callees)) = open.last_mut() {
                if let Some(callee) = callees.pop() {
                    if !std::mem::replace(&mut seen[callee.index()], true) {
                        let callees = self.collect_exprs(callee);
                        open.push((callee, callees));
                    }
                } else {
                    self.functions.push(*function);
                    open.pop();
                }
            }
        }
    }

    /// Stores the expressions of a function, and returns its callees.
    fn collect_exprs(&mut self, function: FunctionId) -> Vec<FunctionId> {
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
        for variable in tree.global_variables() {
            if let Some(initializer) = tree[variable].initializer {
                self.definitions[variable.index()].push(Definition::Value(initializer));
            }
        }
        for &parameter in &tree[self.main].parameters {
            self.definitions[parameter.index()].push(Definition::External);
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
                        && let Some(initializer) = tree[variable].initializer
                    {
                        found.push((variable, Definition::Value(initializer)));
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

/// The maximum number of names that an analysis follows from a use to its definition.
pub(super) const MAX_RESOLVE_STEPS: usize = 64;

/// The last `most` elements: a bounded depth-first search visits no others.
pub(super) fn newest<T>(all: &[T], most: usize) -> &[T] {
    &all[all.len().saturating_sub(most)..]
}

/// The user-defined function that an expression calls.
pub(super) fn callee(tree: &Tree, expr: ExprId) -> Option<FunctionId> {
    match tree[expr].kind {
        ExprKind::Call { function, .. } => Some(function),
        _ => None,
    }
}

/// Whether a type is `float`, or a vector or matrix of floats.
pub(super) fn is_float(ty: Type) -> bool {
    ty.scalar() == Some(toyproof_glsl::tree::Scalar::Float)
}
