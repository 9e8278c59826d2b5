#version 300 es
// glsl/10-quadrics.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
struct Quadric {
    vec3 origin;
    vec3 axis;
    vec3 q;
    float g;
    float k;
    float low;
    float high;
    vec3 color;
};
struct Intersection {
    float t;
    vec3 normal;
    vec3 color;
};
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const int QUADRICS = 5;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(4.0, 6.0, 2.0);
const vec3 LIGHT_COLOR = vec3(0.85);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Quadric quadrics[5] = Quadric[5](Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)), Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)), Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)), Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)), Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)));

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

Quadric ellipsoid(vec3 center, vec3 radii, vec3 color) {
    vec3 center_1 = vec3(0.0);
    vec3 radii_1 = vec3(0.0);
    vec3 color_1 = vec3(0.0);
    center_1 = center;
    radii_1 = radii;
    color_1 = color;
    vec3 _e6 = center_1;
    vec3 _e12 = radii_1;
    vec3 _e13 = radii_1;
    vec3 _e19 = radii_1;
    vec3 _e22 = radii_1;
    vec3 _e24 = color_1;
    return Quadric(_e6, vec3(0.0, 0.0, 1.0), (vec3(1.0) / (_e12 * _e13)), 0.0, -1.0, -(_e19.z), _e22.z, _e24);
}

Quadric cylinder(vec3 base, vec3 axis, float radius, float height, vec3 color_2) {
    vec3 base_1 = vec3(0.0);
    vec3 axis_1 = vec3(0.0);
    float radius_1 = 0.0;
    float height_1 = 0.0;
    vec3 color_3 = vec3(0.0);
    base_1 = base;
    axis_1 = axis;
    radius_1 = radius;
    height_1 = height;
    color_3 = color_2;
    vec3 _e10 = base_1;
    vec3 _e11 = axis_1;
    float _e17 = radius_1;
    float _e19 = radius_1;
    float _e22 = height_1;
    vec3 _e23 = color_3;
    return Quadric(_e10, _e11, vec3(1.0, 1.0, 0.0), 0.0, (-(_e17) * _e19), 0.0, _e22, _e23);
}

Quadric cone(vec3 apex, vec3 axis_2, float radius_2, float height_2, vec3 color_4) {
    vec3 apex_1 = vec3(0.0);
    vec3 axis_3 = vec3(0.0);
    float radius_3 = 0.0;
    float height_3 = 0.0;
    vec3 color_5 = vec3(0.0);
    float slope = 0.0;
    apex_1 = apex;
    axis_3 = axis_2;
    radius_3 = radius_2;
    height_3 = height_2;
    color_5 = color_4;
    float _e10 = radius_3;
    float _e11 = height_3;
    slope = (_e10 / _e11);
    vec3 _e14 = apex_1;
    vec3 _e15 = axis_3;
    float _e18 = slope;
    float _e20 = slope;
    float _e26 = height_3;
    vec3 _e27 = color_5;
    return Quadric(_e14, _e15, vec3(1.0, 1.0, (-(_e18) * _e20)), 0.0, 0.0, 0.0, _e26, _e27);
}

Quadric paraboloid(vec3 apex_2, vec3 axis_4, float radius_4, float height_4, vec3 color_6) {
    vec3 apex_3 = vec3(0.0);
    vec3 axis_5 = vec3(0.0);
    float radius_5 = 0.0;
    float height_5 = 0.0;
    vec3 color_7 = vec3(0.0);
    apex_3 = apex_2;
    axis_5 = axis_4;
    radius_5 = radius_4;
    height_5 = height_4;
    color_7 = color_6;
    vec3 _e10 = apex_3;
    vec3 _e11 = axis_5;
    float _e17 = radius_5;
    float _e19 = radius_5;
    float _e21 = height_5;
    float _e25 = height_5;
    vec3 _e26 = color_7;
    return Quadric(_e10, _e11, vec3(1.0, 1.0, 0.0), (((-0.5 * _e17) * _e19) / _e21), 0.0, 0.0, _e25, _e26);
}

Quadric hyperboloid(vec3 center_2, vec3 axis_6, float waist, float radius_6, float height_6, vec3 color_8) {
    vec3 center_3 = vec3(0.0);
    vec3 axis_7 = vec3(0.0);
    float waist_1 = 0.0;
    float radius_7 = 0.0;
    float height_7 = 0.0;
    vec3 color_9 = vec3(0.0);
    float z = 0.0;
    float slope2_ = 0.0;
    center_3 = center_2;
    axis_7 = axis_6;
    waist_1 = waist;
    radius_7 = radius_6;
    height_7 = height_6;
    color_9 = color_8;
    float _e13 = height_7;
    z = (0.5 * _e13);
    float _e16 = radius_7;
    float _e17 = radius_7;
    float _e19 = waist_1;
    float _e20 = waist_1;
    float _e23 = z;
    float _e24 = z;
    slope2_ = (((_e16 * _e17) - (_e19 * _e20)) / (_e23 * _e24));
    vec3 _e28 = center_3;
    vec3 _e29 = axis_7;
    float _e32 = slope2_;
    float _e36 = waist_1;
    float _e38 = waist_1;
    float _e40 = z;
    float _e42 = z;
    vec3 _e43 = color_9;
    return Quadric(_e28, _e29, vec3(1.0, 1.0, -(_e32)), 0.0, (-(_e36) * _e38), -(_e40), _e42, _e43);
}

void makeScene() {
    Quadric _e15 = ellipsoid(vec3(-2.0, 0.5, -7.0), vec3(0.9, 0.5, 0.6), vec3(0.9, 0.3, 0.3));
    quadrics[0] = _e15;
    Quadric _e32 = cylinder(vec3(-0.9, -1.0, -5.2), vec3(0.0, 1.0, 0.0), 0.4, 0.8, vec3(0.3, 0.7, 0.9));
    quadrics[1] = _e32;
    Quadric _e49 = cone(vec3(0.3, 0.9, -6.5), vec3(0.0, -1.0, 0.0), 0.7, 1.9, vec3(0.9, 0.7, 0.2));
    quadrics[2] = _e49;
    Quadric _e66 = paraboloid(vec3(1.1, -0.9, -5.0), vec3(0.28, 0.96, 0.0), 0.5, 0.7, vec3(0.5, 0.9, 0.4));
    quadrics[3] = _e66;
    Quadric _e84 = hyperboloid(vec3(2.3, 0.0, -7.5), vec3(0.0, 1.0, 0.0), 0.4, 0.8, 2.0, vec3(0.7, 0.5, 0.9));
    quadrics[4] = _e84;
    return;
}

mat3x3 frame(vec3 axis_8) {
    vec3 axis_9 = vec3(0.0);
    vec3 local = vec3(0.0);
    vec3 x = vec3(0.0);
    axis_9 = axis_8;
    vec3 _e2 = axis_9;
    if ((abs(_e2.z) > 0.9)) {
        local = vec3(1.0, 0.0, 0.0);
    } else {
        vec3 _e11 = axis_9;
        local = normalize(cross(_e11, vec3(0.0, 0.0, 1.0)));
    }
    vec3 _e19 = local;
    x = _e19;
    vec3 _e21 = x;
    vec3 _e22 = axis_9;
    vec3 _e23 = x;
    vec3 _e24 = cross(_e22, _e23);
    vec3 _e25 = axis_9;
    return mat3x3(vec3(_e21.x, _e21.y, _e21.z), vec3(_e24.x, _e24.y, _e24.z), vec3(_e25.x, _e25.y, _e25.z));
}

float intersectQuadric(Ray ray, Quadric quadric, mat3x3 frame_1) {
    Ray ray_1 = Ray(vec3(0.0), vec3(0.0));
    Quadric quadric_1 = Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0));
    mat3x3 frame_2 = mat3x3(0.0);
    vec3 d = vec3(0.0);
    vec3 far = vec3(0.0);
    float ahead = 0.0;
    vec3 o = vec3(0.0);
    float a = 0.0;
    float b = 0.0;
    float c = 0.0;
    float disc = 0.0;
    float local_1 = 0.0;
    float q = 0.0;
    float local_2 = 0.0;
    float t0_ = 0.0;
    float local_3 = 0.0;
    float t1_ = 0.0;
    float t = 0.0;
    float z0_ = 0.0;
    float z1_ = 0.0;
    ray_1 = ray;
    quadric_1 = quadric;
    frame_2 = frame_1;
    Ray _e7 = ray_1;
    mat3x3 _e9 = frame_2;
    d = (_e7.direction * _e9);
    Ray _e12 = ray_1;
    Quadric _e14 = quadric_1;
    mat3x3 _e17 = frame_2;
    far = ((_e12.origin - _e14.origin) * _e17);
    vec3 _e20 = far;
    vec3 _e21 = d;
    ahead = -(dot(_e20, _e21));
    vec3 _e25 = far;
    float _e26 = ahead;
    vec3 _e27 = d;
    o = (_e25 + (_e26 * _e27));
    Quadric _e31 = quadric_1;
    vec3 _e33 = d;
    vec3 _e35 = d;
    a = dot((_e31.q * _e33), _e35);
    Quadric _e38 = quadric_1;
    vec3 _e40 = d;
    vec3 _e42 = o;
    Quadric _e44 = quadric_1;
    vec3 _e46 = d;
    b = (dot((_e38.q * _e40), _e42) + (_e44.g * _e46.z));
    Quadric _e51 = quadric_1;
    vec3 _e53 = o;
    vec3 _e55 = o;
    Quadric _e58 = quadric_1;
    vec3 _e61 = o;
    Quadric _e65 = quadric_1;
    c = ((dot((_e51.q * _e53), _e55) + ((2.0 * _e58.g) * _e61.z)) + _e65.k);
    float _e69 = b;
    float _e70 = b;
    float _e72 = a;
    float _e73 = c;
    disc = ((_e69 * _e70) - (_e72 * _e73));
    float _e77 = disc;
    if ((_e77 < 0.0)) {
        {
            return NO_HIT;
        }
    }
    float _e80 = b;
    if ((_e80 > 0.0)) {
        float _e83 = b;
        float _e85 = disc;
        local_1 = (-(_e83) - sqrt(_e85));
    } else {
        float _e88 = b;
        float _e90 = disc;
        local_1 = (-(_e88) + sqrt(_e90));
    }
    float _e94 = local_1;
    q = _e94;
    float _e96 = q;
    if ((_e96 == 0.0)) {
        local_2 = NO_HIT;
    } else {
        float _e99 = c;
        float _e100 = q;
        local_2 = (_e99 / _e100);
    }
    float _e103 = local_2;
    t0_ = _e103;
    float _e105 = a;
    if ((_e105 == 0.0)) {
        local_3 = NO_HIT;
    } else {
        float _e108 = q;
        float _e109 = a;
        local_3 = (_e108 / _e109);
    }
    float _e112 = local_3;
    t1_ = _e112;
    float _e114 = t0_;
    float _e115 = t1_;
    if ((_e114 > _e115)) {
        {
            float _e117 = t0_;
            t = _e117;
            float _e119 = t1_;
            t0_ = _e119;
            float _e120 = t;
            t1_ = _e120;
        }
    }
    vec3 _e121 = o;
    float _e123 = t0_;
    vec3 _e124 = d;
    z0_ = (_e121.z + (_e123 * _e124.z));
    float _e129 = ahead;
    float _e130 = t0_;
    float _e134 = z0_;
    Quadric _e135 = quadric_1;
    float _e139 = z0_;
    Quadric _e140 = quadric_1;
    if (((((_e129 + _e130) > 0.001) && (_e134 >= _e135.low)) && (_e139 <= _e140.high))) {
        {
            float _e144 = ahead;
            float _e145 = t0_;
            return (_e144 + _e145);
        }
    }
    vec3 _e147 = o;
    float _e149 = t1_;
    vec3 _e150 = d;
    z1_ = (_e147.z + (_e149 * _e150.z));
    float _e155 = ahead;
    float _e156 = t1_;
    float _e160 = z1_;
    Quadric _e161 = quadric_1;
    float _e165 = z1_;
    Quadric _e166 = quadric_1;
    if (((((_e155 + _e156) > 0.001) && (_e160 >= _e161.low)) && (_e165 <= _e166.high))) {
        {
            float _e170 = ahead;
            float _e171 = t1_;
            return (_e170 + _e171);
        }
    }
    return NO_HIT;
}

vec3 normalOf(vec3 point, Quadric quadric_2, mat3x3 frame_3) {
    vec3 point_1 = vec3(0.0);
    Quadric quadric_3 = Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0));
    mat3x3 frame_4 = mat3x3(0.0);
    vec3 p = vec3(0.0);
    point_1 = point;
    quadric_3 = quadric_2;
    frame_4 = frame_3;
    vec3 _e6 = point_1;
    Quadric _e7 = quadric_3;
    mat3x3 _e10 = frame_4;
    p = ((_e6 - _e7.origin) * _e10);
    mat3x3 _e13 = frame_4;
    Quadric _e14 = quadric_3;
    vec3 _e16 = p;
    Quadric _e20 = quadric_3;
    return normalize((_e13 * ((_e14.q * _e16) + vec3(0.0, 0.0, _e20.g))));
}

Intersection nearestHit(Ray ray_2) {
    Ray ray_3 = Ray(vec3(0.0), vec3(0.0));
    Intersection hit = Intersection(1000000.0, vec3(0.0), vec3(0.0));
    int i = 0;
    mat3x3 f = mat3x3(0.0);
    float t_1 = 0.0;
    float t_2 = 0.0;
    ray_3 = ray_2;
    while(true) {
        int _e13 = i;
        if (!((_e13 < QUADRICS))) {
            break;
        }
        {
            int _e16 = i;
            Quadric _e18 = quadrics[_e16];
            mat3x3 _e20 = frame(_e18.axis);
            f = _e20;
            Ray _e22 = ray_3;
            int _e23 = i;
            Quadric _e25 = quadrics[_e23];
            mat3x3 _e26 = f;
            float _e27 = intersectQuadric(_e22, _e25, _e26);
            t_1 = _e27;
            float _e29 = t_1;
            Intersection _e30 = hit;
            if ((_e29 < _e30.t)) {
                {
                    float _e34 = t_1;
                    hit.t = _e34;
                    Ray _e36 = ray_3;
                    float _e38 = t_1;
                    Ray _e39 = ray_3;
                    int _e43 = i;
                    Quadric _e45 = quadrics[_e43];
                    mat3x3 _e46 = f;
                    vec3 _e47 = normalOf((_e36.origin + (_e38 * _e39.direction)), _e45, _e46);
                    hit.normal = _e47;
                    int _e49 = i;
                    Quadric _e51 = quadrics[_e49];
                    hit.color = _e51.color;
                }
            }
            int _e53 = i;
            i = (_e53 + 1);
        }
    }
    Ray _e57 = ray_3;
    Ray _e61 = ray_3;
    t_2 = ((-1.0 - _e57.origin.y) / _e61.direction.y);
    float _e66 = t_2;
    float _e69 = t_2;
    Intersection _e70 = hit;
    if (((_e66 > 0.001) && (_e69 < _e70.t))) {
        {
            float _e74 = t_2;
            hit = Intersection(_e74, vec3(0.0, 1.0, 0.0), vec3(0.5));
        }
    }
    Intersection _e82 = hit;
    Ray _e84 = ray_3;
    if ((dot(_e82.normal, _e84.direction) > 0.0)) {
        {
            Intersection _e90 = hit;
            hit.normal = -(_e90.normal);
        }
    }
    Intersection _e93 = hit;
    return _e93;
}

Ray cameraRay(vec2 fragCoord) {
    vec2 fragCoord_1 = vec2(0.0);
    float aspect = 0.0;
    float x_1 = 0.0;
    float y = 0.0;
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
    y = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x_1;
    float _e36 = y;
    return Ray(vec3(0.0), normalize(vec3(_e35, _e36, SCREEN_DEPTH)));
}

void mainImage(inout vec4 fragColor, vec2 fragCoord_2) {
    vec2 fragCoord_3 = vec2(0.0);
    Ray ray_4 = Ray(vec3(0.0), vec3(0.0));
    vec3 color_10 = vec3(0.6, 0.7, 0.9);
    Intersection hit_1 = Intersection(0.0, vec3(0.0), vec3(0.0));
    vec3 point_2 = vec3(0.0);
    vec3 toLight = vec3(0.0);
    float distance_ = 0.0;
    float cosine = 0.0;
    vec3 sum = AMBIENT;
    Ray shadow = Ray(vec3(0.0), vec3(0.0));
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    makeScene();
    vec2 _e9 = fragCoord_3;
    Ray _e10 = cameraRay(_e9);
    ray_4 = _e10;
    Ray _e17 = ray_4;
    Intersection _e18 = nearestHit(_e17);
    hit_1 = _e18;
    Intersection _e20 = hit_1;
    if ((_e20.t < NO_HIT)) {
        {
            Ray _e23 = ray_4;
            Intersection _e25 = hit_1;
            Ray _e27 = ray_4;
            point_2 = (_e23.origin + (_e25.t * _e27.direction));
            vec3 _e32 = point_2;
            Intersection _e34 = hit_1;
            toLight = (LIGHT - (_e32 + (0.001 * _e34.normal)));
            vec3 _e40 = toLight;
            distance_ = length(_e40);
            Intersection _e43 = hit_1;
            vec3 _e45 = point_2;
            cosine = dot(_e43.normal, normalize((LIGHT - _e45)));
            float _e51 = cosine;
            if ((_e51 > 0.0)) {
                {
                    vec3 _e54 = point_2;
                    Intersection _e56 = hit_1;
                    vec3 _e60 = toLight;
                    float _e61 = distance_;
                    shadow = Ray((_e54 + (0.001 * _e56.normal)), (_e60 / vec3(_e61)));
                    Ray _e66 = shadow;
                    Intersection _e67 = nearestHit(_e66);
                    float _e69 = distance_;
                    if ((_e67.t > _e69)) {
                        {
                            vec3 _e71 = sum;
                            float _e72 = cosine;
                            sum = (_e71 + (LIGHT_COLOR * _e72));
                        }
                    }
                }
            }
            Intersection _e75 = hit_1;
            vec3 _e77 = sum;
            color_10 = (_e75.color * _e77);
        }
    }
    vec3 _e79 = color_10;
    fragColor = vec4(_e79.x, _e79.y, _e79.z, 1.0);
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

