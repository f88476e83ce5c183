//! Reading images back from the device.

use super::gpu::Gpu;
use image::{Rgba32FImage, RgbaImage};

/// Reads the pixels of `texture`, four bytes each, in RGBA order; blocks until the device is done. Panics, as wgpu
/// does, when the device is lost during the wait, so it must be called guarded.
pub fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, String> {
    let mut pixels = read_bytes(gpu, texture, 4)?;
    if matches!(texture.format(), wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb) {
        pixels.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
    }
    let picture = RgbaImage::from_raw(texture.width(), texture.height(), pixels);
    picture.ok_or_else(|| "the image has the wrong size".to_owned())
}

/// Does the same for pixels of four 32-bit floating-point numbers.
pub(crate) fn read_light(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Rgba32FImage, String> {
    let bytes = read_bytes(gpu, texture, 16)?;
    let numbers = bytes.as_chunks::<4>().0.iter().map(|&number| f32::from_ne_bytes(number)).collect();
    let picture = Rgba32FImage::from_raw(texture.width(), texture.height(), numbers);
    picture.ok_or_else(|| "the image has the wrong size".to_owned())
}

/// Reads the rows of `texture`, with `size` bytes for a pixel.
fn read_bytes(gpu: &Gpu, texture: &wgpu::Texture, size: u32) -> Result<Vec<u8>, String> {
    let (width, height) = (texture.width(), texture.height());
    let row = width * size;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(padded) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    let (sender, receiver) = flume::bounded(1);
    buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        let _ = sender.send(result);
    });
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| error.to_string())?;
    let mapped = receiver.try_recv().map_err(|_| "the device did not return the image".to_owned())?;
    mapped.map_err(|error| error.to_string())?;
    let bytes = buffer.slice(..).get_mapped_range().map_err(|error| error.to_string())?;
    let mut pixels = Vec::with_capacity(row as usize * height as usize);
    for line in bytes.chunks_exact(padded as usize) {
        pixels.extend_from_slice(&line[..row as usize]);
    }
    Ok(pixels)
}
