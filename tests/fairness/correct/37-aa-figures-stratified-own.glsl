// Class 1: inside or outside, 16 cells in the pixel with one dart in each.

float dart(vec2 p, float k)
{
    vec3 q = fract(vec3(p.xyx) * vec3(.1031, .1030, .0973) + k * vec3(.618, .414, .732));
    q += dot(q, q.yzx + 33.33);
    return fract((q.x + q.y) * q.z);
}

bool sun(vec2 p)   { p -= vec2(.4, .2); return p.x * p.x + p.y * p.y < .04; }
bool heart(vec2 p) { vec2 u = (p - vec2(-.45, .1)) / .2; float a = u.x * u.x + u.y * u.y - 1.; return a * a * a < u.x * u.x * u.y * u.y * u.y; }
bool sea(vec2 p)   { return p.y < -.25 + .05 * sin(14. * p.x); }

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec3 c = vec3(0.);
    for (int i = 0; i < 16; i++)
    {
        float k = float(i) + 16. * float(iFrame);
        vec2 cell = vec2(i & 3, i >> 2);
        vec2 f = floor(fragCoord) + (cell + vec2(dart(fragCoord, 2. * k), dart(fragCoord.yx + 71.7, 2. * k + 1.))) / 4.;
        vec2 p = (2. * f - iResolution.xy) / iResolution.x;
        vec3 s = vec3(.8, .9, .95);
        if (sun(p)) s = vec3(1., .8, .3);
        if (heart(p)) s = vec3(.8, .1, .25);
        if (sea(p)) s = vec3(.1, .3, .5);
        c += s;
    }
    fragColor = vec4(c / 16., 1.);
}
