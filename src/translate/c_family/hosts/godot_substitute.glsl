#version 450
$block
#define TIME toyproof_iTime
#define SCREEN_PIXEL_SIZE (1.0 / toyproof_iResolution.xy)
#define FRAGCOORD gl_FragCoord
#define iTimeDelta toyproof_iTimeDelta //? iTimeDelta
#define iFrame toyproof_iFrame //? iFrame
#define iFrameRate toyproof_iFrameRate //? iFrameRate
#define iChannelTime toyproof_iChannelTime //? iChannelTime
#define iMouse toyproof_iMouse //? iMouse
#define iDate toyproof_iDate //? iDate
#define iSampleRate toyproof_iSampleRate //? iSampleRate
layout(location = 0) out vec4 COLOR;
$shader
void main() {
    fragment();
}
