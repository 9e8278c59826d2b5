use toyproof_diagnostic::{File, Files};
use toyproof_glsl::lexemes;

use crate::{Error, format};

/// Formats a text, and checks that the result stays as it is when it is formatted again.
fn formatted(text: &str) -> String {
    let once = format(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(
        format(&once).expect("the text is as deep as before"),
        once,
        "{text}"
    );
    let tokens = |text: &str| {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let texts = lexemes(&files, file).into_iter();
        texts
            .map(|lexeme| files.text(lexeme.span).to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(tokens(text), tokens(&once));
    once
}

fn assert_formatted(text: &str, expected: &str) {
    assert_eq!(formatted(text), expected, "of {text}");
    assert_eq!(formatted(expected), expected);
}

/// Statements, formatted inside of a function.
fn assert_statements(text: &str, expected: &str) {
    assert_formatted(
        &format!("void f() {{\n{text}\n}}\n"),
        &format!("void f() {{\n{expected}}}\n"),
    );
}

#[test]
fn operators_have_spaces_and_signs_have_none() {
    assert_formatted(
        "const vec2 a=vec2( -1.,+ 2. )*- b.x ,c = a[ 1 ]-(-a);",
        "const vec2 a = vec2(-1., +2.) * -b.x, c = a[1] - (-a);\n",
    );
    assert_formatted(
        "float x = a?b:- -c*! !d+ + +e- --f-g-- -h;",
        "float x = a ? b : - -c * !!d + + +e - --f - g-- - h;\n",
    );
    assert_formatted(
        "layout ( location=0 ) out vec4 o ; float[ 3 ]g=float[]( 1.,2.,3. );",
        "layout(location = 0) out vec4 o;\nfloat[3] g = float[](1., 2., 3.);\n",
    );
    assert_formatted("float a[2]={ 1. , { -2. } };", "float a[2] = {1., {-2.}};\n");
}

#[test]
fn tokens_stay_apart() {
    assert_formatted(
        "float x = 1. .x, y = 1 .x, z = a- -b, w = a+ +b;",
        "float x = 1. .x, y = 1 .x, z = a - -b, w = a + +b;\n",
    );
    assert_formatted("int a = b /c, d = e & &f;", "int a = b / c, d = e & & f;\n");
}

#[test]
fn statements_have_lines_of_their_own() {
    assert_statements(
        "int i=0;i ++;for(;;){break;}\n\n\nreturn\n;",
        "    int i = 0;\n    i++;\n    for (;;) { break; }\n\n    return;\n",
    );
    assert_statements(
        "if(a){b;}else if(c){d;e;f;}\nelse{}",
        "    if (a) {\n        b;\n    } else if (c) {\n        d;\n        e;\n        f;\n    } else {}\n",
    );
    assert_statements(
        "while(a)\n{\nb;\n}\ndo\n{\nc;\n}\nwhile(d);",
        "    while (a) {\n        b;\n    }\n    do {\n        c;\n    } while (d);\n",
    );
}

#[test]
fn bodies_without_braces_stay_where_they_are() {
    assert_statements(
        "if(a)b;\nif(a)\nb;\nelse\nif(c) d;\nelse e;",
        "    if (a) b;\n    if (a)\n        b;\n    else if (c) d;\n    else e;\n",
    );
    assert_statements(
        "for(;;)\nfor(;;)\n{\na;b;\n}\nif (a) for (;;) b; else c;",
        "    for (;;)\n        for (;;) {\n            a;\n            b;\n        }\n    if (a) for (;;) b; else c;\n",
    );
    assert_statements(
        "if (a) do b; while (c); else d;\nif (a) while (b) c;\nd;",
        "    if (a) do b; while (c); else d;\n    if (a) while (b) c;\n    d;\n",
    );
}

#[test]
fn labels_are_indented_and_keep_their_line() {
    assert_statements(
        "switch(i){case 0:a=1;break;\ncase 1:\ncase 2:b;\nc;\ndefault:{d;}\n}e;",
        "    switch (i) {\n        case 0: a = 1; break;\n        case 1:\n        case 2: b;\n            c;\n        \
         default: { d; }\n    }\n    e;\n",
    );
}

#[test]
fn short_functions_stay_on_one_line_if_they_fit() {
    assert_formatted(
        "float sq(float x){return x*x;}\nfloat c(float x)\n{ return x; }",
        "float sq(float x) { return x * x; }\nfloat c(float x) { return x; }\n",
    );
    let long = "a + ".repeat(25);
    assert_formatted(
        &format!("float f(float a) {{ return {long}a; }}"),
        &format!(
            "float f(float a) {{\n    return {}\n        + {};\n}}\n",
            "a + ".repeat(23).trim_end_matches(" + "),
            "a + ".repeat(3).trim_end_matches(" + "),
        ),
    );
    assert_formatted(
        "struct A{float x;}a;struct B{float x;float y;float z;};",
        "struct A { float x; } a;\nstruct B {\n    float x;\n    float y;\n    float z;\n};\n",
    );
}

#[test]
fn long_lines_are_broken_outside_of_brackets() {
    let argument = "argument_1, ".repeat(8);
    assert_formatted(
        &format!("float x = call({argument}y) * call({argument}z);"),
        "float x = call(argument_1, argument_1, argument_1, argument_1, argument_1, argument_1, argument_1,\n\
         \x20              argument_1, y) * call(argument_1, argument_1, argument_1, argument_1, argument_1,\n\
         \x20                                    argument_1, argument_1, argument_1, z);\n",
    );
}

#[test]
fn line_breaks_inside_of_statements_are_kept() {
    assert_formatted(
        "mat2 m = mat2(1.,0.,\n0.,1.);\nfloat x = a +\nb\n* c;\nfloat y\n= f(\n1.,2.\n);\nvec2 z = vec2(a\n, b);",
        "mat2 m = mat2(1., 0.,\n              0., 1.);\nfloat x = a\n    + b\n    * c;\nfloat y = f(\n    1., 2.\n);\n\
         vec2 z = vec2(a,\n              b);\n",
    );
    assert_statements(
        "if (a &&\nb) c;\nfloat d[2] = float[2](\n1.,\n\n2.);",
        "    if (a\n            && b) c;\n    float d[2] = float[2](\n        1.,\n\n        2.);\n",
    );
}

#[test]
fn comments_stay_with_their_code() {
    assert_statements(
        "// before\na; // behind\n/* inline */ b /* x */ + c;\nif (a) // why\nb;\n// last",
        "    // before\n    a; // behind\n    /* inline */ b /* x */ + c;\n    if (a) // why\n        b;\n    // last\n",
    );
    assert_statements(
        "if (a)\n// about b\nb;\nelse // about c\nc;\nf(a, // first\nb);",
        "    if (a)\n        // about b\n        b;\n    else // about c\n        c;\n    f(a, // first\n      b);\n",
    );
    // Further lines move with the first one.
    assert_statements(
        "  /* one\n     two\n\n   three */\n  a;",
        "    /* one\n       two\n\n     three */\n    a;\n",
    );
    assert_formatted(
        "// art \\ \nfloat a;\n// on\\\nfloat b;",
        "// art \\ \nfloat a;\n// on\\\nfloat b;\n",
    );
}

#[test]
fn aligned_comments_stay_aligned() {
    assert_formatted(
        "float a=1.;   // one\nint   b;      // two\nint c; // three\n",
        "float a = 1.; // one\nint b;        // two\nint c; // three\n",
    );
}

#[test]
fn directives_are_kept_and_their_branches_are_independent() {
    assert_formatted(
        "  #define  A   (1 ) // a  \nvoid f()\n{\n  #if A\nif(a){\n#else\nif(b){\n#endif\nc;\n}\n#ifdef B\n}\n#endif\nd;\n}",
        "#define  A   (1 ) // a\nvoid f() {\n#if A\n    if (a) {\n#else\n    if (b) {\n#endif\n        c;\n    }\n\
         #ifdef B\n}\n#endif\n    d;\n}\n",
    );
    assert_formatted(
        "float x = a\n#ifdef B\n+ b\n#endif\n;",
        "float x = a\n#ifdef B\n    + b\n#endif\n    ;\n",
    );
}

#[test]
fn long_definitions_are_continued() {
    let sum = "x + ".repeat(30);
    assert_formatted(
        &format!(
            "#define SUM(x) ({sum}x) // a sum\n#define CONST (x){}\n",
            " ".repeat(99)
        ),
        &format!(
            "#define SUM(x) ({} \\\n                + {}x) // a sum\n#define CONST (x)\n",
            "x + ".repeat(21).trim_end_matches(" + "),
            "x + ".repeat(9),
        ),
    );
}

#[test]
fn macros_shape_statements() {
    assert_statements(
        "#define EACH(i,n) for(int i=0;i<n;i++)\n#define ADD(x) a += x;\nEACH(i,3)\nb;\nEACH(i, 3) c;\nADD(1)\nADD(2)\nd;",
        "#define EACH(i,n) for(int i=0;i<n;i++)\n#define ADD(x) a += x;\n    EACH(i, 3)\n        b;\n    EACH(i, 3) c;\n    \
         ADD(1)\n    ADD(2)\n    d;\n",
    );
}

#[test]
fn what_a_comment_protects_is_kept() {
    assert_formatted(
        "// toyproof: no-format\nmat2 m = mat2( 1,0,\n               0,1 );\nfloat  x;",
        "// toyproof: no-format\nmat2 m = mat2( 1,0,\n               0,1 );\nfloat  x;",
    );
    assert_formatted(
        "float  a;\n// toyproof: no-format\nmat2 m = mat2( 1,0,\n               0,1 );  // id\nfloat  x;",
        "float a;\n// toyproof: no-format\nmat2 m = mat2( 1,0,\n               0,1 );  // id\nfloat x;\n",
    );
    assert_statements(
        "a ;\n// toyproof: no-format\n  if(a){b;}\n  else{c ;}\nd ;",
        "    a;\n    // toyproof: no-format\n  if(a){b;}\n  else{c ;}\n    d;\n",
    );
}

#[test]
fn ends_of_lines_are_those_of_the_text() {
    assert_eq!(formatted("float  a;\r\nfloat b;"), "float a;\r\nfloat b;\r\n");
    assert_eq!(formatted("float  a;\rfloat b;"), "float a;\nfloat b;\n");
    assert_eq!(formatted(""), "");
    assert_eq!(formatted("\n\n \n"), "");
}

#[test]
fn invalid_texts_are_formatted() {
    for text in [
        "}}} float x;",
        "void f( { ) } ;",
        "if (a",
        "/* open",
        "float a = 1.e+",
        "case : default",
        "#if\n#else\n#endif\n#endif",
        "do do while else",
        "'\"@ ` \\ x",
        "f(a;}) {{",
        "struct {",
        "#define",
        "#",
        "a\\\nb; \\\n c;",
        "// toyproof: no-format",
        "x = { a, ; } }",
        "for (;;",
        "else else ;;",
        "\u{feff}float\u{a0}x;",
        "(((\n#if 1\n)))\n#endif\n;",
    ] {
        formatted(text);
    }
}

#[test]
fn nesting_is_limited() {
    for open in ["(", "{", "if (a)\n", "#if 1\n"] {
        let error = format(&open.repeat(5000)).expect_err("the text is too deep");
        assert!(matches!(error, Error::TooDeep(_)), "{open}: {error}");
    }
}
