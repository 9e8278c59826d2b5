// Homework 6 - glass ball. Stack because GLSL cannot recurse.
#define EPS 1e-4
#define FAR 1e5

const vec3 glassC = vec3(0., 0., -4.5);
const float glassR = 1.0;
const vec3 redC = vec3(1.7, -0.5, -6.0);
const float redR = 0.6;
const float floorY = -1.07;

float hitBall(vec3 ro, vec3 rd, vec3 c, float r)
{
    vec3 oc = ro - c;
    float b = dot(oc, rd);
    float h = b*b - (dot(oc, oc) - r*r);
    if (h < 0.0) return FAR;
    h = sqrt(h);
    if (-b - h > 0.0) return -b - h;
    if (-b + h > 0.0) return -b + h;
    return FAR;
}

float hitFloor(vec3 ro, vec3 rd)
{
    float t = (floorY - ro.y) / rd.y;
    return t > 0.0 ? t : FAR;
}

vec3 sky(vec3 rd) { return mix(vec3(.85, .88, .95), vec3(.25, .45, .85), .5 + .5*rd.y); }

vec3 lit(vec3 p, vec3 n, vec3 albedo)
{
    vec3 q = p + EPS*n;
    vec3 l = vec3(5., 8., 2.) - q;
    float d = length(l);
    l /= d;
    float s = 1.0;
    if (hitBall(q, l, glassC, glassR) < d) s = 0.0;
    if (hitBall(q, l, redC, redR) < d) s = 0.0;
    if (hitFloor(q, l) < d) s = 0.0;
    return albedo * (vec3(0.2) + s * max(dot(n, l), 0.0) * vec3(.75, .75, .7));
}

float fresnelExact(float ci, float ct, float n1, float n2)
{
    float rs = (n1*ci - n2*ct) / (n1*ci + n2*ct);
    float rp = (n1*ct - n2*ci) / (n1*ct + n2*ci);
    return 0.5*(rs*rs + rp*rp);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 uv = (2.0*fragCoord - iResolution.xy) / iResolution.x;

    vec3 sRo[10]; vec3 sRd[10]; float sW[10]; int sD[10];
    int sp = 0;
    sRo[0] = vec3(0.0); sRd[0] = normalize(vec3(uv, -2.0)); sW[0] = 1.0; sD[0] = 1;
    sp = 1;

    vec3 col = vec3(0.0);
    for (int guard = 0; guard < 200; guard++)
    {
        if (sp == 0) break;
        sp--;
        vec3 ro = sRo[sp], rd = sRd[sp];
        float w = sW[sp];
        int dep = sD[sp];

        float tg = hitBall(ro, rd, glassC, glassR);
        float tr = hitBall(ro, rd, redC, redR);
        float tf = hitFloor(ro, rd);
        float t = min(tg, min(tr, tf));

        if (t >= FAR) { col += w*sky(rd); continue; }
        vec3 p = ro + t*rd;
        if (t == tr) { col += w*lit(p, (p - redC)/redR, vec3(.8, .3, .2)); continue; }
        if (t == tf) {
            bool odd = mod(floor(p.x) + floor(p.z), 2.0) > 0.5;
            col += w*lit(p, vec3(0., 1., 0.), odd ? vec3(.2, .25, .3) : vec3(.85, .85, .8));
            continue;
        }
        // glass
        if (dep >= 6) continue;
        vec3 n = (p - glassC)/glassR;
        float n1 = 1.0, n2 = 1.5;
        if (dot(n, rd) > 0.0) { n = -n; n1 = 1.5; n2 = 1.0; }
        vec3 refr = refract(rd, n, n1/n2);
        float F = 1.0;
        if (dot(refr, refr) > 0.0)
        {
            F = fresnelExact(-dot(n, rd), -dot(n, refr), n1, n2);
            sRo[sp] = p - EPS*n; sRd[sp] = refr; sW[sp] = w*(1.0 - F); sD[sp] = dep + 1; sp++;
        }
        sRo[sp] = p + EPS*n; sRd[sp] = reflect(rd, n); sW[sp] = w*F; sD[sp] = dep + 1; sp++;
    }
    fragColor = vec4(col, 1.0);
}
