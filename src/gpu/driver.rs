//! Which Vulkan drivers the system has installed, before any is loaded.

use std::env;
use std::path::{Path, PathBuf};

/// How to get the driver that everything is measured on.
pub const INSTALL_HINT: &str = "install Mesa's lavapipe: apt-get install mesa-vulkan-drivers libvulkan1 \
                                (Fedora: dnf install mesa-vulkan-drivers vulkan-loader; \
                                Arch: pacman -S vulkan-swrast vulkan-icd-loader)";

/// The variables by which a user pins drivers: the loader's present one and its older one.
pub(super) const PINS: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// Whether the user chose drivers through the loader's own variables; then we do not.
#[must_use]
pub fn is_pinned_by_user() -> bool {
    PINS.iter().any(|name| env::var_os(name).is_some())
}

/// The manifests that the user names through those variables; none if the user names none.
#[must_use]
pub fn pinned() -> Option<Vec<PathBuf>> {
    let list = PINS.iter().find_map(env::var_os)?;
    Some(env::split_paths(&list).collect())
}

/// The manifests of all installed drivers, in the loader's order of search.
#[must_use]
pub fn manifests() -> Vec<PathBuf> {
    let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let list = |name: &str, default: &str| -> Vec<PathBuf> {
        let value = env::var_os(name).filter(|value| !value.is_empty());
        env::split_paths(&value.unwrap_or_else(|| default.into())).collect()
    };
    let mut roots = vec![home.join(".config")];
    roots.extend(list("XDG_CONFIG_DIRS", "/etc/xdg"));
    roots.push("/etc".into());
    roots.push(home.join(".local/share"));
    roots.extend(list("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
    let mut found: Vec<PathBuf> = Vec::new();
    for folder in roots.iter().map(|root| root.join("vulkan/icd.d")) {
        let mut here: Vec<_> = folder
            .read_dir()
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
            .filter(|path| !found.contains(path))
            .collect();
        here.sort();
        found.extend(here);
    }
    found
}

/// lavapipe's manifest, for this machine's architecture where several are installed.
#[must_use]
pub fn lavapipe_manifest() -> Option<PathBuf> {
    choose_lavapipe(manifests())
}

fn choose_lavapipe(manifests: Vec<PathBuf>) -> Option<PathBuf> {
    let name = |path: &Path| {
        path.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let mut ours: Vec<_> = manifests
        .into_iter()
        .filter(|path| name(path).starts_with("lvp_icd."))
        .collect();
    ours.sort_by_key(|path| !name(path).contains(env::consts::ARCH));
    ours.into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lavapipe_of_this_architecture_is_chosen() {
        let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
        let ours = format!("/b/lvp_icd.{}.json", env::consts::ARCH);
        let all = paths(&["/a/radeon_icd.x86_64.json", "/b/lvp_icd.other.json", &ours]);
        assert_eq!(choose_lavapipe(all), Some(PathBuf::from(ours)));
        let one = paths(&["/b/lvp_icd.json"]);
        assert_eq!(choose_lavapipe(one.clone()), Some(one[0].clone()));
        assert_eq!(choose_lavapipe(paths(&["/a/intel_icd.json"])), None);
    }
}
