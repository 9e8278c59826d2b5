//! The built-in functions (GLSL ES 3.00.6 §8) by name; `check` holds their signatures.

macro_rules! built_in_functions {
    ($($variant:ident $name:literal,)*) => {
        /// A built-in function: all overloads of one name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum BuiltIn {
            $(#[doc = concat!("`", $name, "`")] $variant,)*
        }

        impl BuiltIn {
            /// All built-in functions.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Its name in GLSL.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}

built_in_functions! {
    // §8.1 Angle and trigonometry
    Radians "radians",
    Degrees "degrees",
    Sin "sin",
    Cos "cos",
    Tan "tan",
    Asin "asin",
    Acos "acos",
    Atan "atan",
    Sinh "sinh",
    Cosh "cosh",
    Tanh "tanh",
    Asinh "asinh",
    Acosh "acosh",
    Atanh "atanh",
    // §8.2 Exponential
    Pow "pow",
    Exp "exp",
    Log "log",
    Exp2 "exp2",
    Log2 "log2",
    Sqrt "sqrt",
    InverseSqrt "inversesqrt",
    // §8.3 Common
    Abs "abs",
    Sign "sign",
    Floor "floor",
    Trunc "trunc",
    Round "round",
    RoundEven "roundEven",
    Ceil "ceil",
    Fract "fract",
    Mod "mod",
    Modf "modf",
    Min "min",
    Max "max",
    Clamp "clamp",
    Mix "mix",
    Step "step",
    Smoothstep "smoothstep",
    IsNan "isnan",
    IsInf "isinf",
    FloatBitsToInt "floatBitsToInt",
    FloatBitsToUint "floatBitsToUint",
    IntBitsToFloat "intBitsToFloat",
    UintBitsToFloat "uintBitsToFloat",
    // §8.4 Floating-point pack and unpack
    PackSnorm2x16 "packSnorm2x16",
    UnpackSnorm2x16 "unpackSnorm2x16",
    PackUnorm2x16 "packUnorm2x16",
    UnpackUnorm2x16 "unpackUnorm2x16",
    PackHalf2x16 "packHalf2x16",
    UnpackHalf2x16 "unpackHalf2x16",
    // §8.5 Geometric
    Length "length",
    Distance "distance",
    Dot "dot",
    Cross "cross",
    Normalize "normalize",
    Faceforward "faceforward",
    Reflect "reflect",
    Refract "refract",
    // §8.6 Matrix
    MatrixCompMult "matrixCompMult",
    OuterProduct "outerProduct",
    Transpose "transpose",
    Determinant "determinant",
    Inverse "inverse",
    // §8.7 Vector relational
    LessThan "lessThan",
    LessThanEqual "lessThanEqual",
    GreaterThan "greaterThan",
    GreaterThanEqual "greaterThanEqual",
    Equal "equal",
    NotEqual "notEqual",
    Any "any",
    All "all",
    Not "not",
    // §8.8 Texture lookup
    TextureSize "textureSize",
    Texture "texture",
    TextureProj "textureProj",
    TextureLod "textureLod",
    TextureOffset "textureOffset",
    TexelFetch "texelFetch",
    TexelFetchOffset "texelFetchOffset",
    TextureProjOffset "textureProjOffset",
    TextureLodOffset "textureLodOffset",
    TextureProjLod "textureProjLod",
    TextureProjLodOffset "textureProjLodOffset",
    TextureGrad "textureGrad",
    TextureGradOffset "textureGradOffset",
    TextureProjGrad "textureProjGrad",
    TextureProjGradOffset "textureProjGradOffset",
    // §8.9 Fragment processing
    DFdx "dFdx",
    DFdy "dFdy",
    Fwidth "fwidth",
}

impl BuiltIn {
    /// The index of the parameter that is written, if any: `modf`'s second.
    #[must_use]
    pub fn out_parameter(self) -> Option<usize> {
        (self == Self::Modf).then_some(1)
    }

    /// Whether it reads a texture; such calls are not constant expressions (§4.3.3).
    #[must_use]
    pub fn is_texture(self) -> bool {
        self >= Self::TextureSize && self <= Self::TextureProjGradOffset
    }

    /// Whether it is a derivative, which uses the neighbors in the pixel's quad.
    #[must_use]
    pub fn is_derivative(self) -> bool {
        matches!(self, Self::DFdx | Self::DFdy | Self::Fwidth)
    }
}
