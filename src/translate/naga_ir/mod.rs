//! naga's modules, parsed from lowered GLSL or from WGSL, and validated.

pub(crate) mod expand;
mod loops;

pub use loops::Probe;
use naga::front::glsl::{Frontend, Options};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ShaderStage};
use serde::{Deserialize, Serialize};
use toyproof_diagnostic::Diagnostic;

use crate::Lowered;

/// The shape of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shape {
    /// Two-dimensional.
    D2,
    /// Three-dimensional.
    D3,
    /// A cube map.
    Cube,
}

/// A module that naga has validated, as all later stages require.
#[derive(Debug, Clone)]
pub struct ValidModule {
    module: Module,
    info: ModuleInfo,
}

impl ValidModule {
    /// naga's module.
    #[must_use]
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// The results of naga's validator.
    #[must_use]
    pub fn info(&self) -> &ModuleInfo {
        &self.info
    }

    /// Parses and validates a lowered shader and removes unused items.
    ///
    /// # Errors
    /// naga's message, at the author's source lines.
    pub fn parse(lowered: &Lowered) -> Result<Self, Vec<Diagnostic>> {
        let mut module = Frontend::default()
            .parse(&Options::from(ShaderStage::Fragment), lowered.text())
            .map_err(|errors| {
                errors
                    .errors
                    .iter()
                    .map(|error| naga_diagnostic("E0900", &error.kind.to_string(), error.meta, lowered))
                    .collect::<Vec<_>>()
            })?;
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        Self::validate(module).map_err(|error| {
            let span = error
                .spans()
                .next()
                .map_or(naga::Span::UNDEFINED, |(span, _)| *span);
            vec![naga_diagnostic("E0901", &chain(error.as_inner()), span, lowered)]
        })
    }

    /// Parses and validates a WGSL shader.
    ///
    /// # Errors
    /// naga's message, with the line.
    pub fn of_wgsl(text: &str) -> Result<Self, String> {
        let module = naga::front::wgsl::parse_str(text).map_err(|error| {
            let line = error.location(text).map_or(0, |location| location.line_number);
            format!("line {line}: {error}")
        })?;
        Self::validate(module).map_err(|error| chain(error.as_inner()))
    }

    fn validate(module: Module) -> Result<Self, naga::WithSpan<naga::valid::ValidationError>> {
        let info = Validator::new(
            ValidationFlags::all(),
            Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32,
        )
        .validate(&module)?;
        Ok(Self { module, info })
    }

    /// The texture shapes of channels 0 to 3; unused channels have any shape.
    #[must_use]
    pub fn channels(&self) -> [Shape; 4] {
        let mut shapes = [Shape::D2; 4];
        for (_, global) in self.module.global_variables.iter() {
            if let (naga::TypeInner::Image { dim, .. }, Some(binding)) =
                (&self.module.types[global.ty].inner, global.binding)
                && let Some(shape) = shapes.get_mut((binding.binding as usize).saturating_sub(1) / 2)
            {
                *shape = match dim {
                    naga::ImageDimension::Cube => Shape::Cube,
                    naga::ImageDimension::D3 => Shape::D3,
                    _ => Shape::D2,
                };
            }
        }
        shapes
    }

    /// Whether any function contains a loop.
    #[must_use]
    pub fn has_loops(&self) -> bool {
        loops::has_loop(&self.module)
    }

    /// Whether any function contains a loop without an exit.
    #[must_use]
    pub fn has_endless_loop(&self) -> bool {
        loops::has_infinite_loop(&self.module)
    }

    /// Whether `discard` may skip a pixel.
    #[must_use]
    pub fn discards(&self) -> bool {
        (0..self.module.entry_points.len()).any(|entry| self.info.get_entry_point(entry).may_kill)
    }

    /// Returns the same shader with a probe of its loops in alpha.
    ///
    /// # Errors
    /// naga's message, if it refuses the result.
    pub fn probed(&self, probe: Probe) -> Result<Self, String> {
        let mut module = self.module.clone();
        loops::probe(&mut module, probe);
        Self::validate(module).map_err(|error| chain(error.as_inner()))
    }
}

fn naga_diagnostic(code: &'static str, message: &str, span: naga::Span, lowered: &Lowered) -> Diagnostic {
    let diagnostic = Diagnostic::error(code, format!("naga cannot translate this: {message}"));
    match span.to_range().and_then(|range| lowered.origin(range)) {
        Some(span) => diagnostic.at(span),
        None => diagnostic,
    }
}

/// Joins an error and all of its causes, outermost first.
fn chain(error: &dyn std::error::Error) -> String {
    let mut message = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        message = format!("{message}: {cause}");
        source = cause.source();
    }
    message
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files, short};
    use toyproof_glsl::{Options as Language, check};

    use super::*;
    use crate::lower;

    fn parse(text: &str) -> Result<ValidModule, Vec<String>> {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let lowered = lower(&check(&files, file, &Language::default()).unwrap());
        ValidModule::parse(&lowered)
            .map_err(|diagnostics| diagnostics.iter().map(|d| short(d, &files)).collect())
    }

    #[test]
    fn unused_inputs_are_removed() {
        let module = parse("void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel1, p); }").unwrap();
        let bindings: Vec<_> = module
            .module()
            .global_variables
            .iter()
            .filter_map(|(_, global)| Some(global.binding.as_ref()?.binding))
            .collect();
        assert_eq!(bindings, [3, 4]);
    }

    #[test]
    fn channels_have_the_shapes_of_their_lookups() {
        let text = "void mainImage(out vec4 c, in vec2 p) {
            c = texture(iChannel0, vec3(1.0)) + texture(iChannel3, p);
        }";
        assert_eq!(
            parse(text).unwrap().channels(),
            [Shape::Cube, Shape::D2, Shape::D2, Shape::D2]
        );
    }

    #[test]
    fn probes_are_valid_and_count_every_entry_and_exit() {
        let module = parse(
            "float f(float x) { for (int i = 0; i < 9; i++) { if (x > 4.0) return x; if (x > 3.0) break; x += 1.0; } return 0.0; }\n\
             void mainImage(out vec4 c, in vec2 p) {\n\
               float x = 0.0; do { x += f(x); } while (x < 3.0);\n\
               switch (int(x)) { case 0: x = 1.0; break; default: x = 2.0; break; }\n\
               c = vec4(x);\n\
             }",
        )
        .unwrap();
        let text = |probe| {
            let probed = module.probed(probe).unwrap();
            let flags = naga::back::wgsl::WriterFlags::empty();
            naga::back::wgsl::write_string(probed.module(), probed.info(), flags).unwrap()
        };
        let open = text(Probe::OpenLoops);
        // Two loops are entered; one is left by its condition, a return and a break, the other by its
        // condition.
        assert_eq!(open.matches("+ 1u").count(), 2, "{open}");
        assert_eq!(open.matches("- 1u").count(), 4, "{open}");
        assert!(open.contains("select(0f, 1f,"), "{open}");
        let iterations = text(Probe::Iterations);
        assert_eq!(iterations.matches("+ 1u").count(), 2, "{iterations}");
        assert!(iterations.contains("f32("), "{iterations}");
    }

    #[test]
    fn loops_are_found_at_any_depth() {
        let with = "float f() { float x = 0.0; if (true) { while (x < 3.0) x += 1.0; } return x; }\n\
                    void mainImage(out vec4 c, in vec2 p) { c = vec4(f()); }";
        assert!(parse(with).unwrap().has_loops() && !parse(with).unwrap().has_endless_loop());
        let endless = with
            .replace("x < 3.0", "true")
            .replace("while (true) x += 1.0;", "for (;;) x += 1.0;");
        assert!(parse(&endless).unwrap().has_endless_loop());
        let without = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0.0, 1.0); }";
        assert!(!parse(without).unwrap().has_loops());
    }
}
