use expect_test::{Expect, expect};

use super::{Style, wgsl};
use crate::glsl::{Options, check};
use crate::source::{File, Files};

fn printed(shader: &str, style: Style) -> String {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default()).unwrap();
    wgsl(&checked, &files, style).unwrap_or_else(|why| why.to_string())
}

/// The function `f` of a shader that calls it.
fn function(text: &str, expected: &Expect) {
    let shader = format!("{text}\nvoid mainImage(out vec4 c, in vec2 p) {{ c = vec4(f(p)); }}");
    let whole = printed(&shader, Style::Plain);
    let from = whole.find("fn f(").unwrap_or_else(|| panic!("{whole}"));
    let to = whole[from..].find("\n}\n").unwrap() + from;
    expected.assert_eq(&format!("{}\n}}\n", &whole[from..to]));
}

#[test]
fn a_shader_keeps_its_names_and_comments() {
    let shader = "// A licence.

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
        // A licence.

        struct Inputs {
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
            return p.x * inputs.iTime + f32(STEPS);
        }

        fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
            *fragColor = vec4f(far(fragCoord), inputs.iMouse.xy, 1.0);
        }

        @fragment
        fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
            var color = vec4f(0.0, 0.0, 0.0, 1.0);
            mainImage(&color, position.xy);
            return vec4f(color.xyz, 1.0);
        }
    "]]
    .assert_eq(&printed(shader, Style::Plain));
}

#[test]
fn effects_stand_before_what_they_are_part_of() {
    function(
        "float f(vec2 p) { int i = 0; float a; a = (p.yx *= 2.0, p.x) + float(i++); return i > 0 ? a : p.y; }",
        &expect![[r"
            fn f(p_in: vec2f) -> f32 {
                var p = p_in;
                var i = 0;
                var a: f32;
                let kept = p.yx * 2.0;
                p = vec2f(kept.y, kept.x);
                let kept_1 = p.x;
                let kept_2 = i;
                i++;
                a = kept_1 + f32(kept_2);
                return select(p.y, a, i > 0);
            }
        "]],
    );
}

#[test]
fn loops_are_those_of_the_author_where_wgsl_has_them() {
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
                        {
                            s += p.x;
                        }
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
                    {
                        s -= 1.0;
                    }
                    continuing {
                        break if !(s > 1.0);
                    }
                }
                return s;
            }
        "]],
    );
}

#[test]
fn what_is_never_written_is_not_kept_and_conditions_are_turned_round() {
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
                        let kept = i;
                        i++;
                        if kept >= last {
                            break;
                        }
                        let kept_1 = b;
                        let kept_2 = b;
                        b += 1.0;
                        b = mix(p.y, kept_1, kept_2);
                    }
                }
                return b;
            }
        "]],
    );
}

#[test]
fn words_of_wgsl_and_overloads_get_other_names() {
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
fn what_a_host_does_not_have_is_refused() {
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = iMouse + dFdx(p.x); }";
    let refused = "an input that the host does not have";
    assert_eq!(printed(shader, Style::Bevy), refused);
    let derives = shader.replace("iMouse", "vec4(0.0)");
    let refused = "a derivative in a compute shader";
    assert_eq!(printed(&derives, Style::ComputeToys), refused);
}

#[test]
fn y_points_down_where_the_host_has_it_so() {
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(dFdy(p.y)); }";
    assert!(printed(shader, Style::Plain).contains("vec4f(dpdy(p.y))"));
    for style in [Style::WgpuShadertoy, Style::Bevy] {
        assert!(printed(shader, style).contains("vec4f(-dpdy(p.y))"));
    }
}
