//! Qualifiers: what stands before the type of a declaration (§4.3, §4.5, §4.6).

use super::{Checker, Specifier};
use crate::codes::Code;
use crate::token::Symbol;
use crate::tree::{BuiltInVariable, Place, Scalar, Type, VariableKind};
use crate::words::Keyword;

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

impl Checker<'_> {
    /// What a declaration makes of its variable.
    pub(super) fn variable_kind(&mut self, qualifiers: &Qualifiers) -> VariableKind {
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
    pub(super) fn flat_fits(&mut self, qualifiers: &Qualifiers, ty: Type, kind: VariableKind, at: Place) {
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

    /// `layout(name = …)`: what an output of a fragment shader can say (§4.3.8.2).
    pub(crate) fn layout(&mut self, name: Symbol, at: Place) {
        let text = self.text(name);
        if text != "location" {
            let message = format!("a fragment shader has no layout `{text}`");
            self.error(Code::BadQualifier, at, message);
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
}
