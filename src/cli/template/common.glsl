// Common precedes every other tab. It has no inputs of its own but iDate and iSampleRate.

// A ray of the camera at the origin: the screen plane is at z = -2, and x is from -1 to 1.
vec3 rayDirection(vec2 position, vec2 size) {
    vec2 screen = (2.0 * position - size) / size.x;
    return normalize(vec3(screen, -2.0));
}

// The distance to a sphere along a ray from the origin, or -1.0.
float intersect(vec3 direction, vec3 center, float radius) {
    float b = dot(direction, center);
    float discriminant = b * b - dot(center, center) + radius * radius;
    return discriminant < 0.0 ? -1.0 : b - sqrt(discriminant);
}

// The offset of a sample within its pixel: a low-discrepancy sequence, from 0 to 1.
vec2 sampleOffset(int frame) {
    return fract(vec2(0.5) + float(frame) * vec2(0.7548776662, 0.5698402910));
}
