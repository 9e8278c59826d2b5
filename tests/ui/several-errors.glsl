void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = fragCoord / iResolution.xy
    vec3 color = vec3(uv, 0);
    color *= 2;
    if (colur.x > 1.0 { color.x = 1.0; }
    fragColor = vec4(color);
}
