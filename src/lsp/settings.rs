//! The settings of an editor, below the key `toyproof`.

use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use serde_json::Value;
use toyproof_diagnostic::{nearest, one_of};
use toyproof_glsl::Dialect;

/// What an author chose.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Settings {
    pub(crate) check: CheckSettings,
    /// Accepts what desktop GLSL accepts.
    pub(crate) lenient: bool,
    /// The host of shaders that are not part of a project; `None` to recognize it.
    pub(crate) dialect: Option<Dialect>,
    pub(crate) inlay_hints: InlayHintSettings,
    /// Further folders in which included files may lie.
    pub(crate) include_folders: Vec<PathBuf>,
}

/// Checks in the background.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CheckSettings {
    /// Whether each save starts a check.
    pub(crate) on_save: bool,
    pub(crate) scene: Option<String>,
    pub(crate) reference: Option<String>,
    pub(crate) assignment: Option<String>,
    /// The time limit of a check.
    pub(crate) timeout: Duration,
    /// What is shown of the mistake in a wrong shader; `None` for what `check` shows students of an
    /// assignment (the line), and otherwise everything.
    hints: Option<Hints>,
}

/// What is shown of the mistake in a wrong shader, see `--hints` of `check`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hints {
    None,
    Line,
    Fix,
}

/// Which inlay hints are shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct InlayHintSettings {
    pub(crate) parameter_names: bool,
    pub(crate) conversions: bool,
    /// The values of constants.
    pub(crate) constants: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            check: CheckSettings {
                on_save: true,
                scene: None,
                reference: None,
                assignment: None,
                timeout: Duration::from_secs(60),
                hints: None,
            },
            lenient: false,
            dialect: None,
            inlay_hints: InlayHintSettings {
                parameter_names: true,
                conversions: true,
                constants: false,
            },
            include_folders: Vec::new(),
        }
    }
}

/// The longest time limit of a check, in seconds.
const MAX_TIMEOUT: f64 = 3600.0;

impl Settings {
    /// Reads settings: what a client sends, with or without the key `toyproof` around it. What is missing has
    /// its default. Also returns what is wrong with the rest, one sentence each.
    pub(crate) fn read(value: &Value) -> (Self, Vec<String>) {
        let mut settings = Self::default();
        let mut problems = Vec::new();
        let value = value.get("toyproof").unwrap_or(value);
        if let Some(object) = table("toyproof", value, &mut problems) {
            for (key, value) in object {
                let problem = settings.set(key, value, &mut problems);
                problems.extend(problem.err());
            }
        }
        (settings, problems)
    }

    fn set(&mut self, key: &str, value: &Value, problems: &mut Vec<String>) -> Result<(), String> {
        // An editor may send `null` for what is not set.
        if value.is_null() {
            return Ok(());
        }
        match key {
            "check" => {
                for (key, value) in table("toyproof.check", value, problems).into_iter().flatten() {
                    let problem = self.check.set(key, value);
                    problems.extend(problem.err());
                }
            }
            "lenient" => self.lenient = boolean("toyproof.lenient", value)?,
            "dialect" => {
                let name = string("toyproof.dialect", value)?;
                self.dialect = match name.as_deref() {
                    None | Some("auto") => None,
                    Some(name) => Some(Dialect::named(name).ok_or_else(|| {
                        let names: Vec<_> = Dialect::all().map(Dialect::name).collect();
                        format!("`toyproof.dialect` must be `auto` or {}", one_of(&names))
                    })?),
                };
            }
            "inlayHints" => {
                for (key, value) in table("toyproof.inlayHints", value, problems)
                    .into_iter()
                    .flatten()
                {
                    let problem = self.inlay_hints.set(key, value);
                    problems.extend(problem.err());
                }
            }
            "includeFolders" => {
                let folders = value.as_array().map(|all| all.iter().map(Value::as_str));
                let folders: Option<Option<Vec<_>>> = folders.map(Iterator::collect);
                let folders = folders
                    .flatten()
                    .ok_or("`toyproof.includeFolders` must be a list of paths")?;
                self.include_folders = folders.into_iter().map(PathBuf::from).collect();
            }
            // Keys of extensions, which the server does not need.
            "path" | "trace" | "watch" | "debug" => {}
            _ => {
                let known = ["check", "lenient", "dialect", "inlayHints", "includeFolders"];
                return Err(unknown("toyproof", key, &known));
            }
        }
        Ok(())
    }
}

impl CheckSettings {
    /// The value of `--hints`.
    pub(crate) fn hints(&self) -> &'static str {
        match self.hints {
            Some(Hints::None) => "none",
            Some(Hints::Line) => "line",
            None if self.assignment.is_some() => "line",
            Some(Hints::Fix) | None => "fix",
        }
    }

    /// Adds the flags that name what a shader is compared with.
    pub(crate) fn add_reference(&self, command: &mut Command) {
        for (flag, value) in [
            ("--scene", &self.scene),
            ("--reference", &self.reference),
            ("--assignment", &self.assignment),
        ] {
            if let Some(value) = value {
                command.arg(flag).arg(value);
            }
        }
    }

    fn set(&mut self, key: &str, value: &Value) -> Result<(), String> {
        let name = format!("toyproof.check.{key}");
        if value.is_null() {
            return Ok(());
        }
        match key {
            "onSave" => self.on_save = boolean(&name, value)?,
            "scene" => self.scene = string(&name, value)?,
            "reference" => self.reference = string(&name, value)?,
            "assignment" => self.assignment = string(&name, value)?,
            "timeout" => {
                let seconds = value
                    .as_f64()
                    .filter(|seconds| (1.0..=MAX_TIMEOUT).contains(seconds));
                let seconds =
                    seconds.ok_or(format!("`{name}` must be a number of seconds from 1 to 3600"))?;
                self.timeout = Duration::from_secs_f64(seconds);
            }
            "hints" => {
                self.hints = match string(&name, value)?.as_deref() {
                    None => None,
                    Some("none") => Some(Hints::None),
                    Some("line") => Some(Hints::Line),
                    Some("fix") => Some(Hints::Fix),
                    Some(_) => return Err(format!("`{name}` must be `none`, `line` or `fix`")),
                };
            }
            _ => {
                let known = ["onSave", "scene", "reference", "assignment", "timeout", "hints"];
                return Err(unknown("toyproof.check", key, &known));
            }
        }
        Ok(())
    }
}

impl InlayHintSettings {
    fn set(&mut self, key: &str, value: &Value) -> Result<(), String> {
        let name = format!("toyproof.inlayHints.{key}");
        let field = match key {
            "parameterNames" => &mut self.parameter_names,
            "conversions" => &mut self.conversions,
            "constants" => &mut self.constants,
            _ => {
                let known = ["parameterNames", "conversions", "constants"];
                return Err(unknown("toyproof.inlayHints", key, &known));
            }
        };
        if !value.is_null() {
            *field = boolean(&name, value)?;
        }
        Ok(())
    }
}

fn table<'v>(
    name: &str,
    value: &'v Value,
    problems: &mut Vec<String>,
) -> Option<&'v serde_json::Map<String, Value>> {
    if !value.is_object() && !value.is_null() {
        problems.push(format!("`{name}` must be an object"));
    }
    value.as_object()
}

fn boolean(name: &str, value: &Value) -> Result<bool, String> {
    value
        .as_bool()
        .ok_or_else(|| format!("`{name}` must be true or false"))
}

/// A text; `None` for an empty one, which editors send for what is not set.
fn string(name: &str, value: &Value) -> Result<Option<String>, String> {
    let text = value
        .as_str()
        .ok_or_else(|| format!("`{name}` must be a string"))?;
    Ok(Some(text.to_owned()).filter(|text| !text.is_empty()))
}

fn unknown(table: &str, key: &str, known: &[&str]) -> String {
    let message = format!("unknown setting `{table}.{key}`");
    match nearest(key, known.iter().copied()) {
        Some(near) => format!("{message}; did you mean `{table}.{near}`?"),
        None => format!("{message}; the settings of `{table}` are {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn settings_are_read_with_and_without_their_key() {
        let inner = json!({
            "check": {"onSave": false, "scene": "02-sphere", "reference": "", "timeout": 5},
            "lenient": true, "dialect": "isf", "inlayHints": {"constants": true}, "path": null,
        });
        for value in [json!({"toyproof": inner}), inner.clone()] {
            let (settings, problems) = Settings::read(&value);
            assert_eq!(problems, [""; 0]);
            assert!(settings.lenient && !settings.check.on_save && settings.inlay_hints.constants);
            assert_eq!(settings.check.scene.as_deref(), Some("02-sphere"));
            assert_eq!(settings.check.reference, None);
            assert_eq!(settings.check.timeout, Duration::from_secs(5));
            assert_eq!(settings.dialect, Dialect::named("isf"));
        }
        assert_eq!(Settings::read(&Value::Null), (Settings::default(), Vec::new()));
    }

    #[test]
    fn unknown_keys_and_wrong_types_are_reported() {
        let value = json!({"lenint": true, "check": {"scene": 1, "timeout": 0}, "inlayHints": [], "x": 1});
        let (settings, problems) = Settings::read(&value);
        assert_eq!(settings, Settings::default());
        assert_eq!(
            problems,
            [
                "`toyproof.check.scene` must be a string",
                "`toyproof.check.timeout` must be a number of seconds from 1 to 3600",
                "`toyproof.inlayHints` must be an object",
                "unknown setting `toyproof.lenint`; did you mean `toyproof.lenient`?",
                "unknown setting `toyproof.x`; the settings of `toyproof` are check, lenient, dialect, inlayHints, includeFolders",
            ]
        );
    }
}
