//! The requests of features that read one document, and what the server offers of them.

use lsp_server::{ErrorCode, Request as LspRequest, Response};
use lsp_types::{
    ColorPresentationRequest, ColorProvider, CompletionOptions, CompletionRequest, CompletionResponse,
    DocumentColorRequest, DocumentSymbolProvider, DocumentSymbolRequest, DocumentSymbolResponse,
    FoldingRangeProvider, FoldingRangeRequest, Full, HoverProvider, HoverRequest, InlayHintProvider,
    InlayHintRequest, Range, Request, SelectionRangeProvider, SelectionRangeRequest, SemanticTokensOptions,
    SemanticTokensOptionsRange, SemanticTokensProvider, SemanticTokensRangeRequest, SemanticTokensRequest,
    ServerCapabilities, SignatureHelpOptions, SignatureHelpRequest, Uri, WorkspaceSymbolProvider,
    WorkspaceSymbolRequest, WorkspaceSymbolResponse,
};

use super::Server;
use super::respond::{at, respond};
use crate::color::{color_presentations, document_colors};
use crate::completion::completion;
use crate::folding::folding_ranges;
use crate::hover::hover;
use crate::inlay_hint::inlay_hints;
use crate::outline::{document_symbols, workspace_symbols};
use crate::selection::selection_range;
use crate::semantic::{self, semantic_tokens};
use crate::signature::signature_help;
use crate::snapshot::Snapshot;

/// The capabilities for these requests.
pub(super) fn capabilities() -> ServerCapabilities {
    let characters = |all: &str| Some(all.chars().map(String::from).collect());
    ServerCapabilities {
        hover_provider: Some(HoverProvider::Bool(true)),
        completion_provider: Some(CompletionOptions {
            trigger_characters: characters(".#"),
            ..CompletionOptions::default()
        }),
        signature_help_provider: Some(SignatureHelpOptions {
            trigger_characters: characters("(,"),
            retrigger_characters: characters(")"),
            ..SignatureHelpOptions::default()
        }),
        document_symbol_provider: Some(DocumentSymbolProvider::Bool(true)),
        workspace_symbol_provider: Some(WorkspaceSymbolProvider::Bool(true)),
        folding_range_provider: Some(FoldingRangeProvider::Bool(true)),
        selection_range_provider: Some(SelectionRangeProvider::Bool(true)),
        semantic_tokens_provider: Some(SemanticTokensProvider::SemanticTokensOptions(
            SemanticTokensOptions {
                legend: semantic::legend(),
                range: Some(SemanticTokensOptionsRange::Bool(true)),
                full: Some(Full::Bool(true)),
                ..SemanticTokensOptions::default()
            },
        )),
        inlay_hint_provider: Some(InlayHintProvider::Bool(true)),
        color_provider: Some(ColorProvider::Bool(true)),
        ..ServerCapabilities::default()
    }
}

/// Answers one of these requests; any other is unknown.
pub(super) fn answer(server: &mut Server, request: LspRequest) -> Response {
    match request.method.as_str().into() {
        HoverRequest::METHOD => respond::<HoverRequest>(request, |parameters| {
            let place = parameters.text_document_position_params;
            at(server, &place, hover).flatten()
        }),
        CompletionRequest::METHOD => respond::<CompletionRequest>(request, |parameters| {
            let place = parameters.text_document_position_params;
            at(server, &place, completion).map(CompletionResponse::CompletionList)
        }),
        SignatureHelpRequest::METHOD => respond::<SignatureHelpRequest>(request, |parameters| {
            let place = parameters.text_document_position_params;
            at(server, &place, signature_help).flatten()
        }),
        DocumentSymbolRequest::METHOD => respond::<DocumentSymbolRequest>(request, |parameters| {
            let symbols = of(server, &parameters.text_document.uri, document_symbols)?;
            Some(DocumentSymbolResponse::DocumentSymbolList(symbols))
        }),
        WorkspaceSymbolRequest::METHOD => respond::<WorkspaceSymbolRequest>(request, |parameters| {
            let snapshots = server.workspace.snapshots();
            let symbols = workspace_symbols(&snapshots, &parameters.query);
            Some(WorkspaceSymbolResponse::SymbolInformationList(symbols))
        }),
        FoldingRangeRequest::METHOD => respond::<FoldingRangeRequest>(request, |parameters| {
            of(server, &parameters.text_document.uri, folding_ranges)
        }),
        SelectionRangeRequest::METHOD => respond::<SelectionRangeRequest>(request, |parameters| {
            of(server, &parameters.text_document.uri, |snapshot| {
                let positions = parameters.positions.iter();
                let bytes = positions.map(|&position| snapshot.encoding.byte(snapshot.file(), position));
                bytes.map(|byte| selection_range(snapshot, byte)).collect()
            })
        }),
        SemanticTokensRequest::METHOD => respond::<SemanticTokensRequest>(request, |parameters| {
            of(server, &parameters.text_document.uri, |snapshot| {
                semantic_tokens(snapshot, None)
            })
        }),
        SemanticTokensRangeRequest::METHOD => respond::<SemanticTokensRangeRequest>(request, |parameters| {
            of(server, &parameters.text_document.uri, |snapshot| {
                semantic_tokens(snapshot, Some(bytes(snapshot, parameters.range)))
            })
        }),
        InlayHintRequest::METHOD => respond::<InlayHintRequest>(request, |parameters| {
            let snapshot = server.workspace.snapshot(&parameters.text_document.uri)?;
            let mut hints = inlay_hints(&snapshot, bytes(&snapshot, parameters.range));
            let (uri, range) = (&snapshot.uri, parameters.range);
            hints.extend(
                server
                    .pixels
                    .hints(uri, snapshot.file(), range, snapshot.encoding),
            );
            Some(hints)
        }),
        DocumentColorRequest::METHOD => respond::<DocumentColorRequest>(request, |parameters| {
            of(server, &parameters.text_document.uri, document_colors).unwrap_or_default()
        }),
        ColorPresentationRequest::METHOD => respond::<ColorPresentationRequest>(request, |parameters| {
            let presentations = of(server, &parameters.text_document.uri, |snapshot| {
                color_presentations(snapshot, parameters.color, bytes(snapshot, parameters.range))
            });
            presentations.unwrap_or_default()
        }),
        _ => {
            let message = format!("unknown request `{}`", request.method);
            Response::new_err(request.id, ErrorCode::MethodNotFound as i32, message)
        }
    }
}

/// The bytes of a range of a document.
fn bytes(snapshot: &Snapshot, range: Range) -> (u32, u32) {
    let byte = |position| snapshot.encoding.byte(snapshot.file(), position);
    (byte(range.start), byte(range.end))
}

/// The result of a feature for a whole document; `None` for a document that is not an open shader.
fn of<T>(server: &mut Server, uri: &Uri, feature: impl FnOnce(&Snapshot) -> T) -> Option<T> {
    server.workspace.snapshot(uri).map(|snapshot| feature(&snapshot))
}
