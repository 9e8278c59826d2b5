//! One use of a macro, as the call of a function.

use std::collections::{BTreeMap, HashMap, HashSet};

use toyproof_diagnostic::Span;
use toyproof_glsl::Lexeme;
use toyproof_glsl::tree::{
    BinaryOp, Direction, Expr, ExprId, ExprKind, Function, FunctionId, Item, Place, Scalar, Statement,
    StatementKind, Tree, Type, Variable, VariableId, VariableKind,
};

use super::uses::{MacroUse, Source, contains};
use crate::lower::context::LoweringContext;

/// Words before an expression that is not all of a replacement.
const BEFORE_EXPRESSIONS: [&str; 4] = ["return", "case", "else", "do"];

/// The functions by macro, types of arguments and type of the value, each with the value that it returns.
pub(super) type Functions = HashMap<(Span, Vec<Type>, Type), (FunctionId, ExprId)>;

/// An expression that is all that a use of a macro expands to.
pub(super) struct Expansion<'a> {
    source: &'a Source<'a>,
    used: &'a MacroUse<'a>,
    root: ExprId,
    /// The expressions outside of the arguments, users before operands.
    nodes: Vec<ExprId>,
    /// The occurrences of the arguments.
    parameters: BTreeMap<ExprId, usize>,
    /// The first occurrence of each argument.
    arguments: Vec<ExprId>,
}

impl<'a> Expansion<'a> {
    /// `None` if the expression is more or less than what the use expands to, or if its arguments cannot be
    /// evaluated first.
    pub(super) fn new(
        tree: &Tree,
        source: &'a Source<'a>,
        used: &'a MacroUse<'a>,
        root: ExprId,
    ) -> Option<Self> {
        let mut expansion = Self {
            source,
            used,
            root,
            nodes: Vec::new(),
            parameters: BTreeMap::new(),
            arguments: Vec::new(),
        };
        let occurrences = expansion.occurrences(tree)?;
        let written = used.definition.body.iter().filter_map(|token| {
            let text = source.text(token.span);
            expansion.parameter_named(text)
        });
        let is_whole = occurrences.iter().map(|found| found.parameter).eq(written)
            && expansion.has_end(tree, End::First)
            && expansion.has_end(tree, End::Last);
        // A replacement that is only a parameter has no function.
        if !is_whole || expansion.nodes.is_empty() {
            return None;
        }
        for parameter in 0..used.arguments.len() {
            let mut of_parameter = occurrences.iter().filter(|found| found.parameter == parameter);
            let first = of_parameter.clone().next()?.expr;
            let is_conditional = of_parameter.clone().all(|found| found.is_conditional);
            let is_equal = of_parameter.all(|other| is_same(tree, first, other.expr, |_| None));
            if !is_equal || is_conditional && !is_total(tree, first) {
                return None;
            }
            expansion.arguments.push(first);
        }
        Some(expansion)
    }

    /// Finds the arguments and the other expressions; `None` if an operand is neither an argument nor text of
    /// a macro.
    fn occurrences(&mut self, tree: &Tree) -> Option<Vec<Occurrence>> {
        let mut occurrences = Vec::new();
        let mut pending = vec![(self.root, false)];
        while let Some((id, is_conditional)) = pending.pop() {
            if let Some(parameter) = self.parameter_at(tree, id) {
                self.parameters.insert(id, parameter);
                occurrences.push(Occurrence {
                    parameter,
                    expr: id,
                    is_conditional,
                });
                continue;
            }
            self.nodes.push(id);
            let kind = &tree[id].kind;
            let from = pending.len();
            kind.for_each_operand(|operand| {
                pending.push((operand, is_conditional || evaluates_conditionally(kind, operand)));
            });
            if pending.len() == from && !self.is_of_macro(tree[id].at) {
                return None;
            }
            pending[from..].reverse();
        }
        Some(occurrences)
    }

    /// The parameter that an expression is the argument of. Conversions of an argument, and operations on
    /// two occurrences of one, are at its place too.
    fn parameter_at(&self, tree: &Tree, id: ExprId) -> Option<usize> {
        let at = tree[id].at;
        let mut is_at_operand = false;
        tree[id]
            .kind
            .for_each_operand(|operand| is_at_operand |= tree[operand].at == at);
        if is_at_operand {
            return None;
        }
        if let Some(parameter) = self.used.arguments.iter().position(|&text| text == at.span) {
            return Some(parameter);
        }
        // Parentheses of the replacement around an argument are its place.
        let parenthesized = self.source.without_parentheses(at.spelling);
        let name = self
            .is_in_replacement(at)
            .then(|| self.source.text(parenthesized));
        self.parameter_named(name?)
    }

    fn parameter_named(&self, name: &str) -> Option<usize> {
        let mut names = self.used.definition.parameters.iter();
        names.position(|&parameter| self.source.text(parameter) == name)
    }

    /// Whether a place is text of the replacement.
    fn is_in_replacement(&self, at: Place) -> bool {
        at.is_expanded()
            && at.span == self.used.span
            && contains(self.used.definition.replacement, at.spelling)
    }

    /// Whether an operand at a place is text of the replacement or of a macro that it names, and not an
    /// argument in parentheses of that macro.
    fn is_of_macro(&self, at: Place) -> bool {
        let is_expanded = at.is_expanded() && at.span == self.used.span;
        let is_argument = || !self.is_in_replacement(at) && self.source.text(at.spelling).starts_with('(');
        is_expanded && !is_argument()
    }

    /// Whether the expression has the first or the last token of the replacement.
    fn has_end(&self, tree: &Tree, end: End) -> bool {
        let body = self.used.definition.body;
        let token = match end {
            End::First => body.first(),
            End::Last => body.last(),
        };
        let Some(&Lexeme { span: token, .. }) = token else {
            return false;
        };
        let text = self.source.text(token);
        let mut id = self.root;
        loop {
            let at = tree[id].at;
            if self.is_in_replacement(at) {
                return match end {
                    End::First => at.spelling.start == token.start,
                    End::Last => at.spelling.end == token.end,
                };
            }
            if let Some(&parameter) = self.parameters.get(&id) {
                return self.parameter_named(text) == Some(parameter);
            }
            let kind = &tree[id].kind;
            if let Some(operand) = operand_at(kind, end) {
                id = operand;
                continue;
            }
            // The places of operators are not in the tree.
            return match (kind, end) {
                (ExprKind::Unary { op, .. }, End::First) => text == op.symbol(),
                (ExprKind::Index { .. }, End::Last) => text == "]",
                (ExprKind::Swizzle { .. } | ExprKind::Member { .. }, End::Last) => {
                    let before = body.len().checked_sub(2).and_then(|at| body.get(at));
                    before.is_some_and(|dot| self.source.text(dot.span) == ".")
                }
                // Text of another macro.
                (_, End::First) => is_name(text) && !BEFORE_EXPRESSIONS.contains(&text),
                (_, End::Last) => is_name(text) || text == ")",
            };
        }
    }

    /// Whether the expression names no local variable or structure, and has types that functions may have
    /// in every language.
    pub(super) fn is_global(&self, tree: &Tree, globals: &HashSet<Item>) -> bool {
        let is_item = |item: Item| globals.contains(&item);
        let is_type = |ty: Type| match ty {
            Type::Struct(id) => is_item(Item::Struct(id)),
            Type::Scalar(_) | Type::Vector(..) | Type::Matrix { .. } => true,
            Type::Void | Type::Array(_) | Type::Sampler(_) | Type::Error => false,
        };
        let has_types = self
            .arguments
            .iter()
            .chain([&self.root])
            .all(|&id| is_type(tree[id].ty));
        has_types
            && self.nodes.iter().all(|&id| match tree[id].kind {
                ExprKind::Variable(variable) => match tree[variable].kind {
                    VariableKind::Const => is_item(Item::Variable(variable)),
                    VariableKind::Local | VariableKind::Parameter(_) | VariableKind::Output => false,
                    _ => true,
                },
                ExprKind::Construct { .. } => is_type(tree[id].ty),
                _ => true,
            })
    }

    /// Replaces the expression by a call, unless it differs from the first use with these types.
    pub(super) fn call(
        &self,
        cx: &mut LoweringContext,
        parents: &HashMap<ExprId, ExprId>,
        functions: &mut Functions,
    ) {
        let types = self.arguments.iter().map(|&argument| cx.tree[argument].ty);
        let key = (self.used.definition.name, types.collect(), cx.tree[self.root].ty);
        let &mut (function, value) = functions.entry(key).or_insert_with(|| self.define(cx));
        let parameters = &cx.tree[function].parameters;
        let parameter = |id| self.parameters.get(&id).map(|&parameter| parameters[parameter]);
        if !is_same(&cx.tree, self.root, value, parameter) {
            return;
        }
        cx.tree[self.root].at = Place::plain(self.used.span);
        cx.tree[self.root].kind = ExprKind::Call {
            function,
            arguments: self.arguments.clone(),
        };
        let mut changed = Some(self.root);
        while let Some(id) = changed.filter(|&id| cx.tree[id].constant) {
            cx.tree[id].constant = false;
            cx.tree.clear_cached_value(id);
            changed = parents.get(&id).copied();
        }
    }

    /// Adds the function, where the macro is defined.
    fn define(&self, cx: &mut LoweringContext) -> (FunctionId, ExprId) {
        let tree = &mut cx.tree;
        let definition = &self.used.definition;
        let parameters = definition.parameters.iter().zip(&self.arguments);
        let parameters: Vec<VariableId> = parameters
            .map(|(&name, &argument)| {
                // Arguments are read in the order of the replacement, like operands.
                let kind = VariableKind::Parameter(Direction::ConstIn);
                let (ty, at) = (tree[argument].ty, Place::plain(name));
                tree.variables
                    .push(Variable::new(self.source.text(name), ty, kind, Some(at)))
            })
            .collect();
        let value = self.copy(tree, &parameters);
        let function = tree.functions.push(Function {
            name: self.source.text(definition.name).to_owned(),
            return_type: tree[self.root].ty,
            parameters,
            body: Some(vec![Statement::new(
                StatementKind::Return(Some(value)),
                Place::plain(definition.replacement),
            )]),
            at: Place::plain(definition.name),
        });
        let start = |item: &Item| match *item {
            Item::Variable(id) => tree[id].at,
            Item::Struct(id) => Some(tree[id].at),
            Item::Function(id) | Item::Prototype(id) => Some(tree[id].at),
        };
        let is_after = |item| start(item).is_some_and(|at| at.span.start > definition.name.start);
        let place = tree.items.iter().position(is_after);
        let place = place.unwrap_or(tree.items.len());
        tree.items.insert(place, Item::Function(function));
        (function, value)
    }

    /// Copies the expression, with parameters in place of the arguments.
    fn copy(&self, tree: &mut Tree, parameters: &[VariableId]) -> ExprId {
        let mut copies = HashMap::new();
        for (&id, &parameter) in &self.parameters {
            let variable = Expr {
                kind: ExprKind::Variable(parameters[parameter]),
                constant: false,
                ..tree[id].clone()
            };
            copies.insert(id, tree.exprs.push(variable));
        }
        for &id in self.nodes.iter().rev() {
            let mut node = tree[id].clone();
            node.kind.for_each_operand_mut(|operand| {
                *operand = copies[operand];
                node.constant &= tree[*operand].constant;
            });
            copies.insert(id, tree.exprs.push(node));
        }
        copies[&self.root]
    }
}

/// An argument in an expansion.
struct Occurrence {
    parameter: usize,
    expr: ExprId,
    /// Whether it is evaluated under a condition.
    is_conditional: bool,
}

/// An end of a replacement.
#[derive(Clone, Copy)]
enum End {
    First,
    Last,
}

/// The operand that an expression begins or ends with.
fn operand_at(kind: &ExprKind, end: End) -> Option<ExprId> {
    let (first, last) = match *kind {
        ExprKind::Unary { operand, .. } => (None, Some(operand)),
        ExprKind::Binary { left, right, .. } => (Some(left), Some(right)),
        ExprKind::Conditional { condition, no, .. } => (Some(condition), Some(no)),
        ExprKind::Sequence { first, second } => (Some(first), Some(second)),
        ExprKind::Index { base: operand, .. }
        | ExprKind::Swizzle { vector: operand, .. }
        | ExprKind::Member {
            structure: operand, ..
        } => (Some(operand), None),
        _ => (None, None),
    };
    match end {
        End::First => first,
        End::Last => last,
    }
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

/// Whether an operand is evaluated only for some values of another one.
fn evaluates_conditionally(kind: &ExprKind, operand: ExprId) -> bool {
    match *kind {
        ExprKind::Conditional { yes, no, .. } => operand == yes || operand == no,
        ExprKind::Binary {
            op: BinaryOp::And | BinaryOp::Or,
            right,
            ..
        } => operand == right,
        _ => false,
    }
}

/// Whether an expression is cheap and has a value where the author does not evaluate it.
fn is_total(tree: &Tree, root: ExprId) -> bool {
    tree.postorder(root).into_iter().all(|id| match tree[id].kind {
        ExprKind::Call { .. } | ExprKind::Index { .. } => false,
        ExprKind::BuiltIn { function, .. } => !function.is_texture() && !function.is_derivative(),
        // Integers are not divided by zero, nor shifted by too much.
        ExprKind::Binary { op, .. } => {
            let may_fail = matches!(
                op,
                BinaryOp::Divide | BinaryOp::Remainder | BinaryOp::ShiftLeft | BinaryOp::ShiftRight
            );
            !may_fail || tree[id].ty.scalar() == Some(Scalar::Float)
        }
        _ => true,
    })
}

/// Whether two expressions are the same operations on the same operands, where variables of the second may
/// stand for operands of the first.
fn is_same(
    tree: &Tree,
    left: ExprId,
    right: ExprId,
    variable: impl Fn(ExprId) -> Option<VariableId>,
) -> bool {
    // The kinds are compared without the ids of their operands.
    let bare = |id: ExprId| {
        let mut kind = tree[id].kind.clone();
        kind.for_each_operand_mut(|operand| *operand = left);
        kind
    };
    let operands = |id: ExprId| {
        let mut operands = Vec::new();
        tree[id].kind.for_each_operand(|operand| operands.push(operand));
        operands
    };
    let mut pending = vec![(left, right)];
    while let Some((left, right)) = pending.pop() {
        if let Some(variable) = variable(left) {
            if !matches!(tree[right].kind, ExprKind::Variable(other) if other == variable) {
                return false;
            }
            continue;
        }
        if tree[left].ty != tree[right].ty || bare(left) != bare(right) {
            return false;
        }
        pending.extend(operands(left).into_iter().zip(operands(right)));
    }
    true
}
