//! Tests that inputs of any size and depth end in a tree or a diagnostic, quickly and on a small stack; and
//! invariants of all trees.

use std::collections::HashSet;

use toyproof_diagnostic::{Code, Severity};

use super::{MAIN, check_text};
use crate::dialect::{Dialect, Wrapping};
use crate::tree::{
    self, Block, Condition, ExprId, ExprKind, Item, Label, Place, StatementKind, Tree, Type, VariableId,
};
use crate::{Checked, Options, Stage};

/// Runs `work` on a stack of 2 MB, the default for threads.
fn with_small_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(2 << 20);
        builder.spawn_scoped(scope, work).unwrap().join().unwrap()
    })
}

fn each(indices: std::ops::Range<usize>, line: fn(usize) -> String) -> String {
    indices.map(line).collect()
}

#[test]
fn too_deep_nesting_is_reported() {
    let shapes: [(&str, &str, &str); 9] = [
        ("(", "1.", ")"),
        ("sin(", "1.", ")"),
        ("- ", "1.", ""),
        ("+(", "1.", ")"),
        ("true ? 1. : ", "1.", ""),
        ("true ? ", "1.", " : 1."),
        ("a = ", "1.", ""),
        ("b[int(", "1.", ")]"),
        (
            "1. + 1. * float(true || true && 1 == 1 << 1 + ivec2(",
            "1",
            ").x)",
        ),
    ];
    for (open, middle, close) in shapes {
        let text = |depth: usize| {
            let value = format!("{}{middle}{}", open.repeat(depth), close.repeat(depth));
            format!("void test() {{ float a, b[2]; a = {value}; }} {MAIN}")
        };
        for depth in [50_000, 300] {
            let text = text(depth);
            let errors = with_small_stack(|| check_text(&text, &Options::default()).unwrap_err());
            assert_eq!(errors[0].code, Code::TooDeep, "{open} {depth}");
        }
        let shallow = text(20);
        with_small_stack(|| check_text(&shallow, &Options::default())).unwrap();
    }
    for (open, depth, accepted) in [
        ("if (true) ", 240, true),
        ("if (true) ", 50_000, false),
        ("{", 50_000, false),
        ("for (;;) ", 50_000, false),
    ] {
        let text = format!("void test() {{ {} ; }} {MAIN}", open.repeat(depth));
        let result = with_small_stack(|| check_text(&text, &Options::default()).map(drop));
        assert_eq!(result.is_ok(), accepted, "{open} {depth}");
    }
    let parens = format!(
        "void test() {{ float a = {}1.{}; }} {MAIN}",
        "(".repeat(250),
        ")".repeat(250)
    );
    with_small_stack(|| check_text(&parens, &Options::default()).map(drop)).unwrap();
}

#[test]
fn long_chains_do_not_count_as_nesting() {
    let sum = "a + ".repeat(20_000);
    let commas = "a, ".repeat(20_000);
    let swizzles = ".xy".repeat(20_000);
    let ifs = "if (a < 1.) a = 2.; else ".repeat(5_000);
    let text = format!(
        "const float k = {} 1.; void test(float a) {{ a = {sum} a; a = ({commas} a); vec2 v; v = v{swizzles}; {ifs} ; }} {MAIN}",
        "1. + ".repeat(20_000)
    );
    let checked = with_small_stack(|| check_text(&text, &Options::default())).unwrap();
    let k = checked
        .tree
        .variables
        .iter()
        .find(|(_, variable)| variable.name == "k")
        .unwrap()
        .1;
    assert_eq!(
        k.value.as_ref().unwrap().components(),
        [tree::Value::Float(20_001.0)]
    );
    let consts = each(1..5_000, |index| {
        format!("const float k{index} = k{} * 2.;\n", index - 1)
    });
    let text = format!("const float k0 = 1.;\n{consts}{MAIN}");
    with_small_stack(|| check_text(&text, &Options::default())).unwrap();
}

#[test]
fn nested_structures_take_linear_time() {
    let levels = each(1..60, |level| {
        let last = level - 1;
        format!(
            "struct S{level} {{ S{last} a, b; }}; const S{level} c{level} = S{level}(c{last}, c{last});\n"
        )
    });
    let text = format!("struct S0 {{ float a, b; }}; const S0 c0 = S0(1., 2.);\n{levels}{MAIN}");
    let lenient = Options {
        lenient: true,
        ..Options::default()
    };
    assert_eq!(
        check_text(&text, &lenient).unwrap_err()[0].code,
        Code::BadArraySize
    );
    assert_eq!(
        check_text(&text, &Options::default()).unwrap_err()[0].code,
        Code::TooDeep
    );
    let deep = |line| format!("struct S0 {{ float a; }};\n{}{MAIN}", each(1..20_000, line));
    let texts = [
        deep(|level| format!("struct S{level} {{ S{} a; }};\n", level - 1)),
        deep(|level| format!("struct S{level} {{ S{} a[2]; }};\n", level - 1)),
        format!("float a{};\n{MAIN}", "[1]".repeat(20_000)),
    ];
    for text in texts {
        let errors = with_small_stack(|| check_text(&text, &lenient).unwrap_err());
        assert_eq!(errors[0].code, Code::TooDeep);
    }
}

#[test]
fn variable_size_is_limited() {
    let text = |size| format!("struct S {{ vec4 a[1024]; }}; S s[{size}]; {MAIN}");
    assert!(check_text(&text(1024), &Options::default()).is_ok());
    let errors = check_text(&text(1025), &Options::default()).unwrap_err();
    assert_eq!(errors[0].code, Code::BadArraySize);
}

#[test]
fn number_of_reported_errors_is_limited() {
    for line in ["@\n", "#if 1\n", "#define a__b 1\n#undef a__b\n@\n", "x y;\n"] {
        let text = format!("{}{MAIN}", line.repeat(10_000));
        let reported = check_text(&text, &Options::default()).unwrap_err();
        assert!(reported.len() <= 100, "{line}");
        assert!(
            reported
                .iter()
                .any(|diagnostic| diagnostic.severity == Severity::Error),
            "{line}"
        );
    }
}

#[test]
fn truncated_shaders_end_in_a_diagnostic() {
    let text = "#define F(x) (x)\nstruct S { vec2 a[2]; };\nvoid mainImage(out vec4 c, in vec2 f) {\n S s; for (int i = 0; \
                i < 2; i++) { switch (i) { case 0: s.a[i] = F(f); default: c = true ? vec4(1) : vec4(0); } } /* x */ }\n";
    assert!(check_text(text, &Options::default()).is_ok());
    for end in 0..text.len() - 1 {
        assert!(
            check_text(&text[..end], &Options::default()).is_err(),
            "{}",
            &text[..end]
        );
    }
}

/// Any quadratic algorithm takes minutes for these inputs.
#[test]
fn a_megabyte_of_one_construct_takes_linear_time() {
    let terms = |term: &str, operator: &str| vec![term; 60_000].join(operator);
    let numbers = terms("1.", ",");
    let statements: [(&str, String); 12] = [
        ("a sum of literals", format!("x = {};", terms("1.", "+"))),
        ("a product of vectors", format!("v = {};", terms("vec4(1.)", "*"))),
        ("conditions", format!("b = {};", terms("true", "&&"))),
        ("what has no value", format!("i = {};", terms("(1/0)", "+"))),
        (
            "a local constant",
            format!("const float k = {};", terms("1.", "+")),
        ),
        (
            "reads of a constant array",
            format!(
                "const float k[] = float[]({numbers}); x = {};",
                terms("k[7]", "+")
            ),
        ),
        (
            "copies of a constant structure",
            format!(
                "struct S {{ float a[60000]; }}; const S s = S(float[60000]({numbers})); {}",
                "{ const S t = s; x += t.a[3]; }".repeat(10_000)
            ),
        ),
        ("comparisons", "if (x == 1.5) x = 2.0;".repeat(30_000)),
        (
            "comparisons of sums",
            "if (x + y == 1.5) x = y * .3;".repeat(30_000),
        ),
        (
            "declarations",
            each(0..60_000, |index| format!("float a{index};")),
        ),
        ("arrays", each(0..60_000, |index| format!("float a{index}[9];"))),
        ("declarations before a branch", {
            let declared = each(0..40_000, |index| format!("float a{index};"));
            format!("{declared} if (b) x = 1.;")
        }),
    ];
    for (name, statements) in statements {
        let text = format!(
            "void mainImage(out vec4 c, in vec2 p) {{ float x = p.x, y = p.y; vec4 v; bool b = x > y; int i; {statements} c = vec4(x); }}"
        );
        let checked = check_text(&text, &Options::default());
        assert!(checked.is_ok(), "{name}: {}", checked.unwrap_err()[0].message);
    }
}

#[test]
fn every_stage_stops_at_its_deadline() {
    use toyproof_diagnostic::{Deadline, File, Files};

    use crate::check::{Channels, Checker};
    use crate::parse::Parser;
    use crate::preprocess;

    let over = Deadline::after(std::time::Duration::ZERO);
    let in_time = Options::default();
    let late = Options {
        deadline: over.clone(),
        ..Options::default()
    };
    let text = format!("float f(float x) {{ return x == x + .1 ? 1. : 2.; }} {MAIN}");
    let errors = check_text(&text, &late).unwrap_err();
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert_eq!(errors[0].code, Code::TooSlow);
    assert_eq!(errors[0].message, "compilation exceeded the time limit of 0 s");

    let mut files = Files::default();
    let file = files.add(File::new("a", text.as_str()));
    let wrapping = Wrapping::new(Dialect::ShaderToy, None, false);
    let whole = preprocess::preprocess(&files, file, Stage::Image, wrapping, &in_time.deadline);
    let begun = preprocess::preprocess(&files, file, Stage::Image, wrapping, &over);
    assert!(begun.tokens.len() < whole.tokens.len());
    let parse = |options: &Options| {
        let checker = Checker::new(&whole, options, wrapping, Channels::new(options));
        Parser::new(&whole, files.get(file), checker)
            .parse()
            .tree
            .exprs
            .len()
    };
    assert!(parse(&in_time) > 0);
    assert_eq!(parse(&late), 0);
}

// Invariants of every tree that `check` returns.

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

/// The roots of all expressions in statements and declarations.
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
    if let Some(initializer) = tree[variable].initializer {
        assert_eq!(tree[initializer].ty, tree[variable].ty);
        roots.push(initializer);
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
        // Only the size expressions of two arrays are not in the tree: their types contain the sizes.
        assert_eq!(tree.exprs.len(), seen.len() + 2);
    }
}

#[test]
fn places_of_statements_and_literals_match_the_text() {
    let Checked { tree, .. } = checked(false);
    let spelling = |at: Place| &TEXT[at.spelling.start as usize..at.spelling.end as usize];
    for expr in roots(&tree).into_iter().flat_map(|root| tree.postorder(root)) {
        if let ExprKind::Literal(literal) = &tree[expr].kind
            && tree[expr].at.span.end as usize <= TEXT.len()
        {
            assert_eq!(spelling(tree[expr].at), &*literal.text);
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
        .map(|statement| spelling(statement.at))
        .collect();
    assert_eq!(
        statements,
        ["s += 1.;", "return fract(sin(s++) * 43758.5453123);"]
    );
}
