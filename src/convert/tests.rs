//! Proofs on the evaluator, without a driver.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use toyproof_diagnostic::{Deadline, File, Files};
use toyproof_glsl::{Checked, Options, check};
use toyproof_translate::backend::{Target, emit};
use toyproof_translate::c_family::{CHost, Title, write};
use toyproof_translate::lower;
use toyproof_translate::naga_ir::ValidModule;
use toyproof_translate::wgsl::{Style, wgsl};
use toyproof_verify::Failure;

use super::proof::evaluate;
use super::{ProofError, Prover, Runner, ShaderProof, Source, TargetCode, frames};

const TIME_LIMIT: Duration = Duration::from_secs(60);

const WAVES: &str = "
struct Wave { vec2 at; float width; };
float height(Wave wave, vec2 p) { return exp(-dot(p - wave.at, p - wave.at) / wave.width); }
void mainImage(out vec4 color, in vec2 p) {
    vec2 uv = p / iResolution.xy - 0.5;
    float sum = 0.0;
    for (int i = 0; i < 4; i++) {
        if (i == 2) continue;
        sum += height(Wave(vec2(float(i) * 0.1, sin(iTime)), 0.25), uv);
    }
    color = vec4(fract(sum), mod(p.x, 7.0) / 7.0, iMouse.x + float(iFrame % 5), iDate.w);
}";

fn checked(files: &mut Files, text: &str) -> Checked {
    let file = files.add(File::new("waves.glsl", text));
    check(files, file, &Options::default()).expect("it is valid")
}

/// Proves a conversion of `shader` on the evaluator.
fn prove(
    shader: &str,
    timeout: Duration,
    convert: impl Fn(&Source) -> TargetCode,
) -> Result<ShaderProof, ProofError> {
    let mut files = Files::default();
    let checked = checked(&mut files, shader);
    let source = Source {
        checked: &checked,
        files: &files,
    };
    let mut prover = Prover {
        runner: Runner::Evaluator(None),
        browser: None,
        timeout,
        pool: None,
    };
    prover.prove(source, &convert(&source))
}

/// The shader's WGSL with one edit.
fn edited(source: &Source, style: Style, from: &str, to: &str) -> TargetCode {
    let text = wgsl(source.checked, source.files, style, &Deadline::default()).unwrap();
    assert!(text.contains(from), "{text}");
    TargetCode::Wgsl(text.replacen(from, to, 1), style)
}

#[test]
fn wgsl_of_every_style_is_proved() {
    for style in Style::ALL {
        // compute.toys has no date.
        let shader = match style {
            Style::Plain | Style::WgpuShadertoy | Style::Bevy => WAVES.to_owned(),
            Style::ComputeToys => WAVES.replace("iDate.w", "iMouse.z"),
        };
        let proved = prove(&shader, TIME_LIMIT, |source| edited(source, style, "", ""));
        let Ok(ShaderProof::File(proof, _)) = proved else {
            panic!("{}: {proved:?}", style.name());
        };
        assert_eq!((proof.equal(), proof.differing()), (proof.pixels(), 0));
    }
}

#[test]
fn a_changed_operator_is_found() {
    for (from, to) in [
        ("/ wave.width", "* wave.width"),
        ("i == 2", "i >= 2"),
        ("p - wave.at", "p + wave.at"),
    ] {
        let unproved = prove(WAVES, TIME_LIMIT, |source| edited(source, Style::Plain, from, to));
        match &unproved {
            Err(
                unproved @ ProofError::Differs {
                    differing, pixels, ..
                },
            ) => {
                assert!(*differing > 0 && differing <= pixels && !unproved.is_of_shader());
                assert!(
                    unproved
                        .to_string()
                        .contains(" from the evaluator's image, by at most "),
                    "{unproved}"
                );
            }
            other => panic!("{from}: {other:?}"),
        }
    }
}

#[test]
fn glsl_is_read_again_and_metal_only_in_its_source() {
    let by_naga = |target| {
        move |source: &Source| {
            let lowered = lower(source.checked);
            let module = ValidModule::parse(&lowered).unwrap();
            TargetCode::Naga {
                target,
                bytes: emit(&module, target).unwrap(),
                lowered,
            }
        }
    };
    assert!(matches!(
        prove(WAVES, TIME_LIMIT, by_naga(Target::Glsl)),
        Ok(ShaderProof::File(..))
    ));
    assert!(matches!(
        prove(WAVES, TIME_LIMIT, by_naga(Target::Msl)),
        Ok(ShaderProof::Source(_))
    ));
    let readable = |source: &Source| {
        let title = Title::of_shader("waves");
        let text = write(
            source.checked,
            source.files,
            CHost::Metal,
            title,
            &Deadline::default(),
        );
        TargetCode::CFamily(text.unwrap(), CHost::Metal)
    };
    let unproved = prove(WAVES, TIME_LIMIT, readable).unwrap_err();
    assert!(matches!(unproved, ProofError::AppleOnly("Metal")) && !unproved.is_of_shader());
    let read = prove(WAVES, TIME_LIMIT, by_naga(Target::Spirv));
    // naga's SPIR-V nests the uniform block in a structure, which the text for the evaluator does not expect.
    assert!(matches!(read, Err(ProofError::FrontEnd(_))), "{read:?}");
}

#[test]
fn a_shader_that_is_undefined_everywhere_cannot_be_proved() {
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(p, pow(-p.x, 2.0), 1);\n}\n";
    let unproved = prove(text, TIME_LIMIT, |source| edited(source, Style::Plain, "", "")).unwrap_err();
    assert!(unproved.is_of_shader());
    assert!(
        unproved.to_string().ends_with(" at waves.glsl:2:17"),
        "{unproved}"
    );
}

#[test]
fn the_evaluator_compiles_within_the_time_limit() {
    let checked = checked(&mut Files::default(), WAVES);
    let stop = AtomicBool::new(false);
    let failure = evaluate(&checked, &frames(&checked), Duration::from_nanos(1), &stop).err();
    assert!(matches!(failure, Some(Failure::Overdue(_))), "{failure:?}");
}

#[test]
fn a_file_that_takes_too_long_to_read_is_overdue() {
    let unproved = prove(WAVES, Duration::from_nanos(1), |source| {
        edited(source, Style::Plain, "", "")
    });
    assert!(matches!(unproved, Err(ProofError::Overdue(_))), "{unproved:?}");
}
