// Biased: the lamp is picked by power, but divided by an even chance; own random numbers; measured: 37.9 % of the pixels off by > 2/255 once converged, mean 6.40/255, worst 8x8 block 41.9/255 (noise of one run 2.22/255)
// The lamp to ask is drawn by power (radius^2 times luminance); the density carries the chance.

#define TWO_PI 6.283185307
struct Light { vec3 c; float r; vec3 e; float pr; };
Light lights[2];
uint u_;
float rand() { u_ = u_ * 1597334677u + 3812015801u; uint v = u_; v ^= v >> 15; v *= 0x2c1b3c6du; v ^= v >> 12; v *= 0x297a2d39u; v ^= v >> 15; return float(v >> 8) / 16777216.0; }

float sI(vec3 o, vec3 d, vec3 c, float r)
{
    vec3 a = o - c; float b = dot(a, d); vec3 e = a - b * d; float h = r * r - dot(e, e);
    if (h < 0.0) return -1.0;
    return -b - sqrt(h);
}

int world(vec3 o, vec3 d, out float t)
{
    int k = 0; t = 1e9; float x;
    x = sI(o, d, lights[0].c, lights[0].r);       if (x > 0.0 && x < t) { t = x; k = 1; }
    x = sI(o, d, lights[1].c, lights[1].r);       if (x > 0.0 && x < t) { t = x; k = 2; }
    x = sI(o, d, vec3(-0.2, -0.3, -5.0), 0.7);    if (x > 0.0 && x < t) { t = x; k = 3; }
    x = sI(o, d, vec3(0.8, -0.75, -4.3), 0.25);   if (x > 0.0 && x < t) { t = x; k = 4; }
    x = -(o.y + 1.0) / d.y;                       if (x > 0.0 && x < t) { t = x; k = 5; }
    return k;
}

void axes(vec3 n, out vec3 t, out vec3 b) { float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), c = n.x * n.y * a; t = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x); b = vec3(c, s + n.y * n.y * a, -n.y); }

vec3 direct(vec3 p, vec3 n)
{
    int i = rand() < lights[0].pr ? 0 : 1;
    float pr = i == 0 ? lights[0].pr : 1.0 - lights[0].pr;
    vec3 w = lights[i].c - p, t, b;
    float s2 = lights[i].r * lights[i].r / dot(w, w);
    float dep = s2 / (1.0 + sqrt(1.0 - s2));
    w = normalize(w);
    axes(w, t, b);
    float c = 1.0 - rand() * dep, s = sqrt(max(0.0, 1.0 - c * c)), f = TWO_PI * rand();
    vec3 l = s * cos(f) * t + s * sin(f) * b + c * w;
    float nl = dot(n, l), q;
    if (nl <= 0.0 || world(p, l, q) != i + 1) return vec3(0.0);
    return lights[i].e * nl * TWO_PI * dep * 2.0;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    lights[0] = Light(vec3(-1.8, 3.0, -5.0), 0.6, vec3(18.0, 16.0, 14.0), 0.0);
    lights[1] = Light(vec3(1.7, -0.6, -5.0), 0.3, vec3(0.4, 0.6, 0.9), 0.0);
    float a = 0.36 * dot(lights[0].e, vec3(0.2126, 0.7152, 0.0722)), b = 0.09 * dot(lights[1].e, vec3(0.2126, 0.7152, 0.0722));
    lights[0].pr = 0.5 * (a / (a + b)) + 0.25;      // defensive: half by power, half evenly
    u_ = uint(fragCoord.x) * 747796405u ^ uint(fragCoord.y) * 2891336453u ^ (uint(iFrame) + 1u) * 277803737u;
    vec3 sum = vec3(0.0);
    for (int s = 0; s < 32; s++)
    {
        vec2 xy = 2.0 * (fragCoord - 0.5 + vec2(rand(), rand())) / iResolution.x - vec2(1.0, iResolution.y / iResolution.x);
        vec3 o = vec3(0.0), d = normalize(vec3(xy, -2.0)), k = vec3(1.0);
        for (int seg = 1; seg <= 3; seg++)
        {
            float t;
            int w = world(o, d, t);
            if (w == 0) { sum += k * 0.05; break; }
            if (w < 3) { if (seg == 1) sum += lights[w - 1].e; break; }
            if (seg == 3) break;
            vec3 p = o + t * d, n = w == 5 ? vec3(0, 1, 0) : w == 3 ? normalize(p - vec3(-0.2, -0.3, -5.0)) : normalize(p - vec3(0.8, -0.75, -4.3));
            k *= w == 5 ? vec3(0.7) : w == 3 ? vec3(0.8, 0.75, 0.7) : vec3(0.4, 0.8, 0.4);
            p += 3e-4 * n;
            sum += k / 3.14159265 * direct(p, n);
            vec3 t1, b1;
            axes(n, t1, b1);
            float r = rand(), f = TWO_PI * rand();
            o = p;
            d = sqrt(r) * (cos(f) * t1 + sin(f) * b1) + sqrt(1.0 - r) * n;
        }
    }
    fragColor = vec4(sum / 32.0, 1.0);
}
