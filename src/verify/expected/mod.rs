//! The reference of shaders in one frame: a scene, another shader or an image. Its results are cached
//! from one shader to the next.

mod accepted;
mod bands;
mod conditioning;
mod epsilons;
mod image;
mod march;
mod number_type;
mod scene;
mod shader;
mod variation;

use std::ops::Range;
use std::sync::Arc;

use toyproof_eval::{self as eval, Places};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::{Frame, Image};
use toyproof_scene::{FrameTime, Scene};
use toyproof_tracer::{ColorRange, EpsilonSet, Tracer};

pub use self::accepted::MarchDependence;
use self::accepted::point;
pub use self::bands::ReferenceBand;
pub use self::conditioning::Conditioning;
pub use self::image::ImageReference;
pub use self::number_type::NumberType;
pub use self::scene::SceneReference;
pub use self::shader::{DEFAULT_TOLERANCE, ReferenceFindings, ShaderReference};
use crate::bounds::MAX_ITERATIONS;
use crate::compare::{Band, EXACT_TOLERANCE, EpsilonSearch, SEEN, accept_epsilons};
use crate::evaluator::evaluate_at;
use crate::random::estimates::StochasticReference;

/// The reference of shaders in one frame. Results are computed on first use, from any thread: the
/// reference of many shaders is rendered once, unless it is too large for the cache.
#[derive(Debug)]
pub enum Expected {
    /// A scene, which the tracer renders.
    Scene(Box<SceneReference>),
    /// A shader, evaluated in f64.
    Shader(Box<ShaderReference>),
    /// An image, without anything else.
    Image(ImageReference),
}

/// The kind of an [`Expected`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferenceKind {
    /// A scene.
    Scene,
    /// A shader.
    Shader,
    /// An image.
    Image,
}

impl Expected {
    /// Creates the reference of a scene at the time and in the size of the frame.
    #[must_use]
    pub fn from_scene(scene: Scene, frame: &Frame) -> Self {
        Self::Scene(Box::new(SceneReference::new(scene, frame)))
    }

    /// The kind.
    #[must_use]
    pub fn kind(&self) -> ReferenceKind {
        match self {
            Self::Scene(_) => ReferenceKind::Scene,
            Self::Shader(_) => ReferenceKind::Shader,
            Self::Image(_) => ReferenceKind::Image,
        }
    }

    /// The scene, if it is one.
    #[must_use]
    pub fn scene(&self) -> Option<&Scene> {
        self.as_scene().map(SceneReference::scene)
    }

    /// The reference, if it is a scene.
    #[must_use]
    pub fn as_scene(&self) -> Option<&SceneReference> {
        match self {
            Self::Scene(scene) => Some(scene),
            Self::Shader(_) | Self::Image(_) => None,
        }
    }

    /// The tracer of the scene, if it is one.
    pub fn tracer(&self) -> Option<&Tracer<f64>> {
        self.as_scene().map(SceneReference::tracer)
    }

    /// The shader, if it is one.
    #[must_use]
    pub fn shader(&self) -> Option<&Checked> {
        match self {
            Self::Shader(shader) => Some(shader.checked()),
            Self::Scene(_) | Self::Image(_) => None,
        }
    }

    /// The program of the reference and its frame, if it is a shader.
    #[must_use]
    pub fn program(&self) -> Option<(&Program, &Frame)> {
        match self {
            Self::Shader(shader) => Some((&shader.program, &shader.frame)),
            Self::Scene(_) | Self::Image(_) => None,
        }
    }

    /// The reference in another frame; none if it is an image, or cannot be rendered there.
    #[must_use]
    pub fn in_frame(&self, frame: &Frame) -> Option<Self> {
        match self {
            Self::Scene(scene) => Some(Self::from_scene(scene.scene().clone(), frame)),
            Self::Shader(shader) => Some(Self::Shader(Box::new(shader.in_frame(frame)?))),
            Self::Image(_) => None,
        }
    }

    /// The colors at some places of another frame; none for an image.
    #[must_use]
    pub fn colors_in(&self, frame: &Frame, places: &Places) -> Option<Image> {
        match self {
            Self::Scene(scene) => {
                let mut scene = scene.scene().clone();
                scene.film.size = frame.size;
                let [columns, rows] = places.pixels();
                Some(Tracer::<f64>::at(&scene, FrameTime::from(frame)).sampled(&columns, &rows))
            }
            Self::Shader(shader) => evaluate_at(&shader.program, frame, places, MAX_ITERATIONS),
            Self::Image(_) => None,
        }
    }

    /// Whether random numbers decide where and how pixels are sampled.
    #[must_use]
    pub fn is_stochastic(&self) -> bool {
        match self {
            Self::Scene(scene) => scene.tracer().sampler().is_some(),
            Self::Shader(shader) => shader.is_stochastic(),
            Self::Image(_) => false,
        }
    }

    /// The colors at some positions within pixels, row by row, of a reference that is not stochastic; none
    /// for an image.
    #[must_use]
    pub fn colors_within(&self, positions: &Places) -> Option<Vec<[f64; 3]>> {
        match self {
            Self::Scene(scene) => {
                let Places { columns, rows } = positions;
                let positions = rows.iter().flat_map(|&y| columns.iter().map(move |&x| [x, y]));
                Some(
                    positions
                        .map(|position| scene.tracer().color_at(position))
                        .collect(),
                )
            }
            Self::Shader(shader) => {
                let image = evaluate_at(&shader.program, &shader.frame, positions, MAX_ITERATIONS)?;
                let colors = image.pixels().iter();
                Some(colors.map(|&[r, g, b, _]| [r, g, b].map(f64::from)).collect())
            }
            Self::Image(_) => None,
        }
    }

    /// The approximate memory of the cached results, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::Scene(scene) => scene.bytes(),
            Self::Shader(shader) => shader.bytes(),
            Self::Image(image) => image.bytes(),
        }
    }

    /// The largest difference of a component of colors that agree.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        match self {
            Self::Scene(_) => EXACT_TOLERANCE,
            Self::Shader(shader) => shader.tolerance(),
            Self::Image(image) => image.tolerance(),
        }
    }

    /// The tolerance of images in this number type.
    fn tolerance_in(&self, number_type: NumberType) -> f64 {
        match number_type {
            NumberType::Double => self.tolerance(),
            NumberType::Single => SEEN.max(self.tolerance()),
        }
    }

    /// Returns the whole image, in the frame of the reference.
    ///
    /// # Errors
    /// If a shader that is too large for the cache cannot be evaluated again.
    pub fn image(&self, frame: &Frame) -> Result<Image, eval::Failure> {
        let bands = frame.bands().map(|rows| self.rows(&rows));
        let images = bands.map(|band| band.map(|band| band.image.clone()));
        Ok(Image::of_bands(images.collect::<Result<_, _>>()?))
    }

    /// Returns a band of the reference. Callers block while another thread renders it, so no rayon thread may
    /// call this.
    ///
    /// # Errors
    /// If a shader that is too large for the cache cannot be evaluated again.
    pub fn rows(&self, rows: &Range<u32>) -> Result<Arc<ReferenceBand>, eval::Failure> {
        match self {
            Self::Scene(scene) => Ok(scene.rows(rows)),
            Self::Shader(shader) => shader.rows(rows),
            Self::Image(image) => Ok(image.rows(rows)),
        }
    }

    /// The color of a pixel; NaN where it is not known.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> [f64; 3] {
        match self {
            Self::Scene(scene) => scene.tracer().pixel(x, y),
            Self::Shader(shader) => shader.pixel(x, y),
            Self::Image(image) => image.pixel(x, y),
        }
    }

    /// The accepted colors of a pixel: others agree if they are within [`EXACT_TOLERANCE`] of these.
    #[must_use]
    pub fn color_range(&self, x: u32, y: u32) -> ColorRange {
        match self {
            Self::Scene(scene) => scene.color_range(x, y, EpsilonSet::Alike),
            Self::Shader(shader) => widened(shader.color_range(x, y), shader.tolerance()),
            Self::Image(image) => widened(point(image.pixel(x, y)), image.tolerance()),
        }
    }

    /// The number of samples of a pixel, as far as it is known: a shader takes any number.
    pub fn samples(&self) -> u32 {
        self.tracer().map_or(1, Tracer::samples)
    }

    /// Whether the image depends on the time.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        match self {
            Self::Scene(scene) => !scene.scene().motions.is_empty(),
            Self::Shader(shader) => shader.reads_time(),
            Self::Image(_) => false,
        }
    }

    /// The pixels whose color depends on how a reference shader marches along its rays; `None` for an image
    /// that is too large to be rendered again and again.
    #[must_use]
    pub fn march_dependence(&self) -> Option<&MarchDependence> {
        match self {
            Self::Shader(shader) => shader.accepted()?.march(),
            Self::Scene(_) | Self::Image(_) => None,
        }
    }

    /// As [`march_dependence`](Self::march_dependence), if a comparison has needed it.
    #[must_use]
    pub fn used_march_dependence(&self) -> Option<&MarchDependence> {
        match self {
            Self::Shader(shader) => shader.used()?.march(),
            Self::Scene(_) | Self::Image(_) => None,
        }
    }

    /// Accepts the colors of a band that the reference has for other ray epsilons, or if it marches
    /// differently.
    pub(crate) fn accept_epsilons(&self, rows: &Range<u32>, band: &mut Band, mixed: &mut EpsilonSearch) {
        match self {
            Self::Scene(scene) => accept_epsilons(band, &scene.band(rows), mixed),
            Self::Shader(shader) => shader.accept_epsilons(rows, band),
            Self::Image(_) => {}
        }
    }

    /// Whether the quad of a pixel lies across an edge of a scene, so that derivatives are undefined there.
    pub(crate) fn is_across_edge(&self, x: u32, y: u32) -> bool {
        self.tracer().is_some_and(|tracer| tracer.is_quad_mixed(x, y))
    }

    /// Of the `wanted` pixels of some rows, those in which the reference itself changes color by rounding in
    /// this number type, whatever a shader's formulas.
    #[must_use]
    pub fn tied(&self, rows: &Range<u32>, wanted: &[bool], number_type: NumberType) -> Vec<bool> {
        match self {
            Self::Scene(scene) => scene.tied(rows, wanted, number_type),
            Self::Shader(shader) => shader.tied(rows, wanted, number_type, self.tolerance_in(number_type)),
            Self::Image(_) => vec![false; wanted.len()],
        }
    }
}

/// The colors within a tolerance of a range, as those within [`EXACT_TOLERANCE`] of another.
fn widened(range: ColorRange, tolerance: f64) -> ColorRange {
    let beyond = tolerance - EXACT_TOLERANCE;
    ColorRange {
        low: range.low.map(|part| part - beyond),
        high: range.high.map(|part| part + beyond),
    }
}
