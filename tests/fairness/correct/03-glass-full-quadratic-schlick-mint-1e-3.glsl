// Ray Tracing in One Weekend, the chapter on dielectrics, but both rays are followed instead of one by chance.

const float T_MIN = 0.001;
const float T_MAX = 1.0e7;

struct hit_record { vec3 p; vec3 normal; float t; bool front_face; int mat; vec3 albedo; };
struct ray { vec3 orig; vec3 dir; };

const int LAMBERTIAN = 0, METAL = 1, DIELECTRIC = 2;

bool hit_sphere(vec3 center, float radius, ray r, float t_max, inout hit_record rec, int mat, vec3 albedo)
{
    vec3 oc = r.orig - center;
    float a = dot(r.dir, r.dir);
    float b = 2.0 * dot(oc, r.dir);
    float c = dot(oc, oc) - radius * radius;
    float discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return false;
    float root = (-b - sqrt(discriminant)) / (2.0 * a);
    if (root <= T_MIN || root >= t_max) {
        root = (-b + sqrt(discriminant)) / (2.0 * a);
        if (root <= T_MIN || root >= t_max) return false;
    }
    rec.t = root;
    rec.p = r.orig + root * r.dir;
    vec3 outward = (rec.p - center) / radius;
    rec.front_face = dot(r.dir, outward) < 0.0;
    rec.normal = rec.front_face ? outward : -outward;
    rec.mat = mat;
    rec.albedo = albedo;
    return true;
}

bool hit_world(ray r, float t_max, out hit_record rec)
{
    rec.t = t_max;
    bool any = false;
    if (hit_sphere(vec3(0.0, -100.8, -5.0), 100.0, r, rec.t, rec, LAMBERTIAN, vec3(0.8, 0.8, 0.0))) any = true;
    if (hit_sphere(vec3(0.0, 0.0, -4.2), 0.8, r, rec.t, rec, DIELECTRIC, vec3(1.0))) any = true;
    if (hit_sphere(vec3(-1.7, -0.1, -5.0), 0.7, r, rec.t, rec, LAMBERTIAN, vec3(0.1, 0.2, 0.5))) any = true;
    if (hit_sphere(vec3(1.7, 0.0, -5.0), 0.75, r, rec.t, rec, METAL, vec3(0.8, 0.6, 0.2))) any = true;
    return any;
}

float reflectance(float cosine, float ref_idx)
{
    float r0 = (1.0 - ref_idx) / (1.0 + ref_idx);
    r0 = r0 * r0;
    return r0 + (1.0 - r0) * pow(1.0 - cosine, 5.0);
}

vec3 lambert(hit_record rec)
{
    vec3 to_light = vec3(3.0, 6.0, -1.0) - rec.p;
    hit_record ignored;
    // unnormalised: t = 1 is the light
    float lit = hit_world(ray(rec.p, to_light), 1.0, ignored) ? 0.0 : 1.0;
    return rec.albedo * (0.15 + lit * 0.8 * max(0.0, dot(rec.normal, normalize(to_light))));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord)
{
    float u = fragCoord.x / iResolution.x;
    float v = fragCoord.y / iResolution.y;
    float height = 2.0 * iResolution.y / iResolution.x;
    vec3 lower_left = vec3(-1.0, -0.5 * height, -2.0);

    ray rays[10];
    vec3 att[10];
    int bounce[10];
    rays[0] = ray(vec3(0.0), normalize(lower_left + vec3(2.0 * u, height * v, 0.0)));
    att[0] = vec3(1.0);
    bounce[0] = 8;
    int count = 1;
    vec3 color = vec3(0.0);
    while (count > 0) {
        count--;
        ray r = rays[count];
        vec3 k = att[count];
        int depth = bounce[count];
        if (depth <= 0) continue;
        hit_record rec;
        if (!hit_world(r, T_MAX, rec)) {
            float t = 0.5 * (r.dir.y + 1.0);
            color += k * ((1.0 - t) * vec3(1.0) + t * vec3(0.5, 0.7, 1.0));
        } else if (rec.mat == LAMBERTIAN) {
            color += k * lambert(rec);
        } else if (rec.mat == METAL) {
            rays[count] = ray(rec.p, normalize(reflect(r.dir, rec.normal)));
            att[count] = k * rec.albedo;
            bounce[count] = depth - 1;
            count++;
        } else {
            float ratio = rec.front_face ? (1.0 / 1.5) : 1.5;
            float cos_theta = min(dot(-r.dir, rec.normal), 1.0);
            float sin_theta = sqrt(1.0 - cos_theta * cos_theta);
            bool cannot_refract = ratio * sin_theta > 1.0;
            float f = cannot_refract ? 1.0 : reflectance(rec.front_face ? cos_theta : sqrt(1.0 - 1.5 * 1.5 * sin_theta * sin_theta), 1.5);
            rays[count] = ray(rec.p, normalize(reflect(r.dir, rec.normal)));
            att[count] = k * f;
            bounce[count] = depth - 1;
            count++;
            if (!cannot_refract) {
                vec3 perp = ratio * (r.dir + cos_theta * rec.normal);
                vec3 para = -sqrt(abs(1.0 - dot(perp, perp))) * rec.normal;
                rays[count] = ray(rec.p, normalize(perp + para));
                att[count] = k * (1.0 - f);
                bounce[count] = depth - 1;
                count++;
            }
        }
    }
    fragColor = vec4(color, 1.0);
}
