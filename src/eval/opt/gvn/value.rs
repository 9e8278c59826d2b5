//! Values as they are written: none twice, and words that are known folded.

use super::Forward;
use crate::ir::function::{Cell, NONE, Origin, Value};
use crate::ir::operation::Operation;
use crate::ops::fold;

impl Forward<'_> {
    /// Takes over what is not computed.
    pub(super) fn take_over(&mut self) {
        for at in 0..self.templates.len() {
            let origin = self.templates[at];
            match origin {
                Origin::Word(word) => self.alias[at] = self.word(word),
                Origin::Float(_) | Origin::Input(..) | Origin::FragCoord(_) => {
                    self.alias[at] = self.make(origin);
                }
                Origin::Operation(..) | Origin::Load(_) | Origin::LoadAt { .. } | Origin::Texel { .. } => {}
            }
        }
    }

    fn make(&mut self, origin: Origin) -> Value {
        let mut constant = !matches!(
            origin,
            Origin::FragCoord(_) | Origin::Load(_) | Origin::LoadAt { .. } | Origin::Texel { .. }
        );
        origin.for_each_operand(|operand| constant &= self.constant[operand.0 as usize]);
        if !constant {
            self.room.compute();
        }
        self.constant.push(constant);
        self.flow.origins.push(origin);
        Value(self.flow.origins.len() as u32 - 1)
    }

    /// What stands for a value of the picture; a load that is never run, if no pixel comes to the end.
    pub(super) fn output(&mut self, template: Value) -> Value {
        match self.alias[template.0 as usize] {
            NONE => self.make(self.templates[template.0 as usize]),
            value => value,
        }
    }

    fn word(&mut self, word: u32) -> Value {
        if let Some(value) = self.words.get(word) {
            return value;
        }
        let value = self.make(Origin::Word(word));
        self.words.set(word, Some(value));
        value
    }

    /// What a value is known to be.
    pub(super) fn known_word(&self, value: Value) -> Option<u32> {
        match self.flow.origin(value) {
            Origin::Word(word) => Some(word),
            _ => None,
        }
    }

    /// Makes a value; if it must be computed here, tells it.
    pub(super) fn compute(&mut self, template: Value) -> Option<Value> {
        let at = template.0 as usize;
        let alias = &self.alias;
        let origin = self.templates[at].map_operands(|operand| alias[operand.0 as usize]);
        let origin = match origin {
            Origin::LoadAt {
                cells, offset, index, ..
            } => {
                let index = self.known_word(index);
                index.map_or(origin, |index| Origin::Load(cells.held(offset, index)))
            }
            _ => origin,
        };
        let key = (origin, self.epoch(origin));
        let found = match origin {
            Origin::Word(_) | Origin::Float(_) | Origin::Input(..) | Origin::FragCoord(_) => {
                Some(self.alias[at])
            }
            Origin::Load(cell) => self.known.get(cell),
            Origin::Operation(operation, operands) => self.folded(operation, operands),
            _ => None,
        };
        let found = found.or_else(|| self.computed.get(key).filter(|_| !self.story));
        if let Some(found) = found {
            self.alias[at] = found;
            return None;
        }
        let value = self.make(origin);
        self.alias[at] = value;
        match origin {
            Origin::Load(cell) => self.know(cell, value),
            _ => self.computed.set(key, Some(value)),
        }
        Some(value)
    }

    /// The value of an operation on words that are known, or one of those that a known word chooses from.
    fn folded(&mut self, operation: Operation, operands: [Value; 3]) -> Option<Value> {
        let words = operands.map(|value| {
            if value == NONE {
                Some(0)
            } else {
                self.known_word(value)
            }
        });
        match (operation, words) {
            (Operation::Select | Operation::SelectWord, [Some(word), ..]) => {
                Some(operands[if word == 0 { 2 } else { 1 }])
            }
            (_, [Some(a), Some(b), Some(c)]) => fold(operation, [a, b, c]).map(|word| self.word(word)),
            _ => None,
        }
    }

    fn epoch(&self, origin: Origin) -> u32 {
        let Origin::LoadAt { cells, .. } = origin else {
            return 0;
        };
        let group = self.groups.find(Cell(cells.first));
        group.map_or(0, |group| self.epochs[group])
    }
}
