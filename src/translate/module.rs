//! The front end for programs that use naga or wgpu: the text of a fragment shader becomes a module.

use std::fmt;

use naga::{Module, TypeInner};
use toyproof_diagnostic::{Diagnostic, Diagnostics, File, Files, human};
use toyproof_glsl::tree::VariableKind;
use toyproof_glsl::{Checked, UniformMode, check};

use crate::FloatMode;
use crate::lower::lower_module;
use crate::naga_ir::{ValidModule, parse};
use crate::print::UNIFORM_BINDING;

/// How [`glsl_to_module`] reads a shader.
#[derive(Debug, Clone)]
pub struct ModuleOptions {
    /// The name of the shader in messages.
    pub name: String,
    /// The language: its host, recognized by default, whether desktop GLSL's liberties are accepted in every
    /// version, values that replace uniforms, and a deadline. `uniform_mode` has no effect.
    pub language: toyproof_glsl::Options,
    /// Whether all uniforms but textures are members of the author's block, also those that have the name of
    /// an input of the host, such as `u_time`.
    pub own_uniforms: bool,
    /// Who computes `sin` and its like: the driver, by default, or the shader, in exact operations
    /// ([`FloatMode::Strict`]). That operations are not fused needs SPIR-V's `NoContraction`, which naga's
    /// modules do not have: see [`crate::backend::spirv::strict`].
    pub float: FloatMode,
    /// Whether naga validates the module, which is the default. wgpu does it again.
    pub validate: bool,
}

impl Default for ModuleOptions {
    fn default() -> Self {
        Self {
            name: "shader".to_owned(),
            language: toyproof_glsl::Options::default(),
            own_uniforms: false,
            float: FloatMode::Fast,
            validate: true,
        }
    }
}

impl ModuleOptions {
    /// The default options for a shader of this name.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }
}

/// The errors of a shader. They are displayed with the lines of its text, also by `Debug`, so that `unwrap`
/// and `main` show them.
#[derive(Clone)]
pub struct GlslError {
    diagnostics: Diagnostics,
    files: Files,
}

impl GlslError {
    /// At least one error, possibly among warnings, in the order of the text.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The text to which the spans of the diagnostics refer.
    pub fn files(&self) -> &Files {
        &self.files
    }
}

impl fmt::Display for GlslError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for diagnostic in &self.diagnostics {
            f.write_str(&human(diagnostic, &self.files, None, false))?;
        }
        Ok(())
    }
}

impl fmt::Debug for GlslError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for GlslError {}

/// Translates a fragment shader to a naga module, in place of naga's own GLSL front end: a shader of
/// ShaderToy, of WebGL 1 or 2, or of the desktop, as [`Dialect`](toyproof_glsl::Dialect) and
/// [`Version`](toyproof_glsl::Version) list them. They are recognized by the text.
///
/// ```
/// use toyproof_translate::{ModuleOptions, glsl_to_module};
///
/// let text = "precision mediump float;
///     uniform vec3 tint;
///     void main() { gl_FragColor = vec4(tint * fract(gl_FragCoord.x / 64.0), 0.5); }";
/// let module = glsl_to_module(text, &ModuleOptions::default()).unwrap();
/// assert_eq!(module.entry_points[0].name, "main");
///
/// let error = glsl_to_module(&text.replace("64.0", "pitch"), &ModuleOptions::default()).unwrap_err();
/// assert!(error.to_string().starts_with("error[E0200]: `pitch` is not declared\n  ┌─ shader:3:69\n"), "{error}");
/// ```
///
/// # Interface
///
/// The module has one entry point, the fragment shader `main`, whose color is at location 0. Its position is
/// that of the builtin `position`, and y is not flipped: what GLSL calls the bottom is row 0 of wgpu's
/// target. All bindings are in group 0. A module declares only those that it reads, which
/// [`Module::global_variables`] lists with their names; the members of a block have the author's names.
///
/// | binding | |
/// |---|---|
/// | 0 | a block of [`BLOCK_BYTES`](toyproof_glsl::tree::BLOCK_BYTES) bytes with ShaderToy's inputs at their [offsets](toyproof_glsl::tree::Input::offset) |
/// | 1 + 2K | the texture of channel K, from 0 to 3 |
/// | 2 + 2K | its sampler |
/// | 9 | a block with the author's uniforms, in the order of their declarations, by the rules of std140 |
///
/// **Inputs of the host.** ShaderToy's are not declared. Other shaders declare inputs that are recognized by
/// their names and types, such as `u_time`, and a `varying vec2` is the position from 0 to 1; both are
/// computed from the block at binding 0. With [`ModuleOptions::own_uniforms`], all uniforms but textures are
/// members of the block at binding 9 instead.
///
/// **The author's uniforms.** The block has all that are declared, read or not, so that its layout depends on
/// the declarations alone. A `bool` is a `uint` that is not 0, and the elements of an array are 16 bytes
/// apart, as std140 requires. A value in the text (`uniform float speed = 2.0;`) is ignored, since the block
/// always has one. A uniform with a value in [`uniforms`](toyproof_glsl::Options::uniforms) is a constant.
///
/// **Textures.** A `sampler2D` is the next free channel, or that of its number if its name has one, such as
/// `u_tex0`. Both variables have its name, the sampler's with the suffix `_sampler`.
///
/// **Alpha** is 1 for shaders with `mainImage`, as on ShaderToy, and the shader's own for those with `main`.
///
/// # Not supported
///
/// - Shaders of other stages, interface blocks, storage buffers, images and `double`.
/// - Inputs from a vertex shader, apart from the position; `gl_FragDepth` and further outputs have no effect.
/// - More than four textures; textures that are not two-dimensional, except ShaderToy's `iChannel0` to
///   `iChannel3`, whose shapes are inferred from use; uniforms that are structures, arrays of arrays, or
///   matrices with two rows.
/// - `#include`: [`toyproof_glsl::with_includes`] makes one text of several files, for [`checked_to_module`].
///
/// # Errors
/// The shader's, or that it reads what is not supported. If naga refuses the translated shader, the error
/// says so ([`Code::NagaParse`], [`Code::NagaValidation`]).
///
/// # Panics
/// For the [stage](toyproof_glsl::Stage::Common) without an entry point. If naga panics, which no shader of the
/// test suite causes: a program that runs shaders of strangers should use [`std::panic::catch_unwind`].
///
/// [`Code::NagaParse`]: toyproof_diagnostic::Code::NagaParse
/// [`Code::NagaValidation`]: toyproof_diagnostic::Code::NagaValidation
pub fn glsl_to_module(text: &str, options: &ModuleOptions) -> Result<Module, GlslError> {
    let mut files = Files::default();
    let file = files.add(File::new(&options.name, text));
    let language = toyproof_glsl::Options {
        uniform_mode: if options.own_uniforms {
            UniformMode::Own
        } else {
            UniformMode::Kept
        },
        ..options.language.clone()
    };
    check(&files, file, &language)
        .and_then(|checked| checked_to_module(&checked, options))
        .map_err(|diagnostics| GlslError { diagnostics, files })
}

/// Translates a checked shader to a naga module, like [`glsl_to_module`]. It should be checked with
/// [`UniformMode::Kept`] or [`UniformMode::Own`]; of the options of the language, only the deadline has an
/// effect.
///
/// # Errors
/// As for [`glsl_to_module`], apart from the shader's own; without positions when displayed.
pub fn checked_to_module(checked: &Checked, options: &ModuleOptions) -> Result<Module, Diagnostics> {
    let passes = options.float.passes_for_host();
    let (lowered, members) = lower_module(checked, passes, &options.language.deadline)?;
    let mut module = if options.validate {
        ValidModule::parse(&lowered)?.into_module()
    } else {
        parse(&lowered)?
    };
    name_bindings(&mut module, checked);
    name_members(&mut module, members);
    Ok(module)
}

/// Gives textures and samplers the author's names.
fn name_bindings(module: &mut Module, checked: &Checked) {
    for (_, variable) in checked.tree.variables.iter() {
        let VariableKind::Channel(channel) = variable.kind else {
            continue;
        };
        let texture = 1 + 2 * u32::from(channel);
        for (_, global) in module.global_variables.iter_mut() {
            match global.binding {
                Some(place) if place.binding == texture => global.name = Some(variable.name.clone()),
                Some(place) if place.binding == texture + 1 => {
                    global.name = Some(format!("{}_sampler", variable.name));
                }
                _ => {}
            }
        }
    }
}

/// Gives the members of the author's block the author's names, of which naga's front end does not accept all.
fn name_members(module: &mut Module, names: Vec<String>) {
    let mut globals = module.global_variables.iter();
    let block = globals.find(|(_, global)| {
        let binding = global.binding.map(|place| place.binding);
        binding == Some(UNIFORM_BINDING)
    });
    let Some((_, global)) = block else {
        return;
    };
    let mut ty = module.types[global.ty].clone();
    if let TypeInner::Struct { members, .. } = &mut ty.inner {
        for (member, name) in members.iter_mut().zip(names) {
            member.name = Some(name);
        }
    }
    if ty != module.types[global.ty] {
        module.types.replace(global.ty, ty);
    }
}

#[cfg(test)]
mod tests {
    use naga::back::wgsl;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;

    fn module(text: &str, options: &ModuleOptions) -> Module {
        glsl_to_module(text, options).unwrap()
    }

    /// The module as WGSL, in which bindings and members have their names.
    fn wgsl(module: &Module) -> String {
        let info = Validator::new(ValidationFlags::all(), Capabilities::default()).validate(module);
        wgsl::write_string(module, &info.unwrap(), wgsl::WriterFlags::empty()).unwrap()
    }

    /// The names, offsets and sizes of the members of the block at a binding, in bytes.
    fn members(module: &Module, binding: u32) -> Vec<(String, u32, u32)> {
        let layouter = {
            let mut layouter = naga::proc::Layouter::default();
            layouter.update(module.to_ctx()).unwrap();
            layouter
        };
        let mut globals = module.global_variables.iter();
        let block = globals.find(|(_, global)| global.binding.is_some_and(|place| place.binding == binding));
        let TypeInner::Struct { members, .. } = &module.types[block.unwrap().1.ty].inner else {
            panic!("binding {binding} is no block");
        };
        let members = members.iter().map(|member| {
            let size = layouter[member.ty].size;
            (member.name.clone().unwrap(), member.offset, size)
        });
        members.collect()
    }

    #[test]
    fn uniforms_are_members_of_a_block_in_the_order_of_declarations() {
        let text = "#version 330 core
            uniform float speed = 2.0;
            uniform vec2 unread;
            uniform bool on;
            uniform bvec3 sides;
            uniform float weights[5];
            uniform vec2 points[2];
            uniform bool flags[3];
            uniform vec3 sample;
            uniform mat3 turn;
            uniform float iTimeScale;
            out vec4 color;
            float sum(float all[5]) { return all[0] + all[4]; }
            void main() {
                int at = int(gl_FragCoord.x) % 2;
                color = vec4(turn * sample * speed, sum(weights) + weights[at] + iTimeScale);
                if (on && flags[at] && sides.y || any(sides)) { color.xy += points[at]; }
            }";
        let module = module(text, &ModuleOptions::default());
        let expected = [
            ("speed", 0, 4),
            ("unread", 8, 8),
            ("on", 16, 4),
            ("sides", 32, 12),
            ("weights", 48, 80),
            ("points", 128, 32),
            ("flags", 160, 48),
            ("sample", 208, 12),
            ("turn", 224, 48),
            ("iTimeScale", 272, 4),
        ];
        let expected = expected.map(|(name, offset, size)| (name.to_owned(), offset, size));
        assert_eq!(members(&module, UNIFORM_BINDING), expected);
        wgsl(&module);
    }

    #[test]
    fn inputs_are_recognized_by_name_or_the_authors_own() {
        let text = "uniform float u_time; uniform vec2 u_resolution; uniform vec3 tint; varying vec2 vUv;
            void main() { gl_FragColor = vec4(tint * u_time, vUv.x + u_resolution.y); }";
        let names = |module: &Module, binding| {
            let members = members(module, binding).into_iter();
            members.map(|(name, ..)| name).collect::<Vec<_>>()
        };
        let recognized = module(text, &ModuleOptions::default());
        assert_eq!(names(&recognized, UNIFORM_BINDING), ["tint"]);
        let options = ModuleOptions {
            own_uniforms: true,
            ..ModuleOptions::default()
        };
        let own = module(text, &options);
        assert_eq!(names(&own, UNIFORM_BINDING), ["u_time", "u_resolution", "tint"]);
        // The position from 0 to 1 needs the size of the image.
        assert_eq!(names(&own, 0)[0], "iResolution");
    }

    #[test]
    fn textures_have_their_names() {
        let text = "uniform sampler2D albedo, mask; varying vec2 uv;
            void main() { gl_FragColor = texture2D(albedo, uv) * texture2D(mask, uv).a; }";
        let module = module(text, &ModuleOptions::default());
        let bindings = module.global_variables.iter().filter_map(|(_, global)| {
            let name = global.name.clone()?;
            Some((name, global.binding?.binding))
        });
        let mut bindings: Vec<_> = bindings.filter(|(_, binding)| *binding > 0).collect();
        bindings.sort();
        let expected = [
            ("albedo", 1),
            ("albedo_sampler", 2),
            ("mask", 3),
            ("mask_sampler", 4),
        ];
        assert_eq!(
            bindings,
            expected.map(|(name, binding)| (name.to_owned(), binding))
        );
    }

    #[test]
    fn given_values_are_constants() {
        let text = "uniform float steps; uniform float speed;
            void main() { gl_FragColor = vec4(steps * speed); }";
        let mut options = ModuleOptions::default();
        options.language.uniforms = vec![toyproof_glsl::UniformValue {
            name: "steps".to_owned(),
            components: vec![8.0],
        }];
        let module = module(text, &options);
        assert_eq!(members(&module, UNIFORM_BINDING).len(), 1);
        assert!(wgsl(&module).contains("8f"), "{}", wgsl(&module));
    }

    #[test]
    fn alpha_is_the_shaders_unless_the_host_is_shadertoy() {
        let own = "void main() { gl_FragColor = vec4(0.25); }";
        let shadertoys = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.25); }";
        let colored = "toyproof_color = vec4<f32>(_";
        let is_opaque = |text| wgsl(&module(text, &ModuleOptions::default())).contains(colored);
        assert!(!is_opaque(own) && is_opaque(shadertoys));
    }

    #[test]
    fn what_a_module_cannot_have_is_an_error() {
        for (declared, read, expected) in [
            (
                "varying vec3 vNormal;",
                "vec4(vNormal, 1.0)",
                "`vNormal` has no value",
            ),
            (
                "uniform samplerCube sky;",
                "textureCube(sky, vec3(1.0))",
                "`sky` has no binding",
            ),
            (
                "struct S { float a; }; uniform S s;",
                "vec4(s.a)",
                "`s` cannot be a member",
            ),
            (
                "uniform mat2 turn;",
                "vec4(turn[0], turn[1])",
                "`turn` cannot be a member",
            ),
        ] {
            let text = format!("{declared}\nvoid main() {{ gl_FragColor = {read}; }}");
            let error = glsl_to_module(&text, &ModuleOptions::default()).unwrap_err();
            let shown = error.to_string();
            assert!(shown.starts_with(&format!("error[E0902]: {expected}")), "{shown}");
            assert!(shown.contains("─ shader:1:"), "{shown}");
        }
    }

    #[test]
    fn strict_modules_expand_functions_and_leave_filtering_to_samplers() {
        let text = "uniform sampler2D a;
            void main() { gl_FragColor = texture2D(a, vec2(sin(gl_FragCoord.x))); }";
        let options = ModuleOptions {
            float: FloatMode::Strict,
            validate: false,
            ..ModuleOptions::default()
        };
        let text = wgsl(&module(text, &options));
        assert!(
            text.contains("textureSample(") && !text.contains("sin(gl"),
            "{text}"
        );
    }
}
