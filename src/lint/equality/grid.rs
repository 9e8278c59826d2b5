//! Floats on a grid of integers, halves and finer fractions, on which `+ - *` do not round.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Input, UnaryOp, Value, VariableId, VariableKind,
};

use crate::program::{Definition, Program, is_float, newest};

/// The maximum number of expressions examined for one, which keeps the time linear in the size of a shader.
const MAX_EXPRS: usize = 500;

/// The spacing of the grid: multiples of this are on it.
const GRID_STEP: f64 = 1.0 / 1024.0;

/// Caches which expressions of a program lie on the grid.
pub(super) struct Grid<'a> {
    pub(super) program: &'a Program<'a>,
    known: RefCell<HashMap<ExprId, bool>>,
    /// Whether a function that rounds to integers defines the variable anywhere.
    rounded: RefCell<HashMap<VariableId, bool>>,
}

impl<'a> Grid<'a> {
    pub(super) fn new(program: &'a Program<'a>) -> Self {
        Self {
            program,
            known: RefCell::default(),
            rounded: RefCell::default(),
        }
    }

    /// Whether all values of an expression lie on the grid, or are not known to lie elsewhere.
    pub(super) fn contains(&self, expr: ExprId) -> bool {
        if let Some(&known) = self.known.borrow().get(&expr) {
            return known;
        }
        let holds = self.contains_within_budget(expr);
        self.known.borrow_mut().insert(expr, holds);
        holds
    }

    fn contains_within_budget(&self, expr: ExprId) -> bool {
        let mut pending = vec![expr];
        let mut seen: HashSet<VariableId> = HashSet::new();
        for left in (0..MAX_EXPRS).rev() {
            match pending.pop() {
                None => return true,
                Some(expr) if !stays_on_grid(self, expr, &mut seen, left, &mut pending) => return false,
                Some(_) => {}
            }
        }
        true
    }

    /// `x = floor(x);`: it is unknown which definition of `x` a use reads.
    fn is_rounded_somewhere(&self, variable: VariableId) -> bool {
        *self.rounded.borrow_mut().entry(variable).or_insert_with(|| {
            let mut definitions = self.program.definitions(variable).iter();
            definitions.any(|definition| match definition {
                Definition::Value(value) => rounds_to_whole(self.program, *value),
                _ => false,
            })
        })
    }
}

/// Whether an expression lies on the grid, provided that the operands pushed to `pending` do; at most `left`
/// of those will be examined.
fn stays_on_grid(
    grid: &Grid,
    expr: ExprId,
    seen: &mut HashSet<VariableId>,
    left: usize,
    pending: &mut Vec<ExprId>,
) -> bool {
    let program = grid.program;
    let tree = program.tree;
    if !is_float(tree[expr].ty) {
        return true;
    }
    if let Some(constant) = tree.value(expr) {
        return constant.components().iter().all(|scalar| match scalar {
            Value::Float(value) => (value / GRID_STEP).fract() == 0.0 && value.abs() < 65536.0,
            _ => true,
        });
    }
    match &tree[expr].kind {
        ExprKind::Variable(variable) => {
            let kind = tree[*variable].kind;
            if let VariableKind::Input(Input::Time | Input::TimeDelta | Input::FrameRate | Input::Date) = kind
            {
                return false;
            }
            if seen.insert(*variable) && !grid.is_rounded_somewhere(*variable) {
                for definition in newest(program.definitions(*variable), left) {
                    match definition {
                        Definition::Value(value) => pending.push(*value),
                        Definition::Change(change) => match tree[*change].kind {
                            ExprKind::Assign {
                                op: Some(BinaryOp::Divide),
                                value,
                                ..
                            } if !is_power_of_two(program, value) => {
                                return false;
                            }
                            ExprKind::Assign {
                                op: Some(BinaryOp::Divide),
                                ..
                            } => {}
                            ExprKind::Assign { value, .. } => pending.push(value),
                            _ => {}
                        },
                        Definition::External => {}
                    }
                }
            }
            true
        }
        ExprKind::Binary {
            op: BinaryOp::Divide,
            left,
            right,
        } => {
            pending.push(*left);
            is_power_of_two(program, *right)
        }
        ExprKind::Binary { left, right, .. } => {
            pending.extend([*left, *right]);
            true
        }
        ExprKind::Unary {
            op: UnaryOp::Minus | UnaryOp::Plus,
            operand: only,
        }
        | ExprKind::Swizzle { vector: only, .. }
        | ExprKind::Index { base: only, .. }
        | ExprKind::Sequence { second: only, .. }
        | ExprKind::Assign {
            op: None,
            value: only,
            ..
        } => {
            pending.push(*only);
            true
        }
        ExprKind::Conditional { yes, no, .. } => {
            pending.extend([*yes, *no]);
            true
        }
        ExprKind::Construct {
            constructor,
            arguments,
        } => {
            if !matches!(constructor, Constructor::Struct | Constructor::Array) {
                pending.extend(arguments);
            }
            true
        }
        ExprKind::Call { function, .. } => {
            pending.extend(newest(program.returned(*function), left));
            true
        }
        ExprKind::BuiltIn { function, arguments } => {
            let keeps = preserves_grid(*function);
            if keeps {
                pending.extend(arguments);
            }
            keeps || function.is_texture() || rounds_to_whole(program, expr)
        }
        _ => true,
    }
}

/// Whether a function maps arguments on the grid to results on it.
fn preserves_grid(function: BuiltIn) -> bool {
    use BuiltIn as B;
    matches!(
        function,
        B::Min | B::Max | B::Clamp | B::Abs | B::Mod | B::Fract | B::Dot | B::Mix
    )
}

fn rounds_to_whole(program: &Program, expr: ExprId) -> bool {
    use BuiltIn as B;
    matches!(
        program.tree[expr].kind,
        ExprKind::BuiltIn {
            function: B::Floor | B::Ceil | B::Trunc | B::Round | B::RoundEven | B::Sign | B::Step,
            ..
        }
    )
}

fn is_power_of_two(program: &Program, expr: ExprId) -> bool {
    program.constant(expr).is_some_and(|constant| {
        constant.components().iter().all(|scalar| match scalar {
            Value::Float(value) => value.abs().log2().fract() == 0.0,
            _ => false,
        })
    })
}
