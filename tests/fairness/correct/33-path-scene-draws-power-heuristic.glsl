// All state in one struct that is handed about; the bounce is a function that says whether there is another.

const float pi = 3.14159265358979;

struct Rng { uint s; };
uint pcg(uint v) { uint s = v * 747796405u + 2891336453u; uint w = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u; return (w >> 22u) ^ w; }
float draw(inout Rng r) { r.s = pcg(r.s); return float(r.s >> 8u) / 16777216.0; }
vec2 draw2(inout Rng r) { float a = draw(r); float b = draw(r); return vec2(a, b); }

struct Path { vec3 o; vec3 d; vec3 beta; vec3 sum; float pdf; int used; };

const vec4 ball[4] = vec4[4](vec4(-2, 3, -5, .6), vec4(2.5, 2, -7, .9), vec4(-.7, -.3, -5.2, .7), vec4(.8, -.4, -4.9, .6));
const vec3 tone[5] = vec3[5](vec3(5, 4.5, 4), vec3(1.2, 1.4, 1.8), vec3(.7, .35, .3), vec3(.6), vec3(.6, .65, .6));

bool slice(vec3 o, vec3 d, int i, out float a, out float b)
{
    vec3 f = o - ball[i].xyz;
    float m = -dot(f, d);
    vec3 c = f + m * d;
    float h2 = ball[i].w * ball[i].w - dot(c, c);
    if (h2 <= 0.0) return false;
    float h = sqrt(h2);
    a = m - h; b = m + h;
    return b > 0.0;
}

int view(vec3 o, vec3 d, out float t)
{
    t = 1e9;
    int id = -1;
    float a, b;
    for (int i = 0; i < 4; i++) if (slice(o, d, i, a, b)) { float x = a > 0.0 ? a : b; if (x > 0.0 && x < t) { t = x; id = i; } }
    float x = (-1.0 - o.y) / d.y;
    if (x > 0.0 && x < t) { t = x; id = 4; }
    return id;
}

vec3 turned(vec3 w, float c, float v)
{
    vec3 a = normalize(cross(abs(w.y) > 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0), w));
    vec3 b = cross(w, a);
    float s = sqrt(max(0.0, 1.0 - c * c)), f = 2.0 * pi * v;
    return s * cos(f) * a + s * sin(f) * b + c * w;
}

float coneOf(vec3 p, int e) { vec3 w = ball[e].xyz - p; float q = ball[e].w * ball[e].w / dot(w, w); return q / (1.0 + sqrt(1.0 - q)); }
float pdfL(vec3 p, int e) { return 1.0 / (4.0 * pi * coneOf(p, e)); }

bool bounce(inout Path q, inout Rng r)
{
    q.used++;
    float t;
    int id = view(q.o, q.d, t);
    if (id < 0) { q.sum += q.beta * vec3(.1, .1, .14); return false; }
    if (id < 2) {
        float w = 1.0;
        if (q.pdf > 0.0) { float l = pdfL(q.o, id); w = q.pdf * q.pdf / (q.pdf * q.pdf + l * l); }
        q.sum += q.beta * tone[id] * w;
        return false;
    }
    if (q.used >= 4) return false;
    vec3 p = q.o + t * q.d;
    vec3 n = id == 4 ? vec3(0, 1, 0) : normalize(p - ball[id].xyz);
    vec3 m = reflect(q.d, n);
    bool gloss = id == 3;
    int e = int(draw(r) * 2.0);
    vec2 u = draw2(r);
    vec3 l = turned(normalize(ball[e].xyz - p), 1.0 - u.x * coneOf(p, e), u.y);
    float c = dot(n, l);
    vec3 start = p + 0.0002 * n;
    if (c > 0.0) {
        float x;
        if (view(start, l, x) == e) {
            float pl = pdfL(p, e), rl = max(0.0, dot(m, l));
            float pb = gloss ? 61.0 / (2.0 * pi) * pow(rl, 60.0) : c / pi;
            vec3 f = gloss ? tone[3] * 62.0 / (2.0 * pi) * pow(rl, 60.0) : tone[id] / pi;
            q.sum += q.beta * f * c * tone[e] / pl * (pl * pl / (pl * pl + pb * pb));
        }
    }
    u = draw2(r);
    vec3 d = gloss ? turned(m, pow(1.0 - u.x, 1.0 / 61.0), u.y) : turned(n, sqrt(1.0 - u.x), u.y);
    c = dot(n, d);
    if (c <= 0.0) return false;
    if (gloss) { q.pdf = 61.0 / (2.0 * pi) * pow(max(0.0, dot(m, d)), 60.0); q.beta *= tone[3] * c * 62.0 / 61.0; }
    else { q.pdf = c / pi; q.beta *= tone[id]; }
    q.o = start;
    q.d = d;
    return true;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec3 total = vec3(0);
    for (int i = 0; i < 16; i++) {
        Rng r = Rng(pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i)))));
        vec2 j = draw2(r) - 0.5;
        vec2 s = (fragCoord + j) / iResolution.xy * 2.0 - 1.0;
        Path q = Path(vec3(0), normalize(vec3(s.x, s.y * iResolution.y / iResolution.x, -2)), vec3(1), vec3(0), -1.0, 0);
        while (bounce(q, r)) {}
        total += q.sum;
    }
    fragColor = vec4(total / 16.0, 1);
}
