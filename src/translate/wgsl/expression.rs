//! Expressions as values, with the parentheses that WGSL requires (§8.19): it mixes neither `&&` with `||`
//! nor bitwise operators with others.

use toyproof_glsl::tree::{
    BinaryOp, BuiltInVariable, Direction, ExprId, ExprKind, Scalar, Type, UnaryOp, VariableId, VariableKind,
    walk,
};

use super::Unprintable;
use super::construct::as_scalar;
use super::writer::{Class, Text, TextResult, Writer, is_out};

/// The comparison of scalars that holds exactly if the given one does not.
fn opposite(op: BinaryOp, scalar: Scalar) -> Option<BinaryOp> {
    Some(match op {
        BinaryOp::Equal => BinaryOp::NotEqual,
        BinaryOp::NotEqual => BinaryOp::Equal,
        _ if scalar == Scalar::Float => return None,
        BinaryOp::Less => BinaryOp::GreaterEqual,
        BinaryOp::Greater => BinaryOp::LessEqual,
        BinaryOp::LessEqual => BinaryOp::Greater,
        BinaryOp::GreaterEqual => BinaryOp::Less,
        _ => return None,
    })
}

impl Writer<'_> {
    /// Returns the code of a value; lines for its side effects are printed first.
    pub(super) fn value(&mut self, id: ExprId) -> TextResult {
        let printed = self.value_or_reason(id);
        if printed.is_err() {
            self.failed_at.get_or_insert(self.cx.tree[id].at);
        }
        printed
    }

    fn value_or_reason(&mut self, id: ExprId) -> TextResult {
        self.check_deadline()?;
        let tree = &self.cx.tree;
        let expr = &tree[id];
        match &expr.kind {
            ExprKind::Literal(literal) => {
                let code = self.literal(literal, expr.at);
                Ok(Text::primary(code))
            }
            &ExprKind::Variable(variable) => self.read(variable),
            &ExprKind::Unary { op, operand } => self.unary(op, operand),
            &ExprKind::Binary { op, left, right } => self.binary(op, left, right),
            ExprKind::Assign { .. } | ExprKind::Step { postfix: false, .. } => {
                self.effect(id)?;
                let target = match expr.kind {
                    ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => target,
                    _ => id,
                };
                self.value(target)
            }
            &ExprKind::Step { target, .. } if self.deferred_steps.contains(&id) => self.value(target),
            &ExprKind::Step { op, target, .. } => {
                let before = self.value(target)?;
                let before = self.bind(&before);
                self.step(op, target)?;
                Ok(before)
            }
            ExprKind::Conditional { .. } => self.conditional(id),
            &ExprKind::Sequence { first, second } => {
                self.effect(first)?;
                self.value(second)
            }
            ExprKind::Call { function, arguments } => self.call(*function, arguments, expr.ty),
            ExprKind::BuiltIn { function, arguments } => self.built_in(*function, arguments, expr.ty),
            ExprKind::Construct {
                constructor,
                arguments,
            } => self.construct(*constructor, arguments, expr.ty),
            &ExprKind::Swizzle { vector, components } => {
                if let Some(text) = self.resolution(vector, components) {
                    return Ok(text);
                }
                let vector = self.value(vector)?.operand();
                let letters = self.source.letters(components, expr.at);
                Ok(Text::primary(format!("{vector}.{letters}")))
            }
            &ExprKind::Member { structure, member } => {
                let name = match tree[structure].ty {
                    Type::Struct(id) => self.names.members.get(&(id, member)).cloned().unwrap_or_default(),
                    _ => return Err(Unprintable::Construct("a member of a non-structure")),
                };
                let structure = self.value(structure)?.operand();
                Ok(Text::primary(format!("{structure}.{name}")))
            }
            &ExprKind::Index { base, index } => self.index(base, index),
            ExprKind::Length { array } => match tree[*array].ty {
                Type::Array(array) => Ok(Text::primary(tree.array(array).size.to_string())),
                _ => Err(Unprintable::Construct("`length()` of a non-array")),
            },
        }
    }

    /// Prints several values, each as of its turn in the order of evaluation.
    pub(super) fn values(&mut self, ids: &[ExprId]) -> Result<Vec<Text>, Unprintable> {
        let mut texts: Vec<Text> = Vec::new();
        for &id in ids {
            if self.hoists(id) && walk::has_side_effects(&self.cx.tree, id) {
                for (text, &earlier) in texts.iter_mut().zip(ids) {
                    if !self.is_invariant(earlier) {
                        *text = self.bind(text);
                    }
                }
            }
            let text = self.value(id)?;
            texts.push(text);
        }
        Ok(texts)
    }

    /// Joins values by commas. WGSL parses `a < b, c > d` as a template list (§3.9).
    pub(super) fn list(texts: Vec<Text>) -> String {
        let is_relation = |text: &Text| text.class == Class::Relation;
        let has = |sign| {
            texts
                .iter()
                .any(|text| is_relation(text) && text.code.contains(sign))
        };
        let is_list_of_types = has('<') && has('>');
        let code = texts.into_iter().map(|text| {
            if is_list_of_types && is_relation(&text) {
                format!("({})", text.code)
            } else {
                text.code
            }
        });
        code.collect::<Vec<_>>().join(", ")
    }

    /// Whether a value needs lines before it; determined by a trial print.
    pub(super) fn hoists(&mut self, id: ExprId) -> bool {
        if let Some(&known) = self.hoisting.get(&id) {
            return known;
        }
        let length = self.out.len();
        let temporaries = self.temporaries.clone();
        // Errors are reported by the actual print.
        let printed = self.value(id);
        let hoists = printed.is_ok() && self.out.len() > length;
        self.out.truncate(length);
        self.temporaries = temporaries;
        self.hoisting.insert(id, hoists);
        hoists
    }

    /// Whether no side effect can change a value: it consists of variables that are never written.
    pub(super) fn is_invariant(&self, id: ExprId) -> bool {
        let tree = &self.cx.tree;
        let may_change = |kind: &ExprKind| match kind {
            ExprKind::Variable(variable) => match tree[*variable].kind {
                VariableKind::Const
                | VariableKind::Input(_)
                | VariableKind::Channel(_)
                | VariableKind::Uniform => false,
                VariableKind::Local | VariableKind::Parameter(Direction::In) => {
                    self.facts.is_memory(*variable)
                }
                _ => true,
            },
            ExprKind::Literal(_)
            | ExprKind::Unary { .. }
            | ExprKind::Binary { .. }
            | ExprKind::Swizzle { .. }
            | ExprKind::Construct { .. }
            | ExprKind::Member { .. }
            | ExprKind::Index { .. } => false,
            _ => true,
        };
        tree[id].constant || !walk::any(tree, id, may_change)
    }

    /// Prints the negation of a condition. Of float comparisons only equality can be inverted: the others are
    /// false for NaN.
    pub(super) fn negated(&mut self, id: ExprId) -> Result<String, Unprintable> {
        let tree = &self.cx.tree;
        if let ExprKind::Binary { op, left, right } = tree[id].kind
            && let Type::Scalar(scalar) = tree[left].ty
            && let Some(other) = opposite(op, scalar)
        {
            return Ok(self.binary(other, left, right)?.code);
        }
        Ok(format!("!{}", self.value(id)?.operand()))
    }

    /// Binds a value to a name, to preserve its current value.
    pub(super) fn bind(&mut self, text: &Text) -> Text {
        let name = text.code.trim_start_matches('*');
        let stem = if self.names.all.contains(name) {
            format!("old_{name}")
        } else {
            "value".to_owned()
        };
        self.bind_as(&stem, text)
    }

    /// Binds a value to a name derived from `stem`.
    pub(super) fn bind_as(&mut self, stem: &str, text: &Text) -> Text {
        let name = self.temporary(stem);
        self.line(&format!("let {name} = {};", text.code));
        Text::primary(name)
    }

    /// Prints a variable that is read.
    pub(super) fn read(&mut self, id: VariableId) -> TextResult {
        let variable = &self.cx.tree[id];
        match variable.kind {
            VariableKind::Input(input) => Ok(Text::primary(self.input(id, input)?)),
            VariableKind::BuiltIn(BuiltInVariable::FragCoord) => {
                self.reads_position = true;
                Ok(Text::primary("gl_FragCoord"))
            }
            VariableKind::BuiltIn(_) | VariableKind::BuiltInConstant => {
                Err(Unprintable::Construct("this built-in variable"))
            }
            VariableKind::Uniform if self.is_in_block(id) => Ok(self.uniform(id)),
            _ if is_out(self.cx, id) => Ok(Text::new(format!("*{}", self.variable(id)), Class::Unary)),
            _ => Ok(Text::primary(self.variable(id))),
        }
    }

    fn unary(&mut self, op: UnaryOp, operand: ExprId) -> TextResult {
        if matches!(self.cx.tree[operand].ty, Type::Matrix { .. }) && op == UnaryOp::Minus {
            let operand = self.value(operand)?.within(&[Class::Primary]);
            return Ok(Text::new(format!("-1.0 * {operand}"), Class::Product));
        }
        let operand = self.value(operand)?;
        Ok(match op {
            UnaryOp::Plus => operand,
            _ => Text::new(format!("{}{}", op.symbol(), operand.operand()), Class::Unary),
        })
    }

    pub(super) fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> TextResult {
        let tree = &self.cx.tree;
        if matches!(op, BinaryOp::And | BinaryOp::Or) && self.hoists(right) {
            return self.short_circuit(op, left, right);
        }
        let types = [tree[left].ty, tree[right].ty];
        let outer = self.suffixed;
        let is_abstract = self.is_abstract(left) && self.is_abstract(right);
        self.suffixed |= is_abstract;
        let texts = self.values(&[left, right]);
        self.suffixed = outer;
        let [left, right] =
            <[Text; 2]>::try_from(texts?).map_err(|_| Unprintable::Construct("this operator"))?;
        self.operation(op, (left, types[0]), (right, types[1]))
    }

    /// Prints an operator between values.
    pub(super) fn operation(
        &mut self,
        op: BinaryOp,
        (left, left_type): (Text, Type),
        (right, right_type): (Text, Type),
    ) -> TextResult {
        use Class::{Chain, Primary, Product, Relation, Sum, Unary};
        let is_matrix = |ty| matches!(ty, Type::Matrix { .. });
        let is_scalar = |ty| matches!(ty, Type::Scalar(_));
        let [l, r] = [is_matrix(left_type), is_matrix(right_type)];
        if (l || r)
            && !matches!(op, BinaryOp::Multiply)
            && !(l && r && matches!(op, BinaryOp::Add | BinaryOp::Subtract))
        {
            return Err(Unprintable::Construct("this matrix operation"));
        }
        let (left, right, class) = match op {
            BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Remainder => (
                left.within(&[Primary, Unary, Product]),
                right.within(&[Primary, Unary]),
                Product,
            ),
            BinaryOp::Add | BinaryOp::Subtract => (
                left.within(&[Primary, Unary, Product, Sum]),
                right.within(&[Primary, Unary, Product]),
                Sum,
            ),
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight => {
                let right = match right_type {
                    Type::Scalar(Scalar::Int) => as_scalar(right, right_type, Type::UINT)?.code,
                    Type::Vector(Scalar::Int, size) => format!("vec{size}u({})", right.code),
                    _ => right.within(&[Primary, Unary]),
                };
                let right = match (left_type, right_type) {
                    (Type::Vector(_, size), ty) if is_scalar(ty) => format!("vec{size}u({right})"),
                    _ => right,
                };
                (left.within(&[Primary, Unary]), right, Chain(op))
            }
            BinaryOp::Less | BinaryOp::Greater | BinaryOp::LessEqual | BinaryOp::GreaterEqual => {
                let bare = [Primary, Unary, Product, Sum];
                (left.within(&bare), right.within(&bare), Relation)
            }
            BinaryOp::Equal | BinaryOp::NotEqual | BinaryOp::Xor => {
                let bare = [Primary, Unary, Product, Sum];
                let symbol = if op == BinaryOp::Equal { "==" } else { "!=" };
                let code = format!("{} {symbol} {}", left.within(&bare), right.within(&bare));
                return Ok(match left_type {
                    Type::Vector(..) if op == BinaryOp::Equal => Text::primary(format!("all({code})")),
                    Type::Vector(..) => Text::primary(format!("any({code})")),
                    _ => Text::new(code, Relation),
                });
            }
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor => {
                let splat = |code: String, ty: Type, other_type: Type| match other_type {
                    Type::Vector(..) if is_scalar(ty) => format!("{}({code})", self.type_name(other_type)),
                    _ => code,
                };
                let left = splat(left.within(&[Primary, Unary, Chain(op)]), left_type, right_type);
                let right = splat(right.within(&[Primary, Unary]), right_type, left_type);
                (left, right, Chain(op))
            }
            BinaryOp::And | BinaryOp::Or => {
                let bare = [Primary, Unary, Relation];
                (
                    left.within(&[Primary, Unary, Relation, Chain(op)]),
                    right.within(&bare),
                    Chain(op),
                )
            }
        };
        Ok(Text::new(format!("{left} {} {right}", op.symbol()), class))
    }

    pub(super) fn index(&mut self, base: ExprId, index: ExprId) -> TextResult {
        let tree = &self.cx.tree;
        let in_memory = tree.root_variable(base).is_some() || matches!(tree[base].ty, Type::Vector(..));
        let constant = tree[index].constant;
        let [base, index] = if tree.root_variable(base).is_some() {
            // A place, not a value: side effects of the index do not change it.
            let index = self.value(index)?;
            [self.value(base)?, index]
        } else {
            <[Text; 2]>::try_from(self.values(&[base, index])?)
                .map_err(|_| Unprintable::Construct("this index"))?
        };
        let base = if in_memory || constant {
            base.operand()
        } else {
            let name = self.temporary("indexed");
            self.line(&format!("var {name} = {};", base.code));
            name
        };
        Ok(Text::primary(format!("{base}[{}]", index.code)))
    }
}

// `select` evaluates both branches, so `?:`, `&&` and `||` become `if`s where a branch has side effects.

type PrintResult = Result<(), Unprintable>;

impl Writer<'_> {
    /// The condition and branches of a `?:` that must become an `if`.
    pub(super) fn branch_operands(&mut self, id: ExprId) -> Option<[ExprId; 3]> {
        let ExprKind::Conditional { condition, yes, no } = self.cx.tree[id].kind else {
            return None;
        };
        let is_selection = self.is_selectable(yes) && self.is_selectable(no);
        (!is_selection).then_some([condition, yes, no])
    }

    /// Prints such a `?:` as an `if`; `end` prints the use of either branch.
    pub(super) fn print_if(
        &mut self,
        id: ExprId,
        end: &mut dyn FnMut(&mut Self, ExprId) -> PrintResult,
    ) -> PrintResult {
        let mut word = "if";
        let mut rest = id;
        while let Some([condition, yes, no]) = self.branch_operands(rest)
            && (rest == id || !self.hoists(condition))
        {
            let condition = self.value(condition)?;
            self.line(&format!("{word} {} {{", condition.code));
            self.indented(|writer| writer.print_branch(yes, end))?;
            word = "} else if";
            rest = no;
        }
        self.line("} else {");
        self.indented(|writer| writer.print_branch(rest, end))?;
        self.line("}");
        Ok(())
    }

    fn print_branch(
        &mut self,
        id: ExprId,
        end: &mut dyn FnMut(&mut Self, ExprId) -> PrintResult,
    ) -> PrintResult {
        if self.branch_operands(id).is_some() {
            self.print_if(id, end)
        } else {
            end(self, id)
        }
    }

    /// Assigns a value to the variable `name`, by an `if` where necessary.
    pub(super) fn assign_value(&mut self, name: &str, id: ExprId) -> PrintResult {
        self.print_branch(id, &mut |writer, id| {
            let value = writer.value(id)?;
            writer.line(&format!("{name} = {};", value.code));
            Ok(())
        })
    }

    /// Prints a `return` of a value, by `if`s where necessary.
    pub(super) fn return_value(&mut self, id: ExprId) -> PrintResult {
        if let Some([condition, yes, no]) = self.branch_operands(id) {
            let condition = self.value(condition)?;
            self.line(&format!("if {} {{", condition.code));
            self.indented(|writer| writer.return_value(yes))?;
            self.line("}");
            return self.return_value(no);
        }
        let value = self.value(id)?;
        self.line(&format!("return {};", value.code));
        Ok(())
    }

    pub(super) fn conditional(&mut self, id: ExprId) -> TextResult {
        if self.branch_operands(id).is_some() {
            let name = self.temporary("chosen");
            let ty = self.type_name(self.cx.tree[id].ty);
            self.line(&format!("var {name}: {ty};"));
            self.assign_value(&name, id)?;
            return Ok(Text::primary(name));
        }
        let ExprKind::Conditional { condition, yes, no } = self.cx.tree[id].kind else {
            return Err(Unprintable::Construct("this conditional expression"));
        };
        let acts = walk::has_side_effects(&self.cx.tree, condition);
        let condition = self.value(condition)?;
        // `select` lists the branches before the condition, and evaluates them first.
        let condition = if acts && !(self.is_invariant(yes) && self.is_invariant(no)) {
            self.bind_as("condition", &condition)
        } else {
            condition
        };
        let [no, yes] = [self.value(no)?, self.value(yes)?];
        Ok(Text::primary(format!(
            "select({})",
            Self::list(vec![no, yes, condition])
        )))
    }

    /// Whether an expression is cheap and free of side effects, so that it may be evaluated unconditionally.
    fn is_selectable(&mut self, id: ExprId) -> bool {
        let tree = &self.cx.tree;
        let is_plain = matches!(tree[id].ty, Type::Scalar(_) | Type::Vector(..))
            && !walk::any(tree, id, |kind| match kind {
                ExprKind::Call { .. } => true,
                ExprKind::BuiltIn { function, .. } => function.is_texture(),
                _ => false,
            });
        is_plain && !self.hoists(id)
    }

    /// Prints `&&` and `||` whose right side has side effects.
    pub(super) fn short_circuit(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> TextResult {
        let left = self.value(left)?;
        let name = self.temporary("holds");
        self.line(&format!("var {name} = {};", left.code));
        let not = if op == BinaryOp::Or { "!" } else { "" };
        self.line(&format!("if {not}{name} {{"));
        self.indented(|writer| {
            let right = writer.value(right)?;
            writer.line(&format!("{name} = {};", right.code));
            Ok(())
        })?;
        self.line("}");
        Ok(Text::primary(name))
    }
}
