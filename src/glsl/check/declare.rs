//! Variables and constants (§4.2, §4.3).

use super::scope::Entity;
use super::{Checker, Size, Specifier, liberal_conversion};
use crate::glsl::codes::{Code, tell};
use crate::glsl::token::Symbol;
use crate::glsl::tree::{BuiltInVariable, ExprId, Place, Scalar, Type, Variable, VariableId, VariableKind};
use crate::glsl::words::Keyword;

/// What stands before the type of a declaration.
#[derive(Debug, Clone, Default)]
pub(crate) struct Qualifiers {
    pub(crate) storage: Option<(Storage, Place)>,
    /// `const`; beside `in` for parameters only.
    pub(crate) is_const: Option<Place>,
    /// What only inputs and outputs may have: `invariant`, `flat`, `smooth`, `centroid`, `layout`.
    pub(crate) interface: Vec<(Keyword, Place)>,
    /// `highp`, `mediump` or `lowp`.
    pub(crate) precision: Option<Place>,
}

impl Qualifiers {
    /// A qualifier that only variables can have.
    pub(crate) fn other_than_precision(&self) -> Option<Place> {
        self.storage
            .map(|(_, at)| at)
            .or(self.is_const)
            .or(self.interface.first().map(|&(_, at)| at))
    }

    /// Whether that keyword is all there is.
    pub(crate) fn is_only(&self, keyword: Keyword) -> bool {
        matches!(&self.interface[..], &[(only, _)] if only == keyword)
            && self.storage.is_none()
            && self.is_const.is_none()
            && self.precision.is_none()
    }
}

/// Where a value comes from or goes to (§4.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Storage {
    Uniform,
    In,
    Out,
    InOut,
}

/// One name of a declaration with what belongs to it alone.
#[derive(Debug)]
pub(crate) struct Declarator {
    pub(crate) name: Symbol,
    pub(crate) at: Place,
    pub(crate) sizes: Vec<Size>,
    pub(crate) initialiser: Option<ExprId>,
}

impl Checker<'_> {
    /// Declares a variable, in scope from here on. Its initialiser was read before and does not know it (§4.2.2).
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
            initialiser,
        } = declarator;
        let kind = self.variable_kind(qualifiers);
        let sizes: Vec<_> = sizes.iter().chain(&specifier.sizes).copied().collect();
        let given = initialiser.map(|expr| self.ty(expr));
        let ty = self.array_type(specifier.base, &sizes, given, at);
        let ty = self.variable_type(ty, kind, at);
        self.flat_fits(qualifiers, ty, kind, at);
        let initialiser = self.initialiser(initialiser, ty, kind, name, at);
        // Where value and type contradict each other, either may be meant; but what only lacks a conversion has the type that is written.
        let contradicted = match (initialiser.map(|expr| self.ty(expr)), given) {
            (Some(Type::Error), Some(given)) if given != Type::Error => !liberal_conversion(given, ty),
            _ => false,
        };
        let ty = if contradicted { Type::Error } else { ty };
        let value = initialiser
            .filter(|_| kind == VariableKind::Const)
            .and_then(|expr| self.tree.value(expr));
        let allowed = self.may_declare(name, at);
        let variable = self.tree.variables.push(Variable {
            name: self.text(name).to_owned(),
            ty,
            kind,
            initialiser,
            value,
            at: Some(at),
        });
        if allowed {
            self.scopes.declare(name, Entity::Variable(variable));
        }
        variable
    }

    /// Declares a name whose declaration cannot be read: it may be anything.
    pub(crate) fn declare_unread(&mut self, name: Symbol, at: Place) {
        if self.scopes.find_here(name).is_none() {
            let variable = self.tree.variables.push(Variable {
                name: self.text(name).to_owned(),
                ty: Type::Error,
                kind: VariableKind::Local,
                initialiser: None,
                value: None,
                at: Some(at),
            });
            self.scopes.declare(name, Entity::Variable(variable));
        }
    }

    fn variable_kind(&mut self, qualifiers: &Qualifiers) -> VariableKind {
        let global = self.scopes.is_global();
        self.interface_fits(qualifiers);
        if let (Some((_, at)), Some(_)) = (qualifiers.storage, qualifiers.is_const) {
            self.error(Code::BadQualifier, at, "only a parameter can be `const` and `in`");
        }
        match qualifiers.storage {
            None if qualifiers.is_const.is_some() => VariableKind::Const,
            None if global => VariableKind::Global,
            None => VariableKind::Local,
            Some((Storage::Uniform, _)) if global => VariableKind::Uniform,
            Some((Storage::In, _)) if global => VariableKind::Varying,
            Some((Storage::Out, _)) if global => VariableKind::Output,
            Some((storage, at)) => {
                let message = match storage {
                    Storage::Uniform => "a local variable cannot be `uniform`",
                    Storage::In | Storage::Out | Storage::InOut => {
                        "only a parameter can be `in`, `out` or `inout` here"
                    }
                };
                self.error(Code::BadQualifier, at, message);
                VariableKind::Local
            }
        }
    }

    /// What goes with `in`, and what with `out`, in a fragment shader (§4.3.8, §4.3.9, §4.6.1).
    fn interface_fits(&mut self, qualifiers: &Qualifiers) {
        let global = self.scopes.is_global();
        for &(keyword, at) in &qualifiers.interface {
            let (wanted, whose) = match keyword {
                Keyword::Invariant | Keyword::Layout => (Storage::Out, "outputs"),
                _ => (Storage::In, "inputs"),
            };
            let message = if !global {
                "this qualifier is for globals only".to_owned()
            } else if qualifiers.storage.is_none_or(|(storage, _)| storage != wanted) {
                format!("`{}` is for {whose} only", keyword.text())
            } else {
                continue;
            };
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// Between corners, integers have no middle: such an input is `flat` (§4.3.4).
    fn flat_fits(&mut self, qualifiers: &Qualifiers, ty: Type, kind: VariableKind, at: Place) {
        let flat = qualifiers
            .interface
            .iter()
            .any(|&(keyword, _)| keyword == Keyword::Flat);
        let integral = matches!(self.element(ty).scalar(), Some(Scalar::Int | Scalar::Uint));
        if kind == VariableKind::Varying && integral && !flat {
            let message = format!("an input of type {} must be `flat`", self.said(ty));
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// What an array holds; of anything else, itself.
    fn element(&self, ty: Type) -> Type {
        match ty {
            Type::Array(id) => self.tree.array(id).element,
            _ => ty,
        }
    }

    /// `layout(name = …)`: what an output of a fragment shader can say (§4.3.8.2).
    pub(crate) fn layout(&mut self, name: Symbol, at: Place) {
        let text = self.text(name);
        if text != "location" {
            let message = format!("a fragment shader has no layout `{text}`");
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// The type, if a variable of that kind can have it.
    fn variable_type(&mut self, ty: Type, kind: VariableKind, at: Place) -> Type {
        let problem = match ty {
            Type::Void => "a variable cannot be `void`".to_owned(),
            _ if kind != VariableKind::Uniform && self.holds_sampler(ty) => {
                format!("{} can only be a uniform or a parameter", self.said(ty))
            }
            _ if !self.passes_stages(ty, kind) => {
                format!("{} cannot come from another stage or go there", self.said(ty))
            }
            _ => return self.bounded(ty, at),
        };
        self.error(Code::BadType, at, problem);
        Type::Error
    }

    /// What may be `in` and `out` of a fragment shader: no `bool`, and nothing but vectors `out` (§4.3.4, §4.3.6).
    fn passes_stages(&self, ty: Type, kind: VariableKind) -> bool {
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

    fn initialiser(
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
                    Code::Uninitialised,
                    at,
                    format!("the constant `{text}` has no value"),
                );
            }
            return None;
        };
        if matches!(
            kind,
            VariableKind::Uniform | VariableKind::Varying | VariableKind::Output
        ) {
            self.error(
                Code::BadQualifier,
                at,
                format!("`{text}` comes from outside or goes there: it takes no value here"),
            );
            return None;
        }
        let expr = self.expect(expr, ty, &format!("the value of `{text}`"));
        // §4.3.3; desktop GLSL asks it of constants that sizes depend on only.
        let must_be_constant = matches!(kind, VariableKind::Const | VariableKind::Global);
        if must_be_constant && ty != Type::Error && !self.lenient && !self.tree[expr].constant {
            let what = if kind == VariableKind::Const {
                "constant"
            } else {
                "global"
            };
            let message = format!("the value of the {what} `{text}` is not a constant expression");
            let note = if kind == VariableKind::Const {
                "leave `const` out if it is to be computed while the shader runs"
            } else {
                "globals are set before the shader runs: set this one in `mainImage`, or use --lenient"
            };
            let diagnostic = Code::NotConstant.at(self.tree[expr].at, message);
            self.report(diagnostic.note(note));
        }
        Some(expr)
    }

    /// Whether this scope can take the name; if not, or if the name is GLSL's, says so.
    pub(super) fn may_declare(&mut self, name: Symbol, at: Place) -> bool {
        let text = self.text(name);
        self.may_name(text, at);
        let first = match self.scopes.find_here(name) {
            None => None,
            Some(Entity::Variable(id)) => Some(self.tree[*id].at),
            Some(Entity::Struct(id)) => Some(Some(self.tree[*id].at)),
            Some(Entity::Functions(ids)) => Some(ids.first().map(|&id| self.tree[id].at)),
        };
        let diagnostic = match first {
            Some(Some(first)) => Code::Redeclared
                .at(at, format!("`{text}` is declared already"))
                .related(first.span, "first declared here"),
            Some(None) => Code::Redeclared
                .at(at, format!("`{text}` is declared already, by ShaderToy"))
                .note("leave this declaration out: ShaderToy declares its inputs itself"),
            None if self.scopes.is_global() && text == "main" => Code::Redeclared
                .at(at, "`main` is ShaderToy's own")
                .note("it calls `void mainImage(out vec4 fragColor, in vec2 fragCoord)` for each pixel: write that one"),
            None => return true,
        };
        self.report(diagnostic);
        false
    }

    /// §3.8: names that begin with `gl_` are GLSL's, names with two underscores are better left alone.
    pub(super) fn may_name(&mut self, text: &str, at: Place) {
        if text.starts_with("gl_") {
            self.error(
                Code::Redeclared,
                at,
                format!("`{text}` begins with `gl_`: such names belong to GLSL"),
            );
        } else if text.contains("__") {
            let message = format!("names with two underscores such as `{text}` belong to GLSL");
            tell(&mut self.warnings, Code::ReservedName.at(at, message));
        }
    }

    /// `invariant x;`: of an output that is declared (§4.6.1).
    pub(crate) fn invariant(&mut self, name: Symbol, at: Place) {
        let expr = self.name(name, at);
        if let Some(variable) = self.tree.root_variable(expr)
            && !matches!(
                self.tree[variable].kind,
                VariableKind::Output | VariableKind::BuiltIn(BuiltInVariable::FragDepth)
            )
        {
            self.error(Code::BadQualifier, at, "only an output can be `invariant`");
        }
    }

    /// `highp vec2`: numbers and samplers have a precision, nothing else has (§4.5.3).
    pub(crate) fn precision_fits(&mut self, qualifiers: &Qualifiers, specifier: &Specifier) {
        let numeric = matches!(specifier.base, Type::Sampler(_) | Type::Error)
            || specifier
                .base
                .scalar()
                .is_some_and(|scalar| scalar != Scalar::Bool);
        if let Some(at) = qualifiers.precision
            && !numeric
        {
            let message = format!("{} has no precision", self.said(specifier.base));
            self.error(Code::BadQualifier, at, message);
        }
    }

    /// `precision highp t;`: of `float`, `int` and samplers (§4.5.4).
    pub(crate) fn precision(&mut self, specifier: &Specifier) {
        let (ty, at) = (specifier.base, specifier.at);
        if !specifier.sizes.is_empty() {
            self.error(Code::BadType, at, "an array has no default precision");
        } else if !matches!(ty, Type::FLOAT | Type::INT | Type::Sampler(_)) {
            let message = format!(
                "only `int`, `float` and samplers have a precision, not {}",
                self.said(ty)
            );
            self.error(Code::BadType, at, message);
        }
    }

    /// §9 has no `;` alone at global scope; desktop GLSL does.
    pub(crate) fn takes_stray_semicolons(&self) -> bool {
        self.lenient
    }

    pub(crate) fn open_scope(&mut self) {
        self.scopes.open();
    }

    pub(crate) fn close_scope(&mut self) {
        self.scopes.close();
    }
}
