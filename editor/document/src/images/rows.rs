//! PNG decoded row by row: the pixels of the file are never in memory together, only those of the smaller image.

use super::{DecodedImage, MAX_PIXELS};
use png::{BitDepth, ColorType, Decoder, Limits, Reader, Transformations};
use std::io::Cursor;

/// Returns whether the bytes are a PNG whose rows are in order: not interlaced.
pub(super) fn has_rows(bytes: &[u8]) -> bool {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.read_header_info().is_ok_and(|info| !info.interlaced)
}

/// Returns the memory in bytes that decoding needs in addition to the result, for an image of this width.
pub(super) fn memory_of_rows(width: u32) -> u64 {
    // Two rows of four channels with two bytes, and a row of sums.
    u64::from(width) * (2 * 8 + 16)
}

/// Decodes a PNG with its sides halved `halvings` times: each pixel is the average of those that it covers.
pub(super) fn decode_rows(bytes: &[u8], halvings: u32) -> Result<DecodedImage, String> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: MAX_PIXELS as usize });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let (width, height) = (reader.info().width, reader.info().height);
    let side = |side: u32| (side >> halvings).max(1);
    let mut image = DecodedImage { width: side(width), height: side(height), pixels: Vec::new() };
    let bytes = u64::from(image.width) * u64::from(image.height) * 4;
    let bytes = usize::try_from(bytes).map_err(|_| "it is too large".to_owned())?;
    image.pixels.try_reserve_exact(bytes).map_err(|error| error.to_string())?;
    if halvings == 0 {
        for _ in 0..height {
            let row = next_row(&mut reader)?;
            match (row.color, row.is_wide) {
                (ColorType::Rgba, false) => image.pixels.extend_from_slice(row.data),
                _ => (0..width as usize).for_each(|column| {
                    image.pixels.extend(row.rgba(column).map(|value| value as u8));
                }),
            }
        }
        return Ok(image);
    }
    let mut sums = vec![[0_u32; 4]; image.width as usize];
    // The first row and the first column that a pixel covers.
    let first = |at: u32, all: u32, small: u32| (u64::from(at) * u64::from(all) / u64::from(small)) as u32;
    for y in 0..image.height {
        let rows = first(y + 1, height, image.height) - first(y, height, image.height);
        sums.fill([0; 4]);
        for _ in 0..rows {
            let row = next_row(&mut reader)?;
            let mut column = 0;
            for (x, sum) in (1..).zip(&mut sums) {
                let end = first(x, width, image.width);
                for column in column..end {
                    let pixel = row.rgba(column as usize);
                    sum.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += value);
                }
                column = end;
            }
        }
        for (x, sum) in (0..).zip(&sums) {
            let columns = first(x + 1, width, image.width) - first(x, width, image.width);
            let count = (columns * rows).max(1);
            image.pixels.extend(sum.map(|sum| ((sum + count / 2) / count) as u8));
        }
    }
    Ok(image)
}

/// A row of pixels of the file.
struct PngRow<'a> {
    data: &'a [u8],
    color: ColorType,
    /// Whether a channel has two bytes.
    is_wide: bool,
}

fn next_row<'a>(reader: &'a mut Reader<Cursor<&[u8]>>) -> Result<PngRow<'a>, String> {
    let (color, depth) = reader.output_color_type();
    let row = reader.next_row().map_err(|error| error.to_string())?;
    let data = row.ok_or_else(|| "rows are missing".to_owned())?.data();
    Ok(PngRow { data, color, is_wide: depth == BitDepth::Sixteen })
}

impl PngRow<'_> {
    /// Returns red, green, blue and alpha of a pixel, 0 to 255.
    fn rgba(&self, column: usize) -> [u32; 4] {
        let at = column * self.color.samples();
        let value = |channel: usize| self.value(at + channel);
        match self.color {
            ColorType::Grayscale | ColorType::Indexed => [value(0), value(0), value(0), 255],
            ColorType::GrayscaleAlpha => [value(0), value(0), value(0), value(1)],
            ColorType::Rgb => [value(0), value(1), value(2), 255],
            ColorType::Rgba => [value(0), value(1), value(2), value(3)],
        }
    }

    fn value(&self, sample: usize) -> u32 {
        let byte = |at: usize| self.data.get(at).copied().map_or(0, u32::from);
        if self.is_wide {
            // To the nearest of 256 values.
            ((byte(2 * sample) << 8 | byte(2 * sample + 1)) + 128) / 257
        } else {
            byte(sample)
        }
    }
}
