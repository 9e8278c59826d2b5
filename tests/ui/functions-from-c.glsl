void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float angle = atan2(fragCoord.y, fragCoord.x);
    float shade = fabsf(sinf(angle)) + cbrt(fragCoord.x) + fmod(angle, 2.0);
    fragColor = vec4(shade / M_PI);
}
