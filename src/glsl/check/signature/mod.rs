//! The signatures of the built-in functions (§8), read from a table that looks like the specification's.

mod table;

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::tree::{BuiltIn, Sampler, SamplerShape, Scalar, Type};
use crate::words::{Word, Words};

/// A signature that takes some arguments.
pub(super) struct Match {
    pub(super) result: Type,
    pub(super) parameters: Vec<Type>,
    /// Which argument must be a constant expression, if one must.
    pub(super) constant: Option<usize>,
}

impl BuiltIn {
    /// The built-in function of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        NAMES.get(name).copied()
    }
}

/// The first signature of a function whose parameters `fit(given, parameter)` the arguments.
pub(super) fn find(function: BuiltIn, types: &[Type], fit: impl Fn(Type, Type) -> bool) -> Option<Match> {
    SIGNATURES.get(&function)?.iter().find_map(|signature| {
        let parameters = &signature.parameters;
        if types.len() > parameters.len() || types.len() < signature.required {
            return None;
        }
        let mut same = Same::default();
        let mut wanted = Vec::with_capacity(types.len());
        for (&given, parameter) in types.iter().zip(parameters) {
            let ty = parameter.for_argument(given, &mut same)?;
            if !fit(given, ty) {
                return None;
            }
            wanted.push(ty);
        }
        Some(Match {
            result: signature.result.of(&same)?,
            parameters: wanted,
            constant: signature.constant.filter(|&index| index < types.len()),
        })
    })
}

/// The parameters of every signature of as many arguments, as far as the arguments tell what generic types stand for.
pub(super) fn candidates(function: BuiltIn, types: &[Type]) -> Vec<Vec<Type>> {
    let signatures = SIGNATURES.get(&function).into_iter().flatten();
    let fitting = signatures
        .filter(|signature| (signature.required..=signature.parameters.len()).contains(&types.len()));
    fitting
        .filter_map(|signature| {
            let mut same = Same::default();
            let parameters = signature.parameters.iter().zip(types);
            parameters
                .map(|(parameter, &given)| parameter.for_argument(given, &mut same))
                .collect()
        })
        .collect()
}

/// The numbers of arguments that a function takes.
pub(super) fn counts(function: BuiltIn) -> Vec<usize> {
    let signatures = SIGNATURES.get(&function).into_iter().flatten();
    signatures
        .flat_map(|signature| signature.required..=signature.parameters.len())
        .collect()
}

#[derive(Debug)]
struct Signature {
    result: Pattern,
    parameters: Vec<Pattern>,
    /// How many parameters must be given.
    required: usize,
    constant: Option<usize>,
}

/// A type of a signature.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pattern {
    Exactly(Type),
    /// `genType` and its kin.
    Gen(Scalar),
    /// `vec` and its kin.
    Vec(Scalar),
    /// `mat`.
    Matrix,
    /// `gsampler2D` and its kin.
    Sampler(SamplerShape),
    /// `gvec4`.
    Texel,
}

/// What stands for the same thing throughout one signature.
#[derive(Default)]
struct Same {
    size: Option<u8>,
    matrix: Option<Type>,
    texel: Option<Scalar>,
}

impl Pattern {
    /// The type that the pattern stands for, told by an argument if not by earlier ones.
    fn for_argument(self, given: Type, same: &mut Same) -> Option<Type> {
        match (self, given) {
            (Self::Gen(_), Type::Scalar(_)) => same.size = same.size.or(Some(1)),
            (Self::Gen(_) | Self::Vec(_), Type::Vector(_, size)) => same.size = same.size.or(Some(size)),
            (Self::Matrix, Type::Matrix { .. }) => same.matrix = same.matrix.or(Some(given)),
            (Self::Sampler(_), Type::Sampler(sampler)) => {
                same.texel = Some(sampler.texel);
            }
            _ => {}
        }
        self.of(same)
    }

    fn of(self, same: &Same) -> Option<Type> {
        match self {
            Self::Exactly(ty) => Some(ty),
            Self::Gen(scalar) => Some(Type::vector(scalar, same.size?)),
            Self::Vec(scalar) => same
                .size
                .filter(|&size| size > 1)
                .map(|size| Type::Vector(scalar, size)),
            Self::Matrix => same.matrix,
            Self::Sampler(shape) => Some(Type::Sampler(Sampler {
                texel: same.texel?,
                shape,
                shadow: false,
            })),
            Self::Texel => Some(Type::Vector(same.texel?, 4)),
        }
    }

    fn parse(word: &str, words: &Words) -> Option<Self> {
        Some(match word {
            "genType" => Self::Gen(Scalar::Float),
            "genIType" => Self::Gen(Scalar::Int),
            "genUType" => Self::Gen(Scalar::Uint),
            "genBType" => Self::Gen(Scalar::Bool),
            "vec" => Self::Vec(Scalar::Float),
            "ivec" => Self::Vec(Scalar::Int),
            "uvec" => Self::Vec(Scalar::Uint),
            "bvec" => Self::Vec(Scalar::Bool),
            "mat" => Self::Matrix,
            "gvec4" => Self::Texel,
            _ => match (
                word.strip_prefix('g'),
                words.word(words.find(word.strip_prefix('g').unwrap_or(word))?),
            ) {
                (Some(_), Word::Type(Type::Sampler(sampler))) => Self::Sampler(sampler.shape),
                (None, Word::Type(ty)) => Self::Exactly(ty),
                _ => return None,
            },
        })
    }
}

impl Signature {
    /// Reads a line of the table.
    fn parse(line: &str, words: &Words) -> Option<(BuiltIn, Self)> {
        let (result, rest) = line.split_once(' ')?;
        let (name, parameters) = rest.strip_suffix(')')?.split_once('(')?;
        let mut signature = Self {
            result: Pattern::parse(result, words)?,
            parameters: Vec::new(),
            required: 0,
            constant: None,
        };
        for (index, parameter) in parameters.split(", ").enumerate() {
            let optional = parameter
                .strip_prefix('[')
                .and_then(|word| word.strip_suffix(']'));
            let constant = parameter.strip_prefix("const ");
            if constant.is_some() {
                signature.constant = Some(index);
            }
            if optional.is_none() {
                signature.required = index + 1;
            }
            let word = optional.or(constant).unwrap_or(parameter);
            signature.parameters.push(Pattern::parse(word, words)?);
        }
        Some((BuiltIn::named(name)?, signature))
    }
}

static NAMES: LazyLock<HashMap<&str, BuiltIn>> = LazyLock::new(|| {
    BuiltIn::ALL
        .iter()
        .map(|&function| (function.name(), function))
        .collect()
});

static SIGNATURES: LazyLock<HashMap<BuiltIn, Vec<Signature>>> = LazyLock::new(|| {
    let words = Words::default();
    let mut signatures: HashMap<_, Vec<_>> = HashMap::new();
    for (function, signature) in lines().filter_map(|line| Signature::parse(line, &words)) {
        signatures.entry(function).or_default().push(signature);
    }
    signatures
});

fn lines() -> impl Iterator<Item = &'static str> {
    table::TABLE
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_read_and_every_function_has_one() {
        let read: usize = SIGNATURES.values().map(Vec::len).sum();
        assert_eq!(read, lines().count());
        for function in BuiltIn::ALL {
            assert!(SIGNATURES.contains_key(function), "{}", function.name());
        }
    }

    #[test]
    fn generic_types_are_the_same_throughout() {
        let vec = |size| Type::vector(Scalar::Float, size);
        let result =
            |function, types: &[Type]| find(function, types, |a, b| a == b).map(|found| found.result);
        assert_eq!(result(BuiltIn::Mod, &[vec(3), vec(3)]), Some(vec(3)));
        assert_eq!(result(BuiltIn::Mod, &[vec(3), vec(1)]), Some(vec(3)));
        assert_eq!(result(BuiltIn::Mod, &[vec(3), vec(2)]), None);
        assert_eq!(result(BuiltIn::Mod, &[vec(1), vec(3)]), None);
        assert_eq!(result(BuiltIn::LessThan, &[vec(1), vec(1)]), None);
        assert_eq!(result(BuiltIn::Dot, &[vec(1), vec(1)]), Some(vec(1)));
        let isampler = Type::Sampler(Sampler {
            texel: Scalar::Int,
            ..Sampler::D2
        });
        assert_eq!(
            result(BuiltIn::Texture, &[isampler, vec(2)]),
            Some(Type::Vector(Scalar::Int, 4))
        );
        assert_eq!(
            result(BuiltIn::Texture, &[isampler, vec(2), vec(1)]),
            Some(Type::Vector(Scalar::Int, 4))
        );
        assert_eq!(result(BuiltIn::Texture, &[isampler, vec(3)]), None);
    }
}
