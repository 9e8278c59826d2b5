// The declaration is misspelled, not its uses.
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 positon = fragCoord / iResolution.xy;
    float x = position.x;
    fragColor = vec4(x, position.y, 0.0, 1.0);
}
