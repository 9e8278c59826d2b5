struct Ray {
    vec3 at;
    vec3 to;

struct Ball {
    vec3 at;
    float r;
;

const float LIMIT = 1.0;

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fragColor = vec4(Ball(vec3(0.0), 1.0).at, LIMIT);
}
