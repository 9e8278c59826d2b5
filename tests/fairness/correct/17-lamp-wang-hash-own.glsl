// Wang hash (reedbeta). Every sample has its own seed, so the loop order does not matter.

uint wang_hash(uint seed)
{
    seed = (seed ^ 61u) ^ (seed >> 16);
    seed *= 9u;
    seed = seed ^ (seed >> 4);
    seed *= 0x27d4eb2du;
    seed = seed ^ (seed >> 15);
    return seed;
}
uint g_seed;
float wrand() { g_seed = wang_hash(g_seed); return float(g_seed) / 4294967296.0; }
vec2 wrand2() { float a = wrand(); float b = wrand(); return vec2(a, b); }

vec4 S[4];
vec3 A[4];

float iSphere(vec3 ro, vec3 rd, int i)
{
    vec3 L = S[i].xyz - ro;
    float tca = dot(L, rd);
    float d2 = dot(L, L) - tca*tca;
    if (d2 >= S[i].w*S[i].w) return 1e30;
    float thc = sqrt(S[i].w*S[i].w - d2);
    float t0 = tca - thc, t1 = tca + thc;
    if (t0 > 0.001) return t0;
    if (t1 > 0.001) return t1;
    return 1e30;
}

vec3 directLight(vec3 x, vec3 n)
{
    vec3 to = vec3(4, 4, -2) - x;
    float dc = length(to);
    vec3 dir = to/dc;
    float sinMax2 = 2.25/(dc*dc);
    vec2 xi = wrand2();
    // 1 - cos by halves, to keep digits
    float oneMinusCos = xi.x*(sinMax2/(1.0 + sqrt(1.0 - sinMax2)));
    float ct = 1.0 - oneMinusCos;
    float st = sqrt(oneMinusCos*(2.0 - oneMinusCos));
    vec3 helper = abs(dir.x) > 0.5 ? vec3(0, 0, 1) : vec3(1, 0, 0);
    vec3 s = normalize(cross(dir, helper));
    vec3 t = cross(s, dir);
    float phi = 6.283185307*xi.y;
    vec3 l = ct*dir + st*(cos(phi)*s + sin(phi)*t);
    float ndl = dot(n, l);
    if (ndl <= 0.0) return vec3(0);
    float lampAt = dc*ct - sqrt(max(2.25 - dc*dc*st*st, 0.0));
    for (int i = 0; i < 4; i++)
        if (iSphere(x, l, i) < lampAt) return vec3(0);
    return vec3(0.7*ndl);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    S[0] = vec4(0, -31, -7, 30);      A[0] = vec3(0.7);
    S[1] = vec4(-0.8, -0.1, -5.5, 0.8); A[1] = vec3(0.9, 0.6, 0.2);
    S[2] = vec4(1.1, -0.35, -5, 0.6); A[2] = vec3(0.3, 0.5, 0.9);
    S[3] = vec4(0.2, 0.8, -6.5, 0.5); A[3] = vec3(0.4, 0.8, 0.4);
    uint pix = uint(fragCoord.y)*uint(iResolution.x) + uint(fragCoord.x);
    vec3 c = vec3(0);
    for (int k = 0; k < 16; k++)
    {
        g_seed = wang_hash(wang_hash(pix*16u + uint(k)) + uint(iFrame)*0x9e3779b9u);
        vec2 uv = (fragCoord + wrand2() - 0.5)/iResolution.xy;
        vec3 rd = normalize(vec3((uv*2.0 - 1.0)*vec2(1.0, iResolution.y/iResolution.x), -2.0));
        float t = 1e30; int id = -1;
        for (int i = 0; i < 4; i++) { float x = iSphere(vec3(0), rd, i); if (x < t) { t = x; id = i; } }
        if (id < 0) { c += vec3(0.6, 0.7, 0.8); continue; }
        vec3 p = rd*t;
        c += A[id]*(vec3(0.2) + directLight(p, normalize(p - S[id].xyz)));
    }
    fragColor = vec4(c/16.0, 1.0);
}
