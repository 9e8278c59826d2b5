//! Calls and constructors: overload resolution (§6.1, §5.4).

use toyproof_diagnostic::{Code, Diagnostic, Fix, one_of, plural};

use super::prelude::TEXEL_OFFSETS;
use super::scope::Entity;
use super::signature::{self, Match};
use super::{Call, Checker, Specifier, is_desktop_conversion};
use crate::analysis::Resolution;
use crate::reporting::given;
use crate::token::Symbol;
use crate::tree::{
    BuiltIn, Constructor, Direction, ExprId, ExprKind, FunctionId, Place, Scalar, StructId, Type, Value,
    VariableKind,
};

impl Checker<'_> {
    /// Checks `name(arguments)`: a call of a user or built-in function, or a structure's constructor.
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
            None => match self.built_in_function(text, &arguments) {
                Some(function) => self.call_built_in(function, arguments, name_at, at),
                None => self.undeclared_function(name, name_at, at),
            },
        }
    }

    /// The built-in function of a name that is called with these arguments: one of the language's, or one of
    /// GLSL ES 1.00 for a shape of textures, such as `texture2D`.
    fn built_in_function(&self, name: &str, arguments: &[ExprId]) -> Option<BuiltIn> {
        let language = self.language;
        if let Some(function) = BuiltIn::named(name).filter(|&function| language.has(function)) {
            return Some(function);
        }
        let (function, shape) = language.old_texture_function(name)?;
        let sampler = arguments.first().map(|&argument| self.ty(argument));
        let has_shape = match sampler {
            Some(Type::Sampler(sampler)) => sampler.shape == shape,
            _ => true,
        };
        has_shape.then_some(function)
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
            self.resolved(name_at, Resolution::Function(overloads[0]));
            return self.error_expr(at);
        }
        let Some(function) = self.find_overload(overloads, &types) else {
            // Where a built-in function may be overloaded, its other overloads remain visible.
            let name = self.tree[overloads[0]].name.clone();
            if let Some(built_in) = self.built_in_function(&name, &arguments) {
                return self.call_built_in(built_in, arguments, name_at, at);
            }
            self.resolved(name_at, Resolution::Function(overloads[0]));
            let resolves = |checker: &Self, types: &[Type]| checker.find_overload(overloads, types).is_some();
            if self.infer_channel(&arguments, resolves) || self.has_unparsed_parameter(overloads) {
                return self.error_expr(at);
            }
            return self.no_overload(overloads, &arguments, name_at, at);
        };
        self.resolved(name_at, Resolution::Function(function));
        if let Some(context) = &self.function {
            self.calls.push(Call {
                caller: context.function,
                callee: function,
                at: name_at,
            });
        }
        let parameters = self.tree[function].parameters.clone();
        let mut passed = Vec::with_capacity(arguments.len());
        for (argument, parameter) in arguments.into_iter().zip(parameters) {
            let (ty, kind) = (self.tree[parameter].ty, self.tree[parameter].kind);
            if matches!(kind, VariableKind::Parameter(Direction::Out | Direction::InOut)) {
                self.check_lvalue(argument, "passed to an `out` parameter");
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

    /// The overload that takes exactly these types, otherwise the only one that takes them after implicit
    /// conversion.
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
            given == wanted || (copied_in && self.converts_implicitly(given, wanted))
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

    /// Whether a parameter of any overload could not be parsed.
    fn has_unparsed_parameter(&self, overloads: &[FunctionId]) -> bool {
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
        self.resolved(name_at, Resolution::BuiltIn(function));
        let types = self.types(&arguments);
        if types.contains(&Type::Error) {
            return self.error_expr(at);
        }
        let Some(found) = self.find_signature(function, &types) else {
            if self.infer_channel(&arguments, |checker, types| {
                checker.find_signature(function, types).is_some()
            }) {
                return self.error_expr(at);
            }
            return self.no_signature(function, &arguments, name_at, at);
        };
        if let Some(written) = function.out_parameter().and_then(|index| arguments.get(index)) {
            self.check_lvalue(*written, "passed to an `out` parameter");
        }
        self.check_float_arguments(function, &arguments, at);
        if let Some(&offset) = found.constant.and_then(|index| arguments.get(index)) {
            self.check_texel_offset(function, offset);
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

    /// Checks the offset of a texture lookup (§8.8): a constant in the allowed range.
    fn check_texel_offset(&mut self, function: BuiltIn, offset: ExprId) {
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
                "texel offset {part} is out of range: must be from {} to {}",
                TEXEL_OFFSETS.start(),
                TEXEL_OFFSETS.end()
            );
            self.error(Code::BadIndex, at, message);
        }
    }

    fn find_signature(&self, function: BuiltIn, types: &[Type]) -> Option<Match> {
        signature::find(function, types, |given, wanted| given == wanted).or_else(|| {
            signature::find(function, types, |given, wanted| {
                given == wanted || self.converts_implicitly(given, wanted)
            })
        })
    }

    pub(super) fn types(&self, exprs: &[ExprId]) -> Vec<Type> {
        exprs.iter().map(|&expr| self.ty(expr)).collect()
    }
}

// Diagnostics for calls that no overload accepts.

/// Maximum number of overloads that a note lists.
const MAX_LISTED_OVERLOADS: usize = 6;

impl Checker<'_> {
    /// Reports that none of a user function's overloads takes the arguments.
    fn no_overload(
        &mut self,
        overloads: &[FunctionId],
        arguments: &[ExprId],
        name_at: Place,
        at: Place,
    ) -> ExprId {
        let name = self.tree[overloads[0]].name.clone();
        let types = self.types(arguments);
        let all: Vec<Vec<Type>> = overloads
            .iter()
            .map(|&function| {
                let parameters = self.tree[function].parameters.iter();
                parameters.map(|&parameter| self.tree[parameter].ty).collect()
            })
            .collect();
        let fitting = all
            .iter()
            .zip(overloads)
            .filter(|(wanted, _)| wanted.len() == types.len());
        let closest = fitting.min_by_key(|(wanted, _)| cost(&types, wanted));
        let declared = self.tree[*closest.map_or(&overloads[0], |(_, function)| function)].at;
        let counts: Vec<_> = all.iter().map(Vec::len).collect();
        let closest = closest.map(|(wanted, _)| wanted.as_slice());
        let mut diagnostic = self.overload_mismatch(&name, arguments, closest, &counts, name_at);
        if overloads.len() == 1 {
            diagnostic = diagnostic.related(
                declared.span,
                format!("`{}` is declared here", self.format_signature(&name, &all[0])),
            );
        } else {
            let forms: Vec<_> = all
                .iter()
                .take(MAX_LISTED_OVERLOADS)
                .map(|wanted| format!("`{}`", self.format_signature(&name, wanted)))
                .collect();
            diagnostic = diagnostic.note(format!("its overloads are {}", forms.join(", ")));
        }
        self.refuse_with(diagnostic, at)
    }

    /// Reports that no signature of a built-in function takes the arguments.
    fn no_signature(&mut self, function: BuiltIn, arguments: &[ExprId], name_at: Place, at: Place) -> ExprId {
        let types = self.types(arguments);
        let candidates = signature::candidates(function, &types);
        let closest = candidates.iter().min_by_key(|wanted| cost(&types, wanted));
        let counts = signature::counts(function);
        let diagnostic = self.overload_mismatch(
            function.name(),
            arguments,
            closest.map(Vec::as_slice),
            &counts,
            name_at,
        );
        self.refuse_with(diagnostic, at)
    }

    /// Describes the mismatch: the number of arguments, or those that differ from the closest overload's
    /// parameters.
    fn overload_mismatch(
        &self,
        name: &str,
        arguments: &[ExprId],
        closest: Option<&[Type]>,
        counts: &[usize],
        name_at: Place,
    ) -> Diagnostic {
        let types = self.types(arguments);
        let call = self.format_signature(name, &types);
        let Some(wanted) = closest else {
            if counts.contains(&types.len()) {
                return Code::NoOverload.at(name_at, format!("no matching function for the call `{call}`"));
            }
            let message = format!(
                "`{name}` takes {}, but {}",
                counted(&format_counts(counts), "argument"),
                given(types.len())
            );
            return Code::NoOverload.at(name_at, message);
        };
        let message = format!(
            "no matching function for the call `{call}`; expected `{}`",
            self.format_signature(name, wanted)
        );
        let misfits = arguments
            .iter()
            .zip(wanted)
            .filter(|&(&argument, &wanted)| self.ty(argument) != wanted);
        misfits.fold(
            Code::NoOverload.at(name_at, message),
            |diagnostic, (&argument, &wanted)| self.with_related_fixit(diagnostic, argument, wanted),
        )
    }

    /// Formats `name(type, type)`.
    fn format_signature(&self, name: &str, types: &[Type]) -> String {
        let types: Vec<_> = types.iter().map(|&ty| self.tree.type_name(ty)).collect();
        format!("{name}({})", types.join(", "))
    }
}

/// The distance between arguments and as many parameters: a conversion costs less than a different type.
fn cost(given: &[Type], wanted: &[Type]) -> usize {
    let one = |(&given, &wanted): (&Type, &Type)| match () {
        () if given == wanted => 0,
        () if is_desktop_conversion(given, wanted) => 1,
        () if is_desktop_conversion(wanted, given) => 2,
        () => 4,
    };
    given.iter().zip(wanted).map(one).sum()
}

/// Formats counts as `1`, `1 or 2` or `1, 2 or 4`.
fn format_counts(counts: &[usize]) -> String {
    let mut counts = counts.to_vec();
    counts.sort_unstable();
    counts.dedup();
    let texts: Vec<_> = counts.iter().map(usize::to_string).collect();
    one_of(&texts)
}

fn counted(count: &str, noun: &str) -> String {
    match count {
        "1" => format!("1 {noun}"),
        "0" => format!("no {noun}s"),
        _ => format!("{count} {noun}s"),
    }
}

// Constructors (§5.4).

/// The constructor that converts a scalar or vector to a type of the same shape.
pub(super) fn conversion(to: Type) -> Constructor {
    match to {
        Type::Vector(..) => Constructor::Vector,
        _ => Constructor::Scalar,
    }
}

impl Checker<'_> {
    /// Checks `type(arguments)`.
    pub(crate) fn construct(&mut self, specifier: &Specifier, arguments: Vec<ExprId>, at: Place) -> ExprId {
        if !specifier.sizes.is_empty() {
            return self.construct_array(specifier, arguments, at);
        }
        match specifier.base {
            Type::Struct(id) => self.construct_struct(id, arguments, at),
            Type::Error => self.error_expr(at),
            ty => match self.numeric_constructor(ty, &arguments) {
                Ok(constructor) => self.push_constructor(constructor, ty, arguments, at),
                Err(_) if self.types(&arguments).contains(&Type::Error) => self.error_expr(at),
                Err(message) => {
                    let diagnostic = Code::BadConstructor.at(at, message);
                    let fixit = match arguments[..] {
                        [only] if matches!(ty, Type::Vector(..)) => self.fixit(only, ty),
                        _ => None,
                    };
                    let diagnostic = match fixit {
                        Some((advice, Some(replacement))) if !at.is_expanded() => {
                            diagnostic.fix(Fix::new(advice, at.span, replacement))
                        }
                        Some((advice, _)) => diagnostic.label(advice),
                        None => diagnostic,
                    };
                    self.refuse_with(diagnostic, at)
                }
            },
        }
    }

    fn construct_struct(&mut self, id: StructId, arguments: Vec<ExprId>, at: Place) -> ExprId {
        let types: Vec<_> = self.tree[id].members.iter().map(|member| member.ty).collect();
        if self.incomplete.contains(&id) {
            return self.error_expr(at);
        }
        if types.len() != arguments.len() {
            let name = self.quoted_type(Type::Struct(id));
            let message = format!(
                "{name} has {} {}, but {}",
                types.len(),
                plural(types.len() as u64, "member", "members"),
                given(arguments.len())
            );
            return self.refuse(Code::BadConstructor, at, message);
        }
        let arguments = arguments
            .into_iter()
            .zip(types)
            .map(|(argument, ty)| self.expect(argument, ty, "this member's value"))
            .collect();
        self.push_constructor(Constructor::Struct, Type::Struct(id), arguments, at)
    }

    fn construct_array(&mut self, specifier: &Specifier, arguments: Vec<ExprId>, at: Place) -> ExprId {
        if arguments.is_empty() {
            return self.refuse(
                Code::BadConstructor,
                at,
                "an array must have at least one element",
            );
        }
        // The arguments determine the size of `[]`.
        let first = self.ty(arguments[0]);
        let inferred = match first {
            Type::Error => Type::Error,
            _ => self.tree.array_of(first, arguments.len() as u32),
        };
        let ty = self.array_type(specifier.base, &specifier.sizes, Some(inferred), specifier.at);
        let Type::Array(id) = ty else {
            return self.error_expr(at);
        };
        self.check_whole_array(ty, "a constructor", at);
        let array = self.tree.array(id);
        if array.size as usize != arguments.len() {
            let message = format!(
                "{} has {} {}, but {}",
                self.quoted_type(ty),
                array.size,
                plural(u64::from(array.size), "element", "elements"),
                given(arguments.len())
            );
            return self.refuse(Code::BadConstructor, at, message);
        }
        let arguments = arguments
            .into_iter()
            .map(|argument| self.expect(argument, array.element, "this element"))
            .collect();
        self.push_constructor(Constructor::Array, ty, arguments, at)
    }

    pub(super) fn push_constructor(
        &mut self,
        constructor: Constructor,
        ty: Type,
        arguments: Vec<ExprId>,
        at: Place,
    ) -> ExprId {
        let constant = arguments.iter().all(|&argument| self.tree[argument].constant);
        let kind = ExprKind::Construct {
            constructor,
            arguments,
        };
        self.push(kind, ty, constant, at)
    }

    /// Selects the constructor that makes a scalar, vector or matrix of these arguments (§5.4.1, §5.4.2).
    fn numeric_constructor(&self, ty: Type, arguments: &[ExprId]) -> Result<Constructor, String> {
        let Some(wanted) = ty.component_count() else {
            return Err(format!("{} has no constructor", self.quoted_type(ty)));
        };
        let types = self.types(arguments);
        if let Some(&other) = types.iter().find(|ty| ty.component_count().is_none()) {
            return Err(format!(
                "{} cannot be constructed from {}",
                self.quoted_type(ty),
                self.quoted_type(other)
            ));
        }
        match (ty, &types[..]) {
            (_, []) => {
                return Err(format!(
                    "the constructor of {} needs at least one argument",
                    self.quoted_type(ty)
                ));
            }
            (Type::Scalar(_), [_]) => return Ok(Constructor::Scalar),
            (Type::Scalar(_), _) => {
                return Err(format!(
                    "the constructor of {} takes 1 argument",
                    self.quoted_type(ty)
                ));
            }
            (Type::Vector(..), [Type::Scalar(_)]) => return Ok(Constructor::Splat),
            (Type::Matrix { .. }, [Type::Scalar(_)]) => return Ok(Constructor::Diagonal),
            (Type::Matrix { .. }, [Type::Matrix { .. }]) => return Ok(Constructor::Resize),
            (Type::Matrix { .. }, several) if several.iter().any(|ty| matches!(ty, Type::Matrix { .. })) => {
                return Err(
                    "a matrix is constructed from one matrix, or from scalars and vectors".to_owned(),
                );
            }
            _ => {}
        }
        // Every argument must give at least one component.
        let mut have = 0;
        for &argument in &types {
            if have >= usize::from(wanted) {
                return Err(format!(
                    "too many arguments: {} has {wanted} components",
                    self.quoted_type(ty)
                ));
            }
            have += argument.component_count().map_or(0, usize::from);
        }
        if have < usize::from(wanted) {
            return Err(format!(
                "{} has {wanted} components, but {}",
                self.quoted_type(ty),
                given(have)
            ));
        }
        Ok(match ty.scalar() {
            Some(Scalar::Float) if matches!(ty, Type::Matrix { .. }) => Constructor::Matrix,
            _ => Constructor::Vector,
        })
    }
}
