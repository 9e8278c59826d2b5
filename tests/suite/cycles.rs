//! Import cycles inside a crate are small: whoever reads a file of a cycle has to read the others too.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use syn::visit::{self, Visit};
use syn::{Attribute, File, Item, ItemMod, ItemUse, Meta, Path as SynPath, UseTree};

use crate::architecture::sources;

/// The largest number of files in a cycle.
const MAX_FILES: usize = 8;

/// The front end is one cycle on purpose: the parser asks the checker for typed nodes.
const FRONT_END: (&str, usize) = ("glsl", 14);

/// A module, as the names on the way from its crate's root.
type Module = Vec<String>;

/// The modules of a crate, each with those that it imports from.
type Imports = BTreeMap<Module, BTreeSet<Module>>;

/// Reads the imports of the files in a crate's folder, except those of tests.
fn imports(root: &Path) -> Imports {
    let mut files = BTreeMap::new();
    for path in sources(root) {
        let inside = path.strip_prefix(root).unwrap();
        let mut module: Module = inside
            .with_extension("")
            .iter()
            .map(|part| part.to_str().unwrap().to_owned())
            .collect();
        let is_nested_crate = root == Path::new("src") && module.len() > 1 && module[0] != "cli";
        if is_nested_crate || module.iter().any(|part| part == "tests" || part == "main") {
            continue;
        }
        if module.last().is_some_and(|name| name == "mod" || name == "lib") {
            module.pop();
        }
        files.insert(module, fs::read_to_string(path).unwrap());
    }
    let modules: BTreeSet<Module> = files.keys().cloned().collect();
    let imports = files.into_iter().map(|(module, text)| {
        let file: File = syn::parse_str(&text).unwrap();
        let mut collector = Collector {
            modules: &modules,
            here: module.clone(),
            found: BTreeSet::new(),
        };
        collector.visit_file(&file);
        collector.found.remove(&module);
        (module, collector.found)
    });
    imports.collect()
}

/// Collects the modules that a file names.
struct Collector<'a> {
    modules: &'a BTreeSet<Module>,
    here: Module,
    found: BTreeSet<Module>,
}

impl Collector<'_> {
    /// Adds the module of a path that starts at the crate, at this module or at its parent.
    fn add(&mut self, path: &[String]) {
        let mut full = match path.first().map(String::as_str) {
            Some("crate") => Module::new(),
            Some("self" | "super") => self.here.clone(),
            _ => return,
        };
        for part in path {
            match part.as_str() {
                "crate" | "self" => {}
                "super" => {
                    full.pop();
                }
                name => full.push(name.to_owned()),
            }
        }
        while !self.modules.contains(&full) {
            full.pop();
        }
        self.found.insert(full);
    }

    fn add_tree(&mut self, tree: &UseTree, path: &mut Vec<String>) {
        let length = path.len();
        match tree {
            UseTree::Path(step) => {
                path.push(step.ident.to_string());
                self.add_tree(&step.tree, path);
            }
            UseTree::Group(group) => {
                for item in &group.items {
                    self.add_tree(item, path);
                }
            }
            UseTree::Name(name) => {
                path.push(name.ident.to_string());
                self.add(path);
            }
            UseTree::Rename(rename) => {
                path.push(rename.ident.to_string());
                self.add(path);
            }
            UseTree::Glob(_) => self.add(path),
        }
        path.truncate(length);
    }
}

/// Whether an item belongs to tests.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string().contains("test"),
        Meta::Path(path) => path.is_ident("test"),
        Meta::NameValue(_) => false,
    })
}

impl<'ast> Visit<'ast> for Collector<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Const(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            Item::Mod(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if !is_test(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, item: &'ast ItemMod) {
        self.here.push(item.ident.to_string());
        visit::visit_item_mod(self, item);
        self.here.pop();
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.add_tree(&item.tree, &mut Vec::new());
    }

    fn visit_path(&mut self, path: &'ast SynPath) {
        let segments = path.segments.iter();
        let names: Vec<_> = segments.map(|segment| segment.ident.to_string()).collect();
        if names.len() > 1 {
            self.add(&names);
        }
        visit::visit_path(self, path);
    }
}

/// The modules that a module reaches.
fn reachable<'a>(imports: &'a Imports, from: &'a Module) -> BTreeSet<&'a Module> {
    let mut found = BTreeSet::new();
    let mut left = vec![from];
    while let Some(module) = left.pop() {
        for next in &imports[module] {
            if found.insert(next) {
                left.push(next);
            }
        }
    }
    found
}

/// The files of the largest cycle.
fn largest_cycle(imports: &Imports) -> Vec<&Module> {
    let reached: BTreeMap<_, _> = imports
        .keys()
        .map(|module| (module, reachable(imports, module)))
        .collect();
    let cycles = reached.iter().map(|(&module, others)| {
        let others = others.iter().copied();
        others.filter(|other| reached[other].contains(module)).collect()
    });
    cycles.max_by_key(Vec::len).unwrap_or_default()
}

#[test]
fn import_cycles_are_small() {
    let mut roots = vec![Path::new("src").to_owned()];
    for entry in fs::read_dir("src").unwrap() {
        let folder = entry.unwrap().path();
        if folder.join("Cargo.toml").is_file() {
            roots.push(folder);
        }
    }
    for root in roots {
        let imports = imports(&root);
        assert!(imports.len() > 1, "{} has no files", root.display());
        let cycle = largest_cycle(&imports);
        let names: Vec<_> = cycle.iter().map(|module| module.join("/")).collect();
        let limit = if root.ends_with(FRONT_END.0) {
            FRONT_END.1
        } else {
            MAX_FILES
        };
        assert!(
            cycle.len() <= limit,
            "{}: {} files import from each other: {}",
            root.display(),
            cycle.len(),
            names.join(", ")
        );
    }
}

#[test]
fn cycles_are_found() {
    let module = |name: &str| vec![name.to_owned()];
    let imports: Imports = [("a", "b"), ("b", "c"), ("c", "b"), ("d", "a")]
        .into_iter()
        .map(|(from, to)| (module(from), BTreeSet::from([module(to)])))
        .collect();
    assert_eq!(largest_cycle(&imports), [&module("b"), &module("c")]);
}
