//! The media of projects: files, a folder of copies, computed stand-ins, and sounds.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use toyproof::image::{self, Image};

use crate::program::{Run, toyproof};

/// A project whose image reads an input of the site in each channel, which has the given code.
fn json(inputs: &[(&str, &str)], code: &str) -> String {
    let inputs = (0..).zip(inputs).map(|(channel, (kind, id))| {
        json!({"channel": channel, "type": kind, "id": id, "filepath": "",
            "sampler": {"filter": "linear", "wrap": "repeat", "vflip": "true"}})
    });
    let inputs: Vec<Value> = inputs.collect();
    let image = json!({"inputs": inputs, "outputs": [], "code": code, "name": "Image", "description": "",
        "type": "image"});
    json!({"ver": "0.1", "info": {}, "renderpass": [image]}).to_string()
}

fn run(folder: &Path, arguments: &[&str]) -> Run {
    let run = toyproof(folder, &[&["run"][..], arguments].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    run
}

fn save(path: &Path, image: &Image) {
    fs::write(path, image::encode(image, path).unwrap()).unwrap();
}

/// The texels of an image as 8-bit levels: red at the bottom left, then to the right and upwards.
fn levels(width: u32, height: u32) -> Image {
    let texel = |at: u32| [at as f32 / 255.0, 0.2, 0.4, 1.0];
    Image::new(width, height, (0..width * height).map(texel).collect())
}

#[test]
fn a_project_reads_the_media_of_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let project = folder.join("p");
    fs::create_dir(&project).unwrap();
    save(&project.join("flat.png"), &levels(2, 2));
    // The faces of a strip: 0 to 5.
    let face = |at: u32| [(at / 4 % 6 * 40) as f32 / 255.0, 0.0, 0.0, 1.0];
    let strip = (0..24 * 4).map(|at| face(at % 24)).collect();
    save(&project.join("sky.png"), &Image::new(24, 4, strip));
    // 2×2×2 texels of one component: 10, 20 and so on.
    let mut volume = b"BIN\0".to_vec();
    volume.extend([2_u32, 2, 2].map(u32::to_le_bytes).concat());
    volume.extend([1, 0, 0, 0]);
    volume.extend((1..=8).map(|at| 10 * at));
    fs::write(project.join("v.bin"), volume).unwrap();
    let toml = r#"
        [[pass]]
        tab = "image"
        inputs = [
            { channel = 0, source = "flat.png", sampler = { filter = "nearest" } },
            { channel = 1, source = "sky.png", type = "cubemap", sampler = { filter = "nearest" } },
            { channel = 2, source = "v.bin", sampler = { filter = "nearest" } },
        ]"#;
    fs::write(project.join("project.toml"), toml).unwrap();
    let code = "void mainImage(out vec4 c, in vec2 p) {
        vec3 axis = vec3[6](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1))[int(p.x) % 6];
        c = vec4(texelFetch(iChannel0, ivec2(p) % 2, 0).r, texture(iChannel1, axis).r,
                 texelFetch(iChannel2, ivec3(p, p.y) % 2, 0).r, 1);
        c.rgb += vec3(iChannelResolution[0].xy == vec2(2), iChannelResolution[1].x, iChannelResolution[2].z);
    }";
    fs::write(project.join("image.glsl"), code).unwrap();
    let run = run(folder, &["p", "-o", "p.exr", "--size", "6x2", "--device", "cpu"]);
    assert!(
        !run.stderr.contains("replaced") && !run.stderr.contains("black"),
        "{}",
        run.stderr
    );
    let rendered = image::read(&folder.join("p.exr")).unwrap();
    let level = |value: f32| (value * 255.0).round() as i32;
    for y in 0..2 {
        for x in 0..6 {
            let [r, g, b, _] = rendered.get(x, y);
            let flat = x % 2 + 2 * (y % 2);
            assert_eq!(level(r - 1.0), flat as i32);
            // The resolution of a cube map is 0, that of this volume 2 deep.
            assert_eq!(level(g), 40 * x as i32, "face {x}");
            assert_eq!(
                level(b - 2.0),
                10 * (1 + x % 2 + 2 * (y % 2) + 4 * (y % 2)) as i32
            );
        }
    }
}

#[test]
fn media_that_are_sampled_and_replaced_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let code = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p / iResolution.xy)
        + texture(iChannel1, vec3(p - 8.0, 3.0)); }";
    // London, Uffizi Gallery, and Lichen, which the image does not read.
    let inputs = [
        ("texture", "4dfGRn"),
        ("cubemap", "XsfGzn"),
        ("texture", "4sfGRn"),
    ];
    fs::write(folder.join("a.json"), json(&inputs, code)).unwrap();
    let small = ["a.json", "-o", "a.png", "--size", "16x9", "--device", "cpu"];
    let said = run(folder, &small).stderr;
    for named in [
        "“London” of ShaderToy is replaced",
        "“Uffizi Gallery” of ShaderToy is replaced",
    ] {
        assert!(said.contains(named), "{said}");
    }
    assert!(!said.contains("Lichen") && !said.contains("black"), "{said}");
    let check = ["check", "a.json", "--size", "16x9", "--format", "json"];
    let check = toyproof(folder, &check);
    let report: Value = serde_json::from_str(&check.stdout).unwrap();
    let shader = &report["shaders"][0];
    assert_eq!(shader["verdict"], "ok", "{shader}");
    let codes = shader["diagnostics"].as_array().unwrap().iter();
    let codes: Vec<_> = codes.filter(|one| one["code"] == "W0613").collect();
    assert_eq!(codes.len(), 2, "{shader}");
    assert!(codes.iter().all(|one| one["severity"] == "note"), "{shader}");
    // The user's own copies.
    let media = folder.join("media");
    fs::create_dir(&media).unwrap();
    save(&media.join("london.png"), &levels(1, 1));
    let given = run(folder, &[&small[..], &["--media", "media"]].concat()).stderr;
    assert!(!given.contains("London") && given.contains("Uffizi"), "{given}");
}

#[test]
fn a_sound_is_written_as_the_site_computes_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let project = folder.join("p");
    fs::create_dir(&project).unwrap();
    fs::write(
        project.join("image.glsl"),
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }",
    )
    .unwrap();
    let missing = toyproof(folder, &["run", "p", "-o", "a.wav"]);
    assert_eq!(missing.code, 2);
    assert!(missing.stderr.contains("there is no Sound"), "{}", missing.stderr);
    for (name, code) in [
        (
            "new",
            "vec2 mainSound(int samp, float time) { return vec2(float(samp % 100) / 100.0, time * 44100.0 / 300000.0); }",
        ),
        (
            "old",
            "vec2 mainSound(float time) { return vec2(fract(time * 441.0), time * 0.147); }",
        ),
    ] {
        fs::write(project.join("sound.glsl"), code).unwrap();
        let file = format!("{name}.wav");
        // More than a block of 262,144 samples.
        run(folder, &["p", "-o", &file, "--duration", "6.5"]);
        let mut reader = hound::WavReader::open(folder.join(&file)).unwrap();
        assert_eq!(reader.spec().sample_rate, 44_100);
        let samples: Vec<i16> = reader.samples().map(Result::unwrap).collect();
        assert_eq!(samples.len(), 2 * 286_650);
        for at in [0, 1, 150, 262_143, 262_144, 286_649] {
            let expected = [(at % 100) as f32 / 100.0, at as f32 / 300_000.0];
            for (channel, expected) in expected.into_iter().enumerate() {
                let sample = f32::from(samples[2 * at + channel]) / 32_768.0;
                // The older form computes its phase from a float32 of seconds.
                let tolerance = if name == "old" && channel == 0 { 2e-2 } else { 1e-4 };
                let difference = (sample - expected).abs();
                assert!(
                    difference.min(1.0 - difference) < tolerance,
                    "{name} {at}: {sample}, {expected}"
                );
            }
        }
    }
    // Late phases of a float32 are audible.
    let text = "vec2 mainSound(int samp, float time) { return vec2(sin(6.2831 * 4000.0 * time)); }";
    fs::write(project.join("sound.glsl"), text).unwrap();
    let warned = run(folder, &["p", "-o", "late.wav", "--duration", "60"]).stderr;
    assert!(
        warned.contains("differs from double precision") && warned.contains("`samp`"),
        "{warned}"
    );
    let scene = toyproof(folder, &["render", "02-sphere", "-o", "a.wav"]);
    assert!(scene.stderr.contains("a scene has no sound"), "{}", scene.stderr);
}
