// Biased: n1/n2 the wrong way round; own random numbers; measured: 41.8 % of the pixels off by > 2/255 once converged, mean 3.63/255, worst 8x8 block 169.1/255 (noise of one run 1.78/255)
// Fresnel decides which way one photon goes; the mean over the samples is the split.

uvec2 rng;
float rnd()
{
    // pcg32 folded to two words
    rng.x = rng.x * 747796405u + 2891336453u;
    uint w = ((rng.x >> ((rng.x >> 28) + 4u)) ^ rng.x) * 277803737u;
    w = (w >> 22) ^ w;
    return float(w >> 8) * (1.0 / 16777216.0);
}

const float E = 5e-4;

float hitSphere(vec3 o, vec3 d, vec3 c, float r)
{
    vec3 f = o - c;
    float b = dot(f, d);
    vec3 l = f - b * d;
    float disc = r * r - dot(l, l);
    if (disc < 0.0) return -1.0;
    float q = sqrt(disc);
    return (-b - q > 0.0) ? -b - q : -b + q;
}

vec3 path(vec3 o, vec3 d)
{
    vec3 thr = vec3(1.0);
    for (int seg = 1; seg <= 8; seg++)
    {
        float a = hitSphere(o, d, vec3(-0.8, -0.1, -4.0), 0.8);
        float b = hitSphere(o, d, vec3(0.9, -0.2, -4.4), 0.75);
        float f = (-1.03 - o.y) / d.y;
        float t = 1e9; int id = 0;
        if (a > 0.0) { t = a; id = 1; }
        if (b > 0.0 && b < t) { t = b; id = 2; }
        if (f > 0.0 && f < t) { t = f; id = 3; }
        if (id == 0) return thr * mix(vec3(0.75, 0.8, 0.9), vec3(0.3, 0.5, 0.8), 0.5 * (1.0 + d.y));
        vec3 p = o + t * d;
        if (id == 3)
        {
            vec3 base = mod(floor(p.x) + floor(p.z), 2.0) < 0.5 ? vec3(0.8) : vec3(0.3, 0.4, 0.3);
            vec3 q = p + vec3(0.0, E, 0.0);
            vec3 l = vec3(0.0, 6.0, -3.0) - q;
            float dist = length(l);
            l /= dist;
            float sa = hitSphere(q, l, vec3(-0.8, -0.1, -4.0), 0.8);
            float sb = hitSphere(q, l, vec3(0.9, -0.2, -4.4), 0.75);
            bool dark = (sa > 0.0 && sa < dist) || (sb > 0.0 && sb < dist);
            return thr * base * (0.3 + (dark ? 0.0 : 0.6 * l.y));
        }
        vec3 n; float ior;
        if (id == 1) { n = normalize(p - vec3(-0.8, -0.1, -4.0)); ior = 1.5; }
        else { n = normalize(p - vec3(0.9, -0.2, -4.4)); ior = 1.8; thr *= vec3(0.9, 0.95, 1.0); }
        float c = -dot(d, n);
        float eta = ior;
        if (c < 0.0) { c = -c; n = -n; eta = 1.0 / ior; }
        float k = 1.0 - eta * eta * (1.0 - c * c);
        float F = 1.0;
        float ct = 0.0;
        if (k > 0.0)
        {
            ct = sqrt(k);
            float rs = (eta * c - ct) / (eta * c + ct);
            float rp = (c - eta * ct) / (c + eta * ct);
            F = 0.5 * (rs * rs + rp * rp);
        }
        if (rnd() < F) { d = d + 2.0 * c * n; o = p + E * n; }
        else { d = eta * d + (eta * c - ct) * n; o = p - E * n; }
        d = normalize(d);
    }
    return vec3(0.0);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    rng.x = uint(fragCoord.x) * 1664525u + uint(fragCoord.y) * 22695477u + uint(iFrame) * 69069u + 1u;
    rnd(); rng.x ^= uint(fragCoord.y) * 0x9E3779B9u; rnd();
    vec3 acc = vec3(0.0);
    for (int i = 0; i < 32; i++)
    {
        vec2 j = vec2(rnd(), rnd());
        vec2 uv = (2.0 * (floor(fragCoord) + j) - iResolution.xy) / iResolution.x;
        acc += path(vec3(0.0), normalize(vec3(uv, -2.0)));
    }
    fragColor = vec4(acc / 32.0, 1.0);
}
