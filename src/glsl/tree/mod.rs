//! The typed tree of a shader that passed all checks.
//!
//! Names are resolved to ids, every expression has its type, literals stay as written, and evaluation order
//! and short circuit are the source's. Parentheses, comments, macros and precision qualifiers are removed;
//! [`Place`]s refer back to the source text.
//!
//! Nodes are stored in arenas ([`Arena`]) and referred to by `Copy` ids: `tree[id]` reads any of them,
//! `tree.exprs.push(…)` adds one, and a pass that rewrites a function takes its body out
//! (`tree[f].body.take()`), changes it, and puts it back.
//!
//! Depth: blocks nest at most [`MAX_NESTING`](super::MAX_NESTING) deep, and operands a few times as deep, so
//! that recursion over them is safe, with one exception. The first operand of a chain `a + b + c + …` (also
//! of `,`, and of postfix `.x`, `[i]`) may be thousands deep: traverse it with a loop, or any expression with
//! [`Tree::postorder`], which does not recurse. `else if` chains are flat.

mod expr;
mod item;
mod types;
pub mod walk;

use std::collections::HashMap;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

pub use toyproof_diagnostic::Place;
pub use toyproof_image::{BLOCK_BYTES, Input, InputType};

pub use self::expr::{BinaryOp, Constructor, Expr, ExprId, ExprKind, Literal, StepOp, Swizzle, UnaryOp};
pub use self::item::{
    Arm, Block, BuiltInVariable, Case, Condition, Direction, Function, FunctionId, Item, Label, Statement,
    StatementKind, Variable, VariableId, VariableKind,
};
pub use self::types::{
    ArrayId, ArrayType, Constant, Member, Sampler, SamplerShape, Scalar, Struct, StructId, Type, Value,
};
pub use crate::built_in::{BuiltIn, Definition, Documentation, ExactDefinition, Instruction, Overload, Wgsl};

/// A type-checked shader.
#[derive(Debug, Clone, Default)]
pub struct Tree {
    /// All expressions.
    pub exprs: Arena<Expr>,
    /// All variables of all scopes, including inputs and built-in ones.
    pub variables: Arena<Variable>,
    /// All user functions.
    pub functions: Arena<Function>,
    /// All user-defined structures.
    pub structs: Arena<Struct>,
    /// The declarations at global scope, in source order.
    pub items: Vec<Item>,
    arrays: Arena<ArrayType>,
    array_ids: HashMap<ArrayType, ArrayId>,
    /// The cached values of constant expressions; `None` for those without a value.
    pub(super) values: HashMap<ExprId, Option<Constant>>,
}

impl Tree {
    /// Whether the entry point reads the color before it writes it: its first parameter is `inout`.
    pub fn adds_to_color(&self, entry: FunctionId) -> bool {
        let color = self[entry].parameters.first();
        color.is_some_and(|&color| self[color].kind == VariableKind::Parameter(Direction::InOut))
    }

    /// The type of arrays with `size` elements, created once.
    pub fn array_of(&mut self, element: Type, size: u32) -> Type {
        let array = ArrayType { element, size };
        let arrays = &mut self.arrays;
        Type::Array(*self.array_ids.entry(array).or_insert_with(|| arrays.push(array)))
    }

    /// The element type and size of an array type.
    pub fn array(&self, id: ArrayId) -> ArrayType {
        self.arrays[id]
    }

    /// The type in GLSL syntax: `vec3`, `Ray`, `float[4]`; `float[2][3]` is two arrays of three.
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

    /// A variable with its type, as every version of GLSL declares it: `float weights[4]`.
    pub fn declaration(&self, name: &str, ty: Type) -> String {
        let ty = self.type_name(ty);
        let (element, dimensions) = ty.split_at(ty.find('[').unwrap_or(ty.len()));
        format!("{element} {name}{dimensions}")
    }

    /// The scalar type of each component of a value: columns, members and elements in order. Empty for `void`
    /// and samplers.
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

    /// The expressions at and below `root`, operands before their users, in the order of evaluation.
    pub fn postorder(&self, root: ExprId) -> Vec<ExprId> {
        // Collects users before operands, last operand first; reversed, that is evaluation order.
        let mut order = Vec::new();
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            order.push(id);
            self[id].kind.for_each_operand(|operand| pending.push(operand));
        }
        order.reverse();
        order
    }

    /// An lvalue, and everything that it is a part of, from the inside out: `a[i].x`, `a[i]`, `a`.
    pub fn path(&self, lvalue: ExprId) -> impl Iterator<Item = ExprId> {
        std::iter::successors(Some(lvalue), |&node| match self[node].kind {
            ExprKind::Swizzle { vector: base, .. }
            | ExprKind::Member { structure: base, .. }
            | ExprKind::Index { base, .. } => Some(base),
            _ => None,
        })
    }

    /// The variable that an lvalue is or is a part of; `None` for other expressions.
    pub fn root_variable(&self, lvalue: ExprId) -> Option<VariableId> {
        match self[self.path(lvalue).last()?].kind {
            ExprKind::Variable(variable) => Some(variable),
            _ => None,
        }
    }

    /// The variables at global scope, in source order.
    pub fn global_variables(&self) -> impl Iterator<Item = VariableId> {
        self.items.iter().filter_map(|item| match *item {
            Item::Variable(variable) => Some(variable),
            _ => None,
        })
    }
}

/// A kind of node in a tree.
pub trait Node: Sized {
    /// The arena of these nodes.
    fn arena(tree: &Tree) -> &Arena<Self>;
    /// The mutable arena of these nodes.
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

// Arenas: one vector for each kind of node, and ids for its elements.
//
// Ids are `Copy`, so that passes can hold them during rewrites. Dropping a tree of any depth drops a few
// vectors, so that no input overflows the stack.

/// The id of one `T` in the arena that created it.
pub struct Id<T> {
    index: u32,
    of: PhantomData<fn() -> T>,
}

impl<T> Id<T> {
    /// The position in the arena, for side tables.
    pub fn index(self) -> usize {
        self.index as usize
    }
}

impl<T> Clone for Id<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Id<T> {}

impl<T> PartialEq for Id<T> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

impl<T> Eq for Id<T> {}

impl<T> PartialOrd for Id<T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Id<T> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.index.cmp(&other.index)
    }
}

impl<T> Hash for Id<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.index.hash(state);
    }
}

impl<T> fmt::Debug for Id<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.index)
    }
}

/// The nodes of one kind, in order of creation.
#[derive(Debug, Clone)]
pub struct Arena<T> {
    nodes: Vec<T>,
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { nodes: Vec::new() }
    }
}

impl<T> Arena<T> {
    /// Adds a node and returns its id.
    pub fn push(&mut self, node: T) -> Id<T> {
        let id = Self::id(self.nodes.len());
        self.nodes.push(node);
        id
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the arena is empty.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The ids of all nodes.
    pub fn ids(&self) -> impl Iterator<Item = Id<T>> + use<T> {
        (0..self.nodes.len()).map(Self::id)
    }

    /// All nodes with their ids.
    pub fn iter(&self) -> impl Iterator<Item = (Id<T>, &T)> {
        self.ids().zip(&self.nodes)
    }

    /// The preprocessor's token budget keeps all counts far below 2³².
    fn id(index: usize) -> Id<T> {
        Id {
            index: index as u32,
            of: PhantomData,
        }
    }
}

impl<T> Index<Id<T>> for Arena<T> {
    type Output = T;

    fn index(&self, id: Id<T>) -> &T {
        &self.nodes[id.index()]
    }
}

impl<T> IndexMut<Id<T>> for Arena<T> {
    fn index_mut(&mut self, id: Id<T>) -> &mut T {
        &mut self.nodes[id.index()]
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files, Span};

    use super::*;

    #[test]
    fn array_types_are_unique_and_named_outermost_first() {
        let mut tree = Tree::default();
        let inner = tree.array_of(Type::FLOAT, 3);
        let outer = tree.array_of(inner, 2);
        assert_eq!(tree.array_of(Type::FLOAT, 3), inner);
        assert_ne!(tree.array_of(Type::INT, 3), inner);
        assert_eq!(tree.type_name(outer), "float[2][3]");
    }

    #[test]
    fn postorder_visits_operands_first_at_any_depth() {
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
        let one = |value| ExprKind::Literal(Literal::new("1.", Value::Float(value)));
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
        // Replace the left operand by the right one, which halves the chain.
        let right = made[made.len() - 2];
        tree[chain].kind.for_each_operand_mut(|operand| *operand = right);
        assert_eq!(tree.postorder(chain), [right, right, chain]);
    }

    #[test]
    fn swizzles_detect_repeated_components() {
        assert!(Swizzle::new(&[0, 1, 0]).is_some_and(|s| s.repeats() && s.name() == "xyx"));
        assert!(Swizzle::new(&[3, 2]).is_some_and(|s| !s.repeats() && s.size() == 2));
        assert!(Swizzle::new(&[]).is_none() && Swizzle::new(&[4]).is_none());
    }
}
