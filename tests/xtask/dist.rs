//! `cargo xtask dist`: the files of a release, each complete, with their SHA-256 checksums.
//!
//! A file depends on the commit and the compiler only: files in archives have the commit's date and no owner.

mod deb;
mod licenses;

use std::fmt::Write;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, SystemTime};

use clap::{CommandFactory, ValueEnum};
use clap_complete::Shell;
use sha2::{Digest, Sha256};
use toyproof::cli::Cli;

const VERSION: &str = env!("CARGO_PKG_VERSION");
/// The version of glibc that programs are linked for: that of RHEL 8, older than in Debian 11 and Ubuntu 20.04.
const GLIBC: &str = "2.28";
const CHECKSUMS: &str = "SHA256SUMS";
const THIRD_PARTY: &str = "LICENSES-THIRD-PARTY";

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "dist")]
    out: PathBuf,
    /// The platforms [default: those that Linux can build for]
    #[arg(value_enum, value_name = "TARGET")]
    targets: Vec<Target>,
}

/// A platform, by Rust's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Target {
    /// Loads Vulkan drivers, such as lavapipe: an archive, a package for Debian, and one for Python
    #[value(name = "x86_64-unknown-linux-gnu")]
    LinuxGnu,
    /// Runs on every Linux, without libraries and on the CPU only: an archive
    #[value(name = "x86_64-unknown-linux-musl")]
    LinuxStatic,
    /// Runs on every Linux of this architecture, without libraries and on the CPU only: an archive
    #[value(name = "aarch64-unknown-linux-musl")]
    LinuxStaticArm,
    /// An archive
    #[value(name = "x86_64-pc-windows-gnu")]
    Windows,
    /// An archive, on macOS only
    #[value(name = "aarch64-apple-darwin")]
    MacOs,
}

impl Target {
    const FROM_LINUX: [Self; 4] = [
        Self::LinuxGnu,
        Self::LinuxStatic,
        Self::LinuxStaticArm,
        Self::Windows,
    ];

    fn name(self) -> String {
        let value = self.to_possible_value().expect("no variant is skipped");
        value.get_name().to_owned()
    }

    fn program(self) -> &'static str {
        match self {
            Self::Windows => "toyproof.exe",
            _ => "toyproof",
        }
    }
}

/// The folders of a release.
struct Release {
    root: PathBuf,
    /// Cargo's folder.
    target_folder: PathBuf,
    out: PathBuf,
    /// The date of the commit, in seconds since 1970.
    date: u64,
}

/// Builds the files of all targets, and writes their checksums.
pub(super) fn build(arguments: &Arguments) -> io::Result<()> {
    let root = fs::canonicalize(Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."))?;
    fs::create_dir_all(&arguments.out)?;
    let metadata = licenses::metadata(&root, None)?;
    let mut git = Command::new("git");
    let date = output(git.args(["log", "-1", "--format=%ct"]).current_dir(&root))?;
    let release = Release {
        target_folder: metadata["target_directory"]
            .as_str()
            .expect("cargo names it")
            .into(),
        out: fs::canonicalize(&arguments.out)?,
        date: date.trim().parse().map_err(io::Error::other)?,
        root,
    };
    let targets = match &arguments.targets[..] {
        [] => &Target::FROM_LINUX,
        targets => targets,
    };
    for &target in targets {
        release.build(target)?;
    }
    release.write_checksums()
}

impl Release {
    fn build(&self, target: Target) -> io::Result<()> {
        println!("{}", target.name());
        let folder = self.stage(target)?;
        fs::copy(self.compile(target, &folder)?, folder.join(target.program()))?;
        self.date(&folder)?;
        self.archive(target, &folder)?;
        if target == Target::LinuxGnu {
            deb::build(self, &folder)?;
        }
        Ok(())
    }

    /// Collects the documents of an archive in a folder.
    fn stage(&self, target: Target) -> io::Result<PathBuf> {
        let name = format!("toyproof-{VERSION}-{}", target.name());
        let folder = self.target_folder.join("dist").join(name);
        recreate(&folder)?;
        for file in ["README.md", "CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT"] {
            fs::copy(self.root.join(file), folder.join(file))?;
        }
        let licenses = licenses::of_dependencies(&self.root, &target.name())?;
        fs::write(folder.join(THIRD_PARTY), licenses)?;
        let [man, completions] = ["man", "completions"].map(|name| folder.join(name));
        fs::create_dir(&man)?;
        clap_mangen::generate_to(Cli::command(), &man)?;
        fs::create_dir(&completions)?;
        for shell in Shell::value_variants() {
            clap_complete::generate_to(*shell, &mut Cli::command(), "toyproof", &completions)?;
        }
        Ok(folder)
    }

    /// Compiles the program. That for glibc is compiled by maturin, which also packs it for Python's installers.
    fn compile(&self, target: Target, documents: &Path) -> io::Result<PathBuf> {
        let name = target.name();
        let mut compiler = if target == Target::LinuxGnu {
            let project = self.root.join("packaging");
            let licenses = project.join("licenses");
            recreate(&licenses)?;
            for file in ["LICENSE-APACHE", "LICENSE-MIT", THIRD_PARTY] {
                fs::copy(documents.join(file), licenses.join(file))?;
            }
            let mut maturin = Command::new("maturin");
            maturin.args(["build", "--zig", "--compatibility"]);
            maturin.arg(format!("manylinux_{}", GLIBC.replace('.', "_")));
            maturin.arg("--out").arg(&self.out).current_dir(project);
            maturin
        } else {
            let mut cargo = Command::new(env!("CARGO"));
            cargo.args(["build", "--package", "toyproof", "--bin", "toyproof"]);
            cargo.current_dir(&self.root);
            cargo
        };
        if target == Target::LinuxStaticArm {
            // Rust's target has musl itself; any linker for the architecture will do.
            let linker = "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER";
            compiler.env(linker, "aarch64-linux-gnu-gcc");
        }
        compiler.args(["--release", "--locked", "--target", &name]);
        run(compiler.env("SOURCE_DATE_EPOCH", self.date.to_string()))?;
        let folder = self.target_folder.join(name).join("release");
        Ok(folder.join(target.program()))
    }

    /// Gives all files of a folder the date of the commit.
    fn date(&self, folder: &Path) -> io::Result<()> {
        let date = SystemTime::UNIX_EPOCH + Duration::from_secs(self.date);
        for file in files(folder)? {
            let file = File::options().append(true).open(folder.join(file))?;
            file.set_modified(date)?;
        }
        Ok(())
    }

    /// Packs a folder of files as archive, in the order of their names.
    fn archive(&self, target: Target, folder: &Path) -> io::Result<()> {
        let parent = folder.parent().expect("it is in Cargo's folder");
        let name = folder
            .file_name()
            .expect("it has a name")
            .to_str()
            .expect("it is ASCII");
        let packed = files(folder)?.into_iter().map(|file| Path::new(name).join(file));
        let mut pack;
        let archive = if target == Target::Windows {
            pack = Command::new("zip");
            pack.args(["-X", "-q"]).env("TZ", "UTC");
            format!("{name}.zip")
        } else {
            pack = Command::new("tar");
            if cfg!(target_os = "linux") {
                pack.args(["--owner=0", "--group=0", "--numeric-owner", "--mode=go=u-w"]);
            }
            pack.arg("-czf");
            format!("{name}.tar.gz")
        };
        let archive = self.out.join(archive);
        remove(&archive)?;
        run(pack.arg(archive).args(packed).current_dir(parent))
    }

    /// Writes the checksums of all files, as `sha256sum --check` reads them.
    fn write_checksums(&self) -> io::Result<()> {
        let mut lines = String::new();
        for name in files(&self.out)? {
            if name == Path::new(CHECKSUMS) {
                continue;
            }
            let hash = Sha256::digest(fs::read(self.out.join(&name))?);
            let _ = writeln!(lines, "{hash:x}  {}", name.to_str().expect("it is ASCII"));
        }
        print!("{lines}");
        fs::write(self.out.join(CHECKSUMS), lines)
    }
}

/// Runs a program; an error if it is missing or fails.
fn run(command: &mut Command) -> io::Result<()> {
    let status = command.status().map_err(|error| failed(command, &error))?;
    if status.success() {
        Ok(())
    } else {
        Err(failed(command, &status))
    }
}

/// Runs a program and returns its output.
fn output(command: &mut Command) -> io::Result<String> {
    let output = command.output().map_err(|error| failed(command, &error))?;
    if !output.status.success() {
        return Err(failed(command, &String::from_utf8_lossy(&output.stderr)));
    }
    String::from_utf8(output.stdout).map_err(io::Error::other)
}

fn failed(command: &Command, reason: &dyn std::fmt::Display) -> io::Error {
    let program = command.get_program().to_string_lossy();
    io::Error::other(format!(
        "{program}: {reason}; CONTRIBUTING.md lists the programs that a release needs"
    ))
}

/// Makes an empty folder.
fn recreate(folder: &Path) -> io::Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder)
}

/// Removes a file, if it exists.
fn remove(file: &Path) -> io::Result<()> {
    if file.exists() {
        fs::remove_file(file)
    } else {
        Ok(())
    }
}

/// The files in a folder and its folders, by their paths in it, sorted.
fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = PathBuf::from(entry.file_name());
        if entry.file_type()?.is_dir() {
            found.extend(files(&entry.path())?.into_iter().map(|file| name.join(file)));
        } else {
            found.push(name);
        }
    }
    found.sort();
    Ok(found)
}
