// A sphere, still without light.

const vec3 CENTER = vec3(0.0, 0.0, -6.0);
const float RADIUS = 1.5;
const vec3 COLOR = vec3(0.9, 0.6, 0.2);
const vec3 AMBIENT = vec3(0.1, 0.1, 0.15);
const vec3 BACKGROUND = vec3(0.02, 0.02, 0.05);

// The distance to the sphere along a ray from the origin, or -1.
float intersectSphere(vec3 direction) {
    float b = dot(CENTER, direction);
    float disc = b * b - dot(CENTER, CENTER) + RADIUS * RADIUS;
    return disc > 0.0 ? b - sqrt(disc) : -1.0;
}

vec3 shade(vec3 point) {
    // Your code: the normal, the direction to the light, and the cosine of the angle between them.
    return COLOR * AMBIENT;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    vec2 screen = fragCoord / iResolution.xy * 2.0 - 1.0;
    vec3 direction = normalize(vec3(screen.x, screen.y / aspect, -2.0));
    float t = intersectSphere(direction);
    fragColor = vec4(t > 0.0 ? shade(t * direction) : BACKGROUND, 1.0);
}
