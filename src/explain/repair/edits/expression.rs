//! Edits of operations: other operators, exchanged and deleted operands and arguments, other functions.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Type, UnaryOp};

use super::super::edit::EditKind;
use super::super::term::{Term, TermKind};
use super::number::number;
use super::{Writer, is_literal};

/// The costs: another operator or function, another comparison, exchanged operands, deletions.
const OTHER: u32 = 10;
const COMPARISON: u32 = 12;
const EXCHANGE: u32 = 12;
const DELETION: u32 = 15;

/// The cost of deleting a factor and a term at once, which is more natural than another operator by which
/// they cancel.
const UNSCALED: u32 = 9;

impl Writer<'_> {
    pub(super) fn expression(&mut self, site: usize) {
        let tree = self.tree;
        let expr = self.shader.sites[site].exprs[0];
        match &tree[expr].kind {
            &ExprKind::Binary { op, left, right } => self.binary(site, op, left, right),
            &ExprKind::Unary { operand, op } => {
                let kind = if op == UnaryOp::Not {
                    EditKind::Condition
                } else {
                    EditKind::Sign
                };
                self.replace(site, kind, OTHER, Term::keep(tree, operand));
            }
            &ExprKind::Conditional { condition, yes, no } => {
                let parts = [condition, no, yes].map(|part| Term::keep(tree, part));
                let swapped = Term::new(TermKind::Conditional(Box::new(parts)), tree[expr].ty);
                self.replace(site, EditKind::Operands, EXCHANGE, swapped);
                for part in [yes, no] {
                    self.replace(site, EditKind::Condition, DELETION, Term::keep(tree, part));
                }
            }
            ExprKind::BuiltIn { function, arguments } => self.built_in(site, *function, &arguments.clone()),
            ExprKind::Call { function, arguments } => {
                let arguments = arguments.clone();
                let call = |arguments| Some(Term::new(TermKind::Call(*function, arguments), tree[expr].ty));
                self.exchange(site, &arguments, &call);
                self.pass_through(site, &arguments);
                self.other_functions(site, *function, &arguments);
            }
            ExprKind::Construct {
                constructor,
                arguments,
            } => {
                let is_kind = matches!(
                    constructor,
                    Constructor::Vector | Constructor::Matrix | Constructor::Struct
                );
                let is_number = |&argument: &ExprId| number(tree, argument).is_some();
                if is_kind && !arguments.iter().all(is_number) {
                    let (constructor, arguments) = (*constructor, arguments.clone());
                    let construct = |arguments| {
                        Some(Term::new(
                            TermKind::Construct(constructor, arguments),
                            tree[expr].ty,
                        ))
                    };
                    self.exchange(site, &arguments, &construct);
                }
            }
            _ => {}
        }
    }

    fn binary(&mut self, site: usize, op: BinaryOp, left: ExprId, right: ExprId) {
        use BinaryOp::{
            Add, And, Divide, Equal, Greater, GreaterEqual, Less, LessEqual, Multiply, NotEqual, Or,
            Remainder, Subtract,
        };
        let tree = self.tree;
        let [a, b] = [left, right].map(|operand| Term::keep(tree, operand));
        let (others, kind): (&[BinaryOp], _) = match op {
            Add => (&[Subtract, Multiply, Divide], EditKind::Operator),
            Subtract => (&[Add, Multiply, Divide], EditKind::Operator),
            Multiply => (&[Divide, Add, Subtract], EditKind::Operator),
            Divide => (&[Multiply, Subtract, Add], EditKind::Operator),
            Remainder => (&[Divide, Multiply], EditKind::Operator),
            Less => (&[LessEqual, Greater, GreaterEqual], EditKind::Comparison),
            LessEqual => (&[Less, GreaterEqual, Greater], EditKind::Comparison),
            Greater => (&[GreaterEqual, Less, LessEqual], EditKind::Comparison),
            GreaterEqual => (&[Greater, LessEqual, Less], EditKind::Comparison),
            Equal => (&[NotEqual, Less, Greater], EditKind::Comparison),
            NotEqual => (&[Equal, Less, Greater], EditKind::Comparison),
            And => (&[Or], EditKind::Operator),
            Or => (&[And], EditKind::Operator),
            _ => (&[], EditKind::Operator),
        };
        for &other in others {
            if let Some(term) = Term::binary(other, a.clone(), b.clone()) {
                let kind = if (op, other) == (Add, Subtract) || (op, other) == (Subtract, Add) {
                    EditKind::Sign
                } else {
                    kind
                };
                let cost = if kind == EditKind::Comparison {
                    COMPARISON
                } else {
                    OTHER
                };
                self.replace(site, kind, cost, term);
            }
        }
        let is_matrix = [left, right]
            .iter()
            .any(|&operand| matches!(tree[operand].ty, Type::Matrix { .. }));
        if (matches!(op, Subtract | Divide | Remainder) || (op == Multiply && is_matrix))
            && let Some(term) = Term::binary(op, b.clone(), a.clone())
        {
            self.replace(site, EditKind::Operands, EXCHANGE, term);
        }
        let kind = match op {
            Multiply | Divide | Remainder => EditKind::SuperfluousFactor,
            Add | Subtract => EditKind::SuperfluousTerm,
            _ => EditKind::Condition,
        };
        self.replace(site, kind, DELETION, a.clone());
        self.replace(site, kind, DELETION, b.clone());
        if matches!(op, Add | Subtract) {
            self.unscaled(site, left, right);
        }
        if op == Subtract {
            self.replace(site, kind, DELETION + 2, Term::unary(UnaryOp::Minus, b.clone()));
        }
        if op == Divide
            && let Some(term) = Term::binary(Divide, Term::float(1.0), b.clone())
        {
            self.replace(site, kind, DELETION + 2, term);
        }
        if op == Multiply {
            self.split_product(site);
        }
        // The product of the inner operands in another order: a * (b + c) for a * b + c.
        if matches!(op, Add | Subtract) {
            self.regrouped(site, op, left, right);
        }
    }

    /// Deletes a factor and a term that are numbers: x for 0.5 * x + 0.5.
    fn unscaled(&mut self, site: usize, left: ExprId, right: ExprId) {
        let tree = self.tree;
        let is_number = |expr: ExprId| number(tree, expr).is_some();
        for (product, term) in [(left, right), (right, left)] {
            if let ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            } = tree[product].kind
                && is_number(term)
                && is_number(left) != is_number(right)
            {
                let value = if is_number(left) { right } else { left };
                self.replace(site, EditKind::SuperfluousTerm, UNSCALED, Term::keep(tree, value));
            }
        }
    }

    /// Replaces an inner operator of a product of at least three factors: a + b * c for a * b * c.
    fn split_product(&mut self, site: usize) {
        let tree = self.tree;
        let product = |expr: ExprId| match tree[expr].kind {
            ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            } => Some((left, right)),
            _ => None,
        };
        let whole = self.shader.sites[site].exprs[0];
        let user = self.shader.sites[site].user.and_then(product);
        if user.is_some_and(|(left, _)| left == whole) {
            return;
        }
        // The factors after the operator, from the last one.
        let mut rest: Option<Term> = None;
        let mut part = whole;
        while let Some((left, right)) = product(part) {
            if let Some(rest) = &rest {
                let operands = [Term::keep(tree, left), Term::keep(tree, right)];
                let [before, factor] = operands;
                for op in [BinaryOp::Add, BinaryOp::Subtract] {
                    let after = Term::binary(BinaryOp::Multiply, factor.clone(), rest.clone());
                    if let Some(term) = after.and_then(|after| Term::binary(op, before.clone(), after)) {
                        self.replace(site, EditKind::Operator, OTHER, term);
                    }
                }
            }
            let factor = Term::keep(tree, right);
            rest = match rest {
                None => Some(factor),
                Some(rest) => Term::binary(BinaryOp::Multiply, factor, rest),
            };
            if rest.is_none() {
                return;
            }
            part = left;
        }
    }

    /// Moves a parenthesis: a * (b + c) for a * b + c, and (a + b) * c for a + b * c.
    fn regrouped(&mut self, site: usize, op: BinaryOp, left: ExprId, right: ExprId) {
        let tree = self.tree;
        let inner = |expr: ExprId| match tree[expr].kind {
            ExprKind::Binary {
                op: inner @ (BinaryOp::Multiply | BinaryOp::Divide),
                left,
                right,
            } => Some((inner, left, right)),
            _ => None,
        };
        let keep = |expr| Term::keep(tree, expr);
        if let Some((product, a, b)) = inner(left) {
            let sum = Term::binary(op, keep(b), keep(right));
            let whole = sum.and_then(|sum| Term::binary(product, keep(a), sum));
            self.replace_any(site, EditKind::Expression, EXCHANGE + 4, whole);
        }
        if let Some((product, a, b)) = inner(right) {
            let sum = Term::binary(op, keep(left), keep(a));
            let whole = sum.and_then(|sum| Term::binary(product, sum, keep(b)));
            self.replace_any(site, EditKind::Expression, EXCHANGE + 4, whole);
        }
    }

    pub(super) fn replace_any(&mut self, site: usize, kind: EditKind, cost: u32, term: Option<Term>) {
        if let Some(term) = term {
            self.replace(site, kind, cost, term);
        }
    }

    fn built_in(&mut self, site: usize, function: BuiltIn, arguments: &[ExprId]) {
        let tree = self.tree;
        if function.is_texture() || function.out_parameter().is_some() {
            return;
        }
        let own: Vec<Term> = arguments
            .iter()
            .map(|&argument| Term::keep(tree, argument))
            .collect();
        for &other in alternatives(function) {
            self.replace_any(site, EditKind::Function, OTHER, Term::call(other, own.clone()));
        }
        if !is_commutative(function) {
            self.exchange(site, arguments, &|arguments| Term::call(function, arguments));
        }
        self.pass_through(site, arguments);
    }

    /// Deletes a call: its value becomes one of its arguments.
    fn pass_through(&mut self, site: usize, arguments: &[ExprId]) {
        for &argument in arguments {
            if !is_literal(&self.tree[argument].kind) {
                self.replace(
                    site,
                    EditKind::SuperfluousCall,
                    DELETION,
                    Term::keep(self.tree, argument),
                );
            }
        }
    }

    /// Exchanges two arguments of the same type.
    fn exchange(&mut self, site: usize, arguments: &[ExprId], make: &dyn Fn(Vec<Term>) -> Option<Term>) {
        let tree = self.tree;
        for first in 0..arguments.len().min(8) {
            for second in first + 1..arguments.len().min(8) {
                if tree[arguments[first]].ty == tree[arguments[second]].ty {
                    let mut swapped: Vec<Term> = arguments
                        .iter()
                        .map(|&argument| Term::keep(tree, argument))
                        .collect();
                    swapped.swap(first, second);
                    self.replace_any(site, EditKind::Arguments, EXCHANGE, make(swapped));
                }
            }
        }
    }

    /// Calls another user function with the same parameters.
    fn other_functions(
        &mut self,
        site: usize,
        function: toyproof_glsl::tree::FunctionId,
        arguments: &[ExprId],
    ) {
        let tree = self.tree;
        let expr = self.shader.sites[site].exprs[0];
        let types = |function: &toyproof_glsl::tree::Function| -> Vec<(Type, _)> {
            let parameters = function.parameters.iter();
            parameters
                .map(|&parameter| (tree[parameter].ty, tree[parameter].kind))
                .collect()
        };
        let own = types(&tree[function]);
        let user = self.shader.statements[self.shader.sites[site].statement].at;
        for (other, candidate) in tree.functions.iter() {
            let is_before = candidate.at.span.start < tree[expr].at.span.start;
            let is_caller = user.is_some_and(|user| user.function == other);
            if other != function
                && is_before
                && !is_caller
                && candidate.body.is_some()
                && candidate.return_type == tree[expr].ty
                && types(candidate) == own
            {
                let arguments = arguments
                    .iter()
                    .map(|&argument| Term::keep(tree, argument))
                    .collect();
                let call = Term::new(TermKind::Call(other, arguments), tree[expr].ty);
                self.replace(site, EditKind::Function, OTHER + 2, call);
            }
        }
    }
}

/// The functions with which a function is confused, with the same parameters.
fn alternatives(function: BuiltIn) -> &'static [BuiltIn] {
    use BuiltIn::{
        Abs, Acos, Asin, Atan, Ceil, Clamp, Cos, Cross, Degrees, Distance, Dot, Exp, Exp2, Floor, Fract,
        Inverse, InverseSqrt, Log, Log2, Max, Min, Mix, Mod, Normalize, Pow, Radians, Reflect, Round, Sign,
        Sin, Smoothstep, Sqrt, Step, Tan, Transpose, Trunc,
    };
    match function {
        Min => &[Max, Mod, Step],
        Max => &[Min, Mod, Pow],
        Sin => &[Cos, Tan],
        Cos => &[Sin, Tan],
        Tan => &[Sin, Cos, Atan],
        Asin => &[Acos, Sin],
        Acos => &[Asin, Cos],
        Atan => &[Tan],
        Floor => &[Ceil, Fract, Round, Trunc],
        Ceil => &[Floor, Round, Trunc],
        Fract => &[Floor, Abs, Round],
        Round => &[Floor, Ceil, Trunc],
        Trunc => &[Floor, Round, Ceil],
        Sqrt => &[InverseSqrt, Abs, Exp2],
        InverseSqrt => &[Sqrt],
        Exp => &[Exp2, Log],
        Exp2 => &[Exp, Log2],
        Log => &[Log2, Exp],
        Log2 => &[Log, Exp2],
        Abs => &[Sign, Sqrt],
        Sign | Normalize => &[Abs],
        Mod => &[Min, Max, Pow, Step],
        Pow => &[Mod, Max, Min],
        Dot => &[Distance],
        Distance => &[Dot],
        Radians => &[Degrees],
        Degrees => &[Radians],
        Mix => &[Smoothstep, Clamp],
        Smoothstep => &[Mix, Clamp],
        Clamp => &[Mix, Smoothstep],
        Step => &[Max, Min],
        Reflect => &[Cross],
        Cross => &[Reflect],
        Transpose => &[Inverse],
        Inverse => &[Transpose],
        _ => &[],
    }
}

/// Whether exchanged arguments mean the same.
fn is_commutative(function: BuiltIn) -> bool {
    matches!(
        function,
        BuiltIn::Min | BuiltIn::Max | BuiltIn::Dot | BuiltIn::Distance
    )
}
