//! Converted projects: correct ones are proved in every language, planted faults in files and graphs are found,
//! and the example hosts render the same images.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde_json::{Value, json};
use toyproof::convert::{
    GraphContent, PassSources, PassesProof, ProofError, Prover, Runner, Source, TargetCode,
};
use toyproof::diagnostic::{Deadline, File, Files};
use toyproof::glsl::{self, Checked, Filter, Wrap};
use toyproof::image;
use toyproof::player::{Graph, Pass, Source as Read, Target};
use toyproof::project::{PassKind, Project, Rendering, check};
use toyproof::translate::wgsl::{Style, wgsl};

use crate::program::{Run, toyproof};
use crate::requirements::{require_chromium, require_driver, require_worker};
use crate::support::devtools::Page;
use crate::support::wait::wait_until;

#[path = "../../examples/hosts/passes.rs"]
mod host;

const TIMEOUT: Duration = Duration::from_secs(60);

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn project(name: &str) -> PathBuf {
    root().join("tests/passes").join(name).join("project.json")
}

/// Converts a project into a folder.
fn convert(name: &str, folder: &Path, more: &[&str]) -> Run {
    let (project, folder) = (project(name), folder.to_str().unwrap());
    let all = [&["convert", project.to_str().unwrap(), "-o", folder], more].concat();
    toyproof(root(), &all)
}

/// A converted project, as a proof takes it.
struct Converted {
    files: Files,
    passes: Vec<Checked>,
    rendering: Rendering,
    texts: Vec<String>,
    graph: GraphContent,
}

impl Converted {
    fn new(name: &str) -> Self {
        let mut files = Files::default();
        let file = files.add(File::new(name, fs::read_to_string(project(name)).unwrap()));
        let project = Project::from_json(&mut files, file).unwrap();
        let checked = check(&project, &mut files, &glsl::Options::default()).unwrap();
        let all: Vec<Checked> = checked.passes.into_iter().map(|pass| pass.checked).collect();
        let rendering = project.rendering(&[PassKind::Image]).unwrap();
        let passes: Vec<Checked> = rendering.passes.iter().map(|&at| all[at].clone()).collect();
        let text = |pass: &Checked| wgsl(pass, &files, Style::Plain, &Deadline::default()).unwrap();
        Self {
            texts: passes.iter().map(text).collect(),
            graph: GraphContent {
                graph: rendering.graph.clone(),
                sampling: passes.iter().map(|pass| pass.sampling).collect(),
            },
            files,
            passes,
            rendering,
        }
    }

    /// Changes what a pass reads.
    fn edit(&mut self, edit: impl FnOnce(&mut [Pass])) {
        let mut passes = self.graph.graph.passes().to_vec();
        edit(&mut passes);
        self.graph.graph = Graph::new(passes, self.graph.graph.formats().clone());
    }

    /// Proves it; none without a driver.
    fn prove(&self) -> Option<Result<PassesProof, ProofError>> {
        let mut worker = require_worker()?;
        Some(self.prove_with(Runner::Driver(&mut worker)))
    }

    /// Proves it without a driver.
    fn prove_on_evaluator(&self) -> Result<PassesProof, ProofError> {
        self.prove_with(Runner::Evaluator(None))
    }

    fn prove_with(&self, runner: Runner) -> Result<PassesProof, ProofError> {
        let files = &self.files;
        let sources: Vec<_> = self
            .passes
            .iter()
            .map(|checked| Source { checked, files })
            .collect();
        let passes = PassSources {
            sources: &sources,
            graph: &self.rendering.graph,
            media: &self.rendering.media,
        };
        let texts = self.texts.iter();
        let written: Vec<_> = texts
            .map(|text| TargetCode::Wgsl(text.clone(), Style::Plain))
            .collect();
        let mut prover = Prover {
            runner,
            browser: None,
            timeout: TIMEOUT,
            pool: None,
        };
        prover.prove_passes(&passes, &written, &self.graph)
    }

    /// What the proof says of the first pass that differs.
    fn difference(&self) -> String {
        match self.prove() {
            Some(Err(error @ ProofError::PassesDiffer(_))) => error.to_string(),
            Some(other) => panic!("the fault is not found: {other:?}"),
            None => String::new(),
        }
    }
}

#[test]
fn projects_are_proved() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["ring", "alpha", "mipmap-feedback", "discard-two-frames-back"];
    let devices: &[&str] = if require_driver() {
        &["lavapipe", "cpu"]
    } else {
        &["cpu"]
    };
    for (name, device) in names
        .iter()
        .flat_map(|name| devices.iter().map(move |device| (name, device)))
    {
        let run = convert(name, folder.path(), &["--verify", "--device", device]);
        assert_eq!(run.code, 0, "{name}: {}{}", run.stdout, run.stderr);
        assert!(
            run.stdout.contains("equal, bit for bit"),
            "{name}: {}",
            run.stdout
        );
        let image = fs::read_to_string(folder.path().join("image.wgsl")).unwrap();
        assert!(
            image.contains("// Proved: this file and those of the other passes"),
            "{image}"
        );
    }
}

#[test]
fn chromium_renders_converted_passes_like_the_original() {
    if !require_driver() || require_chromium().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for language in ["wgsl", "glsl"] {
        let run = convert(
            "mipmap-functions",
            folder.path(),
            &["--to", language, "--verify", "--browser"],
        );
        assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
        assert!(
            run.stdout
                .contains("in Chromium none of 159,744 displayed pixels differs"),
            "{}",
            run.stdout
        );
    }
}

/// A project whose Buffer A and Image read a cube map and a volume of the site, with all filters.
const LAYERED: &str = r#"{"ver": "0.1", "info": {"id": "x", "name": "layered"}, "renderpass": [
    {"name": "Buffer A", "type": "buffer", "outputs": [{"channel": 0, "id": "4dXGR8"}], "inputs": [
        {"channel": 0, "type": "cubemap", "id": "4sfGzn", "sampler": {"filter": "mipmap", "wrap": "clamp"}},
        {"channel": 1, "type": "volume", "id": "4sfGRr", "sampler": {"filter": "linear", "wrap": "repeat"}}],
     "code": "void mainImage(out vec4 c, in vec2 p) { vec2 uv = 2.0 * p / iResolution.xy - 1.0; c = texture(iChannel0, vec3(uv, 0.3)) + texture(iChannel1, vec3(uv, iTime)); }"},
    {"name": "Image", "type": "image", "outputs": [{"channel": 0, "id": "4dfGRr"}], "inputs": [
        {"channel": 0, "type": "buffer", "id": "4dXGR8", "sampler": {"filter": "linear", "wrap": "clamp"}},
        {"channel": 1, "type": "volume", "id": "4sfGRr", "sampler": {"filter": "nearest", "wrap": "clamp"}}],
     "code": "void mainImage(out vec4 c, in vec2 p) { vec2 uv = 2.0 * p / iResolution.xy - 1.0; c = texture(iChannel0, uv) + textureLod(iChannel1, vec3(uv, 0.2), 0.0); }"}]}"#;

/// One without a buffer, whose channels have textures of the proof's own.
const SAMPLED: &str = r#"{"ver": "0.1", "info": {"id": "x", "name": "sampled"}, "renderpass": [
    {"name": "Image", "type": "image", "outputs": [{"channel": 0, "id": "4dfGRr"}], "inputs": [
        {"channel": 2, "type": "cubemap", "id": "4sfGzn", "sampler": {"filter": "linear", "wrap": "clamp"}},
        {"channel": 3, "type": "volume", "id": "4sfGRr", "sampler": {"filter": "nearest", "wrap": "clamp"}}],
     "code": "void mainImage(out vec4 c, in vec2 p) { vec3 d = vec3(2.0 * p / iResolution.xy - 1.0, sin(iTime) + 0.3); c = texture(iChannel2, d) + 0.1 * texture(iChannel3, d.zxy) + texelFetch(iChannel3, ivec3(3, 2, 1), 0); }"}]}"#;

#[test]
fn cube_maps_and_volumes_are_proved_and_rendered_by_chromium() {
    if !require_driver() || require_chromium().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("layered", LAYERED), ("sampled", SAMPLED)] {
        let file = folder.path().join(name).with_extension("json");
        fs::write(&file, text).unwrap();
        let convert = |language: &str, more: &[&str]| {
            let output = format!("{}/", folder.path().join(name).display());
            let fixed = [
                "convert",
                file.to_str().unwrap(),
                "-o",
                &output,
                "--to",
                language,
                "--verify",
            ];
            let run = toyproof(root(), &[&fixed[..], more].concat());
            assert_eq!(run.code, 0, "{name} {language}: {}{}", run.stdout, run.stderr);
            assert!(run.stdout.contains("pixels equal, bit for bit"), "{}", run.stdout);
            run.stdout
        };
        convert("spv", &[]);
        for language in ["wgsl", "glsl"] {
            let said = convert(language, &["--browser"]);
            assert!(said.contains("displayed pixels differs"), "{said}");
        }
    }
}

#[test]
#[ignore = "takes minutes: all projects in all languages"]
fn every_project_is_proved_in_every_language() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (language, unproved) in [
        ("wgsl", &[][..]),
        ("spv", &[]),
        ("metal", &[]),
        ("hlsl", &[]),
        // glslang has no `mix` of integers in this version.
        ("glsl", &["game-of-life"]),
    ] {
        let entries = fs::read_dir(root().join("tests/passes")).unwrap();
        for entry in entries
            .map(|entry| entry.unwrap())
            .filter(|entry| entry.path().is_dir())
        {
            let name = entry.file_name().into_string().unwrap();
            let expected = fs::read_to_string(entry.path().join("expect.json")).unwrap();
            let is_refused = expected.contains("\"refused\"");
            let output = folder.path().join(language).join(&name);
            fs::create_dir_all(&output).unwrap();
            let run = convert(&name, &output, &["--verify", "--to", language]);
            let code = match () {
                () if is_refused => 1,
                () if unproved.contains(&&*name) => 2,
                () => 0,
            };
            assert_eq!(run.code, code, "{language} {name}: {}{}", run.stdout, run.stderr);
        }
    }
}

#[test]
fn faults_in_the_code_are_found() {
    let mut ring = Converted::new("ring");
    if ring.prove().is_none() {
        return;
    }
    assert!(ring.prove().unwrap().is_ok());
    let buffer_b = ring.texts[1].clone();
    ring.texts[1] = buffer_b.replace("+ 1.0", "+ 1.0001");
    assert_ne!(ring.texts[1], buffer_b);
    let why = ring.difference();
    assert!(
        why.starts_with("Buffer B differs from frame 0 on, first at pixel (0, 0) of 96×54, which is ["),
        "{why}"
    );
}

#[test]
fn faults_are_found_without_a_driver() {
    let mut ring = Converted::new("ring");
    ring.prove_on_evaluator().unwrap();
    let mut swapped = Converted::new("ring");
    swapped.edit(|passes| passes[2].inputs[0] = passes[1].inputs[0]);
    let why = swapped.prove_on_evaluator().unwrap_err().to_string();
    assert!(why.starts_with("Buffer C differs from frame "), "{why}");
    ring.texts[1] = ring.texts[1].replace("+ 1.0", "+ 1.0001");
    let why = ring.prove_on_evaluator().unwrap_err().to_string();
    assert!(why.starts_with("Buffer B differs from frame 0 on, "), "{why}");
}

#[test]
fn fetches_beyond_a_texture_are_zeros() {
    let mut fetched = Converted::new("mipmap-functions");
    let Some(proof) = fetched.prove() else {
        return;
    };
    assert!(proof.is_ok(), "{proof:?}");
    let text = fetched
        .texts
        .iter_mut()
        .find(|text| text.contains("texel_fetch(iChannel"));
    let text = text.expect("a pass fetches texels");
    // WGSL's own function returns the texel at the edge here.
    *text = text.replace("texel_fetch(iChannel", "textureLoad(iChannel");
    fetched.difference();
}

#[test]
fn faults_in_the_graph_are_found() {
    if !require_driver() {
        return;
    }
    // Another input: what Buffer B reads is read by Buffer C.
    let mut swapped = Converted::new("ring");
    swapped.edit(|passes| passes[2].inputs[0] = passes[1].inputs[0]);
    let why = swapped.difference();
    assert!(why.contains("Buffer C differs from frame "), "{why}");
    // Another order: Buffer A is read before it is rendered.
    let mut late = Converted::new("a-b-a-chain");
    late.edit(|passes| {
        let first = passes
            .iter()
            .position(|pass| pass.inputs.contains(&Some(Read::Buffer(0))));
        passes[first.unwrap()].inputs[0] = Some(Read::Buffer(1));
    });
    late.difference();
    let mut sharp = Converted::new("sweep-linear-clamp");
    for sampling in sharp.graph.sampling.iter_mut().flatten() {
        sampling.filter = Filter::Nearest;
    }
    sharp.difference();
    let mut repeated = Converted::new("sweep-linear-clamp");
    for sampling in repeated.graph.sampling.iter_mut().flatten() {
        sampling.wrap = Wrap::Repeat;
    }
    repeated.difference();
    let mut flat = Converted::new("mipmap-pyramid");
    flat.graph.graph = Graph::new(flat.graph.graph.passes().to_vec(), Default::default());
    flat.difference();
    assert_eq!(flat.graph.graph.passes().last().unwrap().target, Target::Image);
}

#[test]
fn what_cannot_take_passes_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = project("ring");
    let path = path.to_str().unwrap();
    for (arguments, message) in [
        (
            &["convert", path][..],
            "the passes of a project cannot be written to standard output",
        ),
        (
            &["convert", path, "-o", "ring.wgsl"],
            "the passes of a project cannot be written to ring.wgsl",
        ),
        (
            &["convert", path, "-o", "ring", "--style", "bevy"],
            "the style `bevy` does not support; use `--style plain` or `--style wgpu-shadertoy`",
        ),
        (
            &["convert", path, "-o", "ring", "--to", "spv", "--style", "bevy"],
            "--style applies to WGSL only",
        ),
    ] {
        let run = toyproof(folder.path(), arguments);
        assert_eq!(run.code, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
    }
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        0,
        "nothing was written"
    );
}

#[test]
fn the_graph_says_what_each_pass_reads() {
    let folder = tempfile::tempdir().unwrap();
    let run = convert("mipmap-functions", folder.path(), &["--to", "spv"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let graph: Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("graph.json")).unwrap()).unwrap();
    assert_eq!(graph["version"], 1);
    assert_eq!(graph["uniforms"]["offsets"]["iChannelResolution"], 96);
    let passes = graph["passes"].as_array().unwrap();
    let of = |target: &str| passes.iter().find(|pass| pass["target"] == target).unwrap();
    assert_eq!(of("buffer-a")["mipmaps"], true);
    assert_eq!(of("image")["file"], "image.spv");
    let read = &of("image")["inputs"][1];
    let expected = json!({
        "source": "buffer",
        "buffer": "buffer-a",
        "frame": "this",
        "filter": "mipmap",
        "wrap": "repeat",
    });
    assert_eq!(*read, expected);
    assert!(
        passes
            .iter()
            .all(|pass| folder.path().join(pass["file"].as_str().unwrap()).is_file())
    );
}

#[test]
fn wgpu_shadertoy_gets_a_script() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = convert("ring", folder.path(), &["--style", "wgpu-shadertoy", "--verify"]);
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
    let script = fs::read_to_string(folder.path().join("shader.py")).unwrap();
    let first = "    BufferRenderPass(\n        \"a\",\n        code=code(\"buffer-a.wgsl\"),";
    assert!(script.contains(first), "{script}");
    let read = "ShadertoyChannelBuffer(\"d\", filter=\"nearest\", wrap=\"clamp\"),";
    assert!(script.contains(read), "{script}");
    let discards = folder.path().join("discards");
    let run = convert("discard-checkerboard", &discards, &["--style", "wgpu-shadertoy"]);
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("has `discard`"), "{}", run.stderr);
    assert!(!discards.exists());
}

/// The last image of a converted project in the example host.
fn played(folder: &Path, size: [u32; 2], frames: u32) -> Vec<u8> {
    pollster::block_on(host::render(&folder.join("graph.json"), size, frames)).unwrap()
}

#[test]
fn the_rust_host_renders_what_run_renders() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["reads-later", "mipmap-feedback", "discard-two-frames-back"] {
        let run = convert(name, folder.path(), &[]);
        assert_eq!(run.code, 0, "{name}: {}", run.stderr);
        let png = folder.path().join("expected.png");
        let (path, png) = (project(name), png.to_str().unwrap());
        let arguments = [
            "run",
            path.to_str().unwrap(),
            "--size",
            "64x36",
            "--frame",
            "9",
            "-o",
            png,
            "--device",
            "lavapipe",
        ];
        let run = toyproof(root(), &arguments);
        assert_eq!(run.code, 0, "{name}: {}", run.stderr);
        let expected = image::read(Path::new(png)).unwrap();
        let actual = played(folder.path(), [64, 36], 10);
        let expected = expected
            .pixels()
            .iter()
            .flatten()
            .map(|&component| (component * 255.0) as u8);
        let apart = expected.zip(&actual).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        assert_eq!(apart, 0, "{name}");
    }
}

const ORDER: &str = r#"
[[pass]]
tab = "buffer-c"
inputs = [{ channel = 0, source = "buffer-b", sampler = { filter = "nearest" } }]
[[pass]]
tab = "buffer-a"
[[pass]]
tab = "buffer-b"
inputs = [{ channel = 0, source = "buffer-a", sampler = { filter = "linear" } }]
[[pass]]
tab = "image"
inputs = [
    { channel = 0, source = "buffer-c", sampler = { filter = "nearest" } },
    { channel = 1, source = "buffer-b", sampler = { filter = "nearest" } },
]
"#;

/// A project whose image shows ramps of red and green if its buffers hold what they must: Buffer C runs first and
/// reads the previous frame of Buffer B, which reads this frame of Buffer A.
const RAMPS: [(&str, &str); 5] = [
    (
        "buffer-c.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }",
    ),
    (
        "buffer-a.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, float(iFrame), 0.5); }",
    ),
    (
        "buffer-b.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p / iResolution.xy); }",
    ),
    (
        "image.glsl",
        "void mainImage(out vec4 c, in vec2 p) {
            ivec2 at = ivec2(p);
            vec4 b = texelFetch(iChannel1, at, 0), before = texelFetch(iChannel0, at, 0);
            bool right = b.z == float(iFrame) && b.w == 0.5 && (iFrame == 0 || before.z == float(iFrame - 1));
            c = right ? vec4(b.xy, 0.25, 1.0) : vec4(0.0, 0.0, 1.0, 1.0);
        }",
    ),
    ("project.toml", ORDER),
];

/// Writes the project of the ramps into a folder, and converts it.
fn convert_ramps(folder: &Path, language: &str) -> PathBuf {
    let project = folder.join("ramps");
    fs::create_dir_all(&project).unwrap();
    for (name, text) in RAMPS {
        fs::write(project.join(name), text).unwrap();
    }
    let run = toyproof(folder, &["convert", "ramps", "-o", language, "--to", language]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    folder.join(language)
}

#[test]
fn the_rust_host_follows_the_graph() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let output = convert_ramps(folder.path(), "wgsl");
    let graph = output.join("graph.json");
    let correct = fs::read_to_string(&graph).unwrap();
    let first = |frames| played(&output, [16, 16], frames)[..4].to_vec();
    assert_eq!(first(5), [8, 8, 64, 255]);
    let buffer_b_reads = correct.rfind("\"buffer\": \"buffer-a\"").unwrap();
    let (before, after) = correct.split_at(buffer_b_reads);
    let faults = [
        correct.replacen("\"previous\"", "\"this\"", 1),
        format!("{before}{}", after.replacen("\"this\"", "\"previous\"", 1)),
        correct.replacen("\"buffer\": \"buffer-c\"", "\"buffer\": \"buffer-a\"", 1),
        correct.replacen("\"target\": \"buffer-a\"", "\"target\": \"buffer-d\"", 1),
    ];
    for (number, faulty) in faults.into_iter().enumerate() {
        assert_ne!(faulty, correct);
        fs::write(&graph, faulty).unwrap();
        assert_eq!(first(5), [0, 0, 255, 255], "fault {number}");
    }
}

#[test]
fn the_web_hosts_play_a_graph() {
    let Some(program) = require_chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut window = Page::with(&program, &super::browser::SOFTWARE_RENDERING);
    window.window([700, 420], false);
    for (page, language) in [("host.html", "wgsl"), ("host-webgl2.html", "glsl")] {
        let output = convert_ramps(folder.path(), language);
        let mut files = serde_json::Map::new();
        for entry in fs::read_dir(&output).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            files.insert(name, fs::read_to_string(&path).unwrap().into());
        }
        let graph = files.remove("graph.json").unwrap();
        // A page that is opened as a file cannot fetch others.
        let fetch = format!(
            "<script>const files = {}; window.fetch = async (name) => new Response(files[name]);</script>",
            Value::from(files).to_string().replace("</", "<\\/")
        );
        let text = fs::read_to_string(root().join("examples/hosts").join(page)).unwrap();
        let slot = "<script type=\"application/json\"></script>";
        assert!(text.contains(slot));
        let pasted = format!(
            "{fetch}<script type=\"application/json\">{}</script>",
            graph.as_str().unwrap()
        );
        let file = folder.path().join(page);
        fs::write(&file, text.replace(slot, &pasted)).unwrap();
        window.open(&file);
        wait_until(|| {
            let errors = window.value("document.querySelector('#errors').textContent");
            assert_eq!(errors, "", "{page}");
            super::browser::shows_the_ramps(&window.screenshot())
        });
    }
}
