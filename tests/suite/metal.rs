//! Metal from the tree: clang++ compiles the written files with `tests/metal/metal_stdlib` in place of Apple's
//! library, and the images must have the evaluator's bits.
//!
//! Functions whose last bits Metal leaves open are computed by the evaluator's definitions, as in proofs; all
//! other operations are those that IEEE 754 defines, and clang++ neither contracts nor reorders them. So no
//! tolerance is needed. `TOYPROOF_PROGRAMS` and `TOYPROOF_SEED` are the number and the seed of random programs.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};
use regex::Regex;
use toyproof::diagnostic::{Deadline, File, Files, short};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::tree::Input;
use toyproof::glsl::{Checked, Options, check};
use toyproof::image::{Frame, Image, Shape, Texture, noise};
use toyproof::translate::c_family::{CHost, Title, write};
use toyproof::translate::lower_strict;
use walkdir::WalkDir;

use crate::engines;
use crate::program::toyproof;
use crate::requirements::{require_driver, require_folder, require_program};
use crate::support::generate::{self, Arithmetic, Effects};
use crate::support::setting;

/// Calls every function whose definition the header needs.
const FUNCTIONS: &str = "
void mainImage(out vec4 c, in vec2 p) {
    float x = p.x;
    c = vec4(sin(x) + cos(x) + tan(x) + asin(x) + acos(x) + atan(x), sinh(x) + cosh(x) + tanh(x), asinh(x) + acosh(x)
        + atanh(x), exp(x) + exp2(x) + log(x) + log2(x) + pow(x, p.y) + atan(p.y, x));
}";

/// The functions of GLSL that the evaluator's definitions call.
const GLSL: &str = "
inline uint floatBitsToUint(float x) { uint bits; __builtin_memcpy(&bits, &x, 4); return bits; }
inline float uintBitsToFloat(uint bits) { float x; __builtin_memcpy(&x, &bits, 4); return x; }
inline float mix(float x, float y, bool a) { return a ? y : x; }
inline uint mix(uint x, uint y, bool a) { return a ? y : x; }
inline float abs(float x) { return __builtin_fabsf(x); }
inline float sqrt(float x) { return __builtin_sqrtf(x); }
inline float floor(float x) { return __builtin_floorf(x); }
";

/// A written shader.
struct Written {
    name: String,
    checked: Checked,
    text: String,
}

/// Writes a valid shader; `None` if it has a construct that the writer leaves to naga.
fn written(name: &str, shader: &str) -> Option<Written> {
    let failed = |why: String| assert!(why.starts_with("not written"), "{name}: {why}");
    try_written(name, shader).map_err(failed).ok()
}

/// Writes a shader, or returns why it is not written.
fn try_written(name: &str, shader: &str) -> Result<Written, String> {
    let mut files = Files::default();
    let file = files.add(File::new(name, shader));
    let checked = check(&files, file, &Options::default()).map_err(|errors| {
        errors
            .iter()
            .map(|error| short(error, &files))
            .collect::<Vec<_>>()
            .join("; ")
    })?;
    let text = write(
        &checked,
        &files,
        CHost::Metal,
        Title::of_shader(name),
        &Deadline::default(),
    )
    .map_err(|failure| format!("not written: {failure}"))?;
    let name = name.to_owned();
    Ok(Written { name, checked, text })
}

/// The frame that is compared.
fn frame() -> Frame {
    let plane: Texture = noise().cropped([9, 7]).into();
    let volume = Texture::volume(noise().cropped([5, 4 * 3]), 3);
    Frame {
        size: [14, 10],
        time: 1.3,
        frame: 78,
        mouse: [5.0, 7.0, 5.0, 7.0],
        date: [2026.0, 4.0, 17.0, 43_200.0],
        channels: [Some(plane), None, None, Some(volume)],
        ..Frame::default()
    }
}

/// What the header needs before it: the swizzles, and the evaluator's definitions of functions.
fn definitions() -> String {
    let mut text = String::new();
    for size in 2..=4_usize {
        let _ = write!(text, "#define SWIZZLES_{size}");
        for count in 2..=4_u32 {
            for number in 0..size.pow(count) {
                let places = (0..count).map(|at| number / size.pow(at) % size);
                let places: Vec<usize> = places.collect();
                let [letters, colors] = ["xyzw", "rgba"].map(|names| {
                    places
                        .iter()
                        .map(|&place| &names[place..=place])
                        .collect::<String>()
                });
                let places: Vec<String> = places.iter().map(usize::to_string).collect();
                let _ = write!(text, " swizzle<T, {}> {letters}, {colors};", places.join(", "));
            }
        }
        text.push('\n');
    }
    let functions = written("functions", FUNCTIONS).expect("it is simple");
    let lowered = lower_strict(&functions.checked);
    let (_, lowered) = lowered.text().split_once("\n\n").expect("there is a head");
    let (lowered, _) = lowered.split_once("void mainImage").expect("there is an image");
    let lowered = Regex::new(r"toyproof_([a-z]+2?)\(")
        .unwrap()
        .replace_all(lowered, "math_$1(");
    let lowered = lowered
        .replace("\nfloat ", "\ninline float ")
        .replace("math_atan(float toyproof_a, ", "math_atan2(float toyproof_a, ");
    let _ = write!(
        text,
        "typedef unsigned int uint;\nnamespace evaluator {{\n{GLSL}{lowered}}}\n"
    );
    text
}

/// Asserts that variables outside functions and structures are constants.
fn assert_no_globals(shader: &Written) {
    let is_global = |line: &&str| {
        let is_known = ["constant ", "using ", "};"]
            .iter()
            .any(|start| line.starts_with(start));
        !is_known
            && !line.starts_with([' ', '/'])
            && line
                .split("//")
                .next()
                .is_some_and(|code| code.trim().ends_with(';'))
    };
    let globals: Vec<&str> = shader.text.lines().filter(is_global).collect();
    assert!(globals.is_empty(), "{}: {globals:?}", shader.name);
}

/// The text as the header takes it: swizzles that are read get their values.
fn with_values(text: &str) -> String {
    let swizzle =
        Regex::new(r"\.(?:[xyzw]{2,4}|[rgba]{2,4})\b(?<write>\s*(?:[-+*/%&|^]|<<|>>)?=[^=])?").unwrap();
    let value = |found: &regex::Captures<'_>| {
        if found.name("write").is_some() {
            found[0].to_owned()
        } else {
            format!("{}.value()", &found[0])
        }
    };
    swizzle.replace_all(text, value).into_owned()
}

/// The program that renders the shaders: each is in a namespace.
fn program(shaders: &[Written]) -> String {
    let mut text = "#include \"definitions.h\"\n#include <metal_stdlib>\n#include \"runner.h\"\n".to_owned();
    let resource = Regex::new(r"(?m)^    (\S+) \w+ \[\[(\w+)\((\d+)\)\]\],$").unwrap();
    for (number, shader) in shaders.iter().enumerate() {
        assert_no_globals(shader);
        let _ = writeln!(text, "namespace shader_{number} {{\n#line 1 \"{}\"", shader.name);
        let _ = writeln!(text, "{}}}", with_values(&shader.text));
        let _ = writeln!(text, "namespace shader_{number} {{");
        let mut arguments = Vec::new();
        if shader.text.contains("constant Inputs& inputs") {
            let _ = writeln!(text, "static_assert(sizeof(Inputs) == 208, \"\");");
            for input in Input::ALL {
                let (name, offset) = (input.name(), input.offset());
                let _ = writeln!(text, "static_assert(offsetof(Inputs, {name}) == {offset}, \"\");");
            }
            arguments.push("*(const Inputs *)block".to_owned());
        }
        for found in resource.captures_iter(&shader.text) {
            let slot: usize = found[3].parse().unwrap();
            match &found[2] {
                "texture" => arguments.push(format!("bound<{}>(channels + {})", &found[1], slot / 2)),
                kind => {
                    assert_eq!((kind, slot % 2), ("sampler", 0), "{}", shader.text);
                    arguments.push("metal::sampler()".to_owned());
                }
            }
        }
        arguments.push("position".to_owned());
        let _ = writeln!(
            text,
            "float4 run(const void *block, const metal::Image *channels, float4 position) {{\n    \
             (void)block, (void)channels;\n    return main_({});\n}}\n}}",
            arguments.join(", ")
        );
    }
    let runs: Vec<String> = (0..shaders.len())
        .map(|number| format!("shader_{number}::run"))
        .collect();
    let _ = write!(
        text,
        "static const Fragment fragments[] = {{{}}};\n\
         int main(int, char **arguments) {{ return render_all(fragments, arguments[1], arguments[2]); }}\n",
        runs.join(", ")
    );
    text
}

/// The bytes of a frame: its size, the uniform block and the textures.
fn frame_bytes(number: usize, frame: &Frame) -> Vec<u8> {
    let mut bytes = Vec::new();
    let integers = |bytes: &mut Vec<u8>, numbers: &[u32]| {
        bytes.extend(numbers.iter().flat_map(|number| number.to_ne_bytes()));
    };
    integers(&mut bytes, &[number as u32, frame.size[0], frame.size[1]]);
    bytes.extend(frame.block());
    for channel in &frame.channels {
        // An unbound channel is a texel of opaque black.
        let (sides, pixels) = match channel {
            Some(texture) => {
                let [width, height] = texture.size();
                let depth = if texture.shape() == Shape::Volume {
                    texture.layers()
                } else {
                    1
                };
                ([width, height, depth], texture.stack().pixels().to_vec())
            }
            None => ([1; 3], vec![[0.0, 0.0, 0.0, 1.0]]),
        };
        integers(&mut bytes, &sides);
        bytes.extend(
            pixels
                .iter()
                .flatten()
                .flat_map(|component| component.to_ne_bytes()),
        );
    }
    bytes
}

/// Compiles and runs the shaders; returns an image for each.
fn rendered(shaders: &[Written], frame: &Frame) -> Vec<Image> {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("definitions.h"), definitions()).unwrap();
    fs::write(path("program.cpp"), program(shaders)).unwrap();
    if let Some(kept) = env::var_os("TOYPROOF_WRITTEN") {
        fs::copy(path("program.cpp"), Path::new(&kept).join("program.cpp")).unwrap();
        fs::copy(path("definitions.h"), Path::new(&kept).join("definitions.h")).unwrap();
    }
    let frames = (0..shaders.len()).flat_map(|number| frame_bytes(number, frame));
    fs::write(path("frames"), frames.collect::<Vec<u8>>()).unwrap();
    let header = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/metal");
    let compiled = Command::new("clang++")
        .args([
            "-std=c++14",
            "-O1",
            "-ffp-contract=off",
            "-fno-math-errno",
            "-fno-exceptions",
        ])
        // A number without suffix is a `float`.
        .args(["-Xclang", "-cl-single-precision-constant"])
        // Most warnings are about what the author wrote. Metal's compiler is clang, too, which evaluates operands
        // from left to right.
        .args(["-Wno-everything", "-Werror=return-type", "-Werror=uninitialized"])
        .arg("-I")
        .arg(folder.path())
        .arg("-isystem")
        .arg(header)
        .arg(path("program.cpp"))
        .arg("-o")
        .arg(path("program"))
        .output()
        .unwrap();
    let messages = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{messages}");
    let run = Command::new(path("program"))
        .arg(path("frames"))
        .arg(path("images"))
        .status()
        .unwrap();
    assert!(run.success(), "{run}");
    let bytes = fs::read(path("images")).unwrap();
    let floats: Vec<f32> = bytes
        .chunks_exact(4)
        .map(|four| f32::from_ne_bytes(four.try_into().unwrap()))
        .collect();
    let [width, height] = frame.size;
    let images = floats.chunks_exact(4 * (width * height) as usize).map(|image| {
        let pixels = image.chunks_exact(4).map(|pixel| pixel.try_into().unwrap());
        Image::new(width, height, pixels.collect())
    });
    images.collect()
}

/// Compares the images of shaders with the evaluator's; returns the differences.
fn differences(shaders: &[Written], frame: &Frame) -> Vec<String> {
    let images = rendered(shaders, frame);
    assert_eq!(images.len(), shaders.len());
    let mut found = Vec::new();
    for (shader, image) in shaders.iter().zip(&images) {
        let program =
            Program::new(&shader.checked).unwrap_or_else(|refusal| panic!("{}: {refusal}", shader.name));
        let evaluated = program
            .render::<f32>(frame, &Settings::default())
            .unwrap()
            .framebuffer;
        let expected = evaluated.image();
        let mut differing = Vec::new();
        for y in 0..frame.size[1] {
            for x in 0..frame.size[0] {
                let (expected, actual) = (expected.get(x, y), image.get(x, y));
                let equal = |(a, b): (&f32, &f32)| a == b || a.is_nan() && b.is_nan();
                if !evaluated.is_undefined(x, y) && !expected.iter().zip(&actual).all(equal) {
                    differing.push(format!("({x}, {y}): {expected:?} → {actual:?}"));
                }
            }
        }
        if let Some(first) = differing.first() {
            found.push(format!(
                "{}: {} pixels differ, {first}",
                shader.name,
                differing.len()
            ));
        }
    }
    found
}

#[test]
fn the_course_has_the_evaluators_bits() {
    if !require_program("clang++") {
        return;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl");
    let mut shaders = vec![written("inputs", engines::INPUTS).expect("it is written")];
    for entry in WalkDir::new(&folder).sort_by_file_name() {
        let path = entry.unwrap().into_path();
        let is_shader = path.extension().is_some_and(|extension| extension == "glsl");
        let is_tab = path
            .parent()
            .is_some_and(|parent| parent.ends_with("16-progressive"));
        if is_shader && !is_tab {
            let name = path.strip_prefix(&folder).unwrap().to_string_lossy().into_owned();
            let text = fs::read_to_string(&path).unwrap();
            shaders.push(written(&name, &text).unwrap_or_else(|| panic!("{name} is not written")));
        }
    }
    assert!(shaders.len() > 30, "{} shaders", shaders.len());
    let differing = differences(&shaders, &frame());
    assert!(differing.is_empty(), "{}", differing.join("\n"));
}

#[test]
fn faults_in_the_text_are_found() {
    if !require_program("clang++") {
        return;
    }
    let faults = [
        ("position.xy);", "position.yx);"),
        ("inputs.iTime,", "inputs.iTimeDelta,"),
        ("color.xyz, 1.0", "color.zyx, 1.0"),
        ("dfdy(", "dfdx("),
        ("fract(", "floor("),
    ];
    let shaders = faults.map(|(from, to)| {
        let mut shader = written(to, engines::INPUTS).expect("it is written");
        assert!(shader.text.contains(from), "{}", shader.text);
        shader.text = shader.text.replacen(from, to, 1);
        shader
    });
    let found = differences(&shaders, &frame());
    assert_eq!(found.len(), faults.len(), "{found:?}");
}

#[test]
fn random_programs_have_the_evaluators_bits() {
    if !require_program("clang++") {
        return;
    }
    let count: u32 = setting("TOYPROOF_PROGRAMS", 24);
    let seed: u64 = setting("TOYPROOF_SEED", 0);
    let mut seeds = [0; 32];
    seeds[..8].copy_from_slice(&seed.to_le_bytes());
    let mut random = TestRng::from_seed(RngAlgorithm::ChaCha, &seeds);
    let member = Regex::new(r"\b(?:xy|rgb)(?:\[\d+\])?;").unwrap();
    let programs = (0..3 * count).filter_map(|number| {
        let mut bytes = vec![0; 400 + (random.next_u32() % 500) as usize];
        random.fill_bytes(&mut bytes);
        let effects = if number % 2 == 0 {
            Effects::Ordered
        } else {
            Effects::Anywhere
        };
        let program = generate::program(&bytes, effects, Arithmetic::Exact);
        // `with_values` takes members with these names for swizzles.
        let has_swizzle = member.is_match(&program);
        let name = format!("program {number} of seed {seed}");
        (!has_swizzle).then(|| written(&name, &program)).flatten()
    });
    let shaders: Vec<Written> = programs.collect();
    let written = shaders.len();
    assert!(
        written > count as usize / 2,
        "{written} of {} are written",
        3 * count
    );
    let differing = differences(&shaders, &frame());
    assert!(differing.is_empty(), "{}", differing.join("\n"));
}

/// Compares each shader of a folder, with the textures of [`frame`].
#[test]
#[ignore = "takes minutes, and a folder of shaders that TOYPROOF_SHADERS names"]
fn shaders_of_a_folder_have_the_evaluators_bits() {
    let Some(folder) = require_folder("TOYPROOF_SHADERS") else {
        return;
    };
    let mut shaders = Vec::new();
    for entry in WalkDir::new(&folder).sort_by_file_name() {
        let path = entry.unwrap().into_path();
        if path.extension().is_some_and(|extension| extension == "glsl") {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let text = fs::read_to_string(&path).unwrap();
            match try_written(&name, &text) {
                Ok(shader) => shaders.push(shader),
                Err(why) => eprintln!("{name}: {why}"),
            }
        }
    }
    let mut differing = Vec::new();
    for shader in shaders.chunks(8) {
        differing.extend(differences(shader, &frame()));
    }
    eprintln!("{} shaders, {} differ", shaders.len(), differing.len());
    assert!(differing.is_empty(), "{}", differing.join("\n"));
}

/// Without a proof the file is ours; with one it is naga's, and the message says why.
#[test]
fn a_proof_needs_the_text_of_naga() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.metal");
    let shader = "// Stripes\nvoid mainImage(out vec4 c, in vec2 p) {\n    c = vec4(fract(p.x / 9.0)); // repeated\n}\n";
    fs::write(folder.path().join("a.glsl"), shader).unwrap();
    let convert = |options: &[&str]| {
        let run = toyproof(
            folder.path(),
            &[&["convert", "a.glsl", "-o", "a.metal"], options].concat(),
        );
        assert_eq!(run.code, 0, "{}", run.stderr);
        (run.stdout, fs::read_to_string(&file).unwrap())
    };
    let (_, text) = convert(&[]);
    assert!(
        text.contains("// Stripes\n") && text.contains("c = float4(fract(p.x / 9.0)); // repeated\n"),
        "{text}"
    );
    let (_, strict) = convert(&["--float", "strict"]);
    assert!(!strict.contains("struct Shader"), "{strict}");
    if !require_driver() {
        return;
    }
    let (message, text) = convert(&["--verify"]);
    let why = "up to naga's metal writer; written by naga, since only Apple's compiler reads Metal, so the readable text cannot be proved";
    assert!(message.contains(why), "{message}");
    assert!(
        text.contains("// Proved: the module that this text was written from.")
            && !text.contains("// Stripes"),
        "{text}"
    );
}
