// Martin Roberts' R2 for the jitter, shifted by a hash of the pixel (iq's hash without sine).

vec2 hash22(uvec2 x)
{
    const uint k = 1103515245u;
    x = ((x >> 8u) ^ x.yx) * k;
    x = ((x >> 8u) ^ x.yx) * k;
    x = ((x >> 8u) ^ x.yx) * k;
    return vec2(x >> 8u) / 16777216.0;
}

struct H { float t; vec3 n; vec3 c; bool m; };

H hitBall(H h, vec3 o, vec3 d, vec3 ce, float r, vec3 c, bool m)
{
    vec3 L = ce - o;
    float tca = dot(L, d);
    float d2 = dot(L, L) - tca * tca;
    if (tca < 0.0 || d2 > r * r) return h;
    float t = tca - sqrt(r * r - d2);
    if (t > 0.0005 && t < h.t) return H(t, (o + t * d - ce) / r, c, m);
    return h;
}

H hit(vec3 o, vec3 d)
{
    H h = H(1e6, vec3(0), vec3(0), false);
    float t = (-1.0 - o.y) / d.y;
    if (t > 0.0005) { vec3 p = o + t * d; h = H(t, vec3(0, 1, 0), mod(floor(p.x) + floor(p.z), 2.0) < 0.5 ? vec3(0.7) : vec3(0.2, 0.3, 0.25), false); }
    h = hitBall(h, o, d, vec3(-0.9, 0.0, -5.0), 0.9, vec3(0.9), true);
    h = hitBall(h, o, d, vec3(1.0, -0.2, -4.6), 0.75, vec3(0.95, 0.8, 0.6), true);
    h = hitBall(h, o, d, vec3(0.1, -0.7, -3.7), 0.28, vec3(0.9, 0.3, 0.2), false);
    return h;
}

vec3 col(vec3 o, vec3 d)
{
    vec3 k = vec3(1);
    for (int i = 0; i < 6; i++)
    {
        H h = hit(o, d);
        if (h.t > 9e5) return k * mix(vec3(0.95, 0.9, 0.8), vec3(0.2, 0.3, 0.6), 0.5 + 0.5 * d.y);
        vec3 p = o + h.t * d;
        if (!h.m)
        {
            vec3 l = vec3(-4, 6, 2) - p;
            float len = length(l);
            l /= len;
            float v = hit(p, l).t < len ? 0.0 : 1.0;
            return k * h.c * (0.3 + 0.6 * v * max(dot(h.n, l), 0.0));
        }
        k *= h.c;
        o = p;
        d = reflect(d, h.n);
    }
    return vec3(0);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 turn = hash22(uvec2(fragCoord) + uvec2(0, 4096 * iFrame));
    vec3 c = vec3(0);
    for (int i = 0; i < 16; i++)
    {
        vec2 j = fract(turn + float(i) * vec2(0.7548776662, 0.5698402910));
        vec2 p = (floor(fragCoord) + j) / iResolution.xy * 2.0 - 1.0;
        c += col(vec3(0), normalize(vec3(p.x, p.y * iResolution.y / iResolution.x, -2.0)));
    }
    fragColor = vec4(c / 16.0, 1.0);
}
