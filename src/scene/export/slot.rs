//! Named parts of exported shaders, which can be replaced without knowing their text.
//!
//! A template marks a part as `«Name: text»`; parts may contain others. In the template of a replacement,
//! `…` is the text that is replaced and `«Name»` that of another part, with the parts that these contain.

use std::ops::Range;

macro_rules! slots {
    ($($name:ident)*) => {
        /// The name of a part: an expression, or one or two statements.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "the templates show what each name stands for")]
        pub enum Slot {
            $($name),*
        }

        impl Slot {
            /// All names.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            fn named(name: &str) -> Option<Self> {
                match name {
                    $(stringify!($name) => Some(Self::$name),)*
                    _ => None,
                }
            }

            /// Returns the template of a part of that name.
            pub(super) fn mark(self, template: &str) -> String {
                format!("«{self:?}: {template}»")
            }
        }
    };
}

slots! {
    // Spheres, and the nearest hit.
    CenterToOrigin Discriminant DiscriminantRoot NearRoot FarRoot NearRootIsHit SphereMinT
    FirstSphere SphereCount SphereColor SphereNormal IsNearer HitT HitPoint
    NearestHitSignature InitialT ReturnHit PrimaryRay PlaneMinT
    // Quadrics and checkers.
    NearQuadricIsHit FarQuadricIsHit NearQuadricT FarQuadricT NearQuadricMinT FarQuadricMinT
    RayInFrame OriginInFrame AxisFrame QuadricNormal QuadricSide
    EllipsoidQ EllipsoidEnds ConeSlope ConeLow ParaboloidG HyperboloidK
    CheckerSquare CheckerSum CheckerEven CheckerOdd
    PatternSide PatternSum PatternEven PatternOdd AcrossFace
    // Boxes.
    BoxEnter BoxLeave BoxReach BoxDepth BoxMinT BoxNormal BoxSide
    // Grids.
    GridSteps GridStride GridStep NextCellIsX NextCellIsY CellSeed CellNumber
    CellRadius CellRoom CellPlace CellColor HashResult
    // Motions.
    Rotation RotationCross AngleCosine AngleSine RotationAngle RotationAboutPivot RotatedPoint
    CarriedBy0 CarriedBy1 CarriedBy2 RotationArguments
    // Camera.
    AspectStatement AspectRatio ScreenX ScreenY ScreenYOverAspect CameraDirection ScreenPoint ScreenZ ScreenDistance
    ParallelOffset ParallelDirection Forward LookAt Right RightCross UpReference Up Roll RollDegrees
    // Film.
    FinalColor ToneMapStatement ToneMapped GammaStatement GammaExponent Gamma
    SampleCondition SampleStatement Sample MeanStatement MeanDivisor SampleIndex
    SampleXStatement SampleYStatement SampleX SampleY
    // Background and figures.
    BackgroundStatement BackgroundColor BackgroundHeight BackgroundThroughMirrors BackgroundDirection
    DiskFunction WaveFunction HeartFunction
    // Lights and shadows.
    AmbientTerm LightCount DirectionToLight LightCosine Lit LitAndVisible Visible LightStatement LightSum LightTerm
    Brdf LambertBrdf DiffuseBrdf ViewBrdf DiffuseCase
    ShadowOrigin ShadowOffset ShadowVector ShadowDirection ShadowLength ShadowStatement SoftShadowStatement
    SoftShadowDirection
    // Lights with a radius.
    LightSample ConeCosine ConeUStatement ConeVStatement LightRadiusSquared Turn
    // Burley's BRDF.
    ShadeView RoughnessX RoughnessY HalfVectorX HalfVectorY Anisotropy DiffuseLobe BaseAndSheen BaseOverPi
    SpecularColor SchlickWeight FresnelCosine DiffuseAndSubsurface SpecularAndCoat CoatDistribution Shadowing
    HalfVector SpecularTint
    // Mirrors.
    ReflectedDirection ReflectedOrigin ReflectionOffset MirrorStatement MirrorDepth ColorAfterLastMirror
    // Glass.
    EtaEntering EtaLeaving GlassCosine Refracted RefractedOrigin RefractionOffset ReflectedShare Fresnel
    RefractedThroughput ReflectedThroughput GlassColor TotalReflection
    // Path tracing.
    WeightedEmitter UnweightedEmitter EmitterSample EmitterStatement EmitterShare EmitterChoice EmitterHidden
    EmitterDiffuseBrdf ConeSolidAngle DiffuseDensity DiffuseCosine LobeAxis LobeExponent
    PathStatement PathFactor PathBrdf PathDiffuseBrdf PathDepth PathIsAtEnd SampledOrigin SampledOffset
}

/// A shader with its named parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarkedShader {
    /// The shader.
    pub text: String,
    /// The parts and their ranges; a name may occur several times.
    slots: Vec<(Slot, Range<usize>)>,
}

impl MarkedShader {
    /// Expands a template after a text that has no parts.
    pub(super) fn new(heading: String, template: &str) -> Self {
        let nothing = Self {
            text: String::new(),
            slots: Vec::new(),
        };
        let mut shader = Self {
            text: heading,
            slots: Vec::new(),
        };
        let expanded = shader.expand(template, &nothing, &(0..0));
        assert!(
            expanded.is_some(),
            "a template for a whole shader refers to nothing"
        );
        shader
    }

    /// Whether there is a part of that name.
    pub fn has(&self, slot: Slot) -> bool {
        self.ranges(slot).next().is_some()
    }

    /// Replaces each of the parts by what its template expands to; `None` unless each occurs exactly once,
    /// and outside of the others. Parts that enclose a replaced one lose their name.
    ///
    /// # Panics
    /// If a template is malformed.
    pub fn replaced(&self, edits: &[(Slot, &str)]) -> Option<Self> {
        let edits = edits
            .iter()
            .map(|&(slot, template)| Some((self.only(slot)?, template)));
        self.rewritten(edits.collect::<Option<_>>()?)
    }

    /// Replaces all parts of that name by a text, which has the same name.
    ///
    /// # Panics
    /// If parts of that name contain each other.
    #[must_use]
    pub fn with_all(&self, slot: Slot, text: &str) -> Self {
        let template = slot.mark(text);
        let edits = self.ranges(slot).map(|range| (range.clone(), template.as_str()));
        self.rewritten(edits.collect())
            .expect("parts of one name do not overlap")
    }

    fn ranges(&self, slot: Slot) -> impl Iterator<Item = &Range<usize>> {
        let own = self.slots.iter().filter(move |(name, _)| *name == slot);
        own.map(|(_, range)| range)
    }

    /// The range of the only part of that name.
    fn only(&self, slot: Slot) -> Option<Range<usize>> {
        self.only_in(slot, &(0..self.text.len()))
    }

    /// The range of the only part of that name within another range.
    fn only_in(&self, slot: Slot, outer: &Range<usize>) -> Option<Range<usize>> {
        let mut ranges = self.ranges(slot).filter(|inner| contains(outer, inner));
        ranges.next().filter(|_| ranges.next().is_none()).cloned()
    }

    /// Replaces ranges of the text by templates; `None` if they overlap.
    fn rewritten(&self, mut edits: Vec<(Range<usize>, &str)>) -> Option<Self> {
        edits.sort_by_key(|(range, _)| range.start);
        let mut result = Self {
            text: String::with_capacity(self.text.len()),
            slots: Vec::with_capacity(self.slots.len()),
        };
        let mut done = 0;
        for (range, template) in edits {
            if range.start < done {
                return None;
            }
            result.copy(self, &(done..range.start));
            result.expand(template, self, &range)?;
            done = range.end;
        }
        result.copy(self, &(done..self.text.len()));
        Some(result)
    }

    /// Appends a range of another shader, with the parts in it.
    fn copy(&mut self, from: &Self, range: &Range<usize>) {
        let base = self.text.len();
        self.text += &from.text[range.clone()];
        let moved = |at: usize| at - range.start + base;
        let parts = from.slots.iter().filter(|(_, part)| contains(range, part));
        self.slots
            .extend(parts.map(|(slot, part)| (*slot, moved(part.start)..moved(part.end))));
    }

    /// Appends a template, in which `…` is a range of the original shader and `«Name»` the only part of that
    /// name in this range, or in the whole shader; `None` if there is no such part.
    fn expand(&mut self, template: &str, original: &Self, replaced: &Range<usize>) -> Option<()> {
        let mut open = Vec::new();
        let mut rest = template;
        while let Some(at) = rest.find(['…', '«', '»']) {
            let (plain, marked) = rest.split_at(at);
            self.text += plain;
            if let Some(after) = marked.strip_prefix('…') {
                self.copy(original, replaced);
                rest = after;
            } else if let Some(after) = marked.strip_prefix('»') {
                let (slot, start) = open.pop().expect("each » ends a part");
                self.slots.push((slot, start..self.text.len()));
                rest = after;
            } else {
                let name = marked.trim_start_matches('«');
                let end = name.find([':', '»']).expect("each « begins a part");
                let (name, after) = name.split_at(end);
                let slot = Slot::named(name).unwrap_or_else(|| panic!("no slot has the name {name}"));
                if let Some(after) = after.strip_prefix('»') {
                    let inside = original.only_in(slot, replaced);
                    self.copy(original, &inside.or_else(|| original.only(slot))?);
                    rest = after;
                } else {
                    open.push((slot, self.text.len()));
                    rest = after
                        .strip_prefix(": ")
                        .expect("a space follows the name of a part");
                }
            }
        }
        assert!(open.is_empty(), "each part ends");
        self.text += rest;
        Some(())
    }
}

fn contains(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shader(template: &str) -> MarkedShader {
        MarkedShader::new("// «Title» …\n".to_owned(), template)
    }

    /// The text after the edits, without the heading.
    fn edited(shader: &MarkedShader, edits: &[(Slot, &str)]) -> Option<String> {
        Some(shader.replaced(edits)?.text.lines().nth(1)?.to_owned())
    }

    #[test]
    fn markers_are_not_part_of_the_text() {
        let shader = shader("x = «Brdf: «DiffuseBrdf: color / PI»» * cosine;");
        assert_eq!(shader.text, "// «Title» …\nx = color / PI * cosine;");
        assert!(shader.has(Slot::Brdf) && shader.has(Slot::DiffuseBrdf) && !shader.has(Slot::ViewBrdf));
    }

    #[test]
    fn a_part_is_replaced_only_where_it_occurs_once() {
        let twice = shader("f(«HitT: t», «HitT: u»)");
        assert_eq!(edited(&twice, &[(Slot::HitT, "0.0")]), None);
        assert_eq!(edited(&twice, &[(Slot::HitPoint, "0.0")]), None);
        let all = twice.with_all(Slot::HitT, "0.0");
        assert_eq!(
            all.with_all(Slot::HitT, "1.0").text.lines().nth(1),
            Some("f(1.0, 1.0)")
        );
    }

    #[test]
    fn replacements_refer_to_parts() {
        let swapped = shader("f(«SampleX: x», «SampleY: y»)");
        let edits = [(Slot::SampleX, "«SampleY»"), (Slot::SampleY, "«SampleX» + …")];
        assert_eq!(edited(&swapped, &edits).as_deref(), Some("f(y, x + y)"));
        let nested = shader("«LightTerm: «Brdf: color» * cosine»");
        assert_eq!(
            edited(&nested, &[(Slot::LightTerm, "«Brdf»")]).as_deref(),
            Some("color")
        );
        let overlapping = [(Slot::LightTerm, "… * cosine"), (Slot::Brdf, "1.0")];
        assert_eq!(edited(&nested, &overlapping), None);
    }

    #[test]
    fn parts_keep_their_names_unless_their_text_changes() {
        let nested = shader("«LightTerm: «Brdf: color» * cosine»");
        let wrapped = nested.replaced(&[(Slot::LightTerm, "2.0 * …")]).unwrap();
        assert_eq!(
            edited(&wrapped, &[(Slot::Brdf, "1.0")]).as_deref(),
            Some("2.0 * 1.0 * cosine")
        );
        let inner = nested.replaced(&[(Slot::Brdf, "1.0")]).unwrap();
        assert!(!inner.has(Slot::Brdf) && !inner.has(Slot::LightTerm));
    }
}
