//! `compare`: images, folders of images, and shaders to the bit.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::toyproof;

/// A shader whose color is this expression; `p` is the position.
fn shader(color: &str) -> String {
    format!("void mainImage(out vec4 c, in vec2 p) {{\n  c = vec4({color}, 1.0);\n}}\n")
}

/// Writes shaders into a folder, by their names and texts.
fn write(folder: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// Renders the image of a shader with this color, in 16×16 pixels.
fn render(folder: &Path, image: &str, color: &str) {
    write(folder, &[("color.glsl", &shader(color))]);
    let run = toyproof(
        folder,
        &[
            "run",
            "color.glsl",
            "-o",
            image,
            "--size",
            "16x16",
            "--device",
            "cpu",
        ],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
}

fn compare(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let run = toyproof(folder, &[&["compare"], arguments].concat());
    (run.code, run.stdout + &run.stderr)
}

/// The report of a comparison as JSON, which follows the schema.
fn json(folder: &Path, arguments: &[&str]) -> Value {
    let run = toyproof(folder, &[&["compare", "--format", "json"], arguments].concat());
    let json = serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {}", run.stderr));
    let schema = serde_json::from_str(toyproof::report::COMPARISON_SCHEMA).unwrap();
    jsonschema::validate(&schema, &json).unwrap();
    json
}

/// A level is rounding, two levels are not: for `compare` as for a reference image of `check`.
#[test]
fn compare_and_check_have_the_same_tolerance() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    render(folder, "reference.png", "vec3(100.0 / 255.0)");
    for (level, agrees) in [(99, true), (101, true), (102, false), (98, false)] {
        let color = format!("vec3({level}.0 / 255.0)");
        render(folder, "mine.png", &color);
        let (code, text) = compare(folder, &["reference.png", "mine.png"]);
        assert_eq!(code == 0, agrees, "{level}: {text}");
        let check = [
            "check",
            "color.glsl",
            "--reference",
            "reference.png",
            "--device",
            "cpu",
        ];
        assert_eq!(toyproof(folder, &check).code, code, "{level}");
        for (tolerance, is_within) in [("0", level == 100), ("1", agrees), ("2", true)] {
            let flags = ["reference.png", "mine.png", "--tolerance", tolerance];
            assert_eq!(
                compare(folder, &flags).0 == 0,
                is_within,
                "{level} within {tolerance}"
            );
        }
    }
}

#[test]
fn limits_of_pixels_and_parts_of_images() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    render(folder, "a.exr", "vec3(0.5)");
    // The three pixels at the lower right differ.
    render(folder, "b.exr", "vec3(p.x > 13.0 && p.y < 1.0 ? 0.75 : 0.5)");
    let (code, text) = compare(folder, &["a.exr", "b.exr"]);
    assert_eq!(code, 1);
    assert!(
        text.starts_with("3 of 256 pixels differ by more than 0.001;"),
        "{text}"
    );
    assert!(text.contains("\nfirst at (13, 0): (0.500"), "{text}");
    for (most, expected) in [("2", 1), ("3", 0), ("1.1%", 1), ("1.2%", 0)] {
        let (code, text) = compare(folder, &["a.exr", "b.exr", "--max-differing", most]);
        assert_eq!(code, expected, "{most}: {text}");
    }
    for (region, differing) in [("0,0,13,16", 0), ("0,1,16,15", 0), ("14,0,2,2", 2)] {
        let json = json(folder, &["a.exr", "b.exr", "--region", region]);
        let comparison = &json["images"][0]["comparison"];
        assert_eq!(comparison["differing"], differing, "{region}");
        // Pixels have their coordinates in the whole image.
        if differing > 0 {
            assert_eq!(comparison["first"]["x"], 14);
        }
    }
    let (code, text) = compare(folder, &["a.exr", "b.exr", "--region", "10,0,7,1"]);
    assert_eq!(code, 2);
    assert!(text.contains("not within the image of 16×16"), "{text}");
}

#[test]
fn metrics_have_limits_and_maps() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    render(folder, "a.png", "vec3(0.2, 0.4, 0.6)");
    render(folder, "b.png", "vec3(0.2, 0.4, 0.8)");
    let value = |metric: &str| {
        let json = json(folder, &["a.png", "b.png", "--metric", metric]);
        json["images"][0]["value"].as_f64().unwrap()
    };
    // One of three components differs by 0.2.
    let rmse = (0.04_f64 / 3.0).sqrt();
    assert!((value("rmse") - rmse).abs() < 1e-6);
    assert!((value("psnr") + 20.0 * rmse.log10()).abs() < 1e-4);
    let (ssim, flip) = (value("ssim"), value("flip"));
    assert!(
        (0.9..1.0).contains(&ssim) && (0.1..0.5).contains(&flip),
        "{ssim} {flip}"
    );
    for (metric, limit, expected) in [
        ("rmse", "0.2", 0),
        ("rmse", "0.1", 1),
        ("psnr", "18", 0),
        ("psnr", "19", 1),
        ("flip", "0.5", 0),
        ("flip", "0.1", 1),
        ("hdr-flip", "0", 1),
    ] {
        let (code, text) = compare(folder, &["a.png", "b.png", "--metric", metric, "--limit", limit]);
        assert_eq!(code, expected, "{metric} {limit}: {text}");
        assert!(text.contains(&format!("the limit of {limit}")), "{text}");
    }
    let with_image = ["a.png", "b.png", "--metric", "flip", "--diff", "d.png"];
    assert_eq!(
        compare(folder, &with_image).0,
        1,
        "without a limit, pixels decide"
    );
    let map = toyproof::image::read_shown(&folder.join("d.png")).unwrap();
    let color = map.only_color().expect("the same error everywhere");
    assert!(
        map.size() == [16, 16] && color[0] > color[1],
        "a color of magma: {color:?}"
    );
    let (code, text) = compare(folder, &["a.png", "b.png", "--metric", "ssim", "--limit", "2"]);
    assert_eq!(code, 2);
    assert!(text.contains("expected a number from -1 to 1"), "{text}");
}

#[test]
fn folders_are_compared_by_names() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (image, color) in [
        ("a/same.png", "vec3(0.5)"),
        ("b/same.png", "vec3(0.5)"),
        ("a/deep/other.exr", "vec3(0.1)"),
        ("b/deep/other.exr", "vec3(0.2)"),
        ("a/gone.png", "vec3(0.0)"),
        ("b/new.png", "vec3(0.0)"),
    ] {
        render(folder, image, color);
    }
    write(
        folder,
        &[
            ("a/notes.txt", "no image"),
            ("b/bad.png", "not an image"),
            ("a/bad.png", "no"),
        ],
    );
    let (code, text) = compare(folder, &["a", "b", "--diff", "differences"]);
    assert_eq!(code, 2, "{text}");
    assert!(
        text.contains("deep/other.exr: 256 of 256 pixels differ"),
        "{text}"
    );
    assert!(text.contains("gone.png: only in the first folder"), "{text}");
    assert!(text.contains("new.png: only in the second folder"), "{text}");
    assert!(text.contains("bad.png: cannot read"), "{text}");
    let summary = "5 images: 1 is equal, 1 differs, 2 have no counterpart, 1 cannot be compared";
    assert!(text.contains(summary), "{text}");
    assert!(folder.join("differences/deep/other.exr.png").is_file());
    assert!(!folder.join("differences/same.png").exists());
    fs::remove_file(folder.join("a/bad.png")).unwrap();
    assert_eq!(compare(folder, &["a", "b"]).0, 1);
    let json = json(folder, &["a", "b"]);
    let images = json["images"].as_array().unwrap();
    let names: Vec<_> = images
        .iter()
        .map(|image| image["path"].as_str().unwrap())
        .collect();
    assert_eq!(
        names,
        ["bad.png", "deep/other.exr", "gone.png", "new.png", "same.png"]
    );
    assert_eq!(
        compare(folder, &["b", "b"]).0,
        2,
        "an image that cannot be read is no equal image"
    );
    let (code, text) = compare(folder, &["a", "color.glsl"]);
    assert!(
        code == 2 && text.contains("is a folder without a project"),
        "{text}"
    );
}

/// Waves in the style of a program and of a minifier.
const WAVES: &str = "float wave(vec2 p) {
  float distance = length(p);
  return 0.5 + 0.5 * sin(20.0 * distance - iTime);
}
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
  vec2 uv = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
  fragColor = vec4(vec3(wave(uv)), 1.0);
}
";
const MINIFIED: &str = "#define S sin
float f(vec2 v){return .5+.5*S(20.*length(v)-iTime);}void mainImage(out vec4 o,vec2 i){vec2 u=iResolution.xy;
o=vec4(vec3(f((2.*i-u)/u.y)),1);}";

#[test]
fn a_minified_shader_is_equal_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let other = MINIFIED.replace("length(v)", "sqrt(dot(v,v)+1e-5)");
    write(
        folder,
        &[("a.glsl", WAVES), ("b.glsl", MINIFIED), ("c.glsl", &other)],
    );
    let flags = ["--size", "64x36", "--frames", "0..9"];
    let with_flags = |names: &[&'static str]| [names, &flags].concat();
    let (code, text) = compare(folder, &with_flags(&["a.glsl", "b.glsl"]));
    assert_eq!(code, 0, "{text}");
    assert_eq!(text, "frames 0 to 9 are equal to the bit in float32, at 64×36\n");

    let (code, text) = compare(folder, &with_flags(&["a.glsl", "c.glsl"]));
    assert_eq!(code, 1, "{text}");
    assert!(
        text.starts_with("first difference: frame 0, Image, pixel (0, 0)\n  a.glsl: ("),
        "{text}"
    );
    assert!(text.contains("\na.glsl, line 2: `length(p)` is "), "{text}");
    assert!(text.contains("\nc.glsl, line 2: `dot(v,v)` is "), "{text}");

    // Their images agree, which a tolerance asks for.
    let (code, text) = compare(folder, &with_flags(&["a.glsl", "c.glsl", "--tolerance", "1"]));
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("10 images: 10 agree"), "{text}");

    let json = json(folder, &with_flags(&["a.glsl", "c.glsl"]));
    assert_eq!(json["agree"], false);
    assert_eq!(json["shaders"]["first"]["place_in_b"]["line"], 2);
    assert_eq!(json["shaders"]["frames"], serde_json::json!([0, 9]));
}

/// Buffer A counts frames; the difference begins in frame 3, in one pixel.
#[test]
fn projects_are_compared_pass_by_pass() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let image =
        "void mainImage(out vec4 c, in vec2 p) {\n  c = 0.1 * texelFetch(iChannel0, ivec2(p), 0);\n}\n";
    let buffer = "void mainImage(out vec4 c, in vec2 p) {\n  float last = texelFetch(iChannel0, ivec2(p), 0).x;\n  \
                  c = vec4(last + 1.0, 0.0, 0.0, 1.0);\n}\n";
    let changed = buffer.replace(
        "  c = vec4",
        "  if (iFrame == 3 && ivec2(p) == ivec2(5, 6)) last -= 0.5;\n  c = vec4",
    );
    write(
        folder,
        &[
            ("a/image.glsl", image),
            ("a/buffer-a.glsl", buffer),
            ("b/image.glsl", image),
            ("b/buffer-a.glsl", &changed),
        ],
    );
    let flags = |frames: &'static str| ["a", "b", "--size", "16x9", "--frames", frames];
    let (code, text) = compare(folder, &flags("0..2"));
    assert_eq!(code, 0, "{text}");
    assert!(
        text.starts_with("frames 0 to 2 of Buffer A and Image are equal"),
        "{text}"
    );
    let (code, text) = compare(folder, &flags("0..9"));
    assert_eq!(code, 1, "{text}");
    assert!(
        text.starts_with("first difference: frame 3, Buffer A, pixel (5, 6)\n"),
        "{text}"
    );
    assert!(text.contains("b/buffer-a.glsl, line 3: "), "{text}");
    assert!(
        text.contains("\n1 of 144 pixels of this pass differs in this frame\n"),
        "{text}"
    );
    // Without a frame, those of a check.
    let json = json(folder, &["a", "b", "--size", "16x9"]);
    assert_eq!(json["shaders"]["frames"], serde_json::json!([0, 7]));
    let (code, text) = compare(folder, &["a", "a/image.glsl", "--size", "16x9"]);
    assert_eq!(code, 1);
    assert!(text.contains("not compared, only in a: Buffer A"), "{text}");
}

#[test]
fn what_cannot_be_compared_has_a_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    render(folder, "a.png", "vec3(0.5)");
    render(folder, "small.png", "vec3(0.5)");
    let broken = WAVES.replace("20.0", "20.0 +");
    write(folder, &[("a.glsl", WAVES), ("broken.glsl", &broken)]);
    for (arguments, expected) in [
        (&["a.png", "missing.png"][..], "no such file"),
        (&["a.glsl", "a.png"], "toyproof check a.glsl --reference a.png"),
        (&["a.glsl", "broken.glsl"], "broken.glsl:3:"),
        (&["a.png", "a.png", "--frames", "0..3"], "images have no frames"),
        (&["a.png", "."], "can only be compared with another folder"),
        (
            &["a.glsl", "a.glsl", "--diff", "d.png"],
            "compare their images with --tolerance",
        ),
        (&["a.png", "a.png", "--limit", "1"], "--metric"),
        (&["a.png", "a.png", "--region", "1,2"], "four integers X,Y,W,H"),
        (
            &["a.png", "a.png", "--max-differing", "x"],
            "a number of pixels, or a share",
        ),
    ] {
        let (code, text) = compare(folder, arguments);
        assert_eq!(code, 2, "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
    }
}
