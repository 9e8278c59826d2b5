void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float3 a = lerp(float3(0.0), saturate(float3(1.0)), frac(iTime));
    fragColor = float4(a, 1.0);
}
