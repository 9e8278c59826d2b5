#version 450
$block
#define TIME toyproof_iTime
#define SCREEN_PIXEL_SIZE (1.0 / toyproof_iResolution.xy)
#define FRAGCOORD gl_FragCoord
#define PI 3.1415926535897932384626433832795
#define TAU 6.2831853071795864769252867665590
#define E 2.7182818284590452353602874713527
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
