//! Modules for three.js in Chromium, beside the original with WebGL 2 there.

use toyproof_gpu::browser::{BrowserPass, BrowserRead, Chromium, Text, ThreeModule, uniform_values};
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{Source as Read, Target};

use super::Passes;
use super::three::media;
use crate::graph::SourceEntry;
use crate::original::Original;
use crate::proof::Rgb8Comparison;
use crate::prover::{browser_text, shown};
use crate::{ProofError, Source};

/// The browser with its library, and the comparison.
type Shown = (String, Rgb8Comparison);

/// Renders a shader with one pass and its module in these frames, and compares them except in undefined
/// pixels.
pub(super) fn shader(
    passes: &Passes,
    source: Source,
    module: &str,
    browser: &mut Chromium,
    (frames, undefined): (&[Frame], &[Vec<bool>]),
) -> Result<Shown, ProofError> {
    let sampling = source.checked.sampling;
    // The module has a keyboard of its own, on which no key is down.
    let keyboard = Texture::from(Image::new(256, 3, vec![[0.0, 0.0, 0.0, 1.0]; 3 * 256]));
    let mut frames = frames.to_vec();
    for (channel, entry) in passes.entries[0].iter().enumerate() {
        for frame in &mut frames {
            match entry.as_ref().map(|entry| &entry.source) {
                Some(SourceEntry::Keyboard { .. }) => frame.channels[channel] = Some(keyboard.clone()),
                // No pass renders it.
                Some(SourceEntry::Buffer { .. }) => {
                    let [width, height] = frame.size;
                    let zeros = Image::new(width, height, vec![[0.0; 4]; (width * height) as usize]);
                    frame.channels[channel] = Some(zeros.into());
                }
                None if passes.is_project => frame.channels[channel] = None,
                _ => {}
            }
        }
    }
    let original = browser_text(source)?;
    let original = browser.render(Text::Glsl(&original), sampling, &frames);
    let original = original.map_err(ProofError::BrowserOriginal)?;
    let textures = media(passes).into_iter().filter_map(|medium| {
        let (_, channel) = medium.at;
        let texture = frames[0].channels[channel].as_ref()?;
        Some((medium.name, texture, sampling[channel]))
    });
    let module = ThreeModule {
        text: module,
        textures: textures.collect(),
    };
    let played: Vec<_> = frames.iter().map(|frame| (frame.clone(), true)).collect();
    compare(browser, &original, &module, &played, undefined)
}

/// Plays the passes of a shader and its module in the frames of the original, and compares the images except
/// in undefined pixels.
pub(super) fn passes(
    passes: &Passes,
    module: &str,
    browser: &mut Chromium,
    original: &Original,
) -> Result<Shown, ProofError> {
    let mut size = [0; 2];
    let mut played = Vec::new();
    let mut undefined = Vec::new();
    for (inputs, pixels) in original.images() {
        let restarts = inputs.size != size;
        size = inputs.size;
        played.push((inputs.clone(), restarts));
        undefined.push(pixels.to_vec());
    }
    let zeros = Texture::from(Image::new(256, 3, vec![[0.0, 0.0, 0.0, 1.0]; 3 * 256]));
    let graph = passes.graph.passes();
    let mut pass_texts = Vec::new();
    for (at, (pass, source)) in graph.iter().zip(&passes.sources).enumerate() {
        let reads = std::array::from_fn(|channel| {
            let entry = passes.entries[at][channel].as_ref();
            match (pass.inputs[channel], entry.map(|entry| &entry.source)) {
                (_, Some(SourceEntry::Keyboard { .. })) => BrowserRead::Texture(&zeros),
                (Some(Read::Buffer(number)), _) => BrowserRead::Buffer(number),
                (Some(Read::Medium(number)), _) => BrowserRead::Texture(&passes.media[number]),
                _ => BrowserRead::Nothing,
            }
        });
        pass_texts.push(BrowserPass {
            text: browser_text(*source)?,
            target: pass.target,
            mipmaps: matches!(pass.target, Target::Buffer(buffer) if passes.graph.has_mipmaps(buffer)),
            reads,
            sampling: source.checked.sampling,
            uniforms: uniform_values(source.checked),
        });
    }
    let images = browser
        .play(&pass_texts, &played)
        .map_err(ProofError::BrowserOriginal)?;
    let textures = media(passes).into_iter().filter_map(|medium| {
        let (pass, channel) = medium.at;
        let Some(Read::Medium(number)) = graph[pass].inputs[channel] else {
            return None;
        };
        let sampling = passes.sources[pass].checked.sampling[channel];
        Some((medium.name, &passes.media[number], sampling))
    });
    let module = ThreeModule {
        text: module,
        textures: textures.collect(),
    };
    compare(browser, &images, &module, &played, &undefined)
}

fn compare(
    browser: &mut Chromium,
    original: &[Image],
    module: &ThreeModule,
    frames: &[(Frame, bool)],
    undefined: &[Vec<bool>],
) -> Result<Shown, ProofError> {
    let converted = browser.play_three(module, frames).map_err(ProofError::Browser)?;
    let shown = shown(original, &converted, undefined)?;
    let chromium = browser.name().unwrap_or("Chromium");
    let version = browser.three().map_or("", |library| library.version());
    Ok((format!("{chromium} with three.js {version}"), shown))
}
