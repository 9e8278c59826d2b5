// Tiles with integer coordinates. The direction `up` of a tile replaces the rotation: the half disk is on its
// negative side, the small disk on its positive side.
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float unit = iResolution.y / 6.0;
    int row = int(fragCoord.y / unit);
    float shift = (row & 1) == 1 ? 0.5 * unit : 0.0;
    int column = int((fragCoord.x + shift) / unit);

    vec2 q = fragCoord + vec2(shift, 0.0) - unit * (vec2(column, row) + 0.5);
    float turn = radians(45.0 * float((column + 2 * row) % 8));
    vec2 up = vec2(-sin(turn), cos(turn));

    float large = max(dot(q, up), length(q) - 0.4 * unit);
    float small = length(q - 0.18 * unit * up) - 0.12 * unit;
    vec3 warm = (column + row) % 2 == 0 ? vec3(0.95, 0.6, 0.2) : vec3(0.85, 0.25, 0.2);
    vec3 color = mix(warm, vec3(0.1, 0.15, 0.25), smoothstep(-0.5, 0.5, large));
    color = mix(vec3(0.4, 0.75, 0.7), color, smoothstep(-0.5, 0.5, small));
    fragColor = vec4(color, 1.0);
}
