// A parenthesis that the grammar accepts at several places: only one of them compiles.
float sphere(vec3 ro, vec3 rd, vec3 center) {
    vec3 oc = ro - center;
    float b = dot(oc, rd;
    float h = b * b - dot(oc, oc) + 1.0;
    return h < 0.0 ? -1.0 : -b - sqrt(h);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 rd = normalize(vec3(fragCoord - 0.5 * iResolution.xy, iResolution.y));
    fragColor = vec4(sphere(vec3(0.0), rd, vec3(0.0, 0.0, 3.0)));
}
