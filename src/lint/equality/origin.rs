//! The origins of a float, and whether they round.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Tree, Type, UnaryOp, Value, VariableId, VariableKind,
};

use super::grid::Grid;
use crate::program::{Definition, Program, newest};
use crate::shape::Shape;

/// The maximum number of expressions examined; the origin is unknown beyond it.
const MAX_EXPRS: usize = 2_000;

/// Finds the origins of values, and caches those of variables.
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

    pub(super) fn origin(&mut self, expr: ExprId) -> Rc<Origin> {
        let grid = &self.grid;
        let find = || Rc::new(Origin::find(grid, expr));
        match grid.program.tree[expr].kind {
            ExprKind::Variable(variable) => Rc::clone(self.of_variables.entry(variable).or_insert_with(find)),
            _ => find(),
        }
    }
}

/// The possible origins of a value over all control flow.
#[derive(Debug, Default)]
pub(super) struct Origin {
    /// Whether some origin is unknown.
    is_unknown: bool,
    /// Whether the value may result from arithmetic that rounds.
    may_be_rounded: bool,
    /// Whether the rounded value is a sum or difference, which may miss zero.
    is_cancelled: bool,
    /// The constants that the value may equal without rounding.
    exact_values: Vec<f64>,
    /// Variables that pass the value on unchanged.
    aliases: HashSet<VariableId>,
}

impl Origin {
    fn find(grid: &Grid, expr: ExprId) -> Self {
        let mut origin = Self::default();
        let mut pending = vec![(expr, 1.0)];
        for _ in 0..MAX_EXPRS {
            match pending.pop() {
                Some((expr, sign)) if !origin.is_unknown => origin.follow(grid, expr, sign, &mut pending),
                _ => return origin,
            }
        }
        origin.is_unknown = true;
        origin
    }

    /// Whether the value is known to result from arithmetic that rounds.
    pub(super) fn is_rounded(&self) -> bool {
        self.may_be_rounded && !self.is_unknown
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.is_cancelled
    }

    /// Whether the value may equal this constant without rounding.
    pub(super) fn may_be_exactly(&self, value: f64) -> bool {
        self.exact_values.contains(&value)
    }

    /// Whether the other expression may be computed from this value, or from a variable that holds it: the
    /// two may then be equal by construction.
    pub(super) fn feeds(&self, program: &Program, own: ExprId, other: ExprId) -> bool {
        let tree = program.tree;
        let own = Shape::new(tree, own);
        let mut pending = vec![other];
        let mut seen = HashSet::new();
        for _ in 0..MAX_EXPRS {
            let Some(expr) = pending.pop() else {
                return false;
            };
            match tree[expr].kind {
                ExprKind::Variable(variable) if self.aliases.contains(&variable) => return true,
                ExprKind::Variable(variable) if seen.insert(variable) => {
                    for definition in newest(program.definitions(variable), MAX_EXPRS) {
                        match definition {
                            Definition::Value(value) | Definition::Change(value) => pending.push(*value),
                            Definition::External => {}
                        }
                    }
                }
                ExprKind::BuiltIn { .. } if own.is_some() && Shape::new(tree, expr) == own => return true,
                _ => tree[expr].kind.for_each_operand(|operand| pending.push(operand)),
            }
        }
        true
    }

    fn mark_rounded(&mut self) {
        self.may_be_rounded = true;
    }

    /// Marks a sum or difference that rounds.
    fn mark_cancelled(&mut self) {
        self.mark_rounded();
        self.is_cancelled = true;
    }

    fn follow(&mut self, grid: &Grid, expr: ExprId, sign: f64, pending: &mut Vec<(ExprId, f64)>) {
        let program = grid.program;
        let tree = program.tree;
        if let Some(constant) = tree.value(expr) {
            for scalar in constant.components() {
                if let Value::Float(value) = scalar {
                    self.exact_values.push(sign * value);
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
            ExprKind::Binary { .. } if grid.contains(expr) => {}
            ExprKind::Binary {
                op: BinaryOp::Add | BinaryOp::Subtract,
                ..
            } => self.mark_cancelled(),
            ExprKind::Binary { .. } => self.mark_rounded(),
            ExprKind::Conditional { yes, no, .. } => pending.extend([(*yes, sign), (*no, sign)]),
            ExprKind::Sequence { second: value, .. } | ExprKind::Assign { op: None, value, .. } => {
                pending.push((*value, sign));
            }
            ExprKind::Call { function, .. } => {
                let returned = newest(program.returned(*function), MAX_EXPRS);
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
                    self.is_unknown = true;
                }
            }
            // One component may be another's sentinel: a vector is followed only if all of its components
            // come from one value.
            ExprKind::Swizzle { vector: base, .. } | ExprKind::Index { base, .. }
                if matches!(tree[*base].ty, Type::Vector(..)) =>
            {
                pending.push((*base, sign));
            }
            _ => self.is_unknown = true,
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
        if !self.aliases.insert(variable) {
            return;
        }
        let definitions = grid.program.definitions(variable);
        if definitions.len() > MAX_EXPRS {
            self.is_unknown = true;
            return;
        }
        // A function cannot know whether its argument is exact, so its comparison is usually justified.
        self.is_unknown |= matches!(tree[variable].kind, VariableKind::Parameter(_))
            && definitions != [Definition::External];
        if definitions.is_empty() && matches!(tree[variable].kind, VariableKind::Local | VariableKind::Global)
        {
            self.exact_values.push(0.0);
        }
        // `x = floor(x);`: it is unknown which definition the comparison reads.
        let exact = |definition: &Definition| match definition {
            Definition::Value(value) => tree.value(*value).is_none() && grid.contains(*value),
            _ => false,
        };
        self.is_unknown |= definitions.len() > 1 && definitions.iter().any(exact);
        for definition in definitions {
            match definition {
                Definition::Value(value) => pending.push((*value, sign)),
                Definition::External => {}
                Definition::Change(change) => match tree[*change].kind {
                    ExprKind::Step { target, .. }
                    | ExprKind::Assign {
                        op: Some(_), target, ..
                    } => {
                        if !grid.contains(target) {
                            self.mark_cancelled();
                        }
                    }
                    _ => self.is_unknown = true,
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
            // At weights 0 and 1, `mix` returns its arguments unchanged.
            B::Mix => {
                pending.extend(arguments[..2].iter().map(|&argument| (argument, sign)));
                if !grid.contains(arguments[2]) {
                    self.mark_cancelled();
                }
            }
            B::Smoothstep => {
                self.exact_values.extend([0.0, sign]);
                self.mark_rounded();
            }
            B::Floor | B::Ceil | B::Trunc | B::Round | B::RoundEven | B::Sign | B::Step => {}
            B::Mod | B::Fract => {
                if !grid.contains(expr) {
                    self.mark_cancelled();
                }
            }
            B::Dot if is_square(grid.program.tree, arguments) => self.mark_rounded(),
            B::Sin | B::Cos | B::Tan | B::Dot | B::Cross | B::Reflect => self.mark_cancelled(),
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
            | B::Acos => self.mark_rounded(),
            _ => self.is_unknown = true,
        }
    }
}

/// Whether both arguments are the same vector.
fn is_square(tree: &Tree, arguments: &[ExprId]) -> bool {
    Shape::new(tree, arguments[0]) == Shape::new(tree, arguments[1])
}
