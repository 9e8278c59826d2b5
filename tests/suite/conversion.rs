//! Conversions and their proofs: what is right is proved, in every style, and what is wrong is not.

use std::fs;
use std::path::Path;
use std::time::Duration;

use toyproof::glsl::wgsl::{Style, wgsl};
use toyproof::glsl::{Options, check};
use toyproof::gpu::{Worker, Written};
use toyproof::source::{File, Files};
use toyproof::verify::conversion::{Proof, frames, prove};

use crate::program::toyproof;
use crate::support::{ANIMATION, EVERY_RUNG, REFLECTIONS, Rung, worker};

const TIMEOUT: Duration = Duration::from_secs(60);

/// A shader's WGSL as `edit` leaves it, compared with the shader.
fn proof(worker: &mut Worker, shader: &str, style: Style, edit: impl Fn(String) -> String) -> Proof {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default()).expect("it is valid");
    let text = wgsl(&checked, &files, style).unwrap_or_else(|why| panic!("{why}\n{shader}"));
    let hosted = style.hosted(&edit(text));
    let whole = hosted.text.clone();
    prove(
        worker,
        &checked,
        Written::Wgsl(hosted),
        &frames(&checked),
        TIMEOUT,
    )
    .unwrap_or_else(|failure| panic!("{failure}\n{whole}"))
}

/// That conversion holds.
fn holds(worker: &mut Worker, rung: &Rung, style: Style) {
    let proof = proof(worker, rung.shader, style, |text| text);
    assert!(proof.holds(), "{} as {}: {proof:?}", rung.name, style.name());
}

#[test]
fn every_rung_is_proved() {
    let Some(mut worker) = worker() else { return };
    for rung in EVERY_RUNG {
        holds(&mut worker, rung, Style::Plain);
    }
}

#[test]
fn every_style_is_proved() {
    let Some(mut worker) = worker() else { return };
    for style in Style::ALL {
        for rung in [&REFLECTIONS, &ANIMATION] {
            holds(&mut worker, rung, style);
        }
    }
}

#[test]
fn what_is_not_the_shader_is_not_proved() {
    let Some(mut worker) = worker() else { return };
    let edits = [
        ("-b - root", "-b + root"),
        ("disc > 0.0", "disc > 0.01"),
        ("1.0 + direction.y", "1.0001 + direction.y"),
        ("depth < MAX_DEPTH", "depth < 1"),
        ("hit = i;", "hit = 0;"),
        ("reflect(", "-reflect("),
        (
            "inputs.iResolution.x / inputs.iResolution.y",
            "inputs.iResolution.y / inputs.iResolution.x",
        ),
    ];
    for (from, to) in edits {
        let edit = |text: String| {
            assert_eq!(text.matches(from).count(), 1, "{from}\n{text}");
            text.replace(from, to)
        };
        let proof = proof(&mut worker, REFLECTIONS.shader, Style::Plain, edit);
        assert!(!proof.holds(), "{from} as {to}: {proof:?}");
    }
}

/// What naga and GLSL see differently, and what has no words in WGSL.
const CONSTRUCTS: &str = "
#define STEPS 4
#define PI 3.14159265
struct Pair { vec2 a; float b[3]; };
const vec2 TABLE[3] = vec2[3](vec2(0.1, 0.2), vec2(0.3), vec2(0.4, -0.5));
float seed = 0.5;
float next() { return fract(sin(seed++) * 437.5); }
float loop(float fn) { return fn * 2.0; }
float loop(vec2 fn) { return fn.x - fn.y; }
void both(inout vec3 v, out float w) { v.zx *= mat2(0.8, 0.6, -0.6, 0.8); w += v.y; v = v.yzx; }
int pick(int i) { switch (i % 4) { case 0: return 3; case 1: case 2: i += 2; break; default: i = -i; } return i; }
vec3 turn(vec3 p) { p.xy = p.yx; for (int i = 0, j = 3; i < j; i++, j--) p.z += float(i * j); return p; }
float walk(float x) { do { x += 0.25; if (x > 1.5) continue; x *= 1.1; } while (x < 2.0); return x; }
void mainImage(out vec4 c, in vec2 p) {
    vec2 uv = p / iResolution.xy, q;
    float a, b = 0.1 * 0.2 + 3.0 / 7.0;
    int n = 0;
    while (n++ < STEPS) { float fresh; fresh += uv.x; a += fresh * TABLE[n % 3].x; }
    Pair pair = Pair(uv, float[3](1.0, 2.0, next()));
    pair.b[n - 4] += a = b;
    vec3 v = vec3(uv, mod(p.x, 3.0));
    both(v, q.y);
    both(v, seed);
    bool near = uv.x < 0.5 && (b = next()) > 0.2 || uv.y > 0.9;
    float d = near ? loop(uv) : loop(v.x);
    mat3 m = mat3(1.0);
    m[1] = turn(v) * PI;
    mat2 r = mat2(m) * 0.5;
    ivec2 k = ivec2(p) >> 1 & 7;
    c = vec4(d + walk(uv.y), lessThan(uv, v.xy).x ? q.y : seed, dot(r * uv, pair.a) + pair.b[1], 1.0);
    c.rg += uv.x > 0.3 ? vec2(k) / 8.0 : vec2(pick(n), ~n) * 0.01;
    c.b = v.xy == uv ? 1.0 : (c.b += 0.25, c.b) + atan(uv.y, uv.x - 0.5) + float(uint(p.x) << 3u);
}";

#[test]
fn constructs_that_wgsl_lacks_are_said_otherwise_and_proved() {
    let Some(mut worker) = worker() else { return };
    for style in Style::ALL {
        let proof = proof(&mut worker, CONSTRUCTS, style, |text| text);
        assert!(proof.holds(), "{}: {proof:?}", style.name());
    }
}

#[test]
fn a_file_is_written_if_it_is_proved_and_says_so() {
    if worker().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("sphere.wgsl");
    let convert = |more: &[&str]| {
        let all = [
            &[
                "convert",
                "glsl/02-sphere.glsl",
                "--verify",
                "-o",
                out.to_str().unwrap(),
            ],
            more,
        ]
        .concat();
        toyproof(Path::new(env!("CARGO_MANIFEST_DIR")), &all)
    };
    let run = convert(&[]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout.contains("proved") && run.stdout.contains("equal to the bit"),
        "{}",
        run.stdout
    );
    let text = fs::read_to_string(&out).unwrap();
    assert!(
        text.contains("// Proved: this text, read again by naga and run on llvmpipe"),
        "{text}"
    );

    fs::remove_file(&out).unwrap();
    let run = convert(&["--on", "cpu"]);
    assert_eq!(run.code, 2);
    assert!(run.stdout.contains("takes a Vulkan driver"), "{}", run.stdout);
    assert!(!out.exists(), "what is not proved is not written");

    let run = convert(&["--on", "cpu", "--force"]);
    assert_eq!(run.code, 2, "it is still not proved");
    assert!(fs::read_to_string(&out).unwrap().contains("// NOT PROVED: "));
}

#[test]
fn a_folder_has_a_table_of_what_was_proved() {
    if worker().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("in"), folder.path().join("out"));
    fs::create_dir(&from).unwrap();
    for (name, text) in [
        (
            "a.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(sin(p), 0, 1); }",
        ),
        ("b.glsl", "void mainImage(out vec4 c, in vec2 p) { c = vec4(p); "),
        (
            "c.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(texture(iChannel0, p).rgb, 1); }",
        ),
    ] {
        fs::write(from.join(name), text).unwrap();
    }
    for (to_language, ending) in [
        ("wgsl", "wgsl"),
        ("spv", "spv"),
        ("hlsl", "hlsl"),
        ("metal", "metal"),
        ("glsl", "frag"),
    ] {
        let arguments = [
            "convert",
            from.to_str().unwrap(),
            "-o",
            to.to_str().unwrap(),
            "--to",
            to_language,
            "--verify",
        ];
        let run = toyproof(folder.path(), &arguments);
        assert_eq!(run.code, 1, "{to_language}: {}", run.stderr);
        let last = run.stdout.lines().last().unwrap_or_default();
        assert_eq!(
            last, "3 shaders: 2 proved, 0 not proved, 1 refused; 2 written",
            "{}",
            run.stdout
        );
        assert!(to.join(format!("c.{ending}")).exists() && !to.join(format!("b.{ending}")).exists());
    }
}
