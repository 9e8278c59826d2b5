// Biased: the cone has twice the half angle: penumbrae too wide; own random numbers; measured: 21.7 % of the pixels off by > 2/255 once converged, mean 0.49/255, worst 8x8 block 10.8/255 (noise of one run 1.28/255)
// The one-liner that everybody uses, with a third coordinate that counts the calls.

vec3 rs;
float rand()
{
    rs.z += 1.;
    return fract(sin(dot(rs, vec3(12.9898, 78.233, 37.719))) * 43758.5453);
}

float sph(vec3 o, vec3 d, vec3 c, float r, float tmin)
{
    vec3 k = o - c;
    float b = dot(k, d), q = b*b - dot(k, k) + r*r;
    if (q < 0.) return 1e9;
    q = sqrt(q);
    float t = -b - q;
    if (t < tmin) t = -b + q;
    return t < tmin ? 1e9 : t;
}
float world(vec3 o, vec3 d, float tmin, out int m)
{
    float t = 1e9, x;
    m = 0;
    x = (-.8 - o.y)/d.y;                                  if (x > tmin && x < t) { t = x; m = 1; }
    x = sph(o, d, vec3(0., 0., -5.), .8, tmin);           if (x < t) { t = x; m = 2; }
    x = sph(o, d, vec3(1.4, -.3, -4.5), .5, tmin);        if (x < t) { t = x; m = 3; }
    return t;
}

vec3 sample_(vec2 fc)
{
    vec2 q = (fc*2. - iResolution.xy)/iResolution.x;
    vec3 d = normalize(vec3(q, -2.));
    int m;
    float t = world(vec3(0.), d, 0., m);
    if (m == 0) return mix(vec3(.9, .6, .4), vec3(.3, .3, .5), .5 + .5*d.y);
    vec3 p = t*d, n = vec3(0., 1., 0.), k = vec3(.6, .65, .6);
    if (m == 2) { n = normalize(p - vec3(0., 0., -5.)); k = vec3(.8); }
    if (m == 3) { n = normalize(p - vec3(1.4, -.3, -4.5)); k = vec3(.8, .3, .5); }
    vec3 w = vec3(-4., 3., -4.) - p;
    float dist = length(w);
    w = w/dist;
    float cosA = cos(2.*asin(.9/dist));
    float cosT = 1. - rand()*(1. - cosA);
    float sinT = sqrt(1. - cosT*cosT);
    float f = rand()*6.2831853;
    vec3 a = normalize(abs(w.z) < .8 ? cross(w, vec3(0., 0., 1.)) : cross(w, vec3(1., 0., 0.)));
    vec3 b = cross(a, w);
    vec3 l = w*cosT + (a*cos(f) + b*sin(f))*sinT;
    float nl = max(dot(n, l), 0.);
    int dummy;
    if (nl > 0. && world(p, l, .0005, dummy) < dist*cosT - sqrt(max(.81 - dist*dist*sinT*sinT, 0.))) nl = 0.;
    return k*(vec3(.25, .22, .2) + vec3(.7, .6, .5)*nl);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    rs = vec3(fragCoord, 100.*float(iFrame));
    vec3 s = vec3(0.);
    for (int i = 0; i < 25; i++) { float a = rand(); float b = rand(); s += sample_(fragCoord + vec2(a, b) - .5); }
    fragColor = vec4(s/25., 1.);
}
