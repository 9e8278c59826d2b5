//! The licenses of the crates in the program, which its distribution has to include.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// The beginnings of the names of license files.
const FILES: [&str; 5] = ["LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"];

/// What Cargo knows of the packages, with their dependencies on one platform or on all.
pub(super) fn metadata(root: &Path, target: Option<&str>) -> io::Result<Value> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--format-version", "1", "--locked"]);
    if let Some(target) = target {
        cargo.args(["--filter-platform", target]);
    }
    serde_json::from_str(&super::output(cargo.current_dir(root))?).map_err(io::Error::other)
}

/// Lists the crates that the program consists of on a platform, and the texts of their licenses, each once.
pub(super) fn of_dependencies(root: &Path, target: &str) -> io::Result<String> {
    let metadata = metadata(root, Some(target))?;
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let packages: BTreeMap<_, _> = list(&metadata["packages"])
        .into_iter()
        .map(|package| (text(&package["id"]), package))
        .collect();
    let nodes: BTreeMap<_, _> = list(&metadata["resolve"]["nodes"])
        .into_iter()
        .map(|node| (text(&node["id"]), list(&node["deps"])))
        .collect();

    // The crates reached from the program by dependencies that are not for builds or tests only.
    let program = packages.iter().find(|(_, package)| package["name"] == "toyproof");
    let mut reached: BTreeSet<_> = program.map(|(id, _)| id.clone()).into_iter().collect();
    let mut waiting: Vec<_> = reached.iter().cloned().collect();
    while let Some(id) = waiting.pop() {
        for dependency in &nodes[&id] {
            let is_normal = list(&dependency["dep_kinds"])
                .iter()
                .any(|kind| kind["kind"].is_null());
            let id = text(&dependency["pkg"]);
            if is_normal && reached.insert(id.clone()) {
                waiting.push(id);
            }
        }
    }

    let mut lines = BTreeSet::new();
    let mut users: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    // The crates of this workspace have no source.
    for package in reached
        .iter()
        .map(|id| &packages[id])
        .filter(|package| !package["source"].is_null())
    {
        let name = format!("{} {}", text(&package["name"]), text(&package["version"]));
        lines.insert(format!("{name}: {}", text(&package["license"])));
        let manifest = text(&package["manifest_path"]);
        for entry in fs::read_dir(Path::new(&manifest).parent().expect("a file is in a folder"))? {
            let entry = entry?;
            let file = entry.file_name().to_string_lossy().to_uppercase();
            if entry.file_type()?.is_file() && FILES.iter().any(|start| file.starts_with(start)) {
                let license = String::from_utf8_lossy(&fs::read(entry.path())?)
                    .trim()
                    .replace("\r\n", "\n");
                users.entry(license).or_default().insert(name.clone());
            }
        }
    }
    let mut page = "toyproof contains these crates:\n\n".to_owned();
    for line in lines {
        let _ = writeln!(page, "{line}");
    }
    for (license, users) in users {
        let users: Vec<_> = users.into_iter().collect();
        let rule = "=".repeat(80);
        let _ = write!(page, "\n{rule}\n{}\n{rule}\n\n{license}\n", users.join(", "));
    }
    Ok(page)
}
