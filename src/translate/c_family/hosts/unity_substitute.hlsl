$block
#define outputSize toyproof_iResolution
#define _ScreenParams float4(toyproof_iResolution.xy, 0.0, 0.0)
#define _Time float4(0.0, toyproof_iTime, 0.0, 0.0)
#define unity_DeltaTime float4(toyproof_iTimeDelta, 0.0, 0.0, toyproof_iFrameRate)
#define UNITY_COLORSPACE_GAMMA
#define iFrame toyproof_iFrame //? iFrame
#define iMouse toyproof_iMouse //? iMouse
#define iDate toyproof_iDate //? iDate
#define iChannel0_TexelSize float4(0.0, 0.0, toyproof_iChannelResolution[0].xy) //? channel0
#define iChannel1_TexelSize float4(0.0, 0.0, toyproof_iChannelResolution[1].xy) //? channel1
#define iChannel2_TexelSize float4(0.0, 0.0, toyproof_iChannelResolution[2].xy) //? channel2
#define iChannel3_TexelSize float4(0.0, 0.0, toyproof_iChannelResolution[3].xy) //? channel3
struct appdata_img {
    float4 vertex : POSITION;
    float2 texcoord : TEXCOORD0;
};
float4 UnityObjectToClipPos(float4 vertex) {
    return vertex;
}
$shader
float4 main(float4 position : SV_Position) : SV_Target0 {
    Varyings input;
    input.position = position;
    input.uv = float2(position.x, toyproof_iResolution.y - position.y); //? image
    input.uv = position.xy; //? buffer
    return fragment(input);
}
