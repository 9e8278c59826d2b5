//! The function `trace`: mirrors and glass, or path tracing.

use super::image::AROUND;
use super::parts::{GLASS, Kind, Parts, REFLECTIVE, is_emitter};
use super::slot::Slot;
use crate::Object;

/// A mirrored ray, offset from its surface.
const MIRRORED: &str = "Ray(«ReflectedOrigin: hit.point + «ReflectionOffset: 0.001» * side», \
     «ReflectedDirection: reflect(ray.direction, hit.normal)»)";

/// Mirrors tint what they reflect.
const TINTED: &str = "«MirrorStatement: throughput *= hit.color;»";

const PRIMARY_RAY: &str = "«PrimaryRay: Ray ray = Ray(origin, direction);»";

const BACKGROUND: &str = "background(«BackgroundDirection: ray.direction»)";

/// The normal on the side of the ray's origin.
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
        let [facing, emitter, is_lit] = &cases;
        let mirror = format!("{TINTED}\n{SIDE}\nray = {MIRRORED};");
        let cases: [(&[Kind], String); 4] = [
            (&[Kind::Facing], facing.clone()),
            (&[Kind::Emitter], emitter.clone()),
            (&REFLECTIVE, is_lit.clone()),
            (&[Kind::Mirror], mirror),
        ];
        let mut background = BACKGROUND.to_owned();
        if mirrors {
            background = format!("«BackgroundThroughMirrors: throughput * {background}»");
        }
        let mut body = format!(
            "{indent}Intersection hit = nearestHit(ray);\n{indent}if (hit.t == NO_HIT) {{\n{indent}    \
             return {background};\n{indent}}}\n{}",
            self.cases(indent, &cases)
        );
        if mirrors {
            body = format!(
                "    vec3 throughput = vec3(1.0);\n    for (int depth = 0; «MirrorDepth: depth < MAX_DEPTH»; depth++) {{\n{body}    }}\n    \
                 return «ColorAfterLastMirror: vec3(0.0)»;\n"
            );
        }
        vec![format!(
            "vec3 trace(vec3 origin, vec3 direction) {{\n    {PRIMARY_RAY}\n{body}}}\n"
        )]
    }

    /// Returns the code for the ends of paths: surfaces that show their color, emitters, and lit surfaces.
    fn ends(&self, end: impl Fn(&str) -> String) -> [String; 3] {
        [
            end("hit.color * abs(dot(ray.direction, hit.normal))"),
            end("hit.color"),
            end(if self.uses_view() {
                "shade(hit, «ShadeView: -ray.direction»)"
            } else {
                "shade(hit)"
            }),
        ]
    }

    /// Returns `trace` for glass, which splits each ray in two: a stack holds the rays that remain.
    fn branching(&self) -> Vec<String> {
        let [facing, emitter, is_lit] =
            self.ends(|color| format!("color += branch.throughput * {color};\ncontinue;"));
        let stop_at_depth = "if (branch.depth == MAX_DEPTH) {\n    continue;\n}";
        let mirror = "stack[top++] = Branch(mirrored, throughput, branch.depth + 1);\ncontinue;";
        let share = match GLASS.map(|kind| self.uses(kind)) {
            [true, true] => {
                "hit.model == SCHLICK ? schlick(eta, cosine, beyond) : fresnel(eta, cosine, beyond)"
            }
            [true, false] => "fresnel(eta, cosine, beyond)",
            _ => "schlick(eta, cosine, beyond)",
        };
        let glass = format!(
            "float eta = dot(ray.direction, hit.normal) < 0.0 ? «EtaEntering: 1.0 / hit.ior» : «EtaLeaving: hit.ior»;
float cosine = «GlassCosine: -dot(ray.direction, side)»;
float sine2 = eta * eta * (1.0 - cosine * cosine);
if (sine2 >= 1.0) {{
    «TotalReflection: // Total internal reflection.
    stack[top++] = Branch(mirrored, throughput, branch.depth + 1);»
    continue;
}}
float beyond = sqrt(1.0 - sine2);
float share = «ReflectedShare: {share}»;
vec3 refracted = «Refracted: eta * ray.direction + (eta * cosine - beyond) * side»;
stack[top++] = Branch(Ray(«RefractedOrigin: hit.point - «RefractionOffset: 0.001» * side», refracted), \
«RefractedThroughput: throughput * (1.0 - share)», branch.depth + 1);
stack[top++] = Branch(mirrored, «ReflectedThroughput: throughput * share», branch.depth + 1);"
        );
        let sent = self.cases("", &[(&[Kind::Mirror], mirror.to_owned()), (&GLASS, glass)]);
        let split = format!(
            "{stop_at_depth}\nvec3 throughput = branch.throughput * «GlassColor: hit.color»;\n{SIDE}\nRay mirrored = {MIRRORED};\n{sent}"
        );
        let both: Vec<Kind> = GLASS.into_iter().chain([Kind::Mirror]).collect();
        let cases: [(&[Kind], String); 4] = [
            (&[Kind::Facing], facing),
            (&[Kind::Emitter], emitter),
            (&REFLECTIVE, is_lit),
            (&both, split),
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
            "{BRANCHING_TRACE}{}    }}\n    return color;\n}}\n",
            self.cases("        ", &cases)
        ));
        pieces
    }
}

const FRESNEL: &str = "// The reflectance by Fresnel's equations; eta is the ratio of this side's and the other side's index of refraction.
float fresnel(float eta, float cosine, float beyond) {
    float across = (eta * cosine - beyond) / (eta * cosine + beyond);
    float along = (cosine - eta * beyond) / (cosine + eta * beyond);
    return «Fresnel: 0.5 * (across * across + along * along)»;
}
";

const SCHLICK: &str =
    "// Schlick's approximation of the reflectance; the cosine is that on the side of the smaller index.
float schlick(float eta, float cosine, float beyond) {
    float f0 = (1.0 - eta) * (1.0 - eta) / ((1.0 + eta) * (1.0 + eta));
    float m = 1.0 - (eta < 1.0 ? cosine : beyond);
    return f0 + (1.0 - f0) * m * m * m * m * m;
}
";

const BRANCH: &str = "// A ray on the stack; its throughput is its contribution to the pixel.
struct Branch {
    Ray ray;
    vec3 throughput;
    int depth;
};
";

const BRANCHING_TRACE: &str = "vec3 trace(vec3 origin, vec3 direction) {
    Branch stack[MAX_DEPTH + 1];
    stack[0] = Branch(Ray(origin, direction), vec3(1.0), 1);
    int top = 1;
    vec3 color = vec3(0.0);
    while (top > 0) {
        Branch branch = stack[--top];
        Ray ray = branch.ray;
        Intersection hit = nearestHit(ray);
        if (hit.t == NO_HIT) {
            color += branch.throughput * background(«BackgroundDirection: ray.direction»);
            continue;
        }
";

// Path tracing with multiple importance sampling: a direction sampled to an emitter, and one sampled from the
// BRDF.

impl Parts<'_> {
    pub(super) fn path(&self) -> Vec<String> {
        let mut pieces = Vec::new();
        if self.reflects() {
            pieces.push(AROUND.to_owned());
            pieces.extend(self.brdf());
            pieces.extend(self.brdf_sampling());
        }
        if self.uses(Kind::Emitter) {
            pieces.push(LIGHT_DENSITY.to_owned());
        }
        if self.uses(Kind::Emitter) && self.reflects() {
            let brdf = self.path_brdf(Slot::EmitterDiffuseBrdf, "direction", "view");
            let has_pattern =
                |(_, _, object): &(_, _, &Object)| is_emitter(object) && object.material.pattern.is_some();
            let emitter = "spheres[emitter]";
            let (point, color) = if self.spheres.iter().any(has_pattern) {
                (LIT_FROM, self.patterns.color(emitter, "from", "normal"))
            } else {
                ("", format!("{emitter}.color"))
            };
            let sample_light = SAMPLE_LIGHT
                .replace("LIT_FROM\n", point)
                .replace("EMITTED", &color)
                .replace("BRDF", &brdf);
            pieces.push(sample_light);
        }
        let emitter = "float share = 1.0;
if (density > 0.0) {
    share = «EmitterShare: weight(density, lightDensity(ray.origin, spheres[hit.sphere]))»;
}
return color + throughput * hit.color * share;";
        let mirror = format!("{TINTED}\n{SIDE}\ndensity = 0.0;\nray = {MIRRORED};\ncontinue;");
        let sampled = if self.uses(Kind::Emitter) {
            "«EmitterStatement: color += throughput * «EmitterSample: sampleLight(hit, -ray.direction)»;»\n"
        } else {
            ""
        };
        let brdf = self.path_brdf(Slot::PathDiffuseBrdf, "next", "-ray.direction");
        let reflective = format!(
            "// A path through another surface would be longer than MAX_DEPTH segments.
if («PathIsAtEnd: depth == MAX_DEPTH») {{
    return color;
}}
{sampled}vec3 next = sampleBrdf(hit, -ray.direction);
float cosine = dot(hit.normal, next);
if (cosine <= 0.0) {{
    return color;
}}
density = brdfDensity(hit, next, -ray.direction);
«PathStatement: throughput *= «PathFactor: «PathBrdf: {brdf}» * cosine / density»;»
ray = Ray(«SampledOrigin: hit.point + «SampledOffset: 0.001» * hit.normal», next);"
        );
        let cases: [(&[Kind], String); 3] = [
            (&[Kind::Emitter], emitter.to_owned()),
            (&[Kind::Mirror], mirror),
            (&REFLECTIVE, reflective),
        ];
        pieces.push(format!(
            "{PATH_TRACE}{}    }}\n    return color;\n}}\n",
            self.cases("        ", &cases)
        ));
        pieces
    }

    /// Returns the call of the BRDF, with a name if it is the expression of diffuse surfaces.
    fn path_brdf(&self, diffuse: Slot, light: &str, view: &str) -> String {
        let brdf = self.brdf_call(light, view);
        match self.brdf_slot() {
            Some(Slot::DiffuseBrdf) => diffuse.mark(&brdf),
            _ => brdf,
        }
    }

    /// Returns the functions that sample a BRDF's directions, and their density.
    fn brdf_sampling(&self) -> Vec<String> {
        let cosine = [Kind::Lambert, Kind::Diffuse, Kind::Disney];
        let sampled_directions: [(&[Kind], String); 2] = [
            (
                &[Kind::Glossy],
                "return around(«LobeAxis: reflect(-view, hit.normal)», pow(1.0 - u, «LobeExponent: 1.0 / (hit.exponent + 1.0)»), v);"
                    .to_owned(),
            ),
            (&cosine, "return around(hit.normal, «DiffuseCosine: sqrt(1.0 - u)», v);".to_owned()),
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
                "return «DiffuseDensity: max(dot(hit.normal, light), 0.0) / PI»;".to_owned(),
            ),
        ];
        vec![
            format!(
                "vec3 sampleBrdf(Intersection hit, vec3 view) {{\n    float u = random();\n    float v = random();\n{}}}\n",
                self.cases("    ", &sampled_directions)
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

const LIGHT_DENSITY: &str = "// 1 - cos of the half angle of the cone that an emitter subtends.
float coneDepth(vec3 point, Sphere emitter) {
    vec3 toCenter = emitter.center - point;
    float sine2 = emitter.radius * emitter.radius / dot(toCenter, toCenter);
    return sine2 < 1.0 ? sine2 / (1.0 + sqrt(1.0 - sine2)) : 2.0;
}

// The probability density, per solid angle, of sampling a direction toward this emitter.
float lightDensity(vec3 point, Sphere emitter) {
    return 1.0 / «ConeSolidAngle: (2.0 * PI * coneDepth(point, emitter) * float(EMITTERS))»;
}

// The power heuristic.
float weight(float density, float other) {
    float ratio = other / density;
    return 1.0 / (1.0 + ratio * ratio);
}
";

/// The point of an emitter with a pattern from which the light comes.
const LIT_FROM: &str = "    float t = intersectSphere(Ray(hit.point, direction), spheres[emitter]);
    vec3 from = hit.point + t * direction;
    vec3 normal = normalize(from - spheres[emitter].center);
";

const SAMPLE_LIGHT: &str = "bool inShadow(Ray ray, int emitter) {
    return nearestHit(ray).t < intersectSphere(ray, spheres[emitter]);
}

// The light from one randomly chosen emitter.
vec3 sampleLight(Intersection hit, vec3 view) {
    int emitter = «EmitterChoice: min(int(random() * float(EMITTERS)), EMITTERS - 1)»;
    float u = random();
    float v = random();
    float cosTheta = 1.0 - u * coneDepth(hit.point, spheres[emitter]);
    vec3 direction = around(normalize(spheres[emitter].center - hit.point), cosTheta, v);
    float cosine = dot(hit.normal, direction);
    if («EmitterHidden: cosine <= 0.0 || inShadow(Ray(hit.point + «ShadowOffset: 0.001» * hit.normal, direction), emitter)») {
        return vec3(0.0);
    }
LIT_FROM
    float density = lightDensity(hit.point, spheres[emitter]);
    float other = brdfDensity(hit, direction, view);
    return «WeightedEmitter: «UnweightedEmitter: EMITTED * BRDF * cosine» * weight(density, other)» / density;
}
";

const PATH_TRACE: &str = "vec3 trace(vec3 origin, vec3 direction) {
    «PrimaryRay: Ray ray = Ray(origin, direction);»
    vec3 color = vec3(0.0);
    vec3 throughput = vec3(1.0);
    // The probability density of the ray's direction; 0 for camera rays and mirror reflections.
    float density = 0.0;
    for (int depth = 1; «PathDepth: depth <= MAX_DEPTH»; depth++) {
        Intersection hit = nearestHit(ray);
        if (hit.t == NO_HIT) {
            return color + throughput * background(«BackgroundDirection: ray.direction»);
        }
";
