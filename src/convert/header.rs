//! The comment at the head of a converted file: its source and its proof.

use std::fmt::Write as _;

use toyproof_diagnostic::{grouped, plural};
use toyproof_translate::NAGA_VERSION as NAGA;
use toyproof_translate::backend::{Target, spirv};

use crate::{
    FRAMES, Host, PASS_FRAMES, PASS_SIZES, PassesProof, Proof, ProofReference, Rgb8Comparison, ShaderProof,
};

/// The status of a conversion's proof.
#[derive(Debug)]
pub enum ProofStatus {
    /// No proof was requested.
    NotRequested,
    /// The conversion is proved.
    Proved(ShaderProof),
    /// All passes are proved.
    ProvedPasses(PassesProof),
    /// The conversion is not proved, for this reason.
    NotProved(String),
}

/// What a file was made from.
#[derive(Debug, Clone, Copy)]
pub struct Origin<'a> {
    /// The name of the shader or the pass.
    pub name: &'a str,
    /// Its title, author and address, if they are known.
    pub credit: Option<&'a str>,
}

impl ProofStatus {
    /// Returns whether it is proved, or no proof was requested.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        !matches!(self, Self::NotProved(_))
    }
}

/// Inserts the comment before a text, or after the `#version` line, which must come first. In SPIR-V it is a
/// string that nothing refers to.
pub fn insert(bytes: &mut Vec<u8>, target: Target, origin: Origin, status: &ProofStatus) {
    let at = match target {
        Target::Spirv => {
            if let Some(words) = spirv::of_bytes(bytes) {
                *bytes = spirv::bytes(&spirv::with_note(&words, &header_text(origin, status)));
            }
            return;
        }
        Target::Glsl if bytes.starts_with(b"#version") => bytes
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(0, |end| end + 1),
        Target::Glsl | Target::Wgsl | Target::Msl | Target::Hlsl => 0,
    };
    let head = header_text(origin, status);
    bytes.splice(at..at, head.into_bytes());
}

/// The text of a host's file with the comment.
#[must_use]
pub fn insert_in_hosted(text: &str, host: Host, origin: Origin, status: &ProofStatus) -> String {
    let head = header_text(origin, status);
    match host {
        Host::Three => head + text,
        // The header of ISF comes first.
        Host::Isf => match text.split_once("*/\n\n") {
            Some((json, body)) => format!("{json}*/\n\n{head}{body}"),
            None => head + text,
        },
    }
}

/// A text on the line of a comment, which its line breaks would end: `replacement` takes their place. JavaScript
/// has two more than other languages.
fn in_comment(text: &str, replacement: char) -> String {
    let ends_line = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
    let shown = text.chars().map(|c| if ends_line(c) { replacement } else { c });
    shown.collect()
}

fn header_text(origin: Origin, status: &ProofStatus) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let mut head = String::new();
    if let Some(credit) = origin.credit {
        let _ = writeln!(head, "// {}", in_comment(credit, '?'));
    }
    let name = in_comment(origin.name, '?');
    let _ = writeln!(head, "// {name}, converted by toyproof {version} (naga {NAGA}).");
    match status {
        ProofStatus::NotRequested => {}
        ProofStatus::Proved(ShaderProof::File(proof, readers)) => {
            let names: Vec<_> = readers.run.iter().map(ToString::to_string).collect();
            let _ = writeln!(
                head,
                "// Proved: this file, as read by {} and run on {},",
                names.join(" and "),
                proof.device
            );
            settings(&mut head, proof);
            if let Some(validator) = &readers.validator {
                let _ = writeln!(head, "// {validator} accepts it.");
            }
            in_browser(&mut head, readers.browser.as_ref());
        }
        ProofStatus::Proved(ShaderProof::Source(proof)) => {
            head.push_str(
                "// Proved: the module that this text was written from. No compiler for the text was installed.\n",
            );
            let _ = writeln!(head, "// The module, run on {},", proof.device);
            settings(&mut head, proof);
        }
        ProofStatus::ProvedPasses(proof) => passes(&mut head, proof),
        ProofStatus::NotProved(why) => {
            let why = in_comment(why, ' ');
            let _ = writeln!(head, "// NOT PROVED: {why}");
        }
    }
    head.push('\n');
    head
}

/// Appends the reference of the comparison, the frames, and the number of pixels that were left out.
fn settings(head: &mut String, proof: &Proof) {
    let against = match proof.against {
        ProofReference::Evaluator => "renders the same image as the original in toyproof's float32 evaluator",
        ProofReference::StrictRun => {
            "renders the same image as the original does there with strict arithmetic"
        }
    };
    let frames: Vec<_> = FRAMES
        .iter()
        .map(|frame| format!("{}x{} at iTime {}", frame.size[0], frame.size[1], frame.time))
        .collect();
    let _ = writeln!(head, "// {against}: {}.", describe_proof(proof));
    let channels = match proof.against {
        ProofReference::Evaluator => "",
        ProofReference::StrictRun => "; 2D channels hold noise",
    };
    let _ = writeln!(head, "// Frames: {}{channels}.", frames.join(", "));
    head.push_str("// Functions with implementation-defined precision, such as sin, were replaced by the evaluator's.\n");
}

/// Appends the result in a browser, if there is one.
fn in_browser(head: &mut String, browser: Option<&(String, Rgb8Comparison)>) {
    if let Some((name, shown)) = browser {
        let _ = writeln!(
            head,
            "// {name} on SwiftShader renders these frames like the original with WebGL 2: {}.",
            describe_browser(*shown)
        );
    }
}

/// Appends the proof of the passes of a project.
fn passes(head: &mut String, proof: &PassesProof) {
    let readers: Vec<_> = proof.readers.iter().map(ToString::to_string).collect();
    if readers.is_empty() {
        head.push_str(
            "// Proved: the modules that these texts were written from. No compiler for the texts was installed.\n",
        );
        let _ = writeln!(head, "// The modules, played on {},", proof.device);
    } else {
        let readers = readers.join(" and ");
        let _ = writeln!(
            head,
            "// Proved: this file and those of the other passes, as read by {readers} and played on {},",
            proof.device
        );
    }
    let pixels = describe_passes(proof);
    let _ = writeln!(
        head,
        "// render the same textures as the original does there with strict arithmetic: {pixels}."
    );
    let sizes = PASS_SIZES.map(|[width, height]| format!("{width}x{height}"));
    let last = PASS_FRAMES - 1;
    let _ = writeln!(
        head,
        "// Frames: 0 to {last} at {}; textures that are not available hold noise.",
        sizes.join(" and ")
    );
    head.push_str("// Functions with implementation-defined precision, such as sin, were replaced by the evaluator's.\n");
    if let Some(validator) = &proof.validator {
        let _ = writeln!(head, "// {validator} accepts them.");
    }
    in_browser(head, proof.browser.as_ref());
}

/// Describes how many pixels of all passes are equal.
#[must_use]
pub fn describe_passes(proof: &PassesProof) -> String {
    let passes = proof.passes.len() as u64;
    let (pixels, undefined) = (proof.pixels(), proof.undefined());
    format!(
        "{passes} passes: {}",
        describe_equal(pixels - undefined, pixels, undefined)
    )
}

/// What a line of the terminal says of a browser's images, if there are any.
pub fn in_chromium(browser: Option<&(String, Rgb8Comparison)>) -> String {
    browser.map_or_else(String::new, |(_, shown)| {
        format!("; in Chromium {}", describe_browser(*shown))
    })
}

/// Describes the difference between a browser's images.
fn describe_browser(shown: Rgb8Comparison) -> String {
    let by = match format!("{:.2}", shown.max * 255.0).as_str() {
        _ if shown.max == 0.0 => String::new(),
        "0.00" => " by as much as 0.01/255".to_owned(),
        levels => format!(" by more than {levels}/255"),
    };
    format!("none of {} displayed pixels differs{by}", grouped(shown.pixels))
}

/// Describes how many pixels are equal.
#[must_use]
pub fn describe_proof(proof: &Proof) -> String {
    describe_equal(proof.equal(), proof.pixels(), proof.undefined())
}

fn describe_equal(equal: u64, pixels: u64, undefined: u64) -> String {
    let undefined = match undefined {
        0 => String::new(),
        undefined => format!(
            "; {} {} on undefined behavior and {} left out",
            grouped(undefined),
            plural(undefined, "depends", "depend"),
            plural(undefined, "was", "were")
        ),
    };
    format!(
        "{} of {} pixels equal, bit for bit{undefined}",
        grouped(equal),
        grouped(pixels)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn naga_version_matches_the_lock_file() {
        let lock = include_str!("../../Cargo.lock");
        let package = lock
            .split("[[package]]")
            .find(|package| package.contains("name = \"naga\"\n"));
        assert!(package.unwrap().contains(&format!("version = \"{NAGA}\"")));
    }

    #[test]
    fn a_zero_difference_has_no_number() {
        let messages = [0.0, 1e-9, 0.5 / 255.0].map(|max| {
            let shown = Rgb8Comparison {
                pixels: 57_600,
                differing: 0,
                max,
            };
            describe_browser(shown)
        });
        assert!(
            messages[0].ends_with("57,600 displayed pixels differs"),
            "{messages:?}"
        );
        assert!(
            messages[1].ends_with("as much as 0.01/255") && messages[2].ends_with("more than 0.50/255"),
            "{messages:?}"
        );
    }

    #[test]
    fn names_cannot_end_the_comment_and_the_version_stays_first() {
        let mut bytes = b"#version 300 es\nvoid main() {}\n".to_vec();
        let origin = Origin {
            name: "a\nb.glsl",
            credit: Some("\"Wa\u{2028}ves\" by so\nmeone"),
        };
        insert(&mut bytes, Target::Glsl, origin, &ProofStatus::NotRequested);
        let text = String::from_utf8(bytes).unwrap();
        assert!(
            text.starts_with(
                "#version 300 es\n// \"Wa?ves\" by so?meone\n// a?b.glsl, converted by toyproof "
            ),
            "{text}"
        );
        // A SPIR-V header, and `OpCapability Shader`.
        let mut words = spirv::bytes(&[0x0723_0203, 0x0001_0000, 0, 7, 0, 0x0002_0011, 1]);
        let origin = Origin {
            name: "a",
            credit: None,
        };
        insert(&mut words, Target::Spirv, origin, &ProofStatus::NotRequested);
        let words = spirv::of_bytes(&words).unwrap();
        // The string has the next id, and follows the capability.
        assert_eq!((words[3], words[7] & 0xffff, words[8]), (8, 7, 7));
        assert_eq!(7 + (words[7] >> 16) as usize, words.len());
    }
}
