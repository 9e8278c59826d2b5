Texture2D shaderTexture : register(t0);
SamplerState samplerState : register(s0);
cbuffer PixelShaderSettings : register(b0) {
    float Time;
    float Scale;
    float2 Resolution;
    float4 Background;
};

// The inputs of ShaderToy. Windows Terminal has no mouse, and draws up to 60 frames per second.
#define iResolution float3(Resolution, 1.0)
#define iTime Time //? iTime
#define iTimeDelta (1.0 / 60.0) //? iTimeDelta
#define iFrame int(Time * 60.0) //? iFrame
#define iFrameRate 60.0 //? iFrameRate
#define iMouse float4(0.0, 0.0, 0.0, 0.0) //? iMouse
#define iSampleRate 44100.0 //? iSampleRate
static float4 gl_FragCoord; //? position
static const float upward = -1.0; //? derivatives

$shader

float4 main(float4 position : SV_Position, float2 uv : TEXCOORD0) : SV_Target {
    // y points down here, and up in GLSL.
    float2 fragCoord = float2(position.x, Resolution.y - position.y);
    gl_FragCoord = float4(fragCoord, position.zw); //? position
    float4 color; //? out
    float4 color = float4(0.0, 0.0, 0.0, 1.0); //? inout
    $main_image(color, fragCoord);
    float4 text = shaderTexture.Sample(samplerState, uv);
    return float4(lerp(color.xyz, text.xyz, text.w), 1.0);
}
