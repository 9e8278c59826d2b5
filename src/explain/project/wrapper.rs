//! A shader whose entry point is another function, which calls `mainImage` and changes its color.

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::tree::Item;
use toyproof_glsl::{self as glsl, Checked};

/// The name of the function, and that of its variable that holds the color.
const NAME: &str = "toyproofShown";
pub(super) const COLOR: &str = "toyproofColor";

/// The text of the function, which changes the color by `body`. `position` is an expression of the pixel's
/// place; its own place if `None`.
pub(super) fn suffix(body: &str, position: Option<&str>) -> String {
    let position = position.unwrap_or(POSITION);
    // A backslash may end the last line of the shader.
    format!(
        "\n\nvoid {NAME}(out vec4 toyproofOut, in vec2 {POSITION}) {{ vec4 {COLOR} = vec4(0.0, 0.0, 0.0, 1.0); \
         mainImage({COLOR}, {position}); {body} toyproofOut = {COLOR}; }}\n"
    )
}

/// The parameter with the place of the pixel.
pub(super) const POSITION: &str = "toyproofPosition";

/// Checks a text that takes the place of a shader's, with the function after it; `None` if that is no valid
/// shader. Without a `suffix`, the entry point stays.
pub(super) fn with_suffix(shader: &Checked, text: &str, suffix: &str) -> Option<Checked> {
    let mut files = Files::default();
    let file = files.add(File::new("<pass>", format!("{text}{suffix}")));
    let mut checked = glsl::check(&files, file, &shader.options()).ok()?;
    if !suffix.is_empty() {
        let mut functions = checked.tree.functions.iter();
        let (id, _) = functions.find(|(_, function)| function.name == NAME)?;
        // An edit may use the name of the place.
        let position = |checked: &Checked| checked.tree[checked.main_image].parameters.get(1).copied();
        let name = position(shader).map(|place| shader.tree[place].name.clone());
        checked.main_image = id;
        if let (Some(place), Some(name)) = (position(&checked), name) {
            checked.tree.variables[place].name = name;
        }
        // It is no part of the shader that an edit may change.
        checked.tree.items.retain(|item| *item != Item::Function(id));
    }
    Some(checked)
}
