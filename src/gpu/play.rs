//! The passes of a shader on the device: textures stay there from frame to frame.

use std::sync::OnceLock;

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::{self as glsl, Stage};
use toyproof_image::{self as image, Frame, Image, Sampling, Texture, cube};
use toyproof_player::{Channel, Player, Readback, Renderer, Storage};
use toyproof_translate::naga_ir::{Shape, ValidModule};
use toyproof_translate::{FloatMode, Lowered, lower_strict};
use wgpu::{TextureUsages, TextureView, TextureViewDescriptor};

use super::device::Device;
use super::draw::{CompiledPipeline, Program, encode};
use super::texture::{extent, flat, upload, view, write};
use super::{Failure, refused};

/// Renders passes on a device.
#[derive(Debug)]
pub(super) struct PassRenderer {
    device: Device,
    passes: Vec<CompiledPipeline>,
    /// The samplers of each pass.
    sampling: Vec<[Sampling; 4]>,
    /// The textures that do not change.
    media: Vec<Uploads>,
    /// Renders a mipmap from the next larger one; compiled if a buffer has mipmaps.
    halving: OnceLock<CompiledPipeline>,
}

/// A texture that passes render and read.
#[derive(Debug)]
pub(super) struct PassTexture {
    /// What a pass renders: an image with its mipmaps, or the stacked faces of a cube map.
    target: wgpu::Texture,
    /// The cube map, which is made anew when its faces are rendered.
    cube: Option<Uploads>,
}

/// A texture of the processor, and its copies on the device for the shapes that shaders declare.
#[derive(Debug)]
struct Uploads {
    texture: Texture,
    copies: [OnceLock<Option<wgpu::Texture>>; 4],
}

impl Uploads {
    fn new(texture: Texture) -> Self {
        Self {
            texture,
            copies: Default::default(),
        }
    }

    /// The view for a shader that declares this shape; `None` if the texture has another one.
    fn view(&self, device: &Device, shape: Shape) -> Option<TextureView> {
        let copy = &self.copies[shape as usize];
        let copy = copy.get_or_init(|| upload(&device.gpu, &device.queue, &self.texture, shape));
        Some(view(copy.as_ref()?, shape))
    }
}

/// What a channel of a pass reads: a view, and its `iChannelResolution`.
type BoundChannel = Option<(TextureView, [u32; 3])>;

impl PassRenderer {
    /// Compiles the passes and uploads the textures that do not change.
    pub(super) fn new(
        device: Device,
        programs: &[Program],
        sampling: Vec<[Sampling; 4]>,
        media: &[Texture],
    ) -> Result<Self, (Device, Failure)> {
        let passes = programs.iter().map(|program| device.compile(program)).collect();
        match passes {
            Ok(passes) => Ok(Self {
                media: media.iter().cloned().map(Uploads::new).collect(),
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
    pub(super) fn load(&mut self, texture: &Texture, mipmaps: bool) -> Result<PassTexture, Failure> {
        let is_cube = texture.shape() == image::Shape::Cube;
        let storage = if is_cube {
            Storage::Cube(texture.size()[0])
        } else {
            Storage::Image(texture.size())
        };
        let mut made = self.zeros(storage, mipmaps)?;
        let stack = texture.stack();
        self.device.with_error_scopes(|| {
            write(
                &self.device.queue,
                &made.target,
                0,
                extent(stack.size()),
                stack.pixels(),
            );
            self.make_mipmaps(&made.target)
        })?;
        if is_cube {
            made.cube = Some(Uploads::new(with_mipmaps(texture.clone(), mipmaps)));
        }
        Ok(made)
    }

    /// The view of a channel for a shader that declares this shape, with its resolution.
    fn bound(&self, channel: &Channel<'_, PassTexture>, frame: &Frame, shape: Shape) -> BoundChannel {
        let of_uploads =
            |uploads: &Uploads| Some((uploads.view(&self.device, shape)?, uploads.texture.resolution()));
        match channel {
            Channel::Unbound => None,
            Channel::Texture(PassTexture { cube: Some(cube), .. }) => of_uploads(cube),
            Channel::Texture(PassTexture { target, cube: None }) => {
                (shape == Shape::D2).then(|| (view(target, shape), [target.width(), target.height(), 1]))
            }
            Channel::Medium(number) => of_uploads(self.media.get(*number)?),
            Channel::Moving(number) => of_uploads(&Uploads::new(frame.moving.get(*number)?.0.clone())),
            Channel::Keyboard => of_uploads(&Uploads::new(frame.keys.texture())),
        }
    }

    /// Renders over a view of one level, whose pixels are kept where nothing is written.
    fn submit(
        &self,
        compiled: &CompiledPipeline,
        frame: &Frame,
        channels: [BoundChannel; 4],
        sampling: [Sampling; 4],
        target: &TextureView,
    ) -> Result<(), Failure> {
        let Device { gpu, queue, .. } = &self.device;
        let resolutions = channels
            .each_ref()
            .map(|channel| channel.as_ref().map_or([0; 3], |(_, resolution)| *resolution));
        let mut channels = channels.into_iter();
        let views = std::array::from_fn(|channel| {
            let view = channels.next().flatten();
            view.map_or_else(|| compiled.layout.unbound(gpu, queue, channel), |(view, _)| view)
        });
        let bindings = compiled
            .layout
            .bind(gpu, queue, &frame.block_with(resolutions), &views, sampling);
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
                    [side(texture.width()), side(texture.height()), 1],
                )
            };
            let (target, [width, height, _]) = of(level);
            let frame = Frame {
                size: [width, height],
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
    let program =
        |(lowered, float): &(Lowered, FloatMode)| Program::of(lowered, *float).map(|(program, _)| program);
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

/// The texture with mipmaps, if it shall have any.
fn with_mipmaps(texture: Texture, mipmaps: bool) -> Texture {
    if mipmaps { texture.with_mipmaps() } else { texture }
}

impl Renderer for PassRenderer {
    type Texture = PassTexture;
    type Error = Failure;

    fn zeros(&mut self, storage: Storage, mipmaps: bool) -> Result<PassTexture, Failure> {
        let usage = TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC
            | TextureUsages::COPY_DST;
        let (size, levels, cube) = match storage {
            Storage::Image(size) if mipmaps => (size, levels(size), None),
            Storage::Image(size) => (size, 1, None),
            Storage::Cube(side) => {
                let size = [side, side * cube::FACES];
                let zeros = Image::new(size[0], size[1], vec![[0.0_f32; 4]; (size[0] * size[1]) as usize]);
                let cube = Texture::cube(&zeros).with_resolution([side, side, 1]);
                (size, 1, Some(Uploads::new(with_mipmaps(cube, mipmaps))))
            }
        };
        let target = self
            .device
            .with_error_scopes(|| Ok(flat(&self.device.gpu, size, levels, usage)))?;
        Ok(PassTexture { target, cube })
    }

    fn draw(
        &mut self,
        pass: usize,
        mut over: PassTexture,
        frame: &Frame,
        channels: [Channel<'_, PassTexture>; 4],
    ) -> Result<PassTexture, Failure> {
        self.device.with_error_scopes(|| {
            let (compiled, sampling) = (&self.passes[pass], self.sampling[pass]);
            let times = channels.each_ref().map(|channel| match channel {
                Channel::Moving(number) => frame.moving.get(*number).map_or(0.0, |(_, time)| *time),
                _ => 0.0,
            });
            let frame = &Frame {
                channel_times: times,
                ..frame.clone()
            };
            let channels = std::array::from_fn(|channel| {
                self.bound(&channels[channel], frame, compiled.layout.shape(channel))
            });
            self.submit(compiled, frame, channels, sampling, &level_view(&over.target, 0))?;
            self.make_mipmaps(&over.target)
        })?;
        if let Some(cube) = &mut over.cube {
            // The faces get their borders and mipmaps on the processor.
            let faces = self.device.read_texture(&over.target)?;
            let [width, height, _] = cube.texture.resolution();
            let texture = Texture::cube(&faces).with_resolution([width, height, 1]);
            *cube = Uploads::new(with_mipmaps(texture, cube.texture.levels() > 1));
        }
        Ok(over)
    }

    fn resized(&mut self, texture: PassTexture, size: [u32; 2]) -> Result<PassTexture, Failure> {
        let PassTexture { target: old, .. } = texture;
        let made = self.zeros(Storage::Image(size), old.mip_level_count() > 1)?;
        self.device.with_error_scopes(|| {
            let common = [size[0].min(old.width()), size[1].min(old.height())];
            let mut commands = self.device.gpu.create_command_encoder(&Default::default());
            let new = made.target.as_image_copy();
            commands.copy_texture_to_texture(old.as_image_copy(), new, extent(common));
            self.device.queue.submit([commands.finish()]);
            self.device.wait()?;
            self.make_mipmaps(&made.target)
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
    player.renderer().device.read_texture(&texture.target)
}
