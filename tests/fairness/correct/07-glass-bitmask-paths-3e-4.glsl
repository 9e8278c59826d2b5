// Every way through the glass is a word of four letters, "reflect" or "refract": all 16 words are walked one after
// another. A word that ends early counts once, with the unused letters zero.

const vec3 center = vec3(.1, -.2, -4.);

vec3 scene(vec3 ro, vec3 rd, out float tmin)
{
    vec3 c = vec3(.1, .15, .2);
    tmin = 1e10;
    float t = (-1.47 - ro.y) / rd.y;
    if (t > 3e-4 && t < tmin) {
        tmin = t;
        vec2 q = floor((ro + t * rd).xz);
        c = abs(rd.y) * (fract((q.x + q.y) * .5) > .25 ? vec3(.3, .3, .6) : vec3(.8));
    }
    t = (-2.5 - ro.x) / rd.x;
    if (t > 3e-4 && t < tmin) { tmin = t; c = abs(rd.x) * vec3(.9, .3, .2); }
    t = (2.5 - ro.x) / rd.x;
    if (t > 3e-4 && t < tmin) { tmin = t; c = abs(rd.x) * vec3(.2, .7, .3); }
    return c;
}

vec3 walk(vec3 ro, vec3 rd, int word)
{
    float w = 1.;
    for (int seg = 0; seg < 5; seg++)
    {
        float tw;
        vec3 c = scene(ro, rd, tw);
        vec3 oc = ro - center;
        float b = dot(oc, rd), h = b * b - dot(oc, oc) + 1.;
        float t = -1.;
        if (h > 0.) { t = -b - sqrt(h); if (t < 3e-4) t = -b + sqrt(h); }
        if (t < 3e-4 || t > tw)
            return (word >> seg) == 0 ? w * c : vec3(0.);
        if (seg == 4) return vec3(0.);
        ro += t * rd;
        vec3 n = ro - center;
        float eta = 1.52;
        if (dot(n, rd) < 0.) eta = 1. / eta; else n = -n;
        float ci = -dot(n, rd);
        float g2 = 1. / (eta * eta) - 1. + ci * ci;      // the g of Cook and Torrance
        float F = 1.;
        if (g2 > 0.) {
            float g = sqrt(g2);
            float p = (g - ci) / (g + ci);
            float q = (ci * (g + ci) - 1.) / (ci * (g - ci) + 1.);
            F = .5 * p * p * (1. + q * q);
        }
        if (((word >> seg) & 1) == 0) { w *= F; rd = reflect(rd, n); }
        else {
            w *= 1. - F;
            if (F >= 1.) return vec3(0.);
            rd = refract(rd, n, eta);
        }
    }
    return vec3(0.);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 uv = (fragCoord / iResolution.xy - .5) * 2.;
    uv.y /= iResolution.x / iResolution.y;
    vec3 rd = normalize(vec3(uv, -2.));
    vec3 c = vec3(0.);
    for (int word = 0; word < 16; word++) c += walk(vec3(0.), rd, word);
    fragColor = vec4(c, 1.);
}
