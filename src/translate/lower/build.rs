//! Makes nodes: every expression that lowering adds stands where the author's expression stood that it serves.

use toyproof_glsl::tree::{
    BinaryOp, Constructor, Expr, ExprId, ExprKind, FunctionId, Literal, Place, Scalar, Swizzle, Tree, Type,
    UnaryOp, Value, VariableId,
};

/// Adds expressions to a tree, all at one place of the author's text.
pub(super) struct Builder<'a> {
    pub(super) tree: &'a mut Tree,
    pub(super) at: Place,
}

impl Builder<'_> {
    pub(super) fn new(tree: &mut Tree, at: Place) -> Builder<'_> {
        Builder { tree, at }
    }

    /// Adds any expression. What lowering adds is never asked whether it is constant.
    pub(super) fn push(&mut self, kind: ExprKind, ty: Type) -> ExprId {
        self.tree.exprs.push(Expr {
            kind,
            ty,
            constant: false,
            at: self.at,
        })
    }

    /// Moves an expression to a node of its own, so that something else can take its place.
    pub(super) fn detach(&mut self, id: ExprId) -> ExprId {
        let node = self.tree[id].clone();
        self.tree.exprs.push(node)
    }

    pub(super) fn literal(&mut self, value: Value) -> ExprId {
        let text = match value {
            Value::Bool(value) => value.to_string(),
            Value::Int(value) => value.to_string(),
            Value::Uint(value) => format!("{value}u"),
            Value::Float(value) => format!("{value:?}"),
        };
        let literal = Literal {
            text: text.into(),
            value,
        };
        let ty = value.ty();
        let id = self.push(ExprKind::Literal(literal), ty);
        self.tree[id].constant = true;
        id
    }

    /// A literal 0 or 1 of that scalar type.
    pub(super) fn small(&mut self, scalar: Scalar, one: bool) -> ExprId {
        self.literal(match scalar {
            Scalar::Bool => Value::Bool(one),
            Scalar::Int => Value::Int(one.into()),
            Scalar::Uint => Value::Uint(one.into()),
            Scalar::Float => Value::Float(one.into()),
        })
    }

    pub(super) fn variable(&mut self, variable: VariableId) -> ExprId {
        let ty = self.tree[variable].ty;
        self.push(ExprKind::Variable(variable), ty)
    }

    pub(super) fn unary(&mut self, op: UnaryOp, operand: ExprId) -> ExprId {
        let ty = self.tree[operand].ty;
        self.push(ExprKind::Unary { op, operand }, ty)
    }

    pub(super) fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId, ty: Type) -> ExprId {
        self.push(ExprKind::Binary { op, left, right }, ty)
    }

    pub(super) fn assign(&mut self, target: ExprId, value: ExprId) -> ExprId {
        let ty = self.tree[target].ty;
        self.push(
            ExprKind::Assign {
                op: None,
                target,
                value,
            },
            ty,
        )
    }

    /// `variable = value`.
    pub(super) fn set(&mut self, variable: VariableId, value: ExprId) -> ExprId {
        let target = self.variable(variable);
        self.assign(target, value)
    }

    /// `first, second, …`; of at least one.
    pub(super) fn sequence(&mut self, steps: Vec<ExprId>) -> ExprId {
        let chain = steps.into_iter().reduce(|first, second| {
            let ty = self.tree[second].ty;
            self.push(ExprKind::Sequence { first, second }, ty)
        });
        chain.unwrap_or_else(|| self.literal(Value::Bool(true)))
    }

    pub(super) fn call(&mut self, function: FunctionId, arguments: Vec<ExprId>) -> ExprId {
        let ty = self.tree[function].return_type;
        self.push(ExprKind::Call { function, arguments }, ty)
    }

    pub(super) fn construct(&mut self, constructor: Constructor, arguments: Vec<ExprId>, ty: Type) -> ExprId {
        self.push(
            ExprKind::Construct {
                constructor,
                arguments,
            },
            ty,
        )
    }

    /// Those components of a vector.
    pub(super) fn swizzle(&mut self, vector: ExprId, components: Swizzle) -> ExprId {
        let scalar = self.tree[vector].ty.scalar().unwrap_or(Scalar::Float);
        let ty = Type::vector(scalar, components.size());
        self.push(ExprKind::Swizzle { vector, components }, ty)
    }

    pub(super) fn index(&mut self, base: ExprId, index: ExprId) -> ExprId {
        let ty = match self.tree[base].ty {
            Type::Array(array) => self.tree.array(array).element,
            Type::Matrix { rows, .. } => Type::vector(Scalar::Float, rows),
            Type::Vector(scalar, _) => Type::Scalar(scalar),
            other => other,
        };
        self.push(ExprKind::Index { base, index }, ty)
    }

    /// A deep copy.
    pub(super) fn copy(&mut self, root: ExprId) -> ExprId {
        self.copy_with(root, |variable| variable)
    }

    /// A deep copy that names other variables.
    pub(super) fn copy_with(
        &mut self,
        root: ExprId,
        mut rename: impl FnMut(VariableId) -> VariableId,
    ) -> ExprId {
        let order = self.tree.postorder(root);
        let mut copies = std::collections::HashMap::with_capacity(order.len());
        for id in order {
            let mut node = self.tree[id].clone();
            node.kind
                .for_each_operand_mut(|operand| *operand = copies[operand]);
            if let ExprKind::Variable(variable) = &mut node.kind {
                *variable = rename(*variable);
            }
            copies.insert(id, self.tree.exprs.push(node));
        }
        copies[&root]
    }
}
