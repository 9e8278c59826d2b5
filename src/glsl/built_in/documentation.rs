//! What the built-in functions compute, for readers: the names of their parameters and a text for each.

use super::BuiltIn;

/// The documentation of a built-in function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Documentation {
    /// The names of the parameters; a signature with fewer parameters has the first ones.
    pub parameters: &'static [&'static str],
    /// One to three sentences in Markdown: the value, its range, and for which arguments it is undefined.
    pub text: &'static str,
}

/// A signature of a built-in function, as readers see it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Overload {
    /// The type of the value: `vec3`, or `genType` where the arguments do not determine it.
    pub result: String,
    /// Each parameter with its type and name: `float a`, `const ivec2 offset`, `out float whole`, or
    /// `[float bias]`, which may be left out.
    pub parameters: Vec<String>,
    /// Whether the given arguments are a beginning of its arguments.
    pub fits: bool,
}

impl BuiltIn {
    /// The names of the parameters, and what the function computes.
    pub fn documentation(self) -> Documentation {
        let (parameters, text) = self.names_and_text();
        Documentation { parameters, text }
    }

    #[expect(clippy::too_many_lines, reason = "one row for each function")]
    const fn names_and_text(self) -> (&'static [&'static str], &'static str) {
        match self {
            Self::Radians => (&["degrees"], "Converts degrees to radians: `degrees * π / 180`."),
            Self::Degrees => (&["radians"], "Converts radians to degrees: `radians * 180 / π`."),
            Self::Sin => (
                &["angle"],
                "The sine of an angle in radians, in [-1, 1]. Large angles lose precision.",
            ),
            Self::Cos => (
                &["angle"],
                "The cosine of an angle in radians, in [-1, 1]. Large angles lose precision.",
            ),
            Self::Tan => (
                &["angle"],
                "The tangent of an angle in radians: `sin(angle) / cos(angle)`.",
            ),
            Self::Asin => (
                &["x"],
                "The angle in [-π/2, π/2] radians whose sine is `x`. Undefined if `abs(x) > 1`.",
            ),
            Self::Acos => (
                &["x"],
                "The angle in [0, π] radians whose cosine is `x`. Undefined if `abs(x) > 1`.",
            ),
            Self::Atan => (
                &["y", "x"],
                "With two arguments, the angle in [-π, π] radians from the x axis to the point (`x`, `y`); \
                undefined if both are 0. With one argument, the angle in [-π/2, π/2] radians whose tangent \
                is `y`.",
            ),
            Self::Sinh => (&["x"], "The hyperbolic sine: `(exp(x) - exp(-x)) / 2`."),
            Self::Cosh => (
                &["x"],
                "The hyperbolic cosine: `(exp(x) + exp(-x)) / 2`, at least 1.",
            ),
            Self::Tanh => (
                &["x"],
                "The hyperbolic tangent: `sinh(x) / cosh(x)`, in [-1, 1]. Some drivers return NaN for large \
                `x`.",
            ),
            Self::Asinh => (&["x"], "The number whose hyperbolic sine is `x`."),
            Self::Acosh => (
                &["x"],
                "The number at or above 0 whose hyperbolic cosine is `x`. Undefined if `x < 1`.",
            ),
            Self::Atanh => (
                &["x"],
                "The number whose hyperbolic tangent is `x`. Undefined if `abs(x) >= 1`.",
            ),
            Self::Pow => (
                &["base", "exponent"],
                "`base` raised to the power `exponent`. Undefined if `base < 0`, also for whole exponents, \
                and if `base` is 0 and `exponent <= 0`: write `x * x` for a square.",
            ),
            Self::Exp => (
                &["x"],
                "e raised to the power `x`. Overflows to infinity above about 88.7.",
            ),
            Self::Log => (&["x"], "The natural logarithm of `x`. Undefined if `x <= 0`."),
            Self::Exp2 => (
                &["x"],
                "2 raised to the power `x`. Overflows to infinity from 128.",
            ),
            Self::Log2 => (
                &["x"],
                "The logarithm of `x` to the base 2. Undefined if `x <= 0`.",
            ),
            Self::Sqrt => (&["x"], "The square root of `x`. Undefined if `x < 0`."),
            Self::InverseSqrt => (&["x"], "`1 / sqrt(x)`. Undefined if `x <= 0`."),
            Self::Abs => (&["x"], "`x` without its sign."),
            Self::Sign => (&["x"], "-1, 0 or 1, as `x` is negative, zero or positive."),
            Self::Floor => (
                &["x"],
                "The largest whole number that is at most `x`: `floor(-0.5)` is -1.",
            ),
            Self::Trunc => (&["x"], "`x` without its fraction, toward 0: `trunc(-1.5)` is -1."),
            Self::Round => (
                &["x"],
                "The nearest whole number. Which way a fraction of 0.5 goes depends on the implementation; \
                see `roundEven`.",
            ),
            Self::RoundEven => (
                &["x"],
                "The nearest whole number; a fraction of 0.5 goes to the even one.",
            ),
            Self::Ceil => (
                &["x"],
                "The smallest whole number that is at least `x`: `ceil(-0.5)` is 0.",
            ),
            Self::Fract => (
                &["x"],
                "`x - floor(x)`, from 0 up to 1, also of negative numbers: `fract(-0.25)` is 0.75.",
            ),
            Self::Mod => (
                &["x", "y"],
                "`x - y * floor(x / y)`, which has the sign of `y`. Undefined if `y` is 0. Rounding of the \
                quotient may give a result near `y` instead of near 0.",
            ),
            Self::Modf => (
                &["x", "whole"],
                "Returns the fraction of `x`, and writes its whole part to the variable `whole`. Both have \
                the sign of `x`.",
            ),
            Self::Min => (
                &["x", "y"],
                "The smaller of `x` and `y`, by component. Undefined if one is NaN.",
            ),
            Self::Max => (
                &["x", "y"],
                "The larger of `x` and `y`, by component. Undefined if one is NaN.",
            ),
            Self::Clamp => (
                &["x", "low", "high"],
                "`x` limited to the range from `low` to `high`: `min(max(x, low), high)`. Undefined if `low \
                > high`.",
            ),
            Self::Mix => (
                &["x", "y", "a"],
                "Linear interpolation: `x * (1 - a) + y * a`, which is `x` for 0 and `y` for 1; `a` is not \
                limited to [0, 1]. With a `bool`, `y` where `a` is true, otherwise `x`.",
            ),
            Self::Step => (&["edge", "x"], "0 if `x < edge`, otherwise 1."),
            Self::Smoothstep => (
                &["low", "high", "x"],
                "Rises smoothly from 0 for `x <= low` to 1 for `x >= high`: `t * t * (3 - 2 * t)` of `t = \
                clamp((x - low) / (high - low), 0, 1)`. Undefined if `low >= high`: write `1 - \
                smoothstep(low, high, x)` for a falling edge.",
            ),
            Self::IsNan => (
                &["x"],
                "Whether `x` is NaN. Implementations need not have NaN, and may return `false`.",
            ),
            Self::IsInf => (&["x"], "Whether `x` is positive or negative infinity."),
            Self::FloatBitsToInt => (&["x"], "The 32 bits of the float `x` as an `int`."),
            Self::FloatBitsToUint => (&["x"], "The 32 bits of the float `x` as a `uint`."),
            Self::IntBitsToFloat | Self::UintBitsToFloat => (
                &["bits"],
                "The float with these 32 bits, which may be infinite or NaN.",
            ),
            Self::PackSnorm2x16 => (
                &["v"],
                "Both components, limited to [-1, 1], as integers of 16 bits, where 32767 is 1; the first \
                one in the lower bits.",
            ),
            Self::UnpackSnorm2x16 => (
                &["bits"],
                "The two numbers in [-1, 1] that `packSnorm2x16` packed.",
            ),
            Self::PackUnorm2x16 => (
                &["v"],
                "Both components, limited to [0, 1], as integers of 16 bits, where 65535 is 1; the first \
                one in the lower bits.",
            ),
            Self::UnpackUnorm2x16 => (
                &["bits"],
                "The two numbers in [0, 1] that `packUnorm2x16` packed.",
            ),
            Self::PackHalf2x16 => (
                &["v"],
                "Both components as floats of 16 bits; the first one in the lower bits.",
            ),
            Self::UnpackHalf2x16 => (&["bits"], "The two floats of 16 bits that `packHalf2x16` packed."),
            Self::Length => (
                &["x"],
                "The length of a vector: `sqrt(dot(x, x))`. The squares of components above about 1.8e19 \
                overflow.",
            ),
            Self::Distance => (&["p", "q"], "The distance between two points: `length(p - q)`."),
            Self::Dot => (
                &["x", "y"],
                "The sum of the products of the components: of unit vectors, the cosine of the angle \
                between them.",
            ),
            Self::Cross => (
                &["x", "y"],
                "The vector perpendicular to `x` and `y`, by the right-hand rule; its length is the area of \
                the parallelogram between them. `cross(y, x)` is the opposite.",
            ),
            Self::Normalize => (
                &["x"],
                "The vector of length 1 in the direction of `x`: `x / length(x)`. Undefined for the zero \
                vector.",
            ),
            Self::Faceforward => (
                &["n", "incident", "reference"],
                "`n` if `dot(reference, incident) < 0`, otherwise `-n`: a normal that points against the \
                ray.",
            ),
            Self::Reflect => (
                &["incident", "n"],
                "The direction of a ray after reflection: `incident - 2 * dot(n, incident) * n`. The normal \
                `n` must have length 1.",
            ),
            Self::Refract => (
                &["incident", "n", "eta"],
                "The direction of a ray after refraction, or the zero vector if it is totally reflected. \
                `incident` and `n` must have length 1 and point against each other; `eta` is the index of \
                refraction of the medium that the ray leaves divided by that of the one it enters.",
            ),
            Self::MatrixCompMult => (
                &["x", "y"],
                "The product by component; `x * y` is the algebraic product.",
            ),
            Self::OuterProduct => (
                &["column", "row"],
                "The matrix `column * row`, whose element in column i and row j is `column[j] * row[i]`.",
            ),
            Self::Transpose => (&["m"], "The matrix with rows and columns exchanged."),
            Self::Determinant => (
                &["m"],
                "The determinant, which is 0 if the matrix has no inverse.",
            ),
            Self::Inverse => (
                &["m"],
                "The inverse matrix. Undefined if the determinant is 0 or nearly so.",
            ),
            Self::LessThan => (&["x", "y"], "Where `x < y`, by component."),
            Self::LessThanEqual => (&["x", "y"], "Where `x <= y`, by component."),
            Self::GreaterThan => (&["x", "y"], "Where `x > y`, by component."),
            Self::GreaterThanEqual => (&["x", "y"], "Where `x >= y`, by component."),
            Self::Equal => (
                &["x", "y"],
                "Where `x == y`, by component; `==` gives one `bool` for the whole vectors.",
            ),
            Self::NotEqual => (
                &["x", "y"],
                "Where `x != y`, by component; `!=` gives one `bool` for the whole vectors.",
            ),
            Self::Any => (&["x"], "Whether a component is true."),
            Self::All => (&["x"], "Whether all components are true."),
            Self::Not => (&["x"], "The opposite of each component."),
            Self::TextureSize => (
                &["channel", "lod"],
                "The size of the level `lod` in texels: width, height, and depth or number of layers. \
                Undefined for a level that does not exist.",
            ),
            Self::Texture => (
                &["channel", "p", "bias"],
                "The filtered color at `p`: coordinates from 0 to 1 over the texture, or a direction into a \
                cube map. The level of detail follows from derivatives, so it is undefined in control flow \
                that differs between neighboring pixels. The optional `bias` is added to the level.",
            ),
            Self::TextureProj => (
                &["channel", "p", "bias"],
                "Like `texture`, at the coordinates of `p` divided by its last component.",
            ),
            Self::TextureLod => (
                &["channel", "p", "lod"],
                "The filtered color at `p` in the level of detail `lod`, where 0 is the full size. Needs no \
                derivatives, so it can be used in any control flow.",
            ),
            Self::TextureOffset => (
                &["channel", "p", "offset", "bias"],
                "Like `texture`, moved by `offset` texels: constants from -8 to 7.",
            ),
            Self::TexelFetch => (
                &["channel", "p", "lod"],
                "The unfiltered texel in column `p.x` and row `p.y` of the level `lod`, counted from 0 at \
                the lower left. Coordinates outside of the texture give zero in WebGL.",
            ),
            Self::TexelFetchOffset => (
                &["channel", "p", "lod", "offset"],
                "Like `texelFetch`, moved by `offset` texels: constants from -8 to 7.",
            ),
            Self::TextureProjOffset => (
                &["channel", "p", "offset", "bias"],
                "Like `textureProj`, moved by `offset` texels: constants from -8 to 7.",
            ),
            Self::TextureLodOffset => (
                &["channel", "p", "lod", "offset"],
                "Like `textureLod`, moved by `offset` texels: constants from -8 to 7.",
            ),
            Self::TextureProjLod => (
                &["channel", "p", "lod"],
                "Like `textureLod`, at the coordinates of `p` divided by its last component.",
            ),
            Self::TextureProjLodOffset => (
                &["channel", "p", "lod", "offset"],
                "Like `textureProjLod`, moved by `offset` texels: constants from -8 to 7.",
            ),
            Self::TextureGrad => (
                &["channel", "p", "ddx", "ddy"],
                "Like `texture`, with the level of detail from the given derivatives of `p` in x and y, so \
                it can be used in any control flow.",
            ),
            Self::TextureGradOffset => (
                &["channel", "p", "ddx", "ddy", "offset"],
                "Like `textureGrad`, moved by `offset` texels: constants from -8 to 7.",
            ),
            Self::TextureProjGrad => (
                &["channel", "p", "ddx", "ddy"],
                "Like `textureGrad`, at the coordinates of `p` divided by its last component. The \
                derivatives are those of the divided coordinates.",
            ),
            Self::TextureProjGradOffset => (
                &["channel", "p", "ddx", "ddy", "offset"],
                "Like `textureProjGrad`, moved by `offset` texels: constants from -8 to 7.",
            ),
            Self::DFdx => (
                &["x"],
                "The change of `x` to the neighboring pixel in x, within the block of 2×2 pixels. Undefined \
                in control flow that differs between neighboring pixels.",
            ),
            Self::DFdy => (
                &["x"],
                "The change of `x` to the neighboring pixel in y, within the block of 2×2 pixels. Undefined \
                in control flow that differs between neighboring pixels.",
            ),
            Self::Fwidth => (
                &["x"],
                "`abs(dFdx(x)) + abs(dFdy(x))`: how much `x` changes over a pixel. Undefined in control \
                flow that differs between neighboring pixels.",
            ),
        }
    }
}
