//! The comment at the head of a converted file: where it comes from, and what was proved of it.

use std::fmt::Write as _;

use super::conversion::Standing;
use crate::compare::grouped;
use crate::emit::Target;
use crate::verify::conversion::{Against, FRAMES, Proof};

/// The version of naga that translates.
const NAGA: &str = "30.0.1";

/// Puts the comment before a text, or behind the `#version` that must come first. SPIR-V has no room for one.
pub(super) fn put(bytes: &mut Vec<u8>, target: Target, name: &str, standing: &Standing) {
    let at = match target {
        Target::Spirv => return,
        Target::Glsl => bytes
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(0, |end| end + 1),
        Target::Wgsl | Target::Msl | Target::Hlsl => 0,
    };
    let head = head(name, standing);
    bytes.splice(at..at, head.into_bytes());
}

fn head(name: &str, standing: &Standing) -> String {
    // A name may hold anything, also what would end the comment.
    let name: String = name
        .chars()
        .map(|c| if c.is_control() { '?' } else { c })
        .collect();
    let version = env!("CARGO_PKG_VERSION");
    let mut head = format!("// {name}, converted by toyproof {version} (naga {NAGA}).\n");
    match standing {
        Standing::Unasked => {}
        Standing::Proved(proof) => {
            let _ = writeln!(
                head,
                "// Proved: this text, read again by naga and run on {},",
                proof.device
            );
            settings(&mut head, proof);
        }
        Standing::Meant(proof, read) => {
            let read = read.as_deref().unwrap_or("Nothing read it");
            let _ = writeln!(
                head,
                "// Proved is what this text was written from, not the text itself. {read}."
            );
            let _ = writeln!(head, "// That, run on {},", proof.device);
            settings(&mut head, proof);
        }
        Standing::Unproved(why) => {
            let why: String = why
                .chars()
                .map(|c| if c.is_control() { ' ' } else { c })
                .collect();
            let _ = writeln!(head, "// NOT PROVED: {why}");
        }
    }
    head.push('\n');
    head
}

/// What it was compared with, where, and how much was left out.
fn settings(head: &mut String, proof: &Proof) {
    let against = match proof.against {
        Against::Evaluator => "paints what toyproof's evaluator paints of the original in float32",
        Against::StrictRun => "paints what the original paints there when held to its arithmetic",
    };
    let frames: Vec<_> = FRAMES
        .iter()
        .map(|frame| format!("{}x{} at iTime {}", frame.size[0], frame.size[1], frame.time))
        .collect();
    let _ = writeln!(head, "// {against}: {}.", sum(proof));
    let channels = match proof.against {
        Against::Evaluator => "",
        Against::StrictRun => "; flat channels hold noise",
    };
    let _ = writeln!(head, "// Frames: {}{channels}.", frames.join(", "));
    head.push_str("// Functions whose last bits the target leaves open, sin and the like, were the evaluator's own for that.\n");
}

/// How many pixels are equal.
pub(super) fn sum(proof: &Proof) -> String {
    let undefined = match proof.undefined() {
        0 => String::new(),
        left_out => format!(
            ", {} left out where GLSL leaves the value undefined",
            grouped(left_out)
        ),
    };
    format!(
        "all {} pixels equal to the bit{undefined}",
        grouped(proof.pixels() - proof.undefined())
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_of_naga_is_the_one_that_is_linked() {
        let lock = include_str!("../../../Cargo.lock");
        let package = lock
            .split("[[package]]")
            .find(|package| package.contains("name = \"naga\"\n"));
        assert!(package.unwrap().contains(&format!("version = \"{NAGA}\"")));
    }

    #[test]
    fn a_name_cannot_end_the_comment_and_a_version_stays_first() {
        let mut bytes = b"#version 300 es\nvoid main() {}\n".to_vec();
        put(&mut bytes, Target::Glsl, "a\nb.glsl", &Standing::Unasked);
        let text = String::from_utf8(bytes).unwrap();
        assert!(
            text.starts_with("#version 300 es\n// a?b.glsl, converted by toyproof "),
            "{text}"
        );
        let mut words = vec![3, 2, 35, 7];
        put(&mut words, Target::Spirv, "a", &Standing::Unasked);
        assert_eq!(words, [3, 2, 35, 7]);
    }
}
