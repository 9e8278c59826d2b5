#version 300 es
// glsl/01-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


precision highp float;
precision highp int;

struct ToyproofFrame {
    vec3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    vec4 iChannelTime[4];
    vec3 iChannelResolution[4];
    vec4 iMouse;
    vec4 iDate;
    float iSampleRate;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const int SAMPLES = 10;

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

float seed = 0.0;

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

float random() {
    float _e1 = seed;
    seed = (_e1 + 1.0);
    return fract((sin(_e1) * 43758.547));
}

float disk(vec2 p, vec2 center, float radius) {
    vec2 p_1 = vec2(0.0);
    vec2 center_1 = vec2(0.0);
    float radius_1 = 0.0;
    vec2 d = vec2(0.0);
    p_1 = p;
    center_1 = center;
    radius_1 = radius;
    vec2 _e6 = p_1;
    vec2 _e7 = center_1;
    d = (_e6 - _e7);
    vec2 _e10 = d;
    vec2 _e11 = d;
    float _e13 = radius_1;
    float _e14 = radius_1;
    return (dot(_e10, _e11) - (_e13 * _e14));
}

float wave(vec2 p_2, float height, float amplitude, float frequency) {
    vec2 p_3 = vec2(0.0);
    float height_1 = 0.0;
    float amplitude_1 = 0.0;
    float frequency_1 = 0.0;
    p_3 = p_2;
    height_1 = height;
    amplitude_1 = amplitude;
    frequency_1 = frequency;
    vec2 _e8 = p_3;
    float _e10 = height_1;
    float _e12 = amplitude_1;
    float _e13 = frequency_1;
    vec2 _e14 = p_3;
    return ((_e8.y - _e10) - (_e12 * sin((_e13 * _e14.x))));
}

float heart(vec2 p_4, vec2 center_2, float size) {
    vec2 p_5 = vec2(0.0);
    vec2 center_3 = vec2(0.0);
    float size_1 = 0.0;
    vec2 q = vec2(0.0);
    float ring = 0.0;
    p_5 = p_4;
    center_3 = center_2;
    size_1 = size;
    vec2 _e6 = p_5;
    vec2 _e7 = center_3;
    float _e9 = size_1;
    q = ((_e6 - _e7) / vec2(_e9));
    vec2 _e13 = q;
    vec2 _e14 = q;
    ring = (dot(_e13, _e14) - 1.0);
    float _e19 = ring;
    float _e20 = ring;
    float _e22 = ring;
    vec2 _e24 = q;
    vec2 _e26 = q;
    vec2 _e29 = q;
    vec2 _e32 = q;
    vec2 _e35 = q;
    return (((_e19 * _e20) * _e22) - ((((_e24.x * _e26.x) * _e29.y) * _e32.y) * _e35.y));
}

vec3 figures(vec2 p_6) {
    vec2 p_7 = vec2(0.0);
    p_7 = p_6;
    vec2 _e2 = p_7;
    float _e7 = heart(_e2, vec2(0.35, 0.08), 0.25);
    if ((_e7 < 0.0)) {
        {
            return vec3(0.85, 0.1, 0.2);
        }
    }
    vec2 _e14 = p_7;
    float _e19 = disk(_e14, vec2(-0.45, 0.15), 0.28);
    if ((_e19 < 0.0)) {
        {
            return vec3(1.0, 0.8, 0.2);
        }
    }
    vec2 _e26 = p_7;
    float _e30 = wave(_e26, -0.2, 0.1, 9.0);
    if ((_e30 < 0.0)) {
        {
            return vec3(0.1, 0.35, 0.6);
        }
    }
    return vec3(0.75, 0.85, 0.95);
}

void mainImage(inout vec4 fragColor, vec2 fragCoord) {
    vec2 fragCoord_1 = vec2(0.0);
    float aspect = 0.0;
    vec3 color = vec3(0.0);
    int i = 0;
    float fx = 0.0;
    float fy = 0.0;
    float x = 0.0;
    float y = 0.0;
    fragCoord_1 = fragCoord;
    fragColor = vec4(0.0);
    seed = 0.0;
    vec3 _e10 = _group_0_binding_0_fs.iResolution;
    vec3 _e12 = _group_0_binding_0_fs.iResolution;
    aspect = (_e10.x / _e12.y);
    while(true) {
        int _e21 = i;
        if (!((_e21 < SAMPLES))) {
            break;
        }
        {
            vec2 _e24 = fragCoord_1;
            float _e26 = random();
            fx = ((_e24.x + _e26) - 0.5);
            vec2 _e31 = fragCoord_1;
            float _e33 = random();
            fy = ((_e31.y + _e33) - 0.5);
            float _e38 = fx;
            vec3 _e39 = _group_0_binding_0_fs.iResolution;
            x = (((_e38 / _e39.x) * 2.0) - 1.0);
            float _e47 = fy;
            vec3 _e48 = _group_0_binding_0_fs.iResolution;
            float _e55 = aspect;
            y = ((((_e47 / _e48.y) * 2.0) - 1.0) / _e55);
            vec3 _e58 = color;
            float _e59 = x;
            float _e60 = y;
            vec3 _e62 = figures(vec2(_e59, _e60));
            color = (_e58 + _e62);
            int _e64 = i;
            i = (_e64 + 1);
        }
    }
    vec3 _e67 = color;
    vec3 _e70 = (_e67 / vec3(10.0));
    fragColor = vec4(_e70.x, _e70.y, _e70.z, 1.0);
    return;
}

void main_1() {
    vec4 toyproof_image_color = vec4(0.0, 0.0, 0.0, 1.0);
    vec4 _e8 = gen_gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy);
    vec4 _e10 = toyproof_image_color;
    vec3 _e11 = _e10.xyz;
    toyproof_color = vec4(_e11.x, _e11.y, _e11.z, 1.0);
    return;
}

void main() {
    vec4 gen_gl_FragCoord = gl_FragCoord;
    gen_gl_FragCoord_1 = gen_gl_FragCoord;
    main_1();
    vec4 _e3 = toyproof_color;
    FragmentOutput _tmp_return = FragmentOutput(_e3);
    _fs2p_location0 = _tmp_return.toyproof_color;
    return;
}

