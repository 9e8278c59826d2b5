// The ellipsoid is the unit sphere in a space that is squeezed: divide origin and direction by the radii.

const float MIN_T = 1e-4;
const vec3 LENS = vec3(0.0, 0.1, -4.0);
const vec3 RADII = vec3(1.3, 0.8, 0.4);

float ellipsoid(vec3 o, vec3 d, vec3 center, vec3 radii)
{
    vec3 p = (o - center) / radii;
    vec3 q = d / radii;
    float a = dot(q, q);
    float b = 2.0 * dot(p, q);
    float c = dot(p, p) - 1.0;
    float disc = b * b - 4.0 * a * c;
    if (disc < 0.0)
        return 0.0;
    float s = sqrt(disc);
    float t1 = (-b - s) / (2.0 * a);
    float t2 = (-b + s) / (2.0 * a);
    if (t1 > MIN_T) return t1;
    if (t2 > MIN_T) return t2;
    return 0.0;
}

struct Item { vec3 o; vec3 d; vec3 mul; int seg; };

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    float px = (fragCoord.x / iResolution.x) * 2.0 - 1.0;
    float py = ((fragCoord.y / iResolution.y) * 2.0 - 1.0) * iResolution.y / iResolution.x;
    Item items[7];
    items[0] = Item(vec3(0.0), normalize(vec3(px, py, -2.0)), vec3(1.0), 1);
    int live = 1;
    vec3 total = vec3(0.0);
    while (live > 0)
    {
        live -= 1;
        Item it = items[live];
        float tLens = ellipsoid(it.o, it.d, LENS, RADII);
        float tBall = ellipsoid(it.o, it.d, vec3(1.6, -0.6, -4.5), vec3(0.4));
        float tWall = (-8.5 - it.o.z) / it.d.z;
        float t = 1e9;
        int kind = 0;
        if (tLens > 0.0) { t = tLens; kind = 1; }
        if (tBall > 0.0 && tBall < t) { t = tBall; kind = 2; }
        if (tWall > MIN_T && tWall < t) { t = tWall; kind = 3; }
        if (kind == 0)
        {
            float m = 0.5 * (1.0 + it.d.y);
            total += it.mul * ((1.0 - m) * vec3(0.9, 0.85, 0.8) + m * vec3(0.3, 0.4, 0.7));
            continue;
        }
        vec3 p = it.o + t * it.d;
        if (kind == 3)
        {
            // the wall stands at z = -8.5, in the row of squares number -9
            float sq = mod(floor(p.x) - 9.0, 2.0);
            total += it.mul * 0.4 * (sq == 0.0 ? vec3(0.9, 0.2, 0.2) : vec3(0.9));
            continue;
        }
        if (it.seg >= 6) continue;
        vec3 n = kind == 1 ? normalize((p - LENS) / (RADII * RADII)) : normalize(p - vec3(1.6, -0.6, -4.5));
        vec3 k = it.mul * (kind == 1 ? vec3(1.0) : vec3(0.8, 1.0, 1.0));
        float from = 1.0, to = 1.5;
        if (dot(it.d, n) > 0.0) { n = -n; from = 1.5; to = 1.0; }
        vec3 thru = refract(it.d, n, from / to);
        vec3 back = reflect(it.d, n);
        if (thru == vec3(0.0))
        {
            items[live++] = Item(p, back, k, it.seg + 1);
            continue;
        }
        float c1 = -dot(it.d, n), c2 = -dot(thru, n);
        float rs = pow(abs((from * c1 - to * c2) / (from * c1 + to * c2)), 2.0);
        float rp = pow(abs((from * c2 - to * c1) / (from * c2 + to * c1)), 2.0);
        float share = (rs + rp) / 2.0;
        items[live++] = Item(p, thru, k * (1.0 - share), it.seg + 1);
        items[live++] = Item(p, back, k * share, it.seg + 1);
    }
    fragColor = vec4(total, 1.0);
}
