//! A shader whose entry point is another function, which calls `mainImage` and changes its color.

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::tree::Item;
use toyproof_glsl::{self as glsl, Checked};

/// The name of the entry point.
const NAME: &str = "toyproofShown";

/// The name of the entry point's variable that holds the color.
pub(super) const COLOR: &str = "toyproofColor";

/// The text of the entry point, which changes the color by `body`. `position` is an expression of the place
/// that the color is from; `None` for the pixel's own place.
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

/// Checks a text that takes the place of a shader's, followed by a new entry point; `None` if that is no
/// valid shader. With an empty `suffix`, `mainImage` stays the entry point.
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
        // The new entry point is no part of the shader that an edit may change.
        checked.tree.items.retain(|item| *item != Item::Function(id));
    }
    Some(checked)
}
