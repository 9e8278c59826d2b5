//! Loops whose rounds are known are written out: what hangs on the number of a round alone is then computed once for a frame, and an
//! element that it names is a cell like any other.

use super::Forward;
use crate::ir::function::{Block, Node};

/// The most values that a loop and those in it may compute in each batch once they are written out.
const MAX_COMPUTED: usize = 1 << 11;

/// The most nodes that may be read in all attempts of a shader together, those that fail among them: what it may cost to find out.
const MAX_TRIED: usize = 1 << 16;

/// What attempts may still read and write.
#[derive(Debug)]
pub(super) struct Room {
    /// How many nodes may still be read in attempts, in all those of the shader.
    tried: usize,
    /// How many values the attempt that goes on may still compute; those inside share it.
    open: Option<usize>,
    /// How many scopes are around the outermost of which it was known who leaves it.
    decided: usize,
}

impl Default for Room {
    fn default() -> Self {
        Self {
            tried: MAX_TRIED,
            open: None,
            decided: usize::MAX,
        }
    }
}

impl Room {
    /// Takes room for a node that is read.
    pub(super) fn read(&mut self) {
        if self.open.is_some() {
            self.tried = self.tried.saturating_sub(1);
        }
    }

    /// Takes room for a value.
    pub(super) fn compute(&mut self) {
        if let Some(open) = &mut self.open {
            *open = open.saturating_sub(1);
        }
    }

    /// Whether there is none left.
    pub(super) fn is_full(&self) -> bool {
        self.open.is_some_and(|open| open.min(self.tried) == 0)
    }

    /// Notes that it is known who leaves a scope that has so many around it.
    pub(super) fn decide(&mut self, depth: usize) {
        self.decided = self.decided.min(depth);
    }
}

/// Where an attempt began.
struct Start {
    values: usize,
    scopes: u32,
    known: usize,
    computed: usize,
    words: usize,
    /// How many ways led out of each open scope.
    ways: Vec<usize>,
}

impl Forward<'_> {
    /// The rounds of a loop one after the other, if each knows whether another follows.
    pub(super) fn unrolled(&mut self, body: &[Node]) -> Option<Block> {
        // To begin costs something, too.
        self.room.tried = self.room.tried.checked_sub(1)?;
        let outermost = self.room.open.is_none();
        if outermost {
            self.room.open = Some(MAX_COMPUTED);
        }
        let around = self.room.decided;
        let start = self.start();
        let mut out = Block::new();
        loop {
            self.room.decided = usize::MAX;
            self.nodes(body, &mut out);
            if !self.live || self.room.is_full() || self.room.decided >= start.ways.len() {
                break;
            }
        }
        let done = !self.live && !self.room.is_full();
        if outermost {
            self.room.open = None;
        }
        self.room.decide(around);
        if !done {
            self.back_to(&start);
        }
        done.then_some(out)
    }

    fn start(&self) -> Start {
        Start {
            values: self.flow.origins.len(),
            scopes: self.flow.scopes,
            known: self.known.mark(),
            computed: self.computed.mark(),
            words: self.words.mark(),
            ways: self.exits.iter().map(|exit| exit.ways.len()).collect(),
        }
    }

    /// Goes back to where an attempt began. The epochs stay: they only grow, and what was computed in one that is over is not asked for
    /// again. What stands for values of the body stays: each is computed again before it is used, and [`Self::repeat`] clears it first. What
    /// was kept of ways is not given back: it took its time.
    fn back_to(&mut self, start: &Start) {
        self.live = true;
        self.known.back_to(start.known);
        self.computed.back_to(start.computed);
        for (exit, &ways) in self.exits.iter_mut().zip(&start.ways) {
            exit.ways.truncate(ways);
        }
        self.words.back_to(start.words);
        self.flow.origins.truncate(start.values);
        self.constant.truncate(start.values);
        self.flow.scopes = start.scopes;
    }
}
