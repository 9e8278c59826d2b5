// The lamp hangs in the picture, its glass bulb a hair smaller than the lamp itself. The cone is taken where the shadow ray starts, a millimetre above the surface.

#define PI2 6.283185307179586
struct P3 { vec3 pos; vec3 nrm; vec3 kd; };
uint z;
uint pcg(uint v) { v = v * 747796405u + 2891336453u; v = ((v >> ((v >> 28u) + 4u)) ^ v) * 277803737u; return v ^ (v >> 22u); }
float U() { return float((z = pcg(z)) >> 8u) / 16777216.; }

const vec4 LAMP = vec4(1.6, .9, -6., .45);

float ball(vec3 o, vec3 d, vec4 s)
{
    o -= s.xyz;
    float b = -dot(o, d);
    float D = b * b - dot(o, o) + s.w * s.w;
    return D < 0. ? -1. : b - sqrt(D);
}

bool blocked(vec3 o, vec3 d, float far)
{
    float t = ball(o, d, vec4(-.3, -.3, -5.2, .7));
    if (t > 0. && t < far) return true;
    t = ball(o, d, vec4(.9, -.75, -4.4, .25));
    if (t > 0. && t < far) return true;
    t = (-1. - o.y) / d.y;
    return t > 0. && t < far;
}

vec3 Li(P3 s)
{
    vec3 o = s.pos + .001 * s.nrm;
    vec3 w = LAMP.xyz - o;
    float d = length(w);
    w /= d;
    float sm = LAMP.w / d;
    float cm = sqrt(1. - sm * sm);
    float u = U(), v = U();
    float c = 1. - u * (1. - cm);
    float sn = sqrt(1. - c * c);
    vec3 a = normalize(cross(abs(w.y) > .9 ? vec3(1, 0, 0) : vec3(0, 1, 0), w)), b = cross(w, a);
    vec3 l = a * (sn * cos(PI2 * v)) + b * (sn * sin(PI2 * v)) + w * c;
    float cosine = dot(l, s.nrm);
    if (cosine <= 0.) return vec3(0.);
    float end = ball(o, l, vec4(LAMP.xyz, LAMP.w));
    if (end < 0.) end = d * c;
    return blocked(o, l, end) ? vec3(0.) : cosine * vec3(.9, .85, .7);
}

vec3 shoot(vec2 px)
{
    vec3 d = normalize(vec3((px - .5 * iResolution.xy) / iResolution.x, -1.));
    float t = 1e8, x;
    int w = 0;
    x = ball(vec3(0), d, vec4(LAMP.xyz, .4499));    if (x > 0. && x < t) { t = x; w = 1; }
    x = ball(vec3(0), d, vec4(-.3, -.3, -5.2, .7)); if (x > 0. && x < t) { t = x; w = 2; }
    x = ball(vec3(0), d, vec4(.9, -.75, -4.4, .25)); if (x > 0. && x < t) { t = x; w = 3; }
    x = -1. / d.y;                                  if (x > 0. && x < t) { t = x; w = 4; }
    P3 s;
    s.pos = t * d;
    if (w == 0) return vec3(.05, .05, .1);
    if (w == 1) return vec3(.95, .9, .75);
    if (w == 2) { s.nrm = normalize(s.pos - vec3(-.3, -.3, -5.2)); s.kd = vec3(.8); }
    if (w == 3) { s.nrm = normalize(s.pos - vec3(.9, -.75, -4.4)); s.kd = vec3(.9, .5, .2); }
    if (w == 4) { s.nrm = vec3(0, 1, 0); s.kd = mod(floor(s.pos.x) + floor(s.pos.z), 2.) == 0. ? vec3(.6, .6, .7) : vec3(.5, .3, .3); }
    return s.kd * (.1 + Li(s));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec4 sum = vec4(0);
    for (int i = 0; i < 16; i++)
    {
        z = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
        float x = U(), y = U();
        sum += vec4(shoot(fragCoord + vec2(x, y) - .5), 1.);
    }
    fragColor = sum / sum.w;
}
