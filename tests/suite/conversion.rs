//! Conversions and their proofs: correct ones are proved, in every style, and wrong ones are not.

use std::path::Path;
use std::process::Command;
use std::time::Duration;
use std::{env, fs};

use ::spirv::Op;
use toyproof::convert::{
    Proof, ProofError, Prover, Runner, Source, TargetCode, compare_with_original, frames,
};
use toyproof::diagnostic::{Deadline, File, Files};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::{ShaderArtifact, Worker};
use toyproof::translate::backend::{Target, emit, roundtrip, spirv};
use toyproof::translate::lower;
use toyproof::translate::naga_ir::{Shape, ValidModule};
use toyproof::translate::wgsl::{Style, wgsl};

use crate::program::{command, run, toyproof};
use crate::requirements::{require_chromium, require_driver, require_program, require_worker};
use crate::support::{ANIMATION, EVERY_EXERCISE, Exercise, REFLECTIONS};

const TIMEOUT: Duration = Duration::from_secs(60);

/// Compares a shader's WGSL, edited by `edit`, with the shader.
fn proof(worker: &mut Worker, shader: &str, style: Style, edit: impl Fn(String) -> String) -> Proof {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Options::default()).expect("it is valid");
    let text =
        wgsl(&checked, &files, style, &Deadline::default()).unwrap_or_else(|why| panic!("{why}\n{shader}"));
    let hosted = style.hosted(&edit(text));
    let whole = hosted.text.clone();
    proof_of(worker, &checked, ShaderArtifact::Wgsl(hosted))
        .unwrap_or_else(|failure| panic!("{failure}\n{whole}"))
}

/// Compares a conversion with the shader.
fn proof_of(worker: &mut Worker, checked: &Checked, written: ShaderArtifact) -> Result<Proof, ProofError> {
    let mut runner = Runner::Driver(worker);
    let frames = frames(checked);
    let proofs = compare_with_original(&mut runner, checked, vec![written], &frames, TIMEOUT, None)?;
    Ok(proofs.into_iter().next().expect("a proof for each reading"))
}

fn checked(shader: &str) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    check(&files, file, &Options::default()).expect("it is valid")
}

/// Asserts that the conversion is proved.
fn holds(worker: &mut Worker, exercise: &Exercise, style: Style) {
    let proof = proof(worker, exercise.shader, style, |text| text);
    assert!(proof.holds(), "{} as {}: {proof:?}", exercise.name, style.name());
}

#[test]
fn every_exercise_is_proved() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for exercise in EVERY_EXERCISE {
        holds(&mut worker, exercise, Style::Plain);
    }
}

#[test]
fn every_exercise_is_proved_without_a_driver() {
    for exercise in EVERY_EXERCISE {
        let mut files = Files::default();
        let file = files.add(File::new(exercise.name, exercise.shader));
        let checked = check(&files, file, &Options::default()).expect("it is valid");
        let text = wgsl(&checked, &files, Style::Plain, &Deadline::default()).unwrap();
        let mut prover = Prover {
            runner: Runner::Evaluator(None),
            browser: None,
            timeout: TIMEOUT,
            pool: None,
        };
        let source = Source {
            checked: &checked,
            files: &files,
        };
        let proved = prover.prove(source, &TargetCode::Wgsl(text, Style::Plain));
        assert!(proved.is_ok(), "{}: {proved:?}", exercise.name);
    }
}

#[test]
fn every_style_is_proved() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for style in Style::ALL {
        for exercise in [&REFLECTIONS, &ANIMATION] {
            holds(&mut worker, exercise, style);
        }
    }
}

/// The prelude of compute.toys, reconstructed: names and types from the bind.rs of its renderer.
const COMPUTE_TOYS: &str = "
    alias int = i32; alias uint = u32; alias float = f32;
    alias float2 = vec2<f32>; alias float3 = vec3<f32>; alias float4 = vec4<f32>;
    struct Time { frame: uint, elapsed: float, delta: float }
    struct Mouse { pos: vec2u, click: int }
    struct DispatchInfo { id: uint }
    struct Custom { _dummy: float }
    struct Data { _dummy: array<u32, 1> }
    @group(0) @binding(2) var<uniform> time: Time;
    @group(0) @binding(3) var<uniform> mouse: Mouse;
    @group(0) @binding(5) var<uniform> custom: Custom;
    @group(0) @binding(6) var<storage, read> data: Data;
    @group(0) @binding(8) var<uniform> dispatch: DispatchInfo;
    @group(0) @binding(9) var screen: texture_storage_2d<rgba16float, write>;
    @group(0) @binding(10) var pass_in: texture_2d_array<f32>;
    @group(0) @binding(11) var pass_out: texture_storage_2d_array<rgba16float, write>;
    @group(0) @binding(12) var channel0: texture_2d<f32>;
    @group(0) @binding(13) var channel1: texture_2d<f32>;
    @group(0) @binding(14) var nearest: sampler;
    @group(0) @binding(15) var bilinear: sampler;
    @group(0) @binding(16) var trilinear: sampler;
    @group(0) @binding(17) var nearest_repeat: sampler;
    @group(0) @binding(18) var bilinear_repeat: sampler;
    @group(0) @binding(19) var trilinear_repeat: sampler;
    ";

/// The Bevy modules that a shader imports, reconstructed, each substituted for its import.
const BEVY: [(&str, &str); 3] = [
    (
        "#import bevy_sprite::mesh2d_vertex_output::VertexOutput",
        "struct VertexOutput {
            @builtin(position) position: vec4<f32>,
            @location(0) world_position: vec4<f32>,
            @location(1) world_normal: vec3<f32>,
            @location(2) uv: vec2<f32>,
        }",
    ),
    (
        "#import bevy_sprite::mesh2d_view_bindings::{globals, view}",
        "struct View { clip_from_world: mat4x4<f32>, viewport: vec4<f32> }
        struct Globals { time: f32, delta_time: f32, frame_count: u32 }
        @group(0) @binding(0) var<uniform> view: View;
        @group(0) @binding(1) var<uniform> globals: Globals;",
    ),
    ("#{MATERIAL_BIND_GROUP}", "2"),
];

#[test]
fn conversions_are_valid_in_their_hosts_modules() {
    let with_channels = "const float data = 2.0;
        void mainImage(out vec4 c, in vec2 p) {
            c = texture(iChannel0, p / iResolution.xy) * data + texture(iChannel1, p / iResolution.xy) * fract(iTime);
            c.x += float(iFrame % 3) * iTimeDelta + gl_FragCoord.x + iMouse.z;
        }";
    for shader in [with_channels, REFLECTIONS.shader, ANIMATION.shader] {
        let mut files = Files::default();
        let file = files.add(File::new("shader", shader));
        let checked = check(&files, file, &Options::default()).expect("it is valid");
        let valid = |text: &str| ValidModule::of_wgsl(text).unwrap_or_else(|why| panic!("{why}\n{text}"));
        let text = wgsl(&checked, &files, Style::ComputeToys, &Deadline::default()).unwrap();
        let compute = valid(&format!("{COMPUTE_TOYS}{text}"));
        assert_eq!(compute.module().entry_points[0].name, "main_image");
        assert_eq!(compute.module().entry_points[0].workgroup_size, [16, 16, 1]);
        let text = wgsl(&checked, &files, Style::Bevy, &Deadline::default()).unwrap();
        let composed = BEVY.iter().fold(text, |text, (from, to)| text.replace(from, to));
        assert_eq!(valid(&composed).module().entry_points[0].name, "fragment");
    }
}

#[test]
fn wrong_conversions_are_not_proved() {
    let Some(mut worker) = require_worker() else {
        return;
    };
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

/// A shader's file in that language.
fn emitted(checked: &Checked, target: Target) -> Vec<u8> {
    let module = ValidModule::parse(&lower(checked)).expect("naga takes it");
    emit(&module, target).expect("naga writes it")
}

/// The SPIR-V that a driver gets, with every operation `from` replaced by `to`; there is at least one.
fn words(checked: &Checked, from: Op, to: Op) -> ShaderArtifact {
    let mut words = spirv::of_bytes(&emitted(checked, Target::Spirv)).expect("whole words");
    let mut at = 5;
    let mut changed = 0;
    while at < words.len() {
        if words[at] & 0xffff == from as u32 {
            words[at] = words[at] & 0xffff_0000 | to as u32;
            changed += 1;
        }
        at += (words[at] >> 16) as usize;
    }
    assert!(changed > 0, "{from:?}");
    ShaderArtifact::Words {
        words,
        channels: [Shape::D2; 4],
        upside_down: false,
    }
}

#[test]
fn exact_spirv_is_proved_and_modified_is_not() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for shader in [REFLECTIONS.shader, CONSTRUCTS] {
        let checked = checked(shader);
        let as_written = words(&checked, Op::FAdd, Op::FAdd);
        let proof = proof_of(&mut worker, &checked, as_written).unwrap();
        assert!(proof.holds(), "{proof:?}");
        let wrong = words(&checked, Op::FAdd, Op::FSub);
        let proof = proof_of(&mut worker, &checked, wrong).unwrap();
        assert!(!proof.holds(), "{proof:?}");
    }
}

#[test]
fn reread_glsl_is_proved_and_modified_is_not() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let checked_shader = checked(REFLECTIONS.shader);
    let text = String::from_utf8(emitted(&checked_shader, Target::Glsl)).unwrap();
    for (from, to, holds) in [("", "", true), ("reflect(", "-reflect(", false)] {
        assert!(text.contains(from));
        let again = checked(&roundtrip::as_shadertoy(&text.replacen(from, to, 1)));
        let written = ShaderArtifact::Lowered(lower(&again));
        let proof = proof_of(&mut worker, &checked_shader, written).unwrap();
        assert_eq!(proof.holds(), holds, "{from}: {proof:?}");
    }
}

/// Constructs that naga and GLSL interpret differently, and constructs that WGSL lacks.
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
    uvec2 bits = uvec2(p);
    bits ^= uint(n);
    bits &= 63u;
    vec2 steps = p;
    float last = (--steps.yx).x + (steps.yx++).y;
    c.g += float(bits.x | bits.y) * 0.01 + (last + steps.x) * 0.001;
    c.b = v.xy == uv ? 1.0 : (c.b += 0.25, c.b) + atan(uv.y, uv.x - 0.5) + float(uint(p.x) << 3u);
}";

#[test]
fn constructs_that_wgsl_lacks_are_replaced_and_proved() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for style in Style::ALL {
        let proof = proof(&mut worker, CONSTRUCTS, style, |text| text);
        assert!(proof.holds(), "{}: {proof:?}", style.name());
    }
}

#[test]
fn proved_files_are_written_with_a_header() {
    if !require_driver() {
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
        run.stdout.contains("proved") && run.stdout.contains("equal, bit for bit"),
        "{}",
        run.stdout
    );
    let text = fs::read_to_string(&out).unwrap();
    assert!(
        text.contains("// Proved: this file, as read by naga and run on llvmpipe"),
        "{text}"
    );

    fs::remove_file(&out).unwrap();
    let run = convert(&["--device", "cpu"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let text = fs::read_to_string(&out).unwrap();
    assert!(text.contains("and run on toyproof's evaluator,"), "{text}");

    fs::remove_file(&out).unwrap();
    let undefined = folder.path().join("undefined.glsl");
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, pow(-p.x, 2.0), 1); }";
    fs::write(&undefined, text).unwrap();
    let convert = |options: &[&str]| {
        let arguments = [
            "convert",
            undefined.to_str().unwrap(),
            "-o",
            out.to_str().unwrap(),
            "--verify",
        ];
        toyproof(folder.path(), &[&arguments[..], options].concat())
    };
    let run = convert(&[]);
    assert_eq!(run.code, 2);
    assert!(
        run.stdout.contains("every pixel depends on undefined behavior"),
        "{}",
        run.stdout
    );
    assert!(!out.exists(), "what is not proved is not written");

    let run = convert(&["--force"]);
    assert_eq!(run.code, 2, "it is still not proved");
    assert!(fs::read_to_string(&out).unwrap().contains("// NOT PROVED: "));
}

#[test]
fn unprovable_shaders_name_the_operation_and_position() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(p, pow(-p.x, 2.0), 1);\n}\n";
    fs::write(folder.path().join("a.glsl"), text).unwrap();
    let run = toyproof(folder.path(), &["convert", "a.glsl", "--verify", "-o", "a.wgsl"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    let why = "every pixel depends on undefined behavior, such as `pow` of a negative base, or of base 0 and an exponent ≤ 0 at a.glsl:2:17; not written";
    assert!(run.stdout.contains(why), "{}", run.stdout);
}

#[test]
fn folders_have_a_proof_table() {
    if !require_driver() {
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
        let statuses: Vec<_> = run
            .stdout
            .lines()
            .filter_map(|line| line.split(' ').next())
            .collect();
        assert_eq!(statuses, ["proved", "refused", "proved"], "{}", run.stdout);
        let summary = "3 shaders: 2 proved, 1 refused, 2 written to ";
        assert!(run.stderr.contains(summary), "{}", run.stderr);
        assert!(to.join(format!("c.{ending}")).exists() && !to.join(format!("b.{ending}")).exists());
    }
}

/// The header of each language's file states its proof.
#[test]
fn files_in_every_language_state_their_proof() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let textured = "void mainImage(out vec4 c, in vec2 p) {
        vec2 uv = p / iResolution.xy;
        c = texture(iChannel2, uv) * fract(sin(iTime)) + iMouse.x * 0.001 + texture(iChannel0, uv.yx) + iDate.w;
        c.xy *= mat2(0.8, 0.6, -0.6, 0.8);
    }";
    let shader = folder.path().join("textured.glsl");
    fs::write(&shader, textured).unwrap();
    let glslang = require_program("glslangValidator");
    for (ending, words) in [
        ("wgsl", "as read by naga and run on"),
        ("spv", "as read by the driver and run on"),
        (
            "frag",
            if glslang {
                "as read by glslangValidator (Glslang Version"
            } else {
                "as read by toyproof's GLSL front end and run on"
            },
        ),
        (
            "hlsl",
            if glslang {
                "as read by glslangValidator (Glslang Version"
            } else {
                "No compiler for the text was installed"
            },
        ),
        ("metal", "No compiler for the text was installed"),
    ] {
        let out = folder.path().join(format!("out.{ending}"));
        let arguments = [
            "convert",
            shader.to_str().unwrap(),
            "-o",
            out.to_str().unwrap(),
            "--verify",
        ];
        let run = toyproof(folder.path(), &arguments);
        assert_eq!(run.code, 0, "{ending}: {}{}", run.stdout, run.stderr);
        let bytes = fs::read(&out).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.contains(words), "{ending}: {}", &text[..text.len().min(900)]);
        if ending == "spv" && require_program("spirv-val") {
            let validated = Command::new("spirv-val").arg(&out).output().unwrap();
            assert!(validated.status.success(), "{validated:?}");
        }
    }
}

/// Names that surround a shader in some language: ours, naga's, those of hosts and of the preludes that
/// replace them.
const SURROUNDING_NAMES: &str = "toyproof_color toyproof_result toyproof_image_color toyproof_frame ToyproofFrame toyproof_size \
    toyproof_library_0 toyproof_sin toyproof_start toyproof_remainder toyproof_t1 toyproof_s1 main_1 global inputs Inputs \
    position color saturate screen time view View globals Globals fragment VertexOutput kept written_main written_color \
    writtenn_at written_image FragmentInput_main FragmentOutput ConstructRay constructRay naga_mod naga_div i_time \
    frag_coord shader_main main_image f32 vec3f lerp frac mul tex2D Texture2D SamplerState float4 main_ kernel size id \
    pixel iChannel0_sampler sampler0 channel0 Varyings vertex appdata_img Time Resolution Background shaderTexture \
    text fragCoord noise line point half3 make_Ray";

/// A shader whose author uses all of these names.
fn named(declared: impl Fn(&str) -> String, used: impl Fn(&str) -> String) -> String {
    let names = SURROUNDING_NAMES.split_whitespace();
    let declarations: String = names.clone().map(declared).collect();
    let uses: String = names.map(used).collect();
    format!(
        "struct Ray {{ float x; }};
        {declarations}
        void mainImage(out vec4 c, in vec2 p) {{
            float s = sin(iTime) + float(int(p.x) % 3) + Ray(p.x).x + texture(iChannel0, p / iResolution.xy).x;
            {uses}
            c = vec4(fract(s), sin(s), cos(p.y), 1.0);
        }}"
    )
}

#[test]
fn authors_may_use_names_of_the_surrounding_code() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let shaders = [
        named(
            |name| format!("float {name} = 0.5;\n"),
            |name| format!("{name} += p.x * 0.01; s += {name};\n"),
        ),
        named(
            |name| format!("const float {name} = 0.5;\n"),
            |name| format!("s += {name} * p.y;\n"),
        ),
        named(
            |name| format!("float {name}(float x) {{ return x * 0.25; }}\n"),
            |name| format!("s += {name}(p.x);\n"),
        ),
        named(
            |name| format!("struct {name} {{ float x; float y; }};\n"),
            |name| format!("s += {name}(p.x, 1.0).x;\n"),
        ),
        named(
            |_| String::new(),
            |name| format!("float {name} = s * 0.5; s += float(int({name}) % 3) + Ray({name}).x * 0.01;\n"),
        ),
    ];
    for (number, text) in shaders.iter().enumerate() {
        let shader = folder.path().join(format!("{number}.glsl"));
        fs::write(&shader, text).unwrap();
        let targets = ["wgsl", "spv", "frag", "hlsl", "metal"].map(|ending| (ending, "plain"));
        let styles = ["wgpu-shadertoy", "compute-toys", "bevy"].map(|style| ("wgsl", style));
        let hosts = [("shader", "unity"), ("slang", "slang")];
        let hosts = hosts.into_iter().filter(|_| require_program("glslangValidator"));
        for (ending, style) in targets.into_iter().chain(styles).chain(hosts) {
            let out = folder.path().join(format!("out.{ending}"));
            let arguments = [
                "convert",
                shader.to_str().unwrap(),
                "-o",
                out.to_str().unwrap(),
                "--verify",
                "--style",
                style,
            ];
            let run = toyproof(folder.path(), &arguments);
            assert_eq!(
                run.code, 0,
                "{ending} {style}: {}{}\n{text}",
                run.stdout, run.stderr
            );
            // Nothing here reads Metal, so naga's is proved.
            assert!(
                ending == "metal" || !run.stdout.contains("written by naga"),
                "{style}: {}\n{text}",
                run.stdout
            );
        }
    }
}

#[test]
fn hlsl_is_read_without_optimization() {
    if !require_driver() || !require_program("glslangValidator") {
        return;
    }
    // An optimizer would fold these two products into one, and the sum into `fma`.
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {
        float angle = 6.28318530718 * p.x / 240.0;
        c = vec4(angle, p.x / 2.8 + 0.1 * p.y, 0.1 * p.x / 0.3 * 0.7, 1.0);
    }";
    fs::write(folder.path().join("shader.glsl"), text).unwrap();
    let arguments = ["convert", "shader.glsl", "-o", "shader.hlsl", "--verify"];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
}

#[test]
fn files_are_written_while_others_are_in_progress() {
    let folder = tempfile::tempdir().unwrap();
    let from = folder.path().join("in");
    fs::create_dir(&from).unwrap();
    // It is first, and slow to read.
    let long = format!(
        "void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0);\n{}}}",
        "c += 0.001;\n".repeat(10_000)
    );
    fs::write(from.join("a.glsl"), long).unwrap();
    let short = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }";
    fs::write(from.join("b.glsl"), short).unwrap();
    let arguments = ["convert", "in", "-o", "out", "--to", "wgsl", "--jobs", "2"];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let written = |name: &str| {
        let path = folder.path().join("out").join(name);
        fs::metadata(path).unwrap().modified().unwrap()
    };
    assert!(
        written("b.wgsl") < written("a.wgsl"),
        "it did not wait for the first"
    );
}

#[test]
fn the_browser_runs_on_request_and_leaves_nothing_behind() {
    if !require_driver() || require_chromium().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let temporary = folder.path().join("tmp");
    fs::create_dir(&temporary).unwrap();
    for (ending, style) in [("wgsl", "plain"), ("wgsl", "compute-toys"), ("frag", "plain")] {
        let out = folder.path().join(format!("out.{ending}"));
        let mut convert = command(Path::new(env!("CARGO_MANIFEST_DIR")));
        convert
            .env("TMPDIR", &temporary)
            .args(["convert", "glsl/06-reflections.glsl", "--verify", "--browser"])
            .args(["--timeout", "1m", "-o", out.to_str().unwrap()]);
        if style != "plain" {
            convert.args(["--style", style]);
        }
        let run = run(&mut convert);
        assert_eq!(run.code, 0, "{ending} {style}: {}{}", run.stdout, run.stderr);
        let text = fs::read_to_string(&out).unwrap();
        assert!(text.contains(" on SwiftShader renders these frames"), "{text}");
        let left: Vec<_> = fs::read_dir(&temporary)
            .unwrap()
            .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
            .filter(|name| name.starts_with("toyproof-browser-"))
            .collect();
        assert!(left.is_empty(), "{left:?}");
    }
    let refused = toyproof(
        folder.path(),
        &["convert", "a.glsl", "-o", "a.spv", "--verify", "--browser"],
    );
    assert_eq!(refused.code, 2, "browsers run no SPIR-V: {}", refused.stderr);
}
