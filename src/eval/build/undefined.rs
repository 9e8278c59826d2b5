//! What GLSL leaves open: noted where it happens, or chosen otherwise than usual.

use toyproof_glsl::tree::Place;

use super::{Builder, Choice};
use crate::ir::function::{Node, Origin, Value};
use crate::ir::operation::{Kind, Operation};
use crate::observe::{Fault, Predicate, Site, SiteId};
use crate::render::Other;

/// The number that stands where the usual choice is not taken: in range of every index, and hardly ever what an operation gives by itself.
const OTHER_NUMBER: f64 = 0.5;

impl Builder<'_> {
    /// Notes pixels for which a predicate holds. What comes of it, if it is undefined, must be given to [`Builder::settle`].
    pub(super) fn check(&mut self, fault: Fault, at: Place, predicate: Predicate, values: [Value; 2]) {
        match self.extras.choice {
            Choice::Noted => {
                let site = Site { fault, at };
                let next = SiteId(self.sites.len() as u32);
                let id = *self.site_ids.entry(site).or_insert(next);
                if id == next {
                    self.sites.push(site);
                }
                self.push(Node::Check {
                    predicate,
                    values,
                    site: id,
                });
            }
            Choice::Other(_) if fault.is_undefined() => self.open.push((predicate, values)),
            Choice::Other(_) | Choice::Usual => {}
        }
    }

    /// The value of an operation that was checked: another one where GLSL leaves it open, if so chosen.
    pub(super) fn settle(&mut self, value: Value) -> Value {
        let [settled] = self.settle_all([value]);
        settled
    }

    /// The same of an operation that has several values.
    pub(super) fn settle_all<const N: usize>(&mut self, values: [Value; N]) -> [Value; N] {
        let other = match self.extras.choice {
            Choice::Other(Other::NotANumber) => f64::NAN,
            _ => OTHER_NUMBER,
        };
        let open = std::mem::take(&mut self.open);
        let held = open
            .into_iter()
            .filter_map(|(predicate, values)| self.holds(predicate, values));
        let Some(any) = held.reduce(|a, b| self.binary(Operation::Or, a, b)) else {
            return values;
        };
        values.map(|value| {
            let (kind, other) = match self.kind(value) {
                Kind::Float => (Kind::Float, self.float(other)),
                Kind::Word => (Kind::Word, self.word(0)),
            };
            self.select(any, other, value, kind)
        })
    }

    /// Whether a predicate of what is undefined holds, as a word; none of those that no value tells.
    fn holds(&self, predicate: Predicate, [a, b]: [Value; 2]) -> Option<Value> {
        use Operation as O;
        let outside = |low: f64, high: f64| {
            let (low, high) = (self.float(low), self.float(high));
            let above = self.binary(O::Less, low, a);
            let below = self.binary(O::Less, a, high);
            let inside = self.binary(O::And, above, below);
            self.unary(O::Not, inside)
        };
        Some(match predicate {
            Predicate::From(limit) => {
                let below = self.binary(O::LessUint, a, self.word(limit));
                self.unary(O::Not, below)
            }
            Predicate::Zero => self.binary(O::EqualWord, a, self.word(0)),
            Predicate::NoInt => outside(-2_147_483_649.0, 2_147_483_648.0),
            Predicate::NoUint => outside(-1.0, 4_294_967_296.0),
            Predicate::Unordered => {
                let [a, b] = [a, b].map(|value| self.unary(O::IsNan, value));
                self.binary(O::Or, a, b)
            }
            Predicate::Equal => self.binary(O::Equal, a, b),
            Predicate::Greater => self.binary(O::Less, b, a),
            Predicate::NoPower => {
                let zero = self.float(0.0);
                let negative = self.binary(O::Less, a, zero);
                let is_zero = self.binary(O::Equal, a, zero);
                let not_positive = self.binary(O::LessEqual, b, zero);
                let both = self.binary(O::And, is_zero, not_positive);
                self.binary(O::Or, negative, both)
            }
            Predicate::ConstantZeros => {
                let zero = self.float(0.0);
                let [a, b] = [a, b].map(|value| self.binary(O::Equal, value, zero));
                self.binary(O::And, a, b)
            }
            Predicate::Lonely
            | Predicate::Negative
            | Predicate::NotPositive
            | Predicate::BeyondOne
            | Predicate::FromOne
            | Predicate::BelowOne
            | Predicate::BothZero => return None,
        })
    }

    fn kind(&self, value: Value) -> Kind {
        match self.draft.borrow().origins[value.0 as usize] {
            Origin::Operation(operation, _) => operation.kind(),
            Origin::Load(cell) => self.cells[cell.0 as usize],
            Origin::LoadAt { kind, .. } => kind,
            Origin::Word(_) => Kind::Word,
            _ => Kind::Float,
        }
    }
}
