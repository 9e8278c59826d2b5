//! Diagnostics of the front end and the lints, as the protocol has them.

use std::collections::BTreeMap;

use lsp_types::{
    Code as LspCode, CodeDescription, Diagnostic as LspDiagnostic, DiagnosticRelatedInformation,
    DiagnosticSeverity, DiagnosticTag, Location, Message, Uri,
};
use toyproof_diagnostic::{Code, Diagnostic, Severity, Span};

use crate::encoding::Encoding;
use crate::explain::Explanations;
use crate::unit::Unit;

/// The source that editors show beside a message.
pub(crate) const SOURCE: &str = "toyproof";

/// The diagnostics of a unit by the files that they are in; files without any have none.
pub(crate) fn of_unit(
    unit: &Unit,
    encoding: Encoding,
    explanations: &mut Explanations,
) -> BTreeMap<String, Vec<LspDiagnostic>> {
    let mut by_file: BTreeMap<String, Vec<LspDiagnostic>> = BTreeMap::new();
    for diagnostic in &unit.diagnostics {
        // A diagnostic about the whole text is shown at its start.
        let span = diagnostic.span.unwrap_or(Span::new(unit.own, 0, 0));
        let Some(place) = location(unit, encoding, span) else {
            continue;
        };
        let converted = convert(unit, encoding, diagnostic, &place, explanations);
        by_file.entry(place.uri.0).or_default().push(converted);
    }
    by_file
}

fn location(unit: &Unit, encoding: Encoding, span: Span) -> Option<Location> {
    let origin = unit.files.origin(span);
    let range = encoding.range(unit.files.get(origin.file), origin.start, origin.end);
    Some(Location::new(unit.uris.get(&origin.file)?.clone(), range))
}

/// A diagnostic of a unit, without the explanation of its code, for an action that refers to it.
pub(crate) fn converted(unit: &Unit, encoding: Encoding, diagnostic: &Diagnostic) -> Option<LspDiagnostic> {
    let place = location(unit, encoding, diagnostic.span?)?;
    Some(convert(
        unit,
        encoding,
        diagnostic,
        &place,
        &mut Explanations::default(),
    ))
}

fn convert(
    unit: &Unit,
    encoding: Encoding,
    diagnostic: &Diagnostic,
    place: &Location,
    explanations: &mut Explanations,
) -> LspDiagnostic {
    let related = diagnostic.related.iter().filter_map(|(span, text)| {
        let location = location(unit, encoding, *span)?;
        Some(DiagnosticRelatedInformation::new(location, text.clone()))
    });
    let related: Vec<_> = related.collect();
    LspDiagnostic {
        range: place.range,
        severity: Some(severity(diagnostic.severity)),
        code: Some(LspCode::String(diagnostic.code.as_str().to_owned())),
        code_description: explanations.href(diagnostic.code).map(CodeDescription::new),
        source: Some(SOURCE.to_owned()),
        message: Message::String(message(diagnostic)),
        tags: is_unnecessary(diagnostic.code).then(|| vec![DiagnosticTag::Unnecessary]),
        related_information: (!related.is_empty()).then_some(related),
        data: None,
    }
}

pub(crate) fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::Error,
        Severity::Warning => DiagnosticSeverity::Warning,
        Severity::Note => DiagnosticSeverity::Information,
    }
}

/// Whether the code at the place has no effect: editors show it faded.
fn is_unnecessary(code: Code) -> bool {
    matches!(code, Code::UnusedResult | Code::Uncalled | Code::UnusedAllow)
}

/// The message with its label, notes and advice, one line each.
fn message(diagnostic: &Diagnostic) -> String {
    let label = diagnostic.label.iter().map(|label| format!("\n{label}"));
    let notes = diagnostic.notes.iter().map(|note| format!("\nnote: {note}"));
    let fixes = diagnostic.fixes.iter().map(|fix| &fix.message);
    let helps = diagnostic.helps.iter().chain(fixes);
    let helps = helps.filter(|help| !diagnostic.message.contains(*help));
    let helps = helps.map(|help| format!("\nhelp: {help}"));
    let lines: String = label.chain(notes).chain(helps).collect();
    diagnostic.message.clone() + &lines
}

/// What was published last for each file: what did not change is not sent again.
#[derive(Debug, Default)]
pub(crate) struct Published {
    files: BTreeMap<String, (Option<i32>, Vec<LspDiagnostic>)>,
}

impl Published {
    /// Replaces all diagnostics, and returns those that have to be sent, with the version of each document.
    pub(crate) fn replace(
        &mut self,
        mut all: BTreeMap<String, Vec<LspDiagnostic>>,
        version: impl Fn(&Uri) -> Option<i32>,
    ) -> Vec<(Uri, Option<i32>, Vec<LspDiagnostic>)> {
        for (uri, (_, diagnostics)) in &self.files {
            if !diagnostics.is_empty() {
                all.entry(uri.clone()).or_default();
            }
        }
        // A document that is opened again is new to the client.
        self.files.retain(|uri, _| all.contains_key(uri));
        let mut changed = Vec::new();
        for (uri, diagnostics) in all {
            let key = Uri(uri.clone());
            let version = version(&key);
            let entry = (version, diagnostics);
            if self.files.get(&uri) != Some(&entry) {
                changed.push((key, version, entry.1.clone()));
                self.files.insert(uri, entry);
            }
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::of;

    /// The diagnostics of a shader.
    fn found(text: &str) -> Vec<LspDiagnostic> {
        let snapshot = of(text);
        let mut files = of_unit(&snapshot.unit, Encoding::Utf16, &mut Explanations::default());
        files.remove(&snapshot.uri.0).unwrap_or_default()
    }

    fn plain(message: &Message) -> &str {
        match message {
            Message::String(text) => text,
            Message::MarkupContent(_) => panic!("not plain"),
        }
    }

    #[test]
    fn a_diagnostic_has_its_notes_and_related_places() {
        let text = "float a;\nfloat a;\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(a); }";
        let [redeclared] = &found(text)[..] else {
            panic!("one error")
        };
        assert_eq!(redeclared.severity, Some(DiagnosticSeverity::Error));
        assert_eq!(
            (redeclared.range.start.line, redeclared.range.start.character),
            (1, 6)
        );
        let related = redeclared.related_information.as_ref().unwrap();
        assert_eq!(
            (related[0].location.range.start.line, &*related[0].message),
            (0, "previously declared here")
        );
        let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p.z, 1, 1, 1); }";
        let [swizzle] = &found(text)[..] else {
            panic!("one error")
        };
        assert_eq!(
            plain(&swizzle.message),
            "invalid swizzle `.z` of `vec2`\nits components are `.xy`"
        );
    }

    #[test]
    fn code_without_an_effect_is_marked() {
        let text = "float f() { return 1.; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(1); }";
        let warnings = found(text);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert_eq!(warnings[0].severity, Some(DiagnosticSeverity::Warning));
        assert_eq!(
            warnings[0].tags.as_deref(),
            Some(&[DiagnosticTag::Unnecessary][..])
        );
    }

    #[test]
    fn only_what_changed_is_published() {
        let mut published = Published::default();
        let error = found("void mainImage(out vec4 c, in vec2 p) { c = vec4(q); }");
        let mut publish = |files: &[(&str, &[LspDiagnostic])], version: i32| {
            let all = files
                .iter()
                .map(|(uri, found)| ((*uri).to_owned(), found.to_vec()))
                .collect();
            let changed = published.replace(all, |uri| (uri.0 == "open").then_some(version));
            changed
                .into_iter()
                .map(|(uri, version, found)| (uri.0, version, found.len()))
                .collect::<Vec<_>>()
        };
        let of = |uri: &str, version, count| (uri.to_owned(), version, count);
        assert_eq!(
            publish(&[("open", &[]), ("other", &error)], 1),
            [of("open", Some(1), 0), of("other", None, 1)]
        );
        assert_eq!(publish(&[("open", &[]), ("other", &error)], 1), []);
        assert_eq!(
            publish(&[("open", &error), ("other", &error)], 2),
            [of("open", Some(2), 1)]
        );
        assert_eq!(
            publish(&[("open", &[])], 3),
            [of("open", Some(3), 0), of("other", None, 0)]
        );
        // Closed, and opened again.
        assert_eq!(publish(&[], 1), []);
        assert_eq!(publish(&[("open", &[])], 3), [of("open", Some(3), 0)]);
    }
}
