//! The passes of a shader on the device: textures stay there from frame to frame.

use std::sync::OnceLock;

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::{self as glsl, Stage};
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{Channel, ChannelSampling, Player, Readback, Renderer};
use toyproof_translate::naga_ir::ValidModule;
use toyproof_translate::{FloatMode, Lowered, lower_strict};
use wgpu::{TextureUsages, TextureView, TextureViewDescriptor};

use super::device::Device;
use super::draw::{CompiledPipeline, Program, encode};
use super::texture::{extent, flat, upload, write};
use super::{Failure, refused};

/// Renders passes on a device.
#[derive(Debug)]
pub(super) struct PassRenderer {
    device: Device,
    passes: Vec<CompiledPipeline>,
    /// The samplers of each pass.
    sampling: Vec<[ChannelSampling; 4]>,
    media: Vec<wgpu::Texture>,
    /// Renders a mipmap from the next larger one; compiled if a buffer has mipmaps.
    halving: OnceLock<CompiledPipeline>,
}

impl PassRenderer {
    /// Compiles the passes and uploads the textures that do not change.
    pub(super) fn new(
        device: Device,
        programs: &[Program],
        sampling: Vec<[ChannelSampling; 4]>,
        media: &[Texture],
    ) -> Result<Self, (Device, Failure)> {
        let passes = programs.iter().map(|program| device.compile(program)).collect();
        match passes {
            Ok(passes) => Ok(Self {
                media: media
                    .iter()
                    .map(|texture| upload(&device.gpu, &device.queue, texture))
                    .collect(),
                passes,
                sampling,
                halving: OnceLock::new(),
                device,
            }),
            Err(failure) => Err((device, failure)),
        }
    }

    /// The device, whose textures are freed.
    pub(super) fn into_device(self) -> Device {
        self.device
    }

    pub(super) fn device_name(&self) -> String {
        self.device.name()
    }

    /// Uploads a texture of a saved state, and computes its mipmaps if it shall have any.
    pub(super) fn load(&mut self, texture: &Texture, mipmaps: bool) -> Result<wgpu::Texture, Failure> {
        let made = self.zeros(texture.size(), mipmaps)?;
        self.device.with_error_scopes(|| {
            if let Some(image) = texture.to_single().first() {
                write(&self.device.queue, &made, 0, extent(image.size()), image.pixels());
            }
            self.make_mipmaps(&made)
        })?;
        Ok(made)
    }

    /// Renders over a view of one level, whose pixels are kept where nothing is written.
    fn submit(
        &self,
        compiled: &CompiledPipeline,
        frame: &Frame,
        channels: [Option<(TextureView, [u32; 2])>; 4],
        sampling: [ChannelSampling; 4],
        target: &TextureView,
    ) -> Result<(), Failure> {
        let Device { gpu, queue, .. } = &self.device;
        let sizes = channels
            .each_ref()
            .map(|channel| channel.as_ref().map(|(_, size)| *size));
        let mut channels = channels.into_iter();
        let views = std::array::from_fn(|channel| {
            // A view of two dimensions fits no other declaration.
            let view = channels
                .next()
                .flatten()
                .filter(|_| compiled.layout.is_flat(channel));
            view.map_or_else(|| compiled.layout.unbound(gpu, queue, channel), |(view, _)| view)
        });
        let bindings = compiled
            .layout
            .bind(gpu, queue, &frame.block_with(sizes), &views, sampling);
        let mut commands = gpu.create_command_encoder(&Default::default());
        let load = wgpu::LoadOp::Load;
        encode(&mut commands, target, load, &compiled.pipeline, &bindings, 0..3);
        queue.submit([commands.finish()]);
        self.device.wait()
    }

    /// Renders all mipmaps of a texture, as [`Image::halved`] computes them.
    fn make_mipmaps(&self, texture: &wgpu::Texture) -> Result<(), Failure> {
        if texture.mip_level_count() == 1 {
            return Ok(());
        }
        let halving = if let Some(halving) = self.halving.get() {
            halving
        } else {
            let compiled = self.device.compile(&halving_program()?)?;
            self.halving.get_or_init(|| compiled)
        };
        for level in 1..texture.mip_level_count() {
            let of = |level: u32| {
                let side = |side: u32| (side >> level).max(1);
                (
                    level_view(texture, level),
                    [side(texture.width()), side(texture.height())],
                )
            };
            let (target, size) = of(level);
            let frame = Frame {
                size,
                ..Frame::default()
            };
            let channels = [Some(of(level - 1)), None, None, None];
            self.submit(halving, &frame, channels, Default::default(), &target)?;
        }
        Ok(())
    }
}

/// The shader that renders a mipmap from the next larger level, with the steps of [`Image::halved`].
const HALVING: &str = "
void mainImage(out vec4 color, in vec2 position) {
    ivec2 size = textureSize(iChannel0, 0);
    ivec2 to = ivec2(iResolution.xy);
    ivec2 numerator = (2 * ivec2(position) + 1) * size - to;
    ivec2 low = numerator / (2 * to);
    ivec2 high = min(low + 1, size - 1);
    vec2 weight = vec2(numerator - low * 2 * to) / vec2(2 * to);
    vec4 a = texelFetch(iChannel0, low, 0);
    vec4 b = texelFetch(iChannel0, ivec2(high.x, low.y), 0);
    vec4 c = texelFetch(iChannel0, ivec2(low.x, high.y), 0);
    vec4 d = texelFetch(iChannel0, high, 0);
    vec4 lower = a + (b - a) * weight.x;
    vec4 upper = c + (d - c) * weight.x;
    color = lower + (upper - lower) * weight.y;
}";

fn halving_program() -> Result<Program, Failure> {
    let mut files = Files::default();
    let file = files.add(File::new("<mipmaps>", HALVING));
    let options = glsl::Options {
        stage: Stage::Buffer,
        ..glsl::Options::default()
    };
    let checked = glsl::check(&files, file, &options).map_err(refused)?;
    let module = ValidModule::parse(&lower_strict(&checked)).map_err(refused)?;
    Program::new(&module, FloatMode::Strict)
}

/// The SPIR-V of all passes.
pub(super) fn programs(passes: &[(Lowered, FloatMode)]) -> Result<Vec<Program>, Failure> {
    let program = |(lowered, float): &(Lowered, FloatMode)| {
        Program::new(&ValidModule::parse(lowered).map_err(refused)?, *float)
    };
    passes.iter().map(program).collect()
}

fn level_view(texture: &wgpu::Texture, level: u32) -> TextureView {
    texture.create_view(&TextureViewDescriptor {
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

/// The number of levels down to 1×1.
fn levels(size: [u32; 2]) -> u32 {
    size[0].max(size[1]).ilog2() + 1
}

impl Renderer for PassRenderer {
    type Texture = wgpu::Texture;
    type Error = Failure;

    fn zeros(&mut self, size: [u32; 2], mipmaps: bool) -> Result<wgpu::Texture, Failure> {
        let usage = TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC
            | TextureUsages::COPY_DST;
        let levels = if mipmaps { levels(size) } else { 1 };
        self.device
            .with_error_scopes(|| Ok(flat(&self.device.gpu, size, levels, usage)))
    }

    fn draw(
        &mut self,
        pass: usize,
        over: wgpu::Texture,
        frame: &Frame,
        channels: [Channel<'_, wgpu::Texture>; 4],
    ) -> Result<wgpu::Texture, Failure> {
        self.device.with_error_scopes(|| {
            let channels = channels.map(|channel| {
                let texture = match channel {
                    Channel::Unbound => return None,
                    Channel::Texture(texture) => texture.clone(),
                    Channel::Medium(number) => self.media.get(number)?.clone(),
                    Channel::Keyboard => upload(&self.device.gpu, &self.device.queue, &frame.keys.texture()),
                };
                let size = [texture.width(), texture.height()];
                Some((texture.create_view(&Default::default()), size))
            });
            let (compiled, sampling) = (&self.passes[pass], self.sampling[pass]);
            self.submit(compiled, frame, channels, sampling, &level_view(&over, 0))?;
            self.make_mipmaps(&over)
        })?;
        Ok(over)
    }

    fn resized(&mut self, texture: wgpu::Texture, size: [u32; 2]) -> Result<wgpu::Texture, Failure> {
        let made = self.zeros(size, texture.mip_level_count() > 1)?;
        self.device.with_error_scopes(|| {
            let common = [size[0].min(texture.width()), size[1].min(texture.height())];
            let mut commands = self.device.gpu.create_command_encoder(&Default::default());
            commands.copy_texture_to_texture(texture.as_image_copy(), made.as_image_copy(), extent(common));
            self.device.queue.submit([commands.finish()]);
            self.device.wait()?;
            self.make_mipmaps(&made)
        })?;
        Ok(made)
    }
}

/// The frames of a shader, as the worker renders them.
pub(super) type DevicePlayer = Player<PassRenderer>;

/// Reads a texture of a player back.
pub(super) fn read(player: &DevicePlayer, what: Readback) -> Result<Image, Failure> {
    let texture = match what {
        Readback::Last(target) => player.texture(target),
        Readback::Other(buffer) => player.buffer(buffer).map(|[_, other]| other),
    };
    let texture = texture.ok_or_else(|| Failure::Device("there is no such texture".to_owned()))?;
    player.renderer().device.read_texture(texture)
}
