// Biased: a lamp that a bounce meets is thrown away although nobody samples it directly; own random numbers; measured: 50.6 % of the pixels off by > 2/255 once converged, mean 15.01/255, worst 8x8 block 58.5/255 (noise of one run 1.30/255)
// Next Week's style: no light is asked, rays run into it. scatter = normal + random unit vector.

uint seed;
uint nextU() { seed ^= seed << 13; seed ^= seed >> 17; seed ^= seed << 5; return seed; }
float random_float() { return float(nextU() & 0xFFFFFFu) / 16777216.0; }

vec3 random_unit_vector()
{
    float z = 1.0 - 2.0 * random_float();
    float a = 6.283185307 * random_float();
    float r = sqrt(max(0.0, 1.0 - z * z));
    return vec3(r * cos(a), r * sin(a), z);
}

struct HitInfo { float t; vec3 n; vec3 albedo; vec3 emit; };

void sphere(vec3 ro, vec3 rd, vec3 c, float r, vec3 albedo, vec3 emit, inout HitInfo h)
{
    vec3 oc = ro - c;
    float hb = dot(oc, rd);
    float disc = hb * hb - dot(oc, oc) + r * r;
    if (disc < 0.0) return;
    float s = sqrt(disc);
    float t = -hb - s;
    if (t < 0.001) t = -hb + s;
    if (t < 0.001 || t > h.t) return;
    h = HitInfo(t, (ro + t * rd - c) / r, albedo, emit);
}

vec3 ray_color(vec3 ro, vec3 rd)
{
    vec3 attenuation = vec3(1.0);
    for (int depth = 3; depth > 0; depth--)
    {
        HitInfo h = HitInfo(1e9, vec3(0.0), vec3(0.0), vec3(0.0));
        float t = (-1.0 - ro.y) / rd.y;
        if (t > 0.001) h = HitInfo(t, vec3(0.0, 1.0, 0.0), vec3(0.8, 0.8, 0.75), vec3(0.0));
        sphere(ro, rd, vec3(2.0, 6.0, -6.0), 3.0, vec3(0.0), vec3(1.6, 1.5, 1.4), h);
        sphere(ro, rd, vec3(-1.0, -0.2, -5.0), 0.8, vec3(0.9, 0.5, 0.3), vec3(0.0), h);
        sphere(ro, rd, vec3(0.8, -0.4, -5.5), 0.6, vec3(0.4, 0.7, 0.4), vec3(0.0), h);
        if (h.t > 1e8) return attenuation * vec3(0.25, 0.3, 0.4);
        if (h.emit.x > 0.0) return depth == 3 ? h.emit : vec3(0.0);
        attenuation *= h.albedo;
        ro += h.t * rd;
        vec3 dir = h.n + random_unit_vector();
        if (dot(dir, dir) < 1e-10) dir = h.n;
        rd = normalize(dir);
    }
    return vec3(0.0);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    seed = uint(fragCoord.x) * 2654435761u ^ uint(fragCoord.y) * 2246822519u ^ uint(iFrame) * 3266489917u;
    seed ^= seed >> 15; seed *= 2246822519u; seed ^= seed >> 13; seed *= 3266489917u; seed ^= seed >> 16;
    seed |= 1u;
    vec3 pixel = vec3(0.0);
    for (int s = 0; s < 64; s++)
    {
        float u = (fragCoord.x - 0.5 + random_float()) / iResolution.x;
        float v = (fragCoord.y - 0.5 + random_float()) / iResolution.y;
        vec3 dir = vec3(2.0 * u - 1.0, (2.0 * v - 1.0) * iResolution.y / iResolution.x, -2.0);
        pixel += ray_color(vec3(0.0), normalize(dir));
    }
    fragColor = vec4(pixel / 64.0, 1.0);
}
