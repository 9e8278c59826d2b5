//! Writes a scene in POV-Ray's scene language, as far as both models agree.

use std::fmt::Write as _;

use toyproof::scene::{
    Background, Color, Fresnel, Integrator, Light, Material, Model, Object, Point, Projection, Quadric,
    QuadricKind, Scene, Shape,
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
    match scene.camera.projection {
        Projection::Pinhole { screen_distance } => format!(
            "camera {{ location {eye} direction {} {} }}\n",
            vector([0.0, 0.0, -screen_distance]),
            across(1.0)
        ),
        Projection::Parallel { width } => format!(
            "camera {{ orthographic location {eye} direction {} {} }}\n",
            vector([0.0, 0.0, -1.0]),
            across(0.5 * width)
        ),
    }
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
            let eye = scene.camera.eye;
            let parallel = match scene.camera.projection {
                Projection::Pinhole { .. } => String::new(),
                Projection::Parallel { .. } => {
                    format!("parallel point_at {} ", vector([eye[0], eye[1], eye[2] - 1.0]))
                }
            };
            let eye = vector(eye);
            let surface = with(&finish(material, [0.0; 3], 1.0));
            format!(
                "light_group {{ light_source {{ {eye} rgb 1 {parallel}shadowless }}\n{surface}global_lights off }}\n"
            )
        }
        Model::Lambert => with(&finish(material, scene.ambient, 1.0)),
        Model::Diffuse => with(&finish(material, scene.ambient, std::f64::consts::FRAC_1_PI)),
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
fn finish(material: &Material, ambient: Color, diffuse: f64) -> String {
    let color = vector(material.color);
    let pigment = material.checker.map_or(format!("rgb {color}"), |checker| {
        // POV-Ray's checker consists of cubes: here as high as the scene.
        let (side, other) = (checker.size, vector(checker.color));
        format!(
            "checker rgb {color}, rgb {other} scale {} translate -5e5*y",
            vector([side, 1e6, side])
        )
    });
    let ambient = vector(ambient);
    format!("pigment {{ {pigment} }} finish {{ ambient 0 emission rgb {ambient} diffuse {diffuse:?} }}")
}

fn shape_with(shape: &Shape, look: &str) -> String {
    let mut text = match *shape {
        Shape::Sphere { center, radius } => format!("sphere {{ {}, {radius:?} ", vector(center)),
        Shape::Plane { point, normal } => {
            let distance: f64 = (0..3).map(|i| point[i] * normal[i]).sum();
            format!("plane {{ {}, {distance:?} ", vector(normal))
        }
        Shape::Quadric(quadric) => self::quadric(&quadric),
    };
    let _ = writeln!(text, "{look} }}");
    text
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
