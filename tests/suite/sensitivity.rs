//! How small an error may be and is still found: a rung's shader stays as it is, and its scene is falsified.

use toyproof::eval::{Jittered, Number, Program, Seed, Settings};
use toyproof::image::{Frame, Image};
use toyproof::scene::{Moment, Point, Projection, Scene, Shape};
use toyproof::tracer::{Hull, RayStyles, StyleFamily, Styles, Tracer};
use toyproof::verify::compare::{Answer, Answers, Mixed, Reference, SHAKES, Verdict, judge, maths};

use crate::support::{RUNGS, Rung, checked, frame, scene};

/// The size that the course is seen in.
const SIZE: [u32; 2] = [640, 360];

/// Something that a student may get wrong by a little. `sphere` is the object that it is about.
struct Quantity {
    name: &'static str,
    /// Multiplies it by 1 + `error`; lengths that move something, by a share of its distance from the eye. None where the scene has no
    /// such thing.
    falsify: fn(scene: &mut Scene, sphere: usize, error: f64) -> Option<()>,
}

const QUANTITIES: &[Quantity] = &[
    Quantity {
        name: "radius",
        falsify: |scene, sphere, error| {
            *ball(scene, sphere)?.1 *= 1.0 + error;
            Some(())
        },
    },
    Quantity {
        name: "centre, x",
        falsify: |scene, sphere, error| {
            let center = ball(scene, sphere)?.0;
            center[0] += error * length(*center);
            Some(())
        },
    },
    Quantity {
        name: "centre, z",
        falsify: |scene, sphere, error| {
            let center = ball(scene, sphere)?.0;
            center[2] += error * length(*center);
            Some(())
        },
    },
    Quantity {
        name: "albedo",
        falsify: |scene, sphere, error| {
            let color = &mut scene.objects[sphere].material.color;
            *color = color.map(|c| c * (1.0 + error));
            Some(())
        },
    },
    Quantity {
        name: "light, x",
        falsify: |scene, _, error| {
            let position = &mut scene.lights.first_mut()?.position;
            position[0] += error * length(*position);
            Some(())
        },
    },
    Quantity {
        name: "light's colour",
        falsify: |scene, _, error| {
            let color = &mut scene.lights.first_mut()?.color;
            *color = color.map(|c| c * (1.0 + error));
            Some(())
        },
    },
    Quantity {
        name: "screen distance",
        falsify: |scene, _, error| {
            let Projection::Pinhole { screen_distance } = &mut scene.camera.projection else {
                return None;
            };
            *screen_distance *= 1.0 + error;
            Some(())
        },
    },
    Quantity {
        name: "eye, x",
        falsify: |scene, sphere, error| {
            let distance = length(*ball(scene, sphere)?.0);
            scene.camera.eye[0] += error * distance;
            Some(())
        },
    },
];

fn ball(scene: &mut Scene, sphere: usize) -> Option<(&mut Point, &mut f64)> {
    match &mut scene.objects[sphere].shape {
        Shape::Sphere { center, radius } => Some((center, radius)),
        _ => None,
    }
}

/// The eye is where the course's coordinates begin.
fn length(v: Point) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

fn painted<N: Number>(program: &Program, frame: &Frame, settings: Settings<N>) -> Image {
    program.picture(frame, frame.rows(), &settings).unwrap().image
}

/// The spheres, the one that looks largest first.
fn by_size(scene: &mut Scene) -> Vec<usize> {
    let mut order: Vec<(usize, f64)> = (0..scene.objects.len())
        .filter_map(|index| {
            let (center, radius) = ball(scene, index)?;
            Some((index, *radius / length(*center)))
        })
        .collect();
    order.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    order.into_iter().map(|(index, _)| index).collect()
}

/// A shader in f64, whose picture is the same for all scenes that it is compared with.
/// A tracer of a scene.
struct Traced {
    tracer: Tracer<f64>,
    families: Vec<StyleFamily>,
}

impl Reference for Traced {
    fn hull(&self, x: u32, y: u32, styles: Styles) -> Hull {
        self.tracer.hull(x, y, styles)
    }
    fn families(&self) -> &[StyleFamily] {
        &self.families
    }
    fn styled(&self, x: u32, y: u32, styles: &RayStyles) -> [f64; 3] {
        self.tracer.styled([x, y], styles)
    }
    fn samples(&self) -> u32 {
        self.tracer.samples()
    }
    /// The rungs take no derivatives.
    fn is_across_edge(&self, _: u32, _: u32) -> bool {
        false
    }
    /// No edge of a rung passes through the middle of a pixel.
    fn is_tied(&self, _: u32, _: u32) -> bool {
        false
    }
}

struct Subject {
    scene: Scene,
    moment: Moment,
    exact: Image,
    shaken: Vec<Image>,
}

impl Subject {
    fn new(rung: &Rung) -> Self {
        let program = Program::new(&checked(rung.shader)).unwrap();
        let frame = frame(rung, SIZE);
        let mut scene = scene(rung);
        scene.film.size = SIZE;
        let shaken = (0..SHAKES).map(|seed| {
            painted::<Jittered>(
                &program,
                &frame,
                Settings {
                    noise: Seed(seed),
                    ..Settings::default()
                },
            )
        });
        Self {
            scene,
            moment: Moment {
                frame: rung.frame,
                time: f64::from(rung.time),
            },
            exact: painted::<f64>(&program, &frame, Settings::default()),
            shaken: shaken.collect(),
        }
    }

    /// Whether the shader would be judged `wrong` if this were its scene.
    fn is_wrong(&self, scene: &Scene) -> bool {
        let tracer = Tracer::<f64>::at(scene, self.moment);
        let expected = tracer.picture(|| ());
        let standings = maths(
            &expected,
            &self.exact,
            &vec![false; self.exact.pixels().len()],
            &Traced {
                families: tracer.style_families(),
                tracer,
            },
            &mut Mixed::of(self.exact.pixels().len() as u64),
            |seed, _| self.shaken.get(seed as usize).cloned(),
        );
        let answer = Answer::new(&expected, &self.exact, &standings);
        let (verdict, _) = judge(Answers {
            maths: Some(&answer),
            rounding: None,
            toolchain: None,
        });
        verdict == Verdict::Wrong
    }

    /// The smallest relative error that is found, by bisection, to a tenth of it; infinity if not even 100 % is. None where the scene has
    /// no such thing.
    fn smallest(&self, quantity: &Quantity, sphere: usize) -> Option<f64> {
        let found = |error: f64| {
            let mut scene = self.scene.clone();
            (quantity.falsify)(&mut scene, sphere, error)?;
            Some(self.is_wrong(&scene))
        };
        if !found(1.0)? {
            return Some(f64::INFINITY);
        }
        let (mut missed, mut caught) = (1e-7, 1.0);
        while caught / missed > 1.1 {
            let middle = f64::sqrt(missed * caught);
            if found(middle)? {
                caught = middle;
            } else {
                missed = middle;
            }
        }
        Some(caught)
    }
}

/// `cargo test --release --test suite -- --ignored smallest --nocapture` prints the table of `docs/accuracy.md`.
#[test]
#[ignore = "takes minutes"]
fn the_smallest_error_that_is_found() {
    let names: Vec<_> = QUANTITIES.iter().map(|quantity| quantity.name).collect();
    eprintln!("| | {} |", names.join(" | "));
    eprintln!("|---{}|", "|---".repeat(names.len()));
    for rung in RUNGS {
        let mut subject = Subject::new(rung);
        assert!(!subject.is_wrong(&subject.scene), "{}", rung.name);
        let order = by_size(&mut subject.scene);
        let mut which = vec![("largest", order[0])];
        if order.len() > 1 {
            which.push(("middle", order[order.len() / 2]));
        }
        for (word, sphere) in which {
            let cells: Vec<_> = QUANTITIES
                .iter()
                .map(|quantity| match subject.smallest(quantity, sphere) {
                    None => "–".to_owned(),
                    Some(f64::INFINITY) => "never".to_owned(),
                    Some(error) => format!("{:.3} %", 100.0 * error),
                })
                .collect();
            eprintln!("| {}, {word} sphere | {} |", rung.name, cells.join(" | "));
        }
    }
}
