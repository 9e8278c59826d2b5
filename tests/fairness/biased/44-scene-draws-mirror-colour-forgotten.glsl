// Biased: mirrors without their colour; scene's draws; measured: 32.9 % of the pixels off by > 2/255 once converged, mean 5.25/255, worst 8x8 block 48.5/255 (noise of one run 2.54/255)
// while (true) with breaks, as in a C course

uint state;
uint pcg(uint v)
{
    uint s = v * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}
void rnd(out float value) { state = pcg(state); value = float(state >> 8u) / 16777216.0; }

struct Record { bool ok; float t; vec3 p; vec3 n; int m; };

void ball(vec3 o, vec3 d, float tmin, vec3 c, float r, int m, inout Record rec)
{
    vec3 oc = o - c;
    float b = dot(oc, d), q = b * b - dot(oc, oc) + r * r;
    if (q < 0.0) return;
    float t = -b - sqrt(q);
    if (t <= tmin) t = -b + sqrt(q);
    if (t <= tmin) return;
    if (rec.ok && t >= rec.t) return;
    rec.ok = true; rec.t = t; rec.p = o + t * d; rec.n = normalize(rec.p - c); rec.m = m;
}

Record query(vec3 o, vec3 d, float tmin)
{
    Record rec = Record(false, 0.0, vec3(0.0), vec3(0.0), 0);
    ball(o, d, tmin, vec3(-1.1, 0.0, -5.0), 1.0, 1, rec);
    ball(o, d, tmin, vec3(1.0, -0.4, -4.6), 0.6, 2, rec);
    ball(o, d, tmin, vec3(0.1, -0.7, -3.8), 0.3, 3, rec);
    if (d.y != 0.0) {
        float t = -(o.y + 1.03) / d.y;
        if (t > tmin && (!rec.ok || t < rec.t)) { rec.ok = true; rec.t = t; rec.p = o + t * d; rec.n = vec3(0, 1, 0); rec.m = 4; }
    }
    return rec;
}

vec3 look(vec3 o, vec3 d)
{
    vec3 k = vec3(1.0);
    int segment = 0;
    while (true)
    {
        segment++;
        Record r = query(o, d, 3e-4);
        if (!r.ok) return k * vec3(0.35, 0.45, 0.6);
        if (r.m == 1 || r.m == 2)
        {
            if (segment == 4) break;
            o = r.p;
            d = d - 2.0 * dot(d, r.n) * r.n;
            continue;
        }
        vec3 albedo = vec3(0.8, 0.2, 0.2);
        if (r.m == 4) albedo = mod(floor(r.p.x) + floor(r.p.z), 2.0) == 1.0 ? vec3(0.4, 0.5, 0.6) : vec3(0.8, 0.7, 0.5);
        vec3 axis = vec3(0.0, 5.0, -4.0) - r.p;
        float far = length(axis);
        axis /= far;
        float u, v;
        rnd(u);
        rnd(v);
        float ct = 1.0 - u * (1.0 - sqrt(1.0 - 1.21 / (far * far)));
        float st = sqrt(1.0 - ct * ct);
        vec3 ref = vec3(0.0, 1.0, 0.0);
        if (abs(axis.y) > 0.9) ref = vec3(1.0, 0.0, 0.0);
        vec3 a = normalize(cross(ref, axis));
        vec3 b = cross(axis, a);
        vec3 l = st * cos(6.2831853072 * v) * a + st * sin(6.2831853072 * v) * b + ct * axis;
        float nl = dot(r.n, l);
        vec3 light = vec3(0.2);
        if (nl > 0.0)
        {
            float reach = far * ct - sqrt(max(0.0, 1.21 - far * far * st * st));
            Record s = query(r.p, l, 3e-4);
            if (!s.ok || s.t > reach) light += 0.75 * nl;
        }
        return k * albedo * light;
    }
    return vec3(0.0);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec3 all = vec3(0.0);
    int i = 0;
    do {
        state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
        float dx, dy;
        rnd(dx);
        rnd(dy);
        vec2 at = (fragCoord + vec2(dx - 0.5, dy - 0.5)) / iResolution.xy * 2.0 - 1.0;
        all += look(vec3(0.0), normalize(vec3(at.x, at.y * iResolution.y / iResolution.x, -2.0)));
        i++;
    } while (i < 9);
    fragColor = vec4(all / 9.0, 1.0);
}
