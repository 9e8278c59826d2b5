//! Strength reduction: operations with known operands are replaced by cheaper ones, which have the same bits
//! in every number type.

use super::ValueNumbering;
use crate::ir::{Operation, Value, ValueDef};

impl ValueNumbering<'_> {
    /// Returns a cheaper definition with the same value, or the same one.
    pub(super) fn reduce(&mut self, def: ValueDef) -> ValueDef {
        let ValueDef::Operation(operation, operands @ [a, b, _]) = def else {
            return def;
        };
        match operation {
            Operation::Div => match self.exact_reciprocal(b) {
                Some(reciprocal) => {
                    let reciprocal = self.constant(ValueDef::Float(reciprocal.to_bits()));
                    ValueDef::Operation(Operation::Mul, [a, reciprocal, operands[2]])
                }
                None => def,
            },
            // A traced run may replace the operand.
            Operation::FromUint if !self.traced && self.has_clear_sign(a) => {
                ValueDef::Operation(Operation::FromInt, operands)
            }
            _ => def,
        }
    }

    /// Returns the reciprocal of a constant power of two, unless the constant or its reciprocal is not normal
    /// in f32.
    fn exact_reciprocal(&self, value: Value) -> Option<f64> {
        let ValueDef::Float(bits) = self.function.def(value) else {
            return None;
        };
        let number = f64::from_bits(bits);
        let reciprocal = number.recip();
        let is_normal = |number: f64| (number as f32).is_normal();
        let is_power = bits << 12 == 0;
        (is_power && is_normal(number) && is_normal(reciprocal)).then_some(reciprocal)
    }

    /// Whether the highest bit of a word is known to be 0.
    fn has_clear_sign(&self, value: Value) -> bool {
        let ValueDef::Operation(operation, [a, b, _]) = self.function.def(value) else {
            return false;
        };
        let is_known = |operand, test: fn(u32) -> bool| self.known_word(operand).is_some_and(test);
        match operation {
            // Shifts are by the lowest five bits of a word.
            Operation::ShiftRightUint => is_known(b, |count| count & 31 > 0),
            Operation::And => [a, b]
                .into_iter()
                .any(|operand| is_known(operand, |word| word >> 31 == 0)),
            _ => false,
        }
    }
}
