//! Directives and macros.

use super::case::{Case, INVALID, OK, body, lines, nested, within};

pub(crate) fn cases() -> Vec<Case> {
    [macros(), directives()].into_iter().flatten().collect()
}

fn macros() -> Vec<Case> {
    let doubling =
        "#define A0 1.0 + 1.0\n".to_owned() + &lines(40, |at| format!("#define A{} A{at} + A{at}", at + 1));
    let arguments = "#define F(x) x + x + x + x\n";
    let names: Vec<_> = (0..5_000).map(|at| format!("a{at}")).collect();
    let parameters = format!("#define F({}) 1.0\n", names.join(", "));
    vec![
        within(
            "a macro that doubles forty times",
            INVALID,
            &doubling,
            "c = vec4(A40);",
        ),
        within(
            "an argument that doubles forty times",
            INVALID,
            arguments,
            &format!("c = vec4({});", nested(40, "F(", "1.0", ")")),
        ),
        within(
            "macros that call each other",
            INVALID,
            "#define A B\n#define B A\n",
            "c = vec4(A);",
        ),
        within(
            "a macro that calls itself a thousand deep",
            INVALID,
            "#define F(x) F(F(x))\n",
            &format!("c = vec4({});", nested(1_000, "F(", "1.0", ")")),
        ),
        within(
            "ten thousand macros",
            OK,
            &lines(10_000, |at| format!("#define A{at} {at}.0")),
            "c = vec4(A9999);",
        ),
        within(
            "a chain of ten thousand macros",
            INVALID,
            &lines(10_000, |at| format!("#define A{} A{at}", at + 1)),
            "c = vec4(A10000);",
        ),
        within(
            "a macro of five thousand parameters",
            INVALID,
            &parameters,
            "c = vec4(F(1.0));",
        ),
    ]
}

fn directives() -> Vec<Case> {
    vec![
        within(
            "twenty thousand conditions in each other",
            OK,
            &nested(20_000, "#if 1\n", "", "#endif\n"),
            "c = vec4(1.0);",
        ),
        within("a condition that never ends", INVALID, "#if 0", "c = vec4(1.0);"),
        within(
            "a condition of twenty thousand parentheses",
            INVALID,
            &format!("#if {}\n#endif", nested(20_000, "(", "1", ")")),
            "c = vec4(1.0);",
        ),
        within(
            "a condition that divides by zero",
            INVALID,
            "#if 1 / 0\n#endif",
            "c = vec4(1.0);",
        ),
        within(
            "a condition that divides the smallest integer by -1",
            OK,
            "#if (-2147483647 - 1) / -1 == 0\n#error no\n#endif",
            "c = vec4(1.0);",
        ),
        within(
            "a condition that shifts by a million",
            OK,
            "#if 1 << 1000000\n#endif",
            "c = vec4(1.0);",
        ),
        within(
            "#include of the system's users",
            INVALID,
            "#include \"/etc/passwd\"",
            "c = vec4(1.0);",
        ),
        within(
            "#include of an endless file",
            INVALID,
            "#include </dev/zero>",
            "c = vec4(1.0);",
        ),
        within(
            "#include of a process's memory",
            INVALID,
            "#include \"../../../../../../proc/self/environ\"",
            "c = vec4(1.0);",
        ),
        within(
            "a #line beyond all lines",
            OK,
            "#line 2147483647",
            "c = vec4(1.0);",
        ),
        within("a #line below zero", OK, "#line -5", "c = vec4(1.0);"),
        within(
            "a #version that is none",
            INVALID,
            "#version 99999999999999999999",
            "c = vec4(1.0);",
        ),
        within(
            "an #error of a megabyte",
            INVALID,
            &format!("#error {}", "no ".repeat(300_000)),
            "c = vec4(1.0);",
        ),
        within(
            "twenty thousand extensions",
            OK,
            &lines(20_000, |at| format!("#extension GL_none_{at} : enable")),
            "c = vec4(1.0);",
        ),
        body(
            "words pasted into each other",
            INVALID,
            "\n#define P(a, b) a ## b\nP(c, ) = P(vec, 4)(1.0);",
        ),
    ]
}
