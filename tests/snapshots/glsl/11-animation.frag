#version 300 es
// glsl/11-animation.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
const float TAU = 6.2831855;
const int BODIES = 6;
const vec3 AMBIENT = vec3(0.12);
const vec3 SUN = vec3(0.0, 0.2, -7.0);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Sphere bodies[6] = Sphere[6](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));

vec3 lamp = vec3(0.0);

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

vec3 rotate(vec3 v, vec3 axis, float angle) {
    vec3 v_1 = vec3(0.0);
    vec3 axis_1 = vec3(0.0);
    float angle_1 = 0.0;
    float c = 0.0;
    float s = 0.0;
    v_1 = v;
    axis_1 = axis;
    angle_1 = angle;
    float _e6 = angle_1;
    c = cos(_e6);
    float _e9 = angle_1;
    s = sin(_e9);
    float _e12 = c;
    vec3 _e13 = v_1;
    float _e15 = s;
    vec3 _e16 = axis_1;
    vec3 _e17 = v_1;
    float _e22 = c;
    vec3 _e24 = axis_1;
    vec3 _e25 = v_1;
    vec3 _e28 = axis_1;
    return (((_e12 * _e13) + (_e15 * cross(_e16, _e17))) + (((1.0 - _e22) * dot(_e24, _e25)) * _e28));
}

vec3 rotateAbout(vec3 p, vec3 pivot, vec3 axis_2, float turns) {
    vec3 p_1 = vec3(0.0);
    vec3 pivot_1 = vec3(0.0);
    vec3 axis_3 = vec3(0.0);
    float turns_1 = 0.0;
    p_1 = p;
    pivot_1 = pivot;
    axis_3 = axis_2;
    turns_1 = turns;
    vec3 _e9 = pivot_1;
    vec3 _e10 = p_1;
    vec3 _e11 = pivot_1;
    vec3 _e13 = axis_3;
    float _e14 = turns_1;
    vec3 _e17 = rotate((_e10 - _e11), _e13, (TAU * fract(_e14)));
    return (_e9 + _e17);
}

vec3 year(vec3 p_2) {
    vec3 p_3 = vec3(0.0);
    p_3 = p_2;
    vec3 _e5 = p_3;
    float _e10 = _group_0_binding_0_fs.iTime;
    vec3 _e13 = rotateAbout(_e5, SUN, vec3(0.0, 1.0, 0.0), (_e10 / 8.0));
    return _e13;
}

vec3 month(vec3 p_4) {
    vec3 p_5 = vec3(0.0);
    p_5 = p_4;
    vec3 _e4 = p_5;
    float _e13 = _group_0_binding_0_fs.iTime;
    vec3 _e16 = rotateAbout(_e4, vec3(2.0, 0.2, -7.0), vec3(0.0, 0.8, 0.6), (_e13 / 2.0));
    vec3 _e17 = year(_e16);
    return _e17;
}

vec3 orbit(vec3 p_6) {
    vec3 p_7 = vec3(0.0);
    p_7 = p_6;
    vec3 _e4 = p_7;
    int _e13 = _group_0_binding_0_fs.iFrame;
    vec3 _e17 = rotateAbout(_e4, vec3(2.75, 0.2, -7.0), vec3(1.0, 0.0, 0.0), (float(_e13) / 60.0));
    vec3 _e18 = month(_e17);
    return _e18;
}

vec3 retrograde(vec3 p_8) {
    vec3 p_9 = vec3(0.0);
    p_9 = p_8;
    vec3 _e5 = p_9;
    float _e10 = _group_0_binding_0_fs.iTime;
    vec3 _e14 = rotateAbout(_e5, SUN, vec3(0.0, 0.96, -0.28), (-(_e10) / 5.0));
    return _e14;
}

void makeScene() {
    bodies[0] = Sphere(vec3(0.0, 0.2, -7.0), 0.8, vec3(1.0, 0.8, 0.3));
    vec3 _e20 = year(vec3(2.0, 0.2, -7.0));
    bodies[1] = Sphere(_e20, 0.35, vec3(0.3, 0.5, 0.9));
    vec3 _e33 = month(vec3(2.75, 0.2, -7.0));
    bodies[2] = Sphere(_e33, 0.15, vec3(0.8, 0.8, 0.8));
    vec3 _e46 = orbit(vec3(2.75, 0.45, -7.0));
    bodies[3] = Sphere(_e46, 0.06, vec3(0.9, 0.3, 0.9));
    vec3 _e59 = retrograde(vec3(-1.4, 0.2, -7.0));
    bodies[4] = Sphere(_e59, 0.22, vec3(0.9, 0.4, 0.2));
    bodies[5] = Sphere(vec3(0.0, -52.0, -8.0), 50.0, vec3(0.4, 0.4, 0.5));
    vec3 _e82 = retrograde(vec3(3.0, 5.0, -4.0));
    lamp = _e82;
    return;
}

float intersectSphere(Ray ray, Sphere sphere) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_1 = Sphere(vec3(0.0), 0.0, vec3(0.0));
    vec3 f = vec3(0.0);
    float b = 0.0;
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
    b = dot(_e11, _e12.direction);
    vec3 _e16 = f;
    vec3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c_1 = (dot(_e16, _e17) - (_e19.radius * _e21.radius));
    float _e26 = b;
    float _e27 = b;
    float _e29 = c_1;
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

bool inShadow(vec3 point, vec3 normal) {
    vec3 point_1 = vec3(0.0);
    vec3 normal_1 = vec3(0.0);
    vec3 origin = vec3(0.0);
    vec3 toLight = vec3(0.0);
    float distance_ = 0.0;
    Ray ray_2 = Ray(vec3(0.0), vec3(0.0));
    int i = 0;
    point_1 = point;
    normal_1 = normal;
    vec3 _e7 = point_1;
    vec3 _e9 = normal_1;
    origin = (_e7 + (0.001 * _e9));
    vec3 _e13 = lamp;
    vec3 _e14 = origin;
    toLight = (_e13 - _e14);
    vec3 _e17 = toLight;
    distance_ = length(_e17);
    vec3 _e20 = origin;
    vec3 _e21 = toLight;
    float _e22 = distance_;
    ray_2 = Ray(_e20, (_e21 / vec3(_e22)));
    while(true) {
        int _e29 = i;
        if (!((_e29 < BODIES))) {
            break;
        }
        {
            Ray _e32 = ray_2;
            int _e33 = i;
            Sphere _e35 = bodies[_e33];
            float _e36 = intersectSphere(_e32, _e35);
            float _e37 = distance_;
            if ((_e36 < _e37)) {
                {
                    return true;
                }
            }
            int _e40 = i;
            i = (_e40 + 1);
        }
    }
    return false;
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
    Ray ray_3 = Ray(vec3(0.0), vec3(0.0));
    vec3 color = vec3(0.02, 0.02, 0.06);
    float nearest = NO_HIT;
    int hit = -1;
    int i_1 = 0;
    float t_1 = 0.0;
    vec3 point_2 = vec3(0.0);
    vec3 normal_2 = vec3(0.0);
    float cosine = 0.0;
    vec3 sum = AMBIENT;
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    makeScene();
    vec2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10);
    ray_3 = _e11;
    while(true) {
        int _e23 = i_1;
        if (!((_e23 < BODIES))) {
            break;
        }
        {
            Ray _e26 = ray_3;
            int _e27 = i_1;
            Sphere _e29 = bodies[_e27];
            float _e30 = intersectSphere(_e26, _e29);
            t_1 = _e30;
            float _e32 = t_1;
            float _e33 = nearest;
            if ((_e32 < _e33)) {
                {
                    float _e35 = t_1;
                    nearest = _e35;
                    int _e36 = i_1;
                    hit = _e36;
                }
            }
            int _e37 = i_1;
            i_1 = (_e37 + 1);
        }
    }
    int _e40 = hit;
    if ((_e40 >= 0)) {
        {
            Ray _e43 = ray_3;
            float _e45 = nearest;
            Ray _e46 = ray_3;
            point_2 = (_e43.origin + (_e45 * _e46.direction));
            vec3 _e51 = point_2;
            int _e52 = hit;
            Sphere _e54 = bodies[_e52];
            normal_2 = normalize((_e51 - _e54.center));
            vec3 _e59 = normal_2;
            vec3 _e60 = lamp;
            vec3 _e61 = point_2;
            cosine = dot(_e59, normalize((_e60 - _e61)));
            float _e67 = cosine;
            if ((_e67 > 0.0)) {
                {
                    vec3 _e70 = point_2;
                    vec3 _e71 = normal_2;
                    bool _e72 = inShadow(_e70, _e71);
                    if (!(_e72)) {
                        {
                            vec3 _e74 = sum;
                            float _e77 = cosine;
                            sum = (_e74 + (vec3(0.88) * _e77));
                        }
                    }
                }
            }
            int _e80 = hit;
            Sphere _e82 = bodies[_e80];
            vec3 _e84 = sum;
            color = (_e82.color * _e84);
        }
    }
    vec3 _e86 = color;
    fragColor = vec4(_e86.x, _e86.y, _e86.z, 1.0);
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

