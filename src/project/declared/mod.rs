//! Declarations that hosts write outside of the language: the JSON header of ISF, and `#iUniform` of the
//! Shader Toy extension of editors. They become text in front of the shader, and values of its uniforms.

mod declarations;
mod isf;
mod isf_passes;
mod pass_index;
mod size;

use toyproof_diagnostic::{Code, Diagnostic, Diagnostics, FileId, Files, Span};
use toyproof_glsl::{Dialect, Options};

pub use self::declarations::Declared;
pub(crate) use self::declarations::components;
use self::declarations::{Declarations, in_front_of, is_name};

/// Adds the text of a shader with what its host declares, and returns it; the file itself if there is
/// nothing to declare. In the options, the values of uniforms that have none become those of the
/// declarations.
///
/// # Errors
/// A header or an annotation is malformed, or a header has passes that cannot be rendered.
pub fn with_declarations(
    files: &mut Files,
    file: FileId,
    options: &mut Options,
) -> Result<Declared, Diagnostics> {
    let text = files.get(file).text();
    // A shader of ShaderToy may have taken the header along; one of ISF may have kept its `mainImage`, which
    // its `main` calls.
    let may_be_isf = match options.dialect {
        None => !text.contains("mainImage") || text.contains("void main("),
        Some(dialect) => dialect == Dialect::Isf,
    };
    let declared = match isf::header(text).filter(|_| may_be_isf) {
        Some(bytes) => isf::read(files, file, bytes, options),
        None => of_annotations(files, file).map(|declared| {
            options.add_uniforms(&declared.uniforms);
            Declared::Shader(in_front_of(files, file, declared.text))
        }),
    };
    declared.map_err(|error| Diagnostics::new(vec![error], files))
}

// The Shader Toy extension: <https://github.com/stevensona/shader-toy>.

/// The name of the directive.
const ANNOTATION: &str = "#iUniform";

/// Reads lines such as `#iUniform float speed = 1.0 in { 0.0, 5.0 }` and
/// `#iUniform color3 tint = color3(1.0, 0.5, 0.0)`.
fn of_annotations(files: &Files, file: FileId) -> Result<Declarations, Diagnostic> {
    let text = files.get(file).text();
    let mut declared = Declarations::default();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let indent = line.len() - line.trim_start().len();
        if let Some(annotation) = line.trim().strip_prefix(ANNOTATION) {
            let at = start + indent;
            let span = Span::new(file, at as u32, (at + line.trim().len()) as u32);
            annotate(annotation, &mut declared).ok_or_else(|| {
                let error = Diagnostic::new(Code::MalformedDirective, "malformed `#iUniform`").at(span);
                error.help("write `#iUniform float NAME = 1.0 in { 0.0, 5.0 }`")
            })?;
        }
        start += line.len();
    }
    Ok(declared)
}

/// Reads what follows `#iUniform`.
fn annotate(text: &str, declared: &mut Declarations) -> Option<()> {
    let (ty, rest) = text.trim_start().split_once(char::is_whitespace)?;
    // The comment and the range that an editor shows a slider for.
    let rest = rest.split("//").next().unwrap_or_default();
    let (declaration, value) = match rest.split_once('=') {
        Some((name, value)) => (name, Some(value)),
        None => (rest, None),
    };
    let name = declaration.split_whitespace().next()?;
    let (ty, size) = match ty {
        "float" => ("float", 1),
        "int" => ("int", 1),
        "bool" => ("bool", 1),
        "vec2" => ("vec2", 2),
        "vec3" | "color3" => ("vec3", 3),
        "vec4" | "color4" => ("vec4", 4),
        _ => return None,
    };
    if !is_name(name) {
        return None;
    }
    let value = match value {
        Some(value) => numbers(value.split(" in ").next().unwrap_or_default())?,
        None => vec![0.0],
    };
    // One number is that of all components.
    let value = if value.len() == 1 {
        vec![value[0]; size]
    } else {
        value
    };
    if value.len() != size {
        return None;
    }
    declared.uniform(ty, name, Some(value));
    Some(())
}

/// The numbers in `1.0`, `true` or `vec3(1.0, 0.5, 0.0)`.
fn numbers(text: &str) -> Option<Vec<f64>> {
    let text = text.trim();
    let inside = match text.split_once('(') {
        Some((_, arguments)) => arguments.strip_suffix(')')?,
        None => text,
    };
    let number = |text: &str| match text.trim() {
        "true" => Some(1.0),
        "false" => Some(0.0),
        text => text.trim_end_matches(['f', 'F']).parse().ok(),
    };
    inside.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::File;

    use super::*;

    /// The declarations of a text and the values of its uniforms, or the error.
    pub(super) fn declared(text: &str) -> Result<(String, Vec<String>), String> {
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        let mut options = Options::default();
        let joined = with_declarations(&mut files, file, &mut options);
        let Declared::Shader(joined) = joined.map_err(|errors| errors.to_string())? else {
            panic!("it has one pass");
        };
        let joined = files.get(joined).text();
        let declarations = joined.strip_suffix(text).unwrap().to_owned();
        let values = options
            .uniforms
            .iter()
            .map(|uniform| format!("{}={:?}", uniform.name, uniform.components));
        Ok((declarations, values.collect()))
    }

    #[test]
    fn annotations() {
        let text = "#iUniform float speed = 1.5 in { 0.0, 5.0 } // a slider\n\
                    #iUniform color3 tint = color3(1.0, 0.5, 0.0)\n#iUniform vec2 at = 0.5\n";
        let (declarations, values) = declared(text).unwrap();
        assert_eq!(
            declarations,
            "uniform float speed;\nuniform vec3 tint;\nuniform vec2 at;\n\n"
        );
        assert_eq!(values, ["speed=[1.5]", "tint=[1.0, 0.5, 0.0]", "at=[0.5, 0.5]"]);
        let error = declared("\n  #iUniform mat4 m\n").unwrap_err();
        assert!(error.starts_with("a:2:3: error"), "{error}");
    }
}
