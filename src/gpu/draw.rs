//! Painting one frame and reading it back.

use std::borrow::Cow;
use std::ops::Range;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{File, Files};
use toyproof_glsl::{self as glsl};
use toyproof_image::{Frame, Image};
use toyproof_translate::backend::spirv;
use toyproof_translate::naga_ir::{Shape, ValidModule};
use toyproof_translate::{FloatMode, Lowered};
use wgpu::{BindGroup, Buffer, BufferUsages, PollType, RenderPipeline, Texture, TextureUsages};

use super::device::{Device, LoopCap, PROBED_ITERATIONS};
use super::pipeline::{FORMAT, Layout};
use super::{Failure, On};

/// A picture that a shader painted.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Drawn {
    /// The picture, as the float target holds it, in bands of rows from the bottom up, as of [`Frame::bands`]; none where they
    /// were handed over before.
    #[serde(skip)]
    pub bands: Vec<Image>,
    /// Adapter and driver.
    pub device: String,
    /// Whether the shader has loops, and the driver is of a kind that ends loops by force.
    pub(super) may_be_cut_short: bool,
    /// Pixels in which the driver ended a loop by force, whose colours mean nothing; none if that could not be
    /// found out in time. Zero where nobody looked.
    pub cut_short: Option<u64>,
    /// Time for naga to parse, validate and write.
    pub translate: Duration,
    /// Time for the driver to compile.
    pub compile: Duration,
    /// Time to paint and read back.
    pub draw: Duration,
}

impl Drawn {
    /// Whether there is something to be watched.
    #[must_use]
    pub fn may_be_cut_short(&self) -> bool {
        self.may_be_cut_short
    }

    /// The whole picture.
    ///
    /// # Panics
    /// If its bands were taken.
    #[must_use]
    pub fn image(self) -> Image {
        Image::of_bands(self.bands)
    }
}

/// A shader that is compiled and ready to paint.
#[derive(Debug)]
pub(super) struct Scene {
    width: u32,
    bands: Vec<Range<u32>>,
    pipeline: RenderPipeline,
    bindings: BindGroup,
    target: Texture,
    /// Holds one band.
    readback: Buffer,
    bytes_per_row: u32,
}

/// What runs: words, and the textures that they read.
#[derive(Debug)]
pub(super) struct Program {
    words: Vec<u32>,
    channels: [Shape; 4],
    float: FloatMode,
}

impl Program {
    /// naga's words for a module, held to its arithmetic if strict.
    pub(super) fn new(module: &ValidModule, float: FloatMode) -> Result<Self, Failure> {
        let words = spirv::words(module).map_err(Failure::Naga)?;
        Ok(Self {
            words: held_to(words, float),
            channels: module.channels(),
            float,
        })
    }

    /// Another compiler's words.
    pub(super) fn foreign(words: Vec<u32>, channels: [Shape; 4], float: FloatMode) -> Self {
        Self {
            words: held_to(words, float),
            channels,
            float,
        }
    }

    /// As the bytes of a `.spv` file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        spirv::bytes(&self.words)
    }
}

fn held_to(words: Vec<u32>, float: FloatMode) -> Vec<u32> {
    match float {
        FloatMode::Strict => spirv::strict(&words),
        FloatMode::Fast => words,
    }
}

/// A colour that no shader leaves: the alpha of probes is a whole number, that of shaders 1.
const UNPAINTED: wgpu::Color = wgpu::Color {
    r: 0.0,
    g: 0.0,
    b: 0.0,
    a: 0.5,
};

/// llvmpipe runs this many pixels together, on the widest processors, and counts their iterations as one.
const LANES: u32 = 16;

/// A pixel that runs no more rounds of loops than this, all loops together, is ended by force on no driver: Mesa before 23 grants 65,535
/// to all pixels that it runs together.
pub const SAFE_ROUNDS: u32 = 65_535 / LANES;

/// Whether a driver that stops after `cap` iterations can have stopped any pixel of a picture that tells one more
/// than the iterations of each; so it can where the picture tells what no count can be.
pub(super) fn may_reach(iterations: &Image, cap: u32) -> bool {
    let counts = 1.0..cap as f32 / LANES as f32;
    let tells = |alpha: f32| !counts.contains(&alpha) || alpha.fract() != 0.0;
    iterations.pixels().iter().any(|pixel| tells(pixel[3]))
}

/// How many pixels of such a picture ran all the iterations that the driver grants.
pub(super) fn reached(iterations: &Image, cap: u32) -> u64 {
    iterations
        .pixels()
        .iter()
        .filter(|pixel| pixel[3] > cap as f32)
        .count() as u64
}

/// How many pixels of a picture with watched loops tell of one that was ended by force. A pixel that nothing
/// painted does so too, unless the shader discards: code after an endless loop may never be reached.
pub(super) fn cut_short(watched: &Image, discards: bool) -> u64 {
    let unpainted = UNPAINTED.a as f32;
    let cut = |alpha: f32| alpha < unpainted || (alpha <= unpainted && !discards);
    watched.pixels().iter().filter(|pixel| cut(pixel[3])).count() as u64
}

/// A program as a pipeline, for frames of any size.
#[derive(Debug)]
pub(super) struct Compiled {
    layout: Layout,
    pipeline: RenderPipeline,
}

impl Device {
    /// Compiles: a pipeline, and a draw that covers no pixel, since drivers compile when they first draw.
    pub(super) fn prepare(&self, program: &Program, frame: &Frame) -> Result<Scene, Failure> {
        self.stage(&self.compile(program)?, frame)
    }

    /// The pipeline; the driver may do its work when it first draws.
    pub(super) fn compile(&self, program: &Program) -> Result<Compiled, Failure> {
        self.checked(|| {
            let layout = Layout::new(&self.gpu, self.filterable, program.channels);
            let pipeline = layout.pipeline(&self.gpu, &self.run_words(program));
            Ok(Compiled { layout, pipeline })
        })
    }

    /// A program's words as this driver gets them: Mesa's compiler must not take what strict ones spell out for made of uniforms.
    fn run_words<'a>(&self, program: &'a Program) -> Cow<'a, [u32]> {
        match program.float {
            FloatMode::Strict if self.is_lavapipe() => spirv::with_opaque_numbers(&program.words).into(),
            _ => (&program.words).into(),
        }
    }

    /// What a frame is painted with and into, and a draw that covers no pixel.
    pub(super) fn stage(&self, compiled: &Compiled, frame: &Frame) -> Result<Scene, Failure> {
        let [width, height] = frame.size;
        self.checked(|| {
            let target = self.gpu.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let bytes_per_row = (16 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
            let bands: Vec<_> = frame.bands().collect();
            let highest = bands.iter().map(Range::len).max().unwrap_or(0);
            let readback = self.gpu.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: u64::from(bytes_per_row) * highest as u64,
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let scene = Scene {
                width,
                bands,
                pipeline: compiled.pipeline.clone(),
                bindings: compiled.layout.bind(&self.gpu, &self.queue, frame),
                target,
                readback,
                bytes_per_row,
            };
            self.submit(&scene, 3..6)?;
            Ok(scene)
        })
    }

    /// Paints, and hands on one band of rows after the other, from the bottom up.
    pub(super) fn paint(
        &self,
        scene: &Scene,
        mut each: impl FnMut(Image) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.checked(|| {
            self.submit(scene, 0..3)?;
            for (number, rows) in scene.bands.iter().enumerate() {
                // The first has come with the painting.
                if number > 0 {
                    let mut commands = self.gpu.create_command_encoder(&Default::default());
                    scene.copy(&mut commands, rows);
                    self.queue.submit([commands.finish()]);
                    self.wait()?;
                }
                each(self.read(scene, rows)?)?;
            }
            Ok(())
        })
    }

    /// The whole picture.
    pub(super) fn picture(&self, scene: &Scene) -> Result<Image, Failure> {
        let mut bands = Vec::new();
        self.paint(scene, |band| {
            bands.push(band);
            Ok(())
        })?;
        Ok(Image::of_bands(bands))
    }

    /// What lies in the buffer. The target's first row has the smallest fragment coordinates: it is the bottom.
    fn read(&self, scene: &Scene, rows: &Range<u32>) -> Result<Image, Failure> {
        let slice = scene.readback.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        self.wait()?;
        let view = slice
            .get_mapped_range()
            .map_err(|error| Failure::Device(error.to_string()))?;
        let pixels = view
            .chunks(scene.bytes_per_row as usize)
            .take(rows.len())
            .flat_map(|row| row[..16 * scene.width as usize].chunks_exact(16))
            .map(bytemuck::pod_read_unaligned)
            .collect();
        drop(view);
        scene.readback.unmap();
        Ok(Image::new(scene.width, rows.len() as u32, pixels))
    }

    fn submit(&self, scene: &Scene, vertices: Range<u32>) -> Result<(), Failure> {
        let view = scene.target.create_view(&Default::default());
        let mut commands = self.gpu.create_command_encoder(&Default::default());
        {
            let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(UNPAINTED),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            pass.set_pipeline(&scene.pipeline);
            pass.set_bind_group(0, &scene.bindings, &[]);
            pass.draw(vertices, 0..1);
        }
        if let Some(rows) = scene.bands.first() {
            scene.copy(&mut commands, rows);
        }
        self.queue.submit([commands.finish()]);
        self.wait()
    }

    fn wait(&self) -> Result<(), Failure> {
        self.gpu
            .poll(PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|error| Failure::Device(error.to_string()))
    }

    /// Collects what wgpu reports aside: errors of validation and memory, and the loss of the device.
    fn checked<T>(&self, work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        let scopes = [Internal, OutOfMemory, Validation].map(|filter| self.gpu.push_error_scope(filter));
        let result = work();
        // The scope that was opened last closes first. What is built on a device that is lost, or on what the driver or the memory
        // failed to give, is invalid too: the cause is told.
        let error = scopes
            .into_iter()
            .rev()
            .filter_map(|scope| pollster::block_on(scope.pop()))
            .last();
        let lost = self.lost.lock().ok().and_then(|lost| lost.clone());
        match (lost, error) {
            (Some(lost), _) => Err(Failure::Device(lost)),
            (None, Some(error)) => Err(Failure::Device(one_line(&error.to_string()))),
            (None, None) => result,
        }
    }
}

/// wgpu lays its errors out over several lines; a reason is one sentence.
fn one_line(words: &str) -> String {
    words
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(": ")
}

impl Scene {
    /// Copies rows of the target into the buffer.
    fn copy(&self, commands: &mut wgpu::CommandEncoder, rows: &Range<u32>) {
        let target = wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d {
                x: 0,
                y: rows.start,
                z: 0,
            },
            ..self.target.as_image_copy()
        };
        let buffer = wgpu::TexelCopyBufferInfo {
            buffer: &self.readback,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(self.bytes_per_row),
                rows_per_image: None,
            },
        };
        let size = wgpu::Extent3d {
            width: self.width,
            height: rows.len() as u32,
            depth_or_array_layers: 1,
        };
        commands.copy_texture_to_buffer(target, buffer, size);
    }
}

/// A shader compiled on a device of this process: for measuring, where the worker's protection is not wanted.
#[derive(Debug)]
pub struct Painter {
    device: Device,
    scene: Scene,
}

impl Painter {
    /// Translates and compiles.
    ///
    /// # Errors
    /// Why it cannot be run.
    pub fn new(lowered: &Lowered, frame: &Frame, float: FloatMode, on: &On) -> Result<Self, Failure> {
        let module = ValidModule::parse(lowered).map_err(Failure::Refused)?;
        let device = Device::open(on)?;
        let scene = device.prepare(&Program::new(&module, float)?, frame)?;
        Ok(Self { device, scene })
    }

    /// Paints and reads back.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn paint(&mut self) -> Result<Image, Failure> {
        self.device.picture(&self.scene)
    }
}

/// One pixel, and as many iterations as `iFrame` says: the count tells how many the driver granted.
const COUNT: &str = "void mainImage(out vec4 c, in vec2 p) {
    float count = 0.0;
    for (int i = 0; i < iFrame; i++) count += 1.0;
    c = vec4(count);
}";

/// Measures whether the driver ends loops by force.
pub(super) fn measure_cap(device: &Device) -> Result<LoopCap, Failure> {
    let mut files = Files::default();
    let file = files.add(File::new("<loop cap>", COUNT));
    let checked = glsl::check(&files, file, &glsl::Options::default()).map_err(Failure::Invalid)?;
    let lowered = toyproof_translate::lower(&checked);
    let module = ValidModule::parse(&lowered).map_err(Failure::Refused)?;
    let program = Program::new(&module, FloatMode::Strict)?;
    let frame = Frame {
        size: [1, 1],
        frame: PROBED_ITERATIONS as i32,
        ..Frame::default()
    };
    let count = device.picture(&device.prepare(&program, &frame)?)?.get(0, 0)[0] as u32;
    Ok(if count < PROBED_ITERATIONS {
        LoopCap::After(count)
    } else {
        LoopCap::NoneUpTo(count)
    })
}
