//! Codes of warnings that arise while a shader runs, and of notes about the checks.

macro_rules! runs {
    ($($before:tt)*) => { codes! { $($before)*
    /// Observed while the shader ran: an index out of bounds, an integer division by zero, a shift by 32 bits
    /// or more, a conversion of a float that is out of range of `int`, `smoothstep` with equal edges, `pow`
    /// of a negative base, `min` or `max` of NaN, or a texture lookup at infinite or NaN coordinates. The
    /// result differs between GPUs. Pixels whose color depends on undefined behavior are excluded from the
    /// comparison with the reference, and counted.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 colors[2] = vec3[2](vec3(1.0), vec3(0.5));
    ///     c = vec4(colors[int(p.x / iResolution.x * 3.0)], 1.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec3 colors[2] = vec3[2](vec3(1.0), vec3(0.5));
    ///     c = vec4(colors[int(p.x / iResolution.x * 2.0)], 1.0);
    /// }
    /// ```
    UndefinedOperation "W0600" "An operation with an undefined result",

    /// Observed while the shader ran: the loops of one pixel run more than 65,535 iterations in total.
    /// lavapipe before Mesa 23 silently stops all loops there, and the image is wrong. Reduce the number of
    /// iterations, or distribute the work over several frames.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float sum = 0.0;
    ///     int steps = 70000 + int(p.x);
    ///     for (int i = 0; i < steps; i++) { sum += fract(p.x * float(i)); }
    ///     c = vec4(sum / float(steps));
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float sum = 0.0;
    ///     int steps = 700 + int(p.x);
    ///     for (int i = 0; i < steps; i++) { sum += fract(p.x * float(i)); }
    ///     c = vec4(sum / float(steps));
    /// }
    /// ```
    LongRun "W0601" "Loops that exceed the iteration limit of older drivers",

    /// The algorithm agrees with the reference, but the image in float32 differs visibly from that in double
    /// precision, and this is the line where most of the differing pixels lose their precision. The usual
    /// cause is the difference of two large, nearly equal numbers. Rewrite the formula to compute the small
    /// number from small numbers: for the discriminant of a distant sphere, from the distance between the ray
    /// and the center. The textbook discriminant b² − c, with c = |f|² − r², is a difference of two numbers
    /// near L², the squared distance to the center, and has their error: about 4 u L² (u = 2⁻²⁴). Where it is
    /// smaller, on both sides of the sphere's silhouette, rays hit or miss arbitrarily.
    ///
    /// A large sphere as the ground has a different problem, which no discriminant solves: hit points are up
    /// to about 2 u r off the surface, so shadow rays that accept hits from t = 0.001 hit the ground itself.
    /// Start them above the surface, along its normal.
    ///
    /// `toyproof debug SHADER --pixel X,Y` shows all lines of one pixel, in float32 and in double precision.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// float discriminant(vec3 o, vec3 d, vec3 center, float radius) {
    ///     vec3 f = o - center;
    ///     float b = dot(f, d);
    ///     return b * b - (dot(f, f) - radius * radius);
    /// }
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(discriminant(vec3(0.0), vec3(0.0, 0.0, -1.0), vec3(p / iResolution.xy, -20000.0), 2.5));
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// float discriminant(vec3 o, vec3 d, vec3 center, float radius) {
    ///     vec3 f = o - center;
    ///     vec3 aside = f - dot(f, d) * d;
    ///     return radius * radius - dot(aside, aside);
    /// }
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(discriminant(vec3(0.0), vec3(0.0, 0.0, -1.0), vec3(p / iResolution.xy, -20000.0), 2.5));
    /// }
    /// ```
    LostDigits "W0602" "A loss of precision in float32",

    /// Observed while the shader ran: the color of a pixel is NaN or infinite, and this is where that value
    /// first occurs. ShaderToy shows such a pixel as black or white, and blurs and sums spread it. Check for
    /// roots and logarithms of negative numbers and for divisions by zero.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(sqrt(p.x - 100.0));
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(sqrt(max(p.x - 100.0, 0.0)));
    /// }
    /// ```
    NotFinite "W0603" "A color that is NaN or infinite",

    /// Observed while the shader ran: a pixel reads a variable that it has not assigned. WebGL and toyproof
    /// initialize variables to 0; other implementations leave an arbitrary value. Initialize the variable at
    /// its declaration. If the position of the read is known, W0004 is reported instead; if no path assigns
    /// the variable, W0003.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float light[2];
    ///     light[int(p.x) % 2] = 1.0;
    ///     c = vec4(light[0]);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float light[2] = float[2](0.0, 0.0);
    ///     light[int(p.x) % 2] = 1.0;
    ///     c = vec4(light[0]);
    /// }
    /// ```
    NeverWritten "W0604" "A read of an uninitialized variable",

    /// The shader samples `iChannel0` to `iChannel3`, and its text does not specify what ShaderToy binds to
    /// them. A channel without an image is black. `--channel0 FILE` binds an image, `--channel0
    /// noise` binds noise. Cube maps and volumes are those of a project.
    ///
    /// Wrong:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = texture(iChannel3, p / iResolution.xy);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = vec4(p / iResolution.xy, 0.0, 1.0);
    /// }
    /// ```
    UnboundChannel "W0605" "A channel without an image",

    /// The Vulkan driver did not finish compiling the shader within `--timeout`. How long that takes depends
    /// on the driver and the machine rather than on the shader's correctness, so the shader was evaluated on
    /// the CPU instead. The algorithm and precision checks are complete; the toolchain check is skipped.
    /// Raise the limit with `--timeout 60s`. Fewer large arrays and structures, shorter functions and fewer
    /// calls of them compile faster.
    SlowCompilation "W0606" "A shader that takes the driver too long to compile",

    /// Observed over the frames of a project: a pixel of a buffer became NaN, and NaN is left in the last
    /// frame. Everything that is computed from NaN is NaN, so a buffer that reads itself keeps it forever,
    /// and blurs spread it. The warning names the line, the frame and the first pixel. Guard the operation:
    /// `sqrt(max(x, 0.0))`, `x / max(y, 1e-6)`, `normalize` only of vectors that are not zero.
    ///
    /// Wrong:
    ///
    /// ```glsl buffer
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec4 last = texelFetch(iChannel0, ivec2(p), 0);
    ///     float h = p.x / iResolution.x - 0.1 * float(iFrame);
    ///     c = 0.5 * last + vec4(sqrt(h));
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl buffer
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     vec4 last = texelFetch(iChannel0, ivec2(p), 0);
    ///     float h = p.x / iResolution.x - 0.1 * float(iFrame);
    ///     c = 0.5 * last + vec4(sqrt(max(h, 0.0)));
    /// }
    /// ```
    NanInBuffer "W0607" "NaN in a buffer",

    /// Observed over the frames of a project: a buffer reads itself, and is zero in every pixel of every
    /// frame. Buffers are zero before the first frame; a buffer that only transforms its own content needs
    /// initial values. A buffer that reads the mouse or other inputs is not reported.
    ///
    /// Wrong:
    ///
    /// ```glsl buffer
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = 0.99 * texelFetch(iChannel0, ivec2(p), 0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl buffer
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     c = 0.99 * texelFetch(iChannel0, ivec2(p), 0);
    ///     if (iFrame == 0) {
    ///         c = vec4(p / iResolution.xy, 0.0, 1.0);
    ///     }
    /// }
    /// ```
    NeverInitialized "W0608" "A buffer that stays zero",

    /// Float32 and double precision each render all frames of a project from the first on. In more than 0.3 %
    /// of the pixels of the last frame, the images differ visibly. There are three causes:
    ///
    /// - **One frame is imprecise**: a pass renders a visible difference from the same buffers. The warning
    ///   names the pass and the frame, and W0602 the line. Change the formula.
    /// - **Chaos**: errors grow exponentially, in double precision as fast as in float32. That is a property
    ///   of what the shader simulates, and no fault: but the images of two GPUs differ as well, so only
    ///   frames before the difference becomes visible can be compared (`--frame N`).
    /// - **Errors add up**, or decide a comparison: sums over thousands of frames, and thresholds. Compute
    ///   from `iFrame` or `iTime` what does not need the previous frame.
    ///
    /// Wrong:
    ///
    /// ```glsl buffer
    /// // The logistic map: two nearby values are far apart after some frames.
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float x = texelFetch(iChannel0, ivec2(p), 0).x;
    ///     if (iFrame == 0) {
    ///         x = p.x / iResolution.x;
    ///     }
    ///     c = vec4(3.9 * x * (1.0 - x), 0.0, 0.0, 1.0);
    /// }
    /// ```
    ///
    /// Right:
    ///
    /// ```glsl buffer
    /// // With a smaller rate, all values approach one fixed point.
    /// void mainImage(out vec4 c, in vec2 p) {
    ///     float x = texelFetch(iChannel0, ivec2(p), 0).x;
    ///     if (iFrame == 0) {
    ///         x = p.x / iResolution.x;
    ///     }
    ///     c = vec4(2.9 * x * (1.0 - x), 0.0, 0.0, 1.0);
    /// }
    /// ```
    VisibleGrowth "W0609" "Rounding errors that become visible over frames",

    /// naga could not translate the shader, or the driver crashed, failed, ran out of memory or exceeded the
    /// time limit. None of that shows a mistake in the shader. The shader was evaluated on the CPU instead:
    /// the algorithm and precision checks are complete, and the toolchain check is skipped. Another driver
    /// (`--device`), or a newer version, may render the shader; `toyproof doctor` lists the drivers.
    /// `--device cpu` uses none. Without a reference, most of these failures are an `error`, because then the
    /// toolchain is what is checked.
    DriverFailure "W0610" "A shader of which the driver renders no image",

    /// More than 0.1 % of the pixels that the driver rendered are visibly not what the same float32
    /// arithmetic gives on the CPU: naga, the driver or toyproof is at fault. The verdict is that on the
    /// evaluator's image. On the author's GPU the shader may look like either image. `NAME-toolchain.png` of
    /// `--out` shows the pixels. Without a reference, the verdict is `error`.
    ToolchainDifference "W0611" "An image of the driver that differs from the evaluator's",

    /// A loop ends in float32, but not in double precision, or takes longer than the time limit there. The
    /// shader was compared with the reference in float32, with a tolerance of 2/255, and there is no
    /// precision check. A loop that ends only because float32 rounds, such as `while (x + step != x)`,
    /// depends on the precision: bound the number of its iterations.
    OnlySingle "W0612" "A shader that cannot be evaluated in double precision",

    /// A project reads a texture, cube map, volume, film or sound of ShaderToy's site. Their files may not
    /// be distributed, so that toyproof computes others with the properties that shaders rely on: the same
    /// size and components, similar colors, and the same on every machine. A photograph is another one of
    /// the same kind, so that an image in which it is seen is not that of the site. Give your own copies
    /// with `--media DIR`, in files that are named like the media: `rock-tiles.jpg`.
    StandIn "W0613" "A computed texture in place of one of the site's",
    } };
}
