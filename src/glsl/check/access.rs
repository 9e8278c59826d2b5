//! Names, members, swizzles and indices (§5.5–§5.7).

use toyproof_diagnostic::{Code, nearest, plural};

use super::Checker;
use super::scope::{Entity, did_you_mean};
use crate::analysis::Resolution;
use crate::dialect::Bound;
use crate::token::Symbol;
use crate::tree::{
    BuiltIn, ExprId, ExprKind, Place, Scalar, StructId, Swizzle, Type, Variable, VariableId, VariableKind,
};

/// The three sets of component names; a swizzle takes all of its names from one set (§5.5).
const COMPONENT_NAMES: [&str; 3] = ["xyzw", "rgba", "stpq"];

impl Checker<'_> {
    /// Resolves a name that is used as a value.
    pub(crate) fn name(&mut self, name: Symbol, at: Place) -> ExprId {
        let text = self.text(name);
        match self.scopes.find(name) {
            Some(&Entity::Variable(variable)) => {
                self.resolved(at, Resolution::Variable(variable));
                if let Some(bound) = self.bound.get(&variable).cloned() {
                    if matches!(bound, Bound::Value(..)) {
                        self.values_read.insert(variable);
                    }
                    return self.bound_value(bound, at);
                }
                self.report_unbound_texture(variable, at);
                let variable = self.bound_texture(variable);
                let found = &self.tree[variable];
                let constant = match found.kind {
                    VariableKind::BuiltInConstant => true,
                    VariableKind::Const => found.initializer.is_some_and(|value| self.tree[value].constant),
                    _ => false,
                };
                let ty = found.ty;
                self.push(ExprKind::Variable(variable), ty, constant, at)
            }
            Some(Entity::Struct(_)) => self.refuse(
                Code::NotAVariable,
                at,
                format!("`{text}` is a type, not a variable"),
            ),
            Some(Entity::Functions(_)) => self.refuse(
                Code::NotAVariable,
                at,
                format!("`{text}` is a function, not a variable"),
            ),
            None if BuiltIn::named(text).is_some_and(|function| self.language.has(function)) => self.refuse(
                Code::NotAVariable,
                at,
                format!("`{text}` is a function, not a variable"),
            ),
            None => self.undeclared(name, at),
        }
    }

    /// The channel of a sampler that the author declares: its value is 0, the number of `iChannel0`. Other
    /// variables are themselves.
    fn bound_texture(&self, variable: VariableId) -> VariableId {
        let own = &self.tree[variable];
        if own.kind != VariableKind::Uniform || !matches!(own.ty, Type::Sampler(_)) {
            return variable;
        }
        let is_first = |(_, channel): &(VariableId, &Variable)| {
            channel.kind == VariableKind::Channel(0) && channel.ty == own.ty
        };
        let channel = self.tree.variables.iter().find(is_first);
        channel.map_or(variable, |(channel, _)| channel)
    }

    /// Whether the name is declared in the current scope or built in.
    pub(crate) fn is_declared(&self, name: Symbol) -> bool {
        self.scopes.find(name).is_some() || BuiltIn::named(self.text(name)).is_some()
    }

    /// The structure that the name denotes in the current scope, if any.
    pub(crate) fn struct_named(&self, name: Symbol) -> Option<StructId> {
        match self.scopes.find(name)? {
            Entity::Struct(found) => Some(*found),
            _ => None,
        }
    }

    /// Records that the structure of a type is named at a place.
    pub(crate) fn named_type(&mut self, ty: Type, at: Place) {
        if let Type::Struct(id) = ty {
            self.resolved(at, Resolution::Struct(id));
        }
    }

    /// Checks `base.name`: a member or a swizzle.
    pub(crate) fn field(&mut self, base: ExprId, name: Symbol, at: Place) -> ExprId {
        let (ty, constant) = (self.ty(base), self.tree[base].constant);
        let whole = self.tree[base].at.to(at);
        let text = self.text(name);
        match ty {
            Type::Error => self.error_expr(whole),
            Type::Struct(id) => {
                let members = &self.tree[id].members;
                let Some(member) = members.iter().position(|member| member.name == text) else {
                    if self.incomplete.contains(&id) {
                        return self.error_expr(whole);
                    }
                    let near = nearest(text, members.iter().map(|member| &*member.name));
                    let message = format!("{} has no member `{text}`", self.quoted_type(ty));
                    let names: Vec<_> = members
                        .iter()
                        .map(|member| format!("`{}`", member.name))
                        .collect();
                    let diagnostic = did_you_mean(Code::UnknownMember, at, &message, near)
                        .note(format!("its members are {}", names.join(", ")));
                    return self.refuse_with(diagnostic, at);
                };
                let ty = members[member].ty;
                self.resolved(at, Resolution::Member(id, member));
                let kind = ExprKind::Member {
                    structure: base,
                    member,
                };
                self.push(kind, ty, constant, whole)
            }
            Type::Vector(scalar, size) => {
                let Some(components) = swizzle(text, size) else {
                    let message = format!("invalid swizzle `.{text}` of {}", self.quoted_type(ty));
                    let label = format!("its components are `.{}`", &"xyzw"[..usize::from(size)]);
                    let diagnostic = Code::UnknownMember.at(at, message).label(label);
                    return self.refuse_with(diagnostic, at);
                };
                let kind = ExprKind::Swizzle {
                    vector: base,
                    components,
                };
                self.push(kind, Type::vector(scalar, components.size()), constant, whole)
            }
            _ => {
                let message = format!("{} has no member `{text}`", self.quoted_type(ty));
                self.refuse(Code::UnknownMember, at, message)
            }
        }
    }

    /// Checks `array.length()` (§5.7), the only method in GLSL.
    pub(crate) fn method(&mut self, base: ExprId, name: Symbol, at: Place) -> ExprId {
        let ty = self.ty(base);
        let whole = self.tree[base].at.to(at);
        match ty {
            Type::Error => self.error_expr(whole),
            Type::Array(_) if self.text(name) == "length" => {
                self.check_whole_array(ty, "the length", whole);
                self.push(ExprKind::Length { array: base }, Type::INT, true, whole)
            }
            _ => {
                let message = format!("{} has no method `{}`", self.quoted_type(ty), self.text(name));
                self.refuse(Code::UnknownMember, at, message)
            }
        }
    }

    /// Checks `base[index]`.
    pub(crate) fn index(&mut self, base: ExprId, index: ExprId, close: Place) -> ExprId {
        let at = self.tree[base].at.to(close);
        let (ty, index_type) = (self.ty(base), self.ty(index));
        if ty == Type::Error || index_type == Type::Error {
            return self.error_expr(at);
        }
        let (element, size) = match ty {
            Type::Vector(scalar, size) => (Type::Scalar(scalar), u32::from(size)),
            Type::Matrix { columns, rows } => (Type::Vector(Scalar::Float, rows), u32::from(columns)),
            Type::Array(array) => (self.tree.array(array).element, self.tree.array(array).size),
            _ => {
                let message = format!("{} cannot be indexed", self.quoted_type(ty));
                return self.refuse(Code::BadIndex, at, message);
            }
        };
        if !matches!(index_type, Type::INT | Type::UINT) {
            let message = format!(
                "the index must be `int` or `uint`, not {}",
                self.quoted_type(index_type)
            );
            return self.refuse(Code::BadIndex, self.tree[index].at, message);
        }
        if let Some(value) = self.integer(index)
            && !(0..i64::from(size)).contains(&value)
        {
            let message = format!(
                "index {value} is out of bounds: {} has {size} {}",
                self.quoted_type(ty),
                plural(u64::from(size), "element", "elements")
            );
            let at = self.tree[index].at;
            let label = format!("the last index is {}", size.saturating_sub(1));
            return self.refuse_with(Code::BadIndex.at(at, message).label(label), at);
        }
        // §4.1.7: the sampler must be known at compile time.
        if matches!(element, Type::Sampler(_)) && !self.tree[index].constant {
            let message = "the index of a sampler array must be a constant expression";
            return self.refuse(Code::NotConstant, self.tree[index].at, message);
        }
        let constant = self.tree[base].constant && self.tree[index].constant;
        self.push(ExprKind::Index { base, index }, element, constant, at)
    }

    /// The value of an integral constant expression.
    pub(super) fn integer(&self, expr: ExprId) -> Option<i64> {
        self.tree.value(expr)?.integer()
    }
}

/// The components that a swizzle selects, all from one set of names and all less than `size`.
fn swizzle(text: &str, size: u8) -> Option<Swizzle> {
    COMPONENT_NAMES.iter().find_map(|names| {
        let components: Option<Vec<u8>> = text
            .chars()
            .map(|c| names.find(c).map(|at| at as u8).filter(|&at| at < size))
            .collect();
        Swizzle::new(&components?)
    })
}
