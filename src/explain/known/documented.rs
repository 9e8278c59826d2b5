//! The form of what the guide and `toyproof explain` say about mistakes, which stands beside their
//! definitions.

use std::borrow::Cow;

/// A mistake, as the guide lists it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Documented {
    /// The section of the guide.
    pub topic: Topic,
    /// The id, such as `far-root`.
    pub id: &'static str,
    /// Its description; an ellipsis (…) stands for a number, a position or a name.
    pub form: &'static str,
    /// How to fix it: sentences in Markdown.
    pub fix: &'static str,
}

impl Documented {
    /// The description of a mistake, with these texts in place of the ellipses of its form; more are ignored.
    pub(crate) fn description(&self, parts: &[String]) -> Cow<'static, str> {
        if !self.form.contains('…') {
            return self.form.into();
        }
        let pieces = self.form.split('…');
        let parts = parts.iter().map(String::as_str).chain(std::iter::repeat(""));
        let count = self.form.matches('…').count();
        let between = parts.take(count).chain([""]);
        pieces
            .zip(between)
            .flat_map(|(piece, part)| [piece, part])
            .collect::<String>()
            .into()
    }
}

/// A table of [`Documented`]: `Topic "id": "form";` after a comment with the fix.
macro_rules! documented {
    ($($(#[doc = $fix:literal])+ $topic:ident $id:literal: $form:literal;)*) => {
        &[$($crate::known::documented::Documented {
            topic: $crate::known::documented::Topic::$topic,
            id: $id,
            form: $form,
            fix: concat!($($fix),+),
        }),*]
    };
}

pub(crate) use documented;

macro_rules! topics {
    ($($(#[doc = $line:literal])+ $topic:ident $title:literal,)*) => {
        /// A section of the guide, in its order.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Topic {
            $(#[doc = $title] $topic,)*
        }

        impl Topic {
            /// All topics.
            pub const ALL: &[Self] = &[$(Self::$topic),*];

            /// The heading.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$topic => $title,)*
                }
            }

            /// What all mistakes of the topic have in common: a paragraph of Markdown.
            #[must_use]
            pub fn introduction(self) -> &'static str {
                match self {
                    $(Self::$topic => concat!($($line),+).trim_ascii(),)*
                }
            }
        }
    };
}

topics! {
    /// Almost the whole image is lost, and many mistakes look like this. Such a result is reported as a
    /// symptom, not as a mistake.
    Symptom "Symptoms",
    /// The shader solves its task, and its image differs as a whole: it is mirrored, antialiased, or
    /// corrected for gamma. The image is compared again without the difference, by the same rules as any
    /// other, so such a name is reliable. It is found for reference shaders, too, and for images as far as
    /// they allow it. Where the difference does not matter, [`--permit`](checking.md#permitted-differences)
    /// accepts it by its id.
    WholeImage "Right, but not as asked",
    /// A ray that starts on a surface must not hit that surface again at once. Noise like dark dots or rings
    /// is typical. A shader that has it in double precision too is `wrong`; one that has it in float32 only
    /// is `unstable`.
    SelfIntersection "Self-intersection",
    /// The image is stretched, mirrored or shifted as a whole: check how `fragCoord` becomes a point on the
    /// screen, and that point a ray direction.
    Camera "Camera",
    /// Silhouettes are wrong, or the wrong sphere is in front: check the quadratic, the choice of the root,
    /// and the loop that keeps the nearest hit.
    Intersection "Ray–sphere intersection and the nearest hit",
    /// Silhouettes are right and the shading is wrong: show the normal as a color, `0.5 + 0.5 * normal`, and
    /// check that it points outward and has length 1.
    Normals "Normals of spheres",
    /// The image is too bright, too dark, or has a wrong tint: write down the sum, ambient light first, and
    /// check each factor.
    Shading "Lights and shading",
    /// A shadow ray starts slightly off the surface, goes toward the light, and counts only hits before the
    /// light.
    Shadows "Shadows",
    /// Each sample uses one direction in the cone that the light subtends; the cosine, the shadow ray and the
    /// light all belong to this direction.
    SoftShadows "Lights with a radius (soft shadows)",
    /// The reflected ray starts at the hit point and goes along d − 2(d·n)n; its color is multiplied by the
    /// colors of all mirrors before.
    Mirrors "Mirrors",
    /// At each surface, check on which side the ray is, the ratio of the refractive indices (this side over
    /// the other side), and the Fresnel reflectance.
    Glass "Glass",
    /// Each sample is divided by the probability density with which it was chosen; light that two strategies
    /// can sample is weighted (multiple importance sampling, MIS).
    Paths "Path tracing",
    /// Check one sphere at a time: each shows one of the parameters.
    Disney "Disney BRDF (Burley)",
    /// Transform the ray into the quadric's local space, solve the quadratic there, test the ends for both
    /// roots, and transform the normal back.
    Quadrics "Quadrics and checkers",
    /// A ray is in a box from the last of the three slabs that it enters until the first one that it leaves.
    /// A pattern's color depends on whether a sum of whole numbers is odd.
    Boxes "Boxes and patterns",
    /// Check the cell that the ray is in, the cell boundary that it crosses next, and the random numbers from
    /// which the sphere of a cell is made.
    Grids "Grids",
    /// Subtract the pivot, rotate, add the pivot back; apply an object's own rotation first, then the motion
    /// that encloses it.
    Motion "Motion",
    /// The gradient runs from bottom to top: `mix(bottom, top, 0.5 * (1.0 + d.y))` with the normalized ray
    /// direction d.
    Background "Background",
    /// A point is inside a figure where its function is negative; the figure that is tested first is on top.
    Figures "2D figures",
    /// Average the samples first, then apply the tone map, then gamma correction.
    Film "Samples, tone mapping and gamma",
    /// An object is missing, or all spheres have another size.
    Objects "Objects",
    /// One number differs from the scene's. The value that best explains the image is found by a search and
    /// is reported with three digits.
    Numbers "Wrong numbers",
    /// An edit of this kind makes the image of the shader right. The fix states the line and, unless the
    /// edits are hidden from students, the old text and the new text.
    Edits "Mistakes named by their fix",
}
