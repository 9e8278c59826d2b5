//! The README, the book and the scripts that they name work as written.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant, UNIX_EPOCH};
use std::{env, fs};

use toyproof::image::{BLOCK_BYTES, Input};

use crate::architecture::sources;
use crate::program::toyproof;
use crate::requirements::{require_chromium, require_driver};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The Markdown files directly in a folder, relative to the root.
fn pages(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let mut pages: Vec<_> = entries
        .map(|entry| Path::new(folder).join(entry.unwrap().file_name()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .collect();
    pages.sort();
    pages
}

fn book() -> Vec<PathBuf> {
    ["docs", "docs/guide", "docs/guide/hosts", "docs/evidence"]
        .into_iter()
        .flat_map(pages)
        .collect()
}

/// A fenced block of a page.
struct Block {
    /// The word after the fence.
    language: String,
    text: String,
    /// The exit code in a comment `<!-- exit code N: reason -->` before the block.
    exit_code: i32,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut exit_code = 0;
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        if let Some(comment) = line.strip_prefix("<!-- exit code ") {
            let (code, _) = comment.split_once(':').expect("an exit code has a reason");
            exit_code = code.parse().unwrap();
        } else if let Some(language) = line.strip_prefix("```") {
            let text = lines.by_ref().take_while(|line| *line != "```");
            blocks.push(Block {
                language: language.to_owned(),
                text: text.flat_map(|line| [line, "\n"]).collect(),
                exit_code,
            });
            exit_code = 0;
        }
    }
    blocks
}

/// The block of a page whose text contains some text.
pub(crate) fn block(page: &str, text: &str) -> String {
    let blocks = blocks(&read(page)).into_iter();
    let mut found = blocks.filter(|block| block.text.contains(text));
    found
        .next()
        .unwrap_or_else(|| panic!("{page} has no block with {text}"))
        .text
}

/// What Canvas exports of the class.
const GRADEBOOK: &str = "Student,ID,SIS User ID,SIS Login ID,Section,torus (4711)\n    Points Possible,,,,,10.00\n\
                         \"Lee, Bo\",8,S8,bo,A,\n\"Smith, Anna\",7,S7,anna,A,\n\"Student, Test\",99,,test,A,\n";

/// A class of two assignments, as the page on submissions describes it, and what Moodle lets teachers
/// download.
fn class_files(folder: &Path) {
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let page = "docs/guide/submissions.md";
    let [torus, large] = ["half", "large"].map(|name| read(&format!("torus/{name}.glsl")));
    let [right, wrong] = ["anna", "mai"].map(|name| read(&format!("homework/{name}.glsl")));
    let objects = "scene = \"scene.toml\"\n[[frame]]\nsize = [160, 90]\n";
    let points = "[compiles]\npoints = 2\n[algorithm]\npoints = 8\n";
    for (path, text) in [
        ("class.toml", block(page, "[[assignment]]")),
        ("late.toml", format!("{points}{}", block(page, "percent_per_day"))),
        ("objects-task/assignment.toml", objects.to_owned()),
        ("canvas.csv", GRADEBOOK.to_owned()),
        ("objects-task/scene.toml", read("glsl/04-many-objects.toml")),
        ("moodle/Anna S_7_assignsubmission_file/torus.glsl", torus),
        ("moodle/Anna S_7_assignsubmission_file/objects.glsl", wrong),
        ("moodle/Bo Lee_8_assignsubmission_file/week1/a.glsl", large),
        ("moodle/Bo Lee_8_assignsubmission_file/my-objects.glsl", right),
        (
            "moodle/Bo Lee_8_assignsubmission_file/notes.txt",
            "I was ill.\n".to_owned(),
        ),
    ] {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        // Sunday, 2026-03-01, at noon, and Bo's last file on the Wednesday after the deadline.
        let is_late = path.ends_with("my-objects.glsl");
        let seconds = if is_late { 1_773_187_140 } else { 1_772_366_400 };
        let time = UNIX_EPOCH + Duration::from_secs(seconds);
        let file = fs::File::options().write(true).open(&path).unwrap();
        file.set_modified(time).unwrap();
    }
}

/// What the tutorials assume: a student's shader and the scene of its last part, the lines that a lecturer adds to an
/// assignment, and submissions.
fn tutorial_files(folder: &Path) {
    let (student, lecturer) = (
        "docs/guide/tutorial-student.md",
        "docs/guide/tutorial-lecturer.md",
    );
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let [half, large] = ["half", "large"].map(|name| read(&format!("torus/{name}.glsl")));
    for (path, text) in [
        ("mine.glsl", block(student, "float intersect(")),
        ("far.toml", block(student, "screen_distance")),
        ("disk.glsl", block("docs/guide/function-tests.md", "@test disk")),
        ("marbles.glsl", block("docs/guide/reducing.md", "float layers")),
        (
            "waves.frag",
            block("docs/guide/dialects.md", "uniform float speed"),
        ),
        ("additions.toml", block(lecturer, "[rules]")),
        ("download/Anna Smith_1_assignsubmission_file/torus.glsl", half),
        ("download/Bo Lee_2_assignsubmission_file/my torus.glsl", large),
        (
            "download/Max Weber_3_assignsubmission_file/notes.txt",
            "I was ill.\n".to_owned(),
        ),
    ] {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// A folder with the files that the pages assume: the course, submissions of two assignments, one of which
/// has a file, a rubric, and a class.
fn assumed_files() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(toyproof(folder.path(), &["scenes", "--write", "glsl"]).code, 0);
    let solution = fs::read_to_string(folder.path().join("glsl/04-many-objects.glsl")).unwrap();
    let edit = |from: &str, to: &str| {
        assert!(solution.contains(from), "{from}");
        solution.replacen(from, to, 1)
    };
    fs::create_dir(folder.path().join("homework")).unwrap();
    for (name, text) in [
        ("anna.glsl", solution.clone()),
        (
            "mai.glsl",
            edit("if (!inShadow(hit.point, hit.normal))", "if (true)"),
        ),
        (
            "kim.glsl",
            edit(
                "sphere.radius * sphere.radius;\n",
                "sphere.radius * sphere.radius\n",
            ),
        ),
    ] {
        fs::write(folder.path().join("homework").join(name), text).unwrap();
    }
    let torus = block("docs/guide/checking.md", "float distanceTo");
    let half = torus
        .replace("t += d;", "t += 0.5 * d;")
        .replace("d < 1e-4", "d < 1e-3");
    let large = torus.replace("length(p.xz) - 1.0", "length(p.xz) - 1.02");
    let assignment = block("docs/guide/assignments.md", "[rubric.compiles]");
    let photo = torus.replace("vec4(color, 1.0)", "vec4(pow(color, vec3(1.0 / 2.2)), 1.0)");
    for name in ["torus", "torus-task"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    for (name, text) in [
        ("torus-task/assignment.toml", assignment),
        ("torus-task/solution.glsl", torus.clone()),
        ("photo.glsl", photo),
        ("solution.glsl", torus),
        ("torus/half.glsl", half),
        ("torus/large.glsl", large),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    tutorial_files(folder.path());
    let rubric = block("docs/guide/checking.md", "[compiles]");
    fs::write(folder.path().join("rubric.toml"), rubric).unwrap();
    let scene = block("docs/guide/scenes.md", "[film]");
    fs::write(folder.path().join("example.toml"), scene).unwrap();
    class_files(folder.path());
    let export = ["export", "example.toml", "-o", "shader.glsl"];
    assert_eq!(toyproof(folder.path(), &export).code, 0);
    folder
}

/// The lines of an output, with single spaces and without the parentheses at their ends, which have times.
fn without_times(output: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(output);
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = |line: &str| match line.rsplit_once(" (") {
        Some((start, times)) if times.ends_with(')') && times.contains(" s") => words(start),
        _ => words(line),
    };
    text.lines().map(line).collect()
}

/// Runs the `$ …` lines of a page in one folder; for lines with `make`, only the target is looked up. Returns
/// their number, and adds a line to `failures` for each that ends with another exit code, or does not print
/// what the page shows.
fn run_commands(page: &Path, failures: &mut Vec<String>) -> usize {
    let folder = assumed_files();
    let program = Path::new(env!("CARGO_BIN_EXE_toyproof")).parent().unwrap();
    let path = format!("{}:{}", program.display(), env::var("PATH").unwrap());
    let mut run = 0;
    for block in blocks(&read(page)) {
        if block.language != "console" {
            continue;
        }
        let mut lines = block.text.lines().peekable();
        while let Some(line) = lines.next() {
            let Some(line) = line.strip_prefix("$ ") else {
                continue;
            };
            run += 1;
            let mut shown = Vec::new();
            while let Some(line) = lines.next_if(|line| !line.starts_with("$ ")) {
                shown.push(line);
            }
            let needs_driver = line.contains("--verify") || line.contains("doctor");
            if (needs_driver && !require_driver())
                || (line.contains("--browser") && require_chromium().is_none())
            {
                continue;
            }
            let mut shell = Command::new("sh");
            if let Some(target) = line.strip_prefix("make ") {
                shell
                    .args(["-c", &format!("make -n {target}")])
                    .current_dir(root());
            } else {
                shell
                    .args(["-c", line])
                    .current_dir(folder.path())
                    .env("PATH", &path);
            }
            let start = Instant::now();
            let output = shell.output().unwrap();
            eprintln!("{:.1} s: {line}", start.elapsed().as_secs_f64());
            if output.status.code() != Some(block.exit_code) {
                let stderr = String::from_utf8_lossy(&output.stderr);
                failures.push(format!("{}: {line}: {}\n{stderr}", page.display(), output.status));
            }
            let printed = without_times(&[output.stdout, output.stderr].concat());
            for shown in shown.iter().map(|line| without_times(line.as_bytes()).concat()) {
                if !printed.contains(&shown) {
                    let printed = printed.join("\n");
                    failures.push(format!(
                        "{}: {line}: not printed: {shown}\n{printed}",
                        page.display()
                    ));
                }
            }
        }
    }
    run
}

#[test]
fn every_command_of_the_readme_works() {
    let mut failures = Vec::new();
    assert!(run_commands(Path::new("README.md"), &mut failures) >= 8);
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_command_of_the_guide_works() {
    let pages = [pages("docs"), pages("docs/guide"), pages("docs/guide/hosts")].concat();
    let mut failures = Vec::new();
    let run: usize = pages.iter().map(|page| run_commands(page, &mut failures)).sum();
    assert!(run >= 40, "{run}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// GitHub's and mdBook's identifier of a heading.
fn slug(heading: &str) -> String {
    heading
        .to_lowercase()
        .chars()
        .filter(|character| character.is_alphanumeric() || matches!(character, ' ' | '-' | '_'))
        .map(|character| if character == ' ' { '-' } else { character })
        .collect()
}

/// The lines of a page outside of fenced blocks.
fn prose(page: &str) -> Vec<&str> {
    let mut outside = true;
    let mut lines = Vec::new();
    for line in page.lines() {
        if line.starts_with("```") {
            outside = !outside;
        } else if outside {
            lines.push(line);
        }
    }
    lines
}

/// The targets of a line's links and images.
fn links(line: &str) -> Vec<String> {
    let without_code: String = line.split('`').step_by(2).collect();
    let targets = without_code.split("](").skip(1);
    targets
        .map(|rest| rest.split(')').next().unwrap().to_owned())
        .collect()
}

/// Resolves `..` and `.` without the file system.
fn normalized(path: &Path) -> PathBuf {
    let mut result = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => assert!(result.pop(), "{} leaves the root", path.display()),
            Component::CurDir => {}
            other => result.push(other),
        }
    }
    result
}

#[test]
fn links_lead_to_files_and_headings() {
    let mut checked = 0;
    for page in [pages("."), book()].concat() {
        let page = normalized(&page);
        let text = read(&page);
        for line in prose(&text) {
            for link in links(line) {
                if link.contains("://") {
                    continue;
                }
                let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
                let target = if file.is_empty() {
                    page.clone()
                } else {
                    normalized(&page.parent().unwrap().join(file))
                };
                let place = format!("{}: {link}", page.display());
                assert!(root().join(&target).exists(), "{place}");
                // The book has no other files.
                assert!(!page.starts_with("docs") || target.starts_with("docs"), "{place}");
                if !heading.is_empty() {
                    let text = read(&target);
                    let mut headings = prose(&text).into_iter().filter(|line| line.starts_with('#'));
                    assert!(
                        headings.any(|line| slug(line.trim_start_matches('#').trim()) == heading),
                        "{place}"
                    );
                }
                checked += 1;
            }
        }
    }
    assert!(checked > 60, "{checked}");
}

#[test]
fn the_summary_lists_every_page_of_the_book() {
    let summary = read("docs/SUMMARY.md");
    let listed: BTreeSet<_> = prose(&summary)
        .into_iter()
        .flat_map(links)
        .map(|link| Path::new("docs").join(link))
        .collect();
    let mut pages: BTreeSet<_> = book().into_iter().collect();
    pages.remove(Path::new("docs/SUMMARY.md"));
    assert_eq!(listed, pages);
}

#[test]
fn pages_that_the_code_names_exist() {
    let mut named = 0;
    for folder in ["src", "tests", "benches", "examples"] {
        for path in sources(&root().join(folder)) {
            let text = fs::read_to_string(&path).unwrap();
            for rest in text.split("docs/").skip(1) {
                let end = rest.find(|character: char| {
                    !character.is_alphanumeric() && !matches!(character, '/' | '-' | '_' | '.')
                });
                let page = rest[..end.unwrap_or(rest.len())].trim_end_matches('.');
                if Path::new(page)
                    .extension()
                    .is_some_and(|extension| extension == "md")
                {
                    assert!(
                        root().join("docs").join(page).is_file(),
                        "{}: docs/{page}",
                        path.display()
                    );
                    named += 1;
                }
            }
        }
    }
    assert!(named > 5, "{named}");
}

/// Each term of the code in the glossary occurs in the crate that the glossary names.
#[test]
fn the_terms_of_the_code_exist() {
    let page = read("docs/glossary.md");
    let table = page.split("\n## Terms of the code\n").nth(1).unwrap();
    let rows = table.lines().filter(|line| line.starts_with("| ")).skip(1);
    let mut checked = 0;
    for row in rows {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        let folder = root().join("src").join(cells[3].trim_matches('`'));
        let sources = crate::architecture::sources(&folder);
        let text: String = sources
            .iter()
            .map(|path| path.to_string_lossy().into_owned() + &read(path))
            .collect();
        for term in cells[1].split('`').skip(1).step_by(2) {
            assert!(
                text.contains(term),
                "`{term}` does not occur in {}",
                folder.display()
            );
            checked += 1;
        }
    }
    assert!(checked > 40, "{checked}");
}

/// Each crate in ARCHITECTURE.md's drawing is a folder of the sources.
#[test]
fn the_drawn_crates_exist() {
    let page = read("ARCHITECTURE.md");
    let drawing = page
        .lines()
        .filter(|line| line.starts_with("    ") && line.contains('►'));
    let mut names = 0;
    for name in drawing
        .flat_map(|line| line.split(|c: char| !c.is_alphanumeric()))
        .filter(|name| !name.is_empty())
    {
        assert!(root().join("src").join(name).is_dir(), "{name}");
        names += 1;
    }
    assert!(names >= 9, "{names}");
}

#[test]
fn the_guide_describes_every_command() {
    let help = toyproof(root(), &["--help"]).stdout;
    let page = read("docs/guide/commands.md");
    let lists = help.lines().take_while(|line| *line != "Options:");
    let names: Vec<_> = lists
        .filter_map(|line| line.strip_prefix("  "))
        .filter_map(|line| line.split_whitespace().next().filter(|_| !line.starts_with(' ')))
        .collect();
    assert!(names.len() >= 18, "{help}");
    for name in names {
        let row = format!("\n| `{name}");
        let described = page.split(&row).skip(1).any(|rest| rest.starts_with([' ', '`']));
        assert!(described, "{name}");
    }
}

#[test]
fn the_pipeline_of_the_guide_is_that_of_the_example() {
    let host = read("examples/hosts/host.rs");
    let blocks = blocks(&read("docs/guide/converting.md"));
    let quoted = blocks
        .iter()
        .filter(|block| block.language == "rust" && !block.text.contains("bevy"));
    let mut count = 0;
    for block in quoted {
        assert!(host.contains(&block.text), "{}", block.text);
        count += 1;
    }
    assert_eq!(count, 3);
}

#[test]
fn the_guide_lists_the_uniform_block() {
    let page = read("docs/guide/converting.md");
    for input in Input::ALL {
        let ty = match input.length() {
            Some(length) => format!("{}[{length}], 16 bytes each", input.ty().name()),
            None => input.ty().name().to_owned(),
        };
        let row = format!("\n| `{}` | {ty} | {} |\n", input.name(), input.offset());
        assert!(page.contains(&row), "{row}");
    }
    assert!(page.contains(&format!("uniform block of {BLOCK_BYTES} bytes")));
}

/// The format that editors match.
#[test]
fn short_diagnostics_are_one_line_with_a_position() {
    let folder = assumed_files();
    let run = toyproof(
        folder.path(),
        &["check", "homework/kim.glsl", "--format", "short"],
    );
    assert_eq!(run.code, 1, "{}", run.stderr);
    let mut lines = run.stdout.lines();
    assert!(
        lines.any(|line| line.starts_with("homework/kim.glsl:55:56: error[E0100]: ")),
        "{}",
        run.stdout
    );
}

/// On a machine with an old compiler and no package manager, `setup.sh` prints commands and installs nothing.
#[cfg(target_os = "linux")]
#[test]
fn setup_names_what_provides_a_missing_tool() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let folder = tempfile::tempdir().unwrap();
    let search_path = env::var_os("PATH").unwrap();
    let find = |name: &str| {
        let mut folders = env::split_paths(&search_path).map(|folder| folder.join(name));
        folders.find(|path| path.is_file()).unwrap()
    };
    for tool in ["dirname", "id", "sed", "uname", "make"] {
        symlink(find(tool), folder.path().join(tool)).unwrap();
    }
    let add = |name: &str, prints: &str| {
        let path = folder.path().join(name);
        fs::write(&path, format!("#!/bin/sh\necho {prints}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    };
    let setup = || {
        let mut setup = Command::new(find("sh"));
        let output = setup
            .arg(root().join("setup.sh"))
            .env("PATH", folder.path())
            .output()
            .unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    add("cargo", "cargo");
    add("rustc", "rustc 1.63.0");
    let (code, stderr) = setup();
    assert_eq!(code, Some(1), "{stderr}");
    assert!(stderr.contains("rustc 1.63.0 is too old"), "{stderr}");
    assert!(stderr.contains("https://sh.rustup.rs"), "{stderr}");
    assert!(stderr.contains("C linker"), "{stderr}");

    add("rustc", "rustc 1.95.0");
    add("cc", "cc");
    let (code, stderr) = setup();
    assert_eq!(code, Some(0), "{stderr}");
}
