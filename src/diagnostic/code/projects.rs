//! Codes of warnings about `allow` comments, functions, and the inputs of projects.

macro_rules! projects {
    ($($before:tt)*) => { codes! { $($before)*
    /// The comment `// toyproof: allow(W0005)` suppresses a warning. At the end of a line, it applies to that
    /// line; on a line of its own, to the next statement, declaration or directive as a whole; before all
    /// code, to the whole file. Separate several codes with commas. Text after the `)` can give a reason.
    /// Errors cannot be suppressed.
    ///
    /// Warnings that arise while the shader runs (W0600 to W0613) are suppressed by their line in the same
    /// way; those without a line, such as W0601, by an `allow` anywhere. Whether such an `allow` is needed is
    /// not checked.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// // toyproof: allow(W9999)
    /// void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0.0, 1.0); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float random(float x) {
    ///     return fract(sin(x) * 43758.5453); // toyproof: allow(W0005) the course uses this hash
    /// }
    /// void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(random(p.x)), 1.0); }
    /// ```
    BadAllow "W0014" "A malformed `allow` comment",

    /// The warning does not occur where the comment applies: the shader was corrected, the code is wrong, or
    /// the comment is on the wrong line. Remove the comment, so that it cannot hide a later warning.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(p, 0.0, 1.0); // toyproof: allow(W0010)
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(p, 0.0, 1.0);
    /// }
    /// ```
    UnusedAllow "W0015" "An unused `allow` comment",

    /// If a function with a return type reaches its last `}`, its result is undefined: WebGL returns 0, and
    /// other hosts return an arbitrary value. A function without any `return` is an error (E0308), as in
    /// browsers. A chain of comparisons of one value with constants, such as `id == 1`, `id == 2`, is assumed
    /// to be exhaustive.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float step_of(float x) {
    ///     if (x > 0.5) {
    ///         return 1.0;
    ///     }
    /// }
    /// void mainImage(out vec4 c, in vec2 p) { c = vec4(step_of(p.x / iResolution.x)); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float step_of(float x) {
    ///     if (x > 0.5) {
    ///         return 1.0;
    ///     }
    ///     return 0.0;
    /// }
    /// void mainImage(out vec4 c, in vec2 p) { c = vec4(step_of(p.x / iResolution.x)); }
    /// ```
    MissingReturn "W0016" "A function that may reach its end without a `return`",

    /// Lints may use a quarter of `--timeout`. If that is not enough, they report nothing, and this note
    /// takes their place. The verdict does not depend on lints. Raise the limit with `--timeout 60s`.
    LintTimeout "W0017" "Lints that exceeded their time limit",

    /// ShaderToy reads black from a buffer or cube map that the project does not have. Add the tab, or remove
    /// the input.
    ///
    /// Wrong:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "image"
    /// inputs = [{ channel = 0, source = "buffer-a" }]
    /// ```
    ///
    /// Right:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "buffer-a"
    ///
    /// [[pass]]
    /// tab = "image"
    /// inputs = [{ channel = 0, source = "buffer-a" }]
    /// ```
    MissingPass "W0018" "An input that reads a pass that does not exist",

    /// On ShaderToy a sampler belongs to the texture, not to the input. If two inputs of one pass read one
    /// buffer with different filters, the filter of the higher channel is used for both; the wrap mode of a
    /// buffer is that of the last input of all passes. Use one sampler for each buffer, and `texelFetch`
    /// where no filter is wanted.
    ///
    /// Wrong:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "buffer-a"
    ///
    /// [[pass]]
    /// tab = "image"
    /// inputs = [
    ///     { channel = 0, source = "buffer-a", sampler = { filter = "nearest" } },
    ///     { channel = 1, source = "buffer-a", sampler = { filter = "linear" } },
    /// ]
    /// ```
    ///
    /// Right:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "buffer-a"
    ///
    /// [[pass]]
    /// tab = "image"
    /// inputs = [{ channel = 0, source = "buffer-a", sampler = { filter = "linear" } }]
    /// ```
    SamplerConflict "W0019" "Different samplers of one buffer",

    /// Buffers run in the order of the file. A buffer that runs later is read as it was in the previous
    /// frame, one that ran before as it is in this frame. Most projects list their buffers by name; another
    /// order is easily overlooked. `// toyproof: allow` does not apply to it: order the passes, or accept the
    /// warning.
    ///
    /// Wrong:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "buffer-b"
    ///
    /// [[pass]]
    /// tab = "buffer-a"
    /// inputs = [{ channel = 0, source = "buffer-b" }]
    ///
    /// [[pass]]
    /// tab = "image"
    /// ```
    ///
    /// Right:
    ///
    /// ```toml project
    /// [[pass]]
    /// tab = "buffer-a"
    /// inputs = [{ channel = 0, source = "buffer-b" }]
    ///
    /// [[pass]]
    /// tab = "buffer-b"
    ///
    /// [[pass]]
    /// tab = "image"
    /// ```
    BufferOrder "W0020" "Buffers that do not run in the order of their names",

    /// GLSL leaves the result of `smoothstep(edge0, edge1, x)` undefined unless `edge0 < edge1`. With
    /// reversed edges most drivers compute the formula nevertheless, which then falls from 1 to 0, and
    /// toyproof's evaluator does the same. A driver may do otherwise, and so does the compiler of a constant
    /// expression. `1.0 - smoothstep(edge1, edge0, x)` has the same value everywhere. With equal edges the
    /// formula divides by zero: write `step(edge, x)`.
    ///
    /// The warning is given only where the order is certain: for constants, and for edges whose difference is
    /// a sum of values that are never negative, such as `r + fwidth(d)` and `r`, or `2.0 / iResolution.y` and
    /// `0.0`.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float disk(vec2 p, float radius) { return smoothstep(radius, radius - 0.01, length(p)); }
    ///
    /// void mainImage(out vec4 color, in vec2 at) {
    ///     vec2 p = at / iResolution.y - 0.5;
    ///     color = vec4(vec3(disk(p, 0.3)), 1.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float disk(vec2 p, float radius) { return 1.0 - smoothstep(radius - 0.01, radius, length(p)); }
    ///
    /// void mainImage(out vec4 color, in vec2 at) {
    ///     vec2 p = at / iResolution.y - 0.5;
    ///     color = vec4(vec3(disk(p, 0.3)), 1.0);
    /// }
    /// ```
    ReversedEdges "W0021" "A `smoothstep` whose first edge is not less than the second",

    /// The shader defines a function, but neither `mainImage` nor a function that it calls uses it: what the
    /// function computes is missing in the image, or the function is not needed. A call in a comment is not
    /// one.
    ///
    /// Not reported are functions of Common, which other tabs may call, overloads of a function that is
    /// called, functions that the site calls (`mainVR`, `mainSound`), and names that occur in a branch of
    /// `#if` that is not compiled, or in a macro. Of more than three such functions, which are a library, one
    /// warning names all.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float shadow(vec2 p) { return step(0.5, p.x); }
    ///
    /// void mainImage(out vec4 color, in vec2 at) {
    ///     vec2 p = at / iResolution.xy;
    ///     color = vec4(vec3(p.y), 1.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float shadow(vec2 p) { return step(0.5, p.x); }
    ///
    /// void mainImage(out vec4 color, in vec2 at) {
    ///     vec2 p = at / iResolution.xy;
    ///     color = vec4(vec3(p.y) * shadow(p), 1.0);
    /// }
    /// ```
    Uncalled "W0022" "A function that is never called",

    /// `1 / 3` divides integers, and is 0. A constructor converts the quotient only after its fraction is
    /// lost: `float(1 / 3)` and `vec3(1 / 2, 0, 0)` are 0. Only quotients of two numbers are reported,
    /// because `float(n / 2)` may be meant.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float cubeRoot(float x) { return pow(x, float(1 / 3)); }
    ///
    /// void mainImage(out vec4 color, in vec2 at) {
    ///     color = vec4(vec3(cubeRoot(at.x / iResolution.x)), 1.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float cubeRoot(float x) { return pow(x, 1.0 / 3.0); }
    ///
    /// void mainImage(out vec4 color, in vec2 at) {
    ///     color = vec4(vec3(cubeRoot(at.x / iResolution.x)), 1.0);
    /// }
    /// ```
    IntegerDivision "W0023" "A division of integers whose fraction is lost",

    /// A shader may declare uniforms and, with `in`, inputs of its own, but ShaderToy sets only its own:
    /// `iTime`, `iResolution` and so on. All others are 0, and samplers are black. Such a declaration is
    /// often left over from another program.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// uniform float speed;
    /// void mainImage(out vec4 color, in vec2 position) {
    ///     color = vec4(fract(speed * iTime));
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// const float speed = 0.5;
    /// void mainImage(out vec4 color, in vec2 position) {
    ///     color = vec4(fract(speed * iTime));
    /// }
    /// ```
    UnsetUniform "W0030" "A uniform that nothing sets",

    /// WebGL 1 unrolls loops on old hardware, so its shaders, in GLSL ES 1.00, have only `for` loops with a
    /// constant number of iterations, and arrays are indexed only by constants and the counters of such loops
    /// (Appendix A). toyproof runs others as well; browsers refuse them. Leave a loop early with `break`. The
    /// derivatives `dFdx`, `dFdy` and `fwidth` need `#extension GL_OES_standard_derivatives : enable`.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// precision highp float;
    /// void main() {
    ///     float sum = 0.0;
    ///     while (sum < gl_FragCoord.x) sum += 9.0;
    ///     gl_FragColor = vec4(sum / 640.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// precision highp float;
    /// void main() {
    ///     float sum = 0.0;
    ///     for (int i = 0; i < 200; i++) {
    ///         if (sum >= gl_FragCoord.x) break;
    ///         sum += 9.0;
    ///     }
    ///     gl_FragColor = vec4(sum / 640.0);
    /// }
    /// ```
    BeyondAppendixA "W0031" "A loop, an index or a derivative that WebGL 1 refuses",

    /// `--uniform NAME=VALUE` sets a uniform that the shader declares, such as `uniform float speed;`. The
    /// shader declares no uniform of this name, so the value has no effect: the name may be misspelled.
    UndeclaredUniform "W0032" "A value of a uniform that the shader does not declare",
    } };
}
