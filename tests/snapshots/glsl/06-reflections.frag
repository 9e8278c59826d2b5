#version 300 es
// glsl/06-reflections.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const float EPSILON = 0.001;
const int SPHERES = 4;
const int MAX_DEPTH = 100;

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

void makeScene() {
    spheres[0] = Sphere(vec3(-1.3, -0.4, -5.2), 0.6, vec3(0.9, 0.6, 0.6));
    spheres[1] = Sphere(vec3(0.0, 0.0, -7.0), 1.2, vec3(0.95, 0.93, 0.88));
    spheres[2] = Sphere(vec3(0.2, -0.6, -3.6), 0.3, vec3(0.7, 0.9, 0.7));
    spheres[3] = Sphere(vec3(1.2, 0.5, -5.0), 0.7, vec3(0.6, 0.7, 0.95));
    return;
}

vec3 sky(vec3 direction) {
    vec3 direction_1 = vec3(0.0);
    float up = 0.0;
    direction_1 = direction;
    vec3 _e4 = direction_1;
    up = (0.5 * (1.0 + _e4.y));
    float _e10 = up;
    float _e17 = up;
    return (((1.0 - _e10) * vec3(0.9, 0.5, 0.25)) + (_e17 * vec3(0.1, 0.2, 0.5)));
}

float intersectSphere(Ray ray, Sphere sphere, float tMin) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_1 = Sphere(vec3(0.0), 0.0, vec3(0.0));
    float tMin_1 = 0.0;
    vec3 f = vec3(0.0);
    float b = 0.0;
    float c = 0.0;
    float disc = 0.0;
    float root = 0.0;
    float t = 0.0;
    ray_1 = ray;
    sphere_1 = sphere;
    tMin_1 = tMin;
    Ray _e7 = ray_1;
    Sphere _e9 = sphere_1;
    f = (_e7.origin - _e9.center);
    vec3 _e13 = f;
    Ray _e14 = ray_1;
    b = dot(_e13, _e14.direction);
    vec3 _e18 = f;
    vec3 _e19 = f;
    Sphere _e21 = sphere_1;
    Sphere _e23 = sphere_1;
    c = (dot(_e18, _e19) - (_e21.radius * _e23.radius));
    float _e28 = b;
    float _e29 = b;
    float _e31 = c;
    disc = ((_e28 * _e29) - _e31);
    float _e34 = disc;
    if ((_e34 > 0.0)) {
        {
            float _e37 = disc;
            root = sqrt(_e37);
            float _e40 = b;
            float _e42 = root;
            t = (-(_e40) - _e42);
            float _e45 = t;
            float _e46 = tMin_1;
            if ((_e45 > _e46)) {
                {
                    float _e48 = t;
                    return _e48;
                }
            }
            float _e49 = b;
            float _e51 = root;
            t = (-(_e49) + _e51);
            float _e53 = t;
            float _e54 = tMin_1;
            if ((_e53 > _e54)) {
                {
                    float _e56 = t;
                    return _e56;
                }
            }
        }
    }
    return NO_HIT;
}

Ray cameraRay(vec2 fragCoord) {
    vec2 fragCoord_1 = vec2(0.0);
    float aspect = 0.0;
    float x = 0.0;
    float y = 0.0;
    fragCoord_1 = fragCoord;
    vec3 _e5 = _group_0_binding_0_fs.iResolution;
    vec3 _e7 = _group_0_binding_0_fs.iResolution;
    aspect = (_e5.x / _e7.y);
    vec2 _e11 = fragCoord_1;
    vec3 _e13 = _group_0_binding_0_fs.iResolution;
    x = (((_e11.x / _e13.x) * 2.0) - 1.0);
    vec2 _e21 = fragCoord_1;
    vec3 _e23 = _group_0_binding_0_fs.iResolution;
    float _e30 = aspect;
    y = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x;
    float _e36 = y;
    return Ray(vec3(0.0), normalize(vec3(_e35, _e36, SCREEN_DEPTH)));
}

void mainImage(inout vec4 fragColor, vec2 fragCoord_2) {
    vec2 fragCoord_3 = vec2(0.0);
    Ray ray_2 = Ray(vec3(0.0), vec3(0.0));
    vec3 color = vec3(0.0);
    vec3 throughput = vec3(1.0);
    int depth = 0;
    float nearest = 0.0;
    int hit = 0;
    int i = 0;
    float t_1 = 0.0;
    vec3 point = vec3(0.0);
    vec3 normal = vec3(0.0);
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    makeScene();
    vec2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10);
    ray_2 = _e11;
    while(true) {
        int _e21 = depth;
        if (!((_e21 < MAX_DEPTH))) {
            break;
        }
        {
            nearest = NO_HIT;
            hit = -1;
            i = 0;
            while(true) {
                int _e29 = i;
                if (!((_e29 < SPHERES))) {
                    break;
                }
                {
                    Ray _e32 = ray_2;
                    int _e33 = i;
                    Sphere _e35 = spheres[_e33];
                    float _e36 = intersectSphere(_e32, _e35, EPSILON);
                    t_1 = _e36;
                    float _e38 = t_1;
                    float _e39 = nearest;
                    if ((_e38 < _e39)) {
                        {
                            float _e41 = t_1;
                            nearest = _e41;
                            int _e42 = i;
                            hit = _e42;
                        }
                    }
                    int _e43 = i;
                    i = (_e43 + 1);
                }
            }
            int _e46 = hit;
            if ((_e46 < 0)) {
                {
                    vec3 _e49 = throughput;
                    Ray _e50 = ray_2;
                    vec3 _e52 = sky(_e50.direction);
                    color = (_e49 * _e52);
                    break;
                }
            }
            Ray _e54 = ray_2;
            float _e56 = nearest;
            Ray _e57 = ray_2;
            point = (_e54.origin + (_e56 * _e57.direction));
            vec3 _e62 = point;
            int _e63 = hit;
            Sphere _e65 = spheres[_e63];
            normal = normalize((_e62 - _e65.center));
            vec3 _e70 = throughput;
            int _e71 = hit;
            Sphere _e73 = spheres[_e71];
            throughput = (_e70 * _e73.color);
            vec3 _e76 = point;
            Ray _e77 = ray_2;
            vec3 _e79 = normal;
            ray_2 = Ray(_e76, reflect(_e77.direction, _e79));
            int _e82 = depth;
            depth = (_e82 + 1);
        }
    }
    vec3 _e85 = color;
    fragColor = vec4(_e85.x, _e85.y, _e85.z, 1.0);
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

