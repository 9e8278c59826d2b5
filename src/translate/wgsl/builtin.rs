//! Built-in functions: most have their name in WGSL, some are operators there, few are missing.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, Scalar, Type};

use super::Unprintable;
use super::text::{Class, Printed, Text};
use super::writer::Writer;

impl Writer<'_> {
    pub(super) fn built_in(&mut self, function: BuiltIn, arguments: &[ExprId], ty: Type) -> Printed {
        use BuiltIn as B;
        if function.is_texture() {
            return self.lookup(function, arguments, ty);
        }
        let types: Vec<Type> = arguments
            .iter()
            .map(|&argument| self.draft.tree[argument].ty)
            .collect();
        let outer = self.suffixed;
        let is_abstract = arguments.iter().all(|&argument| self.is_abstract(argument));
        self.suffixed |= is_abstract;
        let texts = self.values(arguments);
        self.suffixed = outer;
        let mut texts = texts?;
        let relation = match function {
            B::LessThan => Some(BinaryOp::Less),
            B::LessThanEqual => Some(BinaryOp::LessEqual),
            B::GreaterThan => Some(BinaryOp::Greater),
            B::GreaterThanEqual => Some(BinaryOp::GreaterEqual),
            B::Equal => Some(BinaryOp::Equal),
            B::NotEqual => Some(BinaryOp::NotEqual),
            _ => None,
        };
        if let Some(op) = relation {
            // Told as numbers: WGSL compares vectors component by component.
            let words: Vec<_> = texts.into_iter().map(Text::term).collect();
            return Ok(Text {
                words: words.join(&format!(" {} ", op.symbol())),
                class: Class::Relation,
            });
        }
        self.derives |= function.is_derivative();
        let name = match function {
            B::Mod => return self.modulo(texts, ty, types.last().copied().unwrap_or(ty)),
            B::Not => {
                let operand = texts.pop().ok_or(Unprintable("a call"))?.operand();
                return Ok(Text {
                    words: format!("!{operand}"),
                    class: Class::Unary,
                });
            }
            B::Atan if texts.len() == 2 => "atan2",
            B::InverseSqrt => "inverseSqrt",
            B::RoundEven | B::Round => "round",
            B::Faceforward => "faceForward",
            B::DFdx => "dpdx",
            B::DFdy if self.style.is_upside_down() => {
                let operand = Self::list(texts);
                return Ok(Text {
                    words: format!("-dpdy({operand})"),
                    class: Class::Unary,
                });
            }
            B::DFdy => "dpdy",
            B::Mix if types.last().and_then(|ty| ty.scalar()) == Some(Scalar::Bool) => "select",
            B::FloatBitsToInt | B::FloatBitsToUint | B::IntBitsToFloat | B::UintBitsToFloat => {
                let name = self.type_name(ty);
                return Ok(Text::primary(format!("bitcast<{name}>({})", Self::list(texts))));
            }
            B::PackSnorm2x16 => "pack2x16snorm",
            B::PackUnorm2x16 => "pack2x16unorm",
            B::PackHalf2x16 => "pack2x16float",
            B::UnpackSnorm2x16 => "unpack2x16snorm",
            B::UnpackUnorm2x16 => "unpack2x16unorm",
            B::UnpackHalf2x16 => "unpack2x16float",
            B::Modf | B::IsNan | B::IsInf | B::Inverse | B::OuterProduct | B::MatrixCompMult => {
                return Err(Unprintable("that built-in function"));
            }
            other => other.name(),
        };
        // GLSL takes a number for a vector of it here, WGSL does not; but for the last of `mix`.
        let splats = matches!(
            function,
            B::Min | B::Max | B::Clamp | B::Step | B::Smoothstep | B::Mix
        );
        if let (true, Type::Vector(..)) = (splats, ty) {
            let vector = self.type_name(ty);
            let last = texts.len() - 1;
            for (at, (text, from)) in texts.iter_mut().zip(&types).enumerate() {
                if matches!(from, Type::Scalar(_)) && !(function == B::Mix && at == last) {
                    *text = Text::primary(format!("{vector}({})", text.words));
                }
            }
        }
        Ok(Text::primary(format!("{name}({})", Self::list(texts))))
    }

    /// `mod`, by a function of our own: WGSL's `%` rounds towards zero.
    fn modulo(&mut self, texts: Vec<Text>, ty: Type, divisor: Type) -> Printed {
        let [x, mut y] = <[Text; 2]>::try_from(texts).map_err(|_| Unprintable("a call"))?;
        if self.indent == 0 {
            // No function is called where constants begin.
            let [x, y] = [x.operand(), y.operand()];
            return Ok(Text {
                words: format!("{x} - {y} * floor({x} / {y})"),
                class: Class::Sum,
            });
        }
        let name = self.type_name(ty);
        if ty != divisor {
            y = Text::primary(format!("{name}({})", y.words));
        }
        let stem = match ty {
            Type::Vector(..) => format!("modulo_{name}"),
            _ => "modulo".to_owned(),
        };
        let is_taken = |word: &str| self.names.all.contains(word);
        let function = super::word::free(&stem, is_taken);
        let call = format!("{function}({})", Self::list(vec![x, y]));
        self.helpers.insert(
            function.clone(),
            format!(
                "// `mod` of GLSL: WGSL's `%` rounds towards zero.\n\
                 fn {function}(x: {name}, y: {name}) -> {name} {{\n    return x - y * floor(x / y);\n}}\n"
            ),
        );
        Ok(Text::primary(call))
    }
}
