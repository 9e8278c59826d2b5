//! The words and types of GLSL ES 3.00.

use toyproof_glsl::tree::{BuiltIn, Scalar, Type};

/// Whether nothing may have the name. The author's names are valid: the shader is GLSL.
pub(super) fn is_reserved(word: &str) -> bool {
    word.starts_with("gl_") || word.contains("__")
}

/// A stem for `word` such that `{stem}_1` is not reserved.
pub(super) fn with_free_stem(word: &str) -> String {
    if !is_reserved(&format!("{word}_1")) {
        return word.to_owned();
    }
    let parts = word.split('_').filter(|part| !part.is_empty() && *part != "gl");
    match parts.collect::<Vec<_>>().as_slice() {
        [] => "unused".to_owned(),
        parts => parts.join("_"),
    }
}

/// Whether the name is a function's.
pub(super) fn is_function(word: &str) -> bool {
    BuiltIn::ALL.iter().any(|function| function.name() == word)
}

/// The name of a scalar, vector, matrix or sampler type.
pub(super) fn numeric_type(ty: Type) -> Option<String> {
    Some(match ty {
        Type::Scalar(scalar) => scalar.name().to_owned(),
        Type::Vector(scalar, size) => format!("{}vec{size}", Scalar::vector_prefix(scalar)),
        Type::Matrix { columns, rows } if columns == rows => format!("mat{columns}"),
        Type::Matrix { columns, rows } => format!("mat{columns}x{rows}"),
        Type::Sampler(sampler) => sampler.name(),
        _ => return None,
    })
}
