//! Calls: which overload is meant (§6.1).

use super::Checker;
use super::prelude::TEXEL_OFFSETS;
use super::scope::Entity;
use super::signature::{self, Match};
use crate::codes::Code;
use crate::token::Symbol;
use crate::tree::{BuiltIn, Direction, ExprId, ExprKind, FunctionId, Place, Type, Value, VariableKind};

impl Checker<'_> {
    /// `name(arguments)`: a call of a function or built-in function, or a structure's constructor.
    pub(crate) fn call(&mut self, name: Symbol, name_at: Place, arguments: Vec<ExprId>, at: Place) -> ExprId {
        let text = self.text(name);
        match self.scopes.find(name) {
            Some(Entity::Functions(overloads)) => {
                let overloads = overloads.clone();
                self.call_function(&overloads, arguments, name_at, at)
            }
            Some(&Entity::Struct(id)) => self.construct_struct(id, arguments, at),
            Some(Entity::Variable(_)) => self.refuse(
                Code::NotAVariable,
                name_at,
                format!("`{text}` is a variable, not a function"),
            ),
            None => match BuiltIn::named(text) {
                Some(function) => self.call_built_in(function, arguments, name_at, at),
                None => self.undeclared_function(name, name_at),
            },
        }
    }

    fn call_function(
        &mut self,
        overloads: &[FunctionId],
        arguments: Vec<ExprId>,
        name_at: Place,
        at: Place,
    ) -> ExprId {
        let types = self.types(&arguments);
        if types.contains(&Type::Error) {
            return self.broken(at);
        }
        let Some(function) = self.find_overload(overloads, &types) else {
            // Only `lenient` lets an author overload a built-in function; its other overloads remain.
            if let Some(built_in) = BuiltIn::named(&self.tree[overloads[0]].name) {
                return self.call_built_in(built_in, arguments, name_at, at);
            }
            let resolves = |checker: &Self, types: &[Type]| checker.find_overload(overloads, types).is_some();
            if self.infer_channel(&arguments, resolves) || self.is_unread(overloads) {
                return self.broken(at);
            }
            return self.no_overload(overloads, &arguments, name_at, at);
        };
        if let Some(context) = &self.function {
            self.calls.push((context.function, function, name_at));
        }
        let parameters = self.tree[function].parameters.clone();
        let mut passed = Vec::with_capacity(arguments.len());
        for (argument, parameter) in arguments.into_iter().zip(parameters) {
            let (ty, kind) = (self.tree[parameter].ty, self.tree[parameter].kind);
            if matches!(kind, VariableKind::Parameter(Direction::Out | Direction::InOut)) {
                self.writable(argument, "passed to an `out` parameter");
            }
            passed.push(self.convert(argument, ty).unwrap_or(argument));
        }
        let ty = self.tree[function].return_type;
        let kind = ExprKind::Call {
            function,
            arguments: passed,
        };
        self.push(kind, ty, false, at)
    }

    /// The overload that takes exactly these types; under `lenient`, else the only one that takes them converted.
    fn find_overload(&self, overloads: &[FunctionId], types: &[Type]) -> Option<FunctionId> {
        let takes = |function: FunctionId, fits: &dyn Fn(Type, Type, VariableKind) -> bool| {
            let parameters = &self.tree[function].parameters;
            parameters.len() == types.len()
                && parameters.iter().zip(types).all(|(&parameter, &given)| {
                    let parameter = &self.tree[parameter];
                    parameter.ty == Type::Error || fits(given, parameter.ty, parameter.kind)
                })
        };
        let exact = |given: Type, wanted: Type, _: VariableKind| given == wanted;
        let converted = |given: Type, wanted: Type, kind: VariableKind| {
            let copied_in = kind == VariableKind::Parameter(Direction::In)
                || kind == VariableKind::Parameter(Direction::ConstIn);
            given == wanted || (copied_in && self.converts(given, wanted))
        };
        if let Some(&found) = overloads.iter().find(|&&function| takes(function, &exact)) {
            return Some(found);
        }
        let mut candidates = overloads.iter().filter(|&&function| takes(function, &converted));
        match (candidates.next(), candidates.next()) {
            (Some(&only), None) => Some(only),
            _ => None,
        }
    }

    /// Whether the parameters of an overload could not all be read.
    fn is_unread(&self, overloads: &[FunctionId]) -> bool {
        let parameters = overloads
            .iter()
            .flat_map(|&function| &self.tree[function].parameters);
        parameters
            .into_iter()
            .any(|&parameter| self.tree[parameter].ty == Type::Error)
    }

    fn call_built_in(
        &mut self,
        function: BuiltIn,
        arguments: Vec<ExprId>,
        name_at: Place,
        at: Place,
    ) -> ExprId {
        let types = self.types(&arguments);
        if types.contains(&Type::Error) {
            return self.broken(at);
        }
        let Some(found) = self.find_signature(function, &types) else {
            if self.infer_channel(&arguments, |checker, types| {
                checker.find_signature(function, types).is_some()
            }) {
                return self.broken(at);
            }
            return self.no_signature(function, &arguments, name_at, at);
        };
        if let Some(written) = function.out_parameter().and_then(|index| arguments.get(index)) {
            self.writable(*written, "passed to an `out` parameter");
        }
        if let Some(&offset) = found.constant.and_then(|index| arguments.get(index)) {
            self.offset_fits(function, offset);
        }
        let arguments: Vec<_> = arguments
            .into_iter()
            .zip(found.parameters)
            .map(|(argument, wanted)| self.convert(argument, wanted).unwrap_or(argument))
            .collect();
        let constant = !function.is_texture()
            && function.out_parameter().is_none()
            && arguments.iter().all(|&argument| self.tree[argument].constant);
        self.push(
            ExprKind::BuiltIn { function, arguments },
            found.result,
            constant,
            at,
        )
    }

    /// §8.8: the offset of a texture lookup is known beforehand, and small.
    fn offset_fits(&mut self, function: BuiltIn, offset: ExprId) {
        let at = self.tree[offset].at;
        if !self.tree[offset].constant {
            let message = format!(
                "the offset of `{}` must be a constant expression",
                function.name()
            );
            self.error(Code::NotConstant, at, message);
            return;
        }
        let value = self.tree.value(offset);
        let parts = value.as_ref().map_or(&[][..], |value| value.components());
        let too_far = parts.iter().find_map(|part| {
            let Value::Int(part) = *part else { return None };
            (!TEXEL_OFFSETS.contains(&part)).then_some(part)
        });
        if let Some(part) = too_far {
            let message = format!(
                "the offset {part} is out of range: {} to {}",
                TEXEL_OFFSETS.start(),
                TEXEL_OFFSETS.end()
            );
            self.error(Code::BadIndex, at, message);
        }
    }

    fn find_signature(&self, function: BuiltIn, types: &[Type]) -> Option<Match> {
        signature::find(function, types, |given, wanted| given == wanted).or_else(|| {
            signature::find(function, types, |given, wanted| {
                given == wanted || self.converts(given, wanted)
            })
        })
    }

    pub(super) fn types(&self, exprs: &[ExprId]) -> Vec<Type> {
        exprs.iter().map(|&expr| self.ty(expr)).collect()
    }
}
