//! Built-in functions in Metal: most have the same name, some are operators, few are missing.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, Scalar, Type, Wgsl};

use crate::c_family::Unprintable;
use crate::c_family::expression::{Part, Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(super) fn built_in_of_metal(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        ty: Type,
    ) -> PrintResult<Parts> {
        use BuiltIn as B;
        let types = arguments.iter().map(|&argument| self.cx.tree[argument].ty);
        let types: Vec<Type> = types.collect();
        // Comparisons of vectors component by component.
        if let (Wgsl::Operator(op), &[left, right]) = (function.wgsl(), arguments) {
            return Ok(Self::infix(left, op, right));
        }
        if let Some((name, comment, body)) = missing(function) {
            let name = self.helper_function(name, &types, ty, comment, body)?;
            return Ok((Self::call(name, arguments), level::POSTFIX));
        }
        let name = match function {
            B::Not => {
                let operand = Part::Print(arguments[0], level::POSTFIX);
                return Ok((vec![Part::token("!"), operand], level::UNARY));
            }
            // Metal's are functions of vectors.
            B::Length if types == [Type::FLOAT] => "abs".to_owned(),
            B::Distance if types.first() == Some(&Type::FLOAT) => {
                let (difference, _) = Self::infix(arguments[0], BinaryOp::Subtract, arguments[1]);
                let mut parts = vec![Part::token("abs(")];
                parts.extend(difference);
                parts.push(Part::token(")"));
                return Ok((parts, level::POSTFIX));
            }
            B::Atan if arguments.len() == 2 => "atan2".to_owned(),
            B::DFdx => "dfdx".to_owned(),
            B::DFdy => "dfdy".to_owned(),
            B::InverseSqrt => "rsqrt".to_owned(),
            B::Round | B::RoundEven => "rint".to_owned(),
            B::FloatBitsToInt | B::FloatBitsToUint | B::IntBitsToFloat | B::UintBitsToFloat => {
                format!("as_type<{}>", self.type_name(ty)?)
            }
            B::Mix if types.last().and_then(|ty| ty.scalar()) == Some(Scalar::Bool) => "select".to_owned(),
            B::Sign if ty.scalar() == Some(Scalar::Int) => {
                let name = self.type_name(ty)?;
                let body = format!("return {name}(x > 0) - {name}(x < 0);");
                self.helper_function("signOf", &types, ty, "", &body)?
            }
            B::PackSnorm2x16 => "pack_float_to_snorm2x16".to_owned(),
            B::PackUnorm2x16 => "pack_float_to_unorm2x16".to_owned(),
            B::UnpackSnorm2x16 => "unpack_snorm2x16_to_float".to_owned(),
            B::UnpackUnorm2x16 => "unpack_unorm2x16_to_float".to_owned(),
            // Lowering replaces these.
            B::Modf | B::IsNan | B::IsInf | B::OuterProduct | B::Inverse | B::MatrixCompMult => {
                return Err(Unprintable::Construct("this built-in function"));
            }
            other => other.name().to_owned(),
        };
        Ok((Self::call(name, arguments), level::POSTFIX))
    }
}

/// The name, the comment and the body of a function that Metal lacks.
fn missing(function: BuiltIn) -> Option<(&'static str, &'static str, &'static str)> {
    use BuiltIn as B;
    Some(match function {
        B::Mod => (
            "mod",
            "// `mod` of GLSL: `fmod` rounds towards zero.\n",
            "return x - y * floor(x / y);",
        ),
        B::Radians => ("radians", "", "return x * 0.017453292;"),
        B::Degrees => ("degrees", "", "return x * 57.29578;"),
        B::PackHalf2x16 => ("packHalf2x16", "", "return as_type<uint>(half2(x));"),
        B::UnpackHalf2x16 => ("unpackHalf2x16", "", "return float2(as_type<half2>(x));"),
        _ => return None,
    })
}
