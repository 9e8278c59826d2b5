void mainImage(out vec4 o, in vec2 p) {
    int i = 0; float x;
    float[2](1.0, 2.0)[i++];
    for (vec2[1](p)[i++].x; i < 3; i++) x = (float[2](1.0, x = 2.0)[0], x);
    o = vec4(i, x, 0, 1);
}
