//! Mutant schemata (Untch, Offutt and Harrold, "Mutation analysis using mutant schemata", ISSTA 1993): one
//! program that contains many edits of a shader, each selected by a parameter. It is compiled once for all of
//! them.

use std::collections::{BTreeMap, HashMap};
use std::time::Duration;

use toyproof_eval::{ParametricProgram, Point, PointEvaluator, Refusal};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    Arm, Block, ExprId, ExprKind, FunctionId, Place, Statement, StatementKind, Tree, Type, Variable,
    VariableId, VariableKind,
};
use toyproof_image::Frame;

use super::edit::{Action, Candidate, Change};
use super::shader::{Shader, StatementId, find, renumbered};
use super::term::{Term, push};
use crate::engine::probes::Probes;
use crate::engine::{Colors, Field, Numbers, Run};

/// The number of fitted numbers.
const NUMBERS: usize = std::mem::size_of::<Numbers>() / std::mem::size_of::<f64>();

/// The edits of a compiled schema, evaluated side by side.
pub(super) struct SchemaField<'a, 'e> {
    evaluator: &'a mut PointEvaluator<'e>,
    /// The number of edits.
    count: usize,
}

impl<'a, 'e> SchemaField<'a, 'e> {
    pub(super) fn new(evaluator: &'a mut PointEvaluator<'e>, count: usize) -> Self {
        Self { evaluator, count }
    }

    /// The largest number of loop iterations of the last colors.
    pub(super) fn iterations(&self) -> u32 {
        self.evaluator.iterations()
    }

    /// The work so far.
    pub(super) fn work(&self) -> f64 {
        self.evaluator.work()
    }

    /// The values of the parameters of a run: those that select edits, one for each, then the fitted numbers.
    fn values(&self, run: &Run) -> Vec<f64> {
        let mut values = vec![0.0; self.count];
        if let Some(at) = run.hypothesis {
            values[at] = 1.0;
        }
        values.extend(run.numbers);
        values
    }
}

impl Field for SchemaField<'_, '_> {
    fn colors(&mut self, probes: &Probes, runs: &[Run]) -> Vec<Option<Colors>> {
        let values: Vec<Vec<f64>> = runs.iter().map(|run| self.values(run)).collect();
        let of_run = |(run, values): (&Run, _)| {
            let points = probes.all[run.probes.clone()].iter();
            points.map(move |probe| Point {
                at: probe.point,
                values,
            })
        };
        let points: Vec<Point> = runs
            .iter()
            .zip(values.iter().map(Vec::as_slice))
            .flat_map(of_run)
            .collect();
        let Ok(colors) = self.evaluator.colors(&points) else {
            return vec![None; runs.len()];
        };
        let mut colors = colors.into_iter();
        runs.iter()
            .map(|run| {
                // All colors of the run are taken even if one is missing, so that the next run has its own.
                let own: Vec<_> = colors.by_ref().take(run.probes.len()).collect();
                own.into_iter().collect()
            })
            .collect()
    }
}

/// Compiles a shader with edits that can be selected, unless it has too many values.
pub(super) fn compile(
    shader: &Shader,
    candidates: &[&Candidate],
    frame: &Frame,
    max_values: usize,
    limit: Duration,
) -> Result<ParametricProgram, Refusal> {
    let mut writer = Writer::new(shader.checked.clone(), candidates.len());
    for (number, candidate) in candidates.iter().enumerate() {
        writer.add(shader, number, candidate);
    }
    writer.apply_actions();
    ParametricProgram::new(&writer.checked, &writer.parameters, frame, max_values, limit)
}

struct Writer {
    checked: Checked,
    /// A `bool` for each candidate, and a `float` for each fitted number.
    parameters: Vec<VariableId>,
    /// Where the original of a replaced expression is now.
    moved: HashMap<ExprId, ExprId>,
    /// The changes of statements, by candidate.
    actions: BTreeMap<StatementId, Vec<(usize, Insertion)>>,
}

/// A change at a statement, in terms of the tree.
enum Insertion {
    Delete,
    Before(Statement),
    After(Statement),
}

impl Writer {
    fn new(mut checked: Checked, count: usize) -> Self {
        let types = std::iter::repeat_n(Type::BOOL, count).chain([Type::FLOAT; NUMBERS]);
        let parameters = types.map(|ty| {
            checked.tree.variables.push(Variable {
                name: String::new(),
                ty,
                kind: VariableKind::Uniform,
                initializer: None,
                value: None,
                at: None,
            })
        });
        Self {
            parameters: parameters.collect(),
            checked,
            moved: HashMap::new(),
            actions: BTreeMap::new(),
        }
    }

    /// The parameters for the fitted numbers.
    fn fitted(&self) -> Vec<VariableId> {
        self.parameters[self.parameters.len() - NUMBERS..].to_vec()
    }

    fn add(&mut self, shader: &Shader, number: usize, candidate: &Candidate) {
        match &candidate.change {
            Change::Expression { site, term } => {
                for &expr in &shader.sites[*site].exprs {
                    self.replace(number, expr, term);
                }
            }
            Change::Statements(actions) => {
                for (at, action) in actions {
                    self.add_action(shader, number, *at, action);
                }
            }
        }
    }

    /// Makes an expression a choice between a term and the original.
    fn replace(&mut self, number: usize, expr: ExprId, term: &Term) {
        let fitted = self.fitted();
        let tree = &mut self.checked.tree;
        let old = tree[expr].clone();
        let at = old.at;
        let before = tree.exprs.push(old);
        let original = *self.moved.entry(expr).or_insert(before);
        let condition = push(tree, ExprKind::Variable(self.parameters[number]), Type::BOOL, at);
        let yes = term.build(tree, [expr, original], &fitted);
        tree[expr].kind = ExprKind::Conditional {
            condition,
            yes,
            no: before,
        };
        tree[expr].constant = false;
    }

    fn add_action(&mut self, shader: &Shader, number: usize, at: usize, action: &Action) {
        let Some(id) = shader.statements[at].at else {
            return;
        };
        let copy = |other: usize| {
            let other = shader.statements[other].at?;
            let body = shader.tree[other.function].body.as_ref()?;
            find(body, &mut 0, other.number)
        };
        let assignment = |writer: &mut Self, term: &Term| {
            let place = shader.statements[at].span;
            let fitted = writer.fitted();
            let tree = &mut writer.checked.tree;
            // An assignment replaces no expression.
            let nothing = push(
                tree,
                ExprKind::Variable(fitted[0]),
                Type::FLOAT,
                Place::plain(place),
            );
            let expr = term.build(tree, [nothing; 2], &fitted);
            Statement {
                kind: StatementKind::Expression(expr),
                at: Place::plain(place),
            }
        };
        let insertion = match action {
            Action::Delete => Some(Insertion::Delete),
            Action::CopyBefore(other) => copy(*other).map(Insertion::Before),
            Action::CopyAfter(other) => copy(*other).map(Insertion::After),
            Action::Before(term) => Some(Insertion::Before(assignment(self, term))),
            Action::After(term) => Some(Insertion::After(assignment(self, term))),
        };
        if let Some(insertion) = insertion {
            self.actions.entry(id).or_default().push((number, insertion));
        }
    }

    /// Applies the changes of statements to the functions.
    fn apply_actions(&mut self) {
        let mut functions: Vec<FunctionId> = self.actions.keys().map(|id| id.function).collect();
        functions.dedup();
        for function in functions {
            let Some(body) = self.checked.tree[function].body.take() else {
                continue;
            };
            let (tree, actions, parameters) = (&mut self.checked.tree, &mut self.actions, &self.parameters);
            let body = renumbered(body, &mut 0, &mut |number, statement, out| {
                let id = StatementId { function, number };
                change(
                    tree,
                    parameters,
                    actions.remove(&id).unwrap_or_default(),
                    statement,
                    out,
                );
            });
            self.checked.tree[function].body = Some(body);
        }
    }
}

/// Writes a statement with the changes that may be selected there.
fn change(
    tree: &mut Tree,
    parameters: &[VariableId],
    actions: Vec<(usize, Insertion)>,
    statement: Statement,
    out: &mut Block,
) {
    let at = statement.at;
    let mut selected = |number: usize, body: Block, otherwise: Option<Block>| {
        let condition = push(tree, ExprKind::Variable(parameters[number]), Type::BOOL, at);
        Statement {
            kind: StatementKind::If {
                arms: vec![Arm { condition, body }],
                otherwise,
            },
            at,
        }
    };
    let (mut deleted, mut after) = (Vec::new(), Vec::new());
    for (number, insertion) in actions {
        match insertion {
            Insertion::Delete => deleted.push(number),
            Insertion::Before(new) => out.push(selected(number, vec![new], None)),
            Insertion::After(new) => after.push(selected(number, vec![new], None)),
        }
    }
    let kept = deleted.into_iter().fold(statement, |statement, number| {
        selected(number, Block::new(), Some(vec![statement]))
    });
    out.push(kept);
    out.extend(after);
}
