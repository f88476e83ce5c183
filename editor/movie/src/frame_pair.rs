//! The last frame of a movie and the one before it, for formats that store the part of a frame that changed.

use crate::changed::ChangedRect;
use crate::frame::MovieFrame;
use crate::srgb::SrgbTable;

/// Two frames of equal size, sRGB with alpha.
pub(crate) struct FramePair {
    table: SrgbTable,
    /// Pixels of the frame before and of this one.
    pixels: [Vec<u8>; 2],
}

impl FramePair {
    pub(crate) fn new() -> Self {
        Self { table: SrgbTable::new(), pixels: [Vec::new(), Vec::new()] }
    }

    /// Takes the next frame.
    pub(crate) fn take(&mut self, frame: MovieFrame<'_>) {
        frame.to_srgb(&self.table, &mut self.pixels[1]);
    }

    /// Makes the frame that was taken the one before the next.
    pub(crate) fn keep(&mut self) {
        self.pixels.swap(0, 1);
    }

    /// Returns the part of the frame that differs from the one before, and its pixels; all of it for the first one. `even` moves the left and top
    /// edge to even numbers.
    pub(crate) fn changed(&self, size: [u32; 2], is_first: bool, even: bool) -> (ChangedRect, Vec<[u8; 4]>) {
        let [before, now] = &self.pixels;
        let (before, now) = (before.as_chunks::<4>().0, now.as_chunks::<4>().0);
        let rect = match is_first {
            true => ChangedRect::whole(size),
            false => ChangedRect::between(before, now, size, even),
        };
        let mut cut = Vec::new();
        rect.cut(now, size, &mut cut);
        (rect, cut)
    }
}
