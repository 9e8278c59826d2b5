//! Rendering one frame and reading it back.

use std::ops::Range;

use toyproof_image::{Frame, Image, Sampling};
use toyproof_translate::backend::spirv;
use toyproof_translate::naga_ir::{Shape, ValidModule};
use toyproof_translate::{FloatMode, Lowered};
use wgpu::{BindGroup, PollType, RenderPipeline, Texture, TextureUsages};

use super::device::Device;
use super::pipeline::Layout;
use super::quirks::with_workarounds;
use super::readback::RowBuffer;
use super::texture::flat;
use super::{AdapterSelector, Failure, naga_failed, refused};

/// A compiled shader with the bindings and the target of a frame.
#[derive(Debug)]
pub(super) struct PreparedFrame {
    bands: Vec<Range<u32>>,
    pipeline: RenderPipeline,
    bindings: BindGroup,
    target: Texture,
    /// Holds one band.
    readback: RowBuffer,
}

/// SPIR-V words of a shader, and the shapes of the textures that they sample.
#[derive(Debug)]
pub(super) struct Program {
    words: Vec<u32>,
    channels: [Shape; 4],
    sampling: [Sampling; 4],
    float: FloatMode,
    /// Whether the device must have floats of 16 bits.
    has_halves: bool,
}

impl Program {
    /// Translates a lowered shader, and returns its module, too.
    pub(super) fn of(lowered: &Lowered, float: FloatMode) -> Result<(Self, ValidModule), Failure> {
        let module = ValidModule::parse(lowered).map_err(refused)?;
        let mut words = spirv::words(&module).map_err(naga_failed)?;
        if lowered.is_narrowed() {
            words = spirv::narrowed(&words);
        }
        let program = Self {
            sampling: lowered.sampling(),
            has_halves: lowered.is_narrowed(),
            ..Self::from_words(words, module.channels(), float)
        };
        Ok((program, module))
    }

    /// Sets how the textures are sampled.
    pub(super) fn with_sampling(self, sampling: [Sampling; 4]) -> Self {
        Self { sampling, ..self }
    }

    /// Emits SPIR-V for a module, decorated for strict arithmetic if `float` is strict.
    pub(super) fn new(module: &ValidModule, float: FloatMode) -> Result<Self, Failure> {
        let words = spirv::words(module).map_err(naga_failed)?;
        Ok(Self::from_words(words, module.channels(), float))
    }

    /// Uses the words of a different compiler.
    pub(super) fn from_words(words: Vec<u32>, channels: [Shape; 4], float: FloatMode) -> Self {
        Self {
            words: match float {
                FloatMode::Strict => spirv::strict(&words),
                FloatMode::Fast => words,
            },
            channels,
            sampling: [Sampling::default(); 4],
            float,
            has_halves: false,
        }
    }

    /// Returns the bytes of a `.spv` file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        spirv::bytes(&self.words)
    }
}

/// Clear color, which no shader outputs: the alpha of probes is an integer, that of shaders 1.
pub(crate) const CLEAR_COLOR: wgpu::Color = wgpu::Color {
    r: 0.0,
    g: 0.0,
    b: 0.0,
    a: 0.5,
};

/// A pipeline for frames of any size.
#[derive(Debug)]
pub(super) struct CompiledPipeline {
    pub(super) layout: Layout,
    /// How [`Device::stage`] samples the textures.
    sampling: [Sampling; 4],
    pub(super) pipeline: RenderPipeline,
}

impl Device {
    /// Compiles a program and prepares a frame. Includes a draw that covers no pixel, since drivers compile
    /// on first use.
    pub(super) fn prepare(&self, program: &Program, frame: &Frame) -> Result<PreparedFrame, Failure> {
        self.stage(&self.compile(program)?, frame)
    }

    /// Creates the pipeline; the driver may compile it at the first draw.
    pub(super) fn compile(&self, program: &Program) -> Result<CompiledPipeline, Failure> {
        if program.has_halves && !self.has_halves() {
            return Err(Failure::NoDriver(format!(
                "{} has no floats of 16 bits",
                self.adapter_name()
            )));
        }
        self.with_error_scopes(|| {
            let layout = Layout::new(self, program.channels);
            let words = with_workarounds(&program.words, &self.adapter_name(), program.float);
            let pipeline = layout.pipeline(&self.gpu, &words);
            Ok(CompiledPipeline {
                layout,
                sampling: program.sampling,
                pipeline,
            })
        })
    }

    /// Prepares the bindings and the target of a frame, with a draw that covers no pixel.
    pub(super) fn stage(&self, compiled: &CompiledPipeline, frame: &Frame) -> Result<PreparedFrame, Failure> {
        self.with_error_scopes(|| {
            let target = flat(
                &self.gpu,
                frame.size,
                1,
                TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            );
            let bands: Vec<_> = frame.bands().collect();
            let highest = bands.iter().map(Range::len).max().unwrap_or(0);
            let readback = RowBuffer::new(self, frame.size[0], highest);
            let prepared = PreparedFrame {
                bands,
                pipeline: compiled.pipeline.clone(),
                bindings: {
                    let views = compiled.layout.views(&self.gpu, &self.queue, frame);
                    compiled
                        .layout
                        .bind(&self.gpu, &self.queue, &frame.block(), &views, compiled.sampling)
                },
                target,
                readback,
            };
            self.submit(&prepared, 3..6)?;
            Ok(prepared)
        })
    }

    /// Renders a frame and passes the bands of rows to `on_band`, from the bottom up.
    pub(super) fn render(
        &self,
        prepared: &PreparedFrame,
        mut on_band: impl FnMut(Image) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.with_error_scopes(|| {
            self.submit(prepared, 0..3)?;
            for (number, rows) in prepared.bands.iter().enumerate() {
                // The first band was copied with the draw.
                if number > 0 {
                    let mut commands = self.gpu.create_command_encoder(&Default::default());
                    prepared.readback.copy(&mut commands, &prepared.target, rows);
                    self.queue.submit([commands.finish()]);
                    self.wait()?;
                }
                on_band(prepared.readback.read(self, rows.len())?)?;
            }
            Ok(())
        })
    }

    /// Renders a frame into one image.
    pub(super) fn render_image(&self, prepared: &PreparedFrame) -> Result<Image, Failure> {
        let mut bands = Vec::new();
        self.render(prepared, |band| {
            bands.push(band);
            Ok(())
        })?;
        Ok(Image::of_bands(bands))
    }

    fn submit(&self, prepared: &PreparedFrame, vertices: Range<u32>) -> Result<(), Failure> {
        let view = prepared.target.create_view(&Default::default());
        let mut commands = self.gpu.create_command_encoder(&Default::default());
        let load = wgpu::LoadOp::Clear(CLEAR_COLOR);
        encode(
            &mut commands,
            &view,
            load,
            &prepared.pipeline,
            &prepared.bindings,
            vertices,
        );
        if let Some(rows) = prepared.bands.first() {
            prepared.readback.copy(&mut commands, &prepared.target, rows);
        }
        self.queue.submit([commands.finish()]);
        self.wait()
    }

    pub(super) fn wait(&self) -> Result<(), Failure> {
        self.gpu
            .poll(PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|error| Failure::Device(error.to_string()))
    }

    /// Runs `work` and collects the errors that wgpu reports out of band: validation, memory, and device
    /// loss.
    pub(super) fn with_error_scopes<T>(
        &self,
        work: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        let scopes = [Internal, OutOfMemory, Validation].map(|filter| self.gpu.push_error_scope(filter));
        let result = work();
        // The scope opened last closes first. Resources built on a lost device, or on failed allocations, are
        // invalid too: report the cause.
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

/// Appends a draw of these vertices.
pub(super) fn encode(
    commands: &mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
    pipeline: &RenderPipeline,
    bindings: &BindGroup,
    vertices: Range<u32>,
) {
    let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bindings, &[]);
    pass.draw(vertices, 0..1);
}

/// Joins the lines of wgpu's errors into one sentence.
fn one_line(words: &str) -> String {
    words
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(": ")
}

/// A shader compiled on a device of this process: for measurements, where the isolation of a worker is not
/// needed.
#[derive(Debug)]
pub struct LocalRenderer {
    device: Device,
    prepared: PreparedFrame,
}

impl LocalRenderer {
    /// Translates and compiles a shader.
    ///
    /// # Errors
    /// The failure, if the shader cannot be run.
    pub fn new(
        lowered: &Lowered,
        frame: &Frame,
        float: FloatMode,
        selector: &AdapterSelector,
    ) -> Result<Self, Failure> {
        let (program, _) = Program::of(lowered, float)?;
        let device = Device::open(selector)?;
        let prepared = device.prepare(&program, frame)?;
        Ok(Self { device, prepared })
    }

    /// Renders and reads back.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn render(&mut self) -> Result<Image, Failure> {
        self.device.render_image(&self.prepared)
    }
}
