//! The shader that paints a scene, in the course's style, holding only what the scene requires.

use std::fmt::Write;

use crate::scene::{
    Background, Color, Integrator, Light, Model, Object, Point, Projection, Requirements, Sampler, Scene,
    Shape, ToneMap,
};

/// A `ShaderToy` shader that paints the scene.
///
/// # Errors
/// What the scene uses that cannot be written yet, in the words of the scene file.
pub fn shader(scene: &Scene) -> Result<String, String> {
    let requirements = Requirements::of(scene);
    let film = &scene.film;
    if requirements.figures {
        return Err("figures".to_owned());
    }
    if requirements.motion {
        return Err("motion".to_owned());
    }
    if film.integrator == Integrator::Path {
        return Err("the integrator \"path\"".to_owned());
    }
    if requirements.soft_shadows {
        return Err("a light with a radius".to_owned());
    }
    if matches!(film.sampler, Sampler::Stratified | Sampler::Sobol) {
        return Err("the samplers \"stratified\" and \"sobol\"".to_owned());
    }
    let parts = Parts::of(scene)?;
    Ok(parts.text(scene))
}

/// What of the course's words a scene needs.
struct Parts<'a> {
    spheres: Vec<(Point, f64, &'a Object)>,
    planes: Vec<(Point, Point, &'a Object)>,
    /// The models in use, in the order in which they are first met.
    models: Vec<Model>,
}

fn word(model: &Model) -> Option<&'static str> {
    match model {
        Model::Facing => Some("FACING"),
        Model::Lambert => Some("LAMBERT"),
        Model::Diffuse => Some("DIFFUSE"),
        Model::Mirror => Some("MIRROR"),
        _ => None,
    }
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

fn vector([x, y, z]: [f64; 3]) -> String {
    format!("vec3({}, {}, {})", number(x), number(y), number(z))
}

impl<'a> Parts<'a> {
    fn of(scene: &'a Scene) -> Result<Self, String> {
        let mut parts = Self {
            spheres: Vec::new(),
            planes: Vec::new(),
            models: Vec::new(),
        };
        for object in &scene.objects {
            let model = object.material.model;
            if word(&model).is_none() {
                return Err("the models \"disney\", \"glossy\", \"glass\" and \"emitter\"".to_owned());
            }
            if object.material.checker.is_some() {
                return Err("a checker".to_owned());
            }
            if !parts.models.contains(&model) {
                parts.models.push(model);
            }
            match object.shape {
                Shape::Sphere { center, radius } => parts.spheres.push((center, radius, object)),
                Shape::Plane { point, normal } => parts.planes.push((point, normal, object)),
                Shape::Quadric(_) => return Err("quadrics".to_owned()),
            }
        }
        Ok(parts)
    }

    fn uses(&self, model: Model) -> bool {
        self.models.contains(&model)
    }

    fn lit(&self) -> bool {
        self.uses(Model::Lambert) || self.uses(Model::Diffuse)
    }

    /// Where there is one model alone, nothing says which.
    fn names_models(&self) -> bool {
        self.models.len() > 1
    }

    fn text(&self, scene: &Scene) -> String {
        let mut pieces = vec![self.constants(scene)];
        if !scene.objects.is_empty() {
            pieces.push(self.structures(scene));
        }
        if scene.film.sampler != Sampler::Center {
            pieces.push(random(scene.film.sampler).to_owned());
        }
        if !scene.objects.is_empty() {
            pieces.push(self.scene(scene));
            pieces.extend(self.intersections());
        }
        pieces.push(background(&scene.background));
        if self.lit() {
            pieces.extend(self.shading(scene));
        }
        pieces.push(self.trace());
        pieces.push(camera(scene));
        pieces.push(self.main(scene));
        pieces.join("\n")
    }

    fn constants(&self, scene: &Scene) -> String {
        let title = match scene.title.lines().next() {
            None | Some("") => "A scene",
            Some(title) => title,
        };
        let mut text = format!("// {title}\n\nconst float NO_HIT = 1.0e30;\n");
        let mut say = |line: String| text.push_str(&line);
        if scene.film.samples > 1 {
            say(format!("const int SAMPLES = {};\n", scene.film.samples));
        }
        if !self.spheres.is_empty() {
            say(format!("const int SPHERES = {};\n", self.spheres.len()));
        }
        if !self.planes.is_empty() {
            say(format!("const int PLANES = {};\n", self.planes.len()));
        }
        if self.lit() && !scene.lights.is_empty() {
            say(format!("const int LIGHTS = {};\n", scene.lights.len()));
        }
        if self.lit() {
            say(format!("const vec3 AMBIENT = {};\n", vector(scene.ambient)));
        }
        if self.uses(Model::Mirror) {
            say(format!("const int MAX_DEPTH = {};\n", scene.film.max_depth));
        }
        if self.names_models() {
            for (index, model) in self.models.iter().enumerate() {
                say(format!(
                    "const int {} = {index};\n",
                    word(model).unwrap_or_default()
                ));
            }
        }
        text
    }

    fn structures(&self, scene: &Scene) -> String {
        let model = if self.names_models() {
            "    int model;\n"
        } else {
            ""
        };
        let mut text = "struct Ray {\n    vec3 origin;\n    vec3 direction;\n};\n".to_owned();
        let _ = write!(
            text,
            "\nstruct Intersection {{\n    float t;\n    vec3 point;\n    vec3 normal;\n    vec3 color;\n{model}}};\n"
        );
        if !self.spheres.is_empty() {
            let _ = write!(
                text,
                "\nstruct Sphere {{\n    vec3 center;\n    float radius;\n    vec3 color;\n{model}}};\n\
                 \nSphere spheres[SPHERES];\n"
            );
        }
        if !self.planes.is_empty() {
            let _ = write!(
                text,
                "\nstruct Plane {{\n    vec3 point;\n    vec3 normal;\n    vec3 color;\n{model}}};\n\
                 \nPlane planes[PLANES];\n"
            );
        }
        if self.lit() && !scene.lights.is_empty() {
            let shadow = if shadows(scene) == Shadows::Some {
                "    bool shadow;\n"
            } else {
                ""
            };
            let _ = write!(
                text,
                "\nstruct Light {{\n    vec3 position;\n    vec3 color;\n{shadow}}};\n\nLight lights[LIGHTS];\n"
            );
        }
        text
    }

    fn scene(&self, scene: &Scene) -> String {
        let model = |object: &Object| match word(&object.material.model) {
            Some(word) if self.names_models() => format!(", {word}"),
            _ => String::new(),
        };
        let mut text = "void makeScene() {\n".to_owned();
        for (index, (center, radius, object)) in self.spheres.iter().enumerate() {
            let _ = writeln!(
                text,
                "    spheres[{index}] = Sphere({}, {}, {}{});",
                vector(*center),
                number(*radius),
                vector(object.material.color),
                model(object)
            );
        }
        for (index, (point, normal, object)) in self.planes.iter().enumerate() {
            let _ = writeln!(
                text,
                "    planes[{index}] = Plane({}, {}, {}{});",
                vector(*point),
                vector(*normal),
                vector(object.material.color),
                model(object)
            );
        }
        if self.lit() {
            for (index, light) in scene.lights.iter().enumerate() {
                let shadow = match shadows(scene) {
                    Shadows::Some => format!(", {}", light.shadow),
                    _ => String::new(),
                };
                let _ = writeln!(
                    text,
                    "    lights[{index}] = Light({}, {}{shadow});",
                    vector(light.position),
                    vector(light.color)
                );
            }
        }
        text + "}\n"
    }

    fn intersections(&self) -> Vec<String> {
        let mut pieces = Vec::new();
        let model = |owner: &str| {
            if self.names_models() {
                format!("            hit.model = {owner}[i].model;\n")
            } else {
                String::new()
            }
        };
        let mut loops = String::new();
        if !self.spheres.is_empty() {
            pieces.push(INTERSECT_SPHERE.to_owned());
            let _ = write!(
                loops,
                "    for (int i = 0; i < SPHERES; i++) {{\n        float t = intersectSphere(ray, spheres[i]);\n        \
                 if (t < hit.t) {{\n            hit.t = t;\n            hit.point = ray.origin + t * ray.direction;\n            \
                 hit.normal = normalize(hit.point - spheres[i].center);\n            hit.color = spheres[i].color;\n{}        }}\n    }}\n",
                model("spheres")
            );
        }
        if !self.planes.is_empty() {
            pieces.push(INTERSECT_PLANE.to_owned());
            let _ = write!(
                loops,
                "    for (int i = 0; i < PLANES; i++) {{\n        float t = intersectPlane(ray, planes[i]);\n        \
                 if (t < hit.t) {{\n            hit.t = t;\n            hit.point = ray.origin + t * ray.direction;\n            \
                 hit.normal = faceforward(planes[i].normal, ray.direction, planes[i].normal);\n            \
                 hit.color = planes[i].color;\n{}        }}\n    }}\n",
                model("planes")
            );
        }
        pieces.push(format!(
            "Intersection nearestHit(Ray ray) {{\n    Intersection hit;\n    hit.t = NO_HIT;\n{loops}    return hit;\n}}\n"
        ));
        pieces
    }

    fn shading(&self, scene: &Scene) -> Vec<String> {
        let mut pieces = Vec::new();
        if scene.lights.is_empty() {
            let text = "vec3 shade(Intersection hit) {\n    return hit.color * AMBIENT;\n}\n";
            pieces.push(text.to_owned());
            return pieces;
        }
        let visible = match shadows(scene) {
            Shadows::None => "",
            Shadows::Some => " && !(lights[i].shadow && inShadow(hit, lights[i].position))",
            Shadows::All => " && !inShadow(hit, lights[i].position)",
        };
        if shadows(scene) != Shadows::None {
            pieces.push(IN_SHADOW.to_owned());
        }
        let brdf = match (self.uses(Model::Lambert), self.uses(Model::Diffuse)) {
            (true, true) => "(hit.model == LAMBERT ? 1.0 : 1.0 / 3.14159265359) * ",
            (false, true) => "1.0 / 3.14159265359 * ",
            _ => "",
        };
        pieces.push(format!(
            "vec3 shade(Intersection hit) {{\n    vec3 sum = AMBIENT;\n    for (int i = 0; i < LIGHTS; i++) {{\n        \
             float cosine = dot(hit.normal, normalize(lights[i].position - hit.point));\n        \
             if (cosine > 0.0{visible}) {{\n            sum += {brdf}lights[i].color * cosine;\n        }}\n    }}\n    \
             return hit.color * sum;\n}}\n"
        ));
        pieces
    }

    fn trace(&self) -> String {
        if self.models.is_empty() {
            return "vec3 trace(vec3 origin, vec3 direction) {\n    return background(direction);\n}\n"
                .to_owned();
        }
        let mirrors = self.uses(Model::Mirror);
        let (throughput, indent) = if mirrors {
            ("throughput * ", "        ")
        } else {
            ("", "    ")
        };
        let mut body = format!(
            "{indent}Intersection hit = nearestHit(ray);\n{indent}if (hit.t == NO_HIT) {{\n{indent}    \
             return {throughput}background(ray.direction);\n{indent}}}\n"
        );
        let lit = format!("return {throughput}shade(hit);");
        let facing = format!("return {throughput}hit.color * abs(dot(ray.direction, hit.normal));");
        let mirror = "throughput *= hit.color;\n        vec3 side = faceforward(hit.normal, ray.direction, hit.normal);\n        \
                      ray = Ray(hit.point + 0.001 * side, reflect(ray.direction, hit.normal));";
        let mut cases: Vec<(String, &str)> = Vec::new();
        if self.uses(Model::Facing) {
            cases.push(("hit.model == FACING".to_owned(), &facing));
        }
        if self.lit() {
            let test = match (self.uses(Model::Lambert), self.uses(Model::Diffuse)) {
                (true, true) => "hit.model == LAMBERT || hit.model == DIFFUSE",
                (true, false) => "hit.model == LAMBERT",
                _ => "hit.model == DIFFUSE",
            };
            cases.push((test.to_owned(), &lit));
        }
        // What is tested last needs no test: mirrors go on, and only they do.
        let last = if mirrors {
            Some(mirror)
        } else {
            cases.pop().map(|(_, what)| what)
        };
        for (test, what) in cases {
            let _ = write!(body, "{indent}if ({test}) {{\n{indent}    {what}\n{indent}}}\n");
        }
        if let Some(last) = last {
            let _ = writeln!(body, "{indent}{last}");
        }
        if mirrors {
            body = format!(
                "    vec3 throughput = vec3(1.0);\n    for (int depth = 0; depth < MAX_DEPTH; depth++) {{\n{body}    }}\n    \
                 return vec3(0.0);\n"
            );
        }
        format!(
            "vec3 trace(vec3 origin, vec3 direction) {{\n    Ray ray = Ray(origin, direction);\n{body}}}\n"
        )
    }

    fn main(&self, scene: &Scene) -> String {
        let film = &scene.film;
        let several = film.samples > 1;
        let (indent, index) = if several { ("        ", "i") } else { ("    ", "0") };
        let start = match film.sampler {
            Sampler::Independent => format!("{indent}startSample(fragCoord, {index});\n"),
            _ => String::new(),
        };
        let sample = if film.sampler == Sampler::Center {
            format!("{indent}color += look(fragCoord);\n")
        } else {
            format!(
                "{start}{indent}float x = fragCoord.x + random() - 0.5;\n{indent}float y = fragCoord.y + random() - 0.5;\n\
                 {indent}color += look(vec2(x, y));\n"
            )
        };
        let samples = if several {
            format!(
                "    for (int i = 0; i < SAMPLES; i++) {{\n{sample}    }}\n    color /= float(SAMPLES);\n"
            )
        } else {
            sample
        };
        let scene_made = if self.models.is_empty() {
            ""
        } else {
            "    makeScene();\n"
        };
        let seed = match film.sampler {
            Sampler::SineHash => "    seed = 0.0;\n",
            _ => "",
        };
        format!(
            "void mainImage(out vec4 fragColor, in vec2 fragCoord) {{\n{scene_made}{seed}    vec3 color = vec3(0.0);\n\
             {samples}{}    fragColor = vec4(color, 1.0);\n}}\n",
            develop(scene)
        )
    }
}

/// Which lights cast shadows.
#[derive(PartialEq)]
enum Shadows {
    None,
    Some,
    All,
}

fn shadows(scene: &Scene) -> Shadows {
    let casts = |light: &Light| light.shadow;
    match (scene.lights.iter().any(casts), scene.lights.iter().all(casts)) {
        (false, _) => Shadows::None,
        (true, false) => Shadows::Some,
        (true, true) => Shadows::All,
    }
}

fn background(background: &Background) -> String {
    let body = match *background {
        Background::Uniform(color) => format!("    return {};\n", vector(color)),
        Background::Gradient { bottom, top } => gradient(bottom, top),
    };
    format!("vec3 background(vec3 direction) {{\n{body}}}\n")
}

fn gradient(bottom: Color, top: Color) -> String {
    format!(
        "    return mix({}, {}, 0.5 * (1.0 + direction.y));\n",
        vector(bottom),
        vector(top)
    )
}

/// What is seen at a place of the picture.
fn camera(scene: &Scene) -> String {
    let eye = vector(scene.camera.eye);
    let ray = match scene.camera.projection {
        Projection::Pinhole { screen_distance } => {
            format!(
                "trace({eye}, normalize(vec3(x, y, {})))",
                number(-screen_distance)
            )
        }
        Projection::Parallel { width } => format!(
            "trace({eye} + {} * vec3(x, y, 0.0), vec3(0.0, 0.0, -1.0))",
            number(0.5 * width)
        ),
    };
    format!(
        "vec3 look(vec2 fragCoord) {{\n    float aspect = iResolution.x / iResolution.y;\n    \
         float x = fragCoord.x / iResolution.x * 2.0 - 1.0;\n    \
         float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;\n    return {ray};\n}}\n"
    )
}

fn develop(scene: &Scene) -> String {
    let mut text = String::new();
    if scene.film.tone_map == ToneMap::Reinhard {
        text.push_str("    color = color / (color + 1.0);\n");
    }
    if scene.film.gamma != 1.0 {
        let _ = writeln!(
            text,
            "    color = pow(color, vec3(1.0 / {}));",
            number(scene.film.gamma)
        );
    }
    text
}

fn random(sampler: Sampler) -> &'static str {
    if sampler == Sampler::SineHash {
        SINE_HASH
    } else {
        INDEPENDENT
    }
}

const SINE_HASH: &str = "float seed;

float random() {
    return fract(sin(seed++) * 43758.5453123);
}
";

const INDEPENDENT: &str = "uint state;

// The integer hash pcg (Jarzynski and Olano 2020).
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

void startSample(vec2 fragCoord, int i) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
}
";

const INTERSECT_SPHERE: &str =
    "// From the point of the ray that is closest to the centre: smaller numbers, smaller errors.
float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    vec3 closest = f - b * ray.direction;
    float disc = sphere.radius * sphere.radius - dot(closest, closest);
    if (disc > 0.0) {
        float root = sqrt(disc);
        float t = -b - root;
        if (t > 0.00001) {
            return t;
        }
        t = -b + root;
        if (t > 0.00001) {
            return t;
        }
    }
    return NO_HIT;
}
";

const INTERSECT_PLANE: &str = "float intersectPlane(Ray ray, Plane plane) {
    float t = dot(plane.normal, plane.point - ray.origin) / dot(plane.normal, ray.direction);
    return t > 0.00001 ? t : NO_HIT;
}
";

const IN_SHADOW: &str = "bool inShadow(Intersection hit, vec3 light) {
    vec3 origin = hit.point + 0.001 * hit.normal;
    vec3 toLight = light - origin;
    float distance = length(toLight);
    return nearestHit(Ray(origin, toLight / distance)).t < distance;
}
";
