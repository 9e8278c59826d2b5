// Biased: total internal reflection (at the air inside the shell) gives black; deterministic; measured: 9.5 % of the pixels off by > 1/255, up to 162/255 (f64 run against render)
// shell = two concentric spheres; index stack is not needed, each wall knows what lies on its two sides

#define NEAR_ZERO 1e-5

vec2 shell(vec3 ro, vec3 rd, float r)   // both roots
{
    vec3 oc = ro - vec3(0, 0, -4);
    float b = dot(oc, rd);
    vec3 perp = oc - b*rd;
    float disc = r*r - dot(perp, perp);
    if (disc < 0.0) return vec2(-1.0);
    disc = sqrt(disc);
    return vec2(-b - disc, -b + disc);
}

bool first(vec3 ro, vec3 rd, out float t, out int what)
{
    t = 1e9; what = 0;
    vec2 o = shell(ro, rd, 0.9), i = shell(ro, rd, 0.75);
    if (o.x > NEAR_ZERO && o.x < t) { t = o.x; what = 1; }
    if (o.y > NEAR_ZERO && o.y < t) { t = o.y; what = 1; }
    if (i.x > NEAR_ZERO && i.x < t) { t = i.x; what = 2; }
    if (i.y > NEAR_ZERO && i.y < t) { t = i.y; what = 2; }
    float f = (-1.0 - ro.y)/rd.y;
    if (f > NEAR_ZERO && f < t) { t = f; what = 3; }
    return what > 0;
}

void mainImage( out vec4 fragColor, in vec2 fragCoord )
{
    vec2 p = (-iResolution.xy + 2.0*fragCoord)/iResolution.x;
    vec3 O[9], D[9]; float A[9]; int L[9];
    int top = 1;
    O[0] = vec3(0); D[0] = normalize(vec3(p, -2.0)); A[0] = 1.0; L[0] = 8;
    vec3 tot = vec3(0);
    while( top>0 )
    {
        top--;
        vec3 ro = O[top], rd = D[top]; float a = A[top]; int left = L[top];
        float t; int what;
        if( !first(ro, rd, t, what) ) { tot += a*mix(vec3(0.7,0.8,0.9), vec3(0.1,0.2,0.4), 0.5+0.5*rd.y); continue; }
        vec3 pos = ro + t*rd;
        if( what==3 )
        {
            float c = mod(floor(pos.x/0.7713) + floor(pos.z/0.7713), 2.0);
            vec3 l = vec3(2,5,0) - pos;
            float len = length(l), dif = 0.2; l /= len;
            float ts; int ws;
            if( !first(pos, l, ts, ws) || ts>len ) dif += 0.7*l.y;
            tot += a*dif*mix(vec3(0.9), vec3(0.1), c);
            continue;
        }
        if( left==1 ) continue;
        vec3 nor = normalize(pos - vec3(0,0,-4));
        float n = what==1 ? 1.5 : 1.0/1.5;
        float eta = 1.0/n;
        if( dot(nor,rd)>0.0 ) { nor = -nor; eta = n; }
        float ci = -dot(nor,rd), s2 = eta*eta*(1.0-ci*ci), F = 1.0;
        if( s2<1.0 )
        {
            float ct = sqrt(1.0-s2);
            float a1 = (eta*ci-ct)/(eta*ci+ct), a2 = (ci-eta*ct)/(ci+eta*ct);
            F = 0.5*(a1*a1+a2*a2);
            O[top] = pos; D[top] = normalize(eta*rd + (eta*ci-ct)*nor); A[top] = a*(1.0-F); L[top] = left-1; top++;
        }
        if( s2>=1.0 ) continue;
        O[top] = pos; D[top] = reflect(rd,nor); A[top] = a*F; L[top] = left-1; top++;
    }
    fragColor = vec4( tot, 1.0 );
}
