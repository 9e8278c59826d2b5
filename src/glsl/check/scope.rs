//! Which name means what, where (§4.2).

use std::collections::HashMap;

use crate::token::Symbol;
use crate::tree::{FunctionId, StructId, VariableId};

/// What a name can mean. Types, variables and functions share their names (§4.2.2).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Entity {
    Variable(VariableId),
    Struct(StructId),
    /// All overloads.
    Functions(Vec<FunctionId>),
}

/// The scopes that are open, the innermost last; the outermost is the global one.
#[derive(Debug)]
pub(super) struct Scopes {
    /// The meanings of each name, with the depth of the scope that gave it; the innermost last.
    meanings: HashMap<Symbol, Vec<(usize, Entity)>>,
    /// The names that each scope declared.
    declared: Vec<Vec<Symbol>>,
}

impl Default for Scopes {
    fn default() -> Self {
        Self {
            meanings: HashMap::new(),
            declared: vec![Vec::new()],
        }
    }
}

impl Scopes {
    pub(super) fn open(&mut self) {
        self.declared.push(Vec::new());
    }

    pub(super) fn close(&mut self) {
        for name in self.declared.pop().unwrap_or_default() {
            if let Some(meanings) = self.meanings.get_mut(&name) {
                meanings.pop();
            }
        }
    }

    pub(super) fn is_global(&self) -> bool {
        self.declared.len() == 1
    }

    /// What the name means here.
    pub(super) fn find(&self, name: Symbol) -> Option<&Entity> {
        self.meanings.get(&name)?.last().map(|(_, entity)| entity)
    }

    /// Every name that means something here, in no order.
    pub(super) fn names(&self) -> impl Iterator<Item = (Symbol, &Entity)> {
        self.meanings
            .iter()
            .filter_map(|(&name, meanings)| Some((name, &meanings.last()?.1)))
    }

    /// What the innermost scope itself says of the name.
    pub(super) fn find_here(&self, name: Symbol) -> Option<&Entity> {
        let (depth, entity) = self.meanings.get(&name)?.last()?;
        (*depth == self.declared.len()).then_some(entity)
    }

    /// Gives the name its meaning in the innermost scope, in place of an older one there.
    pub(super) fn declare(&mut self, name: Symbol, entity: Entity) {
        let depth = self.declared.len();
        let meanings = self.meanings.entry(name).or_default();
        match meanings.last_mut() {
            Some((at, old)) if *at == depth => *old = entity,
            _ => {
                meanings.push((depth, entity));
                if let Some(scope) = self.declared.last_mut() {
                    scope.push(name);
                }
            }
        }
    }
}
