//! Legal styles of secondary rays.
//!
//! The tracer has no epsilons: a ray that leaves a surface does not meet the point that it starts from. Shaders cannot know what
//! a ray starts from, so they start it a little off the surface, or do not count what it meets at once. Both are legal,
//! and move an answer where surfaces touch, at shadow edges and in mirrors. [`Tracer::hull`] asks the tracer in
//! each of these styles. How far is a little, the scene says: [`toyproof_scene::Scene::max_offset`].

use super::real::Real;
use super::sampler::{Draws, Sample};
use super::{Tracer, film};

/// How secondary rays start, and what they look for. [`Exact`] costs nothing.
pub(super) trait Style<T: Real> {
    /// How far along the normal they start off their surface, in scene units.
    fn offset(&self) -> T;
    /// How far along their own direction they start, in scene units.
    fn along(&self) -> T;
    /// Hits must lie beyond this t; that of camera rays is 0.
    fn t_min(&self, secondary: bool) -> T;
    /// The style of rays that look for a light, where that of the others is this one.
    fn of_light_rays(&self) -> impl Style<T>;
    /// What rays that look for a light make of it.
    fn lamp(&self) -> Lamp;

    /// Which of them meet the surface that they start from.
    fn acne(&self) -> Acne {
        Acne::default()
    }

    /// Whether they start on their surface itself.
    fn is_on_surface(&self) -> bool {
        self.offset() == T::zero() && self.along() == T::zero()
    }
}

/// What rays that look for a light make of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Lamp {
    /// The direction to a light, or the cone in which it is seen, is that from where the ray starts, not from the surface.
    pub from_start: bool,
    /// A light that is a surface counts only where the ray meets it: at the edge of the cone, a ray that starts elsewhere may not.
    pub must_be_met: bool,
    /// The density with which a light that a path meets by chance would have been sampled is that from the surface, not from
    /// where the ray starts.
    pub weighed_at_surface: bool,
}

/// Which rays of a shader wrongly meet the surface that they start from, where it starts them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Acne {
    /// Those that go on from the n-th surface, by bits from the lowest.
    pub own_met: u32,
    /// Those that look for the n-th light, which is hidden by it.
    pub hidden_lights: u32,
}

/// From the surface itself.
pub(super) struct Exact;

impl<T: Real> Style<T> for Exact {
    fn offset(&self) -> T {
        T::zero()
    }
    fn along(&self) -> T {
        T::zero()
    }
    fn t_min(&self, _: bool) -> T {
        T::zero()
    }
    fn of_light_rays(&self) -> impl Style<T> {
        Self
    }
    fn lamp(&self) -> Lamp {
        Lamp::default()
    }
}

/// Starts off the surface that shaders use, and the smallest t that they accept, by the scene's largest offset.
const OFFSETS: [f64; 3] = [0.0, 0.1, 1.0];
const T_MINS: [f64; 2] = [0.0, 1.0];

/// How a shader may start its secondary rays. Lengths are in scene units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RayStyle {
    /// How far along the normal they start off their surface.
    pub offset: f64,
    /// How far along their own direction they start.
    pub along: f64,
    /// The least t of a hit.
    pub t_min: f64,
    /// What becomes of lights.
    pub lamp: Lamp,
    /// What is wrong with it, if anything is.
    pub acne: Acne,
}

impl RayStyle {
    /// A few from all over what is accepted.
    fn few(max_offset: f64) -> impl Iterator<Item = Self> + Clone {
        let of_offset = move |offset: f64| {
            T_MINS.map(|t_min| Self {
                offset: offset * max_offset,
                t_min: t_min * max_offset,
                ..Self::default()
            })
        };
        OFFSETS.into_iter().flat_map(of_offset)
    }
}

impl Style<f64> for RayStyle {
    fn offset(&self) -> f64 {
        self.offset
    }
    fn along(&self) -> f64 {
        self.along
    }
    fn t_min(&self, secondary: bool) -> f64 {
        if secondary { self.t_min } else { 0.0 }
    }
    fn of_light_rays(&self) -> impl Style<f64> {
        *self
    }
    fn lamp(&self) -> Lamp {
        self.lamp
    }
    fn acne(&self) -> Acne {
        self.acne
    }
}

/// Rays that look for a light start in one style, those that go on in another.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RayStyles {
    /// Those that look for a light.
    pub light: RayStyle,
    /// Those that go on.
    pub other: RayStyle,
}

impl RayStyles {
    /// Both start alike.
    #[must_use]
    pub fn alike(style: RayStyle) -> Self {
        Self {
            light: style,
            other: style,
        }
    }
}

impl Style<f64> for RayStyles {
    fn offset(&self) -> f64 {
        self.other.offset
    }
    fn along(&self) -> f64 {
        self.other.along
    }
    fn t_min(&self, secondary: bool) -> f64 {
        self.other.t_min(secondary)
    }
    fn of_light_rays(&self) -> impl Style<f64> {
        self.light
    }
    fn lamp(&self) -> Lamp {
        self.light.lamp
    }
    fn acne(&self) -> Acne {
        self.other.acne
    }
}

/// Which rays of a shader have one style.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Styles {
    /// All of them.
    Alike,
    /// Those that look for a light have one, those that go on another: six times as many answers.
    Mixed,
}

/// The smallest box that holds all answers, component by component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hull {
    /// The smallest of each component.
    pub low: [f64; 3],
    /// The largest of each component.
    pub high: [f64; 3],
}

impl Hull {
    /// How far `color`, clamped to [0, 1], lies outside of the clamped hull, by the component that is
    /// farthest; infinite for NaN.
    #[must_use]
    pub fn distance(&self, color: [f64; 3]) -> f64 {
        let outside = |i: usize| {
            let [low, high, value] = [self.low[i], self.high[i], color[i]].map(|v| v.clamp(0.0, 1.0));
            if value.is_nan() {
                f64::INFINITY
            } else {
                (low - value).max(value - high).max(0.0)
            }
        };
        (0..3).map(outside).fold(0.0, f64::max)
    }
}

impl Hull {
    /// Of no colours.
    const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    fn take(&mut self, color: [f64; 3]) {
        for (i, component) in color.into_iter().enumerate() {
            self.low[i] = self.low[i].min(component);
            self.high[i] = self.high[i].max(component);
        }
    }
}

impl Tracer<f64> {
    /// The colours that the pixel at (x, y) has in the legal styles. Each sample has its own hull, so that the mean's is
    /// the mean of theirs: which style a shader follows is the same for all samples, but not what it means to each.
    #[must_use]
    pub fn hull(&self, x: u32, y: u32, styles: Styles) -> Hull {
        let legal = || RayStyle::few(self.max_offset);
        let mut sum = Hull {
            low: [0.0; 3],
            high: [0.0; 3],
        };
        let count = self.film.samples;
        for index in 0..count {
            let sample = Sample {
                pixel: [x, y],
                index,
                count,
                set: 0,
            };
            // What the camera sees does not depend on the style.
            let mut draws = Draws::new(self.film.sampler, sample);
            let place = Self::place(sample.pixel, draws.jitter());
            let seen = self.look(self.camera.screen(place));
            let mut hull = Hull::EMPTY;
            for other in legal() {
                if styles == Styles::Alike {
                    hull.take(self.radiance(seen, draws.clone(), &other).to_array());
                    continue;
                }
                for light in legal() {
                    let style = RayStyles { light, other };
                    hull.take(self.radiance(seen, draws.clone(), &style).to_array());
                }
            }
            for i in 0..3 {
                sum.low[i] += hull.low[i];
                sum.high[i] += hull.high[i];
            }
        }
        let mean = |total: f64| film::develop(&self.film, total / f64::from(count));
        Hull {
            low: sum.low.map(mean),
            high: sum.high.map(mean),
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_scene as scene;

    use super::*;

    fn hull(text: &str) -> (Hull, [f64; 3]) {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let tracer = Tracer::<f64>::new(&scene::parse(&files, file).unwrap());
        (tracer.hull(0, 0, Styles::Alike), tracer.pixel(0, 0))
    }

    /// One pixel that looks at a white floor 1 below the eye, where a ball may stand in the light from above.
    fn floor(ball: &str) -> String {
        format!(
            "[film]\nsize = [1, 1]\n[camera]\neye = [0, 0, 0]\nscreen_distance = 1\n\
             [[light]]\nposition = [0, 0, 0]\ncolor = [1, 1, 1]\n\
             [[sphere]]\ncenter = [0, 0, -11]\nradius = 10\n\
             material = {{ model = \"lambert\", color = [1, 1, 1] }}\n{ball}"
        )
    }

    #[test]
    fn away_from_edges_the_hull_is_the_answer() {
        let (hull, exact) = hull(&floor(""));
        assert!(hull.distance(exact) == 0.0);
        assert!((0..3).all(|i| hull.high[i] - hull.low[i] < 1e-12), "{hull:?}");
    }

    #[test]
    fn what_touches_the_surface_may_shade_it_or_not() {
        // The ball hides the light from where the ray meets the floor, and lies nearer than the styles' offset and t.
        let ball = "[[sphere]]\ncenter = [0.000268, 0, -0.999866]\nradius = 0.00005\n\
                    material = { model = \"mirror\", color = [1, 1, 1] }\n";
        let text = floor(ball).replace("position = [0, 0, 0]", "position = [1, 0, -0.5]");
        let (hull, exact) = hull(&text);
        assert_eq!(exact, [0.0; 3]);
        assert_eq!(hull.low, [0.0; 3]);
        // The cosine of the light from a point up to 0.001 higher.
        let cosine = 0.5 / 1.25f64.sqrt();
        assert!((hull.high[0] - cosine).abs() < 1e-3, "{hull:?}");
    }

    #[test]
    fn the_distance_is_zero_inside_and_infinite_for_nan() {
        let hull = Hull {
            low: [0.2; 3],
            high: [0.4, 0.4, 7.0],
        };
        assert_eq!(hull.distance([0.3, 0.2, 1.5]), 0.0);
        assert!((hull.distance([0.3, 0.1, 0.3]) - 0.1).abs() < 1e-15);
        assert_eq!(hull.distance([f64::NAN, 0.3, 0.3]), f64::INFINITY);
    }
}
