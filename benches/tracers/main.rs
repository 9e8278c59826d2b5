//! The reference tracer compared with Embree, lavapipe and POV-Ray, in turns, so that noise affects all of them; in
//! milliseconds of processor time, the tracer's on one thread. Programs that are not installed are left out.
//! `cargo bench --bench tracers [-- rays povray threads features growth building]`

#![expect(clippy::disallowed_methods, reason = "the paths are the benchmark's own")]
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a benchmark reports to the terminal"
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
/// The largest number of spheres in a shader: with more, drivers take minutes to compile it.
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

/// The medians of several programs, which take turns.
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

/// Lavapipe with the shader of a scene.
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

/// The camera rays, as float32, and rays in random directions from the points that they hit.
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
    // In random order, as many as camera rays.
    let shuffled = (0..camera.len())
        .map(|_| others[(random.number() * others.len() as f64) as usize])
        .collect();
    [camera, shuffled]
}

fn ray([ox, oy, oz]: [f32; 3], [dx, dy, dz]: [f32; 3], t_min: f32) -> Ray {
    [ox, oy, oz, dx, dy, dz, t_min]
}

fn intersect_all<T: Real>(tracer: &Tracer<T>, rays: &[([T; 3], [T; 3], Option<usize>)]) -> usize {
    let hits = rays
        .iter()
        .filter(|(origin, direction, from)| tracer.intersect(*origin, *direction, *from).is_some());
    hits.count()
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

/// The surfaces that camera rays hit, and those that shuffled ones hit.
fn compare_with_embree_and_lavapipe(program: Option<&Path>, counts: &[usize]) {
    println!(
        "Milliseconds at 640×360 on one thread. Primary: generating the camera rays, finding the nearest hits, storing their spheres."
    );
    println!(
        "Shuffled: as many rays, from the hit points in random directions. Lavapipe renders the exported shader, whose image is compared.\n"
    );
    println!(
        "| spheres | f32 | f64 | image f32 | f64 | Embree 1 | 8 | user geometry 16 | lavapipe | Embree 8 / f32 | 16 / f32 | lavapipe / f32 | / f64 \
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
                time(|| intersect_all(&single, &shuffled32)),
                time(|| intersect_all(&double, &shuffled64)),
                theirs[3],
            ]
        });
        let [
            f32,
            f64,
            image32,
            image64,
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
        let numbers = [f32, f64, image32, image64, one, eight, sixteen, gpu]
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

/// The trace time that POV-Ray reports, in seconds of processor time.
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
    let log = String::from_utf8_lossy(&output.stderr);
    let (_, trace) = log.split_once("Trace Time:")?;
    let (_, with) = trace.split_once(" with ")?;
    let (seconds, _) = with.split_once(" CPU-seconds")?;
    seconds.trim().parse().ok()
}

fn compare_with_povray(folder: &Path) {
    let mut scene = parse(include_str!("whitted.toml"));
    if povray(&scene, folder).is_none() {
        eprintln!("POV-Ray is not installed (Debian: povray)");
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
        // The image is the same, so that only the rays cost time.
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
        "\nFeatures added to an image of ten spheres under a light, 640×360: milliseconds, and the ratio to the image without:\n"
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

/// Prints the growth of the time, and adds it to the chart.
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
    println!("\nGrowth of the time of an image of flat colors, milliseconds:");
    let mut chart = Scatter {
        title: "Time of an image of flat colors".to_owned(),
        x_title: "number".to_owned(),
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
    fs::write(&path, chart.svg()).expect("the folder is writable");
    println!("\nChart: {}", path.display());
}

/// The resident memory of this process in kB.
fn resident() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse().ok())
        .unwrap_or(f64::NAN)
}

fn building(program: Option<&Path>, counts: &[usize]) {
    println!(
        "\nConstructing a tracer, including its tree: milliseconds, and the memory that it then holds:\n"
    );
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

/// Two threads compared with one, in wall-clock time.
fn threads(one: &rayon::ThreadPool) {
    let two = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .expect("two threads");
    let mut scene = parse(include_str!("whitted.toml"));
    scene.film.samples = 4;
    scene.film.sampler = Sampler::Stratified;
    let (single, double) = (Tracer::<f32>::new(&scene), Tracer::<f64>::new(&scene));
    let wall = |pool: &rayon::ThreadPool, image: &(dyn Fn() + Sync)| {
        let start = std::time::Instant::now();
        pool.install(image);
        1e3 * start.elapsed().as_secs_f64()
    };
    let image32 = || drop(single.render(|| ()));
    let image64 = || drop(double.render(|| ()));
    let [one32, two32, one64, two64] = in_turns(|| {
        [
            wall(one, &image32),
            wall(&two, &image32),
            wall(one, &image64),
            wall(&two, &image64),
        ]
    });
    println!("\nThe seven spheres at four samples, milliseconds of wall-clock time:\n");
    println!("| | one thread | two | ratio |\n|---|---|---|---|");
    println!("| f32 | {one32:.0} | {two32:.0} | {} |", ratio(one32, two32));
    println!("| f64 | {one64:.0} | {two64:.0} | {} |", ratio(one64, two64));
}

/// A table and its name on the command line.
type Part<'a> = (&'static str, &'a (dyn Fn() + Sync));

fn main() {
    let folder = tempfile::tempdir().expect("the folder is writable");
    let program = folder.path().join("embree");
    let program = match embree::compile(&program) {
        Ok(()) => Some(program.as_path()),
        Err(why) => {
            eprintln!("Embree is left out: {why}");
            None
        }
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("one thread");
    let all = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000];
    let parts: [Part<'_>; 6] = [
        ("rays", &|| compare_with_embree_and_lavapipe(program, &all)),
        ("povray", &|| compare_with_povray(folder.path())),
        ("threads", &|| threads(&pool)),
        ("features", &features),
        ("growth", &|| growths(&all)),
        ("building", &|| building(program, &all[2..])),
    ];
    // Cargo adds options of its own.
    let selected: Vec<_> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with('-'))
        .collect();
    for (name, print) in parts {
        if selected.is_empty() || selected.iter().any(|word| word == name) {
            pool.install(print);
        }
    }
}
