//! Codes of the preprocessor (GLSL ES 3.00.6 §3).

macro_rules! preprocessor {
    ($($before:tt)*) => { codes! { $($before)*
    /// Outside comments, GLSL source is ASCII. Characters copied from web pages and word processors may look
    /// right and still be invalid: curly quotes, long dashes, `×`, non-breaking spaces. `"` and `'` do not
    /// occur in GLSL, which has no strings.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float twice(float x) { return 2.0 × x; }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float twice(float x) { return 2.0 * x; }
    /// ```
    UnknownCharacter "E0001" "An invalid character",

    /// A comment that begins with `/*` ends at the next `*/`, which may be many lines below. Such comments do
    /// not nest.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float half_of(float x) { return 0.5 * x; } /* the rest
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float half_of(float x) { return 0.5 * x; } /* the rest */
    /// ```
    UnterminatedComment "E0002" "An unterminated comment",

    /// A line that begins with `#` is a preprocessor directive: `#define`, `#undef`, `#if`, `#ifdef`,
    /// `#ifndef`, `#elif`, `#else`, `#endif`, `#error`, `#pragma`, `#extension`, `#version` or `#line`, and
    /// `#include` in files.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #constant WIDTH 0.1
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #define WIDTH 0.1
    /// ```
    UnknownDirective "E0003" "An unknown preprocessor directive",

    /// A part of the directive is missing, or there is text after its end. The forms are `#ifdef NAME`,
    /// `#undef NAME`, `#define NAME value` and `#define NAME(a, b) value`.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #ifdef
    /// #endif
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #ifdef GL_ES
    /// #endif
    /// ```
    MalformedDirective "E0004" "A malformed directive",

    /// The condition is evaluated before the shader is compiled. It is an integer constant expression of
    /// integers, macros that expand to integers, and `defined(NAME)`. Variables and floats are not allowed,
    /// and a name that is not a macro is an error in GLSL ES, whereas C treats it as 0.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// const int STEPS = 4;
    /// #if STEPS > 2
    /// #endif
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #define STEPS 4
    /// #if STEPS > 2
    /// #endif
    /// ```
    BadCondition "E0005" "An invalid condition of `#if` or `#elif`",

    /// Each `#if`, `#ifdef` and `#ifndef` needs a matching `#endif`. `#elif` and `#else` go between the two;
    /// after `#else`, only `#endif` may follow.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #ifdef FAST
    /// const int STEPS = 8;
    /// #else
    /// const int STEPS = 80;
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #ifdef FAST
    /// const int STEPS = 8;
    /// #else
    /// const int STEPS = 80;
    /// #endif
    /// ```
    UnbalancedCondition "E0006" "Unbalanced conditional directives",

    /// A macro cannot be defined a second time with a different value; write `#undef` first. Names that begin
    /// with `GL_`, and predefined macros such as `__LINE__`, cannot be defined or undefined. The parameters
    /// of a macro must have different names.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #define STEPS 8
    /// #define STEPS 80
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #define STEPS 8
    /// #undef STEPS
    /// #define STEPS 80
    /// ```
    BadMacro "E0007" "An invalid definition of a macro",

    /// A function-like macro takes as many arguments as it has parameters, and its call ends with `)`. A
    /// comma inside inner parentheses does not separate arguments: `F(vec2(1, 2))` has one argument.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #define ROTATE(a) mat2(cos(a), sin(a), -sin(a), cos(a))
    /// mat2 turn(float x, float y) { return ROTATE(x, y); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #define ROTATE(a) mat2(cos(a), sin(a), -sin(a), cos(a))
    /// mat2 turn(float x, float y) { return ROTATE(x + y); }
    /// ```
    BadMacroCall "E0008" "An invalid use of a macro",

    /// In C, macros can join names with `##` and make strings with `#`. GLSL ES has neither operator. A `#`
    /// that begins a directive must be the first character of its line, apart from white space.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #define SDF(name) float sd##name(vec3 p) { return length(p) - 1.0; }
    /// SDF(Sphere)
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #define SDF(name) float name(vec3 p) { return length(p) - 1.0; }
    /// SDF(sdSphere)
    /// ```
    PasteOperator "E0009" "`#` or `##` in a macro, which GLSL ES does not have",

    /// The preprocessor reached an `#error`, which the author wrote to stop compilation in this case. The
    /// message is the rest of the line.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #ifndef STEPS
    /// #error STEPS is not defined
    /// #endif
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #define STEPS 80
    /// #ifndef STEPS
    /// #error STEPS is not defined
    /// #endif
    /// ```
    ErrorDirective "E0010" "An `#error` directive",

    /// ShaderToy compiles shaders as `#version 300 es`. The directive is optional; if it is present, it must
    /// have this version and come before any other code.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #version 330 core
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #version 300 es
    /// ```
    BadVersion "E0011" "An unsupported `#version`",

    /// No extensions are supported. The features of most WebGL 1 extensions (derivatives, `textureLod`) are
    /// part of GLSL ES 3.00.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #extension GL_EXT_gpu_shader4 : require
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// vec2 slope(float x) { return vec2(dFdx(x), dFdy(x)); }
    /// ```
    BadExtension "E0012" "An unsupported extension that is required",

    /// Macros that use each other repeatedly grow exponentially. All macros of a shader together may expand
    /// to about one million tokens, and calls in arguments may nest 256 deep. Replace the largest macro with
    /// a function.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #define A(x) x x x x x x x x x x x x x x x x
    /// #define B(x) A(A(A(A(A(x)))))
    /// void f() { B(;) }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #define A(x) x x x x x x x x x x x x x x x x
    /// #define B(x) A(A(x))
    /// void f() { B(;) }
    /// ```
    TooMuchExpansion "E0013" "A macro expansion that is too large",

    /// The text of a file replaces `#include "file"`. The path is relative to the file with the directive, to
    /// the folder of the shader, or to a folder that `--include-dir` names, and leads to a file in one of
    /// these folders. Files that include each other need a guard.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// #include "/usr/share/noise.glsl"
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// #ifndef NOISE
    /// #define NOISE
    /// float noise(vec2 at) { return fract(at.x * at.y); }
    /// #endif
    /// ```
    BadInclude "E0014" "An included file that cannot be read",
    } };
}
