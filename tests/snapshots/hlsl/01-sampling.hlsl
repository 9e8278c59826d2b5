// glsl/01-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

struct ToyproofFrame {
    float3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    int _pad5_0;
    float4 iChannelTime[4];
    float3 iChannelResolution[4];
    int _pad7_0;
    float4 iMouse;
    float4 iDate;
    float iSampleRate;
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const int SAMPLES = int(10);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static float seed = (float)0;
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

float random()
{
    float _e1 = seed;
    seed = (_e1 + 1.0);
    return frac((sin(_e1) * 43758.547));
}

float disk(float2 p, float2 center_, float radius)
{
    float2 p_1 = (float2)0;
    float2 center_1 = (float2)0;
    float radius_1 = (float)0;
    float2 d = (float2)0;

    p_1 = p;
    center_1 = center_;
    radius_1 = radius;
    float2 _e6 = p_1;
    float2 _e7 = center_1;
    d = (_e6 - _e7);
    float2 _e10 = d;
    float2 _e11 = d;
    float _e13 = radius_1;
    float _e14 = radius_1;
    return (dot(_e10, _e11) - (_e13 * _e14));
}

float wave(float2 p_2, float height, float amplitude, float frequency)
{
    float2 p_3 = (float2)0;
    float height_1 = (float)0;
    float amplitude_1 = (float)0;
    float frequency_1 = (float)0;

    p_3 = p_2;
    height_1 = height;
    amplitude_1 = amplitude;
    frequency_1 = frequency;
    float2 _e8 = p_3;
    float _e10 = height_1;
    float _e12 = amplitude_1;
    float _e13 = frequency_1;
    float2 _e14 = p_3;
    return ((_e8.y - _e10) - (_e12 * sin((_e13 * _e14.x))));
}

float heart(float2 p_4, float2 center_2, float size)
{
    float2 p_5 = (float2)0;
    float2 center_3 = (float2)0;
    float size_1 = (float)0;
    float2 q = (float2)0;
    float ring = (float)0;

    p_5 = p_4;
    center_3 = center_2;
    size_1 = size;
    float2 _e6 = p_5;
    float2 _e7 = center_3;
    float _e9 = size_1;
    q = ((_e6 - _e7) / (_e9).xx);
    float2 _e13 = q;
    float2 _e14 = q;
    ring = (dot(_e13, _e14) - 1.0);
    float _e19 = ring;
    float _e20 = ring;
    float _e22 = ring;
    float2 _e24 = q;
    float2 _e26 = q;
    float2 _e29 = q;
    float2 _e32 = q;
    float2 _e35 = q;
    return (((_e19 * _e20) * _e22) - ((((_e24.x * _e26.x) * _e29.y) * _e32.y) * _e35.y));
}

float3 figures(float2 p_6)
{
    float2 p_7 = (float2)0;

    p_7 = p_6;
    float2 _e2 = p_7;
    const float _e7 = heart(_e2, float2(0.35, 0.08), 0.25);
    if ((_e7 < 0.0)) {
        {
            return float3(0.85, 0.1, 0.2);
        }
    }
    float2 _e14 = p_7;
    const float _e19 = disk(_e14, float2(-0.45, 0.15), 0.28);
    if ((_e19 < 0.0)) {
        {
            return float3(1.0, 0.8, 0.2);
        }
    }
    float2 _e26 = p_7;
    const float _e30 = wave(_e26, -0.2, 0.1, 9.0);
    if ((_e30 < 0.0)) {
        {
            return float3(0.1, 0.35, 0.6);
        }
    }
    return float3(0.75, 0.85, 0.95);
}

void mainImage(inout float4 fragColor, float2 fragCoord)
{
    float2 fragCoord_1 = (float2)0;
    float aspect = (float)0;
    float3 color = (0.0).xxx;
    int i = int(0);
    float fx = (float)0;
    float fy = (float)0;
    float x = (float)0;
    float y = (float)0;

    fragCoord_1 = fragCoord;
    fragColor = (0.0).xxxx;
    seed = 0.0;
    float3 _e10 = global.iResolution;
    float3 _e12 = global.iResolution;
    aspect = (_e10.x / _e12.y);
    while(true) {
        int _e21 = i;
        if (!((_e21 < SAMPLES))) {
            break;
        }
        {
            float2 _e24 = fragCoord_1;
            const float _e26 = random();
            fx = ((_e24.x + _e26) - 0.5);
            float2 _e31 = fragCoord_1;
            const float _e33 = random();
            fy = ((_e31.y + _e33) - 0.5);
            float _e38 = fx;
            float3 _e39 = global.iResolution;
            x = (((_e38 / _e39.x) * 2.0) - 1.0);
            float _e47 = fy;
            float3 _e48 = global.iResolution;
            float _e55 = aspect;
            y = ((((_e47 / _e48.y) * 2.0) - 1.0) / _e55);
            float3 _e58 = color;
            float _e59 = x;
            float _e60 = y;
            const float3 _e62 = figures(float2(_e59, _e60));
            color = (_e58 + _e62);
            int _e64 = i;
            i = asint(asuint(_e64) + asuint(int(1)));
        }
    }
    float3 _e67 = color;
    float3 _e70 = (_e67 / (10.0).xxx);
    fragColor = float4(_e70.x, _e70.y, _e70.z, 1.0);
    return;
}

void main_1()
{
    float4 toyproof_image_color = float4(0.0, 0.0, 0.0, 1.0);

    float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy);
    float4 _e10 = toyproof_image_color;
    float3 _e11 = _e10.xyz;
    toyproof_color = float4(_e11.x, _e11.y, _e11.z, 1.0);
    return;
}

FragmentOutput ConstructFragmentOutput(float4 arg0) {
    FragmentOutput ret = (FragmentOutput)0;
    ret.toyproof_color = arg0;
    return ret;
}

FragmentOutput main(FragmentInput_main fragmentinput_main)
{
    float4 gl_FragCoord = fragmentinput_main.gl_FragCoord_2;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    float4 _e3 = toyproof_color;
    const FragmentOutput fragmentoutput = ConstructFragmentOutput(_e3);
    return fragmentoutput;
}
