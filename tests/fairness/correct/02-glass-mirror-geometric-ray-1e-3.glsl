/*
   Whitted 1980, after the "geometric solution" of the sphere in the old SIGGRAPH course notes:
   the centre is projected on the ray (tca), then half a chord back (thc).
   Origins are nudged along the ray.
*/
struct Hit { float t; int id; };      // id: 0 nothing, 1 glass, 2 mirror, 3 floor
struct Todo { vec3 o; vec3 d; vec3 k; int left; };

const float NUDGE = 0.001;
const vec4 GLASS  = vec4(-0.85, 0.0, -4.0, 0.8);
const vec4 MIRROR = vec4(0.95, 0.1, -4.6, 0.9);
const vec3 LAMP   = vec3(-6.0, 9.0, 3.0);

bool sphere(in vec3 o, in vec3 d, in vec4 s, inout float best)
{
    vec3 L = s.xyz - o;
    float tca = dot(L, d);
    float d2 = dot(L, L) - tca * tca;
    float r2 = s.w * s.w;
    if (d2 > r2) return false;
    float thc = sqrt(r2 - d2);
    float t0 = tca - thc;
    float t1 = tca + thc;
    if (t0 < 0.0) t0 = t1;
    if (t0 < 0.0 || t0 > best) return false;
    best = t0;
    return true;
}

Hit closest(vec3 o, vec3 d)
{
    Hit h = Hit(1e9, 0);
    if (sphere(o, d, GLASS, h.t)) h.id = 1;
    if (sphere(o, d, MIRROR, h.t)) h.id = 2;
    if (abs(d.y) > 1e-7) {
        float t = (-0.91 - o.y) / d.y;
        if (t > 0.0 && t < h.t) { h.t = t; h.id = 3; }
    }
    return h;
}

vec3 floorColour(vec3 p)
{
    vec2 c = floor(p.xz / 0.75);
    vec3 base = mod(c.x + c.y, 2.0) == 1.0 ? vec3(0.35, 0.2, 0.15) : vec3(0.8, 0.75, 0.6);
    vec3 sum = vec3(0.1, 0.1, 0.12);
    vec3 L = LAMP - p;
    float dist = length(L);
    L /= dist;
    Hit h = closest(p + NUDGE * L, L);
    if (h.id == 0 || h.t > dist) sum += vec3(0.9, 0.85, 0.8) * max(L.y, 0.0);
    return base * sum;
}

void mainImage(out vec4 O, vec2 F)
{
    float aspect = iResolution.x / iResolution.y;
    vec2 ndc = F / iResolution.xy * 2.0 - 1.0;
    ndc.y /= aspect;

    Todo list[12];
    int n = 0;
    list[n++] = Todo(vec3(0.0), normalize(vec3(ndc, -2.0)), vec3(1.0), 7);
    vec3 sum = vec3(0.0);

    while (n > 0) {
        Todo r = list[--n];
        Hit h = closest(r.o, r.d);
        vec3 p = r.o + h.t * r.d;
        if (h.id == 0) sum += r.k * vec3(0.55, 0.7, 0.9);
        else if (h.id == 3) sum += r.k * floorColour(p);
        else if (r.left > 1) {
            if (h.id == 2) {
                vec3 m = reflect(r.d, normalize(p - MIRROR.xyz));
                list[n++] = Todo(p + NUDGE * m, m, r.k * vec3(0.95, 0.85, 0.6), r.left - 1);
            } else {
                vec3 N = normalize(p - GLASS.xyz);
                float c = dot(N, r.d);
                float eta = c < 0.0 ? 1.0 / 1.33 : 1.33;
                vec3 Nf = -sign(c) * N;
                float ci = abs(c);
                float k = 1.0 - eta * eta * (1.0 - ci * ci);
                vec3 m = reflect(r.d, N);
                vec3 thr = r.k * vec3(0.9, 0.97, 1.0);
                float R = 1.0;
                if (k > 0.0) {
                    float ct = sqrt(k);
                    float a = (eta * ci - ct) / (eta * ci + ct);
                    float b = (ci - eta * ct) / (ci + eta * ct);
                    R = (a * a + b * b) / 2.0;
                    vec3 x = eta * r.d + (eta * ci - ct) * Nf;
                    list[n++] = Todo(p + NUDGE * x, x, thr * (1.0 - R), r.left - 1);
                }
                list[n++] = Todo(p + NUDGE * m, m, thr * R, r.left - 1);
            }
        }
    }
    O = vec4(sum, 1.0);
}
