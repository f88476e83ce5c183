//! One frame of a movie: pixels in either of two encodings, and the other one made of them.

use crate::error::MovieError;
use crate::srgb::SrgbTable;

/// Largest width and height of a movie, in pixels.
pub const LARGEST_SIDE: u32 = 16_384;

/// Pixels row by row from the top left, red, green, blue and alpha.
#[derive(Clone, Copy, Debug)]
enum FramePixels<'a> {
    /// Encoded as sRGB, 8 bits, color not multiplied by alpha.
    Srgb(&'a [u8]),
    /// Linear light, color multiplied by alpha.
    Linear(&'a [f32]),
}

/// One frame.
#[derive(Clone, Copy, Debug)]
pub struct MovieFrame<'a> {
    size: [u32; 2],
    pixels: FramePixels<'a>,
}

impl<'a> MovieFrame<'a> {
    /// Creates a frame of `width × height` pixels encoded as sRGB: 4 bytes each, red, green, blue and alpha, not multiplied by it.
    pub fn srgb(size: [u32; 2], rgba: &'a [u8]) -> Self {
        Self { size, pixels: FramePixels::Srgb(rgba) }
    }

    /// Creates a frame of `width × height` pixels in linear light: 4 numbers each, red, green and blue multiplied by alpha, and alpha.
    pub fn linear(size: [u32; 2], rgba: &'a [f32]) -> Self {
        Self { size, pixels: FramePixels::Linear(rgba) }
    }

    /// Returns width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns an error, with the number of the frame, unless the frame has `size` and all its pixels.
    pub(crate) fn check(&self, size: [u32; 2], number: u64) -> Result<(), MovieError> {
        let [width, height] = self.size;
        let wanted = u64::from(width) * u64::from(height) * 4;
        let found = match self.pixels {
            FramePixels::Srgb(pixels) => pixels.len(),
            FramePixels::Linear(pixels) => pixels.len(),
        } as u64;
        let reason = if self.size != size {
            format!("it has {width} × {height} pixels, and the movie has {} × {}", size[0], size[1])
        } else if found != wanted {
            format!("{found} numbers are not the {wanted} of {width} × {height} pixels")
        } else {
            return Ok(());
        };
        Err(MovieError::Frame { number, reason })
    }

    /// Writes the pixels as sRGB with 8 bits, not multiplied by alpha, into `out`.
    pub(crate) fn to_srgb(self, table: &SrgbTable, out: &mut Vec<u8>) {
        match self.pixels {
            FramePixels::Srgb(pixels) => {
                out.clear();
                out.extend_from_slice(pixels);
            }
            FramePixels::Linear(pixels) => converted(pixels, out, |pixel: &[f32; 4]| {
                let alpha = pixel[3];
                let by = if alpha > 0.0 { 1.0 / alpha.min(1.0) } else { 0.0 };
                let [red, green, blue] = [0, 1, 2].map(|channel: usize| table.encode(pixel[channel] * by));
                // A comparison with NaN is false.
                let alpha = if alpha > 0.0 { (alpha.min(1.0) * 255.0 + 0.5) as u8 } else { 0 };
                [red, green, blue, alpha]
            }),
        }
    }

    /// Writes the pixels over black, as sRGB with 8 bits and without alpha, into `out`.
    pub(crate) fn to_opaque(self, table: &SrgbTable, out: &mut Vec<u8>) {
        match self.pixels {
            FramePixels::Srgb(pixels) => converted(pixels, out, |pixel: &[u8; 4]| {
                let alpha = u32::from(pixel[3]);
                [0, 1, 2].map(|channel: usize| ((u32::from(pixel[channel]) * alpha + 127) / 255) as u8)
            }),
            FramePixels::Linear(pixels) => converted(pixels, out, |pixel: &[f32; 4]| {
                [0, 1, 2].map(|channel: usize| table.encode(pixel[channel]))
            }),
        }
    }

    /// Writes the pixels in linear light, multiplied by alpha, into `out`; what is no number becomes 0.
    pub(crate) fn to_linear(self, table: &SrgbTable, out: &mut Vec<f32>) {
        match self.pixels {
            FramePixels::Linear(pixels) => converted(pixels, out, |pixel: &[f32; 4]| {
                pixel.map(|value| if value.is_finite() { value } else { 0.0 })
            }),
            FramePixels::Srgb(pixels) => converted(pixels, out, |pixel: &[u8; 4]| {
                let alpha = f32::from(pixel[3]) / 255.0;
                let [red, green, blue] = [0, 1, 2].map(|channel: usize| table.decode(pixel[channel]) * alpha);
                [red, green, blue, alpha]
            }),
        }
    }
}

/// Writes each pixel of four values, converted to `N` values, into `out`.
fn converted<F, T: Copy + Default, const N: usize>(
    pixels: &[F],
    out: &mut Vec<T>,
    convert: impl Fn(&[F; 4]) -> [T; N],
) {
    let pixels = pixels.as_chunks::<4>().0;
    out.resize(pixels.len() * N, T::default());
    for (out, pixel) in out.as_chunks_mut::<N>().0.iter_mut().zip(pixels) {
        *out = convert(pixel);
    }
}
