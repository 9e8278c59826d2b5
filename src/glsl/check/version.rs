//! Rules that only some versions of GLSL have.

use toyproof_diagnostic::Code;

use super::Checker;
use crate::dialect::Version;
use crate::tree::{BinaryOp, BuiltIn, ExprId, Place, Scalar, Type, UnaryOp};

impl Checker<'_> {
    /// Reports a feature that the version of the text does not have.
    fn report_missing(&mut self, feature: &str, at: Place) {
        let version = self.language.version;
        let next = if version == Version::Es100 {
            "300 es"
        } else {
            "130"
        };
        let message = format!("{feature} is not in {}", version.name());
        let help = format!("begin the shader with `#version {next}`, or write it otherwise");
        self.report(Code::NotInVersion.at(at, message).help(help));
    }

    /// Checks the suffix of a number: GLSL ES 1.00 has none (§4.1.3 there).
    pub(crate) fn check_suffix(&mut self, text: &str, at: Place) {
        let is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
        let has_suffix = text.ends_with(['u', 'U']) || (!is_hexadecimal && text.ends_with(['f', 'F']));
        if has_suffix && self.language.is_es_100() {
            self.report_missing("the suffix of a number", at);
        }
    }

    /// Checks the arguments of a built-in function: in GLSL ES 1.00, those of numbers take floats.
    pub(super) fn check_float_arguments(&mut self, function: BuiltIn, arguments: &[ExprId], at: Place) {
        if !self.language.is_es_100() {
            return;
        }
        let takes_floats = matches!(
            function,
            BuiltIn::Abs | BuiltIn::Sign | BuiltIn::Min | BuiltIn::Max | BuiltIn::Clamp | BuiltIn::Mix
        );
        let is_other = |ty: &Type| !matches!(ty.scalar(), Some(Scalar::Float) | None);
        if takes_floats && self.types(arguments).iter().any(is_other) {
            self.report_missing(&format!("`{}` of integers or `bool`", function.name()), at);
        }
    }

    /// Checks an operator: those of bits, and the remainder, are reserved before GLSL ES 3.00 and GLSL 1.30
    /// (§5.1 of GLSL ES 1.00).
    pub(super) fn check_operator(&mut self, op: BinaryOp, at: Place) {
        let is_integer_operator = matches!(
            op,
            BinaryOp::Remainder
                | BinaryOp::BitAnd
                | BinaryOp::BitOr
                | BinaryOp::BitXor
                | BinaryOp::ShiftLeft
                | BinaryOp::ShiftRight
        );
        if is_integer_operator && !self.language.has_integer_operations() {
            self.report_missing(&format!("the operator `{}`", op.symbol()), at);
        }
    }

    /// Checks `~x`, which is reserved like the operators of [`Self::check_operator`].
    pub(super) fn check_complement(&mut self, op: UnaryOp, at: Place) {
        if op == UnaryOp::BitNot && !self.language.has_integer_operations() {
            self.report_missing("the operator `~`", at);
        }
    }

    /// Checks the use of an array as a value: GLSL ES 1.00 has only its elements (§5.7 there).
    pub(super) fn check_whole_array(&mut self, ty: Type, use_of: &str, at: Place) {
        if matches!(ty, Type::Array(_)) && self.language.is_es_100() {
            self.report_missing(&format!("{use_of} of an array"), at);
        }
    }
}
