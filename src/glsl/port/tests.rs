use super::*;

/// Ports a text; returns the other text, or the error.
fn ported(text: &str, to: Dialect) -> Result<String, String> {
    ported_with(text, to, &Options::default())
}

fn ported_with(text: &str, to: Dialect, options: &Options) -> Result<String, String> {
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    let checked = check(&files, file, options).map_err(|errors| errors.to_string())?;
    // As WebGL 1 refuses loops.
    let refusal = |files: &Files, written: &Checked| {
        let at = written.tree[written.main_image].at;
        let text = files.get(at.span.file).text();
        let refused = written.version == Version::Es100 && text.contains("while");
        refused.then(|| Code::BeyondAppendixA.at(at, "a loop"))
    };
    port(&checked, &files, to, &refusal, &Deadline::default()).map_err(|error| error.to_string())
}

const WAVES: &str = "\
// Waves, by the author.
float time = 2.0;

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 uv = fragCoord / iResolution.xy; // 0 to 1
    uv.x *= iResolution.x / iResolution.y;
    fragColor = vec4(uv, sin(iTime * time), 1.0);
}
";

#[test]
fn main_image_becomes_main() {
    let text = ported(WAVES, Dialect::BookOfShaders).unwrap();
    assert_eq!(
        text,
        "\
// Waves, by the author.
#ifdef GL_ES
precision highp float;
#endif

uniform vec2 u_resolution;
uniform float u_time;

float time = 2.0;

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 uv = fragCoord / u_resolution; // 0 to 1
    uv.x *= u_resolution.x / u_resolution.y;
    fragColor = vec4(uv, sin(u_time * time), 1.0);
}

void main() {
    mainImage(gl_FragColor, gl_FragCoord.xy);
    gl_FragColor.a = 1.0;
}
"
    );
    // The author's `time` is not the host's.
    let text = ported(WAVES, Dialect::GlslSandbox).unwrap();
    assert!(
        text.contains("float time_ = 2.0;") && text.contains("sin(time * time_)"),
        "{text}"
    );
}

#[test]
fn newer_features_need_a_newer_version() {
    let text = "void mainImage(out vec4 c, in vec2 p) { uint x = uint(p.x) ^ 3u; c = vec4(float(x)); }";
    let written = ported(text, Dialect::BookOfShaders).unwrap();
    let expected = "#version 300 es\nprecision highp float;\nprecision highp int;\n\nout vec4 outColor;\n\nvoid mainImage";
    assert!(written.starts_with(expected), "{written}");
    assert!(written.ends_with("    outColor.a = 1.0;\n}\n"), "{written}");
    let error = ported(text, Dialect::GlslSandbox).unwrap_err();
    assert!(
        error.starts_with("it is not compiled by GLSL Sandbox: GLSL ES 1.00:"),
        "{error}"
    );
    // Appendix A
    let text =
        "void mainImage(out vec4 c, in vec2 p) { float a = 0.0; while (a < p.x) a += 9.0; c = vec4(a); }";
    assert!(
        ported(text, Dialect::WebGl)
            .unwrap()
            .starts_with("#version 300 es\n")
    );
}

#[test]
fn textures_and_their_sizes() {
    let text =
        "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel1, p / iChannelResolution[1].xy); }";
    let written = ported(text, Dialect::BookOfShaders).unwrap();
    assert!(
        written.contains("uniform sampler2D u_tex1;\nuniform vec2 u_tex1Resolution;\n"),
        "{written}"
    );
    assert!(
        written.contains("c = texture2D(u_tex1, p / u_tex1Resolution);"),
        "{written}"
    );
    let written = ported(text, Dialect::Three).unwrap();
    assert!(
        written.contains("uniform vec3 iChannelResolution[4];\n"),
        "{written}"
    );
    let error = ported(text, Dialect::GlslSandbox).unwrap_err();
    assert_eq!(error, "`iChannel1` is not set by GLSL Sandbox");
}

#[test]
fn what_the_host_does_not_set_is_an_error() {
    let mouse = |use_of: &str| format!("void mainImage(out vec4 c, in vec2 p) {{ c = vec4({use_of}); }}");
    let written = ported(&mouse("iMouse.xy, iMouse.yx"), Dialect::BookOfShaders).unwrap();
    assert!(written.contains("vec4(u_mouse, u_mouse.yx)"), "{written}");
    let written = ported(&mouse("iMouse.xyxy"), Dialect::GlslSandbox).unwrap();
    assert!(written.contains("vec4((mouse * resolution).xyxy)"), "{written}");
    let error = ported(&mouse("iMouse.z"), Dialect::BookOfShaders).unwrap_err();
    assert_eq!(error, "`iMouse.z` is not set by The Book of Shaders");
    let written = ported(&mouse("iMouse.z"), Dialect::Three).unwrap();
    assert!(written.contains("uniform vec4 iMouse;"), "{written}");
    assert!(ported(&mouse("iMouse"), Dialect::BookOfShaders).is_err());
    // Not an element of `iChannelResolution`.
    let error = ported(&mouse("iMouse[0], iChannelResolution[0]"), Dialect::BookOfShaders);
    assert_eq!(error.unwrap_err(), "`iMouse` is not set by The Book of Shaders");
    assert!(ported(&mouse("iSampleRate"), Dialect::BookOfShaders).is_err());
    assert!(
        ported(&mouse("iTime"), Dialect::Isf)
            .unwrap_err()
            .contains("cannot be written for ISF")
    );
}

#[test]
fn lookups_of_isf_name_their_image() {
    let isf = |color: &str| {
        let text = format!(
            "#define at (p / iResolution.xy)\n// p\nvoid mainImage(out vec4 c, in vec2 p) {{ c = {color}; }}"
        );
        let mut files = Files::default();
        let file = files.add(File::new("lookup", text));
        let checked = check(&files, file, &Options::default()).unwrap();
        let versions: &[Version] = &[Version::Desktop(150)];
        port_in_versions(
            &checked,
            &files,
            (Dialect::Isf, versions),
            &|_, _| None,
            &Deadline::default(),
        )
        .map_err(|error| error.to_string())
    };
    for (lookup, written) in [
        ("texture(iChannel1, at)", "IMG_NORM_PIXEL(iChannel1, at)"),
        (
            "textureLod(iChannel1, (at), 0.)",
            "IMG_NORM_PIXEL(iChannel1, (at))",
        ),
        ("texture(iChannel0, at, -100.0)", "IMG_NORM_PIXEL(iChannel0, at)"),
        (
            "texture(iChannel0, texelFetch(iChannel1, ivec2(p), 0).xy)",
            "IMG_NORM_PIXEL(iChannel0, iChannel1Texel(ivec2(p)).xy)",
        ),
        (
            "vec4(textureSize(iChannel0, 0), 1, 1)",
            "vec4(ivec2(IMG_SIZE(iChannel0)), 1, 1)",
        ),
        (
            "vec4(iChannelResolution[2].xyz, iTime)",
            "vec4(vec3(IMG_SIZE(iChannel2), 1.0).xyz, TIME)",
        ),
    ] {
        let text = isf(lookup).unwrap();
        assert!(text.contains(&format!("c = {written};")), "{text}");
        assert!(
            text.contains("(p / RENDERSIZE)") && !text.contains("uniform"),
            "{text}"
        );
    }
    let text = isf("iMouse").unwrap();
    assert!(
        text.contains("vec4 iMouse;") && text.contains("    iMouse = vec4(mouse * RENDERSIZE, "),
        "{text}"
    );
    for lookup in [
        "textureLod(iChannel0, at, 1.0)",
        "textureGrad(iChannel0, at, p, p)",
        "texelFetch(iChannel0, ivec2(p), 1)",
    ] {
        let error = isf(lookup).unwrap_err();
        assert!(error.ends_with("has no equivalent in ISF"), "{error}");
    }
}

const PULSE: &str = "\
#ifdef GL_ES
precision mediump float;
#endif

uniform vec2 u_resolution; // in pixels
uniform float u_time;
uniform float speed;
uniform sampler2D u_tex0;

// A disk.
float disk(vec2 at) { return step(length(at), 0.3 + 0.1 * sin(speed * u_time)); }

void main() {
    vec2 st = gl_FragCoord.xy / u_resolution.xy;
    float ratio = gl_FragCoord.x / u_resolution.y;
    gl_FragColor = texture2D(u_tex0, st) * disk(st - 0.5) * ratio;
    gl_FragColor.a = 1.0;
}
";

#[test]
fn main_becomes_main_image() {
    let options = Options {
        uniforms: vec![crate::UniformValue {
            name: "speed".to_owned(),
            components: vec![3.0],
        }],
        ..Options::default()
    };
    let text = ported_with(PULSE, Dialect::ShaderToy, &options).unwrap();
    assert_eq!(
        text,
        "\
const float speed = 3.0;

// A disk.
float disk(vec2 at) { return step(length(at), 0.3 + 0.1 * sin(speed * iTime)); }

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 st = fragCoord / iResolution.xy;
    float ratio = fragCoord.x / iResolution.y;
    fragColor = texture(iChannel0, st) * disk(st - 0.5) * ratio;
    fragColor.a = 1.0;
}
"
    );
}

#[test]
fn the_color_may_be_set_anywhere() {
    let text = "uniform float u_time;\nvoid paint() { gl_FragColor = vec4(u_time); }\nvoid main(void) { paint(); }\n";
    let written = ported(text, Dialect::ShaderToy).unwrap();
    assert_eq!(
        written,
        "vec4 outColor;\n\nvoid paint() { outColor = vec4(iTime); }\nvoid mainColor() { paint(); }\n\n\
         void mainImage(out vec4 fragColor, in vec2 fragCoord) {\n    mainColor();\n    fragColor = outColor;\n}\n"
    );
    let text = "#version 300 es\nprecision highp float;\nout vec3 color;\nin vec2 vUv;\n\
                void main() { color = vec3(vUv, 0.0); }\n";
    let written = ported(text, Dialect::ShaderToy).unwrap();
    assert!(
        written.starts_with(
            "vec3 color;\nvoid mainColor() { color = vec3((gl_FragCoord.xy / iResolution.xy), 0.0); }"
        ),
        "{written}"
    );
    assert!(written.contains("fragColor = vec4(color, 1.0);"), "{written}");
}

#[test]
fn a_name_of_a_parameter_is_no_input() {
    let text = "uniform vec2 mouse;\nfloat f(float mouse) { return mouse; }\n\
                void main() { gl_FragColor = vec4(mouse, f(0.5), 1.0); }\n";
    let options = Options {
        dialect: Some(Dialect::GlslSandbox),
        ..Options::default()
    };
    let written = ported_with(text, Dialect::ShaderToy, &options).unwrap();
    assert_eq!(
        written,
        "vec2 mouse;\nfloat f(float mouse) { return mouse; }\n\
         void mainImage(out vec4 fragColor, in vec2 fragCoord) {\n    mouse = (iMouse.xy / iResolution.xy); \
         fragColor = vec4(mouse, f(0.5), 1.0); }\n"
    );
}

#[test]
fn a_parameter_of_a_macro_is_no_input() {
    let text = "#define UV(iResolution, p) ((p) / iResolution.xy)\n#define SIZE (iResolution.xy)\n\
                void mainImage(out vec4 c, in vec2 p) { c = vec4(UV(iResolution, p), SIZE); }\n";
    let written = ported(text, Dialect::BookOfShaders).unwrap();
    assert!(
        written.contains("#define UV(iResolution, p) ((p) / iResolution.xy)\n"),
        "{written}"
    );
    assert!(
        written.contains("    iResolution = vec3(u_resolution, 1.0);\n"),
        "{written}"
    );
}

#[test]
fn macros_of_hosts_and_versions() {
    let text = "#ifdef GL_OES_standard_derivatives\n#extension GL_OES_standard_derivatives : enable\n#endif\n\
                uniform vec2 u_resolution;\n\
                void main() {\n#ifdef GL_OES_standard_derivatives\n    gl_FragColor = vec4(dFdx(gl_FragCoord.x));\n#endif\n}\n";
    let written = ported(text, Dialect::ShaderToy).unwrap();
    let expected = "void mainImage(out vec4 fragColor, in vec2 fragCoord) {\n#ifdef GL_ES\n    \
                    fragColor = vec4(dFdx(fragCoord.x));\n#endif\n}\n";
    assert_eq!(written, expected);
    let text = "precision highp float;\nvoid mainImage(out vec4 c, in vec2 p) {\n#if HW_PERFORMANCE == 1\n    c = vec4(iTime);\n#endif\n}\n";
    let written = ported(text, Dialect::Three).unwrap();
    let expected = "#ifdef GL_ES\nprecision highp float;\n#endif\n\n#define HW_PERFORMANCE 1\nuniform float uTime;\n\nprecision";
    assert!(written.starts_with(expected), "{written}");
}

#[test]
fn between_hosts_that_run_main() {
    let text = ported(PULSE, Dialect::Three).unwrap();
    assert!(
        text.contains("uniform vec2 uResolution; // in pixels\nuniform float uTime;\nuniform float speed;\n"),
        "{text}"
    );
    assert!(text.contains("uniform sampler2D iChannel0;\n"), "{text}");
    assert!(text.contains("texture2D(iChannel0, st)"), "{text}");
    let text = "uniform vec2 surfacePosition;\nvoid main() { gl_FragColor = vec4(surfacePosition.x); }\n";
    let text = text.replace("uniform", "varying");
    let written = ported(&text, Dialect::BookOfShaders).unwrap();
    let expected = "uniform vec2 u_resolution;\nvoid main() { gl_FragColor = vec4(((gl_FragCoord.xy / u_resolution - 0.5) * vec2(u_resolution.x / u_resolution.y, 1.0)).x); }\n";
    assert_eq!(written, expected);
}

#[test]
fn what_the_other_host_declares_is_renamed() {
    let text = "uniform float u_time;\nuniform vec3 iMouse, u_resolution;\nfloat iFrame = 0.5;\n\
                void main() { gl_FragColor = vec4(iMouse * iFrame, u_time); }\n";
    let written = ported(text, Dialect::ShaderToy).unwrap();
    assert!(
        written.starts_with("vec3 iMouse_;\nfloat iFrame_ = 0.5;\n"),
        "{written}"
    );
    assert!(written.contains("vec4(iMouse_ * iFrame_, iTime)"), "{written}");
}

#[test]
fn a_variable_does_not_hide_the_function_of_textures() {
    let text = "precision highp float;\nuniform sampler2D u_tex0;\nvoid main() {\n    \
                vec4 texture = texture2D(u_tex0, vec2(0.0));\n    \
                gl_FragColor = texture + texture2D(u_tex0, vec2(1.0));\n}\n";
    let written = ported(text, Dialect::ShaderToy).unwrap();
    assert!(
        written.contains("vec4 texture_ = texture(iChannel0, vec2(0.0));"),
        "{written}"
    );
    assert!(
        written.contains("texture_ + texture(iChannel0, vec2(1.0))"),
        "{written}"
    );
}

#[test]
fn declarations_keep_their_precision_and_extensions_of_webgl_1_stay() {
    let text = "#extension GL_OES_standard_derivatives : enable\nuniform highp vec2 u_resolution;\n\
                uniform mediump float u_time;\nprecision mediump float;\n\
                void main() { gl_FragColor = vec4(dFdx(u_resolution.x), u_time, 0.0, 1.0); }\n";
    let written = ported(text, Dialect::GlslSandbox).unwrap();
    let expected = "#extension GL_OES_standard_derivatives : enable\nuniform highp vec2 resolution;\n\
                    uniform mediump float time;\n";
    assert!(written.starts_with(expected), "{written}");
}

#[test]
fn sizes_of_textures_are_declared_in_place_of_their_array() {
    let text = "precision highp float;\nuniform vec3 iChannelResolution[4];\nuniform sampler2D iChannel1;\n\
                void main() { gl_FragColor = texture2D(iChannel1, 1.0 / iChannelResolution[1].xy); }\n";
    let written = ported(text, Dialect::BookOfShaders).unwrap();
    assert!(
        written.contains("float;\nuniform vec2 u_tex1Resolution;\n"),
        "{written}"
    );
    assert!(written.contains("1.0 / u_tex1Resolution"), "{written}");
}

#[test]
fn uniforms_with_values_become_constants() {
    let text = "uniform float speed;\n#iUniform float speed = 2.0 in { 0.0, 10.0 }\n\
                void mainImage(out vec4 c, in vec2 p) { c = vec4(speed * iTime); }\n";
    let written = ported(text, Dialect::BookOfShaders).unwrap();
    assert!(
        written.contains("\nuniform float speed;\nvoid mainImage"),
        "{written}"
    );
    let text = "#version 120\nuniform float u_time;\nuniform vec2 speed = vec2(2.0, 1.0);\n\
                void main() { gl_FragColor = vec4(speed * u_time, 0.0, 1.0); }\n";
    let written = ported(text, Dialect::WebGl).unwrap();
    assert!(
        written.contains("const vec2 speed = vec2(2.0, 1.0);"),
        "{written}"
    );
}

#[test]
fn an_array_of_colors_shows_its_first_element() {
    let text = "#version 300 es\nprecision highp float;\nuniform float u_time;\nout vec4 colors[1];\n\
                void main() { colors[0] = vec4(u_time); }\n";
    let written = ported(text, Dialect::ShaderToy).unwrap();
    assert_eq!(
        written,
        "void mainImage(out vec4 fragColor, in vec2 fragCoord) { fragColor = vec4(iTime); }\n"
    );
    let written = ported(text, Dialect::WebGl).unwrap();
    assert!(
        written.contains("out vec4 colors[1];") && !written.contains("outColor"),
        "{written}"
    );
    let text = "#define COLOR gl_FragData[0]\nprecision highp float;\nvoid main() { COLOR = vec4(1.0); }\n";
    let written = ported(text, Dialect::ShaderToy).unwrap();
    assert!(written.starts_with("vec4 outColor[4];\n"), "{written}");
}

#[test]
fn line_ends_and_indentation_are_the_same_throughout() {
    let text = "\t#define A 1.0\r\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(A); }\r\n";
    let written = ported(text, Dialect::WebGl).unwrap();
    assert!(written.starts_with("#ifdef GL_ES\n"), "{written}");
    assert!(written.contains("\n\t#define A 1.0\nvoid"), "{written}");
    assert!(!written.contains('\r'), "{written:?}");
}
