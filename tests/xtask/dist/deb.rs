//! The package for Debian and Ubuntu: the files of the archive at their places, packed by `dpkg-deb`.

use std::env;
use std::fs;
use std::io;
use std::path::Path;
use std::process::Command;

use super::{GLIBC, Release, THIRD_PARTY, VERSION, files, output, recreate, run};

/// The folders of the package, and the files of the archive in them.
const PLACES: [(&str, &str, &str); 7] = [
    ("toyproof", "usr/bin", "toyproof"),
    ("README.md", "usr/share/doc/toyproof", "README.md"),
    (THIRD_PARTY, "usr/share/doc/toyproof", THIRD_PARTY),
    ("CHANGELOG.md", "usr/share/doc/toyproof", "NEWS"),
    (
        "completions/toyproof.bash",
        "usr/share/bash-completion/completions",
        "toyproof",
    ),
    (
        "completions/_toyproof",
        "usr/share/zsh/vendor-completions",
        "_toyproof",
    ),
    (
        "completions/toyproof.fish",
        "usr/share/fish/vendor_completions.d",
        "toyproof.fish",
    ),
];

/// The beginnings of the names of glibc's libraries.
const LIBRARIES: [&str; 5] = ["[libc.", "[libm.", "[libdl.", "[libpthread.", "[ld-linux"];

/// Builds the package from the folder of the archive.
///
/// Its maintainer is the person who builds it, by the variables of Debian's own tools.
pub(super) fn build(release: &Release, archive: &Path) -> io::Result<()> {
    check_glibc(&archive.join("toyproof"))?;
    let folder = release.target_folder.join("dist/deb");
    recreate(&folder)?;
    for (from, place, name) in PLACES {
        fs::create_dir_all(folder.join(place))?;
        fs::copy(archive.join(from), folder.join(place).join(name))?;
    }
    let manual = folder.join("usr/share/man/man1");
    fs::create_dir_all(&manual)?;
    for page in files(&archive.join("man"))? {
        fs::copy(archive.join("man").join(&page), manual.join(&page))?;
    }
    let documents = folder.join("usr/share/doc/toyproof");
    let license = fs::read_to_string(archive.join("LICENSE-MIT"))?;
    let copyright = format!(
        "toyproof is licensed under either of Apache-2.0 (/usr/share/common-licenses/Apache-2.0) or MIT, at your option.\n\
         {THIRD_PARTY}.gz has the licenses of the libraries in it.\n\n{license}"
    );
    fs::write(documents.join("copyright"), copyright)?;
    let pages = files(&manual)?.into_iter().map(|page| manual.join(page));
    let compressed = pages.chain([documents.join("NEWS"), documents.join(THIRD_PARTY)]);
    run(Command::new("gzip").args(["-9", "-n"]).args(compressed))?;

    let sizes = files(&folder)?
        .into_iter()
        .map(|file| fs::metadata(folder.join(file)));
    let bytes = sizes
        .map(|size| size.map(|size| size.len()))
        .sum::<io::Result<u64>>()?;
    let variable = |name: &str, default: &str| env::var(name).unwrap_or_else(|_| default.to_owned());
    let name = variable("DEBFULLNAME", "toyproof");
    let address = variable("DEBEMAIL", "toyproof@localhost");
    fs::create_dir(folder.join("DEBIAN"))?;
    let control = format!(
        "Package: toyproof\n\
         Version: {VERSION}\n\
         Architecture: amd64\n\
         Maintainer: {name} <{address}>\n\
         Installed-Size: {}\n\
         Depends: libc6 (>= {GLIBC})\n\
         Recommends: libvulkan1, mesa-vulkan-drivers\n\
         Section: graphics\n\
         Priority: optional\n\
         Description: checks, renders and converts ShaderToy shaders\n \
         toyproof compares each pixel of a shader (GLSL ES 3.00) with a reference,\n \
         and reports whether a wrong image comes from the algorithm, from float32\n \
         precision, or from the compiler and driver.\n \
         .\n \
         Mesa's Vulkan driver lavapipe, which is recommended, runs shaders on the CPU\n \
         as a GPU would. Without a driver, toyproof evaluates them itself.\n",
        bytes.div_ceil(1024)
    );
    fs::write(folder.join("DEBIAN/control"), control)?;
    release.date(&folder)?;
    let package = release.out.join(format!("toyproof_{VERSION}_amd64.deb"));
    let mut dpkg = Command::new("dpkg-deb");
    dpkg.args(["--root-owner-group", "-Zxz", "--build"])
        .arg(&folder)
        .arg(package);
    run(dpkg.env("SOURCE_DATE_EPOCH", release.date.to_string()))
}

/// Checks that the program needs no later version of glibc than the one it is linked for, and no other library.
fn check_glibc(program: &Path) -> io::Result<()> {
    let mut readelf = Command::new("readelf");
    let needed = output(
        readelf
            .args(["--version-info", "--dynamic", "--wide"])
            .arg(program),
    )?;
    let number = |version: &str| -> Vec<u32> {
        let parts = version.split('.').map_while(|part| part.parse().ok());
        parts.collect()
    };
    let versions = needed.split("Name: GLIBC_").skip(1);
    let newest = versions
        .filter_map(|rest| rest.split_whitespace().next().map(number))
        .max();
    if newest > Some(number(GLIBC)) {
        return Err(io::Error::other(format!("the program needs glibc {newest:?}")));
    }
    let is_of_glibc = |line: &str| LIBRARIES.iter().any(|name| line.contains(name));
    let mut libraries = needed.lines().filter(|line| line.contains("(NEEDED)"));
    match libraries.find(|line| !is_of_glibc(line)) {
        Some(other) => Err(io::Error::other(format!(
            "not a library of glibc: {}",
            other.trim()
        ))),
        None => Ok(()),
    }
}
