void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 sky = vec3(0,5, 0.5, 0.45);
    float gain = 0,5;
    fragColor = vec4(sky * clamp(0,5, 0.0, 1.0), vec2(1, 2, 3));
}
