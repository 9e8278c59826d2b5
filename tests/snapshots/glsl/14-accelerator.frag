#version 300 es
// glsl/14-accelerator.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
};
struct Intersection {
    float t;
    ivec3 cell;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const ivec3 CELLS = ivec3(11, 5, 10);
const vec3 CORNER = vec3(-4.125, -1.875, -13.5);
const float SPACING = 0.75;
const uint SEED = 7u;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(6.0, 8.0, -2.0);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

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

Sphere sphereIn(ivec3 cell) {
    ivec3 cell_1 = ivec3(0);
    float radius = 0.0;
    float room = 0.0;
    float x = 0.0;
    float y = 0.0;
    float z = 0.0;
    cell_1 = cell;
    ivec3 _e6 = cell_1;
    ivec3 _e9 = cell_1;
    ivec3 _e12 = cell_1;
    state = (SEED + uint((_e6.x + (11 * (_e9.y + (5 * _e12.z))))));
    float _e22 = random();
    radius = mix(0.1, 0.3, _e22);
    float _e26 = radius;
    room = (SPACING - (2.0 * _e26));
    float _e30 = random();
    x = _e30;
    float _e32 = random();
    y = _e32;
    float _e34 = random();
    z = _e34;
    ivec3 _e36 = cell_1;
    float _e40 = radius;
    float _e43 = room;
    float _e44 = x;
    float _e45 = y;
    float _e46 = z;
    float _e50 = radius;
    return Sphere((((CORNER + (SPACING * vec3(_e36))) + vec3(_e40)) + (_e43 * vec3(_e44, _e45, _e46))), _e50);
}

vec3 nextColor() {
    float r = 0.0;
    float g = 0.0;
    float b = 0.0;
    float _e0 = random();
    r = _e0;
    float _e2 = random();
    g = _e2;
    float _e4 = random();
    b = _e4;
    float _e9 = r;
    float _e10 = g;
    float _e11 = b;
    return (0.95 * (vec3(0.2) + (0.8 * vec3(_e9, _e10, _e11))));
}

float intersectSphere(Ray ray, Sphere sphere) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Sphere sphere_1 = Sphere(vec3(0.0), 0.0);
    vec3 f = vec3(0.0);
    float b_1 = 0.0;
    vec3 closest = vec3(0.0);
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
    b_1 = dot(_e11, _e12.direction);
    vec3 _e16 = f;
    float _e17 = b_1;
    Ray _e18 = ray_1;
    closest = (_e16 - (_e17 * _e18.direction));
    Sphere _e23 = sphere_1;
    Sphere _e25 = sphere_1;
    vec3 _e28 = closest;
    vec3 _e29 = closest;
    disc = ((_e23.radius * _e25.radius) - dot(_e28, _e29));
    float _e33 = disc;
    if ((_e33 > 0.0)) {
        {
            float _e36 = disc;
            root = sqrt(_e36);
            float _e39 = b_1;
            float _e41 = root;
            t = (-(_e39) - _e41);
            float _e44 = t;
            if ((_e44 > 1e-5)) {
                {
                    float _e47 = t;
                    return _e47;
                }
            }
            float _e48 = b_1;
            float _e50 = root;
            t = (-(_e48) + _e50);
            float _e52 = t;
            if ((_e52 > 1e-5)) {
                {
                    float _e55 = t;
                    return _e55;
                }
            }
        }
    }
    return NO_HIT;
}

Intersection hitScene(Ray ray_2) {
    Ray ray_3 = Ray(vec3(0.0), vec3(0.0));
    vec3 low = vec3(0.0);
    vec3 high = vec3(0.0);
    vec3 into = vec3(0.0);
    vec3 outOf = vec3(0.0);
    float enter = 0.0;
    float leave = 0.0;
    Intersection none = Intersection(1000000.0, ivec3(-1));
    vec3 place = vec3(0.0);
    ivec3 cell_2 = ivec3(0);
    ivec3 stride = ivec3(0);
    vec3 next = vec3(0.0);
    vec3 step_ = vec3(0.0);
    int i = 0;
    float t_1 = 0.0;
    ray_3 = ray_2;
    Ray _e5 = ray_3;
    Ray _e8 = ray_3;
    low = ((CORNER - _e5.origin) / _e8.direction);
    Ray _e16 = ray_3;
    Ray _e19 = ray_3;
    high = ((vec3(4.125, 1.875, -6.0) - _e16.origin) / _e19.direction);
    vec3 _e23 = low;
    vec3 _e24 = high;
    into = min(_e23, _e24);
    vec3 _e27 = low;
    vec3 _e28 = high;
    outOf = max(_e27, _e28);
    vec3 _e31 = into;
    vec3 _e33 = into;
    vec3 _e36 = into;
    enter = max(max(_e31.x, _e33.y), max(_e36.z, 0.0));
    vec3 _e42 = outOf;
    vec3 _e44 = outOf;
    vec3 _e46 = outOf;
    leave = min(_e42.x, min(_e44.y, _e46.z));
    float _e56 = enter;
    float _e57 = leave;
    if ((_e56 >= _e57)) {
        {
            Intersection _e59 = none;
            return _e59;
        }
    }
    Ray _e60 = ray_3;
    float _e62 = enter;
    Ray _e63 = ray_3;
    place = (((_e60.origin + (_e62 * _e63.direction)) - CORNER) / vec3(0.75));
    vec3 _e72 = place;
    cell_2 = min(max(ivec3(floor(_e72)), ivec3(0)), ivec3(10, 4, 9));
    Ray _e83 = ray_3;
    stride = ivec3(sign(_e83.direction));
    ivec3 _e88 = cell_2;
    ivec3 _e89 = stride;
    Ray _e97 = ray_3;
    Ray _e100 = ray_3;
    next = (((CORNER + (SPACING * vec3((_e88 + max(_e89, ivec3(0)))))) - _e97.origin) / _e100.direction);
    vec3 _e104 = next;
    ivec3 _e107 = stride;
    next = mix(_e104, vec3(1000000.0), equal(_e107, ivec3(0)));
    Ray _e112 = ray_3;
    step_ = (vec3(0.75) / abs(_e112.direction));
    while(true) {
        int _e121 = i;
        if (!((_e121 < 26))) {
            break;
        }
        {
            Ray _e125 = ray_3;
            ivec3 _e126 = cell_2;
            Sphere _e127 = sphereIn(_e126);
            float _e128 = intersectSphere(_e125, _e127);
            t_1 = _e128;
            float _e130 = t_1;
            if ((_e130 < NO_HIT)) {
                {
                    float _e132 = t_1;
                    ivec3 _e133 = cell_2;
                    return Intersection(_e132, _e133);
                }
            }
            vec3 _e135 = next;
            vec3 _e137 = next;
            vec3 _e140 = next;
            vec3 _e142 = next;
            if (((_e135.x < _e137.y) && (_e140.x < _e142.z))) {
                {
                    ivec3 _e147 = cell_2;
                    ivec3 _e149 = stride;
                    cell_2.x = (_e147.x + _e149.x);
                    vec3 _e153 = next;
                    vec3 _e155 = step_;
                    next.x = (_e153.x + _e155.x);
                    ivec3 _e158 = cell_2;
                    ivec3 _e162 = cell_2;
                    if (((_e158.x < 0) || (_e162.x >= 11))) {
                        {
                            Intersection _e167 = none;
                            return _e167;
                        }
                    }
                }
            } else {
                vec3 _e168 = next;
                vec3 _e170 = next;
                if ((_e168.y < _e170.z)) {
                    {
                        ivec3 _e174 = cell_2;
                        ivec3 _e176 = stride;
                        cell_2.y = (_e174.y + _e176.y);
                        vec3 _e180 = next;
                        vec3 _e182 = step_;
                        next.y = (_e180.y + _e182.y);
                        ivec3 _e185 = cell_2;
                        ivec3 _e189 = cell_2;
                        if (((_e185.y < 0) || (_e189.y >= 5))) {
                            {
                                Intersection _e194 = none;
                                return _e194;
                            }
                        }
                    }
                } else {
                    {
                        ivec3 _e196 = cell_2;
                        ivec3 _e198 = stride;
                        cell_2.z = (_e196.z + _e198.z);
                        vec3 _e202 = next;
                        vec3 _e204 = step_;
                        next.z = (_e202.z + _e204.z);
                        ivec3 _e207 = cell_2;
                        ivec3 _e211 = cell_2;
                        if (((_e207.z < 0) || (_e211.z >= 10))) {
                            {
                                Intersection _e216 = none;
                                return _e216;
                            }
                        }
                    }
                }
            }
            int _e217 = i;
            i = (_e217 + 1);
        }
    }
    Intersection _e220 = none;
    return _e220;
}

Ray cameraRay(vec2 fragCoord) {
    vec2 fragCoord_1 = vec2(0.0);
    float aspect = 0.0;
    float x_1 = 0.0;
    float y_1 = 0.0;
    fragCoord_1 = fragCoord;
    vec3 _e5 = _group_0_binding_0_fs.iResolution;
    vec3 _e7 = _group_0_binding_0_fs.iResolution;
    aspect = (_e5.x / _e7.y);
    vec2 _e11 = fragCoord_1;
    vec3 _e13 = _group_0_binding_0_fs.iResolution;
    x_1 = (((_e11.x / _e13.x) * 2.0) - 1.0);
    vec2 _e21 = fragCoord_1;
    vec3 _e23 = _group_0_binding_0_fs.iResolution;
    float _e30 = aspect;
    y_1 = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x_1;
    float _e36 = y_1;
    return Ray(vec3(0.0), normalize(vec3(_e35, _e36, SCREEN_DEPTH)));
}

void mainImage(inout vec4 fragColor, vec2 fragCoord_2) {
    vec2 fragCoord_3 = vec2(0.0);
    Ray ray_4 = Ray(vec3(0.0), vec3(0.0));
    vec3 color = vec3(0.7, 0.8, 0.9);
    Intersection hit = Intersection(0.0, ivec3(0));
    Sphere sphere_2 = Sphere(vec3(0.0), 0.0);
    vec3 albedo = vec3(0.0);
    vec3 point = vec3(0.0);
    vec3 normal = vec3(0.0);
    vec3 sum = AMBIENT;
    float cosine = 0.0;
    vec3 origin = vec3(0.0);
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    vec2 _e8 = fragCoord_3;
    Ray _e9 = cameraRay(_e8);
    ray_4 = _e9;
    Ray _e16 = ray_4;
    Intersection _e17 = hitScene(_e16);
    hit = _e17;
    Intersection _e19 = hit;
    if ((_e19.t < NO_HIT)) {
        {
            Intersection _e22 = hit;
            Sphere _e24 = sphereIn(_e22.cell);
            sphere_2 = _e24;
            vec3 _e26 = nextColor();
            albedo = _e26;
            Ray _e28 = ray_4;
            Intersection _e30 = hit;
            Ray _e32 = ray_4;
            point = (_e28.origin + (_e30.t * _e32.direction));
            vec3 _e37 = point;
            Sphere _e38 = sphere_2;
            normal = normalize((_e37 - _e38.center));
            vec3 _e44 = normal;
            vec3 _e45 = point;
            cosine = dot(_e44, normalize((LIGHT - _e45)));
            float _e50 = cosine;
            if ((_e50 > 0.0)) {
                {
                    vec3 _e53 = point;
                    vec3 _e55 = normal;
                    origin = (_e53 + (0.001 * _e55));
                    vec3 _e59 = origin;
                    vec3 _e60 = origin;
                    Intersection _e64 = hitScene(Ray(_e59, normalize((LIGHT - _e60))));
                    if ((_e64.t == NO_HIT)) {
                        {
                            vec3 _e67 = sum;
                            float _e70 = cosine;
                            sum = (_e67 + (vec3(0.85) * _e70));
                        }
                    }
                }
            }
            vec3 _e73 = albedo;
            vec3 _e74 = sum;
            color = (_e73 * _e74);
        }
    }
    vec3 _e76 = color;
    fragColor = vec4(_e76.x, _e76.y, _e76.z, 1.0);
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

