//! Reading the parameters of a request, and writing its answer.

use lsp_server::{ErrorCode, Request as LspRequest, Response};
use lsp_types::{Request, TextDocumentPositionParams};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Server;
use crate::snapshot::Snapshot;

/// Reads the parameters of a request, and writes its result.
pub(super) fn respond<R: Request>(request: LspRequest, run: impl FnOnce(R::Params) -> R::Result) -> Response
where
    R::Params: DeserializeOwned,
    R::Result: Serialize,
{
    try_respond::<R>(request, |parameters| Ok(run(parameters)))
}

/// Reads the parameters of a request, and writes its result, or the reason why there is none, which editors
/// show.
pub(super) fn try_respond<R: Request>(
    request: LspRequest,
    run: impl FnOnce(R::Params) -> Result<R::Result, String>,
) -> Response
where
    R::Params: DeserializeOwned,
    R::Result: Serialize,
{
    match serde_json::from_value(request.params) {
        Ok(parameters) => match run(parameters) {
            Ok(result) => Response::new_ok(request.id, result),
            Err(reason) => Response::new_err(request.id, ErrorCode::RequestFailed as i32, reason),
        },
        Err(error) => {
            let message = format!("`{}` is malformed: {error}", request.method);
            Response::new_err(request.id, ErrorCode::InvalidParams as i32, message)
        }
    }
}

/// The result of a feature at a position of a document, which gets the byte of the analyzed text.
pub(super) fn at<T>(
    server: &mut Server,
    parameters: &TextDocumentPositionParams,
    feature: impl FnOnce(&Snapshot, u32) -> T,
) -> Option<T> {
    let (snapshot, byte) = place(server, parameters)?;
    Some(feature(&snapshot, byte))
}

/// A document as it is now, and the byte of the analyzed text at a position of it.
pub(super) fn place(server: &mut Server, parameters: &TextDocumentPositionParams) -> Option<(Snapshot, u32)> {
    let snapshot = server.workspace.snapshot(&parameters.text_document.uri)?;
    let byte = snapshot.byte(parameters.position)?;
    Some((snapshot, byte))
}
