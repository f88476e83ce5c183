//! PNG decoded row by row: the pixels of the file are never in memory together, only those of the smaller image.

use super::{DecodedImage, MAX_PIXELS};
use png::{BitDepth, ColorType, Decoder, Limits, Reader, Transformations};
use std::io::Cursor;

/// Returns whether the bytes are a PNG whose rows are in order: not interlaced.
pub(super) fn has_rows(bytes: &[u8]) -> bool {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.read_header_info().is_ok_and(|info| !info.interlaced)
}

/// Returns the memory in bytes that decoding needs beside the result, for an image of this width.
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
    let mut sums = vec![[0_u32; 4]; image.width as usize];
    // The first row and the first column that a pixel covers; the last pixel covers the rest.
    let first = |at: u32, all: u32, small: u32| (u64::from(at) * u64::from(all) / u64::from(small)) as u32;
    let mut row = 0;
    for y in 0..image.height {
        let end = first(y + 1, height, image.height);
        let rows = end - row;
        sums.fill([0; 4]);
        for _ in row..end {
            add_row(&mut reader, &mut sums, |x| first(x, width, image.width))?;
        }
        row = end;
        for (x, sum) in (0..).zip(&sums) {
            let columns = first(x + 1, width, image.width) - first(x, width, image.width);
            let count = (columns * rows).max(1);
            image.pixels.extend(sum.map(|sum| ((sum + count / 2) / count) as u8));
        }
    }
    Ok(image)
}

/// Adds the next row of the file to the sums of the pixels that cover it. `first` returns the first column of a pixel.
fn add_row(
    reader: &mut Reader<Cursor<&[u8]>>,
    sums: &mut [[u32; 4]],
    first: impl Fn(u32) -> u32,
) -> Result<(), String> {
    let (color, depth) = reader.output_color_type();
    let row = reader.next_row().map_err(|error| error.to_string())?;
    let row = row.ok_or_else(|| "rows are missing".to_owned())?;
    let channels = color.samples();
    let wide = depth == BitDepth::Sixteen;
    let data = row.data();
    let value = |sample: usize| -> u32 {
        if wide {
            let high = |at: usize| data.get(at).copied().map_or(0, u32::from);
            // To the nearest of 256 values.
            ((high(2 * sample) << 8 | high(2 * sample + 1)) + 128) / 257
        } else {
            data.get(sample).copied().map_or(0, u32::from)
        }
    };
    let rgba = |column: usize| -> [u32; 4] {
        let at = column * channels;
        match color {
            ColorType::Grayscale | ColorType::Indexed => [value(at), value(at), value(at), 255],
            ColorType::GrayscaleAlpha => [value(at), value(at), value(at), value(at + 1)],
            ColorType::Rgb => [value(at), value(at + 1), value(at + 2), 255],
            ColorType::Rgba => [value(at), value(at + 1), value(at + 2), value(at + 3)],
        }
    };
    for (x, sum) in (0..).zip(sums) {
        for column in first(x)..first(x + 1) {
            let pixel = rgba(column as usize);
            for (sum, value) in sum.iter_mut().zip(pixel) {
                *sum += value;
            }
        }
    }
    Ok(())
}
