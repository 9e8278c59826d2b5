//! Variables and constants (§4.2, §4.3).

use super::scope::Entity;
use super::{Checker, Qualifiers, Size, Specifier, liberal_conversion};
use crate::codes::{Code, tell};
use crate::token::Symbol;
use crate::tree::{ExprId, Place, Scalar, Type, Variable, VariableId, VariableKind};

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

    /// What an array holds; of anything else, itself.
    pub(super) fn element(&self, ty: Type) -> Type {
        match ty {
            Type::Array(id) => self.tree.array(id).element,
            _ => ty,
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
