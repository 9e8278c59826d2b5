//! Expressions as values, with the parentheses that WGSL asks for (§8.19): it mixes neither `&&` with `||` nor any of the
//! bitwise operators with others.

use toyproof_glsl::tree::{
    BinaryOp, BuiltInVariable, Direction, ExprId, ExprKind, Scalar, Type, UnaryOp, VariableId, VariableKind,
    walk,
};

use super::Unprintable;
use super::construct::as_scalar;
use super::facts::is_out;
use super::text::{Class, Printed, Text};
use super::writer::Writer;

/// The comparison that holds of two scalars where another does not.
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
    /// The words for a value; lines for what it does are printed first.
    pub(super) fn value(&mut self, id: ExprId) -> Printed {
        self.in_time()?;
        let tree = &self.draft.tree;
        let expr = &tree[id];
        match &expr.kind {
            ExprKind::Literal(literal) => {
                let words = self.literal(literal, expr.at);
                Ok(Text::primary(words))
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
            &ExprKind::Step { target, .. } if self.waiting.contains(&id) => self.value(target),
            &ExprKind::Step { op, target, .. } => {
                let before = self.value(target)?;
                let before = self.keep(&before);
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
                let letters = self.comments.letters(components, expr.at);
                Ok(Text::primary(format!("{vector}.{letters}")))
            }
            &ExprKind::Member { structure, member } => {
                let name = match tree[structure].ty {
                    Type::Struct(id) => self.names.members.get(&(id, member)).cloned().unwrap_or_default(),
                    _ => return Err(Unprintable("a member of what is no structure")),
                };
                let structure = self.value(structure)?.operand();
                Ok(Text::primary(format!("{structure}.{name}")))
            }
            &ExprKind::Index { base, index } => self.index(base, index),
            ExprKind::Length { array } => match tree[*array].ty {
                Type::Array(array) => Ok(Text::primary(tree.array(array).size.to_string())),
                _ => Err(Unprintable("the length of what is no array")),
            },
        }
    }

    /// Several values, each as it is when its turn comes.
    pub(super) fn values(&mut self, ids: &[ExprId]) -> Result<Vec<Text>, Unprintable> {
        let mut texts: Vec<Text> = Vec::new();
        for &id in ids {
            if self.hoists(id) && walk::acts(&self.draft.tree, id) {
                for (text, &earlier) in texts.iter_mut().zip(ids) {
                    if !self.is_settled(earlier) {
                        *text = self.keep(text);
                    }
                }
            }
            let text = self.value(id)?;
            texts.push(text);
        }
        Ok(texts)
    }

    /// Values between commas. WGSL takes `a < b, c > d` for a list of types (§3.9).
    pub(super) fn list(texts: Vec<Text>) -> String {
        let is_relation = |text: &Text| text.class == Class::Relation;
        let has = |sign| {
            texts
                .iter()
                .any(|text| is_relation(text) && text.words.contains(sign))
        };
        let is_list_of_types = has('<') && has('>');
        let words = texts.into_iter().map(|text| {
            if is_list_of_types && is_relation(&text) {
                format!("({})", text.words)
            } else {
                text.words
            }
        });
        words.collect::<Vec<_>>().join(", ")
    }

    /// Whether printing a value prints lines before it: found out by printing it.
    pub(super) fn hoists(&mut self, id: ExprId) -> bool {
        if let Some(&known) = self.hoisting.get(&id) {
            return known;
        }
        let length = self.out.len();
        let temporaries = self.temporaries.clone();
        // What cannot be printed is found out when it is printed.
        let printed = self.value(id);
        let hoists = printed.is_ok() && self.out.len() > length;
        self.out.truncate(length);
        self.temporaries = temporaries;
        self.hoisting.insert(id, hoists);
        hoists
    }

    /// Whether a value is the same before and after whatever else is done: it is made of what is never written.
    pub(super) fn is_settled(&self, id: ExprId) -> bool {
        let tree = &self.draft.tree;
        let may_change = |kind: &ExprKind| match kind {
            ExprKind::Variable(variable) => match tree[*variable].kind {
                VariableKind::Const | VariableKind::Input(_) => false,
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

    /// What a condition comes to if it does not hold. Comparisons of floats are turned round only where they ask whether both are equal: none
    /// holds of what is no number.
    pub(super) fn negated(&mut self, id: ExprId) -> Result<String, Unprintable> {
        let tree = &self.draft.tree;
        if let ExprKind::Binary { op, left, right } = tree[id].kind
            && let Type::Scalar(scalar) = tree[left].ty
            && let Some(other) = opposite(op, scalar)
        {
            return Ok(self.binary(other, left, right)?.words);
        }
        Ok(format!("!{}", self.value(id)?.operand()))
    }

    /// A value under a name, as it is now.
    pub(super) fn keep(&mut self, text: &Text) -> Text {
        let name = text.words.trim_start_matches('*');
        let stem = if self.names.all.contains(name) {
            format!("old_{name}")
        } else {
            "value".to_owned()
        };
        self.keep_as(&stem, text)
    }

    /// The same under a name like that.
    pub(super) fn keep_as(&mut self, stem: &str, text: &Text) -> Text {
        let name = self.temporary(stem);
        self.line(&format!("let {name} = {};", text.words));
        Text::primary(name)
    }

    /// A variable where it is read.
    pub(super) fn read(&mut self, id: VariableId) -> Printed {
        let variable = &self.draft.tree[id];
        match variable.kind {
            VariableKind::Input(input) => Ok(Text::primary(self.input(input)?)),
            VariableKind::BuiltIn(BuiltInVariable::FragCoord) => {
                self.reads_position = true;
                Ok(Text::primary("gl_FragCoord"))
            }
            VariableKind::BuiltIn(_) | VariableKind::BuiltInConstant => {
                Err(Unprintable("that built-in variable"))
            }
            _ if is_out(self.draft, id) => Ok(Text {
                words: format!("*{}", self.variable(id)),
                class: Class::Unary,
            }),
            _ => Ok(Text::primary(self.variable(id))),
        }
    }

    fn unary(&mut self, op: UnaryOp, operand: ExprId) -> Printed {
        if matches!(self.draft.tree[operand].ty, Type::Matrix { .. }) && op == UnaryOp::Minus {
            let operand = self.value(operand)?.within(&[Class::Primary]);
            return Ok(Text {
                words: format!("-1.0 * {operand}"),
                class: Class::Product,
            });
        }
        let operand = self.value(operand)?;
        Ok(match op {
            UnaryOp::Plus => operand,
            _ => Text {
                words: format!("{}{}", op.symbol(), operand.operand()),
                class: Class::Unary,
            },
        })
    }

    pub(super) fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> Printed {
        let tree = &self.draft.tree;
        if matches!(op, BinaryOp::And | BinaryOp::Or) && self.hoists(right) {
            return self.either(op, left, right);
        }
        let types = [tree[left].ty, tree[right].ty];
        let outer = self.suffixed;
        let is_abstract = self.is_abstract(left) && self.is_abstract(right);
        self.suffixed |= is_abstract;
        let texts = self.values(&[left, right]);
        self.suffixed = outer;
        let [left, right] = <[Text; 2]>::try_from(texts?).map_err(|_| Unprintable("an operator"))?;
        self.operation(op, (left, types[0]), (right, types[1]))
    }

    /// An operator between words.
    pub(super) fn operation(
        &mut self,
        op: BinaryOp,
        (left, left_type): (Text, Type),
        (right, right_type): (Text, Type),
    ) -> Printed {
        use Class::{Chain, Primary, Product, Relation, Sum, Unary};
        let is_matrix = |ty| matches!(ty, Type::Matrix { .. });
        let is_scalar = |ty| matches!(ty, Type::Scalar(_));
        let [l, r] = [is_matrix(left_type), is_matrix(right_type)];
        if (l || r)
            && !matches!(op, BinaryOp::Multiply)
            && !(l && r && matches!(op, BinaryOp::Add | BinaryOp::Subtract))
        {
            return Err(Unprintable("that operation of a matrix"));
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
                    Type::Scalar(Scalar::Int) => as_scalar(right, right_type, Type::UINT)?.words,
                    Type::Vector(Scalar::Int, size) => format!("vec{size}u({})", right.words),
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
                let words = format!("{} {symbol} {}", left.within(&bare), right.within(&bare));
                return Ok(match left_type {
                    Type::Vector(..) if op == BinaryOp::Equal => Text::primary(format!("all({words})")),
                    Type::Vector(..) => Text::primary(format!("any({words})")),
                    _ => Text {
                        words,
                        class: Relation,
                    },
                });
            }
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor => {
                let splat = |words: String, own: Type, other: Type| match other {
                    Type::Vector(..) if is_scalar(own) => format!("{}({words})", self.type_name(other)),
                    _ => words,
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
        Ok(Text {
            words: format!("{left} {} {right}", op.symbol()),
            class,
        })
    }

    pub(super) fn index(&mut self, base: ExprId, index: ExprId) -> Printed {
        let tree = &self.draft.tree;
        let in_memory = tree.root_variable(base).is_some() || matches!(tree[base].ty, Type::Vector(..));
        let constant = tree[index].constant;
        let [base, index] = if tree.root_variable(base).is_some() {
            // A place, not a value: it is the same before and after what the index does.
            let index = self.value(index)?;
            [self.value(base)?, index]
        } else {
            <[Text; 2]>::try_from(self.values(&[base, index])?).map_err(|_| Unprintable("an index"))?
        };
        let base = if in_memory || constant {
            base.operand()
        } else {
            let name = self.temporary("indexed");
            self.line(&format!("var {name} = {};", base.words));
            name
        };
        Ok(Text::primary(format!("{base}[{}]", index.words)))
    }
}
