//! The reference tracer beside Embree, lavapipe and POV-Ray, in turns, so that all meet the same noise; in
//! milliseconds of processor time, ours on one thread. Who is not installed is left out.
//! `cargo bench --bench tracers [-- rays povray threads features growth building]`

#![expect(clippy::disallowed_methods, reason = "the paths are the benchmark's own")]
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a benchmark's own words"
)]

mod embree;
mod scenes;
#[path = "../../tests/suite/povray/words.rs"]
mod words;

use std::fs;
use std::path::Path;
use std::process::Command;

use rustix::time::{ClockId, clock_gettime};
use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::gpu::{AdapterSelector, LocalRenderer};
use toyproof::image::Frame;
use toyproof::lab::chart::{Point, Scatter};
use toyproof::scene::{
    self, Cuboid, Fresnel, Integrator, Light, Model, Motion, Object, Pattern, PatternKind, Period, Sampler,
    Scene, Shape, Space, export,
};
use toyproof::tracer::{Real, Tracer};
use toyproof::translate::{FloatMode, lower_strict};

use self::embree::{Embree, Ray};
use self::scenes::{Random, light, material, spheres};

const ROUNDS: usize = 7;
/// The most spheres that a shader holds: beyond that, drivers take minutes to compile it.
const MOST_IN_A_SHADER: usize = 100;

/// Milliseconds that this process ran.
fn clock() -> f64 {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    now.tv_sec as f64 * 1e3 + now.tv_nsec as f64 / 1e6
}

fn time<R>(work: impl FnOnce() -> R) -> f64 {
    let start = clock();
    std::hint::black_box(work());
    clock() - start
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// The medians of several contestants, who take turns.
fn in_turns<const N: usize>(mut turn: impl FnMut() -> [f64; N]) -> [f64; N] {
    let mut times = [const { Vec::new() }; N];
    // The first round warms up.
    turn();
    for _ in 0..ROUNDS {
        for (times, taken) in times.iter_mut().zip(turn()) {
            times.push(taken);
        }
    }
    times.map(median)
}

/// Lavapipe with the shader that paints a scene.
fn renderer(scene: &Scene) -> Option<LocalRenderer> {
    let text = export::shader(scene).ok()?;
    let mut files = Files::default();
    let file = files.add(File::new("exported", text));
    let checked = check(&files, file, &Options::default()).ok()?;
    LocalRenderer::new(
        &lower_strict(&checked),
        &Frame::default(),
        FloatMode::Strict,
        &AdapterSelector::Lavapipe,
    )
    .ok()
}

/// The camera rays, as float32, and those that leave what they meet in any direction.
fn rays(scene: &Scene) -> [Vec<(Ray, Option<usize>)>; 2] {
    let tracer = Tracer::<f32>::new(scene);
    let [width, height] = scene.film.size;
    let mut random = Random(99);
    let (mut camera, mut others) = (Vec::new(), Vec::new());
    for y in 0..height {
        for x in 0..width {
            let [origin, direction] = tracer.camera_ray(x, y);
            camera.push((ray(origin, direction, 0.0), None));
            if let Some((t, surface)) = tracer.intersect(origin, direction, None) {
                let point = [0, 1, 2].map(|i| origin[i] + t * direction[i]);
                let away = loop {
                    let v = [0; 3].map(|_| random.between(-1.0, 1.0) as f32);
                    let square = v.iter().map(|c| c * c).sum::<f32>();
                    if (0.01..1.0).contains(&square) {
                        break v.map(|c| c / square.sqrt());
                    }
                };
                others.push((ray(point, away, 1e-3), Some(surface)));
            }
        }
    }
    // In no order, as many as the camera's.
    let shuffled = (0..camera.len())
        .map(|_| others[(random.number() * others.len() as f64) as usize])
        .collect();
    [camera, shuffled]
}

fn ray([ox, oy, oz]: [f32; 3], [dx, dy, dz]: [f32; 3], t_min: f32) -> Ray {
    [ox, oy, oz, dx, dy, dz, t_min]
}

fn meet_all<T: Real>(tracer: &Tracer<T>, rays: &[([T; 3], [T; 3], Option<usize>)]) -> usize {
    let met = rays
        .iter()
        .filter(|(origin, direction, from)| tracer.intersect(*origin, *direction, *from).is_some());
    met.count()
}

fn in_numbers<T: Real>(rays: &[(Ray, Option<usize>)]) -> Vec<([T; 3], [T; 3], Option<usize>)> {
    let number = |x: f32| T::from_f64(f64::from(x));
    rays.iter()
        .map(|&([ox, oy, oz, dx, dy, dz, _], from)| {
            ([ox, oy, oz].map(number), [dx, dy, dz].map(number), from)
        })
        .collect()
}

fn cell(milliseconds: f64) -> String {
    if milliseconds.is_nan() {
        "–".to_owned()
    } else {
        format!("{milliseconds:.2}")
    }
}

fn ratio(theirs: f64, ours: f64) -> String {
    if theirs.is_nan() {
        "–".to_owned()
    } else {
        format!("{:.2}", theirs / ours)
    }
}

/// The surfaces that camera rays meet, and those that shuffled ones meet.
fn beside_embree_and_lavapipe(program: Option<&Path>, counts: &[usize]) {
    println!(
        "Milliseconds at 640×360 on one thread. Primary: making the camera rays, meeting what is nearest, storing which."
    );
    println!(
        "Shuffled: as many rays from what was met in any direction. Lavapipe paints the exported shader, and so does the picture.\n"
    );
    println!(
        "| spheres | f32 | f64 | picture f32 | f64 | Embree 1 | 8 | user geometry 16 | lavapipe | Embree 8 / f32 | 16 / f32 | lavapipe / f32 | / f64 \
         | shuffled f32 | f64 | Embree 1 | f32 / Embree | other ids f32 | Embree |"
    );
    println!("|{}", "---|".repeat(19));
    for &count in counts {
        let scene = spheres(count, Model::Facing);
        let [primary, shuffled] = rays(&scene);
        let (single, double) = (Tracer::<f32>::new(&scene), Tracer::<f64>::new(&scene));
        let (shuffled32, shuffled64) = (in_numbers::<f32>(&shuffled), in_numbers::<f64>(&shuffled));
        let plain = |rays: &[(Ray, Option<usize>)]| rays.iter().map(|(ray, _)| *ray).collect::<Vec<_>>();
        let mut embree = program
            .map(|program| [&primary, &shuffled].map(|rays| Embree::new(program, &scene, &plain(rays))));
        let mut renderer = (count <= MOST_IN_A_SHADER).then(|| renderer(&scene)).flatten();
        let times = in_turns(|| {
            let theirs = embree.as_mut().map_or([f64::NAN; 4], |[primary, shuffled]| {
                let of_primary = [primary.one_by_one(), primary.by_eights(), primary.by_sixteens()];
                let [one, eight, sixteen] = of_primary;
                [one, eight, sixteen, shuffled.one_by_one()].map(|seconds| 1e3 * seconds)
            });
            let gpu = renderer.as_mut().map_or(f64::NAN, |renderer| {
                time(|| renderer.render().expect("it compiled"))
            });
            [
                time(|| single.surfaces()),
                time(|| double.surfaces()),
                time(|| single.render(|| ())),
                time(|| double.render(|| ())),
                theirs[0],
                theirs[1],
                theirs[2],
                gpu,
                time(|| meet_all(&single, &shuffled32)),
                time(|| meet_all(&double, &shuffled64)),
                theirs[3],
            ]
        });
        let [
            f32,
            f64,
            picture32,
            picture64,
            one,
            eight,
            sixteen,
            gpu,
            other32,
            other64,
            other,
        ] = times;
        let exact = double.surfaces();
        let wrong = |numbers: &[u32]| numbers.iter().zip(&exact).filter(|(a, b)| a != b).count();
        let theirs = embree.as_mut().map_or("–".to_owned(), |[primary, _]| {
            let sixteen = wrong(&primary.numbers_by_sixteens());
            format!("{}, user geometry {sixteen}", wrong(&primary.numbers()))
        });
        let numbers = [f32, f64, picture32, picture64, one, eight, sixteen, gpu]
            .map(cell)
            .join(" | ");
        let ratios = [eight, sixteen, gpu]
            .map(|time| ratio(time, f32))
            .into_iter()
            .chain([ratio(gpu, f64)])
            .collect::<Vec<_>>()
            .join(" | ");
        let others = [cell(other32), cell(other64), cell(other)].join(" | ");
        println!(
            "| {count} | {numbers} | {ratios} | {others} | {} | {} | {theirs} |",
            if other.is_nan() {
                "–".to_owned()
            } else {
                ratio(other32, other)
            },
            wrong(&single.surfaces())
        );
    }
}

fn parse(text: &str) -> Scene {
    let mut files = Files::default();
    let file = files.add(File::new("scene", text));
    scene::parse(&files, file).expect("it is valid")
}

/// Seconds of processor time that POV-Ray says it traced.
fn povray(scene: &Scene, folder: &Path) -> Option<f64> {
    let source = folder.join("scene.pov");
    fs::write(&source, words::words(scene)).ok()?;
    let output = Command::new("povray")
        .args([
            "+W640",
            "+H360",
            "-D",
            "+A0.0",
            "+AM1",
            "+R4",
            "-J",
            "+WT1",
            "File_Gamma=1",
        ])
        .arg(format!("+I{}", source.display()))
        .arg(format!("+O{}", folder.join("scene.png").display()))
        .output()
        .ok()?;
    let told = String::from_utf8_lossy(&output.stderr);
    let (_, trace) = told.split_once("Trace Time:")?;
    let (_, with) = trace.split_once(" with ")?;
    let (seconds, _) = with.split_once(" CPU-seconds")?;
    seconds.trim().parse().ok()
}

fn beside_povray(folder: &Path) {
    let mut scene = parse(include_str!("whitted.toml"));
    if povray(&scene, folder).is_none() {
        eprintln!("without POV-Ray: Debian has a package of that name");
        return;
    }
    scene.film.samples = 16;
    scene.film.sampler = Sampler::Stratified;
    let (single, double) = (Tracer::<f32>::new(&scene), Tracer::<f64>::new(&scene));
    scene.film.samples = 1;
    scene.film.sampler = Sampler::Center;
    let [f32, f64, theirs] = in_turns(|| {
        [
            time(|| single.render(|| ())),
            time(|| double.render(|| ())),
            povray(&scene, folder).map_or(f64::NAN, |seconds| 1e3 * seconds),
        ]
    });
    println!(
        "\nSeven spheres, mirrors and glass up to six segments, two lights with shadows, 16 samples, milliseconds:\n"
    );
    println!("| f32 | f64 | POV-Ray 3.7 (its trace time) | POV-Ray / f32 | / f64 |\n|---|---|---|---|---|");
    println!(
        "| {f32:.0} | {f64:.0} | {theirs:.0} | {} | {} |",
        ratio(theirs, f32),
        ratio(theirs, f64)
    );
}

/// A matte surface.
fn surface(shape: Shape) -> Object {
    Object {
        shape,
        material: material(Model::Lambert),
        motion: None,
    }
}

/// Gives all surfaces a pattern that moves with them.
fn patterned(scene: &mut Scene, kind: PatternKind) {
    for object in &mut scene.objects {
        object.material.pattern = Some(Pattern {
            kind,
            color: [0.2, 0.3, 0.4],
            size: 0.3,
            space: Space::Object {
                axes: object.shape.axes(),
            },
        });
    }
}

/// What a scene has besides ten spheres under a light without shadows.
type Feature = (&'static str, fn(&mut Scene));

static FEATURES: [Feature; 15] = [
    ("shadows", |scene| scene.lights[0].shadow = true),
    ("a second light", |scene| {
        scene.lights.push(Light {
            position: [-5.0, 9.0, 4.0],
            ..light()
        });
    }),
    ("a soft shadow", |scene| {
        scene.film.sampler = Sampler::Stratified;
        scene.lights[0].shadow = true;
        scene.lights[0].radius = 1.0;
    }),
    ("mirrors, two segments", |scene| {
        scene.film.max_depth = 2;
        scene
            .objects
            .iter_mut()
            .step_by(2)
            .for_each(|object| object.material = material(Model::Mirror));
    }),
    ("glass, four segments", |scene| {
        scene.film.max_depth = 4;
        let glass = Model::Glass {
            ior: 1.5,
            fresnel: Fresnel::Exact,
        };
        scene
            .objects
            .iter_mut()
            .step_by(2)
            .for_each(|object| object.material = material(glass));
    }),
    ("four samples", |scene| {
        scene.film.samples = 4;
        scene.film.sampler = Sampler::Stratified;
    }),
    ("a gamma", |scene| scene.film.gamma = 2.2),
    ("a plane", |scene| {
        scene.objects.push(surface(Shape::Plane {
            point: [0.0, -10.0, 0.0],
            normal: [0.0, 1.0, 0.0],
        }));
    }),
    ("a box", |scene| {
        scene.objects.push(surface(Shape::Box(Cuboid {
            center: [0.0, -1.0, -10.0],
            size: [3.0, 2.0, 3.0],
            axes: [[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]],
        })));
    }),
    ("checkers on all spheres", |scene| {
        patterned(scene, PatternKind::Checker);
    }),
    ("stripes on all spheres", |scene| {
        patterned(
            scene,
            PatternKind::Stripes {
                direction: [0.6, 0.8, 0.0],
            },
        );
    }),
    ("a turned camera", |scene| {
        // The same image, so that the price is that of the rays.
        scene.camera.look_at = Some([0.0, 0.0, -15.0]);
    }),
    ("motion", |scene| {
        let motion = Motion {
            pivot: [0.0; 3],
            axis: [0.0, 1.0, 0.0],
            period: Period::Frames(60.0),
            within: None,
        };
        scene.motions.push(motion);
        scene
            .objects
            .iter_mut()
            .for_each(|object| object.motion = Some(0));
    }),
    ("a thousand spheres", |scene| {
        scene.objects = spheres(1000, Model::Lambert).objects;
    }),
    ("path tracing, three segments", |scene| {
        scene.film.integrator = Integrator::Path;
        scene.film.sampler = Sampler::Stratified;
        scene.film.max_depth = 3;
        scene
            .objects
            .iter_mut()
            .for_each(|object| object.material = material(Model::Diffuse));
        scene.objects[0].material = material(Model::Emitter);
    }),
];

fn features() {
    let mut base = spheres(10, Model::Lambert);
    base.lights.push(light());
    println!(
        "\nWhat features cost a picture of ten spheres under a light, 640×360, milliseconds, and times the picture without:\n"
    );
    println!("| | f32 | | f64 | |\n|---|---|---|---|---|");
    let (single, double) = (Tracer::<f32>::new(&base), Tracer::<f64>::new(&base));
    for (name, add) in FEATURES {
        let mut scene = base.clone();
        add(&mut scene);
        let (more32, more64) = (Tracer::<f32>::new(&scene), Tracer::<f64>::new(&scene));
        let [f32, with32, f64, with64] = in_turns(|| {
            [
                time(|| single.render(|| ())),
                time(|| more32.render(|| ())),
                time(|| double.render(|| ())),
                time(|| more64.render(|| ())),
            ]
        });
        println!(
            "| {name} | {with32:.1} | {} | {with64:.1} | {} |",
            ratio(with32, f32),
            ratio(with64, f64)
        );
    }
}

/// The slope of the line nearest to the logarithms.
fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / logs.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let over: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    over / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// Prints how the time grows, and adds it to the chart.
fn growth(chart: &mut Scatter, name: &str, scenes: Vec<(f64, Scene)>) {
    println!("\n| {name} | f32 | f64 |\n|---|---|---|");
    let mut points = [Vec::new(), Vec::new()];
    for (at, scene) in scenes {
        let (single, double) = (Tracer::<f32>::new(&scene), Tracer::<f64>::new(&scene));
        let times = in_turns(|| [time(|| single.render(|| ())), time(|| double.render(|| ()))]);
        println!("| {at} | {:.2} | {:.2} |", times[0], times[1]);
        for (points, time) in points.iter_mut().zip(times) {
            points.push((at, time));
        }
    }
    for (number, points) in ["f32", "f64"].into_iter().zip(&points) {
        let group = chart.groups.len();
        chart
            .groups
            .push(format!("{name}, {number}: exponent {:.2}", exponent(points)));
        chart.points.extend(points.iter().map(|&(x, y)| Point {
            x,
            y,
            name: String::new(),
            group,
            on_front: false,
        }));
    }
    let [single, double] = points.map(|points| exponent(&points));
    println!("| exponent | {single:.2} | {double:.2} |");
}

fn growths(counts: &[usize]) {
    println!("\nHow the time grows, a picture of flat colours, milliseconds:");
    let mut chart = Scatter {
        title: "Time of a picture of flat colours".to_owned(),
        x_title: "how many".to_owned(),
        y_title: "milliseconds of processor time".to_owned(),
        groups: Vec::new(),
        points: Vec::new(),
        reference_lines: Vec::new(),
    };
    let counted = |&count: &usize| (count as f64, spheres(count, Model::Emitter));
    growth(&mut chart, "spheres", counts.iter().map(counted).collect());
    let sized = |factor: u32| {
        let mut scene = spheres(100, Model::Emitter);
        scene.film.size = [160 * factor, 90 * factor];
        (f64::from(160 * 90 * factor * factor), scene)
    };
    growth(&mut chart, "pixels", [1, 2, 4, 8, 16].map(sized).into());
    let sampled = |samples: u32| {
        let mut scene = spheres(100, Model::Emitter);
        (scene.film.samples, scene.film.sampler) = (samples, Sampler::Stratified);
        (f64::from(samples), scene)
    };
    growth(&mut chart, "samples", [1, 4, 16, 64].map(sampled).into());
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("growth.svg");
    fs::write(&path, chart.svg()).expect("there is room");
    println!("\nDrawn in {}", path.display());
}

/// Kilobytes of this process in memory.
fn resident() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse().ok())
        .unwrap_or(f64::NAN)
}

fn building(program: Option<&Path>, counts: &[usize]) {
    println!("\nMaking a tracer, its tree included, milliseconds, and the memory it then holds:\n");
    println!("| spheres | f32 | MB | f64 | MB | Embree |\n|---|---|---|---|---|---|");
    for &count in counts {
        let scene = spheres(count, Model::Emitter);
        let before = resident();
        let mut single = None;
        let f32 = time(|| single = Some(Tracer::<f32>::new(&scene)));
        let between = resident();
        let mut double = None;
        let f64 = time(|| double = Some(Tracer::<f64>::new(&scene)));
        let after = resident();
        let embree = program.map_or(f64::NAN, |program| 1e3 * Embree::new(program, &scene, &[]).build);
        println!(
            "| {count} | {f32:.1} | {:.0} | {f64:.1} | {:.0} | {} |",
            (between - before) / 1024.0,
            (after - between) / 1024.0,
            cell(embree)
        );
    }
}

/// Two threads beside one, by the clock on the wall.
fn threads(one: &rayon::ThreadPool) {
    let two = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .expect("two threads");
    let mut scene = parse(include_str!("whitted.toml"));
    scene.film.samples = 4;
    scene.film.sampler = Sampler::Stratified;
    let (single, double) = (Tracer::<f32>::new(&scene), Tracer::<f64>::new(&scene));
    let wall = |pool: &rayon::ThreadPool, picture: &(dyn Fn() + Sync)| {
        let start = std::time::Instant::now();
        pool.install(picture);
        1e3 * start.elapsed().as_secs_f64()
    };
    let picture32 = || drop(single.render(|| ()));
    let picture64 = || drop(double.render(|| ()));
    let [one32, two32, one64, two64] = in_turns(|| {
        [
            wall(one, &picture32),
            wall(&two, &picture32),
            wall(one, &picture64),
            wall(&two, &picture64),
        ]
    });
    println!("\nThe seven spheres at four samples, milliseconds by the clock on the wall:\n");
    println!("| | one thread | two | times as fast |\n|---|---|---|---|");
    println!("| f32 | {one32:.0} | {two32:.0} | {} |", ratio(one32, two32));
    println!("| f64 | {one64:.0} | {two64:.0} | {} |", ratio(one64, two64));
}

/// One of the tables, by the name that asks for it.
type Part<'a> = (&'static str, &'a (dyn Fn() + Sync));

fn main() {
    let folder = tempfile::tempdir().expect("there is room");
    let program = folder.path().join("embree");
    let program = match embree::compile(&program) {
        Ok(()) => Some(program.as_path()),
        Err(why) => {
            eprintln!("without Embree: {why}");
            None
        }
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("one thread");
    let all = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000];
    let parts: [Part<'_>; 6] = [
        ("rays", &|| beside_embree_and_lavapipe(program, &all)),
        ("povray", &|| beside_povray(folder.path())),
        ("threads", &|| threads(&pool)),
        ("features", &features),
        ("growth", &|| growths(&all)),
        ("building", &|| building(program, &all[2..])),
    ];
    // Cargo adds options of its own.
    let asked: Vec<_> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with('-'))
        .collect();
    for (name, print) in parts {
        if asked.is_empty() || asked.iter().any(|word| word == name) {
            pool.install(print);
        }
    }
}
