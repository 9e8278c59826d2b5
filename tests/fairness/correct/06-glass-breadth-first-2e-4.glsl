// Level by level: all rays of one generation are traced, their children are the next generation.

const int   W   = 8;       // 2^(4-1) rays at most in the last generation
const float OFF = 0.0002;  // along the new ray

float march(vec3 o, vec3 d, vec3 c, float r)
{
    float tm = dot(c - o, d);
    vec3 x = o + tm * d - c;
    float g = r * r - dot(x, x);
    if (g <= 0.) return -1.;
    g = sqrt(g);
    return tm > g ? tm - g : tm + g;
}

void marble(int i, out vec3 c, out float r, out vec3 k, out float n)
{
    n = 1.5;
    if (i == 0)      { c = vec3(-.9, -.2, -3.2); r = .4;  k = vec3(.7, 1., .8); }
    else if (i == 1) { c = vec3(0., -.1, -3.8);  r = .5;  k = vec3(1.); }
    else if (i == 2) { c = vec3(.9, -.25, -3.);  r = .35; k = vec3(1., .7, .7); }
    else             { c = vec3(.5, .5, -5.);    r = .45; k = vec3(.8, .8, 1.); n = 1.3; }
}

vec3 floorTile(vec3 p)
{
    // no lamp in this picture, only the ambient light
    return vec3(.35, .33, .3) * (int(floor(p.x * 2.) + floor(p.z * 2.)) % 2 == 0 ? vec3(.6, .7, .6) : vec3(.9));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 s = 2. * fragCoord / iResolution.xy - 1.;
    s.y *= iResolution.y / iResolution.x;

    vec3 po[W], pd[W], pk[W];
    int have = 1;
    po[0] = vec3(0.); pd[0] = normalize(vec3(s, -2.)); pk[0] = vec3(1.);
    vec3 rgb = vec3(0.);

    for (int gen = 1; gen <= 4; gen++)
    {
        vec3 no[W], nd[W], nk[W];
        int next = 0;
        for (int j = 0; j < have; j++)
        {
            vec3 o = po[j], d = pd[j], k = pk[j];
            float best = 1e6;
            int who = -1;
            vec3 c, kc; float r, n;
            for (int i = 0; i < 4; i++) {
                marble(i, c, r, kc, n);
                float t = march(o, d, c, r);
                if (t > 0. && t < best) { best = t; who = i; }
            }
            float tp = (-.61 - o.y) / d.y;
            if (tp > 0. && tp < best) { rgb += k * floorTile(o + tp * d); continue; }
            if (who < 0) { rgb += k * mix(vec3(.9, .9, 1.), vec3(.4, .3, .6), .5 * (1. + d.y)); continue; }
            if (gen == 4) continue;
            marble(who, c, r, kc, n);
            vec3 p = o + best * d;
            vec3 m = (p - c) / r;
            float e = 1. / n;
            if (dot(m, d) > 0.) { m = -m; e = n; }
            float ci = -dot(m, d);
            vec3 a = reflect(d, m), b = refract(d, m, e);
            float F = 1.;
            if (b != vec3(0.)) {
                float ct = -dot(m, b);
                float rs = (e * ci - ct) / (e * ci + ct), rp = (e * ct - ci) / (e * ct + ci);
                F = .5 * rs * rs + .5 * rp * rp;
                no[next] = p + OFF * b; nd[next] = b; nk[next] = k * kc * (1. - F); next++;
            }
            no[next] = p + OFF * a; nd[next] = a; nk[next] = k * kc * F; next++;
        }
        have = next;
        for (int j = 0; j < have; j++) { po[j] = no[j]; pd[j] = nd[j]; pk[j] = nk[j]; }
    }
    fragColor = vec4(rgb, 1.);
}
