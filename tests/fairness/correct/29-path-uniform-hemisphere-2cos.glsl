// Directions uniform over the hemisphere, density 1 / 2pi: BRDF (rho / pi) * cos / (1 / 2pi) = 2 rho cos.

uvec2 k_;
// TEA, four rounds
vec2 noise2()
{
    k_.y++;
    uint v0 = k_.x, v1 = k_.y, s = 0u;
    for (int i = 0; i < 6; i++) {
        s += 0x9e3779b9u;
        v0 += ((v1 << 4) + 0xa341316cu) ^ (v1 + s) ^ ((v1 >> 5) + 0xc8013ea4u);
        v1 += ((v0 << 4) + 0xad90777du) ^ (v0 + s) ^ ((v0 >> 5) + 0x7e95761eu);
    }
    return vec2(v0 >> 8, v1 >> 8) / 16777216.0;
}

vec3 uniformHemisphere(vec3 n)
{
    vec2 xi = noise2();
    float z = 2.0*xi.x - 1.0, r = sqrt(1.0 - z*z), a = 6.2831853*xi.y;
    vec3 v = vec3(r*cos(a), r*sin(a), z);
    return dot(v, n) < 0.0 ? -v : v;
}

float s_(vec3 o, vec3 d, vec3 c, float r)
{
    o -= c;
    float b = dot(o, d), q = b*b - (dot(o, o) - r*r);
    if (q < 0.0) return -1.0;
    return -b - sqrt(q);
}

void nearest(vec3 o, vec3 d, out float t, out vec3 n, out vec3 k, out int what)
{
    t = 1e9; what = 0;
    float x = -(o.y + 1.0)/d.y;
    if (x > 0.0) { t = x; n = vec3(0, 1, 0); k = vec3(0.6); what = 1; }
    x = s_(o, d, vec3(-0.9, -0.1, -5), 0.9);  if (x > 0.0 && x < t) { t = x; n = normalize(o + x*d - vec3(-0.9, -0.1, -5)); k = vec3(0.8, 0.3, 0.3); what = 1; }
    x = s_(o, d, vec3(0.9, -0.4, -4.6), 0.6); if (x > 0.0 && x < t) { t = x; n = normalize(o + x*d - vec3(0.9, -0.4, -4.6)); k = vec3(0.3, 0.4, 0.8); what = 1; }
    x = s_(o, d, vec3(0.1, 0.6, -6), 0.4);    if (x > 0.0 && x < t) { t = x; what = 2; }
}

vec3 go(vec3 o, vec3 d)
{
    vec3 w = vec3(1.0), n, k;
    float t; int what;
    for (int b = 0; b < 3; b++)
    {
        nearest(o, d, t, n, k, what);
        if (what == 0) return w*mix(vec3(0.5, 0.5, 0.55), vec3(0.9, 0.95, 1.0), 0.5*d.y + 0.5);
        if (what == 2) return w*vec3(0.9, 0.9, 0.6);
        o = o + t*d + 0.001*n;
        d = uniformHemisphere(n);
        w *= 2.0*k*dot(n, d);
    }
    return vec3(0.0);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    k_ = uvec2(uint(fragCoord.x) | uint(fragCoord.y) << 16, uint(iFrame)*100000u);
    vec3 c = vec3(0.0);
    for (int i = 0; i < 64; i++)
    {
        vec2 p = 2.0*(floor(fragCoord) + noise2())/iResolution.xy - 1.0;
        c += go(vec3(0.0), normalize(vec3(p*vec2(1.0, iResolution.y/iResolution.x), -2.0)));
    }
    fragColor = vec4(c/64.0, 1.0);
}
