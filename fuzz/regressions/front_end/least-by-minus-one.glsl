const int k = 2147483648 / -1;
void mainImage(out vec4 o, in vec2 p) {
    2147483648 / -1;
    o = vec4(ivec2(-2147483647 - 1, 3) / -1, -2147483648 % -1, k);
}
