//! What a student reads at midnight: typical mistakes, each with the whole message. `UPDATE_EXPECT=1 cargo test mistakes` writes the
//! messages anew; read them aloud before you keep them.

#![expect(clippy::needless_raw_string_hashes, reason = "expect_test writes them")]

use expect_test::{Expect, expect};
use toyproof::diagnostic;
use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};

/// The shader around statements that need one.
fn in_main(statements: &str) -> String {
    format!("void mainImage(out vec4 fragColor, in vec2 fragCoord) {{\n{statements}\n}}\n")
}

/// Everything that is said of a shader, as a terminal shows it.
#[track_caller]
fn told(text: impl Into<String>, wanted: &Expect) {
    let mut files = Files::default();
    let file = files.add(File::new("s.glsl", text));
    let told = match check(&files, file, &Options::default()) {
        Ok(checked) => panic!("accepted, with {:?}", checked.warnings),
        Err(told) => told,
    };
    let all: Vec<_> = told
        .iter()
        .map(|told| diagnostic::human(told, &files, false))
        .collect();
    wanted.assert_eq(&all.concat());
}

#[test]
fn a_missing_semicolon() {
    told(
        in_main(
            r"    vec2 uv = fragCoord / iResolution.xy
    fragColor = vec4(uv, 0.0, 1.0);",
        ),
        &expect![[r#"
            error[E0100]: `;` is missing after `xy`
              ┌─ s.glsl:2:41
              │
            2 │     vec2 uv = fragCoord / iResolution.xy
              │                                         ^ put a `;` here

        "#]],
    );
}

#[test]
fn an_integer_in_a_float() {
    told(
        in_main(
            r"    float x = 1;
    fragColor = vec4(x);",
        ),
        &expect![[r#"
            error[E0301]: the value of `x` must be `float`, and this is `int`
              ┌─ s.glsl:2:15
              │
            2 │     float x = 1;
              │               ^ write `1.0`
              │
              = WebGL2 does not turn `int` into `float` by itself; some desktop drivers do, and so does --lenient

        "#]],
    );
}

#[test]
fn an_integer_beside_a_vector() {
    told(
        in_main(
            r"    vec3 colour = vec3(1.0) / 2;
    fragColor = vec4(colour, 1.0);",
        ),
        &expect![[r#"
            error[E0300]: `/` does not take `vec3` and `int`
              ┌─ s.glsl:2:31
              │
            2 │     vec3 colour = vec3(1.0) / 2;
              │                               ^ write `2.0`
              │
              = WebGL2 does not turn `int` into `float` by itself; some desktop drivers do, and so does --lenient

        "#]],
    );
}

#[test]
fn an_integer_variable_beside_a_float() {
    told(
        in_main(r"    for (int i = 0; i < 4; i++) fragColor += i * 0.1;"),
        &expect![[r#"
            error[E0300]: `*` does not take `int` and `float`
              ┌─ s.glsl:2:46
              │
            2 │     for (int i = 0; i < 4; i++) fragColor += i * 0.1;
              │                                              ^ write `float(i)`
              │
              = WebGL2 does not turn `int` into `float` by itself; some desktop drivers do, and so does --lenient

        "#]],
    );
}

#[test]
fn an_integer_in_a_call() {
    told(
        in_main(r"    fragColor = vec4(pow(2, fragCoord.x));"),
        &expect![[r#"
            error[E0302]: no function `pow(int, float)`; did you mean `pow(float, float)`?
              ┌─ s.glsl:2:22
              │
            2 │     fragColor = vec4(pow(2, fragCoord.x));
              │                      ^^^ - write `2.0`
              │
              = WebGL2 does not turn `int` into `float` by itself; some desktop drivers do, and so does --lenient

        "#]],
    );
}

#[test]
fn a_vector_of_the_wrong_size() {
    told(
        in_main(
            r"    vec3 colour = vec4(1.0);
    fragColor = vec4(colour, 1.0);",
        ),
        &expect![[r#"
            error[E0301]: the value of `colour` must be `vec3`, and this is `vec4`
              ┌─ s.glsl:2:19
              │
            2 │     vec3 colour = vec4(1.0);
              │                   ^^^^^^^^^ `.xyz` behind it takes 3 of its components

        "#]],
    );
}

#[test]
fn a_component_too_few() {
    told(
        in_main(r"    fragColor = vec4(fragCoord, 0.0);"),
        &expect![[r#"
        error[E0303]: `vec4` has 4 components and is given 3
          ┌─ s.glsl:2:17
          │
        2 │     fragColor = vec4(fragCoord, 0.0);
          │                 ^^^^^^^^^^^^^^^^^^^^

    "#]],
    );
}

#[test]
fn vectors_of_two_sizes() {
    told(
        in_main(
            r"    vec2 uv = fragCoord / iResolution;
    fragColor = vec4(uv, 0.0, 1.0);",
        ),
        &expect![[r#"
            error[E0300]: `/` does not take `vec2` and `vec3`
              ┌─ s.glsl:2:27
              │
            2 │     vec2 uv = fragCoord / iResolution;
              │                           ^^^^^^^^^^^ write `iResolution.xy`

        "#]],
    );
}

#[test]
fn a_name_that_is_not_declared() {
    told(
        in_main(
            r"    vec3 color = vec3(1.0);
    fragColor = vec4(colour, 1.0);",
        ),
        &expect![[r#"
            error[E0200]: `colour` is not declared; did you mean `color`?
              ┌─ s.glsl:3:22
              │
            3 │     fragColor = vec4(colour, 1.0);
              │                      ^^^^^^

        "#]],
    );
}

#[test]
fn a_misspelt_built_in_function() {
    told(
        in_main(r"    fragColor = vec4(smoothStep(0.0, 1.0, fragCoord.x));"),
        &expect![[r#"
            error[E0200]: there is no function `smoothStep`; did you mean `smoothstep`?
              ┌─ s.glsl:2:22
              │
            2 │     fragColor = vec4(smoothStep(0.0, 1.0, fragCoord.x));
              │                      ^^^^^^^^^^

        "#]],
    );
}

#[test]
fn a_misspelt_input() {
    told(
        in_main(r"    fragColor = vec4(sin(itime));"),
        &expect![[r#"
        error[E0200]: `itime` is not declared; did you mean `iTime`?
          ┌─ s.glsl:2:26
          │
        2 │     fragColor = vec4(sin(itime));
          │                          ^^^^^

    "#]],
    );
}

#[test]
fn names_of_another_language() {
    told(
        in_main(
            r"    float3 a = lerp(float3(0.0), saturate(float3(1.0)), frac(iTime));
    fragColor = float4(a, 1.0);",
        ),
        &expect![[r#"
            error[E0200]: there is no type `float3`
              ┌─ s.glsl:2:5
              │
            2 │     float3 a = lerp(float3(0.0), saturate(float3(1.0)), frac(iTime));
              │     ^^^^^^ write `vec3`
              │
              = `float3` belongs to HLSL

            error[E0200]: there is no function `lerp`
              ┌─ s.glsl:2:16
              │
            2 │     float3 a = lerp(float3(0.0), saturate(float3(1.0)), frac(iTime));
              │                ^^^^ write `mix`
              │
              = `lerp` belongs to HLSL

            error[E0200]: there is no function `float3`
              ┌─ s.glsl:2:21
              │
            2 │     float3 a = lerp(float3(0.0), saturate(float3(1.0)), frac(iTime));
              │                     ^^^^^^ write `vec3`
              │
              = `float3` belongs to HLSL

            error[E0200]: there is no function `saturate`
              ┌─ s.glsl:2:34
              │
            2 │     float3 a = lerp(float3(0.0), saturate(float3(1.0)), frac(iTime));
              │                                  ^^^^^^^^ write `clamp(x, 0.0, 1.0)`
              │
              = `saturate` belongs to HLSL

            error[E0200]: there is no function `frac`
              ┌─ s.glsl:2:57
              │
            2 │     float3 a = lerp(float3(0.0), saturate(float3(1.0)), frac(iTime));
              │                                                         ^^^^ write `fract`
              │
              = `frac` belongs to HLSL

            error[E0200]: there is no function `float4`
              ┌─ s.glsl:3:17
              │
            3 │     fragColor = float4(a, 1.0);
              │                 ^^^^^^ write `vec4`
              │
              = `float4` belongs to HLSL

        "#]],
    );
}

#[test]
fn names_of_old_glsl() {
    told(
        in_main(r"    gl_FragColor = texture2D(iChannel0, fragCoord);"),
        &expect![[r#"
            error[E0200]: `gl_FragColor` is not declared
              ┌─ s.glsl:2:5
              │
            2 │     gl_FragColor = texture2D(iChannel0, fragCoord);
              │     ^^^^^^^^^^^^ write `fragColor`, or as you call the first parameter of `mainImage`
              │
              = `gl_FragColor` belongs to GLSL ES 1.00

            error[E0200]: there is no function `texture2D`
              ┌─ s.glsl:2:20
              │
            2 │     gl_FragColor = texture2D(iChannel0, fragCoord);
              │                    ^^^^^^^^^ write `texture`
              │
              = `texture2D` belongs to GLSL ES 1.00

        "#]],
    );
}

#[test]
fn a_function_without_return() {
    told(
        r"float square(float x) {
    float y = x * x;
}
void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
",
        &expect![[r#"
            error[E0308]: `square` never returns a value
              ┌─ s.glsl:1:7
              │
            1 │ float square(float x) {
              │       ^^^^^^
              │
              = end it with `return …;` and a `float`, or make it `void`

        "#]],
    );
}

#[test]
fn a_return_of_the_wrong_type() {
    told(
        r"float brightness(vec3 colour) {
    return colour;
}
void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
",
        &expect![[r#"
            error[E0308]: `brightness` returns `float`, and this is `vec3`
              ┌─ s.glsl:2:12
              │
            2 │     return colour;
              │            ^^^^^^ take one component, such as `colour.x`

        "#]],
    );
}

#[test]
fn an_assignment_to_a_uniform() {
    told(
        in_main(
            r"    iTime += 1.0;
    fragColor = vec4(iTime);",
        ),
        &expect![[r#"
            error[E0400]: `iTime` is a uniform and cannot be assigned to
              ┌─ s.glsl:2:5
              │
            2 │     iTime += 1.0;
              │     ^^^^^
              │
              = give a variable of your own its value and change that: `float mine = iTime;`

        "#]],
    );
}

#[test]
fn an_assignment_to_a_constant() {
    told(
        in_main(
            r"    const float gain = 2.0;
    gain = 3.0;
    fragColor = vec4(gain);",
        ),
        &expect![[r#"
            error[E0400]: `gain` is a constant and cannot be assigned to
              ┌─ s.glsl:3:5
              │
            2 │     const float gain = 2.0;
              │                 ---- declared here
            3 │     gain = 3.0;
              │     ^^^^
              │
              = leave `const` out of its declaration if it is to change

        "#]],
    );
}

#[test]
fn a_missing_brace() {
    told(
        r"float clamped(float x) {
    if (x > 1.0) {
        x = 1.0;
    return x;
}

void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
",
        &expect![[r#"
            error[E0105]: this `{` is never closed
              ┌─ s.glsl:2:18
              │
            2 │     if (x > 1.0) {
              │                  ^
            3 │         x = 1.0;
            4 │     return x;
              │     ------ its `}` is missing before this

        "#]],
    );
}

#[test]
fn a_missing_brace_at_the_end() {
    told(
        r"float twice(float x) {
    return 2.0 * x;

void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
",
        &expect![[r#"
            error[E0105]: this `{` is never closed
              ┌─ s.glsl:1:22
              │
            1 │ float twice(float x) {
              │                      ^
              ·
            4 │ void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
              │ ---- its `}` is missing before this

        "#]],
    );
}

#[test]
fn a_missing_parenthesis() {
    told(
        in_main(
            r"    float x = sin(cos(iTime);
    fragColor = vec4(x);",
        ),
        &expect![[r#"
            error[E0105]: this `(` is never closed
              ┌─ s.glsl:2:18
              │
            2 │     float x = sin(cos(iTime);
              │                  ^          - its `)` is missing before this

        "#]],
    );
}

#[test]
fn recursion() {
    told(
        r"vec3 shade(vec3 ray, int depth) {
    if (depth == 0) return vec3(0.0);
    return 0.5 * shade(reflect(ray, vec3(0, 1, 0)), depth - 1);
}
void mainImage(out vec4 c, in vec2 p) { c = vec4(shade(vec3(p, 1.0), 3), 1.0); }
",
        &expect![[r#"
            error[E0404]: by this call, `shade` comes to call itself
              ┌─ s.glsl:3:18
              │
            3 │     return 0.5 * shade(reflect(ray, vec3(0, 1, 0)), depth - 1);
              │                  ^^^^^
              │
              = GLSL has no stack, so no function may call itself: use a loop

        "#]],
    );
}

#[test]
fn a_reserved_word() {
    told(
        in_main(
            r"    vec4 sample = texture(iChannel0, fragCoord);
    fragColor = sample;",
        ),
        &expect![[r#"
            error[E0104]: `sample` is a word that GLSL reserves
              ┌─ s.glsl:2:10
              │
            2 │     vec4 sample = texture(iChannel0, fragCoord);
              │          ^^^^^^ choose another name

        "#]],
    );
}

#[test]
fn an_argument_too_few() {
    told(
        r"float box(vec3 p, vec3 size) { return length(max(abs(p) - size, 0.0)); }
void mainImage(out vec4 c, in vec2 p) { c = vec4(box(vec3(p, 0.0))); }
",
        &expect![[r#"
            error[E0302]: `box` takes 2 arguments and is given 1
              ┌─ s.glsl:2:50
              │
            1 │ float box(vec3 p, vec3 size) { return length(max(abs(p) - size, 0.0)); }
              │       --- `box(vec3, vec3)` is declared here
            2 │ void mainImage(out vec4 c, in vec2 p) { c = vec4(box(vec3(p, 0.0))); }
              │                                                  ^^^

        "#]],
    );
}

#[test]
fn an_argument_of_the_wrong_type() {
    told(
        r"struct Ray { vec3 origin, direction; };
struct Sphere { vec3 centre; float radius; };
float hit(Ray ray, Sphere sphere) { return distance(ray.origin, sphere.centre) - sphere.radius; }
void mainImage(out vec4 c, in vec2 p) {
    Ray ray = Ray(vec3(0.0), vec3(p, 1.0));
    c = vec4(hit(ray, 1));
}
",
        &expect![[r#"
            error[E0302]: no function `hit(Ray, int)`; did you mean `hit(Ray, Sphere)`?
              ┌─ s.glsl:6:14
              │
            3 │ float hit(Ray ray, Sphere sphere) { return distance(ray.origin, sphere.centre) - sphere.radius; }
              │       --- `hit(Ray, Sphere)` is declared here
              ·
            6 │     c = vec4(hit(ray, 1));
              │              ^^^      - this is `int`, not `Sphere`

        "#]],
    );
}

#[test]
fn a_misspelt_member() {
    told(
        r"struct Ray { vec3 origin, direction; };
void mainImage(out vec4 c, in vec2 p) {
    Ray ray = Ray(vec3(0.0), vec3(p, 1.0));
    c = vec4(ray.direcion, 1.0);
}
",
        &expect![[r#"
            error[E0203]: `Ray` has no member `direcion`; did you mean `direction`?
              ┌─ s.glsl:4:18
              │
            4 │     c = vec4(ray.direcion, 1.0);
              │                  ^^^^^^^^
              │
              = its members are `origin`, `direction`

        "#]],
    );
}

#[test]
fn a_misspelt_type() {
    told(
        r"vec5 palette(flaot t) { return vec3(t); }
void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
",
        &expect![[r#"
            error[E0200]: there is no type `vec5`; did you mean `vec2`?
              ┌─ s.glsl:1:1
              │
            1 │ vec5 palette(flaot t) { return vec3(t); }
              │ ^^^^

            error[E0200]: there is no type `flaot`; did you mean `float`?
              ┌─ s.glsl:1:14
              │
            1 │ vec5 palette(flaot t) { return vec3(t); }
              │              ^^^^^

        "#]],
    );
}

#[test]
fn an_assignment_as_condition() {
    told(
        in_main(
            r"    float x = 1.0;
    if (x = 2.0) x = 3.0;
    fragColor = vec4(x);",
        ),
        &expect![[r#"
            error[E0301]: a condition must be `bool`, and this is `float`
              ┌─ s.glsl:3:9
              │
            3 │     if (x = 2.0) x = 3.0;
              │         ^^^^^^^ `=` assigns; to compare write `==`

        "#]],
    );
}

#[test]
fn a_remainder_of_floats() {
    told(
        in_main(
            r"    float stripe = fragCoord.x % 10.0;
    fragColor = vec4(stripe);",
        ),
        &expect![[r#"
            error[E0300]: `%` does not take `float` and `float`
              ┌─ s.glsl:2:20
              │
            2 │     float stripe = fragCoord.x % 10.0;
              │                    ^^^^^^^^^^^^^^^^^^
              │
              = `%` is for integers; for floats write `mod(a, b)`

        "#]],
    );
}

#[test]
fn a_power_in_the_manner_of_mathematics() {
    told(
        in_main(r"    fragColor = vec4(iTime ^ 2.0);"),
        &expect![[r#"
        error[E0300]: `^` does not take `float` and `float`
          ┌─ s.glsl:2:22
          │
        2 │     fragColor = vec4(iTime ^ 2.0);
          │                      ^^^^^^^^^^^
          │
          = `^` combines bits; for a power write `pow(a, b)`, for a square `a * a`

    "#]],
    );
}

#[test]
fn a_comparison_in_the_manner_of_mathematics() {
    told(
        in_main(r"    if (0.0 < fragCoord.x < 10.0) fragColor = vec4(1.0);"),
        &expect![[r#"
            error[E0300]: `<` does not take `bool` and `float`
              ┌─ s.glsl:2:9
              │
            2 │     if (0.0 < fragCoord.x < 10.0) fragColor = vec4(1.0);
              │         ^^^^^^^^^^^^^^^^^^^^^^^^
              │
              = `a < b < c` is written `a < b && b < c`

        "#]],
    );
}

#[test]
fn an_array_whose_size_is_computed() {
    told(
        in_main(
            r"    int n = 3;
    float samples[n];
    fragColor = vec4(samples[0]);",
        ),
        &expect![[r#"
            error[E0305]: the size of an array must be a constant expression
              ┌─ s.glsl:3:19
              │
            3 │     float samples[n];
              │                   ^
              │
              = `const int n = …;` makes it one

        "#]],
    );
}

#[test]
fn an_index_out_of_range() {
    told(
        in_main(
            r"    float weights[3];
    fragColor = vec4(weights[3]);",
        ),
        &expect![[r#"
            error[E0304]: the index 3 is out of range: `float[3]` has 3 elements
              ┌─ s.glsl:3:30
              │
            3 │     fragColor = vec4(weights[3]);
              │                              ^ the last one is 2

        "#]],
    );
}

#[test]
fn a_component_that_is_not_there() {
    told(
        in_main(r"    fragColor = vec4(fragCoord.z);"),
        &expect![[r#"
            error[E0203]: `.z` selects no components of `vec2`
              ┌─ s.glsl:2:32
              │
            2 │     fragColor = vec4(fragCoord.z);
              │                                ^ it has `.xy`

        "#]],
    );
}

#[test]
fn a_list_in_braces() {
    told(
        in_main(
            r"    float weights[3] = { 1.0, 2.0, 1.0 };
    fragColor = vec4(weights[0]);",
        ),
        &expect![[r#"
            error[E0100]: expected an expression, found `{`
              ┌─ s.glsl:2:24
              │
            2 │     float weights[3] = { 1.0, 2.0, 1.0 };
              │                        ^
              │
              = GLSL ES has no lists in braces: write `vec3(…)` for a vector, `float[](…)` for an array

        "#]],
    );
}

#[test]
fn an_else_if_of_another_language() {
    told(
        in_main(
            r"    float x = 0.0;
    if (fragCoord.x > 1.0) {
        x = 1.0;
    } elif (fragCoord.y > 2.0) {
        x = 2.0;
    } else {
        x = 3.0;
    }
    fragColor = vec4(x);",
        ),
        &expect![[r#"
            error[E0100]: GLSL has no `elif`
              ┌─ s.glsl:5:7
              │
            5 │     } elif (fragCoord.y > 2.0) {
              │       ^^^^ write `else if`

        "#]],
    );
}

#[test]
fn a_decimal_comma() {
    told(
        in_main(
            r"    vec3 sky = vec3(0,5, 0.5, 0.45);
    float gain = 0,5;
    fragColor = vec4(sky * clamp(0,5, 0.0, 1.0), vec2(1, 2, 3));",
        ),
        &expect![[r#"
            error[E0303]: `vec3` has 3 components and is given more
              ┌─ s.glsl:2:16
              │
            2 │     vec3 sky = vec3(0,5, 0.5, 0.45);
              │                ^^^^^^^^^^^^^^^^^^^^
              │
              = is `0,5` one number? write `0.5`: GLSL has a decimal point

            error[E0100]: expected a name, found `5`
              ┌─ s.glsl:3:20
              │
            3 │     float gain = 0,5;
              │                    ^ write `0.5`: GLSL has a decimal point

            error[E0302]: `clamp` takes 3 arguments and is given 4
              ┌─ s.glsl:4:28
              │
            4 │     fragColor = vec4(sky * clamp(0,5, 0.0, 1.0), vec2(1, 2, 3));
              │                            ^^^^^
              │
              = is `0,5` one number? write `0.5`: GLSL has a decimal point

            error[E0303]: `vec2` has 2 components and is given more
              ┌─ s.glsl:4:50
              │
            4 │     fragColor = vec4(sky * clamp(0,5, 0.0, 1.0), vec2(1, 2, 3));
              │                                                  ^^^^^^^^^^^^^

        "#]],
    );
}

#[test]
fn a_structure_without_its_end() {
    let main = in_main("    fragColor = vec4(Ball(vec3(0.0), 1.0).at, LIMIT);");
    told(
        format!(
            "struct Ray {{\n    vec3 at;\n    vec3 to;\n\nstruct Ball {{\n    vec3 at;\n    float r;\n;\n\n\
             const float LIMIT = 1.0;\n\n{main}"
        ),
        &expect![[r#"
            error[E0105]: this `{` is never closed
              ┌─ s.glsl:1:12
              │
            1 │ struct Ray {
              │            ^
              ·
            5 │ struct Ball {
              │ ------ its `}` is missing before this

            error[E0105]: this `{` is never closed
              ┌─ s.glsl:5:13
              │
            5 │ struct Ball {
              │             ^
              ·
            8 │ ;
              │ - its `}` is missing before this

        "#]],
    );
}

#[test]
fn a_cast_of_c() {
    told(
        in_main(
            r"    int column = 3;
    fragColor = vec4((float) column);",
        ),
        &expect![[r#"
            error[E0100]: GLSL has no casts: write `float(…)` around the value
              ┌─ s.glsl:3:23
              │
            3 │     fragColor = vec4((float) column);
              │                       ^^^^^

        "#]],
    );
}

#[test]
fn a_constructor_of_c_plus_plus() {
    told(
        in_main(
            r"    vec3 colour(1.0, 0.5, 0.0);
    fragColor = vec4(colour, 1.0);",
        ),
        &expect![[r#"
            error[E0100]: a function cannot be declared inside of a function
              ┌─ s.glsl:2:10
              │
            2 │     vec3 colour(1.0, 0.5, 0.0);
              │          ^^^^^^
              │
              = a variable gets its value by `vec3 colour = vec3(…);`

        "#]],
    );
}

#[test]
fn a_global_set_from_a_uniform_needs_a_function() {
    told(
        in_main(
            r"    fragColor = vec4(1.0);
}
float speed = 2.0 * iTime;
void f() {",
        ),
        &expect![[r#"
            error[E0401]: the value of the global `speed` is not a constant expression
              ┌─ s.glsl:4:15
              │
            4 │ float speed = 2.0 * iTime;
              │               ^^^^^^^^^^^
              │
              = globals are set before the shader runs: set this one in `mainImage`, or use --lenient

        "#]],
    );
}

#[test]
fn a_mistake_in_a_macro() {
    told(
        r"#define SQUARE(x) (x * x * 1)
void mainImage(out vec4 c, in vec2 p) {
    c = vec4(SQUARE(p.x));
}
",
        &expect![[r#"
            error[E0300]: `*` does not take `float` and `int`
              ┌─ s.glsl:3:14
              │
            1 │ #define SQUARE(x) (x * x * 1)
              │                            - write `1.0`
            2 │ void mainImage(out vec4 c, in vec2 p) {
            3 │     c = vec4(SQUARE(p.x));
              │              ^^^^^^^^^^^
              │
              = WebGL2 does not turn `int` into `float` by itself; some desktop drivers do, and so does --lenient

        "#]],
    );
}

#[test]
fn main_instead_of_main_image() {
    told(
        r"void main() {
    gl_FragColor = vec4(1.0);
}
",
        &expect![[r#"
            error[E0201]: `main` is ShaderToy's own
              ┌─ s.glsl:1:6
              │
            1 │ void main() {
              │      ^^^^
              │
              = it calls `void mainImage(out vec4 fragColor, in vec2 fragCoord)` for each pixel: write that one

            error[E0200]: `gl_FragColor` is not declared
              ┌─ s.glsl:2:5
              │
            2 │     gl_FragColor = vec4(1.0);
              │     ^^^^^^^^^^^^ write `fragColor`, or as you call the first parameter of `mainImage`
              │
              = `gl_FragColor` belongs to GLSL ES 1.00

        "#]],
    );
}

#[test]
fn a_function_used_before_it_is_declared() {
    told(
        r"void mainImage(out vec4 c, in vec2 p) { c = vec4(noise(p)); }
float noise(vec2 p) { return fract(p.x * 7.3); }
",
        &expect![[r#"
            error[E0200]: `noise` is used before it is declared
              ┌─ s.glsl:1:50
              │
            1 │ void mainImage(out vec4 c, in vec2 p) { c = vec4(noise(p)); }
              │                                                  ^^^^^
            2 │ float noise(vec2 p) { return fract(p.x * 7.3); }
              │       ----- declared here, too late
              │
              = a name can be used only after its declaration: move that up

        "#]],
    );
}

#[test]
fn a_varying() {
    told(
        r"varying vec2 uv;
void mainImage(out vec4 c, in vec2 p) { c = vec4(uv, 0.0, 1.0); }
",
        &expect![[r#"
            error[E0104]: `varying` is a word that GLSL reserves
              ┌─ s.glsl:1:1
              │
            1 │ varying vec2 uv;
              │ ^^^^^^^ write `in`; but ShaderToy has no inputs except its own
              │
              = `varying` belongs to GLSL ES 1.00

        "#]],
    );
}

#[test]
fn a_quotation_mark_and_a_dash() {
    told(
        r"void mainImage(out vec4 c, in vec2 p) {
    float x = 1.0 – 0.5;
    c = vec4(x);
}
",
        &expect![[r#"
            error[E0001]: `–` is no character of GLSL
              ┌─ s.glsl:2:19
              │
            2 │     float x = 1.0 – 0.5;
              │                   ^ write `-`

        "#]],
    );
}

#[test]
fn several_at_once() {
    told(
        in_main(
            r"    vec2 uv = fragCoord / iResolution.xy
    vec3 colour = vec3(uv, 0);
    colour *= 2;
    if (colur.x > 1.0 { colour.x = 1.0; }
    fragColor = vec4(colour);",
        ),
        &expect![[r#"
            error[E0100]: `;` is missing after `xy`
              ┌─ s.glsl:2:41
              │
            2 │     vec2 uv = fragCoord / iResolution.xy
              │                                         ^ put a `;` here

            error[E0300]: `*=` does not take `vec3` and `int`
              ┌─ s.glsl:4:15
              │
            4 │     colour *= 2;
              │               ^ write `2.0`
              │
              = WebGL2 does not turn `int` into `float` by itself; some desktop drivers do, and so does --lenient

            error[E0105]: this `(` is never closed
              ┌─ s.glsl:5:8
              │
            5 │     if (colur.x > 1.0 { colour.x = 1.0; }
              │        ^              - its `)` is missing before this

            error[E0303]: `vec4` has 4 components and is given 3
              ┌─ s.glsl:6:17
              │
            6 │     fragColor = vec4(colour);
              │                 ^^^^^^^^^^^^ write `vec4(colour, 1.0)`

        "#]],
    );
}
