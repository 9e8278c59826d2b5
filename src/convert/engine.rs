//! The code that plays the passes of a project in an engine: a template with the graph as a literal in its
//! language.

use toyproof_player::BUFFERS;
use toyproof_translate::c_family::CHost;

use crate::graph::{GraphFile, HostGraph};
use crate::passes::GraphContent;
use crate::project::HostFile;

/// The code of an engine.
struct Player {
    /// The script, in which `$graph` is the graph.
    script: (&'static str, &'static str),
    /// The other files.
    others: &'static [(&'static str, &'static str)],
    /// What precedes the graph in the script.
    before: &'static str,
    /// What follows it.
    after: &'static str,
    /// How quotation marks are written in the graph.
    quote: &'static str,
}

fn player(host: CHost) -> Option<Player> {
    match host {
        // The dictionaries of GDScript are written like JSON.
        CHost::Godot => Some(Player {
            script: ("player.gd", include_str!("engines/godot.gd")),
            others: &[("main.tscn", include_str!("engines/godot.tscn"))],
            before: "const GRAPH := ",
            after: "\n\n## The key codes",
            quote: "\"",
        }),
        CHost::Unity => Some(Player {
            script: ("ShaderToyPlayer.cs", include_str!("engines/unity.cs")),
            others: &[],
            before: "const string GraphText = @\"",
            after: "\";\n\n        // JsonUtility",
            quote: "\"\"",
        }),
        _ => None,
    }
}

/// The files that play the graph of a project in an engine; the script is last. `None` for hosts that read the
/// graph's own file.
pub(crate) fn files(host: CHost, graph: &GraphFile, name: &str) -> Option<Vec<HostFile>> {
    let Player {
        script,
        others,
        quote,
        ..
    } = player(host)?;
    let graph = graph.to_json().replace('"', quote);
    let text = script.1.replacen("$name", &identifier(name), 1);
    let script = (script.0, text.replacen("$graph", graph.trim_end(), 1));
    let others = others.iter().map(|&(name, text)| (name, text.to_owned()));
    let files = others.chain([script]).map(|(name, text)| HostFile { name, text });
    Some(files.collect())
}

/// Reads the graph from a script again.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn read(host: CHost, host_graph: &HostGraph, script: &str) -> Result<GraphContent, String> {
    let player = player(host).ok_or("no script")?;
    let graph = script
        .split_once(player.before)
        .and_then(|(_, rest)| rest.split_once(player.after));
    let (graph, _) = graph.ok_or("the script has no graph")?;
    host_graph.read(&graph.replace(player.quote, "\""))
}

/// A name in a language with the syntax of C.
fn identifier(name: &str) -> String {
    let plain = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    format!("_{}", plain.collect::<String>())
}

/// What an engine does not have, of what a graph needs.
pub(crate) fn missing(host: CHost, host_graph: &HostGraph) -> Option<&'static str> {
    let has_mipmaps = (0..BUFFERS).any(|buffer| host_graph.graph.has_mipmaps(buffer));
    (host == CHost::Godot && has_mipmaps)
        .then_some("it reads mipmaps of a buffer, which viewports of Godot do not have")
}
