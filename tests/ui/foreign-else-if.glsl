void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float x = 0.0;
    if (fragCoord.x > 1.0) {
        x = 1.0;
    } elif (fragCoord.y > 2.0) {
        x = 2.0;
    } else {
        x = 3.0;
    }
    fragColor = vec4(x);
}
