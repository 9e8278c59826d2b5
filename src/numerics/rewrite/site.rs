//! What a rewriting rule sees of a shader: an expression, its parts, and the definitions of its variables.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, ExprId, ExprKind, Scalar, Tree, Type, UnaryOp, Value, VariableId, VariableKind, walk,
};

/// The most definitions of variables that are followed from an expression.
const MAX_DEFINITIONS: usize = 4;

/// The most products in each other of which the factors are one product.
const MAX_DEPTH: usize = 8;

/// The most operators and operands of an expression that is rewritten, or whose value a variable is followed
/// to: rules compare its terms in pairs, and repeat their texts.
const MAX_PARTS: usize = 120;

/// The most places to which a number is followed.
const MAX_PLACES: usize = 1000;

/// A shader with the definitions of its variables.
#[derive(Debug)]
pub(super) struct Definitions<'a> {
    pub(super) tree: &'a Tree,
    text: &'a str,
    /// The only value of each variable that is never assigned again.
    values: HashMap<VariableId, ExprId>,
    /// The only assignment to each variable that has one, and its operator is `+=`.
    added: HashMap<VariableId, ExprId>,
    /// The variables of which an expression is the initializer.
    initialized: HashMap<ExprId, VariableId>,
    /// Where each variable is read or written.
    uses: HashMap<VariableId, Vec<ExprId>>,
    parents: HashMap<ExprId, ExprId>,
    /// The expressions of at most [`MAX_PARTS`].
    short: HashSet<ExprId>,
}

/// A term of a sum.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub(super) is_negative: bool,
    pub(super) expr: ExprId,
}

impl<'a> Definitions<'a> {
    pub(super) fn new(checked: &'a Checked, text: &'a str) -> Self {
        let tree = &checked.tree;
        let mut writes: HashMap<VariableId, usize> = HashMap::new();
        let mut assigned: HashMap<VariableId, ExprId> = HashMap::new();
        let mut added: HashMap<VariableId, ExprId> = HashMap::new();
        let mut uses: HashMap<VariableId, Vec<ExprId>> = HashMap::new();
        let mut parents = HashMap::new();
        for id in tree.exprs.ids() {
            if let ExprKind::Variable(variable) = tree[id].kind {
                uses.entry(variable).or_default().push(id);
            }
            tree[id].kind.for_each_operand(|operand| {
                parents.insert(operand, id);
            });
            tree.each_write(id, |target, value| {
                if let Some(variable) = tree.root_variable(target) {
                    *writes.entry(variable).or_default() += 1;
                    if let ExprKind::Assign {
                        op: Some(BinaryOp::Add),
                        ..
                    } = tree[id].kind
                    {
                        added.insert(variable, id);
                    }
                    let is_whole = matches!(tree[target].kind, ExprKind::Variable(_));
                    if let Some(value) = value.filter(|_| is_whole) {
                        assigned.insert(variable, value);
                    }
                }
            });
        }
        let mut sizes: HashMap<ExprId, usize> = HashMap::new();
        let roots = tree.exprs.ids().filter(|id| !parents.contains_key(id));
        for expr in roots.flat_map(|root| tree.postorder(root)) {
            let mut size = 1;
            tree[expr]
                .kind
                .for_each_operand(|operand| size += sizes.get(&operand).copied().unwrap_or(0));
            sizes.insert(expr, size);
        }
        let short = sizes.into_iter().filter(|(_, size)| *size <= MAX_PARTS);
        let short: HashSet<ExprId> = short.map(|(expr, _)| expr).collect();
        let values = tree.variables.iter().filter_map(|(id, variable)| {
            let is_local = matches!(
                variable.kind,
                VariableKind::Local | VariableKind::Const | VariableKind::Global
            );
            let value = match (writes.get(&id), variable.initializer) {
                (None, initializer) => initializer,
                (Some(1), None) => assigned.get(&id).copied(),
                _ => None,
            };
            Some((id, value.filter(|value| is_local && short.contains(value))?))
        });
        let values = values.collect();
        Self {
            tree,
            text,
            values,
            short,
            initialized: tree
                .variables
                .iter()
                .filter_map(|(id, variable)| Some((variable.initializer?, id)))
                .collect(),
            uses,
            parents,
            added: added
                .into_iter()
                .filter(|(variable, _)| writes.get(variable) == Some(&1))
                .collect(),
        }
    }

    /// The expressions of all functions and global variables, without long ones.
    pub(super) fn sites(&self) -> Vec<ExprId> {
        let initializers = self
            .tree
            .global_variables()
            .filter_map(|variable| self.tree[variable].initializer);
        let mut sites: Vec<ExprId> = initializers.flat_map(|root| self.tree.postorder(root)).collect();
        for (_, function) in self.tree.functions.iter() {
            let Some(body) = &function.body else {
                continue;
            };
            walk::each(body, &mut |statement| {
                for root in walk::own_expressions(self.tree, statement) {
                    sites.extend(self.tree.postorder(root));
                }
            });
        }
        sites.retain(|site| self.short.contains(site));
        sites.sort_unstable();
        sites.dedup();
        sites
    }

    pub(super) fn ty(&self, expr: ExprId) -> Type {
        self.tree[expr].ty
    }

    pub(super) fn is_float(&self, expr: ExprId) -> bool {
        self.ty(expr) == Type::FLOAT
    }

    /// The number of components of a float or a vector of floats.
    pub(super) fn components(&self, expr: ExprId) -> Option<u8> {
        match self.ty(expr) {
            Type::Scalar(Scalar::Float) => Some(1),
            Type::Vector(Scalar::Float, size) => Some(size),
            _ => None,
        }
    }

    /// The text of an expression, in parentheses where an operand needs them; `None` inside of a macro, of
    /// which the text is not that of the expression.
    pub(super) fn text(&self, expr: ExprId) -> Option<String> {
        let at = self.tree[expr].at;
        let text = self.text.get(at.span.start as usize..at.span.end as usize)?;
        let is_leaf = matches!(self.tree[expr].kind, ExprKind::Literal(_) | ExprKind::Variable(_));
        if at.is_expanded() && !is_leaf {
            return None;
        }
        let is_primary = matches!(
            self.tree[expr].kind,
            ExprKind::Literal(_)
                | ExprKind::Variable(_)
                | ExprKind::Call { .. }
                | ExprKind::BuiltIn { .. }
                | ExprKind::Swizzle { .. }
                | ExprKind::Member { .. }
                | ExprKind::Index { .. }
        );
        let is_one_line = !text.contains("//") && !text.contains("/*");
        is_one_line.then(|| {
            if is_primary || is_in_parentheses(text) {
                text.to_owned()
            } else {
                format!("({text})")
            }
        })
    }

    /// Whether two expressions are written alike.
    pub(super) fn same(&self, one: ExprId, other: ExprId) -> bool {
        let text = |expr| Some(self.text(expr)?.split_whitespace().collect::<String>());
        one == other || text(one).is_some_and(|one| Some(one) == text(other))
    }

    /// The value of a variable that has only one; any other expression itself.
    pub(super) fn resolve(&self, expr: ExprId) -> ExprId {
        let mut expr = expr;
        for _ in 0..MAX_DEFINITIONS {
            match self.tree[expr].kind {
                ExprKind::Variable(variable) => match self.values.get(&variable) {
                    Some(&value) => expr = value,
                    None => break,
                },
                _ => break,
            }
        }
        expr
    }

    /// The only assignment to a variable, whose operator is `+=`.
    pub(super) fn added(&self, variable: VariableId) -> Option<ExprId> {
        self.added.get(&variable).copied()
    }

    pub(super) fn binary(&self, expr: ExprId, wanted: BinaryOp) -> Option<(ExprId, ExprId)> {
        match self.tree[expr].kind {
            ExprKind::Binary { op, left, right } if op == wanted => Some((left, right)),
            _ => None,
        }
    }

    pub(super) fn negated(&self, expr: ExprId) -> Option<ExprId> {
        match self.tree[expr].kind {
            ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => Some(operand),
            _ => None,
        }
    }

    /// The arguments of a call of a built-in function.
    pub(super) fn call(&self, expr: ExprId, wanted: BuiltIn) -> Option<&'a [ExprId]> {
        match &self.tree[expr].kind {
            ExprKind::BuiltIn { function, arguments } if *function == wanted => Some(arguments),
            _ => None,
        }
    }

    /// The only argument of a call.
    pub(super) fn argument(&self, expr: ExprId, wanted: BuiltIn) -> Option<ExprId> {
        match self.call(expr, wanted)? {
            &[argument] => Some(argument),
            _ => None,
        }
    }

    /// What `clamp`, `min` and `max` with numbers limit; any other expression itself.
    pub(super) fn unclamped(&self, expr: ExprId) -> ExprId {
        let value = self.resolve(expr);
        let functions = [BuiltIn::Clamp, BuiltIn::Min, BuiltIn::Max];
        let arguments = functions
            .into_iter()
            .find_map(|function| self.call(value, function));
        let inner = arguments
            .and_then(|arguments| arguments.iter().copied().find(|&one| self.literal(one).is_none()));
        inner.unwrap_or(expr)
    }

    /// The value of a literal, also converted to a float or in all components.
    pub(super) fn literal(&self, expr: ExprId) -> Option<f64> {
        match &self.tree[expr].kind {
            ExprKind::Literal(literal) => match literal.value {
                Value::Float(value) => Some(value),
                Value::Int(value) => Some(f64::from(value)),
                _ => None,
            },
            ExprKind::Construct { arguments, .. } => match arguments[..] {
                [argument] => self.literal(argument),
                _ => None,
            },
            _ => None,
        }
    }

    pub(super) fn is_literal(&self, expr: ExprId, value: f64) -> bool {
        self.literal(expr) == Some(value)
    }

    /// The terms of a sum.
    pub(super) fn terms(&self, expr: ExprId) -> Vec<Term> {
        let mut terms = Vec::new();
        let mut pending = vec![Term {
            is_negative: false,
            expr,
        }];
        while let Some(term) = pending.pop() {
            let with = |expr, negates: bool| Term {
                is_negative: term.is_negative != negates,
                expr,
            };
            match self.tree[term.expr].kind {
                ExprKind::Binary {
                    op: op @ (BinaryOp::Add | BinaryOp::Subtract),
                    left,
                    right,
                } => {
                    pending.push(with(right, op == BinaryOp::Subtract));
                    pending.push(with(left, false));
                }
                ExprKind::Unary {
                    op: UnaryOp::Minus,
                    operand,
                } => pending.push(with(operand, true)),
                _ => terms.push(term),
            }
        }
        terms
    }

    /// The factors of a product.
    pub(super) fn factors(&self, expr: ExprId) -> Vec<ExprId> {
        let mut factors = Vec::new();
        let mut pending = vec![expr];
        while let Some(expr) = pending.pop() {
            match self.binary(expr, BinaryOp::Multiply) {
                Some((left, right)) => pending.extend([right, left]),
                None => factors.push(expr),
            }
        }
        factors
    }

    /// The factors of a product, also those of the variables in it.
    pub(super) fn all_factors(&self, expr: ExprId) -> Vec<ExprId> {
        let mut factors = Vec::new();
        let mut pending = vec![(expr, 0)];
        while let Some((expr, depth)) = pending.pop() {
            match self.binary(self.resolve(expr), BinaryOp::Multiply) {
                Some((left, right)) if depth < MAX_DEPTH => {
                    pending.extend([(right, depth + 1), (left, depth + 1)]);
                }
                _ => factors.push(expr),
            }
        }
        factors
    }

    /// The terms of a sum, also those of the variables in it.
    pub(super) fn all_terms(&self, expr: ExprId) -> Vec<Term> {
        let whole = self.terms(expr);
        let resolved = whole.into_iter().flat_map(|term| {
            let inner = self.terms(self.resolve(term.expr));
            inner.into_iter().map(move |one| Term {
                is_negative: one.is_negative != term.is_negative,
                ..one
            })
        });
        resolved.collect()
    }

    /// Whether a number is added to what is not a constant, as the step of a difference quotient is: by
    /// itself, as a part of a vector, times a constant or a vector, or as a variable or a parameter.
    pub(super) fn is_step(&self, literal: ExprId) -> bool {
        let mut pending = vec![literal];
        let mut seen = HashSet::new();
        while let Some(carrier) = pending.pop() {
            if seen.len() == MAX_PLACES {
                return false;
            }
            if !seen.insert(carrier) {
                continue;
            }
            let uses = |variable| self.uses.get(&variable).into_iter().flatten().copied();
            if let Some(&variable) = self.initialized.get(&carrier) {
                pending.extend(uses(variable));
            }
            let Some(&parent) = self.parents.get(&carrier) else {
                continue;
            };
            match &self.tree[parent].kind {
                &ExprKind::Binary { op, left, right } => {
                    let other = if left == carrier { right } else { left };
                    match op {
                        BinaryOp::Add | BinaryOp::Subtract if !self.is_constant(other) => return true,
                        BinaryOp::Add | BinaryOp::Subtract => pending.push(parent),
                        BinaryOp::Multiply | BinaryOp::Divide
                            if self.is_constant(other)
                                || self.components(other).is_some_and(|size| size > 1) =>
                        {
                            pending.push(parent);
                        }
                        _ => {}
                    }
                }
                ExprKind::Unary { .. } | ExprKind::Construct { .. } | ExprKind::Swizzle { .. } => {
                    pending.push(parent);
                }
                ExprKind::Call { function, arguments } => {
                    let parameters = self.tree[*function].parameters.iter().zip(arguments);
                    let own = parameters.filter(|&(_, &argument)| argument == carrier);
                    pending.extend(own.flat_map(|(&parameter, _)| uses(parameter)));
                }
                _ => {}
            }
        }
        false
    }

    /// Whether an expression consists of numbers, and variables with such values.
    fn is_constant(&self, expr: ExprId) -> bool {
        self.short.contains(&expr)
            && self
                .tree
                .postorder(expr)
                .into_iter()
                .all(|part| match self.tree[part].kind {
                    ExprKind::Variable(variable) => self.values.get(&variable).is_some_and(|&value| {
                        let parts = self.tree.postorder(value);
                        parts.into_iter().all(|part| {
                            !matches!(
                                self.tree[part].kind,
                                ExprKind::Variable(_) | ExprKind::Call { .. }
                            )
                        })
                    }),
                    ExprKind::Call { .. } => false,
                    _ => true,
                })
    }

    /// The x of `x * x` and of `pow(x, 2.0)`.
    pub(super) fn square(&self, expr: ExprId) -> Option<ExprId> {
        if let Some((left, right)) = self.binary(expr, BinaryOp::Multiply) {
            return self.same(left, right).then_some(left);
        }
        match self.call(expr, BuiltIn::Pow)? {
            &[base, exponent] => self.is_literal(exponent, 2.0).then_some(base),
            _ => None,
        }
    }

    /// The text of a sum; `None` if it is empty or inside of a macro.
    pub(super) fn sum(&self, terms: &[Term]) -> Option<String> {
        if let [
            Term {
                is_negative: false,
                expr,
            },
        ] = terms
        {
            return self.text(*expr);
        }
        let mut text = String::new();
        for term in terms {
            let operand = self.text(term.expr)?;
            text += match (text.is_empty(), term.is_negative) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            text += &operand;
        }
        (!text.is_empty()).then(|| format!("({text})"))
    }

    /// The text of `one - other`, in which equal terms cancel as in [`Self::difference`], or do not.
    pub(super) fn minus(&self, one: ExprId, other: ExprId) -> Option<String> {
        let plain = || Some(format!("({} - {})", self.text(one)?, self.text(other)?));
        self.difference(one, other).or_else(plain)
    }

    /// The text of `one - other`, in which equal terms, also of the definition of a variable, cancel; `None`
    /// if none do.
    pub(super) fn difference(&self, one: ExprId, other: ExprId) -> Option<String> {
        if let (
            ExprKind::Swizzle { vector, components },
            ExprKind::Swizzle {
                vector: other,
                components: of_other,
            },
        ) = (&self.tree[one].kind, &self.tree[other].kind)
            && components == of_other
        {
            let vectors = self.difference(*vector, *other)?;
            return Some(format!("{vectors}.{}", components.name()));
        }
        let variants = [
            (one, other),
            (self.resolve(one), other),
            (one, self.resolve(other)),
        ];
        variants.into_iter().find_map(|(one, other)| {
            let mut terms = self.terms(one);
            let negated = self.terms(other).into_iter().map(|term| Term {
                is_negative: !term.is_negative,
                ..term
            });
            terms.extend(negated);
            let rest = self.cancelled(terms)?;
            if rest.is_empty() {
                Some("0.0".to_owned())
            } else {
                self.sum(&rest)
            }
        })
    }

    /// The terms without those that cancel; `None` if none do.
    pub(super) fn cancelled(&self, mut terms: Vec<Term>) -> Option<Vec<Term>> {
        let count = terms.len();
        let mut first = 0;
        while first < terms.len() {
            let other = (first + 1..terms.len()).find(|&other| {
                terms[first].is_negative != terms[other].is_negative
                    && self.same(terms[first].expr, terms[other].expr)
            });
            match other {
                Some(other) => {
                    terms.remove(other);
                    terms.remove(first);
                }
                None => first += 1,
            }
        }
        (terms.len() < count).then_some(terms)
    }
}

/// Whether the parenthesis with which a text begins is closed by its last character.
fn is_in_parentheses(text: &str) -> bool {
    let mut depth = 0;
    let closed = text.bytes().position(|byte| {
        depth += i32::from(byte == b'(') - i32::from(byte == b')');
        depth == 0
    });
    text.starts_with('(') && closed == Some(text.len() - 1)
}
