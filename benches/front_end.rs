//! How long it takes from an author's text to the SPIR-V that runs, beside naga's own share of it. `cargo
//! bench --bench front_end`

use std::fmt::Write;
use std::fs;

use divan::Bencher;
use toyproof::diagnostic::{File, FileId, Files};
use toyproof::glsl::{Options, check};
use toyproof::translate::backend::spirv;
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::{Lowered, lower};

const SHADERS: [&str; 4] = ["02-sphere", "04-many-objects", "06-reflections", "5,000 lines"];

fn main() {
    divan::main();
}

fn text(name: &str) -> String {
    if name == "5,000 lines" {
        return long();
    }
    fs::read_to_string(format!("glsl/{name}.glsl")).expect("the course is here")
}

/// 500 functions of ten lines.
fn long() -> String {
    let mut text = String::new();
    for i in 0..500 {
        let before = if i == 0 {
            "x".to_owned()
        } else {
            format!("f{}(x)", i - 1)
        };
        writeln!(
            text,
            "vec3 f{i}(vec3 x) {{\n    vec3 v = x;\n    for (int i = 0; i < 3; i++) {{\n        \
             v.xy = v.yx * 0.5 + float(i);\n        if (v.x > 2.0 && v.y < 3.0) {{\n            v /= length(v);\n        \
             }}\n    }}\n    return v + {before};\n}}"
        )
        .expect("a string takes all");
    }
    text + "void mainImage(out vec4 c, in vec2 p) { c = vec4(f499(vec3(p, 0.0)), 1.0); }"
}

fn file(name: &str) -> (Files, FileId) {
    let mut files = Files::default();
    let file = files.add(File::new(name, text(name)));
    (files, file)
}

fn lowered(files: &Files, file: FileId) -> Lowered {
    lower(&check(files, file, &Options::default()).expect("these shaders are valid"))
}

fn spirv(lowered: &Lowered) -> Vec<u32> {
    let module = ValidModule::parse(lowered).expect("naga takes what we print");
    spirv::words(&module).expect("naga writes what it takes")
}

/// Preprocess, parse, check.
#[divan::bench(args = SHADERS)]
fn checked(bencher: Bencher, name: &str) {
    let (files, file) = file(name);
    bencher.bench(|| check(&files, file, &Options::default()));
}

/// All of it: check, lower, print, and naga's parse, validate and write.
#[divan::bench(args = SHADERS)]
fn source_to_spirv(bencher: Bencher, name: &str) {
    let (files, file) = file(name);
    bencher.bench(|| spirv(&lowered(&files, file)));
}

/// naga's parse, validate and write alone, of what we print.
#[divan::bench(args = SHADERS)]
fn naga_alone(bencher: Bencher, name: &str) {
    let (files, file) = file(name);
    let lowered = lowered(&files, file);
    bencher.bench(|| spirv(&lowered));
}
