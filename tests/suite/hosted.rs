//! Shaders and projects in one file of a host: modules for three.js, and ISF.

use std::fs;
use std::path::Path;
use std::time::Duration;

use toyproof::gpu::browser::{Chromium, ThreeLibrary, ThreeModule};
use toyproof::image::{Frame, Image};

use crate::program::{Run, toyproof};
use crate::requirements::{require_chromium, require_driver, require_three};

/// A texture, a texel, its size, the mouse and the time.
const CHANNEL: &str = "// Looks through water.
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = fragCoord / iResolution.xy + 0.01 * sin(iTime + iMouse.y);
    fragColor = texture(iChannel0, uv) + texelFetch(iChannel0, ivec2(fragCoord) - 3, 0);
    fragColor.x += iChannelResolution[0].x / float(textureSize(iChannel0, 0).y) * step(0.5, iMouse.z);
}
";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Converts a shader, or a project of `tests/passes`, in a folder; returns the run and the file.
fn convert(folder: &Path, shader: &str, style: &str, extension: &str, more: &[&str]) -> (Run, String) {
    let input = match shader {
        CHANNEL => {
            fs::write(folder.join("channel.glsl"), shader).unwrap();
            folder.join("channel.glsl")
        }
        name if name.starts_with("glsl/") => root().join(name),
        name => root().join("tests/passes").join(name).join("project.json"),
    };
    let output = format!("out.{extension}");
    let arguments = [
        "convert",
        input.to_str().unwrap(),
        "-o",
        &output,
        "--style",
        style,
    ];
    let run = toyproof(folder, &[&arguments, more].concat());
    let text = fs::read_to_string(folder.join(&output)).unwrap_or_default();
    (run, text)
}

fn assert_has(text: &str, lines: &[&str]) {
    for line in lines {
        assert!(text.contains(line), "{line} is missing:\n{text}");
    }
}

#[test]
fn a_module_has_what_its_shader_needs() {
    let folder = tempfile::tempdir().unwrap();
    let (run, text) = convert(folder.path(), "glsl/11-animation.glsl", "three", "js", &[]);
    assert_eq!(run.code, 0, "{run:?}");
    assert_has(
        &text,
        &[
            "import * as THREE from \"three\";\n",
            "const imageShader = /* glsl */ `// A small solar system",
            "uniforms: [\"iTime\", \"iFrame\", \"iResolution\"],",
            "new THREE.RawShaderMaterial({",
            "constructor(renderer) {",
        ],
    );
    for absent in [
        "#if",
        "#endif",
        "$",
        "WebGLRenderTarget",
        "listen",
        "media",
        "#version",
    ] {
        assert!(!text.contains(absent), "{absent}:\n{text}");
    }
    let (run, text) = convert(folder.path(), CHANNEL, "three", "js", &[]);
    assert_eq!(run.code, 0, "{run:?}");
    assert_has(
        &text,
        &[
            "const media = {\n  iChannel0: {},\n};",
            "      iChannel0: { texture: \"iChannel0\" },",
            "readsChannelResolution: true,",
            "listen(element, \"pointerdown\"",
            "constructor(renderer, textures = {}) {",
        ],
    );
    let (run, text) = convert(folder.path(), "mipmap-feedback", "three", "js", &[]);
    assert_eq!(run.code, 0, "{run:?}");
    assert_has(
        &text,
        &[
            "iChannel0: { buffer: \"bufferA\", filter: \"mipmap\", wrap: \"clamp\" },",
            "generateMipmaps: filter === \"mipmap\",",
            "type: THREE.FloatType,",
        ],
    );
    assert!(!text.contains("Keyboard"), "{text}");
}

#[test]
fn modules_are_proved() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for shader in [
        "glsl/11-animation.glsl",
        CHANNEL,
        "common",
        "filter-per-pass",
        "mipmap-feedback",
        "game-of-life",
        "keyboard-idle",
    ] {
        let (run, text) = convert(folder.path(), shader, "three", "js", &["--verify"]);
        assert_eq!(run.code, 0, "{shader}: {run:?}");
        assert!(run.stdout.contains("equal, bit for bit"), "{shader}: {run:?}");
        assert!(text.contains("// Proved: this file"), "{text}");
    }
    let (_, text) = convert(folder.path(), "common", "three", "js", &["--verify"]);
    assert_has(&text, &["const common = /* glsl */ `", "${common}"]);
}

#[test]
fn modules_run_in_chromium_like_the_original() {
    if !require_driver() || require_chromium().is_none() {
        return;
    }
    let Some(three) = require_three() else { return };
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("node_modules")).unwrap();
    std::os::unix::fs::symlink(&three, folder.path().join("node_modules/three")).unwrap();
    for shader in [
        "glsl/11-animation.glsl",
        CHANNEL,
        "alpha",
        "two-filters-in-one-pass",
        "mipmap-feedback",
        "discard-two-frames-back",
        "reads-later",
    ] {
        let (run, text) = convert(folder.path(), shader, "three", "js", &["--verify", "--browser"]);
        assert_eq!(run.code, 0, "{shader}: {run:?}");
        assert!(
            run.stdout.contains("displayed pixels differs"),
            "{shader}: {run:?}"
        );
        assert!(text.contains(" with three.js "), "{text}");
    }
}

/// The images of a module in its first frames.
fn images(browser: &mut Chromium, text: &str) -> Vec<Image> {
    let module = ThreeModule {
        text,
        textures: Vec::new(),
    };
    let frame = |number: i32| Frame {
        size: [32, 18],
        frame: number,
        ..Frame::default()
    };
    let frames: Vec<_> = (0..4).map(|number| (frame(number), number == 0)).collect();
    browser.play_three(&module, &frames).unwrap()
}

/// A fault in how a module plays its passes shows in its images.
#[test]
fn planted_faults_in_modules_are_seen() {
    let Some(program) = require_chromium() else { return };
    let Some(three) = require_three() else { return };
    let library = ThreeLibrary::read(&three).unwrap();
    let mut browser = Chromium::new(program, Duration::from_secs(60)).with_three(library);
    let folder = tempfile::tempdir().unwrap();
    for (project, from, to) in [
        ("counter", "buffer.last = 1 - buffer.last;", ""),
        (
            "mipmap-feedback",
            "generateMipmaps: filter === \"mipmap\"",
            "generateMipmaps: false",
        ),
        ("discard-two-frames-back", "renderer.autoClear = false;", ""),
        (
            "counter",
            "iFrame: this.frame,\n      ...given",
            "...given,\n      iFrame: 0",
        ),
    ] {
        let (_, text) = convert(folder.path(), project, "three", "js", &[]);
        assert!(text.contains(from), "{from} is missing:\n{text}");
        let right = images(&mut browser, &text);
        let wrong = images(&mut browser, &text.replacen(from, to, 1));
        let is_equal = right.iter().zip(&wrong).all(|(a, b)| a.pixels() == b.pixels());
        assert!(!is_equal, "{project}: {from}");
    }
}

#[test]
fn isf_is_proved() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for shader in [
        "glsl/11-animation.glsl",
        "common",
        "game-of-life",
        "ring",
        "reads-later",
        "sweep-linear-clamp",
        "mouse-idle",
    ] {
        let (run, text) = convert(folder.path(), shader, "isf", "fs", &["--verify"]);
        assert_eq!(run.code, 0, "{shader}: {run:?}");
        assert!(run.stdout.contains("equal, bit for bit"), "{shader}: {run:?}");
        assert!(text.starts_with("/*{\n    \"DESCRIPTION\": "), "{text}");
        assert!(
            text.contains("}*/\n\n// ") && text.contains("// Proved: this file"),
            "{text}"
        );
    }
}

#[test]
fn isf_has_inputs_lookups_and_passes() {
    let folder = tempfile::tempdir().unwrap();
    let (run, text) = convert(folder.path(), CHANNEL, "isf", "fs", &[]);
    assert_eq!(run.code, 0, "{run:?}");
    assert_has(
        &text,
        &[
            "\"DESCRIPTION\": \"Looks through water.\",",
            "\"NAME\": \"iChannel0\",\n            \"TYPE\": \"image\"",
            "\"NAME\": \"mouse\",\n            \"TYPE\": \"point2D\"",
            "vec2 uv = fragCoord / RENDERSIZE + 0.01 * sin(TIME + iMouse.y);",
            "fragColor = IMG_NORM_PIXEL(iChannel0, uv) + iChannel0Texel(ivec2(fragCoord) - 3);",
            "IMG_SIZE(iChannel0).x / float(ivec2(IMG_SIZE(iChannel0)).y)",
            "    return isInside ? IMG_PIXEL(iChannel0, center) : vec4(0.0);",
        ],
    );
    assert!(!text.contains("#version") && !text.contains("uniform"), "{text}");
    let (run, text) = convert(folder.path(), "game-of-life", "isf", "fs", &[]);
    assert_eq!(run.code, 0, "{run:?}");
    assert_has(
        &text,
        &[
            "\"TARGET\": \"bufferA\",\n            \"PERSISTENT\": true,\n            \"FLOAT\": true",
            "    if (PASSINDEX == 0) {\n        renderA();\n    } else {\n        renderImage();\n    }\n",
            "void mainImageA(out vec4 fragColor",
        ],
    );
}

#[test]
fn what_isf_does_not_have_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    for (lookup, message) in [
        ("textureLod(iChannel0, p, 2.0)", "`textureLod` that reads mipmaps"),
        ("look(iChannel0, p)", "`iChannel0` outside of a lookup"),
        ("texture(iChannel0, p, 1.5)", "`texture` that reads mipmaps"),
        ("vec4(iSampleRate)", "`iSampleRate` is not set by ISF"),
    ] {
        let text = format!(
            "vec4 look(sampler2D s, vec2 p) {{ return vec4(p, 0, 1); }}\n\
             void mainImage(out vec4 c, in vec2 p) {{\n    c = {lookup};\n}}\n"
        );
        fs::write(folder.path().join("lookup.glsl"), text).unwrap();
        let run = toyproof(
            folder.path(),
            &["convert", "lookup.glsl", "-o", "x.fs", "--style", "isf"],
        );
        assert_eq!(run.code, 2, "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
        assert!(run.stderr.contains("lookup.glsl:3:"), "{run:?}");
    }
    for (project, message) in [
        (
            "keyboard-idle",
            "Image reads the keyboard, which ISF does not have",
        ),
        (
            "mipmap-feedback",
            "reads mipmaps of a buffer, which ISF does not have",
        ),
        ("discard-checkerboard", "Buffer A has `discard`"),
    ] {
        let (run, _) = convert(folder.path(), project, "isf", "fs", &[]);
        assert_eq!(run.code, 2, "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
    }
}
