//! Workarounds for drivers: [`QUIRKS`] lists all of them, and the files of this folder are those that the
//! worker applies. Those that change the text or the words of every shader are applied by other crates.

mod foldable;
pub(crate) mod loop_cap;
pub(crate) mod loop_exits;
pub(crate) mod loop_probe;
pub(crate) mod loop_steps;
mod opaque;
pub(crate) mod opaque_numbers;

use std::borrow::Cow;
use std::process::Command;

use toyproof_translate::FloatMode;

/// A family of drivers that share their faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriverKind {
    /// Mesa's software driver, whose adapter is named after its rasterizer llvmpipe.
    Lavapipe,
    /// `SwiftShader`, Chromium's software driver.
    SwiftShader,
}

impl DriverKind {
    /// A substring of the names of the driver's adapters.
    pub fn adapter_name(self) -> &'static str {
        match self {
            Self::Lavapipe => "llvmpipe",
            Self::SwiftShader => "SwiftShader",
        }
    }

    /// Whether an adapter belongs to this family.
    pub fn matches(self, adapter: &str) -> bool {
        adapter.contains(self.adapter_name())
    }
}

/// The drivers on which a workaround is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// All drivers: it costs little and changes no defined bit, and converted shaders run anywhere.
    Everywhere,
    /// The affected family of drivers, in all versions.
    Affected,
}

/// A fault of a driver, and its workaround.
#[derive(Debug, Clone, Copy)]
pub struct Quirk {
    /// The name in kebab case.
    pub name: &'static str,
    /// The affected family of drivers.
    pub driver: DriverKind,
    /// The affected versions, as far as they are known.
    pub versions: &'static str,
    /// The fault without the workaround.
    pub symptom: &'static str,
    /// The workaround, in one sentence.
    pub workaround: &'static str,
    /// The file that applies it, relative to the root of the repository.
    pub source: &'static str,
    /// When it can be removed.
    pub removal: &'static str,
    /// Where it is applied.
    pub scope: Scope,
}

impl Quirk {
    /// Whether the workaround is applied on an adapter.
    pub fn applies_to(&self, adapter: &str) -> bool {
        self.scope == Scope::Everywhere || self.driver.matches(adapter)
    }
}

/// Why workarounds for Mesa 22.3 are kept.
const AFTER_MESA_22: &str = "when Mesa 22.3 (Debian 12) is no longer supported";

/// Loops terminated by force.
pub const LOOP_CAP: Quirk = Quirk {
    name: "loop-cap",
    driver: DriverKind::Lavapipe,
    versions: "Mesa before 23: 22.3.6 has the limit, 25.0.7 does not. Measured on each device",
    symptom: "all loops of a pixel end after 65,535 iterations in total, without an error",
    workaround: "the device's limit is measured; where loops may reach it, the frame is rendered again with \
                 its loops instrumented, and a pixel in which one was terminated fails the shader",
    source: "src/gpu/quirks/loop_cap.rs",
    removal: AFTER_MESA_22,
    scope: Scope::Affected,
};

/// Numbers hidden from Mesa's compiler.
pub const OPAQUE_NUMBERS: Quirk = Quirk {
    name: "opaque-numbers",
    driver: DriverKind::Lavapipe,
    versions: "Mesa 22.3.6; the second and the third symptom also 25.0.7",
    symptom: "to see whether a condition is uniform, the compiler walks expressions of uniforms as trees and \
              does not finish for an expanded `sin(cos(iTime))`; it folds the product and quotient of a \
              constant zero to zero, even if it is NaN, and a quotient by zero to anything, also if the zero \
              only results from folding (`mix(x, y, 1.0)`); where it folds constants, denormals are neither \
              zeros as operands nor flushed as results; it takes derivatives of constants for 0, even of NaN; \
              and it dies of −2³¹ / −1 while it counts \
              the iterations of `while (k-- != -2147483647 - 1)`",
    workaround: "in strict runs, numbers of the uniform block and operands of these operations that may be \
                 found to be constant are combined by or with bits of `gl_FragCoord.z` that are 0",
    source: "src/gpu/quirks/opaque_numbers.rs",
    removal: "when `tests/suite/evaluator.rs` and `tests/suite/generated.rs` pass without it on the supported \
              versions of Mesa",
    scope: Scope::Affected,
};

/// Constants hidden from `SwiftShader`'s compiler.
pub const FOLDED_DENORMALS: Quirk = Quirk {
    name: "folded-denormals",
    driver: DriverKind::SwiftShader,
    versions: "the SPIRV-Tools in Chromium",
    symptom: "where it folds constants, denormals are neither zeros as operands nor flushed as results",
    workaround: "that of `opaque-numbers`",
    source: "src/gpu/quirks/opaque_numbers.rs",
    removal: "never: Vulkan allows both",
    scope: Scope::Affected,
};

/// Variables overwritten after a pixel has left a loop.
pub const LOOP_EXITS: Quirk = Quirk {
    name: "loop-exits",
    driver: DriverKind::Lavapipe,
    versions: "Mesa 22.3.6; 25.0.7 is right",
    symptom: "a pixel that leaves a loop earlier than its neighbors gets their last values of variables that \
              are assigned before the first exit of the loop: in `do … while (…)`, and in \
              `for (;;) { x = f(x); if (x > 1.0) break; }`. `for (…; i < n; …)` is right, since it has an exit \
              before all assignments",
    workaround: "such loops get an exit at their head that is never taken",
    source: "src/gpu/quirks/loop_exits.rs",
    removal: AFTER_MESA_22,
    scope: Scope::Affected,
};

/// A shader compiled twice.
pub const TWO_VARIANTS: Quirk = Quirk {
    name: "two-variants",
    driver: DriverKind::Lavapipe,
    versions: "Mesa 22.3.6; other versions were not measured",
    symptom: "a fragment shader without blending is compiled twice, for tiles that a triangle covers and for \
              those that it covers in part, which takes most of the time of a small image",
    workaround: "the color is written by a blending operation that keeps its bits; one variant then serves both",
    source: "src/gpu/pipeline.rs",
    removal: "when the first frame takes as long without it on the supported versions of Mesa",
    scope: Scope::Affected,
};

/// All known quirks.
pub const QUIRKS: [Quirk; 14] = [
    FOLDED_DENORMALS,
    LOOP_CAP,
    LOOP_EXITS,
    OPAQUE_NUMBERS,
    TWO_VARIANTS,
    Quirk {
        name: "loop-steps",
        driver: DriverKind::Lavapipe,
        versions: "Mesa 22.3.6; other versions were not measured",
        symptom: "the step in SPIR-V's continue construct runs once too often if the loop has no `continue` \
                  and the stepped variable is initialized with a constant vector",
        workaround: "steps move to the end of the body, in lowered GLSL and, by \
                     `src/gpu/quirks/loop_steps.rs`, in modules from WGSL",
        source: "src/translate/lower/loops.rs",
        removal: AFTER_MESA_22,
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "nesting",
        driver: DriverKind::Lavapipe,
        versions: "Mesa 22.3.6; other versions were not measured",
        symptom: "conditions nested deeper than 80, or 79 with an `else`, and loops deeper than 80 run \
                  regardless of their condition",
        workaround: "deep statements are flattened under flags; shaders that are still nested too deeply are not \
                     run",
        source: "src/translate/lower/nesting.rs",
        removal: "when `tests/suite/nesting.rs` passes without it on the supported versions of Mesa",
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "half-of-constant",
        driver: DriverKind::Lavapipe,
        versions: "Mesa 22.3.6; other versions were not measured",
        symptom: "the upper half of `unpackHalf2x16` of a constant is 0",
        workaround: "strict lowering unpacks each half by itself",
        source: "src/translate/lower/polyfill.rs",
        removal: AFTER_MESA_22,
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "switch-labels",
        driver: DriverKind::Lavapipe,
        versions: "Mesa 22.3.6; other versions were not measured",
        symptom: "the device is lost at a `switch` of 50,000 labels",
        workaround: "more than 20,000 labels are an error in the shader",
        source: "src/glsl/check/statement.rs",
        removal: "never: other drivers compare with each label, too",
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "sign-of-zero",
        driver: DriverKind::Lavapipe,
        versions: "Mesa 22.3.6; Vulkan leaves the sign to all drivers without `SignedZeroInfNanPreserve`",
        symptom: "a zero that an `if` or `?:` chooses, or that is `0.0 - x`, may lose its sign",
        workaround: "the toolchain check treats both zeros as equal",
        source: "src/verify/compare/check.rs",
        removal: "when all supported drivers keep signs on request",
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "runtime-directory",
        driver: DriverKind::Lavapipe,
        versions: "Mesa 22.3.6; other versions were not measured",
        symptom: "a message on standard error where `XDG_RUNTIME_DIR` is not set",
        workaround: "it is set to the folder for temporary files in the worker process",
        source: "src/gpu/quirks/mod.rs",
        removal: "when Mesa is silent without it",
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "coarse-derivatives",
        driver: DriverKind::SwiftShader,
        versions: "the version in Chromium; SPIR-V leaves the precision to all drivers",
        symptom: "`dFdx`, `dFdy` and `fwidth` are those of the quad's first row and column",
        workaround: "strict code requests fine derivatives",
        source: "src/translate/backend/spirv/mod.rs",
        removal: "never: the specification allows both",
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "decorated-constants",
        driver: DriverKind::SwiftShader,
        versions: "the SPIRV-Tools in Chromium",
        symptom: "its constant propagation treats `sqrt`, `min` and `max` of constants as unknown if \
                  they are decorated, and uses the other branch's constant",
        workaround: "these functions, which are exact or correctly rounded, carry no `NoContraction`",
        source: "src/translate/backend/spirv/mod.rs",
        removal: "never: the decoration has no use there",
        scope: Scope::Everywhere,
    },
    Quirk {
        name: "inexact-functions",
        driver: DriverKind::SwiftShader,
        versions: "the version in Chromium",
        symptom: "`fract` stays below 1, `step` of NaN is 0, `float(uint)` is rounded twice above 2³¹, and \
                  `unpackUnorm2x16` multiplies by 1/65535",
        workaround: "strict lowering expands them",
        source: "src/translate/lower/polyfill.rs",
        removal: "never: the specification allows different last bits",
        scope: Scope::Everywhere,
    },
];

/// Returns the words of a module that the driver of an adapter gets instead: Mesa's loops need early exits, and
/// its compiler must not recognize that strict, expanded operations are computed from uniforms and constants.
pub fn with_workarounds<'a>(words: &'a [u32], adapter: &str, float: FloatMode) -> Cow<'a, [u32]> {
    let applies = |quirk: &Quirk| quirk.applies_to(adapter);
    let mut words = Cow::from(words);
    if applies(&LOOP_EXITS) {
        words = loop_exits::with_early_exits(&words).into();
    }
    if float == FloatMode::Strict && (applies(&OPAQUE_NUMBERS) || applies(&FOLDED_DENORMALS)) {
        words = opaque_numbers::with_opaque_numbers(&words).into();
    }
    words
}

/// Prepares the environment of a process that loads drivers.
pub(crate) fn set_environment(command: &mut Command) {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::fmt::Write;
    use std::fs;
    use std::path::Path;

    use expect_test::expect_file;

    use super::*;

    /// The first section of the page that is not generated.
    const MEASURED: &str = "\n## Measured drivers\n";

    #[test]
    fn the_page_lists_every_quirk() {
        let mut page =
            "# Driver workarounds\n\nGenerated from `src/gpu/quirks` (`UPDATE_EXPECT=1 cargo test -p \
                        toyproof-gpu`).\n"
                .to_owned();
        for quirk in QUIRKS {
            let scope = match quirk.scope {
                Scope::Everywhere => "all drivers",
                Scope::Affected => "this driver",
            };
            let _ = write!(
                page,
                "\n## {}\n\n- Driver: {:?}\n- Versions: {}\n- Symptom: {}\n- Workaround, on {scope}: {} (`{}`)\n- Removal: {}\n",
                quirk.name,
                quirk.driver,
                quirk.versions,
                quirk.symptom,
                quirk.workaround,
                quirk.source,
                quirk.removal,
            );
        }
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/evidence/drivers.md");
        let text = fs::read_to_string(path).unwrap();
        page += &text[text.find(MEASURED).unwrap_or(text.len())..];
        expect_file![path].assert_eq(&page);
    }

    #[test]
    fn names_are_unique_and_sources_exist() {
        let names: HashSet<_> = QUIRKS.iter().map(|quirk| quirk.name).collect();
        assert_eq!(names.len(), QUIRKS.len());
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for quirk in QUIRKS {
            assert!(root.join(quirk.source).is_file(), "{}", quirk.source);
        }
    }

    #[test]
    fn workarounds_apply_where_they_are_needed() {
        let lavapipe = "llvmpipe (LLVM 15.0.6, 256 bits)";
        assert!(OPAQUE_NUMBERS.applies_to(lavapipe) && LOOP_CAP.applies_to(lavapipe));
        assert!(!OPAQUE_NUMBERS.applies_to("SwiftShader Device (LLVM 10.0.0)"));
        let everywhere = QUIRKS.iter().filter(|quirk| quirk.scope == Scope::Everywhere);
        assert!(
            everywhere
                .into_iter()
                .all(|quirk| quirk.applies_to("NVIDIA H200"))
        );
    }
}
