//! Cases of the smaller lints.

use super::*;

#[test]
fn randomness() {
    check_cases(
        "
        W0005 c.x = fract(sin(f.x) * 43758.5453);
        W0005 c.x = fract(sin(dot(f, vec2(12.9898, 78.233))) * 43758.5453);
        W0005 c.xy = fract(vec2(sin(f.x), cos(f.y)) * 4375.8);
        W0005 c.x = fract(4375.8 * -sin(f.x) + 0.5);
        W0005 float s = sin(f.x), h = s * 1e4; c.x = fract(h);
        W0005 vec2 p = f; p = sin(p) * 43758.5; c.xy = fract(p);
        W0005 c.x = mod(cos(f.x) * 1e5, 1.0);
        W0005 const float K = 43758.5; | c.x = fract(sin(f.x) * K);
        W0005 float h(float x) { return fract(sin(x) * 43758.5); } | c.x = h(f.x);
        W0022 float h(float x) { return fract(sin(x) * 43758.5); } |
        -     c.x = fract(sin(f.x) * 3.0);
        -     c.x = fract(f.x * 43758.5);
        -     c.x = mod(sin(f.x) * 1e5, 3.0);
        -     c.x = sin(f.x) * 43758.5;
        ",
    );
}

#[test]
fn reversed_edges() {
    check_cases(
        "
        W0021 c.x = smoothstep(1.0, 0.0, f.x);
        W0021 c.x = smoothstep(0.5, 0.5, f.x);
        W0021 c.x = smoothstep(-0.2, -0.3, f.x);
        W0021 c.x = smoothstep(0.5 + 0.01, 0.5 - 0.01, f.x);
        W0021 const float R = 0.3, W = 0.02; | c.x = smoothstep(R + W, R - W, f.x);
        W0021 float r = 0.3, w = 0.02; c.x = smoothstep(r + w, r, f.x);
        W0021 c.xy = smoothstep(vec2(0.0, 1.0), vec2(1.0, 0.5), f);
        W0021 c.xy = smoothstep(1.0, 0.0, f);
        W0021 float r = length(f); c.x = smoothstep(r, r - 0.01, f.x);
        W0021 float r = length(f); c.x = smoothstep(r + 0.02, r - 0.01, f.x);
        W0021 float r = length(f), px = 2.0 / iResolution.y; c.x = smoothstep(r + px, r - px, f.x);
        W0021 float px = 1.5 / min(iResolution.x, iResolution.y); c.x = smoothstep(px, 0.0, f.x);
        W0021 float px = 2.0 / iResolution.y; c.x = smoothstep(px, -px, f.x);
        W0021 float w = fwidth(f.x); c.x = smoothstep(0.5 + w, 0.5 - w, f.x);
        W0021 float band(float x, float low, float high) { return smoothstep(low, high, x); } | c.x = band(f.x, 0.4, 0.1);
        -     c.x = smoothstep(0.0, 1.0, f.x);
        -     c.x = 1.0 - smoothstep(0.2, 0.5, f.x);
        -     c.x = smoothstep(f.x, f.y, 0.5);
        -     c.x = smoothstep(iTime, 0.0, f.x);
        -     float w = 0.1; if (iTime > 1.0) w = -w; c.x = smoothstep(w, -w, f.x);
        -     float r = length(f); c.x = smoothstep(r, r + 0.01, f.x);
        -     float r = length(f); c.x = smoothstep(r, 0.5, f.x);
        -     float px = 2.0 / iResolution.y; c.x = smoothstep(-px, px, f.x);
        -     float d = f.x; d -= 1.0; c.x = smoothstep(d, 0.0, f.x);
        -     float band(float x, float low, float high) { return smoothstep(low, high, x); } | c.x = band(f.x, 0.4, 0.1) + band(f.y, 0.1, 0.4);
        -     c.xy = smoothstep(vec2(0.0, 0.5), vec2(1.0, 0.6), f);
        ",
    );
    let fix = |call: &str| {
        let (found, files) = diagnostics(&shader("", &format!("c.x = 2.0 * {call};")));
        toyproof_diagnostic::json(&found[0], &files)
            .fix
            .map(|fix| fix.replacement)
    };
    // The edited text is a factor of a product, and keeps the author's text.
    assert_eq!(
        fix("smoothstep(0.5, (0.2 + 0.1), length(f))").as_deref(),
        Some("(1.0 - smoothstep((0.2 + 0.1), 0.5, length(f)))")
    );
    assert_eq!(fix("smoothstep(0.5, 0.5, f.x)"), None);
    let macros = "#define EDGE smoothstep(0.5, 0.2, f.x)\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(EDGE, EDGE, 0, 1); }";
    let (found, files) = diagnostics(macros);
    assert_eq!(found.len(), 1);
    assert_eq!(toyproof_diagnostic::json(&found[0], &files).fix, None);
    assert!(
        found[0]
            .notes
            .contains(&"in the expansion of the macro `EDGE`, defined at a:1".to_owned()),
        "{found:#?}"
    );
}

#[test]
fn functions_that_are_never_called() {
    check_cases(
        "
        W0022 float shade(float x) { return x; } | c.x = f.x;
        W0022 float shade(float x) { return x; } float lit(float x) { return shade(x); } | c.x = f.x;
        -     float shade(float x) { return x; } | c.x = shade(f.x);
        -     float shade(float x) { return x; } float lit(float x) { return shade(x); } | c.x = lit(f.x);
        -     float shade(float x) { return x; } float shade(vec2 x) { return x.y; } | c.x = shade(f);
        -     float shade(float x); | c.x = f.x;
        -     float one() { return 1.0; } const float K = 1.0; | c.x = one() * K;
        -     void mainVR(out vec4 c, in vec2 f, in vec3 o, in vec3 d) { c = vec4(d, 1.0); } | c.x = f.x;
        -     vec2 mainSound(float time) { return vec2(time); } | c.x = f.x;
        ",
    );
    let main = "void mainImage(out vec4 c, in vec2 f) { c = vec4(f, 0.0, 1.0); }";
    for other in [
        // Another value of the macro calls it.
        "#define QUALITY 0\nfloat shade(float x) { return x; }\n#if QUALITY\nfloat used() { return shade(1.0); }\n#endif\n",
        "float shade(float x) { return x; }\n#define SHADE shade(f.x)\n",
        "#define DEFINE(name) float name(float x) { return x; }\nDEFINE(shade)\n",
    ] {
        assert!(warned(&format!("{other}{main}")).is_empty(), "{other}");
    }
    // A call in a comment does not count.
    let text = format!("float shade(float x) {{ return x; }} // c *= shade(f.x);\n{main}");
    assert_eq!(warned(&text), ["W0022:1"]);
    // One warning is enough for a library.
    let functions = (0..9).map(|i| format!("float f{i}(float x) {{ return x; }}"));
    let library = functions.collect::<Vec<_>>().join("\n");
    let (found, _) = diagnostics(&format!("{library}{main}"));
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].message, "`f0` and 8 other functions are never called");
    // Functions of Common are for all tabs.
    let mut files = Files::default();
    let common = files.add(File::new("common.glsl", "float shade(float x) { return x; }"));
    let image = files.add(File::new(
        "image.glsl",
        format!("float own(float x) {{ return x; }} {main}"),
    ));
    let joined = files.join("image.glsl", &[common, image]);
    let checked = check(&files, joined, &Options::default()).unwrap();
    let warnings = lint(&files, &checked, &Deadline::default()).warnings;
    let messages: Vec<_> = warnings.iter().map(|warning| &*warning.message).collect();
    assert_eq!(messages, ["the function `own` is never called"]);
}

#[test]
fn lost_fractions() {
    check_cases(
        "
        W0023 c.x = float(1 / 3);
        W0023 c.xyz = vec3(1 / 2, 0, 0);
        W0023 c.xyz = vec3(7 / 2);
        W0023 c.x = pow(f.x, float(1 / 3));
        -     c.x = float(6 / 3);
        -     const int N = 7; | c.x = float(N / 2);
        -     c.x = float(int(f.x) / 3);
        -     c.x = 1.0 / 3.0;
        -     int i = 7 / 2; c.x = float(i);
        -     int a[7 / 2]; a[0] = 1; c.x = float(a[0]);
        ",
    );
    let (found, files) = diagnostics(&shader("", "c.x = float(1 / 3);"));
    assert_eq!(
        toyproof_diagnostic::json(&found[0], &files)
            .fix
            .unwrap()
            .replacement,
        "1.0 / 3.0"
    );
}

#[test]
fn unused_results() {
    check_cases(
        "
        W0010 vec3 d = vec3(f, 1.0); normalize(d);
        W0010 f.x == 1.0;
        W0010 f.x + 1.0;
        W0010 float twice(float x) { return 2.0 * x; } | twice(f.x);
        W0010 for (int i = 0; i < 3; i + 1) { if (f.x > 1.0) break; }
        -     float n; float count() { return n++; } | count(); c.x = n;
        -     float set(out float x) { x = 1.0; return x; } | float y; set(y); c.x = y;
        -     float stop(float x) { if (x < 0.0) discard; return x; } | stop(f.x);
        -     void nothing() { } | nothing();
        -     int i = 0; for (i; i < 3; i++) c.x += 1.0;
        -     c.x = 1.0, c.y = 2.0;
        ",
    );
    assert!(
        warned("#define SHOW(x) (x)\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(0.0); SHOW(f.x); }")
            .is_empty()
    );
}

#[test]
fn uniforms_that_nothing_sets() {
    check_cases(
        "
        W0030 uniform float speed; | c.x = speed;
        W0030 uniform vec2 offsets[3]; | c.xy = offsets[1];
        W0030 in vec2 at; | c.xy = at;
        -     uniform float speed; | c.x = iTime;
        -     uniform sampler2D noise; | c = texture(noise, f);
        W0022 uniform float speed; float unreached() { return speed; } | c.x = iTime;
        ",
    );
    assert_eq!(
        warned("uniform float a; void mainImage(out vec4 c, in vec2 f) { c = vec4(a, a, 0.0, 1.0); }").len(),
        1,
        "once for each declaration"
    );
}

#[test]
fn equality_of_floats() {
    check_cases(
        "
        W0011 vec2 p = f / iResolution.xy; float b = dot(p, p), disc = b * b - 4.0; if (disc == 0.0) c.x = 1.0;
        W0011 for (float i = 0.0; i != 1.0; i += 0.1) c.x += i;
        W0011 if (length(f) == 0.3) c.x = 1.0;
        W0011 if (0.3 != f.x / iResolution.x) c.x = 1.0;
        W0011 float a = length(f), b = length(f.yx); if (a == b) c.x = 1.0;
        W0011 float half_of(float x) { return x / 3.0; } | if (half_of(f.x) == 0.3) c.x = 1.0;
        W0011 if (sin(iTime) == 0.0) c.x = 1.0;
        W0011 vec3 p = vec3(f, 1.0) * iTime + 0.1; if (p.y == 0.0) c.x = 1.0;
        W0011 if (any(notEqual(f * iTime + 0.1, vec2(1.0)))) c.x = 1.0;
        W0011 if (mod(iTime, 2.0) == 0.0) c.x = 1.0;
        W0011 float x = f.x * 0.1 - f.y * 0.3, y = f.x * 0.7 + f.y; if (x == 0.0 && y == 0.5) c.x = 1.0;
        -     vec3 v = f.x * vec3(0.1, 0.7, 0.3) - f.y; if (v.x == 0.0 && v.y == 0.0 && v.z == 0.0) c.x = 1.0;
        -     vec3 v = f.x * vec3(0.1, 0.7, 0.3) - f.y; if (v.x == 0.0 && (v.y == 0.0 && v.z == 0.0)) c.x = 1.0;
        W0011 vec3 v = f.x * vec3(0.1, 0.7, 0.3) - f.y; if (v.x == 0.0 && (v.y > 0.0 && v.z > 0.0)) c.x = 1.0;
        -     float x = f.x * 0.1 - f.y * 0.3, y = f.x * 0.7 - f.y; if (x == 0.0 && y == 0.0) c.x = 1.0;
        -     if (iTime == 0.0) c.x = 1.0;
        -     if (mod(floor(f.x), 2.0) == 1.0) c.x = 1.0;
        -     if (mod(f.x - 0.5, 2.0) == 0.0) c.x = 1.0;
        -     for (float i = 0.0; i < 4.0; i++) { if (i == 2.0) c.x += i; }
        -     for (float i = 0.0; i != 4.0; i += 0.25) c.x += i;
        -     float t = 1e9; if (f.x > 1.0) t = length(f); if (t == 1e9) c.x = 1.0;
        -     float t = -1.0; for (int i = 0; i < 3; i++) t = min(t, f.x * 0.1); if (t != -1.0) c.x = t;
        -     float a = length(f), b = length(f - 1.0), d = min(a, b); if (d == a) c.x = 1.0;
        -     vec2 near(vec2 a, vec2 b) { return a.x < b.x ? a : b; } | vec2 h = near(vec2(length(f), 1.0), vec2(2.0)); if (h.y == 1.0) c.x = 1.0;
        -     vec2 p = f / iResolution.xy; float d = p.x - p.y; if (d == 0.0) d = 1.0; c.x = p.x / d;
        -     vec2 p = f / iResolution.xy; p = floor(p); if (p.x + p.y == 1.0) c.x = 1.0;
        -     float least(float a, float b) { return a < b ? a : b + 0.0; } | if (least(length(f), 0.3) == length(f)) c.x = 1.0;
        -     float ease(float t) { return t == 1.0 ? t : t * 2.0; } | c.x = ease(iTime * 0.1);
        -     float a = length(f), b = mix(a, 1.0, iTime); if (a == b) c.x = 1.0;
        -     vec2 p = f / iResolution.xy - 1.0; if (dot(p, p) == 0.0) c.x = 1.0;
        -     if (length(f) == 0.0) c.x = 1.0;
        -     if (max(f.x * 0.1 - 2.0, 0.0) == 0.0) c.x = 1.0;
        -     struct Hit { float t; }; | Hit h = Hit(-1.0); h.t = length(f); if (h.t == -1.0) c.x = 1.0;
        -     if (texture(iChannel0, f).x == 1.0) c.x = 1.0;
        -     if (float(int(f.x) * 3) == 9.0) c.x = 1.0;
        -     int i = int(f.x); if (i == 3) c.x = 1.0;
        ",
    );
}

#[test]
fn derivatives_in_divergent_control_flow() {
    check_cases(
        "
        W0006 if (f.x > 9.0) c.x = fwidth(f.y);
        W0006 if (f.x > 9.0) return; c.x = dFdx(f.y);
        W0006 for (int i = 0; i < 9; i++) { c.x += dFdx(f.y); if (f.x > float(i)) break; }
        W0006 for (int i = 0; i < int(f.x); i++) c.x += dFdx(f.y);
        W0006 float w(float x) { return fwidth(x); } | if (f.x > 9.0) c.x = w(f.y);
        W0006 bool near; void find(vec2 p) { near = p.x > 1.0; } | find(f); if (near) c.x = fwidth(f.y);
        W0006 c.x = f.x > 9.0 ? fwidth(f.y) : 0.0;
        W0006 if (f.x > 9.0 && fwidth(f.y) > 0.1) c.x = 1.0;
        W0006 int n = 0; if (f.x > 1.0) n = 1; if (n == 1) c.x = fwidth(f.y);
        W0006 switch (int(f.x)) { case 1: c.x = fwidth(f.y); }
        W0006 bool hit(out float t, vec2 p) { t = p.x; return true; } | float t; hit(t, f); if (t > 1.0) c.x = fwidth(f.y);
        W0007 float t = 0.0; for (int i = 0; i < 9; i++) { t += f.x; if (t > 1.0) break; } if (t > 1.0) c = texture(iChannel0, f * t);
        W0007 for (int i = 0; i < 9; i++) { c += texture(iChannel0, f + float(i)); if (c.x > 1.0) break; }
        W0007 float t(vec2 p) { for (int i = 0; i < 9; i++) if (p.x > float(i)) return p.y; return -1.0; } | float s = t(f); if (s > 0.0) { vec2 q = f * s; c = texture(iChannel0, q); }
        W0007 vec4 look(vec2 p) { return texture(iChannel0, p); } | vec2 p = f; if (f.x > 1.0) p.x = 3.0; if (f.y > 1.0) c = look(p);
        -     if (f.x > 9.0) c = texture(iChannel0, f);
        -     if (f.x > 9.0) { vec2 uv = f / iResolution.xy; c = texture(iChannel0, uv); }
        -     vec4 look(vec2 p) { vec2 q = p * 2.0; return texture(iChannel0, q); } | if (f.x > 9.0) c = look(f);
        -     for (int i = 0; i < 9; i++) { c += texture(iChannel0, vec2(0.1, float(iFrame))); if (c.x > f.x) break; }
        -     for (int i = 0; i < 9; i++) { c += texture(iChannel0, f + float(i), -100.0); if (c.x > 1.0) break; }
        -     for (int i = 0; i < 9; i++) { c += texture(iChannel0, vec2(f.x + float(i), 0.25)); if (c.x > 1.0) break; }
        -     c.x = fwidth(f.y); if (f.x > 9.0) c.x = 1.0;
        -     if (iTime > 9.0) c.x = fwidth(f.y);
        -     if (iTime > 9.0) return; c.x = dFdx(f.y);
        -     for (int i = 0; i < 9; i++) { c.x += dFdx(f.y); if (iTime > float(i)) break; }
        -     for (int i = 0; i < 9; i++) { if (f.x > float(i)) continue; c.y = 1.0; } c.x = fwidth(f.y);
        -     for (int i = 0; i < 9; i++) { if (f.x > float(i)) break; } c.x = fwidth(f.y);
        -     if (f.x > 9.0) c = textureLod(iChannel0, f, 0.0); c += texelFetch(iChannel0, ivec2(f), 0);
        -     float twice(float x) { if (x > 1.0) return 1.0; return 2.0; } | c.x = twice(f.x) + fwidth(f.y);
        -     float kind(float x) { float y = 1.0; y += x; return y; } | if (f.x > 1.0) c.y = kind(1.0); if (kind(iTime) > 3.0) c.x = fwidth(f.y);
        -     float w(float x) { return fwidth(x); } | c.x = w(f.y);
        ",
    );
}

#[test]
fn loops() {
    check_cases(
        "
        W0008 for (int i = 0; i < 70000; i++) c.x += f.x;
        W0008 for (int i = 0; i < 300; i++) for (int j = 0; j < 300; j++) c.x += f.x;
        W0008 const int N = 400; | for (int i = 0; i < N; ++i) for (int j = N; j >= 0; j -= 2) c.x += f.x;
        W0008 float far(vec2 p) { float d = 0.0; for (int i = 0; i < 300; i++) d += p.x; return d; } | for (int i = min(iFrame, 0); i < 300; i++) c.x += far(f);
        W0008 for (int i = 0; i < 40000; i++) c.x += f.x; for (int i = 0; i < 40000; i++) c.x += f.x;
        W0008 for (int i = 0; i < 9; i--) c.x += f.x;
        W0008 for (float x = 0.0; x <= 100.0; x += 0.001) c.x += f.x;
        W0009 while (true) c.x += f.x;
        W0009 for (;;) { c.x += 1.0; }
        W0009 do c.x += 1.0; while (1 < 2);
        W0009 while (true) { for (int i = 0; i < 3; i++) { if (c.x > 1.0) break; } }
        W0009 while (true) { switch (int(f.x)) { case 1: break; } }
        W0009 float x = f.x; while (x < 9.0) { c.x += 1.0; }
        W0009 for (int i = 0; i < int(f.x);) { c.x += 1.0; }
        -     for (int i = 0; i < 65000; i++) c.x += f.x;
        -     for (int i = 0; i < 300; i++) { if (i < 1) continue; } for (int j = 0; j < 300; j++) c.x += f.x;
        -     if (f.x > 1.0) { for (int i = 0; i < 40000; i++) c.x += 1.0; } else { for (int i = 0; i < 40000; i++) c.x += 2.0; }
        -     int n = int(f.x); for (int i = 0; i < n; i++) for (int j = 0; j < n; j++) c.x += 1.0;
        -     while (true) { if (c.x > 1.0) break; c.x += f.x; }
        -     while (true) { if (c.x > 1.0) return; c.x += f.x; }
        -     float x = f.x; while (x < 9.0) { x += 1.0; }
        -     bool more; void next() { more = false; } | while (more) { next(); }
        -     while (false) c.x += 1.0;
        ",
    );
}

#[test]
fn directions_that_are_never_normalized() {
    let ray = "struct Ray { vec3 o, d; }; struct Ball { vec3 c; float r; };";
    let half = "float hit(Ray ray, Ball ball) { vec3 f = ray.o - ball.c; float b = dot(f, ray.d); \
                float c = dot(f, f) - ball.r * ball.r; float disc = b * b - c; return disc > 0.0 ? -b - sqrt(disc) : -1.0; }";
    let full = "float hit(Ray ray, Ball ball) { vec3 f = ray.o - ball.c; float b = 2.0 * dot(ray.d, f); \
                float c = dot(f, f) - ball.r * ball.r; float disc = b * b - 4.0 * c; return disc > 0.0 ? -b - sqrt(disc) : -1.0; }";
    let inline = "float hit(Ray ray, Ball ball) { float b = dot(ray.d, ray.o - ball.c); \
                  return b * b - dot(ray.o - ball.c, ray.o - ball.c) + ball.r * ball.r; }";
    let general = "float hit(Ray ray, Ball ball) { vec3 f = ray.o - ball.c; float a = dot(ray.d, ray.d); float b = dot(f, ray.d); \
                   float c = dot(f, f) - ball.r * ball.r; float disc = b * b - a * c; return disc > 0.0 ? (-b - sqrt(disc)) / a : -1.0; }";
    let found = |formula: &str, direction: &str| {
        let call = format!("c.x = hit(Ray(vec3(0), {direction}), Ball(vec3(0, 0, -6), 1.5));");
        warned(&shader(&format!("{ray} {formula}"), &call)).join(" ")
    };
    for formula in [half, full, inline] {
        for direction in [
            "vec3(f / iResolution.xy - 0.5, -2.0)",
            "mat3(2.0) * vec3(f, -2.0)",
            "-vec3(f.x, f.y, 1.0)",
            "f.x * normalize(vec3(1, 2, 3)) + f.y * vec3(0, 1, 0)",
            "iMouse.x > 1.0 ? vec3(f, 1) : vec3(f, 2)",
        ] {
            assert_eq!(found(formula, direction), "W0012:1", "{formula} {direction}");
        }
        for direction in [
            "normalize(vec3(f, -2.0))",
            "vec3(0.0, 0.0, -1.0)",
            "vec3(f, -2.0) / length(vec3(f, -2.0))",
            "vec3(sin(f.x), 0.0, cos(f.x))",
            "iMouse.x > 1.0 ? normalize(vec3(f, 1)) : vec3(f, 2)",
            "reflect(normalize(vec3(f, -2.0)), vec3(0, 1, 0))",
        ] {
            assert_eq!(found(formula, direction), "", "{formula} {direction}");
        }
    }
    assert_eq!(found(general, "vec3(f, -2.0)"), "");
    // Normalized on one of two paths into the structure.
    let call =
        "Ray r = Ray(vec3(0), vec3(f, -2)); r.d = normalize(r.d); c.x = hit(r, Ball(vec3(0, 0, -6), 1.5));";
    assert!(warned(&shader(&format!("{ray} {half}"), call)).is_empty());
    let call = "vec3 d = vec3(f, -2); d.xy *= mat2(0, 1, -1, 0); d /= length(d); c.x = hit(Ray(vec3(0), d), Ball(vec3(0, 0, -6), 1.5));";
    assert!(warned(&shader(&format!("{ray} {half}"), call)).is_empty());
    // Quaternions and similar expressions.
    assert!(
        warned(&shader(
            "",
            "vec4 q = vec4(f, f); c.x = q.x * q.x - q.y * q.y - dot(f, f);"
        ))
        .is_empty()
    );
}

#[test]
fn what_webgl_1_refuses() {
    let head = "precision highp float;\nuniform float x;\n";
    let main = |body: &str| format!("{head}void main() {{\n{body}\ngl_FragColor = vec4(x);\n}}");
    let refused = |body: &str| warned(&main(body)).contains(&"W0031:4".to_owned());
    assert!(refused("float a = 0.0; while (a < 9.0) a += 1.0;"));
    assert!(refused("for (int i = 0; float(i) < x; i++) {}"));
    assert!(!refused("for (int i = 0; i < 9; i++) {}"));
    assert!(refused("float a[3]; a[0] = a[int(x)];"));
    assert!(refused("float a = dFdx(x);"));
    let enabled = format!(
        "#extension GL_OES_standard_derivatives : enable\n{}",
        main("float a = dFdx(x);")
    );
    assert!(
        !warned(&enabled)
            .iter()
            .any(|warning| warning.starts_with("W0031"))
    );
    let newer = "#version 300 es\nprecision highp float;\nout vec4 c;\nvoid main() { c = vec4(dFdx(gl_FragCoord.x)); }";
    assert!(warned(newer).is_empty(), "{:?}", warned(newer));
}
