use toyproof_diagnostic::{File, Span};

use super::*;
use crate::dialect::Dialect;

/// The tokens' texts with blanks between them, or the code of the first diagnostic.
fn expand(text: &str) -> String {
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    let result = preprocess(
        &files,
        file,
        Stage::Image,
        Wrapping::new(Dialect::ShaderToy, None, false),
        &Deadline::default(),
    );
    if let Some(first) = result.diagnostics.first() {
        return first.code.to_string();
    }
    let texts = result.tokens.iter().filter_map(|token| match token.kind {
        TokenKind::Word(symbol) | TokenKind::Number(symbol) => Some(result.interner.text(symbol)),
        TokenKind::Punctuator(punctuator) => Some(punctuator.text()),
        _ => None,
    });
    texts.collect::<Vec<_>>().join(" ")
}

fn check(cases: &[(&str, &str)]) {
    for (text, wanted) in cases {
        assert_eq!(expand(text), *wanted, "{text}");
    }
}

#[test]
fn tokens() {
    check(&[
        ("a+++b<<=.5e-3*0xE+1", "a ++ + b <<= .5e-3 * 0xE + 1"),
        ("a/* x\n y */b//c\nd", "a b d"),
        ("a\\\nb c\\\r\nd // e\\\nf", "ab cd"),
        ("a\r\nb\rc", "a b c"),
        ("1.xx 1..2", "1.xx 1..2"),
        ("a /* b", "E0002"),
        ("a @ b", "E0001"),
        ("#if 0\n@ \" '\n#endif\nb", "b"),
        ("a # b", "E0009"),
    ]);
}

#[test]
fn macros_are_rescanned_but_never_expand_recursively() {
    check(&[
        ("#define A B\n#define B 1\nA", "1"),
        ("#define A A + B\n#define B A\nA", "A + A"),
        ("#define F(x) x*x\nF(a+b) F (c) F", "a + b * a + b c * c F"),
        ("#define F (x)\nF", "( x )"),
        ("#define F(x, y) y x\nF((1, 2), F(3, 4))", "4 3 ( 1 , 2 )"),
        ("#define F(\\\nx) x\nF(\n1\n)", "1"),
        ("#define F() 1\nF() F( )", "1 1"),
        ("#define F(x) [x]\nF()", "[ ]"),
        // C++98 §16.3.5, without `#` and `##`.
        (
            "#define x 3\n#define f(a) f(x * (a))\n#undef x\n#define x 2\n#define g f\n#define z z[0]\n\
             #define h g(~\n#define m(a) a(w)\n#define w 0,1\n#define t(a) a\n\
             f(y+1) + f(f(z)) % t(t(g)(0) + t)(1);\ng(x+(3,4)-w) | h 5) & m\n(f)^m(m);",
            "f ( 2 * ( y + 1 ) ) + f ( 2 * ( f ( 2 * ( z [ 0 ] ) ) ) ) % f ( 2 * ( 0 ) ) + t ( 1 ) ; \
             f ( 2 * ( 2 + ( 3 , 4 ) - 0 , 1 ) ) | f ( 2 * ( ~ 5 ) ) & f ( 2 * ( 0 , 1 ) ) ^ m ( 0 , 1 ) ;",
        ),
        ("#define F(x) x\nF(1, 2)", "E0008"),
        ("#define F(x) x\nF(1", "E0008"),
        ("#define F(x, x) x", "E0007"),
        ("#define F(x", "E0004"),
        ("#define A a ## b\nA", "E0009"),
        ("#define A(x) #x\nA(1)", "E0009"),
        ("#define A a ## b\nb", "b"),
        ("#define A 1\n#define A  1\nA", "1"),
        ("#define A 1\n#define A 2", "E0007"),
        ("#define A 1\n#undef A\n#define A 2\nA", "2"),
        ("#define GL_x 1", "E0007"),
        ("#undef __LINE__", "E0007"),
        ("#define a__b 1", "W0001"),
    ]);
}

#[test]
fn messages_on_parameter_lists() {
    for (text, wanted) in [
        ("#define F(", "unclosed parameter list of a macro"),
        ("#define F(x", "unclosed parameter list of a macro"),
        ("#define F(x,", "unclosed parameter list of a macro"),
        ("#define F(x,)", "expected the name of a parameter"),
        ("#define F(x y", "expected `,` or `)`"),
    ] {
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        let result = preprocess(
            &files,
            file,
            Stage::Image,
            Wrapping::new(Dialect::ShaderToy, None, false),
            &Deadline::default(),
        );
        assert_eq!(result.diagnostics[0].message, wanted, "{text}");
    }
}

#[test]
fn predefined_macros() {
    check(&[
        (
            "__LINE__\n__LINE__ __VERSION__ GL_ES HW_PERFORMANCE __FILE__",
            "1 2 300 1 1 0",
        ),
        ("#line 10 7\n__LINE__ __FILE__", "10 7"),
        ("#version 300 es\na", "a"),
        ("a\n#version 300 es", "E0011"),
        ("#version 330", "E0011"),
        ("#extension GL_foo : require", "E0012"),
        ("#extension GL_foo : enable", "W0002"),
        ("#pragma optimize(off)\na", "a"),
        ("#error no", "E0010"),
        ("#if 0\n#error no\n#endif\na", "a"),
        ("#\na", "a"),
        ("#include <a>", "E0014"),
    ]);
}

#[test]
fn conditions() {
    let holds = [
        "1",
        "!0",
        "2+3*4 == 14",
        "(1<<4) == 0x10",
        "010 == 8",
        "-1 < 0",
        "~0 == -1",
        "5 % 3 == 2 && 7/2 == 3",
        "1 || 1/0",
        "!(0 && X)",
        "defined(GL_ES) && !defined X",
        "__VERSION__ >= 300",
        "1 | 2 ^ 3 & 1",
    ];
    for condition in holds {
        assert_eq!(
            expand(&format!("#if {condition}\na\n#else\nb\n#endif")),
            "a",
            "{condition}"
        );
        assert_eq!(
            expand(&format!("#if !({condition})\na\n#else\nb\n#endif")),
            "b",
            "{condition}"
        );
    }
    for wrong in [
        "",
        "X",
        "1/0",
        "1 +",
        "(1",
        "1.5",
        "1 1",
        "defined",
        "defined(1)",
        "1 ? 2 : 3",
    ] {
        assert_eq!(expand(&format!("#if {wrong}\n#endif")), "E0005", "{wrong}");
    }
    check(&[
        ("#if 0\na\n#elif 1\nb\n#elif 1/0\nc\n#else\nd\n#endif", "b"),
        ("#ifdef X\na\n#endif\n#ifndef X\nb\n#endif", "b"),
        ("#if 0\n#if X\n#else\n#endif\na\n#else\nb\n#endif", "b"),
        ("#if 1", "E0006"),
        ("#endif", "E0006"),
        ("#else", "E0006"),
        ("#if 0\n#else\n#else\n#endif", "E0006"),
        ("#if 0\n#else\n#elif 1\n#endif", "E0006"),
        ("#ifdef\n#endif", "E0004"),
    ]);
}

#[test]
fn hostile_macros_end_in_a_diagnostic() {
    let levels = |define: fn(usize) -> String| (1..60).map(define).collect::<String>();
    let bomb = levels(|level| format!("#define A{level} A{0} A{0}\n", level - 1));
    assert_eq!(expand(&format!("#define A0 x x\n{bomb} A59")), "E0013");
    let squares = levels(|level| format!("#define F{level}(x) F{0}(F{0}(x))\n", level - 1));
    assert_eq!(expand(&format!("#define F0(x) x x\n{squares} F59(1)")), "E0013");
    let nested = format!("#define F(x) x\n{}1{}", "F(".repeat(20_000), ")".repeat(20_000));
    assert_eq!(expand(&nested), "E0013");
    let parens = format!("#if {}1{}\n#endif", "(".repeat(20_000), ")".repeat(20_000));
    assert_eq!(expand(&parens), "E0101");
}

#[test]
fn tokens_keep_their_use_and_spelling() {
    let mut files = Files::default();
    let file = files.add(File::new("a", "#define F(x) x + b\n#define G F(c)\nF(a); G"));
    let result = preprocess(
        &files,
        file,
        Stage::Image,
        Wrapping::new(Dialect::ShaderToy, None, false),
        &Deadline::default(),
    );
    let reported: Vec<_> = result.tokens[..7]
        .iter()
        .map(|token| (files.text(token.at.span), files.text(token.at.spelling)))
        .collect();
    assert_eq!(
        reported,
        [
            ("a", "a"),
            ("F(a)", "+"),
            ("F(a)", "b"),
            (";", ";"),
            ("G", "c"),
            ("G", "+"),
            ("G", "b"),
        ]
    );
}

#[test]
fn uses_of_macros_can_be_shown_expanded() {
    let shown = |text: &str, used: &str| {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let start = text.rfind(used).unwrap() as u32;
        let used = Span::new(file, start, start + used.len() as u32);
        crate::expanded(&files, file, &crate::Options::default(), used)
    };
    let text = "#define PI 3.14\n#define ROT(a) mat2(cos(a), -sin(a), sin(a), cos(a))\n\
                #define TURN(p) p *= ROT(PI*2.);\nvoid f(inout vec2 q) { TURN(q.xy) }";
    let expanded = "q.xy *= mat2(cos(3.14 * 2.), -sin(3.14 * 2.), sin(3.14 * 2.), cos(3.14 * 2.));";
    assert_eq!(shown(text, "TURN(q.xy)").as_deref(), Some(expanded));
    assert_eq!(shown(text, "q.xy"), None);
    let doubling = "#define A x+x+x+x+x+x+x+x\n#define B A+A+A+A+A+A+A+A\n#define C B+B+B\nfloat y = C;";
    let long = shown(doubling, "C").unwrap();
    assert!(long.ends_with('…') && long.len() < 410, "{long}");
}

#[test]
fn skipped_text_is_recorded_without_directives() {
    let text = "#if 0\nint a;\nint b;\n#elif 1\nint c;\n#else\nint d;\n#endif\nint e;";
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let shader = format!("{text} void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0.); }}");
    let shader = files.add(File::new("b.glsl", shader));
    let checked = crate::check(&files, shader, &crate::Options::default()).unwrap();
    let skipped = checked.expansions.skipped().iter();
    let skipped: Vec<_> = skipped
        .map(|span| files.text(Span::new(file, span.start, span.end)))
        .collect();
    assert_eq!(skipped, ["int a;\nint b;", "int d;"]);
}
