//! Statements that move, and values that are kept before they are overwritten.

use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{ExprKind, walk};

use super::super::super::edit::{EditKind, shortened};
use super::super::super::shader::Shape;
use super::super::writer::is_float;
use super::{MAX_PLACES, Writer, deletion, insertion, replacement};

/// The costs: a move into or out of a block, within a block, and a copy of an old value.
const MOVE: u32 = 16;
const FAR_MOVE: u32 = 22;
const OLD_VALUE: u32 = 20;

/// The largest number of statements that move together.
const MAX_RUN: usize = 4;

impl Writer<'_> {
    /// Moves a statement out of the blocks that contain it, into a neighbouring one, or within its own.
    pub(super) fn moves(&mut self, at: usize) {
        if !self.is_simple(at) {
            self.runs(at);
            return;
        }
        let outer: Vec<usize> = self.outline.enclosing(at).take(2).collect();
        let siblings = self.siblings(at);
        let own = siblings.iter().position(|&other| other == at);
        let mut places: Vec<(usize, bool, u32)> = Vec::new();
        for &outer in &outer {
            places.extend([(outer, true, MOVE), (outer, false, MOVE)]);
        }
        if let Some(own) = own {
            let is_block =
                |at: usize| matches!(self.shader.statements[at].kind, Shape::If { .. } | Shape::Loop);
            let neighbours = [own.checked_sub(1), own.checked_add(1)].into_iter().flatten();
            let blocks = neighbours
                .filter_map(|at| siblings.get(at))
                .filter(|&&at| is_block(at));
            for &block in blocks {
                let children = self.outline.children(block);
                places.extend(children.first().map(|&first| (first, true, MOVE)));
                places.extend(children.iter().map(|&child| (child, false, MOVE)));
            }
            // Exchanging two neighbours is an edit of the tree.
            let others = siblings.iter().enumerate();
            let far =
                others.filter(|&(other, _)| other.abs_diff(own) > 1 && other.abs_diff(own) <= MAX_PLACES);
            places.extend(far.map(|(other, &place)| (place, other < own, FAR_MOVE)));
        }
        let pair = own.and_then(|own| self.declaration_with_use(at, siblings.get(own + 1).copied()?));
        for (place, is_before, cost) in places {
            if let Some(own) = self.outline.extents[at] {
                self.move_to(at, own, place, is_before, cost);
            }
            if let Some(pair) = pair
                && siblings.contains(&place)
            {
                self.move_to(at, pair, place, is_before, FAR_MOVE);
            }
        }
    }

    /// The text of a declaration and of the statement behind it, which uses the variable.
    fn declaration_with_use(&self, at: usize, next: usize) -> Option<Span> {
        let Shape::Declaration(variable) = self.shader.statements[at].kind else {
            return None;
        };
        let Shape::Expression(expr) = self.shader.statements[next].kind else {
            return None;
        };
        let is_used = walk::mentions(self.shader.tree, expr, variable);
        self.extents([at, next]).filter(|_| is_used)
    }

    /// Moves the statements at the start of a block out of it, and those in front of it to its start.
    fn runs(&mut self, block: usize) {
        let kind = &self.shader.statements[block].kind;
        if !matches!(kind, Shape::If { .. } | Shape::Loop) || self.outline.extents[block].is_none() {
            return;
        }
        let is_simple = |&&at: &&usize| self.is_simple(at);
        let inside = self.outline.children(block);
        let first: Vec<usize> = inside.iter().take_while(is_simple).copied().collect();
        let siblings = self.siblings(block);
        let before = siblings.iter().rev().skip_while(|&&at| at >= block);
        let before: Vec<usize> = before.take_while(is_simple).copied().collect();
        for count in 2..=MAX_RUN {
            if let Some(&last) = first.get(count - 1)
                && let Some(own) = self.extents([first[0], last])
            {
                self.move_to(first[0], own, block, true, MOVE);
            }
            if let (Some(&start), Some(&place)) = (before.get(count - 1), inside.first())
                && let Some(own) = self.extents([start, before[0]])
            {
                self.move_to(start, own, place, true, MOVE);
            }
        }
    }

    /// The text from one statement to another of the same block.
    fn extents(&self, [first, last]: [usize; 2]) -> Option<Span> {
        let [first, last] = [first, last].map(|at| self.outline.extents[at]);
        Some(Span::new(first?.file, first?.start, last?.end))
    }

    /// Moves a text that starts with a statement.
    fn move_to(&mut self, at: usize, own: Span, place: usize, is_before: bool, cost: u32) {
        let Some(other) = self.outline.extents[place] else {
            return;
        };
        let text = self.shader.text(own);
        let (position, inserted) = if is_before {
            (other.start, format!("{text} "))
        } else {
            (other.end, format!(" {text}"))
        };
        let side = if is_before { "before" } else { "after" };
        let message = format!(
            "move `{}` {side} `{}`",
            shortened(text),
            shortened(self.text(place))
        );
        let edits = vec![deletion(own), insertion(own, position, inserted)];
        self.add(at, EditKind::MisplacedStatement, cost, message, edits);
    }

    /// Keeps the value that a variable has before a statement for the one after it.
    pub(super) fn old_value(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let (Shape::Expression(expr), Some(extent)) = (&shader.statements[at].kind, self.outline.extents[at])
        else {
            return;
        };
        let ExprKind::Assign { target, .. } = tree[*expr].kind else {
            return;
        };
        let (place, ty) = (tree[target].at, tree[target].ty);
        let Some(next) = shader.statements[at]
            .next
            .filter(|_| !place.is_expanded() && is_float(ty))
        else {
            return;
        };
        let target = shader.text(place.span);
        let uses = shader.sites.iter().filter(|site| {
            site.statement == next && site.exprs.len() == 1 && shader.text(site.span) == target
        });
        let uses: Vec<Span> = uses.map(|site| site.span).collect();
        if uses.is_empty() {
            return;
        }
        let Some(name) = ["old", "before", "previous"]
            .into_iter()
            .find(|name| !shader.source.contains(name))
        else {
            return;
        };
        let declaration = format!("{} {name} = {target};", tree.type_name(ty));
        let message = format!(
            "insert `{declaration}` before `{}`, and use `{name}` in `{}`",
            shortened(self.text(at)),
            shortened(shader.text(shader.statements[next].span))
        );
        let mut edits = vec![insertion(extent, extent.start, format!("{declaration} "))];
        edits.extend(uses.into_iter().map(|span| replacement(span, name)));
        self.add(at, EditKind::MissingStatement, OLD_VALUE, message, edits);
    }
}
