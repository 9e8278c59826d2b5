// Biased: diffuse light without 1/pi; scene's draws; measured: 93.5 % of the pixels off by > 2/255 once converged, mean 121.60/255, worst 8x8 block 159.8/255 (noise of one run 3.90/255)
// the course's draws, but everything in one function and a table of shapes

uint rngState;
uint pcgHash(uint x) { uint s = x * 747796405u + 2891336453u; uint w = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u; return (w >> 22u) ^ w; }
float next() { rngState = pcgHash(rngState); return float(rngState >> 8u) * exp2(-24.0); }

struct Shape { int kind; vec3 a; float b; vec3 kd; };   // kind 0: sphere, 1: plane through a, normal by b (0: y, 1: z)
const Shape shapes[4] = Shape[4](
    Shape(1, vec3(0, -1, 0), 0.0, vec3(0.7)),
    Shape(1, vec3(0, 0, -9), 1.0, vec3(0.6, 0.5, 0.4)),
    Shape(0, vec3(0.2, -0.3, -5.0), 0.7, vec3(0.8, 0.3, 0.2)),
    Shape(0, vec3(-1.2, -0.6, -4.3), 0.4, vec3(0.3, 0.8, 0.4)));

float meet(Shape s, vec3 o, vec3 d)
{
    if (s.kind == 1) {
        vec3 n = s.b < 0.5 ? vec3(0, 1, 0) : vec3(0, 0, 1);
        float k = dot(d, n);
        if (k == 0.0) return -1.0;
        return dot(s.a - o, n) / k;
    }
    vec3 v = o - s.a;
    float B = 2.0 * dot(v, d), C = dot(v, v) - s.b * s.b, disc = B * B - 4.0 * C;
    if (disc < 0.0) return -1.0;
    float t = (-B - sqrt(disc)) / 2.0;
    return t;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec3 mean = vec3(0);
    for (uint i = 0u; i < 16u; ++i)
    {
        rngState = pcgHash(uint(fragCoord.x) + pcgHash(uint(fragCoord.y) + pcgHash(i)));
        float jx = next() - 0.5;
        float jy = next() - 0.5;
        float sx = 2.0 * (fragCoord.x + jx) / iResolution.x - 1.0;
        float sy = (2.0 * (fragCoord.y + jy) / iResolution.y - 1.0) * iResolution.y / iResolution.x;
        vec3 o = vec3(0), d = normalize(vec3(sx, sy, -2));
        float t = 1e20; int hit = -1;
        for (int k = 0; k < 4; ++k) { float x = meet(shapes[k], o, d); if (x > 0.0 && x < t) { t = x; hit = k; } }
        if (hit < 0) { mean += vec3(0.3, 0.35, 0.4); continue; }
        vec3 P = o + t * d, N;
        if (shapes[hit].kind == 0) N = normalize(P - shapes[hit].a);
        else N = shapes[hit].b < 0.5 ? vec3(0, 1, 0) : vec3(0, 0, 1);
        N = faceforward(N, d, N);

        vec3 toL = vec3(-2, 4, -3) - P;
        float D2 = dot(toL, toL);
        vec3 w = toL * inversesqrt(D2);
        float cosMax = sqrt(1.0 - 0.64 / D2);
        float c = 1.0 - next() * (1.0 - cosMax), s = sqrt(max(0.0, 1.0 - c * c)), phi = 2.0 * acos(-1.0) * next();
        vec3 up = abs(w.y) > 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        vec3 a = normalize(cross(up, w));
        vec3 L = mat3(a, cross(w, a), w) * vec3(s * cos(phi), s * sin(phi), c);
        float len = sqrt(D2) * c - sqrt(max(0.0, 0.64 - D2 * s * s));
        float ndl = dot(N, L);
        if (ndl > 0.0) {
            vec3 q = P + 1e-4 * N;
            for (int k = 0; k < 4; ++k) { float x = meet(shapes[k], q, L); if (x > 0.0 && x < len) ndl = 0.0; }
        } else ndl = 0.0;
        mean += shapes[hit].kd * (vec3(0.15, 0.15, 0.18) + vec3(2.6, 2.5, 2.3) * ndl);
    }
    fragColor = vec4(mean / 16.0, 1);
}
