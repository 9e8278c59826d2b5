#version 300 es
precision highp float;
precision highp int;

layout(std140) uniform Inputs { //? inputs
    vec3 iResolution; //? inputs iResolution
    float iTime; //? inputs iTime
    float iTimeDelta; //? inputs iTimeDelta
    int iFrame; //? inputs iFrame
    float iFrameRate; //? inputs iFrameRate
    vec4 iChannelTime[4]; //? inputs iChannelTime
    vec3 iChannelResolution[4]; //? inputs iChannelResolution
    vec4 iMouse; //? inputs iMouse
    vec4 iDate; //? inputs iDate
    float iSampleRate; //? inputs iSampleRate
}; //? inputs
uniform highp $texture0 iChannel0; //? channel0
uniform highp $texture1 iChannel1; //? channel1
uniform highp $texture2 iChannel2; //? channel2
uniform highp $texture3 iChannel3; //? channel3
layout(location = 0) out vec4 $output;

$shader

void main() {
    vec4 $color; //? out
    vec4 $color = vec4(0.0, 0.0, 0.0, 1.0); //? inout
    $main_image($color, gl_FragCoord.xy);
    $output = vec4($color.rgb, 1.0); //? image
    $output = $color; //? buffer
}
