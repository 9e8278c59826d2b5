// Biased: after a mirror the lamp is not counted, although at a mirror no one can ask for it; own random numbers; measured: 2.1 % of the pixels off by > 2/255 once converged (where the lamp is seen in the mirror), worst 8x8 block 186/255 (128 runs against render with 512 samples)
// The lamp is asked at matte points only; what a mirror shows of it counts in full, for no one has asked before.

struct Rec { float t; int what; vec3 n; };
uint w_;
float ran() { w_ = w_ * 69069u + 1234567u; uint h = w_; h = (h ^ (h >> 16)) * 0x7feb352du; h = (h ^ (h >> 15)) * 0x846ca68bu; h ^= h >> 16; return float(h & 0xffffffu) * 5.9604645e-8; }

const vec3 LC = vec3(-1.5, 3.5, -4.2), MC = vec3(-0.8, -0.1, -5.5), BC = vec3(1.0, -0.4, -5.0);

void sph(vec3 o, vec3 d, vec3 c, float r, int w, inout Rec h)
{
    vec3 m = o - c;
    float b = dot(m, d);
    vec3 x = m - b * d;
    float k = r * r - dot(x, x);
    if (k < 0.0) return;
    float t = -b - sqrt(k);
    if (t > 0.001 && t < h.t) h = Rec(t, w, normalize(m + t * d));
}

Rec see(vec3 o, vec3 d)
{
    Rec h = Rec(1e9, 0, vec3(0.0));
    float t = (-1.0 - o.y) / d.y;
    if (t > 0.001) h = Rec(t, 4, vec3(0, 1, 0));
    t = (-8.0 - o.z) / d.z;
    if (t > 0.001 && t < h.t) h = Rec(t, 5, vec3(0, 0, 1));
    sph(o, d, LC, 1.6, 1, h);
    sph(o, d, MC, 0.9, 2, h);
    sph(o, d, BC, 0.6, 3, h);
    return h;
}

vec3 tilt(vec3 n, float c) {
    float a = 6.2831853 * ran(), s = sqrt(max(0.0, 1.0 - c * c));
    vec3 t = normalize(cross(n, abs(n.y) < 0.6 ? vec3(0, 1, 0) : vec3(0, 0, 1)));
    return s * cos(a) * t + s * sin(a) * cross(n, t) + c * n;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    w_ = uint(fragCoord.x) + 8191u * uint(fragCoord.y) + 131071u * 521u * uint(iFrame);
    w_ ^= w_ >> 16; w_ *= 0x85ebca6bu; w_ ^= w_ >> 13; w_ *= 0xc2b2ae35u; w_ ^= w_ >> 16;
    vec3 image = vec3(0.0);
    for (int n = 0; n < 24; n++)
    {
        vec3 o = vec3(0.0), d = normalize(vec3((2.0 * (fragCoord + vec2(ran(), ran()) - 0.5) - iResolution.xy) / iResolution.x, -2.0));
        vec3 k = vec3(1.0);
        bool countLamp = true;
        for (int seg = 1; seg <= 4; seg++)
        {
            Rec h = see(o, d);
            if (h.what == 0) { image += k * vec3(0.2, 0.25, 0.3); break; }
            if (h.what == 1) { if (countLamp) image += k * vec3(1.1, 1.1, 1.0); break; }
            if (seg == 4) break;
            o += h.t * d;
            if (h.what == 2) { d = reflect(d, h.n); k *= 0.9; countLamp = false; continue; }
            vec3 rho = h.what == 3 ? vec3(0.8, 0.35, 0.25) : h.what == 4 ? vec3(0.7, 0.65, 0.6) : vec3(0.5, 0.55, 0.6);
            k *= rho;
            vec3 w = LC - o;
            float s2 = 2.56 / dot(w, w), dep = s2 / (1.0 + sqrt(1.0 - s2));
            vec3 l = tilt(normalize(w), 1.0 - dep * ran());
            float c = dot(h.n, l);
            if (c > 0.0 && see(o, l).what == 1) image += k * vec3(1.1, 1.1, 1.0) * c * 2.0 * dep;
            d = tilt(h.n, sqrt(1.0 - ran()));
            countLamp = false;
        }
    }
    fragColor = vec4(image / 24.0, 1.0);
}
