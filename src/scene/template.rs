//! A scene to begin with.

/// Returns the text of a small scene with comments, to be edited.
///
/// ```
/// let text = toyproof_scene::template("week 1");
/// assert!(text.contains("title = \"week 1\""));
/// ```
pub fn template(title: &str) -> String {
    let mut escaped = String::with_capacity(title.len());
    for c in title.chars() {
        match c {
            '"' | '\\' => escaped.extend(['\\', c]),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    include_str!("template.toml").replacen("TITLE", &escaped, 1)
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    #[test]
    fn the_template_is_a_scene_with_its_title_that_can_be_exported() {
        for title in ["week 1", "a \"quoted\" \\title", "two\nlines", ""] {
            let mut files = Files::default();
            let file = files.add(File::new("new.toml", template(title)));
            let scene = crate::parse(&files, file).unwrap();
            assert_eq!(scene.title, title.replace('\n', " "));
            assert_eq!((scene.objects.len(), scene.lights.len()), (3, 1));
            assert!(crate::export::shader(&scene).is_ok());
        }
    }
}
