//! What holds of every tree that `check` returns.

use std::collections::HashSet;

use super::{MAIN, check_text};
use crate::tree::{
    Block, Condition, ExprId, ExprKind, Item, Label, Place, StatementKind, Tree, Type, VariableId,
};
use crate::{Checked, Options};

const TEXT: &str = "
    struct Ray { vec3 o, d; float t[2]; };
    const int N = 2;
    const Ray unit = Ray(vec3(0), vec3(0, 0, 1), float[](1., 2.));
    float seed = 3. * float(N), rows[N];
    float hash(inout float s) { s += 1.; return fract(sin(s++) * 43758.5453123); }
    float hash(vec2 p) { float s = p.x; return hash(s) + hash(p.y); }
    bool hit(Ray r, out float t, const in int i) { t = r.t[i]; return t > 0. && dot(r.o, r.d) < 1. || i == 0; }
    void test() {
        float t, u = 1.;
        for (int i = 0, j = N; i < j; i++, j -= 1) { if (i == 0) continue; else if (i == 1) t = u; else { break; } }
        while (bool more = hit(unit, t, 1)) { u = more ? -t : +u; do u *= 2.; while (u < 1.); }
        switch (N) { case 0: case N: t = (u, 2.); break; default: { struct S { int a; } s = S(1); rows[s.a] = t; } }
        mat2 m = mat2(1, 2, 3, 4); m[0].yx *= m; t = modf(m[1][0], u); int n = rows.length();
        if (hit(unit, m[0].x, 0)) { discard; } return;
    }
";

/// Every expression that hangs below statements and declarations, parents' roots only.
fn roots(tree: &Tree) -> Vec<ExprId> {
    let mut roots = Vec::new();
    for item in &tree.items {
        match *item {
            Item::Variable(variable) => declare(tree, variable, &mut roots),
            Item::Function(function) => block(tree, tree[function].body.as_ref().unwrap(), &mut roots),
            Item::Struct(_) | Item::Prototype(_) => {}
        }
    }
    roots
}

fn declare(tree: &Tree, variable: VariableId, roots: &mut Vec<ExprId>) {
    if let Some(initialiser) = tree[variable].initialiser {
        assert_eq!(tree[initialiser].ty, tree[variable].ty);
        roots.push(initialiser);
    }
}

fn condition(tree: &Tree, condition: Condition, roots: &mut Vec<ExprId>) {
    match condition {
        Condition::Expression(expr) => roots.push(expr),
        Condition::Declare(variable) => declare(tree, variable, roots),
    }
}

fn block(tree: &Tree, statements: &Block, roots: &mut Vec<ExprId>) {
    for statement in statements {
        match &statement.kind {
            StatementKind::Expression(expr) => roots.push(*expr),
            StatementKind::Declare(variable) => declare(tree, *variable, roots),
            StatementKind::Block(body) => block(tree, body, roots),
            StatementKind::If { arms, otherwise } => {
                for arm in arms {
                    roots.push(arm.condition);
                    block(tree, &arm.body, roots);
                }
                if let Some(body) = otherwise {
                    block(tree, body, roots);
                }
            }
            StatementKind::Switch { selector, cases } => {
                roots.push(*selector);
                for case in cases {
                    roots.extend(case.labels.iter().filter_map(|label| match label {
                        Label::Case { expr, .. } => Some(*expr),
                        Label::Default => None,
                    }));
                    block(tree, &case.body, roots);
                }
            }
            StatementKind::For {
                init,
                condition: test,
                step,
                body,
            } => {
                block(tree, init, roots);
                if let Some(test) = test {
                    condition(tree, *test, roots);
                }
                roots.extend(*step);
                block(tree, body, roots);
            }
            StatementKind::While {
                condition: test,
                body,
            } => {
                condition(tree, *test, roots);
                block(tree, body, roots);
            }
            StatementKind::DoWhile { body, condition } => {
                block(tree, body, roots);
                roots.push(*condition);
            }
            StatementKind::Return(value) => roots.extend(*value),
            StatementKind::Struct(_)
            | StatementKind::Break
            | StatementKind::Continue
            | StatementKind::Discard => {}
        }
    }
}

fn checked(lenient: bool) -> Checked {
    let options = Options {
        lenient,
        ..Options::default()
    };
    let text = if lenient {
        TEXT.replace("3. * float(N)", "3 * iTime")
    } else {
        TEXT.to_owned()
    };
    check_text(&(text + MAIN), &options).unwrap()
}

#[test]
fn every_expression_has_one_parent_and_fits_it() {
    for lenient in [false, true] {
        let Checked { tree, .. } = checked(lenient);
        let mut seen = HashSet::new();
        for expr in roots(&tree).into_iter().flat_map(|root| tree.postorder(root)) {
            assert!(seen.insert(expr), "{:?} twice", tree[expr]);
            assert_ne!(tree[expr].ty, Type::Error);
            match &tree[expr].kind {
                ExprKind::Call { function, arguments } => {
                    let parameters = tree[*function].parameters.iter().map(|&id| tree[id].ty);
                    assert!(parameters.eq(arguments.iter().map(|&argument| tree[argument].ty)));
                }
                ExprKind::Assign {
                    op: None,
                    target,
                    value,
                } => assert_eq!(tree[*target].ty, tree[*value].ty),
                ExprKind::Conditional { yes, no, .. } => assert_eq!(tree[*yes].ty, tree[*no].ty),
                _ => {}
            }
        }
        // Only the sizes of two arrays hang nowhere: their types have them.
        assert_eq!(tree.exprs.len(), seen.len() + 2);
    }
}

#[test]
fn statements_and_literals_lead_back_to_the_text() {
    let Checked { tree, .. } = checked(false);
    let spelled = |at: Place| &TEXT[at.spelled.start as usize..at.spelled.end as usize];
    for expr in roots(&tree).into_iter().flat_map(|root| tree.postorder(root)) {
        if let ExprKind::Literal(literal) = &tree[expr].kind
            && tree[expr].at.span.end as usize <= TEXT.len()
        {
            assert_eq!(spelled(tree[expr].at), &*literal.text);
        }
    }
    let (_, hash) = tree
        .functions
        .iter()
        .find(|(_, function)| function.name == "hash")
        .unwrap();
    let statements: Vec<_> = hash
        .body
        .iter()
        .flatten()
        .map(|statement| spelled(statement.at))
        .collect();
    assert_eq!(
        statements,
        ["s += 1.;", "return fract(sin(s++) * 43758.5453123);"]
    );
}
