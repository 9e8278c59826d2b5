//! Codes of warnings about the text of a shader.

macro_rules! lints {
    ($($before:tt)*) => { codes! { $($before)*
    /// GLSL reserves names that contain two consecutive underscores. Such a name works today, but may get a
    /// meaning in a later version.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float my__value(float x) { return x; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float my_value(float x) { return x; }
    /// ```
    ReservedName "W0001" "A reserved name",

    /// The directive has no effect and can be removed. The features of most WebGL 1 extensions are part of
    /// GLSL ES 3.00.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #extension GL_OES_standard_derivatives : enable
    /// vec2 slope(float x) { return vec2(dFdx(x), dFdy(x)); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// vec2 slope(float x) { return vec2(dFdx(x), dFdy(x)); }
    /// ```
    UnknownExtension "W0002" "An unsupported extension that is enabled",

    /// On every path to this place, the variable has no value. WebGL initializes variables to 0, so the image
    /// on ShaderToy may look right; other hosts leave an arbitrary value. Components and members count
    /// separately: `v.x = 1.0;` leaves `v.y` uninitialized. An `out` parameter has no value until the
    /// function assigns it. A global variable that is never assigned is uninitialized, too.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 sum;
    ///     for (int i = 0; i < 4; i++) {
    ///         sum += vec3(p, i) / iResolution;
    ///     }
    ///     c = vec4(sum / 4.0, 1.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 sum = vec3(0.0);
    ///     for (int i = 0; i < 4; i++) {
    ///         sum += vec3(p, i) / iResolution;
    ///     }
    ///     c = vec4(sum / 4.0, 1.0);
    /// }
    /// ```
    Unwritten "W0003" "A variable that is used uninitialized",

    /// Some paths to this place assign the variable and others do not, and while the shader ran, a pixel took
    /// one of the others. WebGL initializes variables to 0; other hosts leave an arbitrary value. Initialize
    /// the variable at its declaration.
    ///
    /// A path that no pixel takes is not reported, because many correct shaders read a hit record only if a
    /// flag is set. W0004 is therefore reported only by commands that evaluate the shader, such as `check`.
    /// `// toyproof: allow(W0004)` at the read suppresses it. A read that no assignment can precede is W0003;
    /// a read whose position is unknown is W0604.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float pdf;
    ///     if (p.x > 100.0) {
    ///         pdf = 0.5;
    ///     }
    ///     c = vec4(pdf);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float pdf = 1.0;
    ///     if (p.x > 100.0) {
    ///         pdf = 0.5;
    ///     }
    ///     c = vec4(pdf);
    /// }
    /// ```
    MaybeUnwritten "W0004" "A variable that may be used uninitialized",

    /// `fract(sin(x) * 43758.5453)` keeps only the digits of the sine on which drivers disagree: Vulkan
    /// allows an absolute error of 2^-11, and the factor magnifies it beyond the range from 0 to 1. The noise
    /// looks similar on most GPUs, but is not identical on any two of them. An integer hash gives the same
    /// result everywhere.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float random(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }
    /// void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(random(p)), 1.0); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// uint hash(uint h) {
    ///     h = (h ^ (h >> 16)) * 0x7feb352du;
    ///     h = (h ^ (h >> 15)) * 0x846ca68bu;
    ///     return h ^ (h >> 16);
    /// }
    /// float random(vec2 p) {
    ///     uint h = hash(floatBitsToUint(p.x) ^ hash(floatBitsToUint(p.y)));
    ///     return float(h >> 8) / 16777216.0;
    /// }
    /// void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(random(p)), 1.0); }
    /// ```
    SineHash "W0005" "A hash of `sin`, which differs between GPUs",

    /// `dFdx`, `dFdy` and `fwidth` compare a value with that of neighboring pixels in a block of 2×2. After
    /// an `if`, a loop or a `return` that the neighbors may take differently, the result is undefined:
    /// speckles appear along edges and differ between GPUs. WGSL rejects such shaders. Compute the derivative
    /// before the control flow diverges, and keep it in a variable.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(0.0);
    ///     if (p.x > 100.0) {
    ///         c = vec4(fwidth(p.x * p.y));
    ///     }
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float width = fwidth(p.x * p.y);
    ///     c = vec4(0.0);
    ///     if (p.x > 100.0) {
    ///         c = vec4(width);
    ///     }
    /// }
    /// ```
    Derivative "W0006" "A derivative in non-uniform control flow",

    /// `texture` selects the mip level from the distance to the texture coordinates of neighboring pixels.
    /// After an `if`, a loop or a `return` that the neighbors may take differently, the level is undefined.
    /// With mipmaps, which ShaderToy enables for images by default, blurred or sharp pixels then appear along
    /// edges. WGSL rejects such shaders. Sample the texture before the control flow diverges, or give the
    /// level with `textureLod`.
    ///
    /// The warning is limited to cases that can affect the image: the coordinates themselves are computed in
    /// non-uniform control flow, such as along rays of different length. If the coordinates are the same
    /// function of the pixel everywhere, as in `if (p.x > 100.0) c = texture(iChannel0, p /
    /// iResolution.xy);`, drivers find the right level, but WGSL still rejects the shader.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec2 at = p / iResolution.xy;
    ///     c = vec4(0.0);
    ///     for (int i = 0; i < 9; i++) {
    ///         at *= 1.1;
    ///         c += texture(iChannel0, at) / 9.0;
    ///         if (c.x > 0.5) {
    ///             break;
    ///         }
    ///     }
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec2 at = p / iResolution.xy;
    ///     c = vec4(0.0);
    ///     for (int i = 0; i < 9; i++) {
    ///         at *= 1.1;
    ///         c += textureLod(iChannel0, at, 0.0) / 9.0;
    ///         if (c.x > 0.5) {
    ///             break;
    ///         }
    ///     }
    /// }
    /// ```
    ImplicitLod "W0007" "An implicit level of detail in non-uniform control flow",

    /// lavapipe before Mesa 23 stops all loops of a pixel after 65,535 iterations in total and continues as
    /// if they had ended. Iterations are counted from constant bounds, including nested loops and loops in
    /// called functions; a `break` may end a loop earlier. A loop that counts away from its bound, such as
    /// with `i--` instead of `i++`, runs through all integers.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(0.0);
    ///     for (int i = 0; i < 300; i++) {
    ///         for (int j = 0; j < 300; j++) {
    ///             c += vec4(sin(float(i * j) + p.x)) / 90000.0;
    ///         }
    ///     }
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(0.0);
    ///     for (int i = 0; i < 100; i++) {
    ///         for (int j = 0; j < 100; j++) {
    ///             c += vec4(sin(float(i * j) + p.x)) / 10000.0;
    ///         }
    ///     }
    /// }
    /// ```
    LongLoop "W0008" "Loops that may exceed the iteration limit of older drivers",

    /// The condition is always true, or the loop does not change any variable in it, and no `break` or
    /// `return` leaves the loop. Browsers stop such a shader, and the page with it.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float t = 0.0;
    ///     while (t < 10.0) {
    ///         c = vec4(t);
    ///     }
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float t = 0.0;
    ///     while (t < 10.0) {
    ///         c = vec4(t);
    ///         t += 1.0;
    ///     }
    /// }
    /// ```
    EndlessLoop "W0009" "An infinite loop",

    /// The statement has no effect. A built-in function returns its result and does not change its arguments,
    /// so the result must be assigned. `==` compares; `=` assigns.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 d = vec3(p, -2.0);
    ///     normalize(d);
    ///     c = vec4(d, 1.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 d = vec3(p, -2.0);
    ///     d = normalize(d);
    ///     c = vec4(d, 1.0);
    /// }
    /// ```
    UnusedResult "W0010" "An unused result",
    } };
}
