//! Proves conversions: each available reader reads the written file, and the result is run.

use std::fmt;
use std::time::Duration;

use rayon::ThreadPool;
use thiserror::Error;
use toyproof_diagnostic::{Deadline, Files, Overdue, grouped, plural};
use toyproof_eval::{Fault, Observed};
use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{self as glsl, Checked, Dialect, PortError, Stage};
use toyproof_gpu::browser::{self, Chromium, Text};
use toyproof_gpu::{self as gpu, ShaderArtifact};
use toyproof_image::{Frame, Image};
use toyproof_translate::FloatMode;
use toyproof_translate::backend::{Target, roundtrip, spirv};
use toyproof_translate::c_family::CHost;
use toyproof_translate::naga_ir::Shape;
use toyproof_translate::wgsl::Style;
use toyproof_verify::Failure;

use super::passes::PassComparison;
use super::proof::{
    Proof, ProofReference, Rgb8Comparison, Runner, compare_with_original, frames, read_glsl, read_shadertoy,
};
use super::tool::{self, ToolError};
use super::{Source, TargetCode};

/// Proves conversions.
#[derive(Debug)]
pub struct Prover<'a> {
    /// The device that runs the conversion.
    pub runner: Runner<'a>,
    /// A browser that must also render WGSL and GLSL like the original.
    pub browser: Option<&'a mut Chromium>,
    /// The time limit of an image.
    pub timeout: Duration,
    /// The evaluator's thread pool; rayon's global pool if `None`.
    pub pool: Option<&'a ThreadPool>,
}

/// A conversion that renders the same image as the original.
#[derive(Debug, Clone)]
pub enum ShaderProof {
    /// The file was read again.
    File(Proof, Readers),
    /// The shader that naga wrote the file from was run; no reader reads the file itself.
    Source(Proof),
}

impl ShaderProof {
    /// The comparison with the original, of the first reader if there are several.
    #[must_use]
    pub fn proof(&self) -> &Proof {
        match self {
            Self::File(proof, _) | Self::Source(proof) => proof,
        }
    }
}

/// The readers of a conversion.
#[derive(Debug, Clone)]
pub struct Readers {
    /// The readers whose results were run, each separately.
    pub run: Vec<Reader>,
    /// The name and version of the validator that accepts the file.
    pub validator: Option<String>,
    /// The name and version of the browser that renders it like the original.
    pub browser: Option<(String, Rgb8Comparison)>,
}

/// A reader of a converted file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reader {
    /// naga.
    Naga,
    /// The driver, which takes SPIR-V as it is.
    Driver,
    /// Our own front end.
    FrontEnd,
    /// A compiler to SPIR-V, with its version.
    Compiler(String),
}

impl fmt::Display for Reader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Naga => "naga",
            Self::Driver => "the driver",
            Self::FrontEnd => "toyproof's GLSL front end",
            Self::Compiler(name) => name,
        })
    }
}

/// Why a conversion is not proved.
#[derive(Debug, Error)]
pub enum ProofError {
    /// A tool rejects the file.
    #[error(transparent)]
    Tool(#[from] ToolError),
    /// The length of a SPIR-V file is not a multiple of four bytes.
    #[error("the length of the SPIR-V file is not a multiple of four bytes")]
    PartialWord,
    /// Our own front end rejects the file with this message.
    #[error("toyproof's GLSL front end rejects the output: {0}")]
    FrontEnd(String),
    /// The file of a host is not read as it was written.
    #[error("the output is not read again: {0}")]
    Unreadable(String),
    /// No compiler that reads the file is installed.
    #[error("no compiler that reads it for {0} is installed; on Debian: apt-get install glslang-tools")]
    NoReader(&'static str),
    /// No compiler that runs here reads the language.
    #[error("only Apple's compiler reads {0}, so the readable text cannot be proved")]
    AppleOnly(&'static str),
    /// There is no driver to run it.
    #[error("a proof requires a Vulkan driver: {0}")]
    NoDriver(gpu::Failure),
    /// The shader takes too long to compile.
    #[error(transparent)]
    Overdue(Overdue),
    /// The conversion or the original has no images.
    #[error(transparent)]
    Run(Failure),
    /// Some pixels differ.
    #[error(
        "{} of {} pixels {} from {}{}, {}",
        grouped(*differing),
        grouped(*pixels),
        plural(*differing, "differs", "differ"),
        match against {
            ProofReference::Evaluator => "the evaluator's image",
            ProofReference::StrictRun => "the original's image on the same driver",
        },
        reader.as_ref().map_or_else(String::new, |reader| format!(" as read by {reader}")),
        match *max_abs {
            0.0 => "in values that are not finite".to_owned(),
            max_abs => format!("by at most {max_abs:.1e}"),
        },
    )]
    Differs {
        /// The reader, if there are several.
        reader: Option<Reader>,
        /// The number of pixels that differ.
        differing: u64,
        /// The number of pixels of all frames.
        pixels: u64,
        /// The largest difference of a component.
        max_abs: f64,
        /// The reference.
        against: ProofReference,
    },
    /// Some pixels differ as naga reads SPIR-V for the evaluator.
    #[error(
        "{} of {} pixels {} as naga reads glslang's SPIR-V, which it may misread; a Vulkan driver decides",
        grouped(*differing),
        grouped(*pixels),
        plural(*differing, "differs", "differ"),
    )]
    DiffersAsRead {
        /// The number of pixels that differ.
        differing: u64,
        /// The number of pixels of all frames.
        pixels: u64,
    },
    /// A pass of a shader with several differs from the original's on the same driver.
    #[error("{}", differing_passes(.0))]
    PassesDiffer(Vec<PassComparison>),
    /// Every pixel depends on undefined behavior.
    #[error("every pixel depends on undefined behavior, such as {} at {at}", fault.description())]
    FullyUndefined {
        /// The operation that occurs in most pixels.
        fault: Fault,
        /// The position: file, line and column.
        at: String,
    },
    /// The browser is given shaders of ShaderToy, and the original cannot be written as one.
    #[error("the original shader cannot be rendered with WebGL 2: {0}")]
    BrowserHost(PortError),
    /// The browser does not render the original.
    #[error("the original shader cannot be rendered with WebGL 2: {0}")]
    BrowserOriginal(browser::BrowserFailure),
    /// The browser does not render the conversion.
    #[error(transparent)]
    Browser(browser::BrowserFailure),
    /// The browser renders the conversion with other colors than the original.
    #[error(
        "in Chromium, {} of {} pixels {} from the original in WebGL 2, by at most {:.1}/255",
        grouped(.0.differing),
        grouped(.0.pixels),
        plural(.0.differing, "differs", "differ"),
        .0.max * 255.0
    )]
    BrowserDiffers(Rgb8Comparison),
}

impl ProofError {
    /// Returns whether the reason applies to every conversion of the shader: it takes too long, depends on
    /// undefined behavior, or cannot be run.
    #[must_use]
    pub fn is_of_shader(&self) -> bool {
        match self {
            Self::NoDriver(_) | Self::Overdue(_) | Self::FullyUndefined { .. } => true,
            Self::Run(failure) => matches!(
                failure,
                Failure::Cpu(_)
                    | Failure::LoopTruncated(_)
                    | Failure::Gpu(gpu::Failure::Timeout { .. } | gpu::Failure::Device(_))
            ),
            _ => false,
        }
    }
}

impl From<Failure> for ProofError {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Gpu(failure) if failure.is_without_driver() => Self::NoDriver(failure),
            Failure::Overdue(overdue) => Self::Overdue(overdue),
            failure => Self::Run(failure),
        }
    }
}

impl Prover<'_> {
    /// Proves that a written file renders the same images as the shader: to the bit in every frame of
    /// [`super::FRAMES`], except in pixels that depend on undefined behavior.
    ///
    /// # Errors
    /// Returns why it is not proved.
    pub fn prove(&mut self, source: Source, written: &TargetCode) -> Result<ShaderProof, ProofError> {
        self.prove_with(
            source,
            written,
            std::convert::identity,
            |browser, frames, undefined| in_browser(browser, source, written, frames, undefined),
        )
    }

    /// Proves a file like [`Self::prove`], with frames that `adapt` changes; `in_browser` compares it with
    /// the original in the browser, if there is one, in
    /// these frames and except in these pixels.
    pub(super) fn prove_with(
        &mut self,
        source: Source,
        written: &TargetCode,
        adapt: fn(Frame) -> Frame,
        in_browser: impl FnOnce(
            &mut Chromium,
            &[Frame],
            &[Vec<bool>],
        ) -> Result<Option<(String, Rgb8Comparison)>, ProofError>,
    ) -> Result<ShaderProof, ProofError> {
        let validator = validate(written, source.checked.channels)?;
        let mut readings = self.readings(source.checked, written)?;
        let is_unread = readings.is_empty();
        if let (true, TargetCode::Naga { lowered, .. }) = (is_unread, written) {
            readings.push((Reader::Naga, ShaderArtifact::Lowered(lowered.clone())));
        }
        let frames: Vec<Frame> = frames(source.checked).into_iter().map(adapt).collect();
        let (run, proof) = self.run(source, readings, &frames)?;
        if is_unread {
            return Ok(ShaderProof::Source(proof));
        }
        let browser = match &mut self.browser {
            Some(browser) => in_browser(browser, &frames, &proof.undefined_at)?,
            None => None,
        };
        Ok(ShaderProof::File(
            proof,
            Readers {
                run,
                validator,
                browser,
            },
        ))
    }

    /// The results of all available readers of a file.
    pub(super) fn readings(
        &self,
        checked: &Checked,
        written: &TargetCode,
    ) -> Result<Vec<(Reader, ShaderArtifact)>, ProofError> {
        let (target, bytes) = match written {
            TargetCode::Lowered(lowered) => {
                return Ok(vec![(Reader::Naga, ShaderArtifact::Lowered(lowered.clone()))]);
            }
            TargetCode::Wgsl(text, style) => {
                return Ok(vec![(
                    Reader::Naga,
                    ShaderArtifact::Wgsl(style.hosted_in(text, checked.stage)),
                )]);
            }
            TargetCode::Glsl(text, dialect) => {
                let again = read_glsl(text, checked, *dialect, self.timeout)?;
                let lowered = FloatMode::Fast.lower_within(&again, &Deadline::after(self.timeout));
                let lowered = lowered.map_err(ProofError::Overdue)?;
                return Ok(vec![(Reader::FrontEnd, ShaderArtifact::Lowered(lowered))]);
            }
            TargetCode::CFamily(text, host) => return compiled(checked, text, *host),
            TargetCode::Naga { target, bytes, .. } => (*target, bytes),
        };
        let artifact = |words, upside_down| ShaderArtifact::Words {
            words,
            channels: shapes(checked),
            upside_down,
        };
        let mut readings = Vec::new();
        match target {
            Target::Spirv => {
                let words = spirv::of_bytes(bytes).ok_or(ProofError::PartialWord)?;
                readings.push((Reader::Driver, artifact(words, false)));
            }
            Target::Glsl => {
                let text = roundtrip::as_shadertoy(&String::from_utf8_lossy(bytes));
                let again = read_shadertoy(&text, checked, checked.stage, self.timeout)?;
                let lowered = FloatMode::Fast.lower_within(&again, &Deadline::after(self.timeout));
                let lowered = lowered.map_err(ProofError::Overdue)?;
                readings.push((Reader::FrontEnd, ShaderArtifact::Lowered(lowered)));
            }
            Target::Wgsl | Target::Hlsl | Target::Msl => {}
        }
        // naga's reader of SPIR-V does not read all that glslang writes: the evaluator runs what has another reader.
        let is_needed = matches!(self.runner, Runner::Driver(_)) || readings.is_empty();
        if is_needed && let Some((words, compiler)) = tool::compile(target, bytes)? {
            readings.push((Reader::Compiler(compiler), artifact(words, false)));
        }
        Ok(readings)
    }

    /// Runs each reader's result; all of them must agree with the shader.
    fn run(
        &mut self,
        source: Source,
        readings: Vec<(Reader, ShaderArtifact)>,
        frames: &[Frame],
    ) -> Result<(Vec<Reader>, Proof), ProofError> {
        let (readers, artifacts): (Vec<_>, Vec<_>) = readings.into_iter().unzip();
        let mut proofs = compare_with_original(
            &mut self.runner,
            source.checked,
            artifacts,
            frames,
            self.timeout,
            self.pool,
        )?;
        if let Some(proof) = proofs.first()
            && let Some(by) = proof.undefined_by
            && proof.undefined() == proof.pixels()
        {
            return Err(fully_undefined(by, source.files));
        }
        let different = proofs.iter().zip(&readers).find(|(proof, _)| !proof.holds());
        if let Some((proof, reader)) = different {
            // naga's reader of SPIR-V mistakes fall-through in a `switch`, for instance.
            if matches!(
                (&self.runner, reader),
                (Runner::Evaluator(_), Reader::Compiler(_))
            ) {
                return Err(ProofError::DiffersAsRead {
                    differing: proof.differing(),
                    pixels: proof.pixels(),
                });
            }
            return Err(ProofError::Differs {
                reader: (readers.len() > 1).then(|| reader.clone()),
                differing: proof.differing(),
                pixels: proof.pixels(),
                max_abs: proof.max_abs(),
                against: proof.against,
            });
        }
        // There is a proof for each reader, and at least one reader.
        Ok((readers, proofs.swap_remove(0)))
    }
}

/// The results of the compilers that read a file for a host, in a substitute for it.
fn compiled(checked: &Checked, text: &str, host: CHost) -> Result<Vec<(Reader, ShaderArtifact)>, ProofError> {
    let target = host.read_as().ok_or(ProofError::AppleOnly(host.title()))?;
    let hosted = host.hosted(text, checked.stage);
    let compiled = tool::compile_hosted(target, &hosted.text)?;
    let (words, compiler) = compiled.ok_or(ProofError::NoReader(host.title()))?;
    let artifact = ShaderArtifact::Words {
        words,
        channels: shapes(checked),
        upside_down: hosted.upside_down,
    };
    Ok(vec![(Reader::Compiler(compiler), artifact)])
}

/// The shapes of the textures that a shader reads.
fn shapes(checked: &Checked) -> [Shape; 4] {
    checked.channels.map(|shape| match shape {
        SamplerShape::D2 | SamplerShape::D2Array => Shape::D2,
        SamplerShape::D3 => Shape::D3,
        SamplerShape::Cube => Shape::Cube,
    })
}

fn differing_passes(passes: &[PassComparison]) -> String {
    let differing = passes.iter().filter(|pass| pass.differing > 0);
    differing.map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

/// Validates a file with an external tool, if one is installed; returns its name and version. `channels` are
/// the shapes of the textures, which a file for ShaderToy does not declare.
pub(super) fn validate(
    written: &TargetCode,
    channels: [SamplerShape; 4],
) -> Result<Option<String>, ToolError> {
    match written {
        TargetCode::Wgsl(text, Style::Plain) => tool::validate(Target::Wgsl, text.as_bytes()),
        TargetCode::Naga { target, bytes, .. } => tool::validate(*target, bytes),
        TargetCode::Glsl(text, dialect) => {
            let complete = match dialect {
                _ if dialect.calls_main_image() => browser::as_shadertoy(text, channels),
                // The reader has declared what the header does. Drivers join continued lines in older
                // versions, too.
                Dialect::Isf => format!("#version 330\n{}", text.replace("\\\n", "")),
                // Without a version, a host with WebGL compiles GLSL ES 1.00. Browsers join lines in it, too,
                // which end with a backslash.
                _ if text.starts_with("#version") => text.clone(),
                _ if text.contains("\\\n") => {
                    let joined = format!("#version 100\n{}", text.replace("\\\n", ""));
                    let validator = tool::validate(Target::Glsl, joined.as_bytes())?;
                    return Ok(validator.map(|tool| format!("{tool}, with continued lines joined,")));
                }
                _ => format!("#version 100\n{text}"),
            };
            tool::validate(Target::Glsl, complete.as_bytes())
        }
        // Only their hosts complete them.
        TargetCode::Wgsl(..) | TargetCode::CFamily(..) | TargetCode::Lowered(_) => Ok(None),
    }
}

/// The reason why no conversion of a shader can be proved, if every pixel depends on undefined behavior.
pub(super) fn fully_undefined(by: Observed, files: &Files) -> ProofError {
    let span = by.site.at.span;
    let place = files.position(span);
    let name = files.name(span);
    ProofError::FullyUndefined {
        fault: by.site.fault,
        at: format!("{name}:{}:{}", place.line, place.column),
    }
}

/// Renders a conversion and its original in a browser: their 8-bit colors may differ by at most 1/255, except
/// in the pixels of each frame that are undefined. Returns the browser's name and the comparison; `None` for
/// languages that browsers do not run.
pub(super) fn in_browser(
    browser: &mut Chromium,
    source: Source,
    written: &TargetCode,
    frames: &[Frame],
    undefined: &[Vec<bool>],
) -> Result<Option<(String, Rgb8Comparison)>, ProofError> {
    let channels = source.checked.channels;
    let original = browser_text(source)?;
    let sampling = source.checked.sampling;
    let render_original = |browser: &mut Chromium| {
        let images = browser.render(Text::Glsl(&original), sampling, frames);
        images.map_err(ProofError::BrowserOriginal)
    };
    let (original, converted) = match written {
        TargetCode::Wgsl(text, style) => {
            let hosted = style.hosted_in(text, source.checked.stage);
            let original = render_original(browser)?;
            let images = browser.render(Text::Wgsl(&hosted.text), sampling, frames);
            let images = images.map_err(ProofError::Browser)?;
            if hosted.upside_down {
                (original, images.iter().map(Image::upside_down).collect())
            } else {
                (original, images)
            }
        }
        TargetCode::Naga {
            target: Target::Glsl,
            bytes,
            ..
        } => {
            let original = render_original(browser)?;
            let text = String::from_utf8_lossy(bytes);
            let images = browser.render(Text::Glsl(&text), sampling, frames);
            (original, images.map_err(ProofError::Browser)?)
        }
        TargetCode::CFamily(text, CHost::Glsl) => {
            let original = render_original(browser)?;
            let images = browser.render(Text::Glsl(text), sampling, frames);
            (original, images.map_err(ProofError::Browser)?)
        }
        TargetCode::Glsl(text, dialect) if dialect.calls_main_image() => {
            let original = render_original(browser)?;
            let text = browser::as_shadertoy(text, channels);
            let images = browser.render(Text::Glsl(&text), sampling, frames);
            (original, images.map_err(ProofError::Browser)?)
        }
        TargetCode::Naga { .. } | TargetCode::Lowered(_) | TargetCode::Glsl(..) | TargetCode::CFamily(..) => {
            return Ok(None);
        }
    };
    shown(&original, &converted, undefined).map(|shown| {
        let name = browser.name().unwrap_or("Chromium").to_owned();
        Some((name, shown))
    })
}

/// Compares what a browser shows of a conversion and of its original, except in undefined pixels.
pub(super) fn shown(
    original: &[Image],
    converted: &[Image],
    undefined: &[Vec<bool>],
) -> Result<Rgb8Comparison, ProofError> {
    let shown = Rgb8Comparison::new(original, converted, undefined);
    if shown.differing > 0 {
        return Err(ProofError::BrowserDiffers(shown));
    }
    Ok(shown)
}

/// The original as a complete shader for WebGL 2.
///
/// # Errors
/// It is written for a host whose inputs ShaderToy does not have.
pub fn browser_text(source: Source) -> Result<String, ProofError> {
    let channels = source.checked.channels;
    if source.checked.dialect.calls_main_image() {
        let is_buffer = source.checked.stage == Stage::Buffer;
        return Ok(browser::as_shadertoy_pass(source.text(), channels, is_buffer));
    }
    // It has been compiled within the time limit, and is compiled once more.
    let (to, deadline) = (Dialect::ShaderToy, Deadline::default());
    let text = glsl::port(source.checked, source.files, to, &|_, _| None, &deadline);
    let ported = text.map_err(ProofError::BrowserHost)?;
    Ok(browser::as_shadertoy(&ported, channels))
}
