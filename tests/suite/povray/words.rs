//! Writes a scene in POV-Ray's scene language, as far as both models agree.

use std::fmt::Write as _;

use glam::DVec3;
use toyproof::scene::{
    Background, Camera, Color, Cuboid, Fresnel, Integrator, Light, Material, Model, Object, PatternKind,
    Point, Projection, Quadric, QuadricKind, Scene, Shape, Space,
};

/// Writes the scene for one sample in the center of each pixel, without tone map and gamma.
///
/// # Panics
/// If POV-Ray 3.7 cannot express something in the scene.
pub(super) fn words(scene: &Scene) -> String {
    assert!(scene.film.integrator == Integrator::Whitted && scene.figures.is_empty());
    let mut text = format!(
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 max_trace_level {} adc_bailout 0 }}\n{}{}",
        scene.film.max_depth,
        camera(scene),
        background(&scene.background)
    );
    for light in &scene.lights {
        text += &self::light(light);
    }
    for one in &scene.objects {
        text += &object(one, scene);
    }
    text
}

fn vector([x, y, z]: [f64; 3]) -> String {
    format!("<{x:?}, {y:?}, {z:?}>")
}

fn camera(scene: &Scene) -> String {
    let [width, height] = scene.film.size.map(f64::from);
    let eye = vector(scene.camera.eye);
    let across = |half_width: f64| {
        format!(
            "right {} up {}",
            vector([2.0 * half_width, 0.0, 0.0]),
            vector([0.0, 2.0 * half_width * height / width, 0.0])
        )
    };
    let look_at = look_at(&scene.camera);
    match scene.camera.projection {
        Projection::Pinhole { screen_distance } => format!(
            "camera {{ location {eye} direction {} {} {look_at}}}\n",
            vector([0.0, 0.0, -screen_distance]),
            across(1.0)
        ),
        Projection::Parallel { width } => format!(
            "camera {{ orthographic location {eye} direction {} {} {look_at}}}\n",
            vector([0.0, 0.0, -1.0]),
            across(0.5 * width)
        ),
    }
}

/// Turns the camera with POV-Ray's own keywords, if the scene's is turned.
fn look_at(camera: &Camera) -> String {
    if camera.axes().is_none() {
        return String::new();
    }
    let ahead = [0, 1, 2].map(|axis| camera.eye[axis] + camera.forward()[axis]);
    let target = camera.look_at.unwrap_or(ahead);
    let way = [0, 1, 2].map(|axis| target[axis] - camera.eye[axis]);
    let [up, way, target] = [camera.up, way, target].map(vector);
    format!(
        "sky vaxis_rotate({up}, {way}, {:?}) look_at {target} ",
        camera.roll
    )
}

fn background(background: &Background) -> String {
    match *background {
        Background::Uniform(color) => format!("background {{ rgb {} }}\n", vector(color)),
        // The gradient's value is y of the unit direction, mapped from −1 … 1 to 0 … 1.
        Background::Gradient { bottom, top } => format!(
            "sky_sphere {{ pigment {{ gradient y color_map {{ [0 rgb {}] [1 rgb {}] }} scale 2 translate -y }} }}\n",
            vector(bottom),
            vector(top)
        ),
    }
}

fn light(light: &Light) -> String {
    assert!(light.radius == 0.0 && light.motion.is_none());
    let shadow = if light.shadow { "" } else { "shadowless " };
    let [position, color] = [light.position, light.color].map(vector);
    format!("light_source {{ {position} rgb {color} {shadow}}}\n")
}

/// A surface; for glass, an invisible opaque duplicate casts a shadow as black as ours.
fn object(object: &Object, scene: &Scene) -> String {
    let Object {
        shape,
        material,
        motion,
    } = object;
    assert!(motion.is_none());
    let with = |look: &str| shape_with(shape, look);
    match material.model {
        Model::Glass { ior, fresnel } => {
            assert!(fresnel == Fresnel::Exact && material.color == [1.0; 3]);
            let glass = format!(
                "pigment {{ rgbf 1 }} finish {{ ambient 0 diffuse 0 reflection {{ 0, 1 fresnel on }} conserve_energy }} \
                 interior {{ ior {ior:?} }} no_shadow"
            );
            with(&glass) + &with("pigment { rgb 0 } no_image no_reflection")
        }
        // As if lit only from the eye.
        Model::Facing => {
            assert!(scene.film.max_depth == 1);
            let (eye, forward) = (scene.camera.eye, scene.camera.forward());
            let parallel = match scene.camera.projection {
                Projection::Pinhole { .. } => String::new(),
                Projection::Parallel { .. } => {
                    let ahead = [0, 1, 2].map(|axis| eye[axis] + forward[axis]);
                    format!("parallel point_at {} ", vector(ahead))
                }
            };
            let eye = vector(eye);
            let surface = matte(object, [0.0; 3], 1.0);
            format!(
                "light_group {{ light_source {{ {eye} rgb 1 {parallel}shadowless }}\n{surface}global_lights off }}\n"
            )
        }
        Model::Lambert => matte(object, scene.ambient, 1.0),
        Model::Diffuse => matte(object, scene.ambient, std::f64::consts::FRAC_1_PI),
        Model::Mirror => {
            let color = vector(material.color);
            with(&format!(
                "pigment {{ rgb 0 }} finish {{ ambient 0 diffuse 0 reflection {{ rgb {color} }} }}"
            ))
        }
        model => panic!("POV-Ray has no {model:?}"),
    }
}

/// A matte surface.
fn matte(object: &Object, ambient: Color, diffuse: f64) -> String {
    let ambient = vector(ambient);
    let look = |across: Option<usize>| {
        let pigment = pigment(object, across);
        format!("pigment {{ {pigment} }} finish {{ ambient 0 emission rgb {ambient} diffuse {diffuse:?} }}")
    };
    match object.shape {
        Shape::Box(cuboid) if own_axes(&object.material).is_some() => {
            let sides = (0..3).flat_map(|across| [-0.5, 0.5].map(|side| (across, side)));
            let faces =
                sides.map(|(across, side)| face(&cuboid, across, side) + &look(Some(across)) + " }\n");
            faces.collect()
        }
        Shape::Plane { .. } => shape_with(&object.shape, &look(Some(1))),
        _ => shape_with(&object.shape, &look(None)),
    }
}

/// The axes of a pattern in the coordinates of its surface.
fn own_axes(material: &Material) -> Option<[Point; 3]> {
    match material.pattern?.space {
        Space::World => None,
        Space::Object { axes } => Some(axes),
    }
}

/// The colors of a surface; in the coordinates of a flat one, the axis `across` it does not count. Every
/// pattern is POV-Ray's checker, which consists of cubes: along axes that do not count, they are as long as
/// the scene.
fn pigment(object: &Object, across: Option<usize>) -> String {
    let material = &object.material;
    let color = vector(material.color);
    let Some(pattern) = material.pattern else {
        return format!("rgb {color}");
    };
    let own = own_axes(material);
    let axes = own
        .unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        .map(DVec3::from_array);
    let across = if own.is_some() { across } else { None };
    let size = pattern.size;
    let (rows, sides) = match pattern.kind {
        PatternKind::Checker => {
            let ignored = if own.is_some() { across } else { Some(1) };
            (
                axes,
                [0, 1, 2].map(|axis| if ignored == Some(axis) { ENDLESS } else { size }),
            )
        }
        PatternKind::Stripes { mut direction } => {
            if let Some(across) = across {
                direction[across] = 0.0;
            }
            let direction: DVec3 = axes
                .iter()
                .zip(direction)
                .map(|(axis, along)| *axis * along)
                .sum();
            // The direction across the face: one stripe covers it.
            if direction == DVec3::ZERO {
                return format!("rgb {color}");
            }
            let (u, v) = direction.normalize().any_orthonormal_pair();
            (
                [direction.normalize(), u, v],
                [size / direction.length(), ENDLESS, ENDLESS],
            )
        }
    };
    let origin = if own.is_some() {
        object.shape.origin()
    } else {
        [0.0; 3]
    };
    let rows: Vec<String> = rows
        .iter()
        .map(DVec3::to_array)
        .chain([origin])
        .map(|v| row(&v))
        .collect();
    let moved = sides.map(|side| if side == ENDLESS { -0.5 * ENDLESS } else { 0.0 });
    let (other, rows) = (vector(pattern.color), rows.join(", "));
    let [sides, moved] = [sides, moved].map(vector);
    format!("checker rgb {color}, rgb {other} scale {sides} translate {moved} matrix <{rows}>")
}

/// The length of a cube along an axis that does not count.
const ENDLESS: f64 = 1e6;

/// The beginning of a polygon: a face of a box, at half its size along an axis.
fn face(cuboid: &Cuboid, across: usize, side: f64) -> String {
    let [u, v] = [(across + 1) % 3, (across + 2) % 3];
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]].map(|[a, b]| {
        let parts = [(across, side), (u, a), (v, b)];
        let from_center =
            parts.map(|(axis, share)| DVec3::from_array(cuboid.axes[axis]) * (share * cuboid.size[axis]));
        let corner = DVec3::from_array(cuboid.center) + from_center.into_iter().sum::<DVec3>();
        vector(corner.to_array())
    });
    format!("polygon {{ 5, {} ", corners.join(", "))
}

fn shape_with(shape: &Shape, look: &str) -> String {
    let mut text = match *shape {
        Shape::Sphere { center, radius } => format!("sphere {{ {}, {radius:?} ", vector(center)),
        Shape::Plane { point, normal } => {
            let distance: f64 = (0..3).map(|i| point[i] * normal[i]).sum();
            format!("plane {{ {}, {distance:?} ", vector(normal))
        }
        Shape::Quadric(quadric) => self::quadric(&quadric),
        Shape::Box(cuboid) => self::cuboid(&cuboid),
    };
    let _ = writeln!(text, "{look} }}");
    text
}

/// A box in its own coordinates, then turned and translated.
fn cuboid(Cuboid { center, size, axes }: &Cuboid) -> String {
    let half = size.map(|side| 0.5 * side);
    let rows: Vec<String> = axes.iter().chain([center]).map(row).collect();
    let [low, high] = [half.map(|side| -side), half].map(vector);
    format!("box {{ {low}, {high} matrix <{}> ", rows.join(", "))
}

/// A quadric in its own coordinates, then translated.
fn quadric(Quadric { kind, origin, axes }: &Quadric) -> String {
    let open = "open";
    let own = match *kind {
        QuadricKind::Ellipsoid { radii } => format!("sphere {{ 0, 1 scale {}", vector(radii)),
        QuadricKind::Cylinder { radius, height } => {
            format!("cylinder {{ 0, {height:?}*z, {radius:?} {open}")
        }
        QuadricKind::Cone { radius, height } => format!("cone {{ 0, 0, {height:?}*z, {radius:?} {open}"),
        QuadricKind::Paraboloid { radius, height } => format!(
            "quadric {{ <1, 1, 0>, 0, {}, 0 clipped_by {{ plane {{ z, {height:?} }} }}",
            vector([0.0, 0.0, -radius * radius / height])
        ),
        QuadricKind::Hyperboloid {
            waist,
            radius,
            height,
        } => {
            let half = 0.5 * height;
            format!(
                "quadric {{ {}, 0, 0, {:?} clipped_by {{ plane {{ z, {half:?} }} plane {{ -z, {half:?} }} }}",
                vector([1.0, 1.0, -(radius * radius - waist * waist) / (half * half)]),
                -waist * waist
            )
        }
    };
    let rows: Vec<String> = axes.iter().chain([origin]).map(row).collect();
    format!("{own} matrix <{}> ", rows.join(", "))
}

fn row([x, y, z]: &Point) -> String {
    format!("{x:?}, {y:?}, {z:?}")
}
