//! Inputs of any size and depth end in a tree or a diagnostic, soon and on a small stack.

use super::{MAIN, check_text};
use crate::{Options, tree};

/// On a stack of 2 MB, as threads have it.
fn on_a_small_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(2 << 20);
        builder.spawn_scoped(scope, work).unwrap().join().unwrap()
    })
}

fn each(indices: std::ops::Range<usize>, line: fn(usize) -> String) -> String {
    indices.map(line).collect()
}

#[test]
fn nesting_has_a_limit_that_is_told() {
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
            let errors = on_a_small_stack(|| check_text(&text, &Options::default()).unwrap_err());
            assert_eq!(errors[0].code, "E0101", "{open} {depth}");
        }
        let shallow = text(20);
        on_a_small_stack(|| check_text(&shallow, &Options::default())).unwrap();
    }
    for (open, depth, accepted) in [
        ("if (true) ", 240, true),
        ("if (true) ", 50_000, false),
        ("{", 50_000, false),
        ("for (;;) ", 50_000, false),
    ] {
        let text = format!("void test() {{ {} ; }} {MAIN}", open.repeat(depth));
        let result = on_a_small_stack(|| check_text(&text, &Options::default()).map(drop));
        assert_eq!(result.is_ok(), accepted, "{open} {depth}");
    }
    let parens = format!(
        "void test() {{ float a = {}1.{}; }} {MAIN}",
        "(".repeat(250),
        ")".repeat(250)
    );
    on_a_small_stack(|| check_text(&parens, &Options::default()).map(drop)).unwrap();
}

#[test]
fn long_chains_are_no_nesting() {
    let sum = "a + ".repeat(20_000);
    let commas = "a, ".repeat(20_000);
    let swizzles = ".xy".repeat(20_000);
    let ifs = "if (a < 1.) a = 2.; else ".repeat(5_000);
    let text = format!(
        "const float k = {} 1.; void test(float a) {{ a = {sum} a; a = ({commas} a); vec2 v; v = v{swizzles}; {ifs} ; }} {MAIN}",
        "1. + ".repeat(20_000)
    );
    let checked = on_a_small_stack(|| check_text(&text, &Options::default())).unwrap();
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
    on_a_small_stack(|| check_text(&text, &Options::default())).unwrap();
}

#[test]
fn structures_of_structures_cost_nothing() {
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
    assert_eq!(check_text(&text, &lenient).unwrap_err()[0].code, "E0305");
    assert_eq!(
        check_text(&text, &Options::default()).unwrap_err()[0].code,
        "E0101"
    );
    let deep = |line| format!("struct S0 {{ float a; }};\n{}{MAIN}", each(1..20_000, line));
    let texts = [
        deep(|level| format!("struct S{level} {{ S{} a; }};\n", level - 1)),
        deep(|level| format!("struct S{level} {{ S{} a[2]; }};\n", level - 1)),
        format!("float a{};\n{MAIN}", "[1]".repeat(20_000)),
    ];
    for text in texts {
        let errors = on_a_small_stack(|| check_text(&text, &lenient).unwrap_err());
        assert_eq!(errors[0].code, "E0101");
    }
}

#[test]
fn a_variable_has_a_limit() {
    let text = |size| format!("struct S {{ vec4 a[1024]; }}; S s[{size}]; {MAIN}");
    assert!(check_text(&text(1024), &Options::default()).is_ok());
    let errors = check_text(&text(1025), &Options::default()).unwrap_err();
    assert_eq!(errors[0].code, "E0305");
}

#[test]
fn no_more_is_told_than_helps() {
    for line in ["@\n", "#if 1\n", "#define a__b 1\n#undef a__b\n@\n", "x y;\n"] {
        let text = format!("{}{MAIN}", line.repeat(10_000));
        let told = check_text(&text, &Options::default()).unwrap_err();
        assert!(told.len() <= 100, "{line}");
        assert!(
            told.iter().any(|diagnostic| diagnostic.code.starts_with('E')),
            "{line}"
        );
    }
}

#[test]
fn cut_short_anywhere_a_shader_ends_in_a_diagnostic() {
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

/// Whatever is looked at again for each part of a text takes minutes for these.
#[test]
fn a_megabyte_of_one_construct_takes_time_in_proportion() {
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
fn every_stage_ends_when_its_time_is_over() {
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
    assert_eq!(errors[0].code, "E0410");
    assert_eq!(errors[0].message, "this shader takes longer than 0 s to compile");

    let mut files = Files::default();
    let file = files.add(File::new("a", text.as_str()));
    let whole = preprocess::preprocess(&files, file, &in_time.deadline);
    let begun = preprocess::preprocess(&files, file, &over);
    assert!(begun.tokens.len() < whole.tokens.len());
    let parse = |options: &Options| {
        let checker = Checker::new(&whole, options, Channels::new(options));
        Parser::new(&whole, files.get(file), checker)
            .parse()
            .tree
            .exprs
            .len()
    };
    assert!(parse(&in_time) > 0);
    assert_eq!(parse(&late), 0);
}
