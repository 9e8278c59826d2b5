//! How precise the images of variants of a shader are, against the shader in double precision.

use std::cell::OnceCell;
use std::time::Instant;

use toyproof_eval::{Number, RandomRounding, Seed, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::{Frame, Image};
use toyproof_verify::compare::SEEN;

/// The images of a variant of a shader.
#[derive(Debug)]
pub(crate) struct Rendered {
    program: Program,
    single: Image,
    /// `None` if the single image is not better anyway.
    double: Option<Image>,
}

/// One 8-bit level.
const LEVEL: f64 = 1.0 / 255.0;

impl Rendered {
    /// Renders a variant in f32; in f64 only if the f32 image is better than the judge's.
    pub(crate) fn new(
        checked: &Checked,
        frame: &Frame,
        deadline: Instant,
        judge: Option<&Judge>,
    ) -> Option<Self> {
        let limit = deadline.saturating_duration_since(Instant::now());
        let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(limit)).ok()?;
        let single = render::<f32>(&program, frame, (), deadline)?;
        let mut rendered = Self {
            program,
            single,
            double: None,
        };
        let is_better = judge.is_none_or(|judge| judge.precision(&rendered) < judge.own);
        if is_better {
            rendered.double = Some(render::<f64>(&rendered.program, frame, (), deadline)?);
        }
        Some(rendered)
    }
}

fn render<N: Number>(program: &Program, frame: &Frame, noise: N::Noise, deadline: Instant) -> Option<Image> {
    let settings = Settings::<N> {
        undefined: UndefinedPolicy::Plain,
        deadline: Some(deadline),
        noise,
        ..Settings::default()
    };
    Some(program.render(frame, &settings).ok()?.framebuffer.image())
}

/// The number of frames by which times are compared.
const FRAMES: usize = 7;

/// The time of a frame of `other` in f32, relative to that of `one`: the median of alternating frames.
pub(crate) fn relative_time(
    one: &Rendered,
    other: &Rendered,
    frame: &Frame,
    deadline: Instant,
) -> Option<f64> {
    let time = |rendered: &Rendered| {
        let start = Instant::now();
        render::<f32>(&rendered.program, frame, (), deadline)?;
        Some(start.elapsed().as_secs_f64())
    };
    let mut ratios = (0..FRAMES)
        .map(|_| Some(time(other)? / time(one)?.max(1e-9)))
        .collect::<Option<Vec<_>>>()?;
    ratios.sort_by(f64::total_cmp);
    Some(ratios[FRAMES / 2])
}

/// Fewer pixels become precise by chance, as other roundings make them.
const MIN_PIXELS: u64 = 16;

/// How far an image in f32 is from the one in f64.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// The number of pixels whose error is visible: more than two 8-bit levels.
    pub imprecise: u64,
    /// The largest error of a component, of colors clamped to [0, 1].
    pub largest: f64,
}

impl PartialOrd for Precision {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        let order = self.imprecise.cmp(&other.imprecise);
        Some(order.then(self.largest.total_cmp(&other.largest)))
    }
}

impl Precision {
    /// How many times fewer imprecise pixels there are, or how many times smaller the largest error is.
    pub(crate) fn gain(self, after: Self) -> f64 {
        let fewer = self.imprecise.saturating_sub(after.imprecise);
        let pixels = if after.imprecise == 0 || fewer >= MIN_PIXELS {
            self.imprecise as f64 / (after.imprecise as f64).max(0.5)
        } else {
            1.0
        };
        pixels.max(self.largest / after.largest.max(f64::MIN_POSITIVE))
    }

    /// `largest error 3.1e-2 → 4.0e-7, visible in 120 → 0 pixels`
    pub(crate) fn change(self, after: Self) -> String {
        format!(
            "largest error {:.1e} → {:.1e}, visible in {} → {} pixels",
            self.largest, after.largest, self.imprecise, after.imprecise
        )
    }
}

/// The shader itself, with which variants are compared.
#[derive(Debug)]
pub(crate) struct Judge<'a> {
    shader: &'a Rendered,
    frame: &'a Frame,
    deadline: Instant,
    /// The pixels that other roundings in f32 change visibly; unknown until a variant needs them.
    unstable: OnceCell<Vec<bool>>,
    own: Precision,
}

/// The numbers of random roundings by which unstable pixels are found.
const SEEDS: std::ops::Range<u64> = 1..5;

impl<'a> Judge<'a> {
    /// `shader` has both images.
    pub(crate) fn new(shader: &'a Rendered, frame: &'a Frame, deadline: Instant) -> Self {
        let mut judge = Self {
            shader,
            frame,
            deadline,
            unstable: OnceCell::new(),
            own: Precision {
                imprecise: 0,
                largest: 0.0,
            },
        };
        judge.own = judge.precision(shader);
        judge
    }

    fn double(&self) -> &Image {
        self.shader.double.as_ref().unwrap_or(&self.shader.single)
    }

    fn unstable(&self) -> &[bool] {
        self.unstable.get_or_init(|| {
            let double = self.double().pixels();
            let mut unstable = vec![false; double.len()];
            let program = &self.shader.program;
            let rounded =
                |seed| render::<RandomRounding>(program, self.frame, Seed::single(seed), self.deadline);
            for image in SEEDS.filter_map(rounded) {
                for (at, pixel) in image.pixels().iter().enumerate() {
                    unstable[at] |= difference(pixel, &double[at]) > SEEN;
                }
            }
            unstable
        })
    }

    /// The error of each pixel: of its worst component.
    fn errors<'b>(&'b self, image: &'b Image) -> impl Iterator<Item = f64> + 'b {
        image
            .pixels()
            .iter()
            .zip(self.double().pixels())
            .map(|(a, b)| difference(a, b))
    }

    pub(crate) fn precision(&self, rendered: &Rendered) -> Precision {
        let mut precision = Precision {
            imprecise: 0,
            largest: 0.0,
        };
        for error in self.errors(&rendered.single) {
            precision.imprecise += u64::from(error > SEEN);
            precision.largest = precision.largest.max(error);
        }
        precision
    }

    /// Whether a variant shows the same as the shader in double precision: the identity holds for its values.
    pub(crate) fn is_equal(&self, rendered: &Rendered) -> bool {
        let double = rendered.double.as_ref();
        double.is_some_and(|double| self.errors(double).all(|error| error <= LEVEL))
    }

    /// Whether a pixel is worse by more than one 8-bit level than before. On a silhouette or another edge,
    /// where rounding decides, a pixel may take the color of the other side.
    pub(crate) fn is_worse(&self, before: &Rendered, after: &Rendered) -> bool {
        let pairs = self.errors(&before.single).zip(self.errors(&after.single));
        let mut worse = pairs
            .enumerate()
            .filter(|(_, (before, after))| *after > before + LEVEL);
        worse.any(|(at, _)| !(self.unstable()[at] && self.is_between_neighbors(at, &after.single)))
    }

    /// Whether the color of a pixel lies between those of the pixel and its neighbors in double precision.
    fn is_between_neighbors(&self, at: usize, image: &Image) -> bool {
        let [width, height] = self.double().size().map(|side| side as usize);
        let (x, y) = (at % width, at / width);
        let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        let neighbors = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
        let neighbors: Vec<[f32; 4]> = neighbors.map(|at| self.double().pixels()[at]).collect();
        let color = image.pixels()[at];
        (0..3).all(|component| {
            let values = neighbors.iter().map(|pixel| pixel[component]);
            let least = values.clone().fold(f32::INFINITY, f32::min);
            let most = values.fold(f32::NEG_INFINITY, f32::max);
            let slack = LEVEL as f32;
            (least - slack..=most + slack).contains(&color[component])
        })
    }
}

/// The largest difference of red, green and blue, clamped to [0, 1]; NaN differs from everything else by 1.
fn difference(one: &[f32; 4], other: &[f32; 4]) -> f64 {
    let components = one[..3].iter().zip(&other[..3]);
    let differences = components.map(|(&a, &b)| match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (f64::from(a).clamp(0.0, 1.0) - f64::from(b).clamp(0.0, 1.0)).abs(),
        _ => 1.0,
    });
    differences.fold(0.0, f64::max)
}
