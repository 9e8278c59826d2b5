//! The text of lookups in strict shaders: of single texels, and of filters.

use std::fmt::Write as _;

use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{Filter, Sampling, Wrap};

/// The name of the parameter for the offset.
pub(super) const OFFSET: &str = "toyproof_offset";

/// The texture of a channel. A cube map is an array of six images: each has the levels of a face one above
/// the other, with a border of one texel around each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Texture {
    pub(super) channel: u8,
    pub(super) shape: SamplerShape,
}

impl Texture {
    /// The texture, as naga's GLSL combines it with its sampler.
    fn name(self) -> String {
        let Self { channel, shape } = self;
        let ty = match shape {
            SamplerShape::D3 => "sampler3D",
            SamplerShape::Cube | SamplerShape::D2Array => "sampler2DArray",
            SamplerShape::D2 => "sampler2D",
        };
        format!("{ty}(iChannel{channel}, iChannel{channel}_sampler)")
    }

    /// The number of axes of an image, a face or a volume.
    fn axes(self) -> usize {
        if self.shape == SamplerShape::D3 { 3 } else { 2 }
    }

    /// The size of the whole texture.
    fn size(self) -> String {
        match self.shape {
            SamplerShape::Cube => format!("ivec2(textureSize({}, 0).x - 2)", self.name()),
            _ => format!("textureSize({}, 0)", self.name()),
        }
    }

    /// The size of a level. Mesa's software driver returns that of one level to all pixels that it computes
    /// together.
    pub(super) fn size_of_level(self, level: &str) -> String {
        let (size, axes) = (self.size(), self.axes());
        format!("max(ivec{axes}(uvec{axes}({size}) >> uvec{axes}(uint({level}) & 31u)), ivec{axes}(1))")
    }

    /// The number of the last level.
    fn last_level(self) -> String {
        match self.shape {
            // The binary logarithm: the exponent of a float.
            SamplerShape::Cube => {
                format!("int(floatBitsToUint(float(({}).x)) >> 23u) - 127", self.size())
            }
            _ => format!("textureQueryLevels({}) - 1", self.name()),
        }
    }

    /// The body of a fetch of the texel `toyproof_p` in the level `toyproof_a`. Beyond the texture, browsers
    /// return zeros, and naga the texel at the edge.
    pub(super) fn fetch(self) -> String {
        let axes = self.axes();
        let is_near = ["x", "y", "z"][..axes].iter();
        let is_near: Vec<_> = is_near
            .map(|axis| format!("toyproof_near.{axis} == toyproof_at.{axis}"))
            .collect();
        format!(
            "ivec{axes} toyproof_at = toyproof_p + {OFFSET};
    int toyproof_level = min(max(toyproof_a, 0), {last});
    ivec{axes} toyproof_size = {size};
    ivec{axes} toyproof_near = min(max(toyproof_at, ivec{axes}(0)), toyproof_size - ivec{axes}(1));
    vec4 toyproof_texel = texelFetch({texture}, toyproof_near, toyproof_level);
    bool toyproof_is_inside = toyproof_level == toyproof_a
        && {is_near};
    return mix(vec4(0.0), toyproof_texel, bvec4(toyproof_is_inside));",
            last = self.last_level(),
            size = self.size_of_level("toyproof_level"),
            texture = self.name(),
            is_near = is_near.join(" && "),
        )
    }

    /// The body of a lookup at `toyproof_p`: normalized coordinates, or the number of a face and those on it.
    /// With mipmaps, the level is `toyproof_a`; other arguments are ignored.
    pub(super) fn lookup(self, sampling: Sampling) -> String {
        if sampling.filter != Filter::Mipmap {
            let mut text = String::new();
            self.push_level(&mut text, sampling, "0", "0");
            return text + "return toyproof_color0;";
        }
        let mut text = format!(
            "int toyproof_last = {};
    float toyproof_lod = min(max(toyproof_a, 0.0), float(toyproof_last));
    float toyproof_below = floor(toyproof_lod);
    float toyproof_between = toyproof_lod - toyproof_below;
    int toyproof_level = int(toyproof_below);\n    ",
            self.last_level()
        );
        self.push_level(&mut text, sampling, "0", "toyproof_level");
        text += "if (toyproof_between > 0.0) {\n    ";
        let next = "min(toyproof_level + 1, toyproof_last)";
        self.push_level(&mut text, sampling, "1", next);
        text += "toyproof_color0 = toyproof_color0 + (toyproof_color1 - toyproof_color0) * toyproof_between;
    }
    return toyproof_color0;";
        text
    }

    /// Writes the lookup of a level as the variable `toyproof_color{n}`.
    fn push_level(self, text: &mut String, sampling: Sampling, n: &str, level: &str) {
        let axes = self.axes();
        let is_nearest = sampling.filter == Filter::Nearest;
        // Far coordinates, and NaN, must fit an integer.
        let (place, least, most) = match sampling.wrap {
            _ if self.shape == SamplerShape::Cube => ("toyproof_p.yz", "-1.0", "0.0"),
            Wrap::Repeat => ("(toyproof_p - floor(toyproof_p))", "-1.0", "0.0"),
            Wrap::Clamp => ("toyproof_p", "-16.0", "16.0"),
        };
        let half = if is_nearest {
            String::new()
        } else {
            format!(" - vec{axes}(0.5)")
        };
        let _ = write!(
            text,
            "ivec{axes} toyproof_size{n} = {size};
    vec{axes} toyproof_side{n} = vec{axes}(toyproof_size{n});
    vec{axes} toyproof_at{n} = min(max({place} * toyproof_side{n}{half}, vec{axes}({least})), \
             toyproof_side{n} + vec{axes}({most}));
    vec{axes} toyproof_floor{n} = floor(toyproof_at{n});
    ivec{axes} toyproof_i{n} = ivec{axes}(toyproof_floor{n}) + {OFFSET};
    ivec{axes} toyproof_low{n} = {low};\n    ",
            size = if level == "0" {
                self.size()
            } else {
                self.size_of_level(level)
            },
            low = self.wrapped(sampling, n, &format!("toyproof_i{n}")),
        );
        if self.shape == SamplerShape::Cube {
            let _ = write!(
                text,
                "ivec3 toyproof_corner{n} = ivec3(1, 1 + {}, int(toyproof_p.x));\n    ",
                self.row_of_level(level)
            );
        }
        let texel = |corner: usize| {
            let places = ["x", "y", "z"]
                .into_iter()
                .take(axes)
                .enumerate()
                .map(|(at, axis)| {
                    let side = if corner >> at & 1 == 0 { "low" } else { "high" };
                    format!("toyproof_{side}{n}.{axis}")
                });
            let place = places.collect::<Vec<_>>().join(", ");
            let texture = self.name();
            match self.shape {
                SamplerShape::Cube => {
                    format!("texelFetch({texture}, ivec3({place}, 0) + toyproof_corner{n}, 0)")
                }
                _ => format!("texelFetch({texture}, ivec{axes}({place}), {level})"),
            }
        };
        if is_nearest {
            let _ = write!(text, "vec4 toyproof_color{n} = {};\n    ", texel(0));
            return;
        }
        let _ = write!(
            text,
            "ivec{axes} toyproof_high{n} = {high};
    vec{axes} toyproof_weight{n} = toyproof_at{n} - toyproof_floor{n};\n    ",
            high = self.wrapped(sampling, n, &format!("(toyproof_i{n} + ivec{axes}(1))")),
        );
        let corners = 1 << axes;
        for corner in 0..corners {
            let _ = write!(text, "vec4 toyproof_texel{n}{corner} = {};\n    ", texel(corner));
        }
        for (axis, letter) in ["x", "y", "z"].into_iter().take(axes).enumerate() {
            for corner in (0..corners).step_by(2 << axis) {
                let [a, b] = [corner, corner + (1 << axis)].map(|at| format!("toyproof_texel{n}{at}"));
                let _ = write!(
                    text,
                    "{a} = {a} + ({b} - {a}) * toyproof_weight{n}.{letter};\n    "
                );
            }
        }
        let _ = write!(text, "vec4 toyproof_color{n} = toyproof_texel{n}0;\n    ");
    }

    /// Texel coordinates within the image, or within the face of a cube map and its border.
    fn wrapped(self, sampling: Sampling, n: &str, place: &str) -> String {
        let axes = self.axes();
        match (self.shape, sampling.wrap) {
            (SamplerShape::Cube, _) if sampling.filter == Filter::Nearest => {
                format!("min({place}, toyproof_size{n} - ivec2(1))")
            }
            (SamplerShape::Cube, _) => format!("min({place}, toyproof_size{n})"),
            (_, Wrap::Repeat) => {
                format!(
                    "ivec{axes}(uvec{axes}({place} + 32 * toyproof_size{n}) % uvec{axes}(toyproof_size{n}))"
                )
            }
            (_, Wrap::Clamp) => {
                format!("min(max({place}, ivec{axes}(0)), toyproof_size{n} - ivec{axes}(1))")
            }
        }
    }

    /// The first row of a level of a cube map in the image of a face: the levels below it are at most twice as
    /// high as the first, less twice its own height, without their borders.
    fn row_of_level(self, level: &str) -> String {
        if level == "0" {
            return "0".to_owned();
        }
        let whole = format!("2 * ({}).x", self.size());
        format!("{whole} - int(uint({whole}) >> uint({level})) + 2 * ({level})")
    }
}
