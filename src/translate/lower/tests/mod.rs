//! For each pass: naga fails without it, and takes the shader with it.

mod expressions;
mod printed;
mod statements;

use std::panic::catch_unwind;

use naga::back::{spv, wgsl};
use naga::front::glsl::{Frontend, Options};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use toyproof_diagnostic::{File, Files};
use toyproof_glsl::{Checked, check};

use super::{Pass, Passes, lower_with};

fn checked(text: &str, lenient: bool) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let options = toyproof_glsl::Options {
        lenient,
        ..Default::default()
    };
    check(&files, file, &options).unwrap_or_else(|diagnostics| {
        panic!("{}\n{text}", toyproof_diagnostic::short(&diagnostics[0], &files))
    })
}

/// What naga writes as WGSL for a GLSL text that it can also write as SPIR-V, or why it cannot.
fn naga(text: &str) -> Result<String, String> {
    let text = text.to_owned();
    catch_unwind(move || {
        let options = Options::from(naga::ShaderStage::Fragment);
        let mut module = Frontend::default()
            .parse(&options, &text)
            .map_err(|error| error.emit_to_string(&text))?;
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        let info = Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .map_err(|error| error.emit_to_string(&text))?;
        spv::write_vec(&module, &info, &spv::Options::default(), None).map_err(|error| error.to_string())?;
        wgsl::write_string(&module, &info, wgsl::WriterFlags::empty()).map_err(|error| error.to_string())
    })
    .unwrap_or_else(|_| Err("panic".to_owned()))
}

/// Without that pass naga refuses the shader; with it, it does not. Gives the lowered text.
fn mends(pass: Pass, text: &str) -> String {
    let checked = checked(text, true);
    let without = lower_with(&checked, Passes::all().without(pass));
    assert!(
        naga(without.text()).is_err(),
        "naga is mended, {pass:?} can go:\n{}",
        without.text()
    );
    accepted(&checked)
}

/// Without that pass naga takes the shader and gets it wrong, as `wrong` tells from the WGSL; with it, it does not.
fn corrects(pass: Pass, text: &str, wrong: impl Fn(&str) -> bool) -> String {
    let checked = checked(text, true);
    let without = lower_with(&checked, Passes::all().without(pass));
    let wgsl = naga(without.text()).unwrap_or_else(|error| panic!("{error}\n{}", without.text()));
    assert!(
        wrong(&wgsl),
        "naga is mended, {pass:?} can go:\n{}\n{wgsl}",
        without.text()
    );
    let lowered = lower_with(&checked, Passes::all());
    let wgsl = naga(lowered.text()).unwrap_or_else(|error| panic!("{error}\n{}", lowered.text()));
    assert!(!wrong(&wgsl), "{}\n{wgsl}", lowered.text());
    lowered.text().to_owned()
}

fn accepted(checked: &Checked) -> String {
    let lowered = lower_with(checked, Passes::all());
    if let Err(error) = naga(lowered.text()) {
        panic!("{error}\n{}", lowered.text());
    }
    lowered.text().to_owned()
}

/// A shader whose `mainImage` is that.
fn main_image(before: &str, body: &str) -> String {
    format!("{before}\nvoid mainImage(out vec4 o, in vec2 p) {{\n    o = vec4(0.0);\n    {body}\n}}\n")
}

/// The lowered lines of the author's functions.
fn lines(before: &str, body: &str) -> String {
    let text = accepted(&checked(&main_image(before, body), true));
    let begin = text.find("void mainImage").unwrap_or(0);
    let end = text.find("void main()").unwrap_or(text.len());
    let lines = text[begin..end].lines().map(str::trim);
    lines
        .filter(|line| !matches!(*line, "" | "}" | "o = vec4(0.0);") && !line.contains("mainImage"))
        .collect::<Vec<_>>()
        .join("\n")
}

fn position(text: &str, needle: &str) -> usize {
    text.find(needle)
        .unwrap_or_else(|| panic!("{needle} is not in\n{text}"))
}
