//! naga's modules, parsed from lowered GLSL or from WGSL, and validated.

use naga::front::glsl::{Frontend, Options};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ShaderStage};
use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Code, Diagnostic, Diagnostics};

use crate::{Lowered, TranslateError};

/// The shape of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shape {
    /// Two-dimensional.
    D2,
    /// Three-dimensional.
    D3,
    /// A cube map.
    Cube,
    /// An array of images: in strict shaders, the faces of a cube map.
    Layers,
}

/// A module that naga has validated, as all later stages require.
#[derive(Debug, Clone)]
pub struct ValidModule {
    module: Module,
    info: ModuleInfo,
    fetches: Fetches,
}

/// The result of fetching a texel beyond its texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fetches {
    /// Does not occur: the shader checks the coordinates, or fetches nothing.
    Checked,
    /// Zeros, as in browsers.
    Zeros,
    /// The texel at the edge, as in wgpu: WGSL allows any texel.
    Edge,
}

/// The number of levels of a texture whose sides are 2³⁰ texels: no texture has more.
const MOST_LEVELS: u32 = 31;

impl ValidModule {
    /// naga's module.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// naga's module without the validator's results.
    pub fn into_module(self) -> Module {
        self.module
    }

    /// The results of naga's validator.
    pub fn info(&self) -> &ModuleInfo {
        &self.info
    }

    /// The result of fetching a texel beyond its texture.
    pub(crate) fn fetches(&self) -> Fetches {
        self.fetches
    }

    /// The module with the largest number of levels in place of those of its textures, for readers whose language
    /// does not have that number, and that check the levels of lookups themselves.
    pub(crate) fn with_most_levels(&self) -> Self {
        let mut module = self.module.clone();
        let functions = module.functions.iter_mut().map(|(_, function)| function);
        let entry_points = module.entry_points.iter_mut().map(|entry| &mut entry.function);
        for function in functions.chain(entry_points) {
            for (_, expr) in function.expressions.iter_mut() {
                if let naga::Expression::ImageQuery {
                    query: naga::ImageQuery::NumLevels,
                    ..
                } = expr
                {
                    *expr = naga::Expression::Literal(naga::Literal::U32(MOST_LEVELS));
                }
            }
        }
        Self {
            module,
            info: self.info.clone(),
            fetches: self.fetches,
        }
    }

    /// Parses and validates a lowered shader and removes unused items.
    ///
    /// # Errors
    /// naga's message, at the author's source lines.
    pub fn parse(lowered: &Lowered) -> Result<Self, Diagnostics> {
        let module = parse(lowered)?;
        // naga's Metal writer adds declarations to modules with a policy of zeros, whether or not they fetch
        // texels.
        let fetches = if lowered.checks_fetches() || !has_fetches(&module) {
            Fetches::Checked
        } else {
            Fetches::Zeros
        };
        let validated = Self::validate(module).map(|valid| Self { fetches, ..valid });
        validated.map_err(|error| {
            // The first place that is the author's: others are in generated code.
            let mut spans = error.spans().map(|(span, _)| *span);
            let is_authors = |span: &naga::Span| {
                span.to_range()
                    .is_some_and(|range| lowered.origin(range).is_some())
            };
            let span = spans.find(is_authors).unwrap_or(naga::Span::UNDEFINED);
            vec![naga_diagnostic(
                Code::NagaValidation,
                &chain(error.as_inner()),
                span,
                lowered,
            )]
            .into()
        })
    }

    /// Parses and validates a WGSL shader.
    ///
    /// # Errors
    /// naga's message, with the line.
    pub fn of_wgsl(text: &str) -> Result<Self, TranslateError> {
        let module = naga::front::wgsl::parse_str(text).map_err(|error| {
            let line = error.location(text).map_or(0, |location| location.line_number);
            TranslateError(format!("line {line}: {error}"))
        })?;
        Self::new(module)
    }

    /// Parses and validates a SPIR-V module.
    ///
    /// # Errors
    /// naga's message.
    #[cfg(feature = "backend")]
    pub fn of_spirv(words: &[u32]) -> Result<Self, TranslateError> {
        let options = naga::front::spv::Options {
            adjust_coordinate_space: false,
            ..naga::front::spv::Options::default()
        };
        let parsed = naga::front::spv::Frontend::new(words.iter().copied(), &options).parse();
        Self::new(parsed.map_err(TranslateError::new)?)
    }

    /// Validates a module.
    ///
    /// # Errors
    /// naga's message, if it refuses the module.
    pub fn new(module: Module) -> Result<Self, TranslateError> {
        Self::validate(module).map_err(|error| TranslateError(chain(error.as_inner())))
    }

    fn validate(module: Module) -> Result<Self, naga::WithSpan<naga::valid::ValidationError>> {
        let info = Validator::new(
            ValidationFlags::all(),
            Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32,
        )
        .validate(&module)?;
        Ok(Self {
            module,
            info,
            fetches: Fetches::Edge,
        })
    }

    /// The texture shapes of channels 0 to 3; unused channels have any shape.
    pub fn channels(&self) -> [Shape; 4] {
        let mut shapes = [Shape::D2; 4];
        for (_, global) in self.module.global_variables.iter() {
            if let (naga::TypeInner::Image { dim, arrayed, .. }, Some(binding)) =
                (&self.module.types[global.ty].inner, global.binding)
                && let Some(shape) = shapes.get_mut((binding.binding as usize).saturating_sub(1) / 2)
            {
                *shape = match dim {
                    naga::ImageDimension::Cube => Shape::Cube,
                    naga::ImageDimension::D2 if *arrayed => Shape::Layers,
                    naga::ImageDimension::D3 => Shape::D3,
                    _ => Shape::D2,
                };
            }
        }
        shapes
    }
}

/// Parses a lowered shader and removes unused items, without validating the module.
///
/// # Errors
/// naga's message, at the author's source lines.
pub(crate) fn parse(lowered: &Lowered) -> Result<Module, Vec<Diagnostic>> {
    let parsed = Frontend::default().parse(&Options::from(ShaderStage::Fragment), lowered.text());
    let mut module = parsed.map_err(|errors| {
        let errors = errors.errors.iter();
        errors
            .map(|error| naga_diagnostic(Code::NagaParse, &error.kind.to_string(), error.meta, lowered))
            .collect::<Vec<_>>()
    })?;
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    Ok(module)
}

/// All functions of a module, and its entry points.
pub fn functions(module: &Module) -> impl Iterator<Item = &naga::Function> {
    let entry_points = module.entry_points.iter().map(|entry| &entry.function);
    let functions = module.functions.iter().map(|(_, function)| function);
    functions.chain(entry_points)
}

fn has_fetches(module: &Module) -> bool {
    let mut expressions = functions(module).flat_map(|function| function.expressions.iter());
    expressions.any(|(_, expression)| matches!(expression, naga::Expression::ImageLoad { .. }))
}

fn naga_diagnostic(code: Code, message: &str, span: naga::Span, lowered: &Lowered) -> Diagnostic {
    let diagnostic = Diagnostic::new(code, format!("naga cannot translate this: {message}"));
    match span.to_range().and_then(|range| lowered.origin(range)) {
        Some(span) => diagnostic.at(span),
        None => diagnostic.note("the place is in code that toyproof generates, or naga does not name it"),
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
}
