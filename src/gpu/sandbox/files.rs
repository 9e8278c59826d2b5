//! Access to files: drivers read their libraries and settings, write to their caches and to the devices of
//! GPUs, and have no access to anything else.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::{env, fs};

use landlock::{
    ABI, Access, AccessFs, AccessNet, LandlockStatus, RestrictSelfAttr, Ruleset, RulesetAttr,
    RulesetCreatedAttr, RulesetError, RulesetStatus, Scope, path_beneath_rules,
};
use serde_json::Value;

use crate::device::PIN_VARIABLES;

/// The newest version of Landlock whose restrictions are requested; older kernels enforce what they know.
const NEWEST: ABI = ABI::V6;

/// The files that any driver may read: programs and their libraries, the settings of the dynamic linker and
/// of drivers, and the kernel's descriptions of devices. Not home folders, temporary files, or the keys in
/// `/etc`.
const READABLE: [&str; 28] = [
    "/usr",
    "/lib",
    "/lib32",
    "/lib64",
    "/opt",
    "/nix/store",
    "/gnu/store",
    "/app",
    "/snap",
    "/run/opengl-driver",
    "/run/host/usr",
    "/etc/ld.so.cache",
    "/etc/ld.so.conf",
    "/etc/ld.so.conf.d",
    "/etc/vulkan",
    "/etc/xdg/vulkan",
    "/etc/drirc",
    "/etc/glvnd",
    "/etc/nvidia",
    "/etc/amd",
    "/etc/passwd",
    "/etc/nsswitch.conf",
    "/etc/localtime",
    "/proc",
    "/sys",
    "/dev/urandom",
    "/dev/random",
    "/dev/zero",
];

/// The beginnings of the names in `/dev` that a GPU's driver opens: Direct Rendering Manager, NVIDIA, AMD,
/// Mali, Adreno, `PowerVR`, Windows Subsystem for Linux, and buffers shared by devices.
const DEVICES: [&str; 13] = [
    "dri", "nvidia", "nvhost", "nvmap", "nvgpu", "kfd", "mali", "kgsl", "pvr", "dxg", "udmabuf", "dma_heap",
    "null",
];

/// The folders of Mesa's caches: of files, and of one database.
const MESA_CACHES: [&str; 2] = ["mesa_shader_cache", "mesa_shader_cache_db"];

/// The folders of other caches, in that of the user's.
const OTHER_CACHES: [&str; 3] = ["mesa_shader_cache_sf", "nvidia", "AMDVLK"];

/// Reads a variable of the environment.
type Environment<'a> = &'a dyn Fn(&str) -> Option<OsString>;

/// The files that a worker may access; none by default.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct AllowedFiles {
    /// Files, and folders with all that they contain.
    read: Vec<PathBuf>,
    /// Device files, and folders of such.
    devices: Vec<PathBuf>,
    /// Folders in which files are written, created and removed.
    caches: Vec<PathBuf>,
}

impl AllowedFiles {
    /// The files that drivers need in this environment.
    pub(super) fn new(environment: Environment) -> Self {
        let mut read: Vec<PathBuf> = READABLE.iter().map(PathBuf::from).collect();
        let listed = |name: &str| -> Vec<PathBuf> {
            let list = environment(name).filter(|list| !list.is_empty());
            list.iter().flat_map(env::split_paths).collect()
        };
        if let Some(home) = environment("HOME").map(PathBuf::from) {
            let own = [".config/vulkan", ".local/share/vulkan", ".drirc"];
            read.extend(own.map(|name| home.join(name)));
        }
        let roots = [
            "XDG_CONFIG_HOME",
            "XDG_CONFIG_DIRS",
            "XDG_DATA_HOME",
            "XDG_DATA_DIRS",
        ];
        let roots = roots.iter().flat_map(|name| listed(name));
        read.extend(roots.map(|root| root.join("vulkan")));
        read.extend(listed("LD_LIBRARY_PATH"));
        let manifests = PIN_VARIABLES.iter().chain(&["VK_ADD_DRIVER_FILES"]);
        for manifest in manifests.flat_map(|name| listed(name)) {
            read.extend(libraries(&manifest));
            read.push(manifest);
        }
        Self {
            read,
            devices: devices(Path::new("/dev")),
            caches: caches(environment),
        }
    }
}

/// The folders of the libraries that a manifest names, or those in a folder. Relative ones are in its own
/// folder; without a folder, they are where all libraries are.
fn libraries(manifest: &Path) -> Vec<PathBuf> {
    if let Ok(entries) = manifest.read_dir() {
        let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
        return files
            .filter(|path| path.is_file())
            .flat_map(|path| libraries(&path))
            .collect();
    }
    let text = fs::read_to_string(manifest).unwrap_or_default();
    let json: Value = serde_json::from_str(&text).unwrap_or_default();
    let library = json["ICD"]["library_path"].as_str().map(Path::new);
    let folder = library
        .and_then(Path::parent)
        .filter(|folder| !folder.as_os_str().is_empty());
    let own = manifest.parent().unwrap_or(Path::new(""));
    folder.map(|folder| own.join(folder)).into_iter().collect()
}

fn devices(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten();
    let mut found: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            DEVICES.iter().any(|device| name.starts_with(device))
        })
        .collect();
    found.sort();
    found
}

/// The folders in which Mesa creates its caches, if it has any: as its `disk_cache_os.c` determines them.
fn mesa_caches(environment: Environment) -> Vec<PathBuf> {
    let text = |name: &str| environment(name).filter(|value| !value.is_empty());
    let is_disabled = ["MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"]
        .iter()
        .any(|name| {
            let value = text(name).map(|value| value.to_string_lossy().to_lowercase());
            value.is_some_and(|value| ["1", "true", "y", "yes"].contains(&value.as_str()))
        });
    let root = text("MESA_SHADER_CACHE_DIR")
        .or_else(|| text("MESA_GLSL_CACHE_DIR"))
        .map(PathBuf::from)
        .or_else(|| user_caches(environment));
    let root = root.filter(|_| !is_disabled);
    root.iter()
        .flat_map(|root| MESA_CACHES.map(|name| root.join(name)))
        .collect()
}

/// The folder of the user's caches.
fn user_caches(environment: Environment) -> Option<PathBuf> {
    let text = |name: &str| {
        environment(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    text("XDG_CACHE_HOME").or_else(|| Some(text("HOME")?.join(".cache")))
}

/// The folders of all caches of drivers.
fn caches(environment: Environment) -> Vec<PathBuf> {
    let mut caches = mesa_caches(environment);
    if let Some(root) = user_caches(environment) {
        caches.extend(OTHER_CACHES.map(|name| root.join(name)));
    }
    caches.extend(environment("HOME").map(|home| Path::new(&home).join(".nv")));
    caches.extend(environment("__GL_SHADER_DISK_CACHE_PATH").map(PathBuf::from));
    caches
}

/// Creates Mesa's caches. If that fails, Mesa works without.
pub(super) fn create_caches(environment: Environment) {
    for cache in mesa_caches(environment) {
        let _ = fs::create_dir_all(cache);
    }
}

/// Restricts all threads that this one starts, and where the kernel can, all others. Returns the version of
/// Landlock.
///
/// # Errors
/// Why the kernel does not restrict access to files.
pub(super) fn restrict(allowed: &AllowedFiles) -> Result<u32, String> {
    let restricted = request(allowed).map_err(|error| error.to_string())?;
    match (restricted.landlock, restricted.ruleset) {
        (LandlockStatus::NotImplemented, _) => Err("not in this kernel".to_owned()),
        (LandlockStatus::NotEnabled, _) => Err("disabled in this kernel".to_owned()),
        (LandlockStatus::Available { .. }, RulesetStatus::NotEnforced) => Err("not enforced".to_owned()),
        (
            LandlockStatus::Available {
                effective_abi,
                kernel_abi,
            },
            _,
        ) => Ok(kernel_abi.unwrap_or(effective_abi as i32).unsigned_abs()),
    }
}

fn request(allowed: &AllowedFiles) -> Result<landlock::RestrictionStatus, RulesetError> {
    let read = AccessFs::ReadFile | AccessFs::ReadDir;
    let write = read | AccessFs::WriteFile;
    let fill = write
        | AccessFs::Truncate
        | AccessFs::MakeReg
        | AccessFs::MakeDir
        | AccessFs::RemoveFile
        | AccessFs::RemoveDir
        | AccessFs::Refer;
    // Nothing is executed, no port is bound or connected to, and no signal leaves the process.
    Ruleset::default()
        .handle_access(AccessFs::from_all(NEWEST))?
        .handle_access(AccessNet::from_all(NEWEST))?
        .scope(Scope::from_all(NEWEST))?
        .create()?
        .add_rules(path_beneath_rules(&allowed.read, read))?
        .add_rules(path_beneath_rules(&allowed.devices, write | AccessFs::IoctlDev))?
        .add_rules(path_beneath_rules(&allowed.caches, fill))?
        .all_threads(true)?
        .restrict_self()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn allowed(variables: &[(&str, &str)]) -> AllowedFiles {
        AllowedFiles::new(&|name| {
            let (_, value) = variables.iter().find(|(known, _)| *known == name)?;
            Some(value.into())
        })
    }

    fn paths(paths: &[PathBuf]) -> Vec<&str> {
        paths.iter().filter_map(|path| path.to_str()).collect()
    }

    #[test]
    fn homes_and_temporary_files_are_not_readable() {
        let allowed = allowed(&[("HOME", "/home/ada"), ("XDG_DATA_DIRS", "/usr/share:/srv/data")]);
        for private in [
            "/",
            "/etc",
            "/home",
            "/home/ada",
            "/root",
            "/tmp",
            "/var",
            "/run",
            "/dev",
            "/mnt",
        ] {
            assert!(!paths(&allowed.read).contains(&private), "{private}");
        }
        for needed in [
            "/usr",
            "/home/ada/.drirc",
            "/home/ada/.config/vulkan",
            "/srv/data/vulkan",
        ] {
            assert!(paths(&allowed.read).contains(&needed), "{needed}");
        }
    }

    #[test]
    fn named_drivers_and_their_libraries_are_readable() {
        let folder = tempfile::tempdir().unwrap();
        let manifest = |name: &str, library: &str| {
            let path = folder.path().join(name);
            fs::write(&path, format!(r#"{{"ICD": {{"library_path": "{library}"}}}}"#)).unwrap();
            path
        };
        let absolute = manifest("absolute.json", "/srv/driver/lib/driver.so");
        let relative = manifest("relative.json", "../lib/driver.so");
        let plain = manifest("plain.json", "libvulkan_lvp.so");
        let broken = folder.path().join("broken.json");
        fs::write(&broken, "{").unwrap();
        assert_eq!(libraries(&absolute), [Path::new("/srv/driver/lib")]);
        assert_eq!(libraries(&relative), [folder.path().join("../lib")]);
        assert!(libraries(&plain).is_empty() && libraries(&broken).is_empty());
        assert_eq!(libraries(folder.path()).len(), 2);

        let list = [&absolute, &plain].map(|path| path.to_str().unwrap()).join(":");
        let allowed = allowed(&[("VK_DRIVER_FILES", &list), ("LD_LIBRARY_PATH", "/srv/a:/srv/b")]);
        for readable in [
            &absolute,
            &plain,
            Path::new("/srv/driver/lib"),
            Path::new("/srv/b"),
        ] {
            assert!(allowed.read.iter().any(|path| path == readable), "{readable:?}");
        }
    }

    #[test]
    fn caches_are_where_mesa_creates_them() {
        let mesa = |variables: &[(&str, &str)]| {
            let caches = allowed(variables).caches;
            let mesa = caches.iter().find(|path| path.ends_with("mesa_shader_cache"));
            mesa.and_then(|path| Some(path.parent()?.to_str()?.to_owned()))
        };
        let home = ("HOME", "/home/ada");
        let of = |path: &str| Some(path.to_owned());
        assert_eq!(mesa(&[home]), of("/home/ada/.cache"));
        assert_eq!(mesa(&[home, ("XDG_CACHE_HOME", "/c")]), of("/c"));
        assert_eq!(
            mesa(&[home, ("XDG_CACHE_HOME", "/c"), ("MESA_SHADER_CACHE_DIR", "/d")]),
            of("/d")
        );
        assert_eq!(mesa(&[home, ("MESA_SHADER_CACHE_DISABLE", "true")]), None);
        assert_eq!(
            mesa(&[home, ("MESA_SHADER_CACHE_DISABLE", "false")]),
            of("/home/ada/.cache")
        );
        assert_eq!(mesa(&[]), None);
    }

    #[test]
    fn devices_of_gpus_are_found_by_name() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "nvidia0",
            "nvidiactl",
            "nvme0n1",
            "null",
            "dri",
            "tty",
            "kfd",
            "sda",
            "mem",
        ] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let found = devices(folder.path());
        let names: Vec<_> = found
            .iter()
            .filter_map(|path| path.file_name()?.to_str())
            .collect();
        assert_eq!(names, ["dri", "kfd", "null", "nvidia0", "nvidiactl"]);
    }
}
