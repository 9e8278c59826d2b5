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
    ($($variant:ident $name:literal $ty:ident $([$length:literal])?: $documentation:literal,)*) => {
        /// A uniform that ShaderToy sets, other than the samplers of channels. In the order of the block.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Input {
            $(#[doc = $documentation] $variant,)*
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

            /// What the input is, with its unit and range, in Markdown.
            pub const fn documentation(self) -> &'static str {
                match self { $(Self::$variant => $documentation,)* }
            }
        }
    };
    (@length) => { None };
    (@length $length:literal) => { Some($length) };
}

inputs! {
    Resolution "iResolution" Vec3:
        "The size of the image: width and height in pixels, and the aspect ratio of a pixel, which is 1.",
    Time "iTime" Float: "The time since the start, in seconds.",
    TimeDelta "iTimeDelta" Float: "The time since the previous frame, in seconds.",
    Frame "iFrame" Int: "The number of the frame, from 0.",
    FrameRate "iFrameRate" Float: "The number of frames per second.",
    ChannelTime "iChannelTime" Float [4]: "The playing time of each channel's film or sound, in seconds.",
    ChannelResolution "iChannelResolution" Vec3 [4]:
        "The size of the texture of each channel: width and height in texels, and depth, which is 1 unless \
        it is a volume.",
    Mouse "iMouse" Vec4:
        "The mouse, in pixels from the lower left: `xy` is its position while the button was last down, \
        `abs(zw)` is where it was pressed. `z` is positive while the button is down, `w` only in the frame \
        in which it was pressed.",
    Date "iDate" Vec4: "The date: year, month from 0, day from 1, and seconds since midnight.",
    SampleRate "iSampleRate" Float: "The rate of the samples of sounds, in hertz.",
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
