#includ "noise.glsl"
#defne STEPS 4
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fragColor = vec4(0.0);
}
