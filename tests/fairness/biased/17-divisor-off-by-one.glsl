// Biased: 16 samples divided by 15; own random numbers; measured: 90.3 % of the pixels off by > 2/255 once converged, mean 3.82/255, worst 8x8 block 5.1/255 (noise of one run 1.25/255)
// pbrt's way: ConcentricSampleDisk, lifted to the hemisphere; the lamp by its cone; both weighted by the power heuristic.

const float PiOver4 = 0.78539816339, PiOver2 = 1.57079632679, Pi = 3.14159265359;

uint dim, pixelSeed;
float Get1D() { uint h = pixelSeed ^ (dim++ * 0x9E3779B9u); h ^= h >> 16; h *= 0x21f0aaadu; h ^= h >> 15; h *= 0xd35a2d97u; h ^= h >> 15; return float(h >> 8) / 16777216.0; }
vec2 Get2D() { float a = Get1D(); return vec2(a, Get1D()); }

vec2 ConcentricSampleDisk(vec2 u)
{
    vec2 o = 2.0 * u - 1.0;
    if (o.x == 0.0 && o.y == 0.0) return vec2(0.0);
    float r, theta;
    if (abs(o.x) > abs(o.y)) { r = o.x; theta = PiOver4 * (o.y / o.x); }
    else { r = o.y; theta = PiOver2 - PiOver4 * (o.x / o.y); }
    return r * vec2(cos(theta), sin(theta));
}

void CoordinateSystem(vec3 v1, out vec3 v2, out vec3 v3)
{
    if (abs(v1.x) > abs(v1.y)) v2 = vec3(-v1.z, 0.0, v1.x) / sqrt(v1.x * v1.x + v1.z * v1.z);
    else v2 = vec3(0.0, v1.z, -v1.y) / sqrt(v1.y * v1.y + v1.z * v1.z);
    v3 = cross(v1, v2);
}

struct SurfaceInteraction { float t; vec3 p, n, rho; bool light; };

bool Sphere(vec3 o, vec3 d, vec3 c, float r, vec3 rho, bool light, inout SurfaceInteraction si)
{
    vec3 f = o - c;
    float b = -dot(f, d);
    vec3 l = f + b * d;
    float D = r * r - dot(l, l);
    if (D < 0.0) return false;
    float q = b + (b > 0.0 ? sqrt(D) : -sqrt(D));
    float cc = dot(f, f) - r * r;
    float t0 = min(q, cc / q), t1 = max(q, cc / q);
    float t = t0 > 1e-3 ? t0 : t1;
    if (t < 1e-3 || t > si.t) return false;
    si.t = t; si.p = o + t * d; si.n = normalize(si.p - c); si.rho = rho; si.light = light;
    return true;
}

bool Intersect(vec3 o, vec3 d, out SurfaceInteraction si)
{
    si = SurfaceInteraction(1e30, vec3(0), vec3(0), vec3(0), false);
    bool hit = false;
    float t = (-1.0 - o.y) / d.y;
    if (t > 1e-3) { si = SurfaceInteraction(t, o + t * d, vec3(0, 1, 0), vec3(0.65, 0.65, 0.6), false); hit = true; }
    if (Sphere(o, d, vec3(-3, 4, -4), 1.2, vec3(0), true, si)) hit = true;
    if (Sphere(o, d, vec3(-0.7, -0.2, -5), 0.8, vec3(0.5, 0.8, 0.5), false, si)) hit = true;
    if (Sphere(o, d, vec3(1, -0.5, -4.8), 0.5, vec3(0.8, 0.6, 0.3), false, si)) hit = true;
    return hit;
}

float PowerHeuristic(float f, float g) { return (f * f) / (f * f + g * g); }

float LightPdf(vec3 p)
{
    vec3 w = vec3(-3, 4, -4) - p;
    float s2 = 1.44 / dot(w, w);
    return (1.0 + sqrt(1.0 - s2)) / (2.0 * Pi * s2);
}

vec3 Li(vec3 o, vec3 d)
{
    vec3 L = vec3(0), beta = vec3(1);
    float lastPdf = 0.0;
    vec3 lastP = vec3(0);
    for (int bounces = 0; bounces < 3; ++bounces)
    {
        SurfaceInteraction si;
        if (!Intersect(o, d, si)) { L += beta * vec3(0.15, 0.2, 0.3); break; }
        if (si.light) { L += beta * 3.0 * (bounces == 0 ? 1.0 : PowerHeuristic(lastPdf, LightPdf(lastP))); break; }
        if (bounces == 2) break;
        vec3 s, t;
        // light
        vec3 wc = normalize(vec3(-3, 4, -4) - si.p);
        float lp = LightPdf(si.p);
        vec2 u = Get2D();
        float cosT = 1.0 - u.x / (2.0 * Pi * lp), sinT = sqrt(max(0.0, 1.0 - cosT * cosT)), phi = 2.0 * Pi * u.y;
        CoordinateSystem(wc, s, t);
        vec3 wi = s * sinT * cos(phi) + t * sinT * sin(phi) + wc * cosT;
        float c = dot(wi, si.n);
        SurfaceInteraction sh;
        if (c > 0.0 && Intersect(si.p, wi, sh) && sh.light) L += beta * si.rho / Pi * c * 3.0 / lp * PowerHeuristic(lp, c / Pi);
        // BRDF
        vec2 dk = ConcentricSampleDisk(Get2D());
        float z = sqrt(max(0.0, 1.0 - dot(dk, dk)));
        CoordinateSystem(si.n, s, t);
        d = s * dk.x + t * dk.y + si.n * z;
        if (z <= 0.0) break;
        o = si.p;
        beta *= si.rho;
        lastPdf = z / Pi;
        lastP = si.p;
    }
    return L;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec3 sum = vec3(0);
    for (int i = 0; i < 16; i++)
    {
        pixelSeed = uint(fragCoord.x) * 73856093u ^ uint(fragCoord.y) * 19349663u ^ uint(i + 16 * iFrame) * 83492791u;
        pixelSeed ^= pixelSeed >> 16; pixelSeed *= 0x7feb352du; pixelSeed ^= pixelSeed >> 15; pixelSeed *= 0x846ca68bu; pixelSeed ^= pixelSeed >> 16;
        dim = 0u;
        vec2 film = fragCoord - 0.5 + Get2D();
        vec2 ndc = film / iResolution.xy * 2.0 - 1.0;
        sum += Li(vec3(0), normalize(vec3(ndc.x, ndc.y * iResolution.y / iResolution.x, -2.0)));
    }
    fragColor = vec4(sum / 15.0, 1.0);
}
