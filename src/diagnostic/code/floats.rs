//! Codes of warnings about the comparison of floats and about ray–sphere formulas.

macro_rules! floats {
    ($($before:tt)*) => { codes! { $($before)*
    /// Floating-point arithmetic rounds, so two ways to compute the same number rarely give the same bits,
    /// and the bits differ between drivers. Compare with `<`, or with a tolerance that suits the magnitude of
    /// the numbers. Values that are exact are not reported: whole numbers, results of `floor`, and values
    /// that are only copied, such as a `-1.0` that means "no hit".
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float r = length(p / iResolution.xy);
    ///     c = vec4(r == 0.5);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float r = length(p / iResolution.xy);
    ///     c = vec4(abs(r - 0.5) < 0.005);
    /// }
    /// ```
    FloatEquality "W0011" "`==` or `!=` of computed floats",

    /// If the direction d has length 1, then a = dot(d, d) is 1 and can be omitted from t = (-b ± sqrt(b² -
    /// 4ac)) / 2a. With any other direction, the shortened formula misses hits, finds false ones, and returns
    /// wrong distances. It is reported if all directions that reach the formula are known and none of them is
    /// normalized.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float hit(vec3 o, vec3 d, vec3 center, float radius) {
    ///     vec3 f = o - center;
    ///     float b = dot(f, d);
    ///     float c = dot(f, f) - radius * radius;
    ///     float disc = b * b - c;
    ///     return disc > 0.0 ? -b - sqrt(disc) : -1.0;
    /// }
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 d = vec3(p / iResolution.xy - 0.5, -1.0);
    ///     c = vec4(hit(vec3(0.0), d, vec3(0.0, 0.0, -6.0), 1.5));
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float hit(vec3 o, vec3 d, vec3 center, float radius) {
    ///     vec3 f = o - center;
    ///     float b = dot(f, d);
    ///     float c = dot(f, f) - radius * radius;
    ///     float disc = b * b - c;
    ///     return disc > 0.0 ? -b - sqrt(disc) : -1.0;
    /// }
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 d = normalize(vec3(p / iResolution.xy - 0.5, -1.0));
    ///     c = vec4(hit(vec3(0.0), d, vec3(0.0, 0.0, -6.0), 1.5));
    /// }
    /// ```
    UnnormalizedDirection "W0012" "A ray–sphere formula for unit directions with a direction that is not normalized",
    } };
}
