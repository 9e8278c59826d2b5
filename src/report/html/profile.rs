//! The page of a profile: the source of each pass beside the operations of its lines.

use std::collections::HashMap;
use std::fmt::Write;

use toyproof_diagnostic::{FileId, Files, grouped};
use toyproof_verify::profile::{LineProfile, ShaderProfile};

use super::{Text, head, sentence};
use crate::ProfiledPass;

/// Formats the page of the profile of a shader: self-contained, without a script.
#[must_use]
pub fn profile_html(name: &str, passes: &[ProfiledPass<'_>], files: &Files) -> String {
    let title = format!("toyproof run --profile: {}", Text(name));
    let articles: String = passes.iter().map(|pass| article(pass, files)).collect();
    format!(
        "{}<body>\n<header class=\"page\">\n<h1>{title}</h1>\n<p>Operations of the image in float32, before any \
         optimization: one for each component, and for functions such as <code>sin</code> those that compute \
         them.</p>\n</header>\n<main id=\"main\">\n{articles}</main>\n</body>\n</html>\n",
        head(&title)
    )
}

fn article(pass: &ProfiledPass<'_>, files: &Files) -> String {
    let profile = pass.profile;
    let (most, [x, y]) = profile.largest;
    let mut html = "<article>\n".to_owned();
    if let Some(name) = pass.name {
        let _ = writeln!(html, "<h2>{}</h2>", Text(name));
    }
    let _ = writeln!(
        html,
        "<p>{:.1} operations per pixel, at most {} at ({x}, {y}).</p>",
        profile.per_pixel(profile.operations),
        grouped(most)
    );
    html += &functions(profile);
    html += &unused(profile, files);
    for &file in &pass.sources {
        html += &source(profile, file, files);
    }
    html + "</article>\n"
}

fn functions(profile: &ShaderProfile) -> String {
    let rows = profile.functions.iter().map(|function| {
        format!(
            "<tr><th scope=\"row\"><code>{}</code></th><td>{:.1}&nbsp;%</td><td>{:.1}&nbsp;%</td><td>{:.2}</td></tr>\n",
            Text(&function.name),
            profile.share(function.total),
            profile.share(function.own),
            profile.per_pixel(function.calls)
        )
    });
    format!(
        "<table>\n<thead><tr><th>function</th><th>total</th><th>own</th><th>calls per pixel</th></tr></thead>\n\
         <tbody>\n{}</tbody>\n</table>\n",
        rows.collect::<String>()
    )
}

fn unused(profile: &ShaderProfile, files: &Files) -> String {
    let parts = profile.unexecuted.iter().map(|part| {
        let line = files.position(part.at).line;
        format!("line {line}: {}", part.description())
    });
    let names = [("called", &profile.uncalled), ("read", &profile.unread)].into_iter();
    let names = names.filter(|(_, names)| !names.is_empty());
    let names = names.map(|(what, names)| format!("never {what}: {}", names.join(", ")));
    let mut items = String::new();
    for item in parts.chain(names) {
        items.extend(["<li>", &sentence(&item), "</li>\n"]);
    }
    if items.is_empty() {
        return items;
    }
    format!("<h3>Never in this frame</h3>\n<ul>\n{items}</ul>\n")
}

/// Formats a source: of each line its share as a bar, its operations and executions per pixel, and its text.
fn source(profile: &ShaderProfile, file: FileId, files: &Files) -> String {
    let own = profile.lines.iter().filter(|line| line.file == file);
    let by_line: HashMap<usize, &LineProfile> = own.map(|line| (line.line, line)).collect();
    // The lines are sorted by their operations.
    let most = profile.lines.first().map_or(1, |line| line.operations.max(1));
    let rows = files.get(file).text().lines().zip(1..).map(|(text, number)| {
        let counts = match by_line.get(&number) {
            Some(line) => format!(
                "<td><meter max=\"{most}\" value=\"{}\"></meter></td><td>{:.1}</td><td>{}</td>",
                line.operations,
                profile.per_pixel(line.operations),
                line.executions
                    .map_or_else(String::new, |count| format!("{:.2}×", profile.per_pixel(count)))
            ),
            None => "<td></td><td></td><td></td>".to_owned(),
        };
        format!(
            "<tr>{counts}<th scope=\"row\">{number}</th><td><pre><code>{}</code></pre></td></tr>\n",
            Text(text)
        )
    });
    format!(
        "<h3>{}</h3>\n<div class=\"source\" tabindex=\"0\" role=\"region\" aria-label=\"Source\">\n\
         <table class=\"profile\">\n<thead><tr><th></th><th>operations</th><th>executed</th><th>line</th><th></th>\
         </tr></thead>\n<tbody>\n{}</tbody>\n</table>\n</div>\n",
        Text(files.get(file).name()),
        rows.collect::<String>()
    )
}
