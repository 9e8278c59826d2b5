//! Texture lookups: filters and mipmaps are exact operations, so that the evaluator in f32 and the strict GPU
//! run have the same bits.

use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::tree::SamplerShape;
use toyproof::glsl::{self, Filter, Sampling, Stage, Wrap};
use toyproof::gpu::Worker;
use toyproof::image::{Frame, Image, Texture};
use toyproof::translate::{FloatMode, lower_strict};

use crate::requirements::require_worker;
use crate::support::textures::{random_cube, random_image, random_volume};

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

/// A texture of random values.
fn texture(width: u32, height: u32, mipmaps: bool) -> Texture {
    let texture = Texture::from(random_image(width, height));
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
            let textures = [0, 1, 2, 3]
                .map(|channel| (channel == 0).then(|| texture(size[0], size[1], filter == Filter::Mipmap)));
            let name = format!("{filter:?} {wrap:?} {size:?}");
            wrong.extend(differing(
                &mut worker,
                (&name, &text),
                &LOOKUPS,
                &options,
                &textures,
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every kind of lookup of a cube map.
const LOOKUPS_OF_CUBES: [&str; 8] = [
    "texture(iChannel0, at)",
    "texture(iChannel0, at, 0.75)",
    "texture(iChannel0, at.zxy * 9.0, -1.25)",
    "textureLod(iChannel0, -at, p.x * 0.2)",
    "textureLod(iChannel0, at.yzx, 2.9 - p.x * 0.2)",
    "textureGrad(iChannel0, at, at.zxy * 0.1, vec3(0.3, p.y * 0.1, -0.2))",
    "vec4(textureSize(iChannel0, MIPMAPS * (2 - int(p.x) / 8)), iChannelResolution[0].xy)",
    "texture(iChannel1, at)",
];

/// Every kind of lookup of a volume.
const LOOKUPS_OF_VOLUMES: [&str; 14] = [
    "texture(iChannel0, at)",
    "texture(iChannel0, at, 0.75)",
    "texture(iChannel0, at.zxy * 9.0, -1.25)",
    "textureOffset(iChannel0, at, ivec3(-8, 7, 2))",
    "textureOffset(iChannel0, at, ivec3(3, -1, 5), 1.5)",
    "textureLod(iChannel0, at, p.x * 0.2)",
    "textureLodOffset(iChannel0, at, 1.0, ivec3(1, 2, -3))",
    "textureGrad(iChannel0, at, vec3(0.3, 0.1, 0.2), vec3(0.0, p.y * 0.1, 0.0))",
    "textureProj(iChannel0, vec4(at, 1.3))",
    "textureProjLod(iChannel0, vec4(at, 0.7), 0.5)",
    "texelFetch(iChannel0, ivec3(p, p.y) - 4, int(p.x) / 4 - 1)",
    "texelFetchOffset(iChannel0, ivec3(p.yx, p.x) - 4, 1, ivec3(3, -2, 1)) + texelFetch(iChannel1, ivec3(p, 0), 0)",
    "vec4(textureSize(iChannel0, MIPMAPS * (2 - int(p.x) / 8)), 1.0)",
    "vec4(iChannelResolution[0], 0.0) + texture(iChannel1, at)",
];

#[test]
fn every_lookup_of_cube_maps_and_volumes_has_the_same_bits_on_the_cpu() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let mut wrong = Vec::new();
    for filter in [Filter::Nearest, Filter::Linear, Filter::Mipmap] {
        for (wrap, side, size) in [
            (Wrap::Clamp, 1, [5, 3, 4]),
            (Wrap::Repeat, 8, [8, 4, 2]),
            (Wrap::Repeat, 5, [1, 7, 3]),
        ] {
            for (shape, texture, lookups) in [
                (SamplerShape::Cube, random_cube(side), &LOOKUPS_OF_CUBES[..]),
                (SamplerShape::D3, random_volume(size), &LOOKUPS_OF_VOLUMES),
            ] {
                let is_mipmap = filter == Filter::Mipmap;
                let texture = if is_mipmap {
                    texture.with_mipmaps()
                } else {
                    texture
                };
                let options = glsl::Options {
                    stage: Stage::Buffer,
                    sampling: [Sampling { filter, wrap }; 4],
                    channels: [Some(shape); 4],
                    ..glsl::Options::default()
                };
                let cases = lookups.iter().enumerate();
                let cases = cases.map(|(at, lookup)| format!("case {at}: color = {lookup}; break;"));
                let text = format!(
                    "#define MIPMAPS {}
                    void mainImage(out vec4 color, in vec2 p) {{
                        vec3 at = vec3(p.x - 8.7, (p.y - 4.9) * 2.0, (p.x * p.y - 40.0) * 0.1) * 0.4;
                        color = vec4(0.0);
                        switch (iFrame) {{ {} }}
                    }}",
                    i32::from(is_mipmap),
                    cases.collect::<Vec<_>>().join("\n")
                );
                let name = format!("{filter:?} {wrap:?} {shape:?} {:?}", texture.size());
                let textures = [Some(texture), None, None, None];
                wrong.extend(differing(
                    &mut worker,
                    (&name, &text),
                    lookups,
                    &options,
                    &textures,
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Renders the frame of each lookup, and names those of which the driver has other bits.
fn differing(
    worker: &mut Worker,
    (name, text): (&str, &str),
    lookups: &[&str],
    options: &glsl::Options,
    channels: &[Option<Texture>; 4],
) -> Vec<String> {
    let mut files = Files::default();
    let file = files.add(File::new("lookups", text));
    let checked = glsl::check(&files, file, options).unwrap_or_else(|errors| panic!("{errors}"));
    let program = Program::new(&checked).unwrap();
    let mut wrong = Vec::new();
    for (frame, lookup) in (0..).zip(lookups) {
        let frame = Frame {
            size: [18, 10],
            frame,
            channels: channels.clone(),
            ..Frame::default()
        };
        let own = program.render::<f32>(&frame, &Settings::default()).unwrap();
        assert_eq!(own.framebuffer.undefined(), 0, "{lookup}: {:?}", own.observations);
        let drawn = worker.draw(lower_strict(&checked), frame, FloatMode::Strict);
        let drawn = drawn
            .unwrap_or_else(|failure| panic!("{name} {lookup}: {failure}"))
            .image();
        let own = own.framebuffer.image();
        let bits = |image: &Image| -> Vec<_> {
            let components = image.pixels().iter().flatten();
            components.map(|component| component.to_bits()).collect()
        };
        let pairs = bits(&own).into_iter().zip(bits(&drawn));
        let count = pairs.filter(|(a, b)| a != b).count();
        if count > 0 {
            wrong.push(format!("{name} {lookup}: {count} differ"));
        }
        assert!(
            own.pixels().iter().flatten().any(|component| *component != 0.0),
            "{lookup} is black"
        );
    }
    wrong
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

/// The sampler of the driver filters and wraps along each axis.
#[test]
fn the_sampler_of_fast_runs_is_the_one_of_the_channel() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let flat = Texture::from(random_image(8, 4));
    for (shape, texture, at) in [
        (SamplerShape::D2, flat, "at.xy"),
        (SamplerShape::Cube, random_cube(8), "at - 0.5"),
        (SamplerShape::D3, random_volume([8, 4, 2]), "at"),
    ] {
        for filter in [Filter::Nearest, Filter::Linear] {
            for wrap in [Wrap::Clamp, Wrap::Repeat] {
                let options = glsl::Options {
                    stage: Stage::Buffer,
                    sampling: [Sampling { filter, wrap }; 4],
                    channels: [Some(shape); 4],
                    ..glsl::Options::default()
                };
                let text = format!(
                    "void mainImage(out vec4 color, in vec2 p) {{
                        vec3 at = vec3(p, 22.0 - p.x - p.y) * 0.097 - 0.41;
                        color = textureLod(iChannel0, {at}, 0.0);
                    }}"
                );
                let mut files = Files::default();
                let file = files.add(File::new("sampler", text));
                let checked = glsl::check(&files, file, &options).unwrap();
                let frame = Frame {
                    size: [18, 10],
                    channels: [Some(texture.clone()), None, None, None],
                    ..Frame::default()
                };
                let own = Program::new(&checked).unwrap();
                let own = own.render::<f32>(&frame, &Settings::default()).unwrap();
                let own = own.framebuffer.image();
                let drawn = worker.draw(FloatMode::Fast.lower(&checked), frame, FloatMode::Fast);
                let drawn = drawn.unwrap().image();
                let pairs = own.pixels().iter().flatten().zip(drawn.pixels().iter().flatten());
                let largest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                // Vulkan lets a driver round the weights of the filter to 8 bits.
                assert!(largest < 0.02, "{shape:?} {filter:?} {wrap:?}: {largest}");
            }
        }
    }
}
