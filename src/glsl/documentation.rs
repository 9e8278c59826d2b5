//! What the words of the language mean, for readers: built-in variables, types, keywords and directives. The
//! functions are in [`BuiltIn::documentation`](crate::tree::BuiltIn::documentation), the inputs in
//! [`Input::documentation`](crate::tree::Input::documentation).

use crate::keywords::Keyword;
use crate::preprocess::DIRECTIVES;
use crate::tree::{BuiltInVariable, SamplerShape, Scalar, Type, Variable, VariableKind};

/// What a variable is that the text does not define: an input, a channel, or a built-in variable or constant.
/// `None` for others.
pub fn of_variable(variable: &Variable) -> Option<&'static str> {
    Some(match variable.kind {
        VariableKind::Input(input) => input.documentation(),
        VariableKind::Channel(_) => {
            "The texture of a channel. What it shows is set beside the shader; black if nothing is."
        }
        VariableKind::BuiltIn(BuiltInVariable::FragCoord) => {
            "The position of the pixel: `xy` in pixels from the lower left, where the center of the first \
            pixel is (0.5, 0.5), `z` the depth in [0, 1], and `w` the reciprocal of the clip coordinate w."
        }
        VariableKind::BuiltIn(BuiltInVariable::FrontFacing) => {
            "Whether the triangle that is rendered faces the viewer. Of an image that fills the screen, true."
        }
        VariableKind::BuiltIn(BuiltInVariable::PointCoord) => {
            "The position within a point that is rendered, in [0, 1]. Undefined unless points are rendered."
        }
        VariableKind::BuiltIn(BuiltInVariable::FragDepth) => "The depth of the pixel in [0, 1], an output.",
        VariableKind::BuiltInConstant => of_constant(&variable.name)?,
        _ => return None,
    })
}

fn of_constant(name: &str) -> Option<&'static str> {
    Some(match name {
        "gl_MaxVertexAttribs" => "The number of attributes of a vertex that every device has.",
        "gl_MaxVertexUniformVectors" => {
            "The number of uniform vectors in vertex shaders that every device has."
        }
        "gl_MaxVertexOutputVectors" => {
            "The number of output vectors of vertex shaders that every device has."
        }
        "gl_MaxFragmentInputVectors" => {
            "The number of input vectors of fragment shaders that every device has."
        }
        "gl_MaxVertexTextureImageUnits" => "The number of textures in vertex shaders that every device has.",
        "gl_MaxCombinedTextureImageUnits" => "The number of textures in all shaders that every device has.",
        "gl_MaxTextureImageUnits" => "The number of textures in fragment shaders that every device has.",
        "gl_MaxFragmentUniformVectors" => {
            "The number of uniform vectors in fragment shaders that every device has."
        }
        "gl_MaxDrawBuffers" => "The number of color outputs that every device has.",
        "gl_MinProgramTexelOffset" => "The least offset of a lookup in texels that every device accepts.",
        "gl_MaxProgramTexelOffset" => "The largest offset of a lookup in texels that every device accepts.",
        _ => return None,
    })
}

/// What a built-in type is; `None` for structures and arrays.
pub fn of_type(ty: Type) -> Option<String> {
    let number = |scalar| match scalar {
        Scalar::Bool => "`true` or `false`",
        Scalar::Int => "signed integers of 32 bits, which wrap around",
        Scalar::Uint => "unsigned integers of 32 bits, which wrap around",
        Scalar::Float => "floating-point numbers of 32 bits",
    };
    Some(match ty {
        Type::Void => "No value: the type of a function that returns nothing.".to_owned(),
        Type::Scalar(Scalar::Bool) => "`true` or `false`.".to_owned(),
        Type::Scalar(Scalar::Int) => "A signed integer of 32 bits, which wraps around.".to_owned(),
        Type::Scalar(Scalar::Uint) => {
            "An unsigned integer of 32 bits, which wraps around. Literals end with `u`.".to_owned()
        }
        Type::Scalar(Scalar::Float) => "A floating-point number of 32 bits, with about 7 digits.".to_owned(),
        Type::Vector(Scalar::Bool, size) => format!("A vector of {size} times {}.", number(Scalar::Bool)),
        Type::Vector(scalar, size) => format!("A vector of {size} {}.", number(scalar)),
        Type::Matrix { columns, rows } => format!(
            "A matrix of {columns} columns and {rows} rows of floats. Its constructor takes the columns one \
            after another; `m[i]` is a column."
        ),
        Type::Sampler(sampler) => {
            let shape = match sampler.shape {
                SamplerShape::D2 => "A texture of two dimensions",
                SamplerShape::D3 => "A volume: a texture of three dimensions",
                SamplerShape::Cube => "A cube map, looked up by a direction",
                SamplerShape::D2Array => "An array of textures of two dimensions",
            };
            let texel = match (sampler.shadow, sampler.texel) {
                (true, _) => ", which compares depths",
                (false, Scalar::Int) => ", whose texels are signed integers",
                (false, Scalar::Uint) => ", whose texels are unsigned integers",
                (false, _) => "",
            };
            format!("{shape}{texel}.")
        }
        Type::Struct(_) | Type::Array(_) | Type::Error => return None,
    })
}

/// What a keyword or a directive does: `while`, or `#define`.
pub fn of_word(word: &str) -> Option<&'static str> {
    if let Some(directive) = word.strip_prefix('#') {
        return of_directive(directive);
    }
    let mut keywords = Keyword::ALL.iter();
    keywords
        .find(|keyword| keyword.text() == word)
        .map(|&keyword| of_keyword(keyword))
}

/// The names of the directives, without `#`; also `include`, which a text in a folder may have.
pub fn directives() -> impl Iterator<Item = &'static str> {
    DIRECTIVES.into_iter().chain(["include"])
}

fn of_keyword(keyword: Keyword) -> &'static str {
    match keyword {
        Keyword::Const => "The variable never changes after its declaration, which must give it a value.",
        Keyword::Uniform => "A variable that the host sets, with one value for all pixels of an image.",
        Keyword::Layout => "Gives the location of an output, as in `layout(location = 0) out vec4 color;`.",
        Keyword::Centroid => "Interpolates within the part of the pixel that the triangle covers.",
        Keyword::Flat => "Passes the value of one vertex without interpolation.",
        Keyword::Smooth => "Interpolates with perspective, as is the default.",
        Keyword::Break => "Leaves the innermost loop or `switch`.",
        Keyword::Continue => "Goes on with the next iteration of the innermost loop.",
        Keyword::Do => "Runs the body, and again while the condition behind it is true.",
        Keyword::For => "`for (start; condition; step)` runs the body while the condition is true.",
        Keyword::While => "Runs the body while the condition before it is true.",
        Keyword::Switch => {
            "Continues at the `case` with the value of an integer, or at `default`. Without `break` it goes \
            on into the next `case`."
        }
        Keyword::Case => "A value of a `switch` at which to continue: a constant integer.",
        Keyword::Default => "Where a `switch` continues if no `case` has the value.",
        Keyword::If => "Runs the statement behind the condition only if it is true.",
        Keyword::Else => "Runs if the condition of the `if` before it is false.",
        Keyword::In => "The parameter is a copy of the argument, as without the keyword.",
        Keyword::Out => "The parameter is copied to the argument, a variable, at the end of the call.",
        Keyword::InOut => {
            "The parameter is a copy of the argument, a variable, and is copied back at the end."
        }
        Keyword::True | Keyword::False => "A value of type `bool`.",
        Keyword::Invariant => "Requires that equal expressions in different shaders have equal values.",
        Keyword::Discard => "Ends the shader for this pixel, which keeps the color that it had.",
        Keyword::Return => "Ends the function, with the value behind it unless the function is `void`.",
        Keyword::Struct => "Declares a type with named members of other types.",
        Keyword::Precision => "Sets the precision of a type, as in `precision highp float;`.",
        Keyword::Highp => "The highest precision: floats of 32 bits.",
        Keyword::Mediump => "At least medium precision; floats may have 16 bits, about 3 digits.",
        Keyword::Lowp => "At least low precision; floats may be limited to the range from -2 to 2.",
        Keyword::Varying => "An interpolated value from the vertex shader, in GLSL ES 1.00; later `in`.",
        Keyword::Attribute => "A value of a vertex, in GLSL ES 1.00; later `in` of a vertex shader.",
    }
}

fn of_directive(name: &str) -> Option<&'static str> {
    Some(match name {
        "define" => {
            "Defines a macro: a name, or a name with parameters, that is replaced by the rest of the line."
        }
        "undef" => "Removes a macro.",
        "if" => "Compiles the lines up to `#elif`, `#else` or `#endif` if an integer expression is not 0.",
        "ifdef" => "Compiles the lines up to `#elif`, `#else` or `#endif` if a macro is defined.",
        "ifndef" => "Compiles the lines up to `#elif`, `#else` or `#endif` if a macro is not defined.",
        "elif" => "Another condition of the `#if` before it, if no earlier one was true.",
        "else" => "Compiles the lines up to `#endif` if no condition before it was true.",
        "endif" => "Ends an `#if`, `#ifdef` or `#ifndef`.",
        "error" => "Stops the compilation with the rest of the line as its message.",
        "pragma" => "A setting of the compiler; unknown ones have no effect.",
        "extension" => "Enables, requires or disables an extension of the language.",
        "version" => "The version of GLSL, such as `300 es`: the first line. ShaderToy writes it itself.",
        "line" => "Sets the line number of the next line in messages.",
        "include" => "Inserts another file here, before the text is compiled.",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;
    use crate::dialect::Version;
    use crate::tree::{BuiltIn, Input};
    use crate::{Options, check};

    #[test]
    fn every_text_is_one_to_three_sentences() {
        let functions = BuiltIn::ALL.iter().map(|function| function.documentation().text);
        let inputs = Input::ALL.iter().map(|input| input.documentation());
        let words = Keyword::ALL.iter();
        let words = words.map(|keyword| of_word(keyword.text()).unwrap());
        let directives = directives().map(|name| of_word(&format!("#{name}")).expect(name));
        let mut count = 0;
        for text in functions.chain(inputs).chain(words).chain(directives) {
            assert!(text.ends_with('.') && !text.contains("  "), "{text}");
            assert!((10..340).contains(&text.len()), "{text}");
            assert_eq!(text.matches('`').count() % 2, 0, "{text}");
            count += 1;
        }
        assert!(count > 120, "{count}");
    }

    #[test]
    fn every_built_in_variable_has_a_text() {
        let mut files = Files::default();
        let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.); }";
        let file = files.add(File::new("a.glsl", text));
        let checked = check(&files, file, &Options::default()).unwrap();
        let variables = checked.tree.variables.iter();
        let built_in: Vec<_> = variables.filter(|(_, variable)| variable.at.is_none()).collect();
        assert!(built_in.len() > 25, "{}", built_in.len());
        for (_, variable) in built_in {
            assert!(of_variable(variable).is_some(), "{}", variable.name);
        }
    }

    #[test]
    fn every_built_in_type_has_a_text() {
        let types = Version::Es300.types(false);
        assert!(types.len() > 40, "{}", types.len());
        for (name, ty) in types {
            assert!(of_type(ty).is_some_and(|text| text.ends_with('.')), "{name}");
        }
        let text = of_type(Type::Vector(Scalar::Float, 3));
        assert_eq!(
            text.as_deref(),
            Some("A vector of 3 floating-point numbers of 32 bits.")
        );
    }
}
