//! Loops that never end, or not within the time limit.

use super::case::{Case, SLOW, TIMEOUT, body, nested, within};

pub(crate) fn cases() -> Vec<Case> {
    let seven = nested(
        7,
        "for (int i = 0; i < 1000; i++) ",
        "x = fract(x * 1.7 + 0.1);",
        "",
    );
    vec![
        body("a loop without end", TIMEOUT, "for (;;) { } c = vec4(1.0);"),
        body(
            "a loop that only goes on",
            TIMEOUT,
            "for (;;) continue; c = vec4(1.0);",
        ),
        body(
            "do while true",
            TIMEOUT,
            "float x = 0.0; do { x += 1.0; } while (true); c = vec4(x);",
        ),
        body(
            "a loop without a step",
            TIMEOUT,
            "float x = 0.0; for (int i = 0; i < 10;) { x += 0.1; } c = vec4(x);",
        ),
        body(
            "a step that float32 does not take",
            TIMEOUT,
            "float x = 16777216.0; while (x < 16777300.0) { x += 1.0; } c = vec4(x * 1e-8);",
        ),
        body(
            "a condition that is no number",
            TIMEOUT,
            "float x = 0.0 / p.x * 0.0; x = sqrt(-1.0 - p.x); int i = 0; while (!(x > 1.0)) { i++; } c = vec4(float(i));",
        ),
        body(
            "an unsigned number that is never below zero",
            TIMEOUT,
            "uint i = 10u; float x = 0.0; while (i >= 0u) { i--; x += 1.0; } c = vec4(x);",
        ),
        body(
            "a loop without end in one pixel of all",
            TIMEOUT,
            "float x = 0.0; if (p.x < 1.0 && p.y < 1.0) { for (;;) { x += 1.0; } } c = vec4(x);",
        ),
        body(
            "a switch that never leaves its loop",
            TIMEOUT,
            "int s = 0; for (;;) { switch (s) { case 0: s = 1; break; default: s = 0; break; } } c = vec4(1.0);",
        ),
        within(
            "a condition that never returns",
            TIMEOUT,
            "bool f(float x) { while (x > -1.0) { x += 1.0; } return true; }",
            "c = vec4(0.0); if (f(p.x)) { c = vec4(1.0); }",
        ),
        within(
            "two functions that never return",
            TIMEOUT,
            "float f(float x) { for (;;) { x *= 0.5; } return x; } float g(float x) { for (;;) { x = f(x); } return x; }",
            "c = vec4(g(p.x));",
        ),
        body(
            "two thousand million rounds",
            TIMEOUT,
            "float x = p.x; for (int i = 0; i < 2000000000; i++) { x = sin(x) + 0.1; } c = vec4(x);",
        ),
        body(
            "seven loops of a thousand rounds in each other",
            TIMEOUT,
            &format!("float x = p.x; {seven} c = vec4(x);"),
        ),
        body(
            "four thousand million rounds that do nothing",
            SLOW,
            "uint i = 0u; while (i < 4000000000u) { i++; } c = vec4(1.0);",
        ),
        body(
            "sixty thousand rounds of everything",
            SLOW,
            "vec3 x = vec3(p, 1.0); for (int i = 0; i < 60000; i++) { x = normalize(sin(x.yzx) + pow(abs(x), vec3(1.3)) + exp(-x)); } c = vec4(x, 1.0);",
        ),
    ]
}
