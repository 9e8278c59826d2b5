//! What is known on one way through a function: ranges of scalars, and conditions that held.
//!
//! `bool hit = false; … if (hit) use(n);` is no way to `use(n)` past the `hit = true` that stands beside `n = …`.

use toyproof_glsl::tree::{ExprId, VariableId};

use super::range::Range;

/// How many things of a kind are kept in mind at once.
const MAX_KNOWN: usize = 32;
/// How many things are kept in mind of which at least one holds.
const MAX_EITHER: usize = 4;

/// Names an expression among those written alike, in its [`Terms`](super::terms::Terms).
pub(super) type Term = u32;

/// What may hold or not. The order of floats is taken for total, as it is but for NaN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Fact {
    Less(Term, Term),
    Equal(Term, Term),
    /// A condition that is no comparison.
    Holds(Term),
    /// An expression that cannot be told to be alike another, when it was evaluated last.
    Once(ExprId),
}

/// A fact, and whether it holds.
pub(super) type Answer = (Fact, bool);

/// What is known now.
#[derive(Debug, Clone, Default)]
pub(super) struct Known {
    ranges: Vec<(VariableId, Range)>,
    facts: Vec<Answer>,
    /// Of each pair, at least one is so.
    either: Vec<[Answer; 2]>,
}

/// What makes two states of knowledge equal: variables with the bits of their ranges, facts, pairs of facts.
pub(super) type Key = (Vec<(VariableId, u64, u64)>, Vec<Answer>, Vec<[Answer; 2]>);

impl Known {
    pub(super) fn key(&self) -> Key {
        let mut ranges: Vec<_> = self
            .ranges
            .iter()
            .map(|(variable, range)| (*variable, range.least.to_bits(), range.most.to_bits()))
            .collect();
        ranges.sort_unstable();
        let (mut facts, mut either) = (self.facts.clone(), self.either.clone());
        facts.sort_unstable();
        either.sort_unstable();
        (ranges, facts, either)
    }

    pub(super) fn range(&self, variable: VariableId) -> Option<Range> {
        let mut ranges = self.ranges.iter();
        ranges
            .find(|(known, _)| *known == variable)
            .map(|(_, range)| *range)
    }

    pub(super) fn note(&mut self, variable: VariableId, range: Range) {
        self.widen(variable);
        if self.ranges.len() < MAX_KNOWN {
            self.ranges.push((variable, range));
        }
    }

    /// Forgets the variable's range.
    pub(super) fn widen(&mut self, variable: VariableId) {
        self.ranges.retain(|(known, _)| *known != variable);
    }

    /// What was evaluated in the last round is evaluated anew.
    pub(super) fn begin_round(&mut self) {
        let lasts = |(fact, _): &Answer| !matches!(fact, Fact::Once(_));
        self.facts.retain(lasts);
        self.either.retain(|pair| pair.iter().all(lasts));
    }

    /// Forgets the variable's range, and the facts about terms that `depends` says hang on it.
    pub(super) fn forget(&mut self, variable: VariableId, depends: impl Fn(Term) -> bool) {
        self.widen(variable);
        let hangs = |(fact, _): &Answer| match *fact {
            Fact::Less(a, b) | Fact::Equal(a, b) => depends(a) || depends(b),
            Fact::Holds(a) => depends(a),
            Fact::Once(_) => false,
        };
        self.facts.retain(|answer| !hangs(answer));
        self.either.retain(|pair| !pair.iter().any(&hangs));
    }

    /// Whether a fact holds, where that is known or follows.
    pub(super) fn answer(&self, fact: Fact) -> Option<bool> {
        match fact {
            Fact::Less(a, b) => self.less(a, b),
            _ => self.told(fact),
        }
    }

    /// Takes an answer for known, with what follows from it.
    pub(super) fn learn(&mut self, (fact, holds): Answer) {
        if self.facts.len() < MAX_KNOWN && self.told(fact).is_none() {
            self.facts.push((fact, holds));
            self.conclude();
        }
    }

    /// Takes for known that at least one of two answers is so.
    pub(super) fn learn_either(&mut self, pair: [Answer; 2]) {
        if self.either.len() < MAX_EITHER && !self.either.contains(&pair) {
            self.either.push(pair);
            self.conclude();
        }
    }

    fn told(&self, fact: Fact) -> Option<bool> {
        let mut facts = self.facts.iter();
        facts.find(|(known, _)| *known == fact).map(|(_, holds)| *holds)
    }

    /// Whether `a < b`, from what is known of the two, or of both and one other term.
    fn less(&self, a: Term, b: Term) -> Option<bool> {
        if let Some(holds) = self.told(Fact::Less(a, b)) {
            return Some(holds);
        }
        // Neither equal nor the other way round.
        let differ = [Fact::Equal(a, b), Fact::Equal(b, a)].map(|equal| self.told(equal) == Some(false));
        if differ.contains(&true) && self.told(Fact::Less(b, a)) == Some(false) {
            return Some(true);
        }
        // (x, y, strictly): x < y, or x <= y.
        let order = || {
            self.facts
                .iter()
                .filter_map(|&(fact, holds)| match (fact, holds) {
                    (Fact::Less(x, y), true) => Some((x, y, true)),
                    (Fact::Less(x, y), false) => Some((y, x, false)),
                    _ => None,
                })
        };
        for (x, y, strictly) in order() {
            if x == a && order().any(|(from, to, also)| from == y && to == b && (strictly || also)) {
                return Some(true);
            }
            if (x, y) == (b, a) || x == b && order().any(|(from, to, _)| from == y && to == a) {
                return Some(false);
            }
        }
        None
    }

    /// Finds which of two must hold.
    fn conclude(&mut self) {
        let found = self.either.iter().find_map(|&[one, other]| {
            let of = |(fact, holds): Answer| self.answer(fact).map(|answer| answer == holds);
            match (of(one), of(other)) {
                (Some(false), None) => return Some(other),
                (None, Some(false)) => return Some(one),
                (None, None) => {}
                _ => return None,
            }
            // `x < r` or `y < r`: the less of the two is. `x >= r` or `y >= r`: the greater is.
            let ((Fact::Less(x, r), holds), (Fact::Less(y, s), also)) = (one, other) else {
                return None;
            };
            let less = self.less(x, y).filter(|_| r == s && holds == also)?;
            Some(if less == holds { one } else { other })
        });
        if let Some(answer) = found.or_else(|| self.resolve()) {
            self.learn(answer);
        }
    }

    /// `a` or `b`, and `a` or not `b`: so `a`.
    fn resolve(&self) -> Option<Answer> {
        let opposite = |(a, holds): Answer, (b, also): Answer| a == b && holds != also;
        let of_two = |one: &[Answer; 2], other: &[Answer; 2]| {
            (0..2).find_map(|i| {
                let both = |j: usize| one[i] == other[j] && opposite(one[1 - i], other[1 - j]);
                (both(0) || both(1)).then_some(one[i])
            })
        };
        let mut pairs = self.either.iter().enumerate();
        pairs
            .find_map(|(index, one)| self.either[..index].iter().find_map(|other| of_two(one, other)))
            .filter(|(fact, _)| self.told(*fact).is_none())
    }
}
