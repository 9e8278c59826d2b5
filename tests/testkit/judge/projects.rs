//! A project: the site's JSON, or a `project.toml` beside tabs. Both forms hold the same, so each is converted to the
//! other and back.

use std::time::Duration;

use serde_json::Value;
use toyproof::diagnostic::{Diagnostics, File, Files};
use toyproof::glsl::Options;
use toyproof::project::{PassKind, Project, Tab, check};

use super::within;

/// Whether a text is a project.
///
/// # Panics
/// If reading, writing or checking it does, or takes more than `allowed` of a processor; if a rejected file has no
/// error; if the project changes between its forms.
pub fn judge(text: &str, allowed: Duration) -> bool {
    within(allowed, || {
        let mut files = Files::default();
        let file = files.add(File::new("project", text));
        let read = if Project::is_json(text) {
            Project::from_json(&mut files, file)
        } else {
            let tabs = [Tab::Common, Tab::Pass(PassKind::Image)];
            let tabs = tabs.map(|tab| (tab, files.add(File::new(tab.file_name(), code(tab)))));
            Project::from_folder(&files, Some(file), &tabs)
        };
        match read {
            Err(errors) => {
                assert!(
                    errors.to_string().contains("error["),
                    "rejected without an error: {errors}"
                );
                false
            }
            Ok(project) => {
                convert(&project, text, &mut files);
                true
            }
        }
    })
}

fn code(tab: Tab) -> &'static str {
    match tab {
        Tab::Common => "float one() { return 1.0; }\n",
        Tab::Pass(_) => "void mainImage(out vec4 c, in vec2 p) { c = vec4(one()); }\n",
    }
}

/// Exports a project that was read from a text, imports and exports that again, and checks its tabs.
fn convert(project: &Project, text: &str, files: &mut Files) {
    let json = project.to_json(files);
    if Project::is_json(text)
        && let Ok(before) = serde_json::from_str::<Value>(text)
    {
        let after: Value = serde_json::from_str(&json).unwrap_or_else(|error| panic!("{error}: {json}"));
        assert_eq!(after, before, "an export holds what was imported");
    }
    let file = files.add(File::new("exported", &*json));
    let imported = must(Project::from_json(files, file), &json);
    assert_eq!(imported.to_json(files), json);

    let toml = project.to_toml();
    let file = files.add(File::new("project.toml", &*toml));
    let folder = must(Project::from_folder(files, Some(file), project.tabs()), &toml);
    assert_eq!(folder.to_json(files), json, "{toml}");
    let _ = check(project, files, &Options::default());
}

fn must(read: Result<Project, Diagnostics>, text: &str) -> Project {
    read.unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}
