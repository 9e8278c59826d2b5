use expect_test::{Expect, expect};
use toyproof_diagnostic::{Deadline, File, Files};
use toyproof_glsl::{Options, check};

use super::names::Names;
use super::writer::{Facts, Writer};
use super::{CaseLabels, LoweringContext, Order, Style, Unprintable, WriteFailure, wgsl};

fn print(shader: &str, style: Style) -> String {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default()).unwrap();
    wgsl(&checked, &files, style, &Deadline::default()).unwrap_or_else(|why| why.to_string())
}

#[test]
fn printing_stops_after_the_deadline() {
    let mut files = Files::default();
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, p); }";
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default()).unwrap();
    let over = Deadline::after(std::time::Duration::ZERO);
    let late = wgsl(&checked, &files, Style::Plain, &over);
    assert!(matches!(late, Err(WriteFailure::Overdue(_))), "{late:?}");

    // Each value, statement and item checks the deadline.
    let cx = LoweringContext::new(&checked);
    let order = Order::new(&cx, CaseLabels::AsWritten);
    let names = Names::new(&cx, &order, Style::Plain);
    let facts = Facts::new(&cx);
    let mut writer = Writer::new(&cx, &names, &facts, &order, Style::Plain, &files, &over);
    let body = checked.tree[checked.main_image].body.as_ref().unwrap();
    let value = checked.tree.exprs.ids().next().unwrap();
    assert!(writer.value(value).is_err());
    assert!(writer.statements(body).is_err());
    assert!(writer.item(order.items[0]).is_err());
}

/// Checks the function `f` of a shader that calls it.
fn function(text: &str, expected: &Expect) {
    let shader = format!("{text}\nvoid mainImage(out vec4 c, in vec2 p) {{ c = vec4(f(p)); }}");
    let whole = print(&shader, Style::Plain);
    let from = whole.find("fn f(").unwrap_or_else(|| panic!("{whole}"));
    let to = whole[from..].find("\n}\n").unwrap() + from;
    expected.assert_eq(&format!("{}\n}}\n", &whole[from..to]));
}

#[test]
fn a_shader_keeps_its_names_and_comments() {
    let shader = "// A license.

#define STEPS 3
/* How far
 * it goes. */
float far(vec2 p) {
    // Not near.
    return p.x * iTime + float(STEPS); // behind
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fragColor = vec4(far(fragCoord), iMouse.xy, 1.);
}
";
    expect![[r"
        // A license.

        struct Inputs {
            // `@size` skips inputs that the shader does not read.
            iResolution: vec3f,
            @size(148) iTime: f32,
            iMouse: vec4f,
        }

        @group(0) @binding(0) var<uniform> inputs: Inputs;

        const STEPS: i32 = 3;

        // How far
        // it goes.
        fn far(p: vec2f) -> f32 {
            // Not near.
            return p.x * inputs.iTime + f32(STEPS); // behind
        }

        fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
            *fragColor = vec4f(far(fragCoord), inputs.iMouse.xy, 1.0);
        }

        @fragment
        fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
            var color: vec4f;
            // Row 0 of the target is the bottom of the image, as in ShaderToy.
            mainImage(&color, position.xy);
            return vec4f(color.xyz, 1.0);
        }
    "]]
    .assert_eq(&print(shader, Style::Plain));
}

#[test]
fn side_effects_precede_their_statement() {
    function(
        "float f(vec2 p) { int i = 0; float a; a = (p.yx *= 2.0, p.x) + float(i++); return i > 0 ? a : p.y; }",
        &expect![[r"
            fn f(p_in: vec2f) -> f32 {
                var p = p_in;
                var i = 0;
                var a: f32;
                let yx = p.yx * 2.0;
                p = vec2f(yx.y, yx.x);
                a = p.x + f32(i);
                i++;
                return select(p.y, a, i > 0);
            }
        "]],
    );
}

#[test]
fn loops_keep_their_form_where_wgsl_has_it() {
    function(
        "float f(vec2 p) {
            float s = 0.1 * 0.2;
            for (int i = 0, j = 9; i < j; i++, j--) s += p.x;
            while (s < 3.0) s *= 2.0;
            do { s -= 1.0; } while (s > 1.0);
            return s;
        }",
        &expect![[r"
            fn f(p: vec2f) -> f32 {
                var s = 0.1f * 0.2f;
                {
                    var i = 0;
                    var j = 9;
                    loop {
                        if i >= j {
                            break;
                        }
                        s += p.x;
                        continuing {
                            i++;
                            j--;
                        }
                    }
                }
                while s < 3.0 {
                    s *= 2.0;
                }
                loop {
                    s -= 1.0;
                    if !(s > 1.0) {
                        break;
                    }
                }
                return s;
            }
        "]],
    );
}

#[test]
fn unwritten_variables_are_not_bound_and_conditions_are_inverted() {
    function(
        "float f(vec2 p) {
            const int most = max(3, 4), last = most - 1;
            float b = p.x;
            for (int i = 0; i++ < last;) b = mix(p.y, b, b++);
            return b;
        }",
        &expect![[r"
            fn f(p: vec2f) -> f32 {
                let most = max(3i, 4i);
                let last = most - 1;
                var b = p.x;
                {
                    var i = 0;
                    loop {
                        let old_i = i;
                        i++;
                        if old_i >= last {
                            break;
                        }
                        let old_b = b;
                        let old_b_1 = b;
                        b += 1.0;
                        b = mix(p.y, old_b, old_b_1);
                    }
                }
                return b;
            }
        "]],
    );
}

#[test]
fn reserved_words_and_overloads_are_renamed() {
    function(
        "float loop(float fn) { return fn; }
        float loop(vec2 fn) { return fn.x; }
        float f(vec2 p) { float var = loop(p) + loop(p.x); return var; }",
        &expect![[r"
            fn f(p: vec2f) -> f32 {
                let var_1 = loop_2(p) + loop_1(p.x);
                return var_1;
            }
        "]],
    );
}

#[test]
fn unsupported_inputs_and_derivatives_are_refused() {
    let cases = [
        (
            "c = vec4(0.0);\nc += iDate;",
            Style::ComputeToys,
            3,
            "`iDate` is not available in the style `compute-toys`",
        ),
        (
            "c = vec4(iChannelTime[1]);",
            Style::WgpuShadertoy,
            2,
            "`iChannelTime` is not available in the style `wgpu-shadertoy`",
        ),
        (
            "c = vec4(dFdx(p.x));",
            Style::ComputeToys,
            2,
            "`dFdx` is not available in the style `compute-toys`",
        ),
        (
            "c = textureLod(iChannel2, p, 0.0);",
            Style::ComputeToys,
            2,
            "`iChannel2` is not available in the style `compute-toys`",
        ),
        (
            "c = texture(iChannel0, vec3(p, 1.0));",
            Style::Bevy,
            2,
            "`iChannel0`, a `samplerCube`, is not available in the style `bevy`",
        ),
    ];
    for (body, style, line, message) in cases {
        let mut files = Files::default();
        let text = format!("void mainImage(out vec4 c, in vec2 p) {{\n{body}\n}}");
        let file = files.add(File::new("shader", text));
        let checked = check(&files, file, &Options::default()).unwrap();
        match wgsl(&checked, &files, style, &Deadline::default()) {
            Err(WriteFailure::Unprintable(Unprintable::Host(diagnostic))) => {
                assert_eq!(diagnostic.message, message);
                assert_eq!(files.position(diagnostic.span.unwrap()).line, line, "{message}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn bevy_declares_the_inputs_of_the_material() {
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = iMouse + iDate * iTime; }";
    let text = print(shader, Style::Bevy);
    let block = "struct Inputs {\n    iMouse: vec4f,\n    iDate: vec4f,\n}\n\
                 @group(#{MATERIAL_BIND_GROUP}) @binding(8) var<uniform> inputs: Inputs;\n";
    assert!(text.contains(block), "{text}");
    assert!(
        text.contains("inputs.iMouse + inputs.iDate * globals.time"),
        "{text}"
    );
    let without = print(&shader.replace("iMouse + iDate", "vec4(1.0)"), Style::Bevy);
    assert!(!without.contains("nputs"), "{without}");
    let all = "void mainImage(out vec4 c, in vec2 p) {
        c = iMouse + iDate + iFrameRate + iChannelTime[1] + iChannelResolution[2].x;
    }";
    let hosted = Style::Bevy.hosted(&print(all, Style::Bevy)).text;
    let read = crate::naga_ir::ValidModule::of_wgsl(&hosted);
    assert!(read.is_ok(), "{read:?}\n{hosted}");
}

#[test]
fn compute_toys_maps_the_mouse() {
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = iMouse; }";
    let text = print(shader, Style::ComputeToys);
    assert!(
        text.contains("= shadertoy_mouse();") && text.contains("mouse.click != 0"),
        "{text}"
    );
    let without = print(&shader.replace("iMouse", "vec4(1.0)"), Style::ComputeToys);
    assert!(!without.contains("mouse"), "{without}");
}

#[test]
fn all_code_of_a_style_is_wgsl_in_its_host() {
    let shader = "float steps = 0.0;
        void mainImage(inout vec4 c, in vec2 p) {
            steps += iTime + float(iFrame) + iMouse.z;
            c += textureLod(iChannel0, p / iResolution.xy, 0.0) + textureLod(iChannel1, gl_FragCoord.zw, steps);
        }";
    for style in Style::ALL {
        let text = print(shader, style);
        let hosted = style.hosted(&text).text;
        let read = crate::naga_ir::ValidModule::of_wgsl(&hosted);
        assert!(read.is_ok(), "{}: {read:?}\n{hosted}", style.name());
        assert!(
            text.contains("gl_FragCoord = ") && text.contains("var color: vec4f = "),
            "{text}"
        );
    }
}

#[test]
fn dfdy_is_negated_where_y_points_down() {
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(dFdy(p.y)); }";
    assert!(print(shader, Style::Plain).contains("vec4f(dpdy(p.y))"));
    for style in [Style::WgpuShadertoy, Style::Bevy] {
        assert!(print(shader, style).contains("vec4f(-dpdy(p.y))"));
    }
}

#[test]
fn unobserved_steps_are_deferred_and_only_effectful_conditionals_become_ifs() {
    function(
        "float g(float x) { return x * 2.0; }
        float pick(vec2 p, int i) { return i > 2 ? g(p.x) : i > 1 ? g(p.y) : p.x; }
        float f(vec2 p) {
            float stack[4];
            int top = 0, i = 1;
            stack[top++] = pick(p, top);
            stack[top++] = p.y;
            float a = i++ > 0 ? g(p.x) : p.y;
            a += p.x > 0.0 ? g(a) : 1.0;
            vec2 b = g(a) > 1.0 ? p : p.yx;
            return stack[--top] + a * b.x;
        }",
        &expect![[r"
            fn f(p: vec2f) -> f32 {
                var stack: array<f32, 4>;
                var top = 0;
                var i = 1;
                let old_top = top;
                top++;
                stack[old_top] = pick(p, top);
                stack[top] = p.y;
                top++;
                var a: f32;
                if i > 0 {
                    a = g(p.x);
                } else {
                    a = p.y;
                }
                i++;
                if p.x > 0.0 {
                    a += g(a);
                } else {
                    a += 1.0;
                }
                let b = select(p.yx, p, g(a) > 1.0);
                top--;
                return stack[top] + a * b.x;
            }
        "]],
    );
}

#[test]
fn cases_keep_named_labels_and_fall_through() {
    function(
        "const int NEAR = 0, MIDDLE = 1;
        const int FAR = 2;
        float f(vec2 p) {
            switch (int(p.x)) {
            case NEAR: p.y *= 0.5;
            case MIDDLE: return p.y;
            case FAR:
            default: break;
            }
            return 1.0;
        }",
        &expect![[r"
            fn f(p_in: vec2f) -> f32 {
                var p = p_in;
                let selector = i32(p.x);
                switch selector {
                    case NEAR, MIDDLE: {
                        let reached = selector == NEAR;
                        if reached {
                            p.y *= 0.5;
                        }
                        return p.y;
                    }
                    case FAR, default: {}
                }
                return 1.0;
            }
        "]],
    );
}

#[test]
fn letters_bits_blank_lines_and_comments_are_preserved() {
    function(
        "float f(vec2 p) {
            vec4 color = vec4(p, 0.0, 1.0); // red and green

            // The other way.
            color.bg = color.rb;
            float distance = length(p), length = 0.1; /* hidden */
            int bits = 2;
            bits = 0x0fF & int(p.x) << 3 >> bits;
            color.xz *= mod(p.x * 2.0, length) * mod(p, 2.0).x;
            color /= distance;
            return color.a + float(bits % 3);
        }",
        &expect![[r"
            fn f(p: vec2f) -> f32 {
                var color = vec4f(p, 0.0, 1.0); // red and green

                // The other way.
                let bg = color.rb;
                color = vec4f(color.r, bg.g, bg.r, color.a);
                let distance = length(p);
                let length_1 = 0.1; // hidden
                var bits = 2;
                bits = 0x0fF & ((i32(p.x) << 3u) >> u32(bits));
                let xz = color.xz * (modulo(p.x * 2.0, length_1) * modulo_vec2f(p, vec2f(2.0)).x);
                color = vec4f(xz.x, color.y, xz.y, color.w);
                color /= distance;
                return color.a + f32(remainder(bits, 3));
            }
        "]],
    );
}

#[test]
fn a_call_that_may_change_the_target_comes_first() {
    function(
        "float seed;
        float next() { return seed += 1.0; }
        float twice(inout float x) { return x *= 2.0; }
        float f(vec2 p) {
            float x = p.x;
            x += next();
            x += twice(x);
            seed *= next();
            return x;
        }",
        &expect![[r"
            fn f(p: vec2f) -> f32 {
                var x = p.x;
                x += next();
                let value = twice(&x);
                x += value;
                let value_1 = next();
                seed *= value_1;
                return x;
            }
        "]],
    );
}

#[test]
fn functions_of_constants_stay_where_every_compiler_computes_them_alike() {
    let shader = "const float PI = 3.14159265;
        void mainImage(out vec4 c, in vec2 p) {
        c = vec4(normalize(vec3(1, 2, 3)), mix(1.0, 2.0, 0.3)) + sin(PI / 4.0) + length(vec3(1e20)) + pow(0.0, 0.0);
    }";
    let text = print(shader, Style::Plain);
    for kept in [
        "normalize(vec3f(1.0, 2.0, 3.0))",
        "mix(1.0f, 2.0f, 0.3f)",
        "length(runtime(vec3f(1.0e20)))",
    ] {
        assert!(text.contains(kept), "{kept}\n{text}");
    }
    assert!(text.contains("+ 0.7071068") && !text.contains("pow("), "{text}");
}

#[test]
fn uniforms_of_the_author_are_a_block() {
    let text = "#version 300 es\nprecision highp float;\nuniform float speed; // a // b\nuniform bool on;\nuniform vec2 size;\n\
                out vec4 color;\nvoid main() { color = vec4(speed * size, on ? 1.0 : 0.0, 1.0); }\n";
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    let value = |name: &str, components: &[f64]| toyproof_glsl::UniformValue {
        name: name.to_owned(),
        components: components.to_vec(),
    };
    let options = Options {
        uniforms: vec![
            value("speed", &[2.5]),
            value("on", &[1.0]),
            value("size", &[1.0, -2.0]),
        ],
        uniform_mode: toyproof_glsl::UniformMode::Kept,
        ..Options::default()
    };
    let checked = check(&files, file, &options).unwrap();
    let print = |style| wgsl(&checked, &files, style, &Deadline::default()).unwrap();
    let plain = print(Style::Plain);
    let block = "struct Uniforms {\n    // a // b\n    speed: f32, // 2.5\n    on: u32, // u32(true)\n    size: vec2f, // vec2f(1.0, -2.0)\n}\n";
    assert!(plain.contains(block), "{plain}");
    assert!(
        plain.contains("uniforms.speed * uniforms.size") && plain.contains("uniforms.on != 0u"),
        "{plain}"
    );
    // Our host has no such block.
    let hosted = Style::Plain.hosted(&plain).text;
    let values = "var<private> uniforms: Uniforms = Uniforms(2.5, u32(true), vec2f(1.0, -2.0));";
    assert!(
        hosted.contains(values) && !hosted.contains("@binding(9)"),
        "{hosted}"
    );
    let bevy = print(Style::Bevy);
    assert!(
        bevy.contains("const speed: f32 = 2.5;") && bevy.contains("const on: bool = true;"),
        "{bevy}"
    );
}
