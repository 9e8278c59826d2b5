struct Leaf { float a; vec3 b[2]; };
struct Node { Leaf l; mat2 m; int k; };
const Leaf leaf = Leaf(1.0, vec3[2](vec3(0), vec3(1, 2, 3)));
Node make(int k) { Node n; n.l = leaf; n.m = mat2(1, 2, 3, 4); n.k = k; return n; }
void mainImage(out vec4 o, in vec2 p) {
    Node n = make(int(p.x)), m = n;
    n.l.b[1].zx = n.m[0]; n.m[1][0] += 2.0; n.m *= 0.5;
    bool same = n == m || n.l != m.l;
    uvec4 u = uvec4(7u, 0x1Fu, 07u, 3); ivec2 i = ivec2(u.xw << 2) % 3; bvec3 t = bvec3(1, 0, same);
    mat4x3 w = mat4x3(1.0); vec4 r = vec3(1) * w; mat3 q = mat3(mat2(2)) + mat3(w);
    o = vec4(n.l.b[i.x & 1], float(any(t))) + r * q[1].y + vec4(u);
}
