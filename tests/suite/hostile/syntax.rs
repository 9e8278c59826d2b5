//! Nesting, recursion, and excessive sizes.

use super::case::{Case, INVALID, OK, SLOW, body, lines, nested, within};

pub(crate) fn cases() -> Vec<Case> {
    [nesting(), too_much()].into_iter().flatten().collect()
}

fn nesting() -> Vec<Case> {
    let sum = format!("float x = p.x{}; c = vec4(x);", " + 1.0".repeat(50_000));
    vec![
        body(
            "twenty thousand parentheses",
            INVALID,
            &format!("c = vec4({});", nested(20_000, "(", "1.0", ")")),
        ),
        body(
            "twenty thousand blocks",
            INVALID,
            &nested(20_000, "{", "c = vec4(1.0);", "}"),
        ),
        body(
            "twenty thousand ifs",
            INVALID,
            &nested(20_000, "if (p.x > 1.0) ", "c = vec4(1.0);", ""),
        ),
        body(
            "twenty thousand elses",
            SLOW,
            &format!(
                "{} c = vec4(1.0);",
                "if (p.x < 0.0) c = vec4(0.0); else ".repeat(20_000)
            ),
        ),
        body(
            "twenty thousand choices",
            INVALID,
            &format!("c = vec4({}1.0);", "p.x > 1e6 ? 1.0 : ".repeat(20_000)),
        ),
        body(
            "a hundred thousand signs",
            INVALID,
            &format!("c = vec4({}1.0);", "- ".repeat(100_000)),
        ),
        body("a sum of fifty thousand", SLOW, &sum),
        body(
            "ten thousand calls in each other",
            INVALID,
            &format!("c = vec4({});", nested(10_000, "abs(", "p.x", ")")),
        ),
        body(
            "ten thousand indices in each other",
            INVALID,
            &format!(
                "int a[2]; a[0] = 0; c = vec4({});",
                nested(10_000, "a[", "0", "]")
            ),
        ),
        body(
            "brackets of all kinds, none closed",
            INVALID,
            &"({[".repeat(30_000),
        ),
        body(
            "brackets of all kinds, none opened",
            INVALID,
            &")}]".repeat(30_000),
        ),
    ]
}

fn too_much() -> Vec<Case> {
    let structs = "struct S0 { float x; };\n".to_owned()
        + &lines(2_000, |at| format!("struct S{} {{ S{at} s; }};", at + 1));
    let doubled = "struct S0 { vec4 a, b; };\n".to_owned()
        + &lines(40, |at| format!("struct S{} {{ S{at} a, b; }};", at + 1));
    let ring = lines(100, |at| format!("float f{at}(float x);"))
        + &lines(100, |at| {
            format!("float f{at}(float x) {{ return f{}(x); }}", (at + 1) % 100)
        });
    let chain = "float f0(float x) { return x + 1.0; }\n".to_owned()
        + &lines(3_000, |at| {
            format!("float f{}(float x) {{ return f{at}(x) + 1.0; }}", at + 1)
        });
    let cases = lines(20_000, |at| format!("case {at}: c.x += {at}.0; break;"));
    let overloads = lines(500, |at| {
        format!("float f(float a[{}]) {{ return a[0]; }}", at + 1)
    });
    vec![
        within(
            "two thousand structures in each other",
            INVALID,
            &structs,
            "S2000 s; c = vec4(1.0);",
        ),
        within(
            "a structure that doubles forty times",
            INVALID,
            &doubled,
            "S40 s; c = vec4(1.0);",
        ),
        within(
            "a structure within itself",
            INVALID,
            "struct S { S s; };",
            "S s; c = vec4(1.0);",
        ),
        within(
            "a function that calls itself",
            INVALID,
            "float f(float x) { return x > 1.0 ? f(x - 1.0) : x; }",
            "c = vec4(f(p.x));",
        ),
        within(
            "a hundred functions that call each other in a ring",
            INVALID,
            &ring,
            "c = vec4(f0(p.x));",
        ),
        within(
            "a chain of three thousand functions",
            SLOW,
            &chain,
            "c = vec4(f3000(p.x));",
        ),
        within(
            "five hundred functions of one name",
            OK,
            &overloads,
            "float a[500]; a[0] = 1.0; c = vec4(f(a));",
        ),
        body(
            "a switch of twenty thousand cases",
            SLOW,
            &format!("c = vec4(0.0); switch (int(p.x)) {{ {cases} }}"),
        ),
        body(
            "a switch of fifty thousand labels",
            INVALID,
            &format!(
                "c = vec4(0.0); switch (int(p.x)) {{ {} c = vec4(1.0); }}",
                lines(50_000, |at| format!("case {at}:"))
            ),
        ),
        body(
            "twenty thousand variables",
            SLOW,
            &(lines(20_000, |at| format!("float a{at} = p.x * {at}.0;")) + "c = vec4(a0 + a19999);"),
        ),
    ]
}
