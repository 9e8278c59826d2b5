#version 300 es
// glsl/04-many-objects.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
    vec3 color;
};
struct Intersection {
    float t;
    int sphere;
    vec3 point;
    vec3 normal;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const int SAMPLES = 4;
const int SPHERES = 7;
const vec3 AMBIENT = vec3(0.08);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Sphere spheres[7] = Sphere[7](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));

Light light = Light(vec3(0.0), vec3(0.0));

float seed = 0.0;

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

float random() {
    float _e1 = seed;
    seed = (_e1 + 1.0);
    return fract((sin(_e1) * 43758.547));
}

void makeScene() {
    spheres[0] = Sphere(vec3(0.0, -31.0, -8.0), 30.0, vec3(0.5, 0.5, 0.45));
    spheres[1] = Sphere(vec3(0.5, -0.7, -4.0), 0.3, vec3(0.2, 0.8, 0.3));
    spheres[2] = Sphere(vec3(0.0, 0.0, -6.0), 1.0, vec3(0.9, 0.8, 0.1));
    spheres[3] = Sphere(vec3(-1.5, -0.4, -5.0), 0.6, vec3(0.9, 0.2, 0.15));
    spheres[4] = Sphere(vec3(1.4, -0.5, -4.8), 0.5, vec3(0.15, 0.3, 0.9));
    spheres[5] = Sphere(vec3(-0.6, 1.1, -5.5), 0.35, vec3(0.8, 0.4, 0.8));
    spheres[6] = Sphere(vec3(6.8, 10.2, 5.9), 3.0, vec3(0.6, 0.6, 0.6));
    light = Light(vec3(4.0, 6.0, 1.0), vec3(0.9));
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

Intersection nearestHit(Ray ray_2) {
    Ray ray_3 = Ray(vec3(0.0), vec3(0.0));
    Intersection hit = Intersection(0.0, 0, vec3(0.0), vec3(0.0));
    int i = 0;
    float t_1 = 0.0;
    int i_1 = 0;
    ray_3 = ray_2;
    hit.t = NO_HIT;
    hit.sphere = -1;
    while(true) {
        int _e11 = i;
        if (!((_e11 < SPHERES))) {
            break;
        }
        {
            Ray _e14 = ray_3;
            int _e15 = i;
            Sphere _e17 = spheres[_e15];
            float _e18 = intersectSphere(_e14, _e17);
            t_1 = _e18;
            float _e20 = t_1;
            Intersection _e21 = hit;
            if ((_e20 < _e21.t)) {
                {
                    float _e25 = t_1;
                    hit.t = _e25;
                    int _e27 = i;
                    hit.sphere = _e27;
                }
            }
            int _e28 = i;
            i = (_e28 + 1);
        }
    }
    while(true) {
        int _e33 = i_1;
        if (!((_e33 < SPHERES))) {
            break;
        }
        {
            int _e36 = i_1;
            Intersection _e37 = hit;
            if ((_e36 == _e37.sphere)) {
                {
                    Ray _e41 = ray_3;
                    Intersection _e43 = hit;
                    Ray _e45 = ray_3;
                    hit.point = (_e41.origin + (_e43.t * _e45.direction));
                    Intersection _e50 = hit;
                    int _e52 = i_1;
                    Sphere _e54 = spheres[_e52];
                    int _e57 = i_1;
                    Sphere _e59 = spheres[_e57];
                    hit.normal = ((_e50.point - _e54.center) / vec3(_e59.radius));
                }
            }
            int _e63 = i_1;
            i_1 = (_e63 + 1);
        }
    }
    Intersection _e66 = hit;
    return _e66;
}

bool inShadow(vec3 point, vec3 normal) {
    vec3 point_1 = vec3(0.0);
    vec3 normal_1 = vec3(0.0);
    vec3 origin = vec3(0.0);
    vec3 toLight = vec3(0.0);
    float distance_ = 0.0;
    Ray ray_4 = Ray(vec3(0.0), vec3(0.0));
    int i_2 = 0;
    point_1 = point;
    normal_1 = normal;
    vec3 _e7 = point_1;
    vec3 _e9 = normal_1;
    origin = (_e7 + (0.001 * _e9));
    Light _e13 = light;
    vec3 _e15 = origin;
    toLight = (_e13.position - _e15);
    vec3 _e18 = toLight;
    distance_ = length(_e18);
    vec3 _e21 = origin;
    vec3 _e22 = toLight;
    float _e23 = distance_;
    ray_4 = Ray(_e21, (_e22 / vec3(_e23)));
    while(true) {
        int _e30 = i_2;
        if (!((_e30 < SPHERES))) {
            break;
        }
        {
            Ray _e33 = ray_4;
            int _e34 = i_2;
            Sphere _e36 = spheres[_e34];
            float _e37 = intersectSphere(_e33, _e36);
            float _e38 = distance_;
            if ((_e37 < _e38)) {
                {
                    return true;
                }
            }
            int _e41 = i_2;
            i_2 = (_e41 + 1);
        }
    }
    return false;
}

vec3 trace(Ray ray_5) {
    Ray ray_6 = Ray(vec3(0.0), vec3(0.0));
    Intersection hit_1 = Intersection(0.0, 0, vec3(0.0), vec3(0.0));
    vec3 sum = AMBIENT;
    float cosine = 0.0;
    ray_6 = ray_5;
    Ray _e5 = ray_6;
    Intersection _e6 = nearestHit(_e5);
    hit_1 = _e6;
    Intersection _e8 = hit_1;
    if ((_e8.sphere < 0)) {
        {
            return vec3(0.3, 0.4, 0.6);
        }
    }
    Intersection _e17 = hit_1;
    Light _e19 = light;
    Intersection _e21 = hit_1;
    cosine = dot(_e17.normal, normalize((_e19.position - _e21.point)));
    float _e27 = cosine;
    if ((_e27 > 0.0)) {
        {
            Intersection _e30 = hit_1;
            Intersection _e32 = hit_1;
            bool _e34 = inShadow(_e30.point, _e32.normal);
            if (!(_e34)) {
                {
                    vec3 _e36 = sum;
                    Light _e37 = light;
                    float _e39 = cosine;
                    sum = (_e36 + (_e37.color * _e39));
                }
            }
        }
    }
    Intersection _e42 = hit_1;
    Sphere _e45 = spheres[_e42.sphere];
    vec3 _e47 = sum;
    return (_e45.color * _e47);
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
    vec3 color = vec3(0.0);
    int i_3 = 0;
    float x_1 = 0.0;
    float y_1 = 0.0;
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    makeScene();
    seed = 0.0;
    while(true) {
        int _e13 = i_3;
        if (!((_e13 < SAMPLES))) {
            break;
        }
        {
            vec2 _e16 = fragCoord_3;
            float _e18 = random();
            x_1 = ((_e16.x + _e18) - 0.5);
            vec2 _e23 = fragCoord_3;
            float _e25 = random();
            y_1 = ((_e23.y + _e25) - 0.5);
            vec3 _e30 = color;
            float _e31 = x_1;
            float _e32 = y_1;
            Ray _e34 = cameraRay(vec2(_e31, _e32));
            vec3 _e35 = trace(_e34);
            color = (_e30 + _e35);
            int _e37 = i_3;
            i_3 = (_e37 + 1);
        }
    }
    vec3 _e40 = color;
    vec3 _e43 = (_e40 / vec3(4.0));
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

