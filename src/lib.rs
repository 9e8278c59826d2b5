//! Checks, renders and converts ShaderToy shaders, and states how far each image can be trusted.
//!
//! A ShaderToy shader is a GLSL function `mainImage(out vec4 color, in vec2 position)` that is called for
//! each pixel. If its image differs from the expected one, three things can be at fault, and one comparison
//! cannot tell them apart. So there are three **checks**, each of which compares two images pixel by pixel:
//!
//! | check | expected | actual | a difference means |
//! |---|---|---|---|
//! | algorithm | the reference tracer, in double precision | the shader on the CPU, in double precision | the shader computes something else |
//! | precision | the shader in double precision | the shader in float32 | float32 is not enough for this formula |
//! | toolchain | the shader in float32 on the CPU | the shader in float32 on the GPU, to the bit | naga, our translation or the driver is wrong |
//!
//! In double precision two equivalent formulas agree to far below what an eye can see, whatever their style,
//! and a bug does not. Some pixels are special:
//!
//! - A pixel that changes when every operation is perturbed by a unit in the last place is **ill-conditioned**:
//!   no precision would settle it, and it is not held against the shader.
//! - A pixel that depends on **undefined behavior** (an index out of bounds, `pow` of a negative base, a
//!   derivative across an edge) is counted separately and left out of the checks.
//!
//! A **strict** run makes the bits of float32 comparable: operations carry SPIR-V's `NoContraction`, and
//! `sin`, `exp`, `pow` and their like are expanded to operations that all drivers and CPUs round alike. A
//! **fast** run gives the shader to the driver unchanged; it has no toolchain check.
//!
//! # Features
//!
//! Each stage is a crate of its own, which can be used alone; this one re-exports them. The front end and the
//! lints are always there; the default is `cli`, that is, everything.
//!
//! | feature | adds |
//! |---|---|
//! | `eval` | evaluating shaders on the CPU |
//! | `tracer` | scenes and the reference tracer |
//! | `translate` | translation by naga to SPIR-V, WGSL, MSL, HLSL and GLSL |
//! | `verify` | the three checks and the verdict (without `gpu`: algorithm and precision); metrics of images |
//! | `explain` | the mistake that explains a wrong image, and its repair |
//! | `gpu` | rendering on a Vulkan driver, in a worker process |
//! | `convert` | conversions, and their proofs |
//! | `stress` | numerical stability of ray–surface intersection, and tests of an author's own function |
//! | `lab` | measurements of accuracy against time, and charts |
//! | `numerics` | rewrites of expressions that lose fewer digits |
//! | `project` | projects of several tabs, as folders and as the site's JSON |
//! | `lsp` | the language server of editors |
//! | `reduce` | the smallest shader that still shows a fault |
//! | `film` | films of frames: GIF, APNG, and MP4 and `WebM` by an installed ffmpeg |
//! | `format` | the formatter |
//! | `dap` | the debug adapter |
//! | `report` | reports: JSON, HTML, `JUnit`, SARIF, CSV, autograders; with `classroom`, assignments |
//! | `cli` | the command line |
//!
//! # Example
//!
//! ```
//! use toyproof::diagnostic::{Code, Deadline, File, Files};
//! use toyproof::glsl::{Options, check};
//! use toyproof::lint::lint;
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let text = "void mainImage(out vec4 c, in vec2 p) { float shade; c = vec4(shade); }";
//!     let file = files.add(File::new("shade.glsl", text));
//!     // The error of an invalid shader displays each message with its position.
//!     let checked = check(&files, file, &Options::default())?;
//!     let lints = lint(&files, &checked, &Deadline::default());
//!     assert_eq!(lints.warnings[0].code, Code::Unwritten);
//!     Ok(())
//! }
//! ```
//!
//! `examples/` has programs that parse, evaluate, convert and verify a shader, and that compile one for wgpu.
//! A program that renders on a GPU must be
//! able to start itself as the worker process: see `toyproof_gpu`.

/// The examples of the guide are tests.
#[cfg(all(doctest, feature = "translate"))]
#[doc = include_str!("../docs/guide/library.md")]
struct Guide;

#[cfg(feature = "cli")]
pub mod cli;

/// Evaluating shaders on the CPU, with machine code where there is any.
#[cfg(feature = "eval")]
pub mod eval {
    pub use toyproof_eval::*;
    pub use toyproof_eval_native::Program;
}

#[cfg(feature = "classroom")]
pub use toyproof_classroom as classroom;
#[cfg(feature = "convert")]
pub use toyproof_convert as convert;
#[cfg(feature = "dap")]
pub use toyproof_dap as dap;
pub use toyproof_diagnostic as diagnostic;
#[cfg(feature = "explain")]
pub use toyproof_explain as explain;
#[cfg(feature = "film")]
pub use toyproof_film as film;
#[cfg(feature = "format")]
pub use toyproof_format as format;
pub use toyproof_glsl as glsl;
#[cfg(feature = "gpu")]
pub use toyproof_gpu as gpu;
#[cfg(any(
    feature = "eval",
    feature = "film",
    feature = "media",
    feature = "tracer",
    feature = "gpu"
))]
pub use toyproof_image as image;
#[cfg(feature = "lab")]
pub use toyproof_lab as lab;
pub use toyproof_lint as lint;
#[cfg(feature = "lsp")]
pub use toyproof_lsp as lsp;
pub use toyproof_math as math;
#[cfg(feature = "media")]
pub use toyproof_media as media;
#[cfg(feature = "verify")]
pub use toyproof_metrics as metrics;
#[cfg(feature = "numerics")]
pub use toyproof_numerics as numerics;
#[cfg(feature = "eval")]
pub use toyproof_player as player;
#[cfg(feature = "project")]
pub use toyproof_project as project;
#[cfg(feature = "reduce")]
pub use toyproof_reduce as reduce;
#[cfg(feature = "report")]
pub use toyproof_report as report;
#[cfg(feature = "tracer")]
pub use toyproof_scene as scene;
#[cfg(feature = "stress")]
pub use toyproof_stress as stress;
#[cfg(feature = "tracer")]
pub use toyproof_tracer as tracer;
#[cfg(feature = "translate")]
pub use toyproof_translate as translate;
#[cfg(feature = "verify")]
pub use toyproof_verify as verify;
#[cfg(feature = "watch")]
pub use toyproof_watch as watch;
