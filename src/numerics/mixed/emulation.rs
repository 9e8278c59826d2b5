//! A shader that rounds to 16 bits what `mediump` may compute in 16 bits, to the bit: results of operations
//! whose operands are all `mediump` or constants (GLSL ES 3.00.6 §4.5.2), and values of variables. Functions
//! such as `length` round the result of each of their operations; those such as `sin` round theirs.
//!
//! An operation on numbers of 11 bits in f32, rounded to 16 bits afterwards, has the result of the operation
//! in 16 bits: 24 bits are at least twice 11 and two more (Figueroa, “When is Double Rounding Innocuous?”,
//! 1995).

use std::collections::{BTreeSet, HashMap, HashSet};

use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    BuiltIn, Expr, ExprId, ExprKind, FunctionId, Place, Scalar, StatementKind, Tree, Type, VariableId, walk,
};

use super::library::Library;
use super::unit::{Subject, Unit, is_float};

/// What has 16 bits in a shader in which some declarations are `mediump`.
pub(super) struct Emulation<'a> {
    checked: &'a Checked,
    variables: HashSet<VariableId>,
    results: HashSet<FunctionId>,
    /// The operations in 16 bits.
    pub(super) operations: HashSet<ExprId>,
    /// The expressions whose values are rounded.
    rounded: BTreeSet<ExprId>,
    /// The compound assignments and steps after which a variable is rounded.
    updates: Vec<(ExprId, VariableId)>,
}

/// The precision of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Precision {
    /// A constant: that of the other operands.
    Any,
    Medium,
    High,
}

impl Precision {
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Any, other) | (other, Self::Any) => other,
            (Self::Medium, Self::Medium) => Self::Medium,
            _ => Self::High,
        }
    }
}

impl<'a> Emulation<'a> {
    pub(super) fn new<'u>(checked: &'a Checked, units: impl IntoIterator<Item = &'u Unit>) -> Self {
        let mut emulation = Self {
            checked,
            variables: HashSet::new(),
            results: HashSet::new(),
            operations: HashSet::new(),
            rounded: BTreeSet::new(),
            updates: Vec::new(),
        };
        for unit in units {
            match &unit.subject {
                Subject::Variables(all) => emulation.variables.extend(all),
                Subject::Result(function) => {
                    emulation.results.insert(*function);
                }
            }
        }
        emulation.find();
        emulation
    }

    /// Finds what has 16 bits.
    fn find(&mut self) {
        let tree = &self.checked.tree;
        let initialized = |variable: VariableId| tree[variable].initializer;
        for variable in tree.global_variables() {
            if let Some(initializer) = initialized(variable) {
                self.root(initializer);
                self.value_of(variable, initializer);
            }
        }
        for (id, function) in tree.functions.iter() {
            walk::each(function.body.as_deref().unwrap_or_default(), &mut |statement| {
                for root in walk::own_expressions(tree, statement) {
                    self.root(root);
                }
                match statement.kind {
                    StatementKind::Declare(variable) => {
                        if let Some(initializer) = initialized(variable) {
                            self.value_of(variable, initializer);
                        }
                    }
                    StatementKind::Return(Some(value)) if self.results.contains(&id) => self.round(value),
                    _ => {}
                }
            });
        }
    }

    /// Rounds the value that a variable gets, if it is `mediump`.
    fn value_of(&mut self, variable: VariableId, value: ExprId) {
        if self.variables.contains(&variable) {
            self.round(value);
        }
    }

    fn round(&mut self, value: ExprId) {
        if is_float(self.checked.tree[value].ty) {
            self.rounded.insert(value);
        }
    }

    /// Finds the operations of an expression, operands first.
    fn root(&mut self, root: ExprId) {
        let tree = &self.checked.tree;
        let mut precisions = HashMap::new();
        for id in tree.postorder(root) {
            let precision = self.precision(id, &precisions);
            self.writes(id);
            let kind = &tree[id].kind;
            let is_operation = matches!(
                kind,
                ExprKind::Binary { .. } | ExprKind::BuiltIn { .. } | ExprKind::Unary { .. }
            );
            let is_update = matches!(kind, ExprKind::Assign { op: Some(_), .. } | ExprKind::Step { .. });
            if is_float(tree[id].ty) && precision == Precision::Medium {
                if is_operation || is_update {
                    self.operations.insert(id);
                }
                if is_operation {
                    self.round(id);
                }
                // Parameters determine the precision of arguments.
                if !matches!(kind, ExprKind::Call { .. }) {
                    kind.for_each_operand(|operand| {
                        if precisions.get(&operand) == Some(&Precision::Any) {
                            self.round(operand);
                        }
                    });
                }
            }
            precisions.insert(id, precision);
        }
    }

    /// The precision of an expression, from those of its operands.
    fn precision(&self, id: ExprId, known: &HashMap<ExprId, Precision>) -> Precision {
        let tree = &self.checked.tree;
        let of = |operand: ExprId| known.get(&operand).copied().unwrap_or(Precision::High);
        let is_bool = matches!(
            tree[id].ty,
            Type::Scalar(Scalar::Bool) | Type::Vector(Scalar::Bool, _)
        );
        match &tree[id].kind {
            _ if is_bool => Precision::Any,
            ExprKind::Literal(_) => Precision::Any,
            ExprKind::Variable(variable) if self.variables.contains(variable) => Precision::Medium,
            ExprKind::Call { function, .. } if self.results.contains(function) => Precision::Medium,
            ExprKind::Variable(_) | ExprKind::Call { .. } => Precision::High,
            ExprKind::BuiltIn { function, .. } if is_of_high_precision(*function) => Precision::High,
            ExprKind::Index { base, .. } => of(*base),
            kind => {
                let mut precision = Precision::Any;
                kind.for_each_operand(|operand| precision = precision.and(of(operand)));
                precision
            }
        }
    }

    /// Rounds what an expression writes to `mediump` variables.
    fn writes(&mut self, id: ExprId) {
        let tree = &self.checked.tree;
        if let ExprKind::Call { function, arguments } = &tree[id].kind {
            for (&parameter, &argument) in tree[*function].parameters.iter().zip(arguments) {
                self.value_of(parameter, argument);
            }
        }
        tree.each_write(id, |target, value| {
            let Some(variable) = tree.root_variable(target) else {
                return;
            };
            if let Some(value) = value {
                self.value_of(variable, value);
            } else if self.variables.contains(&variable) {
                self.updates.push((id, variable));
            }
        });
    }

    /// The shader with all roundings.
    pub(super) fn shader(&self) -> Checked {
        let mut shader = self.checked.clone();
        let at = shader.tree[shader.main_image].at;
        let tree = &mut shader.tree;
        let library = Library::of(tree, at);
        for &id in &self.rounded {
            let value = tree[id].clone();
            let by_steps = match &value.kind {
                ExprKind::BuiltIn { function, arguments } if self.operations.contains(&id) => {
                    let types = arguments.iter().map(|&argument| tree[argument].ty).collect();
                    library
                        .built_in(function.name(), types)
                        .zip(Some(arguments.clone()))
                }
                _ => None,
            };
            match by_steps {
                Some((function, arguments)) => tree[id].kind = ExprKind::Call { function, arguments },
                None => tree[id] = rounded(tree, &library, value),
            }
        }
        for &(update, variable) in &self.updates {
            tree[update] = rounded_update(tree, &library, update, variable);
        }
        forget_constants(tree, self.rounded.iter().copied().collect());
        shader
    }
}

/// A value, rounded.
fn rounded(tree: &mut Tree, library: &Library, value: Expr) -> Expr {
    let Some(function) = library.rounding(value.ty) else {
        return value;
    };
    let (ty, at) = (value.ty, value.at);
    let arguments = vec![tree.exprs.push(value)];
    expr(ExprKind::Call { function, arguments }, ty, at)
}

/// A compound assignment or a step after which the variable is rounded: `v = round(v + x)`; or, if the target
/// has an index, `v[i++] += x, v = round(v)`.
fn rounded_update(tree: &mut Tree, library: &Library, update: ExprId, variable: VariableId) -> Expr {
    let first = tree[update].clone();
    let at = first.at;
    let assign = |tree: &mut Tree, target, value: Expr| {
        let ty = value.ty;
        let value = rounded(tree, library, value);
        let value = tree.exprs.push(value);
        let op = None;
        expr(ExprKind::Assign { op, target, value }, ty, at)
    };
    if let ExprKind::Assign {
        op: Some(op),
        target,
        value,
    } = first.kind
        && let Some(left) = read_again(tree, target)
    {
        let right = value;
        return assign(
            tree,
            target,
            expr(ExprKind::Binary { op, left, right }, first.ty, at),
        );
    }
    let whole = expr(ExprKind::Variable(variable), tree[variable].ty, at);
    let ty = whole.ty;
    let target = tree.exprs.push(whole.clone());
    let second = assign(tree, target, whole);
    let [first, second] = [first, second].map(|part| tree.exprs.push(part));
    expr(ExprKind::Sequence { first, second }, ty, at)
}

/// A copy of an lvalue without indices, to read it.
fn read_again(tree: &mut Tree, target: ExprId) -> Option<ExprId> {
    let mut read = tree[target].clone();
    match &mut read.kind {
        ExprKind::Variable(_) => {}
        ExprKind::Swizzle { vector, .. } => *vector = read_again(tree, *vector)?,
        _ => return None,
    }
    Some(tree.exprs.push(read))
}

/// Takes expressions, and what is computed from them, for expressions that are not constant.
fn forget_constants(tree: &mut Tree, mut changed: Vec<ExprId>) {
    let mut parents = HashMap::new();
    for (id, expr) in tree.exprs.iter() {
        expr.kind.for_each_operand(|operand| {
            parents.insert(operand, id);
        });
    }
    while let Some(id) = changed.pop() {
        tree[id].constant = false;
        changed.extend(parents.get(&id).filter(|&&parent| tree[parent].constant));
    }
    for id in tree.variables.ids() {
        let initializer = tree[id].initializer;
        if initializer.is_some_and(|initializer| !tree[initializer].constant) {
            tree[id].value = None;
        }
    }
}

fn expr(kind: ExprKind, ty: Type, at: Place) -> Expr {
    Expr {
        kind,
        ty,
        constant: false,
        at,
    }
}

/// Built-in functions whose results have another precision than their arguments: those of textures, and of
/// bits.
fn is_of_high_precision(function: BuiltIn) -> bool {
    use BuiltIn::{IntBitsToFloat, UintBitsToFloat, UnpackHalf2x16, UnpackSnorm2x16, UnpackUnorm2x16};
    function.is_texture()
        || matches!(
            function,
            IntBitsToFloat | UintBitsToFloat | UnpackHalf2x16 | UnpackSnorm2x16 | UnpackUnorm2x16
        )
}
