//! Codes of further rules (GLSL ES 3.00.6 §4.3, §5.8 and §6), and of limits.

macro_rules! rules {
    ($($before:tt)*) => { codes! { $($before)*
    /// Constants, uniforms (`iTime`, `iResolution`, `iMouse` and so on), shader inputs and `const` parameters
    /// cannot be changed. Copy the value to a local variable and change the copy.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float later() { iTime += 1.0; return iTime; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float later() { float time = iTime + 1.0; return time; }
    /// ```
    NotWritable "E0400" "An assignment to a read-only value",

    /// In WebGL 2, the initializers of global variables and of `const` variables are constant expressions:
    /// numbers, other constants, and built-in functions of them. Uniforms and calls of your own functions are
    /// not constant; assign such a global in `mainImage` instead. `--lenient` accepts any initializer of a
    /// global, as desktop GLSL does.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float speed = 2.0 * iTime;
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float speed() { return 2.0 * iTime; }
    /// ```
    NotConstant "E0401" "A value that must be a constant expression",

    /// A constant cannot be assigned later, so it needs an initializer.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// const float PI;
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// const float PI = 3.14159265;
    /// ```
    Uninitialized "E0402" "A `const` without a value",

    /// `uniform`, `in`, `out`, `flat` and `layout` qualify global variables; `in`, `out`, `inout` and `const
    /// in` qualify parameters; `const` qualifies variables; `highp`, `mediump` and `lowp` qualify numeric
    /// types. The order is fixed: `const`, then `in`, then `highp`. Interface blocks are not supported, since
    /// ShaderToy binds none.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float time() { uniform float t; return t; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// uniform float t;
    /// float time() { return t; }
    /// ```
    BadQualifier "E0403" "An invalid qualifier",

    /// GLSL does not support recursion: no function may call itself, directly or through other functions. Use
    /// a loop. To follow a reflected ray, for example, continue with the reflected ray in the next iteration.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float factorial(float n) { return n < 2.0 ? 1.0 : n * factorial(n - 1.0); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float factorial(float n) {
    ///     float product = 1.0;
    ///     for (float i = 2.0; i <= n; i++) product *= i;
    ///     return product;
    /// }
    /// ```
    Recursion "E0404" "A recursive function",

    /// A prototype declares a function. A definition with the same parameter types and a body must follow.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float noise(vec2 p);
    /// float clouds(vec2 p) { return noise(p) + noise(2.0 * p); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float noise(vec2 p);
    /// float clouds(vec2 p) { return noise(p) + noise(2.0 * p); }
    /// float noise(vec2 p) { return fract(p.x * 7.3 + p.y * 3.7); }
    /// ```
    Undefined "E0405" "A function that is called but not defined",

    /// Overloads are distinguished by the types of their parameters. Rename one of the two functions.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float value(float x) { return x; }
    /// vec2 value(float x) { return vec2(x); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float value(float x) { return x; }
    /// vec2 values(float x) { return vec2(x); }
    /// ```
    BadOverload "E0406" "Overloads that differ only in return type or qualifiers",

    /// The value of a `switch` is an `int` or `uint`. Labels are directly inside the `switch`, each value and
    /// `default` at most once, and a statement follows the last label. At most 20,000 labels are allowed:
    /// lavapipe loses the device at 50,000.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float pick(int i) {
    ///     switch (i) {
    ///         case 0: return 1.0;
    ///         case 0: return 2.0;
    ///         default: return 3.0;
    ///     }
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float pick(int i) {
    ///     switch (i) {
    ///         case 0: return 1.0;
    ///         case 1: return 2.0;
    ///         default: return 3.0;
    ///     }
    /// }
    /// ```
    BadSwitch "E0407" "An invalid `switch` or label",

    /// `break` leaves the innermost loop or `switch`; `continue` starts the next iteration of the innermost
    /// loop. To leave a function, use `return`.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float positive(float x) { if (x > 0.0) break; return 0.0; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float positive(float x) { if (x > 0.0) return x; return 0.0; }
    /// ```
    MisplacedJump "E0408" "A `break` or `continue` outside a loop",

    /// ShaderToy calls `void mainImage(out vec4 fragColor, in vec2 fragCoord)` for each pixel. The names of
    /// the parameters are free; their types and `out` are not.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec3 color, in vec2 p) { color = vec3(p / iResolution.xy, 0.0); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 color, in vec2 p) { color = vec4(p / iResolution.xy, 0.0, 1.0); }
    /// ```
    NoMainImage "E0409" "A missing or invalid `mainImage`",

    /// Parsing the shader, translating it or compiling it for the evaluator exceeded `--timeout`, and the
    /// verdict is `timeout`. Each of these steps takes time in proportion to the size of the shader, so this
    /// affects generated code or a busy machine. Shorten the longest expressions, arrays and functions, or
    /// raise the limit with `--timeout 60s` (for `trade`, `--budget 60s`).
    TooSlow "E0410" "A shader that takes too long to compile",

    /// lavapipe inlines all calls and keeps the enclosing conditions and loops of a pixel on stacks of 80
    /// entries; deeper nesting renders wrong pixels. toyproof rewrites deeper nesting, except for more than
    /// 72 nested loops or conditional calls. Such a shader does not run on a driver, and its verdict is
    /// `invalid`; `--device cpu` evaluates it, and `convert` translates it. Only generated code is affected:
    /// divide it into consecutive steps.
    TooDeepToRun "E0411" "Control flow nested too deeply for drivers",

    /// ShaderToy also compiles Common alone, with the inputs `iDate` and `iSampleRate` only, so that a
    /// function in Common cannot use another one, even if all other tabs compile. Pass the input as an
    /// argument, or use it in a macro, which is expanded in the other tabs. Sound has no `iTime`,
    /// `iResolution`, `iFrame` and `iMouse`. See [projects](projects.md).
    ///
    /// Wrong:
    ///
    /// ```glsl common
    /// float wave(float x) { return sin(x + iTime); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl common
    /// float wave(float x, float time) { return sin(x + time); }
    /// #define WAVE(x) wave(x, iTime)
    /// ```
    InputOfOtherTab "E0412" "An input that the tab of a project does not have",

    /// A page with WebGL compiles a shader without `#version` as GLSL ES 1.00, which has no operators on bits,
    /// no remainder `%`, no suffixes of numbers, and no arrays as values. Begin the shader with
    /// `#version 300 es`, for which the page must use WebGL 2, or write it otherwise: `mod` on floats for `%`.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// precision highp float;
    /// void main() {
    ///     int stripe = int(gl_FragCoord.x) % 2;
    ///     gl_FragColor = vec4(float(stripe));
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// precision highp float;
    /// void main() {
    ///     float stripe = mod(floor(gl_FragCoord.x), 2.0);
    ///     gl_FragColor = vec4(stripe);
    /// }
    /// ```
    NotInVersion "E0413" "A feature that the version of GLSL does not have",

    /// toyproof has the four texture channels of ShaderToy. The textures of another host are read from them:
    /// those of known names, such as `u_tex0`, from the channel of their number, and others from the next free
    /// one. A fifth texture has none. Combine textures in one image, or leave out what the image does not need.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// uniform sampler2D a, b, c, d, e;
    /// void main() { gl_FragColor = texture2D(a, vec2(0)) + texture2D(e, vec2(0)); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// uniform sampler2D a;
    /// void main() { gl_FragColor = texture2D(a, vec2(0)) + texture2D(a, vec2(1)); }
    /// ```
    NoChannelLeft "E0414" "A texture for which no channel is left",
    } };
}
