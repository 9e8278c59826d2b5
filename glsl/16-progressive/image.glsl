// The mean of the paths in Buffer A, tone-mapped and gamma-corrected.

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec4 sum = texelFetch(iChannel0, ivec2(fragCoord), 0);
    vec3 color = sum.rgb / sum.a;
    fragColor = vec4(pow(color / (color + 1.0), vec3(1.0 / 2.2)), 1.0);
}
