// GLSL forbids recursion, the preprocessor does not: LEVEL(this, deeper) writes the same function four times.

struct Surf { float t; vec3 p; vec3 n; vec3 alb; bool glass; };
const float kOff = 0.0008;

void trySphere(vec3 ro, vec3 rd, vec3 ce, float ra, vec3 alb, bool glass, inout Surf s)
{
    vec3 oc = ro - ce;
    float a = dot(rd, rd), hb = dot(oc, rd), c = dot(oc, oc) - ra * ra;
    float disc = hb * hb - a * c;
    if (disc <= 0.0) return;
    float sq = sqrt(disc);
    float t = (-hb - sq) / a;
    if (t <= 0.0) t = (-hb + sq) / a;
    if (t <= 0.0 || t >= s.t) return;
    s.t = t;
    s.p = ro + rd * t;
    s.n = (s.p - ce) / ra;
    s.alb = alb;
    s.glass = glass;
}

Surf map(vec3 ro, vec3 rd)
{
    Surf s;
    s.t = 1e30; s.p = vec3(0); s.n = vec3(0); s.alb = vec3(0); s.glass = false;
    float t = -(ro.y + 1.0) / rd.y;
    if (t > 0.0 && t < s.t) { s.t = t; s.p = ro + rd * t; s.n = vec3(0, 1, 0); s.alb = vec3(0.6); }
    trySphere(ro, rd, vec3(-0.3, 0.0, -4.0), 0.9, vec3(0.95, 1.0, 0.97), true, s);
    trySphere(ro, rd, vec3(1.6, -0.4, -5.2), 0.6, vec3(0.8, 0.25, 0.2), false, s);
    trySphere(ro, rd, vec3(-2.0, -0.2, -5.5), 0.8, vec3(0.2, 0.45, 0.8), false, s);
    return s;
}

vec3 oneLight(Surf s, vec3 pos, vec3 power)
{
    vec3 from = s.p + s.n * kOff;
    vec3 l = pos - from;
    float d2 = dot(l, l);
    l *= inversesqrt(d2);
    float ndl = dot(s.n, l);
    if (ndl <= 0.0) return vec3(0.0);
    Surf b = map(from, l);
    return b.t * b.t < d2 ? vec3(0.0) : power * ndl / 3.14159265;
}

vec3 matte(Surf s)
{
    return s.alb * (vec3(0.3, 0.35, 0.45) + oneLight(s, vec3(4, 6, -1), vec3(5, 4.5, 4)) + oneLight(s, vec3(-5, 3, 1), vec3(1.5, 1.5, 2.5)));
}

float fres(float n1, float n2, float ci, float ct)
{
    float s = (n1 * ci - n2 * ct) / (n1 * ci + n2 * ct);
    float p = (n1 * ct - n2 * ci) / (n1 * ct + n2 * ci);
    return (s * s + p * p) * 0.5;
}

vec3 level0(vec3 ro, vec3 rd) { return vec3(0.0); }

#define LEVEL(NAME, DEEPER) \
vec3 NAME(vec3 ro, vec3 rd) { \
    Surf s = map(ro, rd); \
    if (s.t > 1e29) return vec3(0.6, 0.7, 0.9); \
    if (!s.glass) return matte(s); \
    bool in_ = dot(rd, s.n) > 0.0; \
    vec3 n = in_ ? -s.n : s.n; \
    float n1 = in_ ? 1.5 : 1.0, n2 = in_ ? 1.0 : 1.5; \
    float ci = -dot(n, rd); \
    float st = n1 / n2 * sqrt(max(0.0, 1.0 - ci * ci)); \
    vec3 refl = DEEPER(s.p + n * kOff, reflect(rd, n)); \
    if (st >= 1.0) return s.alb * refl; \
    float ct = sqrt(1.0 - st * st); \
    float f = fres(n1, n2, ci, ct); \
    vec3 dir = n1 / n2 * (rd + ci * n) - ct * n; \
    return s.alb * (f * refl + (1.0 - f) * DEEPER(s.p - n * kOff, dir)); \
}
LEVEL(level1, level0)
LEVEL(level2, level1)
LEVEL(level3, level2)
LEVEL(level4, level3)

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 p = fragCoord / iResolution.xy * 2.0 - 1.0;
    p.y *= iResolution.y / iResolution.x;
    vec3 c = level4(vec3(0.0), normalize(vec3(p, -2.0)));
    c = c / (1.0 + c);
    fragColor = vec4(pow(c, vec3(0.4545454545)), 1.0);
}
