//! Estimates the number of samples per pixel of a shader from its loops.

use toyproof_glsl::tree::{
    BinaryOp, Block, Condition, ExprId, ExprKind, StatementKind, StepOp, Tree, Value, VariableId,
};

/// The largest relative difference of a ratio of variances from the ratio of sample counts that explains it.
const MAX_RATIO_ERROR: f64 = 0.15;

/// Returns the number of samples of a shader whose noise has `ratio` times the variance expected for
/// `samples`, if one of its loops has the number of iterations that explains the ratio, and no loop has
/// `samples` or more.
pub(super) fn fewer_samples(tree: &Tree, samples: u32, ratio: f64) -> Option<u32> {
    let mut counts = Vec::new();
    for (_, function) in tree.functions.iter() {
        if let Some(body) = &function.body {
            collect_counts(tree, body, 1.0, &mut counts);
        }
    }
    let samples = f64::from(samples);
    if counts.iter().any(|&count| count >= samples) {
        return None;
    }
    let fits = |&count: &f64| count >= 1.0 && (ratio * count / samples - 1.0).abs() < MAX_RATIO_ERROR;
    counts.into_iter().find(fits).map(|count| count as u32)
}

/// Collects the iteration counts of counting loops, and the products of those of nested loops.
fn collect_counts(tree: &Tree, block: &Block, outside: f64, counts: &mut Vec<f64>) {
    for statement in block {
        match &statement.kind {
            StatementKind::Block(block) => collect_counts(tree, block, outside, counts),
            StatementKind::If { arms, otherwise } => {
                let bodies = arms.iter().map(|arm| &arm.body).chain(otherwise);
                bodies.for_each(|body| collect_counts(tree, body, outside, counts));
            }
            StatementKind::Switch { cases, .. } => {
                for case in cases {
                    collect_counts(tree, &case.body, outside, counts);
                }
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                let iterations = iterations(tree, init, *condition, *step);
                counts.extend(iterations);
                if outside > 1.0 {
                    counts.extend(iterations.map(|iterations| outside * iterations));
                }
                collect_counts(tree, body, outside * iterations.unwrap_or(1.0), counts);
            }
            StatementKind::While { body, .. } | StatementKind::DoWhile { body, .. } => {
                collect_counts(tree, body, outside, counts);
            }
            _ => {}
        }
    }
}

/// The iteration count of a loop that counts up from one constant to another.
fn iterations(tree: &Tree, init: &Block, condition: Option<Condition>, step: Option<ExprId>) -> Option<f64> {
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
        .find_map(|statement| initial_value(tree, &statement.kind, counter))?;
    let step_size = match &tree[step?].kind {
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
    let distance = number(tree, right)? - first;
    let iterations = match op {
        BinaryOp::Less => (distance / step_size).ceil(),
        BinaryOp::LessEqual => (distance / step_size).floor() + 1.0,
        _ => return None,
    };
    (iterations.is_finite() && iterations > 0.0).then_some(iterations)
}

fn initial_value(tree: &Tree, statement: &StatementKind, counter: VariableId) -> Option<f64> {
    match *statement {
        StatementKind::Declare(variable) if variable == counter => number(tree, tree[variable].initializer?),
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

    fn samples_of(loops: &str, samples: u32, ratio: f64) -> Option<u32> {
        let text = format!(
            "const int SAMPLES = 6;\nvoid mainImage(out vec4 c, in vec2 p) {{ c = vec4(0.0); {loops} }}"
        );
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
        fewer_samples(&checked.tree, samples, ratio)
    }

    #[test]
    fn a_loop_with_too_few_iterations_is_found() {
        let six = "for (int i = 0; i < SAMPLES; i++) c.x += p.x;";
        assert_eq!(samples_of(six, 16, 2.7), Some(6));
        assert_eq!(samples_of(six, 16, 1.4), None, "the ratio has another cause");
        assert_eq!(samples_of(six, 6, 1.0), None);
        let four_by_two = "for (int i = 0; i < 4; i++) for (int j = 1; j <= 2; j++) c.x += p.x;";
        assert_eq!(samples_of(four_by_two, 16, 2.0), Some(8));
        assert_eq!(
            samples_of(four_by_two, 8, 2.0),
            None,
            "the number of samples is right"
        );
        let floats = "for (float i = 0.0; i < 1.0; i += 0.25) c.x += i;";
        assert_eq!(samples_of(floats, 16, 4.0), Some(4));
        assert_eq!(samples_of("int i = 0; while (i < 6) { i++; }", 16, 2.7), None);
    }
}
