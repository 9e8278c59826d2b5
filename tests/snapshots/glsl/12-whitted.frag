#version 300 es
// glsl/12-whitted.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
    int model;
    vec3 color;
};
struct Intersection {
    float t;
    vec3 point;
    vec3 normal;
    int model;
    vec3 color;
};
struct Branch {
    Ray ray;
    vec3 throughput;
    int depth;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const float EPSILON = 0.001;
const int SPHERES = 4;
const int MAX_DEPTH = 6;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(-4.0, 7.0, 1.0);
const int MATTE = 0;
const int MIRROR = 1;
const int GLASS = 2;
const float IOR = 1.5;

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, 0, vec3(0.0)), Sphere(vec3(0.0), 0.0, 0, vec3(0.0)), Sphere(vec3(0.0), 0.0, 0, vec3(0.0)), Sphere(vec3(0.0), 0.0, 0, vec3(0.0)));

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

void makeScene() {
    spheres[0] = Sphere(vec3(-0.5, 0.0, -4.5), 0.9, 2, vec3(0.95, 1.0, 0.95));
    spheres[1] = Sphere(vec3(1.3, 0.1, -6.5), 1.1, 1, vec3(0.9, 0.9, 0.9));
    spheres[2] = Sphere(vec3(-2.4, -0.4, -7.0), 0.6, 0, vec3(0.9, 0.3, 0.2));
    spheres[3] = Sphere(vec3(1.1, -0.7, -4.0), 0.3, 0, vec3(0.2, 0.4, 0.9));
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
    return (((1.0 - _e10) * vec3(0.9, 0.9, 0.95)) + (_e17 * vec3(0.3, 0.5, 0.9)));
}

float intersectSphere(Ray ray, Sphere sphere) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_1 = Sphere(vec3(0.0), 0.0, 0, vec3(0.0));
    vec3 f = vec3(0.0);
    float b = 0.0;
    float c = 0.0;
    float disc = 0.0;
    float root = 0.0;
    float t = 0.0;
    ray_1 = ray;
    sphere_1 = sphere;
    Ray _e6 = ray_1;
    Sphere _e8 = sphere_1;
    f = (_e6.origin - _e8.center);
    vec3 _e12 = f;
    Ray _e13 = ray_1;
    b = dot(_e12, _e13.direction);
    vec3 _e17 = f;
    vec3 _e18 = f;
    Sphere _e20 = sphere_1;
    Sphere _e22 = sphere_1;
    c = (dot(_e17, _e18) - (_e20.radius * _e22.radius));
    float _e27 = b;
    float _e28 = b;
    float _e30 = c;
    disc = ((_e27 * _e28) - _e30);
    float _e33 = disc;
    if ((_e33 > 0.0)) {
        {
            float _e36 = disc;
            root = sqrt(_e36);
            float _e39 = b;
            float _e41 = root;
            t = (-(_e39) - _e41);
            float _e44 = t;
            if ((_e44 > EPSILON)) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b;
            float _e49 = root;
            t = (-(_e47) + _e49);
            float _e51 = t;
            if ((_e51 > EPSILON)) {
                {
                    float _e53 = t;
                    return _e53;
                }
            }
        }
    }
    return NO_HIT;
}

vec3 checker(vec3 point) {
    vec3 point_1 = vec3(0.0);
    float square = 0.0;
    vec3 local = vec3(0.0);
    point_1 = point;
    vec3 _e2 = point_1;
    vec3 _e5 = point_1;
    square = (floor(_e2.x) + floor(_e5.z));
    float _e10 = square;
    if (((_e10 - (floor((_e10 / 2.0)) * 2.0)) == 0.0)) {
        local = vec3(0.9, 0.8, 0.3);
    } else {
        local = vec3(0.6, 0.15, 0.1);
    }
    vec3 _e27 = local;
    return _e27;
}

Intersection nearestHit(Ray ray_2) {
    Ray ray_3 = Ray(vec3(0.0), vec3(0.0));
    Intersection hit = Intersection(1000000.0, vec3(0.0), vec3(0.0), 0, vec3(0.0));
    int i = 0;
    float t_1 = 0.0;
    vec3 point_2 = vec3(0.0);
    vec3 normal = vec3(0.0);
    float t_2 = 0.0;
    vec3 point_3 = vec3(0.0);
    ray_3 = ray_2;
    while(true) {
        int _e18 = i;
        if (!((_e18 < SPHERES))) {
            break;
        }
        {
            Ray _e21 = ray_3;
            int _e22 = i;
            Sphere _e24 = spheres[_e22];
            float _e25 = intersectSphere(_e21, _e24);
            t_1 = _e25;
            float _e27 = t_1;
            Intersection _e28 = hit;
            if ((_e27 < _e28.t)) {
                {
                    Ray _e31 = ray_3;
                    float _e33 = t_1;
                    Ray _e34 = ray_3;
                    point_2 = (_e31.origin + (_e33 * _e34.direction));
                    vec3 _e39 = point_2;
                    int _e40 = i;
                    Sphere _e42 = spheres[_e40];
                    normal = normalize((_e39 - _e42.center));
                    float _e47 = t_1;
                    vec3 _e48 = point_2;
                    vec3 _e49 = normal;
                    int _e50 = i;
                    Sphere _e52 = spheres[_e50];
                    int _e54 = i;
                    Sphere _e56 = spheres[_e54];
                    hit = Intersection(_e47, _e48, _e49, _e52.model, _e56.color);
                }
            }
            int _e59 = i;
            i = (_e59 + 1);
        }
    }
    Ray _e63 = ray_3;
    Ray _e67 = ray_3;
    t_2 = ((-1.02 - _e63.origin.y) / _e67.direction.y);
    float _e72 = t_2;
    float _e74 = t_2;
    Intersection _e75 = hit;
    if (((_e72 > EPSILON) && (_e74 < _e75.t))) {
        {
            Ray _e79 = ray_3;
            float _e81 = t_2;
            Ray _e82 = ray_3;
            point_3 = (_e79.origin + (_e81 * _e82.direction));
            float _e87 = t_2;
            vec3 _e88 = point_3;
            vec3 _e93 = point_3;
            vec3 _e94 = checker(_e93);
            hit = Intersection(_e87, _e88, vec3(0.0, 1.0, 0.0), MATTE, _e94);
        }
    }
    Intersection _e96 = hit;
    return _e96;
}

vec3 shade(Intersection hit_1) {
    Intersection hit_2 = Intersection(0.0, vec3(0.0), vec3(0.0), 0, vec3(0.0));
    vec3 sum = AMBIENT;
    float cosine = 0.0;
    vec3 origin = vec3(0.0);
    vec3 toLight = vec3(0.0);
    float distance_ = 0.0;
    hit_2 = hit_1;
    Intersection _e6 = hit_2;
    Intersection _e8 = hit_2;
    cosine = dot(_e6.normal, normalize((LIGHT - _e8.point)));
    float _e14 = cosine;
    if ((_e14 > 0.0)) {
        {
            Intersection _e17 = hit_2;
            Intersection _e19 = hit_2;
            origin = (_e17.point + (EPSILON * _e19.normal));
            vec3 _e24 = origin;
            toLight = (LIGHT - _e24);
            vec3 _e27 = toLight;
            distance_ = length(_e27);
            vec3 _e30 = origin;
            vec3 _e31 = toLight;
            float _e32 = distance_;
            Intersection _e36 = nearestHit(Ray(_e30, (_e31 / vec3(_e32))));
            float _e38 = distance_;
            if ((_e36.t > _e38)) {
                {
                    vec3 _e40 = sum;
                    float _e43 = cosine;
                    sum = (_e40 + (vec3(0.85) * _e43));
                }
            }
        }
    }
    Intersection _e46 = hit_2;
    vec3 _e48 = sum;
    return (_e46.color * _e48);
}

float fresnel(float eta, float cosine_1, float beyond) {
    float eta_1 = 0.0;
    float cosine_2 = 0.0;
    float beyond_1 = 0.0;
    float across = 0.0;
    float along = 0.0;
    eta_1 = eta;
    cosine_2 = cosine_1;
    beyond_1 = beyond;
    float _e6 = eta_1;
    float _e7 = cosine_2;
    float _e9 = beyond_1;
    float _e11 = eta_1;
    float _e12 = cosine_2;
    float _e14 = beyond_1;
    across = (((_e6 * _e7) - _e9) / ((_e11 * _e12) + _e14));
    float _e18 = cosine_2;
    float _e19 = eta_1;
    float _e20 = beyond_1;
    float _e23 = cosine_2;
    float _e24 = eta_1;
    float _e25 = beyond_1;
    along = ((_e18 - (_e19 * _e20)) / (_e23 + (_e24 * _e25)));
    float _e31 = across;
    float _e32 = across;
    float _e34 = along;
    float _e35 = along;
    return (0.5 * ((_e31 * _e32) + (_e34 * _e35)));
}

vec3 trace(Ray first) {
    Ray first_1 = Ray(vec3(0.0), vec3(0.0));
    Branch stack[8] = Branch[8](Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0), Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0), Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0), Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0), Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0), Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0), Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0), Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0));
    int top = 1;
    vec3 color = vec3(0.0);
    Branch branch = Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0);
    Ray ray_4 = Ray(vec3(0.0), vec3(0.0));
    Intersection hit_3 = Intersection(0.0, vec3(0.0), vec3(0.0), 0, vec3(0.0));
    int depth = 0;
    vec3 throughput = vec3(0.0);
    Ray mirrored = Ray(vec3(0.0), vec3(0.0));
    bool entering = false;
    vec3 local_1 = vec3(0.0);
    vec3 normal_1 = vec3(0.0);
    float local_2 = 0.0;
    float eta_2 = 0.0;
    float cosine_3 = 0.0;
    float sine2_ = 0.0;
    float beyond_2 = 0.0;
    float share = 0.0;
    vec3 refracted = vec3(0.0);
    first_1 = first;
    Ray _e10 = first_1;
    stack[0] = Branch(_e10, vec3(1.0), 0);
    while(true) {
        int _e20 = top;
        if (!((_e20 > 0))) {
            break;
        }
        {
            int _e24 = top;
            top = (_e24 - 1);
            int _e27 = top;
            Branch _e29 = stack[_e27];
            branch = _e29;
            Branch _e31 = branch;
            ray_4 = _e31.ray;
            Ray _e34 = ray_4;
            Intersection _e35 = nearestHit(_e34);
            hit_3 = _e35;
            Intersection _e37 = hit_3;
            if ((_e37.t == NO_HIT)) {
                {
                    vec3 _e40 = color;
                    Branch _e41 = branch;
                    Ray _e43 = ray_4;
                    vec3 _e45 = sky(_e43.direction);
                    color = (_e40 + (_e41.throughput * _e45));
                    continue;
                }
            }
            Intersection _e48 = hit_3;
            if ((_e48.model == MATTE)) {
                {
                    vec3 _e51 = color;
                    Branch _e52 = branch;
                    Intersection _e54 = hit_3;
                    vec3 _e55 = shade(_e54);
                    color = (_e51 + (_e52.throughput * _e55));
                    continue;
                }
            }
            Branch _e58 = branch;
            depth = (_e58.depth + 1);
            int _e63 = depth;
            if ((_e63 == MAX_DEPTH)) {
                {
                    continue;
                }
            }
            Branch _e65 = branch;
            Intersection _e67 = hit_3;
            throughput = (_e65.throughput * _e67.color);
            Intersection _e71 = hit_3;
            Ray _e73 = ray_4;
            Intersection _e75 = hit_3;
            mirrored = Ray(_e71.point, reflect(_e73.direction, _e75.normal));
            Intersection _e80 = hit_3;
            if ((_e80.model == MIRROR)) {
                {
                    int _e83 = top;
                    top = (_e83 + 1);
                    Ray _e87 = mirrored;
                    vec3 _e88 = throughput;
                    int _e89 = depth;
                    stack[_e83] = Branch(_e87, _e88, _e89);
                    continue;
                }
            }
            Ray _e91 = ray_4;
            Intersection _e93 = hit_3;
            entering = (dot(_e91.direction, _e93.normal) < 0.0);
            bool _e99 = entering;
            if (_e99) {
                Intersection _e100 = hit_3;
                local_1 = _e100.normal;
            } else {
                Intersection _e102 = hit_3;
                local_1 = -(_e102.normal);
            }
            vec3 _e106 = local_1;
            normal_1 = _e106;
            bool _e108 = entering;
            if (_e108) {
                local_2 = 0.6666667;
            } else {
                local_2 = IOR;
            }
            float _e111 = local_2;
            eta_2 = _e111;
            Ray _e113 = ray_4;
            vec3 _e115 = normal_1;
            cosine_3 = -(dot(_e113.direction, _e115));
            float _e119 = eta_2;
            float _e120 = eta_2;
            float _e123 = cosine_3;
            float _e124 = cosine_3;
            sine2_ = ((_e119 * _e120) * (1.0 - (_e123 * _e124)));
            float _e129 = sine2_;
            if ((_e129 >= 1.0)) {
                {
                    int _e132 = top;
                    top = (_e132 + 1);
                    Ray _e136 = mirrored;
                    vec3 _e137 = throughput;
                    int _e138 = depth;
                    stack[_e132] = Branch(_e136, _e137, _e138);
                    continue;
                }
            }
            float _e141 = sine2_;
            beyond_2 = sqrt((1.0 - _e141));
            float _e145 = eta_2;
            float _e146 = cosine_3;
            float _e147 = beyond_2;
            float _e148 = fresnel(_e145, _e146, _e147);
            share = _e148;
            float _e150 = eta_2;
            Ray _e151 = ray_4;
            float _e154 = eta_2;
            float _e155 = cosine_3;
            float _e157 = beyond_2;
            vec3 _e159 = normal_1;
            refracted = ((_e150 * _e151.direction) + (((_e154 * _e155) - _e157) * _e159));
            int _e163 = top;
            top = (_e163 + 1);
            Ray _e167 = mirrored;
            vec3 _e168 = throughput;
            float _e169 = share;
            int _e171 = depth;
            stack[_e163] = Branch(_e167, (_e168 * _e169), _e171);
            int _e173 = top;
            top = (_e173 + 1);
            Intersection _e177 = hit_3;
            vec3 _e179 = refracted;
            vec3 _e181 = throughput;
            float _e183 = share;
            int _e186 = depth;
            stack[_e173] = Branch(Ray(_e177.point, _e179), (_e181 * (1.0 - _e183)), _e186);
        }
    }
    vec3 _e188 = color;
    return _e188;
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
    fragCoord_3 = fragCoord_2;
    makeScene();
    vec2 _e3 = fragCoord_3;
    Ray _e4 = cameraRay(_e3);
    vec3 _e5 = trace(_e4);
    fragColor = vec4(_e5.x, _e5.y, _e5.z, 1.0);
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

