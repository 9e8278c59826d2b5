//! The requests: each is read, answered by its feature, and written.

use lsp_server::{Request as LspRequest, Response};
use lsp_types::{
    CodeActionRequest, CodeLensRequest, DefinitionRequest, DocumentFormattingRequest,
    DocumentHighlightRequest, DocumentRangeFormattingRequest, ExecuteCommandRequest, PrepareRenameRequest,
    ReferencesRequest, RenameRequest, Request,
};

use super::respond::{at, place, respond, try_respond};
use super::{Server, reading};
use crate::code_actions::code_actions;
use crate::formatting::format;
use crate::navigation::{definition, highlights, references};
use crate::rename;

/// Answers a request.
pub(super) fn answer(server: &mut Server, request: LspRequest) -> Response {
    match request.method.as_str().into() {
        DefinitionRequest::METHOD => respond::<DefinitionRequest>(request, |parameters| {
            at(server, &parameters.text_document_position_params, definition).flatten()
        }),
        ReferencesRequest::METHOD => respond::<ReferencesRequest>(request, |parameters| {
            let with_declaration = parameters.context.include_declaration;
            let (snapshot, byte) = place(server, &parameters.text_document_position_params)?;
            references(&mut server.workspace, &snapshot, byte, with_declaration)
        }),
        DocumentHighlightRequest::METHOD => respond::<DocumentHighlightRequest>(request, |parameters| {
            let (snapshot, byte) = place(server, &parameters.text_document_position_params)?;
            highlights(&mut server.workspace, &snapshot, byte)
        }),
        PrepareRenameRequest::METHOD => try_respond::<PrepareRenameRequest>(request, |parameters| {
            let (snapshot, byte) =
                place(server, &parameters.text_document_position_params).ok_or(NO_SHADER)?;
            rename::prepare(&snapshot, byte).map(Some)
        }),
        RenameRequest::METHOD => try_respond::<RenameRequest>(request, |parameters| {
            let (snapshot, byte) =
                place(server, &parameters.text_document_position_params).ok_or(NO_SHADER)?;
            rename::rename(&mut server.workspace, &snapshot, byte, &parameters.new_name).map(Some)
        }),
        CodeActionRequest::METHOD => respond::<CodeActionRequest>(request, |parameters| {
            let snapshot = server.workspace.snapshot(&parameters.text_document.uri)?;
            let only = parameters.context.only.unwrap_or_default();
            let found = server.found_fix(&snapshot);
            Some(code_actions(
                &mut server.workspace,
                &snapshot,
                parameters.range,
                &only,
                found,
            ))
        }),
        DocumentFormattingRequest::METHOD => {
            try_respond::<DocumentFormattingRequest>(request, |parameters| {
                let snapshot = server.workspace.snapshot(&parameters.text_document.uri);
                format(&snapshot.ok_or(NO_SHADER)?, None).map(Some)
            })
        }
        DocumentRangeFormattingRequest::METHOD => {
            try_respond::<DocumentRangeFormattingRequest>(request, |parameters| {
                let snapshot = server.workspace.snapshot(&parameters.text_document.uri);
                let snapshot = snapshot.ok_or(NO_SHADER)?;
                let byte = |position| snapshot.encoding.byte(snapshot.file(), position);
                let part = byte(parameters.range.start)..byte(parameters.range.end);
                format(&snapshot, Some(&part)).map(Some)
            })
        }
        CodeLensRequest::METHOD => respond::<CodeLensRequest>(request, |parameters| {
            Some(server.lenses(&parameters.text_document.uri))
        }),
        ExecuteCommandRequest::METHOD => try_respond::<ExecuteCommandRequest>(request, |parameters| {
            let arguments = parameters.arguments.unwrap_or_default();
            server.execute(&parameters.command, &arguments).map(Some)
        }),
        _ => reading::answer(server, request),
    }
}

/// Why there is no answer.
const NO_SHADER: &str = "this is not an open shader";
