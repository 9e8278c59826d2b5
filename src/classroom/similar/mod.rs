//! Similarity of shaders: the fingerprints of their trees, or of their texts, and the pairs that share many.

pub mod fingerprint;
pub mod pairs;
pub mod tokens;
