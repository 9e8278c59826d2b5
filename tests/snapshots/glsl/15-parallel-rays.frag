#version 300 es
// glsl/15-parallel-rays.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
const float NO_HIT = 1000000.0;
const float WIDTH = 6.0;
const int SPHERES = 5;
const vec3 AMBIENT = vec3(0.1, 0.1, 0.12);
const vec3 LIGHT = vec3(3.0, 5.0, 4.0);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Sphere spheres[5] = Sphere[5](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

void makeScene() {
    spheres[0] = Sphere(vec3(-2.0, 0.0, -4.0), 0.7, vec3(0.9, 0.3, 0.2));
    spheres[1] = Sphere(vec3(-1.0, 0.3, -6.0), 0.7, vec3(0.9, 0.6, 0.2));
    spheres[2] = Sphere(vec3(0.0, 0.0, -9.0), 0.7, vec3(0.9, 0.9, 0.3));
    spheres[3] = Sphere(vec3(1.0, -0.3, -13.0), 0.7, vec3(0.3, 0.8, 0.4));
    spheres[4] = Sphere(vec3(2.0, 0.0, -18.0), 0.7, vec3(0.3, 0.5, 0.9));
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

Ray cameraRay(vec2 fragCoord) {
    vec2 fragCoord_1 = vec2(0.0);
    float aspect = 0.0;
    float x = 0.0;
    float y = 0.0;
    fragCoord_1 = fragCoord;
    vec3 _e4 = _group_0_binding_0_fs.iResolution;
    vec3 _e6 = _group_0_binding_0_fs.iResolution;
    aspect = (_e4.x / _e6.y);
    vec2 _e10 = fragCoord_1;
    vec3 _e12 = _group_0_binding_0_fs.iResolution;
    x = (((_e10.x / _e12.x) * 2.0) - 1.0);
    vec2 _e20 = fragCoord_1;
    vec3 _e22 = _group_0_binding_0_fs.iResolution;
    float _e29 = aspect;
    y = ((((_e20.y / _e22.y) * 2.0) - 1.0) / _e29);
    float _e33 = x;
    float _e34 = y;
    return Ray((3.0 * vec3(_e33, _e34, 0.0)), vec3(0.0, 0.0, -1.0));
}

void mainImage(inout vec4 fragColor, vec2 fragCoord_2) {
    vec2 fragCoord_3 = vec2(0.0);
    Ray ray_2 = Ray(vec3(0.0), vec3(0.0));
    vec3 color = vec3(0.05, 0.05, 0.08);
    float nearest = NO_HIT;
    int hit = -1;
    int i = 0;
    float t_1 = 0.0;
    vec3 point = vec3(0.0);
    vec3 normal = vec3(0.0);
    vec3 toLight = vec3(0.0);
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    makeScene();
    vec2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10);
    ray_2 = _e11;
    while(true) {
        int _e23 = i;
        if (!((_e23 < SPHERES))) {
            break;
        }
        {
            Ray _e26 = ray_2;
            int _e27 = i;
            Sphere _e29 = spheres[_e27];
            float _e30 = intersectSphere(_e26, _e29);
            t_1 = _e30;
            float _e32 = t_1;
            float _e33 = nearest;
            if ((_e32 < _e33)) {
                {
                    float _e35 = t_1;
                    nearest = _e35;
                    int _e36 = i;
                    hit = _e36;
                }
            }
            int _e37 = i;
            i = (_e37 + 1);
        }
    }
    int _e40 = hit;
    if ((_e40 >= 0)) {
        {
            Ray _e43 = ray_2;
            float _e45 = nearest;
            Ray _e46 = ray_2;
            point = (_e43.origin + (_e45 * _e46.direction));
            vec3 _e51 = point;
            int _e52 = hit;
            Sphere _e54 = spheres[_e52];
            normal = normalize((_e51 - _e54.center));
            vec3 _e59 = point;
            toLight = normalize((LIGHT - _e59));
            int _e63 = hit;
            Sphere _e65 = spheres[_e63];
            vec3 _e69 = normal;
            vec3 _e70 = toLight;
            color = (_e65.color * (AMBIENT + (vec3(0.9) * max(dot(_e69, _e70), 0.0))));
        }
    }
    vec3 _e77 = color;
    fragColor = vec4(_e77.x, _e77.y, _e77.z, 1.0);
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

