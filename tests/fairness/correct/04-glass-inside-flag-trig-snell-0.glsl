// No epsilon anywhere: a ray remembers which ball it starts on and whether it travels inside it.
// From the ball it stands on, outside, a ray never meets the same (convex) ball again;
// inside, the way out is the far end of the chord, 2 (-d.n).

const vec3  C[3] = vec3[3](vec3(-0.7, 0.1, -3.6), vec3(0.7, -0.1, -3.9), vec3(0.3, 0.9, -7.0));
const float R[3] = float[3](0.6, 0.7, 0.9);
const float N[3] = float[3](1.7, 1.45, 0.0);
const vec3  K[3] = vec3[3](vec3(1.0, 0.9, 0.9), vec3(0.9, 1.0, 0.9), vec3(0.9, 0.9, 0.3));

struct State { vec3 o; vec3 d; vec3 w; int on; bool inside; int depth; };

float outerRoot(vec3 o, vec3 d, int i)
{
    vec3 m = o - C[i];
    float b = dot(m, d);
    float c = dot(m, m) - R[i]*R[i];
    if (b > 0.0) return -1.0;
    float q = b*b - c;
    return q < 0.0 ? -1.0 : -b - sqrt(q);
}

int find(State s, out float t)
{
    if (s.inside) { t = -2.0*dot(s.o - C[s.on], s.d); return s.on; }
    int who = -1;
    t = 1e8;
    for (int i = 0; i < 3; ++i) {
        if (i == s.on) continue;
        float x = outerRoot(s.o, s.d, i);
        if (x > 0.0 && x < t) { t = x; who = i; }
    }
    return who;
}

vec3 shadeMatte(vec3 p)
{
    vec3 n = normalize(p - C[2]);
    vec3 l = vec3(0.0, 3.0, 0.0) - p;
    float d = length(l);
    l /= d;
    float light = max(dot(n, l), 0.0);
    for (int i = 0; i < 2; ++i) {
        float x = outerRoot(p, l, i);
        if (x > 0.0 && x < d) light = 0.0;
    }
    return K[2]*(0.3 + 0.6*light);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    vec2 q = (fragCoord - 0.5*iResolution.xy)/(0.5*iResolution.x);
    State todo[8];
    todo[0] = State(vec3(0.0), normalize(vec3(q, -2.0)), vec3(1.0), -1, false, 1);
    int n = 1;
    vec3 acc = vec3(0.0);
    while (n > 0) {
        State s = todo[--n];
        float t;
        int i = find(s, t);
        if (i < 0) { acc += s.w*mix(vec3(0.95, 0.6, 0.35), vec3(0.15, 0.2, 0.5), 0.5*(1.0 + s.d.y)); continue; }
        vec3 p = s.o + t*s.d;
        if (i == 2) { acc += s.w*shadeMatte(p); continue; }
        if (s.depth == 6) continue;
        vec3 nrm = normalize(p - C[i]);
        p = C[i] + R[i]*nrm;
        if (s.inside) nrm = -nrm;
        vec3 w = s.w*K[i];
        // Snell with angles, as in the physics book
        float ratio = s.inside ? N[i] : 1.0/N[i];
        float cosI = clamp(-dot(nrm, s.d), 0.0, 1.0);
        float thetaI = acos(cosI);
        float sinT = ratio*sin(thetaI);
        State mir = State(p, reflect(s.d, nrm), w, i, s.inside, s.depth + 1);
        if (sinT < 1.0) {
            float thetaT = asin(sinT);
            vec3 tangent = s.d + cosI*nrm;
            float len = length(tangent);
            if (len > 0.0) tangent /= len;
            float F;
            if (thetaI < 1e-3) { float z = (ratio - 1.0)/(ratio + 1.0); F = z*z; }
            else {
                float a = sin(thetaI - thetaT)/sin(thetaI + thetaT);
                float b = tan(thetaI - thetaT)/tan(thetaI + thetaT);
                F = 0.5*(a*a + b*b);
            }
            mir.w = w*F;
            todo[n++] = State(p, sin(thetaT)*tangent - cos(thetaT)*nrm, w*(1.0 - F), i, !s.inside, s.depth + 1);
        }
        todo[n++] = mir;
    }
    fragColor = vec4(acc, 1.0);
}
