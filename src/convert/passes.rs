//! Conversions of shaders with several passes, and their proofs: the written files are played for some
//! frames, in the order and with the samplers of the written graph, together with the original shader, and
//! the bits of all passes are compared.

use std::fmt;

use toyproof_glsl::Sampling;
use toyproof_gpu::ShaderArtifact;
use toyproof_gpu::browser::Chromium;
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{Graph, Target};

use super::original::{Original, PlayedFrame};
use super::proof::{Rgb8Comparison, Runner};
use super::prover::{ProofError, Prover, Reader, fully_undefined, validate};
use super::{Source, TargetCode};

/// The sizes in which the passes are played, in pixels: the textures of one size are not multiples of the
/// other's.
pub const PASS_SIZES: [[u32; 2]; 2] = [[96, 54], [60, 80]];

/// The number of frames that are played in each size.
pub const PASS_FRAMES: i32 = 8;

/// A shader with several passes to convert.
#[derive(Debug, Clone, Copy)]
pub struct PassSources<'a> {
    /// The passes, in the order of the graph.
    pub sources: &'a [Source<'a>],
    /// The order of the passes, and what they read.
    pub graph: &'a Graph,
    /// The textures that do not change. Those that are not available are replaced, so that reads of
    /// them are observed.
    pub media: &'a [Texture],
}

/// The contents of a written graph, with the media of the original.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphContent {
    /// The order of the passes, and what they read.
    pub graph: Graph,
    /// How the channels of each pass are sampled.
    pub sampling: Vec<[Sampling; 4]>,
}

/// The result of playing converted passes and their original.
#[derive(Debug, Clone)]
pub struct PassesProof {
    /// One comparison for each texture that is rendered, over all frames.
    pub passes: Vec<PassComparison>,
    /// The device that rendered them.
    pub device: String,
    /// The readers whose results were played; empty if no reader reads the language, so that the source of
    /// the files was played.
    pub readers: Vec<Reader>,
    /// The name and version of the validator that accepts the files.
    pub validator: Option<String>,
    /// The name and version of the browser that renders each pass like the original.
    pub browser: Option<(String, Rgb8Comparison)>,
}

/// The comparison of a pass with its original, over all frames.
#[derive(Debug, Clone, PartialEq)]
pub struct PassComparison {
    /// The target of the pass.
    pub target: Target,
    /// The number of pixels of all frames.
    pub pixels: u64,
    /// The number of pixels that depend on undefined behavior.
    pub undefined: u64,
    /// The number of pixels that differ.
    pub differing: u64,
    /// The first pixel that differs.
    pub first: Option<PixelDifference>,
}

/// A pixel of a pass that differs from the original's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelDifference {
    /// The number of the frame.
    pub frame: i32,
    /// Width and height of the frame in pixels.
    pub size: [u32; 2],
    /// The position from the bottom left, in pixels.
    pub at: [u32; 2],
    /// The original's color.
    pub expected: [f32; 4],
    /// The conversion's color.
    pub actual: [f32; 4],
}

/// The name of a pass, as the site shows it.
fn name(target: Target) -> String {
    match target {
        Target::Image => "Image".to_owned(),
        Target::Buffer(number) => format!("Buffer {}", char::from(b'A' + number as u8)),
    }
}

impl fmt::Display for PassComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = name(self.target);
        let Some(first) = &self.first else {
            return write!(f, "{name} is equal");
        };
        let ([width, height], [x, y]) = (first.size, first.at);
        write!(
            f,
            "{name} differs from frame {} on, first at pixel ({x}, {y}) of {width}×{height}, which is {:?}, not {:?}",
            first.frame, first.actual, first.expected
        )
    }
}

impl PassesProof {
    /// The number of pixels of all passes and frames.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        self.passes.iter().map(|pass| pass.pixels).sum()
    }

    /// The number of pixels that depend on undefined behavior.
    #[must_use]
    pub fn undefined(&self) -> u64 {
        self.passes.iter().map(|pass| pass.undefined).sum()
    }
}

impl Prover<'_> {
    /// Proves that written passes, played by the graph, render the same textures as the shader: to the
    /// bit in [`PASS_FRAMES`] frames of each of [`PASS_SIZES`], except in pixels that depend on undefined
    /// behavior. After a frame in which such a pixel differs, the conversion continues from the original's
    /// textures.
    ///
    /// # Errors
    /// Why it is not proved.
    pub fn prove_passes(
        &mut self,
        passes: &PassSources,
        written: &[TargetCode],
        graph: &GraphContent,
    ) -> Result<PassesProof, ProofError> {
        self.prove_passes_with(
            passes,
            written,
            graph,
            std::convert::identity,
            |browser, original| original.compare_in_browser(browser, passes.sources, written),
        )
    }

    /// Proves passes like [`Self::prove_passes`], in frames that `adapt` changes; `in_browser` compares them
    /// with the original in the browser, if there
    /// is one.
    pub(super) fn prove_passes_with(
        &mut self,
        passes: &PassSources,
        written: &[TargetCode],
        graph: &GraphContent,
        adapt: fn(Frame) -> Frame,
        in_browser: impl FnOnce(&mut Chromium, &Original) -> Result<Option<(String, Rgb8Comparison)>, ProofError>,
    ) -> Result<PassesProof, ProofError> {
        let mut validator = None;
        let mut readings: Vec<(Reader, Vec<ShaderArtifact>)> = Vec::new();
        let mut is_read = true;
        for (source, written) in passes.sources.iter().zip(written) {
            validator = validate(written, source.checked.channels)?;
            let mut of_pass = self.readings(source.checked, written)?;
            if let (true, TargetCode::Naga { lowered, .. }) = (of_pass.is_empty(), written) {
                is_read = false;
                of_pass.push((Reader::Naga, ShaderArtifact::Lowered(lowered.clone())));
            }
            for (reader, artifact) in of_pass {
                match readings.iter_mut().find(|(known, _)| *known == reader) {
                    Some((_, artifacts)) => artifacts.push(artifact),
                    None => readings.push((reader, vec![artifact])),
                }
            }
        }
        let original = Original::play(passes, &mut self.runner, adapt, self.timeout, self.pool)?;
        let mut proofs = Vec::new();
        let mut readers = Vec::new();
        for (reader, artifacts) in readings {
            let limits = (self.timeout, self.pool);
            let proof = original.compare(passes, &mut self.runner, artifacts, graph, limits)?;
            let differing = proof.iter().map(|pass| pass.differing).sum();
            if differing > 0 {
                return Err(match (&self.runner, &reader) {
                    (Runner::Evaluator(_), Reader::Compiler(_)) => ProofError::DiffersAsRead {
                        differing,
                        pixels: proof.iter().map(|pass| pass.pixels).sum(),
                    },
                    _ => ProofError::PassesDiffer(proof),
                });
            }
            proofs.push(proof);
            readers.push(reader);
        }
        let browser = match &mut self.browser {
            Some(browser) => in_browser(browser, &original)?,
            None => None,
        };
        let proof = PassesProof {
            // There is at least one reader.
            passes: proofs.swap_remove(0),
            device: original.device,
            readers: if is_read { readers } else { Vec::new() },
            validator,
            browser,
        };
        match original.undefined_by {
            Some((pass, by)) if proof.undefined() == proof.pixels() => {
                Err(fully_undefined(by, passes.sources[pass].files))
            }
            _ => Ok(proof),
        }
    }
}

impl PassComparison {
    pub(super) fn new(target: Target) -> Self {
        Self {
            target,
            pixels: 0,
            undefined: 0,
            differing: 0,
            first: None,
        }
    }

    /// Compares the pass in a frame, and returns whether all bits are equal. The sign of a zero and the bits
    /// of NaN are open.
    pub(super) fn add(&mut self, frame: &PlayedFrame, actual: &Image, undefined: &[bool]) -> bool {
        let expected = frame.texture(self.target);
        let same = |a: f32, b: f32| a == b || a.is_nan() && b.is_nan();
        let mut has_same_bits = true;
        for (at, (a, b)) in expected.pixels().iter().zip(actual.pixels()).enumerate() {
            has_same_bits &= a.map(f32::to_bits) == b.map(f32::to_bits);
            let is_undefined = undefined[at];
            let differs = !is_undefined && !a.iter().zip(b).all(|(&a, &b)| same(a, b));
            self.pixels += 1;
            self.undefined += u64::from(is_undefined);
            self.differing += u64::from(differs);
            if differs && self.first.is_none() {
                let width = actual.size()[0] as usize;
                self.first = Some(PixelDifference {
                    frame: frame.inputs.frame,
                    size: frame.inputs.size,
                    at: [at % width, at / width].map(|side| side as u32),
                    expected: *a,
                    actual: *b,
                });
            }
        }
        has_same_bits
    }
}
