// The sum of all samples so far in rgb, and their number in alpha. iChannel0 is this buffer in the previous frame.

vec3 render(vec2 position) {
    vec3 direction = rayDirection(position, iResolution.xy);
    vec3 center = vec3(0.0, 0.0, -6.0);
    float t = intersect(direction, center, 1.5);
    if (t < 0.0) return mix(vec3(0.9), vec3(0.4, 0.6, 0.9), 0.5 + 0.5 * direction.y);
    vec3 normal = (t * direction - center) / 1.5;
    vec3 light = normalize(vec3(1.0, 1.0, 1.0));
    return vec3(0.9, 0.5, 0.2) * (0.1 + 0.9 * max(dot(normal, light), 0.0));
}

void mainImage(out vec4 sum, in vec2 position) {
    vec4 previous = iFrame == 0 ? vec4(0.0) : texelFetch(iChannel0, ivec2(position), 0);
    vec2 corner = floor(position);
    sum = previous + vec4(render(corner + sampleOffset(iFrame)), 1.0);
}
