//! Codes of the grammar (GLSL ES 3.00.6 §3 and §9).

macro_rules! grammar {
    ($($before:tt)*) => { codes! { $($before)*
    /// Something is missing, or something is in the wrong place. Also look at the code just before the
    /// reported position: a missing `;`, `)` or operator is only noticed at the next token.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float area(float r) {
    ///     float square = r * r
    ///     return 3.14159 * square;
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float area(float r) {
    ///     float square = r * r;
    ///     return 3.14159 * square;
    /// }
    /// ```
    Syntax "E0100" "A syntax error",

    /// WebGL allows structures to nest 4 levels deep. toyproof allows 256 levels of nested statements,
    /// parentheses, calls and `?:`; long sums and long chains of `else if` do not count.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// struct A { float x; };
    /// struct B { A a; };
    /// struct C { B b; };
    /// struct D { C c; };
    /// struct E { D d; };
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// struct A { float x; };
    /// struct B { A a; };
    /// struct C { B b; };
    /// struct D { C c; };
    /// ```
    TooDeep "E0101" "Nesting that is too deep",

    /// A float has a decimal point or an exponent: `1.0`, `.5`, `2e3`, `1.0f`. An integer has neither: `1`,
    /// `0x1F`, `1u`. An integer that begins with 0 is octal, so `09` is invalid; `1f` is invalid because it
    /// has no decimal point.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// const float radius = 1f;
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// const float radius = 1.0;
    /// ```
    BadNumber "E0102" "A malformed number",

    /// An `int` or `uint` has 32 bits. The largest integer literal is 4294967295.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// const uint SEED = 99999999999u;
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// const uint SEED = 999999999u;
    /// ```
    NumberRange "E0103" "An integer out of range",

    /// GLSL reserves many words for future use: `input`, `output`, `half`, `double`, `sample`, `filter`,
    /// `common`, `active`, `attribute`, `varying`, `goto`, `this` and others. Choose a different name.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// vec4 blur(vec2 sample) { return vec4(sample, 0.0, 1.0); }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// vec4 blur(vec2 uv) { return vec4(uv, 0.0, 1.0); }
    /// ```
    ReservedWord "E0104" "A reserved word",

    /// A `(`, `[` or `{` has no matching closing bracket, or the reverse. If several positions are possible,
    /// indentation decides: a block is assumed to end before the next line that is not indented further than
    /// the block's first line.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 color, in vec2 p) {
    ///     color = vec4(0.0);
    ///     if (p.x > 100.0) {
    ///         color.r = 1.0;
    ///     color.g = 1.0;
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 color, in vec2 p) {
    ///     color = vec4(0.0);
    ///     if (p.x > 100.0) {
    ///         color.r = 1.0;
    ///     }
    ///     color.g = 1.0;
    /// }
    /// ```
    Unclosed "E0105" "An unbalanced bracket",
    } };
}
