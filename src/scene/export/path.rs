//! Path tracing: light is looked for by a direction drawn to an emitter and by one drawn for the BRDF.

use super::material::{Kind, REFLECTIVE};
use super::parts::Parts;
use super::sampler::AROUND;

impl Parts<'_> {
    pub(super) fn path(&self) -> Vec<String> {
        let mut pieces = Vec::new();
        if self.reflects() {
            pieces.push(AROUND.to_owned());
            pieces.extend(self.brdf());
            pieces.extend(self.brdf_draws());
        }
        if self.uses(Kind::Emitter) {
            pieces.push(LIGHT_DENSITY.to_owned());
        }
        if self.uses(Kind::Emitter) && self.reflects() {
            let brdf = self.brdf_call("direction", "view");
            pieces.push(SAMPLE_LIGHT.replace("BRDF", &brdf));
        }
        let emitter = "float share = 1.0;
if (density > 0.0) {
    share = weight(density, lightDensity(ray.origin, spheres[hit.sphere]));
}
return color + throughput * hit.color * share;";
        let mirror = "throughput *= hit.color;
vec3 side = faceforward(hit.normal, ray.direction, hit.normal);
density = 0.0;
ray = Ray(hit.point + 0.001 * side, reflect(ray.direction, hit.normal));
continue;";
        let sampled = if self.uses(Kind::Emitter) {
            "color += throughput * sampleLight(hit, -ray.direction);\n"
        } else {
            ""
        };
        let brdf = self.brdf_call("next", "-ray.direction");
        let reflective = format!(
            "// Light that is looked for here would come by a segment too many.
if (depth == MAX_DEPTH) {{
    return color;
}}
{sampled}vec3 next = sampleBrdf(hit, -ray.direction);
float cosine = dot(hit.normal, next);
if (cosine <= 0.0) {{
    return color;
}}
density = brdfDensity(hit, next, -ray.direction);
throughput *= {brdf} * cosine / density;
ray = Ray(hit.point + 0.001 * hit.normal, next);"
        );
        let cases: [(&[Kind], String); 3] = [
            (&[Kind::Emitter], emitter.to_owned()),
            (&[Kind::Mirror], mirror.to_owned()),
            (&REFLECTIVE, reflective),
        ];
        pieces.push(format!(
            "{TRACE}{}    }}\n    return color;\n}}\n",
            self.cases("        ", &cases)
        ));
        pieces
    }

    /// How directions are drawn for a BRDF, and with which density.
    fn brdf_draws(&self) -> Vec<String> {
        let cosine = [Kind::Lambert, Kind::Diffuse, Kind::Disney];
        let drawn: [(&[Kind], String); 2] = [
            (
                &[Kind::Glossy],
                "return around(reflect(-view, hit.normal), pow(1.0 - u, 1.0 / (hit.exponent + 1.0)), v);"
                    .to_owned(),
            ),
            (&cosine, "return around(hit.normal, sqrt(1.0 - u), v);".to_owned()),
        ];
        let density: [(&[Kind], String); 2] = [
            (
                &[Kind::Glossy],
                "float lobe = pow(max(dot(reflect(-view, hit.normal), light), 0.0), hit.exponent);
return (hit.exponent + 1.0) / (2.0 * PI) * lobe;"
                    .to_owned(),
            ),
            (
                &cosine,
                "return max(dot(hit.normal, light), 0.0) / PI;".to_owned(),
            ),
        ];
        vec![
            format!(
                "vec3 sampleBrdf(Intersection hit, vec3 view) {{\n    float u = random();\n    float v = random();\n{}}}\n",
                self.cases("    ", &drawn)
            ),
            format!(
                "float brdfDensity(Intersection hit, vec3 light, vec3 view) {{\n{}}}\n",
                self.cases("    ", &density)
            ),
        ]
    }

    pub(super) fn reflects(&self) -> bool {
        self.uses_any(&REFLECTIVE)
    }
}

const LIGHT_DENSITY: &str = "// 1 - cos of the half angle of the cone in which an emitter is seen.
float coneDepth(vec3 point, Sphere emitter) {
    vec3 toCenter = emitter.center - point;
    float sine2 = emitter.radius * emitter.radius / dot(toCenter, toCenter);
    return sine2 < 1.0 ? sine2 / (1.0 + sqrt(1.0 - sine2)) : 2.0;
}

// The density, over the solid angle, with which a direction to this emitter is drawn.
float lightDensity(vec3 point, Sphere emitter) {
    return 1.0 / (2.0 * PI * coneDepth(point, emitter) * float(EMITTERS));
}

// The power heuristic.
float weight(float density, float other) {
    float ratio = other / density;
    return 1.0 / (1.0 + ratio * ratio);
}
";

const SAMPLE_LIGHT: &str = "bool inShadow(Ray ray, int emitter) {
    return nearestHit(ray).t < intersectSphere(ray, spheres[emitter]);
}

// The light of one emitter, drawn by chance.
vec3 sampleLight(Intersection hit, vec3 view) {
    int emitter = min(int(random() * float(EMITTERS)), EMITTERS - 1);
    float u = random();
    float v = random();
    float across = 1.0 - u * coneDepth(hit.point, spheres[emitter]);
    vec3 direction = around(normalize(spheres[emitter].center - hit.point), across, v);
    float cosine = dot(hit.normal, direction);
    if (cosine <= 0.0 || inShadow(Ray(hit.point + 0.001 * hit.normal, direction), emitter)) {
        return vec3(0.0);
    }
    float density = lightDensity(hit.point, spheres[emitter]);
    float other = brdfDensity(hit, direction, view);
    return spheres[emitter].color * BRDF * cosine * weight(density, other) / density;
}
";

const TRACE: &str = "vec3 trace(vec3 origin, vec3 direction) {
    Ray ray = Ray(origin, direction);
    vec3 color = vec3(0.0);
    vec3 throughput = vec3(1.0);
    // The density with which the ray was drawn; 0 from the eye and from mirrors.
    float density = 0.0;
    for (int depth = 1; depth <= MAX_DEPTH; depth++) {
        Intersection hit = nearestHit(ray);
        if (hit.t == NO_HIT) {
            return color + throughput * background(ray.direction);
        }
";
