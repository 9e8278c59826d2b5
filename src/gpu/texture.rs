//! Textures on the device.

use toyproof_image::Texture;
use toyproof_translate::naga_ir::Shape;
use wgpu::{
    Device, Extent3d, Queue, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
    TextureViewDimension,
};

/// Format of all targets and textures: 32-bit floats, so that nothing is rounded.
pub(super) const FORMAT: TextureFormat = TextureFormat::Rgba32Float;

pub(super) fn dimension(shape: Shape) -> TextureViewDimension {
    match shape {
        Shape::D2 => TextureViewDimension::D2,
        Shape::D3 => TextureViewDimension::D3,
        Shape::Cube => TextureViewDimension::Cube,
    }
}

/// Uploads a texture with its mipmaps. Row 0 is the bottom, as in texture coordinates.
pub(super) fn upload(device: &Device, queue: &Queue, texture: &Texture) -> wgpu::Texture {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let made = flat(device, texture.size(), texture.levels(), usage);
    for (level, image) in (0..).zip(texture.to_single()) {
        write(queue, &made, level, extent(image.size()), image.pixels());
    }
    made
}

/// Creates the texture of an unbound channel: opaque black.
pub(super) fn black(device: &Device, queue: &Queue, shape: Shape) -> TextureView {
    let layers = if shape == Shape::Cube { 6 } else { 1 };
    let size = Extent3d {
        depth_or_array_layers: layers,
        ..extent([1, 1])
    };
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let texture = make(device, shape, size, 1, usage);
    write(
        queue,
        &texture,
        0,
        size,
        &[[0.0, 0.0, 0.0, 1.0]; 6][..layers as usize],
    );
    texture.create_view(&TextureViewDescriptor {
        dimension: Some(dimension(shape)),
        ..Default::default()
    })
}

/// Creates a two-dimensional texture of zeros.
pub(super) fn flat(device: &Device, size: [u32; 2], levels: u32, usage: TextureUsages) -> wgpu::Texture {
    make(device, Shape::D2, extent(size), levels, usage)
}

fn make(device: &Device, shape: Shape, size: Extent3d, levels: u32, usage: TextureUsages) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: levels,
        sample_count: 1,
        dimension: dimension(shape).compatible_texture_dimension(),
        format: FORMAT,
        usage,
        view_formats: &[],
    })
}

/// The extent of an image.
pub(super) fn extent([width, height]: [u32; 2]) -> Extent3d {
    Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

pub(super) fn write(queue: &Queue, texture: &wgpu::Texture, level: u32, size: Extent3d, pixels: &[[f32; 4]]) {
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(16 * size.width),
        rows_per_image: Some(size.height),
    };
    let to = wgpu::TexelCopyTextureInfo {
        mip_level: level,
        ..texture.as_image_copy()
    };
    queue.write_texture(to, bytemuck::cast_slice(pixels), layout, size);
}
