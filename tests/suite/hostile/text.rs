//! Malformed texts.

use super::case::{Case, INVALID, OK, body, lines, text, within};

pub(crate) fn cases() -> Vec<Case> {
    let utf16 = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); }".encode_utf16();
    let utf16: Vec<u8> = [0xfeff]
        .into_iter()
        .chain(utf16)
        .flat_map(u16::to_le_bytes)
        .collect();
    let binary: Vec<u8> = (0..200_000_u32)
        .map(|at| (at.wrapping_mul(2_654_435_761) >> 13) as u8)
        .collect();
    vec![
        text("an empty file", INVALID, ""),
        text("a megabyte of NUL bytes", INVALID, vec![0; 1_000_000]),
        body(
            "a NUL byte in a word",
            INVALID,
            "float a\0b = 1.0; c = vec4(a\0b);",
        ),
        body("a NUL byte in a comment", OK, "// a\0b\nc = vec4(1.0);"),
        text(
            "bytes that are no UTF-8",
            INVALID,
            b"void mainImage(out vec4 c, in vec2 p) { c = vec4(\xff\xfe); }".to_vec(),
        ),
        text("half of a surrogate pair", INVALID, b"// \xed\xa0\x80\n".to_vec()),
        text("UTF-16", INVALID, utf16),
        text(
            "a program for the processor",
            INVALID,
            [b"\x7fELF\x02\x01\x01".to_vec(), binary].concat(),
        ),
        text("twenty megabytes of blanks", INVALID, vec![b' '; 20_000_000]),
        text(
            "a comment of a megabyte that never ends",
            INVALID,
            format!("/*{}", "*".repeat(1_000_000)),
        ),
        text("a line of a megabyte", INVALID, "a ".repeat(500_000)),
        text("half a million empty lines", INVALID, "\n".repeat(500_000)),
        body(
            "three hundred thousand continued lines",
            OK,
            &format!("c = {}vec4(1.0);", "\\\n".repeat(300_000)),
        ),
        body(
            "an identifier of a megabyte",
            INVALID,
            &format!("float {} = 1.0; c = vec4(1.0);", "a".repeat(1_000_000)),
        ),
        body(
            "nine hundred identifiers of a thousand letters",
            OK,
            &(lines(900, |at| format!("float {}{at} = 1.0;", "a".repeat(1_000))) + "c = vec4(1.0);"),
        ),
        body(
            "identifiers that look alike",
            INVALID,
            "float \u{430} = 1.0; c = vec4(a);",
        ),
        body(
            "text that runs backwards",
            INVALID,
            "c = vec4(1.0); \u{202e} ;)0.1(4cev = c",
        ),
        body(
            "a float of half a million digits",
            OK,
            &format!("c = vec4(0.{});", "3".repeat(500_000)),
        ),
        body(
            "a float of half a million zeros and a one",
            OK,
            &format!("c = vec4(0.{}1);", "0".repeat(500_000)),
        ),
        body(
            "an exponent of twenty digits",
            OK,
            "c = vec4(1e99999999999999999999);",
        ),
        body(
            "a negative exponent of twenty digits",
            OK,
            "c = vec4(1.0e-99999999999999999999);",
        ),
        body(
            "an integer of half a million digits",
            INVALID,
            &format!("c = vec4({});", "9".repeat(500_000)),
        ),
        body(
            "a hexadecimal number of half a million digits",
            INVALID,
            &format!("c = vec4(0x{});", "f".repeat(500_000)),
        ),
        within(
            "fifty thousand mistakes",
            INVALID,
            &lines(50_000, |at| format!("float a{at} = ;")),
            "c = vec4(undeclared);",
        ),
    ]
}
