//! The commands that write, and what must hold after a fault.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, UNIX_EPOCH};

use regex::bytes::Regex;
use serde_json::json;

use super::differing;
use super::injector::{Fault, Injector};
use crate::program::{Run, toyproof};
use crate::support::SPHERE;

/// The contents of files by their paths below a folder; numbers in texts are replaced, since they include times.
pub(super) type Files = BTreeMap<String, Vec<u8>>;

/// A command that writes into the folder `out`.
pub(super) struct Tested {
    pub(super) name: &'static str,
    arguments: &'static [&'static str],
    /// The commands that run before.
    setup: &'static [&'static [&'static str]],
    /// Whether it replaces files that exist.
    pub(super) overwrites: bool,
    /// Whether `--resume` completes it.
    resumes: bool,
    /// The default test tries every write of this number; none where that takes too long.
    pub(super) stride: Option<usize>,
}

const fn tested(name: &'static str, arguments: &'static [&'static str]) -> Tested {
    Tested {
        name,
        arguments,
        setup: &[],
        overwrites: true,
        resumes: false,
        stride: Some(3),
    }
}

/// What both shards check.
macro_rules! shard {
    ($number:literal, $out:literal) => {
        &[
            "check",
            "wrong.glsl",
            "right.glsl",
            "lone.glsl",
            "--size",
            "16x9",
            "--device",
            "cpu",
            "--shard",
            $number,
            "--out",
            $out,
        ]
    };
}

pub(super) const COMMANDS: &[Tested] = &[
    Tested {
        resumes: true,
        stride: Some(41),
        ..tested(
            "check",
            &[
                "check",
                "wrong.glsl",
                "right.glsl",
                "lone.glsl",
                "invalid.glsl",
                "--out",
                "out",
                "--size",
                "16x9",
                "--jobs",
                "1",
                "--device",
                "cpu",
            ],
        )
    },
    tested(
        "render",
        &["render", "right.toml", "-o", "out/r.exr", "--size", "16x9"],
    ),
    Tested {
        stride: Some(11),
        ..tested(
            "render of frames",
            &[
                "render",
                "right.toml",
                "-o",
                "out/r.png",
                "--frames",
                "0..3",
                "--size",
                "16x9",
            ],
        )
    },
    tested(
        "run",
        &[
            "run",
            "lone.glsl",
            "-o",
            "out/r.png",
            "--size",
            "16x9",
            "--device",
            "cpu",
        ],
    ),
    Tested {
        stride: Some(7),
        ..tested(
            "run of several",
            &[
                "run",
                "wrong.glsl",
                "lone.glsl",
                "-o",
                "out",
                "--size",
                "16x9",
                "--device",
                "cpu",
            ],
        )
    },
    tested("convert", &["convert", "lone.glsl", "-o", "out/f.wgsl"]),
    Tested {
        stride: Some(7),
        ..tested(
            "convert of several",
            &["convert", "wrong.glsl", "lone.glsl", "-o", "out", "--to", "wgsl"],
        )
    },
    Tested {
        setup: &[shard!("1/2", "s1"), shard!("2/2", "s2")],
        stride: None,
        ..tested("merge", &["merge", "s1", "s2", "--out", "out"])
    },
    Tested {
        overwrites: false,
        ..tested("collect", &["collect", "downloads", "-o", "out"])
    },
    Tested {
        setup: &[&["new", "assignment", "assignment", "--from", "right.toml"]],
        ..tested(
            "autograder",
            &[
                "autograder",
                "gradescope",
                "assignment",
                "--program",
                "machine",
                "-o",
                "out/g.zip",
            ],
        )
    },
    Tested {
        overwrites: false,
        ..tested("import", &["import", "project.json", "-o", "out"])
    },
    tested("export", &["export", "lone.glsl", "-o", "out/f.json"]),
    tested("export of a scene", &["export", "right.toml", "-o", "out/f.glsl"]),
    Tested {
        overwrites: false,
        ..tested("new", &["new", "project", "name", "-o", "out"])
    },
    tested("compare", &["compare", "a.png", "b.png", "--diff", "out/d.png"]),
];

/// The files that the commands read.
fn write_inputs(folder: &Path) {
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    let wrong = SPHERE
        .shader
        .replace("sphere.radius * sphere.radius", "sphere.radius");
    let lone = "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(p / iResolution.xy, 0.5, 1.0);\n}\n";
    write("wrong.glsl", &wrong);
    write("wrong.toml", SPHERE.scene);
    write("right.glsl", SPHERE.shader);
    write("right.toml", SPHERE.scene);
    write("lone.glsl", lone);
    write(
        "invalid.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(q);\n}\n",
    );
    write("downloads/smithjane_11_22_a.glsl", lone);
    write("downloads/doejohn_12_23_a.glsl", &wrong);
    let pass = |kind: &str, code: &str| json!({"inputs": [], "outputs": [], "code": code, "name": "", "description": "", "type": kind});
    let passes = [
        pass("image", lone),
        pass("common", "float one() { return 1.0; }\n"),
    ];
    let project = json!({"ver": "0.1", "info": {"name": "Test"}, "renderpass": passes});
    write("project.json", &project.to_string());
    fs::copy("/bin/true", folder.join("machine")).unwrap();
    for (shader, image) in [("right.glsl", "a.png"), ("wrong.glsl", "b.png")] {
        let run = ["run", shader, "-o", image, "--size", "16x9", "--device", "cpu"];
        assert_eq!(toyproof(folder, &run).code, 0);
    }
}

/// A command, and what it writes without a fault.
pub(super) struct Case<'a> {
    tested: &'a Tested,
    injector: &'a Injector,
    inputs: PathBuf,
    place: PathBuf,
    /// The calls that write.
    pub(super) calls: Vec<String>,
    run: Run,
    files: Files,
}

impl<'a> Case<'a> {
    pub(super) fn new(tested: &'a Tested, injector: &'a Injector, folder: &Path) -> Self {
        let inputs = folder.join("inputs");
        fs::create_dir(&inputs).unwrap();
        write_inputs(&inputs);
        for arguments in tested.setup {
            assert!(toyproof(&inputs, arguments).code < 2);
        }
        let place = folder.join("place");
        copy(&inputs, &place);
        let (run, calls) = injector.run(&place, tested.arguments, None);
        assert!(run.code < 2, "{}: {run:?}", tested.name);
        let files = read(&place.join("out"));
        assert!(!files.is_empty() && !calls.is_empty(), "{}", tested.name);
        Self {
            tested,
            injector,
            inputs,
            place,
            calls,
            run,
            files,
        }
    }

    /// The content of a file of an earlier run.
    fn old(name: &str) -> Vec<u8> {
        format!("old {name}\n").into_bytes()
    }

    /// Runs the command with a fault.
    pub(super) fn attempt(&self, fault: Fault, number: usize, has_old_files: bool) -> Run {
        fs::remove_dir_all(&self.place).unwrap();
        copy(&self.inputs, &self.place);
        for name in self.files.keys().filter(|_| has_old_files) {
            let path = self.place.join("out").join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, Self::old(name)).unwrap();
        }
        let run = self
            .injector
            .run(&self.place, self.tested.arguments, Some((fault, number)));
        run.0
    }

    /// Runs the command with a fault; returns the rules that it breaks.
    pub(super) fn run_with(&self, fault: Fault, number: usize, has_old_files: bool) -> Vec<String> {
        let call = &self.calls[number - 1];
        let run = self.attempt(fault, number, has_old_files);
        let texts = format!("{}{}", run.stdout, run.stderr);
        let files = read(&self.place.join("out"));
        let mut violations = Vec::new();
        let temporary = files.keys().find(|name| name.contains(".toyproof-"));
        if let Some(name) = temporary.filter(|_| !call.starts_with("unlink")) {
            violations.push(format!("{name} is left behind"));
        }
        if texts.contains("internal error") || texts.contains("panicked") {
            violations.push(format!("a panic: {texts}"));
        }
        let missing = differing(&self.files, &files);
        let lacks_image = missing.iter().any(|name| has_extension(name, "png"));
        for name in &missing {
            match files.get(name) {
                None if has_old_files => violations.push(format!("the old {name} is gone")),
                None => {}
                Some(content) if has_old_files && *content == normalized(name, Self::old(name)) => {}
                // Lines of an interrupted run remain, so that it can resume.
                Some(_) if name.ends_with("results.jsonl") => {}
                // The page shows the images that could be written.
                Some(content) if name == "report.html" && lacks_image && content.ends_with(b"</html>\n") => {}
                Some(_) => violations.push(format!("{name} is neither old nor complete")),
            }
        }
        let is_excused = fault == Fault::Interrupted && !call.starts_with("write ");
        let expected = if missing.is_empty() { self.run.code } else { 2 };
        let may_fail = matches!(fault, Fault::Full | Fault::Device) || is_excused;
        if run.code != expected && !(run.code == 2 && may_fail) {
            violations.push(format!("exit code {} without {missing:?}: {texts}", run.code));
        }
        let is_named = |name: &String| texts.contains(name.rsplit('/').next().unwrap_or(name));
        if !missing.is_empty() && !texts.contains("out") && !missing.iter().any(is_named) {
            violations.push(format!("no message names a file of {missing:?}: {texts}"));
        }
        if self.tested.resumes && violations.is_empty() {
            violations.extend(self.resume());
        }
        violations
    }

    /// Repeats the command without a fault; returns the files that then differ.
    fn resume(&self) -> Vec<String> {
        let arguments = [self.tested.arguments, &["--resume"]].concat();
        let (run, _) = self.injector.run(&self.place, &arguments, None);
        let missing = differing(&self.files, &read(&self.place.join("out")));
        let mut violations: Vec<_> = missing
            .iter()
            .map(|name| format!("{name} differs after --resume"))
            .collect();
        if run.code != self.run.code {
            violations.push(format!("exit code {} after --resume: {run:?}", run.code));
        }
        violations
    }
}

/// Copies a folder. All files have the same time, which archives hold.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), &target).unwrap();
            let file = fs::File::options().write(true).open(target).unwrap();
            file.set_modified(UNIX_EPOCH + Duration::from_secs(1 << 30))
                .unwrap();
        }
    }
}

/// The files below a folder; none if there is no such folder.
fn read(folder: &Path) -> Files {
    fn collect(folder: &Path, prefix: &str, files: &mut Files) {
        let Ok(entries) = fs::read_dir(folder) else { return };
        for entry in entries {
            let entry = entry.unwrap();
            let name = format!("{prefix}{}", entry.file_name().to_str().unwrap());
            if entry.file_type().unwrap().is_dir() {
                collect(&entry.path(), &format!("{name}/"), files);
            } else {
                let mut content = normalized(&name, fs::read(entry.path()).unwrap());
                if has_extension(&name, "jsonl") {
                    // A run that resumes appends what was missing.
                    let mut lines: Vec<_> = content.split_inclusive(|&byte| byte == b'\n').collect();
                    lines.sort_unstable();
                    content = lines.concat();
                }
                files.insert(name, content);
            }
        }
    }
    let mut files = Files::new();
    collect(folder, "", &mut files);
    files
}

/// The content with numbers replaced, unless it is that of an image or an archive.
fn normalized(name: &str, content: Vec<u8>) -> Vec<u8> {
    if [".png", ".exr", ".zip"]
        .iter()
        .any(|suffix| name.ends_with(suffix))
        && !content.starts_with(b"old ")
    {
        return content;
    }
    let numbers = Regex::new(r"(?-u)[0-9]+(\.[0-9]+)?(e-?[0-9]+)?( ?(s|ms)\b)?").unwrap();
    numbers.replace_all(&content, &b"#"[..]).into_owned()
}

fn has_extension(name: &str, extension: &str) -> bool {
    Path::new(name)
        .extension()
        .is_some_and(|found| found == extension)
}
