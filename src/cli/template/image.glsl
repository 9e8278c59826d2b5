// The mean of the samples in Buffer A.

void mainImage(out vec4 color, in vec2 position) {
    vec4 sum = texelFetch(iChannel0, ivec2(position), 0);
    color = vec4(sum.rgb / max(sum.a, 1.0), 1.0);
}
