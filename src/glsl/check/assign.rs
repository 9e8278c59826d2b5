//! What may be written (§5.8).

use super::Checker;
use crate::codes::Code;
use crate::tree::{
    BinaryOp, BuiltInVariable, Direction, ExprId, ExprKind, Input, Place, Scalar, StepOp, Type, VariableKind,
};

impl Checker<'_> {
    pub(crate) fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId) -> ExprId {
        let at = self.tree[target].at.to(self.tree[value].at);
        if !self.writable(target, "assigned to") {
            return self.broken(at);
        }
        let ty = self.ty(target);
        let value = match op {
            None => self.expect(value, ty, "the value assigned here"),
            Some(op) => self.assigned_operand(op, target, value),
        };
        if ty == Type::Error || self.ty(value) == Type::Error {
            return self.broken(at);
        }
        self.push(ExprKind::Assign { op, target, value }, ty, false, at)
    }

    /// The right side of `+=` and the like: the operation must give the target's type again.
    fn assigned_operand(&mut self, op: BinaryOp, target: ExprId, value: ExprId) -> ExprId {
        let (a, mut value) = (self.ty(target), value);
        let scalar = a.scalar();
        if let Some(to) = scalar.and_then(|scalar| self.ty(value).with_scalar(scalar)) {
            value = self.convert(value, to).unwrap_or(value);
        }
        let b = self.ty(value);
        if a == Type::Error || b == Type::Error || self.binary_type(op, a, b) == Some(a) {
            return value;
        }
        let at = self.tree[target].at.to(self.tree[value].at);
        let message = format!(
            "`{}=` does not take {} and {}",
            op.symbol(),
            self.said(a),
            self.said(b)
        );
        let diagnostic = Code::BadOperands.at(at, message);
        let diagnostic = self.mended_operands(diagnostic, op, target, value);
        self.refuse_with(diagnostic, at)
    }

    pub(crate) fn step(&mut self, op: StepOp, postfix: bool, target: ExprId, at: Place) -> ExprId {
        let at = at.to(self.tree[target].at);
        let ty = self.ty(target);
        if ty == Type::Error || !self.writable(target, "changed") {
            return self.broken(at);
        }
        if ty.scalar().is_none_or(|scalar| scalar == Scalar::Bool) {
            let message = format!("`{}` does not take {}", op.symbol(), self.said(ty));
            return self.refuse(Code::BadOperands, at, message);
        }
        self.push(ExprKind::Step { op, postfix, target }, ty, false, at)
    }

    /// Whether the expression is an lvalue; if not, says why. `verb` is what is done to it.
    pub(super) fn writable(&mut self, expr: ExprId, verb: &str) -> bool {
        let at = self.tree[expr].at;
        if self.ty(expr) == Type::Error {
            return true;
        }
        let mut part = expr;
        let variable = loop {
            part = match self.tree[part].kind {
                ExprKind::Variable(variable) => break variable,
                ExprKind::Swizzle { components, .. } if components.repeats() => {
                    let message = format!(
                        "`.{}` names a component twice and cannot be {verb}",
                        components.name()
                    );
                    self.error(Code::NotWritable, at, message);
                    return false;
                }
                ExprKind::Swizzle { vector: base, .. }
                | ExprKind::Member { structure: base, .. }
                | ExprKind::Index { base, .. } => base,
                _ => {
                    self.error(
                        Code::NotWritable,
                        at,
                        format!("this is not a variable, so it cannot be {verb}"),
                    );
                    return false;
                }
            };
        };
        let variable = &self.tree[variable];
        let ty = self.tree.type_name(variable.ty);
        let copy = format!(
            "give a variable of your own its value and change that: `{ty} mine = {};`",
            variable.name
        );
        let constant = "leave `const` out of its declaration if it is to change";
        let (what, note) = match variable.kind {
            VariableKind::BuiltInConstant => ("a constant", None),
            VariableKind::Const => ("a constant", Some(constant.to_owned())),
            VariableKind::Parameter(Direction::ConstIn) => ("a `const` parameter", Some(constant.to_owned())),
            VariableKind::Input(Input::Channel(_)) => ("a sampler", None),
            VariableKind::Input(_) | VariableKind::Uniform => ("a uniform", Some(copy)),
            VariableKind::Varying => ("an input", Some(copy)),
            VariableKind::BuiltIn(built_in) if built_in != BuiltInVariable::FragDepth => {
                ("an input", Some(copy))
            }
            _ if self.holds_sampler(self.ty(expr)) => ("a sampler", None),
            _ => return true,
        };
        let message = format!("`{}` is {what} and cannot be {verb}", variable.name);
        let mut diagnostic = Code::NotWritable.at(at, message);
        if let (Some(declared), VariableKind::Const | VariableKind::Parameter(_)) =
            (variable.at, variable.kind)
        {
            diagnostic = diagnostic.related(declared.span, "declared here");
        }
        diagnostic.notes.extend(note);
        self.report(diagnostic);
        false
    }
}
