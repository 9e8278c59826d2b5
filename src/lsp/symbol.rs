//! The entities that names denote, across all texts: a function of Common has another id in each tab.

use std::collections::{BTreeMap, HashSet};

use toyproof_diagnostic::{Place, Span};
use toyproof_glsl::Resolution;
use toyproof_glsl::tree::{Direction, ExprKind, Tree, VariableKind};

use crate::snapshot::Snapshot;
use crate::unit::Unit;
use crate::workspace::Workspace;

/// An entity that is the same in all texts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Symbol {
    /// What the name at this place declares.
    Declared(FilePlace),
    /// What the host or the language declares, by its name.
    Given(String),
}

/// A place in a file of the user.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct FilePlace {
    pub(crate) uri: String,
    /// The first byte.
    pub(crate) start: u32,
    /// One past the last byte.
    pub(crate) end: u32,
}

/// What happens to an entity where its name stands.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Access {
    /// Whether the name is declared here.
    pub(crate) declares: bool,
    /// Whether a variable or a part of it is changed here.
    pub(crate) writes: bool,
}

impl FilePlace {
    /// The place of a span in the files of the user; `None` for text that is in no file.
    pub(crate) fn of(unit: &Unit, span: Span) -> Option<Self> {
        let Span { file, start, end } = unit.files.origin(span);
        let uri = unit.uris.get(&file)?.0.clone();
        Some(Self { uri, start, end })
    }
}

impl Symbol {
    /// The entity that a name of a text denotes; `None` for what text declares that is in no file.
    pub(crate) fn of(unit: &Unit, tree: &Tree, resolution: Resolution) -> Option<Self> {
        match origin(tree, resolution) {
            Origin::Declared(at) => FilePlace::of(unit, at.spelling).map(Self::Declared),
            Origin::Given(name) => Some(Self::Given(name.to_owned())),
        }
    }

    /// Whether a name of a text denotes the entity.
    fn is_denoted(&self, unit: &Unit, tree: &Tree, resolution: Resolution) -> bool {
        match (self, origin(tree, resolution)) {
            (Self::Declared(place), Origin::Declared(at)) => {
                let found = unit.files.origin(at.spelling);
                let is_there = || unit.uris.get(&found.file).is_some_and(|uri| uri.0 == place.uri);
                (found.start, found.end) == (place.start, place.end) && is_there()
            }
            (Self::Given(name), Origin::Given(other)) => name == other,
            _ => false,
        }
    }

    /// The entity at a byte of the analyzed text, and the span of the name that denotes it there.
    pub(crate) fn at(snapshot: &Snapshot, at: u32) -> Option<(Self, Span)> {
        let name = snapshot.name_at(at)?;
        let symbol = Self::of(&snapshot.unit, snapshot.tree(), name.resolution)?;
        Some((symbol, name.at.spelling))
    }

    /// Where its name stands in all open shaders, and in the files that belong to them.
    pub(crate) fn occurrences(&self, workspace: &mut Workspace) -> BTreeMap<FilePlace, Access> {
        let mut found: BTreeMap<FilePlace, Access> = BTreeMap::new();
        for unit in workspace.units() {
            for text in &unit.texts {
                let tree = text.analysis.tree();
                let mut written = None;
                for name in &text.analysis.names {
                    if !self.is_denoted(&unit, tree, name.resolution) {
                        continue;
                    }
                    let Some(place) = FilePlace::of(&unit, name.at.spelling) else {
                        continue;
                    };
                    // A name in Common is found in each tab.
                    let access = found.entry(place).or_default();
                    let written = written.get_or_insert_with(|| written_places(tree));
                    access.declares |= name.declares;
                    access.writes |= name.declares || written.contains(&name.at);
                }
            }
        }
        found
    }
}

/// Where an entity comes from.
enum Origin<'t> {
    /// The name at this place declares it.
    Declared(Place),
    /// The host or the language has it.
    Given(&'t str),
}

fn origin(tree: &Tree, resolution: Resolution) -> Origin<'_> {
    match resolution {
        Resolution::Variable(id) => match tree[id].at {
            Some(at) => Origin::Declared(at),
            None => Origin::Given(&tree[id].name),
        },
        Resolution::Struct(id) => Origin::Declared(tree[id].at),
        Resolution::Member(id, member) => Origin::Declared(tree[id].members[member].at),
        Resolution::Function(id) => Origin::Declared(tree[id].at),
        Resolution::BuiltIn(function) => Origin::Given(function.name()),
    }
}

/// The places of the variables that expressions change, or parts of which they change: the `a` of `a.x += 1.`
/// and of a call that passes `a` to an `out` parameter.
fn written_places(tree: &Tree) -> HashSet<Place> {
    let mut targets = Vec::new();
    for (_, expr) in tree.exprs.iter() {
        match &expr.kind {
            ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => targets.push(*target),
            ExprKind::Call { function, arguments } => {
                let parameters = tree[*function].parameters.iter().zip(arguments);
                let out = parameters.filter(|&(&parameter, _)| {
                    let kind = tree[parameter].kind;
                    matches!(kind, VariableKind::Parameter(Direction::Out | Direction::InOut))
                });
                targets.extend(out.map(|(_, &argument)| argument));
            }
            _ => {}
        }
    }
    let roots = targets.into_iter().filter_map(|target| tree.path(target).last());
    roots.map(|root| tree[root].at).collect()
}
