//! ISF (Interactive Shader Format 2): a JSON header declares the inputs of a shader and its passes, all of
//! which run the same text. <https://docs.isf.video/ref_json.html>,
//! <https://docs.isf.video/ref_functions.html>

use std::fmt::Write;

use toyproof_diagnostic::{Diagnostic, File, FileId, Files, Span};
use toyproof_glsl::{Dialect, Filter, Options, Wrap};
use toyproof_player::{BufferFormat, BufferSize};

use super::declarations::{Declarations, Declared, components, in_front_of, is_name};
use super::isf_passes::{IsfPass, Sizes, passes, set_channels};
use super::pass_index::Tokens;
use crate::format::{Format, Wrapper};
use crate::json;
use crate::node::{Node, Value};
use crate::pass::{Buffer, Input, Pass, PassKind, Sampler, Source, Tab};
use crate::project::{Document, Project};
use crate::textures::LoadedMedia;

/// The inputs that ISF sets, by their names, with their declarations.
const ISF_INPUTS: [(&str, &str); 7] = [
    ("TIME", "uniform float TIME;"),
    ("TIMEDELTA", "uniform float TIMEDELTA;"),
    ("DATE", "uniform vec4 DATE;"),
    ("FRAMEINDEX", "uniform int FRAMEINDEX;"),
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
pub(super) fn header(text: &str) -> Option<(u32, u32)> {
    let comment = text.trim_start().strip_prefix("/*")?;
    let start = text.len() - comment.len();
    let end = start + comment.find("*/")?;
    let json = text[start..end].trim_start();
    let is_header =
        json.starts_with('{') && ["\"ISFVSN\"", "\"INPUTS\""].iter().any(|key| json.contains(key));
    is_header.then_some((start as u32, end as u32))
}

/// Reads a shader with the header in these bytes, and adds its texts.
///
/// # Errors
/// The header is malformed, or has passes that cannot be rendered.
pub(super) fn read(
    files: &mut Files,
    file: FileId,
    (start, end): (u32, u32),
    options: &mut Options,
) -> Result<Declared, Diagnostic> {
    options.dialect = Some(Dialect::Isf);
    let name = files.get(file).name().to_owned();
    let json = files.join_parts(name, &[Span::new(file, start, end)], "");
    let root = json::parse_lenient(files, json).map_err(|error| *error)?;
    let body = files.get(file).text()[end as usize..].to_owned();
    let mut declared = Declarations::default();
    let mut images = Vec::new();
    for input in root.get("INPUTS").and_then(Node::as_array).unwrap_or_default() {
        images.extend(add_input(&mut declared, input)?);
    }
    // Images that come with the shader are bound like its inputs, after them.
    match root.get("IMPORTED").map(|imported| &imported.value) {
        Some(Value::Object(imported)) => images.extend(imported.iter().map(|image| image.key.clone())),
        Some(Value::Array(imported)) => {
            let names = imported.iter().filter_map(|image| image.get("NAME")?.as_str());
            images.extend(names.map(str::to_owned));
        }
        _ => {}
    }
    images.retain(|image| is_name(image));
    options.add_uniforms(&declared.uniforms);
    let sizes = Sizes {
        files,
        declared: &declared,
        options,
    };
    let mut passes = passes(&root, &sizes)?;
    let targets: Vec<String> = passes.iter().filter_map(|pass| pass.target.clone()).collect();
    // Channels are those of the images and buffers that the text names, in this order.
    let tokens = Tokens::new(&body);
    let (names, members) = (tokens.names(), tokens.members());
    images.retain(|image| passes.is_empty() || names.contains(image.as_str()));
    let mut read = targets.clone();
    read.retain(|target| names.contains(target.as_str()));
    set_channels(&mut passes, &root, &tokens, (&images, &read))?;
    let is_replaced = |name: &&String| passes.iter().any(|pass| !pass.channels.contains(name));
    let mut replaced = images.iter().chain(&read).filter(is_replaced);
    if let Some(name) = replaced.find(|name| members.contains(name.as_str())) {
        let error = root.error(format!(
            "`{name}` is also the name of a member, and not every pass has a channel for it"
        ));
        return Err(error.help("rename the buffer or the image"));
    }
    let values = std::mem::take(&mut declared.text);
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
    let mut text = |declared: &Declarations, channels: &[String], index: usize| {
        let mut text = values.clone();
        for channel in channels {
            let _ = writeln!(text, "uniform sampler2D {channel};");
        }
        // A texture without a channel is only named in branches that the pass does not take.
        for name in images.iter().chain(&read).filter(|name| !channels.contains(name)) {
            let _ = writeln!(text, "#define {name} {}", channels[0]);
        }
        text += &declared.text;
        if uses("PASSINDEX") {
            let _ = writeln!(text, "const int PASSINDEX = {index};");
        }
        in_front_of(files, file, text)
    };
    if passes.is_empty() {
        return Ok(Declared::Shader(text(&declared, &images, 0)));
    }
    let mut project_passes = Vec::new();
    for (index, pass) in passes.iter().enumerate() {
        project_passes.push(Pass {
            kind: pass
                .target
                .as_ref()
                .map_or(PassKind::Image, |target| kind(target, &targets)),
            file: text(&declared, &pass.channels, index),
            inputs: [0, 1, 2, 3].map(|channel: usize| buffer_input(pass.channels.get(channel)?, &targets)),
            format: pass.format.clone(),
        });
    }
    if let Some(last) = passes.last() {
        project_passes.extend(shown_buffer(last, &targets, files));
    }
    let tabs = project_passes
        .iter()
        .map(|pass| (Tab::Pass(pass.kind), pass.file));
    Ok(Declared::Project(Box::new(Project {
        common: None,
        document: Document {
            tabs: tabs.collect(),
            root,
            format: Format::Page,
            wrapper: Wrapper::None,
        },
        passes: project_passes,
        knows_inputs: true,
        uniforms: Vec::new(),
        media: LoadedMedia::default(),
    })))
}

/// The pass that shows a buffer that is rendered last, enlarged if it has another size; `None` if the last
/// pass renders the image.
fn shown_buffer(last: &IsfPass, targets: &[String], files: &mut Files) -> Option<Pass> {
    let target = last.target.as_ref()?;
    let texel = match last.format.size {
        BufferSize::Image => format!("texelFetch({target}, ivec2(gl_FragCoord.xy), 0)"),
        BufferSize::Computed(_) => format!("texture({target}, isf_FragNormCoord)"),
    };
    let shown = format!(
        "uniform sampler2D {target};\nin vec2 isf_FragNormCoord;\nvoid main() {{\n    gl_FragColor = {texel};\n}}\n"
    );
    Some(Pass {
        kind: PassKind::Image,
        file: files.add(File::new(format!("<{target}>"), shown)),
        inputs: [buffer_input(target, targets), None, None, None],
        format: BufferFormat::default(),
    })
}

fn kind(target: &str, targets: &[String]) -> PassKind {
    buffer(target, targets).map_or(PassKind::Image, PassKind::Buffer)
}

/// The buffer of this name; `None` for an image.
fn buffer(name: &str, targets: &[String]) -> Option<Buffer> {
    Buffer::nth(targets.iter().position(|target| target == name)?)
}

/// The input that reads a buffer; `None` for an image.
fn buffer_input(name: &str, targets: &[String]) -> Option<Input> {
    Some(Input {
        source: Source::Buffer(buffer(name, targets)?),
        sampler: Sampler {
            filter: Filter::Linear,
            wrap: Wrap::Clamp,
            vflip: false,
            srgb: false,
        },
        span: None,
    })
}

/// Declares an element of `INPUTS`; returns the name of an image instead, whose place is behind them.
fn add_input(declared: &mut Declarations, input: &Node) -> Result<Option<String>, Diagnostic> {
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
            return Ok(Some(name.to_owned()));
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
    declared.uniform(ty, name, Some(value));
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::declared::tests::declared;
    use crate::declared::with_declarations;

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
                "uniform float level;",
                "uniform vec4 tint;",
                "uniform int mode;",
                "uniform sampler2D inputImage;",
                "uniform float TIME;",
                "in vec2 isf_FragNormCoord;",
                "#define IMG_THIS_NORM_PIXEL(image) texture(image, isf_FragNormCoord)",
                "",
            ]
        );
        assert_eq!(values, ["level=[0.5]", "tint=[1.0, 0.5, 0.0, 1.0]", "mode=[2.0]"]);
        // The last of several values counts, images may come with the shader, and a shader of ShaderToy is
        // none.
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

    fn project(passes: &str) -> Result<(Project, Files), String> {
        let mut files = Files::default();
        let header = format!(
            "/*{{ \"ISFVSN\": 2,\n \"INPUTS\": [{{ \"NAME\": \"i\", \"TYPE\": \"image\" }}],\n \"PASSES\": {passes} }}*/"
        );
        let body = "void main() { gl_FragColor = IMG_THIS_PIXEL(b) * float(PASSINDEX) + IMG_THIS_PIXEL(i); }";
        let file = files.add(File::new("a", header + body));
        match with_declarations(&mut files, file, &mut Options::default()) {
            Ok(Declared::Project(project)) => Ok((*project, files)),
            Ok(Declared::Shader(_)) => panic!("it has several passes"),
            Err(errors) => Err(errors.to_string()),
        }
    }

    #[test]
    fn passes_are_those_of_a_project() {
        let (project, files) = project("[{ \"TARGET\": \"b\", \"PERSISTENT\": true }, {}]").unwrap();
        let kinds: Vec<_> = project.passes.iter().map(|pass| pass.kind).collect();
        assert_eq!(kinds, [PassKind::Buffer(Buffer::A), PassKind::Image]);
        for (index, pass) in project.passes.iter().enumerate() {
            let text = files.get(pass.file).text();
            let declared = "uniform sampler2D i;\nuniform sampler2D b;\nin vec2 isf_FragNormCoord;\n";
            assert!(text.starts_with(declared), "{text}");
            assert!(
                text.contains(&format!("const int PASSINDEX = {index};\n")),
                "{text}"
            );
            let sources = pass
                .inputs
                .each_ref()
                .map(|input| input.as_ref().map(|input| input.source.clone()));
            assert_eq!(sources, [None, Some(Source::Buffer(Buffer::A)), None, None]);
        }
        // A buffer that is rendered last is shown.
        let (project, files) = self::project("[{ \"TARGET\": \"b\" }]").unwrap();
        assert_eq!(project.passes.len(), 2);
        assert!(files.get(project.image().file).text().contains("texelFetch(b, "));
    }

    #[test]
    fn sizes_are_those_of_buffers() {
        let sizes = |passes: &str| {
            let (project, _) = project(passes).unwrap();
            let sizes = project.passes.iter().map(|pass| pass.format.size.of([64, 36]));
            sizes.collect::<Vec<_>>()
        };
        // The last buffer is shown in the size of the image.
        let sides = "\"WIDTH\": \"floor($WIDTH * 0.3)\", \"HEIGHT\": 5";
        let passes =
            format!("[{{ \"TARGET\": \"b\", \"HEIGHT\": \"$WIDTH\" }}, {{ \"TARGET\": \"c\", {sides} }}]");
        assert_eq!(sizes(&passes), [[64, 64], [19, 5], [64, 36]]);
        let (project, _) = project("[{ \"TARGET\": \"b\", \"WIDTH\": \"$WIDTH\" }, {}]").unwrap();
        assert_eq!(project.passes[0].format.size, BufferSize::Image);
    }

    #[test]
    fn buffers_that_a_pass_reads_before_they_are_rendered_are_cleared_unless_they_persist() {
        // The text reads `b` in both passes.
        let is_cleared = |pass: &str| {
            let (project, _) = project(&format!("[{pass}, {{}}]")).unwrap();
            project.passes[0].format.is_cleared
        };
        assert!(is_cleared("{ \"TARGET\": \"b\" }"));
        assert!(!is_cleared("{ \"TARGET\": \"b\", \"PERSISTENT\": true }"));
        assert!(!is_cleared("{ \"TARGET\": \"b\", \"PERSISTENT\": 1 }"));
        assert!(!is_cleared("{ \"TARGET\": \"c\" }"));
    }

    #[test]
    fn version_1_lists_its_buffers() {
        let format = |buffers: &str| {
            let (project, _) = project(&format!(
                "[{{ \"TARGET\": \"b\" }}, {{}}], \"PERSISTENT_BUFFERS\": {buffers}"
            ))
            .unwrap();
            let BufferFormat { size, is_cleared, .. } = &project.passes[0].format;
            (size.of([64, 36]), *is_cleared)
        };
        assert_eq!(format("[\"b\"]"), ([64, 36], false));
        assert_eq!(
            format("{ \"b\": { \"WIDTH\": \"$WIDTH/4\" } }"),
            ([16, 36], false)
        );
        assert_eq!(format("[\"c\"]"), ([64, 36], true));
    }

    #[test]
    fn passes_that_cannot_be_rendered_are_errors() {
        let error = |passes: &str| project(passes).map(|_| ()).unwrap_err();
        // The columns are those of the expression.
        let found = error("[{ \"TARGET\": \"b\", \"WIDTH\": \"$WIDTH/$x\" }, {}]");
        assert!(
            found.starts_with("a:3:47: ") && found.contains("no input `x` that is a number"),
            "{found}"
        );
        assert!(error("[{ \"TARGET\": \"b\", \"WIDTH\": true }, {}]").contains("a number, or an expression"));
        assert!(error("[{ \"TARGET\": \"b\" }, { \"HEIGHT\": 1 }]").contains("has the size of the image"));
        assert!(error("[{}, { \"TARGET\": \"b\" }]").contains("only the last pass"));
        let many = (0..27).map(|number| format!("{{ \"TARGET\": \"t{number}\" }}"));
        let many = many.collect::<Vec<_>>().join(",");
        assert!(error(&format!("[{many}]")).contains("more than 26 passes"));
    }
}
