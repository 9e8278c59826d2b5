//! Measures the smallest error that is found: an exercise's shader stays as it is, and its scene is
//! perturbed.

use toyproof::eval::{Number, Program, RandomRounding, Seed, Settings};
use toyproof::image::{Frame, Image};
use toyproof::scene::{FrameTime, Point, Projection, Scene, Shape};
use toyproof::tracer::{ColorRange, EpsilonFamily, EpsilonSet, RayEpsilons, Tracer};
use toyproof::verify::compare::{
    Band, CheckSummary, EXACT_TOLERANCE, EpsilonColors, EpsilonSearch, PERTURBATIONS, Reference, Undefined,
    accept_epsilons, algorithm,
};
use toyproof::verify::{CheckEvidence, Checks, Verdict, decide};
use toyproof_testkit::{EXERCISES, Exercise, checked, frame, scene};

/// The size of the course's images.
const SIZE: [u32; 2] = [640, 360];

/// A quantity that a student may get slightly wrong. `sphere` is the object that it belongs to.
struct Quantity {
    name: &'static str,
    /// Multiplies it by 1 + `error`; displacements change by a share of the distance from the eye. None if
    /// the scene has no such quantity.
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

/// The eye is the origin of the course's coordinates.
fn length(v: Point) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

fn rendered<N: Number>(program: &Program, frame: &Frame, settings: Settings<N>) -> Image {
    program.render_rows(frame, frame.rows(), &settings).unwrap().image
}

/// The spheres, sorted by apparent size, the largest first.
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

/// A tracer of a scene.
struct Traced {
    tracer: Tracer<f64>,
    families: Vec<EpsilonFamily>,
}

impl Reference for Traced {
    fn tolerance(&self) -> f64 {
        EXACT_TOLERANCE
    }
    fn accept_epsilons(&self, band: &mut Band, mixed: &mut EpsilonSearch) {
        accept_epsilons(band, self, mixed);
    }
    /// The exercises take no derivatives.
    fn is_across_edge(&self, _: u32, _: u32) -> bool {
        false
    }
    /// No edge of an exercise passes through the center of a pixel.
    fn tied(&self, wanted: &[bool]) -> Vec<bool> {
        vec![false; wanted.len()]
    }
}

impl EpsilonColors for Traced {
    fn color_range(&self, x: u32, y: u32, styles: EpsilonSet) -> ColorRange {
        self.tracer.color_range(x, y, styles)
    }
    fn families(&self) -> &[EpsilonFamily] {
        &self.families
    }
    fn pixel_with_epsilons(&self, x: u32, y: u32, styles: &RayEpsilons) -> [f64; 3] {
        self.tracer.pixel_with_epsilons([x, y], styles)
    }
    fn samples(&self) -> u32 {
        self.tracer.samples()
    }
}

/// A shader in f64, whose image is the same for all scenes that it is compared with.
struct Subject {
    scene: Scene,
    frame_time: FrameTime,
    exact: Image,
    perturbed: Vec<Image>,
}

impl Subject {
    fn new(exercise: &Exercise) -> Self {
        let program = Program::new(&checked(exercise.shader)).unwrap();
        let frame = frame(exercise, SIZE);
        let mut scene = scene(exercise);
        scene.film.size = SIZE;
        let perturbed = (0..PERTURBATIONS).map(|seed| {
            rendered::<RandomRounding>(
                &program,
                &frame,
                Settings {
                    noise: Seed::double(seed),
                    ..Settings::default()
                },
            )
        });
        Self {
            scene,
            frame_time: FrameTime {
                frame: exercise.frame,
                time: f64::from(exercise.time),
            },
            exact: rendered::<f64>(&program, &frame, Settings::default()),
            perturbed: perturbed.collect(),
        }
    }

    /// Returns whether the shader would be `wrong` if this were its scene.
    fn is_wrong(&self, scene: &Scene) -> bool {
        let tracer = Tracer::<f64>::at(scene, self.frame_time);
        let expected = tracer.render(|| ());
        let standings = algorithm(
            &expected,
            &self.exact,
            &Undefined {
                pixels: &vec![false; self.exact.pixels().len()],
                substituted: Some(&[]),
                in_reference: &[],
            },
            &Traced {
                families: tracer.epsilon_families(),
                tracer,
            },
            &mut EpsilonSearch::new(self.exact.pixels().len() as u64),
            |seed, _| self.perturbed.get(seed as usize).cloned(),
        );
        let answer = CheckSummary::new(&expected, &self.exact, &standings);
        let checks = Checks {
            algorithm: Some(answer),
            ..Checks::default()
        };
        let ruling = decide(CheckEvidence {
            checks,
            ..CheckEvidence::default()
        });
        ruling.verdict == Verdict::Wrong
    }

    /// The smallest relative error that is found, by bisection, to a tenth of it; infinity if not even 100 %
    /// is found. None if the scene has no such quantity.
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

/// Prints the table of `docs/evidence/accuracy.md`.
pub(super) fn print_table() {
    let names: Vec<_> = QUANTITIES.iter().map(|quantity| quantity.name).collect();
    println!("| | {} |", names.join(" | "));
    println!("|---{}|", "|---".repeat(names.len()));
    for exercise in EXERCISES {
        let mut subject = Subject::new(exercise);
        assert!(!subject.is_wrong(&subject.scene), "{}", exercise.name);
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
            println!("| {}, {word} sphere | {} |", exercise.name, cells.join(" | "));
        }
    }
}
