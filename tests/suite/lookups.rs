//! Texture lookups: filters and mipmaps are exact operations, so that the evaluator in f32 and the strict GPU
//! run have the same bits.

use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::{self, Filter, Sampling, Stage, Wrap};
use toyproof::image::{Frame, Image, Texture, pcg};
use toyproof::translate::{FloatMode, lower_strict};

use crate::requirements::require_worker;

/// Every kind of lookup, at coordinates within and beyond the texture.
const LOOKUPS: [&str; 21] = [
    "texture(iChannel0, at)",
    "texture(iChannel0, at, 0.75)",
    "texture(iChannel0, at * 9.0, -1.25)",
    "textureOffset(iChannel0, at, ivec2(-8, 7))",
    "textureOffset(iChannel0, at, ivec2(3, -1), 1.5)",
    "textureLod(iChannel0, at, p.x * 0.2)",
    "textureLodOffset(iChannel0, at, 1.0, ivec2(1, 2))",
    "textureGrad(iChannel0, at, vec2(0.3, 0.1), vec2(0.0, p.y * 0.1))",
    "textureGradOffset(iChannel0, at, at * 0.1, vec2(0.0), ivec2(-2, 0))",
    "textureProj(iChannel0, vec3(at, 0.7))",
    "textureProj(iChannel0, vec4(at, 3.0, 1.3))",
    "textureProjLod(iChannel0, vec3(at, 1.7), 0.5)",
    "texelFetch(iChannel0, textureSize(iChannel0, 0) / 2, 0)",
    "texelFetch(iChannel0, ivec2(p) - 4, int(p.x) / 4 - 1)",
    "texelFetchOffset(iChannel0, ivec2(p) - 4, 1, ivec2(3, -2)) + texelFetch(iChannel1, ivec2(p), 0)",
    // The level falls from left to right.
    "textureLod(iChannel0, at, 2.9 - p.x * 0.2)",
    "texelFetch(iChannel0, ivec2(p) / 16, 3 - int(p.x) / 5)",
    "vec4(textureSize(iChannel0, MIPMAPS * (2 - int(p.x) / 8)), 0.0, 1.0)",
    "vec4(textureSize(iChannel0, 0), iChannelResolution[0].xy)",
    // The levels of these vary within groups of 2×2 pixels, which naga's own check of texels does not allow for.
    "through(iChannel0, at * p.y)",
    "through(iChannel0, at / (p.y + 0.5))",
];

/// A texture of random values between −1 and 2.
fn texture(width: u32, height: u32, mipmaps: bool) -> Texture {
    let value = |at: u32| 3.0 * (pcg(at) as f32 / u32::MAX as f32) - 1.0;
    let pixels = (0..width * height).map(|at| [0, 1, 2, 3].map(|component| value(4 * at + component)));
    let texture = Texture::from(Image::new(width, height, pixels.collect()));
    if mipmaps { texture.with_mipmaps() } else { texture }
}

#[test]
fn every_lookup_has_the_same_bits_on_the_cpu() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let mut wrong = Vec::new();
    for filter in [Filter::Nearest, Filter::Linear, Filter::Mipmap] {
        for (wrap, size) in [
            (Wrap::Clamp, [5, 3]),
            (Wrap::Repeat, [8, 4]),
            (Wrap::Repeat, [1, 7]),
        ] {
            // The alpha of a buffer is compared, too.
            let options = glsl::Options {
                stage: Stage::Buffer,
                sampling: [Sampling { filter, wrap }; 4],
                ..glsl::Options::default()
            };
            let cases = LOOKUPS.iter().enumerate();
            let cases = cases.map(|(at, lookup)| format!("case {at}: color = {lookup}; break;"));
            let lookups = cases.collect::<Vec<_>>().join("\n");
            // The derivatives of all lookups are taken in uniform control flow.
            let text = format!(
                "#define MIPMAPS {}
                vec4 through(sampler2D channel, vec2 at) {{
                    return texture(channel, at) + texelFetch(channel, ivec2(9.0 * at), int(at.x) & 1);
                }}
                void mainImage(out vec4 color, in vec2 p) {{
                    vec2 at = p / iResolution.yx * 2.0 - 0.6;
                    color = vec4(0.0);
                    switch (iFrame) {{ {lookups} }}
                }}",
                i32::from(filter == Filter::Mipmap)
            );
            let mut files = Files::default();
            let file = files.add(File::new("lookups", text));
            let checked = glsl::check(&files, file, &options).unwrap();
            let program = Program::new(&checked).unwrap();
            for (frame, lookup) in (0..).zip(LOOKUPS) {
                let frame = Frame {
                    size: [18, 10],
                    frame,
                    channels: [0, 1, 2, 3].map(|channel| {
                        (channel == 0).then(|| texture(size[0], size[1], filter == Filter::Mipmap))
                    }),
                    ..Frame::default()
                };
                let own = program.render::<f32>(&frame, &Settings::default()).unwrap();
                assert_eq!(own.framebuffer.undefined(), 0, "{lookup}: {:?}", own.observations);
                let drawn = worker
                    .draw(lower_strict(&checked), frame, FloatMode::Strict)
                    .unwrap()
                    .image();
                let own = own.framebuffer.image();
                let bits = |image: &Image| -> Vec<_> {
                    image
                        .pixels()
                        .iter()
                        .flatten()
                        .map(|component| component.to_bits())
                        .collect()
                };
                let differing = bits(&own)
                    .iter()
                    .zip(bits(&drawn))
                    .filter(|(a, b)| **a != *b)
                    .count();
                if differing > 0 {
                    wrong.push(format!(
                        "{filter:?} {wrap:?} {size:?} {lookup}: {differing} differ"
                    ));
                }
                assert!(
                    own.pixels().iter().flatten().any(|component| *component != 0.0),
                    "{lookup} is black"
                );
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn fetches_beyond_a_texture_are_zeros_in_fast_runs() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let text = "void mainImage(out vec4 color, in vec2 p) {
        color = vec4(texelFetch(iChannel0, ivec2(p) - 4, 0).xyz, 1.0);
    }";
    let mut files = Files::default();
    let file = files.add(File::new("fetches", text.to_owned()));
    let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
    let frame = Frame {
        size: [12, 11],
        channels: [Some(texture(5, 3, false)), None, None, None],
        ..Frame::default()
    };
    let own = Program::new(&checked).unwrap();
    let own = own.render::<f32>(&frame, &Settings::default()).unwrap();
    let drawn = worker.draw(FloatMode::Fast.lower(&checked), frame, FloatMode::Fast);
    assert_eq!(own.framebuffer.image(), drawn.unwrap().image());
}
