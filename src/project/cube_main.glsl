void toyproofMain(out vec4 toyproof_color, in vec2 toyproof_position) {
    int toyproof_face = int(toyproof_position.y) / 1024;
    vec2 toyproof_place = toyproof_position - vec2(0.0, float(1024 * toyproof_face));
    vec2 toyproof_st = toyproof_place / 512.0 - vec2(1.0);
    vec3 toyproof_ray = vec3(1.0, -toyproof_st.y, -toyproof_st.x);
    if (toyproof_face == 1) toyproof_ray = vec3(-1.0, -toyproof_st.y, toyproof_st.x);
    if (toyproof_face == 2) toyproof_ray = vec3(toyproof_st.x, 1.0, toyproof_st.y);
    if (toyproof_face == 3) toyproof_ray = vec3(toyproof_st.x, -1.0, -toyproof_st.y);
    if (toyproof_face == 4) toyproof_ray = vec3(toyproof_st.x, -toyproof_st.y, 1.0);
    if (toyproof_face == 5) toyproof_ray = vec3(-toyproof_st.x, -toyproof_st.y, -1.0);
    toyproof_color = vec4(0.0, 0.0, 0.0, 1.0);
    mainCubemap(toyproof_color, toyproof_place, vec3(0.0), normalize(toyproof_ray));
    toyproof_color.xy = unpackHalf2x16(packHalf2x16(toyproof_color.xy));
    toyproof_color.zw = unpackHalf2x16(packHalf2x16(toyproof_color.zw));
}
