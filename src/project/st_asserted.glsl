#undef mainImage
void mainImage(out vec4 color, in vec2 position) {
    vec4 unchecked = vec4(0.0, 0.0, 0.0, 1.0);
    st_mainImage(unchecked, position);
    color = unchecked;
    if (st_failed.x) color = vec4(1.0, 0.0, 0.0, 1.0);
    if (st_failed.y) color = vec4(0.0, 1.0, 0.0, 1.0);
    if (st_failed.z) color = vec4(0.0, 0.0, 1.0, 1.0);
    if (st_failed.w) color = vec4(1.0, 1.0, 0.0, 1.0);
}
