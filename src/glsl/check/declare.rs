//! Declarations of variables and constants, and their qualifiers (§4.2, §4.3).

use toyproof_diagnostic::Code;

use super::scope::Entity;
use super::{Checker, Size, Specifier, is_desktop_conversion};
use crate::analysis::Resolution;
use crate::keywords::Keyword;
use crate::reporting::push_limited;
use crate::token::Symbol;
use crate::tree::{BuiltInVariable, ExprId, Place, Scalar, Type, Variable, VariableId, VariableKind};

/// The initializer of a variable.
#[derive(Debug)]
pub(crate) enum Initializer {
    Expression(ExprId),
    /// `{…}`, with at least one item.
    List {
        items: Vec<Initializer>,
        at: Place,
    },
}

/// One declarator: a name with its own array sizes and initializer.
#[derive(Debug)]
pub(crate) struct Declarator {
    pub(crate) name: Symbol,
    pub(crate) at: Place,
    pub(crate) sizes: Vec<Size>,
    pub(crate) initializer: Option<Initializer>,
}

impl Checker<'_> {
    /// Declares a variable, in scope from here on. Its initializer was parsed before the name was in scope
    /// (§4.2.2).
    pub(crate) fn declare_variable(
        &mut self,
        qualifiers: &Qualifiers,
        specifier: &Specifier,
        declarator: Declarator,
    ) -> VariableId {
        let Declarator {
            name,
            at,
            sizes,
            initializer,
        } = declarator;
        let kind = self.variable_kind(qualifiers);
        let sizes: Vec<_> = sizes.iter().chain(&specifier.sizes).copied().collect();
        let given = initializer
            .as_ref()
            .map(|initializer| self.initializer_type(initializer, specifier.base, sizes.len()));
        let ty = self.array_type(specifier.base, &sizes, given, at);
        let ty = self.variable_type(ty, kind, at);
        self.check_flat(qualifiers, ty, kind, at);
        let initializer = initializer.map(|initializer| self.initial_value(initializer, ty));
        let initializer = self.initializer(initializer, ty, kind, name, at);
        // If the initializer contradicts the declared type, either may be intended. If only an implicit
        // conversion is missing, the declared type is.
        let contradicted = match (initializer.map(|expr| self.ty(expr)), given) {
            (Some(Type::Error), Some(given)) if given != Type::Error => !is_desktop_conversion(given, ty),
            _ => false,
        };
        let ty = if contradicted { Type::Error } else { ty };
        let value = initializer
            .filter(|_| kind == VariableKind::Const)
            .and_then(|expr| self.tree.value(expr));
        let allowed = self.check_declarable(name, at);
        let variable = self.tree.variables.push(Variable {
            name: self.text(name).to_owned(),
            ty,
            kind,
            initializer,
            value,
            at: Some(at),
        });
        self.declared(at, Resolution::Variable(variable));
        if allowed {
            self.scopes.declare(name, Entity::Variable(variable));
            let end = initializer.map_or(at.span.end, |value| self.tree[value].at.span.end);
            self.visible_after(end.max(at.span.end), Resolution::Variable(variable));
        }
        if kind == VariableKind::Uniform {
            let default = self.tree[variable].initializer.take();
            self.bind_to_default(variable, default);
        }
        self.bind(variable);
        variable
    }

    /// Declares a name whose declaration could not be parsed, with the type `Error`.
    pub(crate) fn declare_unparsed(&mut self, name: Symbol, at: Place) {
        if self.scopes.find_here(name).is_none() {
            let variable = Variable::new(self.text(name), Type::Error, VariableKind::Local, Some(at));
            let variable = self.tree.variables.push(variable);
            self.scopes.declare(name, Entity::Variable(variable));
            self.declared(at, Resolution::Variable(variable));
            self.visible_after(at.span.end, Resolution::Variable(variable));
        }
    }

    /// The element type of an array; any other type unchanged.
    pub(super) fn element(&self, ty: Type) -> Type {
        match ty {
            Type::Array(id) => self.tree.array(id).element,
            _ => ty,
        }
    }

    /// Returns the type if a variable of that kind can have it, otherwise reports an error.
    fn variable_type(&mut self, ty: Type, kind: VariableKind, at: Place) -> Type {
        let problem = match ty {
            Type::Void => "a variable cannot be `void`".to_owned(),
            _ if kind != VariableKind::Uniform && self.holds_sampler(ty) => {
                format!(
                    "{} can only be the type of a uniform or a parameter",
                    self.quoted_type(ty)
                )
            }
            _ if !self.is_stage_io_type(ty, kind) => {
                format!(
                    "{} cannot be the type of a shader input or output",
                    self.quoted_type(ty)
                )
            }
            _ => return self.check_size_limit(ty, at),
        };
        self.error(Code::BadType, at, problem);
        Type::Error
    }

    /// Whether a fragment shader's `in` or `out` can have the type: no `bool`, and only scalars and vectors
    /// for `out` (§4.3.4, §4.3.6).
    fn is_stage_io_type(&self, ty: Type, kind: VariableKind) -> bool {
        let element = self.element(ty);
        match kind {
            VariableKind::Varying => element.scalar() != Some(Scalar::Bool),
            VariableKind::Output => {
                matches!(element, Type::Scalar(scalar) | Type::Vector(scalar, _) if scalar != Scalar::Bool)
                    || element == Type::Error
            }
            _ => true,
        }
    }

    fn initializer(
        &mut self,
        given: Option<ExprId>,
        ty: Type,
        kind: VariableKind,
        name: Symbol,
        at: Place,
    ) -> Option<ExprId> {
        let text = self.text(name);
        let Some(expr) = given else {
            if kind == VariableKind::Const {
                self.error(
                    Code::Uninitialized,
                    at,
                    format!("the constant `{text}` has no initializer"),
                );
            }
            return None;
        };
        let has_default = kind == VariableKind::Uniform && self.language.version.has_uniform_defaults();
        let is_interface = matches!(
            kind,
            VariableKind::Uniform | VariableKind::Varying | VariableKind::Output
        );
        if is_interface && !has_default {
            self.error(
                Code::BadQualifier,
                at,
                format!("`{text}` cannot have an initializer: it is a uniform, an input or an output"),
            );
            return None;
        }
        let expr = self.expect(expr, ty, &format!("the value of `{text}`"));
        // §4.3.3; desktop GLSL requires this only of constants used as array sizes.
        let must_be_constant = match kind {
            VariableKind::Const => !self.language.has_run_time_constants(),
            VariableKind::Global => !self.language.initializes_at_run_time(),
            _ => has_default,
        };
        if must_be_constant && ty != Type::Error && !self.tree[expr].constant {
            let what = if kind == VariableKind::Const {
                "constant"
            } else {
                "global"
            };
            let message = format!("the value of the {what} `{text}` is not a constant expression");
            let help = if kind == VariableKind::Const {
                "remove `const` if the value is computed at run time"
            } else {
                "assign it in `mainImage`, or use `--lenient`"
            };
            let diagnostic = Code::NotConstant.at(self.tree[expr].at, message);
            self.report(diagnostic.help(help));
        }
        Some(expr)
    }

    /// Whether the current scope can declare the name; otherwise reports an error. Also checks for reserved
    /// names.
    pub(super) fn check_declarable(&mut self, name: Symbol, at: Place) -> bool {
        let text = self.text(name);
        self.check_reserved_name(text, at);
        let first = match self.scopes.find_here(name) {
            None => None,
            Some(Entity::Variable(id)) => Some(self.tree[*id].at),
            Some(Entity::Struct(id)) => Some(Some(self.tree[*id].at)),
            Some(Entity::Functions(ids)) => Some(ids.first().map(|&id| self.tree[id].at)),
        };
        let diagnostic = match first {
            Some(Some(first)) => Code::Redeclared
                .at(at, format!("redeclaration of `{text}`"))
                .related(first.span, "previously declared here"),
            Some(None) => Code::Redeclared
                .at(at, format!("redeclaration of `{text}`, which ShaderToy declares"))
                .help("remove this declaration"),
            None if self.scopes.is_global() && text == "main" && self.dialect.calls_main_image() => Code::Redeclared
                .at(at, "`main` is reserved for ShaderToy")
                .help("define `void mainImage(out vec4 fragColor, in vec2 fragCoord)`, which ShaderToy calls for each pixel"),
            None => return true,
        };
        self.report(diagnostic);
        false
    }

    /// Checks for reserved names (§3.8): an error for `gl_…`, a warning for two underscores.
    pub(super) fn check_reserved_name(&mut self, text: &str, at: Place) {
        if text.starts_with("gl_") {
            self.error(
                Code::Redeclared,
                at,
                format!("`{text}` begins with `gl_`, which is reserved"),
            );
        } else if text.contains("__") {
            let message = format!("`{text}` contains `__`, which is reserved");
            push_limited(&mut self.warnings, Code::ReservedName.at(at, message));
        }
    }

    /// Whether `{…}` is an initializer.
    pub(crate) fn takes_initializer_lists(&self) -> bool {
        self.language.has_initializer_lists()
    }

    /// Whether a lone `;` is allowed at global scope: not in §9, but in desktop GLSL.
    pub(crate) fn takes_stray_semicolons(&self) -> bool {
        self.language.is_desktop()
    }

    pub(crate) fn open_scope(&mut self) {
        self.scopes.open();
        if let Some(names) = &mut self.names {
            names.open_scope();
        }
    }

    /// Closes a scope whose text ends at a byte.
    pub(crate) fn close_scope(&mut self, end: u32) {
        self.scopes.close();
        if let Some(names) = &mut self.names {
            names.close_scope(end);
        }
    }
}

// Qualifiers before the type of a declaration (§4.3, §4.5, §4.6).

/// The qualifiers before the type of a declaration.
#[derive(Debug, Clone, Default)]
pub(crate) struct Qualifiers {
    pub(crate) storage: Option<(Storage, Place)>,
    /// `const`; combined with `in` for parameters only.
    pub(crate) is_const: Option<Place>,
    /// The qualifiers of inputs and outputs: `invariant`, `flat`, `smooth`, `centroid`, `layout`.
    pub(crate) interface: Vec<(Keyword, Place)>,
    /// `highp`, `mediump` or `lowp`.
    pub(crate) precision: Option<Place>,
}

impl Qualifiers {
    /// The place of the first qualifier that is not a precision.
    pub(crate) fn other_than_precision(&self) -> Option<Place> {
        self.storage
            .map(|(_, at)| at)
            .or(self.is_const)
            .or(self.interface.first().map(|&(_, at)| at))
    }

    /// Whether that keyword is the only qualifier.
    pub(crate) fn is_only(&self, keyword: Keyword) -> bool {
        matches!(&self.interface[..], &[(only, _)] if only == keyword)
            && self.storage.is_none()
            && self.is_const.is_none()
            && self.precision.is_none()
    }
}

/// A storage qualifier (§4.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Storage {
    Uniform,
    In,
    Out,
    InOut,
    /// `varying`, the old name of a global `in`.
    Varying,
}

impl Checker<'_> {
    /// Determines the kind of variable that a declaration creates.
    fn variable_kind(&mut self, qualifiers: &Qualifiers) -> VariableKind {
        let global = self.scopes.is_global();
        self.check_interface_qualifiers(qualifiers);
        if let (Some((_, at)), Some(_)) = (qualifiers.storage, qualifiers.is_const) {
            self.error(
                Code::BadQualifier,
                at,
                "only a parameter can be both `const` and `in`",
            );
        }
        match qualifiers.storage {
            None if qualifiers.is_const.is_some() => VariableKind::Const,
            None if global => VariableKind::Global,
            None => VariableKind::Local,
            Some((Storage::Uniform, _)) if global => VariableKind::Uniform,
            Some((Storage::In | Storage::Out, at)) if global && !self.language.version.has_stage_io() => {
                let message = "in GLSL ES 1.00, only a parameter can be `in` or `out`";
                let help = "write `varying` for an input, and `gl_FragColor` for the color; or begin with `#version 300 es`";
                self.report(Code::BadQualifier.at(at, message).help(help));
                VariableKind::Global
            }
            Some((Storage::In | Storage::Varying, _)) if global => VariableKind::Varying,
            Some((Storage::Out, _)) if global => VariableKind::Output,
            Some((storage, at)) => {
                let message = match storage {
                    Storage::Uniform => "a local variable cannot be `uniform`",
                    Storage::Varying => "a local variable cannot be `varying`",
                    Storage::In | Storage::Out | Storage::InOut => {
                        "a local variable cannot be `in`, `out` or `inout`"
                    }
                };
                self.error(Code::BadQualifier, at, message);
                VariableKind::Local
            }
        }
    }

    /// Checks which qualifiers `in` and `out` allow in a fragment shader (§4.3.8, §4.3.9, §4.6.1).
    fn check_interface_qualifiers(&mut self, qualifiers: &Qualifiers) {
        let global = self.scopes.is_global();
        let is_varying = matches!(qualifiers.storage, Some((Storage::Varying, _)));
        for &(keyword, at) in &qualifiers.interface {
            let (wanted, whose) = match keyword {
                Keyword::Invariant | Keyword::Layout => (Storage::Out, "shader outputs"),
                _ => (Storage::In, "shader inputs"),
            };
            let message = if !global {
                format!("`{}` is only allowed on global variables", keyword.text())
            } else if qualifiers.storage.is_none_or(|(storage, _)| storage != wanted)
                && !(keyword == Keyword::Invariant && is_varying)
            {
                format!("`{}` is only allowed on {whose}", keyword.text())
            } else {
                continue;
            };
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// Checks that an integer input is `flat` (§4.3.4): integers are not interpolated.
    fn check_flat(&mut self, qualifiers: &Qualifiers, ty: Type, kind: VariableKind, at: Place) {
        let flat = qualifiers
            .interface
            .iter()
            .any(|&(keyword, _)| keyword == Keyword::Flat);
        let integral = matches!(self.element(ty).scalar(), Some(Scalar::Int | Scalar::Uint));
        if kind == VariableKind::Varying && integral && !flat {
            let message = format!("an input of type {} must be `flat`", self.quoted_type(ty));
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// Checks `layout(name = …)`: an output of a fragment shader takes only `location` (§4.3.8.2).
    pub(crate) fn layout(&mut self, name: Symbol, at: Place) {
        let text = self.text(name);
        if text != "location" {
            let message = format!("unknown layout qualifier `{text}`");
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// Checks `invariant x;`: `x` must be a declared output (§4.6.1).
    pub(crate) fn invariant(&mut self, name: Symbol, at: Place) {
        let expr = self.name(name, at);
        if let Some(variable) = self.tree.root_variable(expr)
            && !matches!(
                self.tree[variable].kind,
                VariableKind::Output | VariableKind::BuiltIn(BuiltInVariable::FragDepth)
            )
        {
            self.error(Code::BadQualifier, at, "only a shader output can be `invariant`");
        }
    }

    /// Checks that a type with a precision qualifier is numeric or a sampler (§4.5.3).
    pub(crate) fn check_precision_qualifier(&mut self, qualifiers: &Qualifiers, specifier: &Specifier) {
        let numeric = matches!(specifier.base, Type::Sampler(_) | Type::Error)
            || specifier
                .base
                .scalar()
                .is_some_and(|scalar| scalar != Scalar::Bool);
        if let Some(at) = qualifiers.precision
            && !numeric
        {
            let message = format!(
                "{} cannot have a precision qualifier",
                self.quoted_type(specifier.base)
            );
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// Checks `precision highp t;`: `t` must be `float`, `int` or a sampler (§4.5.4).
    pub(crate) fn precision(&mut self, specifier: &Specifier) {
        let (ty, at) = (specifier.base, specifier.at);
        if !specifier.sizes.is_empty() {
            self.error(Code::BadType, at, "an array has no default precision");
        } else if !matches!(ty, Type::FLOAT | Type::INT | Type::Sampler(_)) {
            let message = format!("{} has no default precision", self.quoted_type(ty));
            self.error(Code::BadType, at, message);
        }
    }
}
