//! Mistakes that students make in the course's shaders.

use toyproof::eval::Program;
use toyproof::explain::known::Hypotheses;

use crate::exercises::EDITED;
use crate::{
    COMPLEX_SCENE, Edit, Exercise, MANY_OBJECTS, REFLECTIONS, SHADING, SPHERE, checked, edited, frame, scene,
};

/// The name of the mistake, its exercise, and the edits.
pub type Fault = (&'static str, &'static Exercise, &'static [Edit]);

const B: &str = "float b = dot(f, ray.direction);";
const TWO_B: &str = "float b = 2.0 * dot(f, ray.direction);";
const NEAR: &str = "float t = -b - root;";

/// Some mistakes cannot be seen, and so are not here:
/// - in `02-sphere` the far root (both ends of a chord meet the sphere at one angle) and a flipped y
///   (symmetry);
/// - in `05-complex-scene` all that hides behind it;
/// - in `08-disney` a missing sheen (the light comes from where the eye is);
/// - in `12-whitted` total reflection (a ray that entered a ball always finds its way out);
/// - in `06-reflections` a limit of four path segments or more (it shows in less than 0.1 % of the pixels).
static FAULTS: &[Fault] = &[
    (
        "roots without the division by 2a, as the slide prints them",
        &SPHERE,
        &[(B, TWO_B), ("b * b - c", "b * b - 4.0 * c")],
    ),
    (
        "discriminant without its 4",
        &SPHERE,
        &[
            (B, TWO_B),
            ("-b - root", "(-b - root) / 2.0"),
            ("-b + root", "(-b + root) / 2.0"),
        ],
    ),
    (
        "sign of b",
        &SPHERE,
        &[("ray.origin - sphere.center", "sphere.center - ray.origin")],
    ),
    (
        "radius not squared",
        &SPHERE,
        &[("sphere.radius * sphere.radius", "sphere.radius")],
    ),
    (
        "square root forgotten",
        &SPHERE,
        &[("float root = sqrt(disc);", "float root = disc;")],
    ),
    (
        "direction not normalised",
        &SPHERE,
        &[("normalize(vec3(x, y, SCREEN_DEPTH))", "vec3(x, y, SCREEN_DEPTH)")],
    ),
    ("aspect missing", &SPHERE, &[(" / aspect", "")]),
    ("aspect upside down", &SPHERE, &[(" / aspect", " * aspect")]),
    (
        "aspect of integers",
        &SPHERE,
        &[(
            "iResolution.x / iResolution.y;",
            "float(int(iResolution.x) / int(iResolution.y));",
        )],
    ),
    (
        "place on the screen by integer division",
        &SPHERE,
        &[(
            "fragCoord.x / iResolution.x * 2.0",
            "float(int(fragCoord.x) / int(iResolution.x)) * 2.0",
        )],
    ),
    (
        "screen behind the eye",
        &SPHERE,
        &[("DEPTH = -2.0", "DEPTH = 2.0")],
    ),
    ("screen at 1", &SPHERE, &[("DEPTH = -2.0", "DEPTH = -1.0")]),
    (
        "one pixel to the right",
        &SPHERE,
        &[(
            "fragCoord.x / iResolution.x",
            "(fragCoord.x + 1.0) / iResolution.x",
        )],
    ),
    (
        "half a pixel added to a coordinate that has it",
        &SPHERE,
        &[(
            "fragCoord.y / iResolution.y",
            "(fragCoord.y + 0.5) / iResolution.y",
        )],
    ),
    (
        "normal not normalised",
        &SPHERE,
        &[("normalize(hitPoint - sphere.center)", "hitPoint - sphere.center")],
    ),
    (
        "centre forgotten in the normal",
        &SPHERE,
        &[("normalize(hitPoint - sphere.center)", "normalize(hitPoint)")],
    ),
    (
        "max instead of the absolute value",
        &SPHERE,
        &[(
            "abs(dot(ray.direction, normal))",
            "max(dot(ray.direction, normal), 0.0)",
        )],
    ),
    (
        "sphere behind the eye",
        &SPHERE,
        &[("vec3(0.0, 0.0, -6.0)", "vec3(0.0, 0.0, 6.0)")],
    ),
    (
        "gamma that nobody asked for",
        &SPHERE,
        &[("vec4(color, 1.0)", "vec4(pow(color, vec3(1.0 / 2.2)), 1.0)")],
    ),
    (
        "red and blue swapped",
        &SPHERE,
        &[("vec4(color, 1.0)", "vec4(color.bgr, 1.0)")],
    ),
    ("far root", &SHADING, &[(NEAR, "float t = -b + root;")]),
    (
        "picture upside down",
        &SHADING,
        &[(
            "(fragCoord.y / iResolution.y * 2.0 - 1.0)",
            "(1.0 - fragCoord.y / iResolution.y * 2.0)",
        )],
    ),
    (
        "from the light to the point",
        &SHADING,
        &[("lights[i].position - point", "point - lights[i].position")],
    ),
    (
        "light's position taken for a direction",
        &SHADING,
        &[("lights[i].position - point", "lights[i].position")],
    ),
    (
        "direction to the light not normalised",
        &SHADING,
        &[(
            "normalize(lights[i].position - point)",
            "lights[i].position - point",
        )],
    ),
    (
        "max missing",
        &SHADING,
        &[("max(dot(normal, toLight), 0.0)", "dot(normal, toLight)")],
    ),
    (
        "absolute value instead of max",
        &SHADING,
        &[("max(dot(normal, toLight), 0.0)", "abs(dot(normal, toLight))")],
    ),
    (
        "normal inward",
        &SHADING,
        &[("(hitPoint - sphere.center) / ", "(sphere.center - hitPoint) / ")],
    ),
    (
        "normal not divided by the radius",
        &SHADING,
        &[(
            "(hitPoint - sphere.center) / sphere.radius",
            "hitPoint - sphere.center",
        )],
    ),
    (
        "ambient twice",
        &SHADING,
        &[("sum = AMBIENT", "sum = 2.0 * AMBIENT")],
    ),
    (
        "ambient missing",
        &SHADING,
        &[("sum = AMBIENT", "sum = vec3(0.0)")],
    ),
    (
        "ambient with every light",
        &SHADING,
        &[("sum += lights", "sum += AMBIENT + lights")],
    ),
    (
        "ambient not times the colour",
        &SHADING,
        &[
            ("sum = AMBIENT", "sum = vec3(0.0)"),
            ("return color * sum", "return AMBIENT + color * sum"),
        ],
    ),
    (
        "light's colour ignored",
        &SHADING,
        &[("lights[i].color * max(", "vec3(1.0) * max(")],
    ),
    ("only one light", &SHADING, &[("i < 2", "i < 1")]),
    (
        "the last light replaces the first",
        &SHADING,
        &[("sum += lights", "sum = AMBIENT + lights")],
    ),
    (
        "the first light twice",
        &SHADING,
        &[
            ("lights[i].color", "lights[0].color"),
            ("lights[i].position", "lights[0].position"),
        ],
    ),
    (
        "falloff that the scene has not",
        &SHADING,
        &[(
            "max(dot(normal, toLight), 0.0)",
            "max(dot(normal, toLight), 0.0) * 50.0 / dot(lights[i].position - point, lights[i].position - point)",
        )],
    ),
    (
        "black background",
        &SHADING,
        &[("vec3 color = vec3(0.02, 0.02, 0.05)", "vec3 color = vec3(0.0)")],
    ),
    (
        "shadows skipped",
        &MANY_OBJECTS,
        &[("if (!inShadow(hit.point, hit.normal)) {", "{")],
    ),
    (
        "shadow rays from below the surface",
        &MANY_OBJECTS,
        &[("point + 0.001 * normal", "point - 0.001 * normal")],
    ),
    (
        "shadow rays away from the light",
        &MANY_OBJECTS,
        &[("light.position - origin", "origin - light.position")],
    ),
    (
        "shadow rays that end short of the light",
        &MANY_OBJECTS,
        &[(") < distance)", ") < 1.0)")],
    ),
    (
        "no ambient in the shadow",
        &MANY_OBJECTS,
        &[(
            "sum += light.color * cosine;\n        }",
            "sum += light.color * cosine;\n        } else { sum = vec3(0.0); }",
        )],
    ),
    (
        "first hit instead of the nearest",
        &MANY_OBJECTS,
        &[("if (t < hit.t) {", "if (t < NO_HIT && hit.sphere < 0) {")],
    ),
    (
        "farthest hit instead of the nearest",
        &MANY_OBJECTS,
        &[(
            "if (t < hit.t) {",
            "if (t < NO_HIT && (hit.sphere < 0 || t > hit.t)) {",
        )],
    ),
    (
        "normal of the first sphere",
        &MANY_OBJECTS,
        &[(
            "(hit.point - spheres[i].center) / spheres[i].radius",
            "normalize(hit.point - spheres[0].center)",
        )],
    ),
    (
        "colour of the next sphere",
        &MANY_OBJECTS,
        &[(
            "spheres[hit.sphere].color",
            "spheres[(hit.sphere + 1) % SPHERES].color",
        )],
    ),
    (
        "one visible sphere too few",
        &MANY_OBJECTS,
        &[(
            "hit.sphere = -1;\n    for (int i = 0; i < SPHERES; i++)",
            "hit.sphere = -1;\n    for (int i = 0; i < SPHERES - 2; i++)",
        )],
    ),
    (
        "the last hit instead of the nearest",
        &MANY_OBJECTS,
        &[("if (t < hit.t)", "if (t < NO_HIT)")],
    ),
    (
        "shadow rays that see beyond the light",
        &MANY_OBJECTS,
        &[("< distance)", "< NO_HIT)")],
    ),
    (
        "the last hit instead of the nearest",
        &REFLECTIONS,
        &[("if (t < nearest)", "if (t < NO_HIT)")],
    ),
    (
        "no jitter",
        &MANY_OBJECTS,
        &[
            ("fragCoord.x + random() - 0.5", "fragCoord.x"),
            ("fragCoord.y + random() - 0.5", "fragCoord.y"),
        ],
    ),
    (
        "jitter not centred",
        &MANY_OBJECTS,
        &[
            ("fragCoord.x + random() - 0.5", "fragCoord.x + random()"),
            ("fragCoord.y + random() - 0.5", "fragCoord.y + random()"),
        ],
    ),
    (
        "y drawn before x",
        &MANY_OBJECTS,
        &[
            (
                "float x = fragCoord.x + random() - 0.5;",
                "float y = fragCoord.y + random() - 0.5;",
            ),
            (
                "        float y = fragCoord.y + random() - 0.5;\n        color",
                "        float x = fragCoord.x + random() - 0.5;\n        color",
            ),
        ],
    ),
    (
        "samples not averaged",
        &MANY_OBJECTS,
        &[("color / float(SAMPLES)", "color")],
    ),
    (
        "only the last sample",
        &MANY_OBJECTS,
        &[
            ("color += trace", "color = trace"),
            ("color / float(SAMPLES)", "color"),
        ],
    ),
    (
        "one sample too few",
        &MANY_OBJECTS,
        &[("i < SAMPLES", "i < SAMPLES - 1")],
    ),
    (
        "children as large as their parent",
        &COMPLEX_SCENE,
        &[("parent.radius / SHRINK", "parent.radius")],
    ),
    (
        "children half sunk in their parent",
        &COMPLEX_SCENE,
        &[("(parent.radius + radius) * turn", "parent.radius * turn")],
    ),
    (
        "grandchildren on the parent",
        &COMPLEX_SCENE,
        &[("childOf(child, j, frame)", "childOf(parent, j, frame)")],
    ),
    (
        "one child too few",
        &COMPLEX_SCENE,
        &[("int i = 0; i < 6", "int i = 1; i < 6")],
    ),
    (
        "one grandchild too few",
        &COMPLEX_SCENE,
        &[("int j = 0; j < 6", "int j = 1; j < 6")],
    ),
    (
        "only one side of each axis",
        &COMPLEX_SCENE,
        &[("i % 2 == 0 ? axis : -axis", "axis")],
    ),
    (
        "colours not averaged",
        &COMPLEX_SCENE,
        &[("0.5 * (parent.color + sideColor(i))", "sideColor(i)")],
    ),
    (
        "nearest sphere not kept",
        &COMPLEX_SCENE,
        &[("        hit.sphere = sphere;\n", "")],
    ),
    (
        "nearest distance not kept",
        &COMPLEX_SCENE,
        &[("if (t < hit.t)", "if (t < NO_HIT)")],
    ),
    (
        "turned a quarter too far",
        &COMPLEX_SCENE,
        &[
            ("float(frame) / 240.0", "float(frame + 60) / 240.0"),
            ("0.5 + 0.4 * side(i)", "0.5 + 0.4 * abs(side(i))"),
        ],
    ),
    (
        "turned in the next frame",
        &COMPLEX_SCENE,
        &[("hitScene(ray, iFrame)", "hitScene(ray, iFrame + 1)")],
    ),
    (
        "turned sine and cosine",
        &COMPLEX_SCENE,
        &[
            ("c = cos(angle)", "c = sin(angle)"),
            ("s = sin(angle)", "s = cos(angle)"),
        ],
    ),
    (
        "light from below",
        &COMPLEX_SCENE,
        &[("vec3(4.0, 5.0, 2.0)", "vec3(4.0, -5.0, 2.0)")],
    ),
    (
        "ambient replaced where there is light",
        &COMPLEX_SCENE,
        &[
            ("AMBIENT + vec3(0.85) *", "max(AMBIENT, vec3(0.85) *"),
            ("toLight), 0.0));", "toLight), 0.0)));"),
        ],
    ),
    (
        "reflection without its factor 2",
        &REFLECTIONS,
        &[(
            "reflect(ray.direction, normal)",
            "ray.direction - dot(ray.direction, normal) * normal",
        )],
    ),
    (
        "reflection with a 2 too many",
        &REFLECTIONS,
        &[(
            "reflect(ray.direction, normal)",
            "ray.direction - 4.0 * dot(ray.direction, normal) * normal",
        )],
    ),
    (
        "reflection of the opposite direction",
        &REFLECTIONS,
        &[(
            "reflect(ray.direction, normal)",
            "reflect(-ray.direction, normal)",
        )],
    ),
    (
        "normal not normalised in the reflection",
        &REFLECTIONS,
        &[(
            "normalize(point - spheres[hit].center)",
            "point - spheres[hit].center",
        )],
    ),
    (
        "the ray goes through",
        &REFLECTIONS,
        &[("reflect(ray.direction, normal)", "ray.direction")],
    ),
    (
        "throughput added",
        &REFLECTIONS,
        &[("throughput *= ", "throughput += ")],
    ),
    (
        "throughput replaced",
        &REFLECTIONS,
        &[("throughput *= ", "throughput = ")],
    ),
    (
        "throughput forgotten",
        &REFLECTIONS,
        &[("color = throughput * sky", "color = sky")],
    ),
    ("only two bounces", &REFLECTIONS, &[("DEPTH = 100", "DEPTH = 3")]),
    (
        "sky after one bounce, whatever is met",
        &REFLECTIONS,
        &[
            ("DEPTH = 100", "DEPTH = 2"),
            (
                "    fragColor",
                "    if (color == vec3(0.0)) { color = throughput * sky(ray.direction); }\n    fragColor",
            ),
        ],
    ),
    (
        "nearest not reset at each bounce",
        &REFLECTIONS,
        &[
            ("        float nearest = NO_HIT;\n", ""),
            (
                "    vec3 throughput",
                "    float nearest = NO_HIT;\n    vec3 throughput",
            ),
        ],
    ),
    (
        "reflected rays from the eye",
        &REFLECTIONS,
        &[("ray = Ray(point,", "ray = Ray(ray.origin,")],
    ),
    (
        "sky along x",
        &REFLECTIONS,
        &[("1.0 + direction.y", "1.0 + direction.x")],
    ),
    (
        "sky upside down",
        &REFLECTIONS,
        &[("1.0 + direction.y", "1.0 - direction.y")],
    ),
    (
        "sky by y alone",
        &REFLECTIONS,
        &[("0.5 * (1.0 + direction.y)", "direction.y")],
    ),
    (
        "sky of the camera's ray",
        &REFLECTIONS,
        &[
            (
                "    vec3 throughput",
                "    vec3 first = ray.direction;\n    vec3 throughput",
            ),
            ("sky(ray.direction)", "sky(first)"),
        ],
    ),
    (
        "first hit instead of the nearest",
        &REFLECTIONS,
        &[("if (t < nearest) {", "if (t < NO_HIT && hit < 0) {")],
    ),
    (
        "all mirrors of one colour",
        &REFLECTIONS,
        &[("throughput *= spheres[hit].color", "throughput *= 0.9")],
    ),
    (
        "colour of the first sphere",
        &REFLECTIONS,
        &[(
            "throughput *= spheres[hit].color",
            "throughput *= spheres[0].color",
        )],
    ),
];

/// All faults: those above and those of the later exercises.
pub fn faults() -> impl Iterator<Item = Fault> {
    let later = EDITED.iter().flat_map(|edited| {
        let of_exercise = |&(name, edits)| (name, edited.exercise, edits);
        edited.faults.iter().map(of_exercise)
    });
    FAULTS.iter().copied().chain(later)
}

/// The known mistakes of an exercise's scene.
pub fn hypotheses(exercise: &Exercise) -> Hypotheses {
    Hypotheses::new(&scene(exercise), &frame(exercise, exercise.size)).expect("the scene renders quickly")
}

/// The name of the mistake that explains a shader's image for an exercise's scene, or an empty name; at most
/// `pairs` pairs of mistakes are tried.
pub fn name(exercise: &Exercise, hypotheses: &Hypotheses, shader: &str, pairs: usize) -> String {
    let program = Program::new(&checked(shader)).expect("it is small");
    let diagnosis = hypotheses.recognize(&program, &frame(exercise, exercise.size), pairs);
    diagnosis.map_or_else(String::new, |diagnosis| diagnosis.id())
}

/// The faults of an exercise, each with its reported name, in the format of `tests/suite/fault_names.txt`.
pub fn named_faults(exercise: &Exercise) -> Vec<String> {
    let hypotheses = hypotheses(exercise);
    let own = faults().filter(|fault| std::ptr::eq(fault.1, exercise));
    let faults = own.map(|(title, _, edits)| {
        let name = name(exercise, &hypotheses, &edited(exercise, edits), 0);
        let name = if name.is_empty() { "-" } else { &name };
        format!("{}: {title}: {name}", exercise.name)
    });
    faults.collect()
}
