// A harbor at night: water with waves, a pier on piles, lamps with halos, a lighthouse and a moon.
// Written to be reduced: it has many constructs that naga's GLSL front end refuses or translates wrongly, each in
// the place of a realistic program, so that `toyproof reduce --without PASS` has something to do.

#define MAX_STEPS 96
#define FAR 60.0
#define ROT(a) mat2(cos((a) + vec4(0.0, 33.0, 11.0, 0.0)))
#define saturate(x) clamp(x, 0.0, 1.0)

const float PI = 3.14159265;
const int LAMPS = 5;
const vec3 MOON = vec3(0.3, 0.45, -0.8);
float tide = iTime * 0.1;

struct Lamp {
    vec3 position;
    vec3 color;
    float reach;
};

struct Hit {
    float t;
    int material;
    vec3 normal;
};

// Noise ----------------------------------------------------------------------------------------------------

uint scramble(uint x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    return -x;
}

float hash(vec2 p) {
    uvec2 q = uvec2(ivec2(floor(p)) + 1000) % 4096u;
    return float(scramble(q.x + 4096u * q.y) >> 8u) / 16777216.0;
}

float noise(vec2 p) {
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    float a = hash(p), b = hash(p + vec2(1.0, 0.0));
    float c = hash(p + vec2(0.0, 1.0)), d = hash(p + vec2(1.0));
    return mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
}

float fbm(vec2 p, const int octaves) {
    float sum = 0.0, weight = 0.5;
    for (int i = 0; i < octaves; i++) {
        sum += weight * noise(p);
        p = ROT(0.6) * p * 2.03;
        weight *= 0.5;
    }
    return sum;
}

// Shapes ---------------------------------------------------------------------------------------------------

float box(vec3 p, vec3 size) {
    vec3 q = abs(p) - size;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

float pile(vec3 p) {
    p.x = mod(p.x + 1.0, 2.0) - 1.0;
    return max(length(p.xz) - 0.12, abs(p.y) - 0.8);
}

void fold(inout float x, float width) {
    x = abs(x) - width;
}

float pier(vec3 p) {
    vec3 q = p - vec3(0.0, 0.4, -6.0);
    fold(q.z, 0.6);
    float deck = box(p - vec3(0.0, 0.5, -6.0), vec3(8.0, 0.06, 0.9));
    return min(deck, pile(q));
}

float lighthouse(vec3 p) {
    p -= vec3(5.0, 0.0, -14.0);
    float level;
    float inside = modf(p.y * 1.5, level);
    float radius = 0.9 - 0.08 * p.y + 0.05 * vec3(inside > 0.5).x;
    float tower = max(length(p.xz) - radius, abs(p.y - 2.5) - 2.5);
    return min(tower, length(p - vec3(0.0, 5.4, 0.0)) - 0.5);
}

float water(vec3 p) {
    float w = fbm(p.xz * 1.5 + tide, 4) * 0.3 + sin(p.x * 2.0 + iTime) * 0.05;
    return p.y + 0.4 - w;
}

bool nearer(inout Hit hit, float d, int material) {
    if (d < hit.t) {
        hit.t = d;
        hit.material = material;
        return true;
    }
}

Hit map(vec3 p) {
    Hit hit = Hit(FAR, 0, vec3(0.0));
    bool any_hit = nearer(hit, water(p), 1) || nearer(hit, pier(p), 2);
    if (any_hit && p.y > -1.0) nearer(hit, pier(p), 2);
    nearer(hit, lighthouse(p), 3);
    return hit;
}

vec3 normal(vec3 p) {
    mat3 m = mat3(1.0);
    float samples[3];
    for (int i = 0; i < 3; i++) {
        vec3 e = 0.002 * m[i];
        float d;
        d += map(p + e).t - map(p - e).t;
        samples[i] = d;
    }
    return normalize(vec3(samples[0], samples[1], samples[2]));
}

// Light ----------------------------------------------------------------------------------------------------

Lamp lamp(int i) {
    float x = float(i) * 3.0 - 6.0;
    vec3 colors[3] = vec3[](vec3(1.0, 0.8, 0.5), vec3(1.0, 0.7, 0.4), vec3(0.9, 0.9, 0.7));
    return Lamp(vec3(x, 1.6, -6.5), colors[i % 3], 4.0 + 0.5 * float(i));
}

vec3 albedo(int material, vec3 p) {
    vec3 color = vec3(0.02);
    switch (material) {
        case 1:
            color = vec3(0.02, 0.05, 0.08);
            break;
        case 2:
            color += vec3(0.2, 0.14, 0.1) * (0.6 + 0.4 * noise(p.xz * vec2(1.0, 12.0)));
        case 3:
            color += 0.1 * step(0.5, fract(p.y * 0.75));
            break;
        default: {
            color = vec3(0.0);
            break;
        }
    }
    return color;
}

vec3 lamps(vec3 p, vec3 n) {
    vec3 sum = vec3(0.0);
    int i = 0;
    do {
        if (i == 3) continue;
        Lamp l = lamp(i);
        vec3 to = l.position - p;
        float falloff = saturate(1.0 - length(to) / l.reach);
        sum += l.color * falloff * falloff * max(dot(n, normalize(to)), 0.0);
    } while (++i < LAMPS);
    return sum;
}

float halo(vec3 o, vec3 d, Lamp l) {
    vec3 to = l.position - o;
    float along = max(dot(to, d), 0.0);
    float across = length(to - along * d);
    return 0.004 / (0.002 + across * across) * length(l.reach);
}

vec3 sky(vec3 d) {
    vec3 color = mix(vec3(0.02, 0.03, 0.08), vec3(0.0, 0.0, 0.02), saturate(d.y * 2.0));
    float moon = smoothstep(0.995, 0.997, dot(d, normalize(MOON)));
    float stars = step(0.995, hash(floor(d.xy * 400.0)));
    return color + moon * vec3(0.9, 0.9, 0.8) + stars * 0.5 * saturate(d.y);
}

Hit march(vec3 o, vec3 d) {
    float t = 0.01;
    for (int i = 0; i < MAX_STEPS; i++) {
        Hit hit = map(o + t * d);
        if (hit.t < 0.002 * t || t > FAR) {
            hit.t = t;
            return hit;
        }
        t += 0.7 * hit.t;
    }
    return Hit(t, 0, vec3(0.0));
}

vec3 shade(vec3 o, vec3 d, out float t) {
    Hit hit = march(o, d);
    t = hit.t;
    if (t >= FAR) return sky(d);
    vec3 p = o + t * d;
    hit.normal = normal(p);
    vec3 base = albedo(hit.material, p);
    vec3 light = lamps(p, hit.normal) + 0.05 + 0.1 * max(dot(hit.normal, normalize(MOON)), 0.0);
    vec3 color = base * light * 4.0;
    if (hit.material == 1) {
        float fresnel = pow(1.0 - saturate(-dot(hit.normal, d)), 5.0);
        color += fresnel * sky(reflect(d, hit.normal));
    }
    return mix(color, sky(d), 1.0 - exp(-0.002 * t * t));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    vec3 o = vec3(0.0, 1.2, 0.0), d = normalize(vec3(uv, -1.6));
    d.xz *= ROT(0.1 * sin(iTime * 0.3));
    float t;
    vec3 color = shade(o, d, t);
    vec3 halos[2];
    int k = 0;
    for (int i = 0; i < LAMPS; i++) {
        halos[k++ % 2] += lamp(i).color * halo(o, d, lamp(i));
    }
    color += 0.2 * (halos[0] + halos[1]);
    if (isnan(color.x)) color = vec3(1.0, 0.0, 1.0);
    color *= 1.0 - 0.25 * dot(uv, uv) * float(t != FAR);
    fragColor = vec4(pow(color, vec3(1.0 / 2.2)), 1.0);
}
