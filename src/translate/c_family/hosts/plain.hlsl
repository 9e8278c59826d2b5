cbuffer Inputs : register(b0) { //? inputs
    float3 iResolution : packoffset(c0); //? iResolution
    float iTime : packoffset(c0.w); //? iTime
    float iTimeDelta : packoffset(c1); //? iTimeDelta
    int iFrame : packoffset(c1.y); //? iFrame
    float iFrameRate : packoffset(c1.z); //? iFrameRate
    float4 iChannelTime[4] : packoffset(c2); //? iChannelTime
    float3 iChannelResolution[4] : packoffset(c6); //? iChannelResolution
    float4 iMouse : packoffset(c10); //? iMouse
    float4 iDate : packoffset(c11); //? iDate
    float iSampleRate : packoffset(c12); //? iSampleRate
}; //? inputs
//? inputs
$texture0 iChannel0 : register(t1); //? channel0
SamplerState iChannel0_sampler : register(s2); //? channel0
$texture1 iChannel1 : register(t3); //? channel1
SamplerState iChannel1_sampler : register(s4); //? channel1
$texture2 iChannel2 : register(t5); //? channel2
SamplerState iChannel2_sampler : register(s6); //? channel2
$texture3 iChannel3 : register(t7); //? channel3
SamplerState iChannel3_sampler : register(s8); //? channel3
//? channels
static float4 gl_FragCoord; //? position
//? position
$shader

float4 main(float4 position : SV_Position) : SV_Target0 {
    gl_FragCoord = position; //? position
    float4 color; //? out
    float4 color = float4(0.0, 0.0, 0.0, 1.0); //? inout
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    $main_image(color, position.xy);
    return float4(color.xyz, 1.0); //? image
    return color; //? buffer
}
