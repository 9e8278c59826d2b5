// A 4 x 4 grid in the pixel and another over the lamp; the lamp's cells are dealt in an order of their own.

float h11(inout uint n) { n = n * 1664525u + 1013904223u; uint m = n; m ^= m >> 17u; m *= 0xed5ad4bbu; m ^= m >> 11u; m *= 0xac4c1b51u; m ^= m >> 15u; return float(m >> 8u) / 16777216.0; }

const vec4 lamp = vec4(1.0, 4.5, -6.0, 1.0);

float near(vec3 o, vec3 d, vec4 s) { vec3 c = o - s.xyz; float b = dot(c, d), h = b*b - dot(c, c) + s.w*s.w; return h < 0.0 ? -1.0 : -b - sqrt(h); }

float cover(vec3 o, vec3 d, float end)
{
    float a = near(o, d, vec4(-1.0, -0.4, -5.5, 0.7)), b = near(o, d, vec4(0.7, -0.6, -5.0, 0.5)), c = near(o, d, vec4(1.5, 0.5, -7.0, 0.6));
    return (a > 0.0 && a < end) || (b > 0.0 && b < end) || (c > 0.0 && c < end) ? 0.0 : 1.0;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    uint n = uint(fragCoord.x) + uint(fragCoord.y) * 65536u + uint(iFrame) * 0x85ebca6bu;
    n ^= n >> 16u; n *= 0x7feb352du; n ^= n >> 15u; n *= 0x846ca68bu; n ^= n >> 16u;

    int deal[16];
    for (int i = 0; i < 16; i++) deal[i] = i;
    for (int i = 15; i > 0; i--)
    {
        int j = min(int(h11(n) * float(i + 1)), i);
        int t = deal[i]; deal[i] = deal[j]; deal[j] = t;
    }

    vec3 sum = vec3(0.0);
    for (int cy = 0; cy < 4; cy++)
    for (int cx = 0; cx < 4; cx++)
    {
        vec2 pix = (vec2(cx, cy) + vec2(h11(n), h11(n))) / 4.0;
        int c = deal[4*cy + cx];
        vec2 uv = (vec2(c % 4, c / 4) + vec2(h11(n), h11(n))) / 4.0;

        vec3 d = normalize(vec3(2.0*(fragCoord - 0.5 + pix)/iResolution.x - vec2(1.0, iResolution.y/iResolution.x), -2.0));
        float t = -1.1/d.y, x;
        if (t < 0.0) t = 1e6;
        vec3 nn = vec3(0.0, 1.0, 0.0), k = vec3(0.75);
        x = near(vec3(0.0), d, vec4(-1.0, -0.4, -5.5, 0.7)); if (x > 0.0 && x < t) { t = x; nn = (t*d - vec3(-1.0, -0.4, -5.5))/0.7; k = vec3(0.8, 0.5, 0.3); }
        x = near(vec3(0.0), d, vec4(0.7, -0.6, -5.0, 0.5));  if (x > 0.0 && x < t) { t = x; nn = (t*d - vec3(0.7, -0.6, -5.0))/0.5; k = vec3(0.4, 0.7, 0.7); }
        x = near(vec3(0.0), d, vec4(1.5, 0.5, -7.0, 0.6));   if (x > 0.0 && x < t) { t = x; nn = (t*d - vec3(1.5, 0.5, -7.0))/0.6; k = vec3(0.7, 0.7, 0.3); }
        if (t >= 1e6) { sum += vec3(0.2, 0.25, 0.35); continue; }

        vec3 p = t*d;
        vec3 w = lamp.xyz - p;
        float dist = length(w);
        w /= dist;
        float ct = mix(sqrt(1.0 - lamp.w*lamp.w/(dist*dist)), 1.0, uv.x);
        float st = sqrt(1.0 - ct*ct), ph = 6.2831853*uv.y;
        vec3 a = normalize(cross(w, vec3(0.36, 0.48, 0.8)));
        vec3 l = ct*w + st*cos(ph)*a + st*sin(ph)*cross(w, a);
        float nl = dot(nn, l);
        sum += k*0.15;
        if (nl > 0.0) sum += k*vec3(0.8, 0.78, 0.7)*nl*cover(p + 0.001*nn, l, dist*ct - sqrt(max(0.0, lamp.w*lamp.w - dist*dist*st*st)));
    }
    fragColor = vec4(sum/16.0, 1.0);
}
