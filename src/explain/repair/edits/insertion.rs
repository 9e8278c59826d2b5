//! Edits that insert something: a call, a factor, a term, a condition.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use toyproof_glsl::tree::{BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Scalar, Type, UnaryOp};

use super::super::edit::{EditKind, Trials};
use super::super::term::{Term, TermKind};
use super::{Writer, is_float, is_input, is_literal, is_name};

/// The costs: calls, signs, well-known numbers, values of the shader, products of vectors, conditions, and
/// fitted numbers.
const CALL: u32 = 16;
const SIGN: u32 = 12;
const NUMBER: u32 = 18;
const VALUE: u32 = 22;
const COSINE: u32 = 24;
const CONDITION: u32 = 22;
const FITTED: u32 = 40;

/// The additional cost of an insertion at the use of a value.
const USED: u32 = 2;

/// The largest number of values that are combined in pairs.
const MAX_PAIRED: usize = 7;

impl Writer<'_> {
    pub(super) fn insertion(&mut self, site: usize) {
        let tree = self.tree;
        let expr = self.shader.sites[site].exprs[0];
        let ty = tree[expr].ty;
        // An edit of a literal is an edit of its number.
        if is_literal(&tree[expr].kind) {
            return;
        }
        match ty {
            Type::Scalar(Scalar::Bool) => self.condition(site),
            Type::Matrix { .. } => {
                for function in [BuiltIn::Transpose, BuiltIn::Inverse] {
                    let call = Term::call(function, vec![Term::keep(tree, expr)]);
                    self.replace_any(site, EditKind::MissingCall, CALL, call);
                }
            }
            Type::Scalar(Scalar::Int) => {
                for (op, by) in [
                    (BinaryOp::Add, 1),
                    (BinaryOp::Subtract, 1),
                    (BinaryOp::Multiply, 2),
                ] {
                    let term = Term::binary(op, Term::keep(tree, expr), Term::int(by));
                    self.replace_any(site, EditKind::MissingTerm, NUMBER, term);
                }
                for value in self.values(self.shader.sites[site].statement, Type::INT) {
                    let term = Term::binary(BinaryOp::Add, Term::keep(tree, expr), value);
                    self.replace_any(site, EditKind::MissingTerm, VALUE, term);
                }
            }
            _ if is_float(ty) => {
                self.calls(site, ty);
                self.factors_and_terms(site);
            }
            _ => {}
        }
    }

    fn calls(&mut self, site: usize, ty: Type) {
        use BuiltIn::{Abs, Clamp, Cos, Exp, Floor, Fract, Max, Min, Normalize, Pow, Radians, Sin, Sqrt};
        let tree = self.tree;
        let expr = self.shader.sites[site].exprs[0];
        let own = || Term::keep(tree, expr);
        // Where a value is computed, rather than where it is used.
        let used = if is_name(&tree[expr].kind) { USED } else { 0 };
        let negated = Term::unary(UnaryOp::Minus, own());
        if !matches!(tree[expr].kind, ExprKind::Unary { .. }) {
            self.replace(site, EditKind::Sign, SIGN + used, negated);
        }
        let float = Term::float;
        let with_numbers = [
            (Max, vec![float(0.0)]),
            (Min, vec![float(1.0)]),
            (Clamp, vec![float(0.0), float(1.0)]),
        ];
        for (function, numbers) in with_numbers {
            let arguments = std::iter::once(own()).chain(numbers).collect();
            self.replace_any(
                site,
                EditKind::MissingCall,
                CALL + used,
                Term::call(function, arguments),
            );
        }
        let mut functions = vec![Abs, Sqrt, Floor, Fract];
        match ty {
            Type::Vector(..) => functions.insert(0, Normalize),
            _ => functions.extend([Cos, Sin, Exp, Radians]),
        }
        for function in functions {
            self.replace_any(
                site,
                EditKind::MissingCall,
                CALL + used,
                Term::call(function, vec![own()]),
            );
        }
        // Gamma, and other powers.
        let exponent = match ty {
            Type::Vector(..) => Term::new(TermKind::Construct(Constructor::Splat, vec![Term::fitted()]), ty),
            _ => Term::fitted(),
        };
        let mut values: Vec<(f64, u32)> = [2.0, 0.5, 1.0 / 2.2, 2.2, 5.0, 3.0, 4.0]
            .map(|value| (value, NUMBER))
            .into();
        values.extend(
            self.constants
                .floats
                .iter()
                .filter(|value| **value > 1.0)
                .map(|&value| (value, NUMBER)),
        );
        let trials = Trials::Values { values, fit: None };
        if let Some(power) = Term::call(Pow, vec![own(), exponent]) {
            self.replace_with(site, EditKind::MissingCall, NUMBER, power, trials);
        }
    }

    fn factors_and_terms(&mut self, site: usize) {
        let tree = self.tree;
        let shader = self.shader;
        let expr = shader.sites[site].exprs[0];
        let ty = tree[expr].ty;
        let statement = shader.sites[site].statement;
        let own = || Term::keep(tree, expr);
        let user = |ops: &[BinaryOp]| {
            let user = shader.sites[site].user;
            user.is_some_and(
                |user| matches!(tree[user].kind, ExprKind::Binary { op, .. } if ops.contains(&op)),
            )
        };
        // A factor of a factor is a factor of the whole product.
        let in_product = user(&[BinaryOp::Multiply, BinaryOp::Divide]);
        let in_sum = user(&[BinaryOp::Add, BinaryOp::Subtract]);
        if matches!(tree[expr].kind, ExprKind::Construct { .. }) && in_product {
            return;
        }
        if !in_product {
            let mut values: Vec<(f64, u32)> =
                [0.5, 2.0, PI, FRAC_1_PI, TAU, 0.25, 4.0, 1.0 / TAU, 3.0, 0.1, 10.0]
                    .map(|value| (value, NUMBER))
                    .into();
            values.retain(|(value, _)| value.is_finite() && *value != 1.0);
            let trials = Trials::Values {
                values,
                fit: Some((FITTED, 1.0)),
            };
            let product = Term::binary(BinaryOp::Multiply, own(), Term::fitted());
            if let Some(product) = product {
                self.replace_with(site, EditKind::MissingFactor, NUMBER, product, trials);
            }
            self.square_and_inverse(site, expr);
        }
        if !in_sum {
            let mut values: Vec<(f64, u32)> = [1.0, -1.0, 0.5, -0.5, 2.0, -2.0]
                .map(|value| (value, NUMBER))
                .into();
            values.retain(|(value, _)| *value != 0.0);
            let trials = Trials::Values {
                values,
                fit: Some((FITTED, 0.0)),
            };
            if let Some(sum) = Term::binary(BinaryOp::Add, own(), Term::fitted()) {
                self.replace_with(site, EditKind::MissingTerm, NUMBER, sum, trials);
            }
            let rest = Term::binary(BinaryOp::Subtract, Term::float(1.0), own());
            self.replace_any(site, EditKind::MissingTerm, NUMBER, rest);
        }
        let mut values = self.values(statement, Type::FLOAT);
        if ty != Type::FLOAT {
            values.extend(self.values(statement, ty));
        }
        for value in values {
            if value.text(tree, shader.source, 0) == shader.text(tree[expr].at.span) {
                continue;
            }
            let ops: &[BinaryOp] = match (in_product, in_sum) {
                (true, true) => &[],
                (true, false) => &[BinaryOp::Add, BinaryOp::Subtract],
                (false, true) => &[BinaryOp::Multiply, BinaryOp::Divide],
                (false, false) => &[
                    BinaryOp::Multiply,
                    BinaryOp::Divide,
                    BinaryOp::Add,
                    BinaryOp::Subtract,
                ],
            };
            for &op in ops {
                let is_factor = matches!(op, BinaryOp::Multiply | BinaryOp::Divide);
                let kind = if is_factor {
                    EditKind::MissingFactor
                } else {
                    EditKind::MissingTerm
                };
                let input = if is_input(tree, &value) { USED } else { 0 };
                self.replace_any(site, kind, VALUE + input, Term::binary(op, own(), value.clone()));
                if is_factor && value.ty == Type::FLOAT {
                    let square = Term::binary(BinaryOp::Multiply, value.clone(), value.clone());
                    let term = square.and_then(|square| Term::binary(op, own(), square));
                    self.replace_any(site, kind, VALUE + 1, term);
                }
            }
        }
        if !in_product {
            self.products_of_vectors(site, statement);
        }
    }

    fn square_and_inverse(&mut self, site: usize, expr: ExprId) {
        let tree = self.tree;
        let own = || Term::keep(tree, expr);
        if toyproof_glsl::tree::walk::has_side_effects(tree, expr) {
            return;
        }
        let square = Term::binary(BinaryOp::Multiply, own(), own());
        self.replace_any(site, EditKind::MissingFactor, NUMBER, square);
        let inverse = Term::binary(BinaryOp::Divide, Term::float(1.0), own());
        self.replace_any(site, EditKind::MissingFactor, NUMBER, inverse);
    }

    /// Inserts a cosine, or the square of a distance.
    fn products_of_vectors(&mut self, site: usize, statement: usize) {
        let tree = self.tree;
        let expr = self.shader.sites[site].exprs[0];
        let mut vectors = self.values(statement, Type::Vector(Scalar::Float, 3));
        vectors.truncate(MAX_PAIRED);
        let own = || Term::keep(tree, expr);
        let dot = |a: &Term, b: &Term| Term::call(BuiltIn::Dot, vec![a.clone(), b.clone()]);
        for (at, first) in vectors.iter().enumerate() {
            let square = dot(first, first);
            let term = square.and_then(|square| Term::binary(BinaryOp::Divide, own(), square));
            self.replace_any(site, EditKind::MissingFactor, COSINE, term);
            for second in &vectors[at + 1..] {
                let cosine = dot(first, second);
                let clamped =
                    cosine.and_then(|cosine| Term::call(BuiltIn::Max, vec![cosine, Term::float(0.0)]));
                let term = clamped.and_then(|cosine| Term::binary(BinaryOp::Multiply, own(), cosine));
                self.replace_any(site, EditKind::MissingFactor, COSINE, term);
            }
        }
    }

    fn condition(&mut self, site: usize) {
        let tree = self.tree;
        let expr = self.shader.sites[site].exprs[0];
        let statement = self.shader.sites[site].statement;
        let own = || Term::keep(tree, expr);
        self.replace(site, EditKind::Condition, SIGN, Term::unary(UnaryOp::Not, own()));
        for value in [true, false] {
            let constant = Term::new(TermKind::Bool(value), Type::BOOL);
            self.replace(site, EditKind::Condition, CALL, constant);
        }
        let is_part = |user: ExprId| {
            matches!(
                tree[user].kind,
                ExprKind::Binary {
                    op: BinaryOp::And | BinaryOp::Or,
                    ..
                }
            )
        };
        if self.shader.sites[site].user.is_some_and(is_part) {
            return;
        }
        let mut floats = self.values(statement, Type::FLOAT);
        let mut others: Vec<(u32, Option<Term>)> = Vec::new();
        for value in &floats {
            let positive = Term::binary(BinaryOp::Greater, value.clone(), Term::float(0.0));
            others.push((CONDITION, positive));
        }
        let bools = self.values(statement, Type::BOOL).into_iter();
        others.extend(bools.map(|value| (CONDITION, Some(value))));
        floats.truncate(MAX_PAIRED);
        for first in &floats {
            for second in floats.iter().filter(|second| *second != first) {
                let less = Term::binary(BinaryOp::Less, first.clone(), second.clone());
                others.push((COSINE, less));
            }
        }
        for (cost, other) in others {
            let term = other.and_then(|other| Term::binary(BinaryOp::And, own(), other));
            self.replace_any(site, EditKind::Condition, cost, term);
        }
    }
}
