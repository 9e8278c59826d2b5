//! Edits that insert something: a call, a factor, a term, a condition.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use toyproof_glsl::tree::{BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Scalar, Type, UnaryOp, walk};

use super::super::edit::EditKind;
use super::super::term::{Term, TermKind};
use super::writer::{At, Writer, is_float, is_input, is_literal, is_name};
use crate::engine::fit::Fit;
use crate::engine::tournament::Values;

/// The costs: calls, signs, well-known numbers, values of the shader, products of vectors, conditions, and
/// fitted numbers.
const CALL: u32 = 16;
const SIGN: u32 = 12;
const NUMBER: u32 = 18;
const VALUE: u32 = 22;
const COSINE: u32 = 24;
const CONDITION: u32 = 22;
const FITTED: u32 = 40;

/// The additional costs of an insertion at the use of a value, and of a call of a function of angles.
const USED: u32 = 2;
const RARE: u32 = 6;

/// The largest number of values that are combined in pairs.
const MAX_PAIRED: usize = 7;

/// The factors, terms and exponents that are tried.
const FACTORS: [f64; 11] = [0.5, 2.0, PI, FRAC_1_PI, TAU, 0.25, 4.0, 1.0 / TAU, 3.0, 0.1, 10.0];
const TERMS: [f64; 6] = [1.0, -1.0, 0.5, -0.5, 2.0, -2.0];
const EXPONENTS: [f64; 7] = [2.0, 0.5, 1.0 / 2.2, 2.2, 5.0, 3.0, 4.0];

/// Numbers that are tried at the cost of well-known ones.
fn known(numbers: impl IntoIterator<Item = f64>, fit: Option<Fit>) -> Values {
    Values::Tried {
        values: numbers.into_iter().map(|number| (number, NUMBER)).collect(),
        fit: fit.map(|fit| (FITTED, fit)),
    }
}

impl Writer<'_> {
    pub(super) fn insertion(&mut self, at: At) {
        // An edit of a literal is an edit of its number.
        if is_literal(&self.tree[at.expr].kind) {
            return;
        }
        let own = self.keep(at.expr);
        match at.ty {
            Type::Scalar(Scalar::Bool) => self.condition(at),
            Type::Matrix { .. } => {
                for function in [BuiltIn::Transpose, BuiltIn::Inverse] {
                    let call = Term::call(function, vec![own.clone()]);
                    self.replace(at, EditKind::MissingCall, CALL, call);
                }
            }
            Type::Scalar(Scalar::Int) => {
                for (op, by) in [
                    (BinaryOp::Add, 1),
                    (BinaryOp::Subtract, 1),
                    (BinaryOp::Multiply, 2),
                ] {
                    let term = Term::binary(op, own.clone(), Term::int(by));
                    self.replace(at, EditKind::MissingTerm, NUMBER, term);
                }
                for value in self.values(at.statement, Type::INT) {
                    let term = Term::binary(BinaryOp::Add, own.clone(), value);
                    self.replace(at, EditKind::MissingTerm, VALUE, term);
                }
            }
            Type::Vector(Scalar::Int, size) => self.offsets(at, size),
            ty if is_float(ty) => {
                self.calls(at);
                self.factors_and_terms(at);
            }
            _ => {}
        }
    }

    /// Adds another vector, or one of the counters of loops, to an integer vector, such as a position.
    fn offsets(&mut self, at: At, size: u8) {
        let own = self.keep(at.expr);
        let mut others = self.values(at.statement, at.ty);
        let mut counters = self.values(at.statement, Type::INT);
        counters.truncate(usize::from(size));
        if counters.len() == usize::from(size) {
            others.push(Term::construct(Constructor::Vector, counters.clone(), at.ty));
            counters.reverse();
            others.push(Term::construct(Constructor::Vector, counters, at.ty));
        }
        for other in others {
            for op in [BinaryOp::Add, BinaryOp::Subtract] {
                let term = Term::binary(op, own.clone(), other.clone());
                self.replace(at, EditKind::MissingTerm, VALUE, term);
            }
        }
    }

    fn calls(&mut self, at: At) {
        use BuiltIn::{Abs, Clamp, Cos, Exp, Floor, Fract, Max, Min, Normalize, Pow, Radians, Sin, Sqrt};
        let kind = &self.tree[at.expr].kind;
        let own = self.keep(at.expr);
        // Where a value is computed, rather than where it is used.
        let used = if is_name(kind) { USED } else { 0 };
        if !matches!(kind, ExprKind::Unary { .. }) {
            self.replace(
                at,
                EditKind::Sign,
                SIGN + used,
                Term::unary(UnaryOp::Minus, own.clone()),
            );
        }
        let is_vector = matches!(at.ty, Type::Vector(..));
        let functions: &[(BuiltIn, &[f64])] = if is_vector {
            &[
                (Normalize, &[]),
                (Abs, &[]),
                (Sqrt, &[]),
                (Floor, &[]),
                (Fract, &[]),
            ]
        } else {
            &[
                (Abs, &[]),
                (Sqrt, &[]),
                (Floor, &[]),
                (Fract, &[]),
                (Cos, &[]),
                (Sin, &[]),
                (Exp, &[]),
                (Radians, &[]),
            ]
        };
        let limits: &[(BuiltIn, &[f64])] = &[(Max, &[0.0]), (Min, &[1.0]), (Clamp, &[0.0, 1.0])];
        for (function, numbers) in limits.iter().chain(functions) {
            let numbers = numbers.iter().map(|&number| Term::float(number));
            let call = Term::call(*function, [own.clone()].into_iter().chain(numbers).collect());
            // Only an angle has degrees.
            let rare = if *function == Radians { RARE } else { 0 };
            self.replace(at, EditKind::MissingCall, CALL + used + rare, call);
        }
        // Gamma, and other powers.
        let exponent = if is_vector {
            Term::construct(Constructor::Splat, vec![Term::fitted()], at.ty)
        } else {
            Term::fitted()
        };
        let of_scene = self.constants.floats.iter().copied().filter(|&value| value > 1.0);
        let values = known(EXPONENTS.into_iter().chain(of_scene), None);
        let power = Term::call(Pow, vec![own, exponent]);
        self.replace_with(at, EditKind::MissingCall, NUMBER, power, values);
    }

    fn factors_and_terms(&mut self, at: At) {
        use BinaryOp::{Add, Divide, Multiply, Subtract};
        let (tree, shader) = (self.tree, self.shader);
        let kind = &tree[at.expr].kind;
        let own = || Term::keep(tree, at.expr);
        let is_used_by = |ops: [BinaryOp; 2]| {
            let is_one =
                |user: ExprId| matches!(tree[user].kind, ExprKind::Binary { op, .. } if ops.contains(&op));
            at.user.is_some_and(is_one)
        };
        // A factor of a factor is a factor of the whole product.
        let (in_product, in_sum) = (is_used_by([Multiply, Divide]), is_used_by([Add, Subtract]));
        if matches!(kind, ExprKind::Construct { .. }) && in_product {
            return;
        }
        if !in_product {
            let product = Term::binary(Multiply, own(), Term::fitted());
            let factors = known(FACTORS, Some(Fit::Number(1.0)));
            self.replace_with(at, EditKind::MissingFactor, NUMBER, product, factors);
            if !walk::has_side_effects(tree, at.expr) {
                let inverse = Term::binary(Divide, Term::float(1.0), own());
                for term in [Term::binary(Multiply, own(), own()), inverse] {
                    self.replace(at, EditKind::MissingFactor, NUMBER, term);
                }
            }
        }
        if !in_sum {
            let terms = known(TERMS, Some(Fit::Number(0.0)));
            let sum = Term::binary(Add, own(), Term::fitted());
            self.replace_with(at, EditKind::MissingTerm, NUMBER, sum, terms);
            let rest = Term::binary(Subtract, Term::float(1.0), own());
            self.replace(at, EditKind::MissingTerm, NUMBER, rest);
        }
        let mut values = self.values(at.statement, Type::FLOAT);
        if at.ty != Type::FLOAT {
            values.extend(self.values(at.statement, at.ty));
        }
        let text = shader.text(tree[at.expr].at.span);
        for value in values
            .into_iter()
            .filter(|value| value.text(tree, shader.source, 0) != text)
        {
            let input = if is_input(tree, &value) { USED } else { 0 };
            for op in [Multiply, Divide].into_iter().filter(|_| !in_product) {
                let term = Term::binary(op, own(), value.clone());
                self.replace(at, EditKind::MissingFactor, VALUE + input, term);
                if value.ty == Type::FLOAT {
                    let square = Term::binary(Multiply, value.clone(), value.clone());
                    let term = square.and_then(|square| Term::binary(op, own(), square));
                    self.replace(at, EditKind::MissingFactor, VALUE + 1, term);
                }
            }
            for op in [Add, Subtract].into_iter().filter(|_| !in_sum) {
                let term = Term::binary(op, own(), value.clone());
                self.replace(at, EditKind::MissingTerm, VALUE + input, term);
            }
        }
        if !in_product {
            self.products_of_vectors(at);
        }
    }

    /// Inserts a cosine, or the square of a distance.
    fn products_of_vectors(&mut self, at: At) {
        let mut vectors = self.values(at.statement, Type::Vector(Scalar::Float, 3));
        vectors.truncate(MAX_PAIRED);
        let own = self.keep(at.expr);
        let dot = |a: &Term, b: &Term| Term::call(BuiltIn::Dot, vec![a.clone(), b.clone()]);
        for (index, first) in vectors.iter().enumerate() {
            let square = dot(first, first);
            let term = square.and_then(|square| Term::binary(BinaryOp::Divide, own.clone(), square));
            self.replace(at, EditKind::MissingFactor, COSINE, term);
            for second in &vectors[index + 1..] {
                let clamped = |cosine| Term::call(BuiltIn::Max, vec![cosine, Term::float(0.0)]);
                let cosine = dot(first, second).and_then(clamped);
                let term = cosine.and_then(|cosine| Term::binary(BinaryOp::Multiply, own.clone(), cosine));
                self.replace(at, EditKind::MissingFactor, COSINE, term);
            }
        }
    }

    fn condition(&mut self, at: At) {
        let tree = self.tree;
        let own = self.keep(at.expr);
        self.replace(
            at,
            EditKind::Condition,
            SIGN,
            Term::unary(UnaryOp::Not, own.clone()),
        );
        for value in [true, false] {
            self.replace(
                at,
                EditKind::Condition,
                CALL,
                Term::new(TermKind::Bool(value), Type::BOOL),
            );
        }
        let is_part = |user: ExprId| match tree[user].kind {
            ExprKind::Binary { op, .. } => matches!(op, BinaryOp::And | BinaryOp::Or),
            _ => false,
        };
        if at.user.is_some_and(is_part) {
            return;
        }
        let mut floats = self.values(at.statement, Type::FLOAT);
        let positive = |value: &Term| Term::binary(BinaryOp::Greater, value.clone(), Term::float(0.0));
        let mut others: Vec<(u32, Option<Term>)> =
            floats.iter().map(|value| (CONDITION, positive(value))).collect();
        let bools = self.values(at.statement, Type::BOOL).into_iter();
        others.extend(bools.map(|value| (CONDITION, Some(value))));
        floats.truncate(MAX_PAIRED);
        for first in &floats {
            for second in floats.iter().filter(|second| *second != first) {
                others.push((
                    COSINE,
                    Term::binary(BinaryOp::Less, first.clone(), second.clone()),
                ));
            }
        }
        for (cost, other) in others {
            let term = other.and_then(|other| Term::binary(BinaryOp::And, own.clone(), other));
            self.replace(at, EditKind::Condition, cost, term);
        }
    }
}
