// The second book's mixture_pdf: half of the directions to the lamp, half for the material, divided by the mixed density.

uint S0;
uint pcg_(uint v) { v = v * 747796405u + 2891336453u; v = ((v >> ((v >> 28) + 4u)) ^ v) * 277803737u; return (v >> 22) ^ v; }
float rnd() { S0 += 0x9E3779B9u; return float(pcg_(S0) >> 8) / 16777216.0; }
#define PI 3.14159265

vec3 cone(vec3 w, float c)
{
    vec3 a = abs(w.x) > 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0);
    vec3 v = normalize(cross(w, a)), u = cross(w, v);
    float f = 2.0 * PI * rnd(), s = sqrt(max(1.0 - c * c, 0.0));
    return cos(f) * s * u + sin(f) * s * v + c * w;
}

float ball(vec3 o, vec3 d, vec3 c, float r)
{
    vec3 f = o - c;
    float b = dot(f, d);
    vec3 g = f - b * d;
    float h = r * r - dot(g, g);
    return h > 0.0 && -b - sqrt(h) > 0.0 ? -b - sqrt(h) : 1e9;
}

vec3 estimate(vec3 o, vec3 d)
{
    vec3 w = vec3(1.0);
    for (int depth = 4; depth > 0; depth--)
    {
        float tl = ball(o, d, vec3(2, 3, -5), 1.0), t1 = ball(o, d, vec3(-0.7, -0.3, -5.2), 0.7), t2 = ball(o, d, vec3(0.7, -0.5, -4.6), 0.5);
        float tf = d.y < 0.0 ? -(o.y + 1.0) / d.y : 1e9;
        float t = min(min(tl, t1), min(t2, tf));
        if (t > 1e8) return w * vec3(0.12, 0.12, 0.15);
        if (t == tl) return w * vec3(2.5, 2.4, 2.2);
        vec3 p = o + t * d, n = t == tf ? vec3(0, 1, 0) : t == t1 ? normalize(p - vec3(-0.7, -0.3, -5.2)) : normalize(p - vec3(0.7, -0.5, -4.6));
        vec3 r = reflect(d, n);
        bool phong = t == t2;
        vec3 rho = t == tf ? vec3(0.7, 0.7, 0.65) : t == t1 ? vec3(0.75, 0.4, 0.4) : vec3(0.7);
        p += 0.001 * n;
        vec3 toL = vec3(2, 3, -5) - p;
        float s2 = 1.0 / dot(toL, toL), cm = sqrt(1.0 - s2);
        toL = normalize(toL);
        float omega = 2.0 * PI * s2 / (1.0 + cm);
        vec3 wi;
        if (rnd() < 0.5) wi = cone(toL, 1.0 - rnd() * s2 / (1.0 + cm));
        else if (phong) wi = cone(r, pow(rnd(), 1.0 / 26.0));
        else wi = cone(n, sqrt(rnd()));
        float nl = dot(n, wi);
        if (nl <= 0.0) return vec3(0.0);
        // is wi one that hits the lamp's disk? then light sampling could have made it
        bool inCone = ball(p, wi, vec3(2, 3, -5), 1.0) < 1e8;
        float lobe = pow(max(dot(r, wi), 0.0), 25.0);
        float pm = phong ? 26.0 / (2.0 * PI) * lobe : nl / PI;
        float pdf = 0.5 * pm + (inCone ? 0.5 / omega : 0.0);
        vec3 f = phong ? rho * 27.0 / (2.0 * PI) * lobe : rho / PI;
        if (pdf <= 0.0) return vec3(0.0);
        w *= f * nl / pdf;
        o = p;
        d = wi;
    }
    return vec3(0.0);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    S0 = pcg_(uint(fragCoord.x) + pcg_(uint(fragCoord.y) + pcg_(uint(iFrame) + 5u)));
    vec3 sum = vec3(0.0);
    for (int s = 0; s < 64; s++)
    {
        vec2 xy = (2.0 * (fragCoord + vec2(rnd(), rnd()) - 0.5) - iResolution.xy) / iResolution.x;
        sum += estimate(vec3(0.0), normalize(vec3(xy, -2.0)));
    }
    fragColor = vec4(sum / 64.0, 1.0);
}
