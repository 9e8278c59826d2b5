//! The text of a shader that rounds to 16 bits what `mediump` may compute in 16 bits, to the bit: results of
//! operations whose operands are all `mediump` or constants (GLSL ES 3.00.6 §4.5.2), and values of variables.
//!
//! An operation on numbers of 11 bits in f32, rounded to 16 bits afterwards, has the result of the operation
//! in 16 bits: 24 bits are at least twice 11 and two more (Figueroa, “When is Double Rounding Innocuous?”,
//! 1995).

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::Span;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{BuiltIn, ExprId, ExprKind, FunctionId, StatementKind, Tree, VariableId, walk};

use super::unit::{Subject, Unit, is_float};

/// Rounds a float, and the components of a vector, to 16 bits.
const FUNCTIONS: &str = "\
vec2 toyproof_half(vec2 v) { return unpackHalf2x16(packHalf2x16(v)); }
float toyproof_half(float x) { return toyproof_half(vec2(x)).x; }
vec3 toyproof_half(vec3 v) { return vec3(toyproof_half(v.xy), toyproof_half(v.z)); }
vec4 toyproof_half(vec4 v) { return vec4(toyproof_half(v.xy), toyproof_half(v.zw)); }
";

/// A shader in which some declarations are `mediump`.
pub(super) struct Emulation<'a> {
    tree: &'a Tree,
    text: &'a str,
    variables: HashSet<VariableId>,
    results: HashSet<FunctionId>,
    /// Texts to insert, with their places.
    insertions: Vec<(u32, Part, String)>,
    /// The operations in 16 bits.
    pub(super) operations: HashSet<ExprId>,
}

/// What is inserted, in the order at one place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Close,
    Statement,
    Open,
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
    pub(super) fn new<'u>(
        checked: &'a Checked,
        text: &'a str,
        units: impl IntoIterator<Item = &'u Unit>,
    ) -> Self {
        let mut variables = HashSet::new();
        let mut results = HashSet::new();
        for unit in units {
            match &unit.subject {
                Subject::Variables(all) => variables.extend(all.iter().copied()),
                Subject::Result(function) => {
                    results.insert(*function);
                }
            }
        }
        let mut emulation = Self {
            tree: &checked.tree,
            text,
            variables,
            results,
            insertions: Vec::new(),
            operations: HashSet::new(),
        };
        emulation.rounds_everything();
        emulation
    }

    /// The text with all roundings.
    pub(super) fn text(mut self) -> String {
        let text = self.text;
        self.insertions.sort_by_key(|&(at, part, _)| (at, part));
        let mut edited = String::from(FUNCTIONS);
        let mut from = 0;
        for (at, _, inserted) in &self.insertions {
            edited += &text[from..*at as usize];
            edited += inserted;
            from = *at as usize;
        }
        edited + &text[from..]
    }

    fn rounds_everything(&mut self) {
        let tree = self.tree;
        for variable in tree.global_variables() {
            if let Some(initializer) = tree[variable].initializer {
                self.root(initializer);
                self.value_of(variable, initializer);
            }
        }
        for (id, function) in tree.functions.iter() {
            let Some(body) = &function.body else {
                continue;
            };
            walk::each(body, &mut |statement| {
                for root in walk::own_expressions(tree, statement) {
                    self.root(root);
                }
                match statement.kind {
                    StatementKind::Declare(variable) => {
                        if let Some(initializer) = tree[variable].initializer {
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

    /// Rounds the operations of an expression, operands first.
    fn root(&mut self, root: ExprId) {
        let tree = self.tree;
        let mut precisions = HashMap::new();
        for id in tree.postorder(root) {
            let expr = &tree[id];
            let mut of_operands = Precision::Any;
            expr.kind.for_each_operand(|operand| {
                let known = precisions.get(&operand).copied().unwrap_or(Precision::High);
                of_operands = of_operands.and(known);
            });
            let precision = match &expr.kind {
                ExprKind::Literal(_) => Precision::Any,
                ExprKind::Variable(variable) if self.variables.contains(variable) => Precision::Medium,
                ExprKind::Variable(_) => Precision::High,
                ExprKind::Call { function, arguments } => {
                    for (&parameter, &argument) in tree[*function].parameters.iter().zip(arguments) {
                        self.value_of(parameter, argument);
                    }
                    if self.results.contains(function) {
                        Precision::Medium
                    } else {
                        Precision::High
                    }
                }
                ExprKind::BuiltIn { function, .. } if is_of_high_precision(*function) => Precision::High,
                ExprKind::Assign { target, value, op } => {
                    let variable = tree.root_variable(*target);
                    if variable.is_some_and(|variable| self.variables.contains(&variable)) {
                        self.assign(*target, *value, op.is_some());
                    }
                    of_operands
                }
                _ => of_operands,
            };
            let is_operation = matches!(
                expr.kind,
                ExprKind::Binary { .. } | ExprKind::BuiltIn { .. } | ExprKind::Unary { .. }
            );
            let is_compound = matches!(expr.kind, ExprKind::Assign { op: Some(_), .. });
            if (is_operation || is_compound) && is_float(expr.ty) && precision == Precision::Medium {
                self.operations.insert(id);
                if is_operation {
                    self.round(id);
                }
            }
            precisions.insert(id, precision);
        }
    }

    /// `v = x` becomes `v = half(x)`, and `v += x` becomes `v += x, v = half(v)`.
    fn assign(&mut self, target: ExprId, value: ExprId, is_compound: bool) {
        if is_compound {
            let target = self.tree[target].at.span;
            let target = &self.text[target.start as usize..target.end as usize];
            let end = self.tree[value].at.span.end;
            self.insertions.push((
                end,
                Part::Statement,
                format!(", {target} = toyproof_half({target})"),
            ));
        } else {
            self.round(value);
        }
    }

    fn round(&mut self, expr: ExprId) {
        let at = self.tree[expr].at;
        if at.is_expanded() || !is_float(self.tree[expr].ty) {
            return;
        }
        let Span { start, end, .. } = at.span;
        self.insertions
            .push((start, Part::Open, "toyproof_half(".to_owned()));
        self.insertions.push((end, Part::Close, ")".to_owned()));
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
