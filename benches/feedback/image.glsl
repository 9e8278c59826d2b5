void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 trail = texture(iChannel0, fragCoord / iResolution.xy).rgb;
    fragColor = vec4(sqrt(trail), 1.0);
}
