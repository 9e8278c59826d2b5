// Biased: tone map and gamma on each sample instead of on the pixel's mean; own random numbers; measured: 30.0 % of the pixels off by > 2/255 once converged, mean 2.11/255, worst 8x8 block 15.4/255 (noise of one run 1.98/255)
// Veach's balance heuristic: w = p / (p_light + p_brdf). Both kinds of samples divided by the sum of the densities.

#define PI 3.14159265
uint s_;
float R() { s_ = s_ * 1664525u + 1013904223u; uint x = s_; x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16; return float(x >> 8) / 16777216.; }

struct Mat { vec3 c; float e; };          // e = 0: diffuse
const vec4 LS[2] = vec4[2](vec4(-2.5, 3., -6., .5), vec4(2.4, 2.8, -5., 1.));
const vec3 LE[2] = vec3[2](vec3(8., 7., 6.), vec3(1., 1.4, 2.));
const vec4 OB[2] = vec4[2](vec4(-.8, -.2, -5.2, .8), vec4(.9, -.4, -5., .6));

float hit(vec3 o, vec3 d, vec4 s)
{
    vec3 m = o - s.xyz;
    float b = dot(m, d);
    vec3 k = m - b * d;
    float D = s.w * s.w - dot(k, k);
    if (D <= 0.) return 1e9;
    D = sqrt(D);
    return -b > D ? -b - D : 1e9;        // no ray starts inside
}

// 0, 1: lamps; 2, 3: balls; 4: floor; -1: none
int scene(vec3 o, vec3 d, out float t)
{
    int w = -1; t = 1e9;
    float x;
    for (int i = 0; i < 2; i++) { x = hit(o, d, LS[i]); if (x < t) { t = x; w = i; } }
    for (int i = 0; i < 2; i++) { x = hit(o, d, OB[i]); if (x < t) { t = x; w = 2 + i; } }
    if (d.y < 0.) { x = -(1. + o.y) / d.y; if (x > 0. && x < t) { t = x; w = 4; } }
    return w;
}

vec3 local(vec3 n, float c, float phi)
{
    vec3 h = abs(n.z) < .7 ? vec3(0, 0, 1) : vec3(0, 1, 0);
    vec3 u = normalize(cross(h, n)), v = cross(n, u);
    float s = sqrt(max(0., 1. - c * c));
    return s * (cos(phi) * u + sin(phi) * v) + c * n;
}

float omc(vec3 p, int i) { vec3 w = LS[i].xyz - p; float q = LS[i].w * LS[i].w / dot(w, w); return q / (1. + sqrt(1. - q)); }
float pLight(vec3 p, int i) { return .5 / (2. * PI * omc(p, i)); }
float pBrdf(Mat m, vec3 n, vec3 r, vec3 l) { return m.e > 0. ? (m.e + 1.) / (2. * PI) * pow(max(0., dot(r, l)), m.e) : max(0., dot(n, l)) / PI; }
vec3 f(Mat m, vec3 r, vec3 l) { return m.c * (m.e > 0. ? (m.e + 2.) / (2. * PI) * pow(max(0., dot(r, l)), m.e) : 1. / PI); }

vec3 L(vec3 o, vec3 d)
{
    vec3 sum = vec3(0), thr = vec3(1), from = vec3(0);
    float pdf = -1., t;
    for (int seg = 1; ; seg++)
    {
        int w = scene(o, d, t);
        if (w < 0) return sum + thr * vec3(.06, .07, .09);
        if (w < 2) { float g = pdf < 0. ? 1. : pdf / (pdf + pLight(from, w)); return sum + thr * LE[w] * g; }
        if (seg == 3) return sum;
        vec3 p = o + t * d, n = w == 4 ? vec3(0, 1, 0) : normalize(p - OB[w - 2].xyz);
        Mat m = Mat(vec3(.6), 0.);
        if (w == 2) m = Mat(vec3(.6, .5, .3), 40.);
        if (w == 3) m = Mat(vec3(.7, .4, .4), 0.);
        vec3 r = reflect(d, n);
        from = p;
        o = p + .001 * n;
        int i = R() < .5 ? 0 : 1;
        vec3 l = local(normalize(LS[i].xyz - p), 1. - R() * omc(p, i), 2. * PI * R());
        float nl = dot(n, l);
        if (nl > 0. && scene(o, l, t) == i) sum += thr * f(m, r, l) * nl * LE[i] / (pLight(p, i) + pBrdf(m, n, r, l));
        float u = R();
        d = m.e > 0. ? local(r, pow(u, 1. / (m.e + 1.)), 2. * PI * R()) : local(n, sqrt(u), 2. * PI * R());
        nl = dot(n, d);
        if (nl <= 0.) return sum;
        pdf = pBrdf(m, n, r, d);
        thr *= f(m, r, d) * nl / pdf;
    }
    return sum;
}

void mainImage(out vec4 O, in vec2 F)
{
    s_ = (uint(F.x) * 6971u + uint(F.y)) * 9173u + uint(iFrame) * 2971215073u;
    vec3 c = vec3(0);
    for (int i = 0; i < 16; i++) { vec3 x = L(vec3(0), normalize(vec3((2. * (F - .5 + vec2(R(), R())) - iResolution.xy) / iResolution.x, -2))); c += pow(x / (x + 1.), vec3(1. / 2.2)); }
    O = vec4(c / 16., 1);
}
