//! Fingerprints of a shader's structure, without names, numbers, layout and the order of its functions:
//! winnowing (Schleimer, Wilkerson and Aiken, *Winnowing: Local Algorithms for Document Fingerprinting*,
//! 2003) over the typed tree of each function.

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};

use toyproof_diagnostic::{Files, Span};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    BinaryOp, ExprId, ExprKind, Statement, StatementKind, Tree, VariableId, VariableKind, walk,
};

use super::tokens::tokens;

/// The number of nodes that a fingerprint covers: fewer match by chance.
const NODES: usize = 14;

/// The number of tokens that a fingerprint covers: about as much of a text.
const TOKENS: usize = 24;

/// One of this many consecutive fingerprints is kept: equal parts of `NODES + WINDOW - 1` nodes share one.
const WINDOW: usize = 6;

/// The kept fingerprints of a shader, each with the first and the last line that it covers.
#[derive(Debug, Default)]
pub struct Fingerprints(HashMap<u64, [usize; 2]>);

/// A node of a tree: its kind and its place.
struct Node {
    kind: u64,
    span: Span,
}

impl Fingerprints {
    /// The fingerprints of a shader's functions.
    #[must_use]
    pub fn from_tree(checked: &Checked, files: &Files) -> Self {
        let mut kept = HashMap::new();
        for (_, function) in checked.tree.functions.iter() {
            let mut list = NodeList {
                tree: &checked.tree,
                nodes: Vec::new(),
            };
            list.block(function.body.as_deref().unwrap_or_default());
            let kinds: Vec<u64> = list.nodes.iter().map(|node| node.kind).collect();
            select(&mut kept, &kinds, NODES, |at| {
                files.position(list.nodes[at].span).line
            });
        }
        Self(kept)
    }

    /// The fingerprints of a text's tokens, which exist even for a shader that does not compile. They are
    /// comparable with each other only.
    #[must_use]
    pub fn from_text(text: &str) -> Self {
        let tokens = tokens(text);
        let kinds: Vec<u64> = tokens.iter().map(|&(kind, _)| kind).collect();
        let mut kept = HashMap::new();
        select(&mut kept, &kinds, TOKENS, |at| tokens[at].1);
        Self(kept)
    }

    /// The number of fingerprints.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The hashes of the fingerprints, in no particular order.
    pub fn hashes(&self) -> impl Iterator<Item = u64> {
        self.0.keys().copied()
    }

    /// Removes fingerprints.
    pub fn remove(&mut self, others: &HashSet<u64>) {
        self.0.retain(|hash, _| !others.contains(hash));
    }

    /// The number of fingerprints that two shaders share.
    #[must_use]
    pub fn shared(&self, other: &Self) -> usize {
        self.hashes().filter(|hash| other.0.contains_key(hash)).count()
    }

    /// The ranges of lines that another shader has too.
    #[must_use]
    pub fn shared_lines(&self, other: &Self) -> Vec<[usize; 2]> {
        let shared = self.0.iter().filter(|(hash, _)| other.0.contains_key(hash));
        let mut ranges: Vec<[usize; 2]> = shared.map(|(_, &lines)| lines).collect();
        ranges.sort_unstable();
        ranges.dedup_by(|next, range| {
            let touches = next[0] <= range[1] + 1;
            if touches {
                range[1] = range[1].max(next[1]);
            }
            touches
        });
        ranges
    }
}

/// Adds the selected fingerprints of a sequence of kinds, each of which covers `covered` consecutive kinds;
/// `line` returns the line of a kind.
fn select(kept: &mut HashMap<u64, [usize; 2]>, kinds: &[u64], covered: usize, line: impl Fn(usize) -> usize) {
    let grams: Vec<u64> = kinds.windows(covered).map(|kinds| hash(&kinds)).collect();
    for at in winnow(&grams) {
        let lines = (at..at + covered).map(&line);
        let first = lines.clone().min().unwrap_or_default();
        let last = lines.max().unwrap_or_default();
        kept.insert(grams[at], [first, last]);
    }
}

fn hash(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

/// The places of the smallest hash of each window, the last of equal ones; the only window of a short text is
/// smaller.
fn winnow(hashes: &[u64]) -> Vec<usize> {
    let mut places = Vec::new();
    let window = WINDOW.min(hashes.len()).max(1);
    for (start, hashes) in hashes.windows(window).enumerate() {
        let smallest = hashes.iter().enumerate().rev().min_by_key(|&(_, hash)| hash);
        let place = start + smallest.map_or(0, |(at, _)| at);
        if places.last() != Some(&place) {
            places.push(place);
        }
    }
    places
}

/// The kind of an expression or a statement, without names and numbers. `T` is what else counts of a node,
/// such as its operator; `()` for nothing.
#[derive(Hash)]
enum Kind<T> {
    /// A number, also if it has a name, or any variable.
    Value,
    Assign(T),
    Unary(T),
    Binary(T),
    Step,
    Conditional,
    Call,
    BuiltIn(T),
    Construct(T),
    Swizzle(T),
    Member,
    Index,
    Input(T),
    If,
    Switch,
    Loop,
    Jump(T),
}

/// The nodes of a function's tree, in the order of evaluation.
struct NodeList<'a> {
    tree: &'a Tree,
    nodes: Vec<Node>,
}

impl NodeList<'_> {
    fn add<T: Hash>(&mut self, kind: &Kind<T>, span: Span) {
        self.nodes.push(Node {
            kind: hash(kind),
            span,
        });
    }

    fn block(&mut self, block: &[Statement]) {
        for statement in block {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        let span = statement.at.span;
        match &statement.kind {
            StatementKind::If { arms, otherwise } => {
                for arm in arms {
                    self.add(&Kind::<()>::If, span);
                    self.expression(arm.condition);
                    self.block(&arm.body);
                }
                self.block(otherwise.as_deref().unwrap_or_default());
            }
            StatementKind::For { init, step, body, .. } => {
                self.block(init);
                self.add(&Kind::<()>::Loop, span);
                let mut own = walk::own_expressions(self.tree, statement);
                own.retain(|expression| Some(*expression) != *step);
                for condition in own {
                    self.expression(condition);
                }
                self.block(body);
                if let Some(step) = step {
                    self.expression(*step);
                }
            }
            StatementKind::DoWhile { condition, body } => {
                self.add(&Kind::<()>::Loop, span);
                self.block(body);
                self.expression(*condition);
            }
            StatementKind::Declare(variable) => self.declare(*variable, span),
            kind => {
                match kind {
                    StatementKind::While { .. } => self.add(&Kind::<()>::Loop, span),
                    StatementKind::Switch { .. } => self.add(&Kind::<()>::Switch, span),
                    StatementKind::Break
                    | StatementKind::Continue
                    | StatementKind::Return(_)
                    | StatementKind::Discard => {
                        self.add(&Kind::Jump(std::mem::discriminant(kind)), span);
                    }
                    _ => {}
                }
                for expression in walk::own_expressions(self.tree, statement) {
                    self.expression(expression);
                }
                for block in walk::child_blocks(statement) {
                    self.block(block);
                }
            }
        }
    }

    /// A declaration with a value is an assignment; one without is nothing, and so is a constant with a
    /// number.
    fn declare(&mut self, variable: VariableId, span: Span) {
        let declared = &self.tree[variable];
        let is_number = |value: ExprId| matches!(self.tree[value].kind, ExprKind::Literal(_));
        if let Some(value) = declared.initializer
            && !(declared.kind == VariableKind::Const && is_number(value))
        {
            // Hashes like the missing operator of `p = x`.
            self.add(&Kind::Assign(None::<BinaryOp>), span);
            self.add(&Kind::<()>::Value, span);
            self.expression(value);
        }
    }

    /// Adds an expression and its operands, with an explicit stack: chains of operators are long.
    fn expression(&mut self, root: ExprId) {
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            let expression = &self.tree[id];
            let span = expression.at.span;
            match &expression.kind {
                ExprKind::Variable(variable) => match self.tree[*variable].kind {
                    VariableKind::Input(input) => self.add(&Kind::Input(input), span),
                    _ => self.add(&Kind::<()>::Value, span),
                },
                ExprKind::Literal(_) => self.add(&Kind::<()>::Value, span),
                ExprKind::Unary { op, operand } => {
                    // The sign of a number is part of the number.
                    if !matches!(self.tree[*operand].kind, ExprKind::Literal(_)) {
                        self.add(&Kind::Unary(op), span);
                    }
                }
                ExprKind::Binary { op, .. } => self.add(&Kind::Binary(op), span),
                ExprKind::Assign { op, .. } => self.add(&Kind::Assign(op), span),
                ExprKind::Step { .. } => self.add(&Kind::<()>::Step, span),
                ExprKind::Conditional { .. } => self.add(&Kind::<()>::Conditional, span),
                ExprKind::Call { .. } => self.add(&Kind::<()>::Call, span),
                ExprKind::BuiltIn { function, .. } => self.add(&Kind::BuiltIn(function), span),
                ExprKind::Construct { constructor, .. } => self.add(&Kind::Construct(constructor), span),
                ExprKind::Swizzle { components, .. } => self.add(&Kind::Swizzle(components), span),
                ExprKind::Member { .. } => self.add(&Kind::<()>::Member, span),
                ExprKind::Index { .. } | ExprKind::Length { .. } => self.add(&Kind::<()>::Index, span),
                ExprKind::Sequence { .. } => {}
            }
            let from = pending.len();
            expression.kind.for_each_operand(|operand| pending.push(operand));
            pending[from..].reverse();
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::File;
    use toyproof_glsl as glsl;

    use super::*;

    const ORIGINAL: &str = "
        float march(vec3 o, vec3 d) {
            float t = 0.0;
            for (int i = 0; i < 99; i++) {
                vec3 p = o + t * d;
                float h = min(length(p.xz) - 1.5, p.y + abs(sin(4.0 * p.x)));
                if (h < 0.001) break;
                t += h;
            }
            return t;
        }
        void mainImage(out vec4 color, in vec2 at) {
            vec2 s = (2.0 * at - iResolution.xy) / iResolution.y;
            float t = march(vec3(0, 1, -4), normalize(vec3(s, 1.5)));
            color = vec4(vec3(1.0 / (1.0 + t * t * 0.1)), 1.0);
        }";

    fn fingerprints(text: &str) -> Fingerprints {
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        Fingerprints::from_tree(
            &glsl::check(&files, file, &glsl::Options::default()).unwrap(),
            &files,
        )
    }

    #[test]
    fn names_numbers_layout_and_order_do_not_matter() {
        let original = fingerprints(ORIGINAL);
        assert!(original.count() > 10, "{}", original.count());
        let (march, main) = ORIGINAL.split_once("void mainImage").unwrap();
        let reordered = format!("float march(vec3 o, vec3 d);\nvoid mainImage{main}\n{march}");
        let renamed = ORIGINAL
            .replace("march", "go")
            .replace("vec3 p ", "vec3 point ")
            .replace("p.", "point.");
        let renumbered = ORIGINAL
            .replace("1.5", "2.25")
            .replace("99", "64")
            .replace("-4", "7");
        let flat = ORIGINAL.split_whitespace().collect::<Vec<_>>().join(" ");
        for copy in [reordered, renamed, renumbered, flat] {
            let copy = fingerprints(&copy);
            assert_eq!(
                (original.shared(&copy), copy.count()),
                (original.count(), original.count())
            );
        }
        let named = format!("const float STEP = 0.001;\n{}", ORIGINAL.replace("0.001", "STEP"));
        assert_eq!(original.shared(&fingerprints(&named)), original.count());
    }

    #[test]
    fn texts_that_do_not_compile_are_compared_by_tokens() {
        let original = Fingerprints::from_text(ORIGINAL);
        let copy = ORIGINAL
            .replace("march", "go")
            .replace("vec3 p ", "vec3  point ")
            .replace("p.", "point.")
            .replace("0.001", "1e-3 /* small */")
            .replace("t += h;", "t += h; // step\n");
        let broken = Fingerprints::from_text(&copy.replace("return t;", "return t"));
        let share = original.shared(&broken) as f64 / original.count() as f64;
        assert!(
            original.count() > 10 && share > 0.7,
            "{share} of {}",
            original.count()
        );
        assert_eq!(original.shared(&Fingerprints::from_text(&copy)), original.count());
    }

    #[test]
    fn other_shaders_share_little_and_parts_are_located() {
        let original = fingerprints(ORIGINAL);
        let other = fingerprints("void mainImage(out vec4 c, in vec2 p) {
            vec2 z = vec2(0);
            for (int i = 0; i < 50; i++) z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + p / iResolution.xy;
            c = vec4(dot(z, z) < 4.0 ? vec3(0) : vec3(1, 0.5, 0), 1);
        }");
        assert_eq!(original.shared(&other), 0);
        let (march, _) = ORIGINAL.split_once("void mainImage").unwrap();
        let part = fingerprints(&format!(
            "{march} void mainImage(out vec4 c, in vec2 p) {{ c = vec4(march(vec3(0), vec3(1))); }}"
        ));
        let lines = original.shared_lines(&part);
        assert!(
            lines.first().unwrap()[0] >= 2 && lines.last().unwrap()[1] <= 10,
            "{lines:?}"
        );
    }

    #[test]
    fn every_window_keeps_a_hash() {
        let hashes: Vec<u64> = (0..200_u64).map(|at| hash(&at)).collect();
        let places = winnow(&hashes);
        assert!(
            places.windows(2).all(|pair| pair[1] - pair[0] <= WINDOW),
            "{places:?}"
        );
        assert!(places.len() < 100);
        assert_eq!((winnow(&[]), winnow(&[7, 3])), (vec![], vec![1]));
    }
}
