//! Rules that only some versions of GLSL have. Where a version lacks a feature, the message names both.

use toyproof_diagnostic::Code;

use super::Checker;
use crate::dialect::Version;
use crate::tree::{BinaryOp, BuiltIn, ExprId, Place, Scalar, Type, UnaryOp};

impl Checker<'_> {
    /// Reports that GLSL ES 1.00 has no such feature.
    fn check_not_es_100(&mut self, has_feature: bool, feature: &str, at: Place) {
        if has_feature && !self.language.is_lenient && self.language.version == Version::Es100 {
            let message = format!("{feature} is not in GLSL ES 1.00");
            let help = "begin the shader with `#version 300 es`, or write it otherwise";
            self.report(Code::NotInVersion.at(at, message).help(help));
        }
    }

    /// Checks the suffix of a number: GLSL ES 1.00 has none (§4.1.3 there).
    pub(crate) fn check_suffix(&mut self, text: &str, at: Place) {
        let is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
        let has_suffix = text.ends_with(['u', 'U']) || (!is_hexadecimal && text.ends_with(['f', 'F']));
        self.check_not_es_100(has_suffix, "the suffix of a number", at);
    }

    /// Reports that a version of the first generation has no such feature.
    fn check_second_generation(&mut self, has_feature: bool, feature: &str, at: Place) {
        if has_feature && !self.language.is_lenient && self.language.version.is_first_generation() {
            let needed = match self.language.version {
                Version::Es100 => "300 es",
                _ => "130",
            };
            let message = format!("{feature} is not in {}", self.language.version.name());
            let help = format!("begin the shader with `#version {needed}`, or write it otherwise");
            self.report(Code::NotInVersion.at(at, message).help(help));
        }
    }

    /// Checks the arguments of a built-in function: in GLSL ES 1.00, those of numbers take floats.
    pub(super) fn check_float_arguments(&mut self, function: BuiltIn, arguments: &[ExprId], at: Place) {
        let takes_floats = matches!(
            function,
            BuiltIn::Abs | BuiltIn::Sign | BuiltIn::Min | BuiltIn::Max | BuiltIn::Clamp | BuiltIn::Mix
        );
        let types = self.types(arguments);
        let is_other = types
            .iter()
            .any(|ty| !matches!(ty.scalar(), Some(Scalar::Float) | None));
        let feature = format!("`{}` of integers or `bool`", function.name());
        self.check_not_es_100(takes_floats && is_other, &feature, at);
    }

    /// Checks an operator: the first generation reserves those of bits, and the remainder (§5.1 of GLSL ES
    /// 1.00).
    pub(super) fn check_operator(&mut self, op: BinaryOp, at: Place) {
        let is_reserved = matches!(
            op,
            BinaryOp::Remainder
                | BinaryOp::BitAnd
                | BinaryOp::BitOr
                | BinaryOp::BitXor
                | BinaryOp::ShiftLeft
                | BinaryOp::ShiftRight
        );
        self.check_second_generation(is_reserved, &format!("the operator `{}`", op.symbol()), at);
    }

    /// Checks `~x`, which the first generation reserves.
    pub(super) fn check_complement(&mut self, op: UnaryOp, at: Place) {
        self.check_second_generation(op == UnaryOp::BitNot, "the operator `~`", at);
    }

    /// Checks the use of an array as a value: GLSL ES 1.00 has only its elements (§5.7 there).
    pub(super) fn check_whole_array(&mut self, ty: Type, use_of: &str, at: Place) {
        self.check_not_es_100(matches!(ty, Type::Array(_)), &format!("{use_of} of an array"), at);
    }
}
