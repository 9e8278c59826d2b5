uint hash(uint x) { x ^= x >> 16u; x *= 0x7feb352dU; x ^= x >> 15; x *= 0x846ca68bu; return x ^ (x >> 16); }
const int big = 0x7fffffff, low = -2147483647 - 1, wrap = big + 1;
void mainImage(out vec4 o, in vec2 p) {
    uvec2 u = uvec2(p); int i = int(hash(u.x + 64u * u.y)); i %= 7; i |= ~i & 3; i <<= 2;
    ivec3 v = ivec3(i, -i, abs(i)) / ivec3(3, -2, 1); v.x++; --v.y; v.zyx -= v % 2;
    float f = uintBitsToFloat(hash(3u) >> 9 | 0x3f800000u) - 1.0;
    o = vec4(v, low / big) + f + unpackHalf2x16(u.x).x + float(wrap ^ 1) + float(u.y & 0xffu);
}
