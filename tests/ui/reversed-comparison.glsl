void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    bool inside = fragCoord.x =< 3.0;
    bool edge = fragCoord.x > 1.0 & fragCoord.y > 1.0;
    fragColor = inside && fragCoord.x ? vec4(1.0) : vec4(0.0);
    if (2) { fragColor = vec4(0.5); }
}
