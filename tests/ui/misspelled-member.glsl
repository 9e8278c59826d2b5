struct Ray { vec3 origin, direction; };
void mainImage(out vec4 c, in vec2 p) {
    Ray ray = Ray(vec3(0.0), vec3(p, 1.0));
    c = vec4(ray.direcion, 1.0);
}
