// Importance sampling of the Phong lobe only. Density (n+1)/2pi cos^n, so the weight is (n+2)/(n+1) * N.L.

uint q_;
float f01() { q_ = q_ * 196314165u + 907633515u; uint b = q_; b ^= b >> 16; b *= 0x21f0aaadu; b ^= b >> 15; b *= 0x735a2d97u; b ^= b >> 15; return float(b >> 8) / 16777216.; }

vec3 around(vec3 w, float ct)
{
    float st = sqrt(max(0., 1. - ct * ct)), a = 6.2831853 * f01();
    vec3 u = abs(w.y) < .5 ? vec3(w.z, 0., -w.x) : vec3(0., -w.z, w.y);
    u /= length(u);
    return w * ct + st * (u * cos(a) + cross(w, u) * sin(a));
}

bool S(vec3 o, vec3 d, vec4 s, inout float t)
{
    vec3 c = s.xyz - o;
    float b = dot(c, d);
    c -= b * d;
    float h = s.w * s.w - dot(c, c);
    if (h < 0.) return false;
    float x = b - sqrt(h);
    if (x < 1e-3 || x > t) return false;
    t = x;
    return true;
}

vec3 follow(vec3 o, vec3 d, int left)
{
    vec3 k = vec3(1.);
    for (; left > 0; left--)
    {
        float t = 1e8;
        int m = 0;
        float y = -(1. + o.y) / d.y;
        if (y > 1e-3) { t = y; m = 1; }
        if (S(o, d, vec4(-2.5, 2.5, -8., 1.2), t)) m = 2;
        if (S(o, d, vec4(-.8, -.1, -5., .9), t)) m = 3;
        if (S(o, d, vec4(1., -.4, -4.8, .6), t)) m = 4;
        if (m == 0) return k * mix(vec3(.3, .3, .35), vec3(.8, .85, .9), .5 + .5 * d.y);
        if (m == 2) return k * vec3(1., .8, .6);
        o += t * d;
        vec3 n = vec3(0., 1., 0.);
        if (m == 3) n = normalize(o - vec3(-.8, -.1, -5.));
        if (m == 4) n = normalize(o - vec3(1., -.4, -4.8));
        if (m == 4) { d = around(n, sqrt(f01())); k *= vec3(.3, .6, .5); }
        else {
            float e = m == 1 ? 15. : 80.;
            d = around(reflect(d, n), pow(f01(), 1. / (e + 1.)));
            float c = dot(n, d);
            if (c <= 0.) return vec3(0.);
            k *= (m == 1 ? vec3(.6, .6, .5) : vec3(.8, .7, .6)) * (e + 2.) / (e + 1.) * c;
        }
    }
    return vec3(0.);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    q_ = (uint(fragCoord.x) + uint(fragCoord.y) * 4096u) * 2654435761u + uint(iFrame) * 362437u;
    q_ ^= q_ >> 15;
    vec3 v = vec3(0.);
    for (int i = 0; i < 64; i++)
        v += follow(vec3(0.), normalize(vec3((fragCoord + vec2(f01(), f01()) - .5 - .5 * iResolution.xy) * 2. / iResolution.x, -2.)), 3);
    fragColor = vec4(v / 64., 1.);
}
