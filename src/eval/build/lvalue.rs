//! The locations of variables and their parts; indices are evaluated once.

use toyproof_glsl::tree::{
    BuiltInVariable, ExprId, ExprKind, Scalar, StructId, Tree, Type, VariableId, VariableKind,
};

use super::{Builder, Result};
use crate::ir::{Cell, Cells, Fault, Kind, NONE, Node, Operation, Predicate, Value, ValueDef};

/// The location of a variable.
#[derive(Debug, Clone)]
pub(super) enum Location {
    /// A variable in cells of its own.
    Cells(Cells),
    /// A read-only variable.
    Values(Vec<Value>),
    /// A sampler: the texture of a channel, or unbound.
    Channel(Option<u8>),
}

/// A part of a variable: an l-value.
#[derive(Debug, Clone)]
pub(super) struct LValue {
    ty: Type,
    /// The first cell of the part.
    first: u32,
    /// The offsets of the components from the first cell, if the components are not contiguous.
    swizzle: Option<Vec<u32>>,
    /// The dynamic index that is added to each component's cell, and the cells that the index may select.
    pub(super) index: Option<(Value, Cells)>,
}

impl Builder<'_> {
    /// Returns the location of a variable that is in scope.
    pub(super) fn location(&mut self, variable: VariableId) -> Location {
        if let Some(location) = self.locations.get(&variable) {
            return location.clone();
        }
        let ty = self.tree[variable].ty;
        let location = match self.tree[variable].kind {
            VariableKind::Channel(channel) => Location::Channel(Some(channel)),
            VariableKind::Input(input) => {
                let components = 0..component_count(self.tree, ty) as u8;
                Location::Values(
                    components
                        .map(|at| self.value(ValueDef::Input(input, at)))
                        .collect(),
                )
            }
            VariableKind::BuiltIn(BuiltInVariable::FragCoord) => Location::Values(self.frag_coord().to_vec()),
            VariableKind::BuiltIn(BuiltInVariable::FrontFacing) => {
                Location::Values(vec![self.bool_value(true)])
            }
            VariableKind::BuiltInConstant => {
                let value = self.tree[variable].value.as_ref();
                let value = value
                    .and_then(toyproof_glsl::tree::Constant::integer)
                    .unwrap_or(0);
                Location::Values(vec![self.word(value as u32)])
            }
            _ if matches!(ty, Type::Sampler(_)) => Location::Channel(None),
            VariableKind::Uniform | VariableKind::Varying => Location::Values(self.uniform(variable)),
            VariableKind::BuiltIn(BuiltInVariable::PointCoord) => Location::Values(self.zeros(ty)),
            // An erroneous declaration.
            _ => {
                let zeros = self.zeros(ty);
                match self.allocate_type(ty) {
                    Ok(cells) => {
                        self.store_all(cells, &zeros);
                        Location::Cells(cells)
                    }
                    Err(_) => Location::Values(zeros),
                }
            }
        };
        self.locations.insert(variable, location.clone());
        location
    }

    /// Returns a uniform: a parameter, or zero.
    fn uniform(&self, variable: VariableId) -> Vec<Value> {
        let ty = self.tree[variable].ty;
        match (self.parameters.get(&variable), ty) {
            (Some(&number), Type::Scalar(scalar)) => {
                vec![self.value(ValueDef::Parameter(scalar_kind(scalar), number))]
            }
            _ => self.zeros(ty),
        }
    }

    /// Returns `gl_FragCoord`: the center of the pixel, with z = 0 and w = 1.
    pub(super) fn frag_coord(&self) -> [Value; 4] {
        use crate::ir::Axis;
        [
            self.value(ValueDef::FragCoord(Axis::X)),
            self.value(ValueDef::FragCoord(Axis::Y)),
            self.float(0.0),
            self.float(1.0),
        ]
    }

    /// Returns the part of a variable that an expression denotes, and evaluates its indices; none if it
    /// denotes none, or one that is not in cells.
    pub(super) fn lvalue(&mut self, expr: ExprId) -> Result<Option<LValue>> {
        let mut path = Vec::new();
        let mut part = expr;
        let variable = loop {
            part = match self.tree[part].kind {
                ExprKind::Variable(variable) => break variable,
                ExprKind::Swizzle { vector: base, .. }
                | ExprKind::Member { structure: base, .. }
                | ExprKind::Index { base, .. } => {
                    path.push(part);
                    base
                }
                _ => return Ok(None),
            };
        };
        let Location::Cells(cells) = self.location(variable) else {
            return Ok(None);
        };
        let mut target = LValue {
            ty: self.tree[variable].ty,
            first: cells.first,
            swizzle: None,
            index: None,
        };
        for step in path.into_iter().rev() {
            self.narrow(&mut target, step)?;
        }
        Ok(Some(target))
    }

    /// Narrows a target by one selection.
    fn narrow(&mut self, target: &mut LValue, selection: ExprId) -> Result<()> {
        let ty = self.ty(selection);
        match self.tree[selection].kind {
            ExprKind::Member { member, .. } => {
                if let Type::Struct(id) = target.ty {
                    target.first += member_offset(self.tree, id, member) as u32;
                }
            }
            ExprKind::Swizzle { components, .. } => {
                let chosen = components.components().iter();
                let chosen = chosen.map(|&at| match &target.swizzle {
                    Some(swizzle) => swizzle[usize::from(at)],
                    None => u32::from(at),
                });
                target.swizzle = Some(chosen.collect());
            }
            ExprKind::Index { index, .. } => {
                let (element, count) = indexed_element(self.tree, target.ty);
                if let Some(at) = self.constant_index(index, count) {
                    target.first += match target.swizzle.take() {
                        Some(swizzle) => swizzle[at],
                        None => (at * component_count(self.tree, element)) as u32,
                    };
                } else {
                    let index = self.clamped_index(index, count)?;
                    self.index_at(target, index);
                }
            }
            _ => {}
        }
        target.ty = ty;
        Ok(())
    }

    fn index_at(&mut self, target: &mut LValue, index: Value) {
        let (element, count) = indexed_element(self.tree, target.ty);
        let size = component_count(self.tree, element) as u32;
        let (scaled, reach) = match target.swizzle.take() {
            None if size == 1 => (index, count),
            None => {
                let size_word = self.word(size);
                (self.binary(Operation::MulWord, index, size_word), size * count)
            }
            Some(swizzle) => {
                let mut chosen = self.word(swizzle[0]);
                for (at, &offset) in (0..).zip(&swizzle).skip(1) {
                    let [at, offset] = [at, offset].map(|word| self.word(word));
                    let selected = self.binary(Operation::EqualWord, index, at);
                    chosen = self.select(selected, offset, chosen, Kind::Word);
                }
                (chosen, swizzle.iter().max().map_or(1, |last| last + 1))
            }
        };
        let cells = Cells {
            first: target.first,
            count: reach,
        };
        target.index = Some(match target.index.take() {
            None => (scaled, cells),
            Some((outer, cells)) => (self.binary(Operation::AddWord, outer, scaled), cells),
        });
        target.ty = element;
    }

    /// Returns the value of an index that is a constant expression and in range.
    pub(super) fn constant_index(&self, index: ExprId, count: u32) -> Option<usize> {
        let value = self.tree.value(index)?.integer()?;
        usize::try_from(value)
            .ok()
            .filter(|&value| value < count as usize)
    }

    /// Returns an index clamped to its range as in naga: negative indices become the last one.
    pub(super) fn clamped_index(&mut self, index: ExprId, count: u32) -> Result<Value> {
        let at = self.at(index);
        let index = self.scalar(index)?;
        self.check(
            Fault::IndexOutOfBounds,
            at,
            Predicate::AtLeast(count),
            [index, NONE],
        );
        let last = self.word(count - 1);
        let clamped = self.binary(Operation::MinUint, index, last);
        Ok(self.substitute_undefined(clamped))
    }

    /// Returns the cells of a part, if they are contiguous and not indexed dynamically.
    pub(super) fn contiguous_cells(&self, target: &LValue) -> Option<Cells> {
        (target.swizzle.is_none() && target.index.is_none()).then(|| Cells {
            first: target.first,
            count: component_count(self.tree, target.ty) as u32,
        })
    }

    /// Returns the cells of a part, before the dynamic index is added.
    pub(super) fn cells_of(&self, target: &LValue) -> Vec<u32> {
        match &target.swizzle {
            Some(swizzle) => swizzle.iter().map(|&at| target.first + at).collect(),
            None => (target.first..)
                .take(component_count(self.tree, target.ty))
                .collect(),
        }
    }

    /// Loads the values of a part.
    pub(super) fn read(&mut self, target: &LValue) -> Vec<Value> {
        let cells = self.cells_of(target);
        self.check_written(target.ty, &cells, target.index);
        cells
            .into_iter()
            .map(|cell| match target.index {
                None => self.load(Cell(cell)),
                Some((index, cells)) => self.value(ValueDef::LoadAt {
                    cells,
                    offset: cell - cells.first,
                    index,
                    kind: self.cells[cell as usize],
                }),
            })
            .collect()
    }

    /// Stores values to a part.
    pub(super) fn write(&self, target: &LValue, values: &[Value]) {
        for (cell, &value) in self.cells_of(target).into_iter().zip(values) {
            self.mark_written(cell, target.index);
            self.push(match target.index {
                None => Node::Store {
                    cell: Cell(cell),
                    value,
                },
                Some((index, cells)) => Node::StoreAt {
                    cells,
                    offset: cell - cells.first,
                    index,
                    value,
                },
            });
        }
    }

    /// Returns the element that an index selects from values that are not in cells.
    pub(super) fn pick(&mut self, values: &[Value], ty: Type, index: ExprId) -> Result<Vec<Value>> {
        let (element, count) = indexed_element(self.tree, ty);
        let size = component_count(self.tree, element);
        if let Some(at) = self.constant_index(index, count) {
            return Ok(values[at * size..(at + 1) * size].to_vec());
        }
        let cells = self.allocate_type(ty)?;
        self.store_all(cells, values);
        let index = self.clamped_index(index, count)?;
        let mut target = LValue {
            ty,
            first: cells.first,
            swizzle: None,
            index: None,
        };
        self.index_at(&mut target, index);
        Ok(self.read(&target))
    }
}

// The component layout of types: columns, members and elements in order.

/// Returns the number of components of a type; 0 for `void` and samplers.
pub(super) fn component_count(tree: &Tree, ty: Type) -> usize {
    match ty {
        Type::Array(id) => {
            let array = tree.array(id);
            component_count(tree, array.element) * array.size as usize
        }
        Type::Struct(id) => tree[id]
            .members
            .iter()
            .map(|member| component_count(tree, member.ty))
            .sum(),
        _ => ty.component_count().map_or(0, usize::from),
    }
}

/// Returns the number of components before a member.
pub(super) fn member_offset(tree: &Tree, id: StructId, member: usize) -> usize {
    tree[id].members[..member]
        .iter()
        .map(|member| component_count(tree, member.ty))
        .sum()
}

/// Returns the type of the elements of a type, and their number.
pub(super) fn indexed_element(tree: &Tree, ty: Type) -> (Type, u32) {
    match ty {
        Type::Array(id) => (tree.array(id).element, tree.array(id).size),
        Type::Matrix { columns, rows } => (Type::vector(Scalar::Float, rows), u32::from(columns)),
        Type::Vector(scalar, size) => (Type::Scalar(scalar), u32::from(size)),
        _ => (ty, 1),
    }
}

pub(super) fn scalar_kind(scalar: Scalar) -> Kind {
    match scalar {
        Scalar::Float => Kind::Float,
        Scalar::Bool | Scalar::Int | Scalar::Uint => Kind::Word,
    }
}
