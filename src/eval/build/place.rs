//! Where an expression's value lies: variables and parts of them, with indices evaluated once.

use toyproof_glsl::tree::{BuiltInVariable, ExprId, ExprKind, Input, Type, VariableId, VariableKind};

use super::{Builder, Result, layout};
use crate::ir::function::{Cell, Cells, NONE, Node, Origin, Value};
use crate::ir::operation::{Kind, Operation};
use crate::observe::{Fault, Predicate};

/// Where a variable lives.
#[derive(Debug, Clone)]
pub(super) enum Home {
    /// In cells of its own.
    Cells(Cells),
    /// It never changes.
    Values(Vec<Value>),
    /// A sampler: the texture of a channel, or of none.
    Channel(Option<u8>),
}

/// A part of a variable.
#[derive(Debug, Clone)]
pub(super) struct Target {
    ty: Type,
    /// The first of its cells.
    first: u32,
    /// Which of the components from there on, where they do not follow each other.
    swizzle: Option<Vec<u32>>,
    /// What is added to each, and the cells that this may lead to.
    index: Option<(Value, Cells)>,
}

impl Builder<'_> {
    /// The home of a variable that is in scope.
    pub(super) fn home(&mut self, variable: VariableId) -> Home {
        if let Some(home) = self.homes.get(&variable) {
            return home.clone();
        }
        let ty = self.tree[variable].ty;
        let home = match self.tree[variable].kind {
            VariableKind::Input(Input::Channel(channel)) => Home::Channel(Some(channel)),
            VariableKind::Input(input) => {
                let components = 0..layout::size(self.tree, ty) as u8;
                Home::Values(
                    components
                        .map(|at| self.value(Origin::Input(input, at)))
                        .collect(),
                )
            }
            VariableKind::BuiltIn(BuiltInVariable::FragCoord) => Home::Values(self.frag_coord().to_vec()),
            VariableKind::BuiltIn(BuiltInVariable::FrontFacing) => Home::Values(vec![self.truth(true)]),
            VariableKind::BuiltInConstant => {
                let value = self.tree[variable].value.as_ref();
                let value = value
                    .and_then(toyproof_glsl::tree::Constant::integer)
                    .unwrap_or(0);
                Home::Values(vec![self.word(value as u32)])
            }
            _ if matches!(ty, Type::Sampler(_)) => Home::Channel(None),
            VariableKind::Uniform | VariableKind::Varying => Home::Values(self.zeros(ty)),
            // Written, like `gl_FragDepth`, or broken.
            _ => {
                let zeros = self.zeros(ty);
                match self.allocate_type(ty) {
                    Ok(cells) => {
                        self.store_all(cells, &zeros);
                        Home::Cells(cells)
                    }
                    Err(_) => Home::Values(zeros),
                }
            }
        };
        self.homes.insert(variable, home.clone());
        home
    }

    /// `gl_FragCoord`: the middle of the pixel, no depth, and no perspective.
    pub(super) fn frag_coord(&self) -> [Value; 4] {
        use crate::ir::function::Axis;
        [
            self.value(Origin::FragCoord(Axis::X)),
            self.value(Origin::FragCoord(Axis::Y)),
            self.float(0.0),
            self.float(1.0),
        ]
    }

    /// The part of a variable that an expression is; none if it is none, or not in cells. Evaluates its indices.
    pub(super) fn target(&mut self, expr: ExprId) -> Result<Option<Target>> {
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
        let Home::Cells(cells) = self.home(variable) else {
            return Ok(None);
        };
        let mut target = Target {
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

    /// Takes a part of a part.
    fn narrow(&mut self, target: &mut Target, step: ExprId) -> Result<()> {
        let ty = self.ty(step);
        match self.tree[step].kind {
            ExprKind::Member { member, .. } => {
                if let Type::Struct(id) = target.ty {
                    target.first += layout::offset(self.tree, id, member) as u32;
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
                let (element, count) = layout::element(self.tree, target.ty);
                if let Some(at) = self.constant_index(index, count) {
                    target.first += match target.swizzle.take() {
                        Some(swizzle) => swizzle[at],
                        None => (at * layout::size(self.tree, element)) as u32,
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

    fn index_at(&mut self, target: &mut Target, index: Value) {
        let (element, count) = layout::element(self.tree, target.ty);
        let size = layout::size(self.tree, element) as u32;
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
                    let here = self.binary(Operation::EqualWord, index, at);
                    chosen = self.select(here, offset, chosen, Kind::Word);
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

    /// The value of an index that is a constant expression, and in range.
    pub(super) fn constant_index(&self, index: ExprId, count: u32) -> Option<usize> {
        let value = self.tree.value(index)?.integer()?;
        usize::try_from(value)
            .ok()
            .filter(|&value| value < count as usize)
    }

    /// An index held to its range as naga does it: what is negative is large.
    pub(super) fn clamped_index(&mut self, index: ExprId, count: u32) -> Result<Value> {
        let at = self.at(index);
        let index = self.scalar(index)?;
        self.check(Fault::IndexOutOfBounds, at, Predicate::From(count), [index, NONE]);
        let last = self.word(count - 1);
        let held = self.binary(Operation::MinUint, index, last);
        Ok(self.settle(held))
    }

    /// The cells of a part, if they follow each other and no index leads to them.
    pub(super) fn row_of(&self, target: &Target) -> Option<Cells> {
        (target.swizzle.is_none() && target.index.is_none()).then(|| Cells {
            first: target.first,
            count: layout::size(self.tree, target.ty) as u32,
        })
    }

    /// The cells of a part, before an index is added.
    fn cells_of(&self, target: &Target) -> Vec<u32> {
        match &target.swizzle {
            Some(swizzle) => swizzle.iter().map(|&at| target.first + at).collect(),
            None => (target.first..)
                .take(layout::size(self.tree, target.ty))
                .collect(),
        }
    }

    /// The values of a part.
    pub(super) fn read(&mut self, target: &Target) -> Vec<Value> {
        let cells = self.cells_of(target);
        self.note_read(target.ty, &cells, target.index);
        cells
            .into_iter()
            .map(|cell| match target.index {
                None => self.load(Cell(cell)),
                Some((index, cells)) => self.value(Origin::LoadAt {
                    cells,
                    offset: cell - cells.first,
                    index,
                    kind: self.cells[cell as usize],
                }),
            })
            .collect()
    }

    /// Puts values into a part.
    pub(super) fn write(&self, target: &Target, values: &[Value]) {
        for (cell, &value) in self.cells_of(target).into_iter().zip(values) {
            self.note_written(cell, target.index);
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

    /// What an index selects of values that lie in no cells.
    pub(super) fn pick(&mut self, values: &[Value], ty: Type, index: ExprId) -> Result<Vec<Value>> {
        let (element, count) = layout::element(self.tree, ty);
        let size = layout::size(self.tree, element);
        if let Some(at) = self.constant_index(index, count) {
            return Ok(values[at * size..(at + 1) * size].to_vec());
        }
        let cells = self.allocate_type(ty)?;
        self.store_all(cells, values);
        let index = self.clamped_index(index, count)?;
        let mut target = Target {
            ty,
            first: cells.first,
            swizzle: None,
            index: None,
        };
        self.index_at(&mut target, index);
        Ok(self.read(&target))
    }
}
