//! Codes of names and types (GLSL ES 3.00.6 §4 and §5).

macro_rules! types {
    ($($before:tt)*) => { codes! { $($before)*
    /// A name is visible from its declaration to the end of the enclosing block. A function must be declared
    /// before its first call, if need be by a prototype such as `float f(float x);`. Names from HLSL and from
    /// older versions of GLSL are not available: use `mix` for `lerp`, `fract` for `frac`, `clamp(x, 0.0,
    /// 1.0)` for `saturate(x)`, `atan(y, x)` for `atan2(y, x)` and `texture` for `texture2D`.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// vec3 fade(vec3 a, vec3 b, float t) { return lerp(a, b, t); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// vec3 fade(vec3 a, vec3 b, float t) { return mix(a, b, t); }
    /// ```
    Undeclared "E0200" "An undeclared name",

    /// A name can be declared once in each block; the parameters of a function belong to the block of its
    /// body. An inner block may declare the name again. ShaderToy's inputs (`iTime`, `iResolution` and so on)
    /// and the built-in functions are declared already, and names that begin with `gl_` are reserved.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// uniform float iTime;
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float seconds() { return iTime; }
    /// ```
    Redeclared "E0201" "A redeclared name",

    /// Types, functions and variables share one namespace. A variable hides a function of the same name,
    /// which then cannot be called.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float scale(float x) { return 2.0 * x; }
    /// float twice(float x) { return scale * x; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float scale(float x) { return 2.0 * x; }
    /// float twice(float x) { return scale(x); }
    /// ```
    NotAVariable "E0202" "A type or function used as a variable, or the reverse",

    /// The components of a vector are `.xyzw`, `.rgba` or `.stpq`. A swizzle has one to four letters, all
    /// from one of these sets, and selects only components that the vector has. An array has no members
    /// except `.length()`.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float depth(vec2 p) { return p.z; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float depth(vec3 p) { return p.z; }
    /// ```
    UnknownMember "E0203" "An unknown member or an invalid swizzle",

    /// Arithmetic operators take two operands of the same type, or a scalar and a vector or matrix with the
    /// same scalar type. WebGL 2 has no implicit conversions: with a `float x`, write `2.0 * x` instead of `2
    /// * x`. `%`, `&`, `|`, `^`, `<<` and `>>` take integers; `&&`, `||` and `!` take `bool` values; `<` and
    /// `>` take scalars.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// vec3 dim(vec3 color) { return color / 2; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// vec3 dim(vec3 color) { return color / 2.0; }
    /// ```
    BadOperands "E0300" "Invalid operands of an operator",

    /// WebGL 2 has no implicit conversions, neither from `int` to `float` nor from `vec4` to `vec3`. Write
    /// `1.0` instead of `1`, `float(i)` for an integer `i`, and `v.xyz` for the first three components. Some
    /// desktop drivers accept `float x = 1;`, as does `--lenient`; browsers do not.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float one() { float x = 1; return x; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float one() { float x = 1.0; return x; }
    /// ```
    Mismatch "E0301" "Mismatched types",

    /// The number and the types of the arguments must be those of a function with this name. The message
    /// lists the candidates and shows which argument does not match.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float square(float x) { return pow(x, 2); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float square(float x) { return pow(x, 2.0); }
    /// ```
    NoOverload "E0302" "No matching function for a call",

    /// `vec3(…)` takes one scalar for all components, or scalars, vectors and matrices with at least three
    /// components in total. The last argument may have unused components, but no argument may be entirely
    /// unused. The constructor of a structure takes one argument for each member, that of an array one for
    /// each element.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// vec3 up() { return vec3(0.0, 1.0); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// vec3 up() { return vec3(0.0, 1.0, 0.0); }
    /// ```
    BadConstructor "E0303" "Invalid arguments of a constructor",

    /// An index is an `int` or `uint` from 0 to the number of elements minus one: the last element of `float
    /// a[3]` is `a[2]`. Only arrays, vectors and matrices can be indexed.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float last(float a[3]) { return a[3]; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float last(float a[3]) { return a[2]; }
    /// ```
    BadIndex "E0304" "An invalid index",

    /// The size of an array is an integer constant expression of at least 1, such as a number or a `const
    /// int`. It can be omitted if the array has an initializer. WebGL limits an array to 65,536 elements and
    /// a variable to 16 MB.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float sum(int n) { float values[n]; return values[0]; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// const int N = 4;
    /// float sum() { float values[N]; values[0] = 1.0; return values[0]; }
    /// ```
    BadArraySize "E0305" "An invalid array size",

    /// Use one longer array and compute the index, or an array of structures that contain an array.
    /// `--lenient` accepts arrays of arrays, as desktop GLSL does.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float grid[3][3];
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float grid[9];
    /// float cell(int x, int y) { return grid[3 * y + x]; }
    /// ```
    ArrayOfArrays "E0306" "An array of arrays, which GLSL ES 3.00 does not support",

    /// A variable cannot be `void`. A sampler can be a uniform or a parameter, but not a local variable or a
    /// return value. In WebGL 2, the results of `?:` are scalars, vectors or matrices.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// vec4 look(vec2 uv) { sampler2D image; return texture(image, uv); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// vec4 look(sampler2D image, vec2 uv) { return texture(image, uv); }
    /// ```
    BadType "E0307" "A type that is not allowed here",

    /// A function returns a value of the type in front of its name. A `void` function returns no value; every
    /// other function needs a `return` with a value.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float half_of(float x) { x *= 0.5; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float half_of(float x) { return x * 0.5; }
    /// ```
    BadReturn "E0308" "An invalid or missing `return`",
    } };
}
