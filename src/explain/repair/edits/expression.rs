//! Edits of operations: other operators, exchanged and deleted operands and arguments, other functions.

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Function, FunctionId, Type, UnaryOp,
};

use super::super::edit::EditKind;
use super::super::term::{Op, Term};
use super::number::number;
use super::writer::{At, Writer, is_literal};

/// The costs: another operator or function, another comparison, exchanged operands, deletions.
const OTHER: u32 = 10;
const COMPARISON: u32 = 12;
const EXCHANGE: u32 = 12;
const DELETION: u32 = 15;

/// The cost of deleting a factor and a term at once, which is more natural than another operator by which
/// they cancel.
const UNSCALED: u32 = 9;

impl Writer<'_> {
    pub(super) fn expression(&mut self, at: At) {
        let tree = self.tree;
        match &tree[at.expr].kind {
            &ExprKind::Binary { op, left, right } => self.binary(at, op, left, right),
            &ExprKind::Unary { operand, op } => {
                let kind = if op == UnaryOp::Not {
                    EditKind::Condition
                } else {
                    EditKind::Sign
                };
                self.replace(at, kind, OTHER, self.keep(operand));
            }
            &ExprKind::Conditional { condition, yes, no } => {
                let parts = [condition, no, yes].map(|part| self.keep(part));
                let swapped = Term::apply(Op::Conditional, parts.into(), at.ty);
                self.replace(at, EditKind::Operands, EXCHANGE, swapped);
                for part in [yes, no] {
                    self.replace(at, EditKind::Condition, DELETION, self.keep(part));
                }
            }
            ExprKind::BuiltIn { function, arguments } => self.built_in(at, *function, arguments),
            ExprKind::Call { function, arguments } => {
                let call = |arguments| Some(Term::apply(Op::Call(*function), arguments, at.ty));
                self.exchange(at, arguments, &call);
                self.pass_through(at, arguments);
                self.other_functions(at, *function, arguments);
                self.exchanged_calls(at, *function, arguments);
            }
            ExprKind::Construct {
                constructor: Constructor::Scalar,
                arguments,
            } if at.ty == Type::FLOAT => self.integer_division(at, arguments[0]),
            ExprKind::Construct {
                constructor: constructor @ (Constructor::Vector | Constructor::Matrix | Constructor::Struct),
                arguments,
            } if !arguments.iter().all(|&argument| number(tree, argument).is_some()) => {
                let construct = |arguments| Some(Term::construct(*constructor, arguments, at.ty));
                self.exchange(at, arguments, &construct);
            }
            _ => {}
        }
    }

    fn binary(&mut self, at: At, op: BinaryOp, left: ExprId, right: ExprId) {
        use BinaryOp::{
            Add, And, Divide, Equal, Greater, GreaterEqual, Less, LessEqual, Multiply, NotEqual, Or,
            Remainder, Subtract,
        };
        let tree = self.tree;
        let [a, b] = [left, right].map(|operand| self.keep(operand));
        let others: &[BinaryOp] = match op {
            Add => &[Subtract, Multiply, Divide],
            Subtract => &[Add, Multiply, Divide],
            Multiply => &[Divide, Add, Subtract],
            Divide => &[Multiply, Subtract, Add],
            Remainder => &[Divide, Multiply],
            Less => &[LessEqual, Greater, GreaterEqual],
            LessEqual => &[Less, GreaterEqual, Greater],
            Greater => &[GreaterEqual, Less, LessEqual],
            GreaterEqual => &[Greater, LessEqual, Less],
            Equal => &[NotEqual, Less, Greater],
            NotEqual => &[Equal, Less, Greater],
            And => &[Or],
            Or => &[And],
            _ => &[],
        };
        let is_comparison = matches!(op, Less | LessEqual | Greater | GreaterEqual | Equal | NotEqual);
        for &other in others {
            let (kind, cost) = match (op, other) {
                (Add, Subtract) | (Subtract, Add) => (EditKind::Sign, OTHER),
                _ if is_comparison => (EditKind::Comparison, COMPARISON),
                _ => (EditKind::Operator, OTHER),
            };
            self.replace(at, kind, cost, Term::binary(other, a.clone(), b.clone()));
        }
        let is_matrix = |operand: ExprId| matches!(tree[operand].ty, Type::Matrix { .. });
        let is_product_of_matrix = op == Multiply && (is_matrix(left) || is_matrix(right));
        if matches!(op, Subtract | Divide | Remainder) || is_product_of_matrix {
            self.replace(
                at,
                EditKind::Operands,
                EXCHANGE,
                Term::binary(op, b.clone(), a.clone()),
            );
        }
        if op == Multiply
            && is_matrix(right)
            && let ExprKind::Binary {
                op: Multiply,
                left: first,
                right: second,
            } = tree[left].kind
            && is_matrix(second)
        {
            let product = Term::binary(Multiply, self.keep(first), b.clone());
            let swapped = product.and_then(|product| Term::binary(Multiply, product, self.keep(second)));
            self.replace(at, EditKind::Operands, EXCHANGE, swapped);
        }
        let kind = match op {
            Multiply | Divide | Remainder => EditKind::SuperfluousFactor,
            Add | Subtract => EditKind::SuperfluousTerm,
            _ => EditKind::Condition,
        };
        self.replace(at, kind, DELETION, a);
        self.replace(at, kind, DELETION, b.clone());
        match op {
            Add => self.unscaled(at, left, right),
            Subtract => {
                self.unscaled(at, left, right);
                self.replace(at, kind, DELETION + 2, Term::unary(UnaryOp::Minus, b));
            }
            Divide => self.replace(at, kind, DELETION + 2, Term::binary(Divide, Term::float(1.0), b)),
            Multiply => self.split_product(at),
            _ => {}
        }
        if matches!(op, Add | Subtract) {
            self.regrouped(at, op, left, right);
        }
    }

    /// Converts the operands of an integer division instead of its result, which has lost the fraction.
    fn integer_division(&mut self, at: At, quotient: ExprId) {
        let tree = self.tree;
        if let ExprKind::Binary {
            op: BinaryOp::Divide,
            left,
            right,
        } = tree[quotient].kind
            && tree[quotient].ty == Type::INT
        {
            let [left, right] = [left, right]
                .map(|part| Term::construct(Constructor::Scalar, vec![self.keep(part)], Type::FLOAT));
            self.replace(
                at,
                EditKind::Operands,
                OTHER,
                Term::binary(BinaryOp::Divide, left, right),
            );
        }
    }

    /// Calls two functions in the other order: g(f(x, a), b) for f(g(x, b), a).
    fn exchanged_calls(&mut self, at: At, function: FunctionId, arguments: &[ExprId]) {
        let tree = self.tree;
        let inner = arguments
            .iter()
            .enumerate()
            .filter_map(|(at, &argument)| match &tree[argument].kind {
                ExprKind::Call { function, arguments } => Some((at, argument, *function, arguments)),
                _ => None,
            });
        for (place, call, other, own) in inner.collect::<Vec<_>>() {
            let Some(value) = own.get(place).copied().filter(|_| other != function) else {
                continue;
            };
            if tree[call].ty != at.ty || tree[value].ty != at.ty {
                continue;
            }
            let mut outer = self.keep_all(arguments);
            outer[place] = self.keep(value);
            let mut whole = self.keep_all(own);
            whole[place] = Term::apply(Op::Call(function), outer, at.ty);
            let swapped = Term::apply(Op::Call(other), whole, at.ty);
            self.replace(at, EditKind::Operands, EXCHANGE, swapped);
        }
    }

    /// Deletes a factor and a term that are numbers: x for 0.5 * x + 0.5.
    fn unscaled(&mut self, at: At, left: ExprId, right: ExprId) {
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
                self.replace(at, EditKind::SuperfluousTerm, UNSCALED, self.keep(value));
            }
        }
    }

    /// Replaces an inner operator of a product of at least three factors: a + b * c for a * b * c.
    fn split_product(&mut self, at: At) {
        let tree = self.tree;
        let product = |expr: ExprId| match tree[expr].kind {
            ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            } => Some((left, right)),
            _ => None,
        };
        if at.user.and_then(product).is_some_and(|(left, _)| left == at.expr) {
            return;
        }
        // The factors after the operator, from the last one.
        let mut rest: Option<Term> = None;
        let mut part = at.expr;
        while let Some((left, right)) = product(part) {
            let factor = self.keep(right);
            if let Some(rest) = &rest {
                for op in [BinaryOp::Add, BinaryOp::Subtract] {
                    let after = Term::binary(BinaryOp::Multiply, factor.clone(), rest.clone());
                    let term = after.and_then(|after| Term::binary(op, self.keep(left), after));
                    self.replace(at, EditKind::Operator, OTHER, term);
                }
            }
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
    fn regrouped(&mut self, at: At, op: BinaryOp, left: ExprId, right: ExprId) {
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
            self.replace(at, EditKind::Expression, EXCHANGE + 4, whole);
        }
        if let Some((product, a, b)) = inner(right) {
            let sum = Term::binary(op, keep(left), keep(a));
            let whole = sum.and_then(|sum| Term::binary(product, sum, keep(b)));
            self.replace(at, EditKind::Expression, EXCHANGE + 4, whole);
        }
    }

    fn keep_all(&self, arguments: &[ExprId]) -> Vec<Term> {
        arguments.iter().map(|&argument| self.keep(argument)).collect()
    }

    fn built_in(&mut self, at: At, function: BuiltIn, arguments: &[ExprId]) {
        if function.is_texture() || function.out_parameter().is_some() {
            return;
        }
        for &other in alternatives(function) {
            let call = Term::call(other, self.keep_all(arguments));
            self.replace(at, EditKind::Function, OTHER, call);
        }
        if !is_commutative(function) {
            self.exchange(at, arguments, &|arguments| Term::call(function, arguments));
        }
        self.pass_through(at, arguments);
    }

    /// Deletes a call: its value becomes one of its arguments.
    fn pass_through(&mut self, at: At, arguments: &[ExprId]) {
        for &argument in arguments {
            if !is_literal(&self.tree[argument].kind) {
                self.replace(at, EditKind::SuperfluousCall, DELETION, self.keep(argument));
            }
        }
    }

    /// Exchanges two arguments of the same type.
    fn exchange(&mut self, at: At, arguments: &[ExprId], make: &dyn Fn(Vec<Term>) -> Option<Term>) {
        let count = arguments.len().min(8);
        for (first, second) in
            (0..count).flat_map(|first| (first + 1..count).map(move |second| (first, second)))
        {
            if self.tree[arguments[first]].ty == self.tree[arguments[second]].ty {
                let mut swapped = self.keep_all(arguments);
                swapped.swap(first, second);
                self.replace(at, EditKind::Arguments, EXCHANGE, make(swapped));
            }
        }
    }

    /// Calls another user function with the same parameters.
    fn other_functions(&mut self, at: At, function: FunctionId, arguments: &[ExprId]) {
        let tree = self.tree;
        let types = |function: &Function| -> Vec<(Type, _)> {
            let parameters = function.parameters.iter();
            parameters
                .map(|&parameter| (tree[parameter].ty, tree[parameter].kind))
                .collect()
        };
        let own = types(&tree[function]);
        let caller = self.shader.statements[at.statement]
            .at
            .map(|caller| caller.function);
        for (other, candidate) in tree.functions.iter() {
            let is_before = candidate.at.span.start < tree[at.expr].at.span.start;
            let is_callable = is_before && candidate.body.is_some() && caller != Some(other);
            if other != function && is_callable && candidate.return_type == at.ty && types(candidate) == own {
                let call = Term::apply(Op::Call(other), self.keep_all(arguments), at.ty);
                self.replace(at, EditKind::Function, OTHER + 2, call);
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
