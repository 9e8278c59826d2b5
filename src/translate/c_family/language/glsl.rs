//! The words and types of GLSL ES 3.00.

use toyproof_glsl::tree::{Scalar, Type};

use crate::print::keyword;

/// Whether nothing may have the name. Words of later versions of GLSL count: other compilers read the file as
/// one of these.
pub(super) fn is_reserved(word: &str) -> bool {
    keyword::is_reserved(word)
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
    keyword::is_function(word)
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
