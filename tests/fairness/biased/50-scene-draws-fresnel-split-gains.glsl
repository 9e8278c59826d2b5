// Biased: refracted part not reduced by what is reflected: glass gives more light than it gets; scene's draws; measured: 20.4 % of the pixels off by > 2/255 once converged, mean 4.42/255, worst 8x8 block 43.0/255 (noise of one run 0.97/255)
float seed;
float random() { return fract(sin(seed++) * 43758.5453123); }

struct Sphere { vec3 c; float r; vec3 col; bool glass; };
Sphere world[3];

float inter(vec3 o, vec3 d, Sphere s) {
    vec3 v = s.c - o;
    float b = dot(v, d), det = b * b - dot(v, v) + s.r * s.r;   // smallpt
    if (det < 0.) return 0.;
    det = sqrt(det);
    if (b - det > 1e-4) return b - det;
    if (b + det > 1e-4) return b + det;
    return 0.;
}

int castRay(vec3 o, vec3 d, out float t) {
    int id = -1;
    t = 1e20;
    for (int i = 0; i < 3; i++) {
        float x = inter(o, d, world[i]);
        if (x != 0. && x < t) { t = x; id = i; }
    }
    return id;
}

vec3 radiance(vec3 o, vec3 d) {
    vec3 O[6], D[6], K[6]; int Z[6];
    O[0] = o; D[0] = d; K[0] = vec3(1); Z[0] = 1;
    int n = 1;
    vec3 L = vec3(0);
    while (n > 0) {
        n--;
        o = O[n]; d = D[n];
        vec3 k = K[n];
        int z = Z[n];
        float t;
        int id = castRay(o, d, t);
        if (id < 0) { L += k * mix(vec3(.8, .8, .9), vec3(.3, .35, .6), .5 * (1. + d.y)); continue; }
        Sphere s = world[id];
        vec3 x = o + d * t;
        vec3 nn = normalize(x - s.c);
        if (!s.glass) {
            vec3 l = vec3(-3, 5, 0) - x;
            float dist = length(l);
            l /= dist;
            float ts;
            float vis = castRay(x, l, ts) >= 0 && ts < dist ? 0. : 1.;
            L += k * s.col * (.25 + .7 * vis * max(dot(nn, l), 0.));
            continue;
        }
        if (z == 5) continue;
        bool into = dot(nn, d) < 0.;
        vec3 nl = into ? nn : -nn;
        float nc = 1., nt = 1.5, nnt = into ? nc / nt : nt / nc, ddn = dot(d, nl);
        float cos2t = 1. - nnt * nnt * (1. - ddn * ddn);
        k *= s.col;
        vec3 refl = d - nn * 2. * dot(nn, d);
        if (cos2t < 0.) { O[n] = x; D[n] = refl; K[n] = k; Z[n] = z + 1; n++; continue; }
        float ct = sqrt(cos2t), ci = -ddn;
        vec3 tdir = normalize(d * nnt - nl * (ddn * nnt + ct));
        float ni = into ? nc : nt, no = into ? nt : nc;
        float perp = (ni * ci - no * ct) / (ni * ci + no * ct), par = (no * ci - ni * ct) / (no * ci + ni * ct);
        float Re = (perp * perp + par * par) * .5, Tr = 1.;
        O[n] = x; D[n] = refl; K[n] = k * Re; Z[n] = z + 1; n++;
        O[n] = x; D[n] = tdir; K[n] = k * Tr; Z[n] = z + 1; n++;
    }
    return L;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    world[0] = Sphere(vec3(0., -60.9, -6.), 60., vec3(.5, .6, .5), false);
    world[1] = Sphere(vec3(-.4, -.1, -3.8), .7, vec3(1., .95, .9), true);
    world[2] = Sphere(vec3(1.1, .2, -6.), .9, vec3(.7, .2, .5), false);
    seed = 0.;
    vec3 c = vec3(0);
    for (int s = 0; s < 8; s++) {
        float dx = random() - .5;
        float dy = random() - .5;
        vec2 p = (fragCoord + vec2(dx, dy)) / iResolution.xy * 2. - 1.;
        c += radiance(vec3(0), normalize(vec3(p.x, p.y * iResolution.y / iResolution.x, -2.)));
    }
    fragColor = vec4(c / 8., 1.);
}
