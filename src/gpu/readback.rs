//! Reading textures back, some rows at a time.

use std::ops::Range;

use toyproof_image::Image;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Extent3d, Origin3d, Texture};

use super::Failure;
use super::device::Device;

/// A buffer that holds rows of a texture.
#[derive(Debug)]
pub(super) struct RowBuffer {
    buffer: Buffer,
    width: u32,
    bytes_per_row: u32,
}

impl RowBuffer {
    /// Creates a buffer for that many rows.
    pub(super) fn new(device: &Device, width: u32, rows: usize) -> Self {
        let bytes_per_row = (16 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.gpu.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(bytes_per_row) * rows as u64,
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            buffer,
            width,
            bytes_per_row,
        }
    }

    /// Copies rows of a texture to the buffer.
    pub(super) fn copy(&self, commands: &mut CommandEncoder, texture: &Texture, rows: &Range<u32>) {
        let from = wgpu::TexelCopyTextureInfo {
            origin: Origin3d {
                x: 0,
                y: rows.start,
                z: 0,
            },
            ..texture.as_image_copy()
        };
        let to = wgpu::TexelCopyBufferInfo {
            buffer: &self.buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(self.bytes_per_row),
                rows_per_image: None,
            },
        };
        let size = Extent3d {
            width: self.width,
            height: rows.len() as u32,
            depth_or_array_layers: 1,
        };
        commands.copy_texture_to_buffer(from, to, size);
    }

    /// Reads that many rows from the buffer. The first row of a target has the smallest fragment coordinates:
    /// it is the bottom.
    pub(super) fn read(&self, device: &Device, rows: usize) -> Result<Image, Failure> {
        let slice = self.buffer.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        device.wait()?;
        let view = slice
            .get_mapped_range()
            .map_err(|error| Failure::Device(error.to_string()))?;
        let mut pixels: Vec<[f32; 4]> = Vec::with_capacity(rows * self.width as usize);
        for row in view.chunks(self.bytes_per_row as usize).take(rows) {
            let row = row[..16 * self.width as usize].chunks_exact(16);
            pixels.extend(row.map(bytemuck::pod_read_unaligned::<[f32; 4]>));
        }
        drop(view);
        self.buffer.unmap();
        Ok(Image::new(self.width, rows as u32, pixels))
    }
}

impl Device {
    /// Reads the largest level of a texture.
    pub(super) fn read_texture(&self, texture: &Texture) -> Result<Image, Failure> {
        self.with_error_scopes(|| {
            let height = texture.height();
            let buffer = RowBuffer::new(self, texture.width(), height as usize);
            let mut commands = self.gpu.create_command_encoder(&Default::default());
            buffer.copy(&mut commands, texture, &(0..height));
            self.queue.submit([commands.finish()]);
            buffer.read(self, height as usize)
        })
    }
}
