// glsl/01-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// language: metal2.0
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct type_4 {
    metal::float4 inner[4];
};
struct type_5 {
    metal::float3 inner[4];
};
struct ToyproofFrame {
    metal::packed_float3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    char _pad5[4];
    type_4 iChannelTime;
    type_5 iChannelResolution;
    metal::float4 iMouse;
    metal::float4 iDate;
    float iSampleRate;
    char _pad10[12];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant int SAMPLES = 10;

float random(
    thread float& seed
) {
    float _e1 = seed;
    seed = _e1 + 1.0;
    return metal::fract(metal::sin(_e1) * 43758.547);
}

float disk(
    metal::float2 p,
    metal::float2 center,
    float radius
) {
    metal::float2 p_1 = {};
    metal::float2 center_1 = {};
    float radius_1 = {};
    metal::float2 d = {};
    p_1 = p;
    center_1 = center;
    radius_1 = radius;
    metal::float2 _e6 = p_1;
    metal::float2 _e7 = center_1;
    d = _e6 - _e7;
    metal::float2 _e10 = d;
    metal::float2 _e11 = d;
    float _e13 = radius_1;
    float _e14 = radius_1;
    return metal::dot(_e10, _e11) - (_e13 * _e14);
}

float wave(
    metal::float2 p_2,
    float height,
    float amplitude,
    float frequency
) {
    metal::float2 p_3 = {};
    float height_1 = {};
    float amplitude_1 = {};
    float frequency_1 = {};
    p_3 = p_2;
    height_1 = height;
    amplitude_1 = amplitude;
    frequency_1 = frequency;
    metal::float2 _e8 = p_3;
    float _e10 = height_1;
    float _e12 = amplitude_1;
    float _e13 = frequency_1;
    metal::float2 _e14 = p_3;
    return (_e8.y - _e10) - (_e12 * metal::sin(_e13 * _e14.x));
}

float heart(
    metal::float2 p_4,
    metal::float2 center_2,
    float size
) {
    metal::float2 p_5 = {};
    metal::float2 center_3 = {};
    float size_1 = {};
    metal::float2 q = {};
    float ring = {};
    p_5 = p_4;
    center_3 = center_2;
    size_1 = size;
    metal::float2 _e6 = p_5;
    metal::float2 _e7 = center_3;
    float _e9 = size_1;
    q = (_e6 - _e7) / metal::float2(_e9);
    metal::float2 _e13 = q;
    metal::float2 _e14 = q;
    ring = metal::dot(_e13, _e14) - 1.0;
    float _e19 = ring;
    float _e20 = ring;
    float _e22 = ring;
    metal::float2 _e24 = q;
    metal::float2 _e26 = q;
    metal::float2 _e29 = q;
    metal::float2 _e32 = q;
    metal::float2 _e35 = q;
    return ((_e19 * _e20) * _e22) - ((((_e24.x * _e26.x) * _e29.y) * _e32.y) * _e35.y);
}

metal::float3 figures(
    metal::float2 p_6
) {
    metal::float2 p_7 = {};
    p_7 = p_6;
    metal::float2 _e2 = p_7;
    float _e7 = heart(_e2, metal::float2(0.35, 0.08), 0.25);
    if (_e7 < 0.0) {
        {
            return metal::float3(0.85, 0.1, 0.2);
        }
    }
    metal::float2 _e14 = p_7;
    float _e19 = disk(_e14, metal::float2(-0.45, 0.15), 0.28);
    if (_e19 < 0.0) {
        {
            return metal::float3(1.0, 0.8, 0.2);
        }
    }
    metal::float2 _e26 = p_7;
    float _e30 = wave(_e26, -0.2, 0.1, 9.0);
    if (_e30 < 0.0) {
        {
            return metal::float3(0.1, 0.35, 0.6);
        }
    }
    return metal::float3(0.75, 0.85, 0.95);
}

void mainImage(
    thread metal::float4& fragColor,
    metal::float2 fragCoord,
    constant ToyproofFrame& global,
    thread float& seed
) {
    metal::float2 fragCoord_1 = {};
    float aspect = {};
    metal::float3 color = metal::float3(0.0);
    int i = 0;
    float fx = {};
    float fy = {};
    float x = {};
    float y = {};
    fragCoord_1 = fragCoord;
    fragColor = metal::float4(0.0);
    seed = 0.0;
    metal::float3 _e10 = global.iResolution;
    metal::float3 _e12 = global.iResolution;
    aspect = _e10.x / _e12.y;
    while(true) {
        int _e21 = i;
        if (!((_e21 < SAMPLES))) {
            break;
        }
        {
            metal::float2 _e24 = fragCoord_1;
            float _e26 = random(seed);
            fx = (_e24.x + _e26) - 0.5;
            metal::float2 _e31 = fragCoord_1;
            float _e33 = random(seed);
            fy = (_e31.y + _e33) - 0.5;
            float _e38 = fx;
            metal::float3 _e39 = global.iResolution;
            x = ((_e38 / _e39.x) * 2.0) - 1.0;
            float _e47 = fy;
            metal::float3 _e48 = global.iResolution;
            float _e55 = aspect;
            y = (((_e47 / _e48.y) * 2.0) - 1.0) / _e55;
            metal::float3 _e58 = color;
            float _e59 = x;
            float _e60 = y;
            metal::float3 _e62 = figures(metal::float2(_e59, _e60));
            color = _e58 + _e62;
            int _e64 = i;
            i = as_type<int>(as_type<uint>(_e64) + as_type<uint>(1));
        }
    }
    metal::float3 _e67 = color;
    metal::float3 _e70 = _e67 / metal::float3(10.0);
    fragColor = metal::float4(_e70.x, _e70.y, _e70.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread float& seed,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, seed);
    metal::float4 _e10 = toyproof_image_color;
    metal::float3 _e11 = _e10.xyz;
    toyproof_color = metal::float4(_e11.x, _e11.y, _e11.z, 1.0);
    return;
}

struct main_Input {
};
struct main_Output {
    metal::float4 toyproof_color [[color(0)]];
};
fragment main_Output main_(
  metal::float4 gl_FragCoord [[position]]
, constant ToyproofFrame& global [[buffer(0)]]
) {
    metal::float4 toyproof_color = {};
    float seed = {};
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, seed, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
