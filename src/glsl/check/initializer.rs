//! Initializers: expressions, and the lists of desktop GLSL (GLSL 4.60 §4.1.14).

use toyproof_diagnostic::{Code, plural};

use super::{Checker, Initializer};
use crate::reporting::given;
use crate::tree::{Constructor, ExprId, Scalar, Type};

impl Checker<'_> {
    /// The type that an initializer gives a variable of `dimensions` array dimensions.
    pub(super) fn initializer_type(
        &mut self,
        initializer: &Initializer,
        base: Type,
        dimensions: usize,
    ) -> Type {
        match initializer {
            Initializer::Expression(expr) => self.ty(*expr),
            Initializer::List { items, .. } if dimensions > 0 => {
                let element = self.initializer_type(&items[0], base, dimensions - 1);
                match element {
                    Type::Error => Type::Error,
                    element => self.tree.array_of(element, items.len() as u32),
                }
            }
            Initializer::List { .. } => base,
        }
    }

    /// The value of an initializer for a variable of this type.
    pub(super) fn initial_value(&mut self, initializer: Initializer, ty: Type) -> ExprId {
        let (items, at) = match initializer {
            Initializer::Expression(expr) => return expr,
            Initializer::List { items, at } => (items, at),
        };
        let parts: Vec<Type> = match ty {
            Type::Array(id) => {
                let array = self.tree.array(id);
                vec![array.element; array.size as usize]
            }
            Type::Struct(id) => self.tree[id].members.iter().map(|member| member.ty).collect(),
            Type::Vector(scalar, size) => vec![Type::Scalar(scalar); usize::from(size)],
            Type::Matrix { columns, rows } => {
                vec![Type::vector(Scalar::Float, rows); usize::from(columns)]
            }
            Type::Error => return self.error_expr(at),
            _ => {
                let message = format!("a value of type {} is no list", self.quoted_type(ty));
                return self.refuse(Code::BadConstructor, at, message);
            }
        };
        if parts.len() != items.len() {
            let message = format!(
                "{} has {} {}, but {}",
                self.quoted_type(ty),
                parts.len(),
                plural(parts.len() as u64, "part", "parts"),
                given(items.len())
            );
            return self.refuse(Code::BadConstructor, at, message);
        }
        let values = items.into_iter().zip(parts).map(|(item, part)| {
            let value = self.initial_value(item, part);
            self.expect(value, part, "this item")
        });
        let values: Vec<ExprId> = values.collect();
        let constructor = match ty {
            Type::Array(_) => Constructor::Array,
            Type::Struct(_) => Constructor::Struct,
            Type::Matrix { .. } => Constructor::Matrix,
            _ => Constructor::Vector,
        };
        self.push_constructor(constructor, ty, values, at)
    }
}
