//! How many samples a shader takes in each pixel, as far as its loops say.

use toyproof_glsl::tree::{
    BinaryOp, Block, Condition, ExprId, ExprKind, StatementKind, StepOp, Tree, Value, VariableId,
};

/// A ratio of variances that is this near to a ratio of counts is taken for it.
const NEAR: f64 = 0.15;

/// The number of samples of a shader whose noise has so many times the variance that `samples` would have, if one of its loops runs
/// just as often as that takes, and none as often as it should.
pub(super) fn fewer_samples(tree: &Tree, samples: u32, ratio: f64) -> Option<u32> {
    let mut counts = Vec::new();
    for (_, function) in tree.functions.iter() {
        if let Some(body) = &function.body {
            in_block(tree, body, 1.0, &mut counts);
        }
    }
    let samples = f64::from(samples);
    if counts.iter().any(|&count| count >= samples) {
        return None;
    }
    let fits = |&count: &f64| count >= 1.0 && (ratio * count / samples - 1.0).abs() < NEAR;
    counts.into_iter().find(fits).map(|count| count as u32)
}

/// How often the bodies of counting loops run, those of nested loops all together.
fn in_block(tree: &Tree, block: &Block, outside: f64, counts: &mut Vec<f64>) {
    for statement in block {
        match &statement.kind {
            StatementKind::Block(block) => in_block(tree, block, outside, counts),
            StatementKind::If { arms, otherwise } => {
                let bodies = arms.iter().map(|arm| &arm.body).chain(otherwise);
                bodies.for_each(|body| in_block(tree, body, outside, counts));
            }
            StatementKind::Switch { cases, .. } => {
                for case in cases {
                    in_block(tree, &case.body, outside, counts);
                }
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                let rounds = rounds(tree, init, *condition, *step);
                counts.extend(rounds);
                if outside > 1.0 {
                    counts.extend(rounds.map(|rounds| outside * rounds));
                }
                in_block(tree, body, outside * rounds.unwrap_or(1.0), counts);
            }
            StatementKind::While { body, .. } | StatementKind::DoWhile { body, .. } => {
                in_block(tree, body, outside, counts);
            }
            _ => {}
        }
    }
}

/// How often a loop runs that counts up from one constant to another.
fn rounds(tree: &Tree, init: &Block, condition: Option<Condition>, step: Option<ExprId>) -> Option<f64> {
    let Some(Condition::Expression(condition)) = condition else {
        return None;
    };
    let &ExprKind::Binary { op, left, right } = &tree[condition].kind else {
        return None;
    };
    let &ExprKind::Variable(counter) = &tree[left].kind else {
        return None;
    };
    let first = init
        .iter()
        .find_map(|statement| first_value(tree, &statement.kind, counter))?;
    let by = match &tree[step?].kind {
        ExprKind::Step {
            op: StepOp::Increment,
            ..
        } => 1.0,
        ExprKind::Assign {
            op: Some(BinaryOp::Add),
            value,
            ..
        } => number(tree, *value)?,
        _ => return None,
    };
    let way = number(tree, right)? - first;
    let rounds = match op {
        BinaryOp::Less => (way / by).ceil(),
        BinaryOp::LessEqual => (way / by).floor() + 1.0,
        _ => return None,
    };
    (rounds.is_finite() && rounds > 0.0).then_some(rounds)
}

fn first_value(tree: &Tree, statement: &StatementKind, counter: VariableId) -> Option<f64> {
    match *statement {
        StatementKind::Declare(variable) if variable == counter => number(tree, tree[variable].initialiser?),
        StatementKind::Expression(expr) => match tree[expr].kind {
            ExprKind::Assign {
                op: None,
                target,
                value,
            } if tree.root_variable(target) == Some(counter) => number(tree, value),
            _ => None,
        },
        _ => None,
    }
}

fn number(tree: &Tree, expr: ExprId) -> Option<f64> {
    match tree.value(expr)?.components()[..] {
        [Value::Int(value)] => Some(f64::from(value)),
        [Value::Uint(value)] => Some(f64::from(value)),
        [Value::Float(value)] => Some(value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl as glsl;

    use super::*;

    fn told(loops: &str, samples: u32, ratio: f64) -> Option<u32> {
        let text = format!(
            "const int SAMPLES = 6;\nvoid mainImage(out vec4 c, in vec2 p) {{ c = vec4(0.0); {loops} }}"
        );
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
        fewer_samples(&checked.tree, samples, ratio)
    }

    #[test]
    fn a_loop_that_runs_too_seldom_is_found_and_others_prove_nothing() {
        let six = "for (int i = 0; i < SAMPLES; i++) c.x += p.x;";
        assert_eq!(told(six, 16, 2.7), Some(6));
        assert_eq!(told(six, 16, 1.4), None, "another reason for its noise");
        assert_eq!(told(six, 6, 1.0), None);
        let four_by_two = "for (int i = 0; i < 4; i++) for (int j = 1; j <= 2; j++) c.x += p.x;";
        assert_eq!(told(four_by_two, 16, 2.0), Some(8));
        assert_eq!(told(four_by_two, 8, 2.0), None, "it takes as many as it should");
        let floats = "for (float i = 0.0; i < 1.0; i += 0.25) c.x += i;";
        assert_eq!(told(floats, 16, 4.0), Some(4));
        assert_eq!(told("int i = 0; while (i < 6) { i++; }", 16, 2.7), None);
    }
}
