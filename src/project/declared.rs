//! Declarations that hosts write outside of the language: the JSON header of ISF (Interactive Shader Format 2),
//! and `#iUniform` of the Shader Toy extension of editors. They become text in front of the shader, and values
//! of its uniforms.

use std::fmt::Write;

use toyproof_diagnostic::{Code, Diagnostic, Diagnostics, File, FileId, Files, Span};
use toyproof_glsl::{Dialect, Options, UniformValue};

use crate::json;
use crate::node::{Node, Value};

/// What a host declares in front of a shader.
#[derive(Debug, Default)]
struct Declarations {
    text: String,
    uniforms: Vec<UniformValue>,
}

/// Adds the text of a shader with what its host declares, and returns its id, or that of the file itself if
/// there is nothing to declare. In the options, the values of uniforms that have none become those of the
/// declarations.
///
/// # Errors
/// A header or an annotation is malformed, or needs more than one pass.
pub fn with_declarations(
    files: &mut Files,
    file: FileId,
    options: &mut Options,
) -> Result<FileId, Diagnostics> {
    let text = files.get(file).text();
    // A shader of ShaderToy may have taken the header along.
    let may_be_isf = match options.dialect {
        None => !text.contains("mainImage"),
        Some(dialect) => dialect == Dialect::Isf,
    };
    let declared = match header(text).filter(|_| may_be_isf) {
        Some(bytes) => {
            options.dialect = Some(Dialect::Isf);
            of_header(files, file, bytes)
        }
        None => of_annotations(files, file),
    };
    let Declarations { text, uniforms } = declared.map_err(|error| Diagnostics::new(vec![error], files))?;
    if text.is_empty() {
        return Ok(file);
    }
    options.add_uniforms(&uniforms);
    let name = files.get(file).name().to_owned();
    let declarations = files.add(File::new(format!("<declarations of {name}>"), text));
    Ok(files.join(name, &[declarations, file]))
}

// ISF: <https://docs.isf.video/ref_json.html>, <https://docs.isf.video/ref_functions.html>.

/// The inputs that ISF sets, by their names, with their declarations.
const ISF_INPUTS: [(&str, &str); 8] = [
    ("TIME", "uniform float TIME;"),
    ("TIMEDELTA", "uniform float TIMEDELTA;"),
    ("DATE", "uniform vec4 DATE;"),
    ("FRAMEINDEX", "uniform int FRAMEINDEX;"),
    ("PASSINDEX", "const int PASSINDEX = 0;"),
    ("RENDERSIZE", "uniform vec2 RENDERSIZE;"),
    ("isf_FragNormCoord", "in vec2 isf_FragNormCoord;"),
    ("vv_FragNormCoord", "in vec2 vv_FragNormCoord;"),
];

/// The functions of images, which are macros since an image is a sampler.
const ISF_FUNCTIONS: [(&str, &str); 5] = [
    ("IMG_SIZE", "(image) vec2(textureSize(image, 0))"),
    ("IMG_NORM_PIXEL", "(image, at) texture(image, at)"),
    (
        "IMG_PIXEL",
        "(image, at) texture(image, (at) / vec2(textureSize(image, 0)))",
    ),
    ("IMG_THIS_PIXEL", "(image) texture(image, isf_FragNormCoord)"),
    ("IMG_THIS_NORM_PIXEL", "(image) texture(image, isf_FragNormCoord)"),
];

/// The bytes of the header: the JSON in the comment at the beginning.
fn header(text: &str) -> Option<(u32, u32)> {
    let comment = text.trim_start().strip_prefix("/*")?;
    let start = text.len() - comment.len();
    let end = start + comment.find("*/")?;
    let json = text[start..end].trim_start();
    let is_header =
        json.starts_with('{') && ["\"ISFVSN\"", "\"INPUTS\""].iter().any(|key| json.contains(key));
    is_header.then_some((start as u32, end as u32))
}

fn of_header(files: &mut Files, file: FileId, (start, end): (u32, u32)) -> Result<Declarations, Diagnostic> {
    let name = files.get(file).name().to_owned();
    let json = files.join_parts(name, &[Span::new(file, start, end)], "");
    let root = json::parse_lenient(files, json).map_err(|error| *error)?;
    let body = &files.get(file).text()[end as usize..];
    let mut declared = Declarations::default();
    let passes = root.get("PASSES").and_then(Node::as_array).unwrap_or_default();
    if let Some(pass) = passes
        .iter()
        .find(|pass| passes.len() > 1 || pass.get("TARGET").is_some())
    {
        return Err(pass
            .error("several passes of ISF are not supported")
            .help("write it as a project with buffers, see `toyproof new --help`"));
    }
    for input in root.get("INPUTS").and_then(Node::as_array).unwrap_or_default() {
        declared.add_input(input)?;
    }
    // Images that come with the shader are bound like its inputs, after them.
    let imported = root.get("IMPORTED").map(|imported| &imported.value);
    let names: Vec<&str> = match imported {
        Some(Value::Object(images)) => images.iter().map(|image| &*image.key).collect(),
        Some(Value::Array(images)) => {
            let names = images.iter().filter_map(|image| image.get("NAME")?.as_str());
            names.collect()
        }
        _ => Vec::new(),
    };
    for name in names.into_iter().filter(|name| is_name(name)) {
        declared.uniform("sampler2D", name, None);
    }
    let uses = |name: &str| body.contains(name);
    let is_used = |(name, _): &&(&str, &str)| {
        // Functions at the current pixel read its coordinates.
        uses(name) || *name == "isf_FragNormCoord" && uses("IMG_THIS_")
    };
    for (_, declaration) in ISF_INPUTS.iter().filter(is_used) {
        declared.line(declaration);
    }
    for (function, definition) in ISF_FUNCTIONS.iter().filter(is_used) {
        declared.line(&format!("#define {function}{definition}"));
    }
    Ok(declared)
}

impl Declarations {
    fn line(&mut self, line: &str) {
        self.text += line;
        self.text.push('\n');
    }

    fn uniform(&mut self, ty: &str, name: &str, components: Option<Vec<f64>>) {
        let _ = writeln!(self.text, "uniform {ty} {name};");
        self.uniforms.extend(components.map(|components| UniformValue {
            name: name.to_owned(),
            components,
        }));
    }

    /// Declares an element of `INPUTS`.
    fn add_input(&mut self, input: &Node) -> Result<(), Diagnostic> {
        let text = |key| input.get(key).and_then(Node::as_str);
        let name = text("NAME").filter(|name| is_name(name));
        let name = name.ok_or_else(|| input.error("an input needs a `NAME` that is a name in GLSL"))?;
        let Some(ty) = text("TYPE") else {
            return Err(input.error("an input needs a `TYPE`"));
        };
        let ty = match ty {
            "float" => ("float", 1),
            "long" => ("int", 1),
            "bool" | "event" => ("bool", 1),
            "point2D" => ("vec2", 2),
            "color" => ("vec4", 4),
            "image" | "audio" | "audioFFT" => {
                self.uniform("sampler2D", name, None);
                return Ok(());
            }
            other => {
                let ty = input.get("TYPE").unwrap_or(input);
                return Err(ty.error(format!("unknown type of an input, `{other}`")));
            }
        };
        let (ty, size) = ty;
        // Hosts start at the default, else at the minimum.
        let first = |key| input.get(key).and_then(components);
        let given = first("DEFAULT").or_else(|| first("MIN"));
        let mut value = given.unwrap_or_else(|| vec![0.0; size]);
        // A color without its opacity is opaque.
        if size == 4 && value.len() == 3 {
            value.push(1.0);
        }
        if ty == "int" {
            for component in &mut value {
                *component = component.trunc();
            }
        }
        self.uniform(ty, name, Some(value));
        Ok(())
    }
}

/// The components of a number, a list of numbers, or a truth value.
pub(crate) fn components(node: &Node) -> Option<Vec<f64>> {
    match &node.value {
        Value::Number(number) => Some(vec![number.parse().ok()?]),
        Value::Bool(value) => Some(vec![f64::from(*value)]),
        Value::Array(nodes) => nodes
            .iter()
            .map(|node| match &node.value {
                Value::Number(number) => number.parse().ok(),
                _ => None,
            })
            .collect(),
        _ => None,
    }
}

fn is_name(text: &str) -> bool {
    let mut characters = text.chars();
    characters
        .next()
        .is_some_and(|first| first.is_ascii_alphabetic() || first == '_')
        && characters.all(|character| character.is_ascii_alphanumeric() || character == '_')
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
    use super::*;

    /// The declarations of a text and the values of its uniforms, or the error.
    fn declared(text: &str) -> Result<(String, Vec<String>), String> {
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        let mut options = Options::default();
        let joined =
            with_declarations(&mut files, file, &mut options).map_err(|errors| errors.to_string())?;
        let joined = files.get(joined).text();
        let declarations = joined.strip_suffix(text).unwrap().to_owned();
        let values = options
            .uniforms
            .iter()
            .map(|uniform| format!("{}={:?}", uniform.name, uniform.components));
        Ok((declarations, values.collect()))
    }

    #[test]
    fn isf() {
        let text = r#"/*{ "ISFVSN": "2", "INPUTS": [
            { "NAME": "inputImage", "TYPE": "image" },
            { "NAME": "level", "TYPE": "float", "DEFAULT": 0.5, "MIN": 0, "MAX": 1 },
            { "NAME": "tint", "TYPE": "color", "DEFAULT": [1, 0.5, 0] },
            { "NAME": "mode", "TYPE": "long", "VALUES": [0, 1], "MIN": 2 }
        ] }*/
        void main() { gl_FragColor = IMG_THIS_NORM_PIXEL(inputImage) * level + tint * float(mode) * TIME; }"#;
        let (declarations, values) = declared(text).unwrap();
        assert_eq!(
            declarations.lines().collect::<Vec<_>>(),
            [
                "uniform sampler2D inputImage;",
                "uniform float level;",
                "uniform vec4 tint;",
                "uniform int mode;",
                "uniform float TIME;",
                "in vec2 isf_FragNormCoord;",
                "#define IMG_THIS_NORM_PIXEL(image) texture(image, isf_FragNormCoord)",
                "",
            ]
        );
        assert_eq!(values, ["level=[0.5]", "tint=[1.0, 0.5, 0.0, 1.0]", "mode=[2.0]"]);
        let error = declared("/*{ \"ISFVSN\": 2,\n \"PASSES\": [{ \"TARGET\": \"b\" }] }*/").unwrap_err();
        assert!(error.starts_with("a:2:13: error"), "{error}");
        // The last of several values counts, images may come with the shader, and a shader of ShaderToy is none.
        let text = "/*{ \"ISFVSN\": 1, \"ISFVSN\": 2, \"IMPORTED\": { \"mask\": { \"PATH\": \"m.png\" } } }*/ void main() {}";
        assert_eq!(declared(text).unwrap().0, "uniform sampler2D mask;\n\n");
        assert_eq!(declared(&text.replace("main", "mainImage")).unwrap().0, "");
        let error = declared("/*{ \"INPUTS\": [{ \"NAME\": \"a\", \"TYPE\": \"cube\" }] }*/").unwrap_err();
        assert!(error.contains("unknown type of an input, `cube`"), "{error}");
        assert_eq!(
            declared("/* { a comment } */ void main() {}").unwrap(),
            (String::new(), vec![])
        );
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
