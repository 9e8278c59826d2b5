//! The evaluator against a plain interpreter of the tree, bit by bit: in f32 and f64, with each treatment of undefined
//! operations.
//!
//! `TOYPROOF_PROGRAMS` sets the number of random programs (200), `TOYPROOF_SEED` their seed (0).

use std::fs;

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::tree::SamplerShape;
use toyproof::glsl::{self, Checked, Filter, Options, Sampling, Stage, Wrap};
use toyproof::image::{Frame, Texture, pcg};

use crate::support::interpreter::{Comparison, POLICIES, Tally};
use crate::support::judge::programs;
use crate::support::setting;
use crate::support::textures::{random_cube, random_image, random_volume};
use crate::support::wait::HANG_GUARD;

const MAX_STEPS: u64 = 2_000_000;

fn checked(name: &str, text: &str) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new(name, text));
    glsl::check(&files, file, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn compare(checked: &Checked, frame: &Frame, pixels: &[[u32; 2]]) -> Result<Tally, String> {
    let mut tally = Tally::default();
    for policy in POLICIES {
        let comparison = Comparison {
            checked,
            frame,
            policy,
            pixels,
            max_steps: MAX_STEPS,
        };
        tally.add(comparison.run()?);
    }
    Ok(tally)
}

#[test]
fn the_course_is_interpreted_to_the_bit() {
    let frame = Frame {
        size: [64, 36],
        time: 1.25,
        frame: 75,
        ..Frame::default()
    };
    let pixels = [[0, 0], [63, 35], [31, 18], [20, 14], [44, 9]];
    let mut tally = Tally::default();
    for entry in fs::read_dir("glsl").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "glsl") {
            let text = fs::read_to_string(&path).unwrap();
            let compared = compare(&checked(&path.display().to_string(), &text), &frame, &pixels);
            tally.add(compared.unwrap_or_else(|error| panic!("{}: {error}", path.display())));
        }
    }
    eprintln!("the course: {tally}");
    assert!(tally.skipped.is_empty(), "{tally}");
}

#[test]
fn random_programs_are_interpreted_to_the_bit() {
    let count: u32 = setting("TOYPROOF_PROGRAMS", 200);
    let seed: u32 = setting("TOYPROOF_SEED", 0);
    let mut tally = Tally::default();
    let mut state = pcg(seed);
    let mut random = || {
        state = pcg(state);
        state
    };
    for _ in 0..count {
        let length = 8 + random() as usize % 900;
        let bytes: Vec<u8> = (0..length).map(|_| (random() >> 13) as u8).collect();
        tally.add(programs::judge(&bytes, HANG_GUARD).1);
    }
    eprintln!("{count} programs: {tally}");
    // Sixteen pixels of each in two number types; few programs take derivatives where not all pixels do.
    assert!(tally.compared > 31 * u64::from(count), "{tally}");
}

/// Every kind of lookup, and derivatives, in uniform control flow.
const LOOKUPS: &str = "
    vec2 at = p / iResolution.yx * 2.0 - 0.6;
    c = texture(iChannel0, at) + texture(iChannel0, at, 0.75) + texture(iChannel0, at * 9.0, -1.25);
    c += textureOffset(iChannel0, at, ivec2(-8, 7)) * 0.5 + textureOffset(iChannel0, at, ivec2(3, -1), 1.5);
    c += textureLod(iChannel0, at, p.x * 0.2) - textureLodOffset(iChannel0, at, 1.0, ivec2(1, 2));
    c += textureGrad(iChannel0, at, vec2(0.3, 0.1), vec2(0.0, p.y * 0.1));
    c += textureGradOffset(iChannel0, at, at * 0.1, vec2(0.0), ivec2(-2, 0));
    c += textureProj(iChannel0, vec3(at, 0.7)) + textureProj(iChannel0, vec4(at, 3.0, 1.3));
    c += textureProjLod(iChannel0, vec3(at, 1.7), 0.5) + texture(iChannel1, at);
    c += texelFetch(iChannel0, ivec2(p) - 4, int(p.x) / 4 - 1) + texelFetch(iChannel1, ivec2(p), 0);
    c += texelFetchOffset(iChannel0, ivec2(p) - 4, 1, ivec2(3, -2));
    c.xy += vec2(textureSize(iChannel0, MIPMAPS * (2 - int(p.x) / 8))) + iChannelResolution[0].xy + fwidth(c.zw);
    c.z += dFdx(c.y * p.y) + dFdy(dFdx(p.x * p.x * p.y));
    for (int i = 0; i < 3; i++) { c.w += fwidth(p.x * float(i) * c.w); }
    c += texture(iChannel0, p / (p.x - 2.5));
";

/// Every kind of lookup of cube maps and volumes, in all directions.
const LOOKUPS_IN_SPACE: &str = "
    vec3 at = vec3(p.x - 8.7, (p.y - 4.9) * 2.0, 3.0 * sin(p.x * p.y));
    c = texture(iChannel0, at) + texture(iChannel0, at, 0.75) + texture(iChannel0, at.zxy * 9.0, -1.25);
    c += textureLod(iChannel0, -at, p.x * 0.2) + textureLod(iChannel0, at.yzx, 2.9 - p.x * 0.2);
    c += textureGrad(iChannel0, at, at.zxy * 0.1, vec3(0.3, p.y * 0.1, -0.2));
    c.xy += vec2(textureSize(iChannel0, MIPMAPS * (2 - int(p.x) / 8)));
    c += texture(iChannel2, at) + textureLod(iChannel3, at, 0.5) + vec4(textureSize(iChannel2, 0), 0.0, 0.0);
    at = at * 0.11 + 0.2;
    c -= texture(iChannel1, at) + texture(iChannel1, at, 0.75) + texture(iChannel1, at.zxy * 9.0, -1.25);
    c -= textureOffset(iChannel1, at, ivec3(-8, 7, 2)) + textureOffset(iChannel1, at, ivec3(3, -1, 5), 1.5);
    c -= textureLod(iChannel1, at, p.x * 0.2) - textureLodOffset(iChannel1, at, 1.0, ivec3(1, 2, -3));
    c -= textureGrad(iChannel1, at, vec3(0.3, 0.1, 0.2), vec3(0.0, p.y * 0.1, 0.0));
    c -= textureGradOffset(iChannel1, at, at * 0.1, vec3(0.0), ivec3(-2, 0, 1));
    c -= textureProj(iChannel1, vec4(at, 1.3)) + textureProjLod(iChannel1, vec4(at, 0.7), 0.5);
    c -= texelFetch(iChannel1, ivec3(p, p.y) - 4, int(p.x) / 4 - 1);
    c -= texelFetchOffset(iChannel1, ivec3(p.yx, p.x) - 4, 1, ivec3(3, -2, 1));
    c.xyz += vec3(textureSize(iChannel1, MIPMAPS * (2 - int(p.x) / 8))) + iChannelResolution[1];
";

#[test]
fn lookups_of_cube_maps_and_volumes_are_interpreted_to_the_bit() {
    let mut all = Tally::default();
    for filter in [Filter::Nearest, Filter::Linear, Filter::Mipmap] {
        for (wrap, side, volume) in [
            (Wrap::Clamp, 1, [5, 3, 4]),
            (Wrap::Repeat, 4, [8, 4, 2]),
            (Wrap::Repeat, 5, [1, 7, 3]),
        ] {
            let options = Options {
                stage: Stage::Buffer,
                sampling: [Sampling { filter, wrap }; 4],
                channels: [
                    SamplerShape::Cube,
                    SamplerShape::D3,
                    SamplerShape::Cube,
                    SamplerShape::D3,
                ]
                .map(Some),
                ..Options::default()
            };
            let mipmaps = i32::from(filter == Filter::Mipmap);
            let text = format!(
                "#define MIPMAPS {mipmaps}\nvoid mainImage(out vec4 c, in vec2 p) {{ {LOOKUPS_IN_SPACE} }}"
            );
            let mut files = Files::default();
            let file = files.add(File::new("lookups", text));
            let checked = glsl::check(&files, file, &options).unwrap_or_else(|errors| panic!("{errors}"));
            let mut frame = Frame {
                size: [18, 10],
                ..Frame::default()
            };
            let [cube, volume] = [random_cube(side), random_volume(volume)];
            frame.channels = [Some(cube), Some(volume), None, None];
            if filter == Filter::Mipmap {
                frame.channels = frame.channels.map(|texture| texture.map(Texture::with_mipmaps));
            }
            // Each derivative runs the quad again.
            let pixels = [[0, 0], [17, 9], [8, 5], [9, 4], [3, 8], [12, 1]];
            let tally = compare(&checked, &frame, &pixels);
            all.add(tally.unwrap_or_else(|error| panic!("{filter:?} {wrap:?} {side}: {error}")));
        }
    }
    eprintln!("lookups: {all}");
    assert!(all.skipped.is_empty(), "{all}");
}

#[test]
fn lookups_and_derivatives_are_interpreted_to_the_bit() {
    let mut all = Tally::default();
    for filter in [Filter::Nearest, Filter::Linear, Filter::Mipmap] {
        for (wrap, [width, height]) in [
            (Wrap::Clamp, [5, 3]),
            (Wrap::Repeat, [8, 4]),
            (Wrap::Repeat, [1, 7]),
        ] {
            let mut texture = Texture::from(random_image(width, height));
            if filter == Filter::Mipmap {
                texture = texture.with_mipmaps();
            }
            let options = Options {
                stage: Stage::Buffer,
                sampling: [Sampling { filter, wrap }; 4],
                ..Options::default()
            };
            let mipmaps = i32::from(filter == Filter::Mipmap);
            let text =
                format!("#define MIPMAPS {mipmaps}\nvoid mainImage(out vec4 c, in vec2 p) {{ {LOOKUPS} }}");
            let mut files = Files::default();
            let file = files.add(File::new("lookups", text));
            let checked = glsl::check(&files, file, &options).unwrap_or_else(|errors| panic!("{errors}"));
            let mut frame = Frame {
                size: [18, 10],
                ..Frame::default()
            };
            frame.channels[0] = Some(texture);
            // Each derivative runs the quad again.
            let pixels = [[0, 0], [17, 9], [8, 5], [9, 4]];
            let tally = compare(&checked, &frame, &pixels);
            all.add(tally.unwrap_or_else(|error| panic!("{filter:?} {wrap:?}: {error}")));
        }
    }
    eprintln!("lookups: {all}");
    assert!(all.skipped.is_empty(), "{all}");
}

/// Statements, effects and variables that random programs do not have.
const PROGRAMS: [&str; 8] = [
    // The depth is zero once, not where it is mentioned.
    "for (int i = 0; i < 3; i++) { c.x += gl_FragDepth; gl_FragDepth += 1.0; }",
    "if (p.x > 3.0) { gl_FragDepth = 3.0; } c.y = gl_FragDepth; if (p.y > 2.0) c.x = gl_PointCoord.x; c.z = gl_PointCoord.y;",
    "if (p.x > 3.0 && p.y < 2.0) discard; c.x = gl_FrontFacing ? 0.5 : 0.25; c.w = float(gl_MaxDrawBuffers);",
    "switch (int(p.x)) { case 0: float x = 2.0; c.x = x; case 1: x += 1.0; c.y = x; break; default: c.z = x; case 3: c.w = 1.0; }",
    "int i = 0; do { if (i == 2) continue; c.x += float(i); } while (i++ < int(p.x)); while (bool go = c.y < p.y) { c.y += float(go); }",
    "float whole; c.x = modf(-p.x * 1.7, whole); c.y = whole; vec2 w; c.zw = modf(p / 3.0, w); c.xy += w;",
    "int k = int(p.x) - 3; int a[3]; a[0] = 1; a[1] = 2; a[2] = 3; c = vec4(a[k], 7 / k, -7 % k, 1 << (k * 20)); c.x += pow(p.x - 2.5, 0.5);",
    // Sines and cosines of the same angle: one after the other, behind effects and branches, and where only one is reached.
    "float a = p.x * p.y; c.x = cos(a); a += c.x; c.y = sin(a) + cos(a); if (p.x > 4.0) { c.z = sin(p.x); } c.w = cos(p.x); for (int i = 0; i < 3; i++) { c.z += sin(a); if (c.z > 1.0) break; c.w -= cos(a); a = -a * 1.7; }",
];

#[test]
fn rare_statements_are_interpreted_to_the_bit() {
    let frame = Frame {
        size: [8, 6],
        ..Frame::default()
    };
    let pixels: Vec<_> = (0..48).map(|at| [at % 8, at / 8]).collect();
    for body in PROGRAMS {
        let text = format!("void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0.0); {body} }}");
        let tally = compare(&checked("program", &text), &frame, &pixels);
        let tally = tally.unwrap_or_else(|error| panic!("{body}: {error}"));
        assert!(tally.skipped.is_empty(), "{body}: {tally}");
    }
}

#[test]
fn arguments_are_interpreted_in_the_order_of_glslang() {
    let text = "int add(int a, int b) { return a * 16 + b; } int fixed_add(const int a, int b) { return a * 16 + b; }
        void mainImage(out vec4 c, in vec2 p) {
            int i = int(p.x), j = i;
            c = vec4(add(i, i += 4), fixed_add(j, j += 4), i, j);
        }";
    let frame = Frame {
        size: [4, 1],
        ..Frame::default()
    };
    let pixels: Vec<_> = (0..4).map(|x| [x, 0]).collect();
    let tally = compare(&checked("program", text), &frame, &pixels);
    let tally = tally.unwrap_or_else(|error| panic!("{error}"));
    assert!(tally.skipped.is_empty(), "{tally}");
}

/// Each derivative runs the quad again, up to where it is.
#[test]
fn derivatives_in_loops_are_limited_by_the_steps_of_all_runs() {
    let text = "void mainImage(out vec4 c, in vec2 p) {
            c = vec4(0.0);
            for (int i = 0; i < 40; i++) { c.x += fwidth(c.x + p.x); }
        }";
    let checked = checked("program", text);
    let frame = Frame {
        size: [2, 2],
        ..Frame::default()
    };
    let compared = |max_steps| {
        let comparison = Comparison {
            checked: &checked,
            frame: &frame,
            policy: POLICIES[0],
            pixels: &[[0, 0]],
            max_steps,
        };
        comparison.run().unwrap_or_else(|error| panic!("{error}"))
    };
    // One run takes fewer than a thousand steps, all of them more than four thousand.
    assert_eq!(compared(1_000).skipped["too many derivatives"], 2);
    assert!(compared(MAX_STEPS).skipped.is_empty());
}
