//! HLSL from the tree, and the files for hosts: Unity, Windows Terminal, Slang and Godot.

use std::fs;
use std::path::Path;
use std::time::Duration;

use toyproof_convert::{ProofError, Prover, Runner, ShaderProof, Source, TargetCode};
use toyproof_diagnostic::{Deadline, File, Files};
use toyproof_glsl::check;
use toyproof_translate::c_family::{CHost, Title, write};

use crate::program::toyproof;
use crate::requirements::{require_driver, require_program, require_worker};

const TIMEOUT: Duration = Duration::from_secs(60);

/// Reads what differs between hosts: inputs, a texture, derivatives and the position.
pub(crate) const INPUTS: &str = "
float shade(vec2 p) { return p.y * 0.01 + dFdy(p.y * p.y) * 0.02 + gl_FragCoord.y * 0.001; }
void mainImage(out vec4 color, in vec2 p) {
    vec2 uv = p / iResolution.xy;
    color = vec4(fract(shade(p)), uv, 1.0) + sin(iTime) * 0.1 + float(iFrame % 7) * 0.01 + iMouse.x * 0.001;
}";

/// Proves the file for a host after one edit.
fn prove(host: CHost, shader: &str, from: &str, to: &str) -> Option<Result<ShaderProof, ProofError>> {
    if !require_program("glslangValidator") {
        return None;
    }
    let mut worker = require_worker()?;
    let mut files = Files::default();
    let file = files.add(File::new("shader", shader));
    let checked = check(&files, file, &Default::default()).expect("it is valid");
    let text = write(
        &checked,
        &files,
        host,
        Title::of_shader("shader"),
        &Deadline::default(),
    )
    .expect("it is written");
    assert!(text.contains(from), "{text}");
    let mut prover = Prover {
        runner: Runner::Driver(&mut worker),
        browser: None,
        timeout: TIMEOUT,
        pool: None,
    };
    let source = Source {
        checked: &checked,
        files: &files,
    };
    Some(prover.prove(source, &TargetCode::CFamily(text.replacen(from, to, 1), host)))
}

#[test]
fn files_for_hosts_are_proved() {
    for host in CHost::ALL.into_iter().filter(|host| host.read_as().is_some()) {
        let Some(proved) = prove(host, INPUTS, "", "") else {
            return;
        };
        let proof = proved.unwrap_or_else(|error| panic!("{}: {error}", host.name()));
        assert_eq!(proof.proof().equal(), proof.proof().pixels(), "{}", host.name());
    }
}

#[test]
fn faults_in_a_hosts_code_are_found() {
    for (host, from, to) in [
        (CHost::Hlsl, "position.xy);", "position.yx);"),
        (CHost::Hlsl, "packoffset(c0.w)", "packoffset(c1)"),
        (CHost::Unity, "? -1.0 : 1.0", "? 1.0 : -1.0"),
        (CHost::WindowsTerminal, "upward = -1.0", "upward = 1.0"),
        (CHost::Unity, "#define iTime _Time.y", "#define iTime _Time.x"),
        (CHost::WindowsTerminal, "Resolution.y - position.y", "position.y"),
        (
            CHost::WindowsTerminal,
            "#define iMouse float4(0.0",
            "#define iMouse float4(1.0",
        ),
        (CHost::Slang, "color.xyz, 1.0", "color.zyx, 1.0"),
        (CHost::Glsl, "color.rgb, 1.0", "color.bgr, 1.0"),
        (
            CHost::Glsl,
            "    float iTime;\n    float iTimeDelta;\n",
            "    float iTimeDelta;\n    float iTime;\n",
        ),
        (CHost::Godot, "size.y - FRAGCOORD.y", "FRAGCOORD.y"),
        (CHost::Godot, "? -1.0 : 1.0", "? 1.0 : -1.0"),
        (CHost::Godot, "#define iTime TIME", "#define iTime (2.0 * TIME)"),
        (CHost::Godot, "vec4(fragCoord, FRAGCOORD.zw)", "FRAGCOORD"),
    ] {
        let Some(proved) = prove(host, INPUTS, from, to) else {
            return;
        };
        assert!(
            matches!(proved, Err(ProofError::Differs { differing: 1.., .. })),
            "{}, {to}: {proved:?}",
            host.name()
        );
    }
}

#[test]
fn the_course_is_written_for_every_host() {
    if !require_driver() || !require_program("glslangValidator") {
        return;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let hosts = [
        ("unity", "shader"),
        ("windows-terminal", "hlsl"),
        ("slang", "slang"),
        ("godot", "gdshader"),
        ("plain", "hlsl"),
        ("plain", "frag"),
    ];
    for (style, extension) in hosts {
        let out = tempfile::tempdir().unwrap();
        let to = out.path().to_str().unwrap();
        let shaders = [
            "glsl/06-reflections.glsl",
            "glsl/13-importance-sampling.glsl",
            "glsl/2d/03-noise.glsl",
            "glsl/2d/05-matrices.glsl",
        ];
        let is_glsl = matches!(extension, "gdshader" | "frag");
        let language = if is_glsl { "glsl" } else { "hlsl" };
        let options = ["--to", language, "--style", style, "-o", to, "--verify"];
        let run = toyproof(folder, &[&["convert"][..], &shaders, &options].concat());
        assert_eq!(run.code, 0, "{style}: {}{}", run.stdout, run.stderr);
        assert!(!run.stdout.contains("by naga"), "{style}: {}", run.stdout);
        let written =
            fs::read_to_string(out.path().join("06-reflections").with_extension(extension)).unwrap();
        // The author's words are there, and no generated ones.
        assert!(
            written.contains("// Proved: this file, as read by glslangValidator"),
            "{written}"
        );
        assert!(
            !written.contains("toyproof_") && !written.contains("_e"),
            "{written}"
        );
    }
}

#[test]
fn what_a_host_lacks_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    c = iDate;\n}";
    fs::write(folder.path().join("date.glsl"), text).unwrap();
    let arguments = [
        "convert",
        "date.glsl",
        "-o",
        "date.hlsl",
        "--style",
        "windows-terminal",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(
        run.stderr
            .contains("`iDate` is not available in the style `windows-terminal`"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains("date.glsl:2:9"), "{}", run.stderr);
    let arguments = ["convert", "date.glsl", "-o", "date.wgsl", "--style", "unity"];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 2, "{}", run.stderr);
}

#[test]
fn passes_are_played_by_a_script() {
    if !require_driver() || !require_program("glslangValidator") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = toyproof(folder.path(), &["new", "project", "waves"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for (style, files) in [
        (
            "godot",
            ["buffer-a.gdshader", "image.gdshader", "main.tscn", "player.gd"],
        ),
        (
            "unity",
            ["ShaderToyPlayer.cs", "buffer-a.shader", "image.shader", ""],
        ),
    ] {
        let run = toyproof(
            folder.path(),
            &["convert", "waves", "-o", style, "--style", style, "--verify"],
        );
        assert_eq!(run.code, 0, "{style}: {}", run.stderr);
        assert!(
            run.stdout.contains("2 passes: 159,744 of 159,744 pixels"),
            "{}",
            run.stdout
        );
        let written = fs::read_dir(folder.path().join(style)).unwrap();
        let mut names: Vec<_> = written.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        let expected: Vec<_> = files.iter().copied().filter(|name| !name.is_empty()).collect();
        assert_eq!(names, expected);
    }
    // Buffers are not upside down, and keep their alpha.
    let buffer = fs::read_to_string(folder.path().join("godot/buffer-a.gdshader")).unwrap();
    assert!(buffer.contains("vec2 fragCoord = FRAGCOORD.xy;\n"), "{buffer}");
    assert!(buffer.contains("\tCOLOR = color;\n"), "{buffer}");
    assert!(
        buffer.contains("uniform sampler2D iChannel0 : filter_nearest, repeat_disable, hint_default_black;"),
        "{buffer}"
    );
    let buffer = fs::read_to_string(folder.path().join("unity/buffer-a.shader")).unwrap();
    assert!(
        buffer.contains("Shader \"ShaderToy/waves/buffer-a\" {"),
        "{buffer}"
    );
    assert!(
        buffer.contains("SamplerState point_clamp_iChannel0_state;"),
        "{buffer}"
    );
    assert!(buffer.contains("                return color;\n"), "{buffer}");
}

#[test]
fn proofs_need_no_driver() {
    if !require_program("glslangValidator") {
        return;
    }
    let out = tempfile::tempdir().unwrap();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, style) in [
        ("a.hlsl", "plain"),
        ("a.frag", "plain"),
        ("a.gdshader", "godot"),
        ("a.wgsl", "plain"),
    ] {
        let to = out.path().join(name);
        let arguments = [
            "convert",
            "glsl/02-sphere.glsl",
            "--style",
            style,
            "--verify",
            "--device",
            "cpu",
            "-o",
        ];
        let run = toyproof(folder, &[&arguments[..], &[to.to_str().unwrap()]].concat());
        assert_eq!(run.code, 0, "{name}: {}{}", run.stdout, run.stderr);
        let written = fs::read_to_string(to).unwrap();
        assert!(written.contains("and run on toyproof's evaluator"), "{written}");
    }
}

#[test]
fn what_naga_misreads_is_not_a_difference_of_the_conversion() {
    if !require_program("glslangValidator") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    float a = 0.0;\n    switch (int(p.x) % 4) {\n        case 0: a += 0.1;\n        \
        case 1: a += 0.2; break;\n        default: a += 0.3;\n        case 2: a += 0.4;\n    }\n    c = vec4(a);\n}\n";
    fs::write(folder.path().join("fall.glsl"), text).unwrap();
    let convert = |device| {
        let options = [
            "convert",
            "fall.glsl",
            "-o",
            "fall.frag",
            "--verify",
            "--device",
            device,
        ];
        toyproof(folder.path(), &options)
    };
    let run = convert("cpu");
    assert!(
        run.stdout
            .contains("as naga reads glslang's SPIR-V, which it may misread"),
        "{}",
        run.stdout
    );
    if require_driver() {
        let run = convert("auto");
        assert!(
            run.code == 0 && !run.stdout.contains("naga"),
            "{}{}",
            run.stdout,
            run.stderr
        );
    }
}

#[test]
fn the_extension_of_an_engine_names_its_style() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0, 1); }";
    fs::write(folder.path().join("a.glsl"), text).unwrap();
    for (output, style) in [
        ("a.gdshader", "godot"),
        ("a.shader", "unity"),
        ("a.slang", "slang"),
    ] {
        let run = toyproof(folder.path(), &["convert", "a.glsl", "-o", output]);
        assert_eq!(run.code, 2, "{}", run.stderr);
        assert!(
            run.stderr.contains(&format!("add --style {style}")),
            "{}",
            run.stderr
        );
        let run = toyproof(
            folder.path(),
            &["convert", "a.glsl", "-o", output, "--style", style],
        );
        assert_eq!(run.code, 0, "{}", run.stderr);
    }
}
