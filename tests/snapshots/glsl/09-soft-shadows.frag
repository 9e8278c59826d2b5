#version 300 es
// glsl/09-soft-shadows.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
struct Ray {
    vec3 origin;
    vec3 direction;
};
struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};
struct Light {
    vec3 position;
    float radius;
    vec3 color;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const int SAMPLES = 16;
const int SPHERES = 4;
const vec3 AMBIENT = vec3(0.25);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));

Light light = Light(vec3(0.0), 0.0, vec3(0.0));

uint state = 0u;

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

uint pcg(uint v) {
    uint v_1 = 0u;
    uint s = 0u;
    uint word = 0u;
    v_1 = v;
    uint _e2 = v_1;
    s = ((_e2 * 747796405u) + 2891336453u);
    uint _e8 = s;
    uint _e9 = s;
    uint _e15 = s;
    word = (((_e8 >> ((_e9 >> 28u) + 4u)) ^ _e15) * 277803737u);
    uint _e20 = word;
    uint _e23 = word;
    return ((_e20 >> 22u) ^ _e23);
}

float random() {
    uint _e1 = state;
    uint _e2 = pcg(_e1);
    state = _e2;
    uint _e3 = state;
    return (float((_e3 >> 8u)) / 16777216.0);
}

void startSample(vec2 fragCoord, int i) {
    vec2 fragCoord_1 = vec2(0.0);
    int i_1 = 0;
    fragCoord_1 = fragCoord;
    i_1 = i;
    vec2 _e5 = fragCoord_1;
    vec2 _e8 = fragCoord_1;
    int _e11 = i_1;
    uint _e13 = pcg(uint(_e11));
    uint _e15 = pcg((uint(_e8.y) + _e13));
    uint _e17 = pcg((uint(_e5.x) + _e15));
    state = _e17;
    return;
}

void makeScene() {
    spheres[0] = Sphere(vec3(0.0, -41.0, -8.0), 40.0, vec3(0.7, 0.7, 0.65));
    spheres[1] = Sphere(vec3(-1.3, -0.2, -6.5), 0.8, vec3(0.9, 0.4, 0.2));
    spheres[2] = Sphere(vec3(0.5, 0.6, -7.0), 0.6, vec3(0.3, 0.7, 0.4));
    spheres[3] = Sphere(vec3(1.5, -0.6, -5.5), 0.4, vec3(0.3, 0.4, 0.9));
    light = Light(vec3(3.0, 5.0, -5.0), 0.6, vec3(0.7));
    return;
}

float intersectSphere(Ray ray, Sphere sphere) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_1 = Sphere(vec3(0.0), 0.0, vec3(0.0));
    vec3 f = vec3(0.0);
    float b = 0.0;
    float c = 0.0;
    float disc = 0.0;
    float root = 0.0;
    float t = 0.0;
    ray_1 = ray;
    sphere_1 = sphere;
    Ray _e5 = ray_1;
    Sphere _e7 = sphere_1;
    f = (_e5.origin - _e7.center);
    vec3 _e11 = f;
    Ray _e12 = ray_1;
    b = dot(_e11, _e12.direction);
    vec3 _e16 = f;
    vec3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c = (dot(_e16, _e17) - (_e19.radius * _e21.radius));
    float _e26 = b;
    float _e27 = b;
    float _e29 = c;
    disc = ((_e26 * _e27) - _e29);
    float _e32 = disc;
    if ((_e32 > 0.0)) {
        {
            float _e35 = disc;
            root = sqrt(_e35);
            float _e38 = b;
            float _e40 = root;
            t = (-(_e38) - _e40);
            float _e43 = t;
            if ((_e43 > 1e-5)) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b;
            float _e49 = root;
            t = (-(_e47) + _e49);
            float _e51 = t;
            if ((_e51 > 1e-5)) {
                {
                    float _e54 = t;
                    return _e54;
                }
            }
        }
    }
    return NO_HIT;
}

vec3 around(vec3 w, float cosine, float turn) {
    vec3 w_1 = vec3(0.0);
    float cosine_1 = 0.0;
    float turn_1 = 0.0;
    vec3 local = vec3(0.0);
    vec3 up = vec3(0.0);
    vec3 a = vec3(0.0);
    vec3 b_1 = vec3(0.0);
    float sine = 0.0;
    float phi = 0.0;
    w_1 = w;
    cosine_1 = cosine;
    turn_1 = turn;
    vec3 _e6 = w_1;
    if ((abs(_e6.y) > 0.9)) {
        local = vec3(1.0, 0.0, 0.0);
    } else {
        local = vec3(0.0, 1.0, 0.0);
    }
    vec3 _e20 = local;
    up = _e20;
    vec3 _e22 = up;
    vec3 _e23 = w_1;
    a = normalize(cross(_e22, _e23));
    vec3 _e27 = w_1;
    vec3 _e28 = a;
    b_1 = cross(_e27, _e28);
    float _e32 = cosine_1;
    float _e33 = cosine_1;
    sine = sqrt(max((1.0 - (_e32 * _e33)), 0.0));
    float _e41 = turn_1;
    phi = (6.2831855 * _e41);
    float _e44 = sine;
    float _e45 = phi;
    vec3 _e48 = a;
    float _e50 = sine;
    float _e51 = phi;
    vec3 _e54 = b_1;
    float _e57 = cosine_1;
    vec3 _e58 = w_1;
    return ((((_e44 * cos(_e45)) * _e48) + ((_e50 * sin(_e51)) * _e54)) + (_e57 * _e58));
}

vec3 sampleLight(vec3 point, inout float lightDistance) {
    vec3 point_1 = vec3(0.0);
    vec3 toLight = vec3(0.0);
    float distance_ = 0.0;
    float sine2_ = 0.0;
    float depth = 0.0;
    float u = 0.0;
    float v_2 = 0.0;
    float cosine_2 = 0.0;
    float chord = 0.0;
    point_1 = point;
    Light _e4 = light;
    vec3 _e6 = point_1;
    toLight = (_e4.position - _e6);
    vec3 _e9 = toLight;
    distance_ = length(_e9);
    Light _e12 = light;
    Light _e14 = light;
    float _e17 = distance_;
    float _e18 = distance_;
    sine2_ = ((_e12.radius * _e14.radius) / (_e17 * _e18));
    float _e22 = sine2_;
    float _e25 = sine2_;
    depth = (_e22 / (1.0 + sqrt((1.0 - _e25))));
    float _e31 = random();
    u = _e31;
    float _e33 = random();
    v_2 = _e33;
    float _e36 = u;
    float _e37 = depth;
    cosine_2 = (1.0 - (_e36 * _e37));
    float _e41 = sine2_;
    float _e43 = cosine_2;
    float _e44 = cosine_2;
    chord = sqrt(max((_e41 - (1.0 - (_e43 * _e44))), 0.0));
    float _e52 = distance_;
    float _e53 = cosine_2;
    float _e54 = chord;
    lightDistance = (_e52 * (_e53 - _e54));
    vec3 _e57 = toLight;
    float _e58 = distance_;
    float _e61 = cosine_2;
    float _e62 = v_2;
    vec3 _e63 = around((_e57 / vec3(_e58)), _e61, _e62);
    return _e63;
}

bool inShadow(Ray ray_2, float distance_1) {
    Ray ray_3 = Ray(vec3(0.0), vec3(0.0));
    float distance_2 = 0.0;
    int i_2 = 0;
    ray_3 = ray_2;
    distance_2 = distance_1;
    while(true) {
        int _e8 = i_2;
        if (!((_e8 < SPHERES))) {
            break;
        }
        {
            Ray _e11 = ray_3;
            int _e12 = i_2;
            Sphere _e14 = spheres[_e12];
            float _e15 = intersectSphere(_e11, _e14);
            float _e16 = distance_2;
            if ((_e15 < _e16)) {
                {
                    return true;
                }
            }
            int _e19 = i_2;
            i_2 = (_e19 + 1);
        }
    }
    return false;
}

vec3 trace(Ray ray_4) {
    Ray ray_5 = Ray(vec3(0.0), vec3(0.0));
    float nearest = NO_HIT;
    int hit = -1;
    int i_3 = 0;
    float t_1 = 0.0;
    vec3 point_2 = vec3(0.0);
    vec3 normal = vec3(0.0);
    float distance_3 = 0.0;
    vec3 toLight_1 = vec3(0.0);
    vec3 sum = AMBIENT;
    float cosine_3 = 0.0;
    ray_5 = ray_4;
    while(true) {
        int _e12 = i_3;
        if (!((_e12 < SPHERES))) {
            break;
        }
        {
            Ray _e15 = ray_5;
            int _e16 = i_3;
            Sphere _e18 = spheres[_e16];
            float _e19 = intersectSphere(_e15, _e18);
            t_1 = _e19;
            float _e21 = t_1;
            float _e22 = nearest;
            if ((_e21 < _e22)) {
                {
                    float _e24 = t_1;
                    nearest = _e24;
                    int _e25 = i_3;
                    hit = _e25;
                }
            }
            int _e26 = i_3;
            i_3 = (_e26 + 1);
        }
    }
    int _e29 = hit;
    if ((_e29 < 0)) {
        {
            return vec3(0.4, 0.5, 0.7);
        }
    }
    Ray _e36 = ray_5;
    float _e38 = nearest;
    Ray _e39 = ray_5;
    point_2 = (_e36.origin + (_e38 * _e39.direction));
    vec3 _e44 = point_2;
    int _e45 = hit;
    Sphere _e47 = spheres[_e45];
    normal = normalize((_e44 - _e47.center));
    vec3 _e53 = point_2;
    vec3 _e54 = sampleLight(_e53, distance_3);
    toLight_1 = _e54;
    vec3 _e57 = normal;
    vec3 _e58 = toLight_1;
    cosine_3 = dot(_e57, _e58);
    float _e61 = cosine_3;
    if ((_e61 > 0.0)) {
        {
            vec3 _e64 = point_2;
            vec3 _e66 = normal;
            vec3 _e69 = toLight_1;
            float _e71 = distance_3;
            bool _e72 = inShadow(Ray((_e64 + (0.001 * _e66)), _e69), _e71);
            if (!(_e72)) {
                {
                    vec3 _e74 = sum;
                    Light _e75 = light;
                    float _e77 = cosine_3;
                    sum = (_e74 + (_e75.color * _e77));
                }
            }
        }
    }
    int _e80 = hit;
    Sphere _e82 = spheres[_e80];
    vec3 _e84 = sum;
    return (_e82.color * _e84);
}

Ray cameraRay(vec2 fragCoord_2) {
    vec2 fragCoord_3 = vec2(0.0);
    float aspect = 0.0;
    float x = 0.0;
    float y = 0.0;
    fragCoord_3 = fragCoord_2;
    vec3 _e5 = _group_0_binding_0_fs.iResolution;
    vec3 _e7 = _group_0_binding_0_fs.iResolution;
    aspect = (_e5.x / _e7.y);
    vec2 _e11 = fragCoord_3;
    vec3 _e13 = _group_0_binding_0_fs.iResolution;
    x = (((_e11.x / _e13.x) * 2.0) - 1.0);
    vec2 _e21 = fragCoord_3;
    vec3 _e23 = _group_0_binding_0_fs.iResolution;
    float _e30 = aspect;
    y = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x;
    float _e36 = y;
    return Ray(vec3(0.0), normalize(vec3(_e35, _e36, SCREEN_DEPTH)));
}

void mainImage(inout vec4 fragColor, vec2 fragCoord_4) {
    vec2 fragCoord_5 = vec2(0.0);
    vec3 color = vec3(0.0);
    int i_4 = 0;
    float x_1 = 0.0;
    float y_1 = 0.0;
    fragCoord_5 = fragCoord_4;
    fragColor = vec4(0.0);
    makeScene();
    while(true) {
        int _e11 = i_4;
        if (!((_e11 < SAMPLES))) {
            break;
        }
        {
            vec2 _e14 = fragCoord_5;
            int _e15 = i_4;
            startSample(_e14, _e15);
            vec2 _e16 = fragCoord_5;
            float _e18 = random();
            x_1 = ((_e16.x + _e18) - 0.5);
            vec2 _e23 = fragCoord_5;
            float _e25 = random();
            y_1 = ((_e23.y + _e25) - 0.5);
            vec3 _e30 = color;
            float _e31 = x_1;
            float _e32 = y_1;
            Ray _e34 = cameraRay(vec2(_e31, _e32));
            vec3 _e35 = trace(_e34);
            color = (_e30 + _e35);
            int _e37 = i_4;
            i_4 = (_e37 + 1);
        }
    }
    vec3 _e40 = color;
    vec3 _e43 = (_e40 / vec3(16.0));
    fragColor = vec4(_e43.x, _e43.y, _e43.z, 1.0);
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

