// Roberts' R2 sequence, one for the pixel and one for the lamp, each turned on the torus by the pixel's own offset.

const vec2 R2 = vec2(0.7548776662466927, 0.5698402909980532);
const vec2 R2b = vec2(0.8191725133961645, 0.6710436067037893);   // first two of R3

uvec4 pcg4d(uvec4 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w; v.y += v.z * v.x; v.z += v.x * v.y; v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w; v.y += v.z * v.x; v.z += v.x * v.y; v.w += v.y * v.z;
    return v;
}

vec2 hitS(vec3 o, vec3 d, vec4 s)
{
    vec3 oc = o - s.xyz;
    float b = dot(oc, d);
    vec3 e = oc - b * d;
    float h = s.w * s.w - dot(e, e);
    if (h < 0.0) return vec2(-1.0);
    h = sqrt(h);
    return vec2(-b - h, -b + h);
}

const vec4 s1 = vec4(-0.5, -0.2, -4.6, 0.8);
const vec4 s2 = vec4(0.9, 0.4, -6.0, 0.6);
const vec4 lamp = vec4(2.5, 3.5, -3.0, 0.7);

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    uvec4 h = pcg4d(uvec4(uvec2(fragCoord), uint(iFrame), 7u));
    vec4 rot = vec4(h >> 8u) / 16777216.0;
    vec3 acc = vec3(0.0);
    for (int i = 1; i <= 16; i++)
    {
        vec2 pj = fract(rot.xy + float(i) * R2);
        vec2 lj = fract(rot.zw + float(i) * R2b);
        vec2 xy = ((fragCoord - 0.5 + pj) * 2.0 - iResolution.xy) / iResolution.x;
        vec3 d = normalize(vec3(xy, -2.0));
        float t = -1.0 / d.y;
        if (t < 0.0) t = 1e9;
        vec3 n = vec3(0.0, 1.0, 0.0), k = vec3(0.7);
        float a = hitS(vec3(0.0), d, s1).x;
        if (a > 0.0 && a < t) { t = a; n = normalize(a * d - s1.xyz); k = vec3(0.8, 0.4, 0.3); }
        a = hitS(vec3(0.0), d, s2).x;
        if (a > 0.0 && a < t) { t = a; n = normalize(a * d - s2.xyz); k = vec3(0.4, 0.6, 0.8); }
        if (t > 1e8) { acc += vec3(0.4, 0.45, 0.5); continue; }
        vec3 p = t * d + 2e-4 * n;
        vec3 w = lamp.xyz - p;
        float dd = length(w);
        w /= dd;
        float q = lamp.w / dd;
        float ct = 1.0 + lj.x * (sqrt(1.0 - q * q) - 1.0);
        float st = sqrt(1.0 - ct * ct);
        vec3 u = normalize(vec3(-w.z, 0.0, w.x) + vec3(1e-8, 0.0, 0.0));
        vec3 v = cross(u, w);
        float az = 6.28318531 * lj.y;
        vec3 l = ct * w + st * (cos(az) * u + sin(az) * v);
        float c = max(0.0, dot(n, l));
        if (c > 0.0) {
            float end = hitS(p, l, lamp).x;
            if (end < 0.0) end = dd * ct;
            float b1 = hitS(p, l, s1).x, b2 = hitS(p, l, s2).x, b3 = (-1.0 - p.y) / l.y;
            if ((b1 > 0.0 && b1 < end) || (b2 > 0.0 && b2 < end) || (b3 > 0.0 && b3 < end)) c = 0.0;
        }
        acc += k * (vec3(0.2, 0.2, 0.25) + c * vec3(0.8, 0.8, 0.75));
    }
    fragColor = vec4(acc / 16.0, 1.0);
}
