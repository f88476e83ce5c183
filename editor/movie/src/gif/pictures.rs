//! The pictures of an animated GIF, encoded one after the other: only what changed in each, in colors of one palette.

use super::dither::DitherTable;
use crate::changed::ChangedRect;
use crate::error::MovieError;
use std::borrow::Cow;

/// Encodes pictures of a GIF.
pub(crate) struct GifPictures {
    size: [u32; 2],
    encoder: gif::Encoder<Vec<u8>>,
    dither: DitherTable,
    /// Index of the color for pixels that do not change.
    transparent: u8,
    /// Indexes of this picture and of the one before; empty before the first one.
    now: Vec<u8>,
    before: Vec<u8>,
}

impl GifPictures {
    /// Creates an encoder for pictures in at most 255 `colors`.
    pub(crate) fn new(size: [u32; 2], colors: &[[u8; 3]], repeats: bool) -> Result<Self, MovieError> {
        // The color after the last one is for pixels that do not change.
        let table = [colors, &[[0; 3]]].concat();
        let [width, height] = size.map(|side| side as u16);
        let mut encoder =
            gif::Encoder::new(Vec::new(), width, height, table.as_flattened()).map_err(refused)?;
        if repeats {
            encoder.set_repeat(gif::Repeat::Infinite).map_err(refused)?;
        }
        let (dither, transparent) = (DitherTable::new(colors, size), colors.len() as u8);
        Ok(Self { size, encoder, dither, transparent, now: Vec::new(), before: Vec::new() })
    }

    /// Encodes the next picture, which is shown for `delay` hundredths of a second. Returns the bytes since the last call.
    pub(crate) fn encode(&mut self, rgb: &[u8], delay: u16) -> Result<Vec<u8>, MovieError> {
        self.dither.indexes(rgb, &mut self.now);
        let mut rect = ChangedRect::whole(self.size);
        let mut cut = Vec::new();
        if self.before.is_empty() {
            cut.clone_from(&self.now);
        } else {
            rect = ChangedRect::between(&self.before, &self.now, self.size, false);
            let mut before = Vec::new();
            rect.cut(&self.before, self.size, &mut before);
            rect.cut(&self.now, self.size, &mut cut);
            let unchanged = cut.iter_mut().zip(before).filter(|(now, before)| *now == before);
            unchanged.for_each(|(now, _)| *now = self.transparent);
        }
        let [left, top, width, height] = [rect.x, rect.y, rect.width, rect.height].map(|side| side as u16);
        let frame = gif::Frame {
            delay,
            transparent: Some(self.transparent),
            top,
            left,
            width,
            height,
            buffer: Cow::Owned(cut),
            ..gif::Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(refused)?;
        std::mem::swap(&mut self.now, &mut self.before);
        Ok(std::mem::take(self.encoder.get_mut()))
    }

    /// Returns the bytes after the last picture.
    pub(crate) fn end(self) -> Result<Vec<u8>, MovieError> {
        self.encoder.into_inner().map_err(refused)
    }
}

fn refused(error: gif::EncodingError) -> MovieError {
    MovieError::Settings { format: "GIF", reason: error.to_string() }
}
