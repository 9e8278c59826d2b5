//! Drivers that do not start, and drivers that do not finish compiling: neither is ever the shader's fault.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use std::{fs, thread};

use serde_json::Value;
use toyproof::diagnostic::{Code, File, Files};
use toyproof::eval;
use toyproof::explain::{self, Findings};
use toyproof::glsl::Checked;
use toyproof::gpu::{AdapterSelector, Failure, Phase, Worker};
use toyproof::image::Frame;
use toyproof::lint::Lints;
use toyproof::scene::{self, Scene};
use toyproof::translate::backend::Target;
use toyproof::translate::{FloatMode, lower};
use toyproof::verify::{self, Case, Expected, Verdict};

use crate::program::{Run, command, run};
use crate::requirements::{require_driver, require_program, require_worker, skip};
use crate::support::wait::HANG_GUARD;
use crate::support::{SPHERE, checked};

/// A worker that is a script. It reports its phase by printing a message of the protocol: the length, the tag
/// of a phase message, and the phase. TRANSLATED is the reply to a translation job: no bytes.
fn worker(script: &str) -> Worker {
    let script = script.replace(
        "TRANSLATED",
        r"printf '\004\000\000\000\000\000\000\000\002\000\001\000'",
    );
    let phases = ["STARTING", "TRANSLATING", "COMPILING", "DRAWING"];
    let script = (0..).zip(phases).fold(script, |script, (number, name)| {
        let says = format!(r"printf '\002\000\000\000\000\000\000\000\000\00{number}'");
        script.replace(name, &says)
    });
    let arguments = vec!["-c".to_owned(), script];
    Worker::new(
        "/bin/sh".into(),
        arguments,
        AdapterSelector::Auto,
        Duration::from_millis(300),
    )
    .with_start_timeout(HANG_GUARD)
}

fn draw(mut worker: Worker) -> Failure {
    let shader = checked(SPHERE.shader);
    let drawn = worker.draw(lower(&shader), Frame::default(), FloatMode::Strict);
    drawn.expect_err("a script paints nothing")
}

#[test]
fn driver_start_failures_are_distinct_from_slow_shaders() {
    let overflow = "echo \"thread 'main' has overflowed its stack\" >&2; kill -ABRT $$";
    let is_not_started = |script: &str, failure: &Failure, wanted: &str| {
        assert!(matches!(failure, Failure::NotStarted(_)), "{script}: {failure:?}");
        assert!(failure.is_without_driver(), "{script}");
        assert!(failure.to_string().contains(wanted), "{script}: {failure}");
    };
    // Long enough that a busy machine starts a shell in it.
    let limit = Duration::from_secs(3);
    thread::scope(|scope| {
        for (script, wanted) in [
            ("exec sleep 60", "the worker process did not respond within 3 s"),
            ("kill -STOP $$", "the worker process did not respond within 3 s"),
            (
                "STARTING; exec sleep 60",
                "the Vulkan driver did not start within 3 s",
            ),
            (
                "STARTING; kill -STOP $$",
                "the Vulkan driver did not start within 3 s",
            ),
        ] {
            scope.spawn(move || {
                let failure = draw(worker(script).with_start_timeout(limit));
                is_not_started(script, &failure, wanted);
            });
        }
    });
    for (script, wanted) in [
        ("exit 3", "terminated (exit status: 3) before its first reply"),
        (
            "TRANSLATING; STARTING; exit 3",
            "while the Vulkan driver was starting",
        ),
        (
            &format!("STARTING; {overflow}"),
            "while the Vulkan driver was starting",
        ),
    ] {
        is_not_started(script, &draw(worker(script)), wanted);
    }
    for (script, wanted) in [
        ("COMPILING; exec sleep 60", Phase::Compiling),
        ("DRAWING; kill -STOP $$", Phase::Drawing),
    ] {
        let failure = draw(worker(script));
        assert!(
            matches!(failure, Failure::Timeout { phase, .. } if phase == wanted),
            "{script}: {failure:?}"
        );
    }
    let failure = draw(worker(&format!("TRANSLATING; {overflow}")));
    let phase = Phase::Translating;
    assert_eq!(failure, Failure::StackOverflow { phase });
}

#[test]
fn a_driver_that_never_started_is_not_retried() {
    let folder = tempfile::tempdir().unwrap();
    let shader = lower(&checked(SPHERE.shader));
    let script = |name: &str, first: &str| {
        let file = folder.path().join(name).display().to_string();
        worker(&format!("[ -e {file} ] && exit 4; touch {file}; {first} exit 3"))
    };
    let mut never = script("never", "");
    for _ in 0..2 {
        let drawn = never.draw(shader.clone(), Frame::default(), FloatMode::Strict);
        let failure = drawn.unwrap_err().to_string();
        assert!(failure.contains("(exit status: 3)"), "{failure}");
    }

    let mut once = script("once", "TRANSLATED;");
    let mut translate = || once.translate(shader.clone(), Target::Wgsl, FloatMode::Strict);
    assert_eq!(translate(), Ok(Vec::new()));
    for status in [3, 4, 4] {
        let failure = translate().unwrap_err().to_string();
        assert!(failure.contains(&format!("(exit status: {status})")), "{failure}");
    }
}

#[test]
fn driver_start_time_does_not_count_for_the_shader() {
    // Together they exceed the shader's time limit, but the driver alone does not.
    let script = "STARTING; sleep 0.4; COMPILING; exec sleep 60";
    let shader = checked(SPHERE.shader);
    let drawn = worker(script).draw(lower(&shader), Frame::default(), FloatMode::Strict);
    let failure = drawn.unwrap_err();
    assert!(failure.is_slow_compilation(), "{failure:?}");
}

fn judge(script: &str, checked: &Checked, timeout: Duration) -> Result<Findings, verify::Failure> {
    judge_against(None, script, checked, timeout)
}

fn judge_against(
    scene: Option<&Scene>,
    script: &str,
    checked: &Checked,
    timeout: Duration,
) -> Result<Findings, verify::Failure> {
    let frame = Frame {
        size: [16, 9],
        ..Frame::default()
    };
    let expected = scene.map(|scene| Expected::from_scene(scene.clone(), &frame));
    let lints = Lints::default();
    let case = Case {
        expected: expected.as_ref(),
        ..Case::new(checked, &lints, &frame).with_timeout(timeout)
    };
    explain::check(Some(&mut worker(script)), &case, &explain::Options::default())
}

#[test]
fn the_evaluator_checks_shaders_that_the_driver_cannot_compile_in_time() {
    let minute = Duration::from_secs(60);
    let findings = judge("COMPILING; exec sleep 60", &checked(SPHERE.shader), minute).unwrap();
    assert_eq!(findings.verdict, Verdict::Ok);
    assert!(
        findings.results.toolchain.is_none()
            && findings.results.precision.is_some()
            && findings.results.gpu_run.is_none()
    );
    let note = findings
        .notes
        .iter()
        .find(|note| note.code == Code::SlowCompilation)
        .unwrap();
    assert!(
        note.message.contains("takes longer than 0.3 s to compile"),
        "{note:?}"
    );

    // A shader that does not end is still reported.
    let endless =
        "void mainImage(out vec4 c, in vec2 p) { for (float s = p.x; s > -1.0; s += 0.0) c.x += s; }";
    let failure = judge(
        "COMPILING; exec sleep 60",
        &checked(endless),
        Duration::from_millis(500),
    )
    .unwrap_err();
    let is_endless = matches!(
        failure,
        verify::Failure::Cpu(eval::Failure::Timeout { .. } | eval::Failure::TooOften { .. })
    );
    assert!(is_endless, "{failure:?}");
}

/// Scripts that fail after they have started, and what the warning says.
const FAILING: [(&str, &str); 6] = [
    (
        "DRAWING; exec sleep 60",
        "time limit of 0.3 s exceeded while the driver was rendering",
    ),
    (
        "DRAWING; kill -STOP $$",
        "time limit of 0.3 s exceeded while the driver was rendering",
    ),
    ("DRAWING; exit 3", "while the driver was rendering the frame"),
    (
        "COMPILING; kill -FPE $$",
        "while the driver was compiling the shader",
    ),
    (
        "COMPILING; kill -KILL $$",
        "while the driver was compiling the shader",
    ),
    ("TRANSLATING; exit 3", "while naga was translating the shader"),
];

#[test]
fn a_drivers_fault_takes_no_verdict_away() {
    let mut files = Files::default();
    let file = files.add(File::new("scene.toml", SPHERE.scene));
    let scene = scene::parse(&files, file).unwrap();
    let wrong = SPHERE.shader.replace("1.5", "1.25");
    let unlike = [(SPHERE.shader, Verdict::Correct), (&wrong, Verdict::Wrong)];
    for (script, wanted) in FAILING {
        for (shader, verdict) in unlike {
            let findings = judge_against(Some(&scene), script, &checked(shader), HANG_GUARD).unwrap();
            assert_eq!(findings.verdict, verdict, "{script}");
            assert!(
                findings.results.toolchain.is_none() && findings.results.gpu_run.is_none(),
                "{script}"
            );
            let note = findings
                .notes
                .iter()
                .find(|note| note.code == Code::DriverFailure)
                .unwrap();
            assert!(note.message.contains(wanted), "{script}: {note:?}");
        }
        // Without a reference, the driver is what is checked; how long it takes shows nothing.
        let checked = checked(SPHERE.shader);
        match judge(script, &checked, HANG_GUARD) {
            Ok(findings) => assert_eq!((findings.verdict, wanted.contains("limit")), (Verdict::Ok, true)),
            Err(failure) => assert!(
                matches!(failure, verify::Failure::Gpu(_)) && !wanted.contains("limit"),
                "{script}: {failure:?}"
            ),
        }
    }
}

/// Compiles a Vulkan driver whose entry points execute `does`; needs `cc`.
fn fake_driver(folder: &Path, does: &str) -> PathBuf {
    let source = format!(
        "#include <stdio.h>\n#include <stdlib.h>\n#include <unistd.h>\n\
         int vk_icdNegotiateLoaderICDInterfaceVersion(unsigned *version) {{ {does} return 0; }}\n\
         void *vk_icdGetInstanceProcAddr(void *instance, const char *name) {{ {does} return 0; }}\n"
    );
    compiled_driver(folder, &source)
}

/// Compiles a Vulkan driver from a file in C, and returns its manifest; needs `cc`.
fn compiled_driver(folder: &Path, source: &str) -> PathBuf {
    fs::write(folder.join("driver.c"), source).unwrap();
    let mut compiler = Command::new("cc");
    compiler.current_dir(folder);
    let made = compiler
        .args(["-shared", "-fPIC", "-o", "driver.so", "driver.c"])
        .status();
    assert!(made.unwrap().success());
    let manifest = folder.join("driver.json");
    let library = folder.join("driver.so");
    let text = serde_json::json!({
        "file_format_version": "1.0.0",
        "ICD": { "library_path": library, "api_version": "1.3.0" },
    });
    fs::write(&manifest, text.to_string()).unwrap();
    manifest
}

/// Runs `toyproof` with only that driver, in a folder with three correct shaders.
fn with_driver(does: &str, arguments: &[&str]) -> Run {
    with_driver_and(does, arguments, &[])
}

/// As [`with_driver`], with further variables in the environment.
fn with_driver_and(does: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let manifest = fake_driver(folder.path(), does);
    fs::create_dir(folder.path().join("hw")).unwrap();
    for name in ["a", "b", "c"] {
        let path = folder.path().join("hw").join(name).with_extension("glsl");
        fs::write(path, SPHERE.shader).unwrap();
    }
    let mut command = command(folder.path());
    command
        .env("VK_ICD_FILENAMES", manifest)
        .env_remove("VK_DRIVER_FILES")
        .envs(variables.iter().copied());
    run(command.args(arguments))
}

/// The driver's behavior, and the expected message.
const FAULTS: [(&str, &str); 3] = [
    ("_exit(3);", "while the Vulkan driver was starting"),
    ("abort();", "while the Vulkan driver was starting"),
    ("for (;;) pause();", "the Vulkan driver did not start within 10 s"),
];

#[test]
fn a_batch_continues_without_a_failed_driver() {
    if !require_driver() || !require_program("cc") {
        return;
    }
    thread::scope(|scope| {
        for (does, wanted) in FAULTS {
            scope.spawn(move || {
                let check = [
                    "check",
                    "hw",
                    "--size",
                    "16x9",
                    "--format",
                    "json",
                    "--timeout",
                    "10s",
                ];
                let run = with_driver(does, &check);
                assert_eq!(run.code, 0, "{does}: {run:?}");
                assert_eq!(
                    run.stderr.matches("shaders are evaluated on the CPU").count(),
                    1,
                    "{does}: {run:?}"
                );
                assert!(run.stderr.contains(wanted), "{does}: {run:?}");
                let report: Value = serde_json::from_str(&run.stdout).unwrap();
                for shader in report["shaders"].as_array().unwrap() {
                    assert_eq!(shader["verdict"], "ok", "{does}: {shader}");
                    assert!(shader["toolchain"].is_null(), "{does}: {shader}");
                }
            });
        }
    });
}

#[test]
fn a_requested_driver_that_does_not_start_is_an_error() {
    if !require_driver() || !require_program("cc") {
        return;
    }
    let check = ["check", "hw/a.glsl", "--size", "16x9", "--device", "lavapipe"];
    let run = with_driver("_exit(3);", &check);
    assert_eq!(run.code, 2, "{run:?}");
    assert!(
        run.stdout.contains("error") && run.stdout.contains("driver was starting"),
        "{run:?}"
    );

    // A batch does not start it again for each shader.
    let first = "if (!access(\"started\", F_OK)) _exit(4); fclose(fopen(\"started\", \"w\")); _exit(3);";
    let check = [
        "check", "hw", "--size", "16x9", "--device", "lavapipe", "--jobs", "1",
    ];
    // In the sandbox, the driver could not create that file.
    let run = with_driver_and(first, &check, &[("TOYPROOF_SANDBOX", "off")]);
    assert_eq!(run.code, 2, "{run:?}");
    assert_eq!(run.stdout.matches("(exit status: 3)").count(), 3, "{run:?}");

    let doctor = with_driver("_exit(3);", &["doctor"]);
    assert_eq!(doctor.code, 2, "{doctor:?}");
    assert!(doctor.stdout.contains("Each driver alone:"), "{doctor:?}");
    assert!(
        doctor
            .stdout
            .contains("driver.json: the worker process terminated"),
        "{doctor:?}"
    );
}

/// A driver that tries what it must not do. Each attempt that succeeds prints its name. OUTSIDE is a file that
/// it may neither read nor write.
#[cfg(target_os = "linux")]
const ATTEMPTS: &str = r#"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
static void attempt(void) {
    static int once; if (once++) return;
    char *run[] = {"true", 0};
    pid_t child = -1;
    struct rlimit limit = {1L << 40, 1L << 40};
    fprintf(stderr, "attempted:");
    if (open(OUTSIDE ".new", O_WRONLY | O_CREAT, 0600) >= 0) fprintf(stderr, " create");
    if (open(OUTSIDE, O_WRONLY) >= 0) fprintf(stderr, " write");
    if (open(OUTSIDE, O_RDONLY) >= 0) fprintf(stderr, " read");
    if (chmod(OUTSIDE, 0777) == 0) fprintf(stderr, " chmod");
    if (unlink(OUTSIDE) == 0) fprintf(stderr, " unlink");
    if (socket(AF_INET, SOCK_STREAM, 0) >= 0) fprintf(stderr, " socket");
    if (socket(AF_UNIX, SOCK_STREAM, 0) >= 0) fprintf(stderr, " local-socket");
    if (posix_spawn(&child, "/bin/true", 0, 0, run, 0) == 0) fprintf(stderr, " spawn");
    child = fork();
    if (child == 0) _exit(0);
    if (child > 0) fprintf(stderr, " fork");
    if (kill(getppid(), 0) == 0) fprintf(stderr, " signal");
    if (setrlimit(RLIMIT_AS, &limit) == 0) fprintf(stderr, " limit");
    execl("/bin/true", "true", (char *)0);
    /* What drivers do still succeeds. */
    if (open("/usr/share", O_RDONLY | O_DIRECTORY) < 0) fprintf(stderr, " cannot-read-system");
    if (open("/dev/null", O_RDWR) < 0) fprintf(stderr, " cannot-write-null");
    if (getrlimit(RLIMIT_AS, &limit) != 0) fprintf(stderr, " cannot-read-limit");
    fprintf(stderr, " end\n");
    _exit(3);
}
int vk_icdNegotiateLoaderICDInterfaceVersion(unsigned *version) { attempt(); return 0; }
void *vk_icdGetInstanceProcAddr(void *instance, const char *name) { attempt(); return 0; }
"#;

#[cfg(target_os = "linux")]
#[test]
fn a_driver_has_no_access_to_files_networks_and_processes() {
    use toyproof::gpu::Sandbox;

    if !require_driver() || !require_program("cc") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // The folder of the driver is readable: the file is in another.
    let outside = tempfile::tempdir().unwrap();
    let file = outside.path().join("private");
    let attempts = |variable: &str| {
        fs::write(&file, "").unwrap();
        let source = format!("#define OUTSIDE {:?}\n{ATTEMPTS}", file.display().to_string());
        let manifest = compiled_driver(folder.path(), &source);
        let mut command = command(folder.path());
        command
            .env("VK_ICD_FILENAMES", manifest)
            .env_remove("VK_DRIVER_FILES")
            .env("TOYPROOF_SANDBOX", variable);
        let run = run(command.arg("doctor"));
        assert_eq!(run.code, 2, "{run:?}");
        run.stdout + &run.stderr
    };
    let mut worker = require_worker().expect("there is a driver");
    match worker.sandbox().unwrap() {
        Sandbox::Enabled {
            landlock: Ok(_),
            seccomp: Ok(()),
        } => {
            let text = attempts("on");
            assert!(text.contains("attempted: end"), "{text}");
            assert!(file.exists() && !outside.path().join("private.new").exists());
        }
        sandbox => skip(&format!("this kernel restricts less: {sandbox}")),
    }
    let text = attempts("off");
    assert!(text.contains("disabled by TOYPROOF_SANDBOX=off"), "{text}");
    assert!(
        !file.exists() && outside.path().join("private.new").exists(),
        "{text}"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_worker_without_a_driver_has_no_access_to_files() {
    use toyproof::gpu::Sandbox;

    let Some(worker) = require_worker() else {
        return;
    };
    let mut worker = worker.without_driver();
    match worker.sandbox().unwrap() {
        Sandbox::Enabled { landlock: Ok(_), .. } => {
            let found = worker.probe();
            assert!(matches!(found, Err(Failure::NoDriver(_))), "{found:?}");
        }
        sandbox => skip(&format!("this kernel restricts less: {sandbox}")),
    }
}
