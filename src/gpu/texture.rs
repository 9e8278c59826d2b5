//! Textures on the device.

use toyproof_image::{self as image, Image, Texture, cube};
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
        Shape::Layers => TextureViewDimension::D2Array,
    }
}

/// Uploads a texture with its mipmaps for a shader that declares this shape. Row 0 is the bottom, as in
/// texture coordinates. Returns `None` if it has another shape.
pub(super) fn upload(
    device: &Device,
    queue: &Queue,
    texture: &Texture,
    shape: Shape,
) -> Option<wgpu::Texture> {
    let [width, height] = texture.size();
    let size = |layers| Extent3d {
        depth_or_array_layers: layers,
        ..extent([width, height])
    };
    let levels = texture.levels();
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    match (shape, texture.shape()) {
        (Shape::D2, image::Shape::Flat) => {
            let made = make(device, shape, size(1), levels, usage);
            for (level, image) in (0..).zip(texture.to_single()) {
                write(queue, &made, level, extent(image.size()), image.pixels());
            }
            Some(made)
        }
        (Shape::D3, image::Shape::Volume) | (Shape::Cube, image::Shape::Cube) => {
            let layers = texture.layers();
            let made = make(device, shape, size(layers), levels, usage);
            for (level, stack) in (0..).zip(texture.stacks()) {
                let [width, rows] = stack.size();
                let layers = match shape {
                    Shape::D3 => (layers >> level).max(1),
                    _ => layers,
                };
                let size = Extent3d {
                    depth_or_array_layers: layers,
                    ..extent([width, rows / layers])
                };
                write(queue, &made, level, size, stack.pixels());
            }
            Some(made)
        }
        (Shape::Layers, image::Shape::Cube) => Some(upload_layers(device, queue, texture)),
        _ => None,
    }
}

/// Uploads a cube map as an array of six images, as strict shaders read it: each has the levels of a face one
/// above the other, with a border of one texel around each.
fn upload_layers(device: &Device, queue: &Queue, texture: &Texture) -> wgpu::Texture {
    let [side, _] = texture.size();
    let height = if texture.levels() > 1 {
        2 * (side + texture.levels())
    } else {
        side + 2
    };
    let size = Extent3d {
        depth_or_array_layers: cube::FACES,
        ..extent([side + 2, height])
    };
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let made = make(device, Shape::Layers, size, 1, usage);
    for (level, stack) in (0..).zip(texture.to_single()) {
        let [width, rows] = stack.size();
        let row = 2 * side - ((2 * side) >> level) + 2 * level;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(16 * width),
            rows_per_image: Some(rows / cube::FACES),
        };
        let to = wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d { x: 0, y: row, z: 0 },
            ..made.as_image_copy()
        };
        let size = Extent3d {
            depth_or_array_layers: cube::FACES,
            ..extent([width, rows / cube::FACES])
        };
        queue.write_texture(to, bytemuck::cast_slice(stack.pixels()), layout, size);
    }
    made
}

/// A view of a whole texture for a shader that declares this shape.
pub(super) fn view(texture: &wgpu::Texture, shape: Shape) -> TextureView {
    texture.create_view(&TextureViewDescriptor {
        dimension: Some(dimension(shape)),
        ..Default::default()
    })
}

/// Creates the texture of an unbound channel: opaque black.
pub(super) fn black(device: &Device, queue: &Queue, shape: Shape) -> TextureView {
    const BLACK: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
    let texel = Image::new(1, 1, vec![BLACK]);
    let texture = match shape {
        Shape::D2 => texel.into(),
        Shape::D3 => Texture::volume(texel, 1),
        Shape::Cube | Shape::Layers => {
            Texture::cube(&Image::new(1, cube::FACES, vec![BLACK; cube::FACES as usize])).with_mipmaps()
        }
    };
    let uploaded = upload(device, queue, &texture, shape);
    view(&uploaded.expect("it has the shape"), shape)
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
