//! The typed tree: a shader whose every rule has been checked.
//!
//! Names are resolved to ids, every expression has its type, literals stay as written, and evaluation order and
//! short circuit are as the author wrote them. Parentheses, comments, macros and precision qualifiers are gone;
//! [`Place`]s lead back to the text.
//!
//! Nodes live in arenas ([`Arena`]) and are named by `Copy` ids: `tree[id]` reads any of them, `tree.exprs.push(…)` makes
//! one, and a pass that rewrites a function takes its body out (`tree[f].body.take()`), works, and puts it back.
//!
//! Depth: blocks nest at most [`MAX_NESTING`](super::MAX_NESTING) deep, and operands a few times as deep, so that recursion over them
//! is safe, with one exception. The first operand of a chain `a + b + c + …` (also of `,`, and of postfix `.x`, `[i]`) may be thousands
//! deep: walk it with a loop, or any expression with [`Tree::postorder`], which needs no stack. `else if` chains are flat.

mod arena;
mod builtin;
mod constant;
mod expr;
mod item;
mod operator;
mod place;
mod statement;
mod types;
pub mod walk;

use std::collections::HashMap;
use std::ops::{Index, IndexMut};

pub use arena::{Arena, Id};
pub use builtin::BuiltIn;
pub use constant::{Constant, Value};
pub use expr::{Constructor, Expr, ExprId, ExprKind, Literal, Swizzle};
pub use item::{
    BuiltInVariable, Direction, Function, FunctionId, Input, Item, Variable, VariableId, VariableKind,
};
pub use operator::{BinaryOp, StepOp, UnaryOp};
pub use place::Place;
pub use statement::{Arm, Block, Case, Condition, Label, Statement, StatementKind};
pub use types::{ArrayId, ArrayType, Member, Sampler, SamplerShape, Scalar, Struct, StructId, Type};

/// A type-checked shader.
#[derive(Debug, Clone, Default)]
pub struct Tree {
    /// Every expression.
    pub exprs: Arena<Expr>,
    /// Every variable of every scope, the inputs and built-in ones included.
    pub variables: Arena<Variable>,
    /// Every function of the author.
    pub functions: Arena<Function>,
    /// Every structure of the author.
    pub structs: Arena<Struct>,
    /// The author's declarations at global scope, in order.
    pub items: Vec<Item>,
    arrays: Arena<ArrayType>,
    array_ids: HashMap<ArrayType, ArrayId>,
    /// The values of constant expressions, as far as they are kept; none of those without a value.
    pub(super) values: HashMap<ExprId, Option<Constant>>,
}

impl Tree {
    /// The type of arrays of `size` elements.
    pub fn array_of(&mut self, element: Type, size: u32) -> Type {
        let array = ArrayType { element, size };
        let arrays = &mut self.arrays;
        Type::Array(*self.array_ids.entry(array).or_insert_with(|| arrays.push(array)))
    }

    /// What an array type is made of.
    #[must_use]
    pub fn array(&self, id: ArrayId) -> ArrayType {
        self.arrays[id]
    }

    /// The type as GLSL writes it: `vec3`, `Ray`, `float[4]`; `float[2][3]` is two arrays of three.
    #[must_use]
    pub fn type_name(&self, mut ty: Type) -> String {
        let mut dimensions = Vec::new();
        while let Type::Array(id) = ty {
            dimensions.push(format!("[{}]", self.arrays[id].size));
            ty = self.arrays[id].element;
        }
        let name = match ty {
            Type::Void => "void".to_owned(),
            Type::Scalar(scalar) => scalar.name().to_owned(),
            Type::Vector(scalar, size) => format!("{}vec{size}", scalar.vector_prefix()),
            Type::Matrix { columns, rows } if columns == rows => format!("mat{columns}"),
            Type::Matrix { columns, rows } => format!("mat{columns}x{rows}"),
            Type::Sampler(sampler) => sampler.name(),
            Type::Struct(id) if self.structs[id].name.is_empty() => "struct".to_owned(),
            Type::Struct(id) => self.structs[id].name.clone(),
            Type::Array(_) | Type::Error => "?".to_owned(),
        };
        name + &dimensions.concat()
    }

    /// What each component of a value is: columns, members and elements in order. None of `void` and samplers.
    #[must_use]
    pub fn scalars(&self, ty: Type) -> Vec<Scalar> {
        match ty {
            Type::Array(id) => {
                let ArrayType { element, size } = self.arrays[id];
                self.scalars(element).repeat(size as usize)
            }
            Type::Struct(id) => {
                let members = self.structs[id].members.iter();
                members.flat_map(|member| self.scalars(member.ty)).collect()
            }
            _ => {
                let count = ty.component_count().map_or(0, usize::from);
                ty.scalar().map_or_else(Vec::new, |scalar| vec![scalar; count])
            }
        }
    }

    /// The expressions at and below `root`, operands before what uses them, in the order of evaluation.
    #[must_use]
    pub fn postorder(&self, root: ExprId) -> Vec<ExprId> {
        // Users before operands, the last operand first; reversed, that is the order wanted.
        let mut order = Vec::new();
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            order.push(id);
            self[id].kind.for_each_operand(|operand| pending.push(operand));
        }
        order.reverse();
        order
    }

    /// The variable that an lvalue is, or is a part of; none for other expressions.
    #[must_use]
    pub fn root_variable(&self, mut lvalue: ExprId) -> Option<VariableId> {
        loop {
            lvalue = match self[lvalue].kind {
                ExprKind::Variable(variable) => return Some(variable),
                ExprKind::Swizzle { vector: base, .. }
                | ExprKind::Member { structure: base, .. }
                | ExprKind::Index { base, .. } => base,
                _ => return None,
            };
        }
    }
}

/// A kind of node that trees hold.
pub trait Node: Sized {
    /// Where a tree holds them.
    fn arena(tree: &Tree) -> &Arena<Self>;
    /// The same, to change them.
    fn arena_mut(tree: &mut Tree) -> &mut Arena<Self>;
}

macro_rules! nodes {
    ($($node:ty: $field:ident),*) => {$(
        impl Node for $node {
            fn arena(tree: &Tree) -> &Arena<Self> {
                &tree.$field
            }

            fn arena_mut(tree: &mut Tree) -> &mut Arena<Self> {
                &mut tree.$field
            }
        }
    )*};
}

nodes!(Expr: exprs, Variable: variables, Function: functions, Struct: structs);

impl<T: Node> Index<Id<T>> for Tree {
    type Output = T;

    fn index(&self, id: Id<T>) -> &T {
        &T::arena(self)[id]
    }
}

impl<T: Node> IndexMut<Id<T>> for Tree {
    fn index_mut(&mut self, id: Id<T>) -> &mut T {
        &mut T::arena_mut(self)[id]
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files, Span};

    use super::*;

    #[test]
    fn an_array_type_is_made_once_and_named_outside_in() {
        let mut tree = Tree::default();
        let inner = tree.array_of(Type::FLOAT, 3);
        let outer = tree.array_of(inner, 2);
        assert_eq!(tree.array_of(Type::FLOAT, 3), inner);
        assert_ne!(tree.array_of(Type::INT, 3), inner);
        assert_eq!(tree.type_name(outer), "float[2][3]");
    }

    #[test]
    fn postorder_gives_operands_first_and_survives_any_depth() {
        let mut tree = Tree::default();
        let file = Files::default().add(File::new("a", ""));
        let mut push = |kind| {
            tree.exprs.push(Expr {
                kind,
                ty: Type::FLOAT,
                constant: true,
                at: Place::plain(Span::new(file, 0, 0)),
            })
        };
        let one = |value| {
            ExprKind::Literal(Literal {
                text: "1.".into(),
                value: Value::Float(value),
            })
        };
        let mut made = vec![push(one(0.0))];
        let mut chain = made[0];
        for value in 0..100_000 {
            let right = push(one(f64::from(value)));
            chain = push(ExprKind::Binary {
                op: BinaryOp::Add,
                left: chain,
                right,
            });
            made.extend([right, chain]);
        }
        assert_eq!(tree.postorder(chain), made);
        // Put the right operand in place of the left one: half of the chain is gone.
        let right = made[made.len() - 2];
        tree[chain].kind.for_each_operand_mut(|operand| *operand = right);
        assert_eq!(tree.postorder(chain), [right, right, chain]);
    }

    #[test]
    fn a_swizzle_knows_its_repeats() {
        assert!(Swizzle::new(&[0, 1, 0]).is_some_and(|s| s.repeats() && s.name() == "xyx"));
        assert!(Swizzle::new(&[3, 2]).is_some_and(|s| !s.repeats() && s.size() == 2));
        assert!(Swizzle::new(&[]).is_none() && Swizzle::new(&[4]).is_none());
    }
}
