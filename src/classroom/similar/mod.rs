//! Similarity of shaders: the fingerprints of their trees, or of their texts.

pub mod fingerprint;
pub mod tokens;
