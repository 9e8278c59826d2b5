#version 300 es
// glsl/03-shading.glsl, converted by toyproof 0.1.0 (naga 30.0.1).


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
struct FragmentOutput {
    vec4 toyproof_color;
};
const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1000000.0;
const vec3 AMBIENT = vec3(0.1, 0.1, 0.15);

vec4 toyproof_color = vec4(0.0);

layout(std140) uniform ToyproofFrame_block_0Fragment { ToyproofFrame _group_0_binding_0_fs; };

Light lights[2] = Light[2](Light(vec3(0.0), vec3(0.0)), Light(vec3(0.0), vec3(0.0)));

vec4 gen_gl_FragCoord_1 = vec4(0.0);

layout(location = 0) out vec4 _fs2p_location0;

void makeScene() {
    lights[0] = Light(vec3(5.0, 5.0, 0.0), vec3(0.8, 0.8, 0.7));
    lights[1] = Light(vec3(-6.0, 1.0, -2.0), vec3(0.1, 0.1, 0.3));
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

vec3 shade(vec3 point, vec3 normal, vec3 color) {
    vec3 point_1 = vec3(0.0);
    vec3 normal_1 = vec3(0.0);
    vec3 color_1 = vec3(0.0);
    vec3 sum = AMBIENT;
    int i = 0;
    vec3 toLight = vec3(0.0);
    point_1 = point;
    normal_1 = normal;
    color_1 = color;
    while(true) {
        int _e11 = i;
        if (!((_e11 < 2))) {
            break;
        }
        {
            int _e15 = i;
            Light _e17 = lights[_e15];
            vec3 _e19 = point_1;
            toLight = normalize((_e17.position - _e19));
            vec3 _e23 = sum;
            int _e24 = i;
            Light _e26 = lights[_e24];
            vec3 _e28 = normal_1;
            vec3 _e29 = toLight;
            sum = (_e23 + (_e26.color * max(dot(_e28, _e29), 0.0)));
            int _e35 = i;
            i = (_e35 + 1);
        }
    }
    vec3 _e38 = color_1;
    vec3 _e39 = sum;
    return (_e38 * _e39);
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
    Sphere sphere_2 = Sphere(vec3(0.0, 0.0, -6.0), 1.5, vec3(0.9, 0.6, 0.2));
    Ray ray_2 = Ray(vec3(0.0), vec3(0.0));
    vec3 color_2 = vec3(0.02, 0.02, 0.05);
    float t_1 = 0.0;
    vec3 hitPoint = vec3(0.0);
    vec3 normal_2 = vec3(0.0);
    fragCoord_3 = fragCoord_2;
    fragColor = vec4(0.0);
    makeScene();
    vec2 _e17 = fragCoord_3;
    Ray _e18 = cameraRay(_e17);
    ray_2 = _e18;
    Ray _e25 = ray_2;
    Sphere _e26 = sphere_2;
    float _e27 = intersectSphere(_e25, _e26);
    t_1 = _e27;
    float _e29 = t_1;
    if ((_e29 < NO_HIT)) {
        {
            Ray _e31 = ray_2;
            float _e33 = t_1;
            Ray _e34 = ray_2;
            hitPoint = (_e31.origin + (_e33 * _e34.direction));
            vec3 _e39 = hitPoint;
            Sphere _e40 = sphere_2;
            Sphere _e43 = sphere_2;
            normal_2 = ((_e39 - _e40.center) / vec3(_e43.radius));
            vec3 _e48 = hitPoint;
            vec3 _e49 = normal_2;
            Sphere _e50 = sphere_2;
            vec3 _e52 = shade(_e48, _e49, _e50.color);
            color_2 = _e52;
        }
    }
    vec3 _e53 = color_2;
    fragColor = vec4(_e53.x, _e53.y, _e53.z, 1.0);
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

