//! Reports of earlier runs.

use std::path::Path;

use toyproof_diagnostic::path_name;
use toyproof_image::input;
use toyproof_project::files::NOT_UTF8;
use toyproof_report::Earlier;

use crate::cli::CliError;

/// Reads an earlier report that `--compare` or `--costs` names, if any.
pub(super) fn earlier(path: Option<&Path>) -> Result<Option<Earlier>, CliError> {
    let Some(path) = path else {
        return Ok(None);
    };
    let file = if path.is_dir() {
        path.join("verdict.json")
    } else {
        path.to_owned()
    };
    let name = path_name(&file);
    let bytes = input::read(&file).map_err(|error| error.to_string());
    let text = bytes.and_then(|bytes| String::from_utf8(bytes).map_err(|_| NOT_UTF8.to_owned()));
    let earlier = text.and_then(|text| Earlier::parse(name.clone(), &text));
    Ok(Some(earlier.map_err(|error| {
        format!("{name} is not an earlier report: {error}")
    })?))
}
