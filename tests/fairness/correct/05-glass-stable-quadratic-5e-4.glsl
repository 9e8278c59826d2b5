// Numerically stable quadratic (pbrt / scratchapixel): q = -1/2 (b + sign(b) sqrt(disc)), t0 = q/a, t1 = c/q.
bool solveQuadratic(const float a, const float b, const float c, out float x0, out float x1)
{
    float discr = b * b - 4.0 * a * c;
    if (discr < 0.0) return false;
    else if (discr == 0.0) { x0 = x1 = -0.5 * b / a; }
    else {
        float q = (b > 0.0) ? -0.5 * (b + sqrt(discr)) : -0.5 * (b - sqrt(discr));
        x0 = q / a;
        x1 = c / q;
    }
    if (x0 > x1) { float s = x0; x0 = x1; x1 = s; }
    return true;
}

struct Ball { vec3 c; float r; vec3 tint; float ior; };
const int NB = 3;
Ball balls[NB];
const float BIAS = 0.0005;

int intersectAll(vec3 orig, vec3 dir, out float tNear)
{
    int id = -1;
    tNear = 1e20;
    for (int i = 0; i < NB; i++) {
        float a, b;
        vec3 L = orig - balls[i].c;
        if (!solveQuadratic(dot(dir, dir), 2.0 * dot(dir, L), dot(L, L) - balls[i].r * balls[i].r, a, b)) continue;
        if (a < 0.0) a = b;
        if (a < 0.0) continue;
        if (a < tNear) { tNear = a; id = i; }
    }
    float t = (-9.0 - orig.z) / dir.z;
    if (t > 0.0 && t < tNear) { tNear = t; id = NB; }
    return id;
}

// scratchapixel's fresnel(I, N, ior, kr)
float fresnel(vec3 I, vec3 N, float ior)
{
    float cosi = clamp(dot(I, N), -1.0, 1.0);
    float etai = 1.0, etat = ior;
    if (cosi > 0.0) { float s = etai; etai = etat; etat = s; }
    float sint = etai / etat * sqrt(max(0.0, 1.0 - cosi * cosi));
    if (sint >= 1.0) return 1.0;
    float cost = sqrt(max(0.0, 1.0 - sint * sint));
    cosi = abs(cosi);
    float Rs = ((etat * cosi) - (etai * cost)) / ((etat * cosi) + (etai * cost));
    float Rp = ((etai * cosi) - (etat * cost)) / ((etai * cosi) + (etat * cost));
    return (Rs * Rs + Rp * Rp) / 2.0;
}

vec3 refractRay(vec3 I, vec3 N, float ior)
{
    float cosi = clamp(dot(I, N), -1.0, 1.0);
    float etai = 1.0, etat = ior;
    vec3 n = N;
    if (cosi < 0.0) cosi = -cosi;
    else { etai = ior; etat = 1.0; n = -N; }
    float eta = etai / etat;
    float k = 1.0 - eta * eta * (1.0 - cosi * cosi);
    return k < 0.0 ? vec3(0.0) : eta * I + (eta * cosi - sqrt(k)) * n;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    balls[0] = Ball(vec3(-1.2, 0.0, -4.5), 0.6, vec3(1.0), 1.2);
    balls[1] = Ball(vec3(0.0, 0.2, -4.0), 0.5, vec3(0.8, 0.9, 1.0), 1.6);
    balls[2] = Ball(vec3(1.2, -0.1, -4.5), 0.65, vec3(1.0, 0.8, 0.8), 2.4);

    vec3 dir = normalize(vec3(fragCoord.x - 0.5 * iResolution.x, fragCoord.y - 0.5 * iResolution.y, -iResolution.x));

    vec3 O[6]; vec3 D[6]; vec3 W[6]; int Z[6];
    O[0] = vec3(0.0); D[0] = dir; W[0] = vec3(1.0); Z[0] = 0;
    int sp = 0;
    vec3 result = vec3(0.0);
    do {
        vec3 o = O[sp], d = D[sp], w = W[sp];
        int z = Z[sp];
        sp--;
        float t;
        int id = intersectAll(o, d, t);
        if (id < 0) { result += w * mix(vec3(0.2, 0.25, 0.3), vec3(0.8, 0.85, 0.9), 0.5 * (1.0 + d.y)); continue; }
        if (id == NB) { result += w * vec3(0.9, 0.5, 0.3) * abs(d.z); continue; }
        if (z + 1 >= 5) continue;
        vec3 P = o + t * d;
        vec3 Nn = normalize(P - balls[id].c);
        bool outside = dot(d, Nn) < 0.0;
        vec3 bias = BIAS * Nn;
        float kr = fresnel(d, Nn, balls[id].ior);
        w *= balls[id].tint;
        if (kr < 1.0) {
            sp++;
            O[sp] = outside ? P - bias : P + bias;
            D[sp] = normalize(refractRay(d, Nn, balls[id].ior));
            W[sp] = w * (1.0 - kr);
            Z[sp] = z + 1;
        }
        sp++;
        O[sp] = outside ? P + bias : P - bias;
        D[sp] = normalize(reflect(d, Nn));
        W[sp] = w * kr;
        Z[sp] = z + 1;
    } while (sp >= 0);
    fragColor = vec4(result, 1.0);
}
