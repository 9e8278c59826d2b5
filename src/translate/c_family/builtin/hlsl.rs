//! Built-in functions in HLSL: most have the same name, some are operators, few are missing.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, Scalar, Type, Wgsl};

use crate::c_family::Unprintable;
use crate::c_family::expression::{Part, Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(super) fn built_in_of_hlsl(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        ty: Type,
    ) -> PrintResult<Parts> {
        use BuiltIn as B;
        let types: Vec<Type> = arguments
            .iter()
            .map(|&argument| self.cx.tree[argument].ty)
            .collect();
        // Comparisons of vectors component by component.
        if let (Wgsl::Operator(op), &[left, right]) = (function.wgsl(), arguments) {
            return Ok(Self::infix(left, op, right));
        }
        let name = match function {
            B::Not => {
                let operand = Part::Print(arguments[0], level::POSTFIX);
                return Ok((vec![Part::token("!"), operand], level::UNARY));
            }
            B::Sign if ty.scalar() == Some(Scalar::Float) => {
                // HLSL's returns integers.
                let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
                parts.extend(Self::call("sign", arguments));
                parts.push(Part::token(")"));
                return Ok((parts, level::POSTFIX));
            }
            B::DFdy if self.host.orients_derivatives(self.cx.stage) => {
                self.takes_derivatives = true;
                let mut parts = vec![Part::token("upward * ")];
                parts.extend(Self::call("ddy", arguments));
                return Ok((parts, BinaryOp::Multiply.precedence() + level::BINARY));
            }
            B::MatrixCompMult => return Ok(Self::infix(arguments[0], BinaryOp::Multiply, arguments[1])),
            B::Atan if arguments.len() == 2 => "atan2".to_owned(),
            B::DFdx => "ddx".to_owned(),
            B::DFdy => "ddy".to_owned(),
            B::Fract => "frac".to_owned(),
            B::InverseSqrt => "rsqrt".to_owned(),
            B::RoundEven => "round".to_owned(),
            B::FloatBitsToInt => "asint".to_owned(),
            B::FloatBitsToUint => "asuint".to_owned(),
            B::IntBitsToFloat | B::UintBitsToFloat => "asfloat".to_owned(),
            B::Mix if types.last().and_then(|ty| ty.scalar()) == Some(Scalar::Bool) => {
                self.mix_of_bool(&types, ty)?
            }
            B::Mix => "lerp".to_owned(),
            B::Mod => self.helper_function(
                "mod",
                &types,
                ty,
                "// `mod` of GLSL: `fmod` rounds towards zero.\n",
                "return x - y * floor(x / y);",
            )?,
            B::Asinh => self.helper_function(
                "asinh",
                &types,
                ty,
                "",
                "return sign(x) * log(abs(x) + sqrt(x * x + 1.0));",
            )?,
            B::Acosh => {
                self.helper_function("acosh", &types, ty, "", "return log(x + sqrt(x * x - 1.0));")?
            }
            B::Atanh => self.helper_function(
                "atanh",
                &types,
                ty,
                "",
                "return 0.5 * log((1.0 + x) / (1.0 - x));",
            )?,
            B::PackHalf2x16 => self.helper_function(
                "packHalf2x16",
                &types,
                ty,
                "",
                "return f32tof16(x.x) | f32tof16(x.y) << 16;",
            )?,
            B::UnpackHalf2x16 => self.helper_function(
                "unpackHalf2x16",
                &types,
                ty,
                "",
                "return float2(f16tof32(x & 0xffff), f16tof32(x >> 16));",
            )?,
            B::PackSnorm2x16
            | B::UnpackSnorm2x16
            | B::PackUnorm2x16
            | B::UnpackUnorm2x16
            | B::Modf
            | B::IsNan
            | B::IsInf
            | B::OuterProduct
            | B::Inverse => return Err(Unprintable::Construct("this built-in function")),
            other => other.name().to_owned(),
        };
        Ok((Self::call(name, arguments), level::POSTFIX))
    }
}
