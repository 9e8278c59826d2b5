// smallpt for ShaderToy: explicit lamp sampling, and roulette by the largest colour component from the third segment.

uint lcg;
float erand48_() { lcg = lcg * 1664525u + 1013904223u; uint z = lcg; z = (z ^ (z >> 16)) * 0x85ebca6bu; z = (z ^ (z >> 13)) * 0xc2b2ae35u; z ^= z >> 16; return float(z >> 8) / 16777216.; }
const float M_PI = 3.14159265358979;

struct Prim { vec3 p; float r; vec3 c; bool lamp; };
const Prim prims[3] = Prim[3](
    Prim(vec3(0, 3.2, -5.5), 1., vec3(3, 3, 2.8), true),
    Prim(vec3(-.8, -.3, -5.8), .7, vec3(.75), false),
    Prim(vec3(.9, -.5, -5), .5, vec3(.5, .5, .75), false));

float hitPrim(Prim s, vec3 o, vec3 d) {
    vec3 op = s.p - o;
    float b = dot(op, d), det = b * b - dot(op, op) + s.r * s.r, t;
    if (det < 0.) return 0.;
    det = sqrt(det);
    return (t = b - det) > 1e-3 ? t : ((t = b + det) > 1e-3 ? t : 0.);
}

int intersect(vec3 o, vec3 d, out float t, out vec3 n, out vec3 f) {
    int id = -1;
    t = 1e20; n = vec3(0); f = vec3(0);
    for (int i = 0; i < 3; i++) {
        float x = hitPrim(prims[i], o, d);
        if (x > 0. && x < t) { t = x; id = i; f = prims[i].c; n = normalize(o + t * d - prims[i].p); }
    }
    vec3 q = (vec3(-sign(d.x) * -2.5, -1., -8.) - o) / d;
    if (q.x > 1e-3 && q.x < t) { t = q.x; id = 3; n = vec3(-sign(d.x), 0, 0); f = d.x < 0. ? vec3(.75, .2, .2) : vec3(.2, .75, .2); }
    if (q.y > 1e-3 && q.y < t) { t = q.y; id = 4; n = vec3(0, 1, 0); f = vec3(.75); }
    if (q.z > 1e-3 && q.z < t) { t = q.z; id = 5; n = vec3(0, 0, 1); f = vec3(.75); }
    return id;
}

vec3 radiance(vec3 o, vec3 d) {
    vec3 cl = vec3(0), cf = vec3(1);
    float survive = 1.;
    for (int depth = 1; depth <= 6; depth++) {
        float t; vec3 n, f;
        int id = intersect(o, d, t, n, f);
        if (id < 0) return cl + cf * vec3(.02, .02, .03);
        if (id == 0) return depth == 1 ? f : cl;
        if (depth == 6) break;
        vec3 x = o + d * t;
        if (dot(n, d) > 0.) n = -n;
        if (depth > 2) {
            float p = max(f.r, max(f.g, f.b));
            if (erand48_() >= p) break;
            cf /= p;
        }
        cf *= f;
        // lamp
        vec3 sw = normalize(prims[0].p - x);
        vec3 su = normalize(cross(abs(sw.x) > .1 ? vec3(0, 1, 0) : vec3(1, 0, 0), sw)), sv = cross(sw, su);
        float cos_a_max = sqrt(1. - 1. / dot(x - prims[0].p, x - prims[0].p));
        float eps1 = erand48_(), eps2 = erand48_();
        float cos_a = 1. - eps1 + eps1 * cos_a_max, sin_a = sqrt(1. - cos_a * cos_a), phi = 2. * M_PI * eps2;
        vec3 l = normalize(su * cos(phi) * sin_a + sv * sin(phi) * sin_a + sw * cos_a);
        float tt; vec3 n2, f2;
        if (dot(l, n) > 0. && intersect(x, l, tt, n2, f2) == 0)
            cl += cf * prims[0].c * dot(l, n) * 2. * (1. - cos_a_max);     // omega / pi
        float r1 = 2. * M_PI * erand48_(), r2 = erand48_(), r2s = sqrt(r2);
        vec3 u = normalize(cross(abs(n.x) > .1 ? vec3(0, 1, 0) : vec3(1, 0, 0), n)), v = cross(n, u);
        o = x;
        d = normalize(u * cos(r1) * r2s + v * sin(r1) * r2s + n * sqrt(1. - r2));
    }
    return cl;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    lcg = uint(fragCoord.x) * 0x9E3779B1u + uint(fragCoord.y) * 0x85EBCA77u + uint(iFrame) * 0xC2B2AE3Du;
    vec3 r = vec3(0);
    for (int s = 0; s < 32; s++) {
        vec2 q = (fragCoord + vec2(erand48_(), erand48_()) - .5) / iResolution.xy - .5;
        r += radiance(vec3(0), normalize(vec3(2. * q.x, 2. * q.y * iResolution.y / iResolution.x, -2.))) * (1. / 32.);
    }
    fragColor = vec4(r, 1.);
}
