#version 300 es
// glsl/05-complex-scene.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
struct Intersection {
    float t;
    Sphere sphere;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const float SHRINK = 2.8;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(4.0, 5.0, 2.0);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

int toyproof_remainder(int a, int b) {
    int a_1 = 0;
    int b_1 = 0;
    int r = 0;
    int local = 0;
    a_1 = a;
    b_1 = b;
    int _e4 = a_1;
    int _e5 = b_1;
    r = (_e4 % _e5);
    int _e8 = r;
    int _e11 = r;
    int _e12 = b_1;
    if (((_e8 != 0) && ((_e11 ^ _e12) < 0))) {
        int _e17 = r;
        int _e18 = b_1;
        local = (_e17 + _e18);
    } else {
        int _e20 = r;
        local = _e20;
    }
    int _e22 = local;
    return _e22;
}

vec3 side(int i) {
    int i_1 = 0;
    vec3 axis = vec3(0.0);
    vec3 local_1 = vec3(0.0);
    i_1 = i;
    int _e2 = i_1;
    int _e7 = i_1;
    int _e12 = i_1;
    axis = vec3(float(((_e2 / 2) == 0)), float(((_e7 / 2) == 1)), float(((_e12 / 2) == 2)));
    int _e22 = i_1;
    int _e24 = toyproof_remainder(_e22, 2);
    if ((_e24 == 0)) {
        vec3 _e27 = axis;
        local_1 = _e27;
    } else {
        vec3 _e28 = axis;
        local_1 = -(_e28);
    }
    vec3 _e31 = local_1;
    return _e31;
}

vec3 sideColor(int i_2) {
    int i_3 = 0;
    i_3 = i_2;
    int _e4 = i_3;
    vec3 _e5 = side(_e4);
    return (vec3(0.5) + (0.4 * _e5));
}

vec3 turn(vec3 v, int frame) {
    vec3 v_1 = vec3(0.0);
    int frame_1 = 0;
    float angle = 0.0;
    float c = 0.0;
    float s = 0.0;
    v_1 = v;
    frame_1 = frame;
    int _e5 = frame_1;
    angle = ((6.2831855 * float(_e5)) / 240.0);
    float _e11 = angle;
    c = cos(_e11);
    float _e14 = angle;
    s = sin(_e14);
    float _e17 = c;
    vec3 _e18 = v_1;
    float _e21 = s;
    vec3 _e22 = v_1;
    vec3 _e26 = v_1;
    float _e28 = c;
    vec3 _e29 = v_1;
    float _e32 = s;
    vec3 _e33 = v_1;
    return vec3(((_e17 * _e18.x) + (_e21 * _e22.z)), _e26.y, ((_e28 * _e29.z) - (_e32 * _e33.x)));
}

Sphere childOf(Sphere parent, int i_4, int frame_2) {
    Sphere parent_1 = Sphere(vec3(0.0), 0.0, vec3(0.0));
    int i_5 = 0;
    int frame_3 = 0;
    float radius = 0.0;
    vec3 center = vec3(0.0);
    parent_1 = parent;
    i_5 = i_4;
    frame_3 = frame_2;
    Sphere _e7 = parent_1;
    radius = (_e7.radius / SHRINK);
    Sphere _e11 = parent_1;
    Sphere _e13 = parent_1;
    float _e15 = radius;
    int _e17 = i_5;
    vec3 _e18 = side(_e17);
    int _e19 = frame_3;
    vec3 _e20 = turn(_e18, _e19);
    center = (_e11.center + ((_e13.radius + _e15) * _e20));
    vec3 _e24 = center;
    float _e25 = radius;
    Sphere _e27 = parent_1;
    int _e29 = i_5;
    vec3 _e30 = sideColor(_e29);
    return Sphere(_e24, _e25, (0.5 * (_e27.color + _e30)));
}

float intersectSphere(Ray ray, Sphere sphere) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_1 = Sphere(vec3(0.0), 0.0, vec3(0.0));
    vec3 f = vec3(0.0);
    float b_2 = 0.0;
    float c_1 = 0.0;
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
    b_2 = dot(_e11, _e12.direction);
    vec3 _e16 = f;
    vec3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c_1 = (dot(_e16, _e17) - (_e19.radius * _e21.radius));
    float _e26 = b_2;
    float _e27 = b_2;
    float _e29 = c_1;
    disc = ((_e26 * _e27) - _e29);
    float _e32 = disc;
    if ((_e32 > 0.0)) {
        {
            float _e35 = disc;
            root = sqrt(_e35);
            float _e38 = b_2;
            float _e40 = root;
            t = (-(_e38) - _e40);
            float _e43 = t;
            if ((_e43 > 1e-5)) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b_2;
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

void keepNearest(Ray ray_2, Sphere sphere_2, inout Intersection hit) {
    Ray ray_3 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_3 = Sphere(vec3(0.0), 0.0, vec3(0.0));
    float t_1 = 0.0;
    ray_3 = ray_2;
    sphere_3 = sphere_2;
    Ray _e5 = ray_3;
    Sphere _e6 = sphere_3;
    float _e7 = intersectSphere(_e5, _e6);
    t_1 = _e7;
    float _e9 = t_1;
    Intersection _e10 = hit;
    if ((_e9 < _e10.t)) {
        {
            float _e14 = t_1;
            hit.t = _e14;
            Sphere _e16 = sphere_3;
            hit.sphere = _e16;
            return;
        }
    } else {
        return;
    }
}

Intersection hitScene(Ray ray_4, int frame_4) {
    Ray ray_5 = Ray(vec3(0.0), vec3(0.0));
    int frame_5 = 0;
    Sphere parent_2 = Sphere(vec3(0.0, 0.0, -7.5), 1.0, vec3(0.9, 0.9, 0.8));
    Intersection hit_1 = Intersection(0.0, Sphere(vec3(0.0), 0.0, vec3(0.0)));
    int i_6 = 0;
    Sphere child = Sphere(vec3(0.0), 0.0, vec3(0.0));
    int j = 0;
    ray_5 = ray_4;
    frame_5 = frame_4;
    Sphere _e16 = parent_2;
    hit_1 = Intersection(NO_HIT, _e16);
    Ray _e19 = ray_5;
    Sphere _e20 = parent_2;
    keepNearest(_e19, _e20, hit_1);
    while(true) {
        int _e23 = i_6;
        if (!((_e23 < 6))) {
            break;
        }
        {
            Sphere _e27 = parent_2;
            int _e28 = i_6;
            int _e29 = frame_5;
            Sphere _e30 = childOf(_e27, _e28, _e29);
            child = _e30;
            Ray _e32 = ray_5;
            Sphere _e33 = child;
            keepNearest(_e32, _e33, hit_1);
            j = 0;
            while(true) {
                int _e36 = j;
                if (!((_e36 < 6))) {
                    break;
                }
                {
                    Ray _e40 = ray_5;
                    Sphere _e41 = child;
                    int _e42 = j;
                    int _e43 = frame_5;
                    Sphere _e44 = childOf(_e41, _e42, _e43);
                    keepNearest(_e40, _e44, hit_1);
                    int _e45 = j;
                    j = (_e45 + 1);
                }
            }
            int _e48 = i_6;
            i_6 = (_e48 + 1);
        }
    }
    Intersection _e51 = hit_1;
    return _e51;
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
    Ray ray_6 = Ray(vec3(0.0), vec3(0.0));
    vec3 color = vec3(0.05, 0.05, 0.1);
    Intersection hit_2 = Intersection(0.0, Sphere(vec3(0.0), 0.0, vec3(0.0)));
    vec3 point = vec3(0.0);
    vec3 normal = vec3(0.0);
    vec3 toLight = vec3(0.0);
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    vec2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10);
    ray_6 = _e11;
    Ray _e18 = ray_6;
    int _e19 = _group_0_binding_0_fs.iFrame;
    Intersection _e20 = hitScene(_e18, _e19);
    hit_2 = _e20;
    Intersection _e22 = hit_2;
    if ((_e22.t < NO_HIT)) {
        {
            Ray _e25 = ray_6;
            Intersection _e27 = hit_2;
            Ray _e29 = ray_6;
            point = (_e25.origin + (_e27.t * _e29.direction));
            vec3 _e34 = point;
            Intersection _e35 = hit_2;
            normal = normalize((_e34 - _e35.sphere.center));
            vec3 _e41 = point;
            toLight = normalize((LIGHT - _e41));
            Intersection _e45 = hit_2;
            vec3 _e50 = normal;
            vec3 _e51 = toLight;
            color = (_e45.sphere.color * (AMBIENT + (vec3(0.85) * max(dot(_e50, _e51), 0.0))));
        }
    }
    vec3 _e58 = color;
    fragColor = vec4(_e58.x, _e58.y, _e58.z, 1.0);
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

