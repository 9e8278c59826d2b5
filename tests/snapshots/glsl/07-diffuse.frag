#version 300 es
// glsl/07-diffuse.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
struct Material {
    vec3 albedo;
};
struct Sphere {
    vec3 center;
    float radius;
    Material material;
};
struct Light {
    vec3 position;
    vec3 color;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const float PI = 3.1415927;
const int SPHERES = 4;
const int LIGHTS = 2;
const vec3 AMBIENT = vec3(0.3, 0.35, 0.45);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, Material(vec3(0.0))), Sphere(vec3(0.0), 0.0, Material(vec3(0.0))), Sphere(vec3(0.0), 0.0, Material(vec3(0.0))), Sphere(vec3(0.0), 0.0, Material(vec3(0.0))));

Light lights[2] = Light[2](Light(vec3(0.0), vec3(0.0)), Light(vec3(0.0), vec3(0.0)));

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

void makeScene() {
    spheres[0] = Sphere(vec3(0.0, -101.0, -7.0), 100.0, Material(vec3(0.5, 0.5, 0.5)));
    spheres[1] = Sphere(vec3(-1.9, 0.0, -7.5), 1.0, Material(vec3(0.8, 0.25, 0.2)));
    spheres[2] = Sphere(vec3(0.2, -0.1, -6.5), 0.9, Material(vec3(0.75, 0.75, 0.75)));
    spheres[3] = Sphere(vec3(1.9, -0.3, -6.0), 0.7, Material(vec3(0.2, 0.45, 0.8)));
    lights[0] = Light(vec3(4.0, 6.0, -2.0), vec3(9.0, 8.5, 7.5));
    lights[1] = Light(vec3(-5.0, 3.0, 0.0), vec3(2.0, 2.5, 4.0));
    return;
}

float intersectSphere(Ray ray, Sphere sphere) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_1 = Sphere(vec3(0.0), 0.0, Material(vec3(0.0)));
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

bool inShadow(vec3 point, vec3 normal, Light light) {
    vec3 point_1 = vec3(0.0);
    vec3 normal_1 = vec3(0.0);
    Light light_1 = Light(vec3(0.0), vec3(0.0));
    vec3 origin = vec3(0.0);
    vec3 toLight = vec3(0.0);
    float distance_ = 0.0;
    Ray ray_2 = Ray(vec3(0.0), vec3(0.0));
    int i = 0;
    point_1 = point;
    normal_1 = normal;
    light_1 = light;
    vec3 _e8 = point_1;
    vec3 _e10 = normal_1;
    origin = (_e8 + (0.001 * _e10));
    Light _e14 = light_1;
    vec3 _e16 = origin;
    toLight = (_e14.position - _e16);
    vec3 _e19 = toLight;
    distance_ = length(_e19);
    vec3 _e22 = origin;
    vec3 _e23 = toLight;
    float _e24 = distance_;
    ray_2 = Ray(_e22, (_e23 / vec3(_e24)));
    while(true) {
        int _e31 = i;
        if (!((_e31 < SPHERES))) {
            break;
        }
        {
            Ray _e34 = ray_2;
            int _e35 = i;
            Sphere _e37 = spheres[_e35];
            float _e38 = intersectSphere(_e34, _e37);
            float _e39 = distance_;
            if ((_e38 < _e39)) {
                {
                    return true;
                }
            }
            int _e42 = i;
            i = (_e42 + 1);
        }
    }
    return false;
}

vec3 brdf(Material material) {
    Material material_1 = Material(vec3(0.0));
    material_1 = material;
    Material _e2 = material_1;
    return (_e2.albedo / vec3(3.1415927));
}

vec3 shade(vec3 point_2, vec3 normal_2, Material material_2) {
    vec3 point_3 = vec3(0.0);
    vec3 normal_3 = vec3(0.0);
    Material material_3 = Material(vec3(0.0));
    vec3 radiance = vec3(0.0);
    int i_1 = 0;
    float cosine = 0.0;
    point_3 = point_2;
    normal_3 = normal_2;
    material_3 = material_2;
    Material _e9 = material_3;
    radiance = (AMBIENT * _e9.albedo);
    while(true) {
        int _e15 = i_1;
        if (!((_e15 < LIGHTS))) {
            break;
        }
        {
            vec3 _e18 = normal_3;
            int _e19 = i_1;
            Light _e21 = lights[_e19];
            vec3 _e23 = point_3;
            cosine = dot(_e18, normalize((_e21.position - _e23)));
            float _e28 = cosine;
            if ((_e28 > 0.0)) {
                {
                    vec3 _e31 = point_3;
                    vec3 _e32 = normal_3;
                    int _e33 = i_1;
                    Light _e35 = lights[_e33];
                    bool _e36 = inShadow(_e31, _e32, _e35);
                    if (!(_e36)) {
                        {
                            vec3 _e38 = radiance;
                            int _e39 = i_1;
                            Light _e41 = lights[_e39];
                            Material _e43 = material_3;
                            vec3 _e44 = brdf(_e43);
                            float _e46 = cosine;
                            radiance = (_e38 + ((_e41.color * _e44) * _e46));
                        }
                    }
                }
            }
            int _e49 = i_1;
            i_1 = (_e49 + 1);
        }
    }
    vec3 _e52 = radiance;
    return _e52;
}

vec3 toneMap(vec3 color) {
    vec3 color_1 = vec3(0.0);
    color_1 = color;
    vec3 _e2 = color_1;
    vec3 _e3 = color_1;
    return (_e2 / (_e3 + vec3(1.0)));
}

vec3 gammaCorrect(vec3 color_2) {
    vec3 color_3 = vec3(0.0);
    color_3 = color_2;
    vec3 _e2 = color_3;
    return pow(_e2, vec3(0.45454544));
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
    vec3 color_4 = vec3(0.5, 0.6, 0.8);
    float nearest = NO_HIT;
    int hit = -1;
    int i_2 = 0;
    float t_1 = 0.0;
    vec3 point_4 = vec3(0.0);
    vec3 normal_4 = vec3(0.0);
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    makeScene();
    vec2 _e8 = fragCoord_3;
    Ray _e9 = cameraRay(_e8);
    ray_3 = _e9;
    while(true) {
        int _e21 = i_2;
        if (!((_e21 < SPHERES))) {
            break;
        }
        {
            Ray _e24 = ray_3;
            int _e25 = i_2;
            Sphere _e27 = spheres[_e25];
            float _e28 = intersectSphere(_e24, _e27);
            t_1 = _e28;
            float _e30 = t_1;
            float _e31 = nearest;
            if ((_e30 < _e31)) {
                {
                    float _e33 = t_1;
                    nearest = _e33;
                    int _e34 = i_2;
                    hit = _e34;
                }
            }
            int _e35 = i_2;
            i_2 = (_e35 + 1);
        }
    }
    int _e38 = hit;
    if ((_e38 >= 0)) {
        {
            Ray _e41 = ray_3;
            float _e43 = nearest;
            Ray _e44 = ray_3;
            point_4 = (_e41.origin + (_e43 * _e44.direction));
            vec3 _e49 = point_4;
            int _e50 = hit;
            Sphere _e52 = spheres[_e50];
            normal_4 = normalize((_e49 - _e52.center));
            vec3 _e57 = point_4;
            vec3 _e58 = normal_4;
            int _e59 = hit;
            Sphere _e61 = spheres[_e59];
            vec3 _e63 = shade(_e57, _e58, _e61.material);
            color_4 = _e63;
        }
    }
    vec3 _e64 = color_4;
    vec3 _e65 = toneMap(_e64);
    vec3 _e66 = gammaCorrect(_e65);
    fragColor = vec4(_e66.x, _e66.y, _e66.z, 1.0);
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

