//! An author's function that intersects a ray with a sphere: its signature, how it reports a miss, where it
//! fails first, and which mistake explains the failure.

#[cfg(test)]
mod conventions;
mod example;
mod findings;
mod miss;
mod mistake;
mod replace;
mod role;
mod signature;
mod typical;

use std::time::Duration;

pub use example::Example;
pub use findings::{Findings, examine};
pub(crate) use miss::{MissConvention, clear_misses};
pub use mistake::Mistake;
pub use replace::replacements;
pub use role::{Role, RoleMap};
pub use signature::{Signature, Unrecognized};
use toyproof_eval::Number;
use toyproof_glsl::{self as glsl, ADDED_MAIN, Dialect};
pub use typical::{TypicalResults, test_typical};

use crate::case::{Case, RaySphere};
use crate::formula::main;
use crate::run::{RunError, ShaderRunner, case_frame};
use crate::tally::Outcome;

/// A shader that calls a function of `text` for each case, with [`ADDED_MAIN`], and the options of its check.
fn call_shader(text: &str, signature: &Signature, options: &glsl::Options) -> (String, glsl::Options) {
    let (steps, result) = signature.call();
    // Hosts other than ShaderToy declare their textures.
    let is_declared = |name: &str| text.contains(name);
    let is_implicit = options.dialect.is_none_or(Dialect::calls_main_image);
    let names = ["iChannel0", "iChannel1", "iChannel2"].into_iter();
    let missing = names.filter(|name| !is_implicit && !is_declared(name));
    let missing = missing.flat_map(|name| ["uniform sampler2D ", name, ";\n"]);
    let declared = missing.collect::<String>();
    let options = glsl::Options {
        calls_added_main: true,
        lenient: options.lenient || !is_implicit,
        ..options.clone()
    };
    (
        format!("{text}\n{declared}{}", main(ADDED_MAIN, &steps, &result)),
        options,
    )
}

/// Evaluates a function on chosen cases.
struct FunctionRunner<'a> {
    shader: ShaderRunner,
    signature: &'a Signature,
}

impl<'a> FunctionRunner<'a> {
    /// Compiles a shader that calls a function of `text`. `timeout` is as in [`ShaderRunner::new`].
    fn new(
        text: &str,
        signature: &'a Signature,
        options: &glsl::Options,
        timeout: Option<Duration>,
    ) -> Result<Self, RunError> {
        let (text, options) = call_shader(text, signature, options);
        let shader = ShaderRunner::new(&text, &options, timeout)?;
        Ok(Self { shader, signature })
    }

    fn colors<N: Number>(&self, ray_spheres: &[RaySphere]) -> Result<Vec<[f64; 3]>, RunError> {
        let cases: Vec<_> = ray_spheres.iter().copied().map(Case::Sphere).collect();
        let mut colors = self.shader.colors::<N>(&case_frame(&cases))?;
        colors.truncate(ray_spheres.len());
        Ok(colors)
    }

    fn miss_convention<N: Number>(&self) -> Result<MissConvention, RunError> {
        Ok(MissConvention::new(
            self.signature,
            &self.colors::<N>(&clear_misses())?,
        ))
    }

    fn outcomes<N: Number>(
        &self,
        ray_spheres: &[RaySphere],
        convention: &MissConvention,
    ) -> Result<Vec<Outcome>, RunError> {
        let colors = self.colors::<N>(ray_spheres)?.into_iter();
        Ok(colors.map(|color| convention.outcome(color)).collect())
    }
}
