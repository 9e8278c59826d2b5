#include <metal_stdlib>
using namespace metal;

$outside //? outside
//? outside
struct Shader {
    float3 iResolution; //? iResolution
    float iTime; //? iTime
    float iTimeDelta; //? iTimeDelta
    int iFrame; //? iFrame
    float iFrameRate; //? iFrameRate
    array<float4, 4> iChannelTime; //? iChannelTime
    array<float3, 4> iChannelResolution; //? iChannelResolution
    float4 iMouse; //? iMouse
    float4 iDate; //? iDate
    float iSampleRate; //? iSampleRate
    $texture0 iChannel0; //? channel0
    sampler iChannel0_sampler; //? channel0
    $texture1 iChannel1; //? channel1
    sampler iChannel1_sampler; //? channel1
    $texture2 iChannel2; //? channel2
    sampler iChannel2_sampler; //? channel2
    $texture3 iChannel3; //? channel3
    sampler iChannel3_sampler; //? channel3
    float4 gl_FragCoord; //? position
    //? inputs channels position
    $shader
};

struct Inputs { //? inputs
    packed_float3 iResolution; //? inputs
    float iTime; //? inputs
    float iTimeDelta; //? inputs
    int iFrame; //? inputs
    float iFrameRate; //? inputs
    float4 iChannelTime[4]; //? inputs
    float3 iChannelResolution[4]; //? inputs
    float4 iMouse; //? inputs
    float4 iDate; //? inputs
    float iSampleRate; //? inputs
}; //? inputs
//? inputs
fragment float4 main_(
    constant Inputs& inputs [[buffer(0)]], //? inputs
    $texture0 iChannel0 [[texture(1)]], //? channel0
    sampler iChannel0_sampler [[sampler(2)]], //? channel0
    $texture1 iChannel1 [[texture(3)]], //? channel1
    sampler iChannel1_sampler [[sampler(4)]], //? channel1
    $texture2 iChannel2 [[texture(5)]], //? channel2
    sampler iChannel2_sampler [[sampler(6)]], //? channel2
    $texture3 iChannel3 [[texture(7)]], //? channel3
    sampler iChannel3_sampler [[sampler(8)]], //? channel3
    float4 position [[position]]
) {
    Shader shader = { //? inputs channels position
        float3(inputs.iResolution), //? iResolution
        inputs.iTime, //? iTime
        inputs.iTimeDelta, //? iTimeDelta
        inputs.iFrame, //? iFrame
        inputs.iFrameRate, //? iFrameRate
        { //? iChannelTime
            inputs.iChannelTime[0], inputs.iChannelTime[1], //? iChannelTime
            inputs.iChannelTime[2], inputs.iChannelTime[3], //? iChannelTime
        }, //? iChannelTime
        { //? iChannelResolution
            inputs.iChannelResolution[0], inputs.iChannelResolution[1], //? iChannelResolution
            inputs.iChannelResolution[2], inputs.iChannelResolution[3], //? iChannelResolution
        }, //? iChannelResolution
        inputs.iMouse, //? iMouse
        inputs.iDate, //? iDate
        inputs.iSampleRate, //? iSampleRate
        iChannel0, iChannel0_sampler, //? channel0
        iChannel1, iChannel1_sampler, //? channel1
        iChannel2, iChannel2_sampler, //? channel2
        iChannel3, iChannel3_sampler, //? channel3
        position, //? position
    }; //? inputs channels position
    Shader shader; //? stateless
    float4 color; //? out
    float4 color = float4(0.0, 0.0, 0.0, 1.0); //? inout
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    shader.$main_image(color, position.xy);
    return float4(color.xyz, 1.0); //? image
    return color; //? buffer
}
