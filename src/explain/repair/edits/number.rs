//! Edits of numbers: other literals, the numbers of the scene, and vectors of them.

use std::f64::consts::{PI, TAU};

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::tree::{Constructor, Expr, ExprId, ExprKind, Literal, Scalar, Tree, Type, UnaryOp, Value};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_scene::{Scene, export};
use toyproof_verify::Expected;

use super::super::copied::Definitions;
use super::super::edit::EditKind;
use super::super::term::{Term, TermKind};
use super::donor::{Donor, assignments, donors};
use super::plausibility::Shapes;
use super::writer::{At, Writer};
use crate::engine::fit::{Fit, rounded};
use crate::engine::tournament::Values;

/// The costs: numbers of the scene that the shader lacks, those that it has, other numbers, vectors of the
/// scene, numbers with another last digit, fitted numbers, and variables.
const SCENE: u32 = 10;
const OWN: u32 = 14;
const RELATED: u32 = 12;
const VECTOR: u32 = 13;
const NEAR: u32 = 24;
const FITTED: u32 = 30;
const VARIABLE: u32 = 16;

/// The largest difference of the last digit.
const MAX_STEPS: u32 = 5;

/// The largest number that an edit writes: larger ones are used as infinity.
const MAX_NUMBER: f64 = 1e6;

/// The smallest factor of a hash, such as `43758.5453123`.
const MIN_HASH_FACTOR: f64 = 1000.0;

/// The parts of the reference shader, or of the one that renders the scene: its numbers, vectors, shapes of
/// operations, and donors.
#[derive(Debug, Default)]
pub(crate) struct Constants {
    pub(super) floats: Vec<f64>,
    integers: Vec<i32>,
    vectors: Vec<Vec<f64>>,
    pub(super) shapes: Shapes,
    pub(crate) donors: Vec<Donor>,
    /// Its assignments, as donors.
    pub(super) assignments: Vec<Donor>,
    /// The numbers of hashes.
    hash: Vec<u64>,
    /// The functions.
    pub(crate) definitions: Definitions,
}

impl Constants {
    /// Collects the numbers of a reference; empty if it has no shader.
    pub(crate) fn new(expected: &Expected) -> Self {
        match (expected.shader(), expected.scene()) {
            (Some(shader), _) => Self::in_trees(&[&shader.tree]),
            (None, Some(scene)) => Self::in_scene(scene),
            (None, None) => Self::default(),
        }
    }

    fn in_scene(scene: &Scene) -> Self {
        let mut files = Files::default();
        let Ok(shader) = export::marked_shader(scene) else {
            return Self::default();
        };
        let file = files.add(File::new("<scene>", shader.text.as_str()));
        glsl::check(&files, file, &glsl::Options::default())
            .map(|checked| Self::in_trees(&[&checked.tree]))
            .unwrap_or_default()
    }

    /// Collects the numbers of the passes of a reference.
    pub(crate) fn in_trees(trees: &[&Tree]) -> Self {
        let mut constants = Self {
            shapes: Shapes::new(trees),
            donors: donors(trees.iter().copied()),
            assignments: trees.iter().flat_map(|tree| assignments(tree)).collect(),
            hash: trees.iter().flat_map(|tree| hash_numbers(tree)).collect(),
            definitions: Definitions::new(trees),
            ..Self::default()
        };
        let exprs = trees
            .iter()
            .flat_map(|tree| tree.exprs.iter().map(move |(id, expr)| (*tree, id, expr)));
        for (tree, id, expr) in exprs {
            match &expr.kind {
                ExprKind::Literal(literal) => match literal.value {
                    Value::Float(value) => add(&mut constants.floats, value),
                    Value::Int(value) => add(&mut constants.integers, value),
                    _ => {}
                },
                ExprKind::Construct { arguments, .. }
                    if matches!(expr.ty, Type::Vector(Scalar::Float, _)) =>
                {
                    let components: Option<Vec<f64>> =
                        arguments.iter().map(|&argument| number(tree, argument)).collect();
                    let size = usize::from(tree[id].ty.component_count().unwrap_or(0));
                    if let Some(vector) = components.filter(|components| components.len() == size) {
                        add(&mut constants.vectors, vector);
                    }
                }
                _ => {}
            }
        }
        constants
    }

    /// Whether a number is one of the scene's, apart from its sign.
    pub(super) fn has(&self, number: f64) -> bool {
        self.floats
            .iter()
            .any(|&own| own.to_bits() == number.abs().to_bits())
    }

    /// Whether a shader has a number of the hash from which the reference draws random numbers.
    pub(crate) fn has_hash_of(&self, checked: &Checked) -> bool {
        let numbers = hash_numbers(&checked.tree);
        numbers.iter().any(|number| self.hash.contains(number))
    }

    /// Whether a vector is one of the scene's.
    pub(super) fn has_vector(&self, vector: &Vec<f64>) -> bool {
        self.vectors.contains(vector)
    }
}

fn add<T: PartialEq>(all: &mut Vec<T>, value: T) {
    if !all.contains(&value) {
        all.push(value);
    }
}

/// The numbers of a shader's hashes, as bits: large constants, except round ones and the powers of 2 that
/// scale integers to floats.
fn hash_numbers(tree: &Tree) -> Vec<u64> {
    let number = |expr: &Expr| match &expr.kind {
        ExprKind::Literal(Literal { value, .. }) => match *value {
            Value::Float(value) => Some(value),
            Value::Int(value) => Some(f64::from(value)),
            Value::Uint(value) => Some(f64::from(value)),
            Value::Bool(_) => None,
        },
        _ => None,
    };
    let numbers = tree.exprs.iter().filter_map(|(_, expr)| number(expr));
    numbers
        .filter(|&number| is_hash_number(number.abs()))
        .map(f64::to_bits)
        .collect()
}

/// The value of the last digit that an author would write of a number.
fn last_digit(number: f64) -> f64 {
    let text = number.to_string();
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    10f64.powi(-i32::try_from(decimals).unwrap_or(0))
}

fn is_hash_number(number: f64) -> bool {
    let is_round = number % (MIN_HASH_FACTOR / 10.0) == 0.0;
    let is_power = |number: f64| number.log2().fract() == 0.0;
    number >= MIN_HASH_FACTOR && !is_round && !is_power(number) && !is_power(number + 1.0)
}

/// The value of a literal with an optional sign.
pub(super) fn number(tree: &Tree, expr: ExprId) -> Option<f64> {
    match &tree[expr].kind {
        ExprKind::Literal(Literal {
            value: Value::Float(value),
            ..
        }) => Some(*value),
        ExprKind::Literal(Literal {
            value: Value::Int(value),
            ..
        }) => Some(f64::from(*value)),
        ExprKind::Unary {
            op: UnaryOp::Minus,
            operand,
        } => number(tree, *operand).map(|value| -value),
        _ => None,
    }
}

impl Writer<'_> {
    pub(super) fn number(&mut self, at: At) {
        match &self.tree[at.expr].kind {
            ExprKind::Literal(literal) => match literal.value {
                Value::Float(value) => self.float(at, value),
                Value::Int(value) => self.integer(at, value),
                Value::Bool(value) => {
                    let other = Term::new(TermKind::Bool(!value), Type::BOOL);
                    self.replace(at, EditKind::Condition, RELATED, other);
                }
                Value::Uint(_) => {}
            },
            ExprKind::Construct {
                constructor: Constructor::Vector | Constructor::Splat,
                arguments,
            } => {
                self.vector(at, arguments);
            }
            _ => {}
        }
    }

    fn float(&mut self, at: At, old: f64) {
        let mut values: Vec<(f64, u32)> = Vec::new();
        let mut add = |value: f64, cost| {
            let is_new = values.iter().all(|(known, _)| known.to_bits() != value.to_bits());
            if is_new && value.abs() <= MAX_NUMBER && value.to_bits() != old.to_bits() {
                values.push((value, cost));
            }
        };
        for &value in &self.constants.floats {
            let is_own = self.own_numbers.contains(&value.to_bits());
            add(value, if is_own { OWN } else { SCENE });
            add(-value, if is_own { OWN + 2 } else { RELATED });
        }
        // As an author would write it: 0.1 rather than 0.1000…01.
        for value in related(old) {
            add(rounded(value, 12), RELATED);
        }
        // A wrong last digit. A number that moves edges cannot be fitted.
        let unit = last_digit(old);
        for steps in 1..=MAX_STEPS {
            for value in [old + f64::from(steps) * unit, old - f64::from(steps) * unit] {
                add(rounded(value, 12), NEAR);
            }
        }
        let values = Values::Tried {
            values,
            fit: Some((FITTED, Fit::Number(old))),
        };
        self.replace_with(at, EditKind::Number, SCENE, Term::fitted(), values);
        self.variables(at, VARIABLE + 2);
    }

    /// Replaces numbers by variables.
    fn variables(&mut self, at: At, cost: u32) {
        if self.shader.sites[at.site].exprs.len() == 1 {
            for value in self.values(at.statement, at.ty) {
                self.replace(at, EditKind::Variable, cost, value);
            }
        }
    }

    fn integer(&mut self, at: At, old: i32) {
        let near = [
            old.wrapping_add(1),
            old.wrapping_sub(1),
            old.wrapping_mul(2),
            old / 2,
            old.wrapping_neg(),
        ];
        let related = near.into_iter().chain([0, 1, 2]).map(|value| (value, RELATED));
        let mut tried = vec![old];
        for (value, cost) in self
            .constants
            .integers
            .iter()
            .map(|&value| (value, SCENE))
            .chain(related)
        {
            if !tried.contains(&value) {
                tried.push(value);
                self.replace(at, EditKind::Number, cost, Term::int(value));
            }
        }
        self.variables(at, VARIABLE);
    }

    /// Replaces a vector of literals by those of the scene, and by one with exchanged components.
    fn vector(&mut self, at: At, arguments: &[ExprId]) {
        let numbers = arguments.iter().map(|&argument| number(self.tree, argument));
        let Some(old) = numbers.collect::<Option<Vec<f64>>>() else {
            return;
        };
        if at.ty.scalar() != Some(Scalar::Float) {
            return;
        }
        let is_splat = old.len() == 1;
        let size = usize::from(at.ty.component_count().unwrap_or(1));
        let old = if is_splat { vec![old[0]; size] } else { old };
        self.variables(at, VARIABLE);
        let construct = |constructor, numbers: &[f64]| {
            let arguments = numbers.iter().map(|&value| Term::float(value)).collect();
            Term::construct(constructor, arguments, at.ty)
        };
        for vector in &self.constants.vectors {
            // Single numbers are separate edits.
            let changed = vector.iter().zip(&old).filter(|(new, old)| new != old).count();
            if vector.len() == old.len() && (changed > 1 || (is_splat && changed > 0)) {
                self.replace(
                    at,
                    EditKind::Number,
                    VECTOR,
                    construct(Constructor::Vector, vector),
                );
            }
        }
        for (first, second) in
            (0..size).flat_map(|first| (first + 1..size).map(move |second| (first, second)))
        {
            if old.len() == size && old[first].to_bits() != old[second].to_bits() {
                let mut swapped = old.clone();
                swapped.swap(first, second);
                self.replace(
                    at,
                    EditKind::Arguments,
                    RELATED,
                    construct(Constructor::Vector, &swapped),
                );
            }
        }
        if let [red, green, blue] = old[..] {
            let components = (0..3)
                .map(|at| Term::new(TermKind::Fitted(at), Type::FLOAT))
                .collect();
            let color = Term::construct(Constructor::Vector, components, at.ty);
            let fit = Some((FITTED, Fit::Color([red, green, blue])));
            let values = Values::Tried {
                values: Vec::new(),
                fit,
            };
            self.replace_with(at, EditKind::Number, FITTED, color, values);
        }
        if !is_splat {
            let splat = construct(Constructor::Splat, &old[..1]);
            self.replace(at, EditKind::Number, VECTOR + 4, splat);
        }
    }
}

/// The numbers that an author may have meant instead of another.
fn related(old: f64) -> [f64; 31] {
    [
        -old,
        old + 1.0,
        old - 1.0,
        2.0 * old,
        old / 2.0,
        10.0 * old,
        old / 10.0,
        100.0 * old,
        old / 100.0,
        1000.0 * old,
        old / 1000.0,
        PI * old,
        old / PI,
        TAU * old,
        old / TAU,
        4.0 * old,
        old / 4.0,
        1.0 / old,
        old * old,
        old.sqrt(),
        1.0 - old,
        0.0,
        0.5,
        1.0,
        2.0,
        3.0,
        PI,
        old * 255.0,
        old / 255.0,
        old.to_degrees(),
        old.to_radians(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_digit_is_the_last_one_that_is_written() {
        for (number, digit) in [(2.6, 0.1), (0.25, 0.01), (-15.0, 1.0), (1e6, 1.0)] {
            assert_eq!(last_digit(number), digit, "{number}");
        }
    }

    #[test]
    fn hashes_have_large_numbers_that_are_not_round() {
        for number in [43_758.545_312_3, 747_796_405.0, 1_973.0] {
            assert!(is_hash_number(number), "{number}");
        }
        for number in [1e6, 10_000.0, 16_777_216.0, 4_294_967_295.0, 12.9898] {
            assert!(!is_hash_number(number), "{number}");
        }
    }
}
