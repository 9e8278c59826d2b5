// One wrong type in a declaration, reported at its uses.
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 uv = fragCoord / iResolution.xy;
    float ring = length(uv - vec2(0.5));
    fragColor = vec4(vec3(ring), 1.0);
}
