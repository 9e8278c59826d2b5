//! The table of a shader's inputs: the uniforms that ShaderToy sets, and their layout in the uniform block.

/// The type of an input, or of the elements of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputType {
    /// `float`
    Float,
    /// `int`
    Int,
    /// `vec3`
    Vec3,
    /// `vec4`
    Vec4,
}

impl InputType {
    /// The name in GLSL.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Int => "int",
            Self::Vec3 => "vec3",
            Self::Vec4 => "vec4",
        }
    }

    /// The number of components, each of 4 bytes.
    pub const fn components(self) -> usize {
        match self {
            Self::Float | Self::Int => 1,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
        }
    }
}

macro_rules! inputs {
    ($($(#[doc = $doc:literal])* $variant:ident $name:literal $ty:ident $([$length:literal])?,)*) => {
        /// A uniform that ShaderToy sets, other than the samplers of channels. In the order of the block.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Input {
            $($(#[doc = $doc])* $variant,)*
        }

        impl Input {
            /// All inputs, in the order of the block.
            pub const ALL: [Self; [$(Self::$variant),*].len()] = [$(Self::$variant),*];

            /// The name in a shader.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The type, for an array that of its elements.
            pub const fn ty(self) -> InputType {
                match self { $(Self::$variant => InputType::$ty,)* }
            }

            /// The number of elements of an array; `None` for other types.
            pub const fn length(self) -> Option<usize> {
                match self { $(Self::$variant => inputs!(@length $($length)?),)* }
            }
        }
    };
    (@length) => { None };
    (@length $length:literal) => { Some($length) };
}

inputs! {
    /// Pixels, pixels, pixel aspect (1).
    Resolution "iResolution" Vec3,
    /// Seconds.
    Time "iTime" Float,
    /// Seconds since the previous frame.
    TimeDelta "iTimeDelta" Float,
    /// From 0.
    Frame "iFrame" Int,
    /// Frames per second.
    FrameRate "iFrameRate" Float,
    /// Seconds.
    ChannelTime "iChannelTime" Float [4],
    /// Texels, texels, depth.
    ChannelResolution "iChannelResolution" Vec3 [4],
    /// Pixels: xy is the last drag position, zw the click.
    Mouse "iMouse" Vec4,
    /// Year, month from 0, day, seconds since midnight.
    Date "iDate" Vec4,
    /// Hertz.
    SampleRate "iSampleRate" Float,
}

/// The alignment of vectors and arrays in std140, and the distance of array elements, in bytes.
pub(crate) const VECTOR_BYTES: usize = 16;

impl Input {
    /// The size in the uniform block, in bytes.
    pub const fn size(self) -> usize {
        match self.length() {
            Some(length) => VECTOR_BYTES * length,
            None => 4 * self.ty().components(),
        }
    }

    /// The alignment in the uniform block by the rules of std140 (OpenGL 4.6 §7.6.2.2), in bytes.
    pub const fn align(self) -> usize {
        if self.length().is_some() || self.ty().components() > 1 {
            VECTOR_BYTES
        } else {
            4
        }
    }

    /// The first byte in the uniform block. Hosts rely on it.
    pub const fn offset(self) -> usize {
        let mut end: usize = 0;
        let mut at = 0;
        while at < self as usize {
            let before = Self::ALL[at];
            end = end.next_multiple_of(before.align()) + before.size();
            at += 1;
        }
        end.next_multiple_of(self.align())
    }
}

/// The size of the uniform block in bytes.
pub const BLOCK_BYTES: usize = {
    let last = Input::ALL[Input::ALL.len() - 1];
    (last.offset() + last.size()).next_multiple_of(VECTOR_BYTES)
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_has_the_documented_offsets() {
        let offsets = Input::ALL.map(|input| (input.name(), input.offset()));
        let documented = [
            ("iResolution", 0),
            ("iTime", 12),
            ("iTimeDelta", 16),
            ("iFrame", 20),
            ("iFrameRate", 24),
            ("iChannelTime", 32),
            ("iChannelResolution", 96),
            ("iMouse", 160),
            ("iDate", 176),
            ("iSampleRate", 192),
        ];
        assert_eq!(offsets, documented);
        assert_eq!(BLOCK_BYTES, 208);
    }
}
