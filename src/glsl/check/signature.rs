//! The signatures of the built-in functions (§8), parsed from the notation of the specification.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::keywords::{Interner, Word};
use crate::tree::{BuiltIn, Overload, Sampler, SamplerShape, Scalar, Tree, Type};

/// A signature that accepts given arguments.
pub(super) struct Match {
    pub(super) result: Type,
    pub(super) parameters: Vec<Type>,
    /// The index of the argument that must be a constant expression, if any.
    pub(super) constant: Option<usize>,
}

impl BuiltIn {
    /// The built-in function with that name.
    pub fn named(name: &str) -> Option<Self> {
        NAMES.get(name).copied()
    }

    /// The signatures in the order of the table, with the types that arguments of these types determine; of a
    /// call that is not complete, [`Type::Error`] is an unknown one.
    pub fn overloads(self, given: &[Type]) -> Vec<Overload> {
        let signatures = SIGNATURES.get(&self).into_iter().flatten();
        signatures
            .map(|signature| signature.overload(self, given))
            .collect()
    }

    /// The type of its value for arguments of these types; `None` if no signature accepts exactly them.
    pub fn result(self, arguments: &[Type]) -> Option<Type> {
        find(self, arguments, |given, wanted| given == wanted).map(|found| found.result)
    }
}

/// The first signature of a function for whose parameters `fit(given, parameter)` holds for all arguments.
pub(super) fn find(function: BuiltIn, types: &[Type], fit: impl Fn(Type, Type) -> bool) -> Option<Match> {
    SIGNATURES.get(&function)?.iter().find_map(|signature| {
        let parameters = &signature.parameters;
        if types.len() > parameters.len() || types.len() < signature.required {
            return None;
        }
        let mut bindings = Bindings::default();
        let mut wanted = Vec::with_capacity(types.len());
        for (&given, parameter) in types.iter().zip(parameters) {
            let ty = parameter.for_argument(given, &mut bindings)?;
            if !fit(given, ty) {
                return None;
            }
            wanted.push(ty);
        }
        Some(Match {
            result: signature.result.resolve(&bindings)?,
            parameters: wanted,
            constant: signature.constant.filter(|&index| index < types.len()),
        })
    })
}

/// The parameters of every signature with that number of arguments, as far as the arguments determine the
/// generic types.
pub(super) fn candidates(function: BuiltIn, types: &[Type]) -> Vec<Vec<Type>> {
    let signatures = SIGNATURES.get(&function).into_iter().flatten();
    let fitting = signatures
        .filter(|signature| (signature.required..=signature.parameters.len()).contains(&types.len()));
    fitting
        .filter_map(|signature| {
            let mut bindings = Bindings::default();
            let parameters = signature.parameters.iter().zip(types);
            parameters
                .map(|(parameter, &given)| parameter.for_argument(given, &mut bindings))
                .collect()
        })
        .collect()
}

/// The numbers of arguments that a function accepts.
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
    /// The number of parameters that are not optional.
    required: usize,
    constant: Option<usize>,
}

/// A type in a signature.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pattern {
    Exactly(Type),
    /// `genType`, `genIType`, `genUType`, `genBType`.
    Gen(Scalar),
    /// `vec`, `ivec`, `uvec`, `bvec`.
    Vec(Scalar),
    /// `mat`.
    Matrix,
    /// `gsampler2D` and other generic samplers.
    Sampler(SamplerShape),
    /// `gvec4`.
    Texel,
}

/// The bindings of the generic types, which are the same throughout one signature.
#[derive(Default)]
struct Bindings {
    size: Option<u8>,
    matrix: Option<Type>,
    texel: Option<Scalar>,
}

impl Pattern {
    /// Binds the pattern's generic type to the argument's unless it is bound, and returns the parameter's
    /// type.
    fn for_argument(self, given: Type, bindings: &mut Bindings) -> Option<Type> {
        match (self, given) {
            (Self::Gen(_), Type::Scalar(_)) => bindings.size = bindings.size.or(Some(1)),
            (Self::Gen(_) | Self::Vec(_), Type::Vector(_, size)) => {
                bindings.size = bindings.size.or(Some(size));
            }
            (Self::Matrix, Type::Matrix { .. }) => bindings.matrix = bindings.matrix.or(Some(given)),
            (Self::Sampler(_), Type::Sampler(sampler)) => {
                bindings.texel = Some(sampler.texel);
            }
            _ => {}
        }
        self.resolve(bindings)
    }

    fn resolve(self, bindings: &Bindings) -> Option<Type> {
        match self {
            Self::Exactly(ty) => Some(ty),
            Self::Gen(scalar) => Some(Type::vector(scalar, bindings.size?)),
            Self::Vec(scalar) => bindings
                .size
                .filter(|&size| size > 1)
                .map(|size| Type::Vector(scalar, size)),
            Self::Matrix => bindings.matrix,
            Self::Sampler(shape) => Some(Type::Sampler(Sampler {
                texel: bindings.texel?,
                shape,
                shadow: false,
            })),
            Self::Texel => Some(Type::Vector(bindings.texel?, 4)),
        }
    }

    /// The type, or the notation of the specification if it is not determined.
    fn name(self, bindings: &Bindings) -> String {
        let generic = |prefix: &str, scalar: Scalar, suffix: &str| {
            format!("{prefix}{}{suffix}", scalar.vector_prefix().to_uppercase())
        };
        match (self.resolve(bindings), self) {
            (Some(ty), _) => Tree::default().type_name(ty),
            (None, Self::Gen(scalar)) => generic("gen", scalar, "Type"),
            (None, Self::Vec(scalar)) => format!("{}vec", scalar.vector_prefix()),
            (None, Self::Sampler(shape)) => format!("g{}", Sampler::float(shape).name()),
            (None, Self::Texel) => "gvec4".to_owned(),
            (None, Self::Matrix | Self::Exactly(_)) => "mat".to_owned(),
        }
    }

    fn parse(word: &str, interner: &Interner) -> Option<Self> {
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
                interner.word(interner.find(word.strip_prefix('g').unwrap_or(word))?),
            ) {
                (Some(_), Word::Type(Type::Sampler(sampler))) => Self::Sampler(sampler.shape),
                (None, Word::Type(ty)) => Self::Exactly(ty),
                _ => return None,
            },
        })
    }
}

impl Signature {
    /// Parses a signature of a function.
    fn parse(line: &str, function: BuiltIn, interner: &Interner) -> Option<Self> {
        let (result, rest) = line.split_once(' ')?;
        let parameters = rest.strip_prefix(function.name())?;
        let parameters = parameters.strip_prefix('(')?.strip_suffix(')')?;
        let mut signature = Self {
            result: Pattern::parse(result, interner)?,
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
            signature.parameters.push(Pattern::parse(word, interner)?);
        }
        Some(signature)
    }

    fn overload(&self, function: BuiltIn, given: &[Type]) -> Overload {
        let mut bindings = Bindings::default();
        let mut fits = given.len() <= self.parameters.len();
        for (&parameter, &given) in self.parameters.iter().zip(given) {
            let wanted = parameter.for_argument(given, &mut bindings);
            fits &= given == Type::Error || wanted == Some(given);
        }
        if !fits {
            bindings = Bindings::default();
        }
        let parameter = |(index, (pattern, name)): (usize, (&Pattern, &&str))| {
            let declared = format!("{} {name}", pattern.name(&bindings));
            if index >= self.required {
                format!("[{declared}]")
            } else if self.constant == Some(index) {
                format!("const {declared}")
            } else if function.out_parameter() == Some(index) {
                format!("out {declared}")
            } else {
                declared
            }
        };
        let names = function.documentation().parameters;
        Overload {
            result: self.result.name(&bindings),
            parameters: self
                .parameters
                .iter()
                .zip(names)
                .enumerate()
                .map(parameter)
                .collect(),
            fits,
        }
    }
}

static NAMES: LazyLock<HashMap<&str, BuiltIn>> = LazyLock::new(|| {
    BuiltIn::ALL
        .iter()
        .map(|&function| (function.name(), function))
        .collect()
});

static SIGNATURES: LazyLock<HashMap<BuiltIn, Vec<Signature>>> = LazyLock::new(|| {
    let interner = Interner::default();
    let mut signatures = HashMap::new();
    for &function in BuiltIn::ALL {
        let parse = |line: &&str| Signature::parse(line, function, &interner);
        signatures.insert(function, function.signatures().iter().filter_map(parse).collect());
    }
    signatures
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_signature_parses() {
        for function in BuiltIn::ALL {
            let signatures = function.signatures();
            assert_eq!(SIGNATURES[function].len(), signatures.len(), "{signatures:?}");
        }
    }

    #[test]
    fn every_parameter_has_a_name() {
        for &function in BuiltIn::ALL {
            let names = function.documentation().parameters;
            let counts = SIGNATURES[&function]
                .iter()
                .map(|signature| signature.parameters.len());
            assert_eq!(counts.max(), Some(names.len()), "{}", function.name());
            let unique: std::collections::HashSet<_> = names.iter().collect();
            assert_eq!(unique.len(), names.len(), "{}", function.name());
        }
    }

    #[test]
    fn overloads_have_the_types_of_the_arguments() {
        let vec3 = Type::vector(Scalar::Float, 3);
        let shown = |function: BuiltIn, given: &[Type]| {
            let overloads = function.overloads(given).into_iter();
            let fitting = overloads.filter(|overload| overload.fits);
            let shown = fitting.map(|it| format!("{} {}", it.result, it.parameters.join(", ")));
            shown.collect::<Vec<_>>().join("; ")
        };
        assert_eq!(shown(BuiltIn::Sin, &[]), "genType genType angle");
        assert_eq!(
            shown(BuiltIn::Mix, &[vec3, Type::Error, Type::FLOAT]),
            "vec3 vec3 x, vec3 y, float a"
        );
        let channel = Type::Sampler(Sampler::D2);
        assert_eq!(
            shown(BuiltIn::TextureOffset, &[channel]),
            "vec4 sampler2D channel, vec2 p, const ivec2 offset, [float bias]"
        );
        assert_eq!(
            shown(BuiltIn::Modf, &[Type::FLOAT]),
            "float float x, out float whole"
        );
        assert_eq!(
            shown(BuiltIn::LessThan, &[]),
            "bvec vec x, vec y; bvec ivec x, ivec y; bvec uvec x, uvec y"
        );
    }

    #[test]
    fn generic_types_bind_consistently() {
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
