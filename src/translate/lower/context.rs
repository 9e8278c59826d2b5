//! The state of lowering: the tree that the passes rewrite, their additions to it, and the builder of new
//! nodes.

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::Diagnostic;
use toyproof_glsl::tree::{
    BinaryOp, Block, Constructor, Direction, Expr, ExprId, ExprKind, Function, FunctionId, Literal, Place,
    Scalar, Statement, StatementKind, Swizzle, Tree, Type, UnaryOp, Value, Variable, VariableId,
    VariableKind, walk,
};
use toyproof_glsl::{Checked, Sampling, Stage};

use crate::lower::generated::{Expansion, Helper};

/// The state that all passes share.
pub(crate) struct LoweringContext {
    pub(crate) tree: Tree,
    pub(crate) main_image: FunctionId,
    /// The tab that the shader is.
    pub(crate) stage: Stage,
    /// Whether the image's alpha is 1 whatever the shader writes.
    pub(crate) is_opaque: bool,
    /// The uniforms that are members of the author's block, in the order of their declarations.
    pub(crate) uniform_block: Vec<VariableId>,
    /// How the textures of the channels are sampled.
    pub(crate) sampling: [Sampling; 4],
    /// Assignments that run before `mainImage`, in order.
    pub(super) startup: Vec<ExprId>,
    /// The function of the assignments that run before `mainImage`.
    pub(crate) startup_function: Option<FunctionId>,
    /// Generated variables, each used within a single statement of the author; [`crate::lower::sequence`]
    /// declares them.
    pub(super) temporaries: HashSet<VariableId>,
    /// Variables whose declarations moved to an outer scope: their names must not clash with others.
    pub(crate) moved: HashSet<VariableId>,
    /// The bodies of generated functions that are plain text.
    pub(crate) helpers: HashMap<FunctionId, String>,
    /// The channels that such a text names.
    pub(crate) helper_inputs: HashMap<FunctionId, VariableId>,
    /// Whether all fetches of texels check that these are within their textures.
    pub(crate) checks_fetches: bool,
    /// Whether parameters are references as in C++, to which members and elements of variables can be bound.
    pub(crate) has_references: bool,
    /// The diagnostic for a shader that nests deeper than drivers support.
    pub(crate) too_deep: Option<Diagnostic>,
    /// Helper functions, by the types of their arguments.
    pub(super) helper_ids: HashMap<(Helper, Type, Type), FunctionId>,
    /// Generated functions that replace built-in ones, by the types of their arguments.
    pub(super) expansions: HashMap<(Expansion, Vec<Type>), FunctionId>,
}

/// Gives ShaderToy's inputs their names, which the shader of another host has replaced by its own.
fn name_inputs(tree: &mut Tree) {
    for id in tree.variables.ids() {
        match tree[id].kind {
            VariableKind::Input(input) if tree[id].name != input.name() => {
                input.name().clone_into(&mut tree[id].name);
            }
            VariableKind::Channel(channel) => tree[id].name = format!("iChannel{channel}"),
            _ => {}
        }
    }
}

impl LoweringContext {
    pub(crate) fn new(checked: &Checked) -> Self {
        let mut tree = checked.tree.clone();
        name_inputs(&mut tree);
        Self {
            tree,
            main_image: checked.main_image,
            stage: checked.stage,
            is_opaque: checked.stage == Stage::Image,
            uniform_block: Vec::new(),
            sampling: checked.sampling,
            startup: Vec::new(),
            startup_function: None,
            temporaries: HashSet::new(),
            moved: HashSet::new(),
            helpers: HashMap::new(),
            helper_inputs: HashMap::new(),
            checks_fetches: false,
            has_references: false,
            too_deep: None,
            helper_ids: HashMap::new(),
            expansions: HashMap::new(),
        }
    }

    pub(super) fn build(&mut self, at: Place) -> Builder<'_> {
        Builder::new(&mut self.tree, at)
    }

    /// Builds nodes at the place of an expression.
    pub(super) fn build_at(&mut self, id: ExprId) -> Builder<'_> {
        let at = self.tree[id].at;
        self.build(at)
    }

    /// Adds a generated variable that is used within one statement and assigned before it is read.
    pub(super) fn temporary(&mut self, name: &str, ty: Type, at: Place) -> VariableId {
        let variable = self.local(name, ty, at);
        self.temporaries.insert(variable);
        self.moved.insert(variable);
        variable
    }

    /// Adds a generated local variable.
    pub(super) fn local(&mut self, name: &str, ty: Type, at: Place) -> VariableId {
        let variable = Variable::new(format!("toyproof_{name}"), ty, VariableKind::Local, Some(at));
        self.tree.variables.push(variable)
    }

    /// Adds a generated function. Its arguments are read in place, like operands: `in` becomes `const in`.
    pub(super) fn function(
        &mut self,
        name: String,
        parameters: &[(Direction, Type, &str)],
        return_type: Type,
        at: Place,
    ) -> FunctionId {
        let variables = &mut self.tree.variables;
        let parameters = parameters.iter().map(|&(direction, ty, name)| {
            let kind = VariableKind::Parameter(match direction {
                Direction::In => Direction::ConstIn,
                other => other,
            });
            variables.push(Variable::new(name, ty, kind, Some(at)))
        });
        let parameters = parameters.collect();
        self.tree.functions.push(Function {
            name,
            return_type,
            parameters,
            body: None,
            at,
        })
    }

    /// Rewrites the body of each function by `change`.
    pub(super) fn each_body(&mut self, mut change: impl FnMut(&mut Self, FunctionId, Block) -> Block) {
        let functions: Vec<_> = self.tree.functions.ids().collect();
        for id in functions {
            if let Some(body) = self.tree[id].body.take() {
                let body = change(self, id, body);
                self.tree[id].body = Some(body);
            }
        }
    }

    /// Rewrites each statement of each function by `change`, inner statements first.
    pub(super) fn each_statement(&mut self, mut change: impl FnMut(&mut Self, Statement, &mut Block)) {
        self.each_body(|cx, _, body| walk::rebuild(body, &mut |statement, out| change(cx, statement, out)));
    }

    /// Rewrites every expression that is in the tree now by `change`, in any order.
    pub(super) fn each_expression(&mut self, mut change: impl FnMut(&mut Self, ExprId)) {
        for id in self.tree.exprs.ids() {
            change(self, id);
        }
    }

    /// Rewrites every expression by `change`, operands before their users: for changes that move operands.
    pub(super) fn each_expression_postorder(&mut self, mut change: impl FnMut(&mut Self, ExprId)) {
        let mut order = Vec::with_capacity(self.tree.exprs.len());
        let mut seen = vec![false; self.tree.exprs.len()];
        let mut pending = Vec::new();
        for root in self.tree.exprs.ids() {
            pending.push((root, false));
            while let Some((id, operands_done)) = pending.pop() {
                if operands_done {
                    order.push(id);
                } else if !std::mem::replace(&mut seen[id.index()], true) {
                    pending.push((id, true));
                    self.tree[id]
                        .kind
                        .for_each_operand(|operand| pending.push((operand, false)));
                }
            }
        }
        for id in order {
            change(self, id);
        }
    }

    /// The expressions whose values are not used.
    pub(crate) fn discarded_values(&self) -> HashSet<ExprId> {
        let mut pending = Vec::new();
        for body in self
            .tree
            .functions
            .iter()
            .filter_map(|(_, function)| function.body.as_ref())
        {
            walk::each(body, &mut |statement| match statement.kind {
                StatementKind::Expression(expr) => pending.push(expr),
                StatementKind::For { step: Some(step), .. } => pending.push(step),
                _ => {}
            });
        }
        let mut discarded = HashSet::new();
        while let Some(id) = pending.pop() {
            discarded.insert(id);
            match self.tree[id].kind {
                ExprKind::Sequence { first, second } => pending.extend([first, second]),
                ExprKind::Conditional { yes, no, .. } => pending.extend([yes, no]),
                _ => {}
            }
        }
        // The first operand of a sequence is always discarded.
        for (_, expr) in self.tree.exprs.iter() {
            if let ExprKind::Sequence { first, .. } = expr.kind {
                discarded.insert(first);
            }
        }
        discarded
    }
}

/// Adds expressions to a tree, all at the source place of the expression that they replace or serve.
pub(super) struct Builder<'a> {
    pub(super) tree: &'a mut Tree,
    pub(super) at: Place,
}

impl Builder<'_> {
    pub(super) fn new(tree: &mut Tree, at: Place) -> Builder<'_> {
        Builder { tree, at }
    }

    /// Adds an expression, not marked as constant: no pass checks this for generated nodes.
    pub(super) fn push(&mut self, kind: ExprKind, ty: Type) -> ExprId {
        self.tree.exprs.push(Expr {
            kind,
            ty,
            constant: false,
            at: self.at,
        })
    }

    /// Moves an expression to a new node, so that another can replace it.
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
        let literal = Literal::new(text, value);
        let ty = value.ty();
        let id = self.push(ExprKind::Literal(literal), ty);
        self.tree[id].constant = true;
        id
    }

    /// A 32-bit float, in the fewest digits; a negative one is a negated literal.
    pub(super) fn float(&mut self, value: f32) -> ExprId {
        let literal = Literal::new(format!("{:?}", value.abs()), Value::Float(value.abs().into()));
        let id = self.push(ExprKind::Literal(literal), Type::FLOAT);
        self.tree[id].constant = true;
        if value.is_sign_positive() {
            return id;
        }
        let negated = self.unary(UnaryOp::Minus, id);
        self.tree[negated].constant = true;
        negated
    }

    /// The literal 0 or 1 of a scalar type.
    pub(super) fn zero_or_one(&mut self, scalar: Scalar, one: bool) -> ExprId {
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

    /// `first, second, …`; of at least one step.
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

    /// Selects components of a vector.
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

    /// Copies an expression deeply.
    pub(super) fn copy(&mut self, root: ExprId) -> ExprId {
        self.copy_with(root, |variable| variable)
    }

    /// Copies an expression deeply and renames its variables.
    pub(super) fn copy_with(
        &mut self,
        root: ExprId,
        mut rename: impl FnMut(VariableId) -> VariableId,
    ) -> ExprId {
        let order = self.tree.postorder(root);
        let mut copies = HashMap::with_capacity(order.len());
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
