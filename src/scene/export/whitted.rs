//! What is seen along a ray, by way of mirrors and glass.

use super::material::{GLASS, Kind, REFLECTIVE};
use super::parts::Parts;

/// A mirrored ray, off its surface.
const MIRRORED: &str = "Ray(hit.point + 0.001 * side, reflect(ray.direction, hit.normal))";
const SIDE: &str = "vec3 side = faceforward(hit.normal, ray.direction, hit.normal);";

impl Parts<'_> {
    pub(super) fn whitted(&self) -> Vec<String> {
        if self.uses_any(&GLASS) {
            return self.branching();
        }
        let mirrors = self.uses(Kind::Mirror);
        let (throughput, indent) = if mirrors {
            ("throughput * ", "        ")
        } else {
            ("", "    ")
        };
        let cases = self.ends(|color| format!("return {throughput}{color};"));
        let [facing, emitter, lit] = &cases;
        let mirror = format!("throughput *= hit.color;\n{SIDE}\nray = {MIRRORED};");
        let cases: [(&[Kind], String); 4] = [
            (&[Kind::Facing], facing.clone()),
            (&[Kind::Emitter], emitter.clone()),
            (&REFLECTIVE, lit.clone()),
            (&[Kind::Mirror], mirror),
        ];
        let mut body = format!(
            "{indent}Intersection hit = nearestHit(ray);\n{indent}if (hit.t == NO_HIT) {{\n{indent}    \
             return {throughput}background(ray.direction);\n{indent}}}\n{}",
            self.cases(indent, &cases)
        );
        if mirrors {
            body = format!(
                "    vec3 throughput = vec3(1.0);\n    for (int depth = 0; depth < MAX_DEPTH; depth++) {{\n{body}    }}\n    \
                 return vec3(0.0);\n"
            );
        }
        vec![format!(
            "vec3 trace(vec3 origin, vec3 direction) {{\n    Ray ray = Ray(origin, direction);\n{body}}}\n"
        )]
    }

    /// Where a path ends: at what only shows its colour, at what shines, and at what is lit.
    fn ends(&self, end: impl Fn(&str) -> String) -> [String; 3] {
        [
            end("hit.color * abs(dot(ray.direction, hit.normal))"),
            end("hit.color"),
            end(if self.looks_back() {
                "shade(hit, -ray.direction)"
            } else {
                "shade(hit)"
            }),
        ]
    }

    /// Glass parts each ray in two: a stack holds those that are still to be followed.
    fn branching(&self) -> Vec<String> {
        let [facing, emitter, lit] =
            self.ends(|color| format!("color += branch.throughput * {color};\ncontinue;"));
        let go_on = "if (branch.depth == MAX_DEPTH) {\n    continue;\n}";
        let mirror = "stack[top++] = Branch(mirrored, throughput, branch.depth + 1);\ncontinue;";
        let share = match GLASS.map(|kind| self.uses(kind)) {
            [true, true] => {
                "hit.model == SCHLICK ? schlick(eta, cosine, beyond) : fresnel(eta, cosine, beyond)"
            }
            [true, false] => "fresnel(eta, cosine, beyond)",
            _ => "schlick(eta, cosine, beyond)",
        };
        let glass = format!(
            "float eta = dot(ray.direction, hit.normal) < 0.0 ? 1.0 / hit.ior : hit.ior;
float cosine = -dot(ray.direction, side);
float sine2 = eta * eta * (1.0 - cosine * cosine);
if (sine2 >= 1.0) {{
    // Total reflection.
    stack[top++] = Branch(mirrored, throughput, branch.depth + 1);
    continue;
}}
float beyond = sqrt(1.0 - sine2);
float share = {share};
vec3 refracted = eta * ray.direction + (eta * cosine - beyond) * side;
stack[top++] = Branch(Ray(hit.point - 0.001 * side, refracted), throughput * (1.0 - share), branch.depth + 1);
stack[top++] = Branch(mirrored, throughput * share, branch.depth + 1);"
        );
        let sent = self.cases("", &[(&[Kind::Mirror], mirror.to_owned()), (&GLASS, glass)]);
        let parted = format!(
            "{go_on}\nvec3 throughput = branch.throughput * hit.color;\n{SIDE}\nRay mirrored = {MIRRORED};\n{sent}"
        );
        let both: Vec<Kind> = GLASS.into_iter().chain([Kind::Mirror]).collect();
        let cases: [(&[Kind], String); 4] = [
            (&[Kind::Facing], facing),
            (&[Kind::Emitter], emitter),
            (&REFLECTIVE, lit),
            (&both, parted),
        ];
        let mut pieces = Vec::new();
        if self.uses(Kind::Glass) {
            pieces.push(FRESNEL.to_owned());
        }
        if self.uses(Kind::Schlick) {
            pieces.push(SCHLICK.to_owned());
        }
        pieces.push(BRANCH.to_owned());
        pieces.push(format!(
            "{TRACE}{}    }}\n    return color;\n}}\n",
            self.cases("        ", &cases)
        ));
        pieces
    }
}

const FRESNEL: &str = "// The share of light that is reflected, by Fresnel's equations; eta is the index on this side over that beyond.
float fresnel(float eta, float cosine, float beyond) {
    float across = (eta * cosine - beyond) / (eta * cosine + beyond);
    float along = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5 * (across * across + along * along);
}
";

const SCHLICK: &str =
    "// The share of light that is reflected, by Schlick's formula with the cosine on the thinner side.
float schlick(float eta, float cosine, float beyond) {
    float f0 = (1.0 - eta) * (1.0 - eta) / ((1.0 + eta) * (1.0 + eta));
    float m = 1.0 - (eta < 1.0 ? cosine : beyond);
    return f0 + (1.0 - f0) * m * m * m * m * m;
}
";

const BRANCH: &str = "// A ray to be followed: what it adds to the picture is multiplied by its throughput.
struct Branch {
    Ray ray;
    vec3 throughput;
    int depth;
};
";

const TRACE: &str = "vec3 trace(vec3 origin, vec3 direction) {
    Branch stack[MAX_DEPTH + 1];
    stack[0] = Branch(Ray(origin, direction), vec3(1.0), 1);
    int top = 1;
    vec3 color = vec3(0.0);
    while (top > 0) {
        Branch branch = stack[--top];
        Ray ray = branch.ray;
        Intersection hit = nearestHit(ray);
        if (hit.t == NO_HIT) {
            color += branch.throughput * background(ray.direction);
            continue;
        }
";
