void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = fragCoord / iResolution.xy
    vec3 colour = vec3(uv, 0);
    colour *= 2;
    if (colur.x > 1.0 { colour.x = 1.0; }
    fragColor = vec4(colour);
}
