//! What is converted is accepted by the compilers of its language, and proved: the course, constants that
//! compilers refuse or fold in their own way, arrays, and generated programs.
//!
//! `TOYPROOF_PROGRAMS` sets the number of generated programs (12), `TOYPROOF_SEED` their seed (0).
//! `TOYPROOF_WRITTEN` names a folder that keeps them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use toyproof::diagnostic::{Deadline, File, Files};
use toyproof::glsl::{Checked, Options, check};
use toyproof::image::pcg;
use toyproof::translate::backend::{Target, emit};
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::wgsl::{Style, wgsl};
use toyproof::translate::{Lowered, lower, lower_strict};

use crate::program::{Run, toyproof};
use crate::requirements::{require_driver, require_program};
use crate::support::generate::{self, Arithmetic, Effects};
use crate::support::setting;

/// The values of `--to`, and the extensions of their files.
const TARGETS: [(&str, &str); 5] = [
    ("wgsl", "wgsl"),
    ("spv", "spv"),
    ("metal", "metal"),
    ("hlsl", "hlsl"),
    ("glsl", "frag"),
];

fn checked(files: &mut Files, shader: &str) -> Checked {
    let file = files.add(File::new("shader", shader));
    check(files, file, &Options::default()).unwrap_or_else(|errors| panic!("{errors}\n{shader}"))
}

/// Asserts that a compiler accepts a file, if the compiler is installed.
fn accepts(program: &str, arguments: &[&str], file: &Path) {
    if !require_program(program) {
        return;
    }
    let run = Command::new(program).args(arguments).arg(file).output().unwrap();
    let text = fs::read(file).unwrap_or_default();
    assert!(
        run.status.success(),
        "{program} refuses {}: {}{}\n{}",
        file.display(),
        String::from_utf8_lossy(&run.stdout),
        String::from_utf8_lossy(&run.stderr),
        String::from_utf8_lossy(&text)
    );
}

/// Asserts that the compilers of a language accept a file, as far as they are installed.
fn is_accepted(file: &Path) {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("wgsl") => {
            accepts("tint", &["--format", "wgsl"], file);
            accepts("naga", &[], file);
        }
        Some("spv") => accepts("spirv-val", &["--target-env", "vulkan1.1"], file),
        Some("frag") => accepts("glslangValidator", &[], file),
        Some("hlsl") => {
            let out = file.with_extension("hlsl.spv");
            let options = [
                "-D",
                "-V",
                "-e",
                "main",
                "-S",
                "frag",
                "-o",
                out.to_str().unwrap(),
            ];
            accepts("glslangValidator", &options, file);
        }
        // Only Apple's compiler reads Metal.
        Some("metal") => {}
        other => panic!("{other:?}"),
    }
}

/// Converts and proves files of a folder in every language, in one mode; each must be accepted.
fn all_are_proved(folder: &Path, shaders: &Path, float: &str) {
    for (to, extension) in TARGETS {
        let out = folder.join(format!("{float}-{to}"));
        let run = verify(folder, shaders, to, float, &out);
        assert_eq!(run.code, 0, "{to}, {float}: {}{}", run.stdout, run.stderr);
        let names = names(shaders);
        assert!(!names.is_empty());
        for name in names {
            is_accepted(&out.join(name).with_extension(extension));
        }
    }
}

fn verify(folder: &Path, shaders: &Path, to: &str, float: &str, out: &Path) -> Run {
    let [shaders, out] = [shaders, out].map(|path| path.to_str().unwrap());
    let arguments = [
        "convert",
        shaders,
        "--verify",
        "--to",
        to,
        "--float",
        float,
        "-o",
        out,
        "--timeout",
        "2m",
    ];
    toyproof(folder, &arguments)
}

/// The names of the shaders of a folder.
fn names(shaders: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(shaders).unwrap().map(|entry| entry.unwrap().path());
    let shaders = entries.filter(|path| path.extension().is_some_and(|extension| extension == "glsl"));
    shaders
        .filter_map(|path| path.file_name().map(PathBuf::from))
        .collect()
}

#[test]
fn the_course_is_proved_and_accepted_in_fast_mode() {
    the_course_is_proved_and_accepted("fast");
}

#[test]
fn the_course_is_proved_and_accepted_in_strict_mode() {
    the_course_is_proved_and_accepted("strict");
}

fn the_course_is_proved_and_accepted(float: &str) {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let course = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl");
    assert_eq!(names(&course).len(), 15);
    all_are_proved(folder.path(), &course, float);
}

/// Numbers at the limits of functions and formats.
const NUMBERS: [&str; 12] = [
    "0.0",
    "-0.0",
    "1.0",
    "-1.0",
    "0.78539816339",
    "2.5",
    "1e20",
    "1e-20",
    "1e39",
    "-3e38",
    "1e-40",
    "90.0",
];

/// Those that are combined with each other.
const PAIRED: [&str; 8] = ["0.0", "-0.0", "-1.0", "2.5", "1e20", "1e39", "-3e38", "1e-40"];

/// Constant expressions of type float that compilers may refuse: of every function, operator and conversion,
/// with infinite, undefined and overflowing values among them.
fn constants() -> Vec<String> {
    let mut all = Vec::new();
    let unary = "radians degrees sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp log exp2 log2 sqrt \
        inversesqrt abs sign floor trunc round roundEven ceil fract length normalize";
    for function in unary.split_whitespace() {
        all.extend(NUMBERS.map(|x| format!("{function}({x})")));
        all.push(format!("dot(vec3({function}(vec3(1e20, -2.0, 0.5))), vec3(1.0))"));
    }
    for [x, y] in pairs(PAIRED) {
        for function in [
            "mod", "min", "max", "pow", "step", "atan", "dot", "distance", "reflect",
        ] {
            all.push(format!("{function}({x}, {y})"));
        }
        all.extend(["+", "-", "*", "/"].map(|operator| format!("({x}) {operator} ({y})")));
        all.extend(
            ["mix", "smoothstep", "clamp", "refract"].map(|function| format!("{function}({x}, {y}, 2.0)")),
        );
    }
    for [x, y] in pairs(["0", "1", "-1", "31", "32", "2147483647", "(-2147483647 - 1)"]) {
        for operator in ["+", "-", "*", "/", "%", "<<", ">>"] {
            all.push(format!("float({x} {operator} {y})"));
        }
    }
    for [x, y] in pairs(["0u", "1u", "31u", "32u", "4294967295u"]) {
        for operator in ["+", "-", "*", "/", "%", "<<", ">>"] {
            all.push(format!("float({x} {operator} {y})"));
        }
    }
    for bits in [
        "0x7fc00000u",
        "0x7f800000u",
        "0xff800000u",
        "0x7f7fffffu",
        "1u",
        "0x7c017c00u",
    ] {
        all.push(format!("uintBitsToFloat({bits})"));
        all.push(format!("intBitsToFloat(int({bits}))"));
        for function in ["unpackHalf2x16", "unpackSnorm2x16", "unpackUnorm2x16"] {
            all.push(format!("{function}({bits}).x"));
        }
    }
    for x in NUMBERS {
        for function in ["packHalf2x16", "packSnorm2x16", "packUnorm2x16"] {
            all.push(format!("float({function}(vec2({x})))"));
        }
        all.extend([
            format!("float(int({x}))"),
            format!("float(uint({x}))"),
            format!("float(isnan({x}))"),
        ]);
    }
    let others = [
        "length(vec3(1e20))",
        "normalize(vec3(1e20)).x",
        "normalize(vec2(1e-30, 0.0)).x",
        "1.0 / (1e-30 * 1e-10)",
        "determinant(mat3(1e20))",
        "inverse(mat2(0.0))[0].x",
        "(mat2(1e20) * mat2(1e20))[0].x",
        "(mat2(1e20) * vec2(1e20)).x",
        "outerProduct(vec2(1e20), vec2(1e20))[0].x",
        "matrixCompMult(mat2(1e20), mat2(1e20))[0].x",
        "cross(vec3(1e20), vec3(-1e20, 1e20, 1.0)).x",
        "(1e39 > 1.0 ? 1.0 : 0.0)",
        "mat2(1e39)[1].y",
        "(vec2(1.0) / vec2(false)).x",
        "(vec2(bvec3(false)) / mat2(false)[1]).x",
    ];
    all.extend(others.map(str::to_owned));
    all
}

fn pairs<const N: usize>(values: [&str; N]) -> impl Iterator<Item = [&str; 2]> {
    (0..N * N).map(move |at| [values[at / N], values[at % N]])
}

#[test]
fn constants_are_accepted_in_every_language() {
    let folder = tempfile::tempdir().unwrap();
    let constants = constants();
    assert!(constants.len() > 1_500);
    let mut own_texts = 0;
    // Many in one shader: a compiler that refuses one names it.
    for (number, part) in constants.chunks(400).enumerate() {
        let mut shader = String::new();
        let mut body = String::new();
        for (at, constant) in part.iter().enumerate() {
            // At module scope, as a local constant, in an array, and in an expression of the body.
            let _ = match at % 4 {
                0 => writeln!(shader, "const float k{at} = {constant};")
                    .and_then(|()| writeln!(body, "    c.x += k{at};")),
                1 => writeln!(body, "    const float k{at} = {constant}; c.x += k{at} * 0.5;"),
                2 => writeln!(
                    body,
                    "    float k{at}[2] = float[](0.5, {constant}); c.x += k{at}[int(p.x) & 1];"
                ),
                _ => writeln!(body, "    c.x += {constant};"),
            };
        }
        let shader =
            format!("{shader}void mainImage(out vec4 c, in vec2 p) {{\n    c = vec4(0.0);\n{body}}}\n");
        let mut files = Files::default();
        let checked = checked(&mut files, &shader);
        // What readable WGSL lacks, such as a matrix minus a number, is written by naga alone.
        let own = wgsl(&checked, &files, Style::Plain, &Deadline::default()).ok();
        let lowered: [(&str, Lowered); 2] = [("fast", lower(&checked)), ("strict", lower_strict(&checked))];
        own_texts += u32::from(own.is_some());
        let own = own.map(|text| (format!("{number}-own.wgsl"), text.into_bytes()));
        let mut written: Vec<_> = own.into_iter().collect();
        for (mode, lowered) in lowered {
            let module = ValidModule::parse(&lowered)
                .unwrap_or_else(|errors| panic!("{mode}: {errors:?}\n{}", lowered.text()));
            for target in Target::ALL {
                let name = format!("{number}-{mode}.{}", target.extension());
                written.push((name, emit(&module, target).unwrap()));
            }
        }
        for (name, bytes) in written {
            let path = folder.path().join(name);
            fs::write(&path, &bytes).unwrap();
            if path.extension().is_some_and(|extension| extension == "wgsl") {
                let text = String::from_utf8(bytes).unwrap();
                ValidModule::of_wgsl(&text).unwrap_or_else(|why| panic!("{}: {why}\n{text}", path.display()));
                // What tint refuses, where it is not installed.
                for rest in text.split("bitcast<f32>(").skip(1) {
                    let bits = rest.split_once("u)").and_then(|(bits, _)| bits.parse().ok());
                    assert!(bits.is_none_or(|bits| f32::from_bits(bits).is_finite()), "{text}");
                }
            }
            is_accepted(&path);
        }
    }
    assert!(own_texts > 0, "toyproof's writer refuses all");
}

/// Functions of constants whose last bits are implementation-defined, in arguments that compilers fold: a
/// macro, a local constant, a global one, an array.
fn inexact_constants() -> String {
    let unary = "radians degrees sin cos tan asin acos atan sinh cosh tanh asinh atanh exp exp2 inversesqrt fract log log2";
    let mut body = String::new();
    for (at, function) in unary.split_whitespace().enumerate() {
        let _ = writeln!(
            body,
            "    c[{}] += q * {function}(PI / 4.0) + {function}(vec2(0.1, 0.7)).y * p.x + {function}(K * 0.3);",
            at % 3
        );
    }
    format!(
        "#define PI 3.14159265359
        #define rot(a) mat2(cos(a), sin(a), -sin(a), cos(a))
        const float K = sin(0.3) + tan(0.9);
        const vec3 LIGHT = normalize(vec3(1.0, 2.0, 3.0));
        const float TABLE[3] = float[](exp(0.7), pow(2.3, 1.7), cosh(1.3));
        void mainImage(out vec4 c, in vec2 p) {{
            vec2 q2 = rot(PI / 4.) * (p / iResolution.xy);
            float q = q2.x;
            c = vec4(q2, dot(LIGHT, vec3(p, 1.0)), TABLE[int(p.x) % 3]);
        {body}
            c.xyz += acosh(1.7) * q + atan(0.3, -0.7) + pow(vec3(0.3, 1.1, 2.7), vec3(2.2)) * q;
            c.xyz += mix(vec3(0.1), vec3(0.7), 0.3) + smoothstep(0.1, 0.9, 0.37) + mod(7.3, 1.9) + reflect(LIGHT, LIGHT);
            c.xyz += inverse(mat3(1.1, 0.2, 0.3, 0.4, 1.5, 0.6, 0.7, 0.8, 1.9)) * vec3(0.3, 0.7, q);
            c.x += length(vec3(0.1, 0.7, 1.3)) * q + distance(vec2(0.1, 0.3), vec2(1.7)) + float(0xFFFFFFFFu);
        }}"
    )
}

#[test]
fn inexact_functions_of_constants_are_proved() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let shaders = folder.path().join("in");
    fs::create_dir(&shaders).unwrap();
    fs::write(shaders.join("a.glsl"), inexact_constants()).unwrap();
    for float in ["fast", "strict"] {
        all_are_proved(folder.path(), &shaders, float);
    }
}

/// Arrays of every type of element, initialized, zeroed, in and outside of functions.
const ARRAYS: &str = "
struct Disk { vec2 at; float radius; mat2 turn; };
const vec3 COLORS[3] = vec3[](vec3(0.1), vec3(0.2, 0.5, 1.0), vec3(0.3));
const Disk DISKS[2] = Disk[](Disk(vec2(1), 2., mat2(1.)), Disk(vec2(3, sin(0.5)), 4., mat2(1, 2, 3, 4)));
const mat2 TURNS[2] = mat2[](mat2(1, 2, 3, 4), mat2(5, 6, 7, 8));
const float LIMITS[2] = float[](sin(1.0), 1.0 / 0.0);
const Disk ONE = Disk(vec2(1), 2., mat2(1, 2, 3, 4));
float history[4];
Disk found[3];
void mainImage(out vec4 c, in vec2 p) {
    float a[3] = float[](0.1, 0.2, 0.3);
    Disk empty[2];
    bvec2 flags[2] = bvec2[](bvec2(true, false), bvec2(false));
    ivec3 counts[2];
    int i = int(p.x);
    counts[i % 2].y += 3;
    history[i % 4] += p.y;
    found[i % 3].radius = 2.0;
    c = vec4(a[i % 3] + DISKS[i % 2].at.y + COLORS[i % 3].y, TURNS[i % 2][1].x, ONE.turn[1].y + empty[i % 2].radius, 1);
    c.xy += DISKS[i % 2].turn[1] + vec2(flags[i % 2]) + min(LIMITS[i % 2], 9.0) + float(counts[0].y);
    c.z += history[1] + found[0].radius + found[2].at.x;
}";

#[test]
fn arrays_are_proved_in_every_language() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let shaders = folder.path().join("in");
    fs::create_dir(&shaders).unwrap();
    fs::write(shaders.join("arrays.glsl"), ARRAYS).unwrap();
    for float in ["fast", "strict"] {
        all_are_proved(folder.path(), &shaders, float);
    }
}

#[test]
fn generated_programs_are_proved_and_accepted() {
    if !require_driver() {
        return;
    }
    let count: u32 = setting("TOYPROOF_PROGRAMS", 12);
    let mut state = pcg(setting("TOYPROOF_SEED", 0));
    let mut random = || {
        state = pcg(state);
        state
    };
    let folder = tempfile::tempdir().unwrap();
    let shaders = env::var_os("TOYPROOF_WRITTEN").map_or_else(|| folder.path().join("in"), PathBuf::from);
    fs::create_dir_all(&shaders).unwrap();
    for number in 0..count {
        let length = 8 + random() as usize % 900;
        let bytes: Vec<u8> = (0..length).map(|_| (random() >> 13) as u8).collect();
        // Half of the programs have functions whose last bits are implementation-defined.
        let arithmetic = if number % 2 == 0 {
            Arithmetic::Exact
        } else {
            Arithmetic::Any
        };
        let program = generate::program(&bytes, Effects::Ordered, arithmetic);
        fs::write(shaders.join(format!("{number:03}.glsl")), program).unwrap();
    }
    for float in ["fast", "strict"] {
        let out = folder.path().join(float);
        let run = verify(folder.path(), &shaders, "wgsl", float, &out);
        eprintln!("{float}: {}", run.stderr.lines().last().unwrap_or_default());
        // Every pixel of some programs depends on undefined behavior.
        let is_unexplained = |line: &&str| {
            line.starts_with("refused")
                || line.starts_with("unproved") && !line.contains("undefined behavior")
        };
        let unexplained: Vec<_> = run.stdout.lines().filter(is_unexplained).collect();
        assert!(
            unexplained.is_empty(),
            "{float}: {unexplained:#?}\n{}",
            run.stderr
        );
        let proved = run
            .stdout
            .lines()
            .filter(|line| line.starts_with("proved"))
            .count();
        assert!(proved * 2 > count as usize, "{float}: {}", run.stdout);
        for name in names(&shaders) {
            let file = out.join(name).with_extension("wgsl");
            if file.exists() {
                is_accepted(&file);
            }
        }
    }
}

#[test]
fn nothing_is_claimed_of_a_file_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); }";
    fs::write(folder.path().join("a.glsl"), shader).unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    let mut cases = vec![("file/x.wgsl", "cannot write file/x.wgsl: `file` is not a folder")];
    if cfg!(target_os = "linux") {
        cases.push((
            "/proc/x.wgsl",
            "cannot write /proc/x.wgsl: No such file or directory",
        ));
        cases.push(("/dev/full", "cannot write /dev/full: No space left on device"));
    }
    for (output, message) in cases {
        let run = toyproof(
            folder.path(),
            &["convert", "a.glsl", "--to", "wgsl", "-o", output],
        );
        assert_eq!(run.code, 2, "{run:?}");
        assert_eq!(run.stderr.trim_end(), format!("error: {message}"), "{run:?}");
        assert_eq!(run.stdout, "");
    }
    let run = toyproof(
        folder.path(),
        &["convert", "a.glsl", "-o", "file/x.wgsl", "--format", "json"],
    );
    assert_eq!(run.code, 2, "{run:?}");
    assert!(run.stdout.contains("\"output\": null") && run.stdout.contains("\"message\": \"not written\""));
}

#[test]
fn languages_have_the_names_of_their_extensions() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); }";
    fs::write(folder.path().join("a.glsl"), shader).unwrap();
    let metal = toyproof(folder.path(), &["convert", "a.glsl", "--to", "metal"]);
    let msl = toyproof(folder.path(), &["convert", "a.glsl", "--to", "msl"]);
    assert_eq!((msl.code, msl.stdout), (0, metal.stdout));
    let run = toyproof(folder.path(), &["convert", "a.glsl", "-o", "a.spirv"]);
    assert_eq!(run.code, 0, "{run:?}");
    let bytes = fs::read(folder.path().join("a.spirv")).unwrap();
    assert_eq!(bytes[..4], 0x0723_0203_u32.to_le_bytes());
}

#[test]
fn an_operation_that_a_style_lacks_has_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let shader =
        "void mainImage(out vec4 c, in vec2 p) {\n    mat2 m = mat2(p, p);\n    c = (m / 3.0)[1].xyxy;\n}";
    fs::write(folder.path().join("a.glsl"), shader).unwrap();
    let run = toyproof(folder.path(), &["convert", "a.glsl", "--style", "bevy"]);
    assert_eq!(run.code, 2, "{run:?}");
    assert!(
        run.stderr
            .contains("error[E0902]: this matrix operation is not supported in the style `bevy`")
            && run.stderr.contains("a.glsl:3:9"),
        "{run:?}"
    );
}
