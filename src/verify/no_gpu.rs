//! Verification with a GPU, in builds without the feature `gpu`: there is no worker.

use std::sync::atomic::AtomicBool;
use std::sync::mpsc::Receiver;

use thiserror::Error;
use toyproof_diagnostic::Diagnostic;
use toyproof_eval::{Program, Refusal};

use crate::session::{IterationCount, VerifySession};
use crate::{Case, Failure, Findings};

/// A GPU worker, of which there are none without the feature `gpu`.
#[derive(Debug)]
pub enum Worker {}

/// Why a GPU rendered no image: there is no GPU without the feature `gpu`.
#[derive(Debug, Clone, Error)]
pub enum GpuFailure {}

impl GpuFailure {
    pub(super) fn diagnostics(&self) -> &[Diagnostic] {
        match *self {}
    }

    pub(super) fn is_invalid(&self) -> bool {
        match *self {}
    }

    pub(super) fn is_timeout(&self) -> bool {
        match *self {}
    }
}

pub(super) fn verify(
    worker: &mut Worker,
    _: &Case,
    _: Result<&Program, &Refusal>,
    _: VerifySession,
    _: &Receiver<IterationCount>,
    _: &AtomicBool,
) -> Result<Findings, Failure> {
    match *worker {}
}
