//! Where a float comes from, as far as its rounding goes.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Tree, Type, UnaryOp, Value, VariableId, VariableKind,
};

use super::super::program::{Definition, Program, last};
use super::super::shape::Shape;
use super::grid::Grid;

/// How many expressions are looked at; of what has more, nothing is known.
const BUDGET: usize = 2_000;

/// Where the values of a program come from, each variable's looked for once.
pub(super) struct Origins<'a> {
    grid: Grid<'a>,
    of_variables: HashMap<VariableId, Rc<Origin>>,
}

impl<'a> Origins<'a> {
    pub(super) fn new(program: &'a Program<'a>) -> Self {
        Self {
            grid: Grid::new(program),
            of_variables: HashMap::new(),
        }
    }

    pub(super) fn of(&mut self, expr: ExprId) -> Rc<Origin> {
        let grid = &self.grid;
        let find = || Rc::new(Origin::of(grid, expr));
        match grid.program.tree[expr].kind {
            ExprKind::Variable(variable) => Rc::clone(self.of_variables.entry(variable).or_insert_with(find)),
            _ => find(),
        }
    }
}

/// All that a value may be, whichever way control goes.
#[derive(Debug, Default)]
pub(super) struct Origin {
    unknown: bool,
    rounded: bool,
    /// By a sum or difference, which may miss zero.
    cancelled: bool,
    /// What it is given as it is.
    given: Vec<f64>,
    /// The variables that hand it on.
    names: HashSet<VariableId>,
}

impl Origin {
    fn of(grid: &Grid, expr: ExprId) -> Self {
        let mut origin = Self::default();
        let mut pending = vec![(expr, 1.0)];
        for _ in 0..BUDGET {
            match pending.pop() {
                Some((expr, sign)) if !origin.unknown => origin.follow(grid, expr, sign, &mut pending),
                _ => return origin,
            }
        }
        origin.unknown = true;
        origin
    }

    /// Whether it is known to come out of arithmetic that rounds.
    pub(super) fn is_rounded(&self) -> bool {
        self.rounded && !self.unknown
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled
    }

    /// Whether it may be just this, unrounded.
    pub(super) fn is_given(&self, value: f64) -> bool {
        self.given.contains(&value)
    }

    /// Whether the other expression may be computed from this value, or from a variable that it is: then the two may be the
    /// same by more than chance.
    pub(super) fn feeds(&self, program: &Program, own: ExprId, other: ExprId) -> bool {
        let tree = program.tree;
        let own = Shape::of(tree, own);
        let mut pending = vec![other];
        let mut seen = HashSet::new();
        for _ in 0..BUDGET {
            let Some(expr) = pending.pop() else {
                return false;
            };
            match tree[expr].kind {
                ExprKind::Variable(variable) if self.names.contains(&variable) => return true,
                ExprKind::Variable(variable) if seen.insert(variable) => {
                    for definition in last(program.definitions(variable), BUDGET) {
                        match definition {
                            Definition::Value(value) | Definition::Change(value) => pending.push(*value),
                            Definition::Outside => {}
                        }
                    }
                }
                ExprKind::BuiltIn { .. } if own.is_some() && Shape::of(tree, expr) == own => return true,
                _ => tree[expr].kind.for_each_operand(|operand| pending.push(operand)),
            }
        }
        true
    }

    fn round(&mut self, cancels: bool) {
        self.rounded = true;
        self.cancelled |= cancels;
    }

    fn follow(&mut self, grid: &Grid, expr: ExprId, sign: f64, pending: &mut Vec<(ExprId, f64)>) {
        let program = grid.program;
        let tree = program.tree;
        if let Some(constant) = tree.value(expr) {
            for scalar in constant.components() {
                if let Value::Float(value) = scalar {
                    self.given.push(sign * value);
                }
            }
            return;
        }
        match &tree[expr].kind {
            ExprKind::Variable(variable) => self.follow_variable(grid, *variable, sign, pending),
            ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => pending.push((*operand, -sign)),
            ExprKind::Unary {
                op: UnaryOp::Plus,
                operand,
            } => pending.push((*operand, sign)),
            ExprKind::Binary { op, .. } => {
                if !grid.holds(expr) {
                    self.round(matches!(op, BinaryOp::Add | BinaryOp::Subtract));
                }
            }
            ExprKind::Conditional { yes, no, .. } => pending.extend([(*yes, sign), (*no, sign)]),
            ExprKind::Sequence { second: value, .. } | ExprKind::Assign { op: None, value, .. } => {
                pending.push((*value, sign));
            }
            ExprKind::Call { function, .. } => {
                let returned = last(program.returned(*function), BUDGET);
                pending.extend(returned.iter().map(|&value| (value, sign)));
            }
            ExprKind::BuiltIn { function, arguments } => {
                self.follow_built_in(grid, expr, *function, arguments, sign, pending);
            }
            ExprKind::Construct {
                constructor: Constructor::Scalar | Constructor::Splat,
                arguments,
            } => {
                if let Type::FLOAT = tree[arguments[0]].ty {
                    pending.push((arguments[0], sign));
                } else if tree[arguments[0]].ty.component_count() != Some(1) {
                    self.unknown = true;
                }
            }
            // One component may be another's sentinel: followed only where all of them are alike.
            ExprKind::Swizzle { vector: base, .. } | ExprKind::Index { base, .. }
                if matches!(tree[*base].ty, Type::Vector(..)) =>
            {
                pending.push((*base, sign));
            }
            _ => self.unknown = true,
        }
    }

    fn follow_variable(
        &mut self,
        grid: &Grid,
        variable: VariableId,
        sign: f64,
        pending: &mut Vec<(ExprId, f64)>,
    ) {
        let tree = grid.program.tree;
        if !self.names.insert(variable) {
            return;
        }
        let definitions = grid.program.definitions(variable);
        if definitions.len() > BUDGET {
            self.unknown = true;
            return;
        }
        // A function cannot know that its argument is exact, and most often is right to ask.
        self.unknown |=
            matches!(tree[variable].kind, VariableKind::Parameter(_)) && definitions != [Definition::Outside];
        if definitions.is_empty() && matches!(tree[variable].kind, VariableKind::Local | VariableKind::Global)
        {
            self.given.push(0.0);
        }
        // `x = floor(x);`: which of its values is compared, is not known.
        let exact = |definition: &Definition| match definition {
            Definition::Value(value) => tree.value(*value).is_none() && grid.holds(*value),
            _ => false,
        };
        self.unknown |= definitions.len() > 1 && definitions.iter().any(exact);
        for definition in definitions {
            match definition {
                Definition::Value(value) => pending.push((*value, sign)),
                Definition::Outside => {}
                Definition::Change(change) => match tree[*change].kind {
                    ExprKind::Step { target, .. }
                    | ExprKind::Assign {
                        op: Some(_), target, ..
                    } => {
                        if !grid.holds(target) {
                            self.round(true);
                        }
                    }
                    _ => self.unknown = true,
                },
            }
        }
    }

    fn follow_built_in(
        &mut self,
        grid: &Grid,
        expr: ExprId,
        function: BuiltIn,
        arguments: &[ExprId],
        sign: f64,
        pending: &mut Vec<(ExprId, f64)>,
    ) {
        use BuiltIn as B;
        match function {
            B::Min | B::Max | B::Clamp => pending.extend(arguments.iter().map(|&argument| (argument, sign))),
            B::Abs => pending.extend([(arguments[0], 1.0), (arguments[0], -1.0)]),
            // At both ends it gives its arguments as they are.
            B::Mix => {
                pending.extend(arguments[..2].iter().map(|&argument| (argument, sign)));
                if !grid.holds(arguments[2]) {
                    self.round(true);
                }
            }
            B::Smoothstep => {
                self.given.extend([0.0, sign]);
                self.round(false);
            }
            B::Floor | B::Ceil | B::Trunc | B::Round | B::RoundEven | B::Sign | B::Step => {}
            B::Mod | B::Fract => {
                if !grid.holds(expr) {
                    self.round(true);
                }
            }
            B::Dot if is_square(grid.program.tree, arguments) => self.round(false),
            B::Sin | B::Cos | B::Tan | B::Dot | B::Cross | B::Reflect => self.round(true),
            B::Sqrt
            | B::InverseSqrt
            | B::Pow
            | B::Exp
            | B::Exp2
            | B::Log
            | B::Log2
            | B::Length
            | B::Distance
            | B::Normalize
            | B::Atan
            | B::Asin
            | B::Acos => self.round(false),
            _ => self.unknown = true,
        }
    }
}

/// Whether a vector is multiplied by itself.
fn is_square(tree: &Tree, arguments: &[ExprId]) -> bool {
    Shape::of(tree, arguments[0]) == Shape::of(tree, arguments[1])
}
