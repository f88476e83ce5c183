//! Pictures from the device back to the processor.

use super::gpu::Gpu;
use image::RgbaImage;

/// The pixels of `texture`, four bytes each, in RGBA order; waits for the device. Panics when the device is lost meanwhile,
/// as wgpu does: call it guarded.
pub fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, String> {
    let (width, height) = (texture.width(), texture.height());
    let row = width * 4;
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
    let mapped = receiver.try_recv().map_err(|_| "the picture never came".to_owned())?;
    mapped.map_err(|error| error.to_string())?;
    let bytes = buffer.slice(..).get_mapped_range().map_err(|error| error.to_string())?;
    let mut pixels = Vec::with_capacity(row as usize * height as usize);
    for line in bytes.chunks_exact(padded as usize) {
        pixels.extend_from_slice(&line[..row as usize]);
    }
    drop(bytes);
    if matches!(texture.format(), wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb) {
        pixels.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
    }
    RgbaImage::from_raw(width, height, pixels).ok_or_else(|| "the picture has the wrong size".to_owned())
}
