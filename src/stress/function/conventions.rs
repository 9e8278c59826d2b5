//! Right functions in many conventions: none may be reported as mistaken.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use toyproof_diagnostic::{File, Files};
use toyproof_glsl as glsl;

use super::{RoleMap, Signature, examine, test_typical};
use crate::study::Settings;

/// A shader with these declarations.
fn shader(function: &str) -> String {
    format!(
        "struct Ray {{ vec3 origin; vec3 direction; }};
         struct Sphere {{ vec3 center; float radius; }};
         struct Hit {{ bool hit; float t; vec3 normal; }};
         {function}
         void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0.0); }}"
    )
}

/// The head of a function, then its body, in which ROOTS declares `near` and `far`, or leaves by MISS.
const CONVENTIONS: [(&str, &str, &str); 14] = [
    (
        "bool hit(vec3 p, vec3 v, vec4 ball, inout float t)",
        "p v ball.xyz ball.w return false;",
        "if (near < 0.0) { near = far; } if (near < 0.0 || near > t) { return false; }
         t = near; return true;",
    ),
    (
        "bool hit(vec3 ro, vec3 rd, vec3 ce, float ra, inout float tMax)",
        "ro rd ce ra return false;",
        "float t = near > 0.0 ? near : far; if (t <= 0.0 || t >= tMax) { return false; }
         tMax = t; return true;",
    ),
    (
        "bool hit(vec3 ro, vec3 rd, vec3 ce, float ra, out float t)",
        "ro rd ce ra t = -1.0; return false;",
        "t = near > 0.0 ? near : far; if (t > 0.0) { return true; } t = -1.0; return false;",
    ),
    (
        "vec2 hit(vec3 ro, vec3 rd, vec3 ce, float ra)",
        "ro rd ce ra return vec2(-1.0);",
        "return vec2(near, far);",
    ),
    (
        "bool hit(vec3 ro, vec3 rd, vec3 ce, float ra, out float tNear, out float tFar)",
        "ro rd ce ra return false;",
        "tNear = near; tFar = far; return far > 0.0;",
    ),
    (
        "Hit hit(Ray ray, Sphere sphere)",
        "ray.origin ray.direction sphere.center sphere.radius return Hit(false, 0.0, vec3(0.0));",
        "float t = near > 0.0 ? near : far;
         return Hit(t > 0.0, t, (ray.origin + t * ray.direction - sphere.center) / sphere.radius);",
    ),
    (
        "bool hit(Ray ray, Sphere sphere, float tMin, float tMax, out Hit result)",
        "ray.origin ray.direction sphere.center sphere.radius return false;",
        "float t = near; if (t < tMin || t > tMax) { t = far; } if (t < tMin || t > tMax) { return false; }
         result = Hit(true, t, vec3(0.0)); return true;",
    ),
    (
        "int hit(vec3 ro, vec3 rd, vec4 sph, int index, inout float t)",
        "ro rd sph.xyz sph.w return -1;",
        "float d = near > 0.0 ? near : far; if (d < 0.0 || d > t) { return -1; } t = d; return 3;",
    ),
    (
        "float hit(vec3 ro, vec3 rd, vec4 sph, float tmin, float tmax)",
        "ro rd sph.xyz sph.w return tmax;",
        "if (near > tmin && near < tmax) { return near; }
         if (far > tmin && far < tmax) { return far; } return tmax;",
    ),
    (
        "float hit(Ray r, vec3 center, float radius)",
        "r.origin r.direction center radius return 1e20;",
        "float t = near > 0.0 ? near : far; return t > 0.0 ? t : 1e20;",
    ),
    (
        "void hit(vec3 ro, vec3 rd, vec3 ce, float ra, inout float t, inout vec3 n)",
        "ro rd ce ra return;",
        "float d = near > 0.0 ? near : far; if (d < 0.0 || d > t) { return; } t = d; n = ro + t * rd - ce;",
    ),
    (
        "bool hit(Ray ray, Sphere sphere, inout Hit closest)",
        "ray.origin ray.direction sphere.center sphere.radius return false;",
        "float t = near > 0.0 ? near : far; if (t < 0.0 || t >= closest.t) { return false; }
         closest = Hit(true, t, vec3(0.0)); return true;",
    ),
    (
        "float hit(in vec3 origin, in vec3 dir, in Sphere s)",
        "origin dir s.center s.radius return -1.0;",
        "if (near > 0.0) { return near; } if (far > 0.0) { return far; } return -1.0;",
    ),
    (
        "bool hit(Sphere s, Ray r, inout float tmax, inout int id)",
        "r.origin r.direction s.center s.radius return false;",
        "float t = near > 0.0 ? near : far; if (t <= 0.0 || t >= tmax) { return false; }
         tmax = t; id = 1; return true;",
    ),
];

/// A function whose second string is its origin, direction, center and radius, then what a miss does.
fn function((head, parts, body): (&str, &str, &str)) -> String {
    let mut parts = parts.splitn(5, ' ');
    let mut part = || parts.next().unwrap();
    let (o, d, c, r, miss) = (part(), part(), part(), part(), part());
    format!(
        "{head} {{
            vec3 f = {o} - {c};
            float a = dot({d}, {d}), b = dot(f, {d}), k = dot(f, f) - {r} * {r};
            float disc = b * b - a * k;
            if (disc < 0.0) {{ {miss} }}
            float root = sqrt(disc), near = (-b - root) / a, far = (-b + root) / a;
            {body}
        }}"
    )
}

#[test]
fn right_functions_of_any_convention_are_right() {
    let options = glsl::Options::default();
    let settings = Settings { seed: 1, cases: 20 };
    for convention in CONVENTIONS {
        let text = shader(&function(convention));
        let mut files = Files::default();
        let file = files.add(File::new("t", &*text));
        let checked =
            glsl::check(&files, file, &options).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
        let signature = Signature::recognize(&checked, "hit", &RoleMap::new());
        let signature = signature.unwrap_or_else(|why| panic!("{why}: {}", convention.0));
        let never = AtomicBool::new(false);
        let found = examine(&text, &signature, &options, None, settings, &never, || ()).unwrap();
        assert_eq!(found.mistake, None, "{}", convention.0);
        let typical = test_typical(&text, &signature, &options, Duration::from_mins(1)).unwrap();
        assert_eq!(
            (typical.right, typical.mistake),
            (typical.cases, None),
            "{}",
            convention.0
        );
    }
}
