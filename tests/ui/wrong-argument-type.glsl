struct Ray { vec3 origin, direction; };
struct Sphere { vec3 center; float radius; };
float hit(Ray ray, Sphere sphere) { return distance(ray.origin, sphere.center) - sphere.radius; }
void mainImage(out vec4 c, in vec2 p) {
    Ray ray = Ray(vec3(0.0), vec3(p, 1.0));
    c = vec4(hit(ray, 1));
}
